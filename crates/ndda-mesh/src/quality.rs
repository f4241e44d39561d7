//! How good tetrahedra are.

use crate::Vec3;
use crate::geometry::{TET_FACES, tet_volume, triangle_area_vector};

/// The six edges and the faces (opposite to which corner) that meet at each.
const EDGES: [([usize; 2], [usize; 2]); 6] = [
    ([0, 1], [2, 3]),
    ([0, 2], [1, 3]),
    ([0, 3], [1, 2]),
    ([1, 2], [0, 3]),
    ([1, 3], [0, 2]),
    ([2, 3], [0, 1]),
];

/// Smallest sine of the six dihedral angles, with the sign of the volume: sin θ = 3 V l / (2 A₁ A₂).
///
/// 0 for a flat tetrahedron, 0.943 for the regular one. NaN counts as flat.
pub fn least_sine(corners: &[Vec3; 4]) -> f64 {
    let volume = tet_volume(corners);
    let area = TET_FACES.map(|face| triangle_area_vector(&face.map(|i| corners[i])).norm());
    let mut least = f64::INFINITY;
    for ([i, j], [k, l]) in EDGES {
        least = least.min((corners[i] - corners[j]).norm() / (area[k] * area[l]));
    }
    let sine = 1.5 * volume * least;
    if sine.is_finite() { sine } else { 0.0 }
}

/// The six dihedral angles [°], in the order of edges 01, 02, 03, 12, 13, 23.
pub fn dihedral_angles_deg(corners: &[Vec3; 4]) -> [f64; 6] {
    let outward = TET_FACES.map(|face| triangle_area_vector(&face.map(|i| corners[i])));
    EDGES.map(|(_, [k, l])| {
        let (a, b) = (outward[k], outward[l]);
        a.cross(&b).norm().atan2(-a.dot(&b)).to_degrees()
    })
}
