//! The straight walk: the triangles that a segment meets, in order.
//!
//! Every decision is the exact side of a vertex relative to the line through the two given ends, so
//! each triangle on the line is visited once and the walk terminates on any tiling (the "straight
//! walk" of O. Devillers, S. Pion and M. Teillaud, "Walking in a triangulation", 2002, with the
//! degenerate cases). The walk is in one of two states: at a vertex that is exactly on the segment,
//! or in the interior of an edge that the segment crosses.

use delone_predicates::{Point2, Sign, lexicographic, orient2d};

use super::tiling::{next, prev};
use crate::base::arrays::{Side, Triangles};
use crate::base::error::{Error, Result};

/// How a trace ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// In a triangle whose closed area contains the target.
    Reached(usize),
    /// At a boundary edge beyond which, or at whose end, the segment continues outside.
    Left(Side),
}

#[derive(Debug, Clone, Copy)]
enum State {
    /// The vertex at this corner is on the segment.
    Vertex(Side),
    /// The segment enters the triangle through the open edge opposite this corner.
    Enter(Side),
    /// The segment begins in this triangle, not at a corner.
    Within(usize),
    Done(End),
}

/// A walk along the segment from `a` to `b`.
pub struct Trace<'a> {
    given: &'a Triangles<'a>,
    a: Point2,
    b: Point2,
    /// Which of the triangles beside an edge on the segment is visited: the left one or the right
    /// one.
    prefer_left: bool,
    state: State,
}

impl<'a> Trace<'a> {
    /// From the vertex at a corner to `b`.
    pub fn from_corner(given: &'a Triangles<'a>, start: Side, b: Point2) -> Self {
        Self {
            given,
            a: given.at(start),
            b,
            prefer_left: true,
            state: State::Vertex(start),
        }
    }

    /// From `a`, which is in the closed area of triangle `t` and on its edges `on`, to a different
    /// point `b`.
    pub fn from_inside(
        given: &'a Triangles<'a>,
        t: usize,
        on: [bool; 3],
        a: Point2,
        b: Point2,
    ) -> Self {
        let mut trace = Self {
            given,
            a,
            b,
            prefer_left: true,
            state: State::Within(t),
        };
        let corners = (0..3).filter(|&k| on[k]).collect::<Vec<_>>();
        let side = |corner| Side { simplex: t, corner };
        trace.state = match corners[..] {
            [] => State::Within(t),
            [k] => trace.leave_edge(side(k)),
            // The corner that is opposite neither edge.
            [k, l, ..] => State::Vertex(side(3 - k - l)),
        };
        trace
    }

    /// From outside boundary edge `side`, which the segment meets, to `b`.
    pub fn from_outside(given: &'a Triangles<'a>, side: Side, a: Point2, b: Point2) -> Self {
        let mut trace = Self {
            given,
            a,
            b,
            prefer_left: true,
            state: State::Enter(side),
        };
        for end in given.ends(side) {
            if trace.side(given.at(end)) == Sign::Zero {
                trace.state = State::Vertex(end);
            }
        }
        trace
    }

    /// The same walk, visiting the right one of two triangles beside an edge.
    pub fn right_handed(mut self) -> Self {
        self.prefer_left = false;
        self
    }

    /// Walks to the end; calls `meet` for each triangle.
    pub fn run(&mut self, mut meet: impl FnMut(usize)) -> Result<End> {
        // Each triangle is entered once; a vertex or an edge on the way adds two steps.
        let mut left = 4 * self.given.simplices.len() + 4;
        loop {
            self.state = match self.state {
                State::Done(end) => return Ok(end),
                State::Vertex(side) => self.leave_vertex(side, &mut meet)?,
                State::Enter(side) => self.cross(side, &mut meet),
                State::Within(t) => self.leave_inside(t, &mut meet),
            };
            left = left.checked_sub(1).ok_or_else(|| self.endless())?;
        }
    }

    fn endless(&self) -> Error {
        Error::Internal(format!(
            "the straight walk from {:?} to {:?} does not end",
            self.a, self.b
        ))
    }

    fn side(&self, p: Point2) -> Sign {
        orient2d(self.a, self.b, p)
    }

    /// Whether the closed area of a triangle contains `b`.
    fn holds_end(&self, t: usize) -> bool {
        let [p, q, r] = self.given.corners(t);
        [(p, q), (q, r), (r, p)]
            .into_iter()
            .all(|(u, v)| orient2d(u, v, self.b) != Sign::Negative)
    }

    /// Crosses the edge opposite a corner, or leaves the tiling.
    fn through(&self, side: Side) -> State {
        match self.given.beyond(side) {
            Some(across) => State::Enter(across),
            None => State::Done(End::Left(side)),
        }
    }

