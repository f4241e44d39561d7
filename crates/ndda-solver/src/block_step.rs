//! One step of one block, alone: predict, turn into its frame, solve, correct.

use ndda_fem::loads::initial_stress_force;
use ndda_fem::{FrameError, Voigt};
use ndda_mesh::{Mat3, Vec3};

use crate::for_each_block::NodeSlices;
use crate::linear_solver::Scratch;
use crate::shape::Shape;
use crate::time_integrator::{StepWeights, TimeIntegrator};

/// Why a block could not take a step.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BlockError {
    /// The shape has no rotation any more.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A velocity is beyond what the material can carry, or not a number (invariant I1).
    #[error(
        "node {node} moves at {speed_m_s:e} m/s, more than ten times its wave speed {wave_speed_m_s:e} m/s: \
         reduce step_s, or the penalty if contact is stiff"
    )]
    TooFast {
        /// The node, counted from the block's first.
        node: usize,
        /// Its speed [m/s].
        speed_m_s: f64,
        /// Wave speed of the material [m/s].
        wave_speed_m_s: f64,
    },
}

/// What a block step needs besides the block itself.
pub struct StepContext<'a> {
    /// The integrator.
    pub integrator: &'a dyn TimeIntegrator,
    /// Its weights for this step.
    pub weights: StepWeights,
    /// Δt [s].
    pub dt_s: f64,
    /// Time at the start of the step [s].
    pub time_s: f64,
    /// Time at the end of the step [s].
    pub end_s: f64,
    /// Where contact was evaluated, x* per node of the block [m].
    pub contact_position: &'a [Vec3],
    /// Force per node of the block, contact and constant loads [N].
    pub force: &'a [Vec3],
    /// The constant loads in it [N].
    pub external: &'a [Vec3],
    /// Friction's part of it [N]; empty without friction.
    pub friction_force: &'a [Vec3],
    /// Row sums of the contact stiffness [N/m]; empty without contact.
    pub contact_stiffness: &'a [f64],
}

/// What a block reports of its step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlockReport {
    /// Force that supports exerted on the block [N].
    pub reaction: Vec3,
    /// Torque about the origin of that force, at mid-step, and of the constant loads, at x* [N m].
    pub outside_torque: Vec3,
    /// Work of prescribed motions [J].
    pub motion_work_j: f64,
    /// Work of friction [J].
    pub friction_work_j: f64,
    /// Fastest node [m/s].
    pub speed_m_s: f64,
    /// Largest Σ|k| / m over the nodes [1/s²]: a bound of ω_c².
    pub contact_rate2: f64,
}

/// Memory of one block: sized once, written every step.
pub struct Body {
    /// Index of its shape.
    pub shape: usize,
    /// ∫ Bᵀ σ₀ in the block's frame [N].
    pub initial_force: Option<Vec<Vec3>>,
    /// σ₀ [Pa].
    pub initial_stress_pa: Option<Voigt>,
    /// Where the held nodes started [m], one entry per held node, then one per spring.
    anchor: Vec<Vec3>,
    predicted: Vec<Vec3>,
    load: Vec<Vec3>,
    displacement: Vec<Vec3>,
    correction: Vec<Vec3>,
    unknowns: Vec<f64>,
    scratch: Scratch,
    /// What it reports of the last step.
    pub report: BlockReport,
    /// Why the last step failed.
    pub error: Option<BlockError>,
}

impl Body {
    /// Memory for a block of this shape that rests at `position`.
    pub fn new(index: usize, shape: &Shape, initial: Option<Voigt>, position: &[Vec3]) -> Self {
        let nodes = shape.operator.nodes();
        let held = shape.supports.held.iter().map(|h| position[h.node as usize]);
        let sprung = shape.supports.springs.iter().map(|s| position[s.node as usize]);
        Self {
            shape: index,
            initial_force: initial.map(|stress| initial_stress_force(&shape.operator, &stress)),
            initial_stress_pa: initial,
            anchor: held.chain(sprung).collect(),
            predicted: vec![Vec3::zeros(); nodes],
            load: vec![Vec3::zeros(); nodes],
            displacement: vec![Vec3::zeros(); nodes],
            correction: vec![Vec3::zeros(); nodes],
            unknowns: vec![0.0; shape.unknowns.len()],
            scratch: shape.factor.as_ref().map_or_else(Vec::new, |f| f.new_scratch()),
            report: BlockReport::default(),
            error: None,
        }
    }

