//! Triangulations and hulls in flats against the definition, with the exact squares of all coordinates.

use std::collections::BTreeSet;

use num_bigint::BigInt;

use super::super::cell::Counts;
use super::super::flat::{hull_in_flat, sorted_in_flat, triangulate_in_flat};
use super::super::order::arranged;
use super::super::sites::{MOST, Rest};
use super::super::triangulate::inserted;
use super::super::validate::{Findings, validate_in_flat};
use super::super::{hull, triangulate};
use super::brute;
use super::numbers;
use super::sets::{Random, kinds};
use crate::base::arrays::Given;
use crate::base::watch::{IDLE, Pace};
use crate::base::wide::{lowest, scaled};

/// The rest of coordinates of one kind, an exact function of the first ones: nothing, a constant, copies,
/// steep ones, sums.
fn rests<const D: usize>(kind: u64, points: &[[f64; D]], r: &mut Random) -> Option<Vec<Rest>> {
    let count = if kind == 0 {
        0
    } else {
        1 + r.below((MOST - D) as u64) as usize
    };
    let mut found = vec![[0.0; MOST]; points.len()];
    for j in 0..count {
        let (a, b) = (r.below(D as u64) as usize, r.below(D as u64) as usize);
        let power = 2f64.powi(r.integer(-3, 3) as i32);
        for (p, rest) in points.iter().zip(&mut found) {
            rest[j] = match kind {
                1 => 0.1,
                2 => -p[a],
                3 => p[a] * power,
                _ => p[a] + p[b],
            };
            // Whether the sum is exact.
            let low = lowest(&[[p[a], p[b], rest[j]]], &[]);
            let at = |x: f64| scaled(x, low);
            if kind > 3 && at(rest[j]) != at(p[a]) + at(p[b]) {
                return None;
            }
        }
    }
    Some(found)
}

/// The simplices by the definition: weights are minus the squares of the rest.
fn defined<const D: usize, const V: usize>(
    points: &[[f64; D]],
    rest: &[Rest],
) -> BTreeSet<[u32; V]> {
    let low = lowest(points, &[]).min(lowest(rest, &[]));
    let units = |row: &[f64]| -> Vec<BigInt> { row.iter().map(|&x| scaled(x, low)).collect() };
    let all: BTreeSet<(Vec<BigInt>, Vec<BigInt>)> = points
        .iter()
        .zip(rest)
        .map(|(p, q)| (units(p), units(q)))
        .collect();
    let square = |q: &Vec<BigInt>| -> BigInt { q.iter().map(|x| -(x * x)).sum() };
    let (at, weights): (Vec<_>, Vec<_>) = all.into_iter().map(|(p, q)| (p, square(&q))).unzip();
    brute::regular(&at, &weights)
}

fn add<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    rest: &[Rest],
    all: &mut Counts,
) {
    let (sites, rows, _) = sorted_in_flat::<D, P>(points, rest).unwrap();
    let order = arranged::<D, P>(&sites.scaled).unwrap();
    let mesh = inserted::<D, V, P>(sites, &rows, &order, &mut Pace::new(&IDLE, 1000)).unwrap();
    all.fine += mesh.counts.fine;
    all.zeros += mesh.counts.zeros;
    all.exact += mesh.counts.exact;
    all.ties += mesh.counts.ties;
}

