//! Centrelines as text: how a CAD model's wires come in, and how a strand's go out.
//!
//! One block per wire, blocks parted by blank lines; one point `x y z` per line in mm; `#` begins a comment. A comment
//! `# wire 3 layer outer diameter 0.39 mm` at the head of a block names the wire's layer and its diameter.

use crate::base::error::{Error, Result};
use glam::DVec3;
use std::fmt::Write;
use std::path::Path;

/// Layer of a wire whose block names none.
const DEFAULT_LAYER: &str = "wire";

/// The centreline of one wire.
#[derive(Debug, Clone, PartialEq)]
pub struct CentrelineWire {
    /// Name of its layer; "wire" where the text names none.
    pub layer: String,
    /// Wire diameter [m], where the text gives it.
    pub diameter: Option<f64>,
    /// Points along it, two at least [m].
    pub points: Vec<DVec3>,
}

/// Reads centrelines. `path` serves the messages only.
///
/// Errors name file and line: a line that is not three finite numbers, a point that repeats the one before, a wire of
/// one point, a broken header, a text without wires.
pub fn parse(text: &str, path: &Path) -> Result<Vec<CentrelineWire>> {
    let mut reader = Reader { path, wires: Vec::new(), header: Header::default(), points: Vec::new(), line: 0 };
    for (index, line) in text.lines().enumerate() {
        reader.line = index + 1;
        reader.read(line.trim())?;
    }
    reader.end_block()?;
    match reader.wires.is_empty() {
        true => Err(Error::input(
            format!("{} holds no wires", path.display()),
            "write one point `x y z` per line in mm, and a blank line between wires",
        )),
        false => Ok(reader.wires),
    }
}

/// Writes centrelines so that [`parse`] gives back exactly the same numbers.
pub fn write(wires: &[CentrelineWire]) -> String {
    let mut text = String::from("# Centrelines: x y z in mm, one block per wire.\n");
    for (index, wire) in wires.iter().enumerate() {
        let _ = write!(text, "\n# wire {} layer {}", index + 1, wire.layer);
        if let Some(diameter) = wire.diameter {
            let _ = write!(text, " diameter {} mm", in_millimetres(diameter));
        }
        text.push('\n');
        for point in &wire.points {
            let [x, y, z] = point.to_array().map(in_millimetres);
            let _ = writeln!(text, "{x} {y} {z}");
        }
    }
    text
}

#[derive(Default)]
struct Header {
    layer: Option<String>,
    diameter: Option<f64>,
}

struct Reader<'a> {
    path: &'a Path,
    wires: Vec<CentrelineWire>,
    header: Header,
    points: Vec<DVec3>,
    line: usize,
}

impl Reader<'_> {
    fn read(&mut self, line: &str) -> Result<()> {
        let (data, comment) = line.split_once('#').unwrap_or((line, ""));
        if line.is_empty() {
            return self.end_block();
        }
        if data.trim().is_empty() {
            return self.read_comment(comment.trim());
        }
        let point = self.read_point(data)?;
        if self.points.last() == Some(&point) {
            return Err(self.error("this point repeats the one before it", "remove one of the two"));
        }
        self.points.push(point);
        Ok(())
    }

    fn read_point(&self, data: &str) -> Result<DVec3> {
        let numbers: Vec<Option<f64>> =
            data.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty()).map(from_millimetres).collect();
        match numbers[..] {
            [Some(x), Some(y), Some(z)] => Ok(DVec3::new(x, y, z)),
            _ => Err(self.error(
                &format!("`{}` is not three finite numbers", data.trim()),
                "write x y z in mm, for example 1.165 0 12.5",
            )),
        }
    }

    /// Takes `wire N [layer NAME] [diameter D mm]`; any other comment is for people.
    fn read_comment(&mut self, comment: &str) -> Result<()> {
        let Some(rest) = comment.strip_prefix("wire ") else {
            return Ok(());
        };
        let mut words = rest.split_whitespace();
        let number = words.next().map(str::parse::<usize>);
        if !matches!(number, Some(Ok(_))) {
            return Ok(());
        }
        if !self.points.is_empty() {
            return Err(
                self.error("a new wire begins here without a blank line before it", "put a blank line between wires")
            );
        }
        let words: Vec<&str> = words.collect();
        let diameter_at = words.iter().rposition(|word| *word == "diameter").unwrap_or(words.len());
        let (layer, diameter) = words.split_at(diameter_at);
        self.header = Header { layer: self.header_layer(layer)?, diameter: self.header_diameter(diameter)? };
        Ok(())
    }

    fn header_layer(&self, words: &[&str]) -> Result<Option<String>> {
        match words {
            [] => Ok(None),
            ["layer", name @ ..] if !name.is_empty() => Ok(Some(name.join(" "))),
            _ => Err(self.bad_header()),
        }
    }

    fn header_diameter(&self, words: &[&str]) -> Result<Option<f64>> {
        match words {
            [] => Ok(None),
            ["diameter", number, "mm"] => match from_millimetres(number).filter(|diameter| *diameter > 0.0) {
                Some(diameter) => Ok(Some(diameter)),
                None => Err(self.bad_header()),
            },
            _ => Err(self.bad_header()),
        }
    }

    fn bad_header(&self) -> Error {
        self.error("the header of this wire cannot be read", "write for example # wire 3 layer outer diameter 0.39 mm")
    }

    fn end_block(&mut self) -> Result<()> {
        match self.points.len() {
            // Blank lines may follow one another, and a header may stand apart from its points.
            0 => Ok(()),
            1 => Err(self.error("the wire that ends here has one point only", "a wire needs two points at least")),
            _ => {
                let header = std::mem::take(&mut self.header);
                self.wires.push(CentrelineWire {
                    layer: header.layer.unwrap_or_else(|| DEFAULT_LAYER.to_owned()),
                    diameter: header.diameter,
                    points: std::mem::take(&mut self.points),
                });
                Ok(())
            }
        }
    }

    fn error(&self, what: &str, help: &str) -> Error {
        Error::input(format!("{}, line {}: {what}", self.path.display(), self.line), help)
    }
}

