//! Reading a scene: file → text → overrides → types → checks, with every message at its place.

use std::ops::Range;
use std::path::Path;

use crate::scene::check;
pub use crate::scene::chosen::Chosen;
use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors, Severity};
use crate::scene::include;
use crate::scene::locate::Node;
use crate::scene::override_files;
use crate::scene::overrides;
use crate::scene::parameter_values;
use crate::scene::parse::{Mistakes, label_of, locate_all, parse_with, place, refuse_blank, sort};
pub use crate::scene::parse::{is_standard_input, text_of};
use crate::scene::renamed;
pub use crate::scene::suggest::{nearest, suggest};
use crate::scene::{Contact, Scene, is_unset};

/// A scene that parsed and passed its checks.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// Its text, with overrides and the values that were chosen.
    pub text: String,
    /// Its text as it is written, with overrides; messages quote it.
    pub written: String,
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
        let mut texts = vec![self.text.clone()];
        for choice in &chosen {
            let text = with_values(&texts[texts.len() - 1], std::slice::from_ref(choice));
            texts.push(text.map_err(|refused| self.errors(vec![refused]))?);
        }
        match load_text(&self.file, &texts[texts.len() - 1], &[], Some(folder)) {
            Ok(mut loaded) => {
                self.move_back(&mut loaded.warnings, &texts);
                Ok(Self { chosen, written: self.written.clone(), ..loaded })
            }
            Err(mut errors) if errors.file == self.file => {
                self.move_back(&mut errors.diagnostics, &texts);
                Err(self.errors(errors.diagnostics))
            }
            Err(errors) => Err(errors),
        }
    }

    /// Gives messages about the last of some texts their places in the first one, after which each has one more value inserted.
    fn move_back(&self, found: &mut [Diagnostic], texts: &[String]) {
        let tree = Node::of(&self.written);
        for diagnostic in found {
            let Some(Range { mut start, mut end }) = diagnostic.span.clone() else { continue };
            for pair in texts.windows(2).rev() {
                (start, end) = (before(&pair[0], &pair[1], start), before(&pair[0], &pair[1], end));
            }
            // Of a value that is not written, the place is that of what is around it.
            let around = || place(&tree, &self.written, &diagnostic.path);
            diagnostic.span = if start < end { Some(start..end) } else { around() };
        }
    }

    /// An error about the value at `path`, with its place in the text.
    pub fn diagnose(&self, path: &str, message: String) -> Diagnostic {
        let is_of_places = is_of_places(path, &message);
        let (message, cure) = match split_cure(&message) {
            Some((problem, cure)) if !is_of_places => (problem.to_string(), Some(cure.to_string())),
            _ => (message, None),
        };
        let help = match (&self.scene.rockfall, cure) {
            (_, Some(cure)) => cure,
            (Some(_), None) => "`ndda rockfall` lets its boulders fall, and draws where they go".to_string(),
            (None, None) if is_of_places => {
                "`ndda mesh` measures and draws the blocks as they are placed".to_string()
            }
            (None, None) => "docs/reference/scene.md says what this field is for".to_string(),
        };
        self.diagnose_as(Code::CannotBuild, path, message).with_help(help)
    }

    /// A message of a kind about the value at `path`.
    pub fn diagnose_as(&self, code: Code, path: &str, message: String) -> Diagnostic {
        Diagnostic::error(code, path, message, place(&Node::of(&self.written), &self.written, path))
    }

    /// Messages about this scene.
    pub fn errors(&self, diagnostics: Vec<Diagnostic>) -> SceneErrors {
        SceneErrors { file: self.file.clone(), text: self.written.clone(), diagnostics }
    }
}

/// Whether a problem is one of shapes, or of places on blocks, that a picture of them shows.
fn is_of_places(path: &str, message: &str) -> bool {
    let field = path.rsplit('.').next().unwrap_or_default();
    let is_shape = path.starts_with("rock[") || path.starts_with("blocks[") && field == "shape";
    let is_place = field == "on" || path.starts_with("monitors[") && field == "at";
    (is_shape || is_place) && !message.contains("did you mean")
}

/// The cure at the end of a message, and what is before it.
fn split_cure(message: &str) -> Option<(&str, &str)> {
    // A cure may have a colon itself, as before the value of a field.
    let parts = message.rmatch_indices(": ").map(|(at, _)| (&message[..at], &message[at + 2..]));
    parts.into_iter().find(|(_, cure)| CURES.iter().any(|begins| cure.starts_with(begins)))
}

/// How cures begin.
const CURES: [&str; 11] = [
    "did you mean ",
    "give ",
    "make ",
    "use ",
    "take ",
    "move ",
    "leave ",
    "hold ",
    "add ",
    "correct ",
    "write ",
];

