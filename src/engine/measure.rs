//! What is measured: nominal stress, stresses per wire and layer, energies, snapshots for those who draw and record.

use super::Engine;
use super::bonds::Bonds;
use super::grips::{Holds, Reaction};
use super::saved::{Reader, Unfit, Writer};
use super::view::{BondState, Energy, RunInfo, Sample, Snapshot, WireInfo};
use crate::reference::helix;
use crate::scene::spec::{BondLawSpec, DriveSpec, GripKind, RuptureCriterion, Spec};
use crate::strand::assembly::Assembly;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::ops::Range;

/// Window of the running means, over the time in which an elastic wave runs along the body (-).
const WINDOW: f64 = 0.125;
/// By how much strain and stress of a row lag behind its instant, over the same time: the middle of the window (-).
pub const MEAN_LAG: f64 = 0.5 * WINDOW;

/// Running means of what a row of the curve says, and who is broken.
///
/// Everything is the mean over the same last L/(8c), an eighth of an elastic wave's way along the body: strain, grip forces,
/// torque and the forces in the wires. A mean lags by half its window behind what grows evenly. Since strain lags as stress
/// does, the curve keeps its phase, and modulus can be read from it at any speed; it rounds off a yield point by half the
/// strain that the grip brings in a window, v/(16c). A window takes out what neighbouring particles ring; the ringing of
/// the body as a whole, of a period of 2L/c, stays.
pub struct Measures {
    /// Length of the window (s).
    window: f64,
    area: f64,
    /// The steps in the window.
    steps: VecDeque<Step>,
    /// Sums over them of length, and of values times length.
    sum: Step,
    /// Bonds in the middle of each wire, whose mean is the wire's stress; wire by wire.
    middle: Vec<usize>,
    /// Those of each wire among them.
    of_wire: Vec<Range<usize>>,
    broken: Vec<bool>,
}

/// What was measured at one step, times its length.
#[derive(Default, Clone, Serialize, Deserialize)]
struct Step {
    /// (s)
    length: f64,
    /// Strain (-), force of the lower and upper grip (N), torque (N m), axial force of each middle bond (N); each times s.
    values: Vec<f64>,
}

const STRAIN: usize = 0;
const FORCE: usize = 1;
const TORQUE: usize = 3;
const BONDS: usize = 4;

impl Measures {
    /// For `assembly` between `holds`.
    pub fn new(spec: &Spec, assembly: &Assembly, holds: &Holds) -> Self {
        let gauge = holds.stretch.gauge;
        let (mut slots, mut of_wire) = (Vec::new(), Vec::new());
        for w in 0..assembly.wires.len() {
            let first = slots.len();
            slots.extend(middle(assembly, w, gauge));
            of_wire.push(first..slots.len());
        }
        Self {
            window: WINDOW * passage(spec, assembly),
            area: assembly.area,
            steps: VecDeque::new(),
            sum: Step { length: 0.0, values: vec![0.0; BONDS + slots.len()] },
            middle: slots,
            of_wire,
            broken: vec![false; assembly.wires.len()],
        }
    }

    /// Takes in a step of `dt` (s): the grips' reactions, the strain (-) and the bonds' forces, all at one instant.
    pub fn take(&mut self, strain: f64, now: &Reaction, bonds: Option<&dyn Bonds>, dt: f64) {
        let mut step = Step::default();
        while self.steps.front().is_some_and(|first| self.sum.length + dt - first.length >= self.window) {
            step = self.steps.pop_front().unwrap_or_default();
            self.sum.length -= step.length;
            self.sum.values.iter_mut().zip(&step.values).for_each(|(sum, value)| *sum -= value);
        }
        if self.steps.is_empty() {
            // No rounding is left of what has gone.
            self.sum.length = 0.0;
            self.sum.values.fill(0.0);
        }
        step.length = dt;
        step.values.clear();
        step.values.extend([strain, now.force[0], now.force[1], now.torque].map(|value| value * dt));
        step.values.extend(self.middle.iter().map(|slot| bonds.map_or(0.0, |bonds| bonds.axial_force(*slot) * dt)));
        self.sum.length += dt;
        self.sum.values.iter_mut().zip(&step.values).for_each(|(sum, value)| *sum += value);
        self.steps.push_back(step);
    }

    fn mean(&self, value: usize) -> f64 {
        if self.sum.length > 0.0 { self.sum.values[value] / self.sum.length } else { 0.0 }
    }

    /// Strain of the body: grip displacement over the length that is free between the grips (-).
    pub fn strain(&self) -> f64 {
        self.mean(STRAIN)
    }

