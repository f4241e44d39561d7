//! Threads that work is done on, which a process that was forked makes anew.
//!
//! A child that `fork` makes has a copy of a pool and none of its threads, and would wait for them forever.

use std::process;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Most threads, as of the command line.
const MOST: i64 = 1024;

/// The process that loaded the package, whose threads all work shares that has none of its own.
static LOADED_BY: OnceLock<u32> = OnceLock::new();

/// Threads of the process.
pub static SHARED: Threads = Threads { count: None, made: Mutex::new(None) };

/// So many threads, or those of the process.
pub struct Threads {
    count: Option<usize>,
    /// A pool and the process that made it.
    made: Mutex<Option<(u32, Arc<ThreadPool>)>>,
}

/// Notes the process that loads the package.
pub fn note_process() {
    LOADED_BY.get_or_init(process::id);
}

impl Threads {
    /// So many threads, or those of the process where no number is given.
    pub fn new(count: Option<i64>) -> PyResult<Self> {
        let count = match count {
            Some(count @ 1..=MOST) => Some(count as usize),
            None => None,
            Some(other) => {
                let message = format!("threads is {other}: give 1 to {MOST}, or None for all processors");
                return Err(PyValueError::new_err(message));
            }
        };
        Ok(Self { count, made: Mutex::new(None) })
    }

    /// Does work on them, while other Python threads run.
    pub fn run<R: Send>(&self, py: Python<'_>, work: impl FnOnce() -> R + Send) -> PyResult<R> {
        let pool = self.pool(py)?;
        Ok(py.detach(|| within(pool.as_deref(), work)))
    }

    /// The pool of a number of threads, or of a process that was forked; none where the threads of the process will do.
    ///
    /// Python's lock is held here, as it is during a fork, so that no child finds `made` locked.
    pub fn pool(&self, _py: Python<'_>) -> PyResult<Option<Arc<ThreadPool>>> {
        let here = process::id();
        if self.count.is_none() && LOADED_BY.get() == Some(&here) {
            return Ok(None);
        }
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, pool)) = made.as_ref().filter(|(by, _)| *by == here) {
            return Ok(Some(pool.clone()));
        }
        let built = ThreadPoolBuilder::new().num_threads(self.count.unwrap_or(0)).build();
        let pool = Arc::new(built.map_err(|error| PyRuntimeError::new_err(error.to_string()))?);
        // To end threads that are not there would wait for them.
        std::mem::forget(made.replace((here, pool.clone())));
        Ok(Some(pool))
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        let made = self.made.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        if made.as_ref().is_some_and(|(by, _)| *by != process::id()) {
            std::mem::forget(made);
        }
    }
}

/// Does work on the threads of a pool, or of the process.
pub fn within<R: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> R + Send) -> R {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}
