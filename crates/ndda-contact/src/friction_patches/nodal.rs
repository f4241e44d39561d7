//! Patches of blocks that deform: what nodes feel of their friction, and how the surface answers to it within the step.
//!
//! A patch acts on the nodes of a block by weights P, one column for each of (F₁, F₂, T/r), and slips by Pᵀ v. The solver says
//! where the nodes would be without friction, v̂, and how the block answers to forces, with inertia and elasticity as the step has them:
//! v = v̂ + Σ U f, U = A⁻¹ P. So a patch that sticks has no slip at the end of the step, a block as a whole or its surface alone
//! may be what it takes to stop.

use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};

use crate::facets::FacetForce;
use crate::friction_patches::patch::ContactPatch;
use crate::friction_patches::{PatchScene, Place};
use crate::model::Deformation;
use crate::scatter::each_of_couple;

/// What a node feels of one facet of a patch.
#[derive(Clone, Copy, Debug)]
struct Weight {
    /// Counted from the first of all blocks.
    node: u32,
    /// ∫ φ N dA over that of the patch.
    share: f64,
    /// Force for a unit of T/r [1].
    twist: Vec3,
}

/// Where the weights and answers of one side of a patch are.
#[derive(Clone, Copy, Debug, Default)]
pub struct NodalSide {
    weights: [u32; 2],
    /// First node of the block, nodes, and where its three columns of answers begin.
    first: u32,
    nodes: u32,
    answers: u32,
}

/// Nodes of blocks that deform, and what their patches do to them.
#[derive(Default)]
pub struct Nodal {
    weights: Vec<Weight>,
    /// Where among them the one of each node was put last.
    place_of: Vec<u32>,
    /// U, three columns for each side of a patch [m/s per N in a whole step].
    answers: Vec<Vec3>,
    /// Velocities at the start of the step and at a time within it; only those of blocks that deform.
    start: Vec<Vec3>,
    pub velocity: Vec<Vec3>,
    /// Forces on the nodes of a block.
    force: Vec<Vec3>,
    /// Blocks that deform and have coupled patches.
    blocks: Vec<BlockId>,
}

impl Nodal {
    /// Forgets the last step.
    pub fn begin(&mut self, start: &[Vec3]) {
        self.weights.clear();
        self.answers.clear();
        self.blocks.clear();
        self.start.resize(start.len(), Vec3::zeros());
        self.velocity.resize(start.len(), Vec3::zeros());
        self.force.resize(start.len(), Vec3::zeros());
        self.place_of.resize(start.len(), 0);
    }

    /// Velocities of a block at the end of the step under all loads and these patches without their friction, by runs of facets.
    pub fn add_block<'a>(
        &mut self,
        block: BlockId,
        scene: &PatchScene,
        forces: &[FacetForce],
        deformation: &dyn Deformation,
        runs: impl Iterator<Item = (&'a [Place], f64)>,
    ) {
        let nodes = scene.input.blocks.nodes_of(block);
        self.force[nodes.clone()].fill(Vec3::zeros());
        for (run, sign) in runs {
            for &(_, _, t) in run {
                let FacetForce { push, shear, .. } = forces[t as usize];
                let force = sign * (push + shear);
                each_weight(scene, t, sign > 0.0, |node, w| self.force[node] += w * force);
            }
        }
        self.start[nodes.clone()].copy_from_slice(&scene.input.velocity[nodes.clone()]);
        deformation.end_velocity(block, &mut self.force[nodes.clone()], &mut self.velocity[nodes]);
        self.blocks.push(block);
    }

