//! One small reference picture per view, compared by how much eyes would notice.
//!
//! The references lie in tests/pictures. A missing one fails. To make them, run
//! `STRANDSNAP_WRITE_REFERENCES=1 cargo test --release --test pictures`, look at what it left in target/pictures, and
//! copy the files over by hand: no test writes where it reads.

#![cfg(feature = "render")]

mod common;

use common::{curve, ka4_like, snapped, told, two_spheres};
use image::{RgbImage, imageops};
use std::io::Write;
use std::path::{Path, PathBuf};
use strandsnap::engine::view::{BondState, RunInfo, Rupture, Snapshot};
use strandsnap::render::Renderer;
use strandsnap::scene::spec::{ColourBy, OutputSpec, View};

/// Least similarity of any tile to its reference, 1 for equal ones (-). The last two tests show
/// what it lets through and what not.
const ALIKE: f64 = 0.985;
/// Tiles across and down: a change of one wire must not drown in the rest of the picture.
const TILES: [u32; 2] = [8, 6];
/// Size of the frames, and of the references that they are reduced to: rounding and coverage of single pixels, which
/// differ from driver to driver, are averaged over 3 × 3 of them.
const DRAWN: [u32; 2] = [480, 270];
const KEPT: [u32; 2] = [160, 90];

/// Similarity of the least similar tile: the lesser of structure (image-compare's hybrid of luma and chroma) and
/// root mean square of the colours. Either alone misses a change that the other sees.
fn similarity(a: &RgbImage, b: &RgbImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions(), "pictures of different sizes");
    let [w, h] = [a.width() / TILES[0], a.height() / TILES[1]];
    let tile = |p: &RgbImage, x: u32, y: u32| imageops::crop_imm(p, x * w, y * h, w, h).to_image();
    (0..TILES[1])
        .flat_map(|y| (0..TILES[0]).map(move |x| (x, y)))
        .map(|(x, y)| {
            let (a, b) = (tile(a, x, y), tile(b, x, y));
            let structure = image_compare::rgb_hybrid_compare(&a, &b).expect("tiles have one size").score;
            let rms = &image_compare::Algorithm::RootMeanSquared;
            structure.min(image_compare::rgb_similarity_structure(rms, &a, &b).expect("tiles have one size").score)
        })
        .fold(1.0, f64::min)
}

/// Every wire in a colour of its own, so that none can stand in for another.
fn options(view: View) -> OutputSpec {
    OutputSpec { views: vec![view], frame_size: DRAWN, colour: ColourBy::Wire, ..Default::default() }
}

fn reduced(picture: &RgbImage) -> RgbImage {
    imageops::resize(picture, KEPT[0], KEPT[1], imageops::FilterType::Triangle)
}

fn draw(info: &RunInfo, view: View, snapshot: &Snapshot, points: &[(f64, f64)], ruptures: &[Rupture]) -> RgbImage {
    let mut renderer = Renderer::new(info, &options(view)).expect("the adapter opens");
    let mut history = told(points, ruptures);
    renderer.follow(&mut history, snapshot);
    reduced(&renderer.draw(snapshot, &history).expect("the frame is drawn"))
}

/// The picture of a view that its reference shows.
fn picture(view: View) -> RgbImage {
    if view == View::Scene {
        let (info, snapshot) = two_spheres();
        return draw(&info, view, &snapshot, &[], &[]);
    }
    let info = ka4_like();
    let (snapshot, ruptures) = snapped(&info, 0.27, 7);
    draw(&info, view, &snapshot, &curve(0.27), &ruptures)
}

