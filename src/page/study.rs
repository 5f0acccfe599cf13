//! A study of error against run time as the page needs it, read from its folder.

use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::run::folder::{ACCURACY_PLOT, ACCURACY_STUDY};
use serde::Deserialize;
use std::path::Path;

/// A study as the page shows it: of `accuracy.json`, what is written for people.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Study {
    /// Scene that was studied.
    pub scene: String,
    /// What the user typed.
    pub command: String,
    /// Whether it was cut short.
    pub interrupted: bool,
    /// What the runs were compared with.
    pub summary: String,
    /// Its tables.
    pub tables: Vec<Table>,
    /// `accuracy.svg`; `None` when its file is missing.
    #[serde(skip)]
    pub plot: Option<String>,
}

/// A table of cells.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Table {
    /// Heading.
    pub title: String,
    /// Heads of the columns.
    pub heads: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
    /// The row that is the scene as it stands.
    pub default: Option<usize>,
}

impl Study {
    /// Reads the study in `folder`; `None` when it holds none.
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be read, [`Error::Input`] when it is damaged.
    pub fn read(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join(ACCURACY_STUDY);
        let Some(text) = read(&path)? else { return Ok(None) };
        let study: Self = serde_json::from_str(&text).map_err(|e| {
            let help = "make it again with `strandsnap accuracy SCENE`; runs that are kept are not made again";
            Error::input(format!("{} is damaged: {e}", path.display()), help)
        })?;
        let plot = read(&folder.join(ACCURACY_PLOT))?;
        Ok(Some(Self { plot, ..study }))
    }
}

fn read(path: &Path) -> Result<Option<String>> {
    regular::text_if_there(path, regular::LONGEST_TABLE)
}
