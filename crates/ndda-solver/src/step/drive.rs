//! Forces and velocities that a caller gives blocks between two steps.

use ndda_fem::block_operator::RigidMotion;
use ndda_mesh::{BlockId, Vec3};

use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::step::Simulation;
use crate::step::state::State;

/// Why a block cannot be driven.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DriveError {
    /// There is no such block.
    #[error("there is no block {number}: the simulation has {blocks}, counted from 0")]
    NoSuchBlock {
        /// Number that was asked for.
        number: usize,
        /// Blocks of the simulation.
        blocks: usize,
    },
    /// The block does not move, or only as prescribed.
    #[error(
        "block {block} is Fixed, so that it only moves as prescribed: make it Rigid, Affine or Elastic to drive it"
    )]
    Fixed {
        /// Its name.
        block: String,
    },
    /// Nodes of the block have a velocity that its supports prescribe.
    #[error(
        "supports of block {block} prescribe velocities of its nodes: remove them to set its velocity, or set a force"
    )]
    Held {
        /// Its name.
        block: String,
    },
    /// A component is infinite or not a number.
    #[error("{what} of block {block} is not finite")]
    NotFinite {
        /// Force, velocity or spin.
        what: &'static str,
        /// Its name.
        block: String,
    },
}

impl Simulation {
    /// Applies a constant force [N] at the centre of mass of a block, from now on until another one is set; zero removes it.
    ///
    /// It acts on every node by its share of the mass, beside the loads of the scene. Its impulse and its work are in the balances of
    /// momentum and energy, and checkpoints keep it.
    ///
    /// # Errors
    /// [`DriveError`] when there is no such block, it is fixed, or the force is not finite; nothing has changed then.
    pub fn set_force(&mut self, block: BlockId, force_n: Vec3) -> Result<(), DriveError> {
        self.drivable(block, &[("the force", force_n)])?;
        if self.state.driving_force.is_empty() {
            self.state.driving_force = vec![Vec3::zeros(); self.problem.blocks.len()];
        }
        let before_n = std::mem::replace(&mut self.state.driving_force[block.index()], force_n);
        self.accelerate(block, force_n - before_n);
        self.place_driving_forces();
        Ok(())
    }

    /// Δa = ΔF/m at once, for integrators that remember accelerations: a force that jumps between two steps acts in full in the next one.
    fn accelerate(&mut self, block: BlockId, change_n: Vec3) {
        let change_m_s2 = change_n / self.shape(block).operator.mass_kg;
        let nodes = self.problem.blocks.nodes_of(block);
        self.audit.ledger.note_jump(change_n);
        let State { acceleration, inertia, .. } = &mut self.state;
        if let Some(inertia) = inertia.get_mut(block.index()) {
            inertia.force += change_n;
        }
        for a in acceleration.get_mut(nodes).into_iter().flatten() {
            *a += change_m_s2;
        }
    }

    /// Gives a block the velocity v + ω × (x − c) [m/s, rad/s] about its centre of mass c now, as a blow would; nothing holds it afterwards.
    ///
    /// The impulse m Δv, its moment, and the change of kinetic energy are in the balances of momentum and energy, as those of loads.
    /// Vibrations of a block that deforms are lost, as its nodes all get the velocity of a rigid motion.
    ///
    /// # Errors
    /// [`DriveError`] when there is no such block, it is fixed or held, or a component is not finite; nothing has changed then.
    pub fn set_velocity(
        &mut self,
        block: BlockId,
        velocity_m_s: Vec3,
        spin_rad_s: Vec3,
    ) -> Result<(), DriveError> {
        self.drivable(block, &[("the velocity", velocity_m_s), ("the spin", spin_rad_s)])?;
        let nodes = self.problem.blocks.nodes_of(block);
        let shape = &self.problem.shapes[self.bodies[block.index()].shape];
        if !shape.supports.held.is_empty() || !shape.supports.motions.is_empty() {
            return Err(DriveError::Held { block: self.problem.blocks.names[block.index()].clone() });
        }
        let offset = self.state.contact_offset_of(block);
        let State { position, velocity, .. } = &mut self.state;
        let (position, velocity) = (&position[nodes.clone()], &mut velocity[nodes]);
        let before = Motion::of(shape, position, velocity);
        let center = shape.operator.center(position);
        for (v, x) in velocity.iter_mut().zip(position) {
            *v = velocity_m_s + spin_rad_s.cross(&(x - center));
        }
        let after = Motion::of(shape, position, velocity);
        let impulse = after.momentum - before.momentum;
        let moment = after.angular_momentum - before.angular_momentum + offset.cross(&impulse);
        self.audit.ledger.add_whole_impulse(impulse, moment);
        self.audit.ledger.add_work(0.0, 0.0, after.kinetic_j - before.kinetic_j, 0.0);
        self.audit.ledger.blocks().lose_rebound(block);
        self.note_blow();
        Ok(())
    }

    /// Velocities have changed between steps: that is no force that the next step feels, too.
    pub(super) fn note_blow(&mut self) {
        self.state.contact.bodies.clear();
    }

