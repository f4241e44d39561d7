//! The native part of the Python package `ndda`: scenes, simulations, arrays, exceptions.
//!
//! Conveniences that are shorter in Python (patterns of names, loops with callbacks, logging) are in `python/ndda`.

mod arrays;
mod errors;
mod scene;
mod simulation;

use pyo3::prelude::*;

use errors::{SceneError, StopError};
use scene::Scene;
use simulation::{Simulation, Snapshot};

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("CONTACT_COLUMNS", ndda::run::contact_rows::COLUMNS.to_vec())?;
    module.add("SceneError", module.py().get_type::<SceneError>())?;
    module.add("StopError", module.py().get_type::<StopError>())?;
    module.add_class::<Scene>()?;
    module.add_class::<Simulation>()?;
    module.add_class::<Snapshot>()
}
