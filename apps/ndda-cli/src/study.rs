//! `ndda study`: a scene with other steps, integrators, meshes, …, and what each costs and is worth.

pub mod case;
pub mod difference;
pub mod emit;
pub mod error;
pub mod front;
mod judge;
pub mod launch;
#[cfg(feature = "plots")]
mod pictures;
pub mod record;
pub mod result;
mod table;
mod write;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use ndda_io::WriteError;
use ndda_io::study::{self, LoadedStudy, Reference};

use crate::args::{StudyArgs, StudyCaseArgs, StudyHow, StudyPart};
use crate::console::{complain, say};
use crate::{exit, interrupt};
use case::Case;
use emit::Plan;
use error::StudyError;
use launch::Launch;
use result::Results;

/// Runs `ndda study`; returns the exit code.
pub fn study(args: &StudyArgs) -> u8 {
    let outcome = match (&args.part, &args.study) {
        (Some(StudyPart::Case(case)), _) => run_one(case),
        (Some(StudyPart::Collect(collect)), _) => {
            Opened::new(&collect.study, &collect.how).and_then(|opened| gather(&opened, collect.json))
        }
        (None, Some(study)) => run_all(study, args),
        // The command line asks for one before it comes to this.
        (None, None) => return exit::USAGE,
    };
    outcome.unwrap_or_else(|error| {
        complain(&error.to_string());
        error.code()
    })
}

/// A study that is read, and where and how it runs.
struct Opened<'a> {
    loaded: LoadedStudy,
    name: String,
    cases: Vec<Case>,
    references: Vec<Case>,
    out: PathBuf,
    how: &'a StudyHow,
}

impl<'a> Opened<'a> {
    fn new(study: &Path, how: &'a StudyHow) -> Result<Self, StudyError> {
        let loaded = study::load(study).map_err(StudyError::Scene)?;
        let mut cases = case::cases(&loaded)?;
        case::set_first(&mut cases, &how.overrides);
        let mut references = case::reference_cases(&loaded, &cases)?;
        case::set_first(&mut references, &how.overrides);
        let name = study.file_stem().map_or_else(|| "study".into(), |s| s.to_string_lossy().into_owned());
        let out = how.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_study")));
        Ok(Self { loaded, name, cases, references, out, how })
    }

    /// Whether there is something to compare with, before anything runs.
    fn check_reference(&self) -> Result<(), StudyError> {
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
    fn runs(&self) -> Vec<Case> {
        self.references.iter().chain(&self.cases).cloned().collect()
    }

    fn launch<'b>(&'b self, jobs: u16, asked_to_end: &'b AtomicBool) -> Launch<'b> {
        let (threads, quiet) = (self.how.threads, self.how.quiet);
        Launch { loaded: &self.loaded, out: &self.out, jobs, threads, quiet, asked_to_end }
    }
}

fn run_all(study: &Path, args: &StudyArgs) -> Result<u8, StudyError> {
    let opened = Opened::new(study, &args.how)?;
    if let Some(kind) = args.emit {
        let plan = Plan { study, out: &opened.out, jobs: args.jobs, how: &args.how };
        say(&emit::script(&plan, &opened.runs(), kind));
        return Ok(exit::DONE);
    }
    opened.check_reference()?;
    make_folder(&opened.out)?;
    let asked_to_end = interrupt::watch();
    opened.launch(args.jobs, &asked_to_end).run_all(&opened.runs())?;
    gather(&opened, args.json)
}

fn run_one(args: &StudyCaseArgs) -> Result<u8, StudyError> {
    let opened = Opened::new(&args.study, &args.how)?;
    let (runs, name) = (opened.runs(), &args.case);
    let case = runs.iter().find(|case| case.name == *name).ok_or_else(|| StudyError::NoCase(name.clone()))?;
    make_folder(&opened.out)?;
    let asked_to_end = interrupt::watch();
    let said = opened.launch(1, &asked_to_end).run_case(case)?;
    if !args.how.quiet {
        say(&format!("{name}: {said}"));
    }
    Ok(exit::DONE)
}

/// Makes the folder of a study, which may hold an earlier part of it.
///
/// # Errors
/// [`StudyError::Write`] when it cannot be made.
pub fn make_folder(out: &Path) -> Result<(), StudyError> {
    if out.is_file() {
        return Err(WriteError::IsFile { path: out.to_path_buf() }.into());
    }
    let refused = |source| WriteError::Io { operation: "create the folder", path: out.to_path_buf(), source };
    Ok(std::fs::create_dir_all(out.join("cases")).map_err(refused)?)
}

/// Reads what has run, writes and prints the results.
fn gather(opened: &Opened, as_json: bool) -> Result<u8, StudyError> {
    let never = AtomicBool::new(false);
    let launch = opened.launch(1, &never);
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
