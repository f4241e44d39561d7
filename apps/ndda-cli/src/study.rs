//! `ndda study`: a scene with other steps, integrators, meshes, …, and what each costs and is worth.

pub mod case;
pub mod difference;
pub mod emit;
pub mod error;
pub mod front;
pub mod launch;
#[cfg(feature = "plots")]
mod pictures;
pub mod record;
pub mod result;
mod table;
mod write;

use std::path::{Path, PathBuf};

use ndda_io::WriteError;
use ndda_io::study::{self, LoadedStudy};

use crate::args::{StudyArgs, StudyCommon, StudyPart, StudyRunArgs};
use crate::console::{complain, say};
use crate::{exit, interrupt};
use case::Case;
use emit::Plan;
use error::StudyError;
use launch::Launch;
use result::Results;

/// Runs `ndda study`; returns the exit code.
pub fn study(args: &StudyArgs) -> u8 {
    let outcome = match (&args.part, &args.all) {
        (Some(StudyPart::Case(case)), _) => run_one(&case.common, &case.case),
        (Some(StudyPart::Collect(args)), _) => {
            Opened::new(&args.common).and_then(|o| gather(&o, &args.common, args.json))
        }
        (None, Some(all)) => run_all(all),
        (None, None) => {
            complain("error: name a study file (see ndda study --help)");
            return exit::USAGE;
        }
    };
    outcome.unwrap_or_else(|error| {
        complain(&error.to_string());
        error.code()
    })
}

/// A study that is read, and where it goes.
struct Opened {
    loaded: LoadedStudy,
    name: String,
    cases: Vec<Case>,
    references: Vec<Case>,
    out: PathBuf,
}

impl Opened {
    fn new(common: &StudyCommon) -> Result<Self, StudyError> {
        let loaded = study::load(&common.study).map_err(StudyError::Scene)?;
        let cases = case::cases(&loaded)?;
        let references = case::reference_cases(&loaded, &cases)?;
        let name =
            common.study.file_stem().map_or_else(|| "study".into(), |s| s.to_string_lossy().into_owned());
        let out = common.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_study")));
        Ok(Self { loaded, name, cases, references, out })
    }

    /// All that runs, what the others are compared with first.
    fn runs(&self) -> Vec<Case> {
        self.references.iter().chain(&self.cases).cloned().collect()
    }

    fn launch<'a>(
        &'a self,
        common: &StudyCommon,
        jobs: u16,
        asked: &'a std::sync::atomic::AtomicBool,
    ) -> Launch<'a> {
        let (threads, quiet) = (common.threads, common.quiet);
        Launch { loaded: &self.loaded, out: &self.out, jobs, threads, quiet, asked_to_end: asked }
    }
}

fn run_all(args: &StudyRunArgs) -> Result<u8, StudyError> {
    let opened = Opened::new(&args.common)?;
    if let Some(kind) = args.emit {
        let (study, out, threads) = (args.common.study.as_path(), opened.out.as_path(), args.common.threads);
        say(&emit::script(&Plan { study, out, jobs: args.jobs, threads }, &opened.runs(), kind));
        return Ok(exit::DONE);
    }
    make_folder(&opened.out)?;
    let asked = interrupt::watch();
    opened.launch(&args.common, args.jobs, &asked).run_all(&opened.runs())?;
    gather(&opened, &args.common, args.json)
}

fn run_one(common: &StudyCommon, name: &str) -> Result<u8, StudyError> {
    let opened = Opened::new(common)?;
    let runs = opened.runs();
    let case = runs.iter().find(|case| case.name == name).ok_or_else(|| StudyError::NoCase(name.into()))?;
    make_folder(&opened.out)?;
    let asked = interrupt::watch();
    let said = opened.launch(common, 1, &asked).run_case(case)?;
    if !common.quiet {
        say(&format!("{name}: {said}"));
    }
    Ok(exit::DONE)
}

/// The folder of a study, which may hold an earlier part of it but nothing else.
fn make_folder(out: &Path) -> Result<(), StudyError> {
    if out.is_file() {
        return Err(WriteError::IsFile { path: out.to_path_buf() }.into());
    }
    let refused = |source| WriteError::Io { operation: "create the folder", path: out.to_path_buf(), source };
    Ok(std::fs::create_dir_all(out.join("cases")).map_err(refused)?)
}

/// Reads what has run, writes and prints the results.
fn gather(opened: &Opened, common: &StudyCommon, as_json: bool) -> Result<u8, StudyError> {
    let asked = std::sync::atomic::AtomicBool::new(false);
    let launch = opened.launch(common, 1, &asked);
    let results = Results::gather(&launch, &opened.name, (&opened.cases, &opened.references))?;
    make_folder(&opened.out)?;
    let json = write::all(&opened.out, &results)?;
    #[cfg(feature = "plots")]
    pictures::all(&opened.out, &results)?;
    say(&if as_json {
        json
    } else {
        format!("{}results in {}", table::text(&results), opened.out.display())
    });
    let (done, missing) = (results.points.iter().any(|p| p.figures.is_some()), !results.missing.is_empty());
    Ok(if done && !missing { exit::DONE } else { exit::FAILED })
}
