//! Checks of studies.

use std::collections::HashSet;

use super::{Axis, Reference, Study, as_overrides};
use crate::scene::Scene;
use crate::scene::code::Code;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::locate::Node;
use crate::scene::parse::parse_with;
use crate::scene::{overrides, parameter_values, parameters, suggest};

pub(super) fn default_curves(study: &Study) -> Vec<String> {
    let others = study.axes.iter().filter(|axis| !axis.varies("time.step_s"));
    others.map(|axis| axis.name().to_string()).collect()
}

/// Errors of a study that do not depend on the scene.
pub(super) fn problems(study: &Study) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut refuse =
        |path: String, message: String| found.push(Diagnostic::error(Code::OutOfRange, path, message, None));
    if study.repeats == 0 {
        refuse("repeats".into(), "0: must be at least 1".into());
    }
    if let Reference::Runs { divisor: 0, .. } = study.reference {
        refuse("reference.divisor".into(), "0: must be at least 1".into());
    }
    if study.axes.is_empty() {
        refuse("axes".into(), "nothing varies: write at least one axis".into());
    }
    if study.samples == 0 {
        refuse("samples".into(), "0: must be at least 1".into());
    }
    if !(study.safety_error > 0.0 && study.safety_error < 1.0) {
        refuse("safety_error".into(), format!("{}: must lie between 0 and 1", study.safety_error));
    }
    let mut names = HashSet::new();
    for (i, axis) in study.axes.iter().enumerate() {
        if axis.name().is_empty() || !names.insert(axis.name()) {
            refuse(format!("axes[{i}]"), format!("the name `{}` is empty or taken: use Choose", axis.name()));
        }
        let (choices, mut labels) = (axis.choices(), HashSet::new());
        if let Axis::Random { distribution, .. } = axis {
            if let Err(reason) = distribution.check() {
                refuse(format!("axes[{i}].distribution"), reason);
            }
        } else if choices.is_empty() {
            refuse(format!("axes[{i}]"), "has no values".into());
        }
        if let Some((label, _)) = choices.iter().find(|(label, _)| !labels.insert(label)) {
            refuse(format!("axes[{i}]"), format!("`{label}` is there twice"));
        }
    }
    for (i, curve) in study.curves.iter().flatten().enumerate() {
        if !names.contains(curve.as_str()) {
            let known = study.axes.iter().map(Axis::name).collect::<Vec<_>>();
            refuse(
                format!("curves[{i}]"),
                format!("no axis is called `{curve}`; {}", suggest::suggest(curve, &known)),
            );
        }
    }
    found.extend(correlation_problems(study));
    found
}

/// Correlations that are none, or of what is not random.
fn correlation_problems(study: &Study) -> Vec<Diagnostic> {
    let random = study.axes.iter().filter(|axis| matches!(axis, Axis::Random { .. }));
    let random: Vec<&str> = random.map(Axis::name).collect();
    let mut found = Vec::new();
    let mut refuse =
        |path: String, message: String| found.push(Diagnostic::error(Code::OutOfRange, path, message, None));
    for (i, correlation) in study.correlations.iter().enumerate() {
        let (a, b) = &correlation.between;
        let path = format!("correlations[{i}]");
        for name in [a, b].into_iter().filter(|name| !random.contains(&name.as_str())) {
            let help = suggest::suggest(name, &random);
            refuse(path.clone(), format!("no random axis is called `{name}`; {help}"));
        }
        if a == b || correlation.coefficient.is_nan() || correlation.coefficient.abs() >= 1.0 {
            refuse(path, "two axes have a coefficient between −1 and 1".into());
        }
    }
    if study.sensitivity && !study.correlations.is_empty() {
        refuse(
            "sensitivity".into(),
            "works with independent parameters only: leave out the correlations".into(),
        );
    }
    if study.sensitivity && random.is_empty() {
        refuse(
            "sensitivity".into(),
            "works with random parameters only: give at least one a distribution".into(),
        );
    }
    found
}

