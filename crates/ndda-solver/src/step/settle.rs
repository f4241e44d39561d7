//! Bringing a scene to rest before it begins.
//!
//! Kinetic damping (Cundall 1976; Barnes 1999): the scene moves freely until its kinetic energy begins to fall, which is
//! where its forces balance on the way; there it is stopped, and starts again from nearer to equilibrium. All blocks are
//! stopped at once: each by itself, a stack of fifty would take 27 times the steps, since the quick oscillations of neighbours
//! would stop the slow one of the whole again and again. Blocks that deform oscillate too quickly to be stopped at a peak, where their masses are scaled: with
//! adaptive damping, all velocities are damped in proportion ([`AdaptiveDamping`](crate::step::adaptive_damping::AdaptiveDamping)). With local damping, each block is damped by itself, in proportion to its
//! unbalanced force ([`LocalDamping`](crate::LocalDamping)).
//!
//! On the way a scene swings beyond its rest, and bonds would break that carry less than their strength at rest. They hold, therefore, until the scene rests; those
//! that carry more are let go then, and it comes to rest once more.

use std::ops::ControlFlow;

use ndda_contact::ContactModel;
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::ExactSum;
use serde::{Deserialize, Serialize};

use crate::error::StepError;
use crate::step::Simulation;
use crate::step::mass_scaling::ScaledMasses;
use crate::step::report::StepReport;
use crate::step::settling_progress::{Damping, Progress};
use crate::step::settling_step::{Ramp, SettlingStep};

/// How far a scene is to settle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settle {
    /// Largest speed left over the largest speed on the way, by the kinetic energy of the scene; on the way is also what
    /// loads alone would bring in the first step, where a scene is at rest from the start, and in the course of a run
    /// ([`Simulation::settle_within`]) what they would bring in a quarter of the slowest oscillation.
    pub tolerance: f64,
    /// Steps after which it is given up.
    pub most_steps: u64,
    /// Damping on the way to rest; without, `Adaptive` where blocks deform, contact is taken at predicted positions and friction does not act on velocities, `Kinetic` elsewhere.
    pub damping: Option<Damping>,
    /// Whether blocks have the inertia on the way with which contact makes all of them oscillate as fast as the step allows. Contact at the end of the step
    /// takes no notice of it, and in the course of a run rigid blocks take none.
    pub mass_scaling: bool,
}

impl Settle {
    /// Settling with kinetic damping and true masses.
    pub fn new(tolerance: f64, most_steps: u64) -> Self {
        Self { tolerance, most_steps, damping: Some(Damping::Kinetic), mass_scaling: false }
    }
}

/// How a scene settled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Settled {
    /// Steps that it took.
    pub steps: u64,
    /// Speed left over the largest speed on the way.
    pub speed_ratio: f64,
    /// The smallest and the largest factor on the inertia of blocks in the last step; none without mass scaling.
    pub inertia_factors: Option<[f64; 2]>,
    /// Bonds that carried more than their strength when the scene first rested, and were let go.
    pub overloaded_bonds: usize,
}

/// A scene on its way to rest: all that settling keeps between two steps, besides the state of the simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settling {
    settled: Settled,
    /// Positions at which settling began.
    from: Vec<Vec3>,
    /// Velocities with which time begins.
    start: Vec<Vec3>,
    progress: Progress,
    /// Inertia of blocks; none without mass scaling.
    masses: Option<Box<ScaledMasses>>,
    /// Least speed over the largest so far, and the step of that.
    least: (f64, u64),
    /// Whether bonds still hold whatever they carry.
    bonds_hold: bool,
}

impl Settling {
    fn new(simulation: &Simulation, progress: Progress, start: Vec<Vec3>) -> Self {
        let settled = Settled { speed_ratio: f64::INFINITY, ..Settled::default() };
        Self {
            settled,
            from: simulation.state.position.clone(),
            start,
            progress,
            masses: None,
            least: (f64::INFINITY, 0),
            bonds_hold: true,
        }
    }

    /// Lets bonds go that carry more than their strength, from where the scene rests; whether there are any.
    fn lets_go(&mut self, progress: Progress) -> bool {
        let lets_go = self.bonds_hold && self.settled.overloaded_bonds > 0;
        if lets_go {
            self.progress = progress;
            self.settled.speed_ratio = f64::INFINITY;
            self.least = (f64::INFINITY, self.settled.steps);
        }
        self.bonds_hold = false;
        lets_go
    }

