//! The verdict: a run's checks against their limits, and whether its motion is to be trusted.

use ndda_solver::{Simulation, Worst};

mod rotation;
mod vibration;

use rotation::{kept_from_turning, lumped_rotation, turns};
use vibration::{
    SETTLE, arriving_waves, chatter, contact_damping, creep, energy_from_damping, hops, rebound, ringing,
    squeezes, within_a_step,
};

use crate::summary::{Judgement, Label, LabelWord, Named, Verdict};

/// Energy gained or lost for good over the largest energy. Speeds are as its root: twice the 1 % that they may be off.
const MOST_ENERGY: f64 = 0.02;
/// Energy by which friction was off Coulomb's law over ½ m V²: an energy of m v δv is a speed that is off by δv.
const MOST_FRICTION: f64 = 1e-3;
/// Penetration over the element size. A collision of depth d leaves blocks up to π d/2 from where they should be: 0.08 element sizes at this limit, less
/// than the promised 0.1.
const MOST_DEPTH: f64 = 0.05;
/// Part of its strength by which a bond may be overloaded when it breaks.
const BOND_OVERLOAD: f64 = 0.05;
/// Limits of an accurate run: errors of speeds over the largest, and of places over an element size.
pub(crate) const SPEED: f64 = 0.01;
const PLACE: f64 = 0.1;
/// Strain up to which a linear law is taken for true: terms of second order are half of it, 5 % of the stress.
const MOST_STRAIN: f64 = 0.1;
/// Relative travel of two blocks that may meet in a step, over the width of the thinner one.
const MOST_TRAVEL: f64 = 0.5;

/// An invariant, and what it means for the motion.
struct Entry {
    name: &'static str,
    verdict: Verdict,
    /// The judgement, `Warn` or `Fail`, at which the label becomes `inaccurate`.
    spoils_at: Judgement,
    /// Reason that is given then.
    reason: String,
}

impl Entry {
    fn new(name: &'static str, verdict: Verdict, spoils_at: Judgement, reason: String) -> Self {
        Self { name, verdict, spoils_at, reason }
    }

    fn spoils(&self) -> bool {
        let found = self.verdict.verdict;
        found == Judgement::Fail || (found == Judgement::Warn && self.spoils_at == Judgement::Warn)
    }
}

/// The checks of a run against their limits.
pub fn verdicts(simulation: &Simulation) -> Named<Verdict> {
    entries(simulation).into_iter().map(|entry| (entry.name.to_string(), entry.verdict)).collect()
}

/// Whether the motion of a run is to be trusted so far, and why not.
pub fn label(simulation: &Simulation, stopped_by: Option<&str>) -> Label {
    if let Some(cause) = stopped_by {
        return Label { word: LabelWord::Stopped, reasons: vec![cause.to_string()] };
    }
    let spoiled = entries(simulation).into_iter().filter(Entry::spoils);
    let reasons: Vec<String> = spoiled.map(|entry| entry.reason).collect();
    let word = if reasons.is_empty() { LabelWord::Accurate } else { LabelWord::Inaccurate };
    Label { word, reasons }
}

/// Error of speeds that an accurate label allows where blocks hardly move; none where 1 % of the largest speed is more [m/s].
pub fn slow_error_m_s(simulation: &Simulation) -> Option<f64> {
    let scale_m_s = simulation.speed_scale_m_s();
    (scale_m_s > simulation.largest_speed_m_s()).then_some(SPEED * scale_m_s)
}

