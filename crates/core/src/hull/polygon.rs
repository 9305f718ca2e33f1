//! The canonical Delaunay triangulation of a convex polygon in 3-D, all of whose corners are
//! extreme.
//!
//! L. P. Chew, "Building Voronoi diagrams for convex polygons in linear expected time" (1990): the
//! corners are removed in random order, which records the two neighbors that each has at that time,
//! and inserted again in the opposite order, each beyond the edge between those two. The in-circle
//! test in the plane of the polygon is an in-sphere test with a point off the plane, with ties
//! broken by coordinates, so the result is independent of the order. Terminates because each corner
//! is inserted once.

use delone_predicates::{Point3, Sign, insphere_canonical, orient3d};

use crate::base::error::{Error, Result};

/// No triangle.
const NONE: usize = usize::MAX;

/// The triangles of a polygon, which is counterclockwise seen from outside; `first` are four points
/// of the hull that are not coplanar.
pub fn triangulate(
    points: &[Point3],
    polygon: &[u32],
    first: [Point3; 4],
) -> Result<Vec<[u32; 3]>> {
    let &[a, b, c, ..] = polygon else {
        return Err(Error::Internal("a facet has two vertices".into()));
    };
    if polygon.len() == 3 {
        return Ok(vec![[a, b, c]]);
    }
    let [a, b, c] = [a, b, c].map(|v| points[v as usize]);
    let inner = first
        .into_iter()
        .find(|&p| orient3d(a, b, c, p) == Sign::Negative)
        .ok_or_else(|| Error::Internal("the whole hull is beyond a facet".into()))?;
    let mut mesh = Mesh {
        at: polygon.iter().map(|&v| points[v as usize]).collect(),
        inner,
        triangles: Vec::new(),
        outer: vec![NONE; polygon.len()],
    };
    let (kept, removed) = thinned(polygon.len());
    mesh.add(kept);
    for &[v, left, right] in removed.iter().rev() {
        mesh.insert(v, left, right)?;
    }
    let alive = mesh.triangles.iter().filter(|t| t.alive);
    Ok(alive.map(|t| t.corners.map(|i| polygon[i])).collect())
}

/// The three corners that stay, counterclockwise, and for each other one itself and its neighbors
/// when it is removed.
fn thinned(n: usize) -> ([usize; 3], Vec<[usize; 3]>) {
    let mut order: Vec<usize> = (0..n).collect();
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    for i in (1..n).rev() {
        // A xorshift generator (G. Marsaglia, 2003).
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        order.swap(i, (state % (i as u64 + 1)) as usize);
    }
    let mut next: Vec<usize> = (0..n).map(|i| (i + 1) % n).collect();
    let mut prev: Vec<usize> = (0..n).map(|i| (i + n - 1) % n).collect();
    let removed = order[3..]
        .iter()
        .map(|&v| {
            let (l, r) = (prev[v], next[v]);
            (next[l], prev[r]) = (r, l);
            [v, l, r]
        })
        .collect();
    let a = order[0];
    ([a, next[a], prev[a]], removed)
}

/// A triangle of corner numbers and the triangles opposite each.
struct Triangle {
    corners: [usize; 3],
    beyond: [usize; 3],
    alive: bool,
}

struct Mesh {
    at: Vec<Point3>,
    inner: Point3,
    triangles: Vec<Triangle>,
    /// For each corner, the triangle at the boundary edge that begins there.
    outer: Vec<usize>,
}

impl Mesh {
    /// Adds a triangle without neighbors.
    fn add(&mut self, corners: [usize; 3]) {
        let t = self.triangles.len();
        self.triangles.push(Triangle {
            corners,
            beyond: [NONE; 3],
            alive: true,
        });
        for corner in corners {
            self.outer[corner] = t;
        }
    }

    /// Whether `v` is inside the circumcircle of a triangle.
    fn holds(&self, t: usize, v: usize) -> bool {
        let [a, b, c] = self.triangles[t].corners.map(|i| self.at[i]);
        // Facets are counterclockwise from outside, so the inner point is on the negative side.
        debug_assert!(orient3d(a, b, c, self.inner) == Sign::Negative);
        insphere_canonical(a, c, b, self.inner, self.at[v]) == Sign::Positive
    }

    /// Inserts a corner again beyond the edge from `left` to `right`.
    ///
    /// ```text
    ///       v                 the triangles whose circumcircles contain v are removed;
    ///      / \                v is joined to all their corners, from right around to left
    ///  left---right
    ///      \ t /
    /// ```
    fn insert(&mut self, v: usize, left: usize, right: usize) -> Result<()> {
        // Edges of the cavity as seen from v: tail, head and the code beyond; depth-first, in order
        // from left, clockwise around the cavity.
        let mut chain: Vec<(usize, usize, usize)> = Vec::new();
        let mut open = vec![(left, right, self.outer[left], NONE)];
        while let Some((tail, head, t, from)) = open.pop() {
            if t == NONE || !self.holds(t, v) {
                chain.push((tail, head, t));
                continue;
            }
            let triangle = &mut self.triangles[t];
            triangle.alive = false;
            // The corner opposite the edge through which the triangle was reached.
            let lost = || Error::Internal("the triangles of a polygon are not linked".into());
            let k = match from {
                NONE => triangle
                    .corners
                    .iter()
                    .position(|&c| c != tail && c != head),
                _ => triangle.beyond.iter().position(|&b| b == from),
            };
            let k = k.ok_or_else(lost)?;
            let apex = triangle.corners[k];
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            // Across the edge from the apex to the head is the triangle opposite the tail.
            let [at_tail, at_head] =
                [tail, head].map(|c| if triangle.corners[i] == c { i } else { j });
            let (to_head, to_tail) = (triangle.beyond[at_tail], triangle.beyond[at_head]);
            open.push((apex, head, to_head, t));
            open.push((tail, apex, to_tail, t));
        }
        let first = self.triangles.len();
        let count = chain.len();
        for (i, &(tail, head, beyond)) in chain.iter().enumerate() {
            let t = first + i;
            let before = if i > 0 { t - 1 } else { NONE };
            let after = if i + 1 < count { t + 1 } else { NONE };
            // The edge was reached from its other side.
            self.triangles.push(Triangle {
                corners: [head, tail, v],
                beyond: [before, after, beyond],
                alive: true,
            });
            if beyond == NONE {
                self.outer[head] = t;
            } else {
                let there = &mut self.triangles[beyond];
                let k = (0..3).find(|&k| ![tail, head].contains(&there.corners[k]));
                if let Some(k) = k {
                    there.beyond[k] = t;
                }
            }
        }
        self.outer[v] = first + count - 1;
        self.outer[left] = first;
        Ok(())
    }
}
