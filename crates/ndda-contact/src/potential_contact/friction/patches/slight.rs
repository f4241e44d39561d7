//! Friction of patches that can bear less than what matters to their blocks: a block has many of them along its edges.
//!
//! Such a patch is not searched for with the others. It acts at its centre, against the slip of its blocks, taken as rigid: with all that Coulomb's law allows,
//! or with what stops the slip within the step.

use ndda_mesh::{BlockId, Vec3};
use rayon::prelude::*;

use crate::friction::facet::FacetForce;
use crate::friction::patches::patch::ContactPatch;
use crate::friction::patches::{FrictionPatches, GRAIN_PATCHES, PatchScene};
use crate::model::Body;

/// Friction that is all there may be, but for so much.
const SLIDES: f64 = 1.0 - 1e-6;

impl FrictionPatches {
    /// Finds the friction of slight patches, and adds it to their facets.
    pub(super) fn add_slight_friction(&mut self, scene: &PatchScene, forces: &mut [FacetForce]) {
        let Self { patches, bodies, places, .. } = self;
        let is_slight = |patch: &ContactPatch| patch.has_friction() && patch.detail.is_none();
        patches.par_iter_mut().with_min_len(GRAIN_PATCHES).for_each(|patch| {
            if is_slight(patch) {
                patch.find_slight_friction(bodies, scene.input.dt_s);
            }
        });
        let each = forces.par_iter_mut().enumerate().zip(&places[..]).with_min_len(GRAIN_PATCHES);
        each.for_each(|((t, force), place)| {
            let patch = &patches[place.patch as usize];
            if is_slight(patch) && scene.sums(t as u32).pressure > 0.0 {
                patch.spread_slight_to(force, (scene, t as u32));
            }
        });
    }
}

impl ContactPatch {
    /// Finds its friction, from the velocities of all blocks; none where neither of both can move.
    pub(super) fn find_slight_friction(&mut self, bodies: &[Body], dt_s: f64) {
        let body = |block: BlockId| &bodies[block.index()];
        let (own, other) = (body(self.owner), body(self.target));
        if own.mass_kg.is_infinite() && other.mass_kg.is_infinite() {
            return;
        }
        self.turn_rad = Some(0.0);
        let slip = own.velocity_at(&self.center) - other.velocity_at(&self.center);
        let slip = slip - self.normal * self.normal.dot(&slip);
        let speed = slip.norm();
        if speed > 0.0 {
            let along = slip / speed;
            let mobility = own.mobility(&self.center, &along) + other.mobility(&self.center, &along);
            let force_n = (speed / (mobility * dt_s)).min(self.most_n);
            self.force_n = -force_n * along;
            self.slides = force_n >= SLIDES * self.most_n;
        }
    }

    /// Adds its friction to one of its facets.
    pub(super) fn spread_slight_to(&self, force: &mut FacetForce, (scene, t): (&PatchScene, u32)) {
        force.shear = self.sign_of(scene.touch(t)) / self.pressure * self.force_n;
        force.sticks = !self.slides;
    }
}

impl Body {
    /// Acceleration of a point along a direction for a force of 1 N along it there [1/kg].
    fn mobility(&self, x: &Vec3, along: &Vec3) -> f64 {
        if self.mass_kg.is_infinite() {
            return 0.0;
        }
        let turn = (x - self.center).cross(along);
        1.0 / self.mass_kg + turn.dot(&(self.inverse_inertia * turn))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_mesh::Mat3;

    fn found(most_n: f64, velocity_m_s: Vec3) -> ContactPatch {
        let held = Body::at_rest(f64::INFINITY);
        let cube = Body {
            mass_kg: 2600.0,
            inverse_inertia: Mat3::identity() * (6.0 / 2600.0),
            center: Vec3::new(0.0, 0.0, 0.5),
            velocity_m_s,
            ..held
        };
        let mut patch =
            ContactPatch { owner: BlockId(1), normal: Vec3::z(), most_n, ..ContactPatch::default() };
        patch.find_slight_friction(&[held, cube], 1e-3);
        patch
    }

    #[test]
    fn a_slight_patch_opposes_its_slip_with_no_more_than_its_most() {
        for most_n in [0.0, 1e-9, 5.0] {
            for velocity in [Vec3::x(), Vec3::new(1.0, -2.0, 3.0), Vec3::new(0.0, 1e-3, -8.0), Vec3::zeros()]
            {
                let ContactPatch { force_n, slides, .. } = found(most_n, velocity);
                assert!(
                    force_n.dot(&velocity) <= 0.0 && force_n.norm() <= most_n * (1.0 + 1e-12),
                    "{force_n}"
                );
                assert_eq!(force_n.z, 0.0);
                assert!(
                    velocity == Vec3::zeros() || slides && (force_n.norm() - most_n).abs() <= 1e-12 * most_n
                );
            }
        }
    }

    #[test]
    fn a_slight_patch_that_can_do_so_stops_its_slip_within_the_step() {
        let ContactPatch { force_n, slides, .. } = found(1e9, Vec3::new(0.3, -0.4, 0.0));
        // A force at the foot of a cube moves it by 1/m and turns it by ½ · ½/I.
        let mobility = 1.0 / 2600.0 + 0.25 * 6.0 / 2600.0;
        let stopping = -Vec3::new(0.3, -0.4, 0.0) / (mobility * 1e-3);
        assert!((force_n - stopping).norm() <= 1e-12 * stopping.norm() && !slides, "{force_n}");
    }
}
