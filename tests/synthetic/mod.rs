//! A run that was not simulated: the KA4 strand (5 + 11 + 18 wires, pitch 39 mm, 120 mm long) stretched evenly, some
//! outer wires breaking near mid-length. For tests of what observes a run.

// Each test program uses its own part of this.
#![allow(dead_code)]

use std::f64::consts::TAU;
use std::sync::Arc;
use strandsnap::base::random::uniform;
use strandsnap::engine::view::{BondState, Energy, RunInfo, Rupture, RuptureCause, Sample, Snapshot, WireInfo};
use strandsnap::observe::Observer;

// Diameter, pitch, length and lay radii (m).
const DIAMETER: f64 = 0.39e-3;
const PITCH: f64 = 39e-3;
const LENGTH: f64 = 120e-3;
const LAYERS: [(&str, usize, f64); 3] = [("inner", 5, 0.332e-3), ("middle", 11, 0.722e-3), ("outer", 18, 1.165e-3)];
/// Strain at the end (-).
const STRAIN_END: f64 = 0.27;
/// Wire (from 0), strain at which it breaks (-), place along it (-).
const BREAKS: [(usize, f64, f64); 6] =
    [(23, 0.234, 0.52), (30, 0.239, 0.55), (18, 0.241, 0.49), (26, 0.247, 0.53), (12, 0.251, 0.51), (2, 0.259, 0.5)];

/// Something that happens in a run.
pub enum Event {
    Sample(Sample),
    Snapshot(Arc<Snapshot>),
    Rupture(Rupture),
}

/// A run: what does not change, and its events in order.
pub struct Run {
    pub info: Arc<RunInfo>,
    pub events: Vec<Event>,
}

impl Run {
    /// A run with as many snapshots and ten samples for each.
    pub fn new(snapshots: usize) -> Self {
        let info = Arc::new(info());
        let (mut events, mut broken) = (Vec::new(), Vec::new());
        for i in 0..snapshots * 10 {
            let strain = STRAIN_END * i as f64 / (snapshots * 10 - 1) as f64;
            for (order, (wire, at, along)) in BREAKS.iter().enumerate() {
                if strain >= *at && broken.len() == order {
                    broken.push((*wire, *along));
                    events.push(Event::Rupture(rupture(&info, order + 1, *wire, *at, *along)));
                }
            }
            let sample = sample(&info, strain, &broken);
            if i % 10 == 9 {
                events.push(Event::Snapshot(Arc::new(snapshot(&info, &sample, &broken))));
            }
            events.push(Event::Sample(sample));
        }
        Self { info, events }
    }

    /// Shows the run to an observer, from start to finish.
    pub fn show(&self, observer: &mut dyn Observer) -> strandsnap::base::error::Result<()> {
        self.show_unfinished(observer)?;
        observer.finish()
    }

    /// Shows the run to an observer without finishing it.
    pub fn show_unfinished(&self, observer: &mut dyn Observer) -> strandsnap::base::error::Result<()> {
        observer.start(&self.info)?;
        self.events.iter().try_for_each(|event| match event {
            Event::Sample(sample) => observer.sample(sample),
            Event::Snapshot(snapshot) => observer.snapshot(snapshot),
            Event::Rupture(rupture) => observer.rupture(rupture),
        })
    }

    pub fn snapshots(&self) -> Vec<&Arc<Snapshot>> {
        self.events.iter().filter_map(|e| if let Event::Snapshot(s) = e { Some(s) } else { None }).collect()
    }

    pub fn samples(&self) -> Vec<&Sample> {
        self.events.iter().filter_map(|e| if let Event::Sample(s) = e { Some(s) } else { None }).collect()
    }

    pub fn ruptures(&self) -> Vec<&Rupture> {
        self.events.iter().filter_map(|e| if let Event::Rupture(r) = e { Some(r) } else { None }).collect()
    }
}

fn info() -> RunInfo {
    let (mut wires, mut rest_position) = (Vec::new(), Vec::new());
    for (layer, (_, count, radius)) in LAYERS.iter().enumerate() {
        let turn = TAU / PITCH;
        let arc = LENGTH * (1.0 + (radius * turn).powi(2)).sqrt();
        let len = (arc / DIAMETER) as usize + 1;
        for wire in 0..*count {
            wires.push(WireInfo { layer, material: 0, first: rest_position.len(), len, diameter: DIAMETER });
            rest_position.extend((0..len).map(|k| {
                let z = LENGTH * k as f64 / (len - 1) as f64;
                let angle = turn * z + TAU * wire as f64 / *count as f64;
                [radius * angle.cos(), radius * angle.sin(), z].map(|x| x as f32)
            }));
        }
    }
    let particles = rest_position.len();
    RunInfo {
        name: "ka4-synthetic".into(),
        about: "A KA4 strand that was not simulated".into(),
        layers: LAYERS.iter().map(|(name, _, _)| (*name).to_owned()).collect(),
        materials: vec!["default".to_owned()],
        sphere_material: Vec::new(),
        wires,
        wire_particles: particles,
        particles,
        bodies: Vec::new(),
        radius: vec![(0.5 * DIAMETER) as f32; particles],
        rest_position,
        gauge: Some([10e-3, 110e-3]),
        stress_range: [0.0, 420e6],
        plastic_strain_range: [0.0, 0.3],
        speed_range: [0.0, 10.0],
        contact_pressure_range: [0.0, 40e6],
        strain_end: Some(STRAIN_END),
        body_stress_end: None,
        negligible_energy: 1e-12,
        wave_passage: 3e-5,
    }
}

