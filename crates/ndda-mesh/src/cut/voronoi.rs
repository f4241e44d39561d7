//! Voronoi cells of seeds as blocks.

use super::CutError;
use super::blocks::{Blocks, CutReport};
use super::domain::Domain;
use super::plane::Plane;
use super::polyhedron::Polyhedron;
use super::random::Stream;
use super::split::{Split, Tolerance, split};
use super::surfaces::index_of;
use super::surfaces::{Surface, SurfaceKind};
use crate::Vec3;
use crate::geometry::Aabb;

/// Name of the faces between Voronoi cells.
pub const CELLS: &str = "cells";

/// Choices of a Voronoi cut.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VoronoiOptions {
    /// Blocks thinner than this are listed in the report [m]; 0 lists none.
    pub sliver_width_m: f64,
}

/// Draws for one seed in a domain that fills little of its bounding box.
const MOST_DRAWS: usize = 10_000;

/// Uniformly random seeds in the domain that keep a distance from each other where they can.
///
/// A draw nearer than `least_distance_m` to an earlier seed is drawn again, up to 30 times. Fewer seeds than asked
/// for come back when there is no room left.
pub fn random_seeds(domain: &Domain, count: usize, least_distance_m: f64, seed: u64) -> Vec<Vec3> {
    let bounds = domain.bounds();
    let mut stream = Stream::new(seed, &[count as u64]);
    let mut grid = Grid::new(&bounds, count);
    let mut seeds: Vec<Vec3> = Vec::new();
    for _ in 0..count {
        let draws =
            (0..MOST_DRAWS).map(|_| Vec3::from_fn(|i, _| stream.between(bounds.min[i], bounds.max[i])));
        for at in draws.filter(|at| domain.holds(at)).take(30) {
            if least_distance_m <= 0.0 || !grid.has_near(&seeds, &at, least_distance_m) {
                grid.add(seeds.len() as u32, &at);
                seeds.push(at);
                break;
            }
        }
    }
    seeds
}

/// Cuts a domain into the Voronoi cells of `seeds_m`; faces between cells are named `cells`.
///
/// Each cell starts as the domain and is cut by bisectors with seeds from near to far, found ring by ring in a grid,
/// until the next ring lies beyond the security radius: twice the distance of the cell's farthest vertex.
/// In a concave domain a cell is one block per convex part that it meets, glued across.
///
/// # Errors
/// [`CutError`] when there is no seed, or one is not finite or coincides with another.
pub fn voronoi_blocks(
    domain: &Domain,
    seeds_m: &[Vec3],
    options: &VoronoiOptions,
) -> Result<Blocks, CutError> {
    if seeds_m.is_empty() {
        return Err(CutError::NoSeeds);
    }
    let bounds = domain.bounds();
    let on_plane_m = domain.tolerance().on_plane_m;
    // Cells are cut one by one: what touches must be near rounding for both sides of a face to agree.
    let tolerance = Tolerance { on_plane_m, least_depth_m: on_plane_m };
    let mut grid = Grid::new(&bounds, seeds_m.len());
    for (seed, at) in (0..).zip(seeds_m) {
        let is_finite = at.iter().all(|x| x.is_finite());
        if !is_finite || grid.has_near(seeds_m, at, domain.tolerance().least_depth_m) {
            return Err(CutError::Seed { seed: seed as usize, at_m: (*at).into() });
        }
        grid.add(seed, at);
    }
    let mut tessellation = Tessellation { seeds_m, grid, tolerance, refused: 0 };
    let mut cells = Vec::new();
    for part in &domain.parts {
        for seed in 0..seeds_m.len() as u32 {
            cells.extend(tessellation.cell(part, seed).map(|cell| (seed, cell)));
        }
    }
    let refused = tessellation.refused;
    let mut blocks = named(domain, seeds_m, cells, refused)?;
    blocks.finish(domain.tolerance(), options.sliver_width_m);
    Ok(blocks)
}

/// Marks faces of a cell that are still named by the seed behind them.
const BISECTOR: u32 = 1 << 31;

