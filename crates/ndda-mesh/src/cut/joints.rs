//! Discontinuities that cut rock: joint sets, single planes and discs.

use super::CutError;
use super::discs::{DiscRule, DiscShape};
use super::plane::{Plane, check_dip, dip_normal};
use super::random::{Stream, frame};
use crate::Vec3;
use crate::geometry::Aabb;

/// Most planes of one set.
const MOST_PLANES: usize = 1_000_000;
/// Normal spacings below this fraction of the mean are drawn again.
const LEAST_SPACING: f64 = 0.1;

/// How the planes of a set scatter about their mean orientation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OrientationScatter {
    /// All planes are parallel.
    #[default]
    None,
    /// The pole tilts by a normally distributed angle about each of two axes in the mean plane.
    Normal {
        /// Standard deviation about each axis [°].
        deviation_deg: f64,
    },
    /// Fisher (1953): p(θ) ∝ exp(κ cos θ) sin θ for the angle θ between pole and mean pole.
    Fisher {
        /// Concentration κ; 100 scatters by about 8°.
        kappa: f64,
    },
    /// Poles are uniform over the cap within an angle of the mean pole.
    Uniform {
        /// Half-angle of the cap [°].
        within_deg: f64,
    },
}

/// How the gaps between successive planes scatter about the spacing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SpacingScatter {
    /// All gaps are equal.
    #[default]
    None,
    /// Gaps are uniform within ± this of the spacing.
    Uniform {
        /// Half-width, less than the spacing [m].
        half_width_m: f64,
    },
    /// Gaps are normal; those below a tenth of the spacing are drawn again.
    Normal {
        /// Standard deviation [m].
        deviation_m: f64,
    },
    /// Gaps are exponential, as those of planes that do not know of each other (Priest & Hudson 1976).
    Exponential,
}

/// Planes of one orientation, one spacing apart.
#[derive(Clone, Debug, PartialEq)]
pub struct JointSet {
    /// Name that faces, node sets and contact properties go by.
    pub name: String,
    /// Dip below horizontal [°], 0 to 90.
    pub dip_deg: f64,
    /// Dip direction clockwise from north (y) [°].
    pub dip_direction_deg: f64,
    /// Mean distance between planes along their normal [m].
    pub spacing_m: f64,
    /// A point of one of the planes [m].
    pub origin_m: Vec3,
    /// Probability that a plane cuts a block that it crosses, drawn for each block and plane; 1 cuts all.
    pub persistence: f64,
    /// Scatter of the orientation. A tilted plane turns about the point below the centre of the domain.
    pub orientation: OrientationScatter,
    /// Scatter of the spacing.
    pub spacing: SpacingScatter,
}

impl JointSet {
    /// A set of parallel, equally spaced, fully persistent planes through the origin.
    pub fn new(name: impl Into<String>, dip_deg: f64, dip_direction_deg: f64, spacing_m: f64) -> Self {
        Self {
            name: name.into(),
            dip_deg,
            dip_direction_deg,
            spacing_m,
            origin_m: Vec3::zeros(),
            persistence: 1.0,
            orientation: OrientationScatter::None,
            spacing: SpacingScatter::None,
        }
    }
}

/// A circular discontinuity.
#[derive(Clone, Debug, PartialEq)]
pub struct Disc {
    /// Name that faces, node sets and contact properties go by.
    pub name: String,
    /// Dip below horizontal [°], 0 to 90.
    pub dip_deg: f64,
    /// Dip direction clockwise from north (y) [°].
    pub dip_direction_deg: f64,
    /// Centre [m].
    pub center_m: Vec3,
    /// Radius [m].
    pub radius_m: f64,
    /// Which blocks it cuts.
    pub rule: DiscRule,
}

/// Something that cuts rock. The order of a list of them is the order of cutting: later ones meet smaller blocks.
#[derive(Clone, Debug, PartialEq)]
pub enum Discontinuity {
    /// A set of planes.
    Set(JointSet),
    /// One plane through all of the domain.
    Plane {
        /// Name that faces, node sets and contact properties go by.
        name: String,
        /// The plane.
        plane: Plane,
    },
    /// A disc.
    Disc(Disc),
}

/// One plane to cut with.
#[derive(Clone, Copy, Debug)]
pub(super) struct CuttingPlane {
    pub plane: Plane,
    pub number: u32,
    pub persistence: f64,
    pub disc: Option<DiscShape>,
}