    /// Changes velocities of a block between steps. Contact damping takes the forces of the last step for those of the next, and finds them from how much the block has become
    /// faster since: the motion that it remembers changes by as much.
    pub(super) fn keep_forces<T>(&mut self, block: BlockId, change: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.remembered_motion(block);
        let found = change(self);
        if let Some((before, after)) = before.zip(self.remembered_motion(block)) {
            let memory = &mut self.state.contact.bodies[block.index()];
            memory.velocity_m_s += after.velocity_m_s - before.velocity_m_s;
            memory.spin_rad_s += after.spin_rad_s - before.spin_rad_s;
        }
        found
    }

    /// Motion of a block, where contact damping remembers one.
    fn remembered_motion(&self, block: BlockId) -> Option<RigidMotion> {
        self.state.contact.bodies.get(block.index())?;
        let (nodes, State { position, velocity, .. }) = (self.problem.blocks.nodes_of(block), &self.state);
        Some(self.shape(block).operator.rigid_motion(&position[nodes.clone()], &velocity[nodes]))
    }

    fn drivable(&self, block: BlockId, vectors: &[(&'static str, Vec3)]) -> Result<(), DriveError> {
        let blocks = self.problem.blocks.len();
        if block.index() >= blocks {
            return Err(DriveError::NoSuchBlock { number: block.index(), blocks });
        }
        let name = || self.problem.blocks.names[block.index()].clone();
        if self.shape(block).kind == BodyKind::Fixed {
            return Err(DriveError::Fixed { block: name() });
        }
        match vectors.iter().find(|(_, vector)| !vector.iter().all(|v| v.is_finite())) {
            Some((what, _)) => Err(DriveError::NotFinite { what, block: name() }),
            None => Ok(()),
        }
    }

    /// Puts the driving forces of the state on the nodes.
    pub(super) fn place_driving_forces(&mut self) {
        if self.state.driving_force.is_empty() && !self.loads.is_driven() {
            return;
        }
        let mut nodal = vec![Vec3::zeros(); self.problem.blocks.rest_position.len()];
        for (block, force) in self.problem.blocks.ids().zip(&self.state.driving_force) {
            let operator = &self.shape(block).operator;
            let nodes = nodal[self.problem.blocks.nodes_of(block)].iter_mut();
            nodes.zip(&operator.node_mass).for_each(|(f, m)| *f = force * (m / operator.mass_kg));
        }
        self.loads.drive(nodal);
        self.place_loads_now();
    }
}

/// Momentum and energy of a block, which a blow changes.
struct Motion {
    momentum: Vec3,
    angular_momentum: Vec3,
    kinetic_j: f64,
}

impl Motion {
    fn of(shape: &Prototype, position: &[Vec3], velocity: &[Vec3]) -> Self {
        Self {
            momentum: shape.operator.momentum(velocity),
            angular_momentum: shape.operator.angular_momentum(&Vec3::zeros(), position, velocity),
            kinetic_j: shape.operator.kinetic_energy_j(velocity),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LocalDamping;
    use crate::step::adaptive_damping::AdaptiveDamping;
    use crate::step::test_boxes::{BoxSprings, boxes};

    /// A cube that rests on a fixed one by contact that keeps how they moved, as damping does, after some steps.
    fn damped() -> Simulation {
        let foot = (BodyKind::Fixed, [1.0; 3], [0.0; 3]);
        let top = (BodyKind::Rigid, [1.0; 3], [0.0, 0.0, 1.0]);
        let mut setup = boxes(&[foot, top]);
        setup.contact = Some(Box::new(BoxSprings { keeps_motions: true }));
        let mut simulation = Simulation::new(setup).unwrap();
        for _ in 0..3 {
            simulation.step().unwrap();
        }
        assert_eq!(simulation.state.contact.bodies.len(), 2);
        simulation
    }

    #[test]
    fn a_change_of_velocity_between_steps_is_no_force_for_the_damping_of_contact() {
        let changes: [&dyn Fn(&mut Simulation); 3] = [
            &|simulation| simulation.set_velocity(BlockId(1), Vec3::x(), Vec3::zeros()).unwrap(),
            &|simulation| simulation.push(&vec![Vec3::x(); simulation.state.velocity.len()]),
            &|simulation| simulation.begin_at_rest(simulation.state.velocity.clone()),
        ];
        for (k, change) in changes.into_iter().enumerate() {
            let mut simulation = damped();
            change(&mut simulation);
            assert!(simulation.state.contact.bodies.is_empty(), "change {k}");
        }
    }

    #[test]
    fn what_damping_on_the_way_to_rest_takes_of_a_velocity_it_takes_of_the_remembered_one() {
        let steps: [&dyn Fn(&mut Simulation); 2] = [
            &|simulation| {
                simulation.step_with_local_damping(&mut LocalDamping::new(0.5)).unwrap();
            },
            &|simulation| {
                simulation.step_with_adaptive_damping(&mut AdaptiveDamping::default()).unwrap();
            },
        ];
        for (k, step) in steps.into_iter().enumerate() {
            let (mut damped, mut undamped) = (damped(), damped());
            step(&mut damped);
            undamped.step().unwrap();
            let gone = |simulation: &Simulation| {
                simulation.state.velocity[8].z - simulation.state.contact.bodies[1].velocity_m_s.z
            };
            let (by_forces, without) = (gone(&damped), gone(&undamped));
            assert!(
                (by_forces - without).abs() < 1e-12 * without.abs(),
                "damping {k}: {by_forces} {without}"
            );
        }
    }
}