/// The same with one wire, one sphere or half of the curve missing.
fn perturbed(view: View) -> RgbImage {
    if view == View::Scene {
        let (info, mut snapshot) = two_spheres();
        snapshot.position[1] = snapshot.position[0];
        snapshot.radius[1] = 0.1e-3;
        return draw(&info, view, &snapshot, &[], &[]);
    }
    let info = ka4_like();
    let (mut snapshot, ruptures) = snapped(&info, 0.27, 7);
    let mut points = curve(0.27);
    if view == View::Curve {
        points.truncate(points.len() / 2);
    }
    let wire = &info.wires[28];
    for i in wire.first..wire.first + wire.len {
        snapshot.position[i][1] += 1.0;
        snapshot.bond_state[i] = BondState::Absent;
    }
    draw(&info, view, &snapshot, &points, &ruptures)
}

fn reference(view: View) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures").join(format!("{}.png", view.word()))
}

fn read_reference(view: View) -> RgbImage {
    let path = reference(view);
    let found = image::open(&path).unwrap_or_else(|e| {
        panic!(
            "no reference picture {}: {e}\nmake it with STRANDSNAP_WRITE_REFERENCES=1 cargo test --release --test \
             pictures, look at it in target/pictures, and copy it over",
            path.display()
        )
    });
    found.to_rgb8()
}

/// Views that this machine can draw like the references; says which it cannot.
fn views(test: &str) -> Vec<View> {
    let skipped = |why: &str| {
        // Past the test harness, which hides what passing tests print.
        let _ = writeln!(std::io::stderr(), "SKIPPED ({why}): {test}, all but the charts");
    };
    let flat = View::ALL.into_iter().filter(|v| matches!(v, View::CrossSection | View::Unrolled | View::Curve));
    match strandsnap::render::adapter::Gpu::open() {
        Err(_) => skipped("no graphics adapter"),
        Ok(gpu) if !gpu.samples_shaded => skipped("the graphics adapter does not smooth edges"),
        Ok(_) => return View::ALL.to_vec(),
    }
    flat.collect()
}

#[test]
fn every_view_looks_like_its_reference() {
    let views = views("every_view_looks_like_its_reference");
    let now: Vec<RgbImage> = views.iter().map(|view| picture(*view)).collect();
    if std::env::var_os("STRANDSNAP_WRITE_REFERENCES").is_some() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/pictures");
        std::fs::create_dir_all(&folder).expect("target can be written");
        for (view, now) in views.iter().zip(&now) {
            now.save(folder.join(format!("{}.png", view.word()))).expect("the picture is written");
        }
    }
    for (view, now) in views.into_iter().zip(now) {
        let seen = similarity(&now, &read_reference(view));
        println!("{}: {seen:.4}", view.word());
        assert!(seen >= ALIKE, "{} is {seen:.3} like its reference, less than {ALIKE}", view.word());
    }
}

#[test]
fn references_are_small() {
    for view in View::ALL {
        let size = std::fs::metadata(reference(view)).map(|m| m.len());
        assert!(size.as_ref().is_ok_and(|s| *s <= 20_000), "{}: {size:?}", view.word());
    }
}

#[test]
fn a_missing_wire_is_noticed_in_every_view() {
    for view in views("a_missing_wire_is_noticed_in_every_view") {
        let seen = similarity(&perturbed(view), &read_reference(view));
        println!("{}: {seen:.4}", view.word());
        // By a margin, or the tolerance would be luck.
        assert!(seen < ALIKE - 0.015, "{}: a missing wire still looks {seen:.3} alike", view.word());
    }
}

#[test]
fn another_rasteriser_is_let_through() {
    // What other drivers do to a picture: other rounding and other coverage wherever it is not flat.
    for view in views("another_rasteriser_is_let_through") {
        let reference = read_reference(view);
        let soft = imageops::blur(&reference, 0.3);
        let mut other = reference.clone();
        for (k, (value, soft)) in other.iter_mut().zip(soft.iter()).enumerate() {
            let step = if *value == *soft { 0 } else { (k * 7919 % 5) as i32 - 2 };
            *value = (i32::from(*soft) + step).clamp(0, 255) as u8;
        }
        let seen = similarity(&other, &reference);
        println!("{}: {seen:.4}", view.word());
        assert!(seen > ALIKE + 0.005, "{}: rounding alone makes it {seen:.3} alike", view.word());
    }
}
