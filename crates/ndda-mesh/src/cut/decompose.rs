//! A closed surface into convex parts: a tree of cuts along the planes of its faces (Fuchs, Kedem & Naylor 1980).

use std::collections::BTreeSet;
use std::f64::consts::PI;

use super::CutError;
use super::neighbours::neighbours;
use super::plane::Plane;
use super::polyhedron::{Face, Polyhedron};
use super::split::{Split, Tolerance, split};
use super::surfaces::Surface;
use crate::Vec3;
use crate::geometry::Aabb;

/// How many faces are looked at for the next cut.
const CANDIDATES: usize = 24;
/// Parts and surface must agree in volume to this fraction.
const SAME_VOLUME: f64 = 1e-6;
/// Faces of two parts are the same if they differ by less than this fraction of their area from what they share.
pub(super) const SAME_AREA: f64 = 1e-9;
/// Most convex parts of a domain.
const MOST_PARTS: usize = 10_000;
/// Rounds after which parts are left as they are, should rounding keep them from meeting face to face.
pub(super) const MOST_ROUNDS: usize = 20;

/// Triangles, later convex polygons, of the surface, with its index.
type Polygon = (u32, Vec<Vec3>);

/// Convex parts of the solid under the closed surface of `triangles`.
pub(super) fn convex_parts(
    triangles: Vec<Polygon>,
    surfaces: &[Surface],
    bounds: &Aabb,
    tolerance: Tolerance,
) -> Result<Vec<Polyhedron>, CutError> {
    let surface_m3 = triangles.iter().map(|(_, t)| signed_volume(t, &bounds.min)).sum::<f64>();
    let mut parts = Vec::new();
    let mut stack = vec![(Polyhedron::around(bounds), triangles.clone())];
    while let Some((cell, polygons)) = stack.pop() {
        if parts.len() + stack.len() > MOST_PARTS {
            return Err(CutError::TooManyParts { most: MOST_PARTS });
        }
        if polygons.is_empty() {
            // No face of the box survives in a closed surface.
            if cell.is_within_surfaces() && winding(&triangles, &cell.volume_and_centroid().1) > 0.5 {
                parts.push(cell);
            }
            continue;
        }
        let surface = best_cut(&polygons, surfaces, tolerance.least_depth_m);
        let plane = &surfaces[surface as usize].plane;
        let (mut above, mut below) = (Vec::new(), Vec::new());
        // Polygons on the surface itself are finished, despite rounding: the list gets shorter each time.
        for polygon in polygons.into_iter().filter(|polygon| polygon.0 != surface) {
            divide(polygon, plane, tolerance.least_depth_m, &mut above, &mut below);
        }
        match split(&cell, plane, surface, tolerance) {
            Split::Both { above: upper, below: lower } => {
                stack.push((upper, above));
                stack.push((lower, below));
            }
            Split::Above | Split::Below | Split::Refused => {
                above.append(&mut below);
                stack.push((cell, above));
            }
        }
    }
    let parts_m3: f64 = parts.iter().map(Polyhedron::volume_m3).sum();
    if (parts_m3 - surface_m3).abs() <= SAME_VOLUME * surface_m3 {
        face_to_face(parts, surfaces, tolerance)
    } else {
        Err(CutError::Inconsistent { surface_m3, parts_m3 })
    }
}

/// Cuts parts until two that meet share a whole face: each is cut by the planes beside the face of the other.
fn face_to_face(
    mut parts: Vec<Polyhedron>,
    surfaces: &[Surface],
    tolerance: Tolerance,
) -> Result<Vec<Polyhedron>, CutError> {
    for _ in 0..MOST_ROUNDS {
        let mut cutting_planes: BTreeSet<(u32, u32)> = BTreeSet::new();
        for pair in neighbours(&parts, surfaces, tolerance.least_depth_m) {
            for (own, other) in [(0, 1), (1, 0)] {
                let part = &parts[pair.blocks[own] as usize];
                let area = part.area_vector(&part.faces[pair.faces[own] as usize]).norm();
                if area > (1.0 + SAME_AREA) * pair.area_m2 {
                    let beside = beside(&parts[pair.blocks[other] as usize], pair.faces[other]);
                    cutting_planes.extend(beside.map(|surface| (pair.blocks[own], surface)));
                }
            }
        }
        let mut changed = false;
        let mut cut: Vec<Polyhedron> = Vec::new();
        for (index, part) in (0..).zip(parts) {
            let mut pieces = vec![part];
            for &(_, surface) in cutting_planes.range((index, 0)..=(index, u32::MAX)) {
                let plane = &surfaces[surface as usize].plane;
                for piece in std::mem::take(&mut pieces) {
                    if let Split::Both { above, below } = split(&piece, plane, surface, tolerance) {
                        changed = true;
                        pieces.extend([above, below]);
                    } else {
                        pieces.push(piece);
                    }
                }
            }
            cut.extend(pieces);
        }
        parts = cut;
        if parts.len() > MOST_PARTS {
            return Err(CutError::TooManyParts { most: MOST_PARTS });
        }
        if !changed {
            break;
        }
    }
    Ok(parts)
}

