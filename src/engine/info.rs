//! What those who draw and record must know before the first step: names, sizes, and ranges that a run will not leave.

use super::estimates::{last_rupture_strain, negligible_energy, nominal_stress, rupture_strain_of, wave_passage};
use super::view::{BodyInfo, BodyShape, RunInfo, WireInfo};
use crate::reference::helix;
use crate::scene::spec::{BondLawSpec, DriveSpec, GripKind, OneMaterial, RigidShape, RigidSpec, Spec};
use crate::strand::assembly::{Assembly, Wire};

/// What does not change during a run; `gauge` is z of the two grip faces before loading (m), alike when there are none.
pub fn info(spec: &Spec, assembly: &Assembly, gauge: [f64; 2]) -> RunInfo {
    Body { spec, assembly, gauge }.info()
}

/// A rigid body for those who draw it.
fn rigid(spec: &RigidSpec) -> BodyInfo {
    let axis = spec.shape.axis().to_array();
    let shape = match spec.shape {
        RigidShape::Plane { .. } => BodyShape::Plane { normal: axis },
        RigidShape::Cylinder { diameter, length, .. } => BodyShape::Cylinder { axis, radius: 0.5 * diameter, length },
        RigidShape::Sphere { diameter, .. } => BodyShape::Sphere { radius: 0.5 * diameter },
    };
    BodyInfo { name: spec.name.clone(), shape }
}

/// A body before loading.
struct Body<'a> {
    spec: &'a Spec,
    assembly: &'a Assembly,
    gauge: [f64; 2],
}

