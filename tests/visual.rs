//! What frames show, asserted pixel by pixel. Tests that need a graphics adapter say so by name where there is none.

#![cfg(feature = "render")]

mod common;

use common::{bond_at, curve, ka4_like, snapped, stretched, told, two_spheres};
use image::RgbImage;
use std::io::Write;
use std::sync::Arc;
use strandsnap::engine::view::{RunInfo, Rupture, Sample, Snapshot};
use strandsnap::observe::Observer;
use strandsnap::render::colour::DARKEST;
use strandsnap::render::{FrameWriter, Renderer};
use strandsnap::scene::spec::{CameraSpec, ColourBy, OutputSpec, Theme, View};

/// Whether `test` can run here; else says that it did not.
fn adapter(test: &str) -> bool {
    let there = strandsnap::render::check().is_ok();
    if !there {
        // Past the test harness, which hides what passing tests print.
        let _ = writeln!(std::io::stderr(), "SKIPPED (no graphics adapter): {test}");
    }
    there
}

fn draw(info: &RunInfo, options: &OutputSpec, snapshot: &Snapshot, ruptures: &[Rupture]) -> RgbImage {
    let mut renderer = Renderer::new(info, options).expect("the adapter opens");
    let mut history = told(&curve(snapshot.sample.strain as f32), ruptures);
    renderer.follow(&mut history, snapshot);
    renderer.draw(snapshot, &history).expect("the frame is drawn")
}

/// Keeps a picture for looking at, in the folder named by STRANDSNAP_KEEP_PICTURES.
fn keep(name: &str, picture: &RgbImage) {
    if let Some(folder) = std::env::var_os("STRANDSNAP_KEEP_PICTURES") {
        let path = std::path::Path::new(&folder).join(format!("{name}.png"));
        picture.save(&path).expect("the folder of kept pictures can be written");
    }
}

fn panel(info: &RunInfo, options: &OutputSpec, view: View) -> [u32; 4] {
    let renderer = Renderer::new(info, options).expect("the adapter opens");
    let found = renderer.panels().into_iter().find(|(v, _)| *v == view);
    found.expect("the view is in the frame").1
}

fn near(a: [u8; 3], b: [u8; 3], tolerance: i32) -> bool {
    (0..3).all(|k| (i32::from(a[k]) - i32::from(b[k])).abs() <= tolerance)
}

/// Signal-coloured pixels in a rectangle: red far above green and blue, also when shaded.
fn signal_pixels(picture: &RgbImage, [x, y, w, h]: [u32; 4]) -> usize {
    let red = |p: &image::Rgb<u8>| p.0[0] > 110 && p.0[0] / 2 > p.0[1] && p.0[0] / 2 > p.0[2];
    (y..y + h).flat_map(|y| (x..x + w).map(move |x| (x, y))).filter(|&(x, y)| red(picture.get_pixel(x, y))).count()
}

#[test]
fn every_shader_is_valid() {
    let module = naga::front::wgsl::parse_str(strandsnap::render::SHADER).expect("the shader parses");
    let mut validator = naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::MULTISAMPLED_SHADING,
    );
    validator.validate(&module).expect("the shader is valid");
    let names: Vec<_> = module.entry_points.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["vs", "fs_sampled", "fs_whole", "vs_roof", "vs_tube", "fs_roof", "fs_thin_roof", "fs_tube"]);
}

#[test]
fn a_frame_has_the_size_asked_for() {
    if !adapter("a_frame_has_the_size_asked_for") {
        return;
    }
    let info = ka4_like();
    let (snapshot, ruptures) = snapped(&info, 0.27, 7);
    for size in [[1280, 720], [641, 363], [3840, 2160]] {
        let options = OutputSpec { frame_size: size, ..Default::default() };
        let picture = draw(&info, &options, &snapshot, &ruptures);
        keep(&format!("size-{}", size[0]), &picture);
        assert_eq!(picture.dimensions(), (size[0], size[1]));
    }
}

#[test]
fn a_size_that_cannot_be_drawn_is_refused() {
    let options = OutputSpec { frame_size: [40, 20], ..Default::default() };
    let message = Renderer::new(&ka4_like(), &options).err().expect("40 × 20 is too small").to_string();
    assert!(message.contains("40 × 20"), "{message}");
}

