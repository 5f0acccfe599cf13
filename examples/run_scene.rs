//! Runs a scene from the program's own, changed a little, and prints what it found:
//! `cargo run --release --no-default-features --example run_scene`

use std::error::Error;
use std::sync::atomic::AtomicBool;
use strandsnap::{run, scene};

pub fn main() -> Result<(), Box<dyn Error>> {
    // The options are those of `strandsnap run --set`.
    let options = ["strand.length=20 mm", "grip.length=3 mm", "grip.speed=20 m/s", "bond.rupture.strain=5 %"];
    let scene = scene::load("strand-1x7", &options.map(str::to_owned))?;
    // Nothing is written; `run::run` writes a folder as the program does.
    let summary = run::summarise(&scene, Vec::new(), &AtomicBool::new(false))?;
    for extreme in summary.extremes() {
        println!("{}: {:.1} MPa at {:.2} %", extreme.kind.name(), extreme.stress_mpa, extreme.strain_percent);
    }
    if let Some(first) = &summary.first_rupture {
        println!("wire {} of the {} layer broke first, at {:.2} %", first.wire, first.layer, first.strain_percent);
    }
    for (layer, count) in &summary.wires_broken_by_layer {
        println!("{layer}: {} of {} wires broken", count.broken, count.of);
    }
    // What must be known before believing it is a value with a kind, and a sentence.
    for (found, sentence) in summary.findings.iter().zip(&summary.warnings) {
        println!("{:?}: {sentence}", found.finding.kind());
    }
    if summary.wires_broken == 0 {
        return Err("no wire broke".into());
    }
    Ok(())
}
