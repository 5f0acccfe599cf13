//! The monitor: sees an engine between two steps and says what is wrong with it, or what it needs.
//!
//! Findings are kept at their worst: contacts too deep for their law, a step that shrinks or is not stable, strain that localises in
//! one bond, bonds stretched beyond what a search covers. What makes results worthless stops the run: bodies that
//! pass through each other, or bend though nothing turns. All of it rides on work that is done anyway: the contact
//! pass, the bound on the step, the neighbour search.

mod crossing;
mod necking;

use super::loading_rate::Ahead;
use super::neighbours::MOST_STRETCH;
use super::state::Deepest;
use super::step_choice;
use super::step_view::StepView;
use super::view::{DeepestContact, Findings, StepAt};
use crate::base::finding::{Failure, Finding, FindingKind, Instant, Member, Notice, Relief};
use crate::base::worst::Worst;
use crate::scene::plan::ContactPlan;
use crate::scene::spec::{GripKind, Spec};
use crate::strand::assembly::Assembly;
use crossing::crossing;
use necking::Necking;
use serde::{Deserialize, Serialize};

/// Overlap over the smaller radius beyond which a contact is said to be deep (-): Hertz's parabola a² = Rδ, from which
/// every contact law here starts, is 5 % off the circle then.
const DEEP: f64 = 0.1;
/// Share of the first step below which the step is said to have shrunk (-).
const SHRUNK: f64 = 0.25;
/// A body bends, though its rotations were left out, when a bond has turned by this angle (rad).
const BENT: f64 = 1e-3;

/// What the monitor wants done.
#[derive(Debug, Clone)]
pub enum Action {
    /// Compute contacts from now on: the plan left them out, and they turn out to be needed.
    AddContacts,
    /// Pull as fast as this allows.
    AdjustLoadingRate(Ahead),
    /// Stop: results from here on would be worthless.
    Stop(Failure),
}

/// What has been seen so far.
#[derive(Default, Serialize, Deserialize)]
pub struct Monitor {
    notices: Vec<Notice>,
    worst: Worst,
    deepest: Option<(Deepest, DeepestContact)>,
    first_step: f64,
    least: StepAt,
    greatest: StepAt,
    necking: Option<Necking>,
}

impl Monitor {
    /// For a scene, before the first step.
    pub fn new(spec: &Spec, assembly: &Assembly) -> Self {
        Self { necking: Necking::new(spec, assembly.len()), ..Self::default() }
    }

