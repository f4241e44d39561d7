//! How a scene comes to rest, step by step: what damps it, and what is left of its motion.

use ndda_mesh::BlockId;
use ndda_mesh::geometry::Aabb;
use ndda_ranks::ExactSum;
use serde::{Deserialize, Serialize};

use crate::bodies::kind::BodyKind;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::adaptive_damping::AdaptiveDamping;
use crate::step::local_damping::LocalDamping;
use crate::step::oscillation::Oscillation;
use crate::step::report::StepReport;

/// Resultant of the loads of a block over the sum of their sizes, below which they cancel.
const CANCELLED: f64 = 1e-5;
/// Part of the forces that act, contact and bolts among them, with which unbalanced forces are compared at least.
const HELD: f64 = 1e-3;

/// Damping on the way to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damping {
    /// All blocks are stopped whenever the kinetic energy of the scene begins to fall.
    Kinetic,
    /// All velocities are damped in proportion, critically for the slowest oscillation that is left (Underwood 1983).
    Adaptive,
    /// Each block loses this part of what a step has changed its velocity by.
    Local {
        /// α, between 0 and 1.
        factor: f64,
    },
}

/// How a scene comes to rest, step by step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Progress {
    damper: Damper,
    pub(super) oscillation: Oscillation,
    /// `load_j` in the course of a run; before it begins a sixty-fourth of that, or none with adaptive damping, which is held to unbalanced forces [J]. A scene in
    /// equilibrium hardly moves, so its speed is compared with the one that loads alone would bring in a quarter of the slowest oscillation, or with an eighth of it: the
    /// former is about the largest speed of the same scene released without stress, whatever the step.
    moving_j: f64,
    /// Kinetic energy that loads alone would give all blocks but the fixed ones in a step [J]; 0 where the loads of each block cancel.
    load_j: f64,
    /// Largest kinetic energy that unbalanced forces would have given blocks in a step so far [J].
    unbalanced_j: f64,
    /// Largest kinetic energy on the way [J].
    highest_j: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Damper {
    Kinetic,
    Adaptive(AdaptiveDamping),
    Local(LocalDamping),
}

impl Progress {
    pub(super) fn new(simulation: &Simulation, damping: Damping) -> Self {
        let damper = match damping {
            Damping::Kinetic => Damper::Kinetic,
            Damping::Adaptive => Damper::Adaptive(AdaptiveDamping::default()),
            Damping::Local { factor } => Damper::Local(LocalDamping::new(factor)),
        };
        let moves = |block: &BlockId| simulation.shape(*block).kind != BodyKind::Fixed;
        let of_all = |energy_j: fn(&Simulation, BlockId) -> f64| {
            let moving = simulation.blocks().ids().filter(moves);
            moving.map(|block| energy_j(simulation, block)).collect::<ExactSum>().value()
        };
        let load_j = of_all(Simulation::load_energy_j);
        // What is left of loads that cancel is rounding, and no measure of anything.
        let is_one_sided = load_j > CANCELLED * CANCELLED * of_all(Simulation::load_size_j);
        let load_j = if is_one_sided { load_j } else { 0.0 };
        let moving_j = if damping == Damping::Adaptive { 0.0 } else { load_j / 64.0 };
        Self {
            damper,
            oscillation: Oscillation::default(),
            moving_j,
            load_j,
            unbalanced_j: 0.0,
            highest_j: load_j,
        }
    }

    /// How a scene comes to rest again in the course of a run.
    pub(super) fn within_a_run(simulation: &Simulation, damping: Damping) -> Self {
        let progress = Self::new(simulation, damping);
        Self { moving_j: progress.load_j, ..progress }
    }

    /// A step; gives its report, and the speed that is left over the largest.
    pub(super) fn step(&mut self, simulation: &mut Simulation) -> Result<(StepReport, f64), StepError> {
        let report = match &mut self.damper {
            Damper::Kinetic => simulation.step()?,
            Damper::Adaptive(damping) => simulation.step_with_adaptive_damping(damping)?,
            Damper::Local(damping) => simulation.step_with_local_damping(damping)?,
        };
        let total_j = simulation.kinetic_energy_j();
        self.highest_j = self.highest_j.max(total_j);
        let peak_j = self.oscillation.energy_j().max(total_j);
        let past_peak = self.oscillation.is_past_peak(total_j);
        match &self.damper {
            Damper::Kinetic => {
                if past_peak {
                    simulation.stop_all();
                }
                // An oscillation that has no more energy than rounding gives it is over.
                let is_over = past_peak && peak_j <= rounding_j(simulation);
                let left_j = if is_over { 0.0 } else { self.oscillation.left_j() };
                Ok((report, ratio(left_j, self.scale_j())))
            }
            Damper::Adaptive(damping) => {
                // A scene whose nodes move by rounding errors alone is at rest.
                let is_over = total_j.max(damping.change_j()) <= rounding_j(simulation);
                let left = self.left_or_unbalanced(simulation, total_j, damping.change_j());
                Ok((report, if is_over { 0.0 } else { left }))
            }
            Damper::Local(damping) => {
                let change_j = damping.change_j();
                Ok((report, self.left_or_unbalanced(simulation, total_j, change_j)))
            }
        }
    }

    /// Speed that is left, or unbalanced forces over loads where that is more: where an oscillation turns it is slow, and its forces are farthest from balance.
    /// Where loads cancel, as on opposite faces, or bolts and initial stress act alone, the largest unbalanced forces so far take the place of loads; in a scene that is
    /// in balance from the start, [`HELD`] of the forces that act does.
    fn left_or_unbalanced(&mut self, simulation: &Simulation, total_j: f64, change_j: f64) -> f64 {
        if self.load_j > 0.0 {
            return ratio(total_j, self.scale_j()).max(ratio(change_j, self.load_j));
        }
        self.unbalanced_j = self.unbalanced_j.max(change_j);
        let held_j = HELD * HELD * simulation.acting_energy_j();
        ratio(total_j, self.scale_j().max(held_j)).max(ratio(change_j, self.unbalanced_j.max(held_j)))
    }

