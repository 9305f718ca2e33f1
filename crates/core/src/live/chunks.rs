//! Arrays that are edited in place, with snapshots that share what has not changed.
//!
//! The items lie in one flat vector, so that reading is as fast as in a mesh that is built once.
//! They are divided into chunks of about 1 KiB, and each write marks its chunk. A snapshot copies the
//! marked chunks and shares all others with the snapshot before it, by reference counts (J. R. Driscoll,
//! N. Sarnak, D. D. Sleator and R. E. Tarjan, "Making data structures persistent", 1989). Chunks are
//! listed in groups, which are shared in the same way, so that a snapshot costs what has changed since
//! the last one, except for the first, which copies everything. A snapshot never changes: any number of
//! threads may read it while the array is edited.

use std::ops::{Index, Range};
use std::sync::Arc;

use super::journal::Journal;
use crate::base::error::Result;
use crate::base::memory::{filled, make_room, with_room};
use crate::base::watch::{Pace, Watch};

/// Bytes of a chunk. Large chunks make scattered changes expensive, small ones long lists.
const CHUNK: usize = 1 << 10;

/// Chunks in a group.
const GROUP: usize = 1 << 4;

/// Chunks between two checks for interruption.
const LOT: usize = 1 << 12;

/// At most one in this many items may be free while others are appended.
const SPARE: usize = 4;

/// Items of a snapshot.
type Chunk<T> = Arc<Vec<T>>;
type Group<T> = Arc<Vec<Chunk<T>>>;

/// An array that is edited in place.
#[derive(Debug)]
pub struct Chunks<T> {
    items: Vec<T>,
    /// Whether a chunk may differ from that of the last snapshot.
    marked: Vec<bool>,
    last: Image<T>,
    journal: Journal<T>,
}

/// An immutable array that shares chunks with others.
#[derive(Debug)]
pub struct Image<T> {
    groups: Vec<Group<T>>,
    len: usize,
}

// Not derived: that would require `Clone` and `Default` of the items.
impl<T> Clone for Image<T> {
    fn clone(&self) -> Self {
        Self {
            groups: self.groups.clone(),
            len: self.len,
        }
    }
}

impl<T> Default for Image<T> {
    fn default() -> Self {
        Self {
            groups: Vec::new(),
            len: 0,
        }
    }
}

impl<T: Copy> Index<usize> for Chunks<T> {
    type Output = T;

    #[inline]
    fn index(&self, i: usize) -> &T {
        &self.items[i]
    }
}

impl<T: Copy> Chunks<T> {
    /// Items in a chunk, a power of two.
    pub const SIZE: usize = 1 << (CHUNK / size_of::<T>()).ilog2();

    /// An array of these items.
    pub fn of(items: Vec<T>) -> Result<Self> {
        Ok(Self {
            marked: filled(items.len().div_ceil(Self::SIZE), true)?,
            items,
            last: Image::default(),
            journal: Journal::default(),
        })
    }

    /// The number of items.
    #[inline]
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// All items.
    #[inline]
    pub fn items(&self) -> &[T] {
        &self.items
    }

    /// Item `i`, to be changed.
    #[inline]
    pub fn get_mut(&mut self, i: usize) -> &mut T {
        self.marked[i / Self::SIZE] = true;
        if self.journal.guards(i) {
            self.journal.record(i, self.items[i]);
        }
        &mut self.items[i]
    }

    /// Marks the chunk of item `i`, whose meaning changes, as changed.
    #[inline]
    pub fn mark(&mut self, i: usize) {
        self.marked[i / Self::SIZE] = true;
    }

    /// Starts an edit that [`Self::take_back`] may undo. Before each step of it, callers make room
    /// for what it changes.
    pub fn begin(&mut self) -> Result<()> {
        self.journal.begin(self.items.len())
    }

    /// Makes room for changes of `n` items, during an edit that may be taken back.
    #[inline]
    pub fn room(&mut self, n: usize) -> Result<()> {
        self.journal.room(n)
    }

    /// Ends an edit and keeps its changes.
    pub fn commit(&mut self) {
        self.journal.end();
    }

    /// Ends an edit and undoes all of its changes. Returns whether none was missed.
    pub fn take_back(&mut self) -> bool {
        let is_whole = self.journal.put_back(&mut self.items);
        self.marked.truncate(self.items.len().div_ceil(Self::SIZE));
        is_whole
    }

    /// Whether a free item is to be used before one is appended, where about `free` are. The next
    /// snapshot copies its chunk, unless that has changed anyway; but free items must not pile up.
    #[inline]
    pub fn is_to_be_used(&self, i: usize, free: usize) -> bool {
        self.marked[i / Self::SIZE]
            || free > self.items.len() / SPARE
            || self.items.len() == self.items.capacity()
    }

    /// Reserves room for `n` more items: the next `n` calls of [`Self::push`] do not fail.
    #[inline]
    pub fn reserve(&mut self, n: usize) -> Result<()> {
        make_room(&mut self.items, n)?;
        let chunks = (self.items.len() + n).div_ceil(Self::SIZE);
        let more = chunks - self.marked.len();
        make_room(&mut self.marked, more)
    }

