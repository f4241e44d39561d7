//! Time and output of a run, estimated from a few of its steps.

use std::fmt;
use std::time::{Duration, Instant};

use ndda_io::scene::Scene;
use ndda_io::{OutputFolder, checkpoint};
use ndda_solver::{Simulation, SinkError};
use serde::Serialize;

use super::doubts::has_friction;
use super::memory::readable;
use crate::numbers::counted;
use crate::run::fields::FieldWriter;
use crate::run::recorder::{Extras, columns, held_blocks};
use crate::run::schedule::{events, is_due};
use crate::run::{bolts, contact_rows, motion, stage_log, twin};
use crate::{build, machine};

/// Steps are timed this long, but at least a few of them: a check of a small scene is to be felt as instant.
const TIMED: Duration = Duration::from_millis(10);
const FEWEST_STEPS: u64 = 3;
/// A run that takes longer than this [s] is timed for `TIMED_LONGER`, and by its later steps: contacts and the rounds of friction grow.
const LONG_S: f64 = 10.0;
/// The same limit [s] for scenes in which several blocks have friction: in the first steps contacts carry little force, and the search for friction is short.
const LONG_WITH_FRICTION_S: f64 = 1.0;
const TIMED_LONGER: Duration = Duration::from_secs(1);
/// A number in a table and its comma, on average [B].
const NUMBER_BYTES: u64 = 20;

/// A file that a run writes, or several of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileGuess {
    /// Its name.
    pub name: String,
    /// How many.
    pub count: u64,
    /// Size of all of them [B].
    pub bytes: u64,
}

impl FileGuess {
    /// What there are several of: frames of a run, and a checkpoint beside the one before it.
    fn several(&self) -> String {
        match self.count {
            0..2 => String::new(),
            count if self.name == OutputFolder::CHECKPOINT => {
                format!(" ({count}: the last and the one before)")
            }
            count => format!(" ({count} frames)"),
        }
    }
}

/// Estimated time and output of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Guess {
    /// Steps that were timed.
    pub timed_steps: u64,
    /// Wall-clock time of a run on as many threads as this process has, if contacts stay as many [s].
    pub run_s: f64,
    /// Whether blocks touched in these steps; none where they cannot.
    pub touches: Option<bool>,
    /// Whether the scene comes to rest first, in steps that nobody knows beforehand and `run_s` leaves out.
    pub settles: bool,
    /// Time of the twin that shows whether the motion is sensitive, which a run makes if three or more blocks move; none where fewer can [s].
    pub twin_s: Option<f64>,
    /// Time of the twin with half the step, which a run makes if a block hits several times, or once on strongly damped contact where blocks deform, or if loads change along its
    /// way, or always; none where nothing can move [s].
    pub half_step_s: Option<f64>,
    /// Whether it makes that twin always: without contact, and with friction where it takes about a second.
    pub always_halves: bool,
    /// Most memory of this process, which has done all that a run does [B]; none where the system does not report it.
    pub memory_bytes: Option<u64>,
    /// Files.
    pub files: Vec<FileGuess>,
}