/// Surfaces of the faces that share an edge with a face.
pub(super) fn beside(part: &Polyhedron, face: u32) -> impl Iterator<Item = u32> + '_ {
    let ring = &part.faces[face as usize].vertices;
    let shares_an_edge =
        |other: &&Face| other.vertices.iter().filter(|vertex| ring.contains(vertex)).count() == 2;
    part.faces.iter().filter(shares_an_edge).map(|other| other.surface)
}

/// The surface whose plane divides the fewest polygons; of those, the one that has most on its lower side.
fn best_cut(polygons: &[Polygon], surfaces: &[Surface], tolerance_m: f64) -> u32 {
    let step = polygons.len().div_ceil(CANDIDATES);
    let score = |surface: u32| {
        let plane = &surfaces[surface as usize].plane;
        let mut crossed = 0;
        let mut above = 0;
        for (_, ring) in polygons {
            let heights = || ring.iter().map(|x| plane.height_m(x));
            let (up, down) = (heights().any(|h| h > tolerance_m), heights().any(|h| h < -tolerance_m));
            crossed += usize::from(up && down);
            above += usize::from(up && !down);
        }
        (crossed, above, surface)
    };
    let candidates = polygons.iter().step_by(step).map(|polygon| score(polygon.0));
    candidates.min().map_or(polygons[0].0, |best| best.2)
}

/// Puts a polygon, or its parts, on the sides of a plane; polygons in the plane are done with.
fn divide(
    (surface, ring): Polygon,
    plane: &Plane,
    band_m: f64,
    above: &mut Vec<Polygon>,
    below: &mut Vec<Polygon>,
) {
    let heights: Vec<f64> = ring.iter().map(|x| plane.height_m(x)).collect();
    let (mut up, mut down) = (Vec::new(), Vec::new());
    for (i, x) in ring.iter().enumerate() {
        let j = (i + 1) % ring.len();
        let (h, next) = (heights[i], heights[j]);
        if h >= -band_m {
            up.push(*x);
        }
        if h <= band_m {
            down.push(*x);
        }
        if h.abs() > band_m && next.abs() > band_m && h * next < 0.0 {
            let point = x + (ring[j] - x) * (h / (h - next));
            up.push(point);
            down.push(point);
        }
    }
    if heights.iter().any(|&h| h > band_m) && up.len() >= 3 {
        above.push((surface, up));
    }
    if heights.iter().any(|&h| h < -band_m) && down.len() >= 3 {
        below.push((surface, down));
    }
}

/// Volume between a point and a triangle [m³].
fn signed_volume(triangle: &[Vec3], from: &Vec3) -> f64 {
    let [a, b, c] = [0, 1, 2].map(|i| triangle[i] - from);
    a.dot(&b.cross(&c)) / 6.0
}

/// Winding number of the surface about a point: solid angles (van Oosterom & Strackee 1983) over 4π.
fn winding(triangles: &[Polygon], point: &Vec3) -> f64 {
    let solid_angle = |triangle: &[Vec3]| {
        let [a, b, c] = [0, 1, 2].map(|i| triangle[i] - point);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        2.0 * a.dot(&b.cross(&c)).atan2(below)
    };
    triangles.iter().map(|(_, triangle)| solid_angle(triangle)).sum::<f64>() / (4.0 * PI)
}

/// Area vector of a polygon in space.
pub(super) fn area_vector(ring: &[Vec3]) -> Vec3 {
    let first = ring[0];
    let sum = ring.windows(2).map(|w| (w[0] - first).cross(&(w[1] - first))).sum::<Vec3>();
    sum * 0.5
}

/// Triangles of a flat polygon, ears first; `None` if it is not simple.
pub(super) fn triangulate(ring: &[Vec3], normal: &Vec3) -> Option<Vec<[Vec3; 3]>> {
    let turn = |a: &Vec3, b: &Vec3, c: &Vec3| normal.dot(&(b - a).cross(&(c - a)));
    let mut left: Vec<Vec3> = ring.to_vec();
    let mut triangles = Vec::with_capacity(ring.len());
    while left.len() > 3 {
        let n = left.len();
        let corners = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        let is_ear = |&i: &usize| {
            let [a, b, c] = corners(i);
            let holds = |x: &Vec3| turn(&a, &b, x) >= 0.0 && turn(&b, &c, x) >= 0.0 && turn(&c, &a, x) >= 0.0;
            let others = (0..n).filter(|&j| j != i && j != (i + 1) % n && j != (i + n - 1) % n);
            turn(&a, &b, &c) > 0.0 && others.map(|j| left[j]).all(|x| !holds(&x))
        };
        // Corners on a straight side have no ear of their own and go with the others.
        let ear = (0..n).find(is_ear)?;
        triangles.push(corners(ear));
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    Some(triangles)
}
