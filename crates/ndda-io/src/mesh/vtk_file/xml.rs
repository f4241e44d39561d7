//! The XML formats, `.vtu` and `.vtp`: elements and the arrays in them.

use std::collections::HashMap;

use miniz_oxide::inflate::{DecompressError, TINFLStatus, decompress_to_vec_zlib_with_limit};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::base64::Decoder;
use super::binary::Kind;
use super::data::Data;
use super::sections::Piece;
use crate::mesh::FileProblem;
use crate::mesh::error::{Fault, excerpt};
use crate::mesh::lines::parse;

/// Encoding of all arrays as the root element declares it, and the appended data.
struct Encoding<'a> {
    is_big: bool,
    header: Kind,
    is_compressed: bool,
    appended: Option<(bool, &'a [u8])>,
}

type Attributes = HashMap<String, String>;

/// Reads unstructured grids and polygonal data.
pub(super) fn read(bytes: &[u8]) -> Result<Data, Fault> {
    let (xml, appended) = split_appended(bytes);
    let mut encoding = Encoding { is_big: false, header: Kind::U32, is_compressed: false, appended };
    let mut reader = Reader::from_reader(xml);
    let (mut data, mut piece, mut section) = (Data::default(), Piece::default(), String::new());
    let mut is_vtk = false;
    loop {
        let position = reader.buffer_position() as usize;
        let line = 1 + xml[..position.min(xml.len())].iter().filter(|&&b| b == b'\n').count();
        let event = reader.read_event();
        let event = event.map_err(|e| Fault::unexpected(line, "XML", e.to_string().as_bytes()))?;
        let is_empty = matches!(event, Event::Empty(_));
        match event {
            Event::Eof => break,
            Event::Start(start) | Event::Empty(start) => {
                let attributes = attributes(&start);
                match start.local_name().as_ref() {
                    b"VTKFile" => {
                        is_vtk = true;
                        encoding.root(&attributes).map_err(|p| Fault::at(line, p))?;
                    }
                    b"DataArray" | b"Array" => {
                        let text = match is_empty {
                            true => &b""[..],
                            false => reader
                                .read_text(start.name())
                                .map(|text| match text {
                                    std::borrow::Cow::Borrowed(text) => text.as_bytes(),
                                    std::borrow::Cow::Owned(_) => b"",
                                })
                                .map_err(|e| Fault::unexpected(line, "XML", e.to_string().as_bytes()))?,
                        };
                        let array = encoding.array(&attributes, text).map_err(|p| Fault::at(line, p))?;
                        if let Some(numbers) = array {
                            piece.add(&mut data, &section, &attributes, numbers);
                        }
                    }
                    b"Piece" => piece = Piece::new(&attributes),
                    name => section = String::from_utf8_lossy(name).into_owned(),
                }
            }
            Event::End(end) if end.local_name().as_ref() == b"Piece" => {
                std::mem::take(&mut piece).finish(&mut data)?;
            }
            _ => {}
        }
    }
    if is_vtk { Ok(data) } else { Err(Fault::unexpected(1, "a file of VTK", &xml[..xml.len().min(40)])) }
}

/// The XML before the appended data, and that data, with whether it is base 64.
fn split_appended(bytes: &[u8]) -> (&[u8], Option<(bool, &[u8])>) {
    let tag = b"<AppendedData";
    let Some(start) = bytes.windows(tag.len()).position(|window| window == tag) else { return (bytes, None) };
    let rest = &bytes[start..];
    let end = rest.iter().position(|&b| b == b'>').unwrap_or(rest.len());
    let is_base64 = rest[..end].windows(6).any(|window| window == b"base64");
    let data = rest[end..].iter().position(|&b| b == b'_').map(|mark| &rest[end + mark + 1..]);
    (&bytes[..start], Some((is_base64, data.unwrap_or(b""))))
}

fn attributes(start: &BytesStart) -> Attributes {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let pair = |a: quick_xml::events::attributes::Attribute| {
        let value = a.unescape_value().map_or_else(|_| text(&a.value), |value| value.into_owned());
        (text(a.key.as_ref()), value)
    };
    start.attributes().flatten().map(pair).collect()
}

