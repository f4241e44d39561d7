//! Patches of blocks that deform: what nodes feel of their friction, and how the surface answers to it within the step.
//!
//! A patch acts on the nodes of a block by weights P, one column for each of (F₁, F₂, T/r), and slips by Pᵀ v. The solver says
//! where the nodes would be without friction, v̂, and how the block answers to forces, with inertia and elasticity as the step has them:
//! v = v̂ + Σ U f, U = A⁻¹ P. So a patch that sticks has no slip at the end of the step, a block as a whole or its surface alone
//! may be what it takes to stop.
//!
//! Friction is found from the slips alone. Where a block has no more patches than nodes, only slips are kept, Pᵀ v = Pᵀ v̂ + Σ (Pᵀ U) f:
//! then a finer mesh does not make the search for friction longer.

use ndda_mesh::{BlockId, Mat3, Vec3};
use rayon::prelude::*;

use crate::friction::facet::FacetForce;
use crate::friction::patches::patch::{ContactPatch, PatchDetail};
use crate::friction::patches::{GRAIN_BODIES, PatchScene, Place};
use crate::model::Deformation;
use crate::room::copy_into;

/// Blocks that are asked at once: where there are more, what only their answers need is kept for so many at a time.
const BATCH: usize = 2048;

/// Share of a node in the force of one facet of a patch.
#[derive(Clone, Copy, Debug)]
struct Weight {
    /// Counted from the first of the block.
    node: u32,
    /// Its weight over that of the patch.
    share: f64,
    /// Force for a unit of T/r [1].
    twist: Vec3,
}

/// One side of a patch, by its place among those of its block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NodalSide {
    /// Place of the block among those that answer.
    pub slot: u32,
    place: u32,
    /// Length of each column of the block.
    rows: u32,
}

/// A patch on a block: its number, the end of its weights, its two axes in the plane of contact, and the twist of a force along each.
#[derive(Clone, Copy, Debug)]
struct Side {
    patch: u32,
    end: u32,
    axes: [Vec3; 2],
    twist_of_force: [f64; 2],
}

/// The sides of patches on one block, and the shares of its nodes in them.
#[derive(Default)]
pub(super) struct BlockSides {
    weights: Vec<Weight>,
    sides: Vec<Side>,
    /// Where among the weights the one of each node was put last.
    place_of: Vec<u32>,
    /// Length of a column: nodes, or sides of patches where these are no more.
    rows: usize,
    /// Velocities at the start of the step, or slips [m/s].
    start: Vec<Vec3>,
    /// Room for the rows of one column.
    found: Vec<Vec3>,
}

/// Nodes of blocks that deform, and what their patches do to them.
#[derive(Default)]
pub(super) struct Nodal {
    /// The blocks that deform and have friction, ascending.
    asked: Vec<BlockId>,
    /// Their sides; there may be room for more.
    blocks: Vec<BlockSides>,
    /// For each of them one vector per row in each column: velocities or slips at a time within the step [m/s], and what
    /// they change by, three columns for each side of a patch [m/s per N in a whole step]. Until the solver has answered, rows are nodes, and forces
    /// are in place of velocities.
    columns: Vec<Vec<Vec3>>,
    /// Memory for the blocks of a batch, where there is more than one: their sides and columns until these are kept.
    room: (Vec<BlockSides>, Vec<Vec<Vec3>>),
}

/// Input from which the sides of patches are found.
#[derive(Clone, Copy)]
pub(super) struct SideScene<'a> {
    pub scene: PatchScene<'a>,
    /// Forces of contact on nodes, but for friction that is searched for [N].
    pub push: &'a [Vec3],
    pub forces: &'a [FacetForce],
}

/// A patch whose friction is searched for.
pub(super) struct SearchedPatch<'a> {
    pub number: u32,
    pub patch: &'a ContactPatch,
    pub detail: &'a PatchDetail,
    /// Its facets, and the mean square distance of the points of each from the facet's own centre [m²].
    pub run: &'a [Place],
    pub own_m2: &'a [f64],
}

