//! Constrained triangulations of points with many ties and touching segments, checked exactly.

use std::collections::{BTreeMap, BTreeSet};

use crate::tier::cases;
use delone_core::Point2;
use delone_core::base::error::{Error, Result};
use delone_core::base::watch::Watch;
use delone_core::constrained::{Constrained, Options, Rule, constrain, polygon};
use delone_core::delaunay::plane::Method;
use delone_predicates::{Sign, angle, incircle_canonical, lexicographic, orient2d};
use proptest::prelude::*;

fn options(split: bool) -> Options {
    Options {
        split,
        conforming: false,
        max_vertices: 100_000,
        method: Method::Auto,
        workers: 1,
    }
}

fn made(points: &[Point2], segments: &[[u32; 2]], split: bool) -> Result<Constrained> {
    constrain(points, segments, options(split), &Watch::idle())
}

/// The triangles as coordinates, from the smallest corner on.
fn shapes(points: &[Point2], c: &Constrained) -> BTreeSet<[[u64; 2]; 3]> {
    let all = [points, &c.added[..]].concat();
    let turned = |t: &[i32; 3]| {
        let p = t.map(|v| all[v as usize]);
        let k = (0..3)
            .min_by(|&i, &j| lexicographic(p[i], p[j]))
            .unwrap_or(0);
        [p[k], p[(k + 1) % 3], p[(k + 2) % 3]].map(|p| p.map(|x| (x + 0.0).to_bits()))
    };
    c.arrays.simplices.iter().map(turned).collect()
}

/// Checks every property of a constrained Delaunay triangulation.
fn check(points: &[Point2], segments: &[[u32; 2]], c: &Constrained) {
    let all = [points, &c.added[..]].concat();
    let at = |v: i32| all[v as usize];
    let mut sides = BTreeMap::new();
    for (t, s) in c.arrays.simplices.iter().enumerate() {
        assert_eq!(orient2d(at(s[0]), at(s[1]), at(s[2])), Sign::Positive);
        for k in 0..3 {
            let old = sides.insert([s[(k + 1) % 3], s[(k + 2) % 3]], (t, k));
            assert!(old.is_none());
        }
    }
    let (mut boundary, mut marked) = (0, BTreeSet::new());
    for (&[u, v], &(t, k)) in &sides {
        if c.constrained[t][k] {
            marked.insert([u.min(v), u.max(v)]);
        }
        let Some(&(s, j)) = sides.get(&[v, u]) else {
            assert_eq!(c.arrays.neighbors[t][k], -1);
            boundary += 1;
            let outside = |p: &Point2| orient2d(at(u), at(v), *p) == Sign::Negative;
            assert!(!all.iter().any(outside), "the hull");
            continue;
        };
        assert_eq!(c.arrays.neighbors[t][k], s as i32);
        assert_eq!(c.constrained[t][k], c.constrained[s][j]);
        if !c.constrained[t][k] {
            let (p, q) = (c.arrays.simplices[t][k], c.arrays.simplices[s][j]);
            let inside = incircle_canonical(at(u), at(v), at(p), at(q));
            assert_ne!(inside, Sign::Positive, "{u} {v} {p} {q}");
        }
    }
    let distinct = all.len() - c.duplicates.len();
    assert_eq!(c.arrays.simplices.len() + boundary + 2, 2 * distinct);
    let sub = &c.subsegments;
    let ends: BTreeSet<_> = sub
        .ends
        .iter()
        .map(|&[u, v]| [u.min(v), u.max(v)])
        .collect();
    assert_eq!(ends, marked);
    assert_eq!(ends.len(), sub.ends.len());
    // Each segment is a chain from end to end.
    let first: Vec<u32> = (0..points.len() as u32)
        .map(|row| {
            let found = c.duplicates.iter().find(|d| d[0] == row);
            found.map_or(row, |d| d[1])
        })
        .collect();
    for (row, s) in segments.iter().enumerate() {
        let mut degree = BTreeMap::new();
        for (i, ends) in sub.ends.iter().enumerate() {
            let range = sub.start[i] as usize..sub.start[i + 1] as usize;
            for j in range.filter(|&j| sub.source[j] == row as i32) {
                let [u, v] = if sub.forward[j] {
                    *ends
                } else {
                    [ends[1], ends[0]]
                };
                *degree.entry(u).or_insert(0) += 1;
                *degree.entry(v).or_insert(0) -= 1;
                if c.added.is_empty() {
                    let [a, b] = s.map(|r| points[r as usize]);
                    assert!(orient2d(a, b, at(u)).is_zero() && orient2d(a, b, at(v)).is_zero());
                }
            }
        }
        degree.retain(|_, d| *d != 0);
        let [a, b] = s.map(|r| first[r as usize] as i32);
        let expected = match a == b {
            true => BTreeMap::new(),
            false => BTreeMap::from([(a, 1), (b, -1)]),
        };
        assert_eq!(degree, expected, "row {row}");
    }
}

