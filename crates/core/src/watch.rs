//! Interruption: long loops ask a watch every few thousand steps whether to stop.

use crate::error::{Error, Result};

fn never() -> bool {
    false
}

/// A watch that never stops anything, for as long as anyone wants it.
pub static IDLE: Watch<'static> = Watch { stop: &never };

/// Asked now and then by long loops; the answer `true` ends them with [`Error::Interrupted`].
pub struct Watch<'a> {
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl<'a> Watch<'a> {
    /// A watch that asks `stop`.
    pub fn new(stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { stop }
    }

    /// A watch that never stops anything.
    pub fn idle() -> Watch<'static> {
        Watch { stop: &never }
    }

    /// Ends the caller's loop where the answer is to stop.
    pub fn check(&self) -> Result<()> {
        if (self.stop)() {
            Err(Error::Interrupted)
        } else {
            Ok(())
        }
    }
}

/// Counts work, and asks a watch each time that enough of it is done.
pub struct Pace<'a> {
    watch: &'a Watch<'a>,
    every: usize,
    left: usize,
}

impl<'a> Pace<'a> {
    /// Asks `watch` after each `every` units of work.
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

    /// Counts so many units, which are about to be done or have been.
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
    fn a_pace_asks_after_so_much_work() {
        let asked = AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) == 2;
        let watch = Watch::new(&stop);
        let mut pace = Pace::new(&watch, 10);
        let mut spent = 0;
        while pace.spend(3).is_ok() {
            spent += 3;
        }
        // The third time, after 12 units each: those that complete ten count.
        assert_eq!((spent, asked.into_inner()), (33, 3));
        assert_eq!(
            Pace::new(&Watch::new(&|| true), 10).spend(25),
            Err(Error::Interrupted)
        );
    }
}
