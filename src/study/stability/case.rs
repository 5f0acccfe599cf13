//! A case of the matrix: a scene, what is extreme about it, and what must come of it.

use super::measure::Check;
use crate::base::error::Result;
use crate::base::finding::FindingKind;
use crate::scene::{self, Scene};
use std::path::Path;

/// Where a case's scene comes from before its options.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Base {
    /// A scene that comes with the program, by name.
    Builtin(&'static str),
    /// The text of one of the matrix's own scenes, or of a verification scene.
    Text(&'static str),
}

/// What must come of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expect {
    /// It runs to its end with its ledger closed.
    Stable,
    /// Refused before it runs, with cause and remedy.
    Refused,
    /// Stopped while it runs, because wires pass through each other.
    PassesThrough,
}

/// How a case is run.
#[derive(Debug, Clone)]
pub enum Kind {
    /// One run to its end.
    Run,
    /// Many times with fixed steps, to find the greatest one that holds.
    Critical(Critical),
}

/// How the critical step of a case is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// The energy of a run may be this many times that of one with half of the bound (-).
    pub growth: f64,
    /// The bound must come within this share of the critical step (-); `None`: it only has to lie below.
    pub within: Option<f64>,
}

impl Critical {
    /// Bodies that keep their energy: an unstable step makes it grow without bound.
    pub const ELASTIC: Self = Self { growth: 10.0, within: None };
    /// Bodies that swallow energy: one per cent more than at a small step is a wrong answer.
    pub const DISSIPATIVE: Self = Self { growth: 1.05, within: None };
}

/// One row of the matrix.
#[derive(Debug, Clone)]
pub struct StabilityCase {
    /// Name, by which it can be asked for.
    pub name: String,
    /// What is extreme about it, in a few words.
    pub about: String,
    /// Scene before options.
    pub base: Base,
    /// `key=value` options as `--set` takes them.
    pub set: Vec<String>,
    /// Further options of the quick form, after the others.
    pub quick: Vec<String>,
    /// What must come of it.
    pub expect: Expect,
    /// How it is run.
    pub kind: Kind,
    /// The number it must give, when one is known.
    pub check: Option<Check>,
    /// Findings that the run must make, for what is stable and yet not what the user asked for.
    pub found: &'static [FindingKind],
    /// Whether it is started before the others, so that no core waits for it at the end.
    pub long: bool,
    /// Wall time after which the run counts as hung (s).
    pub patience: f64,
}

/// Wall time after which a run counts as hung (s); the longest case takes about a minute on a core of its own.
const PATIENCE: f64 = 400.0;

impl StabilityCase {
    /// A run of `base` that must be stable.
    pub fn new(name: impl Into<String>, about: impl Into<String>, base: Base) -> Self {
        Self {
            name: name.into(),
            about: about.into(),
            base,
            set: Vec::new(),
            quick: Vec::new(),
            expect: Expect::Stable,
            kind: Kind::Run,
            check: None,
            found: &[],
            long: false,
            patience: PATIENCE,
        }
    }

    /// Adds options.
    pub fn set<S: Into<String>>(mut self, options: impl IntoIterator<Item = S>) -> Self {
        self.set.extend(options.into_iter().map(Into::into));
        self
    }

    /// Adds options of the quick form.
    pub fn quick<S: Into<String>>(mut self, options: impl IntoIterator<Item = S>) -> Self {
        self.quick.extend(options.into_iter().map(Into::into));
        self
    }

    /// It must be refused.
    pub fn refused(mut self) -> Self {
        self.expect = Expect::Refused;
        self
    }

    /// It must be stopped, because wires pass through each other.
    pub fn passes_through(mut self) -> Self {
        self.expect = Expect::PassesThrough;
        self
    }

    /// It must give a known number.
    pub fn gives(mut self, check: Check) -> Self {
        self.check = Some(check);
        self
    }

    /// It must make these findings.
    pub fn finds(mut self, kinds: &'static [FindingKind]) -> Self {
        self.found = kinds;
        self
    }

    /// It takes long.
    pub fn long(mut self) -> Self {
        self.long = true;
        self
    }

    /// It looks for the critical step.
    pub fn critical(mut self, critical: Critical) -> Self {
        self.kind = Kind::Critical(critical);
        self
    }

    /// Reads the scene with the case's options.
    ///
    /// # Errors
    /// What [`scene::load`] refuses.
    pub fn scene(&self, quick: bool) -> Result<Scene> {
        let mut options = self.set.clone();
        if quick {
            options.extend_from_slice(&self.quick);
        }
        match self.base {
            Base::Builtin(name) => scene::load(name, &options),
            Base::Text(text) => scene::parse(text, &format!("{}.toml", self.name), Path::new("."), &options),
        }
    }
}
