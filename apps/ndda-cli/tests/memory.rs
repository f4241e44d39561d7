//! A scene that does not fit into memory is refused with its figures before it is built; one that fits takes about the memory that was foreseen.

#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::{Command, Output};

const RESOURCE: i32 = 6;

fn scene(parts: &str) -> String {
    format!(
        "(title: \"m\", time: (step_s: 1e-5, end_s: 1e-4), contact: Potential(penalty_pa: 1e7), output: (frames: 0),
          materials: [(name: \"r\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)], {parts})"
    )
}

fn cube(cells: u32, more: &str) -> String {
    scene(&format!(
        "blocks: [(name: \"a\", material: \"r\", shape: Box(size_m: (1, 1, 1), cells: ({cells}, {cells}, {cells})), {more})]"
    ))
}

/// A box of rock with edges of `size_m`.
fn rock(size_m: f64, cut: &str) -> String {
    scene(&format!(
        "rock: [(name: \"c\", material: \"r\", domain: Box(min_m: (0, 0, 0), max_m: ({size_m}, {size_m}, {size_m})), {cut})]"
    ))
}

/// Three sets at right angles.
fn sets(spacing_m: f64, more: &str) -> String {
    let set = |name: &str, dip_deg: u32, direction_deg: u32| {
        format!(
            "Set(name: \"{name}\", dip_deg: {dip_deg}, dip_direction_deg: {direction_deg}, spacing_m: {spacing_m}, {more}),"
        )
    };
    format!("joints: [{}{}{}]", set("a", 90, 90), set("b", 90, 0), set("d", 0, 0))
}

/// `ndda` with 8 GB of addresses, as `ulimit -v` gives them.
fn ndda(folder: &Path, text: &str, arguments: &[&str]) -> Output {
    let file = folder.join("scene.ron");
    std::fs::write(&file, text).expect("a scene");
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 8000000; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_ndda")]);
    command.args(arguments).arg(&file).output().expect("the program starts")
}

#[test]
fn what_does_not_fit_is_refused_with_its_figures_and_nothing_is_built() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |text: &str, arguments: &[&str], words: &[&str]| {
        let output = ndda(folder.path(), text, arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(RESOURCE), "{text}: {said}");
        assert!(words.iter().all(|word| said.contains(word)), "{words:?} in: {said}");
    };
    let check = ["check"];
    refused(&cube(300, ""), &check, &["too-large", "blocks[0].shape", "1.6e8 tetrahedra", "use fewer cells"]);
    refused(&cube(300, "body: Rigid"), &check, &["1.6e8 tetrahedra"]);
    refused(&rock(100.0, &sets(1.0, "")), &check, &["rock[0].joints", "1.0e6 blocks", "wider spacings"]);
    refused(&rock(1000.0, &sets(1.0, "")), &check, &["rock[0].joints", "1.0e9 blocks"]);
    refused(
        &rock(1.0, "voronoi: (count: 1000000)"),
        &check,
        &["rock[0].voronoi", "1.0e6 blocks", "smaller count"],
    );
    refused(&rock(1.0, "fill: Size(size_m: 1e-3)"), &check, &["1.2e10 tetrahedra"]);
    let round = "blocks: [(name: \"a\", material: \"r\", shape: Sphere(radius_m: 1, levels: 6))]";
    refused(&scene(round), &check, &["2.1e6 tetrahedra", "fewer levels"]);
    refused(&cube(40, "body: Rigid"), &["check", "--memory", "50MB"], &["of memory", "there is 50.0 MB"]);
    for verb in ["run", "mesh", "certify"] {
        refused(&cube(40, "body: Rigid"), &[verb, "--memory", "50MB"], &["there is 50.0 MB"]);
    }
    refused(
        &cube(40, "body: Rigid"),
        &["tune", "--error", "1e-2", "--memory", "50MB"],
        &["there is 50.0 MB"],
    );
}

#[test]
fn a_terrain_is_counted_by_its_heights_however_long_the_file_of_a_surface_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let terrain = |file: &str| {
        std::fs::File::create(folder.path().join(file))
            .and_then(|made| made.set_len(800_000))
            .expect("a file");
        let rock = format!(
            "rock: [(name: \"t\", material: \"r\", domain: TerrainFile(file: \"{file}\", base_m: 0))]"
        );
        let output = ndda(folder.path(), &scene(&rock), &["check", "--memory", "50MB"]);
        assert_eq!(output.status.code(), Some(RESOURCE));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let (surface, grid) = (terrain("t.stl"), terrain("t.asc"));
    assert!(surface.contains("rock[0].domain: about 1 block and 6.4e5 tetrahedra"), "{surface}");
    assert!(surface.contains("use a coarser grid or surface"), "{surface}");
    assert!(grid.contains("rock[0].domain: about 1 block and 1.6e6 tetrahedra"), "{grid}");
}

#[test]
fn a_mesh_file_that_does_not_fit_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    // The length of the file decides; what it holds is not looked at.
    let file = folder.path().join("large.msh");
    std::fs::File::create(&file).and_then(|made| made.set_len(25_000_000)).expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_ndda"));
    let output = command.args(["mesh", "--memory", "100MB"]).arg(&file).output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(RESOURCE), "{said}");
    assert!(said.contains("1.0e6 tetrahedra would take 272.0 MB of memory; there is 100.0 MB"), "{said}");
}

