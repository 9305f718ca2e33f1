//! Needles: narrow parts of the domain where good angles need more vertices than the budget allows.
//!
//! They lie between two lines that are very close over a long distance. They are found before the
//! first vertex is inserted, fenced off, and opened again at the end if the budget allows it.
//!
//! # The price
//!
//! Between two lines at distance `g`, edges are about as long as `g`: the number of vertices is
//! proportional to the angle, and to the length over which the lines face each other, divided by
//! `g`. A single vertex near a line is cheap, because edges grow with the distance from it; so is a
//! corner whose sides are split at equal distances. Therefore a triangle is examined only if it is
//! bad and would be refined: its small angle does not lie between two sides of a corner, or its
//! apex is in the lens of one of its subsegments. The lines at its apex, and those opposite the
//! apex in the triangles around it, are clipped to the part that faces the line under the
//! subsegment at a distance of at most twice the gap of the apex. Whole lines are measured, not
//! their pieces, so that a mesh that has already been refined around a needle has the same needles.
//!
//! # The fence
//!
//! Triangles that are expensive by this measure and are connected across edges that are not on a
//! segment form a needle. Its price is the sum over its pairs of lines. Its edges that are not on a
//! segment become temporary lines: like those of the input, they may be split from outside, on
//! circles around their ends if these are sharp corners. A fence can itself be one side of a gap,
//! so the triangle beyond it is examined in the same way. Once a triangle is in a needle, it stays
//! there, whatever the order of work, so the result does not depend on the order of the input.
//!
//! Inside a needle, only sizes count, not angles or encroachment. A line at its side may be
//! split from the other side; the vertices on it are then joined across the needle.
//!
//! # Termination and budget
//!
//! With the fences, the domain without the needles has no two lines that are so close compared with
//! the length over which they face each other. It is refined first, by the usual rules, which treat
//! fences as lines of the input; so it terminates when those do.
//!
//! Then needles are opened in ascending order of price, as long as the sum stays within a share of
//! the budget, and work continues in them. Most corners with a very small angle cost nothing, since
//! their sides are split alike; but one whose sides are split at different distances, because of
//! something outside, may cost the full price. Therefore a needle that needed no work at first, and
//! whose price is not allowed, gets a number of steps of work in proportion to the triangles that
//! it has by then. If they suffice it counts as a corner.
//!
//! In further rounds (see `rounds`) the triangles of needles that were closed to the end belong to
//! needles again, which stay closed. By then their fences have vertices that are on no line, and
//! these may hide what faces a line beyond them.
//!
//! All others stay as they are: a finite triangulation of the vertices that were placed on their
//! sides from outside. So all needles together use about that share, as far as the prices are
//! right; if they are too low, the limit on vertices ends the work after everything else is done.

use std::collections::HashMap;

/// An edge of a needle that is not on a segment.
#[derive(Debug, Clone, Copy)]
pub struct Fence {
    /// Its line, numbered after those of the input.
    pub line: i32,
    /// The needle that it encloses.
    pub needle: u32,
}

/// The needles, by number; triangles in them have labels from `first` on.
#[derive(Debug, Default)]
pub struct Needles {
    /// The number of lines of the input; fences come after them.
    pub lines: usize,
    /// The label of the first needle.
    pub first: u32,
    /// The original label of the triangles in each needle.
    pub labels: Vec<u32>,
    /// Whether the budget allows it to be opened.
    pub allowed: Vec<bool>,
    /// Whether it needed no work at first.
    pub settled: Vec<bool>,
    /// The steps of work that each needle has left without being opened.
    pub steps: Vec<u32>,
    /// The fences of all needles, by their ends.
    pub fences: HashMap<[u32; 2], Fence>,
    /// For each triangle the needle in which it was left, or -1; empty if there are no needles.
    pub left: Vec<i32>,
    /// The triangles of needles that stayed closed until the end of the previous round.
    pub kept: Vec<u32>,
}

/// The key of an edge, regardless of its direction.
pub fn key([u, v]: [u32; 2]) -> [u32; 2] {
    [u.min(v), u.max(v)]
}

impl Needles {
    /// No needles yet, in a triangulation with this many lines.
    pub fn of(lines: usize) -> Self {
        Self {
            lines,
            first: u32::MAX,
            ..Self::default()
        }
    }

    /// Whether triangles with this label are in a needle in which angles do not count.
    #[inline]
    pub fn rest(&self, label: u32) -> bool {
        label >= self.first
            && self
                .steps
                .get((label - self.first) as usize)
                .is_none_or(|steps| *steps == 0)
    }

    /// Whether a line is a fence.
    #[inline]
    pub fn is_fence(&self, line: i32) -> bool {
        line >= 0 && line as usize >= self.lines
    }

    /// The line of the fence between two vertices.
    #[inline]
    pub fn fence(&self, ends: [u32; 2]) -> Option<i32> {
        if self.fences.is_empty() {
            return None;
        }
        self.fences.get(&key(ends)).map(|fence| fence.line)
    }

    /// Records that the edge `u v` was split at `w`.
    pub fn split_at(&mut self, [u, v]: [u32; 2], w: u32) {
        if let Some(fence) = self.fences.remove(&key([u, v])) {
            self.fences.insert(key([u, w]), fence);
            self.fences.insert(key([w, v]), fence);
        }
    }

    /// The needle in which triangle `t` was left, or -1.
    pub fn left(&self, t: u32) -> i32 {
        self.left.get(t as usize).copied().unwrap_or(-1)
    }
}
