//! Faces of a tetrahedron that is compared with many triangles.

use ndda_mesh::Vec3;
use ndda_mesh::geometry::{TET_FACES, triangle_area_vector};

/// Outward area vector of the face of a tetrahedron opposite to a corner, and a point of it.
pub(crate) fn outward_normal(corners: &[Vec3; 4], opposite: usize) -> (Vec3, Vec3) {
    let [i, j, k] = TET_FACES[opposite];
    let normal = triangle_area_vector(&[corners[i], corners[j], corners[k]]);
    // A tetrahedron may be inside out while it is looked at.
    let is_inward = normal.dot(&(corners[opposite] - corners[i])) > 0.0;
    (if is_inward { -normal } else { normal }, corners[i])
}

/// A tetrahedron and its faces, to be compared with many triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TetFaces {
    pub corners: [Vec3; 4],
    /// Outward area vector of each, the square of its length, and a point of the face.
    pub faces: [(Vec3, f64, Vec3); 4],
}

impl TetFaces {
    /// Finds the faces of a tetrahedron from its corners [m].
    pub(crate) fn new(corners: [Vec3; 4]) -> Self {
        let faces = std::array::from_fn(|face| {
            let (outward, from) = outward_normal(&corners, face);
            (outward, outward.norm_squared(), from)
        });
        Self { corners, faces }
    }
}
