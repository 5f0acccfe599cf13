//! A finished run in files that other programs open: Parquet for tables, VTK for ParaView, LAMMPS and extended XYZ for OVITO.
//!
//! Everything is read from the run's trajectory, without simulating. One file per format; each is an
//! [`Observer`](crate::observe::Observer) that is shown the run again. `assets/results/files.md` says what the
//! files hold, in which units, and how programs open them.

mod lammps;
#[cfg(feature = "export")]
mod parquet;
mod staged;
#[cfg(feature = "export")]
mod vtk;
mod xyz;

use crate::base::digest::Digest;
use crate::base::error::{Error, Result};
use crate::engine::view::{BondState, RunInfo, Snapshot};
use crate::observe::Observer;
use crate::run::folder::OutFolder;
use crate::run::identity;
#[cfg(not(feature = "export"))]
use crate::run::outputs::built_without;
use crate::run::replay::{Replay, Selection};
use staged::Staged;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What kind of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Apache Parquet.
    Parquet,
    /// VTK's XML polygonal data, with collections over time.
    Vtk,
    /// Data file and dumps as LAMMPS writes them.
    Lammps,
    /// Extended XYZ.
    Xyz,
}

impl Format {
    /// Every value.
    pub const ALL: [Self; 4] = [Self::Parquet, Self::Vtk, Self::Lammps, Self::Xyz];

    /// The word that people write.
    pub fn word(self) -> &'static str {
        match self {
            Self::Parquet => "parquet",
            Self::Vtk => "vtk",
            Self::Lammps => "lammps",
            Self::Xyz => "xyz",
        }
    }

    /// What it means.
    pub fn about(self) -> &'static str {
        match self {
            Self::Parquet => "Tables and series per wire and per bond, for pandas, polars, DuckDB",
            Self::Vtk => "Wires and bonds over time (.vtp, .pvd), for ParaView and PyVista",
            Self::Lammps => "Data file, dump of atoms and dump of bonds over time, for OVITO",
            Self::Xyz => "Particles over time as extended XYZ, for OVITO and ASE",
        }
    }

    /// The file to open first, which gets its name last.
    pub fn first_file(self) -> &'static str {
        match self {
            Self::Parquet => "curve.parquet",
            Self::Vtk => "wires.pvd",
            Self::Lammps => lammps::DATA,
            Self::Xyz => xyz::FILE,
        }
    }

    /// Whether a file of this name is one that this format writes.
    fn writes(self, name: &str) -> bool {
        let numbered = |kind: &str| {
            let digits = name.strip_prefix(kind).and_then(|rest| rest.strip_suffix(".vtp"));
            digits.is_some_and(|digits| digits.len() > 1 && digits[1..].bytes().all(|b| b.is_ascii_digit()))
        };
        match self {
            Self::Parquet => ["curve", "wires", "ruptures", "wire_series", "bond_series"]
                .iter()
                .any(|table| name.strip_suffix(".parquet") == Some(table)),
            Self::Vtk => ["wires.pvd", "bonds.pvd"].contains(&name) || numbered("wires") || numbered("bonds"),
            Self::Lammps => [lammps::DATA, lammps::ATOMS, lammps::BONDS].contains(&name),
            Self::Xyz => name == xyz::FILE,
        }
    }
}

/// What to export, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportOptions {
    /// The kind of files.
    pub format: Format,
    /// Snapshots to export. Its range of strain holds for the series of wires too; the tables are always whole.
    pub selection: Selection,
    /// The folder; `None`: one in that of the run, named by the format.
    pub out: Option<PathBuf>,
    /// Replace what an earlier export wrote there.
    pub overwrite: bool,
    /// Export also what the run's files do not agree about.
    pub anyway: bool,
}

