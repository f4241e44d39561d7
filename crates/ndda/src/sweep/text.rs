//! Results of a sweep for a terminal.

use std::fmt::Write;

use super::result::{Group, Results};
use crate::columns::columns;

/// Rows of a table, at most.
const MOST_ROWS: usize = 60;

/// The results as text: the table of a grid, or moments, probability and sensitivity of samples.
pub fn text(results: &Results) -> String {
    let mut text = format!("{}\n", results.title);
    if results.drawn.is_none() {
        text.push_str(&table(results));
    }
    for group in &results.groups {
        samples(&mut text, results, group);
    }
    let bounds = results.cases.iter().filter(|row| row.safety_is_bound).count();
    if bounds > 0 {
        let _ = writeln!(
            text,
            "{bounds} of {} cases stand, or fail, at every factor that is tried: their `safety` is the largest or the smallest of these factors; \
             `--of safety_lower,safety_upper` tells which",
            results.cases.len()
        );
    }
    let failed = results.cases.iter().filter(|row| row.reason.is_some());
    let mut failed: Vec<_> = failed.collect();
    let more = failed.len().saturating_sub(5);
    failed.truncate(5);
    for row in failed {
        let reason = row.reason.as_deref().and_then(|reason| reason.lines().next()).unwrap_or_default();
        let _ = writeln!(text, "failed: {}: {reason}", row.name);
    }
    if more > 0 {
        let _ = writeln!(text, "failed: {more} more, see sweep.csv");
    }
    text
}

fn table(results: &Results) -> String {
    let mut header = results.axes.clone();
    header.extend(results.quantities.iter().cloned());
    header.extend(results.has_label.then(|| "label".to_string()));
    header.extend(results.cases.iter().any(|row| row.fails.is_some()).then(|| "fails".to_string()));
    let mut rows = Vec::new();
    for row in results.cases.iter().take(MOST_ROWS) {
        let mut cells = row.labels.clone();
        cells.extend(row.values.iter().map(|value| value.map_or("-".into(), number)));
        if results.has_label {
            cells.push(row.label.clone().unwrap_or_else(|| "failed".into()));
        }
        cells.extend(row.fails.map(|fails| if fails { "yes" } else { "no" }.to_string()));
        cells.resize(header.len(), "-".into());
        rows.push(cells);
    }
    let mut text = format!("{}\n", columns(header, rows));
    if results.cases.len() > MOST_ROWS {
        let _ = writeln!(text, "{} more, see sweep.csv", results.cases.len() - MOST_ROWS);
    }
    text
}

fn samples(text: &mut String, results: &Results, group: &Group) {
    if !group.labels.is_empty() {
        let labels = group.labels.iter().map(|(axis, label)| format!("{axis} = {label}"));
        let _ = writeln!(text, "{}", labels.collect::<Vec<_>>().join(", "));
    }
    let header =
        ["quantity", "mean", "deviation", "least", "5 %", "50 %", "95 %", "largest"].map(String::from);
    let row = |(name, m): &(String, super::statistics::Moments)| {
        let [low, middle, high] = m.quantiles;
        let numbers = [m.mean, m.deviation, m.least, low, middle, high, m.largest].map(number);
        std::iter::once(name.clone()).chain(numbers).collect()
    };
    if !group.moments.is_empty() {
        let _ = writeln!(text, "{}", columns(header.to_vec(), group.moments.iter().map(row).collect()));
    }
    let condition = results.drawn.as_ref().and_then(|drawn| drawn.fails_when.as_deref());
    if let (Some(condition), Some(part)) = (condition, &group.failure) {
        let [low, high] = part.interval95;
        let _ = writeln!(
            text,
            "probability of failure ({condition}): {} ({} to {}), {} of {} samples; in brackets the 95 % interval (Wilson)",
            probability(part.probability),
            probability(low),
            probability(high),
            part.count,
            part.of
        );
    } else if let Some(condition) = condition {
        let _ = writeln!(text, "probability of failure ({condition}): unknown, no sample has a value");
    }
    if group.undecided > 0 {
        let _ = writeln!(text, "without a value: {} samples, which count neither way", group.undecided);
    }
    if !group.sensitivity.is_empty() {
        let header = ["quantity", "parameter", "first order", "±", "total", "±"].map(String::from);
        let row = |index: &super::statistics::Index| {
            let [first, total] = index.half_widths95;
            let numbers = [index.first_order, first, index.total, total].map(|v| format!("{v:.3}"));
            [index.quantity.clone(), index.parameter.clone()].into_iter().chain(numbers).collect()
        };
        let rows = group.sensitivity.iter().map(row).collect();
        let _ = writeln!(
            text,
            "fractions of the variance that each parameter explains (Sobol' indices)\n{}",
            columns(header.to_vec(), rows)
        );
    }
}

/// Three decimals, or three digits where the number is small.
fn probability(value: f64) -> String {
    match value {
        0.0 => "0".into(),
        1.0 => "1".into(),
        small if small < 1e-4 => format!("{small:.2e}"),
        small if small < 0.1 => format!("{small:.digits$}", digits = (2.0 - small.log10().floor()) as usize),
        large if large > 0.9995 => format!("{large:.6}"),
        large => format!("{large:.3}"),
    }
}

/// Six digits, with an exponent where the number is large or small.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e6).contains(&size) => {
            let digits = (5 - size.log10().floor() as i32).max(0) as usize;
            let text = format!("{value:.digits$}");
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
        }
        _ => format!("{value:.5e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_have_three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (0.3, "0.300"),
            (0.24721, "0.247"),
            (0.03333, "0.0333"),
            (1.234e-5, "1.23e-5"),
            (1.0, "1"),
        ] {
            assert_eq!(probability(value), text);
        }
    }

    #[test]
    fn numbers_have_six_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.5, "1.5"),
            (-123456.7, "-123457"),
            (0.00123456789, "0.00123457"),
            (1e-9, "1.00000e-9"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
