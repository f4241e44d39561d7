//! Writes unstructured grids with inline base 64 arrays, as text by hand: `vtkio` knows no field data and no faces.

use std::path::Path;

use ndda_mesh::BlockMesh;

use super::base64::encode;
use super::data::{BODY_NAMES, SET, TETRA};
use crate::atomic;
use crate::mesh_file::join::Joined;
use crate::write_error::WriteError;

/// Writes a mesh of tetrahedra as `.vtu`.
///
/// Cell data `body` counts the bodies from 0; their names are the field data `body_names`, one to a line. Each node
/// set is point data `set:name` of 0 and 1.
///
/// # Errors
/// [`WriteError`] for a number that is not finite, a name that cannot be kept, and what the operating system refuses.
pub fn write(path: &Path, bodies: &[(String, BlockMesh)]) -> Result<(), WriteError> {
    let joined = Joined::new(path, bodies)?;
    let mut grid = Grid::new(joined.nodes.len(), joined.tets.len());
    grid.open("FieldData");
    grid.bytes(BODY_NAMES, joined.names.join("\n").as_bytes());
    grid.close("FieldData");
    grid.open_piece();
    grid.open("PointData");
    for (name, nodes) in &joined.sets {
        let mut flags = vec![0; joined.nodes.len()];
        nodes.iter().for_each(|&node| flags[node as usize] = 1);
        grid.bytes(&format!("{SET}{name}"), &flags);
    }
    grid.close("PointData");
    grid.open("CellData");
    grid.integers("body", joined.body_of_tets().map(i64::from));
    grid.close("CellData");
    grid.points(joined.nodes.iter().map(|x| [x.x, x.y, x.z]));
    grid.open("Cells");
    grid.integers("connectivity", joined.tets.as_flattened().iter().map(|&node| i64::from(node)));
    grid.integers("offsets", (1..=joined.tets.len() as i64).map(|tet| 4 * tet));
    grid.bytes("types", &vec![TETRA; joined.tets.len()]);
    grid.close("Cells");
    atomic::write(path, grid.finish().as_bytes())
}

/// The text of a file that is being made.
pub(super) struct Grid {
    text: String,
    counts: [usize; 2],
}

impl Grid {
    /// With so many points and cells.
    pub fn new(points: usize, cells: usize) -> Self {
        let text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
                    byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
        Self { text: text.to_string(), counts: [points, cells] }
    }

    pub fn open(&mut self, section: &str) {
        self.text += &format!("<{section}>\n");
    }

    pub fn close(&mut self, section: &str) {
        self.text += &format!("</{section}>\n");
    }

    pub fn open_piece(&mut self) {
        let [points, cells] = self.counts;
        self.text += &format!("<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n");
    }

    fn array(&mut self, kind: &str, name: &str, more: &str, bytes: &[u8]) {
        let name = name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        self.text += &format!("<DataArray type=\"{kind}\" Name=\"{name}\" {more} format=\"binary\">");
        let mut content = (bytes.len() as u64).to_le_bytes().to_vec();
        content.extend(bytes);
        encode(&content, &mut self.text);
        self.text += "</DataArray>\n";
    }

    pub fn bytes(&mut self, name: &str, bytes: &[u8]) {
        self.array("UInt8", name, &format!("NumberOfTuples=\"{}\"", bytes.len()), bytes);
    }

    pub fn integers(&mut self, name: &str, values: impl Iterator<Item = i64>) {
        self.array("Int64", name, "", &values.flat_map(i64::to_le_bytes).collect::<Vec<u8>>());
    }

    pub fn reals(&mut self, name: &str, values: impl Iterator<Item = f64>) {
        self.array("Float64", name, "", &values.flat_map(f64::to_le_bytes).collect::<Vec<u8>>());
    }

    pub fn points(&mut self, points: impl Iterator<Item = [f64; 3]>) {
        let bytes: Vec<u8> = points.flatten().flat_map(f64::to_le_bytes).collect();
        self.open("Points");
        self.array("Float64", "Points", "NumberOfComponents=\"3\"", &bytes);
        self.close("Points");
    }

    /// The whole file.
    pub fn finish(mut self) -> String {
        self.text += "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        self.text
    }
}
