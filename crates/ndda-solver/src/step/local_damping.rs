//! Local damping: what is out of balance is damped, and nothing else.

use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::ExactSum;
use serde::{Deserialize, Serialize};

use crate::bodies::kind::BodyKind;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::report::StepReport;

/// Local damping (Cundall 1987, "Distinct element models of rock and soil structure").
///
/// After a step the velocity v of each block loses α times the change Δv that the step made, and at most all of it:
/// v ← v max(0, 1 − α ‖Δv‖/‖v‖), where ‖v‖² is twice the kinetic energy. Vibrations are damped whatever their frequency; blocks at rest and
/// in steady motion are not, and equilibrium is that of the scene without damping. A block that vibrates while it slides is slowed down in its
/// sliding, too: where it matters whether a block slides, use [`of_vibrations`](Self::of_vibrations).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LocalDamping {
    factor: f64,
    /// Velocities before the step, then what the step changed them by.
    change: Vec<Vec3>,
    /// Kinetic energy that the changes of the last step would be by themselves [J].
    change_j: f64,
    /// Steps over which velocities are averaged, and their averages; none where all of a velocity is damped.
    steps: Option<f64>,
    mean: Vec<Vec3>,
}

impl LocalDamping {
    /// Damping by a factor α between 0 (none) and 1.
    pub fn new(factor: f64) -> Self {
        Self {
            factor: factor.clamp(0.0, 1.0),
            change: Vec::new(),
            change_j: 0.0,
            steps: None,
            mean: Vec::new(),
        }
    }

    /// Damping of the difference between a velocity v and its running mean v̄, which changes by (v − v̄)/steps in each step. A block that
    /// slides while it vibrates goes on to slide. A block whose acceleration would be a accelerates by a/(1 + steps d), where d is the part of the
    /// difference that is damped in a step.
    pub fn of_vibrations(factor: f64, steps: f64) -> Self {
        Self { steps: Some(steps.max(1.0)), ..Self::new(factor) }
    }

    /// Kinetic energy that the last step's changes of velocity would be by themselves [J].
    pub(crate) fn change_j(&self) -> f64 {
        self.change_j
    }
}

impl Simulation {
    /// A step with local damping, for finding equilibrium: the energy that damping takes is not part of the balance.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn step_with_local_damping(&mut self, damping: &mut LocalDamping) -> Result<StepReport, StepError> {
        damping.change.clone_from(&self.state.velocity);
        let report = self.step()?;
        if damping.steps.is_some() {
            damping.mean.resize(self.state.velocity.len(), Vec3::zeros());
        }
        let mut change_j = ExactSum::new();
        for block in self.problem.blocks.ids() {
            change_j.add(self.keep_forces(block, |simulation| simulation.damp_block(block, damping)));
        }
        damping.change_j = change_j.value();
        Ok(report)
    }

    /// Adds velocities, per node, to those of all blocks that are not fixed; not part of the balance either.
    pub fn push(&mut self, velocity: &[Vec3]) {
        self.note_blow();
        for block in self.problem.blocks.ids() {
            if self.shape(block).kind == BodyKind::Fixed {
                continue;
            }
            for node in self.problem.blocks.nodes_of(block) {
                self.state.velocity[node] += velocity[node];
            }
        }
    }

    /// Damps a block; gives the kinetic energy that the change of its velocities would be by itself [J].
    fn damp_block(&mut self, block: BlockId, damping: &mut LocalDamping) -> f64 {
        let shape = &self.problem.shapes[self.bodies[block.index()].shape];
        if shape.kind == BodyKind::Fixed {
            return 0.0;
        }
        let inertia_factor = self.inertia_factor(block);
        let nodes = self.problem.blocks.nodes_of(block);
        let velocity = &mut self.state.velocity[nodes.clone()];
        let change = &mut damping.change[nodes.clone()];
        for (change, v) in change.iter_mut().zip(velocity.iter()) {
            *change = v - *change;
        }
        let change_j = shape.operator.kinetic_energy_j(change);
        let Some(steps) = damping.steps else {
            let left = left(damping.factor, change_j, shape.operator.kinetic_energy_j(velocity));
            velocity.iter_mut().for_each(|v| *v *= left);
            return inertia_factor * change_j;
        };
        let mean = &mut damping.mean[nodes];
        for ((vibration, mean), v) in change.iter_mut().zip(mean.iter_mut()).zip(velocity.iter()) {
            *mean += (v - *mean) / steps;
            *vibration = v - *mean;
        }
        let left = left(damping.factor, change_j, shape.operator.kinetic_energy_j(change));
        for (v, vibration) in velocity.iter_mut().zip(change.iter()) {
            *v -= (1.0 - left) * vibration;
        }
        inertia_factor * change_j
    }
}

/// 1 − α ‖Δv‖/‖v‖, at least 0.
fn left(factor: f64, change_j: f64, speed_j: f64) -> f64 {
    if speed_j > 0.0 { (1.0 - factor * (change_j / speed_j).sqrt()).max(0.0) } else { 1.0 }
}
