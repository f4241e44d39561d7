//! How blocks fail: which of them move, along which planes, or by toppling or falling.

use std::fmt;

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;
use serde::{Deserialize, Serialize};

use super::free_blocks::{free, gone_m};
use super::opened::Opened;
use crate::Model;
use crate::forecast::rim;
use crate::run::motion;

/// A block moves if it has gone farther than this part of the farthest.
const MOVES: f64 = 0.2;
/// It topples if a point of it goes farther by rotation than this part of what its mass centre does.
const TOPPLES: f64 = 0.5;
/// Cosine between normals of one plane.
pub(super) const SAME_PLANE: f64 = 0.985;
/// Part of all contact force below which a plane does not count.
const LITTLE: f64 = 0.05;
/// Part of all contact force that a second plane carries at least along whose line with the first a block slides, and cosine of the angle between its direction and that line.
const HARDLY: f64 = 0.005;
const SAME_LINE: f64 = 0.9994;
/// Steps over which contact forces are summed: contact of rigid blocks vibrates.
const SUMMED: usize = 50;
/// Sine of the angle by which a direction may leave a plane that a block slides on.
const ALONG: f64 = 0.2;

/// Dip below which a plane is level \[°\]: 0.0° as it is written.
const LEVEL_DEG: f64 = 0.05;

/// How a block fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// It slides on one plane.
    Sliding,
    /// It slides on two planes along their line of intersection.
    Wedge,
    /// It turns over: about an axis that is not the normal of the plane that it rests on.
    Toppling,
    /// No resting block touches it.
    Falling,
    /// None of these.
    Mixed,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Sliding => "sliding",
            Self::Wedge => "wedge sliding",
            Self::Toppling => "toppling",
            Self::Falling => "falling",
            Self::Mixed => "mixed motion",
        })
    }
}

/// A plane that a block slides on; z points up, x to the east and y to the north.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plane {
    /// Name of the joint. Left out where the face is of none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint: Option<String>,
    /// The block on its other side.
    pub on: String,
    /// Dip \[°\].
    pub dip_deg: f64,
    /// Dip direction, clockwise from the north \[°\].
    pub dip_direction_deg: f64,
    /// Normal into the block that slides.
    pub normal: [f64; 3],
}

impl fmt::Display for Plane {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match &self.joint {
            Some(joint) => write!(f, "joint `{joint}`")?,
            None => write!(f, "`{}`", self.on)?,
        }
        // A level plane dips nowhere.
        match self.dip_deg < LEVEL_DEG {
            true => f.write_str(" (level)"),
            false => write!(f, " ({:.1}°/{:.1}°)", self.dip_deg, self.dip_direction_deg),
        }
    }
}

/// A block that moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MovingBlock {
    /// Its name.
    pub name: String,
    /// How it moves.
    pub kind: Kind,
    /// Direction of its mass centre, of length 1.
    pub direction: [f64; 3],
    /// How far the farthest point of it went in the trial \[m\].
    pub gone_m: f64,
    /// Its rotation in the trial: along the axis, and as long as the angle \[°\].
    #[serde(default)]
    pub turned_deg: [f64; 3],
    /// Whether it slides and its points go much farther by turning in its plane than its mass centre does.
    #[serde(default)]
    pub turns_in_its_plane: bool,
    /// Planes that it touches and does not leave.
    pub planes: Vec<Plane>,
}

/// How blocks fail as a whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mechanism {
    /// How the block that goes farthest moves.
    pub kind: Kind,
    /// In words.
    pub words: String,
    /// Sides of the model that cut off blocks which move, beyond which their rock goes on in nature.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cut_off_by: Vec<String>,
    /// Cohesion that the joints of these blocks have lost because they opened in part. Left out where that does not matter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opened: Option<Opened>,
}

