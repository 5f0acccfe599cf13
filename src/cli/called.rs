//! How the program was called: by its own file, or from within another program that has it as a library.

use crate::base::error::{Error, Result};
use std::ffi::OsString;
use std::sync::OnceLock;

static CALLED: OnceLock<Called> = OnceLock::new();

/// What calls the program, and with which arguments.
#[derive(Debug, Clone, PartialEq)]
struct Called {
    /// What starts it again, without its arguments; `None`: its own file does.
    starts: Option<Vec<String>>,
    arguments: Vec<OsString>,
}

/// Tells how the program was called from within another one. What is told first holds.
pub(super) fn tell(starts: Vec<String>, arguments: Vec<OsString>) {
    let _ = CALLED.set(Called { starts: Some(starts), arguments });
}

fn called() -> &'static Called {
    CALLED.get_or_init(|| Called { starts: None, arguments: std::env::args_os().skip(1).collect() })
}

/// The program that has this one as a library; `None` where it was started by its own file.
pub(super) fn within() -> Option<&'static str> {
    called().starts.as_ref()?.first().map(String::as_str)
}

/// The arguments.
pub(super) fn arguments() -> &'static [OsString] {
    &called().arguments
}

/// The same in text.
pub(super) fn words() -> impl Iterator<Item = String> {
    arguments().iter().map(|word| word.to_string_lossy().into_owned())
}

/// What starts the program again, without its arguments.
///
/// # Errors
/// [`Error::Io`] when the system does not tell where its file is.
pub(super) fn starts() -> Result<Vec<String>> {
    if let Some(words) = &called().starts {
        return Ok(words.clone());
    }
    let program = std::env::current_exe().map_err(|e| Error::io("cannot find", "this program", e))?;
    Ok(vec![program.to_string_lossy().into_owned()])
}
