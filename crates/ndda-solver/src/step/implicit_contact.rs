//! Contact at the end of the step, solved for.
//!
//! A step is u = G(f): each block answers to the forces f on it alone. Contact at the end requires f = f_c(x + G(f)). It is
//! the minimum of the incremental potential Π(u) = ½ (u − û)·K̃ (u − û) + W_c(x + u) + …, whose gradient at x + G(f) is
//! f − f_c. So Newton's method works on the forces:
//!
//! ```text
//! (K̃ − ∂f_c/∂x) δ = f_c(x + G(f)) − f        f ← f + s K̃ δ
//! ```
//!
//! by conjugate gradients with the blocks' own factors as preconditioner: each iteration is one solve per block in
//! contact, no global matrix, and K̃ δ comes out of the recursion without a product. s follows the slope of Π along δ.
//! The forces of the last evaluation, not f, drive the step, so action equals reaction however far Newton got.

use std::ops::Range;

use ndda_contact::{ContactError, ContactHistory, ContactInput, ContactReport, PairStiffness};
use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::ExactSum;

use crate::bodies::body::Body;
use crate::bodies::congruent_groups::{NodeSlices, each_of_run, for_each_run};
use crate::diagnostics::block_sums::over_blocks;
use crate::error::StepError;
use crate::step::line_search::Search;
use crate::step::report::Iterations;
use crate::step::{GRAIN_NODES, Simulation};

/// How well contact at the end of the step is solved for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImplicitContact {
    /// Largest misfit of contact forces over the largest of contact forces and loads; what positions resolve is always
    /// enough.
    pub tolerance: f64,
    /// Evaluations of contact after which the step is given up.
    pub most_iterations: u32,
}

/// Evaluations of contact in which friction is found anew.
const FRICTION_EVALUATIONS: u32 = 30;
/// Reduction of the linear residual (squared) that a Newton step requires.
const KRYLOV_REDUCTION2: f64 = 1e-4;
/// Conjugate gradient steps after which a Newton step takes what it has.
const MOST_KRYLOV: u32 = 2000;
/// Longest stride along a direction whose length says nothing, for Π bends down along it.
const LONGEST_STRIDE: f64 = 64.0;

/// Memory of the iteration; none in steps with contact at predicted positions.
pub(crate) struct Newton {
    settings: ImplicitContact,
    /// f.
    force: Vec<Vec3>,
    /// Where f was when δ was found.
    start: Vec<Vec3>,
    /// δ and K̃ δ.
    change: Vec<Vec3>,
    k_delta: Vec<Vec3>,
    /// f_c − f, and what is left of it.
    residual: Vec<Vec3>,
    left: Vec<Vec3>,
    preconditioned: Vec<Vec3>,
    direction: Vec<Vec3>,
    direction_lifted: Vec<Vec3>,
    product: Vec<Vec3>,
    /// Mean velocity of the step, by which facets slip.
    velocity: Vec<Vec3>,
    /// Friction once it is held [N].
    friction: Vec<Vec3>,
    pairs: Vec<PairStiffness>,
    touched: Vec<bool>,
    history: ContactHistory,
    pub(crate) iterations: Iterations,
}

impl Newton {
    pub(crate) fn new(settings: ImplicitContact, nodes: usize, blocks: usize) -> Self {
        let zeros = || vec![Vec3::zeros(); nodes];
        Self {
            settings,
            force: zeros(),
            start: zeros(),
            change: zeros(),
            k_delta: zeros(),
            residual: zeros(),
            left: zeros(),
            preconditioned: zeros(),
            direction: zeros(),
            direction_lifted: zeros(),
            product: zeros(),
            velocity: zeros(),
            friction: zeros(),
            pairs: Vec::new(),
            touched: vec![false; blocks],
            history: ContactHistory::default(),
            iterations: Iterations::default(),
        }
    }
}