    /// Advances the block by one step:  u = û + R K̃⁻¹ [Rᵀ f − K w − ∫Bᵀσ₀],  w = Rᵀ(x̂ − c) − X,  x̂ = x + θ û.
    ///
    /// For R = I this is the paper's eqs (11)–(13). R is taken at x̂: taken at x it would let a spinning block gain
    /// angular momentum.
    ///
    /// # Errors
    /// [`BlockError`] when the block has lost its shape or its speed.
    pub fn step(
        &mut self,
        shape: &Shape,
        context: &StepContext,
        nodes: NodeSlices,
    ) -> Result<(), BlockError> {
        let NodeSlices { position, velocity, acceleration } = nodes;
        self.report = BlockReport::default();
        self.predict(context, position, velocity, acceleration);
        // x̂ is kept in `displacement` until w replaces it.
        let center = shape.operator.center(&self.displacement);
        let rotation = shape.supports.frame.rotation(&shape.operator, &self.displacement, &center)?;
        self.gather_load(shape, context, &rotation);
        self.turn_into_frame(shape, &rotation, &center);
        self.add_internal_force(shape);
        self.prescribe(shape, context, &rotation, position);
        self.solve(shape);
        if shape.is_free() {
            self.balance_momentum(shape, context, &rotation, position);
        } else {
            self.collect_reaction(shape, context, &rotation, position);
        }
        self.advance(shape, context, &rotation, position, velocity, acceleration)
    }

    /// û and x̂ = x + θ û.
    fn predict(
        &mut self,
        context: &StepContext,
        position: &[Vec3],
        velocity: &[Vec3],
        acceleration: &[Vec3],
    ) {
        let theta = context.weights.stiffness;
        for i in 0..position.len() {
            self.predicted[i] = context.integrator.predict(context.dt_s, &velocity[i], &acceleration[i]);
            self.displacement[i] = position[i] + theta * self.predicted[i];
        }
    }

    /// Rᵀ (f + springs at x̂).
    fn gather_load(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3) {
        self.load.copy_from_slice(context.force);
        let theta_time = context.time_s + context.weights.stiffness * (context.end_s - context.time_s);
        let anchors = &self.anchor[shape.supports.held.len()..];
        for (spring, anchor) in shape.supports.springs.iter().zip(anchors) {
            let node = spring.node as usize;
            let moved =
                spring.motion.map_or(Vec3::zeros(), |m| shape.supports.motions[m].displacement(theta_time));
            let stretch = along(spring.along.as_ref(), &(self.displacement[node] - anchor - moved));
            self.load[node] -= spring.stiffness_n_m * stretch;
        }
        for load in &mut self.load {
            *load = rotation.tr_mul(load);
        }
    }

    /// w = Rᵀ (x̂ − c) − X.
    fn turn_into_frame(&mut self, shape: &Shape, rotation: &Mat3, center: &Vec3) {
        for (w, rest) in self.displacement.iter_mut().zip(&shape.operator.rest) {
            *w = rotation.tr_mul(&(*w - center)) - rest;
        }
    }

    /// Right-hand side Rᵀ f − K w − ∫Bᵀσ₀, left in `correction`.
    fn add_internal_force(&mut self, shape: &Shape) {
        shape.operator.stiffness_times(&self.displacement, &mut self.correction);
        for (i, r) in self.correction.iter_mut().enumerate() {
            *r = self.load[i] - *r - self.initial_force.as_ref().map_or(Vec3::zeros(), |f| f[i]);
        }
    }

    /// Moves the terms of prescribed motion to the right-hand side; nothing to do for supports at rest.
    fn prescribe(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, position: &[Vec3]) {
        for held in shape.supports.held.iter().filter(|h| h.motion.is_some()) {
            let j = held.node as usize;
            let goal = rotation.tr_mul(
                &(self.prescribed_increment(shape, context, held.node, position) - self.predicted[j]),
            );
            let goal: Vec3 = held.held.iter().map(|n| n * n.dot(&goal)).sum();
            for (i, stiffness, mass) in shape.operator.row(j) {
                let coupling = context.weights.stiffness * stiffness.transpose() * goal
                    + context.weights.mass_per_s2 * mass * goal;
                self.correction[i] -= coupling;
            }
        }
    }

