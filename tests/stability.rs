//! The quick form of the stability matrix: every case must end as it should.

use std::sync::atomic::AtomicBool;
use strandsnap::study::stability::outcome::Outcome;
use strandsnap::study::stability::{run_all, select};

#[test]
fn no_case_fails() {
    let cases = select(&[]).expect("all cases");
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let reports = run_all(&cases, true, threads, &AtomicBool::new(false), &|_| {});
    assert_eq!(reports.len(), cases.len());
    let failed: Vec<String> = reports
        .iter()
        .filter(|report| report.outcome == Outcome::Failed)
        .map(|report| format!("{}: {}", report.case.name, report.message))
        .collect();
    assert!(failed.is_empty(), "{} of {} cases:\n{}", failed.len(), cases.len(), failed.join("\n"));
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