/// Does a few steps, a row and a frame, and reckons.
///
/// # Errors
/// Errors that would stop the run in these steps.
pub fn guess(scene: &Scene, simulation: &mut Simulation) -> Result<Guess, SinkError> {
    let steps = build::all_steps(scene);
    simulation.watch_contacts(scene.output.contacts);
    let started = Instant::now();
    let mut timed_steps = 0;
    // The first one makes lists that the others keep.
    let touches = simulation.step()?.contact.contact_pairs > 0;
    let first_s = started.elapsed().as_secs_f64();
    let (timed, mut step_s) = timed_steps_of(simulation, steps.saturating_sub(1), TIMED)?;
    timed_steps += timed;
    let is_shared = has_friction(scene) && twin::may_want_twin(simulation);
    let long_s = if is_shared { LONG_WITH_FRICTION_S } else { LONG_S };
    if steps as f64 * step_s > long_s {
        for _ in 0..2 {
            let left = steps.saturating_sub(1 + timed_steps);
            let (timed, later_s) = timed_steps_of(simulation, left, TIMED_LONGER / 2)?;
            timed_steps += timed;
            step_s = if timed > 0 { later_s } else { step_s };
        }
    }
    let touches = touches || (timed_steps + 1 < steps && simulation.step()?.contact.contact_pairs > 0);
    let touches = simulation.has_contact().then_some(touches);
    let started = Instant::now();
    simulation.sample()?;
    let row_s = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let frame = if scene.output.frames > 0 { FieldWriter::encode(scene, simulation)? } else { Vec::new() };
    let frame_s = started.elapsed().as_secs_f64();
    let rows = events(steps, scene.output.history_rows.into());
    let frames = frames(scene);
    let run_s = first_s + steps as f64 * step_s + rows as f64 * row_s + frames as f64 * frame_s;
    // Twins write nothing.
    let [twin_s, half_step_s] = [twin::may_want_twin(simulation), twin::may_want_half_step(simulation)]
        .map(|may| may.then_some(first_s + steps as f64 * step_s));
    let half_step_s = half_step_s.map(|twin_s| 2.0 * twin_s);
    let files = files(scene, simulation, (rows, frames), frame.len() as u64);
    let settles = scene.settle.is_some();
    Ok(Guess {
        timed_steps,
        run_s,
        touches,
        settles,
        twin_s,
        half_step_s,
        always_halves: twin::always_halves(simulation, steps),
        memory_bytes: machine::peak_memory_bytes(),
        files,
    })
}

/// Does steps for so long, at least a few and at most `most`; gives how many, and the time of one [s].
fn timed_steps_of(simulation: &mut Simulation, most: u64, long: Duration) -> Result<(u64, f64), SinkError> {
    let started = Instant::now();
    let mut done = 0;
    while done < most && (done < FEWEST_STEPS || started.elapsed() < long) {
        simulation.step()?;
        done += 1;
    }
    Ok((done, started.elapsed().as_secs_f64() / done.max(1) as f64))
}

/// Frames of a run, that of the start among them.
pub fn frames(scene: &Scene) -> u64 {
    let asked = u64::from(scene.output.frames);
    let steps = build::all_steps(scene);
    let ends = stage_log::ends(scene).into_iter().filter(|end| !is_due(*end, steps, asked));
    if asked > 0 { events(steps, asked) + ends.count() as u64 } else { 0 }
}

fn files(scene: &Scene, simulation: &Simulation, (rows, frames): (u64, u64), frame: u64) -> Vec<FileGuess> {
    let output = &scene.output;
    let file = |name: &str, count: u64, bytes: u64| FileGuess { name: name.to_string(), count, bytes };
    let held = if output.reactions { held_blocks(simulation) } else { Vec::new() };
    let monitors = scene.monitors.iter().map(|monitor| monitor.name.as_str());
    let columns = columns(monitors, &held, Extras::of(scene)).len() as u64;
    // Of the scene, its text is kept.
    let saved = checkpoint::size(&simulation.snapshot_view()) + checkpoint::size(scene);
    let blocks = simulation.blocks().len() as u64;
    let mut files = vec![
        file(OutputFolder::HISTORY, 1, rows * columns * NUMBER_BYTES),
        file(OutputFolder::CHECKPOINT, 2, 2 * saved),
        file(OutputFolder::SUMMARY, 1, 3000 + 600 * blocks),
        file(OutputFolder::LOG, 1, 4000 + 100 * blocks),
    ];
    if frames > 0 {
        files.push(file(&format!("{}/*.vtu", OutputFolder::FIELDS_FOLDER), frames, frames * frame));
    }
    if output.blocks {
        let rows = blocks * events(build::all_steps(scene), output.frames.into());
        files.push(file(OutputFolder::BLOCKS, 1, rows * motion::COLUMNS.len() as u64 * NUMBER_BYTES));
    }
    let pieces = bolt_pieces(simulation);
    if pieces > 0 {
        let rows = pieces * events(build::all_steps(scene), output.frames.into());
        files.push(file(OutputFolder::BOLTS, 1, rows * bolts::COLUMNS.len() as u64 * NUMBER_BYTES));
    }
    for stage in &scene.stages {
        files.push(file(&OutputFolder::stage_checkpoint_name(&stage.name), 1, saved));
    }
    if output.contacts {
        let pairs = ndda_contact::resultants(simulation.blocks(), &mut simulation.contacts().to_vec()).len();
        let numbers = (pairs * contact_rows::COLUMNS.len()) as u64;
        files.push(file(OutputFolder::CONTACTS, 1, rows * numbers * NUMBER_BYTES));
    }
    files
}

