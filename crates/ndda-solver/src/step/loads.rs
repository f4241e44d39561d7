//! External loads on the nodes, at any time of a run.

use std::ops::Range;

use ndda_fem::{Between, Table};
use ndda_mesh::Vec3;

use crate::diagnostics::block_sums::{ExactVector, over_blocks};
use crate::step::Simulation;
use crate::step::follower::{FollowerPressure, Places};
use crate::step::state::State;

/// Nodal forces that grow and shrink together.
#[derive(Clone, Debug)]
pub(crate) struct VaryingLoad {
    /// Node, and force at a factor of one [N].
    pub forces: Vec<(u32, Vec3)>,
    /// The factor over time.
    pub factor: Table,
    /// How fast the block that feels it most is made by a factor of one [m/s²].
    pub pace_m_s2: f64,
}

impl VaryingLoad {
    /// Forces on a run of nodes from `first` on; those that are zero are left out.
    pub(crate) fn new(first: usize, forces: &[Vec3], factor: Table, pace_m_s2: f64) -> Self {
        let some = forces.iter().enumerate().filter(|(_, force)| **force != Vec3::zeros());
        Self { forces: some.map(|(i, force)| ((first + i) as u32, *force)).collect(), factor, pace_m_s2 }
    }
}

/// All loads but contact.
#[derive(Clone, Debug)]
pub(crate) struct Loads {
    /// First node of each block, with the end appended.
    starts: Vec<u32>,
    constant: Vec<Vec3>,
    /// The part of them that is not reactions of quiet faces; empty while there are none.
    given: Vec<Vec3>,
    varying: Vec<VaryingLoad>,
    /// What a stage lets act on and ramp down.
    release: Option<VaryingLoad>,
    /// Pressure of water.
    pressures: Vec<FollowerPressure>,
    /// Forces that a caller has set, per node [N]; empty while none was.
    driving: Vec<Vec3>,
    /// Whether there are loads other than the weight from the start.
    pub(crate) beyond_weight: bool,
    /// Sum of the varying ones now; empty if there are none, and so is `total`.
    changing: Vec<Vec3>,
    total: Vec<Vec3>,
    /// Sum over the nodes of all of them, and of how large each is [N].
    force: Vec3,
    size_n: f64,
    /// Speed that the varying ones bring and take back unseen within the step [m/s].
    unresolved_m_s: f64,
}

impl Loads {
    /// Constant forces per node, those that vary, and pressures, on nodes that are at rest somewhere; the first node of each block is given, with the end appended.
    pub(crate) fn new(
        constant: Vec<Vec3>,
        varying: Vec<VaryingLoad>,
        pressures: Vec<FollowerPressure>,
        (starts, rest): (Vec<u32>, Places),
    ) -> Self {
        let (force, size_n) = sum_and_size(&constant, &starts);
        let nodes = if varying.is_empty() && pressures.is_empty() { 0 } else { constant.len() };
        let mut loads = Self {
            starts,
            constant,
            given: Vec::new(),
            varying,
            release: None,
            pressures,
            driving: Vec::new(),
            beyond_weight: false,
            changing: vec![Vec3::zeros(); nodes],
            total: vec![Vec3::zeros(); nodes],
            force,
            size_n,
            unresolved_m_s: 0.0,
        };
        loads.place(0.0, 0.0, rest);
        loads
    }

    /// None at all.
    pub(crate) fn none() -> Self {
        let nowhere = Places { position: &[], velocity: &[], lead_s: 0.0 };
        Self::new(Vec::new(), Vec::new(), Vec::new(), (Vec::new(), nowhere))
    }

    /// Makes the varying ones their means between two times [s], pressures on nodes where they are then.
    pub(crate) fn place(&mut self, from_s: f64, to_s: f64, places: Places) {
        if self.changing.is_empty() {
            return;
        }
        if self.driving.is_empty() {
            self.changing.fill(Vec3::zeros());
        } else {
            self.changing.copy_from_slice(&self.driving);
        }
        self.unresolved_m_s = 0.0;
        for load in self.varying.iter().chain(&self.release) {
            let Between { mean: factor, beyond_s } = load.factor.between(from_s, to_s);
            self.unresolved_m_s += load.pace_m_s2 * beyond_s;
            load.forces.iter().for_each(|(node, force)| self.changing[*node as usize] += factor * force);
        }
        for pressure in &mut self.pressures {
            self.unresolved_m_s += pressure.add((from_s, to_s), places, &mut self.changing);
        }
        let sums = self.constant.iter().zip(&self.changing);
        self.total.iter_mut().zip(sums).for_each(|(total, (a, b))| *total = a + b);
        (self.force, self.size_n) = sum_and_size(&self.total, &self.starts);
    }

