//! Which components of a block's nodes are unknowns.

use ndda_fem::{BlockOperator, BlockSupports};
use ndda_mesh::{Mat3, Vec3};

use crate::linear_solver::SymmetricMatrix;
use crate::time_integrator::{StepDamping, StepWeights};

/// Numbering of the free components of a block; a held direction has no unknown.
#[derive(Clone, Debug)]
pub struct Unknowns {
    /// First unknown of each node (`nodes + 1` values).
    start: Vec<u32>,
    /// Directions of the unknowns.
    direction: Vec<Vec3>,
}

impl Unknowns {
    /// Numbers the free components of a block.
    pub fn new(nodes: usize, supports: &BlockSupports) -> Self {
        let mut numbering = Self { start: vec![0], direction: Vec::with_capacity(3 * nodes) };
        let mut held = supports.held.iter().peekable();
        for node in 0..nodes as u32 {
            match held.next_if(|h| h.node == node) {
                Some(h) => numbering.direction.extend(&h.free),
                None => numbering.direction.extend([Vec3::x(), Vec3::y(), Vec3::z()]),
            }
            numbering.start.push(numbering.direction.len() as u32);
        }
        numbering
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.direction.len()
    }

    /// Whether nothing is left to solve for.
    pub fn is_empty(&self) -> bool {
        self.direction.is_empty()
    }

    fn of(&self, node: usize) -> std::ops::Range<usize> {
        self.start[node] as usize..self.start[node + 1] as usize
    }

    /// Components of nodal vectors along the unknowns.
    pub fn gather(&self, nodal: &[Vec3], out: &mut [f64]) {
        if out.len() == 3 * nodal.len() {
            for (three, v) in out.chunks_exact_mut(3).zip(nodal) {
                three.copy_from_slice(v.as_slice());
            }
            return;
        }
        for (node, v) in nodal.iter().enumerate() {
            for k in self.of(node) {
                out[k] = v.dot(&self.direction[k]);
            }
        }
    }

    /// Adds the unknowns to nodal vectors.
    pub fn scatter(&self, unknowns: &[f64], nodal: &mut [Vec3]) {
        if unknowns.len() == 3 * nodal.len() {
            for (three, v) in unknowns.chunks_exact(3).zip(nodal) {
                *v += Vec3::new(three[0], three[1], three[2]);
            }
            return;
        }
        for (node, v) in nodal.iter_mut().enumerate() {
            for k in self.of(node) {
                *v += unknowns[k] * self.direction[k];
            }
        }
    }

    /// K̃ = θ (K + S) + c M + C/Δt over the unknowns (eq 12), S being the springs and C the damping.
    pub fn matrix(
        &self,
        operator: &BlockOperator,
        supports: &BlockSupports,
        weights: &StepWeights,
        damping: &StepDamping,
    ) -> SymmetricMatrix {
        let (on_stiffness, on_mass) =
            (weights.stiffness + damping.stiffness, weights.mass_per_s2 + damping.mass_per_s2);
        let mut springs = vec![Mat3::zeros(); operator.nodes()];
        for spring in &supports.springs {
            let projector = spring.along.map_or(Mat3::identity(), |n| n * n.transpose());
            springs[spring.node as usize] += spring.stiffness_n_m * projector;
        }
        let node_of: Vec<u32> =
            (0..operator.nodes()).flat_map(|n| self.of(n).map(move |_| n as u32)).collect();
        SymmetricMatrix::from_lower(self.len(), |j, out| {
            let node = node_of[j] as usize;
            for (other, stiffness, mass) in operator.row(node) {
                let mut block = on_stiffness * stiffness + Mat3::from_diagonal_element(on_mass * mass);
                if other == node {
                    block += weights.stiffness * springs[node];
                }
                // Row `node` of K gives column j of the lower triangle by symmetry.
                let along_other = block.transpose() * self.direction[j];
                out.extend(
                    self.of(other).filter(|&i| i >= j).map(|i| (i, self.direction[i].dot(&along_other))),
                );
            }
        })
    }
}
