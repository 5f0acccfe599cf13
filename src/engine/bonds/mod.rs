//! Bond stage: kinematics of every bond, its law, damping, and what it does to its two particles.
//!
//! Generic over the law and over whether particles turn; the loop inside is monomorphic and takes as many bonds at
//! once as the machine's registers hold. Log axial strain on the current length; shear, bending and torsion by
//! increments in the bond's co-rotating frame (n, e₁, e₂), measured at mid-step so that a rigid rotation gives none up
//! to third order in its angle per step.
//!
//! Everything that a bond remembers lies in blocks of [`BLOCK`] slots, field after field: one stream of memory, from
//! which a register takes a field of a whole block. Its shape and its dashpots, which never change, are kept once for all
//! blocks that are alike.

pub mod formula;
mod kernel;
mod kinematics;
mod layout;
mod several;
mod stage;
pub mod trial;

use crate::base::lanes::BLOCK;
use crate::base::recorder::Function;
use crate::engine::bytes::{Bytes, NUMBER, VECTOR, behind};
use crate::engine::rupture::{Criterion, RuptureCheck};
use crate::engine::saved::{Reader, Unfit, Writer};
use crate::engine::shared_rows::SharedRows;
use crate::engine::state::{BondActions, CHUNK, ChunkSums, State};
use crate::engine::team::Team;
use crate::engine::time_step::Element;
use crate::law::bond::elastic::Elastic;
use crate::law::bond::elasto_plastic::ElastoPlastic;
use crate::law::bond::{BondForce, BondLaw, BondShape, Moduli, Section};
use crate::law::damping::viscous_coefficient;
use crate::scene::plan::Plan;
use crate::scene::spec::{BondLawSpec, BondSpec, OneMaterial, Spec};
use crate::strand::assembly::Assembly;
use formula::{BondInRun, BondStep};
use kernel::Chunk;
use layout::{CONSTANTS, Layout, MODES, SHAPE, constant_named, force, place, shape};
use pulp::Arch;
use several::{Own, SeveralBonds};
pub use stage::Bonds;

/// Chooses law and modes, once per run and material.
pub fn build(spec: &Spec, plan: &Plan, assembly: &Assembly) -> Box<dyn Bonds> {
    if !spec.has_several_materials() {
        return of_material(spec.material_at(0), spec.seed, plan, assembly, None);
    }
    let own = |number| Some(Own::new(number, assembly));
    let stage = |(number, one)| of_material(one, spec.seed, plan, assembly, own(number));
    Box::new(SeveralBonds::new(spec.materials().enumerate().map(stage).collect(), assembly))
}

/// Bonds of a material.
fn of_material(one: OneMaterial, seed: u64, plan: &Plan, assembly: &Assembly, own: Option<Own>) -> Box<dyn Bonds> {
    let moduli = Moduli::new(one.material.young, one.material.poisson);
    match &one.bond.law {
        BondLawSpec::Elastic => stage(Elastic { moduli }, one.bond, seed, plan, assembly, own),
        BondLawSpec::ElastoPlastic(hardening) => {
            stage(ElastoPlastic { moduli, hardening: hardening.clone() }, one.bond, seed, plan, assembly, own)
        }
    }
}

/// Bonds of the law `law`; damping and rupture are the scene's.
pub fn with_law<L: BondLaw>(law: L, spec: &Spec, plan: &Plan, assembly: &Assembly) -> Box<dyn Bonds> {
    stage(law, &spec.bond, spec.seed, plan, assembly, None)
}

fn stage<L: BondLaw>(
    law: L,
    bond: &BondSpec,
    seed: u64,
    plan: &Plan,
    assembly: &Assembly,
    own: Option<Own>,
) -> Box<dyn Bonds> {
    let check = bond.rupture.as_ref().map(|r| RuptureCheck::new(r, seed, assembly));
    if plan.rotations {
        Box::new(BondStage::<L, true>::new(law, assembly, bond.damping, check, own))
    } else {
        Box::new(BondStage::<L, false>::new(law, assembly, bond.damping, check, own))
    }
}

