//! `--set @FILE`: overrides in a file, one a line, where they are too many for a command line.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use crate::scene::code::Code;
use crate::scene::diagnostic::Diagnostic;
use crate::{WriteError, atomic, limited};

/// What the name of a file begins with, and no path in a scene.
const FILE: char = '@';
/// What a line begins with that is a comment.
const COMMENT: &str = "//";

/// Writes overrides to files, the first to `file(1)`, and returns the words that stand for all of them behind `--set`: the names of these
/// files, and overrides that are no line of a file as they are. Later values win, so that the order is kept.
///
/// # Errors
/// [`WriteError`] when a file cannot be written.
pub fn write(overrides: &[String], file: impl Fn(usize) -> PathBuf) -> Result<Vec<String>, WriteError> {
    let mut words = Vec::new();
    for some in overrides.chunk_by(|a, b| fits_a_line(a) && fits_a_line(b)) {
        let file = file(words.len() + 1);
        match word_for(&file).filter(|_| fits_a_line(&some[0])) {
            Some(word) => {
                atomic::write(&file, (some.join("\n") + "\n").as_bytes())?;
                words.push(word);
            }
            None => words.extend_from_slice(some),
        }
    }
    Ok(words)
}

/// Whether an override can be a line of a file as it is.
fn fits_a_line(one: &str) -> bool {
    let line = one.trim();
    !line.is_empty() && line == one && !one.contains(['\n', '\r']) && !line.starts_with([FILE, '/'])
}

/// The word for `--set` that stands for the overrides in a file.
fn word_for(file: &Path) -> Option<String> {
    file.to_str().map(|name| format!("{FILE}{name}"))
}

/// The overrides, with those of a file in the place of each `@FILE`. Blank lines of a file and those that begin with `//` are left out.
///
/// # Errors
/// A diagnostic when a file cannot be read, or names another.
pub(crate) fn expanded(overrides: &[String]) -> Result<Cow<'_, [String]>, Diagnostic> {
    if !overrides.iter().any(|one| one.starts_with(FILE)) {
        return Ok(Cow::Borrowed(overrides));
    }
    let mut all = Vec::new();
    for one in overrides {
        match one.strip_prefix(FILE) {
            Some(name) => all.extend(lines(one, name)?),
            None => all.push(one.clone()),
        }
    }
    Ok(Cow::Owned(all))
}

fn lines(one: &str, name: &str) -> Result<Vec<String>, Diagnostic> {
    let refuse = |message: String, help: &str| {
        Diagnostic::error(Code::Override, format!("--set {one}"), message, None).with_help(help)
    };
    let help = "@ stands before the name of a file with one PATH=VALUE on each line";
    let bytes = limited::stream(Path::new(name))
        .map_err(|error| refuse(format!("the file `{name}` cannot be read: {error}"), help))?;
    let text = String::from_utf8(bytes)
        .map_err(|_| refuse(format!("the file `{name}` is not UTF-8 text"), "save the file as UTF-8"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with(COMMENT));
    let lines: Vec<String> = lines.map(String::from).collect();
    match lines.iter().find(|line| line.starts_with(FILE)) {
        Some(line) => {
            let message = format!("a line of `{name}` names another file: `{line}`");
            Err(refuse(message, "give each file by a --set of its own"))
        }
        None => Ok(lines),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::read::load_text;

    const SCENE: &str = "(title: \"t\", time: (step_s: 1e-3, end_s: 1), contact: Off,
        materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 1e10, poisson: 0.25)],
        blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])";

    #[test]
    fn values_of_a_file_stand_where_the_file_is_named_and_later_ones_win() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("values.txt");
        std::fs::write(&file, "\u{feff}// a comment\ntime.step_s=1e-4\r\n\n  time.end_s = 2\n").unwrap();
        let word = word_for(&file).unwrap();
        let time = |set: &[&str]| {
            let set: Vec<String> = set.iter().map(ToString::to_string).collect();
            let scene =
                load_text("s.ron", SCENE, &set, None).unwrap_or_else(|e| panic!("{}", e.render(false)));
            (scene.scene.time.step_s, scene.scene.time.end_s)
        };
        assert_eq!(time(&[&word]), (1e-4, 2.0));
        assert_eq!(time(&["time.step_s=1e-5", &word, "time.end_s=3"]), (1e-4, 3.0));
    }

    #[test]
    fn a_file_that_is_missing_wrong_or_names_another_is_refused_by_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("values.txt");
        let said = |content: Option<&[u8]>| {
            content.into_iter().for_each(|content| std::fs::write(&file, content).unwrap());
            let errors = load_text("s.ron", SCENE, &[word_for(&file).unwrap()], None).unwrap_err();
            errors.render(false)
        };
        assert!(said(None).contains("cannot be read"));
        assert!(said(Some(b"@other.txt\n")).contains("names another file: `@other.txt`"));
        assert!(said(Some(b"time.step_s=\xff\n")).contains("is not UTF-8"));
        // What is wrong with a line is said as if it had been typed.
        assert!(said(Some(b"time.stp_s=1\n")).contains("stp_s"));
        assert!(said(Some(b"time.step_s\n")).contains("--set time.step_s"));
    }

    #[test]
    fn what_a_file_would_not_give_back_does_not_fit_a_line() {
        for one in ["time.step_s=1", "monitors=[(name: \"a // b\", block: \"a\")]"] {
            assert!(fits_a_line(one), "{one}");
        }
        for one in ["@file", "// x", "a=1\nb=2", "", " a=1"] {
            assert!(!fits_a_line(one), "{one:?}");
        }
    }
}
