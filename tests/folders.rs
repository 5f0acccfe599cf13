//! Folders that cannot lie: whatever is in one is whole and its own run's, or says so; nothing but results is replaced.

#[path = "common/disk.rs"]
mod disk;

use disk::Disk;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_strandsnap");
/// A run of an instant.
const SHORT: [&str; 8] =
    ["run", "single-wire", "--set", "stop.steps=400", "--no-frames", "--no-recording", "--quiet", "--out"];

fn strandsnap(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(PROGRAM).args(arguments).current_dir(folder).output().expect("the program starts")
}

fn text(output: &Output) -> String {
    // Long messages are wrapped.
    let all = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    all.replace(['│', '\n'], " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

fn assert_refused(output: &Output, words: &[&str]) {
    let text = text(output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    words.iter().for_each(|word| assert!(text.contains(word), "no {word} in: {text}"));
}

fn short(folder: &Path, out: &str, others: &[&str]) -> Output {
    let output = strandsnap(folder, &[&SHORT[..], &[out], others].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    output
}

/// A run that goes on until it is ended.
fn long(folder: &Path) -> Child {
    let arguments = ["run", "ka4", "--quiet", "--no-frames", "--no-recording", "--threads", "1", "--out", "out"];
    let child = Command::new(PROGRAM).args(arguments).current_dir(folder).stderr(Stdio::null()).spawn().unwrap();
    let begin = Instant::now();
    let has_rows = || fs::read(folder.join("out/trajectory.bin.partial")).is_ok_and(|bytes| !bytes.is_empty());
    while !has_rows() {
        assert!(begin.elapsed() < Duration::from_secs(120), "the run does not begin");
        std::thread::sleep(Duration::from_millis(50));
    }
    child
}

fn edit(file: PathBuf, from: &str, to: &str) {
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.contains(from), "{text}");
    fs::write(file, text.replacen(from, to, 1)).unwrap();
}

#[test]
fn two_runs_into_one_folder() {
    let folder = tempfile::tempdir().unwrap();
    let mut first = long(folder.path());
    let number = format!("process {} ", first.id());
    let second = strandsnap(folder.path(), &[&SHORT[..], &["out", "--overwrite"]].concat());
    assert_refused(&second, &[&number, "--wait"]);
    assert!(folder.path().join("out/curve.csv.partial").exists(), "the first goes on");
    // What the first leaves would be refused after the wait, so it is before.
    let in_vain = strandsnap(folder.path(), &[&SHORT[..], &["out", "--wait"]].concat());
    assert_refused(&in_vain, &[&number, "its results will be there", "--overwrite with --wait"]);
    let waiting = Command::new(PROGRAM)
        .args([&SHORT[..], &["out", "--overwrite", "--wait"]].concat())
        .current_dir(folder.path())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(500));
    // A lock of the dead is none.
    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(waiting.wait_with_output().unwrap().status.code(), Some(0));
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("out/summary.json")).unwrap()).unwrap();
    assert_eq!(summary["scene"], "single-wire");
    assert!(!folder.path().join("out/.strandsnap.lock").exists());
}

#[test]
fn two_studies_into_one_folder() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("study")).unwrap();
    let lock = strandsnap::run::lock::Lock::take(&folder.path().join("study")).unwrap();
    let number = format!("process {} ", std::process::id());
    for study in [&["study", "seeds"][..], &["study", "seeds", "--case", "1"], &["calibrate", "single-wire"]] {
        assert_refused(&strandsnap(folder.path(), &[study, &["--out", "study"]].concat()), &[&number]);
    }
    drop(lock);
}

/// A folder with a finished run, `a`, and one of another seed, `b`.
fn two_runs() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    short(folder.path(), "a", &[]);
    short(folder.path(), "b", &["--seed", "7"]);
    folder
}

