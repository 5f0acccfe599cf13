//! STEP files as text: the exchange structure of ISO 10303-21, simple and complex instances.
//!
//! Only the structure is read here; what entities mean stands in [`super::step`].

use crate::base::error::{Error, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// Lists within lists go no deeper in any schema; a bound keeps the stack.
const DEEPEST: usize = 64;

/// A value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `$` or `*`.
    Omitted,
    /// Integers and reals, finite.
    Number(f64),
    /// `'text'`; also `"binary"`, as it stands.
    Text(String),
    /// `.WORD.`.
    Word(String),
    /// `#12`.
    Reference(u64),
    /// `(a, b)`.
    List(Vec<Value>),
    /// `NAME(a)`, a value that says its type.
    Typed(String, Vec<Value>),
}

/// An entity with its attributes, in the order of the schema.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Name of the entity, in capitals.
    pub name: String,
    /// Its attributes.
    pub values: Vec<Value>,
}

/// An instance: one record, or several where it is complex.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    /// Line at which it begins, from 1.
    pub line: usize,
    /// Its records.
    pub records: Vec<Record>,
}

/// All instances of a file.
#[derive(Debug, Default)]
pub struct Exchange {
    /// Names of the schemas that the header gives.
    pub schemas: Vec<String>,
    /// The instances by their numbers.
    pub instances: BTreeMap<u64, Instance>,
}

impl Instance {
    /// Attributes of one of its records.
    pub fn record(&self, name: &str) -> Option<&[Value]> {
        self.records.iter().find(|record| record.name == name).map(|record| &record.values[..])
    }

    /// Its name for people: that of its record, or of the one that says most of a complex instance.
    pub fn name(&self) -> String {
        match &self.records[..] {
            [only] => only.name.clone(),
            records => records.iter().map(|record| record.name.as_str()).collect::<Vec<_>>().join(" + "),
        }
    }
}

/// Whether text begins as such a file does.
pub fn is_one(text: &str) -> bool {
    text.trim_start_matches('\u{feff}').trim_start().starts_with("ISO-10303-21")
}

/// Reads a file's text. `path` serves the messages only.
///
/// # Errors
/// [`Error::Input`] with the line: what is no exchange structure, ends before its end, or has a number that is not finite.
pub fn parse(text: &str, path: &Path) -> Result<Exchange> {
    let mut reader = Reader { path, bytes: text.as_bytes(), at: 0, line: 1 };
    reader.skip_to_start();
    let mut exchange = Exchange::default();
    loop {
        let word = reader.word()?;
        match word.as_str() {
            "ISO-10303-21" | "ENDSEC" => reader.expect(b';')?,
            "HEADER" => {
                reader.expect(b';')?;
                exchange.schemas = reader.header()?;
            }
            "DATA" => {
                // Edition 3 may name its sections.
                if reader.peek() == Some(b'(') {
                    reader.list(0)?;
                }
                reader.expect(b';')?;
                reader.data(&mut exchange.instances)?;
            }
            "ANCHOR" | "REFERENCE" | "SIGNATURE" => reader.skip_section()?,
            "END-ISO-10303-21" => {
                reader.expect(b';')?;
                return Ok(exchange);
            }
            _ => return Err(reader.error(&format!("`{word}` begins no section"), "save the model as STEP again")),
        }
    }
}

