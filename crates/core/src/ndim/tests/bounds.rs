//! Bounds of the filters against fractions: never exceeded, and not loose by orders of magnitude.

use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

use super::super::cell::Mesh;
use super::super::filter::{Test, U, barycentric, invert, minus};
use super::super::fine::Fine;
use super::super::frame::Integers;
use super::super::lanes::{self, LANES};
use super::super::simplex::fine_barycentric;
use super::super::sites::{MOST, Sites};
use super::sets::Random;
use crate::base::wide::scaled;

/// The lowest exponent of the coordinates here.
const LOW: i64 = -200;

fn exact(x: f64) -> BigRational {
    BigRational::new(scaled(x, LOW), BigInt::from(1) << -LOW)
}

/// The solution of a system of equations; `None` if there is not one.
fn solved(mut m: Vec<Vec<BigRational>>) -> Option<Vec<BigRational>> {
    let n = m.len();
    for k in 0..n {
        let pivot = (k..n).find(|&i| !m[i][k].is_zero())?;
        m.swap(k, pivot);
        for i in 0..n {
            if i != k && !m[i][k].is_zero() {
                let factor = &m[i][k] / &m[k][k];
                for j in k..=n {
                    let change = &factor * &m[k][j];
                    m[i][j] -= change;
                }
            }
        }
    }
    Some((0..n).map(|k| &m[k][n] / &m[k][k]).collect())
}

/// The power of a point, and its barycentric coordinates but the first.
fn truth<const D: usize, const V: usize, const P: usize>(
    v: &[[f64; P]; V],
    p: &[f64; P],
) -> Option<(BigRational, Vec<BigRational>)> {
    let from = |q: &[f64; P]| -> Vec<_> { (0..D).map(|k| exact(q[k]) - exact(v[0][k])).collect() };
    let a: Vec<Vec<BigRational>> = v[1..].iter().map(from).collect();
    let lifts: Vec<_> = a.iter().map(|r| square(r)).collect();
    let d = from(p);
    let power = power(&a, &lifts, &d, square(&d))?;
    let columns = (0..D).map(|k| {
        let column: Vec<_> = a.iter().map(|r| r[k].clone()).collect();
        [&column[..], &[d[k].clone()]].concat()
    });
    Some((power, solved(columns.collect())?))
}

fn square(r: &[BigRational]) -> BigRational {
    r.iter().map(|x| x * x).sum()
}

/// The height of a point at `d` above the plane through those of the rows of `a`.
fn power(
    a: &[Vec<BigRational>],
    heights: &[BigRational],
    d: &[BigRational],
    height: BigRational,
) -> Option<BigRational> {
    let rows = a.iter().zip(heights);
    let x = solved(
        rows.map(|(r, h)| [&r[..], std::slice::from_ref(h)].concat())
            .collect(),
    )?;
    Some(height - x.iter().zip(d).map(|(x, d)| x * d).sum::<BigRational>())
}

/// A simplex inside the unit cube, and a point: scattered, far away, thin, near a sphere, near a facet.
fn drawn<const D: usize, const V: usize, const P: usize>(
    r: &mut Random,
    kind: u64,
) -> ([[f64; P]; V], [f64; P]) {
    let mut draw = || -> [f64; P] { std::array::from_fn(|k| if k < D { r.unit() } else { 0.0 }) };
    let mut v: [[f64; P]; V] = std::array::from_fn(|_| draw());
    let mut p = draw();
    match kind % 5 {
        1 => {
            let near = |q: &[f64; P]| q.map(|x| if x == 0.0 { 0.0 } else { 0.5 + x * 1e-6 });
            v = std::array::from_fn(|i| near(&v[i]));
            p = near(&p);
        }
        2 => {
            // The last corner is at a small distance from the center of the others.
            let thin = 2f64.powi(-(r.below(50) as i32));
            for k in 0..D {
                let mean = v[..D].iter().map(|q| q[k]).sum::<f64>() / D as f64;
                v[D][k] = mean + thin * (v[D][k] - mean);
            }
        }
        3 => {
            let on = |q: &[f64; P]| {
                let length = q.iter().map(|x| (x - 0.5) * (x - 0.5)).sum::<f64>().sqrt();
                let mut q = q.map(|x| 0.5 + (x - 0.5) / length / 3.0);
                q[D..].fill(0.0);
                q
            };
            v = std::array::from_fn(|i| on(&v[i]));
            p = on(&p);
        }
        4 => {
            for k in 0..D {
                p[k] = v[..D].iter().map(|q| q[k]).sum::<f64>() / D as f64;
            }
        }
        _ => {}
    }
    (v, p)
}

fn gap(value: f64, truth: &BigRational) -> f64 {
    let value = BigRational::from_float(value).unwrap();
    (value - truth).abs().to_f64().unwrap()
}

