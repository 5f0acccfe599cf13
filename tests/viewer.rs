//! The recording in Rerun's own tools, at the version of the crate: `RERUN_CLI` names the program of the Python package
//! `rerun-sdk`. Without it these tests say that they were skipped.
#![cfg(all(feature = "record", unix))]

mod synthetic;

use rustix::process::{Pid, Signal, kill_process};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use strandsnap::observe::Observer;
use strandsnap::observe::recording::{RERUN_VERSION, Recording, RecordingOptions};
use synthetic::Run;

/// Longest wait for a program to start or to end.
const PATIENCE: Duration = Duration::from_secs(180);

/// Rerun's tool; `None`, said aloud, when it is not there.
fn tool(test: &str) -> Option<PathBuf> {
    let tool = std::env::var_os("RERUN_CLI").filter(|tool| !tool.is_empty());
    if tool.is_none() {
        skipped(test, "RERUN_CLI does not name Rerun's tool");
    }
    tool.map(PathBuf::from)
}

/// Past the test harness, which hides what passing tests print.
fn skipped(test: &str, why: &str) {
    let _ = writeln!(std::io::stderr(), "SKIPPED ({why}): {test}");
}

fn options(live: Option<String>) -> RecordingOptions {
    RecordingOptions { live, scene: strandsnap::scene::load("ka4", &[]).unwrap().spec }
}

fn recorded(run: &Run, file: &Path) {
    run.show(&mut Recording::new(file, options(None)).unwrap()).unwrap();
}

fn output(tool: &Path, arguments: &[&str]) -> Output {
    Command::new(tool).args(arguments).output().expect("Rerun's tool starts")
}

fn text(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat()
}

/// A program that is ended with the test. It has a group of its own: Rerun's program is a script that starts another.
struct Running(Child);

impl Running {
    fn start(command: &mut Command) -> Self {
        Self(std::os::unix::process::CommandExt::process_group(command, 0).spawn().expect("the program starts"))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let group = Pid::from_raw(self.0.id() as i32).unwrap();
        let _ = rustix::process::kill_process_group(group, Signal::KILL);
        let _ = self.0.wait();
    }
}

