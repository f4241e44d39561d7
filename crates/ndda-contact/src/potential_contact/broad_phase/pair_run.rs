//! A triangle and up to 32 tetrahedra of one block.

use ndda_mesh::{TetId, TriangleId};

/// Tetrahedra that one run can have.
const MOST_TETS: u32 = u32::BITS;

/// A boundary triangle and those of 32 tetrahedra in a row, all of one block, that it may be in.
#[derive(Clone, Copy, Debug)]
pub struct PairRun {
    /// The contactor's triangle.
    pub triangle: TriangleId,
    /// The first tetrahedron.
    pub(super) first: TetId,
    /// Bit i stands for the i-th tetrahedron from the first.
    pub(super) bits: u32,
    /// Place of both blocks in [`Candidates::neighbours`](crate::broad_phase::Candidates::neighbours).
    pub(super) neighbours: u32,
}

impl PartialEq for PairRun {
    /// Whether the pairs are the same.
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key() && self.bits == other.bits
    }
}

impl PairRun {
    /// One pair.
    pub(super) fn one(triangle: TriangleId, tet: TetId) -> Self {
        Self { triangle, first: tet, bits: 1, neighbours: 0 }
    }

    /// The first tetrahedron; the others are of the same block.
    #[inline]
    pub fn first(&self) -> TetId {
        self.first
    }

    /// Number of pairs.
    #[inline]
    pub(super) fn pairs(&self) -> usize {
        self.bits.count_ones() as usize
    }

    /// Key by which runs are sorted; pairs are then sorted as well.
    #[inline]
    pub(super) fn key(&self) -> (TriangleId, TetId) {
        (self.triangle, self.first)
    }

    /// The tetrahedra, ascending.
    #[inline]
    pub fn tets(&self) -> Tets<'static> {
        Tets { first: self.first.0, bits: self.bits, rest: [].iter() }
    }

    /// Takes a later tetrahedron of the same block in, if there is room for it.
    #[inline]
    pub(super) fn takes(&mut self, tet: TetId) -> bool {
        let place = tet.0 - self.first.0;
        self.bits |= 1u32.checked_shl(place).unwrap_or(0);
        place < MOST_TETS
    }
}

/// The tetrahedra of runs that follow each other.
#[derive(Clone, Debug)]
pub struct Tets<'a> {
    first: u32,
    bits: u32,
    rest: std::slice::Iter<'a, PairRun>,
}

impl<'a> Tets<'a> {
    /// The tetrahedra of `run`, then those of `rest`.
    #[inline]
    pub(super) fn of(run: &PairRun, rest: &'a [PairRun]) -> Self {
        Self { first: run.first.0, bits: run.bits, rest: rest.iter() }
    }
}

impl Iterator for Tets<'_> {
    type Item = TetId;

    #[inline]
    fn next(&mut self) -> Option<TetId> {
        while self.bits == 0 {
            let run = self.rest.next()?;
            (self.first, self.bits) = (run.first.0, run.bits);
        }
        let next = TetId(self.first + self.bits.trailing_zeros());
        self.bits &= self.bits - 1;
        Some(next)
    }
}
