//! Ctrl-C: the first ends the run cleanly; one that comes [`PATIENCE`] later or more ends the program.

use super::ended::Ended;
use crate::base::error::{Error, Result};
use crate::base::finding::StopReason;
use crate::run::RunSummary;
use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Keys pressed sooner after the first than this say no more than it did: results are being written.
const PATIENCE: Duration = Duration::from_secs(2);

static STOP: AtomicBool = AtomicBool::new(false);
static INSTALLED: AtomicBool = AtomicBool::new(false);
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

/// [`install`] for commands that keep finished cases.
///
/// # Errors
/// As for [`install`].
pub fn install_for_cases() -> Result<&'static AtomicBool> {
    install_saying("\nstopping; finished cases are kept, and the same command goes on with them.")
}

/// [`install`] with words of one's own; where a handler is installed already, that one stays.
///
/// # Errors
/// As for [`install`].
pub fn install_saying(words: &'static str) -> Result<&'static AtomicBool> {
    if INSTALLED.swap(true, Ordering::Relaxed) {
        return Ok(&STOP);
    }
    let handler = move || {
        let now = Instant::now();
        let first = *FIRST.get_or_init(|| now);
        if !STOP.swap(true, Ordering::Relaxed) {
            // A standard error that is lost must not end the run without its results.
            let _ = writeln!(std::io::stderr(), "{words}");
        } else if now.duration_since(first) >= PATIENCE {
            std::process::exit(i32::from(Error::Interrupted.exit_code()));
        }
    };
    listen(handler).map_err(|e| Error::Missing { what: format!("cannot listen for Ctrl-C: {e}"), help: None })?;
    Ok(&STOP)
}

/// Calls `handler` at INT, TERM and HUP; not at HUP where this process was started to ignore it, as `nohup` does.
#[cfg(unix)]
fn listen(handler: impl Fn() + Send + 'static) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM])?;
    if ignored() >> (SIGHUP - 1) & 1 == 0 {
        signals.add_signal(SIGHUP)?;
    }
    std::thread::spawn(move || signals.forever().for_each(|_| handler()));
    Ok(())
}

/// The signals that this process ignores, a bit for each; none where the system does not tell.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(windows)]
fn listen(handler: impl Fn() + Send + 'static) -> std::result::Result<(), ctrlc::Error> {
    ctrlc::set_handler(handler)
}

/// Sets the flag of [`install`] when `limit` has passed, and says so: a batch system that ends jobs at their time then finds
/// one that has ended by itself, with its results and a checkpoint.
pub fn after(limit: Duration) {
    std::thread::spawn(move || {
        std::thread::sleep(limit);
        if !STOP.swap(true, Ordering::Relaxed) {
            let _ = writeln!(
                std::io::stderr(),
                "\nthe time limit of {} s is reached: stopping; results so far are kept.",
                limit.as_secs_f64()
            );
        }
    });
}

/// How a run ended: a signal that came after its last step took nothing from it unless pictures are missing.
///
/// # Errors
/// [`Error::Interrupted`] when it was stopped early.
pub fn ended_run(summary: &RunSummary) -> Result<Ended> {
    let undrawn = summary.cost.frames.is_some_and(|frames| frames.unfinished());
    if summary.stopped == StopReason::Interrupted || undrawn { Err(Error::Interrupted) } else { Ok(Ended::Well) }
}

/// How a command ended that `stop` may have ended early, with its results kept.
///
/// # Errors
/// [`Error::Interrupted`] when it did.
pub fn ended(stop: &AtomicBool) -> Result<Ended> {
    if stop.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(Ended::Well) }
}
