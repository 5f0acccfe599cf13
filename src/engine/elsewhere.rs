//! Steps of an engine that are done elsewhere, as on a graphics processor.
//!
//! The engine tells what a step is: [`Engine::record_step`] gives it as functions, [`Engine::numbers`] what they begin with.
//! [`Engine::plan_block`] foretells the numbers of a few steps, [`Engine::take_block`] takes up what came of them; between two
//! blocks the engine is as if it had done all steps itself, up to rounding. It chooses the size of the step when it is due, so
//! that a block never goes beyond that. A block ends early where a bond has to be broken: the engine does that, books it and
//! goes on.

use super::grips::Holds;
use super::recorded::{Gathering, Motion};
use super::{BOUND_INTERVAL, Engine, RUNAWAY, monitor};
use crate::base::error::{Error, Result};
use crate::base::recorder::{Function, Unrecordable};
use crate::scene::plan::ContactPlan;

/// Steps of the longest block.
pub const LONGEST: u64 = BOUND_INTERVAL;
/// Numbers that are added up over the steps of a block, particle by particle.
pub const SUMS: [&str; 3] = ["work", "plastic_work", "damping_work"];

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
    /// A bond has reached its limit: the last step has come as far as the bonds.
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
}

impl Engine {
    /// A step as functions of one particle (or the bond that begins at it), in the order in which they are done: motion, bonds,
    /// sums over bonds. Of the names of the numbers, those with `near_` and `here_` are of the particle itself, with `far_` of
    /// the next one, with `before_` of the one before (0 where there is none); any other is one of the particle, or of the
    /// step ([`Block`]).
    ///
    /// # Errors
    /// [`Error::Missing`] when a stage of this scene cannot be recorded.
    pub fn record_step(&self) -> Result<Vec<Function>> {
        let refused = |what: &str| Error::Missing {
            what: format!("steps of this scene cannot be recorded: {what}"),
            help: Some("run it on the processor".into()),
        };
        if self.spec.has_several_materials() {
            return Err(refused("its bodies are of several materials"));
        }
        if self.contacts.is_some() || self.plan.contacts == ContactPlan::Present {
            return Err(refused("it has contacts"));
        }
        let bonds = self.bonds.as_ref().ok_or_else(|| refused("it has no bonds"))?;
        let turn = self.plan.rotations;
        let limit = RUNAWAY * self.least_radius;
        let holds = self.holds.formulas().map_err(refused)?;
        let (axis, adaptive) = (self.holds.axis(), self.holds.is_adaptive());
        let motion = Motion { turn, axis, holds, adaptive, limit: limit * limit };
        let unrecordable = |reason: Unrecordable| refused(&reason.to_string());
        Ok(vec![
            Function::record("motion", &motion).map_err(unrecordable)?,
            bonds.record().map_err(|reason| refused(&reason))?,
            Function::record("gather", &Gathering { turn, thin: self.thins() }).map_err(unrecordable)?,
        ])
    }

    /// A number of every particle by its name in the functions, as it is now; `None` where a step makes it.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let n = self.state.len();
        if let Some(row) = self.state.row(name) {
            return Some(row.to_vec());
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

    /// The next steps, `most` of them or fewer; none when contacts have come in, which only the engine itself computes.
    ///
    /// # Errors
    /// As for [`Engine::step`].
    pub fn plan_block(&mut self, most: u64) -> Result<Block> {
        self.before_step()?;
        let dt = self.next_dt;
        let mut block = Block { dt, steps: Vec::new() };
        if self.contacts.is_some() {
            return Ok(block);
        }
        let count = most.min(BOUND_INTERVAL - self.state.step % BOUND_INTERVAL);
        let (mut time, mut kicked, mut holds) = (self.state.time, self.kicked(), self.holds.clone());
        for _ in 0..count {
            block.steps.push(step_numbers(&mut holds, time, dt, kicked));
            time += dt;
            kicked = dt;
        }
        Ok(block)
    }

    /// Names of the numbers of a step ([`Block::steps`]).
    pub fn step_names(&self) -> Vec<String> {
        step_numbers(&mut self.holds.clone(), 0.0, 1.0, 1.0).into_iter().map(|(name, _)| name).collect()
    }

    /// Takes up what came of a block that [`Engine::plan_block`] has planned.
    ///
    /// # Errors
    /// As for [`Engine::step`].
    pub fn take_block(&mut self, block: &Block, outcome: &Outcome) -> Result<()> {
        for measured in &outcome.measured {
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
            self.measures.take(strain, &self.holds.reaction, |_| axial.next().unwrap_or_default(), block.dt);
        }
        for (name, numbers) in &outcome.numbers {
            self.set_numbers(name, numbers);
        }
        match outcome.end {
            End::Whole => Ok(()),
            End::Due => self.forces_after_bonds(),
            End::RanAway => Err(self.failed(monitor::ran_away(&self.view(), RUNAWAY))),
        }
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

/// Numbers of a step of `dt` (s) from `time` (s) on, after a kick over `kicked` (s), by name; `holds` go on by it.
fn step_numbers(holds: &mut Holds, time: f64, dt: f64, kicked: f64) -> Vec<(String, f64)> {
    let own = [("dt", dt), ("inverse_dt", 1.0 / dt), ("kicked", kicked), ("inverse_kicked", 1.0 / kicked)];
    let own = own.map(|(name, number)| (name.to_owned(), number)).into_iter();
    own.chain(holds.foretell(time, dt, kicked)).collect()
}
