//! An order of directions by products of coordinates, without roots.
//!
//! Classes come first: x < 0; x = 0 and y < 0; x = y = 0 and z < 0; then the opposites of these, the
//! last first. In a class, let |p| be the coordinate that defines it, which has one sign there; the
//! remaining coordinates divided by |p| are compared one after the other. They are the coordinates
//! of the ray's intersection with a plane, so that two vectors are equal in this order if and only
//! if they have the same direction. It is a total order: one of numbers on each of six planes, lines or
//! points.

use std::cmp::Ordering;

use crate::sign::Sign;
use crate::{Point3, orient2d};

/// The class of a direction, and the coordinate that defines it.
fn class(v: Point3) -> (u8, usize) {
    match v.iter().position(|&x| x != 0.0) {
        Some(k) if v[k] < 0.0 => (k as u8, k),
        Some(k) => (5 - k as u8, k),
        None => (2, 2),
    }
}

/// Compares two directions; equal if and only if they are the same, whatever the lengths.
///
/// ```
/// use delone_predicates::sphere::compare;
/// assert!(compare([1.0, 2.0, 3.0], [1e300, 2e300, 3e300]).is_eq());
/// assert!(compare([-1.0, 0.0, 0.0], [-1.0, 1e-300, 0.0]).is_lt());
/// ```
#[must_use]
pub fn compare(a: Point3, b: Point3) -> Ordering {
    let ((first, p), (second, _)) = (class(a), class(b));
    if first != second {
        return first.cmp(&second);
    }
    for k in p + 1..3 {
        // The product a_k |b_p| - b_k |a_p|, exactly.
        let turn = orient2d([a[k], a[p].abs()], [b[k], b[p].abs()], [0.0; 2]);
        match turn {
            Sign::Positive => return Ordering::Greater,
            Sign::Negative => return Ordering::Less,
            Sign::Zero => {}
        }
    }
    Ordering::Equal
}

/// Whether two vectors have the same direction.
#[must_use]
pub fn same(a: Point3, b: Point3) -> bool {
    compare(a, b).is_eq()
}
