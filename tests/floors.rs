//! The order of the floors, the homes of the two heavy libraries, circles of imports, and the length of files, read from the sources.
//! See `strandsnap::manual::architecture`: a file imports only from floors above its own in [`FLOORS`].

#[path = "floors/circles.rs"]
mod circles;
#[path = "floors/optimised.rs"]
mod optimised;

use std::fs;
use std::path::{Path, PathBuf};

/// Floors from the ground up. Those in one row do not see each other.
const FLOORS: [&[&str]; 13] = [
    &["base"],
    &["law", "reference"],
    &["scene"],
    &["strand"],
    &["engine"],
    &["observe"],
    &["render", "gpu"],
    &["run"],
    &["page", "export", "import"],
    &["study"],
    &["explore"],
    &["cli"],
    &["manual"],
];

/// Files may not be longer than this many lines.
const LONGEST: usize = 600;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every file below `folder` with one of these extensions, sorted.
fn files(folder: &str, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for path in entries.map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| extensions.iter().any(|x| e == *x)) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The text without comments: they may name anything.
fn code(text: &str) -> String {
    text.lines().map(|line| line.split_once("//").map_or(line, |(code, _)| code)).collect::<Vec<_>>().join("\n")
}

fn height(floor: &str) -> Option<usize> {
    FLOORS.iter().position(|row| row.contains(&floor))
}

/// Floor of a source file: the first part of its path below `src`; `None` for `lib.rs` and `main.rs`.
fn floor_of(path: &str) -> Option<&str> {
    let first = path.split('/').next()?;
    let name = first.strip_suffix(".rs").unwrap_or(first);
    (!["lib", "main"].contains(&name)).then_some(name)
}

/// First parts of all `crate::…` paths in a text, also of grouped ones: `crate::{a::b, c}` gives a and c.
fn imports(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, marker) in code.match_indices("crate::") {
        let whole_word = !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$');
        let rest = &code[at + marker.len()..];
        match rest.strip_prefix('{') {
            _ if !whole_word => {}
            Some(group) => found.extend(group_heads(group)),
            None => found.push(word(rest)),
        }
    }
    found
}

/// First words of the top entries of a `{…}` group whose opening brace is already taken.
fn group_heads(group: &str) -> Vec<String> {
    let (mut depth, mut start) = (0, true);
    let mut heads = Vec::new();
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => start = true,
            c if start && !c.is_whitespace() => {
                heads.push(word(&group[at..]));
                start = false;
            }
            _ => {}
        }
    }
    heads
}

