//! Patches of blocks that deform: what nodes feel of their friction, and how the surface answers to it within the step.
//!
//! A patch acts on the nodes of a block by weights P, one column for each of (F₁, F₂, T/r), and slips by Pᵀ v. The solver says
//! where the nodes would be without friction, v̂, and how the block answers to forces, with inertia and elasticity as the step has them:
//! v = v̂ + Σ U f, U = A⁻¹ P. So a patch that sticks has no slip at the end of the step, a block as a whole or its surface alone
//! may be what it takes to stop.

use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};

use crate::friction::facet::FacetForce;
use crate::friction::patches::patch::ContactPatch;
use crate::friction::patches::{PatchScene, Place};
use crate::model::Deformation;

/// Share of a node in the force of one facet of a patch.
#[derive(Clone, Copy, Debug)]
struct Weight {
    /// Counted from the first of all blocks.
    node: u32,
    /// ∫ φ N dA over that of the patch.
    share: f64,
    /// Force for a unit of T/r [1].
    twist: Vec3,
}

/// Ranges of the weights and answers of one side of a patch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NodalSide {
    weights: [u32; 2],
    block: BlockId,
    /// First node of the block, nodes, and the first of its three columns of answers.
    first: u32,
    nodes: u32,
    column: u32,
}

/// Nodes of blocks that deform, and what their patches do to them.
#[derive(Default)]
pub(super) struct Nodal {
    weights: Vec<Weight>,
    /// Where among them the one of each node was put last.
    place_of: Vec<u32>,
    /// For each block that deforms and has coupled patches, one vector per node in each column: velocities at a time within the step [m/s], and U,
    /// three columns for each side of a patch [m/s per N in a whole step]. Forces on the nodes until the solver has answered to them.
    columns: Vec<Vec<Vec3>>,
    /// These blocks.
    blocks: Vec<BlockId>,
}

impl Nodal {
    /// Forgets the last step.
    pub(super) fn begin(&mut self, blocks: usize, nodes: usize) {
        self.weights.clear();
        self.blocks.clear();
        self.columns.resize_with(blocks, Vec::new);
        self.columns.iter_mut().for_each(Vec::clear);
        self.place_of.resize(nodes, 0);
    }

    /// A block with the forces of its contacts but for the friction of these patches, by runs of facets.
    pub(super) fn add_block<'a>(
        &mut self,
        block: BlockId,
        scene: &PatchScene,
        forces: &[FacetForce],
        runs: impl Iterator<Item = &'a [Place]>,
    ) {
        let nodes = scene.input.blocks.nodes_of(block);
        let column = &mut self.columns[block.index()];
        column.resize(nodes.len(), Vec3::zeros());
        for run in runs {
            for &(_, _, t) in run {
                let FacetForce { push, shear, .. } = forces[t as usize];
                let is_owner = scene.owner(t) == block;
                let force = if is_owner { push + shear } else { -(push + shear) };
                each_weight(scene, t, is_owner, |node, w| column[node - nodes.start] += w * force);
            }
        }
        self.blocks.push(block);
    }

    /// One side of a patch; the block has been [added](Self::add_block).
    pub(super) fn add_side(
        &mut self,
        block: BlockId,
        scene: &PatchScene,
        (patch, run): (&ContactPatch, &[Place]),
        (forces, own_m2): (&[FacetForce], &[Mat3]),
    ) -> NodalSide {
        let from = self.weights.len() as u32;
        for &(_, _, t) in run {
            let is_owner = scene.owner(t) == block;
            let arm = forces[t as usize].center - patch.center;
            let twist = patch.normal.cross(&arm) / patch.surface.radius_m;
            each_weight(scene, t, is_owner, |node, w| {
                let share = w / patch.pressure;
                let weight = Weight { node: node as u32, share, twist: share * twist };
                add_weight(&mut self.weights, &mut self.place_of, from, weight);
            });
            let (pressure, own_m2) = (scene.sums(t).pressure, own_m2[t as usize].trace());
            if pressure > 0.0 {
                let couple = pressure / patch.pressure * own_m2 / patch.surface.radius_m * patch.normal;
                scene.couples().each_force(scene.touch(t), is_owner, &couple, |node, force| {
                    let weight = Weight { node: node as u32, share: 0.0, twist: force };
                    add_weight(&mut self.weights, &mut self.place_of, from, weight);
                });
            }
        }
        let nodes = scene.input.blocks.nodes_of(block);
        let columns = &mut self.columns[block.index()];
        let side = NodalSide {
            weights: [from, self.weights.len() as u32],
            block,
            first: nodes.start as u32,
            nodes: nodes.len() as u32,
            column: (columns.len() / nodes.len()) as u32,
        };
        columns.resize(columns.len() + 3 * nodes.len(), Vec3::zeros());
        for k in 0..3 {
            let force = &mut columns[side.column(k)];
            for weight in &self.weights[side.range()] {
                force[weight.node as usize - nodes.start] += weight.column(&patch.axes, k);
            }
        }
        side
    }

    /// Lets the solver answer for all blocks: velocities and U in place of forces.
    pub(super) fn answer(&mut self, deformation: &dyn Deformation) {
        deformation.answer(&mut self.columns);
    }

    /// Pᵀ v.
    pub(super) fn slip(&self, side: &NodalSide, axes: &[Vec3; 3]) -> Vec3 {
        let (mut shift, mut twist) = (Vec3::zeros(), 0.0);
        let velocity = &self.columns[side.block.index()];
        for weight in &self.weights[side.range()] {
            let v = &velocity[(weight.node - side.first) as usize];
            shift += weight.share * v;
            twist += weight.twist.dot(v);
        }
        Vec3::new(axes[0].dot(&shift), axes[1].dot(&shift), twist)
    }

    /// Pᵀ U.
    pub(super) fn flexibility(&self, side: &NodalSide, axes: &[Vec3; 3]) -> Mat3 {
        let mut found = Mat3::zeros();
        for (l, mut column) in found.column_iter_mut().enumerate() {
            let answers = &self.columns[side.block.index()][side.column(l)];
            for weight in &self.weights[side.range()] {
                let u = &answers[(weight.node - side.first) as usize];
                for k in 0..3 {
                    column[k] += weight.column(axes, k).dot(u);
                }
            }
        }
        0.5 * (found + found.transpose())
    }

    /// v ← v + s U f.
    pub(super) fn push(&mut self, side: &NodalSide, force: &Vec3, part: f64) {
        side.push(&mut self.columns[side.block.index()], force, part);
    }

    /// The columns of all blocks.
    pub(super) fn columns_mut(&mut self) -> &mut [Vec<Vec3>] {
        &mut self.columns
    }

    /// Does something with the velocities of each block that deforms.
    pub(super) fn each_velocity(&mut self, all: &BlockSet, mut work: impl FnMut(&mut [Vec3])) {
        for &block in &self.blocks {
            work(&mut self.columns[block.index()][..all.nodes_of(block).len()]);
        }
    }

    /// Velocities from those at the start of the step and now.
    pub(super) fn change(&mut self, all: &BlockSet, start: &[Vec3], change: impl Fn(Vec3, Vec3) -> Vec3) {
        for &block in &self.blocks {
            let velocity = &mut self.columns[block.index()];
            for (v, from) in velocity.iter_mut().zip(&start[all.nodes_of(block)]) {
                *v = change(*from, *v);
            }
        }
    }
}

