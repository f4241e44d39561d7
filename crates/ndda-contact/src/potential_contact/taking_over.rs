//! History that goes on under other laws.

use crate::contact_model::ContactModel;
use crate::friction::bonds_of_facet::key;
use crate::friction::law_table::FrictionLawTable;
use crate::friction::openings::Moment;
use crate::friction::{bond, bond_formation};
use crate::model::{ContactError, ContactHistory, ContactInput};

use super::PotentialContact;

impl PotentialContact {
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
        bonds.retain(|bond| !before.holds_together(blocks, bond.facet, blocks.tet_block[bond.tet.index()]));
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
