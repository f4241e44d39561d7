//! Accounts of a step: impulses, work, energies of pairs, and extremes.

use crate::step::each_node;
use crate::step::report::StepReport;
use std::time::Instant;

use ndda_contact::ContactReport;
use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::ExactSum;

use crate::diagnostics::block_sums::ExactVector;
use crate::diagnostics::ringing::Quadrature;
use crate::diagnostics::squeeze::Fastest;
use crate::step::report::Iterations;
use crate::step::{Audit, Simulation};

/// Seconds of the stages of a step.
pub(super) struct StageWatch(Instant);

impl StageWatch {
    pub(super) fn start() -> Self {
        Self(Instant::now())
    }

    /// Adds the time since the last stop.
    pub(super) fn stop(&mut self, stage_s: &mut f64) {
        let now = Instant::now();
        *stage_s += (now - self.0).as_secs_f64();
        self.0 = now;
    }
}

impl Simulation {
    /// Notes contacts, places before the step, and how well the direction of contact forces is known.
    pub(super) fn watch_contact(&mut self, contact: &ContactReport) {
        let depth = contact.max_penetration_ratio;
        self.audit.direction_uncertainty =
            if depth > self.problem.min_friction_coefficient { depth } else { 0.0 };
        self.note_contacts();
        if self.contact_does_work(contact) || self.contact_is_damped(contact) {
            let Self { scratch, state, .. } = self;
            each_node(&mut scratch.moved, &state.position, |moved, x| *moved = *x);
        }
    }

    /// Impulses, work and extremes of the step.
    pub(super) fn account_for_step(&mut self, contact: ContactReport, iterations: Iterations) -> StepReport {
        let sums = &mut self.audit.step_sums;
        sums.clear();
        sums.force.add(&self.loads.force());
        sums.exchanged_n.add(self.loads.size_n());
        sums.exchanged_n.add(self.bolts.as_ref().map_or(0.0, |bolts| bolts.size_n()));
        sums.friction_j.add(contact.dilation_work_j);
        let (mut rate2, mut speed_m_s) = (0.0f64, 0.0f64);
        for body in &self.bodies {
            let report = &body.report;
            sums.add(report, self.part_s);
            rate2 = rate2.max(report.contact_rate2);
            speed_m_s = speed_m_s.max(report.speed_m_s);
        }
        self.record_pushes(&contact);
        let quadrature = self.quadrature();
        let bodies = &self.bodies;
        let ledger = &mut self.audit.ledger;
        let fastest = Fastest { now_m_s: speed_m_s, so_far_m_s: ledger.largest_speed_m_s().max(speed_m_s) };
        ledger.blocks().add_ringing((&quadrature, &fastest), |block| &bodies[block].report.drive);
        let travel = self.travel_of_step(speed_m_s);
        let h = self.part_s * rate2.sqrt();
        let Audit { ledger, step_sums, .. } = &mut self.audit;
        ledger.add_sums(step_sums, self.part_s, &self.weights);
        if self.problem.has_impulses {
            self.record_impulses();
        }
        let contact_work_j = self.record_contact_work(&contact);
        if self.audit.direction_uncertainty > 0.0 {
            self.record_lateral_drift();
        }
        self.record_springs(&contact);
        self.audit.ledger.watch_speeds(speed_m_s, self.unresolved_m_s());
        let report = StepReport { contact, h, travel, contact_work_j, iterations };
        self.audit.ledger.watch(&report);
        report
    }

    /// How this step takes forces.
    pub(super) fn quadrature(&self) -> Quadrature {
        Quadrature {
            dt_s: self.part_s,
            is_one_sided: self.newton.is_some() || self.problem.integrator.contact_bound().is_none(),
            elastic_lag: self.weights.elastic_lag(),
            judges_pairs: self.weights.forces_do_their_work(),
            is_first: self.steps_done(0.0) == 0.0,
        }
    }

    /// Whether anything touches, and the work of its forces is what changes the energy of blocks.
    pub(super) fn contact_does_work(&self, contact: &ContactReport) -> bool {
        contact.contact_pairs > 0 && self.weights.forces_do_their_work()
    }

    /// Whether anything touches that may be damped.
    fn contact_is_damped(&self, contact: &ContactReport) -> bool {
        contact.contact_pairs > 0 && self.contact.as_ref().is_some_and(|model| model.damps())
    }

