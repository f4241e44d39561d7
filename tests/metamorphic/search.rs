//! The search: seeds one after the other, failing ones kept as scenes.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use ndda_io::scene::Scene;

use crate::generator::{Case, FIRST_DAMPED, Wanted, case};

/// Outcome of a case.
pub enum Found {
    /// The relation holds.
    Holds,
    /// The relation says nothing of this scene.
    Skipped(&'static str),
    /// The relation does not hold.
    Fails(String),
}

/// A number from the environment.
pub fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|text| text.parse().unwrap_or_else(|_| panic!("{name}={text} is no number")))
}

/// The seeds that are requested; else the usual ones, and a quarter as many with damped contacts.
pub fn seeds(usual: u64) -> Vec<u64> {
    let (first, cases) = (number("NDDA_FIRST"), number("NDDA_CASES"));
    if let Some(seed) = number("NDDA_SEED") {
        return vec![seed];
    }
    if first.is_none() && cases.is_none() {
        return (0..usual).chain(FIRST_DAMPED..FIRST_DAMPED + usual / 4).collect();
    }
    let first = first.unwrap_or(0);
    (first..first + cases.unwrap_or(usual)).collect()
}

/// Whether a scene has the words that are requested, such as `contact_at: End()`.
pub fn has_words(case: &Case) -> bool {
    std::env::var("NDDA_WITH").map_or(true, |words| case.text.contains(&words))
}

/// Folder of the scenes of failing seeds.
pub fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("target/metamorphic");
    std::fs::create_dir_all(&folder).expect("a folder under target");
    folder
}

/// Works on each seed on all processors.
pub fn each_seed(seeds: &[u64], work: impl Fn(u64) + Sync) {
    let threads = match std::thread::available_parallelism() {
        Ok(all) if seeds.len() > 500 => all.get(),
        _ => 1,
    };
    let next = AtomicU64::new(0);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
                    work(seed);
                }
            });
        }
    });
}

/// Keeps a failing scene, and says how to see it again.
pub fn keep(relation: &str, case: &Case, why: &str) -> String {
    let path = folder().join(format!("seed_{}_{relation}.ron", case.seed));
    let command = format!("NDDA_SEED={} cargo test --test metamorphic {relation}", case.seed);
    let comment: String = why.lines().map(|line| format!("// {line}\n")).collect();
    std::fs::write(&path, format!("{comment}// Again: {command}\n{}", case.text))
        .expect("a file under target");
    format!("seed {}: {why}\n  {}\n  again: {command}", case.seed, path.display())
}

/// Checks a relation on the usual number of seeds, or on as many as are requested.
pub fn search(relation: &str, usual: u64, wanted: &Wanted, check: impl Fn(&Case) -> Found + Sync) {
    let (failures, counts) = (Mutex::new(Vec::new()), Mutex::new(BTreeMap::<&str, u64>::new()));
    let count = |what: &'static str| *counts.lock().unwrap().entry(what).or_default() += 1;
    each_seed(&seeds(usual), |seed| {
        let case = case(seed, wanted);
        if !has_words(&case) {
            return;
        }
        let found = catch_unwind(AssertUnwindSafe(|| check(&case)));
        match found.unwrap_or_else(|_| Found::Fails("the run panicked".into())) {
            Found::Holds => count("holds"),
            Found::Skipped(why) => count(why),
            Found::Fails(why) => failures.lock().unwrap().push((seed, keep(relation, &case, &why))),
        }
    });
    println!("{relation}: {:?}", counts.lock().unwrap());
    let mut failures = failures.into_inner().unwrap();
    failures.sort();
    let texts: Vec<&str> = failures.iter().map(|(_, text)| text.as_str()).collect();
    assert!(failures.is_empty(), "{relation} fails in {} case(s):\n{}", texts.len(), texts.join("\n"));
}

/// The text of a scene that was changed.
pub fn text_of(scene: &Scene) -> String {
    ron::ser::to_string_pretty(scene, ron::ser::PrettyConfig::default()).expect("a scene is text")
}
