//! Every law that can be recorded has, when what was recorded is done on the processor, the bits of the law itself.

#[path = "common/drive.rs"]
mod drive;
#[path = "common/laws.rs"]
mod laws;

use drive::{assembly, run_steps};
use std::collections::HashMap;
use strandsnap::base::recorder::{Function, Unrecordable};
use strandsnap::engine::Engine;
use strandsnap::engine::contact::formula::ContactStep;
use strandsnap::engine::contact::pair::Laws;
use strandsnap::engine::elsewhere::StepFunctions;
use strandsnap::law::contact::hertz::Hertz;
use strandsnap::law::tangential::mindlin_deresiewicz::MindlinDeresiewicz;
use strandsnap::scene;

#[test]
fn recorded_laws_have_the_bits_of_the_laws() {
    let mut yielded = 0;
    for case in laws::cases() {
        let function = &case.function;
        println!("{}: {} operations", function.name(), function.operations());
        let work = function.outputs().position(|name| name.starts_with("plastic"));
        for batch in &case.batches {
            for (row, expected) in batch.rows.iter().zip(&batch.expected) {
                let found = function.evaluate(row);
                let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                assert_eq!(
                    bits(&found),
                    bits(expected),
                    "{} {}: {found:?}, not {expected:?}",
                    function.name(),
                    batch.name
                );
                yielded += usize::from(work.is_some_and(|work| expected[work] != 0.0));
            }
        }
    }
    assert!(yielded > 5_000, "{yielded} steps with plastic work");
}

/// Checked without an adapter, as `wgpu` checks it.
#[test]
fn recorded_laws_are_shader_code() {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    for case in laws::cases() {
        let (name, text) = (case.function.name(), case.function.wgsl());
        let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{name}: {e}\n{text}"));
        let able = Capabilities::FLOAT64 | Capabilities::SHADER_INT64;
        Validator::new(ValidationFlags::all(), able).validate(&module).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        assert!(!text.contains("inf") && !text.contains("NaN"), "{name}:\n{text}");
    }
}

/// Its branches differ from contact to contact, and it asks for cube roots: it works on one contact at a time.
#[test]
fn partial_slip_cannot_be_recorded() {
    let tangential = MindlinDeresiewicz { shear_modulus_star: 13e9, friction: 0.2 };
    let laws = Laws { normal: Hertz { effective_modulus: 65e9 }, tangential, damping: 0.0 };
    assert_eq!(Function::record("partial_slip", &ContactStep(laws)).unwrap_err(), Unrecordable::Value);
}

/// Steps of an engine by its recorded functions: a column of numbers for each name.
struct Columns {
    functions: Vec<Function>,
    columns: HashMap<String, Vec<f64>>,
    particles: usize,
}

impl Columns {
    fn of(engine: &Engine) -> Self {
        let StepFunctions { particles: mut functions, gather, .. } = engine.record_step().unwrap();
        functions.push(gather);
        let particles = engine.state().len();
        let of_step = engine.step_names();
        let taken = functions.iter().flat_map(|f| f.inputs()).filter(|name| !of_step.contains(name));
        let column = |name: &str| (name.to_owned(), engine.numbers(name).unwrap_or_else(|| vec![0.0; particles]));
        let columns = taken.map(|name| column(side(name).0)).collect();
        Self { functions, columns, particles }
    }

    fn step(&mut self, of_step: &HashMap<String, f64>) {
        for function in &self.functions {
            let input = |name: &String, p: usize| match (of_step.get(name), side(name)) {
                (Some(number), _) => *number,
                (None, (_, -1)) if p == 0 => 0.0,
                (None, (column, shift)) => {
                    let at = p.saturating_add_signed(shift).min(self.particles - 1);
                    self.columns[column][at]
                }
            };
            let of_particle =
                |p| function.evaluate(&function.inputs().iter().map(|name| input(name, p)).collect::<Vec<_>>());
            let results: Vec<Vec<f64>> = (0..self.particles).map(of_particle).collect();
            for (k, name) in function.outputs().enumerate() {
                self.columns.insert(name.to_owned(), results.iter().map(|result| result[k]).collect());
            }
        }
    }
}

/// The column of an input, and which neighbour's it is.
fn side(input: &str) -> (&str, isize) {
    let sides = [("near_", 0), ("here_", 0), ("far_", 1), ("before_", -1)];
    sides.iter().find_map(|(prefix, shift)| Some((input.strip_prefix(prefix)?, *shift))).unwrap_or((input, 0))
}

/// Whatever an engine does to its particles in a step is in the functions that it gives.
#[test]
fn recorded_steps_have_the_bits_of_the_engine() {
    let jaw = ["grip.kind=jaw", "grip.clamp_pressure=20 MPa", "grip.length=2 mm", "grip.speed=2 m/s"];
    let adaptive = [
        "grip.adaptive={ from = \"0.01 %\", fastest = \"20 m/s\", kinetic = \"100 %\", passages = 1 }",
        "wire.0.to=[\"0 mm\", \"0 mm\", \"60 mm\"]",
    ];
    for (name, set) in [
        ("single-wire", &adaptive[..]),
        ("single-wire", &["wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]", "grip.speed=20 m/s"][..]),
        ("cantilever", &[]),
        ("torsion", &["grip.speed=3 m/s", "grip.rotation_rate=9000 rad/s"]),
        ("torsion", &jaw),
    ] {
        let set: Vec<String> = set.iter().map(|option| option.to_string()).collect();
        let scene = scene::load(name, &set).unwrap_or_else(|error| panic!("{name} {set:?}: {error:?}"));
        let mut engine = Engine::new(&scene.spec, &scene.plan, assembly(&scene.spec)).unwrap();
        // Until something yields.
        run_steps(&mut engine, 128);
        let mut columns = Columns::of(&engine);
        let block = engine.plan_block(|_| false).unwrap();
        let changes = block.steps.iter().flatten().any(|(name, number)| name == "speed_change" && *number != 0.0);
        assert_eq!(changes, set.iter().any(|option| option.contains("adaptive")), "{name} {set:?}");
        for step in block.steps {
            columns.step(&step.into_iter().collect());
        }
        run_steps(&mut engine, 64);
        let given = columns.functions.iter().flat_map(|f| f.outputs());
        // Energies are added up in another order; what is measured or a signal is no state.
        let kept = given
            .filter(|name| !["plastic_work", "damping_work"].contains(name))
            .filter(|name| engine.numbers(name).is_some());
        let kept: Vec<&str> = kept.collect();
        assert!(kept.len() > 10, "{kept:?}");
        for number in kept {
            let expected = engine.numbers(number).unwrap();
            let other = |p: &usize| (columns.columns[number][*p] + 0.0).to_bits() != (expected[*p] + 0.0).to_bits();
            let first = (0..columns.particles).find(other);
            assert_eq!(first, None, "{name} {set:?}: first particle with another {number}");
        }
    }
}
