//! Volumes of overlaps, and how deep they are, from the pieces of both surfaces.

use ndda_mesh::geometry::{tet_heights, triangle_area_vector};
use ndda_mesh::{TetId, Vec3};

use crate::integration::integrals::Integrals;
use crate::model::ContactInput;

/// A convex overlap is nowhere deeper along a direction than so many times its volume over its area across it: it holds a cone of that depth.
const CONE: f64 = 3.0;

/// What the pieces of a pair of blocks add up to.
#[derive(Clone, Copy, Debug)]
struct Overlap {
    /// Where heights count from [m].
    origin: Vec3,
    /// Vector area of the pieces of the first block, less that of the other [m²]: its direction is that in which the first faces the other.
    facing: Vec3,
    /// How far along it the facets of the first block reach [m], and from where those of the other do.
    reach: [f64; 2],
    /// Smallest height of a tetrahedron that is touched [m].
    height_m: f64,
    /// Depth [m].
    depth_m: f64,
}

impl Default for Overlap {
    fn default() -> Self {
        let (origin, facing) = (Vec3::zeros(), Vec3::zeros());
        Self {
            origin,
            facing,
            reach: [f64::NEG_INFINITY, f64::INFINITY],
            height_m: f64::INFINITY,
            depth_m: 0.0,
        }
    }
}

/// Memory for the volumes of a step.
#[derive(Default)]
pub(super) struct OverlapVolumes {
    overlaps: Vec<Overlap>,
    /// Centre [m] and vector area [m²] of each piece.
    pieces: Vec<(Vec3, Vec3)>,
    /// Smallest height of each tetrahedron at rest [m].
    tet_height_m: Vec<f64>,
}

impl OverlapVolumes {
    /// Volumes V = ∮ e·(x − o) e·n dS over the pieces of both surfaces, e being the direction in which the first block faces
    /// the other, and the depths along it. Walls along e do not count: blocks that share one exactly have no pieces on it.
    pub(super) fn measure(
        &mut self,
        input: &ContactInput,
        integrals: &Integrals,
        pair_of_touch: &[u32],
        volume_m3: &mut [f64],
    ) {
        self.place_heights(input);
        let Self { overlaps, pieces, tet_height_m } = self;
        overlaps.clear();
        overlaps.resize(volume_m3.len(), Overlap::default());
        pieces.clear();
        let touching = || integrals.touching().iter().zip(pair_of_touch);
        for (touch, &k) in touching() {
            let corners = input.blocks.triangle_corners(touch.triangle, input.position);
            let sums = integrals.sums_of(touch);
            let (center, area) =
                (sums.center(&corners), sums.area * triangle_area_vector(&corners).normalize());
            let overlap = &mut overlaps[k as usize];
            overlap.origin = center;
            overlap.facing += if touch.owner < touch.target { area } else { -area };
            pieces.push((center, area));
        }
        for ((touch, &k), (center, area)) in touching().zip(&*pieces) {
            let overlap = &mut overlaps[k as usize];
            // The pieces of a block that is wholly inside the other face all ways: any direction will do.
            let along = overlap.facing.try_normalize(0.0).unwrap_or_else(Vec3::z);
            volume_m3[k as usize] += (center - overlap.origin).dot(&along) * area.dot(&along);
            let corners = input.blocks.triangle_corners(touch.triangle, input.position);
            let heights = corners.map(|x| (x - overlap.origin).dot(&along));
            let [first, second] = &mut overlap.reach;
            if touch.owner < touch.target {
                *first = heights.into_iter().fold(*first, f64::max);
            } else {
                *second = heights.into_iter().fold(*second, f64::min);
            }
            for hit in integrals.overlaps_of(touch) {
                overlap.height_m = overlap.height_m.min(tet_height_m[hit.tet.index()]);
            }
        }
        for (overlap, &volume_m3) in overlaps.iter_mut().zip(&*volume_m3) {
            let across_m2 = 0.5 * overlap.facing.norm();
            let cone_m = if across_m2 > 0.0 { CONE * volume_m3 / across_m2 } else { f64::INFINITY };
            overlap.depth_m = cone_m.min(overlap.reach[0] - overlap.reach[1]).max(0.0);
        }
    }

    /// Largest depth over a height, and its pair.
    pub(super) fn deepest(&self) -> Option<(f64, u32)> {
        let ratios = self.overlaps.iter().map(|overlap| overlap.depth_m / overlap.height_m);
        let pairs = ratios.zip(0..).filter(|(ratio, _)| ratio.is_finite());
        pairs.reduce(|most, other| if other.0 > most.0 { other } else { most })
    }

    fn place_heights(&mut self, input: &ContactInput) {
        let blocks = input.blocks;
        if self.tet_height_m.len() == blocks.tets.len() {
            return;
        }
        let height_m = |tet: usize| {
            let heights = tet_heights(&blocks.tet_corners(TetId(tet as u32), &blocks.rest_position));
            heights.into_iter().fold(f64::INFINITY, f64::min)
        };
        self.tet_height_m = (0..blocks.tets.len()).map(height_m).collect();
    }
}

#[cfg(test)]
mod tests {
    use crate::VolumePotential;
    use crate::testing::{evaluate, test_box, test_set};
    use crate::{ContactHistory, ContactInput, PotentialContact};
    use nalgebra::Rotation3;
    use ndda_mesh::{BlockMesh, Vec3};

    /// Penetration over height of a cube with its lowest point or face in the plate below z = 0.
    fn depth_ratio(cube: BlockMesh) -> f64 {
        let plate = test_box([-3.0, -3.0, -1.0], [6.0, 6.0, 1.0], [2, 2, 1]);
        let blocks = test_set(vec![plate, cube]);
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1e-3);
        let potential = VolumePotential { exponent: 2.0, reference_m3: 1.0 };
        let mut model = PotentialContact::new(1e9).with_potential(Box::new(potential));
        evaluate(&mut model, &input, &mut ContactHistory::default()).report.max_penetration_ratio
    }

    #[test]
    fn the_penetration_is_that_of_the_deepest_point_for_faces_edges_and_corners() {
        let depth_m = 1e-3;
        let turned = |turns: &[(Vec3, f64)]| {
            let mut cube = test_box([0.0; 3], [1.0; 3], [1, 1, 1]);
            for x in &mut cube.nodes {
                for (axis, angle) in turns {
                    *x = Rotation3::new(axis * *angle) * *x;
                }
            }
            let lowest = cube.nodes.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
            cube.nodes.iter_mut().for_each(|x| x.z -= lowest + depth_m);
            cube
        };
        let quarter = std::f64::consts::FRAC_PI_4;
        let face = depth_ratio(turned(&[]));
        for (what, turns) in [
            ("edge", vec![(Vec3::x(), quarter)]),
            ("corner", vec![(Vec3::x(), quarter), (Vec3::y(), 0.5f64.sqrt().atan())]),
            ("tilted", vec![(Vec3::x(), 1e-4)]),
        ] {
            let found = depth_ratio(turned(&turns));
            assert!((found / face - 1.0).abs() < 1e-3, "{what}: {found} and {face} of a face");
        }
        // The six tetrahedra of a cube along its diagonal have heights of 1 and 1/√2 of its edge.
        assert!((face / (2f64.sqrt() * depth_m) - 1.0).abs() < 1e-9, "{face}");
    }
}
