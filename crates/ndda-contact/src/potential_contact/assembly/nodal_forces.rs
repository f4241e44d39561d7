//! Facet forces to nodal forces, block by block: each block sums what it gives and takes, in one order.

use std::ops::Range;

use nalgebra::{Matrix4, Vector4};
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::affine::convex_target::{AffineConvexTarget, ConvexBlocks};
use crate::assembly::adjacency::BlockContactIndex;
use crate::assembly::couples::CoupleScene;
use crate::assembly::join_if::join_if;
use crate::friction::facet::FacetForce;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::{FacetMoments, OverlapPair};
use crate::integration::pair_moments::OnTarget;
use crate::model::ContactOutput;

/// Facets per half below which a second thread costs more than it brings.
const GRAIN_FACETS: usize = 200;

/// Input of the sums over nodes.
#[derive(Clone, Copy)]
pub struct ScatterScene<'a> {
    /// Topology.
    pub blocks: &'a BlockSet,
    /// Positions of the nodes [m], if facets have couples.
    pub position: Option<&'a [Vec3]>,
    /// Integrals of the pairs.
    pub integrals: &'a Integrals,
    /// The facets that touch, block by block.
    pub adjacency: &'a BlockContactIndex,
    /// Blocks that are affine convex targets.
    pub hulls: &'a ConvexBlocks,
    /// One entry per touching facet.
    pub forces: &'a [FacetForce],
    /// Force of each facet on the host tetrahedron of its target, where that is an affine convex target.
    pub on_host: &'a [OnTarget],
    /// Moments of damping on facets, one entry per touching facet, or none [N m].
    pub tilt_n_m: &'a [Vec3],
    /// Stiffness per slope, one entry per touching facet [Pa].
    pub stiffness_pa: &'a [f64],
    /// Stiffness per pressure, one entry per touching facet, or none [Pa/m].
    pub curvature_pa_m: &'a [f64],
}

impl ScatterScene<'_> {
    fn stiffness(&self, touch: usize, slope: f64, pressure: f64) -> f64 {
        let curvature = self.curvature_pa_m.get(touch).copied().unwrap_or(0.0);
        let normal = self.stiffness_pa[touch] * slope + curvature * pressure.abs();
        normal + self.forces[touch].shear_slope * pressure.abs()
    }

    /// k λ λᵀ of a facet on a block that is an affine convex target, λ those of the host where the slope has its mean.
    fn spring(&self, touch: usize, OnTarget { pressure, slope }: &OnTarget) -> Matrix4<f64> {
        let (total, rise) = (pressure.iter().sum::<f64>(), slope.iter().sum::<f64>());
        let (weights, sum) = if rise > 0.0 { (slope, rise) } else { (pressure, total) };
        if sum <= 0.0 {
            return Matrix4::zeros();
        }
        let lambda = Vector4::from(*weights) / sum;
        self.stiffness(touch, rise, total) * lambda * lambda.transpose()
    }
}

/// Adds all forces to the nodes.
pub fn add(scene: &ScatterScene, output: &mut ContactOutput) {
    let ContactOutput { force, friction_force, stiffness } = output;
    add_blocks(scene, 0..scene.blocks.len(), ContactOutput { force, friction_force, stiffness });
}

/// Adds the forces on some blocks to their nodes, which `output` begins with.
pub(super) fn add_blocks(scene: &ScatterScene, blocks: Range<usize>, output: ContactOutput) {
    each_block(scene, blocks, output, &|block, output| add_block(scene, block, output));
}

/// Does some work for each of some blocks that are in contact, with the output of its nodes: on all threads where blocks have many facets. `output` begins with
/// the first block.
pub(super) fn each_block(
    scene: &ScatterScene,
    blocks: Range<usize>,
    output: ContactOutput,
    work: &(impl Fn(BlockId, ContactOutput) + Sync),
) {
    match scene.adjacency.count(&blocks) {
        0 => {}
        _ if blocks.len() == 1 => work(BlockId(blocks.start as u32), output),
        _ => {
            let middle = blocks.start + blocks.len() / 2;
            let (head, tail) = (blocks.start..middle, middle..blocks.end);
            let starts = scene.blocks.node_starts();
            let (first, second) = split(output, (starts[middle] - starts[blocks.start]) as usize);
            let parallel = scene.adjacency.count(&head).min(scene.adjacency.count(&tail)) > GRAIN_FACETS;
            join_if(
                parallel,
                || each_block(scene, head, first, work),
                || each_block(scene, tail, second, work),
            );
        }
    }
}

