//! The real program in temporary folders: exit codes, messages, and the files of a run.

#[path = "common/rows.rs"]
mod rows;

use rows::rows;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output};

#[path = "cli/scene.rs"]
mod scene;

/// A command in an empty folder.
fn strandsnap(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandsnap"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn assert_code(output: &Output, code: i32) {
    let (out, err) = (stdout(output), stderr(output));
    assert_eq!(output.status.code(), Some(code), "stdout:\n{out}\nstderr:\n{err}");
}

/// Text of a message with the breaks and bars of the report removed, so that a phrase can be looked for.
fn plain(text: &str) -> String {
    text.split_whitespace().filter(|w| !["│", "|"].contains(w)).collect::<Vec<_>>().join(" ")
}

/// Arguments of the shortest run that writes everything but pictures and recording.
const SHORT: [&str; 8] =
    ["run", "single-wire", "--set", "stop.steps=400", "--set", "output.samples=40", "--set", "output.snapshots=4"];

fn short_run(folder: &Path, more: &[&str]) -> Output {
    let arguments = [&SHORT[..], more].concat();
    strandsnap(folder, &arguments)
}

const LEAN: [&str; 2] = ["--no-frames", "--no-recording"];

#[test]
fn help_and_version_are_well() {
    let folder = tempfile::tempdir().unwrap();
    assert_code(&strandsnap(folder.path(), &["--help"]), 0);
    let version = strandsnap(folder.path(), &["--version"]);
    assert_code(&version, 0);
    let revision =
        format!("strandsnap {} (physics revision {})", env!("CARGO_PKG_VERSION"), strandsnap::engine::REVISION);
    assert_eq!(stdout(&version).trim(), revision);
}

#[test]
fn help_lists_the_exit_codes() {
    let folder = tempfile::tempdir().unwrap();
    let help = stdout(&strandsnap(folder.path(), &["--help"]));
    let codes = help.split_once("Exit codes:").expect("a list").1;
    let first = |line: &str| line.split_whitespace().next().and_then(|word| word.parse::<i32>().ok());
    assert_eq!(codes.lines().filter_map(first).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 130]);
}

#[test]
fn completions_and_manual_pages_are_made() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = strandsnap(folder.path(), &["completions", shell]);
        assert_code(&script, 0);
        assert!(stdout(&script).contains("check-run"), "{shell}");
    }
    assert_code(&strandsnap(folder.path(), &["man", "pages/man1"]), 0);
    let page = fs::read_to_string(folder.path().join("pages/man1/strandsnap-scene-keys.1")).unwrap();
    assert!(page.starts_with(".ie") || page.contains(".TH"), "{page}");
    assert!(folder.path().join("pages/man1/strandsnap.1").is_file());
    assert_code(&strandsnap(folder.path(), &["man", "pages/man1/strandsnap.1"]), 2);
}

#[test]
fn an_unknown_option_is_bad_input() {
    let folder = tempfile::tempdir().unwrap();
    assert_code(&strandsnap(folder.path(), &["run", "ka4", "--colur"]), 2);
    assert_code(&strandsnap(folder.path(), &["run", "ka4", "--threads", "0"]), 2);
    assert_code(&strandsnap(folder.path(), &["render", ".", "--size", "12"]), 2);
}

#[test]
fn an_unknown_scene_suggests_the_nearest() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [["run", "ka5"], ["plan", "ka5"]] {
        let output = strandsnap(folder.path(), &arguments);
        assert_code(&output, 2);
        assert!(stderr(&output).contains("ka4"), "{}", stderr(&output));
    }
    let output = strandsnap(folder.path(), &["scene", "show", "sngle-wire"]);
    assert_code(&output, 2);
    assert!(stderr(&output).contains("single-wire"), "{}", stderr(&output));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing may be written");
}

#[test]
fn a_scene_file_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let output = strandsnap(folder.path(), &["run", "mine.toml"]);
    assert!(matches!(output.status.code(), Some(1 | 2)), "{}", stderr(&output));
    assert!(stderr(&output).contains("mine.toml"), "{}", stderr(&output));
}

#[test]
fn a_wrong_unit_points_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let scene = stdout(&strandsnap(folder.path(), &["scene", "show", "ka4"]));
    let line = scene.lines().position(|l| l.contains("GPa\"")).expect("ka4 gives a modulus in GPa");
    fs::write(folder.path().join("wrong.toml"), scene.replace("GPa\"", "kg\"")).unwrap();
    let output = strandsnap(folder.path(), &["scene", "check", "wrong.toml"]);
    assert_code(&output, 2);
    let message = stderr(&output);
    assert!(message.contains(&format!("wrong.toml:{}:", line + 1)), "{message}");
    assert!(message.contains("kg"), "{message}");
}

