//! Both ends of a bracket once more: blocks that stand are pushed, and blocks that fail are followed.

use std::sync::atomic::Ordering;

use super::Search;
use super::next::bracket;
use crate::numbers::length;
use crate::safety::changes;
use crate::safety::trial::{FAR, Follow, State, Trial};
use crate::safety::{BlockVelocity, Bracket, SafetyError};

/// Whether trials of an earlier call have shown that blocks which accelerate may come to rest, so that those that fail have to be followed.
pub(super) fn were_followed(earlier: &[Trial]) -> bool {
    earlier.iter().any(|trial| trial.followed && trial.state != State::Fails)
}

impl Search<'_> {
    /// Whether both ends of the bracket hold. The trial of one that was not pushed, or not followed, is run again; what comes out may ask for other trials.
    pub(super) fn is_confirmed(&self, before_s: f64) -> Result<bool, SafetyError> {
        let answer = self.answer.lock().expect("no trial panics").clone();
        let Bracket { lower, upper } = answer.factor_of_safety;
        let of = |end: Option<f64>| answer.trials.iter().find(|trial| Some(trial.factor) == end);
        if let Some(trial) = of(upper).filter(|trial| !trial.followed) {
            self.follow(trial, before_s)?;
            return Ok(false);
        }
        let failing = self.failing();
        if let Some(trial) = of(lower).filter(|trial| !trial.pushed && !failing.is_empty()) {
            self.replace(|other| other.factor == trial.factor);
            self.try_factor(trial.factor, &self.start.snapshot, &failing, before_s)?;
            return Ok(false);
        }
        Ok(true)
    }

    /// How far blocks that accelerate go before they fail.
    pub(super) fn follow_now(&self) -> Follow {
        match self.follows.load(Ordering::Relaxed) {
            false => Follow::No,
            true if changes::hangs_on_springs(&self.loaded.scene) => Follow::OnSprings,
            true => Follow::ToAnotherPlace,
        }
    }

    /// Runs a trial in which blocks fail until they have gone a part of their radius; where they do not, other failures do not count either.
    fn follow(&self, trial: &Trial, before_s: f64) -> Result<(), SafetyError> {
        let failing = self.failing_beyond(trial.factor);
        self.follows.store(true, Ordering::Relaxed);
        let tried = self.try_factor(trial.factor, &self.start.snapshot, &failing, before_s)?;
        if tried.state == State::Fails {
            // It went on as it had begun.
            self.follows.store(false, Ordering::Relaxed);
            self.replace(|other| other.factor == trial.factor);
            self.keep(Trial { followed: true, ..trial.clone() });
        } else {
            self.replace(|other| other.state != State::Stands && !other.followed);
        }
        Ok(())
    }

    /// That blocks stand at the lower end only after they have gone far, in words.
    pub(super) fn stretches(&self) -> Option<String> {
        let answer = self.answer.lock().expect("no trial panics");
        let lower = answer.factor_of_safety.lower?;
        let trial = answer.trials.iter().find(|trial| trial.factor == lower)?;
        let gone_m = trial.history.last().map_or(0.0, |[_, gone_m]| *gone_m);
        let is_far = trial.followed && gone_m > FAR * self.start.elastic_m;
        is_far.then(|| {
            format!(
                "`{}` stands at {lower:.4} only after it has moved {}: if that is too far, take a smaller factor from the table of trials",
                trial.block,
                length(gone_m)
            )
        })
    }

    /// Velocities with which blocks failed at a larger factor than this.
    fn failing_beyond(&self, factor: f64) -> Vec<BlockVelocity> {
        let answer = self.answer.lock().expect("no trial panics");
        let beyond = answer.trials.iter().find(|other| other.state == State::Fails && other.factor > factor);
        beyond.map_or_else(Vec::new, |other| self.pushes(other.velocities.clone()))
    }

    /// The velocities at failure of the blocks that did not turn, by which they are pushed where they stand at a smaller factor. Blocks that turn are not pushed,
    /// since a push topples a column before its limit.
    pub(super) fn pushes(&self, mut failed: Vec<BlockVelocity>) -> Vec<BlockVelocity> {
        failed.retain(|velocity| self.may_push() && !velocity.turns);
        failed
    }

    /// Whether a trial of an earlier call counts now: where blocks are followed, no failure does of one that was not.
    pub(super) fn counts(&self, earlier: &Trial) -> bool {
        earlier.followed || earlier.state == State::Stands || !self.follows.load(Ordering::Relaxed)
    }

    /// Takes out trials that are repeated, or no longer count.
    fn replace(&self, goes: impl Fn(&Trial) -> bool) {
        let mut answer = self.answer.lock().expect("no trial panics");
        answer.trials.retain(|trial| !goes(trial));
        answer.factor_of_safety = bracket(&answer.trials);
        let fails_at = answer.factor_of_safety.upper.unwrap_or(f64::INFINITY);
        self.fails_at.store(fails_at.to_bits(), Ordering::Relaxed);
    }
}
