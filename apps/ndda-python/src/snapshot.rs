//! A simulation as it was.

use ndda::driver::DriverSnapshot;
use pyo3::prelude::*;

/// A copy of all that changes in a simulation; `Simulation.restore` takes it.
///
/// Examples
/// --------
/// >>> import ndda
/// >>> isinstance(ndda.Simulation(ndda.parse(ndda.EXAMPLE)).snapshot(), ndda.Snapshot)
/// True
#[pyclass(frozen, module = "ndda")]
pub struct Snapshot(pub DriverSnapshot);
