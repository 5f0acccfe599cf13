//! One browser that looks: what it asks for, and the pictures that it gets.
//!
//! While something moves, pictures are small and compressed with loss; one is on its way at a time, and of the views that
//! came meanwhile only the newest is drawn. A moment after the last move comes the whole picture without loss.

use super::control::Pace;
use super::draw::Picture;
use super::film::{self, Maker};
use super::path::Path as CameraPath;
use super::pictures::entry;
use super::shared::Shared;
use super::view::View;
use crate::base::error::{Error, Result};
use image::codecs::jpeg::JpegEncoder;
use serde::Deserialize;
use serde_json::{Value, json};
use std::io::{Cursor, ErrorKind};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{CloseFrame, Role, WebSocketConfig};
use tungstenite::{Error as Lost, Message, WebSocket};

/// Longest message of a page (bytes).
const LONGEST_MESSAGE: usize = 64 << 10;
/// Messages that are read before the newest view is drawn, so that nobody can keep a session reading.
const MOST_READ: usize = 256;
/// How long nothing must move before the whole picture comes.
const STILL: Duration = Duration::from_millis(150);
/// How often an idle session looks whether the server ends.
const POLL: Duration = Duration::from_millis(250);
/// A page that does not say that it shows its picture has lost it.
const SHOWING: Duration = Duration::from_secs(20);
/// A page without a sign of life for so long has gone: pages greet every twenty seconds.
const SILENCE: Duration = Duration::from_secs(90);
/// How often a page is told how far its film is, and that a run has gone on.
const PROGRESS: Duration = Duration::from_millis(300);
const GROWTH: Duration = Duration::from_millis(400);
/// Largest film that is sent to a page (bytes).
const MOST_FILM: u64 = 256 << 20;
/// What a picture while moving may cost from asking to showing.
const AIM: Duration = Duration::from_millis(60);
/// Shares of the full size at which moving pictures are drawn (-), and where it begins.
const SCALES: [f64; 7] = [0.25, 0.33, 0.42, 0.5, 0.6, 0.75, 1.0];
const FIRST_SCALE: usize = 3;
/// Quality of moving pictures, of 100.
const QUALITY: u8 = 82;

/// What a page asks for.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum Ask {
    /// To draw a view; `size` is that of the whole picture (px).
    Look { number: u32, size: [u32; 2], view: View },
    /// That the page shows a picture now: the next one may come.
    Shown(u32),
    /// The particle at a place of the view, in shares of width and height from the top left.
    Pick { number: u32, size: [u32; 2], at: [f64; 2], view: View },
    /// A wire along its length.
    Wire { wire: usize, state: f64 },
    /// The view as a file.
    Picture { size: [u32; 2], view: View },
    /// The command that makes the view.
    Command { size: [u32; 2], view: View },
    /// The entry of a scene that makes it.
    Entry { size: [u32; 2], view: View },
    /// Stress of a wire over the whole run.
    History(usize),
    /// The film of a camera path.
    Film(Filmed),
    /// No film after all.
    NoFilm(()),
    /// The command that makes the film.
    FilmCommand(Filmed),
    /// How a run that is going goes on.
    Pace(Pace),
    /// To end it.
    Stop(()),
    /// A sign of life.
    Greet(()),
}

/// A film that a page asks for.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Filmed {
    size: [u32; 2],
    /// From view to view (s).
    seconds: f64,
    views: Vec<View>,
}

impl Filmed {
    fn path(&self) -> CameraPath {
        CameraPath { views: self.views.clone(), seconds: self.seconds }
    }

    /// The command's options.
    fn words(&self) -> Result<String> {
        let views: Vec<String> = self.views.iter().map(View::words).collect::<Result<_>>()?;
        let views: String = views.iter().map(|words| format!("--view '{words}' ")).collect();
        let seconds = crate::base::units::shortest(self.seconds);
        Ok(format!("{views}--leg {seconds}s --size {}x{} --animation film.mp4", self.size[0], self.size[1]))
    }
}

/// Kinds of picture.
#[derive(Clone, Copy)]
#[repr(u32)]
enum Kind {
    Moving = 0,
    Whole = 1,
    File = 2,
    /// No picture: three bytes of colour for each particle.
    Colours = 3,
    /// No picture: a film.
    Film = 4,
}

/// Why a session ends.
enum End {
    /// The other side has gone, or must be left.
    Gone,
    /// The page said what no page says.
    Malformed,
}