    /// Takes the speed that is left; how many steps it has not become less for, once these are many.
    fn stalls(&mut self) -> Option<u64> {
        let Settled { steps, speed_ratio, .. } = self.settled;
        let (least, since) = &mut self.least;
        if speed_ratio < LESS * *least {
            (*least, *since) = (speed_ratio, steps);
        }
        let stalled = steps - *since;
        let slowest = PATIENT_QUARTERS * self.progress.oscillation.longest;
        (*least < 1.0 && stalled >= PATIENCE.max(2 * *since).max(slowest)).then_some(stalled)
    }

    /// How far it has come.
    pub fn settled(&self) -> Settled {
        self.settled
    }
}

/// Steps between looks at how far blocks have gone.
const LOOK: u64 = 100;

/// A scene is given up where the speed left has not become less, by a tenth, for so many steps, twice as many as all before, and so many quarters of its
/// slowest oscillation.
const LESS: f64 = 0.9;
const PATIENCE: u64 = 10_000;
const PATIENT_QUARTERS: u64 = 20;

impl Simulation {
    /// Runs with kinetic damping until all blocks are at rest, then sets time and displacements to zero; initial
    /// velocities come after it. What contact remembers stays; loads and prescribed motions are those of the start.
    ///
    /// # Errors
    /// [`StepError::NotSettled`] when the steps do not suffice or a block has gone farther than all blocks extend, or as [`step`](Self::step).
    pub fn settle(&mut self, settle: &Settle) -> Result<Settled, StepError> {
        self.settle_watched(settle, &mut |_| ControlFlow::Continue(()))
    }

    /// The same, asking after each step whether to go on; where not, the scene is left in the middle of it.
    ///
    /// # Errors
    /// As [`settle`](Self::settle).
    pub fn settle_watched(
        &mut self,
        settle: &Settle,
        watch: &mut dyn FnMut(&Settled) -> ControlFlow<()>,
    ) -> Result<Settled, StepError> {
        let mut settling = self.begin_to_settle(settle);
        self.go_on_settling(settle, &mut settling, watch)?;
        Ok(settling.settled)
    }

    /// A scene that is about to settle: velocities are kept for later, and blocks start from rest.
    pub fn begin_to_settle(&mut self, settle: &Settle) -> Settling {
        let nodes = self.state.velocity.len();
        let start = std::mem::replace(&mut self.state.velocity, vec![Vec3::zeros(); nodes]);
        self.note_blow();
        let damping = self.damping_of(settle);
        let masses = if settle.mass_scaling { self.masses_to_settle_with(damping) } else { None };
        self.put_on(masses);
        let mut settling = Settling::new(self, Progress::new(self, damping), start);
        settling.masses = self.take_off();
        settling
    }

    /// Goes on until the scene is at rest, and time begins there; false where `watch` has broken it off, after a step from which it can go on.
    /// It also goes on, bit for bit, from a [`Snapshot`](crate::Snapshot) that was taken together with `settling`.
    ///
    /// # Errors
    /// As [`settle`](Self::settle).
    pub fn go_on_settling(
        &mut self,
        settle: &Settle,
        settling: &mut Settling,
        watch: &mut dyn FnMut(&Settled) -> ControlFlow<()>,
    ) -> Result<bool, StepError> {
        self.scale_masses(settling.masses.take())?;
        let mut rests = self.come_to_rest((settle, settling), &Ramp::default(), watch);
        if matches!(rests, Ok(Some(_))) && settling.lets_go(Progress::new(self, self.damping_of(settle))) {
            rests = self.come_to_rest((settle, settling), &Ramp::default(), watch);
        }
        let unsettled = self.least_settled();
        settling.masses = self.unscale_masses()?;
        if rests?.is_none() {
            return Ok(false);
        }
        let force = std::mem::take(&mut self.scratch.force);
        let kept = self.keep_static_reactions(&force);
        self.scratch.force = force;
        kept?;
        self.begin_at_rest(std::mem::take(&mut settling.start));
        self.audit.ledger.note_unsettled(unsettled);
        Ok(true)
    }

    /// How the scene is damped on the way.
    fn damping_of(&self, settle: &Settle) -> Damping {
        // Friction on velocities may keep blocks vibrating under damping that does not stop them.
        let chatters = self.contact.as_ref().is_some_and(|model| model.needs_bodies());
        let is_adaptive = self.deforms() && self.newton.is_none() && !chatters;
        settle.damping.unwrap_or(if is_adaptive { Damping::Adaptive } else { Damping::Kinetic })
    }

