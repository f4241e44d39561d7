//! Geometry that Gmsh meshes. Needs Gmsh, `gmsh` or what `NDDA_GMSH` names; without it the meshing test says so and
//! passes.

use std::fs;
use std::path::Path;

use ndda_io::gmsh_program::{VARIABLE, mesh};
use ndda_io::mesh_file::read;
use ndda_mesh::stats::stats;
use ndda_mesh::validate;

const BOX: &str =
    "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 2, 3};\nPhysical Volume(\"stone\") = {1};\n";

#[test]
fn a_geometry_is_a_mesh_with_the_names_of_its_groups() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.geo");
    fs::write(&path, BOX).unwrap();
    let bodies = match read(&path) {
        Ok(file) => file.bodies,
        Err(error) if error.to_string().contains("cannot be run") => return println!("SKIPPED: {error}"),
        Err(error) => panic!("{error}"),
    };
    assert_eq!(bodies[0].0, "stone");
    assert_eq!(validate::problems(&bodies[0].1), vec![]);
    assert!((stats(&bodies[0].1).volume_m3 - 6.0).abs() < 1e-12);
    let fine = mesh(&path, Some(0.2), None).unwrap().bodies;
    assert!(fine[0].1.tets.len() > 2 * bodies[0].1.tets.len());
    fs::write(&path, "Box(1) = {0, 0").unwrap();
    let error = read(&path).unwrap_err().to_string();
    assert!(error.contains("Gmsh made no mesh of it: "), "{error}");
}

#[test]
fn a_missing_gmsh_is_named_with_what_to_install() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.step");
    fs::write(&path, "").unwrap();
    let error = mesh(&path, None, Some(Path::new("/no/such/gmsh"))).unwrap_err().to_string();
    assert!(error.contains("install Gmsh") && error.contains(VARIABLE), "{error}");
    assert!(
        mesh(&folder.path().join("b.step"), None, None).unwrap_err().to_string().contains("cannot be read")
    );
}
