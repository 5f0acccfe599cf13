//! Formulas written down instead of computed: the same Rust source as code for a graphics processor.
//!
//! A [`Formula`] is generic over [`Real`]. Run with `f64` it computes; run with [`Recorded`] numbers, each of which is the
//! place of an operation in a list, it gives a [`Function`]: what was done, once each, in an order in which it can be done
//! again. [`Function::wgsl`] writes that as a WGSL function, [`Function::evaluate`] does it on the processor.
//!
//! - What was done before is not done twice: an operation on the same operands is the same place in the list. One whose
//!   operands are constants is a constant. What no output needs is left out.
//! - Constants keep their bits, and so does what is made of bits ([`Real::split`], [`Real::inverse_guess`]):
//!   [`Function::evaluate`] gives the bits of the formula run with `f64`. A graphics processor may fuse a product and a sum
//!   or divide less exactly, so that its results agree to rounding.
//! - [`Mask::any`] answers yes: all work is recorded, and [`Real::select`] takes what counts.
//! - [`Real::refine`] becomes a loop that ends when its number is settled; what does not change in it is computed before it.
//!   Loops do not lie in each other.
//! - A table ([`Real::rows_around`]) becomes a row of choices, one for each inner row.
//! - The constants of a law are those of the recording: another material is another function.
//!
//! What asks for the numbers themselves cannot be recorded ([`Unrecordable`]): an `if` on the value of a number, the
//! functions of `f64` that [`Real`] lacks (angles, cube roots), [`Real::at`] and [`Real::put`]. Laws that work one contact
//! after the other, as `mindlin-deresiewicz` does, are of that kind.
//!
//! # A new law on the graphics processor
//!
//! Nothing to do, if it is generic over `Real` and keeps to the list above: bonds and contacts are recorded with their laws
//! (`engine::bonds::formula`, `engine::contact::formula`). A row of `cases` in `tests/common/laws.rs` compares it on the
//! processor (`tests/recorder.rs`) and on an adapter (`tests/gpu.rs`).

mod operation;
mod wgsl;

use super::lanes::{Mask, Real, Refinement};
use super::triple::Triple;
use operation::{Kind, Node, Operation, Place};
use std::collections::HashMap;
use std::fmt;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A computation with named numbers that go in and come out.
pub trait Formula {
    /// Takes its numbers by name, each once, and puts its results by name, each once.
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R));

    /// Computes with `f64`: the results, in the order in which they are put, from `inputs` in the order in which they are
    /// taken.
    ///
    /// # Panics
    /// When there are fewer inputs than the formula takes.
    fn evaluate(&self, inputs: &[f64]) -> Vec<f64> {
        let (mut inputs, mut results) = (inputs.iter(), Vec::new());
        self.compute(&mut |_| *inputs.next().expect("an input for every name"), &mut |_, number| results.push(number));
        results
    }
}

/// Takes the vector whose parts are `name_x`, `name_y` and `name_z`.
pub fn take_vector<R: Real>(take: &mut dyn FnMut(&str) -> R, name: &str) -> Triple<R> {
    let mut part = |axis| take(&format!("{name}_{axis}"));
    Triple { x: part('x'), y: part('y'), z: part('z') }
}

/// Puts the parts of a vector as `name_x`, `name_y` and `name_z`.
pub fn put_vector<R: Real>(put: &mut dyn FnMut(&str, R), name: &str, vector: Triple<R>) {
    for (axis, number) in [('x', vector.x), ('y', vector.y), ('z', vector.z)] {
        put(&format!("{name}_{axis}"), number);
    }
}

/// Why a formula cannot be recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Unrecordable {
    /// It takes the numbers one by one.
    #[error("the formula asks for the value of a number (Real::at, Real::put)")]
    Value,
    /// It refines a number while it refines another.
    #[error("the formula refines a number within the refinement of another (Real::refine)")]
    NestedLoop,
}

/// A formula as a list of operations.
#[derive(Debug, Clone)]
pub struct Function {
    name: String,
    inputs: Vec<String>,
    outputs: Vec<(String, Place)>,
    nodes: Vec<Node>,
    loops: Vec<Loop>,
    /// The loop in which each node is worked out.
    homes: Vec<Option<u32>>,
    /// Whether each node is needed for an output.
    needed: Vec<bool>,
}