    /// Notices since the last call, in order.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        std::mem::take(&mut self.notices)
    }

    /// Those of them that have become worse since they were given, as they were at their worst.
    pub fn take_worse(&mut self) -> Vec<Notice> {
        self.worst.take_worse()
    }

    /// What was seen over the whole run so far.
    pub fn findings(&self, view: &StepView) -> Findings {
        Findings {
            deepest: self.deepest.as_ref().map(|(deepest, at)| DeepestContact {
                bodies: deepest.pair.map(|p| view.body(p as usize)),
                ..at.clone()
            }),
            least_step: self.least.clone(),
            greatest_step: self.greatest.clone(),
        }
    }

    /// A look at everything, every few steps.
    pub fn look(&mut self, view: &StepView) -> Vec<Action> {
        let mut actions = Vec::new();
        if view.holds.loading_rate.is_some() {
            actions.push(Action::AdjustLoadingRate(ahead(view)));
        }
        actions.extend(self.look_at_stages(view));
        self.look_at_necking(view);
        actions
    }

    /// Whether a contact is deeper than all before.
    pub fn is_deepest(&self, now: &Deepest) -> bool {
        now.ratio > self.deepest.as_ref().map_or(0.0, |(deepest, _)| deepest.ratio)
    }

    /// Takes in a contact that [is deeper](Self::is_deepest) than all before.
    pub fn look_at_contact(&mut self, now: Deepest, view: &StepView) {
        let position = view.state.x.get(now.pair[0] as usize).to_array();
        let pressure = now.force / now.area;
        let at = DeepestContact {
            ratio: now.ratio,
            bodies: Default::default(),
            position,
            force: now.force,
            pressure,
            step: view.state.step,
            time: view.state.time,
            strain: view.instant().strain,
        };
        self.deepest = Some((now, at));
        if now.ratio > DEEP {
            self.found(view, FindingKind::DeepContact, now.ratio, || Finding::DeepContact {
                overlap_over_radius: now.ratio,
                between: now.pair.map(|p| view.body(p as usize)),
                z_m: position[2],
                force_n: now.force,
                pressure_pa: pressure,
                relief: relief(view),
            });
        }
    }

    /// Takes in the step that was chosen.
    pub fn look_at_step(&mut self, view: &StepView) {
        let seconds = view.time_step;
        // Before bodies meet nothing but their flight limits a step, which says little.
        let stiff = view.bonds.is_some() && view.bound.step.is_finite();
        if stiff && self.first_step == 0.0 {
            self.first_step = seconds;
        }
        let fresh = |known: &StepAt, better: bool| known.seconds == 0.0 || better;
        let least = fresh(&self.least, seconds < self.least.seconds);
        let greatest = fresh(&self.greatest, seconds > self.greatest.seconds);
        if least || greatest {
            let limit = step_choice::limit(view);
            let Instant { step, time, strain } = view.instant();
            let at = StepAt { seconds, step, time, strain, limit };
            if least {
                self.least = at.clone();
            }
            if greatest {
                self.greatest = at;
            }
        }
        if view.spec.time.step.is_some_and(|step| step > view.bound.step) {
            self.found(view, FindingKind::UnstableStep, seconds / view.bound.step, || Finding::UnstableStep {
                step_s: seconds,
                bound_s: view.bound.step,
                mode: view.bound.mode,
                element: view.bound.element(),
                body: view.body(view.bound.particle),
            });
        } else if stiff && seconds < SHRUNK * self.first_step {
            let from_s = self.first_step;
            self.found(view, FindingKind::StepShrunk, from_s / seconds, || Finding::StepShrunk {
                from_s,
                to_s: seconds,
                limit: step_choice::limit(view),
            });
        }
    }

    /// Takes in a neighbour search: bonds stretched beyond what it covers.
    pub fn look_at_search(&mut self, view: &StepView) {
        let stretch = view.neighbours.map_or(0.0, |neighbours| neighbours.stretched());
        if stretch > MOST_STRETCH {
            let found = || Finding::BondsStretched { stretch, covered: MOST_STRETCH };
            self.found(view, FindingKind::BondsStretched, stretch, found);
        }
    }

    /// Stages that were left out and turn out to be needed. A straight body that has turned back on itself gets its
    /// contacts; one that bends without rotations cannot go on.
    fn look_at_stages(&mut self, view: &StepView) -> Option<Action> {
        let plan = view.plan;
        let touches = view.contacts.is_none() && plan.contacts != ContactPlan::Present && view.spec.contact.is_some();
        if view.bonds.is_none() || plan.rotations && !touches {
            return None;
        }
        // (slot, squared sine of the angle by which it has turned, whether by more than a right angle)
        let turned = |slot: usize| {
            let a = &view.assembly.position;
            let (before, now) = (a.get(slot + 1) - a.get(slot), view.state.x.get(slot + 1) - view.state.x.get(slot));
            let (cross2, along) = (before.cross(now).length_squared(), before.dot(now));
            (slot, cross2 / (before.length_squared() * now.length_squared()), along < 0.0)
        };
        let bonds = (0..view.state.len()).filter(|slot| view.state.whole[*slot]).map(turned);
        let (slot, sine2, back) = bonds.max_by(|a, b| (a.2, a.1).partial_cmp(&(b.2, b.1)).unwrap_or(a.0.cmp(&b.0)))?;
        if !plan.rotations && (back || sine2 > BENT * BENT) {
            return Some(Action::Stop(Failure::Bends { body: view.body(slot), z_m: view.state.x.z[slot] }));
        }
        (touches && back).then(|| {
            let body = || Finding::ContactsAdded { body: view.body(slot) };
            self.found(view, FindingKind::ContactsAdded, 0.0, body);
            Action::AddContacts
        })
    }

    /// Looks for a bond that necks. It is said once, so then nothing is left to look for.
    fn look_at_necking(&mut self, view: &StepView) {
        let Some(necking) = &mut self.necking else { return };
        let Some(neck) = necking.look(view) else { return };
        let maximum_load = neck.from;
        self.necking = None;
        self.found(view, FindingKind::Necking, 0.0, || Finding::Necking {
            bond: view.member(neck.slot),
            z_m: view.state.x.z[neck.slot],
            plastic_strain: neck.strain,
            others: neck.others,
            maximum_load,
        });
    }

    /// Takes note of a finding that is the worst of its kind by `measure`; 0 for what cannot get worse.
    fn found(&mut self, view: &StepView, kind: FindingKind, measure: f64, finding: impl FnOnce() -> Finding) {
        if self.worst.tops(kind, measure) {
            let finding = finding();
            debug_assert_eq!(finding.kind(), kind);
            self.notices.extend(self.worst.put(measure, Notice { at: view.instant(), finding }));
        }
    }
}

