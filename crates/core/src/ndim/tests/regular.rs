//! Regular triangulations against the definition, and against those of the plane and of space.

use std::collections::BTreeSet;

use num_bigint::BigInt;

use super::super::validate::{Findings, validate_regular};
use super::super::{regular, triangulate};
use super::brute;
use super::numbers;
use super::sets::{Random, kinds};
use crate::base::arrays::Given;
use crate::base::error::Error;
use crate::base::watch::IDLE;
use crate::base::wide::{lowest, scaled};

/// Weights of one kind: none, small integers, random, close to the squares of lengths, huge,
/// tiny.
fn weights<const D: usize>(kind: u64, points: &[[f64; D]], r: &mut Random) -> Vec<f64> {
    let size = points
        .as_flattened()
        .iter()
        .fold(0.0f64, |m, x| m.max(x.abs()));
    points
        .iter()
        .map(|p| match kind {
            0 => 0.0,
            1 => r.integer(-2, 2),
            2 => (r.unit() - 0.5) * size * size,
            // Lifted points in one plane but for roundings: ties and near-ties.
            3 => p.iter().map(|x| x * x).sum(),
            4 => r.integer(-1, 1) * 1e3 * size * size,
            // Far below the rounding of powers: only integers detect it where points are
            // cospherical.
            _ => r.integer(-2, 2) * size * size * 2f64.powi(-140),
        })
        .collect()
}

/// The simplices by the definition, as sets of numbers of distinct points in lexicographic order.
fn defined<const D: usize, const V: usize>(
    points: &[[f64; D]],
    weights: &[f64],
) -> BTreeSet<[u32; V]> {
    let low = lowest(points, weights);
    let mut heaviest = std::collections::BTreeMap::new();
    for (p, &w) in points.iter().zip(weights) {
        let at: Vec<BigInt> = p.iter().map(|&x| scaled(x, low)).collect();
        let w = scaled(w, 2 * low);
        let kept = heaviest.entry(at).or_insert_with(|| w.clone());
        *kept = w.max(kept.clone());
    }
    let (at, weights): (Vec<_>, Vec<_>) = heaviest.into_iter().unzip();
    brute::regular(&at, &weights)
}

