//! Ctrl-C: the first ends the run cleanly; one that comes [`PATIENCE`] later or more ends the program.

use crate::base::error::{Error, Result};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What shells expect of a program ended by Ctrl-C: 128 + SIGINT.
pub const EXIT_CODE: u8 = 130;

/// Keys pressed sooner after the first than this say no more than it did: results are being written.
const PATIENCE: Duration = Duration::from_secs(2);

static STOP: AtomicBool = AtomicBool::new(false);
static FIRST: OnceLock<Instant> = OnceLock::new();

/// Installs the handler and gives the flag that it sets.
///
/// # Errors
/// [`Error::Missing`] when the system refuses the handler.
pub fn install() -> Result<&'static AtomicBool> {
    install_saying(
        "\nstopping; results so far are kept. Ctrl-C once more, two seconds from now or later, ends at once, without them.",
    )
}

/// [`install`] with words of one's own.
///
/// # Errors
/// As for [`install`].
pub fn install_saying(words: &'static str) -> Result<&'static AtomicBool> {
    let handler = move || {
        let now = Instant::now();
        let first = *FIRST.get_or_init(|| now);
        if !STOP.swap(true, Ordering::Relaxed) {
            eprintln!("{words}");
        } else if now.duration_since(first) >= PATIENCE {
            std::process::exit(i32::from(EXIT_CODE));
        }
    };
    ctrlc::set_handler(handler)
        .map_err(|e| Error::Missing { what: format!("cannot listen for Ctrl-C: {e}"), help: None })?;
    Ok(&STOP)
}
