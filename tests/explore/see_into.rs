//! Views into the strand: a section whose wires are discs, layers that are seen through.

use crate::shown::{Shown, folder, next_words, say, skipped};
use crate::synthetic::Run;
use image::RgbImage;
use serde_json::json;
use std::path::Path;
use strandsnap::engine::view::{BondState, Snapshot};
use strandsnap::explore::{View, picture};
use strandsnap::scene::spec::ColourBy;

/// Side of the pictures (px), and what it spans (mm).
const SIDE: u32 = 480;
const SPAN: f64 = 3.4;

fn drawn(run: &Path, view: &View) -> RgbImage {
    image::load_from_memory(&picture(run, None, view, [SIDE; 2]).unwrap()).unwrap().into_rgb8()
}

/// The last snapshot along the axis, from above, cut at `z` (mm).
fn section(run: &Run, z: f64) -> View {
    let state = (run.snapshots().len() - 1) as f64;
    View {
        state,
        azimuth: -90.0,
        centre: [0.0, 0.0, z],
        height: SPAN,
        cut: Some(z),
        colour: ColourBy::Layer,
        ..View::default()
    }
}

/// Where a wire passes a section, x and y (mm), by its two particles there; `None` where it has a gap.
fn crossing(snapshot: &Snapshot, mut bonds: std::ops::Range<usize>, z: f64) -> Option<[f64; 2]> {
    let at = |p: usize| snapshot.position[p].map(|x| f64::from(x) * 1e3);
    let i = bonds.find(|i| snapshot.bond_state[*i].holds() && at(*i)[2] <= z && at(i + 1)[2] > z)?;
    let [from, to] = [at(i), at(i + 1)];
    let share = (z - from[2]) / (to[2] - from[2]);
    Some([0, 1].map(|k| from[k] + share * (to[k] - from[k])))
}

/// How much redder than green and blue.
fn redness([r, g, b]: [u8; 3]) -> i32 {
    i32::from(r) - i32::from(g.max(b))
}

#[test]
fn a_section_shows_whole_wires_as_discs_and_broken_ones_hollow() {
    let test = "a_section_shows_whole_wires_as_discs_and_broken_ones_hollow";
    if strandsnap::render::check().is_err() {
        return skipped(test, "no graphics adapter");
    }
    let (folder, run) = (folder(12), Run::new(12));
    let snapshot = run.snapshots().pop().unwrap().clone();
    // Far from all breaks, anywhere between particles, and through one of the outer layer.
    let outer = run.info.wires.last().unwrap();
    let through = f64::from(snapshot.position[outer.first + outer.len / 4][2]) * 1e3;
    for z in [31.03, 31.11, 31.27, through] {
        let view = section(&run, z);
        let image = drawn(folder.path(), &view);
        if let Some(folder) = std::env::var_os("KEEP_PICTURES") {
            image.save(Path::new(&folder).join(format!("section-{z}.png"))).unwrap();
        }
        let scale = f64::from(SIDE) / SPAN;
        let pixel = |x: f64, y: f64| -> [u8; 3] {
            // The eye looks along -z with y up: x then points to the left or right, which the first wire tells.
            let place = |v: f64| (f64::from(SIDE) / 2.0 + v * scale).round() as u32;
            image.get_pixel(place(x), place(-y)).0
        };
        let (mut whole, mut hollow) = (0, 0);
        for wire in &run.info.wires {
            let [x, y] = crossing(&snapshot, wire.bonds(), z).expect("it passes here");
            let radius = f64::from(snapshot.radius[wire.first]) * 1e3;
            let centre = pixel(x, y);
            let rim: Vec<[u8; 3]> = (0..8)
                .map(|k| {
                    let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
                    pixel(x + 0.85 * radius * angle.cos(), y + 0.85 * radius * angle.sin())
                })
                .collect();
            let red = rim.iter().filter(|pixel| redness(**pixel) > 60).count();
            if wire.bonds().any(|bond| snapshot.bond_state[bond] == BondState::Broken) {
                assert!(centre.iter().all(|c| *c < 60), "the middle of a broken wire is dark: {centre:?} at {x} {y}");
                assert!(red >= 7, "its ring has the signal colour: {rim:?}");
                hollow += 1;
            } else {
                assert!(centre.iter().any(|c| *c > 60), "the middle of a whole wire has its colour: {centre:?}");
                assert!(red <= 1, "its ring has not the signal colour: {rim:?}");
                whole += 1;
            }
        }
        assert_eq!((whole, hollow), (28, 6));
    }
}

