//! Joints and spaces whose planes lie where concave rock was divided into convex parts: the parts meet there already, and nothing is left to cut.
//!
//! A plane that touches a part in one of its faces cuts nothing off. Where glued parts meet in such faces, the plane parts them nevertheless: their faces get its surface.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::blocks::Blocks;
use super::decompose::{MOST_ROUNDS, SAME_AREA, beside};
use super::discs::DiscCounts;
use super::domain::Domain;
use super::joints::CuttingPlane;
use super::plane::Plane;
use super::polyhedron::{Face, Polyhedron};
use super::random::Stream;
use super::split::{Split, Tolerance, split};
use super::surfaces::{Neighbour, Surface, SurfaceKind};

/// Planes whose normals have a smaller cosine are not looked at further.
const ALIKE: f64 = 0.999;

/// Parts glued blocks along the joints that lie in the faces in which they meet; whether there are any. Persistence and the rules of discs decide
/// once for all faces that hang together.
pub(super) fn part_along_joints(
    blocks: &mut Blocks,
    joints: &[(u32, CuttingPlane)],
    (seed, discs): (u64, &mut DiscCounts),
    tolerance: Tolerance,
) -> bool {
    let mut glued: BTreeMap<u32, Vec<Neighbour>> = BTreeMap::new();
    for neighbour in blocks.neighbours.iter().filter(|neighbour| neighbour.glued) {
        glued.entry(neighbour.surface).or_default().push(*neighbour);
    }
    let mut parted = false;
    for (number, (surface, joint)) in (0u32..).zip(joints) {
        for (&between, all) in &mut glued {
            if !are_alike(&blocks.surfaces[between as usize].plane, &joint.plane) {
                continue;
            }
            let in_plane = |pair: &Neighbour| lies_in(blocks, pair, &joint.plane, tolerance);
            let (found, others): (Vec<Neighbour>, Vec<Neighbour>) =
                std::mem::take(all).into_iter().partition(in_plane);
            *all = others;
            for (at, group) in (0..).zip(groups(&found)) {
                let draw = || Stream::new(seed, &[u64::from(number), u64::from(between), at]).uniform();
                if joint.disc.is_some_and(|disc| !discs.decide(number, &disc, &sections(blocks, &group))) {
                    all.extend(group);
                } else if joint.persistence < 1.0 && draw() >= joint.persistence {
                    blocks.report.bridged += 1;
                    all.extend(group);
                } else {
                    blocks.report.cuts += 1;
                    group.iter().for_each(|pair| give_surface(blocks, pair, *surface));
                    parted = true;
                }
            }
        }
    }
    parted
}

impl Blocks {
    /// Parts glued blocks along the border of a space, whose surfaces are those from `first` on, where one of them is inside and the other is not; gives the number of pairs.
    pub(super) fn part_around(
        &mut self,
        (space, first): (&Domain, u32),
        tolerance: Tolerance,
        sliver_width_m: f64,
    ) -> usize {
        let mut parts = self.on_border(space, first, tolerance);
        for _ in 0..MOST_ROUNDS {
            let meets_whole = |(pair, _): &(Neighbour, u32)| (0..2).all(|own| self.is_whole(pair, own));
            if parts.is_empty() || parts.iter().all(meets_whole) {
                break;
            }
            self.meet_face_to_face(tolerance);
            self.finish(tolerance, sliver_width_m);
            parts = self.on_border(space, first, tolerance);
        }
        for (pair, surface) in &parts {
            give_surface(self, pair, *surface);
        }
        if !parts.is_empty() {
            self.report.cuts += parts.len();
            self.finish(tolerance, sliver_width_m);
        }
        parts.len()
    }

    /// Pairs of glued blocks of which a space holds one, with the surface of its border in which they meet.
    fn on_border(&self, space: &Domain, first: u32, tolerance: Tolerance) -> Vec<(Neighbour, u32)> {
        let holds = |block: u32| space.holds(&self.blocks[block as usize].volume_and_centroid().1);
        let of_border = |pair: &Neighbour| {
            let mut surfaces = (first..).zip(&self.surfaces[first as usize..]);
            let found = surfaces.find(|(_, surface)| {
                matches!(surface.kind, SurfaceKind::Joint { .. })
                    && are_alike(&surface.plane, &self.surfaces[pair.surface as usize].plane)
                    && lies_in(self, pair, &surface.plane, tolerance)
            });
            found.map(|(surface, _)| surface)
        };
        let glued = self.neighbours.iter().filter(|pair| pair.glued);
        let on_border = glued.filter_map(|pair| Some((*pair, of_border(pair)?)));
        on_border.filter(|(pair, _)| holds(pair.blocks[0]) != holds(pair.blocks[1])).collect()
    }

