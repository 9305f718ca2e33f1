//! Numbers of single simplices against fractions, and point location against all simplices.

use delone_predicates::Sign;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::super::simplex::{circumcenter, orientation, rough, sides, transform, volume, weights};
use super::super::walk::hurry;
use super::super::{Hyper, Weighed, nearest, triangulate, within};
use super::brute;
use super::sets::{Random, kinds};
use crate::base::arrays::{Given, Side};
use crate::base::watch::IDLE;
use crate::locate::{Batch, Cache, Locator, find};

fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap()
}

/// The determinant of a matrix, and its solution for a right side in the last column.
fn eliminated(mut m: Vec<Vec<BigRational>>) -> (BigRational, Vec<BigRational>) {
    let (n, mut determinant) = (m.len(), BigRational::one());
    for k in 0..n {
        let Some(pivot) = (k..n).find(|&i| !m[i][k].is_zero()) else {
            return (BigRational::zero(), Vec::new());
        };
        if pivot != k {
            m.swap(k, pivot);
            determinant = -determinant;
        }
        determinant *= m[k][k].clone();
        for i in (0..n).filter(|&i| i != k) {
            let factor = &m[i][k] / &m[k][k];
            for j in k..=n {
                let change = &factor * &m[k][j];
                m[i][j] -= change;
            }
        }
    }
    let solution = (0..n).map(|k| &m[k][n] / &m[k][k]).collect();
    (determinant, solution)
}

/// Barycentric coordinates of `q`, and the determinant of the differences.
fn coordinates<const D: usize, const V: usize>(
    corners: &[[f64; D]; V],
    q: &[f64; D],
) -> (BigRational, Vec<BigRational>) {
    let rows = (0..D).map(|k| {
        let difference = |p: &[f64; D]| exact(p[k]) - exact(corners[0][k]);
        corners[1..].iter().chain([q]).map(difference).collect()
    });
    let (determinant, rest) = eliminated(rows.collect());
    let first = BigRational::one() - rest.iter().sum::<BigRational>();
    (determinant, [vec![first], rest].concat())
}

/// Whether `found` is off by at most `share` of `size`.
fn is_near(found: f64, truth: &BigRational, share: f64, size: &BigRational) -> bool {
    (exact(found) - truth).abs() <= exact(share) * size.abs()
}

/// Points whose place in a simplex is known to be special, or is not.
fn queries<const D: usize, const V: usize>(
    corners: &[[f64; D]; V],
    random: &mut Random,
) -> Vec<[f64; D]> {
    let mean = |n: usize| -> [f64; D] {
        std::array::from_fn(|k| corners[..n].iter().map(|p| p[k] / n as f64).sum())
    };
    let near = random.below(V as u64) as usize;
    let mut found = vec![mean(1), mean(2), mean(4), mean(V), corners[near]];
    found.push(std::array::from_fn(|k| {
        corners[near][k] + (random.unit() - 0.5) * (corners[(near + 1) % V][k] - corners[near][k])
    }));
    found
}

fn check<const D: usize, const V: usize, const P: usize>(seeds: u64) -> [usize; 2] {
    let (mut solid, mut flat) = (0, 0);
    for seed in 0..seeds {
        let mut random = Random::new(seed * 77 + D as u64);
        for (kind, points) in kinds::<D>(&mut random) {
            if points.len() < V {
                continue;
            }
            let mut rows: Vec<usize> = (0..points.len()).collect();
            random.shuffle(&mut rows);
            let corners: [[f64; D]; V] = std::array::from_fn(|i| points[rows[i]]);
            let name = format!("{D}-D {kind} {seed}: {corners:?}");
            let (determinant, _) = coordinates(&corners, &corners[0]);
            let truth = match determinant.cmp(&BigRational::zero()) {
                std::cmp::Ordering::Less => Sign::Negative,
                std::cmp::Ordering::Equal => Sign::Zero,
                std::cmp::Ordering::Greater => Sign::Positive,
            };
            assert_eq!(orientation::<D, V, P>(&corners), truth, "{name}");
            if determinant.is_zero() {
                flat += 1;
                assert_eq!(volume::<D, V, P>(&corners), 0.0);
                continue;
            }
            solid += 1;
            numbers::<D, V, P>(&corners, &determinant, &name);
            for q in queries(&corners, &mut random) {
                places::<D, V, P>(&corners, &q, &name);
            }
        }
    }
    [solid, flat]
}

