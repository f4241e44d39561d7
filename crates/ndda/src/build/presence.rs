//! Which blocks are there in a stage of construction.

use ndda_io::scene::{Scene, Stage, matches};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BodyKind, BodySetup};

use super::{Fault, regions};

/// Which blocks are there in a stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Presence {
    /// Blocks that are not there, yet or any more.
    pub absent: Vec<bool>,
    /// Blocks that a stage has added, which begin without stress.
    pub added: Vec<bool>,
}

impl Presence {
    /// In a stage, counted from 1; stage 0 is before the first.
    ///
    /// # Errors
    /// Names of nothing, and blocks that are taken out or put in twice.
    pub(crate) fn of(scene: &Scene, blocks: &BlockSet, stage: usize) -> Result<Self, Vec<Fault>> {
        let mut presence = Self::before(scene, blocks);
        let mut faults = Vec::new();
        for (k, stage) in scene.stages.iter().enumerate().take(stage) {
            presence.change(k, stage, blocks, &mut faults);
        }
        if faults.is_empty() { Ok(presence) } else { Err(faults) }
    }

    /// Before the first stage: blocks that are first spoken of where they are added are not there yet.
    fn before(scene: &Scene, blocks: &BlockSet) -> Self {
        let comes_later = |name: &String| {
            let speaks = |patterns: &[String]| patterns.iter().any(|pattern| matches(pattern, name));
            let first = scene.stages.iter().find(|stage| speaks(&stage.remove) || speaks(&stage.add));
            first.is_some_and(|stage| speaks(&stage.add))
        };
        Self { absent: blocks.names.iter().map(comes_later).collect(), added: vec![false; blocks.len()] }
    }

    fn change(&mut self, k: usize, stage: &Stage, blocks: &BlockSet, faults: &mut Vec<Fault>) {
        for (i, pattern) in stage.remove.iter().enumerate() {
            let absent = &self.absent;
            match found(blocks, pattern, "not there in this stage", |b| !absent[b.index()]) {
                Ok(found) => found.iter().for_each(|block| self.absent[block.index()] = true),
                Err(message) => faults.push(Fault::new(format!("stages[{k}].remove[{i}]"), message)),
            }
        }
        for (i, pattern) in stage.add.iter().enumerate() {
            let absent = &self.absent;
            let at = format!("stages[{k}].add[{i}]");
            match found(blocks, pattern, "there already", |b| absent[b.index()]) {
                Ok(found) => {
                    for block in found {
                        let name = &blocks.names[block.index()];
                        if stage.remove.iter().any(|pattern| matches(pattern, name)) {
                            let message =
                                format!("block `{name}` is removed in this stage: add it in a later one");
                            faults.push(Fault::new(&at, message));
                        }
                        (self.absent[block.index()], self.added[block.index()]) = (false, true);
                    }
                }
                Err(message) => faults.push(Fault::new(at, message)),
            }
        }
    }

    /// Makes absent blocks Fixed ones on which nothing acts, and takes the stress of the ground from those that were added.
    pub(super) fn apply(&self, bodies: &mut [BodySetup]) {
        for ((body, absent), added) in bodies.iter_mut().zip(&self.absent).zip(&self.added) {
            if *absent || *added {
                body.initial_stress = None;
            }
            if *absent {
                body.kind = BodyKind::Fixed;
                body.supports.clear();
                body.tractions.clear();
                body.forces.clear();
                body.pressures.clear();
                body.quiet.clear();
                body.ties.clear();
                (body.velocity_m_s, body.spin_rad_s) = (Vec3::zeros(), Vec3::zeros());
            }
        }
    }
}

/// Blocks of a pattern of which something holds: of a name it must, of a pattern with `*` for one of them at least.
fn found(
    blocks: &BlockSet,
    pattern: &str,
    otherwise: &str,
    holds: impl Fn(BlockId) -> bool,
) -> Result<Vec<BlockId>, String> {
    let named = regions::find_all(blocks, pattern)?;
    let found: Vec<BlockId> = named.into_iter().filter(|block| holds(*block)).collect();
    match found.is_empty() {
        true if pattern.contains('*') => Err(format!("all blocks `{pattern}` are {otherwise}")),
        true => Err(format!("block `{pattern}` is {otherwise}")),
        false => Ok(found),
    }
}