fn lattice() -> impl Strategy<Value = (Vec<Point2>, Vec<[u32; 2]>)> {
    (3..7_i32, 3..30_usize).prop_flat_map(|(side, n)| {
        let point = [0..side, 0..side].prop_map(|p| p.map(f64::from));
        let n32 = n as u32;
        let segment = [0..n32, 0..n32];
        (
            prop::collection::vec(point, n..=n),
            prop::collection::vec(segment, 0..12),
        )
    })
}

fn scattered() -> impl Strategy<Value = (Vec<Point2>, Vec<[u32; 2]>)> {
    let point = [-1.0..1.0, -1.0..1.0_f64];
    (
        prop::collection::vec(point, 30..=30),
        prop::collection::vec([0..30_u32, 0..30], 1..20),
    )
}

fn holds(points: &[Point2], segments: &[[u32; 2]]) {
    let split = match made(points, segments, true) {
        Err(Error::TooFew { .. } | Error::Collinear { .. }) => return,
        made => made.unwrap(),
    };
    check(points, segments, &split);
    match made(points, segments, false) {
        Ok(plain) => {
            assert!(split.crossings.is_empty() && split.added.is_empty());
            check(points, segments, &plain);
            assert!(shapes(points, &plain) == shapes(points, &split));
        }
        Err(Error::Crossing { pairs, points }) => {
            assert!(!pairs.is_empty() && pairs.len() == points.len());
            let split: BTreeSet<_> = split.crossings.iter().map(|c| [c[0], c[1]]).collect();
            let pairs: BTreeSet<_> = pairs.into_iter().collect();
            assert!(split.is_subset(&pairs));
        }
        Err(other) => panic!("{other}"),
    }
    // The same for other orders of rows and of ends.
    let n = points.len() as u32;
    let back: Vec<Point2> = points.iter().rev().copied().collect();
    let turned: Vec<_> = segments
        .iter()
        .rev()
        .map(|&[a, b]| [n - 1 - b, n - 1 - a])
        .collect();
    let other = made(&back, &turned, true).unwrap();
    let same = shapes(points, &split) == shapes(&back, &other);
    assert!(same, "another order gives other triangles");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(66, 800)))]

    #[test]
    fn lattices((points, segments) in lattice()) {
        holds(&points, &segments);
    }

    #[test]
    fn scattered_points((points, segments) in scattered()) {
        holds(&points, &segments);
        let moved: Vec<Point2> = points.iter().map(|p| p.map(|x| x * 1e-3 + 5e5)).collect();
        holds(&moved, &segments);
    }
}

/// No vertex lies inside the diametral circle of a subsegment.
fn check_conforming(points: &[Point2], segments: &[[u32; 2]]) {
    let options = Options {
        conforming: true,
        ..options(true)
    };
    let c = match constrain(points, segments, options, &Watch::idle()) {
        Err(Error::TooFew { .. } | Error::Collinear { .. }) => return,
        made => made.unwrap(),
    };
    check(points, segments, &c);
    let all = [points, &c.added[..]].concat();
    for ends in &c.subsegments.ends {
        let [u, v] = ends.map(|v| all[v as usize]);
        let inside = |p: &&Point2| angle(u, **p, v) == Sign::Negative;
        assert_eq!(
            all.iter().find(inside),
            None,
            "in the diametral circle of {u:?} {v:?}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(20, 200)))]

    #[test]
    fn conforming_lattices((points, segments) in lattice()) {
        check_conforming(&points, &segments);
    }

    #[test]
    fn conforming_scattered_points((points, segments) in scattered()) {
        check_conforming(&points, &segments[..segments.len().min(4)]);
    }
}

#[test]
fn a_limit_ends_the_splits() {
    let points: Vec<Point2> = (0..10)
        .map(|i| [f64::from(i), f64::from(i % 2 * 9 + i)])
        .collect();
    let segments: Vec<[u32; 2]> = (0..5).flat_map(|i| (5..10).map(move |j| [i, j])).collect();
    let few = Options {
        max_vertices: 2,
        ..options(true)
    };
    let error = constrain(&points, &segments, few, &Watch::idle()).unwrap_err();
    assert!(
        matches!(
            error,
            Error::Budget {
                limit: 2,
                found: 3..,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn rules_of_a_star() {
    // A pentagram winds twice around its center.
    let star: Vec<Point2> = (0..5)
        .map(|i| f64::from(2 * i) * std::f64::consts::TAU / 5.0)
        .map(|a| [a.cos(), a.sin()])
        .collect();
    let area = |rule| {
        let filled = polygon(&star, &[0, 5], rule, &Watch::idle()).unwrap();
        let all = [&star[..], &filled.added[..]].concat();
        assert_eq!(filled.added.len(), 5);
        let twice = |t: &[i32; 3]| {
            let [a, b, c] = t.map(|v| all[v as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        filled.simplices.iter().map(twice).sum::<f64>() / 2.0
    };
    let (odd, all) = (area(Rule::EvenOdd), area(Rule::NonZero));
    assert!(
        (odd - 0.776_6).abs() < 1e-3 && (all - 1.122_6).abs() < 1e-3,
        "{odd} {all}"
    );
}
