//! The default model: the contact potential of the paper, integrated exactly over boundary triangles.

pub mod affine;
pub mod assembly;
mod audit;
mod batch;
pub mod broad_phase;
mod contact_model;
mod evaluation;
mod forces;
pub mod friction;
pub mod integration;
mod left_by_faces;
mod plan;
pub mod potential;
pub mod reference;
pub mod restitution;
mod taking_over;

pub use {
    batch::{BatchFacet, BatchFriction, BatchLaw},
    friction::barton_bandis::{BartonBandis, Roughness},
    friction::coulomb::Coulomb,
    friction::dilating::{Dilating, Dilation},
    friction::fracture::Fracture,
    friction::law::{FacetSlip, FrictionLaw, ShearMemory},
    friction::law_table::{FrictionLawTable, Memory},
    friction::mohr_coulomb::MohrCoulomb,
    friction::softening_bond::SofteningBond,
    friction::softening_coulomb::SofteningCoulomb,
    friction::velocity_coulomb::VelocityCoulomb,
    potential::closure::{ClosurePotential, HyperbolicClosure},
    potential::contact_potential::{ContactPotential, OverlapLaw, PotentialError, PotentialField},
    potential::element::ElementPotential,
    potential::function::{FunctionField, PotentialFunction},
    potential::piece_table::PieceTable,
    potential::smooth::SmoothPotential,
    potential::volume::VolumePotential,
    restitution::{Restitution, RestitutionTable},
};

use ndda_mesh::{BlockSet, Vec3};

use crate::affine::convex_target::ConvexBlocks;
use crate::assembly::adjacency::BlockContactIndex;
use crate::assembly::energy;
use crate::assembly::report::Reporter;
use crate::assembly::shared_forces::SharedForces;
use crate::broad_phase::candidates::Candidates;
use crate::broad_phase::finder::BroadPhase;
use crate::friction::bond::BondForce;
use crate::friction::facet::{FacetForce, FacetOutcome};
use crate::friction::openings::Openings;
use crate::friction::patches::FrictionPatches;
use crate::integration::frames::Frames;
use crate::integration::integrals::Integrals;
use crate::integration::pair_moments::OnTarget;
use crate::model::FacetMemory;
use crate::restitution::ContactDamping;

/// Normal forces −k_n n ∫ φ dA on boundary triangles, both ways, and friction on top of them.
///
/// One model serves one set of blocks: it keeps data of their rest shape from the first evaluation on.
///
/// Two cubes of 1 m, one of which has sunk 1 mm into the other:
///
/// ```
/// use ndda_contact::testing::{evaluate, test_box, test_set};
/// use ndda_contact::{ContactHistory, ContactInput, PotentialContact};
///
/// let lower = test_box([0.0, 0.0, 0.0], [1.0; 3], [1, 1, 1]);
/// let upper = test_box([0.0, 0.0, 0.999], [1.0; 3], [1, 1, 1]);
/// let blocks = test_set(vec![lower, upper]);
/// let velocity = vec![ndda_mesh::Vec3::zeros(); blocks.rest_position.len()];
/// let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1e-3);
/// let mut model = PotentialContact::new(1e9);
/// let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
/// let total: ndda_mesh::Vec3 = answer.force.iter().sum();
/// let on_upper: f64 = answer.force[blocks.nodes_of(ndda_mesh::BlockId(1))].iter().map(|f| f.z).sum();
/// assert!(total.norm() < 1e-6 * on_upper);
/// ```
pub struct PotentialContact {
    penalty_pa: f64,
    potential: Box<dyn ContactPotential>,
    joints: Option<FrictionLawTable>,
    damping: Option<Box<ContactDamping>>,
    /// φ of the blocks last seen, and how many tetrahedra they had.
    field: Option<(usize, PotentialField)>,
    /// How many tetrahedra the blocks had for which hulls and faces are in place.
    fitted_to: Option<usize>,
    candidates: Candidates,
    hulls: ConvexBlocks,
    integrals: Integrals,
    adjacency: BlockContactIndex,
    frames: Frames,
    forces: Vec<FacetForce>,
    /// One for each of them where laws act on facets.
    outcomes: Vec<FacetOutcome>,
    /// Forces of facets on host tetrahedra: a block need not look for the hits, which are far away in memory.
    on_host: Vec<OnTarget>,
    penalty_of_facet: Vec<f64>,
    /// k_n w″(U) ∫ φ dA of each facet's pair of blocks [Pa/m]; empty where the law is linear.
    curvature_of_facet: Vec<f64>,
    faces: FrictionPatches,
    overlaps: energy::BlockOverlaps,
    reporter: Reporter,
    new_facets: Vec<FacetMemory>,
    new_state: Vec<f64>,
    /// Forces of unbroken bonds.
    bond_forces: Vec<BondForce>,
    /// The friction laws' own numbers of each touching facet.
    state_of_facet: Vec<f64>,
    work_of_facet: Vec<f64>,
    /// By how much facets are moved out before they are clipped.
    openings: Openings,
    /// Forces on nodes but for friction that is searched for, where blocks answer to them [N].
    push_n: Vec<Vec3>,
    /// What ranks hand each other of the forces on nodes.
    shared_forces: SharedForces,
}

