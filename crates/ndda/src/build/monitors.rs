//! The monitors of a scene.

use ndda_io::scene::{self, At, Scene};
use ndda_solver::Simulation;

use super::regions::{find, find_all};
use super::{Fault, vec3};
use crate::run::monitor::Monitor;

/// The monitors of a scene.
///
/// # Errors
/// All monitors whose point is outside their block.
pub fn monitors(scene: &Scene, simulation: &Simulation) -> Result<Vec<Monitor>, Vec<Fault>> {
    let mut faults = Vec::new();
    let mut monitors = Vec::new();
    for (i, monitor) in scene.monitors.iter().enumerate() {
        let path = || format!("monitors[{i}].at");
        let built = one_monitor(monitor, simulation);
        match built {
            Ok(monitor) => monitors.push(monitor),
            Err(message) => faults.push(Fault::new(path(), message)),
        }
    }
    if faults.is_empty() { Ok(monitors) } else { Err(faults) }
}

fn one_monitor(monitor: &scene::Monitor, simulation: &Simulation) -> Result<Monitor, String> {
    let blocks = simulation.blocks();
    match &monitor.at {
        At::Centre => Ok(Monitor::centre(&monitor.name, simulation, find(blocks, &monitor.block)?)),
        At::Point(place) => {
            let block = find(blocks, &monitor.block)?;
            let point = Monitor::point(&monitor.name, blocks, block, &(vec3(*place) - blocks.origin_m));
            point.ok_or_else(|| format!("this point is outside block `{}` at the start", monitor.block))
        }
        At::Largest(direction) => {
            let found = find_all(blocks, &monitor.block)?;
            let nodes = found.into_iter().map(|block| blocks.nodes_of(block)).collect();
            Ok(Monitor::largest(&monitor.name, nodes, vec3(*direction).normalize()))
        }
    }
}
