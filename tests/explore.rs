//! The interactive picture of a run: what it shows against the files of the run, who is let in, and what a page that
//! misbehaves can do. Drawing needs a graphics adapter, the page a Chromium; without them tests say that they were skipped.
#![cfg(feature = "explore")]

mod browser;
mod synthetic;

use browser::Browser;
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use strandsnap::base::units::{mm, mpa};
use strandsnap::explore::{Options, Server, View, picture};
use strandsnap::observe::origin::Origin;
use strandsnap::observe::trajectory::TrajectoryWriter;
use strandsnap::scene;
use synthetic::Run;
use tempfile::TempDir;
use tungstenite::{Message, WebSocket};

const PATIENCE: Duration = Duration::from_secs(60);
const SIZE: [u32; 2] = [320, 200];

/// The folder of a run that was not simulated, with so many snapshots.
fn folder(snapshots: usize) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let spec = scene::load("ka4", &[]).unwrap().spec;
    let file = folder.path().join("trajectory.bin");
    Run::new(snapshots).show(&mut TrajectoryWriter::new(&file, Origin::of(&spec)).unwrap()).unwrap();
    std::fs::write(folder.path().join("scene.toml"), scene::write::to_toml(&spec)).unwrap();
    folder
}

/// Past the test harness, which hides what passing tests print.
fn skipped(test: &str, why: &str) {
    let _ = writeln!(std::io::stderr(), "SKIPPED ({why}): {test}");
}

/// A run that is being shown.
struct Shown {
    address: String,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    folder: TempDir,
}

impl Shown {
    /// `None`, said aloud, when there is no graphics adapter.
    fn start(test: &str) -> Option<Self> {
        Self::beside(test, None)
    }

    /// The same with another run beside it.
    fn beside(test: &str, with: Option<&Path>) -> Option<Self> {
        if strandsnap::render::check().is_err() {
            skipped(test, "no graphics adapter");
            return None;
        }
        let folder = folder(12);
        let with = with.map(Path::to_owned);
        let options = Options { command: "strandsnap render RUN".into(), with, ..Options::default() };
        let server = Server::open(folder.path(), options).unwrap();
        let (address, stop) = (server.address(), Arc::new(AtomicBool::new(false)));
        let flag = stop.clone();
        let thread = std::thread::spawn(move || server.serve(&flag).unwrap());
        Some(Self { address, stop, thread: Some(thread), folder })
    }

    fn host(&self) -> &str {
        self.address.strip_prefix("http://").unwrap().split('/').next().unwrap()
    }

    fn token(&self) -> &str {
        self.address.split_once("token=").unwrap().1
    }