fn add_block(scene: &ScatterScene, block: BlockId, output: ContactOutput) {
    let mut nodes = BlockNodes { first: scene.blocks.nodes_of(block).start, output };
    let (own, on_block) = (scene.adjacency.of(block), scene.adjacency.on(block));
    match scene.hulls.affine_target(block) {
        None => {
            own.for_each(|t| nodes.add_contactor(scene, t as usize));
            prefetch(scene, on_block);
            on_block.iter().for_each(|&t| nodes.add_target(scene, t as usize));
        }
        Some(whole) => nodes.add_affine_target(scene, whole, own, on_block),
    }
    if let Some(position) = scene.position {
        nodes.add_couples(scene, block, position);
    }
}

/// Prefetches the results of other blocks, which are far away in memory: requested all at once they arrive sooner than one after the other.
fn prefetch(scene: &ScatterScene, on_block: &[u32]) {
    let mut last = 0;
    for &t in on_block {
        for overlap in scene.integrals.overlaps_of(&scene.integrals.touching()[t as usize]) {
            last |= overlap.tet.0 | u32::from(overlap.on_target.slope[3] != 0.0);
        }
        last |= u32::from(scene.forces[t as usize].touches);
    }
    std::hint::black_box(last);
}

/// Output of the nodes before one of them, and of the rest.
pub(super) fn split(output: ContactOutput, node: usize) -> (ContactOutput, ContactOutput) {
    let (f0, f1) = output.force.split_at_mut(node);
    let (s0, s1) = output.stiffness.split_at_mut(node);
    let (t0, t1) = output.friction_force.split_at_mut(node.min(output.friction_force.len()));
    let head = ContactOutput { force: f0, friction_force: t0, stiffness: s0 };
    (head, ContactOutput { force: f1, friction_force: t1, stiffness: s1 })
}

/// Nodes of one block.
struct BlockNodes<'a> {
    first: usize,
    output: ContactOutput<'a>,
}

