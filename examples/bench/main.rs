//! Time per step by stage and how far that is from what the machine can do; neighbour search, memory, recording and
//! frames; and what scenes leave out.
//!
//! ```text
//! cargo run --release --example bench -- [--scene ka4] [--threads 1,2] [--lengths 1,10] [--json FILE]
//! cargo run --release --example bench -- --plans
//! cargo run --release --example bench -- --device gpu --batch 1,16,256 [--json FILE]
//! cargo run --release --example bench -- --explore out/ka4 [--size 1920x1080]
//! ```
//!
//! The strand is first pulled fast (same strain rate for every length) until it is in full contact, then timed at that
//! state. The ends of a very long strand would have to move faster than a step allows: measure that with `--strain 0`
//! on a scene whose wires touch from the start, such as `--scene examples/peers/strand.toml --lengths 1,10,100`.

mod adapter;
mod checkpoint;
mod counted;
mod explore;
mod loops;
mod machine;
mod measure;
mod memory;
mod output;
mod plans;
mod roofline;
mod tables;
mod work;

use clap::Parser;
use measure::Row;
use serde::Serialize;
use std::path::{Path, PathBuf};
use strandsnap::base::error::{Error, Result};
use strandsnap::engine::REVISION;
use strandsnap::run::cost;
use strandsnap::run::devices::Devices;

#[derive(Parser)]
pub struct Args {
    /// Scene with a strand
    #[arg(long, default_value = "ka4")]
    scene: String,
    /// Changes to the scene
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Numbers of threads
    #[arg(long, value_delimiter = ',', default_value = "1,2")]
    threads: Vec<usize>,
    /// Factors on the length of the strand
    #[arg(long, value_delimiter = ',', default_value = "1,10")]
    lengths: Vec<f64>,
    /// Strain at which is measured (%); 0 for the scene as it starts
    #[arg(long, default_value_t = 6.0)]
    strain: f64,
    /// Strain rate of the way there (1/s)
    #[arg(long, default_value_t = 180.0)]
    rate: f64,
    /// Steps that are timed
    #[arg(long, default_value_t = 400, value_parser = clap::value_parser!(u64).range(1..))]
    steps: u64,
    /// How often they are timed; the best counts
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(1..))]
    repeats: u64,
    /// Measure steps on this graphics adapter instead: gpu, or a part of its name
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Strands that are stepped at once on it
    #[arg(long, value_delimiter = ',', default_value = "1,4", requires = "device")]
    batch: Vec<usize>,
    /// Measure instead how long `explore` takes from a move to its picture, of the run in this folder
    #[arg(long, value_name = "RUN")]
    explore: Option<PathBuf>,
    /// Width and height of its pictures (px)
    #[arg(long, value_name = "WxH", default_value = "1920x1080", value_parser = size, requires = "explore")]
    size: [u32; 2],
    /// Also write the rows to this file, with what the machine is and which program was measured
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Show what each shipped scene leaves out instead, and what that saves
    #[arg(long)]
    plans: bool,
    /// Measure one length and write its rows as JSON: each length is a process, so that peaks of memory do not mix
    #[arg(long, hide = true)]
    only: Option<f64>,
}

fn main() -> miette::Result<()> {
    let args = Args::parse();
    if args.plans {
        return Ok(plans::print(&args)?);
    }
    if let Some(run) = &args.explore {
        return Ok(explore::print(&args, run)?);
    }
    if let Some(factor) = args.only {
        println!("{}", serde_json::to_string(&measure::rows(&args, factor)?).expect("rows are plain data"));
        return Ok(());
    }
    if let Some(name) = &args.device {
        let rows = adapter::print(&args, name)?;
        return Ok(args.json.as_ref().map_or(Ok(()), |file| keep(file, &rows))?);
    }
    let mut rows = Vec::new();
    for factor in &args.lengths {
        rows.extend(in_process_of_its_own(*factor)?);
    }
    tables::print(&rows);
    checkpoint::print(&args)?;
    output::print(&args, &rows)?;
    Ok(args.json.as_ref().map_or(Ok(()), |file| keep(file, &rows))?)
}

/// Two numbers with an x between them.
fn size(text: &str) -> std::result::Result<[u32; 2], String> {
    let sides: Option<(&str, &str)> = text.split_once('x');
    let both = sides.and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    both.ok_or_else(|| "it is written as 1920x1080".into())
}

/// Writes rows, with what the machine is and which program was measured.
fn keep(file: &Path, rows: &impl Serialize) -> Result<()> {
    let kept = serde_json::json!({
        "machine": Devices::find(),
        "versions": cost::versions(),
        "physics_revision": REVISION,
        "rows": rows,
    });
    let text = serde_json::to_string_pretty(&kept).expect("rows are plain data");
    strandsnap::observe::files::write_whole(file, &text)
}

/// The rows of one length, measured by a child that is called as this process was.
fn in_process_of_its_own(factor: f64) -> Result<Vec<Row>> {
    let failed = |what: String| Error::Missing { what, help: None };
    let program = std::env::current_exe().map_err(|e| Error::io("cannot find", "this program", e))?;
    let output = std::process::Command::new(&program)
        .args(std::env::args_os().skip(1))
        .args(["--only", &factor.to_string()])
        .stderr(std::process::Stdio::inherit())
        .output()
        .map_err(|e| Error::io("cannot start", &program, e))?;
    if !output.status.success() {
        return Err(failed(format!("measuring {factor} × the length ended with {}", output.status)));
    }
    serde_json::from_slice(&output.stdout).map_err(|e| failed(format!("the rows of {factor} × the length: {e}")))
}
