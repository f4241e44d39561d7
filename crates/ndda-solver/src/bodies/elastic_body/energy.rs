//! Elastic energy, vibrations and displacement in the frame.

use ndda_fem::FrameError;
use ndda_mesh::{Mat3, Vec3};

use super::*;
use crate::bodies::prototype::Prototype;
use crate::error::BlockError;
use crate::integrators::time_integrator::StepWeights;

impl ElasticBody {
    /// Elastic energy at `position`, ½ wᵀ K w + wᵀ ∫Bᵀσ₀, and what a nonlinear material adds [J].
    ///
    /// # Errors
    /// [`FrameError`] when the block has no rotation any more.
    pub(crate) fn strain_energy_j(
        &mut self,
        shape: &Prototype,
        position: &[Vec3],
    ) -> Result<f64, FrameError> {
        self.recover_displacement(shape, position)?;
        shape.operator.stiffness_times(&self.displacement, &mut self.elastic);
        let initial = |i: usize| self.kept.initial_force.as_ref().map_or(Vec3::zeros(), |f| f[i]);
        let terms = self.displacement.iter().zip(&self.elastic).enumerate();
        let energy_j: f64 = terms.map(|(i, (w, kw))| w.dot(&(0.5 * kw + initial(i)))).sum();
        let excess = self.kept.nonlinear.as_ref().map(|n| n.excess_energy_j(shape, &self.displacement));
        Ok(energy_j + excess.unwrap_or(0.0))
    }

    /// The part of the velocity that elasticity turns over in a step, as the integrator has it, c Δt² K̃⁻¹ K v, mean square over
    /// the mass [m/s]: θ² v of a vibration that turns by θ = ω Δt, up to 4 v of one that `Midpoint` does not resolve at all.
    /// It is at most θ v of each, √(v·K v/m) Δt; where that is no more than `known_m_s`, nothing is solved and zero comes back.
    ///
    /// # Errors
    /// [`BlockError`] when the block has no rotation any more, or the solver does not get there.
    pub(crate) fn vibration_m_s(
        &mut self,
        shape: &Prototype,
        (weights, dt_s): (&StepWeights, f64),
        (position, velocity): (&[Vec3], &[Vec3]),
        known_m_s: f64,
    ) -> Result<f64, BlockError> {
        let center = shape.operator.center(position);
        let rotation = shape.supports.frame.rotation(&shape.operator, position, &center)?;
        for (w, v) in self.displacement.iter_mut().zip(velocity) {
            *w = rotation.tr_mul(v);
        }
        shape.operator.stiffness_times(&self.displacement, &mut self.elastic);
        for spring in &shape.supports.springs {
            let node = spring.node as usize;
            let pull = along(spring.along.as_ref(), &velocity[node]);
            self.elastic[node] += spring.stiffness_n_m * rotation.tr_mul(&pull);
        }
        let power: f64 = self.displacement.iter().zip(&self.elastic).map(|(v, kv)| v.dot(kv)).sum();
        let mass_kg = shape.operator.mass_kg;
        if power <= 0.0 || dt_s * (power / mass_kg).sqrt() <= known_m_s {
            return Ok(0.0);
        }
        shape.unknowns.gather(&self.elastic, &mut self.unknowns);
        self.solve(shape)?;
        self.correction.fill(Vec3::zeros());
        shape.unknowns.scatter(&self.unknowns, &mut self.correction);
        let squares =
            self.correction.iter().zip(&shape.operator.node_mass).map(|(v, m)| m * v.norm_squared());
        Ok(weights.mass_per_s2 * dt_s * dt_s * (squares.sum::<f64>() / mass_kg).sqrt())
    }

    /// R at `position`; afterwards [`displacement_in_frame`](Self::displacement_in_frame) is w there.
    ///
    /// # Errors
    /// [`FrameError`] when the block has no rotation any more.
    pub(crate) fn recover_displacement(
        &mut self,
        shape: &Prototype,
        position: &[Vec3],
    ) -> Result<Mat3, FrameError> {
        let center = shape.operator.center(position);
        let rotation = shape.supports.frame.rotation(&shape.operator, position, &center)?;
        self.displacement.copy_from_slice(position);
        self.turn_into_frame(shape, &rotation, &center);
        Ok(rotation)
    }

    /// w = Rᵀ (x − c) − X as last recovered [m].
    pub(crate) fn displacement_in_frame(&self) -> &[Vec3] {
        &self.displacement
    }

    /// Energy stored in support springs at `position` and time [J].
    pub(crate) fn spring_energy_j(&self, shape: &Prototype, position: &[Vec3], time_s: f64) -> f64 {
        let anchors = &self.kept.anchor[shape.supports.held.len()..];
        let springs = shape.supports.springs.iter().zip(anchors);
        let energy = springs.map(|(spring, anchor)| {
            let moved =
                spring.motion.map_or(Vec3::zeros(), |m| shape.supports.motions[m].displacement(time_s));
            let stretch = along(spring.along.as_ref(), &(position[spring.node as usize] - anchor - moved));
            0.5 * spring.stiffness_n_m * stretch.norm_squared()
        });
        energy.sum()
    }
}
