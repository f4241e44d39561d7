//! Forecasts: figures of a run that are known before its first step.

pub mod admit;
pub mod cost;
pub mod creep;
pub mod doubts;
pub mod dry;
pub mod gaps;
mod ground_stress;
pub mod held;
mod idle;
pub mod lumped;
pub mod memory;
mod points;
pub(crate) mod rim;
pub mod rounding;
pub mod size;
pub mod slivers;
pub mod step;
