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
    /// The holes of a grid with a number of cells along x and y, where `has` tells whether a cell has heights at all corners; none if it has no holes.
    pub fn of([nx, ny]: [usize; 2], has: impl Fn(usize, usize) -> bool) -> Option<Self> {
        let lacks = |i: usize, j: usize| !has(i, j);
        let at_border = |i: usize, j: usize| i == 0 || j == 0 || i + 1 == nx || j + 1 == ny;
        let all = (0..nx * ny).map(|cell| [cell % nx, cell / nx]);
        // Cells without heights that are connected to the border of the grid are outside of the terrain, and no holes.
        let border = all.clone().filter(|&[i, j]| at_border(i, j) && lacks(i, j));
        let is_outside = connected([nx, ny], border, lacks);
        let mut holes = all.zip(is_outside).filter(|&([i, j], outside)| lacks(i, j) && !outside);
        let (first, _) = holes.next()?;
        Some(Self { count: 1 + holes.count(), first })
    }
}

/// Which cells of a grid, row by row, are connected edge by edge with one of some cells, through cells that pass.
pub fn connected(
    [nx, ny]: [usize; 2],
    with: impl IntoIterator<Item = [usize; 2]>,
    passes: impl Fn(usize, usize) -> bool,
) -> Vec<bool> {
    let (mut is_found, mut open) = (vec![false; nx * ny], Vec::new());
    let mut take = |[i, j]: [usize; 2], open: &mut Vec<[usize; 2]>| {
        if !std::mem::replace(&mut is_found[j * nx + i], true) {
            open.push([i, j]);
        }
    };
    with.into_iter().for_each(|cell| take(cell, &mut open));
    while let Some([i, j]) = open.pop() {
        let beside = [[i.wrapping_sub(1), j], [i + 1, j], [i, j.wrapping_sub(1)], [i, j + 1]];
        let inside = beside.into_iter().filter(|&[i, j]| i < nx && j < ny && passes(i, j));
        inside.for_each(|cell| take(cell, &mut open));
    }
    is_found
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
