//! What frames show, asserted pixel by pixel. Tests that need a graphics adapter say so by name where there is none.

#![cfg(feature = "render")]

mod common;

use common::{curve, ka4_like, snapped};
use image::RgbImage;
use strandsnap::engine::view::{RunInfo, Rupture, Snapshot};
use strandsnap::render::{FrameOptions, Renderer, Theme, View};

/// Whether `test` can run here; else says that it did not.
fn adapter(test: &str) -> bool {
    let there = strandsnap::render::check().is_ok();
    if !there {
        println!("SKIPPED (no graphics adapter): {test}");
    }
    there
}

fn draw(
    info: &RunInfo,
    options: &FrameOptions,
    snapshot: &Snapshot,
    ruptures: &[Rupture],
) -> RgbImage {
    let mut renderer = Renderer::new(info, options).expect("the adapter opens");
    let points = curve(snapshot.sample.strain as f32);
    renderer
        .draw(snapshot, &points, ruptures)
        .expect("the frame is drawn")
}

/// Keeps a picture for looking at, in the folder named by STRANDSNAP_KEEP_PICTURES.
fn keep(name: &str, picture: &RgbImage) {
    if let Some(folder) = std::env::var_os("STRANDSNAP_KEEP_PICTURES") {
        let path = std::path::Path::new(&folder).join(format!("{name}.png"));
        picture
            .save(&path)
            .expect("the folder of kept pictures can be written");
    }
}

#[test]
fn a_frame_has_the_size_asked_for() {
    if !adapter("a_frame_has_the_size_asked_for") {
        return;
    }
    let info = ka4_like();
    let (snapshot, ruptures) = snapped(&info, 0.27, 7);
    let all = FrameOptions {
        views: View::ALL[..6].to_vec(),
        theme: Theme::Light,
        ..Default::default()
    };
    keep("all", &draw(&info, &all, &snapshot, &ruptures));
    for size in [[1280, 720], [641, 363]] {
        let options = FrameOptions {
            size,
            ..Default::default()
        };
        let picture = draw(&info, &options, &snapshot, &ruptures);
        keep(&format!("size-{}", size[0]), &picture);
        assert_eq!(picture.dimensions(), (size[0], size[1]));
    }
}