    /// Nominal stress: upper grip force over the copper area (Pa).
    pub fn stress(&self) -> f64 {
        if self.area > 0.0 { self.mean(FORCE + 1) / self.area } else { 0.0 }
    }

    /// Axial force of a wire (N): mean over the bonds in the middle of the gauge, in which a broken one counts with zero
    /// from the moment at which it broke, whatever it carried before.
    fn wire_force(&self, wire: usize, whole: &[bool]) -> f64 {
        let range = self.of_wire[wire].clone();
        let count = range.len().max(1) as f64;
        range.filter(|i| whole[self.middle[*i]]).map(|i| self.mean(BONDS + i)).sum::<f64>() / count
    }

    /// Puts in what was measured so far.
    pub fn save(&self, out: &mut Writer) {
        out.put(&self.steps);
        out.put(&self.sum);
        out.put(&self.broken);
    }

    /// Takes up what [`Self::save`] has put in.
    ///
    /// # Errors
    /// [`Unfit`] when it is of another body.
    pub fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit> {
        let values = self.sum.values.len();
        (self.steps, self.sum) = (from.take()?, from.take()?);
        if self.steps.iter().chain([&self.sum]).any(|step| step.values.len() != values) {
            return Err(Unfit("its measures are those of other wires".into()));
        }
        from.take_into(&mut self.broken)
    }

    /// Marks a wire as broken; true when it was whole.
    pub fn mark_broken(&mut self, wire: usize) -> bool {
        !std::mem::replace(&mut self.broken[wire], true)
    }
}

/// Time in which an elastic wave runs along the body (s).
fn passage(spec: &Spec, assembly: &Assembly) -> f64 {
    assembly.length / (spec.material.young / (spec.material.density * spec.time.mass_scale)).sqrt()
}

/// Bonds of wire `w` within a fortieth of the gauge around its middle, at least one.
fn middle(assembly: &Assembly, w: usize, gauge: [f64; 2]) -> Vec<usize> {
    let wire = &assembly.wires[w];
    let z = |slot: usize| 0.5 * (assembly.position.z[slot] + assembly.position.z[slot + 1]);
    let bonds = wire.bonds();
    if bonds.is_empty() {
        return Vec::new();
    }
    let half = wire.first + wire.len / 2;
    if gauge[1] <= gauge[0] {
        return vec![half.min(bonds.end - 1)];
    }
    let centre = 0.5 * (gauge[0] + gauge[1]);
    let near: Vec<usize> = bonds.clone().filter(|s| (z(*s) - centre).abs() <= 0.025 * (gauge[1] - gauge[0])).collect();
    if near.is_empty() {
        bonds.min_by(|a, b| (z(*a) - centre).abs().total_cmp(&(z(*b) - centre).abs())).into_iter().collect()
    } else {
        near
    }
}

impl Engine {
    /// A row of the curve.
    pub fn sample(&self) -> Sample {
        let wire_stress: Vec<f64> = (0..self.assembly.wires.len()).map(|w| self.wire_stress(w)).collect();
        let layer_stress = (0..self.assembly.layers.len())
            .map(|layer| {
                let of_layer = || (0..wire_stress.len()).filter(|w| self.assembly.wires[*w].layer == layer);
                of_layer().map(|w| wire_stress[w]).sum::<f64>() / of_layer().count().max(1) as f64
            })
            .collect();
        Sample {
            step: self.state.step,
            time: self.state.time,
            strain: self.strain(),
            stress: self.stress(),
            grip_force: [0, 1].map(|grip| self.measures.mean(FORCE + grip)),
            torque: self.measures.mean(TORQUE),
            layer_stress,
            wire_stress,
            wires_broken: self.measures.broken.iter().filter(|b| **b).count(),
            bonds_broken: self.rupture_count,
            contacts: self.contacts.as_ref().map_or(0, |c| c.stage.active()),
            time_step: self.next_dt,
            energy: self.energy(),
        }
    }

    /// Nominal axial stress of a wire at mid-gauge (Pa): the mean over its bonds in the middle twentieth of the gauge, of
    /// which those that are broken carry nothing. A wire that broke there reports what its pieces still carry by friction.
    pub fn wire_stress(&self, wire: usize) -> f64 {
        self.measures.wire_force(wire, &self.state.whole) / self.assembly.wires[wire].area()
    }

    /// The energy ledger now.
    pub fn energy(&self) -> Energy {
        Energy {
            work: self.holds.work_now(&self.state),
            kinetic: self.kinetic(),
            elastic_bonds: self.bonds.as_ref().map_or(0.0, |b| b.elastic_energy(&self.state)),
            elastic_contacts: self.contacts.as_ref().map_or(0.0, |c| c.stage.elastic_energy(&self.state)),
            ..self.energy
        }
    }

