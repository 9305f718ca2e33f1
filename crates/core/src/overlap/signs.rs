//! Signs that decide the relative positions of corners and sides of two grids, exactly and without
//! ties.
//!
//! # Ties
//!
//! No sign is zero: they are those of grids of which one has moved by a linear map I + h E. Linear
//! maps take great circles to great circles, so a polygon that has moved is one with the same
//! properties. Between two grids of polygons the target moves, and between polygons and cells of
//! meridians and parallels the polygons do.
//!
//! Let a sign be that of f, a polynomial in the corners that move, and let f vanish for the corners
//! as given. To first order in h it is the sum of e_ij C_ij over the nine entries of E. Below, for
//! each f, some C_ij is not zero. Let each entry of E be positive and much smaller than the one
//! before, in the order e_11, e_12, ..., e_33. As only finitely many signs are asked for, there are
//! such entries for which each sum has the sign of its first C_ij that is not zero, and then an h >
//! 0 below which all signs that are asked for are those of the moved grids. So all answers are true
//! of one pair of grids, without ties, as close to the given one as wanted, and whatever is derived
//! from them is consistent. Areas are continuous: they are computed from the corners as given.
//!
//! Write `first(v)` for the sign of the first entry of v that is not zero. For a sum of e_ij n_i
//! q_j the answer is first(n) first(q).
//!
//! | f | moves | C_ij | zero only if |
//! |---|---|---|---|
//! | n q, side of a source's circle | q | n_i q_j | never |
//! | n q, side of a target's circle | n | -n_i q_j | never |
//! | c y - s x, meridian (c, s) | v | (-s, c, 0)_i v_j | never |
//! | z - t r, parallel of tangent t | v | (-t x, -t y, r)_i v_j / r | never: r = 0 is not a tie |
//! | n k, corner k = (c, s, t rho) | n | -n_i k_j | never |
//! | n_z | n | -n_i for j = 3 | never: then n is not zero |
//! | b_z a^2 - a_z (a b), rise at a | a, b | see [`rise`] | see there |
//! | c n_y - s n_x | n | n_i (s, -c, 0)_j | never |
//! | n_x^2 + n_y^2 - t^2 n_z^2, t > 0 | n | -2 n_i (n_x, n_y, -t^2 n_z)_j | never |
//!
//! (As n = a x b changes by h (tr(E) n - E^T n), and f is linear in n or quadratic and zero, the
//! trace has no effect.)
//!
//! # Filters
//!
//! Let u = 2^-53. Corners are leveled: their largest coordinate is from 1 to 2. Then a normal n = a
//! x b is known as a pair to d = 2^-101 per coordinate, which are below 8, and its head errs by u
//! of itself and d. Directions (c, s) of meridians are leveled, too, and `len` is rho = sqrt(c^2 +
//! s^2) to 2 u. The bounds:
//!
//! - n q: products err by 2 u, two sums by u each, 4 u of the sum P of the sizes of the terms, and
//!   d meets q: 6 d. 6 u P and 2^-96 have room for the roundings of P.
//! - z - t r: r errs by 2 u, t r by 3 u, the difference by u: 4 u (|z| + |t r|). If x and y
//!   underflow, r errs by 2^-537; 2^-500 |t| has room.
//! - c y - s x: 2 u; 4 u are taken, and the least normal double for underflow.
//! - n k: the terms n_x c and n_y s err by 2 u, n_z (t rho) by 5 u, two sums by u each: 7 u P, of
//!   which 10 u are taken; d meets |c| + |s| + |t| rho, below 4 + 3 |t|: 2^-96 (1 + |t|) has room.
//! - rise n_x y - n_y x, and c n_y - s n_x: 3 u and 4 d; 6 u and 2^-96 are taken.
//! - reach: n_x^2 + n_y^2 errs by 4 u of itself and 32 d, t^2 n_z^2 by 5 u and 16 d t^2, the
//!   difference by u: 12 u of both and 2^-94 (1 + t^2) are taken.
//!
//! The second stage takes pairs, whose operations err by at most 9 u^2 of their result and roots by
//! 2^-101: no sign takes more than ten of them, 2^-98, and d is below that, too. 2^-92 of the sum
//! of sizes is taken. NaN and infinity fail all comparisons and go to integers.

use delone_predicates::arithmetic::Pair;
use delone_predicates::sphere::orient_exact;
use delone_predicates::{Point2, Point3, Sign, orient2d};

