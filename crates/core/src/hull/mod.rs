//! 2-D and 3-D convex hulls: exact, each vertex extreme, each facet canonical.
//!
//! `plane` builds a lower and an upper chain. In 3-D `surface` builds a surface of triangles by
//! `insertion`, which walks around an `inner` point; `cells` skip most of the points inside.
//! Vertices of the surface may lie in the interior of flat facets; `faces` merges coplanar
//! triangles into polygons of extreme vertices; `polygon` triangulates these by coordinates only.
//! So the result is independent of the insertion order and of row numbers.

mod cells;
mod faces;
mod inner;
mod insertion;
mod plane;
mod polygon;
mod surface;

use delone_predicates::{Point3, lexicographic};

pub use plane::hull2;

use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::watch::Watch;
use faces::Polygons;

/// The convex hull of points in 3-D.
#[derive(Debug, Default)]
pub struct Hull3 {
    /// Triangles, counterclockwise seen from outside, each from its smallest vertex on, in
    /// lexicographic order of their vertices.
    pub simplices: Vec<[u32; 3]>,
    /// The triangle across the edge opposite each vertex.
    pub neighbors: Vec<[u32; 3]>,
    /// The facet of each triangle.
    pub facet: Vec<u32>,
    /// The vertices of all facets, each counterclockwise from its smallest vertex on, concatenated.
    pub polygons: Vec<u32>,
    /// Where the vertices of each facet begin, plus the end.
    pub starts: Vec<u32>,
    /// `[row, vertex]` for rows that repeat a vertex, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

/// The convex hull of finite points; `None` if they span no volume.
pub fn hull3(points: &[Point3], watch: &Watch) -> Result<Option<Hull3>> {
    let Some(surface) = surface::surface(points, watch)? else {
        return Ok(None);
    };
    watch.check()?;
    let found = faces::polygons(points, &surface.facets)?;
    let Vertices {
        rows,
        rank,
        duplicates,
    } = first_rows(points, &found.vertices, &surface.rows)?;
    // From here on vertices are numbered in lexicographic order.
    let Polygons { vertices, starts } = in_order(found, &rank);
    watch.check()?;
    let at: Vec<Point3> = rows.iter().map(|&row| points[row as usize]).collect();
    let mut triangles = with_room(surface.facets.len())?;
    for (i, ends) in (0u32..).zip(starts.windows(2)) {
        let polygon = &vertices[ends[0] as usize..ends[1] as usize];
        if let &[a, b, c] = polygon {
            triangles.push(([a, b, c], i));
            continue;
        }
        let made = polygon::triangulate(&at, polygon, surface.first)?;
        triangles.extend(made.into_iter().map(|t| (smallest_first(t), i)));
    }
    triangles.sort_unstable();
    let (simplices, facet): (Vec<[u32; 3]>, Vec<u32>) = triangles.into_iter().unzip();
    let named = |v: u32| rows[v as usize];
    Ok(Some(Hull3 {
        neighbors: across(&simplices, rows.len())?,
        simplices: simplices.into_iter().map(|t| t.map(named)).collect(),
        facet,
        polygons: vertices.into_iter().map(named).collect(),
        starts,
        duplicates,
    }))
}

/// The vertices of a hull in lexicographic order.
struct Vertices {
    /// The first row of each.
    rows: Vec<u32>,
    /// The rank of each row that represents a vertex of the surface.
    rank: Vec<u32>,
    /// `[row, vertex]` for rows that repeat a vertex, ascending.
    duplicates: Vec<[u32; 2]>,
}

/// Sorts the vertices of a surface; `rows`, ascending, are those that may coincide with one.
fn first_rows(points: &[Point3], vertices: &[u32], rows: &[u32]) -> Result<Vertices> {
    let mut rank = filled(points.len(), u32::MAX)?;
    let mut order: Vec<u32> = with_room(vertices.len())?;
    for &v in vertices {
        if std::mem::replace(&mut rank[v as usize], 0) == u32::MAX {
            order.push(v);
        }
    }
    order.sort_unstable_by(|&u, &v| lexicographic(points[u as usize], points[v as usize]));
    for (i, &v) in (0u32..).zip(&order) {
        rank[v as usize] = i;
    }
    // Any of the rows with equal coordinates may be the vertex of the surface.
    let others = || rows.iter().filter(|&&row| rank[row as usize] == u32::MAX);
    let place = |row: u32| {
        let p = points[row as usize];
        let found = order.binary_search_by(|&v| lexicographic(points[v as usize], p));
        found.ok().map(|i| (i as u32, row))
    };
    let mut found: Vec<(u32, u32)> = others().filter_map(|&row| place(row)).collect();
    let mut first = order.clone();
    for &(i, row) in &found {
        first[i as usize] = first[i as usize].min(row);
    }
    found.extend((0u32..).zip(order));
    found.retain(|&(i, row)| first[i as usize] != row);
    let mut duplicates: Vec<[u32; 2]> = with_room(found.len())?;
    duplicates.extend(found.iter().map(|&(i, row)| [row, first[i as usize]]));
    duplicates.sort_unstable();
    Ok(Vertices {
        rows: first,
        rank,
        duplicates,
    })
}

/// Polygons by rank, each from its smallest vertex on, sorted by their vertices.
fn in_order(mut found: Polygons, rank: &[u32]) -> Polygons {
    for v in &mut found.vertices {
        *v = rank[*v as usize];
    }
    for ends in found.starts.windows(2) {
        let polygon = &mut found.vertices[ends[0] as usize..ends[1] as usize];
        let least = (0..polygon.len()).min_by_key(|&i| polygon[i]);
        polygon.rotate_left(least.unwrap_or(0));
    }
    let mut list: Vec<&[u32]> = found.iter().collect();
    list.sort_unstable();
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

/// Rotates a triangle so that its smallest vertex is first.
fn smallest_first(t: [u32; 3]) -> [u32; 3] {
    let least = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
    [0, 1, 2].map(|k| t[(least + k) % 3])
}

/// The triangle across each edge of a closed surface on `n` vertices.
fn across(simplices: &[[u32; 3]], n: usize) -> Result<Vec<[u32; 3]>> {
    let edges = |t: &[u32; 3]| [0, 1, 2].map(|k| (t[(k + 1) % 3], t[(k + 2) % 3]));
    // For each vertex, the heads of the edges that begin there, with their triangles.
    let mut starts = filled(n + 1, 0u32)?;
    for &v in simplices.as_flattened() {
        starts[v as usize + 1] += 1;
    }
    for v in 0..n {
        starts[v + 1] += starts[v];
    }
    let mut heads = filled(3 * simplices.len(), [0; 2])?;
    let mut next = starts.clone();
    for (i, t) in (0u32..).zip(simplices) {
        for (u, v) in edges(t) {
            let slot = &mut next[u as usize];
            heads[*slot as usize] = [v, i];
            *slot += 1;
        }
    }
    let of = |v: usize| starts[v] as usize..starts[v + 1] as usize;
    // Sorted, since a vertex may have a very high degree.
    (0..n).for_each(|v| heads[of(v)].sort_unstable());
    let mut beyond = with_room(simplices.len())?;
    for t in simplices {
        let mut row = [0; 3];
        for (other, (u, v)) in row.iter_mut().zip(edges(t)) {
            let heads = &heads[of(v as usize)];
            let back = heads.binary_search_by_key(&u, |[head, _]| *head);
            let back = back.map_err(|_| Error::Internal("the hull is not closed".into()))?;
            *other = heads[back][1];
        }
        beyond.push(row);
    }
    Ok(beyond)
}
