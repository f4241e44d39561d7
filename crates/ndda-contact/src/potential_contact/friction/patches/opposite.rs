//! Faces that lie on each other: two blocks that touch with flat faces have one patch, not one on either face.
//!
//! Both faces see the same slip, so which of the two would carry how much of a sticking friction is nearly undetermined, and
//! Gauss–Seidel over both would hardly converge. Their pressures add up to that of one patch, whose friction is found once.

use std::ops::Range;

use ndda_mesh::{BlockId, Vec3};

use crate::friction::facet::FacetForce;
use crate::friction::patches::{PatchScene, Place};

/// Faces whose normals are opposite but for so much lie on each other: the sine of about 8°.
const TILT: f64 = 0.14;
/// No run.
const NONE: u32 = u32::MAX;

/// The facets of one face on one block, in a row.
#[derive(Clone, Debug)]
struct Run {
    places: Range<usize>,
    owner: BlockId,
    target: BlockId,
    /// Direction of its normal force, zero where it has no friction.
    direction: Vec3,
    /// The run that lies on it.
    opposite: u32,
}

/// Facets by patch, found from facets by face and target.
#[derive(Default)]
pub(super) struct Opposite {
    runs: Vec<Run>,
    /// (lower block, other block, run).
    by_pair: Vec<(BlockId, BlockId, u32)>,
}

impl Opposite {
    /// Puts facets that are sorted by face and target in the order of patches, and says which facets each patch has.
    pub(super) fn join(
        &mut self,
        scene: &PatchScene,
        forces: &[FacetForce],
        (by_face, order): (&[Place], &mut Vec<Place>),
        patches: &mut Vec<Range<usize>>,
    ) {
        self.find_runs(scene, forces, by_face);
        self.find_opposite(scene, by_face);
        order.clear();
        patches.clear();
        for (number, run) in (0..).zip(&self.runs) {
            if run.opposite < number {
                continue;
            }
            let start = order.len();
            order.extend_from_slice(&by_face[run.places.clone()]);
            if let Some(other) = self.runs.get(run.opposite as usize) {
                order.extend_from_slice(&by_face[other.places.clone()]);
            }
            patches.push(start..order.len());
        }
    }

    fn find_runs(&mut self, scene: &PatchScene, forces: &[FacetForce], by_face: &[Place]) {
        self.runs.clear();
        let mut start = 0;
        for places in by_face.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let (_, target, first) = places[0];
            let pressure = |t: u32| scene.sums(t).pressure.max(0.0);
            let total: f64 = places.iter().map(|&(_, _, t)| pressure(t)).sum();
            let mut direction = Vec3::zeros();
            if total > 0.0 && scene.law(places).is_some() {
                direction =
                    places.iter().map(|&(_, _, t)| pressure(t) / total * forces[t as usize].push).sum();
                direction = direction.try_normalize(0.0).unwrap_or_default();
            }
            let places = start..start + places.len();
            start = places.end;
            self.runs.push(Run { places, owner: scene.owner(first), target, direction, opposite: NONE });
        }
    }

    fn find_opposite(&mut self, scene: &PatchScene, by_face: &[Place]) {
        self.by_pair.clear();
        self.by_pair.extend((0..).zip(&self.runs).map(|(number, run)| {
            let (owner, target) = (run.owner, run.target);
            (owner.min(target), owner.max(target), number)
        }));
        self.by_pair.sort_unstable();
        for pair in self.by_pair.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let from_other = pair.partition_point(|&(lower, _, run)| self.runs[run as usize].owner == lower);
            let (own, others) = pair.split_at(from_other);
            for &(_, _, number) in own {
                let run = &self.runs[number as usize];
                let law = scene.law(&by_face[run.places.clone()]);
                let is_free = |other: &Run| {
                    let same_law = || match (law, scene.law(&by_face[other.places.clone()])) {
                        (Some(a), Some(b)) => std::ptr::addr_eq(a, b),
                        _ => false,
                    };
                    other.opposite == NONE && is_opposite(&run.direction, &other.direction) && same_law()
                };
                let along = |other: u32| run.direction.dot(&self.runs[other as usize].direction);
                let free = others.iter().map(|other| other.2).filter(|&k| is_free(&self.runs[k as usize]));
                if let Some(other) = free.min_by(|&a, &b| along(a).total_cmp(&along(b))) {
                    self.runs[number as usize].opposite = other;
                    self.runs[other as usize].opposite = number;
                }
            }
        }
    }
}

fn is_opposite(a: &Vec3, b: &Vec3) -> bool {
    a.dot(b) < 0.0 && a.cross(b).norm() < TILT
}
