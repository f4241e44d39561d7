//! Many runs of one scene: with other steps, integrators, meshes, …, and what each costs and is worth.

pub mod case;
pub mod difference;
pub mod emit;
pub mod error;
pub mod front;
mod gather;
mod judge;
pub mod launch;
#[cfg(feature = "plots")]
mod pictures;
pub mod ranks;
pub mod record;
pub mod result;
pub mod runner;
pub mod table;
pub mod warned;
mod write;

use std::path::{Path, PathBuf};

use ndda_io::study::{LoadedStudy, Reference, SecondRuns};
use ndda_io::{OutputFolder, WriteError};

use crate::choose;
use case::Case;
use error::StudyError;
use launch::Launch;
use result::Results;
use runner::CaseRunner;

/// A study that is read: what runs, and where results go.
pub struct Study {
    /// The study and its scene.
    pub loaded: LoadedStudy,
    /// Its name: the file without its ending.
    pub name: String,
    /// The plotted cases.
    pub cases: Vec<Case>,
    /// The reference cases.
    pub references: Vec<Case>,
    /// The output folder.
    pub out: PathBuf,
}

impl Study {
    /// Reads a study; `overrides` are set in its scene before what the study sets. Results go to `out`, or to
    /// `out/NAME_study`.
    ///
    /// # Errors
    /// [`StudyError`] for what is wrong with it.
    pub fn open(study: &Path, out: Option<PathBuf>, overrides: &[String]) -> Result<Self, StudyError> {
        let loaded = LoadedStudy::load(study).map_err(StudyError::Scene)?;
        if loaded.study.is_sweep() {
            return Err(StudyError::IsSweep);
        }
        let overrides = &pinned(&loaded, overrides);
        let mut cases = case::cases(&loaded)?;
        case::set_first(&mut cases, overrides);
        let mut references = case::reference_cases(&loaded, &cases)?;
        case::set_first(&mut references, overrides);
        let name = study.file_stem().map_or_else(|| "study".into(), |s| s.to_string_lossy().into_owned());
        let out = out.unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_study")));
        Ok(Self { loaded, name, cases, references, out })
    }

    /// Repeats accurate runs of cases as is asked for, in place of what the study says.
    pub fn with_second_runs(mut self, asked: Option<SecondRuns>) -> Self {
        if let Some(asked) = asked {
            self.cases.iter_mut().for_each(|case| case.sensitivity = asked);
        }
        self
    }

    /// Whether there is something to compare with, before anything runs.
    ///
    /// # Errors
    /// [`StudyError::NoReference`] and [`StudyError::NoMonitor`] where there is not.
    pub fn check_reference(&self) -> Result<(), StudyError> {
        let mut scenes = self.cases.iter().filter_map(|case| self.loaded.scene_with(&case.overrides).ok());
        let Some(first) = scenes.next() else { return Ok(()) };
        match &self.loaded.study.reference {
            Reference::ClosedForm if first.scene.reference.is_none() => {
                Err(StudyError::NoReference(self.loaded.scene.clone()))
            }
            Reference::Runs { monitors: Some(names), .. } => {
                let known: Vec<&str> = first.scene.monitors.iter().map(|m| m.name.as_str()).collect();
                let unknown = names.iter().find(|name| !known.contains(&name.as_str()));
                let refuse = |name: &String| StudyError::NoMonitor(name.clone(), known.join(", "));
                unknown.map_or(Ok(()), |name| Err(refuse(name)))
            }
            _ => Ok(()),
        }
    }

    /// All that runs, what the others are compared with first.
    pub fn runs(&self) -> Vec<Case> {
        self.references.iter().chain(&self.cases).cloned().collect()
    }

    /// The launcher of its runs, `jobs` at a time on so many threads each.
    pub fn launch<'a>(
        &'a self,
        runner: &'a dyn CaseRunner,
        say: &'a (dyn Fn(&str) + Sync),
        (jobs, threads): (u16, u16),
    ) -> Launch<'a> {
        Launch { loaded: &self.loaded, out: &self.out, jobs, threads, runner, say }
    }

    /// Reads what has run and writes the results: tables, `study.json` (which is returned, too) and pictures.
    ///
    /// # Errors
    /// [`StudyError`] when a record cannot be read or a result cannot be written.
    pub fn gather(&self, launch: &Launch) -> Result<(Results, String), StudyError> {
        let results = Results::gather(launch, &self.name, (&self.cases, &self.references))?;
        make_folder(&self.out)?;
        let json = write::all(&self.out, &results)?;
        #[cfg(feature = "plots")]
        pictures::all(&self.out, &results)?;
        Ok((results, json))
    }
}

/// Overrides of all cases of a study: those that are asked for, and what is chosen for the base scene where it leaves out the penalty or
/// the step, so that all cases share it.
pub(crate) fn pinned(loaded: &LoadedStudy, overrides: &[String]) -> Vec<String> {
    let base = loaded.scene_with(overrides).ok().filter(|base| !base.is_complete());
    let folder = loaded.scene.parent().unwrap_or(Path::new("."));
    let chosen =
        base.and_then(|base| choose::complete(base, folder).ok()).map_or(Vec::new(), |base| base.chosen);
    [overrides.to_vec(), choose::as_overrides(&chosen)].concat()
}

/// Files that studies, sweeps, certificates and tuning write beside the folder of their cases.
const NAMES: [&str; 9] = [
    "study.json",
    "study.csv",
    "time_to_error.csv",
    "sweep.json",
    "sweep.csv",
    "sweep_numbers.csv",
    "sweep.parquet",
    "certificate.json",
    "tune.json",
];

/// Makes the folder of a study, which may hold an earlier part of it.
///
/// # Errors
/// [`StudyError::Write`] when it cannot be made, is the folder of a run, or has files of these names and no cases.
pub fn make_folder(out: &Path) -> Result<(), StudyError> {
    if out.is_file() {
        return Err(WriteError::IsFile { path: out.to_path_buf() }.into());
    }
    OutputFolder::refuse_run(out)?;
    OutputFolder::refuse_others(out, out.join("cases").is_dir(), &NAMES)?;
    let refused = |source| WriteError::Io { operation: "create the folder", path: out.to_path_buf(), source };
    Ok(std::fs::create_dir_all(out.join("cases")).map_err(refused)?)
}
