//! Files that import each other, directly or through others, cannot be understood or moved one at a time. A file imports
//! another when it names something in it by a path, also through a `pub use`; to declare it with `mod` is no import.

use super::{code, sources};
use std::collections::{BTreeMap, BTreeSet};

type Module = Vec<String>;

#[test]
fn no_files_import_each_other_in_a_circle() {
    let files: Vec<(Module, String)> =
        sources().iter().map(|(path, text)| (module(path), without_tests(&code(text)).to_owned())).collect();
    let names: BTreeSet<Module> = files.iter().map(|(name, _)| name.clone()).collect();
    let graph = files.iter().map(|(name, text)| (name.clone(), imported(name, text, &names))).collect();
    let circles: Vec<String> = circles(&graph)
        .iter()
        .map(|circle| circle.iter().map(|file| file.join("::")).collect::<Vec<_>>().join(", "))
        .collect();
    assert!(circles.is_empty(), "these files import each other in a circle:\n{}", circles.join("\n\n"));
}

/// Path of the module in a file: `a/b/mod.rs` and `a/b.rs` are a::b.
fn module(path: &str) -> Module {
    let path = path.strip_suffix(".rs").unwrap_or(path);
    let mut parts: Module = path.split('/').map(str::to_owned).collect();
    if parts.last().is_some_and(|last| last == "mod" || last == "lib") {
        parts.pop();
    }
    parts
}

fn without_tests(code: &str) -> &str {
    code.find("#[cfg(test)]\nmod tests").map_or(code, |at| &code[..at])
}

/// Modules that a file imports from.
fn imported(own: &Module, code: &str, names: &BTreeSet<Module>) -> BTreeSet<Module> {
    let mut found = BTreeSet::new();
    for path in paths(code) {
        let mut parts: Vec<&str> = path.split("::").map(str::trim).collect();
        let mut full = match parts[0] {
            "crate" => Module::new(),
            "super" | "self" => own.clone(),
            // Of another library, or of a module below.
            _ if names.contains(&[own.clone(), vec![parts[0].to_owned()]].concat()) => own.clone(),
            _ => continue,
        };
        while matches!(parts.first(), Some(&"crate" | &"self" | &"super")) {
            if parts.remove(0) == "super" {
                full.pop();
            }
        }
        full.extend(parts.into_iter().map(str::to_owned));
        while !names.contains(&full) && !full.is_empty() {
            full.pop();
        }
        if full != *own && !full.is_empty() {
            found.insert(full);
        }
    }
    found
}

/// Paths that code names: those of `use` trees, and `a::b` anywhere else.
fn paths(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(at) = next_use(rest) {
        found.extend(plain_paths(&rest[..at]));
        let (tree, after) = rest[at + 4..].split_once(';').unwrap_or((&rest[at + 4..], ""));
        expand("", tree.trim(), &mut found);
        rest = after;
    }
    found.extend(plain_paths(rest));
    found
}

/// Place of the next `use`; the word may stand in a text too, where no path follows up to a semicolon.
fn next_use(code: &str) -> Option<usize> {
    let is_tree = |c: char| c.is_alphanumeric() || c.is_whitespace() || "_:{},*".contains(c);
    code.match_indices("use ").map(|(at, _)| at).find(|at| {
        let alone = code[..*at].is_empty() || code[..*at].ends_with(|c: char| c.is_whitespace());
        alone && code[at + 4..].split_once(';').is_some_and(|(tree, _)| tree.chars().all(is_tree))
    })
}

fn plain_paths(code: &str) -> Vec<String> {
    let words = code.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
    words.filter(|word| word.contains("::") && !word.starts_with(':')).map(str::to_owned).collect()
}

/// `a::{b, c::{d, e}}` as a::b, a::c::d, a::c::e.
fn expand(before: &str, tree: &str, found: &mut Vec<String>) {
    let Some(at) = tree.find('{') else {
        let path = tree.split(" as ").next().unwrap_or(tree);
        found.push(format!("{before}{}", path.trim()));
        return;
    };
    let before = format!("{before}{}", tree[..at].trim());
    let inner = &tree[at + 1..tree.rfind('}').unwrap_or(tree.len())];
    let (mut depth, mut from) = (0, 0);
    for (at, c) in inner.char_indices().chain([(inner.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                let entry = inner[from..at].trim();
                if !entry.is_empty() {
                    expand(&before, entry, found);
                }
                from = at + 1;
            }
            _ => {}
        }
    }
}

/// Sets of more than one file that all reach each other.
fn circles(graph: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<Vec<Module>> {
    let reach: BTreeMap<&Module, BTreeSet<&Module>> = graph.keys().map(|from| (from, reached(graph, from))).collect();
    let mut circles: Vec<Vec<Module>> = Vec::new();
    for from in graph.keys().filter(|from| reach[from].contains(from)) {
        if !circles.iter().any(|circle| circle.contains(from)) {
            let both = |to: &&&Module| reach.get(**to).is_some_and(|back| back.contains(from));
            circles.push(reach[from].iter().filter(both).map(|to| (*to).clone()).collect());
        }
    }
    circles
}

fn reached<'a>(graph: &'a BTreeMap<Module, BTreeSet<Module>>, from: &Module) -> BTreeSet<&'a Module> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&Module> = graph[from].iter().collect();
    while let Some(next) = open.pop() {
        if found.insert(next) {
            open.extend(graph.get(next).into_iter().flatten());
        }
    }
    found
}

#[test]
fn the_scan_sees_circles() {
    let names: BTreeSet<Module> = ["a", "a/b", "a/b/c", "d"].map(module).into();
    let of = |own: &str, text: &str| imported(&module(own), text, &names);
    let set = |paths: &[&str]| -> BTreeSet<Module> { paths.iter().map(|path| module(path)).collect() };
    assert_eq!(module("a/b/mod.rs"), module("a/b.rs"));
    assert_eq!(of("a/b", "use crate::d::Thing;\nfn f() { super::other(); }"), set(&["d", "a"]));
    assert_eq!(of("a", "mod b;\nuse b::c::{Inner, Other as O};"), set(&["a/b/c"]));
    assert_eq!(of("a", "mod b;\nfn f() { b::go() }"), set(&["a/b"]));
    assert_eq!(of("d", "use crate::{a::{b::X, Y}, d::Z};\nuse std::a::b;"), set(&["a/b", "a"]));
    assert_eq!(of("a/b/c", "use super::super::Top;"), set(&["a"]));
    let graph = |edges: &[(&str, &[&str])]| edges.iter().map(|(from, to)| (module(from), set(to))).collect();
    assert!(circles(&graph(&[("a", &["a/b", "d"]), ("a/b", &["d"]), ("d", &[])])).is_empty());
    let round = circles(&graph(&[("a/b", &["a/b/c"]), ("a/b/c", &["d", "a/b"]), ("d", &[])]));
    assert_eq!(round, [vec![module("a/b"), module("a/b/c")]]);
}
