//! Friction, cohesion and tension: their laws, and the forces on facets and patches that they limit.

pub(crate) mod barton_bandis;
pub(crate) mod bond;
pub(crate) mod bond_formation;
pub(crate) mod bond_overload;
pub(crate) mod bonds_of_facet;
pub(crate) mod coulomb;
pub(crate) mod dilating;
pub(crate) mod facet;
pub(crate) mod fracture;
pub(crate) mod law;
pub(crate) mod law_table;
pub(crate) mod memory;
pub(crate) mod mohr_coulomb;
pub(crate) mod openings;
pub(crate) mod patches;
pub(crate) mod softening_bond;
pub(crate) mod softening_coulomb;
pub(crate) mod stretch;
pub mod testing;
pub(crate) mod twist;
pub(crate) mod velocity_coulomb;

pub use facet::FacetForce;
pub use openings::Openings;