fn entries(simulation: &Simulation) -> Vec<Entry> {
    let upright = simulation.invariants().smallest_volume_ratio;
    let sound = Verdict { value: None, limit: None, verdict: Judgement::Pass };
    let fail = Judgement::Fail;
    let mut entries = vec![Entry::new("finite state", sound, fail, String::new())];
    entries.extend(measured(simulation));
    entries.extend(momentum(simulation));
    entries.extend(energy(simulation));
    entries.push(spurious_contact_energy(simulation));
    entries.extend(energy_from_friction(simulation));
    entries.push(friction(simulation));
    entries.extend(friction_search(simulation));
    entries.extend(drawn_overlaps(simulation));
    entries.extend(unsettled(simulation));
    entries.extend(creep(simulation));
    entries.push(hops(simulation));
    entries.extend(chatter(simulation));
    entries.extend(squeezes(simulation));
    entries.extend(rebound(simulation));
    entries.extend(contact(simulation));
    entries.extend(lateral_drift(simulation));
    let verdict = if upright > 0.0 { Judgement::Pass } else { fail };
    let verdict = Verdict { value: Some(upright), limit: Some(0.0), verdict };
    entries.push(Entry::new(
        "smallest volume ratio of an element",
        verdict,
        fail,
        "a tetrahedron is inverted: reduce step_s or the load".into(),
    ));
    entries.push(strain(simulation));
    entries.extend(resolution(simulation));
    entries.extend(turns(simulation));
    entries.extend(kept_from_turning(simulation).into_iter().flatten());
    entries.push(ringing(simulation));
    entries.extend(within_a_step(simulation));
    entries.extend(contact_damping(simulation));
    entries.extend(energy_from_damping(simulation));
    entries.extend(arriving_waves(simulation));
    entries.extend(bonds(simulation));
    if simulation.has_lumped_rotation() {
        entries.extend(lumped_rotation(simulation));
    }
    entries
}

/// Name of the check that energy was measured up to the end.
pub(super) const UNMEASURED: &str = "time since energy was measured [s]";

/// An error that nobody has measured does not pass.
fn measured(simulation: &Simulation) -> Option<Entry> {
    let unsampled_s = simulation.unsampled_s();
    let verdict = Verdict { value: Some(unsampled_s), limit: Some(0.0), verdict: Judgement::Fail };
    let reason = format!(
        "energy and momentum were not measured in the last {unsampled_s:.3e} s; call `Simulation::sample` before the label"
    );
    (unsampled_s > 0.0).then(|| Entry::new(UNMEASURED, verdict, Judgement::Fail, reason))
}

fn momentum(simulation: &Simulation) -> [Entry; 2] {
    let worst = simulation.invariants();
    let (linear, angular) = (worst.linear_momentum, worst.angular_momentum);
    // Held blocks exchange angular momentum with their supports through strains that the ledger does not record.
    let turning = if simulation.is_closed() { judged(angular, 1e-8, 1e-6) } else { shown(angular) };
    let cause = match simulation.books_reactions_at_one_instant() {
        true => {
            "; it seems so, since `Newmark` and `GeneralizedAlpha` take reactions at one instant for their mean over a step, which does not hold with damping in proportion to \
             stiffness or with supports that move: use Midpoint"
        }
        false => "; please report this scene",
    };
    let reason = |what: &str, value: f64| {
        format!("{what} is not conserved: the error is {value:.1e} of the largest {what}{cause}")
    };
    [
        Entry::new(
            "linear momentum error",
            judged(linear, 1e-10, 1e-6),
            Judgement::Fail,
            reason("momentum", linear),
        ),
        Entry::new("angular momentum error", turning, Judgement::Fail, reason("angular momentum", angular)),
    ]
}

fn energy(simulation: &Simulation) -> [Entry; 3] {
    let worst = simulation.invariants();
    let lost = if simulation.should_keep_energy() { worst.lasting_loss } else { 0.0 };
    let lasting = worst.lasting_gain.max(lost);
    let what = if worst.lasting_gain >= lost { "gained" } else { "lost" };
    let reason = format!(
        "{:.1} % of the total energy was {what} to numerical error, limit {:.0} %: speeds may be wrong by half as much; reduce step_s",
        100.0 * lasting,
        100.0 * MOST_ENERGY
    );
    let gained = format!(
        "at some time {:.1} % of the total energy was added by numerical error, limit 2 %; reduce step_s",
        100.0 * worst.energy_gain
    );
    [
        Entry::new("energy gained", judged(worst.energy_gain, 0.01, 0.02), Judgement::Fail, gained),
        Entry::new("energy lost", shown(worst.energy_loss), Judgement::Fail, String::new()),
        warned("lasting energy error", lasting, MOST_ENERGY, reason),
    ]
}

/// Whether friction and bonds gave energy; shown only beyond the limit.
fn energy_from_friction(simulation: &Simulation) -> Option<Entry> {
    let gain = simulation.invariants().friction_gain;
    let reason = format!(
        "friction and bonds added {:.1} % of the largest energy, limit {:.0} %, although they can only take energy: reduce step_s",
        100.0 * gain,
        100.0 * MOST_ENERGY
    );
    (gain > MOST_ENERGY).then(|| warned("energy added by friction", gain, MOST_ENERGY, reason))
}

