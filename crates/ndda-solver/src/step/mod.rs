//! The problem, the state, and the step that joins them.

pub(crate) mod account;
pub(crate) mod adaptive_damping;
pub(crate) mod blocks;
pub(crate) mod bolt_forces;
pub(crate) mod bolt_queries;
pub(crate) mod change;
pub(crate) mod clock;
pub(crate) mod contact_fields;
pub(crate) mod contact_forces;
pub(crate) mod contact_moments;
pub(crate) mod contact_rates;
pub(crate) mod control;
pub(crate) mod deformation;
pub(crate) mod drawn_overlaps;
pub(crate) mod drive;
pub(crate) mod first_step;
pub(crate) mod follower;
pub(crate) mod force_energies;
pub(crate) mod implicit_contact;
pub(crate) mod line_search;
pub(crate) mod loads;
pub(crate) mod local_damping;
pub(crate) mod mass_scaling;
pub(crate) mod oscillation;
pub(crate) mod plan;
pub(crate) mod queries;
pub(crate) mod quiet;
pub(crate) mod ranks;
pub(crate) mod release;
pub(crate) mod report;
pub(crate) mod sample;
pub(crate) mod settle;
pub(crate) mod settling_progress;
pub(crate) mod settling_step;
pub(crate) mod setup;
pub(crate) mod slow_speed;
pub(crate) mod snapshot;
pub(crate) mod stage;
pub(crate) mod stage_state;
pub(crate) mod start_snapshot;
pub(crate) mod state;
#[cfg(test)]
pub(crate) mod test_boxes;
pub(crate) mod travel;
pub(crate) mod unsettled;

use crate::step::account::StageWatch;
use crate::step::report::StageTimes;
use crate::step::report::StepReport;

use ndda_contact::{Body as ContactBody, ContactModel, FacetContact};
use ndda_fem::Table;
use ndda_mesh::{BlockSet, Vec3};
use rayon::prelude::*;

use crate::bodies::body::Body;
use crate::bodies::congruent_groups::CongruentGroups;
use crate::bodies::prototype::Prototype;
use crate::bodies::workspaces::{BorrowedRun, Workspaces};
use crate::bolts::set::Bolts;
use crate::diagnostics::block_sums::StepSums;
use crate::diagnostics::ledger::Ledger;
use crate::error::StepError;
use crate::integrators::time_integrator::{StepWeights, TimeIntegrator};
use crate::linear::linear_solver::LinearSolver;
use crate::step::contact_moments::ContactMoments;
use crate::step::control::Control;
use crate::step::follower::Places;
use crate::step::implicit_contact::Newton;
use crate::step::loads::Loads;
use crate::step::mass_scaling::ScaledMasses;
use crate::step::ranks::Ranks;
use crate::step::settling_step::SettlingStep;
use crate::step::stage_state::StageState;
use crate::step::state::State;
use crate::step::travel::Travel;

/// Nodes per half below which a second thread costs more than it brings.
pub(crate) const GRAIN_NODES: usize = 400;

/// Nodes below which a second thread costs more than it brings where little is done to each.
pub(crate) const MANY_NODES: usize = 1 << 14;

/// Changes the entry of each node by that of another array, on all threads where they are many.
pub(crate) fn each_node(
    entries: &mut [Vec3],
    others: &[Vec3],
    change: impl Fn(&mut Vec3, &Vec3) + Sync + Send,
) {
    if entries.len() > MANY_NODES {
        let each = entries.par_iter_mut().zip(others).with_min_len(MANY_NODES / 2);
        each.for_each(|(entry, other)| change(entry, other));
    } else {
        entries.iter_mut().zip(others).for_each(|(entry, other)| change(entry, other));
    }
}

/// A problem on its way through time.
pub struct Simulation {
    pub(crate) problem: Problem,
    pub(crate) state: State,
    pub(crate) bodies: Vec<Body>,
    pub(crate) loads: Loads,
    pub(crate) contact: Option<Box<dyn ContactModel>>,
    /// Contact at the end of steps; none where it is taken at predicted positions.
    pub(crate) newton: Option<Box<Newton>>,
    /// Correction that conserves angular momentum where the integrator evaluates contact away from mid-step or remembers accelerations.
    pub(crate) contact_moments: Option<Box<ContactMoments>>,
    /// Rock bolts, if there are any.
    pub(crate) bolts: Option<Box<Bolts>>,
    /// The length of the parts that a step is done in, and the integrator's weights for it.
    pub(crate) part_s: f64,
    pub(crate) weights: StepWeights,
    pub(crate) control: Option<Box<Control>>,
    /// What steps see while a scene settles; none otherwise.
    pub(crate) settling: Option<SettlingStep>,
    /// What stages keep; none in a scene without them.
    pub(crate) stage: Option<Box<StageState>>,
    /// The ranks that take the steps together.
    pub(crate) ranks: Ranks,
    pub(crate) scratch: Scratch,
    pub(crate) audit: Audit,
}

