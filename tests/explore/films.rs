//! The film of a camera path: from the page, from the library and from the program it is the same.

use crate::film::{decoded_film, mean_difference};
use crate::program::{strandsnap, text};
use crate::shown::{Shown, close_up, folder, next_picture, next_words, say};
use image::RgbImage;
use serde_json::json;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use strandsnap::explore::{CameraPath, FilmTarget, View, film, picture};

const SIZE: [u32; 2] = [240, 160];

/// Round the first break, while strain goes on and the outer layer comes off.
fn views() -> Vec<View> {
    let near = close_up(3.0);
    let other = View { state: 9.5, azimuth: 140.0, explode: 1.0, ..near.clone() };
    vec![near, other, View { hidden_layers: vec![2], follow: None, centre: [0.0, 0.0, 62.0], ..close_up(11.0) }]
}

fn made(run: &Path, file: &Path) -> Vec<u8> {
    let target = FilmTarget { file, size: SIZE, stop: &AtomicBool::new(false) };
    let path = CameraPath { views: views(), seconds: 0.2 };
    let mut told = Vec::new();
    let bytes = film(run, None, path, &target, &mut |done, of| told.push((done, of))).unwrap();
    assert_eq!(told, (1..=13).map(|done| (done, 13)).collect::<Vec<_>>());
    let film = std::fs::read(file).unwrap();
    assert_eq!(bytes, film.len() as u64);
    film
}

#[test]
fn a_film_is_the_same_from_the_page_the_library_and_the_program() {
    let Some(shown) = Shown::start("a_film_is_the_same_from_the_page_the_library_and_the_program") else { return };
    let run = shown.folder.path();
    let library = made(run, &run.join("library.mp4"));
    let mut socket = shown.socket();
    let ask = json!({ "size": SIZE, "seconds": 0.2, "views": views() });
    say(&mut socket, json!({ "film": ask }));
    let (_, _, page) = next_picture(&mut socket, 4);
    assert!(page == library, "another film than the library's: {} and {} bytes", page.len(), library.len());
    // The command that the page shows makes it too.
    say(&mut socket, json!({ "film-command": ask }));
    let command = next_words(&mut socket, "film-command");
    let command = format!("{} --quiet --out one", command.as_str().unwrap().replace("film.mp4", "one/program.mp4"));
    let output = std::process::Command::new("sh")
        .args(["-c", &format!("\"$0\" render . {command}"), env!("CARGO_BIN_EXE_strandsnap")])
        .current_dir(run)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(std::fs::read(run.join("one/program.mp4")).unwrap() == library, "another film than the program's");

    let pictures = decoded_film(&run.join("library.mp4"));
    assert_eq!(pictures.len(), 13, "two legs of six, and the last view");
    // Above the words, key views are the pictures of those views, as near as a film keeps them: far nearer than to each other.
    let top = |picture: &RgbImage| image::imageops::crop_imm(picture, 0, 0, SIZE[0], 130).to_image();
    for (view, number) in views().iter().zip([0, 6, 12]) {
        let right = image::load_from_memory(&picture(run, None, view, SIZE).unwrap()).unwrap().into_rgb8();
        let difference = mean_difference(&top(&pictures[number].0), &top(&right));
        let others = [0, 6, 12].into_iter().filter(|other| *other != number);
        for other in others {
            let other = mean_difference(&top(&pictures[other].0), &top(&right));
            assert!(other > 2.0 * difference, "picture {number}: {difference}, another key view: {other}");
        }
    }
}

#[test]
fn a_film_that_cannot_be_made_is_refused_and_leaves_nothing() {
    if strandsnap::render::check().is_err() {
        return crate::shown::skipped(
            "a_film_that_cannot_be_made_is_refused_and_leaves_nothing",
            "no graphics adapter",
        );
    }
    let run = folder(4);
    let one = "state = 1, height = 8";
    let try_it = |more: &[&str]| {
        let output = strandsnap(run.path(), &[&["render", ".", "--view", one], more].concat());
        (output.status.code(), text(&output.stderr).split_whitespace().collect::<Vec<_>>().join(" "))
    };
    for (arguments, word) in [
        (&["--animation", "a.mp4"][..], "2 to 64"),
        (&["--view", one][..], "--animation asks for"),
        (&["--view", one, "--animation", "a.gif"][..], "ends in .mp4"),
        (&["--view", "state = 9", "--animation", "a.mp4"][..], "0 to 3"),
        (&["--view", one, "--animation", "a.mp4", "--leg", "100s"][..], "0.1 to 60 s"),
    ] {
        let (code, words) = try_it(arguments);
        assert!(code == Some(2) && words.contains(word), "{arguments:?}: {code:?} {words}");
    }
    std::fs::write(run.path().join("a.mp4"), "mine").unwrap();
    assert_eq!(try_it(&["--view", one, "--animation", "a.mp4"]).0, Some(2));
    assert_eq!(std::fs::read(run.path().join("a.mp4")).unwrap(), b"mine");
    assert!(!run.path().join("a.mp4.partial").exists());
    // One that is stopped.
    let file = run.path().join("b.mp4");
    let stop = AtomicBool::new(true);
    let path = CameraPath { views: vec![View::default(); 2], seconds: 1.0 };
    let target = FilmTarget { file: &file, size: SIZE, stop: &stop };
    assert!(film(run.path(), None, path, &target, &mut |_, _| ()).is_err());
    assert!(!file.exists() && !run.path().join("b.mp4.partial").exists());
}
