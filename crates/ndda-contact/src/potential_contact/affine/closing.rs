//! How fast two blocks that do not touch approach each other.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, Vec3};

use crate::affine::convex_target::ConvexBlocks;
use crate::model::ContactInput;

/// Upper bound of the speed at which two blocks close the gap between them within a step [m/s], by the face of either that lies
/// between them and where it is smallest: zero if the gap stays open. `None` if no face keeps them apart.
///
/// With n the unit normal of a face of block a, beyond which all of b lies, the gap is min n·x over the nodes of b less max n·x over
/// those of a, and closes at most at max n·v over the nodes of a less min n·v over those of b.
pub(crate) fn closing_m_s(
    hulls: &ConvexBlocks,
    input: &ContactInput,
    (a, b): (BlockId, BlockId),
) -> Option<f64> {
    let mut slowest: Option<f64> = None;
    for (own, other) in [(a, b), (b, a)] {
        let faces = hulls.faces_of(own);
        let [own, other] = [own, other].map(|block| input.blocks.nodes_of(block));
        for face in faces {
            let corners = face.corners.map(|node| input.position[node.index()]);
            let normal = triangle_area_vector(&corners).normalize();
            let largest = |of: &[Vec3]| of.iter().map(|x| normal.dot(x)).fold(f64::NEG_INFINITY, f64::max);
            let least = |of: &[Vec3]| of.iter().map(|x| normal.dot(x)).fold(f64::INFINITY, f64::min);
            let gap_m = least(&input.position[other.clone()]) - largest(&input.position[own.clone()]);
            if gap_m < 0.0 {
                continue;
            }
            let speed_m_s = largest(&input.velocity[own.clone()]) - least(&input.velocity[other.clone()]);
            let closing_m_s = if speed_m_s * input.dt_s < gap_m { 0.0 } else { speed_m_s.max(0.0) };
            slowest = Some(slowest.map_or(closing_m_s, |known| known.min(closing_m_s)));
        }
    }
    slowest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::affine::surface::BlockFaces;
    use crate::testing::{test_box, test_set};

    #[test]
    fn it_is_the_speed_along_the_normal_of_the_face_between_them() {
        let cubes = |x: f64| {
            test_set(vec![
                test_box([0.0; 3], [1.0; 3], [2, 2, 2]),
                test_box([x, 0.1, 0.2], [1.0; 3], [2, 2, 2]),
            ])
        };
        let closing = |x: f64, v: Vec3| {
            let blocks = cubes(x);
            let mut hulls = ConvexBlocks::default();
            hulls.fit(&blocks, &BlockFaces::of_all(&blocks), None, &[], true);
            let mut velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
            velocity[blocks.nodes_of(BlockId(1))].fill(v);
            let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1.0);
            closing_m_s(&hulls, &input, (BlockId(0), BlockId(1)))
        };
        assert_eq!(closing(1.1, Vec3::new(-0.5, 7.0, -9.0)), Some(0.5));
        assert_eq!(closing(1.6, Vec3::new(-0.5, 7.0, -9.0)), Some(0.0));
        assert_eq!(closing(1.1, Vec3::new(3.0, 7.0, -9.0)), Some(0.0));
        assert_eq!(closing(0.9, Vec3::new(-0.5, 7.0, -9.0)), None);
    }
}
