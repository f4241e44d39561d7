//! Response spectra: peaks of damped oscillators on a shaken base, exact for accelerations that are linear between rows (Nigam & Jennings 1969).

use std::f64::consts::TAU;

use serde::Serialize;

/// Parts of a period at which the oscillator is looked at: its peak is missed by 1 − cos(π/64), a thousandth, at most.
const LOOKS: f64 = 64.0;
/// Shortest and longest period [s], and how many.
const PERIODS_S: (f64, f64) = (0.02, 10.0);
const COUNT: u32 = 121;

/// Peak response at a period.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Response {
    /// Period without damping [s].
    pub period_s: f64,
    /// Peak of the displacement relative to the base, S_d [m].
    pub displacement_m: f64,
    /// Pseudo-velocity ω S_d [m/s].
    pub pseudo_velocity_m_s: f64,
    /// Pseudo-acceleration ω² S_d [m/s²].
    pub pseudo_acceleration_m_s2: f64,
}

/// Periods of a spectrum, evenly spaced by their ratio [s].
pub(super) fn periods_s() -> Vec<f64> {
    let (from_s, to_s) = PERIODS_S;
    (0..COUNT).map(|k| from_s * (to_s / from_s).powf(f64::from(k) / f64::from(COUNT - 1))).collect()
}

/// Responses to rows of time [s] and acceleration [m/s²], for a part ζ < 1 of critical damping.
pub fn spectrum(rows: &[(f64, f64)], periods_s: &[f64], damping: f64) -> Vec<Response> {
    periods_s.iter().map(|period_s| response(rows, *period_s, damping)).collect()
}

/// Response of one oscillator, which swings on for a period after the record.
pub fn response(rows: &[(f64, f64)], period_s: f64, damping: f64) -> Response {
    let omega = TAU / period_s;
    let mut oscillator = Oscillator { omega, damping, x: 0.0, v: 0.0, peak: 0.0, known: (0.0, [0.0; 3]) };
    for pair in rows.windows(2) {
        let [(t0, a0), (t1, a1)] = [pair[0], pair[1]];
        oscillator.run(t1 - t0, a0, a1);
    }
    oscillator.run(period_s, 0.0, 0.0);
    let displacement_m = oscillator.peak;
    Response {
        period_s,
        displacement_m,
        pseudo_velocity_m_s: omega * displacement_m,
        pseudo_acceleration_m_s2: omega * omega * displacement_m,
    }
}

/// x″ + 2 ζ ω x′ + ω² x = −a.
struct Oscillator {
    omega: f64,
    damping: f64,
    x: f64,
    v: f64,
    peak: f64,
    /// Time for which e^(−ζωτ), cos and sin were last computed.
    known: (f64, [f64; 3]),
}

impl Oscillator {
    /// Advances by a time in which a goes linearly from a₀ to a₁, in parts that show the peak.
    fn run(&mut self, time_s: f64, a0: f64, a1: f64) {
        let parts = (time_s * self.omega / TAU * LOOKS).ceil().max(1.0);
        let (h, rise) = (time_s / parts, (a1 - a0) / parts);
        for k in 0..parts as u64 {
            self.step(h, a0 + k as f64 * rise, rise / h);
        }
    }

    /// x = A + B τ + e^(−ζωτ) (C₁ cos ω_d τ + C₂ sin ω_d τ).
    fn step(&mut self, h: f64, a0: f64, rate: f64) {
        let Self { omega, damping, .. } = *self;
        let damped = omega * (1.0 - damping * damping).sqrt();
        if self.known.0 != h {
            let (sin, cos) = (damped * h).sin_cos();
            self.known = (h, [(-damping * omega * h).exp(), cos, sin]);
        }
        let [e, cos, sin] = self.known.1;
        let slope = -rate / (omega * omega);
        let level = (-a0 - 2.0 * damping * omega * slope) / (omega * omega);
        let c1 = self.x - level;
        let c2 = (self.v - slope + damping * omega * c1) / damped;
        let swing = e * (c1 * cos + c2 * sin);
        self.x = level + slope * h + swing;
        self.v = slope - damping * omega * swing + e * damped * (c2 * cos - c1 * sin);
        self.peak = self.peak.max(self.x.abs());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A base that begins to accelerate at once: x = −(a/ω²)(1 − e^(−ζωt)(cos ω_d t + ζω/ω_d sin ω_d t)), peak (a/ω²)(1 + e^(−πζ/√(1 − ζ²))).
    #[test]
    fn a_sudden_acceleration_has_the_peak_of_its_closed_form() {
        for damping in [0.0, 0.05, 0.5] {
            let found = response(&[(0.0, 3.0), (10.0, 3.0)], 0.7, damping);
            let over = (-std::f64::consts::PI * damping / (1.0 - damping * damping).sqrt()).exp();
            let exact = 3.0 * (1.0 + over);
            assert!(
                (found.pseudo_acceleration_m_s2 / exact - 1.0).abs() < 1.3e-3,
                "{damping}: {found:?} {exact}"
            );
        }
    }

    /// A ramp at rest: x″ + ω² x = −j t gives x = −(j/ω²)(t − sin ωt/ω), whatever the rows.
    #[test]
    fn a_ramp_is_followed_exactly_whatever_the_rows() {
        let rows: Vec<_> = [0.0, 0.1, 0.35, 1.0].map(|t| (t, 2.0 * t)).to_vec();
        let mut oscillator =
            Oscillator { omega: 9.0, damping: 0.0, x: 0.0, v: 0.0, peak: 0.0, known: (0.0, [0.0; 3]) };
        for pair in rows.windows(2) {
            oscillator.run(pair[1].0 - pair[0].0, pair[0].1, pair[1].1);
        }
        let exact = -2.0 / 81.0 * (1.0 - 9f64.sin() / 9.0);
        assert!((oscillator.x - exact).abs() < 1e-13, "{} {exact}", oscillator.x);
    }

    /// Resonance: a steady sine at the oscillator's own frequency is enlarged 1/2ζ times.
    #[test]
    fn a_long_sine_is_enlarged_by_the_inverse_of_twice_the_damping() {
        let rows: Vec<_> = (0..40_000).map(|i| 0.002 * f64::from(i)).map(|t| (t, (TAU * t).sin())).collect();
        let found = response(&rows, 1.0, 0.05);
        assert!((found.pseudo_acceleration_m_s2 / 10.0 - 1.0).abs() < 3e-3, "{found:?}");
    }
}
