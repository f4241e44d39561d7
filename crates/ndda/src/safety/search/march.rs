//! Factors on loads and on the slope: loads grow by strides from one state of rest to the next.

use ndda_solver::Snapshot;

use super::Search;
use crate::safety::trial::State;
use crate::safety::{BlockVelocity, SafetyError};

/// First stride.
const FIRST_STRIDE: f64 = 1.25;
/// The last one over the wanted error.
const LAST_STRIDE: f64 = 0.2;
/// Trials one after the other in which blocks neither stand nor fail, before the search ends.
const MOST_UNDECIDED: usize = 10;

impl Search<'_> {
    /// Loads that grow by strides, each from where blocks rest under the last; strides shorten where blocks fail, since a
    /// load that comes at once swings them beyond where they would rest. Where blocks stood before it was known how they fail, they have to stand
    /// pushed, too. Gives the state before the last stride.
    pub(super) fn march(&self, before_s: f64) -> Result<Snapshot, SafetyError> {
        let last = 1.0 + LAST_STRIDE * self.plan.error;
        let (mut stride, mut failing) = (FIRST_STRIDE, Vec::new());
        let mut stood = vec![(1.0, self.start.snapshot.clone())];
        let first = self.try_factor(1.0, &self.start.snapshot, &failing, before_s)?;
        if first.state != State::Stands {
            return Ok(first.ended);
        }
        stood[0].1 = first.ended;
        let (mut factor, mut next, mut undecided) = (1.0, FIRST_STRIDE, 0);
        while factor < self.plan.most && next <= self.plan.most * last {
            let tried = self.try_factor(next, &stood[stood.len() - 1].1, &failing, before_s)?;
            match tried.state {
                State::Stands => {
                    if !failing.is_empty() {
                        stood.clear();
                    }
                    stood.push((next, tried.ended));
                }
                _ if stride > last => {
                    self.forget(next);
                    stride = stride.sqrt().max(last);
                    let pushes = self.pushes(tried.failing);
                    if failing.is_empty() && !pushes.is_empty() {
                        failing = pushes;
                        if !self.falls_back(&mut stood, &failing, before_s)? {
                            break;
                        }
                    }
                }
                State::Fails => break,
                State::Undecided if undecided < MOST_UNDECIDED => {
                    undecided += 1;
                    next *= last;
                    continue;
                }
                State::Undecided => break,
            }
            undecided = 0;
            factor = stood[stood.len() - 1].0;
            next = factor * stride;
        }
        Ok(stood.pop().expect("the first stays").1)
    }

    /// Takes out the largest factors at which blocks that are pushed do not stand; whether they stand at one.
    fn falls_back(
        &self,
        stood: &mut Vec<(f64, Snapshot)>,
        failing: &[BlockVelocity],
        before_s: f64,
    ) -> Result<bool, SafetyError> {
        while let Some((factor, state)) = stood.last_mut() {
            self.forget(*factor);
            let tried = self.try_factor(*factor, state, failing, before_s)?;
            let stands = tried.state == State::Stands;
            if stands || *factor == 1.0 {
                *state = tried.ended;
                return Ok(stands);
            }
            self.forget(*factor);
            stood.pop();
        }
        Ok(false)
    }
}
