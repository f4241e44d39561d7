//! The problem, the state, and the step that joins them.

pub(crate) mod account;
pub(crate) mod blocks;
pub(crate) mod clock;
pub(crate) mod contact_fields;
pub(crate) mod contact_forces;
pub(crate) mod contact_moments;
pub(crate) mod contact_rates;
pub(crate) mod control;
pub(crate) mod deformation;
pub(crate) mod drive;
pub(crate) mod first_step;
pub(crate) mod follower;
pub(crate) mod implicit_contact;
pub(crate) mod loads;
pub(crate) mod plan;
pub(crate) mod queries;
pub(crate) mod report;
pub(crate) mod sample;
pub(crate) mod settle;
pub(crate) mod setup;
pub(crate) mod snapshot;
pub(crate) mod state;
pub(crate) mod travel;

use crate::step::account::StageWatch;
use crate::step::report::StageTimes;
use crate::step::report::StepReport;

use ndda_contact::{Body as ContactBody, ContactModel, FacetContact};
use ndda_mesh::{BlockSet, Vec3};

use crate::bodies::body::Body;
use crate::bodies::congruent_groups::CongruentGroups;
use crate::bodies::prototype::Prototype;
use crate::diagnostics::ledger::Ledger;
use crate::error::StepError;
use crate::integrators::time_integrator::{StepWeights, TimeIntegrator};
use crate::step::contact_moments::ContactMoments;
use crate::step::control::Control;
use crate::step::follower::Places;
use crate::step::implicit_contact::Newton;
use crate::step::loads::Loads;
use crate::step::state::State;
use crate::step::travel::Travel;

/// Nodes per half below which a second thread costs more than it brings.
pub(crate) const GRAIN_NODES: usize = 400;

/// A problem on its way through time.
pub struct Simulation {
    pub(crate) problem: Problem,
    pub(crate) state: State,
    pub(crate) bodies: Vec<Body>,
    pub(crate) loads: Loads,
    pub(crate) contact: Option<Box<dyn ContactModel>>,
    /// Contact at the end of steps; none where it is taken at predicted positions.
    pub(crate) newton: Option<Box<Newton>>,
    /// Moments of contact forces, for schemes that take them elsewhere than in the middle of a step.
    pub(crate) contact_moments: Option<Box<ContactMoments>>,
    /// The length of the parts that a step is done in, and the integrator's weights for it.
    pub(crate) part_s: f64,
    pub(crate) weights: StepWeights,
    pub(crate) control: Option<Box<Control>>,
    pub(crate) settling: bool,
    pub(crate) scratch: Scratch,
    pub(crate) audit: Audit,
}

/// Data that no step changes.
pub(crate) struct Problem {
    pub(crate) blocks: BlockSet,
    /// Operators, supports and factors; congruent blocks share one.
    pub(crate) shapes: Vec<Prototype>,
    /// Blocks that are solved for together.
    pub(crate) runs: CongruentGroups,
    pub(crate) integrator: Box<dyn TimeIntegrator>,
    /// Δt of a whole step.
    pub(crate) base_step_s: f64,
    /// Which blocks move by an affine map; empty without contact.
    pub(crate) affine: Vec<bool>,
    pub(crate) min_friction_coefficient: f64,
    /// Whether blocks are damped, or nodes of them follow a prescribed motion.
    pub(crate) has_impulses: bool,
}

/// Forces and places of a step, in memory that every step uses again.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(crate) force: Vec<Vec3>,
    pub(crate) friction_force: Vec<Vec3>,
    pub(crate) contact_stiffness: Vec<f64>,
    /// Whether forces of friction and stiffness of contact may be other than zero.
    pub(crate) contact_has_acted: bool,
    pub(crate) contact_position: Vec<Vec3>,
    /// Scratch for positions with contact offsets.
    pub(crate) seen_position: Vec<Vec3>,
    pub(crate) contact_bodies: Vec<ContactBody>,
    /// Where nodes were before the step, later how far it moved them [m]; empty without contact.
    pub(crate) moved: Vec<Vec3>,
}

/// Observers of a run: balances, diagnostics, timing.
pub(crate) struct Audit {
    pub(crate) ledger: Ledger,
    pub(crate) stages: StageTimes,
    pub(crate) travel: Travel,
    /// Facets in contact in the last step, if they were requested.
    pub(crate) contacts: Option<Vec<FacetContact>>,
    /// Direction uncertainty: part of contact forces whose direction is unknown in this step, and that no friction carries.
    pub(crate) direction_uncertainty: f64,
}

impl Simulation {
    /// One step. The order is the paper's; what differs is where contact and rotation are taken.
    ///
    /// # Errors
    /// [`StepError`] naming time, block and element; the state is then not to be used.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        let Some(mut control) = self.control.take() else { return self.part_step() };
        let report = self.controlled_step(&mut control);
        self.control = Some(control);
        report
    }

    /// One step, or one part of a step that is done in several: loads, contact, each block alone; the rest watches.
    pub(crate) fn part_step(&mut self) -> Result<StepReport, StepError> {
        let mut watch = StageWatch::start();
        self.gather_loads();
        self.offset_contact_in_the_first_step()?;
        let (contact, iterations) = self.gather_contact()?;
        self.watch_contact(&contact);
        watch.stop(&mut self.audit.stages.contact_s);
        self.solve_blocks()?;
        watch.stop(&mut self.audit.stages.blocks_s);
        let report = self.account_for_step(contact, iterations);
        self.advance_clock();
        watch.stop(&mut self.audit.stages.ledger_s);
        Ok(report)
    }

    /// f ← gravity, tractions and forces, as their mean over a step about the time at which the integrator takes them.
    fn gather_loads(&mut self) {
        let lead = self.weights.load_lead;
        let (from_s, to_s) = (self.clock_s(lead - 0.5), self.clock_s(lead + 0.5));
        let State { position, velocity, .. } = &self.state;
        self.loads.place(from_s, to_s, Places { position, velocity, lead_s: lead * self.part_s });
        self.scratch.force.copy_from_slice(self.loads.total());
    }
}
