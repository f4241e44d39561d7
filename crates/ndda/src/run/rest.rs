//! How far a scene is on its way to rest, and how long it may still take.

use std::fmt;
use std::time::{Duration, Instant};

use ndda_solver::Settled;

use crate::numbers::counted;

/// How often it is said how far a scene is on its way to rest.
const SAY: Duration = Duration::from_secs(2);

/// Samples of the speed that is left, of which the later half gives the trend.
const MOST_SAMPLES: usize = 64;
/// Fewest samples for a trend.
const FEWEST_SAMPLES: usize = 16;
/// Part of the variance of the logarithm that a trend has to explain.
const EXPLAINED: f64 = 0.5;

/// How far a scene is on its way to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Resting<'a> {
    /// The stage of construction; none before the first step.
    pub stage: Option<&'a str>,
    /// Steps and the speed that is left.
    pub settled: Settled,
    /// Speed over the largest at which it is at rest.
    pub tolerance: f64,
    /// Time that it still takes at the present trend [s]; none where there is no trend.
    pub left_s: Option<f64>,
}

impl fmt::Display for Resting<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let Some(stage) = self.stage {
            write!(f, "stage `{stage}` ")?;
        }
        let (Settled { steps, speed_ratio: left, inertia_factors, overloaded_bonds }, until) =
            (self.settled, self.tolerance);
        match left {
            _ if left <= until => {
                write!(f, "settled in {steps} steps")?;
                if overloaded_bonds > 0 {
                    let points = counted(overloaded_bonds, "point", "points");
                    write!(
                        f,
                        ", at {points} joints carried more at rest than friction, and what they have of cohesion and tensile strength, can bear, and were let go"
                    )?;
                }
                return match inertia_factors {
                    Some([least, most]) => {
                        write!(f, ", inertia of blocks scaled by factors of {least:.1e} to {most:.1e}")
                    }
                    None => Ok(()),
                };
            }
            _ if left.is_finite() => {
                write!(f, "settling: {steps} steps, speed {left:.1e} of the largest, until {until:e}")?;
            }
            _ => write!(f, "settling: {steps} steps, speeds still rise")?,
        }
        match self.left_s {
            Some(left_s) => write!(f, ", about {} left", in_words(left_s)),
            None => Ok(()),
        }
    }
}

/// A time of one or two digits.
fn in_words(time_s: f64) -> String {
    match time_s {
        _ if time_s < 99.5 => format!("{} s", time_s.ceil()),
        _ if time_s < 5940.0 => format!("{:.0} min", time_s / 60.0),
        _ => format!("{:.1} h", time_s / 3600.0),
    }
}

/// Watches a scene on its way to rest, and says now and then how far it is.
pub(super) struct Watch<'a> {
    stage: Option<&'a str>,
    tolerance: f64,
    trend: Trend,
    /// Steps that were behind it when it was first seen, and when that was.
    first: Option<(u64, Instant)>,
    said: Instant,
}

impl<'a> Watch<'a> {
    /// A watch on a stage, or on a scene before its first step.
    pub(super) fn new(stage: Option<&'a str>, tolerance: f64) -> Self {
        Self { stage, tolerance, trend: Trend::default(), first: None, said: Instant::now() }
    }

    /// Takes a step; says how far the scene is when that is due, and when it is at rest.
    pub(super) fn step(&mut self, settled: &Settled, tell: &mut dyn FnMut(&Resting)) {
        let (first, began) = *self.first.get_or_insert_with(|| (settled.steps - 1, Instant::now()));
        self.trend.push(settled);
        if settled.speed_ratio > self.tolerance && self.said.elapsed() < SAY {
            return;
        }
        self.said = Instant::now();
        let a_step_s = began.elapsed().as_secs_f64() / (settled.steps - first) as f64;
        let left_s = self.trend.steps_to(settled.speed_ratio, self.tolerance).map(|steps| steps * a_step_s);
        let (stage, tolerance) = (self.stage, self.tolerance);
        tell(&Resting { stage, settled: *settled, tolerance, left_s });
    }
}

/// The speed that is left over steps: its largest values in parts of equal length.
#[derive(Default)]
struct Trend {
    /// Step at the end of each part, and the logarithm of the largest speed in it.
    samples: Vec<(f64, f64)>,
    /// Steps of a part; 0 stands for 1.
    stride: u64,
}

