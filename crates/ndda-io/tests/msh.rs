//! Gmsh meshes: files that Gmsh made, files by hand, damaged files.

use std::path::{Path, PathBuf};

use ndda_io::mesh_file::{FileProblem, MeshFile, MeshFileError, Place, read};
use ndda_io::msh::{MshProblem, parse};
use ndda_mesh::stats::stats;
use ndda_mesh::{BlockMesh, Vec3, validate};
use proptest::prelude::*;

const FORMS: [&str; 4] = ["v2_ascii", "v2_binary", "v4_ascii", "v4_binary"];

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(format!("{name}.msh"))
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(data(name)).unwrap()
}

fn text(name: &str) -> String {
    String::from_utf8(bytes(name)).unwrap()
}

fn parsed(bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    parse(Path::new("a.msh"), bytes)
}

/// The problem of `text`, and its line.
fn fault(text: &str) -> (Option<usize>, FileProblem) {
    let error = parsed(text.as_bytes()).unwrap_err();
    let line = error.place.map(|place| match place {
        Place::Line(line) => line,
        Place::Byte(byte) => panic!("byte {byte} of an ASCII file"),
    });
    (line, error.problem)
}

fn corners_of(mesh: &BlockMesh, set: &str) -> Vec<Vec3> {
    mesh.node_sets[set].iter().map(|&node| mesh.nodes[node as usize]).collect()
}

#[test]
fn two_boxes_of_gmsh_are_two_named_bodies_in_every_form() {
    for form in FORMS {
        let bodies = read(&data(&format!("two_boxes_{form}"))).unwrap().bodies;
        let names: Vec<&str> = bodies.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["upper", "lower block"], "{form}");
        for ((_, mesh), volume) in bodies.iter().zip([2.0, 1.0]) {
            assert_eq!(validate::problems(mesh), vec![], "{form}");
            assert!((stats(mesh).volume_m3 - volume).abs() < 1e-12, "{form}");
            assert!(corners_of(mesh, "bottom").iter().all(|x| x.z == 0.0), "{form}");
            assert!(corners_of(mesh, "bottom").len() >= 4, "{form}");
        }
        let [(_, upper), (_, lower)] = &bodies[..] else { panic!("{form}") };
        assert_eq!(upper.node_sets.keys().collect::<Vec<_>>(), ["bottom"], "{form}");
        assert_eq!(lower.node_sets.keys().collect::<Vec<_>>(), ["bottom", "corner", "curve_10"], "{form}");
        assert_eq!(corners_of(lower, "corner"), [Vec3::new(0.0, 0.0, 1.0)], "{form}");
        assert!(corners_of(lower, "curve_10").iter().all(|x| x.x == 0.0 && x.y == 0.0), "{form}");
    }
}

#[test]
fn every_form_of_a_mesh_reads_the_same() {
    for name in ["two_boxes", "touching", "one_box"] {
        let first = read(&data(&format!("{name}_{}", FORMS[0]))).unwrap();
        for form in &FORMS[1..] {
            assert_eq!(read(&data(&format!("{name}_{form}"))).unwrap(), first, "{name}_{form}");
        }
    }
}

#[test]
fn a_joint_between_bodies_is_a_set_of_both_and_the_top_of_one() {
    let bodies = read(&data("touching_v4_binary")).unwrap().bodies;
    let [(a, below), (b, above)] = &bodies[..] else { panic!() };
    assert_eq!((a.as_str(), b.as_str()), ("volume_1", "volume_2"));
    assert_eq!(corners_of(below, "joint"), corners_of(above, "joint"));
    assert!(corners_of(above, "top").iter().all(|x| x.z == 2.0));
    assert!(!below.node_sets.contains_key("top"));
    assert_eq!((validate::problems(below), validate::problems(above)), (vec![], vec![]));
}

#[test]
fn a_file_without_groups_is_one_body() {
    let bodies = read(&data("one_box_v4_ascii")).unwrap().bodies;
    assert_eq!(bodies.len(), 1);
    assert_eq!(bodies[0].0, "body");
    assert!((stats(&bodies[0].1).volume_m3 - 1.0).abs() < 1e-12);
}