#[test]
fn layers_in_front_are_seen_through_and_hide_nothing() {
    let test = "layers_in_front_are_seen_through_and_hide_nothing";
    if strandsnap::render::check().is_err() {
        return skipped(test, "no graphics adapter");
    }
    let (folder, run) = (folder(12), Run::new(12));
    let plain = View { colour: ColourBy::Layer, centre: [0.0, 0.0, 20.0], height: SPAN, ..section(&run, 0.0) };
    let plain = View { azimuth: 0.0, cut: None, ..plain };
    let solid = drawn(folder.path(), &plain);
    let ghost = drawn(folder.path(), &View { ghost_layers: vec![1, 2], ..plain.clone() });
    let inner = drawn(folder.path(), &View { hidden_layers: vec![1, 2], ..plain.clone() });
    if let Some(folder) = std::env::var_os("KEEP_PICTURES") {
        ghost.save(Path::new(&folder).join("ghost.png")).unwrap();
    }
    // A quarter of the samples of a pixel are a ghost's: its light is between that of what lies behind and of what hides it.
    let mut between = [0usize; 2];
    for (ghost, (solid, inner)) in ghost.pixels().zip(solid.pixels().zip(inner.pixels())) {
        for k in 0..3 {
            let [ghost, solid, inner] = [ghost[k], solid[k], inner[k]].map(|c| (f64::from(c) / 255.0).powf(2.2));
            if (solid - inner).abs() > 0.1 {
                let share = (ghost - inner) / (solid - inner);
                between[usize::from((0.05..0.6).contains(&share))] += 1;
            }
        }
    }
    let [outside, inside] = between;
    assert!(inside > 10_000 && inside > 9 * outside, "{inside} pixels lie between both pictures, {outside} do not");
    // Nothing see-through changes what a view without such layers shows.
    assert_eq!(drawn(folder.path(), &plain), solid);
}

#[test]
fn where_all_is_hidden_there_is_only_the_ground() {
    if strandsnap::render::check().is_err() {
        return skipped("where_all_is_hidden_there_is_only_the_ground", "no graphics adapter");
    }
    let (folder, run) = (folder(12), Run::new(12));
    let hidden = View { hidden_layers: vec![0, 1, 2], ..section(&run, 20.0) };
    let below = View { cut: Some(-500.0), ..section(&run, 20.0) };
    let empty = drawn(folder.path(), &hidden);
    assert!(empty.pixels().all(|pixel| pixel == empty.get_pixel(0, 0)));
    assert_eq!(drawn(folder.path(), &below), empty);
}

