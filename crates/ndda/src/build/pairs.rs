//! Friction and restitution between pairs of materials, and on the faces of joints.

use ndda_contact::{FrictionLaw, FrictionLawTable, MohrCoulomb, Restitution, RestitutionTable};
use ndda_io::scene::{self, Scene};
use ndda_mesh::BlockSet;
use ndda_mesh::geometry::{TET_FACES, tet_volume, triangle_area_vector};

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
    everywhere: Restitution,
    (pairs, laws): (&[scene::MaterialPair], &[scene::JointLaw]),
) -> RestitutionTable {
    let index = |name: &str| material_index(scene, name);
    let materials = materials_of(scene, blocks);
    let mut table = RestitutionTable::between(materials, scene.materials.len(), everywhere);
    for pair in pairs {
        if pair.restitution.is_some() || pair.shear_restitution.is_some() {
            // A restitution that is given for a pair damps its shear springs, too, unless shear_restitution is given beside it.
            let shear = pair.shear_restitution.or(everywhere.shear.filter(|_| pair.restitution.is_none()));
            let restitution = Restitution { normal: pair.restitution.unwrap_or(everywhere.normal), shear };
            table.set((index(&pair.between.0), index(&pair.between.1)), restitution);
        }
    }
    for law in laws {
        if let Some(normal) = law.restitution {
            let restitution = Restitution { normal, shear: law.shear_restitution };
            table.set_on(&surfaces_of(&law.joint, blocks), restitution);
        }
    }
    table
}

/// Surfaces that a joint's name means.
pub(super) fn surfaces_of(joint: &str, blocks: &BlockSet) -> Vec<u32> {
    let named = |(_, name): &(u32, &String)| scene::matches(joint, name);
    (0..).zip(&blocks.surface_names).filter(named).map(|(surface, _)| surface).collect()
}

/// Laws on the faces that joints made.
pub(super) fn add_joint_laws(joints: &mut FrictionLawTable, laws: &[scene::JointLaw], blocks: &BlockSet) {
    for law in laws {
        joints.set_on(&surfaces_of(&law.joint, blocks), law.friction.as_ref().and_then(friction_law));
    }
}

/// Cohesion and tensile strength of glue [Pa], beyond any stress: 1e15 is ten thousand times Young's modulus of rock.
const GLUE_PA: f64 = 1e15;

/// Glues the faces that the borders of excavations made, as stiff as normal contact is there unless the scene says how stiff.
pub(super) fn add_glue(joints: &mut FrictionLawTable, scene: &Scene, penalty_pa: f64, blocks: &BlockSet) {
    for space in scene.rock.iter().flat_map(|rock| &rock.excavations) {
        let surfaces = surfaces_of(&space.name, blocks);
        let stiffness_pa_m =
            space.glue_pa_m.unwrap_or_else(|| contact_stiffness_pa_m(&surfaces, penalty_pa, blocks));
        joints.set_on(&surfaces, Some(Box::new(MohrCoulomb::new(0.0, stiffness_pa_m, GLUE_PA, GLUE_PA))));
    }
}

/// Mean stiffness of normal contact on surfaces: pressure 4 k_n (1/H + 1/H) over depth, H being the heights of the tetrahedra behind their faces.
pub(super) fn contact_stiffness_pa_m(surfaces: &[u32], penalty_pa: f64, blocks: &BlockSet) -> f64 {
    let (mut area_m2, mut volume_m3) = (0.0, 0.0);
    let mut of_triangle = std::collections::HashMap::new();
    for (triangle, surface) in blocks.triangles.iter().zip(&blocks.triangle_surface) {
        if surface.is_some_and(|surface| surfaces.contains(&surface)) {
            let mut nodes = *triangle;
            nodes.sort_unstable();
            let area = triangle_area_vector(&triangle.map(|n| blocks.rest_position[n.index()])).norm();
            of_triangle.insert(nodes, area);
        }
    }
    for tet in &blocks.tets {
        for face in TET_FACES {
            let mut nodes = face.map(|corner| tet[corner]);
            nodes.sort_unstable();
            if let Some(area) = of_triangle.get(&nodes) {
                area_m2 += area;
                volume_m3 += tet_volume(&tet.map(|n| blocks.rest_position[n.index()]));
            }
        }
    }
    // 3 V/S is the mean height.
    8.0 * penalty_pa * area_m2 / (3.0 * volume_m3)
}
