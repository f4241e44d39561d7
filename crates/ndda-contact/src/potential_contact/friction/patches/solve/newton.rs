//! Newton's method for the friction of all patches at once.
//!
//! Sweeps carry a change from patch to patch only: where many patches hold each other, they need as many as a Gauss–Seidel method for
//! Poisson's equation. Each visit also tells how the friction of a patch answers to a change of its slip without it, Δf = −P Δs, where
//! P = A − A (A + D″)⁻¹ A: its whole stiffness A where it sticks, nothing along its slip where it slides. The visits of all patches together are
//! thus a linear system, Δf_i = −P_i (δ_i + Σ_{j≠i} W_ij Δf_j), with δ_i what s_i has changed by since the visit and W how slips answer to
//! forces; with y_i for the slip that changes f_i = P_i y_i, it is symmetric, and conjugate gradients with the preconditioner P solve it. It is a
//! semismooth Newton method (Qi & Sun 1993): sweeps before it find which patches stick, the one after it corrects what it has got wrong.

mod coupling;

use ndda_mesh::{Mat3, Vec3};
use rayon::prelude::*;

use crate::friction::patches::solve::newton::coupling::{Coupling, Places};
use crate::friction::patches::solve::{CoupledPatch, GAMMA, Motion};
use crate::model::Body;

/// Steps of conjugate gradients at most.
const MOST_STEPS: usize = 100;
/// Part of the residual that the first of the linear systems may leave, and the least part.
const FORCING: [f64; 2] = [0.3, 1e-3];
/// Part of the tolerance to which forces are found.
const FOUND: f64 = 0.3;
/// Patches below which a second thread costs more than it brings.
const GRAIN_PATCHES: usize = 256;

/// One patch in the linear system of Newton's method.
#[derive(Clone, Copy, Default)]
struct Row {
    /// Change of its friction.
    change: Vec3,
    /// P.
    response: Mat3,
    /// Slip that is left, and the friction that it asks for, P r.
    residual: Vec3,
    asked: Vec3,
    /// f and y of the direction, and the change of slip that it brings, less that of y.
    direction: Vec3,
    cause: Vec3,
    product: Vec3,
    /// Change of its slip by its own friction alone.
    own: Mat3,
    /// Change of friction that is as good as none [N].
    found_n: f64,
    places: Places,
    /// Friction and slip before the step.
    before: Vec3,
    slip_before: Vec3,
}

/// Velocities or slips of blocks that deform, set aside.
#[derive(Default)]
struct KeptVelocities(Vec<Vec3>);

impl KeptVelocities {
    fn keep(&mut self, motion: &mut Motion) {
        self.0.clear();
        motion.nodal.each_velocity(|velocities, _| self.0.extend_from_slice(velocities));
    }

    fn put_back(&self, motion: &mut Motion) {
        let mut left = &self.0[..];
        motion.nodal.each_velocity(|velocities, _| {
            let (first, rest) = left.split_at(velocities.len());
            velocities.copy_from_slice(first);
            left = rest;
        });
    }
}

/// Room for Newton's method.
#[derive(Default)]
pub(in crate::friction::patches) struct Newton {
    rows: Vec<Row>,
    coupling: Coupling,
    sums: Vec<(f64, bool)>,
    kept: KeptVelocities,
    /// Residual r·P r with which the system before this one began; none for the first of a stage.
    before: Option<f64>,
}

impl CoupledPatch {
    /// P = A − A (A + D″)⁻¹ A: how its friction answers to a change of its slip without it.
    fn response(&self) -> Mat3 {
        let stiffness = self.stiffness / GAMMA;
        let Some(curvature) = &self.curvature else { return stiffness };
        let inverse = curvature.try_inverse();
        inverse.map_or(Mat3::zeros(), |inverse| stiffness - stiffness * inverse * stiffness)
    }
}

impl Newton {
    /// Takes the patches of a stage.
    pub(super) fn begin(&mut self, patches: &[CoupledPatch], bodies: &[Body], time_s: f64) {
        self.before = None;
        let Self { rows, coupling, .. } = self;
        rows.clear();
        coupling.begin(patches, bodies, time_s, |places| {
            let patch = &patches[rows.len()];
            let (own, found_n) = (GAMMA * patch.flexibility, FOUND * patch.tolerance_n);
            rows.push(Row { own, found_n, places, ..Row::default() });
        });
    }

