//! Couples of facets as forces on nodes.
//!
//! A torque T on a tetrahedron is the antisymmetric stress of its size: forces fᵢ = ½ T × ∇Nᵢ have no resultant, the moment
//! Σ xᵢ × fᵢ = T, and do work on the spin ½ curl u alone. On a block that moves by an affine map it does not matter which
//! tetrahedron has them; on others every tetrahedron that a facet presses on has its share.

use ndda_mesh::{BlockSet, TetId, Vec3};

use crate::affine::convex_target::ConvexBlocks;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::ActiveFacet;

/// Input of the computation of couples.
#[derive(Clone, Copy)]
pub(crate) struct CoupleScene<'a> {
    /// Topology.
    pub blocks: &'a BlockSet,
    /// Positions of the nodes [m].
    pub position: &'a [Vec3],
    /// Integrals of the pairs.
    pub integrals: &'a Integrals,
    /// Blocks that are affine convex targets.
    pub hulls: &'a ConvexBlocks,
}

impl CoupleScene<'_> {
    /// Adds the force of a couple on each node [N]: on those of the tetrahedron that a facet is of, or of those that it presses on.
    pub(crate) fn each_force(
        &self,
        touch: &ActiveFacet,
        is_owner: bool,
        couple_n_m: &Vec3,
        mut add: impl FnMut(usize, Vec3),
    ) {
        if is_owner {
            let tet = self.blocks.triangle_tet[touch.triangle.index()];
            return self.each_of_tet(tet, couple_n_m, &mut add);
        }
        if let Some(whole) = self.hulls.affine_target(touch.target) {
            return self.each_of_tet(whole.host, couple_n_m, &mut add);
        }
        let overlaps = self.integrals.overlaps_of(touch);
        let pressure = |weights: &[f64; 4]| weights.iter().sum::<f64>();
        let total: f64 = overlaps.iter().map(|overlap| pressure(&overlap.on_target.pressure)).sum();
        for overlap in overlaps {
            let share = pressure(&overlap.on_target.pressure) / total;
            if share.is_finite() && share != 0.0 {
                self.each_of_tet(overlap.tet, &(share * couple_n_m), &mut add);
            }
        }
    }

    fn each_of_tet(&self, tet: TetId, couple_n_m: &Vec3, add: &mut impl FnMut(usize, Vec3)) {
        let nodes = &self.blocks.tets[tet.index()];
        let x = nodes.map(|node| self.position[node.index()]);
        let edges = [x[1] - x[0], x[2] - x[0], x[3] - x[0]];
        // 6 V ∇N of the last three nodes; those of all four have no sum.
        let normals = [edges[1].cross(&edges[2]), edges[2].cross(&edges[0]), edges[0].cross(&edges[1])];
        let six_volumes = edges[0].dot(&normals[0]);
        let half = couple_n_m / (2.0 * six_volumes);
        let forces = normals.map(|normal| half.cross(&normal));
        add(nodes[0].index(), -(forces[0] + forces[1] + forces[2]));
        nodes[1..].iter().zip(forces).for_each(|(node, force)| add(node.index(), force));
    }
}
