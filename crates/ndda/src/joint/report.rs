//! A test of a joint in words, as a table and as CSV.

use std::fmt::Write;

use super::{ClosureRow, Comparison, ShearRow};

/// Rows of a table on a screen, at most.
const MOST_ROWS: usize = 21;

/// Columns of a direct-shear test: head, unit of the table and what it is of the field's own.
const SHEAR: [(&str, &str, f64); 7] = [
    ("slip", "mm", 1e3),
    ("shear stress", "MPa", 1e-6),
    ("normal stress", "MPa", 1e-6),
    ("opening", "mm", 1e3),
    ("dilation", "mm", 1e3),
    ("plastic slip", "mm", 1e3),
    ("energy lost", "J/m²", 1.0),
];

/// Columns of a closure test: name, unit, factor from SI.
const CLOSURE: [(&str, &str, f64); 4] = [
    ("closure", "mm", 1e3),
    ("normal stress", "MPa", 1e-6),
    ("tangent stiffness", "GPa/m", 1e-9),
    ("energy", "J/m²", 1.0),
];

fn shear_values(row: &ShearRow) -> [f64; 7] {
    let ShearRow { slip_m, shear_pa, normal_pa, opening_m, dilation_m, plastic_slip_m, dissipated_j_m2 } =
        *row;
    [slip_m, shear_pa, normal_pa, opening_m, dilation_m, plastic_slip_m, dissipated_j_m2]
}

fn closure_values(row: &ClosureRow) -> [f64; 4] {
    let ClosureRow { closure_m, normal_pa, tangent_pa_m, energy_j_m2 } = *row;
    [closure_m, normal_pa, tangent_pa_m, energy_j_m2]
}

/// A few rows of many, evenly spaced, the first and the last among them.
pub fn thinned<T: Copy>(rows: &[T]) -> Vec<T> {
    if rows.len() <= MOST_ROWS {
        return rows.to_vec();
    }
    let last = rows.len() - 1;
    (0..MOST_ROWS).map(|k| rows[(k * last + (MOST_ROWS - 1) / 2) / (MOST_ROWS - 1)]).collect()
}

/// All rows of a direct-shear test, with the names of [`ShearRow`] as heads.
pub fn shear_csv(rows: &[ShearRow]) -> String {
    let head = "slip_m,shear_pa,normal_pa,opening_m,dilation_m,plastic_slip_m,dissipated_j_m2";
    csv(head, rows.iter().map(shear_values))
}

/// All rows of a closure test, with the names of [`ClosureRow`] as heads.
pub fn closure_csv(rows: &[ClosureRow]) -> String {
    csv("closure_m,normal_pa,tangent_pa_m,energy_j_m2", rows.iter().map(closure_values))
}

fn csv<const N: usize>(head: &str, rows: impl Iterator<Item = [f64; N]>) -> String {
    let mut out = format!("{head}\n");
    for row in rows {
        let numbers: Vec<String> = row.iter().map(|value| format!("{value:e}")).collect();
        let _ = writeln!(out, "{}", numbers.join(","));
    }
    out
}

/// Rows of either test.
pub enum Rows<'a> {
    /// Of direct shear.
    Shear(&'a [ShearRow]),
    /// Of closure.
    Closure(&'a [ClosureRow]),
}

/// A table of a few rows, and below it what there is to compare with.
pub fn text(rows: &Rows, comparisons: &[Comparison]) -> String {
    let mut out = match rows {
        Rows::Shear(rows) => table(&SHEAR, thinned(rows).iter().map(shear_values)),
        Rows::Closure(rows) => table(&CLOSURE, thinned(rows).iter().map(closure_values)),
    };
    if comparisons.is_empty() {
        out.push_str("no closed form to compare this test with\n");
        return out;
    }
    let _ = writeln!(out, "{:<36}{:>16}{:>16}{:>10}", "beside the closed form", "found", "exact", "error");
    for Comparison { what, unit, measured, exact, error } in comparisons {
        let what = format!("{what} [{unit}]");
        let _ = writeln!(out, "{what:<36}{measured:>16.6e}{exact:>16.6e}{error:>10.1e}");
    }
    out
}

fn table<const N: usize>(columns: &[(&str, &str, f64); N], rows: impl Iterator<Item = [f64; N]>) -> String {
    let mut out = String::new();
    let heads: Vec<String> = columns.iter().map(|(name, unit, _)| format!("{name} [{unit}]")).collect();
    let wide = |k: usize| heads[k].chars().count().max(9) + 2;
    for (k, head) in heads.iter().enumerate() {
        let _ = write!(out, "{head:>width$}", width = wide(k));
    }
    out.push('\n');
    for row in rows {
        for (k, (value, (_, _, factor))) in row.iter().zip(columns).enumerate() {
            let _ = write!(out, "{:>width$}", number(value * factor), width = wide(k));
        }
        out.push('\n');
    }
    out
}

/// A few digits; what is nothing but for rounding is 0.
fn number(value: f64) -> String {
    match value.abs() {
        0.0..1e-12 => "0".into(),
        1e-3..1e4 => format!("{value:.4}"),
        1e4..1e9 => format!("{value:.1}"),
        _ => format!("{value:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_its_first_and_last_row_and_few_others() {
        let rows: Vec<ShearRow> =
            (0..=1000).map(|k| ShearRow { slip_m: f64::from(k), ..ShearRow::default() }).collect();
        let few = thinned(&rows);
        assert_eq!((few.len(), few[0].slip_m, few[20].slip_m), (21, 0.0, 1000.0));
        assert!(few.windows(2).all(|pair| (pair[1].slip_m - pair[0].slip_m - 50.0).abs() <= 1.0));
        assert_eq!(thinned(&rows[..3]).len(), 3);
        let words = text(&Rows::Shear(&rows[..2]), &[]);
        assert_eq!(words.lines().count(), 4);
        assert_eq!(shear_csv(&rows).lines().count(), 1002);
    }

    #[test]
    fn numbers_are_as_long_as_they_need_to_be() {
        assert_eq!(
            [0.0, 1e-17, 0.0126, 123.456789, 104_123.46, 2e9].map(number),
            ["0", "0", "0.0126", "123.4568", "104123.5", "2.000e9"]
        );
    }
}
