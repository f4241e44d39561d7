//! Slip of a rigid block on a shaken base (Newmark 1965), exact for accelerations that are linear between rows.
//!
//! While the block slides, its acceleration relative to the base is f (d − s y), d being the acceleration by which the record drives it, y the yield
//! acceleration and s the direction of the slip: linear in time between rows, so that velocities are parabolas, of which the roots are known.

use serde::Serialize;

use super::GRAVITY;

/// What a block slides on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slide {
    /// Level ground: it slides both ways beyond this acceleration [m/s²].
    Yield(f64),
    /// A slope, down which a positive record drives it.
    Slope {
        /// Dip of the plane on which it slides [°].
        slope_deg: f64,
        /// Angle of friction [°].
        friction_deg: f64,
        /// Whether the record shakes along the slope, instead of horizontally.
        along_slope: bool,
        /// Gravity [m/s²].
        gravity_m_s2: f64,
    },
}

impl Slide {
    /// A slope under standard gravity.
    pub fn slope(slope_deg: f64, friction_deg: f64, along_slope: bool) -> Self {
        Self::Slope { slope_deg, friction_deg, along_slope, gravity_m_s2: GRAVITY }
    }

    /// (f, y) forwards, and backwards, of what is driven by d: horizontal shaking of a slope α with friction φ has f = cos(φ ∓ α)/cos φ and
    /// y = g tan(φ ∓ α); shaking along it f = 1 and y = g sin(φ ∓ α)/cos φ.
    fn sides(&self) -> [(f64, f64); 2] {
        match *self {
            Self::Yield(y) => [(1.0, y); 2],
            Self::Slope { slope_deg, friction_deg, along_slope, gravity_m_s2: g } => {
                [-1.0, 1.0].map(|sign| {
                    let friction = friction_deg.to_radians();
                    let angle = friction + sign * slope_deg.to_radians();
                    if along_slope {
                        (1.0, g * angle.sin() / friction.cos())
                    } else {
                        (angle.cos() / friction.cos(), g * angle.tan())
                    }
                })
            }
        }
    }

    /// Acceleration that drives the block, of that of the record: on level ground it lags behind.
    fn drive(&self) -> f64 {
        if matches!(self, Self::Yield(_)) { -1.0 } else { 1.0 }
    }
}

/// Slip of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Slip {
    /// Slip at the end, relative to the base: down a slope, or along the record [m].
    pub last_m: f64,
    /// Farthest slip, with its sign [m].
    pub farthest_m: f64,
    /// When it is there [s].
    pub farthest_s: f64,
    /// When the block last comes to rest on the base [s]; none where it never slides.
    pub rests_s: Option<f64>,
}

/// A block on its way.
struct Block {
    sides: [(f64, f64); 2],
    velocity: f64,
    slip: f64,
    /// +1 or −1 where it slides, 0 where it does not.
    sign: f64,
    found: Slip,
}

/// Slip under a record of (time [s], acceleration [m/s²]); after the record the base stands, and the block slides to rest.
pub fn slip(rows: &[(f64, f64)], slide: &Slide) -> Slip {
    let drive = slide.drive();
    let mut block =
        Block { sides: slide.sides(), velocity: 0.0, slip: 0.0, sign: 0.0, found: Slip::default() };
    for pair in rows.windows(2) {
        let [(t0, a0), (t1, a1)] = [pair[0], pair[1]];
        block.run(t0, t1 - t0, (drive * a0, drive * a1));
    }
    let end_s = rows.last().map_or(0.0, |row| row.0);
    // It stops after v/(f y); twice that is enough.
    let slowest = block.sides.iter().map(|(f, y)| f * y).fold(f64::INFINITY, f64::min);
    let rest_s = 2.0 * block.velocity.abs() / slowest;
    if rest_s > 0.0 {
        block.run(end_s, rest_s, (0.0, 0.0));
    }
    block.found.last_m = block.slip;
    block.found
}

impl Block {
    /// Relative acceleration under a drive, where it slides.
    fn acceleration(&self, d: f64) -> f64 {
        let (f, y) = self.sides[usize::from(self.sign < 0.0)];
        f * (d - self.sign * y)
    }

    /// A time in which the drive goes linearly from d₀ to d₁.
    fn run(&mut self, start_s: f64, length_s: f64, (d0, d1): (f64, f64)) {
        let rate = (d1 - d0) / length_s;
        let mut done = 0.0;
        // Each part ends a slip or a rest: a linear drive has four at most.
        for _ in 0..8 {
            let left = length_s - done;
            let d = d0 + rate * done;
            if self.sign == 0.0 {
                let Some(wait) = self.begins(d, rate, left) else { return };
                done += wait;
                if done >= length_s {
                    return;
                }
                continue;
            }
            let (b, j) = (self.acceleration(d), self.acceleration(d + rate) - self.acceleration(d));
            let stop = root(self.velocity, b, j, left);
            let tau = stop.unwrap_or(left);
            self.slip += tau * (self.velocity + tau * (0.5 * b + tau * j / 6.0));
            self.velocity += tau * (b + 0.5 * tau * j);
            done += tau;
            if self.slip.abs() > self.found.farthest_m.abs() {
                (self.found.farthest_m, self.found.farthest_s) = (self.slip, start_s + done);
            }
            if stop.is_none() {
                return;
            }
            (self.velocity, self.sign) = (0.0, 0.0);
            self.found.rests_s = Some(start_s + done);
        }
    }

