//! Candidate pairs, integrals and penalties, from which forces of contact are found; memory of facets, and stiffness of contact.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{Mat3, Vec3};

use crate::affine::surface::BlockFaces;
use crate::assembly::overlap_parts::OverlapParts;
use crate::assembly::tangent::{self, Target};
use crate::friction::bond_formation;
use crate::friction::facet::{KeptShear, element_of};
use crate::friction::law_table::FrictionLawTable;
use crate::friction::openings::{self, Moment};
use crate::integration::scene::Scene;
use crate::model::{ContactError, ContactHistory, ContactInput, FacetMemory};
use crate::pair_stiffness::PairStiffness;

use crate::potential::contact_potential::{OverlapLaw, PotentialField};
use crate::room::make_room;

use super::PotentialContact;

impl PotentialContact {
    /// Forms the bonds of blocks where they are meshed: where contact is evaluated first, a step ahead, faces that are glued have parted.
    pub(super) fn form_bonds(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
    ) -> Result<(), ContactError> {
        let start = ContactInput { position: &input.blocks.rest_position, ..*input };
        self.find_pairs(&start)?;
        if let Some(joints) = &self.joints {
            bond_formation::form(joints, (&self.candidates, &self.hulls), &start, &mut history.bonds);
        }
        Ok(())
    }

    /// Integrals of all candidate pairs at `input.position`.
    pub(super) fn integrate(&mut self, input: &ContactInput) -> Result<(), ContactError> {
        self.find_pairs(input)?;
        let Some((_, field)) = &self.field else { return Ok(()) };
        let (blocks, position) = (input.blocks, input.position);
        let Self { candidates, frames, hulls, openings, integrals, .. } = self;
        let scene = Scene { blocks, position, candidates, frames, field, hulls, openings };
        Ok(integrals.update(&scene, input.ranks)?)
    }

    /// Candidate pairs at `input.position`, and frames of their tetrahedra.
    pub(super) fn find_pairs(&mut self, input: &ContactInput) -> Result<(), ContactError> {
        let tets = input.blocks.tets.len();
        if self.fitted_to != Some(tets) {
            if self.field.as_ref().is_none_or(|(known, _)| *known != tets) {
                self.fit_potential(input.blocks).map_err(|e| ContactError::Potential(e.to_string()))?;
            }
            let surfaces = BlockFaces::of_all(input.blocks);
            // Memory per element needs the elements.
            let phi_per_m = self.potential.phi_per_m().filter(|_| !self.candidates.split_by_element);
            // Each facet has a history of its own.
            let by_triangle = self.joints.as_ref().is_some_and(|joints| !joints.act_on_faces_only());
            self.hulls.fit(input.blocks, &surfaces, phi_per_m, input.affine, by_triangle);
            if self.rubs_faces() {
                self.faces.fit(input.blocks, &surfaces, input.affine);
            }
            self.fitted_to = Some(tets);
        }
        let opening_m = self.openings.most_m();
        self.candidates.make_room(opening_m);
        self.candidates.update(input, &self.hulls);
        let Self { candidates, hulls, frames, .. } = self;
        if candidates.pairs() > 0 {
            hulls.place(input.blocks, input.position);
            hulls.separate(input.blocks, input.position, &candidates.neighbours, opening_m);
        }
        frames.place(candidates, hulls, input)
    }

    /// Takes from what facets remember by how much they are moved out.
    pub(super) fn place_openings(&mut self, input: &ContactInput, history: &ContactHistory, moment: Moment) {
        self.openings.take(self.joints.as_ref(), input.blocks, history, moment);
    }

    /// k_n dw/dU of each touching facet's pair of blocks [Pa].
    pub(super) fn place_penalties(&mut self, input: &ContactInput) -> Result<(), ContactError> {
        let touching = self.integrals.touching();
        self.penalty_of_facet.clear();
        self.curvature_of_facet.clear();
        make_room(&mut self.penalty_of_facet, touching.len());
        if self.potential.law() == OverlapLaw::Linear {
            self.penalty_of_facet.resize(touching.len(), self.penalty_pa);
            return Ok(());
        }
        let Some((_, field)) = &self.field else { return Ok(()) };
        let parts = OverlapParts {
            candidates: &self.candidates,
            integrals: &self.integrals,
            frames: &self.frames,
            field,
            hulls: &self.hulls,
            openings: &self.openings,
        };
        self.overlaps.add_touching(input, &parts)?;
        let law = self.potential.law();
        for (overlap, pressure_m2) in self.overlaps.of_touching() {
            self.penalty_of_facet.push(self.penalty_pa * law.slope(overlap));
            self.curvature_of_facet.push(self.penalty_pa * law.curvature(overlap) * pressure_m2);
        }
        Ok(())
    }

    /// Whether a friction law acts on whole faces.
    pub(super) fn rubs_faces(&self) -> bool {
        self.joints.as_ref().is_some_and(FrictionLawTable::act_on_faces)
    }

