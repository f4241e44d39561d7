//! Mass scaling on the way to rest.
//!
//! The block that contact makes oscillate fastest limits the step; the slowest oscillation of the whole scene determines the number of steps to rest. Equilibrium
//! does not depend on inertia, weights being loads. With mass scaling, each block has the inertia with which its contacts make it oscillate
//! as fast as the step allows (Underwood 1983, "Dynamic relaxation"): h = ω_c Δt is nine tenths of its bound for every block, whatever the step, and steps to rest no longer
//! depend on it. Where friction leaves several equilibria, another one may be found. Of blocks that deform see `deforming.rs`; what follows is about free rigid ones.
//!
//! ω_c is that of the contacts of the step (`Prototype::contact_rate2`), since a block that rocks on an edge, or hangs on one face, is held less than one that is enclosed. A
//! block that gains contacts has more inertia in the same step; one that loses them has less by a twentieth per step, and at least a twentieth of what
//! contact all around it would ask for. Its kinetic energy is the same before and after.
//!
//! A block held all around by contact of stiffness k per area has K = k ∫ g gᵀ dA with g = (n, r × n) and the inertia M = diag(m I, J), so
//! ω² = k λ with λ the largest eigenvalue of M⁻¹ K/k. k is the largest ω_c²/λ that any block has had.

mod deforming;

use nalgebra::{Matrix6, Vector6};
use ndda_mesh::{BlockId, Vec3};
use serde::{Deserialize, Serialize};

use crate::bodies::kind::BodyKind;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::settling_progress::Damping;

/// Part of the largest stable h that blocks are brought to; where steps are controlled, of the h up to which control keeps them whole.
const OF_BOUND: f64 = 0.9;
/// Least inertia of a block over what contact all around it would ask for.
const LEAST: f64 = 0.05;
/// Inertia after a step over that before it, at least.
const KEPT: f64 = 0.95;
/// How much slower blocks that deform oscillate where they are to be stopped at a peak of energy, which steps have to resolve.
const SLOWER_TO_STOP: f64 = 4.0;
/// Depth over height to which blocks are swollen to see which touch before the first step.
const DEPTH: f64 = 1e-3;

/// Inertia of blocks on the way to rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ScaledMasses {
    /// Factors on the inertia of all blocks.
    factor: Vec<f64>,
    /// Factor that a unit of ω_c² asks for: Δt² over the square of the h that blocks are brought to [s²].
    scale_s2: f64,
    /// Largest ω_c²/λ so far [Pa/m].
    stiffness_pa_m: f64,
    /// λ of rigid blocks that are free to move [m²/kg]; 0 for others.
    clamped_rate2: Vec<f64>,
    /// Factors on the masses of the shapes of blocks that deform, which these have while they step; 1 for others.
    of_shapes: Vec<f64>,
}

impl ScaledMasses {
    /// Factor on the inertia of a block, but for that of its shape.
    pub(super) fn factor_of(&self, block: usize) -> f64 {
        self.factor[block]
    }

    /// Shapes whose masses are scaled.
    pub(super) fn scaled_shapes(&self) -> Vec<usize> {
        (0..self.of_shapes.len()).filter(|shape| self.of_shapes[*shape] != 1.0).collect()
    }

    /// The smallest and the largest factor of blocks that have one.
    pub(super) fn range(&self) -> [f64; 2] {
        let rigid = self.factor.iter().zip(&self.clamped_rate2).filter(|(_, rate2)| **rate2 > 0.0);
        let deforming = self.of_shapes.iter().filter(|factor| **factor != 1.0);
        let scaled = rigid.map(|(factor, _)| factor).chain(deforming);
        scaled.fold([f64::INFINITY, 0.0], |[least, most], factor| [least.min(*factor), most.max(*factor)])
    }

    /// Takes ω_c² of all blocks [1/s²]; tells old over new inertia of each block, which is at most 1/`kept`.
    fn follow(&mut self, rates2: &[f64], kept: f64, changed: &mut dyn FnMut(usize, f64)) {
        let pairs = || rates2.iter().zip(&self.clamped_rate2).filter(|(_, clamped)| **clamped > 0.0);
        let stiffest = pairs().map(|(rate2, clamped)| rate2 / clamped).fold(self.stiffness_pa_m, f64::max);
        if !(stiffest > 0.0 && stiffest.is_finite()) {
            return;
        }
        self.stiffness_pa_m = stiffest;
        let blocks = self.factor.iter_mut().zip(rates2).zip(&self.clamped_rate2).enumerate();
        for (block, ((factor, rate2), clamped)) in blocks.filter(|(_, (_, clamped))| **clamped > 0.0) {
            let asked = self.scale_s2 * rate2.max(LEAST * stiffest * clamped);
            let new = asked.max(kept * *factor);
            changed(block, *factor / new);
            *factor = new;
        }
    }
}

