//! Queries of a simulation.

use crate::step::report::StageTimes;

use ndda_fem::Table;
use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::diagnostics::energies::Sample;
use crate::diagnostics::invariants::Invariants;
use crate::step::Simulation;
use crate::step::state::State;

impl Simulation {
    /// Where each node was when time began [m].
    pub fn start_position(&self) -> &[Vec3] {
        if self.state.start.is_empty() { &self.problem.blocks.rest_position } else { &self.state.start }
    }

    /// Whether time began at rest, where blocks had settled.
    pub fn began_at_rest(&self) -> bool {
        self.start_position() != self.problem.blocks.rest_position
    }

    /// Angular momentum of a sample about the origin of the scene's coordinates [kg m²/s].
    pub fn angular_momentum_of_scene(&self, sample: &Sample) -> Vec3 {
        sample.angular_momentum + self.problem.blocks.origin_m.cross(&sample.momentum)
    }

    /// Topology and rest shape.
    pub fn blocks(&self) -> &BlockSet {
        &self.problem.blocks
    }

    /// Gives back the blocks of a simulation that is not needed any more.
    pub fn into_blocks(self) -> BlockSet {
        self.problem.blocks
    }

    /// The changing state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Force of the supports on a block in the last step [N]; that of what holds it, for a fixed block.
    pub fn reaction_n(&self, block: BlockId) -> Vec3 {
        self.bodies[block.index()].report.reaction
    }

    /// The shape of a block: operator, supports, factor.
    pub fn shape(&self, block: BlockId) -> &Prototype {
        &self.problem.shapes[self.bodies[block.index()].shape]
    }

    /// Pressures that change over time: triangles by nodes, counter-clockwise seen from outside, and the factor.
    pub fn pressures_over_time(&self) -> impl Iterator<Item = (&[[u32; 3]], &Table)> {
        self.loads.pressures_over_time()
    }

    /// Number of factored matrices: distinct blocks with unknowns.
    pub fn factors(&self) -> usize {
        self.problem.shapes.iter().filter(|shape| shape.factor.is_some()).count()
    }

    /// Number of unknowns over all blocks.
    pub fn unknowns(&self) -> usize {
        self.problem.blocks.ids().map(|block| self.shape(block).unknowns.len()).sum()
    }

    /// Whether no block is supported, so that momentum can only come from loads.
    pub fn is_closed(&self) -> bool {
        self.problem.shapes.iter().all(Prototype::is_free)
    }

    /// The block of each distinct shape whose rotation is inexact because masses are lumped, with the largest part by which its inertia is
    /// too large.
    pub fn lumped_inertia_errors(&self) -> Vec<(BlockId, f64)> {
        let mut seen = vec![false; self.problem.shapes.len()];
        let firsts = self.problem.blocks.ids().zip(&self.bodies);
        let firsts = firsts.filter(|(_, body)| !std::mem::replace(&mut seen[body.shape], true));
        let errors = firsts.map(|(block, body)| (block, self.problem.shapes[body.shape].rotation_error()));
        errors.filter(|(_, error)| *error > 0.0).collect()
    }

    /// Whether any block turns with the inexact inertia of lumped masses.
    pub fn has_lumped_rotation(&self) -> bool {
        self.problem.shapes.iter().any(|shape| shape.rotation_error() > 0.0)
    }

    /// Whether blocks feel each other.
    pub fn has_contact(&self) -> bool {
        self.contact.is_some()
    }

    /// Whether contact takes energy from blocks that part, by a restitution below 1.
    pub fn damps_contact(&self) -> bool {
        self.contact.as_ref().is_some_and(|model| model.damps())
    }

    /// Whether contact takes much of the energy of impacts, by a restitution below 0.6, and blocks deform in it: their surfaces part from a stiff damper, which steps resolve slowly.
    pub fn damps_strongly(&self) -> bool {
        let strongly = self.contact.as_ref().is_some_and(|model| model.damps_strongly());
        strongly && self.problem.shapes.iter().any(|shape| shape.deforms())
    }

    /// Most that steps may have left of loads that change along the way of a block while nothing touches it: of its velocity, over the speed scale, and of its place, over the smallest
    /// height of its tetrahedra.
    pub fn free_load_errors(&self, block: BlockId) -> (f64, f64) {
        self.audit.ledger.free_load_errors(block)
    }

    /// Largest stable h = ω_c Δt; none where contact is solved for, or never stable.
    pub fn contact_bound(&self) -> Option<f64> {
        if self.newton.is_some() { None } else { self.problem.integrator.contact_bound() }
    }

    /// Largest h at which steps resolve contact at predicted positions: the bound, or a third of a contact's half period where
    /// no step is stable; none where contact is solved for.
    pub fn resolved_h(&self) -> Option<f64> {
        if self.newton.is_some() {
            None
        } else {
            Some(self.problem.integrator.contact_bound().unwrap_or(1.0))
        }
    }

    /// Whether a loss of energy is wrong: not where an integrator is asked to damp what elastic blocks do, unless contact at
    /// the end of steps takes energy, too.
    pub fn should_keep_energy(&self) -> bool {
        let asked = self.problem.integrator.damps_elasticity();
        let rigid = |shape: &Prototype| matches!(shape.kind, BodyKind::Rigid | BodyKind::Fixed);
        self.newton.is_some() || !asked || self.problem.shapes.iter().all(rigid)
    }

