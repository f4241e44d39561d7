//! The bracket: the largest factor at which blocks stand, and the smallest at which they fail.

mod confirm;
mod failure;
mod march;
mod next;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::time::Instant;

use ndda_io::read::LoadedScene;
use ndda_io::scene::Contact;
use ndda_solver::Snapshot;
use rayon::prelude::*;

use super::rest::{STRONGEST, choices, settled};
use super::trial::{Course, Start, State, Trial};
use super::{
    BlockVelocity, Bracket, By, Mechanism, MovingBlock, Plan, SCHEMA, Safety, SafetyError, Watch, changes,
    remarks, write,
};
use crate::Model;
use crate::forecast::held::nothing_loads;
use crate::numbers::counted;
use next::bracket;

/// How far beyond a single factor blocks are looked at unpushed: what a push adds is far less.
const BEYOND: f64 = 1.1;
/// Criteria of trials are those of this error where a larger one is asked for. Coarser ones take blocks for standing that go on to fall, and the answers to two errors
/// would exclude each other.
const COARSEST: f64 = 0.01;

/// What a trial found.
struct Tried {
    state: State,
    /// Velocities with which blocks failed.
    failing: Vec<BlockVelocity>,
    /// The state that it ended in.
    ended: Snapshot,
}

/// A search for the factor of safety.
pub struct Search<'a> {
    loaded: LoadedScene,
    folder: PathBuf,
    plan: &'a Plan,
    watch: &'a Watch<'a>,
    by: By,
    start: Start,
    /// How many times its strength the scene came to rest with.
    strength: f64,
    begun: Instant,
    /// Trials of an earlier call, which may have been interrupted.
    earlier: Vec<Trial>,
    /// How blocks fail at a factor, where an earlier call came so far.
    known_mechanism: Option<(f64, Mechanism, Vec<MovingBlock>)>,
    /// The answer so far.
    answer: Mutex<Safety>,
    /// Trials that were repeated with less at a time, or pushed.
    repeated: AtomicUsize,
    /// Bits of the smallest factor at which blocks have failed, infinite so far.
    fails_at: AtomicU64,
    /// Whether blocks that fail are followed.
    follows: AtomicBool,
}

impl<'a> Search<'a> {
    /// Brings the scene to rest, and takes over trials of an earlier call that was interrupted.
    pub fn new(
        loaded: &LoadedScene,
        (name, folder): (&str, &Path),
        plan: &'a Plan,
        watch: &'a Watch<'a>,
    ) -> Result<Self, SafetyError> {
        let begun = Instant::now();
        if !loaded.scene.stages.is_empty() {
            return Err(SafetyError::Stages);
        }
        if loaded.scene.rockfall.is_some() {
            return Err(SafetyError::Rockfall);
        }
        if let Some(block) = changes::moved_support(&loaded.scene) {
            return Err(SafetyError::MovedSupport { block });
        }
        let taken_otherwise = changes::taken_otherwise(&loaded.scene);
        let mut loaded = loaded.clone();
        loaded.scene = changes::at_rest(&loaded.scene);
        if nothing_loads(&loaded.scene) {
            return Err(SafetyError::NoLoads);
        }
        plan.by.check(&mut loaded.scene)?;
        if !matches!(loaded.scene.contact, Some(Contact::Potential { .. })) {
            return Err(SafetyError::NoContact);
        }
        let (start, strength) = settled(&loaded, folder, watch)?;
        let by = plan.by.on(&loaded.scene, &start.normals)?;
        let mut answer = Safety {
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            scene: name.into(),
            title: loaded.scene.title.clone(),
            scene_crc32: format!(
                "{:08x}",
                ndda_io::checkpoint::fingerprint(&(&loaded.scene, start.blocks_crc32))
            ),
            by,
            error: plan.error,
            factor_of_safety: Bracket { lower: None, upper: None },
            not_standing: start.moved.clone(),
            mechanism: None,
            moving_blocks: Vec::new(),
            trials: Vec::new(),
            remarks: taken_otherwise,
            wall_s: 0.0,
            known_trials: 0,
            earlier_s: 0.0,
        };
        if strength > 1.0 && start.moved.is_empty() {
            answer.remarks.push(format!(
                "settling brought the scene to rest with joints {strength} times as strong, and not as it is drawn: trials begin from there"
            ));
        }
        let (mut known, mut known_mechanism) = (Vec::new(), None);
        if let Some(earlier) = watch.out.and_then(|out| earlier(out, &answer, watch)) {
            let upper = earlier.factor_of_safety.upper;
            known_mechanism = upper.zip(earlier.mechanism).map(|(at, how)| (at, how, earlier.moving_blocks));
            (known, answer.wall_s) = (earlier.trials, earlier.wall_s);
        }
        let folder = folder.to_path_buf();
        let follows = changes::hangs_on_springs(&loaded.scene) || confirm::were_followed(&known);
        Ok(Self {
            loaded,
            folder,
            plan,
            watch,
            by,
            start,
            strength,
            begun,
            earlier: known,
            known_mechanism,
            answer: Mutex::new(answer),
            repeated: AtomicUsize::new(0),
            fails_at: AtomicU64::new(f64::INFINITY.to_bits()),
            follows: AtomicBool::new(follows),
        })
    }

