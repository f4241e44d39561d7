//! The parts of a scene's run, what it leaves out, and why.
//!
//! The scene is built as it is for a run, and what was built says what it is.

mod text;

use std::collections::BTreeMap;

use ndda_contact::Part;
use ndda_io::OutputFolder;
use ndda_io::scene::{Scene, TableFormat};
use ndda_solver::{FactorPlan, KindPlan, Plan, Simulation};
use serde::Serialize;

use crate::forecast::{cost, step};
use crate::judge::reference;
use crate::numbers::counted;
use crate::run::fields;
use crate::{Model, build};

/// The form of the JSON that is printed.
const SCHEMA: &str = "ndda.explain/1";

/// The plan of a run.
#[derive(Debug, Serialize)]
pub struct Explanation {
    /// Form of this object.
    pub schema: &'static str,
    /// The scene's file.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// Its parameters by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, f64>,
    /// Steps of the run.
    pub steps: u64,
    /// Δt [s].
    pub step_s: f64,
    /// Contact's advice on that step.
    pub step_advice: Option<String>,
    /// Blocks by how they may move.
    pub blocks: Vec<KindPlan>,
    /// Distinct matrices.
    pub factors: Vec<FactorPlan>,
    /// Parts that are in, and parts that are left out.
    pub parts: Vec<Part>,
    /// Files that will be written.
    pub files: Vec<String>,
    /// Threads that a run would have, unless `--threads` says otherwise.
    pub threads: usize,
    /// Cargo features of this program, and whether they are in.
    pub features: Vec<(&'static str, bool)>,
}

/// The plan of a scene that is ready to run.
pub fn explain(model: &mut Model) -> Explanation {
    let Model { loaded, simulation, monitors, .. } = model;
    let scene = &loaded.scene;
    let Plan { kinds, factors, mut parts } = simulation.plan();
    parts.extend(phases(scene));
    parts.extend(works(scene, simulation.bolt_count()));
    parts.extend(outputs(scene, monitors.len()));
    Explanation {
        schema: SCHEMA,
        scene: loaded.file.clone(),
        title: scene.title.clone(),
        parameters: scene.parameters.clone(),
        steps: build::all_steps(scene),
        step_s: simulation.step_s(),
        step_advice: advice(scene, simulation),
        blocks: kinds,
        factors,
        parts,
        files: files(scene),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        features: vec![
            ("fancy", cfg!(feature = "fancy")),
            ("gmsh", cfg!(feature = "gmsh")),
            ("parquet", cfg!(feature = "parquet")),
            ("plots", cfg!(feature = "plots")),
            ("png", cfg!(feature = "png")),
            ("report", cfg!(feature = "report")),
            ("tables", cfg!(feature = "tables")),
            ("tetgen", cfg!(feature = "tetgen")),
        ],
    }
}

fn advice(scene: &Scene, simulation: &mut Simulation) -> Option<String> {
    step::advise(scene, simulation).map(|advice| advice.to_string())
}

fn phases(scene: &Scene) -> [Part; 1] {
    let settles = scene.settle.map(|settle| {
        format!(
            "until the speed is {:e} of the largest, at most {} steps",
            settle.tolerance, settle.most_steps
        )
    });
    [Part::of(
        "settling",
        settles.is_some(),
        settles.unwrap_or_default(),
        "the run begins from the scene as written, without `settle`",
    )]
}

/// What is done to the rock.
fn works(scene: &Scene, bolts: usize) -> [Part; 3] {
    let stages: Vec<&str> = scene.stages.iter().map(|stage| stage.name.as_str()).collect();
    [
        Part::of(
            "water",
            !scene.water.is_empty(),
            format!("pressure by {}", counted(scene.water.len(), "entry", "entries")),
            "the scene has no `water`",
        ),
        Part::of(
            "bolts",
            bolts > 0,
            format!("{}, solved in every step", counted(bolts, "bolt", "bolts")),
            "the scene has no `bolts`",
        ),
        Part::of(
            "stages of construction",
            !stages.is_empty(),
            format!("{} after time.end_s: {}", counted(stages.len(), "stage", "stages"), stages.join(", ")),
            "the scene has no `stages`",
        ),
    ]
}

fn outputs(scene: &Scene, monitors: usize) -> [Part; 7] {
    let output = &scene.output;
    let compared =
        scene.reference.as_ref().map(|r| format!("{}, in every row of the history", reference::kind(r).0));
    [
        Part::included(
            "history",
            format!(
                "{} rows at most, with {}",
                output.history_rows,
                counted(monitors, "monitor", "monitors")
            ),
        ),
        Part::of(
            "fields",
            output.frames > 0,
            format!(
                "{} frames after the first, {:?}, {:?} as {:?}",
                output.frames, output.fields, output.format, output.precision
            ),
            "output.frames is 0",
        ),
        Part::of(
            "recovery of stress",
            output.frames > 0 && fields::need_stress(&output.fields),
            "for every frame",
            "no frame holds a stress",
        ),
        Part::of(
            "contact forces of each pair of blocks",
            output.contacts,
            "in every row of the history",
            "output.contacts is false",
        ),
        Part::of(
            "reactions of supports",
            output.reactions,
            "in every row of the history",
            "output.reactions is false",
        ),
        Part::of(
            "checkpoints during the run",
            output.checkpoint_wall_s > 0.0,
            format!("every {} s of wall clock, and at start and end", output.checkpoint_wall_s),
            "output.checkpoint_wall_s is 0: at start and end alone",
        ),
        Part::of(
            "comparison with a closed form",
            compared.is_some(),
            compared.unwrap_or_default(),
            "the scene names no reference",
        ),
    ]
}

fn files(scene: &Scene) -> Vec<String> {
    let mut files: Vec<String> =
        [OutputFolder::SUMMARY, OutputFolder::CHECKPOINT, OutputFolder::LOG].map(Into::into).to_vec();
    let tables = [(OutputFolder::HISTORY, true), (OutputFolder::CONTACTS, scene.output.contacts)];
    for ((csv, written), parquet) in tables.into_iter().zip(OutputFolder::PARQUET) {
        if written && scene.output.history != TableFormat::Parquet {
            files.push(csv.into());
        }
        if written && scene.output.history != TableFormat::Csv {
            files.push(parquet.into());
        }
    }
    files.extend(scene.output.blocks.then(|| OutputFolder::BLOCKS.into()));
    files.extend((!scene.bolts.is_empty()).then(|| OutputFolder::BOLTS.into()));
    files.extend(scene.stages.iter().map(|stage| OutputFolder::stage_checkpoint_name(&stage.name)));
    if scene.output.frames > 0 {
        let last = OutputFolder::frame_name(cost::frames(scene) as usize - 1);
        let fields = OutputFolder::FIELDS_FOLDER;
        files.push(OutputFolder::FIELDS_INDEX.into());
        files.push(format!("{fields}/{} to {fields}/{last}", OutputFolder::frame_name(0)));
    }
    files
}
