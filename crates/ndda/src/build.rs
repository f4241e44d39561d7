//! Scene → simulation: the only place where names become objects.

mod blast;
mod bodies;
pub(crate) mod bolts;
mod bonded;
mod choices;
pub(crate) mod forces;
pub mod friction;
mod monitors;
pub mod overlaps;
mod pairs;
pub(crate) mod presence;
mod quiet;
mod regions;
mod rock;
mod settle;
mod shapes;
mod solid;
pub(crate) mod stages;
pub(crate) mod water;

use std::path::Path;

use ndda_contact::{
    BatchFriction, ClosurePotential, ContactModel, ContactPotential, ElementPotential, Memory,
    PotentialContact, Restitution, SmoothPotential, VolumePotential,
};
use ndda_fem::Table;
use ndda_io::scene::{self, Contact, Integrator, Scene};
use ndda_mesh::{BlockId, BlockMesh, BlockSet, BlockSetBuilder, Vec3};
use ndda_solver::{
    AutoStep, BodySetup, ConjugateGradients, Direct, GeneralizedAlpha, ImplicitContact, LinearSolver, Mass,
    Midpoint, Newmark, Setup, SetupError, Simulation, TimeIntegrator,
};

pub use choices::Choices;
use friction::friction_law;
pub use monitors::monitors;
use pairs::{add_glue, add_joint_laws, between_materials, restitution_table};
pub use quiet::records;
use rock::TakeMesh;
pub use rock::{Bonded, Bonds, CutRock, Meshes, RockReport};
pub(crate) use settle::settle;

/// A node is on a plane when it is nearer than this part of its block's size.
const ON_PLANE: f64 = 1e-6;

/// Something in the scene that cannot be built, with its path in the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Path of the value, as in `blocks[1].shape`.
    pub path: String,
    /// The problem and its remedy.
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
    blocks_and_rock(scene, folder).map(|(blocks, _)| blocks)
}

/// The blocks of a scene, and what each rock was cut into.
///
/// # Errors
/// As [`blocks`].
pub fn blocks_and_rock(scene: &Scene, folder: &Path) -> Result<(BlockSet, Vec<RockReport>), Vec<Fault>> {
    let mut builder = BlockSetBuilder::default();
    let rock = each_mesh(scene, folder, &mut |name, mesh| builder.push(name, &mesh))?;
    let blocks = builder.finish().map_err(|error| -> Vec<Fault> {
        let fault = |(name, problem): (String, _)| Fault::new(path_of(scene, &name, ".shape"), problem);
        error.problems.into_iter().map(fault).collect()
    })?;
    let reports = rock::reports(scene, rock, &blocks);
    Ok((blocks, reports))
}

/// The meshes of a scene before they are checked, and what each rock was cut into.
///
/// # Errors
/// All shapes that cannot be built.
pub fn meshes(scene: &Scene, folder: &Path) -> Result<(Meshes, Vec<CutRock>), Vec<Fault>> {
    let mut meshes = Meshes::new();
    let rocks = each_mesh(scene, folder, &mut |name, mesh| meshes.push((name, mesh)))?;
    Ok((meshes, rocks))
}

/// Hands out the meshes of a scene, one after the other, and gives what each rock was cut into.
fn each_mesh(scene: &Scene, folder: &Path, take: &mut TakeMesh) -> Result<Vec<CutRock>, Vec<Fault>> {
    let (mut rocks, mut faults) = (Vec::new(), Vec::new());
    if scene.rockfall.is_some() {
        let message = "a rockfall scene has no blocks";
        return Err(vec![Fault::new("rockfall", message)]);
    }
    for (i, block) in scene.blocks.iter().enumerate() {
        match shapes::mesh(&block.shape, folder) {
            Ok(mesh) => {
                let placed = mesh.placed(&shapes::turned(&block.turns), &vec3(block.at_m));
                take(block.name.clone(), placed);
            }
            Err(message) => faults.push(Fault::new(format!("blocks[{i}].shape"), message)),
        }
    }
    for index in 0..scene.rock.len() {
        match rock::cut_rock(scene, folder, index, take) {
            Ok(cut) => rocks.push(cut),
            Err(found) => faults.extend(found),
        }
    }
    if faults.is_empty() { Ok(rocks) } else { Err(faults) }
}

