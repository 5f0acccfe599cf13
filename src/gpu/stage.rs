//! A recorded function as a stage of a step: a shader that takes a particle's numbers from columns and puts them back.

use crate::base::recorder::Function;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Particles that are worked on together.
pub const GROUP: u32 = 64;
/// Outputs that are signals: steps end with the stage in which one of them is 1 for some particle.
pub const SIGNALS: [&str; 2] = ["ran_away", "due"];

/// Where numbers lie: those of particles in columns of one length, those of the step in a row.
#[derive(Debug, Default)]
pub struct Places {
    /// Particles.
    pub particles: u32,
    /// Column of each name.
    pub columns: BTreeMap<String, u32>,
    /// Place of each name in the row of the step; its first number is the number of the step.
    pub step: BTreeMap<String, u32>,
}

/// Whose number an input is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Own,
    Next,
    Before,
}

/// Name of the column of an input, and of whose it is.
fn side(input: &str) -> (&str, Side) {
    let prefixes = [("near_", Side::Own), ("here_", Side::Own), ("far_", Side::Next), ("before_", Side::Before)];
    let found = prefixes.iter().find_map(|(prefix, side)| input.strip_prefix(prefix).map(|name| (name, *side)));
    found.unwrap_or((input, Side::Own))
}

/// Names of the columns that the functions of a step take, and of those that they put; `of_step` are not among them.
pub fn columns(functions: &[Function], of_step: impl Fn(&str) -> bool) -> [Vec<&str>; 2] {
    let taken = functions.iter().flat_map(|f| f.inputs()).map(|input| side(input).0).filter(|name| !of_step(name));
    let put = functions.iter().flat_map(Function::outputs).filter(|name| !SIGNALS.contains(name));
    [taken.collect(), put.collect()]
}

impl Places {
    /// An expression for an input of a function.
    fn input(&self, name: &str) -> String {
        if let Some(place) = self.step.get(name) {
            return format!("step[{place}u]");
        }
        let (name, side) = side(name);
        let column = self.columns[name] * self.particles;
        match side {
            Side::Own => format!("columns[{column}u + here]"),
            Side::Next => format!("columns[{column}u + next]"),
            Side::Before => format!("select(0.0lf, columns[{column}u + before], here > 0u)"),
        }
    }

    /// The shader of a function that is number `number` of `stages` in a step.
    pub fn shader(&self, function: &Function, number: usize, stages: usize) -> String {
        let mut text = function.wgsl() + &head(number, stages);
        let inputs: Vec<String> = function.inputs().iter().map(|name| self.input(name)).collect();
        write!(
            text,
            "
@compute @workgroup_size({GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let here = id.x;
    if here >= {count}u || over() {{ return; }}
    let next = min(here + 1u, {count}u - 1u);
    let before = max(here, 1u) - 1u;
    let found = {name}({inputs});
",
            count = self.particles,
            name = function.name(),
            inputs = inputs.join(", ")
        )
        .expect("a String takes any text");
        for name in function.outputs() {
            if SIGNALS.contains(&name) {
                writeln!(text, "    if found.{name} > 0.0lf {{ atomicMin(&end, serial()); }}")
            } else {
                let column = self.columns[name] * self.particles;
                writeln!(text, "    columns[{column}u + here] = found.{name};")
            }
            .expect("a String takes any text");
        }
        text + "}\n"
    }
}

/// What all stages share. A stage does nothing once an earlier one, of this step or of one before, has ended the steps; what
/// others of the same stage do goes on, so that it does not matter who comes first.
fn head(number: usize, stages: usize) -> String {
    format!(
        "
@group(0) @binding(0) var<storage, read_write> columns: array<f64>;
@group(0) @binding(1) var<storage, read_write> end: atomic<u32>;
@group(0) @binding(2) var<storage, read> step: array<f64>;

fn serial() -> u32 {{ return u32(step[0]) * {stages}u + {number}u; }}
fn over() -> bool {{ return atomicLoad(&end) < serial(); }}
"
    )
}

/// The shader that adds up what is measured after the first of `stages`: one sum per group, always in the same order.
pub fn sums(stages: usize) -> String {
    head(0, stages)
        + &format!(
            "
@group(0) @binding(3) var<storage, read> lists: array<u32>;
@group(0) @binding(4) var<storage, read_write> sums: array<f64>;

var<workgroup> part: array<f64, {GROUP}>;

@compute @workgroup_size({GROUP})
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {{
    let column = lists[3u * group.x];
    let last = lists[3u * group.x + 2u];
    var sum = 0.0lf;
    for (var k = lists[3u * group.x + 1u] + thread; k < last; k += {GROUP}u) {{
        sum += columns[column + lists[k]];
    }}
    part[thread] = sum;
    workgroupBarrier();
    for (var half = {GROUP}u / 2u; half > 0u; half /= 2u) {{
        if thread < half {{ part[thread] += part[thread + half]; }}
        workgroupBarrier();
    }}
    if thread == 0u && !over() {{ sums[group.x] = part[0]; }}
}}
"
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_is_of_the_particle_or_of_a_neighbour() {
        for (input, expected) in [
            ("near_x_x", ("x_x", Side::Own)),
            ("far_w_z", ("w_z", Side::Next)),
            ("here_moment_near_x", ("moment_near_x", Side::Own)),
            ("before_thinning", ("thinning", Side::Before)),
            ("mass", ("mass", Side::Own)),
        ] {
            assert_eq!(side(input), expected);
        }
    }
}
