//! What is done with a record: even spacing, filter, baseline.

use std::f64::consts::{PI, SQRT_2};

use super::MOST_ROWS;
use crate::scene::Baseline;

/// Rows at an even spacing, linear between the given ones, of which there are two at least; the last is at or before the end.
pub fn resampled(rows: &[(f64, f64)], spacing_s: f64) -> Vec<(f64, f64)> {
    let (start_s, end_s) = (rows[0].0, rows[rows.len() - 1].0);
    // A last row that rounding puts a little late counts.
    let count = ((end_s - start_s) / spacing_s * (1.0 + 1e-12)).floor() as usize;
    let mut next = 0;
    let at = |i: usize| {
        let time_s = start_s + i as f64 * spacing_s;
        while next + 2 < rows.len() && rows[next + 1].0 <= time_s {
            next += 1;
        }
        let [(t0, a0), (t1, a1)] = [rows[next], rows[next + 1]];
        (time_s, a0 + (a1 - a0) * ((time_s - t0) / (t1 - t0)).min(1.0))
    };
    (0..=count).map(at).collect()
}

/// A second-order section b/a of a filter.
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl Section {
    /// A Butterworth filter of second order by the bilinear transform, exact at its corner.
    fn butterworth(corner_hz: f64, spacing_s: f64, passes_high: bool) -> Self {
        let k = (PI * corner_hz * spacing_s).tan();
        let scale = 1.0 / (1.0 + SQRT_2 * k + k * k);
        let b = if passes_high { [1.0, -2.0, 1.0] } else { [k * k, 2.0 * k * k, k * k] };
        Self { b: b.map(|b| b * scale), a: [2.0 * (k * k - 1.0) * scale, (1.0 - SQRT_2 * k + k * k) * scale] }
    }

    /// Filters values in place, from rest.
    fn run<'a>(&self, values: impl Iterator<Item = &'a mut f64>) {
        let (mut first, mut second) = (0.0, 0.0);
        for value in values {
            let (x, y) = (*value, self.b[0] * *value + first);
            first = self.b[1] * x - self.a[0] * y + second;
            second = self.b[2] * x - self.a[1] * y;
            *value = y;
        }
    }
}

/// Periods of the low corner that are quiet before and after a record that is filtered (Boore 2005: 1.5 n, where n = 2).
const QUIET_PERIODS: f64 = 3.0;

/// Filters rows at an even spacing between two corner frequencies, forwards and backwards, with quiet before and after them, so that what the filter spreads
/// beyond the ends comes back.
///
/// # Errors
/// The slower corner and the lowest one that is possible [Hz], where the quiet would take more than [`MOST_ROWS`].
pub(super) fn filtered(rows: &mut [(f64, f64)], (low_hz, high_hz): (f64, f64)) -> Result<(), (f64, f64)> {
    let spacing_s = rows[1].0 - rows[0].0;
    let slowest_hz = if low_hz > 0.0 { low_hz } else { high_hz };
    let least_hz = QUIET_PERIODS / (MOST_ROWS as f64 * spacing_s);
    if slowest_hz < least_hz {
        return Err((slowest_hz, least_hz));
    }
    let quiet = (QUIET_PERIODS / (slowest_hz * spacing_s)).ceil() as usize;
    let mut values = vec![0.0; rows.len() + 2 * quiet];
    values.iter_mut().skip(quiet).zip(&*rows).for_each(|(value, row)| *value = row.1);
    let mut sections = Vec::new();
    if low_hz > 0.0 {
        sections.push(Section::butterworth(low_hz, spacing_s, true));
    }
    if high_hz < 0.5 / spacing_s {
        sections.push(Section::butterworth(high_hz, spacing_s, false));
    }
    for section in sections {
        section.run(values.iter_mut());
        section.run(values.iter_mut().rev());
    }
    rows.iter_mut().zip(&values[quiet..]).for_each(|(row, value)| row.1 = *value);
    Ok(())
}

