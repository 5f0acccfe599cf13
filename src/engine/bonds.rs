//! Bond stage: kinematics of every bond, its law, damping, and what it does to its two particles.
//!
//! Generic over the law and over whether particles turn; the loop inside is monomorphic. Log axial strain on the
//! current length; shear, bending and torsion by increments in the bond's co-rotating frame (n, e₁, e₂), measured at
//! mid-step so that a rigid rotation gives none up to third order in its angle per step.

use super::rupture::{Criterion, RuptureCheck};
use super::state::{BondAction, CHUNK, Partial, State};
use super::time_step::Stiffness;
use crate::law::bond::{BondForce, BondIncrement, BondLaw, BondShape, Section};
use crate::law::damping::viscous_coefficient;
use crate::strand::assembly::Assembly;
use glam::DVec3;
use rayon::prelude::*;

/// What the engine asks of bonds, whatever their law.
pub trait Bonds: Send {
    /// Computes every bond's action on its particles from `state`; returns the energies of the step.
    fn compute(&mut self, state: &mut State) -> Partial;
    /// Breaks the bonds that reached their limit; calls `broke(slot, cause, true axial stress [Pa])` for each, in order,
    /// and returns the elastic energy that they held [J].
    fn rupture(&mut self, state: &mut State, broke: &mut dyn FnMut(usize, Criterion, f64)) -> f64;
    /// Stored elastic energy [J].
    fn elastic_energy(&self, state: &State) -> f64;
    /// Stiffnesses for the bound on the time step.
    fn stiffness(&self, state: &State, out: &mut Stiffness);
    /// True axial stress of a bond [Pa].
    fn stress(&self, slot: usize) -> f64;
    /// Axial force of a bond [N].
    fn axial_force(&self, slot: usize) -> f64;
    /// Equivalent plastic strain of a bond [-].
    fn plastic_strain(&self, slot: usize) -> f64;
    /// Share of its rupture limit that a bond has reached [-]: it breaks at 1. 0 without a rupture criterion.
    fn utilisation(&self, slot: usize, state: &State) -> f64;
}

/// One bond's frame, forces and history.
#[derive(Debug, Clone, Copy)]
struct Record<S> {
    /// e₁ of the co-rotating frame.
    e1: DVec3,
    force: BondForce,
    /// Force of the axial dashpot at the last step [N].
    dashpot: f64,
    state: S,
}

/// Bonds with law `L`; `TURN` says whether particles turn.
pub struct BondStage<L: BondLaw, const TURN: bool> {
    law: L,
    records: Vec<Record<L::State>>,
    shape: Vec<BondShape>,
    /// Viscous coefficients of axial, shear [N s/m], bending, torsion [N m s]; empty without damping.
    viscosity: Vec<[f64; 4]>,
    rupture: Option<RuptureCheck>,
    partial: Vec<Partial>,
    /// Whether a bond of each chunk may have reached its limit at this step.
    due: Vec<bool>,
}

impl<L: BondLaw, const TURN: bool> BondStage<L, TURN> {
    /// All bonds of the assembly; `damping` is the fraction of critical per mode [-].
    pub fn new(law: L, assembly: &Assembly, damping: [f64; 4], rupture: Option<RuptureCheck>) -> Self {
        let n = assembly.len();
        let shape: Vec<_> = (0..n).map(|i| BondShape::new(assembly.rest_length[i], assembly.radius[i])).collect();
        let records = (0..n)
            .map(|i| {
                let axis = if assembly.is_bond(i) {
                    (assembly.position.get(i + 1) - assembly.position.get(i)).normalize()
                } else {
                    DVec3::Z
                };
                Record {
                    e1: axis.any_orthonormal_vector(),
                    force: BondForce::default(),
                    dashpot: 0.0,
                    state: law.initial(),
                }
            })
            .collect();
        let viscosity = if damping.iter().any(|d| *d > 0.0) {
            (0..n).map(|i| viscosity(&law, assembly, &shape[i], i, damping)).collect()
        } else {
            Vec::new()
        };
        let chunks = n.div_ceil(CHUNK);
        Self {
            law,
            records,
            shape,
            viscosity,
            rupture,
            partial: vec![Partial::default(); chunks],
            due: vec![true; chunks],
        }
    }
}

