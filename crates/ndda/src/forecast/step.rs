//! Forecast of contact stability, before anything has run: h = ω_c Δt with ω_c² = max Σ|k|/m over the nodes, or a bound of the whole block, as a run reports it.
//!
//! Two configurations are evaluated with the scene's contact model. *At the start*: blocks that touch where they are put, each
//! swollen by a thousandth of its smallest tetrahedron. *Face on face*: each distinct block against a copy of itself, turned over
//! about one of its faces. The first is what a run begins with; the second bounds contacts that may form later, and is all there is
//! where no blocks touch.

use std::fmt;

use ndda_contact::affine::BlockFaces;
use ndda_contact::{ContactHistory, ContactInput, ContactOutput};
use ndda_fem::mobility;
use ndda_io::scene::{Body, Contact, ContactAt, Scene, is_unset};
use ndda_mesh::geometry::{tet_volume, triangle_area_vector};
use ndda_mesh::stats::stats;
use ndda_mesh::{BlockId, BlockMesh, BlockSet, Mat3, Vec3};
use ndda_solver::BodyKind;
use ndda_solver::Simulation;
use serde::Serialize;

use crate::build::{self, Choices};

/// Distinct blocks that are tried, those of the smallest elements first.
const MOST_SHAPES: usize = 32;
/// Faces of a block that are tried, the largest first.
const MOST_FACES: usize = 8;
/// Blocks whose smallest heights differ by less than this part, and that have as many elements, are of one kind.
const SAME_HEIGHT: f64 = 1e-9;
/// Depth over the smallest height of an element.
const DEPTH: f64 = 1e-3;
/// Part of the bound on h that is advised.
pub const SAFETY: f64 = 0.5;

/// Forecasts that differ by less than this factor are shown as one.
const SAME_H: f64 = 3.0;

/// Contact stability number h = ω_c Δt of one configuration at the scene's step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Forecast {
    /// h.
    pub h: f64,
    /// The block where it is largest.
    pub block: String,
}

/// The forecast of h, and the step that follows from it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Advice {
    /// Step at which h is half of its bound, for all contacts that were evaluated [s].
    pub step_s: f64,
    /// Largest safe step for the contacts at the start alone [s]; none where no blocks touch.
    pub step_at_start_s: Option<f64>,
    /// Contacts at the start; none where no blocks touch.
    pub at_start: Option<Forecast>,
    /// Each block against a copy of itself, face on face.
    pub face_on_face: Forecast,
    /// Largest stable h.
    pub bound: f64,
}

impl Advice {
    /// The larger of the two forecasts.
    pub fn worst(&self) -> &Forecast {
        self.at_start.as_ref().filter(|start| start.h > self.face_on_face.h).unwrap_or(&self.face_on_face)
    }

    /// The smallest and the largest h that is expected of a run.
    pub fn range(&self) -> (f64, f64) {
        let face_on_face = self.face_on_face.h;
        let start = self.at_start.as_ref().map_or(face_on_face, |start| start.h);
        (start.min(face_on_face), start.max(face_on_face))
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { step_s, bound, .. } = self;
        let (from, to) = self.range();
        let verdict = match (from, to) {
            (_, to) if to <= *bound => "Time step stable",
            (from, _) if from > *bound => "Time step unstable",
            _ => "Time step possibly unstable",
        };
        let Forecast { block, .. } = self.worst();
        match &self.at_start {
            Some(start) if to > SAME_H * from => {
                let (first, last) = (start, &self.face_on_face);
                let at_start_s = self.step_at_start_s.unwrap_or(*step_s);
                write!(
                    f,
                    "{verdict}: contact stability number between {from:.2} and {to:.2} (limit {bound}); recommended time step at most \
                     {at_start_s:.1e} s for the contacts at the start, {step_s:.1e} s for all. The number is {:.2} for the \
                     contacts at the start (block {}), and {:.2} for contacts face on face that may form later (block {}).",
                    first.h, first.block, last.h, last.block
                )?;
            }
            _ => write!(
                f,
                "{verdict}: contact stability number {to:.2} (limit {bound}) at block `{block}`; recommended time step at most {step_s:.1e} s."
            )?,
        }
        match to {
            to if to > *bound => write!(f, " Reduce time.step_s, or set time.step to Auto()."),
            to if to > SAFETY * bound => write!(f, " The limit is near."),
            to if to < 0.1 * SAFETY * bound => {
                write!(f, " The step can be longer if blocks move little in one step.")
            }
            _ => Ok(()),
        }
    }
}