    /// Runs trials until the bracket is as narrow as is asked for.
    pub fn answer(self) -> Result<Safety, SafetyError> {
        let before_s = self.answer.lock().expect("no trial panics").wall_s;
        let (mechanism, moving) = match self.none_stands() {
            true => (None, Vec::new()),
            false if self.by.changes_loads() => self.mechanism(&self.march(before_s)?)?,
            false => self.mechanism(&self.bisect(before_s)?)?,
        };
        let leaning = mechanism.as_ref().and_then(|how: &Mechanism| self.leaning(how, &moving));
        let (may_push, repeated) = (self.may_push(), self.repeated.load(Ordering::Relaxed));
        let (none_stands, as_drawn, stretches) = (self.none_stands(), self.as_drawn(), self.stretches());
        let mut answer = self.answer.into_inner().expect("no trial panics");
        (answer.mechanism, answer.moving_blocks) = (mechanism, moving);
        let first = answer.moving_blocks.first();
        let fails_elsewhere =
            |first: &MovingBlock| self.start.moved.iter().any(|moved| moved.block == first.name);
        if first.map_or(none_stands, fails_elsewhere) {
            answer.factor_of_safety = Bracket { lower: None, upper: Some(as_drawn) };
        }
        let is_brittle = changes::has_brittle_cohesion(&self.loaded.scene);
        answer.remarks.extend(remarks::of(&answer, self.start.slender.as_ref(), is_brittle));
        answer.remarks.extend(leaning.into_iter().chain(stretches));
        if repeated > 0 {
            answer.remarks.push(format!(
                "{} not listed and repeated in smaller steps of the factor, or with a push: a large change at once swings blocks beyond where they would rest",
                counted(repeated, "trial is", "trials are")
            ));
        }
        // Springs that slipped on the way to rest keep their friction at its limit, and nothing pushes them.
        let upper = answer.factor_of_safety.upper;
        let fails_at_once = upper.is_some_and(|upper| upper * self.strength <= 1.0 + self.plan.error);
        let fails_at_once = fails_at_once && answer.stands_as_drawn();
        if fails_at_once && !may_push {
            answer.remarks.push(
                "blocks fail at the same strength at which they came to rest: if joints slipped while the scene settled, the answer depends on how; \
                 compare it with --by gravity and with an ordinary run"
                    .into(),
            );
        }
        answer.wall_s = before_s + self.begun.elapsed().as_secs_f64();
        answer.earlier_s = before_s;
        answer.known_trials = answer.trials.iter().filter(|trial| self.earlier.contains(trial)).count();
        if let Some(out) = self.watch.out {
            write(out, &answer)?;
        }
        Ok(answer)
    }

    /// Whether every block that is free came to rest elsewhere, or some never do: there is no state to begin from then.
    fn none_stands(&self) -> bool {
        self.start.still_moves || self.start.moved.len() == self.start.free
    }

    /// The factor at which a scene fails as drawn, that does not stand with joints as strong as were tried.
    fn as_drawn(&self) -> f64 {
        if self.by.changes_loads() { 1.0 } else { 1.0 / STRONGEST }
    }

