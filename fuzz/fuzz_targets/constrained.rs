//! Constrained triangulations on small lattices, with many touches, overlaps and ties: checked
//! exactly.
//!
//! Crossings are errors or are split; the result must be the same for every order of the rows.

#![no_main]

use std::collections::{BTreeMap, BTreeSet};

use delone_core::Point2;
use delone_core::base::arrays::Given;
use delone_core::base::error::{Error, Result};
use delone_core::base::watch::Watch;
use delone_core::constrained::{Constrained, Options, constrain};
use delone_core::delaunay::plane::Method;
use delone_core::delaunay::plane::validate::{Findings, validate};
use delone_predicates::{Sign, orient2d};
use libfuzzer_sys::arbitrary::{self, Unstructured};

/// More points only make a run slower, not harder.
const MOST_POINTS: usize = 40;
const MOST_SEGMENTS: usize = 16;

type Segments = Vec<[u32; 2]>;
/// Triangles by their corners, from the smallest on, so that rows do not matter.
type Shapes = BTreeSet<[[u64; 2]; 3]>;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok((points, segments)) = read(&mut Unstructured::new(bytes)) {
        let crossing = crossing_pairs(&points, &segments);
        let split = check(&points, &segments, true);
        match check(&points, &segments, false) {
            Ok(plain) => {
                assert_eq!(crossing, Segments::new(), "{points:?} {segments:?}");
                assert_eq!(split, Ok(plain), "{points:?} {segments:?}");
            }
            Err(Error::Crossing { pairs, .. }) => {
                assert_eq!(pairs, crossing, "{points:?} {segments:?}");
                assert!(split.is_ok());
            }
            Err(_) => assert!(split.is_err()),
        }
    }
});

/// A lattice of a few points per side, at an offset that may leave few digits for crossings.
fn read(bytes: &mut Unstructured) -> arbitrary::Result<(Vec<Point2>, Segments)> {
    let side = bytes.int_in_range(1..=15)?;
    let count = bytes.int_in_range(3..=MOST_POINTS)?;
    let offset = *bytes.choose(&[0.0, 1e3, 2f64.powi(40), 2f64.powi(51)])?;
    let mut points = Vec::new();
    for _ in 0..count {
        let [x, y] = [bytes.int_in_range(0..=side)?, bytes.int_in_range(0..=side)?];
        points.push([f64::from(x) + offset, f64::from(y)]);
    }
    let mut segments = Vec::new();
    while !bytes.is_empty() && segments.len() < MOST_SEGMENTS {
        let last = count as u32 - 1;
        segments.push([bytes.int_in_range(0..=last)?, bytes.int_in_range(0..=last)?]);
    }
    Ok((points, segments))
}

/// The triangles, after they are checked, also with all rows reversed.
fn check(points: &[Point2], segments: &[[u32; 2]], split: bool) -> Result<Shapes> {
    let made = made(points, segments, split)?;
    let all = [points, &made.added].concat();
    assert_triangles(&all, &made);
    assert_segments(&all, segments, &made, split);
    let shapes = shapes(&all, &made);
    let last = points.len() as u32 - 1;
    let back: Vec<_> = points.iter().rev().copied().collect();
    let turned: Segments = (segments.iter().rev())
        .map(|&[a, b]| [last - b, last - a])
        .collect();
    let other = self::made(&back, &turned, split).expect("an answer in another order");
    let other = self::shapes(&[&back[..], &other.added].concat(), &other);
    assert_eq!(other, shapes, "{points:?} {segments:?}");
    Ok(shapes)
}

fn made(points: &[Point2], segments: &[[u32; 2]], split: bool) -> Result<Constrained> {
    let options = Options {
        split,
        conforming: false,
        max_vertices: 10_000,
        method: Method::Auto,
        workers: 1,
    };
    let made = constrain(points, segments, options, &Watch::idle());
    if let Err(error) = &made {
        let crossed = matches!(error, Error::Crossing { .. }) && !split;
        let flat = matches!(error, Error::TooFew { .. } | Error::Collinear { .. });
        assert!(crossed || flat, "{error} for {points:?} {segments:?}");
    }
    made
}

