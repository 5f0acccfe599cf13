//! Who is let in, and what a page that misbehaves can do.

use crate::shown::{PATIENCE, SIZE, Shown, close_up, next_picture, next_words, say, status};
use serde_json::json;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::Message;

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
    let more = ["{\"pace\":\"fly\"}", "{\"stop\":1}", "{\"film\":{}}", "{\"history\":-1}", "{\"no-film\":0}"];
    texts.extend(more.map(String::from));
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
    for (seconds, count, word) in
        [(2.0, 1, "2 to 64"), (2.0, 200, "2 to 64"), (1e300, 2, "0.1 to 60 s"), (60.0, 5, "180 s")]
    {
        for ask in ["film", "film-command"] {
            let views = vec![json!({ "state": 1 }); count];
            say(&mut socket, json!({ ask: { "size": SIZE, "seconds": seconds, "views": views } }));
            let words = next_words(&mut socket, "error");
            assert!(words.as_str().unwrap().contains(word), "{words}");
        }
    }
    say(
        &mut socket,
        json!({ "film": { "size": [9000, 9000], "seconds": 1, "views": [close_up(1.0), close_up(2.0)] } }),
    );
    assert!(next_words(&mut socket, "error").as_str().unwrap().contains("pixels"));
    say(&mut socket, json!({ "history": 99 }));
    assert!(next_words(&mut socket, "history").is_null(), "there is no such wire");
    // A run that is over cannot be held or stopped.
    for ask in [json!({ "pace": "held" }), json!({ "stop": null }), json!({ "no-film": null })] {
        say(&mut socket, ask);
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
