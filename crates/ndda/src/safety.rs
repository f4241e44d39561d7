//! Factor of safety: by how much the strength of joints may fall, loads grow or gravity tilt before blocks move.
//!
//! The scene is brought to rest once. From there each trial divides the strength by a factor F (tan φ, c and σ_t of every law), or
//! multiplies loads, or turns gravity, and steps until its blocks rest or accelerate (`trial.rs`). The largest factor at which they stand and the
//! smallest at which they fail are the answer: a bracket from runs, and no limit equilibrium (`search.rs`).

mod changes;
mod edges;
mod failing;
mod film;
mod free_blocks;
mod kept;
mod mechanism;
mod opened;
mod remarks;
mod report;
mod rest;
mod search;
mod slender;
mod slide;
mod trial;
mod watched;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ndda_io::diagnostic::SceneErrors;
use ndda_io::read::LoadedScene;
use ndda_io::{OutputFolder, WriteError};
use ndda_solver::StepError;
use serde::{Deserialize, Serialize};

use crate::documents::{is_of, write_json};
use crate::places;

pub use changes::{By, Question};
pub use failing::BlockVelocity;
pub use free_blocks::Moved;
pub use mechanism::{Kind, Mechanism, MovingBlock, Plane};
pub use opened::Opened;
pub use report::text;
pub use trial::{State, Trial};

/// The question of a search for a factor of safety.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Quantity that is changed from trial to trial.
    pub by: Question,
    /// Relative width of the bracket.
    pub error: f64,
    /// Largest factor that is tried; its inverse is the smallest.
    pub most: f64,
}

impl Default for Plan {
    fn default() -> Self {
        Self { by: Question::Strength, error: 0.01, most: 100.0 }
    }
}

/// The largest factor at which blocks stand and the smallest at which they fail.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bracket {
    /// Blocks stand. None if they fail at the smallest factor that was tried.
    pub lower: Option<f64>,
    /// Blocks fail. None if they stand at the largest factor that was tried.
    pub upper: Option<f64>,
}

/// The answer, as `safety.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Safety {
    /// `ndda.safety/1`.
    pub schema: String,
    /// Version of ndda.
    pub version: String,
    /// Name of the scene: its file without the ending.
    pub scene: String,
    /// The scene's own title.
    pub title: String,
    /// CRC-32 of the scene and its blocks, hexadecimal.
    pub scene_crc32: String,
    /// Quantity that was changed from trial to trial.
    pub by: By,
    /// Relative width of the bracket that was asked for.
    pub error: f64,
    /// The answer.
    pub factor_of_safety: Bracket,
    /// Blocks that do not stand as they are drawn, even with joints 32 times as strong, the farthest first; trials begin where they rest then. If they are those that fail,
    /// or all, the upper end of the bracket is what follows from that: 1/32, or 1 where loads change. Left out where all stand.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_standing: Vec<Moved>,
    /// How blocks fail at the upper end. Left out where nothing fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mechanism: Option<Mechanism>,
    /// Blocks that move then. Empty where nothing fails.
    pub moving_blocks: Vec<MovingBlock>,
    /// All trials by their factor.
    pub trials: Vec<Trial>,
    /// Remarks to read before using the answer.
    pub remarks: Vec<String>,
    /// Wall-clock time, all calls together [s].
    pub wall_s: f64,
    /// Trials among them that were known from earlier calls.
    #[serde(skip)]
    pub known_trials: usize,
    /// Wall-clock time of these calls [s].
    #[serde(skip)]
    pub earlier_s: f64,
}

impl Safety {
    /// Whether the scene stands as it is drawn, or what does not has no part in what fails.
    pub fn stands_as_drawn(&self) -> bool {
        self.not_standing.is_empty() || self.factor_of_safety.lower.is_some()
    }
}

/// Schema of [`Safety`].
pub const SCHEMA: &str = "ndda.safety/1";

