//! What a scene can be known to get wrong before it runs, for `plan` and `scene check`.

use super::spec::{BondLawSpec, BondSpec, DriveSpec, RuptureCriterion, Shape, Spec};

/// Plastic strain (-) beyond which no wire is followed.
const FAR: f64 = 1.0;
/// Wires in a strand are strained more than the strand, by up to this factor (-).
const UNEVEN: f64 = 1.1;
/// Spacing over diameter from which spheres of a wire leave a gap through which another wire fits crosswise (-).
const GAP: f64 = std::f64::consts::SQRT_2;

/// Everything that the user should know before the run; empty when there is nothing.
pub fn cautions(spec: &Spec) -> Vec<String> {
    [necking(spec), gaps(spec), saddles(spec)].into_iter().flatten().collect()
}

/// Plastic strain at which the hardening law reaches the maximum load of a bond in tension, dσ/dp ≤ σ (Considère 1885),
/// if it does so before bonds break and before the body has reached `strain` (-).
pub fn considere(spec: &Spec, strain: f64) -> Option<f64> {
    let each = spec.materials().filter_map(|one| considere_of(one.bond, strain));
    each.min_by(f64::total_cmp)
}

/// [`considere`] of one material.
pub fn considere_of(bond: &BondSpec, strain: f64) -> Option<f64> {
    let BondLawSpec::ElastoPlastic(hardening) = &bond.law else { return None };
    let breaks = match bond.rupture.as_ref().map(|r| &r.criterion) {
        Some(RuptureCriterion::PlasticStrain { strain }) => *strain,
        Some(RuptureCriterion::FibreStrain { strain }) => strain.ln_1p(),
        Some(RuptureCriterion::BeamStress { tensile, .. }) => reaches(|p| hardening.stress(p) >= *tensile),
        None => FAR,
    };
    hardening.considere(breaks.min(UNEVEN * strain.ln_1p()))
}

/// Least plastic strain at which `reached` holds, to a thousandth (-).
fn reaches(reached: impl Fn(f64) -> bool) -> f64 {
    (0..1000).map(|k| FAR * f64::from(k) / 1000.0).find(|p| reached(*p)).unwrap_or(FAR)
}

fn necking(spec: &Spec) -> Option<String> {
    let pulled = spec.grip.as_ref().is_some_and(|g| matches!(g.drive, DriveSpec::Speed(speed) if speed > 0.0));
    let from = considere(spec, spec.stop.strain.unwrap_or(f64::INFINITY)).filter(|_| pulled)?;
    Some(format!(
        "the hardening law passes the maximum load of a wire at a plastic strain of {:.1} % (dσ/dε ≤ σ, Considère), before \
         it breaks: strain then localises in single bonds, and elongation depends on spacing; use a law that still \
         rises at rupture, or compare runs with other values of spacing",
        100.0 * from
    ))
}

/// Touching spheres of one layer find no even ground on those of the next. The losses are this program's own, for 1×7
/// strands with unlike core and helical wires at 0.1 %, lay angles of 9 to 15°, against strand theory.
fn saddles(spec: &Spec) -> Option<String> {
    let spheres = spec.contact.as_ref().is_some_and(|c| c.shape == Shape::Sphere);
    let laid = spec.strand.as_ref().is_some_and(|s| s.layers.len() > 1);
    (spheres && laid).then(|| {
        format!(
            "contact.shape = \"sphere\" makes a strand too soft where its layers are out of register: outer spheres fall \
             into the saddles of the layer below. Measured loss of initial stiffness against strand theory: 37 to 63 % at \
             spacing = 1, about 9 % at 0.5, 2.5 % at 0.25 (here: {}); the summary of a run compares the two where it can",
            spec.spacing
        )
    })
}

fn gaps(spec: &Spec) -> Option<String> {
    let spheres = spec.contact.as_ref().is_some_and(|c| c.shape == Shape::Sphere);
    let wires = spec.wires.len() + spec.strand.as_ref().map_or(0, |s| s.layers.iter().map(|l| l.wires).sum());
    (spheres && wires > 1 && spec.spacing > GAP).then(|| {
        format!(
            "with spacing = {} the spheres of a wire leave gaps through which another wire fits; lower it to 1, or use \
             contact.shape = \"wire\"",
            spec.spacing
        )
    })
}
