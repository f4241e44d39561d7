//! The integrals of all candidate pairs, in parallel, many regions at a time.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use ndda_mesh::{BlockId, TetId, TriangleId};
use ndda_ranks::{Communicator, RanksError};
use pulp::Arch;
use rayon::prelude::*;

use crate::affine::half_spaces::HalfSpaces;
use crate::broad_phase::candidates::{Candidates, Facet};
use crate::broad_phase::finder::FEW_NODES;
use crate::friction::openings::moved_out;
use crate::integration::affine_target::{EvaluateHalfSpaces, PushRegions};
use crate::integration::chunk_parts::{Chunk, Results, Triangle};
use crate::integration::clip::Outline;
use crate::integration::function_moments::{Placed, add_function};
use crate::integration::overlap_pair::{ActiveFacet, ChunkFacet, FacetMoments, OverlapPair};
use crate::integration::pair_moments::{PairMoments, PsiRange};
use crate::integration::pair_report::OverlapReport;
use crate::integration::queue::RegionQueue;
use crate::integration::region::{Pieces, Region};
use crate::integration::scene::{Scene, are_on_one_side};
use crate::integration::shared_chunks::SharedChunks;
use crate::potential::contact_potential::PotentialField;
use crate::room::{copy_into, make_room};

/// Pairs of a chunk: one task for a thread. Where there are many, chunks are larger, since each has memory of its own, most of which is not used.
const CHUNK_PAIRS: usize = 512;
const MOST_CHUNK_PAIRS: usize = 4096;
/// Chunks from which on they grow.
const MANY_CHUNKS: usize = 1024;

/// Most chunks that a thread takes at a time: with more, one waits for the other at the end.
const MOST_CHUNKS: usize = 8;

/// A pair that may overlap.
struct PendingPair {
    tet: TetId,
    /// Place of its frame.
    slot: u32,
    /// λ_b of the target at the corners of the contactor's triangle, as `[b][a]`: where its force acts.
    lambda: [[f64; 3]; 4],
    /// Range of ψ where the contactor is a face.
    range: Option<PsiRange>,
    moments: PairMoments,
}

/// A facet with such pairs, and their places.
struct PendingFacet {
    facet: u32,
    triangle: TriangleId,
    target: BlockId,
    seen: Range<u32>,
}

/// Scratch memory of a thread for one chunk.
#[derive(Default)]
struct Scratch {
    results: Results,
    facets: Vec<PendingFacet>,
    seen: Vec<PendingPair>,
    region: Region,
    pieces: Pieces,
    sides: HalfSpaces,
    batches: RegionQueue,
}

impl Chunk {
    /// Integrates where chunks are very many: what is found is put together in the memory of the thread, and each chunk has room for little more.
    fn integrate_one_of_many(&mut self, arch: Arch, scene: &Scene, scratch: &mut Scratch) {
        self.swap(&mut scratch.results);
        self.integrate(arch, scene, scratch);
        self.swap(&mut scratch.results);
        let Results { overlaps, touching, sums } = &scratch.results;
        copy_into(&mut self.overlaps, overlaps);
        copy_into(&mut self.touching, touching);
        copy_into(&mut self.sums, sums);
    }

    fn swap(&mut self, results: &mut Results) {
        std::mem::swap(&mut self.overlaps, &mut results.overlaps);
        std::mem::swap(&mut self.touching, &mut results.touching);
        std::mem::swap(&mut self.sums, &mut results.sums);
    }

