//! The step of a block that deforms: predict, turn into its frame, solve, correct.

mod energy;
mod momentum;
mod nonlinear;
mod quiet;
mod reactions;

use ndda_fem::Voigt;
use ndda_fem::loads::{InitialStress, initial_stress_force};
use ndda_fem::supports::HeldNode;
use ndda_mesh::{Mat3, Vec3};

use crate::bodies::congruent_groups::{NodeSlices, Nodes};
use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::bodies::record::displacement_at;
use crate::bodies::report::BlockReport;
use crate::bodies::stiffness_damping::StiffnessDamping;
use crate::error::BlockError;
use crate::linear::linear_solver::{Scratch, SolveError};
use nonlinear::Nonlinear;

/// What a block that deforms keeps from step to step beside the state of its nodes.
#[derive(Default)]
pub(crate) struct Kept {
    /// ∫ Bᵀ σ₀ in the block's frame [N].
    pub initial_force: Option<Vec<Vec3>>,
    /// σ₀ of each element [Pa]; empty without.
    pub initial_stress_pa: Vec<Voigt>,
    /// Start positions of the held nodes [m], one entry per held node, then one per spring, then one per node of quiet faces.
    anchor: Vec<Vec3>,
    /// Memory for damping in proportion to stiffness.
    pub(crate) damping: Option<Box<StiffnessDamping>>,
    /// Memory for a material whose stress is not linear in the strain.
    nonlinear: Option<Box<Nonlinear>>,
}

impl Kept {
    /// That of a block of this shape that rests at `position`.
    pub(crate) fn new(shape: &Prototype, initial: Option<&InitialStress>, position: &[Vec3]) -> Self {
        let initial_stress_pa = initial.map_or(Vec::new(), |s| s.of_elements(&shape.operator, position));
        let initial_force = initial.map(|_| initial_stress_force(&shape.operator, &initial_stress_pa));
        let held = shape.supports.held.iter().map(|h| position[h.node as usize]);
        let sprung = shape.supports.springs.iter().map(|s| position[s.node as usize]);
        let quiet = shape.supports.quiet.dashpots.iter().map(|d| position[d.node as usize]);
        Self {
            initial_force,
            initial_stress_pa,
            anchor: held.chain(sprung).chain(quiet).collect(),
            damping: StiffnessDamping::new(shape),
            nonlinear: Nonlinear::new(shape),
        }
    }
}

/// Memory of one block that deforms: sized once, written every step.
pub(crate) struct ElasticBody {
    /// What is not written over.
    pub(crate) kept: Kept,
    /// û [m].
    predicted: Vec<Vec3>,
    /// Rᵀ f, later the velocity at the end of the step.
    load: Vec<Vec3>,
    /// w in the block's frame [m].
    displacement: Vec<Vec3>,
    /// s in the block's frame, later u in global axes [m].
    correction: Vec<Vec3>,
    /// K w + ∫Bᵀσ₀ in the block's frame [N].
    elastic: Vec<Vec3>,
    /// Rigid part of u, for the momentum balance [m]; zero for supported blocks.
    rigid: Vec<Vec3>,
    /// R of the last step.
    rotation: Mat3,
    pub(crate) unknowns: Vec<f64>,
    pub(crate) scratch: Scratch,
    report: BlockReport,
}

impl ElasticBody {
    /// Memory for a block of this shape.
    pub(crate) fn new(shape: &Prototype, kept: Kept) -> Self {
        let zeros = || vec![Vec3::zeros(); shape.operator.nodes()];
        Self {
            kept,
            predicted: zeros(),
            load: zeros(),
            displacement: zeros(),
            correction: zeros(),
            elastic: zeros(),
            rigid: zeros(),
            rotation: Mat3::identity(),
            unknowns: vec![0.0; shape.unknowns.len()],
            scratch: shape.factor.as_ref().map_or_else(Scratch::default, |f| f.new_scratch()),
            report: BlockReport::default(),
        }
    }

