//! Floor 4: the engine. State as structure of arrays, stages, time step, energy ledger.
//!
//! One step, in order: kick (velocities from the last forces) → holds (prescribed motion) → drift → neighbours (when
//! stale) → bonds → rupture → contacts → gather. Each stage is called through `dyn` once; the loops inside are
//! monomorphic over their laws. [`crate::scene::plan::Plan`] decides which stages there are.

pub mod bonds;
pub mod bytes;
pub mod contacts;
pub mod crossing;
pub mod grips;
pub mod integrate;
mod kinds;
pub mod measure;
pub mod neighbours;
pub mod pace;
pub mod pair;
pub mod rupture;
pub mod saved;
pub mod spheres;
pub mod state;
pub mod straight;
pub mod time_step;
pub mod view;
pub mod watch;
pub mod wires;

use crate::base::error::{Error, Result};
use crate::base::finding::{Failure, StepLimit};
use crate::law::bond::elastic::Elastic;
use crate::law::bond::elasto_plastic::ElastoPlastic;
use crate::law::bond::{BondLaw, Moduli};
use crate::law::contact::constants::effective_modulus;
use crate::scene::plan::{ContactPlan, Plan};
use crate::scene::spec::{BondLawSpec, Material, Spec};
use crate::strand::assembly::Assembly;
use bonds::{BondStage, Bonds};
use contacts::Contacts;
use grips::Holds;
use measure::Measures;
use neighbours::Neighbours;
use pulp::Arch;
use rupture::RuptureCheck;
use state::State;
use std::time::{Duration, Instant};
use time_step::{Bound, Stiffness};
use view::{Energy, Rupture};
use watch::Watch;

/// Revision of the physics: raised whenever a run gives other bits than before, which `tests/revision.rs` sees. Kept results
/// of another revision are not those that this engine would give.
pub const REVISION: u32 = 1;

/// Steps between two evaluations of the bound on the time step.
const BOUND_INTERVAL: u64 = 64;
/// Greatest growth of the step at one evaluation (-).
const GROWTH: f64 = 2.0;
/// First step of bodies that overlap, over the usual one (-); it grows from one evaluation to the next.
const START: f64 = 0.25;
/// Energy of contacts at the start, over a negligible one, from which bodies count as overlapping (-): that of an elastic
/// strain of 1e-4 everywhere.
const THROWN: f64 = 1e10;
/// Steps of free flight until the end of the run (-).
const FLIGHT_STEPS: f64 = 10_000.0;
/// Least number of steps of an impact (-); leapfrog is then good for (π/100)²/24 of its time, 4e-5.
const IMPACT_STEPS: f64 = 100.0;
/// A particle that moves further than this share of the least radius in one step has run away (-).
const RUNAWAY: f64 = 0.1;
/// What is fast is stepped so that it moves no further than this share of the least radius in one step (-): half of
/// what counts as running away, for speeds that grow between two evaluations.
const TRAVEL: f64 = 0.05;

/// Wall time spent per stage.
#[derive(Debug, Clone, Copy, Default)]
pub struct Timings {
    /// Kick, holds, drift, gather.
    pub integrate: Duration,
    /// Neighbour search.
    pub neighbours: Duration,
    /// Bonds and rupture.
    pub bonds: Duration,
    /// Contacts.
    pub contacts: Duration,
    /// Bound on the time step.
    pub time_step: Duration,
}

impl Timings {
    /// Every stage with its name.
    pub fn stages(&self) -> [(&'static str, Duration); 5] {
        [
            ("motion", self.integrate),
            ("bonds", self.bonds),
            ("contacts", self.contacts),
            ("neighbours", self.neighbours),
            ("time step", self.time_step),
        ]
    }

    /// What has been spent since `earlier`.
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            integrate: self.integrate - earlier.integrate,
            neighbours: self.neighbours - earlier.neighbours,
            bonds: self.bonds - earlier.bonds,
            contacts: self.contacts - earlier.contacts,
            time_step: self.time_step - earlier.time_step,
        }
    }
}

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
    watch: Watch,
}

