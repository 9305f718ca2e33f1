//! A live triangulation from all of its points, by the method for points that do not change.

use delone_predicates::Point3;

use super::mesh::{INFINITE, Mesh};
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};
use crate::delaunay::space::triangulate;
use crate::live::build::{Sites, flat};
use crate::live::kernel::Built;
use crate::live::rows::NONE;
use crate::live::store::{Counts, Record, Site, Store};
use crate::mesh::space::{FACETS, LIMIT, corner, tetrahedron};
use crate::order::{order_of, sort};

/// Tetrahedra, or rows, between two checks for interruption.
const LOT: usize = 1 << 16;

/// The mesh of `points`, which are at `rows`, ascending, among `total` rows; and if there is no
/// tetrahedron, the vertices in lexicographic order.
pub fn built(
    points: &[Point3],
    rows: &[u32],
    total: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Built<Mesh>> {
    let room = roomy(points.len() + 1);
    match triangulate(points, workers, watch) {
        Ok(made) => {
            let order = order_of(points, workers, watch)?;
            let mut sites = Sites::of(points, rows, total, room)?;
            let duplicates = made.duplicates;
            let mut vertices = filled(points.len(), 0)?;
            for &[row, _] in &duplicates {
                vertices[row as usize] = NONE;
            }
            let mut pace = Pace::new(watch, LOT);
            for i in order.into_iter().flatten() {
                pace.spend(1)?;
                if vertices[i as usize] != NONE {
                    vertices[i as usize] = sites.add(i);
                }
            }
            for &[row, first] in &duplicates {
                sites.attach(row, vertices[first as usize]);
            }
            let mesh = imported(made.arrays, &vertices, sites.sites, watch)?;
            Ok((mesh, sites.own, Vec::new()))
        }
        Err(Error::TooFewInSpace { .. } | Error::Collinear { .. } | Error::Coplanar { .. }) => {
            flat(points, rows, total, room, Mesh::of, watch)
        }
        Err(error) => Err(error),
    }
}

/// Room for n items and for those that edits add soon: untouched memory costs nothing, and a move to
/// larger memory costs as much as many edits.
fn roomy(n: usize) -> usize {
    n + n / 8 + 64
}

/// A mesh of these tetrahedra, whose points have these vertices, and of ghosts.
fn imported(
    arrays: Arrays<4>,
    vertices: &[u32],
    mut sites: Vec<Site<3>>,
    watch: &Watch,
) -> Result<Mesh> {
    let Arrays {
        simplices,
        neighbors,
    } = arrays;
    let mut pace = Pace::new(watch, LOT);
    let finite = simplices.len();
    let hull = neighbors.as_flattened().iter().filter(|&&s| s < 0).count();
    if finite + hull > LIMIT {
        return Err(Error::TooManyTetrahedra { limit: LIMIT });
    }
    let mut records: Vec<Record> = with_room(roomy(finite + hull))?;
    for (t, (simplex, beyond)) in (0u32..).zip(simplices.iter().zip(&neighbors)) {
        pace.spend(1)?;
        let [a, b, c, d] = simplex.map(|row| vertices[row as usize]);
        for v in [a, b, c, d] {
            sites[v as usize].near = t;
        }
        let [e, f, g, h] = beyond.map(|s| match usize::try_from(s) {
            // Two tetrahedra share one facet at most.
            Ok(s) => {
                let back = neighbors[s].iter().position(|&n| n == t as i32);
                4 * s as u32 + back.unwrap_or(0) as u32
            }
            Err(_) => NONE,
        });
        records.push([a, b, c, d, e, f, g, h]);
    }
    drop((simplices, neighbors));
    sites[INFINITE as usize].near = finite as u32;
    add_ghosts(&mut records, hull, watch)?;
    let counts = Counts::of(sites.len() - 1, finite);
    let room = records.capacity();
    Mesh::with_marks(Store::of(records, sites, counts)?, room)
}

/// Adds a ghost at each of the facets that have no other side; there is room.
fn add_ghosts(records: &mut Vec<Record>, hull: usize, watch: &Watch) -> Result<()> {
    let mut pace = Pace::new(watch, LOT);
    let mut edges = with_room(3 * hull)?;
    for e in 0..4 * records.len() as u32 {
        pace.spend(1)?;
        let (t, k) = (tetrahedron(e) as usize, corner(e));
        if records[t][4 + k] != NONE {
            continue;
        }
        // Seen from outside, the facet has the opposite orientation.
        let [b, a, c] = FACETS[k].map(|i| records[t][i]);
        let ghost = 4 * records.len() as u32;
        records.push([a, b, c, INFINITE, NONE, NONE, NONE, e]);
        records[t][4 + k] = ghost + 3;
        for (j, (u, v)) in (0..).zip([(b, c), (c, a), (a, b)]) {
            let ends = u64::from(u.min(v)) << 32 | u64::from(u.max(v));
            edges.push((ends, ghost + j));
        }
    }
    sort(&mut edges, watch)?;
    for &[(_, e), (_, f)] in edges.as_chunks::<2>().0 {
        records[tetrahedron(e) as usize][4 + corner(e)] = f;
        records[tetrahedron(f) as usize][4 + corner(f)] = e;
    }
    Ok(())
}
