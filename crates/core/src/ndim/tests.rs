//! Whole triangulations against the definition, and properties of large ones.

mod bounds;
mod brute;
mod flats;
mod hulls;
mod lazily;
mod regular;
pub(super) mod sets;
mod simplices;

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::cell::{Counts, Mesh};
use super::order::arranged;
use super::triangulate::{inserted, sorted, triangulate};
use crate::base::error::{Error, Result};
use crate::base::watch::{IDLE, Pace, Watch};
use brute::{canonical, orientation, rank};
use sets::{Random, kinds};

/// The finite simplices as sets of numbers in lexicographic order.
fn numbers<const V: usize>(simplices: &[[u32; V]]) -> BTreeSet<[u32; V]> {
    let ascending = |mut v: [u32; V]| {
        v.sort_unstable();
        v
    };
    simplices.iter().copied().map(ascending).collect()
}

/// A mesh of all points, inserted in random order.
fn shuffled<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    random: &mut Random,
) -> Result<Mesh<D, V, P>> {
    let (sites, rows, _) = sorted::<D, P>(points)?;
    let mut order: Vec<u32> = (0..sites.len() as u32).collect();
    random.shuffle(&mut order);
    inserted(sites, &rows, &order, &mut Pace::new(&IDLE, 1000))
}

/// Checks small hostile sets against all subsets; adds what decided.
fn check_small<const D: usize, const V: usize, const P: usize>(seeds: u64, all: &mut Counts) {
    for seed in 0..seeds {
        let mut random = Random::new(seed * 100 + D as u64);
        for (kind, points) in kinds::<D>(&mut random) {
            let made = shuffled::<D, V, P>(&points, &mut random);
            let rank = rank(&points);
            let mesh = match made {
                Ok(mesh) => mesh,
                Err(Error::Flat { rows, .. }) => {
                    assert!(rank < D, "{D}-D {kind} {seed}: not flat");
                    assert_eq!(rows.len(), rank + 1, "{D}-D {kind} {seed}");
                    let spanning: Vec<_> = rows.iter().map(|&i| points[i as usize]).collect();
                    assert_eq!(brute::rank(&spanning), rank, "{D}-D {kind} {seed}");
                    continue;
                }
                Err(other) => panic!("{D}-D {kind} {seed}: {other}"),
            };
            assert_eq!(rank, D, "{D}-D {kind} {seed}: flat");
            let (simplices, neighbors) = mesh.export().unwrap();
            let found = numbers(&simplices);
            assert_eq!(found.len(), simplices.len());
            assert_eq!(found, canonical(&points), "{D}-D {kind} {seed}: {points:?}");
            check_mesh(&points, &simplices, &neighbors);
            let c = mesh.counts;
            all.fine += c.fine;
            all.zeros += c.zeros;
            all.exact += c.exact;
            all.ties += c.ties;
            all.walks += c.walks;
        }
    }
}

/// Neighbors share all but the opposite corners, and simplices are positively oriented.
fn check_mesh<const D: usize, const V: usize>(
    points: &[[f64; D]],
    simplices: &[[u32; V]],
    neighbors: &[[i32; V]],
) {
    let at = brute::distinct(points);
    for (s, (v, n)) in simplices.iter().zip(neighbors).enumerate() {
        assert!(orientation(&at, v) > 0);
        for k in 0..V {
            let Ok(t) = usize::try_from(n[k]) else {
                continue;
            };
            let back = neighbors[t].iter().position(|&x| x == s as i32).unwrap();
            for j in (0..V).filter(|&j| j != k) {
                let place = simplices[t].iter().position(|&u| u == v[j]);
                assert!(place.is_some_and(|place| place != back));
            }
            assert!(!simplices[t].contains(&v[k]));
        }
    }
}

#[test]
fn small_sets_are_as_defined() {
    let mut all = Counts::default();
    check_small::<2, 3, 4>(6, &mut all);
    check_small::<3, 4, 4>(6, &mut all);
    check_small::<4, 5, 4>(3, &mut all);
    check_small::<5, 6, 8>(2, &mut all);
    check_small::<6, 7, 8>(1, &mut all);
    check_small::<7, 8, 8>(1, &mut all);
    check_small::<8, 9, 8>(1, &mut all);
    // Each stage has decided something.
    for count in [all.fine, all.zeros, all.exact, all.ties, all.walks] {
        assert!(count > 20, "{all:?}");
    }
}

/// A grid with the given coordinates along all axes.
fn grid<const D: usize>(axes: [&[f64]; D]) -> Vec<[f64; D]> {
    let mut points = vec![[0.0; D]];
    for (k, axis) in axes.into_iter().enumerate() {
        points = points
            .iter()
            .flat_map(|p| {
                axis.iter().map(move |&x| {
                    let mut q = *p;
                    q[k] = x;
                    q
                })
            })
            .collect();
    }
    points
}

/// The simplices of Kuhn in each cell: along each, all coordinates grow.
fn check_kuhn<const D: usize, const V: usize, const P: usize>(axes: [&[f64]; D]) {
    let points = grid(axes);
    let cells: usize = axes.iter().map(|axis| axis.len() - 1).product();
    let made = triangulate::<D, V, P>(&points, &IDLE).unwrap();
    let paths: usize = (1..=D).product();
    assert_eq!(made.simplices.len(), cells * paths);
    for mut v in made.simplices {
        v.sort_unstable();
        for pair in v.windows(2) {
            let [p, q] = [pair[0], pair[1]].map(|i| points[i as usize]);
            assert!((0..D).all(|k| p[k] <= q[k]));
        }
    }
}

