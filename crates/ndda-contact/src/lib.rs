//! Contact between blocks.
//!
//! [`model`] is the seam: the solver knows contact only through [`ContactModel`]. The default model (feature
//! `potential`) is the contact potential of the paper, integrated exactly over boundary triangles.

pub mod model;

pub use model::{
    ContactError, ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport, FacetMemory,
};