#[test]
fn two_draws_of_one_snapshot_are_identical() {
    if !adapter("two_draws_of_one_snapshot_are_identical") {
        return;
    }
    let info = ka4_like();
    let options = OutputSpec { views: View::ALL[..7].to_vec(), theme: Theme::Light, ..Default::default() };
    let (snapshot, ruptures) = snapped(&info, 0.27, 7);
    let mut renderer = Renderer::new(&info, &options).expect("the adapter opens");
    let points = curve(0.27);
    let mut history = told(&points, &ruptures);
    renderer.follow(&mut history, &snapshot);
    let first = renderer.draw(&snapshot, &history).expect("drawn");
    // Another snapshot in between must leave no trace.
    renderer.draw(&stretched(&info, 0.1), &told(&points[..100], &[])).expect("drawn");
    let again = renderer.draw(&snapshot, &history).expect("drawn");
    keep("all-light", &first);
    assert!(first == again, "the same data gave different pictures");
    println!("{} on {}", renderer.timings(), renderer.adapter().unwrap_or("no adapter"));
}

/// A view of the break of outer wire 25 (number 24 from 0) from the side where it broke.
fn facing_the_break(info: &RunInfo) -> (OutputSpec, usize) {
    let bond = bond_at(info, 24, 64e-3);
    let [x, y, z] = info.rest_position[bond];
    // The eye at elevation 0 looks along +x from −x; at elevation e it sits at angle π − e.
    let elevation = std::f64::consts::PI - f64::from(y.atan2(x));
    let camera = CameraSpec { elevation, focus_z: Some(z.into()), zoom: 2.0, azimuth: 0.0 };
    (OutputSpec { views: vec![View::Midsection], colour: ColourBy::Layer, camera, ..Default::default() }, bond)
}

#[test]
fn a_broken_wire_shows_a_gap_between_two_marked_ends() {
    if !adapter("a_broken_wire_shows_a_gap_between_two_marked_ends") {
        return;
    }
    let info = ka4_like();
    let (options, bond) = facing_the_break(&info);
    let (whole, (broken, ruptures)) = (stretched(&info, 0.27), snapped(&info, 0.27, 1));
    let before = draw(&info, &options, &whole, &[]);
    // Without the list of ruptures, so that no number is written over the place.
    let after = draw(&info, &options, &broken, &[]);
    keep("gap-before", &before);
    keep("gap-after", &after);
    let [x, y, w, h] = panel(&info, &options, View::Midsection);
    let front = [x, y, w, h / 2];
    let (cx, cy) = (x + w / 2, y + h / 4);
    // By layer, the outer one is green and the one below it blue.
    let (seen, below) = (before.get_pixel(cx, cy).0, after.get_pixel(cx, cy).0);
    assert!(seen[1] > seen[2] && below[2] > below[1], "before {seen:?}, after {below:?}");
    assert_eq!(signal_pixels(&before, front), 0, "no break, no signal colour");
    let (left, right) = ([x, y, w / 2, h / 2], [cx, y, w / 2, h / 2]);
    assert!(signal_pixels(&after, left) > 200, "left end marked");
    assert!(signal_pixels(&after, right) > 200, "right end marked");
    assert_eq!(signal_pixels(&after, [cx - 3, cy - 3, 7, 7]), 0, "nothing of the wire in the gap");
    // A light collar and a dark one beside the red: who sees no red sees the end.
    let collars = |picture: &RgbImage, [x, y, w, h]: [u32; 4]| {
        let all = (y..y + h).flat_map(|y| (x..x + w).map(move |x| picture.get_pixel(x, y).0));
        let [light, dark] = [|c: &[u8; 3]| c.iter().all(|v| *v > 150), |c: &[u8; 3]| c.iter().all(|v| *v < 40)];
        [all.clone().filter(light).count(), all.filter(dark).count()]
    };
    let near = [cx - 130, cy - 40, 260, 80];
    assert_eq!(collars(&before, near), [0, 0]);
    let [light, dark] = collars(&after, near);
    assert!(light > 60 && dark > 30, "{light} light and {dark} dark pixels");
    assert_eq!(ruptures[0].bond, bond);
}