impl Discontinuity {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Set(set) => &set.name,
            Self::Plane { name, .. } => name,
            Self::Disc(disc) => &disc.name,
        }
    }

    /// Whether it is a disc.
    pub(super) fn is_disc(&self) -> bool {
        matches!(self, Self::Disc(_))
    }

    /// Its planes that come near the domain.
    pub(super) fn cutting_planes(
        &self,
        index: u64,
        seed: u64,
        domain: &Aabb,
    ) -> Result<Vec<CuttingPlane>, CutError> {
        match self {
            Self::Set(set) => set.cutting_planes(index, seed, domain),
            Self::Plane { plane, .. } => {
                Ok(vec![CuttingPlane { plane: *plane, number: 0, persistence: 1.0, disc: None }])
            }
            Self::Disc(disc) => {
                check(&disc.name, "radius", disc.radius_m, disc.radius_m > 0.0, "a length above 0 m")?;
                if let DiscRule::Share(share) = disc.rule {
                    check(&disc.name, "share", share, (0.0..=1.0).contains(&share), "a part from 0 to 1")?;
                }
                let plane = Plane::dipping(disc.dip_deg, disc.dip_direction_deg, disc.center_m)?;
                let disc =
                    Some(DiscShape { center_m: disc.center_m, radius_m: disc.radius_m, rule: disc.rule });
                Ok(vec![CuttingPlane { plane, number: 0, persistence: 1.0, disc }])
            }
        }
    }
}

fn check(
    joint: &str,
    what: &'static str,
    value: f64,
    good: bool,
    expected: &'static str,
) -> Result<(), CutError> {
    if good && value.is_finite() {
        Ok(())
    } else {
        Err(CutError::Joint { joint: joint.into(), what, value, expected })
    }
}

impl JointSet {
    fn check(&self) -> Result<(), CutError> {
        check_dip(self.dip_deg, self.dip_direction_deg)?;
        let check = |what, value, good, expected| check(&self.name, what, value, good, expected);
        check("spacing", self.spacing_m, self.spacing_m > 0.0, "a length above 0 m")?;
        check("persistence", self.persistence, (0.0..=1.0).contains(&self.persistence), "a probability")?;
        for x in self.origin_m.iter() {
            check("origin", *x, true, "finite coordinates")?;
        }
        match self.orientation {
            OrientationScatter::None => Ok(()),
            OrientationScatter::Normal { deviation_deg: d } => {
                check("deviation of the orientation", d, (0.0..=90.0).contains(&d), "0 to 90°")
            }
            OrientationScatter::Fisher { kappa } => check("kappa", kappa, kappa > 0.0, "a number above 0"),
            OrientationScatter::Uniform { within_deg: d } => {
                check("half-angle of the orientation", d, (0.0..=90.0).contains(&d), "0 to 90°")
            }
        }?;
        match self.spacing {
            SpacingScatter::None | SpacingScatter::Exponential => Ok(()),
            SpacingScatter::Uniform { half_width_m: w } => {
                let good = (0.0..self.spacing_m).contains(&w);
                check("half-width of the spacing", w, good, "at least 0 m and less than the spacing")
            }
            SpacingScatter::Normal { deviation_m: d } => {
                let good = (0.0..=self.spacing_m).contains(&d);
                check("deviation of the spacing", d, good, "0 m to the spacing")
            }
        }
    }

    /// A gap [m].
    fn gap(&self, stream: &mut Stream) -> f64 {
        match self.spacing {
            SpacingScatter::None => self.spacing_m,
            SpacingScatter::Uniform { half_width_m: w } => {
                stream.between(self.spacing_m - w, self.spacing_m + w)
            }
            SpacingScatter::Exponential => self.spacing_m * stream.exponential(),
            SpacingScatter::Normal { deviation_m } => loop {
                let gap = self.spacing_m + deviation_m * stream.normal();
                if gap >= LEAST_SPACING * self.spacing_m {
                    return gap;
                }
            },
        }
    }

    /// Distances of the planes from the origin that lie within a range, rising.
    fn positions(&self, index: u64, seed: u64, [low, high]: [f64; 2]) -> Result<Vec<f64>, CutError> {
        let too_many = || CutError::TooManyPlanes {
            joint: self.name.clone(),
            spacing_m: self.spacing_m,
            most: MOST_PLANES,
        };
        if self.spacing == SpacingScatter::None {
            let (first, last) = ((low / self.spacing_m).ceil(), (high / self.spacing_m).floor());
            if last - first >= MOST_PLANES as f64 || first.abs().max(last.abs()) > 1e15 {
                return Err(too_many());
            }
            return Ok((first as i64..=last as i64).map(|i| i as f64 * self.spacing_m).collect());
        }
        // From the origin outward, so that a larger domain keeps the planes of a smaller one.
        let mut positions = vec![0.0];
        for (way, end) in [(1.0, high), (-1.0, -low)] {
            let mut stream = Stream::new(seed, &[index, if way > 0.0 { 1 } else { 2 }]);
            let mut at = 0.0;
            for count in 0.. {
                at += self.gap(&mut stream);
                if at > end {
                    break;
                }
                if count >= MOST_PLANES {
                    return Err(too_many());
                }
                positions.push(way * at);
            }
        }
        positions.retain(|at| (low..=high).contains(at));
        positions.sort_by(f64::total_cmp);
        Ok(positions)
    }