/// Gives each pair of seeds that share a face one surface.
fn named(
    domain: &Domain,
    seeds_m: &[Vec3],
    mut cells: Vec<(u32, Polyhedron)>,
    refused: usize,
) -> Result<Blocks, CutError> {
    let pair = |seed: u32, surface: u32| {
        let other = surface & !BISECTOR;
        (seed.min(other), seed.max(other))
    };
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    for (seed, cell) in &cells {
        let between = cell.faces.iter().filter(|face| face.surface & BISECTOR != 0);
        pairs.extend(between.map(|face| pair(*seed, face.surface)));
    }
    pairs.sort_unstable();
    pairs.dedup();
    let first = domain.surfaces.len() as u32;
    for (seed, cell) in &mut cells {
        for face in cell.faces.iter_mut().filter(|face| face.surface & BISECTOR != 0) {
            let at = pairs.partition_point(|p| *p < pair(*seed, face.surface));
            face.surface = first + at as u32;
        }
    }
    let mut names = domain.names.clone();
    let name = index_of(&mut names, CELLS);
    let mut surfaces = domain.surfaces.clone();
    for (a, b) in pairs {
        let plane = bisector(seeds_m, a, b)?;
        surfaces.push(Surface { plane, kind: SurfaceKind::Cell, name });
    }
    let report = CutReport {
        cuts: surfaces.len() - domain.surfaces.len(),
        refused: if refused > 0 { vec![(first, refused)] } else { Vec::new() },
        domain_m3: domain.volume_m3(),
        ..CutReport::default()
    };
    let blocks = cells.into_iter().map(|cell| cell.1).collect();
    Ok(Blocks { blocks, surfaces, names, neighbours: Vec::new(), report })
}

/// The plane between two seeds; its normal points from the first to the second.
fn bisector(seeds_m: &[Vec3], a: u32, b: u32) -> Result<Plane, CutError> {
    let (a, b) = (seeds_m[a as usize], seeds_m[b as usize]);
    Plane::new((a + b) * 0.5, b - a)
}

struct Tessellation<'a> {
    seeds_m: &'a [Vec3],
    grid: Grid,
    tolerance: Tolerance,
    refused: usize,
}

impl Tessellation<'_> {
    /// The part of `part` that is nearest to a seed, if any.
    fn cell(&mut self, part: &Polyhedron, seed: u32) -> Option<Polyhedron> {
        let at = self.seeds_m[seed as usize];
        let mut cell = part.clone();
        let reach = |cell: &Polyhedron| cell.vertices.iter().map(|x| (x - at).norm()).fold(0.0, f64::max);
        let mut reach_m = reach(&cell);
        for ring in 0..=self.grid.shape.into_iter().max().unwrap_or(0) {
            if (f64::from(ring) - 1.0) * self.grid.cell_m.min() > 2.0 * reach_m {
                break;
            }
            let mut near: Vec<(f64, u32)> = Vec::new();
            self.grid.for_ring(&at, ring, |other| {
                near.push(((self.seeds_m[other as usize] - at).norm(), other));
            });
            near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            for (distance_m, other) in near {
                if other == seed || distance_m > 2.0 * reach_m {
                    continue;
                }
                let plane = bisector(self.seeds_m, seed.min(other), seed.max(other)).ok()?;
                let keeps_below = seed < other;
                match split(&cell, &plane, BISECTOR | other, self.tolerance) {
                    Split::Both { below, .. } if keeps_below => cell = below,
                    Split::Both { above, .. } => cell = above,
                    Split::Above if keeps_below => return None,
                    Split::Below if !keeps_below => return None,
                    Split::Refused => self.refused += 1,
                    _ => continue,
                }
                reach_m = reach(&cell);
            }
        }
        Some(cell)
    }
}

/// Seeds by cells of a regular grid; those outside of the box count as in its nearest cell.
struct Grid {
    min: Vec3,
    cell_m: Vec3,
    shape: [u32; 3],
    seeds: Vec<Vec<u32>>,
}

impl Grid {
    /// A grid of about one cell per seed, cells as cubic as the box allows.
    fn new(bounds: &Aabb, count: usize) -> Self {
        let size = bounds.max - bounds.min;
        let side = (size.product() / count.max(1) as f64).cbrt();
        let most = (2 * count.max(1)) as f64;
        let mut shape = [0, 1, 2].map(|i| (size[i] / side).round().clamp(1.0, most.min(1000.0)) as u32);
        while shape.iter().map(|&n| n as usize).product::<usize>() > 8 * count.max(1) {
            shape = shape.map(|n| n.div_ceil(2));
        }
        let cells = shape.iter().map(|&n| n as usize).product();
        let cell_m = Vec3::from_fn(|i, _| size[i] / f64::from(shape[i]));
        Self { min: bounds.min, cell_m, shape, seeds: vec![Vec::new(); cells] }
    }

    fn place(&self, x: &Vec3) -> [i64; 3] {
        let index = |i: usize| ((x[i] - self.min[i]) / self.cell_m[i]).floor();
        [0, 1, 2].map(|i| index(i).clamp(0.0, f64::from(self.shape[i] - 1)) as i64)
    }

    fn index(&self, [i, j, k]: [i64; 3]) -> usize {
        let [nx, ny, _] = self.shape.map(i64::from);
        (i + nx * (j + ny * k)) as usize
    }

    fn add(&mut self, seed: u32, at: &Vec3) {
        let cell = self.index(self.place(at));
        self.seeds[cell].push(seed);
    }

