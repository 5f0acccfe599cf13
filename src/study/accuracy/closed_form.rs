//! The exact answer of the one pulled scene that has one: a single straight wire. It strains evenly, so its curve is the
//! hardening law, and it breaks where its weakest bond's rupture strain is reached.

use super::errors::Truth;
use crate::base::units::{mm, mpa, percent};
use crate::engine::rupture::RuptureCheck;
use crate::observe::summary::Break;
use crate::reference::plasticity::{TensionPoint, considere_strain, tension_point};
use crate::run::assemble;
use crate::scene::Scene;
use crate::scene::spec::{
    BondLawSpec, DriveSpec, GripKind, HardeningSpec, PathSpec, RuptureCriterion, RuptureSpec, Spec, WireSpec,
};
use crate::strand::assembly::Assembly;
use crate::study::tensile::Curve;
use glam::DVec3;

/// Points of the elastic and of the plastic part of the curve.
const ELASTIC_POINTS: usize = 50;
const PLASTIC_POINTS: usize = 4000;

/// What the formula needs of a scene.
struct Wire<'a> {
    law: &'a HardeningSpec,
    rupture: &'a RuptureSpec,
    layer: &'a str,
}

/// The exact answer, or why the scene has none in closed form.
///
/// The strengths of the bonds are those that the run itself draws: what remains is the error of the simulation.
pub fn truth(scene: &Scene) -> Result<Truth, String> {
    let wire = Wire::of(&scene.spec)?;
    let assembly = assemble(scene).map_err(|e| e.to_string())?;
    let weakest = Weakest::of(&scene.spec, &wire, &assembly).ok_or("no bond is free between the grips")?;
    let stress = |p: f64| wire.law.stress(p);
    if considere_strain(stress, |p| wire.law.evaluate(p).1, weakest.strain).is_some() {
        return Err("the wire necks before it breaks, so it does not strain evenly (Considère)".into());
    }
    let young = scene.spec.material.young;
    let end = tension_point(weakest.strain, stress(weakest.strain), young);
    if scene.spec.stop.strain.is_some_and(|stop| stop < end.engineering_strain) {
        return Err("the scene stops before the wire breaks".into());
    }
    let volume = assembly.wires[0].area() * weakest.free_length;
    let breaks = vec![Break {
        order: 1,
        wire: 1,
        layer: wire.layer.into(),
        material: None,
        z_mm: mm(weakest.rest_z),
        rest_z_mm: mm(weakest.rest_z),
        strain_percent: percent(end.engineering_strain),
        stress_mpa: mpa(end.true_stress),
        cause: "plastic strain".into(),
    }];
    Ok(Truth {
        strength_mpa: mpa(end.engineering_stress),
        elongation_percent: percent(end.engineering_strain),
        curve: curve(stress, young, weakest.strain, volume),
        breaks,
    })
}

/// In a sentence.
pub const WORDS: &str = "closed form: one wire strains evenly along its hardening law until its weakest bond's plastic \
                         strain at rupture is reached (each run against the strengths that it draws)";

/// The curve up to plastic strain `last` (-) of a wire of this free `volume` (m³).
fn curve(stress: impl Fn(f64) -> f64, young: f64, last: f64, volume: f64) -> Curve {
    let mut curve = Curve { layer_stress_mpa: vec![Vec::new()], ..Curve::default() };
    let mut push = |point: TensionPoint, work: f64| {
        curve.strain.push(point.engineering_strain);
        curve.stress_mpa.push(mpa(point.engineering_stress));
        curve.plastic_work_j.push(work);
        curve.layer_stress_mpa[0].push(mpa(point.engineering_stress));
    };
    for i in 0..ELASTIC_POINTS {
        push(tension_point(0.0, stress(0.0) * i as f64 / ELASTIC_POINTS as f64, young), 0.0);
    }
    // What force times path leaves in plastic strain: s de with e = e^ε − 1 and s = σ e^(−p) is σ e^(σ/E) dε.
    let density = |p: f64| stress(p) * (stress(p) / young).exp();
    let step = last / PLASTIC_POINTS as f64;
    let mut work = 0.0;
    for i in 0..=PLASTIC_POINTS {
        let p = step * i as f64;
        if i > 0 {
            work += 0.5 * (density(p - step) + density(p)) * step * volume;
        }
        push(tension_point(p, stress(p), young), work);
    }
    curve
}

impl<'a> Wire<'a> {
    fn of(spec: &'a Spec) -> Result<Self, String> {
        let [wire] = &spec.wires[..] else { return Err("the scene is not a single wire".into()) };
        if spec.strand.is_some() || !spec.spheres.is_empty() {
            return Err("the scene is not a single wire".into());
        }
        if !is_straight_and_still(wire) || !spec.holds.is_empty() || !is_pulled(spec) {
            return Err("the wire is not straight along z, or something else than a steady pull acts on it".into());
        }
        let BondLawSpec::ElastoPlastic(law) = &spec.bond.law else {
            return Err("the wire is elastic".into());
        };
        match &spec.bond.rupture {
            Some(rupture) if matches!(rupture.criterion, RuptureCriterion::PlasticStrain { .. }) => {
                Ok(Self { law, rupture, layer: &wire.layer })
            }
            _ => Err("the wire does not break at a plastic strain".into()),
        }
    }
}

