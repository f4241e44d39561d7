//! The arrays of a piece of an XML file, put together into cells.

use std::collections::HashMap;

use super::data::{Data, POLYGON, count};
use crate::mesh_file::error::Fault;
use crate::mesh_file::lines::parse;

/// Arrays of a piece by section and name, as far as they make cells.
#[derive(Default)]
pub(super) struct Piece {
    points: Vec<f64>,
    cells: HashMap<&'static str, Vec<f64>>,
    polygons: HashMap<&'static str, Vec<f64>>,
    cell_data: Vec<(String, Vec<f64>)>,
    point_data: Vec<(String, Vec<f64>)>,
    /// Points and cells that its header promises; more are no reason to take memory.
    promised: [Option<usize>; 2],
}

impl Piece {
    /// A piece with the attributes of its header.
    pub fn new(attributes: &HashMap<String, String>) -> Self {
        let number = |name: &str| attributes.get(name).and_then(|text| parse(text.as_bytes()));
        Self { promised: ["NumberOfPoints", "NumberOfCells"].map(number), ..Self::default() }
    }

    /// Takes an array; those of several components and of no concern here are left out.
    pub fn add(
        &mut self,
        data: &mut Data,
        section: &str,
        attributes: &HashMap<String, String>,
        numbers: Vec<f64>,
    ) {
        let name = attributes.get("Name").cloned().unwrap_or_default();
        let is_scalar = attributes.get("NumberOfComponents").is_none_or(|count| count == "1" || count == "0");
        let part = ["connectivity", "offsets", "types"].into_iter().find(|part| *part == name);
        match (section, part) {
            ("Points", _) => self.points = numbers,
            ("Cells", Some(part)) => drop(self.cells.insert(part, numbers)),
            ("Polys", Some(part)) => drop(self.polygons.insert(part, numbers)),
            ("CellData", _) if is_scalar => self.cell_data.push((name, numbers)),
            ("PointData", _) if is_scalar => self.point_data.push((name, numbers)),
            ("FieldData", _) => drop(data.field_data.insert(name, numbers)),
            _ => {}
        }
    }

    /// Adds the piece to what the file holds.
    pub fn finish(mut self, data: &mut Data) -> Result<(), Fault> {
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
        for (name, values) in self.cell_data {
            count(&format!("entries of {name}"), values.len(), cells)?;
            data.cell_data.entry(name).or_default().extend(values);
        }
        for (name, values) in self.point_data {
            count(&format!("entries of {name}"), values.len(), points)?;
            data.point_data.entry(name).or_default().extend(values);
        }
        Ok(())
    }
}
