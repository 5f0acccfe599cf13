//! A scene of imported wires, with comments on what was found.

use super::imported::Imported;
use super::wording;
use crate::base::units;
use crate::base::wording::counted;
use crate::scene::builtin;
use std::path::Path;
use toml_edit::DocumentMut;

/// Rate of strain of the shipped scenes (1/s): 2.5 m/s on 50 mm.
const STRAIN_RATE: f64 = 50.0;
/// Length of a grip over that of the wires along z, and over the greatest diameter (-).
const GRIP: [f64; 2] = [0.08, 4.0];
/// Greatest length of a grip over that of the wires (-).
const LONGEST_GRIP: f64 = 0.25;

/// The shipped scene whose material, bonds and contacts are taken: annealed copper.
const COPPER: &str = "strand-1x7";

/// The scene. `source` is the file that was read, `points` the one that holds the wires, as the scene names it.
pub fn scene(found: &Imported, source: &Path, points: &str) -> String {
    let file = source.file_name().unwrap_or_default().to_string_lossy();
    let mut text = String::new();
    let mut comment = |line: &str| {
        // A name may hold anything; a comment ends with its line.
        let line: String = line.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        text.push_str(format!("# {line}").trim_end());
        text.push('\n');
    };
    wording::report(found, Path::new(&*file)).iter().for_each(|line| comment(line));
    wording::unread(&found.unread).iter().for_each(|line| comment(&format!("NOT USED: {line}")));
    wording::forks(found).iter().for_each(|line| comment(&format!("NOT JOINED: {line}")));
    let about = format!("{} imported from {file}.", counted(found.wires.len(), "wire"));
    text.push_str(&format!("about = {}\nseed = 1\nspacing = 1.0\n{}", quoted(&about), copper()));
    text.push_str(&format!("\n[[wire]]\nfile = {}\nall = true\n", quoted(points)));
    text.push_str(&held(found));
    text
}

/// Material, bonds and contacts, of smooth wires: what those do does not depend on where particles lie.
fn copper() -> String {
    let text = builtin::find(COPPER).expect("the scene is shipped");
    let mut scene: DocumentMut = text.parse().expect("shipped scenes are TOML");
    scene.retain(|key, _| ["material", "bond", "contact"].contains(&key));
    scene["contact"]["shape"] = toml_edit::value("wire");
    format!(
        "\n# No drawing says what wires are made of. This is annealed copper, as in `strandsnap scene show {COPPER}`: put in your \
         own.\n{}\n",
        scene.to_string().trim()
    )
}

/// Grips and an end, where wires run along z.
fn held(found: &Imported) -> String {
    let heights = found.wires.iter().flat_map(|wire| wire.points.iter().map(|point| point.z));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
    let (length, runs_along_z) =
        (high - low, found.is_moved || found.axis.is_some_and(|axis| axis.direction.z > 0.999_999));
    if !runs_along_z || length <= 0.0 {
        return "\n# Grips hold along z, and these wires do not run along it: say yourself what holds and pulls them.\n\
                [stop]\ntime = \"10 us\"\n"
            .into();
    }
    let thickest = found.wires.iter().filter_map(|wire| wire.diameter).fold(0.0, f64::max);
    let grip = (GRIP[0] * length).max(GRIP[1] * thickest).min(LONGEST_GRIP * length);
    let speed = STRAIN_RATE * (length - 2.0 * grip);
    let short = |value: f64| format!("{value:.2e}").parse().unwrap_or(value);
    format!(
        "\n[grip]\nkind = \"all\"\nlength = {}\nspeed = {} # 50 per second of strain, as in the shipped scenes\n\n\
         [stop]\nstress_fraction = \"50 %\"\nstrain = \"40 %\"\n",
        quoted(&format!("{} mm", wording::millimetres(short(grip)))),
        quoted(&format!("{} m/s", units::shortest(short(speed)))),
    )
}

/// Text as TOML writes it.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
