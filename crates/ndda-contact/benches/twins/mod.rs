//! Three ways to find which boxes touch: the product's tree of parry3d, and the two that it was measured against.

use ndda_mesh::geometry::Aabb;
use parry3d_f64::bounding_volume::Aabb as ParryAabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

/// Finds all pairs (i < j) of boxes that touch, from nothing but warm memory, on one thread.
pub trait BoxPairs {
    /// Replaces `pairs`, in any order.
    fn find(&mut self, boxes: &[Aabb], pairs: &mut Vec<(u32, u32)>);
}

/// Boxes sorted along the longest side of the scene; each is compared with those that begin before it ends.
#[derive(Default)]
pub struct Sweep {
    order: Vec<u32>,
    sorted: Vec<Aabb>,
}

impl BoxPairs for Sweep {
    fn find(&mut self, boxes: &[Aabb], pairs: &mut Vec<(u32, u32)>) {
        pairs.clear();
        let axis = bounds_of(boxes).imax();
        self.order.clear();
        self.order.extend(0..boxes.len() as u32);
        let start = |i: &u32| boxes[*i as usize].min[axis];
        self.order.sort_unstable_by(|i, j| start(i).total_cmp(&start(j)));
        self.sorted.clear();
        self.sorted.extend(self.order.iter().map(|&i| boxes[i as usize]));
        for (k, one) in self.sorted.iter().enumerate() {
            let ahead = self.sorted[k + 1..].iter().take_while(|other| other.min[axis] <= one.max[axis]);
            for (m, _) in ahead.enumerate().filter(|(_, other)| other.touches(one)) {
                pairs.push(in_order(self.order[k], self.order[k + 1 + m]));
            }
        }
    }
}

/// Cells as large as the mean box, no more than four per box; a pair is found in the cell where its overlap begins.
#[derive(Default)]
pub struct Grid {
    start: Vec<u32>,
    entries: Vec<u32>,
}

impl BoxPairs for Grid {
    fn find(&mut self, boxes: &[Aabb], pairs: &mut Vec<(u32, u32)>) {
        pairs.clear();
        let cells = Cells::of(boxes);
        self.start.clear();
        self.start.resize(cells.count() + 1, 0);
        boxes.iter().for_each(|b| cells.each(b, |cell| self.start[cell + 1] += 1));
        (1..self.start.len()).for_each(|c| self.start[c] += self.start[c - 1]);
        self.entries.clear();
        self.entries.resize(self.start[cells.count()] as usize, 0);
        for (i, bounds) in boxes.iter().enumerate().rev() {
            cells.each(bounds, |cell| {
                // Filled from the end: the end of a cell becomes its start.
                self.start[cell + 1] -= 1;
                self.entries[self.start[cell + 1] as usize] = i as u32;
            });
        }
        for cell in 0..cells.count() {
            let first = self.start[cell + 1] as usize;
            let end = self.start.get(cell + 2).map_or(self.entries.len(), |&e| e as usize);
            let members = &self.entries[first..end];
            for (k, &i) in members.iter().enumerate() {
                for &j in &members[k + 1..] {
                    let (a, b) = (&boxes[i as usize], &boxes[j as usize]);
                    if a.touches(b) && cells.at(cells.place(&a.min.sup(&b.min))) == cell {
                        pairs.push(in_order(i, j));
                    }
                }
            }
        }
    }
}

/// A regular division of the scene.
struct Cells {
    origin: ndda_mesh::Vec3,
    per_m: ndda_mesh::Vec3,
    count: [usize; 3],
}

impl Cells {
    fn of(boxes: &[Aabb]) -> Self {
        let scene = Aabb::around(boxes.iter().flat_map(|b| [&b.min, &b.max]));
        let mean = boxes.iter().map(|b| b.max - b.min).sum::<ndda_mesh::Vec3>() / boxes.len() as f64;
        let size = scene.max - scene.min;
        let mut side = mean;
        loop {
            let count = [0, 1, 2].map(|i| ((size[i] / side[i]).ceil() as usize).max(1));
            if count.iter().product::<usize>() <= 4 * boxes.len() {
                return Self { origin: scene.min, per_m: side.map(|s| 1.0 / s), count };
            }
            side *= 1.26;
        }
    }

    fn count(&self) -> usize {
        self.count.iter().product()
    }

    fn place(&self, x: &ndda_mesh::Vec3) -> [usize; 3] {
        let at = (x - self.origin).component_mul(&self.per_m);
        [0, 1, 2].map(|i| (at[i] as usize).min(self.count[i] - 1))
    }

    fn at(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.count[1] + j) * self.count[0] + i
    }

    fn each(&self, bounds: &Aabb, mut visit: impl FnMut(usize)) {
        let (low, high) = (self.place(&bounds.min), self.place(&bounds.max));
        for k in low[2]..=high[2] {
            for j in low[1]..=high[1] {
                (low[0]..=high[0]).for_each(|i| visit(self.at([i, j, k])));
            }
        }
    }
}

/// parry3d's tree, rebuilt in its own memory, and queried for each box.
#[derive(Default)]
pub struct Tree {
    tree: Bvh,
    workspace: BvhWorkspace,
}

impl BoxPairs for Tree {
    fn find(&mut self, boxes: &[Aabb], pairs: &mut Vec<(u32, u32)>) {
        pairs.clear();
        for (i, bounds) in boxes.iter().enumerate() {
            self.tree.insert_or_update_partially(to_parry(bounds), i as u32, 0.0);
        }
        self.tree.rebuild(&mut self.workspace, BvhBuildStrategy::Binned);
        for (i, bounds) in boxes.iter().enumerate() {
            self.ask(bounds, |j| {
                if i < j as usize {
                    pairs.push((i as u32, j));
                }
            });
        }
    }
}

impl Tree {
    /// One box has moved: its leaf is brought up to date and its neighbours are counted.
    pub fn renew_one(&mut self, i: usize, bounds: &Aabb) -> usize {
        self.tree.insert(to_parry(bounds), i as u32);
        let mut count = 0;
        self.ask(bounds, |_| count += 1);
        count
    }

    fn ask(&self, bounds: &Aabb, found: impl FnMut(u32)) {
        let touches =
            |(min, max): (Vector, Vector)| (0..3).all(|k| min[k] <= bounds.max[k] && bounds.min[k] <= max[k]);
        self.tree.leaves(|node| touches((node.mins(), node.maxs()))).for_each(found);
    }
}

fn to_parry(bounds: &Aabb) -> ParryAabb {
    let vector = |v: &ndda_mesh::Vec3| Vector::new(v.x, v.y, v.z);
    ParryAabb::new(vector(&bounds.min), vector(&bounds.max))
}

fn bounds_of(boxes: &[Aabb]) -> ndda_mesh::Vec3 {
    let scene = Aabb::around(boxes.iter().flat_map(|b| [&b.min, &b.max]));
    scene.max - scene.min
}

fn in_order(i: u32, j: u32) -> (u32, u32) {
    (i.min(j), i.max(j))
}
