//! Bringing a scene to rest before it begins.
//!
//! Kinetic damping (Cundall 1976; Barnes 1999): the scene moves freely until its kinetic energy begins to fall, which is
//! where its forces balance on the way; there it is stopped, and starts again from nearer to equilibrium. All blocks are
//! stopped at once: each by itself, a stack of fifty would take 27 times the steps, since the quick oscillations of neighbours
//! would stop the slow one of the whole again and again.

use std::ops::ControlFlow;

use ndda_mesh::{BlockId, Vec3};
use serde::{Deserialize, Serialize};

use crate::error::StepError;
use crate::step::Simulation;

/// How far a scene is to settle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settle {
    /// Largest speed left over the largest speed on the way, by the kinetic energy of the scene; on the way is also what
    /// loads alone would bring in the first step, where a scene is at rest from the start.
    pub tolerance: f64,
    /// Steps after which it is given up.
    pub most_steps: u64,
}

/// How a scene settled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Settled {
    /// Steps that it took.
    pub steps: u64,
    /// Speed left over the largest speed on the way.
    pub speed_ratio: f64,
}

/// The oscillations of the whole scene.
#[derive(Clone, Copy, Debug, Default)]
struct Oscillation {
    energy_j: f64,
    /// Largest energy at which it was stopped, older ones counting less; none before the first time.
    peak_j: Option<f64>,
    /// Steps since it was stopped, and between the last two stops.
    since: u64,
    between: u64,
}

/// Weight of the previous peak one oscillation later: a small one may be chance, many in a row are not.
const REMEMBERED: f64 = 0.7;

impl Oscillation {
    /// Takes the energy after a step; true when the scene is past its peak.
    fn is_past_peak(&mut self, energy_j: f64) -> bool {
        // One that no longer gains any is where nothing drives it.
        let past = energy_j <= self.energy_j;
        self.since += 1;
        if past {
            (self.between, self.since) = (self.since, 0);
            self.peak_j = Some(self.energy_j.max(REMEMBERED * self.peak_j.unwrap_or(0.0)));
        }
        self.energy_j = if past { 0.0 } else { energy_j };
        past
    }

    /// Energy that it may still have: what it has, and what its last oscillations had.
    fn left_j(&self) -> f64 {
        match self.peak_j {
            // A oscillation that does not come back is over.
            Some(peak_j) => {
                let oscillations = self.since as f64 / self.between as f64;
                (peak_j * REMEMBERED.powf(oscillations)).max(self.energy_j)
            }
            None if self.energy_j > 0.0 => f64::INFINITY,
            None => 0.0,
        }
    }
}

impl Simulation {
    /// Kinetic energy that the loads would give free blocks in a step [J].
    fn load_energy_j(&self) -> f64 {
        let of_block = |block: BlockId| {
            let load: Vec3 = self.loads.total()[self.blocks().nodes_of(block)].iter().sum();
            0.5 * (self.part_s * load).norm_squared() / self.shape(block).operator.mass_kg
        };
        self.blocks().ids().map(of_block).sum()
    }

    /// Runs with kinetic damping until all blocks are at rest, then sets time and displacements to zero; initial
    /// velocities come after it. What contact remembers stays; loads and prescribed motions are those of the start.
    ///
    /// # Errors
    /// [`StepError::NotSettled`] when the steps do not suffice, or as [`step`](Self::step).
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
        self.settling = true;
        let start = std::mem::take(&mut self.state.velocity);
        self.state.velocity = vec![Vec3::zeros(); start.len()];
        let mut oscillation = Oscillation::default();
        let (mut highest_j, mut settled) =
            (self.load_energy_j(), Settled { speed_ratio: f64::INFINITY, ..Settled::default() });
        while settled.speed_ratio > settle.tolerance {
            if settled.steps == settle.most_steps {
                return Err(StepError::NotSettled { steps: settled.steps, speed_ratio: settled.speed_ratio });
            }
            self.step()?;
            settled.steps += 1;
            let mut total_j = 0.0;
            for block in self.blocks().ids() {
                let nodes = self.blocks().nodes_of(block);
                total_j += self.shape(block).operator.kinetic_energy_j(&self.state.velocity[nodes]);
            }
            highest_j = highest_j.max(total_j);
            if oscillation.is_past_peak(total_j) {
                self.state.velocity.fill(Vec3::zeros());
            }
            settled.speed_ratio =
                if highest_j > 0.0 { (oscillation.left_j() / highest_j).sqrt() } else { 0.0 };
            if watch(&settled).is_break() {
                return Ok(settled);
            }
        }
        self.begin_at_rest(start);
        Ok(settled)
    }
}
