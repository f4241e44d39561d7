//! Linear functions in each tetrahedron, of which the smallest counts.

use std::ops::Range;

use ndda_mesh::TetId;

use crate::integration::capacity::MOST_CUTS;

/// Most linear functions of a tetrahedron: each is cut by four faces and by its rivals.
pub(crate) const MOST_PIECES: usize = 13;
const _: () = assert!(MOST_PIECES + 3 <= MOST_CUTS);

/// For each tetrahedron the nodal values of linear functions; φ is the smallest of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PieceTable {
    starts: Vec<u32>,
    values: Vec<[f64; 4]>,
    most: Vec<f64>,
}

impl PieceTable {
    /// A table without tetrahedra.
    pub fn new() -> Self {
        Self { starts: vec![0], ..Self::default() }
    }

    /// Adds the next tetrahedron, with at least one and at most 13 functions.
    pub fn push(&mut self, pieces: &[[f64; 4]]) {
        assert!((1..=MOST_PIECES).contains(&pieces.len()), "{} pieces in a tetrahedron", pieces.len());
        self.values.extend_from_slice(pieces);
        // φ is the smallest of them, so it is nowhere more than the largest value of any.
        let largest = |piece: &[f64; 4]| piece.iter().copied().fold(0.0, f64::max);
        self.most.push(pieces.iter().map(largest).fold(f64::INFINITY, f64::min));
        self.starts.push(self.values.len() as u32);
    }

    /// φ where it is the same everywhere.
    pub(crate) fn uniform(&self) -> Option<f64> {
        let first = self.values.first()?[0];
        self.values.iter().flatten().all(|&value| value == first).then_some(first)
    }

    /// Upper bound of φ in the tetrahedron: the largest value of a function at a corner, least over the functions.
    #[inline]
    pub fn most_in(&self, tet: TetId) -> f64 {
        self.most[tet.index()]
    }

    /// The functions of a tetrahedron.
    pub fn of(&self, tet: TetId) -> &[[f64; 4]] {
        let range: Range<usize> = self.starts[tet.index()] as usize..self.starts[tet.index() + 1] as usize;
        &self.values[range]
    }
}
