//! The Voronoi diagram of directions as the dual of all facets of their convex hull.
//!
//! Facets of one circle share a vertex: exact in-circle tests decide across which edges. A ridge is
//! dual to each other edge, so no ridge has length zero.

use delone_predicates::sphere::{Unit, incircle_of};
use delone_predicates::{Point3, Sign};

use super::directions::units;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::parallel;
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};

/// The number of facets that are compared together.
const SHARE: usize = 1 << 12;
/// Units of work between two checks for interruption.
const WATCH_EVERY: usize = 1 << 16;
/// No ridge.
const NONE: u32 = u32::MAX;

/// Vertices, ridges and cells.
#[derive(Debug, Default)]
pub struct Dual {
    /// The vertex of each facet.
    pub vertex: Vec<i32>,
    /// The first facet of each vertex.
    pub facet: Vec<i32>,
    /// The directions of the edge of each ridge, and those opposite in the facets to its left and
    /// right.
    pub around: Vec<[i32; 4]>,
    /// The vertices of each ridge: of the facets to the left and to the right of its edge.
    pub ends: Vec<[i32; 2]>,
    /// The cell of each row, -1 if it is not a vertex of facets; rows ascend with cells.
    pub cell: Vec<i32>,
    /// The entries of cell i are `starts[i]..starts[i + 1]`.
    pub starts: Vec<i32>,
    /// Entry: a vertex, counterclockwise.
    pub vertices: Vec<i32>,
    /// Entry: the ridge from that vertex to the next.
    pub ridges: Vec<i32>,
}

/// Facets and their neighbors, without a boundary.
struct Facets<'a> {
    simplices: &'a [[i32; 3]],
    neighbors: &'a [[i32; 3]],
}

/// The dual of facets of at least four directions. Unless `merged`, each facet has a vertex of its
/// own.
pub fn dual(
    vectors: &[Point3],
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    merged: bool,
    workers: usize,
    watch: &Watch,
) -> Result<Dual> {
    let facets = Facets {
        simplices,
        neighbors,
    };
    let tied = if merged {
        facets.tied(vectors, workers, watch)?
    } else {
        filled(simplices.len(), 0)?
    };
    let mut pace = Pace::new(watch, WATCH_EVERY);
    let (vertex, facet) = facets.vertices(&tied, &mut pace)?;
    let mut made = Dual {
        vertex,
        facet,
        ..Dual::default()
    };
    let numbers = facets.ridges(&tied, &mut made, workers, watch)?;
    facets.cells(vectors.len(), &numbers, &mut made, workers, watch)?;
    Ok(made)
}