#[test]
fn tags_may_have_gaps_and_any_order_and_loose_points_are_dropped() {
    for name in ["hand_v2", "hand_v4"] {
        let bodies = read(&data(name)).unwrap().bodies;
        let [(body, mesh)] = &bodies[..] else { panic!("{name}") };
        assert_eq!(body, "volume_5", "{name}");
        assert_eq!(mesh.nodes.len(), 5, "{name}");
        assert_eq!(validate::problems(mesh), vec![], "{name}");
        assert!((stats(mesh).volume_m3 - (1.0 / 6.0 + 1.0 / 3.0)).abs() < 1e-15, "{name}");
        assert!(corners_of(mesh, "base").iter().all(|x| x.z == 0.0), "{name}");
        assert_eq!(mesh.node_sets["base"].len(), 3, "{name}");
    }
}

#[test]
fn line_ends_of_windows_and_a_byte_order_mark_do_not_matter() {
    for name in ["hand_v2", "hand_v4", "two_boxes_v4_ascii"] {
        let windows = format!("\u{FEFF}{}", text(name).replace('\n', "\r\n"));
        assert_eq!(parsed(windows.as_bytes()), parsed(&bytes(name)), "{name}");
    }
}

#[test]
fn parametric_coordinates_are_skipped_in_4_1_and_refused_in_2_2() {
    for form in FORMS {
        let result = read(&data(&format!("one_box_parametric_{form}")));
        if form.starts_with("v4") {
            assert_eq!(result, read(&data("one_box_v4_ascii")), "{form}");
        } else {
            let problem = result.unwrap_err().problem;
            assert!(matches!(problem, FileProblem::NotRead { .. }), "{form}");
        }
    }
}

#[test]
fn meshes_that_are_not_first_order_tetrahedra_are_refused_by_type() {
    for form in FORMS {
        let refused = |name: &str| read(&data(&format!("{name}_{form}"))).unwrap_err().to_string();
        assert!(refused("bricks").contains("4 × hexahedron"), "{}", refused("bricks"));
        let order_2 = refused("one_box_order_2");
        assert!(order_2.contains("× 10-node tetrahedron") && order_2.contains("-order 1"), "{order_2}");
        let surface = read(&data(&format!("one_box_surface_{form}"))).unwrap_err().problem;
        assert_eq!(surface, FileProblem::Msh(MshProblem::OnlySurface { triangles: 24 }), "{form}");
    }
}

#[test]
fn a_tetrahedron_in_two_bodies_is_refused() {
    for form in FORMS {
        let problem = read(&data(&format!("overlapping_{form}"))).unwrap_err().problem;
        let FileProblem::Msh(MshProblem::InTwoBodies { count, a, b, .. }) = problem else {
            panic!("{form}: {problem}")
        };
        assert_eq!((count, a.as_str(), b.as_str()), (48, "volume_1", "all"), "{form}");
    }
}

#[test]
fn tetrahedra_outside_of_all_bodies_are_counted() {
    let outside = text("hand_v2").replace("4 4 2 5 1", "4 4 2 0 1");
    assert_eq!(
        fault(&outside),
        (Some(25), FileProblem::Msh(MshProblem::Unassigned { count: 1, tets: 2, first: 4 }))
    );
}

/// A binary file with one tetrahedron, highest byte first.
fn big_endian(version: &str) -> Vec<u8> {
    let mut file = format!("$MeshFormat\n{version} 1 8\n").into_bytes();
    let ints = |file: &mut Vec<u8>, values: &[i32]| values.iter().for_each(|v| file.extend(v.to_be_bytes()));
    let sizes = |file: &mut Vec<u8>, values: &[u64]| values.iter().for_each(|v| file.extend(v.to_be_bytes()));
    let reals = |file: &mut Vec<u8>, values: &[f64]| values.iter().for_each(|v| file.extend(v.to_be_bytes()));
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    ints(&mut file, &[1]);
    file.extend(b"\n$EndMeshFormat\n$Nodes\n");
    if version == "2.2" {
        file.extend(b"4\n");
        for (tag, corner) in (1..).zip(corners) {
            ints(&mut file, &[tag]);
            reals(&mut file, &corner);
        }
        file.extend(b"\n$EndNodes\n$Elements\n1\n");
        ints(&mut file, &[4, 1, 2, 1, 0, 1, 1, 2, 3, 4]);
    } else {
        sizes(&mut file, &[1, 4, 1, 4]);
        ints(&mut file, &[3, 1, 0]);
        sizes(&mut file, &[4, 1, 2, 3, 4]);
        reals(&mut file, corners.as_flattened());
        file.extend(b"\n$EndNodes\n$Elements\n");
        sizes(&mut file, &[1, 1, 1, 1]);
        ints(&mut file, &[3, 1, 4]);
        sizes(&mut file, &[1, 1, 1, 2, 3, 4]);
    }
    file.extend(b"\n$EndElements\n");
    file
}

