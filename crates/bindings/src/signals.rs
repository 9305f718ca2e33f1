//! How Ctrl-C reaches a long call that runs without the GIL.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// Least time between two looks at Python's signals: a look takes the GIL.
const BETWEEN: Duration = Duration::from_millis(50);

/// Looks at Python's pending signals now and then and remembers that one has come.
pub struct Signals {
    looked: Mutex<Instant>,
    stopped: AtomicBool,
    pending: Mutex<Option<PyErr>>,
}

impl Signals {
    /// Nothing has come yet.
    pub fn new() -> Self {
        Self {
            looked: Mutex::new(Instant::now()),
            stopped: AtomicBool::new(false),
            pending: Mutex::new(None),
        }
    }

    /// Whether the call should end. Where another thread looks at this moment, its look counts.
    pub fn stop(&self) -> bool {
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
        self.stopped.load(Ordering::Relaxed)
    }

    /// The exception of the signal that stopped the call, where one did.
    pub fn exception(self) -> Option<PyErr> {
        self.pending.into_inner().ok().flatten()
    }
}
