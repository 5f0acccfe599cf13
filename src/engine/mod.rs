//! Floor 4: the engine. State as structure of arrays, stages, time step, energy ledger.
//!
//! One step, in order: kick (velocities from the last forces) → holds (prescribed motion) → drift → neighbours (when
//! stale) → bonds → rupture → contacts → gather. Each stage is called through `dyn` once; the loops inside are
//! monomorphic over their laws. [`crate::scene::plan::Plan`] decides which stages there are.

pub mod bonds;
pub mod bytes;
pub mod contact;
mod detail;
pub mod elsewhere;
pub mod estimates;
pub mod grips;
mod info;
pub mod integrate;
mod kept;
pub(crate) mod loading_rate;
pub mod measure;
pub mod memory;
mod monitor;
pub mod motion;
pub mod neighbours;
pub mod recorded;
pub mod rupture;
pub mod saved;
mod shared_rows;
pub mod state;
mod step_choice;
pub mod step_view;
mod straight;
pub mod team;
pub mod time_step;
mod timings;
pub mod view;

use crate::base::error::{Error, Result};
use crate::base::finding::{Failure, Notice, StepLimit, Stopped};
use crate::law::bond::BondLaw;
use crate::scene::plan::{ContactPlan, Plan};
use crate::scene::spec::{BondLawSpec, Spec};
use crate::strand::assembly::Assembly;
use bonds::Bonds;
use contact::Contacts;
use contact::rigid::{self, RigidBodies};
use grips::Holds;
use loading_rate::Ahead;
use measure::Measures;
use memory::StageBytes;
use monitor::{Action, Monitor};
use neighbours::Neighbours;
use pulp::Arch;
use state::{CHUNK, ChunkSums, State};
use std::time::Instant;
use step_view::StepView;
use team::{Team, Tuning};
use time_step::{Bound, Element, Stiffness};
pub use timings::Timings;
use view::{Energy, Findings, RunInfo, Rupture, Sample, Snapshot};

/// Revision of the physics: raised whenever a run gives other bits than before, which `tests/revision.rs` sees. Kept results
/// of another revision are not those that this engine would give.
pub const REVISION: u32 = 2;

/// Steps between two evaluations of the bound on the time step.
const BOUND_INTERVAL: u64 = 64;
/// A particle that moves further than this share of the least radius in one step has run away (-).
const RUNAWAY: f64 = 0.1;

/// Contacts with their neighbour search.
struct ContactPart {
    stage: Box<dyn Contacts>,
    neighbours: Neighbours,
    stale: bool,
}

/// One run in progress.
pub struct Engine {
    spec: Spec,
    plan: Plan,
    assembly: Assembly,
    state: State,
    bonds: Option<Box<dyn Bonds>>,
    contacts: Option<ContactPart>,
    rigid: Option<Box<dyn RigidBodies>>,
    holds: Holds,
    stiffness: Stiffness,
    bound: Bound,
    /// Step to take next (s).
    next_dt: f64,
    energy: Energy,
    ruptures: Vec<Rupture>,
    rupture_count: usize,
    measures: Measures,
    least_radius: f64,
    timings: Timings,
    arch: Arch,
    monitor: Monitor,
    team: Team,
    /// None while all threads of the team work.
    tuning: Option<Tuning>,
}

impl Engine {
    /// Sets the assembly up for its first step. `plan` is that of `spec` ([`Plan::new`]).
    ///
    /// # Errors
    /// When there is no stable step because nothing is stiff and the scene fixes none, or a grip holds nothing.
    pub fn new(spec: &Spec, plan: &Plan, assembly: Assembly) -> Result<Self> {
        Self::set_up(spec, plan, assembly, bonds::build)
    }

    /// [`Engine::new`] with a bond law of one's own in the place of the scene's, whose `bond.law` and hardening then say
    /// nothing; damping and rupture are the scene's.
    ///
    /// # Errors
    /// As for [`Engine::new`], and where the scene has several materials.
    pub fn with_law<L: BondLaw>(spec: &Spec, plan: &Plan, assembly: Assembly, law: L) -> Result<Self> {
        if spec.has_several_materials() {
            let help = "such a law is that of all wires: let them be of one material";
            return Err(Error::input("a bond law of one's own, and several materials", help));
        }
        Self::set_up(spec, plan, assembly, |spec, plan, assembly| bonds::with_law(law, spec, plan, assembly))
    }

