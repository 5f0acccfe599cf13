//! As much of HTTP as one page needs: GET requests for a few fixed names, one on each connection, and whether they may
//! be answered.

use std::io::{ErrorKind, Read, Write};
use std::net::{IpAddr, TcpStream};
use std::time::{Duration, Instant};

/// Longest head of a request (bytes); browsers send less than two thousand.
const LONGEST_HEAD: usize = 8 << 10;
/// Most headers of a request.
const MOST_HEADERS: usize = 64;
/// Time for a whole head to come. Browsers send it at once; connections that they open to have them ready may wait in vain.
const HEAD_TIME: Duration = Duration::from_secs(2);

/// Why a request is not answered with what it asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// It cannot be read.
    Malformed,
    /// Its head is longer than any browser's.
    TooLong,
    /// It is no GET.
    Method,
    /// It comes from another site, or by another name of this machine.
    Site,
    /// It does not know the token.
    Token,
    /// There is nothing by this name.
    Name,
    /// Too many connections are open.
    Busy,
}

impl Refusal {
    /// Status line and words.
    pub fn status(self) -> (&'static str, &'static str) {
        match self {
            Self::Malformed => ("400 Bad Request", "This is no request that can be read."),
            Self::TooLong => ("431 Request Header Fields Too Large", "This request is too long."),
            Self::Method => ("405 Method Not Allowed", "Only GET is answered."),
            Self::Site => {
                ("403 Forbidden", "This comes from another site, or by a name that this address does not have.")
            }
            Self::Token => ("403 Forbidden", "Open the whole address that strandsnap printed: it carries a token."),
            Self::Name => ("404 Not Found", "There is nothing by this name."),
            Self::Busy => ("503 Service Unavailable", "Too many connections are open."),
        }
    }
}

/// A request's head.
#[derive(Debug, Default, PartialEq)]
pub struct Request {
    /// What is asked for, without its query.
    pub path: String,
    /// The token in the query.
    pub token: Option<String>,
    /// Name and port by which this machine was called.
    pub host: String,
    /// The site whose page asks.
    pub origin: Option<String>,
    /// What the browser says of where the request comes from.
    pub fetch_site: Option<String>,
    /// Everything that the browser keeps for this address.
    pub cookie: String,
    /// The key of a socket that is to be opened.
    pub socket_key: Option<String>,
    /// What came after the head.
    pub rest: Vec<u8>,
}

/// Reads the head of a request.
///
/// # Errors
/// A [`Refusal`]; `None` when the other side went away or said nothing.
pub fn read(stream: &mut TcpStream) -> Result<Request, Option<Refusal>> {
    let begin = Instant::now();
    let mut bytes = Vec::new();
    loop {
        let left = HEAD_TIME.checked_sub(begin.elapsed()).filter(|left| !left.is_zero()).ok_or(None)?;
        stream.set_read_timeout(Some(left)).map_err(|_| None)?;
        let mut part = [0; 2048];
        match stream.read(&mut part) {
            Ok(0) => return Err(None),
            Ok(count) => bytes.extend_from_slice(&part[..count]),
            Err(e) if e.kind() == ErrorKind::Interrupted => continue,
            Err(_) => return Err(None),
        }
        if let Some(request) = parse(&bytes).map_err(Some)? {
            return Ok(request);
        }
    }
}

/// The request in `bytes`; `None` while its head has not come whole.
fn parse(bytes: &[u8]) -> Result<Option<Request>, Refusal> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut head = httparse::Request::new(&mut headers);
    let length = match head.parse(bytes) {
        Ok(httparse::Status::Complete(length)) if length <= LONGEST_HEAD => length,
        Ok(httparse::Status::Partial) if bytes.len() <= LONGEST_HEAD => return Ok(None),
        Ok(_) | Err(httparse::Error::TooManyHeaders) => return Err(Refusal::TooLong),
        Err(_) => return Err(Refusal::Malformed),
    };
    if head.method != Some("GET") {
        return Err(Refusal::Method);
    }
    let mut request = Request { rest: bytes[length..].to_vec(), ..Request::default() };
    let (path, query) = head.path.map(|path| path.split_once('?').unwrap_or((path, ""))).ok_or(Refusal::Malformed)?;
    request.path = path.into();
    request.token = query.split('&').find_map(|pair| pair.strip_prefix("token=")).map(String::from);
    let mut hosts = 0;
    for header in head.headers.iter() {
        let value = std::str::from_utf8(header.value).map_err(|_| Refusal::Malformed)?.trim();
        match header.name.to_ascii_lowercase().as_str() {
            "host" => {
                hosts += 1;
                request.host = value.into();
            }
            "origin" => request.origin = Some(value.into()),
            "sec-fetch-site" => request.fetch_site = Some(value.into()),
            "sec-websocket-key" => request.socket_key = Some(value.into()),
            "cookie" => {
                request.cookie.push_str(value);
                request.cookie.push(';');
            }
            // A body would be read as the next request by something in between.
            "content-length" | "transfer-encoding" if value != "0" => return Err(Refusal::Malformed),
            _ => {}
        }
    }
    if hosts == 1 { Ok(Some(request)) } else { Err(Refusal::Malformed) }
}

