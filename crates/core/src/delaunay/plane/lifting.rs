//! Delaunay triangulation by the lower hull of the points lifted to a paraboloid.
//!
//! K. Q. Brown, "Voronoi diagrams from convex hulls", Information Processing Letters 9 (1979), and
//! H. Edelsbrunner and R. Seidel, "Voronoi diagrams and arrangements", Discrete & Computational
//! Geometry 1 (1986): with z = x^2 + y^2 the lower facets of the convex hull are the Delaunay
//! triangles. The hull is built by randomized insertion with conflicts, K. L. Clarkson and P. W.
//! Shor, "Applications of random sampling in computational geometry, II", Discrete & Computational
//! Geometry 4 (1989), in the rounds of N. Amenta, S. Choi and G. Rote, "Incremental constructions
//! con BRIO" (2003): each point in the last round with probability 1/2, else in the one before with
//! 1/2, and so on, and along the curve within a round.
//!
//! # The lifted hull
//!
//! The hull has one more vertex: a point so high above the others that its facets are vertical as
//! far as any sign shows. Those facets are the ghosts; all others are lower facets. A point
//! *sees* a facet if it lies on its outer side. For a lower facet that means below its plane, which
//! is the orientation of four lifted points and is the in-circle determinant, with heights
//! perturbed as for ties; for a ghost it means beyond its hull edge. No height is ever computed, so
//! none is rounded. All perturbed points are extreme and no four are coplanar: the hull is
//! simplicial and has every point as a vertex.
//!
//! # Conflicts
//!
//! A point outside the hull so far is in conflict with the facets that it sees. Each point stores
//! one of them, and each facet the list of points that store it. When p is inserted, the facets
//! that it sees form a disk; they are removed, and replaced by a cone of new facets from p to the
//! horizon. The points x that stored a removed facet are assigned a facet of the cone:
//!
//! - Each x sees a facet of the cone. It sees a connected set of facets, and saw one that is removed.
//!   If all that it saw are removed, it sees new ones, since it lies outside the new hull. If not, it
//!   saw the facets g and h on either side of an edge of the horizon, where p sees only g. The plane
//!   of the new facet on that edge is a combination of the planes of g and h with positive factors,
//!   since p is outside one and inside the other: so x, outside both, is outside it.
//! - It sees the one in whose angle around p it lies. Near p, the lower facets of the cone are the
//!   graph of a convex function; each plane lies below the cone except on its own facet. So if x is
//!   below any plane, it is below the one in whose angle it lies. On the border of two angles both
//!   planes agree. Outside the angles of all lower facets, when p is on the hull of the points in the
//!   plane, x is beyond an edge at p and sees a ghost.
//!
//! The angle is found by a binary search around p with 2-D orientation tests.
//!
//! # Bound
//!
//! A point changes its facet only when a facet that it sees is removed: O(n log n) times in total,
//! expected over the random rounds, for every input (the theorem of Clarkson and Shor). A search
//! takes the logarithm of the degree of p, below 6 on average over the vertices: O(n log n) in
//! total if degrees are bounded, and O(n log^2 n) if points crowd around vertices of high degree.

use std::ops::Range;

use delone_predicates::{Point2, Sign, incircle_canonical, lexicographic, orient2d};

use super::first::first_triangle;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room, zeroed};
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Patch, half_edge, half_edges, next, prev, triangle};
use crate::order::random;

/// Insertions between two checks for interruption.
const WATCH_EVERY: usize = 4096;

/// No point.
const NONE: u32 = u32::MAX;

/// Fills `mesh` with the triangulation of vertices `block` and returns a ghost; `None` if the block
/// is collinear. `points` end with NaN for infinity.
pub fn build(
    points: &[Point2],
    block: Range<u32>,
    mesh: Patch,
    watch: &Watch,
) -> Result<Option<Code>> {
    let order = rounds(block.clone())?;
    let Some(first) = first_triangle(points, order.iter().copied()) else {
        return Ok(None);
    };
    let mut hull = Hull::start(points, block, mesh, first)?;
    for (i, &p) in order.iter().filter(|v| !first.contains(v)).enumerate() {
        if i % WATCH_EVERY == 0 {
            watch.check()?;
        }
        hull.insert(p);
    }
    hull.ghost().map(Some)
}

/// The vertices in random rounds, each in order.
fn rounds(block: Range<u32>) -> Result<Vec<u32>> {
    // Trailing zeros of a random number: 0 for one half, the last round, 1 for a quarter, ...
    let round = |v: u32| random(v).trailing_zeros() as usize;
    let mut count = [0; 65];
    for v in block.clone() {
        count[round(v)] += 1;
    }
    let mut start = [0; 65];
    for r in (0..64).rev() {
        start[r] = start[r + 1] + count[r + 1];
    }
    let mut order = zeroed(block.len())?;
    for v in block {
        let at = &mut start[round(v)];
        order[*at] = v;
        *at += 1;
    }
    Ok(order)
}

