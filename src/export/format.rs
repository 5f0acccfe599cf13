//! The names of the files of each format.

/// LAMMPS: particles and bonds before loading.
pub(super) const DATA: &str = "particles.data";
/// LAMMPS: particles over time.
pub(super) const ATOMS: &str = "particles.dump";
/// LAMMPS: bonds over time.
pub(super) const BONDS: &str = "bonds.dump";
/// Extended XYZ.
pub(super) const XYZ: &str = "particles.xyz";

pub use crate::scene::look::Format;

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
    pub(super) fn writes(self, name: &str) -> bool {
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
