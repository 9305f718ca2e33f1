//! A live triangulation from all of its points, by the method for points that do not change.

use delone_predicates::{Point2, lexicographic};

use super::mesh::{Counts, INFINITE, Mesh, Record, Site};
use crate::delaunay2::{Built, Clock, Method, mesh};
use crate::error::{Error, Result};
use crate::live::chunks::Chunks;
use crate::live::rows::{NONE, Rows};
use crate::memory::with_room;
use crate::mesh2::Code;
use crate::order::sort_by;
use crate::watch::{Pace, Watch};

/// Triangles, or rows, between two checks for interruption.
const LOT: usize = 1 << 16;

/// The vertex at infinity.
const AT_INFINITY: Site = Site {
    at: [f64::NAN; 2],
    near: NONE,
    head: NONE,
};

/// The mesh of `points`, which are at `rows`, ascending, among `total` rows; and if there is no
/// triangle, the vertices in order along their line.
pub fn built(
    points: &[Point2],
    rows: &[u32],
    total: usize,
    workers: usize,
    watch: &Watch,
) -> Result<(Mesh, Rows, Vec<u32>)> {
    match mesh(points, Method::Auto, workers, watch, &mut Clock::start()) {
        Ok(built) => {
            let (mesh, rows) = imported(built, rows, total, watch)?;
            Ok((mesh, rows, Vec::new()))
        }
        Err(Error::TooFew { .. } | Error::Collinear { .. }) => flat(points, rows, total, watch),
        Err(error) => Err(error),
    }
}

/// The vertices of points on one line.
fn flat(
    points: &[Point2],
    rows: &[u32],
    total: usize,
    watch: &Watch,
) -> Result<(Mesh, Rows, Vec<u32>)> {
    let mut order = with_room(points.len())?;
    order.extend(0..points.len() as u32);
    let point = |i: u32| points[i as usize].map(|x| x + 0.0);
    let along = |&i: &u32, &j: &u32| lexicographic(point(i), point(j)).then(i.cmp(&j));
    sort_by(&mut order, watch, along)?;
    let mut sites = with_room(points.len() + 1)?;
    sites.push(AT_INFINITY);
    let mut own = Rows::gone(total)?;
    let mut line = with_room(points.len())?;
    for i in order {
        let p = point(i);
        if sites.last().is_none_or(|last: &Site| last.at != p) {
            line.push(sites.len() as u32);
            sites.push(Site {
                at: p,
                near: NONE,
                head: NONE,
            });
        }
        let v = sites.len() - 1;
        sites[v].head = own.attach(rows[i as usize], v as u32, sites[v].head);
    }
    let counts = Counts {
        vertices: line.len() as u32,
        ghosts: 0,
        record: NONE,
        site: NONE,
    };
    let records = Chunks::of(Vec::new())?;
    Ok((Mesh::of(records, Chunks::of(sites)?, counts, 0), own, line))
}

/// A mesh with the vertex at infinity first, and its rows.
fn imported(built: Built, rows: &[u32], total: usize, watch: &Watch) -> Result<(Mesh, Rows)> {
    let mut pace = Pace::new(watch, LOT);
    let mut mesh = built.mesh;
    let count = built.rows.len();
    let used = 2 * count as u32 - 2;
    let mut sites = with_room(count + 1)?;
    sites.push(AT_INFINITY);
    let mut own = Rows::gone(total)?;
    for (v, &first) in built.rows.iter().enumerate() {
        pace.spend(1)?;
        let head = own.attach(rows[first as usize], v as u32 + 1, NONE);
        let at = built.points[v];
        sites.push(Site {
            at,
            near: NONE,
            head,
        });
    }
    for &[row, first] in &built.duplicates {
        pace.spend(1)?;
        let head = rows[first as usize];
        if let Some(v) = own.vertex(i64::from(head)) {
            own.attach(rows[row as usize], v, head);
        }
    }
    let mut records: Vec<Record> = with_room(used as usize)?;
    let mut ghosts = 0;
    let patch = mesh.resume(used);
    for t in 0..used {
        pace.spend(1)?;
        let mut record = *patch.record(t);
        (record[3], record[7]) = (0, 0);
        for (k, v) in record[..3].iter_mut().enumerate() {
            *v = if *v == patch.infinite() {
                INFINITE
            } else {
                *v + 1
            };
            ghosts += u32::from(*v == INFINITE);
            sites[*v as usize].near = 8 * t as Code + k as Code;
        }
        records.push(record);
    }
    let counts = Counts {
        vertices: count as u32,
        ghosts,
        record: NONE,
        site: NONE,
    };
    drop(mesh);
    let mesh = Mesh::of(Chunks::of(records)?, Chunks::of(sites)?, counts, 0);
    Ok((mesh, own))
}