    fn deforms(&self) -> bool {
        self.problem.shapes.iter().any(|shape| shape.deforms())
    }

    /// Whether blocks deform under friction on damped contact, which may keep them vibrating between the stops of kinetic damping, at steps that resolve contact, too.
    fn may_chatter(&self) -> bool {
        let is_damped = |model: &dyn ContactModel| model.damps() && model.has_friction();
        self.deforms() && self.contact.as_deref().is_some_and(is_damped)
    }

    /// Runs with damping until all blocks are at rest, and loads and prescribed motions have gone through a ramp; gives the last step, or none where
    /// somebody broke it off.
    fn come_to_rest(
        &mut self,
        (settle, settling): (&Settle, &mut Settling),
        ramp: &Ramp,
        watch: &mut dyn FnMut(&Settled) -> ControlFlow<()>,
    ) -> Result<Option<StepReport>, StepError> {
        let mut report = StepReport::default();
        let extent_m = Aabb::around(settling.from.iter()).diagonal();
        // The last step of a ramp has loads of its middle: one at least has those of its end.
        let least_steps = ramp.steps + u64::from(ramp.steps > 0);
        while settling.settled.steps < least_steps || settling.settled.speed_ratio > settle.tolerance {
            let Settled { steps, speed_ratio, .. } = settling.settled;
            let leaves = steps % LOOK == LOOK - 1 && self.farthest(&settling.from)[0].0 > extent_m;
            let stalled = settling.stalls();
            if steps == settle.most_steps || leaves || stalled.is_some() {
                return Err(self.not_settled(settling, stalled));
            }
            let (at_s, ratio) = (ramp.at_s(steps), speed_ratio.max(settle.tolerance));
            self.settling = Some(SettlingStep::new(at_s, ratio, settling.bonds_hold));
            (report, settling.settled.speed_ratio) = settling.progress.step(self)?;
            if settling.bonds_hold {
                settling.settled.overloaded_bonds = report.contact.overloaded_bonds;
            }
            self.follow_contacts(report.h)?;
            settling.settled.steps += 1;
            settling.settled.inertia_factors =
                self.scratch.scaled_masses.as_ref().map(|masses| masses.range());
            if watch(&settling.settled).is_break() {
                return Ok(None);
            }
        }
        Ok(Some(report))
    }

    /// Brings the scene to rest in the course of a run, and goes on from there: displacements and what contact remembers stay. In the first
    /// `ramp_steps` time goes on, damping included, and loads change with it; then time stands still. What damping takes on the way is in the
    /// balance; diagnostics do not judge the way. Gives the last step, too.
    ///
    /// # Errors
    /// As [`settle`](Self::settle).
    pub fn settle_within(
        &mut self,
        settle: &Settle,
        ramp_steps: u64,
        watch: &mut dyn FnMut(&Settled) -> ControlFlow<()>,
    ) -> Result<(Settled, StepReport), StepError> {
        let (step, (old, _)) = (self.state.step, self.look()?);
        let before = self.audit.ledger.clone();
        self.stop_all();
        self.rest_on_quiet_faces();
        let damping = self.damping_of(settle);
        let masses = if settle.mass_scaling { self.masses_in_stages(damping) } else { None };
        self.scale_masses(masses)?;
        let mut settling = Settling::new(self, Progress::within_a_run(self, damping), Vec::new());
        settling.bonds_hold = false;
        let ramp = Ramp { start_s: self.time_s(), step_s: self.step_s(), steps: ramp_steps };
        let last = self.come_to_rest((settle, &mut settling), &ramp, watch);
        let unsettled = self.least_settled();
        self.unscale_masses()?;
        let last = last?;
        self.settling = None;
        let Some(report) = last else { return Ok((settling.settled, StepReport::default())) };
        self.stop_all();
        self.state.step = step + ramp_steps;
        let way = std::mem::replace(&mut self.audit.ledger, before);
        self.audit.ledger.begin_anew_at_contact();
        self.audit.ledger.note_unsettled(unsettled);
        self.audit.ledger.blocks().rest_rebounds();
        let kept_j = self.keep_reactions_of_rest()?;
        let (new, books) = self.look()?;
        self.audit.ledger.blocks().rebase(&books);
        // The work of slip and yielding of bolts is in the balance already.
        let bolts_j = new.bolt_work_j - old.bolt_work_j;
        self.audit.ledger.add_way_to_rest(&way, new.total_j() - old.total_j() - bolts_j - kept_j);
        self.audit.ledger.add_jump_of_momentum(&old, &new);
        if self.has_contact() {
            let (contact, _) = self.contacts_at_start()?;
            self.stop_past_centroid(&contact)?;
            self.audit.ledger.watch_depth(contact.max_penetration_ratio);
        }
        Ok((settling.settled, report))
    }

