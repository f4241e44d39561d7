//! Tools of the program beside stepping: studies, certificates, factors of safety, joint tests, stereonets, pictures, reports.
//!
//! Each function gives the JSON text that the program writes, which `python/ndda` reads.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use ndda::certify::error::CertifyError;
use ndda::certify::runs::{Wanted, certify};
use ndda::joint::{self, ClosureTest, Hold, NormalStiffness, ShearTest, TestOutcome, Which};
use ndda::report::{self, ReportError};
use ndda::safety::{self, Plan, Question, SafetyError, Watch as SafetyWatch};
use ndda::stereonet::{self, SLIDING_LATERAL_DEG, StereonetError};
use ndda::study::error::StudyError;
use ndda::study::runner::InProcess;
use ndda::study::{Study, make_folder};
use ndda::sweep::{Ask, How, Sweep};
use ndda::view3d::{self, BoltColour, Frames, Look, Resting, View, ViewError};
use ndda::{Run, certify as certificates};
use ndda_io::outside_files::OutsideFile;
use ndda_io::study::Sampling;
use ndda_io::{OutputFolder, atomic};
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{scene_error, stop_error};
use crate::scene::Scene;
use crate::threads::{SHARED, Threads};
use crate::watched::watched;

/// Adds the functions to the module.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(_study, module)?)?;
    module.add_function(wrap_pyfunction!(_certify, module)?)?;
    module.add_function(wrap_pyfunction!(_safety, module)?)?;
    module.add_function(wrap_pyfunction!(_joint, module)?)?;
    module.add_function(wrap_pyfunction!(_stereonet, module)?)?;
    module.add_function(wrap_pyfunction!(_picture, module)?)?;
    module.add_function(wrap_pyfunction!(_report, module)?)?;
    module.add_function(wrap_pyfunction!(_viewer, module)?)?;
    module.add_function(wrap_pyfunction!(_record, module)?)
}

/// The words of the command line, whose options are arguments here.
fn value_error(error: impl Display) -> PyErr {
    let text = error.to_string();
    let text = text.strip_prefix("--").unwrap_or(&text);
    let before = [" ", "(", "`", "\""];
    PyValueError::new_err(
        before.iter().fold(text.to_string(), |text, sign| text.replace(&format!("{sign}--"), sign)),
    )
}

fn study_error(py: Python<'_>, error: &StudyError) -> PyErr {
    match error {
        StudyError::Scene(errors) => scene_error(py, errors),
        StudyError::Interrupted => PyKeyboardInterrupt::new_err(error.to_string()),
        StudyError::Write(_) | StudyError::Table(_) | StudyError::Record { .. } => {
            PyOSError::new_err(error.to_string())
        }
        other => value_error(other),
    }
}

/// A value of the options, if it is there and no `None`.
fn option<'py, T: for<'a> FromPyObject<'a, 'py>>(
    options: &Bound<'py, PyDict>,
    name: &str,
) -> PyResult<Option<T>> {
    match options.get_item(name)? {
        Some(value) if !value.is_none() => match value.extract() {
            Ok(value) => Ok(Some(value)),
            Err(_) => Err(value_error(format!(
                "{name} is {value}, which has the wrong type: the description of this function names the right one"
            ))),
        },
        _ => Ok(None),
    }
}