    /// Time until a block at rest begins to slide, and sets its sign; none where it does not in time.
    fn begins(&mut self, d: f64, rate: f64, left: f64) -> Option<f64> {
        let (forwards, backwards) = (self.sides[0].1, -self.sides[1].1);
        // At the very yield it slides if the drive goes on beyond.
        if d > forwards || (d == forwards && rate > 0.0) {
            self.sign = 1.0;
            return Some(0.0);
        }
        if d < backwards || (d == backwards && rate < 0.0) {
            self.sign = -1.0;
            return Some(0.0);
        }
        let (goal, sign) = if rate > 0.0 { (forwards, 1.0) } else { (backwards, -1.0) };
        let wait = if rate == 0.0 { f64::INFINITY } else { (goal - d) / rate };
        (wait < left).then(|| {
            self.sign = sign;
            wait
        })
    }
}

/// The first time in (0, left] at which v + b τ + ½ j τ² comes to zero, a slip of this velocity or one that begins.
fn root(v: f64, b: f64, j: f64, left: f64) -> Option<f64> {
    // ½ j τ² + b τ + v: with q = −(b + sign(b) √(b² − 2 j v)) the roots are q/j and 2 v/q.
    let square = b * b - 2.0 * j * v;
    if square < 0.0 {
        return None;
    }
    let q = -(b + square.sqrt().copysign(b));
    let roots =
        [if j == 0.0 { f64::INFINITY } else { q / j }, if q == 0.0 { f64::INFINITY } else { 2.0 * v / q }];
    let first = roots.into_iter().filter(|r| *r > 0.0).fold(f64::INFINITY, f64::min);
    (first <= left).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    const G: f64 = 9.81;

    /// A constant acceleration from 0 s on, that ends within a millionth of a microsecond.
    fn pulse(a: f64, length_s: f64) -> Vec<(f64, f64)> {
        vec![(0.0, a), (length_s, a), (length_s + 1e-12, 0.0)]
    }

    #[test]
    fn a_pulse_on_level_ground_slides_a_block_as_its_closed_form_says() {
        let found = slip(&pulse(0.3 * G, 0.5), &Slide::Yield(0.1 * G));
        // v = 0.2 g t up to 0.981 m/s, then −0.1 g: ½ · 0.981 · (0.5 + 1.0).
        let exact = 0.5 * 0.2 * G * 0.5 * 1.5;
        assert!((exact - 0.735750f64).abs() < 1e-6 && (found.last_m + exact).abs() < 1e-9, "{found:?}");
        assert!((found.rests_s.unwrap() - 1.5).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_slope_under_a_horizontal_pulse_and_one_along_it() {
        for (along_slope, exact, rests_s) in [(false, 0.204775, Some(0.567128)), (true, 0.146524, None)] {
            let slide = Slide::Slope { slope_deg: 20.0, friction_deg: 30.0, along_slope, gravity_m_s2: G };
            let [(f, y), _] = slide.sides();
            let (a, t) = (0.5 * G, 0.2);
            let closed = 0.5 * f * (a - y) * t * t * a / y;
            let found = slip(&pulse(a, t), &slide);
            assert!((closed - exact).abs() < 1e-6, "{closed}");
            assert!((found.last_m - closed).abs() < 1e-9, "{found:?} {closed}");
            if let Some(rests_s) = rests_s {
                assert!((f - 1.137158).abs() < 1e-6 && (found.rests_s.unwrap() - rests_s).abs() < 1e-6);
            } else {
                assert!((y - 1.967019).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn a_sine_from_rest_slides_a_block_back_to_where_it_was_in_each_period() {
        let a = |t: f64| 0.5 * G * (std::f64::consts::TAU * 2.0 * t).sin();
        let rows: Vec<_> = (0..=20_000).map(|i| 1e-4 * f64::from(i)).map(|t| (t, a(t))).collect();
        let first: Vec<_> = rows.iter().copied().take_while(|row| row.0 <= 0.4).collect();
        let found = slip(&first, &Slide::Yield(0.3 * G));
        assert!((found.farthest_m + 0.0244878).abs() < 1e-6, "{found:?}");
        let whole = slip(&rows, &Slide::Yield(0.3 * G));
        assert!(whole.last_m.abs() < 0.0245 && whole.farthest_m.abs() < 0.02449, "{whole:?}");
        // From 0.530388 s on it rests where it began.
        let once: Vec<_> = rows.iter().copied().take_while(|row| row.0 <= 0.54).collect();
        let once = slip(&once, &Slide::Yield(0.3 * G));
        assert!(once.last_m.abs() < 1e-6, "{once:?}");
        assert!((once.rests_s.unwrap() - 0.530388).abs() < 1e-5, "{once:?}");
    }

    #[test]
    fn many_rows_of_a_line_slide_a_block_as_far_as_one() {
        let few = [(0.0, 0.0), (1.0, 4.0), (2.0, -4.0), (3.0, 0.0)];
        let many: Vec<_> = (0..=3000)
            .map(|i| f64::from(i) / 1000.0)
            .map(|t| {
                (
                    t,
                    if t < 1.0 {
                        4.0 * t
                    } else if t < 2.0 {
                        4.0 - 8.0 * (t - 1.0)
                    } else {
                        4.0 * (t - 3.0)
                    },
                )
            })
            .collect();
        let (one, other) = (slip(&few, &Slide::Yield(1.0)), slip(&many, &Slide::Yield(1.0)));
        assert!((one.last_m - other.last_m).abs() < 1e-9, "{one:?} {other:?}");
    }
}
