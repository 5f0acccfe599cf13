//! A scene as it is written: serde tables, nothing checked but names and kinds of values. This is also the reference
//! of all keys, each with its unit, its default and its meaning, which `strandsnap scene keys` prints
//! ([`super::keys`]); those of materials and bonds stand in `raw/materials.rs`, those of grips and holds in `raw/drive.rs`, those
//! of rigid bodies in `raw/body.rs`, those of outputs in `raw/output.rs` and `raw/picture.rs`.
//!
//! A quantity is text with a unit, `"39 mm"`; any unit of the right kind will do. A ratio may be a plain number or
//! per cent, `0.12` or `"12 %"`. Unknown keys are refused.

mod body;
mod drive;
mod materials;
mod output;
mod picture;
mod scalar;

pub use body::*;
pub use drive::*;
pub use materials::*;
pub use output::*;
pub use picture::*;
pub use scalar::*;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A whole scene file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawScene {
    /// Name of the scene, also of its folder under `out/`.
    #[schemars(extend("x-otherwise" = "the file's name without .toml"))]
    pub name: Option<String>,
    /// What the scene shows, one or more sentences.
    #[schemars(extend("x-required" = true))]
    pub about: Option<String>,
    /// Seed of the scatter.
    #[schemars(extend("x-default" = "1"))]
    pub seed: Option<i64>,
    /// Particle spacing over wire diameter; 1: touching spheres.
    #[schemars(extend("x-unit" = "-", "x-default" = "1"))]
    pub spacing: Option<Scalar>,
    /// Which stages run.
    #[schemars(extend("x-default" = "auto"))]
    pub plan: Option<RawPlan>,
    /// The material of bodies that name none.
    pub material: Option<RawMaterial>,
    /// `[materials.NAME]`: named materials, each with the bonds of its wires; layers, wires and spheres name theirs.
    #[serde(default)]
    pub materials: BTreeMap<String, RawNamedMaterial>,
    /// Bonds along the wires that name no material. Absent: elastic, undamped, unbreakable.
    pub bond: Option<RawBond>,
    /// Contacts between surfaces. Absent: none at all.
    pub contact: Option<RawContact>,
    /// A strand laid up in helical layers around z.
    #[schemars(extend("x-required-when" = "there is no other body: strand, wire or sphere"))]
    pub strand: Option<RawStrand>,
    /// `[[wire]]`: wires given one by one.
    #[schemars(extend("x-required-when" = "there is no other body: strand, wire or sphere"))]
    #[serde(default)]
    pub wire: Vec<RawWire>,
    /// `[[sphere]]`: free spheres.
    #[schemars(extend("x-required-when" = "there is no other body: strand, wire or sphere"))]
    #[serde(default)]
    pub sphere: Vec<RawSphere>,
    /// `[[body]]`: rigid bodies that stand still or move as they are told, and touch all wires and spheres.
    #[serde(default)]
    pub body: Vec<RawBody>,
    /// The two grips. Absent: free bodies.
    pub grip: Option<RawGrip>,
    /// `[[hold]]`: holds and loads on single bodies.
    #[serde(default)]
    pub hold: Vec<RawHold>,
    /// Time stepping.
    #[serde(default)]
    pub time: RawTime,
    /// When to stop: one key at least, and the first that holds ends the run.
    #[schemars(extend("x-required" = true))]
    #[serde(default)]
    pub stop: RawStop,
    /// What to write and how often.
    #[serde(default)]
    pub output: RawOutput,
}

/// `plan`.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawPlan {
    /// Only the stages that the scene needs.
    Auto,
    /// Every stage, for comparison.
    General,
}

/// `[contact]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawContact {
    /// Law of the normal force.
    #[schemars(extend("x-required" = true))]
    pub normal: Option<RawNormal>,
    /// Law of friction.
    #[schemars(extend("x-default" = "mindlin"))]
    pub tangential: Option<RawTangential>,
    /// Coulomb friction coefficient. Without effect when `tangential = "none"`.
    #[schemars(extend("x-unit" = "-", "x-default" = "0.2"))]
    pub friction: Option<Scalar>,
    /// `[[contact.pair]]`: friction between bodies of two named materials.
    #[serde(default)]
    pub pair: Vec<RawContactPair>,
    /// Shape of a wire in contact.
    #[schemars(extend("x-default" = "sphere"))]
    pub shape: Option<RawShape>,
    /// Thornton: limiting pressure over yield stress. Needs an elasto-plastic bond law.
    #[schemars(extend("x-unit" = "-", "x-default" = "2.8"))]
    pub hardness_factor: Option<Scalar>,
    /// Thornton: plastic strain at which that yield stress is taken; Tabor's representative strain is "8 %".
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub hardness_strain: Option<Scalar>,
    /// Thornton: limiting contact pressure, instead of the two keys above.
    #[schemars(extend("x-unit" = "MPa", "x-required-when" = "normal = \"thornton\" and bond.law = \"elastic\""))]
    pub limiting_pressure: Option<Scalar>,
    /// Viscous damping of the normal motion as a fraction of critical.
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub damping: Option<Scalar>,
    /// Coefficient of restitution of two elastic bodies in one contact, whatever their size, speed and stiffness, instead of
    /// `damping`. Plastic loss under thornton comes on top, so that bodies part more slowly than it says.
    #[schemars(extend("x-unit" = "-", "x-otherwise" = "what `damping` gives"))]
    pub restitution: Option<Scalar>,
    /// Skin of the neighbour list over the largest diameter.
    #[schemars(extend("x-unit" = "-", "x-default" = "0.15"))]
    pub skin: Option<Scalar>,
}

