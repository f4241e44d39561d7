//! The settings of a scene that are tried, as values for `--set`.

use ndda_io::scene::{Block, Body, Contact, ContactAt, Integrator, Potential, Scene, Shape};
use ndda_solver::BodyKind;
use ndda_solver::Simulation;

use super::space::{Axis, Setting, Space};
use crate::build;
use crate::certify::plan::{STIFFER, finer};
use crate::numbers::in_fewest_figures;

/// The longest step that is tried is this times that of the scene.
const LONGEST: u64 = 8;
/// Halvings of the longest step that are tried.
const HALVINGS: i32 = 9;
/// Steps of the longest step are a multiple of this where they are more than ten times as many, so that they have divisors.
const ROUND: u64 = 20;
/// How often contact may be made stiffer, and softer.
const PENALTIES: (i32, i32) = (-3, 4);
/// How often cells may be joined, and halved.
const MESHES: (i32, i32) = (-2, 2);

/// One choice along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Name in tables.
    pub label: String,
    /// Values that it sets.
    pub set: Vec<String>,
}

/// Settings of a scene that are varied.
pub struct Settings {
    scene: Scene,
    /// Integrators, potentials, kinds of bodies, patterns of cells; the first of each is the scene's own.
    choices: [Vec<Choice>; 4],
    has_penalty: bool,
    has_mesh: bool,
}

/// Number of the axis of the penalty, after those of the choices; that of the mesh comes next.
const PENALTY: usize = 4;

/// Steps of the longest step that is tried, with a divisor that gives histories rows.
pub fn first_steps(scene: &Scene) -> u64 {
    let steps = build::steps(&scene.time).div_ceil(LONGEST);
    let has_divisor = (ROUND..=10 * ROUND).any(|rows| steps.is_multiple_of(rows));
    if steps > 10 * ROUND && !has_divisor { steps.next_multiple_of(ROUND) } else { steps }
}

impl Settings {
    /// The settings of a scene, with its meshes if they may be changed.
    pub fn new(scene: &Scene, simulation: &Simulation, meshes: bool) -> Self {
        let has_contact = matches!(scene.contact, Some(Contact::Potential { .. }));
        let patterns = if meshes { patterns(scene) } else { vec![own()] };
        Self {
            choices: [schemes(scene, has_contact), potentials(scene, simulation), bodies(scene), patterns],
            has_penalty: has_contact,
            has_mesh: meshes && !finer(scene, 1).is_empty(),
            scene: scene.clone(),
        }
    }

    /// The search space.
    pub fn space(&self, target: f64, budget_s: f64) -> Space {
        let none = (0, 0);
        let mut axes: Vec<Axis> = self.choices.iter().map(|list| Axis::Choice(list.len() as i32)).collect();
        let (softer, stiffer) = if self.has_penalty { PENALTIES } else { none };
        let (coarser, finest) = if self.has_mesh { MESHES } else { none };
        axes.extend([Axis::Range(softer, stiffer), Axis::Range(coarser, finest)]);
        // Patterns of cells cost less than more cells.
        let exact_first = vec![3, PENALTY, PENALTY + 1, 0, 1, 2];
        Space { axes, exact_first, first_level: 0, last_level: HALVINGS, target, budget_s }
    }

    /// The scene's own choices.
    pub fn start(&self) -> Vec<i32> {
        vec![0; PENALTY + 2]
    }

    /// Values of a setting but for its step.
    pub fn set(&self, setting: &Setting) -> Vec<String> {
        let mut set = Vec::new();
        for (choices, at) in self.choices.iter().zip(&setting.at) {
            set.extend(choices[*at as usize].set.iter().cloned());
        }
        let (stiffer, refined) = (setting.at[PENALTY], setting.at[PENALTY + 1]);
        if let (Some(Contact::Potential { penalty_pa, .. }), true) = (&self.scene.contact, stiffer != 0) {
            let penalty_pa = penalty_pa * STIFFER.powi(stiffer);
            set.push(format!("contact.penalty_pa={}", in_fewest_figures(penalty_pa)));
        }
        if refined != 0 {
            set.extend(finer(&self.scene, refined));
        }
        set
    }

    /// A setting in a few words.
    pub fn label(&self, setting: &Setting) -> String {
        let chosen = self.choices.iter().zip(&setting.at).map(|(choices, at)| &choices[*at as usize].label);
        let mut words: Vec<String> = chosen.filter(|label| !label.is_empty()).cloned().collect();
        let (stiffer, refined) = (setting.at[PENALTY], setting.at[PENALTY + 1]);
        if stiffer != 0 {
            words.push(format!("penalty × {}", STIFFER.powi(stiffer)));
        }
        if refined != 0 {
            words.push(format!("cells × {}", 2f64.powi(refined)));
        }
        if words.is_empty() { "as the scene is".into() } else { words.join(", ") }
    }
}