    /// Seeds in the cells that are `ring` cells away from that of `at`, along the axis where they are farthest.
    fn for_ring(&self, at: &Vec3, ring: u32, mut act: impl FnMut(u32)) {
        let (center, ring) = (self.place(at), i64::from(ring));
        let range = |i: usize| {
            let last = i64::from(self.shape[i]) - 1;
            (center[i] - ring).max(0)..=(center[i] + ring).min(last)
        };
        for k in range(2) {
            for j in range(1) {
                let is_shell = (k - center[2]).abs() == ring || (j - center[1]).abs() == ring;
                let ends = [center[0] - ring, center[0] + ring];
                for i in range(0) {
                    if is_shell || ends.contains(&i) {
                        self.seeds[self.index([i, j, k])].iter().for_each(|&seed| act(seed));
                    }
                }
            }
        }
    }

    fn has_near(&self, seeds_m: &[Vec3], at: &Vec3, distance_m: f64) -> bool {
        let mut found = false;
        let rings = (distance_m / self.cell_m.min()).ceil().min(1e6) as u32;
        for ring in 0..=rings.min(self.shape.into_iter().max().unwrap_or(0)) {
            self.for_ring(at, ring, |seed| found |= (seeds_m[seed as usize] - at).norm() < distance_m);
            if found {
                break;
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::domain::Axis;
    use super::*;

    fn cube() -> Domain {
        Domain::cuboid(Vec3::zeros(), Vec3::repeat(1.0)).unwrap()
    }

    #[test]
    fn seeds_on_a_lattice_make_a_lattice_of_cubes() {
        let place = |i: u32| (f64::from(i) + 0.5) / 4.0;
        let seeds: Vec<Vec3> =
            (0..64).map(|i| Vec3::new(place(i % 4), place(i / 4 % 4), place(i / 16))).collect();
        let blocks = voronoi_blocks(&cube(), &seeds, &VoronoiOptions::default()).unwrap();
        assert!(
            blocks.blocks.iter().all(|b| b.faces.len() == 6 && (b.volume_m3() * 64.0 - 1.0).abs() < 1e-13)
        );
        assert_eq!(blocks.neighbours.len(), 144);
    }

    #[test]
    fn random_cells_fill_the_cube_and_hold_what_is_nearest_to_their_seed() {
        let seeds = random_seeds(&cube(), 500, 0.05, 3);
        assert_eq!(seeds, random_seeds(&cube(), 500, 0.05, 3));
        let blocks = voronoi_blocks(&cube(), &seeds, &VoronoiOptions::default()).unwrap();
        assert!((blocks.report.volume_m3 - 1.0).abs() < 1e-12);
        for (block, seed) in blocks.blocks.iter().zip(&seeds) {
            assert_eq!(block.euler(), Some(2));
            for x in &block.vertices {
                let nearest = seeds.iter().map(|s| (s - x).norm()).fold(f64::INFINITY, f64::min);
                assert!((x - seed).norm() < nearest + 1e-12);
            }
        }
    }

    #[test]
    fn cells_of_a_concave_domain_are_glued() {
        let profile = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let domain = Domain::extruded(&profile, Axis::Y, 0.0, 1.0).unwrap();
        let seeds = random_seeds(&domain, 40, 0.0, 1);
        let blocks = voronoi_blocks(&domain, &seeds, &VoronoiOptions::default()).unwrap();
        assert!((blocks.report.volume_m3 - 3.0).abs() < 1e-12);
        let glued: f64 = blocks.neighbours.iter().filter(|n| n.glued).map(|n| n.area_m2).sum();
        assert!((glued - 2.0).abs() < 1e-9, "{glued}");
    }

    #[test]
    fn bad_seeds_are_named() {
        let cut = |seeds: &[Vec3]| voronoi_blocks(&cube(), seeds, &VoronoiOptions::default());
        assert_eq!(cut(&[]), Err(CutError::NoSeeds));
        let twin = Vec3::repeat(0.5);
        assert!(matches!(cut(&[twin, twin]), Err(CutError::Seed { seed: 1, .. })));
        assert!(matches!(cut(&[Vec3::repeat(f64::NAN)]), Err(CutError::Seed { seed: 0, .. })));
        assert_eq!(cut(&[Vec3::repeat(9.0)]).unwrap().blocks.len(), 1);
    }

    proptest! {
        #[test]
        fn coarse_seeds_with_many_equidistant_ones_fill_the_cube(
            seeds in prop::collection::btree_set(prop::array::uniform3(0..5u32), 1..40),
        ) {
            let seeds: Vec<Vec3> = seeds.iter().map(|s| Vec3::from(s.map(|c| f64::from(c) / 4.0))).collect();
            let blocks = voronoi_blocks(&cube(), &seeds, &VoronoiOptions::default()).unwrap();
            prop_assert!((blocks.report.volume_m3 - 1.0).abs() < 1e-12);
            prop_assert!(blocks.blocks.iter().all(|b| b.euler() == Some(2)));
        }
    }
}
