//! A friction law in Python: arrays in, arrays out, once a step.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ndda::build::Choices;
use ndda::driver::Parts;
use ndda_contact::{BatchFacet, BatchLaw};
use ndda_mesh::Vec3;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A law in Python of one simulation, which all that uses it shares, so that the collector of garbage knows its only owner.
#[derive(Clone, Default)]
pub struct Law(Arc<Held>);

#[derive(Default)]
struct Held {
    /// Locked by whoever has Python's lock, and no longer than it takes to copy it.
    call: Mutex<Option<Py<PyAny>>>,
    /// The exception that it raised last.
    raised: Mutex<Option<PyErr>>,
}

impl Law {
    fn held(&self) -> MutexGuard<'_, Option<Py<PyAny>>> {
        self.0.call.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Shows the callable to the collector of garbage.
    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.0.call.try_lock().map_or(Ok(()), |call| visit.call(&*call))
    }

    /// Lets go of the callable.
    pub fn clear(&self) {
        // Taken out before it is dropped: dropping it may free the simulation, which calls this again.
        let call = self.held().take();
        drop(call);
    }
}

/// A callable that a simulation asks for the shear forces of all facets.
struct PyLaw {
    law: Law,
    name: String,
    state_len: usize,
    stiffness_pa_m: f64,
}

/// Parts of a simulation with a Python law of a name, and the law.
pub fn parts(
    law: &Bound<'_, PyAny>,
    name: String,
    (state_len, stiffness_pa_m): (usize, f64),
) -> (Parts, Law) {
    let call = Mutex::new(Some(law.clone().unbind()));
    let law = Law(Arc::new(Held { call, raised: Mutex::default() }));
    let shared = law.clone();
    let make = move || {
        let law = PyLaw { law: shared.clone(), name: name.clone(), state_len, stiffness_pa_m };
        Choices { batch_law: Some(Box::new(law)), ..Choices::default() }
    };
    (Arc::new(make), law)
}

impl BatchLaw for PyLaw {
    fn state_len(&self) -> usize {
        self.state_len
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.stiffness_pa_m
    }

    fn forces(
        &mut self,
        dt_s: f64,
        facets: &[BatchFacet],
        state: &mut [f64],
        force_n: &mut [Vec3],
    ) -> Result<(), String> {
        Python::attach(|py| {
            self.ask(py, dt_s, facets, state, force_n).map_err(|error| {
                let words = error.to_string();
                if let Ok(mut raised) = self.law.0.raised.lock() {
                    *raised = Some(error);
                }
                words
            })
        })
    }
}

impl PyLaw {
    fn ask(
        &self,
        py: Python<'_>,
        dt_s: f64,
        facets: &[BatchFacet],
        state: &mut [f64],
        force_n: &mut [Vec3],
    ) -> PyResult<()> {
        let count = facets.len();
        let vectors = |of: fn(&BatchFacet) -> Vec3| {
            let flat: Vec<f64> = facets.iter().flat_map(|facet| <[f64; 3]>::from(of(facet))).collect();
            PyArray1::from_vec(py, flat).reshape([count, 3])
        };
        let numbers =
            |of: fn(&BatchFacet) -> f64| PyArray1::from_vec(py, facets.iter().map(of).collect::<Vec<f64>>());
        let blocks =
            |of: fn(&BatchFacet) -> i64| PyArray1::from_vec(py, facets.iter().map(of).collect::<Vec<i64>>());
        let kept: Bound<'_, PyArray2<f64>> =
            PyArray1::from_slice(py, state).reshape([count, self.state_len])?;
        let given = PyDict::new(py);
        given.set_item("dt", dt_s)?;
        given.set_item("first", blocks(|facet| facet.owner.0.into()))?;
        given.set_item("second", blocks(|facet| facet.target.0.into()))?;
        // Where blocks touch, the faces of both are facets.
        given.set_item("area", numbers(|facet| 0.5 * facet.area_m2))?;
        given.set_item("normal", vectors(|facet| facet.normal)?)?;
        given.set_item("normal_force", numbers(|facet| facet.normal_n))?;
        given.set_item("slip", vectors(|facet| facet.slip_m)?)?;
        given.set_item("shear", vectors(|facet| facet.shear_n)?)?;
        given.set_item("state", &kept)?;
        let call = self.law.held().as_ref().map(|call| call.clone_ref(py));
        let call = call.ok_or_else(|| PyRuntimeError::new_err("the law is gone, with its simulation"))?;
        let answer = call.bind(py).call1((given,))?;
        let answer: PyReadonlyArray2<'_, f64> = answer.extract()?;
        let answer = answer.as_array();
        for (i, force) in force_n.iter_mut().enumerate() {
            *force = Vec3::new(answer[[i, 0]], answer[[i, 1]], answer[[i, 2]]);
        }
        state.copy_from_slice(kept.readonly().as_slice()?);
        Ok(())
    }
}

/// The exception of a law in Python, where there is one.
pub fn own_or(law: &Law, other: impl FnOnce() -> PyErr) -> PyErr {
    law.0.raised.lock().ok().and_then(|mut raised| raised.take()).unwrap_or_else(other)
}
