//! Tables for people, made from columns of results.

use super::table::Table;

pub use crate::observe::column::{Column, Value, json, write_csv};

/// A table for people of the columns that have a heading; the first `left` of them hold text.
pub fn table<R>(title: String, columns: &[Column<R>], results: &[R], left: usize) -> Table {
    let shown = || columns.iter().filter(|column| !column.heading.is_empty());
    Table {
        title,
        heads: shown().map(Column::label).collect(),
        rows: results.iter().map(|result| shown().map(|column| column.cell(result)).collect()).collect(),
        default: None,
        left,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_with_a_heading_make_a_table() {
        let columns = [
            Column::new("who", "name", "", 0, |r: &(&str, f64)| r.0),
            Column::new("force_n", "force", "N", 1, |r: &(&str, f64)| r.1),
            Column::in_files("known", |r: &(&str, f64)| r.1.is_finite().then_some(1usize)),
        ];
        let table = table("Forces".into(), &columns, &[("a", 1.25), ("b", f64::NAN)], 1);
        assert_eq!(
            (table.heads, table.rows[0].clone()),
            (vec!["name".into(), "force [N]".into()], vec!["a".into(), "1.2".into()])
        );
    }
}
