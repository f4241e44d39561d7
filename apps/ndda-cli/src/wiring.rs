//! Scene → simulation: the only place where names become objects.
//!
//! A fork that brings its own contact model changes [`contact_model`], one match arm.

mod regions;
mod rock;
mod shapes;

use std::path::Path;
use std::sync::Arc;

use ndda_contact::{
    ContactModel, ContactPotential, Coulomb, ElementPotential, FrictionLaw, Joints, Memory, MohrCoulomb,
    PotentialContact, SmoothPotential, VelocityCoulomb, VolumePotential,
};
use ndda_fem::{
    Bedding, Damped, Damping, Hold as FemHold, InitialStress, LinearElastic, Material, MaterialError, Motion,
    NodeSupport, Record, Table, TransverselyIsotropic, Voigt,
};
use ndda_io::record;
use ndda_io::scene::{self, At, By, Contact, Hold, Integrator, Region, Scene};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{
    AutoStep, BodyKind, BodySetup, ConjugateGradients, Direct, EndContact, ForceSetup, GeneralizedAlpha,
    LinearSolver, Mass, Midpoint, Newmark, Setup, SetupError, Simulation, TimeIntegrator, TractionSetup,
};

use crate::monitor::Monitor;
use regions::{find, find_all, in_region, loaded_triangles, region_nodes};
pub use rock::{CutRock, cut_rock};

/// A node is on a plane when it is nearer than this part of its block's size.
const ON_PLANE: f64 = 1e-6;
/// The paper's support springs: 10⁶ E per metre of reference length.
const SPRING_PER_YOUNG_M: f64 = 1e6;

/// Something in the scene that cannot be built, with its path in the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Path of the value, as in `blocks[1].shape`.
    pub path: String,
    /// What is wrong and what to do.
    pub message: String,
}

impl Fault {
    fn new(path: impl Into<String>, message: impl ToString) -> Self {
        Self { path: path.into(), message: message.to_string() }
    }
}

/// The blocks of a scene, meshed and placed; `folder` is where the scene file is.
///
/// # Errors
/// All shapes that cannot be built, and all defects of their meshes.
pub fn blocks(scene: &Scene, folder: &Path) -> Result<BlockSet, Vec<Fault>> {
    let mut faults = Vec::new();
    let mut meshes = Vec::new();
    for (i, block) in scene.blocks.iter().enumerate() {
        match shapes::mesh(&block.shape, folder) {
            Ok(mesh) => {
                let placed = mesh.placed(&shapes::turned(&block.turns), &vec3(block.at_m));
                meshes.push((block.name.clone(), placed));
            }
            Err(message) => faults.push(Fault::new(format!("blocks[{i}].shape"), message)),
        }
    }
    for index in 0..scene.rock.len() {
        match cut_rock(scene, index) {
            Ok(cut) => meshes.extend(cut.meshes),
            Err(found) => faults.extend(found),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    BlockSet::new(meshes).map_err(|error| {
        let fault = |(name, problem): (String, _)| Fault::new(path_of(scene, &name, ".shape"), problem);
        error.problems.into_iter().map(fault).collect()
    })
}

/// Where in the scene a block comes from.
enum Source<'a> {
    Block(&'a scene::Block),
    Rock(&'a scene::Rock),
}

impl Source<'_> {
    fn material(&self) -> &str {
        match self {
            Self::Block(block) => &block.material,
            Self::Rock(rock) => &rock.material,
        }
    }
}

/// Where each block comes from; `None` for blocks that the scene does not name.
fn sources<'a>(scene: &'a Scene, blocks: &BlockSet) -> Vec<Option<Source<'a>>> {
    let rock = |name: &String| scene.rock.iter().find(|rock| rock.makes(name)).map(Source::Rock);
    let written = scene.blocks.iter().map(|block| Some(Source::Block(block)));
    written.chain(blocks.names.iter().skip(scene.blocks.len()).map(rock)).collect()
}

