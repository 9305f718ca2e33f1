//! Simplices that are found without the triangulation, against all simplices.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use num_bigint::BigInt;

use super::super::lazy::{Counts, Lazy, Limits, Located};
use super::super::{Simplices, triangulate};
use super::brute::{canonical, integers, orientation, rank};
use super::sets::{Random, kinds};
use crate::base::error::Error;
use crate::base::watch::{IDLE, Watch};

fn add(all: &mut Counts, some: Counts) {
    all.again += some.again;
    all.proposed += some.proposed;
    all.pivots += some.pivots;
    all.apart += some.apart;
    all.walks += some.walks;
}

/// Queries of all kinds: anywhere, sites, means of sites, by an ulp beside these, and far away.
fn queries<const D: usize>(points: &[[f64; D]], r: &mut Random, count: usize) -> Vec<[f64; D]> {
    let mut all = Vec::new();
    let site = |r: &mut Random| points[r.below(points.len() as u64) as usize];
    for _ in 0..count {
        let mut mean = [0.0; D];
        let parts = 1 + r.below(D as u64 + 2) as usize;
        for _ in 0..parts {
            let p = site(r);
            mean = std::array::from_fn(|k| mean[k] + p[k] / parts as f64);
        }
        let (a, b) = (site(r), site(r));
        let middle: [f64; D] = std::array::from_fn(|k| 0.5 * a[k] + 0.5 * b[k]);
        let share = r.unit();
        let between = std::array::from_fn(|k| a[k] + share * (b[k] - a[k]));
        let beside = middle.map(|x| f64::from_bits(x.to_bits() ^ r.below(2)));
        let far = mean.map(|x| 3.0 * x + 1.0);
        all.extend([mean, a, middle, between, beside, far]);
    }
    all
}

/// Whether a point is in a closed simplex.
fn encloses<const D: usize>(at: &[Vec<BigInt>], v: &[u32], q: &[BigInt]) -> bool {
    let sign = orientation(at, v);
    (0..v.len()).all(|i| {
        let mut with: Vec<Vec<BigInt>> = v.iter().map(|&k| at[k as usize].clone()).collect();
        with[i] = q.to_vec();
        let all: Vec<u32> = (0..=D as u32).collect();
        orientation(&with, &all) * sign >= 0
    })
}

/// Asks for small hostile sets, where every simplex is known.
fn check_small<const D: usize, const V: usize>(seeds: u64, limits: Limits, all: &mut Counts) {
    for seed in 0..seeds {
        let mut r = Random::new(seed * 31 + D as u64);
        for (kind, points) in kinds::<D>(&mut r) {
            let name = format!("{D}-D {kind} {seed}");
            let lazy = match Lazy::limited(points.as_flattened(), D, limits, &IDLE) {
                Ok(lazy) => lazy,
                Err(Error::Flat { rows, .. }) => {
                    assert!(rank(&points) < D, "{name}: not flat");
                    assert_eq!(rows.len(), rank(&points) + 1, "{name}");
                    continue;
                }
                Err(other) => panic!("{name}: {other}"),
            };
            let asked = queries(&points, &mut r, 6);
            let found = lazy.locate(asked.as_flattened(), 1, &IDLE).unwrap();
            add(all, found.counts);
            // Points with the queries in one unit; the simplices by numbers of distinct points.
            let together = integers(&[&points[..], &asked[..]].concat());
            let (at, of_queries) = together.split_at(points.len());
            let sorted: Vec<&Vec<BigInt>> =
                at.iter().collect::<BTreeSet<_>>().into_iter().collect();
            let number = |row: i32| sorted.binary_search(&&at[row as usize]).unwrap() as u32;
            let distinct: Vec<Vec<BigInt>> = sorted.iter().map(|p| (*p).clone()).collect();
            let simplices: BTreeSet<[u32; V]> = canonical(&points);
            for (i, q) in of_queries.iter().enumerate() {
                let rows = &found.rows[i * V..][..V];
                let holding = simplices.iter().filter(|v| encloses::<D>(&distinct, *v, q));
                if rows[0] < 0 {
                    assert_eq!(holding.count(), 0, "{name}: query {i} is inside");
                    continue;
                }
                let mut v: Vec<u32> = rows.iter().map(|&row| number(row)).collect();
                v.sort_unstable();
                assert!(
                    holding.clone().any(|w| w[..] == v[..]),
                    "{name}: query {i} is not in a simplex of the triangulation"
                );
                let weights = &found.weights[i * V..][..V];
                let sum: f64 = weights.iter().sum();
                assert!(
                    (sum - 1.0).abs() < 1e-14 && weights.iter().all(|&w| w >= 0.0),
                    "{name}"
                );
                for k in 0..D {
                    let mean: f64 = (0..V)
                        .map(|j| weights[j] * points[rows[j] as usize][k])
                        .sum();
                    let size = points.iter().map(|p| p[k].abs()).fold(0.0, f64::max);
                    assert!(
                        (mean - asked[i][k]).abs() <= 1e-14 * size,
                        "{name}: query {i} {:?}: {weights:?} {rows:?}",
                        asked[i]
                    );
                }
            }
        }
    }
}

