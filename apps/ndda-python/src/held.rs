//! Who may use the driver of a simulation, and on which threads.

use std::sync::{MutexGuard, TryLockError};

use ndda::driver::Driver;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::stop_error;
use crate::simulation::Simulation;

impl Simulation {
    /// The driver, unless another thread has it.
    pub fn driver(&self) -> PyResult<MutexGuard<'_, Driver>> {
        match self.driver.try_lock() {
            Ok(driver) => Ok(driver),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {
                let message = "this simulation is stepping in another thread: wait for it, or use a simulation of its own in each thread. \
                               A law gets all that it may see as facets";
                Err(PyRuntimeError::new_err(message))
            }
        }
    }

    /// The driver, unless a step has left its state half done.
    pub fn usable(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Driver>> {
        let driver = self.driver()?;
        match driver.stopped() {
            Some(stop) => Err(stop_error(py, stop)),
            None => Ok(driver),
        }
    }

    /// Does something with the driver on the threads, while other Python threads run.
    pub fn on_driver<R: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Driver) -> R + Send,
    ) -> PyResult<R> {
        let mut held = self.driver()?;
        let driver = &mut *held;
        self.threads.run(py, || work(driver))
    }
}
