//! The layout: which crate may use which, and what lies at the top.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Every crate of the workspace with the crates of the workspace that it may depend on.
const ARROWS: [(&str, &[&str]); 8] = [
    ("crates/ndda-mesh", &[]),
    ("crates/ndda-fem", &["ndda-mesh"]),
    ("crates/ndda-contact", &["ndda-mesh"]),
    ("crates/ndda-solver", &["ndda-mesh", "ndda-fem", "ndda-contact"]),
    ("crates/ndda-io", &["ndda-mesh"]),
    ("crates/ndda", &["ndda-mesh", "ndda-fem", "ndda-contact", "ndda-solver", "ndda-io"]),
    ("apps/ndda-cli", &["ndda-mesh", "ndda-fem", "ndda-contact", "ndda-solver", "ndda-io", "ndda"]),
    ("apps/ndda-python", &["ndda", "ndda-io", "ndda-solver"]),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Crates of the workspace in the section `[dependencies]`, and in others if `all`.
fn uses(manifest: &str, all: bool) -> BTreeSet<String> {
    let mut inside = false;
    let mut found = BTreeSet::new();
    for line in manifest.lines() {
        if let Some(section) = line.strip_prefix('[') {
            inside = section.starts_with("dependencies") || all && section.contains("dependencies");
        }
        let name = line.split(['.', ' ', '=']).next().unwrap_or("");
        if inside && (name == "ndda" || name.starts_with("ndda-")) {
            found.insert(name.to_string());
        }
    }
    found
}

#[test]
fn crates_depend_on_each_other_only_along_the_allowed_arrows() {
    for (folder, allowed) in ARROWS {
        let manifest = fs::read_to_string(root().join(folder).join("Cargo.toml")).unwrap();
        for name in uses(&manifest, true) {
            assert!(allowed.contains(&name.as_str()), "{folder} must not depend on {name}");
        }
    }
}

/// Rust sources of a folder, all in one text.
fn sources(folder: &Path) -> String {
    let mut text = String::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            text += &sources(&entry);
        } else if entry.extension().is_some_and(|ending| ending == "rs") {
            text += &fs::read_to_string(entry).unwrap();
        }
    }
    text
}

#[test]
fn every_crate_uses_the_crates_that_it_depends_on() {
    for (folder, _) in ARROWS {
        let folder = root().join(folder);
        let text = sources(&folder.join("src"));
        for name in uses(&fs::read_to_string(folder.join("Cargo.toml")).unwrap(), false) {
            let module = format!("{}::", name.replace('-', "_"));
            assert!(text.contains(&module), "{} names {name} and does not use it", folder.display());
        }
    }
}

#[test]
fn every_crate_has_its_arrows() {
    let folders = ["crates", "apps"].into_iter().flat_map(|top| {
        let entries = fs::read_dir(root().join(top)).unwrap();
        entries.map(move |entry| format!("{top}/{}", entry.unwrap().file_name().to_string_lossy()))
    });
    let found: BTreeSet<String> = folders.collect();
    assert_eq!(found, ARROWS.iter().map(|(folder, _)| folder.to_string()).collect());
}

#[test]
fn the_solver_reaches_contact_through_its_trait_only() {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let contact = manifest.lines().find(|line| line.starts_with("ndda-contact = { path")).unwrap();
    assert!(contact.contains("default-features = false"), "{contact}");
    let solver = fs::read_to_string(root().join("crates/ndda-solver/Cargo.toml")).unwrap();
    assert!(!solver.contains("potential"), "the solver must not enable contact's default model");
}

#[test]
fn the_top_level_reads_as_the_readme_says() {
    let allowed = ["Cargo.toml", "Cargo.lock", "crates", "apps", "tests", "benches", "scenes", "docs"];
    let papers = [
        "README.md",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "rust-toolchain.toml",
        "rustfmt.toml",
        "target",
        "out",
    ];
    for entry in fs::read_dir(root()).unwrap() {
        let name = entry.unwrap().file_name().to_string_lossy().into_owned();
        let known =
            allowed.contains(&name.as_str()) || papers.contains(&name.as_str()) || name.starts_with('.');
        assert!(known, "{name} does not belong at the top level");
    }
    for name in allowed {
        assert!(root().join(name).exists(), "{name} is missing");
    }
}
