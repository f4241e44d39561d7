//! Slivers united with their neighbours.
//!
//! A sliver goes to the neighbour with which it shares the largest face, provided that both together are convex: between the planes of a
//! set that end nowhere they always are. Volume is kept, and no void is left. The joint between the two is closed over that face.

use std::collections::BTreeSet;

use super::blocks::{Blocks, is_sliver};
use super::domain::Domain;
use super::neighbours::neighbours;
use super::polyhedron::Polyhedron;
use super::split::{Split, Tolerance, split};
use super::surfaces::Surface;
use crate::Vec3;
use crate::geometry::Aabb;

/// The union of two blocks has their volume to this fraction, or it is not convex.
const SAME_VOLUME: f64 = 1e-9;

/// Slivers that were united with neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Merged {
    /// Their number.
    pub count: usize,
    /// Their volume, each part of it counted once [m³].
    pub volume_m3: f64,
}

impl Blocks {
    /// Unites blocks thinner than `sliver_width_m` with neighbours, thinnest first; those that have no neighbour with which
    /// they are convex stay, and remain in the report. Parts of concave blocks are left alone. Later blocks move up. The blocks are those of
    /// `domain`.
    pub fn merge_slivers(&mut self, domain: &Domain, sliver_width_m: f64) -> Merged {
        self.merge_slivers_within(domain, sliver_width_m, &|_| 0)
    }

    /// The same, but blocks are united only where `region` gives the same number for their centroids: on one side of a face of the rock or of the border of an excavation.
    pub fn merge_slivers_within(
        &mut self,
        domain: &Domain,
        sliver_width_m: f64,
        region: &dyn Fn(&Vec3) -> usize,
    ) -> Merged {
        let tolerance = domain.tolerance();
        let mut merging = Merging::new(self, sliver_width_m, region);
        let merged = merging.run(&self.surfaces, tolerance);
        if merged.count > 0 {
            self.blocks = merging.blocks.into_iter().flatten().collect();
            self.neighbours = neighbours(&self.blocks, &self.surfaces, tolerance.least_depth_m);
            self.report.slivers = super::blocks::slivers(&self.blocks, sliver_width_m);
        }
        merged
    }
}

/// A face that two blocks share: the other block, the surface, and the area [m²].
#[derive(Clone, Copy, Debug)]
struct Shared {
    other: u32,
    surface: u32,
    area_m2: f64,
}

struct Merging {
    sliver_width_m: f64,
    /// Blocks; none where one has gone into another.
    blocks: Vec<Option<Polyhedron>>,
    shared: Vec<Vec<Shared>>,
    /// Parts of concave blocks.
    glued: Vec<bool>,
    /// Where each block is; a union is where its parts are.
    region: Vec<usize>,
    /// What has come into each block from slivers [m³].
    from_slivers_m3: Vec<f64>,
    /// Slivers by the bits of their width, which order as positive numbers do.
    thin: BTreeSet<(u64, u32)>,
}

impl Merging {
    fn new(blocks: &Blocks, sliver_width_m: f64, region: &dyn Fn(&Vec3) -> usize) -> Self {
        let count = blocks.blocks.len();
        let (mut shared, mut glued) = (vec![Vec::new(); count], vec![false; count]);
        for neighbour in &blocks.neighbours {
            let [a, b] = neighbour.blocks;
            let (surface, area_m2) = (neighbour.surface, neighbour.area_m2);
            shared[a as usize].push(Shared { other: b, surface, area_m2 });
            shared[b as usize].push(Shared { other: a, surface, area_m2 });
            if neighbour.glued {
                (glued[a as usize], glued[b as usize]) = (true, true);
            }
        }
        let region = blocks.blocks.iter().map(|block| region(&block.volume_and_centroid().1)).collect();
        let (none, thin, from_slivers_m3) = (Vec::new(), BTreeSet::new(), vec![0.0; count]);
        let mut merging = Self { sliver_width_m, blocks: none, shared, glued, region, from_slivers_m3, thin };
        merging.blocks = blocks.blocks.iter().cloned().map(Some).collect();
        for sliver in &blocks.report.slivers {
            merging.note(sliver.block);
        }
        merging
    }