#[test]
fn small_sets_have_the_canonical_simplex() {
    let mut all = Counts::default();
    let limits = Limits::USUAL;
    check_small::<2, 3>(8, limits, &mut all);
    check_small::<3, 4>(5, limits, &mut all);
    check_small::<4, 5>(3, limits, &mut all);
    check_small::<5, 6>(2, limits, &mut all);
    check_small::<6, 7>(1, limits, &mut all);
    println!("{all:?}");
    for count in [all.proposed, all.pivots, all.apart, all.walks, all.again] {
        assert!(count > 20, "{all:?}");
    }
}

#[test]
fn steps_that_end_find_the_same_simplices() {
    // Without proposals, exact pivots lead to a simplex and a walk from there. Without pivots by the
    // largest conflict, those by the smallest number remain.
    for (proposals, largest) in [(0, 200), (0, 0), (1, 0), (60, 0), (60, 1)] {
        let mut all = Counts::default();
        let limits = Limits { proposals, largest };
        check_small::<2, 3>(3, limits, &mut all);
        check_small::<3, 4>(2, limits, &mut all);
        check_small::<4, 5>(1, limits, &mut all);
        check_small::<5, 6>(1, limits, &mut all);
        if proposals == 0 {
            assert_eq!((all.proposed, all.pivots), (0, 0));
        }
        assert!(all.walks > 20, "{all:?}");
    }
}

/// Asks for larger sets; returns how.
fn check_large<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    r: &mut Random,
    count: usize,
) -> Counts {
    let lazy = Lazy::new(points.as_flattened(), D, &IDLE).unwrap();
    let asked = queries(points, r, count);
    let found = lazy.locate(asked.as_flattened(), 1, &IDLE).unwrap();
    let Simplices { simplices, .. } = triangulate::<D, V, P>(points, &IDLE).unwrap();
    let known: BTreeSet<Vec<u32>> = simplices
        .iter()
        .map(|v| {
            let mut v = v.to_vec();
            v.sort_unstable();
            v
        })
        .collect();
    for (i, rows) in found.rows.chunks_exact(V).enumerate() {
        if rows[0] < 0 {
            continue;
        }
        let mut v: Vec<u32> = rows.iter().map(|&row| row as u32).collect();
        v.sort_unstable();
        assert!(known.contains(&v), "query {i}");
        // More queries than one task has: each with its own simplex and weights.
        let weights = &found.weights[i * V..][..V];
        for k in 0..D {
            let mean: f64 = (0..V)
                .map(|j| weights[j] * points[rows[j] as usize][k])
                .sum();
            assert!((mean - asked[i][k]).abs() < 1e-13, "query {i}");
        }
    }
    // The number of threads does not matter.
    let again = lazy.locate(asked.as_flattened(), 3, &IDLE).unwrap();
    let same = |a: &Located, b: &Located| {
        let bits = |l: &Located| l.weights.iter().map(|w| w.to_bits()).collect::<Vec<_>>();
        a.rows == b.rows && bits(a) == bits(b)
    };
    assert!(same(&found, &again));
    found.counts
}

