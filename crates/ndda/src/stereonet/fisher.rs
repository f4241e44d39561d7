//! Mean and concentration of poles.

use ndda_mesh::Vec3;
use serde::Serialize;

use super::orientation::Orientation;

/// Rounds of turning poles to the side of their mean; each set needs one or two.
const ROUNDS: usize = 20;

/// Statistics of the poles of one set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fisher {
    /// Planes N.
    pub planes: usize,
    /// The plane whose pole is the mean.
    pub mean: Orientation,
    /// Length R of the sum of the unit poles.
    pub resultant: f64,
    /// Concentration K; none for one plane, or for planes that are all parallel.
    pub k: Option<f64>,
    /// Angle about the mean in which the true mean lies with 95 % certainty [°].
    pub confidence_95_deg: Option<f64>,
    /// Angle about the mean that holds 68 % of the poles of such a set [°].
    pub spread_68_deg: Option<f64>,
}

/// Statistics of planes after Fisher (Dispersion on a sphere, Proc. R. Soc. A 217, 1953): the mean is the direction of the sum of
/// the poles, K = (N − 1) / (N − R), the cone of confidence cos α = 1 − (N − R)/R (p^(−1/(N−1)) − 1) with p = 0.05, and the cone
/// that holds a part q of the poles cos θ = 1 + ln(1 − q) / K. Poles are axes without a sign: each is taken on the side of the mean.
/// None for no planes.
pub fn fisher(planes: &[Orientation]) -> Option<Fisher> {
    let mut poles: Vec<Vec3> = planes.iter().map(Orientation::normal).collect();
    let mut sum = most_axial(&poles)?;
    for _ in 0..ROUNDS {
        let turned = poles.iter_mut().filter(|pole| pole.dot(&sum) < 0.0);
        let count = turned.map(|pole| *pole = -*pole).count();
        sum = poles.iter().sum();
        if count == 0 {
            break;
        }
    }
    let (count, resultant) = (poles.len() as f64, sum.norm());
    let apart = count - resultant;
    let scatters = poles.len() > 1 && apart > 1e-12 * count;
    let cone = |cos: f64| cos.clamp(-1.0, 1.0).acos().to_degrees();
    let k = scatters.then(|| (count - 1.0) / apart);
    Some(Fisher {
        planes: poles.len(),
        // One plane is its own mean, without rounding.
        mean: match planes {
            [only] => {
                let dip_direction_deg = only.dip_direction_deg.rem_euclid(360.0);
                Orientation { dip_direction_deg, ..*only }
            }
            _ => Orientation::of_normal(&sum),
        },
        resultant,
        k,
        confidence_95_deg: scatters
            .then(|| cone(1.0 - apart / resultant * (0.05f64.powf(-1.0 / (count - 1.0)) - 1.0))),
        spread_68_deg: k.map(|k| cone(1.0 + (1.0 - 0.68f64).ln() / k)),
    })
}

/// The pole that the squares of the cosines to all others are largest of: a mean to begin with that does not depend on signs.
fn most_axial(poles: &[Vec3]) -> Option<Vec3> {
    let mut tensor = [[0.0; 3]; 3];
    for pole in poles {
        for (i, row) in tensor.iter_mut().enumerate() {
            row.iter_mut().enumerate().for_each(|(j, entry)| *entry += pole[i] * pole[j]);
        }
    }
    let product = |v: &Vec3| -> f64 {
        let entry = |i: usize, j: usize| v[i] * tensor[i][j] * v[j];
        (0..9).map(|k| entry(k / 3, k % 3)).sum()
    };
    poles.iter().max_by(|a, b| product(a).total_cmp(&product(b))).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(dip_deg: f64, dip_direction_deg: f64) -> Orientation {
        Orientation { dip_deg, dip_direction_deg }
    }

    #[test]
    fn planes_that_dip_to_all_sides_alike_have_a_horizontal_mean() {
        let planes: Vec<_> = (0..8).map(|i| plane(20.0, 45.0 * f64::from(i))).collect();
        let found = fisher(&planes).unwrap();
        // Each pole is at 20° from the vertical: R = 8 cos 20°.
        let cos = 20f64.to_radians().cos();
        assert!(found.mean.dip_deg < 1e-9 && (found.resultant - 8.0 * cos).abs() < 1e-12);
        assert!((found.k.unwrap() - 7.0 / (8.0 * (1.0 - cos))).abs() < 1e-9);
    }

    #[test]
    fn steep_planes_that_dip_to_both_sides_are_one_set() {
        let planes = [plane(85.0, 90.0), plane(85.0, 270.0), plane(88.0, 90.0), plane(88.0, 270.0)];
        let found = fisher(&planes).unwrap();
        assert!((found.mean.dip_deg - 90.0).abs() < 1e-9, "{found:?}");
        assert!((found.mean.dip_direction_deg.rem_euclid(180.0) - 90.0).abs() < 1e-9);
        let [a, b] = [5f64, 2.0].map(|angle| angle.to_radians().cos());
        assert!((found.resultant - 2.0 * (a + b)).abs() < 1e-12);
    }

    #[test]
    fn a_sample_of_known_concentration_gives_it_back() {
        // Quantiles of Fisher's distribution: cos θ = 1 + ln(1 − u) / K, on a spiral about the vertical.
        let (count, k) = (4000, 60.0);
        let planes: Vec<_> = (0..count)
            .map(|i| {
                let u = (f64::from(i) + 0.5) / f64::from(count);
                let dip_deg = f64::acos(1.0 + f64::ln(1.0 - u) / k).to_degrees();
                plane(dip_deg, (137.508 * f64::from(i)).rem_euclid(360.0))
            })
            .collect();
        let found = fisher(&planes).unwrap();
        assert!((found.k.unwrap() / k - 1.0).abs() < 2e-3, "{found:?}");
        assert!(found.mean.dip_deg < 0.05);
        let within = planes.iter().filter(|p| p.dip_deg < found.spread_68_deg.unwrap()).count();
        assert!(within.abs_diff(2720) < 10, "{within}");
    }

    #[test]
    fn one_plane_or_parallel_ones_have_no_concentration() {
        assert_eq!(fisher(&[]), None);
        for count in [1, 5] {
            let found = fisher(&vec![plane(33.0, 210.0); count]).unwrap();
            assert!(
                (found.mean.dip_deg - 33.0).abs() < 1e-9
                    && (found.mean.dip_direction_deg - 210.0).abs() < 1e-9
            );
            assert_eq!((found.k, found.confidence_95_deg, found.planes), (None, None, count));
        }
    }
}
