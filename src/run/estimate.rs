//! What a run would cost: the numbers behind `strandsnap plan`.

use super::size::{Output, gigabytes};
use crate::base::error::Result;
use crate::base::finding::StepLimit;
use crate::base::units::ms;
use crate::base::wording::counted;
use crate::engine::Engine;
use crate::engine::memory::StageBytes;
use crate::scene::plan::Plan;
use crate::scene::spec::{BondLawSpec, DriveSpec, Spec};
use crate::strand::assembly::Assembly;
use crate::strand::discretise;
use crate::strand::size::Size;
use std::fmt;
use std::time::{Duration, Instant};

/// Steps are tried until this many are done or this much time has passed.
const TRIAL: (u64, Duration) = (200, Duration::from_millis(500));

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
    let (step_wall, measured) = trial(&mut engine, TRIAL)?;
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

/// Strain of the trial under load (-): more than any wire yields at.
const LOADED_STRAIN: f64 = 0.05;
/// By how much the trial draws the wires together, of their distance from the axis, and in how many steps (-). With this,
/// 10,000 to 13,000 pairs of KA4's spheres touch while it is measured, and 17,000 in the second half of its run; of its
/// first steps it is 1,500.
const DRAWN_TOGETHER: f64 = 0.1;
const DRAWN_IN: f64 = 100.0;
/// By how much other bodies are thickened, so that those which lie beside each other touch (-).
const PRESSED: f64 = 0.002;
/// Damping of the trial, critical, so that what has met stays together (-).
const LOADED_DAMPING: f64 = 1.0;
/// Steps and time until wires have met, and of the measurement that follows, before a strand of one layer has sprung open.
const SETTLING: (u64, Duration) = (120, Duration::from_millis(600));
const LOADED_TRIAL: (u64, Duration) = (80, Duration::from_millis(400));

/// Wall time of a step (s) of the same run where its bonds flow and its wires touch, which the first steps do not show:
/// tried with bonds that are stretched and, in a strand, with layers that are closed and drawn together until wires lie on
/// each other. `None` where neither can happen, and where such a state cannot be stepped.
pub fn under_load(spec: &Spec, assembly: Assembly) -> Option<f64> {
    trial(&mut loaded(spec, assembly, SETTLING)?, LOADED_TRIAL).ok().map(|(wall, _)| wall)
}

/// The same run in that state, in which a strand comes after `settling` steps and time.
fn loaded(spec: &Spec, assembly: Assembly, settling: (u64, Duration)) -> Option<Engine> {
    let flows =
        spec.grip.is_some() && spec.materials().any(|one| matches!(one.bond.law, BondLawSpec::ElastoPlastic(_)));
    let touches = spec.contact.is_some() && assembly.wires.len() > 1;
    if !flows && !touches {
        return None;
    }
    let mut loaded = spec.clone();
    loaded.bonds_mut().for_each(|bond| bond.rupture = None);
    let closed = if touches { closed(spec) } else { None };
    let is_strand = closed.is_some();
    let mut assembly = closed.unwrap_or(assembly);
    if flows {
        assembly.rest_length.iter_mut().for_each(|length| *length /= 1.0 + LOADED_STRAIN);
    }
    if is_strand {
        // What is not damped at all may be left out of a run, and costs nothing there.
        let damp = |damping: &mut f64| {
            if *damping > 0.0 {
                *damping = LOADED_DAMPING;
            }
        };
        loaded.contact.iter_mut().for_each(|contact| damp(&mut contact.damping));
        loaded.bonds_mut().for_each(|bond| bond.damping.iter_mut().for_each(damp));
        let step = Engine::new(&loaded, &Plan::new(&loaded), assembly.clone()).ok()?.time_step();
        let rate = DRAWN_TOGETHER / (DRAWN_IN * step);
        for particle in 0..assembly.wire_particles {
            assembly.velocity.x[particle] = -rate * assembly.position.x[particle];
            assembly.velocity.y[particle] = -rate * assembly.position.y[particle];
        }
    } else if touches {
        assembly.radius.iter_mut().for_each(|radius| *radius *= 1.0 + PRESSED);
    }
    let mut engine = Engine::new(&loaded, &Plan::new(&loaded), assembly).ok()?;
    if is_strand {
        trial(&mut engine, settling).ok()?;
    }
    Some(engine)
}

/// The bodies of a strand whose layers lie on each other; `None` for other bodies.
fn closed(spec: &Spec) -> Option<Assembly> {
    let mut closed = spec.clone();
    closed.strand.as_mut()?.layers.iter_mut().for_each(|layer| layer.lay_radius = None);
    discretise::build(&closed).ok()
}

/// Steps for a while: wall time of a step (s), and the number of steps that it was measured over.
fn trial(engine: &mut Engine, (most_steps, most_time): (u64, Duration)) -> Result<(f64, u64)> {
    let begin = Instant::now();
    let mut measured = 0;
    while measured == 0 || (measured < most_steps && begin.elapsed() < most_time) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    /// Under load wires lie on each other, as they do later in a run, and not at its start.
    #[test]
    fn wires_touch_in_the_trial_under_load() {
        let spec = scene::load("ka4", &[]).unwrap().spec;
        let assembly = discretise::build(&spec).unwrap();
        let settling = (SETTLING.0, Duration::MAX);
        let mut first = Engine::new(&spec, &Plan::new(&spec), assembly.clone()).unwrap();
        trial(&mut first, settling).unwrap();
        let particles = assembly.len();
        let [first, later] =
            [first, loaded(&spec, assembly, settling).unwrap()].map(|engine| engine.contact_counts().2);
        assert!(first < particles / 4 && later > 2 * particles / 3, "{first} and {later} of {particles}");
        let single = scene::load("single-wire", &[]).unwrap().spec;
        assert!(loaded(&single, discretise::build(&single).unwrap(), settling).is_some());
        let spheres = scene::load("two-spheres", &[]).unwrap().spec;
        assert!(loaded(&spheres, discretise::build(&spheres).unwrap(), settling).is_none());
    }
}