/// A text of the options that is read as something.
fn parsed<T: FromStr>(options: &Bound<'_, PyDict>, name: &str, default: T) -> PyResult<T>
where
    T::Err: Display,
{
    let text = option::<String>(options, name)?;
    let refuse = |error| value_error(format!("{name}: {error}"));
    text.map_or(Ok(default), |text| text.parse().map_err(refuse))
}

/// Runs a study, or quantities over values and distributions.
#[pyfunction]
fn _study(py: Python<'_>, file: PathBuf, out: PathBuf, options: &Bound<'_, PyDict>) -> PyResult<String> {
    let sampling = match option::<String>(options, "sampling")?.as_deref() {
        None => None,
        Some("lhs") => Some(Sampling::LatinHypercube),
        Some("sobol") => Some(Sampling::Sobol),
        Some(other) => return Err(value_error(format!("sampling is {other:?}: write lhs or sobol"))),
    };
    let ask = Ask {
        vary: option(options, "vary")?.unwrap_or_default(),
        of: option(options, "of")?.unwrap_or_default(),
        samples: option(options, "samples")?,
        sampling,
        seed: option(options, "seed")?,
        correlate: option(options, "correlate")?.unwrap_or_default(),
        fails_when: option(options, "fails_when")?,
        sensitivity: option(options, "sensitivity")?.unwrap_or(false),
        second_runs: option::<String>(options, "second_runs")?
            .map(|word| word.parse().map_err(|error| value_error(format!("second_runs: {error}"))))
            .transpose()?,
        overrides: option(options, "overrides")?.unwrap_or_default(),
        out: Some(out.clone()),
    };
    let (jobs, threads) = (option(options, "jobs")?.unwrap_or(1), option(options, "threads")?.unwrap_or(1));
    let done = watched(py, &SHARED, |watch| -> Result<String, StudyError> {
        let runner = InProcess { stop: watch.stop.clone() };
        if let Some(sweep) = Sweep::open(&file, &ask)? {
            let how = How { runner: &runner, stop: watch.stop.clone(), say: watch.tell, jobs, threads };
            return sweep.run(&how).map(|(_, json)| json);
        }
        let study = Study::open(&file, Some(out), &ask.overrides)?.with_second_runs(ask.second_runs);
        study.check_reference()?;
        make_folder(&study.out)?;
        let launch = study.launch(&runner, watch.tell, (jobs, threads));
        launch.run_all(&study.runs())?;
        study.gather(&launch).map(|(_, json)| json)
    })?;
    done.map_err(|error| study_error(py, &error))
}

/// Certifies a scene.
#[pyfunction]
fn _certify(
    py: Python<'_>,
    scene: &Scene,
    name: &str,
    out: PathBuf,
    options: &Bound<'_, PyDict>,
) -> PyResult<String> {
    let wanted = Wanted {
        meshes: option(options, "mesh")?.unwrap_or(0),
        penalties: option(options, "penalty")?.unwrap_or(0),
        of: option(options, "of")?.unwrap_or_default(),
    };
    let (jobs, threads) = (option(options, "jobs")?.unwrap_or(1), option(options, "threads")?.unwrap_or(1));
    let model = scene.built(py, &SHARED)?;
    // Runs read the scene again: the file that it came from, or one in the folder of results.
    let (own, text) = (PathBuf::from(&model.loaded.file), model.loaded.text.clone());
    let is_own = std::fs::read_to_string(&own).is_ok_and(|found| found == text);
    let file = if is_own { own } else { out.join(format!("{name}.ron")) };
    let outside = OutsideFile::all_of(&model.loaded.scene, &scene.folder);
    if !is_own && outside.iter().any(|file| file.path.is_relative()) {
        let message = "the files that the scene names may not be found, since the scene was changed or made from a text: write scene.text to a file in their folder, and load that";
        return Err(value_error(message));
    }
    let done = watched(py, &SHARED, |watch| -> Result<String, CertifyError> {
        make_folder(&out)?;
        if !is_own {
            atomic::write(&file, text.as_bytes())?;
        }
        let steps = model.steps();
        let trial = certificates::Trial::new(&model, (file, text), &[], out, steps)?;
        let runner = InProcess { stop: watch.stop.clone() };
        let launch = trial.launch(&runner, watch.tell, (jobs, threads));
        let certificate = certify(&launch, &trial.plan, &trial.name, &wanted)?;
        Ok(certificate.write(&trial.out)?)
    })?;
    done.map_err(|error| match &error {
        CertifyError::Run(error) => study_error(py, error),
        other => value_error(other),
    })
}

/// Finds a factor of safety.
#[pyfunction]
fn _safety(
    py: Python<'_>,
    scene: &Scene,
    name: &str,
    out: Option<PathBuf>,
    options: &Bound<'_, PyDict>,
) -> PyResult<String> {
    let towards: Option<[f64; 3]> = option(options, "towards")?;
    let by = match option::<String>(options, "by")?.as_deref() {
        None | Some("strength") => Question::Strength,
        Some("load") => Question::Load,
        Some("gravity") => Question::Gravity { towards },
        Some(other) => return Err(value_error(format!("by is {other:?}: write strength, load or gravity"))),
    };
    let error: f64 = option(options, "error")?.unwrap_or(0.01);
    if !(error > 0.0 && error < 1.0) {
        return Err(value_error(format!("error is {error}: a relative error lies between 0 and 1, as 1e-2")));
    }
    let plan = Plan { by, error, ..Plan::default() };
    let found = watched(py, &Threads::new(option(options, "threads")?)?, |watch| {
        let watch = SafetyWatch { out: out.as_deref(), stop: &watch.stop, tell: watch.tell };
        safety::find(&scene.loaded, (name, &scene.folder), &plan, &watch)
    })?;
    match found {
        Ok(found) => json(&found),
        Err(SafetyError::Scene(errors)) => Err(scene_error(py, &errors)),
        Err(SafetyError::NotSettled { strength, source }) => {
            let error = stop_error(py, &source);
            let note = format!(
                "the scene does not come to rest even with joints {strength} times as strong: hold its blocks by supports, or raise settle.most_steps if it is only slow"
            );
            error.value(py).call_method1("add_note", (note,)).map(drop).unwrap_or_default();
            Err(error)
        }
        Err(SafetyError::Write(error)) => Err(PyOSError::new_err(error.to_string())),
        Err(other) => Err(value_error(other)),
    }
}

/// Shears or closes one joint of a scene.
#[pyfunction]
fn _joint(py: Python<'_>, scene: &Scene, test: &str, options: &Bound<'_, PyDict>) -> PyResult<String> {
    let stress_pa: f64 = option(options, "normal_stress_pa")?.unwrap_or(1e6);
    let steps: u32 = option(options, "steps")?.unwrap_or(1000);
    let stiffness: Option<f64> = option(options, "joint_stiffness_pa_m")?;
    let normal = match (stiffness, option(options, "max_closure_m")?) {
        (Some(initial_pa_m), Some(most_m)) => NormalStiffness::Hyperbolic { initial_pa_m, most_m },
        (Some(stiffness_pa_m), None) => NormalStiffness::Linear { stiffness_pa_m },
        (None, _) => joint::normal_stiffness(&scene.loaded.scene),
    };
    let outcome = if test == "closure" {
        TestOutcome::closure(&ClosureTest { stress_pa, normal, steps }).map_err(value_error)
    } else {
        let (which, name) = match (option::<String>(options, "of")?, option(options, "between")?) {
            (Some(name), _) => (Which::Joint(name.clone()), format!("joint `{name}`")),
            (_, Some((a, b))) => {
                let title = format!("joint of `{a}` and `{b}`");
                (Which::Between(a, b), title)
            }
            _ => (Which::Everywhere, "a joint".to_string()),
        };
        let hold = match option::<f64>(options, "spring_pa_m")? {
            Some(stiffness_pa_m) => Hold::Stiffness { stiffness_pa_m },
            None if option(options, "constant_volume")?.unwrap_or(false) => Hold::Volume,
            None => Hold::Stress,
        };
        let amplitude_m = option(options, "amplitude_m")?.unwrap_or(0.01);
        let path_m = joint::path(amplitude_m, option(options, "cycles")?.unwrap_or(0), steps);
        let test = ShearTest { stress_pa, hold, normal, path_m: path_m.map_err(value_error)? };
        let shear = || TestOutcome::shear(&scene.loaded.scene, (&which, &name), &test);
        SHARED.run(py, shear)?.map_err(value_error)
    };
    json(&outcome?)
}

/// Orientations of joints on a net, with kinematic checks.
#[pyfunction]
fn _stereonet(py: Python<'_>, input: PathBuf, out: PathBuf, options: &Bound<'_, PyDict>) -> PyResult<String> {
    let slope = option::<String>(options, "slope")?;
    let request = stereonet::Request {
        input,
        overrides: option(options, "overrides")?.unwrap_or_default(),
        net: parsed(options, "net", stereonet::Net::default())?,
        slope: slope.map(|text| stereonet::parse_orientation(&text).map_err(value_error)).transpose()?,
        friction_deg: option(options, "friction_deg")?,
        lateral_deg: option(options, "lateral_deg")?.unwrap_or(SLIDING_LATERAL_DEG),
        out,
    };
    match SHARED.run(py, || stereonet::make(&request))? {
        Ok(made) => json(&made),
        Err(StereonetError::Scene(errors)) => Err(scene_error(py, &errors)),
        Err(other) => Err(value_error(other)),
    }
}

/// Draws the blocks of a run or a scene to a file.
#[pyfunction]
fn _picture(py: Python<'_>, input: PathBuf, out: PathBuf, options: &Bound<'_, PyDict>) -> PyResult<String> {
    let most: Option<usize> = option(options, "animate")?;
    let colour = option::<String>(options, "color")?;
    let look = Look {
        view: parsed(options, "view", View::default())?,
        resting: parsed(options, "resting", Resting::default())?,
        whole: option(options, "whole")?.unwrap_or(false),
        magnify: option(options, "magnify")?.unwrap_or(1.0),
        outlines: option(options, "outlines")?.unwrap_or(true),
        bolts: parsed(options, "bolts", BoltColour::default())?,
        dark: option(options, "dark")?.unwrap_or(false),
        size: option(options, "size")?.unwrap_or(if most.is_some() { (800, 560) } else { (1200, 800) }),
    };
    let request = view3d::Request {
        input,
        overrides: option(options, "overrides")?.unwrap_or_default(),
        frames: match most {
            Some(most) => Frames::Most(most),
            None => Frames::One(parsed(options, "frame", view3d::FrameChoice::default())?),
        },
        colour: colour.map(|text| text.parse().map_err(value_error)).transpose()?,
        look,
        per_second: option(options, "fps")?.unwrap_or(12),
    };
    match SHARED.run(py, || view3d::draw(&request, &out))? {
        Ok(written) => json(&written),
        Err(ViewError::Scene(errors)) => Err(scene_error(py, &errors)),
        Err(other) => Err(value_error(other)),
    }
}

fn report_error(error: ReportError) -> PyErr {
    match error {
        ReportError::Write(error) => PyOSError::new_err(error.to_string()),
        other => value_error(other),
    }
}

/// Writes the page of the run in a folder.
#[pyfunction]
#[pyo3(signature = (folder, file, frames=None))]
fn _report(py: Python<'_>, folder: PathBuf, file: PathBuf, frames: Option<u32>) -> PyResult<String> {
    json(&SHARED.run(py, || report::write(&folder, &file, frames))?.map_err(report_error)?)
}

/// A page with the blocks of frames, each a time [s] and a file.
#[pyfunction]
fn _viewer(py: Python<'_>, title: &str, names: Vec<String>, frames: Vec<(f64, PathBuf)>) -> PyResult<String> {
    SHARED.run(py, || report::viewer(title, &names, &frames))?.map_err(report_error)
}

/// Runs a scene to its end with its files in a folder; gives the text of `summary.json`.
#[pyfunction]
#[pyo3(signature = (scene, folder, name, force, threads=None))]
fn _record(
    py: Python<'_>,
    scene: &Scene,
    folder: PathBuf,
    name: &str,
    force: bool,
    threads: Option<i64>,
) -> PyResult<String> {
    let threads = Threads::new(threads)?;
    let model = scene.built(py, &threads)?;
    let place = std::path::absolute(&scene.folder).unwrap_or_else(|_| scene.folder.clone());
    let file = place.join(Path::new(name).with_extension("ron"));
    let summary = watched(py, &threads, |watch| {
        let created = OutputFolder::create(&folder, force).map_err(ndda::RunError::Write)?;
        let run = Run::new(model).stop_when(watch.stop.clone()).record(created, file)?;
        run.finish(&mut []).map(|outcome| outcome.summary)
    })?;
    let summary = summary.map_err(|error: ndda::RunError| match &error {
        ndda::RunError::Settling(stop) => stop_error(py, stop),
        ndda::RunError::Write(error) => PyOSError::new_err(error.to_string()),
        other => PyRuntimeError::new_err(other.to_string()),
    })?;
    json(&summary)
}

/// A result as JSON.
fn json(value: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|error| PyRuntimeError::new_err(error.to_string()))
}