/// Volume, center and map.
fn numbers<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    determinant: &BigRational,
    name: &str,
) {
    let factorial: BigInt = (1..=D).map(BigInt::from).product();
    let truth = determinant.abs() / BigRational::from_integer(factorial);
    let found = volume::<D, V, P>(corners);
    assert!(is_near(found, &truth, 1e-14, &truth), "{name}: {found}");
    let rows = (1..V).map(|i| {
        let a: Vec<_> = (0..D)
            .map(|k| exact(corners[i][k]) - exact(corners[0][k]))
            .collect();
        let square = a.iter().map(|x| x * x).sum::<BigRational>();
        [a, vec![square]].concat()
    });
    let (_, twice) = eliminated(rows.collect());
    let center = circumcenter::<D, V, P>(corners);
    for k in 0..D {
        let truth = exact(corners[0][k]) + &twice[k] / BigRational::from_integer(2.into());
        assert!(
            is_near(center[k], &truth, 4.0 * f64::EPSILON, &truth),
            "{name}: {center:?}"
        );
    }
    let map = transform::<D, V, P>(corners);
    assert_eq!(map[D], corners[D]);
    for j in 0..D {
        // Column j of the inverse: the coordinates of a unit vector from the last corner.
        let from_last: [[f64; D]; V] = std::array::from_fn(|i| corners[(i + D) % V]);
        let rows = (0..D).map(|k| {
            let difference = |p: &[f64; D]| exact(p[k]) - exact(from_last[0][k]);
            let unit = BigRational::from_integer(i32::from(k == j).into());
            from_last[1..]
                .iter()
                .map(difference)
                .chain([unit])
                .collect()
        });
        let (_, column) = eliminated(rows.collect());
        for i in 0..D {
            let length = map[i].iter().map(|x| x.abs()).fold(0.0, f64::max);
            assert!(
                is_near(map[i][j], &column[i], 1e-13, &exact(length)),
                "{name}: {map:?}"
            );
        }
    }
}

/// Sides and weights.
fn places<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    q: &[f64; D],
    name: &str,
) {
    let (_, truth) = coordinates(corners, q);
    let found = sides::<D, V, P>(corners, q);
    for (i, l) in truth.iter().enumerate() {
        let sign = if l.is_zero() {
            Sign::Zero
        } else if l.is_negative() {
            Sign::Negative
        } else {
            Sign::Positive
        };
        assert_eq!(found[i], sign, "{name} at {q:?}");
    }
    if truth.iter().all(|l| !l.is_negative()) {
        let on = std::array::from_fn(|i| truth[i].is_zero());
        let found = weights::<D, V, P>(corners, on, q);
        for (i, l) in truth.iter().enumerate() {
            assert!(is_near(found[i], l, 1e-14, l), "{name} at {q:?}: {found:?}");
        }
    }
}

#[test]
fn numbers_are_those_of_fractions() {
    for counts in [
        check::<4, 5, 4>(12),
        check::<5, 6, 8>(6),
        check::<6, 7, 8>(4),
        check::<7, 8, 8>(3),
        check::<8, 9, 8>(3),
    ] {
        assert!(counts.into_iter().all(|count| count > 5), "{counts:?}");
    }
}