    /// Takes over what facets remember; what did not touch is forgotten.
    pub(super) fn remember(&mut self, input: &ContactInput, history: &mut ContactHistory) {
        if self.openings.is_empty() {
            // The old records have been read, so that their memory is free for the new ones.
            std::mem::swap(&mut history.facets, &mut self.new_facets);
            std::mem::swap(&mut history.law_state, &mut self.new_state);
        }
        self.new_facets.clear();
        self.new_state.clear();
        let len = history.law_state_len as usize;
        for (t, (touch, outcome)) in self.integrals.touching().iter().zip(&self.outcomes).enumerate() {
            if let Some(KeptShear { shear_n, twist_n_m, broken }) = outcome.memory {
                self.new_state.extend_from_slice(&self.state_of_facet[t * len..(t + 1) * len]);
                self.new_facets.push(FacetMemory {
                    facet: touch.triangle,
                    target: touch.target,
                    element: element_of(self.joints.as_ref(), self.integrals.overlaps_of(touch)),
                    shear_n,
                    twist_n_m,
                    area_m2: self.integrals.sums_of(touch).area,
                    broken,
                });
            }
        }
        if !self.openings.is_empty() {
            self.keep_open_facets(input, history);
        }
        std::mem::swap(&mut history.facets, &mut self.new_facets);
        std::mem::swap(&mut history.law_state, &mut self.new_state);
        history.begun = true;
    }

    /// Takes over what facets remember whose joints have opened by slip, and which do not touch now but may again.
    #[inline(never)]
    fn keep_open_facets(&mut self, input: &ContactInput, history: &ContactHistory) {
        let Self { joints: Some(joints), new_facets, new_state, .. } = self else { return };
        let len = history.law_state_len as usize;
        for (old, memory) in history.facets.iter().enumerate() {
            let state = history.state_of(old);
            if let Err(place) = new_facets.binary_search_by_key(&memory.key(), FacetMemory::key)
                && openings::is_kept(joints, input, (memory, state))
            {
                new_facets.insert(place, memory.at_rest());
                new_state.splice(place * len..place * len, state.iter().copied());
            }
        }
    }

    /// Stiffness of one facet's hits: normal contact, and the shear spring of a facet that sticks.
    pub(super) fn add_facet_stiffness(
        &self,
        t: usize,
        input: &ContactInput,
        stiffness: &mut Vec<PairStiffness>,
    ) {
        let touch = &self.integrals.touching()[t];
        let force = self.forces.binary_search_by_key(&touch.facet, |force| force.facet);
        let held = force.ok().map(|place| &self.forces[place]);
        let held = held.filter(|force| force.shear_slope > 0.0 && force.sticks);
        let at_nodes = input.blocks.triangle_corners(touch.triangle, input.position);
        let mut corners = at_nodes;
        if !self.openings.is_empty() {
            let normal = triangle_area_vector(&corners).normalize();
            let opening_m = self.openings.of(touch.triangle, touch.target);
            corners = openings::moved_out(&corners, &normal, opening_m);
        }
        let outline = self.hulls.outline(touch.triangle, touch.target);
        for overlap in self.integrals.overlaps_of(touch) {
            let tet = overlap.tet;
            let target = match (&self.field, self.hulls.affine_target(touch.target)) {
                (_, Some(_)) => Target::Convex(self.hulls.planes_of(touch.target), outline),
                (Some((_, PotentialField::Pieces(table))), None) => Target::Pieces(table.of(tet)),
                (Some((_, PotentialField::Function(field))), None) => Target::Function(field, tet),
                _ => Target::Element,
            };
            let frame = self.frames.at(overlap.slot);
            let triangle = &input.blocks.triangles[touch.triangle.index()];
            let mut pair = PairStiffness::new(triangle, &input.blocks.tets[tet.index()]);
            tangent::add_pair(&mut pair, &corners, frame, target, self.penalty_of_facet[t]);
            if let Some(force) = held {
                let normal = force.push.normalize();
                let across = Mat3::identity() - normal * normal.transpose();
                // The spring of a facet, shared among its hits by their pressure. A hit that only grazes has no weights.
                if let Some((total, center)) = overlap.center(&input.blocks.tet_corners(tet, input.position))
                {
                    let [a, b, c] = weights_in_triangle(&at_nodes, &center);
                    let [d, e, g, h] = overlap.on_target.pressure.map(|w| w / total);
                    let weights = [a, b, c, -d, -e, -g, -h];
                    pair.add_spring(&weights, &(force.shear_slope * total * across));
                }
            }
            stiffness.push(pair);
        }
    }
}

