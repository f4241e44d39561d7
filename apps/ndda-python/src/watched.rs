//! Work of seconds or hours during which Ctrl-C works, other Python threads run, and lines go to `logging`.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use ndda::driver::Driver;
use ndda::summary::Label;
use ndda_solver::StepError;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBool;

use crate::threads::{Threads, within};

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

/// Does work on threads, looked after by another one, until it is done or Ctrl-C raises the flag that it is given.
pub fn watched<R: Send>(
    py: Python<'_>,
    threads: &Threads,
    work: impl FnOnce(&Watch) -> R + Send,
) -> PyResult<R> {
    let pool = threads.pool(py)?;
    let stop = Arc::new(AtomicBool::new(false));
    let (tell, told) = mpsc::channel::<String>();
    let told = Mutex::new(told);
    let mut failed = None;
    let flag = stop.clone();
    let done = thread::scope(|scope| {
        let worker = scope.spawn(move || {
            // Nobody listens any more after a failure of `logging`.
            let say = move |line: &str| drop(tell.send(line.to_string()));
            within(pool.as_deref(), move || work(&Watch { stop: flag, tell: &say }))
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

/// The label of a simulation, for which its steps may be taken again.
pub fn judged(py: Python<'_>, threads: &Threads, driver: &mut Driver) -> PyResult<Label> {
    watched(py, threads, |watch| driver.label_watched(&watch.stop, watch.tell))
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

/// A number of steps that a caller gives.
pub fn number_of_steps(n: &Bound<'_, PyAny>) -> PyResult<u64> {
    if n.is_instance_of::<PyBool>() {
        return Err(PyTypeError::new_err(format!("n is {n}: give a whole number")));
    }
    n.extract().map_err(|_| match n.call_method0("__index__").and_then(|n| n.lt(0)) {
        Ok(true) => PyValueError::new_err(format!("n is {n}: give at least 0")),
        Ok(false) => PyValueError::new_err(format!("n is {n}: give fewer steps")),
        Err(_) => PyTypeError::new_err(format!("n is {n:?}: give a whole number")),
    })
}
