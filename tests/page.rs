//! The page of a run: what it says, what it must not hold, and that a real browser shows it.

mod browser;
mod synthetic;

use base64::Engine;
use browser::Browser;
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use strandsnap::base::error::Error;
use strandsnap::base::finding::StopReason;
use strandsnap::observe::Observer;
use strandsnap::observe::origin::Origin;
use strandsnap::observe::summary::{Closing, Cost, Summariser};
use strandsnap::observe::trajectory::TrajectoryWriter;
use strandsnap::page::{self, Source};
use strandsnap::run::{self, RunOptions};
use strandsnap::scene;
use synthetic::{Event, Run};
use tempfile::TempDir;

/// Text that would run or end its surroundings if it were not escaped.
const HOSTILE: &str = "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=2>%{x}";

/// The folder of a run that was not simulated, as a run writes it; `pictures` of its snapshots have frames.
fn folder_of(run: &Run, pictures: usize) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let scene = scene::load("ka4", &[]).unwrap();
    let origin = Origin::of(&scene.spec);
    run.show(&mut TrajectoryWriter::new(&at("trajectory.bin"), origin).unwrap()).unwrap();
    fs::write(at("scene.toml"), scene::write::to_toml(&scene.spec)).unwrap();
    let mut summariser = Summariser::new();
    run.show(&mut summariser).unwrap();
    let steps = run.samples().last().unwrap().step;
    let cost = Cost { steps, wall_s: 12.5, threads: 2, ..Cost::default() };
    let closing = Closing { stopped: StopReason::Steps { limit: 7, reached: 7 }, cost, ..Closing::default() };
    let summary = summariser.summary(&scene.spec, 10_000, closing);
    let text = serde_json::to_string_pretty(&summary).unwrap();
    fs::write(at("summary.json"), run::identity::seal(&text, origin, folder.path(), &[]).unwrap()).unwrap();
    fs::create_dir(at("frames")).unwrap();
    for number in 0..pictures {
        let shade = |x: u32, y: u32| image::Rgb([x as u8, y as u8, number as u8 * 9]);
        image::RgbImage::from_fn(160, 90, shade).save(at(&format!("frames/frame_{number:04}.png"))).unwrap();
    }
    folder
}

/// A real run of a scene that ships with the program, without frames and recording.
fn simulated(name: &str, overrides: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    let options = RunOptions {
        out: folder.path().into(),
        overwrite: true,
        wait: false,
        threads: Some(2),
        device: run::DeviceChoice::default(),
        frames: false,
        recording: false,
        live: None,
        animation: None,
    };
    run::run(&scene::load(name, &overrides).unwrap(), &options, &AtomicBool::new(false)).unwrap();
    folder
}

fn html(folder: &TempDir) -> String {
    page::html(&Source::read(folder.path()).unwrap()).unwrap()
}

/// The page without its scripts and data, whose text is no markup.
fn markup(html: &str) -> String {
    let mut rest = html;
    let mut markup = String::new();
    while let Some(start) = rest.find("<script") {
        let end = start + rest[start..].find("</script>").expect("every script ends") + "</script>".len();
        markup.push_str(&rest[..start]);
        rest = &rest[end..];
    }
    markup + rest
}

