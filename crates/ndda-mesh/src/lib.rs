//! Blocks of rock as tetrahedra: generators, cutting of rock by joints, filling, checks, and the set of blocks that all else works on.
//!
//! A box of rock, cut by bedding of 1 m and filled with tetrahedra:
//!
//! ```
//! use ndda_mesh::cut::{CutOptions, Discontinuity, Domain, JointSet, cut_blocks};
//! use ndda_mesh::geometry::tet_volume;
//! use ndda_mesh::tetrahedralise::Fill;
//! use ndda_mesh::{BlockSet, TetId, Vec3};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let rock = Domain::cuboid(Vec3::zeros(), Vec3::new(2.0, 2.0, 4.0))?;
//! let bedding = JointSet::new("bedding", 0.0, 0.0, 1.0);
//! let blocks = cut_blocks(&rock, &[Discontinuity::Set(bedding)], &CutOptions::default())?;
//! let mut named = Vec::new();
//! for block in 0..blocks.blocks.len() {
//!     named.push((format!("block {block}"), blocks.mesh(block, &Fill::Fewest)?));
//! }
//! let set = BlockSet::new(named)?;
//! let corners = (0..set.tets.len() as u32).map(|tet| set.tet_corners(TetId(tet), &set.rest_position));
//! let volume_m3: f64 = corners.map(|corners| tet_volume(&corners)).sum();
//! assert!(set.len() >= 4 && (volume_m3 - 16.0).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`block_mesh`] | one block on its own: what a generator makes and an importer reads |
//! | [`block_set`] | all blocks of a scene in structs of arrays, with constant topology; each owns a contiguous range of nodes, tetrahedra and outward boundary triangles |
//! | [`generate`] | blocks of one shape each: boxes, prisms, cylinders, spheres, voussoirs |
//! | [`cut`] | rock cut by joints, and Voronoi cells |
//! | [`tetrahedralise`] | tetrahedra that fill a polyhedron |
//! | [`validate`], [`quality`], [`repair`] | problems of a mesh, how good it is, and changes that mend it when asked to |
//! | [`geometry`], [`planar`], [`surface`], [`stats`], [`ids`] | volumes and boxes, polygons, boundary triangles, counts, typed indices |

#![warn(unreachable_pub)]

pub mod block_mesh;
pub mod block_set;
pub mod cut;
pub mod generate;
pub mod geometry;
pub mod ids;
mod node_sets;
pub mod planar;
pub mod quality;
pub mod repair;
pub mod stats;
pub mod surface;
pub mod tetrahedralise;
pub mod validate;

pub use block_mesh::BlockMesh;
pub use block_set::{BlockSet, BlockSetBuilder};
pub use ids::{BlockId, NodeId, TetId, TriangleId};
pub use stats::MeshStats;
pub use validate::{MeshError, MeshProblem};

/// A vector or point in space; positions are in metres unless a name says otherwise.
pub type Vec3 = nalgebra::Vector3<f64>;
/// A 3 × 3 matrix: rotation, deformation gradient, inertia.
pub type Mat3 = nalgebra::Matrix3<f64>;
