//! Bond stage: kinematics of every bond, its law, damping, and what it does to its two particles.
//!
//! Generic over the law and over whether particles turn; the loop inside is monomorphic and takes as many bonds at
//! once as the machine's registers hold. Log axial strain on the current length; shear, bending and torsion by
//! increments in the bond's co-rotating frame (n, e₁, e₂), measured at mid-step so that a rigid rotation gives none up
//! to third order in its angle per step.
//!
//! Everything that a bond remembers lies in blocks of [`BLOCK`] slots, field after field: one stream of memory, from
//! which a register takes a field of a whole block.

pub mod trial;

use super::bytes::{Bytes, NUMBER, VECTOR, behind};
use super::rupture::{Criterion, RuptureCheck};
use super::state::{BondActions, CHUNK, Partial, State};
use super::time_step::Stiffness;
use crate::base::lanes::{BLOCK, Lanes, Mask, Real};
use crate::base::triple::Triple;
use crate::base::vectors::Vectors;
use crate::law::bond::{BondForce, BondIncrement, BondLaw, BondShape, Section};
use crate::law::damping::viscous_coefficient;
use crate::strand::assembly::Assembly;
use pulp::{Arch, Simd, WithSimd};
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
    /// Memory of the stage.
    fn bytes(&self) -> Bytes;
}

/// Bonds with law `L`; `TURN` says whether particles turn.
pub struct BondStage<L: BondLaw, const TURN: bool> {
    law: L,
    /// Blocks of [`Self::FIELDS`] fields.
    records: Vec<f64>,
    /// Blocks of the viscous coefficients of axial, shear [N s/m], bending, torsion [N m s]; empty without damping.
    viscosity: Vec<f64>,
    rupture: Option<RuptureCheck>,
    partial: Vec<Partial>,
    /// Whether a bond of each chunk may have reached its limit at this step.
    due: Vec<bool>,
    arch: Arch,
}

/// Viscous coefficients of a bond.
const MODES: usize = 4;
/// l₀, r₀ and their inverses.
const SHAPE_FIELDS: usize = 4;

impl<L: BondLaw, const TURN: bool> BondStage<L, TURN> {
    // Places of the fields in a block. A bond that only stretches has no frame and no force but the axial one.
    const FRAME: usize = 0;
    const AXIAL: usize = if TURN { 3 } else { 0 };
    const ACROSS: usize = Self::AXIAL + 1;
    const DASHPOT: usize = Self::ACROSS + if TURN { 5 } else { 0 };
    const HISTORY: usize = Self::DASHPOT + 1;
    const SHAPE: usize = Self::HISTORY + L::HISTORY;
    /// 1 where the bond holds, 0 elsewhere.
    const LIVE: usize = Self::SHAPE + SHAPE_FIELDS;
    const FIELDS: usize = Self::LIVE + 1;

    /// All bonds of the assembly; `damping` is the fraction of critical per mode [-].
    pub fn new(law: L, assembly: &Assembly, damping: [f64; MODES], rupture: Option<RuptureCheck>) -> Self {
        let n = assembly.len();
        let blocks = n.div_ceil(BLOCK);
        let damped = damping.iter().any(|d| *d > 0.0);
        let mut stage = Self {
            law,
            records: vec![0.0; blocks * BLOCK * Self::FIELDS],
            viscosity: vec![0.0; if damped { blocks * BLOCK * MODES } else { 0 }],
            rupture,
            partial: vec![Partial::default(); n.div_ceil(CHUNK)],
            due: vec![true; n.div_ceil(CHUNK)],
            arch: Arch::new(),
        };
        for slot in 0..n {
            let shape = BondShape::new(assembly.rest_length[slot], assembly.radius[slot]);
            stage.set_up(slot, &shape, assembly);
            if damped && assembly.is_bond(slot) {
                for (mode, c) in viscosity(&stage.law, assembly, &shape, slot, damping).into_iter().enumerate() {
                    stage.viscosity[place(MODES, slot, mode)] = c;
                }
            }
        }
        stage
    }

