//! The cheapest setting of a scene that reaches an error.

pub mod metric;
pub mod report;
pub mod search;
pub mod settings;
pub mod space;

use ndda_io::table::Table;

use crate::certify::Trial;
use crate::certify::error::CertifyError;
use crate::certify::plan::Plan;
use crate::certify::runs::{Ended, read};
use crate::judge::reasons;
use crate::numbers::in_fewest_figures;
use crate::study::case::{Case, plain};
use crate::study::error::StudyError;
use crate::study::front::{Point, front};
use crate::study::launch::Launch;
use crate::study::record::{Cause, RunOutcome};
use crate::summary::LabelWord;
use metric::{Metric, compared, error_of_last};
use report::{SCHEMA, TrialPoint, Tuned};
use search::{Best, Search};
use settings::Settings;
use space::{Outcome, Setting, Space, Trials, Tried};

/// The run that others are compared with is this much more exact than the error that is asked for.
const MORE_EXACT: f64 = 4.0;
/// Part of the budget that it may take.
const FOR_REFERENCE: f64 = 0.5;
/// Settings whose times are measured again, those that are nearly the cheapest.
const MEASURED_AGAIN: usize = 3;
/// How much longer than the cheapest such a setting took.
const NEARLY: f64 = 1.5;
/// Runs of each of them, unless one takes longer than [`LONG_S`].
const REPEATS: u32 = 3;
/// A run whose time needs no second measurement [s].
const LONG_S: f64 = 2.0;

/// Why a scene cannot be tuned.
#[derive(Debug, thiserror::Error)]
pub enum TuneError {
    /// A run cannot be started, recorded or read.
    #[error(transparent)]
    Run(#[from] CertifyError),
    /// Runs of ever shorter steps do not come together.
    #[error(
        "no run is exact enough to judge others by, steps down to {step_s:.3e} s still differ by {error:.1e}: \
         allow a larger --error, raise --budget-s, or name quantities that converge with --of; `ndda certify` says whether \
         the motion is chaotic"
    )]
    NoTruth {
        /// The shortest step [s].
        step_s: f64,
        /// How far it may be off, relative.
        error: f64,
    },
    /// A closed form that says nothing about a run.
    #[error(
        "the scene's closed form was not compared with: time.end_s is before reference.after_s; name what to compare with --of"
    )]
    NoClosedForm,
}

impl From<StudyError> for TuneError {
    fn from(error: StudyError) -> Self {
        Self::Run(error.into())
    }
}

/// The request: target, budget and quantities.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// The largest relative error that is allowed.
    pub error: f64,
    /// Beginnings of names of what has to be right; none for what the scene's closed form judges, else the displacements of
    /// all monitors and blocks.
    pub of: Vec<String>,
    /// Most time that all runs together may take [s].
    pub budget_s: f64,
}

/// Searches for the cheapest setting, runs it, and writes `tune.json` to the trial's folder; returns its text, too.
///
/// # Errors
/// [`TuneError`].
pub fn tune(
    launch: &Launch,
    trial: &Trial,
    settings: &Settings,
    wanted: &Wanted,
) -> Result<(Tuned, String), TuneError> {
    if !trial.plan.scene.stages.is_empty() {
        return Err(CertifyError::Stages.into());
    }
    trial.plan.check_names(&wanted.of)?;
    let mut runner = Runner {
        launch,
        plan: &trial.plan,
        settings,
        metric: Metric::ClosedForm,
        takes_inaccurate: false,
        wall_s: 0.0,
        spent_s: 0.0,
    };
    if trial.plan.scene.reference.is_none() || !wanted.of.is_empty() {
        runner.metric = runner.reference(wanted)?;
    }
    let space = settings.space(wanted.error, wanted.budget_s);
    let mut found = search(&space, &mut runner, settings)?;
    if found.best.as_ref().is_none_or(|best| best.error > wanted.error) {
        // A label may warn of what the error that is asked for does not mind.
        runner.takes_inaccurate = true;
        found = search(&space, &mut runner, settings)?;
    }
    let (tried, best) = runner.measure_again(found.tried, found.best, wanted.error)?;
    let mut tuned = runner.tuned(trial, tried, best, wanted.error);
    if found.is_out_of_budget {
        tuned.remarks.push(format!(
            "the search ended when its runs had taken {} s: raise --budget-s",
            wanted.budget_s
        ));
    }
    if runner.takes_inaccurate {
        let remark =
            "no run that is labelled accurate is within the error: settings are judged by their error alone";
        tuned.remarks.push(remark.into());
    }
    let json = tuned.write(&trial.out).map_err(CertifyError::from)?;
    Ok((tuned, json))
}

