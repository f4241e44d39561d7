//! A simulation that Python steps.

use std::path::PathBuf;

use ndda::driver::{BlockId, ChangeError, Driver, DriverRestoreError, DriverSnapshot, Vec3};
use numpy::{PyArray1, PyArray2, PyReadwriteArray2};
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::ThreadPool;

use crate::arrays;
use crate::begin::{begun, saved};
use crate::errors::{scene_error, stop_error};
use crate::law::{self, Raised, own_or};
use crate::scene::{Scene, warnings};
use crate::watched::{judged, pool, slice, within};

/// A scene on its way through time; `ndda.Simulation` wraps it.
#[pyclass(subclass, module = "ndda._core")]
pub struct Simulation {
    driver: Driver,
    /// Threads of its own, where a number of them was requested.
    pool: Option<ThreadPool>,
    /// The exception of a law in Python.
    raised: Raised,
}

/// A copy of all that changes in a simulation; `Simulation.restore` takes it.
///
/// Examples
/// --------
/// >>> import ndda
/// >>> isinstance(ndda.Simulation(ndda.parse(ndda.EXAMPLE)).snapshot(), ndda.Snapshot)
/// True
#[pyclass(frozen, module = "ndda")]
pub struct Snapshot(DriverSnapshot);

#[pymethods]
impl Simulation {
    /// A scene at its start, or where a saved simulation was.
    #[new]
    #[pyo3(signature = (source, *, threads=None, contacts=false, law=None, law_state=0, law_stiffness=0.0))]
    fn new(
        py: Python<'_>,
        source: &Bound<'_, PyAny>,
        threads: Option<usize>,
        contacts: bool,
        law: Option<&Bound<'_, PyAny>>,
        law_state: usize,
        law_stiffness: f64,
    ) -> PyResult<Self> {
        // A law is called in a thread of the pool, where Ctrl-C does not break a step off.
        let pool = pool(threads.or(law.map(|_| rayon::current_num_threads())))?;
        let (parts, raised) = law.map(|law| law::parts(law, law_state, law_stiffness)).unzip();
        let raised = raised.unwrap_or_default();
        let mut driver = match source.cast::<Scene>() {
            Ok(scene) => begun(py, scene.get(), pool.as_ref(), parts, &raised)?,
            Err(_) => saved(py, &source.extract::<PathBuf>()?, pool.as_ref(), parts)?,
        };
        driver.watch_contacts(contacts);
        Ok(Self { driver, pool, raised })
    }

    /// Takes `n` steps; other Python threads run meanwhile, and Ctrl-C ends it after a step.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.step(3)
    /// >>> simulation.step_count
    /// 3
    #[pyo3(signature = (n=1))]
    fn step(&mut self, py: Python<'_>, n: u64) -> PyResult<()> {
        let mut left = n;
        loop {
            self.some_steps(py, &mut left)?;
            if left == 0 {
                return Ok(());
            }
            py.check_signals()?;
        }
    }

    /// Takes at most `n` steps, as many as there is time for between two looks at the clock; returns how many are left.
    fn _some_steps(&mut self, py: Python<'_>, n: u64) -> PyResult<u64> {
        let mut left = n;
        self.some_steps(py, &mut left)?;
        py.check_signals().map(|()| left)
    }

    /// Scene, changes included.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.scene.title
    /// 'A block falls for a second'
    #[getter]
    fn scene(&self) -> Scene {
        let model = self.driver.model();
        Scene { loaded: model.loaded.clone(), folder: model.folder.clone() }
    }

