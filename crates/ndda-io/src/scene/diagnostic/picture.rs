//! Pictures of messages about a scene: the line of the text, and a mark under the place.

use std::fmt;

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};

use crate::scene::diagnostic::{Diagnostic, SceneErrors, Severity};

/// Longest line that is drawn [bytes]: beyond 65535 columns miette panics, and nobody reads them.
const LONGEST: usize = 2000;

/// A message with its line of the text; none without a place, or where lines are too long to be looked at.
pub(crate) fn draw(errors: &SceneErrors, diagnostic: &Diagnostic, colour: bool) -> Option<String> {
    let theme = if colour { GraphicalTheme::unicode() } else { GraphicalTheme::none() };
    let handler = GraphicalReportHandler::new_themed(theme).with_width(110).with_links(false);
    diagnostic.span.as_ref().filter(|_| errors.text.lines().all(|line| line.len() <= LONGEST))?;
    let report = Located { diagnostic, source: NamedSource::new(&errors.file, errors.text.clone()) };
    let mut picture = String::new();
    handler.render_report(&mut picture, &report).ok()?;
    // The message is in the headline already.
    let begins = [",-[", "╭─["].iter().find_map(|corner| picture.find(corner))?;
    let line = picture[..begins].rfind('\n').map_or(0, |end| end + 1);
    Some(picture.split_off(line))
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
