//! Statistics of samples: moments, the probability of failure with its confidence interval, and Sobol' indices.

use serde::Serialize;

/// Two-sided 95 % of the standard normal distribution.
const Z95: f64 = 1.959_963_984_540_054;
/// Bins of a histogram, at most.
const MOST_BINS: usize = 40;

/// Moments and quantiles of a quantity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Moments {
    /// Samples that have a value.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation, with n − 1; 0 of one value.
    pub deviation: f64,
    /// Least value.
    pub least: f64,
    /// Values below which lie 5, 50 and 95 % of the samples.
    pub quantiles: [f64; 3],
    /// Largest value.
    pub largest: f64,
    /// The samples by their value.
    pub histogram: Histogram,
}

/// Samples by their value, in bins of one width.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Histogram {
    /// Lower end of the first bin.
    pub from: f64,
    /// Width of a bin; 0 where all values are the same.
    pub width: f64,
    /// Samples in each.
    pub counts: Vec<usize>,
}

impl Moments {
    /// Of values that are finite; none of no value.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (&least, &largest) = (sorted.first()?, sorted.last()?);
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let deviation = if values.len() > 1 { (squares / (n - 1.0)).sqrt() } else { 0.0 };
        let quantiles = [0.05, 0.5, 0.95].map(|part| quantile(&sorted, part));
        let histogram = histogram(&sorted, least, largest);
        Some(Self { count: values.len(), mean, deviation, least, quantiles, largest, histogram })
    }
}

/// The value that a part of values in rising order, of which there is one at least, does not exceed; linear between them.
pub(crate) fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * (sorted.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// As many bins as the root of the number of samples.
fn histogram(values: &[f64], least: f64, largest: f64) -> Histogram {
    let bins = ((values.len() as f64).sqrt().ceil() as usize).clamp(1, MOST_BINS);
    let width = (largest - least) / bins as f64;
    let mut counts = vec![0; if width > 0.0 { bins } else { 1 }];
    for value in values {
        let bin = if width > 0.0 { ((value - least) / width) as usize } else { 0 };
        let last = counts.len() - 1;
        counts[bin.min(last)] += 1;
    }
    Histogram { from: least, width: width.max(0.0), counts }
}

/// A part of the samples, with the 95 % interval of Wilson, "Probable inference, the law of succession, and statistical
/// inference", J. Am. Stat. Assoc. 22 (1927) 209–212.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Samples that are in it.
    pub count: usize,
    /// All samples that were judged.
    pub of: usize,
    /// The one over the other.
    pub probability: f64,
    /// Lower and upper end of the interval.
    pub interval95: [f64; 2],
}

impl Part {
    /// `count` of `of` samples; the whole interval of none.
    pub fn new(count: usize, of: usize) -> Self {
        if of == 0 {
            return Self { count, of, probability: 0.0, interval95: [0.0, 1.0] };
        }
        let (n, p) = (of as f64, count as f64 / of as f64);
        let square = Z95 * Z95;
        let centre = (p + square / (2.0 * n)) / (1.0 + square / n);
        let half = Z95 / (1.0 + square / n) * (p * (1.0 - p) / n + square / (4.0 * n * n)).sqrt();
        Self { count, of, probability: p, interval95: [(centre - half).max(0.0), (centre + half).min(1.0)] }
    }
}

/// Part of the variance of a quantity that is due to one parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Index {
    /// Quantity.
    pub quantity: String,
    /// Parameter.
    pub parameter: String,
    /// Due to it alone, Sᵢ: Saltelli et al., "Variance based sensitivity analysis of model output", Comput. Phys. Commun. 181
    /// (2010) 259–270, table 2 (b).
    pub first_order: f64,
    /// Due to it and its interactions, S_Ti: Jansen, "Analysis of variance designs for model output", Comput. Phys. Commun. 117
    /// (1999) 35–43.
    pub total: f64,
    /// Half of the 95 % intervals of both, from the spread of the terms of their sums.
    pub half_widths95: [f64; 2],
}

