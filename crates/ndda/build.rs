//! Build information for the program: compiler, commit, features.

use std::env;
use std::path::Path;
use std::process::Command;

/// Output of a command; none when it fails.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output =
        Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_string()).filter(|text| !text.is_empty())
}

fn main() {
    let rustc = env::var("RUSTC").ok().and_then(|rustc| said(&rustc, &["-V"]));
    let described = || said("git", &["describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]);
    let commit = env::var("NDDA_COMMIT").ok().or_else(described);
    let mut features: Vec<String> = env::vars()
        .filter_map(|(name, _)| Some(name.strip_prefix("CARGO_FEATURE_")?.to_lowercase()))
        .filter(|name| name != "default")
        .collect();
    features.sort();
    let unknown = || "unknown".to_string();
    println!("cargo::rustc-env=NDDA_RUSTC={}", rustc.unwrap_or_else(unknown));
    println!("cargo::rustc-env=NDDA_COMMIT={}", commit.unwrap_or_else(unknown));
    println!("cargo::rustc-env=NDDA_FEATURES={}", features.join(" "));
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=NDDA_COMMIT");
    // Grows with every commit; a copy without history has none.
    let log = "../../.git/logs/HEAD";
    if Path::new(log).exists() {
        println!("cargo::rerun-if-changed={log}");
    }
}
