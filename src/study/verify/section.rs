//! Plasticity of a section under tension, bending and torsion together.

use super::case::VerificationCase;
use super::comparison::Comparison;
use super::support::Context;
use crate::base::error::Result;
use crate::engine::Engine;
use crate::reference::beam::RoundBar;
use crate::reference::plasticity::Section;
use crate::scene;
use crate::scene::spec::BondLawSpec;
use glam::DVec3;

pub const SECTION: VerificationCase = VerificationCase {
    name: "section-plasticity",
    about: "a plastic bond under a constant tension is bent, twisted, or both: what it carries and how it flows",
    source: "Lubliner, Plasticity Theory, 1990, ch. 4: yield surface (N/N_p)^2 + |M|/M_p + (T/T_p)^2 = 1 and its normal",
    run: section,
};

/// How fast the bond is bent or twisted (rad/s): three times as far as it takes to yield.
const RATE: f64 = 20.0;

/// The bond at one instant.
#[derive(Clone, Copy)]
struct Instant {
    moment: f64,
    torque: f64,
    /// Plastic elongation (m).
    elongation: f64,
    /// Plastic angle, of bending where it is bent and else of twist (rad).
    angle: f64,
    /// The section as it has thinned.
    section: Section,
}

/// Reads the only bond, turned at `rates` of bending and twist (rad/s).
fn look(engine: &Engine, bar: &RoundBar, yield_stress: f64, rates: [f64; 2]) -> Instant {
    let s = engine.state();
    let axis = (s.x.get(1) - s.x.get(0)).normalize();
    let action = s.bond.moment(0);
    let torque = action.dot(axis);
    let moment = (action - axis * torque).length();
    let section = Section { radius: s.radius[0], yield_stress };
    // Volume stays: the stress-free length grows as the section thins.
    let length = bar.length * (0.5 * bar.diameter / section.radius).powi(2);
    let now = RoundBar { length, diameter: 2.0 * section.radius, ..*bar };
    let bent = rates[0] * engine.time() - moment * length / (now.young * now.second_moment());
    let twisted = rates[1] * engine.time() - now.twist(torque.abs());
    let angle = if rates[0] > 0.0 { bent } else { twisted };
    Instant { moment, torque: torque.abs(), elongation: length - bar.length, angle, section }
}

/// One loading path: tension over its limit, and twist over bending.
struct Path {
    share: f64,
    twist: f64,
}

/// What the bond carries at the end and how it flowed in the second half, against the yield surface and its normal.
fn follow(context: &Context, path: &Path) -> Result<Vec<Comparison>> {
    let scene = scene::load("verify/section", &[])?;
    let spec = &scene.spec;
    let BondLawSpec::ElastoPlastic(hardening) = &spec.bond.law else { unreachable!("the scene is plastic") };
    let yield_stress = hardening.stress(0.0);
    let axial = path.share * Section { radius: 0.5 * spec.wires[0].diameter, yield_stress }.plastic_force();
    let rates = if path.twist.is_finite() { [RATE, path.twist * RATE] } else { [0.0, RATE] };
    let spin = 0.5 * DVec3::new(rates[0], 0.0, rates[1]);
    let end = spec.stop.time.expect("the scene says when it ends");
    let scene = scene.changed(|spec| {
        (spec.holds[0].spin, spec.holds[1].spin) = (-spin, spin);
        spec.holds[1].force.z = axial;
    });
    let mut simulation = context.simulation_of(scene)?;
    let bar = simulation.bar();
    simulation.run_to(0.6 * end, |_| {})?;
    let a = look(&simulation.engine, &bar, yield_stress, rates);
    simulation.run_to(end, |_| {})?;
    let b = look(&simulation.engine, &bar, yield_stress, rates);
    let spent = simulation.finish();
    let exact = b.section.flow(axial, path.twist);
    let [before, after] = [a, b].map(|i| i.section.flow(axial, path.twist).elongation);
    let Path { share, twist } = path;
    let how = match *twist {
        0.0 => "bent".to_string(),
        t if t.is_finite() => format!("bent and twisted 1 : {t}"),
        _ => "twisted".to_string(),
    };
    let name = |what: &str| format!("{what}, N = {share} N_p, {how}");
    let mut found = Vec::new();
    if exact.moment > 0.0 {
        found.push(Comparison::new(name("moment"), "N m", b.moment, exact.moment, spent));
    }
    if *twist > 0.0 {
        found.push(Comparison::new(name("torque"), "N m", b.torque, exact.torque, spent));
    }
    if *share > 0.0 {
        let rate = (b.elongation - a.elongation) / (b.angle - a.angle);
        found.push(Comparison::new(name("plastic elongation per angle"), "m/rad", rate, 0.5 * (before + after), spent));
    }
    Ok(found.into_iter().map(|f| f.within(5e-3)).collect())
}

/// The worst of those comparisons whose name begins with `what`.
fn worst(found: &[Comparison], what: &str) -> Comparison {
    Comparison::worst(found.iter().filter(|f| f.what.starts_with(what)).cloned().collect())
}

fn section(context: &Context) -> Result<Vec<Comparison>> {
    let twists = [0.0, 0.7, f64::INFINITY];
    let mut found = Vec::new();
    for share in context.pick(&[0.0, 0.6][..], &[0.0, 0.2, 0.4, 0.6, 0.8]) {
        for twist in twists {
            found.extend(follow(context, &Path { share: *share, twist })?);
        }
    }
    let unit = Section { radius: 1.0, yield_stress: 1.0 };
    let short = |share: f64| {
        let axial = share * unit.plastic_force();
        100.0 * (1.0 - unit.flow(axial, 0.0).moment / unit.exact_moment(axial))
    };
    let mut limits: Vec<Comparison> =
        ["moment", "torque", "plastic elongation"].iter().map(|what| worst(&found, what)).collect();
    limits[0].note = Some(format!(
        "The surface is an approximation of the round section, whose exact limit is N/N_p = (2/pi)(t + sin t cos t), \
         M/M_p = cos^3 t: it lies {:.1} % lower at N = 0.5 N_p and {:.1} % at 0.8 N_p.",
        short(0.5),
        short(0.8),
    ));
    Ok(limits)
}
