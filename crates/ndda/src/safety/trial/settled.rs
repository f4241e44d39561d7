//! The way to rest with which a trial begins.

use std::sync::atomic::Ordering;

use ndda_solver::{Settle, Simulation, StepError};

use super::{Course, State, TO_REST};
use crate::numbers::length;
use crate::run::unless_stopped;
use crate::safety::watched::Watched;

impl Course<'_> {
    /// Brings the scene to rest under loads of its own, in calls of more and more steps, until it rests or a block has gone far; the
    /// verdict in that case, none if somebody asked to end.
    pub(super) fn settle(
        &self,
        simulation: &mut Simulation,
        watched: &mut Watched,
        far_m: &[f64],
    ) -> Option<Result<Option<(State, String)>, StepError>> {
        let Some(tolerance) = self.settle_tolerance else { return Some(Ok(None)) };
        let mut settled = Ok(());
        for doublings in 0..=TO_REST {
            let settle = Settle::new(tolerance, self.steps(simulation.step_s()) << doublings);
            settled = simulation.settle_watched(&settle, &mut |_| unless_stopped(self.stop)).map(drop);
            if self.stop.load(Ordering::Relaxed) {
                return None;
            }
            watched.begin(simulation);
            let places_m = if self.leans { far_m.to_vec() } else { self.elsewhere_m(simulation) };
            if let Some((block, gone_m)) = watched.beyond(&places_m) {
                let name = &simulation.blocks().names[block.index()];
                let reason = match settled {
                    Ok(()) => {
                        format!("`{name}` came to rest only after {}, in another place", length(gone_m))
                    }
                    Err(_) => format!("`{name}` had moved {}, and did not come to rest", length(gone_m)),
                };
                return Some(Ok(Some((State::Fails, reason))));
            }
            // What has gone far and does not rest yet may still: joints that yield settle slowly.
            let is_slow = matches!(settled, Err(StepError::NotSettled { .. }));
            if !is_slow || watched.beyond(far_m).is_some() {
                break;
            }
        }
        // What does not rest is let go: it accelerates, or it does not.
        Some(match settled {
            Ok(()) | Err(StepError::NotSettled { .. }) => Ok(None),
            Err(error) => Err(error),
        })
    }
}
