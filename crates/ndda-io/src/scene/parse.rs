//! Text to types: grammar, units, expressions and types, with every message at its place.

use std::ops::Range;
use std::path::Path;

use ron::error::{Error as RonError, Position, SpannedError};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors};
use crate::scene::locate::{self, Node};
use crate::scene::parameters::Parameters;
use crate::scene::suggest::suggest;
use crate::scene::units::{self, Resolved};

/// The text of a scene or study file.
///
/// # Errors
/// It cannot be read, or is no text.
pub fn text_of(path: &Path) -> Result<String, SceneErrors> {
    let file = path.display().to_string();
    let unreadable = |message: String, help: &str| SceneErrors {
        file: file.clone(),
        text: String::new(),
        diagnostics: vec![Diagnostic::error(Code::Unreadable, "", message, None).with_help(help)],
    };
    if path.is_dir() {
        return Err(unreadable("is a folder".into(), "name a scene file, such as scenes/sliding_45.ron"));
    }
    let bytes = std::fs::read(path)
        .map_err(|e| unreadable(format!("cannot be read: {e}"), "check the path of the scene file"))?;
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let line = e.as_bytes()[..at].iter().filter(|&&b| b == b'\n').count() + 1;
        let message = format!("is not UTF-8 text (byte {at}, line {line})");
        unreadable(message, "save the file as UTF-8")
    })
}

/// Refuses a text that begins with a byte order mark, or is empty; returns the text to show with it.
pub(crate) fn refuse_blank(text: &str) -> Result<(), (&str, Diagnostic)> {
    if let Some(rest) = text.strip_prefix('\u{feff}') {
        let begins =
            Diagnostic::error(Code::Syntax, "", "the file begins with a byte order mark", Some(0..0));
        return Err((rest, begins.with_help("save it as UTF-8 without BOM")));
    }
    if text.trim().is_empty() {
        let empty = Diagnostic::error(Code::Truncated, "", "the file is empty", Some(0..0));
        return Err((text, empty.with_help("begin with one that runs: `ndda new` writes it")));
    }
    Ok(())
}

/// Text of a scene, or of a file that it includes, to types: values in the units of their fields, expressions as numbers.
/// Numbers that are none are found all at once, grammar and types one at a time.
pub(crate) fn parse_with<T: DeserializeOwned>(
    text: &str,
    tree: &Node,
    parameters: &Parameters,
) -> Result<T, Vec<Diagnostic>> {
    refuse_not_finite(tree, text)?;
    types_of(&units::resolve(text, tree, parameters), text, tree)
}

/// Text of a study to types; the values that it sets stay as they are written, and are read with the scene.
pub(crate) fn parse<T: DeserializeOwned>(text: &str, tree: &Node) -> Result<T, Vec<Diagnostic>> {
    refuse_not_finite(tree, text)?;
    types_of(&Resolved::unchanged(text), text, tree)
}

fn types_of<T: DeserializeOwned>(plain: &Resolved, text: &str, tree: &Node) -> Result<T, Vec<Diagnostic>> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    match options.from_str(&plain.text) {
        Ok(value) if plain.errors.is_empty() => Ok(value),
        // In a field that does not exist, no unit is right.
        Err(e) if plain.errors.is_empty() || matches!(e.code, RonError::NoSuchStructField { .. }) => {
            Err(vec![explain(&e, plain, text, tree)])
        }
        _ => Err(plain.errors.clone()),
    }
}

/// Gives each message its place, and puts them in the order of the text.
pub(crate) fn locate_all(found: &mut [Diagnostic], text: &str, tree: &Node) {
    for diagnostic in found.iter_mut() {
        diagnostic.span = place(tree, text, &diagnostic.path);
    }
    sort(found);
}

pub(crate) fn sort(found: &mut [Diagnostic]) {
    found.sort_by_key(|d| d.span.as_ref().map_or(0, |span| span.start));
}

/// Place of the value at a path, or of the nearest value around it that is written.
pub(crate) fn place(tree: &Node, text: &str, path: &str) -> Option<Range<usize>> {
    let mut node = tree;
    for segment in locate::segments(path) {
        match node.child(text, segment) {
            Some(child) => node = child,
            None => break,
        }
    }
    Some(node.span.clone())
}

/// Numbers that RON accepts and nothing can be computed with: NaN, infinities, and 1e400.
fn refuse_not_finite(tree: &Node, text: &str) -> Result<(), Vec<Diagnostic>> {
    let mut found = Vec::new();
    tree.for_each_leaf(&mut |leaf| {
        let word = &text[leaf.span.clone()];
        let digits = word.replace('_', "");
        let looks_like_number = digits.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
            || ["NaN", "inf"].contains(&digits.as_str());
        if looks_like_number && digits.parse::<f64>().is_ok_and(|number| !number.is_finite()) {
            let path = tree.path_at(leaf.span.start);
            let message = format!("{word} is not a number that one can compute with");
            let place = Some(leaf.span.clone());
            let help = "numbers are finite, at most 1.8e308 in size";
            found.push(Diagnostic::error(Code::NotFinite, path, message, place).with_help(help));
        }
    });
    if found.is_empty() { Ok(()) } else { Err(found) }
}

