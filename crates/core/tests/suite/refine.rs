//! Refined meshes, checked exactly where the guarantee is exact.

use std::collections::BTreeMap;

use delone_core::Point2;
use delone_core::base::watch::Watch;
use delone_core::constrained::{Options, components, constrain};
use delone_core::delaunay::plane::Method;
use delone_core::measure;
use delone_core::refine::{Lines, Refined, Rounds, Samples, Task, refine};
use delone_predicates::{Sign, incircle_canonical, orient2d};

/// A triangulation with labels.
struct Domain {
    points: Vec<Point2>,
    simplices: Vec<[i32; 3]>,
    labels: Vec<i32>,
    segments: Vec<[u32; 2]>,
    frozen: Vec<bool>,
}

impl Domain {
    fn task<'a>(&'a self, areas: &'a [f64], min_angle: f64) -> Task<'a> {
        Task {
            points: &self.points,
            simplices: &self.simplices,
            neighbors: None,
            labels: &self.labels,
            areas,
            segments: &self.segments,
            lines: None,
            frozen: &self.frozen,
            min_angle,
            circles: false,
            sizes_yield: false,
            max_vertices: 200_000,
        }
    }
}

/// The inside of rings, each its own loop of segments; triangles that a ray from outside reaches are
/// outside.
fn domain(rings: &[Vec<Point2>]) -> Domain {
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
    let ends = &base.subsegments.ends;
    let segments: Vec<[u32; 2]> = ends.iter().map(|e| e.map(|v| v as u32)).collect();
    Domain {
        points,
        simplices: base.arrays.simplices,
        labels,
        frozen: vec![false; segments.len()],
        segments,
    }
}