/// Checks all bounds; returns the largest parts of them that errors have used.
fn check<const D: usize, const V: usize, const P: usize>() -> [f64; 5] {
    let mut r = Random::new(17 + D as u64);
    let mut used = [0.0f64; 5];
    for kind in 0..240 {
        let (v, p) = drawn::<D, V, P>(&mut r, kind);
        let Some((power, l)) = truth::<D, V, P>(&v, &p) else {
            continue;
        };
        let a: [[f64; P]; D] = std::array::from_fn(|i| minus(&v[i + 1], &v[0]));
        let d = minus(&p, &v[0]);
        let mut note = |stage: usize, value: f64, bound: f64, truth: &BigRational| {
            if bound.is_finite() {
                let part = gap(value, truth) / bound;
                assert!(part <= 1.0, "{D}-D stage {stage} kind {kind}: {part}");
                used[stage] = used[stage].max(part);
            }
        };
        let (value, bound) = Test::lifted(&a, None).value(&d, false);
        note(0, value, bound, &power);
        let (value, bound) = Test::plane(&a).value(&d, true);
        note(1, value, bound, &l[D - 1]);
        let (weights, bound) = barycentric::<D, V, P>(&invert(&a), &d);
        for i in 0..D {
            note(2, weights[i + 1], bound, &l[i]);
        }
        let first = BigRational::from_integer(1.into()) - l.iter().sum::<BigRational>();
        note(2, weights[0], bound, &first);
        let corners: [&[f64; P]; V] = std::array::from_fn(|i| &v[i]);
        let (value, bound) = Fine::<D>::new(&corners).power(&p, &v[0], Pair::from_double(0.0));
        note(3, value, bound, &power);
        // The last one is very small near a facet: heads of pairs are then as good as these.
        let (weights, bound) = fine_barycentric::<D, V, P>(&corners, &p, &invert(&a));
        let head = if kind % 5 == 4 { 0.0 } else { U };
        note(4, weights[D], bound + head * weights[D].abs(), &l[D - 1]);
    }
    used
}

/// Simplices that are measured at once: the part of a bound that errors have used, and how many simplices need
/// pivots.
fn check_lanes<const D: usize, const V: usize, const P: usize>() -> (f64, usize) {
    let mut r = Random::new(29 + D as u64);
    let (mut used, mut alone) = (0.0f64, 0);
    for round in 0..40 {
        let mut drawn: [([[f64; P]; V], [f64; P]); LANES] =
            std::array::from_fn(|l| drawn::<D, V, P>(&mut r, round + l as u64));
        // Edges along the axes in turn: the first pivot is zero.
        let (v, _) = &mut drawn[LANES - 1];
        *v = std::array::from_fn(|i| {
            std::array::from_fn(|k| if i > 0 && k == i % D { 0.75 } else { 0.0 })
        });
        // The point has the weight of the first corner.
        let weighted = round % 2 == 1;
        let weights: [[f64; LANES]; D] = std::array::from_fn(|_| {
            std::array::from_fn(|_| if weighted { r.unit() - 0.5 } else { 0.0 })
        });
        let differences = drawn
            .map(|(v, _)| -> [[f64; P]; D] { std::array::from_fn(|i| minus(&v[i + 1], &v[0])) });
        let a = std::array::from_fn(|i| std::array::from_fn(|k| differences.map(|a| a[i][k])));
        let tests = lanes::lifted(&a, weighted.then_some(&weights));
        assert!(tests[LANES - 1].is_none());
        for (l, test) in tests.iter().enumerate() {
            let Some(test) = test else {
                alone += 1;
                continue;
            };
            let (v, p) = &drawn[l];
            let from =
                |q: &[f64; P]| -> Vec<_> { (0..D).map(|k| exact(q[k]) - exact(v[0][k])).collect() };
            let a: Vec<_> = v[1..].iter().map(from).collect();
            let height = |i: usize| square(&a[i]) - exact(weights[i][l]);
            let heights: Vec<_> = (0..D).map(height).collect();
            let d = from(p);
            let truth = power(&a, &heights, &d, square(&d)).unwrap();
            let (value, bound) = test.value(&minus(p, &v[0]), false);
            let part = gap(value, &truth) / bound;
            assert!(part <= 1.0, "{D}-D round {round} lane {l}: {part}");
            used = used.max(part);
        }
    }
    (used, alone)
}

#[test]
fn bounds_of_several_simplices_hold_and_are_not_loose() {
    for (used, alone) in [
        check_lanes::<2, 3, 4>(),
        check_lanes::<3, 4, 4>(),
        check_lanes::<4, 5, 4>(),
        check_lanes::<6, 7, 8>(),
        check_lanes::<8, 9, 8>(),
    ] {
        println!("{used} {alone}");
        assert!(used > 1e-4, "{used}");
        // One in each round, and some that are thin.
        assert!(alone > 40 && alone < 100, "{alone}");
    }
}

