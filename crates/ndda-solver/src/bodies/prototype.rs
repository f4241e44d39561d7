//! Common data of blocks of one shape: operator, supports, factor. Everything here is computed once per run.

use crate::error::SetupError;
use std::sync::Arc;

use ndda_fem::frame::polar_rotation;
use ndda_fem::{
    BlockOperator, BlockSupports, Frame, Hold, InitialStress, Material, NodeSupport, PressureField, Quiet,
    QuietFaces, Table, mobility,
};
use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};

use crate::bodies::kind::BodyKind;
use crate::bodies::rigid_inertia::{RigidInertia, lumped, turn_per_n_m};
use crate::bodies::step_damping::StepDamping;
use crate::bodies::unknowns::Unknowns;
use crate::diagnostics::worst::BlockScale;
use crate::integrators::time_integrator::StepWeights;
use crate::linear::linear_solver::{Factor, FactorError, LinearSolver};

/// Shapes that agree to this fraction of their size share one factor; a false strain of this size is the price.
const CONGRUENT: f64 = 1e-12;

/// Data of one block besides its mesh.
#[derive(Clone)]
pub struct BodySetup {
    /// How it may move.
    pub kind: BodyKind,
    /// Its material; blocks that share the `Arc` can share a factor.
    pub material: Arc<dyn Material>,
    /// Its supports.
    pub supports: Vec<NodeSupport>,
    /// Initial stress σ₀.
    pub initial_stress: Option<InitialStress>,
    /// Tractions on its surface.
    pub tractions: Vec<TractionSetup>,
    /// Forces on its nodes.
    pub forces: Vec<ForceSetup>,
    /// Pressures of water on its surface, which follow it.
    pub pressures: Vec<PressureSetup>,
    /// Groups of nodes that move alike, counted from the block's first.
    pub ties: Vec<Vec<u32>>,
    /// Faces behind which rock goes on.
    pub quiet: Vec<QuietSetup>,
    /// Velocity of the mass centre [m/s].
    pub velocity_m_s: Vec3,
    /// Rate of rotation about the mass centre [rad/s].
    pub spin_rad_s: Vec3,
}

/// A traction on part of a block.
#[derive(Clone, Debug)]
pub struct TractionSetup {
    /// Triangles by nodes counted from the block's first.
    pub triangles: Vec<[u32; 3]>,
    /// Traction [Pa].
    pub traction_pa: Vec3,
    /// Factor over time; constant without.
    pub factor: Option<Table>,
}

/// Pressure on part of a block, along the inward normal of where its surface is now.
#[derive(Clone, Debug)]
pub struct PressureSetup {
    /// Triangles by nodes counted from the block's first, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The pressure in space, places relative to the origin of the block set.
    pub field: Arc<PressureField>,
    /// Factor over time; constant without.
    pub factor: Option<Table>,
}

/// Faces of a block behind which rock goes on for ever.
#[derive(Clone)]
pub struct QuietSetup {
    /// The faces, and waves that arrive through them; places relative to the origin of the block set.
    pub faces: QuietFaces,
    /// The rock beyond them.
    pub beyond: Arc<dyn Material>,
}

/// A force on a node of a block.
#[derive(Clone, Debug)]
pub struct ForceSetup {
    /// The node, counted from the block's first.
    pub node: u32,
    /// Force [N].
    pub force_n: Vec3,
    /// Factor over time; constant without.
    pub factor: Option<Table>,
}

/// How the mass of an element is shared among its nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mass {
    /// By its shape functions.
    #[default]
    Consistent,
    /// A quarter to each; rigid, affine and fixed blocks keep the consistent mass, which is exact for them.
    Lumped,
}

