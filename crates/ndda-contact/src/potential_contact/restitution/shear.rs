//! Dashpots beside the shear springs of damped contacts.
//!
//! A spring of stiffness K between two blocks of reduced mass m has a dashpot α √(m K): the same α as along the normal, so that blocks that swing on their
//! springs come to rest as those that bounce. Spring and dashpot together carry no more than the friction law allows, and the work is that of friction.

use crate::model::ContactInput;
use crate::restitution::ContactDamping;
use crate::restitution::scene::DampingScene;

/// Most steps that a dashpot lasts where blocks deform, whose lightest nodes it would stop within one.
const MOST_STEPS: f64 = 4.0;

impl ContactDamping {
    /// Sets the dashpots of all springs of damped contacts.
    pub(super) fn damp_springs(&mut self, scene: &DampingScene) {
        self.shear_time_s.clear();
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
        for run in self.order.chunk_by(|a, b| a.0 == b.0) {
            let all_n_m: f64 = run.iter().map(|&(_, t)| stiffness_n_m(t)).sum();
            let pair = run[0].0.map(|block| &bodies[block.index()]);
            let inverse_mass: f64 = pair.iter().map(|body| 1.0 / body.mass_kg).sum();
            let rate_per_s = (all_n_m * inverse_mass).sqrt();
            if rate_per_s == 0.0 {
                continue;
            }
            let most_s = if pair.iter().any(|body| body.deforms) { MOST_STEPS * dt_s } else { f64::INFINITY };
            for &(_, t) in run {
                let touch = &touching[t as usize];
                let factor = self.table.factor(blocks, touch.triangle, touch.target);
                // Taken at the start of a step, a dashpot may not stop more than there is.
                let time_s = factor / rate_per_s / (1.0 + factor * rate_per_s * dt_s);
                self.shear_time_s[t as usize] = time_s.min(most_s);
            }
        }
    }
}
