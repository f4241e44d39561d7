//! Peaks, intensity and duration of a record.

use serde::Serialize;

use super::GRAVITY;

/// A record with its velocity and displacement, exact for accelerations that are linear between rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Time [s].
    pub time_s: Vec<f64>,
    /// Acceleration [m/s²].
    pub acceleration: Vec<f64>,
    /// Velocity [m/s].
    pub velocity: Vec<f64>,
    /// Displacement [m].
    pub displacement: Vec<f64>,
}

impl Motion {
    /// From rest.
    pub fn new(rows: &[(f64, f64)]) -> Self {
        let (mut velocity, mut displacement) = (vec![0.0], vec![0.0]);
        let (mut v, mut u) = (0.0, 0.0);
        for pair in rows.windows(2) {
            let [(t0, a0), (t1, a1)] = [pair[0], pair[1]];
            let h = t1 - t0;
            u += h * (v + h * (2.0 * a0 + a1) / 6.0);
            v += 0.5 * h * (a0 + a1);
            velocity.push(v);
            displacement.push(u);
        }
        let (time_s, acceleration) = rows.iter().copied().unzip();
        Self { time_s, acceleration, velocity, displacement }
    }
}

/// A value and when it comes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peak {
    /// The value without sign.
    pub value: f64,
    /// Its time [s].
    pub time_s: f64,
}

/// Measures of a record.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// Peak of the acceleration [m/s²].
    pub peak_acceleration_m_s2: Peak,
    /// Peak of the velocity [m/s].
    pub peak_velocity_m_s: Peak,
    /// Peak of the displacement [m].
    pub peak_displacement_m: Peak,
    /// Velocity at the end, which a corrected record should not have [m/s].
    pub last_velocity_m_s: f64,
    /// Arias intensity, π/2g ∫ a² dt [m/s].
    pub arias_m_s: f64,
    /// Time in which it goes from 5 % to 95 % of itself [s].
    pub duration_s: f64,
}

/// Measures a motion.
pub fn measures(motion: &Motion) -> Measures {
    let peak = |values: &[f64]| {
        let larger = |best: Peak, (value, time_s): (&f64, &f64)| {
            if value.abs() > best.value { Peak { value: value.abs(), time_s: *time_s } } else { best }
        };
        values.iter().zip(&motion.time_s).fold(Peak::default(), larger)
    };
    // ∫ a² dt, exact for a linear a.
    let mut squares = vec![0.0];
    for (t, a) in motion.time_s.windows(2).zip(motion.acceleration.windows(2)) {
        let part = (t[1] - t[0]) / 3.0 * (a[0] * a[0] + a[0] * a[1] + a[1] * a[1]);
        squares.push(squares[squares.len() - 1] + part);
    }
    let total = squares[squares.len() - 1];
    let when = |part: f64| {
        let after = squares.partition_point(|sum| *sum < part * total).clamp(1, squares.len() - 1);
        let step = squares[after] - squares[after - 1];
        let share = if step > 0.0 { (part * total - squares[after - 1]) / step } else { 0.0 };
        motion.time_s[after - 1] + share * (motion.time_s[after] - motion.time_s[after - 1])
    };
    Measures {
        peak_acceleration_m_s2: peak(&motion.acceleration),
        peak_velocity_m_s: peak(&motion.velocity),
        peak_displacement_m: peak(&motion.displacement),
        last_velocity_m_s: motion.velocity[motion.velocity.len() - 1],
        arias_m_s: std::f64::consts::FRAC_PI_2 / GRAVITY * total,
        duration_s: when(0.95) - when(0.05),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pulse_of_constant_acceleration_has_the_measures_of_its_closed_form() {
        let rows: Vec<_> = (0..=100).map(|i| (0.01 * f64::from(i), 2.0)).collect();
        let found = measures(&Motion::new(&rows));
        assert!((found.peak_velocity_m_s.value - 2.0).abs() < 1e-12);
        assert!((found.peak_displacement_m.value - 1.0).abs() < 1e-12);
        assert!((found.arias_m_s - std::f64::consts::PI * 2.0 / GRAVITY).abs() < 1e-12);
        assert!((found.duration_s - 0.9).abs() < 1e-12);
    }
}
