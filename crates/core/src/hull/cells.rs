//! Cells of directions: the farthest point in each, and a test for points certainly inside the
//! hull.
//!
//! Seen from the inner point o, directions are cells on the six sides of a cube. The deepest point
//! of each cell is likely to be on the hull, and few others are. Once these are inserted, one point
//! on the ray through each corner of the cells is known to be in the hull. So is the pyramid from o
//! to the four points of a cell, and with it all of the cell up to the least of their depths.
//!
//! # Rounding
//!
//! The points on the corners' rays are rounded, but the rounded points are in the hull, by exact
//! predicates. A point is taken to be inside only if its direction, which has a relative error of a
//! few 2^-53, is farther from the bounds of its cell than a share `MARGIN` of the cell, and if it
//! is less deep by the share `MARGIN`. A corner's point may be off its ray by a unit in the last
//! place of the coordinates, and counts only if that is less than a hundredth of `MARGIN` of its
//! depth.

use delone_predicates::{Point3, Sign};

use super::inner::Inner;
use super::insertion::{Hull, Toward};
use crate::base::error::Result;
use crate::base::watch::Watch;

/// Points between two checks for interruption.
const LOT: usize = 1 << 16;
/// Points per cell: the walks of a cell, to one point and one corner, then cost a small part of
/// what walks to all points would.
const POINTS: usize = 16;
/// The most cells along each edge of the cube: more cost more than they save.
const MOST: usize = 32;
/// Share of a cell, and of a depth, that is far above rounding errors.
const MARGIN: f64 = 1e-6;
/// Facet planes that a ray may meet from outside before its corner is given up.
const TRIES: usize = 16;
/// Sizes of hulls whose planes are computed without overflow or underflow.
const SAFE: std::ops::Range<f64> = 1e-90..1e90;

/// Cells of directions from a point.
#[derive(Clone, Copy)]
pub struct Grid {
    o: Point3,
    /// The number of cells along each edge of the cube.
    cells: usize,
}

/// The cell of a point.
struct Place {
    cell: usize,
    depth: f64,
    /// Whether rounding cannot have moved it here from another cell.
    sure: bool,
}

impl Grid {
    /// A grid for this many points around the inner point of a hull; `None` if the inner point is
    /// not a double.
    pub fn of(hull: &Hull, points: usize) -> Option<Self> {
        let Inner::At(o) = hull.inner else {
            return None;
        };
        let cells = (points / (6 * POINTS)).isqrt().clamp(1, MOST);
        Some(Self { o, cells })
    }

    #[inline]
    fn place(&self, p: Point3) -> Place {
        let way = [0, 1, 2].map(|k| p[k] - self.o[k]);
        let size = way.map(f64::abs);
        let axis = if size[0] >= size[1] && size[0] >= size[2] {
            0
        } else if size[1] >= size[2] {
            1
        } else {
            2
        };
        let (half, last) = (self.cells as f64 / 2.0, self.cells - 1);
        let along = |k: usize| {
            let place = (way[(axis + k) % 3] / size[axis] + 1.0) * half;
            // NaN, at o itself, becomes 0, and then is not within the margin.
            let whole = (place as usize).min(last);
            let rest = place - whole as f64;
            (whole, rest > MARGIN && rest < 1.0 - MARGIN)
        };
        let ((i, apart), (j, too)) = (along(1), along(2));
        let side = 2 * axis + usize::from(way[axis] < 0.0);
        Place {
            cell: (side * self.cells + i) * self.cells + j,
            depth: size[axis],
            sure: apart && too,
        }
    }

    /// The deepest point of each nonempty cell.
    pub fn deepest(&self, points: &[Point3], watch: &Watch) -> Result<Vec<u32>> {
        let mut most = vec![(0.0, u32::MAX); 6 * self.cells * self.cells];
        for (first, lot) in (0u32..).step_by(LOT).zip(points.chunks(LOT)) {
            watch.check()?;
            for (row, &p) in (first..).zip(lot) {
                let Place { cell, depth, .. } = self.place(p);
                if depth > most[cell].0 {
                    most[cell] = (depth, row);
                }
            }
        }
        let found = most.into_iter().map(|(_, row)| row);
        Ok(found.filter(|&row| row != u32::MAX).collect())
    }
}