struct Session<'a> {
    shared: &'a Shared,
    socket: WebSocket<TcpStream>,
    /// What is to be drawn next, since when.
    wanted: Option<Look>,
    /// The last view that was drawn smaller or with loss, and when it was asked for.
    unfinished: Option<Look>,
    /// The view that is to be a file.
    file: Option<Look>,
    /// The film that is being made, and when the page was last told how far it is.
    film: Option<(Maker<Cursor<Vec<u8>>>, Instant)>,
    /// What the page was told last of a run that is going, and when.
    growth: (Value, Instant),
    /// Picture on its way, and since when.
    flying: Option<(u32, Instant)>,
    /// When the page was last heard.
    heard: Instant,
    /// Of [`SCALES`].
    scale: usize,
    /// State and colouring that the page was told last, and the steps that the state lay between.
    told: Option<(View, [u64; 2])>,
}

struct Look {
    number: u32,
    size: [u32; 2],
    view: View,
    asked: Instant,
}

/// An error in one line, with what would be right.
fn words_of(error: &Error) -> String {
    match miette::Diagnostic::help(error).map(|help| help.to_string()) {
        Some(help) if !help.is_empty() => format!("{error}; {help}"),
        _ => error.to_string(),
    }
}

/// Serves the page behind a socket until it goes away; `rest` is what it has already sent.
pub(super) fn run(shared: &Shared, stream: TcpStream, rest: Vec<u8>) {
    let config = WebSocketConfig::default()
        .max_message_size(Some(LONGEST_MESSAGE))
        .max_frame_size(Some(LONGEST_MESSAGE))
        .read_buffer_size(16 << 10);
    let socket = WebSocket::from_partially_read(stream, rest, Role::Server, Some(config));
    let mut session = Session {
        shared,
        socket,
        wanted: None,
        unfinished: None,
        file: None,
        film: None,
        growth: (Value::Null, Instant::now()),
        flying: None,
        heard: Instant::now(),
        scale: FIRST_SCALE,
        told: None,
    };
    let end = loop {
        match session.turn() {
            Ok(()) => {}
            Err(end) => break end,
        }
    };
    let (code, reason) = match end {
        End::Gone => (CloseCode::Away, ""),
        End::Malformed => (CloseCode::Policy, "this is not what the page says"),
    };
    // Who has gone already does not hear it.
    let _ = session.socket.close(Some(CloseFrame { code, reason: reason.into() }));
    let _ = session.socket.flush();
}

