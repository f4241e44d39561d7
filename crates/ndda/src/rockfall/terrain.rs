//! The ground as heights on a grid: two triangles in each cell, split from its south-western to its north-eastern corner.

use std::path::Path;

use ndda_io::mesh::terrain_grid::TerrainGrid;
use ndda_io::scene::{Ground, Zone};
use ndda_mesh::Vec3;

use super::classes::Classes;
use crate::numbers::counted;

/// Heights that are less far apart are none of ground [m].
const LEAST_STEP_M: f64 = 1e-3;
/// Coordinates beyond this are none of a map in metres [m].
const MOST_M: f64 = 1e9;
/// Steepest ground: heights of neighbours that differ by more times their distance stand for something else.
const STEEPEST: f64 = 500.0;
/// Part of the size of the terrain, and of its coordinates, that rounding stays below.
const ROUNDING: f64 = 1e-9;
/// No height of ground is as large [m].
const MOST_HEIGHT_M: f64 = 1.2e4;

/// Heights on a grid, and the zone of each triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    /// Place (x, y) of the south-western height [m].
    pub origin_m: [f64; 2],
    /// Point (x, y) of the file's map that is (0, 0) in the scene [m].
    pub zero_m: [f64; 2],
    /// Distance of heights along x and y [m].
    pub step_m: [f64; 2],
    /// Heights along x and along y.
    pub size: [usize; 2],
    /// Heights, row by row from the south; not a number where there is none [m].
    heights_m: Vec<f64>,
    /// Zone of both triangles of each cell: 0 is ground outside of all, else one more than its place in the list.
    zones: Vec<[u16; 2]>,
}

impl Terrain {
    /// Reads or takes the heights of a scene, and finds the zone of each triangle.
    ///
    /// # Errors
    /// What is wrong with the file, or that no cell has a height at all four corners.
    pub fn new(
        ground: &Ground,
        folder: &Path,
        (zones, classes): (&[Zone], Option<&Classes>),
    ) -> Result<Self, String> {
        let grid = match ground {
            Ground::File { file, origin_m, sample_m } => {
                let read = TerrainGrid::read(&folder.join(file), *sample_m);
                let mut grid = read.map_err(|error| error.to_string())?;
                grid.origin_m = [0, 1].map(|i| grid.origin_m[i] - origin_m[i]);
                let terrain = Self::of_grid(&grid, zones, classes);
                return terrain
                    .map(|terrain| Self { zero_m: *origin_m, ..terrain })
                    .map_err(|problem| format!("{file}: {problem}"));
            }
            Ground::Heights { origin_m, step_m, heights_m } => {
                let some = |row: &Vec<f64>| row.iter().copied().map(Some).collect();
                let heights_m = heights_m.iter().map(some).collect();
                TerrainGrid { origin_m: *origin_m, step_m: *step_m, heights_m }
            }
        };
        Self::of_grid(&grid, zones, classes)
    }

    pub(super) fn of_grid(
        grid: &TerrainGrid,
        zones: &[Zone],
        classes: Option<&Classes>,
    ) -> Result<Self, String> {
        sound(grid)?;
        let size = [grid.heights_m.first().map_or(0, Vec::len), grid.heights_m.len()];
        let heights_m = grid.heights_m.iter().flatten().map(|z| z.unwrap_or(f64::NAN)).collect();
        let TerrainGrid { origin_m, step_m, .. } = *grid;
        let mut terrain = Self { origin_m, zero_m: [0.0; 2], step_m, size, heights_m, zones: Vec::new() };
        let cells = terrain.cells();
        if !(0..cells[1]).any(|j| (0..cells[0]).any(|i| terrain.has(i, j))) {
            return Err(
                "no cell of the grid has a height at all four corners: give a grid with fewer gaps".into()
            );
        }
        let held;
        (terrain.zones, held) = terrain.zones_of(zones, classes);
        match held.iter().position(|held| !held) {
            Some(empty) => Err(terrain.holds_nothing(&zones[empty])),
            None => Ok(terrain),
        }
    }

    /// Cells along x and y.
    pub fn cells(&self) -> [usize; 2] {
        self.size.map(|n| n.saturating_sub(1))
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        let [nx, ny] = self.cells();
        2 * (0..ny).map(|j| (0..nx).filter(|&i| self.has(i, j)).count()).sum::<usize>()
    }

    /// A height of the grid; not a number where there is none [m].
    pub fn node_m(&self, i: usize, j: usize) -> f64 {
        self.heights_m[j * self.size[0] + i]
    }

