//! History that goes on under other laws.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockSet, Vec3};

use crate::contact_model::ContactModel;
use crate::friction::bonds_of_facet::{self, key};
use crate::friction::law::{FrictionLaw, facet_basis};
use crate::friction::law_table::FrictionLawTable;
use crate::friction::openings::Moment;
use crate::friction::stretch::{Stretch, frame_of};
use crate::friction::{bond, bond_formation, bond_overload};
use crate::model::{Bond, ContactError, ContactHistory, ContactInput};

use super::PotentialContact;

impl PotentialContact {
    /// Keeps of facets' numbers what means the same under their laws of now.
    pub(super) fn change_laws(
        &self,
        blocks: &BlockSet,
        before: &dyn ContactModel,
        history: &mut ContactHistory,
    ) {
        let len = self.joints.as_ref().map_or(0, FrictionLawTable::state_len);
        history.change_laws(len, |memory| {
            let (facet, target) = (memory.facet, memory.target);
            [before.friction_law(blocks, facet, target), self.friction_law(blocks, facet, target)]
        });
    }

    /// Makes bonds and the springs of facets those of the laws of now; forces change only where they exceed what these laws bear.
    pub(super) fn change_bonds(
        &mut self,
        input: &ContactInput,
        before: &dyn ContactModel,
        history: &mut ContactHistory,
    ) -> Result<(), ContactError> {
        let holds = self.joints.as_ref().is_some_and(FrictionLawTable::hold_together);
        if history.bonds.is_empty() && !holds {
            return Ok(());
        }
        self.place_openings(input, history, Moment::Next);
        self.integrate(input)?;
        self.place_penalties(input)?;
        self.keep_forces(input, before, history);
        self.leave_to_springs(input, before, history);
        self.bond_more(input, before, history);
        self.break_quietly(input, history);
        Ok(())
    }

    /// Moves the points that bonds hold to so that they carry what they did: k s does not change, where k does.
    fn keep_forces(&self, input: &ContactInput, before: &dyn ContactModel, history: &mut ContactHistory) {
        let blocks = input.blocks;
        for bond in history.bonds.iter_mut().filter(|bond| bond.damage < 1.0) {
            let (Some(old), Some(new)) = (holding(bond, before, blocks), holding(bond, self, blocks)) else {
                continue;
            };
            let stiffness = |law: &dyn FrictionLaw| [law.shear_stiffness_pa_m(), law.bond_stiffness_pa_m()];
            let (old, new) = (stiffness(old), stiffness(new));
            if old == new {
                continue;
            }
            let mut stretch = Stretch::of(input, bond);
            stretch.offset_m *= old[0] / new[0];
            if stretch.opening_m > 0.0 {
                stretch.opening_m *= old[1] / new[1];
            }
            bond.lambda = frame_of(bond.tet, input).lambda_at(&stretch.anchor());
        }
    }

    /// Takes bonds away that nothing holds together any more, and leaves their shear to the springs of their facets, where these have some.
    fn leave_to_springs(
        &self,
        input: &ContactInput,
        before: &dyn ContactModel,
        history: &mut ContactHistory,
    ) {
        let Some(joints) = &self.joints else { return history.bonds.clear() };
        let (mut bonds, blocks) = (std::mem::take(&mut history.bonds), input.blocks);
        for bond in bonds.iter_mut().filter(|bond| holding(bond, self, blocks).is_none()) {
            let is_whole = bond.damage < 1.0;
            let (stretch, wanted) = (Stretch::of(input, bond), key(blocks, joints.memory, bond));
            bond.damage = 1.0;
            let rubs = law_of(bond, self, blocks).filter(|law| !law.acts_on_faces());
            if let (true, Some(law), Some(_)) = (is_whole, rubs, self.integrals.place_of(&wanted)) {
                let shear = stretch.shear_n(holding(bond, before, blocks).unwrap_or(law));
                bond::hand_over(
                    wanted,
                    (&stretch, &shear),
                    (law, bond.slip_m, !law.survives_slip()),
                    input,
                    history,
                );
            }
        }
        bonds_of_facet::forget_opened(&mut bonds, blocks, joints.memory);
        history.bonds = bonds;
    }

