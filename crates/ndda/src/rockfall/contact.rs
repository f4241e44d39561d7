//! Contact of a boulder with the ground: the triangles of the ground press on the boulder by how deep they are in it.
//!
//! φ is the depth below the nearest face of the boulder, and zero in the ground: W = k ∫ φ dV over the part of the boulder that is below the surface. Its force,
//! −k n ∫ φ dA on each triangle of the ground, is along the normal of the ground, whatever edge or corner of the boulder is in it, so that friction there is that
//! of the ground's plane. The ground behind its surface, and how it is divided, does not matter.

use ndda_contact::broad_phase::{BroadPhase, BroadScene, PairLists};
use ndda_contact::{ContactPotential, PieceTable, PotentialError, PotentialField};
use ndda_mesh::geometry::TET_FACES;
use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId, Vec3};

/// The boulder among the blocks of a simulation.
pub(super) const BOULDER: BlockId = BlockId(0);
/// The ground.
pub(super) const GROUND: BlockId = BlockId(1);

/// φ = depth in the boulder over a metre, so that the penalty is a pressure at that depth; zero in the ground.
pub(super) struct BoulderDepth;

impl ContactPotential for BoulderDepth {
    fn name(&self) -> &'static str {
        "Depth in the boulder"
    }

    fn phi_per_m(&self) -> Option<f64> {
        Some(1.0)
    }

    /// In each tetrahedron of the boulder, between its mass centre and a triangle of its surface, the depth below that triangle. The boulder is one
    /// affine convex target, so that these values are not used, but those of its faces.
    fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
        let mut table = PieceTable::new();
        for block in blocks.ids() {
            for tet in blocks.tets_of(block) {
                let corners = blocks.tet_corners(TetId(tet as u32), &blocks.rest_position);
                let depth = if block == BOULDER { depth_of_centre(&corners) } else { [0.0; 4] };
                table.push(&[depth]);
            }
        }
        Ok(PotentialField::Pieces(table))
    }
}

/// Depth at each corner below the face opposite to the first.
fn depth_of_centre(corners: &[Vec3; 4]) -> [f64; 4] {
    let [i, j, k] = TET_FACES[0].map(|c| corners[c]);
    let normal = (j - i).cross(&(k - i)).normalize();
    [normal.dot(&(corners[0] - i)).abs(), 0.0, 0.0, 0.0]
}

/// The triangles of the ground near the boulder, each with the tetrahedron that stands for it.
pub(super) struct GroundBelow;

impl BroadPhase for GroundBelow {
    fn name(&self) -> &'static str {
        "ground below a boulder"
    }

    fn find_pairs(&mut self, scene: &BroadScene, _renewed: &[BlockId], pairs: &mut PairLists) -> bool {
        let blocks = scene.blocks;
        let around = scene.block_box(BOULDER);
        let is_host = |tet: &usize| scene.tet_box(*tet).touches(&around);
        let Some(host) = blocks.tets_of(BOULDER).find(is_host) else { return false };
        let is_near = |triangle: &usize| {
            scene.contactor_box(*triangle, BOULDER).is_some_and(|own| own.touches(&around))
        };
        let near = blocks.triangles_of(GROUND).filter(is_near);
        let found: Vec<_> = near.map(|triangle| (TriangleId(triangle as u32), TetId(host as u32))).collect();
        let changed = !pairs.pairs().eq(found.iter().copied());
        if changed {
            pairs.set(blocks, &found);
        }
        changed
    }
}