use super::exact::{Big, across, big3, product, with_root};
use super::pairs::{Pair3, pair, root};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// 2^-96.
const LOW: f64 = 1.0 / (1_u128 << 96) as f64;
/// 2^-92.
const PAIRS: f64 = 16.0 * LOW;
/// 2^-500.
const DEEP: f64 = f64::from_bits((1023 - 500) << 52);

/// -1, 0 or 1.
#[inline]
pub fn number(sign: Sign) -> i32 {
    sign as i32
}

/// The sign of a double.
#[inline]
fn of(x: f64) -> i32 {
    i32::from(x > 0.0) - i32::from(x < 0.0)
}

/// The sign of the first entry that is not zero.
fn first(entries: &[f64]) -> i32 {
    entries
        .iter()
        .map(|&x| of(x))
        .find(|&x| x != 0)
        .unwrap_or(0)
}

/// A side of a polygon: an arc from `a` to `b`, and its normal a x b.
#[derive(Clone, Copy)]
pub struct Side<'a> {
    /// The start.
    pub a: Point3,
    /// The end.
    pub b: Point3,
    /// The normal.
    pub n: &'a Pair3,
}

impl Side<'_> {
    /// The exact signs of the coordinates of the normal.
    fn signs(&self) -> [f64; 3] {
        let sign = |i: usize, j: usize| {
            let turn = orient2d([self.a[i], self.a[j]], [self.b[i], self.b[j]], [0.0; 2]);
            f64::from(number(turn))
        };
        [sign(1, 2), sign(2, 0), sign(0, 1)]
    }

    /// The sign of the first coordinate of the normal that is not zero.
    fn first(&self) -> i32 {
        let x = self.n[0].hi;
        if x.abs() > LOW {
            return of(x);
        }
        first(&self.signs())
    }

    fn exact_normal(&self) -> super::exact::Big3 {
        across(&big3(self.a), &big3(self.b))
    }
}

/// Which polygon of a pair has moved.
#[derive(Clone, Copy, PartialEq)]
pub enum Moved {
    /// That of the corner.
    Corner,
    /// That of the side.
    Side,
    /// Neither: zero on the circle.
    Neither,
}

/// The side of a circle on which a corner is: 1 to the left, -1 to the right.
#[inline]
pub fn side(e: Side, q: Point3, moved: Moved) -> i32 {
    let n = e.n;
    let (x, y, z) = (n[0].hi * q[0], n[1].hi * q[1], n[2].hi * q[2]);
    let det = x + y + z;
    if det.abs() > 6.0 * U * (x.abs() + y.abs() + z.abs()) + LOW {
        return of(det);
    }
    side_exact(e, q, moved)
}

/// The corners that are to the left of a circle, as bits: all filters together, so that they can be
/// computed side by side.
#[inline]
pub fn left(e: Side, corners: impl Iterator<Item = Point3> + Clone, moved: Moved) -> u32 {
    let n = e.n;
    let (mut bits, mut sure) = (0, true);
    for (l, q) in corners.clone().enumerate() {
        let (x, y, z) = (n[0].hi * q[0], n[1].hi * q[1], n[2].hi * q[2]);
        let det = x + y + z;
        sure &= det.abs() > 6.0 * U * (x.abs() + y.abs() + z.abs()) + LOW;
        bits |= u32::from(det > 0.0) << l;
    }
    if sure {
        return bits;
    }
    corners.enumerate().fold(0, |bits, (l, q)| {
        bits | u32::from(side(e, q, moved) > 0) << l
    })
}

#[cold]
#[inline(never)]
fn side_exact(e: Side, q: Point3, moved: Moved) -> i32 {
    // A common corner, the most frequent tie, needs no integers.
    if q != e.a && q != e.b {
        let found = number(orient_exact([e.a, e.b, q]));
        if found != 0 {
            return found;
        }
    }
    match moved {
        Moved::Corner => e.first() * first(&q),
        Moved::Side => -e.first() * first(&q),
        Moved::Neither => 0,
    }
}

/// Whether a moved corner is above the parallel of a tangent.
#[inline]
pub fn above(t: f64, v: Point3) -> bool {
    if t.is_infinite() {
        return t < 0.0;
    }
    let w = t * (v[0] * v[0] + v[1] * v[1]).sqrt();
    let det = v[2] - w;
    if det.abs() > 8.0 * U * (v[2].abs() + w.abs()) + DEEP * t.abs() {
        return det > 0.0;
    }
    above_exact(t, v)
}

