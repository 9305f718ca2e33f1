//! Cross products of differences, with a relative accuracy that survives thin triangles.
//!
//! A cross product in plain floating point errs by a few units of its two products, however small
//! it is itself. If that is too much for a weight, differences and products are computed as
//! unevaluated sums of two doubles (T. J. Dekker, "A floating-point technique for extending the
//! available precision", 1971), which errs by about 2^-100 of the products.

use delone_predicates::Point2;

/// Ratio of products to cross product above which plain floating point does not suffice: about
/// 1e-14 is left.
const THIN: f64 = 32.0;

/// A difference of doubles as head and tail: no rounding.
type Exact = (f64, f64);

/// `a x b`; `None` if it is too small compared with its products.
#[inline]
pub fn plain(a: Point2, b: Point2) -> Option<f64> {
    let (left, right) = (a[0] * b[1], a[1] * b[0]);
    let cross = left - right;
    (cross.abs() * THIN >= left.abs() + right.abs()).then_some(cross)
}

/// `(p - o) x (r - o)`, where `a` and `b` are those differences rounded.
#[inline]
pub fn cross(o: Point2, p: Point2, r: Point2, a: Point2, b: Point2) -> f64 {
    match plain(a, b) {
        Some(cross) => cross,
        None => accurate(o, p, r),
    }
}

/// `(p - o) x (r - o)` from exact differences.
#[cold]
#[inline(never)]
pub fn accurate(o: Point2, p: Point2, r: Point2) -> f64 {
    with_products(o, p, r).0
}

/// The same if it is correct in nearly all of its digits.
#[cold]
#[inline(never)]
pub fn certain(o: Point2, p: Point2, r: Point2) -> Option<f64> {
    // The rest of 2^-100 of the products, and a bound far above underflow.
    const SHARE: f64 = (1_u64 << 45) as f64;
    const LEAST: f64 = 1e-250;
    let (cross, products) = with_products(o, p, r);
    (cross.abs() * SHARE >= products && cross.abs() > LEAST).then_some(cross)
}

fn with_products(o: Point2, p: Point2, r: Point2) -> (f64, f64) {
    let [ax, ay] = [0, 1].map(|k| difference(p[k], o[k]));
    let [bx, by] = [0, 1].map(|k| difference(r[k], o[k]));
    let (left, left_rest) = product(ax, by);
    let (right, right_rest) = product(ay, bx);
    let (head, tail) = difference(left, right);
    let cross = head + (tail + (left_rest - right_rest));
    (cross, left.abs() + right.abs())
}

/// `a - b` without rounding (D. E. Knuth's two-sum).
fn difference(a: f64, b: f64) -> Exact {
    let head = a - b;
    let b_part = a - head;
    let a_part = head + b_part;
    (head, (a - a_part) + (b_part - b))
}

fn product(a: Exact, b: Exact) -> Exact {
    let head = a.0 * b.0;
    let rest = a.0.mul_add(b.0, -head);
    (head, rest + (a.0 * b.1 + a.1 * b.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thin_triangles_have_their_area() {
        // At the offsets of maps, one unit in the last place off a line.
        let o = [500_000.0, 5_000_000.0];
        let step = 2f64.powi(-30);
        let p = [o[0] + 1000.0, o[1] + 1000.0];
        let r = [o[0] + 2000.0, o[1] + 2000.0 + step];
        assert_eq!(accurate(o, p, r), 1000.0 * step);
        assert_eq!(accurate(o, r, p), -1000.0 * step);
        assert_eq!(certain(o, p, r), Some(1000.0 * step));
        assert_eq!(certain([1e-30, 0.0], [1.0, 1.0], [2.0, 2.0]), None);
        let far = [1e16, 1.0];
        assert_eq!(accurate([1.0, 0.0], far, [0.0, 1.0]), 1e16);
    }
}
