//! The step of a block that deforms: predict, turn into its frame, solve, correct.

use ndda_fem::loads::{InitialStress, initial_stress_force};
use ndda_fem::supports::HeldNode;
use ndda_fem::{FrameError, Voigt};
use ndda_mesh::{Mat3, Vec3};

use crate::body::{BlockError, BlockReport, BodyKind, StepContext, checked_speed, displacement_at};
use crate::contact_moments::{Path, spin_torque};
use crate::for_each_block::{NodeSlices, Nodes};
use crate::linear_solver::{Scratch, SolveError};
use crate::shape::Shape;
use crate::stiffness_damping::StiffnessDamping;
use crate::time_integrator::StepWeights;

/// Memory of one block that deforms: sized once, written every step.
pub struct ElasticBody {
    /// ∫ Bᵀ σ₀ in the block's frame [N].
    pub initial_force: Option<Vec<Vec3>>,
    /// σ₀ of each element [Pa]; empty without.
    pub initial_stress_pa: Vec<Voigt>,
    /// Where the held nodes started [m], one entry per held node, then one per spring.
    anchor: Vec<Vec3>,
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
    /// Rigid part of u that keeps the books of momentum [m]; zero for supported blocks.
    rigid: Vec<Vec3>,
    /// R of the last step.
    rotation: Mat3,
    pub(crate) unknowns: Vec<f64>,
    pub(crate) scratch: Scratch,
    /// Memory for damping in proportion to stiffness.
    pub(crate) damping: Option<Box<StiffnessDamping>>,
    report: BlockReport,
}