    /// Warnings of the scene.
    fn _warnings<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        warnings(py, &self.driver.model().loaded)
    }

    /// Steps done.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.step_count
    /// 0
    #[getter]
    fn step_count(&self) -> u64 {
        self.driver.simulation().state().step
    }

    /// Steps to the end of the scene.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.steps
    /// 100
    #[getter]
    fn steps(&self) -> u64 {
        self.driver.steps()
    }

    /// Time step [s].
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.step_s
    /// 0.01
    #[getter]
    fn step_s(&self) -> f64 {
        self.driver.simulation().step_s()
    }

    /// Time [s].
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.step(5)
    /// >>> simulation.time_s
    /// 0.05
    #[getter]
    fn time_s(&self) -> f64 {
        self.driver.simulation().time_s()
    }

    /// Names of the blocks, in the order of the scene.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.block_names
    /// ['block']
    #[getter]
    fn block_names(&self) -> Vec<String> {
        self.driver.simulation().blocks().names.clone()
    }

    /// First node of each block, and the number of nodes at the end.
    fn _node_starts(&self) -> Vec<u32> {
        self.driver.simulation().blocks().node_starts().to_vec()
    }

    /// Mass centre of each block [m].
    fn _centers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.usable(py)?;
        let simulation = self.driver.simulation();
        let (blocks, position) = (simulation.blocks(), &simulation.state().position);
        let center = |block| {
            let own = &position[blocks.nodes_of(block)];
            (simulation.shape(block).operator.center(own) + blocks.origin_m).into()
        };
        arrays::rows(py, blocks.ids().map(center).collect())
    }

    /// Mass of each block [kg].
    fn _masses<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let simulation = self.driver.simulation();
        let masses = simulation.blocks().ids().map(|block| simulation.shape(block).operator.mass_kg);
        PyArray1::from_vec(py, masses.collect())
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

    /// Cauchy stress xx, yy, zz, xy, yz, zx of each tetrahedron [Pa], shape (tetrahedra, 6), a read-only copy.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.stress.shape
    /// (6, 6)
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
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.run()
    /// >>> round(simulation.energies["kinetic_j"])
    /// 125107
    #[getter]
    fn energies<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sample = self.driver.sample().map_err(|stop| stop_error(py, &stop))?;
        let dict = PyDict::new(py);
        arrays::energies(&sample).into_iter().try_for_each(|(name, value)| dict.set_item(name, value))?;
        Ok(dict)
    }

    /// The label: `accurate`, `inaccurate`, `sensitive` or `stopped`.
    ///
    /// After the last step it is that of `ndda run`, which runs some scenes again: where blocks hit several times or disturb each
    /// other, this takes as long as the run, once. After forces, velocities or changes of what acts on blocks, and with a law of
    /// one's own, steps cannot be taken again: where blocks hit several times, the label is then `inaccurate`, since errors of
    /// impacts may have grown. Before the last step, it judges the steps that were taken.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.label
    /// 'accurate'
    #[getter]
    fn label(&mut self, py: Python<'_>) -> PyResult<&'static str> {
        Ok(judged(py, self.pool.as_ref(), &mut self.driver)?.word.as_str())
    }

    /// Why the label is not `accurate`, or what of an `accurate` simulation is not known.
    ///
    /// The second is so where blocks may disturb each other, and steps cannot be taken again from a slightly different start (see
    /// `label`).
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.reasons
    /// []
    #[getter]
    fn reasons(&mut self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(judged(py, self.pool.as_ref(), &mut self.driver)?.reasons)
    }

    /// CRC-32 of the state, as in `summary.json`.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.run()
    /// >>> simulation.state_crc32 == ndda.run(simulation.scene)["state_crc32"]
    /// True
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

    /// Changes values of the scene from now on.
    fn _change(&mut self, py: Python<'_>, overrides: Vec<String>) -> PyResult<()> {
        let Self { driver, pool, raised } = self;
        let done = py.detach(|| within(pool.as_ref(), || driver.change(&overrides)));
        done.map_err(|error| match &error {
            ChangeError::Scene(errors) => scene_error(py, errors),
            ChangeError::Stopped(stop) => stop_error(py, stop),
            other => own_or(raised, || PyValueError::new_err(other.to_string())),
        })
    }

    /// Writes scene and state to a file, whole or not at all; `ndda.resume` goes on from it.
    ///
    /// Examples
    /// --------
    /// >>> import pathlib, tempfile
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.save(pathlib.Path(tempfile.mkdtemp()) / "state")
    fn save(&self, py: Python<'_>, file: PathBuf) -> PyResult<()> {
        self.usable(py)?;
        self.driver.save(&file).map_err(|error| PyOSError::new_err(error.to_string()))
    }

    /// A frame of the present state as the content of a VTK file.
    fn _frame<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.usable(py)?;
        let frame = self.driver.frame().map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(PyBytes::new(py, &frame))
    }

    /// Samples of the energies so far, as rows of numbers.
    fn _history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::rows(py, self.driver.history().iter().map(arrays::sample_row).collect())
    }

    /// A copy of all that changes.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> kept = simulation.snapshot()
    /// >>> simulation.step(10)
    /// >>> simulation.restore(kept)
    /// >>> simulation.step_count
    /// 0
    fn snapshot(&self) -> Snapshot {
        Snapshot(self.driver.snapshot())
    }

    /// Goes on from a snapshot of the same scene, bit for bit.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.restore(simulation.snapshot())
    fn restore(&mut self, py: Python<'_>, snapshot: &Snapshot) -> PyResult<()> {
        self.driver.restore(&snapshot.0).map_err(|error| match &error {
            DriverRestoreError::Scene(errors) => scene_error(py, errors),
            other => PyValueError::new_err(other.to_string()),
        })
    }
}

impl Simulation {
    /// Takes steps for a slice of time.
    fn some_steps(&mut self, py: Python<'_>, left: &mut u64) -> PyResult<()> {
        let Self { driver, pool, raised } = self;
        let done = py.detach(|| within(pool.as_ref(), || slice(driver, left)));
        done.map_err(|stop| own_or(raised, || stop_error(py, &stop)))
    }

    /// Refuses to show a state that a step left half done.
    fn usable(&self, py: Python<'_>) -> PyResult<()> {
        self.driver.stopped().map_or(Ok(()), |stop| Err(stop_error(py, stop)))
    }
}
