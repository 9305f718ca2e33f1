//! Which triangle holds a point, for batches of queries against the exported arrays.
//!
//! Queries are ordered along the Hilbert curve, so each walk starts where the last one ended; the
//! first start is the best of a sample (E. P. Mücke, I. Saias and B. Zhu, "Fast randomized point
//! location without preprocessing", 1996). Visibility walks end on Delaunay triangulations (see
//! `walk`); on other arrays a budget of steps ends them.
//!
//! A query on an edge or a vertex is in several triangles. The first of them is the answer, so that
//! it depends neither on where a walk came from nor, thereby, on the other queries and the threads.

use delone_predicates::{Point2, Sign, orient2d};

use super::validate::Given;
use crate::error::{Error, Result};
use crate::memory::{filled, with_room};
use crate::order::curve;
use crate::parallel;
use crate::watch::Watch;

/// Queries between two looks at the watch.
const WATCH_EVERY: usize = 1 << 12;

/// For each query the triangle that holds it, boundary included, or -1: outside, or not finite.
pub fn find(given: Given, queries: &[Point2], workers: usize, watch: &Watch) -> Result<Vec<i32>> {
    let mut found = filled(queries.len(), -1)?;
    if given.simplices.is_empty() {
        return Ok(found);
    }
    let order = curve::order_of(queries)?;
    let share = order.len().div_ceil(workers.max(1)).max(WATCH_EVERY);
    let tasks = order.chunks(share).collect();
    let parts = parallel::map(workers, tasks, |part| {
        find_part(given, queries, part, watch)
    });
    for (part, rows) in parts.into_iter().zip(order.chunks(share)) {
        for (triangle, &row) in part?.into_iter().zip(rows) {
            found[row as usize] = triangle;
        }
    }
    Ok(found)
}

fn find_part(given: Given, queries: &[Point2], part: &[u32], watch: &Watch) -> Result<Vec<i32>> {
    let mut found = with_room(part.len())?;
    let Some(&head) = part.first() else {
        return Ok(found);
    };
    let mut near = sample(given, queries[head as usize]);
    let mut star = Star {
        vertex: -1,
        first: 0,
    };
    for (i, &row) in part.iter().enumerate() {
        if i % WATCH_EVERY == 0 {
            watch.check()?;
        }
        let triangle = walk(given, near, queries[row as usize], &mut star)?;
        found.push(triangle.map_or(-1, |t| t as i32));
        near = triangle.unwrap_or(near);
    }
    Ok(found)
}

/// Of about the cube root of all triangles, evenly spread, the one whose first corner is nearest.
fn sample(given: Given, q: Point2) -> usize {
    let n = given.simplices.len();
    let step = n.div_ceil((n as f64).cbrt().ceil() as usize);
    let distance = |t: &usize| {
        let p = given.points[given.simplices[*t][0] as usize];
        (p[0] - q[0]).hypot(p[1] - q[1])
    };
    (0..n)
        .step_by(step)
        .min_by(|s, t| distance(s).total_cmp(&distance(t)))
        .unwrap_or(0)
}

fn walk(given: Given, from: usize, q: Point2, star: &mut Star) -> Result<Option<usize>> {
    let mut t = from;
    let mut came_from = -1;
    for _ in 0..=given.simplices.len() {
        let [a, b, c] = given.simplices[t];
        let step = [(b, c), (c, a), (a, b)]
            .into_iter()
            .zip(given.neighbors[t])
            .find(|&((u, v), beyond)| {
                (beyond != came_from || beyond < 0)
                    && orient2d(given.points[u as usize], given.points[v as usize], q)
                        == Sign::Negative
            });
        match step {
            None => return first_holder(given, t, q, star).map(Some),
            Some((_, -1)) => return Ok(None),
            Some((_, beyond)) => {
                came_from = t as i32;
                t = beyond as usize;
            }
        }
    }
    Err(Error::Internal(format!("the walk to {q:?} does not end")))
}

/// The first triangle around the vertex that was asked for last: equal queries follow each other
/// along the curve, and a vertex may have very many triangles.
struct Star {
    vertex: i32,
    first: usize,
}

/// The first of the triangles that hold `q`, of which `t` is one.
fn first_holder(given: Given, t: usize, q: Point2, star: &mut Star) -> Result<usize> {
    let corners = given.simplices[t].map(|v| given.points[v as usize]);
    let on =
        [0, 1, 2].map(|k| orient2d(corners[(k + 1) % 3], corners[(k + 2) % 3], q) == Sign::Zero);
    let corner = match on {
        [false, false, false] => return Ok(t),
        [true, true, _] => 2,
        [true, _, true] => 1,
        [_, true, true] => 0,
        _ => {
            let across = (0..3)
                .find(|&k| on[k])
                .map_or(-1, |k| given.neighbors[t][k]);
            return Ok(if across < 0 {
                t
            } else {
                t.min(across as usize)
            });
        }
    };
    let vertex = given.simplices[t][corner];
    if star.vertex != vertex {
        *star = Star {
            vertex,
            first: first_around(given, t, vertex)?,
        };
    }
    Ok(star.first)
}

/// The first of the triangles around a vertex of `t`.
fn first_around(given: Given, t: usize, vertex: i32) -> Result<usize> {
    let lost = || Error::Internal(format!("the triangles around vertex {vertex} do not end"));
    let mut first = t;
    // Counter-clockwise until the turn is complete; where the boundary is met, clockwise from `t`.
    for side in [1, 2] {
        let mut now = t;
        for _ in 0..=given.simplices.len() {
            let corner = given.simplices[now]
                .iter()
                .position(|&v| v == vertex)
                .ok_or_else(lost)?;
            let beyond = given.neighbors[now][(corner + side) % 3];
            if beyond == t as i32 {
                return Ok(first);
            }
            if beyond < 0 {
                break;
            }
            now = beyond as usize;
            first = first.min(now);
        }
    }
    Ok(first)
}
