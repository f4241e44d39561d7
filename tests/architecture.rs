//! The layout: which crate may use which, what lies at the top, how long a file is, and what documents name.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Every crate of the workspace with the crates of the workspace that it may depend on.
const ARROWS: [(&str, &[&str]); 10] = [
    ("crates/ndda-mesh", &[]),
    ("crates/ndda-fem", &["ndda-mesh"]),
    ("crates/ndda-ranks", &[]),
    ("crates/ndda-contact", &["ndda-mesh", "ndda-ranks"]),
    ("crates/ndda-solver", &["ndda-mesh", "ndda-ranks", "ndda-fem", "ndda-contact"]),
    ("crates/ndda-io", &["ndda-mesh"]),
    ("crates/ndda", &["ndda-mesh", "ndda-ranks", "ndda-fem", "ndda-contact", "ndda-solver", "ndda-io"]),
    ("apps/ndda-cli", &["ndda-mesh", "ndda-fem", "ndda-contact", "ndda-solver", "ndda-io", "ndda"]),
    ("apps/ndda-mpi", &["ndda-ranks", "ndda-solver", "ndda-io", "ndda"]),
    ("apps/ndda-python", &["ndda-mesh", "ndda-contact", "ndda-solver", "ndda-io", "ndda", "ndda-cli"]),
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
    // Tests of the solver may push blocks with it.
    let ours = solver.split("[dev-dependencies]").next().unwrap();
    assert!(!ours.contains("potential"), "the solver must not enable contact's default model");
}

#[test]
fn the_top_level_reads_as_the_readme_says() {
    let allowed = ["Cargo.toml", "Cargo.lock", "crates", "apps", "tests", "benches", "scenes", "docs"];
    let papers = [
        "README.md",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "deny.toml",
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

/// Modules of a crate by their paths (`friction::bond`), with their code: comments and unit tests are left out.
fn modules(src: &Path, prefix: &str, found: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(src).unwrap().map(|entry| entry.unwrap().path()) {
        let name = entry.file_stem().unwrap().to_string_lossy().into_owned();
        if entry.is_dir() {
            modules(&entry, &format!("{prefix}{name}::"), found);
        } else if entry.extension().is_some_and(|ending| ending == "rs") {
            let text = fs::read_to_string(&entry).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests").next().unwrap().lines();
            let code: String = code.map(|line| line.split("//").next().unwrap().to_string() + "\n").collect();
            let own = if ["mod", "lib", "main"].contains(&name.as_str()) { "" } else { &name };
            let path = format!("{prefix}{own}");
            found.insert(path.trim_end_matches("::").to_string(), code);
        }
    }
}

/// Paths that begin with `crate::` or `super::` in a module, with lists in braces taken apart.
fn paths(module: &str, code: &str) -> Vec<String> {
    let parent = module.rsplit_once("::").map_or("", |(parent, _)| parent);
    let mut found = Vec::new();
    for (root, base) in [("crate::", ""), ("super::", parent)] {
        for (start, _) in code.match_indices(root) {
            let base = if base.is_empty() { String::new() } else { format!("{base}::") };
            spread(&base, &code[start + root.len()..], &mut found);
        }
    }
    found
}

/// `a::{b, c::d}` as `a::b` and `a::c::d`.
fn spread(base: &str, text: &str, found: &mut Vec<String>) {
    let text = text.trim_start();
    if let Some(list) = text.strip_prefix('{') {
        let (mut depth, mut start) = (0, 0);
        for (place, letter) in list.char_indices() {
            match letter {
                '{' => depth += 1,
                '}' if depth == 0 => return spread(base, &list[start..place], found),
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    spread(base, &list[start..place], found);
                    start = place + 1;
                }
                _ => {}
            }
        }
        return;
    }
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    match (&text[..end], text[end..].strip_prefix("::")) {
        ("", _) => {}
        (name, Some(rest)) => spread(&format!("{base}{name}::"), rest, found),
        (name, None) => found.push(format!("{base}{name}")),
    }
}

/// The module that a path leads into: the longest part of it that is one, also behind the folders of `re_exported`.
fn leads_to(path: &str, modules: &BTreeMap<String, String>, re_exported: &str) -> Option<String> {
    let whole = [path.to_string(), format!("{re_exported}::{path}")];
    whole.iter().find_map(|path| {
        let ends = path.match_indices("::").map(|(end, _)| end).chain([path.len()]);
        let parts: Vec<&str> = ends.map(|end| &path[..end]).collect();
        let fits = |part: &&&str| modules.contains_key(**part) && **part != re_exported;
        parts.iter().rev().find(fits).map(|part| part.to_string())
    })
}

/// A circle among modules that import each other, if there is one.
fn circle(arrows: &BTreeMap<String, BTreeSet<String>>) -> Option<Vec<String>> {
    fn visit<'a>(
        at: &'a str,
        arrows: &'a BTreeMap<String, BTreeSet<String>>,
        way: &mut Vec<&'a str>,
        done: &mut BTreeSet<&'a str>,
    ) -> Option<Vec<String>> {
        if let Some(start) = way.iter().position(|on| *on == at) {
            return Some(way[start..].iter().chain([&at]).map(|name| name.to_string()).collect());
        }
        if !done.insert(at) {
            return None;
        }
        way.push(at);
        let found = arrows[at].iter().find_map(|next| visit(next, arrows, way, done));
        way.pop();
        found
    }
    let mut done = BTreeSet::new();
    arrows.keys().find_map(|start| visit(start, arrows, &mut Vec::new(), &mut done))
}

