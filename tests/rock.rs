//! Rock in a scene becomes blocks, and what is wrong with it is found at its place.

use std::path::Path;

use ndda::build;
use ndda_io::read::{LoadedScene, load_text};
use ndda_mesh::BlockSet;
use ndda_mesh::geometry::tet_volume;

fn scene(rock: &str, rest: &str) -> String {
    format!(
        "(title: \"t\", time: (step_s: 1e-4, end_s: 0.01), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
          rock: [{rock}], contact: Potential(penalty_pa: 1e8, potential: Smooth()), {rest})"
    )
}

fn load(rock: &str, rest: &str) -> LoadedScene {
    load_text("t.ron", &scene(rock, rest), &[], None).unwrap_or_else(|e| panic!("{e}"))
}

fn blocks(loaded: &LoadedScene) -> BlockSet {
    build::blocks(&loaded.scene, Path::new(".")).unwrap_or_else(|e| panic!("{e:?}"))
}

fn volume_m3(blocks: &BlockSet) -> f64 {
    blocks.tets.iter().map(|t| tet_volume(&t.map(|n| blocks.rest_position[n.index()]))).sum()
}

fn has_set(blocks: &BlockSet, block: ndda_mesh::BlockId, name: &str) -> bool {
    blocks.node_sets_of(block).any(|(known, _)| known == name)
}

const COLUMN: &str = "(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (4, 4, 8)), fill: Centre,
    joints: [Set(name: \"bed\", dip_deg: 0, dip_direction_deg: 0, spacing_m: 2),
             Set(name: \"up\", dip_deg: 90, dip_direction_deg: 90, spacing_m: 2)])";

#[test]
fn a_column_cut_by_two_sets_gives_named_blocks_with_the_sets_of_their_joints() {
    let blocks = blocks(&load(COLUMN, ""));
    assert_eq!(blocks.len(), 8);
    assert_eq!(blocks.names[0], "rock_0001");
    assert!((volume_m3(&blocks) - 128.0).abs() < 1e-9);
    assert!(blocks.ids().all(|block| has_set(&blocks, block, "bed") && has_set(&blocks, block, "y_min")));
}

#[test]
fn a_pattern_holds_the_blocks_that_have_a_part_in_the_region() {
    let rest =
        "supports: [(block: \"rock_*\", on: Plane(point_m: (0, 0, 0), normal: (0, 0, 1)), hold: Fixed)],
                monitors: [(name: \"m\", block: \"rock_*\", at: Largest((1, 0, 0)))]";
    let loaded = load(COLUMN, rest);
    let mut simulation = build::simulation(&loaded.scene, blocks(&loaded), Path::new(".")).unwrap();
    let monitors = build::monitors(&loaded.scene, &simulation).unwrap();
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    let blocks = simulation.blocks();
    let (now, start) = (&simulation.state().position, simulation.start_position());
    let held = (0..now.len()).filter(|&n| (blocks.rest_position[n] + blocks.origin_m).z == 0.0);
    assert_eq!(held.filter(|&n| (now[n] - start[n]).norm() > 1e-15).count(), 0);
    let largest = (0..now.len()).map(|n| now[n].x - start[n].x).fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(monitors[0].displacement(&simulation).x, largest);
}

#[test]
fn removed_blocks_are_gone_and_fixed_ones_stay() {
    let rock = COLUMN.replace(
        "fill: Centre,",
        "fill: Centre, removed: [Inside(min_m: (0, 0, 6), max_m: (2, 4, 8))],
         fixed: [Beyond(point_m: (0, 0, 2), normal: (0, 0, -1))],",
    );
    let loaded = load(&rock, "");
    let blocks = blocks(&loaded);
    assert_eq!(blocks.len(), 7);
    assert!((volume_m3(&blocks) - 112.0).abs() < 1e-9);
    let unknowns = |scene: &str| {
        let loaded = load(scene, "");
        let blocks = build::blocks(&loaded.scene, Path::new(".")).unwrap();
        build::simulation(&loaded.scene, blocks, Path::new(".")).unwrap().unknowns()
    };
    // Eight blocks of nine nodes; one is gone and two are fixed.
    assert_eq!(unknowns(COLUMN), 8 * 27);
    assert_eq!(unknowns(&rock), 5 * 27);
}

#[test]
fn other_domains_fill_their_volume() {
    for (domain, volume) in [
        ("Column(outline_m: [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], start_m: 0, end_m: 3)", 9.0),
        (
            "Polyhedron(corners_m: [(0, 0, 0), (3, 0, 0), (0, 3, 0), (0, 0, 3)],
                        faces: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])",
            4.5,
        ),
        ("Terrain(origin_m: (0, 0), step_m: (1, 1), heights_m: [[1, 1, 1], [1, 1, 1]], base_m: -1)", 4.0),
    ] {
        let blocks = blocks(&load(&format!("(material: \"rock\", domain: {domain})"), ""));
        assert!((volume_m3(&blocks) - volume).abs() < 1e-9, "{domain}: {}", volume_m3(&blocks));
    }
    let cells = "(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (2, 2, 2)), voronoi: (count: 20), seed: 3)";
    let blocks = blocks(&load(cells, ""));
    assert_eq!(blocks.len(), 20);
    assert!((volume_m3(&blocks) - 8.0).abs() < 1e-9);
}

#[test]
fn each_shape_of_a_block_has_its_volume() {
    let hexahedron = "Hexahedron(corners_m: ((0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0),
                                             (0, 0, 1), (2, 0, 1), (2, 1, 1), (0, 1, 1)), cells: (1, 1, 1))";
    let voussoir = "Voussoir(inner_radius_m: 1, outer_radius_m: 2, start_deg: 0, end_deg: 10, width_m: 1, cells: (1, 1, 8))";
    let tetrahedron = "Polyhedron(corners_m: [(0, 0, 0), (3, 0, 0), (0, 3, 0), (0, 0, 3)],
                                  faces: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], fill: Centre)";
    for (shape, volume, tolerance) in [
        (hexahedron, 2.0, 1e-12),
        (voussoir, 1.5 * 10f64.to_radians(), 1e-4),
        ("Cylinder(radius_m: 1, height_m: 2, cells: (8, 2))", std::f64::consts::TAU, 0.03),
        ("Sphere(radius_m: 1, levels: 3)", std::f64::consts::TAU / 1.5, 0.2),
        (tetrahedron, 4.5, 1e-12),
    ] {
        let text = format!(
            "(title: \"t\", time: (step_s: 1e-4, end_s: 0.01), blocks: [(name: \"b\", material: \"rock\", shape: {shape})],
              materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)])"
        );
        let loaded = load_text("t.ron", &text, &[], None).unwrap_or_else(|e| panic!("{e}"));
        let found = volume_m3(&blocks(&loaded));
        assert!((found - volume).abs() < tolerance, "{shape}: {found}");
    }
}

