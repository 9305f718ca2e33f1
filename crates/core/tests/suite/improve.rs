//! Improved tetrahedra, checked exactly where the guarantee is exact.

use std::collections::{BTreeMap, BTreeSet};

use delone_core::Point3;
use delone_core::base::error::{Error, Result};
use delone_core::base::target::Target;
use delone_core::base::watch::Watch;
use delone_core::solids::improve::{Improved, Task, coarsen, improve, relax};
use delone_predicates::{Sign, orient3d};
use num_rational::BigRational;
use num_traits::Zero;

/// A cube of n^3 cells of six tetrahedra each; the vertices inside are perturbed.
fn shaken(n: usize, by: f64) -> (Vec<Point3>, Vec<[i32; 4]>) {
    let mut state = 1_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let side = n + 1;
    let mut points = Vec::new();
    for x in 0..side {
        for y in 0..side {
            for z in 0..side {
                let inside = [x, y, z].iter().all(|&c| c > 0 && c < n);
                let shake = if inside { by } else { 0.0 };
                points.push([x, y, z].map(|c| c as f64 + shake * random()));
            }
        }
    }
    let mut simplices = Vec::new();
    let index = |c: [usize; 3]| ((c[0] * side + c[1]) * side + c[2]) as i32;
    for cell in 0..n * n * n {
        let low = [cell / (n * n), cell / n % n, cell % n];
        for [i, j] in [[0, 1], [1, 2], [2, 0], [1, 0], [2, 1], [0, 2]] {
            let mut corners = [low; 4];
            corners[1][i] += 1;
            corners[2][i] += 1;
            corners[2][j] += 1;
            corners[3] = low.map(|c| c + 1);
            let mut v = corners.map(index);
            let [a, b, c, d] = v.map(|v| points[v as usize]);
            if orient3d(a, b, c, d) == Sign::Negative {
                v.swap(0, 1);
            }
            simplices.push(v);
        }
    }
    (points, simplices)
}

fn task<'a>(points: &'a [Point3], simplices: &'a [[i32; 4]]) -> Task<'a> {
    Task {
        points,
        simplices,
        labels: &[],
        fixed: &[],
        removable: &[],
        min_angle: 30.0,
        flips: true,
        smooth: true,
        exude: false,
        turn: false,
        tolerance: 0.0,
        passes: 10,
        most: 0,
    }
}

fn run(task: Task) -> Result<Improved> {
    improve(task, &Watch::idle(), &mut |_, _| Ok(()))
}

/// Six times the volume, exactly.
fn volume(p: [Point3; 4]) -> BigRational {
    let [a, b, c, d] = p.map(|p| p.map(|x| BigRational::from_float(x).unwrap()));
    let [u, v, w] = [b, c, d].map(|p| [0, 1, 2].map(|k| &p[k] - &a[k]));
    let minor = |i: usize, j: usize| &v[i] * &w[j] - &v[j] * &w[i];
    &u[0] * minor(1, 2) + &u[1] * minor(2, 0) + &u[2] * minor(0, 1)
}

fn total(points: &[Point3], simplices: &[[i32; 4]]) -> BigRational {
    let places = |v: &[i32; 4]| v.map(|v| points[v as usize]);
    let all = simplices.iter().map(|v| volume(places(v)));
    all.inspect(|v| assert!(*v > BigRational::zero()))
        .fold(BigRational::zero(), |sum, v| sum + v)
}

/// The largest squared cosine of an acute angle, exactly: that of the smallest angle.
fn sharpest(points: &[Point3], simplices: &[[i32; 4]]) -> BigRational {
    let mut worst = BigRational::zero();
    for v in simplices {
        let p = v.map(|v| points[v as usize].map(|x| BigRational::from_float(x).unwrap()));
        let normal = |[a, b, c]: [usize; 3]| {
            let [u, w] = [b, c].map(|q| [0, 1, 2].map(|k| &p[q][k] - &p[a][k]));
            [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &u[i] * &w[j] - &u[j] * &w[i])
        };
        let n = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]].map(normal);
        let dot = |i: usize, j: usize| {
            let products = (0..3).map(|k| &n[i][k] * &n[j][k]);
            products.fold(BigRational::zero(), |sum, x| sum + x)
        };
        for i in 0..4 {
            for j in 0..i {
                let cosine = -dot(i, j);
                if cosine > BigRational::zero() {
                    let square = &cosine * &cosine / (dot(i, i) * dot(j, j));
                    worst = worst.max(square);
                }
            }
        }
    }
    worst
}

