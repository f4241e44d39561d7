//! Cells without heights that the terrain encloses.

use super::terrain::Terrain;
use crate::numbers::counted;

impl Terrain {
    /// Warning of cells without heights that the terrain encloses; none where there are none.
    pub(super) fn holes(&self) -> Option<String> {
        let [nx, ny] = self.cells();
        let mut is_land: Vec<bool> = (0..nx * ny).map(|cell| self.has(cell % nx, cell / nx)).collect();
        let is_at_border = |cell: usize| {
            let (i, j) = (cell % nx, cell / nx);
            i == 0 || j == 0 || i + 1 == nx || j + 1 == ny
        };
        // Cells without heights that are connected to the border of the grid are outside of the terrain, and no holes.
        let mut outside: Vec<usize> =
            (0..nx * ny).filter(|&cell| is_at_border(cell) && !is_land[cell]).collect();
        outside.iter().for_each(|&cell| is_land[cell] = true);
        while let Some(cell) = outside.pop() {
            let (i, j) = (cell % nx, cell / nx);
            let beside = [(i.wrapping_sub(1), j), (i + 1, j), (i, j.wrapping_sub(1)), (i, j + 1)];
            for (i, j) in beside.into_iter().filter(|&(i, j)| i < nx && j < ny) {
                if !std::mem::replace(&mut is_land[j * nx + i], true) {
                    outside.push(j * nx + i);
                }
            }
        }
        let first = is_land.iter().position(|land| !land)?;
        let [x, y] = self.map_m([(first % nx) as f64 + 0.5, (first / nx) as f64 + 0.5]);
        let count = is_land.iter().filter(|land| !**land).count();
        let holes = counted(count, "cell within the terrain has", "cells within the terrain have");
        Some(format!(
            "{holes} no height at some corner, the first at ({x:.1}, {y:.1}) m: boulders that get there count as having left the terrain"
        ))
    }
}

#[cfg(test)]
mod tests {
    use ndda_io::mesh::terrain_grid::TerrainGrid;

    use super::*;

    #[test]
    fn cells_without_heights_count_as_holes_where_land_encloses_them() {
        let holes = |gaps: &[(usize, usize)]| {
            let mut heights_m = vec![vec![Some(0.0); 6]; 5];
            gaps.iter().for_each(|&(i, j)| heights_m[j][i] = None);
            let grid = TerrainGrid { origin_m: [10.0, 20.0], step_m: [2.0, 2.0], heights_m };
            Terrain::of_grid(&grid, &[], None).unwrap().holes()
        };
        assert_eq!(holes(&[]), None);
        assert_eq!(holes(&[(1, 1), (2, 2)]), None);
        let said = holes(&[(3, 2)]).unwrap();
        assert!(said.starts_with("4 cells within the terrain have no height"), "{said}");
        assert!(said.contains("the first at (15.0, 23.0) m"), "{said}");
    }
}