impl Nodal {
    /// Forgets the last step, and takes the blocks that deform and have friction, ascending.
    pub(super) fn begin(&mut self, asked: impl Iterator<Item = BlockId>) {
        self.asked.clear();
        self.asked.extend(asked);
        let room = self.asked.len().max(self.blocks.len());
        self.blocks.resize_with(room, BlockSides::default);
        self.columns.resize_with(room, Vec::new);
    }

    /// Lets each block take its sides of patches, adds the forces of bonds, and lets the solver answer: velocities and U in place of forces, or slips and Pᵀ U.
    pub(super) fn ask<'a, I: Iterator<Item = SearchedPatch<'a>>>(
        &mut self,
        found: &SideScene,
        deformation: &dyn Deformation,
        patches_of: impl Fn(BlockId) -> I + Sync,
    ) {
        let Self { asked, blocks, columns, room: (sides, answers) } = self;
        if asked.len() <= BATCH {
            let room = (&mut blocks[..asked.len()], &mut columns[..asked.len()]);
            return ask_batch(asked, found, deformation, room, &patches_of);
        }
        sides.resize_with(BATCH, BlockSides::default);
        answers.resize_with(BATCH, Vec::new);
        let kept = blocks.chunks_mut(BATCH).zip(columns.chunks_mut(BATCH));
        for (asked, (blocks, columns)) in asked.chunks(BATCH).zip(kept) {
            let (sides, answers) = (&mut sides[..asked.len()], &mut answers[..asked.len()]);
            ask_batch(asked, found, deformation, (sides, answers), &patches_of);
            let each = blocks.par_iter_mut().zip(columns).zip(sides.par_iter().zip(answers));
            each.with_min_len(GRAIN_BODIES).for_each(|((block, columns), (sides, answers))| {
                block.keep(sides);
                copy_into(columns, answers);
            });
        }
    }

    /// Each side: its block, the number of its patch, and where it is.
    pub(super) fn each_side(&self, mut work: impl FnMut(BlockId, u32, NodalSide)) {
        for (slot, (block, found)) in (0..).zip(self.asked.iter().zip(&self.blocks)) {
            for (place, side) in (0..).zip(&found.sides) {
                work(*block, side.patch, NodalSide { slot, place, rows: found.rows as u32 });
            }
        }
    }

    /// The blocks that answer.
    pub(super) fn asked(&self) -> &[BlockId] {
        &self.asked
    }

    /// Pᵀ U.
    pub(super) fn flexibility(&self, side: &NodalSide) -> Mat3 {
        let (block, columns) = (&self.blocks[side.slot as usize], &self.columns[side.slot as usize]);
        let mut found = Mat3::zeros();
        for (k, mut column) in found.column_iter_mut().enumerate() {
            let answers = &columns[side.column(k)];
            let slip = match block.has_slips() {
                true => answers[side.place as usize],
                false => block.slip(side.place as usize, answers),
            };
            column.copy_from(&slip);
        }
        0.5 * (found + found.transpose())
    }

    /// v ← v + s U f.
    pub(super) fn push(&mut self, side: &NodalSide, force: &Vec3, part: f64) {
        side.push(&mut self.columns[side.slot as usize], force, part);
    }

    /// The sides of each block that answers, and its columns.
    pub(super) fn blocks(&self) -> (&[BlockSides], &[Vec<Vec3>]) {
        let asked = self.asked.len();
        (&self.blocks[..asked], &self.columns[..asked])
    }

    /// The same, with columns that may change.
    pub(super) fn blocks_mut(&mut self) -> (&[BlockSides], &mut [Vec<Vec3>]) {
        let asked = self.asked.len();
        (&self.blocks[..asked], &mut self.columns[..asked])
    }

    /// Does something with the velocities or slips of each block that answers, and with those at the start of the step.
    pub(super) fn each_velocity(&mut self, work: impl Fn(&mut [Vec3], &[Vec3]) + Sync) {
        let (blocks, columns) = self.blocks_mut();
        let each = blocks.par_iter().zip(columns).with_min_len(GRAIN_BODIES);
        each.for_each(|(block, columns)| work(&mut columns[..block.rows], &block.start));
    }
}

