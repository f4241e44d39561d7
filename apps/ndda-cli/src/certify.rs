//! `ndda certify`: every answer of a scene with an error bar, from runs with steps that halve.

pub mod certificate;
pub mod chaos;
pub mod error;
pub mod extrapolate;
pub mod plan;
pub mod quantities;
pub mod report;
pub mod runs;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use ndda_io::diagnostic::SceneErrors;
use ndda_io::scene::Scene;
use ndda_io::study::LoadedStudy;
use ndda_io::{WriteError, atomic, read};

use crate::args::{CertifyArgs, SceneArgs, TrialHow};
use crate::check::Ready;
use crate::console::{complain, say};
use crate::events::Events;
use crate::study::launch::Launch;
use crate::study::make_folder;
use crate::{examples, exit, input, interrupt, wiring};
use error::CertifyError;
use plan::Plan;
use runs::Wanted;

/// Runs `ndda certify`; returns the exit code.
pub fn certify(args: &CertifyArgs) -> u8 {
    let own_steps = |scene: &Scene| wiring::steps(&scene.time);
    let trial = match Trial::open(&args.input, &args.how, "certified", own_steps) {
        Ok((trial, _)) => trial,
        Err(code) => return code,
    };
    certify_trial(args, &trial).unwrap_or_else(|error| {
        complain(&error.to_string());
        error.code()
    })
}

fn certify_trial(args: &CertifyArgs, trial: &Trial) -> Result<u8, CertifyError> {
    let asked_to_end = interrupt::watch();
    let launch = trial.launch(&args.how, &asked_to_end);
    let wanted = Wanted { meshes: args.mesh, penalties: args.penalty, of: args.of.clone() };
    let certificate = runs::certify(&launch, &trial.plan, &trial.name, &wanted)?;
    let json = certificate.write(&trial.out)?;
    say(&match args.how.json {
        true => json,
        false => format!("{}results in {}", report::text(&certificate, &args.of), trial.out.display()),
    });
    Ok(exit::DONE)
}

/// A scene that is run over and over, and where its runs go.
pub struct Trial {
    /// The scene as runs are launched with it.
    pub loaded: LoadedStudy,
    /// Its name: the file without its ending.
    pub name: String,
    /// Settings that its runs share.
    pub plan: Plan,
    /// The output folder.
    pub out: PathBuf,
}

impl Trial {
    /// Reads, checks and builds a scene once, and makes its output folder, `out/NAME_purpose` unless another is asked for;
    /// `steps` is the number of steps of its longest step.
    ///
    /// # Errors
    /// The exit code, after the reason has been printed.
    pub fn open(
        args: &SceneArgs,
        how: &TrialHow,
        purpose: &str,
        steps: impl FnOnce(&Scene) -> u64,
    ) -> Result<(Self, Ready), u8> {
        let ready = input::ready(args, Events::default())?;
        if !ready.loaded.warnings.is_empty() && !how.quiet {
            Events::default().doubt(&ready.loaded.errors(ready.loaded.warnings.clone()));
        }
        let file = input::file(args);
        let name =
            file.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned());
        let out = how.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_{purpose}")));
        let scene = &ready.loaded.scene;
        let plan = Plan::new(scene, &ready.simulation, &args.overrides, steps(scene));
        let refuse = |error: CertifyError| {
            complain(&error.to_string());
            error.code()
        };
        make_folder(&out).map_err(|error| refuse(error.into()))?;
        let (scene, text) = match &args.example {
            None => read::text_of(&file).map(|text| (file, text)).map_err(|errors| said(&errors))?,
            Some(example) => {
                let text = examples::find(example).unwrap_or_default().to_string();
                (example_file(&out, &text).map_err(|error| refuse(error.into()))?, text)
            }
        };
        Ok((Self { loaded: LoadedStudy::of_scene(scene, text), name, plan, out }, ready))
    }

    /// The launcher of its runs.
    pub fn launch<'a>(&'a self, how: &TrialHow, asked_to_end: &'a AtomicBool) -> Launch<'a> {
        let (jobs, threads, quiet) = (how.jobs, how.threads, how.quiet);
        Launch { loaded: &self.loaded, out: &self.out, jobs, threads, quiet, asked_to_end }
    }
}

/// Writes an example to the folder, so that runs have a file to read.
fn example_file(out: &Path, text: &str) -> Result<PathBuf, WriteError> {
    let file = out.join("scene.ron");
    atomic::write(&file, text.as_bytes()).map(|()| file)
}

/// Says why a scene cannot be read.
fn said(errors: &SceneErrors) -> u8 {
    Events::default().refuse(errors)
}
