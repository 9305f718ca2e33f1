//! The boundary of a tiling: whether it is convex, and its nearest point to a query.

use delone_predicates::{Point2, Sign, lexicographic, orient2d};

use super::boxes::{Boxes, length};
use super::range::seen_from;
use super::tiling::prev;
use crate::arrays::{Given, Side, Triangles};
use crate::error::{Error, Result};
use crate::points::Extent;
use crate::watch::Watch;
use crate::wide::{lowest, ratio, scaled, sign};

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
    /// The edges in boxes, if the boundary is not convex.
    boxes: Option<Boxes<2>>,
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
        let boxes = (!convex).then(|| Boxes::over(sides.len(), box_of, watch));
        Ok(Self {
            boxes: boxes.transpose()?,
            sides,
            convex,
            places,
        })
    }

    /// The boundary edge nearest to `q`, which is outside, and how far along it the nearest point
    /// is.
    ///
    /// On a convex boundary it takes as many steps as there are edges between `from`, which has `q`
    /// beyond it, and the result; otherwise it uses boxes.
    pub fn nearest(&self, given: &Triangles, from: Side, q: Point2) -> (Side, f64) {
        if let Some(boxes) = &self.boxes {
            let found = boxes.nearest(q, None, |i, unit| measure(given, self.sides[i], q, unit));
            return found.map_or((from, 0.0), |(i, along)| (self.sides[i], along));
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

/// The position of `q` along a boundary edge, 0 at its start and 1 at its end.
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
    if error <= NEAR || along < -error || along > 1.0 + error || u == v {
        along
    } else {
        project_exactly([u, v], q)
    }
}

/// The same in integers: far away all digits cancel if the foot is on the edge.
#[cold]
fn project_exactly([u, v]: [Point2; 2], q: Point2) -> f64 {
    let low = lowest(&[u, v, q], &[]);
    let minus = |p: Point2| [0, 1].map(|k| scaled(p[k], low) - scaled(u[k], low));
    let (d, w) = (minus(v), minus(q));
    let along = &d[0] * &w[0] + &d[1] * &w[1];
    let square = &d[0] * &d[0] + &d[1] * &d[1];
    let beyond = if sign(&along) == Sign::Negative {
        -1.0
    } else {
        2.0
    };
    ratio(&along, &square, 0).unwrap_or(beyond)
}

/// The distance of `q` from a boundary edge, of coordinates times `unit`, and the position along
/// it.
fn measure(given: &Triangles, side: Side, q: Point2, unit: f64) -> (f64, f64) {
    let t = clamp(project(given, side, q));
    let [u, v] = ends(given, side).map(|p| p.map(|x| x * unit));
    let away = [0, 1].map(|k| u[k] + t * (v[k] - u[k]) - q[k] * unit);
    (length(away), t)
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
