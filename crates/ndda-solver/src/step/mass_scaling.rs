//! Mass scaling on the way to rest.
//!
//! The block that contact makes oscillate fastest limits the step; the slowest oscillation of the whole scene determines the number of steps to rest. Equilibrium
//! does not depend on inertia, weights being loads. With mass scaling, each rigid block has so much less inertia than its own that contact
//! could make it oscillate as fast as the fastest: the step remains stable, and fewer steps lead to rest (Underwood 1983, "Dynamic
//! relaxation"). Where friction leaves several equilibria, another one may be found.
//!
//! A block held all around by contact of stiffness k per area has K = k ∫ g gᵀ dA with g = (n, r × n) and the inertia M = diag(m I, J), so
//! ω² = k λ with λ the largest eigenvalue of M⁻¹ K/k. Its inertia is multiplied by λ/λ_max.

use nalgebra::{Matrix6, Vector6};
use ndda_mesh::{BlockId, Vec3};

use crate::bodies::kind::BodyKind;
use crate::step::Simulation;
use crate::step::settle::Settle;

impl Simulation {
    /// Scales the inertia of all rigid blocks if that is asked for; the smallest factor.
    pub(super) fn scale_masses_if(&mut self, settle: &Settle) -> Option<f64> {
        if !settle.mass_scaling || self.newton.is_some() {
            return None;
        }
        let rates: Vec<f64> = self.blocks().ids().map(|block| self.clamped_rate2(block)).collect();
        let fastest = rates.iter().copied().fold(0.0, f64::max);
        let factor = |rate: &f64| if *rate > 0.0 { rate / fastest } else { 1.0 };
        self.scratch.inertia_factor = rates.iter().map(factor).collect();
        Some(self.scratch.inertia_factor.iter().copied().fold(1.0, f64::min))
    }

    /// Gives all blocks their own inertia again.
    pub(super) fn unscale_masses(&mut self) {
        if self.scratch.inertia_factor.is_empty() {
            return;
        }
        self.scratch.inertia_factor.clear();
        let shapes = self.bodies.iter().map(|body| &self.problem.shapes[body.shape]);
        for (body, shape) in self.scratch.contact_bodies.iter_mut().zip(shapes) {
            body.mass_kg = shape.contact_body().mass_kg;
        }
    }

    /// Factor on the inertia of a block.
    pub(super) fn inertia_factor(&self, block: BlockId) -> f64 {
        self.scratch.inertia_factor.get(block.index()).copied().unwrap_or(1.0)
    }

    /// Divides forces by the factors on inertia: with its own inertia, a block then moves as it would with the other.
    pub(super) fn scale_forces(&mut self) {
        for (index, factor) in self.scratch.inertia_factor.iter().enumerate() {
            let nodes = self.problem.blocks.nodes_of(BlockId(index as u32));
            self.scratch.force[nodes.clone()].iter_mut().for_each(|force| *force /= *factor);
            if self.scratch.contact_has_acted {
                self.scratch.friction_force[nodes.clone()].iter_mut().for_each(|force| *force /= *factor);
                self.scratch.contact_stiffness[nodes].iter_mut().for_each(|stiffness| *stiffness /= *factor);
            }
        }
    }

    /// λ of a rigid block that is free to move [m²/kg]; 0 for others. It is that of its rest shape, so that settling goes on from a checkpoint with the same bits.
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
