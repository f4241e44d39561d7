//! Where a run is in its stages, how those before ended, and at which steps they end.

use ndda_io::scene::{Scene, Support, matches};
use ndda_mesh::BlockId;
use ndda_solver::{Simulation, View};
use serde::{Deserialize, Serialize};

use super::recorder::Recorder;
use crate::build;
use crate::judge::verdict;
use crate::summary::StageEnd;

/// Where a run is in its stages; a checkpoint keeps it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageLog {
    /// The stage, counted from 1; 0 before the first.
    pub at: usize,
    /// Steps in which the present one came to rest.
    pub(super) settling_steps: u64,
    /// The stages that have ended.
    pub rows: Vec<StageEnd>,
}

impl StageLog {
    /// Notes that the present stage has ended.
    pub(super) fn end(&mut self, name: &str, view: &View, recorder: &Recorder) {
        let simulation = &*view.simulation;
        let blocks = simulation.blocks().ids();
        self.rows.push(StageEnd {
            name: name.to_string(),
            end_s: simulation.time_s(),
            steps: simulation.state().step,
            settling_steps: std::mem::take(&mut self.settling_steps),
            blocks: blocks.filter(|&block| !simulation.is_absent(block)).count(),
            removed_j: view.sample.map_or(0.0, |sample| sample.removed_j),
            motion: recorder.motions.summary(simulation).unwrap_or_default(),
            label: verdict::label(simulation, None),
        });
    }
}

/// The last step of what comes before the first stage, and of each stage; none in a scene without stages.
pub(crate) fn ends(scene: &Scene) -> Vec<u64> {
    if scene.stages.is_empty() {
        return Vec::new();
    }
    let mut end = build::steps(&scene.time);
    let after = scene.stages.iter().map(|stage| build::stages::steps_of_stage(stage, scene.time.step_s));
    let mut ends = vec![end];
    ends.extend(after.map(|steps| {
        end += steps;
        end
    }));
    ends
}

/// Blocks that are fixed or that a support of any stage may hold, and their names: the same in all stages.
pub(crate) fn held_blocks(scene: &Scene, simulation: &Simulation) -> Vec<(BlockId, String)> {
    let blocks = simulation.blocks();
    let later = scene.stages.iter().filter_map(|stage| stage.supports.as_ref()).flatten();
    let supports: Vec<&Support> = scene.supports.iter().chain(later).collect();
    let moving = build::moving(scene, blocks);
    let is_held = |block: &BlockId| {
        let name = &blocks.names[block.index()];
        moving[block.index()].is_none() || supports.iter().any(|support| matches(&support.block, name))
    };
    blocks.ids().filter(is_held).map(|block| (block, blocks.names[block.index()].clone())).collect()
}
