//! What every writer is told, and a text file that grows.

use crate::base::digest::Digest;
use crate::base::error::{Error, Result};
use crate::engine::view::RunInfo;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

/// What every writer is told.
pub struct Target {
    /// Where its files grow.
    pub folder: PathBuf,
    /// The run's id.
    pub run: Digest,
    /// Range of strain (-).
    #[cfg_attr(not(feature = "export"), allow(dead_code, reason = "what needs it is not built"))]
    pub strain: [f64; 2],
}

impl Target {
    /// Creates a file.
    pub fn create(&self, name: &str) -> Result<(PathBuf, BufWriter<File>)> {
        let path = self.folder.join(name);
        let file = File::create(&path).map_err(|e| Error::io("cannot write", &path, e))?;
        Ok((path, BufWriter::new(file)))
    }

    /// One line that says what is exported.
    pub fn title(&self, info: &RunInfo) -> String {
        format!("{}, run {}, strandsnap {}", info.name, self.run, env!("CARGO_PKG_VERSION"))
    }
}

/// A text file that grows by one snapshot at a time.
pub struct Growing {
    path: PathBuf,
    writer: BufWriter<File>,
}

impl Growing {
    pub fn create(target: &Target, name: &str) -> Result<Self> {
        target.create(name).map(|(path, writer)| Self { path, writer })
    }

    pub fn write(&mut self, write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>) -> Result<()> {
        write(&mut self.writer).map_err(|e| Error::io("cannot write", &self.path, e))
    }

    pub fn finish(&mut self) -> Result<()> {
        self.write(|writer| writer.flush())
    }
}