/// A number that is refined.
#[derive(Debug, Clone, Copy)]
struct Loop {
    start: Place,
    wanted: Place,
    /// In the loop: whether its number is unsettled, and the next one.
    unsettled: Place,
    next: Place,
    most: u32,
}

impl Function {
    /// Records `formula` as a function called `name`.
    ///
    /// # Errors
    /// [`Unrecordable`], with the reason.
    pub fn record(name: &str, formula: &impl Formula) -> Result<Self, Unrecordable> {
        let recorder = Recorder::default();
        let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
        formula.compute(
            &mut |name| {
                let place = recorder.push(Node::Input(inputs.len() as u32));
                inputs.push(name.to_owned());
                Recorded { recorder: &recorder, place }
            },
            &mut |name, number: Recorded| outputs.push((name.to_owned(), number.place)),
        );
        let Tape { nodes, loops, homes, failure, .. } =
            recorder.tape.into_inner().unwrap_or_else(PoisonError::into_inner);
        match failure {
            Some(reason) => Err(reason),
            None => {
                let mut function = Self { name: name.to_owned(), inputs, outputs, needed: vec![], nodes, loops, homes };
                function.needed = function.needed();
                Ok(function)
            }
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Names of what goes in, in order.
    pub fn inputs(&self) -> &[String] {
        &self.inputs
    }

    /// Names of what comes out, in order.
    pub fn outputs(&self) -> impl ExactSizeIterator<Item = &str> {
        self.outputs.iter().map(|(name, _)| name.as_str())
    }

    /// How many operations it is, those in a loop once.
    pub fn operations(&self) -> usize {
        let counts = |(node, needed): &(&Node, &bool)| **needed && matches!(node, Node::Apply(..));
        self.nodes.iter().zip(&self.needed).filter(counts).count()
    }

    /// The nodes that an output needs.
    fn needed(&self) -> Vec<bool> {
        let mut needed = vec![false; self.nodes.len()];
        let mut open: Vec<Place> = self.outputs.iter().map(|(_, place)| *place).collect();
        while let Some(place) = open.pop() {
            if std::mem::replace(&mut needed[place as usize], true) {
                continue;
            }
            match self.nodes[place as usize] {
                Node::Apply(operation, operands) => open.extend(operation.of(&operands)),
                Node::Refined(index) => {
                    let Loop { start, wanted, unsettled, next, .. } = self.loops[index as usize];
                    open.extend([start, wanted, unsettled, next]);
                }
                Node::Input(_) | Node::Carried(_) | Node::Number(_) | Node::Truth(_) => {}
            }
        }
        needed
    }

    /// Does what was recorded, with `inputs` in their order; gives the outputs in theirs, with the bits that the formula
    /// has with `f64`.
    ///
    /// # Panics
    /// When there are fewer inputs than [`Self::inputs`].
    pub fn evaluate(&self, inputs: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; self.nodes.len()];
        let within =
            |home: Option<u32>| (0..self.nodes.len()).filter(move |k| self.needed[*k] && self.homes[*k] == home);
        let work = |values: &mut [f64], k: usize| match self.nodes[k] {
            Node::Input(index) => values[k] = inputs[index as usize],
            Node::Number(bits) => values[k] = f64::from_bits(bits),
            Node::Truth(yes) => values[k] = f64::from(yes),
            Node::Apply(operation, operands) => values[k] = operation.apply(operands.map(|at| values[at as usize])),
            Node::Carried(_) | Node::Refined(_) => {}
        };
        for k in within(None) {
            work(&mut values, k);
            let Node::Refined(index) = self.nodes[k] else { continue };
            let Loop { start, wanted, unsettled, next, most } = self.loops[index as usize];
            let (mut number, mut open) = (values[start as usize], values[wanted as usize]);
            for round in 0..most {
                for k in within(Some(index)) {
                    if let Node::Carried(_) = self.nodes[k] {
                        values[k] = number;
                    }
                    work(&mut values, k);
                }
                if round > 0 {
                    open *= values[unsettled as usize];
                }
                if open == 0.0 {
                    break;
                }
                number = values[next as usize];
            }
            values[k] = number;
        }
        self.outputs.iter().map(|(_, place)| values[*place as usize]).collect()
    }
}

/// The loop in which a node is worked out, from those of the nodes before it.
fn home(node: &Node, homes: &[Option<u32>]) -> Option<u32> {
    match node {
        Node::Carried(index) => Some(*index),
        Node::Apply(operation, operands) => operation.of(operands).find_map(|at| homes[at as usize]),
        Node::Input(_) | Node::Number(_) | Node::Truth(_) | Node::Refined(_) => None,
    }
}

/// What has been recorded so far.
#[derive(Default)]
struct Recorder {
    tape: Mutex<Tape>,
}

#[derive(Default)]
struct Tape {
    nodes: Vec<Node>,
    homes: Vec<Option<u32>>,
    known: HashMap<Node, Place>,
    loops: Vec<Loop>,
    failure: Option<Unrecordable>,
}

impl Recorder {
    fn tape(&self) -> MutexGuard<'_, Tape> {
        self.tape.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, node: Node) -> Place {
        let mut guard = self.tape();
        let tape = &mut *guard;
        if let Some(place) = tape.known.get(&node) {
            return *place;
        }
        let place = tape.nodes.len() as Place;
        tape.homes.push(home(&node, &tape.homes));
        tape.nodes.push(node);
        tape.known.insert(node, place);
        place
    }

