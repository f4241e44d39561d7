//! Classes of ground on a grid, as geographic information systems write maps of soil or land use: a whole number for each cell.

use std::collections::BTreeMap;
use std::path::Path;

use ndda_io::mesh::terrain_grid::TerrainGrid;
use ndda_io::scene::{Ground, Rockfall};

/// Classes on a grid; cells without a class have none.
#[derive(Clone, Debug, PartialEq)]
pub struct Classes {
    /// Centre of the south-western cell [m].
    origin_m: [f64; 2],
    /// Size of cells along x and y [m].
    step_m: [f64; 2],
    /// Rows along x, the southernmost first.
    rows: Vec<Vec<Option<u32>>>,
    /// Cells of each class.
    cells: BTreeMap<u32, usize>,
}

/// What is wrong, and the place in the scene that says it.
pub type Refused = (String, String);

impl Classes {
    /// Reads the classes of a scene, if it gives any; the point of the map that is (0, 0) in the scene is that of the terrain.
    ///
    /// # Errors
    /// What is wrong with the file, or a zone of a class that it does not have.
    pub fn of(rockfall: &Rockfall, folder: &Path) -> Result<Option<Self>, Refused> {
        let Some(file) = &rockfall.class_grid else { return Ok(None) };
        let read = |file: &str| {
            let grid = TerrainGrid::read(&folder.join(file), None).map_err(|error| error.to_string())?;
            Self::new(grid, &rockfall.terrain).map_err(|problem| format!("{file}: {problem}"))
        };
        let classes = read(file).map_err(|problem| ("rockfall.class_grid".to_string(), problem))?;
        let named = |(k, zone): (usize, &ndda_io::scene::Zone)| {
            let missing = zone.classes.iter().position(|class| !classes.cells.contains_key(class))?;
            let there: Vec<String> = classes.cells.keys().take(20).map(u32::to_string).collect();
            let problem =
                format!("{file} has no class {}: it has {}", zone.classes[missing], there.join(", "));
            Some((format!("rockfall.zones[{k}].classes[{missing}]"), problem))
        };
        match rockfall.zones.iter().enumerate().find_map(named) {
            Some(refused) => Err(refused),
            None => Ok(Some(classes)),
        }
    }

    /// The classes of a grid; the point of the map that is (0, 0) in the scene is that of `ground`.
    pub(super) fn new(grid: TerrainGrid, ground: &Ground) -> Result<Self, String> {
        let zero_m = match ground {
            Ground::File { origin_m, .. } => *origin_m,
            Ground::Heights { .. } => [0.0; 2],
        };
        let (origin_m, step_m) = ([0, 1].map(|axis| grid.origin_m[axis] - zero_m[axis]), grid.step_m);
        let mut cells = BTreeMap::new();
        let mut rows = Vec::with_capacity(grid.heights_m.len());
        for (j, row) in grid.heights_m.into_iter().enumerate() {
            let mut classes = Vec::with_capacity(row.len());
            for (i, value) in row.into_iter().enumerate() {
                let class = value.map(|value| class(value, grid.origin_m, step_m, [i, j])).transpose()?;
                class.into_iter().for_each(|class| *cells.entry(class).or_insert(0) += 1);
                classes.push(class);
            }
            rows.push(classes);
        }
        if cells.is_empty() {
            return Err("no cell has a class: every one is NODATA".into());
        }
        Ok(Self { origin_m, step_m, rows, cells })
    }

    /// The class of the cell that a place is in; none outside of the grid.
    pub fn at(&self, at_m: [f64; 2]) -> Option<u32> {
        let [i, j] =
            [0, 1].map(|axis| ((at_m[axis] - self.origin_m[axis]) / self.step_m[axis] + 0.5).floor());
        if !(i >= 0.0 && j >= 0.0) {
            return None;
        }
        *self.rows.get(j as usize)?.get(i as usize)?
    }

    /// Classes that no zone names, and how many cells have them.
    pub fn without_zone(&self, rockfall: &Rockfall) -> Vec<(u32, usize)> {
        let has_zone = |class: &u32| rockfall.zones.iter().any(|zone| zone.classes.contains(class));
        self.cells
            .iter()
            .filter(|(class, _)| !has_zone(class))
            .map(|(class, cells)| (*class, *cells))
            .collect()
    }
}

/// A number as a class.
fn class(value: f64, origin_m: [f64; 2], step_m: [f64; 2], cell: [usize; 2]) -> Result<u32, String> {
    let is_class = value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value);
    let [x, y] = [0, 1].map(|axis| origin_m[axis] + cell[axis] as f64 * step_m[axis]);
    is_class.then_some(value as u32).ok_or_else(|| {
        format!("the cell at ({x}, {y}) has {value}, which is no class: write whole numbers from 0, and NODATA where there is none")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: Vec<Vec<Option<f64>>>, zero_m: [f64; 2]) -> Result<Classes, String> {
        let grid = TerrainGrid { origin_m: [105.0, 205.0], step_m: [10.0, 20.0], heights_m: rows };
        Classes::new(grid, &Ground::File { file: "a.asc".into(), origin_m: zero_m, sample_m: None })
    }

    #[test]
    fn a_place_has_the_class_of_the_cell_around_it() {
        let classes = of(vec![vec![Some(1.0), Some(2.0)], vec![Some(7.0), None]], [100.0, 200.0]).unwrap();
        // Cells of 10 × 20 m around (5, 5), (15, 5), (5, 25) and (15, 25).
        for (at, class) in [
            ([0.1, -4.9], Some(1)),
            ([9.9, 14.9], Some(1)),
            ([10.1, 0.0], Some(2)),
            ([4.0, 15.1], Some(7)),
            ([15.0, 25.0], None),
            ([-0.1, 5.0], None),
            ([20.1, 5.0], None),
            ([5.0, 35.1], None),
        ] {
            assert_eq!(classes.at(at), class, "{at:?}");
        }
    }

    #[test]
    fn what_is_no_class_is_refused_with_its_place() {
        let error = of(vec![vec![Some(1.0), Some(2.5)], vec![None, None]], [0.0; 2]).unwrap_err();
        assert!(error.contains("(115, 205) has 2.5"), "{error}");
        assert!(of(vec![vec![Some(-3.0); 2]; 2], [0.0; 2]).is_err());
        assert!(of(vec![vec![None; 2]; 2], [0.0; 2]).unwrap_err().contains("NODATA"));
    }
}
