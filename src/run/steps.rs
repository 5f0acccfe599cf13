//! Who does the steps of a run: the processor, or a graphics adapter.

use super::schedule::Schedule;
use super::stop::StopRule;
use crate::base::error::{Error, Result};
use crate::engine::Engine;
use crate::engine::elsewhere::Foretold;
#[cfg(feature = "gpu")]
use crate::gpu::{Device, Stepper, adapters};
use crate::observe::planned::PlannedEnd;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
#[cfg(feature = "gpu")]
use std::sync::{Mutex, PoisonError};

/// What a run may be computed on.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum DeviceChoice {
    /// The processor.
    #[default]
    Processor,
    /// A graphics adapter with 64-bit numbers that is no program on the processor, where there is one and the scene's steps can
    /// be done there; else the processor.
    Auto,
    /// A graphics adapter with 64-bit numbers, a program on the processor included; an error where there is none.
    Graphics,
    /// The graphics adapter whose name has this in it.
    Named(String),
}

impl FromStr for DeviceChoice {
    type Err = &'static str;

    fn from_str(text: &str) -> std::result::Result<Self, Self::Err> {
        Ok(match text {
            "" => return Err("it is empty; give cpu, gpu, auto or a part of the name of an adapter"),
            "cpu" => Self::Processor,
            "auto" => Self::Auto,
            "gpu" => Self::Graphics,
            name => Self::Named(name.to_owned()),
        })
    }
}

impl fmt::Display for DeviceChoice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Processor => "cpu",
            Self::Auto => "auto",
            Self::Graphics => "gpu",
            Self::Named(name) => name,
        })
    }
}

/// Who does the steps of an engine.
#[derive(Default)]
pub struct Steps {
    #[cfg(feature = "gpu")]
    adapter: Option<OnAdapter>,
    reason: Option<String>,
}

/// Steps on a graphics adapter.
#[cfg(feature = "gpu")]
struct OnAdapter {
    stepper: Stepper,
    name: String,
    /// Whether the processor must not go on when it fails.
    required: bool,
}

#[cfg(feature = "gpu")]
impl Steps {
    /// Those of `engine`, on what is asked for.
    ///
    /// # Errors
    /// [`Error::Missing`] when there is no such adapter, or the scene's steps cannot be done there, though it was asked for.
    pub fn new(choice: &DeviceChoice, engine: &Engine) -> Result<Self> {
        let device = match choice {
            DeviceChoice::Processor => return Ok(Self::default()),
            DeviceChoice::Auto if adapters().iter().all(|adapter| !adapter.f64 || adapter.kind == "software") => {
                return Ok(Self::refused(NO_PROCESSOR.into()));
            }
            _ => opened(choice),
        };
        let stepper = device.and_then(|device| Stepper::new(&device, engine).map(|stepper| (stepper, device)));
        let required = *choice != DeviceChoice::Auto;
        match stepper {
            Ok((stepper, device)) => {
                let adapter = Some(OnAdapter { stepper, name: device.adapter.name, required });
                Ok(Self { adapter, reason: None })
            }
            Err(error) if required => Err(error),
            Err(error) => Ok(Self::refused(error.to_string())),
        }
    }

    /// The same, but a scene whose steps cannot be done there is left to the processor: for tables of cases, some of which are of
    /// that kind.
    ///
    /// # Errors
    /// [`Error::Missing`] when there is no such adapter.
    pub fn where_possible(choice: &DeviceChoice, engine: &Engine) -> Result<Self> {
        if *choice == DeviceChoice::Processor || *choice == DeviceChoice::Auto {
            return Self::new(choice, engine);
        }
        opened(choice)?;
        Self::new(choice, engine).or_else(|error| match engine.record_step() {
            Ok(_) => Err(error),
            Err(reason) => Ok(Self::refused(reason.to_string())),
        })
    }

    fn refused(reason: String) -> Self {
        Self { adapter: None, reason: Some(reason) }
    }

    /// Name of the adapter that does them.
    pub fn adapter(&self) -> Option<&str> {
        self.adapter.as_ref().map(|adapter| adapter.name.as_str())
    }

