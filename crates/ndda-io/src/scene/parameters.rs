//! Parameters of a scene: numbers with a name, of which others are computed with `Calc(…)`.

use std::cell::Cell;
use std::ops::Range;

use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, Severity};
use crate::scene::expression::{self, FUNCTIONS};
use crate::scene::locate::Node;

/// Field of a scene that holds its parameters.
pub(crate) const FIELD: &str = "parameters";

/// Parameters of a scene, in the order in which they are written.
#[derive(Debug, Default)]
pub(crate) struct Parameters {
    list: Vec<Parameter>,
    /// Whether something has been computed from a value that is only supposed.
    has_supposed: Cell<bool>,
}

#[derive(Debug)]
struct Parameter {
    name: String,
    value: f64,
    /// Bytes of its name.
    at: Range<usize>,
    used: Cell<bool>,
    /// Whether its value stands for one that is wrong.
    is_supposed: bool,
}

impl Parameters {
    /// Adds a parameter; `at` are the bytes of its name.
    pub(crate) fn add(&mut self, name: String, value: f64, at: Range<usize>) {
        self.list.push(Parameter { name, value, at, used: Cell::new(false), is_supposed: false });
    }

    /// Adds a parameter whose value is wrong, so that what comes after it can be read.
    pub(crate) fn suppose(&mut self, name: String, at: Range<usize>) {
        self.list.push(Parameter { name, value: 1.0, at, used: Cell::new(true), is_supposed: true });
    }

    /// Whether something has been computed from a supposed value since this was last asked.
    pub(crate) fn take_supposed(&self) -> bool {
        self.has_supposed.replace(false)
    }

    /// Why a name cannot be that of another parameter.
    pub(crate) fn refuse_name(&self, name: &str, at: Range<usize>) -> Option<Diagnostic> {
        let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let word = name.chars().all(letters) && !name.starts_with(|c: char| c.is_ascii_digit());
        let (message, help) = if !word {
            ("is not a name of a parameter", "names have letters, digits and _")
        } else if name == "pi" || FUNCTIONS.contains(&name) {
            ("is a name that expressions have already", "choose another, such as one that ends in its unit")
        } else if self.list.iter().any(|parameter| parameter.name == name) {
            ("is there twice", "keep one of them")
        } else {
            return None;
        };
        let path = format!("{FIELD}.{name}");
        Some(Diagnostic::error(Code::BadName, path, format!("`{name}` {message}"), Some(at)).with_help(help))
    }

    /// Value of an expression in the text of a scene: that of the brackets from byte `begins` to the end of `node`.
    pub(crate) fn calculate(
        &self,
        text: &str,
        tree: &Node,
        node: &Node,
        begins: usize,
    ) -> Result<f64, Diagnostic> {
        if !node.is_closed(text) && text[node.span.end..].trim().is_empty() {
            let (path, at) = (tree.path_at(node.span.start), Some(node.span.clone()));
            let cut_off =
                Diagnostic::error(Code::Truncated, path, "the file ends inside this expression", at);
            return Err(cut_off.with_help("a closing bracket is missing, or the file was cut off"));
        }
        let names: Vec<&str> = self.list.iter().map(|parameter| parameter.name.as_str()).collect();
        let source = &text[begins..node.span.end];
        expression::evaluate(source, &names, &|name| self.value_of(name)).map_err(|mistake| {
            let bare = source.trim().trim_start_matches('(').trim();
            let shown =
                source.trim().strip_prefix('(').and_then(|s| s.strip_suffix(')')).unwrap_or(bare).trim();
            let message = match shown.is_empty() || mistake.message.contains(&format!("`{shown}`")) {
                true => mistake.message,
                false => format!("in `{shown}`: {}", mistake.message),
            };
            let at = begins + mistake.at.start..begins + mistake.at.end;
            let path = tree.path_at(node.span.start);
            Diagnostic::error(Code::Expression, path, message, Some(at)).with_help(mistake.help)
        })
    }

    fn value_of(&self, name: &str) -> Option<f64> {
        let parameter = self.list.iter().find(|parameter| parameter.name == name)?;
        parameter.used.set(true);
        self.has_supposed.set(self.has_supposed.get() || parameter.is_supposed);
        Some(parameter.value)
    }

    /// The parameters as a map of RON.
    pub(crate) fn as_map(&self) -> String {
        let entry = |parameter: &Parameter| format!("\"{}\": {}", parameter.name, number(parameter.value));
        format!("{{{}}}", self.list.iter().map(entry).collect::<Vec<_>>().join(", "))
    }

    /// A warning for each parameter that nothing has been computed from.
    pub(crate) fn unused(&self) -> Vec<Diagnostic> {
        let unused = self.list.iter().filter(|parameter| !parameter.used.get());
        let warn = |parameter: &Parameter| {
            let (name, at) = (&parameter.name, Some(parameter.at.clone()));
            let found = Diagnostic::error(
                Code::NoEffect,
                format!("{FIELD}.{name}"),
                "no number of the scene uses this parameter",
                at,
            );
            Diagnostic { severity: Severity::Warning, ..found }
                .with_help(format!("write Calc({name}) in place of a number, or leave it out"))
        };
        unused.map(warn).collect()
    }
}

/// A number as RON reads it, whole ones for counts, too.
pub(crate) fn number(value: f64) -> String {
    // Below 2⁵³ every whole number is one of f64.
    if value.fract() == 0.0 && value.abs() < 9e15 { format!("{value:.0}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_written_as_such_and_others_keep_their_bits() {
        assert_eq!(number(12.0), "12");
        assert_eq!(number(-3.0), "-3");
        for value in [0.1 + 0.2, 1e300, -2.5e-308, 9.1e15, 1.0 / 3.0] {
            assert_eq!(number(value).parse::<f64>(), Ok(value));
        }
    }
}
