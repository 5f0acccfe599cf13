//! Where the recording goes: a file that keeps its first error, and a running viewer.
//!
//! Rerun's own `FileSink` reports a failed write to a log and goes on silently; a full disk must end the run with
//! an error, so the file is written here through Rerun's encoder.

use crate::base::error::{Error, Result};
use crate::observe::partial;
use rerun::external::{re_build_info, re_log_encoding, re_uri};
use rerun::log::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Address at which a viewer started with `rerun` listens.
pub const DEFAULT_VIEWER: &str = "rerun+http://127.0.0.1:9876/proxy";

/// How long to wait for the viewer's answer (s).
const CONNECT_TIMEOUT: Duration = Duration::from_secs(2);

type Encoder = re_log_encoding::Encoder<BufWriter<File>>;

struct State {
    encoder: Option<Encoder>,
    error: Option<std::io::Error>,
}

/// The file under its working name; it gets its final name when it is whole.
#[derive(Clone)]
pub(super) struct RecordingFile {
    state: Arc<Mutex<State>>,
    partial: PathBuf,
    file: PathBuf,
}

impl RecordingFile {
    /// Creates `<file>.partial`.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be created.
    pub fn create(file: &Path) -> Result<Self> {
        let partial = partial::name(file);
        let created = partial::create(file)?;
        let encoder = Encoder::new_eager(
            re_build_info::CrateVersion::LOCAL,
            re_log_encoding::EncodingOptions::PROTOBUF_COMPRESSED,
            BufWriter::new(created),
        )
        .map_err(|e| Error::io("cannot write", &partial, io_error(e)))?;
        let state = State { encoder: Some(encoder), error: None };
        Ok(Self { state: Arc::new(Mutex::new(state)), partial, file: file.to_owned() })
    }

    /// The first error of the writing thread, if there was one.
    ///
    /// # Errors
    /// [`Error::Io`] with the system's answer.
    pub fn check(&self) -> Result<()> {
        match self.lock().error.take() {
            Some(error) => Err(Error::io("cannot write", &self.partial, error)),
            None => Ok(()),
        }
    }

    /// Ends the file and gives it its final name. Everything must have been sent and flushed before.
    ///
    /// # Errors
    /// [`Error::Io`]; the file then keeps its partial name.
    pub fn complete(&self) -> Result<()> {
        self.check()?;
        if let Some(encoder) = self.lock().encoder.take() {
            end(encoder).map_err(|e| Error::io("cannot write", &self.partial, e))?;
            partial::complete(&self.file)?;
        }
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LogSink for RecordingFile {
    fn send(&self, message: LogMsg) {
        let mut state = self.lock();
        let State { encoder: Some(encoder), error: error @ None } = &mut *state else { return };
        *error = encoder.append(&message).err().map(io_error);
    }

    fn flush_blocking(&self, _timeout: Duration) -> Result<(), SinkFlushError> {
        let mut state = self.lock();
        let State { encoder: Some(encoder), error: error @ None } = &mut *state else { return Ok(()) };
        *error = encoder.flush_blocking().err().map(io_error);
        Ok(())
    }
}

fn end(mut encoder: Encoder) -> std::io::Result<()> {
    encoder.finish().map_err(io_error)?;
    encoder.into_inner().map_err(io_error)?.flush()
}

fn io_error(error: re_log_encoding::EncodeError) -> std::io::Error {
    match error {
        re_log_encoding::EncodeError::Write(error) => error,
        other => std::io::Error::other(other.to_string()),
    }
}

/// Checks that a viewer listens at `address` and gives the address in the form that Rerun's stream wants.
///
/// # Errors
/// [`Error::Input`] for what is no address of a viewer, [`Error::Missing`] when nobody listens there.
pub(super) fn viewer(address: &str) -> Result<re_uri::ProxyUri> {
    let Ok(re_uri::RedapUri::Proxy(uri)) = address.parse::<re_uri::RedapUri>() else {
        return Err(Error::input(
            format!("\"{address}\" is not the address of a Rerun viewer"),
            format!("write it as {DEFAULT_VIEWER}"),
        ));
    };
    let host = uri.origin.host.to_string();
    let reached = (host.trim_matches(['[', ']']), uri.origin.port)
        .to_socket_addrs()
        .is_ok_and(|mut all| all.any(|one| TcpStream::connect_timeout(&one, CONNECT_TIMEOUT).is_ok()));
    if reached { Ok(uri) } else { Err(nobody_listens(address)) }
}

fn nobody_listens(address: &str) -> Error {
    Error::Missing {
        what: format!("no Rerun viewer listens at {address}"),
        help: Some(format!(
            "install one with `pip install rerun-sdk=={RERUN_VERSION}` and start it with `rerun` before the run, \
             or run without --live and open the recording afterwards"
        )),
    }
}

/// Version of the viewer that fits the recording.
pub const RERUN_VERSION: &str = "0.36.3";
