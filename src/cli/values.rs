//! How single arguments are written.

use crate::base::error::Result;
use crate::base::units::{self, Dimension};
use crate::scene::look::FRAME_SIDE;
use crate::scene::quality::Quality;
use crate::scene::{self, Scene};
use clap::Args;
use clap::builder::{OsStringValueParser, PossibleValuesParser, TypedValueParser};
use std::time::Duration;

/// Whole numbers of TOML end here.
const MOST_SEED: u64 = i64::MAX as u64;

/// The scene and changes to it: what every command that loads a scene takes.
#[derive(Debug, Args)]
pub struct SceneArgs {
    /// Built-in scene by name (see `strandsnap scene list`), or the path of a TOML file
    #[arg(value_parser = name_or_path())]
    pub scene: String,
    /// Accuracy against run time: `draft` doubles the pull's speed, `fine` halves it and the time step
    #[arg(long, value_name = "QUALITY", value_parser = quality(), default_value = "standard")]
    pub quality: Quality,
    /// Change a key of the scene, such as --set contact.friction=0.3
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed of the scatter; the same as --set seed=N
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=MOST_SEED))]
    pub seed: Option<u64>,
    /// Refuse what needs more memory than this, such as 4GB [default: what is free]
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    memory: Option<u64>,
}

impl SceneArgs {
    /// The scene with all changes; `--set` wins over the preset, and `--seed` over both.
    ///
    /// # Errors
    /// Whatever is wrong in it or in them.
    pub fn load(&self) -> Result<Scene> {
        self.load_and_tell().map(|(scene, _)| scene)
    }

    /// The same, and what the preset changed, each as `key=value`.
    ///
    /// # Errors
    /// Whatever is wrong in it or in them.
    pub fn load_and_tell(&self) -> Result<(Scene, Vec<String>)> {
        let seed = self.seed.map(|seed| format!("seed={seed}"));
        let options: Vec<String> = self.set.iter().cloned().chain(seed).collect();
        let mut scene = Scene { memory: self.memory, ..scene::load(&self.scene, &options)? };
        let changed = self.quality.apply(&mut scene)?;
        Ok((scene, changed))
    }
}

/// Threads of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Threads {
    /// As many as help, found while it runs.
    Auto,
    /// So many.
    Count(u16),
}

impl Threads {
    /// The number, if one was given.
    pub fn count(self) -> Option<usize> {
        match self {
            Self::Auto => None,
            Self::Count(count) => Some(count.into()),
        }
    }
}

/// Reads a number of threads, or `auto`.
pub fn threads(text: &str) -> std::result::Result<Threads, String> {
    match text {
        "auto" => Ok(Threads::Auto),
        _ => text
            .parse()
            .ok()
            .filter(|count| *count > 0)
            .map(Threads::Count)
            .ok_or_else(|| format!("not auto, nor a whole number from 1 to {}", u16::MAX)),
    }
}

/// Reads what may be a built-in name or a path. Scenes and results name files in text, so a path must be text too.
pub fn name_or_path() -> impl TypedValueParser<Value = String> {
    OsStringValueParser::new().try_map(|given| {
        let refused = |name: std::ffi::OsString| {
            format!("{name:?} is not UTF-8, as the names of scenes and studies must be; rename the file")
        };
        given.into_string().map_err(refused)
    })
}

/// Reads a preset by its name.
pub fn quality() -> impl TypedValueParser<Value = Quality> {
    PossibleValuesParser::new(Quality::ALL.map(Quality::word)).map(|word| {
        let named = Quality::ALL.into_iter().find(|quality| quality.word() == word);
        named.expect("the parser lets only their names through")
    })
}

/// Seeds, written as how many (`16` is 1 to 16), as a range (`4..9`, both ends included) or as a list (`1,2,5`); a study's
/// file writes them the same way, `seeds = 16` or `seeds = [1, 2, 5]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seeds(pub Vec<u64>);

/// Most seeds: more is a typing error.
const MOST_SEEDS: u64 = 10_000;

