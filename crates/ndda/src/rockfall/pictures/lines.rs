//! Histograms of heights, speeds and energies at lines.

use super::axes::{Axes, from_zero};
use super::{GREY, INK, MEDIAN, PERCENTILE, subtitle};
use crate::picture::svg::{Anchor, Svg};
use crate::rockfall::Model;
use crate::rockfall::fall::Fall;
use crate::rockfall::passage::Moment;
use crate::rockfall::result::Outcome;
use crate::rockfall::spread::Spread;

/// Width of the picture, room at the left, above and between, and size of a histogram [px].
const WIDTH: f64 = 1100.0;
const LEFT: f64 = 56.0;
const TOP: f64 = 112.0;
const GAP: f64 = 62.0;
const SIZE: [f64; 2] = [300.0, 170.0];
const ROW: f64 = 276.0;
/// Most lines that are drawn.
const MOST_LINES: usize = 8;
/// Most bars of a histogram.
const MOST_BARS: f64 = 24.0;

/// Name of a quantity, its unit, and its value.
type Quantity = (&'static str, f64, fn(&Moment) -> f64);

/// Draws a row of histograms for each line that was reached; nothing where none was.
pub(super) fn draw(model: &Model, outcome: &Outcome, falls: &[Fall]) -> Option<String> {
    let reached: Vec<usize> =
        (0..outcome.lines.len()).filter(|&k| outcome.lines[k].reached > 0).take(MOST_LINES).collect();
    if reached.is_empty() {
        return None;
    }
    let whole = TOP + ROW * reached.len() as f64;
    let mut svg = Svg::new([WIDTH as usize, whole as usize]);
    svg.rect([0.0, 0.0], [WIDTH, whole], [255; 3]);
    svg.words([LEFT, 22.0], 17.0, Anchor::Start, INK, WIDTH - 2.0 * LEFT, &outcome.title);
    let words = format!("first passages of lines · {}", subtitle(outcome));
    svg.words([LEFT, 45.0], 13.0, Anchor::Start, GREY, WIDTH - 2.0 * LEFT, &words);
    for (row, &k) in reached.iter().enumerate() {
        let first =
            |fall: &Fall| fall.passages.iter().find(|(line, _)| *line == k).map(|(_, moment)| *moment);
        let moments: Vec<Moment> = falls.iter().filter_map(first).collect();
        let top = TOP + ROW * row as f64;
        let line = &outcome.lines[k];
        let [low, high] = line.confidence_95.map(|part| 100.0 * part);
        let words = format!(
            "{}: reached by {} of {}, {:.1} % (95 % confidence {low:.1} to {high:.1} %)",
            model.rockfall.lines[k].name,
            line.reached,
            outcome.count,
            100.0 * line.probability
        );
        svg.words([LEFT, top - 34.0], 14.0, Anchor::Start, INK, WIDTH - 2.0 * LEFT, &words);
        let columns: [Quantity; 3] = [
            ("height of the centre of mass [m]", 1.0, |m| m.height_m),
            ("speed [m/s]", 1.0, Moment::speed_m_s),
            ("kinetic energy [kJ]", 1e3, Moment::energy_j),
        ];
        for (column, (name, unit, of)) in columns.into_iter().enumerate() {
            let at = [LEFT + (SIZE[0] + GAP) * column as f64, top];
            let values = moments.iter().map(|moment| of(moment) / unit).collect();
            histogram(&mut svg, at, name, values);
        }
    }
    Some(svg.finish())
}

/// A number to three digits.
fn three_digits(value: f64) -> String {
    let digits = 2 - value.abs().max(1e-300).log10().floor() as i32;
    format!("{value:.*}", digits.clamp(0, 6) as usize)
}

/// A histogram with its median and its 95th percentile.
fn histogram(svg: &mut Svg, at: [f64; 2], name: &str, values: Vec<f64>) {
    let x = from_zero(values.iter().copied());
    let bars = (values.len() as f64).sqrt().ceil().clamp(5.0, MOST_BARS) as usize;
    let width = x[1] / bars as f64;
    let mut counts = vec![0u32; bars];
    for value in &values {
        counts[((value / width).max(0.0) as usize).min(bars - 1)] += 1;
    }
    let axes = Axes { at, size: SIZE, x, y: from_zero(counts.iter().map(|&count| f64::from(count))) };
    axes.grid(svg, true);
    for (k, &count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let [left, top] = axes.place([k as f64 * width, f64::from(count)]);
        let [right, bottom] = axes.place([(k + 1) as f64 * width, 0.0]);
        svg.rect([left + 0.6, top], [right - left - 1.2, bottom - top], [126, 160, 184]);
    }
    let Some(spread) = Spread::of(values) else { return };
    for (value, colour, words, left) in
        [(spread.median, MEDIAN, "median", 0.0), (spread.percentile_95, PERCENTILE, "95th percentile", 120.0)]
    {
        let [place, _] = axes.place([value, 0.0]);
        svg.line([place, at[1]], [place, at[1] + SIZE[1]], 2.2, colour);
        let label = format!("{words} {}", three_digits(value));
        svg.words([at[0] + left, at[1] - 10.0], 12.0, Anchor::Start, colour, 190.0, &label);
    }
    axes.frame(svg);
    axes.name_below(svg, name);
}