    fn integrate(&mut self, arch: Arch, scene: &Scene, scratch: &mut Scratch) {
        self.overlaps.clear();
        // A contact that closes further rarely requires more than a quarter.
        self.overlaps.reserve(self.pairs / 4);
        self.touching.clear();
        self.touching.reserve(self.facets.len());
        self.sums.clear();
        self.sums.reserve(self.facets.len());
        scratch.make_room(self.pairs, self.facets.len());
        let (mut block, mut at) = (self.first, self.facets.start);
        while at < self.facets.end {
            let end = scene.candidates.numbers_of(block).end.min(self.facets.end);
            if scene.hulls.may_touch(block) {
                scratch.look_at(arch, scene, (block, at..end));
            }
            (block, at) = (BlockId(block.0 + 1), end);
        }
        let Scratch { batches, seen, facets, .. } = scratch;
        batches.finish(arch, |part| seen[part.pair as usize].moments.add_region(part));
        self.take(scene, facets, seen);
    }

    /// Keeps what has an area, and the facets that have such hits; what is not a number stays to be reported.
    fn take(&mut self, scene: &Scene, facets: &[PendingFacet], seen: &mut [PendingPair]) {
        let Self { overlaps, touching, sums, report, .. } = self;
        *report = OverlapReport::default();
        for &PendingFacet { facet, triangle, target, seen: Range { start, end } } in facets {
            let (first, mut sum) = (overlaps.len(), FacetMoments::default());
            for seen in &mut seen[start as usize..end as usize] {
                seen.drop_rounding();
                let PendingPair { tet, slot, lambda, moments, .. } = seen;
                if moments.area != 0.0 {
                    let on_target = moments.on_target(lambda);
                    let overlap = OverlapPair { tet: *tet, slot: *slot, on_target };
                    report.add(triangle, &overlap, moments, scene);
                    sum.add(moments);
                    overlaps.push(overlap);
                }
            }
            let hits = (overlaps.len() - first) as u32;
            if hits > 0 {
                touching.push(ChunkFacet { facet, triangle, target, hits });
                sums.push(sum);
            }
        }
    }
}

impl PendingPair {
    fn drop_rounding(&mut self) {
        match &self.range {
            None => self.moments.drop_rounding(),
            Some(range) => self.moments.drop_rounding_within(range),
        }
    }
}

impl Scratch {
    /// Finds the regions of facets of one block.
    fn look_at(&mut self, arch: Arch, scene: &Scene, (owner, numbers): (BlockId, Range<u32>)) {
        let (mut last, mut corners, opens) = (None, Triangle::default(), !scene.openings.is_empty());
        let may_touch = |neighbours: u32| !scene.hulls.are_apart(neighbours);
        for facet in scene.candidates.facets_that(owner, numbers, may_touch) {
            // Facets of one triangle follow each other.
            if last != Some(facet.triangle) {
                (last, corners) = (Some(facet.triangle), Triangle::new(scene, facet.triangle));
            }
            let first = self.seen.len() as u32;
            if opens {
                self.add_opened_facet(arch, scene, &facet, &corners);
            } else {
                self.add_facet(arch, scene, &facet, &corners);
            }
            let seen = first..self.seen.len() as u32;
            if !seen.is_empty() {
                let Facet { number: facet, triangle, target, .. } = facet;
                self.facets.push(PendingFacet { facet, triangle, target, seen });
            }
        }
    }

    fn add_facet(&mut self, arch: Arch, scene: &Scene, facet: &Facet, triangle: &Triangle) {
        let Triangle { corners, normal, area } = triangle;
        if *area == 0.0 {
            return;
        }
        if scene.hulls.affine_target(facet.target).is_some() {
            return self.add_affine_target(arch, scene, facet, triangle);
        }
        scene.each_near_tet(arch, facet, (corners, normal), |tet, slot, frame, lambda| {
            let at = self.seen.len() as u32;
            let moments = PairMoments::default();
            self.seen.push(PendingPair { tet, slot, lambda: *lambda, range: None, moments });
            self.add_regions(arch, scene, at, &Placed { tet, frame, lambda, normal, area: *area });
        });
    }

