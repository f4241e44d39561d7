//! Reading a scene: file → text → overrides → types → checks, with every message at its place.

use std::path::Path;

use crate::scene::check;
use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors, Severity};
use crate::scene::include;
use crate::scene::locate::{self, Node};
use crate::scene::override_files;
use crate::scene::overrides;
use crate::scene::parameter_values;
use crate::scene::parse::{Mistakes, label_of, locate_all, parse_with, place, refuse_blank, sort};
pub use crate::scene::parse::{is_standard_input, text_of};
use crate::scene::renamed;
pub use crate::scene::suggest::{nearest, suggest};
use crate::scene::{Contact, Scene, is_unset};
use crate::summary::Chosen;

/// A scene that parsed and passed its checks.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// Its text, overrides included.
    pub text: String,
    /// The file, as it was named.
    pub file: String,
    /// Entries that are probably not meant.
    pub warnings: Vec<Diagnostic>,
    /// Values that were left out and have been chosen.
    pub chosen: Vec<Chosen>,
}

impl LoadedScene {
    /// Whether it leaves out a value that is chosen before a run.
    pub fn is_complete(&self) -> bool {
        let penalty = match &self.scene.contact {
            Some(Contact::Potential { penalty_pa, .. }) => is_unset(penalty_pa),
            _ => false,
        };
        self.scene.rockfall.is_some() || !penalty && !is_unset(&self.scene.time.step_s)
    }

    /// The scene with values that were chosen for it, also in its text.
    ///
    /// # Errors
    /// Errors of the scene with these values.
    pub fn with_chosen(&self, chosen: Vec<Chosen>, folder: &Path) -> Result<Self, SceneErrors> {
        let text = with_values(&self.text, &chosen).map_err(|refused| self.errors(vec![refused]))?;
        let loaded = load_text(&self.file, &text, &[], Some(folder))?;
        Ok(Self { chosen, ..loaded })
    }

    /// An error about the value at `path`, with its place in the text.
    pub fn diagnose(&self, path: &str, message: String) -> Diagnostic {
        let help = match &self.scene.rockfall {
            Some(_) => "`ndda rockfall` lets its boulders fall, and draws where they go",
            None => "`ndda mesh` measures and draws the blocks as they are placed",
        };
        self.diagnose_as(Code::CannotBuild, path, message).with_help(help)
    }

    /// A message of a kind about the value at `path`.
    pub fn diagnose_as(&self, code: Code, path: &str, message: String) -> Diagnostic {
        Diagnostic::error(code, path, message, place(&locate::tree(&self.text), &self.text, path))
    }

    /// Messages about this scene.
    pub fn errors(&self, diagnostics: Vec<Diagnostic>) -> SceneErrors {
        SceneErrors { file: self.file.clone(), text: self.text.clone(), diagnostics }
    }
}

/// The text of a scene with values that were chosen for it, and their reasons as comments.
///
/// # Errors
/// The text has no place for one.
pub fn with_values(text: &str, chosen: &[Chosen]) -> Result<String, Diagnostic> {
    chosen.iter().try_fold(text.to_string(), |text, Chosen { path, value, reason }| {
        let put = overrides::put(&text, path, &format!("{value:e} /* {} */", reason.replace("*/", "")));
        put.map_err(|reason| Diagnostic::error(Code::Override, path.as_str(), reason, None))
    })
}

/// Reads and checks a scene file, or standard input for `-`; files that it names are then beside the present folder.
///
/// # Errors
/// Everything that is wrong with it: syntax and types one at a time, values all at once.
pub fn load(path: &Path, overrides: &[String]) -> Result<LoadedScene, SceneErrors> {
    let text = text_of(path)?;
    let folder = path.parent().unwrap_or(Path::new("."));
    load_text(&label_of(path), &text, overrides, Some(folder))
}

/// Reads and checks the text of a scene; `folder` is where its meshes are, if they are to be looked for. Overrides are `path=value`, or
/// `@FILE` for those in the lines of a file.
///
/// # Errors
/// As [`load`].
pub fn load_text(
    file: &str,
    text: &str,
    overrides: &[String],
    folder: Option<&Path>,
) -> Result<LoadedScene, SceneErrors> {
    let expanded = override_files::expanded(overrides);
    let overrides = expanded.as_deref().unwrap_or(overrides);
    let fail = |text: &str, mut diagnostics: Vec<Diagnostic>| {
        overrides::blame(&mut diagnostics, text, overrides);
        SceneErrors { file: file.to_string(), text: text.to_string(), diagnostics }
    };
    if let Err(refused) = &expanded {
        return Err(fail(text, vec![refused.clone()]));
    }
    refuse_blank(text).map_err(|(text, refused)| fail(text, vec![refused]))?;
    let text = overrides::apply(text, overrides).map_err(|refused| fail(text, vec![refused]))?;
    let tree = locate::tree(&text);
    let parameters = parameter_values::read(&text, &tree).map_err(|found| fail(&text, found))?;
    let mut scene: Scene = parse_with(&text, &tree, &parameters)
        .map_err(|mistakes| fail(&text, with_values_out_of_range(mistakes, (&text, &tree), folder)))?;
    let beside = folder.unwrap_or(Path::new("."));
    let included = include::read(&mut scene, beside, (file, &text), &parameters)?;
    let mut found = check::problems(&scene, folder);
    include::name_files(&mut found, &included);
    locate_all(&mut found, &text, &tree);
    found.extend(parameters.unused());
    found.extend(renamed::warnings(&text, &tree, overrides));
    sort(&mut found);
    if found.iter().any(|d| d.severity == Severity::Error) {
        return Err(fail(&text, found));
    }
    Ok(LoadedScene { scene, text, file: file.to_string(), warnings: found, chosen: Vec::new() })
}

/// Fields that do not exist, and values out of their range beside them. Other checks might miss what was meant by those fields.
fn with_values_out_of_range(
    mistakes: Mistakes<Scene>,
    (text, tree): (&str, &Node),
    folder: Option<&Path>,
) -> Vec<Diagnostic> {
    let mut found = mistakes.found;
    if let Some(rest) = mistakes.rest {
        let mut values = check::problems(&rest, folder);
        values.retain(|d| d.code == Code::OutOfRange && d.severity == Severity::Error);
        locate_all(&mut values, text, tree);
        found.extend(values);
        sort(&mut found);
    }
    found
}
