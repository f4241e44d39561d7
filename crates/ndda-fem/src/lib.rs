//! Finite elements inside a block: material, stiffness and mass, frame, loads, supports, stress. Nothing here knows of contact or of time.
//!
//! A block is elastic in its own frame: small strains, one rotation R. A rotated cube, for one, has no strain in its frame:
//!
//! ```
//! use ndda_fem::{BlockOperator, Frame, LinearElastic};
//! use ndda_mesh::generate::{BoxPattern, box_block};
//! use ndda_mesh::{Mat3, Vec3};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let cube = box_block([1.0; 3], [2, 2, 2], BoxPattern::Six)?;
//! let granite = LinearElastic::new(50e9, 0.25, 2650.0)?;
//! let operator = BlockOperator::new(&cube.nodes, cube.tets.clone(), &granite);
//! assert!((operator.mass_kg - 2650.0).abs() < 1e-9);
//!
//! let turn = nalgebra::Rotation3::new(Vec3::new(0.3, -0.2, 1.1)).into_inner();
//! let position: Vec<Vec3> = cube.nodes.iter().map(|x| turn * x).collect();
//! let center = operator.center(&position);
//! let rotation: Mat3 = Frame::free(&operator).rotation(&operator, &position, &center)?;
//! assert!((rotation - turn).norm() < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`material`], [`linear_elastic`], [`transversely_isotropic`], [`damped`] | the contract of a material, and materials |
//! | [`tet4`], [`block_operator`] | the four-node tetrahedron; K and M of a block in its rest frame |
//! | [`frame`] | the rotation R of a block |
//! | [`mobility`](mod@mobility) | how much contact can accelerate a block that moves as a whole |
//! | [`loads`], [`pressure`], [`table`], [`motion`] | gravity, tractions, initial stress, pressure of water; values and motions over time |
//! | [`supports`] | held nodes, springs and prescribed motion |
//! | [`quiet`] | faces behind which rock goes on, and waves that arrive through them |
//! | [`stress`] | stresses, recovered for output |
//! | [`testing`] | the contract suite of materials |

#![warn(unreachable_pub)]

pub mod block_operator;
pub mod damped;
pub mod frame;
pub mod linear_elastic;
pub mod loads;
pub mod material;
pub mod mobility;
pub mod motion;
pub mod pressure;
pub mod quiet;
pub mod stress;
pub mod supports;
pub mod table;
pub mod testing;
pub mod tet4;
pub mod transversely_isotropic;

pub use block_operator::BlockOperator;
pub use damped::Damped;
pub use frame::{Frame, FrameError};
pub use linear_elastic::{LinearElastic, MaterialError};
pub use loads::InitialStress;
pub use material::{Damping, Material, Voigt};
pub use mobility::mobility;
pub use motion::{Motion, Record};
pub use pressure::{CutRoom, LinearField, PressureField, PressurePiece};
pub use quiet::{PlaneWave, Quiet, QuietFaces};
pub use supports::{BlockSupports, Hold, NodeSupport, SupportError};
pub use table::{Between, Table};
pub use transversely_isotropic::{Bedding, TransverselyIsotropic};
