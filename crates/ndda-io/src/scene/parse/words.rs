//! Errors of the RON parser in terms of a scene.

use ron::error::{Error as RonError, Position, SpannedError};

use crate::scene::code::Code;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::locate::{Node, segments};
use crate::scene::parameters::FIELD;
use crate::scene::parse::choices::brackets_of_choice;
use crate::scene::suggest::suggest;
use crate::scene::units::{self, Resolved};

/// Counts, in words.
const COUNTS: &str = "counts are whole numbers from 0 to 4294967295";
/// How serde begins its words for a choice that takes several values in brackets.
const VARIANT: &str = "tuple variant ";
/// Where fields and choices are listed.
pub(super) const REFERENCE: &str = "docs/reference/scene.md lists the fields and their choices";

/// RON's complaint in the words of a scene, at the place in the source where a person would look.
pub(super) fn explain(error: &SpannedError, plain: &Resolved, text: &str, tree: &Node) -> Diagnostic {
    let begins = offset(&plain.text, &error.span.start);
    let byte = |offset: usize| plain.source(offset).min(text.len());
    // RON stops before the blank in front of what it does not like.
    let stops = byte(begins);
    let start = Some(after_blanks(text, stops)).filter(|at| *at < text.len()).unwrap_or(stops);
    let span = start..byte(offset(&plain.text, &error.span.end)).max(start);
    let path = tree.path_at(start);
    let at = |code: Code, message: String| Diagnostic::error(code, path.clone(), message, Some(span.clone()));
    // The name of a choice is said where it is written: `Box(…)`, but not that of `time: (…)`.
    let of = |outer: &Option<String>| {
        let word = tree.innermost(start).map_or("", |node| node.word(text));
        outer.as_ref().filter(|name| *name == word).map_or(String::new(), |name| format!(" of `{name}`"))
    };
    match &error.code {
        RonError::NoSuchStructField { found, .. } if is_choice(found, text, start) => {
            let message = format!("a closing bracket is missing before `{found}`");
            at(Code::Syntax, message).with_help("close what stands before it with `)`")
        }
        RonError::NoSuchStructField { expected, found, outer } => {
            at(Code::UnknownField, format!("there is no field `{found}`{}", of(outer)))
                .with_help(suggest(found, expected))
        }
        RonError::NoSuchEnumVariant { expected, found, .. } => {
            let field = path.rsplit('.').next().filter(|field| !field.is_empty() && !field.ends_with(']'));
            let field = field.map_or("here".to_string(), |field| format!("of `{field}`"));
            at(Code::UnknownChoice, format!("`{found}` is not a choice {field}"))
                .with_help(suggest(found, expected))
        }
        RonError::MissingStructField { field, outer } => {
            // RON points at the closing bracket; the struct is what lacks the field.
            let span = tree.closed_at(start).map_or(span.clone(), |node| node.span.clone());
            let path = tree.path_at(span.start);
            let message = format!("the field `{field}`{} is missing", of(outer));
            Diagnostic::error(Code::MissingField, path, message, Some(span))
                .with_help(format!("write {field}: {} (see docs/reference/scene.md)", example(field)))
        }
        RonError::DuplicateStructField { field, outer } => {
            at(Code::DuplicateField, format!("the field `{field}`{} is written twice", of(outer)))
                .with_help("keep one of them")
        }
        code if *code == RonError::Eof || begins_at_end(code, text, start) => {
            at(Code::Truncated, "the file ends before the scene does".into())
                .with_help("a closing bracket is missing, or the file was cut off")
        }
        RonError::InvalidValueForType { expected, found } => {
            let message = format!("expected {}, found {}", plain_words(expected), plain_words(found));
            at(Code::WrongType, message).with_help(REFERENCE)
        }
        code => {
            if let Some((message, help)) = look_alike(text, start) {
                return at(Code::Syntax, message).with_help(help);
            }
            if let Some((begins, number)) = decimal_comma(code, text, start) {
                let message = format!("`{}` is two values", number.replace('.', ","));
                let found = Diagnostic { path: tree.path_at(begins), ..at(Code::Syntax, message) };
                return found.with_help(format!("write a decimal point: {number}"));
            }
            if let Some(name) = parameter_at(code, text, start, tree) {
                let message = format!("`{name}` is a parameter, and not a number by itself");
                return at(Code::WrongType, message).with_help(format!("write Calc({name})"));
            }
            if let Some((message, help)) = brackets_of_choice(code, text, start) {
                return at(Code::WrongType, message).with_help(help);
            }
            if let Some((number, field, symbol)) = unit_behind(code, text, start, tree) {
                let message = format!("`{number} {symbol}`: {}", units::NOT_BEHIND);
                return Diagnostic { path: field.0, ..at(Code::Syntax, message) }
                    .with_help(units::advice(number, symbol, &field.1));
            }
            if let Some(help) = bare_number(text, start, &path) {
                return at(Code::WrongType, in_words(code)).with_help(help);
            }
            let (kind, message, help) = no_count(code, &plain.text, begins)
                .map(|message| (Code::WrongType, message, COUNTS))
                .unwrap_or_else(|| grammar(code, text, start));
            at(kind, message).with_help(help)
        }
    }
}