    /// A corner of the grid [m].
    pub fn corner_m(&self, i: usize, j: usize) -> Vec3 {
        let [x, y] = self.map_m([i as f64, j as f64]);
        Vec3::new(x, y, self.node_m(i, j))
    }

    /// Whether a cell has heights at all four corners.
    pub fn has(&self, i: usize, j: usize) -> bool {
        let [nx, ny] = self.cells();
        i < nx
            && j < ny
            && [(0, 0), (1, 0), (0, 1), (1, 1)].iter().all(|(a, b)| self.node_m(i + a, j + b).is_finite())
    }

    /// Zones of the triangle south-east of the diagonal of a cell, and of that north-west of it.
    pub fn zones_at(&self, i: usize, j: usize) -> [u16; 2] {
        self.zones[j * self.cells()[0] + i]
    }

    /// Middles on the map of both triangles of a cell, in the same order [m].
    pub(super) fn middles_m(&self, i: usize, j: usize) -> [[f64; 2]; 2] {
        let (i, j) = (i as f64, j as f64);
        [[2.0 / 3.0, 1.0 / 3.0], [1.0 / 3.0, 2.0 / 3.0]].map(|[u, v]| self.map_m([i + u, j + v]))
    }

    /// The part that has neither a class nor a zone, in words; none where all of it has.
    pub(super) fn bare_of(&self, classes: &Classes) -> Option<String> {
        let [nx, ny] = self.cells();
        let (mut bare, mut least, mut most) = (0usize, [f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (i, j) in (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j))).filter(|&(i, j)| self.has(i, j)) {
            for (zone, middle) in self.zones_at(i, j).into_iter().zip(self.middles_m(i, j)) {
                if zone == 0 && classes.at(middle).is_none() {
                    bare += 1;
                    least = [0, 1].map(|axis| least[axis].min(middle[axis]));
                    most = [0, 1].map(|axis| most[axis].max(middle[axis]));
                }
            }
        }
        let percent = 100.0 * bare as f64 / self.triangles() as f64;
        (bare > 0).then(|| {
            format!(
                "class_grid has no class for {percent:.2} % of the terrain, {} between ({:.1}, {:.1}) and ({:.1}, {:.1}) m, where it has `ground`",
                counted(bare, "triangle", "triangles"),
                least[0], least[1], most[0], most[1]
            )
        })
    }

    /// Place on the map [m] of a place in steps of the grid.
    pub fn map_m(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [self.origin_m[0] + u * self.step_m[0], self.origin_m[1] + v * self.step_m[1]]
    }

    /// The cell that a place on the map is in, and where in it, from 0 to 1; none outside of the grid.
    pub fn cell_at(&self, at_m: [f64; 2]) -> Option<([usize; 2], [f64; 2])> {
        let mut cell = [0; 2];
        let mut part = [0.0; 2];
        for axis in 0..2 {
            let steps = (at_m[axis] - self.origin_m[axis]) / self.step_m[axis];
            let last = self.cells()[axis];
            if !(0.0..=last as f64).contains(&steps) {
                return None;
            }
            cell[axis] = (steps.floor() as usize).min(last - 1);
            part[axis] = steps - cell[axis] as f64;
        }
        Some((cell, part))
    }

    /// Height of the ground, and its slope along x and y; none outside and where a cell has no heights.
    pub fn at(&self, at_m: [f64; 2]) -> Option<(f64, [f64; 2])> {
        let ([i, j], [u, v]) = self.cell_at(at_m)?;
        if !self.has(i, j) {
            return None;
        }
        let (a, d) = (self.node_m(i, j), self.node_m(i + 1, j + 1));
        let (along_x, along_y) = match v <= u {
            true => {
                let b = self.node_m(i + 1, j);
                (b - a, d - b)
            }
            false => {
                let c = self.node_m(i, j + 1);
                (d - c, c - a)
            }
        };
        Some((a + u * along_x + v * along_y, [along_x / self.step_m[0], along_y / self.step_m[1]]))
    }

    /// Least and largest place on the map [m].
    pub fn bounds_m(&self) -> [[f64; 2]; 2] {
        [self.origin_m, self.map_m(self.cells().map(|n| n as f64))]
    }

    /// Distance on the map below which places are the same but for rounding [m].
    pub(super) fn rounding_m(&self) -> f64 {
        let [least, most] = self.bounds_m();
        let largest = |axis: usize| (most[axis] - least[axis]) + least[axis].abs().max(most[axis].abs());
        ROUNDING * largest(0).max(largest(1))
    }

