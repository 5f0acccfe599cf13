//! The files that a run has for other programs, in folders within its own that are named by their formats.

/// LAMMPS: particles and bonds before loading.
pub const DATA: &str = "particles.data";
/// LAMMPS: particles over time.
pub const ATOMS: &str = "particles.dump";
/// LAMMPS: bonds over time.
pub const BONDS: &str = "bonds.dump";
/// Extended XYZ.
pub const XYZ: &str = "particles.xyz";

pub use crate::scene::look::Format;

use std::fs;
use std::path::{Path, PathBuf};

/// Folders within that of a run that exports go into.
pub(super) fn folders(run: &Path) -> [PathBuf; Format::ALL.len()] {
    Format::ALL.map(|format| run.join(format.word()))
}

/// What was exported of a run into its folder `run`, and nothing else.
pub(super) fn files(run: &Path) -> Vec<PathBuf> {
    let own = |format: Format, folder: PathBuf| {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let writes = move |path: &PathBuf| path.file_name().is_some_and(|name| format.writes(&name.to_string_lossy()));
        entries.filter(move |path| path.is_file() && writes(path))
    };
    Format::ALL.into_iter().zip(folders(run)).flat_map(|(format, folder)| own(format, folder)).collect()
}

impl Format {
    /// The file to open first, which gets its name last.
    pub fn first_file(self) -> &'static str {
        match self {
            Self::Parquet => "curve.parquet",
            Self::Vtk => "wires.pvd",
            Self::Lammps => DATA,
            Self::Xyz => XYZ,
        }
    }

    /// Whether a file of this name is one that this format writes.
    pub fn writes(self, name: &str) -> bool {
        let numbered = |kind: &str| {
            let digits = name.strip_prefix(kind).and_then(|rest| rest.strip_suffix(".vtp"));
            digits.is_some_and(|digits| digits.len() > 1 && digits[1..].bytes().all(|b| b.is_ascii_digit()))
        };
        match self {
            Self::Parquet => ["curve", "wires", "ruptures", "wire_series", "bond_series"]
                .iter()
                .any(|table| name.strip_suffix(".parquet") == Some(table)),
            Self::Vtk => ["wires.pvd", "bonds.pvd"].contains(&name) || numbered("wires") || numbered("bonds"),
            Self::Lammps => [DATA, ATOMS, BONDS].contains(&name),
            Self::Xyz => name == XYZ,
        }
    }
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
}
