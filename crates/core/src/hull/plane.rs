//! The 2-D convex hull: two monotone chains over the points outside an octagon of extreme points.
//!
//! A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions" (1979), after S.
//! G. Akl and G. T. Toussaint, "A fast convex hull algorithm" (1978).

use delone_predicates::{Point2, Sign, lexicographic, orient2d};

use crate::base::error::Result;
use crate::base::watch::{Pace, Watch};
use crate::order::{sort, sort_by};

/// Points between two checks for interruption.
const LOT: usize = 1 << 16;

/// Rows of a hull, and rows that repeat one of these, each with it.
pub type Chain = (Vec<u32>, Vec<[u32; 2]>);

/// The extreme points, counterclockwise from the lexicographically smallest on, each by its first
/// row; fewer than three if there is no area. And `[row, vertex]` for rows that repeat one.
pub fn hull2(points: &[Point2], watch: &Watch) -> Result<Chain> {
    let mut rows = outside_of_octagon(points, watch)?;
    let at = |v: u32| points[v as usize];
    sort_by(&mut rows, watch, |&u, &v| {
        lexicographic(at(u), at(v)).then(u.cmp(&v))
    })?;
    let mut first: Vec<u32> = Vec::new();
    let mut repeats = Vec::new();
    for &row in &rows {
        match first.last() {
            Some(&last) if at(last) == at(row) => repeats.push([row, last]),
            _ => first.push(row),
        }
    }
    let mut hull = chain(points, first.iter().copied(), watch)?;
    hull.pop();
    let mut above = chain(points, first.iter().rev().copied(), watch)?;
    above.pop();
    hull.append(&mut above);
    if hull.is_empty() {
        hull = first;
    }
    let mut vertices = hull.clone();
    sort(&mut vertices, watch)?;
    repeats.retain(|[_, vertex]| vertices.binary_search(vertex).is_ok());
    sort(&mut repeats, watch)?;
    Ok((hull, repeats))
}

/// The chain of left turns over sorted points.
fn chain(points: &[Point2], rows: impl Iterator<Item = u32>, watch: &Watch) -> Result<Vec<u32>> {
    let mut pace = Pace::new(watch, LOT);
    let at = |v: u32| points[v as usize];
    let mut kept: Vec<u32> = Vec::new();
    for row in rows {
        pace.spend(1)?;
        while let [.., a, b] = kept[..]
            && orient2d(at(a), at(b), at(row)) != Sign::Positive
        {
            kept.pop();
        }
        kept.push(row);
    }
    Ok(kept)
}

/// Rows of points not known to be inside the polygon of the extreme points in eight directions.
fn outside_of_octagon(points: &[Point2], watch: &Watch) -> Result<Vec<u32>> {
    let mut pace = Pace::new(watch, LOT);
    let rows = || (0u32..).zip(points);
    let directions = [
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 0.0],
        [-1.0, -1.0],
        [0.0, -1.0],
        [1.0, -1.0],
    ];
    let mut corners = [0usize; 8];
    let mut most = [f64::NEG_INFINITY; 8];
    for (row, p) in rows() {
        pace.spend(1)?;
        for k in 0..8 {
            // Any point is a valid corner: rounding and overflow only choose a worse one.
            let along = directions[k][0] * p[0] + directions[k][1] * p[1];
            if along > most[k] {
                (most[k], corners[k]) = (along, row as usize);
            }
        }
    }
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let polygon: Vec<Point2> = corners.iter().map(|&c| points[c]).collect();
    let inside = |p: Point2| {
        let sides = (0..8).map(|k| (polygon[k], polygon[(k + 1) % 8]));
        // Equal corners have no side between them; a polygon of one point has no interior.
        let mut proper = sides.filter(|(a, b)| a != b).peekable();
        proper.peek().is_some() && proper.all(|(a, b)| orient2d(a, b, p) == Sign::Positive)
    };
    // Most points lie in a box inside the polygon: four comparisons suffice.
    let [_, ne, _, nw, _, sw, _, se] = polygon[..] else {
        unreachable!("eight directions have eight corners")
    };
    let (low, high) = (
        [nw[0].max(sw[0]), sw[1].max(se[1])],
        [ne[0].min(se[0]), nw[1].min(ne[1])],
    );
    let is_box = [low, high, [low[0], high[1]], [high[0], low[1]]]
        .into_iter()
        .all(inside);
    let in_box = |p: Point2| {
        is_box && low[0] <= p[0] && p[0] <= high[0] && low[1] <= p[1] && p[1] <= high[1]
    };
    let mut found = Vec::new();
    for (row, &p) in rows() {
        pace.spend(1)?;
        if !in_box(p) && !inside(p) {
            found.push(row);
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_extreme_points_are_vertices() {
        let points: Vec<Point2> = (0..5)
            .flat_map(|x| (0..5).map(move |y| [f64::from(x), f64::from(y)]))
            .chain([[0.0, 0.0], [4.0, 4.0], [2.0, 2.0]])
            .collect();
        let (hull, repeats) = hull2(&points, &Watch::idle()).unwrap();
        assert_eq!(hull, [0, 20, 24, 4]);
        assert_eq!(repeats, [[25, 0], [26, 24]]);
        assert_eq!(
            hull2(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]], &Watch::idle())
                .unwrap()
                .0,
            [0, 2]
        );
        assert_eq!(hull2(&[[1.0, 1.0]; 3], &Watch::idle()).unwrap().0, [0]);
        assert!(hull2(&[], &Watch::idle()).unwrap().0.is_empty());
    }

    #[test]
    fn no_extreme_point_is_lost_in_a_box() {
        let mut state = 5u64;
        let mut random = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) % 40
        };
        for (sheared, n) in [(false, 30), (true, 30), (false, 900), (true, 900)] {
            let points: Vec<Point2> = (0..n)
                .map(|_| (random() as f64, random() as f64))
                .map(|(x, y)| {
                    if sheared {
                        [x + 3.0 * y, y - x]
                    } else {
                        [x, y]
                    }
                })
                .collect();
            let (hull, _) = hull2(&points, &Watch::idle()).unwrap();
            // By definition: no point lies right of a side.
            for (i, &u) in hull.iter().enumerate() {
                let (a, b) = (
                    points[u as usize],
                    points[hull[(i + 1) % hull.len()] as usize],
                );
                assert!(points.iter().all(|&p| orient2d(a, b, p) != Sign::Negative));
            }
        }
    }
}