    /// Advances the block by one step:
    ///
    /// ```text
    /// u = û + R K̃⁻¹ [Rᵀ (f − (1 − θ) f_int) − θ (K w + ∫Bᵀσ₀)]      w = Rᵀ (x + û − c) − X
    /// ```
    ///
    /// For R = I this is the paper's eqs (11)–(13). R is taken at x + û: taken at x it would let a spinning block
    /// gain angular momentum. The start of the step enters by its own internal force f_int, in its own frame:
    /// taken at the mean position instead, a turning block would be stretched by (ωΔt)²/8.
    ///
    /// # Errors
    /// [`BlockError`] when the block has lost its shape or its speed.
    pub(crate) fn step(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        nodes: NodeSlices,
    ) -> Result<BlockReport, BlockError> {
        self.prepare(shape, context, &nodes.view())?;
        self.solve(shape)?;
        self.finish(shape, context, nodes)
    }

    /// The rest of a step whose right-hand side is prepared and solved for.
    ///
    /// # Errors
    /// [`BlockError`] when the block has lost its speed.
    pub(crate) fn finish(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        mut nodes: NodeSlices,
    ) -> Result<BlockReport, BlockError> {
        self.report = BlockReport::default();
        self.converge(shape, context.weights.stiffness)?;
        self.place_correction(shape, context, &nodes.view());
        let rotation = self.rotation;
        if let Some(damping) = &mut self.kept.damping {
            damping.note(&self.correction);
        }
        self.update_internal_force(shape, &rotation, nodes.internal_force);
        if !shape.is_free() {
            self.collect_reactions(shape, context, &rotation, &nodes.view());
        }
        self.turn_back(&rotation);
        if shape.is_free() {
            self.balance_momentum(shape, context, &nodes.view());
        }
        self.advance(shape, context, &mut nodes)?;
        Ok(self.report)
    }

    /// u as a step would have it but for the balance of momentum, which changes it in the last digits; nothing else
    /// is written.
    ///
    /// # Errors
    /// [`BlockError`] when the block has lost its shape.
    pub(crate) fn try_step(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        nodes: &Nodes,
    ) -> Result<(), BlockError> {
        self.prepare(shape, context, nodes)?;
        self.solve(shape)?;
        self.converge(shape, context.weights.stiffness)?;
        self.place_correction(shape, context, nodes);
        self.turn_back(&self.rotation.clone());
        Ok(())
    }

    /// u as last tried [m].
    pub(crate) fn increment(&self) -> &[Vec3] {
        &self.correction
    }

    /// Velocities at the end of the step as last tried [m/s].
    pub(crate) fn end_velocity(&self, context: &StepContext, nodes: &Nodes, out: &mut [Vec3]) {
        for (i, (out, u)) in out.iter_mut().zip(&self.correction).enumerate() {
            let (mut velocity, mut acceleration) = (nodes.velocity[i], nodes.acceleration[i]);
            context.correct(u, &self.predicted[i], &mut velocity, &mut acceleration);
            *out = velocity;
        }
    }

    /// f ← R K̃⁻¹ Rᵀ f: how u as last tried changes with the force.
    ///
    /// # Errors
    /// [`BlockError::Solve`] when the solver does not get there.
    pub(crate) fn respond_in_place(
        &mut self,
        shape: &Prototype,
        force: &mut [Vec3],
    ) -> Result<(), BlockError> {
        for (turned, f) in self.correction.iter_mut().zip(&*force) {
            *turned = self.rotation.tr_mul(f);
        }
        shape.unknowns.gather(&self.correction, &mut self.unknowns);
        self.solve(shape)?;
        force.fill(Vec3::zeros());
        shape.unknowns.scatter(&self.unknowns, force);
        force.iter_mut().for_each(|u| *u = self.rotation * *u);
        Ok(())
    }

