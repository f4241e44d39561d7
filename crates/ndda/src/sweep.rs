//! Sweeps: quantities of a scene over values and distributions of its parameters, without a reference.
//!
//! Axes with values make a grid; axes with distributions are sampled at each point of the grid. What has been computed is
//! kept a line at a time, so that the same command goes on where it was interrupted; points depend on the seed alone, and results are
//! put together in the order of the points, so that they are the same for any number of jobs.

pub mod cases;
pub mod condition;
pub mod distribution;
mod ends;
pub mod evaluate;
pub mod normal;
#[cfg(feature = "plots")]
mod pictures;
pub mod points;
pub mod quantity;
pub mod record;
pub mod result;
pub mod statistics;
pub mod text;
mod write;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ndda_io::read;
use ndda_io::study::{Axis, Correlation, LoadedStudy, Sampling, SecondRuns, Study};

use crate::Model;
use crate::places;
use crate::study::error::StudyError;
use crate::study::runner::CaseRunner;
use crate::study::{make_folder, pinned};
use cases::SweepCase;
use condition::Condition;
use evaluate::Evaluator;
use quantity::LABEL;
use result::Results;

/// Options of the command line; they take precedence over the study file.
#[derive(Clone, Debug, Default)]
pub struct Ask {
    /// `path=a,b,c` or `path=Normal(30, 2)`: the file is a scene then, and no study.
    pub vary: Vec<String>,
    /// Quantities.
    pub of: Vec<String>,
    /// Samples of what is random.
    pub samples: Option<u32>,
    /// How they are spread.
    pub sampling: Option<Sampling>,
    /// Their seed.
    pub seed: Option<u64>,
    /// `a,b=-0.5`: correlations of random axes.
    pub correlate: Vec<String>,
    /// The condition whose probability is wanted.
    pub fails_when: Option<String>,
    /// Whether to find how much each random axis matters.
    pub sensitivity: bool,
    /// Whether accurate runs are repeated, where the label is wanted.
    pub second_runs: Option<SecondRuns>,
    /// Values of the base scene.
    pub overrides: Vec<String>,
    /// The output folder.
    pub out: Option<PathBuf>,
}

/// A sweep that is read: its cases, and where results go.
pub struct Sweep {
    /// The study and its scene.
    pub loaded: LoadedStudy,
    /// Its name: the file without its ending.
    pub name: String,
    /// All cases.
    pub cases: Vec<SweepCase>,
    /// Quantities that are asked for.
    pub of: Vec<String>,
    /// The condition whose probability is wanted.
    pub fails_when: Option<Condition>,
    /// The factor at which a trial decides the condition, where no more of the factor of safety is wanted.
    pub trial: Option<f64>,
    /// The output folder.
    pub out: PathBuf,
}

/// How cases are run.
pub struct How<'a> {
    /// Runner of a case.
    pub runner: &'a dyn CaseRunner,
    /// Raised when somebody asks to end.
    pub stop: Arc<AtomicBool>,
    /// Told how far it is, a line at a time.
    pub say: &'a (dyn Fn(&str) + Sync),
    /// Cases at a time.
    pub jobs: u16,
    /// Threads of each.
    pub threads: u16,
}

impl Sweep {
    /// Reads a scene that is to vary, or a study file that asks for quantities; none if the file is a study with a reference.
    ///
    /// # Errors
    /// [`StudyError`] for what is wrong with it.
    pub fn open(file: &Path, ask: &Ask) -> Result<Option<Self>, StudyError> {
        let mut loaded = match ask.vary.is_empty() {
            true => LoadedStudy::load(file).map_err(|errors| match read::load(file, &[]) {
                Ok(_) => StudyError::SceneAlone(file.to_path_buf()),
                Err(_) => StudyError::Scene(errors),
            })?,
            false => {
                let mut study = Study::of_scene(file.to_path_buf());
                study.axes = Axis::from_words(&ask.vary).map_err(StudyError::Scene)?;
                let text = read::text_of(file).map_err(StudyError::Scene)?;
                LoadedStudy { study, curves: Vec::new(), scene: file.to_path_buf(), scene_text: text }
            }
        };
        apply(&mut loaded.study, ask)?;
        refuse_idle(&loaded.study, ask)?;
        if ask.vary.is_empty() && !loaded.study.is_sweep() {
            return Ok(None);
        }
        let loaded =
            LoadedStudy::checked(loaded.study, loaded.scene, loaded.scene_text).map_err(StudyError::Scene)?;
        let fails_when = loaded.study.fails_when.as_deref().map(Condition::parse).transpose()?;
        let mut of = loaded.study.of.clone();
        if of.is_empty() && fails_when.is_none() {
            of = defaults(&loaded, &ask.overrides)?;
        }
        // A condition on the factor of safety alone is decided by a trial at its limit.
        let asked = of.iter().any(|name| quantity::is_of_safety(name)) || loaded.study.sensitivity;
        let trial = fails_when.as_ref().and_then(Condition::factor).filter(|_| !asked);
        if trial.is_none() {
            of.extend(fails_when.iter().map(|condition| condition.quantity.clone()));
        }
        let mut seen = std::collections::HashSet::new();
        of.retain(|name| seen.insert(name.clone()));
        let cases = cases::cases(&loaded, &pinned(&loaded, &ask.overrides))?;
        let (name, out) = (places::name_of(file), places::folder_for(ask.out.as_deref(), file, "_study"));
        Ok(Some(Self { loaded, name, cases, of, fails_when, trial, out }))
    }