impl Session<'_> {
    /// Reads what has come, then draws at most one picture.
    fn turn(&mut self) -> std::result::Result<(), End> {
        if self.shared.ended.load(std::sync::atomic::Ordering::Relaxed) || self.heard.elapsed() > SILENCE {
            return Err(End::Gone);
        }
        self.shared.run.catch_up();
        self.tell_growth()?;
        let mut wait = self.wait();
        for _ in 0..MOST_READ {
            let Some(message) = self.receive(wait)? else { break };
            self.heard = Instant::now();
            self.hear(message)?;
            wait = Duration::ZERO;
        }
        if self.flying.is_some_and(|(_, since)| since.elapsed() > SHOWING) {
            return Err(End::Gone);
        }
        if self.flying.is_some() {
            return Ok(());
        }
        if let Some(look) = self.wanted.take() {
            return self.draw_moving(look);
        }
        if let Some(look) = self.file.take() {
            return self.draw_whole(Kind::File, &look);
        }
        match self.unfinished.take_if(|look| look.asked.elapsed() >= STILL) {
            Some(look) => self.draw_whole(Kind::Whole, &look),
            None => self.draw_film(),
        }
    }

    /// How long nothing but a message is to be done.
    fn wait(&self) -> Duration {
        match (self.wanted.as_ref().or(self.file.as_ref()), &self.unfinished) {
            _ if self.flying.is_some() => POLL,
            _ if self.film.is_some() => Duration::ZERO,
            (Some(_), _) => Duration::ZERO,
            (None, Some(look)) => STILL.saturating_sub(look.asked.elapsed()).min(POLL),
            (None, None) => POLL,
        }
    }

    /// The next message, if one comes in time.
    fn receive(&mut self, wait: Duration) -> std::result::Result<Option<Message>, End> {
        let stream = self.socket.get_ref();
        let set = if wait.is_zero() { stream.set_nonblocking(true) } else { stream.set_read_timeout(Some(wait)) };
        set.map_err(|_| End::Gone)?;
        let read = self.socket.read();
        if wait.is_zero() {
            self.socket.get_ref().set_nonblocking(false).map_err(|_| End::Gone)?;
        }
        match read {
            Ok(message) => Ok(Some(message)),
            Err(Lost::Io(e)) if [ErrorKind::WouldBlock, ErrorKind::TimedOut].contains(&e.kind()) => Ok(None),
            Err(Lost::Io(e)) if e.kind() == ErrorKind::Interrupted => Ok(None),
            Err(Lost::Protocol(_) | Lost::Capacity(_) | Lost::Utf8(_)) => Err(End::Malformed),
            Err(_) => Err(End::Gone),
        }
    }

    fn hear(&mut self, message: Message) -> std::result::Result<(), End> {
        let text = match message {
            Message::Text(text) => text,
            Message::Ping(_) | Message::Pong(_) => return Ok(()),
            Message::Close(_) => return Err(End::Gone),
            Message::Binary(_) | Message::Frame(_) => return Err(End::Malformed),
        };
        match serde_json::from_str(&text).map_err(|_| End::Malformed)? {
            Ask::Look { number, size, view } => {
                self.wanted = Some(Look { number, size, view, asked: Instant::now() });
                self.unfinished = None;
                Ok(())
            }
            Ask::Shown(number) => {
                self.shown(number);
                Ok(())
            }
            Ask::Pick { number, size, at, view } => {
                let picked = self.shared.check(&view).map(|()| self.shared.pick(&view, size, at));
                self.answer(picked.map(|picked| json!({ "picked": picked, "number": number })))
            }
            Ask::Wire { wire, state } => {
                let record = self.shared.run.record();
                let last = (record.states() - 1) as f64;
                let told = record.wire(wire, state.clamp(0.0, last));
                drop(record);
                self.say(&json!({ "wire": told }))
            }
            Ask::Picture { size, view } => {
                self.file = Some(Look { number: 0, size, view, asked: Instant::now() });
                Ok(())
            }
            Ask::Command { size, view } => {
                let words = self.shared.check(&view).and_then(|()| view.words());
                let size = format!("{}x{}", size[0], size[1]);
                self.answer(words.map(|words| json!({ "command": format!("--view '{words}' --size {size}") })))
            }
            Ask::Entry { size, view } => {
                let entry = self.shared.check(&view).map(|()| entry(&self.shared.run.record(), &view, size));
                self.answer(entry.map(|entry| json!({ "entry": entry })))
            }
            Ask::History(wire) => {
                let record = self.shared.run.record();
                let known = wire < record.info().wires.len();
                let told = known.then(|| record.history(wire));
                drop(record);
                self.say(&json!({ "history": told }))
            }
            Ask::Film(filmed) => {
                let (path, size) = (filmed.path(), filmed.size);
                let begun = film::check(self.shared, &path, size)
                    .and_then(|()| Maker::begin(path, size, Cursor::default(), Path::new("the film")));
                match begun {
                    Ok(maker) => {
                        self.film = Some((maker, Instant::now()));
                        Ok(())
                    }
                    Err(error) => self.answer(Err(error)),
                }
            }
            Ask::NoFilm(()) => {
                self.film = None;
                Ok(())
            }
            Ask::FilmCommand(filmed) => {
                let words = film::check(self.shared, &filmed.path(), filmed.size).and_then(|()| filmed.words());
                self.answer(words.map(|words| json!({ "film-command": words })))
            }
            Ask::Pace(pace) => {
                self.shared.live.iter().for_each(|live| live.set(pace));
                Ok(())
            }
            Ask::Stop(()) => {
                self.shared.live.iter().for_each(|live| live.stop());
                Ok(())
            }
            Ask::Greet(()) => Ok(()),
        }
    }

    /// Judges how long the picture took from asking to showing, and chooses the size of the next ones.
    fn shown(&mut self, number: u32) {
        let Some((_, since)) = self.flying.take_if(|(flying, _)| *flying == number) else { return };
        let took = since.elapsed();
        if took > AIM + AIM / 2 {
            self.scale = self.scale.saturating_sub(1);
        } else if took < AIM / 2 {
            self.scale = (self.scale + 1).min(SCALES.len() - 1);
        }
    }

    fn drawn(&self, view: &View, size: [u32; 2]) -> Result<Picture> {
        self.shared.check(view)?;
        self.shared.draw(view, size)
    }

    fn draw_moving(&mut self, look: Look) -> std::result::Result<(), End> {
        let begin = Instant::now();
        let share = SCALES[self.scale];
        let size = look.size.map(|side| ((f64::from(side) * share).round() as u32).max(16));
        let drawn = self.drawn(&look.view, size).and_then(|picture| {
            let mut bytes = Vec::new();
            let encoder = JpegEncoder::new_with_quality(&mut bytes, QUALITY);
            let encoded = picture.image.write_with_encoder(encoder);
            encoded.map_err(|e| Error::input(format!("cannot encode a picture: {e}"), ""))?;
            Ok((bytes, picture.took))
        });
        match drawn {
            Err(error) => self.answer(Err(error)),
            Ok((bytes, took)) => {
                self.tell(&look)?;
                self.flying = Some((look.number, begin));
                self.send_picture(Kind::Moving, look.number, size, took, &bytes)?;
                self.unfinished = Some(look);
                Ok(())
            }
        }
    }

    /// Draws one picture of the film; other pictures come first.
    fn draw_film(&mut self) -> std::result::Result<(), End> {
        let Some((mut maker, told)) = self.film.take() else { return Ok(()) };
        let drawn = maker.draw_next(self.shared);
        let progress = json!({ "film": { "done": maker.drawn(), "of": maker.pictures() } });
        match drawn {
            Err(error) => return self.answer(Err(error)),
            Ok(true) if maker.bytes() > MOST_FILM => {
                let error = Error::input(
                    format!("the film is larger than {} MB", MOST_FILM >> 20),
                    "make it smaller or shorter, or with the command line, which writes it into a file",
                );
                return self.answer(Err(error));
            }
            Ok(true) if told.elapsed() < PROGRESS => self.film = Some((maker, told)),
            Ok(true) => {
                self.film = Some((maker, Instant::now()));
                return self.say(&progress);
            }
            Ok(false) => {
                self.say(&progress)?;
                return match maker.end() {
                    Ok(film) => self.send_picture(Kind::Film, 0, [0, 0], Duration::ZERO, film.get_ref()),
                    Err(error) => self.answer(Err(error)),
                };
            }
        }
        Ok(())
    }

    /// Tells the page that a run has gone on.
    fn tell_growth(&mut self) -> std::result::Result<(), End> {
        let Some(live) = self.shared.live.as_ref().filter(|_| self.growth.1.elapsed() >= GROWTH) else { return Ok(()) };
        let mut state = live.state();
        state["extent"] = self.shared.run.record().extent().into();
        if state == self.growth.0 {
            return Ok(());
        }
        self.growth = (state.clone(), Instant::now());
        self.say(&json!({ "live": state }))
    }

    fn draw_whole(&mut self, kind: Kind, look: &Look) -> std::result::Result<(), End> {
        let drawn = self.drawn(&look.view, look.size).and_then(|picture| {
            let bytes = crate::render::png::encode(&picture.image, None)?;
            Ok((bytes, picture.took))
        });
        match drawn {
            Err(error) => self.answer(Err(error)),
            Ok((bytes, took)) => self.send_picture(kind, look.number, look.size, took, &bytes),
        }
    }

    /// Tells the page of a state or a colouring that is new to it.
    fn tell(&mut self, look: &Look) -> std::result::Result<(), End> {
        let now = (look.view.clone(), self.shared.run.record().steps(look.view.state));
        let told = self.told.replace(now.clone());
        let place = |(view, steps): &(View, [u64; 2])| (view.state, view.follow, *steps);
        let colour = |(view, _): &(View, [u64; 2])| (view.colour, view.range);
        let state = told.as_ref().is_none_or(|told| place(told) != place(&now));
        if state {
            let state = self.shared.state(&look.view);
            self.say(&json!({ "state": state }))?;
        }
        if state || told.is_none_or(|told| colour(&told) != colour(&now)) {
            let run = &self.shared.run;
            let ready = run.artist().ready(&run.record(), &look.view, self.shared.part(look.size));
            self.send_picture(Kind::Colours, look.number, look.size, Duration::ZERO, ready.colours.as_flattened())?;
        }
        Ok(())
    }

    /// An answer, or what is wrong with the question.
    fn answer(&mut self, answer: Result<Value>) -> std::result::Result<(), End> {
        match answer {
            Ok(value) => self.say(&value),
            Err(error) => self.say(&json!({ "error": words_of(&error) })),
        }
    }

    fn say(&mut self, value: &Value) -> std::result::Result<(), End> {
        self.send(Message::text(value.to_string()))
    }

    /// A picture behind a head of five numbers of four bytes: kind, number, width, height, microseconds of drawing.
    fn send_picture(
        &mut self,
        kind: Kind,
        number: u32,
        [w, h]: [u32; 2],
        took: Duration,
        bytes: &[u8],
    ) -> std::result::Result<(), End> {
        let mut message = Vec::with_capacity(20 + bytes.len());
        for part in [kind as u32, number, w, h, took.as_micros() as u32] {
            message.extend_from_slice(&part.to_le_bytes());
        }
        message.extend_from_slice(bytes);
        self.send(Message::binary(message))
    }

    /// Sends a message. A page that takes nothing within the time that the connection allows is given up, so that no
    /// queue of answers grows.
    fn send(&mut self, message: Message) -> std::result::Result<(), End> {
        self.socket.send(message).map_err(|_| End::Gone)
    }
}
