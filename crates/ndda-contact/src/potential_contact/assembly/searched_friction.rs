//! Friction that is found for all faces of a step at once: once it is known, it is added to the nodes of blocks, block by block.

use ndda_mesh::{BlockId, Vec3};
use rayon::prelude::*;

use crate::affine::convex_target::AffineConvexTarget;
use crate::assembly::couples::CoupleScene;
use crate::assembly::nodal_forces::{ScatterScene, each_block};
use crate::friction::patches::FrictionPatches;
use crate::model::ContactOutput;

/// Nodes below which a second thread costs more than it brings.
const GRAIN_NODES: usize = 1 << 13;

/// Adds forces to those on each node.
pub(crate) fn add_all(force: &mut [Vec3], others: &[Vec3]) {
    let each = force.par_iter_mut().zip(others).with_min_len(GRAIN_NODES);
    each.for_each(|(force, other)| *force += other);
}

/// Adds the friction of patches that was searched for to the nodes.
pub(crate) fn add(scene: &ScatterScene, faces: &FrictionPatches, output: &mut ContactOutput) {
    let ContactOutput { force, friction_force, stiffness } = output;
    let all = ContactOutput { force, friction_force, stiffness };
    each_block(scene, 0..scene.blocks.len(), all, &|block, output| add_block(scene, faces, block, output));
}

fn add_block(scene: &ScatterScene, faces: &FrictionPatches, block: BlockId, output: ContactOutput) {
    let first = scene.blocks.nodes_of(block).start;
    let whole = scene.hulls.affine_target(block);
    let ContactOutput { force, friction_force, .. } = output;
    for (t, normal) in faces.searched_facets(block) {
        each_force(scene, (t as usize, normal), (block, whole), |node, added| {
            force[node - first] += added;
            if let Some(sum) = friction_force.get_mut(node - first) {
                *sum += added;
            }
        });
    }
}

/// The friction of a facet, of whose patch that is the normal, on each node of a block: its own, or, with the opposite sign, the target.
fn each_force(
    scene: &ScatterScene,
    (t, normal): (usize, &Vec3),
    (block, whole): (BlockId, Option<&AffineConvexTarget>),
    mut add: impl FnMut(usize, Vec3),
) {
    let (touch, force) = (&scene.integrals.touching()[t], &scene.forces[t]);
    if !force.touches {
        return;
    }
    let is_owner = touch.owner == block;
    if is_owner {
        let sums = scene.integrals.sums_of(touch);
        let weights = force.friction_shares(&sums.weights, &sums.slope);
        match whole.and_then(|_| scene.hulls.contactor(touch.triangle, touch.target)) {
            None => {
                let nodes = &scene.blocks.triangles[touch.triangle.index()];
                nodes.iter().zip(weights).for_each(|(node, share)| add(node.index(), *share * force.shear));
            }
            Some(face) if weights.iter().sum::<f64>() > 0.0 => {
                let shares = face.shares(weights);
                shares.iter().for_each(|(node, share)| add(node.index(), *share * force.shear));
            }
            Some(_) => {}
        }
    } else if let Some(whole) = whole {
        let on_host = &scene.on_host[t];
        let weights = force.friction_shares(&on_host.pressure, &on_host.slope);
        let host = &scene.blocks.tets[whole.host.index()];
        host.iter().zip(weights).for_each(|(node, share)| add(node.index(), -*share * force.shear));
    } else {
        for overlap in scene.integrals.overlaps_of(touch) {
            let weights = force.friction_shares(&overlap.on_target.pressure, &overlap.on_target.slope);
            let nodes = &scene.blocks.tets[overlap.tet.index()];
            nodes.iter().zip(weights).for_each(|(node, share)| add(node.index(), -*share * force.shear));
        }
    }
    if let Some(position) = scene.position.filter(|_| force.couple_n_m != 0.0) {
        let couple_n_m = if is_owner { force.couple_n_m * normal } else { -force.couple_n_m * normal };
        let ScatterScene { blocks, integrals, hulls, .. } = *scene;
        CoupleScene { blocks, position, integrals, hulls }.each_force(touch, is_owner, &couple_n_m, add);
    }
}