/// The blocks that move, the farthest first, and what they do together; `start` is where nodes were [m]. Steps on, to see what they touch.
pub fn of(model: &mut Model, start: &[Vec3]) -> (Option<Mechanism>, Vec<MovingBlock>) {
    let simulation = &model.simulation;
    let mut gone = gone_m(simulation, start);
    gone.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let Some(farthest_m) = gone.first().map(|first| first.1).filter(|gone| *gone > 0.0) else {
        return (None, Vec::new());
    };
    gone.retain(|(_, gone)| *gone > MOVES * farthest_m);
    let moving: Vec<BlockId> = gone.iter().map(|(block, _)| *block).collect();
    let motions: Vec<Motion> = gone.iter().map(|moved| Motion::of(simulation, start, moved)).collect();
    let mut touches = touches(simulation);
    for _ in 0..SUMMED {
        if model.simulation.step().is_err() {
            break;
        }
        touches.extend(self::touches(&model.simulation));
    }
    touches.retain(|touch| !moving.contains(&touch.other));
    let blocks = model.simulation.blocks();
    let names = (&blocks.names[..], &blocks.surface_names[..]);
    let moved: Vec<MovingBlock> = motions.iter().map(|motion| motion.describe(names, &touches)).collect();
    let ways = moving.iter().zip(&moved).map(|(block, moved)| (*block, Vec3::from(moved.direction)));
    let ways: Vec<(BlockId, Vec3)> = ways.collect();
    let sides = rim::cut_off(&model.loaded.scene, blocks, &ways);
    let cut_off_by = sides.into_iter().map(String::from).collect();
    (Some(Mechanism { kind: moved[0].kind, words: words(&moved), cut_off_by, opened: None }), moved)
}

/// Names of blocks and of surfaces.
type Names<'a> = (&'a [String], &'a [String]);

/// How a block has moved.
struct Motion {
    block: BlockId,
    gone_m: f64,
    /// Of its mass centre [m].
    shift: Vec3,
    /// Along the axis, as long as the angle [rad].
    turn: Vec3,
    /// Distance of its farthest node from the mass centre [m].
    radius_m: f64,
}

impl Motion {
    fn of(simulation: &Simulation, start: &[Vec3], &(block, gone_m): &(BlockId, f64)) -> Self {
        Self {
            block,
            gone_m,
            shift: motion::shift_m(simulation, start, block),
            turn: motion::turn_rad(simulation, start, block),
            radius_m: motion::radius_m(&simulation.shape(block).operator),
        }
    }

    /// Whether a rotation moves the block more than its mass centre goes.
    fn is_large(&self, turn: Vec3) -> bool {
        self.radius_m * turn.norm() > TOPPLES * self.shift.norm()
    }

    /// How the block moves on what it touches of blocks that rest.
    fn describe(&self, names: Names, touches: &[Touch]) -> MovingBlock {
        let direction = self.shift.try_normalize(0.0).unwrap_or_default();
        let mut shares = planes(names, touches, self.block);
        shares.retain(|(_, plane)| direction.dot(&Vec3::from(plane.normal)).abs() < ALONG);
        let line_of = |a: &Plane, b: &Plane| Vec3::from(a.normal).cross(&Vec3::from(b.normal)).normalize();
        let is_wedge = match shares.as_slice() {
            [(_, a), (_, b)] => direction.dot(&line_of(a, b)).abs() > SAME_LINE,
            _ => false,
        };
        shares.retain(|(share, _)| is_wedge || *share > LITTLE);
        let planes: Vec<Plane> = shares.into_iter().map(|(_, plane)| plane).collect();
        // A block that turns in its plane stays on it.
        let within = match planes.as_slice() {
            [plane] => self.turn.dot(&Vec3::from(plane.normal)) * Vec3::from(plane.normal),
            _ => Vec3::zeros(),
        };
        let kind = match planes.as_slice() {
            _ if self.is_large(self.turn - within) => Kind::Toppling,
            _ if !touches.iter().any(|touch| touch.block == self.block) => Kind::Falling,
            [_] => Kind::Sliding,
            [a, b] if direction.dot(&line_of(a, b)).abs() > SAME_PLANE => Kind::Wedge,
            _ => Kind::Mixed,
        };
        MovingBlock {
            name: names.0[self.block.index()].clone(),
            kind,
            direction: direction.into(),
            gone_m: self.gone_m,
            turned_deg: self.turn.map(f64::to_degrees).into(),
            turns_in_its_plane: kind == Kind::Sliding && self.is_large(within),
            planes,
        }
    }
}

