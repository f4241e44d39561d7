//! How a run is getting on.

use std::fmt;
use std::ops::Range;
use std::time::Instant;

use ndda_solver::View;
use serde::Serialize;

/// How a run is getting on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pace {
    /// Steps done.
    pub step: u64,
    /// Steps of the run.
    pub steps: u64,
    /// Time of the scene [s].
    pub time_s: f64,
    /// Time spent since this part of the run began [s].
    pub spent_s: f64,
    /// Time left at this pace [s].
    pub left_s: f64,
    /// Pairs of elements in contact.
    pub contacts: usize,
    /// ω_c Δt of the last step.
    pub h: f64,
    /// Largest penetration over the height of a tetrahedron.
    pub penetration_ratio: f64,
    /// Largest gain of energy so far, over the largest energy.
    pub energy_gain: f64,
}

impl Pace {
    /// After a step of a run that began at the first of `steps`, at some instant.
    pub fn of(view: &View, steps: Range<u64>, started: Instant) -> Self {
        let step = view.simulation.state().step;
        let spent_s = started.elapsed().as_secs_f64();
        let (done, to_do) = (step - steps.start, steps.end.saturating_sub(step));
        Self {
            step,
            steps: steps.end,
            time_s: view.simulation.time_s(),
            spent_s,
            left_s: spent_s * to_do as f64 / done.max(1) as f64,
            contacts: view.report.contact.contact_pairs,
            h: view.report.h,
            penetration_ratio: view.report.contact.max_penetration_ratio,
            energy_gain: view.simulation.invariants().energy_gain,
        }
    }
}

impl fmt::Display for Pace {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { time_s, contacts, h, .. } = self;
        let (depth, gain) = (100.0 * self.penetration_ratio, 100.0 * self.energy_gain);
        write!(
            f,
            "t = {time_s:.4} s  {contacts} contacts  stability {h:.2}  penetration {depth:.2} %  energy error {gain:.1e} %"
        )
    }
}
