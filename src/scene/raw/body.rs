//! Rigid bodies as they are written.

use super::scalar::{Scalar, Triple};
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::IgnoredAny;

/// `[[body]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawBody {
    /// Its name in results, that of no other body.
    #[schemars(extend("x-otherwise" = "body 1, body 2, ..."))]
    pub name: Option<String>,
    /// Its shape.
    #[schemars(extend("x-required" = true))]
    pub shape: Option<RawBodyShape>,
    /// Where it begins, three lengths: a point of a plane, the middle of a cylinder, the centre of a sphere.
    #[schemars(extend("x-unit" = "mm", "x-required" = true))]
    pub position: Option<Triple>,
    /// Of a plane: three numbers, a direction of any length that points to where wires and spheres are.
    #[schemars(extend("x-unit" = "-", "x-required-when" = "shape = \"plane\""))]
    pub normal: Option<Triple>,
    /// Of a cylinder, or of a sphere that spins: three numbers, a direction of any length.
    #[schemars(extend("x-unit" = "-", "x-required-when" = "shape = \"cylinder\", or a sphere spins"))]
    pub axis: Option<Triple>,
    /// Of a cylinder or sphere.
    #[schemars(extend("x-unit" = "mm", "x-required-when" = "shape is not \"plane\""))]
    pub diameter: Option<Scalar>,
    /// Of a cylinder, between the hemispheres in which it then ends.
    #[schemars(extend("x-unit" = "mm", "x-otherwise" = "it is endless"))]
    pub length: Option<Scalar>,
    /// Its velocity at full speed, three velocities.
    #[schemars(extend("x-unit" = "m/s", "x-default" = "0 m/s"))]
    pub velocity: Option<Triple>,
    /// Its spin at full speed, right-handed about the axis, or the normal of a plane at `position`.
    #[schemars(extend("x-unit" = "rad/s", "x-default" = "0 rad/s"))]
    pub spin: Option<Scalar>,
    /// Time in which its motion rises smoothly to full speed, and in which it falls before it ends.
    #[schemars(extend("x-unit" = "ms", "x-default" = "0 ms"))]
    pub ramp: Option<Scalar>,
    /// How far it moves along its velocity before it stands still again; at least what the two ramps take. Its spin ends at
    /// the same time.
    #[schemars(extend("x-unit" = "mm", "x-otherwise" = "what duration says"))]
    pub travel: Option<Scalar>,
    /// When it stands still again, at least two ramps; refused beside `travel`.
    #[schemars(extend("x-unit" = "ms", "x-otherwise" = "it moves until the end"))]
    pub duration: Option<Scalar>,
    /// Name of its material, whose elasticity its surface has. It does not yield: limiting pressures are those of wires and
    /// spheres.
    #[schemars(extend("x-otherwise" = "that of [material]"))]
    pub material: Option<String>,
    /// Coulomb friction coefficient with all wires and spheres; contact.pair says nothing of rigid bodies.
    #[schemars(extend("x-unit" = "-", "x-otherwise" = "contact.friction"))]
    pub friction: Option<Scalar>,
    /// Refused with words.
    #[schemars(skip)]
    pub mass: Option<IgnoredAny>,
    /// Refused with words.
    #[schemars(skip)]
    pub groove_radius: Option<IgnoredAny>,
}

/// `body.shape`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawBodyShape {
    /// A half space.
    Plane,
    /// A pin, mandrel or roller.
    Cylinder,
    /// A ball.
    Sphere,
}