#[test]
fn in_perspective_the_near_end_is_as_much_wider_as_a_pinhole_camera_shows_it() {
    let test = "in_perspective_the_near_end_is_as_much_wider_as_a_pinhole_camera_shows_it";
    if strandsnap::render::check().is_err() {
        return skipped(test, "no graphics adapter");
    }
    let (folder, run) = (folder(2), Run::new(2));
    let snapshot = &run.snapshots()[0];
    let place = |p: &[f32; 3]| p.map(|x| f64::from(x) * 1e3);
    let far_out = |p: &[f32; 3]| place(p)[0].hypot(place(p)[1]);
    let radius = f64::from(snapshot.radius[0]) * 1e3;
    let out = snapshot.position.iter().map(far_out).fold(0.0, f64::max) + radius;
    let ends = snapshot.position.iter().map(|p| place(p)[2]);
    let [low, high] = [ends.clone().fold(f64::MAX, f64::min), ends.fold(f64::MIN, f64::max)];
    let height = 8.0 * out;
    let along = View { azimuth: -90.0, centre: [0.0, 0.0, 0.5 * (low + high)], height, ..View::default() };
    // How far from the middle anything is drawn (px), on the ground that the corner shows.
    let half = |view: &View| {
        let image = drawn(folder.path(), view);
        let ground = image.get_pixel(0, 0);
        let differs = |pixel: &image::Rgb<u8>| (0..3).any(|k| pixel[k].abs_diff(ground[k]) > 12);
        let middle = 0.5 * f64::from(SIDE);
        let away = |x: u32, y: u32| (f64::from(x) + 0.5 - middle).hypot(f64::from(y) + 0.5 - middle);
        let seen = image.enumerate_pixels().filter(|(.., pixel)| differs(pixel));
        seen.map(|(x, y, _)| away(x, y)).fold(0.0, f64::max)
    };
    let scale = f64::from(SIDE) / height;
    let parallel = half(&along);
    assert!((parallel - out * scale).abs() < 1.5, "{parallel} instead of {}", out * scale);
    for angle in [2.0f64, 4.0, 6.0] {
        let distance = 0.5 * height / (0.5 * angle.to_radians()).tan();
        let nearest = distance - 0.5 * (high - low);
        // The rounded end reaches half a radius nearer, at most.
        let [least, most] = [nearest, nearest - radius].map(|to| out * scale * distance / to);
        let seen = half(&View { perspective: angle, ..along.clone() });
        assert!(seen > least - 1.5 && seen < most + 1.5, "{angle}°: {seen} px, between {least} and {most} expected");
        assert!(seen > parallel * 1.1);
    }
}

/// By similar triangles: an eye at azimuth 0 and elevation 0 looks along +x, with z to the right and y up.
#[test]
fn in_perspective_a_click_finds_what_a_pinhole_camera_shows_there() {
    let Some(shown) = Shown::start("in_perspective_a_click_finds_what_a_pinhole_camera_shows_there") else { return };
    let run = Run::new(12);
    let snapshot = &run.snapshots()[0];
    let (height, angle, middle) = (30.0, 40.0f64, 60.0);
    let view = View { centre: [0.0, 0.0, middle], height, perspective: angle, ..View::default() };
    let distance = 0.5 * height / (0.5 * angle.to_radians()).tan();
    let spacing = 2e3 * f64::from(snapshot.radius[0]);
    let mut socket = shown.socket();
    let mut wires = std::collections::HashSet::new();
    for number in 0..9 {
        // The particle at this height that lies nearest to the eye hides what is behind it.
        let z = middle + 4.0 * f64::from(number - 4);
        let place = |i: usize| snapshot.position[i].map(|x| f64::from(x) * 1e3);
        let near = (0..run.info.wire_particles).filter(|i| (place(*i)[2] - z).abs() < spacing);
        let nearest = near.min_by(|a, b| place(*a)[0].total_cmp(&place(*b)[0])).unwrap();
        let [x, y, z] = place(nearest);
        let larger = distance / (distance + x);
        let at = [0.5 + (z - middle) * larger / (1.6 * height), 0.5 - y * larger / height];
        say(&mut socket, json!({ "pick": { "number": number, "size": [768, 480], "at": at, "view": view } }));
        let found = next_words(&mut socket, "picked");
        let wire = run.info.wires.iter().position(|wire| wire.particles().contains(&nearest)).unwrap();
        assert_eq!(found["wire"], wire, "at {at:?}: {found}");
        let off = found["position"][2].as_f64().unwrap() - z;
        assert!(off.abs() < 1.5 * spacing, "{off} mm from {z} mm");
        wires.insert(wire);
    }
    assert!(wires.len() > 4, "the same wire everywhere: {wires:?}");
}
