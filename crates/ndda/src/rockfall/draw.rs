//! Numbers that scatter from boulder to boulder: each depends on the seed, the number of the boulder and what it is for, and on nothing else.

use ndda_io::scene::Scatter;
use ndda_io::study::Distribution;
use ndda_mesh::cut::Stream;
use ndda_mesh::{Mat3, Vec3};

use crate::sweep::distribution::quantile;

/// Halvings in which the part of a distribution below a value is found.
const HALVINGS: u32 = 60;

/// Limits at which restitutions are cut off, and friction angles [°].
pub(super) const RESTITUTIONS: (f64, f64) = (0.0, 1.0);
pub(super) const FRICTIONS_DEG: (f64, f64) = (0.0, 89.0);
/// Limits of heights [m] and speeds [m/s] of a release, and of dips [°].
pub(super) const FROM_ZERO: (f64, f64) = (0.0, f64::INFINITY);
pub(super) const DIPS_DEG: (f64, f64) = (-90.0, 90.0);
/// Part of a distribution that is not worth a line where it is cut off.
pub(super) const LITTLE: f64 = 1e-3;

/// What a number is for; numbers of one boulder for different ends are independent.
#[derive(Clone, Copy)]
pub(super) enum Of {
    Place = 1,
    Size,
    Shape,
    Turn,
    Height,
    Speed,
    Azimuth,
    Dip,
    Spin,
    Restitution,
    Friction,
}

/// The random numbers of a boulder.
#[derive(Clone, Copy)]
pub(super) struct Draw {
    seed: u64,
    boulder: u64,
}

impl Draw {
    pub(super) fn new(seed: u64, boulder: u32) -> Self {
        Self { seed, boulder: u64::from(boulder) }
    }

    /// The stream of numbers for an end; `part` tells apart what there are several of.
    pub(super) fn stream(&self, of: Of, part: usize) -> Stream {
        Stream::new(self.seed, &[self.boulder, of as u64, part as u64])
    }

    /// A value of a number that scatters, cut off at its limits.
    pub(super) fn value(&self, of: Of, part: usize, scatter: &Scatter, (least, most): (f64, f64)) -> f64 {
        let Some(distribution) = scatter.as_distribution() else { return scatter.middle() };
        let (low, high) = (below(&distribution, least), below(&distribution, most));
        // In (0, 1), where every quantile is finite.
        let u = self.stream(of, part).uniform() + 2f64.powi(-54);
        // Of a distribution that has next to nothing within the limits, the nearest is taken.
        quantile(&distribution, low + u * (high - low)).clamp(least, most)
    }

    /// A turn, uniform over all of them: a unit quaternion of four normal numbers (Muller 1959).
    pub(super) fn turn(&self) -> Mat3 {
        let mut stream = self.stream(Of::Turn, 0);
        let [w, x, y, z] = [(); 4].map(|()| stream.normal());
        let v = Vec3::new(x, y, z);
        let norm2 = w * w + v.norm_squared();
        let cross = v.cross_matrix();
        Mat3::identity() + 2.0 / norm2 * (w * cross + cross * cross)
    }
}

/// The part of a number that scatters which its limits cut off.
pub(super) fn cut_off(scatter: &Scatter, limits: (f64, f64)) -> f64 {
    scatter.as_distribution().map_or(0.0, |distribution| beyond(&distribution, limits))
}

/// The part of a distribution that is not between two values.
fn beyond(distribution: &Distribution, (least, most): (f64, f64)) -> f64 {
    below(distribution, least) + 1.0 - below(distribution, most)
}

/// The part of a distribution below a value.
fn below(distribution: &Distribution, value: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    if value == f64::INFINITY || quantile(distribution, 1.0) <= value {
        return 1.0;
    }
    if quantile(distribution, 0.0) >= value {
        return 0.0;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if quantile(distribution, middle) < value { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_keep_within_limits_and_have_the_median_of_the_rest() {
        let scatter = Scatter::Normal(1.0, 0.5);
        let mut values: Vec<f64> =
            (0..2000).map(|i| Draw::new(7, i).value(Of::Size, 0, &scatter, (0.5, 1.5))).collect();
        values.sort_by(f64::total_cmp);
        assert!(values[0] >= 0.5 && values[1999] <= 1.5);
        // Symmetric limits leave the median; its standard error is half of the spread of 0.28 over √2000 times 1.25.
        assert!((values[1000] - 1.0).abs() < 0.03, "{}", values[1000]);
        assert_eq!(Draw::new(7, 3).value(Of::Size, 0, &Scatter::Always(2.0), (0.0, 1.0)), 2.0);
    }

    #[test]
    fn what_is_cut_off_is_the_part_of_the_distribution_beyond_the_limits() {
        // A normal number is beyond 1.96 deviations in 5 % of cases.
        let part = beyond(&Distribution::Normal(1.0, 0.5), (1.0 - 0.98, 1.0 + 0.98));
        assert!((part - 0.049_996).abs() < 1e-5, "{part}");
        assert_eq!(beyond(&Distribution::Uniform(1.0, 3.0), (0.0, f64::INFINITY)), 0.0);
        // Millimetres within limits in metres.
        assert!(beyond(&Distribution::LogNormal(1000.0, 300.0), (0.4, 2.5)) > 1.0 - 1e-12);
    }

    #[test]
    fn a_turn_is_one_and_turns_have_no_direction() {
        let mut mean = Mat3::zeros();
        for i in 0..2000 {
            let turn = Draw::new(1, i).turn();
            assert!((turn.transpose() * turn - Mat3::identity()).amax() < 1e-14 && turn.determinant() > 0.0);
            mean += turn / 2000.0;
        }
        // Each entry has a variance of 1/3.
        assert!(mean.amax() < 0.05, "{mean}");
    }
}