/// First-order and total index of a parameter, with half their 95 % intervals: from the values of a quantity at points A, at points
/// B, and at points A with this parameter from B. All zero where the quantity does not vary.
pub fn indices(a: &[f64], b: &[f64], mixed: &[f64]) -> ([f64; 2], [f64; 2]) {
    let n = a.len() as f64;
    let all = || a.iter().chain(b);
    let mean = all().sum::<f64>() / (2.0 * n);
    let variance = all().map(|v| (v - mean).powi(2)).sum::<f64>() / (2.0 * n);
    if variance.is_nan() || variance <= 0.0 {
        return ([0.0; 2], [0.0; 2]);
    }
    // About the mean, which changes no expectation and makes the terms smaller.
    let first: Vec<f64> = (0..a.len()).map(|j| (b[j] - mean) * (mixed[j] - a[j]) / variance).collect();
    let total: Vec<f64> = (0..a.len()).map(|j| 0.5 * (a[j] - mixed[j]).powi(2) / variance).collect();
    let sums = [&first, &total].map(|terms| {
        let mean = terms.iter().sum::<f64>() / n;
        let spread = terms.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
        (mean, Z95 * (spread / n).sqrt())
    });
    (sums.map(|sum| sum.0), sums.map(|sum| sum.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::points::points;
    use ndda_io::study::Sampling;
    use std::f64::consts::PI;

    #[test]
    fn moments_and_histogram_are_those_of_the_values() {
        let values: Vec<f64> = (0..=100).map(f64::from).collect();
        let moments = Moments::of(&values).unwrap();
        assert_eq!((moments.mean, moments.quantiles), (50.0, [5.0, 50.0, 95.0]));
        assert!((moments.deviation.powi(2) - 101.0 * 102.0 / 12.0).abs() < 1e-9);
        assert_eq!(moments.histogram.counts.iter().sum::<usize>(), 101);
        assert_eq!(Moments::of(&[]), None);
        assert_eq!(Moments::of(&[3.0]).unwrap().histogram.counts, [1]);
    }

    #[test]
    fn the_interval_is_wilsons() {
        // Newcombe, "Two-sided confidence intervals for the single proportion", Statist. Med. 17 (1998), table I, method 3.
        for (count, of, lower, upper) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let found = Part::new(count, of).interval95;
            assert!((found[0] - lower).abs() < 5e-5 && (found[1] - upper).abs() < 5e-5, "{count}: {found:?}");
        }
    }

    #[test]
    fn ishigamis_function_has_the_indices_of_its_closed_form() {
        let (a, b) = (7.0, 0.1);
        let f = |x: &[f64]| x[0].sin() + a * x[1].sin().powi(2) + b * x[2].powi(4) * x[0].sin();
        let scaled = |u: &[f64]| u.iter().map(|u| PI * (2.0 * u - 1.0)).collect::<Vec<f64>>();
        let all = points(Sampling::Sobol, 1 << 13, 6, 1);
        let value = |point: &[f64]| f(&scaled(point));
        let at_a: Vec<f64> = all.iter().map(|p| value(&p[..3])).collect();
        let at_b: Vec<f64> = all.iter().map(|p| value(&p[3..])).collect();
        // Ishigami & Homma (1990).
        let (v1, v2) = (0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2), a * a / 8.0);
        let v13 = b * b * PI.powi(8) * 8.0 / 225.0;
        let v = v1 + v2 + v13;
        let expected = [[v1 / v, (v1 + v13) / v], [v2 / v, v2 / v], [0.0, v13 / v]];
        for (i, expected) in expected.iter().enumerate() {
            let mixed: Vec<f64> = all
                .iter()
                .map(|p| {
                    let mut point = p[..3].to_vec();
                    point[i] = p[3 + i];
                    value(&point)
                })
                .collect();
            let (found, half) = indices(&at_a, &at_b, &mixed);
            for k in 0..2 {
                let error = (found[k] - expected[k]).abs();
                assert!(
                    error < 0.01 && error < half[k] + 1e-12,
                    "{i}, {k}: {found:?} ± {half:?}, {expected:?}"
                );
            }
        }
    }
}