    /// Advances `engine` by a step, on an adapter by a few, up to one after which `stop` says yes. `between` sees what is measured
    /// after each but the last.
    fn advance(
        &mut self,
        engine: &mut Engine,
        stop: impl FnMut(Foretold) -> bool,
        between: impl FnMut(&Engine),
    ) -> Result<()> {
        let Some(adapter) = &mut self.adapter else { return engine.step() };
        match adapter.stepper.block(engine, stop, between) {
            // The engine is as it was: it goes on by itself.
            Err(error @ Error::Missing { .. }) if !adapter.required => {
                forget();
                *self = Self::refused(format!("after {} steps {error}", engine.steps()));
                engine.step()
            }
            result => {
                if matches!(result, Err(Error::Missing { .. })) {
                    forget();
                }
                result
            }
        }
    }
}

#[cfg(feature = "gpu")]
const NO_PROCESSOR: &str =
    "this machine has no graphics processor with 64-bit numbers; an adapter that is a program is taken only by name";

/// Adapters that were opened in this process, by what was asked for: all runs on one of them go together.
#[cfg(feature = "gpu")]
static OPENED: Mutex<Vec<(DeviceChoice, Device)>> = Mutex::new(Vec::new());

#[cfg(feature = "gpu")]
fn opened(choice: &DeviceChoice) -> Result<Device> {
    let mut all = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, device)) = all.iter().find(|(own, _)| own == choice) {
        return Ok(device.clone());
    }
    let device = match choice {
        DeviceChoice::Named(name) => Device::open_named(name)?,
        _ => Device::open()?,
    };
    all.push((choice.clone(), device.clone()));
    Ok(device)
}

/// After a failure the next one to ask opens its adapter anew.
#[cfg(feature = "gpu")]
fn forget() {
    OPENED.lock().unwrap_or_else(PoisonError::into_inner).clear();
}

#[cfg(not(feature = "gpu"))]
impl Steps {
    /// Those of `engine`, which only the processor can do.
    ///
    /// # Errors
    /// [`Error::Missing`] when an adapter is asked for.
    pub fn new(choice: &DeviceChoice, _: &Engine) -> Result<Self> {
        match choice {
            DeviceChoice::Processor => Ok(Self::default()),
            DeviceChoice::Auto => Ok(Self { reason: Some(NOT_BUILT.into()) }),
            other => Err(Error::Missing {
                what: format!("--device {other}: {NOT_BUILT}"),
                help: Some("build it with the feature `gpu`".into()),
            }),
        }
    }

    /// The same.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn where_possible(choice: &DeviceChoice, engine: &Engine) -> Result<Self> {
        Self::new(choice, engine)
    }

    /// There is none.
    pub fn adapter(&self) -> Option<&str> {
        None
    }

    fn advance(&mut self, engine: &mut Engine, _: impl FnMut(Foretold) -> bool, _: impl FnMut(&Engine)) -> Result<()> {
        engine.step()
    }
}

#[cfg(not(feature = "gpu"))]
const NOT_BUILT: &str = "this program was built without steps on graphics adapters";

impl Steps {
    /// Advances `engine` by one step.
    ///
    /// # Errors
    /// As for [`Engine::step`]; [`Error::Missing`] when an adapter fails on which the run must go on.
    pub fn step(&mut self, engine: &mut Engine) -> Result<()> {
        self.advance(engine, |_| true, |_| ())
    }

    /// Advances `engine` by a step, on an adapter by a few, up to one after which `schedule` has something due or the run has come
    /// to an end that can be foreseen. `between` shows `rule` what is measured after each but the last.
    ///
    /// # Errors
    /// As for [`Self::step`].
    pub fn step_until_due(
        &mut self,
        engine: &mut Engine,
        schedule: &Schedule,
        end: &PlannedEnd,
        rule: &mut StopRule,
        mut between: impl FnMut(&Engine, &mut StopRule),
    ) -> Result<()> {
        if self.adapter().is_none() {
            return engine.step();
        }
        let (mut schedule, so_far) = (schedule.clone(), rule.clone());
        let stop = |next: Foretold| {
            let due = schedule.due(end.fraction(next.strain, next.time, next.steps));
            due.row || due.snapshot || so_far.reached(next.strain, next.time, next.steps).is_some()
        };
        self.advance(engine, stop, |engine| between(engine, rule))
    }

    /// Why it is the processor that does them, or has done the last ones, though an adapter would have been taken.
    pub fn reason(&self) -> Option<&str> {
        self.reason.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_is_its_name() {
        for text in ["cpu", "auto", "gpu", "NVIDIA H200"] {
            assert_eq!(text.parse::<DeviceChoice>().map(|choice| choice.to_string()), Ok(text.to_owned()));
        }
        assert!("".parse::<DeviceChoice>().is_err());
        assert_eq!("H200".parse(), Ok(DeviceChoice::Named("H200".into())));
    }
}