/// A step for the contact of one material at one penalty, safe by half of the bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AdvisedStep {
    /// The material.
    pub material: String,
    /// The normal penalty k_n [Pa].
    pub penalty_pa: f64,
    /// The step [s].
    pub step_s: f64,
    /// The block that requires it.
    pub block: String,
}

impl fmt::Display for AdvisedStep {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { material, penalty_pa, step_s, block } = self;
        write!(
            f,
            "contact of {material} at penalty_pa {penalty_pa:.1e}: advised step_s {step_s:.1e} (for {block})"
        )
    }
}

/// A block that is laid against an identical one.
struct Trial<'a> {
    block: BlockId,
    name: &'a str,
    mesh: BlockMesh,
    node_mass: Vec<f64>,
    smallest_height_m: f64,
    /// Whether it moves by an affine map, so that contact may take it whole.
    is_affine: bool,
}

/// The step for a scene's contact; none without contact, or where contact is stable at any step or at none.
pub fn advise(scene: &Scene, simulation: &mut Simulation) -> Option<Advice> {
    let bound = simulation.contact_bound().filter(|_| simulation.has_contact())?;
    let at_start = contacts_at_start(simulation);
    let simulation = &*simulation;
    let blocks = simulation.blocks();
    let mut distinct: Vec<BlockId> = Vec::new();
    for block in blocks.ids() {
        let shape = simulation.shape(block);
        let known = distinct.iter().any(|other| std::ptr::eq(simulation.shape(*other), shape));
        if !known && shape.kind != BodyKind::Fixed {
            distinct.push(block);
        }
    }
    let height = |block: &BlockId| simulation.shape(*block).smallest_height_m;
    distinct.sort_by(|a, b| height(a).total_cmp(&height(b)));
    distinct.truncate(MOST_SHAPES);
    let trials = distinct.into_iter().map(|block| {
        let shape = simulation.shape(block);
        let (nodes, tets) = (shape.operator.rest.clone(), shape.operator.tets.clone());
        Trial {
            block,
            name: &blocks.names[block.index()],
            mesh: BlockMesh { nodes, tets, surfaces: blocks.surfaces_of(block), ..BlockMesh::default() },
            node_mass: shape.operator.node_mass.clone(),
            smallest_height_m: shape.smallest_height_m,
            is_affine: shape.kind.is_affine(),
        }
    });
    let face_on_face = fastest(scene, trials)?;
    let fastest = at_start.iter().map(|(rate, _)| *rate).fold(face_on_face.0, f64::max);
    let forecast = |(rate, block): (f64, String)| Forecast { h: rate * simulation.step_s(), block };
    Some(Advice {
        step_s: SAFETY * bound / fastest,
        step_at_start_s: at_start.as_ref().map(|(rate, _)| SAFETY * bound / rate),
        at_start: at_start.map(forecast),
        face_on_face: forecast(face_on_face),
        bound,
    })
}

/// The largest ω_c of the contacts at the start [1/s], and at which block; none where no blocks touch, or where contact cannot be
/// computed, which the first step says.
fn contacts_at_start(simulation: &mut Simulation) -> Option<(f64, String)> {
    let rates2 = simulation.contact_rates2(DEPTH).ok()?;
    let fastest = rates2.into_iter().zip(&simulation.blocks().names).max_by(|a, b| a.0.total_cmp(&b.0));
    fastest.filter(|(rate2, _)| *rate2 > 0.0).map(|(rate2, name)| (rate2.sqrt(), name.clone()))
}

