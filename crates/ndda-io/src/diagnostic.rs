//! Messages about a scene, each with its place in the text.

use std::fmt;
use std::ops::Range;

use crate::code::Code;
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};

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
    /// What kind of thing it is.
    pub code: Code,
    /// Path of the value, as in `blocks[1].shape.size_m`; empty when it is about the whole file.
    pub path: String,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Bytes of the text that it is about.
    pub span: Option<Range<usize>>,
}

impl Diagnostic {
    /// An error at a place of the text.
    pub fn error(
        code: Code,
        path: impl Into<String>,
        message: impl Into<String>,
        span: Option<Range<usize>>,
    ) -> Self {
        let (path, message) = (path.into(), message.into());
        Self { severity: Severity::Error, code, path, message, help: None, span }
    }

    /// The same message with advice.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
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
    /// All messages as text: `file:line:column`, the source line, a caret and advice.
    pub fn render(&self, colour: bool) -> String {
        let theme = if colour { GraphicalTheme::unicode() } else { GraphicalTheme::none() };
        let handler = GraphicalReportHandler::new_themed(theme).with_width(110).with_links(false);
        let mut out = String::new();
        for diagnostic in &self.diagnostics {
            out.push_str(&self.headline(diagnostic));
            let report = Located { diagnostic, source: NamedSource::new(&self.file, self.text.clone()) };
            let mut picture = String::new();
            // Without a place there is nothing to draw.
            if diagnostic.span.is_some() && handler.render_report(&mut picture, &report).is_ok() {
                out.push_str(&picture);
            } else if let Some(help) = &diagnostic.help {
                out.push_str(&format!("  help: {help}\n"));
            }
        }
        out
    }

    /// `file:line:column: error[code]: path: message`.
    fn headline(&self, diagnostic: &Diagnostic) -> String {
        let word = match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let place = diagnostic.span.as_ref().map_or(String::new(), |span| {
            let (line, column) = line_column(&self.text, span.start);
            format!(":{line}:{column}")
        });
        let path = if diagnostic.path.is_empty() { String::new() } else { format!("{}: ", diagnostic.path) };
        format!("{}{place}: {word}[{}]: {path}{}\n", self.file, diagnostic.code, diagnostic.message)
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneErrors {}

/// Line and column of a byte, both from 1, the column in characters.
pub fn line_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.char_indices().take_while(|(i, _)| *i < offset).map(|(_, c)| c);
    before.fold((1, 1), |(line, column), c| if c == '\n' { (line + 1, 1) } else { (line, column + 1) })
}

/// A diagnostic with the text it is about, as miette wants it.
#[derive(Debug)]
struct Located<'a> {
    diagnostic: &'a Diagnostic,
    source: NamedSource<String>,
}

impl fmt::Display for Located<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl std::error::Error for Located<'_> {}

impl miette::Diagnostic for Located<'_> {
    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'b>(&'b self) -> Option<Box<dyn fmt::Display + 'b>> {
        self.diagnostic.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.diagnostic.span.clone()?;
        // A struct of many lines is marked by its first one.
        let text = self.source.inner();
        let line_end = text[span.start..].find('\n').map_or(text.len(), |i| span.start + i);
        let length = span.end.min(line_end).saturating_sub(span.start);
        Some(Box::new(std::iter::once(LabeledSpan::new(Some("here".into()), span.start, length))))
    }
}
