//! A bar that is suddenly pulled.

use super::case::VerificationCase;
use super::comparison::{Comparison, Convergence, Point};
use super::support::{Context, set};
use crate::base::error::Result;

pub const PULLED_BAR: VerificationCase = VerificationCase {
    name: "wave-energy",
    about: "a bar suddenly pulled at its end: half of the work becomes kinetic energy",
    source: "d'Alembert: W = σ² A c t/E, E_kin = W/2",
    run: pulled_bar,
};

/// The end moves at v from t = 0 on. Behind a front that runs at c = √(E/ρ) all moves at v and is strained by ε = v/c, so
/// the stress is σ = E ε = ρ c v. The work is force times way, W = σ A v t = ρ A c v² t = σ² A c t/E. Of it,
/// ½ ρ v² per volume of the A c t behind the front is motion, and ½ E ε² = ½ ρ v² is strain: one half each.
/// The chain of particles smears the front over a length that grows more slowly than its way.
fn pulled_bar(context: &Context) -> Result<Vec<Comparison>> {
    let speed = 1.0;
    let (mut points, mut last) = (Vec::new(), Vec::new());
    for spacing in context.pick(&[2.0, 1.0, 0.5][..], &[4.0, 2.0, 1.0, 0.5, 0.25]) {
        let mut simulation =
            context.simulation("verify/pulled-bar", &[set("spacing", spacing), set("time.safety", 0.2)])?;
        let bar = simulation.bar();
        simulation.run_to(0.8 * bar.length / bar.axial_wave_speed(), |_| {})?;
        let (energy, time) = (simulation.engine.energy(), simulation.engine.time());
        let spent = simulation.finish();
        let stress = bar.young * speed / bar.axial_wave_speed();
        let work = stress.powi(2) * bar.area() * bar.axial_wave_speed() * time / bar.young;
        let share = energy.kinetic / energy.work;
        points.push(Point { resolution: spacing * bar.diameter / bar.length, error: share / 0.5 - 1.0, spent });
        last = vec![
            Comparison::new("work of the pull", "J", energy.work, work, spent).within(5e-3),
            Comparison::new("kinetic energy", "J", energy.kinetic, 0.5 * work, spent).within(5e-3),
            Comparison::new("kinetic energy over work", "-", share, 0.5, spent).within(5e-3),
        ];
    }
    if let Some(finding) = last.last_mut() {
        finding.convergence = Some(Convergence { axis: "a/L".into(), points });
    }
    Ok(last)
}