    /// Whether blocks stand at one factor on the strength. What stands at a larger one unpushed stands here, too; what fails there is pushed here
    /// in the way in which it failed.
    pub fn at(&self, factor: f64) -> Result<State, SafetyError> {
        let start = &self.start.snapshot;
        if self.none_stands() {
            return Ok(if factor >= self.as_drawn() { State::Fails } else { State::Undecided });
        }
        let mut failing = Vec::new();
        if self.may_push() {
            let beyond = self.try_factor(BEYOND * factor, start, &[], 0.0)?;
            if beyond.state == State::Stands {
                return Ok(State::Stands);
            }
            failing = self.pushes(beyond.failing);
        }
        let state = self.try_factor(factor, start, &failing, 0.0)?.state;
        if state != State::Fails || self.follows.swap(true, Ordering::Relaxed) {
            return Ok(state);
        }
        Ok(self.try_factor(factor, start, &failing, 0.0)?.state)
    }

    /// Trials side by side, outwards until there is a bracket and inwards until it is narrow, all from the same start.
    fn bisect(&self, before_s: f64) -> Result<Snapshot, SafetyError> {
        loop {
            let wanted = self.wanted();
            if wanted.is_empty() {
                if self.is_confirmed(before_s)? {
                    return Ok(self.start.snapshot.clone());
                }
                continue;
            }
            let failing = self.failing();
            let run = |&factor: &f64| match self
                .earlier
                .iter()
                .find(|trial| trial.factor == factor && self.counts(trial))
            {
                Some(known) => {
                    self.keep(known.clone());
                    Ok(())
                }
                None if self.is_settled_below(factor) => Ok(()),
                None => match self.try_factor(factor, &self.start.snapshot, &failing, before_s) {
                    Err(SafetyError::Interrupted) if self.is_settled_below(factor) => Ok(()),
                    tried => tried.map(drop),
                },
            };
            wanted.par_iter().map(run).collect::<Result<Vec<()>, SafetyError>>()?;
            self.forget_beyond(&wanted);
        }
    }

    /// Whether a trial at a smaller factor has failed, so that this one cannot change the answer.
    fn is_settled_below(&self, factor: f64) -> bool {
        !self.watch.stop.load(Ordering::Relaxed)
            && f64::from_bits(self.fails_at.load(Ordering::Relaxed)) < factor
    }

    /// Takes out those of some trials that were side by side with a smaller one that failed: whether they came to their end depends on the number of threads.
    fn forget_beyond(&self, tried: &[f64]) {
        let mut answer = self.answer.lock().expect("no trial panics");
        let fails = |trial: &&Trial| trial.state == State::Fails && tried.contains(&trial.factor);
        let Some(first) = answer.trials.iter().find(fails).map(|trial| trial.factor) else { return };
        answer.trials.retain(|trial| trial.factor <= first || !tried.contains(&trial.factor));
        answer.factor_of_safety = bracket(&answer.trials);
    }

    fn keep(&self, trial: Trial) {
        if trial.state == State::Fails {
            // Positive numbers have the order of their bits.
            self.fails_at.fetch_min(trial.factor.to_bits(), Ordering::Relaxed);
        }
        let mut answer = self.answer.lock().expect("no trial panics");
        answer.trials.push(trial);
        answer.trials.sort_by(|a, b| a.factor.total_cmp(&b.factor));
        answer.factor_of_safety = bracket(&answer.trials);
    }

    /// Takes out a trial that is repeated: with less at a time where it failed for its stride, or pushed.
    fn forget(&self, factor: f64) {
        self.repeated.fetch_add(1, Ordering::Relaxed);
        let mut answer = self.answer.lock().expect("no trial panics");
        answer.trials.retain(|trial| trial.factor != factor);
        answer.factor_of_safety = bracket(&answer.trials);
    }

    /// Factors that are to be tried next, side by side.
    fn wanted(&self) -> Vec<f64> {
        let answer = self.answer.lock().expect("no trial panics");
        let known = |factor: &f64| answer.trials.iter().any(|trial| trial.factor == *factor);
        let wanted = next::factors(&answer, self.plan);
        wanted.into_iter().filter(|factor| !known(factor)).collect()
    }

