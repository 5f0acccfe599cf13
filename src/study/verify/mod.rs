//! Verification: the engine against closed forms (physics page, section 8). A case is a scene `verify/…`, a formula of
//! [`crate::reference`] and a function here that runs the one and compares it with the other; [`CASES`] lists them.

mod beams;
mod capstan;
mod case;
pub mod comparison;
mod conservation;
mod contacts;
mod critical_step;
mod damping;
mod elastica;
mod frame;
mod known_strands;
mod materials;
mod modes;
mod oblique;
mod plasticity;
pub mod plots;
mod repeated;
pub mod report;
mod rigid;
mod section;
mod snapping;
mod spring;
mod strands;
pub mod support;
mod vibration;
mod waves;
mod wires;
mod written;

pub use case::VerificationCase;
pub use support::Effort;

use crate::base::error::{Error, Result};
use crate::run::DeviceChoice;
use crate::study::runner::{Case, CaseRunner, Status, Unfinished};
use crate::study::select;
use comparison::{Comparison, Verdict};
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;
use std::time::Instant;
use support::Context;

/// All cases, by theme.
pub const CASES: &[VerificationCase] = &[
    // Bars and beams
    beams::CANTILEVER,
    beams::STOCKY,
    beams::SHARED,
    beams::TORSION,
    elastica::ELASTICA,
    spring::SPRING,
    // Vibration and waves
    vibration::AXIAL_WAVE,
    waves::PULLED_BAR,
    vibration::BENDING_FREQUENCY,
    vibration::BUCKLING,
    vibration::BUCKLING_BRACKET,
    damping::AXIAL,
    damping::BENDING,
    // Contacts of spheres
    contacts::HERTZ,
    contacts::THORNTON,
    contacts::RESTITUTION,
    repeated::REPEATED,
    contacts::TANGENTIAL,
    contacts::ROLLING,
    oblique::OBLIQUE,
    // Rigid bodies
    rigid::IMPACT,
    rigid::ROLLING,
    rigid::BENDING,
    capstan::DRUM,
    // Contacts of wires
    wires::SLIDING_WIRES,
    wires::SPHERE_ON_WIRE,
    wires::CROSSED_WIRES,
    capstan::CAPSTAN,
    // Plasticity and rupture
    plasticity::PULLED,
    plasticity::YOUNG,
    written::WRITTEN,
    plasticity::BENT,
    plasticity::TWISTED,
    plasticity::WIRE_TWISTED,
    section::SECTION,
    snapping::SNAPPED,
    // Strands
    strands::PITCHES,
    strands::FINER,
    known_strands::UTTING,
    known_strands::TEXTBOOK,
    known_strands::GHOREISHI,
    known_strands::JIANG,
    // Several materials
    materials::WIRES,
    materials::SPHERES,
    materials::CONDUCTOR,
    // What must stay
    conservation::WIRE,
    conservation::COLLISION,
    conservation::STRAND,
    frame::FRAME,
    conservation::ENERGY,
    // The stable step
    critical_step::CHAIN,
    critical_step::CANTILEVER,
    critical_step::FREE_WIRE,
    critical_step::DAMPED,
];

/// The cases of these names, each once, in the order of [`CASES`]; all of them when no name is given.
///
/// # Errors
/// A name that no case has; the nearest is suggested.
pub fn select(names: &[String]) -> Result<Vec<&'static VerificationCase>> {
    select::select(names, CASES, |case| case.name, "verification case", "strandsnap verify --list")
}

/// What became of one case.
pub struct Report {
    /// The case.
    pub case: &'static VerificationCase,
    /// What it found, its energy ledger last; or why it could not be run.
    pub result: Result<Vec<Comparison>>,
    /// Wall time (s).
    pub wall_s: f64,
}

impl Report {
    /// Whether the case ran and every finding agrees with its closed form.
    pub fn passes(&self) -> bool {
        self.result.as_ref().is_ok_and(|comparisons| comparisons.iter().all(|f| f.verdict() == Verdict::Pass))
    }
}

