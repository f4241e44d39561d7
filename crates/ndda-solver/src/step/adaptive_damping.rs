//! Adaptive dynamic relaxation: viscous damping that is critical for the slowest oscillation that is left.

use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::ExactSum;
use serde::{Deserialize, Serialize};

use crate::bodies::kind::BodyKind;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::report::StepReport;

/// Largest θ = ω Δt that damping follows, which leaves two thirds of the velocity: quick oscillations die out in ten steps, and slow ones do not stand still meanwhile.
const MOST_THETA: f64 = 0.2;

/// Adaptive dynamic relaxation (Underwood 1983, "Dynamic relaxation").
///
/// After each step all velocities are multiplied by (1 − θ)/(1 + θ), θ = ω Δt, with damping 2 ω that is critical for an oscillation of frequency ω. ω is that of the
/// scene as it moves now, by Rayleigh's quotient: ω² = −v·Δf/(Δt v·M v), Δf being what a step at v has changed forces by. Quick oscillations die out first, and
/// ω falls to that of the slowest. Friction that acts on velocities follows the motion as if contact were stiff, and θ is then at its limit more often.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct AdaptiveDamping {
    /// Velocities before the step.
    before: Vec<Vec3>,
    /// Impulses of the last step [N s].
    impulse: Vec<Vec3>,
    /// θ of the last step.
    theta: f64,
    /// Kinetic energy that the changes of the last step would be by themselves [J].
    change_j: f64,
}

/// Sums over a scene: v·Δf Δt, v·M v and Δv·M Δv, v being velocities before a step and Δv what it changed them by.
#[derive(Clone, Copy, Default)]
struct Sums {
    curved: f64,
    moving: f64,
    changed: f64,
}

impl AdaptiveDamping {
    /// Kinetic energy that the last step's changes of velocity would be by themselves [J].
    pub(crate) fn change_j(&self) -> f64 {
        self.change_j
    }

    /// Takes the sums of a step; gives what damping leaves of velocities.
    fn left(&mut self, sums: &Sums) -> f64 {
        // Where forces grow along the motion, as in a slip, the frequency of before counts.
        if sums.moving > 0.0 && sums.curved < 0.0 {
            self.theta = (-sums.curved / sums.moving).sqrt().min(MOST_THETA);
        }
        (1.0 - self.theta) / (1.0 + self.theta)
    }
}

impl Simulation {
    /// A step with adaptive damping, for finding equilibrium: the energy that damping takes is not part of the balance.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub(crate) fn step_with_adaptive_damping(
        &mut self,
        damping: &mut AdaptiveDamping,
    ) -> Result<StepReport, StepError> {
        damping.before.clone_from(&self.state.velocity);
        let report = self.step()?;
        damping.impulse.resize(self.state.velocity.len(), Vec3::zeros());
        let (mut curved, mut moving, mut changed) = (ExactSum::new(), ExactSum::new(), ExactSum::new());
        for block in self.problem.blocks.ids() {
            let of_block = self.sums_of_block(block, damping);
            curved.add(of_block.curved);
            moving.add(of_block.moving);
            changed.add(of_block.changed);
        }
        let sums = Sums { curved: curved.value(), moving: moving.value(), changed: changed.value() };
        damping.change_j = 0.5 * sums.changed;
        let left = damping.left(&sums);
        for block in self.problem.blocks.ids() {
            if self.problem.shapes[self.bodies[block.index()].shape].kind != BodyKind::Fixed {
                let nodes = self.problem.blocks.nodes_of(block);
                self.keep_forces(block, |simulation| {
                    simulation.state.velocity[nodes].iter_mut().for_each(|v| *v *= left);
                });
            }
        }
        Ok(report)
    }

    /// Notes the impulses of a block's nodes, and gives its part of the sums.
    fn sums_of_block(&self, block: BlockId, damping: &mut AdaptiveDamping) -> Sums {
        let (shape, mut sums) = (self.shape(block), Sums::default());
        if shape.kind == BodyKind::Fixed {
            return sums;
        }
        let (nodes, factor) = (self.problem.blocks.nodes_of(block), self.inertia_factor(block));
        for (node, mass_kg) in nodes.zip(&shape.operator.node_mass) {
            let (before, mass) = (damping.before[node], factor * mass_kg);
            let change = self.state.velocity[node] - before;
            let impulse = mass * change;
            sums.curved += before.dot(&(impulse - damping.impulse[node]));
            sums.moving += mass * before.norm_squared();
            sums.changed += mass * change.norm_squared();
            damping.impulse[node] = impulse;
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps until two oscillators of these θ = ω Δt, of unit mass under unit force each, are within 1e-6 of their rest.
    fn steps_to_rest(thetas: [f64; 2]) -> usize {
        let mut damping = AdaptiveDamping::default();
        let (mut x, mut v, mut last) = ([0.0f64; 2], [0.0f64; 2], [0.0f64; 2]);
        let off =
            |x: &[f64; 2]| (0..2).map(|i| (1.0 - thetas[i] * thetas[i] * x[i]).abs()).fold(0.0, f64::max);
        let mut steps = 0;
        while off(&x) > 1e-6 {
            let mut sums = Sums::default();
            for i in 0..2 {
                // Forces act where x will be in the middle of the step; Δt = 1.
                let change = 1.0 - thetas[i] * thetas[i] * (x[i] + 0.5 * v[i]);
                sums.curved += v[i] * (change - last[i]);
                sums.moving += v[i] * v[i];
                let old = v[i];
                v[i] += change;
                x[i] += 0.5 * (old + v[i]);
                last[i] = change;
            }
            let left = damping.left(&sums);
            v.iter_mut().for_each(|v| *v *= left);
            steps += 1;
            assert!(steps < 100_000);
        }
        steps
    }

    #[test]
    fn a_slow_oscillation_comes_to_rest_as_if_alone_whatever_else_oscillates() {
        let slow = 0.01;
        // (1 + θ n) e^{−θ n} = 1e-6 of one that is damped critically from its start.
        let critical = 16.7 / slow;
        for quick in [0.02, 0.1, 0.5, 1.0, 1.8] {
            let steps = steps_to_rest([slow, quick]) as f64;
            assert!(steps < 1.2 * critical, "{quick}: {steps} steps, {critical} of one alone");
        }
    }
}
