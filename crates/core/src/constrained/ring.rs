//! The triangles inside one simple ring by ear clipping and flips, without a triangulation of its
//! hull.
//!
//! G. H. Meisters, "Polygons have ears", The American Mathematical Monthly 82 (1975); the flips are
//! those of `delaunay::plane::lawson`, with the sides as constrained edges.
//!
//! # Why the ring is simple if this succeeds
//!
//! Ears are clipped in two passes, first at corners that turn right, which fills the pockets
//! outside, then at corners that turn left, which fills the inside:
//!
//! ```text
//!    a       c           a-------c        b goes, and the triangle of a, b, c stays.
//!     \     /     ->      \ ... /
//!      \   /               \ . /
//!        b                   b
//! ```
//!
//! The triangles of both passes are glued along the sides of the ring to a disk, since each is
//! glued to it along one edge or along two adjacent ones. Exact predicates ensure that every one of
//! them is counterclockwise, and the boundary of the disk maps to a convex polygon that is
//! traversed once: no corner turns right, and the direction changes between ascending and
//! descending, in lexicographic order, exactly twice. The number of triangles over a point is the
//! number of times the boundary winds around it, since all count with the same sign: once inside
//! the convex polygon. So the triangles tile it, different vertices are different points, the sides
//! are edges of a triangulation, and they meet only in their common ends. Whether a corner is fit
//! to be clipped therefore need not be decided exactly: a wrong choice only ends without an answer.
//!
//! # Why it succeeds if the ring is simple
//!
//! Inside, and in each pocket, there is a corner whose triangle contains no other vertex (each
//! polygon of four or more vertices has two that are not adjacent, so one is not at the hull edge
//! that closes the pocket), and only such corners are clipped, which leaves a simple ring.
//!
//! Each corner is tested against all those that turn the other way, eight at once by their cells in
//! a grid. This is quadratic, but for rings of up to [`MOST`] vertices a fraction of the rest.

use delone_predicates::{Point2, Sign, incircle_canonical, lexicographic, orient2d};

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::mesh::plane::{Code, Mesh2, Patch, half_edge, next, prev};

/// The most vertices of a ring: above, the search among all corners costs more than it saves.
const MOST: usize = 400;

/// Cells of the grid along the longer side, minus one: they are numbered from 0.
const CELLS: f64 = 254.0;
/// The cell of no vertex.
const NOWHERE: u8 = u8::MAX;
/// Cells that are compared at once, in two words of a byte each.
const LANES: usize = 16;
const WORD: usize = LANES / 2;

/// The triangles inside a ring, as its rows; `None` if the ring is not simple, or too long.
pub fn simple_ring(points: &[Point2]) -> Result<Option<Vec<[i32; 3]>>> {
    let closed = points.len() > 1 && points.first() == points.last();
    let points = &points[..points.len() - usize::from(closed)];
    if !(3..=MOST).contains(&points.len()) {
        return Ok(None);
    }
    let Some(ring) = Ring::of(points)? else {
        return Ok(None);
    };
    let mut outside = Cutter::new(&ring, Sign::Negative)?;
    if !outside.cut_all(|_| {}) || !outside.is_convex() {
        return Ok(None);
    }
    let mut inside = Cutter::new(&ring, Sign::Positive)?;
    let mut fill = Fill::new(points)?;
    if !inside.cut_all(|c| fill.add(c)) || inside.left > 3 || !inside.others.is_empty() {
        return Ok(None);
    }
    let first = inside.start;
    let Corner { before, after, .. } = inside.corners[first as usize];
    fill.close([before, first, after]);
    fill.flip();
    Ok(Some(fill.simplices(points.len() - 2)?))
}

/// A corner of a ring.
#[derive(Debug, Clone, Copy)]
struct Corner {
    at: Point2,
    /// The vertices before and after it, counterclockwise.
    before: u32,
    after: u32,
    /// Its index among the corners that stay, or [`CLIPPABLE`].
    place: u32,
    /// Its cell in a grid over the box, which keeps the order of coordinates.
    cell: [u8; 2],
}

