//! The potential φ within a block, and the pressure that follows from it.

pub(crate) mod closure;
pub(crate) mod contact_potential;
pub(crate) mod element;
pub(crate) mod function;
pub(crate) mod piece_table;
pub(crate) mod smooth;
pub mod testing;
pub(crate) mod volume;
