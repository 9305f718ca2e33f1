//! Triangulations keep what they promise: the same triangles as the core, Euler's formula, exact
//! predicates, and rows that name what is wrong.

use delone::predicates::{Sign, incircle, insphere, orient2d, orient3d};
use delone::{Constrained, Corner, Error, Location, Options, Point2, Tiling, Triangulation};
use delone::{Triangulation3, Voronoi};
use delone_core::delaunay2::{self, Method};
use delone_core::delaunay3;
use delone_core::watch::Watch;
use proptest::prelude::*;

/// Points of a small lattice, so that many are equal, in line, or on one circle.
fn lattice(most: usize) -> impl Strategy<Value = Vec<Point2>> {
    let axis = || (-4i32..5).prop_map(f64::from);
    prop::collection::vec([axis(), axis()], 1..most)
}

/// V - E + F = 1 for a domain without holes, and each neighbor names its neighbor.
fn is_a_disk(t: &Tiling<2, 3>) -> Result<(), TestCaseError> {
    let edges = t.edges().unwrap();
    let mut vertices: Vec<usize> = edges.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    prop_assert_eq!(vertices.len() + t.simplices().len(), edges.len() + 1);
    are_neighbors(t)
}

fn are_neighbors(t: &Tiling<2, 3>) -> Result<(), TestCaseError> {
    let triangles: Vec<_> = t.simplices().collect();
    let neighbors: Vec<_> = t.neighbors().collect();
    let mut open = 0;
    for (i, (corners, beside)) in triangles.iter().zip(&neighbors).enumerate() {
        let [a, b, c] = corners.map(|v| t.points()[v]);
        prop_assert_eq!(orient2d(a, b, c), Sign::Positive);
        for (k, n) in beside.iter().enumerate() {
            let Some(n) = *n else {
                open += 1;
                continue;
            };
            let back = neighbors[n].iter().position(|m| *m == Some(i)).unwrap();
            let edge = |s: &[usize; 3], k: usize| [s[(k + 1) % 3], s[(k + 2) % 3]];
            let [u, v] = edge(corners, k);
            prop_assert_eq!(edge(&triangles[n], back), [v, u]);
        }
    }
    let boundary = t.boundary().unwrap();
    prop_assert_eq!(boundary.len(), open);
    for [u, v] in boundary {
        let has = |[a, b, c]: &[usize; 3]| [[*a, *b], [*b, *c], [*c, *a]].contains(&[u, v]);
        prop_assert!(triangles.iter().any(has));
    }
    Ok(())
}

