//! Files that are either whole or not there under their own name.

use super::partial;
use crate::base::error::{Error, Result};
use crate::base::regular;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes `content` to `path` through a temporary file in the same folder, so that a full disk or an
/// interruption never leaves half a file under that name.
///
/// # Errors
/// [`Error::Input`] where a device, a pipe, a link or a folder has that name; [`Error::Io`] when the folder cannot be
/// written or the disk is full.
pub fn write_whole(path: &Path, content: &(impl AsRef<[u8]> + ?Sized)) -> Result<()> {
    let refuse = |source| Error::io("cannot write", path, source);
    regular::replaceable(path)?;
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".strandsnap-");
    #[cfg(unix)]
    {
        // Temporary files are private by default; what is kept must be as readable as any new file.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(refuse)?;
    file.write_all(content.as_ref()).map_err(refuse)?;
    file.persist(path).map_err(|e| refuse(e.error))?;
    Ok(())
}

/// A CSV table that grows row by row as `NAME.partial` and gets its name when it is finished.
pub struct LiveTable {
    path: PathBuf,
    writer: csv::Writer<BufWriter<File>>,
}

impl LiveTable {
    /// Creates the table with its header.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be created.
    pub fn create(path: PathBuf, header: &[String]) -> Result<Self> {
        let file = partial::create(&path)?;
        let writer = csv::Writer::from_writer(BufWriter::new(file));
        let mut table = Self { path, writer };
        table.row(header)?;
        Ok(table)
    }

    /// Appends a row; it can be read at once.
    ///
    /// # Errors
    /// [`Error::Io`], for instance when the disk is full.
    pub fn row(&mut self, cells: &[String]) -> Result<()> {
        let written = self.writer.write_record(cells).map_err(std::io::Error::from);
        written.and_then(|()| self.writer.flush()).map_err(|e| Error::io("cannot write", partial::name(&self.path), e))
    }

    /// Gives the table its name.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be flushed or renamed.
    pub fn finish(mut self) -> Result<()> {
        self.writer.flush().map_err(|e| Error::io("cannot write", partial::name(&self.path), e))?;
        partial::complete(&self.path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_file_replaces_the_old_one_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_whole(&path, "old").unwrap();
        write_whole(&path, "new").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_that_cannot_be_written_names_its_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("missing").join("a.txt");
        let message = write_whole(&path, "text").unwrap_err().to_string();
        assert!(message.contains("a.txt"), "{message}");
    }

    #[test]
    fn rows_are_readable_before_the_table_is_finished() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        let mut table = LiveTable::create(path.clone(), &["a".into(), "b".into()]).unwrap();
        table.row(&["1".into(), "x, y".into()]).unwrap();
        assert!(!path.exists());
        assert_eq!(std::fs::read_to_string(partial::name(&path)).unwrap(), "a,b\n1,\"x, y\"\n");
        table.finish().unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "a,b\n1,\"x, y\"\n");
        assert!(!partial::name(&path).exists());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_an_error_that_names_the_file() {
        // /dev/full accepts opening and refuses every byte, as a full disk does.
        let file = File::create("/dev/full").unwrap();
        let writer = csv::Writer::from_writer(BufWriter::new(file));
        let mut table = LiveTable { path: "curve.csv".into(), writer };
        let message = table.row(&["1".into()]).unwrap_err().to_string();
        assert!(message.contains("curve.csv"), "{message}");
    }
}