    /// The record of a slot before any load.
    fn set_up(&mut self, slot: usize, shape: &BondShape, assembly: &Assembly) {
        let initial = self.law.initial();
        L::each_number(&initial, |k, number| self.set(slot, Self::HISTORY + k, number));
        // A slot without a bond has no length; its inverse must not be infinite where it is not used.
        let inverse_length = if assembly.is_bond(slot) { shape.inverse_length } else { 0.0 };
        let numbers = [shape.rest_length, shape.radius, inverse_length, shape.inverse_radius];
        numbers.into_iter().enumerate().for_each(|(k, number)| self.set(slot, Self::SHAPE + k, number));
        if assembly.is_bond(slot) {
            self.set(slot, Self::LIVE, 1.0);
            if TURN {
                let axis = (assembly.position.get(slot + 1) - assembly.position.get(slot)).normalize();
                let e1 = axis.any_orthonormal_vector().to_array();
                e1.into_iter().enumerate().for_each(|(k, e)| self.set(slot, Self::FRAME + k, e));
            }
        }
    }

    fn get(&self, slot: usize, field: usize) -> f64 {
        self.records[place(Self::FIELDS, slot, field)]
    }

    fn set(&mut self, slot: usize, field: usize, number: f64) {
        self.records[place(Self::FIELDS, slot, field)] = number;
    }

    fn shape(&self, slot: usize) -> BondShape {
        shape(|k| self.get(slot, Self::SHAPE + k))
    }

    fn history(&self, slot: usize) -> L::State<f64> {
        L::history(|k| self.get(slot, Self::HISTORY + k))
    }

    fn force(&self, slot: usize) -> BondForce {
        if TURN {
            force(self.get(slot, Self::AXIAL), |k| self.get(slot, Self::ACROSS + k))
        } else {
            BondForce { axial: self.get(slot, Self::AXIAL), ..Default::default() }
        }
    }

    fn section(&self, slot: usize) -> Section {
        self.law.section(&self.shape(slot), &self.history(slot))
    }
}

/// Where field `field` of `slot` lies among blocks of `fields` fields.
#[inline(always)]
fn place(fields: usize, slot: usize, field: usize) -> usize {
    (slot / BLOCK * fields + field) * BLOCK + slot % BLOCK
}

#[inline(always)]
fn shape<R: Real>(number: impl Fn(usize) -> R) -> BondShape<R> {
    BondShape { rest_length: number(0), radius: number(1), inverse_length: number(2), inverse_radius: number(3) }
}

#[inline(always)]
fn force<R: Real>(axial: R, across: impl Fn(usize) -> R) -> BondForce<R> {
    BondForce { axial, shear: [across(0), across(1)], bend: [across(2), across(3)], twist: across(4) }
}

/// Coefficients 2ξ√(k m) with the reduced mass (or inertia) of the two ends.
fn viscosity<L: BondLaw>(law: &L, a: &Assembly, shape: &BondShape, i: usize, damping: [f64; MODES]) -> [f64; MODES] {
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
    let pull = state.bond.pull(slot).dot(state.v.get(slot + 1) - state.v.get(slot));
    let [near, far] = state.bond.moments(slot);
    pull - near.dot(state.w.get(slot)) - far.dot(state.w.get(slot + 1))
}

