//! Small surfaces, level by level.

use super::*;
use crate::base::arrays::Given;
use crate::base::watch::IDLE;

const SIDE: usize = 17;

/// A grid of heights, without its corners, on the two triangles of the corners.
fn run(height: impl Fn(f64, f64) -> f64, step: f64, max_error: f64, most: usize) -> Simplified {
    let last = (SIDE - 1) as f64;
    let corners = [[0.0, 0.0], [last, 0.0], [last, last], [0.0, last]];
    let mut points = Vec::new();
    for i in 0..SIDE {
        for j in 0..SIDE {
            let p = [i as f64, j as f64];
            if !corners.contains(&p) {
                points.push(p.map(|x| x * step));
            }
        }
    }
    let z: Vec<_> = points
        .iter()
        .map(|p| height(p[0] / step, p[1] / step))
        .collect();
    let heights = corners.map(|p| height(p[0], p[1]));
    let corners = corners.map(|p| p.map(|x| x * step));
    let task = Task {
        coarse: Given {
            points: &corners,
            simplices: &[[0, 1, 2], [0, 2, 3]],
            neighbors: &[[-1, 1, -1], [-1, -1, 0]],
        },
        heights: &heights,
        segments: &[],
        triangles: 2,
        points: &points,
        z: &z,
        max_error,
        max_triangles: most,
        workers: 1,
    };
    simplify(task, &IDLE).unwrap()
}

/// The same by lists and by scans of a lattice.
fn by_both(task: Task) -> [Simplified; 2] {
    let lattice = Lattice::of(&task, &IDLE).unwrap().unwrap();
    let exact = lattice.is_exact();
    let mut marked = coarse(&task, &IDLE).unwrap();
    let lists = Lists::of(&task, &mut marked, &IDLE).unwrap();
    let mut first = Work::start(task, marked, lists, exact, &IDLE).unwrap();
    first.run(&IDLE).unwrap();
    let marked = coarse(&task, &IDLE).unwrap();
    let mut second = Work::start(task, marked, lattice, exact, &IDLE).unwrap();
    second.run(&IDLE).unwrap();
    [first.found, second.found]
}

#[test]
fn lists_and_lattices_agree() {
    let mut state = 1_u32;
    let mut random = |n: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % n
    };
    for round in 0..60 {
        // Few heights, so that many errors are equal; uneven columns; missing nodes.
        let (side, high) = (5 + random(12), 2 + random(9));
        let uneven = |k: u32| f64::from(if round % 2 == 0 { k } else { k * k + k / 3 });
        let last = uneven(side - 1);
        let corners = [[0.0, 0.0], [last, 0.0], [last, last], [0.0, last]];
        let heights = [1.0, 0.0, 2.0, 1.0];
        let (mut points, mut z) = (Vec::new(), Vec::new());
        for i in 0..side {
            for j in 0..side {
                let p = [uneven(i), uneven(j)];
                if !corners.contains(&p) && random(8) > round % 3 {
                    points.push(p);
                    z.push(f64::from(random(high)));
                }
            }
        }
        let task = Task {
            coarse: Given {
                points: &corners,
                simplices: &[[0, 1, 2], [0, 2, 3]],
                neighbors: &[[-1, 1, -1], [-1, -1, 0]],
            },
            heights: &heights,
            segments: &[[0, 2]],
            triangles: 2,
            points: &points,
            z: &z,
            max_error: f64::from(random(2)) / 2.0,
            max_triangles: usize::MAX,
            workers: 1,
        };
        // No point may be on an edge that stays.
        let task = Task {
            segments: if points.iter().any(|p| p[0] == p[1]) {
                &[]
            } else {
                task.segments
            },
            ..task
        };
        let [lists, lattice] = by_both(task);
        assert_eq!(lists.order, lattice.order, "{round}");
        assert_eq!(lists.errors, lattice.errors);
        assert_eq!(lists.triangles, lattice.triangles);
        assert!(lattice.order.len() > 4);
    }
}

#[test]
fn a_surface_of_corners_alone_stays() {
    let task = Task {
        coarse: Given {
            points: &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            simplices: &[[0, 1, 2]],
            neighbors: &[[-1; 3]],
        },
        heights: &[0.0, 1.0, 5.0],
        segments: &[],
        triangles: 1,
        points: &[],
        z: &[],
        max_error: 0.0,
        max_triangles: usize::MAX,
        workers: 1,
    };
    let found = simplify(task, &IDLE).unwrap();
    assert!(found.order.is_empty());
    assert_eq!(
        (&found.errors[..], &found.triangles[..]),
        (&[0.0][..], &[1][..])
    );
}

#[test]
fn nodes_with_rounded_coordinates_are_all_reached() {
    // Columns at decimals: every node counts, also those that rounding moves to the side of an edge.
    let found = run(|x, y| (x * y) % 7.0, 0.1, 0.0, usize::MAX);
    let mut order = found.order.clone();
    order.sort_unstable();
    order.dedup();
    assert_eq!(order.len(), found.order.len());
    assert_eq!(found.errors.last(), Some(&0.0));
}

#[test]
fn planes_need_no_points_where_nothing_rounds() {
    let found = run(|x, y| 3.0 * x - 0.5 * y, 1.0, 0.0, usize::MAX);
    assert!(found.order.is_empty());
    assert_eq!(found.errors, [0.0]);
    let level = run(|_, _| 0.1, 0.1, 0.0, usize::MAX);
    assert!(level.order.is_empty());
}

#[test]
fn the_worst_point_comes_first() {
    let found = run(|x, y| f64::from(x == 8.0 && y == 3.0), 1.0, 0.0, usize::MAX);
    assert_eq!(found.errors[0], 1.0);
    assert_eq!(found.order[0], (8 * SIDE + 3 - 2) as i32);
    assert_eq!(found.triangles[..2], [2, 4]);
    assert_eq!(found.errors.last(), Some(&0.0));
}

#[test]
fn errors_reach_the_bound_and_triangles_their_limit() {
    for step in [1.0, 0.1] {
        let bowl = |x: f64, y: f64| (x * x + y * y) / 16.0;
        let found = run(bowl, step, 0.25, usize::MAX);
        let (last, before) = found.errors.split_last().unwrap();
        assert!(
            *last <= 0.25 && before.iter().all(|e| *e > 0.25),
            "{last} {before:?}"
        );
        let few = run(bowl, step, 0.0, 20);
        assert!(few.triangles.iter().all(|&t| t <= 20));
        assert_eq!(
            few.order[..],
            run(bowl, step, 0.0, usize::MAX).order[..few.order.len()]
        );
    }
}

#[test]
fn many_columns_in_random_order_are_scattered_points() {
    // One row of more nodes than a lattice may have columns.
    let n = 1_u32 << 16;
    let points: Vec<_> = (0..n).map(|k| [f64::from(k * 40_503 % n), 1.0]).collect();
    let last = f64::from(n);
    let task = Task {
        coarse: Given {
            points: &[[-1.0, 0.0], [last, 0.0], [last, 2.0], [-1.0, 2.0]],
            simplices: &[[0, 1, 2], [0, 2, 3]],
            neighbors: &[[-1, 1, -1], [-1, -1, 0]],
        },
        heights: &[0.0; 4],
        segments: &[],
        triangles: 2,
        points: &points,
        z: &vec![0.0; points.len()],
        max_error: 0.0,
        max_triangles: usize::MAX,
        workers: 1,
    };
    assert!(Lattice::of(&task, &IDLE).unwrap().is_none());
    assert!(simplify(task, &IDLE).unwrap().order.is_empty());
}
