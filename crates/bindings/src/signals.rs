//! How Ctrl-C reaches a long call that runs without the GIL.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::current;
use std::time::{Duration, Instant};

use delone_core::error::Result;
use delone_core::watch::Watch;
use pyo3::prelude::*;

use crate::errors::{attached, detached};

/// Least time between two looks at Python's signals: a look takes the GIL.
const BETWEEN: Duration = Duration::from_millis(50);

/// Runs `work` without the GIL under a watch on Python's signals.
pub fn watched<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Watch) -> Result<T> + Send,
) -> PyResult<T> {
    let signals = Signals::new();
    let outcome = detached(py, || work(&Watch::new(&|| signals.stop())));
    match signals.exception() {
        Some(signal) => Err(signal),
        None => outcome,
    }
}

/// The same with the GIL, for what is short as a rule. Threads that `work` starts do not look themselves, as
/// they could not have the GIL.
pub fn watched_attached<T>(py: Python<'_>, work: impl FnOnce(&Watch) -> Result<T>) -> PyResult<T> {
    let (signals, own) = (Signals::new(), current().id());
    let stop = || (current().id() == own && signals.stop()) || signals.stopped();
    let outcome = attached(py, || work(&Watch::new(&stop)));
    match signals.exception() {
        Some(signal) => Err(signal),
        None => outcome,
    }
}

/// Looks at Python's pending signals now and then and remembers that one has come.
struct Signals {
    looked: Mutex<Instant>,
    stopped: AtomicBool,
    pending: Mutex<Option<PyErr>>,
}

impl Signals {
    /// Nothing has come yet.
    fn new() -> Self {
        Self {
            looked: Mutex::new(Instant::now()),
            stopped: AtomicBool::new(false),
            pending: Mutex::new(None),
        }
    }

    /// Whether the call should end. Where another thread looks at this moment, its look counts.
    fn stop(&self) -> bool {
        if let Ok(mut looked) = self.looked.try_lock()
            && looked.elapsed() >= BETWEEN
        {
            // Python runs handlers on its main thread alone; elsewhere this does nothing.
            if let Err(error) = Python::attach(|py| py.check_signals()) {
                self.stopped.store(true, Ordering::Relaxed);
                if let Ok(mut pending) = self.pending.lock() {
                    *pending = Some(error);
                }
            }
            *looked = Instant::now();
        }
        self.stopped()
    }

    /// Whether a signal has come that ends the call.
    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// The exception of the signal that stopped the call, where one did.
    fn exception(self) -> Option<PyErr> {
        self.pending.into_inner().ok().flatten()
    }
}