/// Faces with one tetrahedron, as sets; checks neighbors on the way.
fn boundary(simplices: &[[i32; 4]], neighbors: Option<&[[i32; 4]]>) -> BTreeSet<[i32; 3]> {
    let mut sides: BTreeMap<[i32; 3], Vec<(usize, usize)>> = BTreeMap::new();
    for (t, v) in simplices.iter().enumerate() {
        for k in 0..4 {
            let mut face = [1, 2, 3].map(|i| v[(k + i) % 4]);
            face.sort_unstable();
            sides.entry(face).or_default().push((t, k));
        }
    }
    for sides in sides.values() {
        assert!(sides.len() <= 2);
        for (i, &(t, k)) in sides.iter().enumerate() {
            let other = sides.get(1 - i).map_or(-1, |&(u, _)| u as i32);
            if let Some(neighbors) = neighbors {
                assert_eq!(neighbors[t][k], other);
            }
        }
    }
    let alone = sides.into_iter().filter(|(_, s)| s.len() == 1);
    alone.map(|(face, _)| face).collect()
}

#[test]
fn a_shaken_cube_becomes_better() {
    let (points, simplices) = shaken(4, 0.6);
    let made = run(task(&points, &simplices)).unwrap();
    assert!(made.counts.edges > 0 && made.counts.faces > 0 && made.counts.moves > 0);
    let (before, after) = (
        sharpest(&points, &simplices),
        sharpest(&made.points, &made.simplices),
    );
    assert!(after < before);
    assert_eq!(
        total(&points, &simplices),
        total(&made.points, &made.simplices)
    );
    let walls = boundary(&made.simplices, Some(&made.neighbors));
    assert_eq!(boundary(&simplices, None), walls);
    for &v in walls.iter().flatten() {
        assert_eq!(points[v as usize], made.points[v as usize]);
    }
}

#[test]
fn removals_move_no_vertex() {
    let (points, simplices) = shaken(4, 0.6);
    let made = run(Task {
        smooth: false,
        ..task(&points, &simplices)
    });
    let made = made.unwrap();
    assert_eq!((made.counts.moves, &made.points), (0, &points));
    assert!(made.counts.edges > 0);
    assert!(sharpest(&points, &made.simplices) <= sharpest(&points, &simplices));
}

#[test]
fn the_result_is_independent_of_row_order() {
    let (points, simplices) = shaken(3, 0.6);
    let n = points.len();
    let row = |v: usize| (v * 7 + 3) % n;
    let mut mixed = vec![[0.0; 3]; n];
    for (v, &p) in points.iter().enumerate() {
        mixed[row(v)] = p;
    }
    let mut other: Vec<[i32; 4]> = simplices
        .iter()
        .map(|v| v.map(|v| row(v as usize) as i32))
        .map(|[a, b, c, d]| [c, a, b, d])
        .collect();
    other.reverse();
    for most in [0, 100] {
        let ask = |task| Task {
            most,
            flips: most == 0,
            smooth: most == 0,
            ..task
        };
        let (one, two) = (
            run(ask(task(&points, &simplices))).unwrap(),
            run(ask(task(&mixed, &other))).unwrap(),
        );
        // Added vertices have the same rows in both.
        let row = |v: usize| if v < n { row(v) } else { v };
        for (v, p) in one.points.iter().enumerate() {
            assert_eq!(*p, two.points[row(v)]);
        }
        let same = one.simplices.iter().zip(&two.simplices);
        for (a, b) in same {
            assert_eq!(a.map(|v| row(v as usize) as i32), *b);
        }
        assert_eq!(one.counts, two.counts);
        assert_eq!(one.counts.added > 0, most > 0);
    }
}

