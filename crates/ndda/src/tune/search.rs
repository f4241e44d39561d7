//! The search for the cheapest setting that reaches an error: one choice after the other, each with the longest step that
//! does. It knows nothing of scenes: a setting is a number per axis and the level of its step, which halves from level to
//! level.

use super::space::{Axis, Outcome, Setting, Space, Trials, Tried};

/// Errors that fall less than to this part when the step is halved are not those of the step.
const STAGNANT: f64 = 0.8;
/// How often that may happen before a setting is given up.
const PATIENCE: u32 = 2;
/// Trials on end that may fail before a setting is given up: long steps are unstable, and stop soon.
const MOST_FAILED: u32 = 4;
/// A setting that misses the error is better than another if its own is less than this part.
const BETTER: f64 = 0.7;
/// A setting is cheaper than another if it takes less than this part of its time; times repeat to some per cent.
const CHEAPER: f64 = 0.9;
/// A run of half the step takes at least this times as long.
const LONGER: f64 = 1.5;
/// Rounds over all axes.
const MOST_ROUNDS: u32 = 4;

/// A search under way.
pub struct Search<'a, T> {
    space: &'a Space,
    trials: &'a mut T,
    /// All that was tried, in its order.
    pub tried: Vec<Tried>,
    spent_s: f64,
    /// Whether the budget ended the search.
    pub is_out_of_budget: bool,
}

/// The best of a setting's steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// The setting.
    pub setting: Setting,
    /// Cost [s].
    pub time_s: f64,
    /// Its error.
    pub error: f64,
}

impl<'a, T: Trials> Search<'a, T> {
    /// A search that has not begun.
    pub fn new(space: &'a Space, trials: &'a mut T) -> Self {
        Self { space, trials, tried: Vec::new(), spent_s: 0.0, is_out_of_budget: false }
    }

    /// The cheapest setting that reaches the error, or the one of the least error where none does; none where no trial ends.
    ///
    /// # Errors
    /// Any error that ends the search.
    pub fn run(&mut self, start: &[i32]) -> Result<Option<Best>, T::Error> {
        let mut best = self.steps(start, self.space.first_level, None)?;
        for _ in 0..MOST_ROUNDS {
            let before = best.clone();
            let order = match self.reaches(best.as_ref()) {
                true => (0..self.space.axes.len()).collect(),
                false => self.space.exact_first.clone(),
            };
            for axis in order {
                best = self.along(axis, start, best)?;
            }
            if best == before {
                break;
            }
        }
        Ok(best)
    }

    fn reaches(&self, best: Option<&Best>) -> bool {
        best.is_some_and(|best| best.error <= self.space.target)
    }

    /// The best along one axis.
    fn along(&mut self, axis: usize, start: &[i32], best: Option<Best>) -> Result<Option<Best>, T::Error> {
        let mut best = best;
        let here =
            |best: &Option<Best>| best.as_ref().map_or_else(|| start.to_vec(), |b| b.setting.at.clone());
        match self.space.axes[axis] {
            Axis::Choice(count) => {
                let centre = here(&best);
                let level = self.from(best.as_ref());
                let next = (0..count).filter(|choice| *choice != centre[axis]).map(|choice| {
                    let mut at = centre.clone();
                    at[axis] = choice;
                    Setting { at, level }
                });
                self.trials.prepare(&next.collect::<Vec<_>>())?;
                for choice in (0..count).filter(|choice| *choice != centre[axis]) {
                    let mut at = here(&best);
                    at[axis] = choice;
                    best = self.better(best, &at)?;
                }
            }
            Axis::Range(least, most) => {
                for way in [1, -1] {
                    loop {
                        let mut at = here(&best);
                        at[axis] += way;
                        if !(least..=most).contains(&at[axis]) {
                            break;
                        }
                        let found = self.better(best.clone(), &at)?;
                        if found == best {
                            break;
                        }
                        best = found;
                    }
                }
            }
        }
        Ok(best)
    }