impl NodalSide {
    /// Adds what a force changes the velocities of its block by, the first of the columns.
    pub(super) fn push(&self, columns: &mut [Vec3], force: &Vec3, part: f64) {
        let nodes = self.nodes as usize;
        let (velocity, answers) = columns.split_at_mut(nodes);
        let start = self.column(0).start - nodes;
        let (first, rest) = answers[start..start + 3 * nodes].split_at(nodes);
        let (second, third) = rest.split_at(nodes);
        let force = part * force;
        for (((v, a), b), c) in velocity.iter_mut().zip(first).zip(second).zip(third) {
            *v += force.x * a + force.y * b + force.z * c;
        }
    }

    /// The velocities of its block among the columns.
    pub(super) fn velocities<'a>(&self, columns: &'a mut [Vec3]) -> &'a mut [Vec3] {
        &mut columns[..self.nodes as usize]
    }

    fn range(&self) -> std::ops::Range<usize> {
        self.weights[0] as usize..self.weights[1] as usize
    }

    fn column(&self, k: usize) -> std::ops::Range<usize> {
        let start = (self.column as usize + k) * self.nodes as usize;
        start..start + self.nodes as usize
    }
}

impl Weight {
    /// Force on the node for a unit of the k-th component of friction.
    fn column(&self, axes: &[Vec3; 3], k: usize) -> Vec3 {
        if k < 2 { self.share * axes[k] } else { self.twist }
    }
}

/// Adds to the weight of a node, those of a patch beginning at `from`; `place_of` says where a node's may be.
fn add_weight(weights: &mut Vec<Weight>, place_of: &mut [u32], from: u32, weight: Weight) {
    let place = &mut place_of[weight.node as usize];
    match weights.get_mut(*place as usize).filter(|other| *place >= from && other.node == weight.node) {
        Some(other) => {
            other.share += weight.share;
            other.twist += weight.twist;
        }
        None => {
            *place = weights.len() as u32;
            weights.push(weight);
        }
    }
}

/// ∫ φ N dA of each node that a facet is of, or of each that it presses on.
fn each_weight(scene: &PatchScene, t: u32, is_owner: bool, mut add: impl FnMut(usize, f64)) {
    let (touch, sums) = (scene.touch(t), scene.sums(t));
    if sums.pressure <= 0.0 {
        return;
    }
    if is_owner {
        let triangle = &scene.input.blocks.triangles[touch.triangle.index()];
        triangle.iter().zip(sums.weights).for_each(|(node, w)| add(node.index(), w));
    } else {
        for hit in scene.integrals.overlaps_of(touch) {
            let tet = &scene.input.blocks.tets[hit.tet.index()];
            tet.iter().zip(hit.on_target.pressure).for_each(|(node, w)| add(node.index(), w));
        }
    }
}
