//! A bond that breaks at the first step, beside no bond at all.

use super::case::VerificationCase;
use super::comparison::Comparison;
use super::support::Context;
use crate::base::error::Result;
use crate::base::vectors::Vectors;
use crate::engine::Engine;
use crate::strand::assembly::{Assembly, Wire};
use glam::DVec3;

pub const SNAPPED: VerificationCase = VerificationCase {
    name: "snapped-bond",
    about: "a bond that breaks at the first step leaves the same motion, to the bit, as no bond at all",
    source: "identity",
    run: snapped_bond,
};

/// Halves fly at each other, so that they touch, rub and part while they turn.
fn collide(a: &mut Assembly, middle: usize) {
    for i in 0..a.len() {
        let sign = if i <= middle { 1.0 } else { -1.0 };
        a.velocity.set(i, a.velocity.get(i) + DVec3::new(0.2 * sign, 0.1 * sign, 2.0 * sign));
    }
}

fn snapped_bond(context: &Context) -> Result<Vec<Comparison>> {
    let scene = "verify/snapped-wire";
    let middle = |a: &Assembly| a.wires[0].len / 2 - 1;
    let mut breaking = context.changed(scene, &[], |a| {
        let slot = middle(a);
        collide(a, slot);
        a.rest_length[slot] *= 0.9;
    })?;
    let mut without = context.changed(scene, &[], |a| {
        let slot = middle(a);
        collide(a, slot);
        let whole = a.wires[0];
        a.rest_length[slot] = 0.0;
        a.wires = vec![Wire { len: slot + 1, ..whole }, Wire { first: slot + 1, len: whole.len - slot - 1, ..whole }];
        a.wire_of[slot + 1..].fill(1);
    })?;
    let broken = breaking.engine.take_ruptures().len();
    let mut touching = 0;
    let steps = context.pick(20_000, 100_000);
    breaking.run_steps(steps, |engine| touching = touching.max(engine.contact_counts().2))?;
    without.run_steps(steps, |_| {})?;
    let differing = differing_bits(&breaking.engine, &without.engine);
    let later = breaking.engine.take_ruptures().len();
    let (a, b) = (breaking.finish(), without.finish());
    let count = |what: &str, value: usize, exact: usize| {
        Comparison::new(what, "-", value as f64, exact as f64, a + b).relative_to(1.0)
    };
    Ok(vec![
        count(&format!("numbers that differ after {steps} steps"), differing, 0),
        count("bonds broken before the first step", broken, 1),
        count("bonds broken later", later, 0),
        Comparison::at_least("contacts at once", "-", touching as f64, 1.0, a + b),
    ])
}

/// Components of positions, velocities and spins that are not the same to the bit.
fn differing_bits(a: &Engine, b: &Engine) -> usize {
    let (a, b) = (a.state(), b.state());
    let differ = |a: &Vectors, b: &Vectors| {
        let bits = |v: DVec3| v.to_array().map(f64::to_bits);
        (0..a.len())
            .map(|i| bits(a.get(i)).iter().zip(bits(b.get(i))).filter(|(a, b)| **a != *b).count())
            .sum::<usize>()
    };
    differ(&a.x, &b.x) + differ(&a.v, &b.v) + differ(&a.w, &b.w)
}
