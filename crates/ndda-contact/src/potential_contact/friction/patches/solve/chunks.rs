//! Blocks in chunks, so that threads may look for the friction of patches side by side.
//!
//! Where patches are many, blocks are divided into chunks of numbers that follow each other. A group of patches is between blocks of one chunk, or of two.
//! Groups are coloured so that those of a colour have no chunk in common: they are worked on at once, and colours one after the other. Chunks, groups and colours
//! depend on the patches alone, so that results do not depend on the number of threads.

use std::sync::{Mutex, PoisonError};

use ndda_mesh::{BlockId, Vec3};

use crate::friction::patches::nodal::BlockSides;
use crate::friction::patches::solve::{CoupledPatch, Motion};
use crate::model::Body;

/// Patches of a chunk, and chunks below which there is only one: then their way to memory is too short for more.
const CHUNK_PATCHES: usize = 2048;
const FEWEST_CHUNKS: usize = 4;
const MOST_CHUNKS: usize = 48;
/// The colour of a group within a chunk; those of two come later.
const WITHIN: u8 = 0;

/// Patches that follow each other and are between the same chunks.
#[derive(Clone, Copy, Debug)]
struct Group {
    colour: u8,
    chunks: [u8; 2],
    patches: usize,
}

/// How blocks are divided into chunks, and patches into groups.
#[derive(Default)]
pub(crate) struct Division {
    /// First block of each chunk but the first; none where there is one chunk.
    starts: Vec<BlockId>,
    /// In the order of patches.
    groups: Vec<Group>,
    /// Colours of pairs of chunks, and the colours that each chunk has.
    colours: Vec<u8>,
    taken: Vec<u128>,
}

impl Division {
    /// Divides blocks for these patches: numbers of patches, and the blocks of each that may move, ascending by the first. Puts them in the order of groups.
    pub(crate) fn divide(&mut self, patches: &mut [u32], blocks_of: impl Fn(u32) -> [BlockId; 2]) {
        self.starts.clear();
        let chunks = (patches.len() / CHUNK_PATCHES).min(MOST_CHUNKS);
        if chunks < FEWEST_CHUNKS {
            return;
        }
        let start = |chunk: usize| blocks_of(patches[chunk * patches.len() / chunks])[0];
        self.starts.extend((1..chunks).map(start));
        self.starts.dedup();
        self.colour(patches, &blocks_of);
        patches.sort_by_cached_key(|&patch| self.place(blocks_of(patch)));
    }

    /// Finds colours, each pair of chunks taking the first that is free.
    fn colour(&mut self, patches: &[u32], blocks_of: &impl Fn(u32) -> [BlockId; 2]) {
        let chunks = self.starts.len() + 1;
        self.colours.clear();
        self.colours.resize(chunks * chunks, u8::MAX);
        self.taken.clear();
        self.taken.resize(chunks, 1 << WITHIN);
        for &patch in patches {
            let [a, b] = self.chunks_of(blocks_of(patch)).map(usize::from);
            if self.colours[a * chunks + b] == u8::MAX {
                let colour =
                    if a == b { WITHIN } else { (self.taken[a] | self.taken[b]).trailing_ones() as u8 };
                self.taken[a] |= 1 << colour;
                self.taken[b] |= 1 << colour;
                self.colours[a * chunks + b] = colour;
            }
        }
    }

    /// The chunks of two blocks, the smaller first.
    fn chunks_of(&self, blocks: [BlockId; 2]) -> [u8; 2] {
        let [a, b] = blocks.map(|block| self.starts.partition_point(|start| *start <= block) as u8);
        [a.min(b), a.max(b)]
    }

    /// Colour and chunks of a patch.
    fn place(&self, blocks: [BlockId; 2]) -> (u8, [u8; 2]) {
        let [a, b] = self.chunks_of(blocks);
        (self.colours[usize::from(a) * (self.starts.len() + 1) + usize::from(b)], [a, b])
    }

    /// How many groups there are; none where patches are visited one after the other.
    #[cfg(test)]
    pub(super) fn groups(&self) -> usize {
        self.groups.len()
    }

    /// Takes the groups of patches, which are in their order, from the blocks of each that may move.
    pub(crate) fn take_groups(&mut self, blocks: impl Iterator<Item = [BlockId; 2]>) {
        self.groups.clear();
        if self.starts.is_empty() {
            return;
        }
        for blocks in blocks {
            let (colour, chunks) = self.place(blocks);
            match self.groups.last_mut().filter(|group| group.chunks == chunks) {
                Some(group) => group.patches += 1,
                None => self.groups.push(Group { colour, chunks, patches: 1 }),
            }
        }
    }
}