impl<L: BondLaw, const TURN: bool> Bonds for BondStage<L, TURN> {
    fn compute(&mut self, state: &mut State) -> Partial {
        let blocks = CHUNK / BLOCK;
        let fields = state.bond.fields();
        let (law, viscosity, arch) = (&self.law, &self.viscosity, self.arch);
        let limit = self.rupture.as_ref().and_then(RuptureCheck::plastic_limit);
        let (x, v, w, dt) = (&state.x, &state.v, &state.w, state.dt);
        (
            self.records.par_chunks_mut(blocks * BLOCK * Self::FIELDS),
            state.bond.data.par_chunks_mut(CHUNK * fields),
            self.partial.par_iter_mut(),
            self.due.par_iter_mut(),
        )
            .into_par_iter()
            .with_max_len(1)
            .enumerate()
            .for_each(|(chunk, (records, actions, partial, due))| {
                let first = chunk * CHUNK;
                let job = Chunk::<L, TURN> { law, first, x, v, w, dt, records, viscosity, limit, actions };
                (*partial, *due) = arch.dispatch(job);
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
        let broken =
            check.broken(&state.whole, state, |slot| (self.plastic_strain(slot), self.force(slot), self.section(slot)));
        let mut released = 0.0;
        for (slot, criterion) in broken {
            broke(slot, criterion, self.stress(slot));
            released += self.law.elastic_energy(&self.shape(slot), &self.force(slot), &self.history(slot));
            // The law has booked this step up to now with the mean of old and new force; the new one never acts.
            released -= 0.5 * state.dt * power(state, slot);
            (Self::AXIAL..Self::DASHPOT).for_each(|field| self.set(slot, field, 0.0));
            self.set(slot, Self::LIVE, 0.0);
            state.whole[slot] = false;
            state.bond.clear(slot);
        }
        released
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        let whole = (0..state.whole.len()).filter(|slot| state.whole[*slot]);
        whole.map(|s| self.law.elastic_energy(&self.shape(s), &self.force(s), &self.history(s))).sum()
    }

    fn stiffness(&self, state: &State, out: &mut Stiffness) {
        for i in (0..state.whole.len()).filter(|slot| state.whole[*slot]) {
            let k = self.law.stiffness(&self.shape(i), &self.history(i));
            let length = (state.x.get(i + 1) - state.x.get(i)).length();
            let damped = !self.viscosity.is_empty();
            let coefficient = |mode| if damped { self.viscosity[place(MODES, i, mode)] } else { 0.0 };
            out.bond(i, &k, length, std::array::from_fn(coefficient), TURN);
        }
    }

    fn stress(&self, slot: usize) -> f64 {
        self.axial_force(slot) / self.section(slot).area
    }

    fn axial_force(&self, slot: usize) -> f64 {
        self.get(slot, Self::AXIAL)
    }

    fn plastic_strain(&self, slot: usize) -> f64 {
        self.law.plastic_strain(&self.shape(slot), &self.history(slot))
    }

    fn utilisation(&self, slot: usize, state: &State) -> f64 {
        let Some(check) = &self.rupture else { return 0.0 };
        check.utilisation(slot, state, self.plastic_strain(slot), &self.force(slot), &self.section(slot))
    }

    fn bytes(&self) -> Bytes {
        let slots = self.records.len() / Self::FIELDS;
        let limits = self.rupture.as_ref().map_or(0, RuptureCheck::bytes);
        let checked = self.rupture.as_ref().and_then(RuptureCheck::plastic_limit).map_or(0, |_| NUMBER);
        let nodes = if TURN { 3 * VECTOR } else { 2 * VECTOR };
        // Shapes and flags are only read, the rest of a record is written back.
        let written = Self::SHAPE * NUMBER;
        let actions = BondActions::fields_of(TURN) * NUMBER;
        Bytes {
            kept: behind(&self.records) + behind(&self.viscosity) + behind(&self.partial) + behind(&self.due) + limits,
            moved: size_of_val(&self.records[..])
                + size_of_val(&self.viscosity[..])
                + slots * (written + nodes + actions + checked),
        }
    }
}

/// The bonds of one chunk at one step.
struct Chunk<'a, L: BondLaw, const TURN: bool> {
    law: &'a L,
    /// Its first slot.
    first: usize,
    x: &'a Vectors,
    v: &'a Vectors,
    w: &'a Vectors,
    /// Step [s].
    dt: f64,
    records: &'a mut [f64],
    viscosity: &'a [f64],
    /// Plastic strain at which each slot breaks [-], if that is the criterion.
    limit: Option<&'a [f64]>,
    actions: &'a mut [f64],
}

/// Energies of one chunk, a sum per lane of a block: added up in the same order whatever the registers' width.
#[derive(Default)]
struct Sums {
    plastic: [f64; BLOCK],
    damping: [f64; BLOCK],
}

/// Particles as their bonds see them.
#[derive(Clone, Copy)]
struct Node<R> {
    x: Triple<R>,
    v: Triple<R>,
    w: Triple<R>,
}

/// What bonds do: pull on the first particle [N] (the second feels minus this), moments on the first and on the second
/// [N m].
struct Acts<R> {
    pull: Triple<R>,
    near: Triple<R>,
    far: Triple<R>,
}

impl<L: BondLaw, const TURN: bool> WithSimd for Chunk<'_, L, TURN> {
    /// Energies, and whether a bond may have reached its limit.
    type Output = (Partial, bool);

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Self::Output {
        let (mut sums, mut due) = (Sums::default(), self.limit.is_none());
        let blocks = self.records.len() / (BLOCK * BondStage::<L, TURN>::FIELDS);
        for block in 0..blocks {
            for lane in (0..BLOCK).step_by(Lanes::<S>::LEN) {
                due |= self.bonds(simd, block, lane, &mut sums);
            }
        }
        let sum = |lanes: [f64; BLOCK]| lanes.iter().sum();
        (Partial { plastic: sum(sums.plastic), damping: sum(sums.damping), ..Default::default() }, due)
    }
}

