//! Centrelines as text: how a CAD model's wires come in, and how a strand's go out.
//!
//! One block per wire, blocks parted by blank lines; one point `x y z` per line in mm; `#` begins a comment. A comment
//! `# wire 3 layer outer diameter 0.39 mm` at the head of a block names the wire's layer and its diameter.
//!
//! What other programs write is read where it has one meaning: UTF-8 and UTF-16 with a byte order mark, any line ends,
//! blanks of any kind, commas, semicolons and tabs between numbers, rows of empty cells as blank lines, a row of column
//! names, and decimal commas where something else parts the numbers.

mod number;
mod words;

use crate::base::error::{Error, Result};
use glam::DVec3;
use number::{from_millimetres, shifted};
use std::fmt::Write;
use std::path::Path;
use words::{Commas, Row};

/// Layer of a wire whose block names none.
pub const DEFAULT_LAYER: &str = "wire";

/// The centreline of one wire.
#[derive(Debug, Clone, PartialEq)]
pub struct CentrelineWire {
    /// Name of its layer; "wire" where the text names none.
    pub layer: String,
    /// Wire diameter (m), where the text gives it.
    pub diameter: Option<f64>,
    /// Points along it, two at least (m).
    pub points: Vec<DVec3>,
}

/// Text of a file's bytes: UTF-8, or UTF-16 where a byte order mark says so; `None` when it is neither.
pub fn decode(bytes: &[u8]) -> Option<String> {
    let utf16 = |unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks(2).map(|b| unit([b[0], *b.get(1).unwrap_or(&0)])).collect();
        String::from_utf16(&units).ok()
    };
    match bytes {
        [0xFF, 0xFE, ..] => utf16(u16::from_le_bytes),
        [0xFE, 0xFF, ..] => utf16(u16::from_be_bytes),
        _ => String::from_utf8(bytes.to_vec()).ok(),
    }
}