#[test]
fn grids_have_the_simplices_of_kuhn() {
    let (two, even, uneven) = ([0.0, 1.0], [0.0, 1.0, 2.0, 3.0], [0.1, 0.7, 1.1, 5e3]);
    check_kuhn::<2, 3, 4>([&even, &uneven]);
    check_kuhn::<3, 4, 4>([&uneven; 3]);
    check_kuhn::<4, 5, 4>([&even, &two, &uneven, &even]);
    check_kuhn::<4, 5, 4>([&uneven[..3]; 4]);
    check_kuhn::<5, 6, 8>([&even, &two, &two, &uneven[..3], &two]);
    check_kuhn::<6, 7, 8>([&two; 6]);
    check_kuhn::<7, 8, 8>([&two; 7]);
}

/// Points on the unit sphere, rounded.
fn sphere<const D: usize>(n: usize, random: &mut Random) -> Vec<[f64; D]> {
    let mut points = Vec::new();
    while points.len() < n {
        let p: [f64; D] = std::array::from_fn(|_| 2.0 * random.unit() - 1.0);
        let square: f64 = p.iter().map(|x| x * x).sum();
        if square < 1.0 {
            points.push(p.map(|x| x / square.sqrt()));
        }
    }
    points
}

#[test]
fn the_order_of_rows_and_powers_of_two_do_not_matter() {
    let mut random = Random::new(3);
    let uniform: Vec<[f64; 4]> = (0..200)
        .map(|_| std::array::from_fn(|_| random.unit()))
        .collect();
    let lattice: Vec<[f64; 4]> = (0..120)
        .map(|_| std::array::from_fn(|_| (random.below(5) as f64) / 3.0))
        .collect();
    for points in [uniform, sphere(120, &mut random), lattice] {
        let mesh = triangulate::<4, 5, 4>(&points, &IDLE).unwrap();
        let right = numbers(&mesh.simplices);
        // Repeated rows change with the order; simplices as coordinates do not.
        let coordinates = |points: &[[f64; 4]], simplices: &[[u32; 5]]| {
            let mut all: Vec<_> = simplices
                .iter()
                .map(|v| v.map(|i| points[i as usize]))
                .collect();
            for v in &mut all {
                v.sort_by(|a, b| a.partial_cmp(b).unwrap());
            }
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            all
        };
        let mut other = points.clone();
        random.shuffle(&mut other);
        let again = triangulate::<4, 5, 4>(&other, &IDLE).unwrap();
        assert_eq!(
            coordinates(&points, &mesh.simplices),
            coordinates(&other, &again.simplices)
        );
        for power in [-960, -500, 500, 1000] {
            let scaled: Vec<_> = points
                .iter()
                .map(|p| p.map(|x| x * 2f64.powi(power)))
                .collect();
            let made = triangulate::<4, 5, 4>(&scaled, &IDLE).unwrap();
            assert_eq!(numbers(&made.simplices), right, "2^{power}");
        }
    }
}

#[test]
fn every_range_of_doubles_is_taken() {
    let mut random = Random::new(9);
    let mut points: Vec<[f64; 4]> = (0..9)
        .map(|_| std::array::from_fn(|_| (random.below(9) as f64 - 4.0) * f64::from_bits(1)))
        .collect();
    points.extend(sets::corners::<4>(f64::MAX).into_iter().take(2));
    points.push([1.0, 2.0, 3.0, 5.0]);
    let (sites, ..) = sorted::<4, 4>(&points).unwrap();
    assert!(!sites.filtered);
    let mesh = shuffled::<4, 5, 4>(&points, &mut random).unwrap();
    assert_eq!(numbers(&mesh.export().unwrap().0), canonical(&points));
}

#[test]
fn duplicates_are_named_and_bad_rows_refused() {
    let mut points = sets::corners::<4>(1.0);
    points.truncate(9);
    points.push(points[3].map(|x| if x == 0.0 { -0.0 } else { x }));
    points.push(points[0]);
    let made = triangulate::<4, 5, 4>(&points, &IDLE).unwrap();
    assert_eq!(made.duplicates, [[9, 3], [10, 0]]);
    points[2][1] = f64::NAN;
    let refused = triangulate::<4, 5, 4>(&points, &IDLE);
    assert!(matches!(refused, Err(Error::NonFinite { ref rows, count: 1 }) if rows == &[2]));
    let few = triangulate::<4, 5, 4>(&points[3..6], &IDLE).unwrap_err();
    assert!(
        few.to_string().starts_with("3 distinct points are too few"),
        "{few}"
    );
    assert!(
        triangulate::<4, 5, 4>(&[], &IDLE)
            .unwrap_err()
            .rows()
            .is_empty()
    );
}

#[test]
fn work_is_interrupted_soon() {
    let mut random = Random::new(5);
    let points: Vec<[f64; 5]> = (0..400)
        .map(|_| std::array::from_fn(|_| random.unit()))
        .collect();
    let asked = AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) == 7;
    let found = triangulate::<5, 6, 8>(&points, &Watch::new(&stop));
    assert_eq!(found, Err(Error::Interrupted));
    assert_eq!(asked.into_inner(), 8);
    // The order of checks is that of the work: a larger set asks more often.
    let asked = AtomicUsize::new(0);
    let count = || asked.fetch_add(1, Ordering::Relaxed) > usize::MAX - 2;
    let (sites, ..) = sorted::<5, 8>(&points).unwrap();
    assert_eq!(arranged::<5, 8>(&sites.scaled).unwrap().len(), 400);
    triangulate::<5, 6, 8>(&points, &Watch::new(&count)).unwrap();
    assert!(asked.into_inner() > 100);
}
