//! The triangles inside arbitrary rings: crossings become vertices, and winding numbers decide what
//! is inside.
//!
//! A single simple ring is filled by `ring`. Otherwise the winding number is 0 outside the hull
//! and changes by one at each edge of a ring, so a flood fill over the triangles computes it:
//! linear time after the triangulation.
//!

use delone_predicates::Point2;

use super::edges::{Edges, edge};
use super::marked::Marked;
use super::ring::simple_ring;
use super::{Options, Work};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::points::LIMIT2;
use crate::base::watch::Watch;
use crate::delaunay::Clock;
use crate::delaunay::plane::Method;
use crate::mesh::plane::{half_edges, next, prev, triangle};

/// Which points are inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Those with an odd winding number.
    EvenOdd,
    /// Those with a nonzero winding number, turns being counted with their sign.
    NonZero,
}

/// Triangles inside rings.
#[derive(Debug, Default)]
pub struct Filled {
    /// Crossings, which are not vertices of the rings.
    pub added: Vec<Point2>,
    /// Triangles as rows of the points of the rings, with added vertices after them.
    pub simplices: Vec<[i32; 3]>,
}

/// Not yet reached by the flood fill.
const UNKNOWN: u32 = u32::MAX;

/// The triangles inside the rings `points[starts[i]..starts[i + 1]]`, each of which is closed
/// implicitly. Rings without area have none.
pub fn polygon(points: &[Point2], starts: &[usize], rule: Rule, watch: &Watch) -> Result<Filled> {
    if let [0, end] = starts[..]
        && end == points.len()
        && let Some(simplices) = simple_ring(points)?
    {
        let added = Vec::new();
        return Ok(Filled { added, simplices });
    }
    wound(points, starts, rule, watch)
}

/// The same, from the triangulation of the hull.
fn wound(points: &[Point2], starts: &[usize], rule: Rule, watch: &Watch) -> Result<Filled> {
    let mut segments = with_room(points.len())?;
    for ring in starts.windows(2) {
        let rows = ring[0] as u32..ring[1] as u32;
        let after = rows.clone().skip(1).chain(rows.clone().take(1));
        segments.extend(rows.zip(after).map(|(a, b)| [a, b]));
    }
    let options = Options {
        split: true,
        conforming: false,
        max_vertices: LIMIT2.saturating_sub(points.len()),
        method: Method::Auto,
        workers: 1,
    };
    let work = Work::start(points, &segments, options, watch, &mut Clock::start());
    let mut work = match work {
        Err(Error::TooFew { .. } | Error::Collinear { .. }) => return Ok(Filled::default()),
        work => work?,
    };
    let inserted = work.insert_segments(points, watch)?;
    let parts = flood(&mut work.marked, &inserted.pieces)?;
    let added = work.added(points.len());
    let rows = &work.rows;
    let inside = |w: &i32| match rule {
        Rule::EvenOdd => w % 2 != 0,
        Rule::NonZero => *w != 0,
    };
    let inside: Vec<bool> = parts.winding.iter().map(inside).collect();
    let mesh = work.marked.patch();
    let mut simplices = with_room(parts.of.len())?;
    for (t, _) in (0..)
        .zip(&parts.of)
        .filter(|(_, part)| inside[**part as usize])
    {
        simplices.push(mesh.corners(t).map(|v| rows[v as usize] as i32));
    }
    Ok(Filled { added, simplices })
}

/// Regions of the plane that the pieces separate.
struct Regions {
    /// The region of each triangle; ghosts are in the first.
    of: Vec<u32>,
    /// The winding number of each region.
    winding: Vec<i32>,
}

/// Finds the regions by a flood fill of each one, which continues across a piece only when the
/// region is full. So only as many pieces are looked up as there are regions.
fn flood(marked: &mut Marked, pieces: &[([u32; 2], u32)]) -> Result<Regions> {
    let used = marked.triangles();
    let vertices = marked.count;
    let mesh = marked.patch();
    let mut of = filled(used as usize, UNKNOWN)?;
    let inf = mesh.infinite();
    let ghost = (0..used).find(|&t| mesh.corners(t).contains(&inf));
    let mut stack = Vec::new();
    stack.extend(ghost);
    // Pieces, by the code on the side that was reached, and the region there.
    let (mut exits, mut entries) = (Vec::new(), Vec::new());
    let mut part = 0;
    for &t in &stack {
        of[t as usize] = part;
    }
    loop {
        while let Some(t) = stack.pop() {
            for e in half_edges(t) {
                let there = triangle(mesh.opposite(e));
                if of[there as usize] != UNKNOWN {
                    continue;
                }
                if mesh.is_marked(e) {
                    push(&mut exits, e)?;
                } else {
                    of[there as usize] = part;
                    push(&mut stack, there)?;
                }
            }
        }
        let beyond = |e: u32| triangle(mesh.opposite(e));
        while exits
            .pop_if(|e| of[beyond(*e) as usize] != UNKNOWN)
            .is_some()
        {}
        let Some(e) = exits.pop() else {
            break;
        };
        part += 1;
        of[beyond(e) as usize] = part;
        stack.push(beyond(e));
        let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
        push(&mut entries, (ends, of[triangle(e) as usize]))?;
    }
    let edges = Edges::of(entries.iter().map(|e| edge(e.0)).collect(), vertices)?;
    // By how much the winding number is larger on the left of an edge directed from its smaller
    // end.
    let mut more = filled(edges.all.len(), 0)?;
    for &(ends, _) in pieces {
        if let Some(place) = edges.place(ends) {
            more[place] += if ends[0] < ends[1] { 1 } else { -1 };
        }
    }
    let mut winding = filled(1, 0)?;
    for (ends, from) in entries {
        let more = edges.place(ends).map_or(0, |place| more[place]);
        let more = if ends[0] < ends[1] { more } else { -more };
        winding.push(winding[from as usize] - more);
    }
    Ok(Regions { of, winding })
}