/// Why there is no factor of safety.
#[derive(Debug, thiserror::Error)]
pub enum SafetyError {
    /// A changed scene is none that can be built.
    #[error("{}", .0.render(false))]
    Scene(#[from] SceneErrors),
    /// Boulders over terrain.
    #[error("a rockfall scene has no blocks that stand or fail: `ndda rockfall` lets its boulders fall")]
    Rockfall,
    /// There is no strength that could be reduced.
    #[error(
        "joints have no friction, cohesion or tensile strength that could be reduced, so blocks that can slide have a factor of safety of 0: \
         give contact.friction a friction_deg above 0 or a cohesion_pa"
    )]
    NoStrength,
    /// It moves, and there is no strength that could hold it.
    #[error(
        "the scene does not come to rest, and its joints have no friction, cohesion or tensile strength that could hold it ({source}): \
         give contact.friction a friction_deg above 0 or a cohesion_pa, or hold blocks by supports"
    )]
    NotHeld {
        /// Error of the solver.
        source: StepError,
    },
    /// Neither weight nor loads.
    #[error(
        "nothing loads the blocks, so they stand whatever the strength of their joints is and have no factor of safety: {}",
        crate::forecast::held::LOAD
    )]
    NoLoads,
    /// No loads.
    #[error(
        "the scene has no forces or tractions to multiply: give `forces` or `tractions`, or use --by strength"
    )]
    NoLoad,
    /// No gravity, or none that could be tilted so.
    #[error(
        "gravity cannot be tilted towards {towards:?}: give gravity_m_s2, and a direction that is not along it"
    )]
    NoTilt {
        /// The direction that was asked for.
        towards: [f64; 3],
    },
    /// Blocks stand on level ground.
    #[error(
        "blocks stand on planes of {slope_deg:.2}°, so that there is no slope to make steeper: use --by strength or --by load, or tilt the scene"
    )]
    NoSlope {
        /// Angle of the steepest way down [°].
        slope_deg: f64,
    },
    /// No block slides that way.
    #[error(
        "no block can slide towards ({}): the steepest way down is ({}), which it is across or against. Give --towards a direction less than 90° from that, or leave it out",
        numbers(towards),
        numbers(down)
    )]
    NoSlopeTowards {
        /// The direction that was asked for.
        towards: [f64; 3],
        /// The steepest way down, of length 1.
        down: [f64; 3],
    },
    /// Blocks do not feel each other.
    #[error("the scene has no contact between blocks, so nothing can stand: give `contact`")]
    NoContact,
    /// Stages of construction.
    #[error(
        "a factor of safety is that of one state: give a scene without `stages`, with the blocks and loads of the stage"
    )]
    Stages,
    /// Supports move.
    #[error(
        "the support of `{block}` moves, and a factor of safety is that of blocks at rest: hold it by `Fixed`, and add the inertial acceleration \
         to gravity_m_s2, such as (0, -1.4715, -9.81) for 0.15 g"
    )]
    MovedSupport {
        /// Its block.
        block: String,
    },
    /// No block can move.
    #[error("every block of the scene is fixed, so nothing can fail")]
    NothingFree,
    /// The scene does not come to rest, however strong its joints are.
    #[error(
        "the scene does not come to rest even with joints {strength} times as strong ({source}): hold its blocks by supports, or raise settle.most_steps if it is only slow"
    )]
    NotSettled {
        /// The largest factor on the strength that was tried.
        strength: f64,
        /// Error of the solver.
        source: StepError,
    },
    /// Somebody asked to end.
    #[error("interrupted: the same command goes on with the trials that are done")]
    Interrupted,
    /// The folder has the answer of another scene.
    #[error("{} has the answer of the scene `{scene}`: name another --out, or replace it by --force", folder.display())]
    OtherScene {
        /// The folder.
        folder: PathBuf,
        /// The scene.
        scene: String,
    },
    /// The folder of the answer cannot be made.
    #[error("cannot make the folder {}: {source}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The answer cannot be written, or an earlier one not be read.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Three numbers to show, without noise.
fn numbers(of: &[f64; 3]) -> String {
    of.map(|number| format!("{}", (1e4 * number).round() / 1e4 + 0.0)).join(", ")
}

/// Folder of the answer and its trials, and their observer.
pub struct Watch<'a> {
    /// Folder of `safety.json`, which is written after each trial; none to write nothing.
    pub out: Option<&'a Path>,
    /// Raised when somebody asks to end.
    pub stop: &'a Arc<AtomicBool>,
    /// Told of each trial.
    pub tell: &'a (dyn Fn(&str) + Sync),
}

/// Finds the factor of safety of a scene that has been read and checked; files that it names are in `folder`. Trials run side by side
/// on the threads of the pool that this is called in, and the answer does not depend on their number.
///
/// # Errors
/// [`SafetyError`].
pub fn find(
    loaded: &LoadedScene,
    (name, folder): (&str, &Path),
    plan: &Plan,
    watch: &Watch,
) -> Result<Safety, SafetyError> {
    search::Search::new(loaded, (name, folder), plan, watch)?.answer()
}

/// Whether blocks stand at one factor, which costs a fraction of the search for the largest. With [`Question::Load`] and
/// [`Question::Gravity`] the change comes at once, from rest, and blocks may swing beyond where they would rest.
///
/// # Errors
/// [`SafetyError`].
pub fn at(
    loaded: &LoadedScene,
    (name, folder): (&str, &Path),
    factor: f64,
    plan: &Plan,
    watch: &Watch,
) -> Result<State, SafetyError> {
    search::Search::new(loaded, (name, folder), plan, watch)?.at(factor)
}

/// Folder of the run that shows how blocks fail.
pub fn mechanism_folder(out: &Path) -> PathBuf {
    out.join(places::MECHANISM)
}

/// File of the answer in a folder.
pub fn file(out: &Path) -> PathBuf {
    out.join(places::SAFETY)
}

/// Makes the folder of an answer; with `anew`, without the trials of an earlier call.
///
/// # Errors
/// The folder has the answer of another scene and is not to begin anew, is that of a run, or cannot be made.
pub fn make_folder(out: &Path, name: &str, anew: bool) -> Result<(), SafetyError> {
    OutputFolder::refuse_run(out)?;
    // Until its first trial has ended, an answer is an empty file.
    let is_empty = std::fs::metadata(file(out)).is_ok_and(|found| found.len() == 0);
    let has_earlier = is_empty || is_of(&file(out), "ndda.safety");
    OutputFolder::refuse_others(out, has_earlier, &[places::SAFETY])?;
    if let Some(scene) = other_scene(out, name).filter(|_| !anew) {
        return Err(SafetyError::OtherScene { folder: out.to_path_buf(), scene });
    }
    // An empty file is no earlier answer to go on from.
    let forget = || match anew {
        true => kept::Kept::forget(out).and_then(|()| std::fs::write(file(out), "")),
        false => Ok(()),
    };
    std::fs::create_dir_all(out)
        .and_then(|()| forget())
        .map_err(|source| SafetyError::Folder { folder: out.to_path_buf(), source })
}

/// Name of the scene whose answer is in a folder, if that is another one.
fn other_scene(out: &Path, name: &str) -> Option<String> {
    let text = std::fs::read_to_string(file(out)).ok()?;
    let earlier: Safety = serde_json::from_str(&text).ok()?;
    Some(earlier.scene).filter(|scene| scene != name)
}

fn write(out: &Path, safety: &Safety) -> Result<(), WriteError> {
    write_json(&file(out), safety).map(drop)
}