    fn set_up(
        spec: &Spec,
        plan: &Plan,
        assembly: Assembly,
        build_bonds: impl FnOnce(&Spec, &Plan, &Assembly) -> Box<dyn Bonds>,
    ) -> Result<Self> {
        let mut state = State::new(&assembly, plan.rotations);
        let holds = Holds::new(spec, &assembly, &mut state)?;
        let bonds = if plan.bonds { Some(build_bonds(spec, plan, &assembly)) } else { None };
        let measures = Measures::new(spec, &assembly, &holds);
        let least_radius = assembly.radius.iter().copied().fold(f64::MAX, f64::min);
        let team = Team::new(rayon::current_num_threads().min(state.len().div_ceil(CHUNK)))?;
        let mut engine = Self {
            team,
            tuning: None,
            spec: spec.clone(),
            plan: plan.clone(),
            state,
            bonds,
            contacts: None,
            rigid: if plan.rigid { rigid::build(spec, &assembly) } else { None },
            stiffness: Stiffness::default(),
            bound: Bound::default(),
            next_dt: 0.0,
            energy: Energy::default(),
            ruptures: Vec::new(),
            rupture_count: 0,
            measures,
            least_radius,
            timings: Timings::default(),
            arch: Arch::new(),
            monitor: Monitor::new(spec, &assembly),
            holds,
            assembly,
        };
        if engine.plan.contacts == ContactPlan::Present {
            engine.add_contacts();
        }
        engine.forces()?;
        // Bodies may overlap from the start; what that stores is there before any work is done.
        engine.holds.work += engine.energy().internal();
        engine.choose_step()?;
        Ok(engine)
    }

    /// Adds the contact stage; between two steps.
    fn add_contacts(&mut self) {
        let (Some(contact), Some(stage)) = (&self.spec.contact, contact::build(&self.spec, &self.assembly)) else {
            return;
        };
        let diameter = 2.0 * self.assembly.radius.iter().copied().fold(0.0, f64::max);
        self.state.make_room_for_contacts();
        self.contacts = Some(ContactPart {
            stage,
            neighbours: Neighbours::new(&self.assembly, contact.skin * diameter, contact.shape),
            stale: true,
        });
    }

    /// Works with `threads` threads from now on, or fewer where there is no work for as many. Bits do not depend on it.
    ///
    /// # Errors
    /// [`Error::Missing`] when the system refuses them.
    pub fn set_threads(&mut self, threads: usize) -> Result<()> {
        (self.team, self.tuning) = (Team::new(threads.min(self.state.len().div_ceil(CHUNK)))?, None);
        Ok(())
    }

    /// Finds out by itself from now on how many of its threads are worth having. Bits do not depend on it.
    pub fn tune_threads(&mut self) {
        self.tuning = Some(Tuning::new(self.team.size()));
    }

    /// Threads that work at its loops now, and how many it has.
    pub fn threads(&self) -> [usize; 2] {
        [self.team.working(), self.team.size()]
    }

    /// Advances by one step.
    ///
    /// # Errors
    /// [`Error::Simulation`] when a value stops being finite or runs away, when wires pass through each other, and when a
    /// stage that was left out turns out to be needed.
    pub fn step(&mut self) -> Result<()> {
        let began = Instant::now();
        self.advance()?;
        if let Some(tuning) = &mut self.tuning {
            self.team.set_working(tuning.after_step(began.elapsed().as_secs_f64()));
        }
        Ok(())
    }

    fn advance(&mut self) -> Result<()> {
        self.before_step()?;
        let began = Instant::now();
        let kicked = self.kicked();
        let turn = self.plan.rotations;
        integrate::kick(&mut self.state, kicked, turn, self.arch, &self.team);
        self.state.dt = self.next_dt;
        // Of the instant at which the forces act that the grips hold against.
        let strain = self.holds.strain();
        self.holds.apply(&mut self.state, kicked, self.arch);
        let largest2 = integrate::drift(&mut self.state, self.arch, &self.team);
        self.state.add_turn();
        self.state.step += 1;
        self.state.time += self.state.dt;
        let axial = |slot| self.bonds.as_ref().map_or(0.0, |bonds| bonds.axial_force(slot));
        let bodies = self.rigid.as_ref().map_or_else(Vec::new, |rigid| rigid.bodies());
        self.measures.take(strain, &self.holds.reaction, axial, &bodies, self.state.dt);
        self.timings.integrate += began.elapsed();
        self.state.travel += largest2.sqrt();
        let limit = RUNAWAY * self.least_radius;
        if motion::ran_away(largest2, limit * limit) {
            return Err(self.failed(monitor::ran_away(&self.view(), RUNAWAY)));
        }
        if let Some(c) = &mut self.contacts {
            c.stale |= c.neighbours.stale(&self.state, &self.holds.stretch, &self.team);
        }
        self.forces()
    }

