//! Bounding boxes over items that are sorted along a curve, level by level: a few items to a lowest box,
//! a few boxes to the next, and so on up to a single one (an R-tree packed along the Hilbert curve:
//! I. Kamel and C. Faloutsos, "On packing R-trees", CIKM 1993).
//!
//! What the items are is up to the owner: simplices and faces in `locate::Boxes`, points in
//! `graphs::Tree`, segments in `constrained::pairs`. A search skips a box only if nothing in it can
//! count, so each bound of a box allows for its roundings.

use std::ops::Range;

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};

/// Boxes that are joined between two checks for interruption.
const LOT: usize = 1 << 16;

/// The boxes of `LEAF` items each, then of `WIDTH` boxes each.
#[derive(Debug)]
pub struct Levels<const D: usize, const LEAF: usize, const WIDTH: usize> {
    /// The boxes of each level, from those of items up to a single one.
    levels: Vec<Vec<Extent<D>>>,
    /// The number of items.
    count: usize,
}

/// Boxes to enter: a lower bound of what is in them, level and number.
pub type Open = Vec<(f64, u32, u32)>;

impl<const D: usize, const LEAF: usize, const WIDTH: usize> Levels<D, LEAF, WIDTH> {
    /// The levels above the lowest boxes of `count` items.
    pub fn over(count: usize, lowest: Vec<Extent<D>>, watch: &Watch) -> Result<Self> {
        let mut pace = Pace::new(watch, LOT);
        let mut levels = Vec::new();
        let mut level = lowest;
        while level.len() > 1 {
            let mut above = with_room(level.len().div_ceil(WIDTH))?;
            for run in level.chunks(WIDTH) {
                pace.spend(run.len())?;
                above.push(Extent::over(run));
            }
            levels.push(std::mem::replace(&mut level, above));
        }
        levels.push(level);
        Ok(Self { levels, count })
    }

    /// The number of the highest level.
    #[inline]
    pub fn top(&self) -> usize {
        self.levels.len() - 1
    }

    /// The box of everything; `None` without items.
    pub fn root(&self) -> Option<&Extent<D>> {
        self.levels[self.top()].first()
    }

    /// The boxes of a level.
    #[inline]
    pub fn at(&self, level: usize) -> &[Extent<D>] {
        &self.levels[level]
    }

    /// The items of a box.
    #[inline]
    pub fn items(&self, level: usize, i: usize) -> Range<usize> {
        let width = LEAF * WIDTH.pow(level as u32);
        i * width..((i + 1) * width).min(self.count)
    }

    /// The boxes of a box on a level above 0.
    #[inline]
    pub fn below(&self, level: usize, i: usize) -> Range<usize> {
        i * WIDTH..((i + 1) * WIDTH).min(self.levels[level - 1].len())
    }

    /// A value for each box, by level: of its items in the lowest ones, then of the values below.
    pub fn values<T>(
        &self,
        of_items: impl Fn(Range<usize>) -> T,
        joined: impl Fn(&[T]) -> T,
    ) -> Result<Vec<Vec<T>>> {
        let mut values: Vec<Vec<T>> = Vec::new();
        for (level, boxes) in self.levels.iter().enumerate() {
            let mut own = with_room(boxes.len())?;
            own.extend((0..boxes.len()).map(|i| match level {
                0 => of_items(self.items(0, i)),
                _ => joined(&values[level - 1][self.below(level, i)]),
            }));
            values.push(own);
        }
        Ok(values)
    }

    /// Calls `visit` on the items of all lowest boxes that `enter` accepts with all above them, by
    /// level and number, until it answers `false`; whether it never did.
    #[inline]
    pub fn each(
        &self,
        open: &mut Vec<(usize, usize)>,
        enter: impl Fn(&Extent<D>, usize, usize) -> bool,
        mut visit: impl FnMut(usize) -> bool,
    ) -> bool {
        open.clear();
        if self.count > 0 {
            open.push((self.top(), 0));
        }
        while let Some((level, i)) = open.pop() {
            if !enter(&self.levels[level][i], level, i) {
                continue;
            }
            if level > 0 {
                open.extend(self.below(level, i).map(|child| (level - 1, child)));
            } else if !self.items(0, i).all(&mut visit) {
                return false;
            }
        }
        true
    }

