//! Blocks of rock as tetrahedra.
//!
//! A [`BlockMesh`] is one block on its own: what a generator makes and an importer reads.
//! A [`BlockSet`] is all blocks of a scene in structs of arrays, with constant topology: each block owns a
//! contiguous range of nodes, tetrahedra and outward boundary triangles.
//!
//! Blocks come from [`generate`] (one shape each) or from [`cut`] (rock cut by joints, or Voronoi cells), which
//! [`tetrahedralise`] fills. [`validate`] says what is wrong with a mesh, [`quality`] how good it is, and [`repair`]
//! changes it when asked to.

pub mod block_mesh;
pub mod block_set;
pub mod cut;
pub mod generate;
pub mod geometry;
pub mod ids;
pub mod quality;
pub mod repair;
pub mod stats;
pub mod surface;
pub mod tetrahedralise;
pub mod validate;

pub use block_mesh::BlockMesh;
pub use block_set::BlockSet;
pub use ids::{BlockId, NodeId, TetId, TriangleId};
pub use stats::MeshStats;
pub use validate::{MeshError, MeshProblem};

/// A vector or point in space; positions are in metres unless a name says otherwise.
pub type Vec3 = nalgebra::Vector3<f64>;
/// A 3 × 3 matrix: rotation, deformation gradient, inertia.
pub type Mat3 = nalgebra::Matrix3<f64>;
