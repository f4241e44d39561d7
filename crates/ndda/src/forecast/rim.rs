//! Blocks that may leave a model through its rim: a side or the bottom of the rock's domain, beyond which there is rock in nature.
//!
//! Which way a block goes follows from the faces on which it touches others, as in the theory of key blocks (Warburton 1981): of all
//! directions into which none of them keeps it from moving, the one that is nearest to that of gravity. It is gravity itself, its
//! projection on one face, or the line of two.

use std::collections::BTreeSet;

use ndda_io::scene::{Axis, Domain, Rock, Scene, matches};
use ndda_mesh::geometry::{Aabb, triangle_area_vector};
use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::build;
use crate::build::overlaps::is_in_solid;

/// Cosine between a direction of motion and the normal of the rim beyond which a block leaves through it, and does not slide along it.
const OUT: f64 = 0.2;
/// Cosine below which a direction of motion runs along a face.
const ALONG: f64 = 0.02;
/// Cosine between a direction of motion and gravity below which friction holds nearly any rock: its way dips less than 14.5°.
const DOWN: f64 = 0.25;
/// A face of a box whose normal makes less than this cosine's angle with the vertical, upwards, is the surface of the ground.
const UPWARD: f64 = 0.5;
/// Faces whose normals agree to this part are one.
const SAME: f64 = 1e-6;
/// Points that look for a neighbour are so far from a face, over the size of its triangle.
const AHEAD: f64 = 1e-4;
/// Blocks that a warning names.
const MOST_NAMES: usize = 3;

/// What helps.
pub const CURE: &str = "check dips and dip directions; else make the domain larger, or hold what is at its rim (rock `fixed: […]`, supports)";

/// Per rock with blocks that may leave through its rim: its index, and which blocks they are.
pub fn leaving(scene: &Scene, blocks: &BlockSet) -> Vec<(usize, String)> {
    let gravity = Vec3::from(scene.gravity_m_s2);
    if gravity == Vec3::zeros() {
        return Vec::new();
    }
    let down = gravity.normalize();
    let rims = scene.rock.iter().enumerate().filter_map(|(i, rock)| Some((i, rock, rim_of(rock, &down)?)));
    let mut found = Vec::new();
    for (i, rock, rim) in rims {
        let surroundings = Surroundings::new(blocks);
        let moving = build::moving(scene, blocks);
        let leaves = |block: BlockId| {
            let name = &blocks.names[block.index()];
            let is_free = moving[block.index()].is_some() && !is_supported(scene, name);
            if is_free && rock.makes(name) { surroundings.leaves(block, &rim, &down) } else { None }
        };
        let out: Vec<(BlockId, &str)> = blocks.ids().filter_map(|b| Some((b, leaves(b)?))).collect();
        if let Some(message) = words(blocks, &out) {
            found.push((i, message));
        }
    }
    found
}

fn words(blocks: &BlockSet, out: &[(BlockId, &str)]) -> Option<String> {
    let (_, side) = out.first()?;
    let name = |(block, _): &(BlockId, &str)| format!("`{}`", blocks.names[block.index()]);
    let named: Vec<String> = out.iter().take(MOST_NAMES).map(name).collect();
    let others = out.len() - named.len();
    let named = match others {
        0 => named.join(", "),
        _ => format!("{} and {others} more", named.join(", ")),
    };
    let (noun, verb, is) =
        if out.len() == 1 { ("block", "reaches", "is") } else { ("blocks", "reach", "are") };
    Some(format!(
        "{noun} {named} {verb} the side `{side}` of the model and {is} not held there, and may slide or fall out, though in nature there is rock beyond"
    ))
}

