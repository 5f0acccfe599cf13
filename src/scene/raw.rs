//! A scene as it is written: serde tables, nothing checked but names and kinds of values. This is also the reference
//! of all keys: each with its unit, its default and its meaning; those of grips and holds stand in `raw/drive.rs`.
//!
//! A quantity is text with a unit, `"39 mm"`; any unit of the right kind will do. A ratio may be a plain number or
//! per cent, `0.12` or `"12 %"`. Unknown keys are refused.

mod drive;

use super::look::{ColourBy, Theme, View};
pub use drive::*;
use serde::Deserialize;
use serde::de::{self, Deserializer, MapAccess, Visitor};
use std::fmt;

/// A quantity before its unit is read: text or a plain number.
#[derive(Debug, Clone, PartialEq)]
pub enum Scalar {
    /// `"39 mm"`.
    Text(String),
    /// `0.2`.
    Number(f64),
}

/// A vector of three quantities.
pub type Triple = [Scalar; 3];

/// A whole scene file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawScene {
    /// Name of the scene, also of its folder under `out/`. Default: the file's name without `.toml`.
    pub name: Option<String>,
    /// What the scene shows, one or more sentences. Required.
    pub about: Option<String>,
    /// Seed of the scatter [-]. Default 1.
    pub seed: Option<i64>,
    /// Particle spacing over wire diameter [-]. Default 1: touching spheres.
    pub spacing: Option<Scalar>,
    /// `auto` (default): only the stages that the scene needs; `general`: every stage, for comparison.
    pub plan: Option<RawPlan>,
    /// The wire material.
    pub material: Option<RawMaterial>,
    /// Bonds along the wires. Absent: elastic, undamped, unbreakable.
    pub bond: Option<RawBond>,
    /// Contacts between surfaces. Absent: none at all.
    pub contact: Option<RawContact>,
    /// A strand laid up in helical layers around z.
    pub strand: Option<RawStrand>,
    /// `[[wire]]`: wires given one by one.
    #[serde(default)]
    pub wire: Vec<RawWire>,
    /// `[[sphere]]`: free spheres.
    #[serde(default)]
    pub sphere: Vec<RawSphere>,
    /// The two grips. Absent: free bodies.
    pub grip: Option<RawGrip>,
    /// `[[hold]]`: holds and loads on single bodies.
    #[serde(default)]
    pub hold: Vec<RawHold>,
    /// Time stepping.
    #[serde(default)]
    pub time: RawTime,
    /// When to stop. At least one key is required.
    #[serde(default)]
    pub stop: RawStop,
    /// What to write and how often.
    #[serde(default)]
    pub output: RawOutput,
}

/// `plan`.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawPlan {
    /// Only what the scene needs.
    Auto,
    /// Everything.
    General,
}

/// `[material]`. Defaults: annealed copper.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawMaterial {
    /// Density, "kg/m^3". Default "8960 kg/m^3".
    pub density: Option<Scalar>,
    /// Young's modulus, "GPa". Default "115 GPa".
    pub young: Option<Scalar>,
    /// Poisson's ratio, above -1 and below 0.5 [-]. Default 0.34.
    pub poisson: Option<Scalar>,
}

/// `[bond]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawBond {
    /// `elastic` (default) or `elasto-plastic`.
    pub law: Option<RawBondLaw>,
    /// Damping as a fraction of critical [-]: one number for all modes, or `{ axial, shear, bending, torsion }`.
    /// Default 0.
    pub damping: Option<RawDamping>,
    /// Hardening of the elasto-plastic law; required there and refused elsewhere.
    pub hardening: Option<RawHardening>,
    /// When a bond breaks. Absent: never.
    pub rupture: Option<RawRupture>,
}

/// `bond.law`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawBondLaw {
    /// Linear in all modes.
    Elastic,
    /// Isotropic hardening, coupled section plasticity.
    ElastoPlastic,
}

/// `bond.damping`: one number or one per mode.
#[derive(Debug, Clone)]
pub enum RawDamping {
    /// The same in all modes.
    All(Scalar),
    /// Mode by mode.
    Modes(RawDampingModes),
}

/// `bond.damping` mode by mode.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawDampingModes {
    /// Axial [-]. Default 0.
    pub axial: Option<Scalar>,
    /// Shear [-]. Default 0.
    pub shear: Option<Scalar>,
    /// Bending [-]. Default 0.
    pub bending: Option<Scalar>,
    /// Torsion [-]. Default 0.
    pub torsion: Option<Scalar>,
}