/// Coefficients 2ξ√(k m) with the reduced mass (or inertia) of the two ends.
fn viscosity<L: BondLaw>(law: &L, a: &Assembly, shape: &BondShape, i: usize, damping: [f64; 4]) -> [f64; 4] {
    if !a.is_bond(i) {
        return [0.0; 4];
    }
    let reduced = |m: &[f64]| m[i] * m[i + 1] / (m[i] + m[i + 1]);
    let (mass, inertia) = (reduced(&a.mass), reduced(&a.inertia));
    let k = law.stiffness(shape, &law.initial());
    [
        viscous_coefficient(damping[0], mass, k.axial),
        viscous_coefficient(damping[1], mass, k.shear),
        viscous_coefficient(damping[2], inertia, k.bend),
        viscous_coefficient(damping[3], inertia, k.twist),
    ]
}

/// Power that the motion does on a bond against its whole action [W].
fn power(state: &State, slot: usize) -> f64 {
    let action = &state.bond[slot];
    let (wa, wb) = (state.w.get(slot), state.w.get(slot + 1));
    action.pull.dot(state.v.get(slot + 1) - state.v.get(slot)) + action.moment.dot(wb - wa) - action.arm.dot(wa + wb)
}

/// What all bonds of a step share.
struct Shared<'a, L> {
    law: &'a L,
    shape: &'a [BondShape],
    viscosity: &'a [[f64; 4]],
    dt: f64,
}

/// A particle as its bonds see it.
#[derive(Clone, Copy)]
struct Node {
    x: DVec3,
    v: DVec3,
    w: DVec3,
}

/// The parts of the state that bonds read.
struct Motion<'a> {
    x: &'a crate::base::vectors::Vectors,
    v: &'a crate::base::vectors::Vectors,
    w: &'a crate::base::vectors::Vectors,
}

impl Motion<'_> {
    #[inline(always)]
    fn node<const TURN: bool>(&self, p: usize) -> Node {
        Node { x: self.x.get(p), v: self.v.get(p), w: if TURN { self.w.get(p) } else { DVec3::ZERO } }
    }
}

impl<L: BondLaw, const TURN: bool> Bonds for BondStage<L, TURN> {
    fn compute(&mut self, state: &mut State) -> Partial {
        let motion = Motion { x: &state.x, v: &state.v, w: &state.w };
        let shared = Shared { law: &self.law, shape: &self.shape, viscosity: &self.viscosity, dt: state.dt };
        let whole = &state.whole;
        let limit = self.rupture.as_ref().and_then(RuptureCheck::plastic_limit);
        (
            self.records.par_chunks_mut(CHUNK),
            state.bond.par_chunks_mut(CHUNK),
            state.thinning.par_chunks_mut(CHUNK),
            self.partial.par_iter_mut(),
            self.due.par_iter_mut(),
        )
            .into_par_iter()
            .with_max_len(1)
            .enumerate()
            .for_each(|(chunk, (records, actions, thinning, partial, due))| {
                // Sums of one chunk stay on this thread's stack: neighbours in memory belong to other threads.
                let (mut sum, mut reached) = (Partial::default(), limit.is_none());
                let first = chunk * CHUNK;
                let mut here = motion.node::<TURN>(first);
                let outputs = actions.iter_mut().zip(thinning);
                for ((k, record), (action, thinning)) in records.iter_mut().enumerate().zip(outputs) {
                    // The last particle has no successor, and its slot no bond.
                    let slot = first + k;
                    let next = if slot + 1 < whole.len() { motion.node::<TURN>(slot + 1) } else { here };
                    if whole[slot] {
                        let ends = [here, next];
                        *action = if TURN {
                            turning(&shared, slot, &ends, record, &mut sum)
                        } else {
                            axial(&shared, slot, &ends, record, &mut sum)
                        };
                        *thinning = shared.law.thinning(&record.state);
                        if let Some(limit) = limit {
                            reached |= shared.law.plastic_strain(&record.state) >= limit[slot];
                        }
                    }
                    here = next;
                }
                (*partial, *due) = (sum, reached);
            });
        let mut sum = Partial::default();
        self.partial.iter().for_each(|p| sum.add(p));
        sum
    }

