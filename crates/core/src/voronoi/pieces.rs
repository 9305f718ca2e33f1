//! Clips convex cells by an outline, where exact predicates decide.
//!
//! The outline is a set of rings with the inside to the left of each. Four exact orientations
//! decide whether a segment of it crosses an edge of a cell; the crossing is rounded once. From
//! each crossing where the outline enters the cell, a piece follows the outline until it leaves,
//! then the boundary of the cell counterclockwise to the next crossing, and so on until it closes
//! (K. Weiler and P. Atherton, "Hidden surface removal using polygon area sorting", SIGGRAPH 1977).
//! Rounding to nearest is monotone, so rounded crossings that differ are in their true order along
//! an edge.
//!
//! All degenerate cases are *doubtful* and left to the caller: a corner of one on an edge of the
//! other, edges that overlap, crossings that round to the same point, or a cell that rounding has
//! made concave. So is a cell that would take too long: the time is quadratic in the number of
//! corners near each other.

use std::cmp::Ordering;

use delone_predicates::{Point2, Sign, orient2d};

use super::measure::{Measures, ring as ring_measures};
use super::outline::{Grid, sorted};
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::constrained::intersection::intersection;

/// Cells per task.
const SHARE: usize = 1 << 7;
/// The most orientation tests for one cell: about 0.1 s.
const MOST: usize = 1 << 22;
/// The most rings of the outline within one cell.
const MOST_RINGS: usize = 1 << 9;

/// Convex polygons: the cells.
#[derive(Clone, Copy)]
pub struct Convex<'a> {
    /// The corners of cell i are `starts[i]..starts[i + 1]`.
    pub starts: &'a [i32],
    /// Corners, counterclockwise.
    pub corners: &'a [Point2],
    /// The ridge along which each edge lies, from its corner to the next.
    pub ridges: &'a [i32],
}

/// Rings with the inside to their left. They may touch, but neither cross nor overlap.
#[derive(Clone, Copy)]
pub struct Outline<'a> {
    /// The corners of ring i are `starts[i]..starts[i + 1]`, the first one not repeated.
    pub starts: &'a [i32],
    /// Corners.
    pub points: &'a [Point2],
}

impl Outline<'_> {
    fn ring(&self, r: usize) -> std::ops::Range<usize> {
        self.starts[r] as usize..self.starts[r + 1] as usize
    }
}

/// What is left of a cell after clipping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// Exact predicates leave this undecided.
    Doubtful = -1,
    /// Nothing.
    Nothing = 0,
    /// The whole cell.
    Whole = 1,
    /// The parts in the arrays.
    Parts = 2,
}

/// What is left of some cells: parts, each an outer ring and its holes.
#[derive(Debug, Default)]
pub struct Pieces {
    /// For each cell a value of [`Left`].
    pub left: Vec<i8>,
    /// The parts of cell i are `cells[i]..cells[i + 1]`.
    pub cells: Vec<i64>,
    /// The rings of part i are `parts[i]..parts[i + 1]`.
    pub parts: Vec<i64>,
    /// The corners of ring i are `rings[i]..rings[i + 1]`.
    pub rings: Vec<i64>,
    /// Corners.
    pub points: Vec<Point2>,
    /// The ridge along which each edge lies, from its corner to the next; -1 along the outline.
    pub ridges: Vec<i32>,
    /// The measures of the parts of each cell together; without parts 0, and NaN for the centroid.
    pub measures: Measures,
}

type Ring = Vec<(Point2, i32)>;

