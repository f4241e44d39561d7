//! Input of the integration.

use ndda_mesh::{BlockSet, TetId, Vec3};
use pulp::Arch;

use crate::affine::convex_target::ConvexBlocks;
use crate::broad_phase::candidates::{Candidates, Facet};
use crate::friction::openings::Openings;
use crate::integration::frames::Frames;
use crate::integration::joint_faces::two_faces_separate;
use crate::integration::tet_frame::{TetFrame, by_face, some_face_separates};
use crate::potential::contact_potential::PotentialField;

/// Input of all chunks.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// Topology.
    pub blocks: &'a BlockSet,
    /// Positions [m].
    pub position: &'a [Vec3],
    /// Pairs and facets.
    pub candidates: &'a Candidates,
    /// Frames of the candidates.
    pub frames: &'a Frames,
    /// φ.
    pub field: &'a PotentialField,
    /// Convex blocks, whose faces exclude facets.
    pub hulls: &'a ConvexBlocks,
    /// By how much facets are moved out before they are clipped.
    pub openings: &'a Openings,
}

impl Scene<'_> {
    /// Gives the tetrahedra of a facet's target that its triangle may be in: their number, the place of their frame, the frame, and λ_b of it at the corners of
    /// the triangle, as `[b][a]`. Touching is not overlap.
    #[inline(always)]
    pub(crate) fn each_near_tet(
        &self,
        arch: Arch,
        facet: &Facet,
        (corners, normal): (&[Vec3; 3], &Vec3),
        mut visit: impl FnMut(TetId, u32, &TetFrame, &[[f64; 3]; 4]),
    ) {
        if self.hulls.keep_apart(arch, facet.target, corners)
            || self.is_on_one_side(facet, &corners[0], normal)
        {
            return;
        }
        let (pieces, shift) = (!self.field.is_element(), self.frames.shift_of(facet.target));
        for tet in facet.tets() {
            let slot = self.candidates.slot_of(tet).wrapping_add(shift);
            let frame = self.frames.at(slot);
            let [x, y, z] = frame.lambda_by_corner(corners);
            let at = [&x, &y, &z];
            let (lambda, is_apart) = (by_face(at), some_face_separates(at));
            if (is_apart && !(pieces && lies_in_a_plane_of(frame, &lambda, normal)))
                || two_faces_separate(at)
                || self.tet_is_on_one_side(tet, &corners[0], normal)
            {
                continue;
            }
            visit(tet, slot, frame, &lambda);
        }
    }

    /// Whether all of the target is strictly before or behind the plane of a facet; not asked where it has more nodes than
    /// the facet has pairs to ask.
    #[inline]
    fn is_on_one_side(&self, facet: &Facet, point: &Vec3, normal: &Vec3) -> bool {
        let nodes = self.blocks.nodes_of(facet.target);
        nodes.len() <= 4 * facet.pairs() && are_on_one_side(self.position[nodes].iter(), point, normal)
    }

    #[inline]
    fn tet_is_on_one_side(&self, tet: TetId, point: &Vec3, normal: &Vec3) -> bool {
        let corners = self.blocks.tets[tet.index()].iter().map(|n| &self.position[n.index()]);
        are_on_one_side(corners, point, normal)
    }
}

#[inline]
pub(super) fn are_on_one_side<'a>(
    points: impl Iterator<Item = &'a Vec3>,
    point: &Vec3,
    normal: &Vec3,
) -> bool {
    let range = |(least, most): (f64, f64), x: &Vec3| {
        let above = normal.dot(&(x - point));
        // As `f64::min` and `f64::max` leave out what is not a number, but in one instruction.
        (if above < least { above } else { least }, if above > most { above } else { most })
    };
    let (least, most) = points.fold((f64::INFINITY, f64::NEG_INFINITY), range);
    least > 0.0 || most < 0.0
}

/// Whether the triangle lies exactly in a face's plane and the tetrahedron owns it: other potentials than the
/// paper's are not zero on the faces inside a block.
fn lies_in_a_plane_of(frame: &TetFrame, lambda: &[[f64; 3]; 4], normal: &Vec3) -> bool {
    let beyond = |at: &[f64; 3]| at.iter().all(|&l| l < 0.0);
    let off = |b: usize| lambda[b].iter().all(|&l| l <= 0.0) && !frame.owns_plane(b, normal);
    !lambda.iter().any(beyond) && !(0..4).any(off)
}