/// A new facet, from the inserted point to `vertex` and to that of the next spoke around the point.
#[derive(Clone, Copy)]
struct Spoke {
    vertex: u32,
    facet: u32,
}

/// The hull of the points so far, and the conflicts of the others.
struct Hull<'a> {
    points: &'a [Point2],
    mesh: Patch<'a>,
    /// The first vertex of the block and the first record of the patch.
    base: [u32; 2],
    facets: usize,
    /// For each vertex a facet that it sees, and the next vertex that stores the same one.
    seen: Vec<u32>,
    next: Vec<u32>,
    /// For each facet the first vertex that stores it.
    kept_by: Vec<u32>,
    stack: Vec<Code>,
    visible: Vec<u32>,
    horizon: Vec<Code>,
    cone: Vec<Spoke>,
    moved: Vec<u32>,
}

impl<'a> Hull<'a> {
    /// The hull of a first triangle, counterclockwise, and the point above.
    fn start(
        points: &'a [Point2],
        block: Range<u32>,
        mut mesh: Patch<'a>,
        first: [u32; 3],
    ) -> Result<Self> {
        let n = block.len();
        let base = [block.start, mesh.first()];
        mesh.triangle(first);
        let mut hull = Self {
            points,
            mesh,
            base,
            facets: 2 * n - 2,
            seen: zeroed(n)?,
            next: zeroed(n)?,
            kept_by: filled(2 * n - 2, NONE)?,
            stack: Vec::new(),
            visible: Vec::new(),
            horizon: Vec::new(),
            cone: Vec::new(),
            moved: with_room(n)?,
        };
        let at = first.map(|v| points[v as usize]);
        // Records 1 to 3 are the ghosts across edges 0 to 2. A point that sees no edge is inside.
        for x in block.filter(|v| !first.contains(v)) {
            let beyond = |k: usize| {
                orient2d(at[(k + 1) % 3], at[(k + 2) % 3], points[x as usize]) == Sign::Negative
            };
            let ghost = (0..3).find(|&k| beyond(k));
            hull.keep(x, base[1] + ghost.map_or(0, |k| k as u32 + 1));
        }
        Ok(hull)
    }

    fn at(&self, v: u32) -> Point2 {
        self.points[v as usize]
    }

    /// Stores `facet` as the conflict of `x`.
    fn keep(&mut self, x: u32, facet: u32) {
        let (x_at, facet_at) = ((x - self.base[0]) as usize, (facet - self.base[1]) as usize);
        self.seen[x_at] = facet;
        self.next[x_at] = std::mem::replace(&mut self.kept_by[facet_at], x);
    }

    /// Whether `p` lies on the outer side of `facet`: the orientation of four lifted points.
    fn sees(&self, p: u32, facet: u32) -> bool {
        let corners = self.mesh.corners(facet);
        let p = self.at(p);
        let inf = self.mesh.infinite();
        let Some(k) = corners.iter().position(|&v| v == inf) else {
            let [a, b, c] = corners.map(|v| self.at(v));
            return incircle_canonical(a, b, c, p) == Sign::Positive;
        };
        // A vertical facet over a hull edge; in its own plane the lifted edge is a lower hull.
        let [a, b] = [corners[(k + 1) % 3], corners[(k + 2) % 3]].map(|v| self.at(v));
        match orient2d(a, b, p) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => lexicographic(a, p) == lexicographic(p, b),
        }
    }

    /// Inserts the lifted point `p` into the hull.
    fn insert(&mut self, p: u32) {
        self.find_horizon(p);
        self.moved.clear();
        for i in 0..self.visible.len() {
            let facet_at = (self.visible[i] - self.base[1]) as usize;
            let mut x = std::mem::replace(&mut self.kept_by[facet_at], NONE);
            while x != NONE {
                if x != p {
                    self.moved.push(x);
                }
                x = self.next[(x - self.base[0]) as usize];
            }
        }
        self.build_cone(p);
        self.redistribute(p);
    }

    /// Finds the facets that `p` sees and their horizon, counterclockwise, as half-edges of the
    /// facets that stay. No vertex lies inside the disk of visible facets, so they form a tree, and
    /// the search visits each once.
    fn find_horizon(&mut self, p: u32) {
        self.visible.clear();
        self.horizon.clear();
        let seed = self.seen[(p - self.base[0]) as usize];
        let mut ahead = self.mesh.opposites(seed);
        ahead.reverse();
        self.visible.push(seed);
        self.stack.extend(ahead);
        while let Some(e) = self.stack.pop() {
            if self.sees(p, triangle(e)) {
                self.visible.push(triangle(e));
                self.stack.push(self.mesh.opposite(prev(e)));
                self.stack.push(self.mesh.opposite(next(e)));
            } else {
                self.horizon.push(e);
            }
        }
    }

    /// Joins `p` to the horizon, using the records of the removed facets and two more.
    fn build_cone(&mut self, p: u32) {
        self.cone.clear();
        for i in 0..self.horizon.len() {
            let across = self.horizon[i];
            let [u, v] = [prev(across), next(across)].map(|e| self.mesh.vertex(e));
            let facet = match self.visible.pop() {
                Some(t) => t,
                None => self.mesh.fresh(),
            };
            self.mesh.set(facet, [p, u, v]);
            self.mesh.link(across, half_edge(facet, 0));
            self.cone.push(Spoke { vertex: u, facet });
        }
        for i in 0..self.cone.len() {
            let after = self.cone[(i + 1) % self.cone.len()];
            self.mesh
                .link(half_edge(self.cone[i].facet, 1), half_edge(after.facet, 2));
        }
    }

    /// Assigns each moved point the facet of the cone in whose angle around `p` it lies.
    fn redistribute(&mut self, p: u32) {
        if self.moved.is_empty() {
            return;
        }
        let inf = self.mesh.infinite();
        let mut cone = std::mem::take(&mut self.cone);
        let outer = cone.iter().position(|s| s.vertex == inf);
        cone.rotate_left(outer.unwrap_or(0));
        let angles = Angles::round(self.points, p, &cone, outer.is_some());
        let moved = std::mem::take(&mut self.moved);
        for &x in &moved {
            self.keep(x, cone[angles.of(self.at(x))].facet);
        }
        (self.cone, self.moved) = (cone, moved);
    }

    /// The infinite corner of some ghost.
    fn ghost(&self) -> Result<Code> {
        let inf = self.mesh.infinite();
        let corners = |t: u32| half_edges(t).find(|&e| self.mesh.vertex(e) == inf);
        (self.base[1]..self.base[1] + self.facets as u32)
            .find_map(corners)
            .ok_or_else(|| Error::Internal("the lifted hull is not closed".into()))
    }
}

