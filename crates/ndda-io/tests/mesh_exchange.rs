//! Meshes go to meshio and Gmsh and come back the same.
//!
//! Needs a Python with the packages meshio and gmsh: `python3`, or the one that `NDDA_PYTHON` names. Without them the
//! test says so and passes, and without gmsh alone it goes on with meshio: `python3 -m venv v && v/bin/pip install meshio gmsh`, then
//! `NDDA_PYTHON=v/bin/python cargo test -p ndda-io --test mesh_exchange -- --nocapture`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use ndda_io::mesh_file::{read, write, write_polyhedra};
use ndda_mesh::cut::{Domain, VoronoiOptions, voronoi_blocks};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockMesh, Mat3, Vec3};

/// Formats that other programs write, and whether the two bodies are still distinguished in it.
const BACK: [(&str, bool); 14] = [
    ("meshio_zlib.vtu", true),
    ("meshio_plain.vtu", true),
    ("meshio_text.vtu", true),
    ("meshio_42.vtk", true),
    ("meshio_42_text.vtk", true),
    ("meshio_51.vtk", true),
    ("meshio.inp", false),
    ("meshio_41.msh", false),
    ("meshio_22.msh", false),
    ("meshio.node", true),
    ("gmsh_41.msh", true),
    ("gmsh_22.msh", true),
    ("gmsh.vtk", false),
    ("gmsh_binary.vtk", false),
];

fn bodies() -> Vec<(String, BlockMesh)> {
    let below = box_block([1.0, 1.0 / 3.0, 0.7], [2, 2, 1], BoxPattern::Six).unwrap();
    let above = box_block([1.0, 1.0, 0.1], [1, 2, 2], BoxPattern::TwentyFour).unwrap();
    let above = above.placed(&Mat3::identity(), &Vec3::new(0.0, 0.0, 1.0));
    vec![("below".into(), below), ("upper block".into(), above)]
}

/// The bodies as one list of nodes and tetrahedra.
fn joined(bodies: &[(String, BlockMesh)]) -> BlockMesh {
    let mut all = BlockMesh::default();
    for (_, mesh) in bodies {
        let first = all.nodes.len() as u32;
        all.nodes.extend(&mesh.nodes);
        all.tets.extend(mesh.tets.iter().map(|tet| tet.map(|node| node + first)));
    }
    all
}

/// A folder with the meshes and, for Python, the same as plain lists.
fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mesh_exchange");
    drop(fs::remove_dir_all(&folder));
    fs::create_dir_all(&folder).unwrap();
    let bodies = bodies();
    for ending in ["msh", "vtu", "inp", "node"] {
        write(&folder.join("a").with_extension(ending), &bodies).unwrap();
    }
    let domain = Domain::cuboid(Vec3::zeros(), Vec3::new(1.0, 2.0, 3.0)).unwrap();
    let seeds = [0.5, 1.0, 2.5].map(|z| Vec3::new(0.5, 1.0 + 0.1 * z, z));
    let cells = voronoi_blocks(&domain, &seeds, &VoronoiOptions::default()).unwrap();
    assert_eq!(cells.blocks.len(), 3);
    write_polyhedra(&folder.join("blocks.vtu"), &cells).unwrap();
    let all = joined(&bodies);
    let put = |name: &str, lines: Vec<String>| fs::write(folder.join(name), lines.join("\n") + "\n").unwrap();
    put("points.txt", all.nodes.iter().map(|x| format!("{:?} {:?} {:?}", x.x, x.y, x.z)).collect());
    put("tets.txt", all.tets.iter().map(|[a, b, c, d]| format!("{a} {b} {c} {d}")).collect());
    put("bodies.txt", bodies.iter().map(|(name, mesh)| format!("{} {name}", mesh.tets.len())).collect());
    let body = (0..2).flat_map(|i| vec![i.to_string(); bodies[i].1.tets.len()]).collect();
    put("body_of_tets.txt", body);
    let size = |set: &str| bodies.iter().map(|(_, mesh)| mesh.node_sets[set].len()).sum::<usize>();
    put("sets.txt", bodies[0].1.node_sets.keys().map(|set| format!("{} {set}", size(set))).collect());
    folder
}

#[test]
fn meshio_and_gmsh_read_the_same_meshes_and_write_them_back() {
    let folder = folder();
    let python = std::env::var("NDDA_PYTHON").unwrap_or_else(|_| "python3".into());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/mesh_exchange.py");
    let output = match Command::new(&python).arg(script).arg(&folder).output() {
        Ok(output) => output,
        Err(error) => {
            return println!("SKIPPED: {python} cannot be run ({error}); name a Python in NDDA_PYTHON");
        }
    };
    let text = String::from_utf8_lossy(&output.stdout);
    if output.status.code() == Some(3) {
        return println!("SKIPPED: {text}install meshio and gmsh, and name their Python in NDDA_PYTHON");
    }
    println!("{text}");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let expected = joined(&bodies());
    let has_gmsh = !text.contains("SKIPPED: Gmsh");
    for (name, tells_apart) in BACK.into_iter().filter(|(name, _)| has_gmsh || !name.starts_with("gmsh")) {
        let found = read(&folder.join(name)).unwrap_or_else(|error| panic!("{error}")).bodies;
        assert_eq!(found.len(), if tells_apart { 2 } else { 1 }, "{name}");
        let all = joined(&found);
        assert_eq!(all.tets, expected.tets, "{name}");
        let largest = all.nodes.iter().zip(&expected.nodes).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
        // meshio's texts have twelve digits.
        assert!(largest <= 1e-11, "{name}: nodes are off by {largest:e}");
        println!("ndda reads {name}: {} nodes, {} tetrahedra", all.nodes.len(), all.tets.len());
    }
}
