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
    let mut homes = Vec::new();
    for i in 0..SIDE {
        for j in 0..SIDE {
            let p = [i as f64, j as f64];
            if !corners.contains(&p) {
                points.push(p.map(|x| x * step));
                homes.push(i32::from(p[1] > p[0]));
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
        homes: &homes,
        max_error,
        max_triangles: most,
        workers: 1,
    };
    simplify(task, &IDLE).unwrap()
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
