//! Bodies of a scene: material, how they move, supports and loads.

use std::path::Path;
use std::sync::Arc;

use ndda_fem::{
    Bedding, Damped, Damping, Hold as FemHold, InitialStress, LinearElastic, Material, MaterialError, Motion,
    NodeSupport, Record, TransverselyIsotropic, Voigt,
};
use ndda_io::record::Prepared;
use ndda_io::scene::{self, By, Hold, Region, Scene};
use ndda_mesh::{BlockId, BlockSet};
use ndda_solver::{BodyKind, BodySetup, ForceSetup, TractionSetup};

use super::blast::add_blasts;
use super::bonded;
use super::forces::acts_on;
use super::quiet::{add_quiet, add_ties};
use super::regions::{in_region, loaded_triangles, region_nodes};
use super::water::add_water;
use super::{Fault, Source, rock, sources, table, vec3};

/// The paper's support springs: 10⁶ E per metre of reference length.
const SPRING_PER_YOUNG_M: f64 = 1e6;

/// The bodies of a scene on its blocks.
pub(super) fn bodies(
    scene: &Scene,
    blocks: &BlockSet,
    folder: &Path,
    own: &[(String, Arc<dyn Material>)],
) -> Result<Vec<BodySetup>, Vec<Fault>> {
    let mut faults = Vec::new();
    let mut materials = materials(scene, &mut faults);
    for (name, material) in own {
        match scene.materials.iter().position(|m| m.name == *name) {
            Some(index) => materials[index] = Some(material.clone()),
            None => faults
                .push(Fault::new("materials", format!("the scene has no material `{name}`, for which your program supplies a law: add it, or correct the name"))),
        }
    }
    let mut bodies = Vec::new();
    let sources = sources(scene, blocks);
    let stiffened = stiffened(scene, blocks, &mut faults);
    for (id, source) in blocks.ids().zip(&sources) {
        let Some(source) = source else { continue };
        let used = scene.materials.iter().position(|m| m.name == source.material());
        let Some(material) = used.and_then(|i| materials[i].clone()) else { continue };
        let own =
            stiffened.iter().find(|(rock, _)| matches!(source, Source::Rock(r) if std::ptr::eq(*r, *rock)));
        let material = own.map_or(material, |(_, stiffer)| stiffer.clone());
        bodies.push(body(scene, blocks, id, source, material));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    for (i, support) in scene.supports.iter().enumerate() {
        match node_supports(scene, blocks, folder, &sources, support) {
            Ok(held) => held.into_iter().for_each(|(block, held)| bodies[block.index()].supports.push(held)),
            Err(message) => faults.push(Fault::new(format!("supports[{i}].on"), message)),
        }
    }
    for (i, traction) in scene.tractions.iter().enumerate() {
        let part = |block| loaded_triangles(blocks, block, &traction.on);
        match in_region(blocks, &traction.block, part) {
            Ok(parts) => {
                for (block, triangles) in parts {
                    let (traction_pa, factor) = (vec3(traction.traction_pa), table(&traction.factor));
                    bodies[block.index()].tractions.push(TractionSetup { triangles, traction_pa, factor });
                }
            }
            Err(message) => faults.push(Fault::new(format!("tractions[{i}].on"), message)),
        }
    }
    for (i, force) in scene.forces.iter().enumerate() {
        match acts_on(blocks, force) {
            Ok(parts) => {
                for (block, (node, share)) in
                    parts.iter().flat_map(|(block, s)| s.iter().map(|s| (*block, *s)))
                {
                    let (force_n, factor) = (share * vec3(force.force_n), table(&force.factor));
                    bodies[block.index()].forces.push(ForceSetup { node, force_n, factor });
                }
            }
            Err(message) => faults.push(Fault::new(format!("forces[{i}].at_m"), message)),
        }
    }
    add_water(scene, blocks, &mut bodies, &mut faults);
    add_quiet(scene, blocks, folder, &materials, &mut bodies, &mut faults);
    add_ties(scene, blocks, &mut bodies, &mut faults);
    add_blasts(scene, blocks, &mut bodies, &mut faults);
    if faults.is_empty() { Ok(bodies) } else { Err(faults) }
}

/// A body as yet without supports and loads.
fn body(
    scene: &Scene,
    blocks: &BlockSet,
    id: BlockId,
    source: &Source<'_>,
    material: Arc<dyn Material>,
) -> BodySetup {
    let (body, own_stress, velocity, spin) = match source {
        Source::Block(b) => (b.body, b.initial_stress_pa.as_ref(), b.velocity_m_s, b.spin_rad_s),
        Source::Rock(rock) => (rock::body(rock, blocks, id), None, [0.0; 3], [0.0; 3]),
    };
    BodySetup {
        kind: match body {
            scene::Body::Elastic => BodyKind::Elastic,
            scene::Body::Affine => BodyKind::Affine,
            scene::Body::Rigid => BodyKind::Rigid,
            scene::Body::Fixed => BodyKind::Fixed,
        },
        material,
        supports: Vec::new(),
        initial_stress: initial_stress(scene, body, own_stress, blocks),
        tractions: Vec::new(),
        pressures: Vec::new(),
        ties: Vec::new(),
        quiet: Vec::new(),
        forces: Vec::new(),
        velocity_m_s: vec3(velocity),
        spin_rad_s: vec3(spin),
    }
}

/// The block's own initial stress, or that of the ground where the block can have one.
fn initial_stress(
    scene: &Scene,
    body: scene::Body,
    own: Option<&scene::Stress>,
    blocks: &BlockSet,
) -> Option<InitialStress> {
    if let Some(own) = own {
        return Some(InitialStress::uniform(voigt(own)));
    }
    let deforms = matches!(body, scene::Body::Elastic | scene::Body::Affine);
    let ground = scene.in_situ.as_ref().filter(|_| deforms)?;
    let mut gradient_pa_m = [Voigt::zeros(); 3];
    for gradient in &ground.gradients {
        let along = vec3(gradient.along).normalize();
        for (sum, part) in gradient_pa_m.iter_mut().zip(along.iter()) {
            *sum += *part * voigt(&gradient.stress_pa_m);
        }
    }
    let at = vec3(ground.at_m) - blocks.origin_m;
    Some(InitialStress { stress_pa: voigt(&ground.stress_pa), at, gradient_pa_m })
}

fn voigt(s: &scene::Stress) -> Voigt {
    Voigt::new(s.xx, s.yy, s.zz, s.xy, s.yz, s.zx)
}

fn materials(scene: &Scene, faults: &mut Vec<Fault>) -> Vec<Option<Arc<dyn Material>>> {
    let mut build = |(i, m): (usize, &scene::Material)| {
        let built = material(m);
        built.map_err(|error| faults.push(Fault::new(format!("materials[{i}]"), error))).ok()
    };
    scene.materials.iter().enumerate().map(&mut build).collect()
}

/// Materials of rock in bonded pieces that make up for their bonds.
fn stiffened<'a>(
    scene: &'a Scene,
    blocks: &BlockSet,
    faults: &mut Vec<Fault>,
) -> Vec<(&'a scene::Rock, Arc<dyn Material>)> {
    let mut build = |(index, rock): (usize, &'a scene::Rock)| {
        let stiffer = bonded::stiffer(scene, index, blocks);
        let built =
            stiffer.and_then(|m| m.map(|m| material(&m).map_err(|error| error.to_string())).transpose());
        let fault = |message| faults.push(Fault::new(format!("rock[{index}].into.compensate"), message));
        built.map_err(fault).ok().flatten().map(|material| (rock, material))
    };
    scene.rock.iter().enumerate().filter_map(&mut build).collect()
}

