//! The tables of a run as numbers and words.

use crate::base::error::{Error, Result};
use crate::base::regular;
use std::path::Path;

/// A table with named columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Its file's name.
    pub name: &'static str,
    /// Heads of the columns.
    pub heads: Vec<String>,
    /// Cells, row by row, as wide as the heads.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads `name` in `folder`.
    ///
    /// # Errors
    /// [`Error::Input`] when it is no table, or lacks one of the columns `needed`; [`Error::Io`] when it cannot be read.
    pub fn read(folder: &Path, name: &'static str, needed: &[&str]) -> Result<Self> {
        let path = folder.join(name);
        let text = regular::read(&path, regular::LONGEST_TABLE)?;
        let damaged = |what: String| {
            Error::input(format!("{} is damaged: {what}", path.display()), "run the scene again into an empty folder")
        };
        let mut reader = csv::Reader::from_reader(text.as_slice());
        let heads: Vec<String> =
            reader.headers().map_err(|e| damaged(e.to_string()))?.iter().map(String::from).collect();
        if let Some(missing) = needed.iter().find(|head| !heads.iter().any(|h| h == *head)) {
            return Err(damaged(format!("it has no column `{missing}`")));
        }
        let rows = reader.records().map(|row| row.map(|row| row.iter().map(String::from).collect()));
        let rows = rows.collect::<std::result::Result<_, _>>().map_err(|e| damaged(e.to_string()))?;
        let table = Self { name, heads, rows };
        table.check_numbers().map_err(damaged)?;
        Ok(table)
    }

    /// Cells of columns that are not words must be numbers or empty.
    fn check_numbers(&self) -> std::result::Result<(), String> {
        for (k, head) in self.heads.iter().enumerate().filter(|(_, head)| !is_words(head)) {
            for (i, row) in self.rows.iter().enumerate() {
                if !row[k].is_empty() && row[k].parse::<f64>().is_err() {
                    return Err(format!("line {}, column {head}: `{}` is no number", i + 2, row[k].escape_debug()));
                }
            }
        }
        Ok(())
    }

    /// Index of a column that [`Table::read`] was asked for.
    fn column(&self, head: &str) -> Option<usize> {
        self.heads.iter().position(|h| h == head)
    }

    /// Whether there is such a column.
    pub fn has(&self, head: &str) -> bool {
        self.column(head).is_some()
    }

    /// A cell's number; NaN when it is empty or missing.
    pub fn number(&self, row: usize, head: &str) -> f64 {
        self.text(row, head).parse().unwrap_or(f64::NAN)
    }

    /// A cell as it stands; empty when it is missing.
    pub fn text(&self, row: usize, head: &str) -> &str {
        self.column(head).and_then(|k| self.rows.get(row)?.get(k)).map_or("", String::as_str)
    }

    /// All numbers that are there, with line and column for people.
    pub fn numbers(&self) -> impl Iterator<Item = (f64, usize, &str)> {
        self.rows.iter().enumerate().flat_map(move |(i, row)| {
            row.iter()
                .zip(&self.heads)
                .filter(|(cell, head)| !cell.is_empty() && !is_words(head))
                .map(move |(cell, head)| (cell.parse().unwrap_or(f64::NAN), i + 2, head.as_str()))
        })
    }
}

/// Columns that hold words.
fn is_words(head: &str) -> bool {
    ["layer", "material", "body", "cause", "broken", "first_rupture_cause"].contains(&head)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Table> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("curve.csv"), text).unwrap();
        Table::read(folder.path(), "curve.csv", &["step", "layer"])
    }

    #[test]
    fn cells_are_found_by_their_heads() {
        let table = read("step,layer,x\n1,outer,\n2,core,3.5\n").unwrap();
        assert_eq!((table.number(1, "x"), table.text(0, "layer")), (3.5, "outer"));
        assert!(table.number(0, "x").is_nan());
        assert_eq!(table.numbers().collect::<Vec<_>>(), [(1.0, 2, "step"), (2.0, 3, "step"), (3.5, 3, "x")]);
    }

    #[test]
    fn damage_is_named_by_line_and_column() {
        let what = |text: &str| {
            let error = read(text).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            error.to_string()
        };
        assert!(what("step,layer,x\n1,outer,2\n1,outer,2x\n").contains("line 3, column x: `2x` is no number"));
        assert!(what("step,x\n1,2\n").contains("no column `layer`"));
        assert!(what("step,layer\n1,2,3\n").contains("damaged"));
    }
}
