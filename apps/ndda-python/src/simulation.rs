//! A simulation that Python steps.

use std::path::PathBuf;
use std::sync::Mutex;

use ndda::driver::{BlockId, ChangeError, Driver, DriverRestoreError, Vec3};
use numpy::{PyArray1, PyArray2, PyReadwriteArray2};
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays;
use crate::begin::{begun, saved};
use crate::errors::{scene_error, stop_error};
use crate::law::{self, Law, own_or};
use crate::scene::{Scene, warnings};
use crate::snapshot::Snapshot;
use crate::threads::Threads;
use crate::watched::{judged, number_of_steps, slice};

/// A scene on its way through time; `ndda.Simulation` wraps it.
#[pyclass(subclass, frozen, module = "ndda._core")]
pub struct Simulation {
    /// Locked by the thread that steps or looks.
    pub driver: Mutex<Driver>,
    pub threads: Threads,
    law: Law,
}

#[pymethods]
impl Simulation {
    /// A scene at its start, or where a saved simulation was.
    #[new]
    #[pyo3(signature = (source, *, threads=None, contacts=false, law=None, law_name="law".into(), law_numbers=(0, 0.0)))]
    fn new(
        py: Python<'_>,
        source: &Bound<'_, PyAny>,
        threads: Option<i64>,
        contacts: bool,
        law: Option<&Bound<'_, PyAny>>,
        law_name: String,
        law_numbers: (usize, f64),
    ) -> PyResult<Self> {
        // A law is called in a thread of the pool, where Ctrl-C does not break a step off.
        let threads = Threads::new(threads.or(law.map(|_| rayon::current_num_threads() as i64)))?;
        let parts = law.map(|law| law::parts(law, law_name, law_numbers));
        let (parts, law) = parts.unzip();
        let law: Law = law.unwrap_or_default();
        let mut driver = match source.cast::<Scene>() {
            Ok(scene) => begun(py, scene.get(), &threads, parts, &law)?,
            Err(_) => saved(py, &source.extract::<PathBuf>()?, &threads, parts)?,
        };
        driver.watch_contacts(contacts);
        Ok(Self { driver: Mutex::new(driver), threads, law })
    }