    /// The start, on the open edge opposite a corner.
    fn leave_edge(&self, side: Side) -> State {
        let [u, v] = self.given.ends(side);
        let [p, q] = [u, v].map(|end| self.given.at(end));
        match orient2d(p, q, self.b) {
            Sign::Positive => State::Within(side.simplex),
            Sign::Negative => self.through(side),
            Sign::Zero => {
                // Along the edge: as if from the end behind.
                let ahead = lexicographic(self.a, self.b) == lexicographic(p, q);
                State::Vertex(if ahead { u } else { v })
            }
        }
    }

    /// Inside `t`: from a point that is not a corner and from which the segment goes into the
    /// interior.
    fn leave_inside(&self, t: usize, meet: &mut impl FnMut(usize)) -> State {
        meet(t);
        if self.holds_end(t) {
            return State::Done(End::Reached(t));
        }
        let signs = self.given.corners(t).map(|p| self.side(p));
        for corner in 0..3 {
            let side = Side { simplex: t, corner };
            // Counterclockwise from inside, corners right of the line precede those left of it.
            match (signs[corner], signs[next(corner)], signs[prev(corner)]) {
                (Sign::Zero, Sign::Positive, Sign::Negative) => return State::Vertex(side),
                (_, Sign::Negative, Sign::Positive) => return self.through(side),
                _ => {}
            }
        }
        // Only in degenerate triangles.
        State::Done(End::Left(Side {
            simplex: t,
            corner: 0,
        }))
    }

    /// Enters the triangle through the open edge opposite the corner, and continues.
    fn cross(&self, side: Side, meet: &mut impl FnMut(usize)) -> State {
        meet(side.simplex);
        if self.holds_end(side.simplex) {
            return State::Done(End::Reached(side.simplex));
        }
        // Seen along the segment, the `next` corner of the edge is on the left.
        match self.side(self.given.at(side)) {
            Sign::Zero => State::Vertex(side),
            Sign::Positive => self.through(Side {
                corner: next(side.corner),
                ..side
            }),
            Sign::Negative => self.through(Side {
                corner: prev(side.corner),
                ..side
            }),
        }
    }

    /// From a vertex on the segment into the triangle, or along the edge, toward `b`.
    fn leave_vertex(&self, at: Side, meet: &mut impl FnMut(usize)) -> Result<State> {
        let p = self.given.at(at);
        let mut found = None;
        let mut rim = at;
        self.given.around(at, |side| {
            let [u, v] = self.given.ends(side).map(|end| self.given.at(end));
            let (right, left) = (orient2d(p, u, self.b), orient2d(p, v, self.b));
            if right == Sign::Negative || left == Sign::Positive {
                // At the boundary: the edge with b outside, which is left or right of p.
                if right == Sign::Negative && self.given.turn_right(side).is_none() {
                    rim = Side {
                        corner: prev(side.corner),
                        ..side
                    };
                }
                if left == Sign::Positive && self.given.turn_left(side).is_none() {
                    rim = Side {
                        corner: next(side.corner),
                        ..side
                    };
                }
                return true;
            }
            found = Some((side, right, left, u, v));
            false
        });
        let Some((side, right, left, u, v)) = found else {
            return Ok(State::Done(End::Left(rim)));
        };
        if right == Sign::Zero && left == Sign::Zero {
            // The target is this vertex.
            meet(side.simplex);
            return Ok(State::Done(End::Reached(side.simplex)));
        }
        if right == Sign::Zero {
            let end = Side {
                corner: next(side.corner),
                ..side
            };
            return Ok(self.along_edge(side, p, u, end, meet));
        }
        if left == Sign::Zero {
            // The same edge from its other side, unless that is outside.
            let (beside, end) = match self.given.turn_left(side) {
                Some(across) => (
                    across,
                    Side {
                        corner: next(across.corner),
                        ..across
                    },
                ),
                None => (
                    side,
                    Side {
                        corner: prev(side.corner),
                        ..side
                    },
                ),
            };
            return Ok(self.along_edge(beside, p, v, end, meet));
        }
        meet(side.simplex);
        if self.holds_end(side.simplex) {
            return Ok(State::Done(End::Reached(side.simplex)));
        }
        Ok(self.through(side))
    }

    /// Along the edge from `p`, at corner `side`, to `u`, at corner `end` of the same triangle.
    fn along_edge(
        &self,
        side: Side,
        p: Point2,
        u: Point2,
        end: Side,
        meet: &mut impl FnMut(usize),
    ) -> State {
        let is_left = end.corner == next(side.corner);
        let other = if is_left {
            self.given.turn_right(side)
        } else {
            self.given.turn_left(side)
        };
        let beside = match other {
            Some(other) if is_left != self.prefer_left => other.simplex,
            _ => side.simplex,
        };
        meet(beside);
        if lexicographic(u, self.b) == lexicographic(p, u) {
            State::Vertex(end)
        } else {
            State::Done(End::Reached(beside))
        }
    }
}