impl Simulation {
    /// f ← loads and the contact forces at the end of the step, x* ← where that is.
    pub(crate) fn solve_contact(&mut self, newton: &mut Newton) -> Result<ContactReport, StepError> {
        newton.history.clone_from(&self.state.contact);
        self.keep_bolts();
        newton.iterations = Iterations::default();
        let (mut stride, mut search) = (0.0, None::<Search>);
        newton.start.copy_from_slice(&self.state.contact_force);
        // A rigid block takes torques about x*: the first evaluation takes them where the blocks are, not where an
        // earlier step, or a part of one that was discarded, left x*.
        self.scratch.contact_position.copy_from_slice(&self.state.position);
        self.carry_by_blocks();
        newton.k_delta.fill(Vec3::zeros());
        loop {
            let evaluated = self.evaluate_at_end(newton, stride);
            newton.iterations.newton += 1;
            let report = match (evaluated, &mut search) {
                (Err(error), Some(search)) if went_too_far(&error) => {
                    stride = search.shorter(stride).ok_or(error)?;
                    continue;
                }
                (evaluated, _) => evaluated?,
            };
            self.precondition(newton)?;
            let misfit2 = self.dot(&newton.residual, &newton.preconditioned);
            let misfit = if misfit2.is_nan() { f64::NAN } else { misfit2.max(0.0).sqrt() };
            let scale = self.motion_of(&self.scratch.force).max(self.motion_of(&newton.force));
            let scale = scale.max(self.motion_of(self.loads.total()));
            if misfit <= (newton.settings.tolerance * scale).max(self.resolution()) {
                self.stop_past_centroid(&report)?;
                self.state.contact_force.copy_from_slice(&self.scratch.force);
                self.scratch.force.iter_mut().zip(self.loads.total()).for_each(|(f, load)| *f += load);
                return Ok(report);
            }
            if newton.iterations.newton >= newton.settings.most_iterations || misfit.is_nan() {
                let (time_s, residual) = (self.time_s(), misfit / scale);
                return Err(StepError::ContactNotSolved {
                    time_s,
                    iterations: newton.iterations.newton,
                    residual,
                });
            }
            let slope = -self.dot(&newton.residual, &newton.change);
            if let Some(next) = search.as_mut().and_then(|search| search.next_stride(stride, slope)) {
                stride = next;
                continue;
            }
            newton.start.copy_from_slice(&newton.force);
            let longest = self.find_change(newton)?;
            search = Some(Search::new(-self.dot(&newton.residual, &newton.change), longest));
            stride = 1.0;
        }
    }

    /// preconditioned ← K̃⁻¹ (f_c − f): what the misfit moves.
    fn precondition(&mut self, newton: &mut Newton) -> Result<(), StepError> {
        newton.left.copy_from_slice(&newton.residual);
        for (index, touched) in newton.touched.iter_mut().enumerate() {
            let range = self.problem.blocks.nodes_of(BlockId(index as u32));
            *touched = newton.left[range].iter().any(|q| *q != Vec3::zeros());
        }
        self.respond(newton)
    }

    /// √(f·u) of nodal forces f and the motion u that free nodes would make of them in a step [√J].
    ///
    /// The measure of misfits: forces that move nothing, as those that press a rigid block from all sides, are none.
    fn motion_of(&self, force: &[Vec3]) -> f64 {
        self.motion_by(|node| force[node].norm_squared())
    }

    /// Change of contact forces by the rounding of positions: no misfit is known better.
    fn resolution(&self) -> f64 {
        let rounding = |node: usize| f64::EPSILON * self.scratch.contact_position[node].amax();
        self.motion_by(|node| (self.scratch.contact_stiffness[node] * rounding(node)).powi(2))
    }

    /// [`motion_of`](Self::motion_of) the forces whose squares [N²] are given for each node.
    fn motion_by(&self, force2: impl Fn(usize) -> f64) -> f64 {
        let of_block = |block: BlockId| {
            let masses = &self.shape(block).operator.node_mass;
            self.problem.blocks.nodes_of(block).zip(masses).map(|(node, m)| force2(node) / m).sum::<f64>()
        };
        (self.problem.blocks.ids().map(of_block).collect::<ExactSum>().value() / self.weights.mass_per_s2)
            .sqrt()
    }