/// Clips the cells of `rows`; `inside` tells for each whether its first corner is inside the
/// outline.
pub fn pieces(
    cells: Convex,
    rows: &[i32],
    inside: &[bool],
    outline: Outline,
    workers: usize,
    watch: &Watch,
) -> Result<Pieces> {
    let cutter = Cutter::of(cells, outline)?;
    let tasks = rows.chunks(SHARE).zip(inside.chunks(SHARE));
    let found = parallel::map(workers, tasks.collect(), |(rows, inside)| {
        watch.check()?;
        let mut work = Work::default();
        let cut = |(&row, &inside): (&i32, &bool)| {
            let (left, rings) = cutter.cell(row as usize, inside, &mut work);
            nested(rings).map_or((Left::Doubtful, Vec::new()), |parts| (left, parts))
        };
        Ok(rows.iter().zip(inside).map(cut).collect::<Vec<_>>())
    });
    let mut out = Pieces {
        left: with_room(rows.len())?,
        cells: with_room(rows.len() + 1)?,
        parts: vec![0],
        rings: vec![0],
        measures: Measures {
            areas: with_room(rows.len())?,
            centroids: with_room(rows.len())?,
            perimeters: with_room(rows.len())?,
        },
        ..Pieces::default()
    };
    out.cells.push(0);
    for part in found {
        for (left, parts) in part? {
            out.add(left, parts)?;
        }
    }
    Ok(out)
}

impl Pieces {
    fn add(&mut self, left: Left, parts: Vec<Vec<Ring>>) -> Result<()> {
        let (area, centroid, perimeter) = together(&parts);
        self.measures.areas.push(area);
        self.measures.centroids.push(centroid);
        self.measures.perimeters.push(perimeter);
        for part in parts {
            for ring in part {
                for (point, ridge) in ring {
                    push(&mut self.points, point)?;
                    push(&mut self.ridges, ridge)?;
                }
                push(&mut self.rings, self.points.len() as i64)?;
            }
            push(&mut self.parts, self.rings.len() as i64 - 1)?;
        }
        self.left.push(left as i8);
        self.cells.push(self.parts.len() as i64 - 1);
        Ok(())
    }
}

/// Area, centroid and perimeter of all parts together.
fn together(parts: &[Vec<Ring>]) -> (f64, Point2, f64) {
    let Some(&(origin, _)) = parts.iter().flatten().flatten().next() else {
        return (0.0, [f64::NAN; 2], 0.0);
    };
    let (mut twice, mut moment, mut around) = (0.0, [0.0; 2], 0.0);
    for ring in parts.iter().flatten() {
        let (area, [x, y], length) = ring_measures(ring.iter().map(|p| p.0), origin);
        twice += area;
        moment = [moment[0] + x, moment[1] + y];
        around += length;
    }
    // As thin as rounding allows.
    if twice <= 0.0 || twice.is_nan() {
        return (0.0, origin, around);
    }
    let centroid = [0, 1].map(|k| origin[k] + moment[k] / twice / 3.0);
    (twice / 2.0, centroid, around)
}

/// Where a segment of the outline crosses an edge of a cell.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// The segment: the index of the corner where it begins.
    segment: usize,
    ring: usize,
    /// Whether the segment enters the cell here.
    enters: bool,
    edge: usize,
    at: Point2,
}

/// Buffers reused from cell to cell.
#[derive(Default)]
struct Work {
    near: Vec<u32>,
    /// For each segment, one more than the last cell for which it was tested.
    met: Vec<u32>,
    begin: Vec<Sign>,
    end: Vec<Sign>,
    crossings: Vec<Crossing>,
    around: Vec<usize>,
}

struct Cutter<'a> {
    cells: Convex<'a>,
    outline: Outline<'a>,
    /// For each corner of the outline its ring, and the next corner.
    ring: Vec<u32>,
    next: Vec<u32>,
    grid: Grid,
    first: Vec<u32>,
    members: Vec<u32>,
}

impl<'a> Cutter<'a> {
    fn of(cells: Convex<'a>, outline: Outline<'a>) -> Result<Self> {
        let count = outline.points.len();
        let (mut ring, mut next) = (with_room(count)?, with_room(count)?);
        for r in 0..outline.starts.len().saturating_sub(1) {
            let range = outline.ring(r);
            for i in range.clone() {
                ring.push(r as u32);
                next.push(if i + 1 == range.end {
                    range.start
                } else {
                    i + 1
                } as u32);
            }
        }
        let mut segments = with_room(count)?;
        segments.extend(outline.points.iter().zip(&next).map(|(a, &b)| {
            let b = outline.points[b as usize];
            [a[0], a[1], b[0], b[1]]
        }));
        let all = cells.corners.iter().chain(outline.points).copied();
        let grid = Grid::over(Extent::of(all), cells.starts.len().max(count));
        let (first, members) = sorted(&grid, &segments)?;
        Ok(Self {
            cells,
            outline,
            ring,
            next,
            grid,
            first,
            members,
        })
    }

