//! The legacy format, `.vtk`, ASCII or binary (highest byte first), to version 5.1.

use super::binary::Kind;
use super::data::{Data, POLYGON, count, whole};
use crate::mesh::FileProblem;
use crate::mesh::error::Fault;
use crate::mesh::lines::parse;

/// Where arrays of data go.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Field,
    Cell(usize),
    Point(usize),
}

/// A position in the file.
struct Text<'a> {
    bytes: &'a [u8],
    next: usize,
    start: usize,
    is_binary: bool,
}

/// Reads an unstructured grid or polygonal data.
pub(super) fn read(bytes: &[u8]) -> Result<Data, Fault> {
    let mut text = Text { bytes, next: 0, start: 0, is_binary: false };
    text.rest_of_line();
    text.rest_of_line();
    text.is_binary = match text.word("ASCII or BINARY")? {
        b"ASCII" => false,
        b"BINARY" => true,
        other => return Err(text.unexpected("ASCII or BINARY", other)),
    };
    let mut data = Data::default();
    let (mut kinds, mut cells) = (Vec::new(), (Vec::new(), Vec::new()));
    let mut section = Section::Field;
    while !text.is_at_end() {
        let word = text.word("a keyword")?.to_ascii_uppercase();
        match word.as_slice() {
            b"DATASET" => match text.word("the kind of data")? {
                b"UNSTRUCTURED_GRID" | b"POLYDATA" => {}
                other => return Err(text.unexpected("UNSTRUCTURED_GRID or POLYDATA", other)),
            },
            b"POINTS" => {
                let points = text.count("the number of points")?;
                let kind = text.kind()?;
                let coordinates = text.numbers(points.saturating_mul(3), kind)?;
                data.add_points(&coordinates)?;
            }
            b"CELLS" => cells = text.cells()?,
            b"CELL_TYPES" => {
                let cells = text.count("the number of cells")?;
                text.rest_of_line();
                kinds = text.numbers(cells, Kind::I32)?;
            }
            b"POLYGONS" => {
                let (ends, nodes) = text.cells()?;
                data.add_cells(&vec![f64::from(POLYGON); ends.len()], &ends, &nodes, 0)?;
            }
            b"VERTICES" | b"LINES" => drop(text.cells()?),
            b"CELL_DATA" => section = Section::Cell(text.count("the number of cells")?),
            b"POINT_DATA" => section = Section::Point(text.count("the number of points")?),
            b"METADATA" => text.skip_metadata(),
            other => attribute(other, &mut text, section, &mut data)?,
        }
    }
    data.add_cells(&kinds, &cells.0, &cells.1, 0)?;
    Ok(data)
}

/// One array of data, or a field of several.
fn attribute(keyword: &[u8], text: &mut Text, section: Section, data: &mut Data) -> Result<(), Fault> {
    let tuples = match section {
        Section::Cell(tuples) | Section::Point(tuples) => tuples,
        Section::Field => 0,
    };
    let name = String::from_utf8_lossy(text.word("a name")?).into_owned();
    let components = match keyword {
        b"FIELD" => return field(text, section, data),
        b"LOOKUP_TABLE" => {
            let colours = text.count("the number of colours")?;
            text.rest_of_line();
            let kind = if text.is_binary { Kind::U8 } else { Kind::F32 };
            return text.numbers(colours.saturating_mul(4), kind).map(drop);
        }
        b"COLOR_SCALARS" => {
            let components = text.count("the number of components")?;
            text.rest_of_line();
            let kind = if text.is_binary { Kind::U8 } else { Kind::F32 };
            return text.numbers(tuples.saturating_mul(components), kind).map(drop);
        }
        b"SCALARS" => {
            let kind = text.kind_word()?;
            // One unless it is said.
            let rest = text.rest_of_line();
            let components = match rest.is_empty() {
                true => 1,
                false => parse(rest).ok_or_else(|| text.unexpected("the number of components", rest))?,
            };
            if text.peek() == b"LOOKUP_TABLE" {
                text.rest_of_line();
            }
            let numbers = text.numbers(tuples.saturating_mul(components), kind)?;
            return put(data, section, name, components, numbers);
        }
        b"VECTORS" | b"NORMALS" => 3,
        b"TENSORS" => 9,
        b"TENSORS6" => 6,
        b"GLOBAL_IDS" | b"PEDIGREE_IDS" => 1,
        b"TEXTURE_COORDINATES" => text.count("the number of components")?,
        other => return Err(text.unexpected("a keyword of VTK's legacy format", other)),
    };
    let kind = text.kind()?;
    text.numbers(tuples.saturating_mul(components), kind).map(drop)
}

/// `count`, then `name components tuples type` before each array.
fn field(text: &mut Text, section: Section, data: &mut Data) -> Result<(), Fault> {
    for _ in 0..text.count("the number of arrays")? {
        if text.peek() == b"METADATA" {
            text.rest_of_line();
            text.skip_metadata();
        }
        let name = String::from_utf8_lossy(text.word("a name")?).into_owned();
        let (components, tuples) = (text.count("components")?, text.count("tuples")?);
        let kind = text.kind()?;
        let numbers = text.numbers(tuples.saturating_mul(components), kind)?;
        put(data, section, name, components, numbers)?;
    }
    Ok(())
}

