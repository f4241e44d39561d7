//! The speed below which blocks hardly move.

use ndda_mesh::geometry::reach_below;
use ndda_mesh::{BlockId, BlockSet, TriangleId};

use crate::bodies::kind::BodyKind;
use crate::step::Simulation;

/// Blocks hardly move below this part of the speed √(g h).
const HARDLY: f64 = 0.01;
/// Nodes times triangles of a block above which its width is not looked for.
const MANY_FACES: usize = 1_000_000;

impl Simulation {
    /// 0.01 √(g h): the speed of a fall through 1/20 000 of h, the lowest height of tetrahedra of elastic blocks or the smallest width of others that
    /// move; zero without gravity or contact [m/s].
    pub(super) fn slow_m_s(&self) -> f64 {
        let mut seen = vec![false; self.problem.shapes.len()];
        let mut height_m = f64::INFINITY;
        for (block, body) in self.problem.blocks.ids().zip(&self.bodies) {
            let shape = &self.problem.shapes[body.shape];
            if std::mem::replace(&mut seen[body.shape], true) || shape.kind == BodyKind::Fixed {
                continue;
            }
            let is_whole = matches!(shape.kind, BodyKind::Rigid | BodyKind::Affine);
            let width_m = is_whole.then(|| convex_width_m(&self.problem.blocks, block)).flatten();
            height_m = height_m.min(width_m.unwrap_or(shape.smallest_height_m));
        }
        let slow = self.contact.is_some() && height_m.is_finite();
        if slow { HARDLY * (self.problem.gravity_m_s2.norm() * height_m).sqrt() } else { 0.0 }
    }
}

/// How far a convex block reaches below a face, where that is least [m]; none for a concave one, and for one with so many faces that this would take long.
fn convex_width_m(blocks: &BlockSet, block: BlockId) -> Option<f64> {
    let (nodes, triangles) = (&blocks.rest_position[blocks.nodes_of(block)], blocks.triangles_of(block));
    if nodes.len() * triangles.len() > MANY_FACES {
        return None;
    }
    let mut width_m = f64::INFINITY;
    for triangle in triangles {
        let [a, b, c] = blocks.triangle_corners(TriangleId(triangle as u32), &blocks.rest_position);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let reach_m = reach_below(&normal, &a, nodes);
        // Corners that are drawn far from the origin of the scene are off by their last digit.
        let digits_m = 16.0 * f64::EPSILON * blocks.origin_m.amax();
        if reach_below(&-normal, &a, nodes) > 1e-9 * reach_m + digits_m {
            return None;
        }
        width_m = width_m.min(reach_m);
    }
    Some(width_m)
}
