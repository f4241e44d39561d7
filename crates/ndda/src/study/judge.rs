//! Compares what has run with a closed form, or with two runs that agree.

use ndda_io::read::LoadedScene;
use ndda_io::study::Reference;
use ndda_io::table::Table;
use serde_json::Value;

use super::case::Case;
use super::difference::{Difference, difference};
use super::error::StudyError;
use super::launch::{Launch, clocked, least};
use super::record::{RESULTS, Record, RunOutcome, folder};
use super::result::{CasePoint, Compared, Figures, Run};
use crate::summary::Named;

/// Reference runs must agree this many times better than the smallest error that is distinguished from zero.
const AGREE: f64 = 5.0;

/// Judge of results.
pub enum Judge {
    /// The closed form that the scene names.
    ClosedForm,
    /// Two runs.
    Runs { first: Table, step_s: f64, apart: Difference, monitors: Vec<String> },
}

impl Judge {
    /// Reads the reference runs, if the study has any, and compares them.
    ///
    /// # Errors
    /// [`StudyError`] when one of them has not run, failed, or cannot be compared.
    pub fn new(launch: &Launch, references: &[Case]) -> Result<Self, StudyError> {
        let Reference::Runs { monitors, .. } = &launch.loaded.study.reference else {
            return Ok(Self::ClosedForm);
        };
        let (first, scene) = reference_history(launch, &references[0])?;
        let (second, _) = reference_history(launch, &references[1])?;
        let all = || scene.scene.monitors.iter().map(|monitor| monitor.name.clone()).collect();
        let monitors = monitors.clone().unwrap_or_else(all);
        let apart = difference(&second, &first, &monitors)
            .map_err(|source| StudyError::Difference { name: references[1].name.clone(), source })?;
        Ok(Self::Runs { first, step_s: scene.scene.time.step_s, apart, monitors })
    }

    /// Reference of relative errors; `kind` is the name of the closed form.
    pub fn compared(&self, kind: String) -> Compared {
        match self {
            Self::ClosedForm => Compared::ClosedForm { name: kind },
            Self::Runs { step_s, apart, .. } => Compared::Runs {
                step_s: *step_s,
                disagreement_end: apart.end,
                disagreement_max: apart.max,
                floor_end: AGREE * apart.end,
                floor_max: AGREE * apart.max,
            },
        }
    }

    /// The point of a case that has run; `kind` becomes the name of the closed form.
    ///
    /// # Errors
    /// [`StudyError`] when there is nothing to compare with.
    pub fn point(
        &self,
        launch: &Launch,
        case: &Case,
        record: Record,
        kind: &mut String,
    ) -> Result<CasePoint, StudyError> {
        let (walls_s, processors_s, summary) = match record.outcome {
            RunOutcome::Failed { reason, .. } => return Ok(CasePoint::failed(case, reason)),
            RunOutcome::Done { walls_s, processors_s, summary } => (walls_s, processors_s, summary),
        };
        let apart = match self {
            Self::ClosedForm => {
                let reference = &summary["reference"];
                let error = |key: &str| reference[key].as_f64();
                let (Some(end), Some(max)) = (error("error_end"), error("error_max")) else {
                    return Err(StudyError::NoReference(launch.loaded.scene.clone()));
                };
                *kind = reference["kind"].as_str().unwrap_or_default().into();
                Difference { end, max }
            }
            Self::Runs { first, monitors, .. } => difference(&history(launch, case)?, first, monitors)
                .map_err(|source| StudyError::Difference { name: case.name.clone(), source })?,
        };
        let beyond_limits = beyond_limits(&summary);
        let run: Run = serde_json::from_value(summary).map_err(|e| StudyError::Record {
            file: folder(launch.out, &case.name),
            reason: e.to_string(),
        })?;
        let time_s = least(clocked(launch.loaded.study.clock, &walls_s, &processors_s)?);
        let (error_end, error_max, wall_s, on_front) = (apart.end, apart.max, least(&walls_s), [false; 2]);
        let figures = Figures {
            error_end,
            error_max,
            on_front,
            time_s,
            wall_s,
            walls_s,
            processors_s,
            beyond_limits,
            run,
        };
        let (name, labels) = (case.name.clone(), Named(case.labels.clone()));
        Ok(CasePoint { name, labels, figures: Some(figures), reason: None })
    }
}

/// Names of the verdicts that failed.
fn beyond_limits(summary: &Value) -> Vec<String> {
    let verdicts = summary["verdicts"].as_object().into_iter().flatten();
    verdicts.filter(|(_, verdict)| verdict["verdict"] == "fail").map(|(name, _)| name.clone()).collect()
}

fn history(launch: &Launch, case: &Case) -> Result<Table, StudyError> {
    let results = folder(launch.out, &case.name).join(RESULTS);
    Ok(Table::read(&results.join(ndda_io::OutputFolder::HISTORY))?)
}

/// History and scene of a reference run.
fn reference_history(launch: &Launch, case: &Case) -> Result<(Table, LoadedScene), StudyError> {
    let refuse = |reason: String| StudyError::Reference { name: case.name.clone(), reason };
    match launch.record(case)?.map(|record| record.outcome) {
        None => Err(refuse("it has not run".into())),
        Some(RunOutcome::Failed { reason, .. }) => Err(refuse(reason)),
        Some(RunOutcome::Done { .. }) => {
            let scene = launch.loaded.scene_with(&case.overrides).map_err(StudyError::Scene)?;
            Ok((history(launch, case)?, scene))
        }
    }
}
