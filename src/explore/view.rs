//! What a browser looks at: everything that decides a picture apart from its size.

use crate::base::error::{Error, Result};
use crate::base::units::shortest;
use crate::engine::view::RunInfo;
use crate::scene::look::SUPERSAMPLING;
use crate::scene::picture::{MOST_EXPLODED, WIDEST};
use crate::scene::spec::{ColourBy, Theme};
use serde::{Deserialize, Serialize};

/// A view of a run. Lengths are in mm and angles in degrees, as the page and the command line write them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct View {
    /// Which snapshot, from 0; between two of them what can move is drawn between.
    pub state: f64,
    /// Turn of the eye about the vertical (°).
    pub azimuth: f64,
    /// Turn of the eye about the horizontal (°).
    pub elevation: f64,
    /// The point in the middle of the picture (mm).
    pub centre: [f64; 3],
    /// What the height of the picture spans (mm); in perspective, where its middle lies.
    pub height: f64,
    /// Angle under which the eye sees that height (°); 0 is the view along parallel lines, true to scale everywhere.
    pub perspective: f64,
    /// z before loading of the material section that the view rides on (mm); the z of `centre` is relative to it then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub follow: Option<f64>,
    /// What colours the wires.
    pub colour: ColourBy,
    /// Ends of the colour scale in its own unit; those of the run where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Layers that are left out, from 0.
    pub hidden_layers: Vec<usize>,
    /// Wires that are left out, from 0.
    pub hidden_wires: Vec<usize>,
    /// Layers that are drawn see-through, from 0.
    pub ghost_layers: Vec<usize>,
    /// Wire that stands out, from 0: the others are dimmed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub selected: Option<usize>,
    /// How far wires are drawn away from the axis, over their distance from it (-); 0 is as they lie.
    pub explode: f64,
    /// What lies above this z is cut off (mm).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut: Option<f64>,
    /// Ground.
    pub theme: Theme,
    /// How many times finer than its pixels the picture is drawn, in either direction.
    #[serde(skip_serializing_if = "is_one")]
    pub supersampling: u32,
}

/// The usual one is left unsaid.
fn is_one(times: &u32) -> bool {
    *times == 1
}

impl Default for View {
    fn default() -> Self {
        Self {
            state: 0.0,
            azimuth: 0.0,
            elevation: 0.0,
            centre: [0.0; 3],
            height: 10.0,
            perspective: 0.0,
            follow: None,
            colour: ColourBy::Stress,
            range: None,
            hidden_layers: Vec::new(),
            hidden_wires: Vec::new(),
            ghost_layers: Vec::new(),
            selected: None,
            explode: 0.0,
            cut: None,
            theme: Theme::Dark,
            supersampling: 1,
        }
    }
}

impl View {
    /// Reads a view from the words that [`View::words`] writes: keys of a TOML table, separated by commas.
    ///
    /// # Errors
    /// [`Error::Input`] that names the key.
    pub fn parse(words: &str) -> Result<Self> {
        #[derive(Deserialize)]
        struct Whole {
            view: View,
        }
        let whole: Whole = toml::from_str(&format!("view = {{ {words} }}")).map_err(|error| {
            Error::input(
                format!("the view cannot be read: {}", error.message()),
                "take it from `strandsnap explore`, which shows the command that makes a view; a view alone is \
                 'state = 40, azimuth = 30, height = 8'",
            )
        })?;
        Ok(whole.view)
    }

    /// The view as keys of a TOML table, separated by commas: no bit is lost.
    ///
    /// # Errors
    /// None for a view that [`View::check`] lets through.
    pub fn words(&self) -> Result<String> {
        let value = toml::Value::try_from(self).map_err(|e| Error::input(format!("cannot write a view: {e}"), ""))?;
        let toml::Value::Table(table) = value else { return Ok(String::new()) };
        let entries = table.into_iter().map(|(key, value)| format!("{key} = {value}"));
        Ok(entries.collect::<Vec<_>>().join(", "))
    }

