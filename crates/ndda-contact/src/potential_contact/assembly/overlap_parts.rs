//! Input of the integration of the energy of contact.

use crate::affine::convex_target::ConvexBlocks;
use crate::broad_phase::candidates::Candidates;
use crate::friction::openings::Openings;
use crate::integration::frames::Frames;
use crate::integration::integrals::Integrals;
use crate::integration::scene::Scene;
use crate::model::ContactInput;
use crate::potential::contact_potential::PotentialField;

/// Input of the integration of U.
#[derive(Clone, Copy)]
pub(crate) struct OverlapParts<'a> {
    /// Pairs and facets.
    pub candidates: &'a Candidates,
    /// Integrals of the facets in contact.
    pub integrals: &'a Integrals,
    /// Frames of the candidates.
    pub frames: &'a Frames,
    /// φ.
    pub field: &'a PotentialField,
    /// Blocks that are affine convex targets.
    pub hulls: &'a ConvexBlocks,
    /// By how much facets are moved out before they are clipped.
    pub openings: &'a Openings,
}

impl<'a> OverlapParts<'a> {
    /// Input of the integration where the nodes are.
    pub(crate) fn scene(&self, input: &ContactInput<'a>) -> Scene<'a> {
        let &Self { candidates, frames, field, hulls, openings, .. } = self;
        let (blocks, position) = (input.blocks, input.position);
        Scene { blocks, position, candidates, frames, field, hulls, openings }
    }
}
