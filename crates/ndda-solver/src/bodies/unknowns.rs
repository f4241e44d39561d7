//! Unknowns of a block: components of its nodes, or the few motions that it may make.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use ndda_fem::{BlockOperator, BlockSupports};
use ndda_mesh::{Mat3, Vec3};

use crate::integrators::time_integrator::StepWeights;
use crate::linear::linear_solver::SymmetricMatrix;

/// Motions held with less than this part of the stiffness of the best held one are free.
const HELD: f64 = 1e-12;

/// The unknowns of a block, and how its nodes move with them.
#[derive(Clone, Debug)]
pub enum Unknowns {
    /// Free components of nodes; a held direction has no unknown.
    Nodal {
        /// First unknown of each node (`nodes + 1` values).
        start: Vec<u32>,
        /// Directions of the unknowns.
        direction: Vec<Vec3>,
    },
    /// Free components of groups of nodes that move alike.
    Tied {
        /// Group of each node.
        group: Vec<u32>,
        /// First unknown of each group (`groups + 1` values).
        start: Vec<u32>,
        /// Directions of the unknowns.
        direction: Vec<Vec3>,
    },
    /// Amplitudes of motions.
    Modes {
        /// How many.
        modes: usize,
        /// Displacement of each node by each motion, node by node [m].
        shape: Vec<Vec3>,
    },
}

impl Unknowns {
    /// The free components of a block.
    pub fn nodal(nodes: usize, supports: &BlockSupports) -> Self {
        if !supports.ties.is_empty() {
            return Self::tied(nodes, supports);
        }
        let (mut start, mut direction) = (vec![0], Vec::with_capacity(3 * nodes));
        let mut held = supports.held.iter().peekable();
        for node in 0..nodes as u32 {
            match held.next_if(|h| h.node == node) {
                Some(h) => direction.extend(&h.free),
                None => direction.extend([Vec3::x(), Vec3::y(), Vec3::z()]),
            }
            start.push(direction.len() as u32);
        }
        Self::Nodal { start, direction }
    }

    /// The free components of a block with tied nodes: groups are numbered by their first nodes.
    fn tied(nodes: usize, supports: &BlockSupports) -> Self {
        let mut first: Vec<u32> = (0..nodes as u32).collect();
        for group in &supports.ties {
            group.iter().for_each(|&node| first[node as usize] = group[0]);
        }
        let (mut group, mut start, mut direction) = (vec![0; nodes], vec![0], Vec::new());
        for node in 0..nodes as u32 {
            if first[node as usize] != node {
                group[node as usize] = group[first[node as usize] as usize];
                continue;
            }
            group[node as usize] = start.len() as u32 - 1;
            match supports.held.binary_search_by_key(&node, |held| held.node) {
                Ok(held) => direction.extend(&supports.held[held].free),
                Err(_) => direction.extend([Vec3::x(), Vec3::y(), Vec3::z()]),
            }
            start.push(direction.len() as u32);
        }
        Self::Tied { group, start, direction }
    }

    /// Affine motions, u = a + A X (Shi 1988): those of twelve that the supports leave.
    pub(crate) fn affine(operator: &BlockOperator, supports: &BlockSupports) -> Self {
        let size = operator.rest.iter().map(|x| x.norm()).fold(0.0, f64::max);
        // Motion 4 i + j moves along axis i, by 1 or in proportion to the j-th coordinate.
        let factors = |node: usize| {
            let x = operator.rest[node] / size;
            [1.0, x.x, x.y, x.z]
        };
        let mut stiffness = DMatrix::<f64>::zeros(12, 12);
        for held in &supports.held {
            let f = factors(held.node as usize);
            for n in &held.held {
                let row = DVector::from_fn(12, |k, _| n[k / 4] * f[k % 4]);
                stiffness += &row * row.transpose();
            }
        }
        let eigen = SymmetricEigen::new(stiffness);
        let most = eigen.eigenvalues.max();
        let free: Vec<usize> = (0..12).filter(|&k| eigen.eigenvalues[k] <= HELD * most).collect();
        let mut shape = Vec::with_capacity(operator.nodes() * free.len());
        for node in 0..operator.nodes() {
            let f = factors(node);
            for &k in &free {
                let q = eigen.eigenvectors.column(k);
                shape.push(Vec3::from_fn(|i, _| (0..4).map(|j| q[4 * i + j] * f[j]).sum()));
            }
        }
        Self::Modes { modes: free.len(), shape }
    }

