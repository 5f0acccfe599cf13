//! `strandsnap stability`.

use super::cases::CaseArgs;
use super::ended::Ended;
use super::say::{self, say};
use crate::base::error::Result;
use crate::base::wording::counted;
use crate::study::stability::outcome::Outcome;
use crate::study::stability::{plots, report, run_all, select};
use std::time::Instant;

const NAME: &str = "stability";

pub fn stability(args: &CaseArgs) -> Result<Ended> {
    let cases = select(&args.cases)?;
    if args.list {
        say::print(format_args!("{}", report::list(&cases)));
        return Ok(Ended::Well);
    }
    args.prepare(NAME)?;
    let began = Instant::now();
    let ran = args.run(NAME, |runner, kept| run_all(&cases, args.quick, &args.device, runner, kept))?;
    let reports = &ran.outputs;
    say::print(format_args!("{}", report::table(reports)));
    say!("\n{}", report::summary(reports, began.elapsed().as_secs_f64()));
    if let Some(path) = &args.json {
        report::write_json(reports, path)?;
        say!("findings: {}", path.display());
    }
    if let Some(folder) = args.plots(NAME) {
        let files = plots::write(reports, &folder)?;
        say!("plots: {} in {}", counted(files.len(), "file"), folder.display());
    }
    let failed = reports.iter().any(|r| r.outcome == Outcome::Failed);
    ran.complete()?;
    Ok(if failed { Ended::Missed } else { Ended::Well })
}
