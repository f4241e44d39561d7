//! The frames of a step: of the tetrahedra that a triangle may be in, where no face keeps their block from all others.

use ndda_mesh::BlockId;
use rayon::prelude::*;

use crate::affine::convex_target::ConvexBlocks;
use crate::broad_phase::candidates::Candidates;
use crate::integration::tet_frame::TetFrame;
use crate::model::{ContactError, ContactInput};

/// Frames below which a second thread costs more than it brings.
const GRAIN_FRAMES: usize = 512;
/// Up to so many candidates there is room for all of their frames from the start, so that a step allocates nothing.
const FEW: usize = 1 << 14;

/// Frames of candidate tetrahedra; none of blocks that a face keeps from all their neighbours, which nothing is in.
#[derive(Default)]
pub struct Frames {
    all: Vec<TetFrame>,
    /// Places in [`Candidates::tets`] of those that have one, and of the others.
    placed: Vec<u32>,
    others: Vec<u32>,
    /// For each block, the number added to an index into [`Candidates::tets`] to get the index into `all` (wrapping).
    shift: Vec<u32>,
}

impl Frames {
    /// Places the frames where the nodes are, after the blocks' faces.
    ///
    /// # Errors
    /// [`ContactError::CollapsedTet`] naming the first candidate without volume or heights, whether it gets a frame or not.
    pub fn place(
        &mut self,
        candidates: &Candidates,
        hulls: &ConvexBlocks,
        input: &ContactInput,
    ) -> Result<(), ContactError> {
        self.list(candidates, hulls, input);
        let blocks = input.blocks;
        let frame_of = |slot: u32| {
            let (tet, order) = (candidates.tets[slot as usize], &candidates.order[slot as usize]);
            TetFrame::in_order(&blocks.tet_corners(tet, input.position), order)
        };
        let lost = |frame: &TetFrame, slot: u32| {
            let is_sound = frame.volume_m3 > 0.0 && frame.has_heights();
            (!is_sound).then_some((slot, frame.volume_m3))
        };
        let place = |(frame, slot): (&mut TetFrame, &u32)| {
            *frame = frame_of(*slot);
            lost(frame, *slot)
        };
        let first = |a: (u32, f64), b: (u32, f64)| if a.0 < b.0 { a } else { b };
        let placed = self.all.par_iter_mut().zip(&self.placed).with_min_len(GRAIN_FRAMES);
        let others = self.others.par_iter().with_min_len(GRAIN_FRAMES);
        let lost = [
            placed.filter_map(place).reduce_with(first),
            others.filter_map(|slot| lost(&frame_of(*slot), *slot)).reduce_with(first),
        ];
        let Some((slot, volume_m3)) = lost.into_iter().flatten().reduce(first) else { return Ok(()) };
        let tet = candidates.tets[slot as usize];
        Err(ContactError::CollapsedTet { tet, block: blocks.tet_block[tet.index()], volume_m3 })
    }

    /// Which candidates have frames, and room for these.
    fn list(&mut self, candidates: &Candidates, hulls: &ConvexBlocks, input: &ContactInput) {
        self.placed.clear();
        self.others.clear();
        self.shift.clear();
        if candidates.pairs() > 0 {
            for block in input.blocks.ids() {
                let slots = candidates.slots_of(block);
                self.shift.push((self.placed.len() as u32).wrapping_sub(slots.start));
                let list = if hulls.may_touch(block) { &mut self.placed } else { &mut self.others };
                list.extend(slots);
            }
        }
        let (needed, candidates) = (self.placed.len(), candidates.tets.len());
        if self.all.capacity() < needed.max(candidates.min(FEW)) {
            let room = if candidates <= FEW { candidates } else { needed + needed / 4 };
            self.all.reserve_exact(room - self.all.len().min(room));
        }
        self.all.resize(needed, TetFrame::default());
    }

    /// The number added to the index of a tetrahedron of a block in [`Candidates::tets`] to get the index of its frame (wrapping).
    #[inline]
    pub(crate) fn shift_of(&self, block: BlockId) -> u32 {
        self.shift[block.index()]
    }

    /// The frame at a place.
    #[inline]
    pub fn at(&self, place: u32) -> &TetFrame {
        &self.all[place as usize]
    }
}