/// A triangulation of all points, with edges that are canonical or constrained.
fn assert_triangles(all: &[Point2], made: &Constrained) {
    let (simplices, neighbors) = (&made.arrays.simplices, &made.arrays.neighbors);
    let given = Given {
        points: all,
        simplices,
        neighbors,
    };
    let mut found = validate(given, &Watch::idle()).expect("a report");
    let free = |&[t, s]: &[u32; 2]| {
        let k = (0..3).find(|&k| neighbors[t as usize][k] == s as i32);
        !made.constrained[t as usize][k.expect("neighbors")]
    };
    found.delaunay.retain(free);
    found.ties.retain(free);
    assert_eq!(found, Findings::default(), "{all:?}");
}

/// Flags must match the subsegments, and the subsegments of each row must lead from end to end.
fn assert_segments(all: &[Point2], segments: &[[u32; 2]], made: &Constrained, split: bool) {
    let mut flagged = BTreeMap::new();
    for (t, s) in made.arrays.simplices.iter().enumerate() {
        for k in 0..3 {
            let [u, v] = [s[(k + 1) % 3], s[(k + 2) % 3]];
            let flag = made.constrained[t][k];
            let before = flagged.insert([u.min(v), u.max(v)], flag);
            assert!(before.is_none_or(|before| before == flag), "one side only");
        }
    }
    let sub = &made.subsegments;
    let mut chains = vec![Vec::new(); segments.len()];
    for (i, &[u, v]) in sub.ends.iter().enumerate() {
        let flag = flagged.insert([u.min(v), u.max(v)], false);
        assert_eq!(
            flag,
            Some(true),
            "{u} {v} is not a flagged edge, or comes twice"
        );
        let rows = sub.start[i] as usize..sub.start[i + 1] as usize;
        assert!(sub.source[rows.clone()].is_sorted_by(|a, b| a < b) && !rows.is_empty());
        for j in rows {
            let piece = if sub.forward[j] { [u, v] } else { [v, u] };
            chains[sub.source[j] as usize].push(piece);
        }
    }
    assert!(
        !flagged.into_values().any(|flag| flag),
        "a flag without a subsegment"
    );
    for (ends, mut chain) in segments.iter().zip(chains) {
        let [a, b] = ends.map(|row| all[row as usize]);
        let at = |v: i32| all[v as usize];
        let on_line = |piece: &[i32; 2]| orient2d(a, b, at(piece[1])) == Sign::Zero;
        assert!(split || chain.iter().all(on_line), "{a:?} {b:?} {chain:?}");
        let mut here = a;
        while let Some(i) = chain.iter().position(|piece| at(piece[0]) == here) {
            here = at(chain.swap_remove(i)[1]);
        }
        assert!(chain.is_empty() && here == b, "{a:?} {b:?} {chain:?}");
    }
}

fn shapes(all: &[Point2], made: &Constrained) -> Shapes {
    let turned = |t: &[i32; 3]| {
        let [a, b, c] = t.map(|v| all[v as usize].map(|x| (x + 0.0).to_bits()));
        // Coordinates are nonnegative, so their bits sort in the same order.
        [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .min()
            .expect("three")
    };
    made.arrays.simplices.iter().map(turned).collect()
}

/// Pairs of rows that cross other than at a point of the input, by brute force.
fn crossing_pairs(points: &[Point2], segments: &[[u32; 2]]) -> Segments {
    let at = |i: usize| segments[i].map(|row| points[row as usize]);
    let mut found = Vec::new();
    for j in 0..segments.len() {
        for i in 0..j {
            let ([a, b], [c, d]) = (at(i), at(j));
            let apart = |a, b, c, d| {
                let sides = [orient2d(a, b, c), orient2d(a, b, d)];
                sides[0] == -sides[1] && sides[0] != Sign::Zero
            };
            let on_both =
                |&p: &Point2| orient2d(a, b, p) == Sign::Zero && orient2d(c, d, p) == Sign::Zero;
            if apart(a, b, c, d) && apart(c, d, a, b) && !points.iter().any(on_both) {
                found.push([i as u32, j as u32]);
            }
        }
    }
    found.sort_unstable();
    found
}
