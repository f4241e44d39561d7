//! Forces of contact on nodes, those of each block summed by one of the ranks.

use std::ops::Range;

use ndda_mesh::Vec3;
use ndda_ranks::{Communicator, Gathered, Packer, RanksError, Topic, Unpacker, divide, share};

use crate::assembly::nodal_forces::{ScatterScene, add_blocks, split};
use crate::model::ContactOutput;

/// Memory of what ranks hand each other.
#[derive(Default)]
pub(crate) struct SharedForces {
    packer: Packer,
    all: Gathered,
}

impl SharedForces {
    /// Adds all forces to the nodes, those on its share of the blocks by itself. Shares have about as many facets, on blocks of their own and on others.
    ///
    /// # Errors
    /// [`RanksError`] when the ranks cannot go on.
    pub(crate) fn add(
        &mut self,
        ranks: &dyn Communicator,
        scene: &ScatterScene,
        output: &mut ContactOutput,
    ) -> Result<(), RanksError> {
        let touches = |block: usize| scene.adjacency.count(&(block..block + 1));
        let weights = (0..scene.blocks.len()).map(|block| touches(block) as u64);
        let starts = divide(weights, ranks.size());
        let own = share(&starts, ranks.rank());
        add_blocks(scene, own.clone(), nodes_of(scene, output, &own));
        self.packer.clear();
        for block in own.filter(|block| touches(*block) > 0) {
            let ContactOutput { force, friction_force, stiffness } =
                nodes_of(scene, output, &(block..block + 1));
            self.packer.put_each(force, |f| <[f64; 3]>::from(*f));
            self.packer.put_each(friction_force, |f| <[f64; 3]>::from(*f));
            self.packer.put_each(stiffness, |k| *k);
        }
        ranks.exchange(Topic::Forces, self.packer.bytes(), &mut self.all)?;
        for rank in (0..ranks.size()).filter(|rank| *rank != ranks.rank()) {
            let mut found = Unpacker::new(self.all.of(rank));
            for block in share(&starts, rank).filter(|block| touches(*block) > 0) {
                let ContactOutput { force, friction_force, stiffness } =
                    nodes_of(scene, output, &(block..block + 1));
                found.take_into(force, |v: [f64; 3]| Vec3::from(v));
                found.take_into(friction_force, |v: [f64; 3]| Vec3::from(v));
                found.take_into(stiffness, |k| k);
            }
        }
        Ok(())
    }
}

/// The nodes of some blocks.
fn nodes_of<'a>(
    scene: &ScatterScene,
    output: &'a mut ContactOutput,
    blocks: &Range<usize>,
) -> ContactOutput<'a> {
    let starts = scene.blocks.node_starts();
    let [start, end] = [blocks.start, blocks.end].map(|block| starts[block] as usize);
    let ContactOutput { force, friction_force, stiffness } = output;
    let all = ContactOutput { force, friction_force, stiffness };
    split(split(all, end).0, start).1
}