proptest! {
    #[test]
    fn a_triangulation_is_that_of_the_core_and_delaunay(points in lattice(40)) {
        let core = delaunay2::triangulate(&points, Method::Auto, 1, &Watch::idle());
        match Options::new().threads(2).triangulate(&points) {
            Ok(t) => {
                is_a_disk(&t)?;
                for [a, b, c] in t.simplices() {
                    let [a, b, c] = [a, b, c].map(|v| points[v]);
                    for p in &points {
                        prop_assert_ne!(incircle(a, b, c, *p), Sign::Positive);
                    }
                }
                let core = core.unwrap();
                prop_assert_eq!(t.duplicates(), core.duplicates);
                let (simplices, neighbors) = Tiling::from(t).into_arrays();
                prop_assert_eq!(simplices, core.arrays.simplices);
                prop_assert_eq!(neighbors, core.arrays.neighbors);
            }
            Err(error) => prop_assert_eq!(error, Error::from(core.unwrap_err())),
        }
    }

    #[test]
    fn every_query_is_where_the_predicates_say(points in lattice(30), queries in lattice(30)) {
        let Ok(t) = Triangulation::new(&points) else { return Ok(()) };
        let triangles: Vec<_> = t.simplices().collect();
        let holds = |s: &[usize; 3], q: Point2| {
            let [a, b, c] = s.map(|v| points[v]);
            [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| orient2d(u, v, q) != Sign::Negative)
        };
        for (&q, place) in queries.iter().zip(t.locate(&queries).unwrap()) {
            let first = triangles.iter().position(|s| holds(s, q));
            prop_assert_eq!(place.simplex(), first);
            let alone = t.locate(&[q]).unwrap()[0];
            if first.is_some() {
                prop_assert_eq!(alone, place);
            } else {
                // At a vertex of the boundary two edges are as near.
                prop_assert_eq!(point_of(&t, alone), point_of(&t, place));
            }
            let distance = |v: usize| (0..2).map(|k| (points[v][k] - q[k]).powi(2)).sum::<f64>();
            let nearest = t.nearest(&[q]).unwrap()[0];
            prop_assert!((0..points.len()).all(|v| distance(v) >= distance(nearest)));
            if let Location::Outside { facet, simplex, .. } = place {
                prop_assert!(facet.iter().all(|v| triangles[simplex].contains(v)));
            }
            let found = point_of(&t, place);
            let off = (found[0] - q[0]).hypot(found[1] - q[1]);
            let fits = if first.is_some() {
                off < 1e-12
            } else {
                off > 0.0 && off * off <= distance(nearest) + 1e-12
            };
            prop_assert!(fits, "{:?} is off by {}", place, off);
        }
    }

    #[test]
    fn segments_are_chains_of_edges(points in lattice(20), rows in prop::collection::vec([0usize..20, 0..20], 0..12)) {
        let segments: Vec<_> = rows.iter().map(|s| s.map(|v| v % points.len())).collect();
        let options = Options::new().threads(1).split_crossings(true);
        let Ok(c) = options.constrain(&points, &segments) else {
            return Ok(());
        };
        is_a_disk(&c)?;
        let edges = c.edges().unwrap();
        let mut covered = vec![0usize; segments.len()];
        for piece in c.subsegments() {
            let [u, v] = piece.ends;
            prop_assert!(edges.contains(&[u.min(v), u.max(v)]));
            piece.sources().for_each(|row| covered[row] += 1);
        }
        for (count, s) in covered.iter().zip(&segments) {
            prop_assert_eq!(*count == 0, points[s[0]] == points[s[1]]);
        }
        let marked = c.is_constrained().iter().map(|sides| sides.iter().filter(|m| **m).count());
        let inner = c.is_constrained().iter().zip(c.neighbors());
        let on_hull = inner.map(|(m, n)| (0..3).filter(|&k| m[k] && n[k].is_none()).count());
        prop_assert_eq!(marked.sum::<usize>() + on_hull.sum::<usize>(), 2 * c.subsegments().len());
    }

    #[test]
    fn a_polygon_has_the_triangles_with_odd_winding_numbers(rings in prop::collection::vec(lattice(8), 1..4)) {
        let Ok(c) = Constrained::polygon(&rings) else { return Ok(()) };
        are_neighbors(&c)?;
        // Crossings are rounded, so that of those that are exact alone a point tells.
        prop_assume!(c.added().is_empty());
        let odd = |q: Point2| {
            let sides = rings.iter().flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
            let over = sides.filter(|&(a, b)| {
                (a[1] <= q[1]) != (b[1] <= q[1]) && {
                    let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
                    orient2d(low, high, q) == Sign::Positive
                }
            });
            over.count() % 2 == 1
        };
        let all: Vec<_> = rings.concat();
        let hull = Triangulation::new(&all).unwrap();
        let inside = c.simplices().map(|s| center(&all, s)).filter(|q| odd(*q)).count();
        prop_assert_eq!(inside, c.simplices().len());
        let area = c.sizes().unwrap().iter().sum::<f64>();
        prop_assert!(area <= hull.sizes().unwrap().iter().sum::<f64>() + 1e-9);
        let exact = even_odd_area(&rings);
        prop_assert!((area - exact).abs() < 1e-9, "{} {}", area, exact);
    }
}

fn center(points: &[Point2], corners: [usize; 3]) -> Point2 {
    [0, 1].map(|k| corners.iter().map(|&v| points[v][k]).sum::<f64>() / 3.0)
}

