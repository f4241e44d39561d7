//! The default contact model: a contact potential, and friction on top of it.

mod plan;

use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};
use rayon::prelude::*;

use crate::block_faces::BlockFaces;
use crate::bonds;
use crate::both::both;
use crate::by_block::ByBlock;
use crate::candidates::Candidates;
use crate::closing::closing_m_s;
use crate::element_potential::ElementPotential;
use crate::energy::{self, OverlapParts};
use crate::facets::{FacetForce, FacetScene, relative_motion};
use crate::friction::FrictionLaw;
use crate::friction_patches::{FrictionPatches, PatchScene};
use crate::hulls::Hulls;
use crate::integrals::{Integrals, Scene, Touch};
use crate::joints::{Joints, Memory};
use crate::model::{
    ContactError, ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport, FacetContact,
    FacetMemory, SpringSlip,
};
use crate::pair::{OnTarget, TetFrame};
use crate::pair_stiffness::PairStiffness;
use crate::plan::Part;
use crate::potential::{ContactPotential, Field, OverlapLaw};
use crate::report::Reporter;
use crate::scatter::{self, ScatterScene};
use crate::tangent::{self, Target};

/// Facets below which a second thread costs more than it brings.
const GRAIN_FACETS: usize = 128;
/// The same for frames.
const GRAIN_FRAMES: usize = 512;

/// Normal forces −k_n n ∫ φ dA on boundary triangles, both ways, and friction on top of them.
///
/// One model serves one set of blocks: what it learns of their rest shape at the first evaluation it keeps.
pub struct PotentialContact {
    penalty_pa: f64,
    potential: Box<dyn ContactPotential>,
    joints: Option<Joints>,
    /// φ of the blocks last seen, and how many tetrahedra they had.
    field: Option<(usize, Field)>,
    candidates: Candidates,
    hulls: Hulls,
    integrals: Integrals,
    by_block: ByBlock,
    frames: Vec<TetFrame>,
    forces: Vec<FacetForce>,
    /// What hosts feel of them: a block need not look for the hits, which are far away in memory.
    on_host: Vec<OnTarget>,
    penalty_of_facet: Vec<f64>,
    /// k_n w″(U) ∫ φ dA of each facet's pair of blocks [Pa/m]; empty where the law is linear.
    curvature_of_facet: Vec<f64>,
    faces: FrictionPatches,
    overlaps: energy::BlockOverlaps,
    reporter: Reporter,
    new_facets: Vec<FacetMemory>,
    work_of_facet: Vec<f64>,
}

impl PotentialContact {
    /// The element potential with penalty k_n [Pa], without friction.
    pub fn new(penalty_pa: f64) -> Self {
        Self {
            penalty_pa,
            potential: Box::new(ElementPotential),
            joints: None,
            field: None,
            candidates: Candidates::default(),
            hulls: Hulls::default(),
            integrals: Integrals::default(),
            by_block: ByBlock::default(),
            frames: Vec::new(),
            forces: Vec::new(),
            on_host: Vec::new(),
            penalty_of_facet: Vec::new(),
            curvature_of_facet: Vec::new(),
            faces: FrictionPatches::default(),
            overlaps: Default::default(),
            reporter: Reporter::default(),
            new_facets: Vec::new(),
            work_of_facet: Vec::new(),
        }
    }

    /// With another potential.
    pub fn with_potential(mut self, potential: Box<dyn ContactPotential>) -> Self {
        self.potential = potential;
        self
    }

    /// With one friction law between all blocks.
    pub fn with_friction(self, law: Box<dyn FrictionLaw>) -> Self {
        self.with_joints(Joints::everywhere(law))
    }

    /// With friction laws for pairs of materials and for named surfaces.
    pub fn with_joints(mut self, joints: Joints) -> Self {
        self.candidates.split_by_element = joints.memory == Memory::Element;
        self.joints = Some(joints);
        self
    }

    /// Integrals of all candidate pairs at `input.position`.
    fn integrate(&mut self, input: &ContactInput) -> Result<(), ContactError> {
        self.find_pairs(input)?;
        let Some((_, field)) = &self.field else { return Ok(()) };
        let (blocks, position) = (input.blocks, input.position);
        let (candidates, frames, hulls) = (&self.candidates, &self.frames[..], &self.hulls);
        self.integrals.update(&Scene { blocks, position, candidates, frames, field, hulls });
        Ok(())
    }

