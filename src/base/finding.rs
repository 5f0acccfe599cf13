//! What a run can find out about itself, as facts: what should be known before it is believed ([`Finding`]), why it had
//! to stop ([`Failure`]), what limited its time step ([`StepLimit`]), why it ended ([`StopReason`]). SI units; the words for
//! them stand in [`super::wording`] and nowhere else, so that nothing decides by a sentence.
//!
//! In JSON each has a `kind`, and its values with their units in the keys.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A wire or a free sphere, counted from 1 as in every table, or a rigid body.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Body {
    /// A wire.
    Wire {
        /// Number of the wire.
        wire: usize,
        /// Name of its layer.
        layer: String,
    },
    /// A free sphere.
    Sphere {
        /// Number of the sphere among the free ones.
        sphere: usize,
    },
    /// A rigid body.
    Rigid {
        /// Its name.
        body: String,
    },
}

impl Default for Body {
    fn default() -> Self {
        Self::Sphere { sphere: 0 }
    }
}

/// A bond or particle, counted from 1 along its body.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Member {
    /// Its number; free spheres have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub number: Option<usize>,
    /// The body.
    #[serde(flatten)]
    pub body: Body,
}

/// The part of a bond's or contact's stiffness that limits the time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StiffnessMode {
    /// Nothing is stiff.
    #[default]
    None,
    /// Tension of a bond.
    Axial,
    /// Shear of a bond.
    Shear,
    /// Bending of a bond.
    Bending,
    /// Torsion of a bond, or spin of a contact.
    Torsion,
    /// Pressure of a contact.
    Normal,
    /// Friction of a contact.
    Tangential,
    /// Duration of a contact, which takes some steps to resolve.
    Duration,
}

/// A bond or a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Element {
    /// A bond between two particles of a wire.
    Bond,
    /// A contact between two bodies.
    Contact,
}

/// What limits the time step.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum StepLimit {
    /// Nothing is stiff, and nothing moves fast.
    #[default]
    None,
    /// The scene fixes it.
    Scene {
        /// The bound on the stable step (s); `None` when nothing is stiff.
        bound_s: Option<f64>,
    },
    /// The fastest particle may move by this share of the least radius in a step (-).
    Travel {
        /// The share.
        share_of_radius: f64,
    },
    /// The shortest impact of a free sphere takes at least this many steps.
    Impact {
        /// The steps.
        steps: f64,
    },
    /// The stiffest element.
    Stiffness {
        /// Its mode.
        mode: StiffnessMode,
        /// What it is.
        element: Element,
        /// Where it is.
        body: Body,
        /// The bound on the stable step (s).
        bound_s: f64,
        /// Factor on the bound, `time.safety` (-).
        safety: f64,
    },
}

/// What takes load off the contacts of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Relief {
    /// A lower speed.
    Speed,
    /// A lower clamping pressure or speed of a jaw.
    Clamp,
}

/// What may lie behind a stiffness other than strand theory's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StiffnessCause {
    /// Touching spheres of one layer fall into the saddles of the next: too soft.
    Spheres,
    /// Layers close in, contacts are soft, or the pull is fast: too soft.
    Soft,
    /// Wires overlap from the start, or the pull is fast: too stiff.
    Stiff,
}

/// Something that must be known before a run is believed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Finding {
    /// A contact deeper than its law is made for.
    DeepContact {
        /// Overlap over the smaller radius (-).
        overlap_over_radius: f64,
        /// The two bodies.
        between: [Body; 2],
        /// Where (m).
        z_m: f64,
        /// Normal force (N).
        force_n: f64,
        /// Force over the area of the contact (Pa): πR*δ of a circle, Σ √(2R*δ) ds of a patch along a smooth wire.
        pressure_pa: f64,
        /// What would help.
        relief: Relief,
    },
    /// The step that the scene fixes is above the bound.
    UnstableStep {
        /// The step (s).
        step_s: f64,
        /// The bound (s).
        bound_s: f64,
        /// The limiting mode.
        mode: StiffnessMode,
        /// Of what.
        element: Element,
        /// Where.
        body: Body,
    },
    /// The step has become much smaller than the first.
    StepShrunk {
        /// The first step (s).
        from_s: f64,
        /// The step now (s).
        to_s: f64,
        /// What limits it.
        limit: StepLimit,
    },
    /// Strain localises in one bond (Considère 1885): elongation hangs on the spacing.
    Necking {
        /// The bond.
        bond: Member,
        /// Where (m).
        z_m: f64,
        /// Its plastic strain (-).
        plastic_strain: f64,
        /// That of the rest of its wire, which has stopped (-).
        others: f64,
        /// Plastic strain at the maximum load, dσ/dε = σ (-).
        maximum_load: f64,
    },
    /// A straight body has turned back on itself and got contacts.
    ContactsAdded {
        /// The body.
        body: Body,
    },
    /// Bonds are longer than a neighbour search covers.
    BondsStretched {
        /// Length of the longest over that at rest (-).
        stretch: f64,
        /// What is covered (-).
        covered: f64,
    },
    /// Loading was over before it could be judged.
    TooShort {
        /// Passages of an elastic wave along the body.
        passages: f64,
        /// How many belong to the start.
        start: f64,
    },
    /// The two grip forces differed.
    GripForcesDiffer {
        /// Greatest difference over the peak force (-).
        mismatch: f64,
        /// `time.mismatch_limit` (-).
        limit: f64,
    },
    /// Kinetic energy was not small.
    KineticEnergy {
        /// Kinetic over internal energy (-).
        over_internal: f64,
        /// `time.kinetic_limit` (-).
        limit: f64,
    },
    /// Energy has vanished or come from nowhere.
    LedgerOpen {
        /// What is missing, negative for what came from nowhere (J).
        missing_j: f64,
        /// That over the work done (-).
        over_work: f64,
    },
    /// The initial stiffness is not what strand theory expects.
    Stiffness {
        /// By strand theory (Pa).
        expected_pa: f64,
        /// Measured on the curve (Pa).
        measured_pa: f64,
        /// Measured over expected − 1 (-).
        deviation: f64,
        /// Strains between which it was measured (-).
        window: [f64; 2],
        /// What may be behind it.
        cause: StiffnessCause,
    },
    /// The simulation had to stop.
    Failed {
        /// Why.
        failure: Failure,
    },
}