impl<L: BondLaw, const TURN: bool> Chunk<'_, L, TURN> {
    /// The bonds of a block from `lane` on, as many as a register holds; tells whether one may have reached its limit.
    #[inline(always)]
    fn bonds<S: Simd>(&mut self, simd: S, block: usize, lane: usize, sums: &mut Sums) -> bool {
        let fields = BondStage::<L, TURN>::FIELDS;
        let slot = self.first + block * BLOCK + lane;
        let ends = [self.node(simd, slot), self.node(simd, slot + 1)];
        let record = &mut self.records[block * BLOCK * fields..(block + 1) * BLOCK * fields];
        let load = |record: &[f64], field: usize| Lanes::load(simd, record, field * BLOCK + lane);
        let live_number = load(record, BondStage::<L, TURN>::LIVE);
        let zero = live_number.like(0.0);
        let live = live_number.above(zero);

        let shape = shape(|k| load(record, BondStage::<L, TURN>::SHAPE + k));
        let mut state = L::history(|k| load(record, BondStage::<L, TURN>::HISTORY + k));
        let across = |k| if TURN { load(record, BondStage::<L, TURN>::ACROSS + k) } else { zero };
        let mut force = force(load(record, BondStage::<L, TURN>::AXIAL), across);
        let mut dashpot = load(record, BondStage::<L, TURN>::DASHPOT);
        let viscosity = (!self.viscosity.is_empty() && self.dt > 0.0).then(|| {
            let all = &self.viscosity[place(MODES, slot, 0)..][..(MODES - 1) * BLOCK + Lanes::<S>::LEN];
            let mode = |k: usize| Lanes::load(simd, all, k * BLOCK);
            [mode(0), mode(1), mode(2), mode(3)]
        });

        let mut step = Step { law: self.law, dt: self.dt, live, plastic: zero, damping: zero };
        let acts = if TURN {
            let frame = |k| load(record, BondStage::<L, TURN>::FRAME + k);
            let mut e1 = Triple { x: frame(0), y: frame(1), z: frame(2) };
            let acts = step.turning(&ends, &shape, &mut e1, &mut force, &mut state, &mut dashpot, viscosity);
            let frame = BondStage::<L, TURN>::FRAME * BLOCK + lane;
            e1.x.store(record, frame);
            e1.y.store(record, frame + BLOCK);
            e1.z.store(record, frame + 2 * BLOCK);
            let across = BondStage::<L, TURN>::ACROSS * BLOCK + lane;
            force.shear[0].store(record, across);
            force.shear[1].store(record, across + BLOCK);
            force.bend[0].store(record, across + 2 * BLOCK);
            force.bend[1].store(record, across + 3 * BLOCK);
            force.twist.store(record, across + 4 * BLOCK);
            acts
        } else {
            step.stretching(&ends, &shape, &mut force, &mut state, &mut dashpot, viscosity)
        };
        force.axial.store(record, BondStage::<L, TURN>::AXIAL * BLOCK + lane);
        dashpot.store(record, BondStage::<L, TURN>::DASHPOT * BLOCK + lane);
        L::each_number(&state, |k, number| {
            number.store(record, (BondStage::<L, TURN>::HISTORY + k) * BLOCK + lane);
        });
        let book = |sum: &mut [f64; BLOCK], part: Lanes<S>| {
            (Lanes::load(simd, sum, lane) + Lanes::choose(live, part, zero)).store(sum, lane);
        };
        book(&mut sums.plastic, step.plastic);
        book(&mut sums.damping, step.damping);
        self.act(block, lane, live, &acts, self.law.thinning(&shape, &state));
        self.limit.is_some_and(|limit| {
            let limit = Lanes::load_up_to_end(simd, limit, slot);
            (live & !limit.above(self.law.plastic_strain(&shape, &state))).any()
        })
    }

    #[inline(always)]
    fn node<S: Simd>(&self, simd: S, p: usize) -> Node<Lanes<S>> {
        let still = Lanes::splat(simd, 0.0);
        Node {
            x: vector(simd, self.x, p),
            v: vector(simd, self.v, p),
            w: if TURN { vector(simd, self.w, p) } else { Triple { x: still, y: still, z: still } },
        }
    }

    /// Writes what the bonds do, and zeros for those that are not there.
    #[inline(always)]
    fn act<S: Simd>(
        &mut self,
        block: usize,
        lane: usize,
        live: <Lanes<S> as Real>::Mask,
        acts: &Acts<Lanes<S>>,
        thinning: Lanes<S>,
    ) {
        let at = block * BLOCK + lane;
        let mut put = |field: usize, number: Lanes<S>| {
            Lanes::choose(live, number, number.like(0.0)).store(self.actions, field * CHUNK + at);
        };
        put(BondActions::THINNING, thinning);
        put(BondActions::PULL, acts.pull.x);
        put(BondActions::PULL + 1, acts.pull.y);
        put(BondActions::PULL + 2, acts.pull.z);
        if TURN {
            put(BondActions::NEAR, acts.near.x);
            put(BondActions::NEAR + 1, acts.near.y);
            put(BondActions::NEAR + 2, acts.near.z);
            put(BondActions::FAR, acts.far.x);
            put(BondActions::FAR + 1, acts.far.y);
            put(BondActions::FAR + 2, acts.far.z);
        }
    }
}

