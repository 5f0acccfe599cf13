//! Where the wall time of a run goes.

use std::time::Duration;

/// Wall time spent per stage.
#[derive(Debug, Clone, Copy, Default)]
pub struct Timings {
    /// Kick, holds, drift, gather.
    pub integrate: Duration,
    /// Neighbour search.
    pub neighbours: Duration,
    /// Bonds and rupture.
    pub bonds: Duration,
    /// Contacts.
    pub contacts: Duration,
    /// Bound on the time step.
    pub time_step: Duration,
}

impl Timings {
    /// Every stage with its name.
    pub fn stages(&self) -> [(&'static str, Duration); 5] {
        [
            ("motion", self.integrate),
            ("bonds", self.bonds),
            ("contacts", self.contacts),
            ("neighbours", self.neighbours),
            ("time step", self.time_step),
        ]
    }

    /// What has been spent since `earlier`.
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            integrate: self.integrate - earlier.integrate,
            neighbours: self.neighbours - earlier.neighbours,
            bonds: self.bonds - earlier.bonds,
            contacts: self.contacts - earlier.contacts,
            time_step: self.time_step - earlier.time_step,
        }
    }
}
