//! The area that two cells with arcs of great circles share.
//!
//! With G_e(x) the integral of the area form along a side e from its start to x, the area is the
//! sum of G_e(end) over sides e of either cell that end in the other one, and of +-(G_e(x) -
//! G_f(x)) over all crossings x of a side e of the first and f of the second cell, + where e leaves
//! the second one (W. R. Franklin, "Polygon properties calculated from the vertex neighborhoods",
//! 1987, in the plane). Nothing is sorted along a side, and concave cells, parts and holes are like
//! others.
//!
//! The second cell has moved: see [`super::signs`]. Signs decide which terms there are; each term
//! is computed from the corners as given.

use delone_predicates::Point3;
use delone_predicates::sphere::leveled;

use super::cell::Cell;
use super::pairs::{
    Pair3, Turn, base, chart, chart_of, cross, cross_of, dot, factor, heads, quotient, unit,
};
use super::signs::{Moved, Side, side};

/// Buffers.
#[derive(Default)]
pub struct Work {
    /// Corners of the first cell at sides of the second one, and the other way round.
    at: Vec<i8>,
    of: Vec<i8>,
    first: Near,
    second: Near,
}

/// Sides of a cell near the other one, and which of its corners are in that.
#[derive(Default)]
struct Near {
    sides: Vec<u32>,
    inside: Vec<bool>,
}

/// Whether two arcs cross, from the signs of the second one's ends at the first one, and of the
/// first one's ends at the second one.
///
/// Both circles separate the other arc's ends, so each arc meets one of the two points where the
/// circles meet. At n x m the second arc, with normal m, comes from the right of the first and ends
/// to its left, and the first comes from the left of the second and ends to its right; at -n x m
/// the other way round. So the points are the same if and only if the second sign of one is the
/// first of the other.
#[inline]
fn cross_at(at: [i8; 2], of: [i8; 2]) -> bool {
    at[0] != at[1] && of[0] != of[1] && of[0] == at[1]
}

/// The area that cells share; the second one has moved.
pub fn shared(p: &Cell, q: &Cell, work: &mut Work) -> f64 {
    let Work {
        at,
        of,
        first,
        second,
    } = work;
    near(p, q, first);
    near(q, p, second);
    if first.sides.is_empty() && second.sides.is_empty() {
        // A cell inside the other one has its sides in the box of that.
        return 0.0;
    }
    // Signs: rows are sides, columns both ends of the sides of the other cell.
    if !signs(at, (q, &second.sides), (p, &first.sides), Moved::Side)
        || !signs(of, (p, &first.sides), (q, &second.sides), Moved::Corner)
    {
        return 0.0;
    }
    corners_inside(first, (p, q), at, second.sides.len(), Moved::Side);
    corners_inside(second, (q, p), of, first.sides.len(), Moved::Corner);
    // What both share is within the hemisphere around the smaller one.
    let axis = chart_of(if p.radius < q.radius { p } else { q }.center);
    let (mut turn, mut crossed) = (Turn::new(), false);
    let (count, across) = (first.sides.len(), second.sides.len());
    for (k, &e) in first.sides.iter().enumerate() {
        let (a, b) = ends(p, e);
        let start = base(axis, &a.unit, &b.unit);
        if first.inside[k] {
            turn.mul(factor(&start, &chart(axis, &b.unit)), false);
        }
        for (l, &f) in second.sides.iter().enumerate() {
            // The ends of e at f, and those of f at e.
            let (i, j) = (2 * (l * count + k), 2 * (k * across + l));
            let (ends_e, ends_f) = ([at[i], at[i + 1]], [of[j], of[j + 1]]);
            if !cross_at(ends_f, ends_e) {
                continue;
            }
            crossed = true;
            // To the left of a side is inside.
            let leaves = ends_e[0] > 0;
            let x = chart(axis, &crossing((p, e), (q, f), leaves));
            turn.mul(factor(&start, &x), !leaves);
            let (c, d) = ends(q, f);
            turn.mul(factor(&base(axis, &c.unit, &d.unit), &x), leaves);
        }
    }
    if !crossed {
        // One cell inside the other: its area as it is.
        let all = |near: &Near, cell: &Cell| {
            near.sides.len() == cell.corners.len() && near.inside.iter().all(|&x| x)
        };
        let none = |near: &Near| !near.inside.contains(&true);
        if all(first, p) && none(second) {
            return p.area;
        }
        if all(second, q) && none(first) {
            return q.area;
        }
    }
    for (l, &f) in second.sides.iter().enumerate() {
        if second.inside[l] {
            let (c, d) = ends(q, f);
            turn.mul(
                factor(&base(axis, &c.unit, &d.unit), &chart(axis, &d.unit)),
                false,
            );
        }
    }
    turn.area()
}