/// Weights of the corners of a triangle at a point of its plane.
fn weights_in_triangle(corners: &[Vec3; 3], x: &Vec3) -> [f64; 3] {
    let whole = triangle_area_vector(corners);
    let part = |a: usize, b: usize| {
        triangle_area_vector(&[*x, corners[a], corners[b]]).dot(&whole) / whole.norm_squared()
    };
    let (b, c) = (part(2, 0), part(0, 1));
    [1.0 - b - c, b, c]
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_mesh::BlockId;

    use crate::contact_model::ContactModel;
    use crate::potential::contact_potential::ContactPotential;
    use crate::potential::element::ElementPotential;
    use crate::testing::{evaluate, test_box, test_set};

    /// Relative difference of the tangent and of differences of the force, for a rigid shift and for a field that
    /// bends the upper block.
    fn tangent_error(potential: Box<dyn ContactPotential>, bends: bool) -> f64 {
        let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [3, 2, 2]);
        let upper = test_box([0.83, 0.71, 0.99], [1.1, 0.9, 0.7], [2, 2, 1]);
        let blocks = test_set(vec![lower, upper]);
        let upper = blocks.nodes_of(BlockId(1));
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let mut model = PotentialContact::new(1e9).with_potential(potential);
        let mut shift = vec![Vec3::zeros(); velocity.len()];
        for i in upper {
            let x = blocks.rest_position[i];
            let bent = Vec3::new(0.1 * x.y, -0.2 * x.x * x.y, (3.0 * x.x).sin() * (2.0 * x.y).cos());
            shift[i] = if bends { bent } else { Vec3::new(0.2, -0.1, 0.9) };
        }
        let step = 1e-7;
        let mut force_at = |factor: f64| {
            let position: Vec<Vec3> =
                blocks.rest_position.iter().zip(&shift).map(|(x, u)| x + factor * step * u).collect();
            let input = ContactInput::new(&blocks, &position, &velocity, 1.0);
            evaluate(&mut model, &input, &mut ContactHistory::default()).force
        };
        let (ahead, behind) = (force_at(1.0), force_at(-1.0));
        let mut pairs = Vec::new();
        let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1.0);
        let history = ContactHistory::default();
        model.add_stiffness(&input, &history, &mut pairs).expect("sound blocks");
        let mut change = vec![Vec3::zeros(); shift.len()];
        for pair in &pairs {
            pair.add_times(&shift, &mut change);
            let largest = pair.block.iter().flatten().map(|k| k.norm()).fold(0.0, f64::max);
            for (p, row) in pair.block.iter().enumerate() {
                for (q, k) in row.iter().enumerate() {
                    assert!((k - pair.block[q][p].transpose()).norm() <= 1e-12 * largest);
                }
            }
        }
        let expected: Vec<Vec3> = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * step)).collect();
        let size: f64 = expected.iter().map(|f| f.norm_squared()).sum();
        let error: f64 = expected.iter().zip(&change).map(|(e, c)| (e - c).norm_squared()).sum();
        (error / size).sqrt()
    }

    #[test]
    fn the_tangent_is_symmetric_and_the_slope_of_the_force() {
        let potentials: [fn() -> Box<dyn ContactPotential>; 2] =
            [|| Box::new(ElementPotential), || Box::new(crate::SmoothPotential { reference_m: 1.0 })];
        for potential in potentials {
            let (shifted, bent) = (tangent_error(potential(), false), tangent_error(potential(), true));
            // One per cent deep in its smallest element: what turns and stretches is left out to that order.
            println!("{}: shift {shifted:.1e}, bending {bent:.1e}", potential().name());
            assert!(shifted < 0.05 && bent < 0.1, "shift {shifted}, bending {bent}");
        }
    }

    #[test]
    fn the_stiffness_bounds_the_slope_of_the_force_for_every_potential() {
        let potentials: [fn() -> Box<dyn ContactPotential>; 3] = [
            || Box::new(ElementPotential),
            || Box::new(crate::SmoothPotential { reference_m: 1.0 }),
            || Box::new(crate::VolumePotential { exponent: 2.0, reference_m3: 1.0 }),
        ];
        let blocks = test_set(vec![
            test_box([0.0; 3], [3.0, 3.0, 1.0], [3, 2, 2]),
            test_box([0.83, 0.71, 0.99], [1.1, 0.9, 0.7], [2, 2, 1]),
        ]);
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let upper = blocks.nodes_of(BlockId(1));
        for potential in potentials {
            let mut model = PotentialContact::new(1e9).with_potential(potential());
            let mut force_at = |lift: f64| {
                let mut position = blocks.rest_position.clone();
                position[upper.clone()].iter_mut().for_each(|x| x.z += lift);
                let input = ContactInput::new(&blocks, &position, &velocity, 1.0);
                let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
                (
                    answer.force[upper.clone()].iter().sum::<Vec3>().z,
                    answer.stiffness[upper.clone()].iter().sum::<f64>(),
                )
            };
            let slope = (force_at(-1e-6).0 - force_at(1e-6).0) / 2e-6;
            let bound = force_at(0.0).1;
            assert!(slope > 0.0 && slope <= bound && bound < 10.0 * slope, "{slope:e} and {bound:e}");
        }
    }
}
