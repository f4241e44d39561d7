//! One frame of fields as a VTK unstructured grid (`.vtu`), the file that ParaView opens.

use std::path::Path;

use ndda_mesh::{BlockSet, Vec3};

use crate::mesh::vtk_file::TETRA;
use crate::mesh::vtk_file::grid::{Array, Grid};
use crate::scene::{FieldFormat, Precision};
use crate::write_error::WriteError;

/// Cells and their numbers, which are equal in all frames of a series; encoded once.
#[derive(Debug)]
pub struct Topology {
    format: FieldFormat,
    nodes: usize,
    tets: usize,
    cells: Vec<Array>,
    data: Vec<Array>,
}

impl Topology {
    /// The tetrahedra of `blocks`.
    ///
    /// # Panics
    /// When there is no block.
    pub fn new(blocks: &BlockSet, format: FieldFormat) -> Self {
        assert!(!blocks.is_empty(), "a frame without blocks");
        let tets = blocks.tets.len();
        let connectivity = blocks.tets.iter().flatten().map(|node| i64::from(node.0));
        let cells = vec![
            Array::integers("connectivity", connectivity, format),
            Array::integers("offsets", (1..=tets as i64).map(|tet| 4 * tet), format),
            Array::bytes("types", &vec![TETRA; tets], format),
        ];
        Self { format, nodes: blocks.rest_position.len(), tets, cells, data: Vec::new() }
    }

    /// With a number per tetrahedron that is the same in all frames.
    ///
    /// # Panics
    /// When there is not one for each.
    pub fn with_numbers(mut self, name: &str, numbers: impl ExactSizeIterator<Item = u32>) -> Self {
        assert_eq!(numbers.len(), self.tets, "{name} per tetrahedron");
        let bytes: Vec<u8> = numbers.flat_map(u32::to_le_bytes).collect();
        self.data.push(Array::new("UInt32", name, 1, &bytes, self.format));
        self
    }

    /// With the number of its block, `block_id`, for each tetrahedron.
    pub fn with_blocks(self, blocks: &BlockSet) -> Self {
        self.with_numbers("block_id", blocks.tet_block.iter().map(|block| block.0))
    }
}

/// Numbers of one moment, per node or per tetrahedron.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    name: &'static str,
    kind: &'static str,
    components: usize,
    count: usize,
    bytes: Vec<u8>,
    bad: Option<usize>,
}

impl Values {
    /// `N` numbers for each node or tetrahedron.
    pub fn new<const N: usize>(
        name: &'static str,
        entries: impl ExactSizeIterator<Item = [f64; N]>,
        precision: Precision,
    ) -> Self {
        let count = entries.len();
        let (kind, size) = match precision {
            Precision::F32 => ("Float32", 4),
            Precision::F64 => ("Float64", 8),
        };
        let mut bytes = Vec::with_capacity(size * N * count);
        let mut bad = None;
        for (index, entry) in entries.enumerate() {
            for number in entry {
                let small = number as f32;
                let finite = match precision {
                    Precision::F32 => small.is_finite(),
                    Precision::F64 => number.is_finite(),
                };
                if !finite {
                    bad = bad.or(Some(index));
                }
                match precision {
                    Precision::F32 => bytes.extend(small.to_le_bytes()),
                    Precision::F64 => bytes.extend(number.to_le_bytes()),
                }
            }
        }
        Self { name, kind, components: N, count, bytes, bad }
    }

    /// A vector for each node.
    pub fn vectors(
        name: &'static str,
        vectors: impl ExactSizeIterator<Item = Vec3>,
        precision: Precision,
    ) -> Self {
        Self::new(name, vectors.map(<[f64; 3]>::from), precision)
    }

    /// A small whole number for each node or tetrahedron.
    pub fn states(name: &'static str, states: Vec<u8>) -> Self {
        Self { name, kind: "UInt8", components: 1, count: states.len(), bytes: states, bad: None }
    }

    fn encoded(&self, path: &Path, count: usize, format: FieldFormat) -> Result<Array, WriteError> {
        assert_eq!(self.count, count, "entries of {}", self.name);
        match self.bad {
            Some(index) => Err(WriteError::not_finite(path, self.name, Some(index))),
            None => Ok(Array::new(self.kind, self.name, self.components, &self.bytes, format)),
        }
    }
}

/// The fields of one moment: what is written is what is in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    points: Values,
    point_data: Vec<Values>,
    cell_data: Vec<Values>,
}

impl Frame {
    /// Positions per node \[m\], relative to the origin of `blocks`; the file has the coordinates of the scene.
    pub fn new(blocks: &BlockSet, position: &[Vec3]) -> Self {
        let points = position.iter().map(|x| x + blocks.origin_m);
        let points = Values::vectors("Points", points, Precision::F64);
        Self { points, point_data: Vec::new(), cell_data: Vec::new() }
    }

    /// Adds numbers per node. The first vectors and scalars are the ones that ParaView's filters offer first.
    pub fn add_points(&mut self, values: Values) {
        self.point_data.push(values);
    }

    /// Adds numbers per tetrahedron.
    pub fn add_cells(&mut self, values: Values) {
        self.cell_data.push(values);
    }
}

