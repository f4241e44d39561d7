//! The study file: a scene, what to vary in it, and what to compare the results with.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use ron::value::RawValue;
use serde::Deserialize;

use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors};
use crate::scene::read::{self, LoadedScene};
use crate::scene::suggest;
use crate::scene::{locate, overrides};

/// A study, as it is written.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// One line that says what the study shows.
    pub title: String,
    /// The base scene; its path counts from the study file.
    pub scene: PathBuf,
    /// Values put into the scene in every case, by path. Default: none.
    #[serde(default)]
    pub set: Values,
    /// The quantities that vary; every choice of one axis is combined with every one of the others.
    pub axes: Vec<Axis>,
    /// Axes each of whose choices is a curve of its own; along the others a curve gets finer. Default: all but
    /// those that vary `time.step_s`.
    #[serde(default)]
    pub curves: Option<Vec<String>>,
    /// Runs of each case, of which the fastest counts. Default: 5.
    #[serde(default = "five")]
    pub repeats: u32,
    /// The cost of a run: wall time or processor time. Default: `Wall`.
    #[serde(default)]
    pub clock: Clock,
    /// The results that cases are compared with. Default: `ClosedForm`.
    #[serde(default)]
    pub reference: Reference,
}

/// Values as text, by their paths in the scene.
pub(crate) type Values = BTreeMap<String, Box<RawValue>>;

/// Something that varies.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Axis {
    /// One value of the scene.
    Vary {
        /// Its path, as in `--set`; the last part of it names the axis.
        path: String,
        /// Its values.
        values: Vec<Box<RawValue>>,
    },
    /// Several values that change together, or one whose choices need labels.
    Choose {
        /// Name of the axis.
        name: String,
        /// The choices.
        choices: Vec<Choice>,
    },
}

/// One choice of an axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// Name in tables and pictures.
    pub label: String,
    /// Values by path.
    pub set: Values,
}

/// Time that counts as the cost of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Clock {
    /// That between its start and its end.
    #[default]
    Wall,
    /// That which its threads computed, however busy the machine is with other things.
    Processor,
}

/// The results that cases are compared with.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Reference {
    /// The closed form that the scene names.
    #[default]
    ClosedForm,
    /// Two runs at a short step that must agree; results are compared with the first.
    Runs {
        /// Values by path, at least an integrator.
        first: Values,
        /// Values by path, another integrator.
        second: Values,
        /// Shortest step of the study over the step of these runs. Default: 16.
        #[serde(default = "sixteen")]
        divisor: u32,
        /// Monitors whose displacement is compared. Default: all.
        #[serde(default)]
        monitors: Option<Vec<String>>,
    },
}

fn five() -> u32 {
    5
}

fn sixteen() -> u32 {
    16
}

impl Axis {
    /// Name in tables.
    pub fn name(&self) -> &str {
        match self {
            Self::Vary { path, .. } => locate::segments(path).last().copied().unwrap_or(path),
            Self::Choose { name, .. } => name,
        }
    }

    /// Label and overrides of each choice.
    pub fn choices(&self) -> Vec<(String, Vec<String>)> {
        match self {
            Self::Vary { path, values } => {
                let texts = values.iter().map(|value| value.get_ron().trim());
                texts.map(|text| (text.to_string(), vec![format!("{path}={text}")])).collect()
            }
            Self::Choose { choices, .. } => {
                choices.iter().map(|choice| (choice.label.clone(), as_overrides(&choice.set))).collect()
            }
        }
    }

    /// Whether it varies the value at a path.
    pub(crate) fn varies(&self, path: &str) -> bool {
        match self {
            Self::Vary { path: own, .. } => own == path,
            Self::Choose { choices, .. } => choices.iter().any(|choice| choice.set.contains_key(path)),
        }
    }
}

/// Values as `--set` takes them; a path comes before those below it.
pub fn as_overrides(values: &Values) -> Vec<String> {
    values.iter().map(|(path, value)| format!("{path}={}", value.get_ron().trim())).collect()
}

/// A study that parsed and passed its checks.
#[derive(Clone, Debug)]
pub struct LoadedStudy {
    /// The study.
    pub study: Study,
    /// Its axes that distinguish curves.
    pub curves: Vec<String>,
    /// The scene's file.
    pub scene: PathBuf,
    /// The scene's text, as it is written.
    pub scene_text: String,
}

impl LoadedStudy {
    /// A study in which nothing varies: a scene that is run over and over with values of the caller.
    pub fn of_scene(scene: PathBuf, scene_text: String) -> Self {
        let study = Study {
            title: String::new(),
            scene: scene.clone(),
            set: Values::new(),
            axes: Vec::new(),
            curves: None,
            repeats: 1,
            clock: Clock::Wall,
            reference: Reference::ClosedForm,
        };
        Self { study, curves: Vec::new(), scene, scene_text }
    }

    /// The scene with `overrides` in it.
    ///
    /// # Errors
    /// The errors of the scene with these values.
    pub fn scene_with(&self, overrides: &[String]) -> Result<LoadedScene, SceneErrors> {
        let folder = self.scene.parent().unwrap_or(Path::new("."));
        read::load_text(&self.scene.display().to_string(), &self.scene_text, overrides, Some(folder))
    }
}