impl std::str::FromStr for Seeds {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let wrong = || "write how many seeds, such as 16, or which, such as 1,2,5 or 4..9".to_string();
        let number = |part: &str| part.trim().parse::<u64>().map_err(|_| wrong());
        let seeds: Vec<u64> = if let Some((first, last)) = text.split_once("..") {
            let (first, last) = (number(first)?, number(last)?);
            if last < first {
                return Err(format!("{first}..{last} ends before it begins; write {last}..{first}"));
            }
            if last - first >= MOST_SEEDS {
                return Err(format!("{first}..{last} are too many seeds; {MOST_SEEDS} at most can be run"));
            }
            (first..=last).collect()
        } else if text.contains(',') {
            text.split(',').filter(|part| !part.trim().is_empty()).map(number).collect::<std::result::Result<_, _>>()?
        } else {
            match number(text)? {
                0 => return Err(format!("none is not enough; {}", wrong())),
                count if count > MOST_SEEDS => {
                    return Err(format!("{count} seeds are too many; one alone is {count}..{count}"));
                }
                count => (1..=count).collect(),
            }
        };
        let mut seen = std::collections::BTreeSet::new();
        match seeds.iter().find(|seed| !seen.insert(**seed)) {
            Some(twice) => Err(format!("seed {twice} is listed twice")),
            None if seeds.is_empty() => Err(wrong()),
            None => Ok(Self(seeds)),
        }
    }
}

/// Least and greatest memory (bytes): the program alone needs more than the least, and no machine has the greatest.
const MEMORY: std::ops::RangeInclusive<f64> = 1e6..=1e18;

/// A size in memory, written as `512MB` or `4GiB`.
pub fn bytes(text: &str) -> std::result::Result<u64, String> {
    let wrong = || "write a size with its unit, such as 512MB or 4GB".to_string();
    let text = text.trim();
    let unit = text.find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E')).ok_or_else(wrong)?;
    let (number, unit) = text.split_at(unit);
    let factor: f64 = match unit.trim().to_ascii_lowercase().as_str() {
        "b" => 1.0,
        "kb" => 1e3,
        "kib" => 1024.0,
        "mb" => 1e6,
        "gb" => 1e9,
        "tb" => 1e12,
        "mib" => 1_048_576.0,
        "gib" => 1_073_741_824.0,
        _ => return Err(wrong()),
    };
    let size = number.trim().parse::<f64>().map_err(|_| wrong())? * factor;
    if MEMORY.contains(&size) { Ok(size as u64) } else { Err("a memory is from 1MB to 1000000TB".into()) }
}

/// A number within a range, both ends included; `words` say what it is, in its unit.
pub fn within(least: f64, most: f64, words: &'static str) -> impl Fn(&str) -> std::result::Result<f64, String> + Clone {
    move |text| match text.trim().parse::<f64>() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        _ => Err(format!("write {words} from {least} to {most}")),
    }
}

/// Pixels, written as `1280x720`.
pub fn size(text: &str) -> std::result::Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X', '×']);
    let parsed = sides.and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]));
    match parsed {
        Some([w, h]) if FRAME_SIDE.contains(&w) && FRAME_SIDE.contains(&h) => Ok([w, h]),
        _ => {
            let (least, most) = FRAME_SIDE.into_inner();
            Err(format!("write width and height in pixels, such as 1280x720, each from {least} to {most}"))
        }
    }
}

/// A range of strain in per cent, written as `20..26`; either end may be left out. Gives fractions (-).
pub fn strain_range(text: &str) -> std::result::Result<[f64; 2], String> {
    let wrong = || "write two strains in per cent, such as 20..26, 20.. or ..26".to_string();
    let (from, to) = text.split_once("..").ok_or_else(wrong)?;
    let end = |side: &str, open: f64| match side.trim().trim_end_matches('%').trim() {
        "" => Ok(open),
        number => match number.parse::<f64>() {
            Ok(percent) if percent.is_finite() => Ok(percent / 100.0),
            _ => Err(wrong()),
        },
    };
    let range = [end(from, f64::NEG_INFINITY)?, end(to, f64::INFINITY)?];
    if range[0] <= range[1] {
        return Ok(range);
    }
    Err(format!("{text} ends before it begins; write {}..{}", to.trim(), from.trim()))
}

/// Longest span of time (s): a hundred years and more.
const LONGEST_TIME: f64 = 3600.0 * 1e6;