#[test]
fn binary_files_of_the_other_byte_order_are_read() {
    for version in ["2.2", "4.1"] {
        let bodies = parsed(&big_endian(version)).unwrap().bodies;
        assert_eq!(bodies[0].1.tets, [[0, 1, 2, 3]]);
        assert_eq!(stats(&bodies[0].1).volume_m3, 1.0 / 6.0);
    }
}

#[test]
fn counts_are_held_against_the_length_of_the_file() {
    let v2 = text("hand_v2");
    let v4 = text("hand_v4");
    let huge = "1000000000000";
    for (text, line) in [
        (v2.replace("$Nodes\n6", &format!("$Nodes\n{huge}")), 12),
        (v2.replace("$Elements\n4", &format!("$Elements\n{huge}")), 21),
        (v2.replace("$PhysicalNames\n1", &format!("$PhysicalNames\n{huge}")), 8),
        (v4.replace("0 0 1 1\n", &format!("0 0 1 {huge}\n")), 9),
        (v4.replace("1 4 0\n", &format!("{huge} 4 0\n")), 10),
        (v4.replace("2 6 7 50", &format!("2 {huge} 7 50")), 14),
        (v4.replace("2 6 7 50", &format!("{huge} 6 7 50")), 14),
        (v4.replace("2 1 0 4", &format!("2 1 0 {huge}")), 15),
        (v4.replace("2 3 2 4", &format!("2 {huge} 2 4")), 31),
        (v4.replace("3 1 4 2", &format!("3 1 4 {}", u64::MAX)), 34),
    ] {
        let (found_line, problem) = fault(&text);
        assert!(matches!(problem, FileProblem::Msh(MshProblem::TooShort { .. })), "{problem}");
        assert_eq!(found_line, Some(line), "{problem}");
    }
    let mut binary = bytes("two_boxes_v4_binary");
    let nodes = binary.windows(7).position(|w| w == b"$Nodes\n").unwrap() + 7;
    binary[nodes + 8..nodes + 16].copy_from_slice(&1_000_000_000_000u64.to_le_bytes());
    let error = parsed(&binary).unwrap_err();
    assert!(
        matches!(error.problem, FileProblem::Msh(MshProblem::TooShort { count: 1_000_000_000_000, .. })),
        "{error}"
    );
}

#[test]
fn damaged_text_is_refused_with_its_line() {
    let v2 = text("hand_v2");
    let v4 = text("hand_v4");
    let unexpected = |problem: &FileProblem| matches!(problem, FileProblem::Unexpected { .. });
    let (line, problem) = fault(&v2.replace("10 1 0 0", "10 1 zero 0"));
    assert_eq!((line, unexpected(&problem)), (Some(14), true));
    assert_eq!(problem.to_string(), "expected a coordinate, found `zero`");
    let (line, problem) = fault(&v2.replace("10 1 0 0", "10 1 nan 0"));
    assert_eq!((line, unexpected(&problem)), (Some(14), true));
    let (line, problem) = fault(&v2.replace("10 1 0 0", "7 1 0 0"));
    assert_eq!((line, problem), (Some(17), FileProblem::Twice { what: "node", id: 7 }));
    let (line, problem) = fault(&v2.replace("7 10 20 30", "7 10 21 30"));
    assert_eq!(
        (line, problem),
        (Some(24), FileProblem::Msh(MshProblem::NoSuchNode { element: 3, node: 21 }))
    );
    let (line, problem) = fault(&v2.replace("4 4 2 5", "4 94 2 5"));
    assert_eq!((line, problem), (Some(25), FileProblem::Msh(MshProblem::ElementType(94))));
    let (line, problem) = fault(&v2.replace("$Elements\n4", "$Elements\n3"));
    assert_eq!((line, unexpected(&problem)), (Some(25), true));
    let (line, problem) = fault(&v4.replace("2 6 7 50", "2 5 7 50"));
    assert_eq!(
        (line, problem),
        (Some(28), FileProblem::Msh(MshProblem::Sum { what: "nodes", promised: 5, held: 6 }))
    );
    let (line, problem) = fault(&v2.replace("\"base\"", "base"));
    assert_eq!((line, unexpected(&problem)), (Some(9), true));
    let names = "$PhysicalNames\n2\n2 4 \"base\"\n0 1 \"base\"";
    let twice = v2.replace("$PhysicalNames\n1\n2 4 \"base\"", names).replace("15 2 0 1 50", "15 2 1 1 7");
    assert_eq!(fault(&twice), (None, FileProblem::Msh(MshProblem::SameName("base".into()))));
}

