//! Units at the border, SI inside: `"110 GPa"` ↔ 1.1e11 for what is read, [`mm`], [`mpa`] and their like for what is
//! shown.
//!
//! The conversion factors are those of the `uom` crate; this file only picks the quantity, accepts common ASCII
//! spellings (`kg/m^3`, `10 deg`, `5 us`, `1 N m`), and words the errors.

use std::str::FromStr;
use uom::si::f64 as quantity;

/// Pa → MPa.
pub fn mpa(pascal: f64) -> f64 {
    pascal * 1e-6
}

/// Pa → GPa.
pub fn gpa(pascal: f64) -> f64 {
    pascal * 1e-9
}

/// m → mm.
pub fn mm(metre: f64) -> f64 {
    metre * 1e3
}

/// s → ms.
pub fn ms(second: f64) -> f64 {
    second * 1e3
}

/// N m → N mm.
pub fn newton_mm(newton_metre: f64) -> f64 {
    newton_metre * 1e3
}

/// Fraction → %.
pub fn percent(fraction: f64) -> f64 {
    fraction * 100.0
}

/// What kind of quantity a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Plain number or per cent (-).
    Ratio,
    /// (m).
    Length,
    /// (m²).
    Area,
    /// (s).
    Time,
    /// (Hz).
    Frequency,
    /// (m/s).
    Velocity,
    /// (rad).
    Angle,
    /// (rad/s).
    AngularVelocity,
    /// Stress, pressure, elastic modulus (Pa).
    Pressure,
    /// (kg/m³).
    Density,
    /// (N).
    Force,
    /// (N m).
    Moment,
}

/// A value that cannot be read; what is wrong and what would be right.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what}")]
pub struct UnitError {
    /// What is wrong.
    pub what: String,
    /// What would be right.
    pub help: String,
}

impl Dimension {
    /// All of them.
    pub const ALL: [Dimension; 12] = [
        Dimension::Ratio,
        Dimension::Length,
        Dimension::Area,
        Dimension::Time,
        Dimension::Frequency,
        Dimension::Velocity,
        Dimension::Angle,
        Dimension::AngularVelocity,
        Dimension::Pressure,
        Dimension::Density,
        Dimension::Force,
        Dimension::Moment,
    ];

    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            Dimension::Ratio => "ratio",
            Dimension::Length => "length",
            Dimension::Area => "area",
            Dimension::Time => "time",
            Dimension::Frequency => "frequency",
            Dimension::Velocity => "velocity",
            Dimension::Angle => "angle",
            Dimension::AngularVelocity => "angular velocity",
            Dimension::Pressure => "pressure",
            Dimension::Density => "density",
            Dimension::Force => "force",
            Dimension::Moment => "moment",
        }
    }

    /// A value as it may stand in a scene, with its quotes.
    pub fn example(self) -> &'static str {
        match self {
            Dimension::Ratio => "0.2 or \"20 %\"",
            Dimension::Length => "\"39 mm\"",
            Dimension::Area => "\"4 mm^2\"",
            Dimension::Time => "\"1 ms\"",
            Dimension::Frequency => "\"50 Hz\"",
            Dimension::Velocity => "\"5 m/s\" or \"50 mm/min\"",
            Dimension::Angle => "\"10 deg\"",
            Dimension::AngularVelocity => "\"2 rad/s\" or \"10 rpm\"",
            Dimension::Pressure => "\"110 GPa\"",
            Dimension::Density => "\"8960 kg/m^3\"",
            Dimension::Force => "\"0.5 N\"",
            Dimension::Moment => "\"1 N m\"",
        }
    }

    /// Spellings tried by [`format`], the preferred one first; the factor is to SI.
    fn spellings(self) -> &'static [(&'static str, f64)] {
        match self {
            Dimension::Ratio => &[],
            Dimension::Length => &[("mm", 1e-3), ("m", 1.0)],
            Dimension::Area => &[("mm^2", 1e-6), ("m^2", 1.0)],
            Dimension::Time => &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)],
            Dimension::Frequency => &[("Hz", 1.0), ("kHz", 1e3)],
            Dimension::Velocity => &[("m/s", 1.0), ("mm/s", 1e-3)],
            Dimension::Angle => &[("rad", 1.0), ("deg", std::f64::consts::PI / 180.0)],
            Dimension::AngularVelocity => &[("rad/s", 1.0)],
            Dimension::Pressure => &[("Pa", 1.0), ("MPa", 1e6), ("GPa", 1e9)],
            Dimension::Density => &[("kg/m^3", 1.0)],
            Dimension::Force => &[("N", 1.0), ("mN", 1e-3)],
            Dimension::Moment => &[("N m", 1.0), ("N mm", 1e-3)],
        }
    }
}

