//! Keyword lines `*NAME, PARAMETER=VALUE` and the data lines below them.

use crate::mesh::error::Fault;
use crate::mesh::lines::{Line, Lines, parse};

/// A keyword line.
pub(super) struct Keyword {
    /// Its line, from 1.
    pub line: usize,
    /// Its name in capitals, without the star.
    pub name: String,
    parameters: Vec<(String, String)>,
}

impl Keyword {
    /// The value of a parameter, if it is there.
    pub(crate) fn get(&self, parameter: &str) -> Option<&str> {
        self.parameters.iter().find(|(name, _)| name == parameter).map(|(_, value)| value.as_str())
    }

    /// Whether a parameter is there.
    pub(crate) fn has(&self, parameter: &str) -> bool {
        self.get(parameter).is_some()
    }

    /// The value of a parameter that has to be there.
    pub(crate) fn value(&self, parameter: &str) -> Result<&str, Fault> {
        let value = self.get(parameter).filter(|value| !value.is_empty());
        let expected = || format!("{parameter}=… after *{}", self.name);
        value.ok_or_else(|| Fault::unexpected(self.line, expected(), b"end of line"))
    }
}

/// A data line, with those that continue it.
pub(super) struct Data<'a> {
    /// The first line, from 1.
    pub line: usize,
    /// Its words.
    pub words: Vec<&'a [u8]>,
}

impl Data<'_> {
    /// Word `i` as a number that is not negative.
    pub(crate) fn integer(&self, i: usize, expected: &str) -> Result<u64, Fault> {
        let word = self.words.get(i).copied().unwrap_or(b"end of line");
        parse(word).ok_or_else(|| Fault::unexpected(self.line, expected, word))
    }
}

/// The lines of a file, without comments (`**`) and empty lines.
pub(super) struct Records<'a> {
    lines: Lines<'a>,
    waiting: Option<Line<'a>>,
}

impl<'a> Records<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        // No byte begins a comment inside a line.
        Self { lines: Lines::new(bytes, b'\n'), waiting: None }
    }

    fn line(&mut self) -> Option<Line<'a>> {
        self.waiting.take().or_else(|| self.lines.by_ref().find(|line| !line.text.starts_with(b"**")))
    }

    /// The next keyword line; data lines before it are skipped.
    pub(crate) fn keyword(&mut self) -> Result<Option<Keyword>, Fault> {
        while let Some(line) = self.line() {
            if line.text.starts_with(b"*") {
                return self.parameters(line).map(Some);
            }
        }
        Ok(None)
    }

    fn parameters(&mut self, first: Line<'a>) -> Result<Keyword, Fault> {
        let mut text = String::from_utf8_lossy(&first.text[1..]).into_owned();
        while text.trim_end().ends_with(',') {
            let Some(next) = self.line() else { return Err(Fault::truncated("the rest of a keyword line")) };
            text += &String::from_utf8_lossy(next.text);
        }
        let mut words = text.split(',').map(str::trim);
        let name = words.next().unwrap_or("").to_uppercase();
        let parameter = |word: &str| {
            let (name, value) = word.split_once('=').unwrap_or((word, ""));
            (name.trim().to_uppercase(), unquoted(value.trim().as_bytes()))
        };
        Ok(Keyword { line: first.number, name, parameters: words.map(parameter).collect() })
    }

    /// The next data line of the last keyword; `None` when they are at an end.
    pub(crate) fn data(&mut self) -> Result<Option<Data<'a>>, Fault> {
        let Some(mut line) = self.line() else { return Ok(None) };
        if line.text.starts_with(b"*") {
            self.waiting = Some(line);
            return Ok(None);
        }
        let mut data = Data { line: line.number, words: Vec::new() };
        loop {
            let continues = line.text.ends_with(b",");
            data.words
                .extend(line.text.split(|&b| b == b',').map(<[u8]>::trim_ascii).filter(|w| !w.is_empty()));
            match self.line() {
                Some(next) if continues && !next.text.starts_with(b"*") => line = next,
                next => {
                    self.waiting = next;
                    return Ok(Some(data));
                }
            }
        }
    }
}

/// Without quotes around it.
pub(super) fn unquoted(word: &[u8]) -> String {
    let inner = word.strip_prefix(b"\"").and_then(|rest| rest.strip_suffix(b"\"")).unwrap_or(word);
    String::from_utf8_lossy(inner).into_owned()
}
