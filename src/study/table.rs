//! Tables of studies, on the screen and on pages.

use serde::Serialize;

/// A table for people, as it stands on the screen and on the page.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    /// Its heading.
    pub title: String,
    /// Heads of the columns, with units.
    pub heads: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
    /// Which of the rows is the scene as it stands.
    pub default: Option<usize>,
    /// Columns at the left that hold text; the others hold numbers, but for one headed "note".
    #[serde(skip)]
    pub left: usize,
}

/// A table as lines of text.
pub struct Aligned {
    /// One line or more above the rows.
    pub head: String,
    /// A line for each row.
    pub rows: Vec<String>,
    /// Characters of the longest line.
    width: usize,
}

impl Table {
    /// Text to the left, numbers to the right, a note at the end.
    pub fn to_text(&self) -> String {
        // Units stand below what they belong to, which keeps columns narrow.
        let split = |head: &String| match head.split_once(" [") {
            Some((what, unit)) => [what.to_string(), format!("[{unit}")],
            None => [head.clone(), String::new()],
        };
        let heads: Vec<[String; 2]> = self.heads.iter().map(split).collect();
        let heads = [0, 1].map(|k| heads.iter().map(|head| head[k].clone()).collect());
        let text = self.lines(&heads, "", "note");
        format!("{}\n{}{}\n{}", self.title, text.head, "-".repeat(text.width), text.rows.concat())
    }

    /// Lines with the heads as they are, `indent` before each; the columns at the left and the one headed `last` hold
    /// text.
    pub fn aligned(&self, indent: &str, last: &str) -> Aligned {
        self.lines(std::slice::from_ref(&self.heads), indent, last)
    }

    fn lines(&self, heads: &[Vec<String>], indent: &str, last: &str) -> Aligned {
        let width = |k: usize| {
            let cells = heads.iter().chain(&self.rows).map(|row| &row[k]);
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.heads.len()).map(width).collect();
        let line = |cells: &Vec<String>| {
            let padded = cells.iter().enumerate().map(|(k, cell)| {
                let pad = " ".repeat(widths[k] - cell.chars().count());
                if k < self.left || self.heads[k] == last { format!("{cell}{pad}") } else { format!("{pad}{cell}") }
            });
            (indent.to_owned() + &padded.collect::<Vec<_>>().join("  ")).trim_end().to_owned() + "\n"
        };
        Aligned {
            head: heads.iter().map(line).collect(),
            rows: self.rows.iter().map(line).collect(),
            width: widths.iter().sum::<usize>() + 2 * (widths.len() - 1),
        }
    }
}
