//! Optional information of a contact model on its last evaluation: for balances, the label, step control and output.

use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::model::{ContactHistory, ContactInput, FacetContact, SpringSlip};
use crate::plan::Part;

/// Information of a contact model beyond its forces. Nothing is required; a quantity that a model does not report is not judged.
pub trait ContactAudit {
    /// Work of the normal forces of the last [`add_forces`](crate::ContactModel::add_forces) over displacements of the nodes [m]: blocks and
    /// work [J], one call for each facet, always in the same order. A model that does not say is not judged pair by pair.
    fn each_work(
        &mut self,
        _blocks: &BlockSet,
        _moved: &[Vec3],
        _add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
    }

    /// Whether contacts are damped, so that the next reports anything.
    fn damps(&self) -> bool {
        false
    }

    /// Whether a contact has a restitution below 0.6.
    fn damps_strongly(&self) -> bool {
        false
    }

    /// Work of contact damping of the last [`add_forces`](crate::ContactModel::add_forces), at these positions, over displacements of the nodes [m]: blocks and work [J], one
    /// call for each facet that it acts on, always in the same order. It is no part of [`each_work`](Self::each_work).
    fn each_damping_work(
        &mut self,
        _blocks: &BlockSet,
        _position: &[Vec3],
        _moved: &[Vec3],
        _add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
    }

    /// How far friction of the last [`add_forces`](crate::ContactModel::add_forces) was from Coulomb's law over displacements of the nodes [m]: two blocks, and the
    /// energy [J] that Coulomb friction takes from such a slip less what this friction took, which is never negative. A model whose friction is not
    /// judged by it makes no call.
    fn each_coulomb_gap(
        &mut self,
        _blocks: &BlockSet,
        _moved: &[Vec3],
        _add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
    }

    /// Calls `add` for each shear spring of the last [`add_forces`](crate::ContactModel::add_forces), with the block of a facet, its target, and the slip of the first on
    /// the second, one call for each facet that has a spring, always in the same order.
    fn each_spring_slip(&self, _add: &mut dyn FnMut(BlockId, BlockId, &SpringSlip)) {}

    /// Normal forces of the last [`add_forces`](crate::ContactModel::add_forces) on facets of the first block, which the second one presses [N], one call for each facet,
    /// always in the same order. A model that does not say is not asked whether blocks vibrate between others.
    fn each_push(&self, _add: &mut dyn FnMut(BlockId, BlockId, &Vec3)) {}

    /// Energies of normal contact as [`energy_j`](crate::ContactModel::energy_j) found them in the call before: two blocks and their
    /// energy [J], at most one call for each pair.
    fn each_energy(&self, _add: &mut dyn FnMut(BlockId, BlockId, f64)) {}

    /// Width of a block as its contact resolves it [m]: what may pass through the block unnoticed has to approach it by more than
    /// that from one evaluation to the next. Asked for after the first evaluation; where a model does not say, the smallest height
    /// of the tetrahedra at the surface counts.
    fn width_m(&self, _blocks: &BlockSet, _block: BlockId) -> Option<f64> {
        None
    }

    /// Upper bound of the speed at which two blocks that do not touch at `input.position` close the gap between them within a step
    /// [m/s]; zero if it stays open. `None` where the model does not know, and any relative velocity counts.
    fn closing_m_s(&self, _input: &ContactInput, _pair: (BlockId, BlockId)) -> Option<f64> {
        None
    }

    /// The parts of the model, for `ndda explain`.
    fn plan(&self) -> Vec<Part> {
        Vec::new()
    }

    /// Adds what each facet does, as [`add_forces`](crate::ContactModel::add_forces) found it in the call before, with the same input.
    /// A model of other things than facets adds none.
    fn add_facets(&self, _input: &ContactInput, _history: &ContactHistory, _facets: &mut Vec<FacetContact>) {}
}
