//! Shows a finished run to an observer again, from its trajectory, without simulating.

use super::folder::TRAJECTORY;
use crate::base::error::{Error, Result};
use crate::observe::Observer;
use crate::observe::trajectory::{Record, Trajectory};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Which snapshots of a run to show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selection {
    /// Every how many snapshots of those within `strain`; 1 is all.
    pub every: usize,
    /// Strain of the body, from and to, both included [-].
    pub strain: [f64; 2],
}

impl Default for Selection {
    fn default() -> Self {
        Self { every: 1, strain: [f64::NEG_INFINITY, f64::INFINITY] }
    }
}

/// The trajectory of a run, given its folder or the file itself.
///
/// # Errors
/// [`Error::Input`] when there is none.
pub fn trajectory_of(run: &Path) -> Result<PathBuf> {
    let file = if run.is_dir() { run.join(TRAJECTORY) } else { run.to_path_buf() };
    if !file.is_file() {
        return Err(Error::input(
            format!("there is no trajectory at {}", file.display()),
            "give the folder of a finished run, such as out/ka4",
        ));
    }
    Ok(file)
}

/// Shows the selected snapshots, and every row and rupture, to `observer`. Returns how many snapshots it showed.
///
/// # Errors
/// [`Error::Input`] when nothing is selected; otherwise what the trajectory or the observer says. The observer is
/// finished in either case.
pub fn replay(run: &Path, selection: &Selection, observer: &mut dyn Observer, stop: &AtomicBool) -> Result<usize> {
    let mut trajectory = Trajectory::open(&trajectory_of(run)?)?;
    observer.start(&trajectory.info().clone())?;
    let shown = show(&mut trajectory, selection, observer, stop);
    observer.finish()?;
    match shown? {
        0 => Err(Error::input(
            format!("no snapshot of {} lies in that range of strain", run.display()),
            "widen --strain-range",
        )),
        shown => Ok(shown),
    }
}

fn show(
    trajectory: &mut Trajectory,
    selection: &Selection,
    observer: &mut dyn Observer,
    stop: &AtomicBool,
) -> Result<usize> {
    let (mut inside, mut shown) = (0, 0);
    for record in trajectory {
        match record? {
            Record::Sample(sample) => observer.sample(&sample)?,
            Record::Rupture(rupture) => observer.rupture(&rupture)?,
            Record::Notice(notice) => observer.notice(&notice)?,
            Record::Snapshot(snapshot) => {
                let [from, to] = selection.strain;
                if (from..=to).contains(&snapshot.sample.strain) {
                    if inside % selection.every.max(1) == 0 {
                        observer.snapshot(&Arc::new(snapshot))?;
                        shown += 1;
                    }
                    inside += 1;
                }
            }
        }
        if stop.load(Ordering::Relaxed) {
            break;
        }
    }
    Ok(shown)
}