/// The kinds of [`Finding`], for those who ask whether one was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum FindingKind {
    /// [`Finding::DeepContact`].
    DeepContact,
    /// [`Finding::UnstableStep`].
    UnstableStep,
    /// [`Finding::StepShrunk`].
    StepShrunk,
    /// [`Finding::Necking`].
    Necking,
    /// [`Finding::ContactsAdded`].
    ContactsAdded,
    /// [`Finding::BondsStretched`].
    BondsStretched,
    /// [`Finding::TooShort`].
    TooShort,
    /// [`Finding::GripForcesDiffer`].
    GripForcesDiffer,
    /// [`Finding::KineticEnergy`].
    KineticEnergy,
    /// [`Finding::LedgerOpen`].
    LedgerOpen,
    /// [`Finding::Stiffness`].
    Stiffness,
    /// [`Finding::Failed`].
    Failed,
}

impl Finding {
    /// Its kind.
    pub fn kind(&self) -> FindingKind {
        match self {
            Self::DeepContact { .. } => FindingKind::DeepContact,
            Self::UnstableStep { .. } => FindingKind::UnstableStep,
            Self::StepShrunk { .. } => FindingKind::StepShrunk,
            Self::Necking { .. } => FindingKind::Necking,
            Self::ContactsAdded { .. } => FindingKind::ContactsAdded,
            Self::BondsStretched { .. } => FindingKind::BondsStretched,
            Self::TooShort { .. } => FindingKind::TooShort,
            Self::GripForcesDiffer { .. } => FindingKind::GripForcesDiffer,
            Self::KineticEnergy { .. } => FindingKind::KineticEnergy,
            Self::LedgerOpen { .. } => FindingKind::LedgerOpen,
            Self::Stiffness { .. } => FindingKind::Stiffness,
            Self::Failed { .. } => FindingKind::Failed,
        }
    }
}

/// A quantity of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case")]
pub enum Quantity {
    /// Simulated time.
    Time,
    /// Strain of the body.
    Strain,
    /// Nominal stress of the body.
    NominalStress,
    /// Force on the lower grip.
    LowerGripForce,
    /// Force on the upper grip.
    UpperGripForce,
    /// Torque on the grips.
    Torque,
    /// Work done on the body.
    Work,
    /// Kinetic energy.
    KineticEnergy,
    /// Internal energy.
    InternalEnergy,
    /// Nominal stress of one wire.
    WireStress {
        /// Number of the wire, from 1.
        wire: usize,
    },
}

/// Why a simulation had to stop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Failure {
    /// A measured value is not finite.
    NotFinite {
        /// Which.
        quantity: Quantity,
    },
    /// A particle moves further in one step than any bound allows.
    Runaway {
        /// The particle.
        particle: Member,
        /// How far it moved (m); `None` when its position is not a number.
        moved_m: Option<f64>,
        /// How far it may move (m).
        limit_m: f64,
        /// The same over the least radius (-).
        limit_over_radius: f64,
        /// The step taken (s).
        step_s: f64,
        /// The bound on it (s); `None` when nothing was stiff.
        bound_s: Option<f64>,
    },
    /// Motion turns round at every step.
    UnstableMotion,
    /// Energy worth a large share of the work is unaccounted for.
    LedgerOpen {
        /// What is missing, negative for what came from nowhere (J).
        missing_j: f64,
        /// That over the work done (-).
        over_work: f64,
    },
    /// Two bodies have passed through each other: the axes of two wires have crossed, or the centre of a free sphere lies
    /// inside another body.
    PassedThrough {
        /// The two bonds, or the free sphere, the smaller of two, and what it is in.
        between: [Member; 2],
        /// Where (m).
        z_m: f64,
        /// What would help.
        relief: Relief,
    },
    /// A body bends whose rotations were left out.
    Bends {
        /// The body.
        body: Body,
        /// Where (m).
        z_m: f64,
    },
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum StopReason {
    /// The strain of the body reached its limit.
    Strain {
        /// `stop.strain` (-).
        limit: f64,
        /// The strain (-).
        reached: f64,
    },
    /// Nominal stress fell below a share of its peak, both as means over two passages of an elastic wave along the body.
    StressFraction {
        /// `stop.stress_fraction` (-).
        limit: f64,
        /// The share (-).
        reached: f64,
    },
    /// The strain of the body went on beyond the drop, at which nominal stress, as the same mean, fell to 80 % of its peak.
    AfterDrop {
        /// `stop.strain_after_drop` (-).
        limit: f64,
        /// The strain since the drop (-).
        reached: f64,
    },
    /// Simulated time reached its limit.
    Time {
        /// `stop.time` (s).
        limit_s: f64,
        /// The time (s).
        reached_s: f64,
    },
    /// Steps reached their limit.
    Steps {
        /// `stop.steps`.
        limit: u64,
        /// Steps done.
        reached: u64,
    },
    /// Someone asked for it (Ctrl-C).
    Interrupted,
    /// The simulation failed; everything seen before it was kept.
    Failed,
    /// Nobody knows: the run was killed.
    #[default]
    Unknown,
}

