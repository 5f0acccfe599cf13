//! The HTML document around the sections.

use super::{Section, Source};
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("../../assets/page/page.css");
const SCRIPT: &str = include_str!("../../assets/page/page.js");
/// Charts; MIT licence, see `assets/page/plotly-LICENSE.txt`.
const PLOTLY: &str = include_str!("../../assets/page/plotly-cartesian.min.js");

/// Nothing may be fetched from anywhere: what the page needs is in it.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// The whole page.
pub fn document(source: &Source, sections: &[Section]) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content={ "strandsnap " (env!("CARGO_PKG_VERSION")) };
                title { (source.info.name) " · strandsnap" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (header(source, sections))
                main { @for section in sections {
                    section id=(section.id) { h2 { (section.title) } (section.body) }
                } }
                footer { p {
                    "Made by strandsnap " (env!("CARGO_PKG_VERSION")) ". Charts by plotly.js (MIT licence), which is part of this file; the page loads nothing from anywhere."
                } }
                script { (PreEscaped(PLOTLY)) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    }
}

fn header(source: &Source, sections: &[Section]) -> Markup {
    html! {
        header {
            div.title {
                h1 { (source.info.name) }
                button type="button" id="theme" aria-pressed="false" { "Dark" }
            }
            @if !source.info.about.is_empty() { p.about { (source.info.about) } }
            nav aria-label="Sections" { @for section in sections { a href={ "#" (section.id) } { (section.title) } } }
            p.broken id="trouble" role="alert" hidden { "A part of this page could not be drawn: " span {} }
        }
    }
}
