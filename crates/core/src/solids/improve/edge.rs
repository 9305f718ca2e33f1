//! Edge removal: the tetrahedra around an edge are replaced by two for each triangle of their ring.
//!
//! ```text
//!            b                      b
//!          / | \                  / | \        The ring v0 v1 ... is triangulated, here by one
//!        v0--|--v2     ->       v0-----v2      triangle, and each triangle is joined to both
//!          \ | /                  \ | /        ends: 3-2, 4-4, 5-6 and so on.
//!            a                      a
//! ```
//!
//! The best triangulation of the ring is found by dynamic programming: G. T. Klincsek, "Minimal
//! triangulations of polygonal domains", Annals of Discrete Mathematics 9 (1980), as in J. R.
//! Shewchuk, "Two discrete optimization algorithms for the topological improvement of tetrahedral
//! meshes" (2002). It takes O(m^3) measurements for a ring of m vertices.

use super::measure::quality;
use super::slide::continues;
use super::store::{Corners, NONE, Store};

/// The longest ring that is tried; the chance of success falls quickly beyond 7 vertices.
const LONGEST: usize = 10;

/// A replacement for some tetrahedra.
#[derive(Debug, Clone, Default)]
pub struct Plan {
    /// The tetrahedra that are removed.
    pub old: Vec<u32>,
    /// The new tetrahedra.
    pub new: Vec<Corners>,
    /// The smallest quality of the new ones.
    pub least: f64,
    /// Whether walls are flipped in their plane.
    pub turning: bool,
}

/// Buffers of the search, reused between calls.
#[derive(Debug, Default)]
pub struct Ring {
    /// The vertices around the edge.
    vertices: Vec<u32>,
    /// The tetrahedra between them.
    tetrahedra: Vec<u32>,
    /// Whether the ring is closed.
    closed: bool,
}

impl Ring {
    /// Walks around the edge from corner `i` to corner `j` of a tetrahedron. False if the ring is
    /// too long or meets itself.
    fn walk(&mut self, store: &Store, t: u32, i: usize, j: usize) -> bool {
        let v = store.corners[t as usize];
        let (a, b) = (v[i], v[j]);
        let (k, l) = others(i, j);
        self.vertices.clear();
        self.tetrahedra.clear();
        self.closed = self.follow(store, t, [a, b, v[k], v[l]]);
        if !self.closed && self.tetrahedra.len() <= LONGEST {
            // Back to the wall on the other side: the mirrored walk, reversed.
            self.vertices.clear();
            self.tetrahedra.clear();
            self.follow(store, t, [b, a, v[l], v[k]]);
            let (start, apex) = match (self.tetrahedra.last(), self.vertices.last()) {
                (Some(&start), Some(&apex)) => (start, apex),
                _ => return false,
            };
            let second = self.vertices[self.vertices.len() - 2];
            self.vertices.clear();
            self.tetrahedra.clear();
            self.follow(store, start, [a, b, apex, second]);
        }
        let n = self.vertices.len();
        let distinct = (1..n).all(|i| !self.vertices[..i].contains(&self.vertices[i]));
        self.tetrahedra.len() <= LONGEST && distinct && n > 2
    }

    /// Walks from the tetrahedron of `a, b, c, d` across the face `a, b, d` and on, until it
    /// returns (true) or reaches a wall.
    fn follow(&mut self, store: &Store, start: u32, [a, b, c, d]: Corners) -> bool {
        let (mut t, mut c, mut d) = (start, c, d);
        self.vertices.push(c);
        loop {
            self.tetrahedra.push(t);
            if self.tetrahedra.len() > LONGEST {
                return false;
            }
            let next = store.corner(t, c).and_then(|k| store.beyond(t, k));
            match next {
                Some(u) if u == start => return true,
                Some(u) => {
                    self.vertices.push(d);
                    let sum = store.corners[u as usize].into_iter().fold(0, |s, v| s ^ v);
                    (t, c, d) = (u, d, sum ^ a ^ b ^ d);
                }
                None => {
                    self.vertices.push(d);
                    return false;
                }
            }
        }
    }
}

/// The other two corners, such that the four are an even permutation.
fn others(i: usize, j: usize) -> (usize, usize) {
    const OTHERS: [[(usize, usize); 4]; 4] = [
        [(0, 0), (2, 3), (3, 1), (1, 2)],
        [(3, 2), (0, 0), (0, 3), (2, 0)],
        [(1, 3), (3, 0), (0, 0), (0, 1)],
        [(2, 1), (0, 2), (1, 0), (0, 0)],
    ];
    OTHERS[i][j]
}

