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
use crate::base::proof::{Expected, Verdict};
use crate::base::watch::{Pace, Watch};
use crate::order::arrange;

/// Triangles, or vertices, between two checks for interruption in cheap loops.
const LOT: usize = 1 << 16;
/// Triangles between two checks for interruption.
const WATCH_EVERY: usize = 1 << 14;

/// Faults by kind; all are empty if the triangulation is right.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// Triangles that are not counterclockwise.
    pub orientation: Vec<u32>,
    /// Directed edges that belong to more than one triangle.
    pub edges: Vec<[u32; 2]>,
    /// Triangles whose neighbor across some edge does not share that edge.
    pub neighbors: Vec<u32>,
    /// Boundary edges after which the boundary is not a convex cycle.
    pub hull: Vec<[u32; 2]>,
    /// Distinct points that are not vertices.
    pub missing: Vec<u32>,
    /// Vertices that are not the first row with their coordinates.
    pub repeats: Vec<u32>,
    /// Adjacent triangles one of which has the other's apex in its circumcircle.
    pub delaunay: Vec<[u32; 2]>,
    /// Adjacent cocircular triangles whose common edge is not the canonical one.
    pub ties: Vec<[u32; 2]>,
    /// The expected number of triangles, 2 n - h - 2, and the actual one, if they differ.
    pub count: Vec<[u32; 2]>,
}

impl Triangles<'_> {
    /// The ends of edge k of triangle t, counterclockwise.
    fn edge(&self, t: usize, k: usize) -> [i32; 2] {
        let s = self.simplices[t];
        [s[(k + 1) % 3], s[(k + 2) % 3]]
    }

    /// The corner of triangle `other` whose opposite edge is edge k of t, reversed.
    fn mutual(&self, t: usize, k: usize, other: usize) -> Option<usize> {
        let [u, v] = self.edge(t, k);
        (0..3).find(|&j| self.neighbors[other][j] == t as i32 && self.edge(other, j) == [v, u])
    }
}

/// Checks every property of the canonical Delaunay triangulation of the points.
pub fn validate(given: Triangles, watch: &Watch) -> Result<Findings> {
    points::scan(given.points)?;
    let ordered = arrange(given.points, 1, watch)?;
    let expected = Expected {
        rows: &ordered.rows,
        others: &ordered.duplicates,
        may_hide: false,
    };
    let judge = |sites: [i32; 4]| {
        let [p, u, v, q] = sites.map(|v| given.point(v));
        match incircle(p, u, v, q) {
            Sign::Positive => Verdict::Wrong,
            Sign::Zero if tie_flips(u, v, p, q) => Verdict::Tie,
            _ => Verdict::Right,
        }
    };
    let (mut found, mut unused) = examine(given, expected, judge, watch)?;
    unused.sort_unstable();
    found.missing = unused;
    Ok(found)
}

/// Checks that `given` tiles the convex hull of its vertices, and asks `judge` at each inner edge:
/// about p, u, v, q, where triangle p, u, v is to the left of the edge from u to v, and q is
/// opposite. Returns all faults except `missing`, and the expected rows that no triangle uses.
pub fn examine(
    given: Triangles,
    expected: Expected,
    judge: impl Fn([i32; 4]) -> Verdict,
    watch: &Watch,
) -> Result<(Findings, Vec<u32>)> {
    let mut found = Findings {
        edges: repeated_edges(given, watch)?,
        ..Findings::default()
    };
    let unused = expected.unused(given.simplices, &mut found.repeats, watch)?;
    let mut boundary = Vec::new();
    for t in 0..given.simplices.len() {
        if t % WATCH_EVERY == 0 {
            watch.check()?;
        }
        triangle(given, t, &judge, &mut found, &mut boundary);
    }
    let hidden = if expected.may_hide { unused.len() } else { 0 };
    let count = [2 * (expected.rows.len() - hidden), boundary.len() + 2];
    let count = count[0].saturating_sub(count[1]);
    if count != given.simplices.len() {
        found
            .count
            .push([count as u32, given.simplices.len() as u32]);
    }
    watch.check()?;
    hull(given, boundary, &mut found);
    Ok((found, unused))
}

/// Checks one triangle: its orientation, its neighbors, the verdicts across its edges.
fn triangle(
    given: Triangles,
    t: usize,
    judge: &impl Fn([i32; 4]) -> Verdict,
    found: &mut Findings,
    boundary: &mut Vec<[i32; 2]>,
) {
    let [a, b, c] = given.corners(t);
    if orient2d(a, b, c) != Sign::Positive {
        found.orientation.push(t as u32);
    }
    let mut joined = true;
    for k in 0..3 {
        let other = given.neighbors[t][k];
        if other < 0 {
            boundary.push(given.edge(t, k));
            continue;
        }
        let other = other as usize;
        let Some(j) = given.mutual(t, k, other) else {
            joined = false;
            continue;
        };
        if t < other {
            let [u, v] = given.edge(t, k);
            let pair = [t as u32, other as u32];
            match judge([given.simplices[t][k], u, v, given.simplices[other][j]]) {
                Verdict::Wrong => found.delaunay.push(pair),
                Verdict::Tie => found.ties.push(pair),
                Verdict::Right => {}
            }
        }
    }
    if !joined {
        found.neighbors.push(t as u32);
    }
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
