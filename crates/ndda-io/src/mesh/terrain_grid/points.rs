//! Heights as points (x, y, z) of a regular grid, a line each, in any order; a first line may name the columns.

mod header;

use super::{MOST_HEIGHTS, POINT, TerrainGrid, decimal_comma};
use crate::mesh::error::{Fault, FileProblem};
use crate::mesh::lines::{Line, Lines};
use header::Columns;

/// How far a point may be from its place in the grid, in steps of that.
const OFF: f64 = 0.01;
/// Distance of coordinates over their extent, below which they are the same.
const SAME: f64 = 1e-7;
/// Places of a grid per point, above which points are on none.
const MOST_SPARSE: u64 = 64;

/// Reads points of a regular grid.
pub(super) fn read(bytes: &[u8]) -> Result<TerrainGrid, Fault> {
    let (columns, names) = Columns::of(bytes)?.unzip();
    let mut points: Vec<(usize, [f64; 3])> = Vec::new();
    for line in Lines::new(bytes, b'#').filter(|line| Some(line.number) != names) {
        points.push((line.number, point(&line, columns.as_ref())?));
    }
    if points.len() < 4 {
        return Err(Fault::truncated(format!("point {} of at least 4", points.len() + 1)));
    }
    let axes = [axis(&points, 0), axis(&points, 1)];
    let [Some((x0, dx, nx)), Some((y0, dy, ny))] = axes else {
        let what = "points on one line".to_string();
        return Err(FileProblem::NotRead {
            what,
            cure: "give points of a grid with at least two rows and columns",
        }
        .into());
    };
    let places = nx.saturating_mul(ny);
    if places > MOST_HEIGHTS || places > MOST_SPARSE * points.len() as u64 {
        let what = format!("{} points that would need a grid of {nx} × {ny}", points.len());
        return Err(FileProblem::NotRead {
            what,
            cure: "they are not on a regular grid: resample them, as with gdal_grid",
        }
        .into());
    }
    let mut heights_m = vec![vec![None; nx as usize]; ny as usize];
    for (number, [x, y, z]) in points {
        let [u, v] = [(x - x0) / dx, (y - y0) / dy];
        if (u - u.round()).abs() > OFF || (v - v.round()).abs() > OFF {
            let (dx, dy) = (dx as f32, dy as f32);
            let what = format!("a point ({x}, {y}) beside the grid of {dx} × {dy} m from ({x0}, {y0})");
            let problem = FileProblem::NotRead {
                what,
                cure: "give points of a regular grid: resample them, as with gdal_grid",
            };
            return Err(Fault::at(number, problem));
        }
        let height = &mut heights_m[v.round() as usize][u.round() as usize];
        if height.replace(z).is_some_and(|known| known != z) {
            let what = format!("a second height at ({x}, {y})");
            return Err(Fault::at(number, FileProblem::NotRead { what, cure: "keep only one of them" }));
        }
    }
    Ok(TerrainGrid { origin_m: [x0, y0], step_m: [dx, dy], heights_m })
}

/// The point in a line.
fn point(line: &Line, columns: Option<&Columns>) -> Result<[f64; 3], Fault> {
    // As Lines have it, but that semicolons separate numbers, too.
    let text: Vec<u8> = line.text.iter().map(|&b| if b == b';' { b' ' } else { b }).collect();
    // Three words and more need no commas between them.
    let words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
    if let Some(word) = decimal_comma(&text).filter(|_| words >= 3) {
        return Err(Fault::unexpected(line.number, POINT, word));
    }
    match columns {
        Some(columns) => columns.point(line),
        None => Ok(Line { number: line.number, text: &text }.point()?.into()),
    }
}