/// Reads `text` as a quantity of the given dimension, in SI.
///
/// A ratio may be a plain number; every other dimension needs its unit. Errors: no number, no unit, an unknown
/// unit, a unit of another dimension.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, UnitError> {
    let (number, unit) = split(text.trim());
    let Ok(value) = number.parse::<f64>() else {
        return Err(UnitError {
            what: format!("`{text}` does not begin with a number"),
            help: format!("give a {}, for example {}", dimension.name(), dimension.example()),
        });
    };
    if unit.is_empty() {
        return match dimension {
            Dimension::Ratio => in_range(text, number, value, dimension),
            _ => Err(UnitError {
                what: format!("`{text}` has no unit, a {} is expected", dimension.name()),
                help: format!("write the unit too, for example {}", dimension.example()),
            }),
        };
    }
    let canonical = format!("{number} {}", normalise(unit));
    let si = convert(&canonical, dimension).ok_or_else(|| wrong_unit(text, unit, &canonical, dimension))?;
    in_range(text, number, si, dimension)
}

/// The value in SI units, unless it lies beyond what a number can hold: it would be infinite, or zero where the text has a
/// digit that is not.
fn in_range(text: &str, number: &str, si: f64, dimension: Dimension) -> Result<f64, UnitError> {
    let digits = number.split(['e', 'E']).next().unwrap_or_default();
    let beyond = match si {
        si if !si.is_finite() => "large",
        0.0 if digits.contains(|c| ('1'..='9').contains(&c)) => "small",
        _ => return Ok(si),
    };
    Err(UnitError {
        what: format!("`{text}` is too {beyond}: in SI units, numbers reach from 5e-324 to 1.8e308"),
        help: format!("check its exponent and its unit; for example {}", dimension.example()),
    })
}

/// Writes an SI value with its unit so that [`parse`] gives back exactly the same number; among the usual units the
/// one with the shortest text.
pub fn format(value: f64, dimension: Dimension) -> String {
    dimension
        .spellings()
        .iter()
        .map(|(unit, factor)| format!("{} {unit}", shortest(value / factor)))
        .filter(|text| parse(text, dimension) == Ok(value))
        .min_by_key(String::len)
        .unwrap_or_else(|| shortest(value))
}

/// The shortest decimal text that reads back as `value`: `1e300`, not a one with 300 zeros.
pub fn shortest(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// Splits `39 mm` or `39mm` into number and unit.
fn split(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).unwrap_or(text.len());
    (&text[..end], text[end..].trim())
}

/// Common spellings → the abbreviations of `uom`.
fn normalise(unit: &str) -> String {
    let unit = unit.replace("^3", "³").replace("^2", "²").replace('\u{3bc}', "µ");
    match unit.as_str() {
        "deg" | "degree" | "degrees" => return "°".into(),
        "deg/s" => return "°/s".into(),
        "turn/s" | "turns/s" | "rev/s" => return "rps".into(),
        "turn/min" | "turns/min" | "rev/min" => return "rpm".into(),
        _ => {}
    }
    if let Some(micro) = unit.strip_prefix('u')
        && ["s", "m", "m/s", "N", "Pa", "rad"].contains(&micro)
    {
        return format!("µ{micro}");
    }
    moment_spelling(&unit).unwrap_or(unit)
}

/// `N m`, `N*m`, `N·m` and `Nm`, with prefixes on either unit → `N · m`.
fn moment_spelling(unit: &str) -> Option<String> {
    let separated: Vec<&str> = unit.split([' ', '*', '·', '⋅']).filter(|part| !part.is_empty()).collect();
    if let [force, arm] = separated[..] {
        return Some(format!("{force} · {arm}"));
    }
    let (force, arm) = unit.split_at(unit.find('N')? + 1);
    ["m", "mm", "cm"].contains(&arm).then(|| format!("{force} · {arm}"))
}

/// The conversion by `uom`; `None` when the unit is not one of this dimension.
fn convert(text: &str, dimension: Dimension) -> Option<f64> {
    macro_rules! si {
        ($name:ident) => {
            quantity::$name::from_str(text).ok().map(|q| q.value)
        };
    }
    match dimension {
        Dimension::Ratio => si!(Ratio),
        Dimension::Length => si!(Length),
        Dimension::Area => si!(Area),
        Dimension::Time => si!(Time),
        Dimension::Frequency => si!(Frequency),
        Dimension::Velocity => si!(Velocity),
        Dimension::Angle => si!(Angle),
        Dimension::AngularVelocity => si!(AngularVelocity),
        Dimension::Pressure => si!(Pressure),
        Dimension::Density => si!(MassDensity),
        Dimension::Force => si!(Force),
        Dimension::Moment => si!(Torque),
    }
}

