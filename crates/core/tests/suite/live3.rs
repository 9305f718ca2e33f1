//! Live 3-D triangulations against a fresh build after each edit.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::tier::cases;
use delone_core::Point3;
use delone_core::base::watch::Watch;
use delone_core::delaunay::space::triangulate;
use delone_core::live::space::Space;
use proptest::prelude::*;

fn idle() -> Watch<'static> {
    Watch::idle()
}

/// The corners in ascending order, or with the last two exchanged, as an even permutation.
fn turned<T: Ord + Copy>(mut t: [T; 4]) -> [T; 4] {
    let inversions = (0..4).flat_map(|i| (0..i).map(move |j| (j, i)));
    let odd = inversions.filter(|&(j, i)| t[j] > t[i]).count() % 2 == 1;
    t.sort_unstable();
    if odd {
        t.swap(2, 3);
    }
    t
}

/// Tetrahedra with their neighbors, as corners, in one order.
fn ordered(simplices: &[[i32; 4]], neighbors: &[[i32; 4]]) -> Vec<([i32; 4], Vec<[i32; 4]>)> {
    let of = |t: i32| usize::try_from(t).map_or([-1; 4], |t| turned(simplices[t]));
    let mut all: Vec<_> = simplices
        .iter()
        .zip(neighbors)
        .map(|(&s, n)| {
            // Neighbors by the vertex opposite.
            let mut across: Vec<_> = (0..4).map(|k| (s[k], of(n[k]))).collect();
            across.sort_unstable();
            (turned(s), across.into_iter().map(|(_, t)| t).collect())
        })
        .collect();
    all.sort_unstable();
    all
}

/// A live triangulation and its points by row.
struct Twin {
    live: Space,
    points: Vec<Option<Point3>>,
    seen: BTreeSet<[i64; 4]>,
}

impl Twin {
    fn new(points: &[Point3]) -> Self {
        Self {
            live: Space::new(points, 1, &idle()).unwrap(),
            points: points.iter().copied().map(Some).collect(),
            seen: BTreeSet::new(),
        }
    }

    fn rows(&self) -> Vec<i64> {
        let there = self.points.iter().enumerate().filter(|(_, p)| p.is_some());
        there.map(|(i, _)| i as i64).collect()
    }

    fn insert(&mut self, points: &[Point3]) {
        let rows = self.live.insert(points, 1, &idle()).unwrap();
        assert_eq!(rows.start, self.points.len());
        self.points.extend(points.iter().copied().map(Some));
        assert_eq!(rows.end, self.points.len());
    }

    fn remove(&mut self, rows: &[i64]) {
        self.live.remove(rows, 1, &idle()).unwrap();
        for &row in rows {
            self.points[row as usize] = None;
        }
    }

    fn relocate(&mut self, rows: &[i64], points: &[Point3]) {
        self.live.relocate(rows, points, 1, &idle()).unwrap();
        for (&row, &p) in rows.iter().zip(points) {
            self.points[row as usize] = Some(p);
        }
    }

    /// The live triangulation equals a fresh one, and reports its changes.
    fn agree(&mut self) {
        self.live.check().unwrap();
        let made = self.live.export(&idle()).unwrap();
        let rows = self.rows();
        assert_eq!(made.rows, rows);
        let points: Vec<Point3> = self.points.iter().copied().flatten().collect();
        assert_eq!(made.points, points);
        match triangulate(&points, 1, &idle()) {
            Ok(fresh) => {
                assert_eq!(
                    ordered(&made.arrays.simplices, &made.arrays.neighbors),
                    ordered(&fresh.arrays.simplices, &fresh.arrays.neighbors)
                );
                assert_eq!(made.duplicates, fresh.duplicates);
            }
            Err(_) => assert!(made.arrays.simplices.is_empty()),
        }
        let changes = self.live.changes(&idle()).unwrap();
        assert!(changes.gone.iter().all(|t| self.seen.remove(t)));
        assert!(changes.new.iter().all(|t| self.seen.insert(*t)));
        let now: BTreeSet<_> = made
            .arrays
            .simplices
            .iter()
            .map(|&t| turned(t.map(|v| rows[v as usize])))
            .collect();
        assert_eq!(self.seen, now);
    }
}

