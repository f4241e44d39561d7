//! Whether anything holds the blocks of a scene, and whether some may leave through the rim of the model.

use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, Severity};
use ndda_io::read::LoadedScene;
use ndda_io::scene::{Block, Body, Hold, Rock, Scene};
use ndda_mesh::BlockSet;

use super::rim;
use crate::build;

/// What is said where nothing is held.
const NOTHING: &str = "nothing is held, so all blocks fall together";
/// Its cure.
const HOLD: &str = "give a block `body: Fixed`, rock `fixed: […]`, or supports";

/// What is said where nothing can move.
pub const NOTHING_MOVES: &str = "no block can move: every block is fixed";
/// Its cure.
const LET_MOVE: &str =
    "give blocks that are to move `body: Rigid`, Affine or Elastic, and hold rock by `fixed: […]`";

/// The cure where rock has blocks that could.
const HOLDS_ALL: &str =
    "all of them lie in `fixed`: check its points and normals (in expressions sin and cos take degrees)";

/// Whether some block of a scene can move, or is moved by a support.
pub fn something_moves(scene: &Scene, blocks: &BlockSet) -> bool {
    !scene.supports.is_empty() || build::moving(scene, blocks).iter().any(Option::is_some)
}

/// Whether all blocks of a scene with gravity are free to fall.
fn nothing_is(scene: &Scene, blocks: &BlockSet) -> bool {
    let held = !scene.supports.is_empty() || !scene.quiet.is_empty() || !scene.ties.is_empty();
    let all_move = || build::moving(scene, blocks).iter().all(Option::is_some);
    scene.gravity_m_s2 != [0.0; 3] && blocks.len() > 1 && !held && all_move()
}

/// Warning of a scene in which nothing loads the blocks.
const NOTHING_LOADS: &str =
    "nothing but overlaps loads the blocks: there is no gravity, force, pressure, stress, speed or motion";
/// Its cure.
pub const LOAD: &str = "give gravity_m_s2, as (0, 0, -9.81), or another load";

/// Whether nothing loads or moves the blocks of a scene, so that those which touch stay where they are.
pub fn nothing_loads(scene: &Scene) -> bool {
    let zero = [0.0; 3];
    let rests = |block: &Block| {
        block.velocity_m_s == zero && block.spin_rad_s == zero && block.initial_stress_pa.is_none()
    };
    let moves = |hold: &Hold| !matches!(hold, Hold::Fixed | Hold::Normal | Hold::Direction(_));
    let is_pushed = scene.forces.iter().any(|load| load.force_n != zero)
        || scene.tractions.iter().any(|load| load.traction_pa != zero)
        || !scene.water.is_empty()
        || !scene.blasts.is_empty()
        || scene.in_situ.is_some()
        || scene.bolts.iter().any(|bolt| bolt.pretension_n != 0.0);
    scene.gravity_m_s2 == zero
        && !is_pushed
        && scene.blocks.iter().all(rests)
        && !scene.supports.iter().any(|support| moves(&support.hold))
        && scene.quiet.iter().all(|quiet| quiet.incident.is_empty())
        && scene.stages.is_empty()
        && scene.rockfall.is_none()
}

/// Warnings about what holds the blocks of a scene: path, message and cure.
fn found(scene: &Scene, blocks: &BlockSet) -> Vec<(String, String, &'static str)> {
    let mut found = Vec::new();
    let list = if scene.blocks.is_empty() { "rock" } else { "blocks" };
    if !something_moves(scene, blocks) {
        let holds_all = |rock: &Rock| rock.body != Body::Fixed && !rock.fixed.is_empty();
        let (path, cure) = match scene.rock.iter().position(holds_all) {
            Some(rock) => (format!("rock[{rock}].fixed"), HOLDS_ALL),
            None => (list.to_string(), LET_MOVE),
        };
        found.push((path, NOTHING_MOVES.to_string(), cure));
    }
    if nothing_is(scene, blocks) {
        found.push((list.to_string(), NOTHING.to_string(), HOLD));
    }
    if nothing_loads(scene) && blocks.len() > 1 && something_moves(scene, blocks) {
        found.push(("gravity_m_s2".to_string(), NOTHING_LOADS.to_string(), LOAD));
    }
    let rims = rim::leaving(scene, blocks);
    found
        .extend(rims.into_iter().map(|(rock, message)| (format!("rock[{rock}].domain"), message, rim::CURE)));
    found
}

