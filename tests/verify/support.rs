//! What all cases share: scenes, engines, averages, orders of convergence, the ledger.

use std::path::{Path, PathBuf};
use strandsnap::base::error::Error;
use strandsnap::engine::Engine;
use strandsnap::reference::beam::RoundBar;
use strandsnap::scene::{self, spec::Spec};
use strandsnap::strand;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes/verify")
}

/// Names of all scenes of this kind.
pub fn scene_names() -> Vec<String> {
    let entries = std::fs::read_dir(folder()).expect("the scenes are part of the sources");
    let mut names: Vec<String> =
        entries.map(|e| e.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The scene of this name with `key=value` options.
pub fn spec(name: &str, options: &[String]) -> Spec {
    let path = folder().join(format!("{name}.toml"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    scene::parse(&text, name, &folder(), options).unwrap_or_else(|error| panic!("{error:?}")).spec
}

/// A case ready for its first step.
pub struct Case {
    pub spec: Spec,
    pub engine: Engine,
}

/// The scene of this name with `key=value` options, set up.
pub fn case(name: &str, options: &[String]) -> Case {
    set_up(spec(name, options))
}

/// A scene that comes with the program, set up.
pub fn builtin(name: &str) -> Case {
    set_up(scene::load(name, &[]).unwrap_or_else(|error| panic!("{error:?}")).spec)
}

fn set_up(spec: Spec) -> Case {
    let name = spec.name.clone();
    let assembly = strand::build(&spec).unwrap_or_else(|error| panic!("{name}: {error:?}"));
    let engine = Engine::new(&spec, assembly).unwrap_or_else(|error| panic!("{name}: {error:?}"));
    Case { spec, engine }
}

impl Case {
    /// The first wire as a bar of beam theory.
    pub fn bar(&self) -> RoundBar {
        let (a, m) = (self.engine.assembly(), &self.spec.material);
        RoundBar {
            length: a.rest_length[a.wires[0].bonds()].iter().sum(),
            diameter: a.wires[0].diameter,
            young: m.young,
            poisson: m.poisson,
            density: m.density,
        }
    }

    /// Steps until `time` [s], calling `each` after every step.
    pub fn run_to(&mut self, time: f64, mut each: impl FnMut(&Engine)) {
        while self.engine.time() < time {
            self.engine.step().unwrap_or_else(|error| panic!("{error:?}"));
            each(&self.engine);
        }
    }

    /// Steps to the scene's own end.
    pub fn run(&mut self, mut each: impl FnMut(&Engine)) {
        let stop = self.spec.stop.clone();
        let reached = |limit: Option<f64>, value: f64| limit.is_some_and(|limit| value >= limit);
        while !reached(stop.time, self.engine.time())
            && !reached(stop.strain, self.engine.strain())
            && stop.steps.is_none_or(|steps| self.engine.steps() < steps)
        {
            self.engine.step().unwrap_or_else(|error| panic!("{error:?}"));
            each(&self.engine);
        }
    }

    /// Mean over `from..to` [s] under a Hann window, which takes out the swing that is left after a smooth ramp.
    pub fn settled(&mut self, from: f64, to: f64, mut value: impl FnMut(&Engine) -> f64) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        self.run_to(to, |engine| {
            let now = value(engine);
            let phase = (engine.time() - from) / (to - from);
            if (0.0..=1.0).contains(&phase) {
                let weight = (std::f64::consts::PI * phase).sin().powi(2) * engine.time_step();
                sum += weight * now;
                weights += weight;
            }
        });
        sum / weights
    }

    /// The ledger closes to 0.1 % of the work done.
    pub fn check_ledger(&self) {
        let energy = self.engine.energy();
        let scale = energy.work.abs().max(energy.internal());
        let residual = energy.residual().abs() / scale;
        assert!(residual < 1e-3, "{}: the ledger misses {residual:.2e} of the work: {energy:?}", self.spec.name);
    }
}

/// Whether a case with a fixed step stays within bounds over `steps` steps.
pub fn stays(case: &mut Case, steps: usize) -> bool {
    for _ in 0..steps {
        match case.engine.step() {
            Ok(()) => {}
            Err(Error::Trouble { .. }) => return false,
            Err(other) => panic!("{other:?}"),
        }
    }
    true
}

/// Runs `work` on one thread: cases are small, and sharing them out would only cost.
pub fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(work)
}

/// An option `key=value`.
pub fn set(key: &str, value: impl std::fmt::Display) -> String {
    format!("{key}={value}")
}

/// Asserts `value` within `tolerance` of `expected`, relative.
pub fn near(what: &str, value: f64, expected: f64, tolerance: f64) {
    let error = value / expected - 1.0;
    println!("{what}: {value:.9e}, exact {expected:.9e}, error {error:+.2e}");
    assert!(error.abs() <= tolerance, "{what}: {value:e} is {error:+.2e} from {expected:e}, more than {tolerance:.0e}");
}

/// Orders of convergence between neighbours of a sequence of errors, each from half the spacing of the one before.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0].abs() / e[1].abs()).log2()).collect()
}

/// Asserts that a sequence of errors falls with `order`.
pub fn converges(what: &str, errors: &[f64], order: f64, tolerance: f64) {
    let observed = orders(errors);
    println!("{what}: errors {errors:?}, orders {observed:?}");
    for p in observed {
        assert!((p - order).abs() <= tolerance, "{what}: order {p:.3} instead of {order} (errors {errors:?})");
    }
}

/// Angular frequency of a signal from its rising zero crossings.
#[derive(Default)]
pub struct Crossings {
    last: Option<[f64; 2]>,
    times: Vec<f64>,
}

impl Crossings {
    pub fn add(&mut self, time: f64, value: f64) {
        if let Some([t0, v0]) = self.last
            && v0 < 0.0
            && value >= 0.0
        {
            self.times.push(t0 + (time - t0) * v0 / (v0 - value));
        }
        self.last = Some([time, value]);
    }

    /// [rad/s]
    pub fn frequency(&self) -> f64 {
        let n = self.times.len();
        assert!(n > 2, "only {n} crossings");
        std::f64::consts::TAU * (n - 1) as f64 / (self.times[n - 1] - self.times[0])
    }
}
