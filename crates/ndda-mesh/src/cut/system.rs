//! A domain cut by discontinuities.

use std::collections::BTreeMap;

use super::CutError;
use super::blocks::{Blocks, CutReport};
use super::discs::DiscCounts;
use super::domain::Domain;
use super::interfaces::part_along_joints;
use super::joints::{CuttingPlane, Discontinuity};
use super::polyhedron::Polyhedron;
use super::random::{Stream, key};
use super::split::{Split, Tolerance, split};
use super::surfaces::index_of;
use super::surfaces::{Surface, SurfaceKind};

/// Choices of a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutOptions {
    /// Seed of scatter and persistence.
    pub seed: u64,
    /// Blocks thinner than this are listed in the report [m]; 0 lists none.
    pub sliver_width_m: f64,
    /// Most blocks; more are an error.
    pub most_blocks: usize,
}

impl Default for CutOptions {
    fn default() -> Self {
        Self { seed: 0, sliver_width_m: 0.0, most_blocks: 10_000_000 }
    }
}

/// Cuts a domain by discontinuities in their order.
///
/// Each plane is tried only on blocks whose bounding box it touches. With persistence below 1, whether a plane cuts
/// a block is drawn from the seed, the plane and the block's history: the same seed gives the same blocks.
///
/// # Errors
/// [`CutError`] when a number of a discontinuity is out of range, or planes or blocks are too many.
pub fn cut_blocks(
    domain: &Domain,
    discontinuities: &[Discontinuity],
    options: &CutOptions,
) -> Result<Blocks, CutError> {
    let mut names = domain.names.clone();
    let mut surfaces = domain.surfaces.clone();
    let mut cutting_planes: Vec<(u32, CuttingPlane)> = Vec::new();
    for (joint, discontinuity) in (0u32..).zip(discontinuities) {
        let name = index_of(&mut names, discontinuity.name());
        for cutting_plane in discontinuity.cutting_planes(u64::from(joint), options.seed, &domain.bounds())? {
            cutting_planes.push((surfaces.len() as u32, cutting_plane));
            let kind = SurfaceKind::Joint { joint, number: cutting_plane.number };
            surfaces.push(Surface { plane: cutting_plane.plane, kind, name });
        }
    }
    let mut carving = Carving {
        cutting_planes,
        seed: options.seed,
        most_blocks: options.most_blocks,
        tolerance: domain.tolerance(),
        blocks: Vec::new(),
        refused: BTreeMap::new(),
        discs: DiscCounts::default(),
        report: CutReport { domain_m3: domain.volume_m3(), ..CutReport::default() },
    };
    // Glued parts start with one history, so that persistence treats them alike where it can.
    for part in &domain.parts {
        carving.carve(part.clone(), 0)?;
    }
    let mut report = carving.report;
    report.refused = carving.refused.into_iter().collect();
    let mut discs = carving.discs;
    let (tolerance, sliver_width_m) = (domain.tolerance(), options.sliver_width_m);
    let mut blocks = Blocks { blocks: carving.blocks, surfaces, names, neighbours: Vec::new(), report };
    blocks.finish(tolerance, sliver_width_m);
    if part_along_joints(&mut blocks, &carving.cutting_planes, (options.seed, &mut discs), tolerance) {
        blocks.finish(tolerance, sliver_width_m);
    }
    blocks.report.discs = discs.report(discontinuities.iter().filter(|joint| joint.is_disc()).count());
    Ok(blocks)
}

struct Carving {
    /// Planes in the order of cutting, with their surfaces.
    cutting_planes: Vec<(u32, CuttingPlane)>,
    seed: u64,
    most_blocks: usize,
    tolerance: Tolerance,
    blocks: Vec<Polyhedron>,
    refused: BTreeMap<u32, usize>,
    discs: DiscCounts,
    report: CutReport,
}