    /// Least and largest height [m].
    pub fn heights_m(&self) -> (f64, f64) {
        let known = self.heights_m.iter().filter(|z| z.is_finite());
        known.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), z| (a.min(*z), b.max(*z)))
    }

    /// For both triangles of each cell, the last zone whose outline its middle is in, or of whose class its cell is; and whether each zone has some triangle.
    fn zones_of(&self, zones: &[Zone], classes: Option<&Classes>) -> (Vec<[u16; 2]>, Vec<bool>) {
        let [nx, ny] = self.cells();
        let (mut found, mut held) = (vec![[0; 2]; nx * ny], vec![false; zones.len()]);
        if zones.is_empty() {
            return (found, held);
        }
        for (k, zones_of_cell) in found.iter_mut().enumerate() {
            for (half, middle) in self.middles_m(k % nx, k / nx).into_iter().enumerate() {
                let class = classes.and_then(|classes| classes.at(middle));
                let holds = |zone: &Zone| match class {
                    _ if !zone.outline_m.is_empty() => is_inside(&zone.outline_m, middle),
                    Some(class) => zone.classes.contains(&class),
                    None => false,
                };
                for (place, _) in zones.iter().enumerate().filter(|(_, zone)| holds(zone)) {
                    zones_of_cell[half] = place as u16 + 1;
                    held[place] = true;
                }
            }
        }
        (found, held)
    }

    /// That a zone is not on the terrain.
    fn holds_nothing(&self, zone: &Zone) -> String {
        let [west, south] = self.origin_m;
        let [east, north] = self.map_m(self.size.map(|count| count.saturating_sub(1) as f64));
        format!(
            "zone `{}` is nowhere on the terrain, which reaches from ({west}, {south}) to ({east}, {north}) m: check its outline, or the coordinates of class_grid and origin_m",
            zone.name
        )
    }
}

/// Refuses places and heights that no ground has, as a number in the place of a missing height is.
fn sound(grid: &TerrainGrid) -> Result<(), String> {
    let TerrainGrid { origin_m, step_m, heights_m } = grid;
    if let Some(step_m) = step_m.iter().find(|step_m| !(LEAST_STEP_M..MOST_M).contains(*step_m)) {
        return Err(format!("heights are {step_m:e} m apart: give a grid in metres"));
    }
    let counts = [heights_m.first().map_or(0, Vec::len), heights_m.len()];
    let far = (0..2).flat_map(|i| [origin_m[i], origin_m[i] + step_m[i] * counts[i] as f64]);
    if let Some(far_m) = far.into_iter().find(|x| !(-MOST_M..MOST_M).contains(x)) {
        return Err(format!(
            "the grid reaches {far_m:e} m on the map: give coordinates in metres, and origin_m for the point that is (0, 0)"
        ));
    }
    let place = |i: usize, j: usize| [origin_m[0] + i as f64 * step_m[0], origin_m[1] + j as f64 * step_m[1]];
    let height = |i: usize, j: usize| *heights_m.get(j)?.get(i)?;
    for (j, row) in heights_m.iter().enumerate() {
        let is_wrong = |z: &Option<f64>| z.is_some_and(|z| !(-MOST_HEIGHT_M..MOST_HEIGHT_M).contains(&z));
        if let Some((i, z)) = row.iter().position(is_wrong).and_then(|i| Some((i, row[i]?))) {
            let [x, y] = place(i, j);
            return Err(format!(
                "the height at ({x}, {y}) is {z:e} m, and no ground is: if it stands for a missing one, say so in the file (NODATA_value), else write metres"
            ));
        }
        let is_steep = |&i: &usize| {
            let jumps = |other: Option<f64>, step_m: f64| {
                row[i].zip(other).is_some_and(|(a, b)| (a - b).abs() > STEEPEST * step_m)
            };
            jumps(height(i + 1, j), step_m[0])
                || jumps(j.checked_sub(1).and_then(|below| height(i, below)), step_m[1])
        };
        if let Some(i) = (0..row.len()).find(is_steep) {
            let [x, y] = place(i, j);
            return Err(format!(
                "heights beside ({x}, {y}) differ by more than {STEEPEST} times their distance, and no ground is so steep: if one stands for a missing height, say so in the file (NODATA_value)"
            ));
        }
    }
    Ok(())
}