    /// No unknowns.
    pub(crate) fn none() -> Self {
        Self::Modes { modes: 0, shape: Vec::new() }
    }

    /// Number of unknowns.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Nodal { direction, .. } | Self::Tied { direction, .. } => direction.len(),
            Self::Modes { modes, .. } => *modes,
        }
    }

    /// Whether nothing is left to solve for.
    pub(crate) fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Projects nodal forces onto the unknowns.
    pub(crate) fn gather(&self, nodal: &[Vec3], out: &mut [f64]) {
        match self {
            Self::Nodal { .. } if out.len() == 3 * nodal.len() => {
                for (three, v) in out.chunks_exact_mut(3).zip(nodal) {
                    three.copy_from_slice(v.as_slice());
                }
            }
            Self::Nodal { start, direction } => {
                for (v, ends) in nodal.iter().zip(start.windows(2)) {
                    for k in ends[0] as usize..ends[1] as usize {
                        out[k] = v.dot(&direction[k]);
                    }
                }
            }
            Self::Tied { group, start, direction } => {
                out.fill(0.0);
                for (v, &group) in nodal.iter().zip(group) {
                    for k in start[group as usize] as usize..start[group as usize + 1] as usize {
                        out[k] += v.dot(&direction[k]);
                    }
                }
            }
            Self::Modes { modes, shape } if *modes > 0 => {
                out.fill(0.0);
                for (v, moves) in nodal.iter().zip(shape.chunks_exact(*modes)) {
                    out.iter_mut().zip(moves).for_each(|(q, u)| *q += u.dot(v));
                }
            }
            Self::Modes { .. } => {}
        }
    }

    /// Adds the motion of the unknowns to nodal vectors.
    pub(crate) fn scatter(&self, unknowns: &[f64], nodal: &mut [Vec3]) {
        match self {
            Self::Nodal { .. } if unknowns.len() == 3 * nodal.len() => {
                for (three, v) in unknowns.chunks_exact(3).zip(nodal) {
                    *v += Vec3::new(three[0], three[1], three[2]);
                }
            }
            Self::Nodal { start, direction } => {
                for (v, ends) in nodal.iter_mut().zip(start.windows(2)) {
                    for k in ends[0] as usize..ends[1] as usize {
                        *v += unknowns[k] * direction[k];
                    }
                }
            }
            Self::Tied { group, start, direction } => {
                for (v, &group) in nodal.iter_mut().zip(group) {
                    for k in start[group as usize] as usize..start[group as usize + 1] as usize {
                        *v += unknowns[k] * direction[k];
                    }
                }
            }
            Self::Modes { modes, shape } if *modes > 0 => {
                for (v, moves) in nodal.iter_mut().zip(shape.chunks_exact(*modes)) {
                    *v += unknowns.iter().zip(moves).map(|(q, u)| *q * u).sum::<Vec3>();
                }
            }
            Self::Modes { .. } => {}
        }
    }

    /// The nearest field that the unknowns can make, by node masses.
    pub(crate) fn restrict(&self, node_mass: &[f64], field: &mut [Vec3]) {
        let Self::Modes { modes, shape } = self else { return };
        let rows = || node_mass.iter().zip(shape.chunks_exact((*modes).max(1)));
        let gram = DMatrix::from_fn(*modes, *modes, |i, j| {
            rows().map(|(&m, moves)| m * moves[i].dot(&moves[j])).sum::<f64>()
        });
        let side = DVector::from_fn(*modes, |i, _| {
            rows().zip(&*field).map(|((&m, moves), v)| m * moves[i].dot(v)).sum::<f64>()
        });
        field.fill(Vec3::zeros());
        if let Some(amplitudes) = gram.cholesky().map(|g| g.solve(&side)) {
            self.scatter(amplitudes.as_slice(), field);
        }
    }

    /// K̃ = θ (K + S) + c M + d K + Q over the unknowns (eq 12), S being the springs, d = b/Δt damping in proportion to stiffness, and Q what quiet
    /// faces add.
    pub fn matrix(
        &self,
        operator: &BlockOperator,
        supports: &BlockSupports,
        weights: &StepWeights,
        damping: f64,
    ) -> SymmetricMatrix {
        let (on_stiffness, on_mass) = (weights.stiffness + damping, weights.mass_per_s2);
        let mut springs = vec![Mat3::zeros(); operator.nodes()];
        for spring in &supports.springs {
            let projector = spring.along.map_or(Mat3::identity(), |n| n * n.transpose());
            springs[spring.node as usize] += weights.stiffness * spring.stiffness_n_m * projector;
        }
        for dashpot in &supports.quiet.dashpots {
            springs[dashpot.node as usize] += weights.drag_per_m() * dashpot.drag;
        }
        let row = |node: usize| {
            let springs = &springs;
            operator.row(node).map(move |(other, stiffness, mass)| {
                let mut block = on_stiffness * stiffness + Mat3::from_diagonal_element(on_mass * mass);
                if other == node {
                    block += springs[node];
                }
                (other, block)
            })
        };
        match self {
            Self::Nodal { start, direction } => nodal_matrix(start, direction, row),
            Self::Tied { group, start, direction } => tied_matrix(group, start, direction, row),
            Self::Modes { modes, shape } => modal_matrix(*modes, shape, row),
        }
    }
}