    /// Whether a block meets the other of a pair with a whole face.
    fn is_whole(&self, pair: &Neighbour, own: usize) -> bool {
        let block = &self.blocks[pair.blocks[own] as usize];
        let area = block.area_vector(&block.faces[pair.faces[own] as usize]).norm();
        area <= (1.0 + SAME_AREA) * pair.area_m2
    }

    /// Cuts glued blocks where another meets only a part of their face: along the planes beside that other face. The pieces are glued to each other.
    fn meet_face_to_face(&mut self, tolerance: Tolerance) {
        let mut cuts: BTreeSet<(u32, u32)> = BTreeSet::new();
        for pair in self.neighbours.iter().filter(|pair| pair.glued) {
            for (own, other) in [(0, 1), (1, 0)] {
                if !self.is_whole(pair, own) {
                    let planes = beside(&self.blocks[pair.blocks[other] as usize], pair.faces[other]);
                    cuts.extend(planes.map(|surface| (pair.blocks[own], surface)));
                }
            }
        }
        let mut copies: HashMap<u32, u32> = HashMap::new();
        let blocks = std::mem::take(&mut self.blocks);
        for (index, block) in (0..).zip(blocks) {
            let mut pieces = vec![block];
            for &(_, surface) in cuts.range((index, 0)..=(index, u32::MAX)) {
                let Surface { plane, name, .. } = self.surfaces[surface as usize];
                let copy = *copies.entry(surface).or_insert_with(|| {
                    self.surfaces.push(Surface { plane, kind: SurfaceKind::Domain, name });
                    self.surfaces.len() as u32 - 1
                });
                for piece in std::mem::take(&mut pieces) {
                    match split(&piece, &plane, copy, tolerance) {
                        Split::Both { above, below } => pieces.extend([above, below]),
                        _ => pieces.push(piece),
                    }
                }
            }
            self.blocks.extend(pieces);
        }
    }
}

fn are_alike(a: &Plane, b: &Plane) -> bool {
    a.normal().dot(b.normal()).abs() > ALIKE
}

/// Whether the faces of a pair lie in a plane.
fn lies_in(blocks: &Blocks, pair: &Neighbour, plane: &Plane, tolerance: Tolerance) -> bool {
    (0..2).all(|own| {
        let block = &blocks.blocks[pair.blocks[own] as usize];
        let mut ring = block.ring(&block.faces[pair.faces[own] as usize]);
        ring.all(|x| plane.height_m(&x).abs() <= tolerance.least_depth_m)
    })
}

/// Pairs in groups: those that share a face, directly or by others, are together.
fn groups(pairs: &[Neighbour]) -> Vec<Vec<Neighbour>> {
    let mut with_face: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
    for (at, pair) in pairs.iter().enumerate() {
        (0..2).for_each(|own| with_face.entry((pair.blocks[own], pair.faces[own])).or_default().push(at));
    }
    let mut is_taken = vec![false; pairs.len()];
    let mut found = Vec::new();
    for start in 0..pairs.len() {
        let (mut group, mut front) = (Vec::new(), vec![start]);
        while let Some(at) = front.pop() {
            if !std::mem::replace(&mut is_taken[at], true) {
                group.push(pairs[at]);
                let faces = (0..2).map(|own| (pairs[at].blocks[own], pairs[at].faces[own]));
                faces.for_each(|face| front.extend(&with_face[&face]));
            }
        }
        found.extend((!group.is_empty()).then_some(group));
    }
    found
}

/// The faces of pairs on one side, each once.
fn sections<'a>(blocks: &'a Blocks, pairs: &[Neighbour]) -> Vec<(&'a Polyhedron, &'a Face)> {
    let faces: BTreeSet<(u32, u32)> = pairs.iter().map(|pair| (pair.blocks[0], pair.faces[0])).collect();
    let of = |(block, face): (u32, u32)| {
        let block = &blocks.blocks[block as usize];
        (block, &block.faces[face as usize])
    };
    faces.into_iter().map(of).collect()
}

fn give_surface(blocks: &mut Blocks, pair: &Neighbour, surface: u32) {
    for own in 0..2 {
        blocks.blocks[pair.blocks[own] as usize].faces[pair.faces[own] as usize].surface = surface;
    }
}

#[cfg(test)]
mod tests {
    use super::super::discs::DiscRule;
    use super::super::joints::{Disc, Discontinuity, JointSet};
    use super::super::{Axis, CutOptions, cut_blocks};
    use super::*;
    use crate::Vec3;

    /// A bench of 2 m with a face of 1 m above it, 5 m thick: 10 m wide below and 6 m above.
    fn bench() -> Domain {
        let outline = [[0.0, 0.0], [10.0, 0.0], [10.0, 3.0], [4.0, 3.0], [4.0, 2.0], [0.0, 2.0]];
        Domain::extruded(&outline, Axis::Y, 0.0, 5.0).unwrap()
    }

