//! What all sessions share: the run, and the one who draws it.

use super::draw::Artist;
use super::record::Record;
use super::view::View;
use crate::base::error::Result;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The run, the one who draws it, and whether the server ends.
pub(super) struct Shared {
    pub record: Record,
    artist: Mutex<Artist>,
    pub ended: AtomicBool,
}

impl Shared {
    pub fn new(record: Record, artist: Artist) -> Self {
        Self { record, artist: Mutex::new(artist), ended: AtomicBool::new(false) }
    }

    /// The one who draws, when it is free. A picture that failed in the middle leaves nothing half done.
    pub fn artist(&self) -> MutexGuard<'_, Artist> {
        self.artist.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Checks that the run has what a view names.
    pub fn check(&self, view: &View) -> Result<()> {
        view.check(self.record.info(), self.record.states())
    }
}