impl Encoding<'_> {
    fn root(&mut self, attributes: &Attributes) -> Result<(), FileProblem> {
        let get = |name: &str| attributes.get(name).map(String::as_str);
        self.is_big = get("byte_order") == Some("BigEndian");
        self.header = if get("header_type") == Some("UInt64") { Kind::U64 } else { Kind::U32 };
        match get("type") {
            Some("UnstructuredGrid" | "PolyData") => {}
            other => {
                let what = format!("a file of the type {}", other.unwrap_or("none"));
                return Err(FileProblem::NotRead { what, cure: "save an unstructured grid (.vtu)" });
            }
        }
        match get("compressor") {
            None | Some("") => {}
            Some("vtkZLibDataCompressor") => self.is_compressed = true,
            Some(other) => {
                let what = format!("the compression {other}");
                return Err(FileProblem::NotRead { what, cure: "save with zlib or without compression" });
            }
        }
        Ok(())
    }

    /// The numbers of an array; `None` for texts.
    fn array(&self, attributes: &Attributes, text: &[u8]) -> Result<Option<Vec<f64>>, FileProblem> {
        let get = |name: &str| attributes.get(name).map(String::as_str).unwrap_or_default();
        let Some(kind) = Kind::find(&get("type").to_lowercase()) else { return Ok(None) };
        let bytes = match get("format") {
            "binary" => self.bytes(&mut Source::Base64(Decoder::new(text)))?,
            "appended" => {
                let (is_base64, all) = self.appended.unwrap_or((false, b""));
                let offset: Option<usize> = parse(get("offset").as_bytes());
                let rest = offset.and_then(|offset| all.get(offset..));
                let rest = rest.ok_or_else(|| truncated("the appended data"))?;
                let mut source =
                    if is_base64 { Source::Base64(Decoder::new(rest)) } else { Source::Raw(rest) };
                self.bytes(&mut source)?
            }
            _ => {
                let words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
                let number = |word: &[u8]| {
                    let expected = "a number".to_string();
                    parse(word).ok_or_else(|| FileProblem::Unexpected { expected, found: excerpt(word) })
                };
                return words.map(number).collect::<Result<_, _>>().map(Some);
            }
        };
        Ok(Some(kind.numbers(&bytes, self.is_big)))
    }

    /// The bytes of an array behind its header.
    fn bytes(&self, source: &mut Source) -> Result<Vec<u8>, FileProblem> {
        let mut word = || -> Result<usize, FileProblem> {
            let bytes = source.take(self.header.size()).ok_or_else(|| truncated("the header of an array"))?;
            Ok(self.header.numbers(&bytes, self.is_big)[0] as usize)
        };
        if !self.is_compressed {
            let length = word()?;
            return source.take(length).ok_or_else(|| truncated("the numbers of an array"));
        }
        let (blocks, size, last) = (word()?, word()?, word()?);
        let mut lengths = Vec::new();
        for _ in 0..blocks {
            lengths.push(word()?);
        }
        let mut bytes = Vec::new();
        for (i, length) in lengths.into_iter().enumerate() {
            let most = if i + 1 == blocks && last > 0 { last } else { size };
            let packed = source.take(length).ok_or_else(|| truncated("a packed block"))?;
            let block = decompress_to_vec_zlib_with_limit(&packed, most);
            bytes.extend(block.map_err(|error| FileProblem::Unexpected {
                expected: format!("a zlib block of {most} bytes"),
                found: status(&error).to_string(),
            })?);
        }
        Ok(bytes)
    }
}

fn truncated(what: &str) -> FileProblem {
    FileProblem::Truncated(what.to_string())
}

/// Bytes one after the other.
enum Source<'a> {
    Raw(&'a [u8]),
    Base64(Decoder<'a>),
}

impl Source<'_> {
    fn take(&mut self, count: usize) -> Option<Vec<u8>> {
        match self {
            Self::Raw(rest) => {
                let (taken, left) = rest.split_at_checked(count)?;
                *rest = left;
                Some(taken.to_vec())
            }
            Self::Base64(decoder) => decoder.take(count),
        }
    }
}

/// Message for an error of miniz.
fn status(error: &DecompressError) -> &'static str {
    match error.status {
        TINFLStatus::HasMoreOutput => "a longer one",
        TINFLStatus::Adler32Mismatch => "a wrong checksum",
        _ => "damaged data",
    }
}