/// Sites with weights of one kind, or in a flat: the corners and then a point.
fn lifted<const D: usize, const V: usize, const P: usize>(
    r: &mut Random,
    kind: u64,
) -> Option<Sites<D, P>> {
    let (v, p) = drawn::<D, V, P>(r, kind / 5);
    let short = |q: &[f64; P]| -> [f64; D] { std::array::from_fn(|k| q[k]) };
    let at: Vec<[f64; D]> = v.iter().chain([&p]).map(short).collect();
    if kind % 5 == 4 {
        let steep = 2f64.powi(r.integer(-4, 12) as i32);
        let rest = |q: &[f64; D]| {
            std::array::from_fn(|k| if k < MOST - D { steep * q[k % D] } else { 0.0 })
        };
        return Sites::in_flat(at.clone(), at.iter().map(rest).collect()).ok();
    }
    let of = |q: &[f64; D]| q.iter().map(|x| x * x).sum::<f64>();
    let mut weights: Vec<f64> = match kind % 5 {
        0 => at.iter().map(|_| r.unit() - 0.5).collect(),
        // Lifted points in one plane but for roundings: the center is that of coordinates, not of
        // the points.
        1 => at.iter().map(of).collect(),
        2 => at.iter().map(|_| 1e6 * r.unit()).collect(),
        _ => vec![0.0; V + 1],
    };
    if kind % 5 == 3 {
        weights[V] = 1e6 * r.unit();
    }
    Sites::weighted(at, weights).ok()
}

/// The same of heights with weights and in flats.
fn check_lifted<const D: usize, const V: usize, const P: usize>() -> [f64; 2] {
    let mut r = Random::new(5 + D as u64);
    let mut used = [0.0f64; 2];
    // Fractions are slow with many coordinates.
    for kind in 0..if D < 5 { 400 } else { 100 } {
        let Some(sites) = lifted::<D, V, P>(&mut r, kind) else {
            panic!("no sites");
        };
        let from = |i: usize| -> Vec<_> {
            (0..D)
                .map(|k| exact(sites.scaled[i][k]) - exact(sites.scaled[0][k]))
                .collect()
        };
        let a: Vec<_> = (1..V).map(from).collect();
        // In units of the scaled coordinates.
        let unit = BigRational::new(BigInt::from(1), BigInt::from(1) << (-2 * sites.unit));
        let height =
            |i: usize| square(&from(i)) - BigRational::from(sites.wide_weight(i as u32, 0)) * &unit;
        let heights: Vec<_> = (1..V).map(height).collect();
        let Some(truth) = power(&a, &heights, &from(V), height(V)) else {
            continue;
        };
        let corners: [u32; V] = std::array::from_fn(|i| i as u32);
        let points: [&[f64; P]; V] = std::array::from_fn(|i| &sites.scaled[i]);
        let pairs = std::array::from_fn(|i| sites.weight_pair(i as u32 + 1, 0));
        let fine = Fine::<D>::lifted(&points, pairs);
        let refined = fine.power(&sites.scaled[V], points[0], sites.weight_pair(V as u32, 0));
        let Ok(mesh) = Mesh::<D, V, P>::new(sites, corners) else {
            continue;
        };
        for (stage, (value, bound)) in [mesh.value(0, V as u32), refined].into_iter().enumerate() {
            if bound.is_finite() {
                let part = gap(value, &truth) / bound;
                assert!(part <= 1.0, "{D}-D stage {stage} kind {kind}: {part}");
                used[stage] = used[stage].max(part);
            }
        }
    }
    used
}

#[test]
fn bounds_of_lifted_heights_hold_and_are_not_loose() {
    for used in [
        check_lifted::<2, 3, 4>(),
        check_lifted::<3, 4, 4>(),
        check_lifted::<4, 5, 4>(),
        check_lifted::<5, 6, 8>(),
        check_lifted::<7, 8, 8>(),
    ] {
        println!("{used:?}");
        for part in used {
            assert!(part > 1e-4, "{used:?}");
        }
    }
}

#[test]
fn bounds_hold_and_are_not_loose() {
    for used in [
        check::<2, 3, 4>(),
        check::<4, 5, 4>(),
        check::<5, 6, 8>(),
        check::<8, 9, 8>(),
    ] {
        println!("{used:?}");
        for part in used {
            assert!(part > 1e-4, "{used:?}");
        }
    }
}

