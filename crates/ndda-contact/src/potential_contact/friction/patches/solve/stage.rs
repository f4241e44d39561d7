//! One of both minima: visits of patch after patch, and Newton's method for all where these take long.

use rayon::prelude::*;

use crate::friction::patches::GRAIN_PATCHES;
use crate::friction::patches::solve::chunks::{Left, each_patch};
use crate::friction::patches::solve::newton::Newton;
use crate::friction::patches::solve::{CoupledPatch, GAMMA, Motion, Search};

/// Visits after which a search ends: of each patch on average, and of few patches together; more of each where the solver compares forces of one
/// evaluation with the next.
const MOST_VISITS_EACH: usize = 100;
const MOST_VISITS: usize = 20_000;
const ITERATED_VISITS_EACH: usize = 300;
/// Sweeps over these: most visit only patches whose blocks were pushed.
const SHORT_SWEEPS: usize = 10;

/// Visits of each patch before Newton's method, on average, and of few patches together: few are found sooner by visits, many hardly at all.
pub(super) const VISITS_ALONE: usize = 8;
const FEW_VISITS: usize = 10_000;
/// Newton's steps, visits of each patch on average between two of them, and how many times more after each that was taken back.
const NEWTON_STEPS: usize = 20;
const VISITS_BETWEEN: usize = 1;
const PATIENCE: usize = 4;

/// Visits before Newton's method.
pub(crate) fn visits_alone(patches: usize) -> usize {
    (VISITS_ALONE * patches).max(FEW_VISITS)
}

/// Visits, of each patch on average and of few patches together, after which a search may end although friction still changes by ten times what does not
/// matter, and as many again for each further factor of ten; most factors.
const EASED_EACH: usize = 10;
const EASED_VISITS: usize = 4_000;
const MOST_EASED: usize = 3;

/// Visits after which a search may leave ten times what does not matter; never where the solver compares forces of one evaluation with the next.
pub(crate) fn visits_eased(patches: usize, is_iterated: bool) -> usize {
    if is_iterated { usize::MAX } else { (EASED_EACH * patches).max(EASED_VISITS) }
}

/// Which patches are to be visited: those of which a block was pushed by more than a tolerance since the last visit.
#[derive(Default)]
pub(crate) struct Visits {
    /// When each block was pushed last.
    pub(super) pushed: Vec<u32>,
    pub(super) now: u32,
    /// Patches whose friction was looked for.
    pub(super) count: usize,
}

impl Visits {
    fn begin(&mut self, blocks: usize) {
        self.pushed.clear();
        self.pushed.resize(blocks, 1);
        (self.now, self.count) = (1, 0);
    }
}

/// One of both minima.
pub(super) fn solve_stage(patches: &mut [CoupledPatch], motion: &mut Motion, newton: &mut Newton) -> Search {
    let (time_s, count) = (GAMMA * motion.dt_s, patches.len());
    let most_visits = if motion.is_iterated { ITERATED_VISITS_EACH } else { MOST_VISITS_EACH } * count;
    let most_visits = most_visits.max(MOST_VISITS);
    let most_sweeps = SHORT_SWEEPS * most_visits / count.max(1);
    motion.visits.begin(motion.bodies.len());
    let all = &*motion;
    patches.par_iter_mut().enumerate().with_min_len(GRAIN_PATCHES).for_each(|(row, patch)| {
        (patch.row, patch.seen) = (row as u32, 0);
        patch.begin(all);
    });
    let (mut sweeps, mut left) = (0, Left::default());
    let (mut steps, mut is_tried, mut between) = (0, false, VISITS_BETWEEN * count);
    let mut next = motion.alone;
    while sweeps < most_sweeps && motion.visits.count < most_visits {
        left = sweep(patches, motion, time_s, sweeps);
        let factors = (motion.visits.count / motion.eased).min(MOST_EASED);
        let is_found = left.slip_m_s == 0.0 || !is_tried && left.times <= 10f64.powi(factors as i32);
        if is_found && !refine(patches) {
            break;
        }
        sweeps += 1;
        if std::mem::take(&mut is_tried) && !newton.gains(patches, motion) {
            newton.take_back(patches, motion, time_s);
            between *= PATIENCE;
            next = motion.visits.count + between;
        }
        let has_room = motion.visits.count + (1 + VISITS_BETWEEN) * count < most_visits;
        if motion.visits.count >= next && steps < NEWTON_STEPS && has_room {
            if steps == 0 {
                newton.begin(patches, motion, time_s);
            }
            newton.step(patches, motion, time_s);
            patches.iter_mut().for_each(|patch| patch.seen = 0);
            (steps, is_tried, next) = (steps + 1, true, motion.visits.count + between);
        }
    }
    Search { visits: motion.visits.count, left_m_s: left.slip_m_s }
}

/// Whether patches turn of which that was not known: their friction is to be found anew.
fn refine(patches: &mut [CoupledPatch]) -> bool {
    patches.iter_mut().fold(false, |turns, patch| turns | patch.refine())
}

/// A sweep over all patches that are to be visited, to and fro by turns.
fn sweep(patches: &mut [CoupledPatch], motion: &mut Motion, time_s: f64, number: usize) -> Left {
    let time = motion.share(time_s);
    let found = each_patch(patches, motion, number.is_multiple_of(2), |patch, place| {
        if place.pushed(patch) > patch.seen {
            patch.seen = place.next();
            let of_patch = patch.advance(place, time, number == 0);
            let left = &mut place.found().left;
            left.slip_m_s = left.slip_m_s.max(of_patch.slip_m_s);
            left.times = left.times.max(of_patch.times);
        }
    });
    motion.visits.count += found.visits;
    found.left
}