    fn rupture(&mut self, state: &mut State, broke: &mut dyn FnMut(usize, Criterion, f64)) -> f64 {
        let Some(check) = &self.rupture else { return 0.0 };
        if !self.due.iter().any(|due| *due) {
            return 0.0;
        }
        let (law, records, shape) = (&self.law, &self.records, &self.shape);
        let broken = check.broken(&state.whole, state, |slot| {
            let r = &records[slot];
            (law.plastic_strain(&r.state), &r.force, law.section(&shape[slot], &r.state))
        });
        let mut released = 0.0;
        for (slot, criterion) in broken {
            broke(slot, criterion, self.stress(slot));
            let record = &mut self.records[slot];
            released += self.law.elastic_energy(&self.shape[slot], &record.force, &record.state);
            // The law has booked this step up to now with the mean of old and new force; the new one never acts.
            released -= 0.5 * state.dt * power(state, slot);
            record.force = BondForce::default();
            state.whole[slot] = false;
            state.bond[slot] = BondAction::default();
        }
        released
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        self.records
            .iter()
            .enumerate()
            .filter(|(i, _)| state.whole[*i])
            .map(|(i, r)| self.law.elastic_energy(&self.shape[i], &r.force, &r.state))
            .sum()
    }

    fn stiffness(&self, state: &State, out: &mut Stiffness) {
        for (i, r) in self.records.iter().enumerate() {
            if state.whole[i] {
                let k = self.law.stiffness(&self.shape[i], &r.state);
                let length = (state.x.get(i + 1) - state.x.get(i)).length();
                let viscosity = self.viscosity.get(i).copied().unwrap_or_default();
                out.bond(i, &k, length, viscosity, TURN);
            }
        }
    }

    fn stress(&self, slot: usize) -> f64 {
        let r = &self.records[slot];
        let section: Section = self.law.section(&self.shape[slot], &r.state);
        r.force.axial / section.area
    }

    fn axial_force(&self, slot: usize) -> f64 {
        self.records[slot].force.axial
    }

    fn plastic_strain(&self, slot: usize) -> f64 {
        self.law.plastic_strain(&self.records[slot].state)
    }

    fn utilisation(&self, slot: usize, state: &State) -> f64 {
        let Some(check) = &self.rupture else { return 0.0 };
        let r = &self.records[slot];
        let section = self.law.section(&self.shape[slot], &r.state);
        check.utilisation(slot, state, self.law.plastic_strain(&r.state), &r.force, &section)
    }
}

/// ln(l/l₀), from the square of the length, which is there before its root [-].
#[inline(always)]
fn log_strain(d: DVec3, shape: &BondShape) -> f64 {
    0.5 * (d.length_squared() * (shape.inverse_length * shape.inverse_length)).ln()
}

/// A bond that only stretches.
#[inline(always)]
fn axial<L: BondLaw>(
    shared: &Shared<L>,
    slot: usize,
    [a, b]: &[Node; 2],
    record: &mut Record<L::State>,
    partial: &mut Partial,
) -> BondAction {
    let d = b.x - a.x;
    let shape = &shared.shape[slot];
    let length = d.length();
    let n = d * (1.0 / length);
    let step = BondIncrement { log_strain: log_strain(d, shape), length, ..Default::default() };
    partial.plastic += shared.law.axial_response(shape, &mut record.force, &mut record.state, &step);
    let mut axial = record.force.axial;
    if let Some(c) = shared.viscosity.get(slot) {
        let rate = (b.v - a.v).dot(n);
        axial += axial_dashpot(c[0], rate, shared.dt, &mut record.dashpot, partial);
    }
    BondAction { pull: n * axial, ..Default::default() }
}

