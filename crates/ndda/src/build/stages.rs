//! A scene in a stage of construction: which blocks are there, and the simulation of them.

use std::path::Path;

use ndda_io::scene::{Scene, Stage, Then, matches};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BodyKind, BodySetup, Simulation};

use super::{Choices, Fault, bodies, bolts, simulation_of, simulation_with};

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
    fn apply(&self, bodies: &mut [BodySetup]) {
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
    let named = super::regions::find_all(blocks, pattern)?;
    let found: Vec<BlockId> = named.into_iter().filter(|block| holds(*block)).collect();
    match found.is_empty() {
        true if pattern.contains('*') => Err(format!("all blocks `{pattern}` are {otherwise}")),
        true => Err(format!("block `{pattern}` is {otherwise}")),
        false => Ok(found),
    }
}

/// The simulation of a scene as it is in a stage, on all of its blocks.
///
/// # Errors
/// As [`simulation_with`], and parts of one's own in a scene with stages.
pub fn simulation_in_stage(
    scene: &Scene,
    blocks: BlockSet,
    folder: &Path,
    choices: Choices,
    stage: usize,
) -> Result<Simulation, Vec<Fault>> {
    if scene.stages.is_empty() {
        return simulation_with(scene, blocks, folder, choices);
    }
    if !choices.are_the_scenes() {
        let message =
            "stages build a simulation each, of what the scene names: leave out the program's own parts";
        return Err(vec![Fault::new("stages", message)]);
    }
    let presence = Presence::of(scene, &blocks, stage)?;
    let apply = |bodies: &mut [BodySetup]| presence.apply(bodies);
    let built = simulation_of(&scene.in_stage(stage), blocks, folder, choices, (stage, &apply));
    let mut simulation = built.map_err(|faults| at_stage(scene, stage, faults))?;
    simulation.leave_out(presence.absent.clone()).map_err(|error| vec![Fault::new("stages", error)])?;
    Ok(simulation)
}

/// Looks at what all stages need: their blocks, and parts of these.
///
/// # Errors
/// All that is wrong with the first stage that cannot be built.
pub(crate) fn refuse(scene: &Scene, blocks: &BlockSet, folder: &Path) -> Result<(), Vec<Fault>> {
    for stage in 1..=scene.stages.len() {
        Presence::of(scene, blocks, stage)?;
        let bodies = bodies::bodies(&scene.in_stage(stage), blocks, folder, &[]);
        bodies.map_err(|faults| at_stage(scene, stage, faults))?;
        bolts::refuse_loose(scene, blocks, stage)?;
    }
    Ok(())
}

/// The same faults, at the stage that gives the part of the scene that they are of.
fn at_stage(scene: &Scene, stage: usize, faults: Vec<Fault>) -> Vec<Fault> {
    let path_in = |path: &str| (0..stage).rev().find_map(|k| scene.stages[k].path_of(k, path));
    let place = |fault: Fault| Fault { path: path_in(&fault.path).unwrap_or(fault.path), ..fault };
    faults.into_iter().map(place).collect()
}

/// Steps of a stage, at least one.
pub(crate) fn steps_of_stage(stage: &Stage, step_s: f64) -> u64 {
    let steps = (stage.time_s() / step_s).round() as u64;
    match stage.then {
        // What changes over a time has changed when the scene comes to rest.
        Then::Settle { .. } => ((stage.over_s / step_s).ceil() as u64).max(1),
        Then::Run(_) => steps.max(1),
    }
}

#[cfg(test)]
mod tests {
    use crate::Model;

    #[test]
    fn a_bolt_in_a_block_that_is_taken_out_is_refused() {
        let text = r#"(
            title: "A bolt in a block that is taken out", time: (step_s: 1e-4, end_s: 1e-3),
            materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            blocks: [
                (name: "foot", material: "rock", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                (name: "top", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1)),
            ],
            contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 30)),
            bolts: [(
                name: "anchor", at: Line(from_m: (0.5, 0.5, 1.9), to_m: (0.5, 0.5, 0.1)),
                steel: (young_pa: 200e9, area_m2: 5e-4), grout: (stiffness_n_m2: 1e9, strength_n_m: 2e5),
            )],
            stages: [(name: "out", remove: ["top"], over_s: 1e-3, then: Run(2e-3))],
        )"#;
        let refused = |text: &str| Model::from_text(text).err().map(|error| error.to_string());
        let message = refused(text).expect("nothing lets the bolt go");
        assert!(message.contains("bolt `anchor` is bonded in block `top`"), "{message}");
        assert!(message.contains("release: [\"anchor\"]"), "{message}");
        let let_go = text.replace("remove: [\"top\"]", "remove: [\"top\"], release: [\"anchor\"]");
        assert_eq!(refused(&let_go), None);
        let later = text.replace("remove: [\"top\"]", "remove: [\"top\"], install: [\"anchor\"]");
        assert_eq!(refused(&later), None, "it ends in the foot");
    }
}