fn step(strain: f64) -> u64 {
    (strain * 1e6) as u64
}

fn stress(strain: f64) -> f64 {
    let saturation = 1.0 - (-strain / 0.08).exp();
    1e6 * (110e3 * strain).min(80.0 + 240.0 * saturation)
}

fn sample(info: &RunInfo, strain: f64, broken: &[(usize, f64)]) -> Sample {
    let wire_stress: Vec<f64> = (0..info.wires.len())
        .map(|w| if broken.iter().any(|(b, _)| *b == w) { 0.35 } else { 1.0 } * stress(strain))
        .collect();
    let layer_stress = (0..info.layers.len()).map(|layer| {
        let of: Vec<f64> =
            info.wires.iter().zip(&wire_stress).filter(|(w, _)| w.layer == layer).map(|(_, s)| *s).collect();
        of.iter().sum::<f64>() / of.len() as f64
    });
    let mean = wire_stress.iter().sum::<f64>() / wire_stress.len() as f64;
    Sample {
        step: step(strain),
        time: strain * 1e-2,
        strain,
        stress: mean,
        grip_force: [mean * 4e-6; 2],
        layer_stress: layer_stress.collect(),
        wires_broken: broken.len(),
        bonds_broken: broken.len(),
        energy: Energy { work: strain, elastic_bonds: strain, ..Default::default() },
        wire_stress,
        ..Default::default()
    }
}

fn snapshot(info: &RunInfo, sample: &Sample, broken: &[(usize, f64)]) -> Snapshot {
    let n = info.particles;
    let noise = |i: usize, of: u64| (uniform(of, i as u64, sample.step) - 0.5) as f32;
    let stretch = (1.0 + sample.strain) as f32;
    let thin = stretch.powf(-0.5);
    let mut all = Snapshot {
        sample: sample.clone(),
        position: (0..n)
            .map(|i| {
                let [x, y, z] = info.rest_position[i];
                [x * thin + 2e-6 * noise(i, 1), y * thin + 2e-6 * noise(i, 2), z * stretch + 2e-6 * noise(i, 3)]
            })
            .collect(),
        radius: info.radius.iter().map(|r| r * thin).collect(),
        speed: (0..n).map(|i| 1.0 + noise(i, 4)).collect(),
        bond_state: vec![if sample.strain > 8e-4 { BondState::Yielding } else { BondState::Whole }; n],
        bond_stress: (0..n).map(|i| stress(sample.strain) as f32 * stretch + 8e6 * noise(i, 5)).collect(),
        plastic_strain: (0..n).map(|i| stretch.ln() * (1.0 + 0.02 * noise(i, 6))).collect(),
        utilisation: (0..n).map(|i| stretch.ln() / 0.3 * (1.0 + 0.02 * noise(i, 6))).collect(),
        contact_pressure: (0..n).map(|i| 100e6 * (stretch - 1.0) * (1.0 + noise(i, 7))).collect(),
        roll: Vec::new(),
        detail: None,
    };
    for wire in &info.wires {
        all.bond_state[wire.first + wire.len - 1] = BondState::Absent;
    }
    broken.iter().for_each(|(wire, along)| open(&mut all, &info.wires[*wire], *along));
    all
}

/// Draws the ends of a broken wire apart and unloads them.
fn open(all: &mut Snapshot, wire: &WireInfo, along: f64) {
    let at = bond_of(wire, along);
    for k in 0..wire.len {
        let distance = (k as f32 - at as f32 - 0.5) * 0.39e-3;
        let near = (-distance.abs() / 12e-3).exp();
        all.position[wire.first + k][2] += 0.9e-3 * near * distance.signum();
        all.bond_stress[wire.first + k] *= 1.0 - near;
    }
    all.bond_state[wire.first + at] = BondState::Broken;
    all.bond_stress[wire.first + at] = 0.0;
}

fn bond_of(wire: &WireInfo, along: f64) -> usize {
    (along * (wire.len - 1) as f64) as usize
}

fn rupture(info: &RunInfo, order: usize, wire: usize, strain: f64, along: f64) -> Rupture {
    let of = &info.wires[wire];
    let bond_in_wire = bond_of(of, along);
    let bond = of.first + bond_in_wire;
    let rest: [f64; 3] = std::array::from_fn(|axis| {
        0.5 * f64::from(info.rest_position[bond][axis] + info.rest_position[bond + 1][axis])
    });
    let thin = (1.0 + strain).powf(-0.5);
    Rupture {
        order,
        step: step(strain),
        time: strain * 1e-2,
        strain,
        wire,
        layer: of.layer,
        bond,
        bond_in_wire,
        position: [rest[0] * thin, rest[1] * thin, rest[2] * (1.0 + strain)],
        rest_z: rest[2],
        cause: RuptureCause::PlasticStrain,
        stress: stress(strain) * (1.0 + strain),
        body_stress: stress(strain),
        first_of_wire: true,
    }
}
