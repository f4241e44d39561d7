//! Text line by line, and the words of a line.

use std::str::FromStr;

use ndda_mesh::Vec3;

use super::error::Fault;

/// Lines of a text that are not empty, with their numbers; a comment ends a line.
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    next: usize,
    comment: u8,
}

impl<'a> Lines<'a> {
    /// Of `bytes`, with comments from the byte `comment` on; a byte order mark of UTF-8 is skipped.
    pub(crate) fn new(bytes: &'a [u8], comment: u8) -> Self {
        Self { rest: bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), next: 1, comment }
    }

    /// Bytes that are left.
    pub(crate) fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    /// The next line with its comment but without white space around it, even if it is empty.
    pub(crate) fn raw(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
        let text = self.rest[..end].trim_ascii();
        self.rest = &self.rest[(end + 1).min(self.rest.len())..];
        let number = self.next;
        self.next += 1;
        Some(Line { number, text })
    }

    /// The next line or an error that it is not there.
    pub(crate) fn expect(&mut self, what: &str) -> Result<Line<'a>, Fault> {
        self.next().ok_or_else(|| Fault::truncated(what))
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        loop {
            let mut line = self.raw()?;
            if let Some(end) = line.text.iter().position(|&b| b == self.comment) {
                line.text = line.text[..end].trim_ascii();
            }
            if !line.text.is_empty() {
                return Some(line);
            }
        }
    }
}

/// The rest of a line.
#[derive(Clone, Copy)]
pub(crate) struct Line<'a> {
    /// From 1.
    pub number: usize,
    /// Its text.
    pub text: &'a [u8],
}

impl<'a> Line<'a> {
    /// The next word; commas separate words, too.
    pub(crate) fn word(&mut self) -> Option<&'a [u8]> {
        let separates = |b: &u8| b.is_ascii_whitespace() || *b == b',';
        let skip = self.text.iter().take_while(|b| separates(b)).count();
        let length = self.text[skip..].iter().take_while(|b| !separates(b)).count();
        let word = &self.text[skip..skip + length];
        self.text = &self.text[skip + length..];
        (length > 0).then_some(word)
    }

    /// The next word as a number.
    pub(crate) fn number<T: FromStr>(&mut self, expected: &str) -> Result<T, Fault> {
        let word = self.word().ok_or_else(|| Fault::unexpected(self.number, expected, b"end of line"))?;
        parse(word).ok_or_else(|| Fault::unexpected(self.number, expected, word))
    }

    /// The next word as a finite number.
    pub(crate) fn finite(&mut self, expected: &str) -> Result<f64, Fault> {
        let word = self.word().ok_or_else(|| Fault::unexpected(self.number, expected, b"end of line"))?;
        real(word).ok_or_else(|| Fault::unexpected(self.number, format!("{expected}, finite"), word))
    }

    /// Three finite coordinates.
    pub(crate) fn point(&mut self) -> Result<Vec3, Fault> {
        let mut next = || self.finite("a coordinate");
        Ok(Vec3::new(next()?, next()?, next()?))
    }
}

/// A word as a number.
pub(crate) fn parse<T: FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A word as a finite number; Fortran's exponent D is read, too.
pub(crate) fn real(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    let value = text.parse().or_else(|_| text.replace(['d', 'D'], "e").parse::<f64>()).ok()?;
    value.is_finite().then_some(value)
}