#[test]
fn labels_are_walls_and_fixed_vertices_stay() {
    let (points, simplices) = shaken(4, 0.6);
    let labels: Vec<i32> = (0..simplices.len())
        .map(|t| (t >= simplices.len() / 2) as i32)
        .collect();
    let fixed: Vec<bool> = (0..points.len()).map(|v| v % 3 == 0).collect();
    let made = run(Task {
        labels: &labels,
        fixed: &fixed,
        ..task(&points, &simplices)
    })
    .unwrap();
    let part = |simplices: &[[i32; 4]], labels: &[i32], label: i32| -> Vec<[i32; 4]> {
        let all = simplices.iter().zip(labels);
        all.filter(|(_, l)| **l == label).map(|(v, _)| *v).collect()
    };
    for label in 0..2 {
        let (old, new) = (
            part(&simplices, &labels, label),
            part(&made.simplices, &made.labels, label),
        );
        assert_eq!(boundary(&old, None), boundary(&new, None));
        assert_eq!(total(&points, &old), total(&made.points, &new));
    }
    for v in (0..points.len()).filter(|&v| fixed[v]) {
        assert_eq!(points[v], made.points[v]);
    }
    assert!(made.counts.moves > 0);
}

#[test]
fn added_vertices_fill_the_same_regions() {
    let (points, simplices) = shaken(4, 0.6);
    let labels: Vec<i32> = (0..simplices.len())
        .map(|t| (t >= simplices.len() / 2) as i32)
        .collect();
    let fixed = vec![true; points.len()];
    for most in [0, 5, 1000] {
        // Nothing else changes: no vertex may move, and no edge is removed.
        let made = run(Task {
            labels: &labels,
            fixed: &fixed,
            flips: false,
            most,
            ..task(&points, &simplices)
        });
        let made = made.unwrap();
        let added = made.points.len() - points.len();
        assert_eq!(added, made.counts.added);
        assert!(if most < 1000 {
            added == most
        } else {
            added > 20
        });
        assert_eq!(made.points[..points.len()], points);
        let used: BTreeSet<i32> = made.simplices.iter().flatten().copied().collect();
        assert!(used.into_iter().eq(0..made.points.len() as i32));
        boundary(&made.simplices, Some(&made.neighbors));
        for label in 0..2 {
            let part = |simplices: &[[i32; 4]], labels: &[i32]| -> Vec<[i32; 4]> {
                let all = simplices.iter().zip(labels).filter(|(_, l)| **l == label);
                all.map(|(v, _)| *v).collect()
            };
            let (old, new) = (
                part(&simplices, &labels),
                part(&made.simplices, &made.labels),
            );
            assert_eq!(boundary(&old, None), boundary(&new, None));
            assert_eq!(total(&points, &old), total(&made.points, &new));
        }
        let sharper = sharpest(&made.points, &made.simplices) < sharpest(&points, &simplices);
        assert_eq!(sharper, most > 0);
    }
}

#[test]
fn a_sliver_with_vertices_on_the_boundary_gets_a_vertex() {
    // Nearly a square, between two vertices above and below: no vertex may move.
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.01],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.01],
        [0.5, 0.5, 1.0],
        [0.5, 0.5, -1.0],
    ];
    let simplices = [
        [0, 1, 2, 3],
        [0, 1, 3, 4],
        [1, 2, 3, 4],
        [1, 0, 2, 5],
        [0, 3, 2, 5],
    ];
    let made = run(Task {
        flips: false,
        most: 3,
        ..task(&points, &simplices)
    });
    let made = made.unwrap();
    assert_eq!((made.counts.added, made.simplices.len()), (1, 8));
    assert_eq!(
        total(&points, &simplices),
        total(&made.points, &made.simplices)
    );
}