/// Blocks whose numbers follow each other, and what moves of them.
pub(super) struct Chunk<'a> {
    /// Its first block, and the first of those that answer.
    first: u32,
    first_slot: u32,
    bodies: &'a mut [Body],
    sides: &'a [BlockSides],
    columns: &'a mut [Vec<Vec3>],
    /// When each block was pushed last.
    pushed: &'a mut [u32],
    /// Counts visits.
    now: u32,
    /// Results of the visits so far.
    pub found: Found,
}

/// Largest change of a visit: of a slip [m/s], and of friction as a multiple of what does not matter; none where no patch changed by more than that.
#[derive(Clone, Copy, Default)]
pub(super) struct Left {
    pub slip_m_s: f64,
    pub times: f64,
}

/// Results of visits.
#[derive(Clone, Copy, Default)]
pub(super) struct Found {
    /// Patches whose friction was looked for.
    pub visits: usize,
    pub left: Left,
    /// Sum over patches.
    pub sum: f64,
}

impl Found {
    fn join(self, other: Self) -> Self {
        let left = Left {
            slip_m_s: self.left.slip_m_s.max(other.left.slip_m_s),
            times: self.left.times.max(other.left.times),
        };
        Self { visits: self.visits + other.visits, left, sum: self.sum + other.sum }
    }
}

impl<'a> Chunk<'a> {
    fn whole<'m: 'a>(motion: &'a mut Motion<'m>) -> Self {
        let (sides, columns) = motion.nodal.blocks_mut();
        let now = motion.visits.now;
        let pushed = &mut motion.visits.pushed[..];
        let bodies = &mut *motion.bodies;
        Self { first: 0, first_slot: 0, bodies, sides, columns, pushed, now, found: Found::default() }
    }

    /// The blocks before one of them, and the rest, of which `slot` is the first that answers.
    fn split(self, block: u32, slot: u32) -> (Self, Self) {
        let (middle, middle_slot) = ((block - self.first) as usize, (slot - self.first_slot) as usize);
        let Self { first, first_slot, bodies, sides, columns, pushed, now, found } = self;
        let (bodies, other_bodies) = bodies.split_at_mut(middle);
        let (sides, other_sides) = sides.split_at(middle_slot);
        let (columns, other_columns) = columns.split_at_mut(middle_slot);
        let (pushed, other_pushed) = pushed.split_at_mut(middle);
        let rest = Chunk {
            first: block,
            first_slot: slot,
            bodies: other_bodies,
            sides: other_sides,
            columns: other_columns,
            pushed: other_pushed,
            now,
            found,
        };
        (Chunk { first, first_slot, bodies, sides, columns, pushed, now, found }, rest)
    }

    fn holds(&self, block: BlockId) -> bool {
        (block.0.wrapping_sub(self.first) as usize) < self.bodies.len()
    }
}

/// The chunks of the patches of a group.
pub(super) struct Place<'p, 'a> {
    own: &'p mut Chunk<'a>,
    other: Option<&'p mut Chunk<'a>>,
}

impl<'a> Place<'_, 'a> {
    /// The chunk of a block; none of one that does not move may be here.
    fn chunk_of(&mut self, block: BlockId) -> Option<&mut Chunk<'a>> {
        match &mut self.other {
            _ if self.own.holds(block) => Some(self.own),
            Some(other) if other.holds(block) => Some(other),
            _ => None,
        }
    }

    /// Slip of the side of a patch on a block; none where the block does not move and is not here.
    pub(super) fn slip(&mut self, patch: &CoupledPatch, k: usize) -> Option<Vec3> {
        let block = patch.blocks()[k];
        let chunk = self.chunk_of(block)?;
        Some(match &patch.sides[k] {
            Some(side) => {
                let slot = (side.slot - chunk.first_slot) as usize;
                side.slip(&chunk.sides[slot], &chunk.columns[slot])
            }
            None => patch.slip_of(&chunk.bodies[(block.0 - chunk.first) as usize], &patch.arms[k]),
        })
    }

    /// Adds what a force of a patch changes velocities by in `time_s`, which is `part` of the step.
    pub(super) fn push(&mut self, patch: &CoupledPatch, force: &Vec3, (time_s, part): (f64, f64)) {
        for (k, block) in patch.blocks().into_iter().enumerate() {
            let Some(chunk) = self.chunk_of(block) else { continue };
            let body = &mut chunk.bodies[(block.0 - chunk.first) as usize];
            let columns = match &patch.sides[k] {
                Some(side) => &mut chunk.columns[(side.slot - chunk.first_slot) as usize][..],
                None => &mut [],
            };
            patch.push_side(k, (body, columns), force, (time_s, part));
        }
    }

    /// When the blocks of a patch were pushed last.
    pub(super) fn pushed(&mut self, patch: &CoupledPatch) -> u32 {
        let [own, other] = patch.blocks();
        self.pushed_block(own).max(self.pushed_block(other))
    }

    fn pushed_block(&mut self, block: BlockId) -> u32 {
        self.chunk_of(block).map_or(0, |chunk| chunk.pushed[(block.0 - chunk.first) as usize])
    }

    /// The time of a visit, which is after all others of both chunks.
    pub(super) fn next(&mut self) -> u32 {
        let now = 1 + self.other.as_ref().map_or(0, |other| other.now).max(self.own.now);
        self.own.now = now;
        if let Some(other) = &mut self.other {
            other.now = now;
        }
        now
    }

    /// Notes that the patch that is visited pushes its blocks.
    pub(super) fn note_push(&mut self, patch: &CoupledPatch) {
        for block in patch.blocks() {
            if let Some(chunk) = self.chunk_of(block) {
                chunk.pushed[(block.0 - chunk.first) as usize] = chunk.now;
            }
        }
    }

    /// Results of the visits here so far.
    pub(super) fn found(&mut self) -> &mut Found {
        &mut self.own.found
    }
}