    /// Lets forces per node [N] act from now on, beside the others.
    pub(crate) fn drive(&mut self, nodal: Vec<Vec3>) {
        self.make_room();
        self.driving = nodal;
    }

    fn make_room(&mut self) {
        if self.changing.is_empty() {
            self.changing = vec![Vec3::zeros(); self.constant.len()];
            self.total = self.changing.clone();
        }
    }

    /// Lets a load act that is taken away by and by, in the place of the one before.
    pub(crate) fn release(&mut self, load: Option<VaryingLoad>, now_s: f64, places: Places) {
        if load.is_some() {
            self.make_room();
        }
        self.release = load;
        self.place(now_s, now_s, places);
    }

    /// Takes all loads off some runs of nodes.
    pub(crate) fn leave_out(&mut self, nodes: &[Range<usize>], places: Places) {
        let is_there = |n: u32| !nodes.iter().any(|range| range.contains(&(n as usize)));
        for forces in [&mut self.constant, &mut self.given].into_iter().filter(|forces| !forces.is_empty()) {
            nodes.iter().for_each(|range| forces[range.clone()].fill(Vec3::zeros()));
        }
        self.varying.iter_mut().for_each(|load| load.forces.retain(|(node, _)| is_there(*node)));
        self.pressures.retain(|pressure| pressure.first_node().is_none_or(is_there));
        (self.force, self.size_n) = sum_and_size(&self.constant, &self.starts);
        self.place(0.0, 0.0, places);
    }

    /// Lets the reactions of quiet faces [N] act from now on as constant loads, in the place of those of before.
    pub(crate) fn keep(&mut self, reactions: &[Vec3]) {
        if self.given.is_empty() {
            self.given.clone_from(&self.constant);
        }
        let sums = self.given.iter().zip(reactions);
        self.constant.iter_mut().zip(sums).for_each(|(sum, (given, kept))| *sum = given + kept);
        if self.changing.is_empty() {
            (self.force, self.size_n) = sum_and_size(&self.constant, &self.starts);
        }
    }

    /// Times [s] of the last row of each table of a load, and of its largest and its least factor that lasts for `held_s`.
    pub(crate) fn extremes_s(&self, held_s: f64) -> impl Iterator<Item = f64> {
        let of_pressures = self.pressures_over_time().map(|(_, factor)| factor);
        let factors = self.varying.iter().map(|load| &load.factor).chain(of_pressures);
        factors.flat_map(move |factor| extremes(&factor.rows, held_s)).map(|row| row.0)
    }

    /// Load on each node [N] at a time, with the nodes at `places`; without the forces that a caller has set and the reactions of quiet faces.
    pub(crate) fn at(&self, time_s: f64, places: Places) -> Vec<Vec3> {
        let mut then = self.clone();
        then.driving.clear();
        if !then.given.is_empty() {
            then.constant = std::mem::take(&mut then.given);
        }
        then.place(time_s, time_s, places);
        then.total().to_vec()
    }

    /// Faces of pressures that change over time, and their factors.
    pub(crate) fn pressures_over_time(&self) -> impl Iterator<Item = (&[[u32; 3]], &Table)> {
        self.pressures.iter().filter_map(FollowerPressure::over_time)
    }

    /// Whether there are loads other than the weight, which may change along the way of a block.
    pub(crate) fn are_more_than_weight(&self) -> bool {
        self.beyond_weight || self.release.is_some() || !self.driving.is_empty() || !self.given.is_empty()
    }

    /// Whether a caller has set forces.
    pub(crate) fn is_driven(&self) -> bool {
        !self.driving.is_empty()
    }

    /// Constant part of the loads, per node [N].
    pub(crate) fn constant(&self) -> &[Vec3] {
        &self.constant
    }

    /// Varying part of the loads, as last placed [N]; empty if nothing varies.
    pub(crate) fn changing(&self) -> &[Vec3] {
        &self.changing
    }

    /// Both [N].
    pub(crate) fn total(&self) -> &[Vec3] {
        if self.changing.is_empty() { &self.constant } else { &self.total }
    }

    /// Speed that they bring and take back within the step, where nobody sees it [m/s].
    pub(crate) fn unresolved_m_s(&self) -> f64 {
        self.unresolved_m_s
    }

    /// Their sum over all nodes [N].
    pub(crate) fn force(&self) -> Vec3 {
        self.force
    }

    /// Sum of how large they are over all nodes, where they cancel too [N].
    pub(crate) fn size_n(&self) -> f64 {
        self.size_n
    }
}