#[test]
fn a_fixed_vertex_is_not_lost_to_a_better_place() {
    // The star of a vertex close to a face of an octahedron: with a vertex in the middle instead,
    // all tetrahedra would be good.
    let mut points: Vec<Point3> = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut corner = [0.0; 3];
            corner[axis] = side;
            points.push(corner);
        }
    }
    points.push([0.3, 0.32, 0.34]);
    let mut simplices = Vec::new();
    for (x, y, z) in (0..8).map(|k| (k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2))) {
        let [a, b, c, d] = [x, y, z, 6].map(|v| points[v]);
        let positive = orient3d(a, b, c, d) == Sign::Positive;
        let [y, z] = if positive { [y, z] } else { [z, y] };
        simplices.push([x as i32, y as i32, z as i32, 6]);
    }
    let fixed = [false, false, false, false, false, false, true];
    let made = run(Task {
        fixed: &fixed,
        flips: false,
        most: 5,
        ..task(&points, &simplices)
    });
    let made = made.unwrap();
    assert!(made.simplices.iter().flatten().any(|&v| v == 6));
    assert_eq!(
        total(&points, &simplices),
        total(&made.points, &made.simplices)
    );
}

#[test]
fn faces_of_the_boundary_turn_in_their_plane() {
    // Two tetrahedra over a flat kite: the long diagonal is the worse one.
    let points = [
        [0.0, -4.0, 0.0],
        [0.0, 4.0, 0.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let simplices = [[0, 2, 1, 4], [0, 1, 3, 4]];
    let kept = run(task(&points, &simplices)).unwrap();
    assert_eq!(kept.counts.edges, 0);
    let made = run(Task {
        turn: true,
        min_angle: 60.0,
        ..task(&points, &simplices)
    });
    let made = made.unwrap();
    assert_eq!(made.simplices.len(), 2);
    assert_eq!(made.counts.boundary, made.counts.edges);
    assert_eq!(
        total(&points, &simplices),
        total(&made.points, &made.simplices)
    );
}

#[test]
fn tiny_and_huge_coordinates_behave_as_others() {
    let (points, simplices) = shaken(3, 0.5);
    let ask = |points: &[Point3]| {
        run(Task {
            most: 100,
            flips: false,
            smooth: false,
            ..task(points, &simplices)
        })
    };
    let plain = ask(&points).unwrap();
    assert!(plain.counts.added > 0);
    for power in [-600, 700] {
        let scale = 2_f64.powi(power);
        let scaled: Vec<Point3> = points.iter().map(|p| p.map(|x| x * scale)).collect();
        let made = ask(&scaled).unwrap();
        assert_eq!(made.simplices, plain.simplices);
        let back: Vec<Point3> = made.points.iter().map(|p| p.map(|x| x / scale)).collect();
        assert_eq!(back, plain.points);
    }
}

#[test]
fn invalid_meshes_are_rejected() {
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, 2.0],
        [0.0, 0.0, 0.0],
    ];
    let refused = |simplices: &[[i32; 4]], what: &str| {
        let Err(Error::Shape(message)) = run(task(&corners, simplices)) else {
            panic!("{what} was not rejected");
        };
        assert!(message.contains(what), "{message}");
    };
    refused(&[[1, 0, 2, 3]], "negatively oriented");
    refused(&[[0, 3, 4, 1]], "flat");
    refused(&[[0, 1, 2, 3], [5, 1, 2, 4]], "same point");
    let shared = "on the same side of the face of rows 0, ";
    refused(&[[0, 1, 2, 3], [0, 1, 2, 4]], shared);
    refused(&[[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 2, 3]], shared);
    let nothing = run(task(&corners, &[])).unwrap();
    assert_eq!(nothing.simplices.len(), 0);
}

/// The changes that need not improve anything.
type Change = fn(Task, &Watch) -> Result<Improved>;
const CHANGES: [(&str, Change); 4] = [
    ("coarsen", coarsen),
    ("lloyd", |task, watch| relax(task, Target::Lloyd, watch)),
    ("odt", |task, watch| relax(task, Target::Odt, watch)),
    ("laplace", |task, watch| relax(task, Target::Laplace, watch)),
];

