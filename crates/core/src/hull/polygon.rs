//! The canonical Delaunay triangulation of a convex polygon in space, whose corners are all extreme.
//!
//! L. P. Chew, "Building Voronoi diagrams for convex polygons in linear expected time" (1990): the
//! corners are taken away in random order, which leaves each with its two neighbours at that time, and
//! come back in the opposite order, each beyond the edge between those two. A circle in the plane of
//! the polygon is asked for by a sphere through it and a point off the plane, and ties by
//! coordinates, so that the order leaves no trace. Each corner comes once: it ends.

use delone_predicates::{Point3, Sign, insphere_canonical, orient3d};

use crate::error::{Error, Result};

/// No triangle.
const NONE: usize = usize::MAX;

/// The triangles of a polygon, which is counter-clockwise seen from outside; `first` are four points
/// of the hull that are not in one plane.
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
        .ok_or_else(|| Error::Internal("all of the hull is beyond a facet".into()))?;
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

/// The three corners that stay, counter-clockwise, and for each other one itself and its neighbours
/// when it is taken away.
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

/// A triangle of corner numbers and what lies opposite each.
struct Triangle {
    corners: [usize; 3],
    beyond: [usize; 3],
    alive: bool,
}

struct Mesh {
    at: Vec<Point3>,
    inner: Point3,
    triangles: Vec<Triangle>,
    /// For each corner the triangle at the boundary edge that begins there.
    outer: Vec<usize>,
}

impl Mesh {
    /// Puts a triangle of which nothing is beyond any edge.
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

    /// Whether `v` is inside the circle of a triangle.
    fn holds(&self, t: usize, v: usize) -> bool {
        let [a, b, c] = self.triangles[t].corners.map(|i| self.at[i]);
        // Outer sides are counter-clockwise: the inner point makes a negative tetrahedron.
        debug_assert!(orient3d(a, b, c, self.inner) == Sign::Negative);
        insphere_canonical(a, c, b, self.inner, self.at[v]) == Sign::Positive
    }

    /// Puts a corner back beyond the edge from `left` to `right`.
    ///
    /// ```text
    ///       v                 the triangles whose circles hold v go; v is joined to all their
    ///      / \                corners, from right round to left
    ///  left---right
    ///      \ t /
    /// ```
    fn insert(&mut self, v: usize, left: usize, right: usize) -> Result<()> {
        // Edges of the hole as seen from v: tail, head and what is beyond; depth first, they come
        // in order from left, clockwise round the hole.
        let mut chain: Vec<(usize, usize, usize)> = Vec::new();
        let mut open = vec![(left, right, self.outer[left], NONE)];
        while let Some((tail, head, t, from)) = open.pop() {
            if t == NONE || !self.holds(t, v) {
                chain.push((tail, head, t));
                continue;
            }
            let triangle = &mut self.triangles[t];
            triangle.alive = false;
            // The corner opposite the edge through which it was reached.
            let lost = || Error::Internal("a polygon's triangles are not linked".into());
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
            // Beyond the edge from the apex to the head is what is opposite the tail.
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
            // The edge was seen from its other side.
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