/// The last row of a table, and the rows of its largest and its least value that lasts for `held_s`.
fn extremes(rows: &[(f64, f64)], held_s: f64) -> impl Iterator<Item = (f64, f64)> {
    let mut rising: Vec<usize> = (0..rows.len()).collect();
    rising.sort_by(|a, b| rows[*a].1.total_cmp(&rows[*b].1));
    let least = rising.iter().find(|row| holds(rows, **row, held_s)).copied();
    let largest = rising.iter().rev().find(|row| holds(rows, **row, held_s)).copied();
    least.into_iter().chain(largest).map(|row| rows[row]).chain(rows.last().copied())
}

/// Whether a table stays at or above half of its value at a row for `held_s` around that row. It is constant before its first row and after its last.
fn holds(rows: &[(f64, f64)], row: usize, held_s: f64) -> bool {
    let value = rows[row].1;
    let is_less = |(_, other): &&(f64, f64)| other * value.signum() < 0.5 * value.abs();
    let before_s = rows[..row].iter().rev().find(is_less).map_or(f64::NEG_INFINITY, |row| row.0);
    let after_s = rows[row..].iter().find(is_less).map_or(f64::INFINITY, |row| row.0);
    after_s - before_s >= held_s
}

/// Sum of forces on the nodes of all blocks, and of how large each is.
fn sum_and_size(forces: &[Vec3], starts: &[u32]) -> (Vec3, f64) {
    let mut sum = ExactVector::default();
    let size_n = over_blocks(starts, |nodes| {
        let of_block = &forces[nodes];
        sum.add(&of_block.iter().sum());
        of_block.iter().map(|force| force.norm()).sum()
    });
    (sum.value(), size_n)
}

impl Simulation {
    /// Times [s] at which loads are largest or least: the start, and of each table of gravity, tractions, forces and water the last row and those of the largest and
    /// the least factor that keeps half of its value or more for `held_s` around it. Shorter pulses, such as blasts, are left out.
    pub fn load_times_s(&self, held_s: f64) -> Vec<f64> {
        let mut times_s: Vec<f64> = std::iter::once(0.0).chain(self.loads.extremes_s(held_s)).collect();
        times_s.sort_by(f64::total_cmp);
        times_s.dedup();
        times_s
    }

    /// Loads on all nodes at a time where blocks were drawn [N]: gravity, tractions, forces, and pressures of water and blasts.
    pub fn loads_as_drawn(&self, time_s: f64) -> Vec<Vec3> {
        let position = &self.problem.blocks.rest_position;
        self.loads.at(time_s, Places { position, velocity: &self.state.velocity, lead_s: 0.0 })
    }

    /// Loads on the nodes where they are, at the present time.
    pub(crate) fn place_loads_now(&mut self) {
        let now_s = self.clock_s(0.0);
        let State { position, velocity, .. } = &self.state;
        self.loads.place(now_s, now_s, Places { position, velocity, lead_s: 0.0 });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_that_are_taken_off_stay_off_when_reactions_of_quiet_faces_are_kept() {
        let nowhere = Places { position: &[], velocity: &[], lead_s: 0.0 };
        let one = Vec3::new(1.0, 2.0, 3.0);
        let mut loads = Loads::new(vec![one; 2], Vec::new(), Vec::new(), (vec![0, 1, 2], nowhere));
        loads.keep(&[Vec3::zeros(); 2]);
        loads.leave_out(std::slice::from_ref(&(1..2)), nowhere);
        assert_eq!(loads.total(), [one, Vec3::zeros()]);
        loads.keep(&[-one, Vec3::zeros()]);
        assert_eq!(loads.total(), [Vec3::zeros(); 2]);
        assert_eq!(loads.force(), Vec3::zeros());
        assert_eq!(loads.at(0.0, nowhere), [one, Vec3::zeros()]);
    }

    #[test]
    fn a_table_counts_where_it_is_extreme_for_long_enough_and_at_its_end() {
        let counted = |rows: &[(f64, f64)], held_s: f64| -> Vec<f64> {
            extremes(rows, held_s).map(|row| row.0).collect()
        };
        let peak = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.1), (9.0, 0.2)];
        assert_eq!(counted(&peak, 0.5), [0.0, 1.0, 9.0]);
        let pulse = [(0.0, 0.0), (0.01, 0.5), (0.02, 1.0), (0.03, 0.2), (0.05, -1.0), (0.06, 0.1)];
        assert_eq!(counted(&pulse, 0.5), [0.0, 0.06, 0.06], "its ends hold for ever");
        assert_eq!(counted(&pulse, 0.015), [0.05, 0.02, 0.06]);
        assert!(counted(&[], 1.0).is_empty());
    }
}