/// Data of the page: `<script class="CLASS" data-of="OF">`.
fn data(html: &str, class: &str, of: &str) -> Value {
    let tag = format!(r#"<script type="application/json" class="{class}" data-of="{of}">"#);
    let start = html.find(&tag).unwrap_or_else(|| panic!("there is no {class} of {of}")) + tag.len();
    let end = start + html[start..].find("</script>").unwrap();
    serde_json::from_str(&html[start..end]).unwrap()
}

/// Numbers as the page hands them to its charts.
fn numbers(value: &Value) -> Vec<f32> {
    assert_eq!(value["dtype"], "f4", "{value}");
    let bytes = base64::engine::general_purpose::STANDARD.decode(value["bdata"].as_str().unwrap()).unwrap();
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

fn values_of<'a>(markup: &'a str, attribute: &str) -> Vec<&'a str> {
    let opening = format!(" {attribute}=\"");
    markup.split(&opening).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

#[test]
fn the_page_fetches_nothing() {
    let html = html(&folder_of(&Run::new(12), 12));
    let markup = markup(&html);
    let sources = values_of(&markup, "src");
    assert!(!sources.is_empty() && sources.iter().all(|s| s.starts_with("data:image/jpeg;base64,")), "{sources:?}");
    let links = values_of(&markup, "href");
    assert!(links.len() > 5 && links.iter().all(|l| l.starts_with('#')), "{links:?}");
    for way_out in ["http:", "https:", "url(", "@import", "<link", "<iframe", "<object"] {
        assert!(!markup.contains(way_out), "{way_out}");
    }
    assert!(markup.contains("default-src 'none'"));
    assert!(!html.contains(" src=\"http") && !html.contains(" href=\"http"));
}

#[test]
fn its_numbers_are_those_of_the_summary() {
    let run = Run::new(12);
    let folder = folder_of(&run, 0);
    let html = html(&folder);
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("summary.json")).unwrap()).unwrap();
    let number = |key: &str| summary[key].as_f64().unwrap_or_else(|| panic!("{key}"));
    let first = &summary["first_rupture"];
    let told = [
        format!("{:.2} MPa", number("greatest_stress_mpa")),
        format!("{:.2} %", number("strain_at_greatest_stress_percent")),
        format!("{:.2} MPa", number("residual_stress_mpa")),
        format!("Wire {}, {} layer,", first["wire"], first["layer"].as_str().unwrap()),
        format!("{:.1} mm</strong> before loading", first["rest_z_mm"].as_f64().unwrap()),
        format!("{:.1} mm when it snapped", first["z_mm"].as_f64().unwrap()),
        format!("{:.2} % strain", first["strain_percent"].as_f64().unwrap()),
        format!("{} of {}", summary["wires_broken"], run.info.wires.len()),
        "12.5 s".to_string(),
    ];
    for text in told {
        assert!(html.contains(&text), "{text} is not in the page");
    }
    let table = html.split("id=\"breaks\"").nth(1).unwrap().split("</table>").next().unwrap();
    assert_eq!(table.matches("<tr").count(), 1 + summary["bonds_broken"].as_u64().unwrap() as usize);
}

#[test]
fn its_charts_hold_the_rows_and_stresses_of_the_run() {
    let run = Run::new(12);
    let html = html(&folder_of(&run, 0));
    let curve = &data(&html, "figure", "curve-whole")["data"][0];
    let (strain, stress): (Vec<f32>, Vec<f32>) =
        run.samples().iter().map(|row| ((row.strain * 1e2) as f32, (row.stress * 1e-6) as f32)).unzip();
    assert_eq!(numbers(&curve["x"]), strain);
    assert_eq!(numbers(&curve["y"]), stress);

    let states = data(&html, "states", "states");
    let shown = states["states"].as_array().unwrap();
    assert_eq!(shown.len(), run.snapshots().len());
    for (state, snapshot) in shown.iter().zip(run.snapshots()) {
        let broken = run.ruptures().iter().filter(|r| r.step <= snapshot.sample.step).count();
        assert_eq!(state["broken"], broken);
        for (cells, wire) in state["stress"].as_array().unwrap().iter().zip(&run.info.wires) {
            let bonds = &snapshot.bond_stress[wire.first..wire.first + wire.len - 1];
            let cells = numbers(cells);
            assert_eq!(cells.len(), bonds.len());
            // A broken bond is a hole, not a zero.
            let shows =
                |cell: f32, bond: f32| cell == (f64::from(bond) * 1e-6) as f32 || (cell.is_nan() && bond == 0.0);
            assert!(cells.iter().zip(bonds).all(|(cell, bond)| shows(*cell, *bond)));
        }
        let holes = state["stress"].as_array().unwrap().iter().flat_map(numbers).filter(|c| c.is_nan()).count();
        assert_eq!(holes, broken);
    }
    let rest_z = run.ruptures()[0].rest_z * 1e3;
    assert!((states["marks"]["x"][0].as_f64().unwrap() - rest_z).abs() < 1e-9);
}