    /// Candidate pairs at `input.position`, and frames of their tetrahedra.
    fn find_pairs(&mut self, input: &ContactInput) -> Result<(), ContactError> {
        let tets = input.blocks.tets.len();
        if self.field.as_ref().is_none_or(|(known, _)| *known != tets) {
            let field = self.potential.field(input.blocks);
            let surfaces = BlockFaces::of_all(input.blocks);
            // Memory per element needs the elements.
            let phi_per_m = self.potential.phi_per_m().filter(|_| !self.candidates.split_by_element);
            // What a facet remembers is its own.
            let by_triangle = self.joints.as_ref().is_some_and(|joints| !joints.act_on_faces_only());
            self.hulls.fit(input.blocks, &surfaces, phi_per_m, input.affine, by_triangle);
            self.candidates.numbers_overlaps = matches!(field, Ok(Field::Element));
            if self.needs_bodies() {
                self.faces.fit(input.blocks, &surfaces);
            }
            self.field = Some((tets, field.map_err(|e| ContactError::Potential(e.to_string()))?));
        }
        self.candidates.update(input, &self.hulls);
        let Self { candidates, hulls, frames, .. } = self;
        let place_hulls = || {
            if !candidates.pairs.is_empty() {
                hulls.place(input.blocks, input.position);
                hulls.separate(input.blocks, input.position, &candidates.neighbours);
            }
        };
        let many = candidates.tets.len() > GRAIN_FRAMES;
        both(many, place_hulls, || place_frames(frames, candidates, input)).1
    }

    /// k_n dw/dU of each touching facet's pair of blocks [Pa].
    fn place_penalties(&mut self, input: &ContactInput) {
        let touching = self.integrals.touching();
        self.penalty_of_facet.clear();
        self.curvature_of_facet.clear();
        if self.potential.law() == OverlapLaw::Linear {
            self.penalty_of_facet.resize(touching.len(), self.penalty_pa);
            return;
        }
        self.overlaps.add_surfaces(input, &self.candidates, &self.integrals);
        let law = self.potential.law();
        for touch in touching {
            let (a, b) = (touch.owner, touch.target);
            let overlap = self.overlaps.of(a, b);
            self.penalty_of_facet.push(self.penalty_pa * law.slope(overlap));
            let curvature = self.penalty_pa * law.curvature(overlap) * self.overlaps.pressure_of(a, b);
            self.curvature_of_facet.push(curvature);
        }
    }

    /// Takes over what facets remember; what did not touch is forgotten.
    fn remember(&mut self, input: &ContactInput, history: &mut ContactHistory) {
        self.new_facets.clear();
        let scene = FacetScene { input, candidates: &self.candidates, joints: self.joints.as_ref(), history };
        for (touch, force) in self.integrals.touching().iter().zip(&self.forces) {
            let facet = &self.candidates.facets[force.facet as usize];
            if let Some(memory) = force.memory {
                self.new_facets.push(FacetMemory {
                    facet: facet.triangle,
                    target: facet.target,
                    element: scene.element_of(facet),
                    shear_n: memory.shear_n,
                    plastic_slip_m: memory.plastic_slip_m,
                    area_m2: self.integrals.sums_of(touch).area,
                    broken: memory.broken,
                });
            }
        }
        std::mem::swap(&mut history.facets, &mut self.new_facets);
        history.begun = true;
    }