fn check<const D: usize, const V: usize, const P: usize>(seeds: u64, all: &mut Counts) {
    for seed in 0..seeds {
        let mut r = Random::new(seed * 31 + D as u64);
        let mut sets = kinds::<D>(&mut r);
        // Points on a sphere of the flat up to rounding, where the first coordinate counts five times.
        if let Some((_, near)) = sets.iter().find(|(kind, _)| *kind == "near a sphere") {
            let squeezed = near.iter().map(|p| {
                let mut q = *p;
                q[0] /= 5f64.sqrt();
                q
            });
            sets.push(("near an ellipsoid", squeezed.collect()));
        }
        for (kind, points) in sets {
            if brute::rank(&points) < D {
                continue;
            }
            for of_rest in if D < 5 { 0..6 } else { 2..6 } {
                let name = format!("{D}-D {kind} {of_rest} {seed}");
                let rest = if kind == "near an ellipsoid" {
                    Some(
                        points
                            .iter()
                            .map(|p| std::array::from_fn(|k| if k == 0 { 2.0 * p[0] } else { 0.0 }))
                            .collect(),
                    )
                } else {
                    rests(of_rest, &points, &mut r)
                };
                let Some(rest) = rest else { continue };
                let made = triangulate_in_flat::<D, V, P>(&points, &rest, &IDLE).unwrap();
                add::<D, V, P>(&points, &rest, all);
                let at: Vec<_> = brute::integers(&points);
                let distinct: Vec<_> = at.iter().collect::<BTreeSet<_>>().into_iter().collect();
                let number = |row: u32| distinct.binary_search(&&at[row as usize]).unwrap() as u32;
                let found: Vec<[u32; V]> = made.simplices.iter().map(|v| v.map(number)).collect();
                assert_eq!(
                    numbers(&found),
                    defined(&points, &rest),
                    "{name}: {points:?} {rest:?}"
                );
                if of_rest < 2 && kind != "near an ellipsoid" {
                    assert_eq!(
                        made,
                        triangulate::<D, V, P>(&points, &IDLE).unwrap(),
                        "{name}"
                    );
                }
                let signed = |v: &[u32; V]| v.map(|i| i as i32);
                let simplices: Vec<_> = made.simplices.iter().map(signed).collect();
                let given = Given {
                    points: &points,
                    simplices: &simplices,
                    neighbors: &made.neighbors,
                };
                let faults = validate_in_flat::<D, V, P>(given, &rest, &IDLE).unwrap();
                assert_eq!(faults, Findings::default(), "{name}");
                check_hull::<D, V, P>(&points, &rest, &name);
            }
        }
    }
}

/// The extreme points are those of the projections; facets are the boundary of the triangulation of these
/// points in the flat.
fn check_hull<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    rest: &[Rest],
    name: &str,
) {
    let found = hull_in_flat::<D, V, P>(points, rest, &IDLE).unwrap();
    let plain = hull::<D, V, P>(points, &IDLE).unwrap();
    let vertices =
        |facets: &[[u32; D]]| -> BTreeSet<u32> { facets.as_flattened().iter().copied().collect() };
    let extreme = vertices(&found.simplices);
    assert_eq!(extreme, vertices(&plain.simplices), "{name}");
    let kept: Vec<u32> = extreme.into_iter().collect();
    let corners: Vec<_> = kept.iter().map(|&v| points[v as usize]).collect();
    let others: Vec<_> = kept.iter().map(|&v| rest[v as usize]).collect();
    let made = triangulate_in_flat::<D, V, P>(&corners, &others, &IDLE).unwrap();
    let mut boundary = BTreeSet::new();
    for (v, n) in made.simplices.iter().zip(&made.neighbors) {
        for k in (0..V).filter(|&k| n[k] < 0) {
            let mut facet: Vec<u32> = (0..V)
                .filter(|&i| i != k)
                .map(|i| kept[v[i] as usize])
                .collect();
            facet.sort_unstable();
            boundary.insert(facet);
        }
    }
    let facets: BTreeSet<Vec<u32>> = numbers(&found.simplices)
        .iter()
        .map(|v| v.to_vec())
        .collect();
    assert_eq!(facets, boundary, "{name}");
}

#[test]
fn small_sets_are_as_defined() {
    let mut all = Counts::default();
    check::<2, 3, 4>(4, &mut all);
    check::<3, 4, 4>(2, &mut all);
    check::<4, 5, 4>(1, &mut all);
    check::<5, 6, 8>(1, &mut all);
    check::<7, 8, 8>(1, &mut all);
    for count in [all.fine, all.zeros, all.exact, all.ties] {
        assert!(count > 50, "{all:?}");
    }
}

#[test]
fn points_that_leave_the_flat_are_found_at_another_place() {
    // A wrong height is a fault, although the projections are right.
    let mut r = Random::new(3);
    let points: Vec<[f64; 3]> = (0..40).map(|_| std::array::from_fn(|_| r.unit())).collect();
    let rest: Vec<Rest> = points
        .iter()
        .map(|p| std::array::from_fn(|k| if k == 0 { 4.0 * p[1] } else { 0.0 }))
        .collect();
    let made = triangulate_in_flat::<3, 4, 4>(&points, &rest, &IDLE).unwrap();
    let simplices: Vec<_> = made.simplices.iter().map(|v| v.map(|i| i as i32)).collect();
    let given = Given {
        points: &points,
        simplices: &simplices,
        neighbors: &made.neighbors,
    };
    let none = vec![[0.0; MOST]; 40];
    let faults = validate_in_flat::<3, 4, 4>(given, &none, &IDLE).unwrap();
    assert!(!faults.delaunay.is_empty());
}