/// Paths that lead nowhere in the scene, and fields that no scene has. What values mean is found when a case runs.
pub(super) fn lost_paths(study: &Study, scene_text: &str) -> Vec<Diagnostic> {
    let refused = |text: &str, overrides: &[String]| match overrides::apply(text, overrides) {
        Ok(with) => unknown_field(&with).map(|d| match parameter(text, &d.path) {
            Some(known) => d.with_help(format!("did you mean `{known}`?")),
            None => d,
        }),
        Err(found) => found.into_iter().next(),
    };
    let common = as_overrides(&study.set);
    let lost = |path: String, d: Diagnostic| {
        // Nobody wrote the value that was tried here, nor --set.
        let tried = d.path.strip_prefix("--set ").map(|set| set.split_once('=').unwrap_or((set, "")));
        let (place, value) = tried.unwrap_or((d.path.as_str(), ""));
        let help = d.help.map(|help| match tried {
            Some(_) => help.replace("--set ", "").replace(&format!("={value}?"), "?"),
            None => help,
        });
        let at = Diagnostic::error(Code::Override, path, format!("{place}: {}", d.message), None);
        Diagnostic { help, ..at }
    };
    let text = match overrides::apply(scene_text, &common) {
        Ok(text) => text,
        Err(found) => return found.into_iter().map(|d| lost("set".into(), d)).collect(),
    };
    let mut found = Vec::new();
    for (i, axis) in study.axes.iter().enumerate() {
        if let Axis::Random { path, .. } = axis {
            found.extend(refused(&text, &[format!("{path}=0")]).map(|d| lost(format!("axes[{i}]"), d)));
        }
        let part = if matches!(axis, Axis::Vary { .. }) { "values" } else { "choices" };
        for (j, (_, overrides)) in axis.choices().iter().enumerate() {
            found.extend(refused(&text, overrides).map(|d| lost(format!("axes[{i}].{part}[{j}]"), d)));
        }
    }
    if let Reference::Runs { first, second, .. } = &study.reference {
        for (name, values) in [("first", first), ("second", second)] {
            let d = refused(&text, &as_overrides(values));
            found.extend(d.map(|d| lost(format!("reference.{name}"), d)));
        }
    }
    let mut told = HashSet::new();
    found.retain(|d| told.insert(d.message.clone()));
    found
}

/// Path of the parameter of a scene that has the name of a field.
fn parameter(text: &str, field: &str) -> Option<String> {
    let tree = Node::of(text);
    let known = tree.child(text, parameters::FIELD).and_then(|all| all.child(text, field));
    known.map(|_| format!("{}.{field}", parameters::FIELD))
}

/// The first field of a text that no scene has.
fn unknown_field(text: &str) -> Option<Diagnostic> {
    let tree = Node::of(text);
    let (parameters, _) = parameter_values::read(text, &tree).ok()?;
    let found = parse_with::<Scene>(text, &tree, &parameters).err()?.found;
    found.into_iter().find(|d| d.code == Code::UnknownField)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str =
        "(title: \"t\", parameters: (phi: 30), time: (step_s: 1e-3, end_s: 1), materials: [])";

    /// Messages and advice for an argument of `--vary`.
    fn told(vary: &str) -> String {
        let axes = Axis::from_words(&[vary.to_string()]).unwrap();
        let study = Study { axes, ..Study::of_scene("s.ron".into()) };
        let found = lost_paths(&study, SCENE);
        found.iter().map(|d| format!("{}; {}", d.message, d.help.as_deref().unwrap_or_default())).collect()
    }

    #[test]
    fn parameters_that_are_varied_by_a_wrong_path_are_told_with_what_was_meant() {
        assert_eq!(told("parameters.phi=30,40"), "");
        for values in ["30,40", "Uniform(30, 40)"] {
            let short = told(&format!("phi={values}"));
            assert!(short.contains("did you mean `parameters.phi`?"), "{short}");
            let wrong = told(&format!("parameters.phy={values}"));
            assert_eq!(wrong, "parameters.phy: there is no parameter `phy`; did you mean `phi`?; ");
        }
    }
}