/// The place of a corner that may be clipped.
const CLIPPABLE: u32 = u32::MAX;

/// A ring, counterclockwise.
struct Ring {
    corners: Vec<Corner>,
    turns: Vec<Sign>,
}

impl Ring {
    /// `None` if the box is not finite or has no size, or the ring has no interior at its first
    /// vertex in lexicographic order.
    fn of(points: &[Point2]) -> Result<Option<Self>> {
        let n = points.len();
        let (mut min, mut max) = (points[0], points[0]);
        // NaN as soon as a coordinate is NaN or infinite.
        let mut poison = 0.0;
        for p in points {
            for k in 0..2 {
                poison += 0.0 * p[k];
                min[k] = if p[k] < min[k] { p[k] } else { min[k] };
                max[k] = if p[k] > max[k] { p[k] } else { max[k] };
            }
        }
        let scale = CELLS / (max[0] - min[0]).max(max[1] - min[1]);
        if !(poison == 0.0 && scale.is_normal()) {
            return Ok(None);
        }
        let mut turns = with_room(n)?;
        let mut corners: Vec<Corner> = with_room(n)?;
        let mut first = (0, points[0]);
        let (mut before, mut p) = (n - 1, points[n - 1]);
        for (v, &at) in points.iter().enumerate() {
            let after = if v + 1 == n { 0 } else { v + 1 };
            turns.push(orient2d(p, at, points[after]));
            corners.push(Corner {
                at,
                before: before as u32,
                after: after as u32,
                place: CLIPPABLE,
                cell: [0, 1].map(|k| ((at[k] - min[k]) * scale) as u8),
            });
            if at[0] < first.1[0] || at[0] == first.1[0] && at[1] < first.1[1] {
                first = (v, at);
            }
            (before, p) = (v, at);
        }
        match turns[first.0] {
            Sign::Zero => return Ok(None),
            Sign::Positive => {}
            Sign::Negative => {
                for (corner, turn) in corners.iter_mut().zip(&mut turns) {
                    (corner.before, corner.after) = (corner.after, corner.before);
                    *turn = -*turn;
                }
            }
        }
        Ok(Some(Self { corners, turns }))
    }
}

/// Clips the corners of one orientation off a ring.
struct Cutter {
    corners: Vec<Corner>,
    turn: Sign,
    /// A vertex of the remaining ring, and how many there are.
    start: u32,
    left: usize,
    /// The corners with the other orientation.
    others: Vec<u32>,
    /// The cells of the others, then [`NOWHERE`].
    columns: Vec<[u8; LANES]>,
    rows: Vec<[u8; LANES]>,
}

impl Cutter {
    fn new(ring: &Ring, turn: Sign) -> Result<Self> {
        let n = ring.corners.len();
        let mut corners = with_room(n)?;
        let mut others = with_room(n)?;
        let blank = [NOWHERE; LANES];
        let mut columns = filled(n.div_ceil(LANES), blank)?;
        let mut rows = filled(n.div_ceil(LANES), blank)?;
        for (corner, at) in ring.corners.iter().zip(&ring.turns) {
            let mut place = CLIPPABLE;
            if *at != turn {
                place = others.len() as u32;
                columns.as_flattened_mut()[others.len()] = corner.cell[0];
                rows.as_flattened_mut()[others.len()] = corner.cell[1];
                others.push(corners.len() as u32);
            }
            corners.push(Corner { place, ..*corner });
        }
        Ok(Self {
            corners,
            turn,
            start: 0,
            left: n,
            others,
            columns,
            rows,
        })
    }

