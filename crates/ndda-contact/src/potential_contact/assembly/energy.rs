//! Potential energy: U = ∫_{A∩B} (φ_A + φ_B) dV of each pair of blocks.
//!
//! The element potential needs the surface pieces only (see [`pair`](crate::integration::tet_frame)), a volume is a sum over the
//! surface of the overlap, and any other potential is integrated over the overlaps of tetrahedra. Forces never need
//! U, except where its law is not linear; energies are requested when results are written.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, TetId, Vec3};
use ndda_ranks::{ExactSum, RanksError};
use pulp::Arch;
use rayon::prelude::*;

use crate::affine::convex_target::ConvexBlocks;
use crate::assembly::block_shares::{BlockShares, SHARE_BLOCKS, ShareScratch};
use crate::assembly::facet_energy;
use crate::assembly::overlap_parts::OverlapParts;
use crate::assembly::overlap_volumes::OverlapVolumes;
use crate::assembly::shared_overlaps::Shared;
use crate::friction::openings::Openings;
use crate::integration::integrals::Integrals;
use crate::integration::linear::Linear;
use crate::integration::polyhedron::{EmbeddedPolyhedron, Polyhedron, faces_of};
use crate::integration::tet_frame::TetFrame;
use crate::model::ContactInput;
use crate::potential::contact_potential::{OverlapLaw, PotentialField};
use crate::potential::function::FunctionField;
use crate::potential::piece_table::PieceTable;

/// Pairs below which a second thread costs more than it brings.
const GRAIN_PAIRS: usize = 512;
/// Pairs of blocks below which a second thread costs more than it brings.
const GRAIN_BLOCK_PAIRS: usize = 4;

/// U for each pair of blocks that may touch.
#[derive(Default)]
pub(crate) struct BlockOverlaps {
    /// (smaller, larger), ascending.
    pairs: Vec<(BlockId, BlockId)>,
    overlap_m3: Vec<f64>,
    /// The second block's part of it, where parts are found apart.
    second_m3: Vec<f64>,
    /// ∫ φ dA over the pieces of both surfaces [m²].
    pressure_m2: Vec<f64>,
    /// Place in `pairs` of each facet that touches.
    pair_of_touch: Vec<u32>,
    /// Volumes of overlaps.
    volumes: OverlapVolumes,
    shares: Vec<BlockShares>,
}

impl BlockOverlaps {
    /// U [m³] and ∫ φ dA over both surfaces [m²] of each touching facet's pair, as [`add_touching`](Self::add_touching) found them.
    pub(crate) fn of_touching(&self) -> impl Iterator<Item = (f64, f64)> {
        self.pair_of_touch.iter().map(|&k| (self.overlap_m3[k as usize], self.pressure_m2[k as usize]))
    }

    /// Penetration of the deepest pair over the smallest height of the tetrahedra that it touches, and a facet of it, as
    /// [`add_touching`](Self::add_touching) found them for a φ that is the same everywhere; none where nothing touches.
    pub(crate) fn deepest(&self) -> Option<(f64, usize)> {
        let (ratio, pair) = self.volumes.deepest()?;
        Some((ratio, self.pair_of_touch.iter().position(|&k| k == pair)?))
    }

    /// Σ w(U) [m³].
    pub(crate) fn energy_m3(&self, law: OverlapLaw) -> f64 {
        self.overlap_m3.iter().map(|&overlap| law.energy_m3(overlap)).collect::<ExactSum>().value()
    }

    /// Pairs of blocks and their w(U) [m³].
    pub(crate) fn each_energy_m3(&self, law: OverlapLaw) -> impl Iterator<Item = (BlockId, BlockId, f64)> {
        self.pairs.iter().zip(&self.overlap_m3).map(move |(&(a, b), &u)| (a, b, law.energy_m3(u)))
    }

    fn place(&self, a: BlockId, b: BlockId) -> Option<usize> {
        self.pairs.binary_search(&(a.min(b), a.max(b))).ok()
    }

    /// Makes room for these pairs of blocks, (smaller, larger).
    fn list(&mut self, pairs: impl Iterator<Item = (BlockId, BlockId)>) {
        self.pairs.clear();
        self.pairs.extend(pairs);
        self.pairs.sort_unstable();
        self.pairs.dedup();
        self.overlap_m3.clear();
        self.overlap_m3.resize(self.pairs.len(), 0.0);
    }

