//! Shapes of a scene as meshes.

use std::path::Path;

use ndda_io::gmsh_program::{self, Finer, Sizes};
use ndda_io::mesh_file::{self, MeshFile};
use ndda_io::scene::{self, Grading, Pattern, Shape, Towards};
use ndda_mesh::cut::plane::sin_cos;
use ndda_mesh::generate::{BoxPattern, Voussoir, box_block, cylinder, hexahedron, prism, sphere, voussoir};
use ndda_mesh::{BlockMesh, Mat3};

use super::{solid, vec3};

/// The mesh of a shape before it is turned and placed.
pub(super) fn mesh(shape: &Shape, folder: &Path) -> Result<BlockMesh, String> {
    match shape {
        Shape::Box { size_m, cells, pattern } => {
            box_block(*size_m, *cells, box_pattern(*pattern)).map_err(|e| e.to_string())
        }
        Shape::Prism { outline_m, height_m, cells } => {
            prism(*outline_m, *height_m, *cells).map_err(|e| e.to_string())
        }
        Shape::Hexahedron { corners_m, cells, pattern } => {
            hexahedron(corners_m.map(vec3), *cells, box_pattern(*pattern)).map_err(|e| e.to_string())
        }
        Shape::Voussoir { inner_radius_m, outer_radius_m, start_deg, end_deg, width_m, cells, pattern } => {
            let stone = Voussoir {
                inner_radius_m: *inner_radius_m,
                outer_radius_m: *outer_radius_m,
                start_deg: *start_deg,
                end_deg: *end_deg,
                width_m: *width_m,
            };
            voussoir(&stone, *cells, box_pattern(*pattern)).map_err(|e| e.to_string())
        }
        Shape::Cylinder { radius_m, height_m, cells } => {
            cylinder(*radius_m, *height_m, *cells).map_err(|e| e.to_string())
        }
        Shape::Sphere { radius_m, levels } => sphere(*radius_m, *levels).map_err(|e| e.to_string()),
        Shape::Polyhedron { corners_m, faces, fill } => {
            let solid = solid::of_corners(corners_m, faces);
            solid::filled(&solid, solid::EXACT, fill)
        }
        Shape::Surface { file, unit_m, fill } => {
            let solid = solid::of_file(&folder.join(file), *unit_m)?;
            solid::filled(&solid, solid::ROUNDED, fill)
        }
        Shape::Mesh { file, body, unit_m, size_m, finer } => {
            let path = folder.join(file);
            let bodies = bodies_of(&path, *unit_m, *size_m, finer)?;
            let mut mesh = body_of(&path, bodies, body.as_deref())?;
            mesh.nodes.iter_mut().for_each(|x| *x *= *unit_m);
            Ok(mesh)
        }
    }
}

fn box_pattern(pattern: Pattern) -> BoxPattern {
    match pattern {
        Pattern::Six => BoxPattern::Six,
        Pattern::TwentyFour => BoxPattern::TwentyFour,
    }
}

/// The bodies of a mesh file, or of a geometry that Gmsh meshes: lengths in its own unit.
fn bodies_of(path: &Path, unit_m: f64, size_m: Option<f64>, finer: &[Grading]) -> Result<MeshFile, String> {
    let in_unit = |grading: &Grading| {
        let unit = |at: [f64; 3]| at.map(|c| c / unit_m);
        let place = match grading.towards {
            Towards::Point(at) => (unit(at), None),
            Towards::Plane { point_m, normal } => (unit(point_m), Some(normal)),
        };
        Finer { place, size: grading.size_m / unit_m, growth: grading.growth }
    };
    let sizes = Sizes { size: size_m.map(|size| size / unit_m), finer: finer.iter().map(in_unit).collect() };
    let read = if gmsh_program::is_geometry(path) {
        gmsh_program::mesh(path, &sizes, None)
    } else {
        mesh_file::read(path)
    };
    read.map_err(|e| e.to_string())
}

fn body_of(file: &Path, mesh: MeshFile, body: Option<&str>) -> Result<BlockMesh, String> {
    let bodies = mesh.bodies;
    let names = bodies.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
    match body {
        None if bodies.len() > 1 => {
            Err(format!("{} holds the bodies {names}: say which with `body`", file.display()))
        }
        _ => bodies
            .into_iter()
            .find(|(name, _)| body.is_none_or(|wanted| wanted == name))
            .map(|(_, mesh)| mesh)
            .ok_or_else(|| {
                format!("{} has no body `{}`; it has {names}", file.display(), body.unwrap_or(""))
            }),
    }
}

/// The product of turns; whole quarters are exact.
pub(super) fn turned(turns: &[scene::Turn]) -> Mat3 {
    turns.iter().fold(Mat3::identity(), |before, turn| rotation(turn) * before)
}

/// Rodrigues' formula, R = cos θ I + sin θ [n]× + (1 − cos θ) n nᵀ.
fn rotation(turn: &scene::Turn) -> Mat3 {
    let axis = vec3(turn.axis).normalize();
    let (sin, cos) = sin_cos(turn.angle_deg);
    cos * Mat3::identity() + sin * axis.cross_matrix() + (1.0 - cos) * axis * axis.transpose()
}
