//! Sizes of the fixed arrays of outlines, regions and polyhedra.

/// Most corners of a contactor's outline; a face of a block that has more is left to its triangles.
pub(crate) const MOST_CORNERS: usize = 8;

/// Most cuts of a region, and most faces of a convex block that is one target.
pub(crate) const MOST_CUTS: usize = 24;
