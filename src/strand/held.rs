//! Which particles the two grips of a scene hold, and what follows from it before a run begins: wires that are not held,
//! components that two of them prescribe, a strain that the drive never reaches.

use crate::scene::spec::{BodyPart, DriveSpec, GripKind, GripSpec, HoldSpec, Spec};
use crate::strand::assembly::Assembly;
use crate::strand::error::{BuildError, BuildErrorKind, mm};
use std::ops::Range;

/// Names of the components of [`HoldSpec::fixed`].
const COMPONENTS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// What the two grips hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Gripped {
    /// Particles in the lower and in the upper grip, wire by wire; empty for wires that do not reach into it, and for all
    /// but the outermost layer under a jaw.
    pub particles: [Vec<Vec<usize>>; 2],
    /// Mean z of the innermost particle that each grip holds of a wire (m); NaN where it holds none.
    pub faces: [f64; 2],
}

impl Gripped {
    /// Finds what `grip` holds of a body.
    pub fn of(grip: &GripSpec, assembly: &Assembly) -> Self {
        let z = &assembly.position.z[..assembly.wire_particles];
        let (low, high) = z.iter().fold((f64::MAX, f64::MIN), |(a, b), z| (a.min(*z), b.max(*z)));
        let outer = assembly.layers.len().saturating_sub(1);
        let jaw = matches!(grip.kind, GripKind::Jaw { .. });
        let mut gripped = Self { particles: [Vec::new(), Vec::new()], faces: [f64::NAN; 2] };
        for upper in [false, true] {
            let (mut last_held, mut wires) = (0.0, 0.0);
            for wire in &assembly.wires {
                let mut held = Vec::new();
                if !jaw || wire.layer == outer {
                    // The particle nearest to the grip's face is the last one held, so that what is free between the
                    // grips is on average as long as the gauge.
                    let half = if wire.len > 1 { 0.5 * (z[wire.first + 1] - z[wire.first]).abs() } else { 0.0 };
                    let inside = |p: &usize| {
                        if upper { z[*p] >= high - grip.length - half } else { z[*p] <= low + grip.length + half }
                    };
                    held.extend(wire.particles().filter(inside));
                }
                let nearer = if upper { f64::min } else { f64::max };
                if let Some(face) = held.iter().map(|p| z[*p]).reduce(nearer) {
                    last_held += face;
                    wires += 1.0;
                }
                gripped.particles[usize::from(upper)].push(held);
            }
            gripped.faces[usize::from(upper)] = last_held / wires;
        }
        gripped
    }

    /// Length between the last particles held in one grip and in the other, mean over the held wires (m).
    pub fn free_length(&self) -> f64 {
        self.faces[1] - self.faces[0]
    }

    /// Wires, from 0, that the lower grip does not hold, and those that the upper one does not.
    fn loose(&self) -> [Vec<usize>; 2] {
        [0, 1].map(|k| (0..self.particles[k].len()).filter(|w| self.particles[k][*w].is_empty()).collect())
    }
}

/// Says which wires are not held at both ends although the grips hold every wire.
pub(super) fn loose_wires(spec: &Spec, assembly: &Assembly) -> Option<String> {
    let grip = spec.grip.as_ref().filter(|grip| grip.kind == GripKind::All)?;
    let [below, above] = Gripped::of(grip, assembly).loose();
    let held = (0..assembly.wires.len()).filter(|w| !below.contains(w) && !above.contains(w)).count();
    if held == assembly.wires.len() {
        return None;
    }
    let neither: Vec<usize> = below.iter().copied().filter(|w| above.contains(w)).collect();
    let only = |missing: &[usize]| missing.iter().copied().filter(|w| !neither.contains(w)).collect::<Vec<_>>();
    let parts = [
        (only(&above), "the lower grip only"),
        (only(&below), "the upper grip only"),
        (neither.clone(), "neither grip"),
    ];
    let told: Vec<String> = parts
        .iter()
        .filter(|(wires, _)| !wires.is_empty())
        .map(|(wires, what)| format!("{} reach{} {what}", numbered(wires), if wires.len() == 1 { "es" } else { "" }))
        .collect();
    let all = assembly.wires.len();
    Some(format!(
        "{}: {held} of {all} wires are held at both ends, and stress is still counted over the section of all; make them \
         as long as the body, or grip.length longer",
        told.join(", ")
    ))
}