    /// Starts a search from the nearest box on.
    #[inline]
    pub fn open(&self, open: &mut Open, bound: f64) {
        open.clear();
        if self.count > 0 {
            open.push((bound, self.top() as u32, 0));
        }
    }

    /// Adds those boxes of a box on a level above 0 for which `bound` has a value. The one with the
    /// smallest goes last, so it is next.
    #[inline]
    pub fn open_below(
        &self,
        open: &mut Open,
        level: usize,
        i: usize,
        mut bound: impl FnMut(&Extent<D>, usize) -> Option<f64>,
    ) {
        let from = open.len();
        let boxes = &self.levels[level - 1];
        let below = self.below(level, i);
        for (child, extent) in below.clone().zip(&boxes[below]) {
            let Some(bound) = bound(extent, child) else {
                continue;
            };
            open.push((bound, level as u32 - 1, child as u32));
            let mut at = open.len() - 1;
            while at > from && open[at - 1].0 < bound {
                open.swap(at - 1, at);
                at -= 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes of points in a row, two to a lowest box and three to the others.
    fn row(count: usize) -> Levels<1, 2, 3> {
        let at = |i: usize| [i as f64];
        let ends: Vec<usize> = (0..count).collect();
        let lowest = ends
            .chunks(2)
            .map(|run| Extent::of(run.iter().map(|&i| at(i))));
        Levels::over(count, lowest.collect(), &Watch::idle()).unwrap()
    }

    #[test]
    fn each_box_has_its_items_and_those_of_the_boxes_below() {
        for count in (0..60).chain([10_000]) {
            let row = row(count);
            assert_eq!(row.root().is_none(), count == 0);
            for level in 0..=row.top() {
                let mut next = 0;
                for (i, extent) in row.at(level).iter().enumerate() {
                    let items = row.items(level, i);
                    assert_eq!((items.start, items.is_empty()), (next, false));
                    let ends = [items.start as f64, items.end as f64 - 1.0];
                    assert_eq!((extent.min[0], extent.max[0]), (ends[0], ends[1]));
                    if level > 0 {
                        let below = row.below(level, i);
                        assert_eq!(row.items(level - 1, below.start).start, items.start);
                        assert_eq!(row.items(level - 1, below.end - 1).end, items.end);
                    }
                    next = items.end;
                }
                assert_eq!(next, count);
            }
            let mut seen = Vec::new();
            row.each(
                &mut Vec::new(),
                |_, _, _| true,
                |i| {
                    seen.push(i);
                    true
                },
            );
            seen.sort_unstable();
            assert_eq!(seen, (0..count).collect::<Vec<_>>());
        }
    }

    #[test]
    fn searches_visit_what_they_accept_and_the_nearest_box_first() {
        let row = row(50);
        let mut seen = Vec::new();
        let all = row.each(
            &mut Vec::new(),
            |extent, _, _| extent.max[0] >= 20.0 && extent.min[0] < 22.0,
            |i| {
                seen.push(i);
                true
            },
        );
        assert_eq!((all, seen), (true, vec![20, 21]));
        assert!(!row.each(&mut Vec::new(), |_, _, _| true, |i| i != 7));
        let sums = row.values(|items| items.sum::<usize>(), |below| below.iter().sum());
        assert_eq!(sums.unwrap()[row.top()], [49 * 25]);

        let (mut open, mut leaves) = (Vec::new(), Vec::new());
        row.open(&mut open, 0.0);
        while let Some((_, level, i)) = open.pop() {
            if level == 0 {
                leaves.push(i as usize);
                continue;
            }
            row.open_below(&mut open, level as usize, i as usize, |extent, _| {
                let gap = (extent.min[0] - 31.0).max(31.0 - extent.max[0]).max(0.0);
                (gap < 12.0).then_some(gap)
            });
        }
        assert_eq!(leaves[..2], [15, 16]);
        leaves.sort_unstable();
        assert_eq!(leaves, (10..22).collect::<Vec<_>>());
    }
}
