//! The address at which a run can be looked at: who may come in, how many, and when it ends.

use super::http::{self, Refusal, Request};
use super::record::Told;
use super::session;
use super::shared::{Pane, Shared};
use crate::base::error::{Error, Result};
use std::collections::VecDeque;
use std::io::{ErrorKind, Write};
use std::net::{IpAddr, Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tungstenite::handshake::derive_accept_key;

const PAGE: &str = include_str!("../../assets/explore/explore.html");
const STYLE: &str = include_str!("../../assets/explore/explore.css");
const SCRIPT: &str = include_str!("../../assets/explore/explore.js");
const CHARTS: &str = include_str!("../../assets/explore/charts.js");
const FILM: &str = include_str!("../../assets/explore/film.js");
const LIVE: &str = include_str!("../../assets/explore/live.js");
const ICON: &str = include_str!("../../assets/explore/icon.svg");
/// All that can be asked for.
const NAMES: [&str; 9] =
    ["/", "/explore.css", "/explore.js", "/charts.js", "/film.js", "/live.js", "/icon.svg", "/run.json", "/socket"];

/// Connections at once, requests and sockets together. When there are so many, the one that has waited longest without a
/// request makes room.
const MOST_CONNECTIONS: usize = 48;
/// Browsers that look at once.
const MOST_BROWSERS: usize = 16;
/// How often to look for a new connection, and whether to end.
const POLL: Duration = Duration::from_millis(10);
/// How long the server stays when the last page has gone.
const LINGER: Duration = Duration::from_secs(300);
/// A client that takes nothing for so long is given up.
const WRITE_TIME: Duration = Duration::from_secs(10);
/// How long open connections may take to end with the server.
const PARTING: Duration = Duration::from_secs(2);

/// Where a run is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Address to listen at.
    pub bind: IpAddr,
    /// Port; 0 is a free one.
    pub port: u16,
    /// Stay when the last page has been closed.
    pub keep: bool,
    /// Folder of a second run, shown beside the first one.
    pub with: Option<PathBuf>,
    /// Command that the page shows in front of a view: `strandsnap render out/ka4`.
    pub command: String,
}

impl Default for Options {
    fn default() -> Self {
        Self { bind: Ipv4Addr::LOCALHOST.into(), port: 0, keep: false, with: None, command: String::new() }
    }
}

/// An address that is listened at, before there is something to show.
pub(super) struct Gate {
    listener: TcpListener,
    bound: SocketAddr,
    token: String,
    options: Options,
}

/// A run at an address.
pub struct Server {
    listener: TcpListener,
    options: Options,
    service: Arc<Service>,
}

/// What answers connections.
struct Service {
    shared: Shared,
    bound: SocketAddr,
    token: String,
    command: String,
    connections: AtomicUsize,
    browsers: AtomicUsize,
    /// Connections that have not sent a whole request yet, in the order in which they came.
    idle: Mutex<VecDeque<Arc<TcpStream>>>,
    /// When the last page went away; none has been there before that.
    left: Mutex<Option<Instant>>,
}

impl Gate {
    /// Listens; who comes waits until something is shown.
    ///
    /// # Errors
    /// When the address is taken.
    pub fn open(options: Options) -> Result<Self> {
        let lost = |e: std::io::Error| Error::Missing {
            what: format!("cannot listen at {} port {}: {e}", options.bind, options.port),
            help: Some("choose another address or port with --bind and --port; port 0 is a free one".into()),
        };
        let listener = TcpListener::bind((options.bind, options.port)).map_err(lost)?;
        listener.set_nonblocking(true).map_err(lost)?;
        let bound = listener.local_addr().map_err(lost)?;
        Ok(Self { listener, bound, token: token()?, options })
    }

    /// The address to open, with the token in it.
    pub fn address(&self) -> String {
        address(self.bound, &self.token)
    }

    /// Shows a run there.
    pub fn show(self, shared: Shared) -> Server {
        let Self { listener, bound, token, options } = self;
        let service = Service {
            command: options.command.clone(),
            token,
            shared,
            bound,
            connections: AtomicUsize::new(0),
            browsers: AtomicUsize::new(0),
            idle: Mutex::default(),
            left: Mutex::new(None),
        };
        Server { listener, options, service: Arc::new(service) }
    }
}

fn address(at: SocketAddr, token: &str) -> String {
    let host = match at.ip() {
        ip if ip.is_unspecified() && ip.is_ipv4() => SocketAddr::new(Ipv4Addr::LOCALHOST.into(), at.port()),
        _ => at,
    };
    format!("http://{host}/?token={token}")
}

impl Server {
    /// Reads the run in a folder, opens the graphics adapter and listens.
    ///
    /// # Errors
    /// When a run cannot be read, there is no adapter, or the address is taken.
    pub fn open(run: &Path, options: Options) -> Result<Self> {
        let other = options.with.as_deref().map(Pane::open).transpose()?;
        let shared = Shared::new(Pane::open(run)?, other)?;
        Ok(Gate::open(options)?.show(shared))
    }