#[test]
fn coarser_and_smoother_cubes_keep_walls_and_angles() {
    let (points, simplices) = shaken(5, 0.6);
    let labels: Vec<i32> = (0..simplices.len())
        .map(|t| (t >= simplices.len() / 2) as i32)
        .collect();
    let fixed: Vec<bool> = (0..points.len()).map(|v| v % 5 == 0).collect();
    let removable = vec![true; points.len()];
    let part = |simplices: &[[i32; 4]], labels: &[i32], label: i32| -> Vec<[i32; 4]> {
        let all = simplices.iter().zip(labels);
        all.filter(|(_, l)| **l == label).map(|(v, _)| *v).collect()
    };
    for (name, change) in CHANGES {
        let given = Task {
            labels: &labels,
            fixed: &fixed,
            removable: &removable,
            ..task(&points, &simplices)
        };
        let made = change(given, &Watch::idle()).unwrap();
        boundary(&made.simplices, Some(&made.neighbors));
        for label in 0..2 {
            let (old, new) = (
                part(&simplices, &labels, label),
                part(&made.simplices, &made.labels, label),
            );
            assert_eq!(boundary(&old, None), boundary(&new, None), "{name}");
            assert_eq!(total(&points, &old), total(&made.points, &new), "{name}");
        }
        let before = sharpest(&points, &simplices);
        assert!(sharpest(&made.points, &made.simplices) <= before, "{name}");
        let used: BTreeSet<i32> = made.simplices.as_flattened().iter().copied().collect();
        assert_eq!(used.len() + made.counts.removed, points.len(), "{name}");
        for v in (0..points.len()).filter(|&v| fixed[v]) {
            assert!(points[v] == made.points[v] && used.contains(&(v as i32)));
        }
        assert!(made.counts.removed + made.counts.moves > 0, "{name}");
        assert_eq!(made.counts.removed > 0, name == "coarsen");
    }
}

#[test]
fn a_vertex_is_removed_only_if_it_may_be() {
    let (points, simplices) = shaken(4, 0.2);
    let all = Task {
        min_angle: 0.0,
        ..task(&points, &simplices)
    };
    assert_eq!(coarsen(all, &Watch::idle()).unwrap().counts.removed, 0);
    // One interior vertex.
    let only: Vec<bool> = points
        .iter()
        .map(|p| p.iter().all(|x| (x - 2.0).abs() < 0.3))
        .collect();
    let one = Task {
        removable: &only,
        ..all
    };
    let made = coarsen(one, &Watch::idle()).unwrap();
    let row = only.iter().position(|&may| may).unwrap() as i32;
    assert_eq!(made.counts.removed, 1);
    assert!(!made.simplices.as_flattened().contains(&row));
    let wrong = Task {
        removable: &only[1..],
        ..all
    };
    assert!(matches!(
        coarsen(wrong, &Watch::idle()),
        Err(Error::Shape(_))
    ));
}

/// The smallest sine of a dihedral angle, where those of obtuse angles count twice.
fn quality(p: [Point3; 4]) -> f64 {
    let minus = |a: Point3, b: Point3| [0, 1, 2].map(|k| a[k] - b[k]);
    let cross =
        |a: Point3, b: Point3| [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i]);
    let dot = |a: Point3, b: Point3| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    // The faces opposite each corner, inward.
    let faces = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];
    let n = faces.map(|[a, b, c]: [usize; 3]| cross(minus(p[b], p[a]), minus(p[c], p[a])));
    let mut worst = f64::INFINITY;
    for i in 0..4 {
        for j in 0..i {
            let cosine = -dot(n[i], n[j]) / (dot(n[i], n[i]) * dot(n[j], n[j])).sqrt();
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            worst = worst.min(if cosine < 0.0 { 2.0 * sine } else { sine });
        }
    }
    worst
}