    /// U of any potential.
    pub(crate) fn integrate(
        &mut self,
        input: &ContactInput,
        parts: &OverlapParts,
        law: OverlapLaw,
    ) -> Result<(), RanksError> {
        let OverlapParts { candidates, field, hulls, .. } = *parts;
        match (field, law) {
            (_, OverlapLaw::Power { .. }) => self.add_touching(input, parts)?,
            (PotentialField::Element, _) => self.add_pieces(input, parts),
            (PotentialField::Pieces(table), _) => {
                let near = (0..).zip(&candidates.neighbours).filter(|(k, _)| !hulls.are_apart(*k));
                self.list(near.map(|(_, pair)| *pair));
                self.add_cells(&Cells { input, table, function: None, hulls })?;
            }
            (PotentialField::Function(field), _) => {
                self.list(candidates.neighbours.iter().copied());
                self.add_cells(&Cells { input, table: &field.regions, function: Some(field), hulls })?;
            }
        }
        Ok(())
    }

    /// Puts U of pairs of blocks between which facets are moved out in place of that of their overlap, which may be none.
    #[inline(never)]
    pub(crate) fn replace_opened(&mut self, input: &ContactInput, parts: &OverlapParts, openings: &Openings) {
        let mut opened: Vec<(BlockId, BlockId)> = openings.pairs(input.blocks).collect();
        opened.sort_unstable();
        opened.dedup();
        for &(a, b) in &opened {
            if let Some(place) = self.place(a, b) {
                self.overlap_m3[place] = 0.0;
            }
        }
        for touch in parts.integrals.touching() {
            let pair = (touch.owner.min(touch.target), touch.owner.max(touch.target));
            if opened.binary_search(&pair).is_ok()
                && let Some(place) = self.place(pair.0, pair.1)
            {
                self.overlap_m3[place] += facet_energy::energy_m3(touch, input, parts, openings);
            }
        }
    }

    /// U and ∫ φ dA of the pairs of blocks that touch.
    ///
    /// # Errors
    /// [`RanksError`] when ranks that share the work cannot go on.
    pub(crate) fn add_touching(
        &mut self,
        input: &ContactInput,
        parts: &OverlapParts,
    ) -> Result<(), RanksError> {
        let OverlapParts { integrals, field, hulls, .. } = *parts;
        self.list_touching(integrals);
        match field {
            _ if field.uniform().is_some() => {
                let twice_phi = 2.0 * field.uniform().unwrap_or(0.0);
                self.volumes.measure(input, integrals, &self.pair_of_touch, &mut self.overlap_m3);
                self.overlap_m3.iter_mut().for_each(|overlap| *overlap *= twice_phi);
            }
            PotentialField::Element => {
                let own = element_pieces(input.blocks.tets.len());
                self.add_cells(&Cells { input, table: &own, function: None, hulls })?;
            }
            PotentialField::Pieces(table) => {
                self.add_cells(&Cells { input, table, function: None, hulls })?
            }
            PotentialField::Function(field) => {
                self.add_cells(&Cells { input, table: &field.regions, function: Some(field), hulls })?;
            }
        }
        Ok(())
    }

    /// Makes room for the pairs that touch, and adds up ∫ φ dA of both surfaces.
    fn list_touching(&mut self, integrals: &Integrals) {
        let pairs = integrals.touching().iter();
        self.list(pairs.map(|touch| (touch.owner.min(touch.target), touch.owner.max(touch.target))));
        self.pressure_m2.clear();
        self.pressure_m2.resize(self.pairs.len(), 0.0);
        self.pair_of_touch.clear();
        for touch in integrals.touching() {
            let k = self.place(touch.owner, touch.target).expect("listed above");
            self.pair_of_touch.push(k as u32);
            self.pressure_m2[k] += integrals.sums_of(touch).pressure;
        }
    }