    /// Stiffness of one facet's hits: normal contact, and the shear spring of a facet that sticks.
    fn add_facet_stiffness(&self, t: usize, input: &ContactInput, stiffness: &mut Vec<PairStiffness>) {
        let touch = &self.integrals.touching()[t];
        let force = self.forces.binary_search_by_key(&touch.facet, |force| force.facet);
        let held = force.ok().map(|place| &self.forces[place]);
        let held = held.filter(|force| force.shear_slope > 0.0 && force.sticks);
        let corners = input.blocks.triangle_corners(touch.triangle, input.position);
        let outline = self.hulls.outline(touch.triangle, touch.target);
        for hit in self.integrals.hits_of(touch) {
            let tet = hit.tet;
            let target = match (&self.field, self.hulls.whole(touch.target)) {
                (_, Some(_)) => Target::Whole(self.hulls.planes_of(touch.target), outline),
                (Some((_, Field::Pieces(table))), None) => Target::Pieces(table.of(tet)),
                _ => Target::Element,
            };
            let frame = &self.frames[self.candidates.pairs[hit.pair as usize].tet as usize];
            let triangle = &input.blocks.triangles[touch.triangle.index()];
            let mut pair = PairStiffness::new(triangle, &input.blocks.tets[tet.index()]);
            tangent::add_pair(&mut pair, &corners, frame, target, self.penalty_of_facet[t]);
            if let Some(force) = held {
                let normal = force.push.normalize();
                let across = Mat3::identity() - normal * normal.transpose();
                // The spring of a facet, shared among its hits by their pressure.
                let [a, b, c] = hit.pressure;
                let [d, e, g, h] = hit.on_target.pressure;
                let total = a + b + c;
                let weights = [a, b, c, -d, -e, -g, -h].map(|w| w / total);
                pair.add_spring(&weights, &(force.shear_slope * total * across));
            }
            stiffness.push(pair);
        }
    }
}

fn place_frames(
    frames: &mut Vec<TetFrame>,
    candidates: &Candidates,
    input: &ContactInput,
) -> Result<(), ContactError> {
    let (blocks, Candidates { tets, order, .. }) = (input.blocks, candidates);
    frames.resize(tets.len(), TetFrame::default());
    let place = |(slot, frame): (usize, &mut TetFrame)| {
        *frame = TetFrame::in_order(&blocks.tet_corners(tets[slot], input.position), &order[slot]);
        let is_sound = frame.volume_m3 > 0.0 && frame.has_heights();
        (!is_sound).then_some(slot)
    };
    let unsound = frames.par_iter_mut().enumerate().with_min_len(GRAIN_FRAMES).filter_map(place);
    let Some(slot) = unsound.min() else { return Ok(()) };
    let (tet, volume_m3) = (tets[slot], frames[slot].volume_m3);
    Err(ContactError::CollapsedTet { tet, block: blocks.tet_block[tet.index()], volume_m3 })
}

/// The forces of all facets, and what hosts feel of them.
fn place_forces(
    forces: &mut Vec<FacetForce>,
    on_host: &mut Vec<OnTarget>,
    scene: &FacetScene,
    integrals: &Integrals,
    penalty_of_facet: &[f64],
    hulls: &Hulls,
) {
    let touching = integrals.touching();
    forces.resize(touching.len(), FacetForce::default());
    on_host.resize(touching.len(), OnTarget::default());
    let place = |((force, on_host), t): ((&mut FacetForce, &mut OnTarget), usize)| {
        let (hits, sums) = (integrals.hits_of(&touching[t]), integrals.sums_of(&touching[t]));
        *force = scene.force(&touching[t], hits, sums, penalty_of_facet[t]);
        if hulls.whole(touching[t].target).is_some() {
            *on_host = hits[0].on_target;
        }
    };
    if touching.len() > GRAIN_FACETS {
        let entries = forces.par_iter_mut().zip(on_host).zip(0..touching.len());
        entries.with_min_len(GRAIN_FACETS / 2).for_each(place);
    } else {
        forces.iter_mut().zip(on_host).zip(0..).for_each(place);
    }
}