/// Rows of a frame in the table of bolts.
fn bolt_pieces(simulation: &Simulation) -> u64 {
    let mut pieces = Vec::new();
    if simulation.bolt_count() > 0 {
        simulation.bolt_pieces(&mut pieces);
    }
    pieces.len() as u64
}

impl fmt::Display for Guess {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a run would take about {:.1} s", self.run_s)?;
        if let Some(bytes) = self.memory_bytes {
            write!(f, " and {} of memory", readable(bytes))?;
        }
        let touches = match self.touches {
            Some(true) => "; longer if more blocks come to touch",
            Some(false) => ", in which no blocks touch; longer once they do",
            None => "",
        };
        write!(f, " ({} timed{touches})", counted(self.timed_steps as usize, "step", "steps"))?;
        if self.settles {
            f.write_str("\n  and as long as it takes to settle before, which may be many times that")?;
        }
        if let Some(twin_s) = self.twin_s {
            write!(
                f,
                "\n  {twin_s:.1} s more if three or more blocks move: a second run shows whether small differences grow"
            )?;
        }
        if let Some(half_step_s) = self.half_step_s {
            write!(
                f,
                "\n  {half_step_s:.1} s more{}: a second run with half the step shows whether speeds are right",
                if self.always_halves { "" } else { " if impacts or changing loads call for it" }
            )?;
        }
        write!(f, "\nit would write")?;
        for file in &self.files {
            write!(f, "\n  {:9} {}{}", readable(file.bytes), file.name, file.several())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    fn guess_of(blocks: usize) -> Guess {
        let block = |i: usize| {
            format!(
                "(name: \"{i}\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: ({}, 0, 0)),",
                2 * i
            )
        };
        let text = format!(
            "(title: \"blocks\", time: (step_s: 1e-4, end_s: 0.01), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
            blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (40, 20, 1), cells: (1, 1, 1)),
                at_m: (-10, -10, -1)), {}],
            contact: Potential(penalty_pa: 1e8, potential: Smooth(), friction: (friction_deg: 25)))",
            (0..blocks).map(block).collect::<String>()
        );
        let mut model = Model::from_text(&text).unwrap();
        guess(&model.loaded.scene, &mut model.simulation).unwrap()
    }

    #[test]
    fn a_twin_is_foreseen_where_three_blocks_can_move() {
        let two = guess_of(2);
        assert_eq!(two.twin_s, None);
        assert!(0.0 < two.half_step_s.unwrap() && two.half_step_s.unwrap() <= 2.0 * two.run_s, "{two:?}");
        assert!(
            two.always_halves && two.to_string().contains("s more: a second run with half the step"),
            "{two}"
        );
        assert!(!two.to_string().contains("if three or more blocks move"), "{two}");
        let three = guess_of(3);
        let twin_s = three.twin_s.unwrap();
        assert!(0.0 < twin_s && twin_s <= three.run_s, "{three:?}");
        assert!(
            three.to_string().contains(
                "s more if three or more blocks move: a second run shows whether small differences grow"
            ),
            "{three}"
        );
    }
}