impl BlockNodes<'_> {
    /// Nodal forces ∫ N dF of a facet of this block.
    fn add_contactor(&mut self, scene: &ScatterScene, t: usize) {
        let (touch, force) = (&scene.integrals.touching()[t], &scene.forces[t]);
        if !force.touches {
            return;
        }
        let FacetMoments { weights: pressure, slope, .. } = scene.integrals.sums_of(touch);
        let nodes = scene.blocks.triangles[touch.triangle.index()];
        let friction = force.friction_shares(pressure, slope);
        for a in 0..3 {
            let stiffness = scene.stiffness(t, slope[a], pressure[a]);
            self.add(nodes[a].index(), (pressure[a], friction[a]), force, stiffness);
        }
    }

    /// The opposite of a facet of another block. Its weights are the contactor's seen from this block's shape
    /// functions, so force and moment balance to round-off.
    fn add_target(&mut self, scene: &ScatterScene, t: usize) {
        let force = &scene.forces[t];
        if !force.touches {
            return;
        }
        for OverlapPair { tet, on_target, .. } in scene.integrals.overlaps_of(&scene.integrals.touching()[t])
        {
            let OnTarget { pressure, slope } = on_target;
            let friction = force.friction_shares(pressure, slope);
            for (b, node) in scene.blocks.tets[tet.index()].iter().enumerate() {
                let stiffness = scene.stiffness(t, slope[b].max(0.0), pressure[b]);
                self.add(node.index(), (-pressure[b], -friction[b]), force, stiffness);
            }
        }
    }

    /// Adds contact on an affine convex target to its host tetrahedron. That and its faces on others make all its nodes as stiff as its fastest
    /// affine motion; each hit counts as a spring at the mean of its slopes.
    fn add_affine_target(
        &mut self,
        scene: &ScatterScene,
        whole: &AffineConvexTarget,
        own: Range<u32>,
        on_block: &[u32],
    ) {
        let mut springs = Matrix4::zeros();
        for (t, force) in
            own.map(|t| (t as usize, &scene.forces[t as usize])).filter(|(_, force)| force.touches)
        {
            let touch = &scene.integrals.touching()[t];
            let Some(face) = scene.hulls.contactor(touch.triangle, touch.target) else {
                self.add_contactor(scene, t);
                continue;
            };
            let FacetMoments { weights, slope, .. } = scene.integrals.sums_of(touch);
            let shares = face.shares(weights);
            for (node, share) in shares.iter() {
                let friction = if force.shear_by_area { 0.0 } else { *share };
                self.add(node.index(), (*share, friction), force, 0.0);
            }
            if force.shear_by_area && slope.iter().sum::<f64>() > 0.0 {
                let shares = face.shares(slope);
                shares.iter().for_each(|(node, share)| self.add(node.index(), (0.0, *share), force, 0.0));
            }
            springs += scene.spring(t, &OnTarget::of(&face.on_host, weights, slope));
        }
        let host = scene.blocks.tets[whole.host.index()];
        for (t, force) in on_block.iter().map(|&t| (t as usize, &scene.forces[t as usize])) {
            if force.touches {
                let on_host = &scene.on_host[t];
                let friction = force.friction_shares(&on_host.pressure, &on_host.slope);
                for (node, (pressure, friction)) in host.iter().zip(on_host.pressure.iter().zip(friction)) {
                    // The corners of a host may be far from where it is pressed: its springs know better.
                    self.add(node.index(), (-pressure, -friction), force, 0.0);
                }
                springs += scene.spring(t, on_host);
            }
        }
        let rate = whole.rate(&springs);
        for (sum, share) in self.output.stiffness.iter_mut().zip(&whole.share) {
            *sum += 2.0 * share * rate;
        }
    }

    /// The moments of damping and of shear springs on facets of this block, and the opposite of those on it.
    #[inline(never)]
    fn add_couples(&mut self, scene: &ScatterScene, block: BlockId, position: &[Vec3]) {
        let own = scene.adjacency.of(block).map(|t| (t, true));
        let on_block = scene.adjacency.on(block).iter().map(|&t| (t, false));
        let ScatterScene { blocks, integrals, hulls, .. } = *scene;
        let couples = CoupleScene { blocks, position, integrals, hulls };
        for (t, is_owner) in own.chain(on_block).map(|(t, is_owner)| (t as usize, is_owner)) {
            let touch = &integrals.touching()[t];
            let ContactOutput { force, friction_force, .. } = &mut self.output;
            if let Some(tilt_n_m) = scene.tilt_n_m.get(t) {
                let tilt_n_m = if is_owner { *tilt_n_m } else { -tilt_n_m };
                couples.each_force(touch, is_owner, &tilt_n_m, |node, f| force[node - self.first] += f);
            }
            let twist_n_m = scene.forces[t].couple_n_m;
            if twist_n_m != 0.0 {
                let corners = blocks.triangle_corners(touch.triangle, position);
                let axis = triangle_area_vector(&corners).normalize();
                let twist_n_m = if is_owner { twist_n_m * axis } else { -twist_n_m * axis };
                couples.each_force(touch, is_owner, &twist_n_m, |node, f| {
                    force[node - self.first] += f;
                    if let Some(sum) = friction_force.get_mut(node - self.first) {
                        *sum += f;
                    }
                });
            }
        }
    }

    /// The force of a facet on a node with these shares in its pressure and in its friction.
    fn add(&mut self, node: usize, (pressure, friction): (f64, f64), force: &FacetForce, stiffness: f64) {
        let i = node - self.first;
        let friction = friction * force.shear;
        self.output.force[i] += pressure * force.push + friction;
        self.output.stiffness[i] += 2.0 * stiffness;
        if let Some(sum) = self.output.friction_force.get_mut(i) {
            *sum += friction;
        }
    }
}