/// Depths for each side of the cube and each cell.
pub struct Cells {
    grid: Grid,
    depths: Vec<f64>,
}

impl Cells {
    /// The depths of a hull; `None` if its size is out of range.
    pub fn of(hull: &Hull, grid: Grid) -> Option<Self> {
        let Grid { o, cells } = grid;
        let (size, most) = hull.reach(o);
        if !SAFE.contains(&size) || !most.is_finite() {
            return None;
        }
        // The rounding of a coordinate, over the share of a depth that is negligible.
        let least = most * f64::EPSILON / (MARGIN / 100.0 / cells as f64);
        // Alternating directions, so that each walk is short.
        let back_and_forth = |i: usize, j: usize| match i & 1 {
            0 => j,
            _ => cells - j,
        };
        let mut near = hull.near();
        let mut depths = vec![0.0; 6 * cells * cells];
        let mut corners = vec![0.0; (cells + 1) * (cells + 1)];
        for side in 0..6 {
            let of = |i: usize| 2.0 * i as f64 / cells as f64 - 1.0;
            for (at, depth) in corners.iter_mut().enumerate() {
                let (i, j) = (at / (cells + 1), at % (cells + 1));
                let mut way = [0.0; 3];
                way[side / 2] = if side % 2 == 0 { 1.0 } else { -1.0 };
                way[(side / 2 + 1) % 3] = of(i);
                way[(side / 2 + 2) % 3] = of(back_and_forth(i, j));
                let found = depth_along(hull, o, way, 2.0 * size, &mut near);
                *depth = if found > least { found } else { 0.0 };
            }
            let corner = |i: usize, j: usize| corners[i * (cells + 1) + back_and_forth(i, j)];
            for i in 0..cells {
                for j in 0..cells {
                    let four = [(i, j), (i, j + 1), (i + 1, j), (i + 1, j + 1)];
                    let depths_of = four.into_iter().map(|(i, j)| corner(i, j));
                    let least = depths_of.fold(f64::INFINITY, f64::min);
                    depths[(side * cells + i) * cells + j] = least * (1.0 - MARGIN);
                }
            }
        }
        Some(Self { grid, depths })
    }

    /// Whether `p` is certainly in the hull and not an extreme point.
    #[inline]
    pub fn holds(&self, p: Point3) -> bool {
        let Place { cell, depth, sure } = self.grid.place(p);
        sure && depth <= self.depths[cell]
    }
}

/// How far along a ray from `o` a rounded point is in the hull, nearly maximal; 0 if none is found.
/// The direction has a largest coordinate of 1, and the ray's end is outside.
fn depth_along(hull: &Hull, o: Point3, way: Point3, end: f64, near: &mut u32) -> f64 {
    let mut depth = end;
    for _ in 0..TRIES {
        let at = [0, 1, 2].map(|k| o[k] + depth * way[k]);
        match hull.toward(at, *near) {
            Toward::Before(facet) => {
                *near = facet;
                // A point on a facet might be extreme.
                let inside = hull.side(at, facet) == Sign::Negative;
                return if inside { depth } else { 0.0 };
            }
            Toward::Beyond(facet) => {
                *near = facet;
                let [a, b, c] = hull.corners(facet).map(|p| [0, 1, 2].map(|k| p[k] - o[k]));
                let (u, v) = (
                    [0, 1, 2].map(|k| b[k] - a[k]),
                    [0, 1, 2].map(|k| c[k] - a[k]),
                );
                let normal = [0, 1, 2].map(|k| {
                    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                    u[i] * v[j] - u[j] * v[i]
                });
                let dot = |p: Point3| (0..3).map(|k| p[k] * normal[k]).sum::<f64>();
                let met = dot(a) / dot(way) * (1.0 - MARGIN);
                if !(met > 0.0 && met < depth) {
                    return 0.0;
                }
                depth = met;
            }
        }
    }
    0.0
}