/// Force of the axial dashpot at an elongation rate [m/s]; one formula for both kinds of bond, so that they agree to
/// the bit. The first evaluation, before any step (`dt` = 0), has none: its work would go unbooked.
///
/// Work is the mean of `last` and present force over the step between them. The present force alone books too much
/// where the rate falls from step to step, as in the ringing after a rupture.
#[inline(always)]
fn axial_dashpot(coefficient: f64, rate: f64, dt: f64, last: &mut f64, partial: &mut Partial) -> f64 {
    if dt == 0.0 {
        return 0.0;
    }
    let force = coefficient * rate;
    partial.damping += 0.5 * (*last + force) * rate * dt;
    *last = force;
    force
}

/// A bond in all modes.
#[inline(always)]
fn turning<L: BondLaw>(
    shared: &Shared<L>,
    slot: usize,
    [a, b]: &[Node; 2],
    record: &mut Record<L::State>,
    partial: &mut Partial,
) -> BondAction {
    let dt = shared.dt;
    let (d, dv) = (b.x - a.x, b.v - a.v);
    let shape = &shared.shape[slot];
    let length = d.length();
    let n = d * (1.0 / length);

    // Mid-step geometry.
    let middle = d - dv * (0.5 * dt);
    let inv_middle = 1.0 / middle.length();
    let n_mid = middle * inv_middle;
    let spin = (a.w + b.w) * 0.5;
    // The frame turns with the bond's direction and with the mean spin about it.
    let turn = n_mid.cross(dv) * (dt * inv_middle) + n_mid * (spin.dot(n_mid) * dt);
    let e1_old = record.e1;
    let carried = e1_old + turn.cross(e1_old);
    let flat = carried - n * carried.dot(n);
    // Its length differs from 1 by the square of a step's rotation; one Newton step of 1/√q mends that.
    let e1 = flat * (1.5 - 0.5 * flat.length_squared());
    record.e1 = e1;
    let e1_mid = (e1_old + e1) * 0.5;
    let e2_mid = n_mid.cross(e1_mid);

    let slide = (dv - spin.cross(middle)) * dt;
    let rotation = (b.w - a.w) * dt;
    let step = BondIncrement {
        log_strain: log_strain(d, shape),
        length,
        shear: [slide.dot(e1_mid), slide.dot(e2_mid)],
        bend: [rotation.dot(e1_mid), rotation.dot(e2_mid)],
        twist: rotation.dot(n_mid),
    };
    partial.plastic += shared.law.response(shape, &mut record.force, &mut record.state, &step);
    let mut f = record.force;
    if let Some(c) = shared.viscosity.get(slot)
        && dt > 0.0
    {
        f.axial += axial_dashpot(c[0], dv.dot(n), dt, &mut record.dashpot, partial);
        let per = 1.0 / dt;
        let mut viscous = |f: &mut f64, c: f64, increment: f64| {
            *f += c * increment * per;
            partial.damping += c * increment * increment * per;
        };
        viscous(&mut f.twist, c[3], step.twist);
        for axis in 0..2 {
            viscous(&mut f.shear[axis], c[1], step.shear[axis]);
            viscous(&mut f.bend[axis], c[2], step.bend[axis]);
        }
    }
    let e2 = n.cross(e1);
    let pull = n * f.axial + (e1 * f.shear[0] + e2 * f.shear[1]);
    BondAction { pull, moment: n * f.twist + (e1 * f.bend[0] + e2 * f.bend[1]), arm: n.cross(pull) * (0.5 * length) }
}
