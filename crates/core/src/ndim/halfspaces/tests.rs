//! Intersections compared with hulls of points from another kernel, and with themselves.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::sites::Sites;
use super::start::{first, middle};
use super::wrap::Hull;
use super::{Corners, Trouble, intersect};
use crate::base::error::Error;
use crate::base::watch::{IDLE, Pace, Watch};
use crate::ndim::hull;
use crate::ndim::tests::sets::{Random, kinds};

/// The half-spaces of the corners, each sorted.
type Sets = BTreeSet<Vec<u32>>;

/// Half-spaces `a x <= 1`, times positive integers: the dual points at the origin are the `a`.
fn polar<const D: usize, const V: usize>(
    points: &[[f64; D]],
    random: &mut Random,
) -> Vec<[f64; V]> {
    let times = |x: f64, t: f64| {
        if (x * t) / t == x && (x * t).abs() < 1e6 {
            t
        } else {
            1.0
        }
    };
    let of = |p: &[f64; D], t: f64| {
        let t = if p.iter().all(|&x| times(x, t) == t) && *p == p.map(f64::round) {
            t
        } else {
            1.0
        };
        std::array::from_fn(|k| p.get(k).map_or(-t, |x| x * t))
    };
    points.iter().map(|p| of(p, random.integer(1, 5))).collect()
}

/// The facets of the hull of points, each with its vertices.
fn facets<const D: usize, const V: usize, const P: usize>(points: &[[f64; D]]) -> Option<Sets> {
    let found = hull::<D, V, P>(points, &IDLE).ok()?;
    let count = found.plane.iter().max().map_or(0, |n| n + 1) as usize;
    let mut of = vec![BTreeSet::new(); count];
    for (simplex, plane) in found.simplices.iter().zip(&found.plane) {
        of[*plane as usize].extend(simplex.iter().copied());
    }
    Some(
        of.into_iter()
            .map(|set| set.into_iter().collect())
            .collect(),
    )
}

fn sets<const D: usize, const V: usize>(found: &Corners<D, V>) -> Sets {
    let sorted = |ends: &[u32]| {
        let mut facet = found.facets[ends[0] as usize..ends[1] as usize].to_vec();
        facet.sort_unstable();
        facet
    };
    let all: Sets = found.starts.windows(2).map(sorted).collect();
    assert_eq!(all.len() + 1, found.starts.len(), "a corner is there twice");
    all
}

/// Checks a triangulation of the boundary of a hull: each ridge occurs twice, and each simplex is in its
/// facet and has the smallest vertex of that facet.
fn check_simplices<const D: usize, const V: usize>(found: &Corners<D, V>, name: &str) {
    let mut ridges = std::collections::BTreeMap::new();
    for (simplex, corner) in found.simplices.iter().zip(&found.corner) {
        let ends = &found.starts[*corner as usize..];
        let facet = &found.facets[ends[0] as usize..ends[1] as usize];
        assert!(simplex.iter().all(|v| facet.contains(v)), "{name}");
        let place = |v: &u32| found.dual[*v as usize];
        let least = facet
            .iter()
            .min_by(|a, b| place(a).partial_cmp(&place(b)).unwrap());
        assert!(
            simplex.contains(least.unwrap()),
            "{name}: {simplex:?} of {facet:?}"
        );
        for k in 0..D {
            let mut ridge = simplex.to_vec();
            ridge.remove(k);
            ridge.sort_unstable();
            *ridges.entry(ridge).or_insert(0) += 1;
        }
    }
    assert!(ridges.values().all(|&count| count == 2), "{name}");
}

fn check<const D: usize, const V: usize, const P: usize>(seeds: u64) -> [usize; 3] {
    let mut counts = [0; 3];
    for seed in 0..seeds {
        let mut random = Random::new(seed * 59 + D as u64);
        for (kind, points) in kinds::<D>(&mut random) {
            let name = format!("{D}-D {kind} {seed}");
            let rows: Vec<[f64; V]> = polar(&points, &mut random);
            let made = intersect::<D, V, P>(&rows, [0.0; D], &IDLE).unwrap();
            let Some(expected) = facets::<D, V, P>(&points) else {
                assert!(matches!(made, Err(Trouble::Flat(_))), "{name}");
                counts[0] += 1;
                continue;
            };
            let found = made.unwrap();
            assert_eq!(sets(&found), expected, "{name}");
            assert_eq!(found.dual, points, "{name}");
            check_simplices(&found, &name);
            counts[1] += found.points.iter().filter(|p| p[0].is_infinite()).count();
            counts[2] += usize::from(found.simplices.len() > found.points.len());
            // The same with subnormal dual points, which are rounded.
            let far = |x: f64, k: usize| x * 2f64.powi(if k == D { 1000 } else { -65 });
            let huge: Vec<[f64; V]> = rows
                .iter()
                .map(|row| std::array::from_fn(|k| far(row[k], k)))
                .collect();
            let other = intersect::<D, V, P>(&huge, [0.0; D], &IDLE).unwrap();
            assert_eq!(sets(&other.unwrap()), expected, "{name}, huge");
            // Which boundaries meet in corners does not depend on the interior point.
            let most = points
                .as_flattened()
                .iter()
                .fold(0.0, |m: f64, x| m.max(x.abs()));
            let point = [(); D].map(|()| (random.unit() - 0.5) / most / D as f64);
            let other = intersect::<D, V, P>(&rows, point, &IDLE).unwrap().unwrap();
            assert_eq!(sets(&other), expected, "{name} from {point:?}");
            // The order of rows does not matter either.
            let mut order: Vec<u32> = (0..rows.len() as u32).collect();
            random.shuffle(&mut order);
            let mixed: Vec<[f64; V]> = order.iter().map(|&i| rows[i as usize]).collect();
            let again = intersect::<D, V, P>(&mixed, point, &IDLE).unwrap().unwrap();
            let place = |v: &u32| rows[*v as usize].map(|x| x / rows[*v as usize][D]);
            let named = |found: &Corners<D, V>, rows: &dyn Fn(&u32) -> u32| -> BTreeSet<String> {
                let all = found.simplices.iter();
                all.map(|simplex| {
                    let mut v = simplex.map(|v| place(&rows(&v)));
                    v.sort_by(|a, b| a.partial_cmp(b).unwrap());
                    format!("{v:?}")
                })
                .collect()
            };
            let back = |v: &u32| order[*v as usize];
            assert_eq!(named(&other, &|v| *v), named(&again, &back), "{name}");
        }
    }
    counts
}

