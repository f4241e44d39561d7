//! How blocks fail: which of them move, along which planes, or by toppling or falling.

use std::fmt;

use ndda_contact::FacetContact;
use ndda_mesh::{BlockId, NodeId, Vec3};
use ndda_solver::Simulation;
use serde::{Deserialize, Serialize};

use super::free_blocks::{free, gone_m};
use crate::Model;
use crate::forecast::rim;
use crate::run::motion;

/// A block moves if it has gone farther than this part of the farthest.
const MOVES: f64 = 0.2;
/// It topples if a point of it goes farther by rotation than this part of what its mass centre does.
const TOPPLES: f64 = 0.5;
/// Cosine between normals of one plane.
const SAME_PLANE: f64 = 0.985;
/// Part of all contact force below which a plane does not count.
const LITTLE: f64 = 0.05;
/// Sine of the angle by which a direction may leave a plane that a block slides on.
const ALONG: f64 = 0.2;

/// How a block fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// It slides on one plane.
    Sliding,
    /// It slides on two planes along their line of intersection.
    Wedge,
    /// It turns over.
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
        write!(f, " ({:.1}°/{:.1}°)", self.dip_deg, self.dip_direction_deg)
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
}

/// The blocks that move, the farthest first, and what they do together; `start` is where nodes were [m].
pub fn of(model: &Model, start: &[Vec3]) -> (Option<Mechanism>, Vec<MovingBlock>) {
    let simulation = &model.simulation;
    let mut gone = gone_m(simulation, start);
    gone.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let Some(farthest_m) = gone.first().map(|first| first.1).filter(|gone| *gone > 0.0) else {
        return (None, Vec::new());
    };
    gone.retain(|(_, gone)| *gone > MOVES * farthest_m);
    let moving: Vec<BlockId> = gone.iter().map(|(block, _)| *block).collect();
    let describe =
        |&(block, gone_m): &(BlockId, f64)| moving_block(simulation, start, &moving, block, gone_m);
    let blocks: Vec<MovingBlock> = gone.iter().map(describe).collect();
    let words = words(&blocks);
    let ways = moving.iter().zip(&blocks).map(|(block, moving)| (*block, Vec3::from(moving.direction)));
    let ways: Vec<(BlockId, Vec3)> = ways.collect();
    let sides = rim::cut_off(&model.loaded.scene, simulation.blocks(), &ways);
    let cut_off_by = sides.into_iter().map(String::from).collect();
    (Some(Mechanism { kind: blocks[0].kind, words, cut_off_by }), blocks)
}

fn moving_block(
    simulation: &Simulation,
    start: &[Vec3],
    moving: &[BlockId],
    block: BlockId,
    gone_m: f64,
) -> MovingBlock {
    let blocks = simulation.blocks();
    let shift = motion::shift_m(simulation, start, block);
    let direction = if shift == Vec3::zeros() { shift } else { shift.normalize() };
    let radius_m = motion::radius_m(&simulation.shape(block).operator);
    let turned_m = radius_m * motion::turn_deg(simulation, start, block).to_radians();
    let planes: Vec<Plane> = planes(simulation, moving, block)
        .into_iter()
        .filter(|plane| direction.dot(&Vec3::from(plane.normal)).abs() < ALONG)
        .collect();
    let touches = supports(simulation, moving, block).next().is_some();
    let kind = match planes.as_slice() {
        _ if turned_m > TOPPLES * shift.norm() => Kind::Toppling,
        _ if !touches => Kind::Falling,
        [_] => Kind::Sliding,
        [a, b] => {
            let line = Vec3::from(a.normal).cross(&Vec3::from(b.normal)).normalize();
            if direction.dot(&line).abs() > SAME_PLANE { Kind::Wedge } else { Kind::Mixed }
        }
        _ => Kind::Mixed,
    };
    MovingBlock {
        name: blocks.names[block.index()].clone(),
        kind,
        direction: direction.into(),
        gone_m,
        planes,
    }
}

/// Contacts of a block with blocks that rest: each with the other block and the normal from that into the block.
fn supports<'a>(
    simulation: &'a Simulation,
    moving: &'a [BlockId],
    block: BlockId,
) -> impl Iterator<Item = (&'a FacetContact, BlockId, Vec3)> {
    let blocks = simulation.blocks();
    simulation.contacts().iter().filter_map(move |contact| {
        let node: NodeId = blocks.triangles[contact.facet.index()][0];
        let owner = blocks.block_of(node);
        let (other, normal) = match (owner == block, contact.target == block) {
            (true, _) => (contact.target, -contact.normal),
            (_, true) => (owner, contact.normal),
            _ => return None,
        };
        let rests = !moving.contains(&other) && contact.push_n != Vec3::zeros();
        rests.then_some((contact, other, normal))
    })
}

/// Normals into free blocks of the faces that they rest on.
pub fn normals(simulation: &Simulation) -> Vec<Vec3> {
    let free: Vec<BlockId> = free(simulation).collect();
    let normals = |&block: &BlockId| {
        let planes = planes(simulation, &free, block);
        planes.into_iter().map(|plane| Vec3::from(plane.normal)).collect::<Vec<_>>()
    };
    free.iter().flat_map(normals).collect()
}

/// Planes on which a block rests on blocks that do not move, those of the largest forces first.
fn planes(simulation: &Simulation, moving: &[BlockId], block: BlockId) -> Vec<Plane> {
    let blocks = simulation.blocks();
    let mut found: Vec<(f64, Vec3, BlockId, Option<String>)> = Vec::new();
    for (contact, other, normal) in supports(simulation, moving, block) {
        let push_n = contact.push_n.norm();
        match found.iter_mut().find(|(_, known, ..)| known.normalize().dot(&normal) > SAME_PLANE) {
            Some(plane) => {
                plane.0 += push_n;
                plane.1 += push_n * normal;
            }
            None => {
                let surface = blocks.triangle_surface[contact.facet.index()];
                let joint = surface.map(|surface| blocks.surface_names[surface as usize].clone());
                found.push((push_n, push_n * normal, other, joint));
            }
        }
    }
    let all_n: f64 = found.iter().map(|plane| plane.0).sum();
    found.retain(|plane| plane.0 > LITTLE * all_n);
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
        .into_iter()
        .map(|(_, normal, other, joint)| plane(&normal.normalize(), &blocks.names[other.index()], joint))
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
