//! A recorded function as a stage of a step: a shader that takes numbers of a particle, or of a pair of them, from columns and
//! puts them back.
//!
//! Particles of all scenes lie one after the other, those of each from the beginning of a group on, and so do pairs; so what is
//! worked on together is of one scene.

use crate::base::recorder::Function;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Particles or pairs that are worked on together.
pub const GROUP: u32 = 64;
/// Groups side by side: an adapter need not take more in one direction.
pub const ABREAST: u32 = 65_535;
/// Outputs that are signals: the steps of a scene end with the stage in which one of them is 1 for some particle; but a search
/// is due after the bonds.
pub const SIGNALS: [&str; 3] = [RAN_AWAY, "due", SEARCH];
const RAN_AWAY: &str = "ran_away";
const SEARCH: &str = "search";
/// What the list of whole numbers begins with, in this order; places are those in the list.
pub const HEAD: [&str; 12] = [
    "slots",          // length of the columns of particles
    "groups",         // groups of particles
    "scene_of_group", // place of the scene of each
    "ends_of_scenes", // place of the end of each scene's particles
    "sums",           // what is measured
    "sum_places",     // place of, for each: scene, column, first and end of its particles
    "stride",         // length of the columns of pairs
    "pair_groups",    // groups of pairs
    "scene_of_pairs", // place of the scene of each
    "ends_of_pairs",  // place of the end of each scene's pairs
    "pair_places",    // place of the two particles of each pair
    "starts",         // place of the place of the first side of each particle
];

/// Where numbers lie: those of particles and of pairs in columns of one length each, those of the step in a row.
#[derive(Debug, Default)]
pub struct Places {
    /// Column of each name.
    pub columns: BTreeMap<String, u32>,
    /// The same for pairs.
    pub pair_columns: BTreeMap<String, u32>,
    /// Place of each name among the numbers of a scene in the row of the step; before them all is the number of the step.
    pub step: BTreeMap<String, u32>,
    /// Stages that come before those of pairs, and all stages of a step.
    pub before_pairs: usize,
    /// See `before_pairs`.
    pub stages: usize,
}

/// Whose number an input is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Own,
    Next,
    Before,
    First,
    Second,
    Contacts,
}

/// What a function is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// Each particle.
    Particles,
    /// Each pair.
    Pairs,
}

/// Name of the column of an input, and of whose it is.
fn side(input: &str) -> (&str, Side) {
    let prefixes = [
        ("near_", Side::Own),
        ("here_", Side::Own),
        ("far_", Side::Next),
        ("before_", Side::Before),
        ("first_", Side::First),
        ("second_", Side::Second),
        ("contacts_", Side::Contacts),
    ];
    let found = prefixes.iter().find_map(|(prefix, side)| input.strip_prefix(prefix).map(|name| (name, *side)));
    found.unwrap_or((input, Side::Own))
}

/// Names of the columns that a function takes and of those that it puts, of particles and of pairs; `of_step` are not among
/// them.
pub fn columns(function: &Function, of: Of, of_step: impl Fn(&str) -> bool) -> Vec<(Of, bool, &str)> {
    let taken = function.inputs().iter().filter(|name| !of_step(name)).map(|input| (input, side(input)));
    let taken = taken.filter_map(|(_, (name, side))| match side {
        Side::Contacts => None,
        Side::First | Side::Second => Some((Of::Particles, false, name)),
        Side::Own | Side::Next | Side::Before => Some((of, false, name)),
    });
    let put = function.outputs().filter(|name| !SIGNALS.contains(name)).map(|name| (of, true, name));
    taken.chain(put).collect()
}

