//! The default contact model: the paper's element potential with Coulomb friction.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{TetId, Vec3};
use rayon::prelude::*;

use crate::candidates::{Candidates, Facet};
use crate::friction::FrictionLaw;
use crate::model::{
    ContactError, ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport, FacetMemory,
};
use crate::pair::{PairMoments, TetFrame, pair_moments};

/// Pairs below which a second thread costs more than it brings.
const GRAIN_PAIRS: usize = 256;
/// Fraction of a tetrahedron's volume beyond which a negative overlap integral is more than rounding.
const PAST_CENTROID: f64 = 1e-9;

/// Normal forces −k_n n ∫ φ dA on boundary triangles, both ways, and friction on top of them.
pub struct PotentialContact {
    penalty_pa: f64,
    friction: Option<Box<dyn FrictionLaw>>,
    candidates: Candidates,
    frames: Vec<TetFrame>,
    moments: Vec<Option<PairMoments>>,
    overlap_energy: Vec<f64>,
    new_history: Vec<FacetMemory>,
}

impl PotentialContact {
    /// A model with normal penalty k_n [Pa], with or without friction.
    pub fn new(penalty_pa: f64, friction: Option<Box<dyn FrictionLaw>>) -> Self {
        Self {
            penalty_pa,
            friction,
            candidates: Candidates::default(),
            frames: Vec::new(),
            moments: Vec::new(),
            overlap_energy: Vec::new(),
            new_history: Vec::new(),
        }
    }

    /// Integrals of all candidate pairs at `input.position`.
    fn integrate(&mut self, input: &ContactInput) -> Result<(), ContactError> {
        self.candidates.update(input);
        let (blocks, position) = (input.blocks, input.position);
        self.frames.clear();
        for &tet in &self.candidates.tets {
            let frame = TetFrame::new(&blocks.tet_corners(tet, position));
            if frame.volume_m3.is_nan() || frame.volume_m3 <= 0.0 {
                let block = blocks.tet_block[tet.index()];
                return Err(ContactError::CollapsedTet { tet, block, volume_m3: frame.volume_m3 });
            }
            self.frames.push(frame);
        }
        let (frames, pairs) = (&self.frames, &self.candidates.pairs);
        self.moments.resize(pairs.len(), None);
        let integrate = |(slot, pair): (&mut Option<PairMoments>, &crate::candidates::Pair)| {
            let corners = blocks.triangle_corners(pair.triangle, position);
            *slot = pair_moments(&corners, &triangle_area_vector(&corners), &frames[pair.tet as usize]);
        };
        if pairs.len() > GRAIN_PAIRS {
            let slots = self.moments.par_iter_mut().zip(pairs.par_iter());
            slots.with_min_len(GRAIN_PAIRS / 2).for_each(integrate);
        } else {
            self.moments.iter_mut().zip(pairs).for_each(integrate);
        }
        Ok(())
    }

    /// W = k_n Σ ∫ φ dV [J], and a tetrahedron whose centroid is inside another block, if there is one.
    fn potential_energy(&mut self) -> (f64, Option<TetId>) {
        self.overlap_energy.clear();
        self.overlap_energy.resize(self.candidates.overlaps.len(), 0.0);
        for (pair, moments) in self.candidates.pairs.iter().zip(&self.moments) {
            if let Some(moments) = moments {
                self.overlap_energy[pair.overlap as usize] += moments.energy;
            }
        }
        let (mut sum, mut past) = (0.0, None);
        for (k, &(tet, _)) in self.candidates.overlaps.iter().enumerate() {
            let slot = self.candidates.tets.binary_search(&tet).expect("every overlap has its tet");
            let volume_m3 = self.frames[slot].volume_m3;
            sum += self.overlap_energy[k];
            if self.overlap_energy[k] < -PAST_CENTROID * volume_m3 {
                // ∫ φ over the whole tetrahedron is V/4: that is what a contained centroid leaves out.
                sum += 0.25 * volume_m3;
                past = past.or(Some(tet));
            }
        }
        (self.penalty_pa * sum, past)
    }

