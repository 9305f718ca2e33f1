//! How a call runs: the number of threads, and when it stops early.

use std::fmt;
use std::sync::OnceLock;
use std::thread::available_parallelism;

use delone_core::watch::{IDLE, Watch};

/// How a call runs. Nothing here affects the result.
///
/// ```
/// use std::sync::atomic::{AtomicBool, Ordering};
///
/// use delone::{Error, Options, Triangulation};
///
/// let cancelled = AtomicBool::new(true);
/// let stop = || cancelled.load(Ordering::Relaxed);
/// let options = Options::new().threads(2).interrupt(&stop);
/// let points: Vec<_> = (0..100_000_u32).map(|i| [f64::from(i), f64::from(i).sin()]).collect();
/// assert_eq!(Triangulation::with_options(&points, options).err(), Some(Error::Interrupted));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Default)]
pub struct Options<'a> {
    threads: usize,
    stop: Option<&'a (dyn Fn() -> bool + Sync)>,
}

impl<'a> Options<'a> {
    /// One thread for each processor, and no interruption.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the largest number of threads; 0 is one for each processor.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// Sets a function that is called every few thousand steps, by any of the threads. If it returns
    /// true, the call ends with [`Error::Interrupted`](crate::Error::Interrupted).
    #[must_use]
    pub fn interrupt(mut self, stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        self.stop = Some(stop);
        self
    }

    pub(crate) fn workers(&self) -> usize {
        match self.threads {
            0 => *PROCESSORS.get_or_init(|| available_parallelism().map_or(1, usize::from)),
            threads => threads,
        }
    }

    pub(crate) fn watch(&self) -> Watch<'a> {
        match self.stop {
            Some(stop) => Watch::new(stop),
            None => Watch::idle(),
        }
    }
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("threads", &self.threads)
            .field("interrupt", &self.stop.is_some())
            .finish()
    }
}

/// The system reads files to count them, which takes longer than a small triangulation.
static PROCESSORS: OnceLock<usize> = OnceLock::new();

/// The watch of calls that are not interrupted.
pub(crate) static NEVER: &Watch<'static> = &IDLE;
