//! The smallest balls orthogonal to the sites of a simplex: squared radii, correctly rounded, and
//! which other sites are in conflict with them, decided exactly.
//!
//! A site is a point p with a weight w: a ball with the squared radius w, possibly negative. With
//! the vectors v_i from the first corner to the others and h_i = |v_i|^2 + w_0 - w_i, the center of
//! the ball is p_0 + c, where c is in the span of the vectors and 2 v_i . c = h_i. Its squared radius
//! is |c|^2 - w_0, and |c|^2 is a quotient N / (4 D):
//!
//! | corners | N | D |
//! |---|---|---|
//! | 2 | h^2 | \|v\|^2 |
//! | 3 | \|h_2 v_1 - h_1 v_2\|^2 | \|v_1 x v_2\|^2 |
//! | 4 | \|h_1 v_2 x v_3 + h_2 v_3 x v_1 + h_3 v_1 x v_2\|^2 | (v_1 . v_2 x v_3)^2 |
//!
//! A site q is in conflict if its power with respect to the ball, less its weight, is negative:
//! |q|^2 - 2 q . c + w_0 - w_q, multiplied by D. Stages are pairs of doubles, with a check that the
//! rounding is certain, and arbitrary-precision integers; for conflicts doubles, integers of 128 bits
//! (for points of a grid, where many conflicts are ties), and arbitrary-precision integers.

use delone_predicates::Sign;
use delone_predicates::arithmetic::{Pair, decode_odd};
use num_bigint::BigInt;

use super::number::{Number, Rough, Rounded, certain};
use crate::base::vector::dot_of;
use crate::base::wide::{lowest, ratio, scaled, sign};

/// Vectors with a largest component between these, 2^-40 and 2^40, and weights below the square,
/// cause no overflow and no underflow that matters: N is of degree 8.
const SMALL: f64 = f64::from_bits((1023 - 40) << 52);
const LARGE: f64 = f64::from_bits((1023 + 40) << 52);
/// Differences on a grid below this, 2^19, in degree 6 fit 128 bits.
const GRID: i128 = 1 << 19;

/// A point, exactly the sum of two, with a weight.
#[derive(Clone, Copy)]
pub struct Site<const D: usize> {
    /// The coordinates.
    pub at: [f64; D],
    /// What is added to them: multiples of a period, which are doubles.
    pub shift: [f64; D],
    /// The weight.
    pub weight: f64,
}

/// Which parts of sites are not zero.
#[derive(Clone, Copy)]
pub struct Kind {
    /// Weights.
    pub weighted: bool,
    /// Shifts.
    pub moved: bool,
}

/// Vectors from the first corner to the others, and their heights.
struct Lifted<N, const D: usize, const M: usize> {
    to: [[N; D]; M],
    heights: [N; M],
}

/// The products of coordinates in which the components of a cross product are differences.
const fn minors<const D: usize>() -> &'static [[usize; 2]] {
    if D == 2 {
        &[[0, 1]]
    } else {
        &[[1, 2], [2, 0], [0, 1]]
    }
}

#[inline]
fn minor<N: Number, const D: usize>(p: &[N; D], q: &[N; D], [i, j]: [usize; 2]) -> N {
    p[i].clone() * q[j].clone() - p[j].clone() * q[i].clone()
}

/// The sum of the squares of `count` terms.
#[inline]
fn squares<N: Number>(count: usize, term: impl Fn(usize) -> N) -> N {
    (1..count).fold(term(0).squared(), |sum, k| sum + term(k).squared())
}

/// The squared size of a vector or, of two, of their cross product.
#[inline]
fn area<N: Number, const D: usize>(p: &[N; D], q: &[N; D]) -> N {
    let minors = minors::<D>();
    squares(minors.len(), |k| minor(p, q, minors[k]))
}

/// N and D of an edge.
#[inline]
fn of_edge<N: Number, const D: usize>(kind: Kind, lifted: &Lifted<N, D, 1>) -> [N; 2] {
    let [height] = lifted.heights.clone();
    if kind.weighted {
        [height.squared(), dot_of(&lifted.to[0], &lifted.to[0])]
    } else {
        [height, N::one()]
    }
}