/// A block, its history, and the planes that may still cut it.
struct Piece {
    block: Polyhedron,
    history: u64,
    cutting_planes: Vec<u32>,
}

impl Carving {
    /// Cuts one convex part by all planes, depth first: each piece inherits the later planes that touch its box.
    fn carve(&mut self, part: Polyhedron, number: u64) -> Result<(), CutError> {
        let all: Vec<u32> = (0..self.cutting_planes.len() as u32).collect();
        let mut stack = vec![self.piece(part, number, &all)];
        while let Some(piece) = stack.pop() {
            let Some((at, above, below)) = self.first_cut(&piece) else {
                self.blocks.push(piece.block);
                if self.blocks.len() + stack.len() > self.most_blocks {
                    return Err(CutError::TooManyBlocks { most: self.most_blocks });
                }
                continue;
            };
            let cutting_plane = u64::from(piece.cutting_planes[at]);
            let rest = &piece.cutting_planes[at + 1..];
            stack.push(self.piece(above, key(piece.history, 2 * cutting_plane + 1), rest));
            stack.push(self.piece(below, key(piece.history, 2 * cutting_plane), rest));
        }
        Ok(())
    }

    fn piece(&self, block: Polyhedron, history: u64, cutting_planes: &[u32]) -> Piece {
        let bounds = block.bounds();
        let touches = |&&k: &&u32| {
            let CuttingPlane { plane, disc, .. } = &self.cutting_planes[k as usize].1;
            plane.touches(&bounds, 0.0) && disc.is_none_or(|disc| disc.touches(&bounds))
        };
        let cutting_planes = cutting_planes.iter().filter(touches).copied().collect();
        Piece { block, history, cutting_planes }
    }

