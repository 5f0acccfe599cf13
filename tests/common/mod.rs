//! A strand like KA4 made up without the engine: 34 wires in three layers, 120 mm long, at the moment when several
//! outer wires have snapped. For tests of what is drawn, not of physics.

#![allow(dead_code, reason = "each test binary uses its own part")]

use std::f32::consts::TAU;
use strandsnap::engine::view::{BondState, RunInfo, Rupture, RuptureCause, Snapshot, WireInfo};
use strandsnap::render::{History, Row};

/// Wire diameter (m).
pub const DIAMETER: f32 = 0.39e-3;
/// Length of the strand (m).
pub const LENGTH: f32 = 120e-3;
/// Wires per layer, inside out, and their lay radius (m).
const LAYERS: [(usize, f32); 3] = [(5, 0.332e-3), (11, 0.722e-3), (18, 1.165e-3)];
const PITCH: f32 = 39e-3;
/// Particles per wire.
const PARTICLES: usize = 312;

/// What broke: wire from 0, and z before loading (m), in the order of rupture.
pub const BREAKS: [(usize, f32); 7] =
    [(24, 64e-3), (25, 62.5e-3), (26, 66e-3), (31, 58e-3), (17, 70e-3), (12, 63e-3), (24, 69e-3)];

/// The strand before loading.
pub fn ka4_like() -> RunInfo {
    strand("ka4-like", &["inner", "middle", "outer"], &LAYERS)
}

/// One straight wire.
pub fn single_wire() -> RunInfo {
    strand("single-wire", &["wire"], &[(1, 0.0)])
}

fn strand(name: &str, layers: &[&str], wires: &[(usize, f32)]) -> RunInfo {
    let mut info = RunInfo {
        name: name.into(),
        layers: layers.iter().map(|l| (*l).into()).collect(),
        materials: vec!["default".into()],
        gauge: Some([10e-3, 110e-3]),
        stress_range: [0.0, 420e6],
        plastic_strain_range: [0.0, 0.3],
        speed_range: [0.0, 2.0],
        contact_pressure_range: [0.0, 30e6],
        strain_end: Some(0.2857),
        ..RunInfo::default()
    };
    for (layer, (count, lay_radius)) in wires.iter().copied().enumerate() {
        for k in 0..count {
            info.wires.push(WireInfo {
                layer,
                material: 0,
                first: info.rest_position.len(),
                len: PARTICLES,
                diameter: DIAMETER.into(),
            });
            for i in 0..PARTICLES {
                let z = LENGTH * i as f32 / (PARTICLES - 1) as f32;
                let angle = TAU * (k as f32 / count as f32 + z / PITCH);
                info.rest_position.push([lay_radius * angle.cos(), lay_radius * angle.sin(), z]);
                info.radius.push(0.5 * DIAMETER);
            }
        }
    }
    info.wire_particles = info.rest_position.len();
    info.particles = info.wire_particles;
    info
}

/// The strand at a strain (-), whole.
pub fn stretched(info: &RunInfo, strain: f32) -> Snapshot {
    let [low, high] = info.gauge.expect("the strand has grips").map(|z| z as f32);
    let thin = (1.0 + strain).powf(-0.5);
    let stress = hardening(strain);
    let mut s = Snapshot::default();
    s.sample.strain = f64::from(strain);
    s.sample.stress = f64::from(stress / (1.0 + strain));
    for (w, wire) in info.wires.iter().enumerate() {
        for i in 0..wire.len {
            let p = info.rest_position[wire.first + i];
            let z = p[2] + strain * (p[2].clamp(low, high) - low);
            let free = p[2] > low && p[2] < high;
            let squeeze = if free { thin } else { 1.0 };
            s.position.push([p[0] * squeeze, p[1] * squeeze, z]);
            s.radius.push(info.radius[wire.first + i] * squeeze);
            s.speed.push(2.0 * (z / (LENGTH * (1.0 + strain))));
            let last = i + 1 == wire.len;
            s.bond_state.push(if last { BondState::Absent } else { BondState::Yielding });
            let ripple = 1.0 + 0.05 * (350.0 * p[2] + 1.7 * w as f32).sin();
            let level = if free { stress * ripple * (0.9 + 0.05 * wire.layer as f32) } else { 0.25 * stress };
            s.bond_stress.push(if last { 0.0 } else { level });
            s.plastic_strain.push(if last || !free { 0.0 } else { (strain * ripple).max(0.0) });
            s.utilisation.push(strain / 0.3);
            s.contact_pressure.push(if free { 60e6 * strain } else { 0.0 });
        }
    }
    s
}

fn hardening(strain: f32) -> f32 {
    (110e9 * strain).min(110e6 + 300e6 * (1.0 - (-6.0 * strain).exp()))
}

/// The same with the first `count` of [`BREAKS`], ends sprung back and out by up to a millimetre.
pub fn snapped(info: &RunInfo, strain: f32, count: usize) -> (Snapshot, Vec<Rupture>) {
    broken(info, strain, &BREAKS[..count])
}

/// Every wire broken, most of them near the middle.
pub fn all_snapped(info: &RunInfo, strain: f32) -> (Snapshot, Vec<Rupture>) {
    let place = |w: usize| 60e-3 + 14e-3 * (2.7 * w as f32).sin();
    let breaks: Vec<_> = (0..info.wires.len()).map(|k| (k * 23) % info.wires.len()).map(|w| (w, place(w))).collect();
    broken(info, strain, &breaks)
}

