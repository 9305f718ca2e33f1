//! The boundary of a tiling: whether it is convex, and its nearest point to a query.

use std::cmp::Ordering;

use delone_predicates::{Point2, Sign, lexicographic, orient2d};
use num_bigint::BigInt;

use super::boxes::Boxes;
use super::excess::Excess;
use super::range::seen_from;
use super::tiling::prev;
use crate::base::arrays::{Given, Side, Triangles};
use crate::base::error::{Error, Result};
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::base::wide::{lowest, ratio, scaled, sign};

/// Simplices between two checks for interruption.
const LOT: usize = 1 << 16;

/// The boundary edges of a tiling.
#[derive(Debug)]
pub struct Boundary {
    /// The boundary edges; if the boundary is convex, in counterclockwise order.
    pub sides: Vec<Side>,
    /// Whether the triangles fill one convex region.
    pub convex: bool,
    /// The index of each edge in `sides`, sorted by edge.
    places: Vec<(Side, usize)>,
    /// The edges in boxes, and the box around all, if the boundary is not convex.
    boxes: Option<(Boxes<2>, Extent<2>)>,
}

impl Boundary {
    /// Extracts the boundary from the arrays.
    pub fn of(given: &Triangles, watch: &Watch) -> Result<Self> {
        let mut sides = outer_sides(given, watch)?;
        let convex = match cycle(given, &sides)? {
            Some(cycle) if is_convex(given, &cycle) => {
                sides = cycle;
                true
            }
            _ => false,
        };
        let mut places: Vec<_> = sides.iter().copied().zip(0..).collect();
        places.sort_unstable();
        let box_of = |i: usize| Extent::of(ends(given, sides[i]));
        let boxes = if convex {
            None
        } else {
            let all = sides.iter().flat_map(|&side| ends(given, side));
            Some((Boxes::over(sides.len(), box_of, watch)?, Extent::of(all)))
        };
        Ok(Self {
            boxes,
            sides,
            convex,
            places,
        })
    }

    /// The boundary edge nearest to `q`, which is outside, by exact distances, and how far along it
    /// the nearest point is.
    ///
    /// On a convex boundary it takes as many steps as there are edges between `from`, which has `q`
    /// beyond it, and the result; otherwise it uses boxes.
    pub fn nearest(&self, given: &Triangles, from: Side, q: Point2) -> (Side, f64) {
        if let Some((boxes, extent)) = &self.boxes {
            let edge = |i: usize| self.sides[i];
            return nearest_of(boxes, extent, given, q, edge).unwrap_or((from, 0.0));
        }
        let count = self.sides.len();
        let start = self
            .places
            .binary_search_by_key(&from, |p| p.0)
            .map_or(0, |i| self.places[i].1);
        let mut i = start;
        let mut forward = None;
        // At most once around: a change of direction ends at the vertex in between.
        for _ in 0..count {
            let along = project(given, self.sides[i], q);
            let ahead = along > 1.0;
            if (0.0..=1.0).contains(&along) || along.is_nan() || forward == Some(!ahead) {
                return self.place(i, clamp(along));
            }
            forward = Some(ahead);
            i = (i + if ahead { 1 } else { count - 1 }) % count;
        }
        self.place(i, clamp(project(given, self.sides[i], q)))
    }

    /// A place on the cycle, at a vertex on the edge that starts there: which of the two edges is
    /// reached depends on where the search began.
    fn place(&self, i: usize, along: f64) -> (Side, f64) {
        if along < 1.0 {
            return (self.sides[i], along);
        }
        (self.sides[(i + 1) % self.sides.len()], 0.0)
    }
}

/// The boundary facets of a tiling, ascending.
pub fn outer_sides<const D: usize, const N: usize>(
    given: &Given<D, N>,
    watch: &Watch,
) -> Result<Vec<Side>> {
    let mut sides = Vec::new();
    for (simplex, row) in given.neighbors.iter().enumerate() {
        if simplex.is_multiple_of(LOT) {
            watch.check()?;
        }
        let open = (0..N).filter(|&k| row[k] < 0);
        sides.extend(open.map(|corner| Side { simplex, corner }));
    }
    Ok(sides)
}