/// `contact.normal`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawNormal {
    /// Elastic.
    Hertz,
    /// Elastoplastic.
    Thornton,
    /// No contacts at all.
    None,
}

/// `contact.tangential`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawTangential {
    /// No-slip with Coulomb cap.
    Mindlin,
    /// Partial slip.
    MindlinDeresiewicz,
    /// Frictionless.
    None,
}

/// `contact.shape`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawShape {
    /// A chain of spheres: the reference paper's model.
    Sphere,
    /// Smooth, whatever the spacing.
    Wire,
}

/// `[strand]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawStrand {
    /// Length along z.
    #[schemars(extend("x-unit" = "mm", "x-required" = true))]
    pub length: Option<Scalar>,
    /// Wire diameter of layers that give none.
    #[schemars(extend("x-unit" = "mm", "x-required-when" = "there is a construction, or a layer without one"))]
    pub wire_diameter: Option<Scalar>,
    /// Pitch of layers that give none, or "inf" for straight wires.
    #[schemars(extend("x-unit" = "mm", "x-required-when" = "there is a construction, or a layer without one that is no single wire on the axis", "x-word" = "inf"))]
    pub pitch: Option<Scalar>,
    /// Lay direction of layers that give none.
    #[schemars(extend("x-default" = "right"))]
    pub lay: Option<RawLay>,
    /// Name of the material of layers that name none.
    #[schemars(extend("x-otherwise" = "that of [material] and [bond]"))]
    pub material: Option<String>,
    /// Instead of `[[strand.layer]]`: the wires of each layer from the inside out, such as [5, 11, 18], or `auto` for
    /// full rings of copper nearest to `area`; lay radii are least, and all layers have the strand's wire diameter,
    /// pitch and lay.
    #[schemars(extend("x-word" = "auto"))]
    pub construction: Option<RawConstruction>,
    /// Copper section of `construction = "auto"`.
    #[schemars(extend("x-unit" = "mm^2", "x-required-when" = "construction = \"auto\""))]
    pub area: Option<Scalar>,
    /// `[[strand.layer]]`, from the inside out.
    #[schemars(extend("x-required-when" = "there is no construction"))]
    #[serde(default)]
    pub layer: Vec<RawLayer>,
}

/// `strand.construction`.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"auto\" or the wires of each layer, such as [5, 11, 18]")]
pub enum RawConstruction {
    /// `"auto"`.
    Named(String),
    /// Wires of each layer, from the inside out.
    Layers(Vec<i64>),
}

/// `[[strand.layer]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawLayer {
    /// Name, used in tables.
    #[schemars(extend("x-otherwise" = "1st, 2nd, ..., inside out"))]
    pub name: Option<String>,
    /// Number of wires.
    #[schemars(extend("x-required" = true))]
    pub wires: Option<i64>,
    /// Lay radius (axis to wire centre), or `auto`: the least radius without overlap; 0 for a single wire in the
    /// first layer.
    #[schemars(extend("x-unit" = "mm", "x-default" = "auto", "x-word" = "auto"))]
    pub lay_radius: Option<Scalar>,
    /// Wire diameter.
    #[schemars(extend("x-unit" = "mm", "x-otherwise" = "strand.wire_diameter"))]
    pub wire_diameter: Option<Scalar>,
    /// Pitch, or "inf" for straight wires.
    #[schemars(extend("x-unit" = "mm", "x-otherwise" = "strand.pitch, else inf for a single wire on the axis", "x-word" = "inf"))]
    pub pitch: Option<Scalar>,
    /// Lay direction.
    #[schemars(extend("x-otherwise" = "strand.lay"))]
    pub lay: Option<RawLay>,
    /// Angle of the first wire at z = 0.
    #[schemars(extend("x-unit" = "deg", "x-default" = "0 deg"))]
    pub phase: Option<Scalar>,
    /// Name of its material.
    #[schemars(extend("x-otherwise" = "strand.material"))]
    pub material: Option<String>,
}

/// Lay direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawLay {
    /// Z lay.
    Right,
    /// S lay.
    Left,
}

