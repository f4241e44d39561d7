//! docs/guide/troubleshooting.md has a section for every code that is printed, and no other.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use ndda_io::code::Code;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

#[test]
fn every_code_has_its_section_and_every_section_a_code() {
    let page = read("docs/guide/troubleshooting.md");
    let sections: BTreeSet<String> =
        page.lines().filter_map(|line| line.strip_prefix("### ")).map(String::from).collect();
    let stops = read("crates/ndda-solver/src/error.rs");
    let stops = stops.lines().filter(|line| line.trim_start().starts_with("Self::"));
    let mut codes: BTreeSet<String> =
        stops.filter_map(|line| line.split('"').nth(1)).map(String::from).collect();
    assert!(codes.len() > 5, "{codes:?}");
    codes.extend(Code::ALL.map(|code| code.to_string()));
    assert_eq!(sections, codes);
}

#[test]
fn every_code_is_in_the_list_of_all() {
    let source = read("crates/ndda-io/src/scene/code.rs");
    let declared = source.split("pub enum Code {").nth(1).unwrap().split('}').next().unwrap();
    let variants = declared.lines().filter(|line| line.ends_with(',')).count();
    assert_eq!(variants, Code::ALL.len());
}