impl StopReason {
    /// Whether somebody or something ended the run before its own conditions did.
    pub fn cut_short(self) -> bool {
        matches!(self, Self::Interrupted | Self::Failed | Self::Unknown)
    }
}

/// A moment of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Instant {
    /// Step.
    pub step: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Strain of the body (-); `None` without grips.
    pub strain: Option<f64>,
}

/// A finding and when it was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Notice {
    /// When.
    pub at: Instant,
    /// What. As JSON also in binary files: only there a tagged enum can be read back.
    #[serde(with = "json")]
    pub finding: Finding,
}

/// A failure and when it came.
#[derive(Debug, Clone, PartialEq)]
pub struct Stopped {
    /// When.
    pub at: Instant,
    /// Why.
    pub failure: Failure,
    /// What is left of the run, when it was written somewhere.
    pub kept: Option<KeptResults>,
}

/// What a run that failed has left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeptResults {
    /// Folder of its results.
    pub folder: PathBuf,
    /// Findings made before the failure.
    pub earlier: usize,
}

/// For serde's `with`: a value as JSON text, where a binary format cannot hold its untagged enums.
pub mod json {
    use serde::de::{DeserializeOwned, Error as _};
    use serde::ser::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// Writes the text.
    pub fn serialize<T: Serialize, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
        serde_json::to_string(value).map_err(S::Error::custom)?.serialize(serializer)
    }

    /// Reads the text.
    pub fn deserialize<'de, T: DeserializeOwned, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
        serde_json::from_str(&String::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_comes_back_from_json_with_its_kind_and_from_a_binary_record() {
        let body = Body::Wire { wire: 3, layer: "outer".into() };
        let limit = StepLimit::Stiffness {
            mode: StiffnessMode::Bending,
            element: Element::Bond,
            body: body.clone(),
            bound_s: 1e-8,
            safety: 0.8,
        };
        let particle = Member { number: Some(5), body: body.clone() };
        let failure =
            Failure::PassedThrough { between: [particle.clone(), particle], z_m: 1e-3, relief: Relief::Clamp };
        let between = [Body::Rigid { body: "pin".into() }, Body::Sphere { sphere: 1 }];
        for (kind, finding) in [
            ("step-shrunk", Finding::StepShrunk { from_s: 1e-7, to_s: 1e-8, limit }),
            ("failed", Finding::Failed { failure }),
            (
                "deep-contact",
                Finding::DeepContact {
                    overlap_over_radius: 0.1,
                    between,
                    z_m: 0.01,
                    force_n: 1.0,
                    pressure_pa: 1e8,
                    relief: Relief::Speed,
                },
            ),
        ] {
            let json = serde_json::to_value(&finding).unwrap();
            assert_eq!(json["kind"], kind);
            assert_eq!(serde_json::from_value::<Finding>(json).unwrap(), finding);
            let notice = Notice { at: Instant { step: 1, time: 2.0, strain: None }, finding };
            let bytes = postcard::to_stdvec(&notice).unwrap();
            assert_eq!(postcard::from_bytes::<Notice>(&bytes).unwrap(), notice);
        }
    }

    #[test]
    fn stop_reasons_come_back_from_json() {
        let strain = StopReason::Strain { limit: 0.3, reached: 0.301 };
        let steps = StopReason::Steps { limit: 7, reached: 7 };
        for reason in [strain, steps, StopReason::Interrupted, StopReason::Unknown] {
            let json = serde_json::to_string(&reason).unwrap();
            assert_eq!(serde_json::from_str::<StopReason>(&json).unwrap(), reason, "{json}");
        }
    }

    #[test]
    fn a_reason_to_stop_gives_the_limit_and_what_was_reached_with_units() {
        let json = serde_json::to_value(StopReason::Time { limit_s: 1e-3, reached_s: 1.0001e-3 }).unwrap();
        assert_eq!(json, serde_json::json!({ "kind": "time", "limit_s": 1e-3, "reached_s": 1.0001e-3 }));
    }
}
