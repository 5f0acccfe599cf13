//! Engines for tests: scenes from text, run without files and observers.

#![allow(dead_code, reason = "each test binary uses its own part")]

use glam::DVec3;
use std::path::Path;
use strandsnap::engine::Engine;
use strandsnap::engine::state::State;
use strandsnap::engine::view::Rupture;
use strandsnap::scene::plan::Plan;
use strandsnap::scene::spec::Spec;
use strandsnap::strand::assembly::Assembly;

/// A straight core and six wires around it, pulled: yields, thins, rubs and breaks within a few thousand steps.
pub const STRAND: &str = r#"
about = "A small strand of seven wires, pulled until wires break."
seed = 1
[bond]
law = "elasto-plastic"
damping = 0.02
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "180 MPa", rate = 12, linear = "550 MPa" }
rupture = { criterion = "plastic-strain", strain = "3 %", weibull_modulus = 20 }
[contact]
normal = "thornton"
tangential = "mindlin"
friction = 0.2
shape = "sphere"
hardness_strain = "8 %"
damping = 0.1
[strand]
length = "12 mm"
wire_diameter = "0.39 mm"
[[strand.layer]]
name = "core"
wires = 1
pitch = "inf"
[[strand.layer]]
name = "outer"
wires = 6
pitch = "12 mm"
[grip]
length = "2 mm"
speed = "10 m/s"
[stop]
strain = "10 %"
"#;

/// The overrides that cut [`STRAND`] free.
pub const FREE: [&str; 3] = ["grip=", "stop.strain=", "stop.time=1 ms"];

/// Reads a scene; `set` are `--set` options.
pub fn spec(text: &str, set: &[&str]) -> Spec {
    let set: Vec<String> = set.iter().map(|s| s.to_string()).collect();
    match strandsnap::scene::parse(text, "test.toml", Path::new("."), &set) {
        Ok(scene) => scene.spec,
        Err(error) => panic!("{error:?}"),
    }
}

/// The assembly of a scene.
pub fn assembly(spec: &Spec) -> Assembly {
    strandsnap::strand::build(spec).unwrap_or_else(|error| panic!("{error:?}"))
}

/// An engine on the scene as it is.
pub fn engine(text: &str, set: &[&str]) -> Engine {
    edited(text, set, |_| {})
}

/// An engine on the scene with an assembly that the test changes first.
pub fn edited(text: &str, set: &[&str], edit: impl FnOnce(&mut Assembly)) -> Engine {
    let spec = spec(text, set);
    let mut assembly = assembly(&spec);
    edit(&mut assembly);
    Engine::new(&spec, &Plan::new(&spec), assembly).unwrap_or_else(|error| panic!("{error:?}"))
}

/// Steps until `done`.
pub fn run_while(engine: &mut Engine, mut go_on: impl FnMut(&Engine) -> bool) {
    while go_on(engine) {
        engine.step().unwrap_or_else(|error| panic!("{error:?}"));
    }
}

/// Takes `steps` steps.
pub fn run_steps(engine: &mut Engine, steps: u64) {
    let last = engine.steps() + steps;
    run_while(engine, |e| e.steps() < last);
}

/// Runs to a simulated time (s).
pub fn run_to(engine: &mut Engine, time: f64) {
    run_while(engine, |e| e.time() < time);
}

/// Everything that a step leaves behind, bit for bit, with zeros of either sign taken as one.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    pub position: Vec<DVec3>,
    pub velocity: Vec<DVec3>,
    pub spin: Vec<DVec3>,
    pub radius: Vec<f64>,
    pub whole: Vec<bool>,
    pub time: f64,
    pub energy: strandsnap::engine::view::Energy,
    pub ruptures: Vec<Rupture>,
}

impl Outcome {
    pub fn of(engine: &mut Engine) -> Self {
        let s = engine.state();
        Self {
            position: s.x.iter().collect(),
            velocity: s.v.iter().collect(),
            spin: s.w.iter().collect(),
            radius: s.radius.clone(),
            whole: s.whole.clone(),
            time: s.time,
            energy: engine.energy(),
            ruptures: engine.take_ruptures(),
        }
    }

    /// Asserts that positions, velocities and spins are the same, without printing them all.
    pub fn assert_same_motion(&self, other: &Self, what: &str) {
        let first = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).position(|(a, b)| a != b);
        assert_eq!(self.time, other.time, "{what}: time");
        assert_eq!(first(&self.position, &other.position), None, "{what}: first particle with another position");
        assert_eq!(first(&self.velocity, &other.velocity), None, "{what}: first particle with another velocity");
        assert_eq!(first(&self.spin, &other.spin), None, "{what}: first particle with another spin");
    }

    /// Asserts that two outcomes are one.
    pub fn assert_same(&self, other: &Self, what: &str) {
        self.assert_same_motion(other, what);
        assert!(self.radius == other.radius, "{what}: radii");
        assert_eq!(self.energy, other.energy, "{what}: energies");
        assert_eq!(self.ruptures, other.ruptures, "{what}: ruptures");
        assert!(self == other, "{what}");
    }
}

/// Greatest distance between particles of two outcomes (m).
pub fn distance(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// Σ m v (N s).
pub fn momentum(s: &State) -> DVec3 {
    (0..s.len()).map(|p| s.v.get(p) * s.mass[p]).sum()
}

/// Σ (x × m v + I ω) (N m s); x_n with v_{n−1/2}, for which leapfrog conserves it exactly.
pub fn angular_momentum(s: &State) -> DVec3 {
    (0..s.len()).map(|p| s.x.get(p).cross(s.v.get(p) * s.mass[p]) + s.w.get(p) * s.inertia[p]).sum()
}

/// Velocity field `field(position)` on top of what the assembly has.
pub fn add_velocity(a: &mut Assembly, field: impl Fn(DVec3) -> DVec3) {
    for p in 0..a.len() {
        let v = field(a.position.get(p));
        a.velocity.add(p, v);
    }
}

/// Centre of mass (m).
pub fn centre(a: &Assembly) -> DVec3 {
    let mass: f64 = a.mass.iter().sum();
    (0..a.len()).map(|p| a.position.get(p) * a.mass[p]).sum::<DVec3>() / mass
}
