//! How friction of a patch is spread over its facets.
//!
//! Between blocks that do not deform it is in proportion to the pressure. Where one does, it is in proportion to |∂φ/∂n| dA, the stiffness of the contact, which
//! is that of the area that touches: friction that followed the pressure would push harder wherever a vibration presses harder, and so feed
//! vibrations of a block that sticks (flutter), while a part that sticks to fixed weights of its points does no work. Force and torque are those
//! of the patch with both.

use ndda_mesh::Vec3;

use crate::friction::facet::FacetForce;
use crate::friction::patches::{PatchScene, Place};

/// How friction of a patch is spread.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spread {
    pub by_area: bool,
    /// Sum of the weights of facets, ∫ φ dA [m²] or ∫ |∂φ/∂n| dA [m], and their centre [m].
    pub total: f64,
    pub center: Vec3,
    /// Mean square distance from it [m²].
    pub radius2_m2: f64,
}

impl Spread {
    /// By the area that touches, over the facets of a patch; none where nothing presses. `own_m2` is the mean square
    /// distance of each facet's points from its own centre.
    pub(super) fn by_area(
        run: &[Place],
        scene: &PatchScene,
        (forces, own_m2): (&[FacetForce], &[f64]),
    ) -> Option<Self> {
        let mut spread = Self { by_area: true, ..Self::default() };
        let all = || run.iter().map(|place| place.2).zip(own_m2);
        let pressing = || all().filter(|(t, _)| scene.sums(*t).pressure > 0.0);
        spread.total = pressing().map(|(t, _)| spread.weight(scene, t)).sum();
        let share = |t: u32| spread.weight(scene, t) / spread.total;
        let center = |t: u32| spread.center_of(scene, &forces[t as usize], t);
        let middle: Vec3 = pressing().map(|(t, _)| share(t) * center(t)).sum();
        let radius2 = |(t, own_m2): (u32, &f64)| share(t) * ((center(t) - middle).norm_squared() + own_m2);
        let radius2_m2 = pressing().map(radius2).sum();
        (spread.total > 0.0).then_some(Self { center: middle, radius2_m2, ..spread })
    }

    /// The weight of a facet.
    pub(super) fn weight(&self, scene: &PatchScene, t: u32) -> f64 {
        scene.sums(t).friction_weight(self.by_area)
    }

    /// The centre of a facet [m].
    pub(super) fn center_of(&self, scene: &PatchScene, force: &FacetForce, t: u32) -> Vec3 {
        if !self.by_area {
            return force.center;
        }
        let corners = scene.input.blocks.triangle_corners(scene.touch(t).triangle, scene.input.position);
        scene.sums(t).center_of_area(&corners).unwrap_or(force.center)
    }

    /// Weights of each node that a facet is of, or of each that it presses on.
    pub(super) fn each_node(
        &self,
        scene: &PatchScene,
        (t, is_owner): (u32, bool),
        mut add: impl FnMut(usize, f64),
    ) {
        let (touch, sums) = (scene.touch(t), scene.sums(t));
        if sums.pressure <= 0.0 {
            return;
        }
        if is_owner {
            let triangle = &scene.input.blocks.triangles[touch.triangle.index()];
            let weights = if self.by_area { sums.slope } else { sums.weights };
            triangle.iter().zip(weights).for_each(|(node, w)| add(node.index(), w));
        } else {
            for hit in scene.integrals.overlaps_of(touch) {
                let tet = &scene.input.blocks.tets[hit.tet.index()];
                let weights = if self.by_area { hit.on_target.slope } else { hit.on_target.pressure };
                tet.iter().zip(weights).for_each(|(node, w)| add(node.index(), w));
            }
        }
    }
}