#[cold]
#[inline(never)]
fn above_exact(t: f64, v: Point3) -> bool {
    if v[0].abs().max(v[1].abs()) > 1e-100 && t.abs() < 1e100 {
        let radius = root(Pair::product(v[0], v[0]) + Pair::product(v[1], v[1]));
        let w = pair(t) * radius;
        let det = (pair(v[2]) - w).hi;
        if det.abs() > PAIRS * (v[2].abs() + w.hi.abs()) {
            return det > 0.0;
        }
    }
    let [x, y, z] = big3(v);
    let found = with_root(&z, &Big::of(-t), &x.square().plus(&y.square()));
    if found != 0 {
        return found > 0;
    }
    first(&[-of(t) as f64 * v[0], -of(t) as f64 * v[1], 1.0]) * first(&v) > 0
}

/// Whether a moved corner is to the left of the plane of a meridian.
#[inline]
pub fn east(m: Point2, v: Point3) -> bool {
    let (p, q) = (m[0] * v[1], m[1] * v[0]);
    if (p - q).abs() > 4.0 * U * (p.abs() + q.abs()) + f64::MIN_POSITIVE {
        return p > q;
    }
    let found = number(orient2d(m, [v[0], v[1]], [0.0; 2]));
    if found != 0 {
        return found > 0;
    }
    first(&[-m[1], m[0]]) * first(&v) > 0
}

/// The side of the circle of a moved side on which the corner of a meridian and a parallel is;
/// `len` is the length of
/// `m`, rounded. The tangent is finite.
#[inline]
pub fn corner(m: Point2, len: f64, t: f64, e: Side) -> i32 {
    let n = e.n;
    let (x, y, z) = (n[0].hi * m[0], n[1].hi * m[1], n[2].hi * (t * len));
    let det = x + y + z;
    let bound = 10.0 * U * (x.abs() + y.abs() + z.abs()) + LOW * (1.0 + t.abs());
    if det.abs() > bound {
        return of(det);
    }
    corner_exact(m, t, e)
}

#[cold]
#[inline(never)]
fn corner_exact([c, s]: Point2, t: f64, e: Side) -> i32 {
    let n = e.n;
    if t.abs() < 1e100 {
        let len = root(Pair::product(c, c) + Pair::product(s, s));
        let (x, y, z) = (n[0] * pair(c), n[1] * pair(s), n[2] * (pair(t) * len));
        let det = (x + y + z).hi;
        let sizes = x.hi.abs() + y.hi.abs() + z.hi.abs();
        if det.abs() > PAIRS * (sizes + 1.0 + t.abs()) {
            return of(det);
        }
    }
    let n = e.exact_normal();
    let (x, y) = (Big::of(c), Big::of(s));
    let found = with_root(
        &n[0].times(&x).plus(&n[1].times(&y)),
        &n[2].times(&Big::of(t)),
        &x.square().plus(&y.square()),
    );
    if found != 0 {
        return found;
    }
    -e.first() * first(&[c, s, t])
}

/// Whether a moved side runs east.
#[inline]
pub fn eastward(e: Side) -> bool {
    let z = e.n[2].hi;
    if z.abs() > LOW {
        return z > 0.0;
    }
    let n = e.signs();
    let found = of(n[2]);
    if found != 0 { found > 0 } else { first(&n) < 0 }
}

/// The sign with which the latitude grows at the start of a moved side, toward its end; at its end
/// if `ends`.
///
/// At a it is that of f = (n x a)_z = b_z a^2 - a_z (a b), and at b that of minus the same with a
/// and b exchanged. If f is 0, the entries are C = e_3 (b a^2 - a (a b))^T + 2 b_z a a^T - a_z (b
/// a^T + a b^T). They are not all zero: C a = 2 b_z a^2 a - a_z (a^2 b + (a b) a) has the part -a_z
/// a^2 along b, so that a_z = 0, then b_z = 0 as f is 0, and C is e_3 times a vector that is not
/// zero.
#[inline]
pub fn rise(e: Side, ends: bool) -> i32 {
    let (v, n) = (if ends { e.b } else { e.a }, e.n);
    let (p, q) = (n[0].hi * v[1], n[1].hi * v[0]);
    if (p - q).abs() > 6.0 * U * (p.abs() + q.abs()) + LOW {
        return of(p - q);
    }
    if ends {
        -rise_exact(e.b, e.a)
    } else {
        rise_exact(e.a, e.b)
    }
}

