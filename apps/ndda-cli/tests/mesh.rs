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
        let drawn = out.join(if cfg!(feature = "png") { "blocks.png" } else { "blocks.svg" });
        assert!(fs::metadata(drawn).unwrap().len() > 1000);
    }
}

/// A tetrahedron of edges 2 m along the axes.
const OBJ: &str = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// `ndda mesh`, `check` and `run` say alike that nothing is held.
#[test]
fn blocks_that_nothing_holds_are_warned_of_by_all_who_build_them() {
    let folder = tempfile::tempdir().unwrap();
    let falling = SCENE.replace("contact: Off,", "contact: Off, gravity_m_s2: (0, 0, -9.81),");
    for (text, expected) in [(SCENE.to_string(), 0), (falling, 1)] {
        let scene = written(folder.path(), "s.ron", &text);
        for verb in ["mesh", "check", "run"] {
            let mut command = ndda();
            command.arg(verb).arg(&scene).current_dir(folder.path());
            let done = command.args(if verb == "check" { &[][..] } else { &["--force"] }).output().unwrap();
            let said = String::from_utf8(done.stdout).unwrap() + &String::from_utf8(done.stderr).unwrap();
            assert_eq!(said.matches("nothing is held").count(), expected, "{verb}: {said}");
        }
    }
}

#[test]
fn a_closed_surface_is_measured_and_one_that_is_open_refused() {
    let folder = tempfile::tempdir().unwrap();
    let stl: String = OBJ
        .lines()
        .filter_map(|line| line.strip_prefix("f "))
        .map(|face| {
            let corner = |i: &str| ["0 0 0", "2 0 0", "0 2 0", "0 0 2"][i.parse::<usize>().unwrap() - 1];
            let corners: String = face.split(' ').map(|i| format!("vertex {}\n", corner(i))).collect();
            format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        })
        .collect();
    for (name, text) in [("t.obj", OBJ.to_string()), ("t.stl", format!("solid t\n{stl}endsolid t\n"))] {
        let file = written(folder.path(), name, &text);
        assert_eq!(mesh(&file, &[]), exit::DONE, "{name}");
        let report = fs::read_to_string(folder.path().join("t.out/mesh.json")).unwrap();
        let report: Value = serde_json::from_str(&report).unwrap();
        // 2³/6 m³.
        assert!((report["volume_m3"].as_f64().unwrap() - 8.0 / 6.0).abs() < 1e-12, "{report}");
    }
    let open = written(folder.path(), "open.obj", OBJ.strip_suffix("f 2 3 4\n").unwrap());
    assert_eq!(mesh(&open, &[]), exit::BAD_INPUT);
}

/// Columns of 1 m by 1 m by 4 m in a box of 2 m by 2 m, and discs from a table.
const DISCS: &str = "(
    title: \"t\", time: (step_s: 1e-4, end_s: 0.01),
    materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
    rock: [(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (2, 2, 4)), joints: [
        Set(name: \"a\", dip_deg: 90, dip_direction_deg: 90, spacing_m: 1),
        Set(name: \"b\", dip_deg: 90, dip_direction_deg: 0, spacing_m: 1),
        Discs(file: \"dfn.csv\"),
    ])],
    contact: Potential(penalty_pa: 1e8, rock_joints: [(joint: \"J1\", friction: (friction_deg: 30))]),
)";

#[test]
fn discs_of_a_table_cut_blocks_in_the_order_of_their_size() {
    let folder = tempfile::tempdir().unwrap();
    let scene = written(folder.path(), "s.ron", DISCS);
    let header = "dip_deg,dip_direction_deg,x_m,y_m,z_m,radius_m,set\n";
    // The first covers all four columns, the second one of them, the third a quarter of one.
    let rows = ["0,0,1,1,1,2,J1\n", "0,0,0.5,0.5,2,0.8,J1\n", "0,0,0.5,0.5,3,0.28,\n"];
    let mut seen = Vec::new();
    for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
        let table: String = order.iter().map(|&i| rows[i]).collect();
        written(folder.path(), "dfn.csv", &format!("{header}{table}"));
        assert_eq!(mesh(&scene, &[]), exit::DONE);
        let report = fs::read_to_string(folder.path().join("s.out/mesh.json")).unwrap();
        let report: Value = serde_json::from_str(&report).unwrap();
        let discs = &report["rock"][0]["discs"];
        let counts =
            ["discs", "idle", "cuts", "ends_in_cut", "left_whole"].map(|key| discs[key].as_u64().unwrap());
        // The second disc ends in the other three columns, of none of which it covers half, and the third in its own.
        assert_eq!((report["blocks"].as_u64(), counts), (Some(9), [3, 1, 5, 0, 4]), "{report}");
        assert!((discs["joint_m2"].as_f64().unwrap() - 5.0).abs() < 1e-12);
        seen.push(report["rock"][0].to_string());
    }
    assert!(seen.iter().all(|one| *one == seen[0]));
    for (text, words) in [
        (format!("{header}0,0,1,1,1,-2,J1\n"), "dfn.csv, line 2, column 6: radius_m is `-2`"),
        (format!("{header}0,0,1,1,1,2,J2\n"), "there is no joint `J1`"),
        ("dip_deg\n3\n".to_string(), "there is no column dip_direction_deg"),
    ] {
        written(folder.path(), "dfn.csv", &text);
        let done = ndda().arg("check").arg(&scene).output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(done.status.code() == Some(exit::BAD_INPUT) && said.contains(words), "{said}");
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
