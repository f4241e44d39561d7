//! Runs the cases of a study that have not run yet, several at a time, and keeps a record of each.

use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use ndda_io::WriteError;
use ndda_io::study::{Clock, LoadedStudy};
use serde_json::Value;

use super::case::{Case, fingerprint};
use super::error::StudyError;
use super::record::{Cause, Identity, RESULTS, Record, RunOutcome, folder};
use super::runner::{CaseRun, CaseRunner};
use super::warned::Warned;
use crate::judge::words::SECOND_RUN;
use crate::run::Sensitivity;

/// Where and how cases run.
pub struct Launch<'a> {
    /// The study.
    pub loaded: &'a LoadedStudy,
    /// Its output folder.
    pub out: &'a Path,
    /// Cases at a time.
    pub jobs: u16,
    /// Threads of each, or of each of its ranks.
    pub threads: u16,
    /// Runner of a case.
    pub runner: &'a dyn CaseRunner,
    /// Told how far it is, a line at a time.
    pub say: &'a (dyn Fn(&str) + Sync),
}

impl Launch<'_> {
    /// The identity of a case as it would run now; what is wrong with its scene otherwise.
    pub fn identity(&self, case: &Case) -> Identity {
        // A scene that is wrong has a fingerprint, too: its errors.
        let scene = fingerprint(self.loaded, case).unwrap_or_else(|errors| errors.render(false));
        Identity::new(scene, (self.runner.ranks(), self.threads), (case.repeats, case.sensitivity))
    }

    /// The record of a case that was run as it would run now.
    ///
    /// # Errors
    /// [`StudyError::Record`] when its file is something else.
    pub fn record(&self, case: &Case) -> Result<Option<Record>, StudyError> {
        let record = Record::read(&folder(self.out, &case.name))?;
        Ok(record.filter(|record| record.identity == self.identity(case)))
    }

    /// The same, if it need not be run again.
    ///
    /// # Errors
    /// As [`record`](Self::record).
    pub fn finished(&self, case: &Case) -> Result<Option<Record>, StudyError> {
        Ok(self.record(case)?.filter(Record::is_final))
    }

    /// Runs what has not run yet, `jobs` at a time.
    ///
    /// # Errors
    /// The first error of any case that is not the case's own.
    pub fn run_all(&self, cases: &[Case]) -> Result<(), StudyError> {
        let (next, failed) = (AtomicUsize::new(0), Mutex::new(None));
        let warned = Warned::default();
        let work = || {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(case) = cases.get(index) else { break };
                warned.note(self.loaded, case);
                match self.run_case(case) {
                    Ok(said) => {
                        (self.say)(&format!("{} of {}: {}: {said}", index + 1, cases.len(), case.name));
                    }
                    Err(error) => {
                        next.store(cases.len(), Ordering::Relaxed);
                        failed.lock().expect("no thread panics").get_or_insert(error);
                    }
                }
            }
        };
        std::thread::scope(|scope| (0..self.jobs).for_each(|_| drop(scope.spawn(work))));
        warned.lines(cases.len()).iter().for_each(|line| (self.say)(line));
        failed.into_inner().expect("no thread panics").map_or(Ok(()), Err)
    }

    /// Runs one case unless it has run; returns a few words on how it went.
    ///
    /// # Errors
    /// [`StudyError`] when runs cannot be started, recorded, or somebody asks to end.
    pub fn run_case(&self, case: &Case) -> Result<String, StudyError> {
        if self.finished(case)?.is_some() {
            return Ok("has run".into());
        }
        if self.loaded.study.clock == Clock::Processor && self.runner.ranks() > 1 {
            return Err(StudyError::ProcessorTimeOfRanks);
        }
        let folder = folder(self.out, &case.name);
        fs::create_dir_all(&folder).map_err(|source| WriteError::Io {
            operation: "create the folder",
            path: folder.clone(),
            source,
        })?;
        let outcome = self.repeat(case, &folder)?;
        let said = match &outcome {
            RunOutcome::Done { walls_s, processors_s, .. } => {
                let times_s = clocked(self.loaded.study.clock, walls_s, processors_s)?;
                let of = if walls_s.len() > 1 {
                    format!(", the shortest of {} runs", walls_s.len())
                } else {
                    String::new()
                };
                format!("{:.3} s{of}", least(times_s))
            }
            RunOutcome::Failed { reason, .. } => format!("failed: {reason}"),
        };
        Record { name: case.name.clone(), identity: self.identity(case), outcome }.write(&folder)?;
        Ok(said)
    }

    /// All runs of a case, until one fails.
    fn repeat(&self, case: &Case, folder: &Path) -> Result<RunOutcome, StudyError> {
        let (mut walls_s, mut processors_s): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        let (mut fastest, mut label) = (Value::Null, Value::Null);
        for _ in 0..case.repeats {
            let is_first = walls_s.is_empty();
            let sensitivity = if is_first { case.sensitivity } else { Sensitivity::Never };
            let summary = match self.run_once((case, sensitivity), &folder.join(RESULTS))? {
                Ok(summary) => summary,
                Err(failed) => return Ok(failed),
            };
            if is_first {
                label = summary["label"].clone();
            } else if summary["state_crc32"] != fastest["state_crc32"] {
                let reason = "two runs of it ended in different bits: please report this".into();
                return Ok(RunOutcome::Failed { cause: Cause::Other, reason });
            }
            // A second run is not what the case costs; processor time is that of the first.
            let again_s = summary["stages_s"][SECOND_RUN].as_f64().unwrap_or(0.0);
            walls_s.push(summary["wall_s"].as_f64().map_or(f64::INFINITY, |wall_s| wall_s - again_s));
            processors_s.extend(summary["machine"]["processor_time_s"].as_f64());
            let (last, before) = clocked(self.loaded.study.clock, &walls_s, &processors_s)?
                .split_last()
                .expect("a run has ended");
            if *last < least(before) {
                fastest = summary;
            }
        }
        // The label of a run that was repeated knows more.
        fastest["label"] = label;
        Ok(RunOutcome::Done { walls_s, processors_s, summary: fastest })
    }

    /// One run: its summary, or how it failed.
    fn run_once(
        &self,
        (case, sensitivity): (&Case, Sensitivity),
        results: &Path,
    ) -> Result<Result<Value, RunOutcome>, StudyError> {
        let run = CaseRun {
            scene: &self.loaded.scene,
            overrides: &case.overrides,
            out: results,
            threads: self.threads,
            sensitivity,
        };
        if let Some((cause, reason)) = self.runner.run(&run)? {
            return Ok(Err(RunOutcome::Failed { cause, reason }));
        }
        let file = results.join(ndda_io::OutputFolder::SUMMARY);
        let broken = |reason: String| StudyError::Record { file: file.clone(), reason };
        let text = fs::read_to_string(&file).map_err(|e| broken(e.to_string()))?;
        serde_json::from_str(&text).map(Ok).map_err(|e| broken(e.to_string()))
    }
}

/// The times that count.
///
/// # Errors
/// [`StudyError::NoProcessorTime`] where the system does not report it.
pub fn clocked<'a>(
    clock: Clock,
    walls_s: &'a [f64],
    processors_s: &'a [f64],
) -> Result<&'a [f64], StudyError> {
    match clock {
        Clock::Wall => Ok(walls_s),
        Clock::Processor if processors_s.len() == walls_s.len() => Ok(processors_s),
        Clock::Processor => Err(StudyError::NoProcessorTime),
    }
}

/// The least of some times; infinite if there are none.
pub fn least(times_s: &[f64]) -> f64 {
    times_s.iter().copied().fold(f64::INFINITY, f64::min)
}
