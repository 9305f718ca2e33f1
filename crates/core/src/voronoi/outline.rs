//! Classifies cells against an outline: touched by it, or in groups that are certainly on one side.
//!
//! Segments of the outline go into a grid; a cell is *touched* if the line of a segment crosses its
//! box, or is too close to tell. Cells that are not touched and share an edge lie on the same side,
//! so one test for each group of them suffices.

use delone_predicates::Point2;

use crate::base::error::Result;
use crate::base::memory::{copied, filled};
use crate::base::points::Extent;
use crate::base::sets::Sets;

/// The most columns and rows of the grid.
const MOST: f64 = 1024.0;
/// Cells count as touched within this fraction of the extent, which covers all rounding errors
/// here.
const CLOSE: f64 = 1e-9;

pub(super) struct Grid {
    origin: Point2,
    step: Point2,
    size: usize,
}

impl Grid {
    pub fn over(extent: Extent, items: usize) -> Self {
        let size = (items as f64).sqrt().clamp(1.0, MOST).ceil();
        Self {
            origin: extent.min,
            step: [0, 1].map(|k| ((extent.max[k] - extent.min[k]) / size).max(f64::MIN_POSITIVE)),
            size: size as usize,
        }
    }

    /// The columns (or rows) from `low` to `high`, plus one on either side.
    pub fn range(&self, k: usize, low: f64, high: f64) -> std::ops::RangeInclusive<usize> {
        let place = |x: f64| (x - self.origin[k]) / self.step[k];
        let last = self.size - 1;
        let from = (place(low) - 1.0).max(0.0) as usize;
        let to = (place(high) + 1.0).max(0.0) as usize;
        from.min(last)..=to.min(last)
    }

    /// The index of a field.
    pub fn field(&self, row: usize, column: usize) -> usize {
        row * self.size + column
    }

    /// Calls `mark` with each field that a segment may meet.
    fn along(&self, [a, b]: [Point2; 2], mut mark: impl FnMut(usize)) {
        for row in self.range(1, a[1].min(b[1]), a[1].max(b[1])) {
            // The part of the segment that lies in this row and its neighbors.
            let low = self.origin[1] + (row as f64 - 1.0) * self.step[1];
            let high = low + 3.0 * self.step[1];
            let at = |y: f64| ((y - a[1]) / (b[1] - a[1])).clamp(0.0, 1.0);
            let (s, t) = if a[1] == b[1] {
                (0.0, 1.0)
            } else {
                (at(low), at(high))
            };
            let (p, q) = (a[0] + s * (b[0] - a[0]), a[0] + t * (b[0] - a[0]));
            for column in self.range(0, p.min(q), p.max(q)) {
                mark(self.field(row, column));
            }
        }
    }
}

/// For each convex polygon, the number of its group of untouched ones, or -1 if it is touched or
/// has no corners; and how many groups there are. `ridges` names the edges that two polygons share;
/// -1 for other edges.
pub fn touched(
    starts: &[i32],
    points: &[Point2],
    ridges: &[i32],
    segments: &[[f64; 4]],
) -> Result<(Vec<i32>, usize)> {
    let cells = starts.len().saturating_sub(1);
    let ends = segments.iter().flat_map(|s| [[s[0], s[1]], [s[2], s[3]]]);
    let extent = Extent::of(points.iter().copied().chain(ends));
    let grid = &Grid::over(extent, cells.max(segments.len()));
    let (first, members) = sorted(grid, segments)?;
    let close = CLOSE * extent.side();
    let mut free = filled(cells, false)?;
    for (i, free) in free.iter_mut().enumerate() {
        let corners = &points[starts[i] as usize..starts[i + 1] as usize];
        let cell = Extent::of(corners.iter().copied());
        let mut fields = grid.range(1, cell.min[1], cell.max[1]).flat_map(|row| {
            let columns = grid.range(0, cell.min[0], cell.max[0]);
            columns.map(move |column| grid.field(row, column))
        });
        let near = |field: usize| {
            let range = first[field] as usize..first[field + 1] as usize;
            members[range]
                .iter()
                .any(|&s| meets(cell, segments[s as usize], close))
        };
        *free = !corners.is_empty() && !fields.any(near);
    }
    groups(starts, ridges, &free)
}

