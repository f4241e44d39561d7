//! Checks of shapes.

use std::path::Path;

use ndda_mesh::planar::turn;

use super::Check;
use crate::mesh::gmsh_program;
use crate::scene::{Fill, Grading, Shape, Towards};

/// Refinements of a sphere beyond this are a slip of the keyboard.
const MOST_LEVELS: u32 = 6;

impl Check<'_> {
    pub(super) fn shape(&mut self, path: &str, shape: &Shape, folder: Option<&Path>) {
        match shape {
            Shape::Box { size_m, cells, .. } => {
                for (i, size) in size_m.iter().enumerate() {
                    self.positive(format!("{path}.size_m[{i}]"), *size, "m");
                }
                self.cells(path, cells);
            }
            Shape::Prism { outline_m: [a, b, c], height_m, cells } => {
                self.positive(format!("{path}.height_m"), *height_m, "m");
                let twice_area = turn(a, b, c);
                if twice_area < 0.0 {
                    let help = "swap two corners";
                    self.error(format!("{path}.outline_m"), "the corners run clockwise", help);
                } else if twice_area.is_nan() || twice_area == 0.0 {
                    let help = "give three corners that span an area";
                    self.error(format!("{path}.outline_m"), "the triangle has no area", help);
                }
                self.cells(path, cells);
            }
            Shape::Hexahedron { corners_m, cells, .. } => {
                corners_m.iter().for_each(|corner| self.numbers(&format!("{path}.corners_m"), corner));
                self.cells(path, cells);
            }
            Shape::Voussoir {
                inner_radius_m, outer_radius_m, start_deg, end_deg, width_m, cells, ..
            } => {
                self.positive(format!("{path}.inner_radius_m"), *inner_radius_m, "m");
                self.positive(format!("{path}.width_m"), *width_m, "m");
                if outer_radius_m <= inner_radius_m {
                    let message =
                        format!("{outer_radius_m} m: must be above the inner radius of {inner_radius_m} m");
                    self.error(format!("{path}.outer_radius_m"), message, "the stone lies between the two");
                }
                if end_deg <= start_deg {
                    let message = format!("{end_deg}°: must be above start_deg, which is {start_deg}°");
                    self.error(format!("{path}.end_deg"), message, "angles grow from x towards z");
                }
                self.cells(path, cells);
            }
            Shape::Cylinder { radius_m, height_m, cells } => {
                self.positive(format!("{path}.radius_m"), *radius_m, "m");
                self.positive(format!("{path}.height_m"), *height_m, "m");
                self.cells(path, cells);
            }
            Shape::Sphere { radius_m, levels } => {
                self.positive(format!("{path}.radius_m"), *radius_m, "m");
                if *levels > MOST_LEVELS {
                    let message = format!("{levels} levels are 8^{} tetrahedra", u64::from(*levels) + 1);
                    self.error(format!("{path}.levels"), message, "2 is round enough for most uses");
                }
            }
            Shape::Polyhedron { corners_m, faces, fill } => {
                self.polyhedron(path, corners_m, faces);
                self.fill(&format!("{path}.fill"), fill);
            }
            Shape::Surface { file, unit_m, fill } => {
                self.positive(format!("{path}.unit_m"), *unit_m, "m");
                self.file(format!("{path}.file"), file, folder);
                self.fill(&format!("{path}.fill"), fill);
            }
            Shape::Mesh { file, unit_m, size_m, finer, .. } => {
                self.positive(format!("{path}.unit_m"), *unit_m, "m");
                self.file(format!("{path}.file"), file, folder);
                size_m.iter().for_each(|size| self.positive(format!("{path}.size_m"), *size, "m"));
                self.gradings(&format!("{path}.finer"), finer);
                let asks = size_m.map(|_| "size_m").or((!finer.is_empty()).then_some("finer"));
                if let Some(field) = asks.filter(|_| !gmsh_program::is_geometry(Path::new(file))) {
                    let help = "leave it out, or give a .geo, .step, .stp or .brep file";
                    self.error(format!("{path}.{field}"), "a mesh in a file is as fine as it is", help);
                }
            }
        }
    }

    /// Corners and faces; whether they close is found when the body is built.
    pub(super) fn polyhedron(&mut self, path: &str, corners_m: &[[f64; 3]], faces: &[Vec<u32>]) {
        corners_m.iter().for_each(|corner| self.numbers(&format!("{path}.corners_m"), corner));
        for (i, face) in faces.iter().enumerate() {
            if let Some(corner) = face.iter().find(|&&corner| corner as usize >= corners_m.len()) {
                let message = format!("there is no corner {corner}: there are {}", corners_m.len());
                self.error(format!("{path}.faces[{i}]"), message, "corners are counted from 0");
            } else if face.len() < 3 {
                self.error(
                    format!("{path}.faces[{i}]"),
                    "a face has at least three corners",
                    "name them all",
                );
            }
        }
        if faces.len() < 4 {
            let message = format!("{} faces bound no body", faces.len());
            self.error(format!("{path}.faces"), message, "a body has at least four faces");
        }
    }

    pub(super) fn fill(&mut self, path: &str, fill: &Fill) {
        match fill {
            Fill::Fewest | Fill::Centre => {}
            Fill::Size { size_m, finer } => {
                self.positive(format!("{path}.size_m"), *size_m, "m");
                self.gradings(&format!("{path}.finer"), finer);
            }
            Fill::TetGen { size_m } => {
                self.positive(format!("{path}.size_m"), *size_m, "m");
                if !cfg!(feature = "tetgen") {
                    let help = "build ndda with `--features tetgen` (AGPL), or use `Size`";
                    self.error(path, "this program was built without TetGen", help);
                }
            }
        }
    }

    fn gradings(&mut self, path: &str, finer: &[Grading]) {
        for (i, grading) in finer.iter().enumerate() {
            self.positive(format!("{path}[{i}].size_m"), grading.size_m, "m");
            self.positive(format!("{path}[{i}].growth"), grading.growth, "");
            match &grading.towards {
                Towards::Point(at) => self.numbers(&format!("{path}[{i}].towards"), at),
                Towards::Plane { point_m, normal } => {
                    self.numbers(&format!("{path}[{i}].towards.point_m"), point_m);
                    self.direction(format!("{path}[{i}].towards.normal"), normal);
                }
            }
        }
    }
}
