//! Meshes of other programs: files by hand, files of our own, damaged files.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use ndda_io::mesh_file::{FileProblem, MeshFileError, Place, read, write};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockMesh, Mat3, Vec3};
use proptest::prelude::*;
use proptest::sample::Index;

/// Endings of the formats that are read and written.
const ENDINGS: [&str; 4] = ["msh", "ele", "inp", "vtu"];

/// Two boxes that touch, with sets of the same names.
fn two_boxes() -> Vec<(String, BlockMesh)> {
    let below = box_block([1.0, 1.0 / 3.0, 0.7], [2, 2, 1], BoxPattern::Six).unwrap();
    let above = box_block([1.0, 1.0, 1e-3], [1, 2, 2], BoxPattern::TwentyFour).unwrap();
    let above = above.placed(&Mat3::identity(), &Vec3::new(1e5, 0.0, 0.7));
    vec![("below".into(), below), ("upper block".into(), above)]
}

/// The problem of the file, and its line.
fn fault(path: &Path) -> (Option<usize>, FileProblem) {
    let MeshFileError { place, problem, .. } = read(path).unwrap_err();
    let line = place.map(|place| match place {
        Place::Line(line) => line,
        Place::Byte(byte) => panic!("byte {byte} of a text"),
    });
    (line, problem)
}

/// The problem of an Abaqus file with that text.
fn inp(text: &str) -> (Option<usize>, FileProblem) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.inp");
    fs::write(&path, text).unwrap();
    fault(&path)
}

#[test]
fn what_is_written_is_read_back_bit_by_bit_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    for ending in ENDINGS {
        let path = folder.path().join("a").with_extension(ending);
        write(&path, &two_boxes()).unwrap();
        assert_eq!(read(&path).unwrap().bodies, two_boxes(), "{ending}");
    }
}

#[test]
fn legacy_files_keep_all_but_the_names_of_bodies() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtk");
    write(&path, &two_boxes()).unwrap();
    let found = read(&path).unwrap().bodies;
    assert_eq!(found.iter().map(|b| b.0.as_str()).collect::<Vec<_>>(), ["body_0", "body_1"]);
    for ((_, read), (_, written)) in found.iter().zip(&two_boxes()) {
        assert_eq!(read, written);
    }
}

const LEGACY: &str = "# vtk DataFile Version 3.0\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n\
    0 0 0 1 0 0 0 1 0 0 0 1 0 0 -1\nCELLS 3 14\n4 0 1 2 3\n4 0 2 1 4\n3 0 1 2\nCELL_TYPES 3\n10 10 5\n\
    CELL_DATA 3\nVECTORS v float\n0 0 0 0 0 0 0 0 0\nSCALARS Material int 1\nLOOKUP_TABLE default\n1 1 1\n\
    SCALARS block int\nLOOKUP_TABLE default\n7 5 5\nPOINT_DATA 5\nFIELD FieldData 1\nset:tip 1 5 int\n0 0 0 1 0\n";

#[test]
fn legacy_files_of_vtk_are_read_with_bodies_and_sets() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtk");
    fs::write(&path, LEGACY).unwrap();
    let bodies = read(&path).unwrap().bodies;
    assert_eq!(bodies.iter().map(|b| b.0.as_str()).collect::<Vec<_>>(), ["block_5", "block_7"]);
    assert_eq!((bodies[0].1.node_sets.len(), &bodies[1].1.node_sets["tip"]), (0, &vec![3]));
    fs::write(&path, LEGACY.replace("4 0 2 1 4", "4 0 2 1 5")).unwrap();
    assert!(matches!(fault(&path).1, FileProblem::NoSuchNode { node: 5, .. }));
    fs::write(&path, LEGACY.replace("10 10 5", "10 12 5")).unwrap();
    assert!(matches!(fault(&path).1, FileProblem::NotRead { .. }));
    fs::write(&path, LEGACY.replace("4 0 2 1 4", "4 0 x 1 4")).unwrap();
    assert!(matches!(fault(&path), (Some(9), FileProblem::Unexpected { .. })));
}