#[test]
fn facets_are_those_of_hulls_of_points() {
    let mut all = [0; 3];
    for counts in [
        check::<2, 3, 4>(12),
        check::<3, 4, 4>(12),
        check::<4, 5, 4>(6),
        check::<5, 6, 8>(3),
        check::<6, 7, 8>(1),
    ] {
        for (sum, count) in all.iter_mut().zip(counts) {
            *sum += count;
        }
    }
    // Flats, facets at infinity, and facets that are not simplices.
    assert!(all.iter().all(|&count| count > 20), "{all:?}");
}

/// A hull of rows, with rounded tests or with integers alone.
fn wrapped<const D: usize, const V: usize, const P: usize>(
    rows: &[[f64; V]],
    point: [f64; D],
    exact: bool,
) -> Hull<'_, D, V, P> {
    let mut pace = Pace::new(&IDLE, 1000);
    let mut sites = Sites::new(rows, point).unwrap().unwrap();
    let scaled = sites.scale().unwrap();
    let (corners, sign) = first(&sites, &scaled, &mut pace).unwrap().unwrap();
    sites.look(&scaled, &middle(&scaled, &corners)).unwrap();
    if exact {
        sites.slack = f64::INFINITY;
    }
    let mut hull = Hull::new(sites, corners, sign).unwrap();
    hull.wrap(&mut pace).unwrap();
    hull
}

/// Half-spaces whose dual points are near each other: their boundaries pass near a common point, and
/// have nearly the same normal.
fn bundle<const D: usize, const V: usize>(count: usize, r: &mut Random) -> Vec<[f64; V]> {
    let of = |r: &mut Random| {
        let a: [f64; D] = std::array::from_fn(|k| f64::from(k == 0) + 1e-5 * (r.unit() - 0.5));
        let b = -(a.iter().sum::<f64>() * (1.0 + r.integer(-2, 2) * f64::EPSILON));
        std::array::from_fn(|k| a.get(k).copied().unwrap_or(b))
    };
    (0..count).map(|_| of(r)).collect()
}

/// Half-spaces whose boundaries pass near a few common points, by roundings and units in the last place.
fn pencils<const D: usize, const V: usize>(
    count: usize,
    far: f64,
    r: &mut Random,
) -> Vec<[f64; V]> {
    let centers: Vec<[f64; D]> = (0..3).map(|_| [(); D].map(|()| far + r.unit())).collect();
    let mut rows = Vec::new();
    while rows.len() < count {
        let a = [(); D].map(|()| r.unit() - 0.5);
        let center = centers[r.below(3) as usize];
        let b = -(0..D).map(|k| a[k] * center[k]).sum::<f64>();
        let b = b + r.integer(-2, 2) * b.abs() * f64::EPSILON;
        let row: [f64; V] = std::array::from_fn(|k| a.get(k).copied().unwrap_or(b));
        // The mean of the centers is well inside.
        let middle = far + 0.5;
        if a.iter().sum::<f64>() * middle + b < -0.05 {
            rows.push(row);
        }
    }
    rows
}

