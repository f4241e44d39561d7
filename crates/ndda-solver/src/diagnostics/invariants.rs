//! The worst values of a run, which verdicts judge.

use serde::{Deserialize, Serialize};

use crate::diagnostics::worst::Worst;
use crate::step::report::StepCounts;
use crate::step::unsettled::Unsettled;

/// The worst values of a run so far; the limits are those of the summary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Invariants {
    /// |momentum − impulses| / max Σ m |v|.
    pub linear_momentum: f64,
    /// |angular momentum − angular impulses| / max Σ m |x| |v|.
    pub angular_momentum: f64,
    /// largest energy gain over the peak energy.
    pub energy_gain: f64,
    /// largest energy loss over the peak energy.
    pub energy_loss: f64,
    /// largest gain that does not come back when contact parts, over the peak energy.
    pub lasting_gain: f64,
    /// largest energy that contact damping gave, over the peak energy.
    pub damping_gain: f64,
    /// largest loss that does not come back when contact parts, over the peak energy.
    pub lasting_loss: f64,
    /// largest energy that friction and bonds gave in all, over the peak energy; zero where their springs were stretched at the start and may give that back.
    pub friction_gain: f64,
    /// largest lasting gain of the lighter block of a pair, over ½ m v V for the speed v of the impact and the largest
    /// speed V, or its largest energy of contact.
    pub block_gain: Worst,
    /// largest lasting loss of it, over the same.
    pub block_loss: Worst,
    /// largest energy by which friction of the lighter block of a pair was off Coulomb's law, summed over all steps, over ½ m V².
    pub unresolved_friction: Worst,
    /// Changes of slip velocities by friction when the search for it ended before it was found: the sum over all steps of the largest [m/s].
    pub friction_left_m_s: f64,
    /// Largest speed at which overlaps as drawn throw a block [m/s].
    pub drawn_overlap_m_s: Worst,
    /// Block that settling has left farthest from rest, by its own measure.
    pub unsettled: Unsettled,
    /// penetration over tet height.
    pub max_penetration_ratio: f64,
    /// by how much the strength of a bond was exceeded where one broke, over its strength under its normal stress or without any, whichever is
    /// more.
    pub bond_overload: f64,
    /// largest unresolved lateral velocity of a clamped block, due to the uncertain direction of contact forces, over the largest speed.
    pub lateral_drift_speed: Worst,
    /// where that took it, over the smallest tet height of its block.
    pub lateral_drift_place: Worst,
    /// mean speed at which a block creeps on shear springs that contact makes slip by ringing, over the largest speed.
    pub creep_speed: Worst,
    /// where that took it, over the smallest tet height of its block.
    pub creep_place: Worst,
    /// Hops of a block in a row, each longer than the one before, with friction in between.
    pub growing_hops: Worst,
    /// Short hops of a block that deforms: contact lost and soon regained, where friction acted and could stop the block.
    pub chattering_hops: Worst,
    /// Hops of a block with friction between them that could stop it: small differences grow from hop to hop.
    pub hops_with_friction: Worst,
    /// How often a block nearly lost and regained the contact that presses it from opposite sides, friction acting: its friction may be that of its
    /// vibrations.
    pub squeezes: Worst,
    /// Second largest impact of a block: velocity that contact added, less that which bears its loads, over the largest speed.
    pub second_impact: Worst,
    /// Largest impact of a block, likewise.
    pub impact: Worst,
    /// Most that steps may have left of loads that change along the way of a block which nothing touches: of its velocity, over the largest speed.
    pub free_speed: Worst,
    /// Of its place, over the smallest tet height of its block.
    pub free_place: Worst,
    /// Speed that a sliding block gained while its contact rebounded, over the largest speed.
    pub rebound_speed: Worst,
    /// Speed that a block which deforms gained while its contact rebounded, found from the impulse of contact, over the largest speed; holds on one plane only.
    pub rebound_speed_on_a_plane: Worst,
    /// |action + reaction| / |force| over the pairs.
    pub action_reaction: f64,
    /// smallest det F.
    pub smallest_volume_ratio: f64,
    /// largest principal strain of an element at a sample, in the frame of its block; none below 0.01.
    pub largest_strain: Worst,
    /// h = ω_c Δt, ω_c² bounded by the row sums of the contact stiffness over nodal masses, or by those of whole blocks.
    pub max_h: f64,
    /// relative travel of two blocks that may meet in a step over the width of the thinner one.
    pub max_travel: Worst,
    /// error of a place over the smallest tet height of its block, for turns that are behind.
    pub turn_place: Worst,
    /// error of a velocity over the largest speed, for turns that are behind.
    pub turn_speed: f64,
    /// Error of a place over the smallest tet height of its block, for a block that turns though its supports are taken to keep it from turning.
    pub kept_turn_place: Worst,
    /// Error of a velocity over the largest speed, for the same.
    pub kept_turn_speed: Worst,
    /// Error of a velocity over the largest speed, for blocks that turn with the inertia of lumped masses.
    pub lumped_speed: Worst,
    /// Error of a place over the smallest tet height of its block, for the same.
    pub lumped_place: Worst,
    /// error of a velocity over the largest speed, for the ringing of contact and supports.
    pub ringing: Worst,
    /// speed of elastic vibrations that turns over in a step, over the largest speed and the block's elastic scale; none below 0.001,
    /// and that of the last sample where the integrator lets them die out.
    pub vibration: f64,
    /// speed that loads and motions bring and take back within a step, over the largest speed.
    pub unresolved_speed: f64,
    /// largest error of velocities that damping leaves in a step, over the largest speed.
    pub damping_speed: f64,
    /// error of velocities by damping of contact that steps leave out, at the end of the run, over the largest speed.
    pub contact_damping_speed: f64,
    /// Most pairs looked at in a step.
    pub candidate_pairs_max: usize,
    /// Most pairs in contact in a step.
    pub contact_pairs_max: usize,
    /// Pairs looked at, over all steps.
    pub candidate_pairs_total: u64,
    /// Pairs in contact, over all steps.
    pub contact_pairs_total: u64,
    /// Most evaluations of contact that a step was solved with.
    pub iterations_max: u32,
    /// Counts of step control.
    pub control: StepCounts,
}
