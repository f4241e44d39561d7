//! Values of distributions from uniform numbers.

use ndda_io::study::Distribution;

use super::normal;

/// The value below which lies the part `p` of a distribution.
pub fn quantile(distribution: &Distribution, p: f64) -> f64 {
    match *distribution {
        Distribution::Normal(mean, deviation) => mean + deviation * normal::quantile(p),
        Distribution::LogNormal(mean, deviation) => {
            // Mean and deviation of the logarithm: σ² = ln(1 + (s/m)²), μ = ln m − σ²/2.
            let variance = (deviation / mean).powi(2).ln_1p();
            (mean.ln() - 0.5 * variance + variance.sqrt() * normal::quantile(p)).exp()
        }
        Distribution::Uniform(least, largest) => least + (largest - least) * p,
        Distribution::Triangular(least, likeliest, largest) => {
            let width = largest - least;
            let rising = (likeliest - least) / width;
            match p < rising {
                true => least + (p * width * (likeliest - least)).sqrt(),
                false => largest - ((1.0 - p) * width * (largest - likeliest)).sqrt(),
            }
        }
        Distribution::Fisher(concentration) => {
            // P(θ) = (1 − e^(−κ(1 − cos θ)))/(1 − e^(−2κ)), solved for 1 − cos θ, so that small angles keep their digits.
            let versine = -(p * (-2.0 * concentration).exp_m1()).ln_1p() / concentration;
            // 1 − cos θ is at most 2 but for rounding.
            2.0 * (0.5 * versine).min(1.0).sqrt().asin().to_degrees()
        }
    }
}

/// Lower factor L of a correlation matrix, L Lᵀ = R (Cholesky); none if the matrix is not positive definite.
pub fn factor(correlation: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = correlation.len();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = correlation[i][j] - known;
            if i == j {
                if rest <= 1e-12 {
                    return None;
                }
                lower[i][i] = rest.sqrt();
            } else {
                lower[i][j] = rest / lower[j][j];
            }
        }
    }
    Some(lower)
}

/// Uniform numbers with the dependence of correlated normal ones (a Gaussian copula): z = Φ⁻¹(u), u′ = Φ(L z).
pub fn correlated(uniform: &[f64], lower: &[Vec<f64>]) -> Vec<f64> {
    let z: Vec<f64> = uniform.iter().map(|&u| normal::quantile(u)).collect();
    let row = |row: &Vec<f64>| row.iter().zip(&z).map(|(l, z)| l * z).sum::<f64>();
    lower.iter().map(|l| normal::below(row(l))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and standard deviation by the midpoint rule over probability.
    fn moments(distribution: Distribution) -> (f64, f64) {
        let n = 200_000;
        let values: Vec<f64> =
            (0..n).map(|i| quantile(&distribution, (f64::from(i) + 0.5) / f64::from(n))).collect();
        let mean = values.iter().sum::<f64>() / f64::from(n);
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / f64::from(n);
        (mean, variance.sqrt())
    }

    #[test]
    fn distributions_have_the_moments_of_their_closed_forms() {
        let (a, b, c) = (2.0, 3.0, 7.0);
        let triangular = ((a * a + b * b + c * c - a * b - a * c - b * c) / 18.0f64).sqrt();
        for (distribution, mean, deviation) in [
            (Distribution::Normal(30.0, 2.0), 30.0, 2.0),
            (Distribution::LogNormal(20e3, 5e3), 20e3, 5e3),
            (Distribution::Uniform(2.0, 8.0), 5.0, 6.0 / 12f64.sqrt()),
            (Distribution::Triangular(a, b, c), (a + b + c) / 3.0, triangular),
        ] {
            let found = moments(distribution);
            assert!((found.0 / mean - 1.0).abs() < 1e-5, "{distribution:?}: {found:?}");
            assert!((found.1 / deviation - 1.0).abs() < 1e-4, "{distribution:?}: {found:?}");
        }
    }

    #[test]
    fn quantiles_are_those_of_closed_forms() {
        assert_eq!(quantile(&Distribution::Uniform(2.0, 8.0), 0.25), 3.5);
        // Of a symmetric triangle an eighth lies below the quarter of its width.
        assert_eq!(quantile(&Distribution::Triangular(0.0, 2.0, 4.0), 0.125), 1.0);
        assert_eq!(quantile(&Distribution::Triangular(0.0, 2.0, 4.0), 0.875), 3.0);
        // The median of a log-normal distribution is m/√(1 + (s/m)²).
        let median = quantile(&Distribution::LogNormal(3.0, 4.0), 0.5);
        assert!((median - 3.0 / (1.0 + 16.0 / 9.0f64).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn directions_scatter_as_fisher_says() {
        for concentration in [1e-3, 0.5, 5.0, 300.0, 1e7] {
            // The mean of cos θ is coth κ − 1/κ; 1 less that is compared, which is small where directions are close together.
            let n = 200_000;
            let versine = |i: u32| {
                let p = (f64::from(i) + 0.5) / f64::from(n);
                2.0 * (0.5 * quantile(&Distribution::Fisher(concentration), p).to_radians()).sin().powi(2)
            };
            let found = (0..n).map(versine).sum::<f64>() / f64::from(n);
            let exact = 1.0 / concentration - 2.0 / (2.0 * concentration).exp_m1();
            assert!((found / exact - 1.0).abs() < 1e-5, "κ {concentration}: {found}, {exact}");
        }
        // Half of the directions of a large concentration lie within √(2 ln 2/κ).
        let median = quantile(&Distribution::Fisher(1e8), 0.5).to_radians();
        assert!((median / (2.0 * 2f64.ln() / 1e8).sqrt() - 1.0).abs() < 1e-8, "{median}");
        assert_eq!(quantile(&Distribution::Fisher(1e3), 1.0), 180.0);
    }

    #[test]
    fn correlated_numbers_have_the_correlation_that_is_asked_for() {
        let correlation = vec![vec![1.0, -0.6], vec![-0.6, 1.0]];
        let lower = factor(&correlation).unwrap();
        assert_eq!(lower, [[1.0, 0.0], [-0.6, 0.8]]);
        let n = 300;
        let (mut product, mut count) = (0.0, 0.0);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let u = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(n));
            let z: Vec<f64> = correlated(&u, &lower).into_iter().map(normal::quantile).collect();
            product += z[0] * z[1];
            count += 1.0;
        }
        assert!((product / count + 0.6).abs() < 0.01, "{}", product / count);
        assert_eq!(factor(&[vec![1.0, 1.0], vec![1.0, 1.0]]), None);
    }
}