/// Runs one case on the present thread pool, its steps on `device` where they can be done there.
///
/// # Errors
/// [`Error::Interrupted`] when `stop` ended it early.
pub fn run_one(
    case: &'static VerificationCase,
    effort: Effort,
    device: &DeviceChoice,
    stop: &AtomicBool,
) -> Result<Report> {
    let began = Instant::now();
    let context = Context::new(effort, device, stop);
    let result = match (case.run)(&context) {
        Err(Error::Interrupted) => return Err(Error::Interrupted),
        other => other.map(|mut comparisons| {
            comparisons.extend(context.ledger());
            comparisons
        }),
    };
    Ok(Report { case, result, wall_s: began.elapsed().as_secs_f64() })
}

/// A case of a command that may have been ended before.
struct CaseOfCommand<'a> {
    case: &'static VerificationCase,
    effort: Effort,
    device: &'a DeviceChoice,
    unfinished: Option<&'a Unfinished>,
}

/// What is kept of a case that passed. One that did not is run again.
#[derive(PartialEq, Serialize, Deserialize)]
struct Passed {
    comparisons: Vec<Comparison>,
    wall_s: f64,
}

impl CaseOfCommand<'_> {
    /// What it is kept by.
    fn key(&self) -> String {
        match self.device {
            DeviceChoice::Processor => format!("verification case {}, {:?}", self.case.name, self.effort),
            device => format!("verification case {}, {:?}, on {device}", self.case.name, self.effort),
        }
    }
}

impl Case for CaseOfCommand<'_> {
    type Output = Report;

    fn name(&self) -> String {
        self.case.name.into()
    }

    fn kept(&self) -> Option<Report> {
        let Passed { comparisons, wall_s } = self.unfinished?.find(&self.key())?;
        Some(Report { case: self.case, result: Ok(comparisons), wall_s })
    }

    fn run(&self, stop: &AtomicBool) -> Result<Report> {
        let report = run_one(self.case, self.effort, self.device, stop)?;
        if let (Some(unfinished), Ok(comparisons), true) = (self.unfinished, &report.result, report.passes()) {
            let passed = Passed { comparisons: comparisons.clone(), wall_s: report.wall_s };
            unfinished.keep(&self.key(), passed)?;
        }
        Ok(report)
    }
}

/// Runs cases; they are small, so a runner with several jobs, each on one thread, is fastest. The statuses come in the
/// order of `cases`. Those that passed in a command that was ended before are taken from `unfinished`.
///
/// # Errors
/// When a thread cannot be started, or a result cannot be kept.
pub fn run_all(
    cases: &[&'static VerificationCase],
    effort: Effort,
    device: &DeviceChoice,
    runner: &CaseRunner,
    unfinished: Option<&Unfinished>,
) -> Result<Vec<Status<Report>>> {
    let of_command = |case: &&'static VerificationCase| CaseOfCommand { case, effort, device, unfinished };
    runner.run(&cases.iter().map(of_command).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn cases_are_selected_by_name_and_slips_are_corrected() {
        let names = |given: &[&str]| {
            let given: Vec<String> = given.iter().map(|name| name.to_string()).collect();
            select(&given).map(|cases| cases.iter().map(|case| case.name).collect::<Vec<_>>())
        };
        assert_eq!(names(&["thornton", "hertz", "hertz"]).unwrap(), ["hertz", "thornton"]);
        assert_eq!(names(&[]).unwrap().len(), CASES.len());
        let error = names(&["hertzz"]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(format!("{:?}", miette::Report::new(error)).contains("did you mean `hertz`"));
    }

    #[test]
    fn names_are_unique_and_every_case_says_what_it_claims() {
        let mut seen = HashSet::new();
        for case in CASES {
            assert!(seen.insert(case.name), "{} is there twice", case.name);
            assert!(
                case.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'),
                "{}",
                case.name
            );
            assert!(!case.about.is_empty() && !case.source.is_empty(), "{}", case.name);
        }
    }
}
