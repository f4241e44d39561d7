//! What is observed in a trial.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use super::free_blocks::{free, gone_m};
use crate::numbers::length;

/// Fewest windows that are compared with each other.
const SPAN: usize = 2;
/// How much farther a block goes in one of them than in the one before where its contact does not just vibrate.
const MUCH: f64 = 1.1;

/// Observed quantities of a trial.
pub struct Watched {
    start: Vec<Vec3>,
    blocks: Vec<BlockId>,
    pub times_s: Vec<f64>,
    /// How far each free block has gone, per look [m].
    gone_m: Vec<Vec<f64>>,
    /// Looks before the push.
    before: usize,
}

impl Watched {
    pub fn new(simulation: &Simulation, start: &[Vec3]) -> Self {
        let blocks = free(simulation).collect();
        let mut watched =
            Self { start: start.to_vec(), blocks, times_s: Vec::new(), gone_m: Vec::new(), before: 0 };
        watched.look(simulation);
        watched
    }

    /// Forgets the times before.
    pub fn begin(&mut self, simulation: &Simulation) {
        self.times_s.clear();
        self.gone_m.clear();
        self.look(simulation);
    }

    /// Compares later looks with each other only.
    pub fn pushed(&mut self) {
        self.before = self.gone_m.len() - 1;
    }

    /// Whether blocks have been pushed.
    pub fn is_pushed(&self) -> bool {
        self.before > 0
    }

    /// How far the block has gone since the last push that has gone farthest since then [m].
    pub fn pushed_on_m(&self) -> f64 {
        let last = self.gone_m.last().expect("the start is looked at");
        last.iter().zip(&self.gone_m[self.before]).map(|(now, then)| (now - then).abs()).fold(0.0, f64::max)
    }

    /// How far each block will be when it has gone farther by so much [m].
    pub fn farther_by(&self, far_m: &[f64]) -> Vec<f64> {
        let last = self.gone_m.last().expect("the start is looked at");
        last.iter().zip(far_m).map(|(gone, far_m)| gone + far_m).collect()
    }

    pub fn look(&mut self, simulation: &Simulation) {
        self.times_s.push(simulation.time_s());
        self.gone_m.push(gone_m(simulation, &self.start).into_iter().map(|(_, gone)| gone).collect());
    }

    /// Place of the block that has gone farthest.
    pub fn farthest(&self) -> usize {
        let last = self.gone_m.last().expect("the start is looked at");
        (0..last.len()).max_by(|&a, &b| last[a].total_cmp(&last[b]).then(b.cmp(&a))).expect("a block is free")
    }

    pub fn farthest_m(&self) -> f64 {
        self.gone_m.last().expect("the start is looked at")[self.farthest()]
    }

    pub fn name(&self, simulation: &Simulation) -> String {
        simulation.blocks().names[self.blocks[self.farthest()].index()].clone()
    }

    pub fn history(&self) -> Vec<[f64; 2]> {
        let farthest = self.farthest();
        self.times_s.iter().zip(&self.gone_m).map(|(&time, gone)| [time, gone[farthest]]).collect()
    }

    /// A block that has gone far now.
    pub fn beyond(&self, far_m: &[f64]) -> Option<(BlockId, f64)> {
        let last = self.gone_m.last().expect("the start is looked at");
        let block = (0..last.len()).find(|&block| last[block] > far_m[block])?;
        Some((self.blocks[block], last[block]))
    }

    /// A block that has gone far and accelerates: since the push, or else the start, it has gone farther in each third of the time than in the one
    /// before, or in each of the last three spans much farther.
    pub fn accelerating(&self, far_m: &[f64]) -> Option<(BlockId, f64)> {
        let (last, third) = (self.gone_m.len() - 1, self.third());
        let accelerates = |&block: &usize| {
            let grows = |span: usize, by: f64| {
                let [a, b, c] = self.ways_m(block, span);
                a >= 0.0 && b > by * a && c > by * b
            };
            self.gone_m[last][block] > far_m[block] && (grows(third, 1.0) || grows(SPAN, MUCH))
        };
        let block = (0..self.blocks.len()).filter(|_| third >= SPAN).find(accelerates)?;
        Some((self.blocks[block], self.gone_m[last][block]))
    }

    /// That a block has gone far and accelerates.
    pub fn fails(&self, simulation: &Simulation, far_m: &[f64]) -> Option<String> {
        let (block, gone_m) = self.accelerating(far_m)?;
        let name = &simulation.blocks().names[block.index()];
        Some(format!("`{name}` accelerates; it had moved {} when that was clear", length(gone_m)))
    }

    /// A third of the windows since the push, or else the start.
    fn third(&self) -> usize {
        (self.gone_m.len() - 1 - self.before) / 3
    }

