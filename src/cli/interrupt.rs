//! Ctrl-C: the first ends the run cleanly, the second ends the program.

use super::Ended;
use crate::base::error::{Error, Result};
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// Installs the handler and gives the flag that it sets.
///
/// # Errors
/// [`Error::Missing`] when the system refuses the handler.
pub fn install() -> Result<&'static AtomicBool> {
    install_saying("\nstopping; results so far are kept. Press Ctrl-C again to end at once, without them.")
}

/// [`install`] for commands that keep finished cases.
///
/// # Errors
/// As for [`install`].
pub fn install_for_cases() -> Result<&'static AtomicBool> {
    install_saying("\nstopping; finished cases are kept, and the same command goes on with them.")
}

fn install_saying(words: &'static str) -> Result<&'static AtomicBool> {
    let handler = move || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(Error::Interrupted.exit_code()));
        }
        eprintln!("{words}");
    };
    ctrlc::set_handler(handler)
        .map_err(|e| Error::Missing { what: format!("cannot listen for Ctrl-C: {e}"), help: None })?;
    Ok(&STOP)
}

/// How a command ended that `stop` may have ended early, with its results kept.
///
/// # Errors
/// [`Error::Interrupted`] when it did.
pub fn ended(stop: &AtomicBool) -> Result<Ended> {
    if stop.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(Ended::Well) }
}
