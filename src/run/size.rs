//! Whether a run fits into memory, found out before anything is built.

use super::schedule::most_snapshots;
use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::spec::Spec;
use crate::strand::size::{MOST_WIRES, Size};
use std::fmt;

/// Particles are numbered by 32 bits.
const MOST_PARTICLES: f64 = u32::MAX as f64;

/// The size of a scene that is fit to be built.
///
/// # Errors
/// [`crate::base::error::Error::Scene`] at the key that makes it large, where it needs more memory than `scene.memory`
/// says, or without that, than is free.
pub fn check(scene: &Scene) -> Result<Size> {
    let size = Size::of(&scene.spec);
    let free = scene.memory.or_else(free_memory).map_or(f64::INFINITY, |bytes| bytes as f64);
    let refuse = |why: String| {
        let what = format!("{why}; `{}` makes it so large", size.key);
        scene.source.error(&size.key, what, "take less of that, or raise the limit with --memory where there is more")
    };
    if size.wires > MOST_WIRES {
        return Err(refuse(format!("the scene has {} wires, and {MOST_WIRES} at most can be laid", size.wires)));
    }
    if size.memory > free || size.particles > MOST_PARTICLES {
        let [needed, free] = [size.memory, free].map(gigabytes);
        let particles = count(size.particles);
        return Err(refuse(format!("the scene has about {particles} particles, which need {needed} of {free}")));
    }
    Ok(size)
}

/// What a run may write, at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output {
    /// Snapshots.
    pub snapshots: f64,
    /// Trajectory and tables (bytes).
    pub trajectory: f64,
    /// Recording, where one is made (bytes).
    pub recording: f64,
    /// Frames, where they are drawn (bytes).
    pub frames: f64,
}

/// Bytes of a particle in a snapshot of the trajectory, and of a recording.
const IN_TRAJECTORY: f64 = 37.0;
const IN_RECORDING: f64 = 42.0;
/// Bytes of a row, and of a wire in it, in trajectory and table.
const ROW: f64 = 400.0;
const ROW_OF_WIRE: f64 = 8.0;
/// Bytes of a pixel in a picture: most of it is ground.
const PIXEL: f64 = 0.4;

impl Output {
    /// Of a run of `spec` with so many particles and wires.
    pub fn of(spec: &Spec, particles: usize, wires: usize) -> Self {
        let output = &spec.output;
        let snapshots = most_snapshots(output, spec.breaks()) as f64;
        let rows = output.samples as f64 + snapshots;
        let [width, height] = output.frame_size.map(f64::from);
        Self {
            snapshots,
            trajectory: snapshots * particles as f64 * IN_TRAJECTORY + rows * (ROW + ROW_OF_WIRE * wires as f64),
            recording: snapshots * particles as f64 * IN_RECORDING,
            frames: snapshots * width * height * PIXEL,
        }
    }
}

impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [trajectory, recording, frames] = [self.trajectory, self.recording, self.frames].map(gigabytes);
        let snapshots = count(self.snapshots);
        write!(
            f,
            "output: up to {snapshots} snapshots; trajectory {trajectory}, recording {recording}, frames {frames}"
        )
    }
}

/// A memory for people.
pub fn gigabytes(bytes: f64) -> String {
    match bytes {
        b if b < 1e9 => format!("{:.0} MB", b * 1e-6),
        b if b < 1e13 => format!("{:.1} GB", b * 1e-9),
        b => format!("{:.0e} GB", b * 1e-9),
    }
}

/// A number of things for people: in full as long as that can be read.
fn count(number: f64) -> String {
    if number < 1e7 { format!("{number:.0}") } else { format!("{number:.1e}") }
}

/// Memory that this process may still get (bytes): of the machine and of its control group, whichever has less. `None`
/// where the system does not tell.
#[cfg(target_os = "linux")]
fn free_memory() -> Option<u64> {
    let number = |path: &str| std::fs::read_to_string(path).ok()?.trim().parse::<u64>().ok();
    let machine = std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
        Some(line.trim().strip_suffix(" kB")?.parse::<u64>().ok()? << 10)
    });
    let group = |most: &str, used: &str| {
        let folder = "/sys/fs/cgroup";
        Some(number(&format!("{folder}/{most}"))?.saturating_sub(number(&format!("{folder}/{used}"))?))
    };
    let groups = [("memory.max", "memory.current"), ("memory/memory.limit_in_bytes", "memory/memory.usage_in_bytes")];
    groups.into_iter().map(|(most, used)| group(most, used)).chain([machine]).flatten().min()
}

/// Memory that this process may still get (bytes): this system does not tell.
#[cfg(not(target_os = "linux"))]
fn free_memory() -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    fn refused(name: &str, set: &str, memory: Option<u64>) -> String {
        let mut scene = scene::load(name, &[set.to_owned()]).unwrap();
        scene.memory = memory;
        let error = check(&scene).err().unwrap_or_else(|| panic!("{set} is not refused"));
        assert_eq!(error.exit_code(), 2);
        error.to_string()
    }

    #[test]
    fn what_does_not_fit_is_refused_at_its_key() {
        let long = refused("ka4", "strand.length=12 km", None);
        assert!(long.contains("`strand.length`") && long.contains("particles"), "{long}");
        assert!(refused("single-wire", "spacing=1e-9", None).contains("`spacing`"));
        assert!(refused("ka4", "seed=1", Some(10_000_000)).contains("of 10 MB"));
        assert!(refused("strand-1x7", "strand.layer.1.wires=4999", Some(1 << 30)).contains("wires"));
    }

    /// A run of ka4 with its 117 snapshots wrote 41.0 MB of trajectory, 49.0 MB of recording, 38 MB of frames, and 0.55 MB
    /// of curve.
    #[test]
    fn output_is_about_what_ka4_wrote() {
        let output = Output::of(&scene::load("ka4", &[]).unwrap().spec, 10_618, 34);
        assert_eq!(output.snapshots, 300.0);
        let wrote = 117.0 / 300.0;
        for (foretold, found) in [(output.trajectory, 41.6e6), (output.recording, 49e6), (output.frames, 38e6)] {
            assert!((0.9..1.3).contains(&(foretold * wrote / found)), "{foretold} {found}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn shipped_scenes_fit_into_this_machine() {
        assert!(free_memory().is_some_and(|bytes| bytes > 1 << 24));
        check(&scene::load("ka4", &[]).unwrap()).unwrap();
    }
}
