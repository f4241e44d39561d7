//! Faces that lie on each other: two blocks that touch with flat faces have one patch, not one on either face.
//!
//! Both faces see the same slip, so which of the two would carry how much of a sticking friction is nearly undetermined, and
//! Gauss–Seidel over both would hardly converge. Their pressures add up to that of one patch, whose friction is found once. Where one of both faces
//! has parts (`parts.rs`), each part is a patch, and the facets of the other face are left without friction: those of the parts have all of it.

use std::ops::Range;

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, Vec3};
use rayon::prelude::*;

use crate::friction::facet::FacetForce;
use crate::friction::law::FrictionLaw;
use crate::friction::patches::parts::{FaceParts, number_of, was_divided};
use crate::friction::patches::patch::PatchFacets;
use crate::friction::patches::{GRAIN_PATCHES, PatchScene, Place};
use crate::model::ContactHistory;
use crate::room::make_room;

/// Faces whose normals are opposite but for so much lie on each other: the sine of about 8°.
const TILT: f64 = 0.14;
/// Force on other faces than one, over the force on that one, up to which each face of two convex blocks has its own friction, as faces have that lie on each other and
/// are a little deep in each other with their edges; from twice that on the one has the friction of all.
const BESIDE: f64 = 0.01;
/// No run.
const NONE: u32 = u32::MAX;

/// The facets of one face on one block, in a row.
#[derive(Clone, Debug)]
struct Run {
    places: Range<u32>,
    owner: BlockId,
    target: BlockId,
    /// Its normal force on its owner [N]; the direction of that, zero where it has no friction, and ∫ φ dA.
    force_n: Vec3,
    direction: Vec3,
    pressure: f64,
    /// The run that lies on it.
    opposite: u32,
    /// Factor on the normal force in Coulomb's law.
    weight: f64,
}

impl Run {
    /// Its facets in the list of all.
    fn of<'a>(&self, by_face: &'a [Place]) -> &'a [Place] {
        &by_face[self.places.start as usize..self.places.end as usize]
    }
}

/// (Lower block, other block, run, the run that lies on it.)
type PairRun = (BlockId, BlockId, u32, u32);

/// Facets by patch, found from facets by face and target.
#[derive(Default)]
pub(super) struct Opposite {
    runs: Vec<Run>,
    by_pair: Vec<PairRun>,
    /// For each block, the place in `by_pair` for the next run whose pair has it as the lower block.
    starts: Vec<u32>,
    /// Runs whose weight is not one, with it.
    weights: Vec<(u32, f64)>,
}

impl Opposite {
    /// Puts facets that are sorted by face and target in the order of patches, and says which facets each patch has.
    pub(super) fn join(
        &mut self,
        scene: &PatchScene,
        (forces, history): (&[FacetForce], &ContactHistory),
        (by_face, order): (&[Place], &mut Vec<Place>),
        (faces, patches): (&FaceParts, &mut Vec<PatchFacets>),
    ) {
        self.find_runs(scene, forces, by_face);
        self.find_opposite(scene, by_face);
        self.weigh(scene, by_face);
        order.clear();
        make_room(order, by_face.len());
        patches.clear();
        make_room(patches, self.runs.iter().zip(0..).filter(|(run, number)| run.opposite >= *number).count());
        let mut joined = Joined { scene, history, faces, by_face, order, patches };
        for (number, run) in (0..).zip(&self.runs) {
            if run.opposite >= number {
                joined.add(run, self.runs.get(run.opposite as usize));
            }
        }
    }

