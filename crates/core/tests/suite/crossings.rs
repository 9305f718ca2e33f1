//! Crossings of segments compared with rational numbers: the rounded point, and the pairs.

use crate::tier::cases;
use delone_core::Point2;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::constrained::intersection::{crosses, intersection};
use delone_core::constrained::pairs::{crossing_pairs, crossing_pairs_above};
use num_rational::BigRational;
use num_traits::{One, Zero};
use proptest::prelude::*;

type Quad = [Point2; 4];

fn rational(x: f64) -> BigRational {
    BigRational::from_float(x).expect("a finite number")
}

/// The parameters along ab and cd at which the lines meet, unless they are parallel.
fn parameters(quad: Quad) -> Option<[BigRational; 2]> {
    let [a, b, c, d] = quad.map(|p| p.map(rational));
    let minus = |p: &[BigRational; 2], q: &[BigRational; 2]| [&p[0] - &q[0], &p[1] - &q[1]];
    let cross = |p: &[BigRational; 2], q: &[BigRational; 2]| &p[0] * &q[1] - &p[1] * &q[0];
    let (r, s, w) = (minus(&b, &a), minus(&d, &c), minus(&c, &a));
    let below = cross(&r, &s);
    (!below.is_zero()).then(|| [cross(&w, &s) / &below, cross(&w, &r) / &below])
}

fn cross_exactly(quad: Quad) -> bool {
    let inside = |t: &BigRational| *t > BigRational::zero() && *t < BigRational::one();
    parameters(quad).is_some_and(|t| t.iter().all(inside))
}

/// Whether `r` is the double nearest to `x`, the even one in a tie, and not -0.0.
fn is_nearest(r: f64, x: &BigRational) -> bool {
    let two = rational(2.0);
    let end = |next: f64| (rational(r) + rational(next)) / &two;
    let (low, high) = (end(r.next_down()), end(r.next_up()));
    let even = r.to_bits() & 1 == 0;
    let inside = low < *x && *x < high || even && (low == *x || *x == high);
    inside && !(r == 0.0 && r.is_sign_negative())
}

/// Checks every guarantee for two segments; returns whether they cross.
fn check(quad: Quad) -> bool {
    let [a, b, c, d] = quad;
    let found = crosses(a, b, c, d);
    assert_eq!(found, cross_exactly(quad), "{quad:?}");
    if !found {
        return false;
    }
    let point = intersection(a, b, c, d);
    let [t, _] = parameters(quad).expect("one point");
    for k in 0..2 {
        let x = rational(a[k]) + &t * (rational(b[k]) - rational(a[k]));
        assert!(is_nearest(point[k], &x), "{quad:?}: {point:?}");
        for [p, q] in [[a, b], [c, d]] {
            let (low, high) = (p[k].min(q[k]), p[k].max(q[k]));
            assert!(low <= point[k] && point[k] <= high, "{quad:?}: {point:?}");
        }
    }
    for [a, b, c, d] in [[b, a, c, d], [c, d, a, b], [d, c, b, a]] {
        let same = intersection(a, b, c, d).map(f64::to_bits);
        assert_eq!(same, point.map(f64::to_bits), "{quad:?}");
    }
    true
}

fn ulps(x: f64, steps: i32) -> f64 {
    let step = if steps < 0 {
        f64::next_down
    } else {
        f64::next_up
    };
    (0..steps.abs()).fold(x, |x, _| step(x))
}

#[test]
fn ties_go_to_even() {
    // The midpoint of two neighboring doubles, at height one half.
    let half = |low: f64, shift: i32| {
        let y = ulps(0.5, shift);
        let quad = [[low, 0.0], [low.next_up(), 1.0], [-1.0, y], [3.0, y]];
        assert!(check(quad), "{quad:?}");
        let [a, b, c, d] = quad;
        intersection(a, b, c, d)[0]
    };
    let least = f64::from_bits(1);
    for (low, even) in [
        (1.0, 1.0),
        (1.0_f64.next_up(), ulps(1.0, 2)),
        (1.0_f64.next_down(), 1.0),
        (2.0_f64.next_down(), 2.0),
        (0.0, 0.0),
        (least, 2.0 * least),
        (f64::MIN_POSITIVE.next_down(), f64::MIN_POSITIVE),
        (-least, 0.0),
    ] {
        assert_eq!(half(low, 0), even, "{low:e}");
        assert_eq!(half(low, -1), low, "{low:e}");
        assert_eq!(half(low, 1), low.next_up(), "{low:e}");
    }
}

#[test]
fn the_ends_of_the_range() {
    const M: f64 = f64::MAX;
    const S: f64 = 5e-324;
    for quad in [
        [[-M, -M], [M, M], [-M, M], [M, -M]],
        [[-M, -M], [M, M], [M.next_down(), M], [M, M.next_down()]],
        [[-M, -S], [M, S], [-S, M], [S, -M]],
        [[0.0, 0.0], [3.0 * S, S], [S, S], [2.0 * S, 0.0]],
        [
            [1e300, 1e-300],
            [-1e300, -1e-300],
            [1e-300, 1e300],
            [0.0, -1e-5],
        ],
        [[-0.0, -1.0], [-0.0, 1.0], [-1.0, -0.0], [1.0, -0.0]],
        [[-S, -S], [S, S], [-S, S], [S, -S]],
        [[-S, -M], [0.0, M], [-1.0, 0.0], [1.0, 0.0]],
    ] {
        assert!(check(quad), "{quad:?}");
    }
}

