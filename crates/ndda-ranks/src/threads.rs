//! Ranks that are threads of one process, for tests: they have no memory in common but the channels between them.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::communicator::{Communicator, Gathered, RanksError, Topic};
use crate::until_ended::UntilEnded;

type Message = (Topic, Arc<Vec<u8>>);

/// A rank that is a thread.
///
/// A rank waits while another is behind. One that runs parallel loops needs a pool of threads of its own: in a pool that ranks share, those that
/// wait keep the others from going on.
#[derive(Debug)]
pub struct Threads {
    rank: usize,
    size: usize,
    lines: UntilEnded<Lines>,
}

/// To and from every rank.
#[derive(Debug)]
struct Lines {
    to: Vec<Sender<Message>>,
    from: Vec<Receiver<Message>>,
}

impl Threads {
    /// So many ranks.
    pub fn group(size: usize) -> Vec<Self> {
        let mut to: Vec<Vec<Sender<Message>>> = (0..size).map(|_| Vec::new()).collect();
        let mut from: Vec<Vec<Receiver<Message>>> = (0..size).map(|_| Vec::new()).collect();
        for to in &mut to {
            for from in &mut from {
                let (sender, receiver) = channel();
                to.push(sender);
                from.push(receiver);
            }
        }
        let lines = to.into_iter().zip(from).map(|(to, from)| UntilEnded::new(Lines { to, from }));
        (0..).zip(lines).map(|(rank, lines)| Self { rank, size, lines }).collect()
    }
}

impl Lines {
    fn send(&self, topic: Topic, own: &[u8]) {
        let own = Arc::new(own.to_vec());
        // A rank that has ended needs nothing any more; that it has is noticed where its message is missing.
        self.to.iter().for_each(|to| drop(to.send((topic, own.clone()))));
    }

    fn take(&self, topic: Topic, all: &mut Gathered) -> Result<(), RanksError> {
        all.bytes.clear();
        all.ends.clear();
        let mut topics = Vec::with_capacity(self.from.len());
        for from in &self.from {
            let (topic, bytes) = from.recv().unwrap_or_else(|_| {
                let why = "it has ended before the others".to_string();
                (Topic::GivenUp, Arc::new(why.into_bytes()))
            });
            topics.push(topic as u8);
            all.bytes.extend_from_slice(&bytes);
            all.ends.push(all.bytes.len());
        }
        all.judge(topic, &topics)
    }
}

impl Communicator for Threads {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, topic: Topic, own: &[u8], all: &mut Gathered) -> Result<(), RanksError> {
        self.lines.exchange(|lines| {
            lines.send(topic, own);
            lines.take(topic, all)
        })
    }

    fn give_up(&self, why: &str) {
        let told = self.lines.exchange(|lines| {
            lines.send(Topic::GivenUp, why.as_bytes());
            Err(RanksError::Stopped { rank: self.rank, why: why.into() })
        });
        drop(told);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_each<R: Send>(size: usize, work: impl Fn(Threads) -> R + Sync) -> Vec<std::thread::Result<R>> {
        std::thread::scope(|scope| {
            let ranks: Vec<_> =
                Threads::group(size).into_iter().map(|rank| scope.spawn(|| work(rank))).collect();
            ranks.into_iter().map(|rank| rank.join()).collect()
        })
    }

    #[test]
    fn each_gets_what_all_hand_in_in_the_order_of_ranks() {
        let found = on_each(4, |ranks| {
            let (mut all, mut sum) = (Gathered::default(), 0);
            for round in 0..100u8 {
                let own = vec![ranks.rank() as u8; usize::from(round) % 3 + ranks.rank()];
                ranks.exchange(Topic::Pairs, &own, &mut all).expect("all are there");
                assert_eq!((0..4).map(|rank| all.of(rank).len()).collect::<Vec<_>>(), {
                    let more = usize::from(round) % 3;
                    [more, more + 1, more + 2, more + 3]
                });
                sum += all.bytes.iter().map(|byte| u32::from(*byte)).sum::<u32>();
            }
            sum
        });
        let found: Vec<u32> = found.into_iter().map(|sum| sum.expect("no panic")).collect();
        assert!(found.iter().all(|sum| *sum == found[0]), "{found:?}");
    }

    #[test]
    fn the_lowest_rank_that_gives_up_ends_all_with_its_words() {
        let found = on_each(4, |ranks| {
            let mut all = Gathered::default();
            if ranks.rank() % 2 == 1 {
                ranks.give_up(&format!("no disk on {}", ranks.rank()));
            }
            let first = ranks.exchange(Topic::Blocks, b"x", &mut all);
            assert_eq!(first, ranks.exchange(Topic::Pairs, b"x", &mut all), "it stays so");
            first
        });
        for (rank, found) in found.into_iter().enumerate() {
            let lowest = if rank == 3 { 3 } else { 1 };
            let why = format!("no disk on {lowest}");
            assert_eq!(found.expect("no panic"), Err(RanksError::Stopped { rank: lowest, why }));
        }
    }

    #[test]
    fn a_panic_and_an_early_end_end_all() {
        let found = on_each(3, |ranks| {
            assert!(ranks.rank() != 1, "for the test");
            ranks.exchange(Topic::Blocks, b"x", &mut Gathered::default())
        });
        assert!(found[1].is_err());
        for rank in [0, 2] {
            let ended = found[rank].as_ref().expect("no panic");
            assert!(matches!(ended, Err(RanksError::Stopped { rank: 1, .. })), "{ended:?}");
        }
    }

    #[test]
    fn ranks_at_different_places_notice_it() {
        let found = on_each(2, |ranks| {
            let topic = if ranks.rank() == 0 { Topic::Pairs } else { Topic::Blocks };
            ranks.exchange(topic, b"x", &mut Gathered::default())
        });
        let found: Vec<_> = found.into_iter().map(|found| found.expect("no panic")).collect();
        assert_eq!(found, [1, 0].map(|rank| Err(RanksError::OutOfStep { rank })));
    }
}
