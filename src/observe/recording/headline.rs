//! What the run found, in a few words that are read without a click: the first break, then the result.

use super::names;
use super::sink::RERUN_VERSION;
use super::stream::{self, Stream};
use crate::base::error::Result;
use crate::base::finding::Notice;
use crate::base::units::{mm, mpa, percent};
use crate::base::wording::counted;
use crate::base::worst::renew;
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::summary::RunSummary;
use crate::observe::wording::{OneDraw, layer_words, wire_number};
use rerun::TextDocument;
use std::fmt::Write;

/// Wires that the order of break names at most: one line of text.
const NAMED: usize = 24;

/// What is known so far.
pub(super) struct Headline {
    ruptures: Vec<Rupture>,
    notices: Vec<Notice>,
    one_draw: Option<OneDraw>,
    changed: bool,
}

impl Headline {
    /// Nothing is known, which is to be said; `one_draw` where bonds scatter.
    pub fn new(one_draw: Option<OneDraw>) -> Self {
        Self { ruptures: Vec::new(), notices: Vec::new(), one_draw, changed: true }
    }

    /// Takes note of a rupture.
    pub fn rupture(&mut self, rupture: &Rupture) {
        self.changed |= rupture.first_of_wire;
        self.ruptures.push(rupture.clone());
    }

    /// Takes note of a notice.
    pub fn notice(&mut self, notice: &Notice) {
        self.changed = true;
        renew(&mut self.notices, notice);
    }

    /// Sends the words when they have changed. They hold at all times, so that they can be read
    /// wherever the cursor is.
    pub fn send(&mut self, stream: &Stream, info: &RunInfo) -> Result<()> {
        if std::mem::take(&mut self.changed) {
            return send(stream, &self.text(info, None));
        }
        Ok(())
    }

    /// Sends the final words, with the result.
    pub fn send_end(&self, stream: &Stream, info: &RunInfo, summary: &RunSummary) -> Result<()> {
        send(stream, &self.text(info, Some(summary)))
    }

    fn text(&self, info: &RunInfo, summary: Option<&RunSummary>) -> String {
        let mut text = match self.ruptures.first() {
            Some(first) => first_break(info, first, self.one_draw.is_some()),
            None if info.wires.is_empty() => format!("# {}\n{}\n", info.name, info.about),
            None if summary.is_some() => "# No wire broke\n".to_owned(),
            None => "# No wire has broken yet\n".to_owned(),
        };
        let warnings = self.warnings(summary);
        if let Some(summary) = summary {
            text += &result(summary, warnings.len());
        }
        text += &self.order(info);
        if let Some(draw) = self.one_draw.filter(|_| !self.ruptures.is_empty()) {
            let _ = write!(text, "\n{}\n", draw.sentence());
        }
        for warning in warnings {
            // Writing to a String cannot fail.
            let _ = write!(text, "\n> **WARNING** {warning}\n");
        }
        text
    }

    fn order(&self, info: &RunInfo) -> String {
        let firsts: Vec<_> = self.ruptures.iter().filter(|r| r.first_of_wire).collect();
        if firsts.len() < 2 {
            return String::new();
        }
        let wires: Vec<_> = firsts.iter().take(NAMED).map(|r| wire_number(r.wire).to_string()).collect();
        let more = if firsts.len() > NAMED { ", …" } else { "" };
        format!("\nWires in order of break: {}{more} ({} of {})\n", wires.join(", "), firsts.len(), info.wires.len())
    }

    /// Notices in the order in which they came, then what the summary adds to them.
    fn warnings(&self, summary: Option<&RunSummary>) -> Vec<String> {
        match summary {
            Some(summary) => summary.warnings.clone(),
            None => self.notices.iter().map(Notice::to_string).collect(),
        }
    }
}

fn send(stream: &Stream, text: &str) -> Result<()> {
    stream.fixed(names::HEADLINE, &TextDocument::from_markdown(text))
}

fn first_break(info: &RunInfo, first: &Rupture, one_draw: bool) -> String {
    let of = if info.wires.len() > 1 { format!(", {}", layer_words(info, first.layer)) } else { String::new() };
    let body = if info.wires.len() > 1 { "strand" } else { "wire" };
    format!(
        "# 1st break{}: wire {}{of}\n## z = {:.1} mm, strain {:.2} %, {:.1} MPa\n\
         z is counted before loading ({:.1} mm when it broke). The {body} then carried {:.1} MPa of nominal stress; \
         true axial stress where it broke: {:.0} MPa.\n",
        if one_draw { format!(" in this {body}") } else { String::new() },
        wire_number(first.wire),
        mm(first.rest_z),
        percent(first.strain),
        mpa(first.body_stress),
        mm(first.position[2]),
        mpa(first.body_stress),
        mpa(first.stress),
    )
}

/// The result; `warnings` are announced in its first line, for they may stand below the edge of the panel.
fn result(summary: &RunSummary, warnings: usize) -> String {
    let mut parts = Vec::new();
    parts.extend(
        summary
            .extremes()
            .map(|e| format!("{} **{:.2} MPa** at {:.2} %", e.kind.name(), e.stress_mpa, e.strain_percent)),
    );
    if let (Some(stress), Some(strain)) = (summary.residual_stress_mpa, summary.final_strain_percent) {
        parts.push(format!("at the end {stress:.1} MPa at {strain:.2} %"));
    }
    match warnings {
        0 => {}
        n => parts.push(format!("**{}, below**", counted(n, "warning"))),
    }
    let mut text = String::new();
    if !parts.is_empty() {
        let _ = writeln!(text, "\nResult: {}", parts.join("; "));
    }
    let layers = summary.wires_broken_by_layer.iter();
    let layers: Vec<String> = layers.map(|(name, n)| format!("{name} {} of {}", n.broken, n.of)).collect();
    if !layers.is_empty() {
        let _ = writeln!(text, "\nWires broken: {}", layers.join(", "));
    }
    text
}

/// What the run is.
pub(super) fn about(info: &RunInfo) -> String {
    let wires = info.layers.iter().enumerate().map(|(layer, name)| {
        let count = info.wires_of(layer).count();
        format!("- {name}: {}\n", counted(count, "wire"))
    });
    let wires: String = wires.collect();
    format!(
        "# {}\n\n{}\n\n{wires}\n{}; positions in mm, stress in MPa. \
         The timeline `{}` counts strain in µm/m: 10,000 is 1 %.\n\n\
         Values of a bond: click it, in space or on the map, and open the selection panel (the right one of the three \
         buttons at the top). The button for loops, at the lower left, repeats the ruptures.\n\n\
         Colours: from {:.0} to {:.0} MPa of true axial stress where stress colours; grey where next to nothing is \
         carried; red at broken bonds.\n\n\
         strandsnap {}, Rerun {RERUN_VERSION}\n",
        info.name,
        info.about,
        counted(info.particles, "particle"),
        stream::STRAIN,
        mpa(info.stress_range[0]),
        mpa(info.stress_range[1]),
        env!("CARGO_PKG_VERSION"),
    )
}
