//! Text to types, going on after mistakes as far as what comes after them can be read.

use std::ops::Range;

use ron::error::{Error as RonError, SpannedError};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

use super::{choices, sort, words};
use crate::scene::code::Code;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::locate::Node;
use crate::scene::units::Resolved;

/// Mistakes of fields and types that are told at once.
const MOST_MISTAKES: usize = 20;
/// Stands for a number that is none.
const STAND_IN: &str = "1";

/// What is wrong with a text, and what the rest of it says.
pub(crate) struct Mistakes<T> {
    pub(crate) found: Vec<Diagnostic>,
    /// The value without what is wrong; none where places in lists would be others.
    pub(crate) rest: Option<T>,
    /// Bytes of the text that the value does not have as they are meant.
    pub(crate) doubtful: Vec<Range<usize>>,
    /// Whether nothing but numbers is missing from the value.
    pub(crate) has_all_names: bool,
}

impl<T> Mistakes<T> {
    /// No mistakes in a value.
    pub(crate) fn none_in(value: T) -> Self {
        Self { found: Vec::new(), rest: Some(value), doubtful: Vec::new(), has_all_names: true }
    }
}

/// Reads a value from a text, and takes mistakes out of it so that the next ones can be found.
pub(super) struct Reader<'a> {
    plain: Resolved,
    text: &'a str,
    tree: &'a Node,
    options: ron::Options,
    found: Vec<Diagnostic>,
    /// Bytes of the plain text that were taken out.
    taken_out: Vec<Range<usize>>,
    /// Bytes of the source in whose place stands something else.
    doubtful: Vec<Range<usize>>,
    has_all_items: bool,
    has_all_names: bool,
}

impl<'a> Reader<'a> {
    pub(super) fn new(plain: Resolved, text: &'a str, tree: &'a Node) -> Self {
        Self {
            doubtful: plain.supposed.clone(),
            plain,
            text,
            tree,
            options: ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME),
            found: Vec::new(),
            taken_out: Vec::new(),
            has_all_items: true,
            has_all_names: true,
        }
    }

    /// The value, or else its mistakes.
    pub(super) fn read<T: DeserializeOwned>(mut self) -> Result<T, Mistakes<T>> {
        let mut rest = None;
        // Mistakes that follow from others are not told, and come to an end, too.
        for _ in 0..3 * MOST_MISTAKES {
            match self.options.from_str(&self.plain.text) {
                Ok(value) => {
                    if self.plain.errors.is_empty() && self.found.is_empty() && self.doubtful.is_empty() {
                        return Ok(value);
                    }
                    rest = Some(value);
                    break;
                }
                Err(error) if self.found.len() < MOST_MISTAKES && self.goes_on_after::<T>(&error) => {}
                Err(_) => break,
            }
        }
        // In a field that does not exist, no unit is right.
        let unknown = self.found.iter().filter(|earlier| earlier.code == Code::UnknownField);
        let unknown = unknown.filter_map(|earlier| self.tree.entry_around(earlier.span.as_ref()?.start));
        let unknown: Vec<Range<usize>> = unknown.collect();
        let stands = |mistake: &&Diagnostic| {
            let at = mistake.span.as_ref().map(|span| span.start);
            !unknown.iter().any(|field| at.is_some_and(|at| field.contains(&at)))
        };
        self.found.extend(self.plain.errors.iter().filter(stands).cloned());
        sort(&mut self.found);
        let Self { found, doubtful, has_all_names, has_all_items, .. } = self;
        Err(Mistakes { found, rest: rest.filter(|_| has_all_items), doubtful, has_all_names })
    }

    /// Tells a mistake, and puts something in its place; false where nothing after it can be read.
    fn goes_on_after<T: DeserializeOwned>(&mut self, error: &SpannedError) -> bool {
        let shape = Node::of(&self.plain.text);
        let plain = &self.plain.text;
        let at = words::after_blanks(plain, words::offset(plain, &error.span.start));
        // RON points at the closing bracket of a struct that lacks a field.
        let is_missing = matches!(error.code, RonError::MissingStructField { .. });
        let whole = is_missing.then(|| shape.closed_at(at)).flatten();
        let whole = whole.map_or(at..at, |node| node.span.clone());
        let source = self.plain.source(whole.start);
        // A field may be missing only because it was taken out with a mistake of its own, and a stand-in may be of another type.
        let follows = self.taken_out.iter().any(|earlier| whole.contains(&earlier.start))
            || !is_missing && self.doubtful.iter().any(|part| part.contains(&source));
        let mut told = words::explain(error, &self.plain, self.text, self.tree);
        if let Some(choices) = choices::advice::<T>((&self.options, plain), &error.code, &shape, at)
            && (is_missing || told.help.as_deref() == Some(words::REFERENCE))
        {
            told = told.with_help(choices);
        }
        // A file that ends inside an expression ends before the scene does, too.
        let is_cut_off = told.code == Code::Truncated;
        let follows = follows || is_cut_off && self.plain.errors.iter().any(|e| e.code == Code::Truncated);
        let is_comma = told.code == Code::Syntax && stops_for_comma(&error.code);
        let is_misplaced = told.code == Code::Syntax;
        if !follows {
            self.found.push(told);
        }
        if is_comma {
            return self.puts_comma::<T>(at);
        }
        // What stands after a bracket that is not closed is in another place than it seems.
        if is_misplaced {
            return false;
        }
        if let Some(number) = number_at(&error.code, &shape, plain, at) {
            self.suppose(number);
            return true;
        }
        // A number that has a name where it should have none goes with the choice that it is of.
        let is_named = matches!(error.code, RonError::ExpectedFloat | RonError::ExpectedInteger)
            && shape.has_key_at(whole.start);
        let outer = shape.innermost(whole.start).filter(|_| is_named).map(|node| node.span.start);
        let entry = shape.entry_around(outer.unwrap_or(whole.start)).filter(|_| is_of_types(&error.code));
        let Some(entry) = entry else { return false };
        self.has_all_items &= shape.has_key_at(entry.start);
        self.has_all_names &= is_number(&self.plain.text[entry.clone()]);
        self.doubtful.push(self.plain.source(entry.start)..self.plain.source(entry.end));
        take_out(&mut self.plain.text, entry.clone());
        self.taken_out.push(entry);
        true
    }

    /// Puts 1 in the place of a number that is none.
    fn suppose(&mut self, number: Range<usize>) {
        self.doubtful.push(self.plain.source(number.start)..self.plain.source(number.end));
        let blanks = " ".repeat(number.len() - STAND_IN.len());
        self.plain.text.replace_range(number, &format!("{STAND_IN}{blanks}"));
    }

    /// Puts a comma in the place of the blank before a byte, if the text is better with it.
    fn puts_comma<T: DeserializeOwned>(&mut self, at: usize) -> bool {
        let plain = &self.plain.text;
        let begins_entry = |c: char| c.is_alphanumeric() || "\"(['-.".contains(c);
        let is_between =
            plain[at..].starts_with(begins_entry) && plain[..at].ends_with(|c: char| c.is_ascii_whitespace());
        if !is_between {
            return false;
        }
        let mut with = plain.clone();
        // A comment may be before the blank, so that the comma comes after what is before both.
        with.replace_range(at - 1..at, ",");
        let is_better = match self.options.from_str::<T>(&with) {
            Ok(_) => true,
            Err(next) => {
                let later = words::after_blanks(&with, words::offset(&with, &next.span.start)) > at;
                later && (is_of_types(&next.code) || stops_for_comma(&next.code))
            }
        };
        if is_better {
            self.plain.text = with;
        }
        is_better
    }
}

