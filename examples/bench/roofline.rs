//! How far each stage is from what the machine could do: its bytes over the bandwidth, its operations over their
//! throughput.

use crate::counted::Operations;
use crate::machine::Machine;
use crate::measure::Stages;
use crate::work::Work;
use serde::{Deserialize, Serialize};
use strandsnap::engine::bytes::Bytes;
use strandsnap::engine::memory::StageBytes;

/// The least times of a stage per step (ms); none where its work depends on the state too much to be counted.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Limits {
    /// For moving its bytes.
    pub bandwidth: f64,
    /// For its arithmetic.
    pub arithmetic: f64,
    /// Its bytes and operations per step.
    pub bytes: usize,
    pub simple: f64,
    pub divisions: f64,
    pub roots: f64,
}

impl Limits {
    fn new(bytes: Bytes, work: Operations, machine: &Machine) -> Self {
        Self {
            bandwidth: machine.moving(bytes.moved) * 1e3,
            arithmetic: machine.computing(work) * 1e3,
            bytes: bytes.moved,
            simple: work.simple,
            divisions: work.divisions,
            roots: work.roots,
        }
    }

    /// The limit as a share of a time (-).
    pub fn reached(&self, ms: f64) -> f64 {
        self.bandwidth.max(self.arithmetic) / ms
    }
}

/// Limits of the stages that stream.
pub fn limits(bytes: &StageBytes, work: &Work, machine: &Machine) -> Stages<Limits> {
    Stages {
        integrate: Limits::new(bytes.integrate, work.integrate, machine),
        bonds: Limits::new(bytes.bonds, work.bonds, machine),
        contacts: Limits::new(bytes.contacts, work.contacts, machine),
        ..Default::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greater_limit_counts() {
        let machine = Machine { far: 1.0, near: 1e6, simple: 1e3, divisions: 1e3, roots: 1e3 };
        let work = Operations { simple: 5.0, divisions: 1.0, roots: 1.0 };
        let limits = Limits::new(Bytes { kept: 0, moved: 2000 }, work, &machine);
        assert_eq!((limits.bandwidth, limits.arithmetic), (2.0, 5.0));
        assert_eq!(limits.reached(10.0), 0.5);
    }
}
