//! Which triangle holds a point, for batches of queries against the exported arrays.
//!
//! Queries are ordered along the Hilbert curve, so each walk starts where the last one ended; the
//! first start is the best of a sample (E. P. Mücke, I. Saias and B. Zhu, "Fast randomized point
//! location without preprocessing", 1996). Visibility walks end on Delaunay triangulations (see
//! `walk`); on other arrays a budget of steps ends them.

use delone_predicates::{Point2, Sign, orient2d};

use super::validate::Given;
use crate::error::{Error, Result};
use crate::memory::filled;
use crate::order::curve;
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
    let parts: Vec<Result<Vec<i32>>> = std::thread::scope(|scope| {
        let handles: Vec<_> = order
            .chunks(share)
            .map(|part| scope.spawn(move || find_part(given, queries, part, watch)))
            .collect();
        handles
            .into_iter()
            .map(|h| {
                h.join()
                    .unwrap_or_else(|_| Err(Error::Internal("a worker panicked".into())))
            })
            .collect()
    });
    for (part, rows) in parts.into_iter().zip(order.chunks(share)) {
        for (triangle, &row) in part?.into_iter().zip(rows) {
            found[row as usize] = triangle;
        }
    }
    Ok(found)
}

fn find_part(given: Given, queries: &[Point2], part: &[u32], watch: &Watch) -> Result<Vec<i32>> {
    let mut found = Vec::with_capacity(part.len());
    let Some(&head) = part.first() else {
        return Ok(found);
    };
    let mut near = sample(given, queries[head as usize]);
    for (i, &row) in part.iter().enumerate() {
        if i % WATCH_EVERY == 0 {
            watch.check()?;
        }
        let triangle = walk(given, near, queries[row as usize])?;
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

fn walk(given: Given, from: usize, q: Point2) -> Result<Option<usize>> {
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
            None => return Ok(Some(t)),
            Some((_, -1)) => return Ok(None),
            Some((_, beyond)) => {
                came_from = t as i32;
                t = beyond as usize;
            }
        }
    }
    Err(Error::Internal(format!("the walk to {q:?} does not end")))
}
