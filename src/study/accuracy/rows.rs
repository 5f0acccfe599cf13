//! The rows of a study: one per value of a knob, with its run of every seed, and means over seeds.

use super::agenda::Turned;
use super::errors::Errors;
use super::knobs::Role;
use crate::study::cases::measured::Measured;
use crate::study::cases::stat::Stat;

/// A value of a knob, or the scene as it stands.
pub struct Row {
    /// The knob and its key; `None` for the scene as it stands.
    pub knob: Option<Turn>,
    /// The value as people read it.
    pub value: String,
    /// Its runs, one per seed.
    pub runs: Vec<Run>,
}

/// What a row knows of its knob.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// Name.
    pub name: &'static str,
    /// Key of the scene.
    pub key: &'static str,
    /// What its differences mean.
    pub role: Role,
    /// The scene's own value.
    pub default: String,
    /// The same as a number.
    pub default_number: Option<f64>,
    /// This row's as a number.
    pub number: Option<f64>,
}

/// One run of a row.
pub struct Run {
    /// Seed of the scatter.
    pub seed: u64,
    /// What became of it.
    pub outcome: Outcome,
}

/// What became of a run.
pub enum Outcome {
    /// It ran.
    Ran {
        /// What it gave.
        measured: Box<Measured>,
        /// How far that is from the reference; `None` where its seed has no reference.
        errors: Option<Errors>,
    },
    /// It was refused or had to stop: why.
    Failed(String),
    /// The budget had no room for it: what it would have taken (s).
    LeftOut(f64),
    /// The study was interrupted before.
    NotReached,
}

impl Row {
    /// Mean over the seeds that ran.
    pub fn of_runs(&self, value: impl Fn(&Measured) -> Option<f64>) -> Option<Stat> {
        let values = self.ran().filter_map(|(measured, _)| value(measured));
        Stat::of(&values.collect::<Vec<_>>())
    }

    /// Mean error over the seeds that ran and have a reference. The same seed gives the same bonds the same strengths, so
    /// that the errors of one seed compare like with like.
    pub fn of_errors(&self, value: impl Fn(&Errors) -> Option<f64>) -> Option<Stat> {
        let values = self.ran().filter_map(|(_, errors)| errors.and_then(&value));
        Stat::of(&values.collect::<Vec<_>>())
    }

    /// The runs that ran.
    pub fn ran(&self) -> impl Iterator<Item = (&Measured, Option<&Errors>)> {
        self.runs.iter().filter_map(|run| match &run.outcome {
            Outcome::Ran { measured, errors } => Some((&**measured, errors.as_ref())),
            _ => None,
        })
    }

    /// Whether it has nothing to show but that it was not run.
    pub fn is_missing(&self) -> bool {
        self.runs.iter().all(|run| matches!(run.outcome, Outcome::LeftOut(_) | Outcome::NotReached))
    }

    /// Whether its differences are those of another model, no errors.
    pub fn is_other_model(&self) -> bool {
        self.knob.as_ref().is_some_and(|knob| knob.role == Role::Model)
    }

    /// What must be known of it, in a few words; empty when there is nothing.
    pub fn note(&self) -> String {
        let runs = self.runs.len();
        let mut notes = Vec::new();
        let told = |count: usize, what: String| if runs > 1 { format!("{count} of {runs} {what}") } else { what };
        let failed = self.runs.iter().filter(|run| run.cause().is_some()).count();
        if failed > 0 {
            notes.push(told(failed, "failed, see below".into()));
        }
        let out = self.runs.iter().filter(|run| matches!(run.outcome, Outcome::LeftOut(_))).count();
        if out > 0 {
            notes.push(told(out, "left out: over the budget".into()));
        }
        let cut = self.runs.iter().filter(|run| matches!(run.outcome, Outcome::NotReached)).count();
        if cut > 0 {
            notes.push(told(cut, "not reached".into()));
        }
        if self.is_other_model() {
            notes.push("another model, no error".into());
        }
        notes.join("; ")
    }
}

impl Run {
    /// Why it failed, if it did.
    pub fn cause(&self) -> Option<&String> {
        match &self.outcome {
            Outcome::Failed(cause) => Some(cause),
            _ => None,
        }
    }

    /// In a word.
    pub fn word(&self) -> &'static str {
        match self.outcome {
            Outcome::Ran { .. } => "ran",
            Outcome::Failed(_) => "failed",
            Outcome::LeftOut(_) => "left-out",
            Outcome::NotReached => "not-reached",
        }
    }
}

/// Places of the rows: the scene as it stands, then knob by knob with rising values, words in the order of their ladder.
pub fn places(turned: &[Turned]) -> Vec<Option<[usize; 2]>> {
    let mut places = vec![None];
    for (k, turned) in turned.iter().enumerate() {
        let levels = &turned.ladder.levels;
        let mut order: Vec<usize> = (0..levels.len()).collect();
        order.sort_by(|a, b| {
            let number = |l: usize| levels[l].value.number;
            number(*a).zip(number(*b)).map_or(std::cmp::Ordering::Equal, |(a, b)| a.total_cmp(&b))
        });
        places.extend(order.into_iter().map(|l| Some([k, l])));
    }
    places
}

/// A row without runs.
pub fn empty(turned: &[Turned], place: Option<[usize; 2]>) -> Row {
    let Some([k, l]) = place else {
        return Row { knob: None, value: String::new(), runs: Vec::new() };
    };
    let Turned { knob, ladder } = &turned[k];
    let value = &ladder.levels[l].value;
    let turn = Turn {
        name: knob.name,
        key: knob.key,
        role: ladder.role,
        default: ladder.base.shown.clone(),
        default_number: ladder.base.number,
        number: value.number,
    };
    Row { knob: Some(turn), value: value.shown.clone(), runs: Vec::new() }
}