    /// f ← start + stride · K̃ δ, x* ← x + G(f), force ← f_c there, residual ← f_c − f.
    fn evaluate_at_end(&mut self, newton: &mut Newton, stride: f64) -> Result<ContactReport, StepError> {
        for ((f, start), k_delta) in newton.force.iter_mut().zip(&newton.start).zip(&newton.k_delta) {
            *f = start + stride * k_delta;
        }
        for ((sum, f), load) in self.scratch.force.iter_mut().zip(&newton.force).zip(self.loads.total()) {
            *sum = f + load;
        }
        self.try_blocks()?;
        let moved = self.scratch.contact_position.iter().zip(&self.state.position);
        let step_s = self.part_s;
        newton.velocity.iter_mut().zip(moved).for_each(|(v, (end, x))| *v = (end - x) / step_s);
        self.state.contact.clone_from(&newton.history);
        self.put_bolts_back();
        self.scratch.force.fill(Vec3::zeros());
        let report = self.add_contact_forces(Some(&newton.velocity))?;
        self.hold_friction(newton);
        // The rotations due to these forces agree among observers only together with the velocities of their pairs.
        self.carry_contact_forces();
        for ((q, contact), f) in newton.residual.iter_mut().zip(&self.scratch.force).zip(&newton.force) {
            *q = contact - f;
        }
        Ok(report)
    }

    /// Friction on velocities and the normal forces depend on each other, and Newton's matrix leaves this coupling out. After [`FRICTION_EVALUATIONS`] friction
    /// keeps the value of the last one, within the misfit of which it is known, and only the normal forces are looked for.
    fn hold_friction(&mut self, newton: &mut Newton) {
        if !self.contact.as_ref().is_some_and(|model| model.needs_bodies()) {
            return;
        }
        let evaluation = newton.iterations.newton + 1;
        if evaluation == FRICTION_EVALUATIONS {
            newton.friction.copy_from_slice(&self.scratch.friction_force);
        }
        if evaluation > FRICTION_EVALUATIONS {
            let friction = self.scratch.friction_force.iter_mut().zip(&newton.friction);
            for (force, (friction, held)) in self.scratch.force.iter_mut().zip(friction) {
                *force += held - *friction;
                *friction = *held;
            }
        }
    }

    /// x* ← x + G(force).
    fn try_blocks(&mut self) -> Result<(), StepError> {
        self.with_bodies(|simulation, bodies, slices| {
            let starts = simulation.blocks().node_starts();
            for_each_run(
                &simulation.problem.runs,
                bodies,
                starts,
                slices,
                GRAIN_NODES,
                &|first, run, slices| {
                    each_of_run(first, run, starts, slices, |index, body: &mut Body, nodes| {
                        let shape = &simulation.problem.shapes[body.shape];
                        body.try_step(shape, &simulation.context(index, shape), &nodes.view());
                    });
                },
            );
        });
        self.stop_if_a_block_failed()?;
        let end_s = self.clock_s(1.0);
        for (index, body) in self.bodies.iter().enumerate() {
            let range = self.problem.blocks.nodes_of(BlockId(index as u32));
            let shape = &self.problem.shapes[body.shape];
            let (x, ends) = (&self.state.position[range.clone()], &mut self.scratch.contact_position[range]);
            body.place_end(shape, end_s, x, ends);
        }
        Ok(())
    }

    /// δ and K̃ δ from the residual in `left` and what it moves in `preconditioned`, by conjugate gradients with K̃⁻¹ as
    /// preconditioner; returns how long a stride along it may be.
    fn find_change(&mut self, newton: &mut Newton) -> Result<f64, StepError> {
        self.gather_stiffness(newton)?;
        newton.change.fill(Vec3::zeros());
        newton.k_delta.fill(Vec3::zeros());
        newton.direction.copy_from_slice(&newton.preconditioned);
        newton.direction_lifted.copy_from_slice(&newton.left);
        let mut size = self.dot(&newton.left, &newton.preconditioned);
        let enough = KRYLOV_REDUCTION2 * size;
        for step in 0..MOST_KRYLOV {
            newton.iterations.krylov += 1;
            newton.multiply();
            let curvature = self.dot(&newton.direction, &newton.product);
            // Contact that softens as it deepens, and bonds that break, bend Π the other way: take what there is, at least the first direction.
            if curvature <= 0.0 {
                if step == 0 {
                    newton.change.copy_from_slice(&newton.direction);
                    newton.k_delta.copy_from_slice(&newton.direction_lifted);
                }
                return Ok(LONGEST_STRIDE);
            }
            let along = size / curvature;
            add(along, &newton.direction, &mut newton.change);
            add(along, &newton.direction_lifted, &mut newton.k_delta);
            add(-along, &newton.product, &mut newton.left);
            self.respond(newton)?;
            let next = self.dot(&newton.left, &newton.preconditioned);
            if next <= enough {
                break;
            }
            turn(next / size, &newton.preconditioned, &mut newton.direction);
            turn(next / size, &newton.left, &mut newton.direction_lifted);
            size = next;
        }
        Ok(1.0)
    }

