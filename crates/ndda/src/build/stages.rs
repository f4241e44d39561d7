//! A scene in a stage of construction: which blocks are there, and the simulation of them.

use std::path::Path;

use ndda_io::scene::{Scene, Stage, Then};
use ndda_mesh::BlockSet;
use ndda_solver::{BodySetup, Simulation};

use super::presence::Presence;
use super::{Choices, Fault, bodies, bolts, simulation_of, simulation_with};

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
        let message = "each stage builds a simulation from the scene alone: leave out the parts that your program supplies, or the stages";
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

/// Rounding of a quotient of two decimal numbers: a step that is only that much too many is none.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Steps of a stage, at least one.
pub(crate) fn steps_of_stage(stage: &Stage, step_s: f64) -> u64 {
    let steps = (stage.time_s() / step_s).round() as u64;
    match stage.then {
        // What changes over a time has changed when the scene comes to rest.
        Then::Settle { .. } => ((stage.over_s / step_s * (1.0 - ROUNDING)).ceil() as u64).max(1),
        Then::Run(_) => steps.max(1),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use ndda_mesh::{BlockId, Vec3};
    use ndda_solver::StageStart;

    use super::*;
    use crate::Model;

    #[test]
    fn a_time_that_is_a_whole_number_of_steps_takes_that_many() {
        let stage = |over_s: f64| -> Stage {
            let text = format!(
                r#"(title: "t", time: (step_s: 1e-3, end_s: 1), materials: [(name: "rock", density_kg_m3: 2600, young_pa: 2e10, poisson: 0.25)],
                    blocks: [(name: "b", material: "rock", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))], contact: Potential(penalty_pa: 1e9),
                    stages: [(name: "s", over_s: {over_s}, then: Settle())])"#
            );
            ndda_io::read::load_text("t.ron", &text, &[], None).unwrap().scene.stages.remove(0)
        };
        for (over_s, step_s, steps) in
            [(8.05, 1e-3, 8050), (0.3, 0.1, 3), (8.0505, 1e-3, 8051), (1e-3, 1e-3, 1), (0.0, 1e-3, 1)]
        {
            assert_eq!(steps_of_stage(&stage(over_s), step_s), steps, "{over_s} s by {step_s} s");
        }
    }

    #[test]
    fn nothing_pulls_at_blocks_that_are_taken_out_of_a_scene_with_quiet_faces() {
        let block = |name: &str, body: &str, at_m: u32| {
            format!(
                "(name: \"{name}\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: ({at_m}, 0, 0)),"
            )
        };
        let text = format!(
            "(title: \"Quiet\", time: (step_s: 1e-4, end_s: 1e-3), gravity_m_s2: (0, 0, -10),
              materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
              blocks: [{}{}{}],
              quiet: [(block: \"base\", on: Set(\"z_min\")), (block: \"other\", on: Set(\"z_min\"))],
              contact: Potential(penalty_pa: 1e9),
              stages: [(name: \"out\", remove: [\"other\", \"wall\"], then: Run(1e-3))])",
            block("base", "Elastic", 0),
            block("other", "Elastic", 5),
            block("wall", "Fixed", 9),
        );
        let Model { loaded, mut simulation, .. } = Model::from_text(&text).unwrap();
        simulation.step().unwrap();
        let (blocks, folder) = (simulation.blocks().clone(), Path::new("."));
        let next = simulation_in_stage(&loaded.scene, blocks, folder, Choices::default(), 1);
        let mut next = next.unwrap_or_else(|faults| panic!("{faults:?}"));
        next.begin_stage(&mut simulation, &StageStart::default()).unwrap();
        next.step().unwrap();
        for block in [1, 2] {
            assert_eq!(next.reaction_n(BlockId(block)), Vec3::zeros(), "block {block}");
        }
    }

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
