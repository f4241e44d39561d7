//! Work on blocks in parallel with disjoint slices of the nodal arrays.

use std::ops::Range;

use ndda_mesh::Vec3;

/// The slices of per-node arrays that belong to a run of blocks.
pub(crate) struct NodeSlices<'a> {
    /// x [m].
    pub position: &'a mut [Vec3],
    /// v [m/s].
    pub velocity: &'a mut [Vec3],
    /// a [m/s²].
    pub acceleration: &'a mut [Vec3],
    /// f_int [N]; empty when the integrator does not need it.
    pub internal_force: &'a mut [Vec3],
}

/// Nodes of a group, read only.
#[derive(Clone, Copy)]
pub(crate) struct Nodes<'a> {
    /// x [m].
    pub position: &'a [Vec3],
    /// v [m/s].
    pub velocity: &'a [Vec3],
    /// a [m/s²].
    pub acceleration: &'a [Vec3],
    /// f_int [N]; empty when the integrator does not need it.
    pub internal_force: &'a [Vec3],
}

impl<'a> NodeSlices<'a> {
    /// Slices of one array alone.
    pub(crate) fn only_positions(position: &'a mut [Vec3]) -> Self {
        Self { position, velocity: &mut [], acceleration: &mut [], internal_force: &mut [] }
    }

    /// To read.
    pub(crate) fn view(&self) -> Nodes<'_> {
        Nodes {
            position: self.position,
            velocity: self.velocity,
            acceleration: self.acceleration,
            internal_force: self.internal_force,
        }
    }

    /// The slices of another borrow.
    pub(crate) fn again(&mut self) -> NodeSlices<'_> {
        NodeSlices {
            position: self.position,
            velocity: self.velocity,
            acceleration: self.acceleration,
            internal_force: self.internal_force,
        }
    }

    fn split_at(self, node: usize) -> (Self, Self) {
        let (p0, p1) = self.position.split_at_mut(node);
        // Arrays that nobody needs are empty.
        let (v0, v1) = self.velocity.split_at_mut(node.min(self.velocity.len()));
        let (a0, a1) = self.acceleration.split_at_mut(node.min(self.acceleration.len()));
        let (f0, f1) = self.internal_force.split_at_mut(node.min(self.internal_force.len()));
        let head = Self { position: p0, velocity: v0, acceleration: a0, internal_force: f0 };
        (head, Self { position: p1, velocity: v1, acceleration: a1, internal_force: f1 })
    }
}

/// Blocks in runs: those of a run are worked on together, by one thread.
pub(crate) struct CongruentGroups {
    /// First block of each run, with the end appended.
    starts: Vec<u32>,
}

impl CongruentGroups {
    /// Every block by itself.
    pub(crate) fn single(blocks: usize) -> Self {
        Self { starts: (0..=blocks as u32).collect() }
    }

    /// The blocks of each run.
    pub(crate) fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        self.starts.windows(2).map(|ends| ends[0] as usize..ends[1] as usize)
    }

    /// Lets runs end also where these blocks begin.
    pub(crate) fn split(&mut self, firsts: &[usize]) {
        self.starts.extend(firsts.iter().map(|first| *first as u32));
        self.starts.sort_unstable();
        self.starts.dedup();
    }

    /// Neighbours in the list for which `congruent` holds, up to `most` in a run.
    pub(crate) fn group(blocks: usize, most: usize, congruent: impl Fn(usize, usize) -> bool) -> Self {
        let mut starts: Vec<u32> = vec![0];
        for block in 1..blocks {
            let first = starts[starts.len() - 1] as usize;
            if block - first == most || !congruent(first, block) {
                starts.push(block as u32);
            }
        }
        starts.push(blocks as u32);
        Self { starts }
    }
}

/// Calls `work(first block, items, slices)` for each run, with the nodes of its blocks.
///
/// `node_starts` are the node starts of all blocks with the end appended. Halves are handed to other threads while a
/// half holds more than `grain` nodes. No run sees another, so the result does not depend on the threads.
pub(crate) fn for_each_run<T: Send>(
    runs: &CongruentGroups,
    items: &mut [T],
    node_starts: &[u32],
    slices: NodeSlices,
    grain: usize,
    work: &(impl Fn(usize, &mut [T], NodeSlices) + Sync),
) {
    if !items.is_empty() {
        halve(&runs.starts, items, node_starts, slices, grain, work);
    }
}

fn halve<T: Send>(
    runs: &[u32],
    items: &mut [T],
    node_starts: &[u32],
    slices: NodeSlices,
    grain: usize,
    work: &(impl Fn(usize, &mut [T], NodeSlices) + Sync),
) {
    let first = runs[0] as usize;
    if runs.len() == 2 {
        return work(first, items, slices);
    }
    let middle = (runs.len() - 1) / 2;
    let block = runs[middle] as usize;
    let (head, tail) = items.split_at_mut(block - first);
    let (head_slices, tail_slices) = slices.split_at((node_starts[block] - node_starts[first]) as usize);
    let parallel = tail_slices.position.len().min(head_slices.position.len()) > grain;
    let run_head = || halve(&runs[..=middle], head, node_starts, head_slices, grain, work);
    let run_tail = || halve(&runs[middle..], tail, node_starts, tail_slices, grain, work);
    if parallel {
        rayon::join(run_head, run_tail);
    } else {
        run_head();
        run_tail();
    }
}

/// Calls `work(block, item, slices)` for each block of a run, one after the other.
pub(crate) fn each_of_run<T>(
    first: usize,
    items: &mut [T],
    node_starts: &[u32],
    mut slices: NodeSlices,
    mut work: impl FnMut(usize, &mut T, NodeSlices),
) {
    for (offset, item) in items.iter_mut().enumerate() {
        let block = first + offset;
        let (own, rest) = slices.split_at((node_starts[block + 1] - node_starts[block]) as usize);
        work(block, item, own);
        slices = rest;
    }
}
