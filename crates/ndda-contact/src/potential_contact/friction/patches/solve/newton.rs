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

use crate::friction::patches::solve::chunks::{Place, each_patch};
use crate::friction::patches::solve::newton::coupling::{Coupling, Places};
use crate::friction::patches::solve::{CoupledPatch, GAMMA, Motion};

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
    /// y of the direction, and the change of slip that the direction brings, less that of y.
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

/// Room for Newton's method.
#[derive(Default)]
pub(in crate::friction::patches) struct Newton {
    rows: Vec<Row>,
    /// f of the direction.
    directions: Vec<Vec3>,
    coupling: Coupling,
    sums: Vec<(f64, bool)>,
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
    pub(super) fn begin(&mut self, patches: &[CoupledPatch], motion: &Motion, time_s: f64) {
        self.before = None;
        let Self { rows, directions, coupling, .. } = self;
        rows.clear();
        directions.clear();
        directions.resize(patches.len(), Vec3::zeros());
        coupling.begin(patches, motion, time_s, |places| {
            let patch = &patches[rows.len()];
            let (own, found_n) = (GAMMA * patch.flexibility, FOUND * patch.tolerance_n);
            rows.push(Row { own, found_n, places, ..Row::default() });
        });
    }

    /// One of its steps, from what the last visit of each patch has found.
    pub(super) fn step(&mut self, patches: &mut [CoupledPatch], motion: &mut Motion, time_s: f64) {
        let all = &*motion;
        let left = |(row, patch): (&mut Row, &CoupledPatch)| {
            (row.before, row.slip_before) = (patch.force, patch.slip_in(all));
            let free_slip = row.slip_before - row.own * patch.force;
            (row.residual, row.change) = (patch.free_slip - free_slip, Vec3::zeros());
            row.response = patch.response();
            row.asked = row.response * row.residual;
            row.cause = Vec3::zeros();
        };
        self.rows.par_iter_mut().zip(&*patches).with_min_len(GRAIN_PATCHES).for_each(left);
        self.directions.fill(Vec3::zeros());
        self.iterate(motion, time_s);
        let time = motion.share(time_s);
        let rows = &self.rows;
        each_patch(patches, motion, true, |patch, place| {
            let row = &rows[patch.row as usize];
            patch.force += row.change;
            place.push(patch, &row.change, time);
            // Its friction is to be looked at again, unless it sticks for sure.
            patch.is_found = patch.curvature.is_none() && patch.surface.holds(&patch.force);
            if patch.is_found {
                patch.free_slip = -(row.own * patch.force);
            }
        });
    }

    /// Whether the last step, and the visits since, have brought the minimum nearer, or changed nothing that matters. Of the dual problem, ½ f·W f + f·s over all
    /// forces within their limits, they change the value by ½ Δf·(slips before + slips after), which friction within its tolerance does not make exact.
    pub(super) fn gains(&self, patches: &mut [CoupledPatch], motion: &mut Motion) -> bool {
        let change = |patch: &mut CoupledPatch, place: &mut Place| {
            let row = &self.rows[patch.row as usize];
            let slips = row.slip_before + patch.slip(place);
            place.found().sum +=
                (patch.force - row.before).dot(&slips) - patch.tolerance_n * slips.abs().sum();
        };
        each_patch(patches, motion, true, change).sum <= 0.0
    }

    /// Takes the last step back, and the visits since: all patches are to be visited again.
    pub(super) fn take_back(&self, patches: &mut [CoupledPatch], motion: &mut Motion, time_s: f64) {
        let time = motion.share(time_s);
        each_patch(patches, motion, true, |patch, place| {
            let row = &self.rows[patch.row as usize];
            let change = row.before - patch.force;
            (patch.force, patch.is_found, patch.seen) = (row.before, false, 0);
            place.push(patch, &change, time);
        });
    }

    /// Conjugate gradients.
    fn iterate(&mut self, motion: &Motion, time_s: f64) {
        let (mut now, mut is_found) = self.sum(|row, _, _| (row.residual.dot(&row.asked), row.is_found()));
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
            let each = self.rows.par_iter_mut().zip(&mut self.directions).with_min_len(GRAIN_PATCHES);
            each.for_each(|(row, direction)| {
                *direction = row.asked + back * *direction;
                row.cause = row.residual + back * row.cause;
            });
            self.coupling.answer(motion, time_s, &self.directions);
            let (work, _) = self.sum(|row, direction, coupling| {
                row.product = coupling.slip(&row.places) + row.cause - row.own * direction;
                (row.product.dot(direction), true)
            });
            let length = now / work;
            if !(length > 0.0 && length.is_finite()) {
                return;
            }
            let old = now;
            (now, is_found) = self.sum(|row, direction, _| {
                row.change += length * direction;
                row.residual -= length * row.product;
                row.asked = row.response * row.residual;
                (row.residual.dot(&row.asked), row.is_found())
            });
            back = now / old;
        }
    }

    /// Sum over all rows, after some work on each, and whether all of them say so: by parts that do not depend on the number of threads.
    fn sum(&mut self, work: impl Fn(&mut Row, &Vec3, &Coupling) -> (f64, bool) + Sync) -> (f64, bool) {
        let Self { rows, directions, coupling, sums, .. } = self;
        let each = rows.par_chunks_mut(GRAIN_PATCHES).zip(directions.par_chunks(GRAIN_PATCHES));
        let parts = each.map(|(rows, directions)| {
            let add = |(sum, all): (f64, bool), (row, direction): (&mut Row, &Vec3)| {
                let (part, is_so) = work(row, direction, coupling);
                (sum + part, all & is_so)
            };
            rows.iter_mut().zip(directions).fold((0.0, true), add)
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
