//! Convex hulls against all points, and against hulls without a point.

use super::super::{hull, triangulate};
use super::brute;
use super::sets::{Random, kinds};
use crate::base::error::Error;
use crate::base::watch::{IDLE, Watch};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Whether rows of points have some point strictly on the side of a facet where `inside` is not.
fn is_beyond<const D: usize>(
    at: &[Vec<num_bigint::BigInt>],
    facet: &[u32; D],
    inside: u32,
    p: u32,
) -> i32 {
    let with = |q: u32| brute::orientation(at, &[facet.as_slice(), &[q]].concat());
    let side = with(inside);
    assert_ne!(side, 0);
    -side * with(p)
}

fn check<const D: usize, const V: usize, const P: usize>(seeds: u64) -> [usize; 3] {
    let mut counts = [0; 3];
    for seed in 0..seeds {
        let mut random = Random::new(seed * 53 + D as u64);
        for (kind, points) in kinds::<D>(&mut random) {
            let name = format!("{D}-D {kind} {seed}");
            let found = match hull::<D, V, P>(&points, &IDLE) {
                Ok(found) => found,
                Err(Error::Flat { rows, .. }) => {
                    let spanning: Vec<_> = rows.iter().map(|&i| points[i as usize]).collect();
                    assert_eq!(brute::rank(&spanning), brute::rank(&points), "{name}");
                    assert!(brute::rank(&points) < D, "{name}");
                    continue;
                }
                Err(other) => panic!("{name}: {other}"),
            };
            let at = brute::integers(&points);
            let mut vertices: Vec<u32> = found.simplices.as_flattened().to_vec();
            vertices.sort_unstable();
            vertices.dedup();
            for (f, facet) in found.simplices.iter().enumerate() {
                let inside = found.inside[f];
                // No point is beyond a facet.
                let on = (0..points.len() as u32)
                    .map(|p| is_beyond(&at, facet, inside, p))
                    .inspect(|&side| assert!(side <= 0, "{name}: facet {f}"))
                    .filter(|&side| side == 0)
                    .count();
                counts[0] += usize::from(on > D);
                // Facets of one plane, and no others, have its number.
                for (g, other) in found.simplices.iter().enumerate().take(20) {
                    let level = other.iter().all(|&p| is_beyond(&at, facet, inside, p) == 0);
                    assert_eq!(
                        found.plane[f] == found.plane[g],
                        level,
                        "{name}: {f} and {g}"
                    );
                }
                // A point inside in front of the corners makes them positive.
                let with = [&[inside], facet.as_slice()].concat();
                assert_eq!(brute::orientation(&at, &with), 1, "{name}: facet {f}");
                // Neighbors share all corners but one, and are mutual.
                for k in 0..D {
                    let other = found.neighbors[f][k] as usize;
                    let theirs = &found.simplices[other];
                    let shared = facet.iter().filter(|v| theirs.contains(v)).count();
                    assert_eq!(shared, D - 1, "{name}: facet {f}");
                    assert!(!theirs.contains(&facet[k]));
                    let back = found.neighbors[other].iter().position(|&n| n == f as u32);
                    assert!(!facet.contains(&theirs[back.unwrap()]));
                }
            }
            // A vertex is outside the hull of all other points; another point is not.
            let places: std::collections::BTreeSet<_> =
                vertices.iter().map(|&v| &at[v as usize]).collect();
            for p in 0..points.len() {
                let rest: Vec<[f64; D]> = (0..points.len())
                    .filter(|&q| at[q] != at[p])
                    .map(|q| points[q])
                    .collect();
                let is_extreme = match hull::<D, V, P>(&rest, &IDLE) {
                    Ok(others) => {
                        let all = [&rest[..], &[points[p]]].concat();
                        let at = brute::integers(&all);
                        let last = rest.len() as u32;
                        others
                            .simplices
                            .iter()
                            .zip(&others.inside)
                            .any(|(facet, &inside)| is_beyond(&at, facet, inside, last) > 0)
                    }
                    // The others lie in a flat, and all do not.
                    Err(_) => true,
                };
                assert_eq!(places.contains(&at[p]), is_extreme, "{name}: point {p}");
                counts[1 + usize::from(is_extreme)] += 1;
            }
        }
    }
    counts
}

#[test]
fn facets_support_and_extreme_points_are_vertices() {
    let mut all = [0; 3];
    for counts in [
        check::<3, 4, 4>(3),
        check::<4, 5, 4>(2),
        check::<5, 6, 8>(1),
        check::<6, 7, 8>(1),
    ] {
        all = std::array::from_fn(|k| all[k] + counts[k]);
    }
    // Points on planes of facets, points that are not extreme, and points that are.
    assert!(all.into_iter().all(|count| count > 20), "{all:?}");
}

#[test]
fn the_hull_of_points_in_general_position_is_that_of_their_triangulation() {
    let mut random = Random::new(9);
    let points: Vec<[f64; 8]> = (0..30).map(|_| [0; 8].map(|_| random.unit())).collect();
    let found = hull::<8, 9, 8>(&points, &IDLE).unwrap();
    let made = triangulate::<8, 9, 8>(&points, &IDLE).unwrap();
    let sorted = |v: &mut Vec<u32>| v.sort_unstable();
    let mut facets: Vec<Vec<u32>> = found.simplices.iter().map(|f| f.to_vec()).collect();
    let mut expected = Vec::new();
    for (v, n) in made.simplices.iter().zip(&made.neighbors) {
        for k in (0..9).filter(|&k| n[k] < 0) {
            expected.push(
                v.iter()
                    .copied()
                    .filter(|&u| u != v[k])
                    .collect::<Vec<u32>>(),
            );
        }
    }
    facets.iter_mut().chain(&mut expected).for_each(sorted);
    facets.sort_unstable();
    expected.sort_unstable();
    assert_eq!(facets, expected);
}

#[test]
fn work_on_a_hull_is_interrupted_soon() {
    let mut random = Random::new(3);
    // On a sphere, so that all are vertices.
    let points: Vec<[f64; 5]> = (0..300)
        .map(|_| {
            let p = [0; 5].map(|_| random.unit() - 0.5);
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            p.map(|x| x / length)
        })
        .collect();
    let asked = AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) == 5;
    let found = hull::<5, 6, 8>(&points, &Watch::new(&stop));
    assert_eq!(found, Err(Error::Interrupted));
    assert_eq!(asked.into_inner(), 6);
}