#[test]
fn every_scene_is_listed_shown_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    let list = strandsnap(folder.path(), &["scene", "list"]);
    assert_code(&list, 0);
    let names: Vec<String> = stdout(&list).lines().filter_map(|l| Some(l.split_whitespace().next()?.into())).collect();
    for name in ["ka4", "single-wire", "strand-1x7", "two-spheres", "cantilever", "torsion", "jaw-grip"] {
        assert!(names.iter().any(|n| n == name), "{name} is not in {names:?}");
    }
    for name in &names {
        let check = strandsnap(folder.path(), &["scene", "check", name]);
        assert_code(&check, 0);
        let shown = strandsnap(folder.path(), &["scene", "show", name]);
        assert_code(&shown, 0);
        toml::from_str::<toml::Table>(&stdout(&shown)).expect("a scene is TOML");
    }
}

#[test]
fn an_output_folder_that_exists_is_refused_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("curve.csv"), "precious").unwrap();
    let output = short_run(folder.path(), &[&LEAN[..], &["--out", "results"]].concat());
    assert_code(&output, 2);
    assert!(stderr(&output).contains("--overwrite"), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(out.join("curve.csv")).unwrap(), "precious");
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("plain"), "").unwrap();
    let output = short_run(folder.path(), &[&LEAN[..], &["--out", "plain/below"]].concat());
    assert_code(&output, 2);
    assert!(stderr(&output).contains("plain is not a folder"), "{}", stderr(&output));
}

#[test]
fn a_run_that_does_not_exist_cannot_be_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let output = strandsnap(folder.path(), &["render", "nowhere"]);
    let built = cfg!(feature = "render");
    assert_code(&output, if built { 2 } else { 3 });
    let word = if built { "nowhere" } else { "built without" };
    assert!(plain(&stderr(&output)).contains(word), "{}", stderr(&output));
}

#[test]
fn devices_are_listed_with_what_they_are_used_for() {
    let folder = tempfile::tempdir().unwrap();
    let output = strandsnap(folder.path(), &["devices"]);
    assert_code(&output, 0);
    for word in ["processor: ", "thread", "registers of ", "raphics adapters", "used for the simulation: processor"] {
        assert!(stdout(&output).contains(word), "no `{word}` in\n{}", stdout(&output));
    }
    let output = strandsnap(folder.path(), &["devices", "--json"]);
    assert_code(&output, 0);
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(found["processor"]["threads"].as_u64() > Some(0), "{found}");
    assert!([128, 256, 512].contains(&found["processor"]["register_bits"].as_u64().unwrap()), "{found}");
    assert_eq!(found["used_for"]["simulation"], "processor");
    if cfg!(feature = "gpu") {
        let adapters = found["adapters"].as_array().unwrap();
        let whole = |a: &serde_json::Value| a["f64"].is_boolean() && a["largest_binding"].as_u64() > Some(1 << 20);
        assert!(adapters.iter().all(whole), "{found}");
        // The adapter that draws frames is one of them.
        let frames = found["used_for"]["frames"].as_str().unwrap_or_default();
        let named = |a: &serde_json::Value| frames.starts_with(a["name"].as_str().unwrap());
        assert!(frames.is_empty() || adapters.iter().any(named), "{found}");
    }
}

#[test]
fn a_plan_names_size_step_and_cost() {
    let folder = tempfile::tempdir().unwrap();
    let output = strandsnap(folder.path(), &["plan", "single-wire"]);
    assert_code(&output, 0);
    for word in ["particles", "bonds", "time step", "limited by", "steps", "contacts"] {
        assert!(stdout(&output).contains(word), "no `{word}` in\n{}", stdout(&output));
    }
}

#[test]
fn centre_lines_are_written_once() {
    let folder = tempfile::tempdir().unwrap();
    assert_code(&strandsnap(folder.path(), &["scene", "centrelines", "strand-1x7", "lines.txt"]), 0);
    let text = fs::read_to_string(folder.path().join("lines.txt")).unwrap();
    assert!(text.lines().count() > 7, "{text}");
    assert_code(&strandsnap(folder.path(), &["scene", "centrelines", "strand-1x7", "lines.txt"]), 2);
    assert_code(&strandsnap(folder.path(), &["scene", "centrelines", "strand-1x7", "lines.txt", "--overwrite"]), 0);
}