    fn cell(&self, row: usize, inside: bool, work: &mut Work) -> (Left, Vec<Ring>) {
        let doubtful = (Left::Doubtful, Vec::new());
        let range = self.cells.starts[row] as usize..self.cells.starts[row + 1] as usize;
        let cell = Cell {
            corners: &self.cells.corners[range.clone()],
            ridges: &self.cells.ridges[range],
        };
        if !cell.is_convex() {
            return doubtful;
        }
        self.candidates(row, &cell, work);
        let known = work.near.len() * cell.corners.len() <= MOST
            && self.crossings(&cell, work).is_some()
            && alternate(&work.crossings)
            && around(&cell, inside, work);
        if !known {
            return doubtful;
        }
        let Some(mut rings) = self.whole_rings(&cell, work) else {
            return doubtful;
        };
        if work.crossings.is_empty() {
            match (inside, rings.is_empty()) {
                (true, true) => return (Left::Whole, rings),
                (false, true) => return (Left::Nothing, rings),
                (true, false) => rings.push(cell.ring()),
                (false, false) => {}
            }
        }
        self.trace(&cell, work, &mut rings);
        let left = if rings.is_empty() {
            Left::Nothing
        } else {
            Left::Parts
        };
        (left, rings)
    }

    /// The segments whose boxes meet that of the cell, ascending.
    fn candidates(&self, row: usize, cell: &Cell, work: &mut Work) {
        let (near, met) = (&mut work.near, &mut work.met);
        near.clear();
        met.resize(self.ring.len(), 0);
        let stamp = row as u32 + 1;
        let extent = Extent::of(cell.corners.iter().copied());
        for line in self.grid.range(1, extent.min[1], extent.max[1]) {
            for column in self.grid.range(0, extent.min[0], extent.max[0]) {
                let field = self.grid.field(line, column);
                let range = self.first[field] as usize..self.first[field + 1] as usize;
                for &s in &self.members[range] {
                    let seen = std::mem::replace(&mut met[s as usize], stamp) == stamp;
                    let [a, b] = self.ends(s as usize);
                    let meets = |k: usize| {
                        a[k].max(b[k]) >= extent.min[k] && a[k].min(b[k]) <= extent.max[k]
                    };
                    if !seen && meets(0) && meets(1) {
                        near.push(s);
                    }
                }
            }
        }
        near.sort_unstable();
    }

    fn ends(&self, segment: usize) -> [Point2; 2] {
        let points = self.outline.points;
        [points[segment], points[self.next[segment] as usize]]
    }

    /// All crossings in the order of the outline; `None` if one is doubtful.
    fn crossings(&self, cell: &Cell, work: &mut Work) -> Option<()> {
        work.crossings.clear();
        let mut last = usize::MAX;
        for &segment in &work.near {
            let segment = segment as usize;
            let [a, b] = self.ends(segment);
            if last == segment {
                std::mem::swap(&mut work.begin, &mut work.end);
            } else {
                cell.sides(a, &mut work.begin);
            }
            cell.sides(b, &mut work.end);
            last = self.next[segment] as usize;
            let from = work.crossings.len();
            for (edge, (&p, &q)) in work.begin.iter().zip(&work.end).enumerate() {
                if p == q && !p.is_zero() {
                    continue;
                }
                let [c, d] = cell.edge(edge);
                let (u, v) = (orient2d(a, b, c), orient2d(a, b, d));
                if u == v && !u.is_zero() {
                    continue;
                }
                if [p, q, u, v].contains(&Sign::Zero) {
                    return None;
                }
                work.crossings.push(Crossing {
                    segment,
                    ring: self.ring[segment] as usize,
                    enters: q == Sign::Positive,
                    edge,
                    at: intersection(a, b, c, d),
                });
            }
            // A segment enters a convex cell before it leaves it.
            match work.crossings.len() - from {
                0 | 1 => {}
                2 => work.crossings[from..].sort_by_key(|c| !c.enters),
                _ => return None,
            }
        }
        Some(())
    }