/// Integer points on the sphere of radius 3 around the origin, and the origin: 31 points.
fn on_sphere() -> Vec<Point3> {
    let cube = (-3..=3).flat_map(|x| (-3..=3).flat_map(move |y| (-3..=3).map(move |z| [x, y, z])));
    cube.filter(|p: &[i32; 3]| matches!(p.iter().map(|x| x * x).sum(), 0 | 9))
        .map(|p| p.map(f64::from))
        .collect()
}

/// Points of a lattice, of a sphere, in two layers, of mixed exponents, and scattered.
fn point(kind: u8) -> BoxedStrategy<Point3> {
    match kind {
        0 => [0..3i32, 0..3, 0..3].prop_map(|p| p.map(f64::from)).boxed(),
        1 => prop::sample::select(on_sphere()).boxed(),
        2 => (0..5i32, 0..5i32, 0..20i32)
            .prop_map(|(x, y, z)| [x, y, z.max(18) - 18].map(f64::from))
            .boxed(),
        3 => (-3..4i32, -3..4i32, -3..4i32, -200..200i32)
            .prop_map(|(x, y, z, e)| {
                let [x, y, z] = [x, y, z].map(f64::from);
                [x * 2f64.powi(e), y * 2f64.powi(-e / 3), z]
            })
            .boxed(),
        _ => [any::<i16>(), any::<i16>(), any::<i16>()]
            .prop_map(|p| p.map(f64::from))
            .boxed(),
    }
}

#[derive(Debug, Clone)]
enum Edit {
    Insert(Vec<Point3>),
    Remove(Vec<prop::sample::Index>),
    Relocate(Vec<(prop::sample::Index, Point3)>),
    Keep,
    Restore(prop::sample::Index),
}

fn edits() -> impl Strategy<Value = (Vec<Point3>, Vec<Edit>)> {
    (0..5u8).prop_flat_map(|kind| {
        let p = move || point(kind);
        let edit = prop_oneof![
            prop::collection::vec(p(), 1..4).prop_map(Edit::Insert),
            prop::collection::vec(any::<prop::sample::Index>(), 1..4).prop_map(Edit::Remove),
            prop::collection::vec((any::<prop::sample::Index>(), p()), 1..4)
                .prop_map(Edit::Relocate),
            Just(Edit::Keep),
            any::<prop::sample::Index>().prop_map(Edit::Restore),
        ];
        (
            prop::collection::vec(p(), 0..30),
            prop::collection::vec(edit, 1..30),
        )
    })
}

fn picked(rows: &[i64], at: impl Iterator<Item = usize>) -> Vec<i64> {
    let mut picked: Vec<i64> = at.map(|i| rows[i % rows.len()]).collect();
    picked.sort_unstable();
    picked.dedup();
    picked
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(333, 4000)))]
    #[test]
    fn every_edit_equals_a_fresh_build((points, edits) in edits()) {
        let mut twin = Twin::new(&points);
        twin.agree();
        let mut kept = Vec::new();
        for edit in edits {
            let rows = twin.rows();
            match edit {
                Edit::Insert(points) => twin.insert(&points),
                Edit::Remove(at) if !rows.is_empty() => {
                    let rows = picked(&rows, at.iter().map(|i| i.index(rows.len())));
                    twin.remove(&rows);
                }
                Edit::Relocate(moves) if !rows.is_empty() => {
                    let mut moves: Vec<_> =
                        moves.iter().map(|(i, p)| (rows[i.index(rows.len())], *p)).collect();
                    moves.sort_by_key(|m| m.0);
                    moves.dedup_by_key(|m| m.0);
                    let (rows, points): (Vec<_>, Vec<_>) = moves.into_iter().unzip();
                    twin.relocate(&rows, &points);
                }
                Edit::Keep => kept.push((twin.live.state(&idle()).unwrap(), twin.points.clone())),
                Edit::Restore(i) if !kept.is_empty() => {
                    let (state, points) = &kept[i.index(kept.len())];
                    twin.live.restore(state, &idle()).unwrap();
                    let total = twin.points.len();
                    twin.points = points.clone();
                    twin.points.resize(total, None);
                }
                _ => {}
            }
            twin.agree();
        }
    }
}

