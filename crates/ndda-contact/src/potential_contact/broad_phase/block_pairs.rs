//! The pairs of one block: a word for each triangle and block that it may be in, where both are small.

use std::ops::Range;

use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId};

use crate::broad_phase::pair_run::{PairRun, Tets};

/// Triangles and targets that a word can tell apart, and tetrahedra of a target that it has bits for.
const FEW: usize = 1 << 8;
const FEW_TETS: u32 = 16;
/// Numbers before the words: the first triangle of the block, then for each target its first tetrahedron and its place in
/// [`Candidates::neighbours`](crate::broad_phase::Candidates::neighbours).
const HEAD: usize = 1;
const PER_TARGET: usize = 2;
/// Part of a list, 1 / this, by which it gets more room than it needs when it grows, so that blocks that come a bit nearer do not ask again.
const ROOM: usize = 4;

/// The pairs of a block's triangles, sorted by (triangle, tetrahedron).
#[derive(Clone, Debug)]
pub(super) enum BlockPairs {
    /// Targets, sorted, and for each run a word: the triangle from the block's first (8 bits), the target (8), and which of the target's
    /// tetrahedra from its first (16).
    Few { targets: u32, numbers: Vec<u32> },
    /// Runs as they are.
    Many(Vec<PairRun>),
}

impl Default for BlockPairs {
    fn default() -> Self {
        Self::Few { targets: 0, numbers: Vec::new() }
    }
}

impl PartialEq for BlockPairs {
    /// Whether the pairs are the same.
    fn eq(&self, other: &Self) -> bool {
        self.runs().eq(other.runs())
    }
}

impl BlockPairs {
    /// Number of runs.
    #[inline]
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Few { targets, numbers } => numbers.len().saturating_sub(words_from(*targets)),
            Self::Many(runs) => runs.len(),
        }
    }

    /// The runs, sorted.
    #[inline]
    pub(super) fn runs(&self) -> Runs<'_> {
        match self {
            Self::Few { numbers, .. } if numbers.is_empty() => Runs::NONE,
            Self::Few { targets, numbers } => {
                let (head, words) = numbers.split_at(words_from(*targets));
                Runs { head, words, many: &[] }
            }
            Self::Many(runs) => Runs { many: runs, ..Runs::NONE },
        }
    }

    /// Takes these runs of a block, sorted, in the place of all.
    pub(super) fn set(&mut self, runs: &[PairRun], blocks: &BlockSet, own: BlockId) {
        let (triangles, first_triangle) =
            (blocks.triangles_of(own).len(), blocks.triangles_of(own).start as u32);
        let Some(targets) = Targets::of(runs, blocks).filter(|_| triangles <= FEW) else {
            return self.set_many(runs);
        };
        if let Self::Many(_) = self {
            *self = Self::default();
        }
        let Self::Few { targets: count, numbers } = self else { return };
        *count = targets.count as u32;
        make_room(numbers, words_from(*count) + runs.len());
        numbers.push(first_triangle);
        for first in &targets.first[..targets.count] {
            numbers.extend([*first, 0]);
        }
        numbers.extend(runs.iter().map(|run| {
            let target = targets.place(tets_around(run, blocks).start as u32);
            let bits = run.bits << (run.first.0 - targets.first[target]);
            ((run.triangle.0 - first_triangle) << 24) | ((target as u32) << 16) | bits
        }));
    }

    fn set_many(&mut self, runs: &[PairRun]) {
        if let Self::Few { .. } = self {
            *self = Self::Many(Vec::new());
        }
        let Self::Many(list) = self else { return };
        make_room(list, runs.len());
        list.extend_from_slice(runs);
    }

    /// Visits a tetrahedron of each target, and its place in [`Candidates::neighbours`](crate::broad_phase::Candidates::neighbours); a target may come more
    /// than once.
    #[inline]
    pub(super) fn each_target_mut(&mut self, mut visit: impl FnMut(TetId, &mut u32)) {
        match self {
            Self::Few { targets, numbers } if !numbers.is_empty() => {
                let (head, _) = numbers.split_at_mut(words_from(*targets));
                head[HEAD..].chunks_exact_mut(PER_TARGET).for_each(|t| {
                    let (first, place) = t.split_at_mut(1);
                    visit(TetId(first[0]), &mut place[0]);
                });
            }
            Self::Few { .. } => {}
            Self::Many(runs) => runs.iter_mut().for_each(|run| visit(run.first, &mut run.neighbours)),
        }
    }

    /// How many tetrahedra [`targets`](Self::targets) gives.
    pub(super) fn count_targets(&self) -> usize {
        match self {
            Self::Few { targets, .. } => *targets as usize,
            Self::Many(runs) => runs.len(),
        }
    }

    /// A tetrahedron of each target; a target may come more than once.
    pub(super) fn targets(&self) -> impl Iterator<Item = TetId> + '_ {
        let Runs { head, many, .. } = self.runs();
        let few = head.get(HEAD..).unwrap_or(&[]).chunks_exact(PER_TARGET).map(|t| TetId(t[0]));
        few.chain(many.iter().map(PairRun::first))
    }

    /// Whether it is quick to see that it has pairs with the block of these tetrahedra.
    pub(super) fn has_target(&self, tets: &Range<usize>) -> bool {
        match self {
            Self::Few { targets, numbers } => {
                let first_of = |place: usize| numbers[HEAD + PER_TARGET * place] as usize;
                let (mut low, mut high) = (0, *targets as usize);
                while low < high {
                    let middle = low.midpoint(high);
                    if first_of(middle) < tets.start { low = middle + 1 } else { high = middle }
                }
                low < *targets as usize && first_of(low) == tets.start
            }
            Self::Many(_) => false,
        }
    }

    /// Visits the tetrahedra, some of them more than once, and counts the pairs.
    pub(super) fn mark(&self, mut visit: impl FnMut(TetId)) -> usize {
        let mut pairs = 0;
        let Runs { head, words, many } = self.runs();
        let mut seen = [0u32; FEW];
        for word in words {
            seen[target_of(*word)] |= word & BITS;
            pairs += (word & BITS).count_ones() as usize;
        }
        for (t, bits) in head.get(HEAD..).unwrap_or(&[]).chunks_exact(PER_TARGET).zip(seen) {
            PairRun { triangle: TriangleId(0), first: TetId(t[0]), bits, neighbours: 0 }
                .tets()
                .for_each(&mut visit);
        }
        for run in many {
            run.tets().for_each(&mut visit);
            pairs += run.pairs();
        }
        pairs
    }

    /// Memory on the heap [B].
    pub(super) fn heap_bytes(&self) -> usize {
        match self {
            Self::Few { numbers, .. } => numbers.capacity() * size_of::<u32>(),
            Self::Many(runs) => runs.capacity() * size_of::<PairRun>(),
        }
    }
}