#[test]
fn files_that_would_not_be_read_back_are_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |ending: &str, bodies: &[(String, BlockMesh)]| {
        let path = folder.path().join("a").with_extension(ending);
        let text = write(&path, bodies).unwrap_err().to_string();
        assert!(!path.exists());
        text
    };
    for ending in ENDINGS {
        let [a, b] = [0, 1].map(|i| two_boxes()[i].1.clone());
        assert!(refused(ending, &[]).contains("no tetrahedra"));
        assert!(refused(ending, &[("a".into(), a.clone()), ("a".into(), b)]).contains("rename one"));
        assert!(refused(ending, &[("a\n".into(), a.clone())]).contains("rename it"));
        let mut bad = a.clone();
        bad.nodes[3].y = f64::NAN;
        assert!(refused(ending, &[("a".into(), bad)]).starts_with("node[3] is not a finite number"));
        let mut bad = a;
        bad.tets[0][1] = 1000;
        assert!(refused(ending, &[("a".into(), bad)]).contains("no node 1000"));
    }
    assert!(refused("stl", &two_boxes()).contains("not a format"));
}

const TETRAHEDRON: &str =
    "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1.0D+0, 0\n9, 0, 0, 1\n*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 9\n";

#[test]
fn an_abaqus_file_without_sets_is_one_body() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.INP");
    fs::write(&path, TETRAHEDRON).unwrap();
    let bodies = read(&path).unwrap().bodies;
    assert_eq!((bodies[0].0.as_str(), &bodies[0].1.tets[..]), ("body", &[[0, 1, 2, 3]][..]));
    assert_eq!(bodies[0].1.nodes[2], Vec3::y());
}

#[test]
fn sets_of_abaqus_are_bodies_by_section_and_node_sets_by_surface_element() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.inp");
    let sets = "*ELEMENT, TYPE=S3, ELSET=shell\n20, 1, 2, 3\n*ELSET, elset=All, generate\n7, 7, 1\n\
                *Elset, elset=\"my rock\"\nall\n*NSET, nset=TIP\n9,\n*ELSET, ELSET=base\nSHELL\n";
    fs::write(&path, format!("{TETRAHEDRON}{sets}*SOLID SECTION, ELSET=\"MY ROCK\",\nMATERIAL=granite\n,\n"))
        .unwrap();
    let bodies = read(&path).unwrap().bodies;
    assert_eq!(bodies.len(), 1);
    assert_eq!(bodies[0].0, "my rock");
    let sets = &bodies[0].1.node_sets;
    assert_eq!(sets.keys().collect::<Vec<_>>(), ["TIP", "base", "shell"]);
    assert_eq!((&sets["TIP"], &sets["base"]), (&vec![3], &vec![0, 1, 2]));
}

#[test]
fn defects_of_abaqus_files_are_named_with_their_line() {
    let edit = |from: &str, to: &str| inp(&TETRAHEDRON.replace(from, to));
    let (line, problem) = edit("7, 1, 2, 3, 9", "7, 1, 2, 3, 8");
    assert_eq!((line, problem), (Some(7), FileProblem::NoSuchNode { what: "element 7".into(), node: 8 }));
    assert_eq!(edit("9, 0, 0, 1", "9, 0, nan, 1").0, Some(5));
    assert_eq!(edit("9, 0, 0, 1", "9, 0, 1e400, 1").0, Some(5));
    assert_eq!(edit("9, 0, 0, 1", "3, 0, 0, 1"), (Some(5), FileProblem::Twice { what: "node", id: 3 }));
    assert!(matches!(edit("C3D4", "C3D10"), (Some(6), FileProblem::NotRead { .. })));
    assert_eq!(edit("7, 1, 2, 3, 9", "7, 1, 2, 3").0, Some(7));
    assert_eq!(inp("*NODE\n"), (None, FileProblem::NoTetrahedra));
    let twice = "*ELSET, ELSET=a\n7\n*ELSET, ELSET=b\n7\n*ELEMENT, TYPE=C3D4\n8, 1, 2, 3, 9\n";
    assert!(matches!(inp(&format!("{TETRAHEDRON}{twice}")).1, FileProblem::InTwoBodies { element: 7, .. }));
}