/// The vectors from particle `p` on.
#[inline(always)]
fn vector<S: Simd>(simd: S, v: &Vectors, p: usize) -> Triple<Lanes<S>> {
    Triple {
        x: Lanes::load_up_to_end(simd, &v.x, p),
        y: Lanes::load_up_to_end(simd, &v.y, p),
        z: Lanes::load_up_to_end(simd, &v.z, p),
    }
}

/// A step of some bonds: what they share, and the energies that they give off [J].
struct Step<'a, L: BondLaw, R: Real> {
    law: &'a L,
    dt: f64,
    live: R::Mask,
    plastic: R,
    damping: R,
}

/// Length of a bond [m] and its direction.
#[inline(always)]
fn axis<R: Real>(d: Triple<R>) -> (R, Triple<R>) {
    let square = d.length_squared();
    let inverse = square.inverse_sqrt();
    (square * inverse, d * inverse)
}

/// ln(l/l₀), from the square of the length, which is there before its root [-].
#[inline(always)]
fn log_strain<R: Real>(d: Triple<R>, shape: &BondShape<R>) -> R {
    (d.length_squared() * (shape.inverse_length * shape.inverse_length)).ln() * 0.5
}

impl<L: BondLaw, R: Real> Step<'_, L, R> {
    /// Bonds that only stretch.
    #[inline(always)]
    fn stretching(
        &mut self,
        [a, b]: &[Node<R>; 2],
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        state: &mut L::State<R>,
        dashpot: &mut R,
        viscosity: Option<[R; MODES]>,
    ) -> Acts<R> {
        let d = b.x - a.x;
        let (length, n) = axis(d);
        let zero = length.like(0.0);
        let log_strain = log_strain(d, shape);
        let step = BondIncrement { log_strain, length, shear: [zero; 2], bend: [zero; 2], twist: zero };
        self.plastic = self.law.axial_response(shape, force, state, &step, self.live);
        let mut axial = force.axial;
        if let Some(c) = viscosity {
            axial += self.axial_dashpot(c[0], (b.v - a.v).dot(n), dashpot);
        }
        let none = Triple { x: zero, y: zero, z: zero };
        Acts { pull: n * axial, near: none, far: none }
    }

    /// Force of the axial dashpot at an elongation rate [m/s]; one formula for both kinds of bond, so that they agree
    /// to the bit. The first evaluation, before any step (`dt` = 0), has none: its work would go unbooked.
    ///
    /// Work is the mean of `last` and present force over the step between them. The present force alone books too much
    /// where the rate falls from step to step, as in the ringing after a rupture.
    #[inline(always)]
    fn axial_dashpot(&mut self, coefficient: R, rate: R, last: &mut R) -> R {
        let force = coefficient * rate;
        self.damping += (*last + force) * 0.5 * rate * self.dt;
        *last = force;
        force
    }

    /// Adds the force of a dashpot across to `f`; `per` is the inverse of the step [1/s].
    #[inline(always)]
    fn dashpot(&mut self, f: &mut R, coefficient: R, increment: R, per: f64) {
        let push = coefficient * increment * per;
        *f += push;
        self.damping += push * increment;
    }

    /// Bonds in all modes.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn turning(
        &mut self,
        [a, b]: &[Node<R>; 2],
        shape: &BondShape<R>,
        e1: &mut Triple<R>,
        force: &mut BondForce<R>,
        state: &mut L::State<R>,
        dashpot: &mut R,
        viscosity: Option<[R; MODES]>,
    ) -> Acts<R> {
        let dt = self.dt;
        let (d, dv) = (b.x - a.x, b.v - a.v);
        let (length, n) = axis(d);

        // Mid-step geometry.
        let middle = d - dv * length.like(0.5 * dt);
        let inv_middle = middle.length_squared().inverse_sqrt();
        let n_mid = middle * inv_middle;
        let spin = (a.w + b.w).map(|w| w * 0.5);
        // The frame turns with the bond's direction and with the mean spin about it.
        let turn = n_mid.cross(dv) * (inv_middle * dt) + n_mid * (spin.dot(n_mid) * dt);
        let e1_old = *e1;
        let carried = e1_old + turn.cross(e1_old);
        let flat = carried - n * carried.dot(n);
        // Its length differs from 1 by the square of a step's rotation; one Newton step of 1/√q mends that.
        *e1 = flat * (flat.length_squared() * -0.5 + 1.5);
        let e1_mid = (e1_old + *e1).map(|e| e * 0.5);
        let e2_mid = n_mid.cross(e1_mid);

        let slide = (dv - spin.cross(middle)).map(|s| s * dt);
        let rotation = (b.w - a.w).map(|w| w * dt);
        let step = BondIncrement {
            log_strain: log_strain(d, shape),
            length,
            shear: [slide.dot(e1_mid), slide.dot(e2_mid)],
            bend: [rotation.dot(e1_mid), rotation.dot(e2_mid)],
            twist: rotation.dot(n_mid),
        };
        self.plastic = self.law.response(shape, force, state, &step, self.live);
        let mut f = *force;
        if let Some(c) = viscosity {
            f.axial += self.axial_dashpot(c[0], dv.dot(n), dashpot);
            let per = 1.0 / dt;
            self.dashpot(&mut f.twist, c[3], step.twist, per);
            for axis in 0..2 {
                self.dashpot(&mut f.shear[axis], c[1], step.shear[axis], per);
                self.dashpot(&mut f.bend[axis], c[2], step.bend[axis], per);
            }
        }
        let e2 = n.cross(*e1);
        let pull = n * f.axial + (*e1 * f.shear[0] + e2 * f.shear[1]);
        let moment = n * f.twist + (*e1 * f.bend[0] + e2 * f.bend[1]);
        let arm = n.cross(pull) * (length * 0.5);
        Acts { pull, near: arm + moment, far: arm - moment }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_of_a_block_is_contiguous() {
        assert_eq!(place(5, 0, 0), 0);
        assert_eq!(place(5, 7, 2), 2 * BLOCK + 7);
        assert_eq!(place(5, BLOCK, 0), 5 * BLOCK);
    }
}