/// The mesh inside rings.
fn meshed(rings: &[Vec<Point2>], min_angle: f64, area: f64) -> (Vec<Point2>, Refined) {
    let domain = domain(rings);
    let areas = vec![area; domain.labels.len()];
    let task = domain.task(&areas, min_angle);
    let mut made = refine(task, &Watch::idle()).unwrap();
    keep_inside(&mut made);
    (domain.points, made)
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

/// The most rounds: where no triangle may be split, sizes are never met.
const MOST: usize = 6;

/// Refinements one after the other, each from the arrays of the one before.
fn separately(
    domain: &Domain,
    samples: Samples,
    wanted: impl Fn(Point2) -> f64,
) -> (Refined, usize) {
    let watch = Watch::idle();
    let mut points = domain.points.clone();
    let areas = vec![f64::INFINITY; domain.labels.len()];
    let task = Task {
        max_vertices: 0,
        ..domain.task(&areas, 20.0)
    };
    let ends = &domain.segments;
    let mut on = vec![-1; points.len()];
    let (mut made, mut all, mut rounds) = (refine(task, &watch).unwrap(), Vec::new(), 0);
    loop {
        let areas = measure::areas(&points, &made.simplices, 1, &watch).unwrap();
        let at = |s: &[i32; 3]| s.map(|v| points[v as usize]);
        let mut least: Vec<f64> = (made.simplices.iter())
            .map(|s| {
                let [a, b, c] = at(s).map(|p| p.map(|x| x / 3.0));
                wanted([0, 1].map(|k| a[k] + b[k] + c[k]))
            })
            .collect();
        for (&p, &area) in samples.positions.iter().zip(samples.areas) {
            let inside = |s: &[i32; 3]| {
                let [a, b, c] = at(s);
                [[a, b], [b, c], [c, a]]
                    .iter()
                    .all(|[u, v]| orient2d(*u, *v, p) != Sign::Negative)
            };
            if let Some(t) = made.simplices.iter().position(inside) {
                least[t] = least[t].min(area);
            }
        }
        let large = |t: usize| made.labels[t] >= 0 && areas[t] > least[t];
        let caps: Vec<f64> = (0..areas.len())
            .map(|t| match large(t) {
                true => least[t].max(areas[t] / 4.0),
                false => f64::INFINITY,
            })
            .collect();
        if rounds == MOST || rounds > 0 && caps.iter().all(|cap| cap.is_infinite()) {
            made.added = all;
            return (made, rounds);
        }
        let (mut segments, mut of) = (Vec::new(), Vec::new());
        for (t, s) in made.simplices.iter().enumerate() {
            for k in (0..3).filter(|&k| made.sides[t][k] >= 0 && made.neighbors[t][k] < t as i32) {
                segments.push([s[(k + 1) % 3] as u32, s[(k + 2) % 3] as u32]);
                of.push(made.sides[t][k]);
            }
        }
        let task = Task {
            points: &points,
            simplices: &made.simplices,
            labels: &made.labels,
            areas: &caps,
            segments: &segments,
            lines: Some(Lines {
                of: &of,
                ends,
                on: &on,
            }),
            ..domain.task(&caps, 20.0)
        };
        let next = refine(task, &watch).unwrap();
        points.extend(&next.added);
        all.extend(&next.added);
        on.extend(&next.on);
        (made, rounds) = (next, rounds + 1);
    }
}

/// A refinement in rounds; the number of rounds, of triangles asked about, and of vertices added.
fn in_rounds(
    domain: &Domain,
    samples: Samples,
    wanted: impl Fn(Point2) -> f64,
) -> (Refined, [usize; 3]) {
    let watch = Watch::idle();
    let mut rounds = Rounds::new(domain.task(&[], 20.0), samples, &watch).unwrap();
    let (mut turns, mut seen) = (0, 0);
    loop {
        let fresh = rounds.fresh(2, &watch).unwrap();
        seen += fresh.centers.len();
        let areas: Vec<f64> = fresh.centers.iter().map(|p| wanted(*p)).collect();
        if rounds.comply(&areas, &watch).unwrap() && turns > 0 || turns == MOST {
            break;
        }
        assert!(rounds.refine(200_000, &watch, &mut |_, _| Ok(())).unwrap());
        turns += 1;
    }
    (
        rounds.export(&watch).unwrap(),
        [turns, seen, rounds.added()],
    )
}

fn square() -> Vec<Point2> {
    vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
}

/// A thin hole.
fn notch(gap: f64) -> Vec<Point2> {
    let (near, far) = (0.5 + gap, 0.5 + 2.0 * gap);
    vec![[0.2, 0.5], [0.8, 0.5], [0.8, near], [0.2, far]]
}

/// A triangle below it.
fn slit(gap: f64) -> Vec<Point2> {
    vec![[0.3, 0.5 - gap], [0.7, 0.5 - gap], [0.5, 0.3]]
}

#[test]
fn rounds_are_refinements_one_after_the_other() {
    // Samples on edges and at vertices of the first triangles.
    let lattice: Vec<Point2> = (0..289)
        .map(|i| [i % 17, i / 17].map(|k| f64::from(k) / 16.0))
        .collect();
    let wanted = |p: Point2| 0.002 + 0.02 * (p[0] - p[1]).powi(2);
    let areas: Vec<f64> = lattice.iter().map(|p| wanted(*p)).collect();
    let samples = Samples {
        positions: &lattice,
        areas: &areas,
    };
    let domains = [
        vec![square()],
        vec![square(), notch(1e-3)],
        vec![square(), notch(1e-7)],
        vec![square(), notch(1e-3), slit(1e-2)],
    ];
    for rings in domains {
        let domain = domain(&rings);
        let (expected, count) = separately(&domain, samples, wanted);
        let (made, [turns, seen, added]) = in_rounds(&domain, samples, wanted);
        assert_eq!(turns, count);
        assert_eq!(added, made.added.len());
        assert_eq!(made.added, expected.added);
        assert_eq!(made.simplices, expected.simplices);
        assert_eq!(made.neighbors, expected.neighbors);
        assert_eq!(made.sides, expected.sides);
        assert_eq!(made.labels, expected.labels);
        assert_eq!(made.needles, expected.needles);
        // Most triangles are known from an earlier round.
        assert!(seen < turns * made.simplices.len());
    }
}

#[test]
fn needles_stay_closed_from_round_to_round() {
    let wanted = |_: Point2| 0.002;
    let nowhere = Samples {
        positions: &[],
        areas: &[],
    };
    for gap in [1e-5, 1e-7] {
        let domain = domain(&[square(), notch(1e-7), slit(gap)]);
        let (made, [turns, _, added]) = in_rounds(&domain, nowhere, wanted);
        assert!(turns > 2);
        assert!(made.needles.iter().any(|n| *n >= 0));
        // To fill the gap takes hundreds of thousands.
        assert!(added < 2000, "{gap}: {added}");
    }
}
