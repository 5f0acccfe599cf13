//! Makes tables and summary of a run again, from its scene and its trajectory.

use super::tables::Table;
use crate::base::error::{Error, Result};
use crate::engine::view::RunInfo;
use crate::observe::Observer;
use crate::observe::bodies::BODIES;
use crate::observe::summary::{Closing, RunSummary, Summariser};
use crate::observe::tables::{FILES, Tables};
use crate::observe::trajectory::Record;
use crate::scene::spec::Spec;
use serde_json::Value;
use std::sync::Arc;

/// What was made anew.
pub struct Remade {
    /// The tables, in the order of [`FILES`].
    pub tables: [Table; 3],
    /// Table of rigid bodies, where there are any.
    pub bodies: Option<Table>,
    /// `summary.json` without its seal.
    pub summary: Value,
}

/// Makes it, record by record.
pub struct Maker {
    folder: tempfile::TempDir,
    tables: Tables,
    summariser: Summariser,
}

impl Maker {
    /// Of a run that begins.
    ///
    /// # Errors
    /// [`Error::Io`] when there is no room for temporary files.
    pub fn new(info: &Arc<RunInfo>) -> Result<Self> {
        let folder = tempfile::tempdir().map_err(|e| Error::io("cannot make a folder in", std::env::temp_dir(), e))?;
        let (mut tables, mut summariser) = (Tables::new(folder.path()), Summariser::new());
        tables.start(info)?;
        summariser.start(info)?;
        Ok(Self { folder, tables, summariser })
    }

    /// Takes in a record.
    ///
    /// # Errors
    /// [`Error::Io`] when the disk is full.
    pub fn take(&mut self, record: &Record) -> Result<()> {
        for observer in [&mut self.tables as &mut dyn Observer, &mut self.summariser] {
            match record {
                Record::Sample(sample) => observer.sample(sample)?,
                Record::Rupture(rupture) => observer.rupture(rupture)?,
                Record::Notice(notice) => observer.notice(notice)?,
                Record::Peaks(peaks) => observer.peaks(peaks)?,
                Record::Snapshot(_) => {}
            }
        }
        Ok(())
    }

    /// All records were taken in; `told` is the summary as the run wrote it.
    ///
    /// # Errors
    /// [`Error::Io`] when the disk is full.
    pub fn end(mut self, spec: &Spec, told: &RunSummary, bonds: usize) -> Result<Remade> {
        self.tables.finish()?;
        // An error that is no failure of the simulation is a warning without a finding.
        let error = told.warnings.first().filter(|_| told.warnings.len() > told.findings.len());
        let closing = Closing {
            stopped: told.stopped,
            error: error.cloned(),
            quasi_static: told.quasi_static,
            limits: told.limits.clone(),
            cost: told.cost.clone(),
            written: told.written.clone(),
        };
        let summary = self.summariser.summary(spec, bonds, closing);
        let [curve, wires, ruptures] = FILES.map(|name| Table::read(self.folder.path(), name, &[]));
        let bodies = || Table::read(self.folder.path(), BODIES, &[]);
        let bodies = (!spec.rigids.is_empty()).then(bodies).transpose()?;
        Ok(Remade {
            tables: [curve?, wires?, ruptures?],
            bodies,
            summary: serde_json::to_value(summary).unwrap_or_default(),
        })
    }
}