    /// What is looked at now and then before a step: its size, and whether all that is needed is there.
    fn before_step(&mut self) -> Result<()> {
        if self.state.step.is_multiple_of(BOUND_INTERVAL) && self.state.step > 0 {
            self.choose_step()?;
            self.watch()?;
        }
        Ok(())
    }

    /// Time that the next kick spans (s).
    fn kicked(&self) -> f64 {
        0.5 * (self.state.dt + self.next_dt)
    }

    /// Forces at the present positions.
    fn forces(&mut self) -> Result<()> {
        let began = Instant::now();
        if let Some(bonds) = &mut self.bonds {
            let partial = bonds.compute(&mut self.state, &self.team);
            self.energy.plastic_bonds += partial.plastic;
            self.energy.damping += partial.damping;
        }
        self.timings.bonds += began.elapsed();
        self.forces_after_bonds()
    }

    /// Ruptures, contacts and sums, when bonds have acted.
    fn forces_after_bonds(&mut self) -> Result<()> {
        let began = Instant::now();
        if self.plan.rupture {
            self.break_bonds();
        }
        let after_bonds = Instant::now();
        self.timings.bonds += after_bonds - began;
        let stale = self.contacts.as_ref().is_some_and(|c| c.stale);
        if stale {
            self.check_crossings()?;
        }
        if let Some(c) = &mut self.contacts {
            if c.stale {
                let list = c.neighbours.search(&self.state, self.holds.stretch, &self.team);
                let lost = c.stage.rebuild(list, &self.state, &self.team);
                self.energy.friction += lost.friction;
                self.energy.released += lost.released;
                c.stale = false;
            }
            let after_search = Instant::now();
            self.timings.neighbours += after_search - after_bonds;
            let partial = c.stage.compute(&mut self.state, &self.team);
            self.timings.contacts += after_search.elapsed();
            self.book_contacts(&partial);
            if stale {
                self.show(Monitor::look_at_search);
            }
        }
        let before_gather = Instant::now();
        let parts = integrate::Parts {
            turn: self.plan.rotations,
            contacts: self.contacts.as_ref().map(|c| c.stage.second_sides()),
            thin: self.thins(),
        };
        integrate::gather(&mut self.state, parts, self.arch, &self.team);
        self.timings.integrate += before_gather.elapsed();
        self.meet_rigid_bodies()
    }

    /// Lets rigid bodies act on what has been gathered, and books it.
    fn meet_rigid_bodies(&mut self) -> Result<()> {
        let Some(rigid) = &mut self.rigid else { return Ok(()) };
        let began = Instant::now();
        let outcome = rigid.compute(&mut self.state, &self.team);
        self.timings.contacts += began.elapsed();
        self.holds.work += outcome.work;
        self.energy.released += outcome.sums.released;
        self.book_contacts(&outcome.sums);
        match outcome.passed {
            Some(passed) => Err(self.failed(monitor::entered(&self.view(), passed))),
            None => Ok(()),
        }
    }

    /// Books what contacts have given off.
    fn book_contacts(&mut self, partial: &ChunkSums) {
        self.energy.plastic_contacts += partial.plastic;
        self.energy.plastic_thinning += partial.thinning;
        self.energy.friction += partial.friction;
        self.energy.damping += partial.damping;
        if self.monitor.is_deepest(&partial.deepest) {
            self.show(|monitor, view| monitor.look_at_contact(partial.deepest, view));
        }
    }

    /// Whether wires thin as they stretch.
    fn thins(&self) -> bool {
        self.spec.materials().any(|one| matches!(one.bond.law, BondLawSpec::ElastoPlastic(_)))
    }