/// The area of places with an odd winding number, by strips between the heights of the lattice in
/// which, as no two sides cross but at lattice points, sides keep their order.
fn even_odd_area(rings: &[Vec<Point2>]) -> f64 {
    let mut heights: Vec<f64> = rings.iter().flatten().map(|p| p[1]).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let mut area = 0.0;
    for strip in heights.windows(2) {
        let (y0, y1) = (strip[0], strip[1]);
        let y = 0.5 * (y0 + y1);
        let mut at: Vec<f64> = Vec::new();
        for ring in rings {
            for i in 0..ring.len() {
                let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                if (a[1] <= y) != (b[1] <= y) {
                    at.push(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
                }
            }
        }
        at.sort_by(f64::total_cmp);
        area += at.chunks(2).map(|pair| pair[1] - pair[0]).sum::<f64>() * (y1 - y0);
    }
    area
}

/// The point that a location stands for: the query, or the nearest one of the boundary.
fn point_of(t: &Triangulation, place: Location<2, 3>) -> Point2 {
    let (corners, weights) = match place {
        Location::Inside { simplex, weights } => {
            let corners = t.simplices().nth(simplex).unwrap();
            (corners.to_vec(), weights.to_vec())
        }
        Location::Outside { facet, weights, .. } => (facet.to_vec(), weights.to_vec()),
    };
    let pairs = || corners.iter().zip(&weights);
    [0, 1].map(|k| pairs().map(|(v, w)| w * t.points()[*v][k]).sum())
}

fn cube(n: i32) -> Vec<[f64; 3]> {
    let axis = || (0..n).map(f64::from);
    axis()
        .flat_map(|x| axis().flat_map(move |y| axis().map(move |z| [x, y, z])))
        .collect()
}

#[test]
fn tetrahedra_are_those_of_the_core_and_delaunay() {
    let points = cube(4);
    let t = Triangulation3::new(&points).unwrap();
    for s in t.simplices() {
        let [a, b, c, d] = s.map(|v| points[v]);
        assert_eq!(orient3d(a, b, c, d), Sign::Positive);
        assert!(
            points
                .iter()
                .all(|p| insphere(a, b, c, d, *p) != Sign::Positive)
        );
    }
    assert!((t.sizes().unwrap().iter().sum::<f64>() - 27.0).abs() < 1e-12);
    // Euler: V - E + F - T = 1, and each inner face belongs to two tetrahedra.
    let outer = t.boundary().unwrap();
    let faces = (4 * t.simplices().len() + outer.len()) / 2;
    let edges = t.edges().unwrap().len();
    assert_eq!(points.len() + faces, edges + t.simplices().len() + 1);
    for f in outer {
        let [a, b, c] = f.map(|v| points[v]);
        // Counter-clockwise from outside: all points are on the other side.
        assert!(
            points
                .iter()
                .all(|p| orient3d(a, b, c, *p) != Sign::Positive)
        );
    }
    let core = delaunay3::triangulate(&points, 1, &Watch::idle()).unwrap();
    assert_eq!(
        Tiling::from(t).into_arrays(),
        (core.arrays.simplices, core.arrays.neighbors)
    );
}

#[test]
fn queries_in_3d_have_weights_that_give_them_back() {
    let points = cube(3);
    let t = Triangulation3::new(&points).unwrap();
    let Location::Inside { simplex, weights } = t.locate(&[[0.3, 1.2, 0.7]]).unwrap()[0] else {
        panic!("inside")
    };
    let corners = t.simplices().nth(simplex).unwrap();
    let mean = |k: usize| {
        (0..4)
            .map(|i| weights[i] * points[corners[i]][k])
            .sum::<f64>()
    };
    for (k, x) in [0.3, 1.2, 0.7].into_iter().enumerate() {
        assert!((mean(k) - x).abs() < 1e-14);
    }
    let Location::Outside { facet, weights, .. } = t.locate(&[[0.5, 0.25, -3.0]]).unwrap()[0]
    else {
        panic!("outside")
    };
    let mean = |k: usize| {
        (0..3)
            .map(|i| weights[i] * points[facet[i]][k])
            .sum::<f64>()
    };
    assert_eq!([mean(0), mean(1), mean(2)], [0.5, 0.25, 0.0]);
    assert_eq!(
        t.nearest(&[[2.2, 1.9, 1.4]]).unwrap(),
        [points.iter().position(|p| *p == [2.0, 2.0, 1.0]).unwrap()]
    );
}

#[test]
fn errors_name_their_rows() {
    let nan = Triangulation::new(&[[0.0, 0.0], [f64::NAN, 1.0], [1.0, 0.0]]).unwrap_err();
    let Error::NonFinite { rows, count, .. } = &nan else {
        panic!("{nan}")
    };
    assert_eq!((&rows[..], *count), (&[1][..], 1));
    assert_eq!(
        nan.to_string(),
        "1 row has a coordinate that is NaN or infinite: row 1"
    );
    let line = Triangulation::new(&[[2.0, 2.0], [0.0, 0.0], [1.0, 1.0]]).unwrap_err();
    let Error::Collinear { rows, .. } = &line else {
        panic!("{line}")
    };
    assert_eq!(rows, &[1, 2, 0]);
    let two = Triangulation3::new(&[[0.0; 3], [1.0; 3], [0.0; 3]]).unwrap_err();
    let Error::TooFew { rows, .. } = &two else {
        panic!("{two}")
    };
    assert_eq!(rows, &[0, 1]);
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let flat = Triangulation3::new(&square.map(|[x, y]| [x, y, 0.0])).unwrap_err();
    assert!(matches!(flat, Error::Coplanar { rows, .. } if rows.len() == 4));
    let crossing = Constrained::new(&square, &[[0, 2], [0, 1], [1, 3]]).unwrap_err();
    let Error::Crossing { pairs, points, .. } = crossing else {
        panic!()
    };
    assert_eq!(
        (&pairs[..], &points[..]),
        (&[[0, 2]][..], &[[0.5, 0.5]][..])
    );
    let row = Constrained::new(&square, &[[0, 1], [2, 4]]).unwrap_err();
    assert_eq!(
        row.to_string(),
        "segment 1 ends at row 4, but there are 4 points"
    );
    let t = Triangulation::new(&square).unwrap();
    let query = t.locate(&[[0.0, 0.0], [0.0, f64::INFINITY]]).unwrap_err();
    assert!(matches!(query, Error::NonFinite { rows, count: 1, .. } if rows == [1]));
    let many = t.locate(&[[f64::NAN; 2]; 30]).unwrap_err();
    assert!(matches!(many, Error::NonFinite { rows, count: 30, .. } if rows.len() == 10));
    let voronoi = Voronoi::new(&t).unwrap();
    assert!(matches!(
        voronoi.clip([0.0, 0.0], [0.0, 1.0]),
        Err(Error::Option(_))
    ));
    let c = Constrained::polygon(&[square]).unwrap();
    assert!(matches!(
        Options::new().min_angle(60.0).mesh(&c),
        Err(Error::Option(_))
    ));
    assert!(matches!(
        Options::new().max_area(0.0).mesh(&c),
        Err(Error::Option(_))
    ));
}

/// A square in a square, and the segments of both.
fn frame() -> (Vec<Point2>, Vec<[usize; 2]>) {
    let square = |low: f64, high: f64| [[low, low], [high, low], [high, high], [low, high]];
    let points = [square(0.0, 6.0), square(2.0, 4.0)].concat();
    let ring = |first: usize| (0..4).map(move |i| [first + i, first + (i + 1) % 4]);
    (points, ring(0).chain(ring(4)).collect())
}

#[test]
fn holes_and_the_outside_are_removed() {
    let (mut points, segments) = frame();
    points.push([9.0, 3.0]);
    let area = |c: &Constrained| c.sizes().unwrap().iter().sum::<f64>();
    assert_eq!(area(&Constrained::new(&points, &segments).unwrap()), 45.0);
    let enclosed = Options::new().enclosed_only(true);
    assert_eq!(area(&enclosed.constrain(&points, &segments).unwrap()), 36.0);
    let holed = enclosed.holes(&[[3.0, 3.0]]);
    let c = holed.constrain(&points, &segments).unwrap();
    assert_eq!(area(&c), 32.0);
    assert_eq!(c.boundary().unwrap().len(), 8);
    assert_eq!(c.locate(&[[3.0, 3.5]]).unwrap()[0].simplex(), None);
    // The eight edges of both rings are on the boundary, and each once.
    let marked = c
        .is_constrained()
        .iter()
        .map(|sides| sides.iter().filter(|m| **m).count());
    assert_eq!(marked.sum::<usize>(), 8);
    for seed in [[0.0, 3.0], [2.0, 2.0], [10.0, 10.0], [4.0, 3.5]] {
        let found = enclosed
            .holes(&[[3.0, 3.0], seed])
            .constrain(&points, &segments);
        assert!(
            matches!(found, Err(Error::Seed { hole: 1, .. })),
            "{seed:?}"
        );
    }
    let all = enclosed
        .holes(&[[3.0, 3.0], [1.0, 1.0]])
        .constrain(&points, &segments);
    assert_eq!(all.err(), Some(Error::EmptyDomain));
    let none = Options::new()
        .enclosed_only(true)
        .constrain(&points, &segments[1..4]);
    assert_eq!(none.err(), Some(Error::EmptyDomain));
}

#[test]
fn the_seed_of_a_hole_may_not_be_an_end_of_any_segment() {
    let around = |i: i32| [f64::from(i % 3 - 1), f64::from(i / 3 - 1)];
    let points: Vec<Point2> = (0..9).map(around).collect();
    for end in (0..9).filter(|end| *end != 4) {
        let seed = Options::new()
            .holes(&[[0.0, 0.0]])
            .constrain(&points, &[[end, 4]]);
        assert!(matches!(seed, Err(Error::Seed { hole: 0, .. })), "{end}");
    }
}

#[test]
fn meshes_meet_their_bounds_and_keep_the_domain() {
    let (points, segments) = frame();
    let domain = Options::new()
        .holes(&[[3.0, 3.0]])
        .constrain(&points, &segments)
        .unwrap();
    let told = std::sync::atomic::AtomicUsize::new(0);
    let tell = |added: usize, _: &mut dyn FnMut() -> f64| {
        told.fetch_max(added, std::sync::atomic::Ordering::Relaxed);
    };
    let mesh = Options::new()
        .min_angle(30.0)
        .max_area(0.01)
        .progress(&tell)
        .mesh(&domain)
        .unwrap();
    assert!(mesh.is_complete());
    are_neighbors(&mesh).unwrap();
    let smallest = mesh.min_angles().unwrap().into_iter().fold(60.0, f64::min);
    // The bound is compared as a squared cosine, rounded.
    assert!(smallest > 30.0 - 1e-9, "{smallest}");
    let areas = mesh.sizes().unwrap();
    assert!(areas.iter().all(|area| *area <= 0.01));
    assert!((areas.iter().sum::<f64>() - 32.0).abs() < 1e-10);
    assert_eq!(mesh.points()[..8], points);
    assert_eq!(mesh.points().len(), 8 + mesh.added().len());
    assert!((1..=mesh.added().len()).contains(&told.into_inner()));
    // The boundary is all that is constrained here.
    for (sides, beside) in mesh.is_constrained().iter().zip(mesh.neighbors()) {
        assert_eq!(*sides, beside.map(|n| n.is_none()));
    }
    // V - E + F = 0 with one hole.
    let (edges, faces) = (mesh.edges().unwrap().len(), mesh.simplices().len());
    assert_eq!(mesh.points().len() + faces, edges);
    let few = Options::new()
        .max_area(0.01)
        .max_points(50)
        .mesh(&domain)
        .unwrap();
    assert!(!few.is_complete() && few.added().len() <= 50);
}

#[test]
fn a_hull_without_segments_can_be_meshed() {
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 1.0], [0.0, 1.0], [5.0, 0.3]];
    let domain = Constrained::new(&points, &[]).unwrap();
    let mesh = Options::new().min_angle(25.0).mesh(&domain).unwrap();
    assert!((mesh.sizes().unwrap().iter().sum::<f64>() - 10.0).abs() < 1e-12);
    assert!(
        mesh.min_angles()
            .unwrap()
            .into_iter()
            .all(|angle| angle >= 25.0)
    );
}