fn check_bounds<const D: usize, const V: usize, const P: usize>(seeds: u64) -> [usize; 2] {
    let mut counts = [0; 2];
    for seed in 0..seeds {
        let mut random = Random::new(seed * 61 + D as u64);
        for far in [0.0, 3.0, 1e5, f64::INFINITY] {
            let (rows, point): (Vec<[f64; V]>, _) = if far.is_finite() {
                (pencils::<D, V>(24, far, &mut random), [far + 0.5; D])
            } else {
                (bundle::<D, V>(24, &mut random), [0.0; D])
            };
            let mut hull = wrapped::<D, V, P>(&rows, point, false);
            for c in 0..hull.facets.len() as u32 {
                if !hull.facets[c as usize].alive {
                    continue;
                }
                for w in 0..=rows.len() as u32 {
                    let (value, bound) = hull.value(c, w);
                    let exact = hull.exact_side(c, w);
                    assert!(
                        exact <= 0 || w == rows.len() as u32,
                        "{D}-D {seed}: {w} is outside"
                    );
                    if value.abs() > bound {
                        counts[0] += 1;
                        assert_eq!(value > 0.0, exact > 0, "{D}-D {seed} {far}: {c} {w}");
                        assert_ne!(exact, 0, "{D}-D {seed} {far}: {c} {w}");
                    } else {
                        counts[1] += 1;
                    }
                }
            }
            let slow = wrapped::<D, V, P>(&rows, point, true);
            let named = |hull: &Hull<'_, D, V, P>| -> BTreeSet<[u32; D]> {
                let alive = hull.facets.iter().filter(|f| f.alive);
                alive
                    .map(|f| {
                        let mut v = f.vertices;
                        v.sort_unstable();
                        v
                    })
                    .collect()
            };
            assert_eq!(named(&hull), named(&slow), "{D}-D {seed} {far}");
        }
    }
    counts
}

#[test]
fn what_is_certain_is_right() {
    let all = [
        check_bounds::<2, 3, 4>(8),
        check_bounds::<3, 4, 4>(8),
        check_bounds::<4, 5, 4>(3),
        check_bounds::<5, 6, 8>(1),
    ];
    // Among many values, some besides those of the vertices are uncertain.
    assert!(
        all.iter()
            .all(|[certain, other]| *certain > 500 && *other > 100),
        "{all:?}"
    );
}

#[test]
fn what_has_no_corners_is_named() {
    let square = [
        [1.0, 0.0, -1.0],
        [-1.0, 0.0, -1.0],
        [0.0, 1.0, -1.0],
        [0.0, -1.0, -1.0],
    ];
    let trouble =
        |rows: &[[f64; 3]], point| intersect::<2, 3, 4>(rows, point, &IDLE).unwrap().err();
    assert_eq!(trouble(&square, [1.0, 0.0]), Some(Trouble::NotInside(0)));
    assert_eq!(trouble(&square, [0.0, -1.5]), Some(Trouble::NotInside(3)));
    assert_eq!(
        trouble(&square[..2], [0.0, 0.0]),
        Some(Trouble::Flat(vec![0, 1]))
    );
    assert_eq!(trouble(&[], [0.0, 0.0]), Some(Trouble::Flat(vec![])));
    assert_eq!(
        trouble(&[[0.0; 3]], [0.0, 0.0]),
        Some(Trouble::NotInside(0))
    );
    let close = [[1e300, 0.0, -1e-300], [-1.0, 0.0, -1.0], [0.0, 1.0, -1.0]];
    assert_eq!(trouble(&close, [0.0, 0.0]), Some(Trouble::TooClose(0)));
}

#[test]
fn all_of_the_range_of_doubles_is_taken() {
    // A simplex with sides of very different sizes: coordinates that are not negative, and a cut.
    for (size, unit) in [
        (1e-300, 1.0),
        (1e300, 1e-300),
        (1.0, 1e300),
        (5e-324, 1.0),
        (1e150, 1e10),
    ] {
        let rows = [
            [-unit, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 0.0],
            [0.0, 0.0, -1e-300, 0.0],
            [1.0, 1.0, 1.0, -4.0 * size],
        ];
        let found = intersect::<3, 4, 4>(&rows, [size; 3], &IDLE).unwrap();
        let Ok(found) = found else {
            // Dual points are not doubles.
            assert!(size < 1e-200, "{size}");
            continue;
        };
        let mut expected = vec![[0.0; 3]; 4];
        for (k, p) in expected[1..].iter_mut().enumerate() {
            p[k] = 4.0 * size;
        }
        let mut points = found.points;
        points.sort_by(|a, b| b.partial_cmp(a).unwrap());
        expected.sort_by(|a, b| b.partial_cmp(a).unwrap());
        assert_eq!(points, expected, "{size} {unit}");
    }
}

#[test]
fn dual_points_of_wide_rows_are_exact() {
    // The second number underflows if the first one is scaled to 1.
    let tiny = 1e-299 / 3.0;
    let rows = [[1e10, tiny, -1.5e10], [-1.0, 1.0, -4.0], [-1.0, -1.0, -4.0]];
    let point = [1.5 - 0.5f64.powi(20), 0.0];
    let found = intersect::<2, 3, 4>(&rows, point, &IDLE).unwrap().unwrap();
    assert_eq!(found.dual[0][1], tiny / (1e10 * 0.5f64.powi(20)));
}

#[test]
fn hulls_can_be_interrupted() {
    let mut random = Random::new(5);
    let rows: Vec<[f64; 6]> = pencils::<5, 6>(60, 0.0, &mut random);
    let asked = AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) == 3;
    let found = intersect::<5, 6, 8>(&rows, [0.5; 5], &Watch::new(&stop));
    assert_eq!(found, Err(Error::Interrupted));
}
