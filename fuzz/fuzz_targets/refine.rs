//! Refinement on small lattices, with many ties, touches and sharp corners: checked exactly.
//!
//! Subsegments lead from end to end, no angle is below the bound unless a corner of the input
//! forces it, and refinement terminates.

#![no_main]

use std::cmp::Ordering;
use std::collections::BTreeMap;

use delone_core::Point2;
use delone_core::base::arrays::Given;
use delone_core::base::watch::Watch;
use delone_core::constrained::{Constrained, Options, components, constrain};
use delone_core::delaunay::plane::Method;
use delone_core::delaunay::plane::validate::{Findings, validate};
use delone_core::refine::{Refined, Task, refine};
use libfuzzer_sys::arbitrary::{self, Unstructured};
use num_bigint::BigInt;

/// More points only make a run slower, not harder.
const MOST_POINTS: usize = 20;
const MOST_SEGMENTS: usize = 10;
/// More than angles up to 26 degrees can need there.
const MOST_ADDED: usize = 20_000;
/// As in the core: radii around a corner are equal if they differ by less than this share.
const SAME_SHELL: f64 = 1e-3;

struct Input {
    points: Vec<Point2>,
    segments: Vec<[u32; 2]>,
    degrees: f64,
    cap: f64,
    circles: bool,
    frozen: bool,
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(input) = read(&mut Unstructured::new(bytes)) {
        check(&input);
    }
});

/// Points of a lattice in a box, so that its sides stay straight however they are split.
fn read(bytes: &mut Unstructured) -> arbitrary::Result<Input> {
    let side = bytes.int_in_range(1..=9)?;
    let degrees = *bytes.choose(&[0.0, 20.0, 26.0, 30.0, 33.0])?;
    let cap = *bytes.choose(&[f64::INFINITY, 1.0, 0.05])?;
    let (circles, frozen) = (bytes.arbitrary()?, bytes.ratio(1, 8)?);
    let offset = *bytes.choose(&[0.0, 1000.0])?;
    let top = f64::from(side) + 1.0;
    let [left, right] = [-1.0, top].map(|x| x + offset);
    let mut points = vec![[left, -1.0], [right, -1.0], [right, top], [left, top]];
    for _ in 0..bytes.int_in_range(0..=MOST_POINTS)? {
        let [x, y] = [bytes.int_in_range(0..=side)?, bytes.int_in_range(0..=side)?];
        points.push([f64::from(x) + offset, f64::from(y)]);
    }
    let mut segments = vec![[0, 1], [1, 2], [2, 3], [3, 0]];
    let last = points.len() as u32 - 1;
    while !bytes.is_empty() && segments.len() < 4 + MOST_SEGMENTS {
        segments.push([bytes.int_in_range(0..=last)?, bytes.int_in_range(0..=last)?]);
    }
    Ok(Input {
        points,
        segments,
        degrees,
        cap,
        circles,
        frozen,
    })
}

fn check(input: &Input) {
    let options = Options {
        split: true,
        conforming: false,
        max_vertices: 10_000,
        method: Method::Auto,
        workers: 1,
    };
    let base = constrain(&input.points, &input.segments, options, &Watch::idle()).expect("a base");
    let points = [&input.points[..], &base.added].concat();
    let lines: Vec<[u32; 2]> = base
        .subsegments
        .ends
        .iter()
        .map(|&e| e.map(|v| v as u32))
        .collect();
    let made = meshed(input, &points, &base, &lines);
    let all = [&points[..], &made.added].concat();
    let again = meshed(input, &points, &base, &lines);
    assert_eq!(again.added, made.added);
    assert_eq!(again.simplices, made.simplices);
    assert_triangles(&all, &made);
    assert_chains(&all, &lines, &made, points.len(), input.frozen);
    assert!(
        input.degrees > 26.0 || input.frozen || !made.exhausted,
        "does not terminate: {points:?} {lines:?}"
    );
    if !made.exhausted {
        assert_sizes(input.cap, &all, &made);
    }
    if !made.exhausted && !input.frozen {
        assert_angles(input.degrees, &all, &lines, &made, points.len());
    }
}

fn meshed(input: &Input, points: &[Point2], base: &Constrained, lines: &[[u32; 2]]) -> Refined {
    let arrays = &base.arrays;
    let labels = components(&arrays.neighbors, &base.constrained, &Watch::idle()).expect("labels");
    let task = Task {
        points,
        simplices: &arrays.simplices,
        neighbors: Some(&arrays.neighbors),
        labels: &labels,
        areas: &vec![input.cap; labels.len()],
        segments: lines,
        lines: None,
        frozen: &vec![input.frozen; lines.len()],
        min_angle: input.degrees,
        circles: input.circles,
        sizes_yield: false,
        max_vertices: MOST_ADDED,
    };
    refine(task, &Watch::idle()).expect("a mesh")
}

/// A triangulation of all points, with edges that are canonical or part of lines.
fn assert_triangles(all: &[Point2], made: &Refined) {
    let given = Given {
        points: all,
        simplices: &made.simplices,
        neighbors: &made.neighbors,
    };
    let mut found = validate(given, &Watch::idle()).expect("a report");
    let free = |&[t, s]: &[u32; 2]| {
        let k = (0..3).find(|&k| made.neighbors[t as usize][k] == s as i32);
        made.sides[t as usize][k.expect("neighbors")] < 0
    };
    found.delaunay.retain(free);
    found.ties.retain(free);
    assert_eq!(found, Findings::default(), "{all:?}");
}