impl Places {
    /// An expression for an input of a function.
    fn input(&self, of: Of, name: &str) -> String {
        if let Some(place) = self.step.get(name) {
            return format!("step[numbers + {place}u]");
        }
        let (column, side) = side(name);
        let of_particle = |at: &str| format!("columns[{}u * slots + {at}]", self.columns[column]);
        match (of, side) {
            (_, Side::Contacts) => name.to_owned(),
            (_, Side::First) => of_particle("first"),
            (_, Side::Second) => of_particle("second"),
            (Of::Pairs, _) => format!("pairs[{}u * stride + here]", self.pair_columns[column]),
            (Of::Particles, Side::Next) => of_particle("next"),
            (Of::Particles, Side::Before) => format!("select(0.0lf, {}, here > 0u)", of_particle("before")),
            (Of::Particles, _) => of_particle("here"),
        }
    }

    /// The shader of a function that is number `number` of a step.
    pub fn shader(&self, function: &Function, of: Of, number: usize) -> String {
        let mut text = function.wgsl() + &self.head(number);
        text += &match of {
            Of::Particles => self.of_particles(function),
            Of::Pairs => self.of_pairs(),
        };
        let inputs: Vec<String> = function.inputs().iter().map(|name| self.input(of, name)).collect();
        writeln!(text, "    let found = {}({});", function.name(), inputs.join(", ")).expect(ANY);
        for name in function.outputs() {
            text += &self.output(of, name);
        }
        text + "}\n"
    }

    /// What is done with an output.
    fn output(&self, of: Of, name: &str) -> String {
        let signal = |raised: String| format!("    if found.{name} > 0.0lf {{ {raised} }}\n");
        let end = "atomicMin(&ends[2u * scene], serial());";
        match (name, of) {
            (RAN_AWAY, _) => signal(format!("{end} atomicMax(&ends[2u * scene + 1u], 1u);")),
            (SEARCH, _) => {
                let after_bonds = format!("u32(step[0]) * {}u + {}u", self.stages, self.before_pairs);
                signal(format!("atomicMin(&ends[2u * scene], {after_bonds});"))
            }
            _ if SIGNALS.contains(&name) => signal(end.into()),
            (_, Of::Particles) => format!("    columns[{}u * slots + here] = found.{name};\n", self.columns[name]),
            (_, Of::Pairs) => format!("    pairs[{}u * stride + here] = found.{name};\n", self.pair_columns[name]),
        }
    }