/// What was exported.
#[derive(Debug)]
pub struct Exported {
    /// The folder.
    pub folder: PathBuf,
    /// Number of files in it.
    pub files: usize,
    /// Their size (bytes).
    pub bytes: u64,
    /// Snapshots in them.
    pub snapshots: usize,
    /// Why the trajectory ends before its run did, if so.
    pub cut_off: Option<String>,
}

/// What every writer is told.
struct Target {
    /// Where its files grow.
    folder: PathBuf,
    /// The run's id.
    run: Digest,
    /// Range of strain (-).
    #[cfg_attr(not(feature = "export"), expect(dead_code, reason = "what needs it is not built"))]
    strain: [f64; 2],
}

impl Target {
    /// Creates a file.
    fn create(&self, name: &str) -> Result<(PathBuf, BufWriter<File>)> {
        let path = self.folder.join(name);
        let file = File::create(&path).map_err(|e| Error::io("cannot write", &path, e))?;
        Ok((path, BufWriter::new(file)))
    }

    /// One line that says what is exported.
    fn title(&self, info: &RunInfo) -> String {
        format!("{}, run {}, strandsnap {}", info.name, self.run, env!("CARGO_PKG_VERSION"))
    }
}

/// A text file that grows by one snapshot at a time.
struct Growing {
    path: PathBuf,
    writer: BufWriter<File>,
}

impl Growing {
    fn create(target: &Target, name: &str) -> Result<Self> {
        target.create(name).map(|(path, writer)| Self { path, writer })
    }

    fn write(&mut self, write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>) -> Result<()> {
        write(&mut self.writer).map_err(|e| Error::io("cannot write", &self.path, e))
    }

    fn finish(&mut self) -> Result<()> {
        self.write(|writer| writer.flush())
    }
}

/// Exports the run in the folder `run`, or of the trajectory `run`. Nothing has its name before all is whole.
///
/// # Errors
/// [`Error::Input`] when there is no trajectory, nothing is selected, files of the run do not agree, or the folder is not
/// empty; [`Error::Interrupted`] when `stop` was set, with nothing written; [`Error::Io`]; [`Error::Missing`] for a format
/// that was not built.
pub fn export(run: &Path, options: &ExportOptions, stop: &AtomicBool) -> Result<Exported> {
    let doubts = identity::check(run, options.anyway)?;
    let replay = Replay::open(run, &options.selection)?.doubting(&doubts);
    let beside = if run.is_dir() { run } else { run.parent().unwrap_or(Path::new("")) };
    let out = options.out.clone().unwrap_or_else(|| beside.join(options.format.word()));
    OutFolder::check(&out, options.overwrite)?;
    let staged = Staged::open(&out)?;
    let target =
        Target { folder: staged.path().to_owned(), run: replay.origin().run, strain: options.selection.strain };
    let snapshots = replay.show(&mut *writer(options.format, target)?, stop)?;
    if stop.load(Ordering::Relaxed) {
        return Err(Error::Interrupted);
    }
    let (files, bytes) = staged.complete(options.format)?;
    Ok(Exported { folder: out, files, bytes, snapshots, cut_off: replay.cut_off().map(ToString::to_string) })
}

#[cfg(feature = "export")]
fn writer(format: Format, target: Target) -> Result<Box<dyn Observer>> {
    Ok(match format {
        Format::Parquet => Box::new(parquet::Writer::new(target)),
        Format::Vtk => Box::new(vtk::Writer::new(target)),
        Format::Lammps => Box::new(lammps::Writer::new(target)),
        Format::Xyz => Box::new(xyz::Writer::new(target)),
    })
}

#[cfg(not(feature = "export"))]
fn writer(format: Format, target: Target) -> Result<Box<dyn Observer>> {
    match format {
        Format::Parquet | Format::Vtk => {
            Err(built_without("this format", "export", "export to lammps or xyz, which need nothing more"))
        }
        Format::Lammps => Ok(Box::new(lammps::Writer::new(target))),
        Format::Xyz => Ok(Box::new(xyz::Writer::new(target))),
    }
}

