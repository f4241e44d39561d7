//! Choices, which are written as a name with or without brackets.

use std::ops::Range;

use ron::error::{Error as RonError, SpannedError};
use serde::de::DeserializeOwned;

use crate::scene::locate::Node;
use crate::scene::suggest::suggest;

/// The choice of a number without scatter.
const ALWAYS: &str = "Always";
/// A name that no choice has, by which a type is asked for those that it has.
const NO_CHOICE: &str = "NoChoice";

/// The choices where a mistake is that none is named, or that a field is missing, in a sentence; none if the field has no choices.
pub(super) fn advice<T: DeserializeOwned>(
    (options, text): (&ron::Options, &str),
    error: &RonError,
    shape: &Node,
    at: usize,
) -> Option<String> {
    match error {
        RonError::ExpectedIdentifier => {
            let value = shape.beginning_at(at)?.span.clone();
            choices_at::<T>(options, text, value, NO_CHOICE).map(|choices| suggest("", choices))
        }
        RonError::SuggestRawIdentifier(number) if number.parse::<f64>().is_ok() => {
            let value = shape.leaf_around(at)?.span.clone();
            let number = text[value.clone()].trim();
            let choices = choices_at::<T>(options, text, value.clone(), NO_CHOICE)?;
            let always = choices
                .contains(&ALWAYS)
                .then(|| format!("write {ALWAYS}({number}), or another of {}", choices.join(", ")));
            Some(always.unwrap_or_else(|| suggest("", choices)))
        }
        RonError::MissingStructField { field, .. } => {
            let end = shape.closed_at(at)?.span.end - 1;
            let comma = if text[..end].trim_end().ends_with([',', '(']) { "" } else { "," };
            let entry = format!("{comma} {field}: {NO_CHOICE}");
            let choices = choices_at::<T>(options, text, end..end, &entry)?;
            Some(format!("write {field}: and one of {} (see docs/reference/scene.md)", choices.join(", ")))
        }
        _ => None,
    }
}

/// The choices of what is read where other words stand at a place.
fn choices_at<T: DeserializeOwned>(
    options: &ron::Options,
    text: &str,
    place: Range<usize>,
    words: &str,
) -> Option<&'static [&'static str]> {
    let asked = format!("{}{words}{}", &text[..place.start], &text[place.end..]);
    match options.from_str::<T>(&asked) {
        Err(SpannedError { code: RonError::NoSuchEnumVariant { expected, found, .. }, .. }) => {
            (found == NO_CHOICE).then_some(expected)
        }
        _ => None,
    }
}

/// That a choice lacks its brackets, has some where it has no fields, or has values without names; with the remedy.
pub(super) fn brackets_of_choice(error: &RonError, text: &str, at: usize) -> Option<(String, String)> {
    let before = text[..at].trim_end();
    let inside = before.strip_suffix('(').map(str::trim_end);
    let opens = text[at..].starts_with('(');
    let choice = |text: &str| {
        let word = text.rsplit(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default();
        Some(word.to_string()).filter(|word| word.starts_with(|c: char| c.is_uppercase()))
    };
    match error {
        RonError::ExpectedStructLike | RonError::ExpectedNamedStructLike(_) if !opens => {
            let name = choice(before)?;
            Some((
                format!("`{name}` is written with brackets"),
                format!("write {name}(), or {name}(field: value); docs/reference/scene.md lists its fields"),
            ))
        }
        RonError::ExpectedComma if opens => {
            let name = choice(before)?;
            Some((format!("`{name}` has no fields"), format!("write {name} without brackets")))
        }
        RonError::ExpectedFloat | RonError::ExpectedInteger => {
            let (name, word) = (choice(inside?)?, words_from(text, at)?);
            let value = word.1.unwrap_or("value");
            Some((
                format!("the value of `{name}` is written without a name"),
                format!("write {name}({value}) in place of {name}({}: {value})", word.0),
            ))
        }
        RonError::ExpectedIdentifier | RonError::InvalidIdentifier(_) | RonError::SuggestRawIdentifier(_) => {
            let name = choice(inside?)?;
            Some((
                format!("the fields of `{name}` are written with their names"),
                format!("write {name}(field: value); docs/reference/scene.md lists its fields"),
            ))
        }
        _ => None,
    }
}

/// The name of a field that begins at a byte, and its number.
fn words_from(text: &str, at: usize) -> Option<(&str, Option<&str>)> {
    let rest = &text[at..];
    let (name, value) = rest.split_once(':')?;
    let is_name = !name.is_empty() && name.trim_end().chars().all(|c| c.is_alphanumeric() || c == '_');
    let value = value.trim_start();
    let number =
        &value[..value.find(|c: char| !(c.is_ascii_digit() || ".eE+-_".contains(c))).unwrap_or(value.len())];
    is_name.then(|| (name.trim_end(), Some(number).filter(|number| !number.is_empty())))
}

#[cfg(test)]
mod tests {
    use crate::scene::code::Code;
    use crate::scene::locate::Node;
    use crate::scene::parameters::Parameters;
    use crate::scene::parse::parse_with;
    use crate::scene::rockfall::Scatter;
    use crate::scene::stage::Stage;
    use crate::scene::support::Hold;

    fn told<T: serde::de::DeserializeOwned>(text: &str) -> Vec<(Code, String)> {
        let found = parse_with::<T>(text, &Node::of(text), &Parameters::default());
        let found = found.err().map(|mistakes| mistakes.found).unwrap_or_default();
        found.into_iter().map(|told| (told.code, told.help.unwrap_or_default())).collect()
    }

    #[test]
    fn a_field_that_is_missing_is_told_with_its_choices() {
        for text in ["(name: \"a\")", "(name: \"a\", )"] {
            let [(Code::MissingField, help)] = &told::<Stage>(text)[..] else { panic!("{text}") };
            assert!(help.starts_with("write then: and one of Settle, Run "), "{help}");
        }
    }

    #[test]
    fn a_number_where_a_choice_stands_is_told_with_the_one_that_takes_it() {
        let [(Code::WrongType, help)] = &told::<Vec<Scatter>>("[34.5]")[..] else { panic!("one mistake") };
        assert!(help.starts_with("write Always(34.5), or another of Always, "), "{help}");
    }

    #[test]
    fn a_character_that_looks_like_another_is_told_with_that_one() {
        for (text, words) in [
            ("[Always(\u{2212}3)]", "write the minus of the keyboard: -"),
            ("[# none\n]", "comments begin with //"),
        ] {
            let found = told::<Vec<Scatter>>(text);
            assert_eq!(found, [(Code::Syntax, words.to_string())], "{text}");
        }
    }

    #[test]
    fn a_value_without_the_name_of_a_choice_is_told_with_the_choices() {
        let [(Code::WrongType, help)] = &told::<Vec<Hold>>("[(1, 0, 0)]")[..] else { panic!("one mistake") };
        assert!(help.starts_with("choose one of Fixed, "), "{help}");
    }

    #[test]
    fn a_number_with_a_name_that_it_should_not_have_is_told_once() {
        let [(Code::WrongType, help)] = &told::<Stage>("(name: \"a\", then: Run(until_s: 1.6))")[..] else {
            panic!("one mistake")
        };
        assert_eq!(help, "write Run(1.6) in place of Run(until_s: 1.6)");
    }
}
