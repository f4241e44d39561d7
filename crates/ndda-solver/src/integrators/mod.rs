//! Schemes in time.

pub(crate) mod generalized_alpha;
pub(crate) mod midpoint;
pub(crate) mod newmark;
pub(crate) mod time_integrator;
