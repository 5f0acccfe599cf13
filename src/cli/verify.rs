//! `strandsnap verify`.

use super::cases::CaseArgs;
use super::ended::Ended;
use super::say::{self, say};
use crate::base::error::Result;
use crate::base::wording::counted;
use crate::study::verify::{self, CASES, Effort, Report, plots, report};
use std::time::Instant;

const NAME: &str = "verify";

pub fn verify(args: &CaseArgs) -> Result<Ended> {
    if args.list {
        list();
        return Ok(Ended::Well);
    }
    let cases = verify::select(&args.cases)?;
    args.prepare(NAME)?;
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let began = Instant::now();
    let ran = args.run(NAME, |runner, kept| verify::run_all(&cases, effort, &args.device, runner, kept))?;
    let reports = &ran.outputs;
    show(reports, began.elapsed().as_secs_f64());
    if let Some(path) = &args.json {
        report::write_json(reports, path)?;
        say!("findings: {}", path.display());
    }
    if let Some(folder) = args.plots(NAME) {
        let files = plots::write(reports, &folder)?;
        if !files.is_empty() {
            say!("plots: {} in {}", counted(files.len(), "file"), folder.display());
        }
    }
    let well = reports.iter().all(Report::passes);
    ran.complete()?;
    Ok(if well { Ended::Well } else { Ended::Missed })
}

fn list() {
    let width = CASES.iter().map(|case| case.name.len()).max().unwrap_or(0);
    for case in CASES {
        say!("{:width$}  {}", case.name, case.about);
        say!("{:width$}  {}", "", case.source);
    }
}

fn show(reports: &[Report], seconds: f64) {
    say::print(format_args!("{}", report::table(reports)));
    let notes = report::notes(reports);
    if !notes.is_empty() {
        say!("\nNotes:\n{notes}");
    }
    let passed = reports.iter().filter(|r| r.passes()).count();
    let missed: Vec<&str> = reports.iter().filter(|r| !r.passes()).map(|r| r.case.name).collect();
    let tail = if missed.is_empty() { String::new() } else { format!("; not: {}", missed.join(", ")) };
    say!("{passed} of {} cases agree with their closed forms in {seconds:.1} s{tail}", reports.len());
}
