//! Orientations of joints on a stereonet, their statistics, and kinematic checks of a slope.
//!
//! | module | contents |
//! |---|---|
//! | `orientation` | planes, poles, lines of intersection |
//! | `net` | equal area and equal angle |
//! | `fisher` | mean and concentration of poles |
//! | `kinematics` | plane sliding, wedge sliding, flexural toppling |
//! | `input`, `report`, `picture` | scenes and tables; words; a picture |

mod error;
mod fisher;
mod input;
mod kinematics;
mod net;
mod orientation;
#[cfg(feature = "plots")]
mod picture;
mod report;

use std::path::PathBuf;

use ndda_io::scene::Friction;
use serde::Serialize;

pub use error::StereonetError;
pub use fisher::Fisher;
use fisher::fisher;
use input::Planes;
#[cfg(feature = "plots")]
pub(crate) use input::is_table;
pub use kinematics::{Checks, Count, Slope};
pub use net::Net;
pub use orientation::{Line, Orientation};

/// Planes slide within this angle of the face's dip direction [°] (Wyllie & Mah 2004).
pub const SLIDING_LATERAL_DEG: f64 = 20.0;
/// Planes topple within this angle of the direction opposite to it [°] (Goodman 1989).
const TOPPLING_LATERAL_DEG: f64 = 30.0;

/// Dips up to a right angle, in radians, are below it.
const RADIANS_AT_MOST: f64 = 1.6;

/// Most sets that a table and a picture list.
const MOST_LISTED: usize = 12;

/// A stereonet to make.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// A scene with joints, or a table as CSV.
    pub input: PathBuf,
    /// Values of a scene that are replaced, `path=value`.
    pub overrides: Vec<String>,
    /// Projection.
    pub net: Net,
    /// Face of a slope.
    pub slope: Option<Orientation>,
    /// Friction of the joints [°].
    pub friction_deg: Option<f64>,
    /// Lateral limit of plane sliding [°].
    pub lateral_deg: f64,
    /// The picture, SVG or PNG.
    pub out: PathBuf,
}

/// Planes of one set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Set {
    /// Its name.
    pub name: String,
    /// Mean and concentration.
    #[serde(flatten)]
    pub fisher: Fisher,
    /// Checks of its planes, without wedges, which are of two sets.
    pub checks: Option<Checks>,
}

/// The line in which the mean planes of two sets meet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Wedge {
    /// The sets.
    pub sets: [String; 2],
    /// The line.
    #[serde(flatten)]
    pub line: Line,
    /// Whether a wedge may slide along it; none without a slope and friction.
    pub critical: Option<bool>,
}

/// A stereonet in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stereonet {
    /// Scene or table.
    pub title: String,
    /// Projection of the picture.
    pub net: Net,
    /// The picture; none in a program without pictures.
    pub picture: Option<PathBuf>,
    /// Slope of the checks.
    pub slope: Option<Slope>,
    /// Sets.
    pub sets: Vec<Set>,
    /// Intersections of their mean planes.
    pub wedges: Vec<Wedge>,
    /// Checks of all planes; wedges are those of two planes of different sets, or of any two if there is one set.
    pub checks: Option<Checks>,
    /// Planes of a scene that are borders of rock that is removed or fixed, and no joints.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub borders: Vec<String>,
    /// What is probably not meant.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// Whether friction was given; without it the checks are of directions alone.
    #[serde(skip)]
    pub has_friction: bool,
}

impl Stereonet {
    /// The sets that a table and a picture list, those of most planes first and then as they occur: all, where they are few.
    pub fn listed(&self) -> Vec<usize> {
        let mut sets: Vec<usize> = (0..self.sets.len()).collect();
        if sets.len() > MOST_LISTED {
            sets.sort_by_key(|&set| std::cmp::Reverse(self.sets[set].fisher.planes));
            sets.truncate(MOST_LISTED);
        }
        sets
    }
}

