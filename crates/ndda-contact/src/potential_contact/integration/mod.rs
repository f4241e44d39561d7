//! Exact integrals of the potential over the part of a triangle that lies in a target.

mod affine_target;
pub(crate) mod capacity;
pub(crate) mod chunk_parts;
pub(crate) mod clip;
pub(crate) mod double_double;
pub(crate) mod fluxes;
pub(crate) mod frames;
pub(crate) mod function_moments;
pub(crate) mod integrals;
pub(crate) mod joint_faces;
pub(crate) mod kernel;
pub(crate) mod linear;
pub(crate) mod overlap_pair;
pub(crate) mod pair_moments;
pub(crate) mod pair_report;
pub(crate) mod polyhedron;
mod polyhedron_integrals;
pub(crate) mod quadrature;
pub(crate) mod queue;
pub(crate) mod region;
pub(crate) mod scene;
mod shared_chunks;
pub(crate) mod tet_frame;
pub(crate) mod tet_overlap;

pub use frames::Frames;
pub use integrals::Integrals;
pub use kernel::{GROUP, GroupMoments, RegionGroup, region_moments};
pub use pair_moments::{PairMoments, pair_moments};
pub use polyhedron::overlap_of;
pub use queue::RegionQueue;
pub use region::{Region, element_regions};
pub use scene::Scene;
pub use tet_frame::TetFrame;
pub use tet_overlap::{PairError, TetOverlap, tet_overlap};
