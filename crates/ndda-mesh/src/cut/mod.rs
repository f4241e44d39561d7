//! Rock cut into blocks: domains, joints, Voronoi cells.
//!
//! A [`Domain`] of convex parts is cut by [`Discontinuity`]s with [`cut_blocks`], or into seeded cells with
//! [`voronoi_blocks`]. Both give [`Blocks`]: convex polyhedra whose faces know the surface that made them, pairs of
//! faces that meet, and a report. Convention: x east, y north, z up; dip direction clockwise from north; dip downward
//! from horizontal. No tolerance is absolute: parts that rise less
//! than 1e-9 of the domain's diagonal above a plane are not cut off, and vertices within 1e-13 of it lie on the plane.

mod blocks;
mod decompose;
mod discs;
mod domain;
mod error;
mod excavate;
mod interfaces;
mod joints;
mod merge;
mod neighbours;
pub mod plane;
mod polyhedron;
mod random;
mod split;
mod surfaces;
mod system;
mod terrain;
mod voronoi;

pub use blocks::{Blocks, CutReport, Sliver};
pub use discs::{DiscReport, DiscRule};
pub use domain::{Axis, Domain, DomainFace};
pub use error::CutError;
pub use joints::{Disc, Discontinuity, JointSet, OrientationScatter, SpacingScatter};
pub use merge::Merged;
pub use plane::{Plane, dip_normal, sin_cos};
pub use polyhedron::{Face, Polyhedron};
pub use random::Stream;
pub(crate) use random::frame as plane_frame;
pub use split::{Split, Tolerance, split};
pub use surfaces::{Neighbour, Surface, SurfaceKind};
pub use system::{CutOptions, cut_blocks};
pub use voronoi::{CELLS, VoronoiOptions, random_seeds, voronoi_blocks};

/// Vertices within this fraction of the domain's diagonal of a plane lie on it.
const ON_PLANE_RATIO: f64 = 1e-13;
/// Parts that rise less than this fraction of the domain's diagonal above a plane are not cut off.
const LEAST_DEPTH_RATIO: f64 = 1e-9;
