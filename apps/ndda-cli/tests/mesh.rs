//! `ndda mesh` measures scenes and files, and repairs files when asked to.

use std::fs;
use std::path::{Path, PathBuf};

mod common;

use common::{code, exit, ndda};
use serde_json::Value;

const SCENE: &str = "(
    title: \"t\", time: (step_s: 1e-4, end_s: 0.01), contact: Off,
    materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
    rock: [(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (2, 2, 2)),
            joints: [Plane(name: \"j\", dip_deg: 0, dip_direction_deg: 0, point_m: (0, 0, 0.5))])],
)";

/// Two tetrahedra over one face; the second is inverted, and has its own copies of the nodes of the face.
const GMSH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 0\n6 1 0 0\n\
                    7 0 1 0\n8 0 0 -1\n$EndNodes\n$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 5 6 7 8\n$EndElements\n";

/// Runs `ndda mesh` with results beside the input; returns the exit code.
fn mesh(input: &Path, words: &[&str]) -> i32 {
    let out = input.with_extension("out");
    code(ndda().arg("mesh").arg(input).arg("--out").arg(out).args(["--force", "--json"]).args(words))
}

fn written(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_scene_is_measured_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let scene = written(folder.path(), "s.ron", SCENE);
    assert_eq!(mesh(&scene, &["--also", "gmsh,polyhedra,obj,tetgen"]), exit::DONE);
    let out = folder.path().join("s.out");
    let report: Value = serde_json::from_str(&fs::read_to_string(out.join("mesh.json")).unwrap()).unwrap();
    assert_eq!(report["blocks"], 2);
    assert!((report["volume_m3"].as_f64().unwrap() - 8.0).abs() < 1e-12);
    assert_eq!(report["block_size"]["smallest_m3"][1], "rock_0001");
    assert_eq!(report["rock"][0]["blocks"], 2);
    for name in ["blocks.vtu", "rock_parts.vtu", "rock_parts.obj", "mesh.ele"] {
        assert!(fs::metadata(out.join(name)).unwrap().len() > 0, "{name}");
    }
    let again = ndda_io::mesh_file::read(&out.join("mesh.msh")).unwrap().bodies;
    assert_eq!(again.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["rock_0001", "rock_0002"]);
    assert_eq!(report["steps"].as_array().unwrap().len(), 0);
    if cfg!(feature = "plots") {
        let picture = fs::read_to_string(out.join("mesh.svg")).unwrap();
        assert!(picture.starts_with("<svg") && picture.contains("volume of blocks"), "{picture}");
    }
}

#[test]
fn a_file_is_repaired_only_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let file = written(folder.path(), "f.msh", GMSH);
    assert_eq!(mesh(&file, &[]), exit::BAD_INPUT);
    assert_eq!(mesh(&file, &["--fix", "orient,merge"]), exit::DONE);
    let text = fs::read_to_string(folder.path().join("f.out/mesh.json")).unwrap();
    let report: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&report["nodes"], &report["tets"]), (&Value::from(5), &Value::from(2)));
    assert_eq!(report["fixes"].as_array().unwrap().len(), 2);
    assert_eq!(fs::read_to_string(&file).unwrap(), GMSH);
}

#[test]
fn a_scene_is_not_repaired_and_a_missing_file_is_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    let scene = written(folder.path(), "s.ron", SCENE);
    assert_eq!(mesh(&scene, &["--fix", "orient"]), exit::BAD_INPUT);
    assert_eq!(mesh(&folder.path().join("no.msh"), &[]), exit::BAD_INPUT);
    fs::create_dir(folder.path().join("folder.msh")).unwrap();
    assert_eq!(mesh(&folder.path().join("folder.msh"), &[]), exit::BAD_INPUT);
    assert_eq!(mesh(folder.path(), &[]), exit::BAD_INPUT);
}

/// Penalty contact is a spring: ω² grows as the penalty, so the step falls by √10 from one row to the next.
#[test]
fn steps_are_advised_for_each_material_and_penalty() {
    let folder = tempfile::tempdir().unwrap();
    let text = SCENE.replace("contact: Off", "contact: Potential(penalty_pa: 1e8, potential: Smooth())");
    let scene = written(folder.path(), "s.ron", &text);
    assert_eq!(mesh(&scene, &[]), exit::DONE);
    let text = fs::read_to_string(folder.path().join("s.out/mesh.json")).unwrap();
    let report: Value = serde_json::from_str(&text).unwrap();
    let steps: Vec<f64> =
        report["steps"].as_array().unwrap().iter().map(|s| s["step_s"].as_f64().unwrap()).collect();
    assert_eq!(steps.len(), 3);
    let ratio = 10f64.sqrt();
    assert!(
        (steps[0] / steps[1] - ratio).abs() < 1e-9 && (steps[1] / steps[2] - ratio).abs() < 1e-9,
        "{steps:?}"
    );
    assert_eq!(report["steps"][1]["penalty_pa"], 1e8);
}
