//! The native part of the Python package `ndda`: scenes, simulations, arrays, exceptions, tools.
//!
//! Conveniences that are shorter in Python (patterns of names, loops with callbacks, builders, pictures) are in `python/ndda`.
#![cfg(feature = "python")]

mod arrays;
mod begin;
mod errors;
mod held;
mod law;
mod scene;
mod simulation;
mod snapshot;
mod threads;
mod tools;
mod watched;

use std::ffi::OsString;

use pyo3::prelude::*;
use pyo3::types::PyTuple;

use errors::{SceneError, StopError};
use scene::Scene;
use simulation::Simulation;
use snapshot::Snapshot;

/// Does what a command line asks for, the program's name first; `program` starts it again. Returns the exit code.
#[pyfunction]
fn _command(py: Python<'_>, args: Vec<OsString>, program: Vec<OsString>) -> u8 {
    py.detach(|| ndda_cli::run_command(args, program))
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    threads::note_process();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("_HISTORY", PyTuple::new(module.py(), arrays::row_names())?)?;
    module.add("SceneError", module.py().get_type::<SceneError>())?;
    module.add("StopError", module.py().get_type::<StopError>())?;
    module.add_class::<Scene>()?;
    module.add_class::<Simulation>()?;
    module.add_class::<Snapshot>()?;
    module.add_function(wrap_pyfunction!(_command, module)?)?;
    tools::add_to(module)
}