/// That a character looks like one of a scene, and is another: the minus and the quotes of a word processor, the sign of comments of other languages.
fn look_alike(text: &str, at: usize) -> Option<(String, &'static str)> {
    let found = text[at..].chars().next()?;
    let help = match found {
        '\u{2212}' | '\u{2013}' | '\u{2014}' => "write the minus of the keyboard: -",
        '\u{201c}' | '\u{201d}' | '\u{201e}' | '\u{2018}' | '\u{2019}' | '\'' => {
            "write the text between straight quotes: \"text\""
        }
        '#' | '%' | ';' => "comments begin with //",
        _ => return None,
    };
    Some((format!("`{found}` has no meaning here"), help))
}

/// Whether a value is looked for at the end of a text.
fn begins_at_end(error: &RonError, text: &str, at: usize) -> bool {
    use RonError::*;
    let is_of_value = matches!(
        error,
        ExpectedStructLike
            | ExpectedNamedStructLike(_)
            | ExpectedArray
            | ExpectedString
            | ExpectedFloat
            | ExpectedInteger
            | ExpectedBoolean
            | ExpectedIdentifier
    );
    is_of_value && text[at..].trim().is_empty() && !text.trim().is_empty()
}

/// How a field is written that has fields of its own, and of which a number is given: the friction angle, the length of a step.
fn bare_number(text: &str, at: usize, path: &str) -> Option<String> {
    let of_number = |c: &char| c.is_ascii_digit() || ".eE-".contains(*c);
    let number: String = text[at..].chars().take_while(of_number).collect();
    number.parse::<f64>().ok()?;
    match path.rsplit('.').next()? {
        "friction" => Some(format!("write friction: (friction_deg: {number})")),
        "step" => Some(format!("write step_s: {number} for the length of a step")),
        field if field.starts_with("factor[") => {
            Some(format!("write each row as (time_s: {number}, factor: …)"))
        }
        _ => None,
    }
}

/// An example of the value of a field that is missing.
fn example(field: &str) -> &'static str {
    match field {
        "cells" => "(1, 1, 1), the number of cells along x, y and z; more for blocks that deform",
        "title" => "\"A block on a slope\",",
        "name" => "\"block\",",
        "material" => "\"rock\", the name of one of the materials",
        "young_pa" => "Gigapascal(20)",
        "poisson" => "0.25",
        "density_kg_m3" => "2650",
        "end_s" => "1, the time to simulate in seconds",
        _ => "…,",
    }
}

/// Whether a name that is taken for a field is that of a choice with brackets, as the next item of a list is after one that is not closed.
fn is_choice(name: &str, text: &str, at: usize) -> bool {
    let rest = text[at..].strip_prefix(name).map(str::trim_start);
    name.starts_with(char::is_uppercase) && rest.is_some_and(|rest| rest.starts_with('('))
}

/// Byte and text of a number, with its point, that has a comma in the place of it: `0,25` is two values.
fn decimal_comma(error: &RonError, text: &str, at: usize) -> Option<(usize, String)> {
    let wants_name = matches!(
        error,
        RonError::ExpectedIdentifier | RonError::InvalidIdentifier(_) | RonError::SuggestRawIdentifier(_)
    );
    let decimals: String = text[at..].chars().take_while(char::is_ascii_digit).collect();
    let before = text[..at].strip_suffix(',').filter(|_| wants_name && !decimals.is_empty())?;
    let begins = before.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    (begins < before.len()).then(|| (begins, format!("{}.{decimals}", &before[begins..])))
}

/// The parameter that stands where a number should.
fn parameter_at<'a>(error: &RonError, text: &'a str, at: usize, tree: &Node) -> Option<&'a str> {
    let wants_number = matches!(error, RonError::ExpectedFloat | RonError::ExpectedInteger);
    let rest = &text[at..];
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
    let known = tree.children.iter().find(|child| child.key.as_deref() == Some(FIELD))?;
    let is_known = known.children.iter().any(|child| child.key.as_deref() == Some(&rest[..end]));
    (wants_number && is_known).then_some(&rest[..end])
}

