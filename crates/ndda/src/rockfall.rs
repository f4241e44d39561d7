//! Rockfall: boulders that are released one by one over terrain, and what engineers ask of them: how far they get, how likely they reach a place, and how high, how
//! fast and with what energy they pass a line.
//!
//! Each boulder is a simulation of its own, of a rigid block and of the ground near it (`window.rs`), and depends on the scene, the seed and its number
//! alone. Boulders fall side by side, and results are put together in the order of their numbers.

mod accuracy;
mod boulder;
mod classes;
mod contact;
mod crossed;
mod draw;
mod fall;
pub mod files;
mod holes;
pub mod map;
mod passage;
#[cfg(feature = "plots")]
mod pictures;
pub mod profile;
mod release;
mod report;
pub mod result;
pub mod spread;
mod stopped;
mod terrain;
#[cfg(test)]
mod tests;
mod window;

pub use accuracy::Accuracy;
pub use boulder::Boulder;
use classes::Classes;
pub use fall::{End, Fall};
pub use passage::Moment;
pub use result::Outcome;
pub use terrain::Terrain;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use ndda_io::WriteError;
use ndda_io::code::Code;
use ndda_io::diagnostic::SceneErrors;
use ndda_io::read::LoadedScene;
use ndda_io::scene::Rockfall;
use rayon::prelude::*;

use crate::places;

/// How often it is said how far a rockfall is.
const SAY: Duration = Duration::from_secs(2);
/// Most points of all paths together, and fewest of one.
const MOST_POINTS: usize = 1_000_000;
const FEWEST_POINTS: usize = 64;
/// Points of a path along the longer side of the terrain, at least.
const PATH_POINTS: f64 = 500.0;
/// Most cells of the map of reach.
const MOST_CELLS: f64 = 1.6e7;

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
pub enum RockfallError {
    /// The scene cannot be used.
    #[error("{}", .0.render(false))]
    Scene(#[from] SceneErrors),
    /// A scene of blocks.
    #[error("the scene has no `rockfall`: `ndda run` runs scenes of blocks")]
    NoRockfall,
    /// The folder has results.
    #[error("{} has the results of an earlier rockfall: name another --out, or replace them by --force", .0.display())]
    Earlier(PathBuf),
    /// The folder of the results cannot be made.
    #[error("cannot make the folder {}: {source}; name another --out", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Threads cannot be started.
    #[error("cannot start the threads: {0}; use a smaller --jobs")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// Somebody asked to end before any fall had ended.
    #[error(
        "interrupted before the first of {count} falls had ended: nothing is written; --count runs fewer"
    )]
    Interrupted {
        /// How many falls were asked for.
        count: usize,
    },
    /// A result cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// What to run, and where results go.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The file of the scene.
    pub file: PathBuf,
    /// Boulders, in the place of those of the scene.
    pub count: Option<u32>,
    /// Seed, in the place of that of the scene.
    pub seed: Option<u64>,
    /// Threads; 0 for all cores.
    pub jobs: usize,
    /// Folder of the results.
    pub out: PathBuf,
    /// Whether they replace those of an earlier rockfall.
    pub force: bool,
}

/// Runs the rockfall of a scene and writes its results; those of the falls that have ended, once `stop` is raised.
///
/// # Errors
/// [`RockfallError`].
pub fn make(
    loaded: LoadedScene,
    request: &Request,
    stop: &AtomicBool,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Outcome, RockfallError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(request.jobs).build()?;
    let folder = request.file.parent().unwrap_or(Path::new("."));
    pool.install(|| {
        let model = Model::new(loaded, folder, (request.count, request.seed))?;
        let out = &request.out;
        let _held = files::make_folder(out, request.force)?;
        let started = Instant::now();
        let falls = model.falls(stop, tell)?;
        let wall_s = started.elapsed().as_secs_f64();
        let outcome = Outcome::new(&model, &places::name_of(&request.file), &falls, wall_s);
        files::write(&model, &outcome, &falls, out)?;
        #[cfg(feature = "plots")]
        pictures::draw(&model, &outcome, &falls, out)?;
        Ok(outcome)
    })
}

/// A rockfall that is ready to run.
pub struct Model {
    /// The scene as it was read.
    pub loaded: LoadedScene,
    /// Its part about boulders.
    pub rockfall: Rockfall,
    /// The ground.
    pub terrain: Terrain,
    /// Classes of ground that no zone names, and how many cells have them.
    pub unnamed: Vec<(u32, usize)>,
    /// The part of the terrain that has neither a class nor a zone, in words.
    pub bare: Option<String>,
    /// Warning of cells without heights that the terrain encloses; none where there are none.
    pub holes: Option<String>,
}