fn broken(info: &RunInfo, strain: f32, breaks: &[(usize, f32)]) -> (Snapshot, Vec<Rupture>) {
    let mut s = stretched(info, strain);
    let mut ruptures: Vec<Rupture> = Vec::new();
    for (order, &(w, z)) in breaks.iter().enumerate() {
        let bond = bond_at(info, w, z);
        let first_of_wire = ruptures.iter().all(|r| r.wire != w);
        s.bond_state[bond] = BondState::Broken;
        let body = f64::from(strain);
        ruptures.push(Rupture {
            order: order + 1,
            step: 1000 + order as u64,
            time: 1e-3,
            strain: body - 0.03 * (breaks.len() - order) as f64 / breaks.len() as f64,
            wire: w,
            layer: info.wires[w].layer,
            bond,
            bond_in_wire: bond - info.wires[w].first,
            position: s.position[bond].map(f64::from),
            rest_z: f64::from(info.rest_position[bond][2]),
            cause: RuptureCause::PlasticStrain,
            stress: 400e6,
            body_stress: 300e6,
            first_of_wire,
        });
        spring_back(info, &mut s, w, bond);
    }
    s.sample.wires_broken = ruptures.iter().filter(|r| r.first_of_wire).count();
    s.sample.bonds_broken = ruptures.len();
    (s, ruptures)
}

/// Bond slot of wire `w` nearest to `z` before loading (m).
pub fn bond_at(info: &RunInfo, w: usize, z: f32) -> usize {
    let wire = &info.wires[w];
    let distance = |i: &usize| (info.rest_position[*i][2] - z).abs();
    (wire.first..wire.first + wire.len - 1)
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .expect("the wire has bonds")
}

fn spring_back(info: &RunInfo, s: &mut Snapshot, w: usize, bond: usize) {
    let wire = &info.wires[w];
    let reach = 18;
    for i in wire.first..wire.first + wire.len {
        let away = if i <= bond { bond - i } else { i - bond - 1 };
        let near = (-(away as f32) / reach as f32).exp();
        s.bond_stress[i] *= 1.0 - 0.85 * near;
        if away < 40 {
            let side = if i <= bond { -1.0 } else { 1.0 };
            let lift = 1.0 + 0.35 * (-(away as f32) / 4.0).exp() * if wire.layer == 2 { 1.0 } else { 0.0 };
            s.position[i][0] *= lift;
            s.position[i][1] *= lift;
            s.position[i][2] += side * 0.5e-3 * (1.0 - away as f32 / 40.0);
        }
    }
}

/// A curve up to `strain` (-).
pub fn curve(strain: f32) -> Vec<(f64, f64)> {
    (0..=400).map(|k| strain * k as f32 / 400.0).map(|e| (f64::from(e), f64::from(hardening(e) / (1.0 + e)))).collect()
}

/// A history with points of the stress-strain curve (-, Pa) and ruptures.
pub fn told(points: &[(f64, f64)], ruptures: &[Rupture]) -> History {
    let mut history = History::default();
    let row = |(strain, stress): &(f64, f64)| Row { strain: *strain, stress: *stress, ..Row::default() };
    history.rows.extend(points.iter().map(row));
    history.ruptures.extend_from_slice(ruptures);
    history
}

/// Two free spheres.
pub fn two_spheres() -> (RunInfo, Snapshot) {
    let position = vec![[0.0, 0.0, 0.0], [0.1e-3, 0.2e-3, 1.3e-3]];
    let info = RunInfo {
        name: "two-spheres".into(),
        particles: 2,
        materials: vec!["default".into()],
        sphere_material: vec![0; 2],
        radius: vec![0.5e-3, 0.6e-3],
        rest_position: position.clone(),
        stress_range: [0.0, 1.0],
        plastic_strain_range: [0.0, 1.0],
        speed_range: [0.0, 1.0],
        ..RunInfo::default()
    };
    let snapshot = Snapshot {
        position,
        radius: vec![0.5e-3, 0.6e-3],
        speed: vec![0.3, 0.8],
        bond_state: vec![BondState::Absent; 2],
        bond_stress: vec![0.0; 2],
        plastic_strain: vec![0.0; 2],
        utilisation: vec![0.0; 2],
        contact_pressure: vec![0.0; 2],
        ..Snapshot::default()
    };
    (info, snapshot)
}

/// A wire along z without grips, bent into a quarter circle.
pub fn bent_wire() -> (RunInfo, Snapshot) {
    let mut info = single_wire();
    info.name = "cantilever-like".into();
    info.gauge = None;
    let mut snapshot = stretched(&RunInfo { gauge: Some([0.0, LENGTH.into()]), ..info.clone() }, 0.0);
    let bend = LENGTH * 2.0 / std::f32::consts::PI;
    for (k, p) in snapshot.position.iter_mut().enumerate() {
        let angle = p[2] / bend;
        *p = [0.0, bend * (1.0 - angle.cos()), bend * angle.sin()];
        snapshot.bond_stress[k] = 300e6 * angle.cos();
    }
    (info, snapshot)
}