/// Bonds with law `L`; `TURN` says whether particles turn.
pub struct BondStage<L: BondLaw, const TURN: bool> {
    law: L,
    /// Blocks of [`Layout::FIELDS`] fields.
    records: Vec<f64>,
    /// Rows of the shapes and of the viscous coefficients of axial, shear (N s/m), bending, torsion (N m s), by kind of
    /// block.
    constants: SharedRows,
    /// Where those of each block are.
    kind: Vec<u32>,
    damped: bool,
    rupture: Option<RuptureCheck>,
    /// Which bonds are its own; `None` where all are.
    own: Option<Own>,
    partial: Vec<ChunkSums>,
    /// Whether a bond of each chunk may have reached its limit at this step.
    due: Vec<bool>,
    arch: Arch,
}

impl<L: BondLaw, const TURN: bool> BondStage<L, TURN> {
    /// The bonds of the assembly that are its `own`, all where it is `None`; `damping` is the fraction of critical per mode
    /// (-).
    pub fn new(
        law: L,
        assembly: &Assembly,
        damping: [f64; MODES],
        rupture: Option<RuptureCheck>,
        own: Option<Own>,
    ) -> Self {
        let n = assembly.len();
        let blocks = n.div_ceil(BLOCK);
        let mut stage = Self {
            law,
            records: vec![0.0; blocks * BLOCK * Layout::<L, TURN>::FIELDS],
            constants: SharedRows::default(),
            kind: Vec::with_capacity(blocks),
            damped: damping.iter().any(|d| *d > 0.0),
            rupture,
            own,
            partial: vec![ChunkSums::default(); n.div_ceil(CHUNK)],
            due: vec![true; n.div_ceil(CHUNK)],
            arch: Arch::new(),
        };
        for block in 0..blocks {
            if stage.own.as_ref().is_some_and(|own| !own.blocks[block]) {
                stage.kind.push(0);
                continue;
            }
            let mut rows = [0.0; CONSTANTS * BLOCK];
            for slot in block * BLOCK..n.min((block + 1) * BLOCK) {
                stage.set_up(slot, assembly);
                let constants = constants(&stage.law, assembly, slot, damping, stage.has(slot));
                constants.into_iter().enumerate().for_each(|(k, c)| rows[k * BLOCK + slot % BLOCK] = c);
            }
            stage.kind.push(stage.constants.place(&rows));
        }
        stage.constants.close();
        stage
    }

    /// The record of a slot before any load.
    fn set_up(&mut self, slot: usize, assembly: &Assembly) {
        let initial = self.law.initial();
        L::each_number(&initial, |k, number| self.set(slot, Layout::<L, TURN>::HISTORY + k, number));
        if assembly.is_bond(slot) && self.has(slot) {
            self.set(slot, Layout::<L, TURN>::LIVE, 1.0);
            if TURN {
                let axis = (assembly.position.get(slot + 1) - assembly.position.get(slot)).normalize();
                let e1 = axis.any_orthonormal_vector().to_array();
                e1.into_iter().enumerate().for_each(|(k, e)| self.set(slot, Layout::<L, TURN>::FRAME + k, e));
            }
        }
    }

    /// Whether a slot is of a bond that is its own, or of none.
    fn has(&self, slot: usize) -> bool {
        self.own.as_ref().is_none_or(|own| own.has(slot))
    }

    fn get(&self, slot: usize, field: usize) -> f64 {
        self.records[place(Layout::<L, TURN>::FIELDS, slot, field)]
    }

    fn set(&mut self, slot: usize, field: usize, number: f64) {
        self.records[place(Layout::<L, TURN>::FIELDS, slot, field)] = number;
    }

    fn shape(&self, slot: usize) -> BondShape {
        shape(|k| self.constant(slot, k))
    }

    fn constant(&self, slot: usize, row: usize) -> f64 {
        self.constants.rows()[self.kind[slot / BLOCK] as usize + row * BLOCK + slot % BLOCK]
    }

    fn history(&self, slot: usize) -> L::State<f64> {
        L::history(|k| self.get(slot, Layout::<L, TURN>::HISTORY + k))
    }

    fn force(&self, slot: usize) -> BondForce {
        if TURN {
            force(self.get(slot, Layout::<L, TURN>::AXIAL), |k| self.get(slot, Layout::<L, TURN>::ACROSS + k))
        } else {
            BondForce { axial: self.get(slot, Layout::<L, TURN>::AXIAL), ..Default::default() }
        }
    }

    fn section(&self, slot: usize) -> Section {
        self.law.section(&self.shape(slot), &self.history(slot))
    }
}

