//! The bonds of one chunk, as many at once as a register holds.

use super::kinematics::{Acts, Node, Step, reached};
use super::layout::{CONSTANTS, Layout, SHAPE, force, shape};
use crate::base::lanes::{BLOCK, Lanes, Mask, Real};
use crate::base::triple::Triple;
use crate::base::vectors::Vectors;
use crate::engine::state::{BondActions, CHUNK, ChunkSums};
use crate::law::bond::BondLaw;
use pulp::{Simd, WithSimd};

/// The bonds of one chunk at one step.
pub(super) struct Chunk<'a, L: BondLaw, const TURN: bool> {
    pub(super) law: &'a L,
    /// Its first slot.
    pub(super) first: usize,
    pub(super) x: &'a Vectors,
    pub(super) v: &'a Vectors,
    pub(super) w: &'a Vectors,
    /// Step (s).
    pub(super) dt: f64,
    pub(super) records: &'a mut [f64],
    /// Where the constants of each block are among `constants`.
    pub(super) kind: &'a [u32],
    pub(super) constants: &'a [f64],
    pub(super) damped: bool,
    /// Plastic strain at which each slot breaks (-), if that is the criterion.
    pub(super) limit: Option<&'a [f64]>,
    /// Which slots and blocks are those of its law, where others are not (1 or 0).
    pub(super) own: Option<(&'a [f64], &'a [bool])>,
    pub(super) actions: &'a mut [f64],
}

/// Energies of one chunk, a sum per lane of a block: added up in the same order whatever the registers' width.
#[derive(Default)]
struct Sums {
    plastic: [f64; BLOCK],
    damping: [f64; BLOCK],
}

impl<L: BondLaw, const TURN: bool> WithSimd for Chunk<'_, L, TURN> {
    /// Energies, and whether a bond may have reached its limit.
    type Output = (ChunkSums, bool);

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Self::Output {
        let (mut sums, mut due) = (Sums::default(), self.limit.is_none());
        let blocks = self.records.len() / (BLOCK * Layout::<L, TURN>::FIELDS);
        for block in 0..blocks {
            if self.own.is_some_and(|(_, blocks)| !blocks[block]) {
                continue;
            }
            for lane in (0..BLOCK).step_by(Lanes::<S>::LEN) {
                due |= self.bonds(simd, block, lane, &mut sums);
            }
        }
        let sum = |lanes: [f64; BLOCK]| lanes.iter().sum();
        (ChunkSums { plastic: sum(sums.plastic), damping: sum(sums.damping), ..Default::default() }, due)
    }
}