    /// Forms bonds where blocks touch now that hold together under these laws, and did not under those of before.
    fn bond_more(&self, input: &ContactInput, before: &dyn ContactModel, history: &mut ContactHistory) {
        let Some(joints) = self.joints.as_ref().filter(|joints| joints.hold_together()) else { return };
        let (blocks, mut bonds) = (input.blocks, Vec::new());
        bond_formation::form(joints, (&self.candidates, &self.hulls), input, &mut bonds);
        bonds.retain(|bond| holding(bond, before, blocks).is_none());
        bonds.sort_by_key(|bond| key(blocks, joints.memory, bond));
        let is_of_one = |a: &Bond, b: &Bond| key(blocks, joints.memory, a) == key(blocks, joints.memory, b);
        for own in bonds.chunk_by_mut(is_of_one) {
            self.take_shear(joints, own, input, history);
        }
        history.bonds.append(&mut bonds);
        history.bonds.sort_by_key(|bond| key(blocks, joints.memory, bond));
    }

    /// Gives the shear that the spring of a facet carries to the new bonds of the facet, each the part that it bears of the pressure.
    fn take_shear(
        &self,
        joints: &FrictionLawTable,
        own: &mut [Bond],
        input: &ContactInput,
        history: &mut ContactHistory,
    ) {
        let (blocks, wanted) = (input.blocks, key(input.blocks, joints.memory, &own[0]));
        let (Ok(place), Some(law)) = (history.find(&wanted), law_of(&own[0], self, blocks)) else { return };
        let memory = &mut history.facets[place];
        memory.broken = false;
        let (Some(t), true) = (self.integrals.place_of(&wanted), law.shear_stiffness_pa_m() > 0.0) else {
            return;
        };
        let corners = blocks.triangle_corners(wanted.0, input.position);
        let basis = facet_basis(&corners, &triangle_area_vector(&corners).normalize());
        let shear: Vec3 = basis[0] * memory.shear_n[0] + basis[1] * memory.shear_n[1];
        memory.shear_n = [0.0; 2];
        let weights = self.integrals.sums_of(&self.integrals.touching()[t]).weights;
        let facet = (blocks, joints.memory, wanted);
        let bears: Vec<f64> =
            (0..own.len()).map(|place| bonds_of_facet::borne(own, place, facet, &weights)).collect();
        let all: f64 = bears.iter().sum();
        for (bond, part) in own.iter_mut().zip(bears) {
            let part = if all > 0.0 { part / all } else { bond.part };
            let mut stretch = Stretch::of(input, bond);
            stretch.offset_m = part / (law.shear_stiffness_pa_m() * stretch.half_area) * shear;
            bond.lambda = frame_of(bond.tet, input).lambda_at(&stretch.anchor());
        }
    }

    /// Breaks bonds that carry more than their strength, as those do whose strength has just been taken away: a shorter step would not help.
    fn break_quietly(&mut self, input: &ContactInput, history: &mut ContactHistory) {
        if history.bonds.is_empty() {
            return;
        }
        self.damage_quietly(input, history);
        if let Some(joints) = &self.joints {
            let kept = (history, &mut self.new_state);
            bond::break_overloaded(joints, &self.integrals, &self.penalty_of_facet, input, kept);
        }
    }

    /// Damages bonds that break gradually by what they carry, and leaves to the friction of their facets what they carry no longer.
    fn damage_quietly(&self, input: &ContactInput, history: &mut ContactHistory) {
        let Some(joints) = &self.joints else { return };
        let (mut bonds, blocks) = (std::mem::take(&mut history.bonds), input.blocks);
        for bond in bonds.iter_mut().filter(|bond| bond.damage < 1.0) {
            let Some(law) = law_of(bond, self, blocks) else { continue };
            let (Some(fracture), before) = (law.fracture(), Stretch::of(input, bond)) else { continue };
            bond_overload::damage(bond, fracture, input);
            let left = before.shear_n(law) - Stretch::of(input, bond).shear_n(law);
            let wanted = key(blocks, joints.memory, bond);
            if left != Vec3::zeros() && self.integrals.place_of(&wanted).is_some() {
                bond::hand_over(wanted, (&before, &left), (law, 0.0, !law.survives_slip()), input, history);
            }
        }
        bonds_of_facet::forget_opened(&mut bonds, blocks, joints.memory);
        history.bonds = bonds;
    }
}

/// Law of the joint that a bond is in, under the laws of a model.
fn law_of<'a>(bond: &Bond, model: &'a dyn ContactModel, blocks: &BlockSet) -> Option<&'a dyn FrictionLaw> {
    model.friction_law(blocks, bond.facet, blocks.tet_block[bond.tet.index()])
}

/// Law of the joint that a bond is in, if it holds together what touches.
fn holding<'a>(bond: &Bond, model: &'a dyn ContactModel, blocks: &BlockSet) -> Option<&'a dyn FrictionLaw> {
    law_of(bond, model, blocks).filter(|law| law.holds_together())
}
