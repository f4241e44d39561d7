//! One trial: whether blocks stand or fail at a factor.
//!
//! A block that is held moves elastically, by u; one that is not accelerates by a part of gravity that grows with how far the factor
//! is beyond the limit. A trial lasts until an acceleration of 2 % of the wanted error times gravity would have moved a block by 10 u.
//! It *fails* as soon as a block has gone 30 u and farther in each third of the time than in the one before; it *stands*
//! if all blocks have come to rest, also where they went farther before, or if at its end each block that has gone so far has gone 9 % less in each third of
//! the time than in the one before, and no other is faster than that acceleration would have made it. Else it goes on for up to four times as long, and then is *undecided*.
//!
//! Springs that are far softer than contact, as bolts are, or a column that leans on its edge let a block accelerate for 30 u, too, and hold it later. So the failure at
//! the upper end of the bracket is *followed*, until a block has gone 1 % of its radius, or 5 % on bolts and springs; where it comes to rest instead, all failures are, and they are from the
//! beginning where blocks hang on bolts or springs.
//!
//! Vibrations are damped locally, since undamped contact of rigid blocks vibrates for ever, and blocks that hardly stand slip a little in each
//! vibration. Their mean velocity is not damped, or a tall block that rocks while it slides would be called stable.
//!
//! Friction makes equilibrium ambiguous: a wedge whose friction points across its line stands where one that slides does not. Blocks that
//! stand are therefore pushed once, by the velocities with which they failed at a larger factor, and have to come to rest again; where they stood before any had failed, at
//! the end, if theirs is the lower end of the bracket. They have to
//! go some elastic displacements before their friction points against their slip: where one of two joints is hardly pressed, a push of 5 u left a
//! wedge standing at 1.4 % more than its limit. Shear springs give way to a push before they slip, so that blocks on them are pushed again as long as that moves them on.
//!
//! Changed loads act at once, and the scene is brought to rest under them first, with kinetic damping; a block that has gone 5 % of
//! its radius then fails. Scenes whose friction has springs are brought to rest first, too.

mod settled;
mod start;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::failing::{self, BlockVelocity};
use super::free_blocks::{ELSEWHERE, fastest_m_s, free};
use super::watched::Watched;
use ndda_solver::{LocalDamping, Simulation, StepError};
use serde::{Deserialize, Serialize};

use crate::numbers::length;
use crate::run::motion::radius_m;

pub use start::Start;

/// Part of the wanted error times gravity that counts as no acceleration.
const NO_ACCELERATION: f64 = 0.02;
/// Elastic displacements that it would bring within a trial, and that a block goes before it fails.
const WITHIN: f64 = 10.0;
pub const FAR: f64 = 30.0;
/// Windows in which no block moves by more than so many elastic displacements where all rest: less than what no acceleration would bring in them.
const RESTED: usize = 8;
const RESTED_WITHIN: f64 = WITHIN * (RESTED as f64 / WINDOWS as f64) * (RESTED as f64 / WINDOWS as f64);
/// Longest trial over the time in which no acceleration would move a block by those 10 u: blocks may be slow to rest.
const LONGEST: u64 = 4;
/// The same under changed loads, and where blocks are followed: a column that stands on its edge, or a block on bolts, swings far more slowly than contact of a whole base vibrates.
const LONGEST_UNDER_LOADS: u64 = 64;
/// Part of its radius that a block goes before it fails under changed loads or on bolts and springs, and elsewhere where it is followed.
const FAR_UNDER_LOADS: f64 = 0.05;
const FAR_FOLLOWED: f64 = 0.01;
/// How often the steps that a trial may take to come to rest are doubled, from those that it lasts.
const TO_REST: u32 = 5;
/// Fewest steps of a trial.
const FEWEST_STEPS: u64 = 400;
/// Windows in which displacements are looked at.
const WINDOWS: u64 = 48;
/// Window after which blocks are pushed at the latest.
const PUSH: u64 = 12;
/// Blocks rest that are slower, at the ends of so many windows, than this part of what no acceleration would make of them in a window.
const SLOW: f64 = 0.1;
const RESTING: u32 = 2;
/// Elastic displacements that a push moves blocks by which half the wanted error times gravity slows down.
const PUSHED: f64 = 20.0;
/// Part of gravity that stops a push after so many displacements under changed loads, whatever error is asked for. A slower push ends before contact has
/// vibrated once, and leaves a block wedged in by more force than its loads need.
const STOPS_UNDER_LOADS: f64 = 0.015;
/// How often blocks are pushed on that changed loads have wedged in, or that stand on springs, which give way to a push before they slip, and elastic displacements that a
/// push has to move them by for another one.
const MOST_PUSHES: u32 = 10;
const PUSHED_ON: f64 = 0.5;
/// Local damping of vibrations in trials, and the steps over which velocities are averaged.
const DAMPING: f64 = 0.8;
const AVERAGED: f64 = 50.0;