/// An orientation as `DIP/DIP_DIRECTION`, degrees.
///
/// # Errors
/// An example, for another text.
pub fn parse_orientation(text: &str) -> Result<Orientation, String> {
    let numbers = text.split_once('/').and_then(|(dip, direction)| {
        let (dip, direction): (f64, f64) = (dip.trim().parse().ok()?, direction.trim().parse().ok()?);
        ((0.0..=90.0).contains(&dip) && (-360.0..=360.0).contains(&direction)).then_some((dip, direction))
    });
    let (dip_deg, dip_direction_deg) = numbers
        .ok_or("write dip (0 to 90) and dip direction (0 to 360, or -360 to 0) in degrees, as 65/150")?;
    Ok(Orientation { dip_deg, dip_direction_deg })
}

/// Reads planes, computes what is to be known of them, and draws them.
///
/// # Errors
/// [`StereonetError`] when the input cannot be used, an angle is out of range, or the picture cannot be written.
pub fn make(request: &Request) -> Result<Stereonet, StereonetError> {
    check_angle("friction", request.friction_deg.unwrap_or(0.0), 90.0)?;
    check_angle("lateral", request.lateral_deg, 180.0)?;
    if input::is_table(&request.input) && !request.overrides.is_empty() {
        return Err(StereonetError::SetOfTable(request.input.clone()));
    }
    let planes = input::read(&request.input, &request.overrides)?;
    // Without friction the checks are of directions alone, as if joints had none.
    let slope = request.slope.map(|face| Slope {
        face,
        friction_deg: request.friction_deg.unwrap_or(0.0),
        sliding_lateral_deg: request.lateral_deg,
        toppling_lateral_deg: TOPPLING_LATERAL_DEG,
    });
    let mut stereonet = measure(&planes, slope);
    stereonet.has_friction = request.friction_deg.is_some();
    stereonet.warnings.extend(request.friction_deg.and_then(as_coefficient));
    stereonet.net = request.net;
    #[cfg(feature = "plots")]
    {
        let svg = picture::draw(&planes, &stereonet, request.slope, request.friction_deg);
        crate::picture::write_svg(&request.out, svg)?;
        stereonet.picture = Some(request.out.clone());
    }
    Ok(stereonet)
}

fn check_angle(option: &'static str, value: f64, most: f64) -> Result<(), StereonetError> {
    let advice = if most > 90.0 { "an angle from 0 to 180" } else { "an angle from 0 to 90" };
    let fits = (0.0..=most).contains(&value);
    if fits { Ok(()) } else { Err(StereonetError::Option { option, value, advice }) }
}

fn measure(planes: &Planes, slope: Option<Slope>) -> Stereonet {
    let statistics: Vec<Fisher> =
        (0..planes.sets.len()).filter_map(|set| fisher(&planes.of_set(set))).collect();
    let mut wedges = Vec::new();
    for (i, first) in statistics.iter().enumerate() {
        for (j, second) in statistics.iter().enumerate().skip(i + 1) {
            let Some(line) = first.mean.intersection(&second.mean) else { continue };
            let sets = [planes.sets[i].clone(), planes.sets[j].clone()];
            wedges.push(Wedge { sets, line, critical: slope.map(|slope| slope.wedge_slides(&line)) });
        }
    }
    let with_own_set: Vec<usize> = (0..planes.planes.len()).collect();
    let set_of = if planes.sets.len() > 1 { &planes.set_of } else { &with_own_set };
    let sets = statistics.into_iter().enumerate().map(|(index, fisher)| {
        let own = planes.of_set(index);
        let checks = slope.map(|slope| slope.checks(&own, &vec![0; own.len()]));
        Set { name: planes.sets[index].clone(), fisher, checks }
    });
    Stereonet {
        title: planes.title.clone(),
        net: Net::default(),
        picture: None,
        slope,
        sets: sets.collect(),
        wedges,
        checks: slope.map(|slope| slope.checks(&planes.planes, set_of)),
        borders: planes.borders.clone(),
        warnings: in_radians(&planes.planes).into_iter().collect(),
        has_friction: true,
    }
}

