use super::*;
use crate::strand::discretise;
use std::path::Path;

/// Tolerance of sums over the particles of a grip (-).
const ROUNDING: f64 = 1e-12;

fn wire(keys: &str) -> (Spec, Assembly) {
    let text = format!(
        r#"about = "A wire."
        wire = [{{ diameter = "1 mm", from = ["0 mm", "0 mm", "0 mm"], to = ["0 mm", "0 mm", "20 mm"] }}]
        {keys}
        [bond]
        law = "elastic""#
    );
    let spec = crate::scene::parse(&text, "wire.toml", Path::new("."), &[]).unwrap().spec;
    let assembly = discretise::build(&spec).unwrap_or_else(|e| panic!("{}", e.message));
    (spec, assembly)
}

fn holds(keys: &str) -> (Holds, State) {
    let (spec, assembly) = wire(keys);
    let mut state = State::new(&assembly, true);
    (Holds::new(&spec, &assembly, &mut state).unwrap(), state)
}

const PULL: &str = r#"grip = { length = "2 mm", speed = "5 m/s" }
        stop = { strain = "20 %" }"#;

#[test]
fn a_pull_starts_in_its_affine_velocity_field() {
    let (holds, state) = holds(PULL);
    for p in 0..state.len() {
        let share = ((state.x.z[p] - 2e-3) / 16e-3).clamp(0.0, 1.0);
        assert!((state.v.z[p] - 5.0 * share).abs() < ROUNDING, "particle {p}: {} m/s", state.v.z[p]);
    }
    let kinetic: f64 = (0..state.len()).map(|p| 0.5 * state.mass[p] * state.v.z[p].powi(2)).sum();
    assert!((holds.work / kinetic - 1.0).abs() < ROUNDING, "its energy is booked as work");
    assert_eq!(holds.speed(), 5.0);
}

#[test]
fn a_grip_reacts_to_what_pulls_at_it_and_does_the_work_of_it() {
    let (mut holds, mut state) = holds(PULL);
    let before = holds.work;
    let (dt, force) = (1e-7, 3.0);
    state.dt = dt;
    // The particle of the upper grip that is nearest to the gauge is pulled down, that of the lower grip up.
    let upper = (0..state.len()).find(|p| state.hold[*p] == 2).unwrap();
    let lower = (0..state.len()).rfind(|p| state.hold[*p] == 1).unwrap();
    for (p, pull) in [(upper, -force), (lower, force)] {
        state.force.z[p] = pull;
        state.v.z[p] += pull * dt / state.mass[p];
    }
    holds.apply(&mut state, dt, Arch::new());
    for reaction in holds.reaction.force {
        assert!((reaction / force - 1.0).abs() < 1e-9, "{reaction} N instead of {force} N in tension");
    }
    assert!(holds.reaction.torque.abs() < 1e-15);
    assert!(((holds.work - before) / (force * 5.0 * dt) - 1.0).abs() < 1e-6, "{} J", holds.work - before);
    assert!((state.v.z[upper] - 5.0).abs() < ROUNDING && state.v.z[lower] == 0.0);
    assert!((holds.stretch.displacement - 5.0 * dt).abs() < 1e-18);
}

#[test]
fn strain_is_displacement_over_the_free_length_of_the_particles() {
    let (mut holds, mut state) = holds(PULL);
    state.dt = 1e-6;
    (0..100).for_each(|_| holds.apply(&mut state, 1e-6, Arch::new()));
    let held = |grip: u16| state.hold.iter().zip(&state.x.z).filter(move |(hold, _)| **hold == grip).map(|(_, z)| *z);
    let (upper, lower) = (held(2).fold(f64::MAX, f64::min), held(1).fold(f64::MIN, f64::max));
    assert!((holds.strain() * (upper - lower) / 5e-4 - 1.0).abs() < 1e-9, "{}", holds.strain());
}

#[test]
fn a_cyclic_drive_follows_its_sine() {
    let (mut holds, mut state) = holds(
        r#"grip = { length = "2 mm", amplitude = "0.1 mm", frequency = "1000 Hz" }
        stop = { time = "1 ms" }"#,
    );
    state.dt = 1e-6;
    for step in 1..=300 {
        holds.apply(&mut state, 1e-6, Arch::new());
        state.time += 1e-6;
        let expected = 1e-4 * (TAU * 1e3 * f64::from(step) * 1e-6).sin();
        assert!((holds.stretch.displacement - expected).abs() < 1e-15);
    }
    assert_eq!(holds.speed(), 0.0, "no steady pull");
}

#[test]
fn a_load_rises_smoothly_to_its_value_and_leaves_free_components_alone() {
    let (mut holds, mut state) = holds(
        r#"hold = [{ body = 1, part = "end", force = ["0 N", "0 N", "2 N"], ramp = "1 ms" }]
        stop = { time = "1 ms" }"#,
    );
    let last = state.len() - 1;
    for (time, share) in [(0.0, 0.0), (5e-4, 0.5), (1e-3, 1.0), (2e-3, 1.0)] {
        let loads = holds.loads(time);
        assert_eq!(loads.keys().copied().collect::<Vec<_>>(), [last]);
        assert!((loads[&last][0].z - 2.0 * share).abs() < ROUNDING, "at {time} s");
    }
    (state.dt, state.time) = (1e-8, 1e-3);
    holds.apply(&mut state, 1e-8, Arch::new());
    assert!((state.v.z[last] - 2.0 * 1e-8 / state.mass[last]).abs() < ROUNDING);
    assert_eq!((state.v.z[0], state.fixed[last]), (0.0, 0));
}

#[test]
fn a_smooth_rise_has_no_slope_at_its_ends() {
    assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0].map(smooth), [0.0, 0.0, 0.5, 1.0, 1.0]);
    assert!(smooth(1e-4) < 1e-7 && 1.0 - smooth(1.0 - 1e-4) < 1e-7);
}