fn check<const D: usize, const V: usize, const P: usize>(seeds: u64) -> usize {
    let mut hidden = 0;
    for seed in 0..seeds {
        let mut r = Random::new(seed * 7 + D as u64);
        for (kind, points) in kinds::<D>(&mut r) {
            // By the definition, sets of many coordinates take long.
            for of_weights in if D < 5 { 0..6 } else { 2..6 } {
                let name = format!("{D}-D {kind} {of_weights} {seed}");
                let weights = weights(of_weights, &points, &mut r);
                let (made, stands_for) = match regular::<D, V, P>(&points, &weights, &IDLE) {
                    Ok(made) => made,
                    Err(Error::Flat { .. }) => {
                        assert!(brute::rank(&points) < D, "{name}");
                        continue;
                    }
                    Err(other) => panic!("{name}: {other}"),
                };
                // Rows as numbers of distinct points.
                let all: Vec<_> = brute::integers(&points);
                let distinct: Vec<_> = all.iter().collect::<BTreeSet<_>>().into_iter().collect();
                let number = |row: u32| distinct.binary_search(&&all[row as usize]).unwrap() as u32;
                let found: Vec<[u32; V]> = made.simplices.iter().map(|v| v.map(number)).collect();
                assert_eq!(
                    numbers(&found),
                    defined(&points, &weights),
                    "{name}: {points:?} {weights:?}"
                );
                for &v in made.simplices.as_flattened() {
                    assert_eq!(stands_for[v as usize], v as i32, "{name}");
                }
                let used: BTreeSet<u32> = found.as_flattened().iter().copied().collect();
                hidden += distinct.len() - used.len();
                if of_weights == 0 {
                    let plain = triangulate::<D, V, P>(&points, &IDLE).unwrap();
                    assert_eq!(
                        numbers(&plain.simplices),
                        numbers(&made.simplices),
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
                let (faults, _) = validate_regular::<D, V, P>(given, &weights, &IDLE).unwrap();
                assert_eq!(faults, Findings::default(), "{name}");
            }
        }
    }
    hidden
}

#[test]
fn small_sets_are_as_defined() {
    for hidden in [
        check::<2, 3, 4>(3),
        check::<3, 4, 4>(1),
        check::<4, 5, 4>(1),
        check::<5, 6, 8>(1),
    ] {
        assert!(hidden > 3, "{hidden}");
    }
}

#[test]
fn they_are_those_of_the_plane_and_of_space() {
    let mut r = Random::new(4);
    for seed in 0..20 {
        let points: Vec<[f64; 2]> = (0..200)
            .map(|_| {
                std::array::from_fn(|_| r.below(if seed % 2 == 0 { 9 } else { 1 << 30 }) as f64)
            })
            .collect();
        let weights: Vec<f64> = points.iter().map(|_| r.below(5) as f64).collect();
        let (made, stands_for) = regular::<2, 3, 4>(&points, &weights, &IDLE).unwrap();
        let plane = crate::regular::regular(&points, &weights, 1, &IDLE).unwrap();
        assert_eq!(stands_for, plane.stands_for);
        let right: Vec<_> = plane
            .triangles
            .simplices
            .iter()
            .map(|v| v.map(|i| i as u32))
            .collect();
        assert_eq!(numbers(&made.simplices), numbers(&right));
        let solid: Vec<[f64; 3]> = points
            .iter()
            .map(|p| [p[0], p[1], r.below(9) as f64])
            .collect();
        let (made, stands_for) = regular::<3, 4, 4>(&solid, &weights, &IDLE).unwrap();
        let space = crate::regular::space::regular(&solid, &weights, 1, &IDLE).unwrap();
        assert_eq!(stands_for, space.stands_for);
        let right: Vec<_> = space
            .tetrahedra
            .simplices
            .iter()
            .map(|v| v.map(|i| i as u32))
            .collect();
        assert_eq!(numbers(&made.simplices), numbers(&right));
    }
}

#[test]
fn faults_of_weights_are_found() {
    let mut r = Random::new(8);
    let points: Vec<[f64; 4]> = (0..60).map(|_| std::array::from_fn(|_| r.unit())).collect();
    let weights: Vec<f64> = points.iter().map(|_| 0.4 * r.unit()).collect();
    let (made, _) = regular::<4, 5, 4>(&points, &weights, &IDLE).unwrap();
    let simplices: Vec<_> = made.simplices.iter().map(|v| v.map(|i| i as i32)).collect();
    let given = Given {
        points: &points,
        simplices: &simplices,
        neighbors: &made.neighbors,
    };
    let used: BTreeSet<u32> = made.simplices.as_flattened().iter().copied().collect();
    let hidden = (0..60u32).find(|v| !used.contains(v)).unwrap();
    // A hidden point that is too heavy, a vertex that is too light.
    let mut other = weights.clone();
    other[hidden as usize] += 9.0;
    let (faults, _) = validate_regular::<4, 5, 4>(given, &other, &IDLE).unwrap();
    assert_eq!(faults.hidden, [hidden]);
    let mut other = weights.clone();
    other[made.simplices[0][0] as usize] -= 9.0;
    let (faults, _) = validate_regular::<4, 5, 4>(given, &other, &IDLE).unwrap();
    assert!(!faults.delaunay.is_empty());
    // The same for weights and lengths times a power of two, and shifted weights.
    for power in [-500, 500] {
        let scale = 2f64.powi(power);
        let moved: Vec<_> = points.iter().map(|p| p.map(|x| x * scale)).collect();
        let heavier: Vec<_> = weights.iter().map(|w| w * scale * scale).collect();
        let (again, _) = regular::<4, 5, 4>(&moved, &heavier, &IDLE).unwrap();
        assert_eq!(numbers(&again.simplices), numbers(&made.simplices));
    }
}
