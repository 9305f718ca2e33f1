//! The values of tetrahedra, their faces and their edges.
//!
//! A face is measured for the later of its tetrahedra, an edge for the earliest one around it, which
//! is found by going around.

use super::ball;
use super::simplices::{Sites, bits, each, value};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::watch::Watch;
use crate::measure::{Buckets, distinct};

/// The values of tetrahedra, faces and edges.
pub struct Solid {
    /// Those of the tetrahedra.
    pub tetrahedra: Vec<f64>,
    /// The faces: rows of each ascending, and the faces, too.
    pub faces: Vec<[i32; 3]>,
    /// Their values.
    pub of_faces: Vec<f64>,
    /// The edges: the smaller row first, ascending.
    pub edges: Vec<[i32; 2]>,
    /// Their values.
    pub of_edges: Vec<f64>,
}

/// The pairs of corners of a tetrahedron, and the other pair.
const EDGES: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 1, 3],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 0, 2],
    [2, 3, 0, 1],
];

/// The arrays of tetrahedra, their values, and those of faces with their later tetrahedron.
struct Measured<'a> {
    sites: Sites<'a, 3>,
    simplices: &'a [[i32; 4]],
    neighbors: &'a [[i32; 4]],
    tetrahedra: &'a [f64],
    faces: &'a [[f64; 4]],
}

/// The values of tetrahedra, their faces and their edges.
pub fn solid(
    sites: Sites<'_, 3>,
    simplices: &[[i32; 4]],
    neighbors: &[[i32; 4]],
    workers: usize,
    watch: &Watch,
) -> Result<Solid> {
    let (count, n) = (simplices.len(), sites.points.len());
    let tetrahedra = each(count, workers, watch, |t| {
        ball::tetrahedron(sites.kind(), simplices[t].map(|v| sites.at(v)))
    })?;
    let mut all = Measured {
        sites,
        simplices,
        neighbors,
        tetrahedra: &tetrahedra,
        faces: &[],
    };
    let by_corner = each(count, workers, watch, |t| {
        [0, 1, 2, 3].map(|k| all.face(t, k).unwrap_or(0.0))
    })?;
    all.faces = &by_corner;
    let (faces, of_faces) = all.listed_faces(n, workers, watch)?;
    let (edges, of_edges) = all.listed_edges(n, workers, watch)?;
    Ok(Solid {
        faces,
        of_faces,
        edges,
        of_edges,
        tetrahedra,
    })
}

