//! Exact validation of a 3-D Delaunay triangulation: lists the simplices that are wrong.
//!
//! Why these checks suffice: if all tetrahedra are positive and each inner facet joins exactly two
//! of them, they cover each point of space as often as their boundary winds around it. The boundary
//! is checked to be that of a convex body: its facets are divided into lower and upper ones by the
//! sign of their normal along z, and if that is zero along y, then x, which is the direction z
//! tilted by an infinitesimal. Along it, each lower facet projects to a triangle that turns right,
//! each upper one to one that turns left. An edge between an upper and a lower facet is on the
//! silhouette. If the silhouette is one convex cycle, which ascends and descends once, then lower
//! facets tile its interior once (as in 2-D, see `delaunay::plane::validate`), and so do upper ones. Each
//! set is then the graph of a function over a convex polygon, and one that is locally convex (or
//! concave) at each edge is convex (or concave). So the boundary winds once around its interior,
//! which is convex, and the tetrahedra tile it. A tiling of the hull whose inner facets are all
//! locally Delaunay is Delaunay (B. Delaunay, "Sur la sphère vide", 1934), and likewise with
//! perturbed heights.

use std::collections::HashMap;

use delone_predicates::{Point3, Sign, insphere, insphere_canonical, lexicographic};
use delone_predicates::{orient2d, orient3d};

use crate::base::arrays::Tetrahedra;
use crate::base::error::Result;
use crate::base::memory::{filled, zeroed};
use crate::base::points;
use crate::base::proof::{self, Tiling, Verdict};
use crate::base::watch::{Pace, Watch};
use crate::mesh::space::FACETS;
use crate::order::space::arrange;

/// Facets, or tetrahedra, between two checks for interruption in cheap loops.
const LOT: usize = 1 << 16;

/// Faults of a 3-D triangulation.
pub type Findings3 = proof::Findings<3>;

impl Tiling<3, 4> for Tetrahedra<'_> {
    /// From its smallest row on.
    fn facet(self, t: usize, k: usize) -> [i32; 3] {
        let [a, b, c] = FACETS[k].map(|i| self.simplices[t][i]);
        smallest_first([b, a, c])
    }

    fn turned([a, b, c]: [i32; 3]) -> [i32; 3] {
        smallest_first([b, a, c])
    }

    fn is_positive(self, t: usize) -> bool {
        let [a, b, c, d] = self.corners(t);
        orient3d(a, b, c, d) == Sign::Positive
    }

    fn repeated(self, watch: &Watch) -> Result<Vec<[u32; 3]>> {
        repeated_facets(self, watch)
    }

    fn check_boundary(self, boundary: Vec<[i32; 3]>, _used: usize, found: &mut Findings3) {
        hull(self, &boundary, found);
    }
}