/// Byte of a text that a byte of the text with something inserted comes from.
fn before(short: &str, long: &str, at: usize) -> usize {
    let same = short.bytes().zip(long.bytes()).take_while(|(a, b)| a == b).count();
    if at <= same { at } else { at.saturating_sub(long.len().saturating_sub(short.len())).max(same) }
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
/// Everything that is wrong with it, as far as the rest can be read: mistakes of grammar but for missing commas hide what comes after them.
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
    let text = overrides::apply(text, overrides).map_err(|refused| fail(text, refused))?;
    let tree = Node::of(&text);
    let (parameters, refused) = parameter_values::read(&text, &tree).map_err(|found| fail(&text, found))?;
    let mut scene: Scene = match parse_with(&text, &tree, &parameters) {
        Ok(scene) if refused.is_empty() => scene,
        parsed => {
            let mut mistakes = parsed.map_or_else(|mistakes| mistakes, Mistakes::none_in);
            mistakes.found.extend(refused);
            return Err(fail(&text, with_mistakes_of_values(mistakes, (&text, &tree), folder)));
        }
    };
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
    Ok(LoadedScene {
        scene,
        written: text.clone(),
        text,
        file: file.to_string(),
        warnings: found,
        chosen: Vec::new(),
    })
}

/// Mistakes of fields and types, and beside them values out of their range and names of nothing, but for those that may follow from them.
fn with_mistakes_of_values(
    mistakes: Mistakes<Scene>,
    (text, tree): (&str, &Node),
    folder: Option<&Path>,
) -> Vec<Diagnostic> {
    let mut found = mistakes.found;
    if let Some(rest) = mistakes.rest {
        let has_all_names = mistakes.has_all_names && rest.include.is_empty();
        let mut values = check::problems(&rest, folder);
        values.retain(|d| {
            let is_told = d.code == Code::OutOfRange || has_all_names && d.code == Code::UnknownName;
            let at = place(tree, text, &d.path).unwrap_or_default();
            let is_doubtful = mistakes.doubtful.iter().any(|part| part.start < at.end && at.start < part.end);
            d.severity == Severity::Error && is_told && !is_doubtful
        });
        locate_all(&mut values, text, tree);
        found.extend(values);
    }
    sort(&mut found);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cure_may_have_a_colon_itself() {
        let split = split_cure("depth is zero: give it an interior node, or take `potential: Element`");
        assert_eq!(split, Some(("depth is zero", "give it an interior node, or take `potential: Element`")));
        assert_eq!(split_cure("t: 3, 4: is no number"), None);
    }

    #[test]
    fn the_picture_of_blocks_is_advised_where_it_shows_what_is_wrong() {
        let text = "(title: \"t\", time: (step_s: 1e-3, end_s: 1),
  materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 2e10, poisson: 0.2)],
  blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])";
        let loaded = load_text("s.ron", text, &[], None).unwrap();
        let helps = |path: &str, message: &str| {
            loaded.diagnose(path, message.into()).help.is_some_and(|help| help.starts_with("`ndda mesh`"))
        };
        assert!(helps("blocks[0].shape", "is open") && helps("supports[0].on", "no node is in this region"));
        assert!(helps("monitors[0].at", "is outside") && helps("rock[0].removed", "no block is left"));
        for path in ["supports[0]", "forces[0].at_m", "bolts[0].at", "quiet[0].incident[0]", "contact"] {
            assert!(!helps(path, "is wrong"), "{path}");
        }
        let meant = loaded.diagnose("supports[0].on", "there is no set `zmin`: did you mean `z_min`?".into());
        assert_eq!(meant.message, "there is no set `zmin`");
        assert_eq!(meant.help.unwrap(), "did you mean `z_min`?");
    }

    #[test]
    fn messages_quote_the_text_as_it_is_written_after_values_have_been_chosen() {
        let text = "(title: \"t\", parameters: (unused: 1), time: (end_s: 1),
  materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 2e10, poisson: 0.2)],
  blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
  contact: Potential(potential: Smooth(), friction: (friction_deg: 0.5)), output: (frames: 200000))";
        let loaded = load_text("s.ron", text, &[], None).unwrap();
        let chosen = |path: &str, value: f64| Chosen { path: path.into(), value, reason: "a \u{3c1}".into() };
        let all = vec![chosen("contact.penalty_pa", 1e9), chosen("time.step_s", 1e-4)];
        let complete = loaded.with_chosen(all, Path::new(".")).unwrap();
        assert!(complete.text.contains("step_s: 1e-4 /*") && complete.scene.time.step_s == 1e-4);
        assert_eq!(complete.warnings, loaded.warnings);
        assert!(complete.warnings.len() > 2, "{:?}", complete.warnings);
        let at = |path: &str| complete.diagnose(path, String::new()).span.unwrap();
        assert_eq!(&text[at("output.frames")], "200000");
        assert_eq!(complete.errors(Vec::new()).text, text);
        // What was chosen is not written: its place is that of what is around it.
        let refused = loaded.with_chosen(vec![chosen("time.step_s", -1.0)], Path::new(".")).unwrap_err();
        let wrong = refused.diagnostics.iter().find(|found| found.path == "time.step_s").unwrap();
        assert_eq!(&refused.text[wrong.span.clone().unwrap()], "(end_s: 1)");
    }
}
