//! Closed surfaces from other programs, on their way to a domain that is cut.

use std::fmt::Write;
use std::fs;

use ndda_io::mesh_file::{FileProblem, MeshFileError, Place, write_polyhedra};
use ndda_io::surface_file::{Surface, write_blocks};
use ndda_mesh::Vec3;
use ndda_mesh::cut::{Blocks, CutOptions, Domain, Polyhedron, cut_blocks};
use proptest::prelude::*;

/// The triangles of a box of 1 × 2 × 3.
fn triangles() -> Vec<[Vec3; 3]> {
    let cube = Polyhedron::cuboid(Vec3::zeros(), Vec3::new(1.0, 2.0, 3.0));
    let corners = |face: &ndda_mesh::cut::Face| cube.ring(face).collect::<Vec<_>>();
    cube.faces.iter().map(corners).flat_map(|c| [[c[0], c[1], c[2]], [c[0], c[2], c[3]]]).collect()
}

fn stl_text(triangles: &[[Vec3; 3]]) -> String {
    let mut text = String::from("solid rock face\n");
    for triangle in triangles {
        text += " facet normal 0 0 0\n  outer loop\n";
        triangle.iter().for_each(|x| writeln!(text, "   vertex {} {} {}", x.x, x.y, x.z).unwrap());
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid rock face\n"
}

fn stl_binary(triangles: &[[Vec3; 3]]) -> Vec<u8> {
    let mut bytes = b"solid in name only".to_vec();
    bytes.resize(80, 0);
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        let numbers = [0f32; 3].into_iter().chain(triangle.iter().flatten().map(|&x| x as f32));
        bytes.extend(numbers.flat_map(f32::to_le_bytes));
        bytes.extend([0, 0]);
    }
    bytes
}

const OBJ: &str = "# a wedge\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no rock\nf 1//1 3//1 2//1\nusemtl side\nf 1 2 4\nf -4 -1 -2\nf 2 3 4\n";
const VTK: &str = "# vtk DataFile Version 3.0\nwedge\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n\
                   POLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const VTP: &str = "<?xml version='1.0'?><VTKFile type='PolyData' version='0.1'><PolyData><Piece NumberOfPoints='4' \
    NumberOfPolys='4'><Points><DataArray type='Float32' NumberOfComponents='3' format='ascii'>0 0 0 1 0 0 0 1 0 0 0 1\
    </DataArray></Points><Polys><DataArray type='Int32' Name='connectivity'>0 2 1 0 1 3 0 3 2 1 2 3</DataArray>\
    <DataArray type='Int32' Name='offsets'>3 6 9 12</DataArray></Polys></Piece></PolyData></VTKFile>";

fn from(ending: &str, content: impl AsRef<[u8]>, tolerance: f64) -> Result<Surface, MeshFileError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a").with_extension(ending);
    fs::write(&path, content).unwrap();
    Surface::read(&path, tolerance)
}

fn volume_m3(surface: &Surface) -> f64 {
    Domain::polyhedral(&surface.vertices, &surface.faces).unwrap().volume_m3()
}

#[test]
fn text_and_binary_stl_are_one_closed_surface_that_can_be_cut() {
    let text = from("stl", stl_text(&triangles()), 0.0).unwrap();
    assert_eq!((text.vertices.len(), text.faces.len(), text.faces[0].name.as_str()), (8, 12, "rock face"));
    let binary = from("STL", stl_binary(&triangles()), 0.0).unwrap();
    assert_eq!(binary.vertices, text.vertices);
    assert!((volume_m3(&text) - 6.0).abs() < 1e-12);
}

