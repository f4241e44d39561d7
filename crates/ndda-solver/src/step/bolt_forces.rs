//! Forces of bolts in the step.

use std::mem::take;

use ndda_mesh::Vec3;

use crate::bodies::kind::BodyKind;
use crate::bolts::set::Bolts;
use crate::bolts::setup::BoltSetup;
use crate::error::SetupError;
use crate::step::Simulation;
use crate::step::first_step::seen;

impl Simulation {
    /// Finds the forces of bolts where contact is evaluated; what yields is remembered.
    pub(crate) fn find_bolt_forces(&mut self) {
        let Some(mut bolts) = self.bolts.take() else { return };
        let mut workspace = take(&mut self.scratch.seen_position);
        let position = seen(
            &self.problem.blocks,
            &self.state.contact_offset,
            &self.scratch.contact_position,
            &mut workspace,
        );
        let Bolts { list, sizes, rows, work, force, .. } = &mut *bolts;
        rows.iter().for_each(|(node, _)| force[*node as usize] = Vec3::zeros());
        work.pairs.clear();
        self.state.bolts.each(sizes, |k, memory| {
            if list[k].is_installed {
                list[k].act(position, memory, work, force);
            }
        });
        self.scratch.seen_position = workspace;
        self.bolts = Some(bolts);
    }

    /// force ← force + bolts, and their stiffness.
    pub(crate) fn add_bolt_forces(&mut self) {
        let Some(bolts) = &self.bolts else { return };
        if !std::mem::replace(&mut self.scratch.contact_has_acted, true) || self.contact.is_none() {
            self.scratch.friction_force.fill(Vec3::zeros());
            self.scratch.contact_stiffness.fill(0.0);
        }
        for (node, stiffness_n_m) in &bolts.rows {
            let node = *node as usize;
            self.scratch.force[node] += bolts.force[node];
            self.scratch.contact_stiffness[node] += stiffness_n_m;
        }
    }

    /// Evaluates contact and bolts in some way that changes neither what they remember nor the forces of the step.
    pub(super) fn without_memory<T>(&mut self, evaluate: impl FnOnce(&mut Self) -> T) -> T {
        let (contact, force) = (self.state.contact.clone(), self.scratch.force.clone());
        self.keep_bolts();
        let found = evaluate(self);
        (self.state.contact, self.scratch.force) = (contact, force);
        self.put_bolts_back();
        found
    }

    /// Keeps what bolts remember, before something is tried from which there is a way [back](Self::put_bolts_back).
    pub(crate) fn keep_bolts(&mut self) {
        if let Some(bolts) = &mut self.bolts {
            bolts.before.copy_from(&self.state.bolts);
        }
    }

    /// Goes back to what was [kept](Self::keep_bolts).
    pub(crate) fn put_bolts_back(&mut self) {
        if let Some(bolts) = &self.bolts {
            self.state.bolts.copy_from(&bolts.before);
        }
    }

    /// Energy stored in bolts where blocks are now, and what they have taken [J].
    pub(crate) fn bolt_energies_j(&mut self) -> (f64, f64) {
        let Some(mut bolts) = self.bolts.take() else { return (0.0, 0.0) };
        let mut workspace = take(&mut self.scratch.seen_position);
        let position =
            seen(&self.problem.blocks, &self.state.contact_offset, &self.state.position, &mut workspace);
        let mut stored_j = 0.0;
        let Bolts { list, sizes, work, .. } = &mut *bolts;
        self.state.bolts.each(sizes, |k, memory| {
            if list[k].is_installed {
                stored_j += list[k].potential_j(position, &memory, work);
            }
        });
        self.scratch.seen_position = workspace;
        self.bolts = Some(bolts);
        (stored_j, self.state.bolts.dissipated_j())
    }

    /// Installs the bolts that were not there before, where the rock is now.
    pub(crate) fn install_bolts(&mut self, before: &Self) {
        let Some(mut bolts) = self.bolts.take() else { return };
        let mut workspace = take(&mut self.scratch.seen_position);
        let position =
            seen(&self.problem.blocks, &self.state.contact_offset, &self.state.position, &mut workspace);
        let was_installed = |k: usize| before.bolts.as_ref().is_some_and(|bolts| bolts.list[k].is_installed);
        let Bolts { list, sizes, work, .. } = &mut *bolts;
        self.state.bolts.each(sizes, |k, memory| {
            if list[k].is_installed && !was_installed(k) {
                list[k].install(position, memory, work);
            }
        });
        self.scratch.seen_position = workspace;
        self.bolts = Some(bolts);
    }

    /// Whether there are bolts.
    pub(crate) fn has_bolts(&self) -> bool {
        self.bolts.is_some()
    }

    /// Sets bolts, if there are any.
    pub(crate) fn set_bolts(&mut self, setups: &[BoltSetup]) -> Result<(), SetupError> {
        if setups.is_empty() {
            return Ok(());
        }
        let kinds: Vec<BodyKind> = self.problem.blocks.ids().map(|block| self.shape(block).kind).collect();
        let (bolts, memory) = Bolts::new(setups, &self.problem.blocks, &kinds)?;
        self.state.bolts = memory;
        self.bolts = Some(Box::new(bolts));
        Ok(())
    }
}
