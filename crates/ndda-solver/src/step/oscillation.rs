//! The oscillations of a scene on its way to rest, by its kinetic energy.

use serde::{Deserialize, Serialize};

/// The oscillations of the whole scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Oscillation {
    energy_j: f64,
    /// Largest energy at which it was stopped, older ones counting less; none before the first time.
    peak_j: Option<f64>,
    /// Steps since it was stopped, and between the last two stops.
    since: u64,
    between: u64,
    /// Most steps between two stops: a quarter of the slowest oscillation.
    pub(super) longest: u64,
}

/// Weight of the previous peak one oscillation later: a small one may be chance, many in a row are not.
const REMEMBERED: f64 = 0.7;

impl Oscillation {
    /// Takes the energy after a step; true when the scene is past its peak.
    pub(super) fn is_past_peak(&mut self, energy_j: f64) -> bool {
        // One that no longer gains any is where nothing drives it.
        let past = energy_j <= self.energy_j;
        self.since += 1;
        if past {
            (self.between, self.since) = (self.since, 0);
            self.longest = self.longest.max(self.between);
            self.peak_j = Some(self.energy_j.max(REMEMBERED * self.peak_j.unwrap_or(0.0)));
        }
        self.energy_j = if past { 0.0 } else { energy_j };
        past
    }

    /// Kinetic energy after the last step, if it was not stopped there [J].
    pub(super) fn energy_j(&self) -> f64 {
        self.energy_j
    }

    /// Energy that it may still have: what it has, and what its last oscillations had.
    pub(super) fn left_j(&self) -> f64 {
        match self.peak_j {
            // An oscillation that does not come back is over.
            Some(peak_j) => {
                let oscillations = self.since as f64 / self.between as f64;
                (peak_j * REMEMBERED.powf(oscillations)).max(self.energy_j)
            }
            None if self.energy_j > 0.0 => f64::INFINITY,
            None => 0.0,
        }
    }
}
