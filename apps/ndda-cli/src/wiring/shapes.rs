//! Shapes of a scene as meshes.

use std::path::Path;

use ndda_io::mesh_file;
use ndda_io::scene::{self, Pattern, Shape};
use ndda_mesh::generate::{BoxPattern, Voussoir, box_block, cylinder, hexahedron, prism, sphere, voussoir};
use ndda_mesh::tetrahedralise::Fill;
use ndda_mesh::{BlockMesh, Mat3};

use super::{rock, vec3};

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
        Shape::Polyhedron { corners_m, faces, fill } => polyhedron(corners_m, faces, &self::fill(*fill)),
        Shape::Mesh { file, body, unit_m } => {
            let mut mesh = body_of(&folder.join(file), body.as_deref())?;
            mesh.nodes.iter_mut().for_each(|x| *x *= *unit_m);
            Ok(mesh)
        }
    }
}

/// A polyhedron is rock that nothing cuts.
fn polyhedron(corners_m: &[[f64; 3]], faces: &[Vec<u32>], fill: &Fill) -> Result<BlockMesh, String> {
    let domain = rock::polyhedron(corners_m, faces)?;
    let blocks = ndda_mesh::cut::cut_blocks(&domain, &[], &Default::default()).map_err(|e| e.to_string())?;
    match blocks.groups().as_slice() {
        [whole] => blocks.mesh_glued(whole, fill).map_err(|e| e.to_string()),
        several => Err(format!("the faces bound {} bodies: give each its own block", several.len())),
    }
}

fn box_pattern(pattern: Pattern) -> BoxPattern {
    match pattern {
        Pattern::Six => BoxPattern::Six,
        Pattern::TwentyFour => BoxPattern::TwentyFour,
    }
}

/// How a polyhedron is filled.
pub(super) fn fill(fill: scene::Fill) -> Fill {
    match fill {
        scene::Fill::Fewest => Fill::Fewest,
        scene::Fill::Centre => Fill::Centre,
        scene::Fill::Size { size_m } => Fill::Size { size_m, finer: Vec::new() },
    }
}

fn body_of(file: &Path, body: Option<&str>) -> Result<BlockMesh, String> {
    let bodies = mesh_file::read(file).map_err(|e| e.to_string())?.bodies;
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
    let (sin, cos) = match turn.angle_deg.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        angle => angle.to_radians().sin_cos(),
    };
    cos * Mat3::identity() + sin * axis.cross_matrix() + (1.0 - cos) * axis * axis.transpose()
}