#[test]
fn a_file_of_another_run_is_refused_and_passed_over_with_a_mark() {
    let folder = two_runs();
    let at = |name: &str| folder.path().join(name);
    let report = |more: &[&str]| strandsnap(folder.path(), &[&["report", "a", "--overwrite"], more].concat());
    assert_eq!(report(&[]).status.code(), Some(0), "{}", text(&report(&[])));
    assert!(!fs::read_to_string(at("a/report.html")).unwrap().contains("doubtful"));
    for name in ["trajectory.bin", "summary.json", "scene.toml"] {
        let own = fs::read(at(&format!("a/{name}"))).unwrap();
        fs::copy(at(&format!("b/{name}")), at(&format!("a/{name}"))).unwrap();
        assert_refused(&report(&[]), &["is not of the run of trajectory.bin", "--anyway"]);
        fs::write(at(&format!("a/{name}")), own).unwrap();
    }
    assert_eq!(report(&[]).status.code(), Some(0));
    edit(at("a/scene.toml"), "115 GPa", "116 GPa");
    assert_refused(&report(&[]), &["scene.toml"]);
    assert_eq!(report(&["--anyway"]).status.code(), Some(0));
    assert!(fs::read_to_string(at("a/report.html")).unwrap().contains("doubtful files: scene.toml"));
    let checked = strandsnap(folder.path(), &["check-run", "a"]);
    assert_eq!(checked.status.code(), Some(4));
    assert!(text(&checked).contains("own-files"), "{}", text(&checked));
}

#[test]
fn an_edited_summary_is_refused() {
    let folder = two_runs();
    assert_eq!(strandsnap(folder.path(), &["check-run", "a"]).status.code(), Some(0));
    edit(folder.path().join("a/summary.json"), "\"wall_s\": ", "\"wall_s\": 1");
    assert_refused(&strandsnap(folder.path(), &["report", "a"]), &["summary.json was changed since"]);
}

#[test]
fn a_run_does_not_replace_its_own_scene() {
    let folder = two_runs();
    let before = fs::read(folder.path().join("a/scene.toml")).unwrap();
    let again = ["run", "a/scene.toml", "--overwrite", "--no-frames", "--no-recording", "--quiet", "--out", "a"];
    assert_refused(&strandsnap(folder.path(), &again), &["would be replaced", "--out"]);
    assert_eq!(fs::read(folder.path().join("a/scene.toml")).unwrap(), before);
    assert!(folder.path().join("a/summary.json").exists());
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_neither_read_nor_replaced() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let folder = two_runs();
    let at = |name: &str| folder.path().join(name);
    let call = |arguments: &[&str]| strandsnap(folder.path(), arguments);
    for name in ["pipe", "pipe.toml", "a/summary.pipe"] {
        assert!(Command::new("mkfifo").arg(at(name)).status().unwrap().success());
    }
    // Read: at once refused, where a pipe waits for ever and a device never ends.
    for (scene, kind) in [("./pipe", "a pipe"), ("pipe.toml", "a pipe"), ("/dev/zero", "a device"), ("./a", "a folder")]
    {
        assert_refused(&call(&["scene", "check", scene]), &[kind]);
    }
    assert_refused(&call(&["study", "./pipe"]), &["a pipe"]);
    let wire = "wire=[{ file = \"pipe\", diameter = \"1 mm\" }]";
    fs::write(at("s.toml"), "about = \"A wire of a pipe.\"\n[stop]\ntime = \"1 ms\"\n").unwrap();
    assert_refused(&call(&["scene", "check", "s.toml", "--set", wire]), &["a pipe"]);
    // Written.
    symlink(at("b/curve.csv"), at("link.txt")).unwrap();
    let curve = fs::read(at("b/curve.csv")).unwrap();
    for (file, kind) in [("pipe", "a pipe"), ("link.txt", "a link"), ("a", "a folder"), ("/dev/full", "a device")] {
        assert_refused(&call(&["scene", "centrelines", "single-wire", file, "--overwrite"]), &[kind]);
        assert_refused(&call(&["report", "b", "--overwrite", "--out", file]), &[kind]);
    }
    assert!(fs::symlink_metadata("/dev/full").unwrap().file_type().is_char_device());
    assert_eq!(fs::read(at("b/curve.csv")).unwrap(), curve);
    fs::remove_file(at("a/curve.csv")).unwrap();
    symlink(at("b/curve.csv"), at("a/curve.csv")).unwrap();
    assert_refused(&call(&[&SHORT[..], &["a", "--overwrite"]].concat()), &["curve.csv is a link"]);
    assert!(at("a/summary.json").exists(), "nothing was removed");
}

