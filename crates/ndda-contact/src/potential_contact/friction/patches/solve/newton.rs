//! Newton's method for the friction of all patches at once.
//!
//! Sweeps carry a change from patch to patch only: where many patches hold each other, they need as many as a Gauss–Seidel method for
//! Poisson's equation. Each visit also tells how the friction of a patch answers to a change of its slip without it, Δf = −P Δs, where
//! P = A − A (A + D″)⁻¹ A: its whole stiffness A where it sticks, nothing along its slip where it slides. The visits of all patches together are
//! thus a linear system, Δf_i = −P_i (δ_i + Σ_{j≠i} W_ij Δf_j), with δ_i what s_i has changed by since the visit and W how slips answer to
//! forces; with y_i for the slip that changes f_i = P_i y_i, it is symmetric, and conjugate gradients with the preconditioner P solve it. It is a
//! semismooth Newton method (Qi & Sun 1993): sweeps before it find which patches stick, the one after it corrects what it has got wrong.

use ndda_mesh::{Mat3, Vec3};
use rayon::prelude::*;

use crate::friction::patches::GRAIN_BODIES;
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
    /// Slip that is left.
    residual: Vec3,
    /// f and y of the direction, and the change of slip that it brings, less that of y.
    direction: Vec3,
    cause: Vec3,
    product: Vec3,
}

/// Velocities of blocks, set aside.
#[derive(Default)]
struct KeptVelocities {
    bodies: Vec<[Vec3; 2]>,
    nodes: Vec<Vec3>,
}

impl KeptVelocities {
    fn keep(&mut self, motion: &mut Motion) {
        let Self { bodies, nodes } = self;
        bodies.clear();
        bodies.extend(motion.bodies.iter().map(|body| [body.velocity_m_s, body.spin_rad_s]));
        nodes.clear();
        motion.nodal.each_velocity(|velocities, _| nodes.extend_from_slice(velocities));
    }

