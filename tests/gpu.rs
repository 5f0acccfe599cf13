//! Recorded laws on the graphics adapter that there is, against the laws with `f64`; whole steps in `gpu/steps.rs`,
//! runs in `gpu/runs.rs`.
//!
//! Results may differ from the law's own by rounding: by 1e-13 of the largest result for that output among arguments of one
//! batch, and by some times what the law's own result changes by when its arguments change in their last bits. (A steep law
//! on a step of tens of elastic strains amplifies that much.)

#[path = "common/drive.rs"]
mod drive;
#[path = "common/laws.rs"]
mod laws;
#[path = "gpu/runs.rs"]
mod runs;
#[path = "gpu/steps.rs"]
mod steps;

use laws::Batch;
use strandsnap::base::error::Error;
use strandsnap::base::lanes::Real;
use strandsnap::base::random::uniform;
use strandsnap::base::recorder::{Formula, Function};
use strandsnap::gpu::{Device, Kernel, adapters};

fn device(test: &str) -> Option<Device> {
    match Device::open() {
        Ok(device) => Some(device),
        Err(Error::Missing { what, .. }) if adapters().iter().all(|adapter| !adapter.f64) => {
            println!("SKIPPED ({test}: {what})");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Columns below each other, from rows.
fn columns(rows: &[Vec<f64>]) -> Vec<f64> {
    (0..rows[0].len()).flat_map(|k| rows.iter().map(move |row| row[k])).collect()
}

/// How far a result may be off, in changes of the law's own result for other last bits of the arguments.
const CHANGES: f64 = 100.0;
/// And beside that, over the largest result of a batch.
const SHARE: f64 = 1e-13;

/// How much each result of a batch changes with the last bits of the arguments, row by row.
fn changes(function: &Function, batch: &Batch) -> Vec<Vec<f64>> {
    let other = |row: &Vec<f64>, variant: u64| -> Vec<f64> {
        let sign = |k: usize| if uniform(variant, k as u64, 0) < 0.5 { 1.0 } else { -1.0 };
        row.iter().enumerate().map(|(k, x)| x * (1.0 + sign(k) * f64::EPSILON)).collect()
    };
    let of = |(row, expected): (&Vec<f64>, &Vec<f64>)| {
        let variants = [1, 2, 3].map(|variant| function.evaluate(&other(row, variant)));
        let change = |k: usize| variants.iter().map(|other| (other[k] - expected[k]).abs()).fold(0.0, f64::max);
        (0..expected.len()).map(change).collect()
    };
    batch.rows.iter().zip(&batch.expected).map(of).collect()
}

#[test]
fn recorded_laws_agree_with_the_laws_on_the_adapter() {
    let Some(device) = device("recorded_laws_agree_with_the_laws_on_the_adapter") else { return };
    println!("{} ({})", device.adapter.name, device.adapter.driver);
    let mut wrong = Vec::new();
    for case in laws::cases() {
        let function = &case.function;
        let kernel = Kernel::new(&device, function).unwrap();
        for batch in &case.batches {
            let found = kernel.run(&columns(&batch.rows)).unwrap();
            let (expected, change) = (columns(&batch.expected), columns(&changes(function, batch)));
            let rows = batch.rows.len();
            let mut worst = (0.0, 0.0, "");
            for (k, output) in function.outputs().enumerate() {
                let at = k * rows..(k + 1) * rows;
                let largest = expected[at.clone()].iter().fold(0.0f64, |most, x| most.max(x.abs()));
                for row in at {
                    let difference = (found[row] - expected[row]).abs();
                    let same = found[row] == expected[row] || (found[row].is_nan() && expected[row].is_nan());
                    let allowed = SHARE * largest + CHANGES * change[row];
                    if !same && (difference.is_nan() || difference / allowed > worst.0) {
                        worst = (difference / allowed, difference / largest, output);
                    }
                }
            }
            let (of_allowed, of_largest, output) = worst;
            let line = format!(
                "{:26} {:9} worst in {output}: {of_allowed:.2} of what is allowed, {of_largest:.1e} of the largest",
                function.name(),
                batch.name
            );
            println!("{line}");
            if of_allowed.is_nan() || of_allowed > 1.0 {
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The functions that laws are made of, and constants that no literal can hold.
struct Parts;

impl Formula for Parts {
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
        let (x, y) = (take("x"), take("y"));
        put("ln", x.ln());
        put("exp", y.exp());
        put("power", x.powf(0.31));
        put("inverse", x.inverse());
        put("inverse_sqrt", x.inverse_sqrt());
        put("root", x.sqrt());
        put("whole", (x.ln() * 7.0).round_ties_even());
        let [[_, low], [_, high]] = x.rows_around(&[[0.0, 1.5], [1e-3, -2.5], [1.0, 3.0], [1e3, f64::MAX]]);
        put("below", low);
        put("above", high);
        let one = x.splat(1.0);
        for (name, value) in [("infinite", f64::INFINITY), ("least", f64::NEG_INFINITY), ("third", 1.0 / 3.0)] {
            put(name, R::select(x.simd_gt(one), x.splat(value), one));
        }
    }
}

#[test]
fn functions_and_constants_agree_over_the_whole_range_of_numbers() {
    let Some(device) = device("functions_and_constants_agree_over_the_whole_range_of_numbers") else { return };
    let function = Function::record("parts", &Parts).unwrap();
    let rows: Vec<Vec<f64>> =
        (-2990..=2990).map(f64::from).map(|k| vec![10f64.powf(0.1 * k), 0.25 * k + 1e-5 * k * k]).collect();
    let found = Kernel::new(&device, &function).unwrap().run(&columns(&rows)).unwrap();
    for (k, row) in rows.iter().enumerate() {
        for (column, (output, expected)) in function.outputs().zip(Parts.evaluate(row)).enumerate() {
            let found = found[column * rows.len() + k];
            let off = (found / expected - 1.0).abs();
            // A power has the rounding of its logarithm.
            let allowed = 4e-15 + if output == "power" { 1e-16 * row[0].ln().abs() } else { 0.0 };
            assert!(found == expected || off <= allowed, "{output} of {row:?}: {found:e}, not {expected:e}");
        }
    }
}

#[test]
fn the_same_bits_come_from_call_to_call() {
    let Some(device) = device("the_same_bits_come_from_call_to_call") else { return };
    let case = laws::cases().pop().unwrap();
    let inputs = columns(&case.batches[0].rows);
    let bits = || -> Vec<u64> {
        let kernel = Kernel::new(&device, &case.function).unwrap();
        kernel.run(&inputs).unwrap().into_iter().map(f64::to_bits).collect()
    };
    assert_eq!(bits(), bits());
}

#[test]
fn what_is_no_whole_column_is_refused() {
    let Some(device) = device("what_is_no_whole_column_is_refused") else { return };
    let case = laws::cases().pop().unwrap();
    let kernel = Kernel::new(&device, &case.function).unwrap();
    let inputs = case.function.inputs().len();
    for count in [0, inputs - 1, inputs + 1] {
        assert!(matches!(kernel.run(&vec![1.0; count]), Err(Error::Input { .. })), "{count} numbers");
    }
    assert_eq!(kernel.run(&vec![1.0; inputs]).unwrap().len(), case.function.outputs().len());
}