    fn find_runs(&mut self, scene: &PatchScene, forces: &[FacetForce], by_face: &[Place]) {
        let of_one_run = |a: &Place, b: &Place| (a.0, a.1) == (b.0, b.1);
        self.runs.clear();
        make_room(&mut self.runs, by_face.chunk_by(of_one_run).count());
        let mut start = 0;
        for places in by_face.chunk_by(of_one_run) {
            let (_, target, first) = places[0];
            let places = start..start + places.len() as u32;
            start = places.end;
            let (owner, zero) = (scene.owner(first), Vec3::zeros());
            let (force_n, direction, pressure) = (zero, zero, 0.0);
            self.runs.push(Run {
                places,
                owner,
                target,
                force_n,
                direction,
                pressure,
                opposite: NONE,
                weight: 1.0,
            });
        }
        let press = |run: &mut Run| {
            let places = run.of(by_face);
            let pressure = |t: u32| scene.sums(t).pressure.max(0.0);
            let total: f64 = places.iter().map(|&(_, _, t)| pressure(t)).sum();
            run.pressure = total;
            if total > 0.0 {
                let push = |&(_, _, t): &Place| pressure(t) / total * forces[t as usize].push;
                let push_pa: Vec3 = places.iter().map(push).sum();
                run.force_n = total * push_pa;
                if scene.law(places).is_some() {
                    run.direction = push_pa.try_normalize(0.0).unwrap_or_default();
                }
            }
        };
        if self.runs.len() > GRAIN_PATCHES {
            self.runs.par_iter_mut().with_min_len(GRAIN_PATCHES).for_each(press);
        } else {
            self.runs.iter_mut().for_each(press);
        }
    }

    /// Lists runs by the lower block of their pair, those of a block in the order of runs.
    fn list_by_lower_block(&mut self, blocks: usize) {
        let Self { runs, by_pair, starts, .. } = self;
        starts.clear();
        starts.resize(blocks + 1, 0);
        runs.iter().for_each(|run| starts[run.owner.min(run.target).index() + 1] += 1);
        (0..blocks).for_each(|block| starts[block + 1] += starts[block]);
        by_pair.clear();
        make_room(by_pair, runs.len());
        by_pair.resize(runs.len(), (BlockId(0), BlockId(0), 0, NONE));
        for (number, run) in (0..).zip(&*runs) {
            let (lower, higher) = (run.owner.min(run.target), run.owner.max(run.target));
            let next = &mut starts[lower.index()];
            by_pair[*next as usize] = (lower, higher, number, NONE);
            *next += 1;
        }
    }

    fn find_opposite(&mut self, scene: &PatchScene, by_face: &[Place]) {
        self.list_by_lower_block(scene.input.blocks.len());
        let Self { runs, by_pair, .. } = self;
        let all = &*runs;
        let of_pair = |pair: &mut [PairRun]| {
            let from_other = pair.partition_point(|&(lower, _, run, _)| all[run as usize].owner == lower);
            let (own, others) = pair.split_at_mut(from_other);
            if others.is_empty() {
                return;
            }
            for (_, _, number, opposite) in own {
                let run = &all[*number as usize];
                let law = scene.law(run.of(by_face));
                let is_free = |&(_, _, other, taken): &PairRun| {
                    let other = &all[other as usize];
                    taken == NONE
                        && is_opposite(&run.direction, &other.direction)
                        && is_same_law(law, scene.law(other.of(by_face)))
                };
                let along = |other: u32| run.direction.dot(&all[other as usize].direction);
                let free = others.iter_mut().filter(|other| is_free(other));
                if let Some(other) = free.min_by(|a, b| along(a.2).total_cmp(&along(b.2))) {
                    (*opposite, other.3) = (other.2, *number);
                }
            }
        };
        let of_block = |of_lower: &mut [PairRun]| {
            of_lower.sort_unstable_by_key(|(_, higher, run, _)| (*higher, *run));
            of_lower.chunk_by_mut(|a, b| a.1 == b.1).for_each(of_pair);
        };
        if by_pair.len() > GRAIN_PATCHES {
            by_pair.par_chunk_by_mut(|a, b| a.0 == b.0).for_each(of_block);
        } else {
            by_pair.chunk_by_mut(|a, b| a.0 == b.0).for_each(of_block);
        }
        for &(_, _, run, opposite) in &*by_pair {
            runs[run as usize].opposite = opposite;
        }
    }
}

