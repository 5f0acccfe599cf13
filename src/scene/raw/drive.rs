//! Grips and holds as they are written.

use super::scalar::{Scalar, Triple};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[grip]`: either `speed`, or `displacement_amplitude` and `frequency`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawGrip {
    /// What the grips hold.
    #[schemars(extend("x-default" = "all"))]
    pub kind: Option<RawGripKind>,
    /// Length of each grip along z.
    #[schemars(extend("x-unit" = "mm", "x-required" = true))]
    pub length: Option<Scalar>,
    /// Radial clamp pressure of a jaw; refused elsewhere.
    #[schemars(extend("x-unit" = "MPa", "x-required-when" = "kind = \"jaw\""))]
    pub clamp_pressure: Option<Scalar>,
    /// Speed of the upper grip along z; positive pulls. Constant, unless `adaptive` is there.
    #[schemars(extend("x-unit" = "m/s", "x-required-when" = "there are no displacement_amplitude and frequency"))]
    pub speed: Option<Scalar>,
    /// Pulls faster than `speed`, which must be above zero, between the start and the first rupture. Absent: `speed` is constant.
    pub adaptive: Option<RawAdaptive>,
    /// Amplitude of a sinusoidal displacement.
    #[schemars(extend("x-unit" = "mm", "x-required-when" = "there is no speed"))]
    pub displacement_amplitude: Option<Scalar>,
    /// Frequency of that displacement.
    #[schemars(extend("x-unit" = "Hz", "x-required-when" = "there is no speed"))]
    pub frequency: Option<Scalar>,
    /// Rotation rate of the upper grip about z; refused beside `free_rotation = true`.
    #[schemars(extend("x-unit" = "rad/s", "x-default" = "0 rad/s"))]
    pub rotation_rate: Option<Scalar>,
    /// The upper grip turns freely about z.
    #[schemars(extend("x-default" = "false"))]
    pub free_rotation: Option<bool>,
}

/// `grip.adaptive`: `speed` is that of the start and, until the end, of ruptures; in between the pull is as fast as all of
/// these allow. Changes of speed are spread over time and over the whole body, which is sped up as it flows.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawAdaptive {
    /// Strain up to which the pull stays at `speed`: that at which gaps between layers have closed. How they do
    /// decides where single wires are strained most later on, and another speed there gives another strand.
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub from: Option<Scalar>,
    /// Greatest speed, at least `grip.speed`.
    #[schemars(extend("x-unit" = "m/s", "x-required" = true))]
    pub fastest: Option<Scalar>,
    /// Greatest kinetic energy of the pull over the work that it has done, at most 1.
    #[schemars(extend("x-unit" = "-", "x-default" = "4 %"))]
    pub kinetic: Option<Scalar>,
    /// Least time to the next rupture at the speed of any moment, in passages of an elastic wave from grip to grip.
    /// The next rupture is where the bond nearest to its limit reaches it at its mean rate so far.
    #[schemars(extend("x-unit" = "-", "x-default" = "20"))]
    pub passages: Option<Scalar>,
}

/// `grip.kind`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawGripKind {
    /// Every wire is held.
    All,
    /// The outermost layer only, pressed inwards.
    Jaw,
}

/// `[[hold]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawHold {
    /// Body number from 0: strand wires inside out, then `[[wire]]`, then `[[sphere]]`; a `[[body]]` is not among them. Results count wires, and free
    /// spheres among themselves, from 1.
    #[schemars(extend("x-required" = true))]
    pub body: Option<i64>,
    /// Which particles.
    #[schemars(extend("x-default" = "all"))]
    pub part: Option<RawPart>,
    /// Prescribed components.
    #[schemars(extend("x-otherwise" = "none"))]
    #[serde(default)]
    pub fix: Vec<RawFix>,
    /// Velocity of the prescribed x, y, z, three velocities.
    #[schemars(extend("x-unit" = "m/s", "x-default" = "0 m/s"))]
    pub velocity: Option<Triple>,
    /// Spin of the prescribed rx, ry, rz, three angular velocities.
    #[schemars(extend("x-unit" = "rad/s", "x-default" = "0 rad/s"))]
    pub spin: Option<Triple>,
    /// Total force on the part, three forces.
    #[schemars(extend("x-unit" = "N", "x-default" = "0 N"))]
    pub force: Option<Triple>,
    /// Total moment on the part, three moments.
    #[schemars(extend("x-unit" = "N mm", "x-default" = "0 N mm"))]
    pub moment: Option<Triple>,
    /// Time over which force and moment rise smoothly from zero.
    #[schemars(extend("x-unit" = "ms", "x-default" = "0 ms"))]
    pub ramp: Option<Scalar>,
}

/// `hold.part`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawPart {
    /// First particle.
    Start,
    /// Last particle.
    End,
    /// All particles.
    All,
}

/// An element of `hold.fix`, in the order of [`crate::scene::spec::HoldSpec::fixed`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawFix {
    /// Displacement along x.
    X,
    /// Displacement along y.
    Y,
    /// Displacement along z.
    Z,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}