/// The scene's own choice.
fn own() -> Choice {
    Choice { label: String::new(), set: Vec::new() }
}

/// Integrators, with where contact is taken, that are not the scene's.
fn schemes(scene: &Scene, has_contact: bool) -> Vec<Choice> {
    let at_end = matches!(scene.time.contact_at, ContactAt::End { .. });
    let midpoint = Integrator::Midpoint { theta: 0.5 };
    let all = [
        ("Midpoint", "Midpoint(theta: 0.5)", midpoint.clone(), false),
        (
            "GeneralizedAlpha 0.8",
            "GeneralizedAlpha(radius: 0.8)",
            Integrator::GeneralizedAlpha { radius: 0.8 },
            false,
        ),
        (
            "Newmark (0.5, 1)",
            "Newmark(alpha: 0.5, delta: 1)",
            Integrator::Newmark { alpha: 0.5, delta: 1.0 },
            false,
        ),
        ("Midpoint, contact at the end", "Midpoint(theta: 0.5)", midpoint, true),
        ("Midpoint θ = 1", "Midpoint(theta: 1)", Integrator::Midpoint { theta: 1.0 }, false),
    ];
    let mut choices = vec![own()];
    for (label, text, integrator, end) in all {
        let is_own = integrator == scene.time.integrator && end == at_end;
        // A scheme that damps all motion is for scenes that come to rest without contact.
        let is_of_use = if has_contact { label != "Midpoint θ = 1" } else { !end };
        if is_own || !is_of_use {
            continue;
        }
        let mut set = vec![format!("time.integrator={text}")];
        if end != at_end {
            set.push(format!("time.contact_at={}", if end { "End()" } else { "Predicted" }));
        }
        choices.push(Choice { label: label.into(), set });
    }
    choices
}

/// Potentials that are not the scene's, as stiff as it: the smooth one presses at a depth of a quarter of the height of a
/// tetrahedron as hard as that of elements does.
fn potentials(scene: &Scene, simulation: &Simulation) -> Vec<Choice> {
    let Some(Contact::Potential { potential, .. }) = &scene.contact else { return vec![own()] };
    let blocks = simulation.blocks();
    let moving = blocks.ids().filter(|&block| simulation.shape(block).kind != BodyKind::Fixed);
    let mut heights: Vec<f64> = moving.map(|block| simulation.shape(block).smallest_height_m).collect();
    heights.sort_by(f64::total_cmp);
    let height_m = heights.get(heights.len() / 2).copied().unwrap_or(1.0);
    let mut choices = vec![own()];
    match potential {
        Potential::Element => choices.push(Choice {
            label: format!("Smooth, L₀ = {:.2e} m", height_m / 4.0),
            set: vec![format!("contact.potential=Smooth(reference_m: {:.2e})", height_m / 4.0)],
        }),
        Potential::Smooth { .. } => {
            choices.push(Choice { label: "Element".into(), set: vec!["contact.potential=Element".into()] });
        }
        // Their stiffness is that of the whole patch, or grows with the closure: no other potential is as stiff.
        Potential::Volume { .. } | Potential::Closure { .. } => {}
    }
    choices
}

/// Kinds of bodies for all blocks that move, where that changes any; what supports hold is never made rigid.
fn bodies(scene: &Scene) -> Vec<Choice> {
    let mut choices = vec![own()];
    for (label, body) in [("Rigid", Body::Rigid), ("Affine", Body::Affine), ("Elastic", Body::Elastic)] {
        let changes = |own: &Body| *own != Body::Fixed && *own != body;
        let is_held = |name: &str| scene.supports.iter().any(|support| support.block == name);
        let may = |block: &&Block| changes(&block.body) && (body != Body::Rigid || !is_held(&block.name));
        let blocks = scene.blocks.iter().filter(may);
        let mut set: Vec<String> =
            blocks.map(|block| format!("blocks.{}.body={label}", block.name)).collect();
        let rocks = scene.rock.iter().enumerate().filter(|(_, rock)| changes(&rock.body));
        set.extend(rocks.map(|(i, _)| format!("rock[{i}].body={label}")));
        if !set.is_empty() {
            choices.push(Choice { label: label.into(), set });
        }
    }
    choices
}

/// The other pattern for the cells of boxes.
fn patterns(scene: &Scene) -> Vec<Choice> {
    let mut choices = vec![own()];
    let has_pattern = |shape: &Shape| {
        matches!(shape, Shape::Box { .. } | Shape::Hexahedron { .. } | Shape::Voussoir { .. })
    };
    for pattern in ["Six", "TwentyFour"] {
        let blocks = scene.blocks.iter().enumerate().filter(|(_, block)| has_pattern(&block.shape));
        let set: Vec<String> = blocks.map(|(i, _)| format!("blocks[{i}].shape.pattern={pattern}")).collect();
        if !set.is_empty() {
            choices.push(Choice { label: format!("cells of {pattern}"), set });
        }
    }
    choices
}