/// Steps for the contact of each material that moves, at the scene's penalty, a tenth of it and ten times as much; none
/// without contact, of bonded pieces, or where contact is stable at any step or at none.
pub fn advise_materials(scene: &Scene, blocks: &BlockSet) -> Vec<AdvisedStep> {
    let predicted = matches!(scene.time.contact_at, ContactAt::Predicted);
    let bound = build::integrator(&scene.time.integrator).contact_bound().filter(|_| predicted);
    let (Some(bound), Some(Contact::Potential { penalty_pa, .. })) = (bound, &scene.contact) else {
        return Vec::new();
    };
    // The step of bonded pieces is that of their bonds, which only all of them together show.
    let is_bonded = scene.rock.iter().any(|rock| rock.into.is_some());
    if is_unset(penalty_pa) || is_bonded {
        return Vec::new();
    }
    let moving = build::moving(scene, blocks);
    let mut advised = Vec::new();
    for (index, material) in scene.materials.iter().enumerate() {
        let of_material: Vec<(BlockId, bool)> = blocks
            .ids()
            .zip(&moving)
            .filter_map(|(block, moving)| {
                moving
                    .filter(|(material, _)| *material == index)
                    .map(|(_, body)| (block, body != Body::Elastic))
            })
            .collect();
        for penalty_pa in [0.1, 1.0, 10.0].map(|factor| factor * penalty_pa) {
            let mut changed = scene.clone();
            if let Some(Contact::Potential { penalty_pa: penalty, .. }) = &mut changed.contact {
                *penalty = penalty_pa;
            }
            let trials = smallest(blocks, &of_material, material.density_kg_m3);
            if let Some((rate, block)) = fastest(&changed, trials.into_iter()) {
                let step_s = SAFETY * bound / rate;
                advised.push(AdvisedStep { material: material.name.clone(), penalty_pa, step_s, block });
            }
        }
    }
    advised
}

/// Blocks of the smallest elements, one of each kind, with lumped masses.
fn smallest<'a>(blocks: &'a BlockSet, among: &[(BlockId, bool)], density_kg_m3: f64) -> Vec<Trial<'a>> {
    let trial = |&(block, is_affine): &(BlockId, bool)| {
        let mesh = BlockMesh {
            nodes: blocks.rest_position[blocks.nodes_of(block)].to_vec(),
            tets: blocks.local_tets(block).collect(),
            surfaces: blocks.surfaces_of(block),
            ..BlockMesh::default()
        };
        let mut node_mass = vec![0.0; mesh.nodes.len()];
        for tet in &mesh.tets {
            let mass = density_kg_m3 * tet_volume(&tet.map(|node| mesh.nodes[node as usize])) / 4.0;
            tet.iter().for_each(|&node| node_mass[node as usize] += mass);
        }
        let smallest_height_m = stats(&mesh).smallest_height_m;
        Trial { block, name: &blocks.names[block.index()], mesh, node_mass, smallest_height_m, is_affine }
    };
    let mut trials: Vec<Trial> = among.iter().map(trial).collect();
    trials.sort_by(|a, b| a.smallest_height_m.total_cmp(&b.smallest_height_m));
    let same = |a: &Trial, b: &Trial| {
        let difference = (a.smallest_height_m - b.smallest_height_m).abs();
        let alike = a.is_affine == b.is_affine && a.mesh.tets.len() == b.mesh.tets.len();
        alike && difference <= SAME_HEIGHT * b.smallest_height_m
    };
    trials.dedup_by(|a, b| same(a, b));
    trials.truncate(MOST_SHAPES);
    trials
}

/// The largest ω_c of blocks against identical ones [1/s], and whose it is.
fn fastest<'a>(scene: &Scene, trials: impl Iterator<Item = Trial<'a>>) -> Option<(f64, String)> {
    let rates = trials.filter_map(|trial| Some((contact_rate2(scene, &trial)?.sqrt(), trial.name)));
    let fastest = rates.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(rate, _)| *rate > 0.0)?;
    Some((fastest.0, fastest.1.to_string()))
}

