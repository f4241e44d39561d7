//! Details of patches whose friction is searched for: axes, limit surface, the spread of friction over facets, and the friction of the last step.

use ndda_mesh::{Mat3, Vec3};

use crate::friction::facet::FacetForce;
use crate::friction::patches::limit_surface::LimitSurface;
use crate::friction::patches::moments::{self, fourfold_angle, principal, tangents};
use crate::friction::patches::patch::{ContactPatch, PatchDetail, PatchFacets, Remembered};
use crate::friction::patches::spread::Spread;
use crate::friction::patches::{GRAIN_PATCHES, PatchScene, Place};
use crate::integration::overlap_pair::FacetMoments;
use crate::model::{Body, ContactHistory};

/// The facets of one patch, with their forces and integrals.
#[derive(Clone, Copy)]
struct FacetsScene<'a> {
    scene: &'a PatchScene<'a>,
    forces: &'a [FacetForce],
    run: &'a [Place],
}

impl PatchDetail {
    /// Finds the details of a patch, and the mean square distance of each facet's points from its own centre of pressure [m²].
    fn find(
        &mut self,
        patch: &ContactPatch,
        facets: &PatchFacets,
        found: &FacetsScene,
        own_m2: &mut [f64],
        remembered: &mut Remembered,
    ) {
        let second_moment_m2 = found.second_moment_m2(patch, own_m2);
        self.spread = found.spread(patch, own_m2, second_moment_m2.trace());
        let (axes, principal_m2) = found.principal_axes(patch, &second_moment_m2);
        (self.axes, self.surface) = (axes, LimitSurface::new(patch.most_n, principal_m2));
        let old = remembered.of(facets).filter(|old| old.normal.dot(&patch.normal) > 0.0);
        self.previous = old.map(|old| old.turned_to(&patch.normal));
    }

    /// Torque about the centre of the spread of a unit force along each axis that acts at the centre of pressure, over r [1].
    pub(super) fn twist_of_force(&self, patch: &ContactPatch) -> [f64; 2] {
        let arm = self.spread.center - patch.center;
        [0, 1].map(|k| -patch.normal.dot(&arm.cross(&self.axes[k])) / self.surface.radius_m)
    }

    /// Adds the friction of a patch to one of its facets.
    pub(super) fn spread_to(
        &self,
        patch: &ContactPatch,
        force: &mut FacetForce,
        (scene, t, own_radius2_m2): (&PatchScene, u32, f64),
    ) {
        let sign = patch.sign_of(scene.touch(t));
        let Spread { by_area, total, center, radius2_m2 } = self.spread;
        let torque_n_m = patch.torque_n_m - patch.normal.dot(&(center - patch.center).cross(&patch.force_n));
        let twist = sign * torque_n_m / total / radius2_m2;
        let arm = self.spread.center_of(scene, force, t) - center;
        force.shear = sign * patch.force_n / total + twist * patch.normal.cross(&arm);
        force.couple_n_m = self.spread.weight(scene, t) * twist * own_radius2_m2;
        force.shear_by_area = by_area;
        force.sticks = !patch.slides;
    }

    /// Applies the friction of the last step to a body.
    pub(super) fn apply_previous_friction(&self, patch: &ContactPatch, body: &mut Body, sign: f64) {
        if let Some(old) = &self.previous {
            body.push(&patch.center, &(sign * old.force_n));
            body.torque_n_m += sign * old.torque_n_m * patch.normal;
        }
    }
}