    /// Notes a block that is a sliver.
    fn note(&mut self, block: u32) {
        let Some(polyhedron) = &self.blocks[block as usize] else { return };
        let width_m = polyhedron.width_m();
        if !self.glued[block as usize] && is_sliver(polyhedron, width_m, self.sliver_width_m) {
            self.thin.insert((width_m.to_bits(), block));
        }
    }

    fn run(&mut self, surfaces: &[Surface], tolerance: Tolerance) -> Merged {
        let mut merged = Merged::default();
        while let Some((_, sliver)) = self.thin.pop_first() {
            let Some((other, union)) = self.partner(sliver, surfaces, tolerance) else { continue };
            merged.count += 1;
            // Of a sliver that slivers have been united with, these have been counted.
            let volume_m3 = self.blocks[sliver as usize].as_ref().map_or(0.0, Polyhedron::volume_m3);
            merged.volume_m3 += volume_m3 - self.from_slivers_m3[sliver as usize];
            self.from_slivers_m3[other as usize] += volume_m3;
            self.thin.retain(|(_, block)| *block != other);
            self.unite(sliver, other, union);
            self.note(other);
        }
        merged
    }

    /// The neighbour with the largest shared face with which a sliver is convex, and both together.
    fn partner(&self, sliver: u32, surfaces: &[Surface], tolerance: Tolerance) -> Option<(u32, Polyhedron)> {
        let mut candidates = self.shared[sliver as usize].clone();
        let region = self.region[sliver as usize];
        candidates.retain(|shared| {
            !self.glued[shared.other as usize] && self.region[shared.other as usize] == region
        });
        candidates.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2).then(a.other.cmp(&b.other)));
        let own = self.blocks[sliver as usize].as_ref()?;
        candidates.into_iter().find_map(|shared| {
            let other = self.blocks[shared.other as usize].as_ref()?;
            Some((shared.other, union(own, other, shared.surface, surfaces, tolerance)?))
        })
    }

    /// Puts a sliver into another block.
    fn unite(&mut self, sliver: u32, other: u32, union: Polyhedron) {
        self.blocks[sliver as usize] = None;
        self.blocks[other as usize] = Some(union);
        let gone = std::mem::take(&mut self.shared[sliver as usize]);
        self.shared[other as usize].retain(|shared| shared.other != sliver);
        for shared in gone.into_iter().filter(|shared| shared.other != other) {
            self.shared[shared.other as usize].retain(|back| back.other != sliver);
            self.add(other, shared);
            self.add(shared.other, Shared { other, ..shared });
        }
    }

    fn add(&mut self, block: u32, new: Shared) {
        let list = &mut self.shared[block as usize];
        match list.iter_mut().find(|old| old.other == new.other && old.surface == new.surface) {
            Some(old) => old.area_m2 += new.area_m2,
            None => list.push(new),
        }
    }
}

/// Two blocks that meet on a surface as one, if it is convex: what the planes of all their other faces enclose. Each of these planes has both blocks
/// on one side, so that the union holds them, and no more than them by its volume: where planes are evenly spaced, another cell of theirs may be as large.
fn union(
    a: &Polyhedron,
    b: &Polyhedron,
    between: u32,
    surfaces: &[Surface],
    tolerance: Tolerance,
) -> Option<Polyhedron> {
    let faces: BTreeSet<u32> =
        a.faces.iter().chain(&b.faces).map(|face| face.surface).filter(|&s| s != between).collect();
    let corners: Vec<_> = a.vertices.iter().chain(&b.vertices).copied().collect();
    let mut cell = Polyhedron::around(&Aabb::around(&corners));
    let inside = corners.iter().sum::<Vec3>() / corners.len() as f64;
    for surface in faces {
        let plane = &surfaces[surface as usize].plane;
        let side = plane.height_m(&inside).signum();
        if corners.iter().any(|corner| side * plane.height_m(corner) < -tolerance.least_depth_m) {
            return None;
        }
        if let Split::Both { above, below } = split(&cell, plane, surface, tolerance) {
            cell = if plane.height_m(&inside) > 0.0 { above } else { below };
        }
    }
    let volume_m3 = a.volume_m3() + b.volume_m3();
    (cell.is_within_surfaces() && (cell.volume_m3() - volume_m3).abs() <= SAME_VOLUME * volume_m3)
        .then_some(cell)
}