/// Whether friction was found in every step; said only where it was not.
fn friction_search(simulation: &Simulation) -> Option<Entry> {
    let left = simulation.invariants().friction_left_m_s / simulation.speed_scale_m_s();
    let reason = format!(
        "friction at all contacts together did not converge in some steps, and speeds may be wrong by {:.1} % of the largest, limit {:.0} %: reduce step_s",
        100.0 * left,
        100.0 * SPEED
    );
    (left > 0.0).then(|| warned("friction search error / largest speed", left, SPEED, reason))
}

/// Whether blocks overlap as they are drawn, so that contact throws them apart; said only where it does.
fn drawn_overlaps(simulation: &Simulation) -> Option<Entry> {
    let thrown = simulation.invariants().drawn_overlap_m_s;
    let part = thrown.value / simulation.speed_scale_m_s().max(thrown.value).max(f64::MIN_POSITIVE);
    let reason = format!(
        "block `{}` overlaps others as drawn, and contact throws it away at {:.2e} m/s, {:.1} % of the largest speed, limit {:.0} %: move it, or let the scene come to rest first, {SETTLE}",
        name(simulation, thrown),
        thrown.value,
        100.0 * part,
        100.0 * SPEED
    );
    (thrown.value > 0.0).then(|| warned("speed from drawn overlaps / largest speed", part, SPEED, reason))
}

/// Whether settling has left a block far from rest; said only where it has.
fn unsettled(simulation: &Simulation) -> Option<Entry> {
    let found = simulation.invariants().unsettled;
    let part = found.over(simulation.largest_speed_m_s());
    let reason = format!(
        "the scene has settled but block `{}` has not: it sets off at about {:.1e} m/s, {:.0} times what an accurate label allows; divide the tolerance of settle by {:.0}",
        simulation.blocks().names[found.block as usize],
        found.speed_m_s,
        part / SPEED,
        10f64.powf((part / SPEED).log10().ceil())
    );
    (part > SPEED)
        .then(|| warned("speed that settling leaves to a block / its largest speed", part, SPEED, reason))
}

/// Energy that contact makes or takes, pair by pair.
fn spurious_contact_energy(simulation: &Simulation) -> Entry {
    let worst = simulation.invariants();
    let (gain, loss) = (worst.block_gain, worst.block_loss);
    let (what, most) = if gain.value >= loss.value { ("added", gain) } else { ("removed", loss) };
    let reason = format!(
        "contact {what} {:.1} % spurious energy at block `{}`, limit {:.0} %: its velocity may be wrong by {:.1} % of the largest; reduce step_s",
        100.0 * most.value,
        name(simulation, most),
        100.0 * MOST_ENERGY,
        50.0 * most.value
    );
    warned("spurious contact energy", most.value, MOST_ENERGY, reason)
}

/// Whether steps are short enough for friction.
fn friction(simulation: &Simulation) -> Entry {
    let worst = simulation.invariants().unresolved_friction;
    let reason = format!(
        "friction on block `{}` deviates from Coulomb's law by {:.1} % of its largest kinetic energy, limit {:.1} %: reduce step_s",
        name(simulation, worst),
        100.0 * worst.value,
        100.0 * MOST_FRICTION
    );
    warned("friction energy error", worst.value, MOST_FRICTION, reason)
}

fn name(simulation: &Simulation, worst: Worst) -> &str {
    &simulation.blocks().names[worst.block as usize]
}

fn contact(simulation: &Simulation) -> [Entry; 2] {
    let worst = simulation.invariants();
    let depth = worst.max_penetration_ratio;
    let reason = format!(
        "blocks penetrate each other by {:.1} % of an element size, limit {:.0} %: raise penalty_pa",
        100.0 * depth,
        100.0 * MOST_DEPTH
    );
    let unequal = format!(
        "action and reaction of a pair differ by {:.1e} of the force; please report this scene",
        worst.action_reaction
    );
    [
        Entry::new("penetration / element size", judged(depth, MOST_DEPTH, 0.25), Judgement::Warn, reason),
        Entry::new(
            "action minus reaction",
            judged(worst.action_reaction, 1e-12, 1e-9),
            Judgement::Fail,
            unequal,
        ),
    ]
}

