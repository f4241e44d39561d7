//! Symbolic factorisation: supernodes, merged further while that makes the solve quicker.

use super::dissection::dissect;
use super::graph::{Compressed, Graph};

/// Cost of a solve for one supernode, in entries of L read from memory: the relaxation is tuned by these.
#[derive(Clone, Copy, Debug)]
struct Cost;

impl Cost {
    /// For each row: an index, a number gathered and one scattered.
    const ROW: f64 = 4.0;
    /// For each supernode: loops that begin and end.
    const SUPERNODE: f64 = 80.0;
    /// Rows that are taken together.
    const TILE: f64 = 8.0;

    /// Of `width` columns over `below` rows.
    fn of(width: f64, below: f64) -> f64 {
        let padding = 0.5 * Self::TILE;
        let entries = width * (0.5 * width + padding + below + padding);
        entries + Self::ROW * (width + below) + Self::SUPERNODE
    }
}

/// Columns with one pattern.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Supernode {
    /// Its columns, in the order of the factor.
    pub columns: std::ops::Range<usize>,
    /// Rows below its columns, in the order of the factor, ascending.
    pub rows: Vec<u32>,
    /// Supernodes that update it, ascending.
    pub children: Vec<u32>,
}

/// The pattern of the factor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Symbolic {
    /// Unknown of each row of the factor.
    pub unknown: Vec<u32>,
    /// Supernodes, children before parents and those of one parent together.
    pub supernodes: Vec<Supernode>,
}

/// A supernode in the making, over vertices.
#[derive(Clone, Debug, Default)]
struct Front {
    columns: Vec<u32>,
    rows: Vec<u32>,
    children: Vec<u32>,
    /// Unknowns in its columns and rows.
    width: u32,
    below: u32,
    merged: bool,
}

impl Symbolic {
    /// Orders the unknowns and finds the supernodes.
    pub(super) fn new(compressed: &Compressed) -> Self {
        let order = dissect(&compressed.graph);
        let mut fronts = fundamental(&compressed.graph, &order);
        relax(&mut fronts);
        number(compressed, fronts)
    }
}

/// Fronts of vertices with nested patterns, front v being the one that ends with v-th vertex, if not merged.
fn fundamental(graph: &Graph, order: &[u32]) -> Vec<Front> {
    let n = order.len();
    let mut position = vec![0u32; n];
    (0..).zip(order).for_each(|(k, &v)| position[v as usize] = k);
    let weight = |vertices: &[u32]| -> u32 { vertices.iter().map(|&v| graph.weight[v as usize]).sum() };
    let mut fronts: Vec<Front> = Vec::with_capacity(n);
    let mut waiting: Vec<Vec<u32>> = vec![Vec::new(); n];
    let mut seen = vec![u32::MAX; n];
    for (k, &v) in (0u32..).zip(order) {
        let children = std::mem::take(&mut waiting[k as usize]);
        seen[v as usize] = k;
        let mut rows: Vec<u32> = Vec::new();
        let later = graph.of(v).iter().filter(|&&u| position[u as usize] > k);
        for &u in later.chain(children.iter().flat_map(|&c| &fronts[c as usize].rows)) {
            if std::mem::replace(&mut seen[u as usize], k) != k {
                rows.push(u);
            }
        }
        let mut front = Front {
            columns: vec![v],
            width: weight(&[v]),
            below: weight(&rows),
            rows,
            children,
            merged: false,
        };
        // The child with the same rows, if there is one, is the same supernode.
        let own = front.width + front.below;
        if let Some(at) = front.children.iter().position(|&c| fronts[c as usize].below == own) {
            front.absorb(&mut fronts, at);
        }
        if let Some(parent) = front.rows.iter().map(|&u| position[u as usize]).min() {
            waiting[parent as usize].push(k);
        }
        fronts.push(front);
    }
    fronts
}

