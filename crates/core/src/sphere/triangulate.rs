//! Triangulates rows of vectors: check, order, insert, export.

use delone_predicates::Point3;

use super::arrange::{Arranged, arrange};
use super::degenerate::degenerate;
use super::directions::check;
use super::fill::fill;
use super::join::in_halves;
use crate::base::arrays::Arrays;
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Mesh2, export};
use crate::order::sort;

/// Triangles in the rows of the input.
#[derive(Debug)]
pub struct Triangulation {
    /// Triangles, counterclockwise seen from outside, and their neighbors; -1 beyond the hull.
    pub arrays: Arrays<3>,
    /// `[row, first row of the same direction]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

/// A mesh of directions.
pub(super) struct Built {
    pub mesh: Mesh2,
    /// The infinite corner of a ghost; `None` if the sphere is covered.
    pub ghost: Option<Code>,
    /// The number of records in use.
    pub taken: usize,
    /// The directions; after `join` the row of each vertex is the first of its direction.
    pub arranged: Arranged,
    /// Directions that are the same as a vertex, with that vertex.
    pub repeats: Vec<[u32; 2]>,
}

/// The canonical Delaunay triangulation of the directions of `vectors`; the same arrays for any
/// number of workers.
pub fn triangulate(vectors: &[Point3], workers: usize, watch: &Watch) -> Result<Triangulation> {
    let mut built = build(vectors, workers, watch)?;
    let duplicates = join(&mut built.arranged, &built.repeats, watch)?;
    let Built {
        mesh,
        ghost,
        taken,
        arranged,
        ..
    } = built;
    let arrays = export::partial_arrays(mesh, ghost, taken, &arranged.rows, workers, watch)?;
    Ok(Triangulation { arrays, duplicates })
}

/// The mesh of the directions of `vectors`.
pub(super) fn build(vectors: &[Point3], workers: usize, watch: &Watch) -> Result<Built> {
    check(vectors)?;
    let arranged = arrange(vectors, workers, watch)?;
    let n = arranged.directions.count();
    let mut mesh = Mesh2::with_vertices(n as usize)?;
    // Its records are the same for any number of workers.
    let joined = match arranged.halves {
        Some(halves) => in_halves(&mut mesh, &arranged.directions, halves, workers, watch)?,
        None => None,
    };
    let filled = match joined {
        Some(filled) => filled,
        None => match fill(mesh.patch(), &arranged.directions, 0..n, watch)? {
            Some(filled) => filled,
            None => return Err(degenerate(&arranged, watch)?),
        },
    };
    Ok(Built {
        mesh,
        ghost: filled.ghost,
        taken: filled.taken.len(),
        arranged,
        repeats: filled.repeats,
    })
}

/// All rows that repeat an earlier direction, with the first row of that direction, which becomes
/// the row of the vertex.
pub(super) fn join(
    arranged: &mut Arranged,
    repeats: &[[u32; 2]],
    watch: &Watch,
) -> Result<Vec<[u32; 2]>> {
    let Arranged {
        rows,
        repeats: equal,
        ..
    } = arranged;
    // The vertex of each number.
    let mut vertices: Vec<u32> = with_room(rows.len())?;
    vertices.extend(0..rows.len() as u32);
    for &[number, vertex] in repeats {
        vertices[number as usize] = vertex;
    }
    let mut found: Vec<[u32; 2]> = with_room(equal.len() + repeats.len())?;
    found.extend(
        equal
            .iter()
            .map(|&[row, number]| [row, vertices[number as usize]]),
    );
    found.extend(
        repeats
            .iter()
            .map(|&[number, vertex]| [rows[number as usize], vertex]),
    );
    watch.check()?;
    for [row, vertex] in &mut found {
        let first = &mut rows[*vertex as usize];
        if *row < *first {
            std::mem::swap(row, first);
        }
    }
    for pair in &mut found {
        pair[1] = rows[pair[1] as usize];
    }
    sort(&mut found, watch)?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::base::error::Error;

    /// Scattered vectors of different lengths, with z of at least `low`.
    fn scattered(n: u32, low: f64) -> Vec<Point3> {
        let mut x = 1_u64;
        let mut next = || {
            x = x
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        (0..n)
            .map(|_| [next(), next(), next().max(low + 0.1 * next().abs())])
            .collect()
    }

    #[test]
    fn all_directions_are_vertices_and_edges_agree() {
        for (low, whole) in [(-1.0, true), (0.2, false)] {
            let vectors = scattered(5000, low);
            for workers in [1, 2] {
                let made = triangulate(&vectors, workers, &Watch::idle()).unwrap();
                let arrays = &made.arrays;
                let rim: usize = arrays
                    .neighbors
                    .iter()
                    .flatten()
                    .filter(|&&t| t < 0)
                    .count();
                assert_eq!(rim == 0, whole);
                let less = if whole { 4 } else { 2 + rim };
                assert_eq!(arrays.simplices.len(), 2 * 5000 - less);
                for (t, beside) in arrays.neighbors.iter().enumerate() {
                    for k in (0..3).filter(|&k| beside[k] >= 0) {
                        let other = arrays.neighbors[beside[k] as usize];
                        assert!(other.contains(&(t as i32)));
                    }
                }
            }
        }
    }

    #[test]
    fn interruption_is_heard_in_every_stage() {
        // So many that they are divided.
        let vectors = scattered(17_000, -1.0);
        let count = AtomicUsize::new(0);
        let counting = || {
            count.fetch_add(1, Ordering::Relaxed);
            false
        };
        triangulate(&vectors, 1, &Watch::new(&counting)).unwrap();
        let all = count.into_inner();
        assert!(all > 20, "{all}");
        for at in 0..all {
            let left = AtomicUsize::new(at);
            let stop = || {
                left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1))
                    .is_err()
            };
            let ended = triangulate(&vectors, 1, &Watch::new(&stop));
            assert_eq!(ended.err(), Some(Error::Interrupted), "{at} of {all}");
        }
    }

    #[test]
    fn a_first_triangle_is_found_behind_many_of_one_circle() {
        let mut vectors: Vec<Point3> = (0..3000)
            .map(|i| [f64::from(i) - 1500.5, 1.0, 0.0])
            .collect();
        let Err(Error::OneGreatCircle { chain }) = triangulate(&vectors, 1, &Watch::idle()) else {
            panic!("they are on one circle");
        };
        assert_eq!(chain.len(), 3000);
        vectors.push([0.0, 1.0, 1e-300]);
        let made = triangulate(&vectors, 1, &Watch::idle()).unwrap();
        assert_eq!(made.arrays.simplices.len(), 2999);
    }
}