/// The pieces of each line lead from end to end, with increasing distance along it.
fn assert_chains(all: &[Point2], lines: &[[u32; 2]], made: &Refined, own: usize, frozen: bool) {
    let mut pieces = vec![BTreeMap::new(); lines.len()];
    for (t, corners) in made.simplices.iter().enumerate() {
        for k in 0..3 {
            let (line, next) = (made.sides[t][k], made.neighbors[t][k]);
            let [u, v] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
            if next >= 0 {
                let back = made.neighbors[next as usize]
                    .iter()
                    .position(|&n| n == t as i32);
                assert_eq!(made.sides[next as usize][back.expect("mutual")], line);
                assert!(line >= 0 || made.labels[t] == made.labels[next as usize]);
            }
            if line >= 0 {
                let chain = &mut pieces[line as usize];
                chain.entry(u).or_insert_with(Vec::new).push(v);
                chain.entry(v).or_insert_with(Vec::new).push(u);
            }
        }
    }
    for (&[a, b], chain) in lines.iter().zip(pieces) {
        let [p, q] = [a, b].map(|v| all[v as usize]);
        let along = |v: i32| {
            let r = all[v as usize];
            (r[0] - p[0]) * (q[0] - p[0]) + (r[1] - p[1]) * (q[1] - p[1])
        };
        let (mut here, mut steps) = (a as i32, 0);
        while here != b as i32 {
            let ahead = chain[&here].iter().find(|&&v| along(v) > along(here));
            here = *ahead.expect("a way on");
            steps += 1;
            assert!(
                here == b as i32 || here as usize >= own,
                "a vertex of the input on a line"
            );
        }
        assert_eq!(chain.len(), steps + 1, "{p:?} {q:?}");
        assert!(!frozen || steps == 1);
    }
}

fn assert_sizes(cap: f64, all: &[Point2], made: &Refined) {
    for corners in &made.simplices {
        let [a, b, c] = corners.map(|v| all[v as usize]);
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
        assert!(area <= cap * (1.0 + 1e-9), "{area} {a:?} {b:?} {c:?}");
    }
}

/// Angles are within the bound, except where a corner forces one.
fn assert_angles(degrees: f64, all: &[Point2], lines: &[[u32; 2]], made: &Refined, own: usize) {
    for (t, corners) in made.simplices.iter().enumerate() {
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|i| all[corners[(k + i) % 3] as usize]);
            let small = is_below(degrees, a, b, c);
            assert!(
                !small || is_forced(all, lines, made, own, t, k),
                "{a:?} {b:?} {c:?}"
            );
        }
    }
}

/// Whether the angle at `a` is below the bound; at 30 degrees exactly.
fn is_below(degrees: f64, a: Point2, b: Point2, c: Point2) -> bool {
    if degrees != 30.0 {
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let (dot, cross) = (u[0] * v[0] + u[1] * v[1], u[0] * v[1] - u[1] * v[0]);
        return cross.atan2(dot).to_degrees() < degrees - 1e-9;
    }
    let [a, b, c] = [a, b, c].map(|p| p.map(integer));
    let minus = |p: &[BigInt; 2]| [&p[0] - &a[0], &p[1] - &a[1]];
    let dot = |u: &[BigInt; 2], v: &[BigInt; 2]| &u[0] * &v[0] + &u[1] * &v[1];
    let (u, v) = (minus(&b), minus(&c));
    let cosine = dot(&u, &v);
    cosine > BigInt::ZERO && 4 * &cosine * &cosine > 3 * dot(&u, &u) * dot(&v, &v)
}

/// A double of this lattice or its splits as an integer.
fn integer(x: f64) -> BigInt {
    let bits = x.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i64;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (digits, shift) = match exponent {
        0 => (fraction, -1074),
        _ => (fraction | 1 << 52, exponent - 1075),
    };
    let digits = BigInt::from(if x < 0.0 { -digits } else { digits });
    digits << usize::try_from(shift + 1100).expect("a double")
}

/// Whether the angle at corner `k` lies between two lines, or opposite an edge that joins two that
/// meet in a corner, at points on one circle around it.
fn is_forced(
    all: &[Point2],
    lines: &[[u32; 2]],
    made: &Refined,
    own: usize,
    t: usize,
    k: usize,
) -> bool {
    let (corners, sides) = (made.simplices[t], made.sides[t]);
    let [left, right] = [(k + 1) % 3, (k + 2) % 3];
    if sides[left] >= 0 && sides[right] >= 0 {
        return true;
    }
    let on = |v: i32| (v as usize).checked_sub(own).map_or(-1, |row| made.on[row]);
    let [u, v] = [corners[left], corners[right]];
    let [s, r] = [on(u), on(v)];
    if s < 0 || r < 0 || s == r {
        return false;
    }
    let [s, r] = [s, r].map(|line| lines[line as usize]);
    let Some(corner) = s.into_iter().find(|end| r.contains(end)) else {
        return false;
    };
    let apart = |p: Point2, q: Point2| (p[0] - q[0]).hypot(p[1] - q[1]);
    let [p, q, c] = [all[u as usize], all[v as usize], all[corner as usize]];
    let (d, e) = (apart(p, c), apart(q, c));
    let sharp = apart(p, q).partial_cmp(&d.min(e)) == Some(Ordering::Less);
    sharp && (d - e).abs() <= SAME_SHELL * d.max(e)
}
