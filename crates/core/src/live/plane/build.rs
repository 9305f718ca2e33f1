//! Builds a live triangulation from all of its points, by the method for static points.

use delone_predicates::Point2;

use super::mesh::{INFINITE, Mesh};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};
use crate::delaunay::Clock;
use crate::delaunay::plane::{self, Method};
use crate::live::build::flat;
use crate::live::kernel::Built;
use crate::live::rows::{NONE, Rows};
use crate::live::store::{Counts, Record, Site, Store};
use crate::mesh::plane::{Code, half_edge, triangle};

/// Triangles, or rows, between two checks for interruption.
const LOT: usize = 1 << 16;

/// The share of room that is left for insertions.
const SPARE: usize = 3;

/// The mesh of `points`, which are at `rows`, ascending, among `total` rows; and if there is no
/// triangle, the vertices in order along their line.
pub fn built(
    points: &[Point2],
    rows: &[u32],
    total: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Built<Mesh>> {
    match plane::mesh(points, Method::Auto, workers, watch, &mut Clock::start()) {
        Ok(built) => {
            let (mesh, rows) = imported(built, rows, total, watch)?;
            Ok((mesh, rows, Vec::new()))
        }
        Err(Error::TooFew { .. } | Error::Collinear { .. }) => {
            flat(points, rows, total, points.len() + 1, Mesh::of, watch)
        }
        Err(error) => Err(error),
    }
}

/// A mesh with the vertex at infinity first, and its rows.
fn imported(
    built: plane::Built,
    rows: &[u32],
    total: usize,
    watch: &Watch,
) -> Result<(Mesh, Rows)> {
    let mut pace = Pace::new(watch, LOT);
    let mut mesh = built.mesh;
    let count = built.rows.len();
    let used = 2 * count as u32 - 2;
    let mut sites = with_room(count + 1 + count / SPARE)?;
    sites.push(Site::AT_INFINITY);
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
    let patch = mesh.resume(used);
    let corner = |v: u32| {
        if v == patch.infinite() {
            INFINITE
        } else {
            v + 1
        }
    };
    // Triangles in the order of their smallest vertices, which is that of the curve: a neighborhood
    // then takes a few chunks and a few cache lines.
    let least = |t: u32| patch.corners(t).into_iter().min().unwrap_or_default() as usize;
    let mut start = filled(count + 1, 0u32)?;
    for t in 0..used {
        pace.spend(1)?;
        start[least(t) + 1] += 1;
    }
    for v in 0..count {
        start[v + 1] += start[v];
    }
    let mut place = with_room(used as usize)?;
    for t in 0..used {
        pace.spend(1)?;
        let at = &mut start[least(t)];
        place.push(*at);
        *at += 1;
    }
    // Untouched room for the next batches costs nothing.
    let mut records: Vec<Record> = with_room(used as usize + used as usize / SPARE)?;
    records.resize(used as usize, [0; 8]);
    let mut ghosts = 0;
    for (t, &at) in (0u32..).zip(&place) {
        pace.spend(1)?;
        let [u, v, w] = patch.corners(t);
        let [a, b, c] = [corner(u), corner(v), corner(w)];
        ghosts += usize::from([a, b, c].contains(&INFINITE));
        let [e, f, g] = patch.opposites(t);
        let moved = |e: Code| half_edge(place[triangle(e) as usize], e & 3);
        records[at as usize] = [a, b, c, 0, moved(e), moved(f), moved(g), 0];
        for (e, v) in (half_edge(at, 0)..).zip([a, b, c]) {
            sites[v as usize].near = e;
        }
    }
    let counts = Counts::of(count, used as usize - ghosts);
    drop(mesh);
    Ok((Mesh::of(Store::of(records, sites, counts)?), own))
}
