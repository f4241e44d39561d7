//! The arrays of a piece of an XML file, put together into cells.

use std::collections::{BTreeMap, HashMap};

use super::data::{Array, Data, POLYGON, count};
use crate::mesh::error::Fault;
use crate::mesh::lines::parse;

/// Arrays of a piece by section and name, as far as they make cells.
#[derive(Default)]
pub(super) struct Piece {
    points: Vec<f64>,
    cells: HashMap<&'static str, Vec<f64>>,
    polygons: HashMap<&'static str, Vec<f64>>,
    cell_data: Vec<(String, Array)>,
    point_data: Vec<(String, Array)>,
    /// Points and cells that its header promises; more are no reason to take memory.
    promised: [Option<usize>; 2],
}

impl Piece {
    /// A piece with the attributes of its header.
    pub(crate) fn new(attributes: &HashMap<String, String>) -> Self {
        let number = |name: &str| attributes.get(name).and_then(|text| parse(text.as_bytes()));
        Self { promised: ["NumberOfPoints", "NumberOfCells"].map(number), ..Self::default() }
    }

    /// Takes an array; those of no concern here are left out.
    pub(crate) fn add(
        &mut self,
        data: &mut Data,
        section: &str,
        attributes: &HashMap<String, String>,
        numbers: Vec<f64>,
    ) {
        let name = attributes.get("Name").cloned().unwrap_or_default();
        let components = attributes.get("NumberOfComponents").and_then(|text| text.parse().ok());
        // VTK writes 0 for what was never set, and means 1.
        let components: usize = components.unwrap_or(1).max(1);
        let part = ["connectivity", "offsets", "types"].into_iter().find(|part| *part == name);
        match (section, part) {
            ("Points", _) => self.points = numbers,
            ("Cells", Some(part)) => drop(self.cells.insert(part, numbers)),
            ("Polys", Some(part)) => drop(self.polygons.insert(part, numbers)),
            ("CellData", _) => self.cell_data.push((name, Array { components, values: numbers })),
            ("PointData", _) => self.point_data.push((name, Array { components, values: numbers })),
            ("FieldData", _) => drop(data.field_data.insert(name, numbers)),
            _ => {}
        }
    }

    /// Adds the piece to what the file holds.
    pub(crate) fn finish(mut self, data: &mut Data) -> Result<(), Fault> {
        let (first_point, first_cell) = (data.points.len(), data.kinds.len());
        count("coordinates", self.points.len(), self.points.len() / 3 * 3)?;
        data.add_points(&self.points)?;
        for arrays in [&mut self.cells, &mut self.polygons] {
            let [connectivity, ends] =
                ["connectivity", "offsets"].map(|name| arrays.remove(name).unwrap_or_default());
            let polygons = || vec![f64::from(POLYGON); ends.len()];
            let kinds = arrays.remove("types").unwrap_or_else(polygons);
            data.add_cells(&kinds, &ends, &connectivity, first_point)?;
        }
        let (points, cells) = (data.points.len() - first_point, data.kinds.len() - first_cell);
        for (what, found, promised) in
            [("points", points, self.promised[0]), ("cells", cells, self.promised[1])]
        {
            count(what, found, promised.unwrap_or(found))?;
        }
        for (name, array) in self.cell_data {
            add(name, array, cells, &mut data.cell_data, &mut data.cell_arrays)?;
        }
        for (name, array) in self.point_data {
            add(name, array, points, &mut data.point_data, &mut data.point_arrays)?;
        }
        Ok(())
    }
}

/// Adds an array of `entries` to the scalars or to the others.
fn add(
    name: String,
    array: Array,
    entries: usize,
    scalars: &mut BTreeMap<String, Vec<f64>>,
    others: &mut BTreeMap<String, Array>,
) -> Result<(), Fault> {
    let needed = entries.saturating_mul(array.components);
    count(&format!("entries of {name}"), array.values.len(), needed)?;
    if array.components == 1 {
        scalars.entry(name).or_default().extend(array.values);
    } else {
        let known = others.entry(name.clone()).or_default();
        if known.components == 0 {
            known.components = array.components;
        }
        count(&format!("components of {name}"), array.components, known.components)?;
        known.values.extend(array.values);
    }
    Ok(())
}