fn ends(cell: &Cell, k: u32) -> (&super::cell::Corner, &super::cell::Corner) {
    let a = &cell.corners[k as usize];
    (a, &cell.corners[a.next as usize])
}

/// Cells with fewer corners take all their sides.
const FEW: usize = 12;

/// Sides of a cell whose boxes meet that of the other one.
fn near(cell: &Cell, other: &Cell, found: &mut Near) {
    found.sides.clear();
    let count = cell.corners.len() as u32;
    if cell.corners.len() < FEW {
        found.sides.extend(0..count);
        return;
    }
    let extent = other.extent();
    for k in 0..count {
        let (a, b) = ends(cell, k);
        let (p, q) = (heads(&a.unit), heads(&b.unit));
        // An arc rises above its chord by less than the square of that.
        let bulge = (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>() + 1e-12;
        let meets = (0..3).all(|i| {
            p[i].min(q[i]) - bulge <= extent.max[i] && extent.min[i] <= p[i].max(q[i]) + bulge
        });
        if meets {
            found.sides.push(k);
        }
    }
}

/// The signs of the ends of the other cell's sides at the sides of a cell. False if all are to the
/// right of one side of a convex cell, which then shares nothing.
fn signs(
    into: &mut Vec<i8>,
    (cell, sides): (&Cell, &[u32]),
    (other, others): (&Cell, &[u32]),
    moved: Moved,
) -> bool {
    into.clear();
    let all = others.len() == other.corners.len();
    for &k in sides {
        let own = cell.side(k as usize);
        let from = into.len();
        let mut any = false;
        for (at, &l) in others.iter().enumerate() {
            // Sides in sequence share corners.
            let a = match at.checked_sub(1) {
                Some(before) if other.corners[others[before] as usize].next == l => {
                    into[from + 2 * before + 1]
                }
                _ => side(own, other.corners[l as usize].v, moved) as i8,
            };
            let next = other.corners[l as usize].next;
            let b = if next == others[0] {
                // The end of the last side is the start of the first.
                if at == 0 { a } else { into[from] }
            } else {
                side(own, other.corners[next as usize].v, moved) as i8
            };
            into.extend([a, b]);
            any |= a > 0 || b > 0;
        }
        if !any && all && cell.convex {
            return false;
        }
    }
    true
}

/// Which sides of a cell end in the other one.
fn corners_inside(
    near: &mut Near,
    (cell, other): (&Cell, &Cell),
    at: &[i8],
    rows: usize,
    moved: Moved,
) {
    let count = near.sides.len();
    near.inside.clear();
    for (k, &e) in near.sides.iter().enumerate() {
        let found = if other.convex && rows == other.corners.len() {
            (0..rows).all(|l| at[2 * (l * count + k) + 1] > 0)
        } else {
            inside(other, ends(cell, e).1.v, moved)
        };
        near.inside.push(found);
    }
}

/// Whether a corner of the other cell is in a cell, where `moved` tells which of the two has moved:
/// the parity of sides that cross an arc from the corner to a direction outside, which belongs to
/// the other cell and moves with it.
pub fn inside(cell: &Cell, q: Point3, moved: Moved) -> bool {
    // Opposite to the center; a little beside it if that is opposite to the corner, or the corner
    // itself.
    let c = cell.center;
    let turned = [c[1], c[2], c[0]];
    let far = [0.0, 1e-7, -1e-7]
        .into_iter()
        .map(|shift| leveled([0, 1, 2].map(|k| -c[k] + shift * turned[k])))
        .find(|&r| heads(&cross_of(q, r)) != [0.0; 3]);
    let Some(r) = far else { return false };
    let n = cross_of(q, r);
    let arc = Side { a: q, b: r, n: &n };
    let other = match moved {
        Moved::Corner => Moved::Side,
        _ => Moved::Corner,
    };
    let mut odd = false;
    for k in 0..cell.corners.len() {
        let own = cell.side(k);
        let of = [q, r].map(|v| side(own, v, moved) as i8);
        if of[0] == of[1] {
            continue;
        }
        let at = [own.a, own.b].map(|v| side(arc, v, other) as i8);
        odd ^= cross_at(at, of);
    }
    odd
}

/// Where a side of the first cell crosses one of the second, as a unit vector.
///
/// On nearly equal circles the error of n x m points in any direction. Taking away what is off the
/// first circle leaves an error along both, which does no harm. On circles that are equal but for
/// roundings, any point of both arcs serves: an end of one that is on the other.
fn crossing((p, e): (&Cell, u32), (q, f): (&Cell, u32), leaves: bool) -> Pair3 {
    let ((a, b), (c, d)) = (ends(p, e), ends(q, f));
    let (n, m) = (&a.n, &c.n);
    // The first side leaves to the right of the second one: it is m x n there.
    let x = if leaves { cross(n, m) } else { cross(m, n) };
    let size = x.iter().fold(0.0, |top: f64, v| top.max(v.hi.abs()));
    let length = |v: &Pair3| v.iter().map(|x| x.hi.abs()).sum::<f64>();
    let scale = length(n) * length(m);
    if size > 1e-5 * scale {
        return unit(&x);
    }
    if size > 1e-26 * scale {
        let x = unit(&x);
        let k = quotient(dot(n, &x), dot(n, n));
        return unit(&[0, 1, 2].map(|j| x[j] - n[j] * k));
    }
    // How far an end is from the middle of the other side, over half the length of that: at most 1
    // on it.
    let between = |u: &Pair3, x: &Pair3, y: &Pair3, normal: &Pair3| {
        let [u, x, y, n] = [u, x, y, normal].map(heads);
        let middle = if x[0] * y[0] + x[1] * y[1] + x[2] * y[2] < 0.0 {
            // The sum of the ends cancels.
            let d = [0, 1, 2].map(|k| x[k] - y[k]);
            [(1, 2), (2, 0), (0, 1)].map(|(i, j)| n[i] * d[j] - n[j] * d[i])
        } else {
            [0, 1, 2].map(|k| x[k] + y[k])
        };
        let length = middle.iter().map(|x| x * x).sum::<f64>().sqrt();
        let distance = |v: Point3| {
            (0..3)
                .map(|k| (v[k] - middle[k] / length).powi(2))
                .sum::<f64>()
        };
        distance(u) / distance(x).max(distance(y))
    };
    let ends = [
        (between(&a.unit, &c.unit, &d.unit, m), a.unit),
        (between(&b.unit, &c.unit, &d.unit, m), b.unit),
        (between(&c.unit, &a.unit, &b.unit, n), c.unit),
        (between(&d.unit, &a.unit, &b.unit, n), d.unit),
    ];
    let mut best = ends[0];
    for end in &ends[1..] {
        if end.0 < best.0 {
            best = *end;
        }
    }
    best.1
}