#[test]
fn what_is_wrong_with_a_rock_is_found_at_its_place() {
    let domain = "domain: Box(min_m: (0, 0, 0), max_m: (1, 1, 1))";
    for (rock, path) in [
        (format!("(material: \"rick\", {domain})"), "rock[0].material"),
        (
            "(material: \"rock\", domain: Box(min_m: (0, 0, 2), max_m: (1, 1, 1)))".into(),
            "rock[0].domain.max_m[2]",
        ),
        (format!("(material: \"rock\", {domain}, voronoi: (count: 0))"), "rock[0].voronoi.count"),
        (
            format!(
                "(material: \"rock\", {domain}, joints: [Set(name: \"a\", dip_deg: 91, dip_direction_deg: 0, spacing_m: 1)])"
            ),
            "rock[0].joints[0].dip_deg",
        ),
        (
            format!(
                "(material: \"rock\", {domain}, joints: [Set(name: \"a\", dip_deg: 9, dip_direction_deg: 0, spacing_m: 0)])"
            ),
            "rock[0].joints[0].spacing_m",
        ),
        (format!("(material: \"rock\", {domain}, fill: Size(size_m: -1))"), "rock[0].fill.size_m"),
        (format!("(material: \"rock\", {domain}, into: Tetrahedra(size_m: 0))"), "rock[0].into.size_m"),
        (
            format!("(material: \"rock\", {domain}, fill: Centre, into: Tetrahedra(size_m: 1))"),
            "rock[0].into",
        ),
        (
            format!(
                "(material: \"rock\", {domain}, body: Rigid, into: Tetrahedra(size_m: 1, compensate: true))"
            ),
            "rock[0].into.compensate",
        ),
        (
            format!("(material: \"rock\", {domain}, fixed: [Beyond(point_m: (0, 0, 0), normal: (0, 0, 0))])"),
            "rock[0].fixed[0].normal",
        ),
    ] {
        let errors = load_text("t.ron", &scene(&rock, ""), &[], None).unwrap_err();
        let found = errors.diagnostics.iter().find(|d| d.path == path);
        assert!(found.is_some_and(|d| d.span.is_some()), "{path}: {errors}");
    }
    let all_removed =
        format!("(material: \"rock\", {domain}, removed: [Beyond(point_m: (0, 0, 0), normal: (0, 0, 1))])");
    let faults = build::blocks(&load(&all_removed, "").scene, Path::new(".")).unwrap_err();
    assert_eq!(faults[0].path, "rock[0].removed");
}

