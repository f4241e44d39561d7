//! Runs over blocks in parallel with disjoint slices of the nodal arrays.

use ndda_mesh::Vec3;

/// The slices of per-node arrays that belong to a run of blocks.
pub struct NodeSlices<'a> {
    /// x [m].
    pub position: &'a mut [Vec3],
    /// v [m/s].
    pub velocity: &'a mut [Vec3],
    /// a [m/s²].
    pub acceleration: &'a mut [Vec3],
    /// f_int [N]; empty when the integrator does not need it.
    pub internal_force: &'a mut [Vec3],
}

/// The same to read.
#[derive(Clone, Copy)]
pub struct Nodes<'a> {
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
    pub fn only_positions(position: &'a mut [Vec3]) -> Self {
        Self { position, velocity: &mut [], acceleration: &mut [], internal_force: &mut [] }
    }

    /// To read.
    pub fn view(&self) -> Nodes<'_> {
        Nodes {
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

/// Calls `work(block, item, slices)` for each item, each with the node range of its block.
///
/// `starts` are the node starts of these blocks with the end appended. Halves are handed to other threads while a
/// half holds more than `grain` nodes. No block sees another, so the result does not depend on the threads.
pub fn for_each_block<T: Send>(
    first: usize,
    items: &mut [T],
    starts: &[u32],
    slices: NodeSlices,
    grain: usize,
    work: &(impl Fn(usize, &mut T, NodeSlices) + Sync),
) {
    match items {
        [] => {}
        [item] => work(first, item, slices),
        _ => {
            let middle = items.len() / 2;
            let (head, tail) = items.split_at_mut(middle);
            let (head_slices, tail_slices) = slices.split_at((starts[middle] - starts[0]) as usize);
            let parallel = tail_slices.position.len().min(head_slices.position.len()) > grain;
            let run_head = || for_each_block(first, head, &starts[..=middle], head_slices, grain, work);
            let run_tail =
                || for_each_block(first + middle, tail, &starts[middle..], tail_slices, grain, work);
            if parallel {
                rayon::join(run_head, run_tail);
            } else {
                run_head();
                run_tail();
            }
        }
    }
}
