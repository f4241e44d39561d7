//! Friction of all patches, found together, as forces that stop their slip or oppose it.
//!
//! Normal forces are known, so friction is a problem of Tresca: with the velocities u of rigid blocks and of the nodes of others, their inertia
//! M and the forces f_i ∈ −∂D_i(slip_i) of the patches, M u′ = F + Σ f_i. It is convex, and each step of
//!
//! ```text
//! u_a = u₀ + γ Δt M⁻¹ (F + Σ f_a)                        f_a ∈ −∂D(slip of u_a)
//! u₁  = u₀ +   Δt M⁻¹ (F + (1 − γ) Σ f_a + γ Σ f₁)       f₁ ∈ −∂D(slip of u₁)         γ = 1 − 1/√2
//! ```
//!
//! (Alexander 1977: of second order, and a patch that sticks has no slip at the end) is a minimum of ½ u·M u − … + γ Δt Σ D_i, found
//! patch by patch (Gauss–Seidel), from the friction of the last step, and for all together where that takes long (`newton.rs`). For blocks that
//! deform Δt M⁻¹ is how their nodes answer within the whole step, elasticity included (`nodal.rs`).

use ndda_mesh::{BlockId, Mat3, Vec3};

use crate::friction::patches::limit_surface::{LimitSurface, solved};
use crate::friction::patches::nodal::{Nodal, NodalSide};
use crate::friction::patches::patch::{ContactPatch, PatchDetail};
use crate::friction::patches::solve::chunks::{Division, Left, Place};
use crate::friction::patches::solve::newton::Newton;
use crate::friction::patches::solve::stage::{Visits, solve_stage};
use crate::model::Body;

/// γ of Alexander's method.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// Residual at which the friction of one patch is accepted, relative to the change that does not matter.
const LOCAL_TOLERANCE: f64 = 0.1;
/// Slip over that without friction that is more than what smoothing leaves of a patch that sticks.
const SLIPS: f64 = 1e-6;
/// Least flexibility of a patch in any direction over the largest.
const REGULAR: f64 = 1e-9;

/// One patch among others.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CoupledPatch {
    /// Its number.
    pub patch: u32,
    owner: BlockId,
    target: BlockId,
    /// Axes of the patch, and its normal.
    axes: [Vec3; 3],
    /// From the mass centres to the patch [m], and what acts on nodes instead, where a block deforms.
    arms: [Vec3; 2],
    sides: [Option<NodalSide>; 2],
    surface: LimitSurface,
    /// Change of friction that does not matter to the blocks [N].
    tolerance_n: f64,
    /// Change of slip per force in a whole step, and its inverse.
    flexibility: Mat3,
    stiffness: Mat3,
    /// Slip without its own friction where that was found last, and with it.
    free_slip: Vec3,
    found_slip: Vec3,
    /// Friction of this stage, and of the first.
    force: Vec3,
    first: Vec3,
    /// A + D″ where that was found; none where it sticks.
    curvature: Option<Mat3>,
    /// Whether the friction is that of `free_slip`.
    is_found: bool,
    /// Slip of the side whose block does not move.
    held: Vec3,
    /// Its place among all, and when it was visited last.
    row: u32,
    seen: u32,
}

impl CoupledPatch {
    /// A patch with its friction of the last step; none where nothing it touches can move.
    pub(super) fn new(
        (patch, detail, tolerance_n): (&ContactPatch, &PatchDetail, f64),
        (bodies, nodal): (&[Body], &Nodal),
        sides: [Option<NodalSide>; 2],
        dt_s: f64,
    ) -> Option<Self> {
        let (axes, surface) = (detail.axes, detail.surface);
        let [own, other] = [patch.owner, patch.target].map(|block| &bodies[block.index()]);
        let arms = [patch.center - own.center, patch.center - other.center];
        let mut found = Self {
            patch: detail.patch,
            owner: patch.owner,
            target: patch.target,
            axes,
            arms,
            sides,
            surface,
            tolerance_n,
            ..Self::default()
        };
        for ((body, arm), side) in [own, other].into_iter().zip(arms).zip(&sides) {
            found.flexibility += match side {
                Some(side) => nodal.flexibility(side),
                None => dt_s * found.flexibility_of(body, &arm),
            };
        }
        if patch.deforms {
            // Supports may leave some motions only, a single facet feels no torque.
            found.flexibility += Mat3::from_diagonal_element(REGULAR * found.flexibility.trace());
        }
        found.stiffness = found.flexibility.try_inverse().filter(|a| a.iter().all(|x| x.is_finite()))?;
        if let Some(old) = &detail.previous {
            let twist = old.torque_n_m / surface.radius_m;
            found.force = Vec3::new(axes[0].dot(&old.force_n), axes[1].dot(&old.force_n), twist);
        }
        Some(found)
    }

