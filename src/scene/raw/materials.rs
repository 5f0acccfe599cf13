//! Named materials and what holds between two of them.

use super::{RawBondLaw, RawDamping, RawHardening, RawRupture, Scalar};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[materials.NAME]`: all that `[material]` and `[bond]` say, for the bodies that name it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawNamedMaterial {
    /// Density.
    #[schemars(extend("x-unit" = "kg/m^3", "x-required" = true))]
    pub density: Option<Scalar>,
    /// Young's modulus.
    #[schemars(extend("x-unit" = "GPa", "x-required" = true))]
    pub young: Option<Scalar>,
    /// Poisson's ratio, above -1 and below 0.5.
    #[schemars(extend("x-unit" = "-", "x-required" = true))]
    pub poisson: Option<Scalar>,
    /// Law of its bonds.
    #[schemars(extend("x-default" = "elastic"))]
    pub law: Option<RawBondLaw>,
    /// Damping of its bonds as a fraction of critical, as bond.damping.
    #[schemars(extend("x-unit" = "-", "x-otherwise" = "bond.damping"))]
    pub damping: Option<RawDamping>,
    /// Hardening of the elasto-plastic law, as bond.hardening; refused elsewhere.
    #[schemars(extend("x-required-when" = "law = \"elasto-plastic\""))]
    pub hardening: Option<RawHardening>,
    /// When one of its bonds breaks, as bond.rupture. Absent: never.
    pub rupture: Option<RawRupture>,
    /// Thornton: limiting pressure over yield stress.
    #[schemars(extend("x-unit" = "-", "x-otherwise" = "contact.hardness_factor"))]
    pub hardness_factor: Option<Scalar>,
    /// Thornton: plastic strain at which that yield stress is taken.
    #[schemars(extend("x-unit" = "-", "x-otherwise" = "contact.hardness_strain"))]
    pub hardness_strain: Option<Scalar>,
    /// Thornton: limiting contact pressure of two bodies of this material, instead of the two keys above. Between unlike
    /// materials the lower one holds.
    #[schemars(extend("x-unit" = "MPa", "x-otherwise" = "contact.limiting_pressure, else from the hardening law"))]
    pub limiting_pressure: Option<Scalar>,
}

/// `[[contact.pair]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawContactPair {
    /// Names of two materials, which may be the same.
    #[schemars(extend("x-required" = true))]
    pub materials: Option<[String; 2]>,
    /// Coulomb friction coefficient between bodies of the two.
    #[schemars(extend("x-unit" = "-", "x-required" = true))]
    pub friction: Option<Scalar>,
}