    /// The rings of the outline that are entirely in the cell; `None` if that is doubtful.
    fn whole_rings(&self, cell: &Cell, work: &mut Work) -> Option<Vec<Ring>> {
        let mut found: Vec<Ring> = Vec::new();
        let mut last = usize::MAX;
        for &segment in &work.near {
            let ring = self.ring[segment as usize] as usize;
            if ring == last || work.crossings.iter().any(|c| c.ring == ring) {
                last = ring;
                continue;
            }
            last = ring;
            let points = &self.outline.points[self.outline.ring(ring)];
            cell.sides(points[0], &mut work.begin);
            if work.begin.contains(&Sign::Negative) {
                continue;
            }
            if work.begin.contains(&Sign::Zero) || found.len() == MOST_RINGS {
                return None;
            }
            found.push(points.iter().map(|&p| (p, -1)).collect());
        }
        Some(found)
    }

    /// Adds the pieces between crossings, counterclockwise.
    fn trace(&self, cell: &Cell, work: &Work, rings: &mut Vec<Ring>) {
        let crossings = &work.crossings;
        let mut place = vec![0; crossings.len()];
        for (i, &crossing) in work.around.iter().enumerate() {
            place[crossing] = i;
        }
        let mut met = vec![false; crossings.len()];
        for start in 0..crossings.len() {
            if !crossings[start].enters || met[start] {
                continue;
            }
            let mut ring = Ring::new();
            let mut now = start;
            // Each step visits a new entry; entries and exits alternate, so it returns to the
            // first.
            while !met[now] {
                met[now] = true;
                let leave = after(crossings, now);
                self.follow(&crossings[now], &crossings[leave], now < leave, &mut ring);
                let enter = work.around[(place[leave] + 1) % place.len()];
                let ahead = place[leave] + 1 < place.len();
                cell.follow(&crossings[leave], &crossings[enter], ahead, &mut ring);
                now = enter;
            }
            ring.dedup_by(|b, a| {
                let same = a.0 == b.0;
                // Drop an edge of zero length: the corner keeps the next edge.
                if same {
                    a.1 = b.1;
                }
                same
            });
            if ring.len() > 1 && ring[0].0 == ring[ring.len() - 1].0 {
                ring.pop();
            }
            if ring.len() > 2 {
                rings.push(ring);
            }
        }
    }

    /// Adds the outline from where it enters to where it leaves; `ahead` tells whether the exit is
    /// later in its ring.
    fn follow(&self, enter: &Crossing, leave: &Crossing, ahead: bool, ring: &mut Ring) {
        ring.push((enter.at, -1));
        if enter.segment == leave.segment && ahead {
            return;
        }
        let mut at = self.next[enter.segment] as usize;
        ring.push((self.outline.points[at], -1));
        while at != leave.segment {
            at = self.next[at] as usize;
            ring.push((self.outline.points[at], -1));
        }
    }
}

/// The crossing after one in its ring.
fn after(crossings: &[Crossing], i: usize) -> usize {
    match crossings.get(i + 1) {
        Some(next) if next.ring == crossings[i].ring => i + 1,
        _ => crossings.partition_point(|c| c.ring < crossings[i].ring),
    }
}

/// Whether each ring alternately enters and leaves.
fn alternate(crossings: &[Crossing]) -> bool {
    (0..crossings.len()).all(|i| crossings[i].enters != crossings[after(crossings, i)].enters)
}

/// Sorts crossings around the cell; returns whether their kinds alternate, consistently with the
/// first corner.
fn around(cell: &Cell, inside: bool, work: &mut Work) -> bool {
    let crossings = &work.crossings;
    work.around.clear();
    work.around.extend(0..crossings.len());
    let order = |&i: &usize, &j: &usize| {
        let (p, q) = (&crossings[i], &crossings[j]);
        p.edge
            .cmp(&q.edge)
            .then_with(|| cell.along(p.edge, p.at, q.at))
    };
    work.around.sort_by(order);
    let apart = work.around.windows(2).all(|w| order(&w[0], &w[1]).is_lt());
    // The inside of the outline is on its left: between leaving the cell and entering it again.
    let alternates = |(k, &i): (usize, &usize)| crossings[i].enters == (inside ^ (k % 2 == 1));
    apart && work.around.iter().enumerate().all(alternates)
}

