//! Ctrl-C during long calls that run without the GIL.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::current;
use std::time::{Duration, Instant};

use crate::errors::{Outcome, attached, detached};
use delone_core::base::error::Result;
use delone_core::base::watch::Watch;
use pyo3::prelude::*;

/// Minimum time between two checks of Python's signals: a check takes the GIL.
const BETWEEN: Duration = Duration::from_millis(50);

/// Whether a call should end.
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// Runs `work` without the GIL, with checks of Python's signals.
pub fn stoppable<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(Stop<'_>) -> Result<T> + Send,
) -> Outcome<T> {
    let signals = Signals::new();
    let outcome = detached(py, || work(&|| signals.stop()));
    match signals.exception() {
        Some(signal) => Err(signal.into()),
        None => outcome,
    }
}

/// The same, with a watch for the core.
pub fn watched<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Watch) -> Result<T> + Send,
) -> Outcome<T> {
    stoppable(py, |stop| work(&Watch::new(stop)))
}

/// The same with the GIL, for calls that are usually short. Threads that `work` starts do not check
/// signals, because they cannot take the GIL.
pub fn watched_attached<T>(work: impl FnOnce(&Watch) -> Result<T>) -> Outcome<T> {
    let (signals, own) = (Signals::new(), current().id());
    let stop = || (current().id() == own && signals.stop()) || signals.stopped();
    let outcome = attached(|| work(&Watch::new(&stop)));
    match signals.exception() {
        Some(signal) => Err(signal.into()),
        None => outcome,
    }
}

/// Checks Python's pending signals from time to time and remembers if one has arrived.
struct Signals {
    checked: Mutex<Instant>,
    stopped: AtomicBool,
    pending: Mutex<Option<PyErr>>,
}

impl Signals {
    /// No signal has arrived yet.
    fn new() -> Self {
        Self {
            checked: Mutex::new(Instant::now()),
            stopped: AtomicBool::new(false),
            pending: Mutex::new(None),
        }
    }

    /// Whether the call should end. If another thread is checking at this moment, its check counts.
    fn stop(&self) -> bool {
        if let Ok(mut checked) = self.checked.try_lock()
            && checked.elapsed() >= BETWEEN
        {
            // Python runs handlers only on its main thread; elsewhere this has no effect.
            if let Err(error) = Python::attach(|py| py.check_signals()) {
                self.stopped.store(true, Ordering::Relaxed);
                if let Ok(mut pending) = self.pending.lock() {
                    *pending = Some(error);
                }
            }
            *checked = Instant::now();
        }
        self.stopped()
    }

    /// Whether a signal that ends the call has arrived.
    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// The exception of the signal that stopped the call, if any.
    fn exception(self) -> Option<PyErr> {
        self.pending.into_inner().ok().flatten()
    }
}