/// Lateral drift of clamped blocks, due to the uncertain direction of contact forces.
fn lateral_drift(simulation: &Simulation) -> [Entry; 2] {
    let worst = simulation.invariants();
    let (place, speed) = (worst.lateral_drift_place, worst.lateral_drift_speed);
    let why = "raise penalty_pa, or give the contact friction: where contact is deep the direction of its force is uncertain, and little holds the block across it";
    let where_it_is = format!(
        "block `{}` drifts sideways by {:.2} of its smallest element size, limit {PLACE}: {why}",
        name(simulation, place),
        place.value
    );
    let how_fast = format!(
        "block `{}` drifts sideways at {:.1} % of the largest speed, limit {:.0} %: {why}",
        name(simulation, speed),
        100.0 * speed.value,
        100.0 * SPEED
    );
    [
        warned("unresolved lateral drift / element size", place.value, PLACE, where_it_is),
        warned("unresolved lateral speed / largest speed", speed.value, SPEED, how_fast),
    ]
}

/// Whether strains are small enough for the linear law.
fn strain(simulation: &Simulation) -> Entry {
    let strain = simulation.invariants().largest_strain;
    let reason = format!(
        "strains reach {:.0} % in block `{}`, limit {:.0} %: the linear material law does not hold there; stiffen the block or reduce its load",
        100.0 * strain.value,
        name(simulation, strain),
        100.0 * MOST_STRAIN
    );
    warned("largest strain", strain.value, MOST_STRAIN, reason)
}

/// Whether steps are short enough for contact.
fn resolution(simulation: &Simulation) -> [Entry; 2] {
    let worst = simulation.invariants();
    let (h, bound) = (worst.max_h, simulation.resolved_h());
    let coarse = format!(
        "contact is unstable or not resolved: stability number {h:.2}, limit {:.2}; divide step_s by {:.0}",
        bound.unwrap_or_default(),
        (h / bound.unwrap_or(f64::INFINITY)).ceil().max(2.0)
    );
    let h = bound.map_or(shown(h), |bound| judged(h, bound, f64::INFINITY));
    let travel = worst.max_travel.value;
    let jumped = format!(
        "block `{}` and a neighbour approached each other by {travel:.2} block widths in one step, limit {MOST_TRAVEL}, and may have passed through \
         each other: divide step_s by {:.0}",
        name(simulation, worst.max_travel),
        (travel / MOST_TRAVEL).ceil()
    );
    // How far a block moves in a step matters only where it may jump through another.
    let travel = match simulation.has_contact() {
        true => judged(travel, MOST_TRAVEL, f64::INFINITY),
        false => shown(travel),
    };
    [
        Entry::new("contact stability number", h, Judgement::Warn, coarse),
        Entry::new("travel in a step / block width", travel, Judgement::Warn, jumped),
    ]
}

/// Whether bonds broke close to their strength, if any broke.
fn bonds(simulation: &Simulation) -> Option<Entry> {
    let overload = simulation.invariants().bond_overload;
    let reason = format!(
        "a bond broke only at {:.0} % above its strength, limit {:.0} %, so other bonds may have held or broken wrongly: reduce step_s",
        100.0 * overload,
        100.0 * BOND_OVERLOAD
    );
    (overload > 0.0).then(|| warned("bond overload", overload, BOND_OVERLOAD, reason))
}

/// A value that should not exceed `warn`, and fails the run beyond `fail`.
fn judged(value: f64, warn: f64, fail: f64) -> Verdict {
    let verdict = if value > fail {
        Judgement::Fail
    } else if value > warn {
        Judgement::Warn
    } else {
        Judgement::Pass
    };
    Verdict { value: Some(value), limit: Some(warn), verdict }
}

/// A value that warns beyond its limit, and never fails the run.
fn warned(what: &'static str, value: f64, limit: f64, reason: String) -> Entry {
    Entry::new(what, judged(value, limit, f64::INFINITY), Judgement::Warn, reason)
}

fn shown(value: f64) -> Verdict {
    Verdict { value: Some(value), limit: None, verdict: Judgement::Pass }
}

#[cfg(test)]
mod tests;