/// First coordinate along an axis, the least distance of two, and how many places that makes; none if all are the same.
fn axis(points: &[(usize, [f64; 3])], axis: usize) -> Option<(f64, f64, u64)> {
    let mut along: Vec<f64> = points.iter().map(|(_, point)| point[axis]).collect();
    along.sort_by(f64::total_cmp);
    let (first, last) = (along[0], along[along.len() - 1]);
    let same = SAME * (last - first);
    let gaps = along.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > same);
    let least = gaps.fold(f64::INFINITY, f64::min);
    // Of many steps the mean has more digits than one of them.
    let count = ((last - first) / least).round();
    (least.is_finite() && last > first).then(|| (first, (last - first) / count, count as u64 + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn error(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().of(Path::new("a.xyz")).to_string()
    }

    #[test]
    fn points_in_any_order_with_gaps_make_a_grid() {
        let text = "x;y;z\n12;20;3\n10;20;1\n11;20;2\n10;25;4\n12;25;6\n";
        let grid = read(text.as_bytes()).unwrap();
        assert_eq!((grid.origin_m, grid.step_m), ([10.0, 20.0], [1.0, 5.0]));
        assert_eq!(grid.heights_m, [vec![Some(1.0), Some(2.0), Some(3.0)], vec![Some(4.0), None, Some(6.0)]]);
        for separator in [",", ", "] {
            assert_eq!(read(text.replace(';', separator).as_bytes()).unwrap(), grid);
        }
    }

    #[test]
    fn columns_are_found_by_their_names() {
        let rows =
            [[12.0, 20.0, 3.0], [10.0, 20.0, 1.0], [11.0, 20.0, 2.0], [10.0, 25.0, 4.0], [12.0, 25.0, 6.0]];
        let table = |names: &str, row: &dyn Fn([f64; 3]) -> String| {
            let lines: String = rows.iter().map(|point| row(*point) + "\n").collect();
            read(format!("{names}\n{lines}").as_bytes())
        };
        let plain = table("x y z", &|[x, y, z]| format!("{x} {y} {z}")).unwrap();
        assert_eq!((plain.origin_m, plain.step_m), ([10.0, 20.0], [1.0, 5.0]));
        let swapped = table("north,east,height", &|[x, y, z]| format!("{y},{x},{z}"));
        assert_eq!(swapped.unwrap(), plain);
        let comment = table("# a slope\n# columns: Y X Z", &|[x, y, z]| format!("{y} {x} {z}"));
        assert_eq!(comment.unwrap(), plain);
        let quoted = table("\"id\";\"Z [m]\";\"N_m\";\"E_m\"", &|[x, y, z]| format!(";{z};{y};{x}"));
        assert_eq!(quoted.unwrap(), plain);
        // Comments that name no columns are none, and lines without names have x, y, z first.
        assert_eq!(table("# heights of the slope", &|[x, y, z]| format!("{x} {y} {z} 7")).unwrap(), plain);
    }

    #[test]
    fn points_beside_a_grid_are_refused_with_line_and_cure() {
        for (text, part) in [
            ("0 0 1\n1 0 1\n0 1 1\n1.4 1 1\n2.4 1 1", "a.xyz:2: a point (1, 0) beside the grid of 0.4 × 1 m"),
            ("0 0 1\n1 0 1\n0 1 1\n0 1 2", "a.xyz:4: a second height at (0, 1)"),
            ("0 0 1\n1 0 1\n2 0 1\n3 0 1", "at least two rows"),
            ("0 0 1\n1 0 1\n0 1 x\n", "a.xyz:3: expected a coordinate"),
            ("0 0 1\n1e-3 5e5 1\n1e6 1 1\n7 3.3 1", "gdal_grid"),
            ("0 0 1\n", "point 2 of at least 4"),
            (
                "0 0 1\n1 0 1,5",
                "a.xyz:2: expected a number whose decimals come after a point, as 2.5, found `1,5`",
            ),
            ("y x dsm\n0 0 1", "a.xyz:1: a table of points whose columns are `y`, `x`, `dsm`"),
            ("x y z\n1 0 0 1", "a.xyz:2: expected as many columns as the first line names, 3, found `4`"),
            ("a 0 1\n1 0 0", "a.xyz:1: expected a coordinate, finite, found `a`"),
            (
                "x;y;z\n0,5;0;1",
                "a.xyz:2: expected a number whose decimals come after a point, as 2.5, found `0,5`",
            ),
        ] {
            let message = error(text);
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
