//! Checks of rock that is cut. What it is cut into is found when it is.

use std::collections::HashSet;
use std::path::Path;

use super::{CELLS, Check, TETRAHEDRA, overturned};
use crate::scene::code::Code;
use crate::scene::joint_table::DiscRow;
use crate::scene::{Body, DiscRule, Discontinuity, Domain, Fill, OrientationScatter, Pieces, Rock, Scene};
use crate::scene::{Slivers, SpacingScatter, Whereabouts, matches};

/// More points of Voronoi cells than this are a slip of the keyboard.
const MOST_CELLS: u32 = 10_000_000;
/// Dips up to a right angle, in radians, are below it.
const RIGHT_ANGLE_AT_MOST: f64 = 1.6;
/// Level part of a gravity that is still upright: a twentieth of a degree.
const LEVEL: f64 = 1e-3;
/// How a table of discs is written.
const DISC_COLUMNS: &str =
    "a table of discs has the columns dip_deg, dip_direction_deg, x_m, y_m, z_m, radius_m and perhaps set";

/// Names of the joints of all rock; none where they are in a table that cannot be read.
pub(super) fn joint_names(scene: &Scene, folder: Option<&Path>) -> Option<Vec<String>> {
    let mut names = Vec::new();
    for joint in scene.rock.iter().flat_map(|rock| &rock.joints) {
        if let Discontinuity::Discs { file, .. } = joint {
            let rows = DiscRow::read_all(&folder?.join(file)).ok()?;
            names.extend(rows.into_iter().filter_map(|row| row.plane.set));
        }
        names.push(joint.name().to_string());
    }
    names.extend(scene.rock.iter().flat_map(|rock| &rock.excavations).map(|space| space.name.clone()));
    names.extend(scene.rock.iter().filter(|rock| rock.voronoi.is_some()).map(|_| CELLS.to_string()));
    names.extend(scene.rock.iter().filter(|rock| rock.into.is_some()).map(|_| TETRAHEDRA.to_string()));
    let mut seen = HashSet::new();
    names.retain(|name| seen.insert(name.clone()));
    Some(names)
}

fn twelve_figures(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}

