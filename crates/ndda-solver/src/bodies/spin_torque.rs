//! The torque that changes the spin of a block in a step.

use ndda_mesh::Vec3;

use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::bodies::report::BlockReport;
use crate::integrators::time_integrator::Inertia;

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
    shape: &Prototype,
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