#[test]
fn tetgen_counts_from_0_or_1_and_its_markers_are_sets() {
    let folder = tempfile::tempdir().unwrap();
    let path = |ending: &str| folder.path().join("a.1").with_extension(format!("1.{ending}"));
    let put = |ending: &str, text: &str| fs::write(path(ending), text).unwrap();
    put("node", "# made by hand\n5  3  0  1\n1 0 0 0 1\n2 1 0 0 1\n3 0 1 0 1\n4 0 0 1 1\n5 0 0 -1 1\n");
    put("ele", "2 4 1\n1 1 2 3 4 20\n2 1 3 2 5 10.0 # below\n");
    put("face", "2 1\n1 1 2 3 7\n2 1 2 4 0\n");
    let bodies = read(&path("node")).unwrap().bodies;
    assert_eq!(bodies.iter().map(|b| b.0.as_str()).collect::<Vec<_>>(), ["region_10", "region_20"]);
    assert!(bodies.iter().all(|(_, mesh)| mesh.node_sets["face_7"] == [0, 1, 2]));
    put("ele", "2 4 0\n1 1 2 3 4\n2 1 3 2 6\n");
    assert!(matches!(fault(&path("ele")), (Some(3), FileProblem::NoSuchNode { node: 6, .. })));
    put("ele", "2000000 4 0\n1 1 2 3 4\n2 1 3 2 6\n");
    assert!(matches!(fault(&path("ele")).1, FileProblem::TooShort { count: 2_000_000, .. }));
}

#[test]
fn other_endings_missing_files_and_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(fault(Path::new("a.dwg")).1, FileProblem::Extension { .. }));
    assert!(matches!(fault(&folder.path().join("a.inp")).1, FileProblem::Unreadable(_)));
    fs::create_dir(folder.path().join("a.inp")).unwrap();
    assert_eq!(fault(&folder.path().join("a.inp")).1, FileProblem::NotAFile);
}

/// The message for `a.ending` with that text; `.ele` has a `.node` of four corners beside it.
fn said(ending: &str, text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.node"), CORNERS).unwrap();
    let path = folder.path().join("a").with_extension(ending);
    fs::write(&path, text).unwrap();
    read(&path).unwrap_err().to_string()
}

const CORNERS: &str = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n";
const VTU: &str = "<?xml version='1.0'?><VTKFile type='UnstructuredGrid' version='0.1'><UnstructuredGrid>\
    <Piece NumberOfPoints='4' NumberOfCells='1'><Points><DataArray type='Float32' NumberOfComponents='3' format='ascii'>\
    0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray type='Int32' Name='connectivity' format='ascii'>0 1 2 3\
    </DataArray><DataArray type='Int32' Name='offsets' format='ascii'>4</DataArray>\
    <DataArray type='UInt8' Name='types' format='ascii'>10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";

#[test]
fn a_node_beyond_the_last_one_is_refused_also_in_a_second_piece() {
    let from = VTU.find("<Piece").unwrap();
    let to = VTU.find("</UnstructuredGrid>").unwrap();
    for index in ["18446744073709551615", "-1", "4", "2.5"] {
        let piece = VTU[from..to].replace("0 1 2 3", &format!("0 1 2 {index}"));
        for pieces in [piece.clone(), format!("{}{piece}", &VTU[from..to])] {
            let text = VTU.replace(&VTU[from..to], &pieces).replace("'Int32'", "'Float64'");
            let error = said("vtu", &text);
            assert!(error.contains("node") || error.contains("cell"), "{index}: {error}");
        }
    }
}

#[test]
fn components_that_are_no_number_are_refused() {
    let error = said("vtk", &LEGACY.replace("SCALARS Material int 1", "SCALARS Material int 1x"));
    assert!(error.contains("the number of components"), "{error}");
}

#[test]
fn a_folder_with_the_name_of_a_mesh_is_no_mesh() {
    let folder = tempfile::tempdir().unwrap();
    for ending in ["msh", "node", "ele", "inp", "vtu", "vtk"] {
        let path = folder.path().join("a").with_extension(ending);
        fs::create_dir(&path).unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(error.contains("is not a file"), "{error}");
    }
}

