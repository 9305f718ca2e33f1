//! Segments of a live triangulation: pairs of rows, and for each row the segments that end there.
//!
//! Like a row, a segment has a number that is never used again. Its ends are rows and not vertices,
//! so that they remain valid when points move, and when one of several equal points is removed.

use std::collections::BTreeSet;
use std::sync::Arc;

use delone_predicates::Point2;

use crate::base::error::{Error, Result};
use crate::base::memory::with_room;
use crate::base::watch::Watch;
use crate::live::chunks::{Chunks, Image};
use crate::live::kernel::Constraints;
use crate::live::rows::NONE;

/// A segment. A link is the number of a segment, doubled, plus 1 for its second end.
#[derive(Debug, Clone, Copy)]
struct Segment {
    /// Its rows; [`NONE`] if it was removed.
    ends: [u32; 2],
    /// For each end, the next link at the same row.
    after: [u32; 2],
    /// For each end, the previous link at the same row.
    before: [u32; 2],
}

/// Segments that do not run straight along edges: they cross others, or pass through rounded points.
#[derive(Debug, Default)]
pub struct Crossed {
    /// The numbers of these segments, ascending.
    pub segments: Vec<u32>,
    /// The rows of vertices that only crossings need, ascending.
    pub rows: Vec<u32>,
    /// Two segments, ascending, and the vertex where they cross.
    pub crossings: Vec<[u32; 3]>,
    /// The edges of these segments: the segment, ascending, and two vertices.
    pub edges: Vec<(u32, [u32; 2])>,
}

/// What an edit has taken out of the mesh.
#[derive(Debug, Default)]
pub struct Detached {
    /// Segments that are there, but have no edges.
    pub segments: BTreeSet<u32>,
    /// Removed crossings, and their rows.
    pub places: Vec<(Point2, u32)>,
}

/// All segments ever inserted.
#[derive(Debug)]
pub struct Segments {
    items: Chunks<Segment>,
    /// For each row the first link; rows beyond its end have none.
    first: Chunks<u32>,
    live: usize,
    /// Whether crossings are split; otherwise they are an error.
    pub split: bool,
    /// What is not straight.
    pub crossed: Arc<Crossed>,
    /// How many there were at the start of an edit, and what was not straight.
    before: (usize, Arc<Crossed>),
}

/// A snapshot of segments.
#[derive(Debug, Clone)]
pub struct SegmentsImage {
    items: Image<Segment>,
    first: Image<u32>,
    live: usize,
    split: bool,
    crossed: Arc<Crossed>,
}

impl Segments {
    /// The number of present segments.
    pub fn live(&self) -> usize {
        self.live
    }

    /// The rows of a present segment.
    pub fn ends(&self, segment: i64) -> Option<[u32; 2]> {
        let i = usize::try_from(segment).ok()?;
        let ends = self.items.items().get(i)?.ends;
        (ends[0] != NONE).then_some(ends)
    }