#[test]
fn a_star_stands_for_anything() {
    use ndda_io::scene::matches;
    assert!(
        matches("rock_*", "rock_0001") && matches("*", "") && matches("a*c*", "abcd") && matches("a", "a")
    );
    assert!(!matches("rock_*", "base") && !matches("a*c", "abcd") && !matches("a", "ab"));
}

/// Triangles whose corners are all on joints of one name, but which lie across them, are not part of the joint.
#[test]
fn faces_know_their_joint_where_nodes_do_not() {
    let blocks = blocks(&load(&COLUMN.replace("fill: Centre", "fill: Fewest"), ""));
    let area = |upright: bool, surface: &str| -> f64 {
        let index = blocks.surface_names.iter().position(|name| name == surface).map(|i| i as u32);
        let own = |t: &usize| index.is_some() && blocks.triangle_surface[*t] == index;
        let normals = (0..blocks.triangles.len()).filter(own).map(|t| {
            let corners = blocks.triangles[t].map(|n| blocks.rest_position[n.index()]);
            ndda_mesh::geometry::triangle_area_vector(&corners)
        });
        normals.filter(|n| (n.z.abs() > 0.5 * n.norm()) == upright).map(|n| n.norm()).sum()
    };
    // Three planes inside and the top and bottom of the domain; `up` cuts once, over 8 m by 4 m.
    assert!((area(true, "bed") - 3.0 * 2.0 * 16.0).abs() < 1e-9 && area(false, "bed") == 0.0);
    assert!((area(false, "up") - 2.0 * 32.0).abs() < 1e-9 && area(true, "up") == 0.0);
    let (_, set) = blocks.node_sets_of(ndda_mesh::BlockId(0)).find(|(name, _)| *name == "bed").unwrap();
    let on_set = |t: &&[ndda_mesh::NodeId; 3]| t.iter().all(|n| set.contains(n));
    let in_first = blocks.triangles_of(ndda_mesh::BlockId(0));
    let tagged = blocks.triangle_surface[in_first.clone()]
        .iter()
        .filter(|s| s.is_some_and(|s| blocks.surface_names[s as usize] == "bed"))
        .count();
    assert!(blocks.triangles[in_first].iter().filter(on_set).count() >= tagged);
}

const WEDGE_MM: &str = "o rock\nv 0 0 0\nv 2000 0 0\nv 0 2000 0\nv 0 0 1000\nusemtl floor\nf 1 3 2\n\
                             usemtl wall\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn in_folder(file: &str, content: &str, scene: &str) -> Result<BlockSet, String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(file), content).unwrap();
    let loaded = load_text("t.ron", scene, &[], Some(folder.path())).map_err(|e| e.to_string())?;
    build::blocks(&loaded.scene, folder.path()).map_err(|faults| format!("{faults:?}"))
}