/// Path of what makes a block; `field` is that of an explicit one.
fn path_of(scene: &Scene, block: &str, field: &str) -> String {
    match scene.rock.iter().position(|rock| rock.makes(block)) {
        Some(index) => format!("rock[{index}]"),
        None => {
            let index = scene.blocks.iter().position(|b| b.name == *block).unwrap_or(0);
            format!("blocks[{index}]{field}")
        }
    }
}

fn vec3(v: [f64; 3]) -> Vec3 {
    Vec3::from(v)
}

/// The simulation of a scene on its blocks, with the contact model that the scene names.
///
/// # Errors
/// All supports, tractions and materials that cannot be built.
pub fn simulation(scene: &Scene, blocks: BlockSet, folder: &Path) -> Result<Simulation, Vec<Fault>> {
    let contact = contact_model(scene, &blocks).map_err(|fault| vec![fault])?;
    simulation_with(scene, blocks, folder, contact)
}

/// The simulation of a scene with a contact model of one's own.
///
/// # Errors
/// As [`simulation`].
pub fn simulation_with(
    scene: &Scene,
    blocks: BlockSet,
    folder: &Path,
    contact: Option<Box<dyn ContactModel>>,
) -> Result<Simulation, Vec<Fault>> {
    let bodies = bodies(scene, &blocks, folder)?;
    let setup = Setup {
        blocks,
        bodies,
        gravity_m_s2: vec3(scene.gravity_m_s2),
        gravity_factor: (scene.gravity_ramp_s > 0.0)
            .then(|| Table { rows: vec![(0.0, 0.0), (scene.gravity_ramp_s, 1.0)] }),
        mass: match scene.time.mass {
            scene::Mass::Consistent => Mass::Consistent,
            scene::Mass::Lumped => Mass::Lumped,
        },
        step_s: scene.time.step_s,
        integrator: integrator(&scene.time.integrator),
        contact,
        auto_step: match scene.time.step {
            scene::Step::Fixed => None,
            scene::Step::Auto { safety, energy, most_halvings } => {
                Some(AutoStep { safety, energy, most_halvings })
            }
        },
        end_contact: match scene.time.contact_at {
            scene::ContactAt::Predicted => None,
            scene::ContactAt::End { tolerance, most_iterations } => {
                Some(EndContact { tolerance, most_iterations })
            }
        },
        solver: linear_solver(scene.time.solver),
    };
    Simulation::new(setup).map_err(|error| vec![setup_fault(scene, error)])
}

/// Where in the scene a simulation could not be set up.
fn setup_fault(scene: &Scene, error: SetupError) -> Fault {
    let (block, supported) = match &error {
        SetupError::Support { block, .. } | SetupError::Kind { block, .. } => (block, true),
        SetupError::Factor { block, .. } | SetupError::Solve { block, .. } => (block, false),
        SetupError::Contact(_) => return Fault::new("contact", error),
    };
    let support = scene.supports.iter().position(|s| supported && scene::matches(&s.block, block));
    let path = support.map_or(path_of(scene, block, ""), |i| format!("supports[{i}]"));
    Fault::new(path, error)
}

/// The contact model that a scene names: a fork adds its own arm here.
///
/// # Errors
/// A potential that cannot serve the blocks.
pub fn contact_model(scene: &Scene, blocks: &BlockSet) -> Result<Option<Box<dyn ContactModel>>, Fault> {
    match &scene.contact {
        None | Some(Contact::Off) => Ok(None),
        Some(Contact::Potential { penalty_pa, potential, friction, joints, memory }) => {
            let potential = contact_potential(potential);
            potential.field(blocks).map_err(|e| Fault::new("contact.potential", e))?;
            let mut model = PotentialContact::new(*penalty_pa).with_potential(potential);
            if let Some(joints) = friction_table(scene, blocks, friction.as_ref(), joints, *memory) {
                model = model.with_joints(joints);
            }
            Ok(Some(Box::new(model)))
        }
    }
}