fn is_straight_and_still(wire: &WireSpec) -> bool {
    let along_z = matches!(&wire.path, PathSpec::Straight { from, to } if from.x == to.x && from.y == to.y);
    along_z && wire.velocity == DVec3::ZERO && wire.spin == DVec3::ZERO
}

fn is_pulled(spec: &Spec) -> bool {
    spec.grip.as_ref().is_some_and(|grip| {
        let speed = matches!(grip.drive, DriveSpec::Speed(speed) if speed > 0.0);
        speed && grip.kind == GripKind::All && grip.rotation_rate == 0.0 && !grip.free_rotation
    })
}

/// The bond that breaks first.
struct Weakest {
    /// Plastic strain at which it does (-).
    strain: f64,
    /// Where it is before loading (m).
    rest_z: f64,
    /// Length of all bonds between the grips (m).
    free_length: f64,
}

impl Weakest {
    fn of(spec: &Spec, wire: &Wire, assembly: &Assembly) -> Option<Self> {
        let check = RuptureCheck::new(wire.rupture, spec.seed, assembly);
        let limits = check.plastic_limit()?;
        let z = &assembly.position.z;
        let (low, high) = z.iter().fold((f64::MAX, f64::MIN), |(a, b), z| (a.min(*z), b.max(*z)));
        let grip = spec.grip.as_ref()?.length;
        // The particle nearest to a grip's face is the last one held, so a bond is free when its centre is.
        let centre = |slot: usize| 0.5 * (z[slot] + z[slot + 1]);
        let between = |slot: &usize| (low + grip..=high - grip).contains(&centre(*slot));
        let free: Vec<usize> = assembly.wires[0].bonds().filter(between).collect();
        let weakest = free.iter().copied().min_by(|a, b| limits[*a].total_cmp(&limits[*b]))?;
        Some(Self {
            strain: limits[weakest],
            rest_z: centre(weakest),
            free_length: free.iter().map(|slot| assembly.rest_length[*slot]).sum(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    fn of(name: &str, options: &[&str]) -> Result<Truth, String> {
        let options: Vec<String> = options.iter().map(|text| text.to_string()).collect();
        truth(&scene::load(name, &options).unwrap())
    }

    /// σ₀ + Q(1 − e^(−bp)) + Hp at the stated rupture strain, without scatter; plastic work is its integral.
    #[test]
    fn without_scatter_it_is_the_law_at_the_stated_strain() {
        let truth = of("single-wire", &["bond.rupture.weibull_modulus=inf"]).unwrap();
        let p = 0.28314_f64;
        let stress = 100.0 + 177.4 * (1.0 - (-12.0 * p).exp()) + 541.8 * p;
        let strain = (p + stress / 115e3).exp_m1();
        assert!((truth.strength_mpa / (stress * (-p).exp()) - 1.0).abs() < 1e-12, "{}", truth.strength_mpa);
        assert!((truth.elongation_percent - 100.0 * strain).abs() < 1e-9);
        assert!((truth.curve.end() - strain).abs() < 1e-12);
        let integral = (100.0 + 177.4) * p - 177.4 / 12.0 * (1.0 - (-12.0 * p).exp()) + 0.5 * 541.8 * p * p;
        let volume = std::f64::consts::PI * 0.195e-3_f64.powi(2) * 0.1;
        let work = truth.curve.plastic_work_j.last().unwrap() / (integral * 1e6 * volume);
        // Elastic stretch lengthens the path by σ/E, 0.2 to 0.4 %; the free length may be half a bond off the gauge.
        assert!((work - 1.003).abs() < 4e-3, "{work}");
    }

    #[test]
    fn scatter_moves_the_break_with_the_seed() {
        let [one, two] = ["seed=1", "seed=2"].map(|seed| of("single-wire", &[seed]).unwrap());
        assert_ne!(one.breaks[0].rest_z_mm, two.breaks[0].rest_z_mm);
        assert_ne!(one.elongation_percent, two.elongation_percent);
    }

    #[test]
    fn scenes_without_a_closed_form_say_why() {
        for (name, options, why) in [
            ("strand-1x7", &[][..], "not a single wire"),
            ("single-wire", &["stop.strain=10 %"], "stops before"),
            ("single-wire", &["bond.hardening={ form = \"voce\", yield_stress = \"200 MPa\" }"], "necks"),
            ("single-wire", &["grip.rotation_rate=10 rad/s"], "steady pull"),
            ("single-wire", &["bond.rupture=", "stop.stress_fraction="], "does not break"),
        ] {
            let found = of(name, options).unwrap_err();
            assert!(found.contains(why), "{name} {options:?}: {found}");
        }
    }
}
