//! Tetrahedra that come and go, with the ones around each node at hand.

use super::Filled;
use crate::Vec3;
use crate::quality::least_sine;

/// A mesh under change. Dead tetrahedra are skipped and their slots used again.
pub(super) struct Pool {
    pub nodes: Vec<Vec3>,
    /// Faces of the block that each node lies on, sorted.
    pub on: Vec<Vec<u32>>,
    pub tets: Vec<[u32; 4]>,
    /// Smallest sine of a dihedral angle of each tetrahedron; −∞ for dead ones.
    pub sine: Vec<f64>,
    /// Tetrahedra around each node.
    pub around: Vec<Vec<u32>>,
    /// Unit normals of the block's faces.
    pub normals: Vec<Vec3>,
    free: Vec<u32>,
    /// Changes so far; the last one around each node; and how many there had been when each tetrahedron was last tried to
    /// flip and each node to move. What failed fails again unless something around it has changed.
    changes: u64,
    changed: Vec<u64>,
    flip_tried: Vec<u64>,
    move_tried: Vec<u64>,
}

/// The nodes around an edge, each followed by the next; closed unless the edge lies on the surface.
pub(super) struct Ring {
    pub nodes: Vec<u32>,
    pub is_closed: bool,
}

impl Pool {
    pub(crate) fn new(normals: Vec<Vec3>, filled: Filled) -> Self {
        let count = filled.nodes.len();
        let mut pool = Self {
            nodes: filled.nodes,
            on: filled.on,
            tets: Vec::new(),
            sine: Vec::new(),
            around: vec![Vec::new(); count],
            normals,
            free: Vec::new(),
            changes: 0,
            changed: vec![0; count],
            flip_tried: Vec::new(),
            move_tried: vec![0; count],
        };
        filled.tets.into_iter().for_each(|tet| pool.add(tet));
        pool
    }

    /// Live tetrahedra, and the nodes that they use.
    pub(crate) fn finish(self) -> Filled {
        let mut filled = Filled::default();
        let mut index = vec![u32::MAX; self.nodes.len()];
        for (node, around) in self.around.iter().enumerate() {
            if !around.is_empty() {
                index[node] = filled.nodes.len() as u32;
                filled.nodes.push(self.nodes[node]);
                filled.on.push(self.on[node].clone());
            }
        }
        let alive = (0..self.tets.len()).filter(|&t| self.is_alive(t as u32));
        filled.tets = alive.map(|t| self.tets[t].map(|n| index[n as usize])).collect();
        filled
    }

    pub(crate) fn is_alive(&self, tet: u32) -> bool {
        self.sine[tet as usize] > f64::NEG_INFINITY
    }

