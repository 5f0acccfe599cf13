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

impl Table {
    /// Text to the left, numbers to the right, a note at the end.
    pub fn to_text(&self) -> String {
        // Units stand below what they belong to, which keeps columns narrow.
        let split = |head: &String| match head.split_once(" [") {
            Some((what, unit)) => [what.to_string(), format!("[{unit}")],
            None => [head.clone(), String::new()],
        };
        let heads: Vec<[String; 2]> = self.heads.iter().map(split).collect();
        let [whats, units] = [0, 1].map(|k| heads.iter().map(|head| head[k].clone()).collect::<Vec<_>>());
        let width = |k: usize| {
            let cells = self.rows.iter().map(|row| &row[k]).chain(&heads[k]);
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.heads.len()).map(width).collect();
        let line = |cells: &[String]| {
            let padded = cells.iter().enumerate().map(|(k, cell)| {
                let pad = " ".repeat(widths[k] - cell.chars().count());
                if k < self.left || self.heads[k] == "note" { format!("{cell}{pad}") } else { format!("{pad}{cell}") }
            });
            padded.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
        };
        let rule = "-".repeat(widths.iter().sum::<usize>() + 2 * (widths.len() - 1));
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        format!("{}\n{}{}{rule}\n{rows}", self.title, line(&whats), line(&units))
    }
}