    /// The better of the best so far and what other choices come to with their own step.
    fn better(&mut self, best: Option<Best>, at: &[i32]) -> Result<Option<Best>, T::Error> {
        let reached = self.reaches(best.as_ref());
        let limit_s = best.as_ref().filter(|_| reached).map(|best| best.time_s);
        let found = self.steps(at, self.from(best.as_ref()), limit_s)?;
        Ok(match (best, found) {
            (Some(old), Some(new)) => Some(if self.is_better(&new, &old) { new } else { old }),
            (old, new) => old.or(new),
        })
    }

    /// The level that other choices begin with: that of the best so far, or one longer where it reaches the error.
    fn from(&self, best: Option<&Best>) -> i32 {
        let longer = i32::from(self.reaches(best));
        best.map_or(self.space.first_level, |best| (best.setting.level - longer).max(self.space.first_level))
    }

    fn is_better(&self, new: &Best, old: &Best) -> bool {
        let target = self.space.target;
        match (new.error <= target, old.error <= target) {
            (true, true) => new.time_s < CHEAPER * old.time_s,
            (false, false) => new.error < BETTER * old.error,
            (new, _) => new,
        }
    }

    /// The longest step of some choices that reaches the error, from the level `from`; the most exact one where none does.
    /// Steps whose trial would take longer than `limit_s` are left out.
    fn steps(&mut self, at: &[i32], from: i32, limit_s: Option<f64>) -> Result<Option<Best>, T::Error> {
        let (mut best, mut last): (Option<Best>, Option<(f64, f64)>) = (None, None);
        let (mut stagnant, mut failed) = (0, 0);
        for level in from..=self.space.last_level {
            let foreseen_s = last.map(|(time_s, _)| LONGER * time_s);
            let too_long = foreseen_s.zip(limit_s).is_some_and(|(foreseen_s, limit_s)| foreseen_s > limit_s);
            if too_long || !self.may_spend(foreseen_s.unwrap_or(0.0)) {
                break;
            }
            let (time_s, error) = match self.trial(at, level)? {
                Outcome::Done { time_s, error } => (time_s, error),
                Outcome::Failed { is_final, .. } => {
                    failed += 1;
                    if is_final || failed >= MOST_FAILED {
                        break;
                    }
                    continue;
                }
            };
            failed = 0;
            if best.as_ref().is_none_or(|b| error < b.error) {
                best = Some(Best { setting: Setting { at: at.to_vec(), level }, time_s, error });
            }
            if error <= self.space.target {
                break;
            }
            stagnant =
                if last.is_some_and(|(_, before)| error > STAGNANT * before) { stagnant + 1 } else { 0 };
            if stagnant >= PATIENCE {
                break;
            }
            last = Some((time_s, error));
        }
        self.longer_steps(best, from)
    }

    /// Longer steps than those that were begun with, while they reach the error.
    fn longer_steps(&mut self, best: Option<Best>, from: i32) -> Result<Option<Best>, T::Error> {
        let mut best = best;
        while let Some(found) = &best {
            let level = found.setting.level - 1;
            if found.error > self.space.target || found.setting.level > from || level < self.space.first_level
            {
                break;
            }
            let at = found.setting.at.clone();
            match self.trial(&at, level)? {
                Outcome::Done { time_s, error } if error <= self.space.target && time_s < found.time_s => {
                    best = Some(Best { setting: Setting { at, level }, time_s, error });
                }
                _ => break,
            }
        }
        Ok(best)
    }

    fn may_spend(&mut self, time_s: f64) -> bool {
        let may = self.spent_s + time_s <= self.space.budget_s;
        self.is_out_of_budget |= !may;
        may
    }