    /// Clips corners until none has the orientation or three vertices are left; returns whether
    /// that was reached. In each round no two adjacent corners are clipped, so that triangles have
    /// similar sizes. It terminates: a round without a cut is the last.
    fn cut_all(&mut self, mut cut: impl FnMut([u32; 3])) -> bool {
        let mut idle = 0;
        let mut b = self.start;
        while self.left > 3 && self.others.len() < self.left {
            let corner = self.corners[b as usize];
            let (a, c) = (corner.before, corner.after);
            if corner.place != CLIPPABLE || self.is_blocked(corner) {
                idle += 1;
                if idle > self.left {
                    return false;
                }
                b = c;
                continue;
            }
            idle = 0;
            cut([a, b, c]);
            self.left -= 1;
            self.start = c;
            self.corners[a as usize].after = c;
            self.corners[c as usize].before = a;
            b = self.corners[c as usize].after;
            if !(self.update(a) && self.update(c)) {
                return false;
            }
        }
        true
    }

    /// Tests again whether `v` has the orientation. If the ring is simple, a corner that has it
    /// keeps it.
    #[inline]
    fn update(&mut self, v: u32) -> bool {
        let Corner {
            at,
            before,
            after,
            place,
            ..
        } = self.corners[v as usize];
        let a = self.corners[before as usize].at;
        let c = self.corners[after as usize].at;
        let turns = orient2d(a, at, c) == self.turn;
        if turns && place != CLIPPABLE {
            self.remove_other(v, place as usize);
        }
        turns || place != CLIPPABLE
    }

    /// Removes a corner from the others: the last of them takes its place.
    fn remove_other(&mut self, v: u32, place: usize) {
        let last = self.others.len() - 1;
        let moved = self.others[last];
        self.others[place] = moved;
        self.others.truncate(last);
        self.corners[moved as usize].place = place as u32;
        self.corners[v as usize].place = CLIPPABLE;
        for cells in [&mut self.columns, &mut self.rows] {
            let cells = cells.as_flattened_mut();
            cells[place] = cells[last];
            cells[last] = NOWHERE;
        }
    }

    /// Whether a vertex of the other orientation lies in the closed triangle at a corner, except
    /// its own vertices.
    #[inline]
    fn is_blocked(&self, corner: Corner) -> bool {
        let a = self.corners[corner.before as usize];
        let c = self.corners[corner.after as usize];
        let low = [0, 1].map(|k| corner.cell[k].min(a.cell[k]).min(c.cell[k]));
        let high = [0, 1].map(|k| corner.cell[k].max(a.cell[k]).max(c.cell[k]));
        let size = [high[0] - low[0], high[1] - low[1]];
        let used = self.others.len().div_ceil(LANES);
        let lanes = self.columns[..used].iter().zip(&self.rows[..used]);
        for (i, (x, y)) in lanes.enumerate() {
            // 0 in the lanes of vertices in the box.
            let mut beyond = [0; LANES];
            for j in 0..LANES {
                let dx = x[j].wrapping_sub(low[0]).saturating_sub(size[0]);
                let dy = y[j].wrapping_sub(low[1]).saturating_sub(size[1]);
                beyond[j] = dx | dy;
            }
            let words = beyond.as_chunks::<WORD>().0;
            for (i, &word) in (2 * i..).zip(words) {
                let word = u64::from_le_bytes(word);
                if has_zero(word) == 0 {
                    continue;
                }
                let mut word = word | lane(a.place, i) | lane(c.place, i);
                while has_zero(word) != 0 {
                    let j = has_zero(word).trailing_zeros() as usize / 8;
                    let p = self.corners[self.others[WORD * i + j] as usize].at;
                    if self.holds([a.at, corner.at, c.at], p) {
                        return true;
                    }
                    word |= 1 << (8 * j);
                }
            }
        }
        false
    }

    #[inline]
    fn holds(&self, [a, b, c]: [Point2; 3], p: Point2) -> bool {
        [(a, b), (b, c), (c, a)].iter().all(|&(a, b)| {
            let side = orient2d(a, b, p);
            side == self.turn || side.is_zero()
        })
    }