#[test]
fn a_vertex_goes_to_its_best_neighbor() {
    let (points, simplices) = shaken(4, 0.5);
    let places = |v: &[i32; 4]| v.map(|v| points[v as usize]);
    let mut choices = 0;
    for v in 0..points.len() as i32 {
        if !points[v as usize].iter().all(|x| (0.6..3.4).contains(x)) {
            continue;
        }
        let removable: Vec<bool> = (0..points.len() as i32).map(|w| w == v).collect();
        let given = Task {
            min_angle: 1.0,
            removable: &removable,
            ..task(&points, &simplices)
        };
        let made = coarsen(given, &Watch::idle()).unwrap();
        // The worst new tetrahedron for each neighbor, if all are positive.
        let star: Vec<[i32; 4]> = simplices
            .iter()
            .filter(|t| t.contains(&v))
            .copied()
            .collect();
        let neighbors: BTreeSet<i32> = star.as_flattened().iter().copied().collect();
        let worst = |u: i32| {
            let others = star.iter().filter(|t| !t.contains(&u));
            let new = others.map(|t| t.map(|w| if w == v { u } else { w }));
            let positive = |t: &[i32; 4]| {
                let [a, b, c, d] = places(t);
                orient3d(a, b, c, d) == Sign::Positive
            };
            let value = |t: [i32; 4]| {
                if positive(&t) {
                    quality(places(&t))
                } else {
                    0.0
                }
            };
            new.map(value).fold(f64::INFINITY, f64::min)
        };
        let all: Vec<f64> = neighbors
            .iter()
            .filter(|&&u| u != v)
            .map(|&u| worst(u))
            .collect();
        let best = all.iter().copied().fold(0.0, f64::max);
        let old: BTreeSet<[i32; 4]> = simplices.iter().map(|t| sorted(*t)).collect();
        let new = made
            .simplices
            .iter()
            .filter(|t| !old.contains(&sorted(**t)));
        let found = new
            .map(|t| quality(places(t)))
            .fold(f64::INFINITY, f64::min);
        if made.counts.removed == 1 {
            assert!((found - best).abs() < 1e-9, "{v}: {found} {best}");
            choices += usize::from(all.iter().filter(|&&q| q > 0.02).count() > 1);
        }
    }
    assert!(choices > 3, "{choices}");
}

fn sorted(mut t: [i32; 4]) -> [i32; 4] {
    t.sort_unstable();
    t
}

#[test]
fn large_cubes_change_everywhere() {
    // More vertices than are passed between two checks for interruption.
    let (points, simplices) = shaken(19, 0.3);
    let removable = vec![true; points.len()];
    for (name, change) in CHANGES {
        let given = Task {
            removable: &removable,
            min_angle: 5.0,
            passes: 1,
            ..task(&points, &simplices)
        };
        let made = change(given, &Watch::idle()).unwrap();
        let used: BTreeSet<i32> = made.simplices.as_flattened().iter().copied().collect();
        let mut eighths = [0; 8];
        for (row, (p, q)) in (0..).zip(points.iter().zip(&made.points)) {
            if p != q || !used.contains(&row) {
                eighths[(0..3).map(|k| usize::from(p[k] > 9.5) << k).sum::<usize>()] += 1;
            }
        }
        assert!(
            eighths.iter().all(|&count| count > 20),
            "{name} {eighths:?}"
        );
    }
}

#[test]
fn an_interruption_ends_other_changes() {
    let (points, simplices) = shaken(14, 0.6);
    let removable = vec![true; points.len()];
    let stop = || true;
    for (name, change) in CHANGES {
        let given = Task {
            removable: &removable,
            ..task(&points, &simplices)
        };
        let outcome = change(given, &Watch::new(&stop));
        assert!(matches!(outcome, Err(Error::Interrupted)), "{name}");
    }
}

#[test]
fn an_interruption_ends_it() {
    let (points, simplices) = shaken(6, 0.6);
    let stop = || true;
    let outcome = improve(
        Task {
            min_angle: 60.0,
            ..task(&points, &simplices)
        },
        &Watch::new(&stop),
        &mut |_, _| Ok(()),
    );
    assert!(matches!(outcome, Err(Error::Interrupted)));
}
