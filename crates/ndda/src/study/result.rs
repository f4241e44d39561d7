//! The results of a study: a point per case, its errors and figures, and the fronts.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::case::Case;
use super::front::Point;
use crate::summary::{Invariants, Label, Named, ReferenceError};

/// Everything that a study has found.
pub struct Results {
    /// Name of the study: its file without the ending.
    pub name: String,
    /// Its title.
    pub title: String,
    /// Name of the scene's file.
    pub scene: String,
    /// Axes that distinguish curves.
    pub curves: Vec<String>,
    /// Cost of a run: `wall` or `processor` time.
    pub clock: &'static str,
    /// Reference of relative errors.
    pub reference: Compared,
    /// One per case that has run.
    pub points: Vec<CasePoint>,
    /// Cases that have not run.
    pub missing: Vec<String>,
}

/// Reference of relative errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Compared {
    /// A closed form of this name.
    ClosedForm {
        /// Its name in the scene.
        name: String,
    },
    /// Two runs.
    Runs {
        /// Their step [s].
        step_s: f64,
        /// How far they are apart at the end, relative.
        disagreement_end: f64,
        /// How far they are apart at most, relative.
        disagreement_max: f64,
        /// Errors at the end below this are not distinguished.
        floor_end: f64,
        /// Largest errors below this are not distinguished.
        floor_max: f64,
    },
}

impl Compared {
    /// Errors at the end, and largest errors, below which points are not distinguished.
    pub fn floors(&self) -> [f64; 2] {
        match self {
            Self::ClosedForm { .. } => [0.0; 2],
            Self::Runs { floor_end, floor_max, .. } => [*floor_end, *floor_max],
        }
    }
}

/// One case that has run.
#[derive(Clone, Debug, Serialize)]
pub struct CasePoint {
    /// Its name.
    pub name: String,
    /// Choice by axis.
    pub labels: Named<String>,
    /// Results of the case; none if it failed.
    pub figures: Option<Figures>,
    /// Why it failed.
    pub reason: Option<String>,
}

/// Results of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Relative error at the end.
    pub error_end: f64,
    /// Largest relative error over time.
    pub error_max: f64,
    /// Whether no other case is both faster and more exact, at the end and over time.
    pub on_front: [bool; 2],
    /// Time of the fastest run by the study's clock [s].
    pub time_s: f64,
    /// Wall time of the fastest run [s].
    pub wall_s: f64,
    /// Wall time of each run [s].
    pub walls_s: Vec<f64>,
    /// Processor time of each run [s]; none where the system does not report it.
    pub processors_s: Vec<f64>,
    /// Invariants that were beyond their limits.
    pub beyond_limits: Vec<String>,
    /// The fastest run's own report.
    #[serde(flatten)]
    pub run: Run,
}

/// The part of a `summary.json` that a study reads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Version of ndda.
    pub version: String,
    /// The run's label.
    pub label: Label,
    /// The largest violation of each invariant.
    pub invariants: Invariants,
    /// Comparison with the closed form, where the scene names one.
    pub reference: Option<ReferenceError>,
    /// Steps.
    pub steps: u64,
    /// Step [s].
    pub step_s: f64,
    /// Threads.
    pub threads: u64,
    /// Processor, commit, features, memory.
    pub machine: Machine,
    /// Sizes of the problem.
    pub counts: Counts,
    /// Seconds per stage.
    pub stages_s: Map<String, Value>,
}

/// Machine of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor.
    pub processor: String,
    /// Commit of the program.
    pub commit: String,
    /// Its cargo features.
    pub features: Vec<String>,
    /// Most memory held at a time [B].
    pub peak_memory_b: Option<u64>,
}

/// Sizes of the problem.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Blocks.
    pub blocks: u64,
    /// Tetrahedra.
    pub tets: u64,
    /// Unknown displacement components.
    pub dofs: u64,
    /// Pairs that were looked at, over all steps.
    pub candidate_pairs_total: u64,
    /// Pairs that were clipped, over all steps.
    pub clips_total: u64,
}

impl CasePoint {
    /// The point of a case that failed.
    pub fn failed(case: &Case, reason: String) -> Self {
        Self {
            name: case.name.clone(),
            labels: Named(case.labels.clone()),
            figures: None,
            reason: Some(reason),
        }
    }

    /// All its choices.
    pub fn choices(&self) -> String {
        self.labels.0.iter().map(|(_, label)| label.as_str()).collect::<Vec<_>>().join(", ")
    }

    /// Choices of the curve that the point is on.
    pub fn curve(&self, curves: &[String]) -> String {
        let parts =
            self.labels.0.iter().filter(|(axis, _)| curves.contains(axis)).map(|(_, label)| label.as_str());
        parts.collect::<Vec<_>>().join(", ")
    }
}

impl Figures {
    /// Time and error, at the end (0) or the largest over time (1); an error below the floor counts as the floor.
    pub fn point(&self, which: usize, floor: f64) -> Point {
        let error = [self.error_end, self.error_max][which];
        Point { time_s: self.time_s, error: error.max(floor) }
    }
}

impl Results {
    /// Names of the curves, in the order of the cases.
    pub fn curve_names(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for name in self.points.iter().map(|point| point.curve(&self.curves)) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    /// Time and error of the points on a curve, or of all; see [`Figures::point`].
    pub fn time_and_error(&self, curve: Option<&str>, which: usize) -> Vec<Point> {
        let floor = self.reference.floors()[which];
        let on = |point: &&CasePoint| curve.is_none_or(|name| point.curve(&self.curves) == name);
        let points = self.points.iter().filter(on);
        points.filter_map(|point| Some(point.figures.as_ref()?.point(which, floor))).collect()
    }
}