impl Measured<'_> {
    /// The rows of the face opposite a corner.
    #[inline]
    fn rows(&self, t: usize, k: usize) -> [i32; 3] {
        [0, 1, 2].map(|i| self.simplices[t][i + usize::from(i >= k)])
    }

    /// The corner of tetrahedron `n` that faces `t`.
    #[inline]
    fn back(&self, n: usize, t: usize) -> usize {
        let found = (0..4).find(|&j| self.neighbors[n][j] == t as i32);
        found.unwrap_or(0)
    }

    /// The value of a face, for its later tetrahedron.
    #[inline]
    fn face(&self, t: usize, k: usize) -> Option<f64> {
        let beyond = self.neighbors[t][k];
        if beyond >= t as i32 {
            return None;
        }
        let kind = self.sites.kind();
        let corners = self.rows(t, k).map(|v| self.sites.at(v));
        let is_met = |t: usize, k: usize| {
            ball::meets_triangle(kind, corners, self.sites.at(self.simplices[t][k]))
        };
        let own = self.tetrahedra[t];
        let Ok(n) = usize::try_from(beyond) else {
            let met = is_met(t, k);
            return Some(if met {
                own
            } else {
                ball::triangle(kind, corners)
            });
        };
        if is_met(t, k) || is_met(n, self.back(n, t)) {
            return Some(own.min(self.tetrahedra[n]));
        }
        Some(ball::triangle(kind, corners))
    }

    fn listed_faces(
        &self,
        n: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<(Vec<[i32; 3]>, Vec<f64>)> {
        let rows_of = |t: usize, to: &mut Buckets<[u32; 4]>| {
            for k in (0..4).filter(|&k| self.neighbors[t][k] < t as i32) {
                let mut face = self.rows(t, k);
                face.sort_unstable();
                let [u, v, w] = face;
                let [high, low] = bits(self.faces[t][k]);
                to.put(u, [v as u32, w as u32, high, low])?;
            }
            Ok(())
        };
        let row = |u: i32, [v, w, high, low]: [u32; 4]| [u as u32, v, w, high, low];
        let rows = distinct::<true, _, _>(self.simplices.len(), n, workers, watch, rows_of, row)?;
        let (mut faces, mut values) = (with_room(rows.len())?, with_room(rows.len())?);
        faces.extend(
            rows.iter()
                .map(|row| [row[0], row[1], row[2]].map(|v| v as i32)),
        );
        values.extend(rows.iter().map(|row| value([row[3], row[4]])));
        Ok((faces, values))
    }

    fn listed_edges(
        &self,
        n: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<(Vec<[i32; 2]>, Vec<f64>)> {
        let rows_of = |t: usize, to: &mut Buckets<[u32; 3]>| {
            for corners in EDGES {
                let Some(found) = self.edge(t, corners) else {
                    continue;
                };
                let [a, b] = [corners[0], corners[1]].map(|i| self.simplices[t][i]);
                let [high, low] = bits(found);
                to.put(a.min(b), [a.max(b) as u32, high, low])?;
            }
            Ok(())
        };
        let row = |u: i32, [v, high, low]: [u32; 3]| [u as u32, v, high, low];
        let rows = distinct::<true, _, _>(self.simplices.len(), n, workers, watch, rows_of, row)?;
        let (mut edges, mut values) = (with_room(rows.len())?, with_room(rows.len())?);
        edges.extend(rows.iter().map(|row| [row[0] as i32, row[1] as i32]));
        values.extend(rows.iter().map(|row| value([row[2], row[3]])));
        Ok((edges, values))
    }

    /// The value of an edge, for its earliest tetrahedron. A first tour stops at an earlier one, so
    /// that conflicts are decided once.
    #[inline]
    fn edge(&self, t: usize, corners: [usize; 4]) -> Option<f64> {
        // Most edges have an earlier tetrahedron next to this one, which costs no tour.
        let is_earlier = |k: usize| {
            let n = self.neighbors[t][corners[k]];
            n >= 0 && n < t as i32
        };
        if is_earlier(2) || is_earlier(3) || !self.tour(t, corners, |n, _, _| n >= t) {
            return None;
        }
        let kind = self.sites.kind();
        let ends = [corners[0], corners[1]].map(|i| self.sites.at(self.simplices[t][i]));
        let (mut least, mut met) = (f64::INFINITY, false);
        self.tour(t, corners, |_, face, apex| {
            least = least.min(face);
            met |= apex.is_some_and(|v| ball::meets_edge(kind, ends, self.sites.at(v)));
            true
        });
        Some(if met { least } else { ball::edge(kind, ends) })
    }

    /// Goes around an edge, in both directions if it ends outside, and calls `visit` with each
    /// tetrahedron, the value of the face into it, and the corner of that face; at the end of a
    /// direction, with the face to the outside. Whether all visits want to go on.
    #[inline]
    fn tour(
        &self,
        start: usize,
        [_, _, c, d]: [usize; 4],
        mut visit: impl FnMut(usize, f64, Option<i32>) -> bool,
    ) -> bool {
        for [mut out, mut stay] in [[c, d], [d, c]] {
            let mut t = start;
            loop {
                // The face opposite `out` has the edge and `stay`.
                let beyond = self.neighbors[t][out];
                let apex = self.simplices[t][stay];
                let Ok(n) = usize::try_from(beyond) else {
                    if !visit(t, self.value_of(t, out, None), Some(apex)) {
                        return false;
                    }
                    break;
                };
                let back = self.back(n, t);
                if !visit(n, self.value_of(t, out, Some((n, back))), Some(apex)) {
                    return false;
                }
                if n == start {
                    return true;
                }
                // The new corner is opposite the common face.
                let old = (0..4).find(|&j| self.simplices[n][j] == apex).unwrap_or(0);
                (t, out, stay) = (n, old, back);
            }
        }
        true
    }

    /// The value of a face, which is with its later tetrahedron.
    #[inline]
    fn value_of(&self, t: usize, k: usize, beyond: Option<(usize, usize)>) -> f64 {
        match beyond {
            Some((n, back)) if n > t => self.faces[n][back],
            _ => self.faces[t][k],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::error::Error;
    use crate::measure::{edges, faces3};

    /// An octahedron, cut into tetrahedra around the segment between its poles.
    const POINTS: [[f64; 3]; 6] = [
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [-2.0, 0.0, 0.0],
        [0.0, -2.0, 0.0],
    ];

    fn tiling() -> (Vec<[i32; 4]>, Vec<[i32; 4]>) {
        let simplices = (0..4).map(|i| [0, 1, 2 + (i + 1) % 4, 2 + i]);
        // Across the face without the next point of the equator is the one before, and so on.
        let neighbors = (0..4).map(|i| [-1, -1, (i + 3) % 4, (i + 1) % 4]);
        (simplices.collect(), neighbors.collect())
    }

    #[test]
    fn every_face_and_edge_is_listed_once() {
        let (simplices, neighbors) = tiling();
        let watch = Watch::idle();
        let sites = Sites {
            points: &POINTS,
            weights: &[],
        };
        for workers in [1, 2] {
            let found = solid(sites, &simplices, &neighbors, workers, &watch).unwrap();
            let faces = faces3(&simplices, &neighbors, 6, workers, &watch).unwrap();
            assert_eq!(found.faces, faces);
            assert_eq!(found.edges, edges(&simplices, 6, workers, &watch).unwrap());
            // The segment between the poles, and the sides of the equator.
            assert_eq!(found.of_edges[0], 1.0);
            assert_eq!(found.of_edges[5], 1.25);
            assert!(found.tetrahedra.iter().all(|&r| r == 2.125));
        }
    }

    #[test]
    fn it_can_be_interrupted() {
        let (simplices, neighbors) = tiling();
        let sites = Sites {
            points: &POINTS,
            weights: &[],
        };
        let stopped = solid(sites, &simplices, &neighbors, 1, &Watch::new(&|| true));
        assert!(matches!(stopped, Err(Error::Interrupted)));
    }
}
