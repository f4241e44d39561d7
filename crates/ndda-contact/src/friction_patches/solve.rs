//! Friction of all patches between blocks that do not deform, found together, as forces that stop their slip or oppose it.
//!
//! Normal forces are known, so friction is a problem of Tresca: with the velocities u of the blocks, their inertia M and the
//! forces f_i ∈ −∂D_i(slip_i) of the patches, M u′ = F + Σ f_i. It is convex, and each step of
//!
//! ```text
//! u_a = u₀ + γ Δt M⁻¹ (F + Σ f_a)                        f_a ∈ −∂D(slip of u_a)
//! u₁  = u₀ +   Δt M⁻¹ (F + (1 − γ) Σ f_a + γ Σ f₁)       f₁ ∈ −∂D(slip of u₁)         γ = 1 − 1/√2
//! ```
//!
//! (Alexander 1977: of second order, and a patch that sticks has no slip at the end) is a minimum of ½ u·M u − … + γ Δt Σ D_i, found
//! patch by patch (Gauss–Seidel), from the friction of the last step.

use ndda_mesh::{BlockId, Mat3, Vec3};

use crate::friction_patches::limit_surface::LimitSurface;
use crate::friction_patches::patch::ContactPatch;
use crate::model::Body;

/// γ of Alexander's method.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// Friction is found when no patch changes its own by more than this part of μN.
const TOLERANCE: f64 = 1e-3;
/// Sweeps over all patches.
const MOST_SWEEPS: usize = 30;

/// One patch among others.
#[derive(Clone, Copy, Debug, Default)]
pub struct CoupledPatch {
    /// Its number.
    pub patch: u32,
    owner: BlockId,
    target: BlockId,
    /// Axes of the patch, and its normal.
    axes: [Vec3; 3],
    /// From the mass centres to the patch [m].
    arms: [Vec3; 2],
    surface: LimitSurface,
    /// What a force changes the slip by in a whole step, and the inverse.
    flexibility: Mat3,
    stiffness: Mat3,
    /// Slip without its own friction where that was found last.
    free_slip: Vec3,
    /// Friction of this stage, and of the first.
    force: Vec3,
    first: Vec3,
}

