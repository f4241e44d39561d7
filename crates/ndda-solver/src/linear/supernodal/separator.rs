//! A small set of vertices that splits a graph in two: coarsened by matching, split, and refined on the way back
//! (Karypis & Kumar 1998; moves of Fiduccia & Mattheyses 1982 on the separator itself).

use std::collections::BinaryHeap;

use super::graph::Graph;

/// Vertices at which coarsening stops.
const COARSEST: usize = 80;
/// Splits of the coarsest graph that are tried.
const TRIALS: u64 = 6;
/// Most that one side may have of the whole.
const MOST_OF_WHOLE: f64 = 0.6;
/// Moves without a better separator after which a pass ends.
const PATIENCE: usize = 80;
/// Passes of refinement at each level.
const PASSES: usize = 8;
/// Label of the separator; 0 and 1 are the sides.
pub(super) const SEPARATOR: u8 = 2;

/// Labels of the vertices with the weights of the three parts.
#[derive(Clone, Debug)]
struct Split {
    label: Vec<u8>,
    weight: [i64; 3],
}

/// A side (0 or 1) or [`SEPARATOR`] for each vertex, the best of `attempts`; the sides have no edge between them.
pub(super) fn separate(graph: &Graph, attempts: u64) -> Vec<u8> {
    let splits = (0..attempts.max(1)).map(|seed| multilevel(graph, seed));
    splits.min_by_key(Split::cost).map(|split| split.label).unwrap_or_default()
}

fn multilevel(graph: &Graph, seed: u64) -> Split {
    if graph.len() > COARSEST {
        let (coarse, parent) = coarsen(graph, seed);
        if coarse.len() * 20 < graph.len() * 19 {
            let above = multilevel(&coarse, seed);
            let label = parent.iter().map(|&p| above.label[p as usize]).collect();
            let mut split = Split { label, weight: above.weight };
            split.refine(graph);
            return split;
        }
    }
    let grown = (0..TRIALS).map(|trial| {
        let mut split = grow(graph, seed * TRIALS + trial);
        split.refine(graph);
        split
    });
    grown.min_by_key(Split::cost).expect("at least one trial")
}

/// A number in 0..n that looks random (Steele, Lea & Flood 2014).
fn scatter(n: usize, seed: u64) -> usize {
    let mut z = seed.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) % n as u64) as usize
}

/// Merges each vertex with the neighbour of the heaviest edge that is still free; returns who went where.
fn coarsen(graph: &Graph, seed: u64) -> (Graph, Vec<u32>) {
    let n = graph.len();
    let mut order: Vec<u32> = (0..n as u32).collect();
    (1..n).rev().for_each(|i| order.swap(i, scatter(i + 1, seed ^ (i as u64) << 20)));
    let (mut parent, mut members) = (vec![u32::MAX; n], Vec::new());
    for v in order {
        if parent[v as usize] != u32::MAX {
            continue;
        }
        let free = graph.edges(v).filter(|&(u, _)| parent[u as usize] == u32::MAX && u != v);
        let mate = free.max_by_key(|&(u, edge)| (edge, std::cmp::Reverse(graph.weight[u as usize])));
        let id = members.len() as u32;
        let pair = [v, mate.map_or(v, |(u, _)| u)];
        pair.iter().for_each(|&u| parent[u as usize] = id);
        members.push(pair);
    }
    (contract(graph, &parent, &members), parent)
}

fn contract(graph: &Graph, parent: &[u32], members: &[[u32; 2]]) -> Graph {
    let mut coarse = Graph { start: vec![0], ..Graph::default() };
    let mut place = vec![usize::MAX; members.len()];
    for (id, &[a, b]) in (0..).zip(members) {
        let first = coarse.neighbour.len();
        for v in [a, b].into_iter().take(if a == b { 1 } else { 2 }) {
            for (u, edge) in graph.edges(v) {
                let other = parent[u as usize];
                let k = place[other as usize];
                if other == id {
                } else if k != usize::MAX && k >= first {
                    coarse.edge[k] += edge;
                } else {
                    place[other as usize] = coarse.neighbour.len();
                    coarse.neighbour.push(other);
                    coarse.edge.push(edge);
                }
            }
        }
        let second = if a == b { 0 } else { graph.weight[b as usize] };
        coarse.weight.push(graph.weight[a as usize] + second);
        coarse.start.push(coarse.neighbour.len());
    }
    coarse
}

