//! The seam between a program and whatever carries bytes from rank to rank.

use std::fmt::Debug;
use std::ops::Range;

/// One of several processes or threads that run a scene together. All of them call [`exchange`](Self::exchange) equally often, in the same order.
pub trait Communicator: Debug + Send + Sync {
    /// Its number, from 0.
    fn rank(&self) -> usize;

    /// How many there are.
    fn size(&self) -> usize;

    /// Hands `own` to all ranks, and takes what they hand in, in the order of ranks.
    ///
    /// # Errors
    /// [`RanksError`] when a rank has given up, or is at another place of the program; every later exchange then fails, too.
    fn exchange(&self, topic: Topic, own: &[u8], all: &mut Gathered) -> Result<(), RanksError>;

    /// Says that this rank cannot go on, and why: the next exchange of all others fails. Nothing where an exchange has failed before.
    fn give_up(&self, why: &str);
}

/// What an exchange is about, so that ranks at different places of the program notice it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Topic {
    /// Pairs in contact.
    Pairs = 1,
    /// Forces of contact on nodes.
    Forces = 2,
    /// How blocks that deform answer to forces.
    Answers = 3,
    /// Blocks at the end of a step.
    Blocks = 4,
    /// Whether to end.
    Decision = 5,
    /// What the ranks are about to run.
    Start = 6,
    /// That a rank has come to the end of its run.
    End = 7,
    /// That a rank has given up.
    GivenUp = 8,
}

impl Topic {
    /// The topic of this number.
    pub fn of(number: u8) -> Option<Self> {
        use Topic::{Answers, Blocks, Decision, End, Forces, GivenUp, Pairs, Start};
        [Pairs, Forces, Answers, Blocks, Decision, Start, End, GivenUp]
            .into_iter()
            .find(|t| *t as u8 == number)
    }
}

/// Why ranks cannot go on together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RanksError {
    /// A rank has given up.
    #[error("rank {rank} has stopped: {why}")]
    Stopped {
        /// The lowest of those that have.
        rank: usize,
        /// Its words.
        why: String,
    },
    /// Two ranks are at different places of the program.
    #[error(
        "rank {rank} is at another place of the run than the others: start all ranks with the same program, scene and options"
    )]
    OutOfStep {
        /// The lowest that is not where this one is.
        rank: usize,
    },
}

/// What all ranks handed in; its memory is used again.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    /// One after the other.
    pub bytes: Vec<u8>,
    /// Where each ends.
    pub ends: Vec<usize>,
}

impl Gathered {
    /// What a rank handed in.
    pub fn of(&self, rank: usize) -> &[u8] {
        &self.bytes[self.range(rank)]
    }

    fn range(&self, rank: usize) -> Range<usize> {
        let start = if rank == 0 { 0 } else { self.ends[rank - 1] };
        start..self.ends[rank]
    }

    /// Judges an exchange by the topic of each rank: that of those that have given up comes with their words.
    ///
    /// # Errors
    /// [`RanksError`] unless all have the topic `own`.
    pub fn judge(&self, own: Topic, topics: &[u8]) -> Result<(), RanksError> {
        if let Some(rank) = topics.iter().position(|topic| *topic == Topic::GivenUp as u8) {
            let why = String::from_utf8_lossy(self.of(rank)).into_owned();
            return Err(RanksError::Stopped { rank, why });
        }
        match topics.iter().position(|topic| *topic != own as u8) {
            Some(rank) => Err(RanksError::OutOfStep { rank }),
            None => Ok(()),
        }
    }
}

/// The only rank: it hands nothing to anybody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Alone;

impl Communicator for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn exchange(&self, _: Topic, own: &[u8], all: &mut Gathered) -> Result<(), RanksError> {
        all.bytes.clear();
        all.bytes.extend_from_slice(own);
        all.ends.clear();
        all.ends.push(own.len());
        Ok(())
    }

    fn give_up(&self, _: &str) {}
}

/// Whether any rank wants something.
///
/// # Errors
/// As [`Communicator::exchange`].
pub fn agree(ranks: &dyn Communicator, wanted: bool) -> Result<bool, RanksError> {
    if ranks.size() == 1 {
        return Ok(wanted);
    }
    let mut all = Gathered::default();
    ranks.exchange(Topic::Decision, &[u8::from(wanted)], &mut all)?;
    Ok(all.bytes.contains(&1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topics_are_known_by_their_numbers() {
        for number in 0..=u8::MAX {
            assert!(Topic::of(number).is_none_or(|topic| topic as u8 == number));
        }
        assert_eq!((1..=8).filter_map(Topic::of).count(), 8);
    }

    #[test]
    fn alone_there_is_nobody_to_ask() {
        let mut all = Gathered::default();
        Alone.exchange(Topic::Pairs, b"abc", &mut all).expect("nobody else");
        assert_eq!((all.of(0), Alone.rank(), Alone.size()), (&b"abc"[..], 0, 1));
        assert_eq!(agree(&Alone, true), Ok(true));
        assert_eq!(agree(&Alone, false), Ok(false));
    }
}
