//! Verdicts on blocks that vibrate on their contacts and supports, or in themselves.

use ndda_mesh::BlockId;
use ndda_mesh::geometry::Aabb;
use ndda_solver::{BodyKind, Simulation, Worst};

use crate::judge::words::OR_DAMP;
use crate::numbers::two_figures_down;
use crate::waves;

use super::{Entry, PLACE, SPEED, name, warned};

/// Limit of vibrations: the speed that elasticity changes in one step, over the largest speed. A vibration of θ = ω Δt changes θ² of its speed and lags by
/// θ²/12 per radian, so that this limit keeps the lag within [`SPEED`].
const MOST_VIBRATION: f64 = 12.0 * SPEED;
/// Energy that contact damping may add, over the largest energy: the square of the error allowed in speeds.
const MOST_GIVEN: f64 = SPEED * SPEED;
/// Hops in a row that may each be longer than the one before. One more makes nine flights in growing order: by chance one in 362 880.
const MOST_GROWING: f64 = 7.0;
/// Times that a block between others nearly lost and regained contact: a key block that falls as statics says has none, one that hangs 16 to 534.
const MOST_SQUEEZES: f64 = 15.0;
/// Damping in proportion to stiffness that ends such vibrations, over the time that a wave takes through the block: a tenth of critical.
const DAMPED: f64 = 0.06;
/// Short hops of a sliding block: runs that agree with closed forms have up to 11, runs that do not have 21 and more.
const MOST_CHATTERING: f64 = 15.0;

/// Cosine between normals of one plane.
const SAME_PLANE: f64 = 0.99;

/// How a run begins at rest; gravity has no ramp then.
pub(super) const SETTLE: &str = "`settle: ()` (in place of gravity_ramp_s)";

/// Whether blocks creep on shear springs while contact rings.
pub(super) fn creep(simulation: &Simulation) -> [Entry; 2] {
    let worst = simulation.invariants();
    let (place, speed) = (worst.creep_place, worst.creep_speed);
    let vibrates = |found: Worst| worst.squeezes.value > MOST_SQUEEZES && worst.squeezes.block == found.block;
    let cure = |found: Worst| match vibrates(found) {
        true => format!(
            "because it vibrates between others, which makes its shear springs slip: {}",
            against_squeezes(simulation, found)
        ),
        false => format!(
            "because vibrating contact makes its shear springs slip: {}, or remove shear_penalty_pa_m where joints have no cohesion",
            against_creep(simulation.damps_contact(), simulation.began_at_rest())
        ),
    };
    let where_it_is = format!(
        "block `{}` crept by {:.2} of its smallest element size, limit {PLACE}, {}",
        name(simulation, place),
        place.value,
        cure(place)
    );
    let how_fast = format!(
        "block `{}` creeps at {:.1} % of the largest speed, limit {:.0} %, {}",
        name(simulation, speed),
        100.0 * speed.value,
        100.0 * SPEED,
        cure(speed)
    );
    [
        warned("creep / element size", place.value, PLACE, where_it_is),
        warned("creep speed / largest speed", speed.value, SPEED, how_fast),
    ]
}

/// Cures of vibrating contact that the scene does not have yet.
fn against_creep(is_damped: bool, began_at_rest: bool) -> &'static str {
    match (is_damped, began_at_rest) {
        (false, false) => {
            "give the contact a restitution below 1, or add `settle: ()` (in a stage, `then: Settle(ramp: Damped)`), or gravity_ramp_s (not together with settle)"
        }
        (false, true) => "give the contact a restitution below 1",
        (true, false) => {
            "add `settle: ()` (in a stage, `then: Settle(ramp: Damped)`), or gravity_ramp_s (not together with settle)"
        }
        (true, true) => "reduce step_s",
    }
}

/// Whether friction feeds the hops of blocks on undamped contacts.
pub(super) fn hops(simulation: &Simulation) -> Entry {
    let worst = simulation.invariants().growing_hops;
    let reason = format!(
        "block `{}` hopped {} times in a row, each time longer than before, limit {MOST_GROWING}: friction feeds the hops of a contact that is not \
         damped, and where the block would be without them is unknown; give the contact a restitution below 1",
        name(simulation, worst),
        worst.value
    );
    warned("hops that grow by friction", worst.value, MOST_GROWING, reason)
}