/// N and D of a triangle.
#[inline]
fn of_triangle<N: Number, const D: usize>(lifted: &Lifted<N, D, 2>) -> [N; 2] {
    let ([a, b], [ha, hb]) = (&lifted.to, &lifted.heights);
    let term = |k: usize| hb.clone() * a[k].clone() - ha.clone() * b[k].clone();
    [squares(D, term), area(a, b)]
}

/// N and D of a tetrahedron.
#[inline]
fn of_tetrahedron<N: Number>(lifted: &Lifted<N, 3, 3>) -> [N; 2] {
    let ([a, b, c], [ha, hb, hc]) = (&lifted.to, &lifted.heights);
    let minors = minors::<3>();
    let term = |k: usize| {
        ha.clone() * minor(b, c, minors[k])
            + hb.clone() * minor(c, a, minors[k])
            + hc.clone() * minor(a, b, minors[k])
    };
    let part = |k: usize| a[k].clone() * minor(b, c, minors[k]);
    let volume = part(0) + part(1) + part(2);
    [squares(3, term), volume.squared()]
}

/// The power of the last site with respect to the ball of an edge, times D.
#[inline]
fn beside_edge<N: Number, const D: usize>(lifted: &Lifted<N, D, 2>) -> N {
    let ([v, q], [h, power]) = (&lifted.to, lifted.heights.clone());
    power * dot_of(v, v) - h * dot_of(v, q)
}

/// The power of the last site with respect to the ball of a triangle, times D.
#[inline]
fn beside_triangle<N: Number, const D: usize>(lifted: &Lifted<N, D, 3>) -> N {
    let ([a, b, q], [ha, hb, power]) = (&lifted.to, lifted.heights.clone());
    let (aa, ab, bb) = (dot_of(a, a), dot_of(a, b), dot_of(b, b));
    let first = ha.clone() * bb - hb.clone() * ab.clone();
    let second = hb * aa - ha * ab;
    power * area(a, b) - (first * dot_of(a, q) + second * dot_of(b, q))
}

/// Rounded vectors, and whether they are in the range that `SMALL` and `LARGE` give.
#[inline]
fn rounded<T: Rounded, const D: usize, const M: usize>(
    kind: Kind,
    first: &Site<D>,
    others: &[Site<D>; M],
) -> Option<Lifted<Rough<T>, D, M>> {
    let to = others.each_ref().map(|site| {
        std::array::from_fn::<_, D, _>(|k| {
            let plain = Rough::<T>::difference(site.at[k], first.at[k]);
            if kind.moved {
                plain + Rough::difference(site.shift[k], first.shift[k])
            } else {
                plain
            }
        })
    });
    let sizes = to.as_flattened().iter();
    let largest = sizes.fold(0.0_f64, |most, x| most.max(x.size));
    // Written so that NaN fails; `max` ignores it, but then another size is infinite or NaN.
    if !(largest > SMALL && largest < LARGE) {
        return None;
    }
    let mut heights = to.each_ref().map(|v| dot_of(v, v));
    if kind.weighted {
        for (height, site) in heights.iter_mut().zip(others) {
            *height = *height + Rough::difference(first.weight, site.weight);
        }
        let weights = others
            .iter()
            .fold(first.weight.abs(), |most, site| most.max(site.weight.abs()));
        if weights >= LARGE * LARGE {
            return None;
        }
    }
    Some(Lifted { to, heights })
}

/// The exponent of a unit of which all coordinates are multiples; of weights, its square.
fn unit<const D: usize>(first: &Site<D>, others: &[Site<D>]) -> i64 {
    let sites = std::iter::once(first).chain(others);
    let lows = sites.map(|site| lowest(&[site.at, site.shift], &[site.weight]));
    lows.min().unwrap_or(0)
}

/// Vectors as integers, in the unit 2^low.
fn integers<const D: usize, const M: usize>(
    first: &Site<D>,
    others: &[Site<D>; M],
    low: i64,
) -> Lifted<BigInt, D, M> {
    let place = |site: &Site<D>, k: usize| scaled(site.at[k], low) + scaled(site.shift[k], low);
    let to = others
        .each_ref()
        .map(|site| std::array::from_fn(|k| place(site, k) - place(first, k)));
    let heights = std::array::from_fn(|i| {
        let v: &[BigInt; D] = &to[i];
        dot_of(v, v) + scaled(first.weight, 2 * low) - scaled(others[i].weight, 2 * low)
    });
    Lifted { to, heights }
}

