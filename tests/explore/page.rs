//! The page in a real browser.

use crate::browser::{self, Browser};
use crate::film::decoded_film;
use crate::shown::{PATIENCE, Shown, folder, skipped};
use crate::synthetic::Run;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use strandsnap::explore::{Options, Server, View, picture};
use tempfile::TempDir;

fn keep(browser: &mut Browser, name: &str) {
    if let Some(folder) = std::env::var_os("KEEP_PICTURES") {
        browser.screenshot(&Path::new(&folder).join(name));
    }
}

/// Waits until the whole picture of the view is shown.
fn settled(browser: &mut Browser) {
    std::thread::sleep(Duration::from_millis(120));
    browser.wait_for(
        "String(document.querySelector('#stage').dataset.whole === 'yes' && \
         JSON.stringify(explore.shown()?.view) === JSON.stringify(explore.view))",
        "true",
    );
}

#[test]
fn a_person_finds_what_broke_first() {
    let Some(program) = browser::find() else {
        skipped("a_person_finds_what_broke_first", "no Chromium");
        return;
    };
    let Some(shown) = Shown::start("a_person_finds_what_broke_first") else { return };
    let run = Run::new(12);
    let first = run.ruptures()[0];
    let mut page = Browser::start(&program);
    page.visit(&shown.0, "dark");
    settled(&mut page);
    assert_eq!(page.value("location.search"), "", "the token does not stay in the address");
    assert!(page.value("document.querySelector('#headline').textContent").as_str().unwrap().contains("Wire 24"));
    keep(&mut page, "explore-dark.png");

    // A drag turns the strand: other pixels, another camera.
    let pixels = "document.querySelector('#picture').toDataURL()";
    let before = (page.value(pixels), page.value("explore.view.azimuth"));
    page.drag("#stage", [0.4, 0.5], [0.6, 0.55]);
    settled(&mut page);
    assert_ne!(page.value("explore.view.azimuth"), before.1);
    assert_ne!(page.value(pixels), before.0);

    // Scrubbing: the words are those of the snapshot.
    page.value("(s => { s.value = 4; s.dispatchEvent(new Event('input')); })(document.querySelector('#slider'))");
    settled(&mut page);
    let strain = format!("{:.2} % strain", run.snapshots()[4].sample.strain * 1e2);
    let now = page.value("document.querySelector('#now').textContent");
    assert!(now.as_str().unwrap().starts_with(&strain), "{now} instead of {strain}");
    assert!(now.as_str().unwrap().contains("Broken bonds: 0"), "{now}");

    // The first break in the table: wire, moment and place.
    page.value("document.querySelector('#breaks tbody button').click()");
    settled(&mut page);
    assert_eq!(page.value("explore.view.selected"), first.wire);
    let follow = page.value("explore.view.follow").as_f64().unwrap();
    assert!((follow - first.rest_z * 1e3).abs() < 1e-9);
    let chosen = page.value("document.querySelector('#chosen-text').textContent");
    assert!(chosen.as_str().unwrap().contains(&format!("true stress {:.0} MPa", first.stress * 1e-6)), "{chosen}");
    page.wait_for("String(document.querySelectorAll('#along path').length)", "3");
    assert!(page.value("document.querySelectorAll('#overlay .mark').length").as_u64() >= Some(1));
    keep(&mut page, "explore-break.png");

    // Without the outer layer other wires are seen.
    let before = page.value(pixels);
    page.value("document.querySelector('#layers input[data-layer=\"2\"]').click()");
    settled(&mut page);
    assert_eq!(page.value("explore.view.hidden_layers"), json!([2]));
    assert_ne!(page.value(pixels), before);
    // The section is moved.
    page.value("(s => { s.value = 75; s.dispatchEvent(new Event('input')); })(document.querySelector('#cut'))");
    settled(&mut page);
    assert!(page.value("document.querySelector('#cut-text').textContent").as_str().unwrap().contains("75"));
    // A layer is seen through.
    let before = page.value(pixels);
    page.value("document.querySelector('#layers .ghost[data-layer=\"1\"]').click()");
    settled(&mut page);
    assert_eq!(page.value("explore.view.ghost_layers"), json!([1]));
    assert_eq!(page.value("document.querySelector('.ghost[data-layer=\"1\"]').ariaPressed"), "true");
    assert_ne!(page.value(pixels), before);
    // A handle on the colour bar moves the end of the colours, and the number beside it.
    page.value(
        "(s => { s.value = +s.max / 2; s.dispatchEvent(new Event('input')); })(document.querySelector('[data-end=low]'))",
    );
    settled(&mut page);
    let ends = page.value("explore.view.range");
    let most = page.value("+document.querySelector('[data-end=low]').max").as_f64().unwrap();
    assert!((ends[0].as_f64().unwrap() / most - 0.5).abs() < 1e-6, "{ends} of {most}");
    assert!((page.value("+document.querySelector('#low').value").as_f64().unwrap() / most - 0.5).abs() < 1e-3);
    page.value("document.querySelector('#reset-range').click()");
    settled(&mut page);
    keep(&mut page, "explore-ghost.png");
    // In perspective.
    let before = page.value(pixels);
    page.value("document.querySelector('#perspective').click()");
    settled(&mut page);
    assert_eq!(page.value("explore.view.perspective"), 30);
    assert_ne!(page.value(pixels), before);
    keep(&mut page, "explore-perspective.png");
    // The command that makes the view.
    page.value("document.querySelector('#command').click()");
    page.wait_for("String(document.querySelector('#command-text').hidden)", "false");
    let command = page.value("document.querySelector('#command-text').textContent");
    assert!(command.as_str().unwrap().contains("hidden_layers = [2]"), "{command}");
    assert!(command.as_str().unwrap().contains("ghost_layers = [1]"), "{command}");
    assert!(command.as_str().unwrap().contains("perspective = 30"), "{command}");
    // The entry of a scene that makes it, with finer outlines.
    page.value("document.querySelector('#finer').click()");
    page.value("document.querySelector('#entry').click()");
    page.wait_for(
        "String(document.querySelector('#command-text').textContent.startsWith('[[output.picture]]'))",
        "true",
    );
    let entry = page.value("document.querySelector('#command-text').textContent");
    assert!(entry.as_str().unwrap().contains("hidden_layers = [\"outer\"]"), "{entry}");
    assert!(entry.as_str().unwrap().contains("supersampling = 2"), "{entry}");
    assert_eq!(page.complaints(), Vec::<Value>::new(), "the console has complaints");

    page.visit(&shown.0, "light");
    settled(&mut page);
    keep(&mut page, "explore-light.png");
    assert_eq!(page.complaints(), Vec::<Value>::new(), "the console has complaints");
}

