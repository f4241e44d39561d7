//! Stress in the ground that is lost before anything is dug: joints begin at zero depth, and blocks give it to them while they come to rest.
//!
//! Under a stress σ a joint closes by σ L/(2 k_n), while a block of size s that loses the stress grows by σ s/E. Between a joint and the next, what is left of σ₀ is
//! σ₀ (s/E)/(s/E + L/(2 k_n)). Of blocks of unlike sides the least counts, along which there are most joints.

use ndda_io::scene::{Contact, Scene};
use ndda_mesh::geometry::Aabb;
use ndda_solver::{BodyKind, Simulation};

use crate::choose::rounded_up;

/// Part of the stress that may be lost without a word.
const LOST: f64 = 0.05;

/// That much of the stress in the ground is lost, or that no block can have it.
pub(super) fn finding(scene: &Scene, simulation: &Simulation) -> Option<String> {
    scene.in_situ.as_ref()?;
    let Some(size_m) = size_m(simulation) else {
        return Some("in_situ acts on nothing, since no block of the scene can deform: make blocks Elastic or Affine, or leave it out".into());
    };
    let Loss { lost, enough_pa } = loss(scene, simulation, size_m)?;
    (lost > LOST).then(|| {
        format!(
            "about {:.0} % of the stress in the ground (in_situ) is lost as joints close, which begin at zero depth: give a penalty_pa of {enough_pa:.0e} to lose {:.0} %",
            100.0 * lost,
            100.0 * LOST
        )
    })
}

/// Whether joints take more of the stress in the ground than may be lost without a word.
pub(super) fn is_lost(scene: &Scene, simulation: &Simulation) -> bool {
    let loss = size_m(simulation).and_then(|size_m| loss(scene, simulation, size_m));
    scene.in_situ.is_some() && loss.is_some_and(|loss| loss.lost > LOST)
}

/// What joints take of the stress in the ground.
struct Loss {
    /// Part of the stress.
    lost: f64,
    /// The penalty with which as much is lost as may be without a word [Pa].
    enough_pa: f64,
}

/// Smaller side of the middle one of blocks that deform [m]; none where there are none.
fn size_m(simulation: &Simulation) -> Option<f64> {
    let blocks = simulation.blocks();
    let deforms = |kind: BodyKind| matches!(kind, BodyKind::Elastic | BodyKind::Affine);
    let of_size = |block| {
        let bounds = Aabb::around(&blocks.rest_position[blocks.nodes_of(block)]);
        deforms(simulation.shape(block).kind).then(|| (bounds.max - bounds.min).min())
    };
    let mut sizes_m: Vec<f64> = blocks.ids().filter_map(of_size).collect();
    sizes_m.sort_unstable_by(f64::total_cmp);
    sizes_m.get(sizes_m.len() / 2).copied()
}

fn loss(scene: &Scene, simulation: &Simulation, size_m: f64) -> Option<Loss> {
    let Some(Contact::Potential { penalty_pa, potential, .. }) = &scene.contact else { return None };
    let reference_m = potential.reference_m()?;
    if simulation.blocks().len() < 2 {
        return None;
    }
    let young_pa = scene.materials.iter().map(|material| material.young_pa).fold(0.0, f64::max);
    let (joint, rock) = (reference_m / (2.0 * penalty_pa), size_m / young_pa);
    let lost = joint / (joint + rock);
    let enough_pa = rounded_up((1.0 / LOST - 1.0) * reference_m / (2.0 * rock));
    Some(Loss { lost, enough_pa })
}