/// Reads and checks a study file and the scene that it names.
///
/// # Errors
/// Everything that is wrong with it: syntax and types one at a time, values all at once.
pub fn load(path: &Path) -> Result<LoadedStudy, SceneErrors> {
    let text = read::text_of(path)?;
    let fail = |text: &str, diagnostics| SceneErrors {
        file: path.display().to_string(),
        text: text.to_string(),
        diagnostics,
    };
    read::refuse_blank(&text).map_err(|(text, refused)| fail(text, vec![refused]))?;
    let tree = locate::tree(&text);
    let study: Study = read::parse(&text, &tree).map_err(|found| fail(&text, found))?;
    let scene = path.parent().unwrap_or(Path::new(".")).join(&study.scene);
    let mut found = problems(&study);
    let scene_text = match read::text_of(&scene) {
        Ok(scene_text) => {
            found.extend(lost_paths(&study, &scene_text));
            scene_text
        }
        Err(errors) => {
            let said = errors.diagnostics.first().map_or(String::new(), |d| d.message.clone());
            found.push(Diagnostic::error(
                Code::MissingFile,
                "scene",
                format!("{} {said}", scene.display()),
                None,
            ));
            String::new()
        }
    };
    read::locate_all(&mut found, &text, &tree);
    if !found.is_empty() {
        return Err(fail(&text, found));
    }
    let curves = study.curves.clone().unwrap_or_else(|| default_curves(&study));
    Ok(LoadedStudy { study, curves, scene, scene_text })
}

fn default_curves(study: &Study) -> Vec<String> {
    let others = study.axes.iter().filter(|axis| !axis.varies("time.step_s"));
    others.map(|axis| axis.name().to_string()).collect()
}

/// Errors of a study that do not depend on the scene.
fn problems(study: &Study) -> Vec<Diagnostic> {
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
    let mut names = HashSet::new();
    for (i, axis) in study.axes.iter().enumerate() {
        if axis.name().is_empty() || !names.insert(axis.name()) {
            refuse(format!("axes[{i}]"), format!("the name `{}` is empty or taken: use Choose", axis.name()));
        }
        let (choices, mut labels) = (axis.choices(), HashSet::new());
        if choices.is_empty() {
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
    found
}

/// Paths that lead nowhere in the scene. What values mean is found when a case runs.
fn lost_paths(study: &Study, scene_text: &str) -> Vec<Diagnostic> {
    let refused = |text: &str, overrides: &[String]| overrides::apply(text, overrides).err();
    let common = as_overrides(&study.set);
    let lost = |path: String, d: Diagnostic| {
        Diagnostic::error(Code::Override, path, format!("{}: {}", d.path, d.message), None)
    };
    let text = match overrides::apply(scene_text, &common) {
        Ok(text) => text,
        Err(d) => return vec![lost("set".into(), d)],
    };
    let mut found = Vec::new();
    for (i, axis) in study.axes.iter().enumerate() {
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
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "(title: \"t\", time: (step_s: 1e-3, end_s: 1), materials: [], contact: Off)";

    fn loaded(text: &str) -> Result<LoadedStudy, String> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.ron"), SCENE).unwrap();
        let file = folder.path().join("study.ron");
        std::fs::write(&file, text).unwrap();
        load(&file).map_err(|errors| errors.render(false))
    }

    const STUDY: &str = "(title: \"s\", scene: \"scene.ron\",
    axes: [
        Vary(path: \"time.step_s\", values: [1e-3, 5e-4]),
        Choose(name: \"how\", choices: [
            (label: \"mid\", set: {\"time.integrator\": Midpoint(theta: 0.5)}), // a comment
            (label: \"paper\", set: {\"time.integrator\": Newmark(alpha: 0.5, delta: 1), \"time.mass\": Lumped}),
        ]),
    ],
)";

    #[test]
    fn values_keep_their_text_and_become_overrides() {
        let loaded = loaded(STUDY).unwrap();
        let axes = &loaded.study.axes;
        assert_eq!(axes[0].name(), "step_s");
        assert_eq!(axes[0].choices()[1], ("5e-4".into(), vec!["time.step_s=5e-4".into()]));
        let both = ["time.integrator=Newmark(alpha: 0.5, delta: 1)", "time.mass=Lumped"].map(String::from);
        assert_eq!(axes[1].choices()[1], ("paper".into(), both.to_vec()));
        assert_eq!(loaded.curves, ["how"]);
        assert_eq!((loaded.study.repeats, &loaded.study.reference), (5, &Reference::ClosedForm));
    }

    #[test]
    fn errors_come_with_their_places() {
        for (old, new, place, word) in [
            ("title", "titel", "study.ron:1:2", "titel"),
            ("1e-3, 5e-4", "1e-3, 1e-3", "study.ron:3:9", "twice"),
            ("time.step_s", "materials.rock.poisson", "study.ron:3", "there is"),
            ("scene.ron", "no.ron", "study.ron:1:21", "cannot be read"),
            ("axes: [", "curves: [\"hou\"], axes: [", "study.ron:2:14", "did you mean `how`"),
            ("axes: [", "repeats: 0, axes: [", "study.ron:2:14", "at least 1"),
            ("5e-4", "inf", "study.ron:3", "inf"),
        ] {
            let text = STUDY.replacen(old, new, 1);
            let said = loaded(&text).unwrap_err();
            assert!(said.contains(place) && said.contains(word), "{new}: {said}");
        }
    }
}