/// That an angle is so small that it is probably a coefficient of friction.
fn as_coefficient(friction_deg: f64) -> Option<String> {
    Friction::deg_of_coefficient(friction_deg).map(|degrees| {
        format!("--friction {friction_deg} is read as degrees; if it is the coefficient tan φ, write --friction {degrees:.1}")
    })
}

/// That all planes are so nearly level that their angles are probably in radians.
fn in_radians(planes: &[Orientation]) -> Option<String> {
    let steepest = planes.iter().map(|plane| plane.dip_deg).fold(0.0, f64::max);
    let are_level = planes.len() > 1 && steepest > 0.0 && steepest < RADIANS_AT_MOST;
    are_level.then(|| {
        format!(
            "no plane dips by more than {steepest}°: angles are read as degrees, and these may be radians"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orientations_are_written_as_dip_and_dip_direction() {
        assert_eq!(parse_orientation("65/150"), Ok(Orientation { dip_deg: 65.0, dip_direction_deg: 150.0 }));
        for text in ["65", "91/0", "65/400", "a/b", "nan/0", "150,65", ""] {
            let told = parse_orientation(text).unwrap_err();
            assert!(told.contains("65/150") && told.contains("dip direction (0 to 360"), "{text}");
        }
    }

    #[test]
    fn a_wedge_of_two_sets_is_critical_by_its_mean_planes_and_by_each_pair() {
        let mut planes = Planes::default();
        for turn in [-2.0, 0.0, 2.0] {
            planes.planes.push(Orientation { dip_deg: 40.0, dip_direction_deg: 130.0 + turn });
            planes.planes.push(Orientation { dip_deg: 60.0, dip_direction_deg: 220.0 + turn });
        }
        planes.set_of = vec![0, 1, 0, 1, 0, 1];
        planes.sets = vec!["a".into(), "b".into()];
        let slope = Slope {
            face: Orientation { dip_deg: 65.0, dip_direction_deg: 156.0 },
            friction_deg: 30.0,
            sliding_lateral_deg: SLIDING_LATERAL_DEG,
            toppling_lateral_deg: TOPPLING_LATERAL_DEG,
        };
        let found = measure(&planes, Some(slope));
        assert_eq!(found.wedges.len(), 1);
        assert_eq!(found.wedges[0].critical, Some(true));
        // The mean of planes about one of them is that plane, nearly.
        assert!((found.wedges[0].line.plunge_deg - 37.06).abs() < 0.05, "{:?}", found.wedges);
        assert_eq!(found.checks.unwrap().wedge_sliding, Count { critical: 9, of: 9 });
        assert_eq!(found.sets[1].fisher.planes, 3);
    }

    #[test]
    fn of_many_sets_those_of_most_planes_are_listed() {
        let mut planes = Planes::default();
        for set in 0..200 {
            let count = if set == 150 { 3 } else { 1 };
            planes.sets.push(format!("set {set}"));
            for _ in 0..count {
                planes.planes.push(Orientation { dip_deg: 30.0, dip_direction_deg: f64::from(set) });
                planes.set_of.push(set as usize);
            }
        }
        let found = measure(&planes, None);
        assert_eq!(found.listed(), [vec![150], (0..11).collect()].concat());
        let text = found.to_string();
        assert!(text.contains("all alike") && text.contains("188 more sets"), "{text}");
        assert!(text.lines().count() < 50, "{text}");
    }

    #[test]
    fn planes_without_sets_form_wedges_with_each_other() {
        let planes = Planes {
            planes: vec![
                Orientation { dip_deg: 40.0, dip_direction_deg: 130.0 },
                Orientation { dip_deg: 60.0, dip_direction_deg: 220.0 },
            ],
            set_of: vec![0, 0],
            sets: vec!["all".into()],
            ..Planes::default()
        };
        let slope = Slope {
            face: Orientation { dip_deg: 65.0, dip_direction_deg: 156.0 },
            friction_deg: 30.0,
            sliding_lateral_deg: 20.0,
            toppling_lateral_deg: 30.0,
        };
        assert_eq!(measure(&planes, Some(slope)).checks.unwrap().wedge_sliding.of, 1);
    }
}
