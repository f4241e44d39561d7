//! The default model: the contact potential of the paper, integrated exactly over boundary triangles.

pub mod affine;
pub mod assembly;
mod audit;
pub mod broad_phase;
mod contact_model;
mod evaluation;
pub mod friction;
pub mod integration;
mod plan;
pub mod potential;
pub mod reference;

pub use {
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
};

use crate::affine::convex_target::ConvexBlocks;
use crate::assembly::adjacency::BlockContactIndex;
use crate::assembly::energy;
use crate::assembly::report::Reporter;
use crate::broad_phase::candidates::Candidates;
use crate::broad_phase::finder::BroadPhase;
use crate::friction::facet::FacetForce;
use crate::friction::patches::FrictionPatches;
use crate::integration::integrals::Integrals;
use crate::integration::pair_moments::OnTarget;
use crate::integration::tet_frame::TetFrame;
use crate::model::FacetMemory;

/// Normal forces −k_n n ∫ φ dA on boundary triangles, both ways, and friction on top of them.
///
/// One model serves one set of blocks: what it learns of their rest shape at the first evaluation it keeps.
pub struct PotentialContact {
    penalty_pa: f64,
    potential: Box<dyn ContactPotential>,
    joints: Option<FrictionLawTable>,
    /// φ of the blocks last seen, and how many tetrahedra they had.
    field: Option<(usize, PotentialField)>,
    candidates: Candidates,
    hulls: ConvexBlocks,
    integrals: Integrals,
    by_block: BlockContactIndex,
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
    new_state: Vec<f64>,
    /// What the laws keep of each touching facet.
    state_of_facet: Vec<f64>,
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
            hulls: ConvexBlocks::default(),
            integrals: Integrals::default(),
            by_block: BlockContactIndex::default(),
            frames: Vec::new(),
            forces: Vec::new(),
            on_host: Vec::new(),
            penalty_of_facet: Vec::new(),
            curvature_of_facet: Vec::new(),
            faces: FrictionPatches::default(),
            overlaps: Default::default(),
            reporter: Reporter::default(),
            new_facets: Vec::new(),
            new_state: Vec::new(),
            state_of_facet: Vec::new(),
            work_of_facet: Vec::new(),
        }
    }

    /// With another potential.
    pub fn with_potential(mut self, potential: Box<dyn ContactPotential>) -> Self {
        self.potential = potential;
        self
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

    /// With friction laws for pairs of materials and for named surfaces.
    pub fn with_law_table(mut self, joints: FrictionLawTable) -> Self {
        self.candidates.split_by_element = joints.memory == Memory::Element;
        self.joints = Some(joints);
        self
    }
}