/// Result of a search.
struct Found {
    tried: Vec<Tried>,
    best: Option<Best>,
    is_out_of_budget: bool,
}

fn search(space: &Space, runner: &mut Runner, settings: &Settings) -> Result<Found, TuneError> {
    let mut search = Search::new(space, runner);
    let best = search.run(&settings.start())?;
    Ok(Found { tried: std::mem::take(&mut search.tried), best, is_out_of_budget: search.is_out_of_budget })
}

/// Runs settings of a scene.
struct Runner<'a> {
    launch: &'a Launch<'a>,
    plan: &'a Plan,
    settings: &'a Settings,
    metric: Metric,
    /// Whether runs that call themselves inaccurate count.
    takes_inaccurate: bool,
    /// Wall time of all runs [s].
    wall_s: f64,
    /// Processor time of all runs, or wall time where the system does not tell [s].
    spent_s: f64,
}

impl Runner<'_> {
    fn case(&self, setting: &Setting) -> Case {
        let name =
            format!("{}_{}", plain(&self.settings.label(setting)), self.plan.steps(setting.level as u32));
        self.plan.case(name, setting.level as u32, self.settings.set(setting))
    }

    /// Runs a case; how it failed where it does.
    fn run_case(&mut self, case: &Case) -> Result<Result<Ended, Outcome>, TuneError> {
        let said = self.launch.run_case(case)?;
        (self.launch.say)(&format!("{}: {said}", case.name));
        if let Some(RunOutcome::Failed { cause, reason }) =
            self.launch.record(case)?.map(|record| record.outcome)
        {
            let is_final = cause == Cause::Scene;
            return Ok(Err(Outcome::Failed { reason, is_final }));
        }
        let ended = read(self.launch, case)?;
        self.wall_s += ended.summary.wall_s;
        self.spent_s += cost_s(&ended) * f64::from(case.repeats);
        Ok(Ok(ended))
    }

    /// Runs the scene's own setting with ever shorter steps, until it is exact enough to judge others.
    fn reference(&mut self, wanted: &Wanted) -> Result<Metric, TuneError> {
        let space = self.settings.space(wanted.error, wanted.budget_s);
        let monitors: Vec<String> =
            self.plan.scene.monitors.iter().map(|monitor| monitor.name.clone()).collect();
        let mut runs: Vec<Table> = Vec::new();
        let (mut error, mut step_s) = (f64::INFINITY, self.plan.step_s(0));
        for level in space.first_level..=space.last_level {
            let before_s = self.wall_s;
            let case = self.case(&Setting { at: self.settings.start(), level });
            match self.run_case(&case)? {
                Ok(ended) => runs.push(ended.history),
                Err(_) => runs.clear(),
            }
            step_s = self.plan.step_s(level as u32);
            if let [.., first, second, last] = &runs[..] {
                let quantities = compared(last, &wanted.of, &monitors);
                if quantities.is_empty() {
                    let (name, known) = (wanted.of.join(","), last.names[1..].join(", "));
                    return Err(CertifyError::NoQuantity { name, known }.into());
                }
                error = error_of_last([first, second, last], &quantities);
                if error <= wanted.error / MORE_EXACT {
                    return Ok(Metric::Run { history: last.clone(), quantities, error });
                }
            }
            let took_s = self.wall_s - before_s;
            if self.wall_s + 2.0 * took_s > FOR_REFERENCE * wanted.budget_s {
                break;
            }
        }
        Err(TuneError::NoTruth { step_s, error })
    }

    /// Measures the times of the settings that are nearly the cheapest again, and takes the cheapest of them.
    fn measure_again(
        &mut self,
        tried: Vec<Tried>,
        best: Option<Best>,
        target: f64,
    ) -> Result<(Vec<Tried>, Option<Best>), TuneError> {
        let mut tried = tried;
        let Some(best) = best.filter(|best| best.error <= target) else {
            let least = least_error(&tried);
            return Ok((tried, least));
        };
        let limit_s = if best.time_s > LONG_S { 0.0 } else { NEARLY * best.time_s };
        let mut order: Vec<usize> =
            (0..tried.len()).filter(|&i| reaches(&tried[i], target, limit_s)).collect();
        order.sort_by(|&a, &b| time_s(&tried[a]).total_cmp(&time_s(&tried[b])));
        order.truncate(MEASURED_AGAIN);
        for i in order {
            let mut case = self.case(&tried[i].setting);
            case.name += "_again";
            case.repeats = REPEATS;
            if let (Ok(ended), Outcome::Done { time_s, .. }) = (self.run_case(&case)?, &mut tried[i].outcome)
            {
                *time_s = time_s.min(cost_s(&ended));
            }
        }
        let cheapest = tried.iter().filter(|one| reaches(one, target, f64::INFINITY));
        let cheapest = cheapest.min_by(|a, b| time_s(a).total_cmp(&time_s(b))).and_then(as_best);
        Ok((tried, cheapest.or(Some(best))))
    }

    /// The result of a search.
    fn tuned(&self, trial: &Trial, tried: Vec<Tried>, best: Option<Best>, target: f64) -> Tuned {
        let mut points: Vec<TrialPoint> = tried.iter().map(|one| self.point(one)).collect();
        let ended: Vec<usize> = (0..points.len()).filter(|&i| points[i].error.is_some()).collect();
        let at = |&i: &usize| Point {
            time_s: points[i].time_s.unwrap_or(f64::INFINITY),
            error: points[i].error.unwrap_or(f64::INFINITY),
        };
        let on_front = front(&ended.iter().map(at).collect::<Vec<_>>());
        on_front.into_iter().for_each(|k| points[ended[k]].on_front = true);
        let is_best = |one: &&Tried| best.as_ref().is_some_and(|best| best.setting == one.setting);
        let best = tried.iter().position(|one| is_best(&one)).map(|i| points[i].clone());
        let judged_by = match &self.metric {
            Metric::ClosedForm => "relative to the scene's closed form, the largest over time".into(),
            Metric::Run { error, .. } => format!(
                "relative to the scene's own setting at a short step, which is certified to {error:.1e}; that is added to each"
            ),
        };
        Tuned {
            schema: SCHEMA,
            scene: trial.name.clone(),
            title: self.plan.scene.title.clone(),
            target,
            judged_by,
            is_reached: best.as_ref().and_then(|best| best.error).is_some_and(|error| error <= target),
            best,
            tried: points,
            remarks: Vec::new(),
            wall_s: self.wall_s,
            spent_s: self.spent_s,
        }
    }

    fn point(&self, tried: &Tried) -> TrialPoint {
        let step_s = self.plan.step_s(tried.setting.level as u32);
        let mut set = vec![format!("time.step_s={}", in_fewest_figures(step_s))];
        set.extend(self.settings.set(&tried.setting));
        let (time_s, error, reason) = match &tried.outcome {
            Outcome::Done { time_s, error } => (Some(*time_s), Some(*error), None),
            Outcome::Failed { reason, .. } => (None, None, Some(reason.clone())),
        };
        TrialPoint {
            label: self.settings.label(&tried.setting),
            step_s,
            set,
            time_s,
            error,
            reason,
            on_front: false,
        }
    }
}

