//! The edges of a 2-D tiling, and turns around its vertices.

use crate::base::arrays::{Side, Triangles};

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

/// ```text
///        a                 the edge from s[next(k)] to s[prev(k)] of one triangle is the edge
///       / \                from s'[prev(k')] to s'[next(k')] of the one beyond
///      / k \
///     b-----c
///      \ k'/
///       \ /
/// ```
impl Triangles<'_> {
    /// The corners at the ends of the edge opposite a corner, counterclockwise.
    #[inline]
    pub fn ends(&self, side: Side) -> [Side; 2] {
        [next(side.corner), prev(side.corner)].map(|corner| Side { corner, ..side })
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
            if now.is_some_and(|side| side.simplex == start.simplex) {
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
