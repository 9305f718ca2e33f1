//! Rows of coordinates and their vertices: any number of rows share one vertex.
//!
//! The rows of a vertex form a ring in ascending order, from the smallest, its head, which the vertex
//! stores. Rows are numbered in the order of their insertion, and a number is never used again.

use super::chunks::{Chunks, Image};
use crate::base::error::{Error, Result};
use crate::base::memory::with_room;
use crate::base::watch::Watch;

/// No row, or no vertex.
pub const NONE: u32 = u32::MAX;

/// The share of room that is left for insertions.
const SPARE: usize = 3;

/// A row.
#[derive(Debug, Clone, Copy)]
struct Row {
    vertex: u32,
    before: u32,
    after: u32,
}

const GONE: Row = Row {
    vertex: NONE,
    before: NONE,
    after: NONE,
};

/// All rows ever inserted.
#[derive(Debug)]
pub struct Rows {
    rows: Chunks<Row>,
    live: usize,
    /// The same at the start of an edit.
    before: usize,
}

/// A snapshot of rows.
#[derive(Debug, Clone)]
pub struct RowsImage {
    rows: Image<Row>,
    live: usize,
}

impl Rows {
    /// `total` rows that are at no vertex.
    pub fn gone(total: usize) -> Result<Self> {
        // Untouched room for the next batches costs nothing.
        let mut rows = with_room(total + total / SPARE)?;
        rows.resize(total, GONE);
        Ok(Self {
            rows: Chunks::of(rows)?,
            live: 0,
            before: 0,
        })
    }

    /// The number of rows ever inserted: the number of the next row.
    pub fn total(&self) -> usize {
        self.rows.len()
    }

    /// The number of rows that are at vertices.
    pub fn live(&self) -> usize {
        self.live
    }

    /// The vertex of a row; `None` if it was removed or never existed.
    #[inline]
    pub fn vertex(&self, row: i64) -> Option<u32> {
        let row = usize::try_from(row).ok()?;
        let vertex = self.rows.items().get(row)?.vertex;
        (vertex != NONE).then_some(vertex)
    }

    /// The rows that are at vertices, ascending, each with its vertex.
    pub fn iter(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        (0u32..)
            .zip(self.rows.items())
            .filter(|(_, row)| row.vertex != NONE)
            .map(|(i, row)| (i, row.vertex))
    }

