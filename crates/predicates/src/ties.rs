//! Ties, broken by the coordinates of the points only.
//!
//! # The perturbation
//!
//! Lift each point p to the height h(p) = |p|^2 - eps(p), where eps(p) depends on the coordinates
//! only: eps of the lexicographically smallest of all points is infinitely larger than eps of the
//! next, and so on, all infinitely small. The Delaunay triangulation is the lower hull of the lifted
//! points; an infinitesimal perturbation of the heights makes it unique, whatever the input, and
//! keeps it a Delaunay triangulation.
//!
//! # The sign
//!
//! In the plane, `incircle(a, b, c, d)` is the determinant of the rows (x, y, h, 1) of a, b, c, d.
//! In h(d) it is linear with the cofactor -orient2d(a, b, c): a higher d is further out. It changes
//! sign with each exchange of two points, so in the order p0 < p1 < p2 < p3 the cofactor of h(pk) is
//! (-1)^(3-k) times -orient2d of the other three in their order, and -eps(pk) adds
//! (-1)^(3-k) orient2d(others) eps(pk). The unperturbed determinant is zero on a tie; then the first
//! k whose term is not zero decides, as all later ones are infinitely smaller.
//!
//! If four distinct points tie and are not all on one line, no three of them are: three distinct
//! points of a line have lifts that span the vertical plane above it, and a fourth point off that
//! line is off that plane, which is not a tie. So k = 0 decides, and the sign is
//! -orient2d(p1, p2, p3).
//!
//! In space, likewise, the cofactor of h(e) is -orient3d(a, b, c, d), and with p0 < ... < p4 the term
//! of pk is (-1)^(4-k) orient3d(others) eps(pk). Five distinct points that tie lie in one plane, where
//! all terms are zero, or on one sphere, where no three lie on one line. In the latter case, if the
//! terms of p0 and p1 are zero, both points lie in the plane of p2, p3, p4, and again all five do.
//! So p0 decides, and p1 if p1, ..., p4 lie in one plane (their circle), or no one.
//!
//! Two equal points have equal eps: their rows are equal and the determinant is zero, perturbed or
//! not. The sign returned for points in any order is that for the sorted points, times the parity of
//! the permutation: consistent by construction.

use std::cmp::Ordering;

use crate::sign::Sign;
use crate::{Point2, Point3, incircle, insphere, orient2d, orient3d};

/// Compares by x, then y (then z). `-0.0` equals `0.0`; NaN equals everything.
///
/// ```
/// use delone_predicates::lexicographic;
/// assert!(lexicographic([0.0, 1.0], [-0.0, 2.0]).is_lt());
/// ```
#[inline]
#[must_use]
pub fn lexicographic<const D: usize>(a: [f64; D], b: [f64; D]) -> Ordering {
    for k in 0..D {
        if a[k] < b[k] {
            return Ordering::Less;
        }
        if a[k] > b[k] {
            return Ordering::Greater;
        }
    }
    Ordering::Equal
}

/// Whether the edge `uv` between the cocircular apexes `p` and `q` must be flipped: the smallest of
/// the four points is `p` or `q`.
///
/// For four distinct points on a circle this agrees with [`incircle_canonical`]: `q` is in
/// conflict with the triangle `u`, `v`, `p`.
///
/// ```
/// use delone_predicates::tie_flips;
/// let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// assert!(tie_flips(b, d, a, c));
/// assert!(!tie_flips(a, c, b, d));
/// ```
#[inline]
#[must_use]
pub fn tie_flips(u: Point2, v: Point2, p: Point2, q: Point2) -> bool {
    before(smaller(p, q), smaller(u, v))
}

#[inline]
fn smaller(a: Point2, b: Point2) -> Point2 {
    if before(b, a) { b } else { a }
}

/// Lexicographic order without a branch, which would be unpredictable on a grid.
#[inline]
fn before(a: Point2, b: Point2) -> bool {
    (a[0] < b[0]) | ((a[0] == b[0]) & (a[1] < b[1]))
}