impl Front {
    /// Takes over the columns and the children of the child at this place.
    fn absorb(&mut self, fronts: &mut [Front], at: usize) {
        let child = &mut fronts[self.children.swap_remove(at) as usize];
        child.merged = true;
        child.rows = Vec::new();
        self.children.append(&mut child.children);
        let own = std::mem::replace(&mut self.columns, std::mem::take(&mut child.columns));
        self.columns.extend(own);
        self.width += child.width;
    }

    /// Gain of the solve if this front takes over `child`.
    fn gain(&self, child: &Front) -> f64 {
        let [wide, below] = [self.width, self.below].map(f64::from);
        let [child_wide, child_below] = [child.width, child.below].map(f64::from);
        Cost::of(child_wide, child_below) + Cost::of(wide, below) - Cost::of(wide + child_wide, below)
    }
}

/// Merges fronts into their parents, best first, while the solve gains.
fn relax(fronts: &mut [Front]) {
    for p in 0..fronts.len() {
        if fronts[p].merged {
            continue;
        }
        let mut front = std::mem::take(&mut fronts[p]);
        loop {
            let mut candidates: Vec<(f64, u32)> =
                front.children.iter().map(|&c| (front.gain(&fronts[c as usize]), c)).collect();
            candidates.retain(|&(gain, _)| gain > 0.0);
            candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let mut any = false;
            for (_, child) in candidates {
                if front.gain(&fronts[child as usize]) > 0.0 {
                    let at = front.children.iter().position(|&c| c == child).expect("a child");
                    front.absorb(fronts, at);
                    any = true;
                }
            }
            if !any {
                break;
            }
        }
        front.children.sort_unstable();
        fronts[p] = front;
    }
}

/// Fronts from the leaves up, each right after its children.
fn postorder(fronts: &[Front]) -> Vec<u32> {
    let mut has_parent = vec![false; fronts.len()];
    let alive = || fronts.iter().filter(|front| !front.merged);
    alive().flat_map(|front| &front.children).for_each(|&c| has_parent[c as usize] = true);
    let is_root = |&f: &u32| !fronts[f as usize].merged && !has_parent[f as usize];
    let mut stack: Vec<(u32, bool)> =
        (0..fronts.len() as u32).rev().filter(is_root).map(|f| (f, false)).collect();
    let mut order = Vec::new();
    while let Some((f, children_done)) = stack.pop() {
        if children_done {
            order.push(f);
        } else {
            stack.push((f, true));
            stack.extend(fronts[f as usize].children.iter().rev().map(|&c| (c, false)));
        }
    }
    order
}

fn number(compressed: &Compressed, mut fronts: Vec<Front>) -> Symbolic {
    let order = postorder(&fronts);
    let mut first_row = vec![0u32; compressed.graph.len()];
    let (mut unknown, mut columns) = (Vec::new(), Vec::new());
    let mut place = vec![0u32; fronts.len()];
    for (k, &f) in (0..).zip(&order) {
        let start = unknown.len();
        place[f as usize] = k;
        for &v in &fronts[f as usize].columns {
            first_row[v as usize] = unknown.len() as u32;
            unknown.extend(&compressed.unknowns[v as usize]);
        }
        columns.push(start..unknown.len());
    }
    let supernode = |(&f, columns): (&u32, std::ops::Range<usize>)| {
        let mut front = std::mem::take(&mut fronts[f as usize]);
        front.rows.sort_unstable_by_key(|&v| first_row[v as usize]);
        let expand =
            |&v: &u32| first_row[v as usize]..first_row[v as usize] + compressed.graph.weight[v as usize];
        let mut children: Vec<u32> = front.children.iter().map(|&c| place[c as usize]).collect();
        children.sort_unstable();
        Supernode { columns, rows: front.rows.iter().flat_map(expand).collect(), children }
    };
    let supernodes = order.iter().zip(columns).map(supernode).collect();
    Symbolic { unknown, supernodes }
}
