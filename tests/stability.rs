//! The quick form of the stability matrix: every case must end as it should.

use std::sync::atomic::AtomicBool;
use strandsnap::run::DeviceChoice;
use strandsnap::study::runner::{CaseRunner, all_outputs, cores};
use strandsnap::study::stability::case::StabilityCase;
use strandsnap::study::stability::outcome::{Outcome, Report};
use strandsnap::study::stability::{self, select};

fn run_all(cases: &[StabilityCase]) -> Vec<Report> {
    let stop = AtomicBool::new(false);
    let runner = CaseRunner { jobs: cores(), threads: Some(1), budget: None, stop: &stop, tell: &|_| {} };
    all_outputs(stability::run_all(cases, true, &DeviceChoice::Processor, &runner, None).unwrap()).unwrap()
}

#[test]
fn no_case_fails() {
    let cases = select(&[]).expect("all cases");
    let reports = run_all(&cases);
    assert_eq!(reports.len(), cases.len());
    let failed: Vec<String> = reports
        .iter()
        .filter(|report| report.outcome == Outcome::Failed)
        .map(|report| format!("{}: {}", report.case.name, report.message))
        .collect();
    assert!(failed.is_empty(), "{} of {} cases:\n{}", failed.len(), cases.len(), failed.join("\n"));
}

/// What is refused names its cause, or the key, in words that lead on.
#[test]
fn refusals_say_what_is_wrong() {
    for (case, words) in [
        ("spacing-2d-sphere", ["gaps", "wire"]),
        ("spacing-4d-sphere", ["gaps", "wire"]),
        ("pitch-3r", ["outer", "pitch"]),
        ("overlap-11%", ["overlap", "apart"]),
        ("overlap-inside", ["overlap", "apart"]),
        ("overlap-same-place", ["overlap", "apart"]),
        ("overlap-strand-20%", ["overlap", "lay"]),
        ("softening", ["softening", "localise"]),
        ("softening-linear", ["linear", "zero or more"]),
    ] {
        let cases = select(&[case.to_string()]).unwrap();
        let reports = run_all(&cases);
        let [report] = &reports[..] else { panic!("{case}") };
        assert_eq!(report.outcome, Outcome::Refused, "{case}: {}", report.message);
        for word in words {
            assert!(report.message.contains(word), "{case}: no \"{word}\" in \"{}\"", report.message);
        }
    }
}

/// No item of the matrix is dropped unseen.
#[test]
fn every_kind_of_case_is_there() {
    for kind in [
        "step-*",
        "stiff-*",
        "soft-*",
        "hardening-*",
        "softening*",
        "yield-*",
        "friction-*",
        "damping-*",
        "spacing-*",
        "wire-*",
        "pitch-*",
        "wires-*",
        "overlap-*",
        "speed-*",
        "sudden-stop*",
        "buckling",
        "compressed-*",
        "torsion-*",
        "cycles-*",
        "broken-*",
        "after-the-break-*",
        "rest-*",
    ] {
        assert!(!select(&[kind.to_string()]).unwrap_or_default().is_empty(), "{kind}");
    }
}