/// RON's complaint in the words of a scene, at the place in the source where a person would look.
fn explain(error: &SpannedError, plain: &Resolved, text: &str, tree: &Node) -> Diagnostic {
    let byte = |position: &Position| plain.source(offset(&plain.text, position)).min(text.len());
    let start = byte(&error.span.start);
    let span = start..byte(&error.span.end).max(start);
    let path = tree.path_at(start);
    let at = |code: Code, message: String| Diagnostic::error(code, path.clone(), message, Some(span.clone()));
    let of = |outer: &Option<String>| outer.as_ref().map_or(String::new(), |name| format!(" of `{name}`"));
    match &error.code {
        RonError::NoSuchStructField { expected, found, outer } => {
            at(Code::UnknownField, format!("there is no field `{found}`{}", of(outer)))
                .with_help(suggest(found, expected))
        }
        RonError::NoSuchEnumVariant { expected, found, outer } => {
            at(Code::UnknownChoice, format!("`{found}` is no choice{}", of(outer)))
                .with_help(suggest(found, expected))
        }
        RonError::MissingStructField { field, outer } => {
            // RON points at the closing bracket; the struct is what lacks the field.
            let inside = start.saturating_sub(1);
            let span = tree.innermost(inside).map_or(span.clone(), |node| node.span.clone());
            let path = tree.path_at(span.start);
            let message = format!("the field `{field}`{} is missing", of(outer));
            Diagnostic::error(Code::MissingField, path, message, Some(span))
                .with_help(format!("write `{field}: …,` (see docs/reference/scene.md)"))
        }
        RonError::DuplicateStructField { field, outer } => {
            at(Code::DuplicateField, format!("the field `{field}`{} is written twice", of(outer)))
                .with_help("keep one of them")
        }
        RonError::Eof => at(Code::Truncated, "the file ends before the scene does".into())
            .with_help("a closing bracket is missing, or the file was cut off"),
        RonError::InvalidValueForType { expected, found } => {
            at(Code::WrongType, format!("expected {expected}, found {found}"))
                .with_help("see docs/reference/scene.md for this field")
        }
        RonError::ExpectedComma => {
            let (kind, message, help) = comma(text, start);
            at(kind, message.into()).with_help(help)
        }
        code => {
            let (kind, help) = grammar(code);
            at(kind, in_words(code)).with_help(help)
        }
    }
}

/// Diagnosis of the character that stands where a comma should.
fn comma(text: &str, at: usize) -> (Code, &'static str, &'static str) {
    let after_number = text[..at].ends_with(|c: char| c.is_ascii_digit());
    // At the end, RON shows the bracket before it.
    let rest = text[at..].trim_start_matches([')', ']']).trim_start();
    match text[at..].chars().next() {
        _ if rest.is_empty() => (
            Code::Truncated,
            "the file ends before the scene does",
            "a closing bracket is missing, or the file was cut off",
        ),
        Some('.') if after_number => (Code::WrongType, "expected a whole number", "write it without a point"),
        Some(c) if after_number && c.is_alphabetic() => (
            Code::Syntax,
            "a number has no unit after it",
            "it is in the unit of the field's name; another one is written around it: Millisecond(0.1)",
        ),
        _ => (
            Code::Syntax,
            "expected a comma",
            "a comma is missing before this, a bracket is one too many, or a text above is not closed",
        ),
    }
}

/// RON's words for what it expected, in those of a scene.
fn in_words(error: &RonError) -> String {
    match error {
        RonError::ExpectedFloat => "expected a number".into(),
        RonError::ExpectedInteger | RonError::IntegerOutOfBounds => "expected a whole number".into(),
        RonError::ExpectedString => "expected a text in quotes".into(),
        RonError::ExpectedIdentifier => "expected one of the choices by its name".into(),
        other => lowercase_first(&other.to_string()),
    }
}

/// Kind of a syntax error, and its remedy.
fn grammar(error: &RonError) -> (Code, &'static str) {
    match error {
        RonError::ExpectedMapColon => (Code::Syntax, "a field is `name: value`"),
        RonError::ExpectedArrayEnd => (Code::Syntax, "a comma or `]` is missing before this"),
        RonError::ExpectedStructLikeEnd => {
            (Code::WrongType, "a comma or `)` is missing, or there is one value too many")
        }
        RonError::TrailingCharacters => (Code::Syntax, "a bracket before this closes the scene too early"),
        RonError::ExpectedString => (Code::WrongType, "write the text between quotes: \"text\""),
        RonError::ExpectedInteger | RonError::IntegerOutOfBounds => {
            (Code::WrongType, "counts are whole numbers from 0 to 4294967295")
        }
        RonError::ExpectedFloat => (
            Code::WrongType,
            "write a number, such as 1.5 or 20e9, or one with its unit, such as Megapascal(20)",
        ),
        RonError::ExpectedIdentifier => {
            (Code::WrongType, "see docs/reference/scene.md for the choices of this field")
        }
        RonError::ExpectedDifferentLength { .. } => {
            (Code::WrongType, "see docs/reference/scene.md for this field")
        }
        RonError::ExpectedArray => (Code::WrongType, "a list is written between [ and ]"),
        RonError::ExpectedStructLike | RonError::ExpectedNamedStructLike(_) => {
            (Code::WrongType, "structs and vectors are written between ( and )")
        }
        RonError::ExpectedDifferentStructName { .. } => {
            (Code::WrongType, "leave the name before the bracket out")
        }
        RonError::UnclosedBlockComment => (Code::Truncated, "close it with */"),
        RonError::ExpectedStringEnd => (Code::Truncated, "close the text with a quote"),
        _ => (Code::Syntax, "see docs/reference/scene.md for how scenes are written"),
    }
}

fn lowercase_first(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
}

/// Byte of a line and column, both from 1 and in characters.
fn offset(text: &str, position: &Position) -> usize {
    let line_start =
        text.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum::<usize>();
    let line = &text[line_start.min(text.len())..];
    let inside = line.char_indices().nth(position.col.saturating_sub(1)).map_or(line.len(), |(i, _)| i);
    line_start.min(text.len()) + inside
}
