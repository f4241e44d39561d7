//! Audit of the contact potential's last evaluation.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::affine::closing::closing_m_s;
use crate::affine::surface::BlockFaces;
use crate::audit::ContactAudit;
use crate::friction::bond;
use crate::friction::facet::relative_motion;
use crate::model::{ContactHistory, ContactInput, FacetContact, SpringSlip};
use crate::plan::Part;
use crate::potential::contact_potential::PotentialField;
use crate::restitution::ContactDamping;
use crate::room::make_room;

use super::forces::for_each_facet;
use super::{PotentialContact, plan};

impl ContactAudit for PotentialContact {
    fn each_work(&mut self, blocks: &BlockSet, moved: &[Vec3], add: &mut dyn FnMut(BlockId, BlockId, f64)) {
        let (integrals, forces, outcomes) = (&self.integrals, &self.forces, &self.outcomes);
        let taken_pa = self.damping.as_deref().map_or(&[][..], ContactDamping::taken_pa);
        let touching = integrals.touching();
        let work_of = |(t, work_j): (usize, &mut f64)| {
            let touch = &touching[t];
            let found = (integrals.overlaps_of(touch), integrals.sums_of(touch));
            let push = taken_pa.get(t).map_or(forces[t].push, |taken_pa| forces[t].push + taken_pa);
            // What dilation takes from friction is stored in contact.
            let dilation_work_j = outcomes.get(t).map_or(0.0, |outcome| outcome.dilation_work_j);
            *work_j = push.dot(&relative_motion(touch, found, (blocks, moved))) - dilation_work_j;
        };
        make_room(&mut self.work_of_facet, touching.len());
        self.work_of_facet.resize(touching.len(), 0.0);
        for_each_facet(&mut self.work_of_facet, work_of);
        for (touch, &work_j) in touching.iter().zip(&self.work_of_facet) {
            add(touch.owner, touch.target, work_j);
        }
    }

    fn each_push(&self, add: &mut dyn FnMut(BlockId, BlockId, &Vec3)) {
        for (touch, force) in self.integrals.touching().iter().zip(&self.forces).filter(|(_, f)| f.touches) {
            add(touch.owner, touch.target, &(self.integrals.sums_of(touch).pressure * force.push));
        }
    }

    fn damps(&self) -> bool {
        self.damping.is_some()
    }

    fn damps_strongly(&self) -> bool {
        self.damping.as_ref().is_some_and(|damping| damping.is_strong())
    }

    fn each_damping_work(
        &mut self,
        blocks: &BlockSet,
        position: &[Vec3],
        moved: &[Vec3],
        add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
        if let Some(damping) = &self.damping {
            damping.each_work((blocks, &self.integrals, &self.hulls), position, moved, add);
        }
    }

    fn each_coulomb_gap(
        &mut self,
        blocks: &BlockSet,
        moved: &[Vec3],
        add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
        if self.rubs_faces() {
            self.faces.each_coulomb_gap((blocks, &self.integrals, &self.forces), moved, add);
        }
    }

    fn each_spring_slip(&self, add: &mut dyn FnMut(BlockId, BlockId, &SpringSlip)) {
        if self.joints.is_none() {
            return;
        }
        for (touch, outcome) in self.integrals.touching().iter().zip(&self.outcomes) {
            if let Some(spring) = &outcome.spring {
                add(touch.owner, touch.target, spring);
            }
        }
    }

    fn each_energy(&self, add: &mut dyn FnMut(BlockId, BlockId, f64)) {
        let energies = self.overlaps.each_energy_m3(self.potential.law());
        energies.for_each(|(a, b, energy_m3)| add(a, b, self.penalty_pa * energy_m3));
    }

    /// A convex block is as wide as it reaches below the nearest of its faces, where φ does not depend on tetrahedra.
    fn width_m(&self, blocks: &BlockSet, block: BlockId) -> Option<f64> {
        let Some((_, PotentialField::Pieces(_))) = &self.field else { return None };
        BlockFaces::new(blocks, block).width_m(blocks, block)
    }

    fn closing_m_s(&self, input: &ContactInput, pair: (BlockId, BlockId)) -> Option<f64> {
        closing_m_s(&self.hulls, input, pair)
    }

    fn plan(&self) -> Vec<Part> {
        plan::parts(self)
    }

    fn add_facets(&self, input: &ContactInput, history: &ContactHistory, facets: &mut Vec<FacetContact>) {
        let normals = self.normals_of_friction(input.blocks);
        let tilt_n_m = self.damping.as_deref().map_or(&[][..], ContactDamping::tilt_n_m);
        for (t, (touch, force)) in self.integrals.touching().iter().zip(&self.forces).enumerate() {
            if !force.touches {
                continue;
            }
            let sums = self.integrals.sums_of(touch);
            let own = triangle_area_vector(&input.blocks.triangle_corners(touch.triangle, input.position))
                .normalize();
            let of_patch = normals.get(t).filter(|normal| **normal != Vec3::zeros());
            let twist_n_m = force.couple_n_m * of_patch.unwrap_or(&own);
            let tilt_n_m = tilt_n_m.get(t).copied().unwrap_or_default();
            facets.push(FacetContact {
                facet: touch.triangle,
                target: touch.target,
                area_m2: sums.area,
                normal: own,
                center: force.center,
                push_n: sums.pressure * force.push,
                friction_n: force.friction_n(sums),
                couple_n_m: twist_n_m + tilt_n_m + force.moment_of_friction(sums, input, touch.triangle),
                sticks: force.sticks,
            });
        }
        if let Some(joints) = &self.joints {
            bond::add_facets(joints, input, &history.bonds, facets);
        }
    }
}

impl PotentialContact {
    /// Normal of the patch of each touching facet whose friction was searched for, zero for others; none where no friction is.
    fn normals_of_friction(&self, blocks: &BlockSet) -> Vec<Vec3> {
        if !self.rubs_faces() {
            return Vec::new();
        }
        let mut normals = vec![Vec3::zeros(); self.integrals.touching().len()];
        for block in blocks.ids() {
            self.faces.searched_facets(block).for_each(|(t, normal)| normals[t as usize] = *normal);
        }
        normals
    }
}
