//! Live triangulations against a fresh build after each edit.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::tier::cases;
use delone_core::Point2;
use delone_core::base::watch::Watch;
use delone_core::delaunay::plane::{Method, triangulate};
use delone_core::live::plane::Plane;
use proptest::prelude::*;

fn idle() -> Watch<'static> {
    Watch::idle()
}

fn turned(mut t: [i32; 3]) -> [i32; 3] {
    while t[0] > t[1] || t[0] > t[2] {
        t.rotate_left(1);
    }
    t
}

/// Triangles with their neighbors, as corners, in one order.
fn ordered(simplices: &[[i32; 3]], neighbors: &[[i32; 3]]) -> Vec<([i32; 3], Vec<[i32; 3]>)> {
    let of = |t: i32| usize::try_from(t).map_or([-1; 3], |t| turned(simplices[t]));
    let mut all: Vec<_> = simplices
        .iter()
        .zip(neighbors)
        .map(|(&s, n)| {
            // Neighbors by the vertex opposite.
            let mut across: Vec<_> = (0..3).map(|k| (s[k], of(n[k]))).collect();
            across.sort_unstable();
            (turned(s), across.into_iter().map(|(_, t)| t).collect())
        })
        .collect();
    all.sort_unstable();
    all
}

/// A live triangulation and its points by row.
struct Twin {
    live: Plane,
    points: Vec<Option<Point2>>,
    seen: BTreeSet<[i64; 3]>,
}

impl Twin {
    fn new(points: &[Point2]) -> Self {
        Self {
            live: Plane::new(points, 1, &idle()).unwrap(),
            points: points.iter().copied().map(Some).collect(),
            seen: BTreeSet::new(),
        }
    }

    fn rows(&self) -> Vec<i64> {
        let there = self.points.iter().enumerate().filter(|(_, p)| p.is_some());
        there.map(|(i, _)| i as i64).collect()
    }

