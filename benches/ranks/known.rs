//! Data of one rank: its own blocks, copies of those near them, and all that never move.

use std::collections::BTreeSet;

use ndda_contact::broad_phase::Candidates;
use ndda_contact::testing::{Answer, evaluate};
use ndda_contact::{ContactHistory, ContactInput, ContactModel, Coulomb, PotentialContact, SmoothPotential};
use ndda_mesh::{BlockId, BlockMesh, BlockSet, Vec3};

use crate::split::Owners;

/// The blocks of a rank, in the order of their numbers: then pairs, facets and sums come in the same order as they do
/// where all blocks are.
pub struct Known {
    blocks: Vec<BlockId>,
    set: BlockSet,
}

impl Known {
    /// Data of `rank`.
    pub fn of(rank: usize, owners: &Owners, candidates: &Candidates, all: &BlockSet) -> Self {
        let own = |block: &BlockId| owners.of(*block).is_none_or(|owner| owner == rank);
        let mut known: BTreeSet<BlockId> = all.ids().filter(own).collect();
        for facet in candidates.facets() {
            let ends = [facet.owner, facet.target];
            if ends.iter().any(|end| owners.of(*end) == Some(rank)) {
                known.extend(ends);
            }
        }
        let blocks: Vec<BlockId> = known.into_iter().collect();
        let mesh = |&block: &BlockId| (all.names[block.index()].clone(), mesh_of(all, block));
        let set = BlockSet::new(blocks.iter().map(mesh).collect()).expect("blocks that were sound before");
        Self { blocks, set }
    }

    /// Panics unless contact among these blocks gives those of the rank the forces that contact among all gives them.
    pub fn assert_same_bits(&self, rank: usize, owners: &Owners, input: &ContactInput) {
        let here = |values: &[Vec3]| -> Vec<Vec3> {
            let of_block = |block: &BlockId| values[input.blocks.nodes_of(*block)].to_vec();
            self.blocks.iter().flat_map(of_block).collect()
        };
        let (position, velocity) = (here(input.position), here(input.velocity));
        let part = forces(&ContactInput::new(&self.set, &position, &velocity, input.dt_s));
        let whole = forces(input);
        for (place, &block) in self.blocks.iter().enumerate().filter(|(_, b)| owners.of(**b) == Some(rank)) {
            let (mine, theirs) = (self.set.nodes_of(BlockId(place as u32)), input.blocks.nodes_of(block));
            let same = part.force[mine.clone()] == whole.force[theirs.clone()]
                && part.friction_force[mine.clone()] == whole.friction_force[theirs.clone()]
                && part.stiffness[mine] == whole.stiffness[theirs];
            assert!(same, "rank {rank} of {} finds other forces on block {block:?}", owners.ranks);
        }
    }
}

/// Forces by the potential of the scene, with friction by springs: friction on velocities asks a second time.
fn forces(input: &ContactInput) -> Answer {
    let potential = Box::new(SmoothPotential { reference_m: 1.0 });
    let model = PotentialContact::new(5e8).with_potential(potential);
    let mut model: Box<dyn ContactModel> = Box::new(model.with_friction(Box::new(Coulomb::new(30.0, 5e8))));
    evaluate(model.as_mut(), input, &mut ContactHistory::default())
}

fn mesh_of(all: &BlockSet, block: BlockId) -> BlockMesh {
    BlockMesh {
        nodes: all.rest_position[all.nodes_of(block)].to_vec(),
        tets: all.local_tets(block).collect(),
        ..BlockMesh::default()
    }
}