    /// Acceleration of the mass centre of a block in the last step [m/s²].
    pub fn acceleration_m_s2(&self, block: BlockId) -> Vec3 {
        self.shape(block).operator.center(&self.state.acceleration[self.blocks().nodes_of(block)])
    }

    /// Whether a block has fallen freely in the last step: its mass centre has the acceleration of gravity, to a thousandth.
    pub fn falls_freely(&self, block: BlockId) -> bool {
        let shape = self.shape(block);
        if shape.kind == BodyKind::Fixed {
            return false;
        }
        let gravity_m_s2 = self.gravity_of_last_step() * self.problem.gravity_m_s2;
        (self.acceleration_m_s2(block) - gravity_m_s2).norm() < 1e-3 * gravity_m_s2.norm()
    }

    /// Part of gravity that acted in the last step, or in the last part of one that was divided.
    fn gravity_of_last_step(&self) -> f64 {
        let Some(factor) = &self.problem.gravity_factor else { return 1.0 };
        let lead = self.weights.load_lead;
        factor.between(self.clock_s(lead - 1.5), self.clock_s(lead - 0.5)).mean
    }

    /// Blocks that fall freely below every block that does not, along gravity: nothing is left on which they could land.
    pub fn fallen_out(&self) -> Vec<BlockId> {
        let down = self.problem.gravity_m_s2;
        let depths =
            |block: BlockId| self.blocks().nodes_of(block).map(|node| down.dot(&self.state.position[node]));
        let (mut falling, mut lowest) = (Vec::new(), f64::NEG_INFINITY);
        for block in self.blocks().ids().filter(|&block| !self.is_absent(block)) {
            if self.falls_freely(block) {
                falling.push(block);
            } else {
                lowest = depths(block).fold(lowest, f64::max);
            }
        }
        falling.retain(|&block| lowest.is_finite() && depths(block).fold(f64::INFINITY, f64::min) > lowest);
        falling
    }

    /// Largest speed of the run so far [m/s].
    pub fn largest_speed_m_s(&self) -> f64 {
        self.audit.ledger.largest_speed_m_s()
    }

    /// Speed that errors of block velocities are held against [m/s]: the largest so far or, where that is less, that of a fall through 1/20 000 of
    /// h, 0.01 √(g h): the lowest height of tetrahedra of elastic blocks, or the smallest width of rigid and affine ones, that move.
    pub fn speed_scale_m_s(&self) -> f64 {
        self.audit.ledger.speed_scale_m_s()
    }

    /// Whether contact has friction.
    pub fn has_friction(&self) -> bool {
        self.contact.as_ref().is_some_and(|model| model.has_friction())
    }

    /// Whether the scheme takes reactions at one instant for their mean over a step where that is not so: with damping in proportion to stiffness, and where supports move. What
    /// momentum blocks have then differs from the impulses that are booked.
    pub fn books_reactions_at_one_instant(&self) -> bool {
        let changes = |shape: &Prototype| shape.damping.stiffness > 0.0 || !shape.supports.motions.is_empty();
        !self.weights.forces_do_their_work() && self.problem.shapes.iter().any(changes)
    }

    /// Whether errors of steps without contact fall with the square of the step.
    pub fn is_of_second_order(&self) -> bool {
        self.weights.elastic_lag() == 0.0
    }

    /// Speed below which a block that supports alone hold is at rest: that of vibrations of a hundredth of its strain; zero for others [m/s].
    pub fn rest_speed_m_s(&self, block: BlockId) -> f64 {
        self.audit.ledger.rest_speed_m_s(block)
    }

    /// Speed that a block has if all energy which rounding may have brought by now is its own [m/s].
    pub fn rounding_speed_m_s(&self, block: BlockId) -> f64 {
        (2.0 * self.audit.ledger.rounding_j() / self.shape(block).operator.mass_kg).sqrt()
    }

    /// Time since energies and momenta were measured by [`sample`](Self::sample) [s].
    pub fn unsampled_s(&self) -> f64 {
        self.audit.ledger.since_sample_s(self.time_s())
    }

    /// The worst of the run so far. Errors of energy and momentum are the worst of the [samples](Self::sample), and zero where there was none;
    /// [`unsampled_s`](Self::unsampled_s) says how much of the run they miss.
    pub fn invariants(&self) -> Invariants {
        self.audit.ledger.invariants()
    }

    /// Seconds per stage so far.
    pub fn stages(&self) -> StageTimes {
        self.audit.stages
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::newmark::Newmark;
    use crate::step::test_boxes::boxes;

    #[test]
    fn a_block_falls_freely_while_gravity_still_grows() {
        let roof = (BodyKind::Fixed, [1.0; 3], [0.0, 0.0, 2.0]);
        let cube = (BodyKind::Rigid, [1.0; 3], [0.0; 3]);
        let ramp = || Some(Table { rows: vec![(0.0, 0.0), (1.0, 1.0)] });
        let setup = || crate::Setup { gravity_factor: ramp(), ..boxes(&[roof, cube]) };
        let newmark = Box::new(Newmark { alpha: 0.25, delta: 0.5 });
        for setup in [setup(), crate::Setup { integrator: newmark, ..setup() }] {
            let mut simulation = Simulation::new(setup).unwrap();
            for _ in 0..20 {
                simulation.step().unwrap();
                assert!(simulation.falls_freely(BlockId(1)));
            }
            assert_eq!(simulation.fallen_out(), [BlockId(1)]);
        }
    }
}