#[cfg(test)]
mod tests {
    use delone_predicates::{Sign, orient2d};
    use proptest::prelude::*;

    use super::*;

    fn turned(simplices: &[[i32; 3]]) -> Vec<[i32; 3]> {
        let turn = |t: &[i32; 3]| {
            let k = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
            [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]
        };
        let mut all: Vec<_> = simplices.iter().map(turn).collect();
        all.sort_unstable();
        all
    }

    /// Whether two segments of positive length have a point in common.
    fn meet([a, b]: [Point2; 2], [c, d]: [Point2; 2]) -> bool {
        let on = |a: Point2, b: Point2, p: Point2| {
            orient2d(a, b, p).is_zero()
                && (0..2).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k]))
        };
        let parted = |a, b, c, d| {
            let sides = [orient2d(a, b, c), orient2d(a, b, d)];
            sides.contains(&Sign::Positive) && sides.contains(&Sign::Negative)
        };
        parted(a, b, c, d) && parted(c, d, a, b)
            || on(a, b, c)
            || on(a, b, d)
            || on(c, d, a)
            || on(c, d, b)
    }

    /// Whether a ring, closed or not, is simple; tests every pair of its sides.
    fn is_simple(ring: &[Point2]) -> bool {
        let closed = ring.len() > 1 && ring.first() == ring.last();
        let ring = &ring[..ring.len() - usize::from(closed)];
        let n = ring.len();
        let side = |i: usize| [ring[i % n], ring[(i + 1) % n]];
        let apart = |i: usize, j: usize| match j - i {
            1 => !meet([side(i)[0]; 2], side(j)) && !meet([side(j)[1]; 2], side(i)),
            _ if i == 0 && j == n - 1 => {
                !meet([side(i)[1]; 2], side(j)) && !meet([side(j)[0]; 2], side(i))
            }
            _ => !meet(side(i), side(j)),
        };
        n >= 3 && (0..n).all(|i| side(i)[0] != side(i)[1] && (i + 1..n).all(|j| apart(i, j)))
    }

    /// A short ring is filled without its hull if and only if it is simple, with the same
    /// triangles.
    fn check(ring: &[Point2]) -> std::result::Result<(), TestCaseError> {
        let found = simple_ring(ring).unwrap();
        prop_assert_eq!(found.is_some(), is_simple(ring), "{:?}", ring);
        if let Some(found) = found {
            let whole = wound(ring, &[0, ring.len()], Rule::NonZero, &Watch::idle()).unwrap();
            prop_assert_eq!(whole.added.len(), 0);
            prop_assert_eq!(turned(&found), turned(&whole.simplices), "{:?}", ring);
            if ring.first() != ring.last() {
                let closed = [ring, &ring[..1]].concat();
                prop_assert_eq!(simple_ring(&closed).unwrap(), Some(found));
            }
        }
        Ok(())
    }

    fn lattice(side: i32) -> impl Strategy<Value = Point2> {
        (0..=side, 0..=side).prop_map(|(x, y)| [f64::from(x), f64::from(y)])
    }

    /// A simple ring, grown from a triangle vertex by vertex.
    fn grown(points: &[(Point2, usize)], turn: bool) -> Vec<Point2> {
        let mut ring: Vec<Point2> = Vec::new();
        for &(p, place) in points {
            let place = place % (ring.len() + 1);
            ring.insert(place, p);
            if ring.len() >= 3 && !is_simple(&ring) {
                ring.remove(place);
            }
        }
        if turn {
            ring.reverse();
        }
        ring
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]

        #[test]
        fn any_short_ring_is_simple_or_not(
            ring in prop::collection::vec(lattice(3), 0..8),
            scale in prop::sample::select(vec![1.0, 0.1, 1e-300, 1e300, 3e-324]),
        ) {
            let ring: Vec<_> = ring.iter().map(|p| p.map(|x| x * scale)).collect();
            let found = simple_ring(&ring).unwrap();
            // Coordinates too small or too large for the grid are left to the hull.
            if scale > 1e-305 {
                check(&ring)?;
            } else {
                prop_assert!(found.is_none() || is_simple(&ring));
            }
        }

        #[test]
        fn simple_rings_with_ties_and_straight_corners(
            points in prop::collection::vec((lattice(9), any::<usize>()), 3..90),
            turn in any::<bool>(),
        ) {
            check(&grown(&points, turn))?;
        }

        #[test]
        fn random_simple_rings(
            points in prop::collection::vec((lattice(1 << 20), any::<usize>()), 3..120),
            turn in any::<bool>(),
        ) {
            check(&grown(&points, turn))?;
        }
    }

    #[test]
    fn a_ring_that_winds_twice_is_not_simple() {
        let [a, b, c] = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]];
        assert_eq!(simple_ring(&[a, b, c, a, b, c]).unwrap(), None);
        // A strip bent into slightly more than a circle: all of its triangles turn left.
        let strip = |radius: f64, k: i32| {
            let turn = f64::from(k) * 0.3;
            [radius * turn.cos(), radius * turn.sin()]
        };
        for (steps, simple) in [(18, true), (24, false)] {
            let outer = (0..=steps).map(|k| strip(2.0, k));
            let inner = (0..=steps).rev().map(|k| strip(1.0, k));
            let ring: Vec<Point2> = outer.chain(inner).collect();
            assert_eq!(simple_ring(&ring).unwrap().is_some(), simple);
        }
    }
}
