//! The step that contact asks for, before anything has run.
//!
//! Each block is laid against its own like, face on face, a little deep, and the scene's contact model says how stiff that
//! is: ω_c² = max Σ|k|/m over the nodes, as a run reports it.

use std::fmt;

use ndda_contact::block_faces::BlockFaces;
use ndda_contact::{ContactHistory, ContactInput, ContactOutput};
use ndda_io::scene::Scene;
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockMesh, BlockSet, Mat3, Vec3};
use ndda_solver::body::BodyKind;
use ndda_solver::{Shape, Simulation};

use crate::wiring;

/// Distinct blocks that are tried, those of the smallest elements first.
const MOST_SHAPES: usize = 32;
/// Faces of a block that are tried, the largest first.
const MOST_FACES: usize = 8;
/// Depth over the smallest height of an element.
const DEPTH: f64 = 1e-3;
/// Part of the bound on h that is advised.
pub const SAFETY: f64 = 0.5;

/// The shortest step that contact asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// Step at which h = ω_c Δt is half of its bound [s].
    pub step_s: f64,
    /// The block that asks for it.
    pub block: String,
    /// h at the scene's own step.
    pub h: f64,
    /// The bound.
    pub bound: f64,
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { step_s, block, h, bound } = self;
        let verdict = match h {
            h if h > bound => "it is unstable: shorten it, or let time.step be Auto()",
            h if *h > SAFETY * bound => "it is near the bound",
            h if *h < 0.1 * SAFETY * bound => "it could be longer, if blocks move little in it",
            _ => "it will do",
        };
        write!(
            f,
            "contact of `{block}` with its like: h = ω_c Δt = {h:.2} of at most {bound} at this step, so {verdict}; \
             advised step_s: {step_s:.1e}"
        )
    }
}

/// The step for a scene's contact; none without contact, or where contact is stable at any step or at none.
pub fn advise(scene: &Scene, simulation: &Simulation) -> Option<Advice> {
    let bound = simulation.contact_bound().filter(|_| simulation.has_contact())?;
    let mut distinct: Vec<BlockId> = Vec::new();
    for block in simulation.blocks().ids() {
        let shape = simulation.shape(block);
        let known = distinct.iter().any(|other| std::ptr::eq(simulation.shape(*other), shape));
        if !known && shape.kind != BodyKind::Fixed {
            distinct.push(block);
        }
    }
    let height = |block: &BlockId| simulation.shape(*block).smallest_height_m;
    distinct.sort_by(|a, b| height(a).total_cmp(&height(b)));
    distinct.truncate(MOST_SHAPES);
    let rates = distinct.iter().filter_map(|&block| {
        let name = &simulation.blocks().names[block.index()];
        let rate2 = contact_rate2(scene, simulation.shape(block), (block, name))?;
        Some((rate2.sqrt(), block))
    });
    let (rate, block) = rates.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(rate, _)| *rate > 0.0)?;
    let name = simulation.blocks().names[block.index()].clone();
    Some(Advice { step_s: SAFETY * bound / rate, block: name, h: rate * simulation.step_s(), bound })
}

/// ω_c² of a block against its like [1/s²]; none if the scene's contact model cannot serve the two.
fn contact_rate2(scene: &Scene, shape: &Shape, (block, name): (BlockId, &str)) -> Option<f64> {
    let mesh = BlockMesh {
        nodes: shape.operator.rest.clone(),
        tets: shape.operator.tets.clone(),
        ..BlockMesh::default()
    };
    let alone = BlockSet::new(vec![("it".into(), mesh.clone())]).ok()?;
    let pair = alone_with_its_like(scene, block, name);
    let mut largest = 0.0f64;
    for (centroid, normal) in largest_faces(&alone) {
        let depth = DEPTH * shape.smallest_height_m;
        let like = turned_over(&mesh, &centroid, &normal, depth);
        let Ok(blocks) = BlockSet::new(vec![("it".into(), mesh.clone()), ("like".into(), like)]) else {
            continue;
        };
        let mut model = wiring::contact_model(&pair, &blocks).ok()??;
        let zeros = vec![Vec3::zeros(); blocks.rest_position.len()];
        let (mut force, mut friction) = (zeros.clone(), zeros.clone());
        let mut stiffness = vec![0.0; zeros.len()];
        let input = ContactInput::new(&blocks, &blocks.rest_position, &zeros, scene.time.step_s);
        let mut output =
            ContactOutput { force: &mut force, friction_force: &mut friction, stiffness: &mut stiffness };
        model.add_forces(&input, &mut ContactHistory::default(), &mut output).ok()?;
        let masses = shape.operator.node_mass.iter().cycle();
        largest = stiffness.iter().zip(masses).map(|(k, m)| k / m).fold(largest, f64::max);
    }
    Some(largest)
}

/// The scene with nothing in it but a block and its like, for the laws of contact between them.
fn alone_with_its_like(scene: &Scene, block: BlockId, name: &str) -> Scene {
    let mut pair = Scene { rock: Vec::new(), ..scene.clone() };
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
