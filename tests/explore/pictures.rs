//! `[[output.picture]]`: pictures that a run draws of itself, and how fine pictures are drawn.

use crate::shown::{Served, folder, next_words, say, skipped};
use image::RgbImage;
use serde_json::json;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use strandsnap::explore::{View, picture};

const SIZE: [u32; 2] = [240, 160];

/// A wire of 30 mm that breaks within a tenth of a second, with more lines of a scene.
fn wire(folder: &Path, more: &str, options: &[&str]) -> Output {
    let scene = Command::new(env!("CARGO_BIN_EXE_strandsnap")).args(["scene", "show", "single-wire"]).output().unwrap();
    let scene = String::from_utf8(scene.stdout).unwrap();
    let file = folder.join("wire.toml");
    fs::write(&file, format!("{scene}\n{more}")).unwrap();
    let set = [
        "wire.0.to=[\"0 mm\", \"0 mm\", \"30 mm\"]",
        "grip.length=5 mm",
        "bond.rupture.strain=20 %",
        "grip.speed=20 m/s",
        "output.samples=40",
        "output.snapshots=4",
    ];
    Command::new(env!("CARGO_BIN_EXE_strandsnap"))
        .args(["run", "wire.toml", "--no-frames", "--no-recording", "--overwrite", "--quiet", "--out", "run"])
        .args(set.iter().flat_map(|key| ["--set", key]))
        .args(options)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn pixels(file: &Path) -> RgbImage {
    image::open(file).unwrap_or_else(|error| panic!("{}: {error}", file.display())).into_rgb8()
}

fn drawn(run: &Path, view: &View, size: [u32; 2]) -> RgbImage {
    image::load_from_memory(&picture(run, None, view, size).unwrap()).unwrap().into_rgb8()
}

/// Largest difference of a channel, and how many differ by more than two.
fn difference(a: &RgbImage, b: &RgbImage) -> (u8, usize) {
    assert_eq!(a.dimensions(), b.dimensions());
    let apart = || a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b));
    (apart().max().unwrap(), apart().filter(|apart| *apart > 2).count())
}

