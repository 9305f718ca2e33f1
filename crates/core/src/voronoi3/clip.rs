//! Cells cut to a convex polyhedron.
//!
//! A bounded cell with all vertices inside stays as it is. Each of the others is the polyhedron, cut by
//! the planes of the cell's ridges one after the other (C. H. Rycroft, "Voro++: a three-dimensional Voronoi
//! cell library in C++", Chaos 19, 2009), so that no use is made of vertices that are far away or at infinity.
//!
//! A ridge is measured once: as a whole where one of its two cells is, otherwise in the cell of its
//! first site. So both cells say the same.

use delone_predicates::Point3;

use super::measure::{Cells, Measures, dot, measures};
use super::polyhedron::Polyhedron;
use crate::error::Result;
use crate::memory::with_room;
use crate::parallel;
use crate::watch::Watch;

/// Cells that one task does.
const SHARE: usize = 1 << 10;

/// A convex polyhedron: faces counter-clockwise from outside, and their planes n . x <= c.
#[derive(Clone, Copy)]
pub struct Clip<'a> {
    /// Corners.
    pub points: &'a [Point3],
    /// The corners of face f are `corners[starts[f]..starts[f + 1]]`.
    pub starts: &'a [i32],
    /// Numbers of corners.
    pub corners: &'a [i32],
    /// For each face n and c.
    pub planes: &'a [[f64; 4]],
}

/// What is left of the cells. Those that are not cut are as in the diagram.
#[derive(Debug)]
pub struct Clipped {
    /// Measures of what is left.
    pub measures: Measures,
    /// The cells that were cut, ascending; body b is what is left of `cut[b]`.
    pub cut: Vec<i32>,
    /// The corners of body b are `points[point_starts[b]..point_starts[b + 1]]`.
    pub point_starts: Vec<i32>,
    /// Corners.
    pub points: Vec<Point3>,
    /// The faces of body b are those from `face_starts[b]` to `face_starts[b + 1]`.
    pub face_starts: Vec<i32>,
    /// The corners of face f are `corners[corner_starts[f]..corner_starts[f + 1]]`.
    pub corner_starts: Vec<i32>,
    /// Corners of faces, as numbers in `points`.
    pub corners: Vec<i32>,
    /// The ridge of each face, or !k for face k of the clip.
    pub labels: Vec<i32>,
}

/// What is left of one cell.
struct Body {
    cell: i32,
    volume: f64,
    centroid: Point3,
    areas: Vec<f64>,
    shape: Polyhedron,
}

/// Cuts the cells.
pub fn clip(cells: Cells, clip: Clip, workers: usize, watch: &Watch) -> Result<Clipped> {
    let inside = inside(cells.vertices, clip, workers);
    watch.check()?;
    let is_whole = |cell: usize| {
        cells.ridges_of(cell).iter().all(|&r| {
            let entries = cells.entries_of(r as usize);
            entries.iter().all(|&v| v >= 0 && inside[v as usize])
        })
    };
    let whole: Vec<bool> = (0..cells.site.len()).map(is_whole).collect();
    let mut start = Polyhedron::default();
    start.points.extend_from_slice(clip.points);
    start.starts.extend(clip.starts.iter().map(|&i| i as u32));
    start.corners.extend(clip.corners.iter().map(|&i| i as u32));
    start
        .labels
        .extend((0..clip.planes.len() as i32).map(|k| !k));
    let rest: Vec<usize> = (0..whole.len()).filter(|&c| !whole[c]).collect();
    let bodies = parallel::map(workers, rest.chunks(SHARE).collect(), |part| {
        watch.check()?;
        Ok(part.iter().map(|&c| body(cells, c, &start)).collect())
    });
    let bodies = bodies.into_iter().collect::<Result<Vec<Vec<Body>>>>()?;
    collected(cells, &whole, measures(cells, workers)?, bodies)
}

/// Which vertices lie inside, the boundary included.
fn inside(vertices: &[Point3], clip: Clip, workers: usize) -> Vec<bool> {
    let within = |v: &Point3| {
        let beyond = |p: &[f64; 4]| dot([p[0], p[1], p[2]], *v) > p[3];
        !clip.planes.iter().any(beyond)
    };
    let tasks = vertices.chunks(SHARE).collect();
    let parts = parallel::map(workers, tasks, |part: &[Point3]| {
        part.iter().map(within).collect::<Vec<_>>()
    });
    parts.into_iter().flatten().collect()
}