/// That the number around a byte is no count: RON stops at its point, its exponent, or its sign.
fn no_count(error: &RonError, plain: &str, at: usize) -> Option<String> {
    let is_inside = match error {
        RonError::ExpectedComma | RonError::ExpectedStructLikeEnd | RonError::ExpectedArrayEnd => true,
        RonError::ExpectedInteger | RonError::IntegerOutOfBounds | RonError::InvalidIntegerDigit { .. } => {
            false
        }
        _ => return None,
    };
    let of_number = |c: &u8| c.is_ascii_digit() || b"._eE+-".contains(c);
    let bytes = plain.as_bytes();
    let begins = at - bytes[..at].iter().rev().take_while(|c| of_number(c)).count();
    let ends = at + bytes[at..].iter().take_while(|c| of_number(c)).count();
    if is_inside && !(begins < at && at < ends) {
        return None;
    }
    let number = plain[begins..ends].replace('_', "");
    let value = number.parse::<f64>().ok().filter(|_| number.contains(|c: char| c.is_ascii_digit()))?;
    let is_short = number.contains(['e', 'E']) && (0.0..=f64::from(u32::MAX)).contains(&value);
    Some(match value.fract() == 0.0 {
        true if is_short => format!("a count has no exponent: write {value} for {number}"),
        true => format!("{value} is not a count that can be used"),
        false => format!("the value {value} is not a whole number"),
    })
}

/// That a unit stands at a byte, behind a number: the number, path and name of its field, and the unit.
fn unit_behind<'a>(
    error: &RonError,
    text: &'a str,
    at: usize,
    tree: &Node,
) -> Option<(&'a str, (String, String), &'a str)> {
    let stops = [RonError::ExpectedComma, RonError::ExpectedStructLikeEnd, RonError::ExpectedArrayEnd];
    let before = text[..at].trim_end();
    let of_number = |c: char| c.is_ascii_digit() || "._eE+-".contains(c);
    let begins = before.trim_end_matches(of_number).len();
    let number = &before[begins..];
    let is_unit = |c: char| !",()[]{}\n\"".contains(c);
    let length = text[at..].find(|c: char| !is_unit(c)).unwrap_or(text.len() - at);
    let mut symbol = text[at..at + length].split("//").next().unwrap_or_default().trim();
    if symbol.contains(':') {
        // A comma is missing, too.
        symbol = symbol.split_whitespace().next().filter(|word| units::may_be_unit(word))?;
    }
    let starts = symbol.starts_with(|c: char| c.is_alphabetic() || c == '°');
    if !stops.contains(error) || !starts || number.parse::<f64>().is_err() {
        return None;
    }
    let path = tree.path_at(begins);
    let named = |part: &&str| part.parse::<usize>().is_err();
    let field = segments(&path).into_iter().rev().find(named).unwrap_or_default().to_string();
    Some((number, (path, field), symbol))
}

/// Diagnosis of the character that stands where a comma should.
fn comma(text: &str, at: usize) -> (Code, &'static str, &'static str) {
    // At the end, RON shows the bracket before it.
    let rest = text[at..].trim_start_matches([')', ']']).trim_start();
    match rest.is_empty() {
        true => (
            Code::Truncated,
            "the file ends before the scene does",
            "a closing bracket is missing, or the file was cut off",
        ),
        false => (
            Code::Syntax,
            "expected a comma",
            "a comma is missing before this, a bracket is one too many, or a text above is not closed",
        ),
    }
}

/// Terms of a scene for the terms of serde.
fn plain_words(text: &str) -> String {
    let words = [
        ("the floating point number", "the number"),
        ("the unsigned integer", "the number"),
        ("the signed integer", "the number"),
        ("the boolean", "the word"),
        ("the string", "the text"),
        ("the UTF-8 character", "the letter"),
        ("a unit value", "empty brackets"),
        ("an optional value", "a value"),
        ("a sequence", "a list"),
        ("a map", "values with names"),
        ("an enum", "a choice"),
        ("an array of length", "a vector of length"),
        ("a tuple of size", "a vector of length"),
        ("a string", "a text in quotes"),
        ("f64", "a number"),
        ("u32", "a whole number"),
        ("u64", "a whole number"),
        ("usize", "a whole number"),
    ];
    let replaced = words.iter().find(|(theirs, _)| text.starts_with(theirs));
    replaced.map_or(text.to_string(), |(theirs, ours)| text.replacen(theirs, ours, 1))
}

