//! Geometry that cannot be built, with the key of the scene that is to blame.

use crate::base::error::Error;
use crate::strand::lay_radius::{Clash, LayRadiusError};

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BuildErrorKind {
    /// The scene has no body.
    Empty,
    /// A lay radius at which wires overlap.
    LayRadius,
    /// A layer whose wires overlap at every lay radius.
    NoLayRadius,
    /// Bodies that overlap.
    Overlap,
    /// A wire shorter than the spacing of its particles.
    TooShort,
    /// A wire that turns too far between neighbouring particles.
    TooFewParticles,
    /// A centre line that is none: fewer than two points, a value that is not finite.
    BadPath,
    /// A component that two holds prescribe, or a hold and a grip.
    HeldTwice,
    /// A run that would go on for ever.
    NeverEnds,
}

/// Geometry that cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct BuildError {
    /// What is wrong.
    pub kind: BuildErrorKind,
    /// The strand's layer to blame, from 0, when it is one.
    pub layer: Option<usize>,
    /// What is wrong, with names and values.
    pub message: String,
    /// What would be right.
    pub help: String,
    /// The scene's key to blame, such as `strand.layer.1.lay_radius`, `wire.0` or `sphere.3`. Wires are counted as in
    /// [`crate::scene::spec::Spec::wires`]: where one `[[wire]]` stands for a whole file, numbers may lie past the last
    /// table, and `wire` is then the key.
    pub key: String,
}

impl From<BuildError> for Error {
    /// For callers that have no scene text to point into.
    fn from(error: BuildError) -> Self {
        Error::input(format!("{}: {}", error.key, error.message), error.help)
    }
}

impl BuildError {
    /// From a lay radius that cannot be, in a strand whose layers have these names.
    pub(crate) fn lay_radius(error: LayRadiusError, names: &[&str]) -> Self {
        let name = names[error.layer];
        let (kind, message, help) = match (error.given, error.least) {
            (Some(given), Some(least)) => (
                BuildErrorKind::LayRadius,
                format!(
                    "a lay radius of {} mm makes the wires of layer \"{name}\" overlap {}",
                    mm(given),
                    runs_into(error.clash, names)
                ),
                format!("the least lay radius that works here is {} mm; \"auto\" finds it", mm_rounded_up(least)),
            ),
            _ => (
                BuildErrorKind::NoLayRadius,
                format!("the wires of layer \"{name}\" overlap each other at every lay radius"),
                "the pitch must be greater than the number of wires times their diameter".to_owned(),
            ),
        };
        let key = match kind {
            BuildErrorKind::LayRadius => "lay_radius",
            _ => "pitch",
        };
        Self { kind, layer: Some(error.layer), message, help, key: format!("strand.layer.{}.{key}", error.layer) }
    }
}

fn runs_into(clash: Clash, names: &[&str]) -> String {
    match clash {
        Clash::Own => "each other".to_owned(),
        Clash::Below(below) => format!("those of layer \"{}\"", names[below]),
    }
}

/// Millimetres for a message, to a nanometre and without trailing zeros.
pub(crate) fn mm(metres: f64) -> String {
    let text = format!("{:.6}", metres * 1e3);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Micrometre-rounded millimetres that are not below the value, so that a radius copied from a message works.
pub(crate) fn mm_rounded_up(metres: f64) -> String {
    // A value that is a round number but for its last bits stays that number.
    format!("{:.3}", (metres * 1e6 - 1e-6).ceil() * 1e-3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_printed_short_and_radii_on_the_safe_side() {
        assert_eq!(mm(0.9e-3), "0.9");
        assert_eq!(mm(0.1), "100");
        assert_eq!(mm_rounded_up(1.142_03e-3), "1.143");
        assert_eq!(mm_rounded_up(1.29e-3), "1.290");
    }

    #[test]
    fn message_names_layer_radius_and_remedy() {
        let error = LayRadiusError { layer: 1, given: Some(0.9e-3), least: Some(1.142_03e-3), clash: Clash::Below(0) };
        let error = BuildError::lay_radius(error, &["inner", "outer"]);
        assert_eq!(error.key, "strand.layer.1.lay_radius");
        assert!(error.message.contains("0.9 mm") && error.message.contains("\"inner\""));
        assert!(error.help.contains("1.143 mm"));
    }
}