#[test]
fn a_short_run_writes_files_that_parse() {
    let folder = tempfile::tempdir().unwrap();
    let output = short_run(folder.path(), &LEAN);
    assert_code(&output, 0);
    let out = folder.path().join("out/single-wire");
    let curve = rows(&out.join("curve.csv"));
    assert!((40..=46).contains(&curve.len()), "{} rows", curve.len());
    let strain: Vec<f64> = curve.iter().map(|row| row["strain_percent"].parse().unwrap()).collect();
    assert!(strain.windows(2).all(|w| w[1] > w[0]), "strain grows from row to row: {strain:?}");
    assert_eq!(curve.last().unwrap()["step"], "400");
    assert_eq!(rows(&out.join("wires.csv")).len(), 1);
    assert_eq!(rows(&out.join("ruptures.csv")).len(), 0);
    let summary = summary(&out);
    assert_eq!(summary["steps"], 400);
    assert_eq!(summary["first_rupture"], serde_json::Value::Null);
    for key in [
        "greatest_stress_mpa",
        "strain_at_greatest_stress_percent",
        "energy_residual_percent",
        "wall_s",
        "cpu_s",
        "ms_per_step",
    ] {
        assert!(summary[key].is_f64(), "{key} is {}", summary[key]);
    }
    // Nothing failed, and 400 steps are less than one passage of a wave.
    for key in ["tensile_strength_mpa", "fracture_elongation_percent", "kinetic_over_internal_max"] {
        assert!(summary[key].is_null(), "{key} is {}", summary[key]);
    }
    assert!(summary["wires_broken_by_layer"].is_object());
    toml::from_str::<toml::Table>(&fs::read_to_string(out.join("scene.toml")).unwrap()).unwrap();
    let left: Vec<_> = fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert!(left.iter().all(|n| !n.to_string_lossy().contains("partial")), "{left:?}");
}

#[test]
fn the_resolved_scene_reproduces_the_run() {
    let folder = tempfile::tempdir().unwrap();
    assert_code(&short_run(folder.path(), &LEAN), 0);
    let again = ["run", "out/single-wire/scene.toml", "--out", "again", "--no-frames", "--no-recording"];
    assert_code(&strandsnap(folder.path(), &again), 0);
    let curve = |out: &str| fs::read_to_string(folder.path().join(out).join("curve.csv")).unwrap();
    assert_eq!(curve("out/single-wire"), curve("again"));
}

#[test]
fn overwriting_replaces_the_results_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    assert_code(&short_run(folder.path(), &LEAN), 0);
    let out = folder.path().join("out/single-wire");
    fs::write(out.join("notes.txt"), "mine").unwrap();
    fs::write(out.join("curve.csv"), "old").unwrap();
    assert_code(&short_run(folder.path(), &[&LEAN[..], &["--overwrite"]].concat()), 0);
    assert!(rows(&out.join("curve.csv")).len() > 10);
    assert_eq!(fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");
}

#[test]
fn a_quiet_run_says_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let output = short_run(folder.path(), &[&LEAN[..], &["--quiet"]].concat());
    assert_code(&output, 0);
    assert_eq!(stdout(&output).lines().count(), 1, "{}", stdout(&output));
}

#[test]
fn nobody_listening_is_said_before_the_simulation() {
    let folder = tempfile::tempdir().unwrap();
    // Port 9 is `discard`; nothing of this kind listens there.
    let live = ["--live", "rerun+http://127.0.0.1:9/proxy", "--no-frames"];
    let output = short_run(folder.path(), &live);
    assert_code(&output, 3);
    assert!(!folder.path().join("out").exists(), "nothing may be written");
}