    /// One of its steps, from what the last visit of each patch has found.
    pub(super) fn step(&mut self, patches: &mut [CoupledPatch], motion: &mut Motion, time_s: f64) {
        let left = |(row, patch): (&mut Row, &CoupledPatch)| {
            (row.before, row.slip_before) = (patch.force, patch.slip(motion));
            let free_slip = row.slip_before - row.own * patch.force;
            (row.residual, row.change) = (patch.free_slip - free_slip, Vec3::zeros());
            row.response = patch.response();
            row.asked = row.response * row.residual;
            (row.direction, row.cause) = (Vec3::zeros(), Vec3::zeros());
        };
        self.rows.par_iter_mut().zip(&*patches).with_min_len(GRAIN_PATCHES).for_each(left);
        self.kept.keep(motion);
        self.iterate(patches, motion, time_s);
        self.kept.put_back(motion);
        for (row, patch) in self.rows.iter().zip(&mut *patches) {
            patch.force += row.change;
            patch.push(motion, &row.change, time_s);
            // Its friction is to be looked at again, unless it sticks for sure.
            patch.is_found = patch.curvature.is_none() && patch.surface.holds(&patch.force);
            if patch.is_found {
                patch.free_slip = -(row.own * patch.force);
            }
        }
    }

    /// Whether the last step, and the visits since, have brought the minimum nearer, or changed nothing that matters. Of the dual problem, ½ f·W f + f·s over all
    /// forces within their limits, they change the value by ½ Δf·(slips before + slips after), which friction within its tolerance does not make exact.
    pub(super) fn gains(&self, patches: &[CoupledPatch], motion: &Motion) -> bool {
        let change = |(row, patch): (&Row, &CoupledPatch)| {
            let slips = row.slip_before + patch.slip(motion);
            (patch.force - row.before).dot(&slips) - patch.tolerance_n * slips.abs().sum()
        };
        self.rows.iter().zip(patches).map(change).sum::<f64>() <= 0.0
    }

    /// Takes the last step back, and the visits since: all patches are to be visited again.
    pub(super) fn take_back(&self, patches: &mut [CoupledPatch], motion: &mut Motion, time_s: f64) {
        for (row, patch) in self.rows.iter().zip(patches) {
            let change = row.before - patch.force;
            (patch.force, patch.is_found) = (row.before, false);
            patch.push(motion, &change, time_s);
        }
        motion.visits.forget();
    }

    /// Conjugate gradients.
    fn iterate(&mut self, patches: &[CoupledPatch], motion: &mut Motion, time_s: f64) {
        let (mut now, mut is_found) = self.sum(|row, _| (row.residual.dot(&row.asked), row.is_found()));
        // Eisenstat & Walker 1996, second choice: no closer than the last step was worth.
        let [most, least] = FORCING;
        let part = self.before.map_or(most, |before| (now / before).clamp(least, most));
        let enough = part * part * now;
        self.before = Some(now);
        let mut back = 0.0;
        for _ in 0..MOST_STEPS {
            if is_found || now.is_nan() || now <= enough {
                return;
            }
            self.rows.par_iter_mut().with_min_len(GRAIN_PATCHES).for_each(|row| {
                row.direction = row.asked + back * row.direction;
                row.cause = row.residual + back * row.cause;
            });
            let Self { rows, coupling, .. } = self;
            coupling.answer(patches, motion, time_s, |row| rows[row as usize].direction);
            let (work, _) = self.sum(|row, coupling| {
                row.product = coupling.slip(&row.places) + row.cause - row.own * row.direction;
                (row.product.dot(&row.direction), true)
            });
            let length = now / work;
            if !(length > 0.0 && length.is_finite()) {
                return;
            }
            let old = now;
            (now, is_found) = self.sum(|row, _| {
                row.change += length * row.direction;
                row.residual -= length * row.product;
                row.asked = row.response * row.residual;
                (row.residual.dot(&row.asked), row.is_found())
            });
            back = now / old;
        }
    }

    /// Sum over all rows, after some work on each, and whether all of them say so: by parts that do not depend on the number of threads.
    fn sum(&mut self, work: impl Fn(&mut Row, &Coupling) -> (f64, bool) + Sync) -> (f64, bool) {
        let Self { rows, coupling, sums, .. } = self;
        let parts = rows.par_chunks_mut(GRAIN_PATCHES).map(|rows| {
            let add = |(sum, all): (f64, bool), row: &mut Row| {
                let (part, is_so) = work(row, coupling);
                (sum + part, all & is_so)
            };
            rows.iter_mut().fold((0.0, true), add)
        });
        parts.collect_into_vec(sums);
        sums.iter().fold((0.0, true), |(sum, all), (part, is_so)| (sum + part, all & is_so))
    }
}

impl Row {
    /// Whether its friction would change by no more than what matters.
    fn is_found(&self) -> bool {
        self.asked.amax() <= self.found_n
    }
}
