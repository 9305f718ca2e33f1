//! Output arrays that several threads fill, each its own rows.

use std::sync::atomic::{AtomicI32, AtomicU64, Ordering};

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::watch::Watch;

/// Numbers initialized between two checks for interruption: their pages are new.
const LOT: usize = 1 << 18;

/// Numbers that threads write to their own rows, in any order.
pub struct Output<T: Word> {
    cells: Vec<T::Cell>,
}

/// A number of one word.
pub trait Word: Copy {
    /// The same number in a form that threads can share.
    type Cell: Send + Sync;
    /// A cell with the number.
    fn cell(self) -> Self::Cell;
    /// Stores the number in a cell.
    fn put(self, cell: &Self::Cell);
    /// The number in a cell.
    fn take(cell: Self::Cell) -> Self;
}

// Rows are written once and read after the threads have ended: relaxed ordering suffices, and the
// cells are as fast as plain numbers.
impl Word for i32 {
    type Cell = AtomicI32;
    fn cell(self) -> AtomicI32 {
        AtomicI32::new(self)
    }
    #[inline]
    fn put(self, cell: &AtomicI32) {
        cell.store(self, Ordering::Relaxed);
    }
    #[inline]
    fn take(cell: AtomicI32) -> Self {
        cell.into_inner()
    }
}

impl Word for f64 {
    type Cell = AtomicU64;
    fn cell(self) -> AtomicU64 {
        AtomicU64::new(self.to_bits())
    }
    #[inline]
    fn put(self, cell: &AtomicU64) {
        cell.store(self.to_bits(), Ordering::Relaxed);
    }
    #[inline]
    fn take(cell: AtomicU64) -> Self {
        Self::from_bits(cell.into_inner())
    }
}

impl<T: Word> Output<T> {
    /// `n` copies of a number.
    pub fn filled(n: usize, value: T, watch: &Watch) -> Result<Self> {
        let mut cells = with_room(n)?;
        while cells.len() < n {
            watch.check()?;
            let lot = LOT.min(n - cells.len());
            cells.extend((0..lot).map(|_| value.cell()));
        }
        Ok(Self { cells })
    }

    /// Writes one number.
    #[inline]
    pub fn set(&self, i: usize, value: T) {
        value.put(&self.cells[i]);
    }

    /// Writes the numbers from `i` on.
    #[inline]
    pub fn set_all(&self, i: usize, values: &[T]) {
        for (cell, value) in self.cells[i..i + values.len()].iter().zip(values) {
            value.put(cell);
        }
    }

    /// The numbers.
    pub fn into_vec(self) -> Vec<T> {
        self.cells.into_iter().map(T::take).collect()
    }
}