#[test]
fn larger_sets_have_the_simplices_of_their_triangulation() {
    let mut r = Random::new(11);
    let uniform: Vec<[f64; 4]> = (0..1500)
        .map(|_| std::array::from_fn(|_| r.unit()))
        .collect();
    println!("{:?}", check_large::<4, 5, 4>(&uniform, &mut r, 60));
    let clusters: Vec<[f64; 5]> = (0..250)
        .map(|i| std::array::from_fn(|_| (i % 3) as f64 + 1e-6 * r.unit()))
        .collect();
    println!("{:?}", check_large::<5, 6, 8>(&clusters, &mut r, 40));
    let lattice: Vec<[f64; 4]> = (0..300)
        .map(|_| std::array::from_fn(|_| r.below(4) as f64 / 3.0))
        .collect();
    println!("{:?}", check_large::<4, 5, 4>(&lattice, &mut r, 40));
    let on_sphere: Vec<[f64; 4]> = (0..300)
        .map(|_| {
            let p: [f64; 4] = std::array::from_fn(|_| r.unit() - 0.5);
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            p.map(|x| x / length)
        })
        .collect();
    println!("{:?}", check_large::<4, 5, 4>(&on_sphere, &mut r, 40));
}

/// Points with many coordinates: each simplex by its definition, as no triangulation can be made.
fn check_high<const D: usize>(points: &[[f64; D]], r: &mut Random, count: usize) -> Counts {
    let lazy = Lazy::new(points.as_flattened(), D, &IDLE).unwrap();
    let asked = queries(points, r, count);
    let found = lazy.locate(asked.as_flattened(), 2, &IDLE).unwrap();
    let mut inside = 0;
    for (i, rows) in found.rows.chunks_exact(D + 1).enumerate() {
        if rows[0] < 0 {
            // Sites are inside, and few other points are.
            assert_ne!(i % 6, 1, "query {i}");
            continue;
        }
        inside += 1;
        let weights = &found.weights[i * (D + 1)..][..D + 1];
        for k in 0..D {
            let mean: f64 = (0..=D)
                .map(|j| weights[j] * points[rows[j] as usize][k])
                .sum();
            assert!((mean - asked[i][k]).abs() < 1e-13, "query {i}");
        }
    }
    assert!(inside > count, "{inside}");
    found.counts
}

#[test]
fn many_coordinates_are_taken() {
    let mut r = Random::new(7);
    let uniform: Vec<[f64; 12]> = (0..300)
        .map(|_| std::array::from_fn(|_| r.unit()))
        .collect();
    println!("{:?}", check_high(&uniform, &mut r, 10));
    let wide: Vec<[f64; 30]> = (0..200)
        .map(|_| std::array::from_fn(|_| r.unit()))
        .collect();
    println!("{:?}", check_high(&wide, &mut r, 3));
}

#[test]
fn bad_points_are_refused_and_work_is_interrupted() {
    let flat = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [1.0, 1.0]];
    let refused = Lazy::new(flat.as_flattened(), 2, &IDLE).err().unwrap();
    assert!(matches!(refused, Error::Flat { ref rows, distinct: 3, .. } if rows.len() == 2));
    let bad = Lazy::new(&[0.0, 1.0, f64::NAN, 2.0, 1.0, f64::INFINITY], 2, &IDLE)
        .err()
        .unwrap();
    assert!(matches!(bad, Error::NonFinite { ref rows, count: 2 } if rows == &[1, 2]));
    assert!(Lazy::new(&[], 3, &IDLE).is_err());
    let mut r = Random::new(2);
    let points: Vec<f64> = (0..3000).map(|_| r.unit()).collect();
    let lazy = Lazy::new(&points, 3, &IDLE).unwrap();
    let nowhere = lazy.locate(&[f64::NAN, 0.5, 0.5], 1, &IDLE).unwrap();
    assert_eq!(nowhere.rows, [-1; 4]);
    let asked = AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) == 2;
    let ended = lazy.locate(&points, 1, &Watch::new(&stop));
    assert_eq!(ended, Err(Error::Interrupted));
}
