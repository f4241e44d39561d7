//! Convex blocks that move by an affine map: each is one target, and its faces are the contactors.

pub(crate) mod closing;
pub(crate) mod convex_target;
pub(crate) mod face;
pub(crate) mod face_contactor;
pub(crate) mod half_spaces;
pub(crate) mod surface;

pub use convex_target::ConvexBlocks;
pub use surface::BlockFaces;