struct Cell<'a> {
    corners: &'a [Point2],
    ridges: &'a [i32],
}

impl Cell<'_> {
    fn edge(&self, i: usize) -> [Point2; 2] {
        [self.corners[i], self.corners[(i + 1) % self.corners.len()]]
    }

    fn is_convex(&self) -> bool {
        let turn = |i: usize| {
            let [a, b] = self.edge(i);
            orient2d(a, b, self.corners[(i + 2) % self.corners.len()])
        };
        let turns = || (0..self.corners.len()).map(turn);
        turns().all(|s| s != Sign::Negative) && turns().any(|s| s == Sign::Positive)
    }

    /// On which side of each edge a point is; positive is inside.
    fn sides(&self, p: Point2, out: &mut Vec<Sign>) {
        out.clear();
        out.extend((0..self.corners.len()).map(|i| {
            let [a, b] = self.edge(i);
            orient2d(a, b, p)
        }));
    }

    /// The order of two points along an edge.
    fn along(&self, edge: usize, p: Point2, q: Point2) -> Ordering {
        let [a, b] = self.edge(edge);
        let by = |k: usize| {
            let order = p[k].total_cmp(&q[k]);
            if a[k] <= b[k] { order } else { order.reverse() }
        };
        by(0).then(by(1))
    }

    fn ring(&self) -> Ring {
        let ridges = self.ridges.iter().copied();
        self.corners.iter().copied().zip(ridges).collect()
    }

    /// Adds the boundary from where the outline leaves to where it enters; `ahead` tells whether
    /// the entry is later.
    fn follow(&self, leave: &Crossing, enter: &Crossing, ahead: bool, ring: &mut Ring) {
        ring.push((leave.at, self.ridges[leave.edge]));
        if leave.edge == enter.edge && ahead {
            return;
        }
        let mut edge = leave.edge;
        loop {
            edge = (edge + 1) % self.corners.len();
            ring.push((self.corners[edge], self.ridges[edge]));
            if edge == enter.edge {
                return;
            }
        }
    }
}

/// Outer rings, each with the holes for which it is the innermost one; `None` if a hole is in no
/// ring.
fn nested(rings: Vec<Ring>) -> Option<Vec<Vec<Ring>>> {
    let (outer, holes): (Vec<Ring>, Vec<Ring>) = rings.into_iter().partition(|r| area(r) > 0.0);
    let mut parts: Vec<Vec<Ring>> = outer.into_iter().map(|ring| vec![ring]).collect();
    for hole in holes {
        let around = |part: &&mut Vec<Ring>| {
            let told = hole.iter().find_map(|p| holds(&part[0], p.0));
            told.unwrap_or(false)
        };
        let least = |p: &&mut Vec<Ring>, q: &&mut Vec<Ring>| area(&p[0]).total_cmp(&area(&q[0]));
        let part = parts.iter_mut().filter(around).min_by(least)?;
        part.push(hole);
    }
    Some(parts)
}

/// Twice the signed area.
fn area(ring: &Ring) -> f64 {
    ring_measures(ring.iter().map(|p| p.0), ring[0].0).0
}

/// Whether a point is inside a ring; `None` if it is on the ring.
fn holds(ring: &Ring, p: Point2) -> Option<bool> {
    let mut inside = false;
    for (i, &(b, _)) in ring.iter().enumerate() {
        let a = ring[(i + ring.len() - 1) % ring.len()].0;
        let (low, high) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        if p[1] < low[1] || p[1] > high[1] {
            continue;
        }
        let side = orient2d(low, high, p);
        let level = low[1] == high[1];
        let between = |k: usize| (a[k].min(b[k])..=a[k].max(b[k])).contains(&p[k]);
        if side == Sign::Zero && between(0) {
            return None;
        }
        inside ^= !level && p[1] < high[1] && side == Sign::Positive;
    }
    Some(inside)
}