fn scattered(n: usize, seed: u64) -> Vec<Point3> {
    let mut x = seed;
    let mut next = || {
        x = x
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| [next(), next(), next()]).collect()
}

#[test]
fn batches_in_a_large_set_equal_a_fresh_build() {
    let mut twin = Twin::new(&scattered(8_000, 1));
    twin.insert(&scattered(1200, 2));
    twin.agree();
    let rows: Vec<i64> = (0..9_200).step_by(12).collect();
    twin.remove(&rows);
    twin.agree();
    let rows = picked(&twin.rows(), (0..700).map(|i| i * 7919));
    let points: Vec<Point3> = rows
        .iter()
        .zip(scattered(rows.len(), 3))
        .map(|(&row, d)| {
            let p = twin.points[row as usize].unwrap();
            [0, 1, 2].map(|k| p[k] + 0.02 * (d[k] - 0.5))
        })
        .collect();
    twin.relocate(&rows, &points);
    twin.agree();
    // Vertices whose smallest row changes, each among unchanged tetrahedra.
    for k in 0..6 {
        let [row, onto] = [7 * k + 1, 8000 - 9 * k - 1].map(|i| twin.rows()[i as usize]);
        let p = twin.points[onto as usize].unwrap();
        twin.relocate(&[row], &[p]);
        twin.agree();
        if k % 2 == 0 {
            twin.remove(&[row]);
        } else {
            twin.relocate(&[row], &[[0.5, 0.5, 0.001 * f64::from(k)]]);
        }
        twin.agree();
    }
    // Beyond the share that is edited point by point.
    twin.insert(&scattered(8_000, 5));
    twin.agree();
    let rows = picked(&twin.rows(), (0..4000).map(|i| i * 7919));
    let points = scattered(rows.len(), 6);
    twin.relocate(&rows, &points);
    twin.agree();
    let rows = picked(&twin.rows(), (0..12_000).map(|i| i * 7919));
    twin.remove(&rows);
    twin.agree();
}

#[test]
fn hubs_lines_and_layers_equal_a_fresh_build() {
    // A center with hundreds of neighbors.
    let unit = |p: Point3| {
        let q = p.map(|x| x - 0.5);
        let r = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        q.map(|x| x / r)
    };
    let mut points: Vec<Point3> = scattered(400, 3).into_iter().map(unit).collect();
    points.push([0.0; 3]);
    let mut twin = Twin::new(&points);
    twin.remove(&[400]);
    twin.agree();
    twin.insert(&[[0.01, 0.0, 0.0]]);
    twin.agree();
    twin.relocate(&[401], &[[3.0, 0.0, 0.0]]);
    twin.agree();
    twin.remove(&[401]);
    twin.agree();
    // The first three points of a plane are on one line.
    let mut twin = Twin::new(&[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [3.0, 0.0, 0.0],
    ]);
    twin.insert(&[[1.0, 1.0, 1.0]]);
    twin.agree();
    // A line, a layer, a point above it, and back.
    let line: Vec<Point3> = (0..40).map(|i| [f64::from(i), 3.0, 0.0]).collect();
    let mut twin = Twin::new(&line);
    twin.agree();
    twin.insert(&[[7.5, 3.0, 0.0]]);
    twin.insert(&[[7.0, 3.0, 0.0]]);
    twin.agree();
    for k in 0..9 {
        twin.insert(&[[f64::from(k % 3), f64::from(k), 0.0]]);
        twin.agree();
    }
    let above = twin.points.len() as i64;
    twin.insert(&[[10.5, 2.0, 9.0]]);
    twin.agree();
    twin.relocate(&[above], &[[10.5, 2.0, -9.0]]);
    twin.agree();
    twin.relocate(&[above], &[[10.5, 4.0, 0.0]]);
    twin.agree();
    twin.insert(&[[1.0, 4.0, 2.0]]);
    twin.agree();
    twin.remove(&[above + 1]);
    twin.agree();
    let rows = twin.rows();
    twin.remove(&rows);
    twin.agree();
    twin.insert(&[
        [1.0, 2.0, 0.0],
        [3.0, 4.0, 0.0],
        [1.0, 9.0, 5.0],
        [1.0, 9.0, 5.0],
    ]);
    twin.agree();
    twin.insert(&[[0.0, 2.0, 1.0]]);
    twin.agree();
}