fn word(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// What is wrong with the imports of a file at `path` below `src`.
fn upward_imports(path: &str, text: &str) -> Vec<String> {
    let Some(own) = floor_of(path) else { return Vec::new() };
    let Some(here) = height(own) else { return vec![format!("{path}: no floor is called {own}")] };
    imports(&code(text))
        .into_iter()
        .filter(|there| there != own && height(there).is_none_or(|there| there >= here))
        .map(|there| format!("{path} ({own}) imports {there}"))
        .collect()
}

/// Whether code names a library as a path: `name::…` or `use name`.
fn names_library(code: &str, library: &str) -> bool {
    code.match_indices(library).any(|(at, _)| {
        let before = &code[..at];
        let alone = !before.ends_with(|c: char| c.is_alphanumeric() || "_:/\"-`+".contains(c));
        let after = &code[at + library.len()..];
        let is_path = after.starts_with("::") && !after.starts_with(":://");
        let is_use = before.ends_with("use ") && after.starts_with([';', ' ', ',']);
        alone && (is_path || is_use)
    })
}

/// Below `src`, but not a floor: the Python package, a crate of its own that has this one as a library.
const OTHER_CRATE: &str = "python/";

fn sources() -> Vec<(String, String)> {
    let src = root().join("src");
    let read = |path: PathBuf| {
        let name = path.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/");
        (name, fs::read_to_string(&path).unwrap())
    };
    let all: Vec<_> =
        files("src", &["rs"]).into_iter().map(read).filter(|(path, _)| !path.starts_with(OTHER_CRATE)).collect();
    assert!(all.len() > 10, "the sources were not found");
    all
}

#[test]
fn nothing_imports_upward() {
    let wrong: Vec<String> = sources().iter().flat_map(|(path, text)| upward_imports(path, text)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn heavy_libraries_stay_at_home() {
    let mut wrong = Vec::new();
    for (path, text) in sources() {
        let code = code(&text);
        for (library, homes) in [("rerun", &["observe/recording"][..]), ("wgpu", &["render/", "gpu/"])] {
            if names_library(&code, library) && !homes.iter().any(|home| path.starts_with(home)) {
                wrong.push(format!("{path} names {library}, whose home is {}", homes.join(" or ")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_file_is_too_long() {
    let mut wrong = Vec::new();
    for folder in ["src", "tests", "examples", "benches"] {
        for path in files(folder, &["rs", "wgsl", "py", "pyi"]) {
            let lines = fs::read_to_string(&path).unwrap().lines().count();
            if lines > LONGEST {
                wrong.push(format!("{} has {lines} lines", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "at most {LONGEST} lines:\n{}", wrong.join("\n"));
}

/// Comparisons of text with a sentence (words with a space between) in code that is no test: what the program decides by
/// must be a value, not its own English.
fn prose_read_back(text: &str) -> Vec<String> {
    let code = code(text.split("#[cfg(test)]").next().unwrap_or_default());
    let mut found = Vec::new();
    let ways = ["contains(\"", "starts_with(\"", "ends_with(\"", "strip_prefix(\"", "find(\"", "== \"", "!= \""];
    for way in ways {
        for (at, _) in code.match_indices(way) {
            let literal = code[at + way.len()..].split('"').next().unwrap_or_default();
            let words =
                literal.split(' ').filter(|word| word.chars().filter(|c| c.is_alphabetic()).count() > 1).count();
            if words > 1 {
                found.push(format!("{way}{literal}\""));
            }
        }
    }
    found.extend(code.matches(".to_string() ==").map(str::to_owned));
    found
}

#[test]
fn nothing_decides_by_its_own_words() {
    // What serde says about a scene has no other form than its sentence; Linux names a processor's model so.
    let foreign = ["scene/mod.rs", "run/devices.rs"];
    let wrong: Vec<String> = sources()
        .iter()
        .filter(|(path, _)| !foreign.contains(&path.as_str()) && !path.ends_with("tests.rs"))
        .flat_map(|(path, text)| prose_read_back(text).into_iter().map(move |what| format!("{path}: {what}")))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_scan_itself_sees_what_it_should() {
    assert_eq!(upward_imports("law/a.rs", "use crate::base::error::Result;"), Vec::<String>::new());
    assert_eq!(upward_imports("law/a.rs", "use crate::law::b;"), Vec::<String>::new());
    assert_eq!(upward_imports("law/a.rs", "use crate::engine::Engine;").len(), 1);
    assert_eq!(upward_imports("law/a.rs", "use crate::reference::beam;").len(), 1);
    assert_eq!(upward_imports("law.rs", "let x = crate::run::run();").len(), 1);
    assert_eq!(upward_imports("scene/a.rs", "use crate::{base::{x, engine}, law, run};").len(), 1);
    assert_eq!(upward_imports("scene/a.rs", "// use crate::run;"), Vec::<String>::new());
    assert_eq!(upward_imports("elsewhere/a.rs", "").len(), 1);
    assert_eq!(upward_imports("lib.rs", "pub use crate::run;"), Vec::<String>::new());
    assert!(names_library("let d = wgpu::Device;", "wgpu"));
    assert!(names_library("use rerun;", "rerun"));
    assert!(!names_library("\"open it with rerun file.rrd\"", "rerun"));
    assert!(!names_library("[\"rerun+http://x\"]", "rerun"));
    assert_eq!(prose_read_back("if text.contains(\"of the radius deep\") {}").len(), 1);
    assert_eq!(prose_read_back("if reason == \"stress fell\" {}").len(), 1);
    assert_eq!(prose_read_back("if head.ends_with(\"_mm\") || a.to_string() == b {}").len(), 1);
    assert_eq!(prose_read_back("#[cfg(test)]\nif text.contains(\"of the radius\") {}"), Vec::<String>::new());
}
