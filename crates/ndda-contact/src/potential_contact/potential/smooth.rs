//! The potential that grows with depth below the block's surface.

use ndda_mesh::geometry::{Aabb, distance_to_triangle};
use ndda_mesh::{BlockId, BlockSet, NodeId, TetId, Vec3};
use parry3d_f64::bounding_volume::Aabb as ParryAabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use rayon::prelude::*;

use crate::affine::surface::{BlockFaces, Plane};
use crate::potential::contact_potential::{ContactPotential, PotentialError, PotentialField};
use crate::potential::piece_table::{MOST_PIECES, PieceTable};

/// Depths closer than this fraction of the block's largest are the same: by rounding, they differ with how it is turned.
const SAME_DEPTH: f64 = 1e-11;

/// Nodes per task of a thread.
const NODES_OF_TASK: usize = 256;

/// φ = depth / L₀, depth being the distance to the nearest face of the block in its rest shape; it moves and
/// stretches with the block's nodes.
///
/// After the smooth potential of Lei, Rougier, Euser & Munjiza (2020) and the distance potential of Zhao (2018). In
/// a convex block the depth below each face is interpolated from the nodes and the least of them counts, which is
/// exact in the rest shape whatever the mesh: the stiffness is k_n/L₀ per area on either side, deep blocks are pushed
/// out, and nothing changes where a contact crosses the border of two elements. In a concave block the distance to
/// the surface is itself interpolated from the nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothPotential {
    /// L₀ [m]: k_n is the pressure at this depth.
    pub reference_m: f64,
}

impl ContactPotential for SmoothPotential {
    fn name(&self) -> &'static str {
        "Smooth"
    }

    fn phi_per_m(&self) -> Option<f64> {
        Some(1.0 / self.reference_m)
    }

    fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
        let mut table = PieceTable::new();
        for block in blocks.ids() {
            let faces = BlockFaces::new(blocks, block);
            if faces.convex {
                self.add_convex(blocks, block, &faces.planes, &mut table)?;
            } else {
                self.add_concave(blocks, block, &mut table)?;
            }
        }
        Ok(PotentialField::Pieces(table))
    }
}

impl SmoothPotential {
    fn add_convex(
        &self,
        blocks: &BlockSet,
        block: BlockId,
        planes: &[Plane],
        table: &mut PieceTable,
    ) -> Result<(), PotentialError> {
        let (mut pieces, mut kept) = (Vec::new(), Vec::new());
        let deepest = blocks.nodes_of(block).map(|n| blocks.rest_position[n]);
        let deepest = deepest.flat_map(|x| planes.iter().map(move |plane| plane.depth_m(&x)));
        let same = SAME_DEPTH * deepest.fold(0.0, f64::max) / self.reference_m;
        for tet in blocks.tets_of(block) {
            let corners = blocks.tets[tet].map(|n| blocks.rest_position[n.index()]);
            let depth = |plane: &Plane| {
                corners.map(|x| plane.depth_m(&x) / self.reference_m).map(|d| if d > same { d } else { 0.0 })
            };
            // A function that is nowhere below another's largest value is never the smallest.
            let largest = |piece: &[f64; 4]| piece.iter().copied().fold(0.0, f64::max);
            let enough = planes.iter().map(|plane| largest(&depth(plane))).fold(f64::INFINITY, f64::min);
            pieces.clear();
            pieces.extend(planes.iter().map(depth).filter(|piece| piece.iter().any(|&d| d <= enough + same)));
            keep_the_smallest(&pieces, same, &mut kept);
            if kept.len() > MOST_PIECES {
                let (block, tet) = (blocks.names[block.index()].clone(), TetId(tet as u32));
                return Err(PotentialError::TooManyFaces { block, tet, faces: kept.len() });
            }
            table.push(&kept);
        }
        Ok(())
    }

    fn add_concave(
        &self,
        blocks: &BlockSet,
        block: BlockId,
        table: &mut PieceTable,
    ) -> Result<(), PotentialError> {
        let depth = depth_of_nodes(blocks, block);
        let first = blocks.nodes_of(block).start;
        for tet in blocks.tets_of(block) {
            let values = blocks.tets[tet].map(|n| depth[n.index() - first] / self.reference_m);
            if values.iter().all(|&d| d == 0.0) {
                let block = blocks.names[block.index()].clone();
                return Err(PotentialError::NoInteriorNode { block, tet: TetId(tet as u32) });
            }
            table.push(&[values]);
        }
        Ok(())
    }
}

/// Drops functions that another is nowhere above, but for rounding: they are never the only smallest.
fn keep_the_smallest(pieces: &[[f64; 4]], same: f64, kept: &mut Vec<[f64; 4]>) {
    kept.clear();
    let below = |o: &[f64; 4], p: &[f64; 4]| o.iter().zip(p).all(|(o, p)| *o <= p + same);
    for (k, piece) in pieces.iter().enumerate() {
        // Of two that are the same the former is kept.
        let beaten = kept.iter().any(|other| below(other, piece))
            || pieces[k + 1..].iter().any(|other| below(other, piece) && !below(piece, other));
        if !beaten {
            kept.push(*piece);
        }
    }
}