/// Fills a list with one entry per facet, on all threads if it is long.
fn for_each_facet<T: Send>(entries: &mut [T], fill: impl Fn((usize, &mut T)) + Send + Sync) {
    if entries.len() > GRAIN_FACETS {
        entries.par_iter_mut().enumerate().with_min_len(GRAIN_FACETS / 2).for_each(fill);
    } else {
        entries.iter_mut().enumerate().for_each(fill);
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
        if let Some(joints) = self.joints.as_ref().filter(|joints| joints.hold_together() && !history.begun) {
            bonds::form(joints, (&self.candidates, &self.hulls), input, &mut history.bonds);
        }
        let Some((_, field)) = &self.field else { return Ok(ContactReport::default()) };
        let (candidates, integrals) = (&self.candidates, &self.integrals);
        let mut report = self.reporter.report(input, candidates, integrals, &self.frames, field)?;
        let blocks_of = |touch: &Touch| (touch.owner, touch.target);
        self.place_penalties(input);
        if let Some(joints) = self.joints.as_ref().filter(|_| !history.bonds.is_empty()) {
            let found = (&self.candidates, &self.integrals);
            report.bond_overload =
                bonds::break_overloaded(joints, found, &self.penalty_of_facet, input, history);
        }
        let rubs = self.needs_bodies() && !input.bodies.is_empty();
        let Self { by_block, faces, integrals, .. } = self;
        let sort = || {
            by_block.arrange(input.blocks.len(), integrals.touching().iter().map(blocks_of));
            if rubs {
                faces.arrange(integrals);
            }
        };
        let (forces, on_host) = (&mut self.forces, &mut self.on_host);
        let facets =
            FacetScene { input, candidates: &self.candidates, joints: self.joints.as_ref(), history };
        let place = || place_forces(forces, on_host, &facets, integrals, &self.penalty_of_facet, &self.hulls);
        both(integrals.touching().len() > GRAIN_FACETS, place, sort);
        if let Some(joints) = self.joints.as_ref().filter(|_| rubs) {
            let scene = PatchScene { input, integrals: &self.integrals, joints, hulls: &self.hulls };
            self.faces.add(&scene, &mut self.forces, history);
        }
        let scene = ScatterScene {
            blocks: input.blocks,
            position: rubs.then_some(input.position),
            integrals: &self.integrals,
            by_block: &self.by_block,
            hulls: &self.hulls,
            forces: &self.forces,
            on_host: &self.on_host,
            stiffness_pa: &self.penalty_of_facet,
            curvature_pa_m: &self.curvature_of_facet,
        };
        scatter::add(&scene, output);
        if let Some(joints) = self.joints.as_ref().filter(|_| !history.bonds.is_empty()) {
            bonds::add_forces(joints, input, &history.bonds, output);
        }
        if self.joints.is_some() {
            self.remember(input, history);
        }
        Ok(report)
    }

    fn has_acted(&self) -> bool {
        !self.forces.is_empty() || self.joints.as_ref().is_some_and(Joints::hold_together)
    }

    fn energy_j(&mut self, input: &ContactInput, _history: &ContactHistory) -> Result<f64, ContactError> {
        let law = self.potential.law();
        match law {
            OverlapLaw::Linear => self.find_pairs(input)?,
            // The law is of what touches.
            OverlapLaw::Power { .. } => self.integrate(input)?,
        }
        let Some((_, field)) = &self.field else { return Ok(0.0) };
        let parts = OverlapParts {
            candidates: &self.candidates,
            integrals: &self.integrals,
            frames: &self.frames,
            field,
            hulls: &self.hulls,
        };
        self.overlaps.integrate(input, &parts, law);
        Ok(self.penalty_pa * self.overlaps.energy_m3(law))
    }

    /// The turning and stretching of triangles under their own pressure is left out, and so is what friction owes to
    /// changes of pressure; where the law of the overlap is not linear, the rank-one part of its curvature, too.
    fn add_stiffness(
        &mut self,
        input: &ContactInput,
        history: &ContactHistory,
        stiffness: &mut Vec<PairStiffness>,
    ) -> Result<(), ContactError> {
        self.integrate(input)?;
        self.place_penalties(input);
        for t in 0..self.integrals.touching().len() {
            self.add_facet_stiffness(t, input, stiffness);
        }
        if let Some(joints) = &self.joints {
            bonds::add_stiffness(joints, input, &history.bonds, stiffness);
        }
        Ok(())
    }

    fn each_work(&mut self, blocks: &BlockSet, moved: &[Vec3], add: &mut dyn FnMut(BlockId, BlockId, f64)) {
        let (integrals, forces) = (&self.integrals, &self.forces);
        let touching = integrals.touching();
        let work_of = |(t, work_j): (usize, &mut f64)| {
            let touch = &touching[t];
            let found = (integrals.hits_of(touch), integrals.sums_of(touch));
            *work_j = forces[t].push.dot(&relative_motion(touch, found, (blocks, moved)));
        };
        self.work_of_facet.resize(touching.len(), 0.0);
        for_each_facet(&mut self.work_of_facet, work_of);
        for (touch, &work_j) in touching.iter().zip(&self.work_of_facet) {
            add(touch.owner, touch.target, work_j);
        }
    }

    fn each_coulomb_gap(
        &mut self,
        blocks: &BlockSet,
        moved: &[Vec3],
        add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
        if self.needs_bodies() {
            self.faces.each_coulomb_gap((blocks, &self.integrals, &self.forces), moved, add);
        }
    }

    fn each_spring_slip(&self, add: &mut dyn FnMut(BlockId, BlockId, &SpringSlip)) {
        if self.joints.is_none() {
            return;
        }
        for (touch, force) in self.integrals.touching().iter().zip(&self.forces) {
            if let Some(spring) = &force.spring {
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
        let Some((_, Field::Pieces(_))) = &self.field else { return None };
        BlockFaces::new(blocks, block).width_m(blocks, block)
    }

    fn closing_m_s(&self, input: &ContactInput, pair: (BlockId, BlockId)) -> Option<f64> {
        closing_m_s(&self.hulls, input, pair)
    }

    fn gathers(&self, block: BlockId) -> bool {
        self.hulls.whole(block).is_some()
    }

    fn plan(&self) -> Vec<Part> {
        plan::parts(self)
    }

    fn add_facets(&self, input: &ContactInput, history: &ContactHistory, facets: &mut Vec<FacetContact>) {
        for (touch, force) in self.integrals.touching().iter().zip(&self.forces) {
            if !force.touches {
                continue;
            }
            let sums = self.integrals.sums_of(touch);
            facets.push(FacetContact {
                facet: touch.triangle,
                target: touch.target,
                area_m2: sums.area,
                normal: -force.push.normalize(),
                center: force.center,
                push_n: sums.pressure * force.push,
                friction_n: sums.pressure * force.shear,
                sticks: force.sticks,
            });
        }
        if let Some(joints) = &self.joints {
            bonds::add_facets(joints, input, &history.bonds, facets);
        }
    }

    fn needs_bodies(&self) -> bool {
        self.joints.as_ref().is_some_and(Joints::act_on_faces)
    }

    fn has_friction(&self) -> bool {
        self.joints.is_some()
    }

    fn least_friction(&self) -> f64 {
        self.joints.as_ref().map_or(0.0, Joints::least_friction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coulomb::Coulomb;
    use crate::testing::{check_model, evaluate, test_box, test_set};
    use ndda_mesh::geometry::tet_heights;

    #[test]
    fn it_keeps_the_contract_of_a_contact_model_with_and_without_friction() {
        check_model(&mut PotentialContact::new(1e9));
        check_model(&mut PotentialContact::new(1e9).with_friction(Box::new(Coulomb::new(30.0, 1e9))));
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
            let input = ContactInput::new(&blocks, position, &velocity, 1.0);
            let mut model = PotentialContact::new(1e9);
            let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
            assert!(answer.force.iter().all(|f| *f == Vec3::zeros()), "{corner:?}");
            assert_eq!(model.energy_j(&input, &ContactHistory::default()), Ok(0.0));
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
        let input = ContactInput::new(&blocks, position, &velocity, 1.0);
        let answer = evaluate(&mut PotentialContact::new(1e9), &input, &mut ContactHistory::default());
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
        let mut model = PotentialContact::new(penalty).with_friction(Box::new(law));
        let mut history = ContactHistory::default();
        let slip_m = 1e-7;
        let mut input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, slip_m);
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
        assert!(model.has_acted());
        evaluate(&mut model, &input, &mut history);
        assert!(history.facets.is_empty() && !model.has_acted());
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
        let input = ContactInput::new(&blocks, position, &velocity, 1.0);
        let mut model = PotentialContact::new(1e9);
        let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
        assert!(answer.report.past_centroid.is_some());
        assert!(model.energy_j(&input, &ContactHistory::default()).expect("an energy") > 0.0);
    }

    /// An L of four cells, out of a box of 2 × 1 × 2 cells without the one at the top right.
    fn l_block() -> ndda_mesh::BlockMesh {
        let mut mesh = test_box([0.0; 3], [2.0, 1.0, 2.0], [2, 1, 2]);
        let nodes = mesh.nodes.clone();
        let cut_out = |tet: &[u32; 4]| {
            let middle = tet.iter().map(|&n| nodes[n as usize]).sum::<Vec3>() / 4.0;
            middle.x > 1.0 && middle.z > 1.0
        };
        mesh.tets.retain(|tet| !cut_out(tet));
        let used: Vec<u32> =
            (0..nodes.len() as u32).filter(|n| mesh.tets.iter().flatten().any(|m| m == n)).collect();
        let place = |n: u32| used.binary_search(&n).expect("a used node") as u32;
        mesh.tets.iter_mut().flatten().for_each(|n| *n = place(*n));
        mesh.nodes = used.iter().map(|&n| nodes[n as usize]).collect();
        mesh.node_sets.clear();
        mesh
    }

    #[test]
    fn a_concave_block_pushes_as_its_convex_parts_do_and_not_itself() {
        let third = || test_box([0.8, 0.1, 0.95], [1.5, 0.7, 0.9], [2, 1, 1]);
        let force_on_third = |meshes: Vec<ndda_mesh::BlockMesh>| -> Vec3 {
            let blocks = test_set(meshes);
            let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
            let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1.0);
            let answer = evaluate(&mut PotentialContact::new(1e9), &input, &mut ContactHistory::default());
            answer.force[blocks.nodes_of(BlockId(0))].iter().sum()
        };
        let part = |corner: [f64; 3], size, cells| test_box(corner, size, cells);
        let whole = force_on_third(vec![third(), l_block()]);
        let lower = force_on_third(vec![third(), part([0.0; 3], [2.0, 1.0, 1.0], [2, 1, 1])]);
        let upper = force_on_third(vec![third(), part([0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [1, 1, 1])]);
        assert!(whole.norm() > 0.0);
        assert!((whole - lower - upper).norm() < 1e-12 * 1e9, "{whole:?} instead of {:?}", lower + upper);

        let alone = test_set(vec![l_block(), test_box([10.0, 0.0, 0.0], [1.0; 3], [1, 1, 1])]);
        let velocity = vec![Vec3::zeros(); alone.rest_position.len()];
        let input = ContactInput::new(&alone, &alone.rest_position, &velocity, 1.0);
        let answer = evaluate(&mut PotentialContact::new(1e9), &input, &mut ContactHistory::default());
        assert!(answer.force.iter().all(|f| *f == Vec3::zeros()), "a concave block at rest pushes itself");
    }

    #[test]
    fn a_bond_holds_its_tension_and_breaks_for_good() {
        let (stiffness, tension) = (1e9, 1e3);
        let law = crate::MohrCoulomb::new(30.0, stiffness, 0.0, tension);
        let mut model = PotentialContact::new(1e9).with_friction(Box::new(law));
        let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [3, 3, 1]);
        let upper = test_box([1.0, 1.0, 1.0], [1.0, 1.0, 0.5], [1, 1, 1]);
        let blocks = test_set(vec![lower, upper]);
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let mut history = ContactHistory::default();
        let upper = blocks.nodes_of(BlockId(1));
        let mut lifted = |gap_m: f64, history: &mut ContactHistory| -> (Vec3, f64) {
            let mut position = blocks.rest_position.clone();
            position[upper.clone()].iter_mut().for_each(|x| x.z += gap_m);
            let input = ContactInput::new(&blocks, &position, &velocity, 1e-3);
            let answer = evaluate(&mut model, &input, history);
            // What a bond stores is work of friction: from rest, −½ f·u.
            let moved = position.iter().zip(&blocks.rest_position).map(|(x, rest)| x - rest);
            let stored: f64 = answer.friction_force.iter().zip(moved).map(|(f, u)| -0.5 * f.dot(&u)).sum();
            assert!(answer.force.iter().sum::<Vec3>().norm() < 1e-9);
            (answer.force[upper.clone()].iter().sum(), stored)
        };
        lifted(0.0, &mut history);
        assert!(!history.bonds.is_empty());
        // A square metre of glue, seen by the facets of both sides.
        let gap = 0.9 * tension / stiffness;
        let (force, energy) = lifted(gap, &mut history);
        assert!((force.z / (-stiffness * gap) - 1.0).abs() < 1e-6, "{force:?}");
        assert!((energy / (0.5 * stiffness * gap * gap) - 1.0).abs() < 1e-6, "{energy}");
        assert_eq!(lifted(1.1 * tension / stiffness, &mut history), (Vec3::zeros(), 0.0));
        assert_eq!(lifted(gap, &mut history), (Vec3::zeros(), 0.0));
    }

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
