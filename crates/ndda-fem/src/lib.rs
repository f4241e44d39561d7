//! Finite elements inside a block.
//!
//! A block is linear elastic in its own frame: small strains, one rotation R. [`BlockOperator`] holds K and M in
//! the rest frame, [`frame`] finds R, [`loads`] and [`supports`] say what acts on the nodes, [`stress`] recovers
//! stresses for output. Nothing here knows of contact or of time.

pub mod block_operator;
pub mod damped;
pub mod frame;
pub mod linear_elastic;
pub mod loads;
pub mod material;
pub mod motion;
pub mod pressure;
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
pub use motion::{Motion, Record};
pub use pressure::{CutRoom, LinearField, PressureField, PressurePiece};
pub use supports::{BlockSupports, Hold, NodeSupport, SupportError};
pub use table::{Between, Table};
pub use transversely_isotropic::{Bedding, TransverselyIsotropic};
