//! A live triangulation from all of its points, by the method for points that do not change.

use delone_predicates::{Point3, lexicographic};

use super::mesh::{Counts, INFINITE, Mesh, Record, Site};
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};
use crate::delaunay::space::triangulate;
use crate::live::rows::{NONE, Rows};
use crate::mesh::space::{FACETS, LIMIT, corner, tetrahedron};
use crate::order::{order_of, sort, sort_by};

/// Tetrahedra, or rows, between two checks for interruption.
const LOT: usize = 1 << 16;

/// The vertex at infinity.
const AT_INFINITY: Site = Site {
    at: [f64::NAN; 3],
    near: NONE,
    head: NONE,
};

/// The mesh of `points`, which are at `rows`, ascending, among `total` rows; and if there is no
/// tetrahedron, the vertices in lexicographic order.
pub fn built(
    points: &[Point3],
    rows: &[u32],
    total: usize,
    workers: usize,
    watch: &Watch,
) -> Result<(Mesh, Rows, Vec<u32>)> {
    match triangulate(points, workers, watch) {
        Ok(made) => {
            let order = order_of(points, workers, watch)?;
            let mut sites = Sites::of(points, rows, total)?;
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
            flat(points, rows, total, watch)
        }
        Err(error) => Err(error),
    }
}

/// Room for n items and for those that edits add soon: untouched memory costs nothing, and a move to
/// larger memory costs as much as many edits.
fn roomy(n: usize) -> usize {
    n + n / 8 + 64
}

/// Vertices as they are numbered, and their rows.
struct Sites<'a> {
    points: &'a [Point3],
    rows: &'a [u32],
    sites: Vec<Site>,
    own: Rows,
}

impl<'a> Sites<'a> {
    fn of(points: &'a [Point3], rows: &'a [u32], total: usize) -> Result<Self> {
        let mut sites = with_room(roomy(points.len() + 1))?;
        sites.push(AT_INFINITY);
        Ok(Self {
            points,
            rows,
            sites,
            own: Rows::gone(total)?,
        })
    }

    /// Numbers point i.
    fn add(&mut self, i: u32) -> u32 {
        let v = self.sites.len() as u32;
        self.sites.push(Site {
            at: self.points[i as usize].map(|x| x + 0.0),
            near: NONE,
            head: NONE,
        });
        self.attach(i, v);
        v
    }

    /// Puts the row of point i at vertex v.
    fn attach(&mut self, i: u32, v: u32) {
        let site = &mut self.sites[v as usize];
        site.head = self.own.attach(self.rows[i as usize], v, site.head);
    }
}

/// The vertices of points in one plane.
fn flat(
    points: &[Point3],
    rows: &[u32],
    total: usize,
    watch: &Watch,
) -> Result<(Mesh, Rows, Vec<u32>)> {
    let mut order = with_room(points.len())?;
    order.extend(0..points.len() as u32);
    let point = |i: u32| points[i as usize];
    let along = |&i: &u32, &j: &u32| lexicographic(point(i), point(j)).then(i.cmp(&j));
    sort_by(&mut order, watch, along)?;
    let mut sites = Sites::of(points, rows, total)?;
    let mut list: Vec<u32> = with_room(points.len())?;
    for i in order {
        match list.last() {
            Some(&v) if sites.sites[v as usize].at == point(i) => sites.attach(i, v),
            _ => list.push(sites.add(i)),
        }
    }
    let counts = Counts {
        vertices: list.len() as u32,
        tetrahedra: 0,
        record: NONE,
        site: NONE,
    };
    let mesh = Mesh::of(Vec::new(), sites.sites, counts)?;
    Ok((mesh, sites.own, list))
}

/// A mesh of these tetrahedra, whose points have these vertices, and of ghosts.
fn imported(
    arrays: Arrays<4>,
    vertices: &[u32],
    mut sites: Vec<Site>,
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
    let counts = Counts {
        vertices: sites.len() as u32 - 1,
        tetrahedra: finite as u32,
        record: NONE,
        site: NONE,
    };
    Mesh::of(records, sites, counts)
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