/// One distinct block: all blocks congruent to it, of the same material, use its operator and factor.
pub struct Prototype {
    /// How it may move.
    pub kind: BodyKind,
    /// K, M and rest shape.
    pub operator: BlockOperator,
    /// Supports and frame.
    pub supports: BlockSupports,
    /// Numbering of what is solved for.
    pub unknowns: Unknowns,
    /// K̃ factored; `None` when nothing is left to solve for.
    pub factor: Option<Box<dyn Factor>>,
    /// Material of its elements.
    pub material: Arc<dyn Material>,
    /// Its damping.
    pub damping: StepDamping,
    /// M + k K factored, which filters velocities; `None` without damping in proportion to stiffness.
    pub filter: Option<Box<dyn Factor>>,
    /// Inertia in the rest frame, for rigid blocks.
    pub rigid: Option<RigidInertia>,
    /// Smallest height of its elements at rest [m].
    pub smallest_height_m: f64,
    /// r J⁻¹ at rest: the acceleration of the farthest node, at r from the mass centre, by a torque about that [m/s² per N m].
    pub turn_per_n_m: Mat3,
    /// Of a block that moves as a whole, the mobility of its nodes [1/kg]; empty for others.
    pub mobility: Vec<f64>,
    /// Trace of K [N/m].
    pub stiffness_n_m: f64,
    /// Largest part by which its inertia of rotation is too large about any axis, for lumped masses; zero for consistent ones.
    pub inertia_error: f64,
}

impl Prototype {
    /// Assembles and factors one block.
    ///
    /// # Errors
    /// [`SetupError`] with the name of the block.
    pub(crate) fn new(
        blocks: &BlockSet,
        block: BlockId,
        setup: &BodySetup,
        mass: Mass,
        (dt_s, weights): (f64, &StepWeights),
        solver: &dyn LinearSolver,
    ) -> Result<Self, SetupError> {
        let damping = StepDamping::new(&setup.material.damping(), dt_s, weights);
        let name = || blocks.names[block.index()].clone();
        let position = &blocks.rest_position[blocks.nodes_of(block)];
        let tets: Vec<[u32; 4]> = blocks.local_tets(block).collect();
        check_kind(setup).map_err(|reason| SetupError::Kind { block: name(), reason })?;
        let kind = setup.kind;
        let operator = match kind {
            BodyKind::Elastic | BodyKind::Affine => {
                BlockOperator::new(position, tets, setup.material.as_ref())
            }
            BodyKind::Rigid | BodyKind::Fixed => {
                BlockOperator::rigid(position, tets, setup.material.density_kg_m3())
            }
        };
        let (operator, inertia_error) = match (mass, kind) {
            (Mass::Lumped, BodyKind::Elastic) => lumped(operator),
            _ => (operator, 0.0),
        };
        let mut supports = BlockSupports::new(&operator, &setup.supports, &setup.ties)
            .map_err(|source| SetupError::Support { block: name(), source })?;
        let quiet: Vec<_> = setup.quiet.iter().map(|quiet| (&quiet.faces, quiet.beyond.as_ref())).collect();
        supports.quiet = Quiet::new(position, &quiet)
            .map_err(|source| SetupError::Wave { block: name(), source: Box::new(source) })?;
        let unknowns = match kind {
            BodyKind::Elastic => Unknowns::nodal(operator.nodes(), &supports),
            BodyKind::Affine => Unknowns::affine(&operator, &supports),
            BodyKind::Rigid | BodyKind::Fixed => Unknowns::none(),
        };
        let rigid = (kind == BodyKind::Rigid).then(|| RigidInertia::new(&operator));
        let heights = operator
            .tets
            .iter()
            .flat_map(|tet| ndda_mesh::geometry::tet_heights(&tet.map(|n| operator.rest[n as usize])));
        let turn_per_n_m = turn_per_n_m(&operator);
        let mobility = match kind {
            BodyKind::Rigid | BodyKind::Affine => mobility(position, &operator.tets, operator.mass_kg),
            BodyKind::Elastic | BodyKind::Fixed => Vec::new(),
        };
        let smallest_height_m = heights.fold(f64::INFINITY, f64::min);
        let diagonal = |i: usize| operator.row(i).filter(move |(j, ..)| *j == i).map(|(_, k, _)| k.trace());
        let stiffness_n_m = match kind {
            BodyKind::Elastic | BodyKind::Affine => (0..operator.nodes()).flat_map(diagonal).sum(),
            BodyKind::Rigid | BodyKind::Fixed => 0.0,
        };
        let material = setup.material.clone();
        let mut shape = Self {
            kind,
            operator,
            supports,
            unknowns,
            factor: None,
            material,
            damping,
            filter: None,
            rigid,
            smallest_height_m,
            turn_per_n_m,
            mobility,
            stiffness_n_m,
            inertia_error,
        };
        shape.refactor(weights, solver).map_err(|source| SetupError::Factor { block: name(), source })?;
        Ok(shape)
    }

