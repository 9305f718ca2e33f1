//! What an edit replaces in an array, so that an error can put it back.
//!
//! Each item is recorded before it changes for the first time, so an edit costs what it changes, and
//! the record is at most as large as the array. Whether an item has been recorded is told by the number
//! of the last edit that did so, which never has to be cleared.
//!
//! Items are recorded where nothing may fail. So callers make room where an edit may still fail: before
//! each step, for all that it changes ([`Journal::room`]).

use crate::base::error::Result;
use crate::base::memory::{make_room, zeroed};

/// Items for which there is always room: more than the steps change that do not ask for any.
const ROOM: usize = 64;

/// Items for which memory is kept from one edit to the next.
const KEPT: usize = 1 << 14;

/// The items that an edit has replaced.
#[derive(Debug)]
pub struct Journal<T> {
    is_on: bool,
    /// The number of items at the start of the edit; those after them are new. 0 outside edits.
    guarded: usize,
    /// Items that have been replaced, and their places.
    old: Vec<(u32, T)>,
    /// For each place the last edit that recorded it.
    edits: Vec<u32>,
    now: u32,
    /// Whether memory was refused where there should have been room.
    is_broken: bool,
}

// Not derived: that would require `Default` of the items.
impl<T> Default for Journal<T> {
    fn default() -> Self {
        Self {
            is_on: false,
            guarded: 0,
            old: Vec::new(),
            edits: Vec::new(),
            now: 0,
            is_broken: false,
        }
    }
}

impl<T: Copy> Journal<T> {
    /// Starts an edit of an array of `len` items.
    pub fn begin(&mut self, len: usize) -> Result<()> {
        make_room(&mut self.old, ROOM)?;
        if self.edits.len() < len {
            self.edits = zeroed(len + len / 2)?;
            self.now = 0;
        }
        if self.now == u32::MAX {
            self.edits.fill(0);
            self.now = 0;
        }
        self.now += 1;
        (self.is_on, self.guarded) = (true, len);
        Ok(())
    }

    /// Makes room for changes of `n` items.
    #[inline]
    pub fn room(&mut self, n: usize) -> Result<()> {
        if self.is_on {
            make_room(&mut self.old, n + ROOM)?;
        }
        Ok(())
    }

    /// Whether item `i` is to be recorded before it changes.
    #[inline]
    pub fn guards(&self, i: usize) -> bool {
        i < self.guarded
    }

    /// Records an item that is guarded, unless it has been.
    // Apart from the callers, which stay short for edits that record nothing.
    #[cold]
    #[inline(never)]
    pub fn record(&mut self, i: usize, item: T) {
        if self.edits[i] == self.now {
            return;
        }
        if make_room(&mut self.old, 1).is_err() {
            self.is_broken = true;
            return;
        }
        self.edits[i] = self.now;
        self.old.push((i as u32, item));
    }

    /// Ends the edit: nothing can be put back any more.
    pub fn end(&mut self) {
        (self.is_on, self.is_broken, self.guarded) = (false, false, 0);
        if self.old.capacity() > KEPT {
            self.old = Vec::new();
        }
        self.old.clear();
    }

    /// Puts all items back, without those that are new, and ends the edit. Returns whether all that
    /// changed had been recorded.
    pub fn put_back(&mut self, items: &mut Vec<T>) -> bool {
        let is_whole = !self.is_broken;
        if self.is_on {
            for &(i, item) in &self.old {
                items[i as usize] = item;
            }
            items.truncate(self.guarded);
        }
        self.end();
        is_whole
    }
}
