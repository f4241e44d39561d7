//! Dashpots beside the shear springs of damped contacts.
//!
//! A spring of stiffness K between two blocks of reduced mass m has a dashpot α √(m K): the same α as along the normal, so that blocks that swing on their
//! springs come to rest as those that bounce. Spring and dashpot together carry no more than the friction law allows, and the work is that of friction.

use crate::friction::facet::{FacetForce, STICKS};
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::ActiveFacet;
use crate::model::ContactInput;
use crate::restitution::ContactDamping;
use crate::restitution::scene::DampingScene;

/// Most steps that a dashpot lasts where blocks deform. Taken with the velocity at the start of a step, a dashpot of τ makes a spring of frequency ω stable
/// for ω² Δt² < 2/(½ + τ/Δt): with this one for every node with ω Δt < 1.4.
const MOST_STEPS: f64 = 0.5;

impl ContactDamping {
    /// Sets the dashpots of all springs of damped contacts.
    pub(super) fn damp_springs(&mut self, scene: &DampingScene) {
        self.shear_time_s.clear();
        self.shear_lag.clear();
        let Some(joints) = scene.joints else { return };
        let ContactInput { blocks, bodies, dt_s, .. } = *scene.input;
        let touching = scene.integrals.touching();
        let stiffness_n_m = |t: u32| {
            let touch = &touching[t as usize];
            let law = joints.law(blocks, touch.triangle, touch.target);
            let stiffness_pa_m = law.map_or(0.0, |law| law.shear_stiffness_pa_m());
            0.5 * stiffness_pa_m * scene.integrals.sums_of(touch).area
        };
        self.shear_time_s.resize(touching.len(), 0.0);
        self.shear_lag.resize(touching.len(), 0.0);
        for run in self.order.chunk_by(|a, b| a.0 == b.0) {
            let all_n_m: f64 = run.iter().map(|&(_, t)| stiffness_n_m(t)).sum();
            let inverse_mass: f64 = run[0].0.iter().map(|block| 1.0 / bodies[block.index()].mass_kg).sum();
            let rate_per_s = (all_n_m * inverse_mass).sqrt();
            if rate_per_s == 0.0 {
                continue;
            }
            let deforms = run[0].0.iter().any(|block| bodies[block.index()].deforms);
            let most_s = if deforms { MOST_STEPS * dt_s } else { f64::INFINITY };
            // Velocity that a unit force along the face takes from the point where it acts at most, per second, rotation included.
            let most_mobile = run[0].0.iter().map(|block| {
                let body = &bodies[block.index()];
                let arm2_m2 = (scene.center(run[0].1) - body.center).norm_squared();
                1.0 / body.mass_kg + arm2_m2 * body.inverse_inertia.trace()
            });
            let braked_per_s2 = all_n_m * most_mobile.sum::<f64>();
            for &(_, t) in run {
                let touch = &touching[t as usize];
                let time_s = self.table.factor(blocks, touch.triangle, touch.target) / rate_per_s;
                // Taken with the velocity at the start of a step, a dashpot may not stop more than there is.
                let taken_s = (time_s / (1.0 + time_s * braked_per_s2 * dt_s)).min(most_s);
                self.shear_time_s[t as usize] = taken_s;
                if time_s > 0.0 {
                    self.shear_lag[t as usize] = 1.0 - taken_s / time_s;
                }
            }
        }
    }

    /// By how much dashpots that are taken too small let blocks go too fast that stick on their springs, at most [m/s]: blocks that a force drives against
    /// a dashpot go as much faster as it is less than it should be. Where a joint slides, dashpots change nothing.
    pub(crate) fn spring_error_m_s(&self, integrals: &Integrals, forces: &[FacetForce], dt_s: f64) -> f64 {
        let of_facet = |((force, lag), touch): ((&FacetForce, &f64), &ActiveFacet)| {
            let spring = force.spring.as_ref().filter(|spring| !spring.slides && *lag > 0.0)?;
            let shear_n = integrals.sums_of(touch).pressure * force.shear.norm();
            (shear_n < STICKS * spring.capacity_n).then(|| lag * spring.slip_m.norm() / dt_s)
        };
        let facets = forces.iter().zip(&self.shear_lag).zip(integrals.touching());
        facets.filter_map(of_facet).fold(0.0, f64::max)
    }
}
