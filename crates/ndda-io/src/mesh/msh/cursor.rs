//! Reads numbers from bytes, as text or binary, and remembers where.

use std::str::FromStr;

use super::error::MshProblem;
use crate::mesh::error::{FileProblem, Place, excerpt};

/// A problem and the byte where it is.
#[derive(Debug)]
pub(super) struct Fault {
    /// Byte in the file, if it is one place.
    pub at: Option<usize>,
    /// The problem.
    pub problem: FileProblem,
}

impl From<MshProblem> for Fault {
    fn from(problem: MshProblem) -> Self {
        Self { at: None, problem: problem.into() }
    }
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Decimal, separated by white space.
    Ascii,
    /// As in memory, lowest byte first.
    LittleEndian,
    /// As in memory, highest byte first.
    BigEndian,
}

/// A position in a file.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    next: usize,
    /// Start of the last item.
    start: usize,
    /// How [`int`](Self::int), [`size`](Self::size) and [`real`](Self::real) read.
    pub encoding: Encoding,
}

impl<'a> Cursor<'a> {
    /// At the beginning of `bytes`, after a byte order mark of UTF-8.
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let next = if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
        Self { bytes, next, start: next, encoding: Encoding::Ascii }
    }

    /// The place of byte `at` as the user finds it.
    pub(crate) fn place(&self, at: usize) -> Place {
        match self.encoding {
            Encoding::Ascii => Place::Line(1 + self.bytes[..at].iter().filter(|&&b| b == b'\n').count()),
            _ => Place::Byte(at),
        }
    }

    /// The byte where the last item began.
    pub(crate) fn start(&self) -> usize {
        self.start
    }

    /// `problem` at the item that was read last.
    pub(crate) fn fault(&self, problem: impl Into<FileProblem>) -> Fault {
        Fault { at: Some(self.start), problem: problem.into() }
    }

    fn unexpected(&self, expected: &str, found: &[u8]) -> Fault {
        self.fault(FileProblem::Unexpected { expected: expected.to_string(), found: excerpt(found) })
    }

    fn truncated(&self, expected: &str) -> Fault {
        Fault { at: Some(self.bytes.len()), problem: FileProblem::Truncated(expected.to_string()) }
    }

    /// Whether only white space is left.
    pub(crate) fn is_at_end(&self) -> bool {
        self.bytes[self.next..].iter().all(u8::is_ascii_whitespace)
    }

    /// The next word of text.
    pub(crate) fn word(&mut self, expected: &str) -> Result<&'a [u8], Fault> {
        let rest = &self.bytes[self.next..];
        let skip = rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
        let length = rest[skip..].iter().take_while(|b| !b.is_ascii_whitespace()).count();
        if length == 0 {
            return Err(self.truncated(expected));
        }
        self.start = self.next + skip;
        self.next = self.start + length;
        Ok(&rest[skip..skip + length])
    }

    /// The next word, which must be `word`.
    pub(crate) fn keyword(&mut self, word: &str) -> Result<(), Fault> {
        let found = self.word(&format!("`{word}`"))?;
        if found == word.as_bytes() { Ok(()) } else { Err(self.unexpected(&format!("`{word}`"), found)) }
    }

    /// The next word as a number, whatever the encoding.
    pub(crate) fn text<T: FromStr>(&mut self, expected: &str) -> Result<T, Fault> {
        let word = self.word(expected)?;
        let number = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
        number.ok_or_else(|| self.unexpected(expected, word))
    }

    /// The rest of the line, without its end; the cursor goes to the next line.
    pub(crate) fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.next..];
        let length = rest.iter().take_while(|&&b| b != b'\n').count();
        self.start = self.next;
        self.next += (length + 1).min(rest.len());
        rest[..length].trim_ascii()
    }

    fn raw<const N: usize>(&mut self, expected: &str) -> Result<[u8; N], Fault> {
        let Some(&raw) = self.bytes[self.next..].first_chunk::<N>() else {
            return Err(self.truncated(expected));
        };
        self.start = self.next;
        self.next += N;
        Ok(raw)
    }

    /// Four bytes as they are, lowest first.
    pub(crate) fn raw_u32(&mut self, expected: &str) -> Result<u32, Fault> {
        Ok(u32::from_le_bytes(self.raw(expected)?))
    }

    /// The format's `int`.
    pub(crate) fn int(&mut self, expected: &str) -> Result<i32, Fault> {
        match self.encoding {
            Encoding::Ascii => self.text(expected),
            Encoding::LittleEndian => Ok(i32::from_le_bytes(self.raw(expected)?)),
            Encoding::BigEndian => Ok(i32::from_be_bytes(self.raw(expected)?)),
        }
    }

    /// The format's `size_t`.
    pub(crate) fn size(&mut self, expected: &str) -> Result<u64, Fault> {
        match self.encoding {
            Encoding::Ascii => self.text(expected),
            Encoding::LittleEndian => Ok(u64::from_le_bytes(self.raw(expected)?)),
            Encoding::BigEndian => Ok(u64::from_be_bytes(self.raw(expected)?)),
        }
    }

    /// The format's `double`.
    pub(crate) fn real(&mut self, expected: &str) -> Result<f64, Fault> {
        match self.encoding {
            Encoding::Ascii => self.text(expected),
            Encoding::LittleEndian => Ok(f64::from_le_bytes(self.raw(expected)?)),
            Encoding::BigEndian => Ok(f64::from_be_bytes(self.raw(expected)?)),
        }
    }

    /// Whether numbers are binary.
    pub(crate) fn is_binary(&self) -> bool {
        self.encoding != Encoding::Ascii
    }

    /// `count` if that many items of at least `text` bytes (ASCII) or `binary` bytes fit into the rest.
    pub(crate) fn fitting(
        &self,
        what: &'static str,
        count: u64,
        text: usize,
        binary: usize,
    ) -> Result<usize, Fault> {
        let bytes = self.bytes.len() - self.next;
        let least = if self.is_binary() { binary } else { text };
        match usize::try_from(count) {
            Ok(fits) if fits.checked_mul(least).is_some_and(|needed| needed <= bytes) => Ok(fits),
            _ => Err(self.fault(MshProblem::TooShort { what, count, bytes })),
        }
    }

    /// Goes behind the next occurrence of `word` at the start of a line.
    pub(crate) fn skip_past(&mut self, word: &str) -> Result<(), Fault> {
        let line = format!("\n{word}");
        let from = self.next.saturating_sub(1);
        match self.bytes[from..].windows(line.len()).position(|window| window == line.as_bytes()) {
            Some(offset) => {
                self.next = from + offset + line.len();
                Ok(())
            }
            None => Err(self.truncated(&format!("`{word}`"))),
        }
    }
}
