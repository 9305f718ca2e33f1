//! Interruption: long loops check every few thousand steps whether the caller wants to stop.

use std::time::Instant;

use crate::base::error::{Error, Result};

fn never() -> bool {
    false
}

/// The time; None in WebAssembly, where the clock of the standard library panics.
pub(crate) fn now() -> Option<Instant> {
    (!cfg!(target_family = "wasm")).then(Instant::now)
}

/// A watch that never interrupts; it is static.
pub static IDLE: Watch<'static> = Watch { stop: &never };

/// Checked at intervals by long loops; if it answers `true`, they end with [`Error::Interrupted`].
pub struct Watch<'a> {
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl<'a> Watch<'a> {
    /// A watch that calls `stop` at each check.
    pub fn new(stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { stop }
    }

    /// A watch that never interrupts.
    pub fn idle() -> Watch<'static> {
        Watch { stop: &never }
    }

    /// Returns the error [`Error::Interrupted`] if the caller wants to stop.
    pub fn check(&self) -> Result<()> {
        if (self.stop)() {
            Err(Error::Interrupted)
        } else {
            Ok(())
        }
    }
}

/// Counts units of work, and checks for interruption whenever enough of it is done.
pub struct Pace<'a> {
    watch: &'a Watch<'a>,
    every: usize,
    left: usize,
}

impl<'a> Pace<'a> {
    /// Checks `watch` after every `every` units of work.
    pub fn new(watch: &'a Watch<'a>, every: usize) -> Self {
        Self {
            watch,
            every,
            left: every,
        }
    }

    /// The watch.
    pub fn watch(&self) -> &'a Watch<'a> {
        self.watch
    }

    /// Counts units that are about to be done or have been done.
    #[inline]
    pub fn spend(&mut self, work: usize) -> Result<()> {
        if work < self.left {
            self.left -= work;
            return Ok(());
        }
        self.left = self.every;
        self.watch.check()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn a_pace_checks_after_so_many_units() {
        let asked = AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) == 2;
        let watch = Watch::new(&stop);
        let mut pace = Pace::new(&watch, 10);
        let mut spent = 0;
        while pace.spend(3).is_ok() {
            spent += 3;
        }
        // Units after which a check happened: 12 each time, once ten are complete.
        assert_eq!((spent, asked.into_inner()), (33, 3));
        assert_eq!(
            Pace::new(&Watch::new(&|| true), 10).spend(25),
            Err(Error::Interrupted)
        );
    }
}
