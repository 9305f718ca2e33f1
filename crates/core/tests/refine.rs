//! Refined meshes, checked exactly where the guarantee is exact.

use std::collections::BTreeMap;

use delone_core::Point2;
use delone_core::constrained::{Options, components, constrain};
use delone_core::delaunay2::Method;
use delone_core::refine::{Refined, Task, refine};
use delone_core::watch::Watch;
use delone_predicates::{Sign, incircle_canonical, orient2d};

/// The mesh inside rings, each its own loop of segments; triangles that a ray from outside reaches
/// are outside.
fn meshed(rings: &[Vec<Point2>], min_angle: f64, area: f64) -> (Vec<Point2>, Refined) {
    let mut points = Vec::new();
    let mut segments = Vec::new();
    for ring in rings {
        let (first, n) = (points.len() as u32, ring.len() as u32);
        points.extend_from_slice(ring);
        segments.extend((0..n).map(|i| [first + i, first + (i + 1) % n]));
    }
    let options = Options {
        split: false,
        conforming: false,
        max_vertices: 0,
        method: Method::Auto,
        workers: 1,
    };
    let base = constrain(&points, &segments, options, &Watch::idle()).unwrap();
    let labels = components(&base.arrays.neighbors, &base.constrained, &Watch::idle()).unwrap();
    // The parity of the number of segments crossed from outside.
    let mut depth = BTreeMap::new();
    for (t, n) in base.arrays.neighbors.iter().enumerate() {
        for (k, &n) in n.iter().enumerate() {
            if n < 0 {
                depth.insert(labels[t], u32::from(base.constrained[t][k]));
            }
        }
    }
    loop {
        let before = depth.len();
        for (t, n) in base.arrays.neighbors.iter().enumerate() {
            for (k, &n) in n.iter().enumerate().filter(|(_, n)| **n >= 0) {
                if let Some(&d) = depth.get(&labels[t]) {
                    let wall = u32::from(base.constrained[t][k]);
                    depth.entry(labels[n as usize]).or_insert(d + wall);
                }
            }
        }
        if depth.len() == before {
            break;
        }
    }
    let labels: Vec<i32> = labels
        .iter()
        .map(|l| if depth[l] % 2 == 1 { *l } else { -1 })
        .collect();
    let areas = vec![area; labels.len()];
    let segments: Vec<[u32; 2]> = base
        .subsegments
        .ends
        .iter()
        .map(|e| e.map(|v| v as u32))
        .collect();
    let frozen = vec![false; segments.len()];
    let task = Task {
        points: &points,
        simplices: &base.arrays.simplices,
        labels: &labels,
        areas: &areas,
        segments: &segments,
        lines: None,
        frozen: &frozen,
        min_angle,
        circles: false,
        sizes_yield: false,
        max_vertices: 200_000,
    };
    let mut made = refine(task, &Watch::idle()).unwrap();
    keep_inside(&mut made);
    (points, made)
}

/// Drops triangles outside the domain.
fn keep_inside(made: &mut Refined) {
    let mut number = vec![-1; made.labels.len()];
    let inside: Vec<usize> = (0..number.len()).filter(|&t| made.labels[t] >= 0).collect();
    for (i, &t) in (0..).zip(&inside) {
        number[t] = i;
    }
    let across = |n: i32| if n < 0 { -1 } else { number[n as usize] };
    made.neighbors = inside
        .iter()
        .map(|&t| made.neighbors[t].map(across))
        .collect();
    made.simplices = inside.iter().map(|&t| made.simplices[t]).collect();
    made.sides = inside.iter().map(|&t| made.sides[t]).collect();
}

/// Orientation, neighbors, sides, Delaunay; returns the smallest angle in degrees.
fn check(points: &[Point2], made: &Refined) -> f64 {
    let all = [points, &made.added[..]].concat();
    let at = |v: i32| all[v as usize];
    let mut sides = BTreeMap::new();
    let mut smallest = f64::INFINITY;
    for (t, s) in made.simplices.iter().enumerate() {
        let p = s.map(at);
        assert_eq!(orient2d(p[0], p[1], p[2]), Sign::Positive);
        for k in 0..3 {
            assert!(
                sides
                    .insert([s[(k + 1) % 3], s[(k + 2) % 3]], (t, k))
                    .is_none()
            );
            let [u, v] = [1, 2].map(|j| {
                let q = p[(k + j) % 3];
                [q[0] - p[k][0], q[1] - p[k][1]]
            });
            let angle = (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]);
            smallest = smallest.min(angle.to_degrees());
        }
    }
    for (&[u, v], &(t, k)) in &sides {
        match sides.get(&[v, u]) {
            None => {
                assert_eq!(made.neighbors[t][k], -1);
                assert!(made.sides[t][k] >= 0, "the boundary consists of segments");
            }
            Some(&(s, j)) => {
                assert_eq!(made.neighbors[t][k], s as i32);
                assert_eq!(made.sides[t][k], made.sides[s][j]);
                let (p, q) = (made.simplices[t][k], made.simplices[s][j]);
                if made.sides[t][k] < 0 {
                    let inside = incircle_canonical(at(u), at(v), at(p), at(q));
                    assert_ne!(inside, Sign::Positive);
                }
            }
        }
    }
    smallest
}

fn ring(n: usize, radius: impl Fn(f64) -> f64) -> Vec<Point2> {
    (0..n)
        .map(|i| i as f64 * std::f64::consts::TAU / n as f64)
        .map(|a| [radius(a) * a.cos(), radius(a) * a.sin()])
        .collect()
}

#[test]
fn a_square_needs_few_vertices() {
    let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let (points, made) = meshed(std::slice::from_ref(&square), 30.0, f64::INFINITY);
    assert_eq!((made.simplices.len(), made.added.len()), (2, 0));
    assert!(check(&points, &made) > 44.0);
    let (points, made) = meshed(&[square], 30.0, 1e-3);
    let (smallest, count) = (check(&points, &made), made.simplices.len());
    assert!(smallest >= 30.0 - 1e-9, "{smallest}");
    assert!((1000..2500).contains(&count), "{count}");
}

#[test]
fn a_ring_with_a_hole_has_its_angles() {
    let outer = ring(60, |a| 1.0 + 0.3 * (5.0 * a).sin());
    let inner = ring(20, |a| 0.3 + 0.1 * (3.0 * a).cos());
    for degrees in [20.0, 26.0, 30.0, 33.0] {
        let (points, made) = meshed(&[outer.clone(), inner.clone()], degrees, f64::INFINITY);
        assert!(!made.exhausted);
        let smallest = check(&points, &made);
        assert!(smallest >= degrees - 1e-9, "{smallest} of {degrees}");
    }
}

#[test]
fn refinement_terminates_at_sharp_corners() {
    for height in [0.1, 1e-3, 1e-6] {
        let needle = vec![[0.0, 0.0], [1.0, 0.0], [1.0, height]];
        let (points, made) = meshed(&[needle], 30.0, f64::INFINITY);
        assert!(!made.exhausted, "{height}");
        check(&points, &made);
    }
    let star: Vec<Point2> = ring(14, |_| 1.0)
        .into_iter()
        .enumerate()
        .map(|(i, p)| p.map(|x| if i % 2 == 0 { x } else { 0.1 * x }))
        .collect();
    let (points, made) = meshed(&[star], 30.0, 0.01);
    assert!(!made.exhausted);
    check(&points, &made);
}