    /// Breaks what has reached its limit and books it.
    fn break_bonds(&mut self) {
        let Some(bonds) = &mut self.bonds else { return };
        let mut broke = Vec::new();
        self.energy.released += bonds.rupture(&mut self.state, &mut |slot, cause, stress| {
            broke.push((slot, cause, stress));
        });
        if broke.is_empty() {
            return;
        }
        for (slot, cause, stress) in broke {
            self.rupture_count += 1;
            let wire = self.assembly.wire_of[slot] as usize;
            let centre = (self.state.x.get(slot) + self.state.x.get(slot + 1)) * 0.5;
            let rest = 0.5 * (self.assembly.position.z[slot] + self.assembly.position.z[slot + 1]);
            let first = self.measures.mark_broken(wire);
            self.ruptures.push(Rupture {
                order: self.rupture_count,
                step: self.state.step,
                time: self.state.time,
                strain: self.measures.strain(),
                wire,
                layer: self.assembly.wires[wire].layer,
                bond: slot,
                bond_in_wire: slot - self.assembly.wires[wire].first,
                position: centre.to_array(),
                rest_z: rest,
                cause,
                stress,
                body_stress: self.measures.stress(),
                first_of_wire: first,
            });
        }
        // Pieces of a wire may now touch: look for new pairs, and add the stage if it was left out until now.
        match &mut self.contacts {
            Some(c) => c.stale = true,
            None if self.plan.contacts == ContactPlan::AfterRupture => self.add_contacts(),
            None => {}
        }
    }

    /// Follows the bound on the stable step.
    fn choose_step(&mut self) -> Result<()> {
        let began = Instant::now();
        let (state, bonds, contacts) = (&self.state, self.bonds.as_deref(), self.contacts.as_ref());
        let (chunks, horizon) = (state.len().div_ceil(CHUNK), BOUND_INTERVAL as f64 * self.next_dt);
        // The laws of contacts are asked once; what follows from their answers is cheap, and made twice.
        let stiffness = |chunk: usize| contacts.map_or_else(Vec::new, |c| c.stage.stiffness(state, chunk, horizon));
        let stiffness = self.team.map(0..chunks, |chunk, _| stiffness(chunk));
        // All bonds come before all contacts, and these before rigid bodies.
        let rigid = self.rigid.as_deref();
        let elements = |part: usize, each: &mut dyn FnMut(Element)| match (part / chunks, part % chunks) {
            (0, chunk) => bonds.into_iter().for_each(|bonds| bonds.elements(state, chunk, each)),
            (1, chunk) => {
                contacts.into_iter().for_each(|c| c.stage.elements(state, chunk, &stiffness[chunk], each));
            }
            (_, chunk) => rigid.into_iter().for_each(|rigid| rigid.elements(state, chunk, horizon, each)),
        };
        let parts = chunks * if rigid.is_some() { 3 } else { 2 };
        let (resolution, held) = (self.spec.time.contact_resolution, |p: usize| state.hold[p] != 0);
        self.bound = self.stiffness.bound(parts, elements, state, resolution, held, &self.team);
        self.timings.time_step += began.elapsed();
        self.next_dt = step_choice::choose(&self.view())?;
        self.show(|monitor, view| monitor.look_at_step(view));
        Ok(())
    }

    /// Lets the monitor look at everything, and does what it answers.
    fn watch(&mut self) -> Result<()> {
        for action in self.show(Monitor::look) {
            match action {
                Action::AddContacts => self.add_contacts(),
                Action::AdjustLoadingRate(ahead) => {
                    let interval = BOUND_INTERVAL as f64 * self.next_dt;
                    self.holds.loading_rate.iter_mut().for_each(|rate| rate.aim(ahead, interval));
                }
                Action::Stop(failure) => return Err(self.failed(failure)),
            }
        }
        Ok(())
    }

    /// Shows the monitor what there is.
    fn show<A>(&mut self, look: impl FnOnce(&mut Monitor, &StepView) -> A) -> A {
        let mut monitor = std::mem::take(&mut self.monitor);
        let answer = look(&mut monitor, &self.view());
        self.monitor = monitor;
        answer
    }

    /// The error that ends a run now.
    fn failed(&self, failure: Failure) -> Error {
        Error::Simulation(Box::new(Stopped { at: self.view().instant(), failure, kept: None }))
    }