/// A contact, from the side of one of its blocks.
struct Touch {
    block: BlockId,
    other: BlockId,
    /// Into the block.
    normal: Vec3,
    push_n: f64,
    /// Number of the surface that the contact is on.
    surface: Option<u32>,
}

/// All contacts that press, from both sides.
fn touches(simulation: &Simulation) -> Vec<Touch> {
    let blocks = simulation.blocks();
    let contacts = simulation.contacts().iter().filter(|contact| contact.push_n != Vec3::zeros());
    let sides = contacts.flat_map(|contact| {
        let owner = blocks.block_of(blocks.triangles[contact.facet.index()][0]);
        let surface = blocks.triangle_surface[contact.facet.index()];
        let side =
            |block, other, normal| Touch { block, other, normal, push_n: contact.push_n.norm(), surface };
        [side(owner, contact.target, -contact.normal), side(contact.target, owner, contact.normal)]
    });
    sides.collect()
}

/// Normals into each free block of the faces of fixed ones that it rests on.
pub fn normals(simulation: &Simulation) -> Vec<Vec<Vec3>> {
    let blocks = free(simulation).collect::<Vec<_>>();
    let mut touches = touches(simulation);
    touches.retain(|touch| !blocks.contains(&touch.other));
    blocks.iter().map(|block| normals_among(simulation, &touches, *block)).collect()
}

/// Normals into a block of the faces that others press it at.
pub(super) fn normals_of(simulation: &Simulation, block: BlockId) -> Vec<Vec3> {
    normals_among(simulation, &touches(simulation), block)
}

fn normals_among(simulation: &Simulation, touches: &[Touch], block: BlockId) -> Vec<Vec3> {
    let blocks = simulation.blocks();
    let planes = planes((&blocks.names, &blocks.surface_names), touches, block);
    let pressed = planes.into_iter().filter(|(share, _)| *share > LITTLE);
    pressed.map(|(_, plane)| Vec3::from(plane.normal)).collect()
}

/// Planes at which a block is pressed, with their part of all force, those of the largest first.
fn planes((blocks, surfaces): Names, touches: &[Touch], block: BlockId) -> Vec<(f64, Plane)> {
    let mut found: Vec<(f64, Vec3, BlockId, Option<u32>)> = Vec::new();
    for touch in touches.iter().filter(|touch| touch.block == block) {
        match found.iter_mut().find(|(_, known, ..)| known.normalize().dot(&touch.normal) > SAME_PLANE) {
            Some(plane) => {
                plane.0 += touch.push_n;
                plane.1 += touch.push_n * touch.normal;
            }
            None => found.push((touch.push_n, touch.push_n * touch.normal, touch.other, touch.surface)),
        }
    }
    let all_n: f64 = found.iter().map(|plane| plane.0).sum();
    found.retain(|plane| plane.0 > HARDLY * all_n);
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let joint = |surface: Option<u32>| surface.map(|surface| surfaces[surface as usize].clone());
    found
        .into_iter()
        .map(|(push_n, normal, other, surface)| {
            (push_n / all_n, plane(&normal.normalize(), &blocks[other.index()], joint(surface)))
        })
        .collect()
}

fn plane(normal: &Vec3, on: &str, joint: Option<String>) -> Plane {
    let upward = if normal.z < 0.0 { -normal } else { *normal };
    let direction = upward.x.atan2(upward.y).to_degrees();
    Plane {
        joint,
        on: on.to_string(),
        dip_deg: upward.z.clamp(-1.0, 1.0).acos().to_degrees(),
        dip_direction_deg: if direction < 0.0 { direction + 360.0 } else { direction },
        normal: (*normal).into(),
    }
}