    /// Live tetrahedra.
    pub(crate) fn alive(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.tets.len() as u32).filter(|&tet| self.is_alive(tet))
    }

    /// Smallest sine of a dihedral angle; at most 0 if inverted.
    pub(crate) fn quality(&self, tet: [u32; 4]) -> f64 {
        least_sine(&tet.map(|n| self.nodes[n as usize]))
    }

    pub(crate) fn add(&mut self, tet: [u32; 4]) {
        let sine = self.quality(tet);
        let slot = self.free.pop().unwrap_or(self.tets.len() as u32);
        if slot as usize == self.tets.len() {
            self.tets.push(tet);
            self.sine.push(sine);
            self.flip_tried.push(0);
        } else {
            self.tets[slot as usize] = tet;
            self.sine[slot as usize] = sine;
        }
        tet.iter().for_each(|&n| self.around[n as usize].push(slot));
        self.mark(tet);
    }

    fn mark(&mut self, tet: [u32; 4]) {
        self.changes += 1;
        tet.iter().for_each(|&n| self.changed[n as usize] = self.changes);
    }

    /// Whether a flip of a tetrahedron has not been tried as things are; from now on it has.
    pub(crate) fn is_flip_due(&mut self, tet: u32) -> bool {
        let tried = std::mem::replace(&mut self.flip_tried[tet as usize], self.changes);
        self.tets[tet as usize].iter().any(|&n| self.changed[n as usize] > tried)
    }

    /// Whether a move of a node has not been tried as things are; from now on it has.
    pub(crate) fn is_move_due(&mut self, node: u32) -> bool {
        let tried = std::mem::replace(&mut self.move_tried[node as usize], self.changes);
        self.changed[node as usize] > tried
    }

    pub(crate) fn remove(&mut self, tet: u32) {
        for n in self.tets[tet as usize] {
            let around = &mut self.around[n as usize];
            if let Some(at) = around.iter().position(|&t| t == tet) {
                around.swap_remove(at);
            }
        }
        self.sine[tet as usize] = f64::NEG_INFINITY;
        self.free.push(tet);
        self.mark(self.tets[tet as usize]);
    }

    pub(crate) fn add_node(&mut self, at: Vec3, on: Vec<u32>) -> u32 {
        self.nodes.push(at);
        self.on.push(on);
        self.around.push(Vec::new());
        self.changed.push(0);
        self.move_tried.push(0);
        self.nodes.len() as u32 - 1
    }

    /// Moves a node and grades the tetrahedra around it anew.
    pub(crate) fn place(&mut self, node: u32, at: Vec3) {
        self.nodes[node as usize] = at;
        for i in 0..self.around[node as usize].len() {
            let tet = self.around[node as usize][i];
            self.sine[tet as usize] = self.quality(self.tets[tet as usize]);
            self.mark(self.tets[tet as usize]);
        }
    }

    /// Smallest quality around a node.
    pub(crate) fn worst_around(&self, node: u32) -> f64 {
        self.around[node as usize].iter().map(|&t| self.sine[t as usize]).fold(f64::INFINITY, f64::min)
    }

    /// Tetrahedra with the edge from `a` to `b`.
    pub(crate) fn at_edge(&self, a: u32, b: u32) -> Vec<u32> {
        let (a, b) =
            if self.around[a as usize].len() < self.around[b as usize].len() { (a, b) } else { (b, a) };
        self.around[a as usize].iter().copied().filter(|&t| self.tets[t as usize].contains(&b)).collect()
    }

    /// Faces of the block that two nodes share: where the edge between them lies, as the block is convex.
    pub(crate) fn shared(&self, a: u32, b: u32) -> Vec<u32> {
        let (a, b) = (&self.on[a as usize], &self.on[b as usize]);
        a.iter().copied().filter(|face| b.binary_search(face).is_ok()).collect()
    }

    /// The ring around the edge, counter-clockwise seen from `b`; `None` if the tetrahedra make no ring.
    pub(crate) fn ring(&self, a: u32, b: u32, tets: &[u32]) -> Option<Ring> {
        let mut links: Vec<(u32, u32)> =
            tets.iter().map(|&t| opposite(self.tets[t as usize], a, b)).collect();
        let is_closed = links.iter().all(|link| links.iter().any(|other| other.1 == link.0));
        let first =
            links.iter().position(|link| is_closed || !links.iter().any(|other| other.1 == link.0))?;
        let (start, mut at) = links.swap_remove(first);
        let mut nodes = vec![start];
        while !links.is_empty() {
            nodes.push(at);
            let next = links.iter().position(|link| link.0 == at)?;
            at = links.swap_remove(next).1;
        }
        if !is_closed {
            nodes.push(at);
        } else if at != start {
            return None;
        }
        Some(Ring { nodes, is_closed })
    }
}

/// The nodes c and d for which (a, b, c, d) is positive.
fn opposite(tet: [u32; 4], a: u32, b: u32) -> (u32, u32) {
    // Even permutations of (0, 1, 2, 3) by their first two.
    const EVEN: [[usize; 4]; 12] = [
        [0, 1, 2, 3],
        [0, 2, 3, 1],
        [0, 3, 1, 2],
        [1, 0, 3, 2],
        [1, 2, 0, 3],
        [1, 3, 2, 0],
        [2, 0, 1, 3],
        [2, 1, 3, 0],
        [2, 3, 0, 1],
        [3, 0, 2, 1],
        [3, 1, 0, 2],
        [3, 2, 1, 0],
    ];
    let place = |node: u32| tet.iter().position(|&n| n == node).unwrap_or(0);
    let (i, j) = (place(a), place(b));
    let order = EVEN.iter().find(|order| order[0] == i && order[1] == j).unwrap_or(&EVEN[0]);
    (tet[order[2]], tet[order[3]])
}