    /// Normal force, friction and stiffness of one facet on one block, added to the nodes.
    fn add_facet(
        &self,
        facet: &Facet,
        input: &ContactInput,
        old: &ContactHistory,
        output: &mut ContactOutput,
    ) -> Option<FacetMemory> {
        let moments = || self.moments[facet.pairs.clone()].iter().flatten();
        let pressure: f64 = moments().map(PairMoments::total).sum();
        if pressure <= 0.0 {
            return None;
        }
        let corners = input.blocks.triangle_corners(facet.triangle, input.position);
        let normal = triangle_area_vector(&corners).normalize();
        let push = -self.penalty_pa * normal;
        let mut memory = None;
        let mut shear = None;
        if let Some(law) = &self.friction {
            let basis = facet_basis(&corners, &normal);
            let slip = self.slip(facet, input, pressure);
            let mut shear_n = remembered(old, facet);
            let area: f64 = moments().map(|m| m.area).sum();
            let slip_m = [slip.dot(&basis[0]), slip.dot(&basis[1])];
            law.advance(self.penalty_pa * pressure, area, &slip_m, &mut shear_n);
            shear = Some((basis[0] * shear_n[0] + basis[1] * shear_n[1]) / pressure);
            memory = Some(FacetMemory { facet: facet.triangle, target: facet.target, shear_n });
        }
        self.scatter(facet, input, &push, shear.as_ref(), output);
        memory
    }

    /// Slip of the step at the facet's centre of pressure [m], contactor minus target.
    fn slip(&self, facet: &Facet, input: &ContactInput, pressure: f64) -> Vec3 {
        let triangle = input.blocks.triangles[facet.triangle.index()];
        let mut sum = Vec3::zeros();
        for k in facet.pairs.clone() {
            let Some(moments) = &self.moments[k] else { continue };
            let tet = input.blocks.tets[self.candidates.tets[self.candidates.pairs[k].tet as usize].index()];
            for (node, w) in triangle.iter().zip(moments.pressure) {
                sum += w * input.velocity[node.index()];
            }
            for (node, w) in tet.iter().zip(moments.target_pressure) {
                sum -= w * input.velocity[node.index()];
            }
        }
        input.dt_s / pressure * sum
    }

    /// Nodal forces ∫ N dF of the facet and, opposite, of the target; the target's weights are the contactor's seen
    /// from its shape functions, so force and moment balance to round-off.
    fn scatter(
        &self,
        facet: &Facet,
        input: &ContactInput,
        push: &Vec3,
        shear: Option<&Vec3>,
        output: &mut ContactOutput,
    ) {
        let triangle = input.blocks.triangles[facet.triangle.index()];
        let per_pressure = push + shear.unwrap_or(&Vec3::zeros());
        for k in facet.pairs.clone() {
            let Some(moments) = &self.moments[k] else { continue };
            let tet = input.blocks.tets[self.candidates.tets[self.candidates.pairs[k].tet as usize].index()];
            let contactor = triangle.iter().zip(moments.pressure).zip(moments.slope);
            let target = tet.iter().zip(moments.target_pressure).zip(moments.target_slope);
            for ((node, w), slope) in contactor {
                output.force[node.index()] += w * per_pressure;
                output.stiffness[node.index()] += 2.0 * self.penalty_pa * slope;
                if let Some(shear) = shear {
                    output.friction_force[node.index()] += w * shear;
                }
            }
            for ((node, w), slope) in target {
                output.force[node.index()] -= w * per_pressure;
                output.stiffness[node.index()] += 2.0 * self.penalty_pa * slope.max(0.0);
                if let Some(shear) = shear {
                    output.friction_force[node.index()] -= w * shear;
                }
            }
        }
    }