impl Frame {
    /// The file of a frame; `path` is what an error names.
    ///
    /// # Errors
    /// [`WriteError::NotFinite`] for the first number that is not finite.
    ///
    /// # Panics
    /// When an array has not one entry per node or tetrahedron.
    pub fn encode(&self, path: &Path, topology: &Topology) -> Result<Vec<u8>, WriteError> {
        let Topology { format, nodes, tets, cells, data } = topology;
        let all = |values: &[Values], count| -> Result<Vec<Array>, WriteError> {
            values.iter().map(|values| values.encoded(path, count, *format)).collect()
        };
        let points = self.points.encoded(path, *nodes, *format)?;
        let (point_data, cell_data) = (all(&self.point_data, *nodes)?, all(&self.cell_data, *tets)?);
        let mut grid = Grid::new(*nodes, *tets, *format);
        grid.open_piece();
        grid.section("PointData", &point_data);
        grid.section("CellData", cell_data.iter().chain(data));
        grid.section("Points", [&points]);
        grid.section("Cells", cells);
        Ok(grid.finish())
    }
}

#[cfg(test)]
mod tests {
    use ndda_mesh::BlockMesh;

    use super::*;
    use crate::mesh::vtk_file::data;

    const FORMATS: [FieldFormat; 3] = [FieldFormat::Compressed, FieldFormat::Appended, FieldFormat::Base64];

    fn two_tets_at(x: f64) -> BlockSet {
        let corners = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)];
        let at = |x0: f64| BlockMesh {
            nodes: corners.map(|(x, y, z)| Vec3::new(x0 + x, y, z)).to_vec(),
            tets: vec![[0, 1, 2, 3]],
            ..BlockMesh::default()
        };
        BlockSet::new(vec![("a".into(), at(x)), ("b".into(), at(x + 2.0))]).unwrap()
    }

    #[test]
    fn what_is_written_is_read_back_bit_by_bit_in_every_format() {
        let blocks = two_tets_at(4.5e6);
        let heights: Vec<f64> =
            (0..8).map(|i| if i == 3 { 1e-300 } else { -1.0 / 3.0 * f64::from(i) }).collect();
        let pressures = [0.1 + 0.2, f64::MIN_POSITIVE / 8.0];
        for format in FORMATS {
            let topology = Topology::new(&blocks, format).with_blocks(&blocks);
            let mut frame = Frame::new(&blocks, &blocks.rest_position);
            frame.add_points(Values::new("height_m", heights.iter().map(|&h| [h]), Precision::F64));
            frame.add_points(Values::states("friction_state", vec![2; 8]));
            frame.add_cells(Values::new("pressure_pa", pressures.iter().map(|&p| [p]), Precision::F64));
            frame.add_cells(Values::new("rough_pa", pressures.iter().map(|&p| [p]), Precision::F32));
            let file = frame.encode(Path::new("a.vtu"), &topology).unwrap();
            let read = data(&file).unwrap_or_else(|_| panic!("{format:?} is not read"));
            assert_eq!(read.points[5], blocks.rest_position[5] + blocks.origin_m);
            assert_eq!((read.kinds, read.nodes), (vec![TETRA; 2], (0..8).collect()));
            assert_eq!(read.point_data["height_m"], heights);
            assert_eq!(read.point_data["friction_state"], [2.0; 8]);
            assert_eq!(read.cell_data["pressure_pa"], pressures);
            assert_eq!(read.cell_data["rough_pa"], pressures.map(|p| f64::from(p as f32)));
            assert_eq!(read.cell_data["block_id"], [0.0, 1.0]);
        }
    }

    #[test]
    fn arrays_larger_than_a_block_are_packed_whole() {
        // One block, a block and a bit, exactly two.
        for count in [1usize << 17, (1 << 17) + 1, 1 << 18] {
            let numbers: Vec<f64> = (0..count).map(|i| (i as f64).sqrt()).collect();
            let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
            let mut grid = Grid::new(count, 0, FieldFormat::Compressed);
            grid.open_piece();
            let values = Array::new("Float64", "x", 1, &bytes, FieldFormat::Compressed);
            grid.section("PointData", [&values]);
            grid.points((0..count).map(|_| [0.0; 3]));
            grid.section("Cells", []);
            let file = grid.finish();
            assert_eq!(data(&file).unwrap_or_else(|_| panic!("{count}")).point_data["x"], numbers);
        }
    }

    #[test]
    fn a_number_that_is_not_finite_is_refused_by_name_and_index() {
        let blocks = two_tets_at(0.0);
        let topology = Topology::new(&blocks, FieldFormat::Compressed);
        let refused = |velocity: f64, precision| {
            let mut frame = Frame::new(&blocks, &blocks.rest_position);
            let velocities = (0..8).map(|i| if i == 5 { Vec3::repeat(velocity) } else { Vec3::zeros() });
            frame.add_points(Values::vectors("velocity_m_s", velocities, precision));
            frame.encode(Path::new("a.vtu"), &topology).unwrap_err()
        };
        for (velocity, precision) in [(f64::NAN, Precision::F64), (1e200, Precision::F32)] {
            let error = refused(velocity, precision);
            assert!(
                matches!(&error, WriteError::NotFinite { array, index: Some(5), .. } if array == "velocity_m_s"),
                "{error}"
            );
        }
    }
}