/// Imports of a parent from its own modules do not count, nor do those of its re-exports.
#[test]
fn modules_do_not_import_each_other_in_circles() {
    for (folder, _) in ARROWS {
        let mut found = BTreeMap::new();
        modules(&root().join(folder).join("src"), "", &mut found);
        let arrows: BTreeMap<String, BTreeSet<String>> = found
            .iter()
            .map(|(module, code)| {
                let leads = paths(module, code);
                let to = leads.iter().filter_map(|path| leads_to(path, &found, "potential_contact"));
                let holds =
                    |other: &String, inner: &str| inner == other || inner.starts_with(&format!("{other}::"));
                let to =
                    to.filter(|other| !other.is_empty() && !holds(other, module) && !holds(module, other));
                (module.clone(), to.collect())
            })
            .collect();
        let circle = circle(&arrows);
        assert!(circle.is_none(), "{folder}: {}", circle.unwrap().join(" → "));
    }
}

/// Every file with the given ending under a folder, but for what the build leaves.
fn files(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = entry.file_name().unwrap().to_string_lossy().into_owned();
        if entry.is_dir() && !["target", "out"].contains(&name.as_str()) && !name.starts_with('.') {
            files(&entry, ending, found);
        } else if entry.extension().is_some_and(|own| own == ending) {
            found.push(entry);
        }
    }
}

#[test]
fn no_source_file_is_longer_than_400_lines() {
    let mut found = Vec::new();
    files(&root().join("crates"), "rs", &mut found);
    files(&root().join("apps"), "rs", &mut found);
    for file in found {
        let lines = fs::read_to_string(&file).unwrap().lines().count();
        assert!(lines <= 400, "{}: {lines} lines; split it by what its parts are about", file.display());
    }
}

/// Paths in backticks; those with a placeholder in capitals (`scenes/NAME.ron`) or a pattern are left out.
#[test]
fn every_path_that_a_document_names_exists() {
    let mut documents = Vec::new();
    files(root(), "md", &mut documents);
    for document in documents.iter().filter(|document| !document.ends_with("CHANGELOG.md")) {
        let text = fs::read_to_string(document).unwrap();
        for name in text.split('`').skip(1).step_by(2) {
            let top = name.split('/').next().unwrap();
            let in_the_tree = ["crates", "apps", "tests", "benches", "scenes", "docs"].contains(&top)
                && name.contains('/')
                && name.chars().all(|c| c.is_ascii_alphanumeric() || "/_-.".contains(c))
                && !name
                    .split(['/', '.'])
                    .any(|part| part.len() > 1 && part.chars().all(|c| c.is_ascii_uppercase()));
            let known = !in_the_tree || root().join(name).exists();
            assert!(known, "{} names {name}, which is not there", document.display());
        }
    }
}

fn cargo(words: &[&str]) -> String {
    let output = std::process::Command::new(env!("CARGO")).args(words).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "cargo {words:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Whether a licence expression allows what is asked: one of its alternatives has allowed parts only.
fn is_allowed(expression: &str, allowed: &[&str]) -> bool {
    let alternatives = expression.replace(['(', ')'], "").replace('/', " OR ");
    // `(A OR B) AND C` reads as A, or B and C, here: C has to be among the allowed ones then, as well.
    let parts_of = |alternative: &str| alternative.split(" AND ").all(|part| allowed.contains(&part.trim()));
    let together = expression.rsplit_once(") AND ").is_none_or(|(_, last)| allowed.contains(&last.trim()));
    together && alternatives.split(" OR ").any(parts_of)
}

#[test]
fn every_dependency_has_a_licence_that_deny_toml_allows() {
    let rules = fs::read_to_string(root().join("deny.toml")).unwrap();
    let list = rules.split("allow = [").nth(1).unwrap().split(']').next().unwrap();
    let allowed: Vec<&str> = list.split('"').skip(1).step_by(2).collect();
    let version = cargo(&["-vV"]);
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    let text =
        cargo(&["metadata", "--locked", "--all-features", "--format-version=1", "--filter-platform", host]);
    let metadata: serde_json::Value = serde_json::from_str(&text).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    for package in packages {
        let licence = package["license"].as_str().unwrap_or("none");
        assert!(
            is_allowed(licence, &allowed),
            "{} {} has the licence {licence}",
            package["name"],
            package["version"]
        );
    }
    assert!(!is_allowed("GPL-3.0", &allowed) && !is_allowed("(MIT OR Zlib) AND GPL-3.0", &allowed));
}

/// Sources go by the end of their path; `src` and `potential_contact`, in which chapters lie, may be left out.
#[test]
fn every_source_file_that_a_document_names_exists() {
    let mut sources = Vec::new();
    let mut documents = Vec::new();
    for top in ["crates", "apps", "tests", "benches"] {
        files(&root().join(top), "rs", &mut sources);
    }
    files(&root().join("docs"), "md", &mut documents);
    let shortened = |path: &Path| {
        let path = path.strip_prefix(root()).unwrap().to_string_lossy().into_owned();
        [path.clone(), path.replace("/src/", "/").replace("/potential_contact/", "/")]
    };
    let known: Vec<String> = sources.iter().flat_map(|path| shortened(path)).collect();
    for document in documents {
        let text = fs::read_to_string(&document).unwrap();
        let names = text.split('`').skip(1).step_by(2).filter(|name| name.ends_with(".rs"));
        for name in names.filter(|name| name.chars().all(|c| c.is_ascii_alphanumeric() || "/_-.".contains(c)))
        {
            let exists = known.iter().any(|path| path == name || path.ends_with(&format!("/{name}")));
            assert!(exists, "{} names {name}, which is not there", document.display());
        }
    }
}