#[test]
fn conforming_segments_have_empty_circles() {
    let points = [[0.0, 0.0], [10.0, 0.0], [5.0, 0.5], [5.0, -3.0]];
    let c = Options::new()
        .conforming(true)
        .constrain(&points, &[[0, 1]])
        .unwrap();
    assert!(!c.added().is_empty());
    for piece in c.subsegments() {
        let [a, b] = piece.ends.map(|v| c.points()[v]);
        let acute =
            |p: &Point2| (a[0] - p[0]) * (b[0] - p[0]) + (a[1] - p[1]) * (b[1] - p[1]) >= 0.0;
        assert!(c.points().iter().all(acute));
    }
    let few = Options::new()
        .conforming(true)
        .max_points(0)
        .constrain(&points, &[[0, 1]]);
    assert!(matches!(few, Err(Error::Budget { limit: 0, segments, .. }) if segments == [0]));
}

#[test]
fn every_long_call_can_be_interrupted() {
    let golden = |i: u32| [f64::from(i) * 0.618_033_988_749_894_9 % 1.0, f64::from(i)];
    let points: Vec<Point2> = (0..60_000).map(golden).collect();
    let stop = || true;
    let options = Options::new().threads(2).interrupt(&stop);
    let stopped = Some(Error::Interrupted);
    assert_eq!(options.triangulate(&points).err(), stopped);
    let solid: Vec<_> = points.iter().map(|&[x, y]| [x, y, x * y % 7.0]).collect();
    assert_eq!(options.triangulate(&solid).err(), stopped);
    let segments = [[0, 1]];
    assert_eq!(options.constrain(&points, &segments).err(), stopped);
    let t = Triangulation::new(&points).unwrap();
    assert_eq!(options.voronoi(&t).err(), stopped);
    let domain = Constrained::new(&points, &[]).unwrap();
    assert_eq!(options.mesh(&domain).err(), stopped);
}

