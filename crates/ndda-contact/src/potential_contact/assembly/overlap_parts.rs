//! Input of the integration of the energy of contact.

use crate::affine::convex_target::ConvexBlocks;
use crate::broad_phase::candidates::Candidates;
use crate::integration::frames::Frames;
use crate::integration::integrals::Integrals;
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
}