#[test]
fn other_versions_and_other_files_are_refused() {
    let v2 = text("hand_v2");
    for version in ["1", "2", "2.1", "4", "4.0", "5.0", "x"] {
        let (line, problem) = fault(&v2.replace("2.2 0 8", &format!("{version} 0 8")));
        assert_eq!((line, problem), (Some(5), FileProblem::Msh(MshProblem::Version(version.into()))));
    }
    assert_eq!(fault("$NOD\n1\n"), (Some(1), FileProblem::Msh(MshProblem::Version("1".into()))));
    assert_eq!(fault(&v2.replace("2.2 0 8", "2.2 2 8")).1, FileProblem::Msh(MshProblem::FileType(2)));
    assert_eq!(fault(&v2.replace("2.2 0 8", "2.2 0 4")).1, FileProblem::Msh(MshProblem::DataSize(4)));
    assert!(matches!(fault("solid cube\n").1, FileProblem::Msh(MshProblem::NotMsh(_))));
    assert!(matches!(fault("$Nodes\n").1, FileProblem::Msh(MshProblem::NotMsh(_))));
    assert_eq!(fault("").1, FileProblem::Msh(MshProblem::Empty));
    assert_eq!(fault(" \n").1, FileProblem::Msh(MshProblem::Empty));
    assert_eq!(fault("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n").1, FileProblem::Msh(MshProblem::NoTetrahedra));
    let partitioned = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PartitionedEntities\n";
    assert!(matches!(fault(partitioned).1, FileProblem::NotRead { .. }));
}

#[test]
fn missing_files_and_folders_are_refused() {
    let missing = read(&data("missing")).unwrap_err();
    assert!(matches!(missing.problem, FileProblem::Unreadable(_)));
    assert!(missing.to_string().contains("missing.msh: cannot be read"), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    let named_as_a_file = folder.path().join("a.msh");
    std::fs::create_dir(&named_as_a_file).unwrap();
    assert_eq!(read(&named_as_a_file).unwrap_err().problem, FileProblem::NotAFile);
}

#[test]
fn every_truncation_is_refused_or_loses_only_white_space() {
    for name in ["hand_v2", "hand_v4", "two_boxes_v2_binary", "two_boxes_v4_binary"] {
        let whole = bytes(name);
        let full = parsed(&whole).unwrap();
        for length in 0..whole.len() {
            match parsed(&whole[..length]) {
                Ok(file) => {
                    assert!(file == full && whole[length..].trim_ascii().is_empty(), "{name} {length}")
                }
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn no_damage_panics(
        name in prop::sample::select(vec![
            "hand_v2", "hand_v4", "two_boxes_v2_ascii", "two_boxes_v2_binary",
            "two_boxes_v4_ascii", "two_boxes_v4_binary", "one_box_parametric_v4_binary",
        ]),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4u8), 1..6),
    ) {
        let mut damaged = bytes(name);
        for (at, value, kind) in changes {
            let at = at.index(damaged.len());
            match kind {
                0 => damaged[at] = value,
                1 => damaged[at] = b"0123456789-+.eE \n$\"x"[usize::from(value) % 20],
                2 => damaged.insert(at, value),
                _ => { damaged.remove(at); }
            }
        }
        if let Err(error) = parsed(&damaged) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}