/// Final state of the blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// All of them rest.
    Stands,
    /// Some accelerate.
    Fails,
    /// Some moved, and neither rest nor accelerate.
    Undecided,
}

/// A trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// The factor F.
    pub factor: f64,
    /// Final state of the blocks.
    pub state: State,
    /// Why, in words.
    pub reason: String,
    /// Block that went farthest.
    pub block: String,
    /// Times [s] and how far that block went [m].
    pub history: Vec<[f64; 2]>,
    /// Steps taken.
    pub steps: u64,
    /// Wall-clock time [s].
    pub wall_s: f64,
    /// Facets in contact whose cohesion or tensile strength is gone at the end, and all of them, where joints have any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub broken_facets: Option<[usize; 2]>,
    /// Velocities at the end of blocks that fail.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocities: Vec<BlockVelocity>,
    /// Whether blocks were pushed by the velocities with which they failed at a larger factor.
    #[serde(default, skip_serializing_if = "is_false")]
    pub pushed: bool,
    /// Whether blocks that fail were followed for 1 % of their radius, or 5 % on bolts and springs.
    #[serde(default, skip_serializing_if = "is_false")]
    pub followed: bool,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// How far blocks that accelerate go before they fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follow {
    /// They fail once they accelerate.
    No,
    /// For a part of their radius: then they are in another place, even if they would come to rest there.
    ToAnotherPlace,
    /// For a larger part, on bolts and springs, which stretch before they hold.
    OnSprings,
}

impl Follow {
    /// That part of the radius of a block.
    fn part(self) -> f64 {
        match self {
            Self::No => 0.0,
            Self::ToAnotherPlace => FAR_FOLLOWED,
            Self::OnSprings => FAR_UNDER_LOADS,
        }
    }
}

/// How a trial is run.
pub struct Course<'a> {
    /// Where it begins.
    pub start: &'a Start,
    /// Speed over the largest at which it is at rest, before it moves freely: where loads change, and where all friction has springs, which
    /// creep while their contact vibrates. Friction on velocities is let go at once and slips the way that blocks would fail: brought
    /// to rest on its way it finds other equilibria, too, which nothing disturbs (a wedge of F = 1.27 stands up to 1.29 then).
    pub settle_tolerance: Option<f64>,
    /// Whether loads change, under which blocks lean before they fail.
    pub leans: bool,
    /// How far blocks that accelerate go before they fail, where loads do not change.
    pub follow: Follow,
    /// Whether joints have cohesion or tensile strength.
    pub has_cohesion: bool,
    /// Relative error that criteria are as fine as.
    pub error: f64,
    /// Velocities with which blocks failed at a larger factor, to push them by; empty where they are not pushed.
    pub failing: &'a [BlockVelocity],
    /// Raised when somebody asks to end.
    pub stop: &'a AtomicBool,
    /// Whether the answer no longer depends on this trial.
    pub is_settled: &'a (dyn Fn() -> bool + Sync),
}