#[cfg(test)]
mod tests {
    use super::super::polyhedron::Face;
    use super::super::{CutOptions, Discontinuity, JointSet, cut_blocks};
    use super::*;

    fn slope(sliver_width_m: f64, persistence: f64) -> (Blocks, Domain) {
        let domain = Domain::cuboid(Vec3::zeros(), Vec3::new(9.0, 7.0, 8.0)).unwrap();
        let sets = [(38.0, 90.0, 1.4), (75.0, 270.0, 2.1), (83.0, 12.0, 1.7), (60.0, 200.0, 2.9)];
        let sets = sets.map(|(dip, direction, spacing)| {
            Discontinuity::Set(JointSet { persistence, ..JointSet::new("set", dip, direction, spacing) })
        });
        let options = CutOptions { sliver_width_m, seed: 3, ..CutOptions::default() };
        (cut_blocks(&domain, &sets, &options).unwrap(), domain)
    }

    #[test]
    fn slivers_between_planes_without_end_find_neighbours_and_volume_is_kept() {
        let (mut blocks, domain) = slope(0.5, 1.0);
        let (count, slivers) = (blocks.blocks.len(), blocks.report.slivers.len());
        assert!(slivers > 50, "{slivers}");
        let merged = blocks.merge_slivers(&domain, 0.5);
        // Unions are no cells of the planes any longer: later slivers may find none with which they are convex.
        assert!(20 * blocks.report.slivers.len() < slivers, "{:?}", blocks.report.slivers);
        assert_eq!(blocks.blocks.len(), count - merged.count);
        let volume: f64 = blocks.blocks.iter().map(Polyhedron::volume_m3).sum();
        assert!((volume / domain.volume_m3() - 1.0).abs() < 1e-9);
        let left: Vec<u32> = blocks.report.slivers.iter().map(|sliver| sliver.block).collect();
        for (index, block) in (0..).zip(&blocks.blocks) {
            assert_eq!(block.euler(), Some(2));
            assert!(left.contains(&index) || block.width_m() >= 0.5 && block.volume_m3() >= 0.125);
        }
    }

    #[test]
    fn slivers_of_an_excavation_unite_on_their_side_of_its_border() {
        let (mut blocks, domain) = slope(0.4, 1.0);
        blocks.merge_slivers(&domain, 0.4);
        let space = Domain::cuboid(Vec3::new(2.1, -1.0, 2.1), Vec3::new(6.3, 4.2, 5.9)).unwrap();
        blocks.excavate(&domain, ("heading", &space), 0.4);
        let inside_m3 = |blocks: &Blocks| {
            let parts = blocks.blocks.iter().map(Polyhedron::volume_and_centroid);
            parts.filter(|(_, at)| space.holds(at)).map(|(m3, _)| m3).sum::<f64>()
        };
        let slivers = blocks.report.slivers.len();
        let merged = blocks.merge_slivers_within(&domain, 0.4, &|at| if space.holds(at) { 1 } else { 0 });
        assert!(slivers > 20 && 5 * blocks.report.slivers.len() < slivers, "{slivers} {merged:?}");
        assert!((inside_m3(&blocks) / (4.2 * 4.2 * 3.8) - 1.0).abs() < 1e-9, "{}", inside_m3(&blocks));
    }

