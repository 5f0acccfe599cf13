//! Frames, an animation and a recording that the run says it wrote.

use crate::damaged::{Copy, copy};
use crate::wrong;
use std::fs;
use std::path::Path;
use strandsnap::observe::origin::RUN_KEYWORD;
use strandsnap::observe::trajectory::{Record, Trajectory};

const SIZE: [u32; 2] = [160, 120];

/// A frame as the renderer writes it, all of one colour; `run` is the id that it carries.
fn frame(path: &Path, shade: u8, run: Option<&str>, [width, height]: [u32; 2]) {
    let mut encoder = png::Encoder::new(fs::File::create(path).unwrap(), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Fast);
    if let Some(run) = run {
        encoder.add_text_chunk(RUN_KEYWORD.into(), run.into()).unwrap();
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&vec![shade; (3 * width * height) as usize]).unwrap();
    writer.finish().unwrap();
}

/// An animated PNG of so many pictures.
fn animation(path: &Path, frames: u32) {
    let mut encoder = png::Encoder::new(fs::File::create(path).unwrap(), 16, 9);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_animated(frames, 0).unwrap();
    let mut writer = encoder.write_header().unwrap();
    (0..frames).for_each(|k| writer.write_image_data(&[k as u8; 3 * 16 * 9]).unwrap());
    writer.finish().unwrap();
}

/// A run as if it had drawn its frames, and how many.
fn drawn() -> (Copy, usize, String) {
    let copy = copy();
    let trajectory = Trajectory::open(&copy.run.join("trajectory.bin")).unwrap();
    let id = trajectory.origin().run.to_string();
    let snapshots = trajectory.filter(|record| matches!(record, Ok(Record::Snapshot(_)))).count();
    fs::create_dir(copy.run.join("frames")).unwrap();
    frame(&picture(&copy, 0), 7, Some(&id), SIZE);
    for number in 1..snapshots {
        fs::copy(picture(&copy, 0), picture(&copy, number)).unwrap();
    }
    animation(&copy.run.join("frames.png"), snapshots as u32);
    let bytes = fs::metadata(copy.run.join("frames.png")).unwrap().len();
    copy.summary(|summary| {
        summary["written"] = serde_json::json!({ "frames": true, "recording": false, "animation": "frames.png" });
        summary["frames"] = serde_json::json!({
            "count": snapshots, "draw_ms": 1.0, "read_back_ms": 1.0, "charts_and_text_ms": 1.0, "png_ms": 1.0,
            "simulation_waited_s": 0.0, "drawn_after_the_simulation_s": 0.0, "animation_s": 1.0, "animation_bytes": bytes,
        });
    });
    (copy, snapshots, id)
}

fn picture(copy: &Copy, number: usize) -> std::path::PathBuf {
    copy.run.join(format!("frames/frame_{number:04}.png"))
}

impl Copy {
    /// Changes the summary and seals it.
    fn summary(&self, change: impl Fn(&mut serde_json::Value)) {
        let path = self.run.join("summary.json");
        let mut summary: serde_json::Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
        change(&mut summary);
        fs::write(&path, serde_json::to_string_pretty(&summary).unwrap()).unwrap();
        self.seal();
    }
}

/// Asserts that `change` makes the invariant `name` fail, for a reason that holds `words`.
fn caught(name: &str, words: &str, change: impl Fn(&Copy, usize, &str)) {
    let (copy, count, id) = drawn();
    change(&copy, count, &id);
    let wrong = wrong(&copy.run);
    let seen = wrong.iter().find(|w| w.starts_with(&format!("{name}: ")));
    assert!(seen.is_some_and(|seen| seen.contains(words)), "{name}, {words}: {wrong:?}");
}

/// The page was made before the frames were drawn, which is no fault of it.
#[test]
fn frames_and_animation_of_an_honest_run() {
    let (copy, ..) = drawn();
    assert!(wrong(&copy.run).is_empty(), "{:?}", wrong(&copy.run));
    strandsnap::page::write(&copy.run, None, None, true, false).unwrap();
    assert!(wrong(&copy.run).is_empty(), "{:?}", wrong(&copy.run));
}

#[test]
fn frames_that_are_missing_cut_foreign_or_of_another_size() {
    caught("frames", "pictures in frames", |copy, _, _| fs::remove_dir_all(copy.run.join("frames")).unwrap());
    caught("frames", "pictures in frames", |copy, count, _| fs::remove_file(picture(copy, count / 2)).unwrap());
    caught("frames", "number of the last picture", |copy, count, _| {
        fs::rename(picture(copy, count - 1), picture(copy, count)).unwrap();
    });
    caught("frames", "picture 3: it is damaged", |copy, _, _| {
        let bytes = fs::read(picture(copy, 3)).unwrap();
        fs::write(picture(copy, 3), &bytes[..bytes.len() - 20]).unwrap();
    });
    caught("frames", "picture 3: it is damaged", |copy, _, _| {
        let mut bytes = fs::read(picture(copy, 3)).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(picture(copy, 3), bytes).unwrap();
    });
    caught("frames", "id of its run", |copy, _, id| frame(&picture(copy, 2), 9, Some(&id.replace('a', "b")), SIZE));
    caught("frames", "id of its run", |copy, _, _| frame(&picture(copy, 2), 9, None, SIZE));
    caught("frames", "640 × 360 against 160 × 120", |copy, _, id| frame(&picture(copy, 2), 9, Some(id), [640, 360]));
    caught("frames", "render, picture 0", |copy, _, _| {
        fs::create_dir(copy.run.join("render")).unwrap();
        frame(&copy.run.join("render/frame_0000.png"), 1, Some("another"), [640, 360]);
    });
}

#[test]
fn a_page_with_pictures_that_are_not_the_runs() {
    caught("page-words", "a picture", |copy, count, id| {
        strandsnap::page::write(&copy.run, None, None, true, false).unwrap();
        frame(&picture(copy, count - 1), 200, Some(id), SIZE);
    });
}

#[test]
fn an_animation_that_is_missing_cut_or_too_short() {
    let file = |copy: &Copy| copy.run.join("frames.png");
    caught("animation", "missing", |copy, _, _| fs::remove_file(file(copy)).unwrap());
    caught("animation", "damaged", |copy, _, _| {
        let bytes = fs::read(file(copy)).unwrap();
        fs::write(file(copy), &bytes[..bytes.len() / 2]).unwrap();
    });
    caught("animation", "frames of frames.png", |copy, count, _| animation(&file(copy), count as u32 - 1));
}

#[test]
fn a_recording_that_the_run_wrote_and_is_gone() {
    let copy = copy();
    let _ = fs::remove_file(copy.run.join("recording.rrd"));
    copy.summary(|summary| summary["written"]["recording"] = true.into());
    let gone = |words: &str| wrong(&copy.run).iter().any(|w| w.starts_with("recording: ") && w.contains(words));
    assert!(gone("missing"), "{:?}", wrong(&copy.run));
    fs::write(copy.run.join("recording.rrd.partial"), "").unwrap();
    assert!(gone("unfinished"), "{:?}", wrong(&copy.run));
}