/// Data that no step changes.
pub(crate) struct Problem {
    pub(crate) blocks: BlockSet,
    /// Operators, supports and factors; congruent blocks share one.
    pub(crate) shapes: Vec<Prototype>,
    /// Memory to work in for the blocks of each shape; none where each has its own.
    pub(crate) workspaces: Vec<Option<Workspaces>>,
    /// Groups of congruent blocks that one thread solves together.
    pub(crate) runs: CongruentGroups,
    pub(crate) integrator: Box<dyn TimeIntegrator>,
    /// The solver that factors K̃ of each block.
    pub(crate) solver: Box<dyn LinearSolver>,
    /// Δt of a whole step.
    pub(crate) base_step_s: f64,
    /// Gravity \[m/s²\].
    pub(crate) gravity_m_s2: Vec3,
    /// Factor on it over time; constant without.
    pub(crate) gravity_factor: Option<Table>,
    /// Which blocks move by an affine map; empty without contact.
    pub(crate) affine: Vec<bool>,
    pub(crate) min_friction_coefficient: f64,
    /// Whether blocks are damped, or nodes of them follow a prescribed motion.
    pub(crate) has_impulses: bool,
}

impl Problem {
    /// Lets a run of blocks of one shape have memory to work in.
    pub(crate) fn lend_memory<'a>(&'a self, run: &'a mut [Body]) -> BorrowedRun<'a> {
        let shape = run[0].shape;
        BorrowedRun::new(&self.shapes[shape], self.workspaces[shape].as_ref(), run)
    }
}

/// Forces and places of a step, in memory that every step uses again.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(crate) force: Vec<Vec3>,
    pub(crate) friction_force: Vec<Vec3>,
    pub(crate) contact_stiffness: Vec<f64>,
    /// Whether `friction_force` or `contact_stiffness` may hold values other than zero; if not, they are neither cleared nor read.
    pub(crate) contact_has_acted: bool,
    /// Whether the stiffness of contact alone is asked for.
    pub(crate) is_without_friction: bool,
    pub(crate) contact_position: Vec<Vec3>,
    /// Scratch for positions with contact offsets.
    pub(crate) seen_position: Vec<Vec3>,
    pub(crate) contact_bodies: Vec<ContactBody>,
    /// Inertia of blocks while a scene settles with mass scaling; none otherwise.
    pub(crate) scaled_masses: Option<Box<ScaledMasses>>,
    /// Node positions before the step, overwritten in the same step by its displacements [m]; empty without contact.
    pub(crate) moved: Vec<Vec3>,
}

/// Observers of a run: balances, diagnostics, timing.
pub(crate) struct Audit {
    pub(crate) ledger: Ledger,
    pub(crate) step_sums: Box<StepSums>,
    pub(crate) stages: StageTimes,
    pub(crate) travel: Travel,
    /// Facets in contact in the last step, if they were requested.
    pub(crate) contacts: Option<Vec<FacetContact>>,
    /// Whether forces of contact are those of the present state: of its last step, or of its start at rest.
    pub(crate) contact_is_known: bool,
    /// Uncertainty of the direction of contact forces in this step, as a fraction of their size: the largest penetration ratio, or 0 where friction
    /// everywhere can carry that much.
    pub(crate) direction_uncertainty: f64,
}

impl Simulation {
    /// One step Δt, in the paper's order; contact and rotation are evaluated at other times than in the paper (docs/theory/method.md).
    ///
    /// # Errors
    /// [`StepError`] naming time, block and element; the state is then not to be used.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        // Called from outside the thread pool, each parallel loop of contact would wake it and wait for it by itself.
        if self.contact.is_some() && rayon::current_thread_index().is_none() {
            return rayon::scope(|_| self.whole_step());
        }
        self.whole_step()
    }

    fn whole_step(&mut self) -> Result<StepReport, StepError> {
        let Some(mut control) = self.control.take() else { return self.part_step() };
        let report = self.controlled_step(&mut control);
        self.control = Some(control);
        report
    }

    /// Advances by a whole step, or by one of the parts that a step is done in: loads, contact, each block alone, then the clock. The first step also sets how
    /// far ahead contact looks; the other calls only measure.
    pub(crate) fn part_step(&mut self) -> Result<StepReport, StepError> {
        let mut watch = StageWatch::start();
        self.gather_loads();
        self.offset_contact_in_the_first_step()?;
        let (contact, iterations) = self.gather_contact()?;
        self.audit.contact_is_known = true;
        self.watch_contact(&contact);
        watch.stop(&mut self.audit.stages.contact_s);
        self.scale_forces();
        self.solve_blocks()?;
        watch.stop(&mut self.audit.stages.blocks_s);
        let report = self.account_for_step(contact, iterations);
        self.advance_clock();
        watch.stop(&mut self.audit.stages.ledger_s);
        Ok(report)
    }

    /// f ← all loads, averaged over the step around the time at which the integrator evaluates them.
    fn gather_loads(&mut self) {
        let lead = self.weights.load_lead;
        let (from_s, to_s) = (self.clock_s(lead - 0.5), self.clock_s(lead + 0.5));
        let State { position, velocity, .. } = &self.state;
        self.loads.place(from_s, to_s, Places { position, velocity, lead_s: lead * self.part_s });
        self.scratch.force.copy_from_slice(self.loads.total());
    }
}
