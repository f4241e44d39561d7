//! Cells without heights that the terrain encloses.

use ndda_io::mesh::terrain_grid::Holes;

use super::terrain::Terrain;
use crate::forecast::gaps;

impl Terrain {
    /// Warning of cells without heights that the terrain encloses; none where there are none.
    pub(super) fn holes(&self) -> Option<String> {
        let holes = Holes::of(self.cells(), |i, j| self.has(i, j))?;
        let middle = self.map_m(holes.first.map(|i| i as f64 + 0.5));
        Some(gaps::told(&holes, middle, "boulders that get there count as having left the terrain"))
    }
}

#[cfg(test)]
mod tests {
    use ndda_io::mesh::terrain_grid::TerrainGrid;

    use super::*;

    #[test]
    fn a_hole_is_said_with_its_place() {
        let mut heights_m = vec![vec![Some(0.0); 6]; 5];
        heights_m[2][3] = None;
        let grid = TerrainGrid { origin_m: [10.0, 20.0], step_m: [2.0, 2.0], heights_m };
        let said = Terrain::of_grid(&grid, &[], None).unwrap().holes().unwrap();
        assert!(said.starts_with("4 cells within the terrain have no height"), "{said}");
        assert!(said.contains("the first at (15.0, 23.0) m"), "{said}");
    }
}