/// `bond.hardening`. Which keys belong to which form stands at each key.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawHardening {
    /// `voce`: σ₀ + Q (1 − e^(−b p)) + H p; `swift`: K (ε₀ + p)^n; `ludwik`: σ₀ + K p^n; `table`;
    /// `engineering-curve`. Required.
    pub form: Option<RawForm>,
    /// σ₀ of voce and ludwik, "MPa". Required there.
    pub yield_stress: Option<Scalar>,
    /// Q of voce, "MPa". Default 0.
    pub saturation: Option<Scalar>,
    /// b of voce [-]. Default 0; required with a saturation.
    pub rate: Option<Scalar>,
    /// H of voce, "MPa". Default 0.
    pub linear: Option<Scalar>,
    /// K of swift and ludwik, "MPa". Required there.
    pub strength: Option<Scalar>,
    /// ε₀ of swift [-]. Required there.
    pub prestrain: Option<Scalar>,
    /// n of swift and ludwik [-]. Required there.
    pub exponent: Option<Scalar>,
    /// Points [strain, stress]. `table`: true plastic strain, from 0 on, and true stress. `engineering-curve`: the
    /// engineering curve of a single wire, straight between its points, converted with Young's modulus and A = A₀e^(−p).
    pub points: Option<Vec<[Scalar; 2]>>,
}

/// `bond.hardening.form`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawForm {
    /// Voce with a linear term.
    Voce,
    /// Swift.
    Swift,
    /// Ludwik.
    Ludwik,
    /// True stress over true plastic strain.
    Table,
    /// Engineering stress over engineering strain.
    EngineeringCurve,
}

/// `bond.rupture`. Which keys belong to which criterion stands at each key.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawRupture {
    /// `plastic-strain`, `beam-stress` or `fibre-strain`. Required.
    pub criterion: Option<RawCriterion>,
    /// Rupture strain of plastic-strain and fibre-strain [-]. Required there.
    pub strain: Option<Scalar>,
    /// σ_c of beam-stress, "MPa". Required there.
    pub tensile: Option<Scalar>,
    /// τ_c of beam-stress, "MPa". Required there.
    pub shear: Option<Scalar>,
    /// β_m of beam-stress, 0 to 1 [-]. Default 1.
    pub moment_share: Option<Scalar>,
    /// Weibull modulus of the scatter of the rupture value from bond to bond [-]. Default "inf": no scatter.
    pub weibull_modulus: Option<Scalar>,
}

/// `bond.rupture.criterion`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawCriterion {
    /// Equivalent plastic strain; needs the elasto-plastic law.
    PlasticStrain,
    /// Beam stresses at the surface.
    BeamStress,
    /// Strain of the outermost fibre.
    FibreStrain,
}

/// `[contact]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawContact {
    /// `hertz`, `thornton`, or `none` for no contacts at all. Required.
    pub normal: Option<RawNormal>,
    /// `mindlin` (default), `mindlin-deresiewicz`, or `none` for frictionless.
    pub tangential: Option<RawTangential>,
    /// Coulomb friction coefficient [-]. Default 0.2; without effect when `tangential = "none"`.
    pub friction: Option<Scalar>,
    /// Shape of a wire in contact: `sphere` (default), a chain of them, or `wire`, smooth.
    pub shape: Option<RawShape>,
    /// Thornton: limiting pressure over yield stress [-]. Default 2.8. Needs an elasto-plastic bond law.
    pub hardness_factor: Option<Scalar>,
    /// Thornton: plastic strain at which that yield stress is taken [-]; Tabor's representative strain is "8 %".
    /// Default 0.
    pub hardness_strain: Option<Scalar>,
    /// Thornton: limiting contact pressure, "MPa", instead of the two keys above.
    pub limiting_pressure: Option<Scalar>,
    /// Viscous damping of the normal motion as a fraction of critical [-]. Default 0.
    pub damping: Option<Scalar>,
    /// Skin of the neighbour list over the largest diameter [-]. Default 0.15.
    pub skin: Option<Scalar>,
}

/// `contact.normal`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawNormal {
    /// Elastic.
    Hertz,
    /// Elastoplastic.
    Thornton,
    /// No contacts.
    None,
}

