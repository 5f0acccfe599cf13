//! What a run would cost: the numbers behind `strandsnap plan`.

use super::size::{Output, gigabytes};
use crate::base::error::Result;
use crate::base::finding::StepLimit;
use crate::base::units::ms;
use crate::base::wording::counted;
use crate::engine::Engine;
use crate::engine::memory::StageBytes;
use crate::scene::plan::Plan;
use crate::scene::spec::{BondLawSpec, BondSpec, DriveSpec, Spec};
use crate::strand::assembly::Assembly;
use crate::strand::size::Size;
use std::fmt;
use std::time::{Duration, Instant};

/// Steps are tried until this much time has passed or this many are done.
const TRIAL_TIME: Duration = Duration::from_millis(500);
const TRIAL_STEPS: u64 = 200;

/// The size of a run, and what it is expected to cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Wires.
    pub wires: usize,
    /// Particles, free spheres included.
    pub particles: usize,
    /// Bonds.
    pub bonds: usize,
    /// First time step (s).
    pub first_time_step: f64,
    /// Time step after the trial steps (s): the first one may be short, because the bound does not know yet which
    /// contacts will close.
    pub time_step: f64,
    /// What limits it.
    pub time_step_limit: StepLimit,
    /// Simulated time to the expected end (s); `None` when the scene does not tell.
    pub duration: Option<f64>,
    /// Steps to the expected end at the time step after the trial.
    pub steps: Option<f64>,
    /// Wall time of a step, measured (s).
    pub step_wall: f64,
    /// Wall time of a step once wires flow and touch (s) ([`under_load`]); `None` where it was not measured or they never
    /// do.
    pub loaded_wall: Option<f64>,
    /// Where the time of the first steps goes, by stage (s).
    pub stage_wall: [(&'static str, f64); 5],
    /// Number of steps that it was measured over.
    pub measured: u64,
    /// Memory by stage.
    pub bytes: StageBytes,
    /// Most contacts at a time (-), roughly.
    pub contacts: f64,
    /// What it may write.
    pub output: Output,
}

/// Sets a run up, tries a few steps and extrapolates. Call it inside a rayon pool to choose the threads.
///
/// # Errors
/// What [`Engine::new`] refuses, and failure of the first steps.
pub fn estimate(spec: &Spec, plan: &Plan, assembly: Assembly) -> Result<Estimate> {
    let (wires, particles, bonds) = (assembly.wires.len(), assembly.len(), assembly.bond_count());
    let mut engine = Engine::new(spec, plan, assembly)?;
    let first_time_step = engine.time_step();
    let duration = duration(spec, &engine);
    let before = *engine.timings();
    let (step_wall, measured) = trial(&mut engine)?;
    let time_step = engine.time_step();
    let of_time = duration.map(|seconds| (seconds / time_step).ceil());
    let of_steps = spec.stop.steps.map(|n| n as f64);
    Ok(Estimate {
        wires,
        particles,
        bonds,
        first_time_step,
        time_step,
        time_step_limit: engine.time_step_limit(),
        duration,
        steps: [of_time, of_steps].into_iter().flatten().reduce(f64::min),
        step_wall,
        loaded_wall: None,
        stage_wall: engine.timings().since(&before).stages().map(|(name, t)| (name, t.as_secs_f64() / measured as f64)),
        measured,
        bytes: engine.bytes(),
        contacts: Size::of(spec).contacts,
        output: Output::of(spec, particles, wires),
    })
}

/// Strain and radial pressing of the trial under load (-): more than any wire yields at, and what a strand that is strained
/// so presses its layers together.
const LOADED_STRAIN: f64 = 0.01;
const PRESSED: f64 = 0.002;

/// Wall time of a step (s) of the same run where its bonds flow and its wires touch, which the first steps do not show:
/// tried with bonds that are stretched and wires that are pressed from the start. `None` where neither can happen, and where
/// such a state cannot be stepped.
pub fn under_load(spec: &Spec, mut assembly: Assembly) -> Option<f64> {
    let flows = matches!(spec.bond.law, BondLawSpec::ElastoPlastic(_)) && spec.grip.is_some();
    let touches = spec.contact.is_some() && assembly.wires.len() > 1;
    if !flows && !touches {
        return None;
    }
    let unbroken = Spec { bond: BondSpec { rupture: None, ..spec.bond.clone() }, ..spec.clone() };
    if flows {
        assembly.rest_length.iter_mut().for_each(|length| *length /= 1.0 + LOADED_STRAIN);
    }
    assembly.radius.iter_mut().for_each(|radius| *radius *= 1.0 + PRESSED);
    trial(&mut Engine::new(&unbroken, &Plan::new(&unbroken), assembly).ok()?).ok().map(|(wall, _)| wall)
}

/// Steps for a while: wall time of a step (s), and the number of steps that it was measured over.
fn trial(engine: &mut Engine) -> Result<(f64, u64)> {
    let begin = Instant::now();
    let mut measured = 0;
    while measured == 0 || (measured < TRIAL_STEPS && begin.elapsed() < TRIAL_TIME) {
        engine.step()?;
        measured += 1;
    }
    Ok((begin.elapsed().as_secs_f64() / measured as f64, measured))
}

/// Simulated time to the expected end (s): `stop.time`, or the expected strain at the pull's speed.
fn duration(spec: &Spec, engine: &Engine) -> Option<f64> {
    let info = engine.info();
    let gauge = info.gauge.map(|[lower, upper]| upper - lower);
    let strain = info.strain_end.or(spec.stop.strain);
    let pull = match (gauge, strain, &spec.grip) {
        (Some(gauge), Some(strain), Some(grip)) => match grip.drive {
            DriveSpec::Speed(speed) if speed != 0.0 => {
                engine.adaptive_time(strain).or(Some((strain * gauge / speed).abs()))
            }
            _ => None,
        },
        _ => None,
    };
    [pull, spec.stop.time].into_iter().flatten().reduce(f64::min)
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "size: {}, {}, {}",
            counted(self.wires, "wire"),
            counted(self.particles, "particle"),
            counted(self.bonds, "bond")
        )?;
        writeln!(
            f,
            "time step: {:.3e} s at first, {:.3e} s after {}, limited by {}",
            self.first_time_step,
            self.time_step,
            counted(self.measured, "step"),
            self.time_step_limit
        )?;
        if let Some(duration) = self.duration {
            writeln!(f, "simulated time: {duration:.3e} s")?;
        }
        match self.steps {
            Some(steps) => {
                let first = ms(self.step_wall);
                write!(f, "steps: about {steps:.0}, {first:.3} ms each over the first {}", self.measured)?;
                match self.loaded_wall {
                    Some(wall) => writeln!(f, ", {:.3} ms once wires flow and touch", ms(wall))?,
                    None => writeln!(f)?,
                }
                let wall = steps * self.loaded_wall.unwrap_or(self.step_wall);
                writeln!(f, "wall time: about {}; output not included", span(wall))?;
            }
            None => writeln!(f, "steps: unknown, because the scene ends at no strain, time or number of steps")?,
        }
        let shares = self.stage_wall.iter().filter(|(_, wall)| *wall > 0.0);
        let times: Vec<String> = shares.map(|(name, wall)| format!("{name} {:.4} ms", ms(*wall))).collect();
        writeln!(f, "by stage: {}", times.join(", "))?;
        let each = |bytes: usize| bytes / self.particles;
        let kept = self.bytes.stages().into_iter().filter(|(_, bytes)| each(bytes.kept) > 0);
        let kept: Vec<String> = kept.map(|(name, bytes)| format!("{name} {}", each(bytes.kept))).collect();
        let all = gigabytes(self.bytes.kept() as f64);
        writeln!(f, "memory: {all}, {} bytes per particle: {}", each(self.bytes.kept()), kept.join(", "))?;
        writeln!(f, "contacts: up to about {:.0}", self.contacts)?;
        write!(f, "{}", self.output)
    }
}

/// Seconds for people.
fn span(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