/// What a run that could not write leaves: an error that names a file, and nothing that looks whole but is not.
fn assert_nothing_looks_whole(output: &Output, out: &Path, size: usize) {
    let told = text(output);
    assert_eq!(output.status.code(), Some(1), "{size}: {told}");
    assert!(told.contains("cannot") && told.contains("out") && !told.contains("panicked"), "{size}: {told}");
    // As the system tells it, of the file that is missing.
    assert!(told.contains("No space left") || told.contains("File too large"), "{size}: {told}");
    assert!(!told.contains("buffer") && !told.contains("at path") && !told.contains(".strandsnap-"), "{size}: {told}");
    let whole = |name: &str| out.join(name).exists();
    assert!(!whole("summary.json") || !whole("trajectory.bin"), "{size}: a whole run: {told}");
    for (name, end) in [("curve.csv", "\n"), ("wires.csv", "\n"), ("ruptures.csv", "\n"), ("scene.toml", "\n")] {
        if whole(name) {
            assert!(fs::read_to_string(out.join(name)).unwrap().ends_with(end), "{size}: {name} is cut off");
        }
    }
}

/// Sizes at which something different is cut off: a folder, each file, its last byte.
fn sizes(whole: usize) -> Vec<usize> {
    (0..12).map(|k| 1024 + (whole - 1024) * k / 12).collect()
}

fn bytes_in(folder: &Path) -> Vec<usize> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().metadata().unwrap().len() as usize).collect()
}

/// No file may become longer than a limit: every write past it fails, as on a full disk.
#[cfg(target_os = "linux")]
#[test]
fn files_that_cannot_grow() {
    let folder = two_runs();
    let longest = bytes_in(&folder.path().join("a")).into_iter().max().unwrap();
    for (k, size) in sizes(longest).into_iter().enumerate() {
        let out = format!("out{k}");
        let run = [&SHORT[..], &[out.as_str(), "--set", "output.checkpoint=50"]].concat();
        // Blocks of 1024 bytes; the signal would end the program before it can say anything.
        let script = format!("trap '' XFSZ; ulimit -f {}; exec \"$0\" \"$@\"", size / 1024);
        let mut command = Command::new("bash");
        let output = command.args(["-c", &script, PROGRAM]).args(run).current_dir(folder.path()).output().unwrap();
        assert_nothing_looks_whole(&output, &folder.path().join(out), size);
    }
}

/// A disk that is full at any byte, where a file system may be mounted.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_is_full() {
    let folder = two_runs();
    let whole: usize = bytes_in(&folder.path().join("a")).iter().sum();
    for (k, size) in sizes(whole).into_iter().enumerate() {
        let place = folder.path().join(format!("disk{k}"));
        fs::create_dir(&place).unwrap();
        let Some(disk) = Disk::mount(&place, size, "a_disk_that_is_full") else { return };
        let output = strandsnap(&place, &[&SHORT[..], &["out", "--set", "output.checkpoint=50"]].concat());
        assert_nothing_looks_whole(&output, &place.join("out"), size);
        drop(disk);
    }
}

/// A device that takes nothing, as a full disk behind a redirection does.
#[cfg(target_os = "linux")]
#[test]
fn a_lost_standard_error_is_an_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    // Friction where nothing touches changes nothing, which is told.
    let scene = "about = 'one'\n[contact]\nnormal = 'none'\nfriction = 0.3\n[[sphere]]\ndiameter = '1 mm'\n\
                 position = ['0 mm', '0 mm', '0 mm']\n[stop]\nsteps = 5\n";
    fs::write(folder.path().join("two.toml"), scene).unwrap();
    let warns = ["run", "two.toml", "--no-frames", "--no-recording", "--out", "out"];
    assert!(text(&strandsnap(folder.path(), &warns)).contains("WARNING"));
    let warns = ["run", "two.toml", "--no-frames", "--no-recording", "--out", "lost"];
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = Command::new(PROGRAM).args(warns).current_dir(folder.path()).stderr(full).output().unwrap();
    // 101 is that of a panic.
    assert_eq!(output.status.code(), Some(1));
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = Command::new(PROGRAM).args(["scene", "check", "no"]).stderr(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "the error's own code");
}