/// The potential that a scene names.
fn contact_potential(potential: &scene::Potential) -> Box<dyn ContactPotential> {
    match *potential {
        scene::Potential::Element => Box::new(ElementPotential),
        scene::Potential::Smooth { reference_m } => Box::new(SmoothPotential { reference_m }),
        scene::Potential::Volume { exponent, reference_m3 } => {
            Box::new(VolumePotential { exponent, reference_m3 })
        }
    }
}

/// Laws between materials; `None` where nothing rubs, so that no shear spring and no memory is made.
fn friction_table(
    scene: &Scene,
    blocks: &BlockSet,
    everywhere: Option<&scene::Friction>,
    special: &[scene::Joint],
    memory: scene::Memory,
) -> Option<Joints> {
    let rubs = |f: &&scene::Friction| f.friction_deg > 0.0 || f.cohesion_pa > 0.0 || f.tension_pa > 0.0;
    let index = |name: &str| scene.materials.iter().position(|m| m.name == name).unwrap_or(0) as u32;
    let sources = sources(scene, blocks);
    let material = sources.iter().map(|s| s.as_ref().map_or(0, |s| index(s.material()))).collect();
    let mut joints = Joints::between(material, scene.materials.len());
    let all = || 0..scene.materials.len() as u32;
    let pairs: Vec<(u32, u32)> = all().flat_map(|a| all().map(move |b| (a, b))).collect();
    joints.set(&pairs, everywhere.filter(rubs).map(friction_law));
    for joint in special {
        let pair = (index(&joint.between.0), index(&joint.between.1));
        joints.set(&[pair], joint.friction.as_ref().filter(rubs).map(friction_law));
    }
    joints.memory = match memory {
        scene::Memory::Body => Memory::Body,
        scene::Memory::Element => Memory::Element,
    };
    joints.have_laws().then_some(joints)
}

/// The law that a scene's friction asks for.
fn friction_law(friction: &scene::Friction) -> Box<dyn FrictionLaw> {
    let scene::Friction { friction_deg, shear_penalty_pa_m, cohesion_pa, tension_pa } = *friction;
    match shear_penalty_pa_m {
        None => Box::new(VelocityCoulomb::new(friction_deg)),
        Some(shear) if cohesion_pa > 0.0 || tension_pa > 0.0 => {
            Box::new(MohrCoulomb::new(friction_deg, shear, cohesion_pa, tension_pa))
        }
        Some(shear) => Box::new(Coulomb::new(friction_deg, shear)),
    }
}

/// The time integrator that a scene names.
pub fn integrator(choice: &Integrator) -> Box<dyn TimeIntegrator> {
    match choice {
        Integrator::Midpoint { theta } => Box::new(Midpoint { theta: *theta }),
        Integrator::GeneralizedAlpha { radius } => Box::new(GeneralizedAlpha { radius: *radius }),
        Integrator::Newmark { alpha, delta } => Box::new(Newmark { alpha: *alpha, delta: *delta }),
    }
}