    /// Kinetic energy now (J). Leapfrog's is a product of two velocities half a step apart, which rounding errors in a body
    /// at rest turn round at every step: what is negative by less than a negligible energy is rest.
    fn kinetic(&self) -> f64 {
        let kinetic = self.holds.kinetic(&self.state);
        if kinetic < 0.0 && -kinetic <= self.negligible_energy() { 0.0 } else { kinetic }
    }

    /// An energy that is nothing (J): what an elastic strain of 1e-9 everywhere would store.
    pub fn negligible_energy(&self) -> f64 {
        const STRAIN: f64 = 1e-9;
        let volume = self.assembly.mass.iter().sum::<f64>() / (self.spec.material.density * self.spec.time.mass_scale);
        0.5 * self.spec.material.young * STRAIN * STRAIN * volume
    }

    /// Every particle.
    pub fn snapshot(&self) -> Snapshot {
        let state = &self.state;
        let n = state.len();
        let mut bond_state = vec![BondState::Absent; n];
        let mut bond_stress = vec![0.0; n];
        let mut plastic_strain = vec![0.0; n];
        let mut utilisation = vec![0.0; n];
        if let Some(bonds) = &self.bonds {
            for slot in (0..n).filter(|s| self.assembly.is_bond(*s)) {
                let p = bonds.plastic_strain(slot);
                plastic_strain[slot] = p as f32;
                bond_stress[slot] = (bonds.stress(slot) * 1e-6) as f32;
                utilisation[slot] = if state.whole[slot] { bonds.utilisation(slot, state) as f32 } else { 1.0 };
                bond_state[slot] = match (state.whole[slot], p > 0.0) {
                    (false, _) => BondState::Broken,
                    (true, true) => BondState::Yielding,
                    (true, false) => BondState::Whole,
                };
            }
        }
        Snapshot {
            sample: self.sample(),
            position: state.x.iter().map(millimetres).collect(),
            radius: state.radius.iter().map(|r| (r * 1e3) as f32).collect(),
            speed: state.v.iter().map(|v| v.length() as f32).collect(),
            bond_state,
            bond_stress,
            plastic_strain,
            utilisation,
            contact_pressure: self.contact_pressure(),
        }
    }

    /// [`Snapshot::contact_pressure`] (MPa).
    fn contact_pressure(&self) -> Vec<f32> {
        let mut force = vec![0.0; self.state.len()];
        if let Some(contacts) = &self.contacts {
            contacts.stage.add_normal_forces(&mut force);
        }
        force.iter().enumerate().map(|(i, f)| (f / shown_area(&self.assembly, i) * 1e-6) as f32).collect()
    }

    /// What does not change during the run.
    pub fn info(&self) -> RunInfo {
        let a = &self.assembly;
        let gauge = self.holds.stretch.gauge;
        let (stress_range, plastic_strain_range) = self.ranges();
        RunInfo {
            name: self.spec.name.clone(),
            about: self.spec.about.clone(),
            layers: a.layers.iter().map(|l| l.name.clone()).collect(),
            wires: a
                .wires
                .iter()
                .map(|w| WireInfo { layer: w.layer, first: w.first, len: w.len, diameter: (w.diameter * 1e3) as f32 })
                .collect(),
            wire_particles: a.wire_particles,
            particles: a.len(),
            radius: a.radius.iter().map(|r| (r * 1e3) as f32).collect(),
            rest_position: a.position.iter().map(millimetres).collect(),
            gauge: (gauge[1] > gauge[0]).then(|| gauge.map(|z| (z * 1e3) as f32)),
            stress_range,
            plastic_strain_range,
            speed_range: [0.0, self.greatest_speed() as f32],
            contact_pressure_range: [0.0, self.contact_pressure_range(stress_range[1])],
            strain_end: self.strain_end(),
            negligible_energy: self.negligible_energy(),
            wave_passage: passage(&self.spec, a),
        }
    }

    /// The strain at which bonds are expected to break (-); infinite when they never do.
    pub(super) fn rupture_strain(&self) -> f64 {
        match self.spec.bond.rupture.as_ref().map(|r| &r.criterion) {
            // True plastic strain to engineering strain.
            Some(RuptureCriterion::PlasticStrain { strain }) => strain.exp_m1(),
            Some(RuptureCriterion::FibreStrain { strain }) => *strain,
            Some(RuptureCriterion::BeamStress { tensile, .. }) => tensile / self.spec.material.young,
            None => f64::INFINITY,
        }
    }