/// Half of the graph, in breadth from one vertex; the rim of it is the separator.
fn grow(graph: &Graph, seed: u64) -> Split {
    let n = graph.len();
    let half = graph.weight.iter().map(|&w| i64::from(w)).sum::<i64>() / 2;
    let mut split = Split { label: vec![1; n], weight: [0, 2 * half, 0] };
    let (mut queue, mut head, mut seen) = (vec![scatter(n, seed) as u32], 0, vec![false; n]);
    seen[queue[0] as usize] = true;
    let mut next_start = 0;
    while split.weight[0] < half {
        if head == queue.len() {
            while seen[next_start] {
                next_start += 1;
            }
            seen[next_start] = true;
            queue.push(next_start as u32);
        }
        let v = queue[head];
        head += 1;
        split.label[v as usize] = 0;
        split.weight[0] += i64::from(graph.weight[v as usize]);
        for &u in graph.of(v) {
            if !std::mem::replace(&mut seen[u as usize], true) {
                queue.push(u);
            }
        }
    }
    for v in 0..n as u32 {
        if split.label[v as usize] == 0 && graph.of(v).iter().any(|&u| split.label[u as usize] == 1) {
            split.label[v as usize] = SEPARATOR;
        }
    }
    split.weigh(graph);
    split
}

impl Split {
    fn weigh(&mut self, graph: &Graph) {
        self.weight = [0; 3];
        self.label.iter().zip(&graph.weight).for_each(|(&l, &w)| self.weight[l as usize] += i64::from(w));
    }

    /// Objective to minimise: the separator, dearer the less the sides are balanced; first that no side is too large.
    fn cost(&self) -> (i64, i64) {
        let [a, b, separator] = self.weight;
        let over = a.max(b) - (MOST_OF_WHOLE * (a + b + separator) as f64).ceil() as i64;
        let uneven = (a - b).abs() as f64 / (a + b).max(1) as f64;
        // In sixteenths, as weights are small integers.
        (over.max(0), (16.0 * separator as f64 * (1.0 + 0.5 * uneven)) as i64)
    }

    /// Weight that the separator loses when `v` leaves it for `side`.
    fn gain(&self, graph: &Graph, v: u32, side: u8) -> i64 {
        let pulled = graph.of(v).iter().filter(|&&u| self.label[u as usize] == 1 - side);
        i64::from(graph.weight[v as usize])
            - pulled.map(|&u| i64::from(graph.weight[u as usize])).sum::<i64>()
    }

    fn set(&mut self, graph: &Graph, v: u32, label: u8) {
        let (old, weight) = (self.label[v as usize], i64::from(graph.weight[v as usize]));
        self.weight[old as usize] -= weight;
        self.weight[label as usize] += weight;
        self.label[v as usize] = label;
    }

    fn refine(&mut self, graph: &Graph) {
        for _ in 0..PASSES {
            let before = self.cost();
            self.pass(graph);
            if self.cost() >= before {
                return;
            }
        }
    }

    /// Moves vertices out of the separator, best first and each once, also for worse; keeps the best that was seen.
    fn pass(&mut self, graph: &Graph) {
        let n = graph.len();
        let most = (MOST_OF_WHOLE * self.weight.iter().sum::<i64>() as f64).ceil() as i64;
        let mut heap = BinaryHeap::new();
        for v in (0..n as u32).filter(|&v| self.label[v as usize] == SEPARATOR) {
            (0..2).for_each(|side| heap.push((self.gain(graph, v, side), v, side)));
        }
        let (mut moved, mut journal, mut best, mut kept) = (vec![false; n], Vec::new(), self.cost(), 0);
        let mut patience = PATIENCE;
        while let Some((gain, v, side)) = heap.pop().filter(|_| patience > 0) {
            let stale = self.label[v as usize] != SEPARATOR || moved[v as usize];
            let other = self.weight[1 - side as usize];
            let reached = self.weight[side as usize] + i64::from(graph.weight[v as usize]);
            if stale || reached > most.max(other) || gain != self.gain(graph, v, side) {
                continue;
            }
            moved[v as usize] = true;
            self.shift(graph, v, side, &mut journal, &moved, &mut heap);
            patience -= 1;
            if self.cost() < best {
                (best, kept, patience) = (self.cost(), journal.len(), PATIENCE);
            }
        }
        for &(v, old) in journal[kept..].iter().rev() {
            self.set(graph, v, old);
        }
    }

    /// Moves `v` to `side` and the neighbours that it had on the other one into the separator.
    fn shift(
        &mut self,
        graph: &Graph,
        v: u32,
        side: u8,
        journal: &mut Vec<(u32, u8)>,
        moved: &[bool],
        heap: &mut BinaryHeap<(i64, u32, u8)>,
    ) {
        journal.push((v, SEPARATOR));
        self.set(graph, v, side);
        let mut touched = Vec::new();
        for &u in graph.of(v) {
            if self.label[u as usize] == 1 - side {
                journal.push((u, 1 - side));
                self.set(graph, u, SEPARATOR);
                touched.push(u);
                touched.extend(graph.of(u));
            } else {
                touched.push(u);
            }
        }
        touched.sort_unstable();
        touched.dedup();
        for u in touched.into_iter().filter(|&u| self.label[u as usize] == SEPARATOR && !moved[u as usize]) {
            (0..2).for_each(|side| heap.push((self.gain(graph, u, side), u, side)));
        }
    }
}
