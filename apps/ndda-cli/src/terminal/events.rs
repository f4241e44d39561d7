//! Events for other programs: one JSON object per line on standard output, as docs/reference/json.md says.

use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, SceneErrors, Severity};
use serde::Serialize;

use crate::exit;
use crate::terminal::console::{colour, complain, say};

/// Schema of `ndda run` and `ndda resume`.
pub const RUN: &str = "ndda.run/2";
/// Schema of `ndda check`.
pub const CHECK: &str = "ndda.check/1";
/// Schema of `ndda mesh`.
pub const MESH: &str = "ndda.mesh/1";
/// Schema of `ndda new`.
pub const NEW: &str = "ndda.new/1";
/// Schema of `ndda plot`.
#[cfg(feature = "plots")]
pub const PLOT: &str = "ndda.plot/1";
/// Schema of `ndda stereonet`.
pub const STEREONET: &str = "ndda.stereonet/1";
/// Schema of `ndda record`.
pub const RECORD: &str = "ndda.record/1";
/// Schema of `ndda picture`.
#[cfg(feature = "plots")]
pub const PICTURE: &str = "ndda.picture/1";
/// Schema of `ndda report` and `ndda view`.
#[cfg(feature = "report")]
pub const REPORT: &str = "ndda.report/1";

/// Where events go: to standard output as lines of a schema, or nowhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Events(Option<&'static str>);

#[derive(Serialize)]
struct Line<'a, T> {
    schema: &'a str,
    event: &'a str,
    #[serde(flatten)]
    body: T,
}

#[derive(Serialize)]
struct Warning<'a> {
    message: &'a str,
}

#[derive(Serialize)]
struct Failed<'a> {
    exit_code: u8,
    message: &'a str,
    diagnostics: Vec<Place<'a>>,
}

/// A message about a scene.
#[derive(Serialize)]
struct Place<'a> {
    severity: &'static str,
    path: &'a str,
    message: &'a str,
    help: Option<&'a str>,
    line: Option<usize>,
    column: Option<usize>,
}

impl Events {
    /// Lines of `schema` if they are requested.
    pub fn new(asked: bool, schema: &'static str) -> Self {
        Self(asked.then_some(schema))
    }

    /// Whether a program reads standard output.
    pub fn are_read(self) -> bool {
        self.0.is_some()
    }

    /// Writes an event with what is to be known of it, an object.
    pub fn emit(self, event: &str, body: &impl Serialize) {
        let Some(schema) = self.0 else { return };
        match serde_json::to_string(&Line { schema, event, body }) {
            Ok(line) => say(&line),
            Err(error) => complain(&format!("warning: the event {event} cannot be written: {error}")),
        }
    }

    /// Says a warning.
    pub fn warn(self, message: &str) {
        complain(&format!("warning: {message}"));
        self.emit("warning", &Warning { message });
    }

    /// Says why there is no result; gives the exit code back.
    pub fn fail(self, exit_code: u8, message: &str) -> u8 {
        complain(&format!("error: {message}"));
        self.emit("failed", &Failed { exit_code, message, diagnostics: Vec::new() });
        exit_code
    }

    /// Says what is wrong with a scene.
    pub fn refuse(self, errors: &SceneErrors) -> u8 {
        complain(&errors.render(colour()));
        let diagnostics = errors.diagnostics.iter().map(|d| place(errors, d)).collect();
        let message = "the scene cannot be used";
        let is_too_large = errors.diagnostics.iter().any(|found| found.code == Code::TooLarge);
        let exit_code = if is_too_large { exit::RESOURCE } else { exit::BAD_INPUT };
        self.emit("failed", &Failed { exit_code, message, diagnostics });
        exit_code
    }

    /// Says what in a scene may not mean what was meant.
    pub fn doubt(self, warnings: &SceneErrors) {
        complain(&warnings.render(colour()));
        for warning in &warnings.diagnostics {
            self.emit("warning", &place(warnings, warning));
        }
    }
}

fn place<'a>(errors: &SceneErrors, diagnostic: &'a Diagnostic) -> Place<'a> {
    let at = diagnostic.line_column(&errors.text);
    Place {
        severity: match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        path: &diagnostic.path,
        message: &diagnostic.message,
        help: diagnostic.help.as_deref(),
        line: at.map(|(line, _)| line),
        column: at.map(|(_, column)| column),
    }
}