#[test]
fn a_header_that_promises_a_million_million_is_refused_before_memory_is_taken() {
    let huge = "1000000000000";
    for (ending, text) in [
        ("ele", format!("{huge} 4 0\n0 0 1 2 3\n")),
        ("node", CORNERS.replacen('4', huge, 1)),
        ("vtk", LEGACY.replace("POINTS 5", &format!("POINTS {huge}"))),
        ("vtk", LEGACY.replace("CELLS 3 14", &format!("CELLS {huge} 14"))),
        ("vtk", LEGACY.replace("CELLS 3 14", &format!("CELLS 3 {huge}"))),
    ] {
        let error = said(ending, &text);
        // The numbers of a point count one by one.
        assert!(error.contains("000000000000 ") && error.contains("damaged"), "{ending}: {error}");
    }
    for count in ["NumberOfPoints='4'", "NumberOfCells='1'"] {
        let name = count.split('=').next().unwrap();
        let error = said("vtu", &VTU.replace(count, &format!("{name}='{huge}'")));
        assert!(error.contains(huge), "{error}");
    }
}

#[test]
fn files_of_triangles_only_are_no_blocks() {
    for (ending, text) in [
        (
            "vtk",
            LEGACY
                .replace("CELLS 3 14\n4 0 1 2 3\n4 0 2 1 4", "CELLS 3 12\n3 0 1 2\n3 0 2 1")
                .replace("10 10 5", "5 5 5"),
        ),
        ("vtu", VTU.replace("0 1 2 3", "0 1 2").replace(">4<", ">3<").replace(">10<", ">5<")),
        ("inp", "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n*ELEMENT, TYPE=S3\n1, 1, 2, 3\n".to_string()),
        ("ele", "0 4 0\n".to_string()),
    ] {
        let error = said(ending, &text);
        assert!(error.contains("holds no tetrahedra"), "{ending}: {error}");
    }
}

#[test]
fn nodes_that_are_missing_are_named_and_those_of_no_tetrahedron_left_out() {
    assert!(said("ele", "1 4 0\n0 0 1 2 9\n").contains("node 9"));
    assert!(said("vtu", &VTU.replace("0 1 2 3", "0 1 2 9")).contains("node 9"));
    assert!(said("vtk", &LEGACY.replace("4 0 2 1 4", "4 0 2 1 9")).contains("node 9"));
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.node"), CORNERS.replacen('4', "5", 1) + "4 9 9 9\n").unwrap();
    fs::write(folder.path().join("a.ele"), "1 4 0\n0 0 1 2 3\n").unwrap();
    let bodies = read(&folder.path().join("a.ele")).unwrap().bodies;
    assert_eq!(bodies[0].1.nodes.len(), 4);
}

/// Names and contents of the files of two boxes in every format.
static FILES: LazyLock<Vec<(String, Vec<u8>)>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let mesh = box_block([1.0; 3], [1; 3], BoxPattern::Six).unwrap();
    for ending in ENDINGS {
        let path = folder.path().join("a").with_extension(ending);
        write(&path, &[("a".into(), mesh.clone()), ("b".into(), mesh.clone())]).unwrap();
    }
    fs::write(folder.path().join("b.vtk"), LEGACY).unwrap();
    let entries = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap());
    let content = |e: fs::DirEntry| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap());
    let mut files: Vec<_> = entries.map(content).collect();
    files.sort();
    files
});

/// Changes bytes, as a bad disk or editor does.
fn damage(bytes: &mut Vec<u8>, changes: &[(Index, u8, u8)], cut: Option<Index>) {
    for &(at, value, kind) in changes {
        let at = at.index(bytes.len());
        match kind {
            0 => bytes[at] = value,
            1 => bytes[at] = b"0123456789-+.eE \n$\"x*,<>=#"[usize::from(value) % 26],
            2 => bytes.insert(at, value),
            _ => drop(bytes.remove(at)),
        }
    }
    if let Some(cut) = cut {
        bytes.truncate(cut.index(bytes.len()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]
    #[test]
    fn no_damage_panics(
        which in any::<Index>(),
        changes in prop::collection::vec((any::<Index>(), any::<u8>(), 0..4u8), 1..6),
        cut in prop::option::weighted(0.2, any::<Index>()),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let damaged = which.index(FILES.len());
        for (i, (name, content)) in FILES.iter().enumerate() {
            let mut content = content.clone();
            if i == damaged {
                damage(&mut content, &changes, cut);
            }
            fs::write(folder.path().join(name), content).unwrap();
        }
        match read(&folder.path().join(&FILES[damaged].0)) {
            Ok(file) => prop_assert!(file.bodies.iter().all(|(_, mesh)| !mesh.tets.is_empty())),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}