fn located<const D: usize, const V: usize, const P: usize>(seeds: u64)
where
    Hyper<D>: Weighed<D, V>,
{
    for seed in 0..seeds {
        let mut random = Random::new(seed * 31 + D as u64);
        for (kind, points) in kinds::<D>(&mut random) {
            let Ok(made) = triangulate::<D, V, P>(&points, &IDLE) else {
                continue;
            };
            let simplices: Vec<[i32; V]> =
                made.simplices.iter().map(|v| v.map(|i| i as i32)).collect();
            let given = Given {
                points: &points,
                simplices: &simplices,
                neighbors: &made.neighbors,
            };
            let mut at: Vec<[f64; D]> = points.clone();
            for pair in points.windows(2) {
                at.push(std::array::from_fn(|k| pair[0][k] / 2.0 + pair[1][k] / 2.0));
                at.push(std::array::from_fn(|k| {
                    pair[0][k] + (pair[1][k] - pair[0][k]) * 1.3
                }));
            }
            at.push([f64::NAN; D]);
            let kept = Cache::<Hyper<D>, D, V>::of(&given, &IDLE).unwrap();
            let batch = Batch {
                locator: Locator::new(given, &kept, &IDLE),
                queries: &at,
                workers: 2,
                watch: &IDLE,
            };
            let found = within(&batch).unwrap();
            assert_eq!(found.simplex, find(&batch).unwrap());
            let near = nearest(&batch).unwrap();
            for (row, q) in at.iter().enumerate() {
                let is_in =
                    |t: &usize| !sides::<D, V, P>(&given.corners(*t), q).contains(&Sign::Negative);
                let finite = !q[0].is_nan();
                let first = (0..simplices.len()).find(|t| finite && is_in(t));
                let expected = first.map_or(-1, |t| t as i32);
                assert_eq!(found.simplex[row], expected, "{D}-D {kind} {seed}: {q:?}");
                let weights = &found.weights[V * row..V * row + V];
                assert_eq!(weights[0].is_nan(), expected < 0);
                if finite {
                    let rows = brute::integers(&[&points[..], &[*q]].concat());
                    let distance = |v: usize| -> BigInt {
                        (0..D)
                            .map(|k| (&rows[v][k] - &rows[points.len()][k]).pow(2))
                            .sum()
                    };
                    let best = (0..points.len()).min_by_key(|&v| distance(v)).unwrap();
                    assert_eq!(near[row], best as i32, "{D}-D {kind} {seed}: {q:?}");
                }
            }
        }
    }
}

#[test]
fn points_are_located_in_the_first_simplex_that_contains_them() {
    located::<4, 5, 4>(3);
    located::<5, 6, 8>(2);
    located::<6, 7, 8>(1);
    located::<8, 9, 8>(1);
}

/// Rounded steps lead from any simplex to the one that contains a query, in general position.
#[test]
fn rounded_steps_end_where_the_query_is() {
    fn check<const D: usize, const N: usize, const P: usize>(n: usize) {
        let mut random = Random::new(D as u64);
        let points: Vec<[f64; D]> = (0..n).map(|_| [0; D].map(|_| random.unit())).collect();
        let made = triangulate::<D, N, P>(&points, &IDLE).unwrap();
        let simplices: Vec<[i32; N]> = made.simplices.iter().map(|v| v.map(|i| i as i32)).collect();
        let given = Given {
            points: &points,
            simplices: &simplices,
            neighbors: &made.neighbors,
        };
        let (mut walks, mut right) = (0, 0);
        while walks < 200 {
            // A point in one simplex, and another simplex, as far away as any.
            let [home, from] = [0; 2].map(|_| random.below(simplices.len() as u64) as usize);
            let mut q = [0.0; D];
            for p in given.corners(home) {
                for k in 0..D {
                    q[k] += p[k] / N as f64;
                }
            }
            let (l, bound, inverse) = rough::<D, N, P>(&given.corners(from), &q);
            let corner = (0..N).min_by(|&i, &j| l[i].total_cmp(&l[j])).unwrap();
            if l[corner] >= -bound {
                continue;
            }
            walks += 1;
            let at = Side {
                simplex: from,
                corner,
            };
            right += usize::from(hurry(&given, at, &q, l, inverse, 10_000) == home);
        }
        assert!(right >= 190, "{D}-D: {right} of {walks}");
    }
    check::<4, 5, 4>(300);
    check::<5, 6, 8>(120);
    check::<6, 7, 8>(60);
    check::<8, 9, 8>(30);
}