impl Facets<'_> {
    /// The corner of `other` opposite the edge that it shares with `t`.
    fn back(&self, t: usize, other: usize) -> Result<usize> {
        self.neighbors[other]
            .iter()
            .position(|&x| x == t as i32)
            .ok_or_else(|| Error::Shape(format!("facets {t} and {other} are not neighbors")))
    }

    /// The edge opposite corner k of facet t, and the corners to its left and right.
    fn around(&self, t: usize, k: usize) -> Result<[i32; 4]> {
        let other = self.neighbors[t][k] as usize;
        let corners = self.simplices[t];
        let apex = self.simplices[other][self.back(t, other)?];
        Ok([corners[(k + 1) % 3], corners[(k + 2) % 3], corners[k], apex])
    }

    /// For each facet, a mask of its edges to facets of larger numbers that are on the same circle.
    fn tied(&self, vectors: &[Point3], workers: usize, watch: &Watch) -> Result<Vec<u8>> {
        let (heads, tails) = units(vectors, workers, watch)?;
        let mut masks = filled(self.simplices.len(), 0_u8)?;
        let tasks = masks.chunks_mut(SHARE).enumerate().collect();
        parallel::map_watched(workers, tasks, watch, |(i, masks): (usize, &mut [u8])| {
            for (t, mask) in (i * SHARE..).zip(masks) {
                for k in (0..3).filter(|&k| self.neighbors[t][k] as usize > t) {
                    let [a, b, c, d] = self.around(t, k)?.map(|v| v as usize);
                    let numbers = [a, b, c, d];
                    let units = numbers.map(|v| Unit {
                        hi: heads[v],
                        lo: tails[v],
                    });
                    let sign = incircle_of(numbers.map(|v| vectors[v]), units.each_ref());
                    *mask |= u8::from(sign == Sign::Zero) << k;
                }
            }
            Ok(())
        })?;
        Ok(masks)
    }

    /// The vertex of each facet, and the first facet of each vertex.
    fn vertices(&self, tied: &[u8], pace: &mut Pace) -> Result<(Vec<i32>, Vec<i32>)> {
        // The smallest facet represents those at a vertex.
        let mut sets = Sets::of(tied.len())?;
        for t in (0..tied.len()).filter(|&t| tied[t] != 0) {
            pace.spend(1)?;
            for k in (0..3).filter(|k| tied[t] >> k & 1 == 1) {
                sets.join(t as u32, self.neighbors[t][k] as u32);
            }
        }
        let mut vertex: Vec<i32> = with_room(tied.len())?;
        let mut facet = with_room(tied.len())?;
        for t in 0..tied.len() as u32 {
            pace.spend(1)?;
            let first = sets.root(t);
            if first == t {
                vertex.push(facet.len() as i32);
                facet.push(t as i32);
            } else {
                vertex.push(vertex[first as usize]);
            }
        }
        Ok((vertex, facet))
    }

    /// Whether a ridge is dual to the edge opposite corner k of facet t, and belongs to t: of the two
    /// facets it is the one with the smaller number.
    #[inline]
    fn owns(&self, tied: &[u8], t: usize, k: usize) -> bool {
        self.neighbors[t][k] as usize >= t && tied[t] >> k & 1 == 0
    }

    /// Adds the ridges; returns the ridge of each edge that a facet owns.
    fn ridges(
        &self,
        tied: &[u8],
        made: &mut Dual,
        workers: usize,
        watch: &Watch,
    ) -> Result<Vec<[u32; 3]>> {
        let count = tied.len();
        let shares = || (0..count).step_by(SHARE);
        let counts = parallel::map_watched(workers, shares().collect(), watch, |from| {
            let share = from..count.min(from + SHARE);
            let owned = |t: usize| (0..3).filter(|&k| self.owns(tied, t, k)).count();
            Ok(share.map(owned).sum::<usize>())
        })?;
        let total = counts.iter().sum();
        let mut numbers = filled(count, [NONE; 3])?;
        made.around = filled(total, [0; 4])?;
        made.ends = filled(total, [0; 2])?;
        // Each task fills its own part of the arrays.
        let (mut around, mut ends) = (&mut made.around[..], &mut made.ends[..]);
        let mut tasks = Vec::with_capacity(counts.len());
        let mut first = 0;
        for ((from, own), count) in shares().zip(numbers.chunks_mut(SHARE)).zip(counts) {
            let (own_around, rest_around) = around.split_at_mut(count);
            let (own_ends, rest_ends) = ends.split_at_mut(count);
            tasks.push((from, own, first, own_around.iter_mut().zip(own_ends)));
            (around, ends) = (rest_around, rest_ends);
            first += count as u32;
        }
        let vertex = &made.vertex[..];
        parallel::map_watched(
            workers,
            tasks,
            watch,
            |(from, own, mut number, mut places)| {
                for (t, numbers) in (from..).zip(own) {
                    for k in (0..3).filter(|&k| self.owns(tied, t, k)) {
                        let Some((around, ends)) = places.next() else {
                            break;
                        };
                        *around = self.around(t, k)?;
                        *ends = [vertex[t], vertex[self.neighbors[t][k] as usize]];
                        numbers[k] = number;
                        number += 1;
                    }
                }
                Ok(())
            },
        )?;
        Ok(numbers)
    }

    /// Adds the cells.
    fn cells(
        &self,
        rows: usize,
        numbers: &[[u32; 3]],
        made: &mut Dual,
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        // The first corner of each row, 4 t + k.
        let mut corner = filled(rows, NONE)?;
        for (t, corners) in self.simplices.iter().enumerate().rev() {
            for (k, &v) in corners.iter().enumerate() {
                corner[v as usize] = (4 * t + k) as u32;
            }
        }
        let vertex = &made.vertex[..];
        let parts =
            parallel::map_watched(workers, corner.chunks(SHARE).collect(), watch, |part| {
                let (mut ends, mut around) = (with_room(part.len())?, with_room(6 * part.len())?);
                for &code in part.iter().filter(|&&code| code != NONE) {
                    self.turn(code, numbers, |t, ridge| {
                        push(&mut around, (vertex[t], ridge as i32))
                    })?;
                    ends.push(around.len());
                }
                Ok((ends, around))
            })?;
        let total = parts.iter().map(|(_, around)| around.len()).sum();
        made.cell = filled(rows, -1)?;
        for (i, cell) in (0..).zip(made.cell.iter_mut().zip(&corner).filter(|x| *x.1 != NONE)) {
            *cell.0 = i;
        }
        made.starts = with_room(rows + 1)?;
        made.starts.push(0);
        made.vertices = with_room(total)?;
        made.ridges = with_room(total)?;
        for (ends, around) in parts {
            watch.check()?;
            let before = made.vertices.len();
            made.starts
                .extend(ends.iter().map(|&end| (before + end) as i32));
            made.vertices.extend(around.iter().map(|x| x.0));
            made.ridges.extend(around.iter().map(|x| x.1));
        }
        Ok(())
    }

    /// Turns once around the vertex of a corner, 4 t + k, counterclockwise: calls `found` with each
    /// facet and the ridge dual to the edge that the turn leaves it by, where there is one.
    #[inline]
    fn turn(
        &self,
        code: u32,
        numbers: &[[u32; 3]],
        mut found: impl FnMut(usize, u32) -> Result<()>,
    ) -> Result<()> {
        let first = (code as usize / 4, code as usize % 4);
        let (mut t, mut k) = first;
        // A turn visits each facet once.
        for _ in 0..self.simplices.len() {
            let edge = (k + 1) % 3;
            let next = self.neighbors[t][edge] as usize;
            let back = self.back(t, next)?;
            // One of both sides owns the ridge.
            let ridge = numbers[t][edge].min(numbers[next][back]);
            if ridge != NONE {
                found(t, ridge)?;
            }
            (t, k) = (next, (back + 1) % 3);
            if (t, k) == first {
                break;
            }
        }
        Ok(())
    }
}
