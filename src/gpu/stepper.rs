//! The steps of an engine on a device.
//!
//! All numbers of particles and pairs lie in columns on the device, from the first step to the last. A block of steps is one
//! submission; after it the engine takes up what came of its steps, so that rows, ruptures, ledger and checkpoints are its own.
//! Where a bond has to be broken or neighbours have to be searched, the block ends at that step: the engine does it and ends the
//! step itself, and the next block begins with what the engine then has.
//!
//! Engines of one process whose steps are the same functions, such as draws of one strand, share submissions
//! ([`together`](super::together)).

use super::adapter::Device;
use super::batch::Program;
use super::layout::Shape;
use super::together::{Request, Response, Together};
use crate::base::error::Result;
use crate::engine::Engine;
use crate::engine::elsewhere::{End, Foretold};
use std::sync::Arc;

/// Steps of an engine on a device.
pub struct Stepper {
    device: Device,
    together: Arc<Together>,
    number: usize,
    /// The batch that it was in.
    epoch: u64,
    /// Whether the engine has something else than the device.
    ahead: bool,
    /// Whether the functions have contacts among them.
    contacts: bool,
}

impl Stepper {
    /// Takes over the steps of `engine`, and of no other from then on.
    ///
    /// # Errors
    /// [`Error::Missing`](crate::base::error::Error::Missing) when the engine has a stage that cannot be recorded
    /// ([`Engine::record_step`]), or the driver refuses the work; [`Error::Input`](crate::base::error::Error::Input) when it is too
    /// large for the device.
    pub fn new(device: &Device, engine: &Engine) -> Result<Self> {
        let together = Together::of(device, &engine.record_step()?, &engine.step_names())?;
        let shape = Shape { particles: engine.state().len() as u32, measured: engine.measured() };
        let number = together.join(shape, engine.pairs().len())?;
        let contacts = engine.has_contacts();
        Ok(Self { device: device.clone(), together, number, epoch: 0, ahead: true, contacts })
    }

    /// Advances by `steps` steps.
    ///
    /// # Errors
    /// As for [`Self::block`].
    pub fn advance(&mut self, engine: &mut Engine, steps: u64) -> Result<()> {
        let last = engine.steps() + steps;
        while engine.steps() < last {
            self.block(engine, |next| next.steps >= last, |_| ())?;
        }
        Ok(())
    }

    /// Does a block of steps: up to the first after which `stop` says yes, or to where the engine has to look after something.
    /// `between` sees what is measured after each step but the last.
    ///
    /// # Errors
    /// As for [`Engine::step`], and [`Error::Missing`](crate::base::error::Error::Missing) when the device fails: the engine is
    /// then as it was before the block.
    pub fn block(
        &mut self,
        engine: &mut Engine,
        stop: impl FnMut(Foretold) -> bool,
        between: impl FnMut(&Engine),
    ) -> Result<()> {
        let mut block = engine.plan_block(stop)?;
        if engine.has_contacts() != self.contacts {
            *self = Self::new(&self.device, engine)?;
        }
        let outcome = loop {
            let program: &Program = &self.together.program;
            let news = self.ahead.then(|| program.news(engine));
            match self.together.exchange(self.number, Request { block, news, epoch: self.epoch })? {
                Response::Done(own, outcome, epoch) => {
                    (block, self.epoch) = (own, epoch);
                    break outcome;
                }
                Response::Anew(own) => (block, self.ahead) = (own, true),
            }
        };
        self.ahead = outcome.end == End::Due;
        engine.take_block(&block, &outcome, between)
    }
}

impl Drop for Stepper {
    fn drop(&mut self) {
        self.together.leave(self.number);
    }
}