impl Simulation {
    /// The inertia with which a scene begins to settle: that for the contacts of blocks that touch or, where none touch, that with which contact all around would make all
    /// as fast as the fastest. None where contact is solved for, or there is no block with others to scale.
    pub(super) fn masses_to_settle_with(&mut self, damping: Damping) -> Option<Box<ScaledMasses>> {
        let clamped_rate2 = self.blocks().ids().map(|block| self.clamped_rate2(block)).collect();
        self.masses_of(clamped_rate2, damping)
    }

    /// The same for rest in the course of a run, for blocks that deform alone: rigid blocks keep their own inertia, since the work of forces is accounted for; all do where contact is damped.
    pub(super) fn masses_in_stages(&mut self, damping: Damping) -> Option<Box<ScaledMasses>> {
        if self.contact.as_ref().is_some_and(|model| model.damps()) {
            return None;
        }
        let clamped_rate2 = vec![0.0; self.bodies.len()];
        self.masses_of(clamped_rate2, damping)
    }

    fn masses_of(&mut self, clamped_rate2: Vec<f64>, damping: Damping) -> Option<Box<ScaledMasses>> {
        let scale_s2 = self.scale_of_rates_s2()?;
        let fastest = clamped_rate2.iter().copied().fold(0.0, f64::max);
        let factor =
            clamped_rate2.iter().map(|rate| if *rate > 0.0 { rate / fastest } else { 1.0 }).collect();
        let of_shapes = vec![1.0; self.problem.shapes.len()];
        let mut masses = ScaledMasses { factor, scale_s2, stiffness_pa_m: 0.0, clamped_rate2, of_shapes };
        // Contact that cannot be computed stops the first step with its own cause.
        if let Ok(rates2) = self.contact_rates2(DEPTH) {
            masses.follow(&rates2, 0.0, &mut |_, _| {});
            let slower = if damping == Damping::Kinetic { SLOWER_TO_STOP } else { 1.0 };
            masses.of_shapes = self.factors_of_shapes((scale_s2, slower), &rates2);
        }
        let is_any = fastest > 0.0 || masses.of_shapes.iter().any(|factor| *factor != 1.0);
        is_any.then(|| Box::new(masses))
    }

    /// Δt² over the square of the h that blocks are brought to; none where contact is solved for, or nothing can touch or pull.
    fn scale_of_rates_s2(&self) -> Option<f64> {
        if !self.has_contact() && !self.has_bolts() {
            return None;
        }
        let whole = self.control.as_ref().map_or(1.0, |control| control.settings.safety.min(1.0));
        let h = OF_BOUND * whole * self.resolved_h()?;
        Some((self.problem.base_step_s / h).powi(2))
    }

    /// Gives blocks other inertia for steps.
    ///
    /// # Errors
    /// [`StepError::Factor`].
    pub(super) fn scale_masses(&mut self, masses: Option<Box<ScaledMasses>>) -> Result<(), StepError> {
        let scaled = masses.as_ref().map(|masses| masses.scaled_shapes());
        self.put_on(masses);
        self.factor_anew(&scaled.unwrap_or_default())
    }

    /// Gives all blocks their own inertia again; what it was.
    ///
    /// # Errors
    /// [`StepError::Factor`].
    pub(super) fn unscale_masses(&mut self) -> Result<Option<Box<ScaledMasses>>, StepError> {
        let masses = self.take_off();
        self.factor_anew(&masses.as_ref().map(|masses| masses.scaled_shapes()).unwrap_or_default())?;
        Ok(masses)
    }

    /// Gives blocks other inertia, K̃ of those that deform being that of another one.
    pub(super) fn put_on(&mut self, masses: Option<Box<ScaledMasses>>) {
        if let Some(masses) = &masses {
            self.scale_shapes(&masses.of_shapes);
        }
        self.scratch.scaled_masses = masses;
    }