    /// A facet of a scene in which joints open by slip: it is moved out before it is clipped, and its force acts where it is.
    #[inline(never)]
    fn add_opened_facet(&mut self, arch: Arch, scene: &Scene, facet: &Facet, triangle: &Triangle) {
        let opening_m = scene.openings.of(facet.triangle, facet.target);
        if opening_m == 0.0 {
            return self.add_facet(arch, scene, facet, triangle);
        }
        let first = self.seen.len();
        let corners = moved_out(&triangle.corners, &triangle.normal, opening_m);
        self.add_facet(arch, scene, facet, &Triangle { corners, ..*triangle });
        for pair in &mut self.seen[first..] {
            pair.lambda = scene.frames.at(pair.slot).lambda(&triangle.corners);
        }
    }

    /// A facet on a block that is an affine convex target.
    fn add_affine_target(
        &mut self,
        arch: Arch,
        scene: &Scene,
        facet: &Facet,
        Triangle { corners, normal, area }: &Triangle,
    ) {
        let nodes = scene.blocks.nodes_of(facet.target);
        let contactor = scene.hulls.contactor(facet.triangle, facet.target);
        let outline = contactor.map_or(&Outline::TRIANGLE, |face| &face.outline);
        let planes = scene.hulls.planes_of(facet.target);
        if !arch.dispatch(EvaluateHalfSpaces { sides: &mut self.sides, planes, corners, normal, outline })
            || (nodes.len() <= FEW_NODES
                && are_on_one_side(scene.position[nodes].iter(), &corners[0], normal))
        {
            return;
        }
        let (at, tet) = (self.seen.len() as u32, facet.first());
        let slot = scene.candidates.slot_of(tet).wrapping_add(scene.frames.shift_of(facet.target));
        let (lambda, range) = (scene.frames.at(slot).lambda(corners), contactor.map(|face| face.range));
        self.seen.push(PendingPair { tet, slot, lambda, range, moments: PairMoments::default() });
        let Self { sides, region, batches, .. } = self;
        arch.dispatch(PushRegions { sides, region, batches, outline, arch, at, area_m2: *area });
    }

    fn make_room(&mut self, pairs: usize, facets: usize) {
        self.facets.clear();
        self.facets.reserve(facets);
        let pairs = pairs.max(CHUNK_PAIRS);
        self.seen.clear();
        self.seen.reserve(pairs);
        self.batches.make_room(pairs);
    }

    fn add_regions(&mut self, arch: Arch, scene: &Scene, at: u32, placed: &Placed) {
        let Placed { tet, frame, lambda, normal, area } = *placed;
        match scene.field {
            PotentialField::Element => {
                self.batches.push_element(arch, at, area, lambda, &frame.slopes(normal));
            }
            PotentialField::Pieces(table) => {
                if self.pieces.set(lambda, table.of(tet), frame, normal) {
                    self.batches.push_pieces(arch, at, area, &self.pieces);
                }
            }
            PotentialField::Function(field) => {
                if self.pieces.set(lambda, field.regions.of(tet), frame, normal) {
                    let moments = &mut self.seen[at as usize].moments;
                    add_function(moments, field, &self.pieces, &mut self.region, placed);
                }
            }
        }
    }
}

/// All chunks of a scene; their memory is kept from step to step.
pub struct Integrals {
    arch: Arch,
    chunks: Vec<Chunk>,
    /// One for each thread.
    scratch: Vec<Mutex<Scratch>>,
    used: usize,
    touching: Vec<ActiveFacet>,
    /// The list that the chunks are of.
    list: Option<u64>,
    /// What ranks hand each other.
    shared: SharedChunks,
}

impl Default for Integrals {
    fn default() -> Self {
        Self {
            arch: Arch::new(),
            chunks: Vec::new(),
            scratch: Vec::new(),
            used: 0,
            touching: Vec::new(),
            list: None,
            shared: SharedChunks::default(),
        }
    }
}