    /// The element potential, from the flux through surface pieces.
    fn add_pieces(&mut self, input: &ContactInput, parts: &OverlapParts) {
        let candidates = parts.candidates;
        self.list(candidates.neighbours.iter().copied());
        self.shares.resize_with(candidates.blocks().div_ceil(SHARE_BLOCKS), BlockShares::default);
        let place = |scratch: &mut ShareScratch, (number, shares): (usize, &mut BlockShares)| {
            let first = number * SHARE_BLOCKS;
            let last = (first + SHARE_BLOCKS).min(candidates.blocks());
            shares.integrate(input, parts, first..last, scratch);
        };
        let share_pairs = candidates.pairs() / self.shares.len().max(1);
        let grain = GRAIN_PAIRS.div_ceil(share_pairs.max(1));
        let shares = self.shares.par_iter_mut().enumerate().with_min_len(grain);
        shares.for_each_init(ShareScratch::default, place);
        // Both blocks' parts of a pair apart, so that it does not matter which comes first.
        self.second_m3.clear();
        self.second_m3.resize(self.pairs.len(), 0.0);
        for &(k, is_second, share_m3) in self.shares.iter().flat_map(|shares| &shares.of_pair) {
            let sums = if is_second { &mut self.second_m3 } else { &mut self.overlap_m3 };
            sums[k as usize] += share_m3;
        }
        self.overlap_m3.iter_mut().zip(&self.second_m3).for_each(|(first, second)| *first += second);
    }

    /// Any potential, over the overlaps of the cells of blocks that no face keeps apart.
    fn add_cells(&mut self, cells: &Cells) -> Result<(), RanksError> {
        let shared = Shared::new(cells.input.ranks, self.pairs.len());
        let own = shared.own();
        let room = || Box::new([Polyhedron::default(), Polyhedron::default()]);
        let pairs = self.overlap_m3[own.clone()].par_iter_mut().zip(&self.pairs[own]);
        let pairs = pairs.with_min_len(GRAIN_BLOCK_PAIRS);
        pairs.for_each_init(room, |room, (overlap, &(a, b))| *overlap = cells.overlap_of(a, b, room));
        shared.exchange(&mut self.overlap_m3)
    }
}

/// The four functions of the element potential in each tetrahedron.
fn element_pieces(tets: usize) -> PieceTable {
    let mut table = PieceTable::new();
    let own = [0, 1, 2, 3].map(|b| [0, 1, 2, 3].map(|c| if b == c { 4.0 } else { 0.0 }));
    (0..tets).for_each(|_| table.push(&own));
    table
}

/// Cells of the blocks: an affine convex target is one cell, others consist of their tetrahedra.
struct Cells<'a> {
    input: &'a ContactInput<'a>,
    table: &'a PieceTable,
    /// φ where it is not the smallest of the table's functions.
    function: Option<&'a FunctionField>,
    hulls: &'a ConvexBlocks,
}