/// Whether a point is within an outline: an odd number of its edges is crossed on the way to the east.
pub(super) fn is_inside(outline_m: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    let mut last = outline_m.len() - 1;
    for (k, &[xk, yk]) in outline_m.iter().enumerate() {
        let [xl, yl] = outline_m[last];
        if (yk > y) != (yl > y) && x < xk + (y - yk) / (yl - yk) * (xl - xk) {
            inside = !inside;
        }
        last = k;
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_io::scene::Scatter;

    fn terrain(zones: &[Zone]) -> Terrain {
        let heights_m = vec![vec![0.0, 1.0, 3.0], vec![2.0, 5.0, 4.0]];
        let ground = Ground::Heights { origin_m: [10.0, 20.0], step_m: [2.0, 4.0], heights_m };
        Terrain::new(&ground, Path::new("."), (zones, None)).expect("a grid")
    }

    #[test]
    fn heights_are_linear_in_both_triangles_of_a_cell() {
        let terrain = terrain(&[]);
        assert_eq!(terrain.triangles(), 4);
        for (at, z, slope) in [
            ([10.0, 20.0], 0.0, [0.5, 1.0]),
            ([14.0, 24.0], 4.0, [1.0, 0.25]),
            // South-east of the diagonal of the first cell: 0 + ½ · 1 + ¼ · 4.
            ([11.0, 21.0], 1.5, [0.5, 1.0]),
            // North-west of it: 0 + ¼ · 3 + ½ · 2.
            ([10.5, 22.0], 1.75, [1.5, 0.5]),
        ] {
            assert_eq!(terrain.at(at), Some((z, slope)), "{at:?}");
        }
        assert_eq!(terrain.at([9.9, 21.0]), None);
        assert_eq!(terrain.at([11.0, 24.1]), None);
    }

    #[test]
    fn a_triangle_is_in_the_last_zone_that_its_middle_is_in() {
        let zone = |name: &str, outline_m: Vec<[f64; 2]>| Zone {
            name: name.into(),
            outline_m,
            classes: Vec::new(),
            restitution: Scatter::Always(0.5),
            friction_deg: Scatter::Always(30.0),
        };
        let all = vec![[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]];
        let west = vec![[0.0, 0.0], [12.0, 0.0], [12.0, 100.0], [0.0, 100.0]];
        let terrain = terrain(&[zone("all", all), zone("west", west)]);
        assert_eq!((terrain.zones_at(0, 0), terrain.zones_at(1, 0)), ([2, 2], [1, 1]));
    }

    #[test]
    fn a_triangle_is_in_the_zone_of_the_class_of_the_cell_that_its_middle_is_in() {
        let ground =
            Ground::Heights { origin_m: [10.0, 20.0], step_m: [2.0, 4.0], heights_m: vec![vec![0.0; 3]; 2] };
        // Cells of a metre, of class 1 west of x = 11, 2 up to 12, 7 up to 13, and none beyond.
        let rows = vec![vec![Some(1.0), Some(2.0), Some(7.0)]; 6];
        let grid = TerrainGrid { origin_m: [10.5, 19.5], step_m: [1.0; 2], heights_m: rows };
        let classes = Classes::new(grid, &ground).unwrap();
        let zone = |name: &str, classes: &[u32]| Zone {
            name: name.into(),
            outline_m: Vec::new(),
            classes: classes.to_vec(),
            restitution: Scatter::Always(0.5),
            friction_deg: Scatter::Always(30.0),
        };
        let zones = [zone("scree", &[2, 3]), zone("rock", &[1])];
        let terrain = Terrain::new(&ground, Path::new("."), (&zones, Some(&classes))).unwrap();
        // Middles at 10 + 4/3 and 10 + 2/3, and at 12 + 4/3 and 12 + 2/3.
        assert_eq!((terrain.zones_at(0, 0), terrain.zones_at(1, 0)), ([1, 2], [0, 0]));
        // One of four triangles is beyond the grid of classes; the other without a zone has a class that none names.
        let bare = terrain.bare_of(&classes).unwrap_or_default();
        assert!(bare.contains("25.00 % of the terrain, 1 triangle between (13.3, 21.3) and"), "{bare}");
    }

    #[test]
    fn heights_and_coordinates_that_no_ground_has_are_refused_with_their_place() {
        let refused = |origin: f64, step: f64, height: f64| {
            let heights_m = vec![vec![0.0, 1.0], vec![height, 2.0]];
            let ground = Ground::Heights { origin_m: [origin, 0.0], step_m: [step; 2], heights_m };
            Terrain::new(&ground, Path::new("."), (&[], None)).err().unwrap_or_default()
        };
        assert_eq!(refused(1e7, 1.0, -99.0), "");
        assert!(refused(0.0, 1.0, -9998.0).contains("no ground is so steep"));
        assert!(refused(0.0, 2.0, -3.4028235e38).contains("at (0, 2) is -3.4028235e38 m"));
        assert!(refused(1e18, 2.0, 0.0).contains("origin_m"));
        assert!(
            refused(0.0, 1e-9, 0.0).contains("apart") && refused(0.0, f64::INFINITY, 0.0).contains("apart")
        );
    }
}
