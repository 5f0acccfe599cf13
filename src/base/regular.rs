//! Regular files, read to a bound and replaced only by what replaces files: a device or a pipe may never end, and what is
//! written over one is lost in another way than its owner expects.

use super::error::{Error, Result};
use std::fs::{File, FileType};
use std::io::{ErrorKind, Read};
use std::path::Path;

/// Longest scene or study (bytes).
pub const LONGEST_SCENE: u64 = 16 << 20;
/// Longest table, summary, page or file of centre lines (bytes).
pub const LONGEST_TABLE: u64 = 1 << 30;

/// What a path is, where that is no regular file.
fn other_kind(kind: FileType) -> Option<&'static str> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return Some("a pipe");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
        if kind.is_block_device() || kind.is_char_device() {
            return Some("a device");
        }
    }
    match kind {
        kind if kind.is_dir() => Some("a folder"),
        kind if kind.is_symlink() => Some("a link"),
        kind if kind.is_file() => None,
        _ => Some("no regular file"),
    }
}

/// Opens a regular file, or a link to one. Another kind is never opened: that alone may wait for ever.
///
/// # Errors
/// [`Error::Input`] for anything but a regular file, [`Error::Io`] when the file system refuses.
pub fn open(path: &Path) -> Result<File> {
    let refuse = |cause| Error::io("cannot read", path, cause);
    match other_kind(std::fs::metadata(path).map_err(refuse)?.file_type()) {
        Some(kind) => Err(Error::input(format!("{} is {kind}", path.display()), "give the name of a regular file")),
        None => File::open(path).map_err(refuse),
    }
}

/// All of a regular file of at most `most` bytes.
///
/// # Errors
/// As for [`open`]; [`Error::Input`] for one that is longer.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // It may grow while it is read.
    let read = open(path)?.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|cause| Error::io("cannot read", path, cause))?;
    if bytes.len() as u64 > most {
        let what = format!("{} is longer than {} MiB", path.display(), most >> 20);
        return Err(Error::input(what, "such a file is never as long: is it the right one?"));
    }
    Ok(bytes)
}

/// [`read`] as text.
///
/// # Errors
/// As for [`read`]; [`Error::Input`] for what is not UTF-8.
pub fn text(path: &Path, most: u64) -> Result<String> {
    String::from_utf8(read(path, most)?).map_err(|_| {
        Error::input(format!("{} is damaged: it is no text in UTF-8", path.display()), "save it as plain text")
    })
}

/// [`text`], or `None` where there is no such file.
///
/// # Errors
/// As for [`text`].
pub fn text_if_there(path: &Path, most: u64) -> Result<Option<String>> {
    match text(path, most) {
        Err(Error::Io { cause, .. }) if cause.kind() == ErrorKind::NotFound => Ok(None),
        other => other.map(Some),
    }
}

/// Checks that a file may be written at `path`: nothing is there, or a regular file.
///
/// # Errors
/// [`Error::Input`] for a device, a pipe, a socket, a link or a folder; [`Error::Io`] when the file system refuses.
pub fn replaceable(path: &Path) -> Result<()> {
    let kind = match std::fs::symlink_metadata(path) {
        Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(()),
        Err(cause) if cause.kind() == ErrorKind::NotADirectory => {
            return check_folder(path).and(Err(Error::io("cannot write", path, cause)));
        }
        Err(cause) => return Err(Error::io("cannot write", path, cause)),
        Ok(there) => other_kind(there.file_type()),
    };
    match kind {
        Some(kind) => {
            Err(Error::input(format!("{} is {kind}, which nothing replaces", path.display()), "give another name"))
        }
        None => Ok(()),
    }
}

/// [`replaceable`], and where `overwrite` is not set, that nothing is there; `option` names another file.
///
/// # Errors
/// As for [`replaceable`]; [`Error::Input`] when there is a file.
pub fn check_target(path: &Path, overwrite: bool, option: &str) -> Result<()> {
    replaceable(path)?;
    if overwrite || !path.exists() {
        return Ok(());
    }
    let other = if option.is_empty() { String::new() } else { format!(", or another file with {option}") };
    Err(Error::input(format!("{} exists", path.display()), format!("give --overwrite to replace it{other}")))
}