    /// Takes the factors of a step with these weights, and of its filter, in the place of those in use.
    ///
    /// # Errors
    /// [`FactorError`] when a matrix is not positive definite or too large.
    pub(crate) fn refactor(
        &mut self,
        weights: &StepWeights,
        solver: &dyn LinearSolver,
    ) -> Result<(), FactorError> {
        (self.factor, self.filter) = (None, None);
        self.factor = self.factored(weights, solver)?;
        self.filter = self.factored_filter(weights, solver)?;
        Ok(())
    }

    /// K̃ of a step with these weights, factored; nothing when nothing is to be solved for.
    fn factored(
        &self,
        weights: &StepWeights,
        solver: &dyn LinearSolver,
    ) -> Result<Option<Box<dyn Factor>>, FactorError> {
        if self.unknowns.is_empty() {
            return Ok(None);
        }
        let (weights, damping) = (self.weights(weights), self.damping.stiffness);
        solver.factor(&self.unknowns.matrix(&self.operator, &self.supports, &weights, damping)).map(Some)
    }

    /// M + k K factored; nothing without damping in proportion to stiffness, or when nothing is to be solved for.
    fn factored_filter(
        &self,
        weights: &StepWeights,
        solver: &dyn LinearSolver,
    ) -> Result<Option<Box<dyn Factor>>, FactorError> {
        if self.unknowns.is_empty() || self.damping.stiffness == 0.0 {
            return Ok(None);
        }
        let mass = StepWeights { stiffness: 0.0, mass_per_s2: 1.0, ..*weights };
        let filter = self.damping.filter_s2;
        solver.factor(&self.unknowns.matrix(&self.operator, &self.supports, &mass, filter)).map(Some)
    }

    /// Weights of the integrator for this block: damping in proportion to mass changes them.
    pub(crate) fn weights(&self, weights: &StepWeights) -> StepWeights {
        self.damping.weights(weights)
    }

    /// The motion of a block that is held as a whole: the last counts.
    pub(crate) fn motion_as_a_whole(&self) -> Option<usize> {
        self.supports.motions.len().checked_sub(1)
    }

    /// How far a block that is held as a whole is displaced at time t [m].
    pub(crate) fn displacement_as_a_whole(&self, time_s: f64) -> Vec3 {
        self.supports.motions.last().map_or_else(Vec3::zeros, |motion| motion.displacement(time_s))
    }

    /// Whether it deforms.
    pub(crate) fn deforms(&self) -> bool {
        matches!(self.kind, BodyKind::Elastic | BodyKind::Affine)
    }

    /// Whether nothing holds the block, so that its momentum changes by outside forces only.
    pub fn is_free(&self) -> bool {
        self.kind != BodyKind::Fixed
            && self.supports.held.is_empty()
            && self.supports.springs.is_empty()
            && self.supports.quiet.dashpots.is_empty()
            && self.supports.ties.is_empty()
    }

    /// Whether velocities of the block change by impulses beside the forces: those of damping, and of prescribed velocities.
    pub(crate) fn has_impulses(&self) -> bool {
        self.kind != BodyKind::Fixed && !(self.damping.is_none() && self.supports.motions.is_empty())
    }

    /// Scales of the block for its diagnostics.
    pub(crate) fn scale(&self) -> BlockScale {
        BlockScale {
            mass_kg: self.operator.mass_kg,
            is_held: !self.is_free(),
            deforms: self.deforms(),
            radius_m: self.operator.rest.iter().map(|x| x.norm()).fold(0.0, f64::max),
            height_m: self.smallest_height_m,
        }
    }

    /// Part by which rates of rotation may be wrong because masses are lumped; zero for a block that supports keep from turning.
    pub(crate) fn rotation_error(&self) -> f64 {
        if self.supports.frame == Frame::Held { 0.0 } else { self.inertia_error }
    }

    /// Takes out of nodal velocities what supports do not let through; R is the rotation of the block's frame.
    pub(crate) fn stop_held(&self, rotation: &Mat3, velocity: &mut [Vec3]) {
        if self.kind == BodyKind::Affine && !self.is_free() {
            velocity.iter_mut().for_each(|v| *v = rotation.tr_mul(v));
            self.unknowns.restrict(&self.operator.node_mass, velocity);
            velocity.iter_mut().for_each(|v| *v = rotation * *v);
            return;
        }
        for held in &self.supports.held {
            let v = &mut velocity[held.node as usize];
            held.held.iter().for_each(|n| *v -= n * n.dot(v));
        }
        for group in &self.supports.ties {
            let masses = group.iter().map(|&n| (self.operator.node_mass[n as usize], velocity[n as usize]));
            let (mass, momentum) =
                masses.fold((0.0, Vec3::zeros()), |sum, (m, v)| (sum.0 + m, sum.1 + m * v));
            group.iter().for_each(|&n| velocity[n as usize] = momentum / mass);
        }
    }