    /// Appends an item.
    #[inline]
    pub fn push(&mut self, item: T) -> Result<()> {
        self.reserve(1)?;
        if self.items.len().is_multiple_of(Self::SIZE) {
            self.marked.push(true);
        }
        self.items.push(item);
        self.marked[(self.items.len() - 1) / Self::SIZE] = true;
        Ok(())
    }

    /// The current items as a snapshot. If memory is refused or the call is interrupted, nothing
    /// changes.
    pub fn image(&mut self, watch: &Watch) -> Result<Image<T>> {
        let mut pace = Pace::new(watch, LOT);
        let mut groups = with_room(self.marked.len().div_ceil(GROUP))?;
        for (g, marked) in self.marked.chunks(GROUP).enumerate() {
            // A group without a marked chunk is shared with the last snapshot.
            let kept = self.last.groups.get(g).filter(|g| g.len() == marked.len());
            if let Some(group) = kept.filter(|_| !marked.contains(&true)) {
                groups.push(Arc::clone(group));
                continue;
            }
            pace.spend(marked.len())?;
            let mut group = with_room(marked.len())?;
            // Otherwise each chunk is, unless it is marked: those are copied.
            for (k, &marked) in marked.iter().enumerate() {
                let chunk = match self.last.chunk(GROUP * g + k).filter(|_| !marked) {
                    Some(chunk) => Arc::clone(chunk),
                    None => {
                        let own = &self.items[self.range(GROUP * g + k)];
                        let mut chunk = with_room(own.len())?;
                        chunk.extend_from_slice(own);
                        Arc::new(chunk)
                    }
                };
                group.push(chunk);
            }
            groups.push(Arc::new(group));
        }
        self.last = Image {
            groups,
            len: self.items.len(),
        };
        self.marked.fill(false);
        Ok(self.last.clone())
    }

    /// Reserves the memory for [`Self::restore`], which does not fail then.
    pub fn make_room(&mut self, image: &Image<T>) -> Result<()> {
        self.reserve(image.len.saturating_sub(self.items.len()))
    }

    /// Makes the items those of `image`, a snapshot of this array or of any other. Only chunks that
    /// differ are copied. If memory is refused, nothing has changed.
    pub fn restore(&mut self, image: &Image<T>) -> Result<()> {
        self.make_room(image)?;
        let common = image.len.min(self.items.len()).div_ceil(Self::SIZE);
        let mut from = common;
        for c in 0..common {
            let (Some(new), range) = (image.chunk(c), self.range(c)) else {
                break;
            };
            if new.len() != range.len() {
                // The last chunk of one of the two.
                from = c;
                break;
            }
            if self.marked[c] || !self.last.chunk(c).is_some_and(|old| Arc::ptr_eq(old, new)) {
                self.items[range].copy_from_slice(new);
            }
        }
        self.items.truncate((Self::SIZE * from).min(image.len));
        for c in from.. {
            let Some(new) = image.chunk(c) else {
                break;
            };
            self.items.extend_from_slice(new);
        }
        self.marked.clear();
        self.marked.resize(image.len.div_ceil(Self::SIZE), false);
        self.last = image.clone();
        Ok(())
    }

    /// The chunks that may differ from those of `image`, as ranges of items of either.
    pub fn changed<'a>(&'a self, image: &'a Image<T>) -> impl Iterator<Item = Range<usize>> + 'a {
        let chunks = self.marked.len().max(image.len.div_ceil(Self::SIZE));
        let same = |c: usize| match (self.last.chunk(c), image.chunk(c), self.marked.get(c)) {
            (Some(last), Some(old), Some(false)) => Arc::ptr_eq(last, old),
            _ => false,
        };
        (0..chunks)
            .filter(move |&c| !same(c))
            .map(|c| Self::SIZE * c..Self::SIZE * (c + 1))
    }

    /// The items of chunk `c`.
    fn range(&self, c: usize) -> Range<usize> {
        Self::SIZE * c..self.items.len().min(Self::SIZE * (c + 1))
    }
}

impl<T> Image<T> {
    /// The number of items.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    #[inline]
    fn chunk(&self, c: usize) -> Option<&Chunk<T>> {
        self.groups.get(c / GROUP)?.get(c % GROUP)
    }
}

impl<T: Copy> Image<T> {
    /// Item `i`, if there is one.
    #[inline]
    pub fn get(&self, i: usize) -> Option<T> {
        let size = Chunks::<T>::SIZE;
        self.chunk(i / size)?.get(i % size).copied()
    }

    /// All items.
    pub fn to_vec(&self) -> Result<Vec<T>> {
        let mut items = with_room(self.len)?;
        for chunk in self.groups.iter().flat_map(|group| group.iter()) {
            items.extend_from_slice(chunk);
        }
        Ok(items)
    }

