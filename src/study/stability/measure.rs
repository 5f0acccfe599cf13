//! What a run is asked for, and the number it must give.

use crate::base::finding::{FindingKind, Notice};
use crate::engine::Engine;
use crate::engine::view::{Rupture, Sample};
use crate::reference::column::Column;
use crate::reference::helix::lay_angle;
use crate::reference::hertz::Pair;
use crate::reference::plasticity::{Section, tension_at};
use crate::reference::strand::wire_strain;
use crate::scene::spec::{BondLawSpec, DriveSpec, Shape, Spec};
use crate::strand::assembly::Assembly;
use crate::strand::lay_radius::GREATEST_OVERLAP;
use crate::strand::overlap::{self, Body};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::Range;

/// Bodies up to this many particles have their positions kept at every row.
const TRACKED: usize = 32;

/// A number that a case must give.
pub type Check = fn(&CompletedRun) -> Answer;

/// How near a number must come.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Accept {
    /// Within this share of the exact one (-).
    Within(f64),
    /// Within this much of it, in its unit.
    Absolute(f64),
    /// Below it; within this share when one is given (-).
    Below(Option<f64>),
}

/// A number and what it should be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// What it is.
    pub what: Cow<'static, str>,
    /// Its unit.
    pub unit: Cow<'static, str>,
    /// The computed one.
    pub computed: f64,
    /// The exact or theoretical one.
    pub exact: f64,
    /// How near they must be.
    pub accept: Accept,
}

impl Answer {
    /// 100 × (computed/exact − 1) (%); `None` where the exact value is zero.
    pub fn error_percent(&self) -> Option<f64> {
        (self.exact != 0.0).then(|| 100.0 * (self.computed / self.exact - 1.0))
    }

    /// How the computed number must lie to the exact one, in a word or two.
    pub fn relation(&self) -> &'static str {
        match self.accept {
            Accept::Below(_) => "below",
            Accept::Within(_) | Accept::Absolute(_) => "must be",
        }
    }

    /// What is wrong with it, if it is not near enough.
    pub fn miss(&self) -> Option<String> {
        let Self { what, unit, .. } = self;
        let (computed, exact) = (self.computed, self.exact);
        let ratio = computed / exact;
        let good = match self.accept {
            Accept::Within(share) => (ratio - 1.0).abs() <= share,
            Accept::Absolute(most) => (computed - exact).abs() <= most,
            Accept::Below(share) => ratio <= 1.0 && share.is_none_or(|share| ratio >= 1.0 - share),
        };
        (!good).then(|| format!("{what} {computed:.6e} {unit} instead of {exact:.6e}"))
    }
}

/// A run that came to its end.
pub struct CompletedRun {
    /// Its scene.
    pub spec: Spec,
    /// What it started from.
    pub assembly: Assembly,
    /// Its curve.
    pub rows: Vec<Sample>,
    /// Its ruptures.
    pub ruptures: Vec<Rupture>,
    /// What it found.
    pub notices: Vec<Notice>,
    /// Energy below which nothing happened (J).
    pub negligible: f64,
    /// Positions at each row (m), of small bodies only.
    pub track: Vec<Vec<DVec3>>,
    /// Least bound on the time step at any row (s).
    pub least_bound: f64,
    /// Positions (m) and velocities (m/s) at the end.
    pub end: [Vec<DVec3>; 2],
    /// Radii at the end (m).
    pub radius: Vec<f64>,
}

impl CompletedRun {
    /// Before the first step.
    pub fn start(spec: Spec, engine: &Engine) -> Self {
        let assembly = engine.assembly().clone();
        Self {
            spec,
            assembly,
            rows: Vec::new(),
            ruptures: Vec::new(),
            notices: Vec::new(),
            negligible: engine.info().negligible_energy,
            track: Vec::new(),
            least_bound: f64::INFINITY,
            end: Default::default(),
            radius: Vec::new(),
        }
    }

    /// Takes in a row; keeps the positions of a small body.
    pub fn row(&mut self, engine: &Engine, sample: Sample) {
        self.least_bound = self.least_bound.min(engine.time_step_bound());
        self.rows.push(sample);
        if self.assembly.len() <= TRACKED {
            self.track.push(engine.state().x.iter().collect());
        }
    }

    /// After the last step.
    pub fn finish(&mut self, engine: &Engine) {
        self.end = [engine.state().x.iter().collect(), engine.state().v.iter().collect()];
        self.radius = engine.state().radius.clone();
    }

