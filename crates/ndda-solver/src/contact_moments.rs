//! Angular momentum in schemes that take contact elsewhere than in the middle of a step, or that remember accelerations.
//!
//! The angular momentum of a block is that of its mass about the mass centre c, its *spin*, and that of the mass centre about the origin,
//! its *orbital* part. Torques about c change the spin. The orbital part changes as the integrator moves c: with forces A₀ and A₁ = M a
//! at both ends of a step, u = Δt v₀ + Δt² [(½ − β) A₀ + β A₁]/m and ΔP = Δt [(1 − γ) A₀ + γ A₁] give
//!
//! ```text
//! c₁ × P₁ − c₀ × P₀ = c₀ × ΔP + Δt² v₀ × [(½ − γ + β) A₀ + (γ − β) A₁] + Δt³ (½ γ − β)/m · A₀ × A₁
//! ```
//!
//! *Loads* act along the path of c: their orbital moment is this expression, which is ∫ c × F dt for a constant load, and none of it goes
//! to the spin. *Contact* forces of a pair act at common points x*, not where the two mass centres are when the integrator moves them, so
//! their orbital moments and torques do not cancel: angular momentum would change by about ½ Δt² (v_a − v_b) × F. That misfit is given
//! to the spins of the two blocks, in proportion to their moments of inertia J. Each pair has its own velocity w = (J_b v_a + J_a v_b)/(J_a + J_b),
//! and each of its blocks takes the misfit that an observer sees who moves at w. So the result is the same for all observers, and w × F of
//! both blocks cancels. A held block counts as infinitely heavy and takes the whole misfit.

use ndda_contact::{ContactInput, FacetContact};
use ndda_mesh::{BlockId, Vec3};

use crate::body::{BlockReport, StepContext};
use crate::shape::Shape;
use crate::simulation::Simulation;
use crate::time_integrator::Inertia;

/// Σ w × F of the contact forces on each block: memory sized once.
pub struct ContactMoments {
    /// Half the trace of the inertia of each block about its mass centre [kg m²]; infinite for blocks that are held.
    inertia: Vec<f64>,
    /// Velocity of each mass centre [m/s].
    velocity: Vec<Vec3>,
    facets: Vec<FacetContact>,
    /// Σ w × F of each block [N m/s].
    pub carried: Vec<Vec3>,
}

impl ContactMoments {
    /// Memory for blocks of these shapes.
    pub fn new<'a>(shapes: impl Iterator<Item = &'a Shape>) -> Self {
        let inertia: Vec<f64> = shapes.map(mean_inertia).collect();
        let zeros = vec![Vec3::zeros(); inertia.len()];
        Self { inertia, velocity: zeros.clone(), facets: Vec::new(), carried: zeros }
    }

    /// w of a pair of blocks [m/s].
    fn pair_velocity(&self, a: usize, b: usize) -> Vec3 {
        let (heavy, light) = if self.inertia[a] >= self.inertia[b] { (a, b) } else { (b, a) };
        let ratio = self.inertia[light] / self.inertia[heavy];
        // Two held blocks have no ratio, and no spin that could change.
        let share = if ratio.is_nan() { 0.5 } else { ratio / (1.0 + ratio) };
        self.velocity[light] + share * (self.velocity[heavy] - self.velocity[light])
    }

    fn carry(&mut self, owner: BlockId, target: BlockId, force: &Vec3) {
        let (a, b) = (owner.index(), target.index());
        let carried = self.pair_velocity(a, b).cross(force);
        self.carried[a] += carried;
        self.carried[b] -= carried;
    }
}

/// Σ m x², half the trace of the inertia about the mass centre [kg m²]; infinite for a block that is held.
fn mean_inertia(shape: &Shape) -> f64 {
    let arms = shape.operator.node_mass.iter().zip(&shape.operator.rest);
    if shape.is_free() { arms.map(|(m, x)| m * x.norm_squared()).sum() } else { f64::INFINITY }
}

impl Simulation {
    /// Finds Σ w × F of the contact forces just added, where the scheme asks for it.
    pub(crate) fn carry_contact_forces(&mut self) {
        let Some(mut moments) = self.contact_moments.take() else { return };
        moments.carried.fill(Vec3::zeros());
        if let Some(model) = self.contact.as_ref().filter(|_| self.contact_has_acted) {
            moments.facets.clear();
            let (position, velocity) = (&self.contact_position, &self.state.velocity);
            let input = ContactInput::new(&self.blocks, position, velocity, self.part_s);
            model.add_facets(&input, &self.state.contact, &mut moments.facets);
            for block in self.blocks.ids() {
                let nodes = self.blocks.nodes_of(block);
                moments.velocity[block.index()] = self.shape(block).operator.center(&velocity[nodes]);
            }
            for k in 0..moments.facets.len() {
                let facet = moments.facets[k];
                let owner = self.blocks.triangle_block[facet.facet.index()];
                moments.carry(owner, facet.target, &(facet.push_n + facet.friction_n));
            }
        }
        self.contact_moments = Some(moments);
    }

