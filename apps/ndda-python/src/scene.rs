//! A scene that has been read and checked.

use std::path::{Path, PathBuf};

use ndda::{Model, Run};
use ndda_io::diagnostic::SceneErrors;
use ndda_io::read::{self, LoadedScene};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{diagnostic, scene_error, stop_error};

/// A scene that has been read and checked; `ndda.load` and `ndda.parse` make it.
#[pyclass(frozen, module = "ndda")]
pub struct Scene {
    loaded: LoadedScene,
    /// Folder that the file names of the scene are relative to.
    folder: PathBuf,
}

#[pymethods]
impl Scene {
    /// Reads the scene in a file; `overrides` are `path=value`.
    #[staticmethod]
    fn _load(py: Python<'_>, file: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        let folder = file.parent().unwrap_or(Path::new(".")).to_path_buf();
        let loaded = py.detach(|| read::load(&file, &overrides)).map_err(|e| scene_error(py, &e))?;
        Ok(Self { loaded, folder })
    }

    /// Reads the scene in a text; files that it names are in `folder`.
    #[staticmethod]
    fn _parse(py: Python<'_>, text: &str, overrides: Vec<String>, folder: PathBuf) -> PyResult<Self> {
        let loaded = py.detach(|| read::load_text("scene.ron", text, &overrides, Some(&folder)));
        Ok(Self { loaded: loaded.map_err(|e| scene_error(py, &e))?, folder })
    }

    /// Title of the scene.
    #[getter]
    fn title(&self) -> &str {
        &self.loaded.scene.title
    }

    /// Text of the scene in RON, overrides included.
    #[getter]
    fn text(&self) -> &str {
        &self.loaded.text
    }

    /// Time step [s].
    #[getter]
    fn step_s(&self) -> f64 {
        self.loaded.scene.time.step_s
    }

    /// Time at which a run of the scene ends [s].
    #[getter]
    fn end_s(&self) -> f64 {
        self.loaded.scene.time.end_s
    }

    /// Steps to the end of the scene.
    #[getter]
    fn steps(&self) -> u64 {
        ndda::build::steps(&self.loaded.scene.time)
    }

    /// Builds the scene and returns its warnings, as dictionaries like those of `SceneError.diagnostics`.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let model = py.detach(|| self.model()).map_err(|e| scene_error(py, &e))?;
        let loaded = &model.loaded;
        loaded.warnings.iter().map(|found| diagnostic(py, &loaded.text, found)).collect()
    }

    /// Runs the scene to its end without files; the result is the text of `summary.json`.
    fn _run(&self, py: Python<'_>) -> PyResult<String> {
        let model = py.detach(|| self.model()).map_err(|e| scene_error(py, &e))?;
        let outcome = py.detach(|| Run::new(model).finish(&mut []));
        let outcome = outcome.map_err(|error| match &error {
            ndda::RunError::Settling(stop) => stop_error(py, stop),
            other => PyRuntimeError::new_err(other.to_string()),
        })?;
        serde_json::to_string(&outcome.summary).map_err(|error| PyRuntimeError::new_err(error.to_string()))
    }

    fn __repr__(&self) -> String {
        format!("<ndda.Scene {:?}, {} steps of {} s>", self.title(), self.steps(), self.step_s())
    }
}

impl Scene {
    /// The scene with its simulation at the start.
    pub fn model(&self) -> Result<Model, SceneErrors> {
        Model::new(self.loaded.clone(), &self.folder)
    }
}
