//! By how much facets are moved out before they are clipped, because their joints have opened by slip.
//!
//! A joint opens by millimetres and blocks overlap by micrometres: a facet that was clipped where it is would lose its contact. Each facet of a joint that has
//! opened by v is therefore moved out by v along its normal and then clipped, so that the pressure is that of the depth h + v, where h is the overlap of the blocks,
//! negative while they are apart. Forces act on the facet where it is, so that both blocks feel them at one place. What is remembered of a facet outlives its contact
//! while the two are near each other: walls that part and meet again still ride on each other.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, TriangleId, Vec3};

use crate::friction::law_table::FrictionLawTable;
use crate::model::{ContactHistory, ContactInput, FacetMemory};

/// A joint's walls are near each other while boxes around them are no farther apart than this many openings.
const NEAR: f64 = 2.0;

/// Which opening of a facet counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moment {
    /// That at which it was clipped last.
    Last = 0,
    /// That at which it is to be clipped next.
    Next = 1,
}

/// Openings of all facets that have one.
#[derive(Debug, Default)]
pub struct Openings {
    /// Facet, target, and the openings of both moments; sorted by facet and target.
    of_facet: Vec<(TriangleId, BlockId, [f64; 2])>,
    moment: usize,
    most_m: f64,
}

impl Openings {
    /// Takes the openings from what facets remember.
    pub(crate) fn take(
        &mut self,
        joints: Option<&FrictionLawTable>,
        blocks: &BlockSet,
        history: &ContactHistory,
        moment: Moment,
    ) {
        self.of_facet.clear();
        (self.moment, self.most_m) = (moment as usize, 0.0);
        let Some(joints) = joints.filter(|joints| joints.dilate()) else { return };
        for (place, memory) in history.facets.iter().enumerate() {
            let both_m = openings_m(joints, blocks, (memory, history.state_of(place)));
            if both_m != [0.0; 2] {
                self.of_facet.push((memory.facet, memory.target, both_m));
                self.most_m = self.most_m.max(both_m[self.moment]);
            }
        }
    }

    /// Whether no facet is moved out.
    pub(crate) fn is_empty(&self) -> bool {
        self.of_facet.is_empty()
    }

    /// The largest opening [m].
    pub(crate) fn most_m(&self) -> f64 {
        self.most_m
    }

    /// By how much a facet is moved out in its contact with a block [m].
    pub(crate) fn of(&self, facet: TriangleId, target: BlockId) -> f64 {
        self.both_m(facet, target)[self.moment]
    }

    /// Whether the joint of a facet has opened by slip.
    pub(crate) fn have(&self, facet: TriangleId, target: BlockId) -> bool {
        !self.is_empty() && self.both_m(facet, target) != [0.0; 2]
    }

    fn both_m(&self, facet: TriangleId, target: BlockId) -> [f64; 2] {
        let place = self.of_facet.binary_search_by_key(&(facet, target), |&(f, t, _)| (f, t));
        place.map_or([0.0; 2], |place| self.of_facet[place].2)
    }

    /// Pairs of blocks, (smaller, larger), between which a facet is moved out; pairs may come more than once.
    pub(crate) fn pairs<'a>(&'a self, blocks: &'a BlockSet) -> impl Iterator<Item = (BlockId, BlockId)> + 'a {
        self.of_facet.iter().map(|&(facet, target, _)| {
            let owner = blocks.triangle_block[facet.index()];
            (owner.min(target), owner.max(target))
        })
    }
}

/// Openings of a facet, by moment [m].
fn openings_m(
    joints: &FrictionLawTable,
    blocks: &BlockSet,
    (memory, state): (&FacetMemory, &[f64]),
) -> [f64; 2] {
    let law = joints.law(blocks, memory.facet, memory.target).filter(|law| law.dilates());
    law.map_or([0.0; 2], |law| law.openings_m(&state[..law.state_len()]))
}

/// Corners of a facet, moved out along its normal [m].
pub(crate) fn moved_out(corners: &[Vec3; 3], normal: &Vec3, opening_m: f64) -> [Vec3; 3] {
    corners.map(|corner| corner + opening_m * normal)
}

/// Whether a facet that does not touch its target keeps what it remembers: it has opened by slip, and the two are near each other still.
pub(crate) fn is_kept(
    joints: &FrictionLawTable,
    input: &ContactInput,
    (memory, state): (&FacetMemory, &[f64]),
) -> bool {
    let opening_m = openings_m(joints, input.blocks, (memory, state))[Moment::Next as usize];
    if opening_m <= 0.0 {
        return false;
    }
    let corners = input.blocks.triangle_corners(memory.facet, input.position);
    let target = Aabb::around(&input.position[input.blocks.nodes_of(memory.target)]);
    Aabb::around(&corners).inflated(NEAR * opening_m).touches(&target)
}
