//! Checks of a point set before triangulation: finite coordinates, bounding box, degenerate sets.

use delone_predicates::{Point2, Point3, lexicographic, orient2d};

use crate::base::error::{Error, Result};

/// Points that one 2-D mesh can hold: half-edge codes are `8 t + k` in 32 bits, and n points have
/// 2 n - 2 triangles with ghosts.
pub const LIMIT2: usize = 1 << 28;

/// Points that one 3-D mesh can hold: facet codes are `4 t + k` in 32 bits, and uniform points have
/// seven tetrahedra each, ghosts included. Sets with more tetrahedra per point reach the limit of
/// the mesh.
pub const LIMIT3: usize = 1 << 27;

/// How many invalid rows an error names.
pub const NAMED_ROWS: usize = 10;

/// The bounding box of a finite point set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent<const D: usize = 2> {
    /// Smallest coordinate of each axis.
    pub min: [f64; D],
    /// Largest coordinate of each axis.
    pub max: [f64; D],
}

impl<const D: usize> Extent<D> {
    /// The box of all points.
    pub const EVERYWHERE: Self = Self {
        min: [f64::NEG_INFINITY; D],
        max: [f64::INFINITY; D],
    };

    /// The box of some points, which must be finite; inverted (`min` > `max`) if there are none.
    pub fn of(points: impl IntoIterator<Item = [f64; D]>) -> Self {
        let mut e = Self {
            min: [f64::INFINITY; D],
            max: [f64::NEG_INFINITY; D],
        };
        for p in points {
            for (k, x) in p.into_iter().enumerate() {
                // A selection is one instruction; `f64::min` also has to handle NaN.
                e.min[k] = if x < e.min[k] { x } else { e.min[k] };
                e.max[k] = if x > e.max[k] { x } else { e.max[k] };
            }
        }
        e
    }

    /// The box of all that is in some boxes.
    pub fn over(boxes: &[Self]) -> Self {
        Self::of(boxes.iter().flat_map(|e| [e.min, e.max]))
    }

    /// The longest side, rounded; infinite if it exceeds the range of doubles.
    pub fn side(&self) -> f64 {
        (0..D).fold(f64::NEG_INFINITY, |side, k| {
            side.max(self.max[k] - self.min[k])
        })
    }
}

/// Checks that the coordinates of `points` can be triangulated.
pub fn scan<const D: usize>(points: &[[f64; D]]) -> Result<()> {
    let limit = if D == 2 { LIMIT2 } else { LIMIT3 };
    if points.len() > limit {
        return Err(Error::TooMany {
            found: points.len(),
            limit,
        });
    }
    finite(points.as_flattened(), D)
}

/// Checks that rows of `d` coordinates are finite.
pub fn finite(coordinates: &[f64], d: usize) -> Result<()> {
    // The sum of 0 * x is 0 only if all x are finite; it needs no branch per row.
    let zero: f64 = coordinates.iter().map(|x| 0.0 * x).sum();
    if zero == 0.0 {
        return Ok(());
    }
    let rows = || (0u32..).zip(coordinates.chunks_exact(d));
    let bad = rows().filter(|(_, p)| !p.iter().all(|x| x.is_finite()));
    Err(Error::NonFinite {
        rows: bad.clone().map(|(i, _)| i).take(NAMED_ROWS).collect(),
        count: bad.count(),
    })
}

/// The error of distinct `points` that span no triangle; `rows` are their rows in the input.
pub fn degenerate(points: &[Point2], rows: &[u32]) -> Error {
    let mut order: Vec<u32> = (0u32..).zip(points).map(|(i, _)| i).collect();
    order.sort_unstable_by(|&i, &j| lexicographic(points[i as usize], points[j as usize]));
    let chain = order.iter().map(|&i| rows[i as usize]).collect();
    if points.len() < 3 {
        Error::TooFew { chain }
    } else {
        Error::Collinear { chain }
    }
}

/// The error of distinct 3-D `points` that span no tetrahedron.
pub fn degenerate_in_space(points: &[Point3], rows: &[u32]) -> Error {
    let mut order: Vec<u32> = (0u32..).zip(points).map(|(i, _)| i).collect();
    order.sort_unstable_by(|&i, &j| lexicographic(points[i as usize], points[j as usize]));
    let chain = order.iter().map(|&i| rows[i as usize]).collect();
    let in_line = |&c: &Point3| collinear(points[0], points[1], c);
    if points.len() < 4 {
        Error::TooFewInSpace { chain }
    } else if points.iter().all(in_line) {
        Error::Collinear { chain }
    } else {
        Error::Coplanar { chain }
    }
}

/// Whether three points in 3-D are collinear: all projections are, and the cross product is zero.
pub fn collinear(a: Point3, b: Point3, c: Point3) -> bool {
    let turn = |j: usize, k: usize| orient2d([a[j], a[k]], [b[j], b[k]], [c[j], c[k]]);
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(j, k)| turn(j, k).is_zero())
}