fn body(cells: Cells, cell: usize, start: &Polyhedron) -> Body {
    let site = cells.site[cell];
    let p = cells.points[site as usize];
    let mut shape = start.clone();
    for &ridge in cells.ridges_of(cell) {
        let (d, h) = cells.plane(ridge as usize, site);
        shape.cut(ridge, |x| {
            dot([x[0] - p[0], x[1] - p[1], x[2] - p[2]], d) - h
        });
        if shape.is_empty() {
            break;
        }
    }
    shape.weld();
    let (volume, centroid) = shape.body();
    Body {
        cell: cell as i32,
        volume,
        centroid,
        areas: (0..shape.labels.len()).map(|f| shape.area(f)).collect(),
        shape,
    }
}

/// Puts bodies into arrays, and their measures in the place of those of whole cells.
fn collected(
    cells: Cells,
    whole: &[bool],
    mut measures: Measures,
    bodies: Vec<Vec<Body>>,
) -> Result<Clipped> {
    let bodies = || bodies.iter().flatten();
    // Only ridges between two whole cells, or a whole and a cut one, keep their area.
    let mut cell_of = vec![usize::MAX; cells.points.len()];
    for (cell, &site) in cells.site.iter().enumerate() {
        cell_of[site as usize] = cell;
    }
    let is_whole = |site: i32| whole[cell_of[site as usize]];
    for (area, &[a, b]) in measures.ridge_areas.iter_mut().zip(cells.sites) {
        if !is_whole(a) && !is_whole(b) {
            *area = 0.0;
        }
    }
    let count = |of: fn(&Body) -> usize| bodies().map(of).sum::<usize>();
    let mut out = Clipped {
        measures,
        cut: with_room(count(|_| 1))?,
        point_starts: vec![0],
        points: with_room(count(|b| b.shape.points.len()))?,
        face_starts: vec![0],
        corner_starts: vec![0],
        corners: with_room(count(|b| b.shape.corners.len()))?,
        labels: with_room(count(|b| b.shape.labels.len()))?,
    };
    for body in bodies() {
        let cell = body.cell as usize;
        let base = out.points.len() as i32;
        out.cut.push(body.cell);
        out.points.extend_from_slice(&body.shape.points);
        for f in 0..body.shape.labels.len() {
            let face = body.shape.face(f).iter().map(|&v| base + v as i32);
            out.corners.extend(face);
            out.corner_starts.push(out.corners.len() as i32);
        }
        out.labels.extend_from_slice(&body.shape.labels);
        out.point_starts.push(out.points.len() as i32);
        out.face_starts.push(out.labels.len() as i32);
        out.measures.volumes[cell] = body.volume;
        out.measures.centroids[cell] = body.centroid;
        out.measures.areas[cell] = body.areas.iter().sum();
        for (&label, area) in body.shape.labels.iter().zip(&body.areas) {
            if label >= 0 {
                let [a, b] = cells.sites[label as usize];
                if a == cells.site[cell] && !is_whole(b) {
                    out.measures.ridge_areas[label as usize] += area;
                }
            }
        }
    }
    Ok(out)
}

/// What half-spaces n . x <= c leave of the cube of all |x| <= size: faces have the labels of their
/// half-spaces, negative for the cube.
pub fn halfspaces(planes: &[[f64; 4]], size: f64) -> Shape {
    let mut shape = Polyhedron::cube(size);
    for (i, p) in (0..).zip(planes) {
        shape.cut(i, |x| dot([p[0], p[1], p[2]], x) - p[3]);
        if shape.is_empty() {
            break;
        }
    }
    shape.weld();
    let signed = |v: Vec<u32>| v.into_iter().map(|i| i as i32).collect();
    Shape {
        points: shape.points,
        starts: signed(shape.starts),
        corners: signed(shape.corners),
        labels: shape.labels,
    }
}

/// A polyhedron as arrays.
#[derive(Debug)]
pub struct Shape {
    /// Corners.
    pub points: Vec<Point3>,
    /// The corners of face f are `corners[starts[f]..starts[f + 1]]`.
    pub starts: Vec<i32>,
    /// Numbers of corners, counter-clockwise from outside.
    pub corners: Vec<i32>,
    /// Where each face comes from.
    pub labels: Vec<i32>,
}
