//! A simulation as it was.

use ndda::driver::DriverSnapshot;
use pyo3::prelude::*;

/// A copy of all that changes in a simulation, and of its history so far; `Simulation.restore` takes it.
///
/// Examples
/// --------
/// >>> import ndda
/// >>> isinstance(ndda.Simulation(ndda.parse(ndda.EXAMPLE)).snapshot(), ndda.Snapshot)
/// True
#[pyclass(frozen, weakref, module = "ndda")]
pub struct Snapshot(pub DriverSnapshot);
