//! Pictures of a sweep: each quantity over the first axis of a grid, or as a histogram of samples.

use std::path::Path;

use ndda_io::WriteError;

use super::result::Results;
use crate::picture;
use crate::plot::{self, Line};
use crate::study::case::plain;

/// Draws and writes a picture of every quantity.
///
/// # Errors
/// [`WriteError`] when one cannot be drawn or written.
pub(super) fn all(out: &Path, results: &Results) -> Result<(), WriteError> {
    for (i, quantity) in results.quantities.iter().enumerate() {
        let (lines, axes) = match results.drawn {
            Some(_) => (histograms(results, quantity), [quantity.clone(), "samples".into()]),
            None => {
                let Some(x) = numeric_axis(results) else { continue };
                (curves(results, x, i), [results.axes[x].clone(), quantity.clone()])
            }
        };
        if lines.iter().all(|line| line.points.is_empty()) {
            continue;
        }
        for ending in picture::ENDINGS {
            let file = out.join(format!("sweep_{}.{ending}", plain(quantity)));
            picture::write(&file, plot::SIZE, |root| plot::draw(root, &lines, &axes, false))?;
        }
    }
    Ok(())
}

/// The first axis whose values are numbers.
fn numeric_axis(results: &Results) -> Option<usize> {
    let is_number = |label: Option<&String>| label.is_some_and(|label| label.parse::<f64>().is_ok());
    (0..results.axes.len()).find(|&i| results.cases.iter().all(|row| is_number(row.labels.get(i))))
}

/// A quantity over an axis, a line for each combination of the others.
fn curves(results: &Results, x: usize, quantity: usize) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for row in &results.cases {
        let (Ok(at), Some(value)) = (row.labels[x].parse::<f64>(), row.values[quantity]) else { continue };
        let others = row.labels.iter().zip(&results.axes).enumerate().filter(|(i, _)| *i != x);
        let name = others.map(|(_, (label, axis))| format!("{axis} {label}")).collect::<Vec<_>>().join(", ");
        let name = if name.is_empty() { results.quantities[quantity].clone() } else { name };
        match lines.iter_mut().find(|line| line.name == name) {
            Some(line) => line.points.push((at, value)),
            None => lines.push(Line { name, points: vec![(at, value)] }),
        }
    }
    lines.iter_mut().for_each(|line| line.points.sort_by(|a, b| a.0.total_cmp(&b.0)));
    lines
}

/// Histograms of a quantity, one for each point of the grid.
fn histograms(results: &Results, quantity: &str) -> Vec<Line> {
    let mut lines = Vec::new();
    for group in &results.groups {
        let Some((_, moments)) = group.moments.iter().find(|(name, _)| name == quantity) else { continue };
        let labels = group.labels.iter().map(|(axis, label)| format!("{axis} {label}"));
        let name = labels.collect::<Vec<_>>().join(", ");
        let bins = &moments.histogram;
        let mut points = vec![(bins.from, 0.0)];
        for (i, &count) in bins.counts.iter().enumerate() {
            let left = bins.from + i as f64 * bins.width;
            points.extend([(left, count as f64), (left + bins.width, count as f64)]);
        }
        points.push((bins.from + bins.counts.len() as f64 * bins.width, 0.0));
        lines.push(Line { name: if name.is_empty() { quantity.into() } else { name }, points });
    }
    lines
}
