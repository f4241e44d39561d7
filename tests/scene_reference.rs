//! docs/reference/scene.md is what the types of a scene say of themselves, and its example is a scene.

use std::fs;
use std::path::Path;

fn reference() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference/scene.md")).unwrap()
}

#[test]
fn the_reference_is_that_of_the_types() {
    let told = ndda_io::schema::reference();
    let differs =
        reference().lines().zip(told.lines()).find(|(a, b)| a != b).map(|(a, b)| format!("{a}\n{b}"));
    assert!(
        reference() == told,
        "write it anew: ndda schema --markdown > docs/reference/scene.md\n{differs:?}"
    );
}

#[test]
fn the_example_of_the_reference_is_a_scene_without_warnings_that_runs() {
    let reference = reference();
    let example = reference.split("```ron\n").nth(1).unwrap().split("```").next().unwrap();
    let loaded = ndda_io::read::load_text("docs/reference/scene.md", example, &[], None)
        .unwrap_or_else(|e| panic!("{e}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let blocks = ndda::build::blocks(&loaded.scene, Path::new(".")).unwrap();
    let mut simulation = ndda::build::simulation(&loaded.scene, blocks, Path::new(".")).unwrap();
    assert_eq!(ndda::build::monitors(&loaded.scene, &simulation).unwrap().len(), 1);
    simulation.step().unwrap();
}
