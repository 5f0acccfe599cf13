//! The curve as a run writes it: what users read modulus and yield from.

use super::case::VerificationCase;
use super::comparison::{Comparison, Spent};
use super::plasticity::hardening;
use super::support::{Context, set};
use crate::base::error::{Error, Result};
use crate::reference::plasticity::tension_at;
use crate::run::{RunOptions, StopReason, run_watched};
use crate::scene;
use serde::Deserialize;
use std::path::Path;

pub const WRITTEN: VerificationCase = VerificationCase {
    name: "curve-as-written",
    about: "one wire pulled at 5 m/s: modulus and yield read from the rows of curve.csv",
    source: "Hooke, and the hardening law converted with A = A₀ e^(−p)",
    run: curve_as_written,
};

/// Strains at which the curve is read (-): three below yield, two beyond.
const STRAINS: [f64; 5] = [2e-4, 4e-4, 6e-4, 1e-3, 1.4e-3];

/// The built-in wire at the speed that it is shipped with: 0.15 % take as long as an elastic wave from grip to grip, and what
/// smooths stress must not shift it against strain.
fn curve_as_written(context: &Context) -> Result<Vec<Comparison>> {
    let scene = scene::load("single-wire", &[set("stop.strain", "0.15 %"), set("output.samples", 300)])?;
    let (law, young) = (hardening(&scene.spec), scene.spec.material.young);
    let folder = tempfile::tempdir().map_err(|e| Error::io("cannot make a folder in", std::env::temp_dir(), e))?;
    let out = folder.path().join("run");
    let summary = run_watched(&scene, &RunOptions::tables(&out), Vec::new(), context.stop())?;
    if summary.stopped == StopReason::Interrupted {
        return Err(Error::Interrupted);
    }
    let spent = Spent { steps: summary.cost.steps, wall_s: summary.cost.wall_s };
    let curve = read(&out.join("curve.csv"))?;
    let stress = |strain: f64| {
        let i = curve.partition_point(|row| row[0] < strain).clamp(1, curve.len() - 1);
        let ([e0, s0], [e1, s1]) = (curve[i - 1], curve[i]);
        s0 + (s1 - s0) * (strain - e0) / (e1 - e0)
    };
    let exact = |strain: f64| tension_at(strain, |p| law.stress(p), young).engineering_stress;
    let at = STRAINS.map(|strain| {
        let what = format!("stress in curve.csv, worst of five: at {:.2} %", 100.0 * strain);
        Comparison::new(what, "Pa", stress(strain), exact(strain), spent).within(1e-2)
    });
    let secant = |curve: &dyn Fn(f64) -> f64| (curve(6e-4) - curve(2e-4)) / 4e-4;
    let modulus =
        Comparison::new("modulus from curve.csv, 0.02 to 0.06 %", "Pa", secant(&stress), secant(&exact), spent);
    Ok(vec![Comparison::worst(at.into()), modulus.within(1e-2)])
}

/// A row of the curve.
#[derive(Deserialize)]
struct Row {
    strain_percent: f64,
    stress_mpa: f64,
}

/// Strain (-) and nominal stress (Pa) of each row.
fn read(path: &Path) -> Result<Vec<[f64; 2]>> {
    let wrong = |e: csv::Error| Error::io("cannot read", path, std::io::Error::other(e));
    let mut table = csv::Reader::from_path(path).map_err(wrong)?;
    let row = |row: csv::Result<Row>| row.map(|row| [0.01 * row.strain_percent, 1e6 * row.stress_mpa]).map_err(wrong);
    table.deserialize().map(row).collect()
}
