//! Materials, what their bonds do, and what holds between two of them.

use super::scalar::{RawDamping, Scalar};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[material]`. Defaults: annealed copper.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawMaterial {
    /// Density.
    #[schemars(extend("x-unit" = "kg/m^3", "x-default" = "8960 kg/m^3"))]
    pub density: Option<Scalar>,
    /// Young's modulus.
    #[schemars(extend("x-unit" = "GPa", "x-default" = "115 GPa"))]
    pub young: Option<Scalar>,
    /// Poisson's ratio, above -1 and below 0.5.
    #[schemars(extend("x-unit" = "-", "x-default" = "0.34"))]
    pub poisson: Option<Scalar>,
}

/// `[bond]`.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawBond {
    /// Law of the bonds.
    #[schemars(extend("x-default" = "elastic"))]
    pub law: Option<RawBondLaw>,
    /// Damping as a fraction of critical: one number for all modes, or `{ axial, shear, bending, torsion }`.
    #[schemars(extend("x-unit" = "-", "x-default" = "0"))]
    pub damping: Option<RawDamping>,
    /// Hardening of the elasto-plastic law; refused elsewhere.
    #[schemars(extend("x-required-when" = "law = \"elasto-plastic\""))]
    pub hardening: Option<RawHardening>,
    /// When a bond breaks. Absent: never.
    pub rupture: Option<RawRupture>,
}

/// `bond.law`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawBondLaw {
    /// Linear in all modes.
    Elastic,
    /// Isotropic hardening, coupled section plasticity.
    ElastoPlastic,
}

/// `bond.hardening`. Which keys belong to which form stands at each key.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawHardening {
    /// Form of the law of hardening, true stress over true plastic strain p.
    #[schemars(extend("x-required" = true))]
    pub form: Option<RawForm>,
    /// σ₀ of voce and ludwik.
    #[schemars(extend("x-unit" = "MPa", "x-required-when" = "form = \"voce\" or \"ludwik\""))]
    pub yield_stress: Option<Scalar>,
    /// Q of voce.
    #[schemars(extend("x-unit" = "MPa", "x-default" = "0 MPa"))]
    pub saturation: Option<Scalar>,
    /// b of voce.
    #[schemars(extend("x-unit" = "-", "x-default" = "0", "x-required-when" = "form = \"voce\" has a saturation"))]
    pub rate: Option<Scalar>,
    /// H of voce.
    #[schemars(extend("x-unit" = "MPa", "x-default" = "0 MPa"))]
    pub linear: Option<Scalar>,
    /// K of swift and ludwik.
    #[schemars(extend("x-unit" = "MPa", "x-required-when" = "form = \"swift\" or \"ludwik\""))]
    pub strength: Option<Scalar>,
    /// ε₀ of swift.
    #[schemars(extend("x-unit" = "-", "x-required-when" = "form = \"swift\""))]
    pub prestrain: Option<Scalar>,
    /// n of swift and ludwik.
    #[schemars(extend("x-unit" = "-", "x-required-when" = "form = \"swift\" or \"ludwik\""))]
    pub exponent: Option<Scalar>,
    /// Points [strain, stress]. `table`: true plastic strain, from 0 on, and true stress. `engineering-curve`: the
    /// engineering curve of a single wire, straight between its points, converted with Young's modulus and A =
    /// A₀e^(−p).
    #[schemars(extend("x-required-when" = "form = \"table\" or \"engineering-curve\""))]
    pub points: Option<Vec<[Scalar; 2]>>,
}

/// `bond.hardening.form`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawForm {
    /// σ₀ + Q (1 − e^(−b p)) + H p.
    Voce,
    /// K (ε₀ + p)^n.
    Swift,
    /// σ₀ + K p^n.
    Ludwik,
    /// True stress over true plastic strain, straight between points.
    Table,
    /// Engineering stress over engineering strain of a single wire, converted.
    EngineeringCurve,
}

/// `bond.rupture`. Which keys belong to which criterion stands at each key.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawRupture {
    /// What breaks a bond.
    #[schemars(extend("x-required" = true))]
    pub criterion: Option<RawCriterion>,
    /// Rupture strain of plastic-strain and fibre-strain.
    #[schemars(extend("x-unit" = "-", "x-required-when" = "criterion = \"plastic-strain\" or \"fibre-strain\""))]
    pub strain: Option<Scalar>,
    /// σ_c of beam-stress.
    #[schemars(extend("x-unit" = "MPa", "x-required-when" = "criterion = \"beam-stress\""))]
    pub tensile: Option<Scalar>,
    /// τ_c of beam-stress.
    #[schemars(extend("x-unit" = "MPa", "x-required-when" = "criterion = \"beam-stress\""))]
    pub shear: Option<Scalar>,
    /// β_m of beam-stress, 0 to 1.
    #[schemars(extend("x-unit" = "-", "x-default" = "1"))]
    pub moment_share: Option<Scalar>,
    /// Weibull modulus of the scatter of the rupture value from bond to bond; "inf": no scatter.
    #[schemars(extend("x-unit" = "-", "x-default" = "inf", "x-word" = "inf"))]
    pub weibull_modulus: Option<Scalar>,
}

/// `bond.rupture.criterion`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RawCriterion {
    /// Equivalent plastic strain; needs the elasto-plastic law.
    PlasticStrain,
    /// Beam stresses at the surface.
    BeamStress,
    /// Strain of the outermost fibre.
    FibreStrain,
}

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
    pub materials: Option<Vec<String>>,
    /// Coulomb friction coefficient between bodies of the two.
    #[schemars(extend("x-unit" = "-", "x-required" = true))]
    pub friction: Option<Scalar>,
}
