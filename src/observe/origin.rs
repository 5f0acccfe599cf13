//! Which run a file is of.

use crate::base::digest::Digest;
use crate::engine::REVISION;
use crate::scene::spec::{PathSpec, Spec};
use crate::scene::write;
use serde::{Deserialize, Serialize};

/// Keyword of the text chunk in which a PNG file carries the id of the run that it shows.
pub const RUN_KEYWORD: &str = "strandsnap run";
/// Keyword of the text chunk with the step of the run whose state the picture shows.
pub const STEP_KEYWORD: &str = "strandsnap step";

/// What decides every bit of a run's result: two runs with the same id are the same run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Origin {
    /// The run's id: of its scene (and so of its seed), of the points of its centre-line files, and of the physics.
    pub run: Digest,
    /// Of the text of its scene alone, as `scene.toml` has it.
    pub scene: Digest,
    /// Revision of the physics ([`REVISION`]).
    pub revision: u32,
}

impl Origin {
    /// Bytes in a binary file.
    pub const LEN: usize = 2 * Digest::LEN + 4;

    /// Of a run of `spec` by this program.
    pub fn of(spec: &Spec) -> Self {
        Self::new(&write::to_toml(spec), spec, REVISION)
    }

    fn new(text: &str, spec: &Spec, revision: u32) -> Self {
        let mut all = revision.to_le_bytes().to_vec();
        all.extend(text.as_bytes());
        for wire in &spec.wires {
            if let PathSpec::File { points, .. } = &wire.path {
                all.extend(points.iter().flat_map(|p| p.to_array()).flat_map(f64::to_le_bytes));
            }
        }
        Self { run: Digest::of(all), scene: Digest::of(text), revision }
    }

    /// Whether the run is one of the scene with this text; `spec` is the same as read, where this program can.
    pub fn is_of(&self, text: &str, spec: Option<&Spec>) -> bool {
        match spec {
            Some(spec) => *self == Self::new(text, spec, self.revision),
            None => self.scene == Digest::of(text),
        }
    }

    /// As it stands in binary files.
    pub fn to_bytes(self) -> [u8; Self::LEN] {
        let mut bytes = [0; Self::LEN];
        bytes[..32].copy_from_slice(&self.run.to_bytes());
        bytes[32..64].copy_from_slice(&self.scene.to_bytes());
        bytes[64..].copy_from_slice(&self.revision.to_le_bytes());
        bytes
    }

    /// Back from there.
    pub fn from_bytes(bytes: &[u8; Self::LEN]) -> Self {
        let digest = |at: usize| Digest::from_bytes(std::array::from_fn(|k| bytes[at + k]));
        let revision = u32::from_le_bytes(std::array::from_fn(|k| bytes[64 + k]));
        Self { run: digest(0), scene: digest(Digest::LEN), revision }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    fn spec(set: &[&str]) -> Spec {
        scene::load("strand-1x7", &set.iter().map(ToString::to_string).collect::<Vec<_>>()).unwrap().spec
    }

    #[test]
    fn what_changes_a_run_changes_its_id() {
        let origin = Origin::of(&spec(&[]));
        for set in [["material.young=111 GPa"], ["seed=7"], ["output.samples=12"]] {
            assert_ne!(Origin::of(&spec(&set)).run, origin.run, "{set:?}");
        }
        assert_eq!(Origin::of(&spec(&[])), origin);
        assert_eq!(Origin::from_bytes(&origin.to_bytes()), origin);
    }

    /// A scene is its run's when it was written, and read again.
    #[test]
    fn a_scene_that_was_written_is_its_runs() {
        let origin = Origin::of(&spec(&[]));
        let text = write::to_toml(&spec(&[]));
        let read = scene::parse(&text, "scene.toml", std::path::Path::new("."), &[]).unwrap().spec;
        assert!(origin.is_of(&text, Some(&read)) && origin.is_of(&text, None));
        let edited = text.replace("115 GPa", "116 GPa");
        assert!(edited != text && !origin.is_of(&edited, None) && !origin.is_of(&edited, Some(&read)));
    }
}