/// Like [`incircle()`], with ties broken by a symbolic perturbation in lexicographic order.
///
/// [`Sign::Zero`] only if two points are equal or all four are collinear. Swapping two points
/// negates the sign.
///
/// ```
/// use delone_predicates::{Sign, incircle_canonical};
/// let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// // The square is split along the diagonal from its smallest vertex, a.
/// assert_eq!(incircle_canonical(a, b, c, d), Sign::Negative); assert_eq!(incircle_canonical(b, c,
/// d, a), Sign::Positive);
/// ```
#[inline]
#[must_use]
pub fn incircle_canonical(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    match incircle(a, b, c, d) {
        Sign::Zero => incircle_tie([a, b, c, d]),
        sign => sign,
    }
}

#[cold]
#[inline(never)]
fn incircle_tie(points: [Point2; 4]) -> Sign {
    // Only the smallest counts. Moving it from place i to the front takes i swaps of adjacent
    // points, which leave the others in their order.
    let mut smallest = 0;
    for i in 1..4 {
        match lexicographic(points[i], points[smallest]) {
            Ordering::Less => smallest = i,
            Ordering::Equal => return Sign::Zero,
            Ordering::Greater => {}
        }
    }
    let [a, b, c, d] = points;
    let [p, q, r] = [[b, c, d], [a, c, d], [a, b, d], [a, b, c]][smallest];
    (-orient2d(p, q, r)).flip_if(smallest % 2 == 1)
}

/// Like [`insphere()`], with ties broken by a symbolic perturbation in lexicographic order.
///
/// [`Sign::Zero`] only if two points are equal or all five are coplanar. Swapping two points
/// negates the sign.
#[inline]
#[must_use]
pub fn insphere_canonical(a: Point3, b: Point3, c: Point3, d: Point3, e: Point3) -> Sign {
    match insphere(a, b, c, d, e) {
        Sign::Zero => insphere_tie([a, b, c, d, e]),
        sign => sign,
    }
}

/// The smallest point decides, if the others are affinely independent: moving it from place i to
/// the front takes i swaps of adjacent points, which leave the others in their order.
#[cold]
#[inline(never)]
fn insphere_tie(points: [Point3; 5]) -> Sign {
    let (mut smallest, mut twice) = (0, false);
    for (i, p) in points.iter().enumerate().skip(1) {
        // On lattices nothing here is predictable, so there is no branch.
        let q = points[smallest];
        let equal = (p[0] == q[0]) & (p[1] == q[1]) & (p[2] == q[2]);
        let last = (p[1] < q[1]) | ((p[1] == q[1]) & (p[2] < q[2]));
        let less = (p[0] < q[0]) | ((p[0] == q[0]) & last);
        smallest = if less { i } else { smallest };
        twice = !less & (twice | equal);
    }
    if twice {
        return Sign::Zero;
    }
    let [a, b, c, d, e] = points;
    let others = [
        [b, c, d, e],
        [a, c, d, e],
        [a, b, d, e],
        [a, b, c, e],
        [a, b, c, d],
    ];
    let [p, q, r, s] = others[smallest];
    match orient3d(p, q, r, s) {
        Sign::Zero => insphere_tie_sorted(points),
        sign => sign.flip_if(smallest % 2 == 1),
    }
}

/// The same by all points in order.
#[cold]
#[inline(never)]
fn insphere_tie_sorted(mut points: [Point3; 5]) -> Sign {
    let Some(odd) = sort(&mut points) else {
        return Sign::Zero;
    };
    let [o, p, q, r, s] = points;
    let sign = match orient3d(p, q, r, s) {
        Sign::Zero => -orient3d(o, q, r, s),
        sign => sign,
    };
    sign.flip_if(odd)
}

/// Sorts the points and returns whether that took an odd number of swaps; `None` if two are equal.
fn sort<const D: usize, const N: usize>(points: &mut [[f64; D]; N]) -> Option<bool> {
    let mut odd = false;
    for i in 1..N {
        for j in (1..=i).rev() {
            match lexicographic(points[j - 1], points[j]) {
                Ordering::Less => break,
                Ordering::Equal => return None,
                Ordering::Greater => points.swap(j - 1, j),
            }
            odd = !odd;
        }
    }
    Some(odd)
}