    /// Whether the remaining ring, none of whose corners turns right, is traversed once.
    fn is_convex(&self) -> bool {
        let ascends = |v: u32| {
            let Corner { at, after, .. } = self.corners[v as usize];
            (after, lexicographic(at, self.corners[after as usize].at))
        };
        let (mut v, mut before) = ascends(self.start);
        let mut changes = 0;
        for _ in 0..self.left {
            let (after, now) = ascends(v);
            changes += usize::from(now != before);
            (v, before) = (after, now);
        }
        self.others.len() == self.left && changes == 2
    }
}

/// Nonzero in the lane of a place, if it lies in word `i`.
#[inline]
fn lane(place: u32, i: usize) -> u64 {
    let (word, j) = (place as usize / WORD, place as usize % WORD);
    u64::from(word == i) << (8 * j)
}

/// Nonzero if a byte is 0; the lowest bit that is set is in the first such byte.
#[inline]
fn has_zero(word: u64) -> u64 {
    let ones = u64::MAX / 0xff;
    word.wrapping_sub(ones) & !word & (ones << 7)
}

/// Triangles inside a ring.
struct Fill<'a> {
    points: &'a [Point2],
    mesh: Mesh2,
    count: u32,
    /// For each vertex of the remaining ring, the code across the edge to the next vertex.
    across: Vec<Code>,
    stack: Vec<Code>,
    /// What lies across the sides: a code of a record that is not a triangle.
    outside: Code,
}

impl<'a> Fill<'a> {
    fn new(points: &'a [Point2]) -> Result<Self> {
        let outside = half_edge(points.len() as u32 - 2, 0);
        Ok(Self {
            points,
            mesh: Mesh2::with_vertices(points.len())?,
            count: 0,
            across: filled(points.len(), outside)?,
            stack: with_room(4 * points.len())?,
            outside,
        })
    }

    /// Adds the triangle that is clipped at `b`.
    fn add(&mut self, [a, b, c]: [u32; 3]) {
        let t = self.count;
        self.count += 1;
        self.mesh.resume(t).set(t, [a, b, c]);
        self.join(half_edge(t, 2), a);
        self.join(half_edge(t, 0), b);
        self.across[a as usize] = half_edge(t, 1);
    }

    /// Adds the last triangle.
    fn close(&mut self, [a, b, c]: [u32; 3]) {
        self.add([a, b, c]);
        self.join(half_edge(self.count - 1, 1), c);
    }

    /// Links the edge `e`, which starts at `v`, to the code across it.
    fn join(&mut self, e: Code, v: u32) {
        let o = self.across[v as usize];
        self.mesh.resume(self.count).link(e, o);
        if o != self.outside {
            self.stack.push(e);
        }
    }

    /// Flips edges until all are legal; see `delaunay::plane::lawson` for why that terminates.
    fn flip(&mut self) {
        let mut mesh = self.mesh.resume(self.count);
        while let Some(e) = self.stack.pop() {
            // A flip elsewhere may have assigned this code to a side.
            let o = mesh.opposite(e);
            if o != self.outside && must_flip(self.points, &mesh, e, o) {
                let other = mesh.flip(e);
                self.stack.extend([e, prev(e), other, next(other)]);
            }
        }
    }

    fn simplices(&mut self, count: usize) -> Result<Vec<[i32; 3]>> {
        let mesh = self.mesh.resume(self.count);
        let mut simplices = with_room(count)?;
        simplices.extend((0..self.count).map(|t| mesh.corners(t).map(|v| v as i32)));
        Ok(simplices)
    }
}

#[inline]
fn must_flip(points: &[Point2], mesh: &Patch, e: Code, o: Code) -> bool {
    let [u, v, p, q] = [next(e), prev(e), e, o].map(|c| points[mesh.vertex(c) as usize]);
    incircle_canonical(u, v, p, q) == Sign::Positive
}
