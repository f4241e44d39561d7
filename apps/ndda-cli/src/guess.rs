//! What a run will take and write, from a few of its steps.

use std::fmt;
use std::time::{Duration, Instant};

use ndda_io::checkpoint;
use ndda_io::scene::{Output, Scene};
use ndda_solver::{Simulation, SinkError};
use serde::Serialize;

use crate::fields::FieldWriter;
use crate::machine;
use crate::recorder::held_blocks;
use crate::wiring;

/// Steps are timed this long, but at least a few of them: a check of a small scene is to be felt as instant.
const TIMED: Duration = Duration::from_millis(10);
const FEWEST_STEPS: u64 = 3;
/// A number in a table and its comma, on average [B].
const NUMBER_BYTES: u64 = 20;
/// Columns of the history besides monitors and reactions, and of the contacts.
const HISTORY_COLUMNS: u64 = 21;
const CONTACT_COLUMNS: u64 = 18;

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

/// What a run will take and write.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Guess {
    /// Steps that were timed.
    pub timed_steps: u64,
    /// Wall-clock time of a run on as many threads as this process has, if contacts stay as many [s].
    pub run_s: f64,
    /// Most memory of this process, which has done all that a run does [B]; none where the system does not tell.
    pub memory_bytes: Option<u64>,
    /// Files.
    pub files: Vec<FileGuess>,
}

/// Does a few steps, a row and a frame, and reckons.
///
/// # Errors
/// What would stop the run in these steps.
pub fn guess(scene: &Scene, simulation: &mut Simulation) -> Result<Guess, SinkError> {
    let steps = wiring::steps(&scene.time);
    simulation.watch_contacts(scene.output.contacts);
    let started = Instant::now();
    let mut timed_steps = 0;
    // The first one makes lists that the others keep.
    simulation.step()?;
    let first_s = started.elapsed().as_secs_f64();
    let started = Instant::now();
    while timed_steps + 1 < steps && (timed_steps < FEWEST_STEPS || started.elapsed() < TIMED) {
        simulation.step()?;
        timed_steps += 1;
    }
    let step_s = started.elapsed().as_secs_f64() / timed_steps.max(1) as f64;
    let started = Instant::now();
    simulation.sample()?;
    let row_s = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let frame = if scene.output.frames > 0 { FieldWriter::encode(scene, simulation)? } else { Vec::new() };
    let frame_s = started.elapsed().as_secs_f64();
    let (rows, frames) = counts(&scene.output, steps);
    let run_s = first_s + steps as f64 * step_s + rows as f64 * row_s + frames as f64 * frame_s;
    let files = files(scene, simulation, (rows, frames), frame.len() as u64);
    Ok(Guess { timed_steps, run_s, memory_bytes: machine::peak_memory_bytes(), files })
}

/// Rows and frames of a run.
fn counts(output: &Output, steps: u64) -> (u64, u64) {
    let rows = u64::from(output.history_rows).clamp(1, steps) + 1;
    let frames = u64::from(output.frames).min(steps);
    (rows, if frames > 0 { frames + 1 } else { 0 })
}

fn files(scene: &Scene, simulation: &Simulation, (rows, frames): (u64, u64), frame: u64) -> Vec<FileGuess> {
    let output = &scene.output;
    let file = |name: &str, count: u64, bytes: u64| FileGuess { name: name.to_string(), count, bytes };
    let held = if output.reactions { held_blocks(simulation).len() as u64 } else { 0 };
    let columns = HISTORY_COLUMNS + 6 * scene.monitors.len() as u64 + 3 * held;
    // Of the scene, its text is kept.
    let saved = checkpoint::size(&simulation.snapshot()) + checkpoint::size(scene);
    let blocks = simulation.blocks().len() as u64;
    let mut files = vec![
        file("history", 1, rows * columns * NUMBER_BYTES),
        file("checkpoint.ndda", 2, 2 * saved),
        file("summary.json", 1, 3000 + 600 * blocks),
        file("run.log", 1, 4000 + 100 * blocks),
    ];
    if frames > 0 {
        files.push(file("fields/*.vtu", frames, frames * frame));
    }
    if output.contacts {
        let pairs = ndda_contact::resultants(simulation.blocks(), &mut simulation.contacts().to_vec()).len();
        files.push(file("contacts", 1, rows * pairs as u64 * CONTACT_COLUMNS * NUMBER_BYTES));
    }
    files
}

/// Bytes as a person reads them.
fn readable(bytes: u64) -> String {
    let powers = [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let found = powers.iter().find(|(size, _)| bytes as f64 >= *size);
    found.map_or_else(|| format!("{bytes} B"), |(size, unit)| format!("{:.1} {unit}", bytes as f64 / size))
}

impl fmt::Display for Guess {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let steps = self.timed_steps;
        write!(f, "a run would take {:.1} s ({steps} steps timed; more as contacts grow)", self.run_s)?;
        if let Some(bytes) = self.memory_bytes {
            write!(f, " and {} of memory", readable(bytes))?;
        }
        for FileGuess { name, count, bytes } in &self.files {
            write!(
                f,
                "\n  {:9} {name}{}",
                readable(*bytes),
                if *count > 1 { format!(" ({count})") } else { String::new() }
            )?;
        }
        Ok(())
    }
}