impl Integrals {
    /// Integrates all pairs, on several ranks its part of them, and takes the rest from the others. The division into chunks depends on the list of
    /// pairs alone.
    ///
    /// # Errors
    /// [`RanksError`] when the ranks cannot go on.
    pub fn update(&mut self, scene: &Scene, ranks: Option<&dyn Communicator>) -> Result<(), RanksError> {
        let list = Some(scene.candidates.version);
        if self.list != list {
            self.divide(scene.candidates);
            self.list = list;
        }
        let (arch, used) = (self.arch, self.used);
        let threads = rayon::current_num_threads().max(self.scratch.len());
        self.scratch.resize_with(threads, Mutex::default);
        let own = ranks.map_or(0..used, |ranks| self.shared.divide(ranks, &self.chunks[..used]));
        let (chunks, scratch) = (&mut self.chunks[own], &self.scratch);
        let are_many = used > MANY_CHUNKS;
        let integrate = |chunk: &mut Chunk| {
            let own = &scratch[rayon::current_thread_index().unwrap_or(0)];
            let scratch = &mut own.lock().unwrap_or_else(PoisonError::into_inner);
            if are_many {
                chunk.integrate_one_of_many(arch, scene, scratch);
            } else {
                chunk.integrate(arch, scene, scratch);
            }
        };
        match chunks {
            [only] => integrate(only),
            many => many.par_iter_mut().with_max_len(MOST_CHUNKS).for_each(integrate),
        }
        if let Some(ranks) = ranks {
            self.shared.exchange(ranks, scene.candidates.version, &mut self.chunks[..used])?;
        }
        self.touching.clear();
        let used = &self.chunks[..used];
        make_room(&mut self.touching, used.iter().map(|chunk| chunk.touching.len()).sum());
        used.iter().for_each(|chunk| self.touching.extend(chunk.facets_in_touch(scene.blocks)));
        Ok(())
    }

    fn divide(&mut self, candidates: &Candidates) {
        let most = (candidates.pairs() / MANY_CHUNKS).clamp(CHUNK_PAIRS, MOST_CHUNK_PAIRS);
        self.used = 0;
        let mut pairs = most;
        for facet in candidates.facets() {
            let more = facet.pairs();
            if pairs + more > most {
                if self.used == self.chunks.len() {
                    self.chunks.push(Chunk::default());
                }
                let chunk = &mut self.chunks[self.used];
                (chunk.facets, chunk.first) = (facet.number..facet.number, facet.owner);
                chunk.number = self.used as u32;
                self.used += 1;
                pairs = 0;
            }
            pairs += more;
            let chunk = &mut self.chunks[self.used - 1];
            (chunk.facets.end, chunk.pairs) = (facet.number + facet.numbers(), pairs);
        }
    }

    /// The chunks in use, in the order of facets.
    pub(crate) fn chunks(&self) -> &[Chunk] {
        &self.chunks[..self.used]
    }

    /// The facets that touch, ascending.
    pub fn touching(&self) -> &[ActiveFacet] {
        &self.touching
    }

    /// Place among them of a facet with its target and, with memory per element, the element.
    pub(crate) fn place_of(&self, wanted: &(TriangleId, BlockId, Option<TetId>)) -> Option<usize> {
        let key = |touch: &ActiveFacet| {
            // With memory per element, all hits of a facet are in one.
            let element = wanted.2.map(|_| self.overlaps_of(touch)[0].tet);
            (touch.triangle, touch.target, element)
        };
        self.touching.binary_search_by_key(wanted, key).ok()
    }

    /// The hits of a facet that touches, in the order of pairs.
    pub fn overlaps_of(&self, touch: &ActiveFacet) -> &[OverlapPair] {
        let [start, end] = touch.overlaps.map(|k| k as usize);
        &self.chunks[touch.chunk as usize].overlaps[start..end]
    }

    /// Sums of the overlapping pairs of a facet in contact.
    pub(crate) fn sums_of(&self, touch: &ActiveFacet) -> &FacetMoments {
        &self.chunks[touch.chunk as usize].sums[touch.place as usize]
    }
}