    /// What can be seen between two steps.
    pub fn view(&self) -> StepView<'_> {
        StepView {
            spec: &self.spec,
            plan: &self.plan,
            assembly: &self.assembly,
            state: &self.state,
            bonds: self.bonds.as_deref(),
            contacts: self.contacts.as_ref().map(|c| &*c.stage),
            neighbours: self.contacts.as_ref().map(|c| &c.neighbours),
            rigid: self.rigid.as_deref(),
            team: &self.team,
            holds: &self.holds,
            measures: &self.measures,
            ledger: &self.energy,
            ruptures: self.rupture_count,
            bound: &self.bound,
            time_step: self.next_dt,
        }
    }

    /// Strain of the body: grip displacement over the free length between the particles held, smoothed as stress is, so that the two belong together
    /// ([`measure::Measures`]) (-).
    pub fn strain(&self) -> f64 {
        self.measures.strain()
    }

    /// Simulated time (s).
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.state.step
    }

    /// Nominal stress, the mean over an eighth of a wave's way along the strand (Pa).
    pub fn stress(&self) -> f64 {
        self.measures.stress()
    }

    /// Current time step (s).
    pub fn time_step(&self) -> f64 {
        self.next_dt
    }

    /// The bound on the stable step (s).
    pub fn time_step_bound(&self) -> f64 {
        self.bound.step
    }

    /// What limits the time step.
    pub fn time_step_limit(&self) -> StepLimit {
        step_choice::limit(&self.view())
    }

    /// A row of the curve.
    pub fn sample(&self) -> Sample {
        self.view().sample()
    }

    /// Every particle.
    pub fn snapshot(&self) -> Snapshot {
        let view = self.view();
        Snapshot { detail: detail::detail(&view), ..view.snapshot() }
    }

    /// The energy ledger now.
    pub fn energy(&self) -> Energy {
        self.view().energy()
    }

    /// What does not change during the run.
    pub fn info(&self) -> RunInfo {
        info::info(&self.spec, &self.assembly, self.holds.stretch.gauge)
    }

    /// Memory by stage, now.
    pub fn bytes(&self) -> StageBytes {
        StageBytes::of(&self.view(), self.stiffness.bytes())
    }

    /// Speed of the upper grip along z now, of a pull at constant or adaptive speed (m/s); 0 of any other drive.
    pub fn grip_speed(&self) -> f64 {
        self.holds.speed()
    }

    /// Time that an adaptive pull is expected to take from here to `strain` (s), by the law of the bonds alone. `None` of
    /// any other drive.
    pub fn adaptive_time(&self, strain: f64) -> Option<f64> {
        let now = Ahead { work: self.holds.work, strain: self.holds.strain(), left: 0.0 };
        let stress = |strain: f64| estimates::body_stress(&self.spec, &self.assembly, strain);
        let breaks = estimates::rupture_strain(&self.spec);
        Some(
            self.holds
                .loading_rate
                .as_ref()?
                .time_to(strain, now, breaks, |strain| stress(strain) * self.assembly.area),
        )
    }

    /// Notices since the last call, in order.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        self.monitor.take_notices()
    }

    /// Those of them that have become worse since they were given, as they were at their worst.
    pub fn take_worse(&mut self) -> Vec<Notice> {
        self.monitor.take_worse()
    }

    /// What was seen of the engine's own limits over the whole run so far.
    pub fn findings(&self) -> Findings {
        self.monitor.findings(&self.view())
    }

    /// Looks whether wires passed through each other since the last neighbour search.
    ///
    /// # Errors
    /// [`Error::Simulation`] when two did.
    pub fn check_crossings(&self) -> Result<()> {
        monitor::crossed(&self.view()).map_or(Ok(()), |failure| Err(self.failed(failure)))
    }

    /// Ruptures since the last call, in order.
    pub fn take_ruptures(&mut self) -> Vec<Rupture> {
        std::mem::take(&mut self.ruptures)
    }

    /// The scene that it runs.
    pub fn spec(&self) -> &Spec {
        &self.spec
    }

    /// The assembly that the run started from.
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// What this run computes.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Particles as they are now.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Wall time per stage so far.
    pub fn timings(&self) -> &Timings {
        &self.timings
    }

    /// Neighbour searches so far, candidate pairs and touching pairs now.
    pub fn contact_counts(&self) -> (u64, usize, usize) {
        self.contacts.as_ref().map_or((0, 0, 0), |c| (c.neighbours.rebuilds, c.stage.candidates(), c.stage.active()))
    }
}