impl Engine {
    /// Sets the assembly up for its first step.
    ///
    /// # Errors
    /// When there is no stable step because nothing is stiff and the scene fixes none, or a grip holds nothing.
    pub fn new(spec: &Spec, assembly: Assembly) -> Result<Self> {
        Self::set_up(spec, assembly, build_bonds)
    }

    /// [`Engine::new`] with a bond law of one's own in the place of the scene's, whose `bond.law` and hardening then say
    /// nothing; damping and rupture are the scene's.
    ///
    /// # Errors
    /// As for [`Engine::new`].
    pub fn with_law<L: BondLaw>(spec: &Spec, assembly: Assembly, law: L) -> Result<Self> {
        Self::set_up(spec, assembly, |spec, plan, assembly| bond_stage(law, spec, plan, assembly))
    }

    fn set_up(
        spec: &Spec,
        assembly: Assembly,
        build_bonds: impl FnOnce(&Spec, &Plan, &Assembly) -> Box<dyn Bonds>,
    ) -> Result<Self> {
        let plan = Plan::new(spec);
        let mut state = State::new(&assembly, plan.rotations);
        let holds = Holds::new(spec, &assembly, &mut state)?;
        let bonds = if plan.bonds { Some(build_bonds(spec, &plan, &assembly)) } else { None };
        let measures = Measures::new(spec, &assembly, &holds);
        let least_radius = assembly.radius.iter().copied().fold(f64::MAX, f64::min);
        let mut engine = Self {
            spec: spec.clone(),
            plan,
            state,
            bonds,
            contacts: None,
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
            watch: Watch::new(spec, &assembly),
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
        let Some(contact) = &self.spec.contact else { return };
        let diameter = 2.0 * self.assembly.radius.iter().copied().fold(0.0, f64::max);
        self.state.meet_contacts();
        self.contacts = Some(ContactPart {
            stage: contacts::build(contact, &self.spec.material, &self.assembly),
            neighbours: Neighbours::new(&self.assembly, contact.skin * diameter, contact.shape),
            stale: true,
        });
    }

    /// Advances by one step.
    ///
    /// # Errors
    /// [`Error::Simulation`] when a value stops being finite or runs away, when wires pass through each other, and when a
    /// stage that was left out turns out to be needed.
    pub fn step(&mut self) -> Result<()> {
        if self.state.step.is_multiple_of(BOUND_INTERVAL) && self.state.step > 0 {
            self.choose_step()?;
            self.choose_pace(BOUND_INTERVAL);
            self.watch_stages()?;
            self.watch_necking();
        }
        let began = Instant::now();
        let kicked = 0.5 * (self.state.dt + self.next_dt);
        let turn = self.plan.rotations;
        integrate::kick(&mut self.state, kicked, turn, self.arch);
        self.state.dt = self.next_dt;
        // Of the instant at which the forces act that the grips hold against.
        let strain = self.holds.strain();
        self.holds.apply(&mut self.state, kicked, self.arch);
        let largest2 = integrate::drift(&mut self.state, self.arch);
        self.state.step += 1;
        self.state.time += self.state.dt;
        self.measures.take(strain, &self.holds.reaction, self.bonds.as_deref(), self.state.dt);
        self.timings.integrate += began.elapsed();
        self.state.travel += largest2.sqrt();
        let limit = RUNAWAY * self.least_radius;
        if largest2.is_nan() || largest2 > limit * limit {
            return Err(self.runaway(limit));
        }
        if let Some(c) = &mut self.contacts {
            c.stale |= c.neighbours.stale(&self.state, &self.holds.stretch);
        }
        self.forces()
    }

    /// Forces at the present positions.
    fn forces(&mut self) -> Result<()> {
        let began = Instant::now();
        if let Some(bonds) = &mut self.bonds {
            let partial = bonds.compute(&mut self.state);
            self.energy.plastic_bonds += partial.plastic;
            self.energy.damping += partial.damping;
        }
        if self.plan.rupture {
            self.break_bonds();
        }
        let after_bonds = Instant::now();
        self.timings.bonds += after_bonds - began;
        let stale = self.contacts.as_ref().is_some_and(|c| c.stale);
        if stale {
            self.inspect()?;
        }
        if let Some(c) = &mut self.contacts {
            if c.stale {
                let list = c.neighbours.search(&self.state, self.holds.stretch);
                let lost = c.stage.rebuild(list, &self.state);
                self.energy.friction += lost.friction;
                self.energy.released += lost.released;
                c.stale = false;
            }
            let after_search = Instant::now();
            self.timings.neighbours += after_search - after_bonds;
            let partial = c.stage.compute(&mut self.state);
            self.energy.plastic_contacts += partial.plastic;
            self.energy.plastic_thinning += partial.thinning;
            self.energy.friction += partial.friction;
            self.energy.damping += partial.damping;
            self.timings.contacts += after_search.elapsed();
            self.watch_contacts(partial.deepest);
            if stale {
                self.watch_stretch();
            }
        }
        let before_gather = Instant::now();
        let parts = integrate::Parts {
            turn: self.plan.rotations,
            contacts: self.contacts.as_ref().map(|c| c.stage.second_sides()),
            thin: matches!(self.spec.bond.law, BondLawSpec::ElastoPlastic(_)),
        };
        integrate::gather(&mut self.state, parts, self.arch);
        self.timings.integrate += before_gather.elapsed();
        Ok(())
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

    /// Follows the bound on the stable step; small changes are left alone, so that leapfrog keeps its even step.
    fn choose_step(&mut self) -> Result<()> {
        let began = Instant::now();
        self.stiffness.clear();
        if let Some(bonds) = &self.bonds {
            bonds.stiffness(&self.state, &mut self.stiffness);
        }
        if let Some(c) = &self.contacts {
            let horizon = BOUND_INTERVAL as f64 * self.next_dt;
            c.stage.stiffness(&self.state, horizon, &mut self.stiffness);
        }
        let hold = &self.state.hold;
        self.bound = self.stiffness.bound(&self.state, self.spec.time.contact_resolution, |p| hold[p] != 0);
        self.timings.time_step += began.elapsed();
        self.next_dt = self.wanted_step()?;
        self.watch_step();
        Ok(())
    }

    /// The step to take from here on (s).
    fn wanted_step(&self) -> Result<f64> {
        if let Some(step) = self.spec.time.step {
            return Ok(step);
        }
        let stiff = (self.spec.time.safety * self.bound.step).min(self.impact_step());
        let wanted = if self.bonds.is_some() && stiff.is_finite() { stiff } else { stiff.min(self.flight_step()) };
        let wanted = wanted.min(self.travel_step());
        if !wanted.is_finite() && self.next_dt == 0.0 {
            return Err(Error::input(
                "nothing in this scene is stiff, so there is no bound on the time step",
                "state time.step, e.g. step = \"1e-7 s\", or stop.time",
            ));
        }
        // What is foreseen at one step may not hold for a much longer one.
        let wanted = if self.next_dt > 0.0 { wanted.min(GROWTH * self.next_dt) } else { wanted * self.start() };
        let changes = wanted.is_finite() && (self.next_dt == 0.0 || (wanted / self.next_dt - 1.0).abs() > 0.01);
        Ok(if changes { wanted } else { self.next_dt })
    }

    /// Share of the step that the first steps take (-): bodies that overlap from the start are thrown apart in a few
    /// steps, and with full ones the energy of that is off by per cents.
    fn start(&self) -> f64 {
        let much = THROWN * self.negligible_energy();
        let pressed = self.contacts.as_ref().is_some_and(|c| c.stage.elastic_energy(&self.state) > much);
        if pressed { START } else { 1.0 }
    }

    /// Free flight: nothing limits the step but how finely the scene wants to be seen (s).
    fn flight_step(&self) -> f64 {
        self.spec.stop.time.map_or(f64::INFINITY, |time| time / FLIGHT_STEPS)
    }

    /// The step in which the fastest particle moves by [`TRAVEL`] of the least radius (s); infinite at rest.
    fn travel_step(&self) -> f64 {
        TRAVEL * self.least_radius / self.fastest()
    }

    /// Greatest speed of a particle now (m/s).
    fn fastest(&self) -> f64 {
        self.state.v.iter().map(|v| v.length()).fold(0.0, f64::max)
    }

    /// A share of the shortest impact of a free sphere (s): nothing is stiff before two bodies meet, so the bound comes
    /// too late for them, and an impact of a few steps, though stable, has the wrong outcome.
    ///
    /// Contact time 2.868 (m*²/(R*E*²v))^(1/5) (Hertz), m* against an equal sphere, R* against a flat one, twice the
    /// greatest speed.
    fn impact_step(&self) -> f64 {
        let spheres = self.assembly.wire_particles..self.assembly.len();
        if self.contacts.is_none() || spheres.is_empty() {
            return f64::INFINITY;
        }
        let Material { young, poisson, .. } = self.spec.material;
        let modulus = effective_modulus(young, poisson, young, poisson);
        let speed = 2.0 * self.fastest();
        let impact = |p: usize| {
            let mass = 0.5 * self.state.mass[p];
            2.868 * (mass * mass / (self.state.radius[p] * modulus * modulus * speed)).powf(0.2)
        };
        spheres.map(impact).fold(f64::INFINITY, f64::min) / IMPACT_STEPS
    }

    fn runaway(&self, limit: f64) -> Error {
        let far = |p: usize| (self.state.v.get(p) * self.state.dt).length();
        let worst = (0..self.state.len())
            .max_by(|a, b| {
                let key = |p: usize| if far(p).is_nan() { f64::INFINITY } else { far(p) };
                key(*a).total_cmp(&key(*b))
            })
            .unwrap_or(0);
        let moved = far(worst);
        self.failed(Failure::Runaway {
            particle: self.member(worst),
            moved_m: (!moved.is_nan()).then_some(moved),
            limit_m: limit,
            limit_over_radius: RUNAWAY,
            step_s: self.state.dt,
            bound_s: Some(self.bound.step).filter(|bound| bound.is_finite()),
        })
    }

    /// Strain of the body: grip displacement over gauge length, smoothed as stress is, so that the two belong together
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
        let bound = &self.bound;
        let stiff = self.spec.time.safety * bound.step;
        if self.spec.time.step.is_some() {
            StepLimit::Scene { bound_s: Some(bound.step).filter(|bound| bound.is_finite()) }
        } else if self.travel_step() < stiff.min(self.impact_step()) {
            StepLimit::Travel { share_of_radius: TRAVEL }
        } else if self.impact_step() < stiff {
            StepLimit::Impact { steps: IMPACT_STEPS }
        } else if !bound.step.is_finite() {
            StepLimit::None
        } else {
            StepLimit::Stiffness {
                mode: bound.mode,
                element: bound.element(),
                body: self.body(bound.particle),
                bound_s: bound.step,
                safety: self.spec.time.safety,
            }
        }
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

/// Chooses law and modes, once per run.
fn build_bonds(spec: &Spec, plan: &Plan, assembly: &Assembly) -> Box<dyn Bonds> {
    let moduli = Moduli::new(spec.material.young, spec.material.poisson);
    match &spec.bond.law {
        BondLawSpec::Elastic => bond_stage(Elastic { moduli }, spec, plan, assembly),
        BondLawSpec::ElastoPlastic(h) => {
            bond_stage(ElastoPlastic { moduli, hardening: h.clone() }, spec, plan, assembly)
        }
    }
}

fn bond_stage<L: BondLaw>(law: L, spec: &Spec, plan: &Plan, assembly: &Assembly) -> Box<dyn Bonds> {
    let check = spec.bond.rupture.as_ref().map(|r| RuptureCheck::new(r, spec.seed, assembly));
    let damping = spec.bond.damping;
    if plan.rotations {
        Box::new(BondStage::<L, true>::new(law, assembly, damping, check))
    } else {
        Box::new(BondStage::<L, false>::new(law, assembly, damping, check))
    }
}
