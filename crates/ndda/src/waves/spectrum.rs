//! Where the energy of a motion lies over frequency.

use std::f64::consts::TAU;

use ndda_fem::{Motion, Table};

/// Part of the energy of a wave that lies below the frequency at which it is judged.
const ENERGY: f64 = 0.95;
/// Part of the energy of a motion that rounding leaves of it where it is a straight line.
const ROUNDING: f64 = 1e-24;
/// Most samples of a motion.
const MOST_SAMPLES: usize = 1 << 20;

/// Frequency below which 95 % of the energy of a motion lies, by the square of its velocity less a straight line between its ends [Hz]; none where
/// nothing moves.
pub(super) fn of_motion(motion: &Motion) -> Option<f64> {
    highest_hz(motion.extent()?, |time_s| motion.velocity(time_s).into())
}

/// The same of a pressure: the velocity of the wave that it sends off is in proportion to it.
pub(super) fn of_pressure(factor: &Table) -> Option<f64> {
    let (first, last) = (factor.rows.first()?, factor.rows.last()?);
    highest_hz((first.0, last.0, factor.rows.len()), |time_s| [factor.at(time_s)])
}

/// Frequency below which 95 % of the squares of some components lie, less straight lines between their ends, over an extent of two times and a number of rows.
fn highest_hz<const N: usize>(
    (start_s, end_s, rows): (f64, f64, usize),
    at: impl Fn(f64) -> [f64; N],
) -> Option<f64> {
    let samples = (2 * rows).max(256).next_power_of_two().min(MOST_SAMPLES);
    let spacing_s = (end_s - start_s) / samples as f64;
    let values: Vec<[f64; N]> = (0..samples).map(|i| at(start_s + (i as f64 + 0.5) * spacing_s)).collect();
    let (mut power, mut squares) = (vec![0.0; samples], 0.0);
    for axis in 0..N {
        let (first, last) = (values[0][axis], values[samples - 1][axis]);
        squares += values.iter().map(|value| value[axis].powi(2)).sum::<f64>();
        let line = |i: usize| first + (last - first) * (i as f64 / (samples - 1) as f64);
        let mut real: Vec<f64> = values.iter().enumerate().map(|(i, value)| value[axis] - line(i)).collect();
        // As many zeros behind it keep its end from its start.
        real.resize(2 * samples, 0.0);
        let mut imaginary = vec![0.0; 2 * samples];
        transform(&mut real, &mut imaginary);
        power.iter_mut().enumerate().for_each(|(k, power)| *power += real[k].powi(2) + imaginary[k].powi(2));
    }
    let total: f64 = power.iter().sum();
    let mut below = 0.0;
    let place = power.iter().position(|power| {
        below += power;
        below >= ENERGY * total
    })?;
    // What rounding leaves of a straight line is no wave; by Parseval, powers are 2 × samples times squares, half of them here.
    let rounding = ROUNDING * samples as f64 * squares;
    (total > rounding && total.is_finite()).then(|| place.max(1) as f64 / (2.0 * (end_s - start_s)))
}

/// The discrete Fourier transform of a power of two of values, in place (Cooley & Tukey 1965).
fn transform(real: &mut [f64], imaginary: &mut [f64]) {
    let n = real.len();
    let bits = n.trailing_zeros();
    for i in 0..n {
        let j = i.reverse_bits() >> (usize::BITS - bits);
        if i < j {
            real.swap(i, j);
            imaginary.swap(i, j);
        }
    }
    let mut half = 1;
    while half < n {
        for k in 0..half {
            let (sin, cos) = (-TAU * k as f64 / (2 * half) as f64).sin_cos();
            for i in (k..n).step_by(2 * half) {
                let j = i + half;
                let (re, im) = (cos * real[j] - sin * imaginary[j], cos * imaginary[j] + sin * real[j]);
                (real[j], imaginary[j]) = (real[i] - re, imaginary[i] - im);
                (real[i], imaginary[i]) = (real[i] + re, imaginary[i] + im);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_fem::Record;
    use ndda_mesh::Vec3;

    #[test]
    fn a_long_burst_has_its_energy_at_its_frequency_and_a_gaussian_where_its_integral_says() {
        let rows =
            |a: &dyn Fn(f64) -> f64| (0..=4000).map(|i| f64::from(i) * 1e-3).map(|t| (t, a(t))).collect();
        let of = |rows: Vec<(f64, f64)>| of_motion(&Motion::Record(Record::new(Vec3::x(), &rows))).unwrap();
        let burst = of(rows(&|t| (TAU * 10.0 * t).cos()));
        assert!((burst / 10.0 - 1.0).abs() < 0.05, "{burst}");
        // v = exp(−½ (t/σ)²), |V|² = exp(−(ω σ)²): 95 % below ω σ = 1.3859, where erf is 0.95.
        let sigma_s = 0.05;
        let gaussian = of(rows(&|t| {
            let u = (t - 2.0) / sigma_s;
            -u / sigma_s * (-0.5 * u * u).exp()
        }));
        let exact = 1.3859 / (TAU * sigma_s);
        assert!((gaussian / exact - 1.0).abs() < 0.05, "{gaussian} {exact}");
        assert_eq!(of_motion(&Motion::Record(Record::new(Vec3::x(), &[(0.0, 0.0), (1.0, 0.0)]))), None);
    }

    #[test]
    fn a_triangular_pulse_has_its_energy_where_its_integral_says() {
        // A triangle of half-width T has |P|² = sinc⁴(f T): 95 % of the integral over f is below f T = 0.5004.
        let half_s = 1e-3;
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { (0.5 * TAU * x).sin() / (0.5 * TAU * x) };
        let part =
            |to: f64| (0..20_000).map(|i| sinc((i as f64 + 0.5) * to / 2e4).powi(4)).sum::<f64>() * to / 2e4;
        let exact = 0.5004 / half_s;
        assert!((part(0.5004) / part(50.0) - 0.95).abs() < 1e-3, "{}", part(0.5004) / part(50.0));
        let rows =
            vec![(0.0, 0.0), (5e-3, 0.0), (5e-3 + half_s, 1.0), (5e-3 + 2.0 * half_s, 0.0), (2e-2, 0.0)];
        let found = of_pressure(&Table { rows }).unwrap();
        assert!((found / exact - 1.0).abs() < 0.05, "{found} {exact}");
        // What only rises sends no wave that comes back.
        assert_eq!(of_pressure(&Table { rows: vec![(0.0, 0.0), (1.0, 2.0)] }).filter(|hz| *hz > 1.0), None);
    }
}