/// `contact.tangential`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawShape {
    /// A chain of spheres.
    Sphere,
    /// Smooth.
    Wire,
}

/// `[strand]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawStrand {
    /// Length along z, "mm". Required.
    pub length: Option<Scalar>,
    /// Wire diameter of layers that give none, "mm".
    pub wire_diameter: Option<Scalar>,
    /// Pitch of layers that give none, "mm", or "inf" for straight wires.
    pub pitch: Option<Scalar>,
    /// Lay direction of layers that give none. Default `right`.
    pub lay: Option<RawLay>,
    /// Instead of `[[strand.layer]]`: the wires of each layer from the inside out, such as [5, 11, 18], or `auto` for
    /// full rings of copper nearest to `area`; lay radii are least, and all layers have the strand's wire diameter,
    /// pitch and lay.
    pub construction: Option<RawConstruction>,
    /// Copper section of `construction = "auto"`, "mm^2". Required there.
    pub area: Option<Scalar>,
    /// `[[strand.layer]]`, from the inside out. At least one, unless there is a `construction`.
    #[serde(default)]
    pub layer: Vec<RawLayer>,
}

/// `strand.construction`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected \"auto\" or the wires of each layer, such as [5, 11, 18]")]
pub enum RawConstruction {
    /// `"auto"`.
    Named(String),
    /// Wires of each layer, from the inside out.
    Layers(Vec<i64>),
}

/// `[[strand.layer]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawLayer {
    /// Name, used in tables. Default "layer N", N from 1.
    pub name: Option<String>,
    /// Number of wires. Required.
    pub wires: Option<i64>,
    /// Lay radius (axis to wire centre), "mm", or `auto` (default): the least radius without overlap; 0 for a single
    /// wire in the first layer.
    pub lay_radius: Option<Scalar>,
    /// Wire diameter, "mm". Default `strand.wire_diameter`.
    pub wire_diameter: Option<Scalar>,
    /// Pitch, "mm" or "inf". Default `strand.pitch`; "inf" for a single wire on the axis when that is absent too.
    pub pitch: Option<Scalar>,
    /// Lay direction. Default `strand.lay`.
    pub lay: Option<RawLay>,
    /// Angle of the first wire at z = 0, "deg". Default 0.
    pub phase: Option<Scalar>,
}

/// Lay direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawLay {
    /// Z lay.
    Right,
    /// S lay.
    Left,
}

/// `[[wire]]`: either `from` and `to`, or `file`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawWire {
    /// Wire diameter, "mm". Required, unless the centreline file gives it.
    pub diameter: Option<Scalar>,
    /// Name of the layer it is counted in. Default: the centreline file's, else "wire".
    pub layer: Option<String>,
    /// First point of a straight wire, three lengths.
    pub from: Option<Triple>,
    /// Last point of a straight wire, three lengths.
    pub to: Option<Triple>,
    /// Centreline text file, relative to the scene's folder.
    pub file: Option<String>,
    /// Which wire of the file, from 0. May be left out when the file has one wire.
    pub index: Option<i64>,
    /// Take all wires of the file. Default false.
    pub all: Option<bool>,
    /// Initial velocity, three velocities. Default 0.
    pub velocity: Option<Triple>,
    /// Initial spin, three angular velocities. Default 0.
    pub spin: Option<Triple>,
}

/// `[[sphere]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawSphere {
    /// Diameter, "mm". Required.
    pub diameter: Option<Scalar>,
    /// Centre, three lengths. Required.
    pub position: Option<Triple>,
    /// Initial velocity, three velocities. Default 0.
    pub velocity: Option<Triple>,
    /// Initial spin, three angular velocities. Default 0.
    pub spin: Option<Triple>,
}

/// `[time]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawTime {
    /// Fraction of the bound on the stable step, above 0 and at most 1 [-]. Default 0.8.
    pub safety: Option<Scalar>,
    /// How finely a contact is stepped at least: Δt √(k/m*), k its stiffness and m* its effective mass [-]; `safety`
    /// is a factor on it too. A half period, in which two bodies meet and part, takes π over it steps; what is only
    /// stable lets them gain energy. Default 0.4.
    pub contact_resolution: Option<Scalar>,
    /// Fixed step, "s". Default: from the bound.
    pub step: Option<Scalar>,
    /// Factor on mass [-]. Default 1.
    pub mass_scale: Option<Scalar>,
    /// Factor on rotational inertia [-]. Default 1.
    pub inertia_scale: Option<Scalar>,
    /// Kinetic over internal energy above which the run says that it is not quasi-static [-]. Default "5 %".
    pub kinetic_limit: Option<Scalar>,
    /// Relative difference of the grip forces above which the run says so [-]. Default "5 %".
    pub mismatch_limit: Option<Scalar>,
}