#[test]
fn lines_that_are_parallel_have_no_point() {
    let at = intersection([0.0, 0.0], [2.0, 1.0], [0.0, 1.0], [2.0, 2.0]);
    assert!(at[0].is_nan() && at[1].is_nan());
}

#[test]
fn touching_is_not_crossing() {
    let ([a, b], m) = ([[0.0, 0.0], [4.0, 2.0]], [2.0, 1.0]);
    for [c, d] in [
        [a, b],
        [b, a],
        [a, m],
        [m, [6.0, 3.0]],
        [[-2.0, -1.0], m],
        [m, [2.0, 9.0]],
        [b, [4.0, 9.0]],
        [m, m],
        [[6.0, 3.0], [8.0, 4.0]],
        [[0.0, 1.0], [4.0, 3.0]],
    ] {
        assert!(!crosses(a, b, c, d), "{c:?} {d:?}");
        assert!(!cross_exactly([a, b, c, d]));
        let points = [a, b, c, d];
        let pairs = crossing_pairs(&points, &[[0, 1], [2, 3]], &Watch::idle());
        assert_eq!(pairs.expect("pairs"), [[0; 2]; 0]);
    }
}

/// Pseudo-random bits of a number.
fn hash(i: u64) -> u64 {
    let mut z = i.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// A number in [0, 1).
fn unit(i: u64) -> f64 {
    (hash(i) >> 11) as f64 / (1u64 << 53) as f64
}

/// How many of 2,000 drawn quadruples cross; each is checked.
fn crossing_share(draw: impl Fn(&mut dyn FnMut() -> u64) -> Quad) -> usize {
    let mut i = 0;
    let mut bits = || {
        i += 1;
        hash(i)
    };
    (0..2_000).filter(|_| check(draw(&mut bits))).count()
}

#[test]
fn of_all_exponents() {
    let coordinate = |bits: u64| {
        let x = f64::from_bits(bits);
        if x.is_finite() { x } else { 0.5 }
    };
    let all = crossing_share(|bits| [(); 4].map(|()| [(); 2].map(|()| coordinate(bits()))));
    assert!(all > 100, "{all}");
    // All of one order of magnitude, also subnormal or near the largest.
    let one = crossing_share(|bits| {
        let field = [0, 1, 2, 700, 863, 864, 1212, 1213, 2045, 2046][(bits() % 10) as usize];
        let mask = 1 << 63 | ((1 << 52) - 1);
        [(); 4].map(|()| [(); 2].map(|()| f64::from_bits(field << 52 | bits() & mask)))
    });
    assert!(one > 300, "{one}");
}

#[test]
fn of_surveys_with_large_offsets() {
    let share = crossing_share(|bits| {
        let mut unit = || (bits() >> 11) as f64 / (1u64 << 53) as f64;
        let (width, grid) = ([1.0, 1e3, 1e-6][(unit() * 3.0) as usize], unit() < 0.5);
        let mut at = |offset: f64| {
            let x = offset + width * unit();
            if grid { (x * 1e3).round() / 1e3 } else { x }
        };
        [(); 4].map(|()| [at(448_262.08), at(4_643_107.36)])
    });
    assert!(share > 300, "{share}");
}

#[test]
fn of_segments_that_are_nearly_parallel() {
    let share = crossing_share(|bits| {
        let mut unit = || (bits() >> 11) as f64 / (1u64 << 53) as f64;
        let (a, b) = ([unit(), unit()], [8.0 + unit(), 5.0 * unit()]);
        let mut shaken = |p: Point2, way: i32| {
            let steps = way * (1.0 + 4.0 * unit()) as i32;
            [p[0], ulps(p[1], steps)]
        };
        [a, b, shaken(a, 1), shaken(b, -1)]
    });
    assert!(share > 1_500, "{share}");
}

/// Coordinates on a tiny lattice, scaled.
fn lattice_quad() -> impl Strategy<Value = Quad> {
    let scale = prop::sample::select(vec![1.0, 0.1, 3e-320, 1e-300, 1e300]);
    (prop::array::uniform4(prop::array::uniform2(-3i8..4)), scale)
        .prop_map(|(quad, scale)| quad.map(|p| p.map(|x| f64::from(x) * scale)))
}

/// Points of a set with many ties, and segments between any of them.
fn drawing() -> impl Strategy<Value = (Vec<Point2>, Vec<[u32; 2]>)> {
    let scale = prop::sample::select(vec![1.0, 0.1, 5e-324, 1e307, f64::MAX / 8.0]);
    let coordinate = prop_oneof![
        4 => (0i32..6).prop_map(f64::from),
        1 => (0i32..40).prop_map(|e| 2.0_f64.powi(-e)),
    ];
    let points = prop::collection::vec(prop::array::uniform2(coordinate), 2..40);
    (points, scale).prop_flat_map(|(points, scale)| {
        let n = points.len() as u32;
        let points: Vec<Point2> = points.iter().map(|p| p.map(|x| x * scale)).collect();
        let segments = prop::collection::vec(prop::array::uniform2(0..n), 0..120);
        (Just(points), segments)
    })
}

fn brute_force(points: &[Point2], segments: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let at = |s: u32| segments[s as usize].map(|v| points[v as usize]);
    let n = segments.len() as u32;
    let all = (0..n).flat_map(|s| (s + 1..n).map(move |t| [s, t]));
    all.filter(|&[s, t]| {
        let ([a, b], [c, d]) = (at(s), at(t));
        crosses(a, b, c, d)
    })
    .collect()
}

fn found(points: &[Point2], segments: &[[u32; 2]]) -> Vec<[u32; 2]> {
    crossing_pairs(points, segments, &Watch::idle()).expect("pairs")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(66, 800)))]

    #[test]
    fn lattices(quad in lattice_quad()) {
        check(quad);
    }

    #[test]
    fn drawings((points, segments) in drawing()) {
        prop_assert_eq!(found(&points, &segments), brute_force(&points, &segments));
    }
}