    fn apply(&self, operation: Operation, mut operands: [Place; 3]) -> Place {
        if operation.commutes() && operands[0] > operands[1] {
            operands.swap(0, 1);
        }
        let constants = {
            let tape = self.tape();
            let mut values = [0.0; 3];
            let all = operation.of(&operands).zip(&mut values).all(|(at, value)| {
                match tape.nodes[at as usize] {
                    Node::Number(bits) => *value = f64::from_bits(bits),
                    Node::Truth(yes) => *value = f64::from(yes),
                    _ => return false,
                }
                true
            });
            all.then_some(values)
        };
        self.push(match constants {
            None => Node::Apply(operation, operands),
            Some(values) => match (operation.kind(), operation.apply(values)) {
                (Kind::Number, value) => Node::Number(value.to_bits()),
                (Kind::Truth, value) => Node::Truth(value != 0.0),
            },
        })
    }

    fn fail(&self, reason: Unrecordable) {
        self.tape().failure.get_or_insert(reason);
    }

    /// The end of the loop `index`, which must be the last that was begun.
    fn push_loop(&self, index: u32, own: Loop) -> Place {
        {
            let mut tape = self.tape();
            if tape.loops.len() as u32 != index + 1 {
                tape.failure.get_or_insert(Unrecordable::NestedLoop);
            }
            tape.loops[index as usize] = own;
        }
        self.push(Node::Refined(index))
    }
}

/// A number of a formula that is recorded.
#[derive(Clone, Copy)]
pub struct Recorded<'r> {
    recorder: &'r Recorder,
    place: Place,
}

/// An answer of a formula that is recorded.
#[derive(Clone, Copy)]
pub struct RecordedMask<'r>(Recorded<'r>);

impl fmt::Debug for Recorded<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "n{}", self.place)
    }
}

impl fmt::Debug for RecordedMask<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Recorded<'_> {
    /// An operation on this number and up to two others.
    fn apply<const N: usize>(self, operation: Operation, others: [Self; N]) -> Self {
        let mut operands = [self.place; 3];
        operands[1..].iter_mut().zip(others).for_each(|(operand, other)| *operand = other.place);
        // What an operation does not take is one and the same, so that it is known again.
        operands[operation.count()..].fill(0);
        Self { place: self.recorder.apply(operation, operands), ..self }
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident, $assign:ident $assign_method:ident;)*) => {$(
        impl $trait for Recorded<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.apply(Operation::$trait, [other])
            }
        }
        impl $trait<f64> for Recorded<'_> {
            type Output = Self;
            fn $method(self, other: f64) -> Self {
                self.apply(Operation::$trait, [self.splat(other)])
            }
        }
        impl $assign for Recorded<'_> {
            fn $assign_method(&mut self, other: Self) {
                *self = self.apply(Operation::$trait, [other]);
            }
        }
    )*};
}