impl Cells<'_> {
    /// U of two blocks: every pair of their cells whose boxes touch.
    fn overlap_of(&self, a: BlockId, b: BlockId, room: &mut [Polyhedron; 2]) -> f64 {
        let block_box = |block| Aabb::around(&self.input.position[self.input.blocks.nodes_of(block)]);
        let (mut a, mut b, mut box_a, mut box_b) = (a, b, block_box(a), block_box(b));
        // Their roles differ, so that the sum would round otherwise if the scene listed them the other way round: places tell them apart.
        let place = |bounds: &Aabb| [bounds.min, bounds.max].map(|corner| [corner.x, corner.y, corner.z]);
        if place(&box_b) < place(&box_a) {
            std::mem::swap(&mut a, &mut b);
            std::mem::swap(&mut box_a, &mut box_b);
        }
        // Near the overlap, so that map coordinates lose no digits.
        let origin = box_a.min.sup(&box_b.min);
        let (of_a, of_b) =
            (self.near((a, &box_a), (b, &box_b), &origin), self.near((b, &box_b), (a, &box_a), &origin));
        let mut sum = 0.0;
        for (k, c) in of_a.iter().enumerate() {
            let within = of_b.iter().take_while(|t| t.bounds.min.x <= c.bounds.max.x);
            let is_new = |at: usize| a != b || at > k;
            for (_, t) in within.enumerate().filter(|(at, t)| is_new(*at) && t.bounds.touches(&c.bounds)) {
                sum += c.overlap_with(t, self.function, room);
            }
        }
        sum
    }

    /// The cells of a block that may reach into another, from left to right, seen from `origin`; blocks come with their boxes.
    fn near(
        &self,
        (block, own): (BlockId, &Aabb),
        (other, around): (BlockId, &Aabb),
        origin: &Vec3,
    ) -> Vec<Cell<'_>> {
        let (blocks, position) = (self.input.blocks, self.input.position);
        if let Some(whole) = self.hulls.affine_target(block) {
            let phi = self.hulls.faces_of(block).iter().map(|face| face.linear(origin)).collect();
            let host = blocks.tet_corners(whole.host, position).map(|x| x - origin);
            return vec![Cell { bounds: *own, shape: Shape::AffineConvexTarget(&whole.shape, host), phi }];
        }
        let arch = Arch::new();
        let near = |tet: usize| {
            let corners = blocks.tet_corners(TetId(tet as u32), position);
            let bounds = Aabb::around(&corners);
            let values = || self.table.of(TetId(tet as u32));
            let reaches = bounds.touches(around) && !self.hulls.keep_apart(arch, other, &corners);
            reaches.then(|| Cell::of_tet((TetId(tet as u32), &corners), values(), bounds, origin))
        };
        let mut near: Vec<_> = blocks.tets_of(block).filter_map(near).collect();
        near.sort_by(|x, y| x.bounds.min.x.total_cmp(&y.bounds.min.x));
        near
    }
}

/// A convex part of a block, in which φ is the smallest of linear functions.
struct Cell<'a> {
    bounds: Aabb,
    shape: Shape<'a>,
    phi: Vec<Linear>,
}

/// Shape of a cell, relative to an origin.
enum Shape<'a> {
    /// A tetrahedron with these corners, in which these functions are not negative.
    Tet(TetId, [Vec3; 4], [Linear; 4]),
    /// A block that is an affine convex target, and the corners of its host; φ itself is not negative in it.
    AffineConvexTarget(&'a EmbeddedPolyhedron, [Vec3; 4]),
}

impl Cell<'_> {
    fn of_tet((tet, corners): (TetId, &[Vec3; 4]), values: &[[f64; 4]], bounds: Aabb, origin: &Vec3) -> Self {
        let frame = TetFrame::new(corners);
        let phi = values.iter().map(|values| Linear::of_corners(&frame, values, origin)).collect();
        let shape = Shape::Tet(tet, corners.map(|x| x - origin), faces_of(&frame, origin));
        Self { bounds, shape, phi }
    }

    /// Linear functions that are non-negative in the cell.
    fn sides(&self) -> &[Linear] {
        match &self.shape {
            Shape::Tet(_, _, sides) => sides,
            Shape::AffineConvexTarget(..) => &self.phi,
        }
    }

    /// ∫ (φ + φ_t) dV over the overlap with t.
    fn overlap_with(
        &self,
        t: &Self,
        function: Option<&FunctionField>,
        [overlap, part]: &mut [Polyhedron; 2],
    ) -> f64 {
        match &self.shape {
            Shape::Tet(_, corners, _) => overlap.set_tet(corners),
            Shape::AffineConvexTarget(body, host) => overlap.set_embedded(body, host),
        }
        for side in t.sides() {
            overlap.cut(side);
            if overlap.is_empty() {
                return 0.0;
            }
        }
        self.integral_over(overlap, function, part) + t.integral_over(overlap, function, part)
    }

    /// ∫ φ dV over a part of it.
    fn integral_over(
        &self,
        overlap: &Polyhedron,
        function: Option<&FunctionField>,
        part: &mut Polyhedron,
    ) -> f64 {
        match (&self.shape, function) {
            (Shape::Tet(tet, _, lambda), Some(field)) => {
                let phi = |x: &Vec3| field.function.phi(*tet, &lambda.map(|l| l.at(x)));
                let over = |_, part: &Polyhedron| part.integral_of(&field.rule, &phi);
                overlap.sum_where_smallest(&self.phi, part, over)
            }
            _ => overlap.integral_of_smallest(&self.phi, part),
        }
    }
}
