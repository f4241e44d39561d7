//! Rock in a scene becomes blocks, and what is wrong with it is found at its place.

use std::path::Path;

use ndda_cli::wiring;
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
    wiring::blocks(&loaded.scene, Path::new(".")).unwrap_or_else(|e| panic!("{e:?}"))
}

fn volume_m3(blocks: &BlockSet) -> f64 {
    blocks.tets.iter().map(|t| tet_volume(&t.map(|n| blocks.rest_position[n.index()]))).sum()
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
    assert!(blocks.node_sets.iter().all(|sets| sets.contains_key("bed") && sets.contains_key("y_min")));
}

#[test]
fn a_pattern_holds_the_blocks_that_have_a_part_in_the_region() {
    let rest =
        "supports: [(block: \"rock_*\", on: Plane(point_m: (0, 0, 0), normal: (0, 0, 1)), hold: Fixed)],
                monitors: [(name: \"m\", block: \"rock_*\", at: Largest((1, 0, 0)))]";
    let loaded = load(COLUMN, rest);
    let mut simulation = wiring::simulation(&loaded.scene, blocks(&loaded), Path::new(".")).unwrap();
    let monitors = wiring::monitors(&loaded.scene, &simulation).unwrap();
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
        let blocks = wiring::blocks(&loaded.scene, Path::new(".")).unwrap();
        wiring::simulation(&loaded.scene, blocks, Path::new(".")).unwrap().unknowns()
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
    let faults = wiring::blocks(&load(&all_removed, "").scene, Path::new(".")).unwrap_err();
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