/// The body under the closed surface in a file, filled with as few tetrahedra as there can be; coordinates as in the file.
///
/// # Errors
/// What is wrong with the file or the surface.
pub fn body_in_surface(path: &Path) -> Result<BlockMesh, String> {
    solid::filled(&solid::of_file(path, 1.0)?, solid::ROUNDED, &scene::Fill::Fewest)
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

/// Index of the material of each block that can move, and its kind of body.
pub fn moving(scene: &Scene, blocks: &BlockSet) -> Vec<Option<(usize, scene::Body)>> {
    let material = |(block, source): (BlockId, Option<Source>)| {
        let source = source?;
        let body = match source {
            Source::Block(block) => block.body,
            Source::Rock(rock) => rock::body(rock, blocks, block),
        };
        let index = scene.materials.iter().position(|m| m.name == source.material());
        index.filter(|_| body != scene::Body::Fixed).map(|index| (index, body))
    };
    blocks.ids().zip(sources(scene, blocks)).map(material).collect()
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

/// No table is a constant load.
pub(crate) fn table(rows: &[scene::FactorRow]) -> Option<Table> {
    let rows: Vec<_> = rows.iter().map(|row| (row.time_s, row.factor)).collect();
    (!rows.is_empty()).then_some(Table { rows })
}

/// The simulation of a scene on its blocks.
///
/// # Errors
/// All supports, tractions and materials that cannot be built.
pub fn simulation(scene: &Scene, blocks: BlockSet, folder: &Path) -> Result<Simulation, Vec<Fault>> {
    simulation_with(scene, blocks, folder, Choices::default())
}

/// Builds the simulation with parts of one's own in the place of what the scene names.
///
/// # Errors
/// As [`simulation`].
pub fn simulation_with(
    scene: &Scene,
    blocks: BlockSet,
    folder: &Path,
    choices: Choices,
) -> Result<Simulation, Vec<Fault>> {
    simulation_of(scene, blocks, folder, choices, (0, &|_| {}))
}

/// What is changed of bodies before they are built.
type ChangeBodies<'a> = &'a dyn Fn(&mut [BodySetup]);

/// The same in a stage of construction, with bodies that are changed before they are built.
fn simulation_of(
    scene: &Scene,
    blocks: BlockSet,
    folder: &Path,
    mut choices: Choices,
    (stage, change): (usize, ChangeBodies),
) -> Result<Simulation, Vec<Fault>> {
    let contact = contact_model(scene, &blocks, &mut choices).map_err(|fault| vec![fault])?;
    let mut bodies = bodies::bodies(scene, &blocks, folder, &choices.materials)?;
    change(&mut bodies);
    let bolts = bolts::bolts(scene, &blocks, stage)?;
    let setup = Setup {
        blocks,
        bodies,
        bolts,
        gravity_m_s2: vec3(scene.gravity_m_s2),
        gravity_factor: (scene.gravity_ramp_s > 0.0)
            .then(|| Table { rows: vec![(0.0, 0.0), (scene.gravity_ramp_s, 1.0)] }),
        mass: match scene.time.mass {
            scene::Mass::Consistent => Mass::Consistent,
            scene::Mass::Lumped => Mass::Lumped,
        },
        step_s: scene.time.step_s,
        integrator: choices.integrator.unwrap_or_else(|| integrator(&scene.time.integrator)),
        contact,
        auto_step: match scene.time.step {
            scene::Step::Fixed => None,
            scene::Step::Auto { safety, energy, most_halvings } => {
                Some(AutoStep { safety, energy, most_halvings })
            }
        },
        implicit_contact: match scene.time.contact_at {
            scene::ContactAt::Predicted => None,
            scene::ContactAt::End { tolerance, most_iterations } => {
                Some(ImplicitContact { tolerance, most_iterations })
            }
        },
        solver: choices.solver.unwrap_or_else(|| linear_solver(scene.time.solver)),
    };
    Simulation::new(setup).map_err(|error| vec![setup_fault(scene, error)])
}

/// Where in the scene a simulation could not be set up.
fn setup_fault(scene: &Scene, error: SetupError) -> Fault {
    let (block, supported) = match &error {
        SetupError::Support { block, .. } | SetupError::Kind { block, .. } => (block, true),
        SetupError::Factor { block, .. } | SetupError::Solve { block, .. } => (block, false),
        SetupError::Wave { block, .. } => {
            let quiet = scene.quiet.iter().position(|q| scene::matches(&q.block, block)).unwrap_or(0);
            return Fault::new(format!("quiet[{quiet}].incident"), error);
        }
        SetupError::Bolt { bolt, .. } => {
            return Fault::new(format!("bolts[{}]", bolts::entry(scene, bolt)), error);
        }
        SetupError::Contact(_) => return Fault::new("contact", error),
    };
    let support = scene.supports.iter().position(|s| supported && scene::matches(&s.block, block));
    let path = support.map_or(path_of(scene, block, ""), |i| format!("supports[{i}]"));
    Fault::new(path, error)
}

/// The contact model that a scene names, with the choices about contact in it.
pub(crate) fn contact_model(
    scene: &Scene,
    blocks: &BlockSet,
    choices: &mut Choices,
) -> Result<Option<Box<dyn ContactModel>>, Fault> {
    if let Some(own) = choices.contact.take() {
        return Ok(Some(own));
    }
    match &scene.contact {
        None | Some(Contact::Off) => Ok(None),
        Some(Contact::Potential {
            penalty_pa,
            potential,
            friction,
            material_pairs,
            rock_joints,
            memory,
            restitution,
            shear_restitution,
            friction_tolerance,
            ..
        }) => {
            let potential = choices.potential.take().unwrap_or_else(|| contact_potential(potential));
            let mut model = PotentialContact::new(*penalty_pa).with_potential(potential);
            model.fit_potential(blocks).map_err(|e| Fault::new("contact.potential", e))?;
            let everywhere = Restitution { normal: *restitution, shear: *shear_restitution };
            model = model.with_restitution(restitution_table(
                scene,
                blocks,
                everywhere,
                (material_pairs, rock_joints),
            ));
            if let Some(broad_phase) = choices.broad_phase.take() {
                model = model.with_broad_phase(broad_phase);
            }
            if let Some(law) = choices.batch_law.take() {
                return Ok(Some(Box::new(BatchFriction::new(model, law))));
            }
            let everywhere = choices.friction.take().or_else(|| friction.as_ref().and_then(friction_law));
            let mut table = between_materials(scene, blocks, everywhere, material_pairs);
            add_glue(&mut table, scene, *penalty_pa, blocks);
            add_joint_laws(&mut table, rock_joints, blocks);
            table.memory = match memory {
                scene::Memory::Body => Memory::Body,
                scene::Memory::Element => Memory::Element,
            };
            table.tolerance = choices.friction_tolerance.or(*friction_tolerance).unwrap_or(table.tolerance);
            // Without friction, no shear spring and no memory is made.
            if table.have_laws() {
                model = model.with_law_table(table);
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
        scene::Potential::Closure { reference_m, max_closure_m } => {
            Box::new(ClosurePotential { reference_m, most_m: max_closure_m })
        }
        scene::Potential::Volume { exponent, reference_m3 } => {
            Box::new(VolumePotential { exponent, reference_m3 })
        }
    }
}

fn material_index(scene: &Scene, name: &str) -> u32 {
    scene.materials.iter().position(|m| m.name == name).unwrap_or(0) as u32
}

/// Number of each block's material, in the order of the scene's materials.
pub fn materials_of(scene: &Scene, blocks: &BlockSet) -> Vec<u32> {
    let index = |source: &Option<Source>| source.as_ref().map_or(0, |s| material_index(scene, s.material()));
    sources(scene, blocks).iter().map(index).collect()
}

/// The time integrator that a scene names.
pub fn integrator(choice: &Integrator) -> Box<dyn TimeIntegrator> {
    match choice {
        Integrator::Midpoint { theta } => Box::new(Midpoint { theta: *theta }),
        Integrator::GeneralizedAlpha { radius } => Box::new(GeneralizedAlpha { radius: *radius }),
        Integrator::Newmark { alpha, delta } => Box::new(Newmark { alpha: *alpha, delta: *delta }),
    }
}

fn linear_solver(solver: scene::Solver) -> Box<dyn LinearSolver> {
    match solver {
        scene::Solver::Cholesky => Box::new(Direct),
        scene::Solver::ConjugateGradients { tolerance } => Box::new(ConjugateGradients { tolerance }),
    }
}

/// Steps of all of a scene, its stages included.
pub fn all_steps(scene: &Scene) -> u64 {
    let of_stage = |stage| stages::steps_of_stage(stage, scene.time.step_s);
    steps(&scene.time) + scene.stages.iter().map(of_stage).sum::<u64>()
}

/// Steps before the first stage, or of a run without stages: `end_s` rounded to whole steps, at least one.
pub fn steps(time: &scene::Time) -> u64 {
    ((time.end_s / time.step_s).round() as u64).max(1)
}