/// `[stop]`: the first that holds ends the run.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawStop {
    /// Grip displacement over gauge length [-]; needs a grip.
    pub strain: Option<Scalar>,
    /// Nominal stress over its peak, after a rupture [-]; needs a grip and a rupture criterion.
    pub stress_fraction: Option<Scalar>,
    /// Strain beyond the drop, at which nominal stress had fallen to 80 % of its peak after a rupture [-]: shows what is
    /// left. Needs a grip and a rupture criterion.
    pub strain_after_drop: Option<Scalar>,
    /// Simulated time, "ms".
    pub time: Option<Scalar>,
    /// Number of steps.
    pub steps: Option<i64>,
}

/// `[output]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawOutput {
    /// Number of curve samples over the planned run, four times denser after the first rupture. Default 2000.
    pub samples: Option<i64>,
    /// Number of snapshots (recording and frames), evenly spread over the planned run; ruptures bring more, up to four
    /// times as many. Default 160, or 60 where bonds can break.
    pub snapshots: Option<i64>,
    /// How many times denser than that snapshots are right after a rupture [-]; with 1 a rupture brings only the last
    /// state before it and the first one after it. Default 40.
    pub rupture_density: Option<Scalar>,
    /// Width and height of frames in pixels. Default [1280, 720].
    pub frame_size: Option<[i64; 2]>,
    /// What colours the wires: `stress` (default), `plastic-strain`, `utilisation` (to rupture),
    /// `contact-pressure`, `layer`, `wire`, `velocity`.
    pub colour: Option<ColourBy>,
    /// Panels of a frame, such as ["overview", "midsection"]; every word stands in [`View`]. Default: those that suit
    /// the scene.
    pub views: Option<Vec<View>>,
    /// Ground of the frames: `dark` (default), for screens, or `light`, for paper.
    pub theme: Option<Theme>,
    /// Viewpoint of the frames.
    #[serde(default)]
    pub camera: RawCamera,
}

/// `[output.camera]`: the viewpoint of the three-dimensional panels. The strand's axis z points right, y points up, the
/// eye looks along +x.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawCamera {
    /// Turn of the eye about the vertical, "deg". Default 0.
    pub azimuth: Option<Scalar>,
    /// Turn of the eye about the horizontal, "deg"; at azimuth 0 that turns the strand about its axis. Default 0.
    pub elevation: Option<Scalar>,
    /// Magnification over what fits a panel [-]. Default 1.
    pub zoom: Option<Scalar>,
    /// Section that the close-up follows: z before loading, "mm". Default: mid-length, then the first rupture.
    pub focus_z: Option<Scalar>,
}

impl fmt::Display for Scalar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Scalar::Text(text) => write!(f, "{text:?}"),
            Scalar::Number(number) => write!(f, "{number}"),
        }
    }
}

impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ScalarVisitor)
    }
}

struct ScalarVisitor;

impl Visitor<'_> for ScalarVisitor {
    type Value = Scalar;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or text with a unit")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Scalar, E> {
        Ok(Scalar::Text(text.to_owned()))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<Scalar, E> {
        Ok(Scalar::Number(number as f64))
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<Scalar, E> {
        Ok(Scalar::Number(number as f64))
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<Scalar, E> {
        Ok(Scalar::Number(number))
    }
}

impl<'de> Deserialize<'de> for RawDamping {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(DampingVisitor)
    }
}

struct DampingVisitor;

impl<'de> Visitor<'de> for DampingVisitor {
    type Value = RawDamping;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or { axial, shear, bending, torsion }")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<RawDamping, E> {
        ScalarVisitor.visit_str(text).map(RawDamping::All)
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<RawDamping, E> {
        ScalarVisitor.visit_i64(number).map(RawDamping::All)
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<RawDamping, E> {
        ScalarVisitor.visit_f64(number).map(RawDamping::All)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawDamping, A::Error> {
        RawDampingModes::deserialize(de::value::MapAccessDeserializer::new(map)).map(RawDamping::Modes)
    }
}
