//! The broad phase: which triangles of one block may meet which elements of another.

pub(crate) mod block_bvh;
mod block_pairs;
pub(crate) mod bvh;
pub(crate) mod candidates;
pub(crate) mod finder;
pub(crate) mod neighbour_list;
pub(crate) mod pair_lists;
mod pair_run;
pub mod testing;
mod tet_faces;

pub use bvh::TreeBroadPhase;
pub use candidates::{Candidates, Facet};
pub use finder::{AllPairs, BroadPhase, BroadScene};
pub use pair_lists::PairLists;
pub use pair_run::{PairRun, Tets};