/// What a run's particles are, and how its snapshots are told of them.
struct Body {
    info: Arc<RunInfo>,
    /// Wire of each particle, from 1; 0 for free spheres.
    wire: Vec<i32>,
    /// Layer of each particle, from 1 inside out; 0 for free spheres.
    layer: Vec<i32>,
}

impl Body {
    fn new(info: &Arc<RunInfo>) -> Self {
        let (mut wire, mut layer) = (vec![0; info.particles], vec![0; info.particles]);
        for (number, own) in info.wires.iter().enumerate() {
            wire[own.particles()].fill(number as i32 + 1);
            layer[own.particles()].fill(own.layer as i32 + 1);
        }
        Self { info: info.clone(), wire, layer }
    }

    /// Every bond slot with the wire (from 0) that it belongs to, broken ones included.
    fn bonds(&self) -> impl Iterator<Item = (usize, usize)> {
        self.info.wires.iter().enumerate().flat_map(|(wire, own)| own.bonds().map(move |slot| (wire, slot)))
    }

    /// The two bond slots beside each particle, where there are such.
    fn beside(snapshot: &Snapshot, particle: usize) -> impl Iterator<Item = usize> {
        let there = |slot: &usize| snapshot.bond_state[*slot] != BondState::Absent;
        [particle.checked_sub(1), Some(particle)].into_iter().flatten().filter(there)
    }

    /// A quantity of bonds, as the mean over those beside each particle that hold; 0 where none does.
    fn at_particles(snapshot: &Snapshot, quantity: &[f32]) -> Vec<f32> {
        let mean = |particle: usize| {
            let holding = || Self::beside(snapshot, particle).filter(|slot| snapshot.bond_state[*slot].holds());
            holding().map(|slot| quantity[slot]).sum::<f32>() / holding().count().max(1) as f32
        };
        (0..snapshot.position.len()).map(mean).collect()
    }

    /// Whether a bond beside each particle is broken.
    fn at_breaks(snapshot: &Snapshot) -> Vec<u8> {
        let broken = |slot: usize| snapshot.bond_state[slot] == BondState::Broken;
        (0..snapshot.position.len()).map(|p| u8::from(Self::beside(snapshot, p).any(broken))).collect()
    }
}

/// Least and greatest coordinates of what the particles fill (m).
fn bounds(position: &[[f32; 3]], radius: &[f32]) -> [[f32; 2]; 3] {
    std::array::from_fn(|k| {
        position
            .iter()
            .zip(radius)
            .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], (x, r)| [low.min(x[k] - r), high.max(x[k] + r)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_knows_its_own_files() {
        for (format, name) in [
            (Format::Parquet, "bond_series.parquet"),
            (Format::Vtk, "wires-0012.vtp"),
            (Format::Vtk, "bonds.pvd"),
            (Format::Lammps, "bonds.dump"),
            (Format::Xyz, "particles.xyz"),
        ] {
            let owners: Vec<Format> = Format::ALL.into_iter().filter(|own| own.writes(name)).collect();
            assert_eq!(owners, [format], "{name}");
        }
        for foreign in ["curve.csv", "wires-mine.vtp", "wires-.vtp", "wires.vtp", "notes.txt", ".parquet"] {
            assert!(!Format::ALL.into_iter().any(|format| format.writes(foreign)), "{foreign}");
        }
    }

    #[test]
    fn particles_get_the_mean_of_the_bonds_that_hold() {
        let bond_state = [BondState::Whole, BondState::Broken, BondState::Yielding, BondState::Absent].to_vec();
        let snapshot = Snapshot { position: vec![[0.0; 3]; 4], bond_state, ..Snapshot::default() };
        assert_eq!(Body::at_particles(&snapshot, &[2.0, 7.0, 4.0, 9.0]), [2.0, 2.0, 4.0, 4.0]);
        assert_eq!(Body::at_breaks(&snapshot), [0, 1, 1, 0]);
    }
}
