//! A simulation that Python steps.

use std::time::{Duration, Instant};

use ndda::driver::{BlockId, Driver, DriverSnapshot, Vec3};
use ndda_solver::{Sample, StepError};
use numpy::{PyArray2, PyReadwriteArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::arrays;
use crate::errors::{scene_error, stop_error};
use crate::scene::Scene;

/// How long steps go on before Ctrl-C is looked for.
const SLICE: Duration = Duration::from_millis(50);

/// A scene on its way through time; `ndda.Simulation` wraps it.
#[pyclass(subclass, module = "ndda._core")]
pub struct Simulation {
    driver: Driver,
    /// Threads of its own, where a number of them was requested.
    pool: Option<ThreadPool>,
}

/// A copy of all that changes in a simulation; `Simulation.restore` takes it.
#[pyclass(frozen, module = "ndda")]
pub struct Snapshot(DriverSnapshot);

/// Does work on the threads of a pool, or of the process.
fn within<R: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> R + Send) -> R {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Steps until `left` is zero or the slice of time is over.
fn slice(driver: &mut Driver, left: &mut u64) -> Result<(), StepError> {
    let began = Instant::now();
    while *left > 0 {
        driver.step(1)?;
        *left -= 1;
        if began.elapsed() >= SLICE {
            break;
        }
    }
    Ok(())
}

fn energies<'py>(py: Python<'py>, sample: &Sample) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in [
        ("kinetic_j", sample.kinetic_j),
        ("strain_j", sample.strain_j),
        ("contact_j", sample.contact_j),
        ("load_j", sample.load_j),
        ("spring_j", sample.spring_j),
        ("total_j", sample.total_j()),
        ("friction_work_j", sample.friction_work_j),
        ("motion_work_j", sample.motion_work_j),
        ("load_work_j", sample.load_work_j),
        ("damping_work_j", sample.damping_work_j),
        ("balance_j", sample.balance_j),
    ] {
        dict.set_item(name, value)?;
    }
    Ok(dict)
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scene, *, threads=None, contacts=false))]
    fn new(py: Python<'_>, scene: &Scene, threads: Option<usize>, contacts: bool) -> PyResult<Self> {
        if threads == Some(0) {
            return Err(PyValueError::new_err("threads is 0: give at least 1, or None for all processors"));
        }
        let pool = threads.map(|count| ThreadPoolBuilder::new().num_threads(count).build()).transpose();
        let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let model = py.detach(|| within(pool.as_ref(), || scene.model())).map_err(|e| scene_error(py, &e))?;
        let driver = py.detach(|| within(pool.as_ref(), || Driver::new(model)));
        let mut driver = driver.map_err(|stop| stop_error(py, &stop))?;
        driver.watch_contacts(contacts);
        Ok(Self { driver, pool })
    }

    /// Takes `n` steps; other Python threads run meanwhile, and Ctrl-C ends it after a step.
    #[pyo3(signature = (n=1))]
    fn step(&mut self, py: Python<'_>, n: u64) -> PyResult<()> {
        let Self { driver, pool } = self;
        let mut left = n;
        loop {
            let done = py.detach(|| within(pool.as_ref(), || slice(driver, &mut left)));
            done.map_err(|stop| stop_error(py, &stop))?;
            if left == 0 {
                return Ok(());
            }
            py.check_signals()?;
        }
    }

    /// Steps done.
    #[getter]
    fn step_count(&self) -> u64 {
        self.driver.simulation().state().step
    }

    /// Steps to the end of the scene.
    #[getter]
    fn steps(&self) -> u64 {
        self.driver.steps()
    }

    /// Time step [s].
    #[getter]
    fn step_s(&self) -> f64 {
        self.driver.simulation().step_s()
    }

    /// Time [s].
    #[getter]
    fn time_s(&self) -> f64 {
        self.driver.simulation().time_s()
    }

    /// Names of the blocks, in the order of the scene.
    #[getter]
    fn block_names(&self) -> Vec<String> {
        self.driver.simulation().blocks().names.clone()
    }

    /// First node of each block, and the number of nodes at the end.
    fn _node_starts(&self) -> Vec<u32> {
        self.driver.simulation().blocks().node_starts().to_vec()
    }

    /// A quantity of the nodes, in a new read-only array, or in `out`.
    fn _nodes<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.usable(py)?;
        let mut rows = vec![[0.0; 3]; self.driver.simulation().state().position.len()];
        arrays::each_node(self.driver.simulation(), name, |i, value| rows[i] = value)?;
        arrays::rows(py, rows)
    }

    /// Writes a quantity of the nodes to an array.
    fn _fill_nodes(&self, py: Python<'_>, name: &str, mut out: PyReadwriteArray2<'_, f64>) -> PyResult<()> {
        self.usable(py)?;
        arrays::fill(self.driver.simulation(), name, &mut out)
    }

    /// Cauchy stress xx, yy, zz, xy, yz, zx of each tetrahedron [Pa].
    #[getter]
    fn stress<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let stress = self.driver.stress_pa().map_err(|stop| stop_error(py, &stop))?;
        arrays::rows(py, stress)
    }

    /// Rows of contacts.
    fn _contacts<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.usable(py)?;
        arrays::rows(py, self.driver.contacts())
    }

    /// Energies and works now [J].
    #[getter]
    fn energies<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sample = self.driver.sample().map_err(|stop| stop_error(py, &stop))?;
        energies(py, &sample)
    }

    /// The label: `accurate`, `inaccurate` or `stopped`.
    #[getter]
    fn label(&mut self) -> &'static str {
        self.driver.label().word.as_str()
    }

    /// Why the label is not `accurate`.
    #[getter]
    fn reasons(&mut self) -> Vec<String> {
        self.driver.label().reasons
    }

    /// CRC-32 of the state, as in `summary.json`.
    #[getter]
    fn state_crc32(&self) -> String {
        self.driver.state_crc32()
    }

    /// Lets a force act at the centre of mass of a block from now on.
    fn _set_force(&mut self, py: Python<'_>, block: u32, force_n: [f64; 3]) -> PyResult<()> {
        self.usable(py)?;
        let done = self.driver.set_force(BlockId(block), Vec3::from(force_n));
        done.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Gives a block a velocity and a spin now.
    fn _set_velocity(
        &mut self,
        py: Python<'_>,
        block: u32,
        velocity_m_s: [f64; 3],
        spin_rad_s: [f64; 3],
    ) -> PyResult<()> {
        self.usable(py)?;
        let done = self.driver.set_velocity(BlockId(block), Vec3::from(velocity_m_s), Vec3::from(spin_rad_s));
        done.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// A copy of all that changes.
    fn snapshot(&self) -> Snapshot {
        Snapshot(self.driver.snapshot())
    }

    /// Goes on from a snapshot of the same scene, bit for bit.
    fn restore(&mut self, snapshot: &Snapshot) -> PyResult<()> {
        self.driver.restore(&snapshot.0).map_err(|error| PyValueError::new_err(error.to_string()))
    }
}

impl Simulation {
    /// Refuses to show a state that a step left half done.
    fn usable(&self, py: Python<'_>) -> PyResult<()> {
        self.driver.stopped().map_or(Ok(()), |stop| Err(stop_error(py, stop)))
    }
}
