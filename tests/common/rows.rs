//! Tables that the program writes, read as (column → cell).

#![allow(dead_code, reason = "each test binary uses its own part")]

use std::collections::HashMap;
use std::path::Path;

/// A row: column → cell.
pub type Row = HashMap<String, String>;

/// The rows of a CSV file.
pub fn rows(path: &Path) -> Vec<Row> {
    let mut reader = csv::Reader::from_path(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

/// The number in a column of a row.
pub fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} is {:?} in {row:?}", row[column]))
}

/// The numbers in a column; NaN where a cell holds none.
pub fn column(rows: &[Row], name: &str) -> Vec<f64> {
    let cell = |row: &Row| row.get(name).unwrap_or_else(|| panic!("{name} in {row:?}")).parse().unwrap_or(f64::NAN);
    rows.iter().map(cell).collect()
}
