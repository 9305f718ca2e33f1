//! Exported arrays as a tiling: steps from triangle to triangle by codes, never by vertex numbers.
//!
//! So the two sides of an edge may name different rows with equal coordinates.

use crate::arrays::Triangles;

/// A corner of a triangle, and the opposite edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The triangle.
    pub triangle: usize,
    /// The corner, 0 to 2.
    pub corner: usize,
}

/// The corner after `k`, counterclockwise.
#[inline]
pub fn next(k: usize) -> usize {
    if k == 2 { 0 } else { k + 1 }
}

/// The corner before `k`.
#[inline]
pub fn prev(k: usize) -> usize {
    if k == 0 { 2 } else { k - 1 }
}

impl Triangles<'_> {
    /// The vertex at a corner.
    #[inline]
    pub fn vertex(&self, side: Side) -> i32 {
        self.simplices[side.triangle][side.corner]
    }

    /// The same edge seen from the triangle beyond; `None` at the boundary.
    ///
    /// ```text
    ///        a                 the edge from s[next(k)] to s[next(next(k))] of the one
    ///       / \                is the edge from s'[next(next(k'))] to s'[next(k')] of the other
    ///      / k \
    ///     b-----c
    ///      \ k'/
    ///       \ /
    /// ```
    #[inline]
    pub fn beyond(&self, side: Side) -> Option<Side> {
        let t = self.neighbors[side.triangle][side.corner];
        if t < 0 {
            return None;
        }
        let back = &self.neighbors[t as usize];
        let here = side.triangle as i32;
        let corner = usize::from(back[1] == here) + 2 * usize::from(back[2] == here);
        Some(Side {
            triangle: t as usize,
            // Invalid arrays, in which no edge is shared, must not lead out of range.
            corner: corner.min(2),
        })
    }

    /// The next triangle counterclockwise around the vertex at a corner.
    #[inline]
    pub fn turn_left(&self, side: Side) -> Option<Side> {
        let across = self.beyond(Side {
            corner: next(side.corner),
            ..side
        })?;
        Some(Side {
            corner: next(across.corner),
            ..across
        })
    }

    /// The next triangle clockwise around the vertex at a corner.
    #[inline]
    pub fn turn_right(&self, side: Side) -> Option<Side> {
        let across = self.beyond(Side {
            corner: prev(side.corner),
            ..side
        })?;
        Some(Side {
            corner: prev(across.corner),
            ..across
        })
    }

    /// Calls `visit` on each triangle around the vertex at a corner, once, until it answers
    /// `false`: counterclockwise until the turn is complete; if it reaches the boundary, clockwise
    /// from the first one. It ends after at most as many steps as there are triangles, even if the
    /// arrays are invalid. Returns whether the boundary was reached.
    #[inline]
    pub fn around(&self, start: Side, mut visit: impl FnMut(Side) -> bool) -> bool {
        let mut left = self.simplices.len();
        let mut now = Some(start);
        while let Some(side) = now {
            if !visit(side) || left == 0 {
                return false;
            }
            left -= 1;
            now = self.turn_left(side);
            if now.is_some_and(|side| side.triangle == start.triangle) {
                return false;
            }
        }
        let mut now = self.turn_right(start);
        while let Some(side) = now {
            if !visit(side) || left == 0 {
                break;
            }
            left -= 1;
            now = self.turn_right(side);
        }
        true
    }
}