/// The best removal of the edge between two corners, if it is better than both `above` and the
/// present tetrahedra. An edge between walls is removed only if these are coplanar and may be
/// flipped.
pub fn remove(
    store: &Store,
    ring: &mut Ring,
    (t, i, j): (u32, usize, usize),
    above: f64,
    may_turn: bool,
) -> Option<Plan> {
    let [a, b] = [i, j].map(|k| store.corners[t as usize][k]);
    // Most edges on walls are rejected here, before any walk.
    if !may_turn && store.fixed[a as usize] && store.fixed[b as usize] {
        let (k, l) = others(i, j);
        store.beyond(t, k)?;
        store.beyond(t, l)?;
    }
    if !ring.walk(store, t, i, j) || !(ring.closed || may_turn && turns(store, ring, a, b)) {
        return None;
    }
    let before = ring.tetrahedra.iter().map(|&t| store.quality[t as usize]);
    let above = before.fold(above, f64::min).max(above);
    let (least, triangles) = triangulate(&ring.vertices, above, |[u, v, w]| {
        let first = quality(store.places_of([u, v, w, b]));
        if first > above {
            first.min(quality(store.places_of([u, w, v, a])))
        } else {
            first
        }
    })?;
    let new = triangles
        .into_iter()
        .flat_map(|[u, v, w]| [[u, v, w, b], [u, w, v, a]]);
    Some(Plan {
        old: ring.tetrahedra.clone(),
        new: new.collect(),
        least,
        turning: !ring.closed,
    })
}

/// Whether an edge of two boundary walls lies in one plane with them, between them, and the walls that would
/// replace them are not on the boundary already, where parts of it touch.
fn turns(store: &Store, ring: &Ring, a: u32, b: u32) -> bool {
    let (Some(&first), Some(&last)) = (ring.vertices.first(), ring.vertices.last()) else {
        return false;
    };
    let ends = [ring.tetrahedra.first(), ring.tetrahedra.last()];
    let nothing = |t: Option<&u32>, v: u32| {
        // The wall is opposite the ring's vertex on the inner side.
        t.and_then(|&t| store.corner(t, v).map(|k| store.across[t as usize][k]))
    };
    let (second, before) = (ring.vertices[1], ring.vertices[ring.vertices.len() - 2]);
    if nothing(ends[0], second) != Some(NONE) || nothing(ends[1], before) != Some(NONE) {
        return false;
    }
    // Tetrahedra on both sides of the new edge are tested for positivity later, which implies
    // convexity; here only the plane is tested.
    let [p, q, r, s] = [a, b, first, last].map(|v| store.points[v as usize]);
    if !continues([p, q], [r, s]) {
        return false;
    }
    let pinched = |v: u32| store.pinched[v as usize];
    let apart = pinched(first) && pinched(last) && (pinched(a) || pinched(b));
    let mut around = Vec::new();
    let known = store.whole_star(first, &mut around).is_ok();
    let has = |t: &u32, end: u32| {
        let corners = store.corners[*t as usize];
        corners.contains(&last) && corners.contains(&end) && !ring.tetrahedra.contains(t)
    };
    let twice = |end: u32| around.iter().any(|t| has(t, end));
    known && !apart && !twice(a) && !twice(b)
}

/// The triangulation of a polygon whose worst triangle is best, if that is better than `above`.
fn triangulate(
    polygon: &[u32],
    above: f64,
    worth: impl Fn([u32; 3]) -> f64,
) -> Option<(f64, Vec<[u32; 3]>)> {
    const SIDE: usize = LONGEST + 1;
    let n = polygon.len();
    let mut best = [[f64::INFINITY; SIDE]; SIDE];
    let mut apex = [[0; SIDE]; SIDE];
    for width in 2..n {
        for i in 0..n - width {
            let j = i + width;
            best[i][j] = f64::NEG_INFINITY;
            for k in i + 1..j {
                let sides = best[i][k].min(best[k][j]);
                if sides <= above || sides <= best[i][j] {
                    continue;
                }
                let least = sides.min(worth([polygon[i], polygon[k], polygon[j]]));
                if least > best[i][j] {
                    best[i][j] = least;
                    apex[i][j] = k;
                }
            }
        }
    }
    let least = best[0][n - 1];
    if least <= above {
        return None;
    }
    let mut triangles = Vec::with_capacity(n - 2);
    let mut chains = vec![(0, n - 1)];
    while let Some((i, j)) = chains.pop() {
        if j - i > 1 {
            let k = apex[i][j];
            triangles.push([polygon[i], polygon[k], polygon[j]]);
            chains.extend([(k, j), (i, k)]);
        }
    }
    Some((least, triangles))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_other_corners_make_an_even_permutation() {
        for i in 0..4 {
            for j in (0..4).filter(|&j| j != i) {
                let (k, l) = others(i, j);
                let p = [i, j, k, l];
                let swaps = (0..4).flat_map(|x| (x + 1..4).map(move |y| (x, y)));
                assert_eq!(swaps.filter(|&(x, y)| p[x] > p[y]).count() % 2, 0, "{p:?}");
            }
        }
    }

    #[test]
    fn the_best_triangulation_avoids_the_worst_triangles() {
        // Of the fans of a pentagon, only that from vertex 3 has no triangle with both 0 and 2.
        let worth = |t: [u32; 3]| if t.contains(&3) { 1.0 } else { 0.5 };
        let (least, triangles) = triangulate(&[0, 1, 2, 3, 4], 0.0, worth).unwrap();
        assert_eq!((least, triangles.len()), (1.0, 3));
        assert!(triangulate(&[0, 1, 2, 3, 4], 1.0, worth).is_none());
    }
}
