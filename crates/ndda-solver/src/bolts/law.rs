//! One elastic, perfectly plastic spring: steel, grout and plates are made of these.

/// A spring that is elastic between two forces and yields at them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Law {
    /// Force per elongation [N/m].
    pub stiffness_n_m: f64,
    /// Least force, zero or negative [N].
    pub least_n: f64,
    /// Largest force [N].
    pub most_n: f64,
    /// Whether it opens at the least force instead of yielding: a plate that loses its face finds it again where it was.
    pub opens: bool,
}

impl Law {
    /// Yields at the same force both ways.
    pub(crate) fn symmetric(stiffness_n_m: f64, limit_n: f64) -> Self {
        Self { stiffness_n_m, least_n: -limit_n, most_n: limit_n, opens: false }
    }

    /// A constant force: that of a jack [N].
    pub(crate) fn constant(stiffness_n_m: f64, force_n: f64) -> Self {
        Self { stiffness_n_m, least_n: force_n, most_n: force_n, opens: false }
    }

    /// Force at an elongation beyond that which is remembered [N].
    pub(crate) fn force_n(&self, elongation_m: f64) -> f64 {
        (self.stiffness_n_m * elongation_m).clamp(self.least_n, self.most_n)
    }

    /// Whether it is within its limits.
    pub(crate) fn is_elastic(&self, elongation_m: f64) -> bool {
        let trial_n = self.stiffness_n_m * elongation_m;
        trial_n > self.least_n && trial_n < self.most_n
    }

    /// Energy stored, and work that yielding from zero to there takes [J]: ½ f²/k + f (x − f/k).
    pub(crate) fn potential_j(&self, elongation_m: f64) -> f64 {
        let force_n = self.force_n(elongation_m);
        force_n * (elongation_m - 0.5 * force_n / self.stiffness_n_m)
    }

    /// By how much it has yielded [m], and the work that this took, never negative [J].
    pub(crate) fn yielding(&self, elongation_m: f64) -> (f64, f64) {
        let force_n = self.force_n(elongation_m);
        let yielded_m = elongation_m - force_n / self.stiffness_n_m;
        if self.is_elastic(elongation_m) || self.opens && yielded_m < 0.0 {
            return (0.0, 0.0);
        }
        (yielded_m, (force_n * yielded_m).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_is_the_slope_of_the_potential() {
        for law in [
            Law::symmetric(3.0, 2.0),
            Law { stiffness_n_m: 5.0, least_n: 0.0, most_n: 1.0, opens: true },
            Law::constant(4.0, 1.5),
        ] {
            for k in -40..40 {
                let x = 0.05 * f64::from(k) + 0.013;
                let slope = (law.potential_j(x + 1e-6) - law.potential_j(x - 1e-6)) / 2e-6;
                assert!((slope - law.force_n(x)).abs() < 1e-8, "{law:?} at {x}");
            }
        }
    }

    #[test]
    fn yielding_leaves_the_force_and_takes_the_rest() {
        let law = Law::symmetric(10.0, 2.0);
        let (yielded_m, work_j) = law.yielding(0.5);
        assert!((yielded_m - 0.3).abs() < 1e-15 && (work_j - 0.6).abs() < 1e-15);
        assert!((law.force_n(0.5 - yielded_m) - 2.0).abs() < 1e-15);
        let (yielded_m, work_j) = law.yielding(-0.5);
        assert!((yielded_m + 0.3).abs() < 1e-15 && (work_j - 0.6).abs() < 1e-15);
    }

    #[test]
    fn a_plate_that_has_lost_its_face_remembers_nothing() {
        let plate = Law { stiffness_n_m: 10.0, least_n: 0.0, most_n: 2.0, opens: true };
        assert_eq!(plate.yielding(-1.0), (0.0, 0.0));
        assert_eq!(plate.force_n(-1.0), 0.0);
    }
}
