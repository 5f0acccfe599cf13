//! The short report at the end of a run, in plain words.

use super::materials::{Share, Shares};
use super::summary::{Break, Extreme, ExtremeKind, RunSummary};
use crate::base::wording::counted;
use std::fmt::Write;

/// The report of a run: strength, elongation, breaks, energy, quasi-static measures, cost.
pub fn report(summary: &RunSummary) -> String {
    let mut text = String::new();
    let mut line = |label: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {label:<22}{value}");
    };
    for Extreme { kind, stress_mpa, strain_percent } in summary.extremes() {
        let (remark, there) = match kind {
            ExtremeKind::Strength => (" (peak nominal stress)", "elongation at peak"),
            ExtremeKind::Greatest => (" (nominal; the body did not fail)", "  at a strain of"),
            ExtremeKind::Compressive => (" (least nominal stress)", "  at a strain of"),
        };
        line(kind.name(), format!("{stress_mpa:.2} MPa{remark}"));
        line(there, format!("{strain_percent:.2} %"));
    }
    if let Some(drop) = summary.elongation_at_20_percent_drop_percent {
        line("  at 20 % drop", format!("{drop:.2} %"));
    }
    if let Some(force) = summary.breaking_force_n {
        line("breaking force", newton(force));
    }
    if let Some(shares) = &summary.shares_at_greatest_stress {
        line("  carried by", carried(shares));
    }
    if let (Some(stress), Some(strain)) = (summary.residual_stress_mpa, summary.final_strain_percent) {
        line("at the end", format!("{stress:.2} MPa at {strain:.2} %"));
    }
    if let Some(stiffness) = &summary.stiffness {
        line("initial stiffness", stiffness.words());
    }
    line("first rupture", first_rupture(summary.first_rupture.as_ref(), summary.one_draw.is_some()));
    let layers = summary.wires_broken_by_layer.iter();
    let layers: Vec<String> = layers.map(|(name, n)| format!("{name} {} of {}", n.broken, n.of)).collect();
    if !layers.is_empty() {
        line("wires broken", layers.join(", "));
    }
    for body in &summary.bodies {
        let at = format!("at most {:.4} N, at t = {:.3e} s", body.greatest_force_n, body.greatest_force_at_s);
        line("force on", format!("rigid body {:?} {at}", body.name));
    }
    if let Some(residual) = summary.energy_residual_percent {
        line("energy residual", format!("{residual:.4} % of the work done"));
    }
    if let Some(ratio) = summary.quasi_static.kinetic_over_internal_max {
        let overall = summary.quasi_static.kinetic_over_internal_overall.unwrap_or(ratio);
        line("kinetic / internal", format!("{ratio:.5} before the first rupture, {overall:.5} overall"));
    }
    if let Some(mismatch) = summary.quasi_static.grip_force_mismatch_percent {
        let overall = summary.quasi_static.grip_force_mismatch_overall_percent.unwrap_or(mismatch);
        line("grip force mismatch", format!("{mismatch:.3} % before the first rupture, {overall:.3} % overall"));
    }
    if let Some(deep) = &summary.limits.deepest_contact {
        let [a, b] = &deep.between;
        let when = match deep.strain_percent {
            Some(strain) => format!("strain {strain:.2} %"),
            None => format!("t = {:.3e} s", deep.time_s),
        };
        let depth = deep.overlap_percent_of_radius;
        line("deepest contact", format!("{depth:.2} % of the radius, {a} on {b}, z = {:.1} mm, {when}", deep.z_mm));
    }
    line("time step", time_step(summary));
    if summary.mass_scale != 1.0 || summary.inertia_scale != 1.0 {
        line("scaled", format!("mass × {}, rotational inertia × {}", summary.mass_scale, summary.inertia_scale));
    }
    line("cost", cost(summary));
    if let Some(frames) = &summary.cost.frames {
        line("frames", frames.to_string());
    }
    line("stopped because", summary.stopped_because.clone());
    if let Some(draw) = &summary.one_draw {
        let _ = writeln!(text, "\n  {}", draw.sentence());
    }
    text
}

/// One line for logs and quiet runs.
pub fn one_line(summary: &RunSummary) -> String {
    let mut parts = vec![format!("{} in {:.1} s", counted(summary.cost.steps, "step"), summary.cost.wall_s)];
    let draw = summary.one_draw.map_or(String::new(), |draw| format!(" (one draw, seed {})", draw.seed));
    let named = |e: Extreme| format!("{} {:.2} MPa at {:.2} %{draw}", e.kind.name(), e.stress_mpa, e.strain_percent);
    parts.extend(summary.extremes().map(named));
    let wires: usize = summary.wires_broken_by_layer.values().map(|n| n.of).sum();
    if wires > 0 {
        parts.push(format!("{} of {} broken", summary.wires_broken, counted(wires, "wire")));
    }
    format!("{}: {}; {}", summary.scene, parts.join(", "), summary.stopped_because)
}

/// A force in N, or in kN where that is shorter.
fn newton(force: f64) -> String {
    if force.abs() < 1e4 { format!("{force:.1} N") } else { format!("{:.3} kN", force * 1e-3) }
}

/// What each material carried at the greatest stress.
fn carried(shares: &Shares) -> String {
    let one = |share: &Share| format!("{} {} ({:.1} MPa)", share.name, newton(share.force_n), share.stress_mpa);
    shares.materials.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Of one draw of the scatter it is said that the place is that of this strand.
fn first_rupture(first: Option<&Break>, one_draw: bool) -> String {
    let Some(b) = first else { return "none".into() };
    format!(
        "{}wire {}, {} layer{}, at z = {:.1} mm ({:.1} mm before loading), strain {:.2} %, {:.0} MPa ({})",
        if one_draw { "in this strand " } else { "" },
        b.wire,
        b.layer,
        b.material.iter().map(|material| format!(", {material}")).collect::<String>(),
        b.z_mm,
        b.rest_z_mm,
        b.strain_percent,
        b.stress_mpa,
        b.cause
    )
}

fn time_step(summary: &RunSummary) -> String {
    let (least, greatest) = (&summary.limits.least_time_step, &summary.limits.greatest_time_step);
    format!("{:.3e} to {:.3e} s; least by {}", least.seconds, greatest.seconds, least.limited_by)
}

fn cost(summary: &RunSummary) -> String {
    let cost = &summary.cost;
    let mut text = format!("{}, {:.1} s", counted(cost.steps, "step"), cost.wall_s);
    if let Some(cpu) = cost.cpu_s {
        let _ = write!(text, ", {cpu:.1} s of processor time");
    }
    if let Some(ms) = cost.ms_per_step {
        let _ = write!(text, ", {ms:.3} ms per step");
    }
    if let Some(adapter) = &cost.adapter {
        let _ = write!(text, ", computed on {adapter}");
    }
    let _ = match cost.threads_available {
        available if available > cost.threads => {
            write!(text, " on {} of {} (more were no faster)", cost.threads, counted(available, "thread"))
        }
        _ => write!(text, " on {}", counted(cost.threads, "thread")),
    };
    if let Some(reason) = &cost.not_on_adapter {
        let _ = write!(text, "; computed on the processor: {reason}");
    }
    text
}
