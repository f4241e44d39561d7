//! Damping in proportion to stiffness: it resists deformation, and neither displacement nor rotation of a block.
//!
//! With w = Rᵀ (x − c) − X, the displacement that a block's own frame R sees, the force is −b K (w₁ − w₀)/Δt at the middle of the
//! step, w₁ being solved for. A mode of frequency ω then keeps (1 − y)/(1 + y) of its velocity, y = ½ b ω² Δt: second order, but
//! beyond y = 1 the sign alternates. So the change of velocities in the step is filtered afterwards,
//!
//! ```text
//! v₁ ← v₁ − D² ½ (v₁ − v₀)        D = 1 − (M + k K)⁻¹ M = (M + k K)⁻¹ k K        k = b Δt
//! ```
//!
//! with velocities seen in the frames of their own instants, which leaves (1 + 3y)/((1 + y)(1 + 2y)²) of the mode: positive, falling,
//! 1 − z + ½ z² + O(z³) for z = 2y = b ω² Δt, and about 3/4y² for large y. Where accelerations are remembered, their deforming
//! part keeps (1 − D)². D has no momentum and, about the places of rest, no angular momentum.

use ndda_fem::{BlockOperator, FrameError};
use ndda_mesh::{Mat3, Vec3};

use crate::bodies::congruent_groups::Nodes;
use crate::bodies::prototype::Prototype;
use crate::bodies::report::BlockReport;
use crate::error::BlockError;
use crate::linear::linear_solver::{Factor, Scratch};

/// Memory of one block for damping in proportion to stiffness: sized once, written every step.
pub(crate) struct StiffnessDamping {
    /// R at the start of the step.
    start: Mat3,
    /// w₀, then w₁ − w₀ in the block's frame [m].
    change: Vec<Vec3>,
    /// K of a field [N].
    product: Vec<Vec3>,
    /// A field of velocities or accelerations in the block's frame, and D of it.
    field: Vec<Vec3>,
    unknowns: Vec<f64>,
    scratch: Scratch,
}

impl StiffnessDamping {
    /// Memory for a block of this shape; none where nothing is to be damped so.
    pub(crate) fn new(shape: &Prototype) -> Option<Box<Self>> {
        let factor = shape.filter.as_ref()?;
        let zeros = vec![Vec3::zeros(); shape.operator.nodes()];
        Some(Box::new(Self {
            start: Mat3::identity(),
            change: zeros.clone(),
            product: zeros.clone(),
            field: zeros,
            unknowns: vec![0.0; shape.unknowns.len()],
            scratch: factor.new_scratch(),
        }))
    }

    /// Memory of solves for another factor of the same matrix structure.
    pub(crate) fn renew_scratch(&mut self, factor: &dyn Factor) {
        self.scratch = factor.new_scratch();
    }

    /// load ← load − b/Δt K (ŵ − w₀) for the block at the start of the step and ŵ, w at x + û; the rest of the force is in K̃.
    ///
    /// # Errors
    /// [`FrameError`] when the block has no rotation.
    pub(crate) fn load(
        &mut self,
        shape: &Prototype,
        position: &[Vec3],
        predicted: &[Vec3],
        load: &mut [Vec3],
    ) -> Result<(), FrameError> {
        let operator = &shape.operator;
        let center = operator.center(position);
        self.start = shape.supports.frame.rotation(operator, position, &center)?;
        let nodes = position.iter().zip(&operator.rest).zip(predicted);
        for (change, ((x, rest), w)) in self.change.iter_mut().zip(nodes) {
            *change = w - (self.start.tr_mul(&(x - center)) - rest);
        }
        operator.stiffness_times(&self.change, &mut self.product);
        let force = shape.damping.stiffness;
        load.iter_mut().zip(&self.product).for_each(|(load, kw)| *load -= force * kw);
        Ok(())
    }

    /// Notes the correction s that the step has solved for: w₁ = ŵ + s.
    pub(crate) fn note(&mut self, correction: &[Vec3]) {
        self.change.iter_mut().zip(correction).for_each(|(change, s)| *change += s);
    }

    /// Work of the force in the step, −(w₁ − w₀)·b/Δt K (w₁ − w₀) [J]: never positive, and none where a block moves rigidly.
    pub(crate) fn work_j(&mut self, shape: &Prototype) -> f64 {
        shape.operator.stiffness_times(&self.change, &mut self.product);
        let along = self.change.iter().zip(&self.product).map(|(change, kw)| change.dot(kw));
        -shape.damping.stiffness * along.sum::<f64>()
    }

