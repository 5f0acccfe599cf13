//! A run at an address, and those who ask there.

use crate::synthetic::Run;
use serde_json::Value;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::ops::Deref;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;
use strandsnap::explore::{Options, Server, View};
use strandsnap::observe::origin::Origin;
use strandsnap::observe::trajectory::TrajectoryWriter;
use strandsnap::scene;
use tempfile::TempDir;
use tungstenite::{Message, WebSocket};

pub const PATIENCE: Duration = Duration::from_secs(60);
pub const SIZE: [u32; 2] = [320, 200];

/// The folder of a run that was not simulated, with so many snapshots.
pub fn folder(snapshots: usize) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let spec = scene::load("ka4", &[]).unwrap().spec;
    let file = folder.path().join("trajectory.bin");
    Run::new(snapshots).show(&mut TrajectoryWriter::new(&file, Origin::of(&spec)).unwrap()).unwrap();
    std::fs::write(folder.path().join("scene.toml"), scene::write::to_toml(&spec)).unwrap();
    folder
}

/// Past the test harness, which hides what passing tests print.
pub fn skipped(test: &str, why: &str) {
    let _ = writeln!(std::io::stderr(), "SKIPPED ({why}): {test}");
}

/// An address where a run is shown.
pub struct At(pub String);

/// A server that shows a run until it is dropped.
pub struct Served {
    at: At,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// A run that was not simulated and is being shown.
pub struct Shown {
    served: Served,
    pub folder: TempDir,
}

impl Deref for Served {
    type Target = At;

    fn deref(&self) -> &At {
        &self.at
    }
}

impl Deref for Shown {
    type Target = At;

    fn deref(&self) -> &At {
        &self.served
    }
}

impl Served {
    pub fn of(run: &Path, with: Option<&Path>) -> Self {
        let with = with.map(Path::to_owned);
        let options = Options { command: "strandsnap render RUN".into(), with, ..Options::default() };
        let server = Server::open(run, options).unwrap();
        let (address, stop) = (server.address(), Arc::new(AtomicBool::new(false)));
        let flag = stop.clone();
        let thread = std::thread::spawn(move || server.serve(&flag).unwrap());
        Self { at: At(address), stop, thread: Some(thread) }
    }
}

impl Shown {
    /// `None`, said aloud, when there is no graphics adapter.
    pub fn start(test: &str) -> Option<Self> {
        Self::beside(test, None)
    }

    /// The same with another run beside it.
    pub fn beside(test: &str, with: Option<&Path>) -> Option<Self> {
        if strandsnap::render::check().is_err() {
            skipped(test, "no graphics adapter");
            return None;
        }
        let folder = folder(12);
        Some(Self { served: Served::of(folder.path(), with), folder })
    }
}

impl At {
    pub fn host(&self) -> &str {
        self.0.strip_prefix("http://").unwrap().split('/').next().unwrap()
    }

    pub fn token(&self) -> &str {
        self.0.split_once("token=").unwrap().1
    }

    pub fn connect(&self) -> TcpStream {
        let port = self.host().split_once(':').unwrap().1.parse().unwrap();
        let stream = TcpStream::connect(SocketAddr::from((Ipv4Addr::LOCALHOST, port))).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// What is answered to a head with these lines.
    pub fn ask(&self, path: &str, headers: &[(&str, &str)]) -> String {
        let mut stream = self.connect();
        let lines: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        stream.write_all(format!("GET {path} HTTP/1.1\r\n{lines}\r\n").as_bytes()).unwrap();
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    pub fn cookie(&self) -> String {
        format!("strandsnap-{}={}", self.host().split_once(':').unwrap().1, self.token())
    }

    /// What the page itself is answered.
    pub fn fetch(&self, path: &str) -> String {
        self.ask(path, &[("Host", self.host()), ("Cookie", &self.cookie())])
    }

    pub fn socket(&self) -> WebSocket<TcpStream> {
        let (origin, cookie) = (format!("http://{}", self.host()), self.cookie());
        self.socket_from(&origin, &cookie).unwrap()
    }

    pub fn socket_from(&self, origin: &str, cookie: &str) -> Result<WebSocket<TcpStream>, String> {
        let request = tungstenite::http::Request::builder()
            .uri(format!("ws://{}/socket", self.host()))
            .header("Host", self.host())
            .header("Origin", origin)
            .header("Cookie", cookie)
            .header("Connection", "Upgrade")
            .header("Upgrade", "websocket")
            .header("Sec-WebSocket-Version", "13")
            .header("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ==")
            .body(())
            .unwrap();
        tungstenite::client(request, self.connect()).map(|(socket, _)| socket).map_err(|e| e.to_string())
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        if !std::thread::panicking() {
            ended.unwrap().unwrap();
        }
    }
}

pub fn status(answer: &str) -> &str {
    answer.split(' ').nth(1).unwrap_or("nothing")
}

pub fn json_of(answer: &str) -> Value {
    serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
}

pub fn close_up(state: f64) -> View {
    View { state, azimuth: -20.0, elevation: 30.0, follow: Some(62.0), height: 7.0, ..View::default() }
}

pub fn say(socket: &mut WebSocket<TcpStream>, message: Value) {
    socket.send(Message::text(message.to_string())).unwrap();
}

/// What an answer is: kind, number, size and bytes of a picture, or a message.
pub enum Heard {
    Picture { kind: u32, number: u32, size: [u32; 2], bytes: Vec<u8> },
    Words(Value),
}

pub fn hear(socket: &mut WebSocket<TcpStream>) -> Heard {
    loop {
        match socket.read().unwrap() {
            Message::Binary(data) => {
                let part = |k: usize| u32::from_le_bytes(data[4 * k..4 * k + 4].try_into().unwrap());
                let size = [part(2), part(3)];
                return Heard::Picture { kind: part(0), number: part(1), size, bytes: data[20..].to_vec() };
            }
            Message::Text(text) => return Heard::Words(serde_json::from_str(&text).unwrap()),
            _ => {}
        }
    }
}

/// The next picture of a kind.
pub fn next_picture(socket: &mut WebSocket<TcpStream>, wanted: u32) -> (u32, [u32; 2], Vec<u8>) {
    loop {
        if let Heard::Picture { kind, number, size, bytes } = hear(socket)
            && kind == wanted
        {
            return (number, size, bytes);
        }
    }
}

/// The next message with a key.
pub fn next_words(socket: &mut WebSocket<TcpStream>, key: &str) -> Value {
    loop {
        if let Heard::Words(mut value) = hear(socket)
            && value.get(key).is_some()
        {
            return value[key].take();
        }
    }
}
