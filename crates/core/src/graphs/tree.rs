//! A tree of bounding boxes over distinct points along the curve (see `base::boxes`), and distances
//! that allow for rounding errors.

use delone_predicates::{Point2, Point3};

use crate::base::boxes::Levels;
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
    /// Their boxes.
    pub(crate) boxes: Levels<D, LEAF, WIDTH>,
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
        Ok(Self {
            boxes: Levels::over(along.points.len(), parts.concat(), watch)?,
            points: along.points,
            rows: along.rows,
            duplicates: along.duplicates,
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
