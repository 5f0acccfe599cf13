//! Dependencies are compiled without optimisation, which halves the time of a full build, but for those that Cargo.toml
//! lists because they handle bulk data. Whoever adds a dependency decides which it is.

use std::collections::BTreeSet;

/// Dependencies that may be slow.
const COLD: [(&str, &[&str]); 9] = [
    (
        "reads or writes a few kB per run",
        &["miette", "schemars", "serde_json", "strsim", "thiserror", "shiguredo_mp4", "toml", "toml_edit"],
    ),
    ("is generic: compiled with our own code", &["nalgebra", "levenberg-marquardt", "postcard", "serde", "uom"]),
    ("describes a table once", &["arrow-schema"]),
    ("calls the system", &["ctrlc", "pollster", "rustix", "signal-hook", "tempfile"]),
    ("talks to people", &["clap", "clap_complete", "clap_mangen", "indicatif", "textwrap"]),
    ("makes a page or a plot in a second at most", &["base64", "colorous", "maud", "plotters"]),
    ("is called a few times per study", &["statrs"]),
    ("is called a few times per message of a browser", &["getrandom", "httparse", "tungstenite"]),
    ("what is bulk in it lies in libraries of its own, which are listed", &["rerun", "wgpu"]),
];

#[test]
fn every_dependency_is_optimised_or_known_to_be_cold() {
    let text = std::fs::read_to_string(super::root().join("Cargo.toml")).unwrap();
    let manifest: toml::Table = text.parse().unwrap();
    let names = |table: &toml::Value| -> BTreeSet<String> { table.as_table().unwrap().keys().cloned().collect() };
    let mut used = names(&manifest["dependencies"]);
    for target in manifest["target"].as_table().unwrap().values() {
        used.extend(names(&target["dependencies"]));
    }
    let profile = manifest["profile"]["release"]["package"].as_table().unwrap();
    // "name@version" where several versions of a package are compiled.
    let named = |key: &str, name: &str| key.split('@').next() == Some(name);
    let level = |name: &str| {
        let settings = profile.iter().find(|(key, _)| named(key, name));
        settings.map_or(0, |(_, settings)| settings["opt-level"].as_integer().unwrap())
    };
    let cold: BTreeSet<String> = COLD.iter().flat_map(|(_, names)| names.iter().map(|name| name.to_string())).collect();
    let slow: BTreeSet<String> = used.iter().filter(|name| level(name) < 2).cloned().collect();
    assert_eq!(
        slow, cold,
        "left: dependencies that Cargo.toml compiles without optimisation; right: those that COLD names, with why. A new \
         one gets opt-level = 3 under [profile.release.package.NAME], or its place in COLD"
    );
}
