//! Rock bolts: bars in boreholes across blocks, grouted or with a free length, solved statically in every step.
//!
//! A bolt has no mass. In each step its bar is brought to balance between springs that hold it in the rock (`chain`), made of the laws of steel, grout and plate
//! (`law`); points of it move with tetrahedra (`embedding`), and what the rock does to it between them, and it to the rock, is in `span`. What slips,
//! yields and breaks is remembered (`memory`). Its forces act where contact acts, at x*, and its stiffness is added to that of contact
//! (`stiffness`), so that all that is said of steps holds for both.

pub(crate) mod bolt;
pub(crate) mod chain;
pub(crate) mod embedding;
pub(crate) mod error;
pub(crate) mod law;
pub(crate) mod memory;
pub(crate) mod report;
pub(crate) mod set;
pub(crate) mod setup;
pub(crate) mod span;
pub(crate) mod stiffness;
