//! A real browser without a window, spoken to through the DevTools protocol over two pipes. It cannot reach any network
//! but this machine's own loopback.

// Each test program uses its own part of this.
#![allow(dead_code)]

use base64::Engine;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Names under which Chromium is installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
/// A browser that says nothing for so long has died.
const PATIENCE: Duration = Duration::from_secs(120);

/// The browser of this machine: the one that the variable BROWSER_FOR_TESTS names, or Chromium on the PATH.
pub fn find() -> Option<PathBuf> {
    if let Some(path) = std::env::var_os("BROWSER_FOR_TESTS") {
        return Some(path.into());
    }
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
}

/// A browser with one open page.
pub struct Browser {
    child: Child,
    input: ChildStdin,
    answers: Receiver<Value>,
    next: u64,
    session: Option<String>,
    complaints: Vec<Value>,
    _profile: tempfile::TempDir,
}

impl Browser {
    pub fn start(program: &Path) -> Self {
        let profile = tempfile::tempdir().expect("a folder for the browser's profile");
        // The protocol's pipes are file descriptors 3 and 4 of the browser, which only a shell can set.
        let mut child = Command::new("sh")
            .args(["-c", r#"exec "$0" "$@" 3<&0 4>&1 >/dev/null 2>&1"#])
            .arg(program)
            .args([
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                "--enable-unsafe-swiftshader",
                "--disable-dev-shm-usage",
                "--no-first-run",
            ])
            .args(["--remote-debugging-pipe", "--disable-background-networking", "--disable-component-update"])
            .args([
                "--proxy-server=127.0.0.1:9",
                "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
                "--window-size=1280,900",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a shell starts the browser");
        let input = child.stdin.take().expect("its input is a pipe");
        let output = BufReader::new(child.stdout.take().expect("its output is a pipe"));
        let (send, answers) = channel();
        std::thread::spawn(move || {
            for message in output.split(0).map_while(Result::ok) {
                let message = serde_json::from_slice(&message).expect("the browser speaks JSON");
                if send.send(message).is_err() {
                    break;
                }
            }
        });
        let mut browser =
            Self { child, input, answers, next: 0, session: None, complaints: Vec::new(), _profile: profile };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attached =
            browser.call("Target.attachToTarget", json!({ "targetId": target["targetId"], "flatten": true }));
        browser.session = attached["sessionId"].as_str().map(String::from);
        browser
    }

    /// Calls a method of the protocol and waits for its answer.
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.next += 1;
        let mut message = json!({ "id": self.next, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        self.input.write_all(format!("{message}\0").as_bytes()).expect("the browser listens");
        loop {
            let mut answer = self.answers.recv_timeout(PATIENCE).expect("the browser answers");
            if answer["id"] == json!(self.next) {
                assert!(answer["error"].is_null(), "{method}: {answer}");
                return answer["result"].take();
            }
            let error = match answer["method"].as_str() {
                Some("Runtime.exceptionThrown") => true,
                Some("Runtime.consoleAPICalled") => answer["params"]["type"] == "error",
                Some("Log.entryAdded") => answer["params"]["entry"]["level"] == "error",
                _ => false,
            };
            if error {
                self.complaints.push(answer["params"].take());
            }
        }
    }

    /// Opens a file and waits until its script says that it is ready. `scheme` is `light` or `dark`.
    pub fn open(&mut self, page: &Path, scheme: &str) {
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", json!({ "features": features }));
        self.size(1280, 900);
        self.call("Page.navigate", json!({ "url": format!("file://{}", page.display()) }));
        // There is no root element while the file is being read.
        self.wait_for("document.documentElement?.dataset.ready", "yes");
    }

    /// The same for an address on this machine, listening to what the page complains about.
    pub fn visit(&mut self, address: &str, scheme: &str) {
        self.call("Runtime.enable", json!({}));
        self.call("Log.enable", json!({}));
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", json!({ "features": features }));
        self.size(1440, 900);
        self.call("Page.navigate", json!({ "url": address }));
        self.wait_for("document.documentElement?.dataset.ready", "yes");
    }

    /// Lets the page save files into a folder.
    pub fn save_into(&mut self, folder: &Path) {
        self.call("Browser.setDownloadBehavior", json!({ "behavior": "allow", "downloadPath": folder }));
    }

    /// Errors in the page's console so far, since it was visited.
    pub fn complaints(&self) -> Vec<Value> {
        self.complaints.clone()
    }

    /// What the page breaks of the rules of accessibility of axe-core, whose script the variable AXE_FOR_TESTS names; `None`
    /// where it is not set.
    pub fn violations(&mut self) -> Option<Vec<String>> {
        let file = std::env::var_os("AXE_FOR_TESTS")?;
        let script = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        self.value(&format!("{script};void 0"));
        let found = self.value(
            "axe.run(document, { resultTypes: ['violations'] }).then(({ violations }) => violations.map(v => \
             `${v.id}: ${v.help}: ${v.nodes.map(n => n.html.slice(0, 160) + ' ' + n.failureSummary).join(' | ')}`))",
        );
        Some(serde_json::from_value(found).expect("a list"))
    }

    pub fn size(&mut self, width: u32, height: u64) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    /// The value of an expression in the page.
    pub fn value(&mut self, expression: &str) -> Value {
        let asked = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let mut answer = self.call("Runtime.evaluate", asked);
        assert!(answer["exceptionDetails"].is_null(), "{expression}: {answer}");
        answer["result"]["value"].take()
    }

    /// Waits until an expression has a value.
    pub fn wait_for(&mut self, expression: &str, value: &str) {
        let start = Instant::now();
        while self.value(expression) != value {
            assert!(start.elapsed() < PATIENCE, "{expression} never became {value}: {}", self.value(expression));
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Presses and releases a key.
    pub fn press(&mut self, key: &str) {
        for kind in ["rawKeyDown", "keyUp"] {
            let code = if key == "ArrowLeft" { 37 } else { 39 };
            let event = json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// Moves the mouse over an element, to a place in it given as shares of its width and height.
    pub fn point_at(&mut self, selector: &str, [right, down]: [f64; 2]) {
        let element = format!("document.querySelector('{selector}')");
        self.value(&format!("{element}.scrollIntoView({{ block: 'center', behavior: 'instant' }})"));
        let corner = self.value(&format!("(r => [r.x, r.y, r.width, r.height])({element}.getBoundingClientRect())"));
        let corner = |k: usize| corner[k].as_f64().expect("a number");
        let (x, y) = (corner(0) + right * corner(2), corner(1) + down * corner(3));
        self.call("Input.dispatchMouseEvent", json!({ "type": "mouseMoved", "x": x, "y": y }));
    }

    /// Drags with the mouse from one place in an element to another, given as shares of its width and height.
    pub fn drag(&mut self, selector: &str, from: [f64; 2], to: [f64; 2]) {
        let element = format!("document.querySelector('{selector}')");
        let corner = self.value(&format!("(r => [r.x, r.y, r.width, r.height])({element}.getBoundingClientRect())"));
        let corner = |k: usize| corner[k].as_f64().expect("a number");
        let at = |share: f64| {
            let [right, down] = [0, 1].map(|k| from[k] + share * (to[k] - from[k]));
            (corner(0) + right * corner(2), corner(1) + down * corner(3))
        };
        let mut event = |kind: &str, share: f64, buttons: u32| {
            let (x, y) = at(share);
            let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1 });
            self.call("Input.dispatchMouseEvent", event);
        };
        event("mousePressed", 0.0, 1);
        for step in 1..=10 {
            event("mouseMoved", f64::from(step) / 10.0, 1);
        }
        event("mouseReleased", 1.0, 0);
    }

    /// Keeps a picture of the whole page.
    pub fn screenshot(&mut self, file: &Path) {
        let height = self.value("document.documentElement.scrollHeight").as_u64().expect("a height");
        let width = self.value("document.documentElement.clientWidth").as_u64().expect("a width");
        self.size(width as u32, height);
        let asked = json!({ "format": "png", "captureBeyondViewport": true });
        let picture = self.call("Page.captureScreenshot", asked);
        let data = picture["data"].as_str().expect("a picture");
        let bytes = base64::engine::general_purpose::STANDARD.decode(data).expect("base64");
        std::fs::write(file, bytes).expect("the picture can be kept");
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Its own children end with it.
        let _ = self.input.write_all(b"{\"id\":0,\"method\":\"Browser.close\"}\0");
        let start = Instant::now();
        while matches!(self.child.try_wait(), Ok(None)) && start.elapsed() < Duration::from_secs(10) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