/// Bits of a word that stand for tetrahedra.
const BITS: u32 = (1 << FEW_TETS) - 1;

#[inline]
fn target_of(word: u32) -> usize {
    (word >> FEW_TETS) as usize % FEW
}

/// Where words begin.
#[inline]
fn words_from(targets: u32) -> usize {
    HEAD + PER_TARGET * targets as usize
}

/// Empties a list and makes room for so many; the first time for no more, later for a part more.
fn make_room<T>(list: &mut Vec<T>, count: usize) {
    list.clear();
    if list.capacity() < count {
        let more = if list.capacity() == 0 { 0 } else { count / ROOM };
        list.reserve_exact(count + more);
    }
}

/// The tetrahedra of the block that a run is in.
fn tets_around(run: &PairRun, blocks: &BlockSet) -> Range<usize> {
    blocks.tets_of(blocks.tet_block[run.first.index()])
}

/// The first tetrahedra of the blocks that runs are in, ascending.
struct Targets {
    first: [u32; FEW],
    count: usize,
}

impl Targets {
    /// None where they are too many, or have too many tetrahedra.
    fn of(runs: &[PairRun], blocks: &BlockSet) -> Option<Self> {
        let mut targets = Self { first: [0; FEW], count: 0 };
        for run in runs {
            let tets = tets_around(run, blocks);
            if tets.len() > FEW_TETS as usize {
                return None;
            }
            let first = tets.start as u32;
            let place = targets.place(first);
            if targets.first[..targets.count].get(place) == Some(&first) {
                continue;
            }
            if targets.count == FEW {
                return None;
            }
            targets.first.copy_within(place..targets.count, place + 1);
            targets.first[place] = first;
            targets.count += 1;
        }
        Some(targets)
    }

    fn place(&self, first: u32) -> usize {
        self.first[..self.count].partition_point(|known| *known < first)
    }
}

/// The runs of a block, or some of them that follow each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Runs<'a> {
    head: &'a [u32],
    words: &'a [u32],
    many: &'a [PairRun],
}

impl<'a> Runs<'a> {
    pub(super) const NONE: Self = Self { head: &[], words: &[], many: &[] };

    /// The runs with these indices.
    #[inline]
    pub(super) fn within(self, numbers: Range<usize>) -> Self {
        match self.words {
            [] => Self { many: &self.many[numbers], ..self },
            words => Self { words: &words[numbers], ..self },
        }
    }

    /// Takes the first one off, and those after it that have the same triangle and target.
    #[inline]
    pub(super) fn next_facet(&mut self, are_split: bool) -> Option<FacetRuns<'a>> {
        if let Some((word, rest)) = self.words.split_first() {
            self.words = rest;
            return Some(FacetRuns { run: self.run_of(*word), more: &[] });
        }
        let (run, rest) = self.many.split_first()?;
        let same = |next: &&PairRun| {
            next.triangle == run.triangle && next.neighbours == run.neighbours && !are_split
        };
        let (more, others) = rest.split_at(rest.iter().take_while(same).count());
        self.many = others;
        Some(FacetRuns { run: *run, more })
    }

    #[inline]
    fn run_of(&self, word: u32) -> PairRun {
        let at = HEAD + PER_TARGET * target_of(word);
        let (bits, skipped) = (word & BITS, (word & BITS).trailing_zeros());
        PairRun {
            triangle: TriangleId(self.head[0] + (word >> 24)),
            first: TetId(self.head[at] + skipped),
            bits: bits >> skipped,
            neighbours: self.head[at + 1],
        }
    }
}

impl Iterator for Runs<'_> {
    type Item = PairRun;

    #[inline]
    fn next(&mut self) -> Option<PairRun> {
        self.next_facet(true).map(|facet| facet.run)
    }
}

/// A run, and more of the same triangle and target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FacetRuns<'a> {
    pub(super) run: PairRun,
    pub(super) more: &'a [PairRun],
}

impl<'a> FacetRuns<'a> {
    /// The tetrahedra, ascending.
    #[inline]
    pub(super) fn tets(&self) -> Tets<'a> {
        Tets::of(&self.run, self.more)
    }

    /// Number of pairs.
    #[inline]
    pub(super) fn pairs(&self) -> usize {
        self.run.pairs() + self.more.iter().map(PairRun::pairs).sum::<usize>()
    }

    /// Number of runs.
    #[inline]
    pub(super) fn len(&self) -> usize {
        1 + self.more.len()
    }
}