/// Warnings about what holds the blocks of a scene, each in a sentence.
pub fn sentences(scene: &Scene, blocks: &BlockSet) -> Vec<String> {
    found(scene, blocks).into_iter().map(|(_, message, cure)| format!("{message}: {cure}")).collect()
}

/// The same at their places in the scene.
pub fn warnings(loaded: &LoadedScene, blocks: &BlockSet) -> Vec<Diagnostic> {
    let warning = |(path, message, cure): (String, String, &str)| {
        let idle = [NOTHING_MOVES, NOTHING_LOADS].contains(&message.as_str());
        let code = if idle { Code::NoEffect } else { Code::NotHeld };
        let found = loaded.diagnose_as(code, &path, message).with_help(cure);
        Diagnostic { severity: Severity::Warning, ..found }
    };
    found(&loaded.scene, blocks).into_iter().map(warning).collect()
}

#[cfg(test)]
mod tests {
    use crate::Model;

    /// Codes of the warnings of two blocks, one on the other; `more` is said of the lower one.
    fn codes(more: &str, rest: &str) -> Vec<String> {
        codes_of(more, "", "penalty_pa: 1e8, ", rest)
    }

    fn codes_of(more: &str, upper: &str, penalty: &str, rest: &str) -> Vec<String> {
        let block = |name: &str, z: f64, more: &str| {
            format!(
                "(name: \"{name}\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, {z}), {more}),"
            )
        };
        let text = format!(
            "(title: \"two\", time: (step_s: 1e-4, end_s: 1e-3), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            blocks: [{}{}], contact: Potential({penalty}friction: (friction_deg: 30)), {rest})",
            block("lower", 0.0, more),
            block("upper", 1.0, upper)
        );
        let model = Model::from_text(&text).unwrap();
        model.loaded.warnings.iter().map(|warning| warning.code.to_string()).collect()
    }

    #[test]
    fn blocks_that_all_fall_are_warned_of_wherever_a_scene_is_built() {
        assert_eq!(codes("", ""), ["not-held"]);
        assert_eq!(codes("body: Fixed", ""), Vec::<String>::new());
        assert_eq!(codes("", "supports: [(block: \"lower\", on: All, hold: Fixed)]"), Vec::<String>::new());
    }

    #[test]
    fn blocks_that_nothing_loads_are_warned_of_and_those_that_move_by_themselves_are_not() {
        let text = |more: &str| {
            format!(
                "(title: \"two\", contact: Off, time: (step_s: 1e-4, end_s: 1e-3),
                materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
                blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), {more}])"
            )
        };
        let messages = |more: &str| -> Vec<String> {
            let warnings = Model::from_text(&text(more)).unwrap().loaded.warnings;
            warnings.into_iter().map(|warning| warning.message).collect()
        };
        let second = "), (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (2, 0, 0))";
        assert_eq!(messages(second), [super::NOTHING_LOADS]);
        assert_eq!(messages(&format!("velocity_m_s: (1, 0, 0){second}")), Vec::<String>::new());
        assert_eq!(messages(")"), Vec::<String>::new(), "a block alone overlaps nothing");
    }

    #[test]
    fn blocks_that_are_all_fixed_are_warned_of_with_and_without_a_penalty() {
        for penalty in ["penalty_pa: 1e8, ", ""] {
            assert_eq!(codes_of("body: Fixed", "body: Fixed", penalty, ""), ["no-effect"], "{penalty}");
        }
    }
}
