//! Planes of a scene or of a table.

use std::path::Path;

use ndda_io::joint_table::{DiscRow, PlaneRow};
use ndda_io::read;
use ndda_io::scene::{Discontinuity, Rock, Scene, Whereabouts};
use ndda_mesh::Vec3;
use ndda_mesh::cut::dip_normal;

use super::error::StereonetError;
use super::orientation::Orientation;

/// Most planes: every two of them may form a wedge.
pub const MOST_PLANES: usize = 10_000;
/// Sine of the angle, and distance [m], below which two planes are one.
const SAME: f64 = 1e-6;
/// Set of planes for which a table names none.
const NO_SET: &str = "all";

/// Planes by set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Planes {
    /// Title of the scene, or name of the table.
    pub title: String,
    /// The planes.
    pub planes: Vec<Orientation>,
    /// Set of each, as an index in `sets`.
    pub set_of: Vec<usize>,
    /// Names of the sets, in the order in which they occur.
    pub sets: Vec<String>,
    /// Names of planes of a scene that are borders of what is removed or fixed.
    pub borders: Vec<String>,
}

impl Planes {
    fn push(&mut self, plane: Orientation, set: &str) {
        let known = self.sets.iter().position(|name| name == set);
        let index = known.unwrap_or_else(|| {
            self.sets.push(set.into());
            self.sets.len() - 1
        });
        self.planes.push(plane);
        self.set_of.push(index);
    }

    fn push_row(&mut self, row: PlaneRow, no_set: &str) {
        let PlaneRow { dip_deg, dip_direction_deg, set } = row;
        self.push(Orientation { dip_deg, dip_direction_deg }, set.as_deref().unwrap_or(no_set));
    }

    /// The planes of a set.
    pub fn of_set(&self, set: usize) -> Vec<Orientation> {
        let both = self.planes.iter().zip(&self.set_of);
        both.filter(|(_, index)| **index == set).map(|(plane, _)| *plane).collect()
    }
}

/// Whether a file is a table by its ending.
pub fn is_table(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
}

/// Reads the joints of a scene, or the planes of a table if the file ends in `.csv`.
///
/// # Errors
/// [`StereonetError`] with the place of what cannot be used.
pub fn read(file: &Path, overrides: &[String]) -> Result<Planes, StereonetError> {
    let planes = if is_table(file) { table(file)? } else { scene(file, overrides)? };
    match planes.planes.len() {
        1..=MOST_PLANES => Ok(planes),
        count => Err(StereonetError::Count { path: file.to_path_buf(), count, most: MOST_PLANES }),
    }
}

fn scene(file: &Path, overrides: &[String]) -> Result<Planes, StereonetError> {
    let loaded = read::load(file, overrides).map_err(|errors| StereonetError::Scene(Box::new(errors)))?;
    let planes = joints(&loaded.scene, file.parent().unwrap_or(Path::new(".")))?;
    if planes.planes.is_empty() { Err(StereonetError::NoJoints(file.to_path_buf())) } else { Ok(planes) }
}

/// Whether a plane of a rock is a border of it, and no joint: the plane beyond which it is removed, or a level one below which it is fixed.
fn is_border(rock: &Rock, joint: &Discontinuity) -> bool {
    let Discontinuity::Plane { dip_deg, dip_direction_deg, point_m, .. } = joint else { return false };
    let normal = dip_normal(*dip_deg, *dip_direction_deg);
    let bounds = |place: &Whereabouts| {
        let Whereabouts::Beyond { point_m: other_m, normal: beyond } = place else { return false };
        let (beyond, point, other) = (Vec3::from(*beyond), Vec3::from(*point_m), Vec3::from(*other_m));
        let from_other = point - other;
        let rounding_m = 1e-12 * (point.norm() + other.norm());
        let is_beside = from_other.dot(&normal).abs() <= SAME * from_other.norm() + rounding_m;
        beyond.cross(&normal).norm() <= SAME * beyond.norm() && is_beside
    };
    rock.removed.iter().any(bounds) || *dip_deg == 0.0 && rock.fixed.iter().any(bounds)
}

