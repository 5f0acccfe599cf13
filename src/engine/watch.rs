//! What the engine watches while it runs, and makes a finding of once: contacts too deep for their law, a step that
//! shrinks or is not stable, strain that localises in one bond, bonds stretched beyond what a search covers. What makes
//! results worthless stops the run: wires that pass through each other, bodies that bend though nothing turns.
//!
//! All of it rides on work that is done anyway: the contact pass, the bound on the step, the neighbour search.

use super::Engine;
use super::crossing::crossing;
use super::neighbours::MOST_STRETCH;
use super::state::Deepest;
use super::view::{DeepestContact, Findings, StepAt};
use crate::base::error::{Error, Result};
use crate::base::finding::{Body, Failure, Finding, FindingKind, Instant, Member, Notice, Once, Relief, Stopped};
use crate::scene::caution;
use crate::scene::plan::ContactPlan;
use crate::scene::spec::{BondLawSpec, GripKind};
use crate::strand::assembly::Assembly;
use serde::{Deserialize, Serialize};

/// Overlap over the smaller radius beyond which a contact is said to be deep (-): Hertz's parabola a² = Rδ, from which
/// every contact law here starts, is 5 % off the circle then.
const DEEP: f64 = 0.1;
/// Share of the first step below which the step is said to have shrunk (-).
const SHRUNK: f64 = 0.25;
/// A body bends, though its rotations were left out, when a bond has turned by this angle (rad).
const BENT: f64 = 1e-3;
/// Bonds between two looks at necking: those that flow at less than this share of the one that flows most have
/// stopped (-).
const STOPPED: f64 = 0.1;
/// A neck stands out from its wire by this plastic strain (-): less may be a wave that passes.
const STANDS_OUT: f64 = 0.005;
/// A wire of fewer free bonds has no surroundings that a neck could stand out from.
const FEWEST: usize = 8;

/// What the engine has seen so far.
#[derive(Default, Serialize, Deserialize)]
pub struct Watch {
    notices: Vec<Notice>,
    made: Once,
    deepest: Option<(Deepest, DeepestContact)>,
    first_step: f64,
    least: StepAt,
    greatest: StepAt,
    necking: Option<Necking>,
}

/// Strain that localises (Considère 1885): past the maximum load of a bond, dσ/dp ≤ σ, it alone goes on and the others
/// unload. How far, depends on its length.
#[derive(Serialize, Deserialize)]
struct Necking {
    /// Plastic strain at the maximum load of a bond (-).
    from: f64,
    /// Plastic strain of every bond at the last look (-).
    before: Vec<f64>,
}

/// A bond that necks.
struct Neck {
    slot: usize,
    strain: f64,
    others: f64,
}

impl Watch {
    /// For the engine's scene, before the first step.
    pub fn new(spec: &crate::scene::spec::Spec, assembly: &Assembly) -> Self {
        let from = caution::considere(spec, f64::INFINITY);
        Self { necking: from.map(|from| Necking { from, before: vec![0.0; assembly.len()] }), ..Self::default() }
    }
}