/// A browser that shows a run; `None`, said aloud, where one of both is missing.
fn open(test: &str, with: Option<&Path>, scheme: &str) -> Option<(Shown, Browser)> {
    let Some(program) = browser::find() else {
        skipped(test, "no Chromium");
        return None;
    };
    let shown = Shown::beside(test, with)?;
    let mut page = Browser::start(&program);
    page.visit(&shown.0, scheme);
    settled(&mut page);
    Some((shown, page))
}

/// The one file that a page saves into a folder, when it is whole.
fn saved(folder: &TempDir, ending: &str) -> PathBuf {
    let begin = Instant::now();
    loop {
        let mut files = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
        if let Some(file) = files.find(|file| file.extension().is_some_and(|e| e == ending)) {
            return file;
        }
        assert!(begin.elapsed() < PATIENCE, "no .{ending} is saved");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn what_is_taken_away_is_what_is_on_the_screen() {
    let Some((shown, mut page)) = open("what_is_taken_away_is_what_is_on_the_screen", None, "dark") else { return };
    let files = tempfile::tempdir().unwrap();
    page.save_into(files.path());
    page.value("document.querySelector('#save').click()");
    let view: View = serde_json::from_value(page.value("explore.view")).unwrap();
    let bytes = std::fs::read(saved(&files, "png")).unwrap();
    let drawn = image::load_from_memory(&bytes).unwrap().into_rgb8();
    let size = [drawn.width(), drawn.height()];
    assert!(bytes == picture(shown.folder.path(), None, &view, size).unwrap(), "another picture than the library's");
    // The pixels of the canvas, top to bottom.
    let sum = "(c => [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data].reduce((a, v, k) => k % 4 < 3 ? \
               (a * 31 + v) % 1000003 : a, 7))(document.querySelector('#picture'))";
    let right = drawn.as_raw().iter().fold(7u64, |a, v| (a * 31 + u64::from(*v)) % 1_000_003);
    assert_eq!(page.value(sum).as_u64(), Some(right), "the canvas shows other pixels");

    // Three views of a film: each as it is on the screen when it is added.
    page.value("document.querySelector('#add-view').click()");
    assert_eq!(page.value("document.querySelector('#make-film').disabled"), true, "one view makes no film");
    page.drag("#stage", [0.4, 0.5], [0.6, 0.55]);
    page.value("(s => { s.value = 11; s.dispatchEvent(new Event('input')); })(document.querySelector('#slider'))");
    page.value("document.querySelector('#add-view').click()");
    page.value("(e => { e.value = 0.2; })(document.querySelector('#leg'))");
    page.value("document.querySelector('#film-words').click()");
    page.wait_for("String(document.querySelector('#command-text').hidden)", "false");
    let command = page.value("document.querySelector('#command-text').textContent");
    let command = command.as_str().unwrap();
    assert!(
        command.starts_with("strandsnap render RUN --view '") && command.ends_with("--animation film.mp4"),
        "{command}"
    );
    page.value("document.querySelector('#make-film').click()");
    let film = decoded_film(&saved(&files, "mp4"));
    assert_eq!(film.len(), 7);
    page.wait_for("String(document.querySelector('#film-text').textContent.startsWith('The film is saved'))", "true");
    // A view of it brings everything back.
    page.value("document.querySelector('#views button').click()");
    settled(&mut page);
    let back: View = serde_json::from_value(page.value("explore.view")).unwrap();
    assert_eq!(back, view);
    assert_eq!(page.value("document.querySelector('#slider').value"), view.state.to_string());
    assert_eq!(page.complaints(), Vec::<Value>::new(), "the console has complaints");
}

#[test]
fn two_runs_are_compared_in_one_page() {
    let beside = folder(7);
    let Some((_shown, mut page)) = open("two_runs_are_compared_in_one_page", Some(beside.path()), "light") else {
        return;
    };
    let strain = |count: usize, at: usize| Run::new(count).snapshots()[at].sample.strain * 1e2;
    page.value("(s => { s.value = 9; s.dispatchEvent(new Event('input')); })(document.querySelector('#slider'))");
    settled(&mut page);
    // Both at the strain of the first one's state.
    let words = format!("{:.2} % strain", strain(12, 9).min(strain(7, 6)));
    let now = page.value("document.querySelector('#now').textContent");
    assert_eq!(now.as_str().unwrap().matches(&words).count(), 2, "{now}");
    assert!(now.as_str().unwrap().contains("Right: "), "{now}");
    // The two halves show something, and not the same: the second run has other states.
    let halves = page.value(
        "(c => [0, 1].map(k => { const d = c.getContext('2d').getImageData(k * c.width / 2, 0, c.width / 2, c.height).data; \
         return new Set(Array.from({ length: d.length / 4 }, (_, i) => d[4 * i])).size; }))(document.querySelector('#picture'))",
    );
    assert!(halves[0].as_u64() > Some(50) && halves[1].as_u64() > Some(50), "{halves}");
    assert_eq!(page.value("document.querySelectorAll('#curve .line').length"), 2);
    page.value("document.querySelector('#command').click()");
    page.wait_for("String(document.querySelector('#command-text').hidden)", "false");
    assert_eq!(page.complaints(), Vec::<Value>::new(), "the console has complaints");
}

#[test]
fn the_page_keeps_the_rules_of_accessibility() {
    const NAME: &str = "the_page_keeps_the_rules_of_accessibility";
    if std::env::var_os("AXE_FOR_TESTS").is_none() {
        return skipped(NAME, "no axe-core");
    }
    let Some((shown, mut page)) = open(NAME, None, "dark") else { return };
    page.value("document.querySelector('#breaks tbody button').click()");
    page.value("explore.film.add(); explore.film.add(); document.querySelector('#film-words').click()");
    settled(&mut page);
    assert_eq!(page.violations().unwrap(), Vec::<String>::new(), "dark");
    page.visit(&shown.0, "light");
    settled(&mut page);
    assert_eq!(page.violations().unwrap(), Vec::<String>::new(), "light");
    page.size(390, 844);
    settled(&mut page);
    assert_eq!(page.violations().unwrap(), Vec::<String>::new(), "on a phone");
    keep(&mut page, "explore-phone.png");
}

/// The page of a run that is there, as a picture: the first one of README is made so, of `strandsnap run ka4`.
#[test]
#[ignore = "makes a picture of RUN in FILE"]
fn a_picture_of_the_page() {
    let [run, file] = ["RUN", "FILE"].map(|name| PathBuf::from(std::env::var_os(name).expect("RUN and FILE are set")));
    let server = Server::open(&run, Options::default()).unwrap();
    let (address, stop) = (server.address(), AtomicBool::new(false));
    std::thread::scope(|scope| {
        scope.spawn(|| server.serve(&stop).unwrap());
        let mut page = Browser::start(&browser::find().expect("Chromium is needed"));
        page.size(1440, 960);
        page.visit(&address, "dark");
        settled(&mut page);
        // Some breaks later, where most of them are, with all layers.
        page.value(
            "(run => { const places = run.ruptures.map(r => r.rest_z).sort((a, b) => a - b); \
             explore.toState(run.ruptures.at(-4).state); \
             Object.assign(explore.view, { hidden_layers: [], follow: places[places.length >> 1], elevation: 12, \
             azimuth: -16, height: 5.5 }); \
             document.querySelectorAll('#layers input').forEach(box => { box.checked = true; }); \
             explore.changed(); })(explore.run())",
        );
        settled(&mut page);
        page.screenshot(&file);
        stop.store(true, Ordering::Relaxed);
    });
}