impl Request {
    /// Whether the request may come from the page itself, or from a person who opens it. A name under which another site
    /// could reach this machine (DNS rebinding) is refused: only `localhost` and addresses in numbers are taken, and of
    /// those only loopback ones unless `bound` is another address.
    ///
    /// # Errors
    /// [`Refusal::Site`].
    pub fn check_site(&self, bound: IpAddr) -> Result<(), Refusal> {
        let (name, _) = split_port(&self.host);
        let known = match name.trim_matches(['[', ']']).parse::<IpAddr>() {
            Ok(address) => address.is_loopback() || !bound.is_loopback(),
            Err(_) => name.eq_ignore_ascii_case("localhost"),
        };
        let own = format!("http://{}", self.host);
        let same = self.origin.as_ref().is_none_or(|origin| *origin == own);
        if known && same { Ok(()) } else { Err(Refusal::Site) }
    }

    /// Whether a part of the page, or its socket, is asked for by the page.
    pub fn comes_from_the_page(&self) -> bool {
        self.fetch_site.as_deref().is_none_or(|site| site == "same-origin")
    }

    /// Whether the browser was given the token.
    pub fn has_cookie(&self, name: &str, token: &str) -> bool {
        self.cookie.split(';').filter_map(|pair| pair.trim().split_once('=')).any(|(n, v)| n == name && same(v, token))
    }
}

/// Whether two texts are the same, in a time that does not tell how much of them is.
pub fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |all, (a, b)| all | (a ^ b)) == 0
}

/// Name and port; an IPv6 address keeps its brackets.
fn split_port(host: &str) -> (&str, &str) {
    match host.rsplit_once(':') {
        Some((name, port)) if !port.contains(']') => (name, port),
        _ => (host, ""),
    }
}

/// Answers a request and ends the connection. Nothing of the answer may be kept, framed or used by another site.
///
/// # Errors
/// When the other side has gone.
pub fn respond(stream: &mut TcpStream, status: &str, kind: &str, more: &str, body: &[u8]) -> std::io::Result<()> {
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
         Cross-Origin-Opener-Policy: same-origin\r\n{more}\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body)?;
    stream.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(head: &str) -> Result<Option<Request>, Refusal> {
        parse(head.replace('\n', "\r\n").as_bytes())
    }

    #[test]
    fn heads_are_read() {
        let text = "GET /data?a=1&token=12ab HTTP/1.1\nHost: localhost:80\nOrigin: http://localhost:80\nCookie: a=b; c=d\n\nrest";
        let r = request(text).unwrap().unwrap();
        assert_eq!((r.path.as_str(), r.token.as_deref(), r.host.as_str()), ("/data", Some("12ab"), "localhost:80"));
        assert!(r.has_cookie("c", "d") && r.has_cookie("a", "b") && !r.has_cookie("c", "e") && !r.has_cookie("b", "d"));
        assert_eq!(r.rest, b"rest");
        assert_eq!(request("GET / HTTP/1.1\nHost: x\n"), Ok(None));
    }

    #[test]
    fn what_no_browser_sends_is_refused() {
        for (text, refusal) in [
            ("POST / HTTP/1.1\nHost: x\n\n", Refusal::Method),
            ("GET / HTTP/1.1\n\n", Refusal::Malformed),
            ("GET / HTTP/1.1\nHost: a\nHost: b\n\n", Refusal::Malformed),
            ("GET / HTTP/1.1\nHost: a\nContent-Length: 5\n\n", Refusal::Malformed),
            ("GET / HTTP/1.1\nHost: a\nTransfer-Encoding: chunked\n\n", Refusal::Malformed),
            ("\u{1}\u{2}\u{3}\n\n", Refusal::Malformed),
        ] {
            assert_eq!(request(text), Err(refusal), "{text}");
        }
        assert_eq!(request(&format!("GET /{} HTTP/1.1\n", "a".repeat(9000))), Err(Refusal::TooLong));
        let headers = "A: b\n".repeat(100);
        assert_eq!(request(&format!("GET / HTTP/1.1\nHost: a\n{headers}\n")), Err(Refusal::TooLong));
    }

    #[test]
    fn only_the_machines_own_names_are_known() {
        let loopback: IpAddr = "127.0.0.1".parse().unwrap();
        let open: IpAddr = "0.0.0.0".parse().unwrap();
        let check = |host: &str, origin: Option<&str>, bound| {
            Request { host: host.into(), origin: origin.map(String::from), ..Request::default() }
                .check_site(bound)
                .is_ok()
        };
        for host in ["127.0.0.1:4000", "localhost:80", "localhost", "[::1]:4000", "LocalHost:1"] {
            assert!(check(host, None, loopback), "{host}");
            assert!(check(host, Some(&format!("http://{host}")), loopback), "{host}");
        }
        for host in
            ["example.org:4000", "127.0.0.1.example.org", "10.0.0.1:4000", "", "localhost.example.org:80", ":80"]
        {
            assert!(!check(host, None, loopback), "{host}");
        }
        assert!(check("10.0.0.1:4000", None, open) && !check("example.org:4000", None, open));
        for origin in ["http://example.org", "null", "https://127.0.0.1:4000", "http://127.0.0.1:4001"] {
            assert!(!check("127.0.0.1:4000", Some(origin), loopback), "{origin}");
        }
    }
}