    /// Shows the law to the collector of garbage: it may refer to its simulation.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.law.traverse(&visit)
    }

    /// Lets go of the law.
    fn __clear__(&self) {
        self.law.clear();
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
    #[pyo3(signature = (n=None), text_signature = "($self, n=1)")]
    fn step(&self, py: Python<'_>, n: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let mut left = n.map_or(Ok(1), number_of_steps)?;
        while left > 0 {
            left = self._some_steps(py, left)?;
        }
        Ok(())
    }

    /// Takes at most `n` steps, as many as there is time for between two looks at the clock; returns how many are left.
    fn _some_steps(&self, py: Python<'_>, n: u64) -> PyResult<u64> {
        let mut left = n;
        let done = self.on_driver(py, |driver| slice(driver, &mut left))?;
        done.map_err(|stop| own_or(&self.law, || stop_error(py, &stop)))?;
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
    fn scene(&self) -> PyResult<Scene> {
        let driver = self.driver()?;
        let model = driver.model();
        Ok(Scene { loaded: model.loaded.clone(), folder: model.folder.clone() })
    }

    /// Warnings of the scene.
    fn _warnings<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        warnings(py, &self.driver()?.model().loaded)
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
    fn step_count(&self) -> PyResult<u64> {
        Ok(self.driver()?.simulation().state().step)
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
    fn steps(&self) -> PyResult<u64> {
        Ok(self.driver()?.steps())
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
    fn step_s(&self) -> PyResult<f64> {
        Ok(self.driver()?.simulation().step_s())
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
    fn time_s(&self) -> PyResult<f64> {
        Ok(self.driver()?.simulation().time_s())
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
    fn block_names(&self) -> PyResult<Vec<String>> {
        Ok(self.driver()?.simulation().blocks().names.clone())
    }

    /// First node of each block, and the number of nodes at the end.
    fn _node_starts(&self) -> PyResult<Vec<u32>> {
        Ok(self.driver()?.simulation().blocks().node_starts().to_vec())
    }

    /// First tetrahedron of each block, and the number of tetrahedra at the end.
    fn _tet_starts(&self) -> PyResult<Vec<usize>> {
        Ok(arrays::tet_starts(self.driver()?.simulation()))
    }

    /// Nodes of each tetrahedron, rows of the arrays of nodes, shape (tetrahedra, 4), a read-only copy.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.tetrahedra.shape
    /// (6, 4)
    #[getter]
    fn tetrahedra<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        arrays::rows(py, arrays::tetrahedra(self.driver()?.simulation()))
    }

    /// Mass centre of each block [m].
    fn _centers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::rows(py, arrays::centers(self.usable(py)?.simulation()))
    }

    /// Mass of each block [kg].
    fn _masses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, arrays::masses_kg(self.driver()?.simulation())))
    }

    /// A quantity of the nodes, in a new read-only array, or in `out`.
    fn _nodes<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let driver = self.usable(py)?;
        let mut rows = vec![[0.0; 3]; driver.simulation().state().position.len()];
        arrays::each_node(driver.simulation(), name, |i, value| rows[i] = value)?;
        arrays::rows(py, rows)
    }

    /// Writes a quantity of the nodes to an array.
    fn _fill_nodes(&self, py: Python<'_>, name: &str, mut out: PyReadwriteArray2<'_, f64>) -> PyResult<()> {
        arrays::fill(self.usable(py)?.simulation(), name, &mut out)
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
    fn stress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let stress = self.on_driver(py, Driver::stress_pa)?.map_err(|stop| stop_error(py, &stop))?;
        arrays::rows(py, stress)
    }

    /// Rows of contacts.
    fn _contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        drop(self.usable(py)?);
        arrays::rows(py, self.on_driver(py, Driver::contacts)?)
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
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sample = self.on_driver(py, Driver::sample)?.map_err(|stop| stop_error(py, &stop))?;
        let dict = PyDict::new(py);
        arrays::energies(&sample).into_iter().try_for_each(|(name, value)| dict.set_item(name, value))?;
        Ok(dict)
    }

    /// The label: `accurate`, `inaccurate`, `sensitive` or `stopped`.
    ///
    /// After the last step it is that of `ndda run`, which runs some scenes again: where blocks hit several times, disturb each
    /// other or cannot touch, and where steps are few, this takes as long as the run or twice as long, once. After forces,
    /// velocities or changes of what acts on blocks, and with a law of one's own, steps cannot be taken again: where blocks hit
    /// several times, the label is then `inaccurate`, since errors of impacts may have grown. Where something is set again and again,
    /// at most ten steps apart, it always is: errors of what is set so are not judged, and halve with the step. Before the last
    /// step, it judges the steps that were taken.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.label
    /// 'accurate'
    #[getter]
    fn label(&self, py: Python<'_>) -> PyResult<&'static str> {
        Ok(judged(py, &self.threads, &mut *self.driver()?)?.word.as_str())
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
    fn reasons(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(judged(py, &self.threads, &mut *self.driver()?)?.reasons)
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
    fn state_crc32(&self, py: Python<'_>) -> PyResult<String> {
        self.on_driver(py, |driver| driver.state_crc32())
    }

    /// Lets a force act at the centre of mass of a block from now on.
    fn _set_force(&self, py: Python<'_>, block: u32, force_n: [f64; 3]) -> PyResult<()> {
        let done = self.usable(py)?.set_force(BlockId(block), Vec3::from(force_n));
        done.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Gives a block a velocity and a spin now.
    fn _set_velocity(
        &self,
        py: Python<'_>,
        block: u32,
        velocity_m_s: [f64; 3],
        spin_rad_s: [f64; 3],
    ) -> PyResult<()> {
        let (velocity_m_s, spin_rad_s) = (Vec3::from(velocity_m_s), Vec3::from(spin_rad_s));
        let done = self.usable(py)?.set_velocity(BlockId(block), velocity_m_s, spin_rad_s);
        done.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Changes values of the scene from now on.
    fn _change(&self, py: Python<'_>, overrides: Vec<String>) -> PyResult<()> {
        let done = self.on_driver(py, |driver| driver.change(&overrides))?;
        done.map_err(|error| match &error {
            ChangeError::Scene(errors) => scene_error(py, errors),
            ChangeError::Stopped(stop) => stop_error(py, stop),
            other => own_or(&self.law, || PyValueError::new_err(other.to_string())),
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
        drop(self.usable(py)?);
        self.on_driver(py, |driver| driver.save(&file))?
            .map_err(|error| PyOSError::new_err(error.to_string()))
    }

    /// A frame of the present state as the content of a VTK file.
    fn _frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        drop(self.usable(py)?);
        let frame =
            self.on_driver(py, Driver::frame)?.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(PyBytes::new(py, &frame))
    }

    /// Samples of the energies so far, as rows of numbers.
    fn _history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::rows(py, self.driver()?.history().iter().map(arrays::sample_row).collect())
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
    fn snapshot(&self, py: Python<'_>) -> PyResult<Snapshot> {
        Ok(Snapshot(self.on_driver(py, |driver| driver.snapshot())?))
    }

    /// Goes on from a snapshot of the same scene, bit for bit.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    /// >>> simulation.restore(simulation.snapshot())
    fn restore(&self, py: Python<'_>, snapshot: &Snapshot) -> PyResult<()> {
        self.on_driver(py, |driver| driver.restore(&snapshot.0))?.map_err(|error| match &error {
            DriverRestoreError::Scene(errors) => scene_error(py, errors),
            other => PyValueError::new_err(other.to_string()),
        })
    }
}