/// A length [m] as decimal text in mm: the point of the shortest decimal text is moved, so that no digit is lost.
fn in_millimetres(metres: f64) -> String {
    let text = format!("{metres:e}");
    let (digits, exponent) = shifted(&text, 3).expect("a formatted number is a number");
    // Plain notation where it is exact and short.
    let plain = format!("{digits}e{exponent}").parse::<f64>().map(|value| value.to_string());
    match plain {
        Ok(plain) if plain.len() <= 24 && from_millimetres(&plain) == Some(metres) => plain,
        _ => format!("{digits}e{exponent}"),
    }
}

/// Decimal text in mm as metres; `None` when it is no finite number.
fn from_millimetres(text: &str) -> Option<f64> {
    let (digits, exponent) = shifted(text, -3)?;
    format!("{digits}e{exponent}").parse().ok().filter(|value: &f64| value.is_finite())
}

/// Splits decimal text into digits and exponent, the exponent shifted.
fn shifted(text: &str, by: i32) -> Option<(&str, i32)> {
    text.parse::<f64>().ok().filter(|value| value.is_finite())?;
    match text.split_once(['e', 'E']) {
        Some((digits, exponent)) => Some((digits, exponent.parse::<i32>().ok()? + by)),
        None => Some((text, by)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn line_of(text: &str) -> String {
        parse(text, Path::new("wires.txt")).unwrap_err().to_string()
    }

    #[test]
    fn blocks_headers_and_comments_are_read() {
        let text =
            "# from CAD\n# wire 1 layer outer left diameter 0.39 mm\n0 0 0\n0 0 1 # second\n\n\n0,1,0\n0,1,2\n0,1,3\n";
        let wires = parse(text, Path::new("wires.txt")).unwrap();
        assert_eq!(wires.len(), 2);
        assert_eq!(wires[0].layer, "outer left");
        assert_eq!(wires[0].diameter, Some(0.39e-3));
        assert_eq!(wires[0].points, [DVec3::ZERO, DVec3::new(0.0, 0.0, 1e-3)]);
        assert_eq!((wires[1].layer.as_str(), wires[1].diameter, wires[1].points.len()), ("wire", None, 3));
    }

    #[test]
    fn errors_name_file_and_line() {
        assert!(line_of("0 0 0\n0 0 x\n").starts_with("wires.txt, line 2: `0 0 x`"));
        assert!(line_of("0 0 0\n0 0\n").contains("line 2"));
        assert!(line_of("0 0 0\n0 0 0\n").contains("line 2: this point repeats"));
        assert!(line_of("0 0 0\n\n0 0 0\n0 0 1\n").contains("line 2: the wire that ends here"));
        assert!(line_of("# wire 1 layer a diameter 0.39\n0 0 0\n0 0 1\n").contains("line 1: the header"));
        assert!(line_of("0 0 0\n0 0 1\n# wire 2\n0 1 0\n0 1 1").contains("line 3: a new wire"));
        assert!(line_of("0 0 0\n0 0 inf\n").contains("line 2"));
        assert!(line_of("# nothing\n").contains("no wires"));
    }

    proptest! {
        #[test]
        fn reading_what_was_written_gives_the_same_bits(x in -1.0f64..1.0, y in proptest::num::f64::NORMAL, d in 1e-6f64..1.0) {
            let y = if y.abs() < 1e300 { y } else { 1.0 };
            let wires = vec![CentrelineWire {
                layer: "outer".into(),
                diameter: Some(d),
                points: vec![DVec3::ZERO, DVec3::new(x, y, 1.0 / 3.0)],
            }];
            prop_assert_eq!(parse(&write(&wires), Path::new("w")).unwrap(), wires);
        }
    }
}