    /// How far wires have got into each other at the end, where that is more than contact can explain: more than a tenth
    /// of the diameter, or half of it when the user was told that contacts are too deep. Whole wires only: the two ends
    /// of a break lay in each other before it.
    pub fn passed_through(&self) -> Option<String> {
        let shape = self.spec.contact.as_ref()?.shape;
        if !self.ruptures.is_empty() {
            return None;
        }
        let least = |range: Range<usize>| self.radius[range].iter().copied().fold(f64::MAX, f64::min);
        let body = |range: Range<usize>| Body { points: &self.end[0][range.clone()], radius: least(range) };
        let bodies: Vec<Body> = self.assembly.bodies().into_iter().map(body).collect();
        let interlock = match shape {
            // A crest in the saddle between two spheres, as far apart as they are now.
            Shape::Sphere => 1.0 - (1.0 - 0.25 * self.widest().min(2.0).powi(2)).sqrt(),
            Shape::Wire => 0.0,
        };
        let told = self.notices.iter().any(|notice| notice.finding.kind() == FindingKind::DeepContact);
        let crushed = if told { 0.5 } else { GREATEST_OVERLAP + interlock };
        let worst = overlap::deepest(&bodies, crushed)?;
        let [a, b] = worst.bodies.map(|body| body + 1);
        Some(format!("wires {a} and {b} are in each other by {:.0} % of the diameter", 100.0 * worst.share))
    }

    /// Longest bond at the end over the diameter there (-).
    fn widest(&self) -> f64 {
        let at = &self.end[0];
        let over = |slot: usize| at[slot].distance(at[slot + 1]) / (self.radius[slot] + self.radius[slot + 1]);
        (0..self.assembly.len()).filter(|slot| self.assembly.is_bond(*slot)).map(over).fold(0.0, f64::max)
    }

    fn last(&self) -> &Sample {
        self.rows.last().expect("a run has its first row at least")
    }

    fn diameter(&self) -> f64 {
        2.0 * self.assembly.radius[0]
    }

    /// Nominal stress of a wire at engineering strain `strain` (Pa).
    fn wire_stress(&self, strain: f64) -> f64 {
        let young = self.spec.material.young;
        match &self.spec.bond.law {
            BondLawSpec::Elastic => young * strain.ln_1p(),
            BondLawSpec::ElastoPlastic(law) => tension_at(strain, |p| law.stress(p), young).engineering_stress,
        }
    }

    /// σ_y before any plastic strain (Pa).
    fn first_yield(&self) -> f64 {
        match &self.spec.bond.law {
            BondLawSpec::Elastic => f64::INFINITY,
            BondLawSpec::ElastoPlastic(law) => law.stress(0.0),
        }
    }
}

/// Nominal stress of a strand or wire at `strain`, ends not turning (Pa): every wire at the strain that its helix gives
/// it, with the lay radius that its layer has at the end (Costello 1997, chapter 3, at finite strain).
fn nominal_stress(seen: &CompletedRun, strain: f64) -> f64 {
    let (mut force, mut area) = (0.0, 0.0);
    for (index, layer) in seen.assembly.layers.iter().enumerate() {
        let angle = lay_angle(layer.lay_radius, layer.pitch);
        let contraction = if layer.lay_radius > 0.0 { lay_radius_now(seen, index) / layer.lay_radius } else { 1.0 };
        let stretch = wire_strain(strain, angle, contraction);
        let cos = (1.0 + strain) * angle.cos() / (1.0 + stretch);
        for wire in seen.assembly.wires.iter().filter(|wire| wire.layer == index) {
            force += wire.area() * seen.wire_stress(stretch) * cos;
            area += wire.area();
        }
    }
    force / area
}

/// Mean distance of a layer's particles from the axis at the end, between the grips (m).
fn lay_radius_now(seen: &CompletedRun, layer: usize) -> f64 {
    let grip = seen.spec.grip.as_ref().map_or(0.0, |grip| grip.length);
    let gauge = grip..seen.assembly.length - grip;
    let wires = seen.assembly.wires.iter().filter(|wire| wire.layer == layer);
    let free = wires.flat_map(|wire| wire.particles()).filter(|p| gauge.contains(&seen.assembly.position.z[*p]));
    let radii: Vec<f64> = free.map(|p| seen.end[0][p].truncate().length()).collect();
    radii.iter().sum::<f64>() / radii.len() as f64
}

