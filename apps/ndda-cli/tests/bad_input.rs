//! The messages for wrong scenes: each scene of `bad_input/` is compared with the message beside it.
//!
//! `NDDA_ACCEPT=1 cargo test -p ndda-cli --test bad_input` writes the messages anew; read them before they are committed.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bad_input"))
}

/// Names of the cases: every scene has its message, and a message may be about a scene that is not there.
fn cases() -> BTreeSet<String> {
    let entries = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    entries
        .filter(|path| path.extension().is_some_and(|extension| extension == "ron" || extension == "txt"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect()
}

/// Exit code and what is printed for a person to read.
fn told(case: &str) -> String {
    let mut ndda = Command::new(env!("CARGO_BIN_EXE_ndda"));
    let done = ndda.args(["check", &format!("{case}.ron")]).current_dir(folder()).output().unwrap();
    let code = done.status.code().expect("no signal");
    format!("exit {code}\n{}", String::from_utf8(done.stderr).unwrap())
}

#[test]
fn every_bad_scene_is_answered_with_its_message() {
    let mut wrong = Vec::new();
    for case in cases() {
        let file = folder().join(format!("{case}.txt"));
        let told = told(&case);
        if std::env::var_os("NDDA_ACCEPT").is_some() {
            fs::write(&file, &told).unwrap();
        }
        let expected = fs::read_to_string(&file).unwrap_or_default();
        if told != expected {
            wrong.push(format!("{case}:\n{told}\nnot as in {}:\n{expected}", file.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_message_has_a_code_and_advice_and_those_with_a_place_name_line_and_column() {
    for case in cases() {
        let told = told(&case);
        let headline = told.lines().nth(1).unwrap_or_default();
        assert!(headline.contains("error[") || headline.contains("warning["), "{told}");
        assert!(told.contains("help: "), "{told}");
        let whole_file = ["folder", "no_such_file", "not_utf8"].contains(&case.as_str());
        let place = headline.strip_prefix(&format!("{case}.ron:")).unwrap_or_else(|| panic!("{told}"));
        let numbers = place.split(':').take(2).all(|part| part.parse::<usize>().is_ok());
        assert!(numbers || whole_file, "{told}");
        assert!(told.starts_with("exit 3\n") || headline.contains("warning["), "{told}");
    }
}
