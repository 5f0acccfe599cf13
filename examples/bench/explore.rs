//! How long `strandsnap explore` takes from a move to its picture: a browser's part is played over the same socket.

use crate::Args;
use std::path::Path;
use strandsnap::base::error::{Error, Result};

#[cfg(not(feature = "explore"))]
pub fn print(_: &Args, _: &Path) -> Result<()> {
    Err(Error::Missing { what: "this bench was built without the feature `explore`".into(), help: None })
}

#[cfg(feature = "explore")]
pub use measured::print;

#[cfg(feature = "explore")]
mod measured {
    use super::*;
    use serde_json::{Value, json};
    use std::io::{Read, Write};
    use std::net::TcpStream;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::{Duration, Instant};
    use strandsnap::explore::{Options, Server, View};
    use tungstenite::{Message, WebSocket};

    /// Moves that are timed, after some that are not.
    const MOVES: usize = 40;
    const BEFORE: usize = 10;
    /// Kinds of picture: while something moves, and whole.
    const MOVING: u32 = 0;
    const WHOLE: u32 = 1;

    /// Measures and prints.
    pub fn print(args: &Args, run: &Path) -> Result<()> {
        let clock = Instant::now();
        let server = Server::open(run, Options::default())?;
        let opened = clock.elapsed();
        let (address, adapter, stop) = (server.address(), server.adapter(), AtomicBool::new(false));
        std::thread::scope(|scope| {
            let serving = scope.spawn(|| server.serve(&stop));
            let measured = measure(args, &address, &adapter, opened);
            stop.store(true, Ordering::Relaxed);
            serving.join().expect("serving does not panic").and(measured)
        })
    }

    fn measure(args: &Args, address: &str, adapter: &str, opened: Duration) -> Result<()> {
        let page = Page::open(address).map_err(lost)?;
        let facts = page.facts().map_err(lost)?;
        let [w, h] = args.size;
        let states = facts["states"].as_array().map_or(0, Vec::len);
        println!(
            "{}: {} particles, {states} states, opened in {:.1} s; {adapter}, {w} × {h} pixels",
            facts["name"].as_str().unwrap_or(""),
            facts["particles"],
            opened.as_secs_f64()
        );
        println!("from a move to its picture: median and 95 %, pixels of the moving picture, then the whole picture\n");
        println!("{:<34}{:>10}{:>10}{:>14}{:>12}", "", "ms", "ms", "px", "whole ms");
        let number = |value: &Value| value.as_f64().unwrap_or(0.0);
        let [low, high] = ["low", "high"].map(|end| [0, 1, 2].map(|k| number(&facts["body"][end][k])));
        let radius = number(&facts["body"]["radius"]);
        let middle = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
        let last = states.saturating_sub(1) as f64;
        let all = View {
            state: last,
            azimuth: -28.0,
            elevation: 22.0,
            centre: middle,
            height: (high[2] - low[2]) * f64::from(h) / f64::from(w),
            ..View::default()
        };
        let near = View { height: 4.2 * radius, ..all.clone() };
        let turned = |view: &View, k: usize| View { azimuth: view.azimuth + 2.0 * k as f64, ..view.clone() };
        // From one snapshot to the next, and between them.
        let scrubbed =
            |view: &View, k: usize| View { state: last * k as f64 / (BEFORE + MOVES) as f64, ..view.clone() };
        let cut = |view: &View, k: usize| View { cut: Some(middle[2] + 0.05 * radius * k as f64), ..view.clone() };
        type Moved<'a> = &'a dyn Fn(&View, usize) -> View;
        let moves: [(&str, &View, Moved); 6] = [
            ("turned, all in sight", &all, &turned),
            ("turned, close", &near, &turned),
            ("strain dragged, all in sight", &all, &scrubbed),
            ("strain dragged, close", &near, &scrubbed),
            ("section dragged, all in sight", &all, &cut),
            ("section dragged, close", &near, &cut),
        ];
        for (name, view, moved) in moves {
            let mut page = Page::open(address).map_err(lost)?;
            let mut took = Vec::new();
            let mut drawn = [0; 2];
            for k in 0..BEFORE + MOVES {
                let begin = Instant::now();
                drawn = page.moved(&moved(view, k), args.size).map_err(lost)?;
                took.push(begin.elapsed());
            }
            let begin = Instant::now();
            let waited = page.whole().map_err(lost)? - begin;
            let mut timed: Vec<f64> = took[BEFORE..].iter().map(|took| 1e3 * took.as_secs_f64()).collect();
            timed.sort_by(f64::total_cmp);
            let share = |share: f64| timed[((timed.len() - 1) as f64 * share).round() as usize];
            let pixels = format!("{} × {}", drawn[0], drawn[1]);
            println!(
                "{name:<34}{:>10.1}{:>10.1}{pixels:>14}{:>12.1}",
                share(0.5),
                share(0.95),
                1e3 * waited.as_secs_f64()
            );
        }
        println!("\nThe whole picture comes 150 ms after the last move; its time counts from that move.");
        Ok(())
    }