impl Check<'_> {
    /// The name of a joint, or a pattern of such names.
    pub(super) fn known_joint(&mut self, path: String, name: &str) {
        let Some(names) = self.joints.take() else { return };
        if !names.iter().any(|known| matches(name, known)) {
            self.known(path, "joint", name, &names.iter().map(String::as_str).collect::<Vec<_>>());
        }
        self.joints = Some(names);
    }

    /// Names of excavations begin those of blocks, and are those of the joints that glue them.
    fn excavations(&mut self) {
        let scene = self.scene;
        let mut taken: Vec<&str> = scene.rock.iter().map(|rock| rock.name.as_str()).collect();
        taken.extend(scene.rock.iter().flat_map(|rock| &rock.joints).map(Discontinuity::name));
        for (i, rock) in scene.rock.iter().enumerate() {
            let list = format!("rock[{i}].excavations");
            self.names(&list, &rock.excavations.iter().map(|space| space.name.as_str()).collect::<Vec<_>>());
            for (k, space) in rock.excavations.iter().enumerate() {
                let path = |field: &str| format!("{list}[{k}].{field}");
                if taken.contains(&space.name.as_str()) {
                    let message = format!("a rock, joint or excavation is named `{}` already", space.name);
                    self.report(Code::BadName, path("name"), message, "give each its own name");
                }
                self.numbers(&path("outline_m"), space.outline_m.as_flattened());
                self.numbers(&path("start_m"), &[space.start_m, space.end_m]);
                if let Some(glue) = space.glue_pa_m {
                    self.positive(path("glue_pa_m"), glue, "Pa/m");
                }
            }
            taken.extend(rock.excavations.iter().map(|space| space.name.as_str()));
        }
    }

    /// Dips are measured from the z axis, whatever gravity is.
    fn dips(&mut self) {
        let [x, y, z] = self.scene.gravity_m_s2;
        let (level, whole) = (x.hypot(y), x.hypot(y).hypot(z));
        // Gravity that points up is told by itself.
        let is_tilted = whole > 0.0 && level > LEVEL * whole;
        if is_tilted && self.scene.rock.iter().any(|rock| !rock.joints.is_empty()) {
            let tilt_deg = level.atan2(-z).to_degrees();
            let message = format!(
                "gravity is tilted by {tilt_deg:.1}° from −z, but dips of joints are measured from the plane of x and y, not from the horizontal of this gravity"
            );
            let help = "keep gravity along −z and turn the joints; or go on, if the dips are measured from the plane of x and y";
            self.warn(Code::DoesNotFit, "gravity_m_s2", message, help);
        }
    }

    pub(super) fn rock(&mut self, folder: Option<&Path>) {
        let scene = self.scene;
        self.names("rock", &scene.rock.iter().map(|rock| rock.name.as_str()).collect::<Vec<_>>());
        self.excavations();
        self.dips();
        let materials: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
        for (i, rock) in scene.rock.iter().enumerate() {
            let path = |field: &str| format!("rock[{i}].{field}");
            self.known(path("material"), "material", &rock.material, &materials);
            self.domain(&path("domain"), &rock.domain, folder);
            self.joints_of(&format!("rock[{i}]"), rock, folder);
            self.fill(&path("fill"), &rock.fill);
            self.pieces(&path("into"), rock);
            if rock.slivers == Slivers::Remove && rock.sliver_width_m == 0.0 {
                let help = "give sliver_width_m, the width below which a block is taken out";
                self.misfit(path("slivers"), "no block is thinner than a sliver_width_m of 0", help);
            }
            if !(rock.sliver_width_m >= 0.0 && rock.sliver_width_m.is_finite()) {
                let message = format!("{} m: must not be negative", rock.sliver_width_m);
                self.error(path("sliver_width_m"), message, "0 keeps all blocks as they are");
            }
            self.widths(&path("sliver_width_m"), rock);
            self.radians(&path("joints"), &rock.joints);
            for (list, places) in [("removed", &rock.removed), ("fixed", &rock.fixed)] {
                for (k, place) in places.iter().enumerate() {
                    self.whereabouts(&path(&format!("{list}[{k}]")), place);
                }
            }
            if let Some(k) = scene.blocks.iter().position(|block| rock.makes(&block.name)) {
                let message =
                    format!("`{}` may be a block of rock `{}`, too", scene.blocks[k].name, rock.name);
                self.report(
                    Code::BadName,
                    format!("blocks[{k}].name"),
                    message,
                    "give the block or the rock another name",
                );
            }
        }
    }

    /// Warns of slivers as wide as the slabs between two planes of a set.
    fn widths(&mut self, path: &str, rock: &Rock) {
        let spacing_m = |joint: &Discontinuity| match joint {
            Discontinuity::Set { spacing_m, .. } => Some(*spacing_m),
            _ => None,
        };
        let spacings = rock.joints.iter().filter_map(|joint| Some((joint.name(), spacing_m(joint)?)));
        let least = spacings.min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((name, spacing_m)) = least.filter(|(_, spacing_m)| rock.sliver_width_m > *spacing_m) {
            let width_m = rock.sliver_width_m;
            let message = format!(
                "{width_m} m is more than the spacing of `{name}`, {spacing_m} m, so that its slabs are slivers"
            );
            self.warn(Code::Inexact, path, message, "give a tenth of the smallest spacing, or less");
        }
    }

    /// Warns of dips that are probably in radians: several joints, all of them nearly level.
    fn radians(&mut self, path: &str, joints: &[Discontinuity]) {
        let dips = joints.iter().filter_map(|joint| Some(joint.orientation_deg()?[0]));
        let dips: Vec<f64> = dips.filter(|dip_deg| *dip_deg != 0.0).collect();
        let are_small = dips.iter().all(|dip_deg| (0.0..RIGHT_ANGLE_AT_MOST).contains(dip_deg));
        if dips.len() > 1 && are_small {
            let listed = dips.iter().map(|dip_deg| format!("{dip_deg}°")).collect::<Vec<_>>().join(", ");
            let message = format!("all joints are nearly level (dips of {listed})");
            let help = format!("if these are radians, write Radians({})", dips[0]);
            self.warn(Code::UnitSlip, path, message, help);
        }
    }

    fn pieces(&mut self, path: &str, rock: &Rock) {
        let Some(Pieces::Tetrahedra { size_m, compensate }) = rock.into else { return };
        self.positive(format!("{path}.size_m"), size_m, "m");
        if rock.fill != Fill::Fewest {
            let help = "leave out fill: each tetrahedron is a block of one element";
            self.misfit(path, "blocks are filled or taken apart, not both", help);
        }
        if compensate && matches!(rock.body, Body::Rigid | Body::Fixed) {
            let help = "give body: Affine, or leave out compensate";
            self.misfit(
                format!("{path}.compensate"),
                "blocks that do not deform cannot be made stiffer",
                help,
            );
        }
        let bedding = self.scene.materials.iter().find(|m| m.name == rock.material);
        if compensate && bedding.is_some_and(|material| material.bedding.is_some()) {
            let help = "leave out compensate, or the bedding of the material";
            self.misfit(
                format!("{path}.compensate"),
                "bonds make bedded rock softer by a different fraction in each direction",
                help,
            );
        }
    }

    fn whereabouts(&mut self, path: &str, place: &Whereabouts) {
        match place {
            Whereabouts::Inside { min_m, max_m } => self.extent(path, min_m, max_m),
            Whereabouts::Beyond { point_m, normal } => {
                self.numbers(&format!("{path}.point_m"), point_m);
                self.direction(format!("{path}.normal"), normal);
            }
        }
    }

    /// A box between two corners.
    fn extent(&mut self, path: &str, min_m: &[f64; 3], max_m: &[f64; 3]) {
        for (i, (min, max)) in min_m.iter().zip(max_m).enumerate() {
            if min >= max {
                // Computed bounds have digits that nobody wrote.
                let (min, max) = (twelve_figures(*min), twelve_figures(*max));
                let message = format!("{max} m: must be above min_m[{i}], which is {min} m");
                self.error(
                    format!("{path}.max_m[{i}]"),
                    message,
                    "min_m is the lowest corner, max_m the highest",
                );
            }
        }
    }

    fn domain(&mut self, path: &str, domain: &Domain, folder: Option<&Path>) {
        match domain {
            Domain::Box { min_m, max_m } => self.extent(path, min_m, max_m),
            Domain::Column { outline_m, start_m, end_m, .. } => {
                outline_m.iter().for_each(|corner| self.numbers(&format!("{path}.outline_m"), corner));
                if outline_m.len() < 3 {
                    let message = format!("{} corners do not make an outline", outline_m.len());
                    self.error(format!("{path}.outline_m"), message, "give at least three");
                }
                if end_m <= start_m {
                    let message = format!("{end_m} m: must be above start_m, which is {start_m} m");
                    self.error(format!("{path}.end_m"), message, "exchange the two");
                }
            }
            Domain::Polyhedron { corners_m, faces } => self.polyhedron(path, corners_m, faces),
            Domain::File { file, unit_m } => {
                self.positive(format!("{path}.unit_m"), *unit_m, "m");
                self.file(format!("{path}.file"), file, folder);
            }
            Domain::Terrain { origin_m, step_m, heights_m, .. } => {
                self.numbers(&format!("{path}.origin_m"), origin_m);
                self.positive(format!("{path}.step_m[0]"), step_m[0], "m");
                self.positive(format!("{path}.step_m[1]"), step_m[1], "m");
                heights_m.iter().for_each(|row| self.numbers(&format!("{path}.heights_m"), row));
            }
            Domain::TerrainFile { file, origin_m, base_m } => {
                self.numbers(&format!("{path}.origin_m"), origin_m);
                self.numbers(&format!("{path}.base_m"), &[*base_m]);
                self.file(format!("{path}.file"), file, folder);
            }
        }
    }

    fn joints_of(&mut self, path: &str, rock: &Rock, folder: Option<&Path>) {
        if let Some(voronoi) = rock.voronoi {
            if !rock.joints.is_empty() {
                let help = "leave out one of the two";
                self.misfit(
                    format!("{path}.voronoi"),
                    "a rock is cut by joints or into cells, not both",
                    help,
                );
            }
            if voronoi.count == 0 || voronoi.count > MOST_CELLS {
                let message = format!("{} points", voronoi.count);
                self.error(format!("{path}.voronoi.count"), message, "give 1 to 1e7");
            }
            self.numbers(&format!("{path}.voronoi.least_distance_m"), &[voronoi.least_distance_m]);
        }
        for (k, joint) in rock.joints.iter().enumerate() {
            self.joint(&format!("{path}.joints[{k}]"), joint, folder);
            let is_set = |joint: &Discontinuity| matches!(joint, Discontinuity::Set { .. });
            if is_set(joint)
                && rock.joints[..k].iter().any(|other| is_set(other) && other.name() == joint.name())
            {
                let message = format!(
                    "two joint sets are named `{}`: properties of joints and results treat them as one",
                    joint.name()
                );
                let help = "give each set its own name, unless they are to be one";
                self.warn(Code::BadName, format!("{path}.joints[{k}].name"), message, help);
            }
        }
    }

    fn joint(&mut self, path: &str, joint: &Discontinuity, folder: Option<&Path>) {
        let field = |name: &str| format!("{path}.{name}");
        if joint.name().trim().is_empty() {
            self.report(Code::BadName, field("name"), "a joint has a name", "node sets go by it");
        }
        let [dip_deg, dip_direction_deg] = joint.orientation_deg().unwrap_or_default();
        if !(0.0..=90.0).contains(&dip_deg) {
            let message = format!("{dip_deg}°: must be from 0 to 90");
            self.error(field("dip_deg"), message, overturned::help(dip_deg, dip_direction_deg));
        }
        if !(-360.0..=360.0).contains(&dip_direction_deg) {
            let message = format!("{dip_direction_deg}°: must be from -360 to 360");
            self.error(field("dip_direction_deg"), message, "0 is north (y), 90 east (x)");
        }
        match joint {
            Discontinuity::Set {
                spacing_m,
                origin_m,
                persistence,
                orientation_scatter,
                spacing_scatter,
                ..
            } => {
                self.positive(field("spacing_m"), *spacing_m, "m");
                self.numbers(&field("origin_m"), origin_m);
                if !(0.0..=1.0).contains(persistence) {
                    let message = format!("{persistence}: must be from 0 to 1");
                    self.error(field("persistence"), message, "1 cuts every block that a plane crosses");
                }
                self.scatter(path, *spacing_m, *orientation_scatter, *spacing_scatter);
            }
            Discontinuity::Plane { point_m, .. } => self.numbers(&field("point_m"), point_m),
            Discontinuity::Disc { center_m, radius_m, rule, .. } => {
                self.numbers(&field("center_m"), center_m);
                self.positive(field("radius_m"), *radius_m, "m");
                self.disc_rule(field("rule"), *rule);
            }
            Discontinuity::Discs { file, rule, .. } => {
                self.disc_rule(field("rule"), *rule);
                let before = self.found.len();
                self.file(field("file"), file, folder);
                let table = folder.filter(|_| before == self.found.len());
                if let Some(Err(error)) = table.map(|folder| DiscRow::read_all(&folder.join(file))) {
                    self.report(Code::OutOfRange, field("file"), error.to_string(), DISC_COLUMNS);
                }
            }
        }
    }

    fn disc_rule(&mut self, path: String, rule: DiscRule) {
        if let DiscRule::Share(share) = rule
            && !(0.0..=1.0).contains(&share)
        {
            let message = format!("{share}: must be from 0 to 1");
            self.error(
                path,
                message,
                "Share(0.5) cuts a block if the disc covers at least half of its section",
            );
        }
    }

    fn scatter(&mut self, path: &str, spacing_m: f64, poles: OrientationScatter, gaps: SpacingScatter) {
        let angle = match poles {
            OrientationScatter::Normal { deviation_deg } => Some(("deviation_deg", deviation_deg)),
            OrientationScatter::Uniform { within_deg } => Some(("within_deg", within_deg)),
            _ => None,
        };
        if let Some((name, angle)) = angle.filter(|(_, angle)| !(0.0..=90.0).contains(angle)) {
            let message = format!("{angle}°: must be from 0 to 90");
            self.error(format!("{path}.orientation_scatter.{name}"), message, "5 to 15 is common");
        }
        if let OrientationScatter::Fisher { kappa } = poles {
            self.positive(format!("{path}.orientation_scatter.kappa"), kappa, "");
        }
        let length = match gaps {
            SpacingScatter::Uniform { half_width_m } => Some(("half_width_m", half_width_m)),
            SpacingScatter::Normal { deviation_m } => Some(("deviation_m", deviation_m)),
            _ => None,
        };
        if let Some((name, length)) = length.filter(|(_, length)| !(0.0..spacing_m).contains(length)) {
            let message = format!("{length} m: must be from 0 to below the spacing of {spacing_m} m");
            self.error(format!("{path}.spacing_scatter.{name}"), message, "distances stay above 0");
        }
        let wide = 0.4 * spacing_m..spacing_m;
        if let Some(("deviation_m", _)) = length.filter(|(_, length)| wide.contains(length)) {
            let message = "distances below a tenth of spacing_m are drawn again, which makes their mean larger: by 1.3, 8 and 20 % at 0.4, 0.6 and 0.8 of spacing_m";
            let help = "lower it or spacing_m, or choose Exponential, whose mean is spacing_m";
            self.warn(Code::Inexact, format!("{path}.spacing_scatter.deviation_m"), message, help);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::read::load_text;

    /// Warnings of a cube of rock with a joint, under a gravity.
    fn warned(gravity: &str) -> Vec<String> {
        let text = format!(
            "(title: \"t\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: {gravity}, contact: Off,
              materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 1e10, poisson: 0.25)],
              rock: [(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (1, 1, 1)),
                  joints: [Plane(name: \"a\", dip_deg: 30, dip_direction_deg: 90, point_m: (0.5, 0.5, 0.5))])])"
        );
        let warnings = load_text("s.ron", &text, &[], None).unwrap().warnings;
        warnings.into_iter().filter(|w| w.path == "gravity_m_s2").map(|w| w.message).collect()
    }

    #[test]
    fn dips_under_tilted_gravity_are_warned_of() {
        assert_eq!(warned("(0, 0, -9.81)"), Vec::<String>::new());
        assert_eq!(warned("(0, 0, 0)"), Vec::<String>::new());
        let tilted = warned("(5, 0, -8.660254037844386)");
        assert!(tilted.len() == 1 && tilted[0].contains("tilted by 30.0°"), "{tilted:?}");
        let upward = warned("(0, 0, 9.81)");
        assert!(upward.len() == 1 && upward[0].starts_with("gravity points up along z"), "{upward:?}");
    }
}