    fn report(&mut self) -> Result<ContactReport, ContactError> {
        let (energy_j, past) = self.potential_energy();
        let mut report = ContactReport {
            candidate_pairs: self.candidates.pairs.len(),
            energy_j,
            ..ContactReport::default()
        };
        for (pair, moments) in self.candidates.pairs.iter().zip(&self.moments) {
            let Some(moments) = moments else { continue };
            let tet = self.candidates.tets[pair.tet as usize];
            let (on_contactor, on_target) = (moments.total(), moments.target_pressure.iter().sum::<f64>());
            if !on_contactor.is_finite() || !on_target.is_finite() {
                return Err(ContactError::NotFinite { triangle: pair.triangle, tet });
            }
            report.contact_pairs += 1;
            if on_contactor > 0.0 {
                let error = (on_contactor - on_target).abs() / on_contactor;
                report.action_reaction_error = report.action_reaction_error.max(error);
            }
            // φ = 4 λ, and λ is the depth over the height.
            let ratio = 0.25 * moments.depth;
            if report.deepest.is_none() || ratio > report.max_penetration_ratio {
                report.max_penetration_ratio = ratio;
                report.deepest = Some((pair.triangle, tet));
            }
            if past == Some(tet) && report.past_centroid.is_none() {
                report.past_centroid = Some((pair.triangle, tet));
            }
        }
        Ok(report)
    }
}

impl ContactModel for PotentialContact {
    fn add_forces(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
        output: &mut ContactOutput,
    ) -> Result<ContactReport, ContactError> {
        self.integrate(input)?;
        let report = self.report()?;
        let mut new_history = std::mem::take(&mut self.new_history);
        new_history.clear();
        for facet in &self.candidates.facets {
            new_history.extend(self.add_facet(facet, input, history, output));
        }
        // What did not touch is forgotten.
        std::mem::swap(&mut history.facets, &mut new_history);
        self.new_history = new_history;
        Ok(report)
    }

    fn energy_j(&mut self, input: &ContactInput) -> Result<f64, ContactError> {
        self.integrate(input)?;
        Ok(self.potential_energy().0)
    }

    fn has_friction(&self) -> bool {
        self.friction.is_some()
    }
}

/// Two unit vectors in the facet: along its first edge, and across. They turn with the facet.
fn facet_basis(corners: &[Vec3; 3], normal: &Vec3) -> [Vec3; 2] {
    let along = (corners[1] - corners[0]).normalize();
    [along, normal.cross(&along)]
}