#[test]
fn cells_fill_the_box() {
    let points = [
        [0.0, 0.0],
        [3.0, 1.0],
        [1.0, 4.0],
        [3.0, 1.0],
        [5.0, 5.0],
        [2.0, 2.0],
    ];
    let t = Triangulation::new(&points).unwrap();
    let voronoi = Voronoi::new(&t).unwrap();
    let cells = voronoi.clip([-1.0, -1.0], [6.0, 6.0]).unwrap();
    let total: f64 = (0..points.len()).map(|row| cells.area(row)).sum();
    assert!((total - 49.0).abs() < 1e-12);
    assert_eq!(
        (cells.area(3), cells.polygon(3).len(), cells.centroid(3)),
        (0.0, 0, None)
    );
    for (row, p) in points.iter().enumerate().filter(|(row, _)| *row != 3) {
        for corner in cells.polygon(row) {
            let to = |q: &Point2| (q[0] - corner[0]).hypot(q[1] - corner[1]);
            assert!(points.iter().all(|q| to(q) >= to(p) - 1e-12));
        }
    }
    for ridge in voronoi.ridges() {
        let [a, b] = ridge.sites.map(|v| points[v]);
        if let [Corner::Ray(ray), Corner::Vertex(v)] = ridge.corners {
            let corner = voronoi.vertices()[v];
            // Far along the ray both sites are the nearest.
            let far = [0, 1].map(|k| corner[k] + 1e3 * ray[k]);
            let to = |p: Point2| (p[0] - far[0]).hypot(p[1] - far[1]);
            assert!((to(a) - to(b)).abs() < 1e-9);
            assert!(points.iter().all(|p| to(*p) >= to(a) - 1e-9));
        }
        assert!(t.edges().unwrap().contains(&{
            let [a, b] = ridge.sites;
            [a.min(b), a.max(b)]
        }));
    }
}

#[test]
fn triangulations_can_be_shared_between_threads() {
    let points: Vec<Point2> = (0..500)
        .map(|i| [f64::from(i % 23), f64::from(i * 7 % 31)])
        .collect();
    let t = Triangulation::new(points).unwrap();
    let place = |x: f64| t.locate(&[[x, 1.5 * x]]).unwrap();
    let alone: Vec<_> = (0..20).map(|x| place(f64::from(x))).collect();
    let fresh = Triangulation::new(t.points().to_vec()).unwrap();
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for (x, expected) in alone.iter().enumerate() {
                    let x = x as f64;
                    assert_eq!(fresh.locate(&[[x, 1.5 * x]]).unwrap(), *expected);
                }
            });
        }
    });
}
