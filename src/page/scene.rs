//! The scene as it was run, what it cost and with what it was made.

use super::section::Section;
use super::source::Source;
use crate::base::error::Result;
use crate::base::units::ms;
use maud::{Markup, html};

/// Cost, versions, and the resolved scene, folded.
pub fn section(source: &Source) -> Result<Section> {
    let body = html! {
        div.pair { (cost(source)) (versions(source)) }
        @match &source.scene {
            Some(text) => details {
                summary { "The resolved scene, every default filled in (" code { "scene.toml" } ")" }
                pre tabindex="0" { (text) }
            },
            None => p { "The scene is not known: " code { "scene.toml" } " is missing from the run's folder." },
        }
    };
    Ok(Section { id: "scene", title: "Scene, cost and versions", body })
}

fn cost(source: &Source) -> Markup {
    html! {
        table {
            caption { "What the run was and what it cost" }
            tbody { @for (name, value) in facts(source) { tr { th { (name) } td.number { (value) } } } }
        }
    }
}

fn facts(source: &Source) -> Vec<(&'static str, String)> {
    let s = &source.summary;
    let mut facts = vec![
        ("id of the run", source.origin.run.to_string()),
        ("wires", source.info.wires.len().to_string()),
        ("particles", s.particles.to_string()),
        ("bonds", s.bonds.to_string()),
        ("seed of the scatter", s.seed.to_string()),
        ("factor on mass", s.mass_scale.to_string()),
        ("factor on rotational inertia", s.inertia_scale.to_string()),
        ("steps", s.cost.steps.to_string()),
        ("simulated time", format!("{:.4} ms", ms(s.cost.simulated_s))),
    ];
    if !source.finished {
        return facts;
    }
    facts.push(("wall time, output included", format!("{:.1} s", s.cost.wall_s)));
    if let Some(cpu) = s.cost.cpu_s {
        facts.push(("processor time", format!("{cpu:.1} s")));
    }
    if let Some(ms) = s.cost.ms_per_step {
        facts.push(("engine time per step", format!("{ms:.3} ms")));
    }
    facts.push(("threads", s.cost.threads.to_string()));
    facts
}

fn versions(source: &Source) -> Markup {
    html! {
        @if source.summary.cost.versions.is_empty() {
            p { "The versions of program and libraries are not known: the run did not end properly." }
        } @else {
            table {
                caption { "With what it was made" }
                tbody { @for (name, version) in &source.summary.cost.versions { tr { th { (name) } td { (version) } } } }
            }
        }
    }
}
