//! Merges coplanar triangles of a convex surface into polygons of extreme points.
//!
//! A supporting plane meets the polytope in one convex polygon. So triangles belong to one side
//! exactly if they are joined by edges whose two triangles are coplanar, and the boundary of a side
//! is one cycle.

use delone_predicates::{Point3, Sign, orient3d};

use super::insertion::{Facet, in_line};
use crate::base::error::{Error, Result};
use crate::base::memory::filled;

/// Lists of vertices, concatenated.
#[derive(Debug, Default)]
pub struct Polygons {
    /// The vertices of all polygons.
    pub vertices: Vec<u32>,
    /// Where each polygon begins, plus the end.
    pub starts: Vec<u32>,
}

impl Polygons {
    /// The polygons.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let ends = self.starts.windows(2);
        ends.map(|w| &self.vertices[w[0] as usize..w[1] as usize])
    }
}

/// The corners of each side, counterclockwise seen from outside.
pub fn polygons(points: &[Point3], facets: &[Facet]) -> Result<Polygons> {
    let mut met = filled(facets.len(), false)?;
    // For each vertex on the boundary of the current side, the next one.
    let mut after = filled(points.len(), 0)?;
    let mut rim = Vec::new();
    let mut open = Vec::new();
    let mut found = Polygons {
        starts: vec![0],
        ..Polygons::default()
    };
    for seed in 0..facets.len() {
        if std::mem::replace(&mut met[seed], true) {
            continue;
        }
        let plane = facets[seed].corners;
        rim.clear();
        open.push(seed);
        while let Some(i) = open.pop() {
            let Facet {
                corners, beyond, ..
            } = facets[i];
            for k in 0..3 {
                let j = beyond[k] as usize;
                if !lies_in(points, plane, facets[j].corners) {
                    let (u, v) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                    after[u as usize] = v;
                    rim.push(u);
                } else if !std::mem::replace(&mut met[j], true) {
                    open.push(j);
                }
            }
        }
        add_corners(points, &rim, &after, &mut found)?;
    }
    Ok(found)
}

/// Whether a triangle lies in the plane of another. Shared corners are not tested, which saves much
/// time: a predicate goes through all of its stages before it says zero.
fn lies_in(points: &[Point3], plane: [u32; 3], corners: [u32; 3]) -> bool {
    let [a, b, c] = plane.map(|v| points[v as usize]);
    corners
        .iter()
        .all(|v| plane.contains(v) || orient3d(a, b, c, points[*v as usize]) == Sign::Zero)
}

/// Adds a boundary cycle, without the vertices in the interior of an edge.
fn add_corners(points: &[Point3], rim: &[u32], after: &[u32], found: &mut Polygons) -> Result<()> {
    let broken = || Error::Internal("the boundary of a side is not a cycle".into());
    let &start = rim.first().ok_or_else(broken)?;
    let at = |v: u32| points[v as usize];
    let mut v = start;
    for step in 0..rim.len() {
        let next = after[v as usize];
        let next_but_one = after[next as usize];
        // No triangle is degenerate.
        if rim.len() == 3 || !in_line(at(v), at(next), at(next_but_one)) {
            found.vertices.push(next);
        }
        v = next;
        if (v == start) != (step + 1 == rim.len()) {
            return Err(broken());
        }
    }
    found.starts.push(found.vertices.len() as u32);
    Ok(())
}
