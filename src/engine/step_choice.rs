//! The step that is taken: the stable one with a margin, or less where something moves fast or is about to collide.

use super::estimates::negligible_energy;
use super::step_view::StepView;
use crate::base::error::{Error, Result};
use crate::base::finding::StepLimit;
use crate::law::contact::constants::effective_modulus;
use crate::scene::spec::Material;

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
/// What is fast is stepped so that it moves no further than this share of the least radius in one step (-): half of
/// what counts as running away, for speeds that grow between two evaluations.
const TRAVEL: f64 = 0.05;

/// The step to take from here on (s). Small changes are left alone, so that leapfrog keeps its even step.
///
/// # Errors
/// When nothing is stiff and the scene fixes no step.
pub fn choose(view: &StepView) -> Result<f64> {
    let (time, now) = (&view.spec.time, view.time_step);
    if let Some(step) = time.step {
        return Ok(step);
    }
    let stiff = (time.safety * view.bound.step).min(impact_step(view));
    let wanted = if view.bonds.is_some() && stiff.is_finite() { stiff } else { stiff.min(flight_step(view)) };
    let wanted = wanted.min(travel_step(view));
    if !wanted.is_finite() && now == 0.0 {
        return Err(Error::input(
            "nothing in this scene is stiff, so there is no bound on the time step",
            "state time.step, e.g. step = \"1e-7 s\", or stop.time",
        ));
    }
    // What is foreseen at one step may not hold for a much longer one.
    let wanted = if now > 0.0 { wanted.min(GROWTH * now) } else { wanted * start(view) };
    let changes = wanted.is_finite() && (now == 0.0 || (wanted / now - 1.0).abs() > 0.01);
    Ok(if changes { wanted } else { now })
}

/// What limits the step.
pub fn limit(view: &StepView) -> StepLimit {
    let (bound, time) = (view.bound, &view.spec.time);
    let stiff = time.safety * bound.step;
    if time.step.is_some() {
        StepLimit::Scene { bound_s: Some(bound.step).filter(|bound| bound.is_finite()) }
    } else if travel_step(view) < stiff.min(impact_step(view)) {
        StepLimit::Travel { share_of_radius: TRAVEL }
    } else if impact_step(view) < stiff {
        StepLimit::Impact { steps: IMPACT_STEPS }
    } else if !bound.step.is_finite() {
        StepLimit::None
    } else {
        StepLimit::Stiffness {
            mode: bound.mode,
            element: bound.element(),
            body: view.body(bound.particle),
            bound_s: bound.step,
            safety: time.safety,
        }
    }
}

/// Share of the step that the first steps take (-): bodies that overlap from the start are thrown apart in a few
/// steps, and with full ones the energy of that is off by per cents.
fn start(view: &StepView) -> f64 {
    let much = THROWN * negligible_energy(view.spec, view.assembly);
    let pressed = view.contacts.is_some_and(|contacts| contacts.elastic_energy(view.state) > much);
    if pressed { START } else { 1.0 }
}

/// Free flight: nothing limits the step but how finely the scene wants to be seen (s).
fn flight_step(view: &StepView) -> f64 {
    view.spec.stop.time.map_or(f64::INFINITY, |time| time / FLIGHT_STEPS)
}

/// The step in which the fastest particle or rigid body moves by [`TRAVEL`] of the least radius (s); infinite at rest.
fn travel_step(view: &StepView) -> f64 {
    TRAVEL * view.assembly.least_radius() / view.fastest().max(fastest_rigid(view))
}

/// Greatest speed of a rigid body from now on (m/s).
fn fastest_rigid(view: &StepView) -> f64 {
    view.rigid.map_or(0.0, |rigid| rigid.fastest(view.state.time))
}

/// A share of the shortest impact of a free sphere (s): nothing is stiff before two bodies meet, so the bound comes
/// too late for them, and an impact of a few steps, though stable, has the wrong outcome.
///
/// Contact time 2.868 (m*²/(R*E*²v))^(1/5) (Hertz), m* against an equal sphere, R* against a flat one, twice the
/// greatest speed. That of a rigid body is no shorter: its m* is twice as great, and E* no more than that.
fn impact_step(view: &StepView) -> f64 {
    let spheres = view.assembly.wire_particles..view.assembly.len();
    if view.contacts.is_none() && view.rigid.is_none() || spheres.is_empty() {
        return f64::INFINITY;
    }
    let fastest = view.fastest();
    let speed = (2.0 * fastest).max(fastest + fastest_rigid(view));
    let impact = |p: usize| {
        let Material { young, poisson, .. } = *view.spec.material_at(view.assembly.material_of(p)).material;
        let modulus = effective_modulus(young, poisson, young, poisson);
        let mass = 0.5 * view.state.mass[p];
        2.868 * (mass * mass / (view.state.radius[p] * modulus * modulus * speed)).powf(0.2)
    };
    spheres.map(impact).fold(f64::INFINITY, f64::min) / IMPACT_STEPS
}
