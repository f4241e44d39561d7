//! The seam between solver and contact.

use ndda_mesh::{BlockId, BlockSet, TriangleId};

use crate::audit::ContactAudit;
#[cfg(feature = "potential")]
use crate::friction::law::FrictionLaw;
use crate::model::{ContactError, ContactHistory, ContactInput, ContactOutput, ContactReport, FacetContact};
use crate::pair_stiffness::PairStiffness;

/// A law of contact between blocks. `&mut self` is scratch only; memory that matters is in [`ContactHistory`].
///
/// Forces and their energy are required. Optional queries of the solver and of reports are in [`ContactAudit`], whose empty implementation
/// reports nothing.
pub trait ContactModel: ContactAudit + Send + Sync {
    /// Adds the contact forces at `input.position` to `output` and advances `history` by one step.
    ///
    /// Forces sum to zero and exert no net torque.
    ///
    /// # Errors
    /// [`ContactError`] when a force cannot be computed; `output` is then not to be used.
    fn add_forces(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
        output: &mut ContactOutput,
    ) -> Result<ContactReport, ContactError>;

    /// Potential energy of contact at `input.position` [J]; what shear springs and bonds store is work of friction.
    ///
    /// # Errors
    /// As [`add_forces`](Self::add_forces).
    fn energy_j(&mut self, input: &ContactInput, history: &ContactHistory) -> Result<f64, ContactError>;

    /// ∂f/∂x where forces were added last, for steps that solve for contact: symmetric blocks of seven nodes, some of
    /// which may be in several. It need not be exact; the closer it is, the fewer iterations a step takes.
    ///
    /// # Errors
    /// [`ContactError::NoTangent`] unless a model has one, or as [`add_forces`](Self::add_forces).
    fn add_stiffness(
        &mut self,
        _input: &ContactInput,
        _history: &ContactHistory,
        _stiffness: &mut Vec<PairStiffness>,
    ) -> Result<(), ContactError> {
        Err(ContactError::NoTangent)
    }

    /// Leaves blocks out of contact from now on, those that are `true`, as if they were not there; `false` where the model cannot.
    fn leave_out(&mut self, _absent: &[bool]) -> bool {
        false
    }

    /// The law by which a facet rubs on a block, or holds to it; none where nothing rubs, or where the model has no such laws.
    #[cfg(feature = "potential")]
    fn friction_law(
        &self,
        _blocks: &BlockSet,
        _facet: TriangleId,
        _target: BlockId,
    ) -> Option<&dyn FrictionLaw> {
        None
    }

    /// Takes over the history of another model, whose laws were others; it comes with what [each facet does](ContactAudit::add_facets) under them. What a facet keeps and means the same under its law before and after goes on, the rest
    /// begins anew. What touches now and holds together under these laws alone does so from now on, and carries the shear that the springs of its facets did; what held
    /// together before alone leaves its shear to them. What holds together more stiffly or more softly than before carries what it did, and what carries more than its
    /// strength breaks.
    ///
    /// # Errors
    /// As [`add_forces`](Self::add_forces).
    fn take_over(
        &mut self,
        _input: &ContactInput,
        _before: (&dyn ContactModel, &[FacetContact]),
        _history: &mut ContactHistory,
    ) -> Result<(), ContactError> {
        Ok(())
    }

    /// Whether forces on a block go to a few of its nodes wherever they press, because it moves by an affine map.
    fn uses_host_forces(&self, _block: BlockId) -> bool {
        false
    }

    /// Whether the last [`add_forces`](Self::add_forces) may have added anything; `false` lets the solver leave out its bookkeeping.
    fn has_acted(&self) -> bool {
        true
    }

    /// Whether [`ContactInput::bodies`] is read; `false` lets the solver leave them out.
    fn needs_bodies(&self) -> bool {
        false
    }

    /// Whether `friction_force` is ever written; `false` lets the solver leave out its bookkeeping.
    fn has_friction(&self) -> bool {
        false
    }

    /// Smallest friction coefficient between any two blocks.
    fn min_friction_coefficient(&self) -> f64 {
        0.0
    }
}
