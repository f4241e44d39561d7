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

    /// The motion between two rows.
    fn pieces(&self) -> impl Iterator<Item = Piece> {
        (1..self.time_s.len()).map(|k| Piece {
            start_s: self.time_s[k - 1],
            length_s: self.time_s[k] - self.time_s[k - 1],
            acceleration: [self.acceleration[k - 1], self.acceleration[k]],
            velocity: self.velocity[k - 1],
            displacement: self.displacement[k - 1],
        })
    }

    /// Peak of a value whose extremes between rows are where another one is zero.
    fn peak(&self, extremes: impl Fn(&Piece) -> [f64; 2], value: impl Fn(&Piece, f64) -> f64) -> Peak {
        let mut best = Peak::default();
        for piece in self.pieces() {
            for t in extremes(&piece).into_iter().chain([0.0, piece.length_s]) {
                let found = if (0.0..=piece.length_s).contains(&t) { value(&piece, t).abs() } else { 0.0 };
                if found > best.value {
                    best = Peak { value: found, time_s: piece.start_s + t };
                }
            }
        }
        best
    }
}

/// Motion between two rows, with an acceleration that is linear in time; times are from its start [s].
struct Piece {
    start_s: f64,
    length_s: f64,
    /// At its start and at its end [m/s²].
    acceleration: [f64; 2],
    /// At its start [m/s], [m].
    velocity: f64,
    displacement: f64,
}

impl Piece {
    /// Change of the acceleration per time [m/s³].
    fn jerk(&self) -> f64 {
        (self.acceleration[1] - self.acceleration[0]) / self.length_s
    }

    /// v + a t + j t²/2.
    fn velocity(&self, t: f64) -> f64 {
        self.velocity + t * (self.acceleration[0] + 0.5 * t * self.jerk())
    }

    /// u + v t + a t²/2 + j t³/6.
    fn displacement(&self, t: f64) -> f64 {
        self.displacement + t * (self.velocity + t * (0.5 * self.acceleration[0] + t * self.jerk() / 6.0))
    }

    /// Times that may lie outside of it, or be none.
    fn where_acceleration_is_zero(&self) -> [f64; 2] {
        [-self.acceleration[0] / self.jerk(), f64::NAN]
    }

    fn where_velocity_is_zero(&self) -> [f64; 2] {
        let (a, half_jerk) = (self.acceleration[0], 0.5 * self.jerk());
        // The larger root of both without cancellation, and the other from their product.
        let q = -0.5 * (a + (a * a - 4.0 * half_jerk * self.velocity).sqrt().copysign(a));
        [q / half_jerk, self.velocity / q]
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
        peak_velocity_m_s: motion.peak(|piece| piece.where_acceleration_is_zero(), Piece::velocity),
        peak_displacement_m: motion.peak(|piece| piece.where_velocity_is_zero(), Piece::displacement),
        last_velocity_m_s: motion.velocity[motion.velocity.len() - 1],
        arias_m_s: std::f64::consts::FRAC_PI_2 / GRAVITY * total,
        duration_s: when(0.95) - when(0.05),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_of_velocity_and_displacement_lie_between_rows() {
        let found = measures(&Motion::new(&[(0.0, 0.0), (0.1, 3.0), (0.2, -3.0), (0.3, 0.0)]));
        // v = 0.15 + ½ · 0.05 · 3 where a is zero.
        assert!((found.peak_velocity_m_s.value - 0.225).abs() < 1e-15);
        assert!((found.peak_velocity_m_s.time_s - 0.15).abs() < 1e-15);
        // a = 6 − 12 t: v = 6 t (1 − t) is zero again at 1, and u = 3 t² − 2 t³ is 1 there; then it comes back.
        let found = measures(&Motion::new(&[(0.0, 6.0), (1.5, -12.0)]));
        assert!((found.peak_displacement_m.value - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.peak_displacement_m.time_s - 1.0).abs() < 1e-12, "{found:?}");
    }

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