/// Error of a position along an edge up to which rounding is acceptable.
const NEAR: f64 = 1e-12;

fn clamp(along: f64) -> f64 {
    // NaN, for an edge of zero length, gives its start.
    if along > 0.0 { along.min(1.0) } else { 0.0 }
}

/// The ends of an edge.
fn ends(given: &Triangles, side: Side) -> [Point2; 2] {
    given.ends(side).map(|end| given.at(end))
}

/// The position of `q` along a boundary edge, 0 at its start and 1 at its end. Its comparisons with
/// 0 and 1 are exact.
fn project(given: &Triangles, side: Side, q: Point2) -> f64 {
    let [u, v] = ends(given, side);
    // Each in its own unit: the edge may be very short compared with the distance.
    let ([d], short) = seen_from(u, [v]);
    let ([w], long) = seen_from(u, [q]);
    let terms = [w[0] * d[0], w[1] * d[1]];
    let square = d[0] * d[0] + d[1] * d[1];
    let share = |x: f64| x / square * (long / short);
    let along = share(terms[0] + terms[1]);
    // Four roundings in each term, and one in the sum.
    let error = 5.0 * f64::EPSILON * share(terms[0].abs() + terms[1].abs());
    let is_between = along > error && along < 1.0 - error && error <= NEAR;
    if is_between || along < -error || along > 1.0 + error {
        return along;
    }
    // Common on lattices: the edge is parallel to an axis, and the query is beside one of its ends.
    let beside = |p: Point2| (0..2).all(|k| q[k] == p[k] || u[k] == v[k]);
    if beside(u) {
        return 0.0;
    }
    if beside(v) {
        return 1.0;
    }
    project_exactly([u, v], q)
}

/// The same in integers: far away all digits cancel if the foot is on the edge.
#[cold]
fn project_exactly([u, v]: [Point2; 2], q: Point2) -> f64 {
    let low = lowest(&[u, v, q], &[]);
    let minus = |p: Point2| [0, 1].map(|k| scaled(p[k], low) - scaled(u[k], low));
    let (d, w) = (minus(v), minus(q));
    let along = &d[0] * &w[0] + &d[1] * &w[1];
    let square = &d[0] * &d[0] + &d[1] * &d[1];
    let rounded = ratio(&along, &square, 0);
    // Rounding must not reach 0 or 1.
    match (sign(&along), along.cmp(&square)) {
        (Sign::Zero, _) => 0.0,
        (Sign::Negative, _) => rounded.unwrap_or(-1.0).min(-f64::MIN_POSITIVE),
        (_, Ordering::Equal) => 1.0,
        (_, Ordering::Greater) => rounded.unwrap_or(2.0).max(1.0_f64.next_up()),
        (_, Ordering::Less) => rounded
            .unwrap_or(0.5)
            .clamp(f64::MIN_POSITIVE, 1.0_f64.next_down()),
    }
}

/// An edge that may be the nearest one.
struct Candidate {
    /// The vertices of the edge, or of its end with the nearest point, ascending: if two edges share
    /// it, their distances are equal.
    feature: [i32; 2],
    item: usize,
    /// The nearest point is the start of the edge, its end, or between them.
    along: f64,
    /// A lower bound of the excess of its distance.
    least: f64,
}

