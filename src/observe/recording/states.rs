//! Lanes that show when each wire is whole, yields and breaks.

use super::names;
use super::particles::{STATE_NAMES, wire_state};
use super::stream::{Instant, Stream};
use crate::base::error::Result;
use crate::engine::view::{BondState, RunInfo, Snapshot};
use rerun::external::arrow::array::StringArray;
use rerun::{SerializedComponentBatch, StateChange, StateConfiguration};
use std::sync::Arc;

/// State of each wire and its changes that are not sent yet.
pub(super) struct States {
    now: Vec<Option<BondState>>,
    unsent: Vec<Vec<(Instant, BondState)>>,
}

impl States {
    /// Nothing known yet.
    pub fn new(wires: usize) -> Self {
        Self { now: vec![None; wires], unsent: vec![Vec::new(); wires] }
    }

    /// Takes note of every wire's state in a snapshot.
    pub fn snapshot(&mut self, info: &RunInfo, snapshot: &Snapshot, instant: Instant) {
        for (number, wire) in info.wires.iter().enumerate() {
            self.set(number, wire_state(snapshot, wire), instant);
        }
    }

    /// Takes note of a state; a wire never goes back to an earlier one, whatever order ruptures and snapshots
    /// come in.
    pub fn set(&mut self, wire: usize, state: BondState, instant: Instant) {
        if self.now[wire].is_none_or(|now| (now as u8) < state as u8) {
            self.now[wire] = Some(state);
            self.unsent[wire].push((instant, state));
        }
    }

    /// Sends the colours of the states.
    pub fn send_style(stream: &Stream, info: &RunInfo) -> Result<()> {
        let style = StateConfiguration::new().with_values(STATE_NAMES[..3].iter().copied()).with_colors([
            0x3E6F8EFFu32,
            0xD9A441FF,
            super::paint::BROKEN,
        ]);
        (0..info.wires.len()).try_for_each(|w| stream.fixed(names::wire(names::STATES, info, w), &style))
    }

    /// Sends what is new.
    pub fn send(&mut self, stream: &Stream, info: &RunInfo) -> Result<()> {
        for (number, changes) in self.unsent.iter_mut().enumerate().filter(|(_, changes)| !changes.is_empty()) {
            let instants: Vec<_> = changes.iter().map(|(instant, _)| *instant).collect();
            let words = StringArray::from_iter_values(changes.iter().map(|(_, state)| STATE_NAMES[*state as usize]));
            let batch = SerializedComponentBatch::new(Arc::new(words), StateChange::descriptor_state());
            stream.rows(names::wire(names::STATES, info, number), &instants, [(batch, vec![1; changes.len()])])?;
            changes.clear();
        }
        Ok(())
    }
}