    fn connect(&self) -> TcpStream {
        let port = self.host().split_once(':').unwrap().1.parse().unwrap();
        let stream = TcpStream::connect(SocketAddr::from((Ipv4Addr::LOCALHOST, port))).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// What is answered to a head with these lines.
    fn ask(&self, path: &str, headers: &[(&str, &str)]) -> String {
        let mut stream = self.connect();
        let lines: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        stream.write_all(format!("GET {path} HTTP/1.1\r\n{lines}\r\n").as_bytes()).unwrap();
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn cookie(&self) -> String {
        format!("strandsnap-{}={}", self.host().split_once(':').unwrap().1, self.token())
    }

    /// What the page itself is answered.
    fn fetch(&self, path: &str) -> String {
        self.ask(path, &[("Host", self.host()), ("Cookie", &self.cookie())])
    }

    fn socket(&self) -> WebSocket<TcpStream> {
        let (origin, cookie) = (format!("http://{}", self.host()), self.cookie());
        self.socket_from(&origin, &cookie).unwrap()
    }

    fn socket_from(&self, origin: &str, cookie: &str) -> Result<WebSocket<TcpStream>, String> {
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

impl Drop for Shown {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        if !std::thread::panicking() {
            ended.unwrap().unwrap();
        }
    }
}

fn status(answer: &str) -> &str {
    answer.split(' ').nth(1).unwrap_or("nothing")
}

fn json_of(answer: &str) -> Value {
    serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
}

fn close_up(state: f64) -> View {
    View { state, azimuth: -20.0, elevation: 30.0, follow: Some(62.0), height: 7.0, ..View::default() }
}

fn say(socket: &mut WebSocket<TcpStream>, message: Value) {
    socket.send(Message::text(message.to_string())).unwrap();
}

/// What an answer is: kind, number, size and bytes of a picture, or a message.
enum Heard {
    Picture { kind: u32, number: u32, size: [u32; 2], bytes: Vec<u8> },
    Words(Value),
}

fn hear(socket: &mut WebSocket<TcpStream>) -> Heard {
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
fn next_picture(socket: &mut WebSocket<TcpStream>, wanted: u32) -> (u32, [u32; 2], Vec<u8>) {
    loop {
        if let Heard::Picture { kind, number, size, bytes } = hear(socket)
            && kind == wanted
        {
            return (number, size, bytes);
        }
    }
}

/// The next message with a key.
fn next_words(socket: &mut WebSocket<TcpStream>, key: &str) -> Value {
    loop {
        if let Heard::Words(mut value) = hear(socket)
            && value.get(key).is_some()
        {
            return value[key].take();
        }
    }
}

#[test]
fn the_page_is_told_what_the_run_holds() {
    let Some(shown) = Shown::start("the_page_is_told_what_the_run_holds") else { return };
    let run = Run::new(12);
    let page = shown.ask(&format!("/?token={}", shown.token()), &[("Host", shown.host())]);
    assert_eq!(status(&page), "200", "{page}");
    assert!(page.contains("Wire 24, outer layer"), "the answer stands on the page itself: {page}");
    for part in ["HttpOnly", "SameSite=Strict", "default-src 'none'", "frame-ancestors 'none'", "nosniff"] {
        assert!(page.contains(part), "{part}: {page}");
    }
    assert!(!page.contains("https://") && !page.contains("unsafe"), "something comes from outside");
    let facts = json_of(&shown.fetch("/run.json"));
    assert_eq!(facts["states"].as_array().unwrap().len(), 12);
    assert_eq!(facts["wires"].as_array().unwrap().len(), 34);
    let ruptures = facts["ruptures"].as_array().unwrap();
    assert_eq!(ruptures.len(), run.ruptures().len());
    for (told, rupture) in ruptures.iter().zip(run.ruptures()) {
        assert_eq!(told["wire"], rupture.wire);
        let near = |key: &str, value: f64| (told[key].as_f64().unwrap() - value).abs() < 1e-9 * value.abs();
        assert!(near("x", rupture.strain * 1e2) && near("rest_z", rupture.rest_z * 1e3), "{told}");
        assert!(near("stress", rupture.stress * 1e-6) && near("body_stress", rupture.body_stress * 1e-6), "{told}");
        let state = told["state"].as_u64().unwrap() as usize;
        assert!(run.snapshots()[state].sample.strain >= rupture.strain);
        assert!(state == 0 || run.snapshots()[state - 1].sample.strain < rupture.strain);
    }
}

#[test]
fn render_and_explore_draw_the_same_view() {
    let Some(shown) = Shown::start("render_and_explore_draw_the_same_view") else { return };
    let view = View { explode: 0.4, hidden_layers: vec![2], cut: Some(75.5), ..close_up(10.5) };
    let mut socket = shown.socket();
    say(&mut socket, json!({ "look": { "number": 7, "size": SIZE, "view": view } }));
    let (number, small, _) = next_picture(&mut socket, 0);
    assert!(number == 7 && small[0] < SIZE[0] && small[1] < SIZE[1], "{small:?}");
    say(&mut socket, json!({ "shown": 7 }));
    let (number, size, whole) = next_picture(&mut socket, 1);
    assert_eq!((number, size), (7, SIZE));
    assert_eq!(whole, picture(shown.folder.path(), &view, SIZE).unwrap(), "another picture than the library's");
    say(&mut socket, json!({ "command": { "size": SIZE, "view": view } }));
    let command = next_words(&mut socket, "command");
    let words = command.as_str().unwrap().strip_prefix("--view '").unwrap().split_once('\'').unwrap();
    let out = shown.folder.path().join("one");
    let run = Command::new(env!("CARGO_BIN_EXE_strandsnap"))
        .arg("render")
        .arg(shown.folder.path())
        .args(["--view", words.0])
        .args(words.1.split_whitespace())
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    assert_eq!(whole, std::fs::read(out.join("view.png")).unwrap(), "another picture than the program's");
}

#[test]
fn two_runs_stand_side_by_side_at_the_same_strain() {
    const NAME: &str = "two_runs_stand_side_by_side_at_the_same_strain";
    let beside = folder(7);
    let Some(shown) = Shown::beside(NAME, Some(beside.path())) else { return };
    let strains =
        |count: usize| Run::new(count).snapshots().iter().map(|s| s.sample.strain * 1e2).collect::<Vec<f64>>();
    let (left, right) = (strains(12), strains(7));
    let strain = 0.5 * (left[9] + left[10]);
    let after = right.iter().position(|x| *x >= strain).unwrap();
    let state = (after - 1) as f64 + (strain - right[after - 1]) / (right[after] - right[after - 1]);
    let facts = json_of(&shown.fetch("/run.json"));
    assert_eq!(facts["other"]["states"].as_array().unwrap().len(), 7);
    // Runs of the same scene are told apart by their folders.
    assert_eq!(facts["other"]["label"], beside.path().display().to_string());
    assert_ne!(facts["label"], facts["other"]["label"]);
    let mut socket = shown.socket();
    let view = close_up(9.5);
    say(&mut socket, json!({ "look": { "number": 1, "size": SIZE, "view": view } }));
    let told = next_words(&mut socket, "state");
    let x = told["other"]["x"].as_f64().unwrap();
    assert!((told["x"].as_f64().unwrap() - strain).abs() < 1e-9 && (x - strain).abs() < 1e-9, "{told}");
    next_picture(&mut socket, 0);
    say(&mut socket, json!({ "shown": 1 }));
    let (_, _, whole) = next_picture(&mut socket, 1);
    let whole = image::load_from_memory(&whole).unwrap().into_rgb8();
    let half = [SIZE[0] / 2, SIZE[1]];
    for (run, state, from) in [(shown.folder.path(), 9.5, 0), (beside.path(), state, half[0])] {
        let alone = picture(run, &View { state, ..view.clone() }, half).unwrap();
        let alone = image::load_from_memory(&alone).unwrap().into_rgb8();
        let part = image::imageops::crop_imm(&whole, from, 0, half[0], half[1]).to_image();
        let differing = part.pixels().zip(alone.pixels()).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "pixels of the part from {from} px");
    }
    // What is in the middle of a part is picked in its own run.
    for (at, other) in [(0.25, false), (0.75, true)] {
        say(&mut socket, json!({ "pick": { "number": 1, "size": SIZE, "at": [at, 0.5], "view": view } }));
        assert_eq!(next_words(&mut socket, "picked")["other"], other);
    }
}

#[test]
fn what_is_under_the_pointer_is_in_the_picture() {
    let Some(shown) = Shown::start("what_is_under_the_pointer_is_in_the_picture") else { return };
    let run = Run::new(12);
    let mut socket = shown.socket();
    let mut view = close_up(11.0);
    let mut pick = |view: &View, at: [f64; 2]| {
        say(&mut socket, json!({ "pick": { "number": 1, "size": SIZE, "at": at, "view": view } }));
        next_words(&mut socket, "picked")
    };
    let found = pick(&view, [0.5, 0.5]);
    let (i, wire) = (found["particle"].as_u64().unwrap() as usize, found["wire"].as_u64().unwrap() as usize);
    let last = run.snapshots()[11];
    assert_eq!(run.info.wires[wire].layer, 2, "the outer layer lies in front");
    // The browser is told of mm and MPa.
    assert_eq!(found["position"][2].as_f64().unwrap() as f32, mm(last.position[i][2].into()) as f32);
    assert_eq!(found["contact_pressure"].as_f64().unwrap() as f32, mpa(last.contact_pressure[i].into()) as f32);
    view.hidden_layers = vec![2];
    let found = pick(&view, [0.5, 0.5]);
    assert_eq!(run.info.wires[found["wire"].as_u64().unwrap() as usize].layer, 1, "what is hidden is not picked");
    assert_eq!(pick(&view, [0.5, 0.02]), Value::Null, "nothing is there");
}

#[test]
fn pictures_come_one_at_a_time_and_stale_views_are_dropped() {
    let Some(shown) = Shown::start("pictures_come_one_at_a_time_and_stale_views_are_dropped") else { return };
    let mut socket = shown.socket();
    for number in 1..=40 {
        let view = View { azimuth: f64::from(number), ..close_up(11.0) };
        say(&mut socket, json!({ "look": { "number": number, "size": SIZE, "view": view } }));
    }
    let mut seen = Vec::new();
    while seen.last() != Some(&40) {
        let (number, ..) = next_picture(&mut socket, 0);
        seen.push(number);
        // Nothing more is on its way until the page says that it shows this one.
        socket.get_ref().set_read_timeout(Some(Duration::from_millis(300))).unwrap();
        let early = socket.read();
        assert!(early.is_err(), "a second picture while the first was on its way: {seen:?}");
        socket.get_ref().set_read_timeout(Some(PATIENCE)).unwrap();
        say(&mut socket, json!({ "shown": number }));
    }
    assert!(seen.len() <= 4, "stale views were drawn: {seen:?}");
    assert_eq!(next_picture(&mut socket, 1).0, 40);
}

#[test]
fn strangers_are_refused() {
    let Some(shown) = Shown::start("strangers_are_refused") else { return };
    let (host, cookie) = (shown.host(), shown.cookie());
    let own = format!("http://{host}");
    let with = |path: &str, headers: &[(&str, &str)]| status(&shown.ask(path, headers)).to_owned();
    assert_eq!(with("/", &[("Host", host), ("Cookie", &cookie)]), "200");
    assert_eq!(with("/run.json", &[("Host", host), ("Cookie", &cookie), ("Origin", &own)]), "200");
    let wrong = "0".repeat(32);
    for (path, headers) in [
        ("/", vec![("Host", host)]),
        ("/run.json", vec![("Host", host)]),
        ("/socket", vec![("Host", host), ("Origin", &own)]),
        ("/", vec![("Host", host), ("Cookie", "strandsnap-1=x")]),
        // Another name for this machine, which another site could have made.
        ("/", vec![("Host", "example.org"), ("Cookie", &cookie)]),
        ("/run.json", vec![("Host", "127.0.0.1.example.org:80"), ("Cookie", &cookie)]),
        // Another site's page.
        ("/run.json", vec![("Host", host), ("Cookie", &cookie), ("Origin", "http://example.org")]),
        ("/run.json", vec![("Host", host), ("Cookie", &cookie), ("Sec-Fetch-Site", "cross-site")]),
        ("/socket", vec![("Host", host), ("Cookie", &cookie), ("Origin", "null")]),
        ("/socket", vec![("Host", host), ("Cookie", &cookie)]),
    ] {
        assert_eq!(with(path, &headers), "403", "{path} {headers:?}");
    }
    assert_eq!(with(&format!("/?token={wrong}"), &[("Host", host)]), "403");
    assert_eq!(with(&format!("/run.json?token={}", shown.token()), &[("Host", host)]), "403", "only the page takes it");
    for path in
        ["/../scene.toml", "/scene.toml", "//etc/passwd", "/%2e%2e/trajectory.bin", "/explore.js/../../scene.toml"]
    {
        assert_eq!(with(path, &[("Host", host), ("Cookie", &cookie)]), "404", "{path}");
    }
    assert!(shown.socket_from("http://example.org", &cookie).is_err());
    assert!(shown.socket_from(&own, "strandsnap-1=x").is_err());
    assert!(shown.socket_from(&own, &cookie).is_ok());
}

#[test]
fn malformed_messages_end_their_session_and_nothing_else() {
    let Some(shown) = Shown::start("malformed_messages_end_their_session_and_nothing_else") else { return };
    let good = json!({ "look": { "number": 1, "size": SIZE, "view": close_up(3.0) } });
    let mut texts: Vec<String> =
        ["", "{", "[]", "null", "{\"look\":{}}", "{\"unknown\":1}", "{\"shown\":-1}"].map(String::from).into();
    texts.push("[".repeat(60_000));
    texts.push("x".repeat(1 << 20));
    let mut deep = good.clone();
    deep["look"]["view"]["more"] = json!(1);
    texts.push(deep.to_string());
    for text in &texts {
        let mut socket = shown.socket();
        let sent = socket.send(Message::text(text.as_str()));
        let closed = sent.is_err()
            || loop {
                match socket.read() {
                    Ok(Message::Close(_)) | Err(_) => break true,
                    Ok(_) => {}
                }
            };
        assert!(closed);
    }
    // Ten thousand in one go: the first ends it.
    let mut socket = shown.socket();
    for k in 0..10_000 {
        if socket.write(Message::text(format!("{{\"nothing\":{k}}}"))).is_err() {
            break;
        }
    }
    let _ = socket.flush();
    // Well formed, but not of this run: an answer that says so, and the session goes on.
    let mut socket = shown.socket();
    for (key, value) in [
        ("state", json!(12.0)),
        ("state", json!(-1)),
        ("height", json!(0)),
        ("hidden_wires", json!([99])),
        ("explode", json!(1e9)),
        ("centre", json!([0, 0, 1e300])),
        ("range", json!([2, 1])),
    ] {
        let mut ask = good.clone();
        ask["look"]["view"][key] = value;
        say(&mut socket, ask);
        let words = next_words(&mut socket, "error");
        let words = words.as_str().unwrap();
        assert!(
            words.contains(key)
                && (words.contains("; it takes ") || words.contains("; they take "))
                && words.len() < 200,
            "{words}"
        );
    }
    for size in [[0, 0], [100_000, 100_000], [8192, 8192]] {
        say(&mut socket, json!({ "picture": { "size": size, "view": close_up(3.0) } }));
        assert!(next_words(&mut socket, "error").as_str().unwrap().contains("pixels"));
    }
    say(&mut socket, good);
    assert_eq!(next_picture(&mut socket, 0).0, 1);
}

#[test]
fn who_never_reads_or_comes_too_often_harms_nobody() {
    let Some(shown) = Shown::start("who_never_reads_or_comes_too_often_harms_nobody") else { return };
    // Asks for large pictures and takes none.
    let mut silent = shown.socket();
    silent.get_ref().set_write_timeout(Some(Duration::from_secs(1))).unwrap();
    for _ in 0..2000 {
        let ask = json!({ "picture": { "size": [640, 400], "view": close_up(3.0) } });
        if silent.send(Message::text(ask.to_string())).is_err() {
            break;
        }
    }
    // A hundred connections that say nothing, or half of a request: who asks for something is answered at once.
    let mut idle: Vec<TcpStream> = (0..100).map(|_| shown.connect()).collect();
    idle.iter_mut().step_by(2).for_each(|stream| drop(stream.write_all(b"GET /run.json HTTP/1.1\r\n")));
    let begin = Instant::now();
    assert_eq!(status(&shown.fetch("/run.json")), "200");
    assert!(begin.elapsed() < Duration::from_millis(1500), "{:?}", begin.elapsed());
    // Those that came first have made room.
    let mut nothing = [0; 1];
    assert!(!matches!(idle[0].read(&mut nothing), Ok(1..)), "the first is not answered");
    drop(idle);
    // Pages that are open keep their places: they are not turned out for others.
    let mut pages: Vec<_> =
        (0..20).filter_map(|_| shown.socket_from(&format!("http://{}", shown.host()), &shown.cookie()).ok()).collect();
    assert!(pages.len() < 17, "{} browsers at once", pages.len());
    let mut idle: Vec<TcpStream> = (0..100).map(|_| shown.connect()).collect();
    say(&mut pages[0], json!({ "look": { "number": 9, "size": SIZE, "view": close_up(3.0) } }));
    assert_eq!(next_picture(&mut pages[0], 0).0, 9);
    idle.clear();
    drop(pages);
    let begin = Instant::now();
    while status(&shown.fetch("/run.json")) != "200"
        || shown.socket_from(&format!("http://{}", shown.host()), &shown.cookie()).is_err()
    {
        assert!(begin.elapsed() < PATIENCE, "nobody gets in any more");
        std::thread::sleep(Duration::from_millis(50));
    }
    let mut socket = shown.socket();
    say(&mut socket, json!({ "look": { "number": 5, "size": SIZE, "view": close_up(3.0) } }));
    assert_eq!(next_picture(&mut socket, 0).0, 5);
}

fn keep(browser: &mut Browser, name: &str) {
    if let Some(folder) = std::env::var_os("KEEP_PICTURES") {
        browser.screenshot(&Path::new(&folder).join(name));
    }
}

/// Waits until the whole picture of the view is shown.
fn settled(browser: &mut Browser) {
    std::thread::sleep(Duration::from_millis(120));
    browser.wait_for(
        "String(document.querySelector('#stage').dataset.whole === 'yes' && \
         JSON.stringify(explore.shown()?.view) === JSON.stringify(explore.view))",
        "true",
    );
}

#[test]
fn a_person_finds_what_broke_first() {
    let Some(program) = browser::find() else {
        skipped("a_person_finds_what_broke_first", "no Chromium");
        return;
    };
    let Some(shown) = Shown::start("a_person_finds_what_broke_first") else { return };
    let run = Run::new(12);
    let first = run.ruptures()[0];
    let mut page = Browser::start(&program);
    page.visit(&shown.address, "dark");
    settled(&mut page);
    assert_eq!(page.value("location.search"), "", "the token does not stay in the address");
    assert!(page.value("document.querySelector('#headline').textContent").as_str().unwrap().contains("Wire 24"));
    keep(&mut page, "explore-dark.png");

    // A drag turns the strand: other pixels, another camera.
    let pixels = "document.querySelector('#picture').toDataURL()";
    let before = (page.value(pixels), page.value("explore.view.azimuth"));
    page.drag("#stage", [0.4, 0.5], [0.6, 0.55]);
    settled(&mut page);
    assert_ne!(page.value("explore.view.azimuth"), before.1);
    assert_ne!(page.value(pixels), before.0);

    // Scrubbing: the words are those of the snapshot.
    page.value("(s => { s.value = 4; s.dispatchEvent(new Event('input')); })(document.querySelector('#slider'))");
    settled(&mut page);
    let strain = format!("{:.2} % strain", run.snapshots()[4].sample.strain * 1e2);
    let now = page.value("document.querySelector('#now').textContent");
    assert!(now.as_str().unwrap().starts_with(&strain), "{now} instead of {strain}");
    assert!(now.as_str().unwrap().contains("Broken bonds: 0"), "{now}");

    // The first break in the table: wire, moment and place.
    page.value("document.querySelector('#breaks tbody button').click()");
    settled(&mut page);
    assert_eq!(page.value("explore.view.selected"), first.wire);
    let follow = page.value("explore.view.follow").as_f64().unwrap();
    assert!((follow - first.rest_z * 1e3).abs() < 1e-9);
    let chosen = page.value("document.querySelector('#chosen-text').textContent");
    assert!(chosen.as_str().unwrap().contains(&format!("true stress {:.0} MPa", first.stress * 1e-6)), "{chosen}");
    page.wait_for("String(document.querySelectorAll('#along path').length)", "3");
    assert!(page.value("document.querySelectorAll('#overlay .mark').length").as_u64() >= Some(1));
    keep(&mut page, "explore-break.png");

    // Without the outer layer other wires are seen.
    let before = page.value(pixels);
    page.value("document.querySelector('#layers input[data-layer=\"2\"]').click()");
    settled(&mut page);
    assert_eq!(page.value("explore.view.hidden_layers"), json!([2]));
    assert_ne!(page.value(pixels), before);
    // The section is moved.
    page.value("(s => { s.value = 75; s.dispatchEvent(new Event('input')); })(document.querySelector('#cut'))");
    settled(&mut page);
    assert!(page.value("document.querySelector('#cut-text').textContent").as_str().unwrap().contains("75"));
    // The command that makes the view.
    page.value("document.querySelector('#command').click()");
    page.wait_for("String(document.querySelector('#command-text').hidden)", "false");
    let command = page.value("document.querySelector('#command-text').textContent");
    assert!(command.as_str().unwrap().contains("hidden_layers = [2]"), "{command}");
    assert_eq!(page.complaints(), Vec::<Value>::new(), "the console has complaints");

    page.visit(&shown.address, "light");
    settled(&mut page);
    keep(&mut page, "explore-light.png");
    assert_eq!(page.complaints(), Vec::<Value>::new(), "the console has complaints");
}