#[test]
fn text_from_the_scene_cannot_become_markup() {
    let mut run = Run::new(4);
    let info = Arc::make_mut(&mut run.info);
    (info.name, info.about) = (HOSTILE.into(), HOSTILE.into());
    info.layers[2] = HOSTILE.into();
    let html = html(&folder_of(&run, 0));
    assert!(!html.contains("<script>window.hacked"), "the scene's text is a script of the page");
    assert!(!html.contains("<img src=x"), "the scene's text is markup of the page");
    assert!(html.contains("&lt;/script&gt;"));
}

#[test]
fn a_run_without_frames_says_how_to_make_them() {
    let page = markup(&html(&folder_of(&Run::new(4), 0)));
    assert!(page.contains("The run has no frames") && page.contains("strandsnap render RUN"));
    assert!(!page.contains("<img"));
}

#[test]
fn frames_are_shown_with_their_own_snapshots_and_counted() {
    let html = html(&folder_of(&Run::new(12), 3));
    assert!(html.contains("3 of 3 frames are in this page"));
    let states = data(&html, "states", "states");
    let with: Vec<bool> = states["states"].as_array().unwrap().iter().map(|s| s["picture"].is_string()).collect();
    assert_eq!(with.iter().filter(|w| **w).count(), 3);
    assert!(with[..3].iter().all(|w| *w));
}