/// The shear force that a facet remembers of its target; none when they did not touch before.
fn remembered(history: &ContactHistory, facet: &Facet) -> [f64; 2] {
    let key = |memory: &FacetMemory| (memory.facet, memory.target);
    let place = history.facets.binary_search_by_key(&(facet.triangle, facet.target), key);
    place.map_or([0.0, 0.0], |i| history.facets[i].shear_n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::Coulomb;
    use crate::testing::{check_model, evaluate, test_box, test_set};
    use ndda_mesh::BlockId;
    use ndda_mesh::geometry::tet_heights;

    #[test]
    fn it_keeps_the_contract_of_a_contact_model_with_and_without_friction() {
        check_model(&mut PotentialContact::new(1e9, None));
        check_model(&mut PotentialContact::new(1e9, Some(Box::new(Coulomb::new(30.0, 1e9)))));
    }

    #[test]
    fn blocks_that_only_touch_feel_exactly_nothing() {
        let sides = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.5, 0.25, 1.0], [1.0, 1.0, 1.0]];
        for corner in sides {
            let blocks = test_set(vec![
                test_box([0.0; 3], [1.0; 3], [2, 2, 2]),
                test_box(corner, [1.0; 3], [2, 2, 2]),
            ]);
            let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
            let position = &blocks.rest_position;
            let input = ContactInput { blocks: &blocks, position, velocity: &velocity, dt_s: 1.0 };
            let mut model = PotentialContact::new(1e9, None);
            let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
            assert!(answer.force.iter().all(|f| *f == Vec3::zeros()), "{corner:?}");
            assert_eq!(answer.report.energy_j, 0.0);
        }
    }

    #[test]
    fn flat_on_flat_the_pressure_is_that_of_both_heights() {
        // p = 4 k_n h (1/H_c + 1/H_t) as h → 0, the heights being those over the faces in touch.
        let depth = 1e-6;
        let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [1, 1, 1]);
        let upper = test_box([1.0, 1.0, 1.0 - depth], [1.0, 1.0, 0.5], [1, 1, 1]);
        let blocks = test_set(vec![lower, upper]);
        let height = |block: BlockId, z: f64| {
            let faces = blocks.triangles_of(block).filter(|&t| {
                blocks.triangles[t].iter().all(|n| (blocks.rest_position[n.index()].z - z).abs() < 1e-9)
            });
            let tet = blocks.triangle_tet[faces.into_iter().next().expect("a face there")];
            let corners = blocks.tet_corners(tet, &blocks.rest_position);
            let over = |i: usize| (corners[i].z - z).abs() > 1e-9;
            let apex = (0..4).find(|&i| over(i)).expect("an apex");
            tet_heights(&corners)[apex]
        };
        let (below, above) = (height(BlockId(0), 1.0), height(BlockId(1), 1.0 - depth));
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let position = &blocks.rest_position;
        let input = ContactInput { blocks: &blocks, position, velocity: &velocity, dt_s: 1.0 };
        let answer = evaluate(&mut PotentialContact::new(1e9, None), &input, &mut ContactHistory::default());
        let force: Vec3 = answer.force[blocks.nodes_of(BlockId(1))].iter().sum();
        let expected = 4.0 * 1e9 * depth * (1.0 / below + 1.0 / above);
        assert!((force.z / expected - 1.0).abs() < 1e-4, "{} against {expected}", force.z);
    }

    #[test]
    fn friction_holds_until_its_cap_and_is_forgotten_on_release() {
        let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [2, 2, 1]);
        let upper = test_box([1.0, 1.0, 0.999], [1.0, 1.0, 0.5], [1, 1, 1]);
        let blocks = test_set(vec![lower, upper]);
        let mut velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        velocity[blocks.nodes_of(BlockId(1))].fill(Vec3::x());
        let (penalty, shear_penalty, friction_deg) = (1e9, 1e10, 30.0);
        let law = Coulomb::new(friction_deg, shear_penalty);
        let mut model = PotentialContact::new(penalty, Some(Box::new(law)));
        let mut history = ContactHistory::default();
        let slip_m = 1e-7;
        let mut input = ContactInput {
            blocks: &blocks,
            position: &blocks.rest_position,
            velocity: &velocity,
            dt_s: slip_m,
        };
        let stuck = evaluate(&mut model, &input, &mut history);
        let upper = blocks.nodes_of(BlockId(1));
        let total = |force: &[Vec3]| force[upper.clone()].iter().sum::<Vec3>();
        // k_s S u over the square metre of the patch; the thin walls in the other block add their share.
        let held = total(&stuck.friction_force).x;
        assert!((held / (-shear_penalty * slip_m) - 1.0).abs() < 5e-3, "{held}");

        input.dt_s = 1.0;
        let slid = evaluate(&mut model, &input, &mut history);
        let normal = total(&slid.force) - total(&slid.friction_force);
        let ratio = -total(&slid.friction_force).x / normal.z / f64::to_radians(friction_deg).tan();
        assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");

        let apart: Vec<Vec3> = blocks.rest_position.iter().map(|x| Vec3::new(x.x, x.y, 2.0 * x.z)).collect();
        input.position = &apart;
        let mut lifted = apart.clone();
        lifted[upper.clone()].iter_mut().for_each(|x| x.z += 1.0);
        input.position = &lifted;
        evaluate(&mut model, &input, &mut history);
        assert!(history.facets.is_empty());
    }

    #[test]
    fn a_centroid_inside_another_block_is_noticed_and_its_energy_counted() {
        // A whole small block inside a large tetrahedron's neighbourhood: its tets lie inside the large block.
        let blocks = test_set(vec![
            test_box([0.0; 3], [1.0; 3], [1, 1, 1]),
            test_box([0.3, 0.3, 0.8], [0.4, 0.4, 0.3], [1, 1, 1]),
        ]);
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let position = &blocks.rest_position;
        let input = ContactInput { blocks: &blocks, position, velocity: &velocity, dt_s: 1.0 };
        let answer = evaluate(&mut PotentialContact::new(1e9, None), &input, &mut ContactHistory::default());
        assert!(answer.report.past_centroid.is_some());
        assert!(answer.report.energy_j > 0.0);
    }
}