    /// u of a node with prescribed motion [m].
    fn prescribed_increment(
        &self,
        shape: &Shape,
        context: &StepContext,
        node: u32,
        position: &[Vec3],
    ) -> Vec3 {
        let index = shape.supports.held.binary_search_by_key(&node, |h| h.node).expect("a held node");
        let held = &shape.supports.held[index];
        let displacement =
            held.motion.map_or(Vec3::zeros(), |m| shape.supports.motions[m].displacement(context.end_s));
        self.anchor[index] + displacement - position[node as usize]
    }

    /// s = K̃⁻¹ r over the unknowns; held components stay zero.
    fn solve(&mut self, shape: &Shape) {
        shape.unknowns.gather(&self.correction, &mut self.unknowns);
        if let Some(factor) = &shape.factor {
            factor.solve_in_place(&mut self.unknowns, &mut self.scratch);
        }
        self.correction.fill(Vec3::zeros());
        shape.unknowns.scatter(&self.unknowns, &mut self.correction);
    }

    /// Gives the step exactly the momentum and angular momentum that outside forces bring.
    ///
    /// Internal forces of a corotated frame have no resultant but, to second order in the strain, a torque. It is
    /// taken out as the rigid motion t + ω × y with  c m t = Σ g − c Σ m s  and  c I ω = Σ y* × g − c Σ y × M s,
    /// where g = Rᵀ f, y* the places of contact and y the places at mid-step, both from their mass centre. Arms
    /// at x* make the total exact: contact forces have no torque there.
    fn balance_momentum(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, position: &[Vec3]) {
        let (operator, c) = (&shape.operator, context.weights.mass_per_s2);
        let missing = self.load.iter().sum::<Vec3>() - c * operator.momentum(&self.correction);
        let shift = missing / (c * operator.mass_kg);
        self.correction.iter_mut().for_each(|s| *s += shift);

        let contact_center = operator.center(context.contact_position);
        let arms = context.contact_position.iter().zip(&self.load);
        let torque: Vec3 = arms.map(|(x, g)| rotation.tr_mul(&(x - contact_center)).cross(g)).sum();
        // Two passes: the first changes the arms of the second by its own small size.
        for _ in 0..2 {
            // Arms at mid-step replace w, which is not needed any more.
            for (i, x) in position.iter().enumerate() {
                let middle = x + 0.5 * self.predicted[i];
                self.displacement[i] = rotation.tr_mul(&(middle - contact_center)) + 0.5 * self.correction[i];
            }
            let center = operator.center(&self.displacement);
            self.displacement.iter_mut().for_each(|y| *y -= center);
            let spin = operator.angular_momentum(&Vec3::zeros(), &self.displacement, &self.correction);
            let inertia = c * operator.inertia(&self.displacement);
            let Some(inverse) = inertia.try_inverse() else { return };
            let turn = inverse * (torque - c * spin);
            for (s, y) in self.correction.iter_mut().zip(&self.displacement) {
                *s += turn.cross(y);
            }
        }
    }

    /// What supports must exert for the held components and springs to do as they do.
    fn collect_reaction(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, position: &[Vec3]) {
        let StepWeights { stiffness: theta, mass_per_s2: c, .. } = context.weights;
        for held in shape.supports.held.iter().filter(|h| h.motion.is_some()) {
            let j = held.node as usize;
            let goal = rotation.tr_mul(
                &(self.prescribed_increment(shape, context, held.node, position) - self.predicted[j]),
            );
            self.correction[j] += held.held.iter().map(|n| n * n.dot(&goal)).sum::<Vec3>();
        }
        for held in &shape.supports.held {
            let i = held.node as usize;
            let mut inertia = Vec3::zeros();
            let mut elastic = self.initial_force.as_ref().map_or(Vec3::zeros(), |f| f[i]);
            for (j, stiffness, mass) in shape.operator.row(i) {
                inertia += c * mass * self.correction[j];
                elastic += stiffness * (self.displacement[j] + theta * self.correction[j]);
            }
            let unbalanced = inertia + elastic - self.load[i];
            let reaction = rotation * held.held.iter().map(|n| n * n.dot(&unbalanced)).sum::<Vec3>();
            let increment = self.predicted[i] + rotation * self.correction[i];
            self.add_reaction(&reaction, &(position[i] + 0.5 * increment));
            if held.motion.is_some() {
                self.report.motion_work_j += reaction.dot(&increment);
            }
        }
        self.collect_springs(shape, context, rotation, position);
    }

