//! Needles: parts of the domain between two lines that come so near to each other, over so long a
//! way, that good angles there take more vertices than the budget allows. They are found before the
//! first vertex is inserted, fenced off, and opened again at the end where the budget allows it.
//!
//! # The price
//!
//! Between two lines at distance `g` edges are about as long as `g`: that takes a number of vertices
//! in proportion to the length over which the lines face each other, divided by `g`, and to the
//! angle. A single vertex near a line is cheap, as edges grow again with the distance from it; and so
//! is a corner whose sides are cut at equal distances. Therefore a triangle is looked at if it is bad,
//! and would be worked upon: its small angle does not lie between two sides of a corner, or its apex
//! is in the lens of one of its subsegments. The lines at its apex, and those opposite the apex in
//! the triangles around it, are clipped to where they face the line under the subsegment at no more
//! than twice the gap of the apex. Whole lines are measured, not their pieces, so that a mesh that
//! has been refined already, around a needle, has the same needles.
//!
//! # The fence
//!
//! Triangles that are dear by this measure join across edges without a segment to a needle. Its
//! price is the sum over its pairs of lines. Its edges without a segment become lines for a while:
//! they may be split from outside as those of the input, with circles about their ends where they are
//! sharp corners. A fence can itself be one side of a gap, so the triangle beyond is looked at in the
//! same way. A triangle once in a needle stays in it, whatever the order, so the outcome is one, and
//! for any order of the input.
//!
//! Inside of a needle no angle and no encroachment counts, only sizes. A line at its side may be cut
//! from the other side; the vertices on it are then joined across the needle.
//!
//! # Termination and budget
//!
//! With the fences up, the domain without the needles has no two lines that are as near to each other
//! in comparison to the length over which they face each other. It is refined first, by the usual
//! rules, for which fences are lines of the input; so it ends where those end.
//!
//! Then the needles are opened whose prices, summed from the least on, stay within a share of the
//! budget, and the work goes on in them. Most corners of nearly no angle cost nothing, since their
//! sides are cut alike; but one cut at another place, because of something outside, may cost the full
//! price. Thus a needle that was in order at first, and is not allowed for its price, gets some steps
//! of work in proportion to the triangles that it has by then. If they suffice it counts as a corner.
//!
//! All others stay as they are, which is no more than a finite triangulation of what the outside put on
//! their sides. So all needles together take about that share, as far as prices are right, and where
//! they are too low the limit on vertices ends the work after the rest is done.

use std::collections::HashMap;

/// An edge of a needle without a segment.
#[derive(Debug, Clone, Copy)]
pub struct Fence {
    /// Its line, behind those of the input.
    pub line: i32,
    /// The needle that it encloses.
    pub needle: u32,
}

/// The needles, by number; triangles in them have labels from `first` on.
#[derive(Debug, Default)]
pub struct Needles {
    /// The number of lines of the input; fences come after them.
    pub lines: usize,
    /// The label of the first one.
    pub first: u32,
    /// The label of the triangles before.
    pub labels: Vec<u32>,
    /// Whether the budget allows to open it.
    pub allowed: Vec<bool>,
    /// Whether nothing was to be done in it at first.
    pub settled: Vec<bool>,
    /// The steps of work that are left for each, without being opened.
    pub steps: Vec<u32>,
    /// Its fences and those of the others, by their ends.
    pub fences: HashMap<[u32; 2], Fence>,
    /// For each triangle the needle that it is left in, or -1; empty where there is none.
    pub left: Vec<i32>,
}

/// An edge whichever way it runs.
pub fn key([u, v]: [u32; 2]) -> [u32; 2] {
    [u.min(v), u.max(v)]
}

impl Needles {
    /// None yet, in a triangulation with so many lines.
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

    /// The edge `u v` has been parted in `w`.
    pub fn part(&mut self, [u, v]: [u32; 2], w: u32) {
        if let Some(fence) = self.fences.remove(&key([u, v])) {
            self.fences.insert(key([u, w]), fence);
            self.fences.insert(key([w, v]), fence);
        }
    }

    /// The needle that triangle `t` is left in, or -1.
    pub fn left(&self, t: u32) -> i32 {
        self.left.get(t as usize).copied().unwrap_or(-1)
    }
}
