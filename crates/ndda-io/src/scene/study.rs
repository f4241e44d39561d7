//! The study file: a scene, what to vary in it, and what to compare the results with.

mod axis;
mod check;
mod distribution;
mod vary;

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors};
use crate::scene::locate::Node;
use crate::scene::parse;
use crate::scene::read::{self, LoadedScene};

pub(crate) use axis::Values;
pub use axis::{Axis, Choice, as_overrides};
use check::{default_curves, lost_paths, problems};
pub use distribution::Distribution;

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
    /// Whether an accurate run is repeated, from a slightly different start or with half the step, as `ndda run` does: its label is then that of
    /// `ndda run`. The time of the repetition does not count. Default: `Auto`.
    #[serde(default)]
    pub second_runs: SecondRuns,
    /// The cost of a run: wall time or processor time. Default: `Wall`.
    #[serde(default)]
    pub clock: Clock,
    /// The results that cases are compared with. Default: `ClosedForm`.
    #[serde(default)]
    pub reference: Reference,
    /// Quantities of a sweep: nothing is compared with a reference then. Default: none.
    #[serde(default)]
    pub of: Vec<String>,
    /// Samples of what is random. Default: 100.
    #[serde(default = "hundred")]
    pub samples: u32,
    /// How samples are spread. Default: `LatinHypercube`.
    #[serde(default)]
    pub sampling: Sampling,
    /// Seed of the samples. Default: 0.
    #[serde(default)]
    pub seed: u64,
    /// Correlations between random axes. Default: none.
    #[serde(default)]
    pub correlations: Vec<Correlation>,
    /// A condition on a quantity, such as `safety < 1`, whose probability is wanted. Default: none.
    #[serde(default)]
    pub fails_when: Option<String>,
    /// Whether to find how much each random axis matters, which takes samples times the number of such axes and two. Default: false.
    #[serde(default)]
    pub sensitivity: bool,
    /// Relative width of the bracket of factors of safety. Default: 0.01.
    #[serde(default = "hundredth")]
    pub safety_error: f64,
}

/// Whether accurate runs are repeated to see whether their result changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SecondRuns {
    /// Those that have no contact, or are short and have friction or a scheme of first order, or in which three or more blocks have moved, or two that end beside each
    /// other, or in which one has hopped several times with friction in between, or hit twice or more.
    #[default]
    Auto,
    /// All of them.
    Always,
    /// None.
    Never,
}

impl fmt::Display for SecondRuns {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Always => "always",
            Self::Never => "never",
        })
    }
}

impl FromStr for SecondRuns {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        match word {
            "auto" => Ok(Self::Auto),
            "always" => Ok(Self::Always),
            "never" => Ok(Self::Never),
            other => Err(format!("`{other}` is none of auto, always, never")),
        }
    }
}

/// How samples are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sampling {
    /// One sample in each of as many strata of each axis.
    #[default]
    LatinHypercube,
    /// Points of a Sobol' sequence, shifted by the seed.
    Sobol,
}

/// Correlation of two random axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Correlation {
    /// Names of the axes.
    pub between: (String, String),
    /// Coefficient of correlation of the normal numbers that the samples come from, between −1 and 1.
    pub coefficient: f64,
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

fn hundred() -> u32 {
    100
}

fn hundredth() -> f64 {
    0.01
}

impl Study {
    /// A study of a scene in which nothing varies yet.
    pub fn of_scene(scene: PathBuf) -> Self {
        Self {
            title: String::new(),
            scene,
            set: Values::new(),
            axes: Vec::new(),
            curves: None,
            repeats: 1,
            second_runs: SecondRuns::default(),
            clock: Clock::Wall,
            reference: Reference::ClosedForm,
            of: Vec::new(),
            samples: hundred(),
            sampling: Sampling::default(),
            seed: 0,
            correlations: Vec::new(),
            fails_when: None,
            sensitivity: false,
            safety_error: hundredth(),
        }
    }

    /// Whether it asks for quantities of the scene, and compares nothing with a reference.
    pub fn is_sweep(&self) -> bool {
        let is_random = |axis: &Axis| matches!(axis, Axis::Random { .. });
        !self.of.is_empty() || self.fails_when.is_some() || self.axes.iter().any(is_random)
    }
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
        Self { study: Study::of_scene(scene.clone()), curves: Vec::new(), scene, scene_text }
    }

    /// A study of a scene that is not from a file.
    ///
    /// # Errors
    /// Errors of its fields, by their names.
    pub fn checked(study: Study, scene: PathBuf, scene_text: String) -> Result<Self, SceneErrors> {
        let mut diagnostics = problems(&study);
        diagnostics.extend(lost_paths(&study, &scene_text));
        if !diagnostics.is_empty() {
            return Err(SceneErrors { file: scene.display().to_string(), text: String::new(), diagnostics });
        }
        let curves = default_curves(&study);
        Ok(Self { study, curves, scene, scene_text })
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

impl LoadedStudy {
    /// Reads and checks a study file and the scene that it names.
    ///
    /// # Errors
    /// Everything that is wrong with it: syntax and types one at a time, values all at once.
    pub fn load(path: &Path) -> Result<Self, SceneErrors> {
        let text = read::text_of(path)?;
        let fail = |text: &str, diagnostics| SceneErrors {
            file: path.display().to_string(),
            text: text.to_string(),
            diagnostics,
        };
        parse::refuse_blank(&text).map_err(|(text, refused)| fail(text, vec![refused]))?;
        let tree = Node::of(&text);
        let study: Study = parse::parse(&text, &tree).map_err(|found| fail(&text, found))?;
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
        parse::locate_all(&mut found, &text, &tree);
        if !found.is_empty() {
            return Err(fail(&text, found));
        }
        let curves = study.curves.clone().unwrap_or_else(|| default_curves(&study));
        Ok(LoadedStudy { study, curves, scene, scene_text })
    }
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
        LoadedStudy::load(&file).map_err(|errors| errors.render(false))
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
            ("time.step_s", "materials.rock.poisson", "study.ron:3", "without fields"),
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