#[test]
fn pulling_to_fracture_tells_where_it_broke() {
    let folder = tempfile::tempdir().unwrap();
    let output = strandsnap(folder.path(), &["run", "single-wire", "--no-frames", "--no-recording"]);
    assert_code(&output, 0);
    let out = folder.path().join("out/single-wire");
    let ruptures = rows(&out.join("ruptures.csv"));
    assert!(!ruptures.is_empty(), "the wire must snap:\n{}", stdout(&output));
    let summary = summary(&out);
    let first = &summary["first_rupture"];
    assert_eq!(first["wire"], 1);
    let z: f64 = ruptures[0]["z_mm"].parse().unwrap();
    assert!((first["z_mm"].as_f64().unwrap() - z).abs() < 1e-6 * z.abs());
    assert_eq!(rows(&out.join("wires.csv"))[0]["broken"], "yes");
    assert!(stdout(&output).contains("wire 1,"), "{}", stdout(&output));
    let peak =
        rows(&out.join("curve.csv")).iter().map(|row| row["stress_mpa"].parse::<f64>().unwrap()).fold(0.0, f64::max);
    let strength = summary["tensile_strength_mpa"].as_f64().unwrap();
    assert!(strength >= peak && strength < 1.001 * peak, "seen at every step, not at rows: {strength} {peak}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_results() {
    use rustix::process::{Pid, Signal, kill_process};
    use std::time::{Duration, Instant};
    let folder = tempfile::tempdir().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_strandsnap"))
        .args(["run", "ka4", "--quiet", "--no-frames", "--no-recording", "--out", "out"])
        .current_dir(folder.path())
        .spawn()
        .unwrap();
    let growing = folder.path().join("out/curve.csv.partial");
    let begin = Instant::now();
    let has_rows = || fs::read_to_string(&growing).is_ok_and(|text| text.lines().count() > 2);
    while !has_rows() && child.try_wait().unwrap().is_none() && begin.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(50));
    }
    assert!(has_rows(), "the run must get as far as a few rows");
    // Twice, as keys are pressed: the second must not cost the summary that the first promises.
    for _ in 0..2 {
        kill_process(Pid::from_child(&child), Signal::INT).unwrap();
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let out = folder.path().join("out");
    assert!(rows(&out.join("curve.csv")).len() >= 2);
    assert_eq!(summary(&out)["stopped_because"], "interrupted");
}

#[test]
fn a_run_away_stops_with_its_results_kept() {
    let folder = tempfile::tempdir().unwrap();
    // Forty times the stable step.
    let unstable = ["run", "single-wire", "--set", "time.step=4 us", "--no-frames", "--no-recording"];
    let output = strandsnap(folder.path(), &unstable);
    assert_code(&output, 4);
    let message = plain(&stderr(&output));
    assert!(message.contains("stopped at step"), "{message}");
    assert!(message.contains("out/single-wire"), "it says where the results are: {message}");
    let out = folder.path().join("out/single-wire");
    assert!(!rows(&out.join("curve.csv")).is_empty());
    let summary = summary(&out);
    assert_eq!(
        (&summary["stopped"]["kind"], &summary["findings"][0]["failure"]["kind"]),
        (&"failed".into(), &"runaway".into())
    );
    assert!(summary["warnings"][0].as_str().unwrap().contains("stopped at step"), "{}", summary["warnings"]);
    let because = summary["stopped_because"].as_str().unwrap();
    assert!(because.contains("the simulation failed at step") && because.contains(" moved "), "{because}");
}

/// A device that takes nothing, as a full disk does.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_printed_does_not_end_well() {
    for arguments in [&["scene", "show", "ka4"][..], &["scene", "keys"], &["completions", "bash"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_strandsnap")).args(arguments).stdout(full).output().unwrap();
        assert_code(&output, 1);
        assert!(stderr(&output).contains("standard output"), "{}", stderr(&output));
    }
}

#[cfg(unix)]
#[test]
fn a_reader_who_has_gone_is_no_trouble() {
    let program = env!("CARGO_BIN_EXE_strandsnap");
    let script = format!("'{program}' scene show ka4 | true; exit ${{PIPESTATUS[0]}}");
    let output = Command::new("bash").args(["-c", &script]).output().expect("bash starts");
    assert_code(&output, 0);
    assert!(!stderr(&output).contains("panicked"), "{}", stderr(&output));
}

/// Whether frames can be drawn here; else says which test did not run.
fn has_adapter(test: &str) -> bool {
    #[cfg(feature = "render")]
    let there = strandsnap::render::check().is_ok();
    #[cfg(not(feature = "render"))]
    let there = false;
    if !there {
        let _ = writeln!(std::io::stderr(), "SKIPPED (no frames: no graphics adapter, or built without them): {test}");
    }
    there
}

fn pictures(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    entries.filter(|e| e.as_ref().unwrap().path().extension().is_some_and(|x| x == "png")).count()
}

