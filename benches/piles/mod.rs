//! Scenes as the benches take them, and piles of cubes from where they meet their ridge.
#![allow(dead_code)] // each bench takes some of it

use std::path::Path;

use ndda::Model;
use ndda_solver::{BodyKind, Simulation};

/// Time that cubes fall freely before they are watched [s]: 4 mm above the ridge, of 0.2 m.
const FALL_S: f64 = 0.2;
/// Gravity of the scenes [m/s²].
const GRAVITY_M_S2: f64 = 9.8;
/// Steps from there until all of the lower cubes press on each other.
pub const STEPS: u32 = 50;

/// A scene of `scenes/` with some values changed, at its start.
pub fn prepared(scene: &str, settings: &[&str]) -> Simulation {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.ron"));
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    Model::open(&file, &settings).expect("a sound scene").simulation
}

/// A pile after its fall, which needs no steps: nothing touches the cubes but each other.
pub fn fallen(scene: &str, settings: &[&str]) -> Simulation {
    let mut simulation = prepared(scene, settings);
    let mut snapshot = simulation.snapshot();
    let blocks = simulation.blocks();
    let moves = |block: &_| simulation.shape(*block).kind != BodyKind::Fixed;
    for node in blocks.ids().filter(moves).flat_map(|block| blocks.nodes_of(block)) {
        snapshot.state.position[node].z -= 0.5 * GRAVITY_M_S2 * FALL_S * FALL_S;
        snapshot.state.velocity[node].z -= GRAVITY_M_S2 * FALL_S;
    }
    simulation.restore(snapshot).expect("a state of the same blocks");
    simulation
}
