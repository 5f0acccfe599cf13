//! The range of an axis, its ticks and their labels.

use super::figure::{Axis, Scale};
use crate::base::ticks::{label, ticks};
use plotters::coord::ranged1d::{KeyPointHint, KeyPointWeight, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// Major ticks that an axis aims at.
const TICKS: usize = 6;
/// Share of the range left free on either side (-).
const PADDING: f64 = 0.06;

/// An axis whose range is known.
#[derive(Debug, Clone)]
pub struct Span {
    low: f64,
    high: f64,
    scale: Scale,
    /// Names of 0, 1, 2, …; empty for numbers.
    names: Vec<String>,
}

impl Span {
    /// The axis' own range, or one that holds `values` with some room.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let (scale, names) = (axis.scale, axis.names.clone());
        if let Some([low, high]) = axis.range {
            return Self { low, high, scale, names };
        }
        let shown = values.filter(|v| can_show(scale, *v)).map(|v| forward(scale, v));
        let (low, high) = shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = match high - low {
            span if span > 0.0 => (low - PADDING * span, high + PADDING * span),
            // One value, or none.
            _ if low.is_finite() => (low - 0.5 * low.abs().max(1.0), high + 0.5 * low.abs().max(1.0)),
            _ => (0.0, 1.0),
        };
        Self { low: backward(scale, low), high: backward(scale, high), scale, names }
    }

    /// Whether a value has a place on this axis.
    pub fn shows(&self, value: f64) -> bool {
        can_show(self.scale, value) && self.low <= value && value <= self.high
    }

    /// The least value shown.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// The greatest value shown.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Place of a value between the ends: 0 to 1.
    pub fn share(&self, value: f64) -> f64 {
        let [low, high, value] = [self.low, self.high, value].map(|v| forward(self.scale, v));
        (value - low) / (high - low)
    }

    fn decades(&self) -> (i32, i32) {
        ((self.low.log10() - 1e-6).ceil() as i32, (self.high.log10() + 1e-6).floor() as i32)
    }

    /// Major ticks.
    fn major(&self) -> Vec<f64> {
        if !self.names.is_empty() {
            return (0..self.names.len()).map(|k| k as f64).collect();
        }
        if self.scale == Scale::Linear {
            return ticks(self.low, self.high, TICKS).values;
        }
        let (first, last) = self.decades();
        if last - first >= 2 {
            let stride = ((last - first) as usize / TICKS + 1) as i32;
            return (first..=last).filter(|k| k % stride == 0).map(|k| 10f64.powi(k)).collect();
        }
        self.between(&[1.0, 2.0, 5.0])
    }

    fn minor(&self) -> Vec<f64> {
        match self.scale {
            Scale::Linear => Vec::new(),
            Scale::Log => self.between(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]),
        }
    }

    /// These multiples of powers of ten.
    fn between(&self, factors: &[f64]) -> Vec<f64> {
        let (first, last) = self.decades();
        let all = (first - 1..=last).flat_map(|k| factors.iter().map(move |f| f * 10f64.powi(k)));
        all.filter(|v| self.shows(*v)).collect()
    }
}

/// Whether a value has a place on an axis of this scale.
pub fn can_show(scale: Scale, value: f64) -> bool {
    value.is_finite() && (scale == Scale::Linear || value > 0.0)
}

fn forward(scale: Scale, value: f64) -> f64 {
    if scale == Scale::Log { value.log10() } else { value }
}

fn backward(scale: Scale, value: f64) -> f64 {
    if scale == Scale::Log { 10f64.powf(value) } else { value }
}

impl Ranged for Span {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        limit.0 + (self.share(*value) * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match hint.weight() {
            KeyPointWeight::Bold => self.major(),
            KeyPointWeight::Any => self.minor(),
        }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Span {
    fn format_ext(&self, value: &f64) -> String {
        if !self.names.is_empty() {
            return self.names.get(value.round() as usize).cloned().unwrap_or_default();
        }
        let largest = self.low.abs().max(self.high.abs());
        let plain = (1e-3..1e5).contains(&largest) && (self.scale == Scale::Linear || self.low >= 1e-4);
        if !plain {
            return scientific(*value);
        }
        let decimals = match self.scale {
            Scale::Linear => ticks(self.low, self.high, TICKS).decimals,
            Scale::Log => (-value.log10() - 1e-9).ceil().max(0.0) as usize,
        };
        label(*value, decimals)
    }
}

/// 0, 1e−4, 2e−4, 1.5e3: the font lacks most raised figures.
fn scientific(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let text = format!("{value:.2e}");
    let (mantissa, exponent) = text.split_once('e').expect("Rust writes an exponent");
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
    format!("{mantissa}e{exponent}").replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithmic_axes_have_a_tick_per_decade() {
        let span = Span::new(&Axis::log("x").from_to(1e-5, 1e-1), std::iter::empty());
        let labels: Vec<String> = span.major().iter().map(|v| span.format_ext(v)).collect();
        assert_eq!(labels, ["1e−5", "1e−4", "1e−3", "1e−2", "1e−1"]);
        assert_eq!(span.map(&1e-3, (0, 100)), 50);
    }

    #[test]
    fn a_short_logarithmic_axis_has_ticks_within_the_decade() {
        let span = Span::new(&Axis::log("x").from_to(0.04, 0.3), std::iter::empty());
        let labels: Vec<String> = span.major().iter().map(|v| span.format_ext(v)).collect();
        assert_eq!(labels, ["0.05", "0.1", "0.2"]);
    }

    #[test]
    fn numbers_are_written_as_people_do() {
        for (value, text) in [(0.0, "0"), (1e-4, "1e−4"), (-2e7, "−2e7"), (1.5e12, "1.5e12")] {
            assert_eq!(scientific(value), text);
        }
    }

    #[test]
    fn an_axis_holds_what_it_can_show() {
        let span = Span::new(&Axis::log("x"), [1.0, 100.0, 0.0, -3.0, f64::NAN].into_iter());
        assert!(span.shows(1.0) && span.shows(100.0) && !span.shows(0.0));
        let one = Span::new(&Axis::linear("x"), [5.0].into_iter());
        assert!(one.shows(5.0) && one.low() < one.high());
        let none = Span::new(&Axis::linear("x"), std::iter::empty());
        assert!(none.low() < none.high());
    }
}