#[test]
fn the_colour_bar_ends_in_the_colours_of_the_range() {
    if !adapter("the_colour_bar_ends_in_the_colours_of_the_range") {
        return;
    }
    let info = ka4_like();
    for (by, map) in [(ColourBy::Stress, colorous::VIRIDIS), (ColourBy::Velocity, colorous::CIVIDIS)] {
        let options = OutputSpec { colour: by, views: vec![View::Unrolled], ..Default::default() };
        let picture = draw(&info, &options, &stretched(&info, 0.1), &[]);
        for (x, fraction) in [(989, DARKEST), (1258, 1.0)] {
            let c = map.eval_continuous(fraction);
            let seen = picture.get_pixel(x, 29).0;
            assert!(near(seen, [c.r, c.g, c.b], 4), "{by:?} {fraction}: {seen:?} {c:?}");
        }
    }
}

#[test]
fn the_unrolled_map_marks_every_broken_bond_in_its_row() {
    let info = ka4_like();
    let options = OutputSpec { views: vec![View::Unrolled], ..Default::default() };
    let (snapshot, ruptures) = snapped(&info, 0.27, 7);
    let whole = draw(&info, &options, &stretched(&info, 0.27), &[]);
    let broken = draw(&info, &options, &snapshot, &ruptures);
    keep("unrolled", &broken);
    let area = panel(&info, &options, View::Unrolled);
    assert_eq!(signal_pixels(&whole, area), 0);
    // Seven marks of 5 × 15 or more pixels each, none hidden by a number.
    let marked = signal_pixels(&broken, area);
    assert!((7 * 60..7 * 140).contains(&marked), "{marked}");
}

#[test]
fn the_part_in_a_grip_is_grey() {
    let info = ka4_like();
    let options = OutputSpec { views: vec![View::Unrolled], ..Default::default() };
    let picture = draw(&info, &options, &stretched(&info, 0.2), &[]);
    let [x, y, w, h] = panel(&info, &options, View::Unrolled);
    let colourful = |px: u32| {
        let [low, high] = (y + h / 4..y + h / 2).fold([0, 0], |[a, b], py| {
            let c = picture.get_pixel(px, py).0;
            let spread = c.iter().max().unwrap() - c.iter().min().unwrap();
            if spread > 40 { [a, b + 1] } else { [a + 1, b] }
        });
        high > low
    };
    assert!(!colourful(x + 90), "in the lower grip");
    assert!(colourful(x + w / 2), "in the gauge");
}

#[test]
fn layers_apart_show_all_three_layers() {
    if !adapter("layers_apart_show_all_three_layers") {
        return;
    }
    let info = ka4_like();
    let options = OutputSpec { views: vec![View::Exploded], colour: ColourBy::Layer, ..Default::default() };
    let picture = draw(&info, &options, &stretched(&info, 0.1), &[]);
    keep("exploded-layer", &picture);
    let [x, y, w, h] = panel(&info, &options, View::Exploded);
    let column: Vec<[u8; 3]> = (y..y + h).map(|py| picture.get_pixel(x + w / 2, py).0).collect();
    let blue = |c: &&[u8; 3]| c[2] > 110 && c[2] > c[0] + 40;
    let green = |c: &&[u8; 3]| c[1] > 70 && c[1] > c[0] + 40 && c[1] > c[2] + 15;
    let orange = |c: &&[u8; 3]| c[0] > 110 && c[0] > c[2] + 60;
    for (name, count) in [
        ("inner", column.iter().filter(orange).count()),
        ("middle", column.iter().filter(blue).count()),
        ("outer", column.iter().filter(green).count()),
    ] {
        assert!(count > 40, "{name}: {count} pixels");
    }
}

/// Pixels of a panel in the colours of the inner, the middle and the outer layer.
fn layer_pixels(info: &RunInfo, picture: &RgbImage, options: &OutputSpec, view: View) -> [usize; 3] {
    let [x, y, w, h] = panel(info, options, view);
    let mut counts = [0; 3];
    for p in (y + 30..y + h).flat_map(|py| (x..x + w).map(move |px| picture.get_pixel(px, py).0)) {
        let [r, g, b] = p.map(i32::from);
        counts[0] += usize::from(r > 110 && r > b + 60 && g < r - 20 && g > r / 2);
        counts[1] += usize::from(b > 110 && b > r + 40);
        counts[2] += usize::from(g > 70 && g > r + 40 && g > b + 15);
    }
    counts
}