impl Opposite {
    /// Where an edge or a corner is in a face, the faces beside it slip only as deep as they are in it, and the face that is pressed along the force between the blocks bears
    /// the friction of all. Two convex blocks touch in one region, whose normal that is; so do others where one of them presses with faces along the force alone, and then all
    /// of these bear friction. Faces of several laws keep their own.
    fn weigh(&mut self, scene: &PatchScene, by_face: &[Place]) {
        let Self { runs, by_pair, weights, .. } = self;
        weights.clear();
        for pair in by_pair.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|pair| pair.len() > 1) {
            let law = |(_, _, run, _): &PairRun| scene.law(runs[*run as usize].of(by_face));
            let first = law(&pair[0]);
            let has_one_region = scene.hulls.is_convex(pair[0].0) && scene.hulls.is_convex(pair[0].1);
            if !pair.iter().all(|run| is_same_law(law(run), first)) {
                continue;
            }
            let between = Between::new(runs, pair);
            if (has_one_region || between.is_flat())
                && let Some((bears, own, others)) = between.bearers(has_one_region)
            {
                let heads = pair.iter().filter(|(_, _, run, opposite)| opposite >= run);
                weights.extend(heads.map(|patch| (patch.2, if bears(patch) { own } else { others })));
            }
        }
        weights.iter().for_each(|(run, weight)| runs[*run as usize].weight = *weight);
    }
}

/// The normal forces between two blocks.
struct Between<'a> {
    runs: &'a [Run],
    pair: &'a [PairRun],
    /// Their sum on the lower block [N].
    whole_n: Vec3,
}

impl<'a> Between<'a> {
    fn new(runs: &'a [Run], pair: &'a [PairRun]) -> Self {
        let mut between = Self { runs, pair, whole_n: Vec3::zeros() };
        between.whole_n = pair.iter().map(|(_, _, run, _)| between.on_lower_n(*run)).sum();
        between
    }

    fn on_lower_n(&self, run: u32) -> Vec3 {
        let Run { owner, force_n, .. } = &self.runs[run as usize];
        if *owner == self.pair[0].0 { *force_n } else { -force_n }
    }

    /// The force of a patch: of its run, and of the one that lies on it.
    fn joined_n(&self, &(_, _, run, opposite): &PairRun) -> Vec3 {
        self.on_lower_n(run) + if opposite == NONE { Vec3::zeros() } else { self.on_lower_n(opposite) }
    }

    fn is_along(&self, force_n: &Vec3) -> bool {
        force_n.dot(&self.whole_n) > 0.0
            && force_n.cross(&self.whole_n).norm() < TILT * force_n.norm() * self.whole_n.norm()
    }

    /// Whether all faces with which one of the blocks presses are pressed along the force, but for what hardly counts.
    fn is_flat(&self) -> bool {
        let is_lower = |run: u32| self.runs[run as usize].owner == self.pair[0].0;
        [true, false].into_iter().any(|lower| {
            let (mut along_n, mut beside_n) = (0.0, 0.0);
            for &(_, _, run, _) in self.pair.iter().filter(|(_, _, run, _)| is_lower(*run) == lower) {
                let force_n = self.on_lower_n(run);
                let sum = if self.is_along(&force_n) { &mut along_n } else { &mut beside_n };
                *sum += force_n.norm();
            }
            along_n > 0.0 && beside_n <= 2.0 * BESIDE * along_n
        })
    }

    /// Which patches bear friction, the largest of those that are pressed along the force or all of them, with their weight and that of the others; none where no patch does, or
    /// others hardly count.
    fn bearers(&self, largest: bool) -> Option<(impl Fn(&PairRun) -> bool, f64, f64)> {
        let (mut best, mut most_n, mut along_n, mut all_n) = (None, 0.0, 0.0, 0.0);
        for patch in self.pair.iter().filter(|(_, _, run, opposite)| opposite >= run) {
            let force_n = self.joined_n(patch);
            let size_n = force_n.norm();
            all_n += size_n;
            if self.is_along(&force_n) {
                along_n += size_n;
                if best.is_none() || size_n > most_n {
                    (best, most_n) = (Some(patch.2), size_n);
                }
            }
        }
        let best = best?;
        let own_n = if largest { most_n } else { along_n };
        let part = ((all_n - own_n) / own_n / BESIDE - 1.0).min(1.0);
        let bears = move |patch: &PairRun| {
            if largest { patch.2 == best } else { self.is_along(&self.joined_n(patch)) }
        };
        (part > 0.0).then(|| (bears, 1.0 + part * (self.whole_n.norm() / own_n - 1.0), 1.0 - part))
    }
}

