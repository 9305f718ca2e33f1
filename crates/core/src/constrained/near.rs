//! What is as close to a segment as its rounding error: the vertices whose pixels it meets (see
//! `split`).
//!
//! Which vertices these are must not depend on the mesh, or points far away would change the result.
//! So the search is not a walk along the segment: between it and such a vertex there may be others, and a
//! vertex beside a triangle that the segment crosses may hide one behind it. It is a flood: from one
//! end of the segment, through triangles that overlap its box, across each edge that comes as near to
//! its line as a pixel.
//!
//! # Why it reaches every such vertex
//!
//! - The segment itself is followed: an edge that it crosses has its ends on different sides, or one of
//!   them as near as a pixel.
//! - Let the segment meet the pixel of `w` at x, above, below or beside w. The straight line from x to
//!   w lies in the pixel, in the box of the segment, since both of its ends do, and in the hull. So each
//!   triangle that it passes overlaps the box.
//! - No point of that line is farther from the segment's line than w. An edge that it crosses has both
//!   ends on one side and farther away than that only if all of the edge is: then it does not cross.
//! - Where it runs through a vertex, this one is as near as a pixel, and the flood continues across all
//!   edges there.
//!
//! The cost is that of the triangles along the segment, and of the stars of the vertices on it.

use delone_predicates::{Point2, Sign, orient2d};

use super::intersection::intersection;
use super::marked::{Marked, turn};
use super::pairs::overlap;
use crate::base::error::Result;
use crate::base::memory::{make_room, push};
use crate::base::points::Extent;
use crate::mesh::plane::{half_edge, triangle};

/// A segment and the size of the pixels in its box.
pub(crate) struct Band {
    from: Point2,
    along: Point2,
    /// Its box.
    pub(crate) extent: Extent,
    pixel: f64,
}

impl Band {
    /// Of the segment from p to q.
    pub(crate) fn of(p: Point2, q: Point2) -> Self {
        let along = [q[0] - p[0], q[1] - p[1]];
        let largest = (p.iter().chain(&q)).fold(0.0, |m: f64, x| m.max(x.abs()));
        let unit = largest * f64::EPSILON + f64::MIN_POSITIVE;
        Self {
            from: p,
            along,
            extent: Extent::of([p, q]),
            pixel: 2.0 * (along[0].abs() + along[1].abs()) * unit,
        }
    }

    /// The side of the line on which x lies; zero at least if x is no farther from it than a
    /// pixel's width.
    #[inline]
    pub(crate) fn side(&self, x: Point2) -> Sign {
        let left = self.along[0] * (x[1] - self.from[1]);
        let right = self.along[1] * (x[0] - self.from[0]);
        let rounding = 4.0 * f64::EPSILON * (left.abs() + right.abs()) + f64::MIN_POSITIVE;
        let det = left - right;
        // False also after overflow, when the value is NaN.
        if det.abs() > self.pixel + rounding {
            Sign::of(det)
        } else {
            Sign::Zero
        }
    }
}

/// Whether the edge `r s` may pass through the pixel of `p`.
pub(crate) fn is_near(r: Point2, s: Point2, p: Point2) -> bool {
    let beside = (0..2).any(|k| {
        let unit = 2.0 * (p[k].abs() * f64::EPSILON + f64::MIN_POSITIVE);
        p[k] < r[k].min(s[k]) - unit || p[k] > r[k].max(s[k]) + unit
    });
    !beside && !far(r, s, p)
}

/// Whether a point lies in the box of two others.
fn in_box(x: Point2, p: Point2, q: Point2) -> bool {
    (0..2).all(|k| p[k].min(q[k]) <= x[k] && x[k] <= p[k].max(q[k]))
}

/// Whether the segment `r s` meets the pixel of `p`, the points that round to it: at the abscissa
/// of p it has an ordinate that rounds to that of p, or vice versa.
pub(crate) fn passes(r: Point2, s: Point2, p: Point2) -> bool {
    if !in_box(p, r, s) || p == r || p == s || far(r, s, p) {
        return false;
    }
    if orient2d(r, s, p).is_zero() {
        return true;
    }
    // From here on both sides of the box have a positive length.
    (0..2).any(|k| {
        let other = 1 - k;
        let (mut below, mut above) = (p, p);
        below[other] = r[other].min(s[other]);
        above[other] = r[other].max(s[other]);
        intersection(r, s, below, above)[other] == p[other]
    })
}

