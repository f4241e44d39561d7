//! How contact forces change as blocks move: what an implicit step iterates with.

use ndda_mesh::{Mat3, NodeId, Vec3};

/// ∂f/∂x between the seven nodes of a pair: a triangle's three, then a tetrahedron's four.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairStiffness {
    /// The nodes.
    pub nodes: [NodeId; 7],
    /// ∂f_p/∂x_q [N/m].
    pub block: [[Mat3; 7]; 7],
}

impl PairStiffness {
    /// No stiffness between these nodes.
    pub fn new(triangle: &[NodeId; 3], tet: &[NodeId; 4]) -> Self {
        let ([a, b, c], [d, e, f, g]) = (*triangle, *tet);
        Self { nodes: [a, b, c, d, e, f, g], block: [[Mat3::zeros(); 7]; 7] }
    }

    /// Adds −K w_p w_q, a spring of stiffness K along Σ w_p x_p.
    pub fn add_spring(&mut self, weights: &[f64; 7], stiffness: &Mat3) {
        for (row, w_p) in self.block.iter_mut().zip(weights) {
            for (block, w_q) in row.iter_mut().zip(weights) {
                *block -= *w_p * *w_q * stiffness;
            }
        }
    }

    /// out ← out + (∂f/∂x) u.
    pub fn add_times(&self, u: &[Vec3], out: &mut [Vec3]) {
        for (row, p) in self.block.iter().zip(self.nodes) {
            for (k, q) in row.iter().zip(self.nodes) {
                out[p.index()] += k * u[q.index()];
            }
        }
    }
}
