//! Reading a scene: file → text → overrides → types → checks, with every message at its place.

use std::path::Path;

use crate::scene::Scene;
use crate::scene::check;
use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors, Severity};
use crate::scene::include;
use crate::scene::locate;
use crate::scene::overrides;
use crate::scene::parameter_values;
pub use crate::scene::parse::text_of;
use crate::scene::parse::{locate_all, parse_with, place, refuse_blank, sort};
use crate::scene::renamed;
pub use crate::scene::suggest::{nearest, suggest};

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
}

impl LoadedScene {
    /// An error about the value at `path`, with its place in the text.
    pub fn diagnose(&self, path: &str, message: String) -> Diagnostic {
        let found = self.diagnose_as(Code::CannotBuild, path, message);
        found.with_help("`ndda mesh` measures and draws the blocks as they are placed")
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

/// Reads and checks a scene file.
///
/// # Errors
/// Everything that is wrong with it: syntax and types one at a time, values all at once.
pub fn load(path: &Path, overrides: &[String]) -> Result<LoadedScene, SceneErrors> {
    let text = text_of(path)?;
    let folder = path.parent().unwrap_or(Path::new("."));
    load_text(&path.display().to_string(), &text, overrides, Some(folder))
}

/// Reads and checks the text of a scene; `folder` is where its meshes are, if they are to be looked for.
///
/// # Errors
/// As [`load`].
pub fn load_text(
    file: &str,
    text: &str,
    overrides: &[String],
    folder: Option<&Path>,
) -> Result<LoadedScene, SceneErrors> {
    let fail = |text: &str, mut diagnostics: Vec<Diagnostic>| {
        overrides::blame(&mut diagnostics, text, overrides);
        SceneErrors { file: file.to_string(), text: text.to_string(), diagnostics }
    };
    refuse_blank(text).map_err(|(text, refused)| fail(text, vec![refused]))?;
    let text = overrides::apply(text, overrides).map_err(|refused| fail(text, vec![refused]))?;
    let tree = locate::tree(&text);
    let parameters = parameter_values::read(&text, &tree).map_err(|found| fail(&text, found))?;
    let mut scene: Scene = parse_with(&text, &tree, &parameters).map_err(|found| fail(&text, found))?;
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
    Ok(LoadedScene { scene, text, file: file.to_string(), warnings: found })
}
