//! The interactive picture of a run: what it shows against the files of the run, who is let in, and what a page that
//! misbehaves can do. Drawing needs a graphics adapter, the page a Chromium; without them tests say that they were skipped.
#![cfg(feature = "explore")]

mod browser;
#[path = "common/film.rs"]
mod film;
#[path = "explore/films.rs"]
mod films;
#[path = "explore/live.rs"]
mod live;
#[path = "explore/page.rs"]
mod page;
#[path = "explore/pictures.rs"]
mod pictures;
#[path = "common/program.rs"]
mod program;
#[path = "explore/see_into.rs"]
mod see_into;
#[path = "explore/shown.rs"]
mod shown;
#[path = "common/strand.rs"]
mod strand;
#[path = "explore/strangers.rs"]
mod strangers;
mod synthetic;

use serde_json::{Value, json};
use shown::{PATIENCE, SIZE, Shown, close_up, folder, json_of, next_picture, next_words, say, status};
use std::process::Command;
use std::time::Duration;
use strandsnap::base::units::{mm, mpa};
use strandsnap::explore::{View, picture};
use synthetic::Run;

#[test]
fn the_page_is_told_what_the_run_holds() {
    let Some(shown) = Shown::start("the_page_is_told_what_the_run_holds") else { return };
    let run = Run::new(12);
    let page = shown.ask(&format!("/?token={}", shown.token()), &[("Host", shown.host())]);
    assert_eq!(status(&page), "200", "{page}");
    assert!(page.contains("Wire 24, outer layer"), "the answer stands on the page itself: {page}");
    for part in ["HttpOnly", "SameSite=Strict", "default-src 'none'", "frame-ancestors 'none'", "nosniff"] {
        assert!(page.contains(part), "{part}: {page}");
    }
    assert!(!page.contains("https://") && !page.contains("unsafe"), "something comes from outside");
    let facts = json_of(&shown.fetch("/run.json"));
    assert_eq!(facts["states"].as_array().unwrap().len(), 12);
    assert_eq!(facts["wires"].as_array().unwrap().len(), 34);
    let ruptures = facts["ruptures"].as_array().unwrap();
    assert_eq!(ruptures.len(), run.ruptures().len());
    for (told, rupture) in ruptures.iter().zip(run.ruptures()) {
        assert_eq!(told["wire"], rupture.wire);
        let near = |key: &str, value: f64| (told[key].as_f64().unwrap() - value).abs() < 1e-9 * value.abs();
        assert!(near("x", rupture.strain * 1e2) && near("rest_z", rupture.rest_z * 1e3), "{told}");
        assert!(near("stress", rupture.stress * 1e-6) && near("body_stress", rupture.body_stress * 1e-6), "{told}");
        let state = told["state"].as_u64().unwrap() as usize;
        assert!(run.snapshots()[state].sample.strain >= rupture.strain);
        assert!(state == 0 || run.snapshots()[state - 1].sample.strain < rupture.strain);
    }
}

#[test]
fn render_and_explore_draw_the_same_view() {
    let Some(shown) = Shown::start("render_and_explore_draw_the_same_view") else { return };
    let view = View { explode: 0.4, hidden_layers: vec![2], cut: Some(75.5), ..close_up(10.5) };
    let mut socket = shown.socket();
    say(&mut socket, json!({ "look": { "number": 7, "size": SIZE, "view": view } }));
    let (number, small, _) = next_picture(&mut socket, 0);
    assert!(number == 7 && small[0] < SIZE[0] && small[1] < SIZE[1], "{small:?}");
    say(&mut socket, json!({ "shown": 7 }));
    let (number, size, whole) = next_picture(&mut socket, 1);
    assert_eq!((number, size), (7, SIZE));
    assert_eq!(whole, picture(shown.folder.path(), None, &view, SIZE).unwrap(), "another picture than the library's");
    say(&mut socket, json!({ "command": { "size": SIZE, "view": view } }));
    let command = next_words(&mut socket, "command");
    let words = command.as_str().unwrap().strip_prefix("--view '").unwrap().split_once('\'').unwrap();
    let out = shown.folder.path().join("one");
    let run = Command::new(env!("CARGO_BIN_EXE_strandsnap"))
        .arg("render")
        .arg(shown.folder.path())
        .args(["--view", words.0])
        .args(words.1.split_whitespace())
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    assert_eq!(whole, std::fs::read(out.join("view.png")).unwrap(), "another picture than the program's");
}