    /// Inverse of the inertia of a rigid block at these positions [1/(kg m²)]; lumped masses would make that of a coarse mesh several times too large.
    pub(crate) fn rigid_inverse_inertia(
        &self,
        position: &[Vec3],
        motion: &ndda_fem::block_operator::RigidMotion,
    ) -> Option<Mat3> {
        let rotation = self.supports.frame.rotation(&self.operator, position, &motion.center).ok()?;
        Some(self.rigid.as_ref()?.inverse_turned(&rotation))
    }

    /// The block's inertia for contact. Supports that leave no rigid motion make it immovable.
    pub(crate) fn contact_body(&self) -> ndda_contact::Body {
        let immovable = self.kind == BodyKind::Fixed || self.supports.hold_all_rigid_motions(&self.operator);
        let mass_kg = if immovable { f64::INFINITY } else { self.operator.mass_kg };
        ndda_contact::Body { deforms: self.deforms(), ..ndda_contact::Body::at_rest(mass_kg) }
    }

    /// Whether a block is this shape up to a rigid motion, with the same mesh and material.
    pub(crate) fn fits(&self, blocks: &BlockSet, block: BlockId, setup: &BodySetup) -> bool {
        let position = &blocks.rest_position[blocks.nodes_of(block)];
        if !self.is_free()
            || self.kind != setup.kind
            || !setup.supports.is_empty()
            || !setup.quiet.is_empty()
            || !setup.ties.is_empty()
            || !Arc::ptr_eq(&self.material, &setup.material)
            || position.len() != self.operator.nodes()
            || !blocks.local_tets(block).eq(self.operator.tets.iter().copied())
        {
            return false;
        }
        let Frame::Free { inverse_moment } = &self.supports.frame else { return false };
        let center = self.operator.center(position);
        let weighted = self.operator.node_mass.iter().zip(position).zip(&self.operator.rest);
        let moment = weighted.map(|((&m, x), rest)| m * (x - center) * rest.transpose()).sum::<Mat3>();
        let Ok(rotation) = polar_rotation(&(moment * inverse_moment)) else { return false };
        if !self.material.is_isotropic() && (rotation - Mat3::identity()).amax() > CONGRUENT {
            return false;
        }
        let size = self.operator.rest.iter().map(|x| x.norm()).fold(0.0, f64::max);
        let misfit = |(x, rest): (&Vec3, &Vec3)| (x - center - rotation * rest).norm();
        position.iter().zip(&self.operator.rest).map(misfit).fold(0.0, f64::max) <= CONGRUENT * size
    }
}

/// Whether a body of its kind can have the supports that are requested.
fn check_kind(setup: &BodySetup) -> Result<(), &'static str> {
    let moves = |s: &NodeSupport| matches!(s.hold, Hold::Motion(_)) && s.spring_n_m.is_none();
    match setup.kind {
        BodyKind::Elastic => Ok(()),
        _ if !setup.ties.is_empty() => Err("only nodes of an Elastic block can be tied: make it Elastic"),
        _ if !setup.quiet.is_empty() => {
            Err("only an Elastic block carries waves that a quiet face can let out: make it Elastic")
        }
        BodyKind::Affine if setup.supports.iter().any(moves) => Err(
            "the motion of parts of an affine block cannot be prescribed: make it Elastic, or Fixed to prescribe its motion as a whole",
        ),
        BodyKind::Affine => Ok(()),
        BodyKind::Rigid if setup.supports.iter().any(moves) => {
            Err("a rigid block moves by the forces on it: make it Fixed to prescribe its motion")
        }
        BodyKind::Rigid if !setup.supports.is_empty() => {
            Err("a rigid block cannot be held in parts: make it Fixed, Affine or Elastic")
        }
        BodyKind::Rigid => Ok(()),
        BodyKind::Fixed if setup.supports.len() > 1 || !setup.supports.iter().all(moves) => Err(
            "a fixed block is held already: leave out its supports, except one that prescribes its motion",
        ),
        BodyKind::Fixed => Ok(()),
    }
}