    /// The right-hand side of the block's equations, in `unknowns`.
    ///
    /// # Errors
    /// [`BlockError`] when the block has lost its shape.
    pub(crate) fn prepare(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        nodes: &Nodes,
    ) -> Result<(), BlockError> {
        self.predict(context, nodes);
        // x + û is kept in `displacement` until w replaces it.
        let center = shape.operator.center(&self.displacement);
        let rotation = shape.supports.frame.rotation(&shape.operator, &self.displacement, &center)?;
        self.rotation = rotation;
        self.gather_load(shape, context, &rotation, nodes);
        self.turn_into_frame(shape, &rotation, &center);
        if let Some(damping) = &mut self.kept.damping {
            damping.load(shape, nodes.position, &self.displacement, &mut self.load)?;
        }
        self.gather_residual(shape, context);
        self.prescribe(shape, context, &rotation, nodes.position);
        if let Some(nonlinear) = &mut self.kept.nonlinear {
            nonlinear.begin(&self.correction);
        }
        shape.unknowns.gather(&self.correction, &mut self.unknowns);
        Ok(())
    }

    /// s from `unknowns` as solved, prescribed motions included; held components stay zero.
    fn place_correction(&mut self, shape: &Prototype, context: &StepContext, nodes: &Nodes) {
        self.correction.fill(Vec3::zeros());
        shape.unknowns.scatter(&self.unknowns, &mut self.correction);
        self.finish_prescribed(shape, context, &self.rotation.clone(), nodes.position);
    }

    /// û and x + û.
    fn predict(&mut self, context: &StepContext, nodes: &Nodes) {
        for (i, x) in nodes.position.iter().enumerate() {
            let (v, a) = (&nodes.velocity[i], &nodes.acceleration[i]);
            self.predicted[i] = context.predict(v, a);
            self.displacement[i] = x + self.predicted[i];
        }
    }

    /// Rᵀ (f + springs at x + θ û − (1 − θ) f_int − α_m M a).
    fn gather_load(&mut self, shape: &Prototype, context: &StepContext, rotation: &Mat3, nodes: &Nodes) {
        let theta = context.weights.stiffness;
        self.load.copy_from_slice(context.force);
        for (load, internal) in self.load.iter_mut().zip(nodes.internal_force) {
            *load -= (1.0 - theta) * internal;
        }
        if context.weights.old_inertia != 0.0 {
            for (i, load) in self.load.iter_mut().enumerate() {
                let inertia = shape.operator.mass_row_times(i, nodes.acceleration);
                *load -= context.weights.old_inertia * inertia;
            }
        }
        for (k, spring) in shape.supports.springs.iter().enumerate() {
            let pull = self.pull_of_spring(shape, context, k, nodes.position);
            self.load[spring.node as usize] += pull;
        }
        for (k, dashpot) in shape.supports.quiet.dashpots.iter().enumerate() {
            let known = self.quiet_force(shape, context, k, nodes).0;
            self.load[dashpot.node as usize] += known;
        }
        for load in &mut self.load {
            *load = rotation.tr_mul(load);
        }
    }

    /// Force of the k-th spring at x + θ û [N]; what u adds to it is in K̃.
    fn pull_of_spring(&self, shape: &Prototype, context: &StepContext, k: usize, position: &[Vec3]) -> Vec3 {
        let spring = &shape.supports.springs[k];
        let node = spring.node as usize;
        let place = position[node] + context.weights.stiffness * self.predicted[node];
        let anchor = self.kept.anchor[shape.supports.held.len() + k];
        let stretch = place - anchor - displacement_at(shape, spring.motion, context.theta_time_s());
        -spring.stiffness_n_m * along(spring.along.as_ref(), &stretch)
    }

    /// w = Rᵀ (x − c) − X for the positions in `displacement`.
    fn turn_into_frame(&mut self, shape: &Prototype, rotation: &Mat3, center: &Vec3) {
        for (w, rest) in self.displacement.iter_mut().zip(&shape.operator.rest) {
            *w = rotation.tr_mul(&(*w - center)) - rest;
        }
    }

