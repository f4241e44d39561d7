//! History that goes on under other laws.

use ndda_mesh::BlockSet;

use crate::contact_model::ContactModel;
use crate::friction::bonds_of_facet::key;
use crate::friction::law_table::FrictionLawTable;
use crate::friction::openings::Moment;
use crate::friction::stretch::{Stretch, frame_of};
use crate::friction::{bond, bond_formation};
use crate::model::{Bond, ContactError, ContactHistory, ContactInput};

use super::PotentialContact;

impl PotentialContact {
    /// Moves the points that bonds hold to so that they carry what they did: k s does not change, where k does.
    pub(super) fn keep_forces(
        &self,
        input: &ContactInput,
        before: &dyn ContactModel,
        history: &mut ContactHistory,
    ) {
        let blocks = input.blocks;
        for bond in history.bonds.iter_mut().filter(|bond| bond.damage < 1.0) {
            let (Some(old), Some(new)) =
                (stiffness_of(bond, before, blocks), stiffness_of(bond, self, blocks))
            else {
                continue;
            };
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

    /// Forms bonds where blocks touch now that hold together under these laws, and did not under those of before.
    pub(super) fn bond_more(
        &mut self,
        input: &ContactInput,
        before: &dyn ContactModel,
        history: &mut ContactHistory,
    ) -> Result<(), ContactError> {
        if !self.joints.as_ref().is_some_and(FrictionLawTable::hold_together) {
            return Ok(());
        }
        self.find_pairs(input)?;
        let Some(joints) = &self.joints else { return Ok(()) };
        let (blocks, mut bonds) = (input.blocks, Vec::new());
        bond_formation::form(joints, (&self.candidates, &self.hulls), input, &mut bonds);
        bonds.retain(|bond| stiffness_of(bond, before, blocks).is_none());
        if !bonds.is_empty() {
            history.bonds.append(&mut bonds);
            history.bonds.sort_by_key(|bond| key(blocks, joints.memory, bond));
        }
        Ok(())
    }

    /// Breaks bonds that carry more than their strength, as those do whose strength has just been taken away: a shorter step would not help.
    pub(super) fn break_quietly(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
    ) -> Result<(), ContactError> {
        if history.bonds.is_empty() {
            return Ok(());
        }
        self.place_openings(input, history, Moment::Next);
        self.integrate(input)?;
        self.place_penalties(input)?;
        if let Some(joints) = &self.joints {
            let kept = (history, &mut self.new_state);
            bond::break_overloaded(joints, &self.integrals, &self.penalty_of_facet, input, kept);
        }
        Ok(())
    }
}

/// Stiffness of a bond under the laws of a model, across and along the normal [Pa/m]; none where they hold nothing together.
fn stiffness_of(bond: &Bond, model: &dyn ContactModel, blocks: &BlockSet) -> Option<[f64; 2]> {
    model.bond_stiffness_pa_m(blocks, bond.facet, blocks.tet_block[bond.tet.index()])
}