/// The nearest of the edges in boxes, the first of several, and how far along it the nearest point
/// is: rounded bounds leave a few candidates, between which integers decide.
fn nearest_of(
    boxes: &Boxes<2>,
    extent: &Extent<2>,
    given: &Triangles,
    q: Point2,
    side: impl Fn(usize) -> Side,
) -> Option<(Side, f64)> {
    let excess = Excess::over(extent, q);
    let mut found: Vec<Candidate> = Vec::new();
    let mut within = f64::INFINITY;
    boxes.search(
        None,
        |extent| excess.least(extent),
        |item| {
            let along = clamp(project(given, side(item), q));
            let shares = [1.0 - along, along];
            let [least, most] = excess.bounds(&ends(given, side(item)), shares);
            if least <= within {
                within = within.min(most);
                let corners = given.ends(side(item)).map(|end| given.vertex(end));
                found.push(Candidate {
                    feature: feature(corners, along),
                    item,
                    along,
                    least,
                });
            }
            within
        },
    );
    found.retain(|candidate| candidate.least <= within);
    found.sort_unstable_by_key(|candidate| (candidate.feature, candidate.item));
    found.dedup_by_key(|candidate| candidate.feature);
    found.sort_unstable_by_key(|candidate| candidate.item);
    let best = match &found[..] {
        [] => return None,
        [only] => only,
        several => several_exactly(several, q, |candidate| ends(given, side(candidate.item)))?,
    };
    Some((side(best.item), best.along))
}

fn feature([u, v]: [i32; 2], along: f64) -> [i32; 2] {
    if along <= 0.0 {
        [-1, u]
    } else if along >= 1.0 {
        [-1, v]
    } else {
        [u.min(v), u.max(v)]
    }
}

/// The nearest of the candidates, the first of several, by exact comparison.
#[cold]
#[inline(never)]
fn several_exactly(
    found: &[Candidate],
    q: Point2,
    ends: impl Fn(&Candidate) -> [Point2; 2],
) -> Option<&Candidate> {
    let mut points = vec![q];
    points.extend(found.iter().flat_map(&ends));
    let low = lowest(&points, &[]);
    let minus = |p: Point2, o: Point2| [0, 1].map(|k| scaled(p[k], low) - scaled(o[k], low));
    let square = |[x, y]: &[BigInt; 2]| x * x + y * y;
    let mut best: Option<(&Candidate, BigInt, BigInt)> = None;
    for candidate in found {
        let [u, v] = ends(candidate);
        let (above, below) = if candidate.along > 0.0 && candidate.along < 1.0 {
            let (d, w) = (minus(v, u), minus(q, u));
            let height = &d[0] * &w[1] - &d[1] * &w[0];
            (&height * &height, square(&d))
        } else {
            let end = if candidate.along > 0.0 { v } else { u };
            (square(&minus(q, end)), BigInt::from(1))
        };
        let is_nearer = |(_, least, unit): &(_, BigInt, BigInt)| &above * unit < least * &below;
        if best.as_ref().is_none_or(is_nearer) {
            best = Some((candidate, above, below));
        }
    }
    best.map(|(candidate, ..)| candidate)
}

/// The boundary edges in order, if they are one cycle.
fn cycle(given: &Triangles, sides: &[Side]) -> Result<Option<Vec<Side>>> {
    let Some(&start) = sides.first() else {
        return Ok(None);
    };
    let mut cycle = Vec::with_capacity(sides.len());
    let mut side = start;
    let mut steps = 4 * given.simplices.len() + 4;
    loop {
        cycle.push(side);
        // The next edge starts where this one ends: rotate clockwise around that vertex.
        let mut at = Side {
            corner: prev(side.corner),
            ..side
        };
        while let Some(beside) = given.turn_right(at) {
            at = beside;
            steps = steps.checked_sub(1).ok_or_else(|| {
                Error::Internal("the triangles around a boundary vertex form a cycle".into())
            })?;
        }
        side = Side {
            corner: prev(at.corner),
            ..at
        };
        if side == start {
            return Ok((cycle.len() == sides.len()).then_some(cycle));
        }
        if cycle.len() == sides.len() {
            return Ok(None);
        }
    }
}

/// Whether a closed chain never turns right and winds once: then it has exactly one lexicographic
/// minimum.
fn is_convex(given: &Triangles, cycle: &[Side]) -> bool {
    let start = |side: &Side| ends(given, *side)[0];
    let n = cycle.len();
    let mut minima = 0;
    for i in 0..n {
        let [a, b, c] = [i, i + 1, i + 2].map(|j| start(&cycle[j % n]));
        if orient2d(a, b, c) == Sign::Negative {
            return false;
        }
        minima += usize::from(lexicographic(a, b).is_gt() && lexicographic(b, c).is_lt());
    }
    minima == 1
}