/// Faces of the rim that cut off blocks which move, each in a direction: the rock that they belong to goes on beyond. A slice between two
/// parallel faces, along which it moves, stands for all of them and is left out.
pub fn cut_off(scene: &Scene, blocks: &BlockSet, moving: &[(BlockId, Vec3)]) -> BTreeSet<&'static str> {
    let gravity = Vec3::from(scene.gravity_m_s2);
    let down = if gravity == Vec3::zeros() { -Vec3::z() } else { gravity.normalize() };
    let mut found = BTreeSet::new();
    for rock in &scene.rock {
        let Some(rim) = rim_of(rock, &down) else { continue };
        for (block, way) in moving.iter().filter(|(block, _)| rock.makes(&blocks.names[block.index()])) {
            let on_rim = |triangle: usize| {
                let corners = blocks.triangles[triangle].map(|n| blocks.rest_position[n.index()]);
                Some((rim_at(blocks, &rim, triangle)?, triangle_area_vector(&corners).normalize()))
            };
            let cut: Vec<(&str, Vec3)> = blocks.triangles_of(*block).filter_map(on_rim).collect();
            let is_slice = |normal: &Vec3| {
                way.dot(normal).abs() < ALONG && cut.iter().any(|(_, other)| (other + normal).norm() < SAME)
            };
            found.extend(cut.iter().filter(|(_, normal)| !is_slice(normal)).map(|(name, _)| *name));
        }
    }
    found
}

/// Name of the face of the rim that a triangle lies in.
fn rim_at(blocks: &BlockSet, rim: &[&'static str], triangle: usize) -> Option<&'static str> {
    let name = &blocks.surface_names[blocks.triangle_surface[triangle]? as usize];
    rim.iter().find(|known| *known == name).copied()
}

/// Whether supports, quiet boundaries or ties hold a block.
fn is_supported(scene: &Scene, block: &str) -> bool {
    let supports = scene.supports.iter().map(|support| &support.block);
    let others = scene.quiet.iter().map(|quiet| &quiet.block).chain(scene.ties.iter().map(|tie| &tie.block));
    supports.chain(others).any(|pattern| matches(pattern, block))
}

/// Names of the faces of a rock's domain that are cuts through rock and no ground; none where that is not known.
///
/// A part of the rock has to be fixed: else it stands free, as a column does. Of a box, a part has to be taken out: else its sides may be
/// the face of a slope.
fn rim_of(rock: &Rock, down: &Vec3) -> Option<Vec<&'static str>> {
    let carved = !rock.removed.is_empty() || !rock.excavations.is_empty();
    if rock.fixed.is_empty() {
        return None;
    }
    match &rock.domain {
        Domain::Box { .. } if carved => {
            let faces = [
                ("x_min", -Vec3::x()),
                ("x_max", Vec3::x()),
                ("y_min", -Vec3::y()),
                ("y_max", Vec3::y()),
                ("z_min", -Vec3::z()),
                ("z_max", Vec3::z()),
            ];
            let is_rim = |(_, normal): &(&str, Vec3)| normal.dot(down) > -UPWARD;
            Some(faces.into_iter().filter(is_rim).map(|(name, _)| name).collect())
        }
        Domain::Column { axis, .. } => {
            let along = match axis {
                Axis::X => Vec3::x(),
                Axis::Y => Vec3::y(),
                Axis::Z => Vec3::z(),
            };
            (along.dot(down).abs() < UPWARD).then(|| vec!["start", "end"])
        }
        Domain::Terrain { .. } | Domain::TerrainFile { .. } => Some(vec!["side", "base"]),
        Domain::Box { .. } | Domain::Polyhedron { .. } | Domain::File { .. } => None,
    }
}

/// All blocks, to ask what is at a place.
struct Surroundings<'a> {
    blocks: &'a BlockSet,
    /// Bounds of each, by their lowest x.
    bounds: Vec<(Aabb, BlockId)>,
    /// The largest extent of one along x [m].
    widest_m: f64,
}

impl<'a> Surroundings<'a> {
    fn new(blocks: &'a BlockSet) -> Self {
        let around = |block| (Aabb::around(&blocks.rest_position[blocks.nodes_of(block)]), block);
        let mut bounds: Vec<(Aabb, BlockId)> = blocks.ids().map(around).collect();
        bounds.sort_by(|a, b| a.0.min.x.total_cmp(&b.0.min.x));
        let widest_m = bounds.iter().map(|(b, _)| b.max.x - b.min.x).fold(0.0, f64::max);
        Self { blocks, bounds, widest_m }
    }