impl Trials for Runner<'_> {
    type Error = TuneError;

    fn run(&mut self, setting: &Setting) -> Result<Outcome, TuneError> {
        let case = self.case(setting);
        let ended = match self.run_case(&case)? {
            Ok(ended) => ended,
            Err(failed) => return Ok(failed),
        };
        let label = &ended.summary.label;
        if !self.takes_inaccurate && label.word == LabelWord::Inaccurate {
            let reason = format!("inaccurate: {}", reasons::in_a_line(&label.reasons));
            return Ok(Outcome::Failed { reason, is_final: false });
        }
        Ok(Outcome::Done { time_s: cost_s(&ended), error: self.metric.error(&ended)? })
    }

    fn prepare(&mut self, settings: &[Setting]) -> Result<(), TuneError> {
        if self.launch.jobs < 2 {
            return Ok(());
        }
        let cases: Vec<Case> = settings.iter().map(|setting| self.case(setting)).collect();
        Ok(self.launch.run_all(&cases)?)
    }
}

/// Cost of a run: processor time, or wall time where the system does not tell [s].
fn cost_s(ended: &Ended) -> f64 {
    ended.summary.machine.processor_time_s.unwrap_or(ended.summary.wall_s)
}

fn as_best(tried: &Tried) -> Option<Best> {
    match tried.outcome {
        Outcome::Done { time_s, error } => Some(Best { setting: tried.setting.clone(), time_s, error }),
        Outcome::Failed { .. } => None,
    }
}

fn time_s(tried: &Tried) -> f64 {
    as_best(tried).map_or(f64::INFINITY, |best| best.time_s)
}

/// Whether a setting reaches an error within a time.
fn reaches(tried: &Tried, target: f64, limit_s: f64) -> bool {
    as_best(tried).is_some_and(|best| best.error <= target && best.time_s <= limit_s)
}

/// The most exact of all that were tried.
fn least_error(tried: &[Tried]) -> Option<Best> {
    tried.iter().filter_map(as_best).min_by(|a, b| a.error.total_cmp(&b.error))
}