/// Shape of a slot, and its coefficients 2ξ√(k m) with the reduced mass (or inertia) of the two ends, where its bond is one
/// `of` the law's.
fn constants<L: BondLaw>(law: &L, a: &Assembly, i: usize, damping: [f64; MODES], of: bool) -> [f64; CONSTANTS] {
    let shape = BondShape::new(a.rest_length[i], a.radius[i]);
    if !a.is_bond(i) || !of {
        // A slot without a bond has no length; its inverse must not be infinite where it is not used.
        return [shape.rest_length, shape.radius, 0.0, shape.inverse_radius, 0.0, 0.0, 0.0, 0.0];
    }
    let reduced = |m: &[f64]| m[i] * m[i + 1] / (m[i] + m[i + 1]);
    let (mass, inertia) = (reduced(&a.mass), reduced(&a.inertia));
    let k = law.stiffness(&shape, &law.initial());
    [
        shape.rest_length,
        shape.radius,
        shape.inverse_length,
        shape.inverse_radius,
        viscous_coefficient(damping[0], mass, k.axial),
        viscous_coefficient(damping[1], mass, k.shear),
        viscous_coefficient(damping[2], inertia, k.bend),
        viscous_coefficient(damping[3], inertia, k.twist),
    ]
}

/// Power that the motion does on a bond against its whole action (W).
fn power(state: &State, slot: usize) -> f64 {
    let pull = state.bond.pull(slot).dot(state.v.get(slot + 1) - state.v.get(slot));
    let [near, far] = state.bond.moments(slot);
    pull - near.dot(state.w.get(slot)) - far.dot(state.w.get(slot + 1))
}

impl<L: BondLaw, const TURN: bool> Bonds for BondStage<L, TURN> {
    fn compute(&mut self, state: &mut State, team: &Team) -> ChunkSums {
        let blocks = CHUNK / BLOCK;
        let fields = state.bond.fields();
        let (law, kind, constants, arch) = (&self.law, &self.kind, self.constants.rows(), self.arch);
        let limit = self.rupture.as_ref().and_then(RuptureCheck::plastic_limit);
        let own = self.own.as_ref();
        let (x, v, w, dt, damped) = (&state.x, &state.v, &state.w, state.dt, self.damped);
        let records = self.records.chunks_mut(blocks * BLOCK * Layout::<L, TURN>::FIELDS);
        let results = self.partial.iter_mut().zip(&mut self.due);
        let chunks = records.zip(state.bond.data.chunks_mut(CHUNK * fields)).zip(results);
        team.for_each(chunks, |chunk, ((records, actions), (partial, due))| {
            let first = chunk * CHUNK;
            let kind = &kind[first / BLOCK..];
            // The first evaluation, before any step, has no dashpots: their work would go unbooked.
            let damped = damped && dt > 0.0;
            let own = own.map(|own| own.of_chunk(chunk));
            let job =
                Chunk::<L, TURN> { law, first, x, v, w, dt, records, kind, constants, damped, limit, own, actions };
            (*partial, *due) = arch.dispatch(job);
        });
        let mut sum = ChunkSums::default();
        self.partial.iter().for_each(|p| sum.add(p));
        sum
    }

    fn rupture(&mut self, state: &mut State, broke: &mut dyn FnMut(usize, Criterion, f64)) -> f64 {
        let Some(check) = &self.rupture else { return 0.0 };
        if !self.due.iter().any(|due| *due) {
            return 0.0;
        }
        let of_own = |own: &Own| (0..state.len()).map(|slot| state.whole[slot] && own.has(slot)).collect::<Vec<_>>();
        let own = self.own.as_ref().map(of_own);
        let whole = own.as_deref().unwrap_or(&state.whole);
        let broken =
            check.broken(whole, state, |slot| (self.plastic_strain(slot), self.force(slot), self.section(slot)));
        let mut released = 0.0;
        for (slot, criterion) in broken {
            broke(slot, criterion, self.stress(slot));
            released += self.law.elastic_energy(&self.shape(slot), &self.force(slot), &self.history(slot));
            // The law has booked this step up to now with the mean of old and new force; the new one never acts.
            released -= 0.5 * state.dt * power(state, slot);
            (Layout::<L, TURN>::AXIAL..Layout::<L, TURN>::DASHPOT).for_each(|field| self.set(slot, field, 0.0));
            self.set(slot, Layout::<L, TURN>::LIVE, 0.0);
            let thinning = state.bond.get(slot, BondActions::THINNING);
            state.length_at_break[slot] = self.shape(slot).rest_length / (thinning * thinning);
            state.whole[slot] = false;
            state.bond.release(slot);
        }
        released
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        let whole = (0..state.whole.len()).filter(|slot| state.whole[*slot] && self.has(*slot));
        whole.map(|s| self.law.elastic_energy(&self.shape(s), &self.force(s), &self.history(s))).sum()
    }