/// Whether blocks that deform lose and regain contact while they slide; shown only where some do.
pub(super) fn chatter(simulation: &Simulation) -> Option<Entry> {
    let worst = simulation.invariants().chattering_hops;
    let reason = format!(
        "block `{}` lost contact and regained it {} times while friction acted on it, limit {MOST_CHATTERING}: how far it slides depends on \
         vibrations of contact, which are hardly damped; give contacts a restitution of 0.5, or begin with {SETTLE}",
        name(simulation, worst),
        worst.value
    );
    let check = "contact lost and regained while sliding";
    (worst.value > 0.0).then(|| warned(check, worst.value, MOST_CHATTERING, reason))
}

/// Whether blocks vibrate between others while friction acts on them; shown only beyond the limit.
pub(super) fn squeezes(simulation: &Simulation) -> Option<Entry> {
    let worst = simulation.invariants().squeezes;
    let reason = format!(
        "block `{}` vibrates between others: it nearly lost the contact that presses it from opposite sides and regained it {} times while friction acted, limit \
         {MOST_SQUEEZES}, and may hang or slide too slowly; {}",
        name(simulation, worst),
        worst.value,
        against_squeezes(simulation, worst)
    );
    let check = "contact between others lost and regained";
    (worst.value > MOST_SQUEEZES).then(|| warned(check, worst.value, MOST_SQUEEZES, reason))
}

/// The cure of vibrations of a block between others: damping of its material, or of the blocks that press it, in proportion to size over wave speed.
fn against_squeezes(simulation: &Simulation, found: Worst) -> String {
    let deforms =
        |block: &BlockId| matches!(simulation.shape(*block).kind, BodyKind::Elastic | BodyKind::Affine);
    let own = Some(BlockId(found.block)).filter(deforms);
    let Some(block) = own.or_else(|| simulation.blocks().ids().find(deforms)) else {
        return "give contacts a restitution of 0.5".into();
    };
    let whose = if own.is_some() { "its material" } else { "the material of the blocks that press it" };
    let material = simulation.shape(block).material.as_ref();
    let wave_m_s = (material.moduli()[(2, 2)] / material.density_kg_m3()).sqrt();
    let blocks = simulation.blocks();
    let bounds = Aabb::around(&blocks.rest_position[blocks.nodes_of(block)]);
    let across_s = (bounds.max - bounds.min).max() / wave_m_s;
    let damping_s = (DAMPED * across_s).max(2.0 * material.damping().stiffness_s);
    let of_a_stack = match simulation.damps_contact() {
        true => "",
        false => "; blocks that only bounce on each other need a restitution of 0.5 instead",
    };
    format!("give {whose} `damping: (stiffness_s: {})`, or more{of_a_stack}", two_figures_down(damping_s))
}

/// Whether rebounds of contact made a block slide faster; shown only beyond the limit, and not where friction has shear springs, which hold less at first, and are meant to.
pub(super) fn rebound(simulation: &Simulation) -> Option<Entry> {
    let found = simulation.invariants();
    let (any, on_a_plane) = (found.rebound_speed, found.rebound_speed_on_a_plane);
    let worst = if on_a_plane.value > any.value && lies_on_one_plane(simulation, on_a_plane) {
        on_a_plane
    } else {
        any
    };
    let reason = format!(
        "the speed of block `{}` may be off, usually too large, by about {:.1} % of the largest speed, limit {:.0} %: a load that came at once, or over a short ramp, made its contact rebound, and friction held it less meanwhile; make penalty_pa about {} times as large for an error of {:.0} % (the error falls with the square root of the penalty), or let the load grow more slowly (gravity_ramp_s), which helps less where a block slides between two planes",
        name(simulation, worst),
        100.0 * worst.value,
        100.0 * SPEED,
        times_as_large((worst.value / SPEED).powi(2)),
        100.0 * SPEED
    );
    let check = "speed gained in rebounds of contact / largest speed";
    let has_springs = !simulation.state().contact.facets.is_empty();
    (worst.value > SPEED && !has_springs).then(|| warned(check, worst.value, SPEED, reason))
}

/// A factor above 1, with one decimal where it is small.
fn times_as_large(factor: f64) -> String {
    if factor < 10.0 { format!("{factor:.1}") } else { format!("{factor:.0}") }
}

/// Whether all faces that touch a block lie in one plane: between others it is pushed in as many directions as it touches planes, and its impulse does not tell what
/// it gained.
fn lies_on_one_plane(simulation: &Simulation, found: Worst) -> bool {
    let faces = &simulation.state().contact.faces;
    let mut normals = faces.iter().filter(|face| face.target.0 == found.block).map(|face| face.normal);
    let first = normals.next();
    normals.all(|normal| first.is_some_and(|first| normal.dot(&first) > SAME_PLANE))
}

