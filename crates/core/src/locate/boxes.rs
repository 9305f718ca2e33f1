//! A tree of bounding boxes: finds the items whose boxes contain a point, and the nearest item.
//!
//! For arrays with holes or a concave boundary, where a walk that leaves the tiling proves nothing,
//! and for faces of a boundary.
//!
//! Items are sorted along the curve, eight to a box, eight boxes to the next, and so on (see
//! `base::boxes`).

use crate::base::boxes::{Levels, Open};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};
use crate::order::order_of;

/// Items per lowest box, and boxes per box.
const WIDTH: usize = 8;

/// Items between two checks for interruption.
const LOT: usize = 1 << 16;

/// The tree of boxes.
#[derive(Debug)]
pub struct Boxes<const D: usize> {
    /// Items along the curve.
    order: Vec<u32>,
    levels: Levels<D, WIDTH, WIDTH>,
}

impl<const D: usize> Boxes<D> {
    /// A tree of items, by the box of each.
    pub fn over(count: usize, box_of: impl Fn(usize) -> Extent<D>, watch: &Watch) -> Result<Self> {
        let mut middles = with_room(count)?;
        let mut pace = Pace::new(watch, LOT);
        for i in 0..count {
            pace.spend(1)?;
            let Extent { min, max } = box_of(i);
            middles.push(std::array::from_fn(|k| min[k] / 2.0 + max[k] / 2.0));
        }
        let order = order_of::<D>(&middles, 1, watch)?.concat();
        Self::packed(order, box_of, watch)
    }

    /// The same for items that are already sorted.
    pub fn packed(
        order: Vec<u32>,
        box_of: impl Fn(usize) -> Extent<D>,
        watch: &Watch,
    ) -> Result<Self> {
        let mut pace = Pace::new(watch, LOT);
        let ends = |e: Extent<D>| [e.min, e.max];
        let mut lowest = with_room(order.len().div_ceil(WIDTH))?;
        for run in order.chunks(WIDTH) {
            pace.spend(run.len())?;
            let boxes = run.iter().flat_map(|&i| ends(box_of(i as usize)));
            lowest.push(Extent::of(boxes));
        }
        let levels = Levels::over(order.len(), lowest, watch)?;
        Ok(Self { order, levels })
    }

    /// The item nearest to `q`, the first of several, and the value returned with its distance; the
    /// search starts at `hint`. Distances are requested as in [`Self::toward`].
    pub fn nearest<T: Copy>(
        &self,
        q: [f64; D],
        hint: Option<usize>,
        distance: impl Fn(usize, f64) -> (f64, T),
    ) -> Option<(usize, T)> {
        let mut best: Option<(usize, f64, T)> = None;
        self.toward(q, hint, |item, unit| {
            let (away, with) = distance(item, unit);
            let before = |(other, least, _): (usize, f64, T)| {
                away.total_cmp(&least).then(item.cmp(&other)).is_lt()
            };
            if best.is_none_or(before) {
                best = Some((item, away, with));
            }
            best.map_or(f64::INFINITY, |(_, least, _)| least)
        });
        best.map(|(item, _, with)| (item, with))
    }

    /// Calls `visit` on items, nearer boxes first, `hint` before all, and skips those whose boxes
    /// are farther from `q` than its last answer. It gets the factor of coordinates in which
    /// distances are doubles: 1 except for the largest. No item may be nearer than its box, up to
    /// rounding.
    pub fn toward(
        &self,
        q: [f64; D],
        hint: Option<usize>,
        mut visit: impl FnMut(usize, f64) -> f64,
    ) {
        let far = |p: [f64; D]| p.iter().any(|x| x.abs() > 1e300);
        let Some(root) = self.levels.root() else {
            return;
        };
        let unit = if far(q) || far(root.min) || far(root.max) {
            0.25
        } else {
            1.0
        };
        let bound = |extent: &Extent<D>| bound_from(extent, q, unit);
        self.search(hint, bound, |item| visit(item, unit));
    }

    /// The same by any measure, where `bound` gives a lower bound of it in a box.
    #[inline]
    pub fn search(
        &self,
        hint: Option<usize>,
        bound: impl Fn(&Extent<D>) -> f64,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        let mut open: Open = Vec::with_capacity(WIDTH * (self.levels.top() + 1));
        self.levels.open(&mut open, f64::NEG_INFINITY);
        if open.is_empty() {
            return;
        }
        let mut within = hint.map_or(f64::INFINITY, &mut visit);
        while let Some((away, level, i)) = open.pop() {
            let (level, i) = (level as usize, i as usize);
            if away > within {
                continue;
            }
            if level == 0 {
                for &item in &self.order[self.levels.items(0, i)] {
                    within = visit(item as usize);
                }
                continue;
            }
            self.levels.open_below(&mut open, level, i, |extent, _| {
                Some(bound(extent)).filter(|&away| away <= within)
            });
        }
    }

    /// Calls `visit` on the items of each lowest box that contains `q`.
    pub fn around(&self, q: [f64; D], visit: impl FnMut(usize)) {
        self.meeting(&Extent { min: q, max: q }, visit);
    }

    /// Calls `visit` on the items of each lowest box that meets `extent`.
    pub fn meeting(&self, extent: &Extent<D>, mut visit: impl FnMut(usize)) {
        let meets = |e: &Extent<D>, _, _| {
            (0..D).all(|k| e.min[k] <= extent.max[k] && extent.min[k] <= e.max[k])
        };
        self.levels.each(&mut Vec::new(), meets, |place| {
            visit(self.order[place] as usize);
            true
        });
    }
}

/// Sums of squares within these bounds have neither overflowed nor lost significant digits to
/// underflow.
const SAFE: std::ops::Range<f64> = 1e-290..1e300;

/// The length of a vector with any exponents.
pub fn length<const D: usize>(v: [f64; D]) -> f64 {
    let squares: f64 = v.iter().map(|x| x * x).sum();
    if SAFE.contains(&squares) {
        return squares.sqrt();
    }
    v.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}

/// A lower bound of the distance to the box, roundings allowed for.
#[inline]
pub fn bound_from<const D: usize>(extent: &Extent<D>, q: [f64; D], unit: f64) -> f64 {
    let gaps: [f64; D] = std::array::from_fn(|k| {
        let (min, max, x) = (extent.min[k] * unit, extent.max[k] * unit, q[k] * unit);
        (min - x).max(x - max).max(0.0)
    });
    length(gaps) * (1.0 - 1e-14) - 1e-320
}