/// ω_c² of a block against an identical one [1/s²]; none if the scene's contact model cannot serve the two.
fn contact_rate2(scene: &Scene, trial: &Trial) -> Option<f64> {
    let Trial { mesh, node_mass, .. } = trial;
    let alone = BlockSet::new(vec![("it".into(), mesh.clone())]).ok()?;
    // Far from the origin, a set has one of its own.
    let mesh = &BlockMesh { nodes: alone.rest_position.clone(), ..mesh.clone() };
    let pair = scene_of_an_identical_pair(scene, trial.block, trial.name);
    let whole = mobility(&mesh.nodes, &mesh.tets, node_mass.iter().sum());
    let mut largest = 0.0f64;
    for (centroid, normal) in largest_faces(&alone) {
        let like = turned_over(mesh, &centroid, &normal, DEPTH * trial.smallest_height_m);
        let Ok(blocks) = BlockSet::new(vec![("it".into(), mesh.clone()), ("like".into(), like)]) else {
            continue;
        };
        let mut model = build::contact_model(&pair, &blocks, &mut Choices::default()).ok()??;
        let zeros = vec![Vec3::zeros(); blocks.rest_position.len()];
        let (mut force, mut friction) = (zeros.clone(), zeros.clone());
        let mut stiffness = vec![0.0; zeros.len()];
        let input = ContactInput {
            affine: &[trial.is_affine; 2],
            ..ContactInput::new(&blocks, &blocks.rest_position, &zeros, scene.time.step_s)
        };
        let mut output =
            ContactOutput { force: &mut force, friction_force: &mut friction, stiffness: &mut stiffness };
        model.add_forces(&input, &mut ContactHistory::default(), &mut output).ok()?;
        for stiffness in stiffness.chunks(node_mass.len()) {
            let by_nodes = stiffness.iter().zip(node_mass).map(|(k, m)| k / m).fold(0.0, f64::max);
            let whole: f64 = stiffness.iter().zip(&whole).map(|(k, w)| k * w).sum();
            largest = largest.max(if trial.is_affine { by_nodes.min(whole) } else { by_nodes });
        }
    }
    Some(largest)
}

/// The scene with nothing in it but a block and an identical one, for the laws of contact between them.
fn scene_of_an_identical_pair(scene: &Scene, block: BlockId, name: &str) -> Scene {
    let mut pair = Scene { rock: Vec::new(), bolts: Vec::new(), ..scene.clone() };
    match scene.blocks.get(block.index()) {
        Some(own) => pair.blocks = vec![own.clone(), own.clone()],
        // Blocks of rock are of its material, which is all that counts here.
        None => {
            pair.blocks.clear();
            let material = scene.rock.iter().find(|rock| rock.makes(name)).map(|rock| &rock.material);
            let index = scene.materials.iter().position(|m| Some(&m.name) == material);
            pair.materials.swap(0, index.unwrap_or(0));
        }
    }
    pair
}

/// Centroids and normals of a block's largest faces.
fn largest_faces(blocks: &BlockSet) -> Vec<(Vec3, Vec3)> {
    let faces = BlockFaces::new(blocks, BlockId(0));
    let mut sums = vec![(0.0, Vec3::zeros()); faces.planes.len()];
    for (triangle, &face) in blocks.triangles.iter().zip(&faces.of_triangle) {
        let corners = triangle.map(|n| blocks.rest_position[n.index()]);
        let area = triangle_area_vector(&corners).norm();
        sums[face].0 += area;
        sums[face].1 += area * (corners[0] + corners[1] + corners[2]) / 3.0;
    }
    let mut order: Vec<usize> = (0..sums.len()).collect();
    order.sort_by(|&a, &b| sums[b].0.total_cmp(&sums[a].0));
    order.truncate(MOST_FACES);
    order.iter().map(|&f| (sums[f].1 / sums[f].0, faces.planes[f].normal)).collect()
}

/// A block turned over about a line in one of its faces, so that this face lies on itself, `depth` deep.
fn turned_over(mesh: &BlockMesh, centroid: &Vec3, normal: &Vec3, depth: f64) -> BlockMesh {
    let across = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    let turn = 2.0 * across * across.transpose() - Mat3::identity();
    let mut like = mesh.clone();
    like.nodes.iter_mut().for_each(|x| *x = centroid + turn * (*x - centroid) - depth * normal);
    like
}
