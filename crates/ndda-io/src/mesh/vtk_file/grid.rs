//! Writes unstructured grids as text by hand, arrays inline or appended: `vtkio` knows no appended arrays, no field data
//! and no faces.
//!
//! Format: VTK user's guide, "VTK File Formats". Numbers are little-endian, headers of arrays are 64-bit.

use miniz_oxide::deflate::compress_to_vec_zlib;

use super::base64::encode;
use crate::scene::FieldFormat;

/// Bytes that are packed together; VTK unpacks one such block at a time.
const BLOCK: usize = 1 << 20;
/// Little is gained by trying harder on floating-point numbers.
const LEVEL: u8 = 1;

/// An array, ready to be put into a file: it can be put into many.
#[derive(Clone, Debug)]
pub(crate) struct Array {
    declaration: String,
    content: Vec<u8>,
    format: FieldFormat,
}

impl Array {
    /// Numbers as bytes, of a type by its name in VTK, `components` to a point or cell.
    pub(crate) fn new(kind: &str, name: &str, components: usize, bytes: &[u8], format: FieldFormat) -> Self {
        let shape =
            if components > 1 { format!(" NumberOfComponents=\"{components}\"") } else { String::new() };
        Self::declared(kind, name, &shape, bytes, format)
    }

    fn declared(kind: &str, name: &str, more: &str, bytes: &[u8], format: FieldFormat) -> Self {
        let name = name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let declaration = format!("<DataArray type=\"{kind}\" Name=\"{name}\"{more}");
        let content = match format {
            FieldFormat::Compressed => packed(bytes),
            FieldFormat::Appended => with_length(bytes),
            FieldFormat::Base64 => {
                let mut text = String::new();
                encode(&with_length(bytes), &mut text);
                text.into_bytes()
            }
        };
        Self { declaration, content, format }
    }

    pub(crate) fn bytes(name: &str, bytes: &[u8], format: FieldFormat) -> Self {
        Self::new("UInt8", name, 1, bytes, format)
    }

    pub(crate) fn integers(name: &str, values: impl Iterator<Item = i64>, format: FieldFormat) -> Self {
        Self::new("Int64", name, 1, &values.flat_map(i64::to_le_bytes).collect::<Vec<u8>>(), format)
    }
}

/// How many bytes, and the bytes.
fn with_length(bytes: &[u8]) -> Vec<u8> {
    let mut content = (bytes.len() as u64).to_le_bytes().to_vec();
    content.extend(bytes);
    content
}

/// How many blocks, their size, the size of a last one that is not full, the packed size of each, and the blocks.
fn packed(bytes: &[u8]) -> Vec<u8> {
    let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK).map(|block| compress_to_vec_zlib(block, LEVEL)).collect();
    let header = [blocks.len(), BLOCK, bytes.len() % BLOCK];
    let sizes = header.into_iter().chain(blocks.iter().map(Vec::len));
    let mut content: Vec<u8> = sizes.flat_map(|size| (size as u64).to_le_bytes()).collect();
    blocks.iter().for_each(|block| content.extend(block));
    content
}

/// A file that is being made.
pub(crate) struct Grid {
    text: Vec<u8>,
    appended: Vec<u8>,
    counts: [usize; 2],
    format: FieldFormat,
}

impl Grid {
    /// With so many points and cells.
    pub(crate) fn new(points: usize, cells: usize, format: FieldFormat) -> Self {
        let compressor = match format {
            FieldFormat::Compressed => " compressor=\"vtkZLibDataCompressor\"",
            _ => "",
        };
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\"{compressor}>\n<UnstructuredGrid>\n"
        );
        Self { text: text.into_bytes(), appended: Vec::new(), counts: [points, cells], format }
    }

    fn line(&mut self, line: &str) {
        self.text.extend(line.as_bytes());
        self.text.push(b'\n');
    }

    pub(crate) fn open(&mut self, section: &str) {
        self.line(&format!("<{section}>"));
    }

    pub(crate) fn close(&mut self, section: &str) {
        self.line(&format!("</{section}>"));
    }

    pub(crate) fn open_piece(&mut self) {
        let [points, cells] = self.counts;
        self.line(&format!("<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">"));
    }

    /// Adds an array.
    ///
    /// # Panics
    /// When it was made for another format.
    pub(crate) fn add(&mut self, array: &Array) {
        assert_eq!(array.format, self.format, "the format of an array");
        self.text.extend(array.declaration.as_bytes());
        if array.format == FieldFormat::Base64 {
            self.text.extend(b" format=\"binary\">");
            self.text.extend(&array.content);
            self.line("</DataArray>");
        } else {
            self.line(&format!(" format=\"appended\" offset=\"{}\"/>", self.appended.len()));
            self.appended.extend(&array.content);
        }
    }

    /// A section of its own for arrays.
    pub(crate) fn section<'a>(&mut self, name: &str, arrays: impl IntoIterator<Item = &'a Array>) {
        self.open(name);
        arrays.into_iter().for_each(|array| self.add(array));
        self.close(name);
    }

    /// Adds field data, whose length no count of points or cells says.
    pub(crate) fn field_bytes(&mut self, name: &str, bytes: &[u8]) {
        let more = format!(" NumberOfTuples=\"{}\"", bytes.len());
        self.add(&Array::declared("UInt8", name, &more, bytes, self.format));
    }

    pub(crate) fn bytes(&mut self, name: &str, bytes: &[u8]) {
        self.add(&Array::bytes(name, bytes, self.format));
    }

    pub(crate) fn integers(&mut self, name: &str, values: impl Iterator<Item = i64>) {
        self.add(&Array::integers(name, values, self.format));
    }

    pub(crate) fn reals(&mut self, name: &str, values: impl Iterator<Item = f64>) {
        let bytes: Vec<u8> = values.flat_map(f64::to_le_bytes).collect();
        self.add(&Array::new("Float64", name, 1, &bytes, self.format));
    }

    pub(crate) fn points(&mut self, points: impl Iterator<Item = [f64; 3]>) {
        let bytes: Vec<u8> = points.flatten().flat_map(f64::to_le_bytes).collect();
        self.section("Points", [&Array::new("Float64", "Points", 3, &bytes, self.format)]);
    }

    /// The whole file.
    pub(crate) fn finish(mut self) -> Vec<u8> {
        self.line("</Piece>\n</UnstructuredGrid>");
        if self.format != FieldFormat::Base64 {
            self.text.extend(b"<AppendedData encoding=\"raw\">\n_");
            self.text.append(&mut self.appended);
            self.line("\n</AppendedData>");
        }
        self.line("</VTKFile>");
        self.text
    }
}