    /// The rows of the vertex with this head, ascending.
    pub fn at(&self, head: u32) -> impl Iterator<Item = u32> + '_ {
        let next = move |&row: &u32| {
            let after = self.rows[row as usize].after;
            (after != head).then_some(after)
        };
        std::iter::successors((head != NONE).then_some(head), next)
    }

    /// Whether a row is alone at its vertex.
    #[inline]
    pub fn is_single(&self, row: u32) -> bool {
        self.rows[row as usize].after == row
    }

    /// Whether the vertex with this head has exactly `count` rows.
    pub fn has_rows(&self, head: u32, count: usize) -> bool {
        let mut row = head;
        for _ in 1..count {
            row = self.rows[row as usize].after;
            if row == head {
                return false;
            }
        }
        self.rows[row as usize].after == head
    }

    /// Reserves room for `n` more rows: the next `n` calls of [`Self::push`] do not fail.
    pub fn reserve(&mut self, n: usize) -> Result<()> {
        if self.rows.len() + n >= NONE as usize {
            return Err(Error::TooMany {
                found: self.rows.len() + n,
                limit: NONE as usize - 1,
            });
        }
        self.rows.reserve(n)
    }

    /// Appends a row that is at no vertex yet.
    pub fn push(&mut self) -> Result<u32> {
        let row = self.rows.len() as u32;
        self.rows.push(GONE)?;
        Ok(row)
    }

    /// Puts a row that is at no vertex at `vertex`, which has this head, and returns its new head.
    pub fn attach(&mut self, row: u32, vertex: u32, head: u32) -> u32 {
        self.live += 1;
        if head == NONE {
            *self.rows.get_mut(row as usize) = Row {
                vertex,
                before: row,
                after: row,
            };
            return row;
        }
        let tail = self.rows[head as usize].before;
        let mut before = tail;
        while before > row && before != head {
            before = self.rows[before as usize].before;
        }
        if before > row {
            before = tail; // Smaller than all: a new head.
        }
        let after = self.rows[before as usize].after;
        *self.rows.get_mut(row as usize) = Row {
            vertex,
            before,
            after,
        };
        self.rows.get_mut(before as usize).after = row;
        self.rows.get_mut(after as usize).before = row;
        head.min(row)
    }

    /// Takes a row from its vertex, which has this head, and returns its new head, if any.
    pub fn detach(&mut self, row: u32, head: u32) -> u32 {
        self.live -= 1;
        let Row { before, after, .. } = self.rows[row as usize];
        *self.rows.get_mut(row as usize) = GONE;
        if after == row {
            return NONE;
        }
        self.rows.get_mut(before as usize).after = after;
        self.rows.get_mut(after as usize).before = before;
        if row == head { after } else { head }
    }

    /// Starts an edit that [`Self::take_back`] may undo.
    pub fn begin(&mut self) -> Result<()> {
        self.before = self.live;
        self.rows.begin()
    }

    /// Makes room for another step of such an edit.
    pub fn room(&mut self) -> Result<()> {
        self.rows.room(0)
    }

    /// Ends an edit and keeps its changes.
    pub fn commit(&mut self) {
        self.rows.commit();
    }

    /// Ends an edit and undoes all of its changes. Returns whether none was missed.
    pub fn take_back(&mut self) -> bool {
        self.live = self.before;
        self.rows.take_back()
    }

    /// For each row, how many rows that are at vertices come before it.
    pub fn ranks(&self) -> Result<Vec<i32>> {
        let mut ranks = with_room(self.rows.len())?;
        let mut rank = 0;
        for row in self.rows.items() {
            ranks.push(rank);
            rank += i32::from(row.vertex != NONE);
        }
        Ok(ranks)
    }

    /// A snapshot.
    pub fn image(&mut self, watch: &Watch) -> Result<RowsImage> {
        Ok(RowsImage {
            rows: self.rows.image(watch)?,
            live: self.live,
        })
    }

    /// Reserves the memory for [`Self::restore`].
    pub fn make_room(&mut self, image: &RowsImage) -> Result<()> {
        self.rows.make_room(&image.rows)
    }

    /// Restores a snapshot. The numbers of rows inserted since are not used again.
    pub fn restore(&mut self, image: &RowsImage) -> Result<()> {
        self.rows.restore(&image.rows)?;
        self.live = image.live;
        Ok(())
    }
}

impl RowsImage {
    /// Bytes that are not shared with `other`.
    pub fn own_bytes(&self, other: &Self) -> usize {
        self.rows.own_bytes(&other.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_ascending_in_any_order_of_insertion() {
        for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1], [1, 3, 0, 2]] {
            let mut rows = Rows::gone(4).unwrap();
            let mut head = NONE;
            for row in order {
                head = rows.attach(row, 7, head);
            }
            assert_eq!((head, rows.live()), (0, 4));
            assert!(rows.has_rows(head, 4) && !rows.has_rows(head, 3) && !rows.has_rows(head, 5));
            assert!((0..4).all(|i| rows.rows[i].after == (i as u32 + 1) % 4));
            assert!((0..4).all(|i| rows.rows[i].before == (i as u32 + 3) % 4));
            assert_eq!(rows.detach(1, head), 0);
            assert_eq!(rows.detach(0, head), 2);
            assert_eq!(rows.vertex(0), None);
            assert_eq!(rows.ranks().unwrap(), [0, 0, 0, 1]);
            assert_eq!(rows.detach(3, 2), 2);
            assert!(rows.is_single(2));
            assert_eq!(rows.detach(2, 2), NONE);
        }
    }
}