    #[test]
    fn the_volume_of_slivers_is_counted_once_where_all_blocks_are_slivers() {
        let domain = Domain::cuboid(Vec3::zeros(), Vec3::new(6.0, 6.0, 6.0)).unwrap();
        let set = |dip, direction| Discontinuity::Set(JointSet::new("set", dip, direction, 0.5));
        let options = CutOptions { sliver_width_m: 1.0, ..CutOptions::default() };
        let mut blocks = cut_blocks(&domain, &[set(0.0, 0.0), set(90.0, 90.0)], &options).unwrap();
        let merged = blocks.merge_slivers(&domain, 1.0);
        assert!(merged.count > 100 && merged.volume_m3 <= domain.volume_m3(), "{merged:?}");
    }

    /// Whether a point is in a block.
    fn holds(block: &Polyhedron, at: &Vec3) -> bool {
        let is_behind = |face: &Face| {
            let corner = block.vertices[face.vertices[0] as usize];
            (at - corner).dot(&block.area_vector(face)) < 0.0
        };
        block.faces.iter().all(is_behind)
    }

    #[test]
    fn each_point_is_in_one_block_after_most_cells_of_a_regular_grid_were_united() {
        let domain = Domain::cuboid(Vec3::zeros(), Vec3::new(9.0, 8.0, 7.0)).unwrap();
        let set = |dip, direction| Discontinuity::Set(JointSet::new("set", dip, direction, 0.5));
        let sets = [set(40.0, 130.0), set(60.0, 220.0)];
        let options = CutOptions { sliver_width_m: 1.0, ..CutOptions::default() };
        let mut blocks = cut_blocks(&domain, &sets, &options).unwrap();
        let merged = blocks.merge_slivers(&domain, 1.0);
        assert!(merged.count > 300, "{merged:?}");
        // Points of no regular grid: multiples of irrational numbers.
        for i in 1..2000 {
            let part = |irrational: f64| (f64::from(i) * irrational).fract();
            let at = Vec3::new(9.0 * part(2f64.sqrt()), 8.0 * part(3f64.sqrt()), 7.0 * part(5f64.sqrt()));
            let count = blocks.blocks.iter().filter(|block| holds(block, &at)).count();
            assert_eq!(count, 1, "{at}");
        }
    }

    #[test]
    fn slivers_behind_a_face_do_not_unite_with_what_is_in_front_of_it() {
        let (mut blocks, domain) = slope(0.5, 1.0);
        // One of the planes of the first set, which goes through the origin.
        let face = Vec3::new(38f64.to_radians().sin(), 0.0, 38f64.to_radians().cos());
        let front_m3 = |blocks: &Blocks| {
            let parts = blocks.blocks.iter().map(Polyhedron::volume_and_centroid);
            parts.filter(|(_, at)| at.dot(&face) > 7.0).map(|(m3, _)| m3).sum::<f64>()
        };
        let before_m3 = front_m3(&blocks);
        let merged = blocks.merge_slivers_within(&domain, 0.5, &|at| usize::from(at.dot(&face) > 7.0));
        assert!(merged.count > 50 && (front_m3(&blocks) / before_m3 - 1.0).abs() < 1e-9, "{merged:?}");
    }

    /// Every face inside the domain is covered by neighbours, from both sides.
    #[test]
    fn merged_blocks_leave_no_void() {
        for persistence in [1.0, 0.7] {
            let (mut blocks, domain) = slope(0.3, persistence);
            blocks.merge_slivers(&domain, 0.3);
            let inner: f64 = blocks
                .blocks
                .iter()
                .flat_map(|b| b.faces.iter().map(move |f| (b, f)))
                .filter(|(_, f)| f.surface >= 6)
                .map(|(b, f)| b.area_vector(f).norm())
                .sum();
            let met: f64 = blocks.neighbours.iter().map(|n| n.area_m2).sum();
            assert!((inner - 2.0 * met).abs() < 1e-7 * inner, "{inner} {met}");
        }
    }
}
