//! Errors of a scene and of a step as Python exceptions, with the program's code, place and advice.

use ndda_io::diagnostic::{Diagnostic, SceneErrors, Severity};
use ndda_solver::StepError;
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

create_exception!(
    ndda,
    SceneError,
    PyValueError,
    "A scene that cannot be used.\n\nThe text is that of the command line. `diagnostics` is a list of dictionaries with `severity`, `code`, `path`,\n`message`, `help`, `line` and `column`; the last three may be None.\n\nExamples\n--------\n>>> import ndda\n>>> try:\n...     ndda.parse('(titel: \"x\")')\n... except ndda.SceneError as error:\n...     error.diagnostics[0]['code']\n'unknown-field'"
);
create_exception!(
    ndda,
    StopError,
    PyRuntimeError,
    "A simulation that cannot go on without giving a wrong number.\n\n`code` is its section in docs/guide/troubleshooting.md.\n\nExamples\n--------\n>>> import ndda\n>>> issubclass(ndda.StopError, RuntimeError)\nTrue"
);

/// A message as a dictionary.
pub fn diagnostic<'py>(py: Python<'py>, text: &str, found: &Diagnostic) -> PyResult<Bound<'py, PyDict>> {
    let place = found.line_column(text);
    let dict = PyDict::new(py);
    let severity = if found.severity == Severity::Error { "error" } else { "warning" };
    dict.set_item("severity", severity)?;
    dict.set_item("code", found.code.to_string())?;
    dict.set_item("path", &found.path)?;
    dict.set_item("message", &found.message)?;
    dict.set_item("help", &found.help)?;
    dict.set_item("line", place.map(|(line, _)| line))?;
    dict.set_item("column", place.map(|(_, column)| column))?;
    Ok(dict)
}

/// Errors of a scene as an exception.
pub fn scene_error(py: Python<'_>, errors: &SceneErrors) -> PyErr {
    let error = SceneError::new_err(errors.render(false).trim_end().to_string());
    let found = errors.diagnostics.iter().map(|found| diagnostic(py, &errors.text, found));
    let set =
        found.collect::<PyResult<Vec<_>>>().and_then(|found| error.value(py).setattr("diagnostics", found));
    set.map_or_else(|failed| failed, |()| error)
}

/// A numerical stop as an exception.
pub fn stop_error(py: Python<'_>, stop: &StepError) -> PyErr {
    let error = StopError::new_err(format!("[{}] {stop}", stop.code()));
    let set = error.value(py).setattr("code", stop.code());
    set.map_or_else(|failed| failed, |()| error)
}