/// Stress of the axial dashpots in a steady pull (Pa): 2ξ√(k m*) × strain rate × length of a bond with k = EA/a and
/// m* = ρAa/2, over A: √2 ξ ρ c a ε̇.
fn viscous_stress(seen: &CompletedRun) -> f64 {
    let material = &seen.spec.material;
    let wave = (material.young / material.density).sqrt();
    let rate = seen.last().strain / seen.last().time;
    2.0_f64.sqrt() * seen.spec.bond.damping[0] * material.density * wave * seen.assembly.rest_length[0] * rate
}

/// Nominal stress at the end against strand theory; `within` covers clamped ends, gaps and interlocking spheres.
fn pulled_within(seen: &CompletedRun, within: f64) -> Answer {
    // The end's own ringing is taken out by the mean of the last twentieth of the curve, at the mean strain.
    let rows = &seen.rows[seen.rows.len() - (seen.rows.len() / 20).max(1)..];
    let mean = |of: fn(&Sample) -> f64| rows.iter().map(of).sum::<f64>() / rows.len() as f64;
    Answer {
        what: "stress at the end".into(),
        unit: "MPa".into(),
        computed: mean(|row| row.stress) * 1e-6,
        exact: (nominal_stress(seen, mean(|row| row.strain)) + viscous_stress(seen)) * 1e-6,
        accept: Accept::Within(within),
    }
}

/// A strand's stress against strand theory.
pub fn pulled_strand(seen: &CompletedRun) -> Answer {
    pulled_within(seen, 0.02)
}

/// The same for many layers in a short specimen: each has its own contraction from the grips on, and one mean radius per
/// layer is no exact measure of it.
pub fn pulled_layers(seen: &CompletedRun) -> Answer {
    pulled_within(seen, 0.03)
}

/// A single wire's stress against its hardening law.
pub fn pulled_wire(seen: &CompletedRun) -> Answer {
    pulled_within(seen, 0.005)
}

/// Peak stress against the yield stress, for wires that do not harden.
pub fn peak_is_yield(seen: &CompletedRun) -> Answer {
    Answer {
        what: "peak stress".into(),
        unit: "MPa".into(),
        computed: seen.rows.iter().map(|row| row.stress).fold(0.0, f64::max) * 1e-6,
        exact: seen.first_yield() * 1e-6,
        accept: Accept::Within(0.02),
    }
}

/// Friction does no work.
pub fn no_friction(seen: &CompletedRun) -> Answer {
    let energy = seen.last().energy;
    Answer {
        what: "work of friction".into(),
        unit: "J".into(),
        computed: energy.friction,
        exact: 0.0,
        accept: Accept::Absolute(0.0),
    }
}

/// Torque after the last turn, T_p at the hardening that the turning has brought: dp = dW/(σ_y A l) with W = ∫T dθ
/// gives p = 2 r θ/(3√3 L).
pub fn turned(seen: &CompletedRun) -> Answer {
    let wire = &seen.assembly.wires[0];
    let radius = 0.5 * wire.diameter;
    let length: f64 = seen.assembly.rest_length[wire.bonds()].iter().sum();
    let angle = seen.spec.grip.as_ref().map_or(0.0, |grip| grip.rotation_rate) * seen.last().time;
    let p = 2.0 * radius * angle / (3.0 * 3.0_f64.sqrt() * length);
    let yield_stress = match &seen.spec.bond.law {
        BondLawSpec::Elastic => f64::INFINITY,
        BondLawSpec::ElastoPlastic(law) => law.stress(p),
    };
    Answer {
        what: "torque after ten turns".into(),
        unit: "N mm".into(),
        computed: seen.last().torque * 1e3,
        exact: Section { radius, yield_stress }.plastic_torque() * 1e3,
        accept: Accept::Within(0.01),
    }
}

/// Plastic work of the last half of all cycles against that of a perfectly plastic wire, 4 σ_y A (a − σ_y L/E) a cycle.
pub fn cycled_plastic(seen: &CompletedRun) -> Answer {
    let Some(DriveSpec::Cyclic { amplitude, frequency }) = seen.spec.grip.as_ref().map(|grip| grip.drive) else {
        unreachable!("the case has a cyclic grip")
    };
    let wire = &seen.assembly.wires[0];
    let length: f64 = seen.assembly.rest_length[wire.bonds()].iter().sum();
    let yield_stress = seen.first_yield();
    // Whole cycles, from the one in the middle to the last whole one.
    let work_after = |cycles: f64| {
        let after = seen.rows.partition_point(|row| row.time * frequency < cycles).min(seen.rows.len() - 1);
        seen.rows[after].energy.plastic_bonds
    };
    let last = (seen.last().time * frequency).floor();
    let middle = (0.5 * last).floor();
    let elastic = yield_stress * length / seen.spec.material.young;
    Answer {
        what: "plastic work a cycle".into(),
        unit: "mJ".into(),
        computed: (work_after(last) - work_after(middle)) / (last - middle) * 1e3,
        exact: 4.0 * yield_stress * wire.area() * (amplitude - elastic) * 1e3,
        accept: Accept::Within(0.02),
    }
}

