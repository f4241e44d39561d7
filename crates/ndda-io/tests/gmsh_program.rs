//! Geometry that Gmsh meshes. Needs Gmsh, `gmsh` or what `NDDA_GMSH` names; without it the meshing test says so and
//! passes.

use std::fs;
use std::path::Path;

use ndda_io::gmsh_program::{Finer, Sizes, mesh};
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
    let fine = mesh(&path, &Sizes { size: Some(0.2), finer: vec![] }, None).unwrap().bodies;
    assert!(fine[0].1.tets.len() > 2 * bodies[0].1.tets.len());
    // Finer towards the corner at the origin, then towards the plane x = 1.
    for (at, normal) in [([0.0; 3], None), ([1.0, 0.0, 0.0], Some([-2.0, 0.0, 0.0]))] {
        let finer = vec![Finer { place: (at, normal), size: 0.1, growth: 0.3 }];
        let graded = &mesh(&path, &Sizes { size: Some(0.5), finer }, None).unwrap().bodies[0].1;
        let near = |x: &ndda_mesh::Vec3| match normal {
            None => x.norm() < 0.3,
            Some(_) => x.x > 0.8,
        };
        let edges = |wanted: bool| {
            let tets = graded.tets.iter().map(|tet| tet.map(|node| graded.nodes[node as usize]));
            let chosen: Vec<f64> = tets
                .filter(|corners| corners.iter().all(|x| near(x) == wanted))
                .map(|[a, b, ..]| (a - b).norm())
                .collect();
            chosen.iter().sum::<f64>() / chosen.len() as f64
        };
        assert!(edges(true) < 0.25 && edges(false) > 1.3 * edges(true), "{} {}", edges(true), edges(false));
    }
    fs::write(&path, "Box(1) = {0, 0").unwrap();
    let error = read(&path).unwrap_err().to_string();
    assert!(error.contains("Gmsh made no mesh of it: "), "{error}");
}

#[test]
fn a_missing_gmsh_is_named_with_what_to_install() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.step");
    fs::write(&path, "").unwrap();
    let error = mesh(&path, &Sizes::default(), Some(Path::new("/no/such/gmsh"))).unwrap_err().to_string();
    assert!(error.contains("install Gmsh") && error.contains("NDDA_GMSH"), "{error}");
    assert!(
        mesh(&folder.path().join("b.step"), &Sizes::default(), None)
            .unwrap_err()
            .to_string()
            .contains("cannot be read")
    );
}