impl RawLay {
    /// Sign of the lay; right where it is not given.
    pub(super) fn sign(lay: Option<Self>) -> f64 {
        match lay.unwrap_or(Self::Right) {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }
}

/// `[[wire]]`: either `from` and `to`, or `file`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawWire {
    /// Wire diameter; that of the centreline file, if it gives one, holds otherwise.
    #[schemars(extend("x-unit" = "mm", "x-required-when" = "the centreline file does not give it"))]
    pub diameter: Option<Scalar>,
    /// Name of the layer it is counted in.
    #[schemars(extend("x-otherwise" = "the centreline file's, else wire"))]
    pub layer: Option<String>,
    /// Name of its material.
    #[schemars(extend("x-otherwise" = "that of [material] and [bond]"))]
    pub material: Option<String>,
    /// First point of a straight wire, three lengths.
    #[schemars(extend("x-unit" = "mm", "x-required-when" = "there is no file"))]
    pub from: Option<Triple>,
    /// Last point of a straight wire, three lengths.
    #[schemars(extend("x-unit" = "mm", "x-required-when" = "there is no file"))]
    pub to: Option<Triple>,
    /// Centreline text file, relative to the scene's folder.
    #[schemars(extend("x-required-when" = "there is no from and to"))]
    pub file: Option<String>,
    /// Which wire of the file, from 0.
    #[schemars(extend("x-required-when" = "the file has several wires, unless all = true"))]
    pub index: Option<i64>,
    /// Take all wires of the file.
    #[schemars(extend("x-default" = "false"))]
    pub all: Option<bool>,
    /// Initial velocity, three velocities.
    #[schemars(extend("x-unit" = "m/s", "x-default" = "0 m/s"))]
    pub velocity: Option<Triple>,
    /// Initial spin, three angular velocities.
    #[schemars(extend("x-unit" = "rad/s", "x-default" = "0 rad/s"))]
    pub spin: Option<Triple>,
}

/// `[[sphere]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawSphere {
    /// Diameter.
    #[schemars(extend("x-unit" = "mm", "x-required" = true))]
    pub diameter: Option<Scalar>,
    /// Name of its material.
    #[schemars(extend("x-otherwise" = "that of [material] and [bond]"))]
    pub material: Option<String>,
    /// Centre, three lengths.
    #[schemars(extend("x-unit" = "mm", "x-required" = true))]
    pub position: Option<Triple>,
    /// Initial velocity, three velocities.
    #[schemars(extend("x-unit" = "m/s", "x-default" = "0 m/s"))]
    pub velocity: Option<Triple>,
    /// Initial spin, three angular velocities.
    #[schemars(extend("x-unit" = "rad/s", "x-default" = "0 rad/s"))]
    pub spin: Option<Triple>,
}

/// `[time]`.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawTime {
    /// Fraction of the bound on the stable step, above 0 and at most 1.
    #[schemars(extend("x-unit" = "-", "x-default" = "0.8"))]
    pub safety: Option<Scalar>,
    /// How finely a contact is stepped at least: Δt √(k/m*), k its stiffness and m* its effective mass; `safety` is a
    /// factor on it too. A half period, in which two bodies meet and part, takes π over it steps; what is only stable
    /// lets them gain energy.
    #[schemars(extend("x-unit" = "-", "x-default" = "0.4"))]
    pub contact_resolution: Option<Scalar>,
    /// Fixed step.
    #[schemars(extend("x-unit" = "s", "x-otherwise" = "from the bound"))]
    pub step: Option<Scalar>,
    /// Factor on mass.
    #[schemars(extend("x-unit" = "-", "x-default" = "1"))]
    pub mass_scale: Option<Scalar>,
    /// Factor on rotational inertia.
    #[schemars(extend("x-unit" = "-", "x-default" = "1"))]
    pub inertia_scale: Option<Scalar>,
    /// Kinetic over internal energy above which the run says that it is not quasi-static.
    #[schemars(extend("x-unit" = "-", "x-default" = "5 %"))]
    pub kinetic_limit: Option<Scalar>,
    /// Relative difference of the grip forces above which the run says so.
    #[schemars(extend("x-unit" = "-", "x-default" = "5 %"))]
    pub mismatch_limit: Option<Scalar>,
}

/// `[stop]`: the first that holds ends the run.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawStop {
    /// Strain of the body, the grip's displacement over the free length between the particles held; needs a grip.
    #[schemars(extend("x-unit" = "-", "x-required-when" = "no other key of stop is there"))]
    pub strain: Option<Scalar>,
    /// Nominal stress over its peak after a rupture, both as means over two passages of an elastic wave along the body;
    /// needs a grip and a rupture criterion.
    #[schemars(extend("x-unit" = "-", "x-required-when" = "no other key of stop is there"))]
    pub stress_fraction: Option<Scalar>,
    /// Strain beyond the drop, at which nominal stress, in the mean over two passages of a wave, had fallen to 80 % of its
    /// peak after a rupture: shows what is left. Needs a grip and a rupture criterion.
    #[schemars(extend("x-unit" = "-", "x-required-when" = "no other key of stop is there"))]
    pub strain_after_drop: Option<Scalar>,
    /// Simulated time.
    #[schemars(extend("x-unit" = "ms", "x-required-when" = "no other key of stop is there"))]
    pub time: Option<Scalar>,
    /// Number of steps.
    #[schemars(extend("x-required-when" = "no other key of stop is there"))]
    pub steps: Option<i64>,
}
