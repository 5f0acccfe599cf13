//! `strandsnap explore`.

use super::ended::Ended;
use crate::base::error::Result;
use crate::observe::Observer;
use crate::run::RunSummary;
use crate::scene::spec::Spec;
use std::net::IpAddr;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
#[cfg(feature = "explore")]
use std::sync::atomic::Ordering;

/// Where a page is shown.
#[derive(Debug, clap::Args)]
pub struct AddressArgs {
    /// Address to listen at; any but a loopback one lets others in who know the token
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    bind: IpAddr,
    /// Port to listen at [default: a free one]
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Open no browser
    #[arg(long)]
    no_open: bool,
}

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run or of a case of a study, such as out/ka4; one that was stopped will do
    run: PathBuf,
    /// A second run, side by side with the first one: the same camera, strain and colours
    #[arg(long, value_name = "RUN")]
    with: Option<PathBuf>,
    #[command(flatten)]
    address: AddressArgs,
    /// Stay when the last page has been closed; otherwise it ends five minutes later
    #[arg(long)]
    keep: bool,
}

#[cfg(not(feature = "explore"))]
pub fn explore(_args: Args) -> Result<Ended> {
    Err(crate::run::outputs::built_without("the interactive picture", "explore", "open the recording with `rerun`"))
}

#[cfg(feature = "explore")]
pub fn explore(args: Args) -> Result<Ended> {
    use super::say::say;
    use crate::explore::{Options, Server};

    check_run(&args.run)?;
    let mut options = args.address.options(&args.run);
    if let Some(with) = &args.with {
        options.command += &format!(" --with {}", quoted(&with.to_string_lossy()));
    }
    options = Options { keep: args.keep, with: args.with, ..options };
    let server = Server::open(&args.run, options)?;
    for note in server.notes() {
        eprintln!("note: {note}");
    }
    let stop = super::interrupt::install_saying("\nclosing")?;
    let address = server.address();
    say!("Open {address} in a browser; Ctrl-C ends it. Drawn by {}.", server.adapter());
    args.address.open(&address);
    // To end it by Ctrl-C is the way it is meant to be ended.
    server.serve(stop).map(|()| Ended::Well)
}

#[cfg(feature = "explore")]
impl AddressArgs {
    /// How to show the run in a folder; a warning where others can reach it.
    pub fn options(&self, run: &Path) -> crate::explore::Options {
        let command = format!("strandsnap render {}", quoted(&run.to_string_lossy()));
        if !self.bind.is_loopback() {
            eprintln!(
                "WARNING: {} can be reached from other machines, and what is sent is not encrypted: whoever reads the \
                 address on its way can look at the run. `ssh -L` to a loopback address is safer.",
                self.bind
            );
        }
        crate::explore::Options { bind: self.bind, port: self.port, command, ..Default::default() }
    }

    /// Opens the system's browser, unless that is not wanted or there is no display.
    pub fn open(&self, address: &str) {
        if !self.no_open && has_display() {
            open(address);
        }
    }
}

/// Refuses a scene, which has no folder of results yet, with what to do.
#[cfg(feature = "explore")]
fn check_run(run: &Path) -> Result<()> {
    let name = run.to_string_lossy();
    let shipped = !run.exists() && crate::scene::builtin::list().iter().any(|(known, _)| *known == name);
    let file = run.is_file() && run.extension().is_some_and(|ending| ending == "toml");
    if !shipped && !file {
        return Ok(());
    }
    Err(crate::base::error::Error::input(
        format!("{name} is a scene, and explore shows runs"),
        format!(
            "`strandsnap run {name} --explore` shows it while it runs; give the folder of a run, such as out/ka4, for one that is over"
        ),
    ))
}

/// A run that is shown while it goes on, where that was asked for.
pub struct Watched {
    #[cfg(feature = "explore")]
    watcher: Option<crate::explore::live::Watcher>,
}

#[cfg(not(feature = "explore"))]
impl Watched {
    /// Refuses what was not built.
    ///
    /// # Errors
    /// When it is asked for.
    pub fn begin(at: Option<&AddressArgs>, _run: &Path, _spec: &Spec, _stop: &'static AtomicBool) -> Result<Self> {
        let refused =
            crate::run::outputs::built_without("the interactive picture", "explore", "run it without --explore");
        at.map_or(Ok(Self {}), |_| Err(refused))
    }

    /// Nobody.
    pub fn observer(&mut self) -> Option<&mut dyn Observer> {
        None
    }

    /// Nothing is left to show.
    pub fn end(self, _summary: &RunSummary, _stop: &AtomicBool) {}
}

#[cfg(feature = "explore")]
impl Watched {
    /// Listens, says where, and opens a browser.
    ///
    /// # Errors
    /// When there is no graphics adapter, or the address is taken.
    pub fn begin(at: Option<&AddressArgs>, run: &Path, spec: &Spec, stop: &'static AtomicBool) -> Result<Self> {
        use super::say::say;
        let Some(at) = at else { return Ok(Self { watcher: None }) };
        let watcher = crate::explore::live::Watcher::open(at.options(run), run.into(), spec, stop)?;
        say!("Open {} in a browser to look at the run while it goes on.", watcher.address());
        at.open(watcher.address());
        Ok(Self { watcher: Some(watcher) })
    }

    /// What the run is shown to.
    pub fn observer(&mut self) -> Option<&mut dyn Observer> {
        self.watcher.as_mut().map(|watcher| watcher as &mut dyn Observer)
    }

    /// Tells pages how the run ended, and leaves it to them until they are closed; a run that was stopped from here, or by
    /// its time limit, ends at once.
    pub fn end(self, summary: &RunSummary, stop: &AtomicBool) {
        use super::say::say;
        let Some(watcher) = self.watcher else { return };
        watcher.tell_end(&summary.stopped_because);
        if watcher.stopped_by_page() {
            stop.store(false, Ordering::Relaxed);
        }
        if stop.load(Ordering::Relaxed) || !watcher.is_looked_at() {
            return;
        }
        say!("The page goes on until it is closed; Ctrl-C ends it.");
        watcher.stay(stop);
    }
}

/// A path as a shell takes it.
#[cfg(feature = "explore")]
fn quoted(path: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+".contains(c);
    if path.chars().all(plain) { path.to_owned() } else { format!("'{}'", path.replace('\'', r"'\''")) }
}

#[cfg(feature = "explore")]
fn has_display() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(any(windows, target_os = "macos")) || set("DISPLAY") || set("WAYLAND_DISPLAY")
}

/// Opens the system's browser. Where it cannot be started, the printed address is enough.
#[cfg(feature = "explore")]
fn open(address: &str) {
    use std::process::{Command, Stdio};
    let (program, arguments): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("rundll32", &["url.dll,FileProtocolHandler"]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    command.args(arguments).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    if let Ok(mut child) = command.spawn() {
        std::thread::spawn(move || child.wait());
    }
}
