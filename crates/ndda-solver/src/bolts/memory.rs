//! What bolts remember: slip, yielding and breaks.

use serde::{Deserialize, Serialize};

/// What all bolts remember, one after the other; part of the state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BoltMemory {
    /// Displacement of each node of the bars along them, from which the next solve starts [m].
    displacement_m: Vec<f64>,
    /// Slip of grout and plates [m].
    slip_m: Vec<f64>,
    /// Displacement of the rock there when the bolt was installed [m].
    start_m: Vec<f64>,
    /// What has yielded of each piece of steel [m].
    yielded_m: Vec<f64>,
    broken: Vec<bool>,
    /// Slip of dowels in the frame of their crossing [m].
    dowel_slip_m: Vec<[f64; 2]>,
    /// How far the plate of each bolt has yielded, and its dowels in all [m].
    gave_way_m: Vec<[f64; 2]>,
    /// Energy that yielding and breaking has taken from each bolt [J].
    dissipated_j: Vec<f64>,
}

/// How much a bolt remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sizes {
    /// Nodes of its bar.
    pub nodes: usize,
    /// Springs that hold it.
    pub holders: usize,
    /// Places where it crosses from one block to the next.
    pub crossings: usize,
}

/// What one bolt remembers.
pub(crate) struct MemoryOf<'a> {
    pub displacement_m: &'a mut [f64],
    pub slip_m: &'a mut [f64],
    pub start_m: &'a mut [f64],
    pub yielded_m: &'a mut [f64],
    pub broken: &'a mut [bool],
    pub dowel_slip_m: &'a mut [[f64; 2]],
    pub gave_way_m: &'a mut [f64; 2],
    pub dissipated_j: &'a mut f64,
}

impl BoltMemory {
    /// Of bolts as they are set.
    pub(crate) fn new(bolts: &[Sizes]) -> Self {
        let count = |of: fn(&Sizes) -> usize| bolts.iter().map(of).sum::<usize>();
        let pieces = count(|bolt| bolt.nodes - 1);
        Self {
            displacement_m: vec![0.0; count(|bolt| bolt.nodes)],
            slip_m: vec![0.0; count(|bolt| bolt.holders)],
            start_m: vec![0.0; count(|bolt| bolt.holders)],
            yielded_m: vec![0.0; pieces],
            broken: vec![false; pieces],
            dowel_slip_m: vec![[0.0; 2]; count(|bolt| bolt.crossings)],
            gave_way_m: vec![[0.0; 2]; bolts.len()],
            dissipated_j: vec![0.0; bolts.len()],
        }
    }

    /// Numbers of its values, and what they are of: those of the same bolts agree.
    pub(crate) fn sizes(&self) -> [(&'static str, usize); 8] {
        [
            ("bolts", self.dissipated_j.len()),
            ("nodes of bolts", self.displacement_m.len()),
            ("springs of bolts", self.slip_m.len()),
            ("starts of springs of bolts", self.start_m.len()),
            ("pieces of bolts", self.yielded_m.len()),
            ("states of pieces of bolts", self.broken.len()),
            ("crossings of bolts", self.dowel_slip_m.len()),
            ("plates and dowels of bolts", self.gave_way_m.len()),
        ]
    }

    /// Takes over another of the same bolts, without new memory.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.displacement_m.copy_from_slice(&other.displacement_m);
        self.slip_m.copy_from_slice(&other.slip_m);
        self.start_m.copy_from_slice(&other.start_m);
        self.yielded_m.copy_from_slice(&other.yielded_m);
        self.broken.copy_from_slice(&other.broken);
        self.dowel_slip_m.copy_from_slice(&other.dowel_slip_m);
        self.gave_way_m.copy_from_slice(&other.gave_way_m);
        self.dissipated_j.copy_from_slice(&other.dissipated_j);
    }

    /// Energy that yielding and breaking has taken [J].
    pub(crate) fn dissipated_j(&self) -> f64 {
        self.dissipated_j.iter().sum::<f64>() + 0.0
    }

    /// Begins to count the energy anew.
    pub(crate) fn forget_work(&mut self) {
        self.dissipated_j.fill(0.0);
    }

    /// Does something with what each bolt remembers, in order, and its index.
    pub(crate) fn each(&mut self, bolts: &[Sizes], mut work: impl FnMut(usize, MemoryOf)) {
        let (mut displacement_m, mut slip_m) = (&mut self.displacement_m[..], &mut self.slip_m[..]);
        let (mut yielded_m, mut broken) = (&mut self.yielded_m[..], &mut self.broken[..]);
        let (mut start_m, mut dowel_slip_m) = (&mut self.start_m[..], &mut self.dowel_slip_m[..]);
        let totals = self.gave_way_m.iter_mut().zip(&mut self.dissipated_j);
        for (index, (bolt, (gave_way_m, dissipated_j))) in bolts.iter().zip(totals).enumerate() {
            work(
                index,
                MemoryOf {
                    displacement_m: take(&mut displacement_m, bolt.nodes),
                    slip_m: take(&mut slip_m, bolt.holders),
                    start_m: take(&mut start_m, bolt.holders),
                    yielded_m: take(&mut yielded_m, bolt.nodes - 1),
                    broken: take(&mut broken, bolt.nodes - 1),
                    dowel_slip_m: take(&mut dowel_slip_m, bolt.crossings),
                    gave_way_m,
                    dissipated_j,
                },
            );
        }
    }
}

/// The first `count` of what is left.
fn take<'a, T>(left: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let (first, rest) = std::mem::take(left).split_at_mut(count);
    *left = rest;
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_of_which_a_part_is_cut_off_has_other_sizes() {
        let whole = BoltMemory::new(&[Sizes { nodes: 4, holders: 3, crossings: 1 }]);
        let cut = |cut: fn(&mut BoltMemory)| {
            let mut memory = whole.clone();
            cut(&mut memory);
            memory
        };
        let parts: [(&str, BoltMemory); 8] = [
            ("bolts", cut(|memory| memory.dissipated_j.clear())),
            ("nodes of bolts", cut(|memory| memory.displacement_m.clear())),
            ("springs of bolts", cut(|memory| memory.slip_m.clear())),
            ("starts of springs of bolts", cut(|memory| memory.start_m.clear())),
            ("pieces of bolts", cut(|memory| memory.yielded_m.clear())),
            ("states of pieces of bolts", cut(|memory| memory.broken.clear())),
            ("crossings of bolts", cut(|memory| memory.dowel_slip_m.clear())),
            ("plates and dowels of bolts", cut(|memory| memory.gave_way_m.clear())),
        ];
        for (what, memory) in parts {
            let differs = memory.sizes().into_iter().zip(whole.sizes()).find(|(cut, whole)| cut != whole);
            assert_eq!(differs.map(|(cut, _)| cut), Some((what, 0)));
        }
    }
}