    /// Stops all nodes.
    pub(super) fn stop_all(&mut self) {
        for block in self.problem.blocks.ids() {
            let nodes = self.problem.blocks.nodes_of(block);
            self.keep_forces(block, |simulation| simulation.state.velocity[nodes].fill(Vec3::zeros()));
        }
    }

    /// How far the centre of each block has gone [m], the farthest first.
    fn farthest(&self, from: &[Vec3]) -> Vec<(f64, BlockId)> {
        let mut moved: Vec<(f64, BlockId)> =
            self.blocks().ids().map(|block| (self.way(from, block).norm(), block)).collect();
        moved.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        moved
    }

    fn way(&self, from: &[Vec3], block: BlockId) -> Vec3 {
        let (nodes, operator) = (self.blocks().nodes_of(block), &self.shape(block).operator);
        operator.center(&self.state.position[nodes.clone()]) - operator.center(&from[nodes])
    }

    /// Which blocks have moved on the way, and where to.
    fn not_settled(&self, settling: &Settling, stalled: Option<u64>) -> StepError {
        let Settling { settled, from, bonds_hold, .. } = settling;
        let moved = self.farthest(from);
        let (gone_m, block) = moved[0];
        let towards = if gone_m > 0.0 { self.way(from, block) / gone_m } else { Vec3::zeros() };
        StepError::NotSettled {
            steps: settled.steps,
            speed_ratio: settled.speed_ratio,
            block: self.blocks().names[block.index()].clone(),
            gone_m,
            towards: towards.into(),
            others: moved[1..].iter().filter(|(gone, _)| *gone >= 0.5 * gone_m && *gone > 0.0).count() as u32,
            stalled,
            overloaded_bonds: if *bonds_hold { 0 } else { settled.overloaded_bonds as u32 },
            divide_step_by: self.divides_step_by(),
            may_chatter: self.may_chatter(),
        }
    }

    /// By how much the step has to be divided for contact that it has not resolved so far.
    fn divides_step_by(&self) -> Option<u32> {
        let times = self.invariants().max_h / self.resolved_h()?;
        (times > 1.0).then_some(times.ceil() as u32)
    }

    /// Kinetic energy of all blocks [J].
    pub(super) fn kinetic_energy_j(&self) -> f64 {
        let of_block = |block: BlockId| {
            let nodes = self.blocks().nodes_of(block);
            self.inertia_factor(block)
                * self.shape(block).operator.kinetic_energy_j(&self.state.velocity[nodes])
        };
        self.blocks().ids().map(of_block).collect::<ExactSum>().value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::kind::BodyKind;
    use crate::step::test_boxes::boxes;

    /// Far apart, of which one has so much energy that those of the others are lost beside it one by one.
    fn flying(speeds_m_s: [f64; 3]) -> Simulation {
        let cube = |k: usize| (BodyKind::Rigid, [1.0; 3], [0.0, 1e3 * k as f64, 0.0]);
        let mut setup = boxes(&[cube(0), cube(1), cube(2)]);
        (setup.contact, setup.gravity_m_s2) = (None, Vec3::zeros());
        for (body, speed_m_s) in setup.bodies.iter_mut().zip(speeds_m_s) {
            body.velocity_m_s = speed_m_s * Vec3::x();
        }
        Simulation::new(setup).unwrap()
    }

    #[test]
    fn the_order_of_blocks_does_not_matter_on_the_way_to_rest() {
        let orders = [[1e8, 1.0, 1.0], [1.0, 1.0, 1e8]];
        let [first, second] = orders.map(|speeds_m_s| flying(speeds_m_s).kinetic_energy_j());
        assert_eq!(first, second);
        assert_ne!(first, flying([1e8, 0.0, 0.0]).kinetic_energy_j(), "the small ones count");
    }
}
