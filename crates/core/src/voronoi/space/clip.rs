//! Clips cells to a convex polyhedron.
//!
//! A bounded cell with all vertices inside is unchanged. Every other cell is computed from the
//! polyhedron, which is clipped by the planes of the cell's ridges one after the other (C. H.
//! Rycroft, "Voro++: a three-dimensional Voronoi cell library in C++", Chaos 19, 2009), so vertices
//! that are far away or at infinity are not used.
//!
//! Corners are computed in floating point. If three planes meet at a flat angle, as those toward
//! two close sites do with a third one, the corner is computed in integers (`meeting`).
//!
//! A ridge is measured once: as a whole if one of its two cells is unchanged, otherwise in the cell
//! of its first site. So both cells have the same value.

use delone_predicates::{Point3, Sign, orient3d};

use super::measure::{Cells, Measures, dot, length, measures, seen};
use super::meeting::{Plane, meeting};
use super::polyhedron::Polyhedron;
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::parallel;
use crate::base::watch::Watch;

/// Cells per task.
const SHARE: usize = 1 << 10;
/// Planes whose unit normals span less than this meet at a point that rounding makes uncertain.
const FLAT: f64 = 1.0 / 32.0;
/// More than the relative error of a sum of six products of rounded numbers.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A convex polyhedron: faces counterclockwise from outside, and their planes n . x <= c.
#[derive(Clone, Copy)]
pub struct Clip<'a> {
    /// Corners.
    pub points: &'a [Point3],
    /// The corners of face f are `corners[starts[f]..starts[f + 1]]`.
    pub starts: &'a [i32],
    /// Numbers of corners.
    pub corners: &'a [i32],
    /// The vector n and the number c of each face.
    pub planes: &'a [[f64; 4]],
}

/// The clipped cells. Those that are unchanged are as in the diagram.
#[derive(Debug)]
pub struct Clipped {
    /// Measures of the clipped cells.
    pub measures: Measures,
    /// The cells that were clipped, ascending; body b is what is left of `cut[b]`.
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

/// What is left of one cell after clipping.
struct Body {
    cell: i32,
    volume: f64,
    centroid: Point3,
    areas: Vec<f64>,
    shape: Polyhedron,
}

/// Clips the cells.
pub fn clip(cells: Cells, clip: Clip, workers: usize, watch: &Watch) -> Result<Clipped> {
    let inside = inside(cells.vertices, clip, workers, watch)?;
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
    let frame = Frame {
        clip,
        normals: clip
            .planes
            .iter()
            .map(|&[x, y, z, _]| unit([x, y, z]))
            .collect(),
    };
    let rest: Vec<usize> = (0..whole.len()).filter(|&c| !whole[c]).collect();
    let bodies = parallel::map(workers, rest.chunks(SHARE).collect(), |part| {
        let cut = |&c| {
            // A cell takes long if the clip has many faces.
            watch.check()?;
            Ok(body(cells, c, &start, &frame))
        };
        part.iter().map(cut).collect()
    });
    let bodies = bodies.into_iter().collect::<Result<Vec<Vec<Body>>>>()?;
    collected(cells, &whole, measures(cells, workers, watch)?, bodies)
}

/// Which vertices are inside, boundary included.
fn inside(vertices: &[Point3], clip: Clip, workers: usize, watch: &Watch) -> Result<Vec<bool>> {
    let within = |v: &Point3| {
        let beyond = |p: &[f64; 4]| dot([p[0], p[1], p[2]], *v) > p[3];
        !clip.planes.iter().any(beyond)
    };
    let mut found = filled(vertices.len(), false)?;
    let tasks = vertices.chunks(SHARE).zip(found.chunks_mut(SHARE));
    let look = |(part, found): (&[Point3], &mut [bool])| {
        watch.check()?;
        for (vertex, found) in part.iter().zip(found) {
            *found = within(vertex);
        }
        Ok(())
    };
    let parts = parallel::map(workers, tasks.collect(), look);
    parts.into_iter().collect::<Result<()>>()?;
    Ok(found)
}

fn body(cells: Cells, cell: usize, start: &Polyhedron, frame: &Frame) -> Body {
    let mut planes = Planes {
        cells,
        frame,
        site: cells.site[cell],
        ridges: cells.ridges_of(cell),
        known: Vec::new(),
    };
    let mut shape = start.clone();
    for i in 0..planes.ridges.len() {
        let (d, h) = planes.add();
        let p = planes.origin();
        shape.cut(
            i as i32,
            |x| dot([x[0] - p[0], x[1] - p[1], x[2] - p[2]], d) - h,
            |labels| planes.corner(labels),
        );
        if shape.is_empty() {
            break;
        }
    }
    shape.weld();
    for label in shape.labels.iter_mut().filter(|label| **label >= 0) {
        *label = planes.ridges[*label as usize];
    }
    let (volume, centroid) = shape.body();
    Body {
        cell: cell as i32,
        volume,
        centroid,
        areas: (0..shape.labels.len()).map(|f| shape.area(f)).collect(),
        shape,
    }
}

/// The clip, with unit normals.
struct Frame<'a> {
    clip: Clip<'a>,
    normals: Vec<Point3>,
}