    /// Bytes of the chunks and lists that this snapshot does not share with `other`.
    pub fn own_bytes(&self, other: &Self) -> usize {
        let mut bytes = size_of::<Group<T>>() * self.groups.len();
        for (g, group) in self.groups.iter().enumerate() {
            if other.groups.get(g).is_some_and(|o| Arc::ptr_eq(o, group)) {
                continue;
            }
            bytes += size_of::<Chunk<T>>() * group.len();
            for (k, chunk) in group.iter().enumerate() {
                let old = other.chunk(GROUP * g + k);
                if !old.is_some_and(|o| Arc::ptr_eq(o, chunk)) {
                    bytes += size_of_val(&chunk[..]);
                }
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = Chunks::<u32>::SIZE;

    fn array(n: usize) -> Chunks<u32> {
        Chunks::of((0..n as u32).collect()).unwrap()
    }

    fn image(array: &mut Chunks<u32>) -> Image<u32> {
        array.image(&Watch::idle()).unwrap()
    }

    #[test]
    fn snapshots_keep_their_items() {
        // Edits at the ends of chunks, beyond the first chunk and the first group.
        for n in [0, 1, SIZE - 1, SIZE, SIZE + 1, 3 * GROUP * SIZE + 5] {
            let mut array = array(n);
            let mut kept = vec![(image(&mut array), array.items().to_vec())];
            for step in 0..40usize {
                if step % 3 == 0 || array.is_empty() {
                    for x in 0..step as u32 * 20 + 1 {
                        array.push(x).unwrap();
                    }
                } else {
                    let at = step * 7919 * SIZE / 3 % array.len();
                    *array.get_mut(at) += 1;
                    let end = array.len() - 1;
                    *array.get_mut(end) += 1;
                }
                kept.push((image(&mut array), array.items().to_vec()));
            }
            for (image, items) in &kept {
                assert_eq!(&image.to_vec().unwrap(), items);
                assert!((0..items.len()).all(|i| image.get(i) == Some(items[i])));
                assert_eq!(image.get(items.len()), None);
            }
            // Restored in any order, with unsaved edits in between.
            for i in (0..kept.len()).map(|i| i * 17 % kept.len()) {
                let (image, items) = &kept[i];
                array.restore(image).unwrap();
                assert_eq!(array.items(), items);
                if let Some(last) = items.len().checked_sub(1) {
                    *array.get_mut(last / 2) ^= 1;
                    array.push(7).unwrap();
                }
            }
        }
    }

    #[test]
    fn a_snapshot_shares_what_has_not_changed() {
        let mut array = array(4 * GROUP * SIZE);
        let first = image(&mut array);
        *array.get_mut(2 * GROUP * SIZE + SIZE) += 1;
        let second = image(&mut array);
        let lists = 8 * (4 + GROUP);
        assert_eq!(second.own_bytes(&first), CHUNK + lists);
        let changed: Vec<_> = array.changed(&first).collect();
        let chunk = 2 * GROUP * SIZE + SIZE;
        assert_eq!(changed.len(), 1);
        assert_eq!(changed[0], chunk..chunk + SIZE);
        assert_eq!(array.changed(&second).count(), 0);
        assert_eq!(image(&mut array).own_bytes(&second), 8 * 4);
    }

    #[test]
    fn a_snapshot_can_be_restored_to_another_array() {
        let before = image(&mut array(3 * SIZE));
        let mut other = Chunks::of(vec![9; SIZE + 1]).unwrap();
        assert_eq!(image(&mut other).to_vec().unwrap(), vec![9; SIZE + 1]);
        other.restore(&before).unwrap();
        assert!(other.items().iter().copied().eq(0..3 * SIZE as u32));
    }

    #[test]
    fn an_edit_is_taken_back() {
        let mut array = array(3 * GROUP * SIZE + 5);
        let before = image(&mut array);
        let items = array.items().to_vec();
        for round in 0..3 {
            array.begin().unwrap();
            for i in (0..array.len()).step_by(7 + round) {
                array.room(2).unwrap();
                *array.get_mut(i) += 1;
                *array.get_mut(i) ^= 9;
            }
            for x in 0..2 * SIZE as u32 {
                array.push(x).unwrap();
            }
            *array.get_mut(items.len() + SIZE) += 1;
            if round == 1 {
                array.commit();
                array.restore(&before).unwrap();
            } else {
                assert!(array.take_back());
            }
            assert_eq!(array.items(), items);
            // Without an edit nothing is recorded.
            *array.get_mut(round) += 1;
            assert!(array.take_back());
            assert_ne!(array.items(), items);
            *array.get_mut(round) -= 1;
            assert_eq!(image(&mut array).to_vec().unwrap(), items);
        }
    }

    #[test]
    fn an_interrupted_snapshot_changes_nothing() {
        let mut array = array(2 * LOT * SIZE);
        let before = image(&mut array);
        for i in (0..array.len()).step_by(SIZE) {
            *array.get_mut(i) += 1;
        }
        let items = array.items().to_vec();
        assert!(array.image(&Watch::new(&|| true)).is_err());
        assert_eq!(array.items(), items);
        assert_eq!(image(&mut array).to_vec().unwrap(), items);
        array.restore(&before).unwrap();
        assert_eq!(array[0], 0);
    }
}