impl<L: BondLaw, const TURN: bool> Chunk<'_, L, TURN> {
    /// The bonds of a block from `lane` on, as many as a register holds; tells whether one may have reached its limit.
    #[inline(always)]
    fn bonds<S: Simd>(&mut self, simd: S, block: usize, lane: usize, sums: &mut Sums) -> bool {
        let fields = Layout::<L, TURN>::FIELDS;
        let slot = self.first + block * BLOCK + lane;
        let ends = [self.node(simd, slot), self.node(simd, slot + 1)];
        let record = &mut self.records[block * BLOCK * fields..(block + 1) * BLOCK * fields];
        let load = |record: &[f64], field: usize| Lanes::load(simd, record, field * BLOCK + lane);
        let live_number = load(record, Layout::<L, TURN>::LIVE);
        let zero = live_number.splat(0.0);
        let live = live_number.simd_gt(zero);

        let constants = &self.constants[self.kind[block] as usize..][..CONSTANTS * BLOCK];
        let shape = shape(|k| load(constants, k));
        let mut state = L::history(|k| load(record, Layout::<L, TURN>::HISTORY + k));
        let across = |k| if TURN { load(record, Layout::<L, TURN>::ACROSS + k) } else { zero };
        let mut force = force(load(record, Layout::<L, TURN>::AXIAL), across);
        let mut dashpot = load(record, Layout::<L, TURN>::DASHPOT);
        let viscosity = self.damped.then(|| {
            [load(constants, SHAPE), load(constants, SHAPE + 1), load(constants, SHAPE + 2), load(constants, SHAPE + 3)]
        });

        let (dt, per) = (zero.splat(self.dt), zero.splat(1.0 / self.dt));
        let mut step = Step { law: self.law, dt, per, live, plastic: zero, damping: zero };
        let acts = if TURN {
            let frame = |k| load(record, Layout::<L, TURN>::FRAME + k);
            let mut e1 = Triple { x: frame(0), y: frame(1), z: frame(2) };
            let acts = step.turning(&ends, &shape, &mut e1, &mut force, &mut state, &mut dashpot, viscosity);
            let frame = Layout::<L, TURN>::FRAME * BLOCK + lane;
            e1.x.store(record, frame);
            e1.y.store(record, frame + BLOCK);
            e1.z.store(record, frame + 2 * BLOCK);
            let across = [force.shear[0], force.shear[1], force.bend[0], force.bend[1], force.twist];
            for (k, f) in across.into_iter().enumerate() {
                keep(simd, record, live, (Layout::<L, TURN>::ACROSS + k) * BLOCK + lane, f);
            }
            acts
        } else {
            step.stretching(&ends, &shape, &mut force, &mut state, &mut dashpot, viscosity)
        };
        keep(simd, record, live, Layout::<L, TURN>::AXIAL * BLOCK + lane, force.axial);
        keep(simd, record, live, Layout::<L, TURN>::DASHPOT * BLOCK + lane, dashpot);
        let history = Layout::<L, TURN>::HISTORY * BLOCK + lane;
        let mut thinning = self.law.thinning(&shape, &state);
        if (!live).any() {
            L::each_number(&state, |k, number| keep(simd, record, live, history + k * BLOCK, number));
            // What a bond has thinned stays thin when it breaks.
            let before = Lanes::load(simd, self.actions, BondActions::THINNING * CHUNK + block * BLOCK + lane);
            thinning = Lanes::select(live, thinning, before);
        } else {
            L::each_number(&state, |k, number| number.store(record, history + k * BLOCK));
        }
        let book = |sum: &mut [f64; BLOCK], part: Lanes<S>| {
            (Lanes::load(simd, sum, lane) + Lanes::select(live, part, zero)).store(sum, lane);
        };
        book(&mut sums.plastic, step.plastic);
        book(&mut sums.damping, step.damping);
        self.act(simd, block, lane, live, &acts, thinning);
        self.limit.is_some_and(|limit| {
            let limit = Lanes::load_up_to_end(simd, limit, slot);
            (live & reached(self.law.plastic_strain(&shape, &state), limit)).any()
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

    /// Writes what the bonds do, nothing where none holds, and their factors on the radius.
    #[inline(always)]
    fn act<S: Simd>(
        &mut self,
        simd: S,
        block: usize,
        lane: usize,
        live: <Lanes<S> as Real>::Mask,
        acts: &Acts<Lanes<S>>,
        thinning: Lanes<S>,
    ) {
        let at = block * BLOCK + lane;
        let Acts { pull, near, far } = acts;
        thinning.store(self.actions, BondActions::THINNING * CHUNK + at);
        let all = [pull.x, pull.y, pull.z, near.x, near.y, near.z, far.x, far.y, far.z];
        let fields = if TURN { BondActions::FAR + 3 } else { BondActions::PULL + 3 } - BondActions::PULL;
        let zero = thinning.splat(0.0);
        match self.own {
            None => {
                for (field, number) in all.into_iter().enumerate().take(fields) {
                    let at = (BondActions::PULL + field) * CHUNK + at;
                    Lanes::select(live, number, zero).store(self.actions, at);
                }
            }
            // Bonds of other laws in the same block have put theirs.
            Some((slots, _)) => {
                let own = Lanes::load_up_to_end(simd, slots, block * BLOCK + lane).simd_gt(zero);
                for (field, number) in all.into_iter().enumerate().take(fields) {
                    let at = (BondActions::PULL + field) * CHUNK + at;
                    let others = Lanes::load(simd, self.actions, at);
                    Lanes::select(own, Lanes::select(live, number, zero), others).store(self.actions, at);
                }
            }
        }
    }
}

const _: () =
    assert!(BondActions::THINNING == 0 && BondActions::PULL == 1 && BondActions::NEAR == 4 && BondActions::FAR == 7);

/// Writes what bonds remember. Of a bond that broke it stays as it was then, no force and its last plastic strain, wherever
/// its two particles go: whoever reads a record need not ask whether the bond holds. No closure, which would not be compiled
/// for the registers that `simd` stands for.
#[inline(always)]
fn keep<S: Simd>(simd: S, record: &mut [f64], live: <Lanes<S> as Real>::Mask, at: usize, number: Lanes<S>) {
    Lanes::select(live, number, Lanes::load(simd, record, at)).store(record, at);
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