/// Bodies that passed through each other since the last neighbour search: what a run finds after that has nothing to do
/// with them.
pub fn crossed(view: &StepView) -> Option<Failure> {
    let found = crossing(view.neighbours?, view.state, &view.assembly.wire_of, view.team)?;
    Some(Failure::PassedThrough {
        between: found.between.map(|slot| view.member(slot)),
        z_m: found.position.z,
        relief: relief(view),
    })
}

/// A particle whose centre has come into a rigid body.
pub fn entered(view: &StepView, [particle, body]: [usize; 2]) -> Failure {
    let rigid = Member { number: None, body: view.body(view.state.len() + body) };
    Failure::PassedThrough {
        between: [view.member(particle), rigid],
        z_m: view.state.x.z[particle],
        relief: relief(view),
    }
}

/// What the fastest particle did in the last step, further than `limit_over_radius` of the least radius (-).
pub fn ran_away(view: &StepView, limit_over_radius: f64) -> Failure {
    let far = |p: usize| (view.state.v.get(p) * view.state.dt).length();
    let worst = (0..view.state.len())
        .max_by(|a, b| {
            let key = |p: usize| if far(p).is_nan() { f64::INFINITY } else { far(p) };
            key(*a).total_cmp(&key(*b))
        })
        .unwrap_or(0);
    let moved = far(worst);
    Failure::Runaway {
        particle: view.member(worst),
        moved_m: (!moved.is_nan()).then_some(moved),
        limit_m: limit_over_radius * view.assembly.least_radius(),
        limit_over_radius,
        step_s: view.state.dt,
        bound_s: Some(view.bound.step).filter(|bound| bound.is_finite()),
    }
}

/// What takes load off contacts in this scene.
fn relief(view: &StepView) -> Relief {
    match view.spec.grip.as_ref().map(|grip| grip.kind) {
        Some(GripKind::Jaw { .. }) => Relief::Clamp,
        _ => Relief::Speed,
    }
}

/// What decides on the speed of an adaptive pull from here on.
fn ahead(view: &StepView) -> Ahead {
    Ahead { work: view.holds.work, strain: view.holds.strain(), left: strain_left(view) }
}

/// Strain until the bond nearest to its limit reaches it, if it goes on at its mean rate so far (-). None is left once
/// a bond has broken: what then comes next is the work of waves and of neighbours that take over load, and broken
/// wires do not flow with the others.
fn strain_left(view: &StepView) -> f64 {
    let Some(bonds) = view.bonds.filter(|_| view.plan.rupture) else { return f64::INFINITY };
    if view.ruptures > 0 {
        return 0.0;
    }
    let whole = (0..view.state.len()).filter(|slot| view.state.whole[*slot]);
    let most = whole.map(|slot| bonds.utilisation(slot, view.state)).fold(0.0, f64::max);
    view.holds.strain() * (1.0 - most).max(0.0) / most
}

#[cfg(test)]
mod tests;