    /// The beginning of the main function of a stage of particles: who it is about, and sums over its pairs where `function`
    /// takes them.
    fn of_particles(&self, function: &Function) -> String {
        let width = self.step.len();
        let mut text = format!(
            "
@compute @workgroup_size({GROUP})
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {{
    let number = group.y * {ABREAST}u + group.x;
    if number >= lists[GROUPS] {{ return; }}
    let scene = lists[lists[SCENE_OF_GROUP] + number];
    let here = number * {GROUP}u + thread;
    if here >= lists[lists[ENDS_OF_SCENES] + scene] || over(scene) {{ return; }}
    let numbers = 1u + scene * {width}u;
    let slots = lists[SLOTS];
    let stride = lists[STRIDE];
    let next = min(here + 1u, slots - 1u);
    let before = max(here, 1u) - 1u;
"
        );
        let sums = function.inputs().iter().filter(|name| side(name).1 == Side::Contacts);
        let (mut begin, mut first, mut second) = (String::new(), String::new(), String::new());
        for name in sums {
            // A force on the second particle is the opposite of that on the first; torques are two.
            let (of_first, of_second, sign) =
                match (name.strip_prefix("contacts_force"), name.strip_prefix("contacts_torque")) {
                    (Some(axis), _) => (format!("push{axis}"), format!("push{axis}"), '-'),
                    (None, Some(axis)) => (format!("twist_first{axis}"), format!("twist_second{axis}"), '+'),
                    (None, None) => unreachable!("no sum over contacts is called {name}"),
                };
            writeln!(begin, "    var {name} = 0.0lf;").expect(ANY);
            // Bodies that do not turn leave no torques.
            let column =
                |part: &str| self.pair_columns.get(part).map(|column| format!("pairs[{column}u * stride + pair]"));
            if let (Some(of_first), Some(of_second)) = (column(&of_first), column(&of_second)) {
                writeln!(first, "            {name} += {of_first};").expect(ANY);
                writeln!(second, "            {name} {sign}= {of_second};").expect(ANY);
            }
        }
        if !begin.is_empty() {
            write!(
                text,
                "{begin}    let start = lists[STARTS] + here;
    for (var k = lists[start]; k < lists[start + 1u]; k++) {{
        let side = lists[k];
        let pair = side >> 1u;
        if (side & 1u) == 0u {{
{first}        }} else {{
{second}        }}
    }}
"
            )
            .expect(ANY);
        }
        text
    }

    /// The beginning of the main function of a stage of pairs.
    fn of_pairs(&self) -> String {
        let width = self.step.len();
        format!(
            "
@compute @workgroup_size({GROUP})
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {{
    let number = group.y * {ABREAST}u + group.x;
    if number >= lists[PAIR_GROUPS] {{ return; }}
    let scene = lists[lists[SCENE_OF_PAIRS] + number];
    let here = number * {GROUP}u + thread;
    if here >= lists[lists[ENDS_OF_PAIRS] + scene] || over(scene) {{ return; }}
    let numbers = 1u + scene * {width}u;
    let slots = lists[SLOTS];
    let stride = lists[STRIDE];
    let first = lists[lists[PAIR_PLACES] + 2u * here];
    let second = lists[lists[PAIR_PLACES] + 2u * here + 1u];
"
        )
    }

    /// What all stages share. A stage does nothing for a scene once an earlier one, of this step or of one before, has ended its
    /// steps; what others of the same stage do goes on, so that it does not matter who comes first.
    fn head(&self, number: usize) -> String {
        let names = HEAD.iter().enumerate();
        let names: String = names.map(|(k, name)| format!("const {} = {k}u;\n", name.to_uppercase())).collect();
        format!(
            "
{names}
@group(0) @binding(0) var<storage, read_write> columns: array<f64>;
@group(0) @binding(1) var<storage, read_write> ends: array<atomic<u32>>;
@group(0) @binding(2) var<storage, read> step: array<f64>;
@group(0) @binding(3) var<storage, read> lists: array<u32>;
@group(0) @binding(4) var<storage, read_write> sums: array<f64>;
@group(0) @binding(5) var<storage, read_write> pairs: array<f64>;

fn serial() -> u32 {{ return u32(step[0]) * {}u + {}u; }}
fn over(scene: u32) -> bool {{ return atomicLoad(&ends[2u * scene]) < serial(); }}
",
            self.stages,
            number + 1
        )
    }

    /// The shader that adds up what is measured after the first stage: one sum per group, always in the same order.
    pub fn sums(&self) -> String {
        self.head(0)
            + &format!(
                "
var<workgroup> part: array<f64, {GROUP}>;

@compute @workgroup_size({GROUP})
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {{
    let number = group.y * {ABREAST}u + group.x;
    let some = number < lists[SUMS];
    let at = lists[SUM_PLACES] + select(0u, 4u * number, some);
    let scene = lists[at];
    let column = lists[at + 1u] * lists[SLOTS];
    let last = lists[at + 3u];
    var sum = 0.0lf;
    for (var k = lists[at + 2u] + thread; k < last; k += {GROUP}u) {{
        sum += columns[column + lists[k]];
    }}
    part[thread] = sum;
    workgroupBarrier();
    for (var half = {GROUP}u / 2u; half > 0u; half /= 2u) {{
        if thread < half {{ part[thread] += part[thread + half]; }}
        workgroupBarrier();
    }}
    if thread == 0u && some && !over(scene) {{ sums[number] = part[0]; }}
}}
"
            )
    }
}

const ANY: &str = "a String takes any text";

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
            ("first_x_y", ("x_y", Side::First)),
            ("contacts_force_x", ("force_x", Side::Contacts)),
            ("history_3", ("history_3", Side::Own)),
            ("mass", ("mass", Side::Own)),
        ] {
            assert_eq!(side(input), expected);
        }
    }
}