#[test]
fn obj_and_vtk_surfaces_are_read_and_turned_outward() {
    for (ending, content) in [("obj", OBJ), ("vtk", VTK), ("vtp", VTP)] {
        let surface = from(ending, content, 0.0).unwrap();
        assert!((volume_m3(&surface) - 1.0 / 6.0).abs() < 1e-15, "{ending}");
    }
    let names: Vec<String> = from("obj", OBJ, 0.0).unwrap().faces.into_iter().map(|face| face.name).collect();
    assert_eq!(names, ["rock", "side", "side", "side"]);
    let inside_out = VTK.replace("3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3", "3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2");
    assert!(volume_m3(&from("vtk", inside_out, 0.0).unwrap()) > 0.0);
}

#[test]
fn nearly_equal_vertices_are_one_at_a_tolerance_only() {
    let mut cracked = triangles();
    cracked[0][1] += Vec3::new(1e-7, 0.0, 0.0);
    assert!(matches!(from("stl", stl_text(&cracked), 0.0).unwrap_err().problem, FileProblem::Open { .. }));
    assert_eq!(from("stl", stl_text(&cracked), 1e-6).unwrap().vertices.len(), 8);
    cracked.push([Vec3::zeros(), Vec3::zeros(), Vec3::x()]);
    assert_eq!(from("stl", stl_text(&cracked), 1e-6).unwrap().faces.len(), 12);
}

#[test]
fn open_edges_are_named_by_their_ends() {
    let error = from("stl", stl_text(&triangles()[1..]), 0.0).unwrap_err();
    let FileProblem::Open { count, edges } = &error.problem else { panic!("{error}") };
    assert_eq!((*count, edges.matches('–').count()), (3, 3));
    assert!(edges.contains("(0, 0, 0)–(0, 0, 3)"), "{edges}");
}

#[test]
fn damaged_surfaces_are_refused_with_their_line() {
    let line = |ending: &str, content: String| match from(ending, content, 0.0).unwrap_err().place? {
        Place::Line(line) => Some(line),
        Place::Byte(byte) => panic!("byte {byte} of a text"),
    };
    assert_eq!(line("obj", OBJ.replace("f 1 2 4", "f 1 2 9")), Some(9));
    assert_eq!(line("obj", OBJ.replace("v 0 1 0", "v 0 inf 0")), Some(4));
    assert_eq!(line("stl", stl_text(&triangles()).replacen("vertex 0 0 0", "vertex 0 0", 1)), Some(4));
    let binary = stl_binary(&triangles());
    for length in 0..binary.len() {
        assert!(from("stl", &binary[..length], 0.0).is_err());
    }
}

fn one_block() -> Blocks {
    let domain = Domain::cuboid(Vec3::zeros(), Vec3::repeat(1.0)).unwrap();
    cut_blocks(&domain, &[], &CutOptions::default()).unwrap()
}

#[test]
fn blocks_go_out_as_obj_that_is_a_closed_surface_again_and_as_polyhedra() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    write_blocks(&path, &one_block()).unwrap();
    let surface = Surface::read(&path, 0.0).unwrap();
    assert!((volume_m3(&surface) - 1.0).abs() < 1e-14);
    assert_eq!(surface.faces[0].name, "x_min");
    let path = folder.path().join("a.vtu");
    write_polyhedra(&path, &one_block()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains("Name=\"faces\"") && text.contains("NumberOfCells=\"1\""));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn no_damage_panics(
        which in 0..5usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..6),
        tolerance in prop::sample::select(vec![0.0, 1e-9, 1.0, f64::NAN]),
    ) {
        let (ending, mut bytes) = match which {
            0 => ("stl", stl_text(&triangles()).into_bytes()),
            1 => ("stl", stl_binary(&triangles())),
            2 => ("obj", OBJ.as_bytes().to_vec()),
            3 => ("vtk", VTK.as_bytes().to_vec()),
            _ => ("vtp", VTP.as_bytes().to_vec()),
        };
        for (at, value, is_digit) in changes {
            let at = at.index(bytes.len());
            bytes[at] = if is_digit { b"0123456789-+.eE \n"[usize::from(value) % 17] } else { value };
        }
        if let Err(error) = from(ending, bytes, tolerance) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}
