//! `strandsnap stability`.

use super::cases::{self, CaseArgs};
use super::ended::Ended;
use super::interrupt;
use super::say::{self, say};
use crate::base::error::Result;
use crate::base::wording::counted;
use crate::study::stability::outcome::{Outcome, Report};
use crate::study::stability::{plots, report, run_all, select};
use std::sync::atomic::Ordering;
use std::time::Instant;

const NAME: &str = "stability";

pub fn stability(args: &CaseArgs) -> Result<Ended> {
    let cases = select(&args.cases)?;
    if args.list {
        say::print(format_args!("{}", report::list(&cases)));
        return Ok(Ended::Well);
    }
    args.prepare(NAME)?;
    let stop = interrupt::install()?;
    let bar = cases::bar(NAME, cases.len());
    let done = |report: &Report| {
        bar.set_message(format!("{}: {}", report.case.name, report.outcome));
        bar.inc(1);
    };
    let began = Instant::now();
    let reports = run_all(&cases, args.quick, args.threads(), stop, &done);
    bar.finish_and_clear();
    say::print(format_args!("{}", report::table(&reports)));
    say!("\n{}", report::summary(&reports, began.elapsed().as_secs_f64()));
    if let Some(path) = &args.json {
        report::write_json(&reports, path)?;
        say!("findings: {}", path.display());
    }
    if let Some(folder) = args.plots(NAME) {
        let files = plots::write(&reports, &folder)?;
        say!("plots: {} in {}", counted(files.len(), "file"), folder.display());
    }
    if stop.load(Ordering::Relaxed) {
        say!("interrupted after {} of {}", reports.len(), counted(cases.len(), "case"));
        return Ok(Ended::Interrupted);
    }
    Ok(if reports.iter().any(|r| r.outcome == Outcome::Failed) { Ended::Missed } else { Ended::Well })
}