fn wrong_unit(text: &str, unit: &str, canonical: &str, expected: Dimension) -> UnitError {
    let help = format!("for example {}", expected.example());
    let other = Dimension::ALL.into_iter().find(|other| convert(canonical, *other).is_some());
    let what = match other {
        Some(other) => format!("`{text}` is a {}, but a {} is expected", other.name(), expected.name()),
        None => format!("`{unit}` is not a known unit of {}", expected.name()),
    };
    UnitError { what, help }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_usual_spellings_are_read() {
        use Dimension::*;
        let cases = [
            ("110 GPa", Pressure, 110e9),
            ("39 mm", Length, 0.039),
            ("39mm", Length, 0.039),
            ("5 um", Length, 5e-6),
            ("4 mm^2", Area, 4e-6),
            ("50 mm/min", Velocity, 0.05 / 60.0),
            ("8960 kg/m^3", Density, 8960.0),
            ("8.96 g/cm^3", Density, 8960.0),
            ("12 %", Ratio, 0.12),
            ("0.12", Ratio, 0.12),
            ("10 deg", Angle, 10f64.to_radians()),
            ("2 rad/s", AngularVelocity, 2.0),
            ("60 rpm", AngularVelocity, std::f64::consts::TAU),
            ("1 turns/s", AngularVelocity, std::f64::consts::TAU),
            ("0.5 N", Force, 0.5),
            ("1 N m", Moment, 1.0),
            ("1 N*m", Moment, 1.0),
            ("1 Nm", Moment, 1.0),
            ("3 mN*m", Moment, 3e-3),
            ("3 N mm", Moment, 3e-3),
            ("5 us", Time, 5e-6),
            ("5 \u{3bc}s", Time, 5e-6),
            ("5e-8 s", Time, 5e-8),
            ("2 kHz", Frequency, 2000.0),
            ("-1e-3 m/s", Velocity, -1e-3),
        ];
        for (text, dimension, expected) in cases {
            let value = parse(text, dimension).unwrap_or_else(|e| panic!("{text}: {e}"));
            assert!(
                (value - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(),
                "{text}: {value} instead of {expected}"
            );
        }
    }

    #[test]
    fn errors_name_the_dimension_and_an_example() {
        let wrong = parse("110 GPa", Dimension::Length).unwrap_err();
        assert!(wrong.what.contains("is a pressure, but a length"), "{wrong}");
        assert!(wrong.help.contains("39 mm"), "{}", wrong.help);
        let bare = parse("39", Dimension::Length).unwrap_err();
        assert!(bare.what.contains("has no unit"), "{bare}");
        let unknown = parse("3 parsnips", Dimension::Force).unwrap_err();
        assert!(unknown.what.contains("not a known unit of force"), "{unknown}");
        assert!(parse("mm", Dimension::Length).is_err());
        assert!(parse("", Dimension::Ratio).is_err());
    }

    #[test]
    fn what_no_number_can_hold_is_told_so_in_every_dimension() {
        for dimension in Dimension::ALL {
            let unit = dimension.spellings().first().map_or("%", |(unit, _)| *unit);
            // A number as large as there is, in a unit that is larger than that of the SI; and one beyond all units.
            let mut large = vec![format!("1e999 {unit}"), format!("-1e999 {unit}")];
            large.extend((dimension == Dimension::Pressure).then(|| "1e308 GPa".to_owned()));
            for text in large {
                let error = parse(&text, dimension).unwrap_err();
                assert!(error.what.contains("is too large") && error.what.contains(text.trim()), "{text}: {error}");
            }
            let small = parse(&format!("1e-999 {unit}"), dimension).unwrap_err();
            assert!(small.what.contains("is too small"), "{small}");
            assert_eq!(parse(&format!("0.0e-999 {unit}"), dimension), Ok(0.0), "{unit}");
        }
    }

    proptest! {
        #[test]
        fn writing_and_reading_gives_the_same_bits(value in proptest::num::f64::NORMAL, which in 0usize..12) {
            let dimension = Dimension::ALL[which];
            let text = format(value, dimension);
            prop_assert_eq!(parse(&text, dimension).map(f64::to_bits), Ok(value.to_bits()), "{}", text);
        }
    }

    #[test]
    fn lengths_are_written_as_people_write_them() {
        let d = parse("0.39 mm", Dimension::Length).unwrap();
        assert_eq!(format(d, Dimension::Length), "0.39 mm");
        assert_eq!(format(115e9, Dimension::Pressure), "115 GPa");
    }
}
