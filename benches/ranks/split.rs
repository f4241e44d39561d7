//! Blocks to ranks by recursive coordinate bisection: halves of equal work, along the longest side.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};

/// The rank of each block; none for blocks that never move, which all ranks have.
pub struct Owners {
    /// How many ranks.
    pub ranks: usize,
    of_block: Vec<Option<usize>>,
}

/// A block: number, centre, tetrahedra.
type Place = (BlockId, Vec3, usize);

impl Owners {
    /// Blocks where they are now, split.
    pub fn new(simulation: &Simulation, ranks: usize) -> Self {
        let (blocks, position) = (simulation.blocks(), &simulation.state().position);
        let moves = |block: &BlockId| simulation.shape(*block).kind != BodyKind::Fixed;
        let place = |block| {
            let nodes = &position[blocks.nodes_of(block)];
            (block, nodes.iter().sum::<Vec3>() / nodes.len() as f64, blocks.tets_of(block).len())
        };
        let mut places: Vec<Place> = blocks.ids().filter(moves).map(place).collect();
        let mut owners = Self { ranks, of_block: vec![None; blocks.len()] };
        owners.split(&mut places, 0, ranks);
        owners
    }

    /// Gives blocks to `ranks` ranks from `first` on.
    fn split(&mut self, places: &mut [Place], first: usize, ranks: usize) {
        if ranks == 1 {
            places.iter().for_each(|place| self.of_block[place.0.index()] = Some(first));
            return;
        }
        let bounds = Aabb::around(places.iter().map(|place| &place.1));
        let axis = (bounds.max - bounds.min).imax();
        places.sort_by(|a, b| a.1[axis].total_cmp(&b.1[axis]).then(a.0.cmp(&b.0)));
        let lower = ranks / 2;
        let goal = places.iter().map(|place| place.2).sum::<usize>() * lower / ranks;
        let mut sum = 0;
        let middle = places.iter().take_while(|place| (sum += place.2, sum <= goal).1).count();
        let (head, tail) = places.split_at_mut(middle);
        self.split(head, first, lower);
        self.split(tail, first + lower, ranks - lower);
    }

    /// The rank that owns a block.
    pub fn of(&self, block: BlockId) -> Option<usize> {
        self.of_block[block.index()]
    }

    /// Number of blocks of a rank.
    pub fn blocks_of(&self, rank: usize) -> usize {
        self.of_block.iter().filter(|owner| **owner == Some(rank)).count()
    }
}
