//! From rows to the Delaunay triangulation of sorted points and four far vertices.

use delone_predicates::{Point3, Sign, lexicographic, orient3d};

use super::coordinates::Coordinates;
use super::mesh::{Mesh, NONE, ascending, number};
use super::task::Task;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::watch::Watch;
use crate::delaunay::space::triangulate;

/// The input in sorted order.
pub struct Imported {
    /// The Delaunay triangulation; the last four vertices are far ones.
    pub mesh: Mesh,
    /// The faces, ascending vertices, sorted.
    pub faces: Vec<[u32; 3]>,
    /// The row of each vertex.
    pub rows: Vec<u32>,
    /// The row of each face.
    pub face_rows: Vec<u32>,
}

/// Sorts the input and triangulates it. Rows that no face uses are vertices, too.
pub fn import(task: Task, watch: &Watch) -> Result<Imported> {
    let n = task.points.len();
    crate::base::points::scan(task.points)?;
    let mut rows: Vec<u32> = with_room(n)?;
    rows.extend(0..n as u32);
    let at = |row: u32| task.points[row as usize];
    rows.sort_unstable_by(|&a, &b| lexicographic(at(a), at(b)).then(a.cmp(&b)));
    if let Some(same) = rows.windows(2).find(|w| at(w[0]) == at(w[1])) {
        let [a, b] = [same[0], same[1]];
        return Err(Error::Shape(format!("rows {a} and {b} are the same point")));
    }
    let mut place = filled(n, NONE)?;
    for (v, &row) in (0..).zip(&rows) {
        place[row as usize] = v;
    }
    let mut points = with_room(n + 4)?;
    // Negative zeros would make bits, not values, depend on the order.
    points.extend(rows.iter().map(|&row| at(row).map(|x| x + 0.0)));
    let far = far_vertices(&points)?;
    points.extend(far);
    let (faces, face_rows) = sorted_faces(task, &place)?;
    let made = triangulate(&points, task.workers, watch)?.arrays;
    let mut corners = with_room(made.simplices.len())?;
    corners.extend(made.simplices.iter().map(|t| t.map(|v| v as u32)));
    let mut across = with_room(made.neighbors.len())?;
    // -1 has the bits of NONE.
    across.extend(made.neighbors.iter().map(|t| t.map(|u| u as u32)));
    let mesh = Mesh::new(Coordinates::new(points)?, corners, across)?;
    Ok(Imported {
        mesh,
        faces,
        rows,
        face_rows,
    })
}

/// The faces in terms of vertices, and their rows, sorted.
fn sorted_faces(task: Task, place: &[u32]) -> Result<(Vec<[u32; 3]>, Vec<u32>)> {
    let mut all: Vec<u128> = with_room(task.faces.len())?;
    for (row, face) in (0..).zip(task.faces) {
        let face = ascending(face.map(|v| place[v as usize]));
        if face[0] == face[1] || face[1] == face[2] {
            return Err(Error::Shape(format!("face {row} has a vertex twice")));
        }
        all.push(number([face[0], face[1], face[2], row]));
    }
    all.sort_unstable();
    if let Some(same) = all.windows(2).find(|w| w[0] >> 32 == w[1] >> 32) {
        let [a, b] = [same[0], same[1]].map(|x| x as u32);
        return Err(Error::Shape(format!("faces {a} and {b} are the same")));
    }
    let face = |x: u128| [x >> 96, x >> 64, x >> 32].map(|v| v as u32);
    Ok(all.into_iter().map(|x| (face(x), x as u32)).unzip())
}

/// Four vertices whose tetrahedron contains all points, far from them.
fn far_vertices(points: &[Point3]) -> Result<[Point3; 4]> {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for p in points {
        for k in 0..3 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    let center = [0, 1, 2].map(|k| low[k] / 2.0 + high[k] / 2.0);
    let reach = (0..3).fold(0.0_f64, |m, k| m.max(high[k] / 2.0 - low[k] / 2.0));
    let size = (0..3).fold(0.0_f64, |m, k| m.max(high[k].abs()).max(low[k].abs()));
    let reach = reach.max(size * 1e-12).max(1e-300);
    for factor in [1024.0, 8.0] {
        let r = reach * factor;
        // A tetrahedron around all points; the smaller one only where the larger is out of range.
        let corner =
            |x: f64, y: f64, z: f64| [center[0] + x * r, center[1] + y * r, center[2] + z * r];
        let far = [
            corner(-1.0, -1.0, -1.0),
            corner(3.0, -1.0, -1.0),
            corner(-1.0, 3.0, -1.0),
            corner(-1.0, -1.0, 3.0),
        ];
        let inside = |p: &Point3| {
            super::mesh::FACES.iter().all(|f| {
                let [a, b, c] = f.map(|i| far[i]);
                orient3d(a, b, c, *p) == Sign::Positive
            })
        };
        let finite = far.as_flattened().iter().all(|x| x.is_finite());
        if finite && points.iter().all(inside) {
            return Ok(far);
        }
    }
    Err(Error::Shape(
        "coordinates above 1e306 leave no room around them: scale them down".into(),
    ))
}