/// The directions from a point to the vertices of its cone.
struct Angles<'a> {
    points: &'a [Point2],
    p: Point2,
    cone: &'a [Spoke],
    outer: bool,
    /// The first spoke that is at least a half turn from the first one.
    half: usize,
}

impl<'a> Angles<'a> {
    /// The angles between spokes; if p is on the hull, the first one leads to infinity.
    fn round(points: &'a [Point2], p: u32, cone: &'a [Spoke], outer: bool) -> Self {
        let p = points[p as usize];
        let at = |s: &Spoke| points[s.vertex as usize];
        let left = |s: &Spoke| orient2d(p, at(&cone[0]), at(s)) == Sign::Positive;
        let half = if outer {
            cone.len()
        } else {
            1 + cone[1..].partition_point(left)
        };
        Self {
            points,
            p,
            cone,
            outer,
            half,
        }
    }

    fn side(&self, spoke: usize, x: Point2) -> Sign {
        orient2d(self.p, self.points[self.cone[spoke].vertex as usize], x)
    }

    /// Counts the spokes that x is left of, or on. All `spokes` are within less than a half turn of
    /// x, with those on one side of it before those on the other.
    fn passed(&self, spokes: Range<usize>, x: Point2) -> usize {
        self.cone[spokes].partition_point(|s| {
            orient2d(self.p, self.points[s.vertex as usize], x) != Sign::Negative
        })
    }

    /// The last spoke at or before the direction of `x`.
    fn of(&self, x: Point2) -> usize {
        let m = self.cone.len();
        if self.outer {
            //   The finite spokes 1 to m - 1 span at most a half turn; beyond either end is outside.
            if self.side(1, x) == Sign::Negative {
                0
            } else if self.side(m - 1, x) == Sign::Positive {
                m - 1
            } else {
                1 + self.passed(2..m - 1, x)
            }
        } else if self.side(0, x) != Sign::Negative {
            self.passed(1..self.half, x)
        } else {
            self.half - 1 + self.passed(self.half..m, x)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_hold_each_vertex_once_and_grow() {
        let order = rounds(5..1005).unwrap();
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(5..1005));
        let last: Vec<u32> = order
            .iter()
            .copied()
            .filter(|&v| random(v) % 2 == 1)
            .collect();
        assert_eq!(last, order[order.len() - last.len()..]);
        assert!((400..600).contains(&last.len()));
    }

    #[test]
    fn angles_are_found_from_both_sides_and_on_spokes() {
        let points = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [0.0, 0.0]];
        let cone = [0, 1, 2, 3].map(|vertex| Spoke {
            vertex,
            facet: vertex,
        });
        let angles = Angles::round(&points, 4, &cone, false);
        for (x, expected) in [
            ([2.0, 0.0], 0),
            ([1.0, 1.0], 0),
            ([0.0, 3.0], 1),
            ([-1.0, 1.0], 1),
            ([-1.0, -1.0], 2),
            ([0.0, -3.0], 3),
            ([1.0, -1.0], 3),
        ] {
            assert_eq!(angles.of(x), expected, "{x:?}");
        }
        // On the spoke a half turn from the first, either side is right.
        assert!([1, 2].contains(&angles.of([-2.0, 0.0])));
    }
}