    /// Runs a trial from a state, and writes what is known then; gives the state that it ends in.
    fn try_factor(
        &self,
        factor: f64,
        from: &Snapshot,
        failing: &[BlockVelocity],
        before_s: f64,
    ) -> Result<Tried, SafetyError> {
        let mut model = self.model(factor, from)?;
        // Loads that grow by strides are taken back where they were too large.
        let is_settled = || !self.by.changes_loads() && self.is_settled_below(factor);
        let trial = self
            .course(failing, &is_settled)
            .run(&mut model.simulation, factor)
            .ok_or(SafetyError::Interrupted)?;
        (self.watch.tell)(&format!(
            "F = {factor:.4}: {}, {} ({} steps, {:.1} s)",
            super::report::state(trial.state),
            trial.reason,
            trial.steps,
            trial.wall_s
        ));
        let (state, failing) = (trial.state, trial.velocities.clone());
        let tried = Tried { state, failing, ended: model.simulation.snapshot() };
        self.keep(trial);
        if let Some(out) = self.watch.out {
            // Trials that end at the same time write one after the other.
            let kept = self.answer.lock().expect("no trial panics");
            let mut answer = kept.clone();
            answer.wall_s = before_s + self.begun.elapsed().as_secs_f64();
            // Trials that are not needed again yet are kept, too.
            let known = |factor: f64| answer.trials.iter().any(|trial| trial.factor == factor);
            let others: Vec<Trial> = self.earlier.iter().filter(|t| !known(t.factor)).cloned().collect();
            answer.trials.extend(others);
            write(out, &answer)?;
        }
        Ok(tried)
    }

    /// The scene at a factor, in a state.
    fn model(&self, factor: f64, from: &Snapshot) -> Result<Model, SafetyError> {
        let mut loaded = self.loaded.clone();
        self.by.change(&mut loaded.scene, factor);
        let mut model = Model::resuming_with(loaded, &self.folder, choices())?;
        model.simulation.restore(from.clone()).expect("the blocks are the same");
        Ok(model)
    }

    /// Whether blocks are pushed: not where a push might break joints or wear them off.
    fn may_push(&self) -> bool {
        !changes::weakens_by_slip(&self.loaded.scene)
    }

    /// Velocities with which blocks fail at the smallest factor at which they do.
    fn failing(&self) -> Vec<BlockVelocity> {
        let answer = self.answer.lock().expect("no trial panics");
        let fails = answer.trials.iter().find(|trial| trial.state == State::Fails);
        match fails {
            Some(trial) => self.pushes(trial.velocities.clone()),
            None => Vec::new(),
        }
    }

    fn course<'b>(
        &'b self,
        failing: &'b [BlockVelocity],
        is_settled: &'b (dyn Fn() -> bool + Sync),
    ) -> Course<'b> {
        let (start, error, stop) = (&self.start, self.plan.error.min(COARSEST), self.watch.stop);
        let tolerance = self.loaded.scene.settle.unwrap_or_default().tolerance;
        let (leans, follow) = (self.by.changes_loads(), self.follow_now());
        let settle_tolerance = (leans || changes::has_springs_only(&self.loaded.scene)).then_some(tolerance);
        let has_cohesion = changes::has_cohesion(&self.loaded.scene);
        Course { start, settle_tolerance, leans, follow, has_cohesion, error, failing, stop, is_settled }
    }
}

/// The answer of an earlier call of the same question; says so where that of another one is replaced.
fn earlier(out: &Path, asked: &Safety, watch: &Watch) -> Option<Safety> {
    let text = std::fs::read_to_string(super::file(out)).ok()?;
    let found: Safety = serde_json::from_str(&text).ok()?;
    let same = (&found.schema, &found.version, &found.scene_crc32, &found.by, found.error)
        == (&asked.schema, &asked.version, &asked.scene_crc32, &asked.by, asked.error);
    if !same {
        let file = super::file(out);
        (watch.tell)(&format!(
            "{} has the answer for other values, another --error or another version: it is replaced",
            file.display()
        ));
    }
    same.then_some(found)
}
