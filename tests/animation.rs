//! Animations, decoded again. They are made of plain pictures, so no graphics adapter is needed.

#![cfg(feature = "render")]

#[path = "common/film.rs"]
mod film;

use film::{decoded_film, mean_difference};
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder, DynamicImage, Frame, Rgb, RgbImage};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use strandsnap::base::error::{Error, Result};
use strandsnap::observe::animation::Animation;
use strandsnap::render::animation::{self, Still};

const SIZE: [u32; 2] = [96, 54];
const GROUND: Rgb<u8> = Rgb([22, 26, 34]);
const MARK: Rgb<u8> = Rgb([255, 45, 60]);

/// A colour map on a dark ground, and a red mark of 5 × 5 pixels that moves.
fn picture(number: u32) -> RgbImage {
    let mut picture = RgbImage::from_pixel(SIZE[0], SIZE[1], GROUND);
    for x in 10..86 {
        let c = colorous::VIRIDIS.eval_continuous(f64::from(x - 10) / 75.0);
        (5..12).for_each(|y| picture.put_pixel(x, y, Rgb([c.r, c.g, c.b])));
    }
    let left = 10 + 7 * number;
    (0..25).for_each(|i| picture.put_pixel(left + i % 5, 30 + i / 5, MARK));
    picture
}

/// Makes it without being stopped.
fn write(animation: &Animation, stills: &[Still]) -> Result<u64> {
    animation::write(animation, stills, &AtomicBool::new(false))
}

fn stills(folder: &Path, count: u32) -> Vec<Still> {
    let still = |number: u32| {
        let file = folder.join(format!("frame_{number:04}.png"));
        picture(number).save(&file).unwrap();
        Still { picture: file, pause: number == 2 }
    };
    (0..count).map(still).collect()
}

/// What a viewer shows, picture by picture, each with its time (ms).
fn decoded(file: &Path) -> Vec<(RgbImage, u128)> {
    match file.extension().unwrap().to_str().unwrap() {
        "gif" => decoded_gif(file),
        "mp4" => decoded_film(file),
        _ => {
            let reader = BufReader::new(File::open(file).unwrap());
            let frames = PngDecoder::new(reader).unwrap().apng().unwrap().into_frames().collect_frames().unwrap();
            let shown = |f: Frame| {
                let time = Duration::from(f.delay()).as_millis();
                (DynamicImage::from(f.into_buffer()).into_rgb8(), time)
            };
            frames.into_iter().map(shown).collect()
        }
    }
}

fn decoded_gif(file: &Path) -> Vec<(RgbImage, u128)> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(file).unwrap()).unwrap();
    assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
    let mut canvas = RgbImage::new(decoder.width().into(), decoder.height().into());
    let mut shown = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!((frame.dispose, &frame.palette), (gif::DisposalMethod::Keep, &None), "one palette for all");
        for (i, pixel) in (0..).zip(frame.buffer.chunks_exact(4)) {
            let (x, y) = (i % u32::from(frame.width), i / u32::from(frame.width));
            if pixel[3] > 0 {
                let at = canvas.get_pixel_mut(x + u32::from(frame.left), y + u32::from(frame.top));
                at.0.copy_from_slice(&pixel[..3]);
            }
        }
        shown.push((canvas.clone(), 10 * u128::from(frame.delay)));
    }
    shown
}

/// Greatest difference in any channel of any pixel.
fn difference(seen: &RgbImage, picture: &RgbImage) -> u8 {
    let seen = seen.pixels().zip(picture.pixels());
    seen.flat_map(|(a, b)| (0..3).map(move |k| a.0[k].abs_diff(b.0[k]))).max().unwrap()
}

#[test]
fn an_animation_shows_every_picture_for_its_time() {
    for (name, tolerance) in [("a.gif", 12), ("a.png", 0), ("a.apng", 0)] {
        let folder = tempfile::tempdir().unwrap();
        let stills = stills(folder.path(), 6);
        let file = folder.path().join(name);
        let bytes = write(&Animation { file: file.clone(), width: None }, &stills).unwrap();
        assert_eq!(bytes, std::fs::metadata(&file).unwrap().len());
        let frames = decoded(&file);
        assert_eq!(frames.len(), 6, "{name}");
        let times: Vec<u128> = frames.iter().map(|(_, time)| *time).collect();
        assert_eq!(times, [70, 70, 500, 70, 70, 2500], "{name}");
        for (number, (frame, _)) in (0..).zip(&frames) {
            assert_eq!(<[u32; 2]>::from(frame.dimensions()), SIZE, "{name}");
            let difference = difference(frame, &picture(number));
            assert!(difference <= tolerance, "{name}, frame {number}: {difference}");
        }
        let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(left.len(), 7, "nothing but pictures and animation: {left:?}");
    }
}