    /// Changes of the slip rate with the force, for one of both blocks.
    fn flexibility_of(&self, body: &Body, arm: &Vec3) -> Mat3 {
        if body.mass_kg.is_infinite() {
            return Mat3::zeros();
        }
        let radius = self.surface.radius_m;
        let turn = |k: usize| if k < 2 { arm.cross(&self.axes[k]) } else { radius * self.axes[2] };
        let turns = Mat3::from_columns(&[turn(0), turn(1), turn(2)]);
        let shift = Mat3::from_diagonal(&Vec3::new(1.0, 1.0, 0.0)) / body.mass_kg;
        turns.transpose() * body.inverse_inertia * turns + shift
    }

    /// (V₁, V₂, Ω r).
    fn slip(&self, place: &mut Place) -> Vec3 {
        let own = place.slip(self, 0).unwrap_or(self.held);
        own - place.slip(self, 1).unwrap_or(self.held)
    }

    /// The same, from all that moves.
    fn slip_in(&self, motion: &Motion) -> Vec3 {
        let (sides, columns) = motion.nodal.blocks();
        let of = |block: BlockId, k: usize| match &self.sides[k] {
            Some(side) => side.slip(&sides[side.slot as usize], &columns[side.slot as usize]),
            None => self.slip_of(&motion.bodies[block.index()], &self.arms[k]),
        };
        of(self.owner, 0) - of(self.target, 1)
    }

    /// Slip of one block that does not deform.
    fn slip_of(&self, body: &Body, arm: &Vec3) -> Vec3 {
        let velocity = body.velocity_m_s + body.spin_rad_s.cross(arm);
        let spin = self.surface.radius_m * body.spin_rad_s;
        Vec3::new(self.axes[0].dot(&velocity), self.axes[1].dot(&velocity), self.axes[2].dot(&spin))
    }

    /// Adds what a force of this patch changes the velocity of its owner (`k` = 0) or target (1) by, in `time_s`, which is `part` of the step.
    fn push_side(
        &self,
        k: usize,
        (body, columns): (&mut Body, &mut [Vec3]),
        force: &Vec3,
        (time_s, part): (f64, f64),
    ) {
        let sign = [1.0, -1.0][k];
        if let Some(side) = &self.sides[k] {
            side.push(columns, force, sign * part);
        } else if body.mass_kg.is_finite() {
            let along = self.axes[0] * force.x + self.axes[1] * force.y;
            let torque = self.axes[2] * (force.z * self.surface.radius_m);
            body.velocity_m_s += sign * time_s / body.mass_kg * along;
            body.spin_rad_s += body.inverse_inertia * (sign * time_s * (self.arms[k].cross(&along) + torque));
        }
    }

    /// Adds its friction of the last step to the nodes of blocks that deform.
    pub(super) fn push_nodes(&self, nodal: &mut Nodal) {
        for (side, sign) in self.sides.iter().zip([1.0, -1.0]) {
            if let Some(side) = side {
                nodal.push(side, &self.force, sign);
            }
        }
    }

    /// Turn of the owner against the target about the normal in the step, at the mean of the spins at both ends.
    pub(super) fn turn_rad(&self, start: &[Body], end: &[Body], dt_s: f64) -> f64 {
        let spin = |block: BlockId| start[block.index()].spin_rad_s + end[block.index()].spin_rad_s;
        0.5 * dt_s * self.axes[2].dot(&(spin(self.owner) - spin(self.target)))
    }

    /// Tells a patch what friction has been found.
    pub(super) fn hand_over(&self, patch: &mut ContactPatch, (start, end): (&[Body], &[Body]), dt_s: f64) {
        let (force_n, torque_n_m, slides) = self.friction();
        (patch.force_n, patch.torque_n_m, patch.slides) = (force_n, torque_n_m, slides);
        patch.turn_rad = Some(self.turn_rad(start, end, dt_s));
    }

    /// Friction of both stages: force [N] and torque about the normal [N m], and whether it is all that there may be.
    fn friction(&self) -> (Vec3, f64, bool) {
        let force = (1.0 - GAMMA) * self.first + GAMMA * self.force;
        let along = self.axes[0] * force.x + self.axes[1] * force.y;
        let slides = self.slips() || along.norm() >= (1.0 - 1e-6) * self.surface.most_n;
        (along, force.z * self.surface.radius_m, slides)
    }

    /// Whether it slips or turns under its friction, which is less than μN then if it turns.
    fn slips(&self) -> bool {
        self.curvature.is_some() && self.found_slip.norm() > SLIPS * self.free_slip.norm()
    }
}

/// Result of a search for friction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Search {
    /// How often patches were visited.
    pub visits: usize,
    /// Largest change of a slip in the last sweep [m/s]; zero where friction was found.
    pub left_m_s: f64,
}

/// All that moves.
pub(super) struct Motion<'a> {
    pub bodies: &'a mut [Body],
    pub nodal: &'a mut Nodal,
    /// How patches are divided among threads.
    pub division: &'a Division,
    pub dt_s: f64,
    /// Whether the solver compares forces of one evaluation with the next.
    pub is_iterated: bool,
    /// Which patches are to be visited.
    pub visits: &'a mut Visits,
    /// Visits before Newton's method.
    pub alone: usize,
    /// Visits after which a search may leave more than what does not matter.
    pub eased: usize,
}