/// Patches that are put one after the other.
struct Joined<'a> {
    scene: &'a PatchScene<'a>,
    history: &'a ContactHistory,
    faces: &'a FaceParts,
    by_face: &'a [Place],
    order: &'a mut Vec<Place>,
    patches: &'a mut Vec<PatchFacets>,
}

impl Joined<'_> {
    /// Adds the patch, or the patches, of a run and the one that lies on it, if there is one.
    fn add(&mut self, run: &Run, other: Option<&Run>) {
        let (face, target, _) = run.of(self.by_face)[0];
        let runs = || std::iter::once(run).chain(other);
        let start = self.order.len();
        let Some(divided) = self.divided(runs(), (face, target)) else {
            runs().for_each(|run| self.order.extend_from_slice(run.of(self.by_face)));
            return self.put(start, run, (number_of(face, None), run.weight));
        };
        for rest in runs().filter(|run| run.owner != divided.owner) {
            self.order.extend_from_slice(rest.of(self.by_face));
            self.put(start, run, (number_of(face, None), 0.0));
        }
        let total: f64 = runs().map(|run| run.pressure).sum();
        let part = |place: &Place| self.faces.part_of(self.scene.touch(place.2).triangle);
        let first = self.order.len();
        self.order.extend_from_slice(divided.of(self.by_face));
        self.order[first..].sort_unstable_by_key(|place| (part(place), place.2));
        let mut start = first as u32;
        for places in self.order[first..].chunk_by(|a, b| part(a) == part(b)) {
            let (places, face) =
                (start..start + places.len() as u32, number_of(face, Some(part(&places[0]))));
            start = places.end;
            let weight = run.weight * total / divided.pressure;
            self.patches.push(PatchFacets { places, face, target, owner: run.owner, weight });
        }
    }

    /// The run whose face has parts, if there is friction and it does not touch all over, or did not in a step before: that of the smaller face.
    fn divided<'r>(
        &self,
        runs: impl Iterator<Item = &'r Run>,
        (remembered, target): (u32, BlockId),
    ) -> Option<&'r Run> {
        let face = |run: &Run| run.of(self.by_face)[0].0;
        let area_m2 = |run: &Run| self.faces.area_m2(face(run));
        let run = runs.min_by(|a, b| area_m2(a).total_cmp(&area_m2(b)))?;
        // Without answers of nodes blocks count as rigid.
        if self.scene.input.deformation.is_none()
            || area_m2(run).is_infinite()
            || run.direction == Vec3::zeros()
        {
            return None;
        }
        if was_divided(self.history, remembered, target) {
            return Some(run);
        }
        let areas_m2 = run.of(self.by_face).iter().map(|place| {
            let corners = self
                .scene
                .input
                .blocks
                .triangle_corners(self.scene.touch(place.2).triangle, self.scene.input.position);
            [self.scene.sums(place.2).area, triangle_area_vector(&corners).norm()]
        });
        (!self.faces.is_closed(face(run), areas_m2)).then_some(run)
    }

    /// Makes a patch of the facets from a place on, under the face of a run.
    fn put(&mut self, start: usize, &Run { owner, target, .. }: &Run, (face, weight): (u32, f64)) {
        let places = start as u32..self.order.len() as u32;
        self.patches.push(PatchFacets { places, face, target, owner, weight });
    }
}

/// Whether both are there, and one and the same.
fn is_same_law(a: Option<&dyn FrictionLaw>, b: Option<&dyn FrictionLaw>) -> bool {
    matches!((a, b), (Some(a), Some(b)) if std::ptr::addr_eq(a, b))
}

fn is_opposite(a: &Vec3, b: &Vec3) -> bool {
    a.dot(b) < 0.0 && a.cross(b).norm() < TILT
}