/// Works on each patch with the blocks that it pushes: in order, or the other way round.
pub(super) fn each_patch(
    patches: &mut [CoupledPatch],
    motion: &mut Motion,
    forward: bool,
    work: impl Fn(&mut CoupledPatch, &mut Place) + Sync,
) -> Found {
    let division = motion.division;
    if division.starts.is_empty() {
        let mut whole = Chunk::whole(motion);
        each_of_group(patches, Place { own: &mut whole, other: None }, forward, &work);
        let (now, found) = (whole.now, whole.found);
        motion.visits.now = now;
        return found;
    }
    let asked = motion.slots_of(&division.starts);
    let mut rest = Chunk::whole(motion);
    let mut chunks = Vec::with_capacity(asked.len() + 1);
    for (block, slot) in division.starts.iter().zip(asked) {
        let (chunk, others) = rest.split(block.0, slot);
        chunks.push(Mutex::new(chunk));
        rest = others;
    }
    chunks.push(Mutex::new(rest));
    let mut by_colour: Vec<_> = division.groups.chunk_by(|a, b| a.colour == b.colour).collect();
    let count = |groups: &[Group]| groups.iter().map(|group| group.patches).sum::<usize>();
    let mut left = patches;
    if !forward {
        by_colour.reverse();
    }
    for groups in by_colour {
        let (here, others) = if forward {
            left.split_at_mut(count(groups))
        } else {
            let at = left.len() - count(groups);
            let (others, here) = left.split_at_mut(at);
            (here, others)
        };
        each_group(groups, here, &chunks, forward, &work);
        left = others;
    }
    let (mut now, mut found) = (0, Found::default());
    for chunk in chunks {
        let chunk = chunk.into_inner().unwrap_or_else(PoisonError::into_inner);
        (now, found) = (chunk.now.max(now), found.join(chunk.found));
    }
    motion.visits.now = now;
    found
}

/// Works on groups that have no chunk in common.
fn each_group(
    groups: &[Group],
    patches: &mut [CoupledPatch],
    chunks: &[Mutex<Chunk>],
    forward: bool,
    work: &(impl Fn(&mut CoupledPatch, &mut Place) + Sync),
) {
    let [group] = groups else {
        let (head, tail) = groups.split_at(groups.len() / 2);
        let (first, rest) = patches.split_at_mut(head.iter().map(|group| group.patches).sum());
        rayon::join(
            || each_group(head, first, chunks, forward, work),
            || each_group(tail, rest, chunks, forward, work),
        );
        return;
    };
    let [a, b] = group.chunks.map(usize::from);
    let mut own = chunks[a].lock().unwrap_or_else(PoisonError::into_inner);
    let mut other = (a != b).then(|| chunks[b].lock().unwrap_or_else(PoisonError::into_inner));
    each_of_group(patches, Place { own: &mut own, other: other.as_deref_mut() }, forward, work);
}

fn each_of_group(
    patches: &mut [CoupledPatch],
    mut place: Place,
    forward: bool,
    work: &impl Fn(&mut CoupledPatch, &mut Place),
) {
    if forward {
        patches.iter_mut().for_each(|patch| work(patch, &mut place));
    } else {
        patches.iter_mut().rev().for_each(|patch| work(patch, &mut place));
    }
}