/// The same as integers of 128 bits, if there are no weights and all differences are small.
fn on_grid<const D: usize, const M: usize>(
    kind: Kind,
    first: &Site<D>,
    others: &[Site<D>; M],
) -> Option<Lifted<i128, D, M>> {
    if kind.weighted || kind.moved {
        return None;
    }
    let exponent = |x: f64| {
        let (magnitude, exponent) = decode_odd(x);
        if magnitude == 0 { i32::MAX } else { exponent }
    };
    // Of exact differences, which are fewer and shorter than coordinates.
    let mut low = i32::MAX;
    let mut plain = [[0.0; D]; M];
    for (v, site) in plain.iter_mut().zip(others) {
        for (k, v) in v.iter_mut().enumerate() {
            let pair = Pair::difference(site.at[k], first.at[k]);
            if pair.lo != 0.0 {
                return None;
            }
            *v = pair.hi;
            low = low.min(exponent(pair.hi));
        }
    }
    if !(-900..=900).contains(&low) {
        return None;
    }
    let factor = f64::from_bits(((1023 - low) as u64) << 52);
    let mut to = [[0_i128; D]; M];
    for (v, plain) in to.as_flattened_mut().iter_mut().zip(plain.as_flattened()) {
        let x = plain * factor;
        if x.abs() >= GRID as f64 {
            return None;
        }
        *v = x as i128;
    }
    let heights = to.each_ref().map(|v| dot_of(v, v));
    Some(Lifted { to, heights })
}

/// The squared radius from the expressions of a simplex.
#[inline]
fn radius<const D: usize, const M: usize>(
    kind: Kind,
    first: &Site<D>,
    others: &[Site<D>; M],
    plain: impl Fn(&Lifted<Rough<Pair>, D, M>) -> [Rough<Pair>; 2],
    exact: impl Fn(&Lifted<BigInt, D, M>) -> [BigInt; 2],
) -> f64 {
    let found = rounded(kind, first, others).and_then(|lifted| {
        let [n, d] = plain(&lifted);
        certain(n, d, first.weight)
    });
    found.unwrap_or_else(|| exact_radius(first, others, exact)) + 0.0
}

#[cold]
#[inline(never)]
fn exact_radius<const D: usize, const M: usize>(
    first: &Site<D>,
    others: &[Site<D>; M],
    exact: impl Fn(&Lifted<BigInt, D, M>) -> [BigInt; 2],
) -> f64 {
    let low = unit(first, others);
    let [n, d] = exact(&integers(first, others, low));
    let d = d * 4;
    let n = n - scaled(first.weight, 2 * low) * &d;
    ratio(&n, &d, 2 * low).unwrap_or(f64::INFINITY)
}

/// Whether an expression is negative.
#[inline]
fn is_negative<const D: usize, const M: usize>(
    kind: Kind,
    first: &Site<D>,
    others: &[Site<D>; M],
    plain: impl Fn(&Lifted<Rough<f64>, D, M>) -> Rough<f64>,
    narrow: impl Fn(&Lifted<i128, D, M>) -> i128,
    exact: impl Fn(&Lifted<BigInt, D, M>) -> BigInt,
) -> bool {
    let found = rounded(kind, first, others).and_then(|lifted| plain(&lifted).sign());
    let found = found.unwrap_or_else(|| {
        if let Some(lifted) = on_grid(kind, first, others) {
            return match narrow(&lifted) {
                0 => Sign::Zero,
                1.. => Sign::Positive,
                _ => Sign::Negative,
            };
        }
        sign(&exact(&integers(first, others, unit(first, others))))
    });
    found == Sign::Negative
}

/// The squared radius of the smallest ball of an edge.
#[inline]
pub fn edge<const D: usize>(kind: Kind, [a, b]: [Site<D>; 2]) -> f64 {
    radius(
        kind,
        &a,
        &[b],
        |lifted| of_edge(kind, lifted),
        |lifted| of_edge(kind, lifted),
    )
}

/// The squared radius of the smallest ball of a triangle.
#[inline]
pub fn triangle<const D: usize>(kind: Kind, [a, b, c]: [Site<D>; 3]) -> f64 {
    radius(kind, &a, &[b, c], of_triangle, of_triangle)
}

