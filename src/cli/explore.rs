//! `strandsnap explore`.

use super::ended::Ended;
use crate::base::error::Result;
use std::net::IpAddr;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as out/ka4; one that was stopped will do
    run: PathBuf,
    /// A second run, side by side with the first one: the same camera, strain and colours
    #[arg(long, value_name = "RUN")]
    with: Option<PathBuf>,
    /// Address to listen at; any but a loopback one lets others in who know the token
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    bind: IpAddr,
    /// Port to listen at [default: a free one]
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Open no browser
    #[arg(long)]
    no_open: bool,
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

    let command = format!("strandsnap render {}", quoted(&args.run.to_string_lossy()));
    let options = Options { bind: args.bind, port: args.port, keep: args.keep, with: args.with, command };
    if !args.bind.is_loopback() {
        eprintln!(
            "WARNING: {} can be reached from other machines, and what is sent is not encrypted: whoever reads the address \
             on its way can look at the run. `ssh -L` to a loopback address is safer.",
            args.bind
        );
    }
    let server = Server::open(&args.run, options)?;
    for note in server.notes() {
        eprintln!("note: {note}");
    }
    let stop = super::interrupt::install_saying("\nclosing")?;
    let address = server.address();
    say!("Open {address} in a browser; Ctrl-C ends it. Drawn by {}.", server.adapter());
    if !args.no_open && has_display() {
        open(&address);
    }
    // To end it by Ctrl-C is the way it is meant to be ended.
    server.serve(stop).map(|()| Ended::Well)
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