impl Course<'_> {
    /// Acceleration that counts as none [m/s²].
    fn threshold_m_s2(&self) -> f64 {
        NO_ACCELERATION * self.error * self.start.gravity_m_s2
    }

    /// Steps of a trial.
    pub fn steps(&self, step_s: f64) -> u64 {
        let time_s = (2.0 * WITHIN * self.start.elastic_m / self.threshold_m_s2()).sqrt();
        ((time_s / step_s).ceil() as u64).max(FEWEST_STEPS)
    }

    /// Runs a trial at a factor; none if somebody asked to end, or the answer no longer depends on it.
    pub fn run(&self, simulation: &mut Simulation, factor: f64) -> Option<Trial> {
        let began = Instant::now();
        let begun = simulation.state().position.clone();
        let mut watched = Watched::new(simulation, &self.start.position);
        let verdict = self.judge(simulation, &mut watched)?;
        let (state, reason) = verdict.unwrap_or_else(|error| {
            let far = watched.beyond(&self.far_m(simulation)).is_some();
            let state = if far { State::Fails } else { State::Undecided };
            (state, format!("the run stopped: {error}"))
        });
        let velocities = match state {
            // On the way to rest blocks are stopped again and again: where they went says how they fail.
            State::Fails if self.settle_tolerance.is_some() => {
                failing::on_the_way(simulation, &begun, self.push_m_s())
            }
            State::Fails => failing::velocities(simulation, &simulation.state().velocity),
            _ => Vec::new(),
        };
        Some(Trial {
            factor,
            pushed: watched.is_pushed(),
            followed: self.follow != Follow::No,
            broken_facets: self.has_cohesion.then(|| broken(simulation)),
            velocities,
            state,
            reason,
            block: watched.name(simulation),
            history: watched.history(),
            steps: simulation.state().step,
            wall_s: began.elapsed().as_secs_f64(),
        })
    }

    /// Final state of the blocks, or why the run stopped; none if somebody asked to end.
    fn judge(
        &self,
        simulation: &mut Simulation,
        watched: &mut Watched,
    ) -> Option<Result<(State, String), StepError>> {
        let followed = self.follow.part();
        let (mut far_m, mut near_m) = (self.far_m(simulation), self.near_m(simulation));
        match self.settle(simulation, watched, &far_m)? {
            Ok(None) => {}
            Ok(Some(verdict)) => return Some(Ok(verdict)),
            Err(error) => return Some(Err(error)),
        }
        if self.settle_tolerance.is_some() && !self.leans {
            // How far it went on its way to rest says nothing about what it does now.
            near_m = watched.farther_by(&self.beyond_elastic_m(simulation, 0.0));
            far_m = watched.farther_by(&self.beyond_elastic_m(simulation, followed));
        }
        let (first, steps) = (simulation.state().step, self.steps(simulation.step_s()));
        let window_s = simulation.step_s() * (steps / WINDOWS) as f64;
        let slow_m_s = SLOW * self.threshold_m_s2() * window_s;
        let mut damping = LocalDamping::of_vibrations(DAMPING, AVERAGED);
        let (mut pushes, mut resting) = (self.most_pushes(), 0);
        let elastic_m = self.start.elastic_m;
        let longest = if self.leans || self.follow != Follow::No { LONGEST_UNDER_LOADS } else { LONGEST };
        for window in 1..=longest * WINDOWS {
            while simulation.state().step - first < window * steps / WINDOWS {
                if self.stop.load(Ordering::Relaxed) || (self.is_settled)() {
                    return None;
                }
                if let Err(error) = simulation.step_with_local_damping(&mut damping) {
                    watched.look(simulation);
                    return Some(Err(error));
                }
            }
            watched.look(simulation);
            let fails = watched.fails(simulation, &far_m).or_else(|| self.is_elsewhere(simulation, watched));
            if let Some(reason) = fails {
                return Some(Ok((State::Fails, reason)));
            }
            resting = if fastest_m_s(simulation) < slow_m_s { resting + 1 } else { 0 };
            let rests = resting == RESTING || watched.rested(RESTED, RESTED_WITHIN * elastic_m);
            let is_next = if watched.is_pushed() { rests } else { rests || window == PUSH };
            if is_next && watched.is_pushed() && watched.pushed_on_m() < PUSHED_ON * elastic_m {
                pushes = 0;
            }
            if pushes > 0 && is_next {
                self.push(simulation);
                watched.pushed();
                (pushes, resting) = (pushes - 1, 0);
                near_m = watched.farther_by(&self.beyond_elastic_m(simulation, 0.0));
                far_m = watched.farther_by(&self.beyond_elastic_m(simulation, followed));
            } else if (rests || window >= WINDOWS) && self.is_decided(simulation, watched, &near_m) {
                break;
            }
        }
        // What has gone faster and faster all the time need not have gone far.
        let elastic_m = self.beyond_elastic_m(simulation, 0.0);
        let verdict = self.at_the_end(simulation, watched, &near_m);
        let is_open = verdict.0 == State::Undecided;
        let fails = is_open.then(|| watched.fails(simulation, &elastic_m)).flatten();
        Some(Ok(fails.map_or(verdict, |reason| (State::Fails, reason))))
    }

    /// Whether it can be said what becomes of the blocks.
    fn is_decided(&self, simulation: &Simulation, watched: &Watched, far_m: &[f64]) -> bool {
        self.at_the_end(simulation, watched, far_m).0 != State::Undecided
    }

    /// How often blocks are pushed at most.
    fn most_pushes(&self) -> u32 {
        // Loads that grow may have wedged a block in, as springs do that give way.
        let gives_way = self.settle_tolerance.is_some();
        match (self.failing.is_empty(), gives_way) {
            (true, _) => 0,
            (false, true) => MOST_PUSHES,
            (false, false) => 1,
        }
    }

    /// √(2 a d), so that a = ½ error g, or 0.015 g under changed loads, stops a block after d = 20 u [m/s].
    fn push_m_s(&self) -> f64 {
        let stops = if self.leans { STOPS_UNDER_LOADS } else { 0.5 * self.error };
        (2.0 * stops * self.start.gravity_m_s2 * PUSHED * self.start.elastic_m).sqrt()
    }

    /// Adds the velocities with which blocks failed.
    fn push(&self, simulation: &mut Simulation) {
        if let Some(field) = failing::field(simulation, self.failing, self.push_m_s()) {
            simulation.push(&field);
        }
    }

    /// How far each free block goes at most without failing [m].
    fn far_m(&self, simulation: &Simulation) -> Vec<f64> {
        self.beyond_elastic_m(simulation, if self.leans { FAR_UNDER_LOADS } else { self.follow.part() })
    }

    /// How far each free block goes at most before it has to slow down to stand [m].
    fn near_m(&self, simulation: &Simulation) -> Vec<f64> {
        self.beyond_elastic_m(simulation, if self.leans { FAR_UNDER_LOADS } else { 0.0 })
    }

    /// How far each free block goes elastically at most, or a part of its radius where that is more [m].
    fn beyond_elastic_m(&self, simulation: &Simulation, part: f64) -> Vec<f64> {
        let elastic_m = FAR * self.start.elastic_m;
        let far = |block| elastic_m.max(part * radius_m(&simulation.shape(block).operator));
        free(simulation).map(far).collect()
    }

    /// That a block has moved as far as it is followed, in a scene without bolts and springs: it fails, even if it would come to rest there.
    fn is_elsewhere(&self, simulation: &Simulation, watched: &Watched) -> Option<String> {
        if self.leans || self.follow != Follow::ToAnotherPlace {
            return None;
        }
        let (block, gone_m) = watched.beyond(&self.far_m(simulation))?;
        let name = &simulation.blocks().names[block.index()];
        Some(format!(
            "`{name}` has moved {}, more than {:.0} % of its radius",
            length(gone_m),
            100.0 * FAR_FOLLOWED
        ))
    }

    /// How far each free block goes at most before it counts as being in another place [m].
    fn elsewhere_m(&self, simulation: &Simulation) -> Vec<f64> {
        self.beyond_elastic_m(simulation, ELSEWHERE)
    }

    fn at_the_end(&self, simulation: &Simulation, watched: &Watched, far_m: &[f64]) -> (State, String) {
        let time_s = simulation.time_s() - watched.times_s[0];
        let (speed_m_s, limit_m_s) = (watched.speed_m_s(far_m), self.threshold_m_s2() * time_s);
        let gone = length(watched.farthest_m());
        let name = watched.name(simulation);
        let has_rested = watched.rested(RESTED, RESTED_WITHIN * self.start.elastic_m);
        if has_rested && watched.beyond(&self.elsewhere_m(simulation)).is_none() {
            let reason = format!("all came to rest within {time_s:.3} s; `{name}` moved farthest, by {gone}");
            (State::Stands, reason)
        } else if watched.beyond(far_m).is_some() && !watched.slowing(far_m) {
            let reason = format!("`{name}` has moved {gone}, and neither rests nor accelerates");
            (State::Undecided, reason)
        } else if speed_m_s > limit_m_s {
            let reason = format!("blocks move at {speed_m_s:.2e} m/s after {time_s:.3} s, which is not rest");
            (State::Undecided, reason)
        } else {
            let reason = match watched.beyond(far_m) {
                Some(_) => format!("`{name}` slows to a stop after {gone}"),
                None => format!("all are at rest after {time_s:.3} s; `{name}` moved farthest, by {gone}"),
            };
            (State::Stands, reason)
        }
    }
}

/// Facets in contact whose cohesion is gone, and all of them.
fn broken(simulation: &Simulation) -> [usize; 2] {
    let facets = &simulation.state().contact.facets;
    [facets.iter().filter(|facet| facet.broken).count(), facets.len()]
}
