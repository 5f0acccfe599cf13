//! The rows of a study: one per value of a parameter, with its run of every seed, and means over seeds.

use super::errors::Errors;
use super::parameters::Role;
use super::schedule::Varied;
use crate::study::statistics::Statistics;
use crate::study::tensile::TensileResult;

/// A value of a parameter, or the scene as it stands.
pub struct Row {
    /// The parameter and its key; `None` for the scene as it stands.
    pub parameter: Option<RowParameter>,
    /// The value as people read it.
    pub value: String,
    /// Its runs, one per seed.
    pub runs: Vec<Run>,
}

/// What a row knows of its parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct RowParameter {
    /// Name of the parameter.
    pub name: &'static str,
    /// Key of the scene.
    pub key: &'static str,
    /// What its differences mean.
    pub role: Role,
    /// The scene's own value.
    pub default: String,
    /// The same as a number.
    pub default_number: Option<f64>,
    /// The value of this row as a number; `None` for words.
    pub number: Option<f64>,
}

/// One run of a row.
pub struct Run {
    /// Seed of the scatter.
    pub seed: u64,
    /// What became of it.
    pub outcome: RunStatus,
}

/// What became of a run.
pub enum RunStatus {
    /// It came to its end.
    Ran(Compared),
    /// It was refused or had to stop: why.
    Failed(String),
    /// The budget had no room for it: what it would have taken (s).
    LeftOut(f64),
    /// The study was interrupted before.
    NotReached,
}

/// A run that came to its end, compared with the reference.
pub struct Compared {
    /// What it gave.
    pub result: Box<TensileResult>,
    /// How far that is from the reference; `None` where its seed has no reference.
    pub errors: Option<Errors>,
}

impl Row {
    /// Mean over the seeds that ran.
    pub fn of_runs(&self, value: impl Fn(&TensileResult) -> Option<f64>) -> Option<Statistics> {
        let values = self.ran().filter_map(|run| value(&run.result));
        Statistics::of(&values.collect::<Vec<_>>())
    }

    /// Mean error over the seeds that ran and have a reference. The same seed gives the same bonds the same strengths, so
    /// that the errors of one seed compare like with like.
    pub fn of_errors(&self, value: impl Fn(&Errors) -> Option<f64>) -> Option<Statistics> {
        let values = self.ran().filter_map(|run| run.errors.as_ref().and_then(&value));
        Statistics::of(&values.collect::<Vec<_>>())
    }

    /// The runs that came to their end.
    pub fn ran(&self) -> impl Iterator<Item = &Compared> {
        self.runs.iter().filter_map(Run::ran)
    }

    /// Whether it has nothing to show but that it was not run.
    pub fn is_missing(&self) -> bool {
        self.runs.iter().all(|run| matches!(run.outcome, RunStatus::LeftOut(_) | RunStatus::NotReached))
    }

    /// Whether its differences are those of another model, no errors.
    pub fn is_other_model(&self) -> bool {
        self.parameter.as_ref().is_some_and(|parameter| parameter.role == Role::Model)
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
        let out = self.runs.iter().filter(|run| matches!(run.outcome, RunStatus::LeftOut(_))).count();
        if out > 0 {
            notes.push(told(out, "left out: over the budget".into()));
        }
        let cut = self.runs.iter().filter(|run| matches!(run.outcome, RunStatus::NotReached)).count();
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
    /// What it gave, if it came to its end.
    pub fn ran(&self) -> Option<&Compared> {
        match &self.outcome {
            RunStatus::Ran(compared) => Some(compared),
            _ => None,
        }
    }

    /// Why it failed, if it did.
    pub fn cause(&self) -> Option<&str> {
        match &self.outcome {
            RunStatus::Failed(cause) => Some(cause),
            _ => None,
        }
    }

    /// In a word.
    pub fn word(&self) -> &'static str {
        match self.outcome {
            RunStatus::Ran(_) => "ran",
            RunStatus::Failed(_) => "failed",
            RunStatus::LeftOut(_) => "left-out",
            RunStatus::NotReached => "not-reached",
        }
    }
}

/// Places of the rows: the scene as it stands, then parameter by parameter with rising values, words in the order of their variation.
pub fn places(varied: &[Varied]) -> Vec<Option<[usize; 2]>> {
    let mut places = vec![None];
    for (k, varied) in varied.iter().enumerate() {
        let levels = &varied.variation.levels;
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
pub fn empty(varied: &[Varied], place: Option<[usize; 2]>) -> Row {
    let Some([k, l]) = place else {
        return Row { parameter: None, value: String::new(), runs: Vec::new() };
    };
    let Varied { parameter, variation } = &varied[k];
    let value = &variation.levels[l].value;
    let own = RowParameter {
        name: parameter.name,
        key: parameter.key,
        role: variation.role,
        default: variation.base.shown.clone(),
        default_number: variation.base.number,
        number: value.number,
    };
    Row { parameter: Some(own), value: value.shown.clone(), runs: Vec::new() }
}