#[test]
fn layers_and_lattices_are_removed_point_by_point() {
    // Vertices whose neighbors are all in one plane, while other points are not.
    let mut points: Vec<Point3> = (0..75)
        .map(|i| [i % 5, i / 5 % 5, i / 25].map(f64::from))
        .collect();
    points.push([2.0, 2.0, 3.0]);
    points.push([2.0, 2.0, 9.0]);
    points.extend(on_sphere().iter().map(|p| p.map(|x| x + 2.0)));
    let mut twin = Twin::new(&points);
    twin.agree();
    for k in 0..points.len() as i64 {
        twin.remove(&[k * 29 % points.len() as i64]);
        twin.agree();
    }
}

#[test]
fn an_interrupted_batch_changes_nothing() {
    let mut twin = Twin::new(&scattered(5_000, 1));
    twin.agree();
    let rows: Vec<i64> = (0..5_000).step_by(13).collect();
    let moved: Vec<Point3> = scattered(rows.len(), 8);
    let more = scattered(1000, 4);
    let asked = AtomicUsize::new(0);
    let mut interrupted = 0;
    for after in 0..40 {
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= after;
        let watch = Watch::new(&stop);
        for kind in 0..3 {
            asked.store(0, Ordering::Relaxed);
            let state = twin.live.state(&idle()).unwrap();
            let result = match kind {
                0 => twin.live.insert(&more, 1, &watch).map(|_| ()),
                1 => twin.live.remove(&rows, 1, &watch),
                _ => twin.live.relocate(&rows, &moved, 1, &watch),
            };
            if result.is_ok() {
                twin.live.restore(&state, &idle()).unwrap();
                let more = twin.live.total() - twin.points.len();
                twin.points.extend(vec![None; more]);
            } else {
                interrupted += 1;
            }
            if after % 5 == 0 {
                twin.agree();
            }
        }
    }
    assert!(interrupted > 9, "{interrupted}");
}

#[test]
fn bad_rows_change_nothing() {
    let mut twin = Twin::new(&scattered(100, 1));
    twin.remove(&[5]);
    for rows in [[3, 5], [3, 100], [3, -1], [3, 3]] {
        assert!(twin.live.remove(&rows, 1, &idle()).is_err());
        assert!(
            twin.live
                .relocate(&rows, &[[0.0; 3]; 2], 1, &idle())
                .is_err()
        );
        twin.agree();
    }
    assert!(
        twin.live
            .insert(&[[0.5; 3], [f64::NAN, 0.0, 0.0]], 1, &idle())
            .is_err()
    );
    twin.agree();
}

#[test]
fn queries_find_the_tetrahedron_and_the_nearest_row() {
    let mut twin = Twin::new(&scattered(500, 1));
    twin.remove(&[1, 2, 3]);
    twin.insert(&scattered(40, 9));
    let rows = twin.rows();
    let queries: Vec<Point3> = scattered(300, 7)
        .into_iter()
        .map(|[x, y, z]| [1.2 * x - 0.1, y, z])
        .collect();
    let nearest = twin.live.nearest(&queries, &idle()).unwrap();
    let corners = twin.live.corners(&queries, &idle()).unwrap();
    let at = |row: i64| twin.points[row as usize].unwrap();
    let mut inside = 0;
    for (k, q) in queries.iter().enumerate() {
        let distance = |p: Point3| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>();
        let best = rows
            .iter()
            .min_by(|a, b| distance(at(**a)).total_cmp(&distance(at(**b))));
        assert_eq!(nearest[k], *best.unwrap());
        if corners.rows[k][0] < 0 {
            assert!(corners.weights[k].iter().all(|w| w.is_nan()));
            continue;
        }
        inside += 1;
        for (axis, &x) in q.iter().enumerate() {
            let sum: f64 = (0..4)
                .map(|i| corners.weights[k][i] * at(corners.rows[k][i])[axis])
                .sum();
            assert!((sum - x).abs() < 1e-12);
        }
    }
    assert!((120..300).contains(&inside));
}