    fn strain_end(&self) -> Option<f64> {
        let gauge = self.holds.stretch.gauge;
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
        let end = if ends_broken { stop.min(1.1 * self.rupture_strain()) } else { stop };
        end.is_finite().then_some(end)
    }

    /// Fixed ranges of true axial stress (MPa) and plastic strain (-) that the run will not leave.
    fn ranges(&self) -> ([f32; 2], [f32; 2]) {
        let strain = self.strain_end().unwrap_or(0.0).min(self.rupture_strain());
        match &self.spec.bond.law {
            BondLawSpec::ElastoPlastic(h) => {
                let p = if strain > 0.0 { strain.ln_1p() } else { 0.01 };
                let top = round_up(h.stress(p) * 1e-6);
                ([0.0, top as f32], [0.0, round_up(p) as f32])
            }
            BondLawSpec::Elastic => {
                let impact = self.spec.material.young * self.greatest_speed()
                    / (self.spec.material.young / self.spec.material.density).sqrt();
                let pulled = self.spec.material.young * strain.abs();
                let top = round_up(pulled.max(impact).max(1e6) * 1e-6) as f32;
                ([-top, top], [0.0, 1.0])
            }
        }
    }

    /// Nominal axial stress of a wire strained by `strain` (-), by its bond law alone (Pa).
    pub(super) fn nominal_stress(&self, strain: f64) -> f64 {
        let elastic = self.spec.material.young * strain;
        match &self.spec.bond.law {
            BondLawSpec::Elastic => elastic,
            // True stress over stretch, with an incompressible wire.
            BondLawSpec::ElastoPlastic(h) => elastic.min(h.stress(strain.ln_1p()) / (1.0 + strain)),
        }
    }

    /// Upper end of a range of contact pressure (MPa); `stress` is that of the range of axial stress (MPa).
    ///
    /// A wire under tension N presses inwards with N κ per length, κ = sin²β/R its curvature; a layer carries what
    /// all layers from itself outwards press, and feels it from both sides. As the strand stretches by λ its lay
    /// radii shrink as λ^(−1/2) and its pitch grows as λ, so κ ≈ R (2π/h)² falls as λ^(−5/2), and each particle
    /// answers for a length that grows as λ: the pressure goes with the nominal stress over λ^(3/2). A jaw adds its
    /// own pressure.
    fn contact_pressure_range(&self, stress: f32) -> f32 {
        let a = &self.assembly;
        let end = self.strain_end().unwrap_or(0.0).min(self.rupture_strain()).max(0.0);
        let pressing = |strain: f64| self.nominal_stress(strain) * 1e-6 / (1.0 + strain).powf(1.5);
        let tension = (0..=50).map(|k| pressing(end * f64::from(k) / 50.0)).fold(0.0, f64::max);
        let (mut press, mut deepest) = (0.0, 0.0f64);
        for (k, layer) in a.layers.iter().enumerate().rev() {
            let wires = a.wires.iter().filter(|w| w.layer == k);
            let (count, Some(wire)) = (wires.clone().count(), wires.clone().next()) else { continue };
            if layer.lay_radius > 0.0 && layer.pitch.is_finite() {
                press += count as f64 * tension * wire.area() * helix::curvature(layer.lay_radius, layer.pitch);
            }
            deepest = deepest.max(2.0 * press / (count as f64 * wire.diameter));
        }
        let jaw = match self.spec.grip.as_ref().map(|g| g.kind) {
            Some(GripKind::Jaw { pressure }) => 2e-6 * pressure,
            _ => 0.0,
        };
        let top = deepest.max(jaw);
        round_up(if top > 0.0 { top } else { 0.1 * f64::from(stress.abs()) }) as f32
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

/// Area that particle `i` shows to its neighbours (m²): d a in a wire, π r² for a free sphere.
fn shown_area(a: &Assembly, i: usize) -> f64 {
    let d = 2.0 * a.radius[i];
    if i >= a.wire_particles {
        return std::f64::consts::FRAC_PI_4 * d * d;
    }
    // The last particle of a wire has its bond before it.
    let spacing = if a.is_bond(i) || i == 0 { a.rest_length[i] } else { a.rest_length[i - 1] };
    d * spacing
}

fn millimetres(p: glam::DVec3) -> [f32; 3] {
    (p * 1e3).as_vec3().to_array()
}

/// The next round number (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 × a power of ten) at or above `value`.
fn round_up(value: f64) -> f64 {
    let scale = 10f64.powf(value.log10().floor());
    let round = [1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 10.0];
    round.into_iter().map(|r| r * scale).find(|r| *r >= value * (1.0 - 1e-9)).unwrap_or(value)
}
