//! Bounds of the filters against fractions: never exceeded, and not loose by orders of magnitude.

use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

use super::super::filter::{Test, barycentric, invert, minus};
use super::super::fine::Fine;
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
    let square = |r: &[BigRational]| r.iter().map(|x| x * x).sum::<BigRational>();
    let x = solved(a.iter().map(|r| [&r[..], &[square(r)]].concat()).collect())?;
    let d = from(p);
    let across: BigRational = x.iter().zip(&d).map(|(x, d)| x * d).sum();
    let columns = (0..D).map(|k| {
        let column: Vec<_> = a.iter().map(|r| r[k].clone()).collect();
        [&column[..], &[d[k].clone()]].concat()
    });
    Some((square(&d) - across, solved(columns.collect())?))
}

/// A simplex inside the unit cube, and a point: scattered, far away, thin, near a sphere.
fn drawn<const D: usize, const V: usize, const P: usize>(
    r: &mut Random,
    kind: u64,
) -> ([[f64; P]; V], [f64; P]) {
    let mut draw = || -> [f64; P] { std::array::from_fn(|k| if k < D { r.unit() } else { 0.0 }) };
    let mut v: [[f64; P]; V] = std::array::from_fn(|_| draw());
    let mut p = draw();
    match kind % 4 {
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
        _ => {}
    }
    (v, p)
}

fn gap(value: f64, truth: &BigRational) -> f64 {
    let value = BigRational::from_float(value).unwrap();
    (value - truth).abs().to_f64().unwrap()
}

/// Checks all bounds; returns the largest parts of them that errors have used.
fn check<const D: usize, const V: usize, const P: usize>() -> [f64; 4] {
    let mut r = Random::new(17 + D as u64);
    let mut used = [0.0f64; 4];
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
    }
    used
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