#[test]
fn the_cutaway_shows_inner_wires_and_quiet_cut_faces() {
    if !adapter("the_cutaway_shows_inner_wires_and_quiet_cut_faces") {
        return;
    }
    let info = ka4_like();
    let seen = |view| {
        let options = OutputSpec { views: vec![view], colour: ColourBy::Layer, ..Default::default() };
        let picture = draw(&info, &options, &stretched(&info, 0.1), &[]);
        keep(&format!("layers-{}", view.word()), &picture);
        let area = panel(&info, &options, view);
        let face = Theme::Dark.style().cut;
        let grey = |p: &image::Rgb<u8>| {
            let [r, g, b] = [0, 1, 2].map(|k| f32::from(p.0[k]) / f32::from(face[k]));
            r > 0.4 && (r - g).abs() < 0.06 && (g - b).abs() < 0.06
        };
        let faces = (area[1] + 40..area[1] + area[3] - 40)
            .flat_map(|y| (area[0]..area[0] + area[2]).map(move |x| (x, y)))
            .filter(|&(x, y)| grey(picture.get_pixel(x, y)))
            .count();
        (layer_pixels(&info, &picture, &options, view), faces)
    };
    let ([inner, middle, outer], faces) = seen(View::Cutaway);
    assert!(inner > 5_000 && middle > 5_000 && outer > 20_000, "{inner}, {middle}, {outer}");
    let ([whole_inner, _, whole_outer], text) = seen(View::Midsection);
    assert!(whole_inner < 200 && whole_outer > 20_000, "nothing is cut in the close-up: {whole_inner}, {whole_outer}");
    // Words over the panels are grey as well.
    assert!(faces > 3 * text, "{faces} pixels of cut faces, {text} of text");
}

#[test]
fn the_gap_of_a_lone_broken_wire_shows_the_ground() {
    if !adapter("the_gap_of_a_lone_broken_wire_shows_the_ground") {
        return;
    }
    let info = common::single_wire();
    let bond = bond_at(&info, 0, 60e-3);
    for theme in Theme::ALL {
        let camera =
            CameraSpec { focus_z: Some(f64::from(info.rest_position[bond][2]) + 0.19e-3), ..Default::default() };
        let options = OutputSpec { views: vec![View::Midsection], camera, theme, ..Default::default() };
        let whole = stretched(&info, 0.2);
        let mut broken = whole.clone();
        broken.bond_state[bond] = strandsnap::engine::view::BondState::Broken;
        let [before, after] = [&whole, &broken].map(|s| draw(&info, &options, s, &[]));
        keep(&format!("lone-{}", theme.word()), &after);
        let [x, y, w, h] = panel(&info, &options, View::Midsection);
        let (cx, cy) = (x + w / 2, y + (h - 6) / 4);
        assert_ne!(before.get_pixel(cx, cy).0, theme.style().panel, "a whole wire covers the ground");
        assert_eq!(after.get_pixel(cx, cy).0, theme.style().panel, "the gap shows it");
        // The necked tips: the wire is thinner right at the break than a wire's radius further away.
        let height =
            |x: u32| (y + 40..y + h / 2 - 40).filter(|y| after.get_pixel(x, *y).0 != theme.style().panel).count();
        let tip = (cx..x + w).find(|x| height(*x) > 0).expect("the right end is in view");
        let (thin, thick) = (height(tip + 2), height(tip + w / 6));
        assert!(thin < thick * 7 / 10 && thin > thick / 3, "{thin} of {thick} pixels");
    }
}

