//! The cavity of a query: the triangles whose circles contain it, and their vertices, its natural neighbors.

use delone_predicates::sphere::{Unit, incircle_of};
use delone_predicates::{Point3, Sign};

use crate::base::error::{Error, Result};
use crate::base::memory::push;
use crate::base::watch::Pace;
use crate::sphere::locate::Index;

/// An edge of a triangle of the cavity, counterclockwise.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    /// Its ends, by their places among the neighbors.
    pub ends: [usize; 2],
    /// The triangle to its left, by its place in the cavity.
    pub left: usize,
    /// The triangle of the cavity to its right; none on the rim.
    pub right: Option<usize>,
}

/// An edge whose other side has not been visited.
struct Open {
    triangle: usize,
    corner: usize,
    ends: [usize; 2],
    left: usize,
}

/// A cavity; its buffers are kept for the next query.
#[derive(Default)]
pub struct Cavity {
    /// The neighbors: vertices of the triangulation.
    pub vertices: Vec<u32>,
    /// The triangles, by the places of their corners.
    pub triangles: Vec<[usize; 3]>,
    /// Each edge once; those of the rim are in counterclockwise order.
    pub edges: Vec<Edge>,
    open: Vec<Open>,
}

impl Cavity {
    /// Finds the cavity of `q` from a triangle; false if the circle of this one does not contain it.
    ///
    /// The triangles form a tree: each adds one vertex, as the star of the query is a disk, and no
    /// vertex is inside it, because `q` is not a vertex.
    pub fn find(
        &mut self,
        index: &Index,
        seed: usize,
        q: (Point3, Unit),
        pace: &mut Pace,
    ) -> Result<bool> {
        self.vertices.clear();
        self.triangles.clear();
        self.edges.clear();
        self.open.clear();
        if !in_conflict(index, seed, &q) {
            return Ok(false);
        }
        let arrays = index.arrays();
        for v in arrays.simplices[seed] {
            push(&mut self.vertices, v as u32)?;
        }
        push(&mut self.triangles, [0, 1, 2])?;
        // The last one is taken first.
        for corner in [1, 0, 2] {
            let ends = [(corner + 1) % 3, (corner + 2) % 3];
            let left = 0;
            push(
                &mut self.open,
                Open {
                    triangle: seed,
                    corner,
                    ends,
                    left,
                },
            )?;
        }
        while let Some(Open {
            triangle,
            corner,
            ends: [u, v],
            left,
        }) = self.open.pop()
        {
            pace.spend(1)?;
            let beyond = usize::try_from(arrays.neighbors[triangle][corner]).ok();
            let beyond = beyond.filter(|&t| in_conflict(index, t, &q));
            let right = beyond.map(|_| self.triangles.len());
            push(
                &mut self.edges,
                Edge {
                    ends: [u, v],
                    left,
                    right,
                },
            )?;
            let Some(t) = beyond else { continue };
            if self.triangles.len() > arrays.simplices.len() {
                return Err(Error::Internal(
                    "a cavity on the sphere does not end".into(),
                ));
            }
            //      w          Counterclockwise around the query: first u to w, then w to v.
            //    /   \
            //   v --- u
            let first = self.vertices[u] as i32;
            let k = arrays.simplices[t]
                .iter()
                .position(|&x| x == first)
                .unwrap_or(0);
            let w = self.vertices.len();
            push(&mut self.vertices, arrays.simplices[t][(k + 1) % 3] as u32)?;
            push(&mut self.triangles, [u, w, v])?;
            let left = w - 2;
            push(
                &mut self.open,
                Open {
                    triangle: t,
                    corner: k,
                    ends: [w, v],
                    left,
                },
            )?;
            let corner = (k + 2) % 3;
            push(
                &mut self.open,
                Open {
                    triangle: t,
                    corner,
                    ends: [u, w],
                    left,
                },
            )?;
        }
        Ok(true)
    }
}

/// Whether the query is strictly inside the circle of a triangle.
fn in_conflict(index: &Index, t: usize, q: &(Point3, Unit)) -> bool {
    let [a, b, c] = index.arrays().simplices[t].map(|v| index.ray(v as u32));
    let vectors = [a.0, b.0, c.0, q.0];
    incircle_of(vectors, [&a.1, &b.1, &c.1, &q.1]) == Sign::Positive
}
