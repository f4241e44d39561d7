//! Cells without heights that a terrain encloses.

use super::TerrainGrid;

/// Cells of a grid with no height at some corner, which others with heights enclose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Holes {
    /// How many cells.
    pub count: usize,
    /// The first of them, along x and y.
    pub first: [usize; 2],
}

impl Holes {
    /// Those of a grid of so many cells along x and y, of which some have heights at all corners; none where there are none.
    pub fn of([nx, ny]: [usize; 2], has: impl Fn(usize, usize) -> bool) -> Option<Self> {
        let mut is_land: Vec<bool> = (0..nx * ny).map(|cell| has(cell % nx, cell / nx)).collect();
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
        let count = is_land.iter().filter(|land| !**land).count();
        Some(Self { count, first: [first % nx, first / nx] })
    }
}

impl TerrainGrid {
    /// Cells without heights that the terrain encloses, and the middle (x, y) of the first [m].
    pub fn holes(&self) -> Option<(Holes, [f64; 2])> {
        let rows = &self.heights_m;
        let cells = [rows.first().map_or(0, Vec::len), rows.len()].map(|count| count.saturating_sub(1));
        let has =
            |i: usize, j: usize| rows[j..j + 2].iter().all(|row| row[i..i + 2].iter().all(Option::is_some));
        let holes = Holes::of(cells, has)?;
        let middle = |axis: usize| self.origin_m[axis] + (holes.first[axis] as f64 + 0.5) * self.step_m[axis];
        Some((holes, [middle(0), middle(1)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_without_heights_count_as_holes_where_land_encloses_them() {
        let holes = |gaps: &[(usize, usize)]| {
            let mut heights_m = vec![vec![Some(0.0); 6]; 5];
            gaps.iter().for_each(|&(i, j)| heights_m[j][i] = None);
            TerrainGrid { origin_m: [10.0, 20.0], step_m: [2.0, 2.0], heights_m }.holes()
        };
        assert_eq!(holes(&[]), None);
        assert_eq!(holes(&[(1, 1), (2, 2)]), None);
        assert_eq!(holes(&[(3, 2)]), Some((Holes { count: 4, first: [2, 1] }, [15.0, 23.0])));
    }
}