impl PotentialContact {
    /// The element potential with penalty k_n [Pa], without friction.
    pub fn new(penalty_pa: f64) -> Self {
        Self {
            penalty_pa,
            potential: Box::new(ElementPotential),
            joints: None,
            damping: None,
            field: None,
            fitted_to: None,
            candidates: Candidates::default(),
            hulls: ConvexBlocks::default(),
            integrals: Integrals::default(),
            adjacency: BlockContactIndex::default(),
            frames: Frames::default(),
            forces: Vec::new(),
            outcomes: Vec::new(),
            on_host: Vec::new(),
            penalty_of_facet: Vec::new(),
            curvature_of_facet: Vec::new(),
            faces: FrictionPatches::default(),
            overlaps: Default::default(),
            reporter: Reporter::default(),
            new_facets: Vec::new(),
            new_state: Vec::new(),
            bond_forces: Vec::new(),
            state_of_facet: Vec::new(),
            work_of_facet: Vec::new(),
            openings: Openings::default(),
            push_n: Vec::new(),
            shared_forces: SharedForces::default(),
        }
    }

    /// With another potential.
    pub fn with_potential(mut self, potential: Box<dyn ContactPotential>) -> Self {
        self.potential = potential;
        self
    }

    /// Finds φ of the blocks now rather than at the first step.
    ///
    /// # Errors
    /// [`PotentialError`] naming the block that the potential cannot serve.
    pub fn fit_potential(&mut self, blocks: &BlockSet) -> Result<(), PotentialError> {
        self.field = Some((blocks.tets.len(), self.potential.field(blocks)?));
        Ok(())
    }

    /// With another broad phase.
    pub fn with_broad_phase(mut self, broad_phase: Box<dyn BroadPhase>) -> Self {
        let split_by_element = self.candidates.split_by_element;
        self.candidates = Candidates::found_by(broad_phase);
        self.candidates.split_by_element = split_by_element;
        self
    }

    /// With one friction law between all blocks.
    pub fn with_friction(self, law: Box<dyn FrictionLaw>) -> Self {
        self.with_law_table(FrictionLawTable::everywhere(law))
    }

    /// With coefficients of restitution; a table that damps nothing is left out.
    pub fn with_restitution(mut self, table: RestitutionTable) -> Self {
        self.damping = table.damps().then(|| Box::new(ContactDamping::new(table)));
        self
    }

    /// With friction laws for pairs of materials and for named surfaces.
    pub fn with_law_table(mut self, joints: FrictionLawTable) -> Self {
        self.candidates.split_by_element = joints.memory == Memory::Element;
        self.joints = Some(joints);
        self
    }
}