#[test]
fn frames_are_drawn_and_drawn_again() {
    if !has_adapter("frames_are_drawn_and_drawn_again") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let small = ["--set", "output.frame_size=[320, 240]", "--no-recording"];
    assert_code(&short_run(folder.path(), &small), 0);
    let out = folder.path().join("out/single-wire");
    // Four planned snapshots and the first state.
    assert_eq!(pictures(&out.join("frames")), 5);
    let again = ["render", "out/single-wire", "--size", "200x150", "--every", "2", "--colour", "plastic-strain"];
    let output = strandsnap(folder.path(), &again);
    assert_code(&output, 0);
    assert_eq!(pictures(&out.join("render")), 3);
    assert_code(&strandsnap(folder.path(), &again), 2);
    assert_code(&strandsnap(folder.path(), &[&again[..], &["--overwrite"]].concat()), 0);
    let nothing = ["render", "out/single-wire", "--size", "200x150", "--strain-range", "90..95", "--out", "none"];
    assert_code(&strandsnap(folder.path(), &nothing), 2);
    assert!(!folder.path().join("none").exists(), "nothing may be written");
}

#[test]
fn words_for_frames_are_checked_before_anything_else() {
    let folder = tempfile::tempdir().unwrap();
    for (command, option, word, right) in [
        ("render", "--views", "overview,midsecton", "midsection"),
        ("run", "--views", "sideways", "cross-section"),
        ("run", "--theme", "lihgt", "light"),
        ("render", "--colour", "strain", "plastic-strain"),
    ] {
        let output = strandsnap(folder.path(), &[command, "single-wire", option, word]);
        assert_code(&output, 2);
        assert!(stderr(&output).contains(right), "{}", stderr(&output));
    }
    assert_code(&strandsnap(folder.path(), &["run", "ka4", "--animation-width", "640"]), 2);
    assert_code(&strandsnap(folder.path(), &["run", "ka4", "--no-frames", "--animation"]), 2);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing may be written");
}

#[test]
fn the_look_of_the_frames_is_kept_with_the_results() {
    let folder = tempfile::tempdir().unwrap();
    let look = ["--views", "curve,unrolled", "--theme", "light", "--size", "640x360", "--focus-z", "12"];
    assert_code(&short_run(folder.path(), &[&LEAN[..], &look].concat()), 0);
    let scene = fs::read_to_string(folder.path().join("out/single-wire/scene.toml")).unwrap();
    let scene: toml::Table = toml::from_str(&scene).unwrap();
    let output = &scene["output"];
    assert_eq!(output["views"].as_array().unwrap().len(), 2);
    assert_eq!((output["theme"].as_str(), output["camera"]["focus_z"].as_str()), (Some("light"), Some("12 mm")));
}

#[test]
fn an_animation_that_cannot_be_written_is_refused_before_the_simulation() {
    if !has_adapter("an_animation_that_cannot_be_written_is_refused_before_the_simulation") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("taken.gif"), "precious").unwrap();
    for (file, word) in [("a.mov", ".gif"), ("taken.gif", "--overwrite")] {
        let output = short_run(folder.path(), &["--no-recording", "--animation", file]);
        assert_code(&output, 2);
        assert!(plain(&stderr(&output)).contains(word), "{}", stderr(&output));
    }
    assert!(!folder.path().join("out").exists(), "nothing may be written");
    assert_eq!(fs::read_to_string(folder.path().join("taken.gif")).unwrap(), "precious");
}

