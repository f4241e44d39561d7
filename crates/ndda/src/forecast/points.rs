//! Points of forces that are outside of their blocks.

use ndda_io::scene::{Scene, matches};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockSet, Vec3};

use crate::build::forces::shares_at;

/// Distance from the point to the node that takes the force, over the size of its block, from which on it is a doubt.
const FAR: f64 = 0.05;

/// Forces on points outside of their blocks, which act on a node far from there.
pub fn findings(scene: &Scene, blocks: &BlockSet) -> Vec<String> {
    let mut found = Vec::new();
    for (i, force) in scene.forces.iter().enumerate() {
        let Some(at_m) = force.at_m else { continue };
        let at = Vec3::from(at_m) - blocks.origin_m;
        let named = || blocks.ids().filter(|block| matches(&force.block, &blocks.names[block.index()]));
        if named().any(|block| shares_at(blocks, block, &at).is_some()) {
            continue;
        }
        let nearest = named().map(|block| {
            let nodes = &blocks.rest_position[blocks.nodes_of(block)];
            let extent = Aabb::around(nodes);
            let distance_m = nodes.iter().map(|x| (x - at).norm()).fold(f64::INFINITY, f64::min);
            (distance_m, (extent.max - extent.min).norm(), block)
        });
        let Some((distance_m, size_m, block)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        if distance_m > FAR * size_m {
            found.push(format!(
                "forces[{i}] acts {distance_m:.3} m away from its at_m, which is outside of block `{}`, on its nearest node: give a point of the block; without at_m \
                 it acts through the mass centre",
                blocks.names[block.index()]
            ));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use crate::Model;

    #[test]
    fn a_force_on_a_point_outside_of_its_block_is_told_and_one_on_a_face_is_not() {
        let found = |at: &str| {
            let text = format!(
                "(title: \"pushed\", time: (step_s: 1e-4, end_s: 1e-3),
                materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
                blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
                forces: [(block: \"a\", {at}force_n: (1, 0, 0))])"
            );
            let model = Model::from_text(&text).unwrap();
            super::findings(&model.loaded.scene, model.simulation.blocks())
        };
        assert_eq!(found("at_m: (0, 0, 0), "), Vec::<String>::new());
        assert_eq!(found(""), Vec::<String>::new());
        assert_eq!(found("at_m: (0, 0.5, 0.2), "), Vec::<String>::new());
        let told = found("at_m: (-0.1, 0.5, 0.2), ");
        assert!(told.len() == 1 && told[0].starts_with("forces[0] acts 0.548 m away"), "{told:?}");
    }
}
