//! The rock of a scene before it is cut.

use std::path::Path;

use ndda_io::mesh::terrain_grid::TerrainGrid;
use ndda_io::scene;
use ndda_mesh::Vec3;
use ndda_mesh::cut::Domain;

use super::axis;
use crate::build::{solid, vec3};
use crate::forecast::gaps;

/// A domain, and a warning of heights that are missing within its terrain.
pub(super) fn domain(domain: &scene::Domain, folder: &Path) -> Result<(Domain, Option<String>), String> {
    let whole = match domain {
        scene::Domain::Box { min_m, max_m } => {
            Domain::cuboid(vec3(*min_m), vec3(*max_m)).map_err(|e| e.to_string())
        }
        scene::Domain::Column { outline_m, axis: along, start_m, end_m } => {
            Domain::extruded(outline_m, axis(*along), *start_m, *end_m).map_err(|e| e.to_string())
        }
        scene::Domain::Polyhedron { corners_m, faces } => {
            solid::domain(&solid::of_corners(corners_m, faces), solid::EXACT)
        }
        scene::Domain::File { file, unit_m } => {
            solid::domain(&solid::of_file(&folder.join(file), *unit_m)?, solid::ROUNDED)
        }
        scene::Domain::Terrain { origin_m, step_m, heights_m, base_m } => {
            let heights_m: Vec<Vec<_>> =
                heights_m.iter().map(|row| row.iter().copied().map(Some).collect()).collect();
            terrain(&TerrainGrid { origin_m: *origin_m, step_m: *step_m, heights_m }, *base_m)
        }
        scene::Domain::TerrainFile { file, origin_m, base_m } => {
            let mut grid = TerrainGrid::read(&folder.join(file), None).map_err(|e| e.to_string())?;
            grid.origin_m = [grid.origin_m[0] - origin_m[0], grid.origin_m[1] - origin_m[1]];
            return Ok((terrain(&grid, *base_m)?, shaft(&grid)));
        }
    };
    whole.map(|domain| (domain, None))
}

/// Warning of a shaft that missing heights leave in rock, if any.
fn shaft(grid: &TerrainGrid) -> Option<String> {
    let (holes, middle) = grid.holes()?;
    Some(gaps::told(&holes, middle, "the rock has a shaft there, down to its base"))
}

/// Two triangles per cell of the grid whose four corners have heights.
fn terrain(grid: &TerrainGrid, base_m: f64) -> Result<Domain, String> {
    let TerrainGrid { origin_m, step_m, heights_m } = grid;
    let columns = heights_m.first().map_or(0, Vec::len);
    if columns < 2 || heights_m.len() < 2 || heights_m.iter().any(|row| row.len() != columns) {
        return Err("give at least two rows of heights, all of the same length of at least two".into());
    }
    let mut vertices = Vec::new();
    for (j, row) in heights_m.iter().enumerate() {
        // No triangle uses a vertex without height.
        let place = |(i, z): (usize, &Option<f64>)| {
            let [x, y] = [origin_m[0] + i as f64 * step_m[0], origin_m[1] + j as f64 * step_m[1]];
            Vec3::new(x, y, z.unwrap_or(base_m))
        };
        vertices.extend(row.iter().enumerate().map(place));
    }
    let mut triangles = Vec::new();
    for (j, rows) in heights_m.windows(2).enumerate() {
        for i in 0..columns - 1 {
            if rows.iter().any(|row| row[i].is_none() || row[i + 1].is_none()) {
                continue;
            }
            let [a, b] = [j * columns + i, (j + 1) * columns + i].map(|v| v as u32);
            triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
        }
    }
    if triangles.is_empty() {
        return Err(
            "no cell of the grid has a height at all four corners: give a grid with fewer gaps".into()
        );
    }
    Domain::terrain(&vertices, &triangles, base_m).map_err(|e| e.to_string())
}
