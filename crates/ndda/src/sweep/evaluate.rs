//! Computes the cases of a sweep, several at a time.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use ndda_io::read::LoadedScene;

use super::cases::{Role, SweepCase};
use super::quantity::{self, Values};
use super::record::{Records, SweepOutcome, SweepRecord};
use super::{How, Sweep};
use crate::run::Sensitivity;
use crate::safety::{self, Bracket, Plan, SafetyError, State, Watch};
use crate::study::case::{Case, fingerprint};
use crate::study::error::StudyError;
use crate::study::record::{Cause, Identity, RESULTS, folder};
use crate::study::runner::CaseRun;
use crate::study::warned::Warned;

/// Set in every run of a sample before the study's own values: fields of thousands of runs are of no use.
const NO_FRAMES: &str = "output.frames=0";

/// Computes cases.
pub struct Evaluator<'a> {
    sweep: &'a Sweep,
    how: &'a How<'a>,
    warned: Warned,
}

impl<'a> Evaluator<'a> {
    /// Of a sweep.
    pub fn new(sweep: &'a Sweep, how: &'a How<'a>) -> Self {
        Self { sweep, how, warned: Warned::default() }
    }

    /// The outcomes of all cases, in their order: those that are known, and the others computed.
    ///
    /// # Errors
    /// The first error of any case that is not the case's own.
    pub fn all(&self) -> Result<Vec<SweepOutcome>, StudyError> {
        let records = Records::open(&self.sweep.out)?;
        let cases = &self.sweep.cases;
        let outcomes: Mutex<Vec<Option<SweepOutcome>>> = Mutex::new(vec![None; cases.len()]);
        let (next, failed) = (AtomicUsize::new(0), Mutex::new(None));
        let work = || {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(case) = cases.get(index) else { break };
                match self.one(case, &records, index) {
                    Ok(outcome) => outcomes.lock().expect("no thread panics")[index] = Some(outcome),
                    Err(error) => {
                        next.store(cases.len(), Ordering::Relaxed);
                        failed.lock().expect("no thread panics").get_or_insert(error);
                    }
                }
            }
        };
        std::thread::scope(|scope| (0..self.how.jobs).for_each(|_| drop(scope.spawn(work))));
        self.warned.lines(cases.len()).iter().for_each(|line| (self.how.say)(line));
        match failed.into_inner().expect("no thread panics") {
            Some(error) => Err(error),
            None => Ok(outcomes.into_inner().expect("no thread panics").into_iter().flatten().collect()),
        }
    }

    fn one(&self, case: &SweepCase, records: &Records, index: usize) -> Result<SweepOutcome, StudyError> {
        if self.how.stop.load(Ordering::Relaxed) {
            return Err(StudyError::Interrupted);
        }
        let case = &self.prepared(case);
        self.warned.note(&self.sweep.loaded, &case.case);
        let (identity, name) = (self.identity(case), case.case.name.clone());
        if let Some(known) = records.get(&name, &identity) {
            return Ok(known.outcome.clone());
        }
        let outcome = self.compute(case)?;
        let record = SweepRecord { name: name.clone(), identity, outcome };
        records.add(&record)?;
        let said = match &record.outcome {
            SweepOutcome::Done(_) => "done".to_string(),
            SweepOutcome::Failed { reason, .. } => {
                format!("failed: {}", reason.lines().next().unwrap_or_default())
            }
        };
        let name = if name.is_empty() { "the scene" } else { &name };
        (self.how.say)(&format!("{} of {}: {name}: {said}", index + 1, self.sweep.cases.len()));
        Ok(record.outcome)
    }

    /// A sample writes no fields unless the study says otherwise.
    fn prepared(&self, case: &SweepCase) -> SweepCase {
        let mut case = case.clone();
        if case.role != Role::Point {
            case.case.overrides.insert(0, NO_FRAMES.into());
        }
        case
    }

    fn identity(&self, case: &SweepCase) -> String {
        // A scene that is wrong has a fingerprint, too: its errors.
        let scene = fingerprint(&self.sweep.loaded, &case.case).unwrap_or_else(|errors| errors.render(false));
        let program = Identity::new(scene, (1, 1), (1, Sensitivity::Never));
        let safety = match self.sweep.wants_safety() {
            true => format!(" safety {:e} {:?}", self.sweep.loaded.study.safety_error, self.sweep.trial),
            false => String::new(),
        };
        let run = match self.sweep.wants_runs() {
            true => format!(" run {}", self.sensitivity(case)),
            false => String::new(),
        };
        format!("{} {}{run}{safety}", program.scene, program.program)
    }

    /// Whether an accurate run is run again: for its label, where that is wanted.
    fn sensitivity(&self, case: &SweepCase) -> Sensitivity {
        let is_labelled = self.sweep.of.iter().any(|name| name == quantity::LABEL);
        if is_labelled { case.case.sensitivity } else { Sensitivity::Never }
    }

    fn compute(&self, case: &SweepCase) -> Result<SweepOutcome, StudyError> {
        let mut values = Values::default();
        if self.sweep.wants_runs() {
            match self.run(case)? {
                SweepOutcome::Done(of_run) => values = of_run,
                failed => return Ok(failed),
            }
        }
        if self.sweep.wants_safety()
            && let Some(failed) = self.safety(&case.case, &mut values)?
        {
            return Ok(failed);
        }
        Ok(SweepOutcome::Done(values))
    }

    /// A run; that of a sample leaves nothing but its quantities.
    fn run(&self, case: &SweepCase) -> Result<SweepOutcome, StudyError> {
        let name = if case.case.name.is_empty() { "scene" } else { &case.case.name };
        let beside = folder(&self.sweep.out, name);
        let results: PathBuf = beside.join(RESULTS);
        let run = CaseRun {
            scene: &self.sweep.loaded.scene,
            overrides: &case.case.overrides,
            out: &results,
            threads: self.how.threads,
            sensitivity: self.sensitivity(case),
        };
        let outcome = match self.how.runner.run(&run)? {
            Some((cause, reason)) => SweepOutcome::Failed { cause, reason },
            None => SweepOutcome::Done(quantity::of_run(&results)?),
        };
        if case.role != Role::Point {
            // If some of its files cannot be removed, the next run of this case replaces them.
            let _ = std::fs::remove_dir_all(&beside);
        }
        Ok(outcome)
    }

    /// Adds the factor of safety, which is found in this process; gives the failure where there is none.
    fn safety(&self, case: &Case, values: &mut Values) -> Result<Option<SweepOutcome>, StudyError> {
        let failed = |cause, reason| Ok(Some(SweepOutcome::Failed { cause, reason }));
        let loaded = match self.sweep.loaded.scene_with(&case.overrides) {
            Ok(loaded) => loaded,
            Err(errors) => return failed(Cause::Scene, errors.render(false)),
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.how.threads.into()).build();
        let pool = pool.map_err(|error| StudyError::Start(std::io::Error::other(error)))?;
        match pool.install(|| self.add_safety(&loaded, values)) {
            Ok(()) => Ok(None),
            Err(SafetyError::Interrupted) => Err(StudyError::Interrupted),
            Err(SafetyError::Write(error)) => Err(error.into()),
            Err(error @ SafetyError::NotSettled { .. }) => failed(Cause::Stopped, error.to_string()),
            Err(error) => failed(Cause::Scene, error.to_string()),
        }
    }

    /// By a trial where that decides all that is wanted, otherwise by the whole search.
    fn add_safety(&self, loaded: &LoadedScene, values: &mut Values) -> Result<(), SafetyError> {
        let plan = Plan { error: self.sweep.loaded.study.safety_error, ..Plan::default() };
        let watch = Watch { out: None, stop: &self.how.stop, tell: &|_| {} };
        let beside = self.sweep.loaded.scene.parent().unwrap_or(Path::new("."));
        let scene = (self.sweep.name.as_str(), beside);
        if let Some(factor) = self.sweep.trial {
            let state = safety::at(loaded, scene, factor, &plan, &watch)?;
            let (lower, upper) = (state == State::Stands, state == State::Fails);
            if lower || upper {
                let end = |is: bool| is.then_some(factor);
                values.add_ends(Bracket { lower: end(lower), upper: end(upper) });
                return Ok(());
            }
        }
        values.add_safety(safety::find(loaded, scene, &plan, &watch)?.factor_of_safety);
        Ok(())
    }
}