    /// The first plane that cuts the piece, as its place in the list, and the parts.
    fn first_cut(&mut self, piece: &Piece) -> Option<(usize, Polyhedron, Polyhedron)> {
        for (at, &k) in piece.cutting_planes.iter().enumerate() {
            let (surface, cutting_plane) = self.cutting_planes[k as usize];
            match split(&piece.block, &cutting_plane.plane, surface, self.tolerance) {
                Split::Above | Split::Below => {}
                Split::Refused => *self.refused.entry(surface).or_default() += 1,
                Split::Both { above, below } => {
                    // The section is the last face.
                    let section = above.faces.last().map(|face| (&above, face));
                    let leaves_whole = |disc| !self.discs.decide(k, &disc, section.as_slice());
                    if cutting_plane.disc.is_some_and(leaves_whole) {
                        continue;
                    }
                    let draw = || Stream::new(self.seed, &[piece.history, u64::from(k)]).uniform();
                    if cutting_plane.persistence < 1.0 && draw() >= cutting_plane.persistence {
                        self.report.bridged += 1;
                        continue;
                    }
                    self.report.cuts += 1;
                    return Some((at, above, below));
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use crate::Vec3;
    use proptest::prelude::*;

    use super::super::discs::DiscRule;
    use super::super::joints::{Disc, JointSet, OrientationScatter, SpacingScatter};
    use super::super::plane::Plane;
    use super::*;

    fn cube() -> Domain {
        Domain::cuboid(Vec3::zeros(), Vec3::repeat(1.0)).unwrap()
    }

    fn cut(list: &[Discontinuity]) -> Blocks {
        cut_blocks(&cube(), list, &CutOptions::default()).unwrap()
    }

    fn set(dip: f64, direction: f64, spacing: f64) -> Discontinuity {
        Discontinuity::Set(JointSet::new(format!("set {dip} {direction}"), dip, direction, spacing))
    }

    #[test]
    fn three_orthogonal_sets_make_a_grid_with_its_neighbours() {
        let blocks = cut(&[set(90.0, 90.0, 0.25), set(90.0, 0.0, 0.25), set(0.0, 0.0, 0.25)]);
        assert_eq!(blocks.blocks.len(), 64);
        assert_eq!(blocks.neighbours.len(), 3 * 3 * 16);
        assert!(blocks.neighbours.iter().all(|n| (n.area_m2 - 0.0625).abs() < 1e-14 && !n.glued));
        assert!((blocks.report.volume_m3 - 1.0).abs() < 1e-14);
        assert_eq!(blocks.report.cuts, 63);
        let face = blocks.blocks[0].faces.last().unwrap();
        assert_eq!(blocks.name_of(face), "set 0 0");
    }

    #[test]
    fn a_face_may_have_several_neighbours() {
        let plane = |name: &str, point: [f64; 3], normal: [f64; 3]| Discontinuity::Plane {
            name: name.into(),
            plane: Plane::new(point.into(), normal.into()).unwrap(),
        };
        let disc = Discontinuity::Disc(Disc {
            name: "disc".into(),
            dip_deg: 90.0,
            dip_direction_deg: 90.0,
            center_m: Vec3::new(0.5, 0.5, 0.9),
            radius_m: 0.2,
            rule: DiscRule::Meets,
        });
        let blocks = cut(&[plane("bed", [0.0, 0.0, 0.5], [0.0, 0.0, 1.0]), disc]);
        assert_eq!(blocks.blocks.len(), 3);
        let on_bed: Vec<f64> = blocks
            .neighbours
            .iter()
            .filter(|n| blocks.surface_name(n.surface) == "bed")
            .map(|n| n.area_m2)
            .collect();
        assert_eq!(on_bed.len(), 2);
        assert!(on_bed.iter().all(|a| (a - 0.5).abs() < 1e-15));
    }

    #[test]
    fn discs_cut_by_their_rule() {
        let disc = |radius_m, rule| {
            let center_m = Vec3::repeat(0.5);
            let name = "disc".into();
            let disc = Disc { name, dip_deg: 0.0, dip_direction_deg: 0.0, center_m, radius_m, rule };
            cut(&[Discontinuity::Disc(disc)]).blocks.len()
        };
        assert_eq!(disc(0.1, DiscRule::Meets), 2);
        assert_eq!(disc(0.1, DiscRule::Covers), 1);
        assert_eq!(disc(0.7, DiscRule::Covers), 1);
        assert_eq!(disc(0.71, DiscRule::Covers), 2);
        // π r² covers half of the unit square from r = √(1/2π) = 0.39894 on.
        assert_eq!((disc(0.3989, DiscRule::Share(0.5)), disc(0.399, DiscRule::Share(0.5))), (1, 2));
        assert_eq!((disc(0.71, DiscRule::Share(1.0)), disc(0.01, DiscRule::Share(0.0))), (2, 2));
    }

    fn level_disc(center_m: [f64; 3], radius_m: f64) -> Discontinuity {
        let (name, rule) = ("disc".into(), DiscRule::Share(0.5));
        Discontinuity::Disc(Disc {
            name,
            dip_deg: 0.0,
            dip_direction_deg: 0.0,
            center_m: center_m.into(),
            radius_m,
            rule,
        })
    }

    #[test]
    fn a_disc_that_ends_in_blocks_cuts_those_of_which_it_covers_half() {
        // Four columns of 0.5 m by 0.5 m. A disc about the corner of one, of radius 0.5, covers a quarter of a circle in it, which is
        // π/4 of its section, and nothing of the others.
        let columns = [set(90.0, 90.0, 0.5), set(90.0, 0.0, 0.5)];
        let cut_by = |disc: Discontinuity| cut(&[columns.to_vec(), vec![disc]].concat());
        let corner = cut_by(level_disc([0.0, 0.0, 0.3], 0.5)).report.discs;
        assert_eq!((corner.cuts, corner.ends_in_cut, corner.left_whole, corner.idle), (1, 1, 0, 0));
        assert!((corner.disc_m2 - 0.25 * std::f64::consts::PI * 0.25).abs() < 1e-14);
        assert!((corner.joint_m2 - 0.25).abs() < 1e-14);
        // About the middle, a quarter of the circle in each: 0.35 covers 0.3848 of a column, 0.4 covers 0.5027.
        let quarter = |radius_m: f64| 0.25 * std::f64::consts::PI * radius_m * radius_m;
        let small = cut_by(level_disc([0.5, 0.5, 0.3], 0.35));
        assert_eq!((small.blocks.len(), small.report.discs.left_whole, small.report.discs.idle), (4, 4, 1));
        assert!((small.report.discs.disc_m2 - 4.0 * quarter(0.35)).abs() < 1e-14);
        let large = cut_by(level_disc([0.5, 0.5, 0.3], 0.4));
        assert_eq!((large.blocks.len(), large.report.discs.cuts, large.report.discs.ends_in_cut), (8, 4, 4));
        assert!((large.report.discs.joint_m2 - 1.0).abs() < 1e-14);
        // One that covers the rock ends in no block.
        let all = cut_by(level_disc([0.5, 0.5, 0.3], 2.0)).report.discs;
        assert_eq!((all.cuts, all.ends_in_cut, all.left_whole), (4, 0, 0));
        assert!((all.disc_m2 - 1.0).abs() < 1e-14);
        let away = cut_by(level_disc([3.0, 0.5, 0.3], 1.0)).report.discs;
        assert_eq!((away.cuts, away.left_whole, away.idle), (0, 0, 1));
    }

    #[test]
    fn discs_that_do_not_meet_cut_the_same_in_any_order() {
        let discs: Vec<Discontinuity> =
            (1..8).map(|i| level_disc([0.5, 0.5, f64::from(i) / 8.0], 0.1 * f64::from(i))).collect();
        let forth = cut(&discs);
        let back = cut(&discs.iter().rev().cloned().collect::<Vec<_>>());
        // Those of radius 0.4 and more cover half of the section.
        assert_eq!((forth.blocks.len(), back.blocks.len()), (5, 5));
        let volumes = |blocks: &Blocks| {
            let mut volumes: Vec<f64> = blocks.blocks.iter().map(Polyhedron::volume_m3).collect();
            volumes.sort_by(f64::total_cmp);
            volumes
        };
        assert_eq!(volumes(&forth), volumes(&back));
    }

    #[test]
    fn persistence_leaves_bridges_and_the_seed_repeats_them() {
        let random = |seed| {
            let sets = [(60.0, 40.0), (35.0, 170.0), (80.0, 290.0)].map(|(dip, direction)| {
                Discontinuity::Set(JointSet {
                    persistence: 0.6,
                    orientation: OrientationScatter::Fisher { kappa: 100.0 },
                    spacing: SpacingScatter::Exponential,
                    ..JointSet::new("set", dip, direction, 0.2)
                })
            });
            cut_blocks(&cube(), &sets, &CutOptions { seed, sliver_width_m: 0.01, ..CutOptions::default() })
                .unwrap()
        };
        let blocks = random(1);
        assert!(blocks.report.bridged > 0 && blocks.report.cuts > 0);
        assert_eq!(blocks, random(1));
        assert_ne!(blocks.blocks.len(), random(2).blocks.len());
        assert!(blocks.report.slivers.windows(2).all(|w| w[0].width_m <= w[1].width_m));
        assert!((blocks.report.volume_m3 - 1.0).abs() < 1e-12);
        assert!(blocks.blocks.iter().all(|b| b.euler() == Some(2)));
    }

    #[test]
    fn coincident_sets_cut_once() {
        let once = cut(&[set(30.0, 90.0, 0.2)]);
        let twice = cut(&[set(30.0, 90.0, 0.2), set(30.0, 90.0, 0.2), set(30.0, 90.0, 0.1)]);
        assert_eq!(twice.blocks.len(), cut(&[set(30.0, 90.0, 0.1)]).blocks.len());
        assert!(once.blocks.len() < twice.blocks.len());
    }

    #[test]
    fn removed_blocks_take_their_neighbours_along() {
        let mut blocks = cut(&[set(90.0, 90.0, 0.25), set(0.0, 0.0, 0.5)]);
        let all = blocks.clone();
        let gone = 3;
        assert!((blocks.remove(&[gone, gone, 99]) - 0.125).abs() < 1e-15);
        assert_eq!(blocks.blocks.len(), 7);
        let with = all.neighbours.iter().filter(|n| n.blocks.contains(&gone)).count();
        assert_eq!(blocks.neighbours.len(), all.neighbours.len() - with);
        for n in &blocks.neighbours {
            let [a, b] = [0, 1].map(|i| {
                let block = &blocks.blocks[n.blocks[i] as usize];
                block.area_vector(&block.faces[n.faces[i] as usize])
            });
            assert!((a + b).norm() < 1e-14);
        }
    }

    #[test]
    fn map_coordinates_change_nothing() {
        let at = Vec3::new(4.5e6, 5.4e6, 300.0);
        let domain = Domain::cuboid(at, at.add_scalar(10.0)).unwrap();
        let sets = [(60.0, 40.0), (35.0, 170.0), (80.0, 290.0)].map(|(dip, direction)| {
            Discontinuity::Set(JointSet { origin_m: at, ..JointSet::new("set", dip, direction, 2.0) })
        });
        let blocks = cut_blocks(&domain, &sets, &CutOptions::default()).unwrap();
        let near = Domain::cuboid(Vec3::zeros(), Vec3::repeat(10.0)).unwrap();
        let sets = sets.map(|mut set| {
            if let Discontinuity::Set(set) = &mut set {
                set.origin_m = Vec3::zeros();
            }
            set
        });
        assert_eq!(
            cut_blocks(&near, &sets, &CutOptions::default()).unwrap().blocks.len(),
            blocks.blocks.len()
        );
        assert!((blocks.report.volume_m3 / 1000.0 - 1.0).abs() < 1e-9);
        assert!(blocks.report.refused.is_empty() && blocks.blocks.iter().all(|b| b.euler() == Some(2)));
    }

    #[test]
    fn too_many_blocks_are_an_error() {
        let options = CutOptions { most_blocks: 100, ..CutOptions::default() };
        let error = cut_blocks(&cube(), &[set(0.0, 0.0, 0.001)], &options).unwrap_err();
        assert_eq!(error, CutError::TooManyBlocks { most: 100 });
    }

    proptest! {
        #[test]
        fn any_sets_fill_the_domain_and_every_face_is_covered(
            sets in prop::collection::vec((0.0..=90.0f64, 0.0..360.0f64, 0.1..1.0f64, 0.3..=1.0f64), 1..4),
            seed in any::<u64>(),
        ) {
            let sets: Vec<Discontinuity> = sets.into_iter().map(|(dip, direction, spacing, persistence)| {
                Discontinuity::Set(JointSet { persistence, ..JointSet::new("set", dip, direction, spacing) })
            }).collect();
            let blocks = cut_blocks(&cube(), &sets, &CutOptions { seed, ..CutOptions::default() }).unwrap();
            prop_assert!((blocks.report.volume_m3 - 1.0).abs() < 1e-12);
            prop_assert!(blocks.blocks.iter().all(|b| b.euler() == Some(2)));
            let inner: f64 = blocks.blocks.iter().flat_map(|b| b.faces.iter().map(move |f| (b, f)))
                .filter(|(_, f)| f.surface >= 6).map(|(b, f)| b.area_vector(f).norm()).sum();
            let met: f64 = blocks.neighbours.iter().map(|n| n.area_m2).sum();
            prop_assert!((inner - 2.0 * met).abs() < 1e-9, "{inner} {met}");
        }
    }
}
