//! The values of triangles and their edges, in 2-D, in a plane of 3-D, and on the torus.

use super::ball::{self, Kind, Site};
use super::simplices::{SHARE, Sites, bits, each, value};
use crate::base::error::Result;
use crate::base::memory::{with_room, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;
use crate::measure::{Buckets, distinct};

/// The values of triangles and edges.
pub struct Flat {
    /// Those of the triangles.
    pub triangles: Vec<f64>,
    /// The edges: the smaller row first, ascending.
    pub edges: Vec<[i32; 2]>,
    /// Their values.
    pub of_edges: Vec<f64>,
}

/// The values of triangles, and of the edges opposite their corners.
pub struct Torus {
    /// Those of the triangles.
    pub triangles: Vec<f64>,
    /// Those of the edges.
    pub of_edges: Vec<[f64; 3]>,
    /// Whether a corner is in conflict with another one, (tail, head) of the edge opposite each.
    pub conflicts: Vec<[[i32; 2]; 3]>,
}

/// A triangle: its value, and a bit for each corner in conflict with the edge opposite.
#[inline]
fn measured<const D: usize>(kind: Kind, corners: [Site<D>; 3]) -> (f64, u32) {
    let is_met = |&k: &usize| {
        let [a, b] = [1, 2].map(|i| corners[(k + i) % 3]);
        ball::meets_edge(kind, [a, b], corners[k])
    };
    let met = (0..3).filter(is_met).fold(0, |all, k| all | 1 << k);
    (ball::triangle(kind, corners), met)
}

/// The values and bits of all triangles.
fn all_measured<const D: usize>(
    count: usize,
    workers: usize,
    watch: &Watch,
    corners: impl Fn(usize) -> (Kind, [Site<D>; 3]) + Sync,
) -> Result<(Vec<f64>, Vec<u32>)> {
    let (mut values, mut met) = (zeroed(count)?, zeroed::<u32>(count)?);
    let parts = values.chunks_mut(SHARE).zip(met.chunks_mut(SHARE));
    let tasks = parts.enumerate().collect();
    let work = |(share, (values, met)): (usize, (&mut [f64], &mut [u32]))| {
        for (i, (value, met)) in values.iter_mut().zip(met).enumerate() {
            let (kind, corners) = corners(share * SHARE + i);
            (*value, *met) = measured(kind, corners);
        }
        Ok(())
    };
    parallel::map_watched(workers, tasks, watch, work)?;
    Ok((values, met))
}

/// The values of triangles and their edges.
pub fn flat<const D: usize>(
    sites: Sites<'_, D>,
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Flat> {
    let kind = sites.kind();
    let corners = |t: usize| simplices[t].map(|v| sites.at(v));
    let measured = |t: usize| (kind, corners(t));
    let (triangles, met) = all_measured(simplices.len(), workers, watch, measured)?;
    let rows_of = |t: usize, to: &mut Buckets<[u32; 3]>| {
        for k in 0..3 {
            let beyond = neighbors[t][k];
            // An edge between two triangles belongs to the later one.
            if beyond >= t as i32 {
                continue;
            }
            let beyond = usize::try_from(beyond).ok();
            let back = beyond.and_then(|n| (0..3).find(|&j| neighbors[n][j] == t as i32));
            let least = beyond.map_or(f64::INFINITY, |n| triangles[n]);
            let other = beyond.zip(back).is_some_and(|(n, j)| met[n] >> j & 1 != 0);
            let own = if met[t] >> k & 1 != 0 || other {
                triangles[t].min(least)
            } else {
                ball::edge(kind, [1, 2].map(|i| sites.at(simplices[t][(k + i) % 3])))
            };
            let [a, b] = [1, 2].map(|i| simplices[t][(k + i) % 3]);
            let [high, low] = bits(own);
            to.put(a.min(b), [a.max(b) as u32, high, low])?;
        }
        Ok(())
    };
    let row = |u: i32, [v, high, low]: [u32; 3]| [u as u32, v, high, low];
    let n = sites.points.len();
    let rows = distinct::<true, _, _>(simplices.len(), n, workers, watch, rows_of, row)?;
    let (mut edges, mut of_edges) = (with_room(rows.len())?, with_room(rows.len())?);
    edges.extend(rows.iter().map(|row| [row[0] as i32, row[1] as i32]));
    of_edges.extend(rows.iter().map(|row| value([row[2], row[3]])));
    Ok(Flat {
        triangles,
        edges,
        of_edges,
    })
}

/// The values of edges that are faces of nothing.
pub fn edges<const D: usize>(
    sites: Sites<'_, D>,
    edges: &[[i32; 2]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<f64>> {
    each(edges.len(), workers, watch, |e| {
        ball::edge(sites.kind(), edges[e].map(|v| sites.at(v)))
    })
}

/// The values of triangles whose corners are translates of points, by `offsets` times `periods`;
/// `partners` has the edge 3 t + k on the other side of each, or -1.
pub fn torus(
    sites: Sites<'_, 2>,
    periods: [f64; 2],
    simplices: &[[i32; 3]],
    offsets: &[[[i32; 2]; 3]],
    partners: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Torus> {
    let kind = Kind {
        moved: true,
        ..sites.kind()
    };
    let corner = |t: usize, k: usize| Site {
        // Offsets are from -2 to 2, so the products are exact.
        shift: [0, 1].map(|x| f64::from(offsets[t][k][x]) * periods[x]),
        ..sites.at(simplices[t][k])
    };
    let measured = |t: usize| (kind, [0, 1, 2].map(|k| corner(t, k)));
    let (triangles, met) = all_measured(simplices.len(), workers, watch, measured)?;
    let of_edges = each(simplices.len(), workers, watch, |t| {
        [0, 1, 2].map(|k| {
            let beyond = usize::try_from(partners[t][k]).ok();
            let (other, least) = beyond.map_or((false, f64::INFINITY), |code| {
                let (n, j) = (code / 3, code % 3);
                (met[n] >> j & 1 != 0, triangles[n])
            });
            if met[t] >> k & 1 != 0 || other {
                triangles[t].min(least)
            } else {
                ball::edge(kind, [1, 2].map(|i| corner(t, (k + i) % 3)))
            }
        })
    })?;
    let conflicts = each(simplices.len(), workers, watch, |t| {
        [0, 1, 2].map(|k| {
            let [a, b] = [1, 2].map(|i| corner(t, (k + i) % 3));
            let hidden = |a, b| i32::from(kind.weighted && ball::hides(kind, a, b));
            [hidden(a, b), hidden(b, a)]
        })
    })?;
    Ok(Torus {
        triangles,
        of_edges,
        conflicts,
    })
}