    /// How much farther a block has gone in each of the last three spans of so many windows [m].
    fn ways_m(&self, block: usize, span: usize) -> [f64; 3] {
        let at = |spans: usize| self.gone_m[self.gone_m.len() - 1 - spans * span][block];
        [3, 2, 1].map(|spans| at(spans - 1) - at(spans))
    }

    /// Whether a block slows down: since the push, or else the start, it has gone much less far in each third of the time than in the one before.
    fn slows_down(&self, block: usize) -> bool {
        let [a, b, c] = self.ways_m(block, self.third());
        self.third() >= SPAN && MUCH * b < a && MUCH * c < b
    }

    /// Whether each block that has gone far slows down.
    pub fn slowing(&self, far_m: &[f64]) -> bool {
        let last = self.gone_m.last().expect("the start is looked at");
        (0..last.len()).all(|block| last[block] <= far_m[block] || self.slows_down(block))
    }

    /// Whether no block has moved by more than so much between the ends of the last windows, all of them after the push.
    pub fn rested(&self, windows: usize, within_m: f64) -> bool {
        let last = self.gone_m.len() - 1;
        let Some(first) = last.checked_sub(windows).filter(|first| *first >= self.before) else {
            return false;
        };
        let range_m = |block: usize| {
            let gone = self.gone_m[first..].iter().map(|gone| gone[block]);
            gone.clone().fold(0.0, f64::max) - gone.fold(f64::INFINITY, f64::min)
        };
        (0..self.blocks.len()).all(|block| range_m(block) <= within_m)
    }

    /// Largest mean speed over the last quarter of the blocks that have not gone far [m/s].
    pub fn speed_m_s(&self, far_m: &[f64]) -> f64 {
        let last = self.gone_m.len() - 1;
        let first = last - (last / 4).max(1);
        let time_s = self.times_s[last] - self.times_s[first];
        let speed = |block: usize| (self.gone_m[last][block] - self.gone_m[first][block]).abs() / time_s;
        let near = (0..self.blocks.len()).filter(|&block| self.gone_m[last][block] <= far_m[block]);
        near.map(speed).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One block that is looked at this many times, a second apart.
    fn watched(looks: usize, gone_m: impl Fn(f64) -> f64) -> Watched {
        let times_s: Vec<f64> = (0..looks).map(|k| k as f64).collect();
        let gone_m = times_s.iter().map(|&t| vec![gone_m(t)]).collect();
        Watched { start: Vec::new(), blocks: vec![BlockId(0)], times_s, gone_m, before: 0 }
    }

    #[test]
    fn a_block_that_has_gone_far_and_goes_farther_in_each_third_fails() {
        let falls = watched(13, |t| 0.5 * t * t);
        assert_eq!(falls.accelerating(&[30.0]), Some((BlockId(0), 72.0)));
        assert_eq!(falls.accelerating(&[100.0]), None, "it has not gone far");
        assert!(!falls.slowing(&[30.0]));
    }

    #[test]
    fn a_block_that_creeps_or_slows_down_does_not_fail() {
        let creeps = watched(13, |t| 10.0 * t);
        assert_eq!(creeps.accelerating(&[30.0]), None);
        assert!(!creeps.slowing(&[30.0]), "nor does it come to rest");
        let slows = watched(13, |t| 100.0 * (1.0 - (-0.5 * t).exp()));
        assert_eq!(slows.accelerating(&[30.0]), None);
        assert!(slows.slowing(&[30.0]));
        // It need not slow down where it has not gone far.
        assert!(creeps.slowing(&[1000.0]));
    }

    #[test]
    fn a_block_that_vibrates_about_its_place_rests_and_is_not_fast() {
        let rings = watched(33, |t| 1.0 + 0.4 * (1.5 * t).sin());
        assert!(rings.rested(8, 1.0) && !rings.rested(8, 0.1) && !rings.rested(40, 1.0));
        assert_eq!(rings.accelerating(&[30.0]), None);
        let exact_m_s = (rings.gone_m[32][0] - rings.gone_m[24][0]).abs() / 8.0;
        assert!((rings.speed_m_s(&[30.0]) - exact_m_s).abs() < 1e-12);
        assert_eq!(
            rings.speed_m_s(&[0.5]),
            0.0,
            "blocks that have gone far are judged by how they slow down"
        );
    }

    #[test]
    fn only_what_comes_after_the_push_is_compared() {
        // It fell before it was pushed, and slows down from there.
        let gone_m = |t: f64| if t < 12.0 { t * t } else { 144.0 + 60.0 * (1.0 - (-(t - 12.0) / 3.0).exp()) };
        let mut pushed = watched(25, gone_m);
        pushed.before = 12;
        assert!(pushed.slowing(&[30.0]) && pushed.accelerating(&[30.0]).is_none());
        assert_eq!(pushed.beyond(&pushed.farther_by(&[1.0])), None);
    }
}
