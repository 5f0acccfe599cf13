use super::*;
use crate::base::finding::Body;
use crate::engine::grips::Holds;
use crate::engine::measure::Measures;
use crate::engine::state::State;
use crate::engine::team::Team;
use crate::engine::time_step::Bound;
use crate::engine::view::Energy;
use crate::scene::plan::Plan;
use crate::strand::discretise;
use std::path::Path;

/// A wire of 20 mm between two grips, without an engine.
struct Bench {
    spec: Spec,
    plan: Plan,
    assembly: Assembly,
    state: State,
    holds: Holds,
    measures: Measures,
    bound: Bound,
    ledger: Energy,
    time_step: f64,
    team: Team,
}

impl Bench {
    fn new(bond: &str) -> Self {
        let text = format!(
            r#"about = "A wire."
            wire = [{{ diameter = "1 mm", from = ["0 mm", "0 mm", "0 mm"], to = ["0 mm", "0 mm", "20 mm"] }}]
            grip = {{ length = "2 mm", speed = "5 m/s" }}
            stop = {{ strain = "20 %" }}
            [contact]
            normal = "hertz"
            [bond]
            {bond}"#
        );
        let spec = crate::scene::parse(&text, "wire.toml", Path::new("."), &[]).unwrap().spec;
        let plan = Plan::new(&spec);
        let assembly = discretise::build(&spec).unwrap_or_else(|e| panic!("{}", e.message));
        let mut state = State::new(&assembly, plan.rotations);
        let holds = Holds::new(&spec, &assembly, &mut state).unwrap();
        let measures = Measures::new(&spec, &assembly, &holds);
        let (bound, ledger) = (Bound::default(), Energy::default());
        Self { spec, plan, assembly, state, holds, measures, bound, ledger, time_step: 1e-8, team: Team::alone() }
    }

    fn view(&self) -> StepView<'_> {
        StepView {
            spec: &self.spec,
            plan: &self.plan,
            assembly: &self.assembly,
            state: &self.state,
            team: &self.team,
            bonds: None,
            contacts: None,
            neighbours: None,
            rigid: None,
            holds: &self.holds,
            measures: &self.measures,
            ledger: &self.ledger,
            ruptures: 0,
            bound: &self.bound,
            time_step: self.time_step,
        }
    }
}

fn contact(ratio: f64) -> Deepest {
    Deepest { ratio, pair: [3, 4], force: 2.0, area: 1e-8 }
}

#[test]
fn a_deep_contact_is_said_once_and_the_deepest_is_kept() {
    let bench = Bench::new(r#"law = "elastic""#);
    let mut monitor = Monitor::new(&bench.spec, &bench.assembly);
    for ratio in [0.05, 0.2, 0.3] {
        assert!(monitor.is_deepest(&contact(ratio)));
        monitor.look_at_contact(contact(ratio), &bench.view());
    }
    assert!(!monitor.is_deepest(&contact(0.3)) && !monitor.is_deepest(&contact(0.1)));
    let notices = monitor.take_notices();
    assert!(
        matches!(&notices[..], [Notice { finding: Finding::DeepContact { overlap_over_radius, .. }, .. }]
            if *overlap_over_radius == 0.2),
        "{notices:?}"
    );
    let deepest = monitor.findings(&bench.view()).deepest.unwrap();
    assert_eq!((deepest.ratio, deepest.pressure), (0.3, 2e8));
    assert!(deepest.bodies.iter().all(|body| matches!(body, Body::Wire { wire: 1, .. })));
}

#[test]
fn a_fixed_step_beyond_the_bound_is_unstable() {
    let mut bench = Bench::new(r#"law = "elastic""#);
    bench.bound.step = 2e-8;
    let mut monitor = Monitor::default();
    bench.spec.time.step = Some(2e-8);
    monitor.look_at_step(&bench.view());
    assert_eq!(monitor.take_notices(), [], "just stable");
    bench.spec.time.step = Some(2.1e-8);
    monitor.look_at_step(&bench.view());
    let notices = monitor.take_notices();
    assert!(matches!(notices[..], [Notice { finding: Finding::UnstableStep { .. }, .. }]), "{notices:?}");
}

#[test]
fn the_least_and_the_greatest_step_are_kept_with_their_time() {
    let mut bench = Bench::new(r#"law = "elastic""#);
    let mut monitor = Monitor::default();
    for (step, time_step) in [(0, 3e-8), (64, 1e-8), (128, 5e-8), (192, 2e-8)] {
        (bench.state.step, bench.time_step) = (step, time_step);
        monitor.look_at_step(&bench.view());
    }
    let found = monitor.findings(&bench.view());
    assert_eq!((found.least_step.step, found.least_step.seconds), (64, 1e-8));
    assert_eq!((found.greatest_step.step, found.greatest_step.seconds), (128, 5e-8));
}

#[test]
fn without_bonds_or_an_adaptive_pull_nothing_is_to_do() {
    let bench = Bench::new(r#"law = "elastic""#);
    assert!(Monitor::default().look(&bench.view()).is_empty());
}

#[test]
fn the_particle_that_moved_furthest_ran_away() {
    let mut bench = Bench::new(r#"law = "elastic""#);
    bench.state.dt = 1e-6;
    bench.state.v.set(7, glam::DVec3::X * 1e3);
    let Failure::Runaway { particle, moved_m, limit_m, .. } = ran_away(&bench.view(), 0.1) else { panic!() };
    assert_eq!(particle.number, Some(8));
    assert!((moved_m.unwrap() - 1e-3).abs() < 1e-15 && (limit_m - 5e-5).abs() < 1e-18);
    bench.state.v.set(5, glam::DVec3::splat(f64::NAN));
    let Failure::Runaway { particle, moved_m, .. } = ran_away(&bench.view(), 0.1) else { panic!() };
    assert_eq!((particle.number, moved_m), (Some(6), None), "what is no number is furthest");
}