/// Greatest stress in the last tenth of the cycles against that in the fifth.
pub fn cycled_alike(seen: &CompletedRun) -> Answer {
    let tenth = seen.rows.len() / 10;
    let greatest = |rows: &[Sample]| rows.iter().map(|row| row.stress.abs()).fold(0.0, f64::max) * 1e-6;
    Answer {
        what: "amplitude at the end".into(),
        unit: "MPa".into(),
        computed: greatest(&seen.rows[9 * tenth..]),
        exact: greatest(&seen.rows[4 * tenth..5 * tenth]),
        accept: Accept::Within(0.01),
    }
}

/// Mean position in the last tenth of a rest against that in the fifth tenth, over the diameter. A hundred-millionth of
/// a diameter is less than an atom; what is left of the ringing of the start is of that size.
pub fn no_drift(seen: &CompletedRun) -> Answer {
    let tenth = seen.track.len() / 10;
    let mean = |rows: &[Vec<DVec3>], p: usize| rows.iter().map(|x| x[p]).sum::<DVec3>() / rows.len() as f64;
    let drift = |p: usize| mean(&seen.track[9 * tenth..], p).distance(mean(&seen.track[4 * tenth..5 * tenth], p));
    Answer {
        what: "drift at rest".into(),
        unit: "d".into(),
        computed: (0..seen.assembly.len()).map(drift).fold(0.0, f64::max) / seen.diameter(),
        exact: 0.0,
        accept: Accept::Absolute(1e-8),
    }
}

/// Mean stress behind the wave of a wire that is stopped at one end, ρ c v (Timoshenko & Goodier, *Theory of
/// Elasticity*, chapter 15); the wave has passed the middle after L/2c and is back after 3L/2c.
pub fn stopped_wave(seen: &CompletedRun) -> Answer {
    let material = &seen.spec.material;
    let wave = (material.young / material.density).sqrt();
    let passage = seen.assembly.length / wave;
    let plateau = seen.rows.iter().filter(|row| (0.75 * passage..1.25 * passage).contains(&row.time));
    let stresses: Vec<f64> = plateau.map(|row| row.wire_stress[0].abs()).collect();
    Answer {
        what: "stress of the impact".into(),
        unit: "MPa".into(),
        computed: stresses.iter().sum::<f64>() / stresses.len() as f64 * 1e-6,
        exact: material.density * wave * seen.spec.wires[0].velocity.length() * 1e-6,
        accept: Accept::Within(0.02),
    }
}

/// Sideways deflection of a buckled column's tip against the elastica.
pub fn buckled(seen: &CompletedRun) -> Answer {
    let wire = &seen.assembly.wires[0];
    let length: f64 = seen.assembly.rest_length[wire.bonds()].iter().sum();
    let tip = seen.end[0][wire.particles().end - 1];
    Answer {
        what: "tip deflection".into(),
        unit: "mm".into(),
        computed: tip.x.hypot(tip.y) * 1e3,
        exact: Column::shortened(1.0 - tip.z / length).deflection * length * 1e3,
        accept: Accept::Within(0.02),
    }
}

/// Speed at which two spheres part that overlapped from the start, of all the energy that they held (Hertz).
pub fn thrown_apart(seen: &CompletedRun) -> Answer {
    let material = &seen.spec.material;
    let [a, b] = [0, 1].map(|p| seen.assembly.position.get(p));
    let radius = seen.assembly.radius[0];
    let pair = Pair::equal_spheres(radius, material.young, material.poisson, material.density);
    // δ_max(v) ∝ v^(4/5), so the speed that reaches this overlap is the speed that it gives back.
    let overlap = 2.0 * radius - a.distance(b);
    let exact = (overlap / pair.greatest_overlap(1.0)).powf(1.25);
    Answer {
        what: "speed of parting".into(),
        unit: "m/s".into(),
        computed: seen.end[1][0].distance(seen.end[1][1]),
        exact,
        accept: Accept::Within(0.005),
    }
}
