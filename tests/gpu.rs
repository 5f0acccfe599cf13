//! Recorded laws on the graphics adapter that there is, against the laws with `f64`.
//!
//! The error of an output is its difference from the law's own, over the largest of the law's own results for that output in
//! the same batch of arguments.

#[path = "common/laws.rs"]
mod laws;

use strandsnap::base::error::Error;
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

/// Largest error that is allowed, by output: what is found from a small difference of large numbers loses digits.
fn allowed(_function: &str, _output: &str) -> f64 {
    1e-12
}

#[test]
fn recorded_laws_agree_with_the_laws_on_the_adapter() {
    let Some(device) = device("recorded_laws_agree_with_the_laws_on_the_adapter") else { return };
    println!("{} ({})", device.adapter.name, device.adapter.driver);
    let mut wrong = Vec::new();
    for case in laws::cases() {
        let kernel = Kernel::new(&device, &case.function).unwrap();
        let mut worst = (0.0, String::new());
        for batch in &case.batches {
            let found = kernel.run(&columns(&batch.rows)).unwrap();
            let expected = columns(&batch.expected);
            let rows = batch.rows.len();
            for (k, output) in case.function.outputs().enumerate() {
                let (found, expected) = (&found[k * rows..][..rows], &expected[k * rows..][..rows]);
                let scale = expected.iter().fold(0.0f64, |most, x| most.max(x.abs()));
                let error = |(a, b): (&f64, &f64)| match (a - b).abs() {
                    _ if a == b || (a.is_nan() && b.is_nan()) => 0.0,
                    difference if difference.is_nan() => f64::INFINITY,
                    difference => difference / scale,
                };
                let most = found.iter().zip(expected).map(error).fold(0.0f64, f64::max);
                let place = format!("{} {}: {output} is {most:.1e} off", case.function.name(), batch.name);
                if most > worst.0 {
                    worst = (most, place.clone());
                }
                if most > allowed(case.function.name(), output) {
                    wrong.push(place);
                }
            }
        }
        println!("{:28} {:5} operations, worst: {}", case.function.name(), case.function.operations(), worst.1);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
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
