//! Every law that can be recorded has, when what was recorded is done on the processor, the bits of the law itself.

#[path = "common/laws.rs"]
mod laws;

use strandsnap::base::recorder::{Function, Unrecordable};
use strandsnap::engine::contact::formula::ContactStep;
use strandsnap::engine::contact::pair::Laws;
use strandsnap::law::contact::hertz::Hertz;
use strandsnap::law::tangential::mindlin_deresiewicz::MindlinDeresiewicz;

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