    fn elements(&self, state: &State, chunk: usize, each: &mut dyn FnMut(Element)) {
        let slots = chunk * CHUNK..state.len().min((chunk + 1) * CHUNK);
        for i in slots.filter(|slot| state.whole[*slot] && self.has(*slot)) {
            let k = self.law.stiffness(&self.shape(i), &self.history(i));
            let length = (state.x.get(i + 1) - state.x.get(i)).length();
            each(Element::bond(i, &k, length, std::array::from_fn(|mode| self.constant(i, SHAPE + mode)), TURN));
        }
    }

    fn stress(&self, slot: usize) -> f64 {
        self.axial_force(slot) / self.section(slot).area
    }

    fn axial_force(&self, slot: usize) -> f64 {
        self.get(slot, Layout::<L, TURN>::AXIAL)
    }

    fn plastic_strain(&self, slot: usize) -> f64 {
        self.law.plastic_strain(&self.shape(slot), &self.history(slot))
    }

    fn utilisation(&self, slot: usize, state: &State) -> f64 {
        let Some(check) = &self.rupture else { return 0.0 };
        check.utilisation(slot, state, self.plastic_strain(slot), &self.force(slot), &self.section(slot))
    }

    fn record(&self) -> Result<Function, String> {
        let limit = match &self.rupture {
            None => None,
            Some(check) => Some(check.formula().ok_or("fibre strain asks for angles between bonds")?),
        };
        let step = BondStep { law: self.law.clone(), turn: TURN, damped: self.damped };
        Function::record("bonds", &BondInRun { step, limit }).map_err(|reason| reason.to_string())
    }

    fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let slots = 0..self.kind.len() * BLOCK;
        if let Some(row) = constant_named(name) {
            return Some(slots.map(|slot| self.constant(slot, row)).collect());
        }
        if name == "limit" {
            let check = self.rupture.as_ref()?;
            return Some(slots.map(|slot| check.limit(slot)).collect());
        }
        let field = Layout::<L, TURN>::named(name)?;
        Some(slots.map(|slot| self.get(slot, field)).collect())
    }

    fn set_numbers(&mut self, name: &str, numbers: &[f64]) {
        let Some(field) = Layout::<L, TURN>::named(name) else { return };
        numbers.iter().enumerate().for_each(|(slot, number)| self.set(slot, field, *number));
        // Whoever has computed them has not looked at all limits.
        self.due.fill(true);
    }

    fn save(&self, out: &mut Writer) {
        out.put(&self.records);
        out.put(&self.due);
    }

    fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit> {
        from.take_into(&mut self.records)?;
        from.take_into(&mut self.due)
    }

    fn bytes(&self) -> Bytes {
        let all = self.records.len() / Layout::<L, TURN>::FIELDS;
        // Blocks that are not its own are never written, and take no memory.
        let slots = self.own.as_ref().map_or(all, Own::worked_on);
        let records = slots * Layout::<L, TURN>::FIELDS * NUMBER;
        let limits = self.rupture.as_ref().map_or(0, RuptureCheck::bytes);
        let checked = self.rupture.as_ref().and_then(RuptureCheck::plastic_limit).map_or(0, |_| NUMBER);
        let nodes = if TURN { 3 * VECTOR } else { 2 * VECTOR };
        // Flags are only read, the rest of a record is written back.
        let written = Layout::<L, TURN>::LIVE * NUMBER;
        let actions = BondActions::fields_of(TURN) * NUMBER;
        Bytes {
            kept: if self.own.is_some() { records } else { behind(&self.records) }
                + self.own.as_ref().map_or(0, Own::bytes)
                + self.constants.bytes()
                + behind(&self.kind)
                + behind(&self.partial)
                + behind(&self.due)
                + limits,
            moved: records + size_of_val(&self.kind[..]) + slots * (written + nodes + actions + checked),
        }
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