#[test]
fn a_page_gives_the_entry_of_a_scene_that_draws_what_it_shows() {
    let test = "a_page_gives_the_entry_of_a_scene_that_draws_what_it_shows";
    if strandsnap::render::check().is_err() {
        return skipped(test, "no graphics adapter");
    }
    let home = tempfile::tempdir().unwrap();
    let output = wire(home.path(), "", &[]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let run = home.path().join("run");
    let shown = Served::of(&run, None);
    let mut socket = shown.socket();
    let views = [
        View { state: 2.0, azimuth: 12.3, elevation: -7.7, centre: [0.01, 0.0, 15.2], height: 3.1, ..View::default() },
        View { state: 1.625, azimuth: -70.0, follow: Some(14.0), height: 1.7, perspective: 25.0, ..View::default() },
        View {
            state: 3.0,
            centre: [0.0, 0.0, 15.0],
            height: 40.0,
            cut: Some(20.1),
            range: Some([0.0, 170.3]),
            supersampling: 2,
            ..View::default()
        },
    ];
    let entries = views.iter().enumerate().map(|(number, view)| {
        say(&mut socket, json!({ "entry": { "size": SIZE, "view": view } }));
        let entry = next_words(&mut socket, "entry");
        entry.as_str().unwrap().replace("name = \"view\"", &format!("name = \"view-{number}\""))
    });
    let entries = entries.collect::<Vec<_>>().join("\n");
    let right: Vec<RgbImage> = views.iter().map(|view| drawn(&run, view, SIZE)).collect();
    let output = wire(home.path(), &entries, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    for (number, right) in right.iter().enumerate() {
        let (most, _) = difference(&pixels(&run.join(format!("pictures/view-{number}.png"))), right);
        assert_eq!(most, 0, "view {number}:\n{entries}");
    }
    let check = Command::new(env!("CARGO_BIN_EXE_strandsnap")).arg("check-run").arg(&run).output().unwrap();
    assert_eq!(check.status.code(), Some(0), "{}", text(&check));
    assert!(text(&check).contains("pictures"), "{}", text(&check));
}

#[test]
fn moments_have_names_and_what_a_run_never_came_to_is_left_out_with_a_word() {
    let test = "moments_have_names_and_what_a_run_never_came_to_is_left_out_with_a_word";
    if strandsnap::render::check().is_err() {
        return skipped(test, "no graphics adapter");
    }
    let home = tempfile::tempdir().unwrap();
    let entry = |name: &str, when: &str| format!("[[output.picture]]\nname = \"{name}\"\nsize = [240, 160]\n{when}\n");
    let entries = [
        entry("start", "at = \"start\""),
        entry("broken", "at = \"first-break\""),
        entry("last", "at = \"last-break\""),
        entry("end", ""),
        entry("far", "strain = \"90 %\""),
        entry("late", "time = \"1 s\""),
    ];
    let output = wire(home.path(), &entries.concat(), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert!(
        text(&output).contains("\"far\" was not drawn: the run did not come to 90 % strain, but to 2"),
        "{}",
        text(&output)
    );
    assert!(text(&output).contains("\"late\" was not drawn: the run ended after "), "{}", text(&output));
    let pictures = home.path().join("run/pictures");
    let names = |folder: &Path| {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    assert_eq!(names(&pictures), ["broken.png", "end.png", "last.png", "start.png"]);
    let [start, broken, end] = ["start", "broken", "end"].map(|name| pixels(&pictures.join(format!("{name}.png"))));
    assert!(difference(&start, &broken).1 > 100 && difference(&broken, &end).1 > 0);
    // All of the wire is in sight, with a margin on each side.
    let ground = *start.get_pixel(0, 0);
    let columns: Vec<u32> = (0..240).filter(|x| (0..160).any(|y| *start.get_pixel(*x, y) != ground)).collect();
    assert!(columns[0] >= 4 && columns[columns.len() - 1] <= 235, "{columns:?}");
    assert!(columns.len() > 180, "{columns:?}");
    // A run in place of the first takes its pictures away, and leaves what somebody else has put there.
    fs::copy(home.path().join("run/pictures/end.png"), home.path().join("own.png")).unwrap();
    start.save(pictures.join("mine.png")).unwrap();
    let output = wire(home.path(), "", &["--set", "stop.steps=200"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert_eq!(names(&pictures), ["mine.png"]);
    // Nothing breaks in so few steps.
    let output = wire(home.path(), &entry("broken", "at = \"first-break\""), &["--set", "stop.steps=200"]);
    assert!(text(&output).contains("\"broken\" was not drawn: nothing broke"), "{}", text(&output));
    // What stands in the way is told before the run.
    fs::remove_dir_all(&pictures).unwrap();
    fs::write(&pictures, "mine").unwrap();
    let output = wire(home.path(), &entry("end", ""), &[]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
    assert!(text(&output).contains("is not a folder, and output.picture writes into it"), "{}", text(&output));
    assert_eq!(fs::read_to_string(&pictures).unwrap(), "mine");
}

#[test]
fn a_finer_picture_is_the_mean_of_a_larger_one_in_light() {
    let test = "a_finer_picture_is_the_mean_of_a_larger_one_in_light";
    if strandsnap::render::check().is_err() {
        return skipped(test, "no graphics adapter");
    }
    let folder = folder(12);
    let linear = |byte: u8| -> f64 {
        let v = f64::from(byte) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    };
    let encoded = |light: f64| if light <= 0.0031308 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    for times in [2, 3] {
        let view = View {
            state: 11.0,
            azimuth: 20.0,
            elevation: 9.0,
            centre: [0.0, 0.0, 40.0],
            height: 6.0,
            ..View::default()
        };
        let larger = drawn(folder.path(), &view, SIZE.map(|side| side * times));
        let finer = drawn(folder.path(), &View { supersampling: times, ..view.clone() }, SIZE);
        let plain = drawn(folder.path(), &view, SIZE);
        let count = f64::from(times * times);
        let mean = RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
            let squares = (0..times * times).map(|k| larger.get_pixel(x * times + k % times, y * times + k / times).0);
            let light = squares.fold([0.0; 3], |sum, pixel| [0, 1, 2].map(|k| sum[k] + linear(pixel[k]) / count));
            image::Rgb(light.map(|light| (255.0 * encoded(light)).round() as u8))
        });
        let channels = (SIZE[0] * SIZE[1] * 3) as usize;
        let (_, apart) = difference(&finer, &mean);
        assert!(apart * 1000 < channels, "{apart} of {channels} channels differ, {times} times finer");
        let coarse = difference(&plain, &mean).1;
        assert!(coarse > 20 * apart && coarse * 100 > channels, "{coarse} of {channels} differ of the plain picture");
    }
}
