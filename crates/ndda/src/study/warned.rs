//! Warnings of the scenes of a study.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use ndda_io::diagnostic::Diagnostic;
use ndda_io::study::LoadedStudy;

use super::case::Case;

/// Warnings of the scenes of a study by path and words, whatever the numbers in them: how the first of them reads, and how many cases have it.
#[derive(Default)]
pub struct Warned {
    seen: Mutex<BTreeMap<(String, String), (String, usize)>>,
}

impl Warned {
    /// Adds the warnings of a case; what is wrong with its scene is said where it runs.
    pub fn note(&self, loaded: &LoadedStudy, case: &Case) {
        let warnings = loaded.scene_with(&case.overrides).map_or(Vec::new(), |read| read.warnings);
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        for warning in warnings {
            let words = warning.message.chars().filter(|letter| letter.is_alphabetic()).collect();
            let key = (warning.path.clone(), words);
            seen.entry(key).or_insert_with(|| (sentence(&warning), 0)).1 += 1;
        }
    }

    /// A line for each warning, of so many cases.
    pub fn lines(&self, cases: usize) -> Vec<String> {
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        let line = |(text, count): &(String, usize)| match *count == cases {
            true => format!("warning: {text}"),
            false => format!("warning in {count} of {cases} cases: {text}"),
        };
        seen.values().map(line).collect()
    }
}

fn sentence(warning: &Diagnostic) -> String {
    let place = if warning.path.is_empty() { String::new() } else { format!("{}: ", warning.path) };
    let help = warning.help.as_ref().map_or(String::new(), |help| format!("; {help}"));
    format!("{place}{}{help}", warning.message)
}
