//! One case on one thread of its own, which survives what goes wrong, and what must hold in every run.

use super::case::{Kind, StabilityCase};
use super::critical;
use super::measure::CompletedRun;
use super::outcome::{Ended, Report, judge};
use super::watch::{RunControl, watch};
use crate::base::error::{Error, Result};
use crate::engine::view::Energy;
use crate::run::{DeviceChoice, in_pool};
use crate::scene::Scene;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Time that a run which was asked to end gets to do so (s).
const GRACE: Duration = Duration::from_secs(10);

/// Runs a case on a thread of its own, its steps on `device` where they can be done there, so that it can be given up when it hangs, and judges it.
///
/// # Errors
/// [`Error::Interrupted`] when `stop` ended it early.
pub fn run_case(case: &StabilityCase, quick: bool, device: &DeviceChoice, stop: &AtomicBool) -> Result<Report> {
    let control = Arc::new(RunControl { device: device.clone(), ..RunControl::default() });
    let (send, receive) = mpsc::channel();
    let (job, held) = (case.clone(), control.clone());
    let began = Instant::now();
    std::thread::spawn(move || {
        let ended = catch_unwind(AssertUnwindSafe(|| in_pool(Some(1), || end_of(&job, quick, &held))));
        let ended = match ended {
            Ok(Ok(ended)) => ended,
            Ok(Err(error)) => Ended::Broke(error.to_string()),
            Err(panic) => Ended::Broke(format!("panic: {}", words_of(&*panic))),
        };
        // Nobody listens any more once the run has been given up.
        let _ = send.send(ended);
    });
    let patience = Duration::from_secs_f64(case.patience);
    let ended = loop {
        match receive.recv_timeout(Duration::from_millis(50)) {
            Ok(ended) => break ended,
            Err(_) if stop.load(Ordering::Relaxed) => {
                control.stop.store(true, Ordering::Relaxed);
                return Err(Error::Interrupted);
            }
            Err(_) if began.elapsed() > patience => {
                control.stop.store(true, Ordering::Relaxed);
                let answers = receive.recv_timeout(GRACE).is_ok();
                let how = if answers { "it takes ever more steps" } else { "it hangs within one step" };
                break Ended::Broke(format!("no end after {:.0} s: {how}", case.patience));
            }
            Err(_) => {}
        }
    };
    Ok(judge(case, ended, control.steps.load(Ordering::Relaxed), began.elapsed().as_secs_f64()))
}

fn words_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| s.to_string());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without words".into())
}

fn end_of(case: &StabilityCase, quick: bool, control: &RunControl) -> Ended {
    let ended = match &case.kind {
        Kind::Run => case.scene(quick).and_then(|scene| once(case, &scene, control)),
        Kind::Critical(critical) => critical::search(case, critical, quick, control),
    };
    ended.unwrap_or_else(from_error)
}

/// An error as the end of a case.
fn from_error(error: Error) -> Ended {
    match error {
        Error::Scene(scene) => Ended::Refused { what: scene.what, help: scene.help },
        Error::Input { what, help } => Ended::Refused { what, help },
        Error::Simulation(stopped) => Ended::Stopped(stopped),
        other => Ended::Broke(other.to_string()),
    }
}

/// A run to its end, with what must hold in every run.
fn once(case: &StabilityCase, scene: &Scene, control: &RunControl) -> Result<Ended> {
    let seen = watch(scene, control)?;
    let mut wrong = Vec::new();
    let answer = case.check.map(|check| check(&seen));
    wrong.extend(ledger_faults(&seen));
    wrong.extend(seen.passed_through());
    let residual = Some(residual(&seen));
    Ok(Ended::Ran { answer, residual, wrong, notices: seen.notices })
}

/// The energy that a run had to do with (J); rounding alone does not count.
fn scale(seen: &CompletedRun) -> f64 {
    let of = |e: &Energy| e.work.abs().max(e.internal().abs()).max(e.kinetic.abs());
    seen.rows.iter().map(|row| of(&row.energy)).fold(seen.negligible, f64::max)
}

/// Greatest residual of the ledger over the greatest work done (-).
fn residual(seen: &CompletedRun) -> f64 {
    let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
    seen.rows.iter().map(|row| row.energy.residual().abs()).fold(0.0, larger) / scale(seen)
}

/// One term of the ledger (J).
type Term = fn(&Energy) -> f64;

/// Terms of the ledger that no closed balance would betray: dissipation that falls, energy stored that is negative.
fn ledger_faults(seen: &CompletedRun) -> Vec<String> {
    let (rows, slack) = (&seen.rows, 1e-3 * scale(seen));
    let dissipated: [(&str, Term); 4] = [
        ("plastic work of bonds", |e| e.plastic_bonds),
        ("plastic work of contacts", |e| e.plastic_contacts),
        ("friction", |e| e.friction),
        ("damping", |e| e.damping),
    ];
    let stored: [(&str, Term); 3] = [
        ("kinetic energy", |e| e.kinetic),
        ("elastic energy of bonds", |e| e.elastic_bonds),
        ("elastic energy of contacts", |e| e.elastic_contacts),
    ];
    let mut faults = Vec::new();
    for (name, term) in dissipated {
        let mut most = 0.0f64;
        for row in rows {
            let now = term(&row.energy);
            if now < most - slack {
                faults.push(format!("{name} gives energy back at step {}", row.step));
                break;
            }
            most = most.max(now);
        }
    }
    for (name, term) in stored {
        if let Some(row) = rows.iter().find(|row| term(&row.energy) < -slack) {
            faults.push(format!("the {name} is negative at step {}", row.step));
        }
    }
    faults
}