    /// The present segments, ascending, with their rows.
    pub fn iter(&self) -> impl Iterator<Item = (u32, [u32; 2])> + '_ {
        (0u32..)
            .zip(self.items.items())
            .filter(|(_, s)| s.ends[0] != NONE)
            .map(|(i, s)| (i, s.ends))
    }

    /// The segments that end at a row, each with its other row.
    pub fn at(&self, row: u32) -> impl Iterator<Item = (u32, u32)> + '_ {
        let first = self.first.items().get(row as usize);
        let link = first.copied().filter(|&link| link != NONE);
        let next = |&link: &u32| {
            let after = self.items[link as usize / 2].after[link as usize % 2];
            (after != NONE).then_some(after)
        };
        std::iter::successors(link, next).map(|link| {
            (
                link / 2,
                self.items[link as usize / 2].ends[1 - link as usize % 2],
            )
        })
    }

    /// Appends a number whose segment is no longer present.
    fn push(&mut self) -> Result<u32> {
        if self.items.len() >= NONE as usize / 2 {
            return Err(Error::TooMany {
                found: self.items.len() + 1,
                limit: NONE as usize / 2,
            });
        }
        self.items.push(Segment {
            ends: [NONE; 2],
            after: [NONE; 2],
            before: [NONE; 2],
        })?;
        Ok(self.items.len() as u32 - 1)
    }

    /// Inserts a segment between two rows and returns its number.
    pub fn insert(&mut self, ends: [u32; 2]) -> Result<u32> {
        let rows = ends[0].max(ends[1]) as usize + 1;
        self.first.reserve(rows.saturating_sub(self.first.len()))?;
        while self.first.len() < rows {
            self.first.push(NONE)?;
        }
        let i = self.push()?;
        self.room()?;
        self.items.get_mut(i as usize).ends = ends;
        self.list(i);
        self.live += 1;
        Ok(i)
    }

    /// Inserts segments whose numbers, ascending, are known, where there have been `total` ever.
    pub fn insert_known(&mut self, known: &[(u32, [u32; 2])], total: usize) -> Result<()> {
        for &(number, ends) in known {
            while self.items.len() < number as usize {
                self.push()?;
            }
            self.insert(ends)?;
        }
        while self.items.len() < total {
            self.push()?;
        }
        Ok(())
    }

    /// Removes a present segment.
    pub fn remove(&mut self, segment: u32) {
        self.unlist(segment);
        self.items.get_mut(segment as usize).ends = [NONE; 2];
        self.live -= 1;
    }

    /// Puts a segment into the lists of its rows.
    pub fn list(&mut self, segment: u32) {
        for (k, row) in self.items[segment as usize].ends.into_iter().enumerate() {
            let link = 2 * segment + k as u32;
            let after = std::mem::replace(self.first.get_mut(row as usize), link);
            let own = self.items.get_mut(segment as usize);
            (own.after[k], own.before[k]) = (after, NONE);
            if after != NONE {
                self.items.get_mut(after as usize / 2).before[after as usize % 2] = link;
            }
        }
    }

    /// Takes a segment out of the lists of its rows; its number and its rows stay.
    pub fn unlist(&mut self, segment: u32) {
        for k in 0..2 {
            let Segment {
                ends,
                after,
                before,
            } = self.items[segment as usize];
            let (after, before) = (after[k], before[k]);
            if before == NONE {
                *self.first.get_mut(ends[k] as usize) = after;
            } else {
                self.items.get_mut(before as usize / 2).after[before as usize % 2] = after;
            }
            if after != NONE {
                self.items.get_mut(after as usize / 2).before[after as usize % 2] = before;
            }
        }
    }

    /// Starts an edit that [`Self::take_back`] may undo.
    pub fn begin(&mut self) -> Result<()> {
        self.before = (self.live, Arc::clone(&self.crossed));
        self.items.begin()?;
        self.first.begin()
    }

    /// Ends an edit and keeps its changes.
    pub fn commit(&mut self) {
        self.before.1 = Arc::default();
        self.items.commit();
        self.first.commit();
    }

    /// Ends an edit and undoes all of its changes. Returns whether none was missed.
    pub fn take_back(&mut self) -> bool {
        (self.live, self.crossed) = std::mem::take(&mut self.before);
        self.items.take_back() & self.first.take_back()
    }

    /// The numbers of present segments, ascending, and their rows.
    pub fn listed(&self) -> Result<(Vec<i64>, Vec<[i64; 2]>)> {
        let (mut numbers, mut ends) = (with_room(self.live)?, with_room(self.live)?);
        for (i, rows) in self.iter() {
            numbers.push(i64::from(i));
            ends.push(rows.map(i64::from));
        }
        Ok((numbers, ends))
    }
}

impl Constraints for Segments {
    type Image = SegmentsImage;

    fn none() -> Result<Self> {
        Ok(Self {
            items: Chunks::of(Vec::new())?,
            first: Chunks::of(Vec::new())?,
            live: 0,
            split: false,
            crossed: Arc::default(),
            before: (0, Arc::default()),
        })
    }

    fn total(&self) -> usize {
        self.items.len()
    }

    fn room(&mut self) -> Result<()> {
        self.items.room(0)?;
        self.first.room(0)
    }

    fn image(&mut self, watch: &Watch) -> Result<SegmentsImage> {
        Ok(SegmentsImage {
            items: self.items.image(watch)?,
            first: self.first.image(watch)?,
            live: self.live,
            split: self.split,
            crossed: Arc::clone(&self.crossed),
        })
    }

    fn make_room(&mut self, image: &SegmentsImage, total: usize) -> Result<()> {
        self.items.make_room(&image.items)?;
        self.items.reserve(total.saturating_sub(self.items.len()))?;
        self.first.make_room(&image.first)
    }

    fn restore(&mut self, image: &SegmentsImage, total: usize) -> Result<()> {
        self.items.restore(&image.items)?;
        self.first.restore(&image.first)?;
        self.live = image.live;
        self.split = image.split;
        self.crossed = Arc::clone(&image.crossed);
        while self.items.len() < total {
            self.push()?;
        }
        Ok(())
    }

    fn own_bytes(image: &SegmentsImage, other: &SegmentsImage) -> usize {
        image.items.own_bytes(&other.items) + image.first.own_bytes(&other.first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_rows_follow_insertions_and_removals() {
        let mut segments = Segments::none().unwrap();
        let numbers: Vec<u32> = [[0, 1], [1, 2], [2, 2], [1, 0]]
            .into_iter()
            .map(|ends| segments.insert(ends).unwrap())
            .collect();
        assert_eq!(numbers, [0, 1, 2, 3]);
        let at = |s: &Segments, row| {
            let mut all: Vec<_> = s.at(row).collect();
            all.sort_unstable();
            all
        };
        assert_eq!(at(&segments, 1), [(0, 0), (1, 2), (3, 0)]);
        assert_eq!(at(&segments, 2), [(1, 1), (2, 2), (2, 2)]);
        segments.remove(1);
        segments.remove(3);
        assert_eq!(at(&segments, 1), [(0, 0)]);
        assert_eq!(at(&segments, 2), [(2, 2), (2, 2)]);
        segments.remove(2);
        assert!(at(&segments, 2).is_empty() && at(&segments, 9).is_empty());
        assert_eq!(at(&segments, 0), [(0, 1)]);
        assert_eq!((segments.live(), segments.total()), (1, 4));
        assert_eq!(segments.insert([2, 0]).unwrap(), 4);
    }
}