#[test]
fn an_animation_is_made_by_run_and_by_render() {
    if !has_adapter("an_animation_is_made_by_run_and_by_render") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let small = ["--size", "320x240", "--no-recording", "--animation", "--animation-width", "160"];
    assert_code(&short_run(folder.path(), &small), 0);
    let out = folder.path().join("out/single-wire");
    let frames = &summary(&out)["frames"];
    assert_eq!(frames["count"], 5);
    for key in ["draw_ms", "read_back_ms", "charts_and_text_ms", "png_ms", "simulation_waited_s", "animation_s"] {
        assert!(frames[key].is_f64(), "{key} is {}", frames[key]);
    }
    let header = fs::read(out.join("frames.gif")).unwrap();
    // Logical screen of a GIF: width and height, little endian, after the six letters of its version.
    assert_eq!(header[..10], [b'G', b'I', b'F', b'8', b'9', b'a', 160, 0, 120, 0]);
    assert_eq!(frames["animation_bytes"], header.len());
    let again = ["render", "out/single-wire", "--events", "--animation", "film.png", "--quiet"];
    assert_code(&strandsnap(folder.path(), &again), 0);
    assert_eq!(pictures(&out.join("render")), 2, "nothing broke: the first and the last");
    // As large as the run's own frames.
    let picture = fs::read(out.join("render/frame_0000.png")).unwrap();
    assert_eq!(picture[16..24], [0, 0, 1, 64, 0, 0, 0, 240]);
    assert!(fs::read(folder.path().join("film.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn the_recording_passes_the_check_of_reruns_own_tool() {
    let test = "the_recording_passes_the_check_of_reruns_own_tool";
    let Some(tool) = std::env::var_os("RERUN_CLI").filter(|_| cfg!(feature = "record")) else {
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED (RERUN_CLI does not name Rerun's tool, or built without recordings): {test}"
        );
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    assert_code(&short_run(folder.path(), &["--no-frames"]), 0);
    let file = folder.path().join("out/single-wire/recording.rrd");
    let check = Command::new(tool).args(["rrd", "verify"]).arg(&file).output().expect("Rerun's tool starts");
    assert!(check.status.success(), "{}{}", stdout(&check), stderr(&check));
}

/// Whether `whole` is `number` rounded; a table's last digit may have moved a number over the middle.
#[cfg(feature = "record")]
fn is_nearest(whole: i64, number: f64) -> bool {
    (whole as f64 - number).abs() <= 0.51
}

/// A single wire that is pulled until it breaks: the recording holds what the tables say.
#[cfg(feature = "record")]
#[test]
fn the_recording_agrees_with_the_tables() {
    use strandsnap::observe::recording::read::contents;
    let folder = tempfile::tempdir().unwrap();
    assert_code(&strandsnap(folder.path(), &["run", "single-wire", "--no-frames", "--quiet"]), 0);
    let out = folder.path().join("out/single-wire");
    let read = contents(&out.join("recording.rrd")).unwrap();
    let value = |row: &std::collections::HashMap<String, String>, key: &str| row[key].parse::<f64>().unwrap();
    let curve = rows(&out.join("curve.csv"));
    assert_eq!(read.nominal_stress.len(), curve.len());
    for ((microstrain, stress), row) in read.nominal_stress.iter().zip(&curve) {
        assert!(is_nearest(*microstrain, value(row, "strain_percent") * 1e4), "{microstrain} is not {row:?}");
        assert!((stress - value(row, "stress_mpa")).abs() <= 1e-7 * stress.abs().max(1.0), "{stress} is not {row:?}");
    }
    let ruptures = rows(&out.join("ruptures.csv"));
    assert!(!ruptures.is_empty() && read.log.len() == ruptures.len());
    for ((microstrain, line), row) in read.log.iter().zip(&ruptures) {
        assert!(is_nearest(*microstrain, value(row, "strain_percent") * 1e4), "{microstrain} is not {row:?}");
        let words = [format!("{}. wire {}", row["order"], row["wire"]), format!("z = {:.1} mm", value(row, "z_mm"))];
        assert!(words.iter().all(|words| line.contains(words)), "{line} is not {row:?}");
    }
    let first = &ruptures[0];
    let words = format!("z = {:.1} mm, strain {:.2} %", value(first, "rest_z_mm"), value(first, "strain_percent"));
    assert!(read.headline.contains(&words), "{words} in {}", read.headline);

    let again = strandsnap(folder.path(), &["record", "out/single-wire"]);
    assert_code(&again, 2);
    assert!(plain(&stderr(&again)).contains("--overwrite"), "{}", stderr(&again));
    assert_code(&strandsnap(folder.path(), &["record", "out/single-wire", "--out", "again.rrd"]), 0);
    assert_eq!(contents(&folder.path().join("again.rrd")).unwrap(), read, "recorded again, but not the same");
}

#[test]
fn viewing_says_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let view = || {
        Command::new(env!("CARGO_BIN_EXE_strandsnap"))
            .args(["view", "."])
            .env("RERUN_CLI", "/nowhere/rerun")
            .current_dir(folder.path())
            .output()
            .expect("the program starts")
    };
    let built = cfg!(feature = "record");
    let nothing = view();
    assert_code(&nothing, if built { 2 } else { 3 });
    fs::write(folder.path().join("recording.rrd"), "").unwrap();
    let no_viewer = view();
    assert_code(&no_viewer, 3);
    if built {
        assert!(plain(&stderr(&nothing)).contains("no recording at ./recording.rrd"), "{}", stderr(&nothing));
        assert!(plain(&stderr(&no_viewer)).contains("pip install rerun-sdk==0.36.3"), "{}", stderr(&no_viewer));
    }
}

fn summary(out: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap()
}