/// Whether p is farther from the line r s than its pixel can be wide; most points are.
fn far(r: Point2, s: Point2, p: Point2) -> bool {
    let (left, right) = ((s[0] - r[0]) * (p[1] - r[1]), (s[1] - r[1]) * (p[0] - r[0]));
    let unit = |x: f64| x.abs() * f64::EPSILON + f64::MIN_POSITIVE;
    let pixel = (s[0] - r[0]).abs() * unit(p[1]) + (s[1] - r[1]).abs() * unit(p[0]);
    let rounding = 4.0 * f64::EPSILON * (left.abs() + right.abs()) + f64::MIN_POSITIVE;
    (left - right).abs() > 2.0 * pixel + rounding
}

/// What a search has visited; reused for the next one.
#[derive(Debug, Default)]
pub struct Seen {
    /// For each triangle, the last search that visited it.
    triangles: Vec<u32>,
    /// The same for each vertex.
    vertices: Vec<u32>,
    now: u32,
    /// How many triangles the last search visited.
    pub visited: usize,
}

impl Seen {
    /// Starts a search among this many triangles and vertices.
    fn start(&mut self, triangles: u32, vertices: usize) -> Result<()> {
        let is_over = self.now == u32::MAX;
        for (last, count) in [
            (&mut self.triangles, triangles as usize),
            (&mut self.vertices, vertices),
        ] {
            let more = count.saturating_sub(last.len());
            make_room(last, more)?;
            last.resize(last.len() + more, 0);
            if is_over {
                last.fill(0);
            }
        }
        self.now = if is_over { 1 } else { self.now + 1 };
        self.visited = 0;
        Ok(())
    }

    /// Whether triangle `t` is visited for the first time.
    #[inline]
    fn is_new(&mut self, t: u32) -> bool {
        self.visited += 1;
        std::mem::replace(&mut self.triangles[t as usize], self.now) != self.now
    }

    /// Whether vertex `v` is visited for the first time.
    #[inline]
    fn is_new_vertex(&mut self, v: u32) -> bool {
        std::mem::replace(&mut self.vertices[v as usize], self.now) != self.now
    }
}

impl Marked {
    /// The vertices on the segment from `a` to `b`, except its ends and `known` ones, in no particular
    /// order: those exactly on it, and of those whose pixel it meets the ones that `is_wanted`. Whatever
    /// edges are marked, and whatever other vertices there are. Terminates: no triangle is left twice.
    pub fn stops(
        &mut self,
        [a, b]: [u32; 2],
        known: &[u32],
        is_wanted: impl Fn(u32) -> bool,
        seen: &mut Seen,
    ) -> Result<Vec<u32>> {
        let [p, q] = [a, b].map(|v| self.at(v));
        let used = self.triangles();
        let (points, start) = (&self.points, self.near[a as usize]);
        let mesh = self.mesh.resume(used);
        seen.start(used, points.len())?;
        for &v in known.iter().chain(&[a, b]) {
            seen.is_new_vertex(v);
        }
        let (mut stops, mut stack) = (Vec::new(), Vec::new());
        let mut corner = start;
        loop {
            push(&mut stack, triangle(corner))?;
            corner = turn(&mesh, corner);
            if corner == start {
                break;
            }
        }
        let band = Band::of(p, q);
        while let Some(t) = stack.pop() {
            let corners = mesh.corners(t);
            if !seen.is_new(t) || corners.contains(&mesh.infinite()) {
                continue;
            }
            let at = corners.map(|v| points[v as usize]);
            if !overlap(&band.extent, &Extent::of(at)) {
                continue;
            }
            let sides = at.map(|x| band.side(x));
            for (&v, &x) in (corners.iter().zip(&at).zip(&sides))
                .filter(|(_, side)| side.is_zero())
                .map(|(corner, _)| corner)
            {
                if seen.is_new_vertex(v)
                    && passes(p, q, x)
                    && (is_wanted(v) || orient2d(p, q, x).is_zero())
                {
                    push(&mut stops, v)?;
                }
            }
            for k in 0..3 {
                let [u, v] = [sides[(k + 1) % 3], sides[(k + 2) % 3]];
                if u == Sign::Zero || u != v {
                    push(&mut stack, triangle(mesh.opposite(half_edge(t, k as u32))))?;
                }
            }
        }
        Ok(stops)
    }
}