    fn plane(name: &str, height_m: f64) -> Discontinuity {
        let plane = Plane::new(Vec3::z() * height_m, Vec3::z()).unwrap();
        Discontinuity::Plane { name: name.into(), plane }
    }

    fn cut(joints: &[Discontinuity]) -> Blocks {
        cut_blocks(&bench(), joints, &CutOptions::default()).unwrap()
    }

    /// Volumes of blocks with what is glued to them [m³], ascending.
    fn bodies_m3(blocks: &Blocks) -> Vec<f64> {
        let mut body: Vec<usize> = (0..blocks.blocks.len()).collect();
        for _ in 0..blocks.blocks.len() {
            for [a, b] in blocks.neighbours.iter().filter(|pair| pair.glued).map(|pair| pair.blocks) {
                let least = body[a as usize].min(body[b as usize]);
                (body[a as usize], body[b as usize]) = (least, least);
            }
        }
        let mut volumes_m3 = vec![0.0; blocks.blocks.len()];
        for (block, body) in blocks.blocks.iter().zip(&body) {
            volumes_m3[*body] += block.volume_m3();
        }
        volumes_m3.retain(|volume_m3| *volume_m3 > 0.0);
        volumes_m3.sort_by(f64::total_cmp);
        volumes_m3
    }

    fn assert_near(found: &[f64], exact: &[f64]) {
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-6 * b;
        assert!(found.len() == exact.len() && found.iter().zip(exact).all(is_near), "{found:?}, {exact:?}");
    }

    #[test]
    fn a_joint_in_the_plane_of_a_bench_cuts_as_one_beside_it_does() {
        for height_m in [2.0, 2.0 + 1e-10, 2.0 - 1e-10, 2.0 + 1e-7] {
            let blocks = cut(&[plane("bed", height_m)]);
            assert_near(&bodies_m3(&blocks), &[30.0, 100.0]);
            let of_bed = |pair: &&Neighbour| blocks.surface_name(pair.surface) == "bed";
            let area_m2: f64 = blocks.neighbours.iter().filter(of_bed).map(|pair| pair.area_m2).sum();
            assert!((area_m2 - 30.0).abs() < 1e-5, "{area_m2}");
        }
        assert_near(&bodies_m3(&cut(&[])), &[130.0]);
    }

    #[test]
    fn planes_of_sets_that_lie_in_faces_of_the_rock_cut_as_others_do() {
        let set = |dip_deg: f64, spacing_m: f64| {
            Discontinuity::Set(JointSet::new(format!("set {dip_deg}"), dip_deg, 90.0, spacing_m))
        };
        assert_near(&bodies_m3(&cut(&[set(0.0, 1.0), set(90.0, 2.0)])), &[10.0; 13]);
    }

    #[test]
    fn discs_in_the_plane_of_a_bench_part_what_their_rule_says() {
        let disc = |radius_m: f64, rule: DiscRule| {
            let center_m = Vec3::new(7.0, 2.5, 2.0);
            let (name, dip_deg, dip_direction_deg) = ("disc".into(), 0.0, 0.0);
            let disc = Disc { name, dip_deg, dip_direction_deg, center_m, radius_m, rule };
            let blocks = cut(&[Discontinuity::Disc(disc)]);
            (bodies_m3(&blocks).len(), blocks.report.discs.cuts)
        };
        assert_eq!(disc(4.0, DiscRule::Covers), (2, 1));
        assert_eq!(disc(1.0, DiscRule::Covers), (1, 0));
        assert_eq!(disc(1.0, DiscRule::Meets), (2, 1));
        assert_eq!(disc(1.0, DiscRule::default()), (1, 0));
        assert_eq!(disc(2.4, DiscRule::default()), (2, 1));
    }

    #[test]
    fn a_space_whose_floor_is_level_with_a_bench_takes_what_is_inside_and_leaves_the_rest() {
        for (from_m, inside_m3) in [(4.0, 30.0), (6.0, 20.0)] {
            let mut blocks = cut(&[]);
            let outline = [[from_m, 2.0], [12.0, 2.0], [12.0, 4.0], [from_m, 4.0]];
            let space = Domain::extruded(&outline, Axis::Y, -1.0, 6.0).unwrap();
            assert!(blocks.excavate(&bench(), ("pit", &space), 0.0) > 0);
            assert_near(&bodies_m3(&blocks), &[inside_m3, 130.0 - inside_m3]);
            let within = |block: &&Polyhedron| space.holds(&block.volume_and_centroid().1);
            let found_m3: f64 = blocks.blocks.iter().filter(within).map(Polyhedron::volume_m3).sum();
            assert!((found_m3 - inside_m3).abs() < 1e-9, "{found_m3}");
        }
    }
}
