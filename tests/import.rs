//! Wires of CAD models: files that CadQuery (OpenCascade) and ezdxf wrote, against what they were made with.
//!
//! `tests/import/make.py` makes the files, and says with what.

#[path = "import/bad.rs"]
mod bad;
#[path = "import/by_hand.rs"]
mod by_hand;
#[path = "common/program.rs"]
mod program;
#[path = "import/random.rs"]
mod random;
#[path = "import/round_trip.rs"]
mod round_trip;

use glam::DVec3;
use std::path::{Path, PathBuf};
use strandsnap::import::fault::Why;
use strandsnap::import::{Clearance, ImportOptions, Imported, import};

/// Lay radius, pitch, length, diameters of wires and core of the files (m).
const RADIUS: f64 = 0.402e-3;
const PITCH: f64 = 10e-3;
const LENGTH: f64 = 12e-3;
const WIRE: f64 = 0.39e-3;
const CORE: f64 = 0.41e-3;

fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/import").join(name)
}

fn read(name: &str, options: ImportOptions) -> Imported {
    import(&model(name), &options).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn with_diameter() -> ImportOptions {
    ImportOptions { diameter: Some(WIRE), ..ImportOptions::default() }
}

/// Asserts that there are a core and six wires around it as they were made, to the share that a program's own curves are
/// off (-).
fn assert_strand(found: &Imported, lay: f64, within: f64) {
    let names: Vec<_> = found.layers.iter().map(|layer| (layer.name.as_str(), layer.wires.len())).collect();
    assert_eq!(names, [("core", 1), ("layer 1", 6)]);
    let [core, outer] = &found.layers[..] else { panic!("two layers") };
    assert!(core.pitch.is_infinite() && core.radius < within * RADIUS, "{core:?}");
    assert!((outer.radius / RADIUS - 1.0).abs() < within, "lay radius {} m", outer.radius);
    assert!((outer.pitch / PITCH - 1.0).abs() < within, "pitch {} m", outer.pitch);
    assert_eq!(outer.lay, lay);
    assert!(outer.deviation < within * RADIUS, "{} m off the helix", outer.deviation);
    for wire in &found.wires {
        let [from, to] = [wire.points[0], wire.points[wire.points.len() - 1]];
        assert!(((to - from).z.abs() / LENGTH - 1.0).abs() < within, "{from} {to}");
    }
    assert!(found.forks.is_empty(), "{:?}", found.forks);
}

#[test]
fn curves_of_every_schema_and_unit_are_found() {
    for name in ["curves.step", "curves-ap203.step", "curves-ap242.step", "curves-inch.step", "curves-metre.step"] {
        let found = read(name, with_diameter());
        assert_strand(&found, 1.0, 1e-6);
        assert!(found.unread.is_empty() && !found.is_moved, "{name}: {:?}", found.unread);
        assert_eq!(found.clearance, Clearance::Free, "{name}");
    }
    let units = |name| read(name, with_diameter()).units;
    assert_eq!(units("curves.step"), [1e-3]);
    assert!((units("curves-inch.step")[0] - 0.0254).abs() < 1e-15);
    assert_eq!(units("curves-metre.step"), [1.0]);
}

/// Each wire is four rational Bézier pieces, in no order.
#[test]
fn rational_pieces_are_joined() {
    let found = read("rational.step", with_diameter());
    assert_strand(&found, 1.0, 1e-6);
    let pieces: Vec<usize> = found.wires.iter().map(|wire| wire.pieces).collect();
    assert_eq!(pieces, [1, 4, 4, 4, 4, 4, 4]);
}

/// A part set in six times, in an assembly within an assembly that lies along x.
#[test]
fn tubes_of_an_assembly_give_lines_and_diameters() {
    for name in ["assembly.step", "assembly-inch.step"] {
        let found = read(name, ImportOptions::default());
        assert_strand(&found, -1.0, 1e-4);
        let diameters: Vec<f64> = found.wires.iter().map(|wire| wire.diameter.unwrap()).collect();
        assert!((diameters[0] / CORE - 1.0).abs() < 1e-6, "{diameters:?}");
        assert!(diameters[1..].iter().all(|d| (d / WIRE - 1.0).abs() < 1e-4), "{diameters:?}");
        let axis = found.axis.unwrap();
        assert!(axis.direction.distance(DVec3::X) < 1e-6, "{axis:?}");
        let foot = axis.origin.reject_from_normalized(axis.direction);
        assert!(foot.distance(DVec3::new(0.0, -4e-3, 7e-3)) < 1e-8, "{axis:?}");
        assert!(found.is_moved && found.unread.is_empty(), "{name}: {:?}", found.unread);
        let low = found.wires.iter().flat_map(|w| &w.points).map(|p| p.z).fold(f64::INFINITY, f64::min);
        assert!(low.abs() < 1e-9, "{low}");
        let drawn = read(name, ImportOptions { as_drawn: true, ..ImportOptions::default() });
        assert!(!drawn.is_moved && drawn.wires.iter().flat_map(|w| &w.points).all(|p| p.x > 29e-3));
    }
}

#[test]
fn a_path_that_is_the_axis_of_a_tube_is_no_wire_of_its_own() {
    let found = read("tubes.step", ImportOptions::default());
    assert_eq!((found.wires.len(), found.layers.len()), (3, 1));
    let layer = &found.layers[0];
    assert!((layer.radius / RADIUS - 1.0).abs() < 1e-4 && (layer.pitch / PITCH - 1.0).abs() < 1e-4, "{layer:?}");
    assert!((layer.diameter.unwrap() / WIRE - 1.0).abs() < 1e-4);
    let told: Vec<&Why> = found.unread.iter().map(|one| &one.why).collect();
    assert_eq!(told, [&Why::Twice]);
}

/// A line, an arc of 60° with a radius of 5 mm, a line; as curves, and as a tube of 1 mm.
#[test]
fn a_bent_wire_keeps_its_place() {
    let arc = 5e-3 * std::f64::consts::FRAC_PI_3;
    let bent = [
        read("bent.step", ImportOptions { diameter: Some(1e-3), ..ImportOptions::default() }),
        read("bent-tube.step", ImportOptions::default()),
    ];
    for found in &bent {
        assert_eq!((found.wires.len(), found.wires[0].pieces), (1, 3));
        assert!((found.wires[0].diameter.unwrap() - 1e-3).abs() < 1e-12);
        assert!(found.axis.is_none() && found.layers.is_empty() && !found.is_moved);
        let points = &found.wires[0].points;
        let length: f64 = points.windows(2).map(|two| two[0].distance(two[1])).sum();
        assert!((length / (20e-3 + arc) - 1.0).abs() < 1e-4, "{length}");
        // On the arc, all points are 5 mm from its centre.
        let centre = DVec3::new(5e-3, 0.0, 0.0);
        let on_arc = points.iter().filter(|p| p.z > 1e-6 && (**p - centre).length() < 5.01e-3 && p.x < 2.49e-3);
        let mut count = 0;
        for point in on_arc {
            assert!((point.distance(centre) - 5e-3).abs() < 1e-8, "{point}");
            count += 1;
        }
        assert!(count > 10, "{count}");
    }
}

/// The chord error is what was asked for: the sagitta of an arc of curvature κ over a chord h, κ h²/8.
#[test]
fn points_are_as_close_as_the_chord_error_asks() {
    let curvature = RADIUS / (RADIUS.powi(2) + (PITCH / std::f64::consts::TAU).powi(2));
    for chord in [1e-8, 1e-7, 1e-6] {
        let found = read("curves.step", ImportOptions { chord: Some(chord), ..with_diameter() });
        for wire in &found.wires[1..] {
            let longest = wire.points.windows(2).map(|two| two[0].distance(two[1])).fold(0.0, f64::max);
            let sagitta = curvature * longest.powi(2) / 8.0;
            assert!(sagitta <= 1.01 * chord && sagitta > 0.5 * chord, "{chord}: {sagitta}");
        }
        assert_eq!(found.wires[0].points.len(), 2, "a straight wire needs its ends");
    }
}

#[test]
fn what_is_no_wire_is_named() {
    let found = read("others.step", with_diameter());
    assert_eq!(found.wires.len(), 1);
    let told: Vec<(&str, &Why)> = found.unread.iter().map(|one| (one.place.entity.as_str(), &one.why)).collect();
    assert!(told.iter().all(|(_, why)| matches!(why, Why::NoTube(_))), "{told:?}");
    assert_eq!(told.len(), 3, "{told:?}");
    assert!(found.unread.iter().all(|one| one.place.number.is_some() && one.place.line > 8));
}

#[test]
fn splines_and_lines_of_a_drawing_are_found() {
    let found = read("splines.dxf", with_diameter());
    assert_strand(&found, 1.0, 1e-6);
    assert_eq!(found.wires.iter().map(|wire| wire.pieces).collect::<Vec<_>>(), [2, 4, 4, 4, 4, 4, 4]);
    assert_eq!(found.unread.len(), 1);
    assert_eq!((found.unread[0].place.entity.as_str(), &found.unread[0].why), ("TEXT", &Why::Kind));
}

/// Points alone lie on the helix, so that the fit goes through them.
#[test]
fn polylines_in_inches_along_x_are_found() {
    let found = read("polylines-inch.dxf", with_diameter());
    assert_strand(&found, 1.0, 1e-6);
    assert!(found.is_moved && (found.units[0] - 0.0254).abs() < 1e-15);
    assert_eq!(found.wires[1].points.len(), 61, "corners are kept, and nothing between them");
}

#[test]
fn helices_in_blocks_are_found() {
    let without = import(&model("helices.dxf"), &with_diameter()).unwrap_err();
    assert!(without.to_string().contains("does not say in what unit"), "{without}");
    for (unit, scale) in [(1e-3, 1.0), (0.0254, 25.4)] {
        let options = ImportOptions { unit: Some(unit), diameter: Some(WIRE * scale), ..ImportOptions::default() };
        let found = read("helices.dxf", options);
        let [_, outer] = &found.layers[..] else { panic!("{:?}", found.layers) };
        assert_eq!(outer.wires.len(), 6);
        assert!((outer.radius / (RADIUS * scale) - 1.0).abs() < 1e-5, "{}", outer.radius);
        assert!((outer.pitch / (PITCH * scale) - 1.0).abs() < 1e-5, "{}", outer.pitch);
        assert_eq!(outer.lay, 1.0);
    }
}

/// In the plane x, z: a polyline with a bulge of 60°, a quarter of a circle, a quarter of an ellipse, and a circle.
#[test]
fn entities_in_a_plane_of_their_own_are_found() {
    let found = read("plane.dxf", ImportOptions { diameter: Some(1e-4), ..ImportOptions::default() });
    assert_eq!(found.wires.len(), 3);
    assert!(found.wires.iter().flat_map(|wire| &wire.points).all(|point| point.y.abs() < 1e-12));
    let lengths: Vec<f64> = found
        .wires
        .iter()
        .map(|wire| wire.points.windows(2).map(|two| two[0].distance(two[1])).sum::<f64>() * 1e3)
        .collect();
    // A quarter of an ellipse with semi-axes 8 and 4 (tables of E(k), k² = 3/4: 8 × 1.211056).
    let expected = [20.0 + 5.0 * std::f64::consts::FRAC_PI_3, 5.0 * std::f64::consts::FRAC_PI_2, 8.0 * 1.211_056];
    for (found, expected) in lengths.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-4, "{lengths:?} {expected}");
    }
    // The bent wire runs from z = −10 mm upwards and leans to x > 0.
    let ends = found.wires[0].points.iter().map(|p| *p * 1e3).collect::<Vec<_>>();
    assert!(ends[0].distance(DVec3::new(0.0, 0.0, -10.0)) < 1e-9, "{}", ends[0]);
    assert!(ends[ends.len() - 1].x > 10.0 && ends[ends.len() - 1].z > 5.0);
    assert_eq!((found.unread[0].place.entity.as_str(), &found.unread[0].why), ("CIRCLE", &Why::Closed));
}

#[test]
fn text_comes_through_the_door_of_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.csv");
    let line = |phase: f64| -> String {
        let at = |k: usize| {
            let z = 0.2 * k as f64;
            let (sin, cos) = (phase + std::f64::consts::TAU * z / 10.0).sin_cos();
            format!("{:.9};{:.9};{z}\n", 0.402 * cos, 0.402 * sin).replace('.', ",")
        };
        (0..=60).map(at).collect()
    };
    let wires: Vec<String> = (0..6).map(|i| line(f64::from(i) * std::f64::consts::FRAC_PI_3)).collect();
    std::fs::write(&path, format!("x;y;z\n0;0;0\n0;0;12\n\n{}", wires.join("\n"))).unwrap();
    let found = import(&path, &with_diameter()).unwrap();
    assert_strand(&found, 1.0, 1e-6);
    let inches = import(&path, &ImportOptions { unit: Some(0.0254), ..with_diameter() }).unwrap();
    assert!((inches.layers[1].pitch / (25.4 * PITCH) - 1.0).abs() < 1e-6);
}