/// Whether steps resolve the damping of contact; said only where they leave something out.
pub(super) fn contact_damping(simulation: &Simulation) -> Option<Entry> {
    let speed = simulation.invariants().contact_damping_speed;
    let reason = format!(
        "the step does not resolve damping of contact (`restitution` below 1): blocks may move against it too fast by {:.1} % of the largest speed, limit \
         {:.0} %; reduce step_s, or raise the restitution",
        100.0 * speed,
        100.0 * SPEED
    );
    (speed > 0.0).then(|| warned("contact damping error / largest speed", speed, SPEED, reason))
}

/// Whether contact damping added energy instead of removing it; shown only beyond the limit.
pub(super) fn energy_from_damping(simulation: &Simulation) -> Option<Entry> {
    let gain = simulation.invariants().damping_gain;
    let deforms = simulation.blocks().ids().any(|block| simulation.shape(block).kind == BodyKind::Elastic);
    let reason = format!(
        "contact damping (`restitution` below 1) added {:.2} % of the largest energy instead of removing energy, limit {:.2} %, which makes blocks vibrate: {}raise the restitution, or reduce step_s until steps resolve the vibrations of blocks",
        100.0 * gain,
        100.0 * MOST_GIVEN,
        if deforms { "make blocks Rigid or Affine (body), " } else { "" }
    );
    (gain > MOST_GIVEN).then(|| warned("energy added by contact damping", gain, MOST_GIVEN, reason))
}

/// Whether steps are short enough for blocks that ring on their contacts or supports.
pub(super) fn ringing(simulation: &Simulation) -> Entry {
    let worst = simulation.invariants().ringing;
    let forces =
        if simulation.has_contact() { "its contact forces" } else { "the reactions of its supports" };
    let is_undamped = simulation.has_contact() && !simulation.damps_contact();
    let or_damp = if is_undamped { OR_DAMP } else { "" };
    let reason = format!(
        "the velocity of block `{}` may be wrong by {:.1} % of the largest speed, limit {:.0} %, because {forces} \
         vibrate or jump faster than steps resolve: reduce step_s{or_damp}",
        name(simulation, worst),
        100.0 * worst.value,
        100.0 * SPEED
    );
    warned("contact vibration error / largest speed", worst.value, SPEED, reason)
}

/// Whether mesh and steps resolve the waves that arrive.
pub(super) fn arriving_waves(simulation: &Simulation) -> impl Iterator<Item = Entry> {
    let findings = waves::findings(simulation).into_iter();
    findings.map(|found| warned(found.what, found.value, found.limit, found.reason))
}

/// Whether anything comes and goes within a step.
pub(super) fn within_a_step(simulation: &Simulation) -> [Entry; 3] {
    let worst = simulation.invariants();
    let percent = |value: f64| 100.0 * value;
    let vibration = format!(
        "steps are too long for the vibrations of blocks: elasticity changes velocities by {:.1} % of the largest speed in one step, limit {:.0} %; reduce step_s",
        percent(worst.vibration),
        percent(MOST_VIBRATION)
    );
    let missed = format!(
        "loads or motions change within a step: {:.1} % of the largest speed is missed, limit {:.0} %; reduce step_s",
        percent(worst.unresolved_speed),
        percent(SPEED)
    );
    let damping = format!(
        "the step does not resolve damping: velocities are wrong by up to {:.1} % of the largest, limit {:.0} %; reduce step_s",
        percent(worst.damping_speed),
        percent(SPEED)
    );
    [
        warned("unresolved vibration / largest speed", worst.vibration, MOST_VIBRATION, vibration),
        warned("load change within a step / largest speed", worst.unresolved_speed, SPEED, missed),
        warned("damping error / largest speed", worst.damping_speed, SPEED, damping),
    ]
}

#[cfg(test)]
mod tests {
    use super::against_creep;

    #[test]
    fn what_a_scene_has_already_is_not_advised_against_creep() {
        for (is_damped, began_at_rest) in [(false, false), (false, true), (true, false), (true, true)] {
            let told = against_creep(is_damped, began_at_rest);
            assert!(!told.contains("restitution") || !is_damped, "{told}");
            assert!(!told.contains("settle") || !began_at_rest, "{told}");
            assert_eq!(told.contains("step_s"), is_damped && began_at_rest);
        }
    }
}
