//! Processes that run one scene together (*ranks*): what they hand each other, and who does what.
//!
//! Every rank has the whole scene and the same state. The costly loops of a step are divided among them ([`divide`]); each rank packs what it
//! has found ([`Packer`]), hands it to all others ([`Communicator::exchange`]) and unpacks what they found ([`Unpacker`]). Numbers travel as they
//! are, and every sum is taken afterwards in the order in which one process takes it: results have the same bits on any number of ranks. Sums over blocks do not depend on their order ([`ExactSum`]).
//!
//! ```
//! use ndda_ranks::{Communicator, Gathered, Threads, Topic};
//!
//! let ranks = Threads::group(3).into_iter().map(|rank| {
//!     std::thread::spawn(move || {
//!         let mut all = Gathered::default();
//!         rank.exchange(Topic::Decision, &[rank.rank() as u8], &mut all).map(|()| all.of(2).to_vec())
//!     })
//! });
//! for rank in ranks.collect::<Vec<_>>() {
//!     assert_eq!(rank.join().unwrap(), Ok(vec![2]));
//! }
//! ```

#![warn(unreachable_pub)]

mod communicator;
mod divide;
mod exact_sum;
mod packing;
mod threads;
mod until_ended;

pub use communicator::{Alone, Communicator, Gathered, RanksError, Topic, agree};
pub use divide::{divide, share};
pub use exact_sum::ExactSum;
pub use packing::{Packed, Packer, Unpacker};
pub use threads::Threads;
pub use until_ended::UntilEnded;