fn wait_until(what: &str, mut done: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !done() {
        assert!(begin.elapsed() < PATIENCE, "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(100));
    }
}

fn free_port() -> u16 {
    TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port()
}

fn listens(port: u16) -> bool {
    TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_ok()
}

#[test]
fn the_tool_verifies_counts_and_compares() {
    let Some(tool) = tool("the_tool_verifies_counts_and_compares") else { return };
    let folder = tempfile::tempdir().unwrap();
    let [a, b, c] = ["a.rrd", "b.rrd", "c.rrd"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    let run = Run::new(30);
    recorded(&run, Path::new(&a));
    recorded(&run, Path::new(&b));
    recorded(&Run::new(29), Path::new(&c));
    let verified = output(&tool, &["rrd", "verify", &a]);
    assert!(verified.status.success(), "{}", text(&verified));
    let stats = output(&tool, &["rrd", "stats", &a]);
    assert!(stats.status.success(), "{}", text(&stats));
    println!("{}", text(&stats));
    let same = output(&tool, &["rrd", "compare", "--unordered", &a, &b]);
    assert!(same.status.success(), "the same run gave another recording: {}", text(&same));
    assert!(!output(&tool, &["rrd", "compare", "--unordered", &a, &c]).status.success(), "the tool compares nothing");
}

#[test]
fn a_live_stream_has_the_contents_of_the_file() {
    let Some(tool) = tool("a_live_stream_has_the_contents_of_the_file") else { return };
    let folder = tempfile::tempdir().unwrap();
    let [saved, file] = ["saved.rrd", "file.rrd"].map(|name| folder.path().join(name));
    let port = free_port();
    let mut command = Command::new(&tool);
    command.args(["--bind", "127.0.0.1", "--port", &port.to_string(), "--save"]).arg(&saved);
    let _server = Running::start(command.stdout(Stdio::null()).stderr(Stdio::null()));
    wait_until("the server listens", || listens(port));
    // Few snapshots: each goes out by itself.
    let run = Run::new(8);
    let live = options(Some(format!("rerun+http://127.0.0.1:{port}/proxy")));
    let mut recording = Recording::new(&file, live).unwrap();
    run.show_unfinished(&mut recording).unwrap();
    wait_until("something streams while the run goes on", || fs::metadata(&saved).is_ok_and(|m| m.len() > 100_000));
    recording.finish().unwrap();
    let [saved, file] = [&saved, &file].map(|path| path.to_str().unwrap());
    // The server writes what it gets without end or footer, so only the comparison tells when it has all.
    wait_until("the stream has the contents of the file", || {
        output(&tool, &["rrd", "compare", "--unordered", saved, file]).status.success()
    });
}

/// `strandsnap`, with Rerun's tool in the place of an installed viewer.
fn strandsnap(tool: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strandsnap"));
    command.args(arguments).env("RERUN_CLI", tool);
    command
}

#[test]
fn a_browser_is_served_until_ctrl_c() {
    let Some(tool) = tool("a_browser_is_served_until_ctrl_c") else { return };
    let folder = tempfile::tempdir().unwrap();
    recorded(&Run::new(3), &folder.path().join("recording.rrd"));
    let mut command = strandsnap(&tool, &["view", "--web", folder.path().to_str().unwrap()]);
    let mut view = Running::start(command.stdout(Stdio::piped()).stderr(Stdio::null()));
    let mut line = String::new();
    BufReader::new(view.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let ports: Vec<u16> = line
        .split("127.0.0.1")
        .filter_map(|part| {
            let digits = part.trim_start_matches(':').trim_start_matches("%3A");
            digits.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
        })
        .collect();
    let [pages, data] = ports[..] else { panic!("no address in {line}") };
    wait_until("pages and data are served", || listens(pages) && listens(data));
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, pages)).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    stream.write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n").unwrap();
    let mut page = vec![0; 2000];
    let length = stream.read(&mut page).unwrap();
    let page = String::from_utf8_lossy(&page[..length]);
    assert!(page.starts_with("HTTP/1.1 200"), "{page}");
    kill_process(Pid::from_raw(view.0.id() as i32).unwrap(), Signal::INT).unwrap();
    assert!(view.0.wait().unwrap().success());
    wait_until("the viewer ends as well", || !listens(pages) && !listens(data));
}

#[test]
fn the_installed_viewer_has_the_version_of_the_recording() {
    let Some(tool) = tool("the_installed_viewer_has_the_version_of_the_recording") else { return };
    let viewer = strandsnap::run::view::Viewer::at(tool).unwrap();
    assert_eq!((viewer.version.as_str(), viewer.mismatch()), (RERUN_VERSION, None));
}

/// Opens the recording in the real viewer and keeps the picture in target/, for people to look at.
#[test]
fn the_viewer_shows_the_recording() {
    let test = "the_viewer_shows_the_recording";
    let Some(tool) = tool(test) else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("recording.rrd");
    recorded(&Run::new(30), &file);
    let picture = Path::new(env!("CARGO_TARGET_TMPDIR")).join("viewer.png");
    let _ = fs::remove_file(&picture);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/viewer_screenshot.sh");
    let mut command = Command::new("sh");
    command.arg(script).args([&file, &picture]).arg("1280x720");
    let shot = command.env("RERUN_CLI", &tool).env("PORT", free_port().to_string()).output().expect("sh starts");
    if shot.status.code() == Some(3) {
        skipped(test, text(&shot).trim());
        return;
    }
    assert!(shot.status.success(), "{}", text(&shot));
    // An empty window of this size is a tenth of that.
    let size = fs::metadata(&picture).unwrap().len();
    assert!(size > 100_000, "{} is only {size} bytes", picture.display());
    println!("{}", picture.display());
}
