//! A recorded function as text in WGSL, the language of `wgpu`, with its extensions for `f64` and `u64`.

use super::operation::{Node, Operation, Place};
use super::{Function, Loop};
use crate::base::lanes;
use std::fmt::Write;

impl Function {
    /// Name of the type of what it returns: a structure of its outputs.
    pub fn results_type(&self) -> String {
        format!("{}_results", self.name())
    }

    /// The function and the type of what it returns. It takes its inputs as parameters, in order and by name; a device
    /// needs the features `SHADER_F64` and `SHADER_INT64` of `wgpu` for it.
    pub fn wgsl(&self) -> String {
        let mut text = format!("struct {} {{\n", self.results_type());
        self.outputs.iter().for_each(|(name, _)| put(&mut text, 1, &format!("{name}: f64,")));
        let parameters: Vec<String> = self.inputs.iter().map(|name| format!("{name}: f64")).collect();
        let head = format!("}}\n\nfn {}({}) -> {} {{", self.name, parameters.join(", "), self.results_type());
        put(&mut text, 0, &head);
        let within = |home: Option<u32>| {
            (0..self.nodes.len() as Place).filter(move |k| self.needed[*k as usize] && self.homes[*k as usize] == home)
        };
        for place in within(None) {
            match self.nodes[place as usize] {
                Node::Refined(index) => self.refine(&mut text, place, index, &mut within(Some(index))),
                _ => self.define(&mut text, 1, place),
            }
        }
        let results: Vec<String> = self.outputs.iter().map(|(_, place)| self.term(*place)).collect();
        put(&mut text, 1, &format!("return {}({});", self.results_type(), results.join(", ")));
        text.push_str("}\n");
        text
    }

    /// A loop whose number is at `place`, with the nodes `body` in it.
    fn refine(&self, text: &mut String, place: Place, index: u32, body: &mut dyn Iterator<Item = Place>) {
        let Loop { start, wanted, unsettled, next, most } = self.loops[index as usize];
        put(text, 1, &format!("var n{place} = {};", self.term(start)));
        put(text, 1, &format!("var open{place} = {};", self.term(wanted)));
        put(text, 1, &format!("for (var round = 0u; round < {most}u; round++) {{"));
        let (known, rest): (Vec<Place>, Vec<Place>) = body.partition(|k| *k <= unsettled);
        known.into_iter().for_each(|k| self.define(text, 2, k));
        put(text, 2, &format!("if round > 0u {{ open{place} = open{place} & {}; }}", self.term(unsettled)));
        put(text, 2, &format!("if !open{place} {{ break; }}"));
        rest.into_iter().for_each(|k| self.define(text, 2, k));
        put(text, 2, &format!("n{place} = {};", self.term(next)));
        put(text, 1, "}");
    }

    /// A line that works out the node at `place`, if that takes work.
    fn define(&self, text: &mut String, depth: usize, place: Place) {
        if let Node::Apply(operation, operands) = self.nodes[place as usize] {
            let operands = operands.map(|at| self.term(at));
            put(text, depth, &format!("let n{place} = {};", expression(operation, &operands)));
        }
    }

    /// What stands for the node at `place` in an expression.
    fn term(&self, place: Place) -> String {
        match self.nodes[place as usize] {
            Node::Input(index) => self.inputs[index as usize].clone(),
            Node::Number(bits) => literal(f64::from_bits(bits)),
            Node::Truth(yes) => yes.to_string(),
            Node::Carried(index) => {
                let end = self.nodes.iter().position(|node| *node == Node::Refined(index));
                format!("n{}", end.expect("every loop has its end"))
            }
            Node::Apply(..) | Node::Refined(_) => format!("n{place}"),
        }
    }
}

fn put(text: &mut String, depth: usize, line: &str) {
    writeln!(text, "{:1$}{line}", "", 4 * depth).expect("a String takes any text");
}

/// A constant with all its bits. What is no normal number has no literal that every driver keeps.
fn literal(value: f64) -> String {
    match value {
        _ if value.is_normal() && value > 0.0 || value.to_bits() == 0 => format!("{value:e}lf"),
        _ if value.is_normal() => format!("({value:e}lf)"),
        _ => format!("bitcast<f64>(0x{:016x}lu)", value.to_bits()),
    }
}

fn expression(operation: Operation, [a, b, c]: &[String; 3]) -> String {
    match operation {
        Operation::Add => format!("{a} + {b}"),
        Operation::Sub => format!("{a} - {b}"),
        Operation::Mul => format!("{a} * {b}"),
        Operation::Div => format!("{a} / {b}"),
        Operation::MulAdd => format!("fma({a}, {b}, {c})"),
        Operation::Neg => format!("-{a}"),
        Operation::Abs => format!("abs({a})"),
        Operation::Sqrt => format!("sqrt({a})"),
        Operation::Round => format!("round({a})"),
        Operation::PowerOfTwo => {
            format!("bitcast<f64>(bitcast<u64>({a} + {}) << 52u)", literal(lanes::EXPONENT_TO_BITS))
        }
        Operation::InverseGuess => format!("bitcast<f64>({}lu - bitcast<u64>({a}))", lanes::INVERSE_BITS),
        Operation::InverseSqrtGuess => {
            format!("bitcast<f64>({}lu - (bitcast<u64>({a}) >> 1u))", lanes::INVERSE_SQRT_BITS)
        }
        Operation::Mantissa => {
            format!("bitcast<f64>((bitcast<u64>({a}) & 0x000ffffffffffffflu) | 0x3ff0000000000000lu)")
        }
        Operation::Exponent => format!(
            "bitcast<f64>((bitcast<u64>({a}) >> 52u) | 0x4330000000000000lu) - {}",
            literal(lanes::NUMBER_OF_BITS)
        ),
        Operation::Greater => format!("{a} > {b}"),
        Operation::And => format!("{a} & {b}"),
        Operation::Or => format!("{a} | {b}"),
        Operation::Not => format!("!{a}"),
        Operation::Select => format!("select({c}, {b}, {a})"),
    }
}