/// Segments of lengths that differ by many orders of magnitude, around a point.
fn mixed(n: u64, center: f64) -> (Vec<Point2>, Vec<[u32; 2]>) {
    let mut points = Vec::new();
    for i in 0..n {
        let size = 10.0_f64.powf(-5.0 * unit(6 * i));
        let middle = [1, 2].map(|k| center + unit(6 * i + k));
        let half = [3, 4].map(|k| size * (unit(6 * i + k) - 0.5));
        points.push([middle[0] - half[0], middle[1] - half[1]]);
        points.push([middle[0] + half[0], middle[1] + half[1]]);
    }
    (points, (0..n as u32).map(|i| [2 * i, 2 * i + 1]).collect())
}

#[test]
fn many_sizes_together() {
    for (n, center) in [(9, 0.0), (65, 0.0), (1_000, 0.0), (2_000, 4e6), (600, 1e15)] {
        let (points, segments) = mixed(n, center);
        let pairs = found(&points, &segments);
        assert!(n < 100 || !pairs.is_empty());
        assert_eq!(pairs, brute_force(&points, &segments));
    }
}

#[test]
fn sizes_of_the_whole_range() {
    let mut points: Vec<Point2> = Vec::new();
    for i in 0..1_200 {
        // Crosses around the origin, from the smallest to the largest double.
        let size = f64::from_bits(hash(i) % f64::MAX.to_bits());
        let turn = 7.0 * unit(i);
        let arm = [size * turn.cos(), size * turn.sin()];
        let slip = 0.1 * size * unit(i + 7);
        points.extend([[-arm[0] + slip, -arm[1]], [arm[0], arm[1] - slip]]);
    }
    let segments: Vec<[u32; 2]> = (0..1_200).map(|i| [2 * i, 2 * i + 1]).collect();
    let pairs = found(&points, &segments);
    assert!(!pairs.is_empty());
    assert_eq!(pairs, brute_force(&points, &segments));
}

#[test]
fn crossings_are_where_they_were_put() {
    // A grid of lines: each of one kind crosses each of the other.
    let n = 70u32;
    let (mut points, mut segments) = (Vec::new(), Vec::new());
    for i in 0..n {
        let x = f64::from(i);
        points.extend([[x, -1.0], [x, 70.0], [-1.0, x], [70.0, x]]);
        segments.extend([[4 * i, 4 * i + 1], [4 * i + 2, 4 * i + 3]]);
    }
    let pairs = found(&points, &segments);
    assert_eq!(pairs.len() as u32, n * n);
    assert!(pairs.iter().all(|p| p[0] < p[1] && p[0] % 2 != p[1] % 2));
    assert!(pairs.is_sorted_by(|p, q| p < q));
}

#[test]
fn a_limit_ends_the_search() {
    let (points, segments) = mixed(400, 0.0);
    let all = found(&points, &segments);
    for limit in [0, 1, 10, all.len() - 1, all.len(), all.len() + 1] {
        let some = crossing_pairs_above(&points, &segments, limit, &Watch::idle()).expect("pairs");
        assert_eq!(some.len(), all.len().min(limit + 1));
        assert!(some.iter().all(|p| all.binary_search(p).is_ok()));
    }
}

#[test]
fn no_segments_and_none_of_any_length() {
    assert!(found(&[], &[]).is_empty());
    let points = vec![[1.0, 2.0]; 50];
    let segments: Vec<[u32; 2]> = (0..50).map(|i| [i, (i + 7) % 50]).collect();
    assert!(found(&points, &segments).is_empty());
}

#[test]
fn an_interruption_ends_the_search() {
    let (points, segments) = mixed(20_000, 0.0);
    let stopped = crossing_pairs(&points, &segments, &Watch::new(&|| true));
    assert_eq!(stopped, Err(Error::Interrupted));
}
