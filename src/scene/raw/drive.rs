//! Grips and holds as they are written.

use super::{Scalar, Triple};
use serde::Deserialize;

/// `[grip]`: either `speed`, or `displacement_amplitude` and `frequency`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawGrip {
    /// `all` (default): every wire is held; `jaw`: the outermost layer only, pressed inwards.
    pub kind: Option<RawGripKind>,
    /// Length of each grip along z, "mm". Required.
    pub length: Option<Scalar>,
    /// Radial clamp pressure of a jaw, "MPa". Required there and refused elsewhere.
    pub clamp_pressure: Option<Scalar>,
    /// Speed of the upper grip along z, "m/s"; positive pulls. Constant, unless `adaptive` is there.
    pub speed: Option<Scalar>,
    /// Pulls faster than `speed` between the start and the first rupture. Absent: `speed` is constant.
    pub adaptive: Option<RawAdaptive>,
    /// Amplitude of a sinusoidal displacement, "mm".
    pub displacement_amplitude: Option<Scalar>,
    /// Frequency of that displacement, "Hz".
    pub frequency: Option<Scalar>,
    /// Rotation rate of the upper grip about z, "rad/s". Default 0.
    pub rotation_rate: Option<Scalar>,
    /// The upper grip turns freely about z. Default false.
    pub free_rotation: Option<bool>,
}

/// `grip.adaptive`: `speed` is that of the start and, until the end, of ruptures; in between the pull is as fast as all of
/// these allow. Changes of speed are spread over time and over the whole body, which is sped up as it flows.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawAdaptive {
    /// Strain up to which the pull stays at `speed` [-]: that at which gaps between layers have closed. How they do decides
    /// where single wires are strained most later on, and another speed there gives another strand. Default 0.
    pub from: Option<Scalar>,
    /// Greatest speed, "m/s", at least `grip.speed`. Required.
    pub fastest: Option<Scalar>,
    /// Greatest kinetic energy of the pull over the work that it has done, at most 1 [-]. Default "4 %".
    pub kinetic: Option<Scalar>,
    /// Least time to the next rupture at the speed of any moment, in passages of an elastic wave from grip to grip [-].
    /// The next rupture is where the bond nearest to its limit reaches it at its mean rate so far. Default 20.
    pub passages: Option<Scalar>,
}

/// `grip.kind`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawGripKind {
    /// Every wire.
    All,
    /// The outermost layer.
    Jaw,
}

/// `[[hold]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawHold {
    /// Body number from 0: strand wires inside out, then `[[wire]]`, then `[[sphere]]`. Required.
    pub body: Option<i64>,
    /// `start`, `end` or `all` (default).
    pub part: Option<RawPart>,
    /// Prescribed components, of `x y z rx ry rz`. Default none.
    #[serde(default)]
    pub fix: Vec<RawFix>,
    /// Velocity of the prescribed x, y, z, three velocities. Default 0.
    pub velocity: Option<Triple>,
    /// Spin of the prescribed rx, ry, rz, three angular velocities. Default 0.
    pub spin: Option<Triple>,
    /// Total force on the part, three forces. Default 0.
    pub force: Option<Triple>,
    /// Total moment on the part, three moments. Default 0.
    pub moment: Option<Triple>,
    /// Time over which force and moment rise smoothly from zero, "ms". Default 0.
    pub ramp: Option<Scalar>,
}

/// `hold.part`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RawPart {
    /// First particle.
    Start,
    /// Last particle.
    End,
    /// All particles.
    All,
}

/// An element of `hold.fix`, in the order of [`super::spec::HoldSpec::fixed`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
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
