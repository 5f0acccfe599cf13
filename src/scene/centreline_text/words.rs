//! Lines of a centreline text as words: what parts them, and how what cannot be read is shown.

use super::number::from_millimetres;

/// What a comma means throughout a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Commas {
    /// It parts numbers.
    Separate,
    /// It parts whole numbers from decimals.
    Decimal,
}

impl Commas {
    /// The first line of three numbers that has a comma decides: it can be read one way only, because where commas part
    /// digits, they leave more than three words when they are taken to part numbers.
    pub fn of(lines: &[&str]) -> Self {
        let with_comma = lines.iter().filter(|line| data(line).contains(','));
        let meaning = with_comma.filter_map(|line| {
            [Commas::Separate, Commas::Decimal].into_iter().find(|commas| point(data(line), *commas).is_some())
        });
        meaning.into_iter().next().unwrap_or(Commas::Separate)
    }
}

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Row<'a> {
    /// Nothing but blanks and separators.
    Blank,
    /// A comment on its own.
    Comment(&'a str),
    /// `x y z`, in any case, each perhaps with its unit mm.
    ColumnNames,
    /// Coordinates (m).
    Point([f64; 3]),
    /// None of these.
    Other,
}

/// Lines with any of the three ends, LF, CR LF and CR.
pub(super) fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split_inclusive(['\n', '\r'])
        .scan(false, |after_return, line| {
            // The LF of a CR LF is not a line of its own.
            let rest_of_end = *after_return && line == "\n";
            *after_return = line.ends_with('\r');
            Some((!rest_of_end).then(|| line.trim_end_matches(['\n', '\r'])))
        })
        .flatten()
}

/// Reads a line.
pub(super) fn row(line: &str, commas: Commas) -> Row<'_> {
    let data = data(line);
    if data.chars().all(|c| is_blank(c) || c == ',' || c == ';') {
        let comment = line[data.len()..].strip_prefix('#').map(|comment| comment.trim_matches(is_blank));
        return comment.map_or(Row::Blank, Row::Comment);
    }
    match point(data, commas) {
        Some(point) => Row::Point(point),
        None if are_column_names(data) => Row::ColumnNames,
        None => Row::Other,
    }
}

/// The line as it may stand in a message: what cannot be seen is escaped, and a long line is cut.
pub(super) fn shown(line: &str) -> String {
    const MOST: usize = 60;
    let data = data(line).trim_matches(|c| c == ' ' || c == '\t');
    let escaped = |c: char| match c {
        '\t' => "\\t".to_owned(),
        c if c != ' ' && (is_blank(c) || c.is_control() || is_format(c)) => c.escape_unicode().to_string(),
        c => c.to_string(),
    };
    let text: String = data.chars().take(MOST).map(escaped).collect();
    if data.chars().nth(MOST).is_some() { text + " …" } else { text }
}

/// What stands before a comment.
fn data(line: &str) -> &str {
    line.split_once('#').map_or(line, |(data, _)| data)
}

/// White space of any kind, and what has no width: a byte order mark, a zero-width space.
fn is_blank(c: char) -> bool {
    c.is_whitespace() || ['\u{feff}', '\u{200b}'].contains(&c)
}

/// Characters that steer how text is set and have no shape of their own.
fn is_format(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{200c}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{2069}')
}

/// Three finite numbers (m).
fn point(data: &str, commas: Commas) -> Option<[f64; 3]> {
    let parts = |c: char| is_blank(c) || c == ';' || (c == ',' && commas == Commas::Separate);
    let mut words = data.split(parts).filter(|word| !word.is_empty());
    let mut next = || number(words.next()?, commas);
    let point = [next()?, next()?, next()?];
    words.next().is_none().then_some(point)
}

fn number(word: &str, commas: Commas) -> Option<f64> {
    match commas {
        Commas::Separate => from_millimetres(word),
        // Thousands parted by points, or a comma at an end, may mean something else.
        Commas::Decimal if word.contains(',') => {
            let (whole, decimals) = word.split_once(',')?;
            let has_digits =
                whole.ends_with(|c: char| c.is_ascii_digit()) && decimals.starts_with(|c: char| c.is_ascii_digit());
            (has_digits && !word.contains('.')).then(|| from_millimetres(&format!("{whole}.{decimals}"))).flatten()
        }
        // Points part decimals elsewhere.
        Commas::Decimal => (!word.contains('.')).then(|| from_millimetres(word)).flatten(),
    }
}

/// Whether these are the words x, y and z, each perhaps with mm after it.
fn are_column_names(data: &str) -> bool {
    let letters: String = data.to_lowercase().chars().filter(|c| !is_blank(*c) && !",;[]()_\"".contains(*c)).collect();
    ["xyz", "xmmymmzmm"].contains(&letters.as_str())
}