/// Segments by field of the grid: where those of each field begin, and their numbers.
pub(super) fn sorted(grid: &Grid, segments: &[[f64; 4]]) -> Result<(Vec<u32>, Vec<u32>)> {
    let ends = |s: &[f64; 4]| [[s[0], s[1]], [s[2], s[3]]];
    let mut first = filled(grid.size * grid.size + 1, 0_u32)?;
    for segment in segments {
        grid.along(ends(segment), |field| first[field + 1] += 1);
    }
    for field in 0..grid.size * grid.size {
        first[field + 1] += first[field];
    }
    let mut place = copied(&first)?;
    let mut members = filled(first[grid.size * grid.size] as usize, 0)?;
    for (number, segment) in (0_u32..).zip(segments) {
        grid.along(ends(segment), |field| {
            members[place[field] as usize] = number;
            place[field] += 1;
        });
    }
    Ok((first, members))
}

/// Whether a segment meets a box, or is too close to tell.
fn meets(cell: Extent, [ax, ay, bx, by]: [f64; 4], close: f64) -> bool {
    let (a, b) = ([ax, ay], [bx, by]);
    for k in 0..2 {
        if a[k].max(b[k]) < cell.min[k] - close || a[k].min(b[k]) > cell.max[k] + close {
            return false;
        }
    }
    // All corners are on one side of its line, by more than `close`.
    let (dx, dy) = (bx - ax, by - ay);
    let bound = close * (dx.abs() + dy.abs());
    let side = |x: f64, y: f64| dx * (y - ay) - dy * (x - ax);
    let sides = [
        side(cell.min[0], cell.min[1]),
        side(cell.max[0], cell.min[1]),
        side(cell.min[0], cell.max[1]),
        side(cell.max[0], cell.max[1]),
    ];
    !(sides.iter().all(|&s| s > bound) || sides.iter().all(|&s| s < -bound))
}

/// Groups of untouched polygons that are connected by common edges, numbered by their first
/// members.
fn groups(starts: &[i32], ridges: &[i32], free: &[bool]) -> Result<(Vec<i32>, usize)> {
    let mut sets = Sets::of(free.len())?;
    let most = ridges.iter().copied().max().unwrap_or(-1);
    let mut first = filled((most + 1) as usize, u32::MAX)?;
    for (i, _) in (0_u32..).zip(free).filter(|(_, free)| **free) {
        let entries = starts[i as usize] as usize..starts[i as usize + 1] as usize;
        for &ridge in ridges[entries].iter().filter(|&&r| r >= 0) {
            let other = &mut first[ridge as usize];
            if *other == u32::MAX {
                *other = i;
                continue;
            }
            sets.join(*other, i);
        }
    }
    sets.numbered(|i| free[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_between_two_squares_leaves_two_groups() {
        // Four unit squares in a row; the segment is in the second.
        let mut points = Vec::new();
        for i in 0..4 {
            let x = f64::from(i);
            points.extend([[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]]);
        }
        let ridges = [-1, 0, -1, -1, -1, 1, -1, 0, -1, 2, -1, 1, -1, -1, -1, 2];
        let segment = [1.5, -1.0, 1.5, 2.0];
        let (group, count) = touched(&[0, 4, 8, 12, 16], &points, &ridges, &[segment]).unwrap();
        assert_eq!(group, [0, -1, 1, 1]);
        assert_eq!(count, 2);
    }

    #[test]
    fn a_diagonal_does_not_touch_everything_in_its_box() {
        let cell = Extent {
            min: [3.0, 0.0],
            max: [4.0, 1.0],
        };
        assert!(!meets(cell, [0.0, 0.0, 4.0, 4.0], 1e-9));
        assert!(meets(cell, [0.0, 0.0, 4.0, 1.0], 1e-9));
    }
}