#[test]
fn a_cut_that_makes_more_blocks_than_fit_ends_there() {
    let folder = tempfile::tempdir().expect("a folder");
    // Discs are no set: nothing is foreseen of them, and 16³ blocks of 8 kB are more than 20 MB.
    let disc = |dip_deg: u32, direction_deg: u32, center_m: String| {
        format!(
            "Disc(name: \"p\", dip_deg: {dip_deg}, dip_direction_deg: {direction_deg}, center_m: {center_m}, radius_m: 9),"
        )
    };
    let three = |i: u32| {
        let at = f64::from(i) / 16.0;
        disc(90, 90, format!("({at}, 0.5, 0.5)"))
            + &disc(90, 0, format!("(0.5, {at}, 0.5)"))
            + &disc(0, 0, format!("(0.5, 0.5, {at})"))
    };
    let discs: String = (1..16).map(three).collect();
    let text = rock(1.0, &format!("joints: [{discs}]"));
    let output = ndda(folder.path(), &text, &["check", "--memory", "20MB"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("more than 2500 blocks"), "{said}");
}

#[test]
fn a_surface_whose_volume_only_its_file_tells_is_refused_before_it_is_filled() {
    let folder = tempfile::tempdir().expect("a folder");
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    std::fs::write(folder.path().join("tet.obj"), format!("{corners}f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"))
        .expect("a surface");
    let fill = "fill: Size(size_m: 0.01)";
    let block = format!("shape: Surface(file: \"tet.obj\", {fill})");
    let block = scene(&format!("blocks: [(name: \"a\", material: \"r\", {block})]"));
    let rock = scene(&format!("rock: [(material: \"r\", domain: File(file: \"tet.obj\"), {fill})]"));
    for text in [block, rock] {
        let output = ndda(folder.path(), &text, &["check", "--memory", "100MB"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains("2.0e6 tetrahedra in all would take"), "{said}");
    }
}

#[test]
fn what_fits_takes_what_was_foreseen_within_a_factor_of_two() {
    use ndda::forecast::size;
    let folder = tempfile::tempdir().expect("a folder");
    for text in [
        cube(24, "body: Rigid"),
        cube(24, ""),
        cube(40, "body: Fixed"),
        rock(12.0, &sets(1.0, "")),
        rock(1.0, "voronoi: (count: 500)"),
        rock(10.0, "body: Rigid, fill: Size(size_m: 0.5)"),
    ] {
        let loaded = ndda_io::read::load_text("scene.ron", &text, &[], None).expect("a scene");
        let foreseen = size::bytes(&size::parts(&loaded.scene, folder.path()));
        let output = ndda(folder.path(), &text, &["check", "--json"]);
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{text}: {}", String::from_utf8_lossy(&output.stderr));
        let last: serde_json::Value =
            serde_json::from_str(said.lines().last().expect("a line")).expect("JSON");
        let taken = last["guess"]["memory_bytes"].as_f64().expect("memory");
        println!("{:.1} MB foreseen, {:.1} MB taken: {text}", foreseen / 1e6, taken / 1e6);
        assert!((0.5..=2.0).contains(&(foreseen / taken)), "{foreseen} and {taken}: {text}");
    }
}
