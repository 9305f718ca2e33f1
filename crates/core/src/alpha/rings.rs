//! The outlines of triangles that are kept, as rings of valid polygons.
//!
//! A walk along the boundary that stays with the triangles on its left turns back at a vertex that
//! other parts of the boundary touch. Where it meets one of its own vertices again, the piece since
//! then is a separate ring. So rings are simple, touch others only at vertices, and of each
//! component, which is connected through edges, exactly one is counterclockwise: its outline.

use delone_predicates::{Point2, Sign, orient2d};

use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::watch::{Pace, Watch};

/// Edges between two checks for interruption.
const LOT: usize = 1 << 16;

/// Rings of vertices; each begins with its lexicographically smallest one.
pub struct Rings {
    /// The vertices of all rings, the first not repeated.
    pub vertices: Vec<i32>,
    /// Where each ring begins, and the end.
    pub starts: Vec<i32>,
    /// The component of each ring.
    pub parts: Vec<i32>,
    /// Whether it is the outline, counterclockwise, and not a hole.
    pub outer: Vec<bool>,
}

/// Triangles and their components, -1 for those that are not kept.
struct Kept<'a> {
    points: &'a [Point2],
    neighbors: &'a [[i32; 3]],
    labels: &'a [i32],
}

impl Kept<'_> {
    /// The triangle on the other side of an edge, if it is kept.
    fn beyond(&self, t: usize, k: usize) -> Option<usize> {
        let n = usize::try_from(self.neighbors[t][k]).ok()?;
        (self.labels[n] >= 0).then_some(n)
    }

    /// The edge of the boundary after one, around the head of that.
    fn next(&self, mut t: usize, mut k: usize) -> (usize, usize) {
        loop {
            k = (k + 1) % 3;
            let Some(n) = self.beyond(t, k) else {
                return (t, k);
            };
            k = (0..3)
                .find(|&j| self.neighbors[n][j] == t as i32)
                .unwrap_or(0);
            t = n;
        }
    }
}

/// The rings of the components of triangles.
pub fn rings(
    points: &[Point2],
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    labels: &[i32],
    watch: &Watch,
) -> Result<Rings> {
    let kept = Kept {
        points,
        neighbors,
        labels,
    };
    let mut found = Rings {
        vertices: Vec::new(),
        starts: vec![0],
        parts: Vec::new(),
        outer: Vec::new(),
    };
    let mut is_done = filled(simplices.len(), [false; 3])?;
    // Where a vertex is in the walk.
    let mut place = filled(points.len(), u32::MAX)?;
    let mut walk: Vec<i32> = Vec::new();
    let mut pace = Pace::new(watch, LOT);
    for t in (0..simplices.len()).filter(|&t| labels[t] >= 0) {
        pace.spend(1)?;
        for k in 0..3 {
            if is_done[t][k] || kept.beyond(t, k).is_some() {
                continue;
            }
            let mut at = (t, k);
            while !is_done[at.0][at.1] {
                pace.spend(1)?;
                is_done[at.0][at.1] = true;
                let tail = simplices[at.0][(at.1 + 1) % 3];
                let since = place[tail as usize];
                if since != u32::MAX {
                    found.close(&kept, t, &walk[since as usize..])?;
                    for v in walk.drain(since as usize..) {
                        place[v as usize] = u32::MAX;
                    }
                }
                place[tail as usize] = walk.len() as u32;
                push(&mut walk, tail)?;
                at = kept.next(at.0, at.1);
            }
            found.close(&kept, t, &walk)?;
            for v in walk.drain(..) {
                place[v as usize] = u32::MAX;
            }
        }
    }
    Ok(found)
}

impl Rings {
    /// Adds a ring of the component of triangle `t`.
    fn close(&mut self, kept: &Kept<'_>, t: usize, ring: &[i32]) -> Result<()> {
        let at = |i: usize| kept.points[ring[i % ring.len()] as usize];
        let least = (0..ring.len()).min_by(|&i, &j| {
            at(i)
                .partial_cmp(&at(j))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let least = least.unwrap_or(0);
        let turn = orient2d(at(least + ring.len() - 1), at(least), at(least + 1));
        for i in 0..ring.len() {
            push(&mut self.vertices, ring[(least + i) % ring.len()])?;
        }
        push(&mut self.starts, self.vertices.len() as i32)?;
        push(&mut self.parts, kept.labels[t])?;
        push(&mut self.outer, turn == Sign::Positive)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_that_touch_are_two_rings() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let simplices = [[0, 1, 2], [0, 3, 4]];
        let neighbors = [[-1; 3], [-1; 3]];
        let found = rings(&points, &simplices, &neighbors, &[0, 1], &Watch::idle()).unwrap();
        assert_eq!(found.vertices, [0, 1, 2, 3, 4, 0]);
        assert_eq!((found.starts, found.parts), (vec![0, 3, 6], vec![0, 1]));
        assert_eq!(found.outer, [true, true]);
    }
}
