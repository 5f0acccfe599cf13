//! Steps of an engine that are done elsewhere, as on a graphics processor.
//!
//! The engine tells what a step is: [`Engine::record_step`] gives it as functions, [`Engine::numbers`] what they begin with.
//! [`Engine::plan_block`] foretells the numbers of a few steps, [`Engine::take_block`] takes up what came of them; between two
//! blocks the engine is as if it had done all steps itself, up to rounding. It chooses the size of the step when it is due, so
//! that a block never goes beyond that. A block ends early where a bond has to be broken or neighbours have to be searched: the
//! engine does that, ends the step itself and goes on.

use super::grips::Holds;
use super::recorded::{Gathering, Motion};
use super::{BOUND_INTERVAL, Engine, RUNAWAY, monitor};
use crate::base::error::{Error, Result};
use crate::base::recorder::{Function, Unrecordable};
use crate::base::vectors::Vectors;

/// Steps of the longest block.
pub const LONGEST: u64 = BOUND_INTERVAL;
/// Numbers that are added up over the steps of a block, particle by particle.
pub const SUMS: [&str; 3] = ["work", "plastic_work", "damping_work"];
/// The same, pair by pair.
pub use super::contact::PAIR_SUMS;

/// What is measured at every step: the sum of a number over some particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Name of the number.
    pub number: &'static str,
    /// The particles.
    pub particles: Vec<u32>,
}

/// Steps to do.
#[derive(Debug, Clone, Default)]
pub struct Block {
    /// Length of each step (s).
    pub dt: f64,
    /// Numbers of each step that are the same for all particles, by name; the same names for all steps.
    pub steps: Vec<Vec<(String, f64)>>,
}

/// How a block ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// All its steps are done.
    Whole,
    /// A bond has reached its limit, or neighbours have to be searched: the last step has come as far as the bonds.
    Due,
    /// A particle ran away in the last step.
    RanAway,
}

/// What came of a block.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// What was measured at each step that was done, in the order of [`Engine::measured`].
    pub measured: Vec<Vec<f64>>,
    /// How it ended.
    pub end: End,
    /// The numbers that the functions gave, of every particle.
    pub numbers: Vec<(String, Vec<f64>)>,
    /// And of every pair of touching particles.
    pub pair_numbers: Vec<(String, Vec<f64>)>,
}

/// Functions of a step, in the order in which they are done.
#[derive(Debug, Clone)]
pub struct StepFunctions {
    /// Of one particle, or the bond that begins at it: motion, and what bonds do.
    pub particles: Vec<Function>,
    /// Of a pair of particles that may touch, where there are any.
    pub pairs: Option<Function>,
    /// Of one particle again: sums over its bonds and contacts.
    pub gather: Function,
}

/// Where a step will end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foretold {
    /// Strain as rows tell it (-).
    pub strain: f64,
    /// Time (s).
    pub time: f64,
    /// Steps done.
    pub steps: u64,
}

impl Engine {
    /// A step as functions. Of the names of the numbers of particles, those with `near_` and `here_` are of the particle itself,
    /// with `far_` of the next one, with `before_` of the one before (0 where there is none), with `contacts_` sums over the
    /// pairs that it is in; of those of pairs, `first_` and `second_` are of their particles. Any other is one of the particle or
    /// pair, or of the step ([`Block`]).
    ///
    /// # Errors
    /// [`Error::Missing`] when a stage of this scene cannot be recorded.
    pub fn record_step(&self) -> Result<StepFunctions> {
        let refused = |what: &str| Error::Missing {
            what: format!("the steps of this scene cannot be done on a graphics adapter: {what}"),
            help: Some("run it on the processor: --device cpu".into()),
        };
        if self.spec.has_several_materials() {
            return Err(refused("its bodies are of several materials"));
        }
        if self.rigid.is_some() {
            return Err(refused("rigid bodies ([[body]])"));
        }
        if !self.spec.output.tables.is_empty() {
            return Err(refused("tables at snapshots (output.tables)"));
        }
        let unrecordable = |reason: Unrecordable| refused(&reason.to_string());
        let mut pairs = None;
        if let Some(contacts) = &self.contacts {
            let stage =
                contacts.stage.elsewhere().ok_or_else(|| refused("contacts of smooth wires (contact.shape)"))?;
            // What asks for single numbers works one contact after the other.
            let one_by_one = |reason| match reason {
                Unrecordable::Value => {
                    refused("the law of friction (contact.tangential), which takes contacts one by one")
                }
                other => unrecordable(other),
            };
            pairs = Some(stage.record(self.plan.rotations).map_err(one_by_one)?);
        }
        let turn = self.plan.rotations;
        let limit = RUNAWAY * self.least_radius;
        let holds = self.holds.formulas().map_err(refused)?;
        let (axis, adaptive) = (self.holds.axis(), self.holds.is_adaptive());
        let motion = Motion { turn, axis, holds, adaptive, limit: limit * limit, search: pairs.is_some() };
        let mut particles = vec![Function::record("motion", &motion).map_err(unrecordable)?];
        if let Some(bonds) = &self.bonds {
            particles.push(bonds.record().map_err(|reason| refused(&reason))?);
        }
        let (bonds, contacts) = (self.bonds.is_some(), pairs.is_some());
        let gathering = Gathering { turn, thin: bonds && self.thins(), bonds, contacts };
        if !bonds && !contacts {
            return Err(refused("nothing in it acts"));
        }
        Ok(StepFunctions { particles, pairs, gather: Function::record("gather", &gathering).map_err(unrecordable)? })
    }

