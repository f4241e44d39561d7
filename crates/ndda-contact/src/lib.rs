//! Contact between blocks.
//!
//! [`model`] is the seam: the solver knows contact only through [`ContactModel`]. The default model (feature
//! `potential`) is the contact potential of the paper, integrated exactly over boundary triangles.

pub mod element_pairs;
pub mod model;
pub mod testing;

#[cfg(feature = "potential")]
pub mod broad_phase;
#[cfg(feature = "potential")]
pub mod bvh;
#[cfg(feature = "potential")]
pub mod candidates;
#[cfg(feature = "potential")]
pub mod clip;
#[cfg(feature = "potential")]
pub mod friction;
#[cfg(feature = "potential")]
pub mod pair;
#[cfg(feature = "potential")]
pub mod potential_contact;

pub use model::{
    ContactError, ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport, FacetMemory,
};

#[cfg(feature = "potential")]
pub use friction::{Coulomb, FrictionLaw};
#[cfg(feature = "potential")]
pub use potential_contact::PotentialContact;