/// Asks these blocks at once.
fn ask_batch<'a, I: Iterator<Item = SearchedPatch<'a>>>(
    asked: &[BlockId],
    found: &SideScene,
    deformation: &dyn Deformation,
    (sides, columns): (&mut [BlockSides], &mut [Vec<Vec3>]),
    patches_of: &(impl Fn(BlockId) -> I + Sync),
) {
    let scene = &found.scene;
    let blocks = asked.par_iter().zip(&mut *sides).zip(&mut *columns);
    blocks.with_min_len(GRAIN_BODIES).for_each(|((&block, sides), columns)| {
        sides.begin();
        columns.clear();
        columns.extend_from_slice(&found.push[scene.input.blocks.nodes_of(block)]);
        patches_of(block).for_each(|patch| sides.add(block, found, patch, columns));
    });
    add_bonds(scene, asked, columns);
    deformation.answer(asked, columns);
    let blocks = asked.par_iter().zip(sides).zip(columns);
    blocks.with_min_len(GRAIN_BODIES).for_each(|((&block, sides), columns)| {
        sides.keep_slips(&scene.input.velocity[scene.input.blocks.nodes_of(block)], columns);
    });
}

/// Adds the forces of bonds to the nodes of these blocks, the first of their columns.
fn add_bonds(scene: &PatchScene, asked: &[BlockId], columns: &mut [Vec<Vec3>]) {
    let blocks = scene.input.blocks;
    for bond in scene.bonds {
        for (k, block) in bond.blocks.iter().enumerate() {
            if let Ok(slot) = asked.binary_search(block) {
                let (first, forces) = (blocks.nodes_of(*block).start, &mut columns[slot]);
                bond.shares(blocks, k, |node, weight| forces[node - first] += weight * bond.force_n);
            }
        }
    }
}

impl BlockSides {
    fn begin(&mut self) {
        self.weights.clear();
        self.sides.clear();
        self.start.clear();
        self.rows = 0;
    }

    /// Takes over what the search for friction needs of others: without weights where columns have slips.
    fn keep(&mut self, found: &Self) {
        self.rows = found.rows;
        copy_into(&mut self.sides, &found.sides);
        copy_into(&mut self.start, &found.start);
        copy_into(&mut self.weights, if found.has_slips() { &[][..] } else { &found.weights });
    }

    /// Whether columns have slips in place of velocities.
    fn has_slips(&self) -> bool {
        self.rows == self.sides.len()
    }

    fn weights_of(&self, place: usize) -> &[Weight] {
        let from = place.checked_sub(1).map_or(0, |before| self.sides[before].end);
        &self.weights[from as usize..self.sides[place].end as usize]
    }

    /// Adds a side, and the forces of its friction as columns.
    fn add(
        &mut self,
        block: BlockId,
        found: &SideScene,
        SearchedPatch { number, patch, detail, run, own_m2 }: SearchedPatch,
        columns: &mut Vec<Vec3>,
    ) {
        let SideScene { scene, forces, .. } = found;
        let nodes = scene.input.blocks.nodes_of(block);
        self.place_of.resize(nodes.len(), 0);
        let from = self.weights.len() as u32;
        let spread = &detail.spread;
        // Force on a node of share 1 at an arm of 1 m for a unit of T/r.
        let per_arm_1_m = detail.surface.radius_m / spread.radius2_m2;
        for (&(_, _, t), own_m2) in run.iter().zip(own_m2) {
            let is_owner = scene.owner(t) == block;
            let arm = spread.center_of(scene, &forces[t as usize], t) - spread.center;
            let twist = per_arm_1_m * patch.normal.cross(&arm);
            spread.each_node(scene, (t, is_owner), |node, w| {
                let share = w / spread.total;
                self.add_weight(from, (node - nodes.start, share, share * twist));
            });
            if scene.sums(t).pressure > 0.0 {
                let share = spread.weight(scene, t) / spread.total;
                let couple = share * own_m2 * per_arm_1_m * patch.normal;
                scene.couples().each_force(scene.touch(t), is_owner, &couple, |node, force| {
                    self.add_weight(from, (node - nodes.start, 0.0, force));
                });
            }
        }
        let (axes, twist_of_force) = ([detail.axes[0], detail.axes[1]], detail.twist_of_force(patch));
        self.sides.push(Side { patch: number, end: self.weights.len() as u32, axes, twist_of_force });
        let first = columns.len();
        columns.resize(first + 3 * nodes.len(), Vec3::zeros());
        for weight in &self.weights[from as usize..] {
            let force = |k: usize| weight.share * axes[k] + twist_of_force[k] * weight.twist;
            let forces = [force(0), force(1), weight.twist];
            for (k, force) in forces.iter().enumerate() {
                columns[first + k * nodes.len() + weight.node as usize] += force;
            }
        }
    }