    fn cutting_planes(&self, index: u64, seed: u64, domain: &Aabb) -> Result<Vec<CuttingPlane>, CutError> {
        self.check()?;
        let normal = dip_normal(self.dip_deg, self.dip_direction_deg);
        let reach = normal.abs().dot(&((domain.max - domain.min) * 0.5));
        let center = domain.center();
        let middle = normal.dot(&(center - self.origin_m));
        let positions = self.positions(index, seed, [middle - reach, middle + reach])?;
        let cutting_plane = |(number, at): (u32, f64)| {
            let mut stream = Stream::new(seed, &[index, 3, at.to_bits()]);
            let pole = self.orientation.pole(&normal, &mut stream);
            let point = match self.orientation {
                OrientationScatter::None => self.origin_m + normal * at,
                _ => center + normal * (at - middle),
            };
            Ok(CuttingPlane {
                plane: Plane::new(point, pole)?,
                number,
                persistence: self.persistence,
                disc: None,
            })
        };
        (0..).zip(positions).map(cutting_plane).collect()
    }
}

impl OrientationScatter {
    fn pole(&self, mean: &Vec3, stream: &mut Stream) -> Vec3 {
        match *self {
            Self::None => *mean,
            Self::Fisher { kappa } => stream.fisher(mean, kappa),
            Self::Uniform { within_deg } => {
                let least = within_deg.to_radians().cos();
                let cosine = stream.between(least, 1.0);
                stream.tilted(mean, cosine)
            }
            Self::Normal { deviation_deg } => {
                let [u, v] = frame(mean);
                let turn = (u * stream.normal() + v * stream.normal()) * deviation_deg.to_radians();
                nalgebra::Rotation3::new(turn) * mean
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOMAIN: Aabb = Aabb { min: Vec3::new(0.0, 0.0, 0.0), max: Vec3::new(100.0, 100.0, 100.0) };

    #[test]
    fn scattered_gaps_keep_their_mean() {
        for spacing in [
            SpacingScatter::Uniform { half_width_m: 0.05 },
            SpacingScatter::Normal { deviation_m: 0.02 },
            SpacingScatter::Exponential,
        ] {
            let set = JointSet { spacing, ..JointSet::new("a", 0.0, 0.0, 0.1) };
            let count = set.cutting_planes(0, 1, &DOMAIN).unwrap().len();
            assert!((950..1050).contains(&count), "{spacing:?}: {count}");
        }
    }

    #[test]
    fn a_larger_domain_keeps_the_planes_of_a_smaller_one() {
        let set = JointSet { spacing: SpacingScatter::Exponential, ..JointSet::new("a", 0.0, 0.0, 1.0) };
        let small = set.positions(0, 5, [-3.0, 10.0]).unwrap();
        let large = set.positions(0, 5, [-30.0, 100.0]).unwrap();
        assert!(small.iter().all(|at| large.contains(at)));
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let good = JointSet::new("a", 30.0, 90.0, 1.0);
        let spoil: [fn(&mut JointSet); 7] = [
            |s| s.spacing_m = 0.0,
            |s| s.spacing_m = f64::NAN,
            |s| s.persistence = 1.5,
            |s| s.origin_m.x = f64::INFINITY,
            |s| s.dip_deg = 91.0,
            |s| s.orientation = OrientationScatter::Fisher { kappa: 0.0 },
            |s| s.spacing = SpacingScatter::Uniform { half_width_m: 1.0 },
        ];
        assert!(good.cutting_planes(0, 0, &DOMAIN).is_ok());
        for spoil in spoil {
            let mut set = good.clone();
            spoil(&mut set);
            assert!(set.cutting_planes(0, 0, &DOMAIN).is_err(), "{set:?}");
        }
        let dense = JointSet { spacing_m: 1e-9, ..good };
        assert!(matches!(dense.cutting_planes(0, 0, &DOMAIN), Err(CutError::TooManyPlanes { .. })));
    }
}
