//! Work of seconds or hours during which Ctrl-C works, other Python threads run, and lines go to `logging`.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use ndda::driver::Driver;
use ndda::summary::Label;
use ndda_solver::StepError;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(50);

/// How long steps go on before Ctrl-C is looked for.
const SLICE: Duration = Duration::from_millis(50);

/// Arguments of every tool: a flag that ends it when raised, and a listener for its lines of progress.
pub struct Watch<'a> {
    /// Raised by Ctrl-C.
    pub stop: Arc<AtomicBool>,
    /// Takes lines for `logging`.
    pub tell: &'a (dyn Fn(&str) + Sync),
}

/// Does work in a thread of its own, until it is done or Ctrl-C raises the flag that it is given.
pub fn watched<R: Send>(py: Python<'_>, work: impl FnOnce(&Watch) -> R + Send) -> PyResult<R> {
    let stop = Arc::new(AtomicBool::new(false));
    let (tell, told) = mpsc::channel::<String>();
    let told = Mutex::new(told);
    let mut failed = None;
    let flag = stop.clone();
    let done = thread::scope(|scope| {
        let worker = scope.spawn(move || {
            // Nobody listens any more after a failure of `logging`.
            let say = move |line: &str| drop(tell.send(line.to_string()));
            work(&Watch { stop: flag, tell: &say })
        });
        loop {
            let line = py.detach(|| match told.lock() {
                Ok(told) => told.recv_timeout(LOOK),
                Err(_) => Err(RecvTimeoutError::Disconnected),
            });
            let went_well = match line {
                Ok(line) => log(py, &line),
                Err(RecvTimeoutError::Timeout) => Ok(()),
                Err(RecvTimeoutError::Disconnected) => break,
            };
            if let Err(error) = went_well.and_then(|()| py.check_signals()) {
                stop.store(true, Ordering::Relaxed);
                failed.get_or_insert(error);
            }
        }
        py.detach(|| worker.join())
    });
    match (failed, done) {
        (Some(error), _) => Err(error),
        (None, Ok(done)) => Ok(done),
        (None, Err(_)) => Err(PyRuntimeError::new_err("a defect of ndda: please report what led to it")),
    }
}

/// A line to the logger `ndda`.
fn log(py: Python<'_>, line: &str) -> PyResult<()> {
    let logger = py.import("logging")?.call_method1("getLogger", ("ndda",))?;
    logger.call_method1("info", ("%s", line)).map(drop)
}

/// A pool of so many threads, where a number is given.
pub fn pool(threads: Option<usize>) -> PyResult<Option<ThreadPool>> {
    if threads == Some(0) {
        let message = "threads is 0: give at least 1, or None for all cores";
        return Err(pyo3::exceptions::PyValueError::new_err(message));
    }
    let pool = threads.map(|count| ThreadPoolBuilder::new().num_threads(count).build()).transpose();
    pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// Does work on the threads of a pool, or of the process.
pub fn within<R: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> R + Send) -> R {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// The label of a simulation, for which its steps may be taken again.
pub fn judged(py: Python<'_>, pool: Option<&ThreadPool>, driver: &mut Driver) -> PyResult<Label> {
    watched(py, |watch| within(pool, || driver.label_watched(&watch.stop, watch.tell)))
}

/// Steps until `left` is zero or the slice of time is over.
pub fn slice(driver: &mut Driver, left: &mut u64) -> Result<(), StepError> {
    let began = Instant::now();
    while *left > 0 {
        driver.step(1)?;
        *left -= 1;
        if began.elapsed() >= SLICE {
            break;
        }
    }
    Ok(())
}
