//! Faces that meet: both lie on one surface, from opposite sides, and overlap.

use super::polyhedron::Polyhedron;
use super::surfaces::{Neighbour, Surface, SurfaceKind};
use crate::Vec3;
use crate::planar::clipped;

/// A face in its plane: the two coordinates across the largest component of the normal.
struct Flat {
    block: u32,
    face: u32,
    /// Counter-clockwise.
    ring: Vec<[f64; 2]>,
    min: [f64; 2],
    max: [f64; 2],
}

/// All pairs of faces that overlap by more than a strip of `tolerance_m`, ordered by surface.
pub(super) fn neighbours(blocks: &[Polyhedron], surfaces: &[Surface], tolerance_m: f64) -> Vec<Neighbour> {
    let mut faces: Vec<(u32, u32, u32)> = Vec::new();
    for (b, block) in (0..).zip(blocks) {
        faces.extend((0..).zip(&block.faces).map(|(f, face)| (face.surface, b, f)));
    }
    faces.sort_unstable();
    let mut found = Vec::new();
    for run in faces.chunk_by(|a, b| a.0 == b.0) {
        let surface = &surfaces[run[0].0 as usize];
        let (mut below, mut above) = (Vec::new(), Vec::new());
        for &(_, block, face) in run {
            let polyhedron = &blocks[block as usize];
            let area = polyhedron.area_vector(&polyhedron.faces[face as usize]);
            let is_below = area.dot(surface.plane.normal()) > 0.0;
            let side = if is_below { &mut below } else { &mut above };
            side.push(flatten(polyhedron, block, face, surface.plane.normal()));
        }
        sweep(below, above, run[0].0, surface, tolerance_m, &mut found);
    }
    found
}

/// The face without the coordinate in which the normal is largest.
fn flatten(polyhedron: &Polyhedron, block: u32, face: u32, normal: &Vec3) -> Flat {
    let axis = normal.iamax();
    let points = polyhedron.ring(&polyhedron.faces[face as usize]);
    let mut ring: Vec<[f64; 2]> = points.map(|x| [x[(axis + 1) % 3], x[(axis + 2) % 3]]).collect();
    if area(&ring) < 0.0 {
        ring.reverse();
    }
    let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in &ring {
        for i in 0..2 {
            min[i] = min[i].min(point[i]);
            max[i] = max[i].max(point[i]);
        }
    }
    Flat { block, face, ring, min, max }
}

/// Sweeps along the first coordinate; a face meets only those of the other side that are open there.
fn sweep(
    mut below: Vec<Flat>,
    mut above: Vec<Flat>,
    index: u32,
    surface: &Surface,
    tolerance_m: f64,
    found: &mut Vec<Neighbour>,
) {
    let stretch = 1.0 / surface.plane.normal().amax();
    below.sort_by(|a, b| a.min[0].total_cmp(&b.min[0]));
    above.sort_by(|a, b| a.min[0].total_cmp(&b.min[0]));
    let widest = above.iter().map(|flat| flat.max[0] - flat.min[0]).fold(0.0, f64::max);
    for low in &below {
        let first = above.partition_point(|high| high.min[0] < low.min[0] - widest);
        for high in above[first..].iter().take_while(|high| high.min[0] < low.max[0]) {
            let apart = (0..2).any(|i| low.max[i] <= high.min[i] || high.max[i] <= low.min[i]);
            if apart || low.block == high.block {
                continue;
            }
            let shared = area(&clipped(low.ring.clone(), &high.ring));
            let extent = (0..2).map(|i| low.max[i].min(high.max[i]) - low.min[i].max(high.min[i]));
            if shared > tolerance_m * extent.fold(0.0, f64::max) {
                found.push(Neighbour {
                    blocks: [low.block, high.block],
                    faces: [low.face, high.face],
                    surface: index,
                    area_m2: shared * stretch,
                    glued: surface.kind == SurfaceKind::Domain,
                });
            }
        }
    }
}

/// Signed area, counter-clockwise positive, about the first corner.
fn area(ring: &[[f64; 2]]) -> f64 {
    let Some(&[x, y]) = ring.first() else { return 0.0 };
    let twice = |w: &[[f64; 2]]| (w[0][0] - x) * (w[1][1] - y) - (w[0][1] - y) * (w[1][0] - x);
    0.5 * ring.windows(2).map(twice).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shifted_squares_share_their_overlap() {
        let square = |x: f64, y: f64| vec![[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
        let shared = |subject, clip: &[[f64; 2]]| area(&clipped(subject, clip));
        assert!((shared(square(0.0, 0.0), &square(0.25, 0.5)) - 0.375).abs() < 1e-15);
        assert_eq!(shared(square(0.0, 0.0), &square(1.0, 0.0)), 0.0);
        assert_eq!(shared(square(0.0, 0.0), &square(3.0, 0.0)), 0.0);
    }
}
