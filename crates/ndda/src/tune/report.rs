//! The result of tuning: as `tune.json`, and in words.

use std::fmt::Write as _;
use std::path::Path;

use ndda_io::WriteError;
use serde::Serialize;

use crate::columns::columns;
use crate::documents::write_json;
use crate::study::emit::quoted;

/// Schema of `tune.json`; it changes when a key does.
pub const SCHEMA: &str = "ndda.tune/1";

/// Everything that `tune.json` says.
#[derive(Clone, Debug, Serialize)]
pub struct Tuned {
    /// Its form.
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Title of the scene.
    pub title: String,
    /// The relative error that was asked for.
    pub target: f64,
    /// Reference of errors, in words.
    pub judged_by: String,
    /// The cheapest setting that reaches the error; the most exact one where none does.
    pub best: Option<TrialPoint>,
    /// Whether it reaches the error.
    pub is_reached: bool,
    /// All that was tried, in its order.
    pub tried: Vec<TrialPoint>,
    /// Remarks for the reader.
    pub remarks: Vec<String>,
    /// Wall time of all runs [s].
    pub wall_s: f64,
    /// Processor time of all runs, or wall time where the system does not tell [s].
    pub spent_s: f64,
}

/// A setting that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrialPoint {
    /// Its choices in a few words.
    pub label: String,
    /// Its step [s].
    pub step_s: f64,
    /// Values that it sets, as `--set` takes them.
    pub set: Vec<String>,
    /// Cost: processor time, or wall time where the system does not tell [s]. None where it failed.
    pub time_s: Option<f64>,
    /// Its relative error. None where it failed.
    pub error: Option<f64>,
    /// Why it failed.
    pub reason: Option<String>,
    /// Whether nothing that was tried is both faster and more exact.
    pub on_front: bool,
}

impl Tuned {
    /// Writes `tune.json`; returns its text.
    ///
    /// # Errors
    /// [`WriteError`] when it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<String, WriteError> {
        write_json(&folder.join("tune.json"), self)
    }

    /// The result as text.
    pub fn text(&self) -> String {
        let mut text = format!("{}: {}\n", self.scene, self.title);
        let front = |point: &&TrialPoint| point.on_front;
        text += &self.table(
            "the best settings, none of which another beats in both error and time:",
            self.tried.iter().filter(front),
        );
        text += &self.table("all that was tried:", self.tried.iter().filter(|point| point.error.is_some()));
        for point in self.tried.iter().filter(|point| point.reason.is_some()) {
            let reason = point.reason.as_deref().unwrap_or_default();
            let _ = writeln!(text, "failed: {}, step {:.3e} s: {reason}", point.label, point.step_s);
        }
        let _ = writeln!(text, "errors are {}", self.judged_by);
        self.remarks.iter().for_each(|remark| {
            let _ = writeln!(text, "note: {remark}");
        });
        let _ = writeln!(text, "time spent: {:.2} s, {:.2} s of processor time", self.wall_s, self.spent_s);
        text += &self.verdict();
        text
    }

    fn table<'a>(&self, title: &str, points: impl Iterator<Item = &'a TrialPoint>) -> String {
        let mut points: Vec<&TrialPoint> = points.collect();
        points
            .sort_by(|a, b| a.time_s.unwrap_or(f64::INFINITY).total_cmp(&b.time_s.unwrap_or(f64::INFINITY)));
        let row = |point: &&TrialPoint| {
            let [time, error] = [point.time_s, point.error].map(|value| value.unwrap_or(f64::NAN));
            vec![
                point.label.clone(),
                format!("{:.3e} s", point.step_s),
                format!("{error:.1e}"),
                format!("{time:.3} s"),
            ]
        };
        let header = ["setting", "step", "error", "time"].map(String::from).to_vec();
        format!("{title}\n{}\n", columns(header, points.iter().map(row).collect()))
    }

    /// The setting that was found.
    fn verdict(&self) -> String {
        let Some(best) = &self.best else { return "no setting runs to its end\n".into() };
        let (time_s, error) = (best.time_s.unwrap_or(0.0), best.error.unwrap_or(0.0));
        let mut text = match self.is_reached {
            true => {
                format!("the cheapest for an error of {:e}: {time_s:.3} s, error {error:.1e}\n", self.target)
            }
            false => format!(
                "no setting reaches an error of {:e}; the most exact one, {error:.1e} in {time_s:.3} s:\n",
                self.target
            ),
        };
        best.set.iter().for_each(|one| {
            let _ = writeln!(text, "  --set {}", quoted(one));
        });
        text
    }
}