/// Reads a length greater than 0, such as `0.39 mm` (m).
pub fn length(text: &str) -> std::result::Result<f64, String> {
    let parsed = units::parse(text, Dimension::Length).map_err(|error| format!("{error}; {}", error.help))?;
    match parsed > 0.0 && parsed.is_finite() {
        true => Ok(parsed),
        false => Err("a length is greater than 0, such as 0.39 mm".into()),
    }
}

/// A span of time, written as `90s`, `20m` or `2h`.
pub fn duration(text: &str) -> std::result::Result<Duration, String> {
    let wrong = || "write a time with its unit, such as 90s, 20m or 2h".to_string();
    let text = text.trim();
    let unit = text.chars().last().ok_or_else(wrong)?;
    let seconds = match unit {
        's' => 1.0,
        'm' => 60.0,
        'h' => 3600.0,
        _ => return Err(wrong()),
    };
    let number: f64 = text[..text.len() - 1].trim().parse().map_err(|_| wrong())?;
    let seconds = number * seconds;
    if !(0.0..=LONGEST_TIME).contains(&seconds) {
        return Err(format!("a time is from 0s to {}h", LONGEST_TIME / 3600.0));
    }
    Ok(Duration::from_secs_f64(seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("1280x720"), Ok([1280, 720]));
        for wrong in ["1280", "0x720", "ax2", "1280x", "-1x5", "15x720", "8193x720", "1280x99999999999"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn memory_is_a_number_with_its_unit() {
        assert_eq!(bytes("4GB"), Ok(4_000_000_000));
        assert_eq!(bytes(" 1.5 MiB"), Ok(1_572_864));
        assert_eq!(bytes("2e3kB"), Ok(2_000_000));
        for wrong in ["", "4", "GB", "1..5GB", "nanGB", "infGB", "4 parsec", "4µB"] {
            assert!(bytes(wrong).unwrap_err().contains("with its unit"), "{wrong}");
        }
        for beyond in ["1B", "0GB", "-4GB", "999kB", "1e300GB", "1e999GB", "99999999TB"] {
            assert!(bytes(beyond).unwrap_err().contains("from 1MB to"), "{beyond}");
        }
    }

    #[test]
    fn numbers_have_ranges() {
        let angle = within(-360.0, 360.0, "an angle in degrees");
        assert_eq!(angle("-12.5"), Ok(-12.5));
        for wrong in ["nan", "inf", "-inf", "1e30", "361", "", "x"] {
            assert!(angle(wrong).unwrap_err().contains("from -360 to 360"), "{wrong}");
        }
    }

    #[test]
    fn seeds_are_a_count_a_range_or_a_list() {
        let seeds = |text: &str| text.parse::<Seeds>().map(|seeds| seeds.0);
        assert_eq!(seeds("3"), Ok(vec![1, 2, 3]));
        assert_eq!(seeds("4..6"), Ok(vec![4, 5, 6]));
        assert_eq!(seeds("7..7"), Ok(vec![7]));
        assert_eq!(seeds("5, 1,2"), Ok(vec![5, 1, 2]));
        for wrong in ["", "0", "-1", "a", "1,1", "6..4", "1..", ",", "1.5", "99999999", "1..99999999"] {
            assert!(seeds(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn durations() {
        for (text, seconds) in [("90s", 90), ("20m", 1200), ("0.5 h", 1800)] {
            assert_eq!(duration(text), Ok(Duration::from_secs(seconds)));
        }
        for wrong in ["20", "", "m", "1d", "3µ"] {
            assert!(duration(wrong).unwrap_err().contains("with its unit"), "{wrong}");
        }
        for beyond in ["-3s", "1e300h", "nanh"] {
            assert!(duration(beyond).unwrap_err().contains("from 0s to 1000000h"), "{beyond}");
        }
    }

    #[test]
    fn ranges_of_strain() {
        assert_eq!(strain_range("20..26"), Ok([0.2, 0.26]));
        assert_eq!(strain_range("20 % .. 26 %"), Ok([0.2, 0.26]));
        assert_eq!(strain_range("..5"), Ok([f64::NEG_INFINITY, 0.05]));
        for wrong in ["20", "a..b", "nan..5", "..inf"] {
            assert!(strain_range(wrong).unwrap_err().contains("in per cent"), "{wrong}");
        }
        assert_eq!(strain_range("5 .. 1").unwrap_err(), "5 .. 1 ends before it begins; write 1..5");
    }
}
