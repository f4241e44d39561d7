//! Friction and restitution between pairs of materials, and on the faces of joints.

use ndda_contact::{FrictionLaw, FrictionLawTable, RestitutionTable};
use ndda_io::scene::{self, Scene};
use ndda_mesh::BlockSet;

use super::friction::friction_law;
use super::{material_index, materials_of};

/// Laws between materials.
pub(super) fn between_materials(
    scene: &Scene,
    blocks: &BlockSet,
    everywhere: Option<Box<dyn FrictionLaw>>,
    special: &[scene::MaterialPair],
) -> FrictionLawTable {
    let index = |name: &str| material_index(scene, name);
    let mut joints = FrictionLawTable::between(materials_of(scene, blocks), scene.materials.len());
    let all = || 0..scene.materials.len() as u32;
    let pairs: Vec<(u32, u32)> = all().flat_map(|a| all().map(move |b| (a, b))).collect();
    joints.set(&pairs, everywhere);
    for joint in special {
        let pair = (index(&joint.between.0), index(&joint.between.1));
        joints.set(&[pair], joint.friction.as_ref().and_then(friction_law));
    }
    joints
}

/// Restitution between materials, and on the faces that joints made.
pub(super) fn restitution_table(
    scene: &Scene,
    blocks: &BlockSet,
    everywhere: f64,
    (pairs, laws): (&[scene::MaterialPair], &[scene::JointLaw]),
) -> RestitutionTable {
    let index = |name: &str| material_index(scene, name);
    let materials = materials_of(scene, blocks);
    let mut table = RestitutionTable::between(materials, scene.materials.len(), everywhere);
    for pair in pairs {
        if let Some(restitution) = pair.restitution {
            table.set((index(&pair.between.0), index(&pair.between.1)), restitution);
        }
    }
    for law in laws {
        if let Some(restitution) = law.restitution {
            table.set_on(&surfaces_of(&law.joint, blocks), restitution);
        }
    }
    table
}

/// Surfaces that a joint's name means.
fn surfaces_of(joint: &str, blocks: &BlockSet) -> Vec<u32> {
    let named = |(_, name): &(u32, &String)| scene::matches(joint, name);
    (0..).zip(&blocks.surface_names).filter(named).map(|(surface, _)| surface).collect()
}

/// Laws on the faces that joints made.
pub(super) fn add_joint_laws(joints: &mut FrictionLawTable, laws: &[scene::JointLaw], blocks: &BlockSet) {
    for law in laws {
        joints.set_on(&surfaces_of(&law.joint, blocks), law.friction.as_ref().and_then(friction_law));
    }
}