    /// Σ v × F of the contact forces of the last step, v being the velocity of each block itself: what they carry as long as nobody
    /// knows between which pairs they act, and the same for all observers.
    pub(crate) fn carry_by_blocks(&mut self) {
        let Some(mut moments) = self.contact_moments.take() else { return };
        for block in self.blocks.ids() {
            let nodes = self.blocks.nodes_of(block);
            let velocity_m_s = self.shape(block).operator.center(&self.state.velocity[nodes.clone()]);
            let force: Vec3 = self.state.contact_force[nodes].iter().sum();
            moments.carried[block.index()] = velocity_m_s.cross(&force);
        }
        self.contact_moments = Some(moments);
    }
}

/// Places and velocities of a block as a whole at the start of a step, and how far it goes.
pub(crate) struct Path {
    /// c₀ [m].
    pub center: Vec3,
    /// v₀ [m/s].
    pub velocity_m_s: Vec3,
    /// u [m].
    pub gone: Vec3,
}

/// The mean torque about the mass centre that changes the spin in a step, `force` and `torque` being those of loads and contact; reports
/// M a at the end of the step and the orbital moment of the loads. Damping in proportion to mass acts on the angular momentum about the
/// mass centre that `spin` gives, and along the path; its moments are reported as impulses of their own.
pub(crate) fn spin_torque(
    shape: &Shape,
    context: &StepContext,
    path: &Path,
    (force, torque): (&Vec3, &Vec3),
    spin: impl FnOnce() -> Vec3,
    report: &mut BlockReport,
) -> Vec3 {
    let (weights, dt_s, old) = (&context.weights, context.dt_s, &context.inertia);
    // The integrator's own β: damping in proportion to mass changes the weights of this block.
    let beta =
        if context.drag.is_none() { weights.beta(dt_s) } else { context.integrator.weights(dt_s).beta(dt_s) };
    let gamma = weights.new_force;
    // (½ − γ + β) A₀ + (γ − β) A₁, and (½ γ − β) Δt²/m.
    let after_start = |a0: &Vec3, a1: &Vec3| (0.5 - gamma + beta) * a0 + (gamma - beta) * a1;
    let cross = (0.5 * gamma - beta) * dt_s * dt_s / shape.operator.mass_kg;

    let pressing: Vec3 = context.force.iter().zip(context.external).map(|(f, load)| f - load).sum();
    let behind = path.center - shape.operator.center(context.contact_position);
    let source = behind.cross(&pressing) + weights.contact_lead * dt_s * context.carried;
    let mut new = Inertia {
        force: weights.inertia(force, &old.force),
        torque: weights.inertia(torque, &old.torque),
        contact: weights.inertia(&pressing, &old.contact),
        carried: weights.inertia(&context.carried, &old.carried),
        lag: weights.inertia(&source, &old.lag),
    };

    let (load0, load1) = (old.force - old.contact, new.force - new.contact);
    report.orbital_impulse += dt_s
        * (path.center.cross(&weights.mean_inertia(&load0, &load1))
            + dt_s * path.velocity_m_s.cross(&after_start(&load0, &load1))
            + cross * load0.cross(&load1));
    let misfit = weights.mean_inertia(&old.lag, &new.lag)
        + dt_s * path.velocity_m_s.cross(&after_start(&old.contact, &new.contact))
        - dt_s * after_start(&old.carried, &new.carried)
        + cross * (old.force.cross(&new.force) - load0.cross(&load1));
    let mean = weights.mean_inertia(&old.torque, &new.torque);
    let drag_moment = context.drag_moment(&mean, spin);
    report.impulse_moment += drag_moment;
    if let Some(drag) = &context.drag {
        let impulse = dt_s * weights.mean_inertia(&old.force, &new.force);
        let undamped = path.center.cross(&impulse)
            + dt_s * dt_s * path.velocity_m_s.cross(&after_start(&old.force, &new.force))
            + dt_s * cross * old.force.cross(&new.force);
        let before = shape.operator.mass_kg * path.velocity_m_s;
        let gain = drag.gain(&before, &impulse);
        report.impulse_moment += path.center.cross(&gain) + path.gone.cross(&(before + gain)) - undamped;
    }
    new.lag += path.gone.cross(&new.contact) - dt_s * new.carried;
    report.inertia = new;
    mean - misfit + drag_moment / dt_s
}