/// "wire 3" or "wires 1, 2 and 5", and how many more when there are too many to name.
fn numbered(wires: &[usize]) -> String {
    const MOST: usize = 12;
    let numbers: Vec<String> = wires.iter().take(MOST).map(|w| (w + 1).to_string()).collect();
    match (&numbers[..], wires.len()) {
        ([one], 1) => format!("wire {one}"),
        (all, count) if count > MOST => format!("wires {} and {} more", all.join(", "), count - MOST),
        ([first @ .., last], _) => format!("wires {} and {last}", first.join(", ")),
        ([], _) => "no wires".into(),
    }
}

/// Refuses a component that two holds, or a grip and a hold, prescribe, and a load on what a grip holds.
pub(super) fn check_holds(spec: &Spec, assembly: &Assembly) -> Result<(), BuildError> {
    let bodies = assembly.bodies();
    let held = |hold: &HoldSpec| part(&bodies[hold.body], hold.part);
    for (second, hold) in spec.holds.iter().enumerate() {
        for (first, before) in spec.holds[..second].iter().enumerate() {
            let apart = held(hold).end <= held(before).start || held(before).end <= held(hold).start;
            let shared = (0..6).find(|k| hold.fixed[*k] && before.fixed[*k]);
            if let Some(component) = shared.filter(|_| !apart) {
                return Err(held_twice(second, hold, component, &format!("[[hold]] {} does already", first + 1)));
            }
        }
    }
    let Some(grip) = &spec.grip else { return Ok(()) };
    // A jaw leaves the radial motion of its particles free, but sets their velocity all the same.
    let gripped = Gripped::of(grip, assembly).particles.concat().concat();
    for (number, hold) in spec.holds.iter().enumerate() {
        let touches = gripped.iter().any(|p| held(hold).contains(p));
        let loaded = |k: usize| if k < 3 { hold.force[k] } else { hold.moment[k - 3] } != 0.0;
        if let Some(component) = (0..6).find(|k| hold.fixed[*k] || loaded(*k)).filter(|_| touches) {
            return Err(held_twice(number, hold, component, "a grip holds it"));
        }
    }
    Ok(())
}

fn part(body: &Range<usize>, part: BodyPart) -> Range<usize> {
    match part {
        BodyPart::Start => body.start..body.start + 1,
        BodyPart::End => body.end - 1..body.end,
        BodyPart::All => body.clone(),
    }
}

fn held_twice(number: usize, hold: &HoldSpec, component: usize, by: &str) -> BuildError {
    let verb = if hold.fixed[component] { "prescribes" } else { "loads" };
    let key = match (hold.fixed[component], component < 3) {
        (true, _) => "fix",
        (false, true) => "force",
        (false, false) => "moment",
    };
    BuildError {
        kind: BuildErrorKind::HeldTwice,
        layer: None,
        message: format!("[[hold]] {} {verb} {} of body {}, but {by}", number + 1, COMPONENTS[component], hold.body),
        help: "one of the two can have its way: take the component out of one, or hold another part".into(),
        key: format!("hold.{number}.{key}"),
    }
}

/// Refuses a strain at which the run is to end but which a swinging grip never reaches, when nothing else ends the run for
/// certain; says so when something does.
pub(super) fn unreachable_strain(spec: &Spec, assembly: &Assembly) -> Option<String> {
    let (Some(grip), Some(strain)) = (&spec.grip, spec.stop.strain) else { return None };
    let DriveSpec::Cyclic { amplitude, .. } = grip.drive else { return None };
    let free = Gripped::of(grip, assembly).free_length();
    // At the very turning point it would hang on where the steps fall.
    (free > 0.0 && amplitude <= strain * free).then(|| {
        format!(
            "a swing of {} mm strains the free length of {} mm by {:.4} % at most, so `stop.strain` of {} % is \
             never reached",
            mm(amplitude),
            mm(free),
            100.0 * amplitude / free,
            round(100.0 * strain)
        )
    })
}

/// Eight figures, for people.
fn round(value: f64) -> f64 {
    format!("{value:.7e}").parse().expect("it was written as a number")
}

/// Refuses a scene that would never stop.
pub(super) fn check_stop(spec: &Spec, assembly: &Assembly) -> Result<(), BuildError> {
    let certain = spec.stop.time.is_some() || spec.stop.steps.is_some();
    let Some(message) = unreachable_strain(spec, assembly).filter(|_| !certain) else { return Ok(()) };
    Err(BuildError {
        kind: BuildErrorKind::NeverEnds,
        layer: None,
        message,
        help: "lower stop.strain, swing further, or add time or steps to [stop]".into(),
        key: "stop.strain".into(),
    })
}