#[test]
fn free_spheres_have_no_curve_no_map_and_no_wires() {
    let folder = simulated("two-spheres", &[]);
    let page = html(&folder);
    for sentence in ["There is no curve", "there is no wire that could break", "This scene has no wires", "Not judged"]
    {
        assert!(page.contains(sentence), "{sentence}");
    }
    assert!(!page.contains(r#"data-of="map""#) && !page.contains(r#"data-of="curve-whole""#));
    assert!(page.contains(r#"data-of="ledger""#));
}

#[test]
fn a_wire_that_is_turned_has_torque_over_time() {
    let page = html(&simulated("torsion", &["stop.steps=400"]));
    assert!(page.contains("torque (N mm)") && page.contains("time (ms)"));
    assert!(!page.contains("Tensile strength") && !page.contains("nominal strain (%)"));
}

#[test]
fn a_wire_that_does_not_break_has_no_strength() {
    let page = html(&simulated("single-wire", &["stop.steps=400"]));
    assert!(page.contains("No wire broke.") && page.contains("Nothing broke."));
    assert!(page.contains("Greatest stress") && !page.contains("Tensile strength"));
}

#[test]
fn a_run_that_died_is_shown_as_far_as_it_went_and_says_so() {
    let run = Run::new(12);
    let folder = folder_of(&run, 0);
    let at = |name: &str| folder.path().join(name);
    fs::remove_file(at("summary.json")).unwrap();
    let bytes = fs::read(at("trajectory.bin")).unwrap();
    fs::remove_file(at("trajectory.bin")).unwrap();
    fs::write(at("trajectory.bin.partial"), &bytes[..bytes.len() / 2]).unwrap();
    let source = Source::read(folder.path()).unwrap();
    assert!(source.samples.len() > 10 && source.samples.len() < run.samples().len());
    assert!(!source.finished);
    let page = page::html(&source).unwrap();
    assert!(page.contains("The run did not end properly") && page.contains("role=\"alert\""));
    assert!(!page.contains("wall time"), "what it cost is not known");
}

#[test]
fn a_summary_made_from_the_trajectory_is_the_one_that_the_run_wrote() {
    let folder = simulated("single-wire", &[]);
    let written = Source::read(folder.path()).unwrap().summary;
    fs::remove_file(folder.path().join("summary.json")).unwrap();
    let made = Source::read(folder.path()).unwrap();
    assert!(made.notes.iter().any(|note| note.contains("summary.json")), "{:?}", made.notes);
    assert_eq!(made.summary.first_rupture.as_ref().map(|b| (b.wire, b.order)), Some((1, 1)));
    let close = |a: Option<f64>, b: Option<f64>| (a.unwrap() - b.unwrap()).abs() < 1e-12 * b.unwrap().abs();
    assert!(close(made.summary.tensile_strength_mpa, written.tensile_strength_mpa));
    assert!(close(made.summary.fracture_elongation_percent, written.fracture_elongation_percent));
    assert_eq!((made.summary.bonds, made.summary.particles), (written.bonds, written.particles));
}

/// What is wrong with a folder, as the user is told.
fn refused(folder: &Path) -> String {
    let error = Source::read(folder).err().expect("this folder is no run");
    assert_eq!(error.exit_code(), 2, "{error:?}");
    let Error::Input { what, help: Some(_) } = error else { panic!("{error:?}") };
    what
}

#[test]
fn a_folder_that_is_no_run_is_told_what_it_lacks() {
    let empty = tempfile::tempdir().unwrap();
    assert!(refused(&empty.path().join("nowhere")).contains("does not exist"));
    assert!(refused(empty.path()).contains("holds no trajectory.bin"));
    for damage in [&b""[..], b"strandsnap\0T", b"strandsnap\0T\x01\0\0\0 and then nothing of use"] {
        fs::write(empty.path().join("trajectory.bin"), damage).unwrap();
        assert!(refused(empty.path()).contains("trajectory.bin"), "{damage:?}");
    }
}

#[test]
fn damaged_and_mixed_runs_are_refused() {
    let folder = folder_of(&Run::new(4), 0);
    let summary = folder.path().join("summary.json");
    let whole = fs::read_to_string(&summary).unwrap();
    fs::write(&summary, &whole[..whole.len() / 2]).unwrap();
    assert!(refused(folder.path()).contains("summary.json"));
    let other = folder_of(&Run::new(7), 0);
    fs::copy(other.path().join("summary.json"), &summary).unwrap();
    fs::write(&summary, fs::read_to_string(&summary).unwrap().replace("\"bonds_broken\": 6", "\"bonds_broken\": 5"))
        .unwrap();
    assert!(refused(folder.path()).contains("not of one run"));
    fs::remove_file(&summary).unwrap();
    fs::remove_file(folder.path().join("scene.toml")).unwrap();
    assert!(refused(folder.path()).contains("neither summary.json nor"));
}

fn report(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandsnap")).arg("report").args(arguments).output().expect("the program starts")
}

#[test]
fn the_program_writes_the_page_and_replaces_nothing_unasked() {
    let folder = folder_of(&Run::new(4), 2);
    let run = folder.path().to_str().unwrap();
    let page = folder.path().join("report.html");
    let first = report(&[run]);
    let said = String::from_utf8_lossy(&first.stdout).into_owned();
    assert!(first.status.success() && said.contains("report.html") && said.contains("2 of 2 frames"), "{said}");
    let before = fs::read_to_string(&page).unwrap();
    assert!(before.ends_with("</html>"));

    let foreign = folder.path().join("mine.html");
    fs::write(&foreign, "precious").unwrap();
    for arguments in [vec![run], vec![run, "--out", foreign.to_str().unwrap()]] {
        let again = report(&arguments);
        assert_eq!(again.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&again.stderr).contains("--overwrite"));
    }
    assert_eq!(fs::read_to_string(&foreign).unwrap(), "precious");
    assert!(report(&[run, "--overwrite"]).status.success());
    assert_eq!(fs::read_to_string(&page).unwrap(), before, "the same run gives the same page");

    let nowhere = report(&["nowhere"]);
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&nowhere.stderr).contains("nowhere does not exist"));
}

/// The browser; else says that `test` did not run.
fn browser(test: &str) -> Option<Browser> {
    let program = browser::find();
    if program.is_none() {
        // Past the test harness, which hides what passing tests print.
        let _ = writeln!(std::io::stderr(), "SKIPPED (no browser): {test}");
    }
    program.map(|program| Browser::start(&program))
}

/// Writes a page and opens it; it must have drawn all its charts without a complaint.
fn shown(browser: &mut Browser, folder: &TempDir, scheme: &str) -> PathBuf {
    let written = page::write(folder.path(), None, None, true, false).unwrap();
    browser.open(&written.path, scheme);
    let trouble = browser.value("document.getElementById('trouble').textContent");
    assert!(browser.value("document.documentElement.dataset.troubles ?? null").is_null(), "{trouble}");
    let places = browser.value("String(document.querySelectorAll('.plot').length)");
    assert_eq!(browser.value("document.documentElement.dataset.charts"), places);
    let empty =
        "[...document.querySelectorAll('.plot')].filter(p => !p.querySelector('.main-svg')).map(p => p.id).join()";
    assert_eq!(browser.value(empty), "");
    assert_eq!(
        browser
            .value("String(performance.getEntriesByType('resource').filter(r => !r.name.startsWith('data:')).length)"),
        "0"
    );
    written.path
}

/// Where pictures for people are kept.
fn kept(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    fs::create_dir_all(folder).unwrap();
    folder.join(name)
}

#[test]
fn a_browser_draws_every_chart_and_the_slider_moves_frame_and_map() {
    let Some(mut browser) = browser("a_browser_draws_every_chart_and_the_slider_moves_frame_and_map") else { return };
    let run = Run::new(12);
    let folder = folder_of(&run, 12);
    shown(&mut browser, &folder, "light");
    assert_eq!(browser.value("String(document.querySelectorAll('.plot').length)"), "8");
    browser.screenshot(&kept("page-light.png"));

    // As many lines as wires and crosses as breaks, in the chart itself.
    let wires = run.info.wires.len();
    assert_eq!(browser.value("document.querySelectorAll('#map .hm').length"), wires as u64);
    let crosses = "document.querySelectorAll('#map .scatterlayer .point').length";
    assert_eq!(browser.value(crosses), run.ruptures().len() as u64);
    let picture = "document.getElementById('frame').src";
    let (last, told) = (browser.value(picture), browser.value("document.getElementById('state').textContent"));

    browser.press("ArrowLeft");
    browser.wait_for("document.documentElement.dataset.state ?? null", "10");
    assert_ne!(browser.value(picture), last);
    assert_ne!(browser.value("document.getElementById('state').textContent"), told);
    browser.value("document.querySelector('.jump').click()");
    browser.wait_for("document.documentElement.dataset.state", "0");
    assert_eq!(browser.value(crosses), 0);
    browser.value("document.getElementById('play').click()");
    browser.wait_for("document.documentElement.dataset.state", "11");
    assert_eq!(browser.value(picture), last);

    for (chart, told) in
        [("curve-whole", ["strain", "MPa", "wires broken"]), ("wires-whole", ["wire 1", "inner layer", "MPa"])]
    {
        browser.value(&format!("void Plotly.Fx.hover('{chart}', [{{ curveNumber: 0, pointNumber: 60 }}])"));
        let text = browser.value(&format!("document.querySelector('#{chart} .hoverlayer').textContent"));
        assert!(told.iter().all(|word| text.as_str().unwrap().contains(word)), "{chart}: {text}");
    }
    // Cells of the map have no number to ask for, but fill their row: a mouse finds one.
    browser.point_at("#map .nsewdrag", [0.6, 0.985]);
    let text = "document.querySelector('#map .hoverlayer').textContent";
    browser.wait_for(&format!("String({text} !== '')"), "true");
    let text = browser.value(text);
    assert!(["wire 1", "mm before loading", "MPa"].iter().all(|word| text.as_str().unwrap().contains(word)), "{text}");

    // Nothing offers to send the run's data anywhere.
    let buttons = browser.value("[...document.querySelectorAll('.modebar-btn')].map(b => b.dataset.title).join()");
    let buttons = buttons.as_str().unwrap().to_lowercase();
    assert!(buttons.contains("download") && !buttons.contains("cloud") && !buttons.contains("share"), "{buttons}");
}

#[test]
fn a_browser_shows_light_and_dark_and_changes_between_them() {
    let Some(mut browser) = browser("a_browser_shows_light_and_dark_and_changes_between_them") else { return };
    let folder = folder_of(&Run::new(12), 12);
    shown(&mut browser, &folder, "dark");
    browser.screenshot(&kept("page-dark.png"));
    let ink = "getComputedStyle(document.body).color";
    let tick = "getComputedStyle(document.querySelector('#curve-whole .xtick text')).fill";
    let dark = browser.value(ink);
    assert_eq!(browser.value(tick), dark, "the charts have the page's colours");
    browser.value("document.getElementById('theme').click()");
    let dark = dark.as_str().unwrap().to_owned();
    browser.wait_for(&format!("String({ink} !== '{dark}' && {tick} === {ink})"), "true");
}

#[test]
fn a_browser_runs_nothing_that_a_scene_says() {
    let Some(mut browser) = browser("a_browser_runs_nothing_that_a_scene_says") else { return };
    let mut run = Run::new(4);
    let info = Arc::make_mut(&mut run.info);
    (info.name, info.about) = (HOSTILE.into(), HOSTILE.into());
    info.layers[2] = HOSTILE.into();
    shown(&mut browser, &folder_of(&run, 0), "light");
    assert!(browser.value("window.hacked ?? null").is_null());
    assert_eq!(browser.value("document.querySelector('h1').textContent"), HOSTILE);
    assert_eq!(browser.value("document.querySelectorAll('img').length"), 0);
    assert!(browser.value("document.querySelector('#map').textContent").as_str().unwrap().contains("</script>"));
}

#[test]
fn a_browser_shows_runs_that_have_little_to_show() {
    let Some(mut browser) = browser("a_browser_shows_runs_that_have_little_to_show") else { return };
    shown(&mut browser, &simulated("two-spheres", &[]), "light");
    shown(&mut browser, &simulated("torsion", &["stop.steps=400"]), "dark");
    shown(&mut browser, &simulated("cantilever", &["stop.steps=200"]), "light");
    // A run of one state.
    let mut run = Run::new(1);
    run.events.truncate(1);
    let folder = tempfile::tempdir().unwrap();
    let scene = scene::load("ka4", &[]).unwrap();
    let trajectory = folder.path().join("trajectory.bin");
    let mut writer = TrajectoryWriter::new(&trajectory, Origin::of(&scene.spec)).unwrap();
    run.show_unfinished(&mut writer).unwrap();
    writer.finish().unwrap();
    fs::write(folder.path().join("scene.toml"), scene::write::to_toml(&scene.spec)).unwrap();
    assert!(matches!(run.events[0], Event::Sample(_)));
    shown(&mut browser, &folder, "light");
}

#[test]
fn a_browser_turns_the_run_and_marks_a_wire_in_map_curve_and_table() {
    let Some(mut browser) = browser("a_browser_turns_the_run_and_marks_a_wire_in_map_curve_and_table") else { return };
    let run = Run::new(12);
    shown(&mut browser, &folder_of(&run, 12), "light");
    browser.size(1440, 900);
    browser.wait_for("document.documentElement.dataset.solid", "yes");
    // Particles lie where the run has them, to half a step of the box.
    let last = run.snapshots().pop().unwrap();
    for i in [0, 17, run.info.particles - 1] {
        let place = browser.value(&format!("page.solid().state().place({i})"));
        for k in 0..3 {
            let off = place[k].as_f64().unwrap() - 1e3 * f64::from(last.position[i][k]);
            assert!(off.abs() < 2e-3, "particle {i}, coordinate {k} is off by {off} mm");
        }
    }
    // Something is drawn, something else from another side, and less without a layer.
    let drawn = "(c => { const s = document.createElement('canvas'); [s.width, s.height] = [c.width, c.height]; \
                 const x = s.getContext('2d'); x.drawImage(c, 0, 0); const d = x.getImageData(0, 0, s.width, s.height).data; \
                 let n = 0; for (let i = 4; i < d.length; i += 4) n += d[i] !== d[0] || d[i + 1] !== d[1]; return n; })\
                 (document.querySelector('#solid'))";
    let frame = "new Promise(f => requestAnimationFrame(() => requestAnimationFrame(() => f(1))))";
    let count = |browser: &mut Browser| {
        browser.value(frame);
        browser.value(drawn).as_f64().unwrap()
    };
    let opened = count(&mut browser);
    browser.value("document.querySelector('.solid [data-view=home]').click()");
    let whole = count(&mut browser);
    assert!(whole > 1000.0, "{whole} pixels are drawn");
    browser.value("document.querySelector('.solid [data-view=break]').click()");
    let near = count(&mut browser);
    assert_eq!(opened, near, "the page opens on the breaks");
    assert!(near > 2.0 * whole, "{near} pixels close to the breaks, {whole} of the whole");
    browser.value("document.querySelector('.solid [data-layer=\"2\"]').click()");
    assert!(count(&mut browser) < near);
    browser.screenshot(&kept("page-shape.png"));
    browser.value("document.querySelector('.solid [data-layer=\"2\"]').click()");
    // A click in the middle of the whole strand takes the wire that lies there, everywhere.
    browser.value("document.querySelector('.solid [data-view=home]').click()");
    count(&mut browser);
    let click = "(c => { const b = c.getBoundingClientRect(), at = { clientX: b.left + b.width / 2, clientY: b.top + b.height / 2, \
                 pointerId: 1, bubbles: true }; c.setPointerCapture = () => {}; \
                 c.dispatchEvent(new PointerEvent('pointerdown', at)); c.dispatchEvent(new PointerEvent('pointerup', at)); \
                 return page.solid().state().chosen; })(document.querySelector('#solid'))";
    assert!(browser.value(click).as_i64().unwrap() >= 0, "a wire lies in the middle");
    // One that broke.
    browser.value("page.choose(23)");
    browser.wait_for("String(document.querySelectorAll('tr.chosen').length)", "1");
    assert_eq!(browser.value("document.querySelector('tr.chosen td:nth-child(2)').textContent"), "24");
    let shapes = |id: &str| format!("document.querySelector('#{id}').layout.shapes.length");
    let (map, curve) = (browser.value(&shapes("map")), browser.value(&shapes("curve-whole")));
    assert!(map.as_u64() > Some(0) && curve == 1, "{map} in the map, {curve} in the curve");
    let told = browser.value("document.querySelector('#solid-told').textContent");
    assert!(told.as_str().unwrap().starts_with("wire 24, outer layer: broken: break 1"), "{told}");
    // Slider, frame, shape and map are in sight together. A picture of the whole page has changed the window.
    browser.size(1440, 900);
    browser.value("document.querySelector('#states .controls').scrollIntoView()");
    let bottom = "Math.max(...['#frame', '#solid', '#map'].map(id => document.querySelector(id).getBoundingClientRect().bottom))";
    let below = browser.value(bottom).as_f64().unwrap();
    assert!(below <= 900.0, "the lowest ends at {below} of 900 pixels");
    browser.screenshot(&kept("page-shape-whole.png"));
    // The words for those who do not see it follow the slider.
    browser.value("document.querySelector('.jump').click()");
    let told = browser.value("document.querySelector('#state').textContent");
    for (element, words) in [("#frame", "alt"), ("#solid", "aria-label")] {
        let said = browser.value(&format!("document.querySelector('{element}').getAttribute('{words}')"));
        assert!(said.as_str().unwrap().ends_with(told.as_str().unwrap()), "{said} at {told}");
    }
    assert_eq!(browser.value("document.documentElement.dataset.troubles ?? null"), serde_json::Value::Null);
}

#[test]
fn a_browser_finds_no_barrier_in_the_page() {
    const NAME: &str = "a_browser_finds_no_barrier_in_the_page";
    if std::env::var_os("AXE_FOR_TESTS").is_none() {
        let _ = writeln!(std::io::stderr(), "SKIPPED (no axe-core): {NAME}");
        return;
    }
    let Some(mut browser) = browser(NAME) else { return };
    let folder = folder_of(&Run::new(12), 12);
    for scheme in ["light", "dark"] {
        shown(&mut browser, &folder, scheme);
        assert_eq!(browser.violations().unwrap(), Vec::<String>::new(), "{scheme}");
    }
    browser.size(390, 844);
    assert_eq!(browser.violations().unwrap(), Vec::<String>::new(), "on a phone");
}