/// Checks that a folder may be made at `path`: nothing but folders is there, or above it.
///
/// # Errors
/// [`Error::Input`] that names what is no folder.
pub fn check_folder(path: &Path) -> Result<()> {
    let there = path.ancestors().find(|above| std::fs::symlink_metadata(above).is_ok());
    match there.filter(|there| !there.is_dir()) {
        Some(file) => Err(Error::input(format!("{} is not a folder", file.display()), "give the name of a folder")),
        None => Ok(()),
    }
}

/// Checks that a file can be written at `path`: one that vanishes again is written into the nearest folder above it that is
/// there.
///
/// # Errors
/// As for [`check_folder`]; [`Error::Io`] when the file system refuses.
pub fn check_writable(path: &Path) -> Result<()> {
    let refuse = |cause| Error::io("cannot write", path, cause);
    let absolute = std::path::absolute(path).map_err(refuse)?;
    let folder = absolute.parent().unwrap_or(&absolute);
    check_folder(folder)?;
    let existing = folder.ancestors().find(|above| above.exists()).unwrap_or(folder);
    tempfile::tempfile_in(existing).map(drop).map_err(refuse)
}

/// Makes a folder, and those above it, where they are not there.
///
/// # Errors
/// As for [`check_folder`]; [`Error::Io`] when the file system refuses.
pub fn make_folder(path: &Path) -> Result<()> {
    check_folder(path)?;
    std::fs::create_dir_all(path).map_err(|cause| Error::io("cannot make the folder", path, cause))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(result: Result<impl Sized>) -> String {
        let error = result.err().expect("it must be refused");
        assert_eq!(error.exit_code(), 2, "{error}");
        error.to_string()
    }

    #[test]
    fn a_file_is_read_up_to_its_bound() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::write(&path, "four").unwrap();
        assert_eq!(text(&path, 4).unwrap(), "four");
        assert!(message(read(&path, 3)).contains("longer than"));
        std::fs::write(&path, [0xff, 0xfe, 0]).unwrap();
        assert!(message(text(&path, 4)).contains("no text"));
        assert_eq!(read(&folder.path().join("none"), 4).unwrap_err().exit_code(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_neither_read_nor_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let _socket = std::os::unix::net::UnixListener::bind(at("socket")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", at("link")).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(at("pipe")).status().unwrap().success());
        std::fs::create_dir(at("folder")).unwrap();
        for (name, kind) in [("socket", "a socket"), ("link", "a device"), ("pipe", "a pipe"), ("folder", "a folder")] {
            assert!(message(read(&at(name), 100)).contains(kind), "{name}");
            let kind = if name == "link" { "a link" } else { kind };
            assert!(message(replaceable(&at(name))).contains(kind), "{name}");
            assert!(message(check_target(&at(name), true, "")).contains(kind), "{name}");
        }
        std::fs::write(at("file"), "").unwrap();
        assert!(check_target(&at("file"), true, "").is_ok() && replaceable(&at("new")).is_ok());
        assert!(message(check_target(&at("file"), false, "--out")).contains("exists"));
    }

    #[test]
    fn a_folder_is_made_where_no_file_is_in_its_way() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        make_folder(&at("a/b")).unwrap();
        make_folder(&at("a/b")).unwrap();
        assert!(at("a/b").is_dir() && check_folder(Path::new("nowhere/below")).is_ok());
        std::fs::write(at("file"), "").unwrap();
        for inside in ["file", "file/below", "file/far/below"] {
            assert!(message(make_folder(&at(inside))).ends_with("file is not a folder"), "{inside}");
        }
        assert!(message(replaceable(&at("file/page.html"))).ends_with("file is not a folder"));
    }
}