    fn put_back(&self, motion: &mut Motion) {
        for (body, kept) in motion.bodies.iter_mut().zip(&self.bodies) {
            [body.velocity_m_s, body.spin_rad_s] = *kept;
        }
        let mut left = &self.nodes[..];
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
    /// Sides of patches by block: where those of each block begin, and row and side of each.
    start: Vec<u32>,
    sides: Vec<(u32, u8)>,
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
    pub(super) fn begin(&mut self, patches: &[CoupledPatch], blocks: usize) {
        self.before = None;
        self.rows.clear();
        self.rows.resize(patches.len(), Row::default());
        self.start.clear();
        self.start.resize(blocks + 2, 0);
        for patch in patches {
            self.start[patch.owner.index() + 2] += 1;
            self.start[patch.target.index() + 2] += 1;
        }
        for block in 0..=blocks {
            self.start[block + 1] += self.start[block];
        }
        self.sides.clear();
        self.sides.resize(2 * self.rows.len(), (0, 0));
        for (row, patch) in (0..).zip(patches) {
            for (k, block) in [(0, patch.owner), (1, patch.target)] {
                let place = &mut self.start[block.index() + 1];
                self.sides[*place as usize] = (row, k);
                *place += 1;
            }
        }
    }

    /// One of its steps, from what the last visit of each patch has found.
    pub(super) fn step(&mut self, patches: &mut [CoupledPatch], motion: &mut Motion, time_s: f64) {
        let left = |(row, patch): (&mut Row, &CoupledPatch)| {
            let free_slip = patch.slip(motion) - GAMMA * (patch.flexibility * patch.force);
            (row.residual, row.change) = (patch.free_slip - free_slip, Vec3::zeros());
            row.response = patch.response();
            (row.direction, row.cause) = (Vec3::zeros(), Vec3::zeros());
        };
        self.rows.par_iter_mut().zip(&*patches).with_min_len(GRAIN_PATCHES).for_each(left);
        self.kept.keep(motion);
        self.iterate(patches, motion, time_s);
        self.kept.put_back(motion);
        for (row, patch) in self.rows.iter_mut().zip(&mut *patches) {
            patch.force += row.change;
            row.direction = row.change;
            // Its friction is to be looked at again, unless it sticks for sure.
            patch.is_found = patch.curvature.is_none() && patch.surface.holds(&patch.force);
            if patch.is_found {
                patch.free_slip = -GAMMA * (patch.flexibility * patch.force);
            }
            patch.seen = 0;
        }
        self.push(patches, motion, time_s, false);
        for patch in &*patches {
            motion.pushed[patch.owner.index()] = motion.pushed[patch.owner.index()].max(1);
            motion.pushed[patch.target.index()] = motion.pushed[patch.target.index()].max(1);
        }
    }

    /// Conjugate gradients.
    fn iterate(&mut self, patches: &[CoupledPatch], motion: &mut Motion, time_s: f64) {
        let (mut old, mut enough) = (0.0, 0.0);
        for step in 0..MOST_STEPS {
            let (now, is_found) = self.left(patches);
            if step == 0 {
                // Eisenstat & Walker 1996, second choice: no closer than the last step was worth.
                let [most, least] = FORCING;
                let part = self.before.map_or(most, |before| (now / before).clamp(least, most));
                (enough, self.before) = (part * part * now, Some(now));
            }
            if is_found || now.is_nan() || now <= enough {
                return;
            }
            let back = if step == 0 { 0.0 } else { now / old };
            old = now;
            self.rows.par_iter_mut().with_min_len(GRAIN_PATCHES).for_each(|row| {
                row.direction = row.response * row.residual + back * row.direction;
                row.cause = row.residual + back * row.cause;
            });
            self.push(patches, motion, time_s, true);
            let rows = self.rows.par_iter_mut().zip(patches).with_min_len(GRAIN_PATCHES);
            rows.for_each(|(row, patch)| {
                row.product = patch.slip(motion) + row.cause - GAMMA * (patch.flexibility * row.direction);
            });
            let work: f64 = self.rows.iter().map(|row| row.product.dot(&row.direction)).sum();
            let length = now / work;
            if !(length > 0.0 && length.is_finite()) {
                return;
            }
            for row in &mut self.rows {
                row.change += length * row.direction;
                row.residual -= length * row.product;
            }
        }
    }

    /// r·P r, and whether no patch would change its friction by what matters.
    fn left(&self, patches: &[CoupledPatch]) -> (f64, bool) {
        let (mut sum, mut is_found) = (0.0, true);
        for (row, patch) in self.rows.iter().zip(patches) {
            let change = row.response * row.residual;
            is_found &= change.amax() <= FOUND * patch.tolerance_n;
            sum += row.residual.dot(&change);
        }
        (sum, is_found)
    }

    /// Adds what the directions of all patches change velocities by, block by block, `from_rest` or to what they are.
    fn push(&self, patches: &[CoupledPatch], motion: &mut Motion, time_s: f64, from_rest: bool) {
        let (rows, part) = (&self.rows, time_s / motion.dt_s);
        let columns = motion.nodal.columns_mut().par_iter_mut();
        let blocks = motion.bodies.par_iter_mut().zip(columns).zip(self.start.par_windows(2));
        blocks.with_min_len(GRAIN_BODIES).for_each(|((body, columns), range)| {
            let sides = &self.sides[range[0] as usize..range[1] as usize];
            if let (true, Some(&(row, k))) = (from_rest, sides.first()) {
                (body.velocity_m_s, body.spin_rad_s) = (Vec3::zeros(), Vec3::zeros());
                if let Some(side) = &patches[row as usize].sides[usize::from(k)] {
                    side.velocities(columns).fill(Vec3::zeros());
                }
            }
            for &(row, k) in sides {
                let (patch, direction) = (&patches[row as usize], &rows[row as usize].direction);
                patch.push_side(usize::from(k), (body, columns), direction, (time_s, part));
            }
        });
    }
}