    /// Filters velocities, and accelerations if they are remembered, at the end of a step that began as `start` and ends at `end`, and
    /// books what that takes. The impulse is that of supports: a free block gets none.
    ///
    /// # Errors
    /// [`BlockError`] when the block has lost its shape, or the solver does not get there.
    pub(crate) fn filter(
        &mut self,
        shape: &Prototype,
        start: &Nodes,
        end: &[Vec3],
        (velocity, acceleration): (&mut [Vec3], Option<&mut [Vec3]>),
        report: &mut BlockReport,
    ) -> Result<(), BlockError> {
        let operator = &shape.operator;
        let center = operator.center(end);
        let rotation = shape.supports.frame.rotation(operator, end, &center)?;
        if let Some(acceleration) = acceleration {
            let spin = rotation.tr_mul(&operator.rigid_motion(end, velocity).spin_rad_s);
            self.filter_acceleration(shape, (end, &rotation, &center), &spin, acceleration)?;
        }
        for ((h, v), old) in self.field.iter_mut().zip(&*velocity).zip(start.velocity) {
            *h = 0.5 * (rotation.tr_mul(v) - self.start.tr_mul(old));
        }
        self.apply(shape)?;
        // Part of a change that the filter leaves when it meets half of it: D − D².
        let once = self.field.iter().zip(&operator.node_mass);
        self.change.iter_mut().zip(once.clone()).for_each(|(change, (d, _))| *change = *d);
        self.apply(shape)?;
        let left = self.change.iter().zip(self.field.iter().zip(&operator.node_mass));
        let square: f64 = left.map(|(once, (twice, m))| m * (once - twice).norm_squared()).sum();
        if shape.is_free() {
            self.take_out_turn(operator, end, &rotation, &center);
        }
        self.field.iter_mut().for_each(|d| *d = rotation * *d);
        for (i, d) in self.field.iter().enumerate() {
            let momentum = operator.mass_row_times(i, &self.field);
            report.damping_work_j += momentum.dot(&(0.5 * d - velocity[i]));
            report.impulse -= momentum;
            report.impulse_moment -= end[i].cross(&momentum);
        }
        velocity.iter_mut().zip(&self.field).for_each(|(v, d)| *v -= d);
        report.damping_error_m_s += (square / operator.mass_kg).sqrt();
        Ok(())
    }

    /// a ← a − (2 D − D²) of its deforming part: what turns a block, and keeps its nodes on circles, deforms nothing.
    fn filter_acceleration(
        &mut self,
        shape: &Prototype,
        (position, rotation, center): (&[Vec3], &Mat3, &Vec3),
        spin: &Vec3,
        acceleration: &mut [Vec3],
    ) -> Result<(), BlockError> {
        for ((r, a), x) in self.field.iter_mut().zip(&*acceleration).zip(position) {
            let arm = rotation.tr_mul(&(x - center));
            *r = rotation.tr_mul(a) - spin.cross(&spin.cross(&arm));
        }
        for part in [2.0, -1.0] {
            self.apply(shape)?;
            let filtered = acceleration.iter_mut().zip(&self.field);
            filtered.for_each(|(a, d)| *a -= part * (rotation * d));
        }
        Ok(())
    }

    /// field ← D field; components that are held get none.
    fn apply(&mut self, shape: &Prototype) -> Result<(), BlockError> {
        let Some(factor) = &shape.filter else { return Ok(()) };
        shape.operator.stiffness_times(&self.field, &mut self.product);
        self.product.iter_mut().for_each(|f| *f *= shape.damping.filter_s2);
        shape.unknowns.gather(&self.product, &mut self.unknowns);
        factor.solve_in_place(&mut self.unknowns, &mut self.scratch)?;
        self.field.fill(Vec3::zeros());
        shape.unknowns.scatter(&self.unknowns, &mut self.field);
        Ok(())
    }

    /// Takes out of `field` the rigid turn that has its angular momentum about the deformed shape.
    fn take_out_turn(&mut self, operator: &BlockOperator, position: &[Vec3], rotation: &Mat3, center: &Vec3) {
        for (arm, x) in self.change.iter_mut().zip(position) {
            *arm = rotation.tr_mul(&(x - center));
        }
        let angular = operator.angular_momentum(&Vec3::zeros(), &self.change, &self.field);
        let Some(inverse) = operator.inertia(&self.change, &self.change).try_inverse() else { return };
        let turn = inverse * angular;
        self.field.iter_mut().zip(&self.change).for_each(|(d, arm)| *d -= turn.cross(arm));
    }
}
