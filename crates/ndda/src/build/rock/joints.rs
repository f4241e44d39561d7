//! Joints of a scene as what cuts rock, and what discs cut.

use std::fmt;
use std::path::Path;

use ndda_io::joint_table::DiscRow;
use ndda_io::scene::{self, Rock};
use ndda_mesh::cut::{
    Disc, DiscReport, DiscRule, Discontinuity, JointSet, OrientationScatter, Plane, SpacingScatter,
};
use serde::Serialize;

use crate::build::vec3;
use crate::numbers::{counted, four_figures};

/// Discs of a rock in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Discs(DiscReport);

impl Discs {
    /// None where there are no discs.
    pub(super) fn new(report: &DiscReport) -> Option<Self> {
        (report.discs > 0).then_some(Self(*report))
    }
}

impl fmt::Display for Discs {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let DiscReport { discs, idle, cuts, ends_in_cut, left_whole, disc_m2, joint_m2 } = &self.0;
        let left_whole = match left_whole {
            0 => "never".into(),
            n => counted(*n, "time", "times"),
        };
        write!(
            f,
            "{}, {idle} of which cut nothing; {}, {ends_in_cut} of which go beyond the rim of their disc, to the faces of \
             the block; {left_whole} a disc ends in a block and does not cut it; area of discs in the rock {} m², of their joints {} m²",
            counted(*discs, "disc", "discs"),
            counted(*cuts, "cut", "cuts"),
            four_figures(*disc_m2),
            four_figures(*joint_m2)
        )
    }
}

/// What cuts a rock, in the order of cutting.
///
/// # Errors
/// What is wrong with a table or a number.
pub(super) fn discontinuities(rock: &Rock, folder: &Path) -> Result<Vec<Discontinuity>, String> {
    let each = rock.joints.iter().map(|joint| discontinuity(joint, folder));
    Ok(each.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

/// Largest discs first; of equal ones by their numbers and sets, so that the order of rows does not matter.
fn sorted(mut rows: Vec<DiscRow>) -> Vec<DiscRow> {
    let numbers = |row: &DiscRow| {
        let [x, y, z] = row.center_m;
        [-row.radius_m, x, y, z, row.plane.dip_deg, row.plane.dip_direction_deg]
    };
    rows.sort_by(|a, b| {
        let pairs = numbers(a).into_iter().zip(numbers(b));
        let first = pairs.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne());
        first.unwrap_or_else(|| a.plane.set.cmp(&b.plane.set))
    });
    rows
}

fn disc(row: DiscRow, no_set: &str, rule: scene::DiscRule) -> Discontinuity {
    Discontinuity::Disc(Disc {
        name: row.plane.set.unwrap_or_else(|| no_set.to_string()),
        dip_deg: row.plane.dip_deg,
        dip_direction_deg: row.plane.dip_direction_deg,
        center_m: vec3(row.center_m),
        radius_m: row.radius_m,
        rule: disc_rule(rule),
    })
}

fn disc_rule(rule: scene::DiscRule) -> DiscRule {
    match rule {
        scene::DiscRule::Share(share) => DiscRule::Share(share),
        scene::DiscRule::Meets => DiscRule::Meets,
        scene::DiscRule::Covers => DiscRule::Covers,
    }
}

fn discontinuity(joint: &scene::Discontinuity, folder: &Path) -> Result<Vec<Discontinuity>, String> {
    match joint {
        scene::Discontinuity::Set {
            name,
            dip_deg,
            dip_direction_deg,
            spacing_m,
            origin_m,
            persistence,
            orientation_scatter,
            spacing_scatter,
        } => Ok(vec![Discontinuity::Set(JointSet {
            origin_m: vec3(*origin_m),
            persistence: *persistence,
            orientation: orientation(*orientation_scatter),
            spacing: spacing(*spacing_scatter),
            ..JointSet::new(name.as_str(), *dip_deg, *dip_direction_deg, *spacing_m)
        })]),
        scene::Discontinuity::Plane { name, dip_deg, dip_direction_deg, point_m } => {
            let plane = Plane::dipping(*dip_deg, *dip_direction_deg, vec3(*point_m));
            Ok(vec![Discontinuity::Plane { name: name.clone(), plane: plane.map_err(|e| e.to_string())? }])
        }
        scene::Discontinuity::Disc { name, dip_deg, dip_direction_deg, center_m, radius_m, rule } => {
            Ok(vec![Discontinuity::Disc(Disc {
                name: name.clone(),
                dip_deg: *dip_deg,
                dip_direction_deg: *dip_direction_deg,
                center_m: vec3(*center_m),
                radius_m: *radius_m,
                rule: disc_rule(*rule),
            })])
        }
        scene::Discontinuity::Discs { name, file, rule } => {
            let rows = DiscRow::read_all(&folder.join(file)).map_err(|e| e.to_string())?;
            Ok(sorted(rows).into_iter().map(|row| disc(row, name, *rule)).collect())
        }
    }
}

fn orientation(scatter: scene::OrientationScatter) -> OrientationScatter {
    match scatter {
        scene::OrientationScatter::None => OrientationScatter::None,
        scene::OrientationScatter::Normal { deviation_deg } => OrientationScatter::Normal { deviation_deg },
        scene::OrientationScatter::Fisher { kappa } => OrientationScatter::Fisher { kappa },
        scene::OrientationScatter::Uniform { within_deg } => OrientationScatter::Uniform { within_deg },
    }
}

fn spacing(scatter: scene::SpacingScatter) -> SpacingScatter {
    match scatter {
        scene::SpacingScatter::None => SpacingScatter::None,
        scene::SpacingScatter::Uniform { half_width_m } => SpacingScatter::Uniform { half_width_m },
        scene::SpacingScatter::Normal { deviation_m } => SpacingScatter::Normal { deviation_m },
        scene::SpacingScatter::Exponential => SpacingScatter::Exponential,
    }
}