#[test]
fn a_small_step_changes_the_picture_little() {
    if !adapter("a_small_step_changes_the_picture_little") {
        return;
    }
    // What flickers jumps between frames that are nearly the same: shading that depends on which particle is nearest,
    // cuts that change their place, labels that swap theirs.
    let info = ka4_like();
    let views = vec![View::Midsection, View::Cutaway, View::Exploded];
    let options = OutputSpec { views, colour: ColourBy::Layer, ..Default::default() };
    let [a, b] = [0.2, 0.2 + 1e-5].map(|strain| draw(&info, &options, &stretched(&info, strain), &[]));
    let differences: Vec<u8> = a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b)).collect();
    let mean = differences.iter().map(|d| f64::from(*d)).sum::<f64>() / differences.len() as f64;
    let jumps = differences.iter().filter(|d| **d > 40).count();
    assert!(mean < 0.1, "mean change {mean}");
    assert!(jumps < differences.len() / 2_000, "{jumps} values jump");
}

#[test]
fn free_bodies_get_one_view_that_frames_everything() {
    if !adapter("free_bodies_get_one_view_that_frames_everything") {
        return;
    }
    let (info, mut snapshot) = two_spheres();
    let options = OutputSpec::default();
    let picture = draw(&info, &options, &snapshot, &[]);
    keep("spheres", &picture);
    // One of them far away: the view widens, so that its border still shows ground.
    snapshot.position[1] = [0.1e-3, 0.2e-3, 40e-3];
    let wide = draw(&info, &options, &snapshot, &[]);
    keep("spheres-far", &wide);
    let [x, y, w, h] = panel(&info, &options, View::Scene);
    let ground = picture.get_pixel(x + 2, y + h / 2).0;
    for p in [&picture, &wide] {
        for py in y + 30..y + h - 30 {
            assert_eq!(p.get_pixel(x + 1, py).0, ground);
            assert_eq!(p.get_pixel(x + w - 2, py).0, ground);
        }
        let body = (y..y + h).flat_map(|py| (x..x + w).map(move |px| (px, py)));
        assert!(body.filter(|&(px, py)| p.get_pixel(px, py).0 != ground).count() > 500);
    }
}

#[test]
fn the_writer_leaves_a_numbered_sequence_of_whole_files() {
    if !adapter("the_writer_leaves_a_numbered_sequence_of_whole_files") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let frames = folder.path().join("frames");
    let info = Arc::new(ka4_like());
    let mut writer = FrameWriter::new(&frames, &OutputSpec::default()).expect("the adapter opens");
    writer.start(&info).expect("started");
    for k in 0..6 {
        let strain = 0.045 * k as f32;
        let (snapshot, ruptures) = snapped(&info, strain, if k < 4 { 0 } else { 2 });
        let sample = Sample { strain: f64::from(strain), ..Default::default() };
        writer.sample(&sample).expect("sampled");
        if k == 4 {
            ruptures.iter().for_each(|r| writer.rupture(r).expect("ruptured"));
        }
        writer.snapshot(&Arc::new(snapshot)).expect("handed over");
    }
    writer.finish().expect("finished");
    let mut names: Vec<_> = std::fs::read_dir(&frames)
        .expect("the folder is there")
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, (0..6).map(|k| format!("frame_{k:04}.png")).collect::<Vec<_>>());
    for name in names {
        assert_eq!(image::open(frames.join(name)).expect("a whole PNG").to_rgb8().dimensions(), (1280, 720));
    }
    assert_eq!(writer.timings().frames, 6);
    println!("{}", writer.timings());
}

#[test]
fn a_folder_that_vanishes_is_reported_with_its_path() {
    if !adapter("a_folder_that_vanishes_is_reported_with_its_path") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let frames = folder.path().join("frames");
    let info = Arc::new(ka4_like());
    let options = OutputSpec { frame_size: [320, 180], ..Default::default() };
    let mut writer = FrameWriter::new(&frames, &options).expect("the adapter opens");
    writer.start(&info).expect("started");
    std::fs::remove_dir(&frames).expect("removed");
    let snapshot = Arc::new(stretched(&info, 0.1));
    let error = (0..20)
        .find_map(|_| writer.snapshot(&snapshot).err())
        .or_else(|| writer.finish().err())
        .expect("the lost folder must be noticed");
    assert!(error.to_string().contains("frame_0000.png"), "{error}");
}

