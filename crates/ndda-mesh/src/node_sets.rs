//! Named node sets of many blocks, in flat arrays: most blocks of rock have the same few names.

use std::collections::HashMap;

use crate::{BlockId, NodeId};

/// The node sets of all blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct NodeSets {
    /// Names of the sets.
    pub(crate) names: Vec<String>,
    /// Name of each set, and where its nodes end; block by block.
    sets: Vec<(u32, u32)>,
    nodes: Vec<NodeId>,
    /// Where the sets of each block end.
    end: Vec<u32>,
}

impl NodeSets {
    /// Adds the sets of the next block: the number of each name, and its nodes counted from the block's first.
    pub(crate) fn push<'a>(
        &mut self,
        sets: impl Iterator<Item = (u32, &'a [u32])>,
        global: impl Fn(u32) -> NodeId,
    ) {
        for (name, nodes) in sets {
            self.nodes.extend(nodes.iter().map(|&node| global(node)));
            self.sets.push((name, self.nodes.len() as u32));
        }
        self.end.push(self.sets.len() as u32);
    }

    /// The sets of a block, in the order in which they came.
    pub(crate) fn of_block(&self, block: BlockId) -> impl Iterator<Item = (&str, &[NodeId])> {
        let first = block.index().checked_sub(1).map_or(0, |before| self.end[before] as usize);
        (first..self.end[block.index()] as usize).map(|k| {
            let from = k.checked_sub(1).map_or(0, |before| self.sets[before].1 as usize);
            let (name, to) = self.sets[k];
            (self.names[name as usize].as_str(), &self.nodes[from..to as usize])
        })
    }
}

/// Names, each once, and their numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct NameIndex {
    /// In the order in which they came.
    pub(crate) list: Vec<String>,
    place: HashMap<String, u32>,
}

impl NameIndex {
    /// Number of a name.
    pub(crate) fn of(&mut self, name: &str) -> u32 {
        if let Some(&place) = self.place.get(name) {
            return place;
        }
        let place = self.list.len() as u32;
        self.list.push(name.into());
        self.place.insert(name.into(), place);
        place
    }
}