    fn collect_springs(&mut self, shape: &Shape, context: &StepContext, rotation: &Mat3, position: &[Vec3]) {
        let theta = context.weights.stiffness;
        let theta_time = context.time_s + theta * (context.end_s - context.time_s);
        for (k, spring) in shape.supports.springs.iter().enumerate() {
            let i = spring.node as usize;
            let motion = spring.motion.map(|m| &shape.supports.motions[m]);
            let moved = motion.map_or(Vec3::zeros(), |m| m.displacement(theta_time));
            let increment = self.predicted[i] + rotation * self.correction[i];
            let place = position[i] + theta * increment;
            let anchor = self.anchor[shape.supports.held.len() + k];
            let reaction = -spring.stiffness_n_m * along(spring.along.as_ref(), &(place - anchor - moved));
            self.add_reaction(&reaction, &(position[i] + 0.5 * increment));
            if let Some(motion) = motion {
                let travel = motion.displacement(context.end_s) - motion.displacement(context.time_s);
                self.report.motion_work_j += reaction.dot(&travel);
            }
        }
    }

    fn add_reaction(&mut self, reaction: &Vec3, place: &Vec3) {
        self.report.reaction += reaction;
        self.report.outside_torque += place.cross(reaction);
    }

    /// u = û + R s; velocities, accelerations and positions at the end of the step; what the step did.
    fn advance(
        &mut self,
        shape: &Shape,
        context: &StepContext,
        rotation: &Mat3,
        position: &mut [Vec3],
        velocity: &mut [Vec3],
        acceleration: &mut [Vec3],
    ) -> Result<(), BlockError> {
        let report = &mut self.report;
        let mut fastest = (0.0, 0);
        for i in 0..position.len() {
            let predicted = self.predicted[i];
            let u = predicted + rotation * self.correction[i];
            context.integrator.correct(context.dt_s, &u, &predicted, &mut velocity[i], &mut acceleration[i]);
            position[i] += u;
            report.outside_torque += context.contact_position[i].cross(&context.external[i]);
            let speed = velocity[i].norm_squared();
            // A NaN speed must win, too.
            if speed > fastest.0 || speed.is_nan() {
                fastest = (speed, i);
            }
            if let Some(friction) = context.friction_force.get(i) {
                report.friction_work_j += friction.dot(&u);
            }
            if let Some(stiffness) = context.contact_stiffness.get(i) {
                report.contact_rate2 = report.contact_rate2.max(stiffness / shape.operator.node_mass[i]);
            }
        }
        for held in shape.supports.held.iter().filter(|h| h.motion.is_some()) {
            follow_motion(held, &self.predicted, rotation, &self.correction, context, velocity, acceleration);
        }
        report.speed_m_s = fastest.0.sqrt();
        let wave_speed_m_s = shape.material.wave_speed_m_s();
        let (node, speed_m_s) = (fastest.1, report.speed_m_s);
        if speed_m_s.is_nan() || speed_m_s >= 10.0 * wave_speed_m_s {
            return Err(BlockError::TooFast { node, speed_m_s, wave_speed_m_s });
        }
        Ok(())
    }

    /// Elastic energy at `position`, ½ wᵀ K w + wᵀ ∫Bᵀσ₀ [J], and w left in the returned slice.
    ///
    /// # Errors
    /// [`FrameError`] when the block has no rotation any more.
    pub fn strain_energy_j(&mut self, shape: &Shape, position: &[Vec3]) -> Result<f64, FrameError> {
        let rotation = self.recover_displacement(shape, position)?;
        debug_assert!(rotation.determinant() > 0.0);
        shape.operator.stiffness_times(&self.displacement, &mut self.correction);
        let initial = |i: usize| self.initial_force.as_ref().map_or(Vec3::zeros(), |f| f[i]);
        let terms = self.displacement.iter().zip(&self.correction).enumerate();
        Ok(terms.map(|(i, (w, kw))| w.dot(&(0.5 * kw + initial(i)))).sum())
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

/// Velocity of a moved node: its mean over the step, which does not ring where the table has a kink.
fn follow_motion(
    held: &ndda_fem::supports::HeldNode,
    predicted: &[Vec3],
    rotation: &Mat3,
    correction: &[Vec3],
    context: &StepContext,
    velocity: &mut [Vec3],
    acceleration: &mut [Vec3],
) {
    let i = held.node as usize;
    let mean = (predicted[i] + rotation * correction[i]) / context.dt_s;
    for n in &held.held {
        velocity[i] += n * n.dot(&(mean - velocity[i]));
        acceleration[i] -= n * n.dot(&acceleration[i]);
    }
}