impl Engine {
    /// Notices since the last call, in order.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        std::mem::take(&mut self.watch.notices)
    }

    /// What was seen over the whole run so far.
    pub fn findings(&self) -> Findings {
        Findings {
            deepest: self.watch.deepest.as_ref().map(|(deepest, at)| DeepestContact {
                bodies: deepest.pair.map(|p| self.body(p as usize)),
                ..at.clone()
            }),
            least_step: self.watch.least.clone(),
            greatest_step: self.watch.greatest.clone(),
        }
    }

    /// The body of a particle.
    pub(super) fn body(&self, particle: usize) -> Body {
        match self.assembly.wire_of[particle] {
            u32::MAX => Body::Sphere { sphere: particle - self.assembly.wire_particles + 1 },
            wire => {
                let layer = self.assembly.wires[wire as usize].layer;
                Body::Wire { wire: wire as usize + 1, layer: self.assembly.layers[layer].name.clone() }
            }
        }
    }

    /// A particle, or the bond that begins at it, in its body.
    pub(super) fn member(&self, particle: usize) -> Member {
        let wire = self.assembly.wires.get(self.assembly.wire_of[particle] as usize);
        Member { number: wire.map(|wire| particle - wire.first + 1), body: self.body(particle) }
    }

    /// The present moment.
    fn instant(&self) -> Instant {
        let [low, high] = self.holds.stretch.gauge;
        Instant { step: self.state.step, time: self.state.time, strain: (high > low).then(|| self.strain()) }
    }

    /// Takes note of a finding, the first time that one of its kind is made.
    fn found(&mut self, kind: FindingKind, finding: impl FnOnce(&Self) -> Finding) {
        if self.watch.made.first(kind) {
            let finding = finding(self);
            debug_assert_eq!(finding.kind(), kind);
            self.watch.notices.push(Notice { at: self.instant(), finding });
        }
    }

    /// The error that ends a run now.
    pub(super) fn failed(&self, failure: Failure) -> Error {
        Error::Simulation(Box::new(Stopped { at: self.instant(), failure, kept: None }))
    }

    /// Takes in the deepest contact of a step.
    pub(super) fn watch_contacts(&mut self, now: Deepest) {
        let known = self.watch.deepest.as_ref().map_or(0.0, |(deepest, _)| deepest.ratio);
        if now.ratio <= known {
            return;
        }
        let position = self.state.x.get(now.pair[0] as usize).to_array();
        let pressure = now.force / now.area;
        let at = DeepestContact {
            ratio: now.ratio,
            bodies: Default::default(),
            position,
            force: now.force,
            pressure,
            step: self.state.step,
            time: self.state.time,
            strain: self.strain(),
        };
        self.watch.deepest = Some((now, at));
        if now.ratio > DEEP {
            self.found(FindingKind::DeepContact, |engine| Finding::DeepContact {
                overlap_over_radius: now.ratio,
                between: now.pair.map(|p| engine.body(p as usize)),
                z_m: position[2],
                force_n: now.force,
                pressure_pa: pressure,
                relief: engine.relief(),
            });
        }
    }

    /// Takes in the step that was chosen.
    pub(super) fn watch_step(&mut self) {
        let seconds = self.next_dt;
        // Before bodies meet nothing but their flight limits a step, which says little.
        let stiff = self.bonds.is_some() && self.bound.step.is_finite();
        if stiff && self.watch.first_step == 0.0 {
            self.watch.first_step = seconds;
        }
        let fresh = |known: &StepAt, better: bool| known.seconds == 0.0 || better;
        let least = fresh(&self.watch.least, seconds < self.watch.least.seconds);
        let greatest = fresh(&self.watch.greatest, seconds > self.watch.greatest.seconds);
        if least || greatest {
            let limit = self.time_step_limit();
            let at = StepAt { seconds, step: self.state.step, time: self.state.time, strain: self.strain(), limit };
            if least {
                self.watch.least = at.clone();
            }
            if greatest {
                self.watch.greatest = at;
            }
        }
        if self.spec.time.step.is_some_and(|step| step > self.bound.step) {
            self.found(FindingKind::UnstableStep, |engine| Finding::UnstableStep {
                step_s: seconds,
                bound_s: engine.bound.step,
                mode: engine.bound.mode,
                element: engine.bound.element(),
                body: engine.body(engine.bound.particle),
            });
        } else if stiff && seconds < SHRUNK * self.watch.first_step {
            self.found(FindingKind::StepShrunk, |engine| Finding::StepShrunk {
                from_s: engine.watch.first_step,
                to_s: seconds,
                limit: engine.time_step_limit(),
            });
        }
    }

    /// Stages that were left out and turn out to be needed. A straight body that has turned back on itself gets its
    /// contacts; one that bends without rotations cannot go on.
    pub(super) fn watch_stages(&mut self) -> Result<()> {
        let touches =
            self.contacts.is_none() && self.plan.contacts != ContactPlan::Present && self.spec.contact.is_some();
        if self.bonds.is_none() || self.plan.rotations && !touches {
            return Ok(());
        }
        // (slot, squared sine of the angle by which it has turned, whether by more than a right angle)
        let turned = |slot: usize| {
            let a = &self.assembly.position;
            let (before, now) = (a.get(slot + 1) - a.get(slot), self.state.x.get(slot + 1) - self.state.x.get(slot));
            let (cross2, along) = (before.cross(now).length_squared(), before.dot(now));
            (slot, cross2 / (before.length_squared() * now.length_squared()), along < 0.0)
        };
        let bonds = (0..self.state.len()).filter(|slot| self.state.whole[*slot]).map(turned);
        let Some((slot, sine2, back)) =
            bonds.max_by(|a, b| (a.2, a.1).partial_cmp(&(b.2, b.1)).unwrap_or(a.0.cmp(&b.0)))
        else {
            return Ok(());
        };
        if !self.plan.rotations && (back || sine2 > BENT * BENT) {
            return Err(self.failed(Failure::Bends { body: self.body(slot), z_m: self.state.x.z[slot] }));
        }
        if touches && back {
            self.add_contacts();
            self.found(FindingKind::ContactsAdded, |engine| Finding::ContactsAdded { body: engine.body(slot) });
        }
        Ok(())
    }

    /// Looks for a bond that necks; between two looks lie `BOUND_INTERVAL` steps.
    pub(super) fn watch_necking(&mut self) {
        let Some(mut necking) = self.watch.necking.take() else { return };
        let found = self.find_neck(&mut necking);
        let Some(neck) = found else {
            self.watch.necking = Some(necking);
            return;
        };
        // It is said once, so nothing is left to look for.
        self.found(FindingKind::Necking, |engine| Finding::Necking {
            bond: engine.member(neck.slot),
            z_m: engine.state.x.z[neck.slot],
            plastic_strain: neck.strain,
            others: neck.others,
            maximum_load: necking.from,
        });
    }

    fn find_neck(&self, necking: &mut Necking) -> Option<Neck> {
        let (Some(bonds), BondLawSpec::ElastoPlastic(hardening)) = (&self.bonds, &self.spec.bond.law) else {
            return None;
        };
        let state = &self.state;
        let mut found = None;
        // (growth since the last look, plastic strain, slot) of the free bonds of a wire
        let mut flow: Vec<(f64, f64, usize)> = Vec::new();
        for wire in &self.assembly.wires {
            flow.clear();
            for slot in wire.bonds() {
                let p = bonds.plastic_strain(slot);
                let grown = p - std::mem::replace(&mut necking.before[slot], p);
                let held = state.fixed[slot] != 0 && state.fixed[slot + 1] != 0;
                if state.whole[slot] && !held {
                    flow.push((grown, p, slot));
                }
            }
            if found.is_some() || flow.len() < FEWEST {
                continue;
            }
            let middle = flow.len() / 2;
            let (_, median, _) = flow.select_nth_unstable_by(middle, |a, b| a.0.total_cmp(&b.0));
            let growth = median.0;
            let others = flow[..=middle].iter().map(|f| f.1).sum::<f64>() / (middle + 1) as f64;
            let most = flow[middle..].iter().max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((grown, p, slot)) = most.copied() else { continue };
            // In tension: a hinge that bends is no neck.
            let pulled = bonds.stress(slot) > 0.5 * hardening.stress(p);
            if p >= necking.from && p - others > STANDS_OUT && growth < STOPPED * grown && pulled {
                found = Some(Neck { slot, strain: p, others });
            }
        }
        found
    }

    /// Wires that passed through each other since the last neighbour search.
    ///
    /// # Errors
    /// [`Error::Simulation`] when two did: what a run finds after that has nothing to do with the strand.
    pub fn inspect(&self) -> Result<()> {
        let Some(contacts) = &self.contacts else { return Ok(()) };
        let Some(found) = crossing(&contacts.neighbours, &self.state, &self.assembly.wire_of) else { return Ok(()) };
        Err(self.failed(Failure::PassedThrough {
            bonds: found.bonds.map(|slot| self.member(slot)),
            z_m: found.position.z,
            relief: self.relief(),
        }))
    }

    /// What takes load off contacts in this scene.
    fn relief(&self) -> Relief {
        match self.spec.grip.as_ref().map(|grip| grip.kind) {
            Some(GripKind::Jaw { .. }) => Relief::Clamp,
            _ => Relief::Speed,
        }
    }

    /// Bonds stretched beyond what a neighbour search covers.
    pub(super) fn watch_stretch(&mut self) {
        let Some(contacts) = &self.contacts else { return };
        let stretched = contacts.neighbours.stretched();
        if stretched > MOST_STRETCH {
            self.found(FindingKind::BondsStretched, |_| Finding::BondsStretched {
                stretch: stretched,
                covered: MOST_STRETCH,
            });
        }
    }
}