fn bodies(scene: &Scene, blocks: &BlockSet, folder: &Path) -> Result<Vec<BodySetup>, Vec<Fault>> {
    let mut faults = Vec::new();
    let materials = materials(scene, &mut faults);
    let mut bodies = Vec::new();
    for (id, source) in blocks.ids().zip(sources(scene, blocks)) {
        let Some(source) = source else { continue };
        let used = scene.materials.iter().position(|m| m.name == source.material());
        let Some(material) = used.and_then(|i| materials[i].clone()) else { continue };
        bodies.push(body(scene, blocks, id, &source, material));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    for (i, support) in scene.supports.iter().enumerate() {
        match node_supports(scene, blocks, folder, support) {
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
        match nearest_node(blocks, force) {
            Ok((block, node)) => {
                let (force_n, factor) = (vec3(force.force_n), table(&force.factor));
                bodies[block.index()].forces.push(ForceSetup { node, force_n, factor });
            }
            Err(message) => faults.push(Fault::new(format!("forces[{i}].at_m"), message)),
        }
    }
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

/// No table is a constant load.
fn table(rows: &[scene::FactorRow]) -> Option<Table> {
    let rows: Vec<_> = rows.iter().map(|row| (row.time_s, row.factor)).collect();
    (!rows.is_empty()).then_some(Table { rows })
}

/// The node nearest to where a force acts, which must not be outside of the block's box by more than a tenth of it.
fn nearest_node(blocks: &BlockSet, force: &scene::Force) -> Result<(BlockId, u32), String> {
    let block = find(blocks, &force.block)?;
    let place = vec3(force.at_m) - blocks.origin_m;
    let nodes = &blocks.rest_position[blocks.nodes_of(block)];
    let bounds = Aabb::around(nodes);
    if !bounds.inflated(0.1 * bounds.diagonal()).touches(&Aabb { min: place, max: place }) {
        return Err(format!("this point is not on block `{}`", force.block));
    }
    let distance = |i: usize| (nodes[i] - place).norm_squared();
    let nearest = (0..nodes.len()).min_by(|&i, &j| distance(i).total_cmp(&distance(j)));
    Ok((block, nearest.ok_or("the block has no nodes")? as u32))
}

fn linear_solver(solver: scene::Solver) -> Box<dyn LinearSolver> {
    match solver {
        scene::Solver::Cholesky => Box::new(Direct),
        scene::Solver::ConjugateGradients { tolerance } => Box::new(ConjugateGradients { tolerance }),
    }
}

fn materials(scene: &Scene, faults: &mut Vec<Fault>) -> Vec<Option<Arc<dyn Material>>> {
    let mut build = |(i, m): (usize, &scene::Material)| {
        let built = material(m);
        built.map_err(|error| faults.push(Fault::new(format!("materials[{i}]"), error))).ok()
    };
    scene.materials.iter().enumerate().map(&mut build).collect()
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
            let rows = record::read(&folder.join(file)).map_err(|e| e.to_string())?;
            let direction = *factor * vec3(*direction).normalize();
            FemHold::Motion(Motion::Record(Record::new(direction, &rows)))
        }
    };
    let sources = sources(scene, blocks);
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

/// The monitors of a scene.
///
/// # Errors
/// All monitors whose point is outside their block.
pub fn monitors(scene: &Scene, simulation: &Simulation) -> Result<Vec<Monitor>, Vec<Fault>> {
    let mut faults = Vec::new();
    let mut monitors = Vec::new();
    for (i, monitor) in scene.monitors.iter().enumerate() {
        let path = || format!("monitors[{i}].at");
        let built = one_monitor(monitor, simulation);
        match built {
            Ok(monitor) => monitors.push(monitor),
            Err(message) => faults.push(Fault::new(path(), message)),
        }
    }
    if faults.is_empty() { Ok(monitors) } else { Err(faults) }
}

fn one_monitor(monitor: &scene::Monitor, simulation: &Simulation) -> Result<Monitor, String> {
    let blocks = simulation.blocks();
    match &monitor.at {
        At::Centre => Ok(Monitor::centre(&monitor.name, simulation, find(blocks, &monitor.block)?)),
        At::Point(place) => {
            let block = find(blocks, &monitor.block)?;
            let point = Monitor::point(&monitor.name, blocks, block, &(vec3(*place) - blocks.origin_m));
            point.ok_or_else(|| format!("this point is outside block `{}` at the start", monitor.block))
        }
        At::Largest(direction) => {
            let found = find_all(blocks, &monitor.block)?;
            let nodes = found.into_iter().map(|block| blocks.nodes_of(block)).collect();
            Ok(Monitor::largest(&monitor.name, nodes, vec3(*direction).normalize()))
        }
    }
}

/// Steps of a run: its end rounded to whole steps, at least one.
pub fn steps(time: &scene::Time) -> u64 {
    ((time.end_s / time.step_s).round() as u64).max(1)
}