/// Whether RON found something else where a comma might stand.
fn stops_for_comma(error: &RonError) -> bool {
    matches!(error, RonError::ExpectedComma | RonError::ExpectedArrayEnd)
}

/// Bytes of the number that is of another type, with a sign or a point that it should not have.
fn number_at(error: &RonError, shape: &Node, plain: &str, at: usize) -> Option<Range<usize>> {
    let may_be = matches!(
        error,
        RonError::ExpectedFloat
            | RonError::ExpectedInteger
            | RonError::IntegerOutOfBounds
            | RonError::InvalidIntegerDigit { .. }
            | RonError::ExpectedComma
            | RonError::ExpectedStructLikeEnd
            | RonError::ExpectedArrayEnd
    );
    let leaf = shape.leaf_around(at).filter(|_| may_be)?.span.clone();
    let word = &plain[leaf.clone()];
    // A word where a number should be is taken out with its field, so that no name is lost unseen.
    (word.trim() != STAND_IN && word.parse::<f64>().is_ok()).then_some(leaf)
}

/// Whether an entry is a number, one that is computed, or a field with such a value.
fn is_number(entry: &str) -> bool {
    let value = entry.rsplit_once(':').map_or(entry, |(_, value)| value).trim();
    value.parse::<f64>().is_ok()
}

/// Whether a mistake is one of a field or a value, after which the rest of the text can still be read.
fn is_of_types(error: &RonError) -> bool {
    matches!(
        error,
        RonError::NoSuchStructField { .. }
            | RonError::MissingStructField { .. }
            | RonError::NoSuchEnumVariant { .. }
            | RonError::InvalidValueForType { .. }
            | RonError::ExpectedFloat
            | RonError::ExpectedInteger
            | RonError::IntegerOutOfBounds
            | RonError::ExpectedString
            | RonError::ExpectedBoolean
            | RonError::SuggestRawIdentifier(_)
    )
}

/// Puts blanks in the place of an entry and its comma, so that all others stay where they are.
fn take_out(plain: &mut String, entry: Range<usize>) {
    let comma = words::after_blanks(plain, entry.end);
    let end = if plain[comma..].starts_with(',') { comma + 1 } else { entry.end };
    let blank = |c: char| if c == '\n' { "\n".into() } else { " ".repeat(c.len_utf8()) };
    let blanks: String = plain[entry.start..end].chars().map(blank).collect();
    plain.replace_range(entry.start..end, &blanks);
}