    /// One side of a patch; the block has been [added](Self::add_block).
    pub fn add_side(
        &mut self,
        block: BlockId,
        scene: &PatchScene,
        (patch, run): (&ContactPatch, &[Place]),
        (forces, own_m2): (&[FacetForce], &[Mat3]),
        deformation: &dyn Deformation,
    ) -> NodalSide {
        let from = self.weights.len() as u32;
        let is_owner = block == patch.owner;
        for &(_, _, t) in run {
            let arm = forces[t as usize].center - patch.center;
            let twist = patch.normal.cross(&arm) / patch.surface.radius_m;
            each_weight(scene, t, is_owner, |node, w| {
                let share = w / patch.pressure;
                let weight = Weight { node: node as u32, share, twist: share * twist };
                add_weight(&mut self.weights, &mut self.place_of, from, weight);
            });
            let (pressure, own_m2) = (scene.sums(t).pressure, own_m2[t as usize].trace());
            let Some(nodes) = scene.couple_nodes(t, is_owner).filter(|_| pressure > 0.0) else { continue };
            let couple = pressure / patch.pressure * own_m2 / patch.surface.radius_m * patch.normal;
            each_of_couple(nodes, scene.input.position, &couple, |node, force| {
                let node = node.index() as u32;
                let weight = Weight { node, share: 0.0, twist: force };
                add_weight(&mut self.weights, &mut self.place_of, from, weight);
            });
        }
        let nodes = scene.input.blocks.nodes_of(block);
        let side = NodalSide {
            weights: [from, self.weights.len() as u32],
            first: nodes.start as u32,
            nodes: nodes.len() as u32,
            answers: self.answers.len() as u32,
        };
        self.answers.resize(self.answers.len() + 3 * nodes.len(), Vec3::zeros());
        for k in 0..3 {
            let force = &mut self.force[nodes.clone()];
            force.fill(Vec3::zeros());
            for weight in &self.weights[side.range()] {
                force[weight.node as usize - nodes.start] += weight.column(&patch.axes, k);
            }
            let start = side.answers as usize + k * nodes.len();
            deformation.respond(block, force, &mut self.answers[start..start + nodes.len()]);
        }
        side
    }

    /// Pᵀ v.
    pub fn slip(&self, side: &NodalSide, axes: &[Vec3; 3]) -> Vec3 {
        let (mut shift, mut twist) = (Vec3::zeros(), 0.0);
        for weight in &self.weights[side.range()] {
            let v = &self.velocity[weight.node as usize];
            shift += weight.share * v;
            twist += weight.twist.dot(v);
        }
        Vec3::new(axes[0].dot(&shift), axes[1].dot(&shift), twist)
    }

    /// Pᵀ U.
    pub fn flexibility(&self, side: &NodalSide, axes: &[Vec3; 3]) -> Mat3 {
        let mut found = Mat3::zeros();
        for (l, mut column) in found.column_iter_mut().enumerate() {
            let answers = &self.answers[side.column(l)];
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
    pub fn push(&mut self, side: &NodalSide, force: &Vec3, part: f64) {
        for l in 0..3 {
            let nodes = side.first as usize..(side.first + side.nodes) as usize;
            for (v, u) in self.velocity[nodes].iter_mut().zip(&self.answers[side.column(l)]) {
                *v += part * force[l] * u;
            }
        }
    }

    /// Velocities from those at the start and now.
    pub fn change(&mut self, all: &BlockSet, change: impl Fn(Vec3, Vec3) -> Vec3) {
        let Self { blocks, start, velocity, .. } = self;
        for &block in &*blocks {
            for node in all.nodes_of(block) {
                velocity[node] = change(start[node], velocity[node]);
            }
        }
    }
}

impl NodalSide {
    fn range(&self) -> std::ops::Range<usize> {
        self.weights[0] as usize..self.weights[1] as usize
    }

    fn column(&self, k: usize) -> std::ops::Range<usize> {
        let start = (self.answers + k as u32 * self.nodes) as usize;
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
        for hit in scene.integrals.hits_of(touch) {
            let tet = &scene.input.blocks.tets[hit.tet.index()];
            tet.iter().zip(hit.on_target.pressure).for_each(|(node, w)| add(node.index(), w));
        }
    }
}