operator! {
    Add add, AddAssign add_assign;
    Sub sub, SubAssign sub_assign;
    Mul mul, MulAssign mul_assign;
}

impl Div for Recorded<'_> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.apply(Operation::Div, [other])
    }
}

impl Neg for Recorded<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.apply(Operation::Neg, [])
    }
}

impl<'r> Real for Recorded<'r> {
    type Mask = RecordedMask<'r>;

    fn splat(self, value: f64) -> Self {
        Self { place: self.recorder.push(Node::Number(value.to_bits())), ..self }
    }
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self.apply(Operation::MulAdd, [factor, addend])
    }
    fn sqrt(self) -> Self {
        self.apply(Operation::Sqrt, [])
    }
    fn abs(self) -> Self {
        self.apply(Operation::Abs, [])
    }
    fn simd_min(self, other: Self) -> Self {
        Self::select(other.simd_gt(self), self, other)
    }
    fn simd_max(self, other: Self) -> Self {
        Self::select(self.simd_gt(other), self, other)
    }
    fn simd_gt(self, other: Self) -> RecordedMask<'r> {
        RecordedMask(self.apply(Operation::Greater, [other]))
    }
    fn select(mask: RecordedMask<'r>, yes: Self, no: Self) -> Self {
        mask.0.apply(Operation::Select, [yes, no])
    }
    fn power_of_two(self) -> Self {
        self.apply(Operation::PowerOfTwo, [])
    }
    fn split(self) -> (Self, Self) {
        (self.apply(Operation::Mantissa, []), self.apply(Operation::Exponent, []))
    }
    fn inverse_sqrt_guess(self) -> Self {
        self.apply(Operation::InverseSqrtGuess, [])
    }
    fn inverse_guess(self) -> Self {
        self.apply(Operation::InverseGuess, [])
    }
    fn round_ties_even(self) -> Self {
        self.apply(Operation::Round, [])
    }
    fn rows_around<const COLUMNS: usize>(self, table: &[[f64; COLUMNS]]) -> [[Self; COLUMNS]; 2] {
        let mut rows = [0, 1].map(|k| table[k].map(|value| self.splat(value)));
        for (k, first) in table[..table.len() - 1].iter().enumerate().skip(1) {
            let reached = !self.splat(first[0]).simd_gt(self);
            for (row, values) in rows.iter_mut().zip(&table[k..]) {
                for (number, value) in row.iter_mut().zip(values) {
                    *number = Self::select(reached, self.splat(*value), *number);
                }
            }
        }
        rows
    }
    fn refine<M: Refinement<Self>>(self, method: &M, wanted: RecordedMask<'r>, most: u32) -> (Self, M::Point) {
        let index = {
            let mut tape = self.recorder.tape();
            tape.loops.push(Loop { start: 0, wanted: 0, unsettled: 0, next: 0, most });
            tape.loops.len() as u32 - 1
        };
        let number = Self { place: self.recorder.push(Node::Carried(index)), ..self };
        let point = method.at(number);
        let (unsettled, next) = (method.unsettled(&point).0.place, method.next(number, &point).place);
        let own = Loop { start: self.place, wanted: wanted.0.place, unsettled, next, most };
        let end = Self { place: self.recorder.push_loop(index, own), ..self };
        (end, method.at(end))
    }
    const COUNT: usize = 1;
    /// Fails the recording ([`Unrecordable::Value`]); no number.
    fn at(self, _: usize) -> f64 {
        self.recorder.fail(Unrecordable::Value);
        f64::NAN
    }
    /// Fails the recording.
    fn put(&mut self, _: usize, _: f64) {
        self.recorder.fail(Unrecordable::Value);
    }
}

impl BitAnd for RecordedMask<'_> {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self(self.0.apply(Operation::And, [other.0]))
    }
}

impl BitOr for RecordedMask<'_> {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0.apply(Operation::Or, [other.0]))
    }
}

impl Not for RecordedMask<'_> {
    type Output = Self;
    fn not(self) -> Self {
        Self(self.0.apply(Operation::Not, []))
    }
}

impl Mask for RecordedMask<'_> {
    /// Yes: everything is recorded.
    fn any(self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests;
