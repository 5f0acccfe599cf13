//! Ctrl-C: the first ends the run cleanly, the second ends the program.

use crate::base::error::{Error, Result};
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

/// What shells expect of a program ended by Ctrl-C: 128 + SIGINT.
pub const EXIT_CODE: u8 = 130;

static STOP: AtomicBool = AtomicBool::new(false);

/// Installs the handler and gives the flag that it sets.
///
/// # Errors
/// [`Error::Missing`] when the system refuses the handler.
pub fn install() -> Result<&'static AtomicBool> {
    install_saying("\nstopping; results so far are kept. Press Ctrl-C again to end at once, without them.")
}

/// [`install`] with words of one's own.
///
/// # Errors
/// As for [`install`].
pub fn install_saying(words: &'static str) -> Result<&'static AtomicBool> {
    let handler = move || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(EXIT_CODE));
        }
        // A standard error that is lost must not end the run without its results.
        let _ = writeln!(std::io::stderr(), "{words}");
    };
    ctrlc::set_handler(handler)
        .map_err(|e| Error::Missing { what: format!("cannot listen for Ctrl-C: {e}"), help: None })?;
    Ok(&STOP)
}