fn smallest_first([a, b, c]: [i32; 3]) -> [i32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Checks every property of the canonical Delaunay triangulation of the points.
pub fn validate(given: Tetrahedra, watch: &Watch) -> Result<Findings3> {
    points::scan(given.points)?;
    let ordered = arrange(given.points, watch)?;
    let judge = |t: usize, _, apex: i32| {
        let ([a, b, c, d], e) = (given.corners(t), given.point(apex));
        match insphere(a, b, c, d, e) {
            Sign::Positive => Verdict::Wrong,
            Sign::Zero if insphere_canonical(a, b, c, d, e) == Sign::Positive => Verdict::Tie,
            _ => Verdict::Right,
        }
    };
    proof::examine_all(given, &ordered.rows, &ordered.duplicates, judge, watch)
}

/// Oriented facets that occur twice, by a counting sort by their smallest vertex.
fn repeated_facets(given: Tetrahedra, watch: &Watch) -> Result<Vec<[u32; 3]>> {
    let mut pace = Pace::new(watch, LOT);
    let facets = || (0..given.simplices.len()).flat_map(|t| (0..4).map(move |k| given.facet(t, k)));
    let mut start = filled(given.points.len() + 1, 0usize)?;
    for [a, ..] in facets() {
        pace.spend(1)?;
        start[a as usize + 1] += 1;
    }
    for v in 0..given.points.len() {
        start[v + 1] += start[v];
    }
    watch.check()?;
    let mut ends = zeroed::<[i32; 2]>(4 * given.simplices.len())?;
    for [a, b, c] in facets() {
        pace.spend(1)?;
        let at = &mut start[a as usize];
        ends[*at] = [b, c];
        *at += 1;
    }
    watch.check()?;
    let mut repeated = Vec::new();
    let mut from = 0;
    for (a, &to) in (0u32..).zip(&start[..given.points.len()]) {
        pace.spend(1 + to - from)?;
        let list = &mut ends[from..to];
        list.sort_unstable();
        let twice = list.windows(2).filter(|w| w[0] == w[1]);
        repeated.extend(twice.map(|w| [a, w[0][0] as u32, w[0][1] as u32]));
        from = to;
    }
    repeated.dedup();
    Ok(repeated)
}

/// The orientation of a, b, c as seen along the tilted z axis: the sign of their normal along z, or
/// y, or x.
fn turn(a: Point3, b: Point3, c: Point3) -> Sign {
    let along = |j: usize, k: usize| orient2d([a[j], a[k]], [b[j], b[k]], [c[j], c[k]]);
    match along(0, 1) {
        Sign::Zero => match along(2, 0) {
            Sign::Zero => along(1, 2),
            sign => sign,
        },
        sign => sign,
    }
}

/// Whether the projection of a precedes that of b: by x, then, because of the tilt, by decreasing
/// z, then by y.
fn before(a: Point3, b: Point3) -> bool {
    let turned = |p: Point3| [p[0], -p[2], p[1]];
    lexicographic(turned(a), turned(b)).is_lt()
}

/// Checks that the outward facets of the boundary bound a convex body, see the head of the file.
fn hull(given: Tetrahedra, boundary: &[[i32; 3]], found: &mut Findings3) {
    let mut across = HashMap::with_capacity(3 * boundary.len());
    let upper: Vec<bool> = boundary
        .iter()
        .map(|f| {
            let [a, b, c] = f.map(|v| given.point(v));
            turn(a, b, c) == Sign::Positive
        })
        .collect();
    let mut wrong = vec![false; boundary.len()];
    for (i, &[a, b, c]) in boundary.iter().enumerate() {
        for (edge, apex) in [([a, b], c), ([b, c], a), ([c, a], b)] {
            wrong[i] |= across.insert(edge, (i, apex)).is_some();
        }
    }
    let mut silhouette = HashMap::new();
    for (i, &[a, b, c]) in boundary.iter().enumerate() {
        let [pa, pb, pc] = [a, b, c].map(|v| given.point(v));
        for [u, v] in [[a, b], [b, c], [c, a]] {
            let Some(&(other, apex)) = across.get(&[v, u]) else {
                wrong[i] = true;
                continue;
            };
            // Outward facets have the body on their negative side.
            let side = orient3d(pa, pb, pc, given.point(apex));
            let folded = side == Sign::Zero && upper[i] != upper[other];
            wrong[i] |= side == Sign::Positive || folded;
            if upper[i] && !upper[other] {
                wrong[i] |= silhouette.insert(u, (v, i)).is_some();
            }
        }
    }
    cycle(given, &silhouette, &mut wrong);
    let faulty = boundary.iter().zip(&wrong).filter(|&(_, &wrong)| wrong);
    found.hull = faulty.map(|(f, _)| f.map(|v| v as u32)).collect();
    if boundary.is_empty() && !given.simplices.is_empty() {
        found.neighbors.push(0);
    }
}

/// The silhouette must be one cycle that ascends and descends once and never turns right.
fn cycle(given: Tetrahedra, silhouette: &HashMap<i32, (i32, usize)>, wrong: &mut [bool]) {
    let Some((&first, &(_, facet))) = silhouette.iter().min() else {
        if let Some(wrong) = wrong.first_mut() {
            *wrong = true;
        }
        return;
    };
    let (mut u, mut seen, mut summits) = (first, 0, 0);
    loop {
        seen += 1;
        let Some(&(v, i)) = silhouette.get(&u) else {
            wrong[facet] = true;
            return;
        };
        let Some(&(w, _)) = silhouette.get(&v) else {
            wrong[i] = true;
            return;
        };
        let [a, b, c] = [u, v, w].map(|v| given.point(v));
        let (up, up_after) = (before(a, b), before(b, c));
        summits += usize::from(up && !up_after);
        let turn = turn(a, b, c);
        wrong[i] |= turn == Sign::Negative || turn == Sign::Zero && up != up_after;
        u = v;
        // Each vertex of the cycle starts one edge; the count ends a walk that misses its start.
        if u == first || seen > silhouette.len() {
            break;
        }
    }
    wrong[facet] |= seen != silhouette.len() || summits != 1;
}
