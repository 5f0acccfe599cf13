//! The contacts of one chunk at one step, as many at once as a register holds.

use super::block::Block;
use super::meeting::{Between, arms, surface_velocity};
use super::store::Store;
use crate::base::lanes::{BLOCK, Lanes, Mask, Real};
use crate::base::triple::Triple;
use crate::engine::contact::law_table::LawTable;
use crate::engine::contact::pair::{ContactKinematics, Dissipated, History, PairForce, contact_response};
use crate::engine::state::{ChunkSums, ContactSides, Deepest, ParticleView};
use crate::law::contact::NormalLaw;
use crate::law::tangential::TangentialLaw;
use pulp::{Simd, WithSimd};

/// Rows of [`BLOCK`] numbers that a block leaves for its second sides: what it takes from their force (N), and where
/// friction acts their torque (N m).
pub const fn rows<T: TangentialLaw>() -> usize {
    if T::ACTIVE { 6 } else { 3 }
}

/// The contacts of one chunk.
pub struct Chunk<'a, N: NormalLaw, T: TangentialLaw> {
    pub laws: &'a LawTable<N, T>,
    pub seen: &'a ParticleView<'a>,
    /// The deepest contact of the run so far.
    pub deepest: Deepest,
    /// See [`closing`](crate::engine::contact::stage::closing).
    pub closing: f64,
    pub constants: &'a [f64],
    /// The first particle.
    pub first: usize,
    pub store: &'a mut Store,
    /// Of the chunk's particles.
    pub sides: ContactSides<'a>,
}

/// Energies of one chunk, a sum per lane: added up in the same order whatever the registers' width.
#[derive(Default)]
struct Sums {
    plastic: [f64; BLOCK],
    thinning: [f64; BLOCK],
    friction: [f64; BLOCK],
    damping: [f64; BLOCK],
}

impl Sums {
    #[inline(always)]
    fn book<S: Simd>(&mut self, simd: S, lane: usize, given: &Dissipated<Lanes<S>>, counts: <Lanes<S> as Real>::Mask) {
        let book = |sum: &mut [f64; BLOCK], part: Lanes<S>| {
            (Lanes::load(simd, sum, lane) + Lanes::select(counts, part, part.splat(0.0))).store(sum, lane);
        };
        book(&mut self.plastic, given.plastic);
        book(&mut self.thinning, given.thinning);
        book(&mut self.friction, given.friction);
        book(&mut self.damping, given.damping);
    }

    fn partial(&self, deepest: Deepest) -> ChunkSums {
        let sum = |lanes: [f64; BLOCK]| lanes.iter().sum();
        let (plastic, thinning) = (sum(self.plastic), sum(self.thinning));
        ChunkSums {
            plastic,
            thinning,
            friction: sum(self.friction),
            damping: sum(self.damping),
            released: 0.0,
            deepest,
        }
    }
}

/// Particles as their contacts see them.
#[derive(Clone, Copy)]
struct Ball<R> {
    x: Triple<R>,
    radius: R,
    thinned: R,
}

impl<N: NormalLaw, T: TangentialLaw> WithSimd for Chunk<'_, N, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        self.sides.rows(T::ACTIVE).for_each(|row| row.fill(0.0));
        let mut sums = Sums::default();
        for b in 0..self.store.blocks.len() {
            if self.store.blocks[b].quiet_until > self.seen.travel {
                continue;
            }
            let mut acts = false;
            let mut gap = [f64::INFINITY; BLOCK];
            for lane in (0..BLOCK).step_by(Lanes::<S>::LEN) {
                acts |= self.contacts(simd, b, lane, &mut sums, &mut gap);
            }
            let block = &mut self.store.blocks[b];
            block.acts = acts;
            // The least gap, used up when every particle has come nearer at the greatest speed there was.
            let least = gap.into_iter().fold(f64::INFINITY, f64::min);
            block.quiet_until = self.seen.travel + least.max(0.0) / self.closing;
        }
        self.store.partial = sums.partial(self.deepest);
    }
}