    /// Computes what has not been computed yet, and writes the results, of which the JSON is returned, too.
    ///
    /// # Errors
    /// [`StudyError`] when a case cannot be started or recorded, a result not be written, or somebody asks to end.
    pub fn run(&self, how: &How) -> Result<(Results, String), StudyError> {
        self.check_names()?;
        make_folder(&self.out)?;
        if let Some(warning) = ends::differing(self) {
            (how.say)(&warning);
        }
        let evaluator = Evaluator::new(self, how);
        let records = evaluator.all()?;
        let results = Results::new(self, records)?;
        let json = write::all(&self.out, &results)?;
        #[cfg(feature = "plots")]
        pictures::all(&self.out, &results)?;
        Ok((results, json))
    }

    /// Refuses names of no quantity before anything is computed, as far as a scene of the sweep can be built.
    fn check_names(&self) -> Result<(), StudyError> {
        let condition = self.fails_when.as_ref().map(|condition| &condition.quantity);
        if self.of.iter().chain(condition).all(|name| quantity::FIXED.contains(&name.as_str())) {
            return Ok(());
        }
        let beside = self.loaded.scene.parent().unwrap_or(Path::new("."));
        let loaded = self.cases.iter().find_map(|case| self.loaded.scene_with(&case.case.overrides).ok());
        let model = loaded.and_then(|loaded| Model::new(loaded, beside).ok());
        model.map_or(Ok(()), |model| result::check_names(self, quantity::of_model(&model)))
    }

    /// Whether factors of safety are wanted.
    fn wants_safety(&self) -> bool {
        self.trial.is_some() || self.of.iter().any(|name| quantity::is_of_safety(name))
    }

    /// Whether runs are wanted: anything but factors of safety needs one.
    fn wants_runs(&self) -> bool {
        self.of.iter().any(|name| !quantity::is_of_safety(name))
    }
}

/// Puts what the command line asks for into a study.
fn apply(study: &mut Study, ask: &Ask) -> Result<(), StudyError> {
    if !ask.of.is_empty() {
        study.of.clone_from(&ask.of);
    }
    study.samples = ask.samples.unwrap_or(study.samples);
    study.sampling = ask.sampling.unwrap_or(study.sampling);
    study.seed = ask.seed.unwrap_or(study.seed);
    study.second_runs = ask.second_runs.unwrap_or(study.second_runs);
    study.sensitivity |= ask.sensitivity;
    if ask.fails_when.is_some() {
        study.fails_when.clone_from(&ask.fails_when);
    }
    for text in &ask.correlate {
        study.correlations.push(correlation(text)?);
    }
    Ok(())
}

/// Refuses options of samples where nothing is random.
fn refuse_idle(study: &Study, ask: &Ask) -> Result<(), StudyError> {
    let options = [
        ("samples", ask.samples.is_some()),
        ("sampling", ask.sampling.is_some()),
        ("seed", ask.seed.is_some()),
    ];
    let is_random = study.axes.iter().any(|axis| matches!(axis, Axis::Random { .. }));
    match options.into_iter().find(|(_, is_there)| *is_there && !is_random) {
        Some((option, _)) => Err(StudyError::Idle(option)),
        None => Ok(()),
    }
}

/// `a,b=-0.5`
fn correlation(text: &str) -> Result<Correlation, StudyError> {
    let read = || {
        let (names, coefficient) = text.split_once('=')?;
        let (a, b) = names.split_once(',')?;
        let between = (a.trim().to_string(), b.trim().to_string());
        Some(Correlation { between, coefficient: coefficient.trim().parse().ok()? })
    };
    read().ok_or_else(|| StudyError::Correlation(text.to_string()))
}

/// The displacements of all monitors, or where there are none of all blocks.
fn defaults(loaded: &LoadedStudy, overrides: &[String]) -> Result<Vec<String>, StudyError> {
    // Overrides that only some choices make possible are the cases' own matter.
    let scene = loaded.scene_with(overrides).map_err(StudyError::Scene)?.scene;
    let of_monitors = scene.monitors.iter().map(|monitor| format!("{}.displacement_m", monitor.name));
    let mut of: Vec<String> = of_monitors.collect();
    if of.is_empty() {
        of = scene.blocks.iter().map(|block| format!("block {}.displacement_m", block.name)).collect();
    }
    of.push(LABEL.into());
    Ok(of)
}
