//! Opens the recording of a run in the Rerun viewer that is installed, or serves it to a browser.

use super::folder::RECORDING;
use crate::base::error::{Error, Result};
use crate::observe::partial;
use crate::observe::recording::RERUN_VERSION;
use std::ffi::OsString;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Environment variable that names the viewer's program; otherwise it is `rerun` on the PATH.
pub const VIEWER_VARIABLE: &str = "RERUN_CLI";
/// Where the viewer usually serves its pages, and where it listens for data.
const USUAL_PORTS: [u16; 2] = [9090, 9876];
/// How often to look whether the viewer has been closed.
const POLL: Duration = Duration::from_millis(50);

/// A recording that can be opened.
#[derive(Debug)]
pub struct Found {
    /// The file that the viewer gets.
    pub file: PathBuf,
    /// Whether the run was not finished (or is still going), so that the recording ends early.
    pub unfinished: bool,
    /// Keeps the name that an unfinished file needs to be opened.
    _link: Option<tempfile::TempDir>,
}

/// An installed viewer.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewer {
    program: PathBuf,
    /// Its version.
    pub version: String,
}

/// A viewer that runs.
pub struct Showing {
    child: Child,
    /// Where to point a browser.
    pub address: Option<String>,
}

/// The recording of the run in `run`, its folder or the file itself.
///
/// # Errors
/// [`Error::Input`] when there is none, [`Error::Io`] when an unfinished one cannot be linked to.
pub fn find(run: &Path) -> Result<Found> {
    let file = if run.is_dir() { run.join(RECORDING) } else { run.to_owned() };
    if file.is_file() {
        return Ok(Found { file, unfinished: false, _link: None });
    }
    let growing = partial::name(&file);
    if growing.is_file() {
        return link(&growing).map_err(|e| Error::io("cannot open", &growing, e));
    }
    Err(Error::input(
        format!("there is no recording at {}", file.display()),
        "give the folder of a run, such as out/ka4; one that was made with --no-recording gets its recording with \
         `strandsnap record`",
    ))
}

/// The viewer knows a recording by the end of its name, which an unfinished file does not have.
fn link(growing: &Path) -> std::io::Result<Found> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join(RECORDING);
    let growing = growing.canonicalize()?;
    #[cfg(unix)]
    std::os::unix::fs::symlink(growing, &file)?;
    #[cfg(not(unix))]
    std::fs::copy(growing, &file)?;
    Ok(Found { file, unfinished: true, _link: Some(folder) })
}

/// How to install the viewer that fits.
pub fn how_to_install() -> String {
    format!(
        "install it with `pip install rerun-sdk=={RERUN_VERSION}` (in a virtual environment where the system asks for \
         one), or name its program in {VIEWER_VARIABLE}"
    )
}

impl Viewer {
    /// The viewer that is installed.
    ///
    /// # Errors
    /// [`Error::Missing`] when there is none or it does not say its version.
    pub fn installed() -> Result<Self> {
        let program = std::env::var_os(VIEWER_VARIABLE).filter(|p| !p.is_empty()).unwrap_or_else(|| "rerun".into());
        Self::at(PathBuf::from(program))
    }

    /// The viewer `program`.
    ///
    /// # Errors
    /// As for [`Viewer::installed`].
    pub fn at(program: PathBuf) -> Result<Self> {
        let missing = |what: String| Error::Missing { what, help: Some(how_to_install()) };
        let output = Command::new(&program).arg("--version").output();
        let output = output.map_err(|e| missing(format!("no Rerun viewer: {}: {e}", program.display())))?;
        let text = String::from_utf8_lossy(&output.stdout);
        let Some(version) = version_in(&text) else {
            return Err(missing(format!("{} is not a Rerun viewer: it does not tell its version", program.display())));
        };
        Ok(Self { program, version: version.to_owned() })
    }

    /// What is to be said about a version that is not the recording's.
    pub fn mismatch(&self) -> Option<String> {
        (self.version != RERUN_VERSION).then(|| {
            format!(
                "the viewer is version {}, the recording {RERUN_VERSION}; if views are missing or empty, \
                 `pip install rerun-sdk=={RERUN_VERSION}`",
                self.version
            )
        })
    }

    /// Opens `file` in a window.
    ///
    /// # Errors
    /// [`Error::Missing`] when the program does not start.
    pub fn open(&self, file: &Path) -> Result<Showing> {
        let child = self.start(vec!["--hide-welcome-screen".into(), file.into()])?;
        Ok(Showing { child, address: None })
    }