impl FacetsScene<'_> {
    /// Mean of r rᵀ about the centre of a patch, weighted by pressure [m²]; a facet counts with its own size, so that one facet has some, too.
    fn second_moment_m2(&self, patch: &ContactPatch, own_m2: &mut [f64]) -> Mat3 {
        let Self { scene, forces, run } = *self;
        let mut sum = Mat3::zeros();
        for (&(_, _, t), own_m2) in run.iter().zip(own_m2) {
            let FacetMoments { pressure, area, .. } = *scene.sums(t);
            *own_m2 = 0.0;
            if pressure > 0.0 {
                let center = &forces[t as usize].center;
                let of_facet = (scene.input, scene.hulls);
                let own = moments::second_moment_m2(of_facet, scene.touch(t), area, center);
                let (arm, share) = (center - patch.center, pressure / patch.pressure);
                sum += share * (arm * arm.transpose() + own);
                *own_m2 = own.trace();
            }
        }
        sum
    }

    /// How friction is spread, once it is known where the patch presses.
    fn spread(&self, patch: &ContactPatch, own_m2: &[f64], radius2_m2: f64) -> Spread {
        let Self { scene, forces, run } = *self;
        let by_area = patch.deforms.then(|| Spread::by_area(run, scene, (forces, own_m2))).flatten();
        let (total, center) = (patch.pressure, patch.center);
        by_area.unwrap_or(Spread { by_area: false, total, center, radius2_m2 })
    }

    /// Two unit vectors in the face along which the pressure has its principal second moments, the normal, and these moments [m²].
    fn principal_axes(&self, patch: &ContactPatch, second_moment_m2: &Mat3) -> ([Vec3; 3], [f64; 2]) {
        let [s, t] = tangents(&patch.normal);
        let (mean, spread, angle) = principal(second_moment_m2, &[s, t]);
        let angle = angle.or_else(|| self.fourfold_angle(patch, &[s, t]));
        let angle = angle.unwrap_or_else(|| self.edge_angle(&[s, t]));
        let (sin, cos) = angle.sin_cos();
        let along = s * cos + t * sin;
        // The lesser one is positive but for rounding.
        let least = (mean - spread).max(1e-6 * mean);
        ([along, patch.normal.cross(&along), patch.normal], [mean + spread, least])
    }

    /// Angle of the axes where both second moments are the same, as those of a square: it follows the facets, so that it turns with the blocks.
    fn fourfold_angle(&self, patch: &ContactPatch, [s, t]: &[Vec3; 2]) -> Option<f64> {
        let corners = self.run.iter().map(|&(_, _, facet)| {
            let arm = self.forces[facet as usize].center - patch.center;
            (self.scene.sums(facet).pressure.max(0.0), [s.dot(&arm), t.dot(&arm)])
        });
        fourfold_angle(corners)
    }

    /// Angle of an edge of the first facet that presses.
    fn edge_angle(&self, axes: &[Vec3; 2]) -> f64 {
        let pressing = self.run.iter().find(|(_, _, facet)| self.scene.sums(*facet).pressure > 0.0);
        pressing.map_or(0.0, |&(_, _, facet)| {
            let (input, triangle) = (self.scene.input, self.scene.touch(facet).triangle);
            moments::edge_angle(&input.blocks.triangle_corners(triangle, input.position), axes)
        })
    }
}

/// The facets of a patch whose friction is searched for, among those of all such patches.
pub(super) fn facets_of(details: &[PatchDetail], detail: u32) -> std::ops::Range<usize> {
    let start = detail.checked_sub(1).map_or(0, |before| details[before as usize].end);
    start as usize..details[detail as usize].end as usize
}

/// All patches, with their facets and what they remember: input of the details.
#[derive(Clone, Copy)]
pub(super) struct DetailScene<'a> {
    pub scene: &'a PatchScene<'a>,
    pub forces: &'a [FacetForce],
    pub history: &'a ContactHistory,
    pub patches: &'a [ContactPatch],
    pub runs: &'a [PatchFacets],
    pub order: &'a [Place],
}

impl DetailScene<'_> {
    /// Finds some details, whose facets begin at `first`.
    pub(super) fn find(&self, details: &mut [PatchDetail], (first, own_m2): (u32, &mut [f64])) {
        if details.len() > GRAIN_PATCHES {
            let (head, tail) = details.split_at_mut(details.len() / 2);
            let middle = head[head.len() - 1].end;
            let (own, others) = own_m2.split_at_mut((middle - first) as usize);
            rayon::join(|| self.find(head, (first, own)), || self.find(tail, (middle, others)));
            return;
        }
        let Some(detail) = details.first() else { return };
        let mut remembered = Remembered::since(self.history, &self.runs[detail.patch as usize]);
        let mut left = own_m2;
        for detail in details {
            let (patch, facets) = (&self.patches[detail.patch as usize], &self.runs[detail.patch as usize]);
            let (own_m2, rest) = left.split_at_mut(facets.places.len());
            left = rest;
            let run = facets.of(self.order);
            let found = FacetsScene { scene: self.scene, forces: self.forces, run };
            detail.find(patch, facets, &found, own_m2, &mut remembered);
        }
    }
}