    /// How a trial goes. What was tried is not tried again.
    fn trial(&mut self, at: &[i32], level: i32) -> Result<Outcome, T::Error> {
        let setting = Setting { at: at.to_vec(), level };
        if let Some(known) = self.tried.iter().find(|tried| tried.setting == setting) {
            return Ok(known.outcome.clone());
        }
        let outcome = self.trials.run(&setting)?;
        if let Outcome::Done { time_s, .. } = outcome {
            self.spent_s += time_s;
        }
        self.tried.push(Tried { setting, outcome: outcome.clone() });
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    /// Errors C Δtᵖ + model error of the penalty, times c/Δt, with the first step unstable where contact is stiff.
    struct Model {
        calls: usize,
    }

    impl Model {
        fn outcome(setting: &Setting) -> Outcome {
            let step = 0.5f64.powi(setting.level);
            // Schemes: of first order, of second order, and a dear one that is exact.
            let (order, constant, cost) =
                [(1, 1.0, 1.0), (2, 1.0, 1.1), (2, 0.0, 40.0)][setting.at[0] as usize];
            let stiffness = 4.0f64.powi(setting.at[1]);
            if step * stiffness.sqrt() > 1.5 {
                return Outcome::Failed { reason: "unstable".into(), is_final: false };
            }
            let error = constant * 0.3 * step.powi(order) + 0.05 / stiffness;
            Outcome::Done { time_s: 1e-2 + cost / step, error }
        }
    }

    impl Trials for Model {
        type Error = Infallible;
        fn run(&mut self, setting: &Setting) -> Result<Outcome, Infallible> {
            self.calls += 1;
            Ok(Self::outcome(setting))
        }
    }

    fn space(target: f64) -> Space {
        let axes = vec![Axis::Choice(3), Axis::Range(-2, 4)];
        Space { axes, exact_first: vec![1, 0], first_level: 0, last_level: 12, target, budget_s: 1e9 }
    }

    /// The cheapest of all settings.
    fn cheapest(space: &Space) -> f64 {
        let mut least = f64::INFINITY;
        for (scheme, penalty, level) in
            (0..3).flat_map(|s| (-2..=4).flat_map(move |k| (0..=12).map(move |l| (s, k, l))))
        {
            match Model::outcome(&Setting { at: vec![scheme, penalty], level }) {
                Outcome::Done { time_s, error } if error <= space.target => least = least.min(time_s),
                _ => {}
            }
        }
        least
    }

    #[test]
    fn it_comes_near_the_cheapest_of_all_at_a_fraction_of_the_trials() {
        for target in [0.2, 5e-2, 2e-2, 5e-3, 1e-3] {
            let space = space(target);
            let mut model = Model { calls: 0 };
            let best = Search::new(&space, &mut model).run(&[0, 0]).unwrap().unwrap();
            assert!(best.error <= target, "{target}: {best:?}");
            assert!(best.time_s <= 2.0 * cheapest(&space), "{target}: {best:?} of {}", cheapest(&space));
            assert!(model.calls < 60, "{target}: {} of 273 trials", model.calls);
        }
    }

    #[test]
    fn where_nothing_reaches_the_error_it_gives_the_least() {
        let space = space(1e-6);
        let best = Search::new(&space, &mut Model { calls: 0 }).run(&[0, 0]).unwrap().unwrap();
        assert!((1e-6..1e-3).contains(&best.error), "{best:?}");
    }

    #[test]
    fn no_setting_is_tried_twice_and_the_budget_holds() {
        let space = Space { budget_s: 30.0, ..space(1e-4) };
        let mut model = Model { calls: 0 };
        let mut search = Search::new(&space, &mut model);
        search.run(&[0, 0]).unwrap();
        assert!(search.is_out_of_budget && search.spent_s < 2.0 * 30.0, "{}", search.spent_s);
        let tried = std::mem::take(&mut search.tried);
        for (i, one) in tried.iter().enumerate() {
            assert!(tried[..i].iter().all(|other| other.setting != one.setting));
        }
        assert_eq!(tried.len(), model.calls);
    }

    /// An error that never occurs.
    struct Broken;

    impl Trials for Broken {
        type Error = Infallible;
        fn run(&mut self, _: &Setting) -> Result<Outcome, Infallible> {
            Ok(Outcome::Failed { reason: "no".into(), is_final: false })
        }
    }

    #[test]
    fn where_no_trial_ends_there_is_no_best() {
        assert_eq!(Search::new(&space(1e-2), &mut Broken).run(&[0, 0]).unwrap(), None);
    }
}
