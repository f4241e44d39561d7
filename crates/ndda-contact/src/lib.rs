//! Contact between blocks: forces, energy and stiffness of nodes from where the blocks are.
//!
//! The solver knows contact only through [`ContactModel`]. [`PotentialContact`], the default model (feature `potential`), is the
//! contact potential of the paper, integrated exactly over boundary triangles, with friction on top of it.
//!
//! Two cubes of 1 m, one of which has sunk 1 mm into the other, by the formula that the default model is tested against (k_n = 1e9 Pa,
//! φ = 4 λ below a face): action and reaction, and the upper cube is pushed up.
//!
//! ```
//! use ndda_contact::element_pairs;
//! use ndda_contact::testing::{test_box, test_set};
//! use ndda_mesh::{BlockId, Vec3};
//!
//! let lower = test_box([0.0, 0.0, 0.0], [1.0; 3], [1, 1, 1]);
//! let upper = test_box([0.0, 0.0, 0.999], [1.0; 3], [1, 1, 1]);
//! let blocks = test_set(vec![lower, upper]);
//! let force = element_pairs::forces(&blocks, &blocks.rest_position, 1e9);
//! let on_upper: Vec3 = force[blocks.nodes_of(BlockId(1))].iter().sum();
//! let total: Vec3 = force.iter().sum();
//! assert!(on_upper.z > 0.0 && total.norm() < 1e-6 * on_upper.z);
//! ```
//!
//! | chapter | |
//! |---|---|
//! | `broad_phase` | which triangles of one block may meet which elements of another |
//! | `potential` | φ within a block, and the pressure that follows from it |
//! | `integration` | exact integrals over the part of a triangle that lies in a target |
//! | `affine` | convex blocks that move by affine maps: one target each, and faces as contactors |
//! | `friction` | laws of friction, cohesion and tension, and the forces that they limit |
//! | `restitution` | contact damping by a coefficient of restitution |
//! | `assembly` | from integrals to forces on nodes, energies, stiffnesses and the report |
//! | `reference` | one pair of tetrahedra, step by step |
//! | [`testing`], and `testing` of the chapters | contract suites for models and laws of other people |

#![warn(unreachable_pub)]

mod audit;
mod contact_model;
pub mod element_pairs;
mod model;
mod pair_stiffness;
mod plan;
mod resultants;
#[cfg(feature = "potential")]
mod room;
pub mod testing;

pub use audit::ContactAudit;
pub use contact_model::ContactModel;
pub use plan::Part;

pub use model::{
    Body, BodyMemory, Bond, ContactError, ContactHistory, ContactInput, ContactOutput, ContactReport,
    Deformation, FaceMemory, FacetContact, FacetMemory, SpringSlip,
};

pub use pair_stiffness::PairStiffness;
pub use resultants::{PairResultant, resultants};

#[cfg(feature = "potential")]
mod potential_contact;
#[cfg(feature = "potential")]
pub use potential_contact::*;
