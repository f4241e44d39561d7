//! Where a simulation begins: at the start of its scene, or where a saved one was.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::Ordering;

use ndda::driver::{Driver, LoadError, Parts};
use ndda_solver::Settled;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::{scene_error, stop_error};
use crate::law::{Law, own_or};
use crate::scene::Scene;
use crate::threads::Threads;
use crate::watched::watched;

/// A driver at the start of a scene.
pub fn begun(
    py: Python<'_>,
    scene: &Scene,
    threads: &Threads,
    parts: Option<Parts>,
    law: &Law,
) -> PyResult<Driver> {
    if scene.has_stages() {
        let message = "the scene has stages, which `ndda.run` follows: leave them out, and change the simulation between steps with `change`";
        return Err(PyValueError::new_err(message));
    }
    let driver = watched(py, threads, |watch| {
        let mut settling = |_: &Settled| match watch.stop.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        scene.model(parts.as_ref()).map(|model| Driver::with_parts(model, parts, &mut settling))
    })?;
    let driver = driver.map_err(|errors| scene_error(py, &errors))?;
    driver.map_err(|stop| own_or(law, || stop_error(py, &stop)))
}

/// A driver that goes on from what `Simulation.save` wrote, or from a run in a folder.
pub fn saved(py: Python<'_>, path: &Path, threads: &Threads, parts: Option<Parts>) -> PyResult<Driver> {
    let loaded = threads.run(py, || Driver::load(path, parts))?;
    loaded.map_err(|error| match &error {
        LoadError::Scene(errors) => scene_error(py, errors),
        other => PyValueError::new_err(other.to_string()),
    })
}
