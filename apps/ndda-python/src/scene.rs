//! A scene that has been read and checked.

use std::path::{Path, PathBuf};

use ndda::driver::Parts;
use ndda::{Model, Run};
use ndda_io::diagnostic::SceneErrors;
use ndda_io::read::{self, LoadedScene};
use ndda_io::scene::{Stage, Then, is_unset};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{diagnostic, scene_error, stop_error};
use crate::threads::{SHARED, Threads};
use crate::watched::watched;

/// A scene that has been read and checked; `ndda.load` and `ndda.parse` make it.
///
/// Examples
/// --------
/// >>> import ndda
/// >>> ndda.parse(ndda.EXAMPLE)
/// <ndda.Scene "A block falls for a second", 100 steps of 0.01 s>
#[pyclass(frozen, module = "ndda")]
pub struct Scene {
    pub loaded: LoadedScene,
    /// Folder that the file names of the scene are relative to.
    pub folder: PathBuf,
}

#[pymethods]
impl Scene {
    /// Reads the scene in a file; `overrides` are `path=value`.
    #[staticmethod]
    fn _load(py: Python<'_>, file: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        let folder = file.parent().unwrap_or(Path::new(".")).to_path_buf();
        let loaded = SHARED.run(py, || read::load(&file, &overrides))?;
        Ok(Self { loaded: loaded.map_err(|e| scene_error(py, &e))?, folder })
    }

    /// Reads the scene in a text; files that it names are in `folder`.
    #[staticmethod]
    fn _parse(py: Python<'_>, text: &str, overrides: Vec<String>, folder: PathBuf) -> PyResult<Self> {
        let load = || read::load_text("scene.ron", text, &overrides, Some(&folder));
        Ok(Self { loaded: SHARED.run(py, load)?.map_err(|e| scene_error(py, &e))?, folder })
    }

    /// Title of the scene.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> ndda.parse(ndda.EXAMPLE).title
    /// 'A block falls for a second'
    #[getter]
    fn title(&self) -> &str {
        &self.loaded.scene.title
    }

    /// Text of the scene in RON, overrides included.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> ndda.parse(ndda.EXAMPLE).text == ndda.EXAMPLE
    /// True
    #[getter]
    fn text(&self) -> &str {
        &self.loaded.text
    }

    /// The file that it was read from, or `scene.ron` of a text.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> ndda.parse(ndda.EXAMPLE).file
    /// 'scene.ron'
    #[getter]
    fn file(&self) -> &str {
        &self.loaded.file
    }

    /// Folder that the file names of the scene are relative to.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> str(ndda.parse(ndda.EXAMPLE).folder)
    /// '.'
    #[getter]
    fn folder(&self) -> PathBuf {
        self.folder.clone()
    }

    /// Time step [s]; None where the scene leaves it out, and it is chosen when a simulation is built: `Simulation.step_s` has it.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> ndda.parse(ndda.EXAMPLE).step_s
    /// 0.01
    #[getter]
    fn step_s(&self) -> Option<f64> {
        Some(self.loaded.scene.time.step_s).filter(|step_s| !is_unset(step_s))
    }

    /// Time at which a run of the scene ends [s], stages included; None where a stage settles, which takes as long as it takes.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> ndda.parse(ndda.EXAMPLE).end_s
    /// 1.0
    #[getter]
    fn end_s(&self) -> Option<f64> {
        let scene = &self.loaded.scene;
        let stages_s: f64 = scene.stages.iter().map(Stage::time_s).sum();
        (!self.settles_later()).then_some(scene.time.end_s + stages_s)
    }

    /// Steps to the end of the scene, stages included; None where they are not known before, as `step_s` or `end_s` is not.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> ndda.parse(ndda.EXAMPLE).steps
    /// 100
    #[getter]
    fn steps(&self) -> Option<u64> {
        let is_known = self.step_s().is_some() && !self.settles_later();
        is_known.then(|| ndda::build::all_steps(&self.loaded.scene))
    }

    /// Builds the scene and returns its warnings, as dictionaries like those of `SceneError.diagnostics`.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> ndda.parse(ndda.EXAMPLE).check()
    /// []
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let model = self.built(py, &SHARED)?;
        warnings(py, &model.loaded)
    }

    /// The scene with all that it leaves out, as JSON.
    fn _json(&self) -> PyResult<String> {
        serde_json::to_string(&self.loaded.scene).map_err(|error| PyRuntimeError::new_err(error.to_string()))
    }

    /// The scene as objects of `ndda.builders`, with all that it leaves out.
    ///
    /// Examples
    /// --------
    /// >>> import ndda
    /// >>> ndda.parse(ndda.EXAMPLE).to_builder().time.integrator
    /// Integrator.Midpoint(theta=0.5)
    fn to_builder<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let dictionary = py.import("json")?.call_method1("loads", (self._json()?,))?;
        py.import("ndda.builders")?.getattr("Scene")?.call_method1("from_dict", (dictionary,))
    }

    /// Runs the scene to its end without files; the result is the text of `summary.json`.
    #[pyo3(signature = (threads=None))]
    fn _run(&self, py: Python<'_>, threads: Option<i64>) -> PyResult<String> {
        let outcome = watched(py, &Threads::new(threads)?, |watch| {
            self.model(None).map(Run::new).map(|run| {
                let run = run.stop_when(watch.stop.clone());
                run.finish(&mut []).map(|outcome| outcome.summary)
            })
        })?;
        let summary = outcome.map_err(|e| scene_error(py, &e))?.map_err(|error| match &error {
            ndda::RunError::Settling(stop) => stop_error(py, stop),
            other => PyRuntimeError::new_err(other.to_string()),
        })?;
        serde_json::to_string(&summary).map_err(|error| PyRuntimeError::new_err(error.to_string()))
    }

    fn __repr__(&self) -> String {
        let length = match (self.steps(), self.step_s(), self.end_s()) {
            (Some(steps), Some(step_s), _) => format!("{steps} steps of {step_s} s"),
            (_, Some(step_s), _) => format!("steps of {step_s} s and stages that settle"),
            (_, None, Some(end_s)) => format!("{end_s} s"),
            (_, None, None) => "stages that settle".into(),
        };
        format!("<ndda.Scene {:?}, {length}>", self.title())
    }
}

impl Scene {
    /// Whether a stage brings the scene to rest, which takes as many steps as it takes.
    fn settles_later(&self) -> bool {
        self.loaded.scene.stages.iter().any(|stage| matches!(stage.then, Then::Settle { .. }))
    }

    /// Whether the scene has stages of construction.
    pub fn has_stages(&self) -> bool {
        !self.loaded.scene.stages.is_empty()
    }

    /// The scene with its simulation at the start, built on threads.
    pub fn built(&self, py: Python<'_>, threads: &Threads) -> PyResult<Model> {
        threads.run(py, || self.model(None))?.map_err(|e| scene_error(py, &e))
    }

    /// The scene with its simulation at the start.
    pub fn model(&self, parts: Option<&Parts>) -> Result<Model, SceneErrors> {
        let choices = parts.map_or_else(Default::default, |make| make());
        Model::with(self.loaded.clone(), &self.folder, choices)
    }
}

/// Warnings of a scene as dictionaries.
pub fn warnings<'py>(py: Python<'py>, loaded: &LoadedScene) -> PyResult<Vec<Bound<'py, PyDict>>> {
    loaded.warnings.iter().map(|found| diagnostic(py, &loaded.text, found)).collect()
}
