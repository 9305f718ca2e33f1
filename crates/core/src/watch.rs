//! How a caller stops a long loop: the loop asks every few thousand steps.

use crate::error::{Error, Result};

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
        Watch { stop: &|| false }
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
