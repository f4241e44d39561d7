//! Exchanges up to the first that fails.

use std::sync::{Mutex, PoisonError};

use crate::communicator::RanksError;

/// What a rank exchanges by, until an exchange fails: every later one then fails in the same way, and nothing is sent any more.
#[derive(Debug)]
pub struct UntilEnded<T>(Mutex<(T, Option<RanksError>)>);

impl<T> UntilEnded<T> {
    /// Nothing has failed yet.
    pub fn new(means: T) -> Self {
        Self(Mutex::new((means, None)))
    }

    /// Exchanges, one thread at a time. A rank that gives up hands in an exchange that tells the others and fails.
    ///
    /// # Errors
    /// That of the first exchange that failed.
    pub fn exchange(&self, by: impl FnOnce(&mut T) -> Result<(), RanksError>) -> Result<(), RanksError> {
        let (means, ended) = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match ended {
            Some(error) => Err(error.clone()),
            None => by(means).inspect_err(|error| *ended = Some(error.clone())),
        }
    }
}
