//! Ranks that are processes, by MPI.

use mpi::Count;
use mpi::datatype::PartitionMut;
use mpi::topology::SimpleCommunicator;
use mpi::traits::*;
use ndda_ranks::{Communicator as Ranks, Gathered, RanksError, Topic, UntilEnded};

/// Bits of the length in the word that announces a message; the topic is above them.
const LENGTH_BITS: u32 = 56;
/// Most bytes that a call of MPI takes: it counts in 32 bits.
const MOST_BYTES: usize = 1 << 30;
/// Begins where something is.
static NOTHING: [u8; 1] = [0];

/// The processes that mpirun has started.
#[derive(Debug)]
pub struct MpiRanks {
    rank: usize,
    size: usize,
    exchanges: UntilEnded<()>,
}

impl MpiRanks {
    /// All of them.
    pub fn new() -> Self {
        let world = SimpleCommunicator::world();
        Self { rank: world.rank() as usize, size: world.size() as usize, exchanges: UntilEnded::new(()) }
    }

    /// Ends all processes at once.
    pub fn abort(code: i32) -> ! {
        SimpleCommunicator::world().abort(code)
    }

    fn gather(&self, topic: Topic, own: &[u8], all: &mut Gathered) -> Vec<u8> {
        // An empty vector points to where MPI takes a message for one that is in place already.
        let own = if own.is_empty() { &NOTHING[..0] } else { own };
        let world = SimpleCommunicator::world();
        let announced = (topic as u64) << LENGTH_BITS | own.len() as u64;
        let mut words = vec![0u64; self.size];
        world.all_gather_into(&announced, &mut words[..]);
        let lengths: Vec<usize> =
            words.iter().map(|word| (word & ((1 << LENGTH_BITS) - 1)) as usize).collect();
        all.ends.clear();
        let mut end = 0;
        all.ends.extend(lengths.iter().map(|length| {
            end += length;
            end
        }));
        all.bytes.resize(end, 0);
        if (1..=MOST_BYTES).contains(&end) {
            let counts: Vec<Count> = lengths.iter().map(|length| *length as Count).collect();
            let starts: Vec<Count> =
                all.ends.iter().zip(&lengths).map(|(end, length)| (end - length) as Count).collect();
            let mut parts = PartitionMut::new(&mut all.bytes[..], counts, starts);
            world.all_gather_varcount_into(own, &mut parts);
        } else {
            self.gather_in_pieces(own, &lengths, all);
        }
        words.iter().map(|word| (word >> LENGTH_BITS) as u8).collect()
    }

    /// Where there is more than MPI can count: each rank's message by itself, in pieces.
    fn gather_in_pieces(&self, own: &[u8], lengths: &[usize], all: &mut Gathered) {
        let world = SimpleCommunicator::world();
        for (rank, length) in lengths.iter().enumerate() {
            let message = &mut all.bytes[all.ends[rank] - length..all.ends[rank]];
            if rank == self.rank {
                message.copy_from_slice(own);
            }
            for piece in message.chunks_mut(MOST_BYTES) {
                world.process_at_rank(rank as i32).broadcast_into(piece);
            }
        }
    }
}

impl Ranks for MpiRanks {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, topic: Topic, own: &[u8], all: &mut Gathered) -> Result<(), RanksError> {
        self.exchanges.exchange(|()| {
            let topics = self.gather(topic, own, all);
            all.judge(topic, &topics)
        })
    }

    fn give_up(&self, why: &str) {
        // The topic itself is what fails.
        drop(self.exchange(Topic::GivenUp, why.as_bytes(), &mut Gathered::default()));
    }
}