    fn lost(error: impl std::fmt::Display) -> Error {
        Error::Missing { what: format!("lost the explorer: {error}"), help: None }
    }

    type Outcome<T> = std::result::Result<T, Box<dyn std::error::Error>>;

    /// A browser's part.
    struct Page {
        host: String,
        cookie: String,
        socket: WebSocket<TcpStream>,
        number: u32,
    }

    impl Page {
        fn open(address: &str) -> Outcome<Self> {
            let (host, token) =
                address.trim_start_matches("http://").split_once("/?token=").ok_or("it has no token")?;
            let port = host.split_once(':').ok_or("it has no port")?.1;
            let cookie = format!("strandsnap-{port}={token}");
            let request = tungstenite::http::Request::builder()
                .uri(format!("ws://{host}/socket"))
                .header("Host", host)
                .header("Origin", format!("http://{host}"))
                .header("Cookie", &cookie)
                .header("Connection", "Upgrade")
                .header("Upgrade", "websocket")
                .header("Sec-WebSocket-Version", "13")
                .header("Sec-WebSocket-Key", tungstenite::handshake::client::generate_key())
                .body(())?;
            let (socket, _) =
                tungstenite::client(request, TcpStream::connect(host)?).map_err(|error| error.to_string())?;
            Ok(Self { host: host.into(), cookie, socket, number: 0 })
        }

        fn facts(&self) -> Outcome<Value> {
            let mut stream = TcpStream::connect(&self.host)?;
            write!(stream, "GET /run.json HTTP/1.1\r\nHost: {}\r\nCookie: {}\r\n\r\n", self.host, self.cookie)?;
            let mut answer = String::new();
            stream.read_to_string(&mut answer)?;
            Ok(serde_json::from_str(answer.split_once("\r\n\r\n").ok_or("no answer")?.1)?)
        }

        /// Asks for a view and waits for its moving picture; gives the size of that (px).
        fn moved(&mut self, view: &View, size: [u32; 2]) -> Outcome<[u32; 2]> {
            self.number += 1;
            let look = json!({ "look": { "number": self.number, "size": size, "view": view } });
            self.socket.send(Message::text(look.to_string()))?;
            let drawn = self.picture(MOVING)?;
            self.socket.send(Message::text(json!({ "shown": self.number }).to_string()))?;
            Ok(drawn)
        }

        /// Waits for the whole picture of the last view.
        fn whole(&mut self) -> Outcome<Instant> {
            self.picture(WHOLE)?;
            Ok(Instant::now())
        }

        fn picture(&mut self, wanted: u32) -> Outcome<[u32; 2]> {
            loop {
                match self.socket.read()? {
                    Message::Text(words) if words.starts_with("{\"error\"") => return Err(words.as_str().into()),
                    Message::Binary(data) => {
                        let part = |k: usize| u32::from_le_bytes([0, 1, 2, 3].map(|b| data[4 * k + b]));
                        if part(0) == wanted && part(1) == self.number {
                            return Ok([part(2), part(3)]);
                        }
                    }
                    _ => {}
                }
            }
        }
    }
}
