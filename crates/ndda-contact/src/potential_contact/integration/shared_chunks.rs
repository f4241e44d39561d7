//! What ranks hand each other of the chunks that they have integrated.

use std::ops::Range;

use ndda_mesh::{BlockId, TetId, TriangleId};
use ndda_ranks::{Communicator, Gathered, Packed, Packer, RanksError, Topic, Unpacker, divide, share};

use crate::integration::chunk_parts::Chunk;
use crate::integration::overlap_pair::{ChunkFacet, FacetMoments, OverlapPair};
use crate::integration::pair_moments::OnTarget;
use crate::integration::pair_report::OverlapReport;

/// Work of an overlapping pair over that of one that is rejected.
const HIT: u64 = 10;

/// Who integrates which chunks, and memory for the exchange.
#[derive(Default)]
pub(super) struct SharedChunks {
    starts: Vec<usize>,
    packer: Packer,
    all: Gathered,
}

/// A facet that touches: facet, triangle, target, and how many hits.
type PackedFacet = [u32; 4];

impl SharedChunks {
    /// The chunks of this rank. Weights are the pairs of a chunk and, ten times, the hits that it had last, which all ranks know.
    pub(super) fn divide(&mut self, ranks: &dyn Communicator, chunks: &[Chunk]) -> Range<usize> {
        let weights = chunks.iter().map(|chunk| chunk.pairs as u64 + HIT * chunk.overlaps.len() as u64);
        self.starts = divide(weights, ranks.size());
        share(&self.starts, ranks.rank())
    }

    /// Takes the chunks of the others from them; `list` says which list of pairs the chunks are of.
    pub(super) fn exchange(
        &mut self,
        ranks: &dyn Communicator,
        list: u64,
        chunks: &mut [Chunk],
    ) -> Result<(), RanksError> {
        let Self { starts, packer, all } = self;
        let head = |rank: usize| {
            let own = share(starts, rank);
            [list, own.start as u64, own.end as u64]
        };
        packer.clear();
        packer.put(&head(ranks.rank()));
        chunks[share(starts, ranks.rank())].iter().for_each(|chunk| pack(chunk, packer));
        ranks.exchange(Topic::Pairs, packer.bytes(), all)?;
        for rank in (0..ranks.size()).filter(|rank| *rank != ranks.rank()) {
            let mut found = Unpacker::new(all.of(rank));
            if found.take::<[u64; 3]>() != head(rank) {
                return Err(RanksError::OutOfStep { rank });
            }
            chunks[share(starts, rank)].iter_mut().for_each(|chunk| unpack(chunk, &mut found));
        }
        Ok(())
    }
}

fn pack(chunk: &Chunk, packer: &mut Packer) {
    packer.put(&[chunk.touching.len() as u32, chunk.overlaps.len() as u32]);
    packer.put_each(&chunk.touching, |touch| -> PackedFacet {
        [touch.facet, touch.triangle.0, touch.target.0, touch.hits]
    });
    packer.put_each(&chunk.overlaps, |overlap| *overlap);
    packer.put_each(&chunk.sums, |sums| *sums);
    packer.put(&chunk.report);
}

fn unpack(chunk: &mut Chunk, found: &mut Unpacker) {
    let [touching, overlaps] = found.take::<[u32; 2]>().map(|count| count as usize);
    let facet = |[facet, triangle, target, hits]: PackedFacet| ChunkFacet {
        facet,
        triangle: TriangleId(triangle),
        target: BlockId(target),
        hits,
    };
    fill(&mut chunk.touching, touching, found.take_each(touching).map(facet));
    fill(&mut chunk.overlaps, overlaps, found.take_each(overlaps));
    fill(&mut chunk.sums, touching, found.take_each(touching));
    chunk.report = found.take();
}

/// Puts so many entries in the place of others, with room for an eighth more where there is too little.
fn fill<T>(list: &mut Vec<T>, count: usize, entries: impl Iterator<Item = T>) {
    list.clear();
    if list.capacity() < count {
        list.reserve_exact(count + count / 8);
    }
    list.extend(entries);
}

impl Packed for OverlapPair {
    const BYTES: usize = 2 * 4 + 8 * 8;

    #[inline(always)]
    fn write(&self, to: &mut [u8]) {
        let Self { tet, slot, on_target } = self;
        [tet.0, *slot].write(to);
        on_target.pressure.write(&mut to[8..]);
        on_target.slope.write(&mut to[40..]);
    }

    #[inline(always)]
    fn read(from: &[u8]) -> Self {
        let [tet, slot] = <[u32; 2]>::read(from);
        let on_target = OnTarget { pressure: Packed::read(&from[8..]), slope: Packed::read(&from[40..]) };
        Self { tet: TetId(tet), slot, on_target }
    }
}

impl Packed for FacetMoments {
    const BYTES: usize = 8 * 8;

    #[inline(always)]
    fn write(&self, to: &mut [u8]) {
        let Self { pressure, weights: [a, b, c], slope: [d, e, f], area } = *self;
        [pressure, a, b, c, d, e, f, area].write(to);
    }

    #[inline(always)]
    fn read(from: &[u8]) -> Self {
        let [pressure, a, b, c, d, e, f, area] = Packed::read(from);
        Self { pressure, weights: [a, b, c], slope: [d, e, f], area }
    }
}

/// A triangle and a tetrahedron, or none.
fn place(pair: Option<(TriangleId, TetId)>) -> [u32; 3] {
    pair.map_or([0; 3], |(triangle, tet)| [1, triangle.0, tet.0])
}

fn placed([is_some, triangle, tet]: [u32; 3]) -> Option<(TriangleId, TetId)> {
    (is_some == 1).then_some((TriangleId(triangle), TetId(tet)))
}

impl Packed for OverlapReport {
    const BYTES: usize = 2 * 8 + 6 * 4;

    fn write(&self, to: &mut [u8]) {
        [self.action_reaction_error, self.max_penetration_ratio].write(to);
        place(self.deepest).write(&mut to[16..]);
        place(self.lost).write(&mut to[28..]);
    }

    fn read(from: &[u8]) -> Self {
        let [action_reaction_error, max_penetration_ratio] = Packed::read(from);
        let (deepest, lost) = (placed(Packed::read(&from[16..])), placed(Packed::read(&from[28..])));
        Self { action_reaction_error, max_penetration_ratio, deepest, lost }
    }
}
