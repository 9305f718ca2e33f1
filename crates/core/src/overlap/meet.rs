//! The area that two cells with arcs of great circles share.

use delone_predicates::Point3;
use delone_predicates::sphere::leveled;

use super::cell::{Cell, Corner};
use super::outline::{Met, Outline, Sum, Work, cross_at, meet};
use super::pairs::{
    Pair3, Turn, base, chart, chart_of, cross, cross_of, dot, factor, heads, quotient, raised, unit,
};
use super::signs::{Moved, Side, side};

impl Outline for Cell {
    fn count(&self) -> usize {
        self.corners.len()
    }

    #[inline]
    fn next(&self, k: u32) -> u32 {
        self.corners[k as usize].next
    }

    fn convex(&self) -> bool {
        self.convex
    }

    #[inline]
    fn sign(&self, k: u32, other: &Self, corner: u32, moved: Moved) -> i8 {
        let v = other.corners[corner as usize].v;
        side(self.side(k as usize), v, moved) as i8
    }

    fn holds(&self, other: &Self, corner: u32, moved: Moved) -> bool {
        inside(self, other.corners[corner as usize].v, moved)
    }

    fn near(&self, other: &Self, found: &mut Vec<u32>) {
        let extent = other.extent();
        for k in 0..self.corners.len() as u32 {
            let (a, b) = ends(self, k);
            let (p, q) = (heads(&a.unit), heads(&b.unit));
            // An arc rises above its chord by less than the square of that.
            let bulge = (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>() + 1e-12;
            let meets = (0..3).all(|i| {
                p[i].min(q[i]) - bulge <= extent.max[i] && extent.min[i] <= p[i].max(q[i]) + bulge
            });
            if meets {
                found.push(k);
            }
        }
    }
}

/// The sum as one product.
struct Product<'a> {
    p: &'a Cell,
    q: &'a Cell,
    axis: usize,
    turn: Turn,
    /// The side of the first cell, and where it is measured from.
    e: u32,
    from: Pair3,
}

impl Sum for Product<'_> {
    fn side(&mut self, e: u32) {
        let (a, b) = ends(self.p, e);
        (self.e, self.from) = (e, base(self.axis, &a.unit, &b.unit));
    }

    fn first(&mut self) {
        let end = chart(self.axis, &ends(self.p, self.e).1.unit);
        self.turn.mul(factor(&self.from, &end), false);
    }

    fn crossing(&mut self, f: u32, leaves: bool) {
        let x = chart(self.axis, &crossing((self.p, self.e), (self.q, f), leaves));
        self.turn.mul(factor(&self.from, &x), !leaves);
        let (c, d) = ends(self.q, f);
        let from = base(self.axis, &c.unit, &d.unit);
        self.turn.mul(factor(&from, &x), leaves);
    }

    fn second(&mut self, f: u32) {
        let (c, d) = ends(self.q, f);
        let from = base(self.axis, &c.unit, &d.unit);
        self.turn
            .mul(factor(&from, &chart(self.axis, &d.unit)), false);
    }
}

/// The area that cells share; the second one has moved.
pub fn shared(p: &Cell, q: &Cell, work: &mut Work) -> f64 {
    // What both share is within the hemisphere around the smaller one.
    let axis = chart_of(if p.radius < q.radius { p } else { q }.center);
    let mut sum = Product {
        p,
        q,
        axis,
        turn: Turn::new(),
        e: 0,
        from: p.corners[0].unit,
    };
    match meet(p, q, work, &mut sum) {
        Met::Nothing => 0.0,
        Met::First => p.area,
        Met::Second => q.area,
        Met::Part => sum.turn.area(),
    }
}

fn ends(cell: &Cell, k: u32) -> (&Corner, &Corner) {
    let a = &cell.corners[k as usize];
    (a, &cell.corners[a.next as usize])
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
/// On nearly equal circles the error of n x m points in any direction. Removing the component off
/// the first circle leaves an error along both, which is harmless. On circles that are equal but
/// for roundings, any point of both arcs serves: an end of one that is on the other.
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
        let n = &raised(n);
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