struct Reader<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl Reader<'_> {
    fn skip_to_start(&mut self) {
        if self.bytes.starts_with("\u{feff}".as_bytes()) {
            self.at = 3;
        }
    }

    fn error(&self, what: &str, help: &str) -> Error {
        Error::input(format!("{}, line {}: {what}", self.path.display(), self.line), help)
    }

    fn unexpected(&mut self, wanted: &str) -> Error {
        match self.peek() {
            None => self.error(
                "the file ends here, within its data",
                "it was cut off: save or copy it again; a whole one ends with END-ISO-10303-21;",
            ),
            Some(_) => {
                let rest =
                    String::from_utf8_lossy(&self.bytes[self.at..self.bytes.len().min(self.at + 24)]).into_owned();
                let shown: String = rest.chars().take(16).flat_map(char::escape_default).collect();
                self.error(&format!("`{shown}` stands where {wanted} is expected"), "save the model as STEP again")
            }
        }
    }

    /// Next byte after blanks and comments, which stays.
    fn peek(&mut self) -> Option<u8> {
        loop {
            let byte = *self.bytes.get(self.at)?;
            match byte {
                b'\n' => {
                    self.line += 1;
                    self.at += 1;
                }
                byte if byte.is_ascii_whitespace() => self.at += 1,
                b'/' if self.bytes.get(self.at + 1) == Some(&b'*') => {
                    let rest = &self.bytes[self.at + 2..];
                    let end = rest.windows(2).position(|two| two == b"*/");
                    let comment = &rest[..end.unwrap_or(rest.len())];
                    self.line += comment.iter().filter(|byte| **byte == b'\n').count();
                    self.at += 2 + comment.len() + if end.is_some() { 2 } else { 0 };
                }
                byte => return Some(byte),
            }
        }
    }

    fn expect(&mut self, byte: u8) -> Result<()> {
        match self.peek() == Some(byte) {
            true => {
                self.at += 1;
                Ok(())
            }
            false => Err(self.unexpected(&format!("`{}`", char::from(byte)))),
        }
    }

    fn taken_while(&mut self, part: impl Fn(u8) -> bool) -> String {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|byte| !part(*byte)).unwrap_or(rest.len());
        self.at += end;
        String::from_utf8_lossy(&rest[..end]).into_owned()
    }

    fn word(&mut self) -> Result<String> {
        match self.peek() {
            Some(byte) if byte.is_ascii_alphabetic() || byte == b'_' || byte == b'!' => {
                let word = self.taken_while(|byte| byte.is_ascii_alphanumeric() || b"_-!".contains(&byte));
                Ok(word.to_ascii_uppercase())
            }
            _ => Err(self.unexpected("a name")),
        }
    }

    /// Names of schemas; what else the header says has no part in geometry.
    fn header(&mut self) -> Result<Vec<String>> {
        let mut schemas = Vec::new();
        loop {
            let name = self.word()?;
            if name == "ENDSEC" {
                self.expect(b';')?;
                return Ok(schemas);
            }
            let values = self.list(0)?;
            self.expect(b';')?;
            if let ("FILE_SCHEMA", [Value::List(names)]) = (name.as_str(), &values[..]) {
                schemas = names
                    .iter()
                    .filter_map(|name| if let Value::Text(name) = name { Some(name.clone()) } else { None })
                    .collect();
            }
        }
    }

    fn data(&mut self, instances: &mut BTreeMap<u64, Instance>) -> Result<()> {
        loop {
            match self.peek() {
                Some(b'#') => {
                    let line = self.line;
                    let number = self.reference()?;
                    self.expect(b'=')?;
                    let records = self.records()?;
                    self.expect(b';')?;
                    if instances.insert(number, Instance { line, records }).is_some() {
                        return Err(
                            self.error(&format!("#{number} is defined twice"), "each instance has its own number")
                        );
                    }
                }
                Some(_) if self.word()? == "ENDSEC" => return self.expect(b';'),
                _ => return Err(self.unexpected("an instance `#1 = NAME(…);` or ENDSEC")),
            }
        }
    }

    fn skip_section(&mut self) -> Result<()> {
        while self.peek().is_some() {
            if self.bytes[self.at..].starts_with(b"ENDSEC") {
                return Ok(());
            }
            // Words within texts end no section.
            if self.peek() == Some(b'\'') {
                self.text(b'\'')?;
            } else {
                self.at += 1;
            }
        }
        Err(self.unexpected("ENDSEC"))
    }

    fn records(&mut self) -> Result<Vec<Record>> {
        if self.peek() != Some(b'(') {
            return Ok(vec![self.record()?]);
        }
        self.at += 1;
        let mut records = Vec::new();
        while self.peek() != Some(b')') {
            records.push(self.record()?);
        }
        self.at += 1;
        match records.is_empty() {
            true => Err(self.error("a complex instance has no record", "save the model as STEP again")),
            false => Ok(records),
        }
    }

    fn record(&mut self) -> Result<Record> {
        Ok(Record { name: self.word()?, values: self.list(0)? })
    }

    fn list(&mut self, depth: usize) -> Result<Vec<Value>> {
        if depth > DEEPEST {
            return Err(
                self.error(&format!("lists are nested more than {DEEPEST} deep"), "save the model as STEP again")
            );
        }
        self.expect(b'(')?;
        let mut values = Vec::new();
        if self.peek() == Some(b')') {
            self.at += 1;
            return Ok(values);
        }
        loop {
            values.push(self.value(depth)?);
            match self.peek() {
                Some(b',') => self.at += 1,
                Some(b')') => {
                    self.at += 1;
                    return Ok(values);
                }
                _ => return Err(self.unexpected("`,` or `)`")),
            }
        }
    }

    fn value(&mut self, depth: usize) -> Result<Value> {
        match self.peek() {
            Some(b'$' | b'*') => {
                self.at += 1;
                Ok(Value::Omitted)
            }
            Some(b'(') => Ok(Value::List(self.list(depth + 1)?)),
            Some(quote @ (b'\'' | b'"')) => self.text(quote).map(Value::Text),
            Some(b'#') => self.reference().map(Value::Reference),
            Some(b'.') => self.enumeration(),
            Some(byte) if byte.is_ascii_digit() || byte == b'-' || byte == b'+' => self.number(),
            Some(byte) if byte.is_ascii_alphabetic() || byte == b'!' => {
                let name = self.word()?;
                match self.peek() {
                    Some(b'(') => Ok(Value::Typed(name, self.list(depth + 1)?)),
                    _ => {
                        Err(self.error(&format!("`{name}` is no value"), "numbers are finite and written with digits"))
                    }
                }
            }
            _ => Err(self.unexpected("a value")),
        }
    }

    fn reference(&mut self) -> Result<u64> {
        self.expect(b'#')?;
        let digits = self.taken_while(|byte| byte.is_ascii_digit());
        digits
            .parse()
            .map_err(|_| self.error(&format!("`#{digits}` names no instance"), "instances are named #1 and so on"))
    }

    fn enumeration(&mut self) -> Result<Value> {
        self.at += 1;
        let word = self.taken_while(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        match self.bytes.get(self.at) {
            Some(b'.') if !word.is_empty() => {
                self.at += 1;
                Ok(Value::Word(word.to_ascii_uppercase()))
            }
            _ => Err(self.unexpected("a word between points, such as .T.")),
        }
    }

    fn number(&mut self) -> Result<Value> {
        let text = self.taken_while(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        value.map(Value::Number).ok_or_else(|| {
            self.error(&format!("`{text}` is no finite number"), "write it with digits, such as 1.25E-3")
        })
    }

    /// A text with its quotes; a quote is doubled within.
    fn text(&mut self, quote: u8) -> Result<String> {
        self.at += 1;
        let from = self.at;
        loop {
            match self.bytes.get(self.at) {
                None => return Err(self.unexpected("the end of a text")),
                Some(byte) if *byte == quote => {
                    self.at += 1;
                    if self.bytes.get(self.at) != Some(&quote) {
                        let text = String::from_utf8_lossy(&self.bytes[from..self.at - 1]).into_owned();
                        return Ok(text.replace("''", "'"));
                    }
                    self.at += 1;
                }
                Some(byte) => {
                    self.line += usize::from(*byte == b'\n');
                    self.at += 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(data: &str) -> Result<Exchange> {
        let text = format!(
            "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AP'));\nENDSEC;\nDATA;\n{data}\nENDSEC;\nEND-ISO-10303-21;\n"
        );
        parse(&text, Path::new("a.step"))
    }

    #[test]
    fn values_of_all_kinds_are_read() {
        let exchange =
            read("#1 = A($,*,1.5E-1,-2,'it''s',.T.,#7,((1.),()),LENGTH_MEASURE(25.4));\n/* #2 */ #3=( B(1) C() );");
        let exchange = exchange.unwrap();
        let one = &exchange.instances[&1];
        assert_eq!((one.line, one.name()), (6, "A".to_owned()));
        let number = Value::Number;
        assert_eq!(
            one.record("A").unwrap(),
            [
                Value::Omitted,
                Value::Omitted,
                number(0.15),
                number(-2.0),
                Value::Text("it's".into()),
                Value::Word("T".into()),
                Value::Reference(7),
                Value::List(vec![Value::List(vec![number(1.0)]), Value::List(vec![])]),
                Value::Typed("LENGTH_MEASURE".into(), vec![number(25.4)]),
            ]
        );
        assert_eq!((exchange.instances[&3].line, exchange.instances[&3].name()), (7, "B + C".into()));
        assert_eq!((exchange.instances.len(), &exchange.schemas[..]), (2, &["AP".to_owned()][..]));
    }

    #[test]
    fn errors_name_the_line() {
        for (data, told) in [
            ("#1 = A(NAN);", "line 6: `NAN` is no value"),
            ("\n#1 = A(1.E999);", "line 7: `1.E999` is no finite number"),
            ("#1 = A(1);\n#1 = A(2);", "line 7: #1 is defined twice"),
            ("#1 = A('open", "the file ends here"),
            ("#1 = A(1;", "line 6: `;"),
            ("#99999999999999999999 = A();", "names no instance"),
        ] {
            let message = read(data).unwrap_err().to_string();
            assert!(message.contains(told), "{data}: {message}");
        }
        let nested = format!("#1 = A({}1{});", "(".repeat(100_000), ")".repeat(100_000));
        assert!(read(&nested).unwrap_err().to_string().contains("nested"));
        let cut = parse("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1 = A(1);\n", Path::new("a")).unwrap_err();
        assert!(cut.to_string().contains("line 6: the file ends here"), "{cut}");
    }
}