/// The squared radius of the ball of a tetrahedron.
#[inline]
pub fn tetrahedron(kind: Kind, [a, b, c, d]: [Site<3>; 4]) -> f64 {
    radius(kind, &a, &[b, c, d], of_tetrahedron, of_tetrahedron)
}

/// Whether a site is in conflict with another one alone.
#[inline]
pub fn hides<const D: usize>(kind: Kind, a: Site<D>, q: Site<D>) -> bool {
    let power = |lifted: &Lifted<Rough<f64>, D, 1>| lifted.heights[0];
    is_negative(
        kind,
        &a,
        &[q],
        power,
        |lifted| lifted.heights[0],
        |lifted| lifted.heights[0].clone(),
    )
}

/// Whether a site is in conflict with the smallest ball of an edge.
#[inline]
pub fn meets_edge<const D: usize>(kind: Kind, [a, b]: [Site<D>; 2], q: Site<D>) -> bool {
    is_negative(kind, &a, &[b, q], beside_edge, beside_edge, beside_edge)
}

/// Whether a site is in conflict with the smallest ball of a triangle.
#[inline]
pub fn meets_triangle<const D: usize>(kind: Kind, [a, b, c]: [Site<D>; 3], q: Site<D>) -> bool {
    is_negative(
        kind,
        &a,
        &[b, c, q],
        beside_triangle,
        beside_triangle,
        beside_triangle,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    const PLAIN: Kind = Kind {
        weighted: false,
        moved: false,
    };
    const WEIGHTED: Kind = Kind {
        weighted: true,
        moved: false,
    };

    fn site<const D: usize>(at: [f64; D]) -> Site<D> {
        Site {
            at,
            shift: [0.0; D],
            weight: 0.0,
        }
    }

    #[test]
    fn radii_of_boxes_are_those_of_their_diagonals() {
        for e in [-300, -60, -7, 0, 20, 100] {
            let u = 2_f64.powi(e);
            let corners = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 6.0]];
            let at = corners.map(|p| site(p.map(|x| x * u)));
            let square = u * u;
            assert_eq!(edge(PLAIN, [at[0], at[1]]), square);
            assert_eq!(triangle(PLAIN, [at[0], at[1], at[2]]), 5.0 * square);
            assert_eq!(tetrahedron(PLAIN, at), 14.0 * square);
        }
    }

    #[test]
    fn the_stages_agree() {
        let mut next = uniform(5);
        let mut sure = 0;
        for i in 0..3000 {
            let thin = if i % 2 == 0 { 1.0 } else { 1e-5 };
            let offset = [0.0, 1e3, -0.3][i % 3];
            let kind = if i % 5 == 0 { WEIGHTED } else { PLAIN };
            let mut weight = || if kind.weighted { next() - 0.5 } else { 0.0 };
            let weights: [f64; 4] = std::array::from_fn(|_| weight());
            let at: [Site<3>; 4] = std::array::from_fn(|k| Site {
                at: [1.0, 1.0, thin].map(|s| offset + s * next()),
                shift: [0.0; 3],
                weight: weights[k],
            });
            let [a, b, c, d] = at;
            let others = [b, c, d];
            if let Some(lifted) = rounded(kind, &a, &others) {
                let [n, e] = of_tetrahedron::<Rough<Pair>>(&lifted);
                if let Some(found) = certain(n, e, a.weight) {
                    sure += 1;
                    assert_eq!(found, exact_radius(&a, &others, of_tetrahedron));
                }
            }
            let exact = |kind: Kind| {
                let _ = kind;
                sign(&beside_triangle(&integers(&a, &others, unit(&a, &others)))) == Sign::Negative
            };
            assert_eq!(meets_triangle(kind, [a, b, c], d), exact(kind));
        }
        assert!(sure > 2500, "{sure}");
    }

    #[test]
    fn ties_on_a_grid_are_not_conflicts() {
        let at = [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]].map(site);
        let far = site([1.0, 1.0, 1.0]);
        assert!(!meets_edge(PLAIN, [at[0], far], at[1]));
        let low = site([1.0, 0.0, 0.0]);
        assert!(!meets_triangle(
            PLAIN,
            [at[0], low, at[1]],
            site([0.0, 1.0, 0.0])
        ));
        assert!(meets_edge(PLAIN, [at[0], far], site([0.5, 0.5, 1e-300])));
    }
}