fn material(m: &scene::Material) -> Result<Arc<dyn Material>, MaterialError> {
    let elastic = elastic(m)?;
    let scene::Damping { mass_per_s, stiffness_s } = m.damping;
    if (mass_per_s, stiffness_s) == (0.0, 0.0) {
        return Ok(elastic);
    }
    Ok(Arc::new(Damped { material: elastic, damping: Damping { mass_per_s, stiffness_s } }))
}

fn elastic(m: &scene::Material) -> Result<Arc<dyn Material>, MaterialError> {
    let isotropic = LinearElastic::new(m.young_pa, m.poisson, m.density_kg_m3)?;
    let Some(bedding) = &m.bedding else { return Ok(Arc::new(isotropic)) };
    let bedding = Bedding {
        normal: vec3(bedding.normal),
        young_across_pa: bedding.young_across_pa,
        poisson_across: bedding.poisson_across,
        shear_across_pa: bedding.shear_across_pa,
    };
    Ok(Arc::new(TransverselyIsotropic::new(&isotropic, &bedding)?))
}

fn node_supports(
    scene: &Scene,
    blocks: &BlockSet,
    folder: &Path,
    sources: &[Option<Source<'_>>],
    support: &scene::Support,
) -> Result<Vec<(BlockId, NodeSupport)>, String> {
    let parts = in_region(blocks, &support.block, |block| region_nodes(blocks, block, &support.on))?;
    let hold = match (&support.hold, &support.on) {
        (Hold::Fixed, _) => FemHold::Fixed,
        (Hold::Direction(n), _) => FemHold::Along(vec3(*n)),
        (Hold::Normal, Region::Plane { normal, .. }) => FemHold::Along(vec3(*normal)),
        (Hold::Normal, _) => return Err("`Normal` needs a region that is a plane; use `Direction(…)`".into()),
        (Hold::Motion(rows), _) => {
            let rows = rows.iter().map(|row| (row.time_s, vec3(row.displacement_m))).collect();
            FemHold::Motion(Motion::Rows(rows))
        }
        (Hold::Acceleration { file, direction, factor }, _) => {
            let file = folder.join(file);
            let record = Prepared::as_written(&file).map_err(|e| e.to_string())?;
            record.check_speed(&file, *factor).map_err(|e| e.to_string())?;
            let direction = *factor * vec3(*direction).normalize();
            FemHold::Motion(Motion::Record(Record::new(direction, &record.rows)))
        }
        (Hold::Shaking(components), _) => {
            let part = |component: &scene::Component| {
                let prepared = component.record.prepared(folder).map_err(|e| e.to_string())?;
                let direction = vec3(component.direction).normalize();
                Ok(Motion::Record(Record::new(direction, &prepared.rows)))
            };
            let parts = components.iter().map(part).collect::<Result<_, String>>()?;
            FemHold::Motion(Motion::Sum(parts))
        }
    };
    let young_pa = |block: BlockId| {
        let material = sources[block.index()].as_ref().map_or("", |source| source.material());
        scene.materials.iter().find(|m| m.name == *material).map_or(0.0, |m| m.young_pa)
    };
    let held = |(block, nodes): (BlockId, Vec<u32>)| {
        let spring_n_m = match support.by {
            By::Elimination => None,
            By::Springs { stiffness_n_m } => {
                Some(stiffness_n_m.unwrap_or_else(|| SPRING_PER_YOUNG_M * young_pa(block)))
            }
        };
        (block, NodeSupport { nodes, hold: hold.clone(), spring_n_m })
    };
    Ok(parts.into_iter().map(held).collect())
}
