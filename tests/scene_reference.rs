//! docs/scene.md says everything that a scene may say, and its example is one.

use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// Names of the fields and choices in scene.rs: lines of a field or a variant between its documentation.
fn names(source: &str) -> Vec<&str> {
    let declared = source.split("\nfn ").next().and_then(|s| s.split("\nimpl ").next()).unwrap();
    declared
        .lines()
        .map(|line| line.trim_start().trim_start_matches("pub "))
        .filter(|line| !line.starts_with(['/', '#']))
        .filter_map(|line| line.split([':', '(', ',', ' ', '{']).next())
        .filter(|name| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'))
        .filter(|name| !["mod", "use", "struct", "enum", "impl", "fn", "Self"].contains(name))
        .collect()
}

#[test]
fn every_field_and_choice_of_a_scene_is_documented() {
    let reference = read("docs/scene.md");
    let sources = ["scene.rs", "scene/output.rs", "scene/rock.rs", "scene/shape.rs"]
        .map(|f| read(&format!("crates/ndda-io/src/{f}")));
    let names: Vec<&str> = sources.iter().flat_map(|source| names(source)).collect();
    assert!(names.len() > 120, "{names:?}");
    for name in names {
        let documented = [format!("`{name}`"), format!("`{name}(")].iter().any(|n| reference.contains(n));
        assert!(documented, "docs/scene.md does not say what `{name}` is");
    }
}

#[test]
fn the_example_of_the_reference_is_a_scene_without_warnings_that_runs() {
    let reference = read("docs/scene.md");
    let example = reference.split("```ron\n").nth(1).unwrap().split("```").next().unwrap();
    let loaded =
        ndda_io::read::load_text("docs/scene.md", example, &[], None).unwrap_or_else(|e| panic!("{e}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let blocks = ndda_cli::wiring::blocks(&loaded.scene, Path::new(".")).unwrap();
    let mut simulation = ndda_cli::wiring::simulation(&loaded.scene, blocks, Path::new(".")).unwrap();
    assert_eq!(ndda_cli::wiring::monitors(&loaded.scene, &simulation).unwrap().len(), 1);
    simulation.step().unwrap();
}
