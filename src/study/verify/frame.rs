//! The same motion in other frames of reference.

use super::case::VerificationCase;
use super::comparison::{Comparison, Spent};
use super::support::Context;
use crate::base::error::Result;
use crate::engine::state::BondActions;
use crate::scene;
use crate::scene::spec::{PathSpec, Spec};
use glam::{DMat3, DVec3};

pub const FRAME: VerificationCase = VerificationCase {
    name: "frame-indifference",
    about: "a rod is twisted, bent and pulled, and two wires collide, in turned, shifted and flying frames: nothing changes",
    source: "Galilean relativity, isotropy of space",
    run: frame,
};

/// Turn, shift and velocity of a frame.
#[derive(Clone, Copy)]
struct Frame {
    turn: DMat3,
    shift: DVec3,
    velocity: DVec3,
}

impl Frame {
    const HOME: Self = Self { turn: DMat3::IDENTITY, shift: DVec3::ZERO, velocity: DVec3::ZERO };

    /// The scene as seen from this frame.
    fn see(&self, spec: &mut Spec) {
        let place = |p: &mut DVec3| *p = self.turn * *p + self.shift;
        let throw = |v: &mut DVec3| *v = self.turn * *v + self.velocity;
        let spin = |w: &mut DVec3| *w = self.turn * *w;
        for wire in &mut spec.wires {
            let PathSpec::Straight { from, to } = &mut wire.path else {
                unreachable!("the scenes' wires are straight")
            };
            place(from);
            place(to);
            throw(&mut wire.velocity);
            spin(&mut wire.spin);
        }
        for hold in &mut spec.holds {
            throw(&mut hold.velocity);
            spin(&mut hold.spin);
        }
    }
}

/// What must not depend on the frame.
struct FrameRun {
    /// Positions (m), bond forces (N) and moments (N m), seen from home.
    vectors: [Vec<DVec3>; 3],
    /// Thinning of the bonds, which tells their plastic strain (-).
    thinning: Vec<f64>,
    /// Elastic, plastic, frictional and damped energy (J).
    energies: [f64; 5],
    spent: Spent,
}

fn outcome(context: &Context, name: &str, frame: &Frame) -> Result<FrameRun> {
    let scene = scene::load(name, &[])?.changed(|spec| {
        spec.time.step = Some(spec.time.step.unwrap_or(20e-9));
        frame.see(spec);
    });
    let mut simulation = context.simulation_of(scene)?;
    simulation.run(|_| {})?;
    let s = simulation.engine.state();
    let home = frame.turn.transpose();
    let away = frame.shift + frame.velocity * s.time;
    let seen = |v: DVec3| home * v;
    let e = simulation.engine.energy();
    Ok(FrameRun {
        vectors: [
            (0..s.len()).map(|p| seen(s.x.get(p) - away)).collect(),
            (0..s.len()).map(|b| seen(s.bond.pull(b))).collect(),
            (0..s.len()).map(|b| seen(s.bond.moment(b))).collect(),
        ],
        thinning: (0..s.len()).map(|b| s.bond.get(b, BondActions::THINNING)).collect(),
        energies: [e.elastic_bonds, e.plastic_bonds, e.damping, e.plastic_contacts, e.friction],
        spent: simulation.finish(),
    })
}

impl FrameRun {
    /// Greatest difference to `other`, each relative to the greatest value of its kind (-).
    fn differs(&self, other: &Self) -> [f64; 3] {
        let forces = self.vectors.iter().zip(&other.vectors).skip(1).map(|(a, b)| {
            let largest = b.iter().map(|v| v.length()).fold(0.0, f64::max);
            a.iter().zip(b).map(|(a, b)| (*a - *b).length() / largest).fold(0.0, f64::max)
        });
        let strain = |v: &f64| -2.0 * v.ln();
        let largest = other.thinning.iter().map(strain).fold(0.0, f64::max);
        let strains = self.thinning.iter().zip(&other.thinning).map(|(a, b)| (strain(a) - strain(b)).abs() / largest);
        let whole: f64 = other.energies.iter().sum();
        let energies = self.energies.iter().zip(other.energies).map(|(a, b)| (a - b).abs() / whole);
        [forces.fold(0.0, f64::max), strains.fold(0.0, f64::max), energies.fold(0.0, f64::max)]
    }
}

fn frame(context: &Context) -> Result<Vec<Comparison>> {
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.1);
    let (shift, velocity) = (DVec3::new(0.3, -0.7, 0.5), DVec3::new(30.0, -20.0, 50.0));
    let frames = [
        ("turned", Frame { turn, ..Frame::HOME }),
        ("shifted by 0.9 m", Frame { shift, ..Frame::HOME }),
        ("flying at 62 m/s", Frame { velocity, ..Frame::HOME }),
        ("turned, shifted and flying", Frame { turn, shift, velocity }),
    ];
    let mut found = Vec::new();
    for (scene, what, target, note) in [
        (
            "verify/frame",
            "rod",
            1e-7,
            "Rounding of positions: 1e-16 of 0.9 m is 3e-13 of a bond, and strains are 1e-3.",
        ),
        ("verify/crossing-wires", "collision", 1e-4, "Rounding grows while the wires ring and rub."),
    ] {
        let home = outcome(context, scene, &Frame::HOME)?;
        let mut off = Vec::new();
        for (how, frame) in frames {
            let there = outcome(context, scene, &frame)?;
            for (kind, value) in ["forces", "plastic strains", "energies"].iter().zip(there.differs(&home)) {
                let what = format!("{what}: greatest difference, {kind}, {how}");
                off.push(Comparison::new(what, "-", value, 0.0, there.spent).relative_to(1.0).within(target));
            }
        }
        found.push(Comparison::worst(off).note(note));
    }
    Ok(found)
}