/// The mean orientation of each joint set and the orientation of each plane and disc; those of one name are one set.
fn joints(scene: &Scene, folder: &Path) -> Result<Planes, StereonetError> {
    let mut planes = Planes { title: scene.title.clone(), ..Planes::default() };
    for (rock, joint) in scene.rock.iter().flat_map(|rock| rock.joints.iter().map(move |joint| (rock, joint)))
    {
        if is_border(rock, joint) {
            planes.borders.push(joint.name().to_string());
        } else if let Some([dip_deg, dip_direction_deg]) = joint.orientation_deg() {
            planes.push(Orientation { dip_deg, dip_direction_deg }, joint.name());
        }
        if let Discontinuity::Discs { file, .. } = joint {
            let rows = DiscRow::read_all(&folder.join(file))?;
            rows.into_iter().for_each(|row| planes.push_row(row.plane, joint.name()));
        }
    }
    Ok(planes)
}

fn table(file: &Path) -> Result<Planes, StereonetError> {
    let title = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let mut planes = Planes { title, ..Planes::default() };
    PlaneRow::read_all(file)?.into_iter().for_each(|row| planes.push_row(row, NO_SET));
    Ok(planes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Planes, StereonetError> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("joints.csv");
        std::fs::write(&file, text).unwrap();
        read(&file, &[])
    }

    #[test]
    fn a_table_gives_planes_by_set_in_any_order_of_columns() {
        let planes = of(
            "set,dip_direction_deg,remark,dip_deg\n# comment\na, 130 ,x,40\nb,220,,60\na,131,,41\n,5,,6\n",
        )
        .unwrap();
        assert_eq!(planes.sets, ["a", "b", "all"]);
        assert_eq!(planes.set_of, [0, 1, 0, 2]);
        assert_eq!(planes.planes[1], Orientation { dip_deg: 60.0, dip_direction_deg: 220.0 });
        assert_eq!(planes.of_set(0).len(), 2);
    }

    #[test]
    fn the_face_and_the_floor_of_a_slope_are_no_joints_and_a_plane_that_rock_slides_on_is_one() {
        let text = "(title: \"slope\", time: (step_s: 1e-3, end_s: 1),
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            rock: [(material: \"rock\", domain: Box(min_m: (-9, -9, -3), max_m: (9, 9, 9)),
                joints: [
                    Plane(name: \"face\", dip_deg: 60, dip_direction_deg: 90, point_m: (0, 0, 0)),
                    Plane(name: \"floor\", dip_deg: 0, dip_direction_deg: 0, point_m: (0, 0, 0)),
                    Plane(name: \"slide\", dip_deg: 30, dip_direction_deg: 90, point_m: (0, 0, 0)),
                ],
                removed: [Beyond(point_m: (0, 5, 0), normal: (Calc(sin(60)), 0, Calc(cos(60))))],
                fixed: [Beyond(point_m: (4, 0, 0), normal: (0, 0, -1)),
                        Beyond(point_m: (0, 0, 0), normal: (Calc(-sin(30)), 0, Calc(-cos(30))))])],
            contact: Potential(penalty_pa: 1e8))";
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("slope.ron");
        std::fs::write(&file, text).unwrap();
        let planes = read(&file, &[]).unwrap();
        assert_eq!(
            (planes.sets, planes.borders),
            (vec!["slide".into()], vec!["face".into(), "floor".into()])
        );
    }

    #[test]
    fn what_is_wrong_with_a_table_is_said_with_line_and_column() {
        for (text, reason) in [
            ("dip_deg,dip_direction_deg\n40,130\n95,220\n", "line 3, column 1: dip_deg is `95`"),
            ("dip_deg,dip_direction_deg\n40,east\n", "line 2, column 2: dip_direction_deg is `east`"),
            ("dip_deg,dip_direction_deg\n40,nan\n", "line 2, column 2: dip_direction_deg is `nan`"),
            ("dip_deg,dip_direction_deg\n40\n", "joints.csv"),
            ("dip,dip_direction_deg\n40,3\n", "no column dip_deg"),
            ("dip_deg,dip_direction_deg\n", "has no joints"),
            ("", "no column dip_deg"),
        ] {
            let error = of(text).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
    }
}