    /// Whether another block than this one is at a place.
    fn has_other(&self, block: BlockId, x: &Vec3) -> bool {
        let first = self.bounds.partition_point(|(b, _)| b.min.x < x.x - self.widest_m);
        let there = self.bounds[first..].iter().take_while(|(b, _)| b.min.x <= x.x);
        let mut there = there
            .filter(|(b, other)| *other != block && (0..3).all(|i| b.min[i] <= x[i] && x[i] <= b.max[i]));
        there.any(|(_, other)| is_in_solid(self.blocks, &self.blocks.rest_position, *other, x))
    }

    /// Whether another block touches a triangle of this one, at its centroid or near a corner.
    fn is_covered(&self, block: BlockId, corners: &[Vec3; 3], normal: &Vec3) -> bool {
        let size_m = Aabb::around(corners).diagonal();
        let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
        let near = corners.iter().map(|corner| 0.7 * corner + 0.3 * centroid);
        near.chain([centroid]).any(|x| self.has_other(block, &(x + AHEAD * size_m * normal)))
    }

    /// The face of the rim through which a block may leave.
    fn leaves(&self, block: BlockId, rim: &[&'static str], down: &Vec3) -> Option<&'static str> {
        let blocks = self.blocks;
        let rim_at = |triangle: usize| rim_at(blocks, rim, triangle);
        let triangles = blocks.triangles_of(block);
        if !triangles.clone().any(|triangle| rim_at(triangle).is_some()) {
            return None;
        }
        let (mut touching, mut open): (Vec<Vec3>, Vec<(Vec3, &str)>) = (Vec::new(), Vec::new());
        for triangle in triangles {
            let corners = blocks.triangles[triangle].map(|n| blocks.rest_position[n.index()]);
            let normal = triangle_area_vector(&corners).normalize();
            if self.is_covered(block, &corners, &normal) {
                if !touching.iter().any(|known| (known - normal).norm() < SAME) {
                    touching.push(normal);
                }
            } else if let Some(name) = rim_at(triangle) {
                open.push((normal, name));
            }
        }
        let way = descent(&touching, down)?;
        open.into_iter().find(|(normal, _)| way.dot(normal) > OUT).map(|(_, name)| name)
    }
}

/// The direction nearest to `down` in which no outward normal of a touched face is entered; none where that is so flat that friction holds.
fn descent(touching: &[Vec3], down: &Vec3) -> Option<Vec3> {
    let mut ways = vec![*down];
    for (i, n) in touching.iter().enumerate() {
        ways.push(down - down.dot(n) * n);
        ways.extend(touching[..i].iter().map(|m| {
            let line = n.cross(m);
            line.dot(down) * line
        }));
    }
    let is_free = |way: &Vec3| touching.iter().all(|n| way.dot(n) <= SAME);
    let ways = ways.into_iter().filter(|way| way.norm() > SAME).map(|way| way.normalize()).filter(is_free);
    let best = ways.max_by(|a, b| a.dot(down).total_cmp(&b.dot(down)))?;
    (best.dot(down) > DOWN).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    #[test]
    fn a_block_goes_down_its_steepest_free_way() {
        let down = -Vec3::z();
        assert_eq!(descent(&[], &down), Some(down));
        // On a plane of 30° that dips to the east: down it.
        let plane = Vec3::new(-0.5, 0.0, -(0.75f64.sqrt()));
        let way = descent(&[plane], &down).unwrap();
        assert!((way - Vec3::new(0.75f64.sqrt(), 0.0, -0.5)).norm() < 1e-12, "{way}");
        // A wall below it leaves the line of both, which is level.
        assert_eq!(descent(&[plane, Vec3::x()], &down), None);
        // A wall that it can slide along.
        let way = descent(&[plane, Vec3::y()], &down).unwrap();
        assert!((way - Vec3::new(0.75f64.sqrt(), 0.0, -0.5)).norm() < 1e-12, "{way}");
    }

    /// Warnings of a slope that dips 65° to the south-east, with two joints through the line where they come out of it.
    fn warned(dips: [(f64, f64); 2]) -> Vec<String> {
        let normal = |dip: f64, direction: f64, sign: f64| {
            let (dip, direction) = (dip.to_radians(), direction.to_radians());
            let n = sign * Vec3::new(dip.sin() * direction.sin(), dip.sin() * direction.cos(), dip.cos());
            format!("Beyond(point_m: (0, 0, 0), normal: ({}, {}, {}))", n.x, n.y, n.z)
        };
        let plane = |name: &str, (dip, direction): (f64, f64)| {
            format!(
                "Plane(name: \"{name}\", dip_deg: {dip}, dip_direction_deg: {direction}, point_m: (0, 0, 0)),"
            )
        };
        let face = (65.0, 156.0);
        let [one, two] = dips;
        let text = format!(
            "(title: \"wedge\", time: (step_s: 1e-4, end_s: 1e-3), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            rock: [(name: \"slope\", material: \"rock\", body: Rigid,
                domain: Box(min_m: (-20, -20, -4), max_m: (20, 20, 8)), joints: [{}{}{}],
                removed: [{}], fixed: [{}, {}])],
            contact: Potential(penalty_pa: 1e8, potential: Smooth(), friction: (friction_deg: 30)))",
            plane("face", face),
            plane("J1", one),
            plane("J2", two),
            normal(face.0, face.1, 1.0),
            normal(one.0, one.1, -1.0),
            normal(two.0, two.1, -1.0),
        );
        let model = Model::from_text(&text).unwrap();
        leaving(&model.loaded.scene, model.simulation.blocks())
            .into_iter()
            .map(|(_, message)| message)
            .collect()
    }

    #[test]
    fn a_side_cuts_off_what_moves_unless_it_is_a_slice() {
        let text = "(title: \"slice\", time: (step_s: 1e-4, end_s: 1e-3), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            rock: [(name: \"slope\", material: \"rock\", body: Rigid,
                domain: Box(min_m: (0, 0, 0), max_m: (4, 1, 4)),
                joints: [Plane(name: \"J\", dip_deg: 45, dip_direction_deg: 90, point_m: (2, 0, 2))],
                removed: [Inside(min_m: (3, 0, 3), max_m: (3.1, 1, 3.1))],
                fixed: [Inside(min_m: (0, 0, 0), max_m: (2, 1, 2))])],
            contact: Potential(penalty_pa: 1e8, potential: Smooth(), friction: (friction_deg: 30)))";
        let model = Model::from_text(text).unwrap();
        let blocks = model.simulation.blocks();
        let upper = blocks.ids().max_by(|a, b| {
            let x = |block: &BlockId| {
                blocks.rest_position[blocks.nodes_of(*block)].iter().map(|x| x.z).sum::<f64>()
            };
            x(a).total_cmp(&x(b))
        });
        let sides = |way: Vec3| {
            let found = cut_off(&model.loaded.scene, blocks, &[(upper.unwrap(), way.normalize())]);
            found.into_iter().collect::<Vec<_>>().join(", ")
        };
        assert_eq!(sides(Vec3::new(1.0, 0.0, -1.0)), "x_max");
        assert_eq!(sides(Vec3::new(1.0, 0.5, -1.0)), "x_max, y_max, y_min");
    }

    #[test]
    fn a_wedge_that_leaves_through_a_side_of_the_box_is_named_and_one_that_leaves_through_the_face_is_not() {
        assert_eq!(warned([(40.0, 130.0), (60.0, 220.0)]), Vec::<String>::new());
        let turned = warned([(40.0, 310.0), (60.0, 220.0)]);
        assert!(turned.len() == 1 && turned[0].contains("of the model and is not held there"), "{turned:?}");
    }
}