/// Takes the baseline of the velocity out; acceleration is linear between rows. Returns c₁ [m/s²] and c₂ [m/s³].
pub(super) fn corrected(rows: &mut [(f64, f64)], baseline: Baseline) -> (f64, f64) {
    let start_s = rows[0].0;
    let length_s = rows[rows.len() - 1].0 - start_s;
    // ∫ v τ dτ and ∫ v τ² dτ for τ = t/T, by Gauss's rule with three points, which is exact for these quartics.
    let points = [(0.5 - 0.15f64.sqrt(), 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.5 + 0.15f64.sqrt(), 5.0 / 18.0)];
    let (mut velocity, mut first, mut second) = (0.0, 0.0, 0.0);
    for pair in rows.windows(2) {
        let [(t0, a0), (t1, a1)] = [pair[0], pair[1]];
        let h = t1 - t0;
        for (at, weight) in points {
            let v = velocity + h * at * (a0 + 0.5 * at * (a1 - a0));
            let tau = (t0 + at * h - start_s) / length_s;
            first += weight * h / length_s * v * tau;
            second += weight * h / length_s * v * tau * tau;
        }
        velocity += 0.5 * h * (a0 + a1);
    }
    let (c1, c2) = match baseline {
        Baseline::None => (0.0, 0.0),
        Baseline::Linear => (3.0 * first, 0.0),
        // [1/3 1/4; 1/4 1/5] c = (first, second).
        Baseline::Quadratic => (48.0 * first - 60.0 * second, 80.0 * second - 60.0 * first),
    };
    let (c1, c2) = (c1 / length_s, c2 / (length_s * length_s));
    rows.iter_mut().for_each(|(t, a)| *a -= c1 + 2.0 * c2 * (*t - start_s));
    (c1, c2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_spacing_keeps_what_is_linear_between_rows() {
        let rows = [(1.0, 0.0), (1.5, 1.0), (2.0, -1.0), (3.0, 1.0)];
        let even = resampled(&rows, 0.25);
        assert_eq!(even.len(), 9);
        for (row, exact) in even.iter().zip([0.0, 0.5, 1.0, 0.0, -1.0, -0.5, 0.0, 0.5, 1.0]) {
            assert!((row.1 - exact).abs() < 1e-14, "{row:?}");
        }
    }

    /// |H|² = 1/(1 + (f/f_c)⁴) of a Butterworth filter of second order, twice; in tan(π f Δt) by the bilinear transform.
    #[test]
    fn a_sine_keeps_its_phase_and_the_amplitude_of_the_filters_run_twice() {
        let spacing_s = 0.005;
        let tan = |f: f64| (PI * f * spacing_s).tan();
        for f in [0.5, 1.0, 4.0, 10.0, 20.0] {
            let sine = |i: usize| (2.0 * PI * f * i as f64 * spacing_s).sin();
            let mut rows: Vec<_> = (0..20_001).map(|i| (i as f64 * spacing_s, sine(i))).collect();
            filtered(&mut rows, (1.0, 10.0)).unwrap();
            let kept = 1.0 / (1.0 + (tan(1.0) / tan(f)).powi(4)) / (1.0 + (tan(f) / tan(10.0)).powi(4));
            for (i, row) in rows.iter().enumerate().skip(9_000).take(2_000) {
                assert!((row.1 - kept * sine(i)).abs() < 1e-6, "{f} Hz: {} {}", row.1, kept * sine(i));
            }
        }
    }

    #[test]
    fn a_corner_too_low_to_be_held_is_refused_with_the_lowest_one() {
        let mut rows: Vec<_> = (0..100).map(|i| (f64::from(i) * 0.01, 1.0)).collect();
        for corners in [(1e-9, 25.0), (1e-300, 25.0), (0.0, 1e-12)] {
            let (slowest_hz, least_hz) = filtered(&mut rows, corners).unwrap_err();
            assert_eq!(slowest_hz, if corners.0 > 0.0 { corners.0 } else { corners.1 });
            assert!((least_hz / 3e-5 - 1.0).abs() < 1e-9, "{least_hz}");
        }
    }

    #[test]
    fn an_offset_and_a_slope_of_accelerations_are_taken_out_to_the_last_digits() {
        let clean = |t: f64| (3.0 * t).sin() * (-t).exp();
        let rows = |offset: f64, slope: f64| -> Vec<(f64, f64)> {
            (0..=500).map(|i| f64::from(i) * 0.02).map(|t| (t + 2.0, clean(t) + offset + slope * t)).collect()
        };
        for (baseline, slope) in [(Baseline::Linear, 0.0), (Baseline::Quadratic, 0.07)] {
            let (mut plain, mut shifted) = (rows(0.0, 0.0), rows(0.3, slope));
            let (before, after) = (corrected(&mut plain, baseline), corrected(&mut shifted, baseline));
            assert!(
                (after.0 - before.0 - 0.3).abs() < 1e-12 && (after.1 - before.1 - 0.5 * slope).abs() < 1e-12
            );
            for (one, other) in plain.iter().zip(&shifted) {
                assert!((one.1 - other.1).abs() < 1e-12);
            }
        }
    }
}