    /// The address to open, with the token in it.
    pub fn address(&self) -> String {
        address(self.service.bound, &self.service.token)
    }

    /// Whether a page is open, or has been a moment ago.
    pub(super) fn is_looked_at(&self, moment: Duration) -> bool {
        let left = self.service.left.lock().unwrap_or_else(PoisonError::into_inner);
        self.service.browsers.load(Ordering::Relaxed) > 0 || left.is_some_and(|left| left.elapsed() < moment)
    }

    /// Takes note of what the run tells, without waiting for those who draw.
    pub(super) fn tell(&self, told: Told) {
        self.service.shared.run.tell(told);
    }

    /// Name of the graphics adapter that draws.
    pub fn adapter(&self) -> String {
        self.service.shared.run.adapter.clone()
    }

    /// What is wrong with the runs' folders, in sentences.
    pub fn notes(&self) -> Vec<String> {
        self.service.shared.notes()
    }

    /// Answers until `stop` is set, or until a while after the last page has been closed.
    ///
    /// # Errors
    /// When the system takes the address away.
    pub fn serve(&self, stop: &AtomicBool) -> Result<()> {
        let outcome = loop {
            if stop.load(Ordering::Relaxed) || (!self.options.keep && self.service.deserted()) {
                break Ok(());
            }
            match self.listener.accept() {
                Ok((stream, _)) => self.service.clone().receive(stream),
                Err(e) if [ErrorKind::WouldBlock, ErrorKind::Interrupted].contains(&e.kind()) => {
                    std::thread::sleep(POLL);
                }
                // A connection that broke while it waited, or no descriptor left for now.
                Err(e) if e.kind() == ErrorKind::ConnectionAborted || e.raw_os_error().is_some() => {
                    std::thread::sleep(POLL);
                }
                Err(e) => break Err(Error::Missing { what: format!("lost the address: {e}"), help: None }),
            }
        };
        self.service.shared.ended.store(true, Ordering::Relaxed);
        let begin = Instant::now();
        while self.service.connections.load(Ordering::Relaxed) > 0 && begin.elapsed() < PARTING {
            std::thread::sleep(POLL);
        }
        outcome
    }
}

/// Counts one more for as long as it lives.
struct Counted(Arc<Service>, fn(&Service) -> &AtomicUsize);

impl Counted {
    fn enter(service: &Arc<Service>, which: fn(&Service) -> &AtomicUsize, most: usize) -> Option<Self> {
        let counted = Self(service.clone(), which);
        let before = which(service).fetch_add(1, Ordering::Relaxed);
        (before < most).then_some(counted)
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        (self.1)(&self.0).fetch_sub(1, Ordering::Relaxed);
    }
}

/// Keeps a connection among the idle ones for as long as it lives.
struct Idle(Arc<Service>, Arc<TcpStream>);

impl Idle {
    /// `None` when the system gives no second handle of it.
    fn enter(service: &Arc<Service>, stream: &TcpStream) -> Option<Self> {
        let handle = Arc::new(stream.try_clone().ok()?);
        service.idle().push_back(handle.clone());
        Some(Self(service.clone(), handle))
    }
}

impl Drop for Idle {
    fn drop(&mut self) {
        self.0.idle().retain(|idle| !Arc::ptr_eq(idle, &self.1));
    }
}

impl Service {
    fn deserted(&self) -> bool {
        let left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
        self.browsers.load(Ordering::Relaxed) == 0 && left.is_some_and(|left| left.elapsed() > LINGER)
    }

    fn cookie(&self) -> String {
        // Cookies are shared by all ports of a name.
        format!("strandsnap-{}", self.bound.port())
    }

    fn receive(self: Arc<Self>, mut stream: TcpStream) {
        let prepared = stream.set_nonblocking(false).and_then(|()| stream.set_write_timeout(Some(WRITE_TIME)));
        if prepared.and_then(|()| stream.set_nodelay(true)).is_err() {
            return;
        }
        let enter = |most| Counted::enter(&self, |service| &service.connections, most);
        // One that is shut down is counted until its thread has seen that.
        let counted =
            enter(MOST_CONNECTIONS).or_else(|| self.drop_oldest_idle().then(|| enter(2 * MOST_CONNECTIONS))?);
        let Some(counted) = counted else {
            // Said without a thread of its own; the words fit into the socket's buffer.
            let _ = refuse(&mut stream, Refusal::Busy);
            return;
        };
        let Some(idle) = Idle::enter(&self, &stream) else { return };
        let spawned = std::thread::Builder::new().name("explore".into()).spawn(move || {
            let _counted = counted;
            self.answer(stream, idle);
        });
        // Without a thread the connection is closed, which says enough.
        drop(spawned);
    }

    fn idle(&self) -> MutexGuard<'_, VecDeque<Arc<TcpStream>>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ends the connection that has waited longest without a request; whether there was one.
    fn drop_oldest_idle(&self) -> bool {
        let oldest = self.idle().pop_front();
        oldest.is_some_and(|stream| stream.shutdown(Shutdown::Both).is_ok())
    }

