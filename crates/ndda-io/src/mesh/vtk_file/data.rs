//! Content of a VTK file, of either format, and the mesh in it.

use std::collections::BTreeMap;

use ndda_mesh::Vec3;

use crate::mesh::FileProblem;
use crate::mesh::error::Fault;
use crate::mesh::parts::Parts;

/// Number of the tetrahedron among VTK's cell types.
pub(crate) const TETRA: u8 = 10;
/// Number of the polygon.
pub(super) const POLYGON: u8 = 7;
/// Cell types without volume.
const FLAT: [u8; 17] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 21, 22, 23, 28, 30, 34, 35, 36];
/// Names of cell data that say the body, best first.
const BODY_ARRAYS: [&str; 6] = ["body", "block", "block_id", "material", "gmsh:physical", "medit:ref"];
/// Point data of this beginning is a node set.
pub(super) const SET: &str = "set:";
/// Field data with the names of the bodies, one to a line, in UTF-8.
pub(super) const BODY_NAMES: &str = "body_names";

/// An array of points or cells of several components.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array {
    /// Numbers per entry.
    pub components: usize,
    /// The numbers, one entry after the other.
    pub values: Vec<f64>,
}

/// Points and cells with their data.
#[derive(Default)]
pub(crate) struct Data {
    /// Positions [unit of the file].
    pub points: Vec<Vec3>,
    /// VTK's type of each cell.
    pub kinds: Vec<u8>,
    /// End of each cell in `nodes`.
    pub ends: Vec<usize>,
    /// Points of the cells, one cell after the other; all are in `points`.
    pub nodes: Vec<u32>,
    /// Cell data of one component.
    pub cell_data: BTreeMap<String, Vec<f64>>,
    /// Point data of one component.
    pub point_data: BTreeMap<String, Vec<f64>>,
    /// Cell data of several components.
    pub cell_arrays: BTreeMap<String, Array>,
    /// Point data of several components.
    pub point_arrays: BTreeMap<String, Array>,
    /// Field data.
    pub field_data: BTreeMap<String, Vec<f64>>,
}

impl Data {
    /// Adds points, three coordinates each.
    pub(crate) fn add_points(&mut self, coordinates: &[f64]) -> Result<(), Fault> {
        if let Some(bad) = coordinates.iter().find(|x| !x.is_finite()) {
            let (expected, found) = ("finite coordinates".into(), bad.to_string());
            return Err(FileProblem::Unexpected { expected, found }.into());
        }
        self.points.extend(coordinates.chunks_exact(3).map(Vec3::from_column_slice));
        if u32::try_from(self.points.len()).is_err() { Err(FileProblem::TooManyNodes.into()) } else { Ok(()) }
    }

    /// Adds cells by their types, ends in `connectivity`, and points counted from point `first`.
    pub(crate) fn add_cells(
        &mut self,
        kinds: &[f64],
        ends: &[f64],
        connectivity: &[f64],
        first: usize,
    ) -> Result<(), Fault> {
        count("cell types", kinds.len(), ends.len())?;
        let base = self.nodes.len();
        let mut last = 0;
        for (kind, &end) in kinds.iter().zip(ends) {
            let end = whole(end, connectivity.len(), "the end of a cell")?;
            if end < last {
                return Err(unexpected("offsets that rise", end as f64));
            }
            last = end;
            self.ends.push(base + end);
            self.kinds.push(whole(*kind, 255, "a cell type")? as u8);
        }
        for &node in &connectivity[..last] {
            let index = (node.fract() == 0.0 && node >= 0.0).then_some(node as usize);
            let index = index.and_then(|node| node.checked_add(first)).filter(|&i| i < self.points.len());
            let missing = || FileProblem::NoSuchNode { what: "a cell".into(), node: node as i64 };
            self.nodes.push(index.ok_or_else(missing)? as u32);
        }
        Ok(())
    }