    /// K w + ∫Bᵀσ₀, and the right-hand side in `correction`.
    fn gather_residual(&mut self, shape: &Prototype, context: &StepContext) {
        self.apply_stiffness(shape);
        let theta = context.weights.stiffness;
        for ((r, load), elastic) in self.correction.iter_mut().zip(&self.load).zip(&self.elastic) {
            *r = load - theta * elastic;
        }
    }

    /// elastic ← K w + ∫Bᵀσ₀ for w in `displacement`, and what a nonlinear material adds.
    fn apply_stiffness(&mut self, shape: &Prototype) {
        shape.operator.stiffness_times(&self.displacement, &mut self.elastic);
        if let Some(initial) = &self.kept.initial_force {
            self.elastic.iter_mut().zip(initial).for_each(|(e, f)| *e += f);
        }
        if let Some(nonlinear) = &mut self.kept.nonlinear {
            nonlinear.find_excess(shape, &self.displacement);
            self.elastic.iter_mut().zip(&nonlinear.excess).for_each(|(e, f)| *e += f);
        }
    }

    /// Moves the terms of prescribed motion to the right-hand side; nothing to do for supports at rest.
    fn prescribe(&mut self, shape: &Prototype, context: &StepContext, rotation: &Mat3, position: &[Vec3]) {
        let on_stiffness = context.weights.stiffness + shape.damping.stiffness;
        let on_mass = context.weights.mass_per_s2;
        for (k, held) in moved(shape) {
            let goal = self.prescribed_correction(shape, context, rotation, position, k);
            for (i, stiffness, mass) in shape.operator.row(held.node as usize) {
                self.correction[i] -= on_stiffness * stiffness.tr_mul(&goal) + on_mass * mass * goal;
            }
        }
    }

    /// s of the k-th held node when its motion is prescribed, in the block's frame [m].
    fn prescribed_correction(
        &self,
        shape: &Prototype,
        context: &StepContext,
        rotation: &Mat3,
        position: &[Vec3],
        k: usize,
    ) -> Vec3 {
        let held = &shape.supports.held[k];
        let node = held.node as usize;
        let place = self.kept.anchor[k] + displacement_at(shape, held.motion, context.end_s);
        let goal = rotation.tr_mul(&(place - position[node] - self.predicted[node]));
        onto(&held.held, &goal)
    }

    /// unknowns ← K̃⁻¹ unknowns.
    fn solve(&mut self, shape: &Prototype) -> Result<(), SolveError> {
        match &shape.factor {
            Some(factor) => factor.solve_in_place(&mut self.unknowns, &mut self.scratch),
            None => Ok(()),
        }
    }

    fn finish_prescribed(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        rotation: &Mat3,
        position: &[Vec3],
    ) {
        for (k, held) in moved(shape) {
            let goal = self.prescribed_correction(shape, context, rotation, position, k);
            self.correction[held.node as usize] += goal;
        }
    }

    /// f_int ← R (K (w + s) + ∫Bᵀσ₀) at the end of the step, where it will be needed.
    fn update_internal_force(&mut self, shape: &Prototype, rotation: &Mat3, internal_force: &mut [Vec3]) {
        if shape.is_free() && internal_force.is_empty() {
            return;
        }
        self.displacement.iter_mut().zip(&self.correction).for_each(|(w, s)| *w += s);
        self.apply_stiffness(shape);
        for (internal, elastic) in internal_force.iter_mut().zip(&self.elastic) {
            *internal = rotation * elastic;
        }
    }
}

/// The part of `v` along a direction, or all of it.
fn along(direction: Option<&Vec3>, v: &Vec3) -> Vec3 {
    direction.map_or(*v, |n| n * n.dot(v))
}

/// The part of `v` in the span of orthonormal directions.
fn onto(directions: &[Vec3], v: &Vec3) -> Vec3 {
    directions.iter().map(|n| n * n.dot(v)).sum()
}

/// Held nodes whose motion is prescribed, with their place in the list.
fn moved(shape: &Prototype) -> impl Iterator<Item = (usize, &HeldNode)> {
    shape.supports.held.iter().enumerate().filter(|(_, held)| held.motion.is_some())
}