/// Colours of four pixels are one in a film, so that edges differ and areas do not.
#[test]
fn a_film_shows_every_picture_for_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.mp4");
    let bytes = write(&Animation { file: file.clone(), width: None }, &stills(folder.path(), 6)).unwrap();
    assert_eq!(bytes, std::fs::metadata(&file).unwrap().len());
    let frames = decoded(&file);
    let times: Vec<u128> = frames.iter().map(|(_, time)| *time).collect();
    assert_eq!(times, [70, 70, 500, 70, 70, 2500]);
    for (number, (frame, _)) in (0..).zip(&frames) {
        assert_eq!(<[u32; 2]>::from(frame.dimensions()), SIZE);
        let right = picture(number);
        assert!(mean_difference(frame, &right) <= 2.0, "frame {number}");
        // A mark of five pixels is smoothed towards its edges.
        for ([x, y], tolerance) in [([2, 50], 6), ([12 + 7 * number, 32], 24)] {
            let [seen, right] = [frame, &right].map(|picture| picture.get_pixel(x, y).0);
            assert!((0..3).all(|k| seen[k].abs_diff(right[k]) <= tolerance), "frame {number}: {seen:?}, not {right:?}");
        }
    }
    // The same pictures give the same bits.
    let again = folder.path().join("b.mp4");
    write(&Animation { file: again.clone(), width: None }, &stills(folder.path(), 6)).unwrap();
    assert!(std::fs::read(&again).unwrap() == std::fs::read(&file).unwrap());
}

#[test]
fn ground_and_marks_keep_their_colours_in_a_gif() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.gif");
    write(&Animation { file: file.clone(), width: None }, &stills(folder.path(), 4)).unwrap();
    for (number, (frame, _)) in (0..).zip(decoded(&file)) {
        assert_eq!(frame.get_pixel(2, 50), &GROUND, "frame {number}");
        assert_eq!(frame.get_pixel(12 + 7 * number, 32), &MARK, "frame {number}");
    }
}

#[test]
fn pictures_that_do_not_change_still_take_their_time() {
    for name in ["a.gif", "a.png", "a.mp4"] {
        let folder = tempfile::tempdir().unwrap();
        let one = stills(folder.path(), 1).remove(0);
        let file = folder.path().join(name);
        write(&Animation { file: file.clone(), width: None }, &[one.clone(), one.clone(), one]).unwrap();
        let frames = decoded(&file);
        assert_eq!(frames.len(), 3, "{name}");
        // Edges of a film differ.
        let off = |f: &RgbImage| {
            if name == "a.mp4" { mean_difference(f, &picture(0)) <= 2.0 } else { difference(f, &picture(0)) <= 12 }
        };
        assert!(frames.iter().all(|(f, _)| off(f)), "{name}");
    }
}

#[test]
fn an_animation_can_be_smaller_than_its_pictures() {
    for (name, width, right) in
        [("a.gif", 48, [48, 27]), ("a.png", 32, [32, 18]), ("b.png", 4000, SIZE), ("a.mp4", 48, [48, 26])]
    {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(name);
        let options = Animation { file: file.clone(), width: Some(width) };
        write(&options, &stills(folder.path(), 3)).unwrap();
        for (frame, _) in decoded(&file) {
            assert_eq!(<[u32; 2]>::from(frame.dimensions()), right, "{name}");
        }
    }
}

#[test]
fn a_lost_picture_is_named_and_leaves_no_animation() {
    let folder = tempfile::tempdir().unwrap();
    let stills = stills(folder.path(), 3);
    std::fs::remove_file(&stills[1].picture).unwrap();
    for name in ["a.gif", "a.png", "a.mp4"] {
        let file = folder.path().join(name);
        let error = write(&Animation { file: file.clone(), width: None }, &stills).unwrap_err();
        assert!(error.to_string().contains("frame_0001.png"), "{error}");
        assert!(!file.exists(), "{name}");
    }
}

#[test]
fn an_animation_that_is_stopped_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let stills = stills(folder.path(), 3);
    for name in ["a.gif", "a.png", "a.mp4"] {
        let file = folder.path().join(name);
        let stopped = animation::write(&Animation { file, width: None }, &stills, &AtomicBool::new(true));
        assert!(matches!(stopped, Err(Error::Interrupted)), "{name}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3, "{name}");
    }
}
