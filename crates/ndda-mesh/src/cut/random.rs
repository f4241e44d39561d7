//! Seeded numbers: the same seed gives the same blocks, whatever the order in which they are requested.

use std::f64::consts::TAU;

use crate::Vec3;

/// A stream of numbers: SplitMix64 (Steele, Lea & Flood 2014). A stream is named by its keys.
#[derive(Clone, Debug)]
pub struct Stream(u64);

impl Stream {
    /// The stream of a seed and of what it is for.
    pub fn new(seed: u64, keys: &[u64]) -> Self {
        Self(keys.iter().fold(mix(seed), |state, &key| mix(state ^ mix(key.wrapping_add(GOLDEN)))))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mix(self.0)
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2f64.powi(-53)
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Standard normal: Box & Muller (1958).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (TAU * self.uniform()).cos()
    }

    /// Exponential with mean 1.
    pub fn exponential(&mut self) -> f64 {
        -(1.0 - self.uniform()).ln()
    }

    /// A unit vector about `mean` after Fisher (1953): p(θ) ∝ exp(κ cos θ) sin θ.
    pub fn fisher(&mut self, mean: &Vec3, kappa: f64) -> Vec3 {
        // 1 − cos θ, by inversion; the second term in the logarithm vanishes for large κ.
        let u = self.uniform();
        let versine = -((1.0 - u) + u * (-2.0 * kappa).exp()).ln() / kappa;
        self.tilted(mean, 1.0 - versine.min(2.0))
    }

    /// `mean` turned by the angle of that cosine, in a uniformly drawn direction.
    pub fn tilted(&mut self, mean: &Vec3, cosine: f64) -> Vec3 {
        let [u, v] = frame(mean);
        let (sin, cos) = (TAU * self.uniform()).sin_cos();
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        mean * cosine + (u * cos + v * sin) * sine
    }
}

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A key made of an older one and one more fact.
pub(crate) fn key(parent: u64, fact: u64) -> u64 {
    mix(parent ^ mix(fact.wrapping_add(GOLDEN)))
}

/// Two unit vectors that make a right-handed frame with the unit vector `normal`: u × v = normal.
pub(crate) fn frame(normal: &Vec3) -> [Vec3; 2] {
    let least = normal.iamin();
    let u = normal.cross(&Vec3::ith(least, 1.0)).normalize();
    [u, normal.cross(&u)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_keys_give_the_same_numbers_and_others_do_not() {
        let first = |seed, keys: &[u64]| Stream::new(seed, keys).uniform();
        assert_eq!(first(1, &[2, 3]), first(1, &[2, 3]));
        assert_ne!(first(1, &[2, 3]), first(1, &[3, 2]));
        assert_ne!(first(1, &[2, 3]), first(2, &[2, 3]));
    }

    #[test]
    fn means_and_deviations_are_those_of_their_laws() {
        let mut stream = Stream::new(7, &[]);
        let n = 200_000;
        let mean = |draw: &mut dyn FnMut() -> f64| (0..n).map(|_| draw()).sum::<f64>() / f64::from(n);
        assert!((mean(&mut || stream.uniform()) - 0.5).abs() < 3e-3);
        assert!(mean(&mut || stream.normal()).abs() < 1e-2);
        assert!((mean(&mut || stream.normal().powi(2)) - 1.0).abs() < 2e-2);
        assert!((mean(&mut || stream.exponential()) - 1.0).abs() < 1e-2);
    }

    #[test]
    fn fisher_has_the_mean_resultant_of_its_kappa() {
        for kappa in [0.5, 5.0, 200.0] {
            let mut stream = Stream::new(3, &[]);
            let mean = Vec3::new(0.6, 0.0, 0.8);
            let n = 100_000;
            let sum: f64 = (0..n).map(|_| stream.fisher(&mean, kappa).dot(&mean)).sum();
            let expected = 1.0 / kappa.tanh() - 1.0 / kappa; // Langevin function
            assert!((sum / f64::from(n) - expected).abs() < 5e-3, "{kappa}");
        }
    }
}
