//! How a run is getting on.

use std::fmt;
use std::ops::Range;
use std::time::Instant;

use ndda_solver::View;
use serde::Serialize;

use crate::numbers::counted;

/// A stability number below this is far from any limit, and is not shown.
const LEAST_H: f64 = 0.005;

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
    /// Contact stability number of the last step, ω_c Δt; 0 where nothing touches.
    pub h: f64,
    /// Largest stable number; none where there is no contact, or contact is stable at any step.
    #[serde(skip)]
    pub bound: Option<f64>,
    /// Whether blocks can touch at all.
    #[serde(skip)]
    pub has_contact: bool,
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
            bound: view.simulation.contact_bound(),
            has_contact: view.simulation.has_contact(),
            penetration_ratio: view.report.contact.max_penetration_ratio,
            energy_gain: view.simulation.invariants().energy_gain,
        }
    }
}

impl fmt::Display for Pace {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { time_s, contacts, h, .. } = self;
        write!(f, "t = {time_s:.4} s")?;
        if self.has_contact {
            write!(f, "  {}", counted(*contacts, "contact", "contacts"))?;
        }
        // Of blocks that do not touch there is neither a stability nor a penetration.
        if *contacts > 0 {
            if let Some(bound) = self.bound.filter(|_| *h >= LEAST_H) {
                write!(f, "  contact stability number {h:.2} (limit {bound})")?;
            }
            write!(f, "  penetration {:.2} % of an element", 100.0 * self.penetration_ratio)?;
        }
        write!(f, "  energy error {:.1e} %", 100.0 * self.energy_gain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PACE: Pace = Pace {
        step: 10,
        steps: 100,
        time_s: 0.1,
        spent_s: 1.0,
        left_s: 9.0,
        contacts: 12,
        h: 0.35,
        bound: Some(2.0),
        has_contact: true,
        penetration_ratio: 0.0123,
        energy_gain: 1e-6,
    };

    #[test]
    fn the_line_says_what_the_stability_number_is_and_leaves_out_what_means_nothing() {
        let text = PACE.to_string();
        assert!(text.contains("12 contacts  contact stability number 0.35 (limit 2)"), "{text}");
        let falls = Pace { contacts: 0, h: 0.0, penetration_ratio: 0.0, ..PACE }.to_string();
        assert_eq!(falls, "t = 0.1000 s  no contacts  energy error 1.0e-4 %");
        let alone = Pace { contacts: 0, has_contact: false, bound: None, ..PACE }.to_string();
        assert_eq!(alone, "t = 0.1000 s  energy error 1.0e-4 %");
        let implicit = Pace { bound: None, ..PACE }.to_string();
        assert!(!implicit.contains("stability"), "{implicit}");
    }
}
