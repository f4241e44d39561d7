//! The contact potential as a contact model.

use ndda_mesh::{BlockId, BlockSet, TriangleId};

use crate::assembly::overlap_parts::OverlapParts;
use crate::contact_model::ContactModel;
use crate::friction::bond;
use crate::friction::law::FrictionLaw;
use crate::friction::law_table::FrictionLawTable;
use crate::friction::openings::Moment;
use crate::model::{ContactError, ContactHistory, ContactInput, ContactOutput, ContactReport, FacetContact};
use crate::pair_stiffness::PairStiffness;

use crate::potential::contact_potential::OverlapLaw;

use super::PotentialContact;

impl ContactModel for PotentialContact {
    fn add_forces(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
        output: &mut ContactOutput,
    ) -> Result<ContactReport, ContactError> {
        history.expect_state(self.joints.as_ref().map_or(0, FrictionLawTable::state_len))?;
        self.place_openings(input, history, Moment::Next);
        if self.joints.as_ref().is_some_and(FrictionLawTable::hold_together) && !history.begun {
            self.form_bonds(input, history)?;
        }
        self.integrate(input)?;
        let Some((_, field)) = &self.field else { return Ok(ContactReport::default()) };
        let (candidates, integrals) = (&self.candidates, &self.integrals);
        let mut report = self.reporter.report(input, candidates, integrals, &self.frames, field)?;
        self.place_penalties(input)?;
        self.report_deepest(&mut report);
        self.load_bonds(input, history, &mut report);
        self.damp(input, history);
        self.place_facet_forces(input, history);
        self.remember_dashpots(input, history, &mut report);
        self.add_to_nodes(input, history, output, &mut report)?;
        bond::add_forces(input.blocks, &self.bond_forces, output);
        self.report_dilation(&mut report);
        if self.joints.is_some() {
            self.remember(input, history);
        }
        Ok(report)
    }

    fn has_acted(&self) -> bool {
        !self.forces.is_empty() || self.joints.as_ref().is_some_and(FrictionLawTable::hold_together)
    }

    /// Facets that are moved out by dilation have the energy of where they were clipped last.
    fn energy_j(&mut self, input: &ContactInput, history: &ContactHistory) -> Result<f64, ContactError> {
        self.place_openings(input, history, Moment::Last);
        let law = self.potential.law();
        match law {
            OverlapLaw::Linear if self.openings.is_empty() => self.find_pairs(input)?,
            OverlapLaw::Linear => self.integrate(input)?,
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
            openings: &self.openings,
        };
        self.overlaps.integrate(input, &parts, law)?;
        if !self.openings.is_empty() {
            self.overlaps.replace_opened(input, &parts, &self.openings);
        }
        Ok(self.penalty_pa * self.overlaps.energy_m3(law))
    }

    /// The turning and stretching of triangles under their own pressure is left out, and so is the dependence of friction on
    /// changes of pressure; where the law of the overlap is not linear, the rank-one part of its curvature, too.
    fn add_stiffness(
        &mut self,
        input: &ContactInput,
        history: &ContactHistory,
        stiffness: &mut Vec<PairStiffness>,
    ) -> Result<(), ContactError> {
        // Where forces were added last: that has made these the last ones.
        self.place_openings(input, history, Moment::Last);
        self.integrate(input)?;
        self.place_penalties(input)?;
        for t in 0..self.integrals.touching().len() {
            self.add_facet_stiffness(t, input, stiffness);
        }
        if let Some(joints) = &self.joints {
            bond::add_stiffness(joints, input, &history.bonds, stiffness);
        }
        Ok(())
    }

    fn leave_out(&mut self, absent: &[bool]) -> bool {
        self.candidates.leave_out(absent);
        true
    }

    fn friction_law(
        &self,
        blocks: &BlockSet,
        facet: TriangleId,
        target: BlockId,
    ) -> Option<&dyn FrictionLaw> {
        self.joints.as_ref()?.law(blocks, facet, target)
    }

    fn take_over(
        &mut self,
        input: &ContactInput,
        (before, carried): (&dyn ContactModel, &[FacetContact]),
        history: &mut ContactHistory,
    ) -> Result<(), ContactError> {
        self.change_laws(input.blocks, before, history);
        self.take_friction_of_faces(input, (before, carried), history);
        if history.begun { self.change_bonds(input, before, history) } else { Ok(()) }
    }

    fn uses_host_forces(&self, block: BlockId) -> bool {
        self.hulls.affine_target(block).is_some()
    }

    fn needs_bodies(&self) -> bool {
        self.rubs_faces() || self.damping.is_some()
    }

    fn has_friction(&self) -> bool {
        self.joints.is_some()
    }

    fn min_friction_coefficient(&self) -> f64 {
        self.joints.as_ref().map_or(0.0, FrictionLawTable::min_friction_coefficient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::coulomb::Coulomb;
    use crate::testing::{check_model, evaluate, test_box, test_set};
    use ndda_mesh::geometry::tet_heights;
    use ndda_mesh::{BlockId, Vec3};

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
}