impl Trend {
    fn push(&mut self, settled: &Settled) {
        let value = settled.speed_ratio.ln();
        if !value.is_finite() {
            return;
        }
        let stride = self.stride.max(1);
        match self.samples.last_mut().filter(|_| !settled.steps.is_multiple_of(stride)) {
            Some((_, largest)) => *largest = largest.max(value),
            None => self.samples.push((settled.steps as f64, value)),
        }
        if self.samples.len() > MOST_SAMPLES {
            let joined = |pair: &[(f64, f64)]| {
                let largest = pair.iter().map(|sample| sample.1).fold(f64::NEG_INFINITY, f64::max);
                (pair[0].0, largest)
            };
            self.samples = self.samples.chunks(2).map(joined).collect();
            self.stride = 2 * stride;
        }
    }

    /// Steps until the speed has fallen from one value to another, as it fell in the later half so far; none where it does not fall steadily.
    fn steps_to(&self, from: f64, to: f64) -> Option<f64> {
        if self.samples.len() < FEWEST_SAMPLES || !from.is_finite() {
            return None;
        }
        let late = &self.samples[self.samples.len() / 2..];
        let count = late.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| late.iter().map(of).sum::<f64>() / count;
        let (x0, y0) = (mean(|sample| sample.0), mean(|sample| sample.1));
        let sum = |of: &dyn Fn(f64, f64) -> f64| late.iter().map(|(x, y)| of(x - x0, y - y0)).sum::<f64>();
        let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
        let is_steady = xy < 0.0 && xy * xy >= EXPLAINED * xx * yy;
        is_steady.then(|| (from / to).ln().max(0.0) * xx / -xy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trend(steps: u64, speed: impl Fn(f64) -> f64) -> Trend {
        let mut trend = Trend::default();
        for step in 1..=steps {
            trend.push(&Settled { steps: step, speed_ratio: speed(step as f64), ..Settled::default() });
        }
        trend
    }

    #[test]
    fn a_speed_that_falls_by_a_tenth_in_so_many_steps_takes_as_many_for_each_tenth() {
        for steps in [40, 1000, 12_345] {
            let trend = trend(steps, |k| 10f64.powf(-k / 500.0));
            let left = trend.steps_to(1e-2, 1e-4).unwrap();
            assert!((left / 1000.0 - 1.0).abs() < 0.02, "{steps}: {left}");
        }
        // With waves on it, and after a part in which it rose.
        let trend =
            trend(6000, |k| (k / 1000.0).min(1.0) * 10f64.powf(-k / 2000.0) * (1.1 + (k / 7.0).sin()));
        let left = trend.steps_to(1e-2, 1e-3).unwrap();
        assert!((left / 2000.0 - 1.0).abs() < 0.1, "{left}");
    }

    #[test]
    fn a_speed_that_does_not_fall_gives_no_estimate() {
        assert_eq!(trend(10, |k| 1.0 / k).steps_to(0.1, 1e-4), None);
        assert_eq!(trend(3000, |_| 1e-3).steps_to(1e-3, 1e-4), None);
        assert_eq!(trend(3000, |k| 1e-3 * k).steps_to(3.0, 1e-4), None);
        assert_eq!(trend(3000, |_| f64::INFINITY).steps_to(f64::INFINITY, 1e-4), None);
    }

    #[test]
    fn words_say_the_stage_the_steps_and_what_is_left() {
        let resting = |speed_ratio: f64, left_s: Option<f64>| {
            let settled = Settled { steps: 1200, speed_ratio, ..Settled::default() };
            Resting { stage: Some("bench 1"), settled, tolerance: 1e-4, left_s }.to_string()
        };
        assert_eq!(
            resting(3.14e-3, Some(151.0)),
            "stage `bench 1` settling: 1200 steps, speed 3.1e-3 of the largest, until 1e-4, about 3 min left"
        );
        assert_eq!(resting(f64::INFINITY, None), "stage `bench 1` settling: 1200 steps, speeds still rise");
        assert_eq!(resting(1e-4, Some(0.0)), "stage `bench 1` settled in 1200 steps");
        assert_eq!([0.2, 42.0, 300.0, 7200.0].map(in_words), ["1 s", "42 s", "5 min", "2.0 h"]);
    }
}