    /// Type and points of each cell.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (u8, &[u32])> {
        let start = |i: usize| if i == 0 { 0 } else { self.ends[i - 1] };
        self.kinds.iter().enumerate().map(move |(i, &kind)| (kind, &self.nodes[start(i)..self.ends[i]]))
    }

    /// The tetrahedra, their bodies and the node sets.
    pub(crate) fn parts(mut self) -> Result<Parts, Fault> {
        let mut parts = Parts::default();
        let mut ids = Vec::new();
        let body = BODY_ARRAYS.iter().find_map(|name| self.cell_data.get_key_value(*name));
        if let Some((name, values)) = body {
            count(&format!("entries of {name}"), values.len(), self.kinds.len())?;
        }
        for (i, (kind, nodes)) in self.cells().enumerate() {
            match (kind, nodes) {
                (TETRA, &[a, b, c, d]) => {
                    parts.tets.push([a, b, c, d]);
                    ids.extend(body.map(|(_, values)| values[i]));
                }
                (TETRA, _) => return Err(unexpected("four points of a tetrahedron", nodes.len() as f64)),
                _ if FLAT.contains(&kind) => {}
                _ => {
                    let what = format!("a cell of VTK's type {kind}");
                    return Err(
                        FileProblem::NotRead { what, cure: "mesh with tetrahedra of first order" }.into()
                    );
                }
            }
        }
        if let Some((array, _)) = body {
            (parts.names, parts.body) = self.bodies(array, &ids)?;
        }
        for (name, values) in &self.point_data {
            let Some(set) = name.strip_prefix(SET) else { continue };
            count(&format!("entries of {name}"), values.len(), self.points.len())?;
            let nodes = (0..).zip(values).filter(|(_, value)| **value == 1.0).map(|(i, _)| [i; 4]);
            parts.sets.insert(set.to_string(), nodes.collect());
        }
        parts.nodes = std::mem::take(&mut self.points);
        Ok(parts)
    }

    /// Names of the bodies, and the body of each tetrahedron.
    fn bodies(&self, array: &str, ids: &[f64]) -> Result<(Vec<String>, Vec<u32>), Fault> {
        let mut numbers = Vec::with_capacity(ids.len());
        for &id in ids {
            if id.fract() != 0.0 || id.abs() > 1e15 {
                return Err(unexpected(&format!("whole numbers in {array}"), id));
            }
            numbers.push(id as i64);
        }
        let mut known = numbers.clone();
        known.sort_unstable();
        known.dedup();
        let text: Vec<u8> = self.field_data.get(BODY_NAMES).into_iter().flatten().map(|&b| b as u8).collect();
        let text = String::from_utf8_lossy(&text);
        let given: Vec<&str> = text.lines().collect();
        let name = |id: &i64| {
            let given = usize::try_from(*id).ok().and_then(|i| given.get(i)).filter(|name| !name.is_empty());
            given.map_or_else(|| format!("{array}_{id}"), |name| name.to_string())
        };
        let body = numbers.iter().map(|id| known.partition_point(|k| k < id) as u32);
        Ok((known.iter().map(name).collect(), body.collect()))
    }
}

/// Something else than `expected`.
pub(super) fn unexpected(expected: &str, found: f64) -> Fault {
    FileProblem::Unexpected { expected: expected.to_string(), found: found.to_string() }.into()
}

/// A list of `found` entries that should have `needed`.
pub(super) fn count(what: &str, found: usize, needed: usize) -> Result<(), Fault> {
    let problem = FileProblem::Count { what: what.to_string(), found, needed };
    if found == needed { Ok(()) } else { Err(problem.into()) }
}

/// A whole number from 0 to `most`.
pub(super) fn whole(value: f64, most: usize, what: &str) -> Result<usize, Fault> {
    let good = value.fract() == 0.0 && (0.0..=most as f64).contains(&value);
    if good { Ok(value as usize) } else { Err(unexpected(&format!("{what}, from 0 to {most}"), value)) }
}
