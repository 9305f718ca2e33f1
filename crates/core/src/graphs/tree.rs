//! A tree of bounding boxes over distinct points along the curve (as in `locate`, an R-tree packed
//! along the Hilbert curve: I. Kamel and C. Faloutsos, 1993).
//!
//! A search is complete because it skips only boxes that contain no point of the region: each bound
//! of a box allows for its roundings.

use std::ops::Range;

use delone_predicates::{Point2, Point3};

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::parallel;
use crate::base::points::{Extent, scan};
use crate::base::watch::Watch;
use crate::order::{arrange, space};

/// Points per lowest box.
pub(crate) const LEAF: usize = 8;
/// Boxes per box.
const WIDTH: usize = 4;
/// Lowest boxes per task.
const SHARE: usize = 1 << 12;

/// Distinct points along the curve.
pub struct Along<const D: usize> {
    points: Vec<[f64; D]>,
    rows: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
}

/// Points of a dimension that can be sorted along the curve.
pub trait Distinct<const D: usize> {
    /// The distinct points of finite ones, and `[row, first row]` of the duplicates.
    fn distinct(points: &[[f64; D]], workers: usize, watch: &Watch) -> Result<Along<D>>;
}

impl Distinct<2> for Point2 {
    fn distinct(points: &[Self], workers: usize, watch: &Watch) -> Result<Along<2>> {
        let found = arrange(points, workers, watch)?;
        Ok(Along {
            points: found.points,
            rows: found.rows,
            duplicates: found.duplicates,
        })
    }
}

impl Distinct<3> for Point3 {
    fn distinct(points: &[Self], _workers: usize, watch: &Watch) -> Result<Along<3>> {
        let found = space::arrange(points, watch)?;
        Ok(Along {
            points: found.points,
            rows: found.rows,
            duplicates: found.duplicates,
        })
    }
}

/// The tree.
pub struct Tree<const D: usize> {
    /// Distinct points along the curve.
    pub(crate) points: Vec<[f64; D]>,
    /// For each, its first row in the input.
    pub(crate) rows: Vec<u32>,
    /// `[row, first row of the same point]` for each further row, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// The boxes of each level, from those of points up to a single one.
    pub(crate) levels: Vec<Vec<Extent<D>>>,
}

impl<const D: usize> Tree<D> {
    /// The tree of the distinct ones of `points`, which are checked.
    pub fn of(points: &[[f64; D]], workers: usize, watch: &Watch) -> Result<Self>
    where
        [f64; D]: Distinct<D>,
    {
        scan(points)?;
        let along = <[f64; D]>::distinct(points, workers, watch)?;
        let shares = along.points.chunks(LEAF * SHARE).collect();
        let parts = parallel::map_watched(workers, shares, watch, |share: &[[f64; D]]| {
            let mut boxes = with_room(share.len().div_ceil(LEAF))?;
            boxes.extend(
                share
                    .chunks(LEAF)
                    .map(|leaf| Extent::of(leaf.iter().copied())),
            );
            Ok(boxes)
        })?;
        let mut levels = vec![parts.concat()];
        while levels[levels.len() - 1].len() > 1 {
            watch.check()?;
            let join = |run: &[Extent<D>]| Extent::of(run.iter().flat_map(|e| [e.min, e.max]));
            levels.push(levels[levels.len() - 1].chunks(WIDTH).map(join).collect());
        }
        Ok(Self {
            points: along.points,
            rows: along.rows,
            duplicates: along.duplicates,
            levels,
        })
    }

    /// The number of distinct points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The places of the points of a box.
    #[inline]
    pub(crate) fn places(&self, level: usize, i: usize) -> Range<usize> {
        let width = LEAF * WIDTH.pow(level as u32);
        i * width..((i + 1) * width).min(self.points.len())
    }

    /// The boxes of a box on a level above 0.
    #[inline]
    pub(crate) fn below(&self, level: usize, i: usize) -> Range<usize> {
        i * WIDTH..((i + 1) * WIDTH).min(self.levels[level - 1].len())
    }

    /// Calls `visit` on the places of points in all boxes that `enter` accepts, by level and
    /// number, until it answers `false`; whether it never did.
    #[inline]
    pub(crate) fn each(
        &self,
        open: &mut Vec<(usize, usize)>,
        enter: impl Fn(&Extent<D>, usize, usize) -> bool,
        mut visit: impl FnMut(usize) -> bool,
    ) -> bool {
        open.clear();
        if !self.is_empty() {
            open.push((self.levels.len() - 1, 0));
        }
        while let Some((level, i)) = open.pop() {
            if !enter(&self.levels[level][i], level, i) {
                continue;
            }
            if level > 0 {
                open.extend(self.below(level, i).map(|child| (level - 1, child)));
            } else if !self.places(0, i).all(&mut visit) {
                return false;
            }
        }
        true
    }
}

/// The squared distance of a box from `q`, rounded; 0 inside.
#[inline]
pub(crate) fn squared_gap<const D: usize>(extent: &Extent<D>, q: [f64; D]) -> f64 {
    (0..D).fold(0.0, |sum, k| {
        let (before, after) = (extent.min[k] - q[k], q[k] - extent.max[k]);
        let gap = if before > after { before } else { after };
        sum + if gap > 0.0 { gap * gap } else { 0.0 }
    })
}

/// The squared distance of two points, rounded.
#[inline]
pub(crate) fn squared<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    (0..D).fold(0.0, |sum, k| {
        let x = a[k] - b[k];
        sum + x * x
    })
}

/// Whether one squared distance is certainly larger than another: each errs by less than 1e-15 of
/// itself, and by underflow. `false` for NaN and infinity.
#[inline]
pub(crate) fn certainly_above(one: f64, other: f64) -> bool {
    one * (1.0 - 1e-14) > other * (1.0 + 1e-14) + f64::MIN_POSITIVE && one < f64::INFINITY
}