    /// Serves `file` to browsers of this machine.
    ///
    /// # Errors
    /// [`Error::Missing`] when the program does not start or no port is free.
    pub fn serve(&self, file: &Path) -> Result<Showing> {
        let [pages, data] = free_ports()?;
        let arguments = ["--serve-web", "--bind", "127.0.0.1", "--web-viewer-port"].map(OsString::from);
        let mut arguments = arguments.to_vec();
        arguments.extend([pages.to_string().into(), "--port".into(), data.to_string().into(), file.into()]);
        let child = self.start(arguments)?;
        let source = format!("rerun%2Bhttp%3A%2F%2F127.0.0.1%3A{data}%2Fproxy");
        Ok(Showing { child, address: Some(format!("http://127.0.0.1:{pages}/?url={source}")) })
    }

    fn start(&self, arguments: Vec<OsString>) -> Result<Child> {
        let mut command = Command::new(&self.program);
        command.args(arguments);
        // What pip installs is a script that starts the real program; a group of their own lets both be ended.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command.spawn().map_err(|e| Error::Missing {
            what: format!("cannot start {}: {e}", self.program.display()),
            help: Some(how_to_install()),
        })
    }
}

impl Showing {
    /// Waits until the viewer is closed, or closes it when `stop` is set.
    ///
    /// # Errors
    /// [`Error::Missing`] when the viewer ended by itself with an error.
    pub fn wait(mut self, stop: &AtomicBool) -> Result<()> {
        let lost = |e: std::io::Error| Error::Missing { what: format!("lost the viewer: {e}"), help: None };
        loop {
            if let Some(status) = self.child.try_wait().map_err(lost)? {
                return if status.success() { Ok(()) } else { Err(failed(status)) };
            }
            if stop.load(Ordering::Relaxed) {
                end(&mut self.child);
                return self.child.wait().map(|_| ()).map_err(lost);
            }
            std::thread::sleep(POLL);
        }
    }
}

fn failed(status: std::process::ExitStatus) -> Error {
    Error::Missing {
        what: format!("the viewer ended with {status}; what it said stands above"),
        help: Some("without a display or a graphics driver, `strandsnap view --web` serves a browser".into()),
    }
}

#[cfg(unix)]
fn end(child: &mut Child) {
    use rustix::process::{Pid, Signal, kill_process_group};
    let group = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
    // It may have ended meanwhile.
    let _ = group.map(|group| kill_process_group(group, Signal::TERM));
}

#[cfg(not(unix))]
fn end(child: &mut Child) {
    let _ = child.kill();
}

/// The version in what `rerun --version` prints: `rerun-cli 0.36.3 [rustc …] …`.
fn version_in(text: &str) -> Option<&str> {
    let first = text.lines().next()?;
    let (name, rest) = first.split_once(' ')?;
    let version = rest.split_whitespace().next()?;
    (name.starts_with("rerun") && version.starts_with(|c: char| c.is_ascii_digit())).then_some(version)
}

/// The usual ports, or others where they are taken.
fn free_ports() -> Result<[u16; 2]> {
    let none = |e| Error::Missing { what: format!("no free port to serve at: {e}"), help: None };
    let listen = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    let free = |usual: u16| listen(usual).or_else(|_| listen(0));
    // Both are held until both are known.
    let held = [free(USUAL_PORTS[0]).map_err(none)?, free(USUAL_PORTS[1]).map_err(none)?];
    let [pages, data] = held.map(|listener| listener.local_addr().map(|address| address.port()));
    Ok([pages.map_err(none)?, data.map_err(none)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read() {
        assert_eq!(version_in("rerun-cli 0.36.3 [rustc 1.95.0]\nfeatures"), Some("0.36.3"));
        assert_eq!(version_in("rerun_py 0.29.0-alpha.1 (x)"), Some("0.29.0-alpha.1"));
        for other in ["", "GNU ls 9.1", "rerun", "rerun-cli unknown"] {
            assert_eq!(version_in(other), None, "{other}");
        }
    }

    #[test]
    fn another_version_is_said_to_be_another() {
        let viewer = |version: &str| Viewer { program: "rerun".into(), version: version.into() };
        assert_eq!(viewer(RERUN_VERSION).mismatch(), None);
        assert!(viewer("0.30.0").mismatch().unwrap().contains(&format!("rerun-sdk=={RERUN_VERSION}")));
    }

    #[test]
    fn an_unfinished_recording_is_found_and_said_to_be_unfinished() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(find(folder.path()).unwrap_err().exit_code(), 2);
        std::fs::write(folder.path().join("recording.rrd.partial"), "part").unwrap();
        let found = find(folder.path()).unwrap();
        assert!(found.unfinished && found.file.extension().is_some_and(|e| e == "rrd"));
        assert_eq!(std::fs::read_to_string(&found.file).unwrap(), "part");
        std::fs::write(folder.path().join("recording.rrd"), "whole").unwrap();
        assert!(!find(folder.path()).unwrap().unfinished);
    }
}