/// Finds the friction of patches that are not slight; `motion` comes with the velocities at the end of the step under all loads, normal forces and
/// the patches' friction of the last step, `start` with those at its start.
pub(super) fn solve(
    patches: &mut [CoupledPatch],
    start: &[Body],
    (motion, newton): (&mut Motion, &mut Newton),
) -> Search {
    motion.change(start, |from, to| from + GAMMA * (to - from));
    let first = solve_stage(patches, motion, newton);
    motion.change(start, |from, to| from + (to - from) / GAMMA);
    patches.iter_mut().for_each(|patch| patch.first = patch.force);
    let second = solve_stage(patches, motion, newton);
    Search { visits: first.visits + second.visits, left_m_s: first.left_m_s.max(second.left_m_s) }
}

impl Motion<'_> {
    /// The first block of each chunk but the first, as a place among those that answer.
    fn slots_of(&self, starts: &[BlockId]) -> Vec<u32> {
        let asked = self.nodal.asked();
        starts.iter().map(|start| asked.partition_point(|block| block < start) as u32).collect()
    }

    /// Time within the step, and the part of the step that it is.
    fn share(&self, time_s: f64) -> (f64, f64) {
        (time_s, time_s / self.dt_s)
    }

    fn change(&mut self, start: &[Body], change: impl Fn(Vec3, Vec3) -> Vec3 + Sync) {
        for (from, to) in start.iter().zip(&mut *self.bodies) {
            to.velocity_m_s = change(from.velocity_m_s, to.velocity_m_s);
            to.spin_rad_s = change(from.spin_rad_s, to.spin_rad_s);
        }
        self.nodal.each_velocity(|velocities, start| {
            velocities.iter_mut().zip(start).for_each(|(to, from)| *to = change(*from, *to));
        });
    }
}

impl CoupledPatch {
    /// The blocks that touch in it.
    fn blocks(&self) -> [BlockId; 2] {
        [self.owner, self.target]
    }

    /// Whether a side is of a block that does not move by itself.
    fn is_held(&self, k: usize, bodies: &[Body]) -> bool {
        self.sides[k].is_none() && bodies[self.blocks()[k].index()].mass_kg.is_infinite()
    }

    /// Begins a stage: notes the slip of the side that does not move, and whether the patch would turn. The latter does not depend on the order of visits.
    fn begin(&mut self, motion: &Motion) {
        for k in [0, 1] {
            if self.is_held(k, motion.bodies) {
                self.held = self.slip_of(&motion.bodies[self.blocks()[k].index()], &self.arms[k]);
            }
        }
        let free_slip = self.slip_in(motion) - GAMMA * (self.flexibility * self.force);
        self.surface.begin(&free_slip);
    }

    /// Whether the patch turns, against what was taken at the beginning of the stage: its friction is then to be found anew.
    fn refine(&mut self) -> bool {
        let turns = self.surface.refine(&self.free_slip);
        if turns {
            (self.is_found, self.seen) = (false, 0);
        }
        turns
    }

    /// Friction of this patch while that of the others stays; by how much it changed, nothing where that is less than the tolerance.
    fn advance(&mut self, place: &mut Place, time: (f64, f64), is_first: bool) -> Left {
        let slip = self.slip(place);
        let free_slip = slip - GAMMA * (self.flexibility * self.force);
        let change_n = (self.stiffness * (free_slip - self.free_slip)).amax() / GAMMA;
        if !is_first && self.is_found && change_n <= self.tolerance_n {
            return Left::default();
        }
        place.found().visits += 1;
        let start = self.slip_for(&free_slip).unwrap_or(slip);
        (self.free_slip, self.is_found) = (free_slip, true);
        let stiffness = self.stiffness / GAMMA;
        let tolerance_n = LOCAL_TOLERANCE * self.tolerance_n;
        let (force, curvature) =
            self.surface.friction(&stiffness, (&free_slip, &start), tolerance_n, is_first);
        self.curvature = curvature;
        self.found_slip = free_slip + GAMMA * (self.flexibility * force);
        let change = force - self.force;
        self.force = force;
        place.push(self, &change, time);
        if change.amax() <= self.tolerance_n {
            return Left::default();
        }
        place.note_push(self);
        Left { slip_m_s: GAMMA * (self.flexibility * change).amax(), times: change.amax() / self.tolerance_n }
    }

    /// Slip that is expected where it would be so much without its own friction, from what was found last, σ + (A + D″)⁻¹ A δ; none where that stuck.
    fn slip_for(&self, free_slip: &Vec3) -> Option<Vec3> {
        let change_n = self.stiffness * (free_slip - self.free_slip) / GAMMA;
        Some(self.found_slip + solved(self.curvature.as_ref()?, &change_n)?)
    }
}

pub(super) mod chunks;
pub(super) mod newton;
pub(crate) mod stage;
#[cfg(test)]
mod tests;