    fn insert(&mut self, points: &[Point2]) {
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

    fn relocate(&mut self, rows: &[i64], points: &[Point2]) {
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
        let points: Vec<Point2> = self.points.iter().copied().flatten().collect();
        assert_eq!(made.points, points);
        match triangulate(&points, Method::Auto, 1, &idle()) {
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
            .map(|&t| {
                let mut t = t.map(|v| rows[v as usize]);
                while t[0] > t[1] || t[0] > t[2] {
                    t.rotate_left(1);
                }
                t
            })
            .collect();
        assert_eq!(self.seen, now);
    }
}

/// Coordinates on lattices and circles, and of mixed exponents.
fn point(kind: u8) -> BoxedStrategy<Point2> {
    match kind {
        0 => (0..4i32, 0..4i32)
            .prop_map(|(x, y)| [f64::from(x), f64::from(y)])
            .boxed(),
        1 => (0..12usize)
            .prop_map(|i| {
                let (x, y) = [(5, 0), (4, 3), (3, 4)][i % 3];
                [[x, y], [-y, x], [-x, -y], [y, -x]][i / 3].map(f64::from)
            })
            .boxed(),
        2 => (-3..4i32, -3..4i32, -200..200i32)
            .prop_map(|(x, y, e)| {
                [
                    f64::from(x) * 2f64.powi(e),
                    f64::from(y) * 2f64.powi(-e / 3),
                ]
            })
            .boxed(),
        _ => (any::<i16>(), any::<i16>())
            .prop_map(|(x, y)| [f64::from(x), f64::from(y)])
            .boxed(),
    }
}

#[derive(Debug, Clone)]
enum Edit {
    Insert(Vec<Point2>),
    Remove(Vec<prop::sample::Index>),
    Relocate(Vec<(prop::sample::Index, Point2)>),
    Keep,
    Restore(prop::sample::Index),
}

fn edits() -> impl Strategy<Value = (Vec<Point2>, Vec<Edit>)> {
    (0..4u8).prop_flat_map(|kind| {
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
    #![proptest_config(ProptestConfig::with_cases(cases(100, 1200)))]
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

fn scattered(n: usize, seed: u64) -> Vec<Point2> {
    let mut x = seed;
    let mut next = || {
        x = x
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| [next(), next()]).collect()
}

#[test]
fn a_removed_point_leaves_the_triangles_of_the_others() {
    let lattice = (0..25).map(|i| [f64::from(i % 5), f64::from(i / 5)]);
    for points in [scattered(25, 3), lattice.collect()] {
        for row in 0..25 {
            let mut twin = Twin::new(&points);
            twin.remove(&[row]);
            twin.agree();
        }
    }
}

#[test]
fn batches_in_a_large_set_equal_a_fresh_build() {
    let mut twin = Twin::new(&scattered(20_000, 1));
    twin.insert(&scattered(3000, 2));
    twin.agree();
    let rows: Vec<i64> = (0..23_000).step_by(9).collect();
    twin.remove(&rows);
    twin.agree();
    let rows = picked(&twin.rows(), (0..5000).map(|i| i * 7919));
    let points: Vec<Point2> = rows
        .iter()
        .zip(scattered(rows.len(), 3))
        .map(|(&row, d)| {
            let p = twin.points[row as usize].unwrap();
            [p[0] + 0.004 * (d[0] - 0.5), p[1] + 0.004 * (d[1] - 0.5)]
        })
        .collect();
    twin.relocate(&rows, &points);
    twin.agree();
    // Beyond the share that is edited point by point.
    twin.insert(&scattered(20_000, 5));
    twin.agree();
    let rows = picked(&twin.rows(), (0..30_000).map(|i| i * 7919));
    twin.remove(&rows);
    twin.agree();
}

#[test]
fn a_hub_and_lines_equal_a_fresh_build() {
    // A center with 2000 neighbors, on the hull and inside.
    let circle = |k: usize| {
        let angle = k as f64 / 1000.0 * std::f64::consts::PI;
        [angle.cos(), angle.sin()]
    };
    let mut points: Vec<Point2> = (0..2000).map(circle).collect();
    points.push([0.0, 0.0]);
    let mut twin = Twin::new(&points);
    twin.remove(&[2000]);
    twin.agree();
    // A line, and one point beside it that comes and goes.
    let line: Vec<Point2> = (0..400).map(|i| [f64::from(i), 3.0]).collect();
    let mut twin = Twin::new(&line);
    twin.agree();
    twin.insert(&[[7.5, 3.0]]);
    twin.insert(&[[7.0, 3.0]]);
    twin.agree();
    twin.insert(&[[100.5, 9.0]]);
    twin.agree();
    let last = twin.rows()[402];
    twin.relocate(&[last], &[[100.5, -9.0]]);
    twin.agree();
    twin.remove(&[last]);
    twin.agree();
    let rows = twin.rows();
    twin.remove(&rows);
    twin.agree();
    twin.insert(&[[1.0, 2.0], [3.0, 4.0], [1.0, 9.0], [1.0, 9.0]]);
    twin.agree();
}

#[test]
fn a_snapshot_of_edits_in_one_place_is_small_after_scattered_removals() {
    let mut seed = 1u64;
    let mut next = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let points: Vec<Point2> = (0..40_000).map(|_| [next(), next()]).collect();
    let mut live = Plane::new(&points, 1, &idle()).unwrap();
    let mut last = live.state(&idle()).unwrap();
    for row in 0..4_000 {
        live.remove(&[row * 7 % 40_000], 1, &idle()).unwrap();
    }
    let scattered = live.state(&idle()).unwrap();
    assert!(scattered.own_bytes(&last) > 2_000_000);
    last = scattered;
    for _ in 0..5 {
        let place = [0.3 + 0.4 * next(), 0.3 + 0.4 * next()];
        let new: Vec<Point2> = (0..1_000)
            .map(|_| place.map(|x| x + 0.02 * next()))
            .collect();
        live.insert(&new, 1, &idle()).unwrap();
        let state = live.state(&idle()).unwrap();
        assert!(
            state.own_bytes(&last) < 400_000,
            "{} bytes",
            state.own_bytes(&last)
        );
        last = state;
    }
    live.check().unwrap();
}

#[test]
fn an_interrupted_batch_changes_nothing() {
    let mut twin = Twin::new(&scattered(30_000, 1));
    twin.agree();
    let rows: Vec<i64> = (0..30_000).step_by(5).collect();
    let moved: Vec<Point2> = scattered(rows.len(), 8);
    let more = scattered(6000, 4);
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
fn an_interrupted_batch_takes_back_a_hub() {
    // A point moves to the middle of a circle of others, where its degree forbids removal.
    let mut points = vec![[5.0, 5.0]];
    for i in 0..2000 {
        let (y, x) = (f64::from(i) * 0.003_141_592).sin_cos();
        points.push([x, y]);
    }
    points.extend(scattered(20_000, 3).iter().map(|[x, y]| [x + 9.0, y + 9.0]));
    let mut twin = Twin::new(&points);
    let rows: Vec<i64> = (0..1).chain(2001..8001).collect();
    let mut moved = vec![[0.0, 0.0]];
    moved.extend(scattered(6000, 8).iter().map(|[x, y]| [x + 9.0, y + 9.0]));
    let asked = AtomicUsize::new(0);
    let mut interrupted = 0;
    for after in 0..20 {
        asked.store(0, Ordering::Relaxed);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= after;
        let state = twin.live.state(&idle()).unwrap();
        if twin
            .live
            .relocate(&rows, &moved, 1, &Watch::new(&stop))
            .is_ok()
        {
            twin.live.restore(&state, &idle()).unwrap();
        } else {
            interrupted += 1;
        }
        twin.agree();
    }
    assert!(interrupted > 1, "{interrupted}");
}

#[test]
fn bad_rows_change_nothing() {
    let mut twin = Twin::new(&scattered(100, 1));
    twin.remove(&[5]);
    for rows in [[3, 5], [3, 100], [3, -1], [3, 3]] {
        assert!(twin.live.remove(&rows, 1, &idle()).is_err());
        assert!(
            twin.live
                .relocate(&rows, &[[0.0; 2]; 2], 1, &idle())
                .is_err()
        );
        twin.agree();
    }
    assert!(
        twin.live
            .insert(&[[0.5, 0.5], [f64::NAN, 0.0]], 1, &idle())
            .is_err()
    );
    twin.agree();
}

#[test]
fn queries_find_the_triangle_and_the_nearest_row() {
    let mut twin = Twin::new(&scattered(500, 1));
    twin.remove(&[1, 2, 3]);
    twin.insert(&scattered(40, 9));
    let rows = twin.rows();
    let queries: Vec<Point2> = scattered(300, 7)
        .into_iter()
        .map(|[x, y]| [1.2 * x - 0.1, y])
        .collect();
    let nearest = twin.live.nearest(&queries, &idle()).unwrap();
    let corners = twin.live.corners(&queries, &idle()).unwrap();
    let at = |row: i64| twin.points[row as usize].unwrap();
    let mut inside = 0;
    for (k, q) in queries.iter().enumerate() {
        let distance = |p: Point2| (p[0] - q[0]).hypot(p[1] - q[1]);
        let best = rows
            .iter()
            .min_by(|a, b| distance(at(**a)).total_cmp(&distance(at(**b))));
        assert_eq!(nearest[k], *best.unwrap());
        if corners.rows[k][0] < 0 {
            assert!(corners.weights[k].iter().all(|w| w.is_nan()));
            continue;
        }
        inside += 1;
        for (axis, x) in q.iter().enumerate() {
            let sum: f64 = (0..3)
                .map(|i| corners.weights[k][i] * at(corners.rows[k][i])[axis])
                .sum();
            assert!((sum - x).abs() < 1e-12);
        }
    }
    assert!((200..300).contains(&inside));
}

#[test]
fn marks_and_links_agree_after_edits_of_segments() {
    let points = scattered(400, 5);
    let mut live = Plane::new(&points, 1, &idle()).unwrap();
    live.split_crossings(true);
    for i in 0..60i64 {
        live.insert_segments(&[[i, 7 * i % 90 + 100]], 1, &idle())
            .unwrap();
        live.check().unwrap();
    }
    assert!(!live.crossings().unwrap().is_empty());
    for i in 0..60i64 {
        let segments = [(17 * i) % 60];
        live.remove_segments(&segments, 1, &idle()).unwrap();
        live.relocate(&[i], &[points[399 - i as usize]], 1, &idle())
            .unwrap();
        live.remove(&[300 + i], 1, &idle()).unwrap();
        live.insert(&[points[200 + i as usize].map(|x| x * 0.5)], 1, &idle())
            .unwrap();
        live.check().unwrap();
    }
    assert!(!live.has_segments() && live.crossing_rows().is_empty());
    let exported = live.export(&idle()).unwrap();
    let fresh = triangulate(&exported.points, Method::Auto, 1, &idle()).unwrap();
    assert_eq!(
        exported.arrays.simplices.len(),
        fresh.arrays.simplices.len()
    );
}

#[test]
fn points_that_go_with_their_segments_go_at_once_or_stay() {
    let points = scattered(400, 5);
    let mut live = Plane::new(&points, 1, &idle()).unwrap();
    live.split_crossings(true);
    let ends: Vec<[i64; 2]> = (0..150).map(|i| [i, (7 * i + 31) % 150 + 150]).collect();
    live.insert_segments(&ends, 1, &idle()).unwrap();
    let rows: Vec<i64> = (0..300).step_by(3).collect();
    let is_gone = |s: &[i64; 2]| s.iter().any(|row| rows.contains(row));
    let expected: Vec<i64> = (0..150).filter(|&i| is_gone(&ends[i as usize])).collect();
    let all = |live: &Plane| {
        let crossings = live.crossings().unwrap();
        let triangles = triangles_of(live);
        (marked(live), live.segments().unwrap(), crossings, triangles)
    };
    let before = all(&live);
    let start = live.state(&idle()).unwrap();
    let asked = AtomicUsize::new(0);
    let mut interrupted = 0;
    for after in 0..60 {
        asked.store(0, Ordering::Relaxed);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= after;
        // A third of all, and so many that all is triangulated again.
        for rows in [&rows[..40], &rows] {
            let result = live.remove_with_segments(rows, 1, &Watch::new(&stop));
            if result.is_ok() {
                live.check().unwrap();
                live.restore(&start, &idle()).unwrap();
            } else {
                interrupted += 1;
            }
            live.check().unwrap();
            assert_eq!(all(&live), before);
        }
    }
    assert!(interrupted > 9, "{interrupted}");
    assert!(live.remove_with_segments(&[0, 0], 1, &idle()).is_err());
    let crossing = i64::from(live.crossing_rows()[0]);
    assert!(
        live.remove_with_segments(&[3, crossing], 1, &idle())
            .is_err()
    );
    assert_eq!(all(&live), before);
    let gone = live.remove_with_segments(&rows, 1, &idle()).unwrap();
    assert_eq!(gone, expected);
    live.check().unwrap();
}

/// The triangles of a triangulation, as ascending rows.
fn triangles_of(live: &Plane) -> BTreeSet<[i64; 3]> {
    let made = live.export(&idle()).unwrap();
    let corner = |v: i32| made.rows[v as usize];
    let sorted = |t: &[i32; 3]| {
        let mut t = t.map(corner);
        t.sort_unstable();
        t
    };
    made.arrays.simplices.iter().map(sorted).collect()
}

/// The marked edges of a triangulation, by coordinates.
fn marked(live: &Plane) -> BTreeSet<[[u64; 2]; 2]> {
    let made = live.export(&idle()).unwrap();
    let bits = |v: i32| made.points[v as usize].map(|x| (x + 0.0).to_bits());
    let mut all = BTreeSet::new();
    for (t, marks) in made.arrays.simplices.iter().zip(&made.constrained) {
        for k in (0..3).filter(|&k| marks[k]) {
            let mut ends = [bits(t[(k + 1) % 3]), bits(t[(k + 2) % 3])];
            ends.sort_unstable();
            all.insert(ends);
        }
    }
    all
}

#[test]
fn overlapping_and_crossing_segments_equal_a_fresh_build() {
    let points: Vec<Point2> = (0..36)
        .map(|i| [f64::from(i % 6), f64::from(i / 6)])
        .collect();
    let mut seed = 7u64;
    let mut next = |n: usize| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % n
    };
    for _ in 0..40 {
        let mut live = Plane::new(&points, 1, &idle()).unwrap();
        live.split_crossings(true);
        let mut there: Vec<(i64, [i64; 2])> = Vec::new();
        for _ in 0..25 {
            if next(3) > 0 || there.is_empty() {
                let ends = [next(18) as i64, next(18) as i64];
                let made = live.insert_segments(&[ends], 1, &idle()).unwrap();
                there.push((made.start as i64, ends));
            } else {
                let (gone, _) = there.swap_remove(next(there.len()));
                live.remove_segments(&[gone], 1, &idle()).unwrap();
            }
            live.check().unwrap();
            let mut fresh = Plane::new(&points, 1, &idle()).unwrap();
            fresh.split_crossings(true);
            there.sort_unstable();
            let ends: Vec<[i64; 2]> = there.iter().map(|s| s.1).collect();
            fresh.insert_segments(&ends, 1, &idle()).unwrap();
            assert_eq!(marked(&live), marked(&fresh), "{ends:?}");
            assert_eq!(live.vertices(), fresh.vertices());
        }
    }
}
