//! What is observed in a trial.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use super::free_blocks::{free, gone_m};

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

    /// How far each block will be when it has gone farther by so much [m].
    pub fn farther_by(&self, far_m: f64) -> Vec<f64> {
        self.gone_m.last().expect("the start is looked at").iter().map(|gone| gone + far_m).collect()
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