    /// Records the work of contact damping in the step.
    fn record_contact_damping(&mut self) {
        let Some(model) = self.contact.as_mut().filter(|model| model.damps()) else { return };
        let (position, moved) = (&self.scratch.contact_position, &self.scratch.moved);
        let mut work_j = ExactSum::new();
        let add = &mut |_, _, part_j| work_j.add(part_j);
        model.each_damping_work(&self.problem.blocks, position, moved, add);
        self.audit.ledger.add_restitution_work(work_j.value());
    }

    /// Records the work of normal contact in the step on both blocks of each pair; returns the sum over single facets, without
    /// sign, where steps are controlled [J].
    pub(super) fn record_contact_work(&mut self, contact: &ContactReport) -> f64 {
        let works = self.contact_does_work(contact);
        let mut contact_work_j = ExactSum::new();
        self.audit.travel.touching.clear();
        if works || self.contact_is_damped(contact) {
            let Self { scratch, state, .. } = self;
            each_node(&mut scratch.moved, &state.position, |moved, x| *moved = x - *moved);
            self.record_contact_damping();
        }
        let Some(model) = self.contact.as_mut().filter(|_| works) else { return 0.0 };
        let (books, travel) = (self.audit.ledger.blocks(), &mut self.audit.travel);
        model.each_work(&self.problem.blocks, &self.scratch.moved, &mut |a, b, work_j| {
            books.add_work(a, b, work_j);
            if travel.notes_touching {
                travel.note_touching(a, b);
                contact_work_j.add(work_j.abs());
            }
        });
        model.each_coulomb_gap(&self.problem.blocks, &self.scratch.moved, &mut |a, b, gap_j| {
            books.add_coulomb_gap(a, b, gap_j);
        });
        books.close_step();
        contact_work_j.value()
    }

    /// Records what presses each block, where friction is in proportion to it.
    fn record_pushes(&mut self, contact: &ContactReport) {
        let Some(model) = self.contact.as_ref().filter(|model| model.has_friction()) else { return };
        if contact.contact_pairs > 0 {
            let (books, bodies) = (self.audit.ledger.blocks(), &self.bodies);
            let mut add = |block: BlockId, push_n: &Vec3| {
                books.add_push(block, push_n, &bodies[block.index()].report.drive.load_m_s2);
            };
            model.each_push(&mut |owner, target, push_n| {
                add(owner, push_n);
                add(target, &-push_n);
            });
        }
    }

    /// Records the slip of shear springs in the step.
    pub(super) fn record_springs(&mut self, contact: &ContactReport) {
        let Some(model) = self.contact.as_ref() else { return };
        let books = self.audit.ledger.blocks();
        if contact.contact_pairs > 0 {
            model.each_spring_slip(&mut |owner, target, spring| {
                books.add_spring_slip(owner, target, spring);
            });
        }
        books.close_springs(self.part_s);
    }

    /// Records the impulses of damping and of prescribed velocities, and how well the step resolves damping.
    pub(super) fn record_impulses(&mut self) {
        let (mut impulse, mut moment) = (ExactVector::default(), ExactVector::default());
        let mut error_m_s: f64 = 0.0;
        for report in self.bodies.iter().map(|body| &body.report) {
            impulse.add(&report.impulse);
            moment.add(&report.impulse_moment);
            error_m_s = error_m_s.max(report.damping_error_m_s);
        }
        self.audit.ledger.add_impulses(impulse.value(), moment.value(), error_m_s);
    }

    /// Records the lateral drift of clamped blocks.
    pub(super) fn record_lateral_drift(&mut self) {
        let books = self.audit.ledger.blocks();
        for (block, body) in self.problem.blocks.ids().zip(&self.bodies) {
            books.add_lateral_drift(block, self.part_s, &body.report.lateral_drift);
        }
    }

    /// Speed that loads and motions bring and take back within the step, where nobody sees it [m/s].
    pub(super) fn unresolved_m_s(&self) -> f64 {
        let (now_s, end_s) = (self.clock_s(0.0), self.clock_s(1.0));
        let motions = self.problem.shapes.iter().map(|shape| &shape.supports);
        let motions = motions.flat_map(|supports| supports.motions.iter().chain(&supports.quiet.waves));
        let fastest = motions.map(|motion| motion.unresolved_m_s(now_s, end_s)).fold(0.0, f64::max);
        self.loads.unresolved_m_s().max(fastest)
    }
}
