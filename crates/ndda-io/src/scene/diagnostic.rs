//! Messages about a scene, each with its place in the text.

#[cfg(feature = "fancy")]
mod picture;

use std::fmt;
use std::ops::Range;

use crate::scene::code::Code;

/// How much a message matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene cannot be used.
    Error,
    /// The scene can be used, but may not mean what was meant.
    Warning,
}

/// One message about a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How much it matters.
    pub severity: Severity,
    /// The kind of the problem.
    pub code: Code,
    /// Path of the value, as in `blocks[1].shape.size_m`; empty when it is about the whole file.
    pub path: String,
    /// The problem.
    pub message: String,
    /// The remedy.
    pub help: Option<String>,
    /// Bytes of the text that it is about.
    pub span: Option<Range<usize>>,
}

impl Diagnostic {
    /// An error at a place of the text.
    pub(crate) fn error(
        code: Code,
        path: impl Into<String>,
        message: impl Into<String>,
        span: Option<Range<usize>>,
    ) -> Self {
        let (path, message) = (path.into(), message.into());
        Self { severity: Severity::Error, code, path, message, help: None, span }
    }

    /// Adds advice to the message.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Line and column in its text, both from 1, the column in characters; none without a place.
    pub fn line_column(&self, text: &str) -> Option<(usize, usize)> {
        self.span.as_ref().map(|span| line_column(text, span.start))
    }
}

/// Messages about one scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneErrors {
    /// The file, as it was named.
    pub file: String,
    /// Its text, after overrides; empty when it could not be read.
    pub text: String,
    /// The messages, in the order of the text where they have a place.
    pub diagnostics: Vec<Diagnostic>,
}

impl SceneErrors {
    /// All messages as text: `file:line:column`, advice, and with the feature `fancy` the source line and a mark. Of several messages in the
    /// same words, the first is explained, and of the others only the places are said.
    pub fn render(&self, colour: bool) -> String {
        let mut out = String::new();
        let alike = |a: &Diagnostic, b: &Diagnostic| {
            (a.severity, a.code, &a.message, &a.help) == (b.severity, b.code, &b.message, &b.help)
        };
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            if self.diagnostics[..i].contains(diagnostic) {
                continue;
            }
            if self.diagnostics[..i].iter().any(|earlier| alike(earlier, diagnostic)) {
                out.push_str(&format!("{}: as above\n", self.place(diagnostic)));
                continue;
            }
            out.push_str(&self.headline(diagnostic));
            match self.picture(diagnostic, colour) {
                Some(picture) => out.push_str(&picture),
                None => out.extend(diagnostic.help.iter().map(|help| format!("  help: {help}\n"))),
            }
        }
        out
    }

    /// The line of the text that a message is about; none without a place, or in a build that draws none.
    #[cfg(feature = "fancy")]
    fn picture(&self, diagnostic: &Diagnostic, colour: bool) -> Option<String> {
        picture::draw(self, diagnostic, colour)
    }

    #[cfg(not(feature = "fancy"))]
    fn picture(&self, _diagnostic: &Diagnostic, _colour: bool) -> Option<String> {
        None
    }

    /// `file:line:column: error[code]: path: message`.
    fn headline(&self, diagnostic: &Diagnostic) -> String {
        format!("{}: {}\n", self.place(diagnostic), diagnostic.message)
    }

    /// `file:line:column: error[code]: path`.
    fn place(&self, diagnostic: &Diagnostic) -> String {
        let word = match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let place = diagnostic.line_column(&self.text);
        let place = place.map_or(String::new(), |(line, column)| format!(":{line}:{column}"));
        let path = if diagnostic.path.is_empty() { String::new() } else { format!(": {}", diagnostic.path) };
        format!("{}{place}: {word}[{}]{path}", self.file, diagnostic.code)
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneErrors {}

/// Line and column of a byte, both from 1, the column in characters.
pub(crate) fn line_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.char_indices().take_while(|(i, _)| *i < offset).map(|(_, c)| c);
    before.fold((1, 1), |(line, column), c| if c == '\n' { (line + 1, 1) } else { (line, column + 1) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_errors_are_explained_once() {
        let error = |path: &str, at: usize| {
            Diagnostic::error(Code::OutOfRange, path, "-1 m: must be positive", Some(at..at + 2))
                .with_help("give a value above 0 m")
        };
        let diagnostics = vec![error("a", 4), error("b", 11), error("b", 11)];
        let errors = SceneErrors { file: "s.ron".into(), text: "(a: -1,\nb: -1)".into(), diagnostics };
        let text = errors.render(false);
        for (sentence, times) in
            [("must be positive", 1), ("give a value above", 1), (": as above", 1), ("s.ron:2:4", 1)]
        {
            assert_eq!(text.matches(sentence).count(), times, "{sentence}: {text}");
        }
    }
}