#[test]
fn every_colouring_gives_its_own_picture() {
    if !adapter("every_colouring_gives_its_own_picture") {
        return;
    }
    let info = ka4_like();
    let (snapshot, ruptures) = common::all_snapped(&info, 0.28);
    let colourings = [
        ColourBy::Stress,
        ColourBy::PlasticStrain,
        ColourBy::Utilisation,
        ColourBy::ContactPressure,
        ColourBy::Layer,
        ColourBy::Wire,
        ColourBy::Velocity,
    ];
    let mut seen: Vec<RgbImage> = Vec::new();
    for colour in colourings {
        let options = OutputSpec { colour, frame_size: [640, 360], ..Default::default() };
        let picture = draw(&info, &options, &snapshot, &ruptures);
        keep(&format!("all-{colour:?}"), &picture);
        assert!(seen.iter().all(|other| *other != picture), "{colour:?}");
        seen.push(picture);
    }
}

#[test]
fn a_single_wire_and_a_bent_one_are_drawn() {
    if !adapter("a_single_wire_and_a_bent_one_are_drawn") {
        return;
    }
    let single = common::single_wire();
    let straight = draw(&single, &OutputSpec::default(), &stretched(&single, 0.05), &[]);
    keep("single", &straight);
    let (bent, snapshot) = common::bent_wire();
    let curved = draw(&bent, &OutputSpec::default(), &snapshot, &[]);
    keep("bent", &curved);
    assert!(straight != curved);
}

/// Pixels in a rectangle that differ from the ground of panels.
fn drawn(picture: &RgbImage, [x, y, w, h]: [u32; 4]) -> usize {
    let ground = Theme::Dark.style().panel;
    (y..y + h)
        .flat_map(|y| (x..x + w).map(move |x| (x, y)))
        .filter(|&(x, y)| picture.get_pixel(x, y).0 != ground)
        .count()
}

#[test]
fn a_wire_that_springs_out_of_its_layer_stays_out_of_the_strips_of_others() {
    if !adapter("a_wire_that_springs_out_of_its_layer_stays_out_of_the_strips_of_others") {
        return;
    }
    let info = ka4_like();
    let mut snapshot = stretched(&info, 0.1);
    let options = OutputSpec { views: vec![View::Exploded], colour: ColourBy::Layer, ..Default::default() };
    let whole = draw(&info, &options, &snapshot, &[]);
    // An outer wire hangs down by two radii of the strand: over the middle layer, were it not in a strip of its own.
    let wire = &info.wires[20];
    for i in wire.particles() {
        snapshot.position[i][1] -= 2.8e-3;
    }
    let sprung = draw(&info, &options, &snapshot, &[]);
    keep("exploded-sprung", &sprung);
    let [x, y, w, h] = panel(&info, &options, View::Exploded);
    let differs = |y: u32, h: u32| {
        let pixels = (y..y + h).flat_map(|y| (x..x + w).map(move |x| (x, y)));
        pixels.filter(|&(x, y)| whole.get_pixel(x, y) != sprung.get_pixel(x, y)).count()
    };
    assert!(differs(y, h / 3) > 100, "the outer layer lacks it");
    // The upper half is the view from the front, whose lower half holds the two other layers.
    assert_eq!(differs(y + h / 4 + 10, h / 4 - 20), 0, "the layers below are as they were");
}

#[test]
fn wires_that_left_the_section_stand_below_it() {
    let info = ka4_like();
    let options = OutputSpec { views: vec![View::CrossSection], ..Default::default() };
    let (mut snapshot, ruptures) = snapped(&info, 0.27, 1);
    let [x, y, w, h] = panel(&info, &options, View::CrossSection);
    let below = [x, y + h - h / 6, w, h / 6];
    let before = draw(&info, &options, &stretched(&info, 0.27), &[]);
    // Its ends spring apart by ten millimetres each.
    let (first, bond) = (&info.wires[24], ruptures[0].bond);
    for i in first.particles() {
        snapshot.position[i][2] += if i <= bond { -10e-3 } else { 10e-3 };
    }
    let after = draw(&info, &options, &snapshot, &ruptures);
    keep("section-left", &after);
    assert_eq!(signal_pixels(&before, below), 0);
    assert!(signal_pixels(&after, below) > 40, "a hollow disc below the section");
    let above = [x, y, w, h - h / 4];
    assert_eq!(signal_pixels(&after, above), 0, "and none in it");
}