impl ElasticBody {
    /// Memory for a block of this shape that rests at `position`.
    pub fn new(shape: &Shape, initial: Option<&InitialStress>, position: &[Vec3]) -> Self {
        let initial_stress_pa = initial.map_or(Vec::new(), |s| s.of_elements(&shape.operator, position));
        let initial_force = initial.map(|_| initial_stress_force(&shape.operator, &initial_stress_pa));
        let zeros = || vec![Vec3::zeros(); shape.operator.nodes()];
        let held = shape.supports.held.iter().map(|h| position[h.node as usize]);
        let sprung = shape.supports.springs.iter().map(|s| position[s.node as usize]);
        Self {
            initial_force,
            initial_stress_pa,
            anchor: held.chain(sprung).collect(),
            predicted: zeros(),
            load: zeros(),
            displacement: zeros(),
            correction: zeros(),
            elastic: zeros(),
            rigid: zeros(),
            rotation: Mat3::identity(),
            unknowns: vec![0.0; shape.unknowns.len()],
            scratch: shape.factor.as_ref().map_or_else(Scratch::default, |f| f.new_scratch()),
            damping: StiffnessDamping::new(shape),
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
    pub fn step(
        &mut self,
        shape: &Shape,
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
    pub fn finish(
        &mut self,
        shape: &Shape,
        context: &StepContext,
        mut nodes: NodeSlices,
    ) -> Result<BlockReport, BlockError> {
        self.report = BlockReport::default();
        self.place_correction(shape, context, &nodes.view());
        let rotation = self.rotation;
        if let Some(damping) = &mut self.damping {
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
    pub fn try_step(
        &mut self,
        shape: &Shape,
        context: &StepContext,
        nodes: &Nodes,
    ) -> Result<(), BlockError> {
        self.prepare(shape, context, nodes)?;
        self.solve(shape)?;
        self.place_correction(shape, context, nodes);
        self.turn_back(&self.rotation.clone());
        Ok(())
    }

    /// u as last tried [m].
    pub fn increment(&self) -> &[Vec3] {
        &self.correction
    }

    /// Velocities at the end of the step as last tried [m/s].
    pub fn end_velocity(&self, context: &StepContext, nodes: &Nodes, out: &mut [Vec3]) {
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
    pub fn respond_in_place(&mut self, shape: &Shape, force: &mut [Vec3]) -> Result<(), BlockError> {
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
    pub fn prepare(&mut self, shape: &Shape, context: &StepContext, nodes: &Nodes) -> Result<(), BlockError> {
        self.predict(context, nodes);
        // x + û is kept in `displacement` until w replaces it.
        let center = shape.operator.center(&self.displacement);
        let rotation = shape.supports.frame.rotation(&shape.operator, &self.displacement, &center)?;
        self.rotation = rotation;
        self.gather_load(shape, context, &rotation, nodes);
        self.turn_into_frame(shape, &rotation, &center);
        if let Some(damping) = &mut self.damping {
            damping.load(shape, nodes.position, &self.displacement, &mut self.load)?;
        }
        self.gather_residual(shape, context);
        self.prescribe(shape, context, &rotation, nodes.position);
        shape.unknowns.gather(&self.correction, &mut self.unknowns);
        Ok(())
    }

    /// s from `unknowns` as solved, prescribed motions included; held components stay zero.
    fn place_correction(&mut self, shape: &Shape, context: &StepContext, nodes: &Nodes) {
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
    fn gather_load(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, nodes: &Nodes) {
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
        for load in &mut self.load {
            *load = rotation.tr_mul(load);
        }
    }

    /// Force of the k-th spring at x + θ û [N]; what u adds to it is in K̃.
    fn pull_of_spring(&self, shape: &Shape, context: &StepContext, k: usize, position: &[Vec3]) -> Vec3 {
        let spring = &shape.supports.springs[k];
        let node = spring.node as usize;
        let place = position[node] + context.weights.stiffness * self.predicted[node];
        let anchor = self.anchor[shape.supports.held.len() + k];
        let stretch = place - anchor - displacement_at(shape, spring.motion, context.theta_time_s());
        -spring.stiffness_n_m * along(spring.along.as_ref(), &stretch)
    }

    /// w = Rᵀ (x − c) − X for the positions in `displacement`.
    fn turn_into_frame(&mut self, shape: &Shape, rotation: &Mat3, center: &Vec3) {
        for (w, rest) in self.displacement.iter_mut().zip(&shape.operator.rest) {
            *w = rotation.tr_mul(&(*w - center)) - rest;
        }
    }

    /// K w + ∫Bᵀσ₀, and the right-hand side in `correction`.
    fn gather_residual(&mut self, shape: &Shape, context: &StepContext) {
        self.apply_stiffness(shape);
        let theta = context.weights.stiffness;
        for ((r, load), elastic) in self.correction.iter_mut().zip(&self.load).zip(&self.elastic) {
            *r = load - theta * elastic;
        }
    }

    /// elastic ← K w + ∫Bᵀσ₀ for w in `displacement`.
    fn apply_stiffness(&mut self, shape: &Shape) {
        shape.operator.stiffness_times(&self.displacement, &mut self.elastic);
        if let Some(initial) = &self.initial_force {
            self.elastic.iter_mut().zip(initial).for_each(|(e, f)| *e += f);
        }
    }

    /// Moves the terms of prescribed motion to the right-hand side; nothing to do for supports at rest.
    fn prescribe(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, position: &[Vec3]) {
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
        shape: &Shape,
        context: &StepContext,
        rotation: &Mat3,
        position: &[Vec3],
        k: usize,
    ) -> Vec3 {
        let held = &shape.supports.held[k];
        let node = held.node as usize;
        let place = self.anchor[k] + displacement_at(shape, held.motion, context.end_s);
        let goal = rotation.tr_mul(&(place - position[node] - self.predicted[node]));
        onto(&held.held, &goal)
    }

    /// unknowns ← K̃⁻¹ unknowns.
    fn solve(&mut self, shape: &Shape) -> Result<(), SolveError> {
        match &shape.factor {
            Some(factor) => factor.solve_in_place(&mut self.unknowns, &mut self.scratch),
            None => Ok(()),
        }
    }

    fn finish_prescribed(
        &mut self,
        shape: &Shape,
        context: &StepContext,
        rotation: &Mat3,
        position: &[Vec3],
    ) {
        for (k, held) in moved(shape) {
            let goal = self.prescribed_correction(shape, context, rotation, position, k);
            self.correction[held.node as usize] += goal;
        }
    }

    /// f_int ← R (K (w + s) + ∫Bᵀσ₀) at the end of the step, where somebody will ask for it.
    fn update_internal_force(&mut self, shape: &Shape, rotation: &Mat3, internal_force: &mut [Vec3]) {
        if shape.is_free() && internal_force.is_empty() {
            return;
        }
        self.displacement.iter_mut().zip(&self.correction).for_each(|(w, s)| *w += s);
        self.apply_stiffness(shape);
        for (internal, elastic) in internal_force.iter_mut().zip(&self.elastic) {
            *internal = rotation * elastic;
        }
    }

    /// What supports must exert for held components and springs to do as they do.
    fn collect_reactions(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, nodes: &Nodes) {
        self.collect_springs(shape, context, rotation, nodes);
        if shape.kind == BodyKind::Affine {
            return self.collect_as_a_whole(shape, context, rotation, nodes);
        }
        for held in &shape.supports.held {
            let i = held.node as usize;
            let reaction = rotation * onto(&held.held, &self.unbalanced(shape, context, i));
            let increment = self.predicted[i] + rotation * self.correction[i];
            self.add_reaction(&reaction, &(nodes.position[i] + 0.5 * increment));
            if held.motion.is_some() {
                self.report.motion_work_j += reaction.dot(&increment);
            }
        }
    }

    /// The same of a block that is kept affine: what keeps it so acts on each node, but has no resultant and no torque, so that of all
    /// nodes together is that of the supports.
    fn collect_as_a_whole(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, nodes: &Nodes) {
        for i in 0..shape.operator.nodes() {
            let force = rotation * self.unbalanced(shape, context, i);
            let increment = self.predicted[i] + rotation * self.correction[i];
            self.add_reaction(&force, &(nodes.position[i] + 0.5 * increment));
        }
    }

    /// Force on a node that its equation of motion lacks, in the block's frame [N].
    fn unbalanced(&self, shape: &Shape, context: &StepContext, node: usize) -> Vec3 {
        let StepWeights { stiffness: theta, mass_per_s2: c, .. } = context.weights;
        let b = shape.damping.stiffness;
        let inertia = shape.operator.row(node).fold(Vec3::zeros(), |sum, (j, stiffness, mass)| {
            let drag = if b > 0.0 { b * (stiffness * self.correction[j]) } else { Vec3::zeros() };
            sum + c * mass * self.correction[j] + drag
        });
        inertia + theta * self.elastic[node] - self.load[node]
    }

    /// Forces of the springs at x + θ u; what u adds to them also goes to `load`, for nodes that are held, too. Those of an affine block
    /// leave `load`, to be found as what it lacks as a whole: its unknowns move all nodes, and round as the stiffest spring does.
    fn collect_springs(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, nodes: &Nodes) {
        let theta = context.weights.stiffness;
        for (k, spring) in shape.supports.springs.iter().enumerate() {
            let i = spring.node as usize;
            let turned = rotation * self.correction[i];
            let increment = self.predicted[i] + turned;
            // As it is solved for: a stiff spring would feel the last digit of x + u.
            let added = -spring.stiffness_n_m * theta * along(spring.along.as_ref(), &turned);
            let pull = self.pull_of_spring(shape, context, k, nodes.position);
            let reaction = pull + added;
            if shape.kind == BodyKind::Affine {
                self.load[i] -= rotation.tr_mul(&pull);
            } else {
                self.load[i] += rotation.tr_mul(&added);
                self.add_reaction(&reaction, &(nodes.position[i] + 0.5 * increment));
            }
            let travel = displacement_at(shape, spring.motion, context.end_s)
                - displacement_at(shape, spring.motion, context.time_s);
            self.report.motion_work_j += reaction.dot(&travel);
        }
    }

    fn add_reaction(&mut self, reaction: &Vec3, place: &Vec3) {
        self.report.reaction += reaction;
        self.report.outside_torque += place.cross(reaction);
    }

    /// u = û + R s.
    fn turn_back(&mut self, rotation: &Mat3) {
        for (s, predicted) in self.correction.iter_mut().zip(&self.predicted) {
            *s = predicted + rotation * *s;
        }
    }

    /// Gives a free block exactly the momentum and angular momentum that outside forces bring.
    ///
    /// Internal forces of a corotated frame have no resultant but, to second order in the strain, a torque. It is
    /// taken out by a rigid part of u, t + ω × z, such that c Σ m (u − û) = Σ f − α_m Σ M a₀ and
    /// Σ y × M (v₁ − v₀) + Σ u × M (½ (v₀ + v₁) − u/Δt) = Δt Σ y* × f,
    /// y at mid-step, z at its end and y* at x*, all from their mass centre. The left side is the change of angular momentum;
    /// arms at x* keep the total of all blocks exact, since contact forces have no torque there. What the right side is
    /// where contact is not taken in the middle of the step, see [`spin_torque`].
    fn balance_momentum(&mut self, shape: &Shape, context: &StepContext, nodes: &Nodes) {
        let (operator, c) = (&shape.operator, context.weights.mass_per_s2);
        let total: Vec3 = context.force.iter().sum();
        let had = operator.momentum(&self.correction) - operator.momentum(&self.predicted);
        let missing = total - context.weights.old_inertia * context.inertia.force - c * had;
        let shift = missing / (c * operator.mass_kg);
        self.correction.iter_mut().for_each(|u| *u += shift);

        let center = operator.center(context.contact_position);
        let arms = context.contact_position.iter().zip(context.force);
        let mut torque: Vec3 = arms.map(|(x, f)| (x - center).cross(f)).sum();
        let drag_moment = &mut self.report.impulse_moment;
        if context.weights.contact_in_the_middle() {
            let place = || operator.center(nodes.position);
            let old = || operator.angular_momentum(&place(), nodes.position, nodes.velocity);
            *drag_moment = context.drag_moment(&torque, old);
            torque += *drag_moment / context.dt_s;
        } else {
            let gone = operator.momentum(&self.correction) / operator.mass_kg;
            let (center, velocity_m_s) = (operator.center(nodes.position), operator.center(nodes.velocity));
            let path = Path { center, velocity_m_s, gone };
            let spin = || operator.angular_momentum(&center, nodes.position, nodes.velocity);
            torque = spin_torque(shape, context, &path, (&total, &torque), spin, &mut self.report);
        }
        self.rigid.fill(Vec3::zeros());
        let mut inverse_inertia = None;
        // A pass changes the arms of the next by its own small size.
        let passes = if context.weights.mean_velocity { 2 } else { 4 };
        for _ in 0..passes {
            let missing = context.dt_s * torque - self.angular_gain(shape, context, nodes);
            self.place_end_arms(shape);
            let inertia = || operator.inertia(&self.displacement, &self.elastic).try_inverse();
            let Some(inverse) = inverse_inertia.or_else(inertia) else { return };
            inverse_inertia = Some(inverse);
            let turn = inverse * missing / context.weights.velocity_per_m;
            for (r, z) in self.rigid.iter_mut().zip(&self.elastic) {
                *r += turn.cross(z);
            }
        }
    }

    /// elastic ← z, the arms at the end of the step: a turn about them stretches nothing.
    fn place_end_arms(&mut self, shape: &Shape) {
        for (i, z) in self.elastic.iter_mut().enumerate() {
            *z = self.displacement[i] + 0.5 * (self.correction[i] + self.rigid[i]);
        }
        let center = shape.operator.center(&self.elastic);
        self.elastic.iter_mut().for_each(|z| *z -= center);
    }

    /// Change of angular momentum about the mass centre that u brings [kg m²/s]; leaves y in `displacement` and
    /// v₁ − v₀ in `load`.
    fn angular_gain(&mut self, shape: &Shape, context: &StepContext, nodes: &Nodes) -> Vec3 {
        let (operator, rate) = (&shape.operator, context.weights.velocity_per_m);
        for (i, u) in self.correction.iter().enumerate() {
            let (mut velocity, mut acceleration) = (nodes.velocity[i], nodes.acceleration[i]);
            let predicted = &self.predicted[i];
            context.correct(u, predicted, &mut velocity, &mut acceleration);
            self.load[i] = velocity - nodes.velocity[i] + rate * self.rigid[i];
            self.displacement[i] = nodes.position[i] + 0.5 * (u + self.rigid[i]);
        }
        let center = operator.center(&self.displacement);
        self.displacement.iter_mut().for_each(|y| *y -= center);
        let mut gained = operator.angular_momentum(&Vec3::zeros(), &self.displacement, &self.load);
        if !context.weights.mean_velocity {
            for (i, u) in self.correction.iter().enumerate() {
                let mean = (u + self.rigid[i]) / context.dt_s;
                self.elastic[i] = nodes.velocity[i] + 0.5 * self.load[i] - mean;
            }
            let center = operator.momentum(&self.correction) / operator.mass_kg;
            gained += operator.angular_momentum(&center, &self.correction, &self.elastic);
            gained += operator.angular_momentum(&Vec3::zeros(), &self.rigid, &self.elastic);
        }
        gained
    }

    /// Velocities, accelerations and positions at the end of the step; nothing is written before all are sound.
    fn advance(
        &mut self,
        shape: &Shape,
        context: &StepContext,
        nodes: &mut NodeSlices,
    ) -> Result<(), BlockError> {
        let rate = context.weights.velocity_per_m;
        // v₁ and a₁ wait in `load` and `elastic`.
        for (i, u) in self.correction.iter_mut().enumerate() {
            let (mut v, mut a) = (nodes.velocity[i], nodes.acceleration[i]);
            context.correct(u, &self.predicted[i], &mut v, &mut a);
            (self.load[i], self.elastic[i]) = (v + rate * self.rigid[i], a);
            *u += self.rigid[i];
        }
        self.report.book_drag(shape, context, (&self.correction, nodes.velocity, &self.load));
        if moved(shape).next().is_some() {
            self.prescribe_velocities(shape, context, nodes.position);
        }
        self.filter_velocities(shape, context, &nodes.view())?;
        self.report.speed_m_s = checked_speed(shape, &self.load)?;
        for (i, u) in self.correction.iter().enumerate() {
            nodes.position[i] += u;
        }
        nodes.velocity.copy_from_slice(&self.load);
        nodes.acceleration.copy_from_slice(&self.elastic);
        self.report.book(shape, context, (&self.rotation, &self.correction));
        Ok(())
    }

    /// Gives moved nodes the mean velocity of the step, which does not ring where the table has a kink. What that changes of momentum
    /// and kinetic energy is an impulse and work of what moves them.
    fn prescribe_velocities(&mut self, shape: &Shape, context: &StepContext, position: &[Vec3]) {
        self.predicted.fill(Vec3::zeros());
        for (_, held) in moved(shape) {
            let i = held.node as usize;
            let mean = self.correction[i] / context.dt_s;
            self.predicted[i] = onto(&held.held, &(mean - self.load[i]));
            let a = self.elastic[i];
            self.elastic[i] -= onto(&held.held, &a);
        }
        for (i, change) in self.predicted.iter().enumerate() {
            let impulse = shape.operator.mass_row_times(i, &self.predicted);
            self.report.impulse += impulse;
            self.report.impulse_moment += (position[i] + self.correction[i]).cross(&impulse);
            self.report.motion_work_j += impulse.dot(&(self.load[i] + 0.5 * change));
        }
        self.load.iter_mut().zip(&self.predicted).for_each(|(v, change)| *v += change);
    }

    /// Filters what damping in proportion to stiffness leaves of the velocities in `load` and of the accelerations in `elastic`, and
    /// books that damping.
    fn filter_velocities(
        &mut self,
        shape: &Shape,
        context: &StepContext,
        start: &Nodes,
    ) -> Result<(), BlockError> {
        let Some(damping) = &mut self.damping else { return Ok(()) };
        self.report.damping_work_j += damping.work_j(shape);
        for ((end, x), u) in self.displacement.iter_mut().zip(start.position).zip(&self.correction) {
            *end = x + u;
        }
        let remembered = context.weights.needs_acceleration.then_some(&mut self.elastic[..]);
        damping.filter(shape, start, &self.displacement, (&mut self.load, remembered), &mut self.report)
    }

    /// Elastic energy at `position`, ½ wᵀ K w + wᵀ ∫Bᵀσ₀ [J].
    ///
    /// # Errors
    /// [`FrameError`] when the block has no rotation any more.
    pub fn strain_energy_j(&mut self, shape: &Shape, position: &[Vec3]) -> Result<f64, FrameError> {
        self.recover_displacement(shape, position)?;
        shape.operator.stiffness_times(&self.displacement, &mut self.elastic);
        let initial = |i: usize| self.initial_force.as_ref().map_or(Vec3::zeros(), |f| f[i]);
        let terms = self.displacement.iter().zip(&self.elastic).enumerate();
        Ok(terms.map(|(i, (w, kw))| w.dot(&(0.5 * kw + initial(i)))).sum())
    }

    /// The part of the velocity that elasticity turns over in a step, as the integrator has it, c Δt² K̃⁻¹ K v, mean square over
    /// the mass [m/s]: θ² v of a vibration that turns by θ = ω Δt, up to 4 v of one that `Midpoint` does not resolve at all.
    /// It is at most θ v of each, √(v·K v/m) Δt; where that is no more than `known_m_s`, nothing is solved and zero comes back.
    ///
    /// # Errors
    /// [`BlockError`] when the block has no rotation any more, or the solver does not get there.
    pub fn vibration_m_s(
        &mut self,
        shape: &Shape,
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
    pub fn recover_displacement(&mut self, shape: &Shape, position: &[Vec3]) -> Result<Mat3, FrameError> {
        let center = shape.operator.center(position);
        let rotation = shape.supports.frame.rotation(&shape.operator, position, &center)?;
        self.displacement.copy_from_slice(position);
        self.turn_into_frame(shape, &rotation, &center);
        Ok(rotation)
    }

    /// w = Rᵀ (x − c) − X as last recovered [m].
    pub fn displacement_in_frame(&self) -> &[Vec3] {
        &self.displacement
    }

    /// Energy stored in support springs at `position` and time [J].
    pub fn spring_energy_j(&self, shape: &Shape, position: &[Vec3], time_s: f64) -> f64 {
        let anchors = &self.anchor[shape.supports.held.len()..];
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

/// The part of `v` along a direction, or all of it.
fn along(direction: Option<&Vec3>, v: &Vec3) -> Vec3 {
    direction.map_or(*v, |n| n * n.dot(v))
}

/// The part of `v` in the span of orthonormal directions.
fn onto(directions: &[Vec3], v: &Vec3) -> Vec3 {
    directions.iter().map(|n| n * n.dot(v)).sum()
}

/// Held nodes whose motion is prescribed, with their place in the list.
fn moved(shape: &Shape) -> impl Iterator<Item = (usize, &HeldNode)> {
    shape.supports.held.iter().enumerate().filter(|(_, held)| held.motion.is_some())
}
