//! Exact validation of a 2-D Delaunay triangulation: lists the simplices that are wrong.
//!
//! Why these checks suffice: if all triangles are counterclockwise and each inner edge joins
//! exactly two of them, the triangles cover each point of the plane as often as their boundary
//! winds around it; a boundary that is one convex cycle winds once around its interior. So they
//! tile the hull, and a tiling whose inner edges are all locally Delaunay is Delaunay (B. Delaunay,
//! "Sur la sphère vide", 1934).

use delone_predicates::{Sign, incircle, lexicographic, orient2d, tie_flips};

use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::zeroed;
use crate::base::points;
use crate::base::proof::{self, Tiling, Verdict};
use crate::base::watch::{Pace, Watch};
use crate::order::arrange;

/// Triangles, or vertices, between two checks for interruption in cheap loops.
const LOT: usize = 1 << 16;

/// Faults of a 2-D triangulation.
pub type Findings = proof::Findings<2>;

impl Tiling<2, 3> for Triangles<'_> {
    /// Its ends, counterclockwise.
    fn facet(self, t: usize, k: usize) -> [i32; 2] {
        let s = self.simplices[t];
        [s[(k + 1) % 3], s[(k + 2) % 3]]
    }

    fn turned([u, v]: [i32; 2]) -> [i32; 2] {
        [v, u]
    }

    fn is_positive(self, t: usize) -> bool {
        let [a, b, c] = self.corners(t);
        orient2d(a, b, c) == Sign::Positive
    }

    fn repeated(self, watch: &Watch) -> Result<Vec<[u32; 2]>> {
        repeated_edges(self, watch)
    }

    fn check_boundary(self, boundary: Vec<[i32; 2]>, used: usize, found: &mut Findings) {
        let (expected, actual) = (
            (2 * used).saturating_sub(boundary.len() + 2),
            self.simplices.len(),
        );
        if expected != actual {
            found.count.push([expected as u32, actual as u32]);
        }
        hull(self, boundary, found);
    }
}

/// Checks every property of the canonical Delaunay triangulation of the points.
pub fn validate(given: Triangles, watch: &Watch) -> Result<Findings> {
    points::scan(given.points)?;
    let ordered = arrange(given.points, 1, watch)?;
    let judge = |t: usize, k: usize, q: i32| {
        let [u, v] = given.facet(t, k);
        let [p, u, v, q] = [given.simplices[t][k], u, v, q].map(|v| given.point(v));
        match incircle(p, u, v, q) {
            Sign::Positive => Verdict::Wrong,
            Sign::Zero if tie_flips(u, v, p, q) => Verdict::Tie,
            _ => Verdict::Right,
        }
    };
    proof::examine_all(given, &ordered.rows, &ordered.duplicates, judge, watch)
}

/// Directed edges that occur twice, by a counting sort of the ends by origin.
fn repeated_edges(given: Triangles, watch: &Watch) -> Result<Vec<[u32; 2]>> {
    let mut pace = Pace::new(watch, LOT);
    let mut start = zeroed::<u32>(given.points.len() + 1)?;
    for s in given.simplices {
        pace.spend(1)?;
        for &v in s {
            start[v as usize + 1] += 1;
        }
    }
    for v in 0..given.points.len() {
        start[v + 1] += start[v];
    }
    let mut ends = zeroed::<i32>(3 * given.simplices.len())?;
    for s in given.simplices {
        pace.spend(1)?;
        for k in 0..3 {
            let at = &mut start[s[k] as usize];
            ends[*at as usize] = s[(k + 1) % 3];
            *at += 1;
        }
    }
    let mut repeated = Vec::new();
    let mut from = 0;
    for (u, &to) in (0u32..).zip(&start[..given.points.len()]) {
        pace.spend(1)?;
        let list = &mut ends[from..to as usize];
        list.sort_unstable();
        let twice = list
            .windows(2)
            .filter(|w| w[0] == w[1])
            .map(|w| [u, w[0] as u32]);
        repeated.extend(twice);
        from = to as usize;
    }
    repeated.dedup();
    Ok(repeated)
}

/// The boundary must be one cycle that ascends and descends lexicographically exactly once and
/// never turns right: then it is the convex hull, with the points on its edges.
fn hull(given: Triangles, mut boundary: Vec<[i32; 2]>, found: &mut Findings) {
    boundary.sort_unstable();
    let up = |[u, v]: [i32; 2]| lexicographic(given.point(u), given.point(v)).is_lt();
    let Some(&first) = boundary.first() else {
        return;
    };
    let mut edge = first;
    let mut summits = 0;
    let mut seen = 0;
    loop {
        seen += 1;
        let after = boundary.binary_search_by_key(&edge[1], |e| e[0]);
        let Ok(after) = after.map(|i| boundary[i]) else {
            found.hull.push(edge.map(|v| v as u32));
            return;
        };
        let turn = orient2d(
            given.point(edge[0]),
            given.point(edge[1]),
            given.point(after[1]),
        );
        summits += usize::from(up(edge) && !up(after));
        let back = turn == Sign::Zero && up(edge) != up(after);
        if turn == Sign::Negative || back {
            found.hull.push(edge.map(|v| v as u32));
        }
        edge = after;
        // If the boundary is not a permutation, the walk may miss its start: the count ends it.
        if edge == first || seen > boundary.len() {
            break;
        }
    }
    if seen != boundary.len() || summits != 1 {
        found.hull.push(first.map(|v| v as u32));
    }
}