    /// ∂f_c/∂x at x*, and which blocks it concerns.
    fn gather_stiffness(&mut self, newton: &mut Newton) -> Result<(), StepError> {
        newton.pairs.clear();
        let time_s = self.time_s();
        let Some(model) = &mut self.contact else { return Ok(()) };
        let input = ContactInput {
            blocks: &self.problem.blocks,
            position: &self.scratch.contact_position,
            velocity: &newton.velocity,
            dt_s: self.part_s,
            affine: &self.problem.affine,
            bodies: &self.scratch.contact_bodies,
            deformation: None,
            is_iterated: true,
            friction_tolerance: 0.0,
            without_friction: false,
            bonds_hold: true,
            ranks: self.ranks.partners(),
        };
        let found = model.add_stiffness(&input, &self.state.contact, &mut newton.pairs);
        found.map_err(|source| StepError::of_contact(time_s, source))?;
        for node in newton.pairs.iter().flat_map(|pair| pair.nodes) {
            newton.touched[self.problem.blocks.block_of(node).index()] = true;
        }
        Ok(())
    }

    /// a·b over all nodes, the same for any order of blocks.
    fn dot(&self, a: &[Vec3], b: &[Vec3]) -> f64 {
        let of_nodes =
            |nodes: Range<usize>| a[nodes.clone()].iter().zip(&b[nodes]).map(|(a, b)| a.dot(b)).sum();
        over_blocks(self.problem.blocks.node_starts(), of_nodes)
    }

    /// preconditioned ← K̃⁻¹ left, block by block.
    fn respond(&mut self, newton: &mut Newton) -> Result<(), StepError> {
        let (blocks, shapes, weights) = (&self.problem.blocks, &self.problem.shapes, &self.weights);
        let (left, touched) = (&newton.left, &newton.touched);
        let slices = NodeSlices::only_positions(&mut newton.preconditioned);
        let respond = |index: usize, body: &mut Body, out: NodeSlices| {
            if touched[index] {
                let range = blocks.nodes_of(BlockId(index as u32));
                body.respond(&shapes[body.shape], weights, &left[range], out.position);
            } else {
                out.position.fill(Vec3::zeros());
            }
        };
        let starts = blocks.node_starts();
        for_each_run(
            &self.problem.runs,
            &mut self.bodies,
            starts,
            slices,
            GRAIN_NODES,
            &|first, run, slices| {
                each_of_run(first, run, starts, slices, respond);
            },
        );
        self.stop_if_a_block_failed()
    }
}

impl Newton {
    /// product ← (K̃ − ∂f_c/∂x) direction.
    fn multiply(&mut self) {
        self.product.fill(Vec3::zeros());
        for pair in &self.pairs {
            pair.add_times(&self.direction, &mut self.product);
        }
        for (product, k_delta) in self.product.iter_mut().zip(&self.direction_lifted) {
            *product = k_delta - *product;
        }
    }
}

/// Whether an evaluation failed for where it took the blocks.
fn went_too_far(error: &StepError) -> bool {
    matches!(
        error,
        StepError::Contact { source: ContactError::CollapsedTet { .. } | ContactError::NotFinite { .. }, .. }
    )
}

/// y ← y + a x.
fn add(a: f64, x: &[Vec3], y: &mut [Vec3]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
}

/// y ← x + a y.
fn turn(a: f64, x: &[Vec3], y: &mut [Vec3]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y = x + a * *y);
}
