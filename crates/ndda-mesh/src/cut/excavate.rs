//! Spaces drawn in rock that is cut already: their borders cut the blocks that they meet, and no others.

use super::blocks::Blocks;
use super::domain::Domain;
use super::plane::Plane;
use super::polyhedron::Polyhedron;
use super::split::{Split, Tolerance, split};
use super::surfaces::{Surface, SurfaceKind, index_of};
use crate::Vec3;

impl Domain {
    /// Whether a point is inside.
    pub fn holds(&self, at: &Vec3) -> bool {
        self.parts.iter().any(|part| planes(part).all(|plane| plane.height_m(at) <= 0.0))
    }
}

/// Outward planes of a convex part.
fn planes(part: &Polyhedron) -> impl Iterator<Item = Plane> + '_ {
    part.faces.iter().filter_map(|face| {
        let corner = part.vertices[face.vertices[0] as usize];
        Plane::new(corner, part.area_vector(face)).ok()
    })
}

impl Blocks {
    /// Cuts blocks along the border of a space; faces of these cuts have its name. Blocks that it does not reach into stay whole, and so do those
    /// wholly inside. Returns how many blocks were cut.
    ///
    /// `domain` is what the rock was cut from, and `sliver_width_m` what counts as a sliver.
    pub fn excavate(
        &mut self,
        domain: &Domain,
        (name, space): (&str, &Domain),
        sliver_width_m: f64,
    ) -> usize {
        let tolerance = domain.tolerance();
        let name = index_of(&mut self.names, name);
        let (mut cut, border) = (0, self.surfaces.len() as u32);
        for part in &space.parts {
            // A joint's number that none of the cut has.
            let joint = u32::MAX - self.surfaces.len() as u32;
            let first = self.surfaces.len() as u32;
            let kind = |number| SurfaceKind::Joint { joint, number };
            let surfaces = (0..).zip(planes(part)).map(|(i, plane)| Surface { plane, kind: kind(i), name });
            self.surfaces.extend(surfaces);
            let mut blocks = Vec::with_capacity(self.blocks.len());
            for block in std::mem::take(&mut self.blocks) {
                match carved(&block, &self.surfaces, first, tolerance) {
                    Some(pieces) => {
                        cut += 1;
                        blocks.extend(pieces);
                    }
                    None => blocks.push(block),
                }
            }
            self.blocks = blocks;
        }
        self.report.cuts += cut;
        self.finish(tolerance, sliver_width_m);
        cut + self.part_around((space, border), tolerance, sliver_width_m)
    }
}

/// The pieces of a block outside of the planes from `first` on and the one inside of all; none where it is not cut, or cannot be.
fn carved(
    block: &Polyhedron,
    surfaces: &[Surface],
    first: u32,
    tolerance: Tolerance,
) -> Option<Vec<Polyhedron>> {
    let (mut inside, mut pieces) = (block.clone(), Vec::new());
    for (surface, number) in surfaces[first as usize..].iter().zip(first..) {
        match split(&inside, &surface.plane, number, tolerance) {
            // It does not reach into the space.
            Split::Above | Split::Refused => return None,
            Split::Below => {}
            Split::Both { above, below } => {
                pieces.push(above);
                inside = below;
            }
        }
    }
    if pieces.is_empty() {
        return None;
    }
    pieces.push(inside);
    Some(pieces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::{Axis, CutOptions, cut_blocks};

    #[test]
    fn an_angled_drift_takes_its_volume_out_of_the_blocks_that_it_meets() {
        let rock = Domain::cuboid(Vec3::zeros(), Vec3::new(6.0, 3.0, 4.0)).unwrap();
        let joints = [crate::cut::Discontinuity::Plane {
            name: "joint".into(),
            plane: Plane::dipping(60.0, 90.0, Vec3::new(3.0, 0.0, 2.0)).unwrap(),
        }];
        let mut blocks = cut_blocks(&rock, &joints, &CutOptions::default()).unwrap();
        // An L of 2 × 2 less 1 × 1, 2 long.
        let outline = [[2.0, 1.0], [4.0, 1.0], [4.0, 2.0], [3.0, 2.0], [3.0, 3.0], [2.0, 3.0]];
        let space = Domain::extruded(&outline, Axis::Y, 0.0, 2.0).unwrap();
        assert!(blocks.excavate(&rock, ("drift", &space), 0.0) >= 2);
        let (mut inside_m3, mut all_m3) = (0.0, 0.0);
        for block in &blocks.blocks {
            let (volume_m3, centroid) = block.volume_and_centroid();
            all_m3 += volume_m3;
            inside_m3 += if space.holds(&centroid) { volume_m3 } else { 0.0 };
            assert_eq!(block.euler(), Some(2));
        }
        assert!((inside_m3 - 6.0).abs() < 1e-12, "{inside_m3}");
        assert!((all_m3 - 72.0).abs() < 1e-11, "{all_m3}");
        // Cuts that were drawn have the name; those of the joint keep theirs.
        let named =
            |name: &str| blocks.neighbours.iter().filter(|n| blocks.surface_name(n.surface) == name).count();
        assert!(named("drift") > 5 && named("joint") > 1);
        assert!(blocks.neighbours.iter().all(|n| !n.glued));
    }

    #[test]
    fn blocks_that_a_space_does_not_reach_stay_whole() {
        let rock = Domain::cuboid(Vec3::zeros(), Vec3::new(2.0, 1.0, 1.0)).unwrap();
        let mut blocks = cut_blocks(&rock, &[], &CutOptions::default()).unwrap();
        let beside = Domain::cuboid(Vec3::new(2.0, 0.0, 0.0), Vec3::new(3.0, 1.0, 1.0)).unwrap();
        assert_eq!(blocks.excavate(&rock, ("beside", &beside), 0.0), 0);
        assert_eq!(blocks.blocks.len(), 1);
    }
}
