//! The directory of a TIFF file and its entries, in either order of bytes.

use crate::mesh::error::{Fault, FileProblem};

use super::not_read;

/// Bytes of an entry, and most numbers of one that are looked at.
const ENTRY: usize = 12;
const MOST_NUMBERS: u64 = 1 << 22;

/// A file whose numbers have their lowest or highest byte first.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub all: &'a [u8],
    pub is_little: bool,
}

impl<'a> Bytes<'a> {
    /// Some bytes from a place on.
    pub(super) fn part(&self, at: u64, length: u64) -> Result<&'a [u8], Fault> {
        let (at, length) = (usize::try_from(at).ok(), usize::try_from(length).ok());
        let part = at.zip(length).and_then(|(at, length)| self.all.get(at..at.checked_add(length)?));
        part.ok_or_else(|| Fault::truncated("data that the directory of the file names"))
    }

    /// A whole number of up to eight bytes without sign.
    pub(super) fn whole(&self, part: &[u8]) -> u64 {
        let add = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        if self.is_little { part.iter().rev().fold(0, add) } else { part.iter().fold(0, add) }
    }
}

/// The first directory of a file.
pub(super) struct Ifd<'a> {
    pub bytes: Bytes<'a>,
    entries: Vec<Entry<'a>>,
}

/// A tag, and its value.
#[derive(Clone, Copy)]
pub(super) struct Entry<'a> {
    bytes: Bytes<'a>,
    tag: u16,
    kind: u16,
    value: &'a [u8],
}

impl<'a> Ifd<'a> {
    pub(super) fn read(all: &'a [u8]) -> Result<Self, Fault> {
        let is_little = match all.get(..2) {
            Some(b"II") => true,
            Some(b"MM") => false,
            _ => {
                return Err(Fault::unexpected(
                    1,
                    "`II` or `MM`, with which a TIFF begins",
                    &all[..all.len().min(4)],
                ));
            }
        };
        let bytes = Bytes { all, is_little };
        match bytes.whole(bytes.part(2, 2)?) {
            42 => {}
            43 => {
                return Err(not_read(
                    "a BigTIFF",
                    "save it as a plain TIFF, as with gdal_translate -co BIGTIFF=NO",
                ));
            }
            found => {
                let (expected, found) = ("42, the mark of a TIFF".into(), found.to_string());
                return Err(FileProblem::Unexpected { expected, found }.into());
            }
        }
        let at = bytes.whole(bytes.part(4, 4)?);
        let count = bytes.whole(bytes.part(at, 2)?);
        let list = bytes.part(at + 2, count * ENTRY as u64)?;
        // Entries of kinds that are not read are left out.
        let entries = list.chunks_exact(ENTRY).map(|entry| Entry::new(bytes, entry));
        Ok(Self { bytes, entries: entries.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect() })
    }

    pub(super) fn get(&self, tag: u16) -> Option<&Entry<'a>> {
        self.entries.iter().find(|entry| entry.tag == tag)
    }

    /// The whole number of a tag that must be there.
    pub(super) fn number(&self, tag: u16) -> Result<u64, Fault> {
        self.number_or(tag, None)
    }

    /// The whole number of a tag, or what it is where the tag is not there.
    pub(super) fn number_or(&self, tag: u16, default: Option<u64>) -> Result<u64, Fault> {
        let numbers = self.get(tag).map(Entry::whole_numbers).transpose()?;
        let first = numbers.and_then(|numbers| numbers.first().copied()).or(default);
        first.ok_or_else(|| Fault::truncated(format!("the tag {tag} of a TIFF")))
    }
}

impl<'a> Entry<'a> {
    fn new(bytes: Bytes<'a>, entry: &'a [u8]) -> Result<Option<Self>, Fault> {
        let [tag, kind] = [0, 2].map(|at| bytes.whole(&entry[at..at + 2]) as u16);
        let size = match kind {
            1 | 2 | 6 | 7 => 1,
            3 | 8 => 2,
            4 | 9 | 11 => 4,
            12 => 8,
            _ => return Ok(None),
        };
        let length = size * bytes.whole(&entry[4..8]);
        let value = match length {
            0..=4 => &entry[8..8 + length as usize],
            _ => bytes.part(bytes.whole(&entry[8..12]), length)?,
        };
        Ok(Some(Self { bytes, tag, kind, value }))
    }

    /// Its whole numbers without sign.
    pub(super) fn whole_numbers(&self) -> Result<Vec<u64>, Fault> {
        let size = match self.kind {
            1 => 1,
            3 => 2,
            4 => 4,
            _ => return Err(self.wrong("whole numbers")),
        };
        if self.value.len() as u64 > size * MOST_NUMBERS {
            return Err(self.wrong("fewer numbers"));
        }
        Ok(self.value.chunks_exact(size as usize).map(|part| self.bytes.whole(part)).collect())
    }

    /// Its numbers of eight bytes.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, Fault> {
        if self.kind != 12 {
            return Err(self.wrong("numbers of eight bytes"));
        }
        let numbers = self.value.chunks_exact(8).take(MOST_NUMBERS as usize);
        Ok(numbers.map(|part| f64::from_bits(self.bytes.whole(part))).collect())
    }

    /// Its text, up to the byte that ends it.
    pub(super) fn text(&self) -> Result<String, Fault> {
        if self.kind != 2 {
            return Err(self.wrong("a text"));
        }
        let end = self.value.iter().position(|b| *b == 0).unwrap_or(self.value.len());
        Ok(String::from_utf8_lossy(&self.value[..end]).into_owned())
    }

    fn wrong(&self, expected: &str) -> Fault {
        let expected = format!("{expected} in the tag {}", self.tag);
        FileProblem::Unexpected { expected, found: format!("type {}", self.kind) }.into()
    }
}
