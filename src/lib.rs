//! strandsnap: a discrete-element engine for stranded wire under load, and the pictures that show how it fails.
//!
//! Each wire is a chain of particles joined by bonds with plasticity, hardening and rupture; wires touch with elastoplastic,
//! frictional contacts. A scene (TOML) says what is laid up, held and pulled; a run says which wires break first, where, and
//! what the strand carried. The program `strandsnap` is [`cli`]; everything that it does can be called from here.
//!
//! # Pages
//!
//! - [`manual::physics`]: every equation with its source, every parameter with its scene key, unit and default, limits
//! - [`manual::import`]: wires of CAD models (STEP, DXF, text): what is read, what is made of it
//! - [`manual::architecture`]: how the modules are layered, where to find what, how to add a law, a key, a picture, a case
//! - [`manual::glossary`]: what the words mean
//! - [`manual::python`]: the package for Python programs and notebooks
//! - [`scene::raw`], [`scene::keys`]: all keys of a scene
//!
//! # Modules
//!
//! They lie on floors, and a module uses only those above it in this list:
//!
//! - [`base`]: units, vectors, errors
//! - [`law`], [`mod@reference`]: formulas of the model; closed forms to check it by
//! - [`scene`]: from TOML to a resolved scene and a plan of what it needs
//! - [`strand`]: from a resolved scene to wires, particles and bonds
//! - [`engine`]: the steps
//! - [`observe`]: what is shown a run and writes it down
//! - `render`: pictures (feature `render`)
//! - `gpu`: formulas of the engine on a graphics processor (feature `gpu`)
//! - [`run`]: one run from scene to results
//! - [`page`]: the HTML page of a run (feature `report`)
//! - [`study`]: many runs (feature `study`)
//! - [`export`]: a run in files that other programs open (feature `export`: Parquet and VTK)
//! - [`import`]: wires of CAD models as centre lines (STEP, DXF, text)
//! - `explore`: an interactive picture of a run (feature `explore`)
//! - [`cli`]: the command line (feature `cli`)
//!
//! # A wire that snaps
//!
//! ```
//! use std::{path::Path, sync::atomic::AtomicBool};
//! use strandsnap::{run, scene};
//!
//! let text = r#"
//!     about = "A copper wire of 0.39 mm, 20 mm long, pulled until it snaps."
//!     wire = [{ diameter = "0.39 mm", from = ["0 mm", "0 mm", "0 mm"], to = ["0 mm", "0 mm", "20 mm"] }]
//!     grip = { length = "2 mm", speed = "5 m/s" }
//!     stop = { strain = "20 %", stress_fraction = "50 %" }
//!     [bond]
//!     law = "elasto-plastic"
//!     damping = 0.02
//!     hardening = { form = "voce", yield_stress = "100 MPa", saturation = "180 MPa", rate = 12, linear = "540 MPa" }
//!     rupture = { criterion = "plastic-strain", strain = "8 %" }
//! "#;
//! let scene = scene::parse(text, "short-wire.toml", Path::new("."), &[])?;
//! let summary = run::summarise(&scene, Vec::new(), &AtomicBool::new(false))?;
//! let strength = summary.tensile_strength_mpa.expect("the wire snaps");
//! println!("{strength:.1} MPa at a strain of {:.1} %", summary.fracture_elongation_percent.unwrap_or_default());
//!
//! // True stress at the plastic strain of rupture, over a section that has thinned at constant volume.
//! let p = 0.08_f64;
//! let law = (100.0 + 180.0 * (1.0 - (-12.0 * p).exp()) + 540.0 * p) * (-p).exp();
//! assert!((strength / law - 1.0).abs() < 0.005, "{strength} MPa instead of {law} MPa");
//! # Ok::<(), strandsnap::base::error::Error>(())
//! ```

#[warn(missing_docs)]
pub mod base;
#[cfg(feature = "cli")]
pub mod cli;
#[warn(missing_docs)]
pub mod engine;
#[cfg(feature = "explore")]
pub mod explore;
#[warn(missing_docs)]
pub mod export;
#[cfg(feature = "gpu")]
#[warn(missing_docs)]
pub mod gpu;
#[warn(missing_docs)]
pub mod import;
#[warn(missing_docs)]
pub mod law;
pub mod manual;
pub mod observe;
#[cfg(feature = "report")]
pub mod page;
#[warn(missing_docs)]
pub mod reference;
#[cfg(feature = "render")]
pub mod render;
#[warn(missing_docs)]
pub mod run;
#[warn(missing_docs)]
pub mod scene;
#[warn(missing_docs)]
pub mod strand;
#[cfg(feature = "study")]
pub mod study;