#[test]
fn an_overview_alone_fills_its_panel() {
    if !adapter("an_overview_alone_fills_its_panel") {
        return;
    }
    let info = ka4_like();
    for view in [View::Overview, View::Scene] {
        let options = OutputSpec { views: vec![view], ..Default::default() };
        let picture = draw(&info, &options, &stretched(&info, 0.28), &[]);
        keep(&format!("alone-{}", view.word()), &picture);
        let [x, y, w, h] = panel(&info, &options, view);
        let third = h / 3;
        for k in 0..3 {
            let share = drawn(&picture, [x, y + k * third, w, third]) as f64 / f64::from(w * third);
            assert!(share > 0.015, "{}: {share} of part {k}", view.word());
        }
    }
}

#[test]
fn a_scene_that_is_not_pulled_has_a_chart_of_its_own() {
    let bent = common::bent_wire();
    let twisted = (RunInfo { strain_end: None, ..common::single_wire() }, {
        let mut snapshot = stretched(&common::single_wire(), 0.0);
        snapshot.sample.torque = 1e-3;
        snapshot.sample.time = 1e-3;
        snapshot
    });
    for (name, (info, last)) in [("bent", bent), ("twisted", twisted), ("spheres", two_spheres())] {
        let options = OutputSpec { views: vec![View::Curve], ..Default::default() };
        let mut renderer = Renderer::new(&info, &options).expect("no adapter is needed");
        let mut history = strandsnap::render::History::default();
        let mut first = last.clone();
        first.position.clone_from(&info.rest_position);
        first.sample = Sample::default();
        let mut pictures = Vec::new();
        for (k, snapshot) in [&first, &last].into_iter().enumerate() {
            let mut snapshot = snapshot.clone();
            snapshot.sample.time = 1e-3 * k as f64;
            if name == "spheres" && k == 1 {
                snapshot.position[1][2] += 0.1e-3;
            }
            history.rows.push((&snapshot.sample).into());
            renderer.follow(&mut history, &snapshot);
            pictures.push(renderer.draw(&snapshot, &history).expect("drawn"));
        }
        keep(&format!("chart-{name}"), &pictures[1]);
        let [x, y, w, h] = panel(&info, &options, View::Curve);
        let accent = Theme::Dark.style().accent;
        let curve = |p: &RgbImage| {
            let inside = (y + 40..y + h - 50).flat_map(|y| (x + 60..x + w - 20).map(move |x| (x, y)));
            inside.filter(|&(x, y)| near(p.get_pixel(x, y).0, accent, 10)).count()
        };
        assert!(curve(&pictures[1]) > curve(&pictures[0]) + 300, "{name}: a curve has grown");
    }
}

#[test]
fn close_ups_go_on_to_the_main_fracture_and_look_there_from_the_start_of_a_run_that_is_known() {
    const NAME: &str = "close_ups_go_on_to_the_main_fracture_and_look_there_from_the_start_of_a_run_that_is_known";
    if !adapter(NAME) {
        return;
    }
    let info = ka4_like();
    let options = OutputSpec { views: vec![View::Midsection], frame_size: [640, 360], ..Default::default() };
    let (snapshot, ruptures) = snapped(&info, 0.27, 7);
    let mut renderer = Renderer::new(&info, &options).expect("the adapter opens");
    let mut seen = |mut history: strandsnap::render::History, frames: usize| {
        renderer.follow(&mut history, &stretched(&info, 0.2));
        history.ruptures.extend_from_slice(&ruptures);
        for _ in 0..frames {
            renderer.follow(&mut history, &snapshot);
        }
        renderer.draw(&snapshot, &history).expect("drawn")
    };
    let known = seen(strandsnap::render::History::knowing(ruptures.clone()), 1);
    let on_the_way = seen(Default::default(), 2);
    let arrived = seen(Default::default(), 10);
    keep("gaze", &arrived);
    assert!(known == arrived, "both look at the same place");
    assert!(on_the_way != arrived, "it takes some frames");
}
