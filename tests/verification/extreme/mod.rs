//! Extreme cases: each runs a scene of `scenes/extreme/`, whose header says what is expected. The promise: a bounded,
//! reported answer, or a clean stop that names the cause; a run that is wrong and calls itself accurate is the only failure.

mod concave;
mod initial_overlap;
mod label;
mod labelled;
mod lighter;
mod locking;
mod long_runs;
mod pulse;
mod ramp;
mod scale;
mod shear_penalty;
mod sizes;
mod slivers;
mod springs;
mod squeezed;
mod stability;
mod touching;
mod tunnelling;
mod turning;
mod unlike_neighbours;
mod vibration;

use std::path::Path;

use ndda::Model;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::{advance, displacements};

/// A scene of `scenes/extreme/`, ready to run.
fn extreme(name: &str, overrides: &[&str]) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/extreme").join(format!("{name}.ron"));
    let overrides: Vec<String> = overrides.iter().map(|text| text.to_string()).collect();
    Model::open(&path, &overrides).unwrap_or_else(|errors| panic!("{}", errors.render(false)))
}

fn block(simulation: &Simulation, name: &str) -> BlockId {
    simulation.blocks().find(name).unwrap_or_else(|| panic!("no block {name}"))
}

/// Mean displacement of those nodes of a block whose place at rest is at a height [m].
fn sunk(simulation: &Simulation, name: &str, height_m: f64) -> f64 {
    let blocks = simulation.blocks();
    let moved = displacements(simulation);
    let there = |n: &usize| (blocks.rest_position[*n].z + blocks.origin_m.z - height_m).abs() < 1e-9;
    let nodes: Vec<usize> = blocks.nodes_of(block(simulation, name)).filter(there).collect();
    -nodes.iter().map(|&n| moved[n].z).sum::<f64>() / nodes.len() as f64
}

/// The farthest that a node has moved since the start [m].
pub(crate) fn farthest(simulation: &Simulation) -> f64 {
    let moved = simulation.state().position.iter().zip(simulation.start_position());
    moved.map(|(x, start): (&Vec3, &Vec3)| (x - start).norm()).fold(0.0, f64::max)
}