/// The motion of blocks, each kind with its count, and the planes of the first.
fn words(blocks: &[MovingBlock]) -> String {
    let first = &blocks[0];
    let planes: Vec<String> = first.planes.iter().map(ToString::to_string).collect();
    let how = match first.kind {
        Kind::Sliding if first.turns_in_its_plane => {
            format!("sliding on {}, turning in its plane", planes.join(" and "))
        }
        Kind::Sliding => format!("sliding on {}", planes.join(" and ")),
        Kind::Wedge => format!("wedge sliding along the line of {}", planes.join(" and ")),
        kind => kind.to_string(),
    };
    let mut words = format!("`{}`: {how}", first.name);
    let mut kinds: Vec<Kind> = blocks[1..].iter().map(|block| block.kind).collect();
    kinds.sort_unstable();
    let counted = kinds.chunk_by(|a, b| a == b).map(|same| format!("{} {}", same.len(), same[0]));
    let others: Vec<String> = counted.collect();
    if !others.is_empty() {
        words.push_str(&format!("; with it {}", others.join(", ")));
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block that rests on planes of these normals and pushes, each a joint, and that has moved and turned so.
    fn described(planes: &[(Vec3, f64)], shift: Vec3, turn: Vec3) -> MovingBlock {
        let blocks = ["rest", "slope"].map(String::from);
        let joints: Vec<String> = (1..=planes.len()).map(|k| format!("J{k}")).collect();
        let (other, block) = (BlockId(0), BlockId(1));
        let touch = |(k, (normal, push_n)): (usize, &(Vec3, f64))| Touch {
            block,
            other,
            normal: normal.normalize(),
            push_n: *push_n,
            surface: Some(k as u32),
        };
        let touches: Vec<Touch> = planes.iter().enumerate().map(touch).collect();
        Motion { block, gone_m: shift.norm(), shift, turn, radius_m: 3.0 }
            .describe((&blocks, &joints), &touches)
    }

    #[test]
    fn a_block_that_turns_about_the_normal_of_its_plane_slides_and_one_that_turns_about_its_edge_topples() {
        let (normal, down) = (Vec3::new(1.0, 0.0, 1.0), Vec3::new(1.0, 0.0, -1.0));
        let turning = described(&[(normal, 1e5)], 0.01 * down, 0.1 * normal);
        assert_eq!(turning.kind, Kind::Sliding);
        assert_eq!(words(&[turning]), "`slope`: sliding on joint `J1` (45.0°/90.0°), turning in its plane");
        let straight = described(&[(normal, 1e5)], 0.1 * down, 1e-4 * normal);
        assert_eq!(words(&[straight]), "`slope`: sliding on joint `J1` (45.0°/90.0°)");
        assert_eq!(described(&[(normal, 1e5)], 0.01 * down, 0.1 * Vec3::y()).kind, Kind::Toppling);
    }

    #[test]
    fn a_level_plane_has_no_dip_direction() {
        let sliding = described(&[(Vec3::new(1e-5, 0.0, 1.0), 1e5)], Vec3::x(), Vec3::zeros());
        assert_eq!(words(&[sliding]), "`slope`: sliding on joint `J1` (level)");
    }

    #[test]
    fn a_block_that_two_planes_press_slides_along_their_line() {
        let (a, b) = (Vec3::new(1.0, 1.0, 2.0), Vec3::new(1.0, -1.0, 2.0));
        let line = Vec3::new(2.0, 0.0, -1.0);
        let pressed = |push_n: f64| described(&[(a, 1e6), (b, push_n)], 0.1 * line, Vec3::zeros());
        assert_eq!(pressed(1e5).kind, Kind::Wedge);
        assert!(words(&[pressed(1e5)]).starts_with("`slope`: wedge sliding along the line of joint `J1`"));
        // 1 % of all force counts where the block moves along the line, but not where it leaves that, and next to nothing does not count.
        assert_eq!((pressed(1e4).kind, pressed(1e3).kind), (Kind::Wedge, Kind::Sliding));
        let beside = line + 0.1 * Vec3::y();
        assert_eq!(described(&[(a, 1e6), (b, 1e4)], beside, Vec3::zeros()).kind, Kind::Sliding);
        assert_eq!(described(&[], 0.1 * line, Vec3::zeros()).kind, Kind::Falling);
    }
}
