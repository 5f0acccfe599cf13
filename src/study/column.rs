//! Tables for people, made from columns of results.

use super::table::Table;

pub use crate::observe::column::{Column, TableSink, Value, json, write_csv};

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
        let columns =
            [Column::new("force_n", "force", "N", 1, |force: &f64| *force), Column::in_files("double", |f| 2.0 * f)];
        let table = table("Forces".into(), &columns, &[1.25], 0);
        assert_eq!((table.heads, table.rows), (vec!["force [N]".into()], vec![vec!["1.2".into()]]));
    }
}