#[test]
fn a_surface_in_a_file_is_rock_that_is_cut_in_metres() {
    let rock = "(material: \"rock\", domain: File(file: \"a.obj\", unit_m: 1e-3),
                 joints: [Plane(name: \"cut\", dip_deg: 0, dip_direction_deg: 0, point_m: (0, 0, 0.5))])";
    let blocks = in_folder("a.obj", WEDGE_MM, &scene(rock, "")).unwrap();
    assert_eq!(blocks.len(), 2);
    // ⅙ · 2 · 2 · 1 m³.
    assert!((volume_m3(&blocks) - 2.0 / 3.0).abs() < 1e-12);
    assert!(blocks.ids().any(|block| has_set(&blocks, block, "floor")));
}

#[test]
fn what_is_wrong_with_a_surface_is_said() {
    let rock = |file: &str| format!("(material: \"rock\", domain: File(file: \"{file}\"))");
    let said = |content: &str| in_folder("a.obj", content, &scene(&rock("a.obj"), "")).unwrap_err();
    let open = said(&WEDGE_MM.replace("f 2 3 4\n", ""));
    assert!(open.contains("not closed: 3 edges"), "{open}");
    // A second shell that reaches into the first.
    let second = "v 100 100 100\nv 2100 100 100\nv 100 2100 100\nv 100 100 1100\n\
                  f 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n";
    let crossed = said(&(WEDGE_MM.to_string() + second));
    assert!(crossed.contains("cuts itself") || crossed.contains("cut itself"), "{crossed}");
    let inside_out = WEDGE_MM.replace("f 2 3 4", "f 2 4 3");
    assert!(said(&inside_out).contains("all faces outward"), "{}", said(&inside_out));
    let missing = in_folder("b.obj", "", &scene(&rock("a.obj"), "")).unwrap_err();
    assert!(missing.contains("there is no file"), "{missing}");
}

fn filled(fill: &str) -> Result<BlockSet, String> {
    let scene = format!(
        "(title: \"t\", time: (step_s: 1e-4, end_s: 0.01),
          materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [(name: \"a\", material: \"rock\", shape: Surface(file: \"a.obj\", unit_m: 1e-3, fill: {fill}))])"
    );
    in_folder("a.obj", WEDGE_MM, &scene)
}

#[test]
fn a_surface_is_filled_finer_towards_a_point() {
    let coarse = filled("Size(size_m: 0.4)").unwrap();
    let finer =
        filled("Size(size_m: 0.4, finer: [(towards: Point((2, 0, 0)), size_m: 0.05, growth: 0.4)])").unwrap();
    let plane = filled(
        "Size(size_m: 0.4, finer: [(towards: Plane(point_m: (0, 0, 0), normal: (0, 0, 1)), size_m: 0.05)])",
    )
    .unwrap();
    let counts = [&coarse, &finer, &plane].map(|blocks| blocks.tets.len());
    assert!(counts[0] < counts[1] && 2 * counts[0] < counts[2], "{counts:?}");
    assert!((volume_m3(&finer) - 2.0 / 3.0).abs() < 1e-12);
    let near = |blocks: &BlockSet| {
        let at = ndda_mesh::Vec3::new(2.0, 0.0, 0.0) - blocks.origin_m;
        blocks.rest_position.iter().filter(|x| (*x - at).norm() < 0.3).count()
    };
    assert!(near(&finer) > 5 * near(&coarse), "{} and {}", near(&finer), near(&coarse));
    assert!(
        filled("Size(size_m: 0.4, finer: [(towards: Point((2, 0, 0)), size_m: 0)])")
            .unwrap_err()
            .contains("size_m")
    );
}

#[test]
fn tetgen_fills_where_the_program_has_it_and_is_missed_by_name_where_not() {
    match filled("TetGen(size_m: 0.3)") {
        Ok(blocks) => assert!((volume_m3(&blocks) - 2.0 / 3.0).abs() < 1e-9 && blocks.tets.len() > 50),
        Err(message) => assert!(message.contains("without TetGen"), "{message}"),
    }
}

#[test]
fn a_mesh_that_is_there_has_no_size() {
    let scene = "(title: \"t\", time: (step_s: 1e-4, end_s: 0.01),
          materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [(name: \"a\", material: \"rock\", shape: Mesh(file: \"a.msh\", size_m: 0.1))])";
    let message = in_folder("a.msh", "", scene).unwrap_err();
    assert!(message.contains("a mesh in a file is as fine as it is"), "{message}");
}

#[test]
fn terrain_from_a_file_in_coordinates_of_a_map_is_that_of_the_same_heights_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let grid = "ncols 3\nnrows 3\nxllcenter 2600000\nyllcenter 1200000\ncellsize 2\nNODATA_value -9999\n7 8 9\n4 5 6\n1 2 3.5\n";
    let built = |domain: &str| {
        let loaded = load(&format!("(material: \"rock\", domain: {domain})"), "");
        build::blocks(&loaded.scene, folder.path()).map_err(|faults| format!("{faults:?}"))
    };
    let file = "TerrainFile(file: \"hill.asc\", origin_m: (2600000, 1200000), base_m: -1)";
    assert!(built(file).unwrap_err().contains("hill.asc"));
    std::fs::write(folder.path().join("hill.asc"), grid).unwrap();
    let heights = "heights_m: [[1, 2, 3.5], [4, 5, 6], [7, 8, 9]]";
    let same = format!("Terrain(origin_m: (0, 0), step_m: (2, 2), {heights}, base_m: -1)");
    let [read, given] = [file, same.as_str()].map(|domain| built(domain).unwrap());
    assert_eq!((&read.rest_position, &read.tets), (&given.rest_position, &given.tets));
    let sets = |blocks: &BlockSet| {
        let of = |block| {
            blocks
                .node_sets_of(block)
                .map(|(name, nodes)| (name.to_string(), nodes.to_vec()))
                .collect::<Vec<_>>()
        };
        blocks.ids().map(of).collect::<Vec<_>>()
    };
    assert_eq!((sets(&read), read.origin_m), (sets(&given), given.origin_m));
    // Without a height in the north-eastern corner its cell is left out.
    std::fs::write(folder.path().join("hill.asc"), grid.replace("8 9", "8 -9999")).unwrap();
    let whole_m3 = volume_m3(&given);
    let corner_m3 = 2.0 * ((5.0 + 6.0 + 9.0) + (5.0 + 9.0 + 8.0)) / 3.0 + 4.0;
    assert!((whole_m3 - volume_m3(&built(file).unwrap()) - corner_m3).abs() < 1e-9);
    std::fs::write(folder.path().join("hill.asc"), grid.replace("5 6", "-9999 6")).unwrap();
    assert!(built(file).unwrap_err().contains("fewer gaps"));
}

#[test]
fn rock_comes_apart_into_blocks_of_one_element_and_keeps_the_names_of_its_joints() {
    let rock = COLUMN.replace("fill: Centre,", "into: Tetrahedra(size_m: 1.5),");
    let blocks = blocks(&load(&rock, ""));
    assert_eq!(blocks.len(), blocks.tets.len());
    assert!(blocks.len() > 8 * 12, "{}", blocks.len());
    assert!((volume_m3(&blocks) - 128.0).abs() < 1e-9);
    for name in ["bed", "up", "tetrahedra", "z_max"] {
        assert!(blocks.surface_names.iter().any(|known| known == name), "{name}");
    }
    assert!(blocks.triangle_surface.iter().all(Option::is_some));
}

/// Rock whose pieces are to be made stiffer, with a law between them; what is wrong with it.
fn refused(penalty_pa: &str, friction: &str) -> String {
    let text = scene(
        "(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (1, 1, 1)), into: Tetrahedra(size_m: 0.5, compensate: true))",
        "",
    );
    let law = format!(
        "penalty_pa: {penalty_pa}, potential: Smooth(), rock_joints: [(joint: \"tetrahedra\", friction: ({friction}))]"
    );
    let text = text.replace("penalty_pa: 1e8, potential: Smooth()", &law);
    let loaded = load_text("t.ron", &text, &[], None).unwrap_or_else(|e| panic!("{e}"));
    let blocks = blocks(&loaded);
    let faults = build::simulation(&loaded.scene, blocks, Path::new(".")).map(drop).unwrap_err();
    assert_eq!(faults[0].path, "rock[0].into.compensate");
    faults[0].message.clone()
}

#[test]
fn bonds_that_cannot_be_made_up_for_are_refused_with_what_to_change() {
    let message = refused("1e11", "friction_deg: 30");
    assert!(message.contains("nothing holds") && message.contains("cohesion_pa or tension_pa"), "{message}");
    let bond = |shear: &str| {
        format!("friction_deg: 30, shear_penalty_pa_m: {shear}, cohesion_pa: 1e6, tension_pa: 1e6")
    };
    let message = refused("1e11", &bond("1e12"));
    assert!(message.contains("give penalty_pa: 5e11"), "{message}");
    let message = refused("5e9", &bond("1e10"));
    assert!(
        message.contains("too soft") && message.contains("a shear_penalty_pa_m of at least"),
        "{message}"
    );
}