#[cold]
#[inline(never)]
fn rise_exact(a: Point3, b: Point3) -> i32 {
    let (a, b) = (big3(a), big3(b));
    let (square, mixed) = (product(&a, &a), product(&a, &b));
    let difference = |k: usize| b[k].times(&square).minus(&a[k].times(&mixed));
    let found = difference(2).sign();
    if found != 0 {
        return found;
    }
    for i in 0..3 {
        for j in 0..3 {
            let twice = a[i].times(&a[j]).times(&b[2]);
            let both = b[i].times(&a[j]).plus(&a[i].times(&b[j]));
            let mut entry = twice.plus(&twice).minus(&both.times(&a[2]));
            if i == 2 {
                entry = entry.plus(&difference(j));
            }
            if entry.sign() != 0 {
                return entry.sign();
            }
        }
    }
    0
}

/// The sign of c n_y - s n_x for a moved side: minus that with which the latitude grows on its
/// circle to the east of n_z > 0, or to the west of n_z < 0, at a meridian.
#[inline]
pub fn falling(m: Point2, e: Side) -> i32 {
    let (p, q) = (m[0] * e.n[1].hi, m[1] * e.n[0].hi);
    if (p - q).abs() > 6.0 * U * (p.abs() + q.abs()) + LOW {
        return of(p - q);
    }
    falling_exact(m, e)
}

#[cold]
#[inline(never)]
fn falling_exact(m: Point2, e: Side) -> i32 {
    let n = e.exact_normal();
    let found = Big::of(m[0])
        .times(&n[1])
        .minus(&Big::of(m[1]).times(&n[0]));
    if found.sign() != 0 {
        return found.sign();
    }
    e.first() * first(&[m[1], -m[0]])
}

/// Whether the circle of a moved side passes beyond the parallels of tangents t and -t, where t > 0
/// is finite.
#[inline]
pub fn reaches(t: f64, e: Side) -> bool {
    let h = [e.n[0].hi, e.n[1].hi, e.n[2].hi];
    let (m, w) = (h[0] * h[0] + h[1] * h[1], t * t * h[2] * h[2]);
    if (m - w).abs() > 12.0 * U * (m + w) + 4.0 * LOW * (1.0 + t * t) {
        return m > w;
    }
    reaches_exact(t, e)
}

#[cold]
#[inline(never)]
fn reaches_exact(t: f64, e: Side) -> bool {
    let n = e.exact_normal();
    let w = n[2].times(&Big::of(t)).square();
    let found = n[0].square().plus(&n[1].square()).minus(&w).sign();
    if found != 0 {
        return found > 0;
    }
    let n = e.signs();
    -first(&n) * first(&[n[0], n[1], -n[2]]) > 0
}

#[cfg(test)]
mod tests {
    //! All stages against integers alone, on input within a few units in the last place of a tie.

    use super::super::pairs::cross_of;
    use super::*;
    use delone_predicates::sphere::leveled;

    /// Numbers from -1 to 1, and small integers.
    struct Numbers(u64);

    impl Numbers {
        fn bits(&mut self) -> u64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            self.0
        }

        fn next(&mut self) -> f64 {
            (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }

        fn vector(&mut self) -> Point3 {
            let v = if self.bits().is_multiple_of(3) {
                [0, 1, 2].map(|_| (self.bits() % 5) as f64 - 2.0)
            } else {
                [0, 1, 2].map(|_| self.next())
            };
            if v == [0.0; 3] {
                [1.0, 0.0, 0.0]
            } else {
                leveled(v)
            }
        }

        /// A few units in the last place away.
        fn near(&mut self, x: f64) -> f64 {
            x * (1.0 + ((self.bits() % 5) as f64 - 2.0) * f64::EPSILON)
        }
    }