/// The matrix between free components; `row` gives the blocks of a node.
fn nodal_matrix<I: Iterator<Item = (usize, Mat3)>>(
    start: &[u32],
    direction: &[Vec3],
    row: impl Fn(usize) -> I,
) -> SymmetricMatrix {
    let of = |node: usize| start[node] as usize..start[node + 1] as usize;
    let node_of: Vec<u32> = (0..start.len() - 1).flat_map(|n| of(n).map(move |_| n as u32)).collect();
    SymmetricMatrix::from_lower(direction.len(), |j, out| {
        for (other, block) in row(node_of[j] as usize) {
            // Row `node` of K gives column j of the lower triangle by symmetry.
            let along_other = block.transpose() * direction[j];
            out.extend(of(other).filter(|&i| i >= j).map(|i| (i, direction[i].dot(&along_other))));
        }
    })
}

/// The matrix between free components of groups: rows of all nodes of a group, and their columns by groups, add up.
fn tied_matrix<I: Iterator<Item = (usize, Mat3)>>(
    group: &[u32],
    start: &[u32],
    direction: &[Vec3],
    row: impl Fn(usize) -> I,
) -> SymmetricMatrix {
    let of = |group: u32| start[group as usize] as usize..start[group as usize + 1] as usize;
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); start.len() - 1];
    group.iter().enumerate().for_each(|(node, &group)| members[group as usize].push(node));
    let group_of: Vec<u32> =
        (0..start.len() as u32 - 1).flat_map(|group| of(group).map(move |_| group)).collect();
    SymmetricMatrix::from_lower(direction.len(), |j, out| {
        let mut column = std::collections::BTreeMap::new();
        for &node in &members[group_of[j] as usize] {
            for (other, block) in row(node) {
                let along_other = block.transpose() * direction[j];
                for i in of(group[other]).filter(|&i| i >= j) {
                    *column.entry(i).or_insert(0.0) += direction[i].dot(&along_other);
                }
            }
        }
        out.extend(column);
    })
}

/// The matrix between motions, PᵀK̃P.
fn modal_matrix<I: Iterator<Item = (usize, Mat3)>>(
    modes: usize,
    shape: &[Vec3],
    row: impl Fn(usize) -> I,
) -> SymmetricMatrix {
    let nodes = shape.len() / modes.max(1);
    SymmetricMatrix::from_lower(modes, |j, out| {
        let mut column = vec![0.0; modes];
        for node in 0..nodes {
            let mut force = Vec3::zeros();
            for (other, block) in row(node) {
                force += block * shape[other * modes + j];
            }
            let moves = &shape[node * modes..(node + 1) * modes];
            column.iter_mut().zip(moves).for_each(|(sum, u)| *sum += u.dot(&force));
        }
        out.extend((j..modes).map(|i| (i, column[i])));
    })
}