impl Body<'_> {
    /// What does not change during the run.
    fn info(&self) -> RunInfo {
        let (a, gauge) = (self.assembly, self.gauge);
        let (stress_range, plastic_strain_range) = self.ranges();
        RunInfo {
            name: self.spec.name.clone(),
            about: self.spec.about.clone(),
            layers: a.layers.iter().map(|l| l.name.clone()).collect(),
            sphere_material: a.sphere_material.clone(),
            materials: self.spec.materials().map(|one| one.label().to_owned()).collect(),
            wires: a
                .wires
                .iter()
                .map(|w| WireInfo {
                    layer: w.layer,
                    material: w.material,
                    first: w.first,
                    len: w.len,
                    diameter: w.diameter,
                })
                .collect(),
            wire_particles: a.wire_particles,
            particles: a.len(),
            bodies: self.spec.rigids.iter().map(rigid).collect(),
            radius: a.radius.iter().map(|r| *r as f32).collect(),
            rest_position: a.position.iter().map(|x| x.as_vec3().to_array()).collect(),
            gauge: (gauge[1] > gauge[0]).then_some(gauge),
            stress_range,
            plastic_strain_range,
            speed_range: [0.0, self.greatest_speed()],
            contact_pressure_range: [0.0, self.contact_pressure_range(stress_range[1])],
            strain_end: self.strain_end(),
            body_stress_end: self.spec.has_several_materials().then(|| self.body_stress_end()),
            negligible_energy: negligible_energy(self.spec, a),
            wave_passage: wave_passage(self.spec, a),
        }
    }

    fn strain_end(&self) -> Option<f64> {
        let gauge = self.gauge;
        if gauge[1] <= gauge[0] {
            return None;
        }
        let DriveSpec::Speed(speed) = self.spec.grip.as_ref()?.drive else { return self.spec.stop.strain };
        if speed == 0.0 {
            return self.spec.stop.strain;
        }
        // An adaptive pull comes at most this far in its time.
        let speed = self.spec.grip.as_ref()?.adaptive.as_ref().map_or(speed, |adaptive| adaptive.fastest);
        let timed = self.spec.stop.time.map_or(f64::INFINITY, |t| t * speed.abs() / (gauge[1] - gauge[0]));
        let stop = self.spec.stop.strain.unwrap_or(f64::INFINITY).min(timed);
        if speed < 0.0 {
            // Compression ends where it is told to: nothing foretells at which strain a wire breaks in it.
            return stop.is_finite().then_some(-stop);
        }
        let ends_broken = self.spec.stop.stress_fraction.is_some() || self.spec.stop.strain_after_drop.is_some();
        let end = if ends_broken { stop.min(1.1 * last_rupture_strain(self.spec)) } else { stop };
        end.is_finite().then_some(end)
    }

    /// Greatest nominal stress of the body (Pa) if all wires are strained as it is, and those of a material carry nothing beyond
    /// the strain at which its bonds break.
    fn body_stress_end(&self) -> f64 {
        let a = self.assembly;
        let end = self.strain_end().unwrap_or(0.0).max(0.0);
        let force = |strain: f64| {
            let of = |wire: &Wire| {
                let one = self.spec.material_at(wire.material);
                let carries = strain <= rupture_strain_of(one);
                if carries { nominal_stress(one, strain) * wire.area() } else { 0.0 }
            };
            a.wires.iter().map(of).sum::<f64>()
        };
        let most = (0..=200).map(|k| force(end * f64::from(k) / 200.0)).fold(0.0, f64::max);
        if most > 0.0 { round_up(most / a.area) } else { 0.0 }
    }

    /// Fixed ranges of true axial stress (Pa) and plastic strain (-) that the run will not leave.
    fn ranges(&self) -> ([f64; 2], [f64; 2]) {
        let each = self.spec.materials().map(|one| self.ranges_of(one));
        let wider = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.min(c), b.max(d)];
        each.reduce(|(stress, plastic), (more, further)| (wider(stress, more), wider(plastic, further)))
            .unwrap_or_default()
    }

    /// The same of one material.
    fn ranges_of(&self, one: OneMaterial) -> ([f64; 2], [f64; 2]) {
        let strain = self.strain_end().unwrap_or(0.0).min(rupture_strain_of(one));
        let OneMaterial { material, bond, .. } = one;
        match &bond.law {
            BondLawSpec::ElastoPlastic(h) => {
                let p = if strain > 0.0 { strain.ln_1p() } else { self.plastic_shear().unwrap_or(0.01) };
                ([0.0, round_up(h.stress(p))], [0.0, round_up(p)])
            }
            BondLawSpec::Elastic => {
                let impact = material.young * self.greatest_speed() / (material.young / material.density).sqrt();
                let pulled = material.young * strain.abs();
                let top = round_up(pulled.max(impact).max(1e6));
                ([-top, top], [0.0, 1.0])
            }
        }
    }

    /// Equivalent strain γ/√3 (von Mises) that the surface of a single straight wire has when a grip has turned to the end of
    /// the scene (-): γ = r θ / L. `None` where the grips do not turn, or more than one wire is turned.
    fn plastic_shear(&self) -> Option<f64> {
        let ([wire], [low, high]) = (&self.assembly.wires[..], self.gauge) else { return None };
        let turn = self.spec.grip.as_ref()?.rotation_rate.abs() * self.spec.stop.time?;
        let shear = 0.5 * wire.diameter * turn / (high - low);
        (shear > 0.0 && high > low).then(|| shear / 3f64.sqrt())
    }

    /// Upper end of a range of contact pressure (Pa); `stress` is that of the range of axial stress (Pa).
    ///
    /// A wire under tension N presses inwards with N κ per length, κ = sin²β/R its curvature; a layer carries what
    /// all layers from itself outwards press, and feels it from both sides. As the strand stretches by λ its lay
    /// radii shrink as λ^(−1/2) and its pitch grows as λ, so κ ≈ R (2π/h)² falls as λ^(−5/2), and each particle
    /// answers for a length that grows as λ: the pressure goes with the nominal stress over λ^(3/2). A jaw adds its
    /// own pressure.
    fn contact_pressure_range(&self, stress: f64) -> f64 {
        let a = self.assembly;
        let tension = |number: usize| {
            let one = self.spec.material_at(number);
            let end = self.strain_end().unwrap_or(0.0).min(rupture_strain_of(one)).max(0.0);
            let pressing = |strain: f64| nominal_stress(one, strain) / (1.0 + strain).powf(1.5);
            (0..=50).map(|k| pressing(end * f64::from(k) / 50.0)).fold(0.0, f64::max)
        };
        let (mut press, mut deepest) = (0.0, 0.0f64);
        for (k, layer) in a.layers.iter().enumerate().rev() {
            let wires = a.wires.iter().filter(|w| w.layer == k);
            let (count, Some(wire)) = (wires.clone().count(), wires.clone().next()) else { continue };
            if layer.lay_radius > 0.0 && layer.pitch.is_finite() {
                press += count as f64
                    * tension(wire.material)
                    * wire.area()
                    * helix::curvature(layer.lay_radius, layer.pitch);
            }
            deepest = deepest.max(2.0 * press / (count as f64 * wire.diameter));
        }
        let jaw = match self.spec.grip.as_ref().map(|g| g.kind) {
            Some(GripKind::Jaw { pressure }) => 2.0 * pressure,
            _ => 0.0,
        };
        let top = deepest.max(jaw);
        round_up(if top > 0.0 { top } else { 0.1 * stress.abs() })
    }

    fn greatest_speed(&self) -> f64 {
        let prescribed = self.spec.grip.as_ref().map_or(0.0, |g| match g.drive {
            DriveSpec::Speed(v) => g.adaptive.as_ref().map_or(v.abs(), |adaptive| adaptive.fastest),
            DriveSpec::Cyclic { amplitude, frequency } => std::f64::consts::TAU * frequency * amplitude,
        });
        let free = self.assembly.velocity.iter().map(|v| v.length()).fold(0.0, f64::max);
        let held = self.spec.holds.iter().map(|h| h.velocity.length()).fold(0.0, f64::max);
        let fastest = prescribed.max(free).max(held);
        if fastest > 0.0 { fastest } else { 1.0 }
    }
}

/// The next round number (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 × a power of ten) at or above `value`.
fn round_up(value: f64) -> f64 {
    let scale = 10f64.powf(value.log10().floor());
    let round = [1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 10.0];
    round.into_iter().map(|r| r * scale).find(|r| *r >= value * (1.0 - 1e-9)).unwrap_or(value)
}
