//! The ground in a picture of a map: shaded from the north-west, with contours.

use std::fmt::Write as _;

use super::axes::{Axes, marks};
use crate::picture::short;
use crate::picture::svg::{Anchor, Rgb, Svg, hex};
use crate::rockfall::terrain::Terrain;

/// Most cells on a side of the shaded picture.
const MOST_CELLS: usize = 260;
/// Levels of brightness.
const LEVELS: usize = 28;
/// Contours, about.
const CONTOURS: f64 = 14.0;

/// Contours and their labels.
pub(super) const CONTOUR: Rgb = [107, 98, 89];
/// Parts of the diagonal within which a contour has its label: those in a corner have none.
const NEAR_DIAGONAL: f64 = 0.25;

/// Draws the ground.
pub(super) fn draw(svg: &mut Svg, axes: &Axes, terrain: &Terrain) {
    let [nx, ny] = terrain.cells();
    // Every k-th height, so that the picture stays small.
    let stride = nx.max(ny).div_ceil(MOST_CELLS).max(1);
    let across = |n: usize| (0..n).step_by(stride).map(|i| (i, (i + stride).min(n))).collect::<Vec<_>>();
    let (columns, rows) = (across(nx), across(ny));
    let mut paths = vec![String::new(); LEVELS];
    for &(j, above) in &rows {
        for &(i, right) in &columns {
            let Some(level) = level(terrain, [i, right], [j, above]) else { continue };
            let [x, y] = axes.place(terrain.map_m([i as f64, above as f64]));
            let [to_x, to_y] = axes.place(terrain.map_m([right as f64, j as f64]));
            let _ = write!(paths[level], "M{x:.1} {y:.1}H{to_x:.1}V{to_y:.1}H{x:.1}Z");
        }
    }
    for (level, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        let colour = hex(grey(level as f64 / (LEVELS - 1) as f64));
        svg.raw(&format!("<path d=\"{path}\" fill=\"{colour}\" shape-rendering=\"crispEdges\"/>"));
    }
    contours(svg, axes, terrain, stride);
}

/// Level of brightness of a cell between heights: the cosine of the angle to light from the north-west, 45° high.
fn level(terrain: &Terrain, [i, right]: [usize; 2], [j, above]: [usize; 2]) -> Option<usize> {
    let corners = [(i, j), (right, j), (i, above), (right, above)].map(|(i, j)| terrain.node_m(i, j));
    if corners.iter().any(|z| !z.is_finite()) {
        return None;
    }
    let [a, b, c, d] = corners;
    let dx = 0.5 * (b - a + d - c) / ((right - i) as f64 * terrain.step_m[0]);
    let dy = 0.5 * (c - a + d - b) / ((above - j) as f64 * terrain.step_m[1]);
    // n = (−dx, −dy, 1), light = (−½, ½, √½).
    let cosine = (0.5 * dx - 0.5 * dy + 0.5f64.sqrt()) / (dx * dx + dy * dy + 1.0).sqrt();
    Some((cosine.clamp(0.0, 1.0) * (LEVELS - 1) as f64).round() as usize)
}

/// Distance of a place from the diagonal of the picture, from below at the left to above at the right, in parts of its sides; infinite at the frame.
fn from_diagonal(axes: &Axes, at: [f64; 2]) -> f64 {
    let [u, v] = [0, 1].map(|i| (at[i] - axes.at[i]) / axes.size[i]);
    let has_room = [u, v].iter().all(|part| (0.02..0.98).contains(part));
    if has_room { (u + v - 1.0).abs() } else { f64::INFINITY }
}

/// Brightness of ground between the darkest, 0, and the lightest, 1.
pub(super) fn grey(part: f64) -> Rgb {
    let grey = 158.0 + 94.0 * part;
    [grey, 0.995 * grey, 0.98 * grey].map(|c| c.round() as u8)
}

/// Lines of equal height, through the triangles of the shaded picture.
fn contours(svg: &mut Svg, axes: &Axes, terrain: &Terrain, stride: usize) {
    let (low, high) = terrain.heights_m();
    let heights = marks([low, high], CONTOURS);
    let mut path = String::new();
    // Of each contour, the place nearest to a diagonal of the map, along which labels stand apart.
    let mut labels = vec![(f64::INFINITY, [0.0; 2]); heights.len()];
    let [nx, ny] = terrain.cells();
    for j in (0..ny).step_by(stride) {
        for i in (0..nx).step_by(stride) {
            let (right, above) = ((i + stride).min(nx), (j + stride).min(ny));
            for triangle in [[(i, j), (right, j), (right, above)], [(i, j), (right, above), (i, above)]] {
                let corners = triangle.map(|(i, j)| terrain.corner_m(i, j));
                for (height, label) in heights.iter().zip(&mut labels) {
                    let mut ends = Vec::new();
                    for k in 0..3 {
                        let (a, b) = (corners[k], corners[(k + 1) % 3]);
                        if (a.z < *height) != (b.z < *height) {
                            let part = (height - a.z) / (b.z - a.z);
                            let at = a + part * (b - a);
                            ends.push(axes.place([at.x, at.y]));
                        }
                    }
                    if let [[ax, ay], [bx, by]] = ends[..] {
                        let _ = write!(path, "M{ax:.1} {ay:.1}L{bx:.1} {by:.1}");
                        let middle = [0.5 * (ax + bx), 0.5 * (ay + by)];
                        let off = from_diagonal(axes, middle);
                        if off < label.0 {
                            *label = (off, middle);
                        }
                    }
                }
            }
        }
    }
    svg.raw(&format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-opacity=\"0.45\" stroke-width=\"0.7\"/>",
        hex(CONTOUR)
    ));
    for (height, (off, at)) in heights.iter().zip(labels) {
        if off < NEAR_DIAGONAL {
            svg.words(at, 10.0, Anchor::Middle, CONTOUR, 60.0, &short(*height));
        }
    }
}