    /// Energy that what is left is compared with [J].
    fn scale_j(&self) -> f64 {
        let steps = self.oscillation.longest as f64;
        self.highest_j.max(steps * steps * self.moving_j)
    }
}

/// ½ Σ m (2 ε X/Δt)² [J], X being the largest coordinate: each step rounds the place of a node, and the force that depends on it.
fn rounding_j(simulation: &Simulation) -> f64 {
    let bounds = Aabb::around(simulation.state.position.iter());
    let speed_m_s = 2.0 * f64::EPSILON * bounds.min.abs().sup(&bounds.max.abs()).max() / simulation.part_s;
    let mass_kg = |block| simulation.inertia_factor(block) * simulation.shape(block).operator.mass_kg;
    let moving = simulation.blocks().ids().filter(|&block| simulation.shape(block).kind != BodyKind::Fixed);
    0.5 * speed_m_s * speed_m_s * moving.map(mass_kg).collect::<ExactSum>().value()
}

/// Speed of an energy over that of another.
fn ratio(energy_j: f64, largest_j: f64) -> f64 {
    if largest_j > 0.0 { (energy_j / largest_j).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::prototype::ForceSetup;
    use crate::step::settle::Settle;
    use crate::step::test_boxes::boxes;
    use ndda_mesh::Vec3;

    /// Steps that a cube takes to rest on a fixed base that bears this load [N], from where contact does not carry it yet.
    fn steps_to_rest(load_n: f64) -> u64 {
        let base = (BodyKind::Fixed, [3.0, 3.0, 1.0], [-1.5, -1.5, -1.0]);
        let cube = (BodyKind::Rigid, [1.0; 3], [-0.5, -0.5, 0.0]);
        let mut setup = boxes(&[base, cube]);
        setup.bodies[0].forces.push(ForceSetup { node: 0, force_n: -load_n * Vec3::z(), factor: None });
        Simulation::new(setup).unwrap().settle(&Settle::new(1e-4, 100_000)).unwrap().steps
    }

    #[test]
    fn what_weighs_on_a_fixed_base_does_not_make_a_scene_rest_earlier() {
        let steps = steps_to_rest(0.0);
        assert!(steps > 10, "{steps} steps");
        assert_eq!(steps_to_rest(1e12), steps);
    }

    /// A cube of no weight between a base and a roof, which presses 2 mm into the base at first: its middle is 1 mm higher. Gives where it rests [m].
    fn clamped(damping: Damping, forces_n: &[f64]) -> f64 {
        let base = (BodyKind::Fixed, [3.0, 3.0, 1.0], [-1.5, -1.5, -1.0]);
        let cube = (BodyKind::Rigid, [1.0; 3], [-0.5, -0.5, -0.002]);
        let roof = (BodyKind::Fixed, [3.0, 3.0, 1.0], [-1.5, -1.5, 0.998]);
        let mut setup = boxes(&[base, cube, roof]);
        setup.gravity_m_s2 = Vec3::zeros();
        // All in one line, so that they do not turn the cube.
        let corners = &setup.blocks.rest_position[setup.blocks.nodes_of(BlockId(1))];
        let along = (corners[1] - corners[0]).normalize();
        for (node, &force_n) in [0, 0, 1].into_iter().zip(forces_n) {
            setup.bodies[1].forces.push(ForceSetup { node, force_n: force_n * along, factor: None });
        }
        let mut simulation = Simulation::new(setup).unwrap();
        let settle = Settle { damping: Some(damping), ..Settle::new(1e-4, 10_000) };
        simulation.settle(&settle).unwrap();
        let nodes = simulation.blocks().nodes_of(BlockId(1));
        simulation.state.position[nodes].iter().map(|x| x.z).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_scene_without_a_resultant_of_loads_rests_where_its_forces_balance() {
        // The second loads cancel but for rounding: 0.1 + 0.2 is not 0.3.
        for forces_n in [&[][..], &[1e5, 2e5, -3e5], &[0.1, 0.2, -0.3]] {
            for damping in [Damping::Local { factor: 0.8 }, Damping::Adaptive, Damping::Kinetic] {
                let z_m = clamped(damping, forces_n);
                assert!((z_m + 1e-3).abs() < 1e-6, "{damping:?} {forces_n:?}: {z_m}");
            }
        }
    }

    #[test]
    fn what_is_left_of_an_oscillation_over_its_scale_does_not_depend_on_the_step() {
        // A mass of 1 kg under 1 N begins at 1e-3 of the speed that 1 N brings in a quarter of its period of 1 s, and is not stopped.
        let left = |step_s: f64| {
            let mut oscillation = Oscillation::default();
            let speed_m_s = |t: f64| 0.25e-3 * (std::f64::consts::TAU * t).sin();
            for k in 1..=(0.4 / step_s).round() as u64 {
                oscillation.is_past_peak(0.5 * speed_m_s(k as f64 * step_s).powi(2));
            }
            let (steps, load_j) = (oscillation.longest as f64, 0.5 * step_s * step_s);
            ratio(0.5 * 0.25e-3f64.powi(2), steps * steps * load_j)
        };
        for step_s in [1e-2, 1e-3, 1e-4, 1e-5] {
            assert!((left(step_s) / 1e-3 - 1.0).abs() < 0.06, "{step_s}: {}", left(step_s));
        }
    }
}
