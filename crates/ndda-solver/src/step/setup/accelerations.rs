//! Accelerations at the start, for integrators that need them.

use ndda_mesh::{BlockId, Vec3};

use crate::bodies::kind::BodyKind;
use crate::error::SetupError;
use crate::integrators::time_integrator::{Inertia, StepWeights};
use crate::step::Simulation;

impl Simulation {
    /// M a = f − ∫Bᵀσ₀ at the start, contact being part of f.
    pub(super) fn place_accelerations(&mut self) -> Result<(), SetupError> {
        let force = self.force_at_start().map_err(Box::new)?;
        self.carry_contact_forces();
        for block in self.problem.blocks.ids() {
            let range = self.problem.blocks.nodes_of(block);
            let force = &force[range.clone()];
            let shape = self.shape(block);
            if shape.kind == BodyKind::Rigid {
                let total: Vec3 = force.iter().sum();
                let acceleration = total / shape.operator.mass_kg;
                let torque = force.iter().zip(&self.state.position[range.clone()]);
                let torque = torque.map(|(f, x)| x.cross(f)).sum();
                self.state.acceleration[range].fill(acceleration);
                self.place_inertia(block, force, total, torque);
            } else if !shape.unknowns.is_empty() {
                self.solve_acceleration(block, force)?;
                let (position, acceleration) =
                    (&self.state.position[range.clone()], &self.state.acceleration[range]);
                let operator = &self.shape(block).operator;
                let total = operator.momentum(acceleration);
                let torque = operator.angular_momentum(&Vec3::zeros(), position, acceleration);
                self.place_inertia(block, force, total, torque);
            } else {
                // It stays at rest: what holds it carries loads and contact.
                self.place_inertia(block, force, Vec3::zeros(), Vec3::zeros());
            }
        }
        Ok(())
    }

    /// M a of a block at the start from nodal forces, their sum and torque about the origin, supports included.
    fn place_inertia(&mut self, block: BlockId, force: &[Vec3], total: Vec3, torque: Vec3) {
        let nodes = self.problem.blocks.nodes_of(block);
        let position = &self.state.position[nodes.clone()];
        let loads = &self.loads.total()[nodes];
        let pressing = || force.iter().zip(loads).map(|(f, load)| f - load);
        let contact: Vec3 = pressing().sum();
        let shape = self.shape(block);
        let torque = if shape.is_free() {
            torque - shape.operator.center(position).cross(&total)
        } else {
            torque - position.iter().zip(pressing()).map(|(x, f)| x.cross(&f)).sum::<Vec3>()
        };
        let moments = self.contact_moments.as_ref();
        let carried = moments.map_or(Vec3::zeros(), |moments| moments.carried[block.index()]);
        self.state.inertia[block.index()] =
            Inertia { force: total, torque, contact, carried, lag: Vec3::zeros() };
    }

    /// a of the nodes of a block that deforms, at the start [m/s²].
    fn solve_acceleration(&mut self, block: BlockId, force: &[Vec3]) -> Result<(), SetupError> {
        let name = || self.problem.blocks.names[block.index()].clone();
        let mass_only = StepWeights { stiffness: 0.0, mass_per_s2: 1.0, ..self.weights };
        let body = &self.bodies[block.index()];
        let shape = &self.problem.shapes[body.shape];
        let mut load = force.to_vec();
        if let Some(initial) = body.kept().and_then(|kept| kept.initial_force.as_ref()) {
            load.iter_mut().zip(initial).for_each(|(l, f)| *l -= f);
        }
        let velocity = &self.state.velocity[self.problem.blocks.nodes_of(block)];
        for dashpot in &shape.supports.quiet.dashpots {
            load[dashpot.node as usize] -= dashpot.drag * velocity[dashpot.node as usize];
        }
        let matrix = shape.unknowns.matrix(&shape.operator, &shape.supports, &mass_only, 0.0);
        let factor = self
            .problem
            .solver
            .factor(&matrix)
            .map_err(|source| SetupError::Factor { block: name(), source })?;
        let mut rhs = vec![0.0; factor.unknowns()];
        shape.unknowns.gather(&load, &mut rhs);
        let solved = factor.solve_in_place(&mut rhs, &mut factor.new_scratch());
        solved.map_err(|source| SetupError::Solve { block: name(), source })?;
        shape.unknowns.scatter(&rhs, &mut self.state.acceleration[self.problem.blocks.nodes_of(block)]);
        Ok(())
    }
}