    /// Gives all blocks their own inertia again, K̃ of those that deform being that of another one; what it was.
    pub(super) fn take_off(&mut self) -> Option<Box<ScaledMasses>> {
        let masses = self.scratch.scaled_masses.take()?;
        let back: Vec<f64> = masses.of_shapes.iter().map(|factor| 1.0 / factor).collect();
        self.scale_shapes(&back);
        let shapes = self.bodies.iter().map(|body| &self.problem.shapes[body.shape]);
        for (body, shape) in self.scratch.contact_bodies.iter_mut().zip(shapes) {
            body.mass_kg = shape.contact_body().mass_kg;
        }
        Some(masses)
    }

    /// Factor on the inertia of a block, but for that of its shape.
    pub(super) fn inertia_factor(&self, block: BlockId) -> f64 {
        self.scratch.scaled_masses.as_ref().map_or(1.0, |masses| masses.factor[block.index()])
    }

    /// Factor on the inertia of a block, that of its shape included.
    pub(super) fn whole_inertia_factor(&self, block: BlockId) -> f64 {
        let masses = self.scratch.scaled_masses.as_ref();
        let of_shape = masses.map_or(1.0, |masses| masses.of_shapes[self.bodies[block.index()].shape]);
        of_shape * self.inertia_factor(block)
    }

    /// Brings inertia to the contacts of the step and divides forces by the factors on it: with its own inertia, a block then moves as it would with the other.
    pub(super) fn scale_forces(&mut self) {
        let Some(mut masses) = self.scratch.scaled_masses.take() else { return };
        if self.scratch.contact_has_acted {
            let rates2: Vec<f64> = self.blocks().ids().map(|block| self.contact_rate2(block)).collect();
            let (blocks, velocity) = (&self.problem.blocks, &mut self.state.velocity);
            let mut is_blow = false;
            masses.follow(&rates2, KEPT, &mut |block, old_over_new| {
                let nodes = blocks.nodes_of(BlockId(block as u32));
                velocity[nodes].iter_mut().for_each(|v| *v *= old_over_new.sqrt());
                is_blow |= old_over_new != 1.0;
            });
            if is_blow {
                self.note_blow();
            }
        }
        for (index, factor) in masses.factor.iter().enumerate() {
            let nodes = self.problem.blocks.nodes_of(BlockId(index as u32));
            self.scratch.force[nodes.clone()].iter_mut().for_each(|force| *force /= *factor);
            if self.scratch.contact_has_acted {
                // Without contact there is no friction, and bolts act.
                let friction = self.scratch.friction_force.get_mut(nodes.clone()).unwrap_or_default();
                friction.iter_mut().for_each(|force| *force /= *factor);
                self.scratch.contact_stiffness[nodes].iter_mut().for_each(|stiffness| *stiffness /= *factor);
            }
        }
        self.scratch.scaled_masses = Some(masses);
    }

    /// λ of a rigid block that is free to move [m²/kg]; 0 for others, by its rest shape.
    fn clamped_rate2(&self, block: BlockId) -> f64 {
        let shape = self.shape(block);
        if shape.kind != BodyKind::Rigid || !shape.is_free() {
            return 0.0;
        }
        let (rest, first) = (&shape.operator.rest, self.blocks().nodes_of(block).start);
        let mut stiffness = Matrix6::zeros();
        for triangle in self.blocks().triangles_of(block) {
            let [a, b, c] = self.blocks().triangles[triangle].map(|node| rest[node.index() - first]);
            let doubled = (b - a).cross(&(c - a));
            let area_m2 = 0.5 * doubled.norm();
            if area_m2 == 0.0 {
                continue;
            }
            // The middles of the edges integrate squares exactly.
            for arm in [a + b, b + c, c + a] {
                let g = wrench(&(0.5 * arm), &(doubled / (2.0 * area_m2)));
                stiffness += area_m2 / 3.0 * g * g.transpose();
            }
        }
        let mut inertia = Matrix6::identity() * shape.operator.mass_kg;
        let about_center = shape.rigid.as_ref().expect("a rigid shape").inertia;
        inertia.fixed_view_mut::<3, 3>(3, 3).copy_from(&about_center);
        let factor = inertia.cholesky().expect("a validated block is not flat").l();
        let inverse = factor.try_inverse().expect("its factor is regular");
        (inverse * stiffness * inverse.transpose()).symmetric_eigenvalues().max()
    }
}

/// (n, r × n).
fn wrench(arm: &Vec3, normal: &Vec3) -> Vector6<f64> {
    let moment = arm.cross(normal);
    Vector6::new(normal.x, normal.y, normal.z, moment.x, moment.y, moment.z)
}