#[test]
fn a_file_where_a_folder_should_be_is_bad_input() {
    let folder = two_runs();
    fs::write(folder.path().join("file"), "mine").unwrap();
    let commands: [&[&str]; 8] = [
        &["run", "single-wire"],
        &["study", "seeds"],
        &["calibrate", "single-wire"],
        &["accuracy", "single-wire"],
        &["accuracy", "verify/hertz"],
        &["verify", "hertz"],
        &["stability", "friction-0-sphere"],
        &["export", "a", "--format", "xyz"],
    ];
    for command in commands {
        for out in ["file", "file/below"] {
            let output = strandsnap(folder.path(), &[command, &["--out", out][..]].concat());
            assert_refused(&output, &["file is not a folder"]);
        }
    }
    assert_refused(&strandsnap(folder.path(), &["man", "file/below"]), &["file is not a folder"]);
    assert_refused(&strandsnap(folder.path(), &["report", "a", "--out", "file/a.html"]), &["file is not a folder"]);
    let json = ["verify", "hertz", "--no-plots", "--json", "file/found.json"];
    assert_refused(&strandsnap(folder.path(), &json), &["file is not a folder"]);
    assert_eq!(fs::read_to_string(folder.path().join("file")).unwrap(), "mine");
}

#[test]
fn sizes_beyond_memory_are_refused_at_their_key() {
    let folder = tempfile::tempdir().unwrap();
    let check = |scene: &str, more: &[&str]| strandsnap(folder.path(), &[&["scene", "check", scene], more].concat());
    assert_refused(&check("ka4", &["--set", "strand.length=90 km"]), &["`strand.length`", "particles", "--memory"]);
    assert_refused(&check("ka4", &["--set", "spacing=1e-9"]), &["`spacing`"]);
    assert_refused(&check("ka4", &["--memory", "10MB"]), &["of 10 MB"]);
    let long = "wire.0.to=[\"0 mm\", \"0 mm\", \"1e18 mm\"]";
    assert_refused(&check("single-wire", &["--set", long]), &["at most 100 km"]);
    for (command, more) in [(&["run"][..], &[][..]), (&["plan"], &[]), (&["scene", "centrelines"], &["points.txt"])] {
        let huge = ["ka4", "--set", "strand.length=9 km", "--memory", "4GB"];
        assert_refused(&strandsnap(folder.path(), &[command, &huge, more].concat()), &["`strand.length`"]);
    }
}

#[test]
fn numbers_of_the_command_line_have_ranges() {
    let folder = tempfile::tempdir().unwrap();
    for (option, value) in [
        ("--azimuth", "nan"),
        ("--elevation", "1e30"),
        ("--zoom", "1e30"),
        ("--focus-z", "inf"),
        ("--size", "16384x16384"),
        ("--size", "16x16"),
        ("--memory", "nanGB"),
        ("--memory", "1B"),
        ("--memory", "1e300GB"),
    ] {
        let output = strandsnap(folder.path(), &["run", "single-wire", option, value]);
        assert_refused(&output, &[option]);
        assert!(!text(&output).contains("unexpected argument"), "{}", text(&output));
    }
    for option in ["--strength", "--elongation", "--tolerance"] {
        assert_refused(&strandsnap(folder.path(), &["calibrate", "single-wire", option, "nan"]), &[option]);
    }
    // What a size writes into the scene can be read again.
    short(folder.path(), "out", &["--size", "120x8192", "--zoom", "1000", "--focus-z", "-12.5"]);
    let again = strandsnap(folder.path(), &["scene", "check", "out/scene.toml"]);
    assert_eq!(again.status.code(), Some(0), "{}", text(&again));
}
