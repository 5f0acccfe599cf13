//! The HTML document around the sections.

use super::section::Section;
use super::source::Source;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("../../assets/page/page.css");
const SCRIPT: &str = include_str!("../../assets/page/page.js");
const SOLID: &str = include_str!("../../assets/page/solid.js");
/// Charts; MIT licence, see `assets/page/plotly-LICENSE.txt`.
const PLOTLY: &str = include_str!("../../assets/page/plotly-cartesian.min.js");

/// Nothing may be fetched from anywhere: what the page needs is in it.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// The whole page of a run.
pub fn document(source: &Source, sections: &[Section]) -> Markup {
    let button = html! { button type="button" id="theme" aria-pressed="false" { "Dark" } };
    let trouble =
        html! { p.broken id="trouble" role="alert" hidden { "A part of this page could not be drawn: " span {} } };
    let scripts =
        html! { script { (PreEscaped(PLOTLY)) } script { (PreEscaped(SOLID)) } script { (PreEscaped(SCRIPT)) } };
    let charts = "Charts by plotly.js (MIT licence), which is part of this file; the page loads nothing from anywhere.";
    // The page begins in the light of its frames, which are drawn once.
    let theme = source.spec.as_ref().filter(|_| source.pictures_shown() > 0).map(|spec| spec.output.theme.word());
    html! { (DOCTYPE) html lang="en" data-theme=[theme] {
        (head(&source.info.name))
        body {
            (header(&source.info.name, &source.info.about, sections, &button, &trouble))
            (main(sections))
            (footer(charts))
            (scripts)
        }
    } }
}

/// A page of text, tables and images alone, which runs nothing.
pub fn plain(title: &str, about: &str, sections: &[Section]) -> Markup {
    html! { (DOCTYPE) html lang="en" {
        (head(title))
        body {
            (header(title, about, sections, &html! {}, &html! {}))
            (main(sections))
            (footer("The page loads nothing from anywhere."))
        }
    } }
}

fn head(title: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta http-equiv="Content-Security-Policy" content=(POLICY);
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta name="generator" content={ "strandsnap " (env!("CARGO_PKG_VERSION")) };
            title { (title) " · strandsnap" }
            style { (PreEscaped(STYLE)) }
        }
    }
}

fn main(sections: &[Section]) -> Markup {
    html! {
        main { @for section in sections {
            section id=(section.id) { h2 { (section.title) } (section.body) }
        } }
    }
}

fn footer(words: &str) -> Markup {
    html! { footer { p { "Made by strandsnap " (env!("CARGO_PKG_VERSION")) ". " (words) } } }
}

fn header(title: &str, about: &str, sections: &[Section], button: &Markup, trouble: &Markup) -> Markup {
    html! {
        header {
            div.title { h1 { (title) } (button) }
            @if !about.is_empty() { p.about { (about) } }
            nav aria-label="Sections" { @for section in sections { a href={ "#" (section.id) } { (section.title) } } }
            (trouble)
        }
    }
}
