//! What people choose by one word for outputs: views, theme, colouring, formats. One row here is all that a new word needs in
//! the scene and on the command line.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Side of a frame, least and greatest (pixels): what a picture's labels need, and what graphics adapters draw.
pub const FRAME_SIDE: RangeInclusive<u32> = 120..=8192;
/// Magnification, least and greatest (-).
pub const ZOOM: RangeInclusive<f64> = 0.01..=1000.0;
/// How many times finer than its pixels a picture is drawn, least and greatest.
pub const SUPERSAMPLING: RangeInclusive<u32> = 1..=4;

/// An enum whose values are words, each with its meaning, in the order in which they are listed to people.
macro_rules! words {
    ($(#[$meta:meta])* $name:ident { $($variant:ident = $word:literal, $about:literal;)+ }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
        pub enum $name {
            $(#[doc = $about] #[serde(rename = $word)] $variant,)+
        }

        impl $name {
            /// Every value.
            pub const ALL: [$name; [$($word),+].len()] = [$($name::$variant),+];

            /// The word that people write.
            pub fn word(self) -> &'static str {
                match self {
                    $($name::$variant => $word,)+
                }
            }

            /// What it means.
            pub fn about(self) -> &'static str {
                match self {
                    $($name::$variant => $about,)+
                }
            }
        }
    };
}

words! {
    /// A panel of a frame.
    View {
        Overview = "overview", "The whole strand, its axis across the width";
        Midsection = "midsection", "Close-up on the section where it breaks, from the front and from the back";
        Cutaway = "cutaway", "The same section with its outer layers cut open in steps, so that inner wires are seen";
        Exploded = "exploded", "The same section with the layers taken apart, each in a strip of its own";
        CrossSection = "cross-section", "The cut at the same section: wires as discs, broken ones hollow, those that left it below";
        Unrolled = "unrolled", "Wire number against axial position";
        Curve = "curve", "Stress-strain curve; where nothing is pulled, torque, deflection, approach or speed over time";
        Scene = "scene", "Everything in one view; what free bodies get";
    }
}

words! {
    /// Dark or light ground.
    Theme {
        Dark = "dark", "Dark, for screens";
        Light = "light", "White, for paper";
    }
}

// The table above has no room for a derive.
#[allow(clippy::derivable_impls)]
impl Default for Theme {
    fn default() -> Self {
        Self::Dark
    }
}

words! {
    /// A moment of a run.
    Moment {
        Start = "start", "Before the first step";
        FirstBreak = "first-break", "The first snapshot with a broken bond";
        LastBreak = "last-break", "The first snapshot with all that breaks in the run broken";
        End = "end", "The last snapshot";
    }
}

words! {
    /// A table that a run writes at its snapshots where a scene asks for it.
    Table {
        Positions = "positions", "Centres of all particles";
        Velocities = "velocities", "Their velocities, half a step before";
        Spins = "spins", "Their spins, half a step before";
        Holds = "holds", "Force and moment of each hold on what it holds, in the step before";
        Contacts = "contacts", "Pairs of particles that touch: place, normal force, overlap, mean pressure; bodies.csv has rigid bodies";
        Grips = "grips", "Displacement and angle of the upper grip; lay length and lay radius of each layer";
    }
}

words! {
    /// Files for other programs.
    Format {
        Parquet = "parquet", "Tables and series per wire and per bond, for pandas, polars, DuckDB";
        Vtk = "vtk", "Wires and bonds over time (.vtp, .pvd), for ParaView and PyVista";
        Lammps = "lammps", "Data file, dump of atoms and dump of bonds over time, for OVITO";
        Xyz = "xyz", "Particles over time as extended XYZ, for OVITO and ASE";
    }
}

words! {
    /// Quantity that colours the wires.
    ColourBy {
        Stress = "stress", "True axial stress";
        Deviation = "stress-deviation", "True axial stress less its mean over all bonds that hold";
        PlasticStrain = "plastic-strain", "Equivalent plastic strain";
        Utilisation = "utilisation", "Share of the rupture limit";
        ContactPressure = "contact-pressure", "Contact pressure";
        Layer = "layer", "Layer";
        Wire = "wire", "Wire";
        Material = "material", "Material";
        Velocity = "velocity", "Speed";
    }
}