impl Model {
    /// Reads the terrain of a scene and checks that every boulder can be released; files that it names are in `folder`. A count and a seed take the place of
    /// those of the scene.
    ///
    /// # Errors
    /// [`RockfallError`] naming the place in the scene.
    pub fn new(
        loaded: LoadedScene,
        folder: &Path,
        (count, seed): (Option<u32>, Option<u64>),
    ) -> Result<Self, RockfallError> {
        let Some(mut rockfall) = loaded.scene.rockfall.clone() else { return Err(RockfallError::NoRockfall) };
        rockfall.count = count.unwrap_or(rockfall.count);
        rockfall.seed = seed.unwrap_or(rockfall.seed);
        let refuse = |path: &str, message: String| {
            let found = loaded.diagnose_as(Code::CannotBuild, path, message);
            RockfallError::Scene(loaded.errors(vec![found]))
        };
        let classes = Classes::of(&rockfall, folder).map_err(|(path, message)| refuse(&path, message))?;
        let terrain = Terrain::new(&rockfall.terrain, folder, (&rockfall.zones, classes.as_ref()))
            .map_err(|message| refuse("rockfall.terrain", message))?;
        let unnamed = classes.as_ref().map_or_else(Vec::new, |classes| classes.without_zone(&rockfall));
        let bare = classes.and_then(|classes| terrain.bare_of(&classes));
        let holes = terrain.holes();
        let model = Self { rockfall, terrain, unnamed, bare, holes, loaded };
        model.meets_the_terrain()?;
        let cells = model.reach_cells().map(|n| n as f64);
        if cells[0] * cells[1] > MOST_CELLS {
            let message = format!(
                "a map of {} × {} cells is more than memory should hold: give a larger side",
                cells[0], cells[1]
            );
            let found = model.loaded.diagnose_as(Code::OutOfRange, "rockfall.detail.cell_m", message);
            return Err(RockfallError::Scene(model.loaded.errors(vec![found])));
        }
        let refused = (0..model.rockfall.count).into_par_iter().find_map_first(|k| model.case().refusal(k));
        if let Some((path, reason)) = refused {
            let found = model.loaded.diagnose_as(Code::CannotBuild, &path, reason);
            return Err(RockfallError::Scene(model.loaded.errors(vec![found])));
        }
        Ok(model)
    }

    /// Refuses lines and a profile at which no boulder can be: none would be counted there, whatever they do.
    fn meets_the_terrain(&self) -> Result<(), RockfallError> {
        let lines = self.rockfall.lines.iter().enumerate().map(|(k, line)| {
            (format!("rockfall.lines[{k}].points_m"), format!("line `{}`", line.name), &line.points_m)
        });
        let profile_m = Some(&self.rockfall.profile_m).filter(|corners| !corners.is_empty());
        let profile = profile_m.map(|corners| ("rockfall.profile_m".into(), "the profile".into(), corners));
        let missed = lines.chain(profile).filter(|(.., corners)| !self.terrain.is_crossed_by(corners));
        let refuse = |(path, what, _): (String, String, _)| {
            let found = self.loaded.diagnose_as(Code::CannotBuild, &path, self.terrain.is_missed_by(&what));
            found.with_help("check its corners, or the terrain's origin_m")
        };
        let found: Vec<_> = missed.map(refuse).collect();
        if found.is_empty() { Ok(()) } else { Err(RockfallError::Scene(self.loaded.errors(found))) }
    }

    /// What all boulders have in common.
    fn case(&self) -> fall::Case<'_> {
        let materials = &self.loaded.scene.materials;
        let material = materials.iter().find(|material| material.name == self.rockfall.boulders.material);
        let step_m = self.terrain.step_m[0].min(self.terrain.step_m[1]);
        let cell_m = self.cell_m();
        let [least, most] = self.terrain.bounds_m();
        let side_m = (most[0] - least[0]).max(most[1] - least[1]);
        fall::Case {
            scene: &self.loaded.scene,
            rockfall: &self.rockfall,
            terrain: &self.terrain,
            material: material.expect("names of materials have been checked"),
            seed: self.rockfall.seed,
            path_m: self.rockfall.detail.path_m.unwrap_or((0.5 * step_m).min(side_m / PATH_POINTS)),
            most_points: (MOST_POINTS / self.rockfall.count as usize).max(FEWEST_POINTS),
            cell_m,
            cells: self.reach_cells(),
        }
    }

    /// The longest step [s].
    pub fn step_s(&self) -> f64 {
        self.case().step_s()
    }

    /// Side of the cells of the map of reach [m].
    pub fn cell_m(&self) -> f64 {
        let step_m = self.terrain.step_m[0].max(self.terrain.step_m[1]);
        self.rockfall.detail.cell_m.unwrap_or(step_m)
    }

    /// Cells of the map of reach along x and y.
    pub fn reach_cells(&self) -> [usize; 2] {
        let [least, most] = self.terrain.bounds_m();
        [0, 1].map(|axis| ((most[axis] - least[axis]) / self.cell_m()).ceil().max(1.0) as usize)
    }

    /// The fall of the boulder with a number; it depends on nothing but the scene, its seed and that number.
    pub fn fall(&self, boulder: u32) -> Fall {
        self.case().fall(boulder)
    }

    /// All falls, side by side on the threads of the pool that this is called in. Once `stop` is raised no other fall begins, those on their way go on to
    /// their end, and the answer is what has ended.
    ///
    /// # Errors
    /// [`RockfallError::Interrupted`] where that is none.
    pub fn falls(&self, stop: &AtomicBool, tell: &(dyn Fn(&str) + Sync)) -> Result<Vec<Fall>, RockfallError> {
        let (done, said) = (AtomicUsize::new(0), Mutex::new(Instant::now()));
        let count = self.rockfall.count as usize;
        let fall = |boulder| {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let fall = self.fall(boulder);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            if let Ok(mut said) = said.try_lock()
                && said.elapsed() >= SAY
            {
                *said = Instant::now();
                let ends =
                    if stop.load(Ordering::Relaxed) { ": ending after those that fall now" } else { "" };
                tell(&format!("{done} of {count} boulders{ends}"));
            }
            Some(fall)
        };
        // One at a time, so that no thread waits for the long falls of another.
        let falls: Vec<Option<Fall>> =
            (0..self.rockfall.count).into_par_iter().with_max_len(1).map(fall).collect();
        let falls: Vec<Fall> = falls.into_iter().flatten().collect();
        if falls.is_empty() { Err(RockfallError::Interrupted { count }) } else { Ok(falls) }
    }
}