    /// Calls `test` with sides and other numbers; the sign of the integers is `exact`, if not zero.
    fn each(test: impl Fn(Side, &mut Numbers) -> (i32, i32)) {
        let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
        let mut ties = 0;
        for _ in 0..4000 {
            let (a, b) = (numbers.vector(), numbers.vector());
            let n = cross_of(a, b);
            if n.iter().all(|x| x.hi == 0.0) {
                continue;
            }
            let (found, exact) = test(Side { a, b, n: &n }, &mut numbers);
            assert!(found != 0);
            if exact == 0 {
                ties += 1;
            } else {
                assert_eq!(found, exact);
            }
        }
        assert!(ties > 0);
    }

    fn sign(x: bool) -> i32 {
        if x { 1 } else { -1 }
    }

    #[test]
    fn corners_at_circles() {
        each(|e, numbers| {
            let (s, t) = (numbers.next(), (numbers.bits() % 3) as f64);
            let q = leveled([0, 1, 2].map(|k| numbers.near(s * e.a[k] + t * e.b[k])));
            let q = if q.iter().all(|x| x.is_finite() && *x != 0.0) {
                q
            } else {
                e.a
            };
            let exact = product(&e.exact_normal(), &big3(q)).sign();
            assert_eq!(
                side(e, q, Moved::Corner),
                if exact == 0 {
                    -side(e, q, Moved::Side)
                } else {
                    exact
                }
            );
            assert_eq!(side(e, q, Moved::Neither), exact);
            (side(e, q, Moved::Side), exact)
        });
    }

    #[test]
    fn corners_at_meridians_and_parallels() {
        each(|e, numbers| {
            let t = numbers.near(e.a[2] / (e.a[0] * e.a[0] + e.a[1] * e.a[1]).sqrt());
            let [x, y, z] = big3(e.a);
            let square = x.square().plus(&y.square());
            if !t.is_finite() {
                return (1, 0);
            }
            (sign(above(t, e.a)), with_root(&z, &Big::of(-t), &square))
        });
        each(|e, numbers| {
            let m = [numbers.near(e.a[0]), numbers.near(e.a[1])];
            let m = if m == [0.0; 2] { [1.0, 0.0] } else { m };
            let [x, y, _] = big3(e.a);
            let exact = Big::of(m[0]).times(&y).minus(&Big::of(m[1]).times(&x));
            (sign(east(m, e.a)), exact.sign())
        });
    }

    #[test]
    fn circles_at_corners_of_meridians_and_parallels() {
        each(|e, numbers| {
            // The meridian of an end, at which the circle has the latitude of that end.
            let v = if numbers.bits().is_multiple_of(2) {
                e.a
            } else {
                e.b
            };
            let m = if v[0] == 0.0 && v[1] == 0.0 {
                [1.0, 0.0]
            } else {
                [v[0], v[1]]
            };
            let len = (m[0] * m[0] + m[1] * m[1]).sqrt();
            let t = numbers.near(v[2] / len);
            let n = e.exact_normal();
            let [x, y] = m.map(Big::of);
            let exact = with_root(
                &n[0].times(&x).plus(&n[1].times(&y)),
                &n[2].times(&Big::of(t)),
                &x.square().plus(&y.square()),
            );
            (corner(m, len, t, e), exact)
        });
    }

    #[test]
    fn extrema_of_circles() {
        each(|e, numbers| {
            let m = [numbers.near(e.n[0].hi), numbers.near(e.n[1].hi)];
            let m = if m == [0.0; 2] { [1.0, 0.0] } else { m };
            let m = leveled([m[0], m[1], 0.0]);
            let m = [m[0], m[1]];
            let n = e.exact_normal();
            let exact = Big::of(m[0])
                .times(&n[1])
                .minus(&Big::of(m[1]).times(&n[0]));
            (falling(m, e), exact.sign())
        });
        each(|e, numbers| {
            let (h, n) = (e.n.map(|x| x.hi), e.exact_normal());
            let t = numbers.near((h[0] * h[0] + h[1] * h[1]).sqrt() / h[2].abs());
            if !(t > 0.0 && t.is_finite()) {
                return (1, 0);
            }
            let square = n[2].times(&Big::of(t)).square();
            let exact = n[0].square().plus(&n[1].square()).minus(&square);
            (sign(reaches(t, e)), exact.sign())
        });
        each(|e, _| {
            let (a, b) = (big3(e.a), big3(e.b));
            let exact = b[2]
                .times(&product(&a, &a))
                .minus(&a[2].times(&product(&a, &b)));
            (rise(e, false), exact.sign())
        });
        each(|e, _| (sign(eastward(e)), e.exact_normal()[2].sign()));
    }
}