/// RON's words for what it expected, in those of a scene.
fn in_words(error: &RonError) -> String {
    let words = match error {
        RonError::ExpectedFloat => "expected a number",
        RonError::ExpectedInteger | RonError::IntegerOutOfBounds => "expected a whole number",
        RonError::ExpectedString => "expected a text in quotes",
        RonError::ExpectedIdentifier => "expected one of the choices by its name",
        RonError::SuggestRawIdentifier(_) => "expected the name of a field or of a choice",
        RonError::ExpectedBoolean => "expected true or false",
        RonError::ExpectedArray => "expected a list, which begins with `[`",
        RonError::ExpectedArrayEnd => "expected a comma, or the `]` that ends the list",
        RonError::ExpectedMap => "expected values with names, which begin with `{`",
        RonError::ExpectedMapEnd => "expected a comma, or the `}` at the end",
        RonError::ExpectedMapColon => "expected a colon after the name of the field",
        RonError::ExpectedStructLike | RonError::ExpectedNamedStructLike(_) => {
            "expected a vector or several fields in round brackets"
        }
        RonError::ExpectedStructLikeEnd | RonError::ExpectedOptionEnd => {
            "one value too many, or a comma or `)` that is missing"
        }
        RonError::ExpectedStructName(_) | RonError::ExpectedDifferentStructName { .. } => {
            "a name before the bracket that does not belong there"
        }
        RonError::ExpectedStringEnd => "a text is not closed",
        RonError::UnclosedBlockComment => "a comment is not closed",
        RonError::UnclosedLineComment => "the last line is a comment without an end of line",
        RonError::TrailingCharacters => "something stands after the end of the scene",
        RonError::ExceededRecursionLimit => "brackets are nested too deeply",
        RonError::FloatUnderscore | RonError::UnderscoreAtBeginning => {
            "an underscore in a number stands between two digits"
        }
        RonError::ExpectedDifferentLength { expected, found } if expected.starts_with(VARIANT) => {
            let (name, count) = expected[VARIANT.len()..].split_once(" with ").unwrap_or_default();
            let name = name.rsplit("::").next().unwrap_or_default();
            let count = count.split(' ').next().unwrap_or_default();
            return format!("`{name}` takes {count} values, and has {found}");
        }
        RonError::ExpectedDifferentLength { expected, found } => {
            let expected = plain_words(expected);
            return format!("expected {expected}, found {found} value{}", if *found == 1 { "" } else { "s" });
        }
        RonError::UnexpectedChar(c) => return format!("`{c}` does not belong here"),
        RonError::InvalidIdentifier(name) => return format!("`{name}` is not a name of a field or a choice"),
        RonError::InvalidIntegerDigit { digit, .. } => {
            return format!("`{digit}` is not a digit of a number");
        }
        other => return lowercase_first(&other.to_string()),
    };
    words.into()
}

/// Kind of a syntax error, what is wrong, and its remedy.
fn grammar(error: &RonError, text: &str, at: usize) -> (Code, String, &'static str) {
    let (kind, help) = match error {
        RonError::ExpectedComma => {
            let (kind, message, help) = comma(text, at);
            return (kind, message.into(), help);
        }
        RonError::ExpectedMapColon => (Code::Syntax, "a field is `name: value`"),
        RonError::ExpectedArrayEnd => (Code::Syntax, "a comma or `]` is missing before this"),
        RonError::ExpectedStructLikeEnd => {
            (Code::WrongType, "a vector has three numbers; docs/reference/scene.md lists the fields")
        }
        RonError::TrailingCharacters => (Code::Syntax, "a bracket before this closes the scene too early"),
        RonError::ExpectedString => (Code::WrongType, "write the text between quotes: \"text\""),
        RonError::ExpectedInteger | RonError::IntegerOutOfBounds => (Code::WrongType, COUNTS),
        RonError::ExpectedFloat => (
            Code::WrongType,
            "write a number, such as 1.5 or 20e9, one with its unit, such as Megapascal(20), or an expression, Calc(2 * width_m)",
        ),
        RonError::ExpectedIdentifier
        | RonError::SuggestRawIdentifier(_)
        | RonError::ExpectedDifferentLength { .. } => (Code::WrongType, REFERENCE),
        RonError::ExpectedArray => (Code::WrongType, "a list is written as [first, second]"),
        RonError::ExpectedStructLike | RonError::ExpectedNamedStructLike(_) => {
            (Code::WrongType, "write a vector as (0, 0, -9.8), and fields as (name: value, name: value)")
        }
        RonError::ExpectedDifferentStructName { .. } => {
            (Code::WrongType, "leave the name before the bracket out")
        }
        RonError::UnclosedBlockComment => (Code::Truncated, "close it with */"),
        RonError::ExpectedStringEnd => (Code::Truncated, "close the text with a quote"),
        _ => (Code::Syntax, REFERENCE),
    };
    (kind, in_words(error), help)
}

fn lowercase_first(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
}

/// The first byte from `at` on that is no blank.
pub(super) fn after_blanks(text: &str, at: usize) -> usize {
    text.len() - text[at..].trim_start().len()
}

/// Byte of a line and column, both from 1 and in characters.
pub(super) fn offset(text: &str, position: &Position) -> usize {
    let line_start =
        text.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum::<usize>();
    let line = &text[line_start.min(text.len())..];
    let inside = line.char_indices().nth(position.col.saturating_sub(1)).map_or(line.len(), |(i, _)| i);
    line_start.min(text.len()) + inside
}
