//! Watches a run from one's own code: an observer that keeps the greatest plastic strain of every wire, and prints it at each
//! break. `cargo run --release --no-default-features --example observe`

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use strandsnap::base::error::Result;
use strandsnap::engine::view::{RunInfo, Rupture, Snapshot};
use strandsnap::observe::Observer;
use strandsnap::{run, scene};

/// Greatest plastic strain of each wire at the last snapshot (-).
#[derive(Default)]
pub struct MostStrained {
    info: Option<Arc<RunInfo>>,
    plastic_strain: Vec<f32>,
    breaks: usize,
}

impl Observer for MostStrained {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.info = Some(info.clone());
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let Some(info) = &self.info else { return Ok(()) };
        // Bond slot i joins particles i and i + 1; the last particle of a wire begins none.
        let greatest = |first: usize, len: usize| {
            snapshot.plastic_strain[first..first + len - 1].iter().copied().fold(0.0, f32::max)
        };
        self.plastic_strain = info.wires.iter().map(|wire| greatest(wire.first, wire.len)).collect();
        Ok(())
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.breaks += 1;
        let others = self.plastic_strain.iter().map(|p| format!("{:.2}", 100.0 * p)).collect::<Vec<_>>().join(" ");
        println!(
            "wire {} breaks at {:.2} %; so far the wires had {others} %",
            rupture.wire + 1,
            100.0 * rupture.strain
        );
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

pub fn main() -> Result<()> {
    let options = ["strand.length=20 mm", "grip.length=3 mm", "grip.speed=20 m/s", "bond.rupture.strain=5 %"];
    let scene = scene::load("strand-1x7", &options.map(str::to_owned))?;
    let mut watcher = MostStrained::default();
    let summary = run::summarise(&scene, vec![&mut watcher], &AtomicBool::new(false))?;
    assert_eq!(watcher.breaks, summary.bonds_broken, "an observer is told of every break");
    assert!(watcher.plastic_strain.iter().any(|p| *p > 0.03), "{:?}", watcher.plastic_strain);
    Ok(())
}