    /// Checks that a run of so many snapshots has what the view names and that its numbers can be drawn.
    ///
    /// # Errors
    /// [`Error::Input`] that says which key is wrong and what it may be.
    pub fn check(&self, info: &RunInfo, states: usize) -> Result<()> {
        let last = states.saturating_sub(1);
        let lengths = self.centre.iter().chain(&self.follow).chain(&self.cut);
        let layers = info.layers.len();
        let wires = info.wires.len();
        let wire_numbers: Vec<usize> = self.hidden_wires.iter().chain(&self.selected).copied().collect();
        let rules = [
            (
                self.state >= 0.0 && self.state <= last as f64,
                "state",
                shortest(self.state),
                format!("a number from 0 to {last}"),
            ),
            (
                [self.azimuth, self.elevation].iter().all(|angle| angle.abs() <= 1e6),
                "azimuth and elevation",
                list([self.azimuth, self.elevation].map(shortest)),
                "numbers from -1e6 to 1e6".into(),
            ),
            (
                lengths.clone().all(|v| v.abs() < 1e6),
                "centre, follow and cut",
                list(lengths.map(|length| shortest(*length))),
                "lengths in mm below a kilometre".into(),
            ),
            (
                self.height > 1e-4 && self.height < 1e6,
                "height",
                shortest(self.height),
                "a length in mm above zero, below a kilometre".into(),
            ),
            (
                (0.0..=WIDEST).contains(&self.perspective),
                "perspective",
                shortest(self.perspective),
                format!("an angle from 0° to {WIDEST}°"),
            ),
            (
                SUPERSAMPLING.contains(&self.supersampling),
                "supersampling",
                self.supersampling.to_string(),
                format!("a whole number from {} to {}", SUPERSAMPLING.start(), SUPERSAMPLING.end()),
            ),
            (
                (0.0..=MOST_EXPLODED).contains(&self.explode),
                "explode",
                shortest(self.explode),
                format!("a number from 0 to {MOST_EXPLODED}"),
            ),
            (
                self.range.is_none_or(|[low, high]| low.is_finite() && high.is_finite() && low < high),
                "range",
                list(self.range.into_iter().flatten().map(shortest)),
                "two numbers, the lower one first".into(),
            ),
            (
                self.hidden_layers.len() <= layers && self.hidden_layers.iter().all(|l| *l < layers),
                "hidden_layers",
                list(self.hidden_layers.iter().map(usize::to_string)),
                format!("numbers below {layers}, each once"),
            ),
            (
                self.ghost_layers.len() <= layers && self.ghost_layers.iter().all(|l| *l < layers),
                "ghost_layers",
                list(self.ghost_layers.iter().map(usize::to_string)),
                format!("numbers below {layers}, each once"),
            ),
            (
                self.hidden_wires.len() <= wires && wire_numbers.iter().all(|wire| *wire < wires),
                "hidden_wires and selected",
                list(wire_numbers.iter().map(usize::to_string)),
                format!("numbers below {wires}, each once"),
            ),
        ];
        match rules.into_iter().find(|(holds, ..)| !holds) {
            None => Ok(()),
            Some((_, key, value, right)) => {
                let (verb, pronoun) = if key.contains(" and ") { ("are", "they take") } else { ("is", "it takes") };
                Err(Error::input(format!("{key} of the view {verb} {value}"), format!("{pronoun} {right}")))
            }
        }
    }

    /// Whether a wire of a layer is left out.
    pub fn hides(&self, wire: usize, layer: usize) -> bool {
        self.hidden_layers.contains(&layer) || self.hidden_wires.contains(&wire)
    }
}

/// Most numbers that a message shows.
const MOST_SHOWN: usize = 8;

/// Numbers as a message shows them: `1, 5 and 7`, and of many the first.
fn list(numbers: impl IntoIterator<Item = String>) -> String {
    let mut shown: Vec<String> = numbers.into_iter().collect();
    let more = shown.len().saturating_sub(MOST_SHOWN);
    shown.truncate(MOST_SHOWN);
    let last = if more > 0 { Some(format!("{more} more")) } else { shown.pop() };
    match last {
        Some(last) if shown.is_empty() => last,
        Some(last) => format!("{} and {last}", shown.join(", ")),
        None => "nothing".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_keep_every_bit() {
        let view = View {
            state: 57.123456789,
            azimuth: -28.1,
            centre: [0.1, -1e-7, 60.333],
            follow: Some(39.29),
            colour: ColourBy::PlasticStrain,
            range: Some([0.0, 12.5]),
            hidden_layers: vec![2],
            selected: Some(13),
            cut: Some(61.7),
            theme: Theme::Light,
            ..View::default()
        };
        let words = view.words().unwrap();
        assert!(!words.contains('\n'), "{words}");
        assert_eq!(View::parse(&words).unwrap(), view, "{words}");
    }

    #[test]
    fn an_unknown_key_is_named() {
        let error = View::parse("azimut = 3").unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("azimut"), "{error}");
    }

    /// What a message shows of a view that a run does not have.
    fn refused(view: View) -> String {
        let info = RunInfo { layers: vec!["outer".into()], ..RunInfo::default() };
        let error = view.check(&info, 3).unwrap_err();
        let Error::Input { what, help: Some(help) } = error else { panic!("{error}") };
        format!("{what}; {help}")
    }

    #[test]
    fn messages_show_numbers_as_people_write_them() {
        let far = refused(View { centre: [0.0, -0.5, 1e308], cut: Some(7.0), ..View::default() });
        assert!(far.starts_with("centre, follow and cut of the view are 0, -0.5, 1e308 and 7; "), "{far}");
        let high = refused(View { height: -1e300, ..View::default() });
        assert!(high.starts_with("height of the view is -1e300; it takes a length"), "{high}");
        let wire = refused(View { selected: Some(7), ..View::default() });
        assert!(wire.starts_with("hidden_wires and selected of the view are 7; they take "), "{wire}");
        let layers = refused(View { hidden_layers: vec![4; 30], ..View::default() });
        assert!(layers.contains("is 4, 4, 4, 4, 4, 4, 4, 4 and 22 more; "), "{layers}");
        let range = refused(View { range: Some([2.0, 1.0]), ..View::default() });
        assert!(range.starts_with("range of the view is 2 and 1; "), "{range}");
    }
}