/// Checks that weights have their part in each bound, where all numbers are exact and bounds follow from
/// the proofs alone.
fn check_parts<const D: usize, const V: usize, const P: usize>() {
    let (d, step, rest) = (D as f64, 0.5, 2f64.powi(-10));
    let mut v = [[0.0; P]; V];
    for i in 0..D {
        v[i + 1][i] = step;
    }
    let about = |bound: f64, proven: f64| {
        assert!(
            bound >= proven && bound < 1.01 * proven,
            "{D}-D: {bound:e} {proven:e}"
        );
    };
    // The products, the square and the weight of a row; the weight is nearly the square.
    let weight = step * step - rest;
    let sizes = rest + step * step + weight;
    // |A^-1| times the root of the number of rows.
    let norm = d / step;
    let a: [[f64; P]; D] = std::array::from_fn(|i| minus(&v[i + 1], &v[0]));
    let test = Test::lifted(&a, Some([weight; D]));
    let size = test.x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let c = (d + 5.0) * U;
    let slope = norm * (2.0 * d + 8.0) * U * sizes + c * size;
    let lanes = a.map(|row| std::array::from_fn(|k| [row[k]; LANES]));
    let several = lanes::lifted(&lanes, Some(&[[weight; LANES]; D]));
    for test in several.map(|test| test.unwrap()).into_iter().chain([test]) {
        about(2.0 * test.q0 / size, slope);
        about(2.0 * test.q1 * size, slope + 2.0 * c * size);
        let mut far = [0.0; P];
        far[0] = 2.0;
        let bound = slope * (size + 4.0 / size) / 2.0 + 4.0 * c;
        about(test.value(&far, false).1, bound);
    }
    // Without weights, the sphere is large enough that the square of a point counts.
    let plain = lanes::lifted(&lanes, None).map(|test| test.unwrap());
    let size = step * d.sqrt();
    let slope = norm * (2.0 * d + 8.0) * U * 2.0 * step * step + c * size;
    for test in plain.into_iter().chain([Test::lifted(&a, None)]) {
        about(2.0 * test.q0 / size, slope);
        about(2.0 * test.q1 * size, slope + 2.0 * c * size);
    }
    let size = test.x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let corners: [&[f64; P]; V] = std::array::from_fn(|i| &v[i]);
    let fine = Fine::<D>::lifted(&corners, [Pair::from_double(weight); D]);
    about(fine.error(), norm * (8.0 * d + 48.0) * U * U * sizes);
    // A point of which the weight is the power without it.
    let mut p = [0.0; P];
    p[0] = 1.0;
    let heavy = 1.0 - test.x[0];
    let (value, bound) = fine.power(&p, &v[0], Pair::from_double(heavy));
    assert_eq!(value, 0.0);
    let unit = (4.0 * d + 48.0) * U * U;
    about(bound, fine.error() + unit * (1.0 + size + heavy));
    let short = |q: &[f64; P]| -> [f64; D] { std::array::from_fn(|k| q[k]) };
    let at: Vec<[f64; D]> = v.iter().chain([&p]).map(short).collect();
    let mut weights = vec![0.0; V + 1];
    weights[V] = heavy;
    let sites = Sites::<D, P>::weighted(at, weights).unwrap();
    let scaled = sites.weights[V];
    let mesh = Mesh::<D, V, P>::new(sites, std::array::from_fn(|i| i as u32)).unwrap();
    let (_, bound) = mesh.less_weight((scaled, 0.0), V as u32, 0);
    about(bound, 24.0 * U * scaled);
}

#[test]
fn weights_have_their_part_in_bounds() {
    check_parts::<2, 3, 4>();
    check_parts::<4, 5, 4>();
    check_parts::<5, 6, 8>();
    check_parts::<8, 9, 8>();
}

/// With rows in any order, that is with any order of pivots, inverses of regular matrices are proven.
#[test]
fn inverses_are_proven_for_rows_in_any_order() {
    fn check<const D: usize, const P: usize>(random: &mut Random) {
        for turn in 0..200 {
            let mut rows: Vec<usize> = (0..D).collect();
            random.shuffle(&mut rows);
            let mut a = [[0.0; P]; D];
            for (row, &k) in a.iter_mut().zip(&rows) {
                for x in &mut row[..D] {
                    *x = if turn % 2 == 0 {
                        0.0
                    } else {
                        0.05 * random.unit()
                    };
                }
                row[k] = 1.0 + random.unit();
            }
            let inverse = invert(&a);
            assert!(
                inverse.norm < 4.0 * D as f64 && inverse.defect < 1e-12,
                "{a:?}"
            );
            for row in inverse.b {
                assert_eq!(row[D..], [0.0; P][D..]);
            }
        }
        // Two equal rows.
        let mut a = [[0.0; P]; D];
        for (k, row) in a.iter_mut().enumerate() {
            row[k.min(D - 2)] = 1.0;
        }
        assert_eq!(invert(&a).norm, f64::INFINITY);
    }
    let mut random = Random::new(3);
    check::<4, 4>(&mut random);
    check::<5, 8>(&mut random);
    check::<6, 8>(&mut random);
    check::<7, 8>(&mut random);
    check::<8, 8>(&mut random);
}
