//! The cases of a study: every choice of one axis with every one of the others.

use std::path::Path;

use ndda_io::checkpoint;
use ndda_io::diagnostic::SceneErrors;
use ndda_io::locate::Node;
use ndda_io::study::{Axis, LoadedStudy, Reference, as_overrides};

use super::error::StudyError;
use crate::run::Sensitivity;

/// Names of cases become names of folders.
pub const LONGEST_NAME: usize = 200;
/// Rows of a reference run's history over those of a case, so that reading between them costs no digits.
const REFERENCE_ROWS: u32 = 10;

/// One scene to run.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Name of its folder.
    pub name: String,
    /// Axis and choice, in the order of the study.
    pub labels: Vec<(String, String)>,
    /// Arguments of `--set` of `ndda run`.
    pub overrides: Vec<String>,
    /// How often it runs.
    pub repeats: u32,
    /// Whether its first run, if it is accurate, is run again to see whether the result changes.
    pub sensitivity: Sensitivity,
}

/// Axes and choices of a point, and its overrides.
type Point = (Vec<(String, String)>, Vec<String>);

/// Every choice of one axis with every one of the others; random axes have none.
pub fn grid(loaded: &LoadedStudy) -> Vec<Point> {
    let mut all = vec![(Vec::new(), as_overrides(&loaded.study.set))];
    for axis in loaded.study.axes.iter().filter(|axis| !matches!(axis, Axis::Random { .. })) {
        let choices = axis.choices();
        let with = |(labels, overrides): &Point| {
            let one = |(label, own): &(String, Vec<String>)| {
                let mut labels = labels.clone();
                labels.push((axis.name().to_string(), label.clone()));
                (labels, overrides.iter().chain(own).cloned().collect())
            };
            choices.iter().map(one).collect::<Vec<_>>()
        };
        all = all.iter().flat_map(with).collect();
    }
    all
}

/// All cases that are plotted.
///
/// # Errors
/// [`StudyError::Names`] when two cases would have one folder.
pub fn cases(loaded: &LoadedStudy) -> Result<Vec<Case>, StudyError> {
    let (repeats, sensitivity) = (loaded.study.repeats, loaded.study.second_runs);
    let cases = grid(loaded).into_iter().map(|(labels, overrides)| Case {
        name: name(&labels),
        labels,
        overrides,
        repeats,
        sensitivity,
    });
    let cases: Vec<Case> = cases.collect();
    for (i, case) in cases.iter().enumerate() {
        if case.name.len() > LONGEST_NAME || cases[..i].iter().any(|other| other.name == case.name) {
            return Err(StudyError::Names(case.name.clone()));
        }
    }
    Ok(cases)
}

/// The two runs that results are compared with where no closed form is known; none where one is.
///
/// # Errors
/// [`StudyError::Scene`] when no case of the study can be read, so that the shortest step is unknown.
pub fn reference_cases(loaded: &LoadedStudy, cases: &[Case]) -> Result<Vec<Case>, StudyError> {
    let Reference::Runs { first, second, divisor, .. } = &loaded.study.reference else {
        return Ok(Vec::new());
    };
    let mut scenes = Vec::new();
    let mut refused = None;
    for case in cases {
        match loaded.scene_with(&case.overrides) {
            Ok(read) => scenes.push(read.scene),
            Err(errors) => refused = Some(errors),
        }
    }
    if let (true, Some(errors)) = (scenes.is_empty(), refused) {
        return Err(StudyError::Scene(errors));
    }
    let shortest_s = scenes.iter().map(|scene| scene.time.step_s).fold(f64::INFINITY, f64::min);
    let rows = scenes.iter().map(|scene| scene.output.history_rows).max().unwrap_or(0);
    let runs = [("reference_first", first), ("reference_second", second)];
    let case = |(name, values): (&str, _)| {
        let mut overrides = as_overrides(&loaded.study.set);
        overrides.extend(as_overrides(values));
        overrides.push(format!("time.step_s={:e}", shortest_s / f64::from(*divisor)));
        overrides.push(format!("output.history_rows={}", rows.saturating_mul(REFERENCE_ROWS)));
        Case { name: name.into(), labels: Vec::new(), overrides, repeats: 1, sensitivity: Sensitivity::Never }
    };
    Ok(runs.map(case).to_vec())
}

/// Puts values of the base scene before what the study sets.
pub fn set_first(cases: &mut [Case], overrides: &[String]) {
    for case in cases {
        case.overrides.splice(0..0, overrides.iter().cloned());
    }
}

/// `axis=choice__axis=choice`, with nothing in it that a file system or a shell could mistake.
pub fn name(labels: &[(String, String)]) -> String {
    let part = |(axis, label): &(String, String)| format!("{}={}", plain(axis), plain(label));
    labels.iter().map(part).collect::<Vec<_>>().join("__")
}

/// A text with nothing in it that a file system or a shell could mistake.
pub fn plain(text: &str) -> String {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c)));
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("_")
}

/// Fingerprint of a case: the text of its scene and the files that it names.
///
/// # Errors
/// Errors of the scene.
pub fn fingerprint(loaded: &LoadedStudy, case: &Case) -> Result<String, SceneErrors> {
    let read = loaded.scene_with(&case.overrides)?;
    let text = read.text;
    let mut bytes = text.clone().into_bytes();
    let folder = loaded.scene.parent().unwrap_or(Path::new("."));
    Node::of(&text).for_each_leaf(&mut |leaf| {
        let word = text[leaf.span.clone()].trim_matches('"');
        let file = folder.join(word);
        // Any word that names a file, such as a mesh or a record, is part of the scene.
        if !word.is_empty() && file.is_file() {
            bytes.extend(std::fs::read(&file).unwrap_or_default());
        }
    });
    // Files of materials may name others.
    for file in &read.scene.include {
        bytes.extend(std::fs::read(folder.join(file)).unwrap_or_default());
    }
    Ok(format!("{:08x}-{}", checkpoint::fingerprint(&bytes), bytes.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_for_shells_and_files() {
        let labels = [("step_s", "1e-3"), ("integrator", "Newmark(alpha: 0.5, delta: 1)"), ("é", "$(rm)/..")];
        let labels = labels.map(|(axis, label)| (axis.to_string(), label.to_string()));
        assert_eq!(name(&labels), "step_s=1e-3__integrator=Newmark_alpha_0.5_delta_1__=rm_..");
    }
}
