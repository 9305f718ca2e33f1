//! Convex hulls in the plane and in space: exact, each vertex extreme, each facet canonical.
//!
//! `plane` is one chain below and one above. In space `insertion` makes a surface of triangles, in
//! which vertices may lie in the middle of flat facets; `faces` merges coplanar triangles to polygons
//! of extreme vertices; `polygon` triangulates those by coordinates alone. Orders and numbers of
//! insertion leave no trace.

mod faces;
mod insertion;
mod plane;
mod polygon;

use delone_predicates::{Point3, lexicographic};

pub use plane::hull2;

use crate::error::{Error, Result};
use crate::memory::{filled, with_room};
use crate::watch::Watch;
use faces::Polygons;

/// The hull of points in space.
#[derive(Debug, Default)]
pub struct Hull3 {
    /// Triangles, counter-clockwise seen from outside, each from its smallest vertex on; in
    /// lexicographic order of their vertices.
    pub simplices: Vec<[u32; 3]>,
    /// The triangle across the edge opposite each vertex.
    pub neighbors: Vec<[u32; 3]>,
    /// The facet of each triangle.
    pub facet: Vec<u32>,
    /// The vertices of each facet, counter-clockwise from the smallest on, one facet after the other.
    pub polygons: Vec<u32>,
    /// Where the vertices of each facet begin, and the end.
    pub starts: Vec<u32>,
    /// `[row, vertex]` for rows that repeat a vertex, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

/// The hull of finite points; nothing where they span no volume.
pub fn hull3(points: &[Point3], watch: &Watch) -> Result<Option<Hull3>> {
    let Some(surface) = insertion::surface(points, watch)? else {
        return Ok(None);
    };
    watch.check()?;
    let mut found = faces::polygons(points, &surface.facets)?;
    let (rank, duplicates) = first_rows(points, &mut found.vertices)?;
    let Polygons {
        vertices: polygons,
        starts,
    } = in_order(found, &rank);
    watch.check()?;
    let mut triangles = with_room(surface.facets.len())?;
    for (i, ends) in (0u32..).zip(starts.windows(2)) {
        let polygon = &polygons[ends[0] as usize..ends[1] as usize];
        let made = polygon::triangulate(points, polygon, surface.first)?;
        triangles.extend(made.into_iter().map(|t| (turned(t, &rank), i)));
    }
    triangles.sort_unstable_by_key(|(t, _)| t.map(|v| rank[v as usize]));
    let (simplices, facet): (Vec<[u32; 3]>, Vec<u32>) = triangles.into_iter().unzip();
    Ok(Some(Hull3 {
        neighbors: across(&simplices)?,
        simplices,
        facet,
        polygons,
        starts,
        duplicates,
    }))
}

/// Names each vertex by the first row with its coordinates; returns the place of each vertex in
/// lexicographic order, of other rows nothing, and the rows that repeat a vertex with it.
fn first_rows(points: &[Point3], vertices: &mut [u32]) -> Result<(Vec<u32>, Vec<[u32; 2]>)> {
    let mut rank = filled(points.len(), u32::MAX)?;
    let mut order = with_room(vertices.len())?;
    for &v in &*vertices {
        if std::mem::replace(&mut rank[v as usize], 0) == u32::MAX {
            order.push(v);
        }
    }
    let at = |v: u32| points[v as usize];
    order.sort_unstable_by(|&u, &v| lexicographic(at(u), at(v)));
    for (i, &v) in (0u32..).zip(&order) {
        rank[v as usize] = i;
    }
    let mut first = filled(order.len(), u32::MAX)?;
    let mut duplicates = Vec::new();
    for (row, &p) in (0u32..).zip(points) {
        if let Ok(i) = order.binary_search_by(|&v| lexicographic(at(v), p)) {
            if first[i] == u32::MAX {
                first[i] = row;
            } else {
                duplicates.push([row, first[i]]);
            }
        }
    }
    for v in vertices {
        *v = first[rank[*v as usize] as usize];
    }
    for (i, &row) in (0u32..).zip(&first) {
        rank[row as usize] = i;
    }
    Ok((rank, duplicates))
}

/// Polygons from their smallest vertex on, in the order of their vertices.
fn in_order(mut found: Polygons, rank: &[u32]) -> Polygons {
    let of = |v: &u32| rank[*v as usize];
    for ends in found.starts.windows(2) {
        let polygon = &mut found.vertices[ends[0] as usize..ends[1] as usize];
        let least = (0..polygon.len()).min_by_key(|&i| of(&polygon[i]));
        polygon.rotate_left(least.unwrap_or(0));
    }
    let mut list: Vec<&[u32]> = found.iter().collect();
    list.sort_unstable_by(|a, b| a.iter().map(of).cmp(b.iter().map(of)));
    let mut sorted = Polygons {
        starts: vec![0],
        ..Polygons::default()
    };
    for polygon in list {
        sorted.vertices.extend_from_slice(polygon);
        sorted.starts.push(sorted.vertices.len() as u32);
    }
    sorted
}

/// A triangle from its smallest vertex on.
fn turned(t: [u32; 3], rank: &[u32]) -> [u32; 3] {
    let least = (0..3).min_by_key(|&k| rank[t[k] as usize]).unwrap_or(0);
    [0, 1, 2].map(|k| t[(least + k) % 3])
}

/// The triangle across each edge of a closed surface.
fn across(simplices: &[[u32; 3]]) -> Result<Vec<[u32; 3]>> {
    let mut edges = with_room(3 * simplices.len())?;
    for (i, t) in (0u32..).zip(simplices) {
        for k in 0..3 {
            let (u, v) = (t[(k + 1) % 3], t[(k + 2) % 3]);
            edges.push((
                u64::from(u.min(v)) << 32 | u64::from(u.max(v)),
                3 * i + k as u32,
            ));
        }
    }
    edges.sort_unstable();
    let mut beyond = filled(simplices.len(), [0; 3])?;
    let (pairs, rest) = edges.as_chunks();
    for &[(edge, one), (other_edge, other)] in pairs {
        if edge != other_edge || !rest.is_empty() {
            return Err(Error::Internal("the hull is not closed".into()));
        }
        beyond[one as usize / 3][one as usize % 3] = other / 3;
        beyond[other as usize / 3][other as usize % 3] = one / 3;
    }
    Ok(beyond)
}