    fn answer(self: &Arc<Self>, mut stream: TcpStream, idle: Idle) {
        let request = http::read(&mut stream);
        drop(idle);
        let answered = match request {
            Ok(request) => match self.check(&request) {
                Ok(()) if request.path == "/socket" => return self.look(stream, request),
                Ok(()) => self.page(&mut stream, &request),
                Err(refusal) => refuse(&mut stream, refusal),
            },
            Err(Some(refusal)) => refuse(&mut stream, refusal),
            Err(None) => Ok(()),
        };
        // Who has gone away needs no answer.
        let _ = answered;
    }

    fn check(&self, request: &Request) -> std::result::Result<(), Refusal> {
        request.check_site(self.bound.ip())?;
        if !NAMES.contains(&request.path.as_str()) {
            return Err(Refusal::Name);
        }
        let given = request.token.as_ref().is_some_and(|given| http::same(given, &self.token));
        let known = request.has_cookie(&self.cookie(), &self.token);
        match request.path.as_str() {
            "/" if given || known => Ok(()),
            "/" => Err(Refusal::Token),
            _ if !request.comes_from_the_page() => Err(Refusal::Site),
            _ if !known => Err(Refusal::Token),
            // Browsers always say whose page opens a socket.
            "/socket" if request.origin.is_none() => Err(Refusal::Site),
            "/socket" if request.socket_key.is_none() => Err(Refusal::Malformed),
            _ => Ok(()),
        }
    }

    fn page(&self, stream: &mut TcpStream, request: &Request) -> std::io::Result<()> {
        let facts;
        let (kind, body): (_, &[u8]) = match request.path.as_str() {
            "/explore.css" => ("text/css; charset=utf-8", STYLE.as_bytes()),
            "/explore.js" => ("text/javascript; charset=utf-8", SCRIPT.as_bytes()),
            "/charts.js" => ("text/javascript; charset=utf-8", CHARTS.as_bytes()),
            "/film.js" => ("text/javascript; charset=utf-8", FILM.as_bytes()),
            "/live.js" => ("text/javascript; charset=utf-8", LIVE.as_bytes()),
            "/icon.svg" => ("image/svg+xml", ICON.as_bytes()),
            "/run.json" => {
                facts = self.facts();
                ("application/json", facts.as_bytes())
            }
            _ => return self.first(stream, request),
        };
        http::respond(stream, "200 OK", kind, "", body)
    }

    fn facts(&self) -> String {
        self.shared.run.catch_up();
        let mut facts = self.shared.facts();
        facts["command"] = self.command.as_str().into();
        facts.to_string()
    }

    /// The page itself, which leaves the token as a cookie that no script can read and no other site can send.
    fn first(&self, stream: &mut TcpStream, request: &Request) -> std::io::Result<()> {
        let headers = format!(
            "Set-Cookie: {}={}; HttpOnly; SameSite=Strict; Path=/\r\nX-Frame-Options: DENY\r\nContent-Security-Policy: \
             default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self' ws://{}; \
             base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n",
            self.cookie(),
            self.token,
            request.host,
        );
        self.shared.run.catch_up();
        let headlines = self.shared.headlines();
        let compared = headlines.len() > 1;
        let names: Vec<&str> = headlines.iter().map(|(name, _)| name.as_str()).collect();
        let name = maud::html! { (names.join(" and ")) }.into_string();
        let headline: String = headlines
            .iter()
            .enumerate()
            .map(|(number, (name, headline))| {
                let side = ["left", "right"][number];
                maud::html! { @if compared { b { (name) ", " (side) ": " } } (maud::PreEscaped(headline)) " " }
                    .into_string()
            })
            .collect();
        let body = PAGE.replace("{{name}}", &name).replace("{{headline}}", headline.trim_end());
        http::respond(stream, "200 OK", "text/html; charset=utf-8", &headers, body.as_bytes())
    }

    /// Opens the socket of a page and serves it until it is closed.
    fn look(self: &Arc<Self>, mut stream: TcpStream, request: Request) {
        let Some(_browser) = Counted::enter(self, |service| &service.browsers, MOST_BROWSERS) else {
            let _ = refuse(&mut stream, Refusal::Busy);
            return;
        };
        let key = request.socket_key.unwrap_or_default();
        let head = format!(
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {}\r\n\r\n",
            derive_accept_key(key.as_bytes())
        );
        if stream.write_all(head.as_bytes()).is_ok() {
            session::run(&self.shared, stream, request.rest);
        }
        *self.left.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
    }
}

fn refuse(stream: &mut TcpStream, refusal: Refusal) -> std::io::Result<()> {
    let (status, words) = refusal.status();
    http::respond(stream, status, "text/plain; charset=utf-8", "", words.as_bytes())
}

/// 128 bits that nobody can guess, in hexadecimal digits.
fn token() -> Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)
        .map_err(|e| Error::Missing { what: format!("the system gives no random numbers: {e}"), help: None })?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}