/// Keeps an array of one component.
fn put(
    data: &mut Data,
    section: Section,
    name: String,
    components: usize,
    numbers: Vec<f64>,
) -> Result<(), Fault> {
    // Blanks in names are written so.
    let name = name.replace("%20", " ").replace("%3A", ":");
    let (map, tuples) = match section {
        Section::Field => (&mut data.field_data, numbers.len()),
        Section::Cell(tuples) => (&mut data.cell_data, tuples),
        Section::Point(tuples) => (&mut data.point_data, tuples),
    };
    if components == 1 {
        count(&format!("entries of {name}"), numbers.len(), tuples)?;
        map.insert(name, numbers);
    }
    Ok(())
}

impl<'a> Text<'a> {
    fn unexpected(&self, expected: &str, found: &[u8]) -> Fault {
        let line = 1 + self.bytes[..self.start].iter().filter(|&&b| b == b'\n').count();
        let fault = Fault::unexpected(line, expected, found);
        if self.is_binary { Fault { line: None, ..fault } } else { fault }
    }

    fn skip_space(&mut self) {
        self.next += self.bytes[self.next..].iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    fn is_at_end(&mut self) -> bool {
        self.skip_space();
        self.next == self.bytes.len()
    }

    /// The next word, which is left.
    fn peek(&mut self) -> &'a [u8] {
        self.skip_space();
        let rest = &self.bytes[self.next..];
        &rest[..rest.iter().take_while(|b| !b.is_ascii_whitespace()).count()]
    }

    fn word(&mut self, expected: &str) -> Result<&'a [u8], Fault> {
        let word = self.peek();
        self.start = self.next;
        self.next += word.len();
        if word.is_empty() { Err(Fault::truncated(expected)) } else { Ok(word) }
    }

    fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.next..];
        let length = rest.iter().take_while(|&&b| b != b'\n').count();
        self.next += (length + 1).min(rest.len());
        rest[..length].trim_ascii()
    }

    /// To the next empty line.
    fn skip_metadata(&mut self) {
        while self.next < self.bytes.len() && !self.rest_of_line().is_empty() {}
    }

    fn count(&mut self, expected: &str) -> Result<usize, Fault> {
        let word = self.word(expected)?;
        parse(word).ok_or_else(|| self.unexpected(expected, word))
    }

    fn kind_word(&mut self) -> Result<Kind, Fault> {
        let word = self.word("a type of numbers")?;
        let kind = Kind::find(&String::from_utf8_lossy(word).to_lowercase());
        kind.ok_or_else(|| self.unexpected("a type of numbers such as double", word))
    }

    /// The type at the end of a line; what follows may be binary.
    fn kind(&mut self) -> Result<Kind, Fault> {
        let kind = self.kind_word()?;
        self.rest_of_line();
        Ok(kind)
    }

    fn numbers(&mut self, count: usize, kind: Kind) -> Result<Vec<f64>, Fault> {
        let rest = &self.bytes[self.next..];
        let least = if self.is_binary { kind.size() } else { 2 };
        if count.checked_mul(least).is_none_or(|bytes| bytes > rest.len() + 1) {
            return Err(FileProblem::TooShort { what: "numbers", count: count as u64 }.into());
        }
        if self.is_binary {
            let bytes = rest.get(..count * kind.size()).ok_or_else(|| Fault::truncated("numbers"))?;
            self.next += bytes.len();
            return Ok(kind.numbers(bytes, true));
        }
        let mut number = || {
            let word = self.word("a number")?;
            parse(word).ok_or_else(|| self.unexpected("a number", word))
        };
        (0..count).map(|_| number()).collect()
    }

    /// Ends and points of cells: `count size`, then in one list or, from 5.1 on, in two.
    fn cells(&mut self) -> Result<(Vec<f64>, Vec<f64>), Fault> {
        let (cells, size) = (self.count("the number of cells")?, self.count("the size of the cells")?);
        self.rest_of_line();
        if self.next < self.bytes.len() && self.bytes[self.next..].starts_with(b"OFFSETS") {
            self.word("OFFSETS")?;
            let kind = self.kind()?;
            let mut ends = self.numbers(cells, kind)?;
            if self.word("CONNECTIVITY")? != b"CONNECTIVITY" {
                return Err(self.unexpected("CONNECTIVITY", b""));
            }
            let kind = self.kind()?;
            let nodes = self.numbers(size, kind)?;
            if !ends.is_empty() {
                ends.remove(0);
            }
            return Ok((ends, nodes));
        }
        let list = self.numbers(size, Kind::I32)?;
        let (mut ends, mut nodes, mut rest) = (Vec::new(), Vec::new(), &list[..]);
        while let Some((&length, after)) = rest.split_first() {
            let length = whole(length, after.len(), "the number of points of a cell")?;
            nodes.extend(&after[..length]);
            ends.push(nodes.len() as f64);
            rest = &after[length..];
        }
        count("cells", ends.len(), cells)?;
        Ok((ends, nodes))
    }
}