impl CoupledPatch {
    /// A patch with its friction of the last step; none where nothing it touches can move.
    pub fn new(number: u32, patch: &ContactPatch, bodies: &[Body], dt_s: f64) -> Option<Self> {
        let (axes, surface) = (patch.axes, patch.surface);
        let [own, other] = [patch.owner, patch.target].map(|block| &bodies[block.index()]);
        let arms = [patch.center - own.center, patch.center - other.center];
        let mut found = Self {
            patch: number,
            owner: patch.owner,
            target: patch.target,
            axes,
            arms,
            surface,
            ..Self::default()
        };
        for (body, arm) in [own, other].into_iter().zip(arms) {
            found.flexibility += dt_s * found.flexibility_of(body, &arm);
        }
        found.stiffness = found.flexibility.try_inverse().filter(|a| a.iter().all(|x| x.is_finite()))?;
        if let Some(old) = &patch.previous {
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
    fn slip(&self, bodies: &[Body]) -> Vec3 {
        let (own, other) = (&bodies[self.owner.index()], &bodies[self.target.index()]);
        let velocity = |body: &Body, arm: &Vec3| body.velocity_m_s + body.spin_rad_s.cross(arm);
        let slip = velocity(own, &self.arms[0]) - velocity(other, &self.arms[1]);
        let spin = self.surface.radius_m * (own.spin_rad_s - other.spin_rad_s);
        Vec3::new(self.axes[0].dot(&slip), self.axes[1].dot(&slip), self.axes[2].dot(&spin))
    }

    /// Adds what a force of this patch changes velocities by in some time.
    fn push(&self, bodies: &mut [Body], force: &Vec3, time_s: f64) {
        let along = self.axes[0] * force.x + self.axes[1] * force.y;
        let torque = self.axes[2] * (force.z * self.surface.radius_m);
        for (block, arm, sign) in [(self.owner, &self.arms[0], 1.0), (self.target, &self.arms[1], -1.0)] {
            let body = &mut bodies[block.index()];
            if body.mass_kg.is_finite() {
                body.velocity_m_s += sign * time_s / body.mass_kg * along;
                body.spin_rad_s += body.inverse_inertia * (sign * time_s * (arm.cross(&along) + torque));
            }
        }
    }

    /// Turn of the owner against the target about the normal in the step, at the mean of the spins at both ends.
    pub fn turn_rad(&self, start: &[Body], end: &[Body], dt_s: f64) -> f64 {
        let spin = |block: BlockId| start[block.index()].spin_rad_s + end[block.index()].spin_rad_s;
        0.5 * dt_s * self.axes[2].dot(&(spin(self.owner) - spin(self.target)))
    }

    /// Friction of both stages: force [N] and torque about the normal [N m], and whether it is all that there may be.
    pub fn friction(&self) -> (Vec3, f64, bool) {
        let force = (1.0 - GAMMA) * self.first + GAMMA * self.force;
        let along = self.axes[0] * force.x + self.axes[1] * force.y;
        let slides = along.norm() >= (1.0 - 1e-6) * self.surface.most_n;
        (along, force.z * self.surface.radius_m, slides)
    }
}

/// Finds the friction of all patches; `bodies` come with the velocities at the end of the step under all loads, normal forces and the patches'
/// friction of the last step, `start` with those at its start. Gives the sweeps.
pub fn solve(patches: &mut [CoupledPatch], start: &[Body], bodies: &mut [Body], dt_s: f64) -> usize {
    each_motion(start, bodies, |from, to| from + GAMMA * (to - from));
    let first = solve_stage(patches, bodies, dt_s);
    each_motion(start, bodies, |from, to| from + (to - from) / GAMMA);
    patches.iter_mut().for_each(|patch| patch.first = patch.force);
    first + solve_stage(patches, bodies, dt_s)
}

fn each_motion(start: &[Body], bodies: &mut [Body], change: impl Fn(Vec3, Vec3) -> Vec3) {
    for (from, to) in start.iter().zip(bodies) {
        to.velocity_m_s = change(from.velocity_m_s, to.velocity_m_s);
        to.spin_rad_s = change(from.spin_rad_s, to.spin_rad_s);
    }
}

/// One of both minima.
fn solve_stage(patches: &mut [CoupledPatch], bodies: &mut [Body], dt_s: f64) -> usize {
    let time_s = GAMMA * dt_s;
    for sweep in 0..MOST_SWEEPS {
        let mut changes = false;
        let mut advance = |patch: &mut CoupledPatch| changes |= patch.advance(bodies, time_s, sweep == 0);
        if sweep % 2 == 0 {
            patches.iter_mut().for_each(&mut advance);
        } else {
            patches.iter_mut().rev().for_each(&mut advance);
        }
        if !changes {
            return sweep;
        }
    }
    MOST_SWEEPS
}

impl CoupledPatch {
    /// Friction of this patch while that of the others stays; whether it had to change.
    fn advance(&mut self, bodies: &mut [Body], time_s: f64, is_first: bool) -> bool {
        let slip = self.slip(bodies);
        let free_slip = slip - GAMMA * (self.flexibility * self.force);
        let most = TOLERANCE * self.surface.most_n;
        if !is_first && (self.stiffness * (free_slip - self.free_slip)).amax() <= GAMMA * most {
            return false;
        }
        self.free_slip = free_slip;
        let force = self.surface.friction(&(self.stiffness / GAMMA), &free_slip, &slip);
        let change = force - self.force;
        self.force = force;
        self.push(bodies, &change, time_s);
        change.amax() > most
    }
}