    /// Adds to the weight of a node, those of its patch beginning at `from`.
    fn add_weight(&mut self, from: u32, (node, share, twist): (usize, f64, Vec3)) {
        let (place, node) = (&mut self.place_of[node], node as u32);
        match self.weights.get_mut(*place as usize).filter(|other| *place >= from && other.node == node) {
            Some(other) => {
                other.share += share;
                other.twist += twist;
            }
            None => {
                *place = self.weights.len() as u32;
                self.weights.push(Weight { node, share, twist });
            }
        }
    }

    /// Puts slips in place of velocities, and Pᵀ U in place of U, where there are no more sides than nodes.
    fn keep_slips(&mut self, start_m_s: &[Vec3], columns: &mut Vec<Vec3>) {
        let (nodes, sides) = (start_m_s.len(), self.sides.len());
        if sides > nodes {
            self.rows = nodes;
            self.start.extend_from_slice(start_m_s);
            return;
        }
        self.rows = sides;
        let (mut found, mut start) = (std::mem::take(&mut self.found), std::mem::take(&mut self.start));
        for k in 0..=3 * sides {
            found.clear();
            found.extend((0..sides).map(|place| self.slip(place, &columns[k * nodes..][..nodes])));
            columns[k * sides..][..sides].copy_from_slice(&found);
        }
        columns.truncate((1 + 3 * sides) * sides);
        start.extend((0..sides).map(|place| self.slip(place, start_m_s)));
        (self.found, self.start) = (found, start);
    }

    /// Pᵀ v of one side.
    fn slip(&self, place: usize, velocity: &[Vec3]) -> Vec3 {
        let (mut shift, mut twist) = (Vec3::zeros(), 0.0);
        for weight in self.weights_of(place) {
            let v = &velocity[weight.node as usize];
            shift += weight.share * v;
            twist += weight.twist.dot(v);
        }
        let Side { axes, twist_of_force, .. } = &self.sides[place];
        let along = |k: usize| axes[k].dot(&shift) + twist_of_force[k] * twist;
        Vec3::new(along(0), along(1), twist)
    }
}

impl NodalSide {
    /// Adds what a force changes the velocities of its block by, the first of the columns.
    pub(super) fn push(&self, columns: &mut [Vec3], force: &Vec3, part: f64) {
        let rows = self.rows as usize;
        let (velocity, answers) = columns.split_at_mut(rows);
        let start = self.column(0).start - rows;
        let (first, rest) = answers[start..start + 3 * rows].split_at(rows);
        let (second, third) = rest.split_at(rows);
        let force = part * force;
        for (((v, a), b), c) in velocity.iter_mut().zip(first).zip(second).zip(third) {
            *v += force.x * a + force.y * b + force.z * c;
        }
    }

    /// Its three columns.
    pub(super) fn columns<'a>(&self, columns: &'a [Vec3]) -> &'a [Vec3] {
        &columns[self.column(0).start..self.column(2).end]
    }

    /// Pᵀ v, from the sides of its block and their columns.
    pub(super) fn slip(&self, block: &BlockSides, columns: &[Vec3]) -> Vec3 {
        if block.has_slips() {
            columns[self.place as usize]
        } else {
            block.slip(self.place as usize, columns)
        }
    }

    /// Number of velocities or slips of its block.
    pub(super) fn rows(&self) -> usize {
        self.rows as usize
    }

    /// Range of the column with the velocity changes per unit of the k-th friction component of this side.
    fn column(&self, k: usize) -> std::ops::Range<usize> {
        let start = (1 + 3 * self.place as usize + k) * self.rows as usize;
        start..start + self.rows as usize
    }
}
