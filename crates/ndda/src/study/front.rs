//! The non-dominated front of error against time, and the time that it takes to reach an error.

/// One result: what it cost and how wrong it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Time by the study's clock [s].
    pub time_s: f64,
    /// Relative error.
    pub error: f64,
}

/// Indices of the points that no other beats in both time and error, by time; of equal points the first one.
pub fn front(points: &[Point]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let key = |&i: &usize| (points[i].time_s, points[i].error);
    order.sort_by(|a, b| {
        let ((time_a, error_a), (time_b, error_b)) = (key(a), key(b));
        time_a.total_cmp(&time_b).then(error_a.total_cmp(&error_b))
    });
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i].error < best;
        best = best.min(points[i].error);
        better
    });
    order
}

/// Time [s] at which the front reaches `error`: between two of its points by a straight line in logarithms, never
/// beyond its ends. None where no point is as exact.
pub fn time_to_error(points: &[Point], error: f64) -> Option<f64> {
    let front = front(points);
    let reached = front.iter().position(|&i| points[i].error <= error)?;
    let b = points[front[reached]];
    let Some(before) = reached.checked_sub(1) else { return Some(b.time_s) };
    let a = points[front[before]];
    // An error of exactly zero has no logarithm.
    let ln = |value: f64| value.max(f64::MIN_POSITIVE).ln();
    let part = (ln(a.error) - ln(error)) / (ln(a.error) - ln(b.error));
    Some((ln(a.time_s) + part * (ln(b.time_s) - ln(a.time_s))).exp())
}

/// The errors 10⁻ᵏ between the smallest and the largest of the points, the next larger one than all included.
pub fn targets(errors: impl Iterator<Item = f64>) -> Vec<f64> {
    let exponents = errors.filter(|e| *e > 0.0).map(|e| e.log10().ceil() as i32);
    let (least, most) = exponents.fold((i32::MAX, i32::MIN), |(a, b), k| (a.min(k), b.max(k)));
    (least..=most).rev().map(|k| 10f64.powi(k)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<Point> {
        list.iter().map(|&(time_s, error)| Point { time_s, error }).collect()
    }

    #[test]
    fn beaten_points_are_not_on_the_front() {
        let all = points(&[(4.0, 1e-3), (1.0, 1e-1), (2.0, 1e-1), (2.0, 1e-2), (5.0, 2e-3), (8.0, 1e-4)]);
        assert_eq!(front(&all), [1, 3, 0, 5]);
        assert_eq!(front(&points(&[(1.0, 0.5), (1.0, 0.5)])), [0]);
        assert!(front(&[]).is_empty());
    }

    #[test]
    fn a_method_of_second_order_takes_the_square_root_of_ten_times_longer_per_digit() {
        // Cost 1/Δt, error Δt²: time = error^(−1/2), also between the points and with beaten ones in between.
        let steps = [1e-1, 2e-2, 1e-3, 1e-4];
        let mut all: Vec<Point> = steps.iter().map(|h| Point { time_s: 1.0 / h, error: h * h }).collect();
        all.push(Point { time_s: 500.0, error: 0.5 });
        for error in [1e-2, 1e-3, 1e-5, 3e-7, 1e-8] {
            let time_s = time_to_error(&all, error).unwrap();
            assert!((time_s * f64::sqrt(error) - 1.0).abs() < 1e-12, "{error}: {time_s}");
        }
    }

    #[test]
    fn nothing_is_extrapolated() {
        let all = points(&[(1.0, 1e-2), (10.0, 1e-4)]);
        assert_eq!(time_to_error(&all, 1e-1), Some(1.0));
        assert_eq!(time_to_error(&all, 9e-5), None);
        assert_eq!(time_to_error(&[], 1.0), None);
        let exact = points(&[(1.0, 1e-2), (10.0, 0.0)]);
        let time_s = time_to_error(&exact, 1e-8).unwrap();
        assert!(1.0 < time_s && time_s < 10.0, "{time_s}");
    }

    #[test]
    fn targets_are_the_powers_of_ten_that_somebody_reaches() {
        let exponents = |errors: &[f64]| -> Vec<i32> {
            targets(errors.iter().copied()).iter().map(|t| t.log10().round() as i32).collect()
        };
        assert_eq!(exponents(&[3e-2, 4e-4, 0.0]), [-1, -2, -3]);
        assert_eq!(exponents(&[1e-3]), [-3]);
        assert!(exponents(&[0.0]).is_empty());
    }
}