fn vector(x: &Vec3) -> Vector {
    Vector::new(x.x, x.y, x.z)
}

/// Distance of each node of a block to its surface in the rest shape [m]; exactly zero for nodes of the surface.
fn depth_of_nodes(blocks: &BlockSet, block: BlockId) -> Vec<f64> {
    let range = blocks.nodes_of(block);
    let mut on_surface = vec![false; range.len()];
    let triangles = || blocks.triangles_of(block).map(|t| blocks.triangles[t]);
    triangles().flatten().for_each(|n| on_surface[n.index() - range.start] = true);
    let corners = |triangle: [NodeId; 3]| triangle.map(|n| blocks.rest_position[n.index()]);
    let boxes = triangles().map(|triangle| {
        let Aabb { min, max } = Aabb::around(&corners(triangle));
        ParryAabb::new(vector(&min), vector(&max))
    });
    let tree = Bvh::from_iter(BvhBuildStrategy::Binned, boxes.enumerate());
    let first = blocks.triangles_of(block).start;
    let distance = |x: &Vec3| {
        let to_box = |node: &BvhNode, _| {
            let at = vector(x);
            // Rounding must not hide a triangle behind its box.
            (1.0 - 1e-9) * (at - at.max(node.mins()).min(node.maxs())).length()
        };
        let to =
            |leaf: u32, _| Some(distance_to_triangle(x, &corners(blocks.triangles[first + leaf as usize])));
        tree.find_best(f64::MAX, to_box, to).map_or(f64::INFINITY, |(_, distance)| distance)
    };
    let nodes = blocks.rest_position[range.clone()].par_iter().with_min_len(NODES_OF_TASK);
    nodes.zip(&on_surface).map(|(x, &on)| if on { 0.0 } else { distance(x) }).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_block_of_too_many_faces_is_told_what_works() {
        let sphere = |levels| ndda_mesh::generate::sphere(1.0, levels).expect("a sphere");
        let field = |potential: &dyn ContactPotential, levels| {
            potential.field(&crate::testing::test_set(vec![sphere(levels)])).map(|_| ())
        };
        let smooth = SmoothPotential { reference_m: 1.0 };
        let faces = |levels| match field(&smooth, levels) {
            Err(PotentialError::TooManyFaces { faces, .. }) => faces,
            other => panic!("{other:?}"),
        };
        assert!(faces(3) > faces(2), "a finer surface has more faces");
        let message = field(&smooth, 2).expect_err("too many faces").to_string();
        assert!(["`Element`", "`Volume`", "fewer faces"].iter().all(|word| message.contains(word)));
        let volume = crate::VolumePotential { exponent: 2.0, reference_m3: 1.0 };
        assert!(field(&smooth, 1).is_ok(), "fewer faces");
        assert!(field(&crate::ElementPotential, 2).is_ok() && field(&volume, 2).is_ok());
    }

    use super::*;
    use crate::potential::testing::check_potential;
    use crate::testing::{test_box, test_set};

    #[test]
    fn it_keeps_the_contract_of_a_potential() {
        check_potential(&SmoothPotential { reference_m: 1.0 });
    }

    #[test]
    fn in_a_box_it_is_the_distance_to_the_nearest_face_whatever_the_mesh() {
        for cells in [[1, 1, 1], [2, 3, 1]] {
            let blocks = test_set(vec![test_box([0.0; 3], [1.0, 2.0, 3.0], cells)]);
            let Ok(PotentialField::Pieces(table)) = (SmoothPotential { reference_m: 0.5 }).field(&blocks)
            else {
                panic!("a box has a smooth potential")
            };
            for tet in 0..blocks.tets.len() {
                let corners = blocks.tets[tet].map(|n| blocks.rest_position[n.index()]);
                for weights in [[0.25; 4], [0.7, 0.1, 0.1, 0.1], [0.05, 0.05, 0.3, 0.6]] {
                    let x: Vec3 = (0..4).map(|b| weights[b] * corners[b]).sum();
                    let value = |piece: &[f64; 4]| (0..4).map(|b| weights[b] * piece[b]).sum::<f64>();
                    let phi = table.of(TetId(tet as u32)).iter().map(value).fold(f64::INFINITY, f64::min);
                    let walls = [x.x, 1.0 - x.x, x.y, 2.0 - x.y, x.z, 3.0 - x.z];
                    let depth = walls.iter().copied().fold(f64::INFINITY, f64::min);
                    assert!((phi - depth / 0.5).abs() < 1e-14, "{phi} for depth {depth}");
                }
            }
        }
    }
}
