//! Tells the program which commit it is built from: `NDDA_COMMIT` if it is set, else what git says.

use std::process::Command;

fn main() {
    println!("cargo:rerun-if-env-changed=NDDA_COMMIT");
    if std::env::var_os("NDDA_COMMIT").is_some() {
        return;
    }
    // Every commit and checkout adds a line to the log of HEAD.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo:rerun-if-changed={log}");
    }
    if let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]) {
        println!("cargo:rustc-env=NDDA_COMMIT={commit}");
    }
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_string();
    (output.status.success() && !text.is_empty()).then_some(text)
}