    /// Whether there is a contact stage now, which is then one of the functions of a step.
    pub fn has_contacts(&self) -> bool {
        self.contacts.is_some()
    }

    /// The two particles of each pair that may touch, in order.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        let stage = self.contacts.as_ref().and_then(|contacts| contacts.stage.elsewhere());
        stage.map_or_else(Vec::new, |stage| stage.pairs())
    }

    /// A number of every pair by its name in the functions, as it is now; `None` where a step makes it.
    pub fn pair_numbers(&self, name: &str) -> Option<Vec<f64>> {
        self.contacts.as_ref()?.stage.elsewhere()?.numbers(name)
    }

    /// A number of every particle by its name in the functions, as it is now; `None` where a step makes it.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let n = self.state.len();
        if let Some(row) = self.state.row(name) {
            return Some(row.to_vec());
        }
        if let (Some(axis), Some(contacts)) = (name.strip_prefix("reference_"), &self.contacts) {
            let (_, reference) = contacts.neighbours.last();
            let row = ["x", "y", "z"].iter().position(|own| *own == axis).map(|k| reference.rows()[k])?;
            // Nothing was searched yet.
            return (row.len() == n).then(|| row.to_vec());
        }
        if let Some(actions) = self.state.bond.numbers(name) {
            return Some(actions.take(n).collect());
        }
        if let Some(hold) = name.strip_prefix("held_").and_then(|hold| hold.parse().ok()) {
            let mut held = vec![0.0; n];
            self.holds.members().nth(hold)?.iter().for_each(|p| held[*p as usize] = 1.0);
            return Some(held);
        }
        if name == "free" {
            return Some(self.state.fixed.iter().map(|fixed| f64::from(*fixed == 0)).collect());
        }
        let mut numbers = self.bonds.as_ref()?.numbers(name)?;
        numbers.truncate(n);
        Some(numbers)
    }

    /// What is measured at every step after the motion: forces of the lower and of the upper grip, torque of the upper one, axial
    /// forces of bonds.
    pub fn measured(&self) -> Vec<Measured> {
        let [lower, upper] = self.holds.gripped();
        let of = |number, particles| Measured { number, particles };
        let mut all = Vec::new();
        if !self.holds.formulas().is_ok_and(|holds| holds.is_empty()) {
            all = vec![of("grip_force", lower), of("grip_force", upper.clone()), of("grip_torque", upper)];
        }
        all.extend(self.measures.bonds().iter().map(|slot| of("axial", vec![*slot as u32])));
        all
    }

    /// The next steps: up to one after which `stop` says yes, or fewer.
    ///
    /// # Errors
    /// As for [`Engine::step`].
    pub fn plan_block(&mut self, mut stop: impl FnMut(Foretold) -> bool) -> Result<Block> {
        self.before_step()?;
        let dt = self.next_dt;
        let mut block = Block { dt, steps: Vec::new() };
        let count = BOUND_INTERVAL - self.state.step % BOUND_INTERVAL;
        let (mut now, mut kicked, mut holds) = (self.state.time, self.kicked(), self.holds.clone());
        let mut strains = self.measures.strains();
        for step in 1..=count {
            let strain = strains.take(holds.strain(), dt);
            block.steps.push(self.step_numbers(&mut holds, now, dt, kicked));
            now += dt;
            kicked = dt;
            if stop(Foretold { strain, time: now, steps: self.state.step + step }) {
                break;
            }
        }
        Ok(block)
    }

    /// Names of the numbers of a step ([`Block::steps`]).
    pub fn step_names(&self) -> Vec<String> {
        self.step_numbers(&mut self.holds.clone(), 0.0, 1.0, 1.0).into_iter().map(|(name, _)| name).collect()
    }

    /// Numbers of a step of `dt` (s) from `time` (s) on, after a kick over `kicked` (s), by name; `holds` go on by it.
    fn step_numbers(&self, holds: &mut Holds, time: f64, dt: f64, kicked: f64) -> Vec<(String, f64)> {
        let own = [("dt", dt), ("inverse_dt", 1.0 / dt), ("kicked", kicked), ("inverse_kicked", 1.0 / kicked)];
        let of_holds = holds.foretell(time, dt, kicked);
        let contacts = self.contacts.iter().flat_map(|contacts| {
            let watch = contacts.neighbours.watch(&holds.stretch);
            // Without a list that holds no step goes on beyond its bonds.
            watch.map(|(name, number)| (name, if contacts.stale && name == "search_most" { -1.0 } else { number }))
        });
        let own = own.into_iter().chain(contacts).map(|(name, number)| (name.to_owned(), number));
        own.chain(of_holds).collect()
    }

    /// Takes up what came of a block that [`Engine::plan_block`] has planned. `between` sees what is measured after each step
    /// but the last.
    ///
    /// # Errors
    /// As for [`Engine::step`].
    pub fn take_block(&mut self, block: &Block, outcome: &Outcome, mut between: impl FnMut(&Self)) -> Result<()> {
        // Spins between these steps are not told here.
        self.state.turned = Vectors::default();
        for (k, measured) in outcome.measured.iter().enumerate() {
            if k > 0 {
                between(self);
            }
            let kicked = 0.5 * (self.state.dt + block.dt);
            self.state.dt = block.dt;
            let strain = self.holds.strain();
            let bonds = self.measures.bonds().len();
            let (grips, axial) = measured.split_at(measured.len() - bonds);
            // Bodies without grips have no reactions.
            let grips = if grips.is_empty() { [0.0; 3] } else { [grips[0], grips[1], grips[2]] };
            self.holds.take(grips, self.state.time, block.dt, kicked, &self.state.mass);
            self.state.step += 1;
            self.state.time += block.dt;
            let mut axial = axial.iter().copied();
            self.measures.take(strain, &self.holds.reaction, |_| axial.next().unwrap_or_default(), &[], block.dt);
        }
        for (name, numbers) in &outcome.numbers {
            self.set_numbers(name, numbers);
        }
        self.take_contacts(&outcome.pair_numbers);
        match outcome.end {
            End::Whole => Ok(()),
            End::Due => {
                if let Some(contacts) = &mut self.contacts {
                    contacts.stale |= contacts.neighbours.stale(&self.state, &self.holds.stretch, &self.team);
                }
                self.forces_after_bonds()
            }
            End::RanAway => Err(self.failed(monitor::ran_away(&self.view(), RUNAWAY))),
        }
    }

    /// Takes up the numbers of all pairs.
    fn take_contacts(&mut self, numbers: &[(String, Vec<f64>)]) {
        let Some(contacts) = &mut self.contacts else { return };
        contacts.neighbours.look_anew();
        contacts.stage.look_anew();
        let Some(stage) = contacts.stage.elsewhere_mut() else { return };
        let partial = stage.take(numbers);
        self.book_contacts(&partial);
    }

    /// Takes up a number of every particle that the functions have given. Numbers that nobody remembers are let go.
    fn set_numbers(&mut self, name: &str, numbers: &[f64]) {
        let sum = || numbers.iter().sum::<f64>();
        match name {
            "work" => self.holds.work += sum(),
            "plastic_work" => self.energy.plastic_bonds += sum(),
            "damping_work" => self.energy.damping += sum(),
            _ if self.state.set_row(name, numbers) || self.state.bond.set_numbers(name, numbers) => {}
            _ => self.bonds.iter_mut().for_each(|bonds| bonds.set_numbers(name, numbers)),
        }
    }
}
