//! Columns of text, the first to the left and figures to the right: in a frame with the feature `tables`, without one else.

/// A table with a header.
#[cfg(feature = "tables")]
pub fn columns(header: Vec<String>, rows: Vec<Vec<String>>) -> String {
    use comfy_table::presets::UTF8_BORDERS_ONLY;
    use comfy_table::{CellAlignment, Table};

    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_header(header);
    table.add_rows(rows);
    table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    table.to_string()
}

/// A table with a header.
#[cfg(not(feature = "tables"))]
pub fn columns(header: Vec<String>, rows: Vec<Vec<String>>) -> String {
    let lines: Vec<Vec<String>> = std::iter::once(header).chain(rows).collect();
    let width = |column: usize| {
        lines.iter().filter_map(|l| l.get(column)).map(|c| c.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..lines[0].len()).map(width).collect();
    let cell = |(k, text): (usize, &String)| {
        let width = widths[k];
        if k == 0 { format!("{text:<width$}") } else { format!("{text:>width$}") }
    };
    let line = |cells: &Vec<String>| cells.iter().enumerate().map(cell).collect::<Vec<_>>().join("  ");
    lines.iter().map(line).collect::<Vec<_>>().join("\n")
}