/// Reads centrelines. `path` serves the messages only.
///
/// Errors name file and line: a line that is not three finite numbers, a wire of one point, a broken header, a text without
/// wires.
pub fn parse(text: &str, path: &Path) -> Result<Vec<CentrelineWire>> {
    let lines: Vec<&str> = words::lines(text).collect();
    let mut reader = Reader {
        path,
        commas: Commas::of(&lines),
        wires: Vec::new(),
        header: Header::default(),
        points: Vec::new(),
        line: 0,
    };
    for (index, line) in lines.iter().enumerate() {
        reader.line = index + 1;
        reader.read(line)?;
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
    commas: Commas,
    wires: Vec<CentrelineWire>,
    header: Header,
    points: Vec<DVec3>,
    line: usize,
}

impl Reader<'_> {
    fn read(&mut self, line: &str) -> Result<()> {
        match words::row(line, self.commas) {
            Row::Blank => self.end_block(),
            Row::Comment(comment) => self.read_comment(comment),
            // Above a block only: between points it would be a torn line.
            Row::ColumnNames if self.points.is_empty() => Ok(()),
            Row::Point([x, y, z]) => {
                self.points.push(DVec3::new(x, y, z));
                Ok(())
            }
            Row::ColumnNames | Row::Other => Err(self.error(
                &format!("`{}` is not three finite numbers", words::shown(line)),
                "write x y z in mm, for example 1.165 0 12.5",
            )),
        }
    }

    /// Takes `wire N [layer NAME] [diameter D mm]`; any other comment is for people.
    fn read_comment(&mut self, comment: &str) -> Result<()> {
        let mut words = comment.split_whitespace();
        if !words.next().is_some_and(|word| word.eq_ignore_ascii_case("wire")) {
            return Ok(());
        }
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
        let diameter_at = words.iter().rposition(|word| word.eq_ignore_ascii_case("diameter")).unwrap_or(words.len());
        let (layer, diameter) = words.split_at(diameter_at);
        self.header = Header { layer: self.header_layer(layer)?, diameter: self.header_diameter(diameter)? };
        Ok(())
    }

    fn header_layer(&self, words: &[&str]) -> Result<Option<String>> {
        match words {
            [] => Ok(None),
            [layer, name @ ..] if layer.eq_ignore_ascii_case("layer") && !name.is_empty() => Ok(Some(name.join(" "))),
            _ => Err(self.bad_header()),
        }
    }

    fn header_diameter(&self, words: &[&str]) -> Result<Option<f64>> {
        match words {
            [] => Ok(None),
            [_, number, unit] if unit.eq_ignore_ascii_case("mm") => {
                // Nothing else in a header has a comma, so that it can only be a decimal one.
                let diameter = from_millimetres(&number.replace(',', "."));
                diameter.filter(|diameter| *diameter > 0.0).map(Some).ok_or_else(|| self.bad_header())
            }
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

/// A length (m) as decimal text in mm: the point of the shortest decimal text is moved, so that no digit is lost.
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
        assert!(line_of("0 0 0\n\n0 0 0\n0 0 1\n").contains("line 2: the wire that ends here"));
        assert!(line_of("# wire 1 layer a diameter 0.39\n0 0 0\n0 0 1\n").contains("line 1: the header"));
        assert!(line_of("0 0 0\n0 0 1\n# wire 2\n0 1 0\n0 1 1").contains("line 3: a new wire"));
        assert!(line_of("0 0 0\n0 0 inf\n").contains("line 2"));
        assert!(line_of("# nothing\n").contains("no wires"));
        // A row of column names stands above points, in mm.
        assert!(line_of("0 0 0\nx y z\n0 0 1\n").contains("line 2: `x y z`"));
        assert!(line_of("x [in] y [in] z [in]\n0 0 0\n0 0 1\n").contains("line 1"));
    }

    /// Each text says the same, whatever program wrote it.
    #[test]
    fn text_that_has_one_meaning_is_read() {
        let right = [DVec3::ZERO, DVec3::new(0.5e-3, 0.0, 4e-3), DVec3::new(3e-3, 0.0, 12e-3)];
        for text in [
            "0 0 0\n0.5 0 4\n3 0 12\n",
            "\u{feff}0 0 0\n0.5 0 4\n3 0 12\n",
            "0 0 0\r0.5 0 4\r3 0 12",
            "0 0 0\r\n0.5 0 4\r\n3 0 12\r\n",
            "0\u{a0}0\u{a0}0\n0.5\u{202f}0\u{2009}4\n3\u{200b} 0 12\n",
            "0;0;0\n0,5;0;4\n3;0;12\n",
            "0\t0\t0\n0,5\t0\t4\n3,0\t0\t12,0\n",
            "0,0 0,0 0,0\n0,5 0,0 4,0\n3,0 0,0 12,0\n",
            "0, 0, 0\n0.5, 0, 4\n3, 0, 12\n",
            "0,0,0,,\n0.5,0,4,,\n3,0,12,,\n",
            "X,Y,Z\n0,0,0\n0.5,0,4\n3,0,12\n",
            "x [mm];Y [MM];z (mm)\n0;0;0\n0,5;0;4\n3;0;12\n",
        ] {
            let wires = parse(text, Path::new("w")).unwrap_or_else(|error| panic!("{text:?}: {error}"));
            assert_eq!((wires.len(), &wires[0].points[..]), (1, &right[..]), "{text:?}");
        }
        let two = parse("0,0,0\n0,0,1\n,,\n1,0,0\n1,0,1\n", Path::new("w")).unwrap();
        assert_eq!(two.len(), 2, "a row of empty cells is blank");
        let header = parse("#WIRE 1 Layer Outer Left DIAMETER 0,39 MM\n0 0 0\n0 0 1\n", Path::new("w")).unwrap();
        assert_eq!((header[0].layer.as_str(), header[0].diameter), ("Outer Left", Some(0.39e-3)));
    }

    #[test]
    fn utf_16_is_told_by_its_mark() {
        let text = "0 0 0\n0 0 1\n";
        let little: Vec<u8> = [0xFEFF].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = [0xFEFF].into_iter().chain(text.encode_utf16()).flat_map(u16::to_be_bytes).collect();
        assert_eq!([decode(&little), decode(&big), decode(text.as_bytes())], [0; 3].map(|_| Some(text.to_owned())));
        assert_eq!(decode(&[b'0', 0xE9]), None);
    }

    /// Commas that part numbers in one line do not part digits in the next.
    #[test]
    fn a_comma_has_one_meaning_throughout() {
        assert!(line_of("0;0;0\n0,5;0;4\n1,2\n").contains("line 3: `1,2`"));
        assert!(line_of("0,5;0;4\n1,0,2\n").contains("line 2: `1,0,2`"));
        assert!(line_of("0,0,0\n0,5;0;4\n").contains("line 2: `0,5;0;4`"));
        assert!(line_of("0,5;1.5;4\n0,5;1;5\n").contains("line 1"));
    }

    #[test]
    fn what_cannot_be_seen_is_shown() {
        assert!(line_of("0 0 0\n0 0\u{7}1 1\n").contains("line 2: `0 0\\u{7}1 1`"));
        assert!(line_of("0 0 0\n0 0 1\u{ad}0\n").contains("`0 0 1\\u{ad}0`"));
        assert!(line_of("0 0\u{a0}x\n").contains("`0 0\\u{a0}x`"));
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
