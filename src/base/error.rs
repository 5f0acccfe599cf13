//! The error type of the library. Each variant is one kind of failure that a user can act on; the CLI maps them to
//! exit codes in one place (`cli/mod.rs`).

use super::finding::Stopped;
use std::path::PathBuf;

/// Everything that can go wrong below the command line.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum Error {
    /// A scene that cannot be used: points at the file, the line and the key.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] Box<SceneError>),
    /// Input other than a scene file: a bad option, an unknown scene name, a bad centreline file.
    #[error("{what}")]
    Input {
        /// What is wrong.
        what: String,
        /// What would be right.
        #[help]
        help: Option<String>,
    },
    /// The file system refused something.
    #[error("{action} {}: {cause}", path.display())]
    Io {
        /// What was being done: "cannot write", "cannot read".
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's answer; part of the message, so not also given as its source.
        cause: std::io::Error,
    },
    /// The machine lacks something that was asked for (no adapter, no Rerun viewer listening).
    #[error("{what}")]
    Missing {
        /// What is missing.
        what: String,
        /// How to get it, or how to do without it.
        #[help]
        help: Option<String>,
    },
    /// The simulation had to stop: a value that is not finite, a particle that runs away, a ledger that does not close.
    #[error("{0}")]
    #[diagnostic(help("{}", .0.remedy()))]
    Simulation(Box<Stopped>),
    /// The user ended it (Ctrl-C) before it was done.
    #[error("interrupted")]
    Interrupted,
}

/// A scene error with its place in the source.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[error("{what}")]
pub struct SceneError {
    /// What is wrong, naming key and value.
    pub what: String,
    /// What would be right.
    #[help]
    pub help: Option<String>,
    /// The text of the scene, named after its file.
    #[source_code]
    pub source_code: miette::NamedSource<String>,
    /// The place of the offending key or value.
    #[label("here")]
    pub span: Option<miette::SourceSpan>,
}

/// Result with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// An input error with its remedy.
    pub fn input(what: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Input { what: what.into(), help: Some(help.into()) }
    }

    /// A file-system error with what was being done.
    pub fn io(action: &'static str, path: impl Into<PathBuf>, cause: std::io::Error) -> Self {
        Error::Io { action, path: path.into(), cause: without_temporary_name(cause) }
    }

    /// Exit code of the program for this error: 2 for bad input, 3 for something missing on the machine,
    /// 4 for a simulation that had to stop, 130 (128 + SIGINT, as shells expect) for an interruption, 1 for the rest.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Scene(_) | Error::Input { .. } => 2,
            Error::Missing { .. } => 3,
            Error::Simulation(_) => 4,
            Error::Interrupted => 130,
            Error::Io { .. } => 1,
        }
    }
}

/// The system's answer alone: `tempfile` adds the name of a file that nobody asked for (`… at path "/a/.tmpXYZ"`), and
/// offers no other way to the answer than its text.
fn without_temporary_name(cause: std::io::Error) -> std::io::Error {
    if cause.raw_os_error().is_some() {
        return cause;
    }
    match cause.to_string().split_once(" at path \"") {
        Some((answer, _)) => std::io::Error::new(cause.kind(), answer.to_owned()),
        None => cause,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_temporary_name_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing");
        let cause = tempfile::Builder::new().prefix(".temporary-").tempfile_in(&missing).unwrap_err();
        assert!(cause.to_string().contains(".temporary-"), "nothing is to be taken away: {cause}");
        let error = Error::io("cannot write", missing.join("curve.csv"), cause);
        let told = error.to_string();
        assert!(!told.contains(".temporary-") && told.contains("curve.csv: No such file"), "{told}");
        let Error::Io { cause, .. } = error else { panic!("{told}") };
        assert_eq!(cause.kind(), std::io::ErrorKind::NotFound);
        let plain = std::io::Error::from_raw_os_error(2);
        assert!(
            matches!(Error::io("cannot read", "a", plain), Error::Io { cause, .. } if cause.raw_os_error() == Some(2))
        );
    }
}