impl<N: NormalLaw, T: TangentialLaw> Chunk<'_, N, T> {
    const FIELDS: usize = History::<N, T>::NUMBERS;

    /// The contacts of a block from `lane` on, as many as a register holds; tells whether one of them touches. `gap`
    /// gets the gaps of pairs that are apart, and 0 where something is remembered of a touch.
    #[inline(always)]
    fn contacts<S: Simd>(&mut self, simd: S, b: usize, lane: usize, sums: &mut Sums, gap: &mut [f64; BLOCK]) -> bool {
        let block = self.store.blocks[b];
        let (i, j) = (block.i as usize + lane, block.j as usize + lane);
        let load = |record: &[f64], field: usize| Lanes::load(simd, record, field * BLOCK + lane);
        let (first, second) = (ball(simd, self.seen, i), ball(simd, self.seen, j));
        let zero = first.radius.splat(0.0);
        let constants = block.constants as usize + lane;
        let reduced = Lanes::load(simd, self.constants, constants);
        let [offset, before] = match self.store.record(&block, Self::FIELDS) {
            Some(record) => [History::<N, T>::OFFSET, History::<N, T>::FORCE].map(|field| load(record, field)),
            None => [zero; 2],
        };
        let pairs = reduced.simd_gt(zero);
        let between = Between::of(second.x - first.x, first.radius + second.radius, offset);
        let overlap = between.overlap;
        let touches = overlap.simd_gt(zero) & pairs;
        let remembers = before.simd_gt(zero) | offset.simd_gt(zero);
        if !(touches | remembers).any() {
            Lanes::select(pairs, -overlap, zero.splat(f64::INFINITY)).store(gap, lane);
            if Lanes::<S>::LEN < BLOCK && block.record != Block::NOTHING {
                self.still(simd, b, lane);
            }
            return false;
        }
        zero.store(gap, lane);

        let [record, _] = self.store.acting(b, Self::FIELDS, rows::<T>());
        let mut history = History::<N, T, _>::of(reduced, |k| load(record, k));
        let overlap = Lanes::select(touches, overlap, zero);
        let normal = between.normal();
        let arms = arms([first.radius, second.radius], overlap, offset);
        let velocity = velocity::<S, T>(simd, self.seen, [i, j], normal, arms);
        let viscosity = Lanes::load(simd, self.constants, constants + BLOCK);
        let thinner = first.thinned + second.thinned;
        let dt = zero.splat(self.seen.dt);
        let meeting = ContactKinematics { normal, overlap, thinner, velocity, viscosity, dt };
        let (pair, given) = contact_response(self.laws.at(block.law as usize), &mut history, &meeting);
        sums.book(simd, lane, &given, pairs);
        history.each_number(|k, number| number.store(record, k * BLOCK + lane));

        let least = first.radius.simd_min(second.radius);
        let deep = touches & overlap.simd_gt(least * self.deepest.ratio);
        if deep.any() {
            self.deepen([i, j], overlap, least, &history, deep);
        }
        self.act(simd, b, lane, touches, &pair, normal, arms);
        touches.any()
    }

    /// Nothing of a part of a block touches, of which another part may act.
    #[inline(always)]
    fn still<S: Simd>(&mut self, simd: S, b: usize, lane: usize) {
        let [_, actions] = self.store.acting(b, Self::FIELDS, rows::<T>());
        (0..rows::<T>()).for_each(|row| Lanes::splat(simd, 0.0).store(actions, row * BLOCK + lane));
    }

    #[inline(always)]
    fn deepen<R: Real>(&mut self, [i, j]: [usize; 2], overlap: R, least: R, history: &History<N, T, R>, deep: R::Mask) {
        let deep = R::select(deep, overlap, overlap.splat(0.0));
        for k in 0..R::COUNT {
            let pair = [(i + k) as u32, (j + k) as u32];
            let (reduced, force) = (history.reduced_radius.at(k), history.normal_force.at(k));
            let area = || std::f64::consts::PI * reduced * deep.at(k);
            self.deepest.take_in(pair, deep.at(k), least.at(k), area, force);
        }
    }

    /// Adds to the first sides, and leaves for the second ones what to take from their force and to add to their torque.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn act<S: Simd>(
        &mut self,
        simd: S,
        b: usize,
        lane: usize,
        touches: <Lanes<S> as Real>::Mask,
        pair: &PairForce<Lanes<S>>,
        normal: Triple<Lanes<S>>,
        arms: [Lanes<S>; 2],
    ) {
        let nothing = Triple::zero(arms[0].splat(0.0));
        let own = self.store.blocks[b].i as usize + lane - self.first;
        let [_, actions] = self.store.acting(b, Self::FIELDS, rows::<T>());
        let force = Triple::select(touches, pair.force, nothing);
        add(simd, &mut self.sides.force, own, force);
        store(force, actions, lane);
        if T::ACTIVE {
            let twist = Triple::select(touches, normal.cross(pair.friction), nothing);
            add(simd, &mut self.sides.torque, own, twist * arms[0]);
            store(twist * arms[1], actions, 3 * BLOCK + lane);
        }
    }
}

/// Adds to the vectors from `at` on, as far as they go.
#[inline(always)]
fn add<S: Simd>(simd: S, rows: &mut [&mut [f64]; 3], at: usize, v: Triple<Lanes<S>>) {
    let [x, y, z] = rows;
    (Lanes::load_up_to_end(simd, x, at) + v.x).store_up_to_end(x, at);
    (Lanes::load_up_to_end(simd, y, at) + v.y).store_up_to_end(y, at);
    (Lanes::load_up_to_end(simd, z, at) + v.z).store_up_to_end(z, at);
}

/// Writes three rows.
#[inline(always)]
fn store<S: Simd>(v: Triple<Lanes<S>>, rows: &mut [f64], at: usize) {
    v.x.store(rows, at);
    v.y.store(rows, at + BLOCK);
    v.z.store(rows, at + 2 * BLOCK);
}

#[inline(always)]
fn vector<S: Simd>(simd: S, [x, y, z]: &[&[f64]; 3], p: usize) -> Triple<Lanes<S>> {
    Triple {
        x: Lanes::load_up_to_end(simd, x, p),
        y: Lanes::load_up_to_end(simd, y, p),
        z: Lanes::load_up_to_end(simd, z, p),
    }
}

#[inline(always)]
fn ball<S: Simd>(simd: S, seen: &ParticleView, p: usize) -> Ball<Lanes<S>> {
    let load = |row: &[f64]| Lanes::load_up_to_end(simd, row, p);
    Ball { x: vector(simd, &seen.x, p), radius: load(seen.radius), thinned: load(seen.thinned) }
}

/// Velocity of the second surfaces relative to the first where they meet (m/s).
#[inline(always)]
fn velocity<S: Simd, T: TangentialLaw>(
    simd: S,
    seen: &ParticleView,
    [i, j]: [usize; 2],
    normal: Triple<Lanes<S>>,
    arms: [Lanes<S>; 2],
) -> Triple<Lanes<S>> {
    let slide = vector(simd, &seen.v, j) - vector(simd, &seen.v, i);
    if !T::ACTIVE {
        return slide;
    }
    surface_velocity(slide, [vector(simd, &seen.w, i), vector(simd, &seen.w, j)], arms, normal)
}