#[test]
fn two_runs_stand_side_by_side_at_the_same_strain() {
    const NAME: &str = "two_runs_stand_side_by_side_at_the_same_strain";
    let beside = folder(7);
    let Some(shown) = Shown::beside(NAME, Some(beside.path())) else { return };
    let strains =
        |count: usize| Run::new(count).snapshots().iter().map(|s| s.sample.strain * 1e2).collect::<Vec<f64>>();
    let (left, right) = (strains(12), strains(7));
    let strain = 0.5 * (left[9] + left[10]);
    let after = right.iter().position(|x| *x >= strain).unwrap();
    let state = (after - 1) as f64 + (strain - right[after - 1]) / (right[after] - right[after - 1]);
    let facts = json_of(&shown.fetch("/run.json"));
    assert_eq!(facts["other"]["states"].as_array().unwrap().len(), 7);
    // Runs of the same scene are told apart by their folders.
    assert_eq!(facts["other"]["label"], beside.path().display().to_string());
    assert_ne!(facts["label"], facts["other"]["label"]);
    let mut socket = shown.socket();
    let view = close_up(9.5);
    say(&mut socket, json!({ "look": { "number": 1, "size": SIZE, "view": view } }));
    let told = next_words(&mut socket, "state");
    let x = told["other"]["x"].as_f64().unwrap();
    assert!((told["x"].as_f64().unwrap() - strain).abs() < 1e-9 && (x - strain).abs() < 1e-9, "{told}");
    next_picture(&mut socket, 0);
    say(&mut socket, json!({ "shown": 1 }));
    let (_, _, whole) = next_picture(&mut socket, 1);
    let whole = image::load_from_memory(&whole).unwrap().into_rgb8();
    let half = [SIZE[0] / 2, SIZE[1]];
    for (run, state, from) in [(shown.folder.path(), 9.5, 0), (beside.path(), state, half[0])] {
        let alone = picture(run, None, &View { state, ..view.clone() }, half).unwrap();
        let alone = image::load_from_memory(&alone).unwrap().into_rgb8();
        let part = image::imageops::crop_imm(&whole, from, 0, half[0], half[1]).to_image();
        let differing = part.pixels().zip(alone.pixels()).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "pixels of the part from {from} px");
    }
    // What is in the middle of a part is picked in its own run.
    for (at, other) in [(0.25, false), (0.75, true)] {
        say(&mut socket, json!({ "pick": { "number": 1, "size": SIZE, "at": [at, 0.5], "view": view } }));
        assert_eq!(next_words(&mut socket, "picked")["other"], other);
    }
}

#[test]
fn what_is_under_the_pointer_is_in_the_picture() {
    let Some(shown) = Shown::start("what_is_under_the_pointer_is_in_the_picture") else { return };
    let run = Run::new(12);
    let mut socket = shown.socket();
    let mut view = close_up(11.0);
    let mut pick = |view: &View, at: [f64; 2]| {
        say(&mut socket, json!({ "pick": { "number": 1, "size": SIZE, "at": at, "view": view } }));
        next_words(&mut socket, "picked")
    };
    let found = pick(&view, [0.5, 0.5]);
    let (i, wire) = (found["particle"].as_u64().unwrap() as usize, found["wire"].as_u64().unwrap() as usize);
    let last = run.snapshots()[11];
    assert_eq!(run.info.wires[wire].layer, 2, "the outer layer lies in front");
    // The browser is told of mm and MPa.
    assert_eq!(found["position"][2].as_f64().unwrap() as f32, mm(last.position[i][2].into()) as f32);
    assert_eq!(found["contact_pressure"].as_f64().unwrap() as f32, mpa(last.contact_pressure[i].into()) as f32);
    view.hidden_layers = vec![2];
    let found = pick(&view, [0.5, 0.5]);
    assert_eq!(run.info.wires[found["wire"].as_u64().unwrap() as usize].layer, 1, "what is hidden is not picked");
    assert_eq!(pick(&view, [0.5, 0.02]), Value::Null, "nothing is there");
}

#[test]
fn pictures_come_one_at_a_time_and_stale_views_are_dropped() {
    let Some(shown) = Shown::start("pictures_come_one_at_a_time_and_stale_views_are_dropped") else { return };
    let mut socket = shown.socket();
    for number in 1..=40 {
        let view = View { azimuth: f64::from(number), ..close_up(11.0) };
        say(&mut socket, json!({ "look": { "number": number, "size": SIZE, "view": view } }));
    }
    let mut seen = Vec::new();
    while seen.last() != Some(&40) {
        let (number, ..) = next_picture(&mut socket, 0);
        seen.push(number);
        // Nothing more is on its way until the page says that it shows this one.
        socket.get_ref().set_read_timeout(Some(Duration::from_millis(300))).unwrap();
        let early = socket.read();
        assert!(early.is_err(), "a second picture while the first was on its way: {seen:?}");
        socket.get_ref().set_read_timeout(Some(PATIENCE)).unwrap();
        say(&mut socket, json!({ "shown": number }));
    }
    assert!(seen.len() <= 4, "stale views were drawn: {seen:?}");
    assert_eq!(next_picture(&mut socket, 1).0, 40);
}
