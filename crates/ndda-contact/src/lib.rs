//! Contact between blocks.
//!
//! [`model`] is the seam: the solver knows contact only through [`ContactModel`]. The default model (feature
//! `potential`) is the contact potential of the paper, integrated exactly over boundary triangles.

pub mod element_pairs;
pub mod model;
pub mod pair_stiffness;
pub mod plan;
pub mod resultants;
pub mod testing;

#[cfg(feature = "potential")]
pub mod batch;
#[cfg(feature = "potential")]
pub mod block_faces;
#[cfg(feature = "potential")]
pub mod bonds;
#[cfg(feature = "potential")]
mod both;
#[cfg(feature = "potential")]
pub mod broad_phase;
#[cfg(feature = "potential")]
mod broad_scenes;
#[cfg(feature = "potential")]
pub mod bvh;
#[cfg(feature = "potential")]
pub mod by_block;
#[cfg(feature = "potential")]
pub mod candidates;
#[cfg(feature = "potential")]
pub mod clip;
#[cfg(feature = "potential")]
mod closing;
#[cfg(feature = "potential")]
pub mod contactors;
#[cfg(feature = "potential")]
pub mod coulomb;
#[cfg(feature = "potential")]
mod couples;
#[cfg(feature = "potential")]
pub mod element_potential;
#[cfg(feature = "potential")]
pub mod energy;
#[cfg(feature = "potential")]
pub mod facets;
#[cfg(feature = "potential")]
pub mod friction;
#[cfg(feature = "potential")]
pub mod friction_patches;
#[cfg(feature = "potential")]
pub mod hulls;
#[cfg(feature = "potential")]
pub mod integrals;
#[cfg(feature = "potential")]
pub mod joints;
#[cfg(feature = "potential")]
pub mod kernel;
#[cfg(feature = "potential")]
pub mod listed;
#[cfg(feature = "potential")]
pub mod mohr_coulomb;
#[cfg(feature = "potential")]
pub mod overlap;
#[cfg(feature = "potential")]
pub mod own_trees;
#[cfg(feature = "potential")]
pub mod pair;
#[cfg(feature = "potential")]
pub mod potential;
#[cfg(feature = "potential")]
pub mod potential_contact;
#[cfg(feature = "potential")]
pub mod region;
#[cfg(feature = "potential")]
pub mod report;
#[cfg(feature = "potential")]
pub mod scatter;
#[cfg(feature = "potential")]
pub mod sides;
#[cfg(feature = "potential")]
pub mod smooth_potential;
#[cfg(feature = "potential")]
pub mod softening_coulomb;
#[cfg(feature = "potential")]
pub mod tangent;
#[cfg(feature = "potential")]
pub mod tet_pair;
#[cfg(feature = "potential")]
mod twofold;
#[cfg(feature = "potential")]
pub mod velocity_friction;
#[cfg(feature = "potential")]
pub mod volume_potential;

pub use plan::Part;

pub use model::{
    Body, Bond, ContactError, ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport,
    Deformation, FaceMemory, FacetContact, FacetMemory, SpringSlip,
};

pub use pair_stiffness::PairStiffness;
pub use resultants::{PairResultant, resultants};

#[cfg(feature = "potential")]
pub use {
    coulomb::Coulomb,
    element_potential::ElementPotential,
    friction::{FacetSlip, FrictionLaw, ShearMemory},
    joints::{Joints, Memory},
    mohr_coulomb::MohrCoulomb,
    potential::{ContactPotential, Field, OverlapLaw, PieceTable, PotentialError},
    potential_contact::PotentialContact,
    smooth_potential::SmoothPotential,
    softening_coulomb::SofteningCoulomb,
    velocity_friction::VelocityCoulomb,
    volume_potential::VolumePotential,
};