impl Frame<'_> {
    /// The plane of a face, as exactly as it is known: the plane of all corners if they are
    /// coplanar, as those of facets are. Corners of half-spaces may be off their plane by rounding.
    fn plane(&self, face: usize) -> Plane {
        let bounds = self.clip.starts[face] as usize..self.clip.starts[face + 1] as usize;
        let corners = &self.clip.corners[bounds];
        let at = |&v: &i32| self.clip.points[v as usize];
        if let [a, b, c, rest @ ..] = corners {
            let [a, b, c] = [a, b, c].map(at);
            if rest.iter().all(|v| orient3d(a, b, c, at(v)) == Sign::Zero) {
                return Plane::Through([a, b, c]);
            }
        }
        Plane::Equation(self.clip.planes[face])
    }
}

/// The planes of a cell; labels are its ridges, or !k for face k of the clip.
struct Planes<'a> {
    cells: Cells<'a>,
    frame: &'a Frame<'a>,
    site: i32,
    ridges: &'a [i32],
    /// For the ridges so far, d and h of `Cells::plane`, and d at length 1.
    known: Vec<(Point3, f64, Point3)>,
}

impl Planes<'_> {
    fn origin(&self) -> Point3 {
        self.cells.points[self.site as usize]
    }

    /// Adds the plane of the next ridge.
    fn add(&mut self) -> (Point3, f64) {
        let (d, h) = self
            .cells
            .plane(self.ridges[self.known.len()] as usize, self.site);
        self.known.push((d, h, unit(d)));
        (d, h)
    }

    fn normal(&self, label: i32) -> Point3 {
        if label < 0 {
            self.frame.normals[!label as usize]
        } else {
            self.known[label as usize].2
        }
    }

    /// The point where three planes meet, correctly rounded, if the angle is so flat that a point
    /// may be far from it although rounding puts it on each plane, and if the point is on the inner
    /// side of all other planes.
    fn corner(&self, labels: [i32; 3]) -> Option<Point3> {
        let [p, q, r] = labels.map(|label| self.normal(label));
        let upright = [0, 1, 2].map(|k| {
            let (x, y) = ((k + 1) % 3, (k + 2) % 3);
            p[x] * q[y] - p[y] * q[x]
        });
        // NaN, from a length out of range, counts as well separated.
        if dot(upright, r).abs() < FLAT {
            let at = meeting(labels.map(|label| self.plane(label)))?;
            return self.holds(at).then_some(at);
        }
        None
    }

    fn plane(&self, label: i32) -> Plane {
        if label < 0 {
            return self.frame.plane(!label as usize);
        }
        let given = self.cells.given();
        let sites = self.cells.sites[self.ridges[label as usize] as usize];
        Plane::Between(
            sites.map(|site| given.point(site)),
            sites.map(|site| given.weight(site)),
        )
    }

    /// Whether a point is, up to rounding, on the inner side of all planes.
    fn holds(&self, at: Point3) -> bool {
        let p = self.origin();
        let size = |n: Point3, far: Point3| (0..3).map(|k| n[k].abs() * far[k]).sum::<f64>();
        let of_ridges = self.known.iter().all(|&(d, h, _)| {
            let far = [0, 1, 2].map(|k| at[k].abs() + p[k].abs());
            dot(seen(at, p), d) - h <= ROUNDING * (size(d, far) + h.abs())
        });
        of_ridges
            && self.frame.clip.planes.iter().all(|&[x, y, z, c]| {
                let n = [x, y, z];
                dot(n, at) - c <= ROUNDING * (size(n, at.map(f64::abs)) + c.abs())
            })
    }
}

fn unit(v: Point3) -> Point3 {
    let size = length(v);
    v.map(|x| x / size)
}

/// Collects the bodies in arrays, and replaces the measures of whole cells by theirs.
fn collected(
    cells: Cells,
    whole: &[bool],
    mut measures: Measures,
    bodies: Vec<Vec<Body>>,
) -> Result<Clipped> {
    let bodies = || bodies.iter().flatten();
    // Only ridges with at least one whole cell keep their area.
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
    // Append each body, and replace the measures of its cell.
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
        out.measures.areas[cell] = body.areas.iter().fold(0.0, |sum, a| sum + a);
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
