//! Convex hulls: facets alone, each point outside kept with one facet that it sees.
//!
//! The cells are the ghosts of a triangulation without its simplices. In place of the corner behind a
//! facet there is one of D + 1 points that are not on one plane (`Inside`). The point that is farthest
//! from its facet is inserted, and the points of the facets that go are kept with new facets (K. L.
//! Clarkson, P. W. Shor, "Applications of random sampling in computational geometry, II", 1989; C. B.
//! Barber, D. P. Dobkin, H. Huhdanpaa, "The quickhull algorithm for convex hulls", 1996). A point that
//! sees none of these is inside: the plane of a new facet is a positive combination of the planes of the
//! two facets at its ridge.
//!
//! Where points were on the plane of a facet, a second pass over the extreme points makes the
//! triangulation of each flat facet its Delaunay triangulation, with the canonical choice among ties.

use super::cavity::Room;
use super::cell::{INFINITE, Inside, Mesh};
use super::dispatch;
use super::order::arranged;
use super::sites::Sites;
use super::triangulate::{simplex_of, sorted};
use crate::error::Result;
use crate::memory::{filled, push, with_room};
use crate::watch::{Pace, Watch};

/// Units of work between two checks for interruption.
const PACE: usize = 1 << 10;

/// A convex hull as arrays.
#[derive(Debug, Clone, PartialEq)]
pub struct Hull<const D: usize> {
    /// Rows of the corners of each facet, positively oriented behind a point inside.
    pub simplices: Vec<[u32; D]>,
    /// The facet opposite each corner.
    pub neighbors: Vec<[u32; D]>,
    /// For each facet, the row of a point that is not on its plane.
    pub inside: Vec<u32>,
    /// The plane of each facet: those that share one have the same number.
    pub plane: Vec<u32>,
    /// Rows that repeat earlier rows, ascending, and the first of these.
    pub duplicates: Vec<[u32; 2]>,
}

/// The convex hull of points; its vertices are extreme points.
pub fn hull<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    watch: &Watch,
) -> Result<Hull<D>> {
    let mut pace = Pace::new(watch, PACE);
    let (sites, rows, duplicates) = sorted::<D, P>(points)?;
    let order = arranged::<D, P>(&sites.scaled)?;
    let mut mesh = faceted::<D, V, P>(sites, &rows, &order, false, &mut pace)?;
    let mut numbers = rows;
    if mesh.counts.ties > 0 {
        let mut extreme = filled(mesh.sites.len(), false)?;
        for c in mesh.alive()? {
            for &v in &mesh.cells[c as usize].vertices[..D] {
                extreme[v as usize] = true;
            }
        }
        let (mut given, mut kept) = (Vec::new(), Vec::new());
        for (v, _) in (0u32..).zip(&extreme).filter(|(_, is)| **is) {
            push(&mut given, mesh.sites.corners(&[v])[0])?;
            push(&mut kept, numbers[v as usize])?;
        }
        let sites = Sites::new(given)?;
        let order = arranged::<D, P>(&sites.scaled)?;
        mesh = faceted(sites, &kept, &order, true, &mut pace)?;
        numbers = kept;
    }
    exported(&mut mesh, &numbers, duplicates, &mut pace)
}

/// The facets of the hull of all sites.
fn faceted<const D: usize, const V: usize, const P: usize>(
    sites: Sites<D, P>,
    rows: &[u32],
    order: &[u32],
    is_delaunay: bool,
    pace: &mut Pace,
) -> Result<Mesh<D, V, P>> {
    let corners: [u32; V] = simplex_of(&sites, rows, order, pace)?;
    let inside = Inside {
        sites: corners.to_vec(),
        far: Vec::new(),
        is_delaunay,
    };
    let mut mesh = Mesh::facets(sites, corners, inside)?;
    let mut left = with_room(order.len())?;
    left.extend(order.iter().copied().filter(|p| !corners.contains(p)));
    dispatch::wrap(&mut mesh, &left, pace)?;
    Ok(mesh)
}

/// Points outside of facets, as linked lists.
struct Waiting {
    /// The first point of each facet.
    head: Vec<u32>,
    /// The point after each.
    next: Vec<u32>,
    /// The point of each facet that is farthest away, and its rounded distance, which is negative.
    farthest: Vec<(f64, u32)>,
}

impl Waiting {
    /// Keeps a point with the first of some facets that it sees, if there is one.
    #[inline(always)]
    fn place<const D: usize, const V: usize, const P: usize>(
        &mut self,
        mesh: &mut Mesh<D, V, P>,
        p: u32,
        facets: &[u32],
        pace: &mut Pace,
    ) -> Result<()> {
        for &c in facets {
            pace.spend(1)?;
            if mesh.conflict(c, p)? {
                let (value, _) = mesh.value(c, &mesh.sites.scaled[p as usize]);
                let c = c as usize;
                self.next[p as usize] = self.head[c];
                self.head[c] = p;
                let (most, far) = self.farthest[c];
                if far == INFINITE || value < most {
                    self.farthest[c] = (value, p);
                }
                return Ok(());
            }
        }
        Ok(())
    }

    /// Room for the facets of a mesh.
    fn widen(&mut self, count: usize) {
        self.head.resize(count, INFINITE);
        self.farthest.resize(count, (0.0, INFINITE));
    }
}

/// Inserts all points that are outside into the hull of the first ones.
#[inline(always)]
pub fn wrap<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    points: &[u32],
    pace: &mut Pace,
) -> Result<()> {
    let mut room = Room::new();
    let mut waiting = Waiting {
        head: Vec::new(),
        next: filled(mesh.sites.len(), INFINITE)?,
        farthest: Vec::new(),
    };
    waiting.widen(mesh.cells.len());
    let mut work: Vec<u32> = (0..mesh.cells.len() as u32).collect();
    for &p in points {
        waiting.place(mesh, p, &work, pace)?;
    }
    let mut list = Vec::new();
    while let Some(c) = work.pop() {
        // A facet may be gone, or have come back with another number of points.
        if waiting.head[c as usize] == INFINITE {
            continue;
        }
        let (_, p) = waiting.farthest[c as usize];
        mesh.open(p, c, &mut room, pace)?;
        mesh.fill(p, &mut room, pace)?;
        waiting.widen(mesh.cells.len());
        // The points of the facets that go, without the new vertex.
        list.clear();
        for &gone in &room.hole {
            let mut q = waiting.head[gone as usize];
            while q != INFINITE {
                if q != p {
                    push(&mut list, q)?;
                }
                q = waiting.next[q as usize];
            }
            waiting.head[gone as usize] = INFINITE;
            waiting.farthest[gone as usize] = (0.0, INFINITE);
        }
        for &q in &list {
            waiting.place(mesh, q, &room.ghosts, pace)?;
        }
        for &born in &room.ghosts {
            if waiting.head[born as usize] != INFINITE {
                push(&mut work, born)?;
            }
        }
    }
    Ok(())
}

/// Numbers of the planes of facets: those of neighbors are the same if the corner that the other one does
/// not have is on the plane.
fn planes<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    alive: &[u32],
    number: &[u32],
    pace: &mut Pace,
) -> Result<Vec<u32>> {
    let mut plane = filled(alive.len(), INFINITE)?;
    let (mut count, mut stack) = (0, Vec::new());
    for &first in alive {
        if plane[number[first as usize] as usize] != INFINITE {
            continue;
        }
        plane[number[first as usize] as usize] = count;
        push(&mut stack, first)?;
        while let Some(c) = stack.pop() {
            pace.spend(1)?;
            for k in 0..D {
                let cell = mesh.cells[c as usize];
                let other = cell.neighbors[k];
                if plane[number[other as usize] as usize] != INFINITE {
                    continue;
                }
                let theirs = mesh.cells[other as usize].vertices;
                let apex = theirs[..D].iter().find(|v| !cell.vertices.contains(v));
                let Some(&apex) = apex else {
                    continue;
                };
                if mesh.is_level(c, apex)? {
                    plane[number[other as usize] as usize] = count;
                    push(&mut stack, other)?;
                }
            }
        }
        count += 1;
    }
    Ok(plane)
}

/// The facets as arrays.
fn exported<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    rows: &[u32],
    duplicates: Vec<[u32; 2]>,
    pace: &mut Pace,
) -> Result<Hull<D>> {
    let alive = mesh.alive()?;
    let mut number = filled(mesh.cells.len(), 0u32)?;
    for (n, &c) in (0u32..).zip(&alive) {
        number[c as usize] = n;
    }
    let mut found = Hull {
        simplices: with_room(alive.len())?,
        neighbors: with_room(alive.len())?,
        inside: with_room(alive.len())?,
        plane: planes(mesh, &alive, &number, pace)?,
        duplicates,
    };
    for &c in &alive {
        let cell = &mesh.cells[c as usize];
        let mut v: [u32; D] = std::array::from_fn(|k| rows[cell.vertices[k] as usize]);
        let mut n: [u32; D] = std::array::from_fn(|k| number[cell.neighbors[k] as usize]);
        // A point outside behind the corners makes them positive; one inside in front of them does if
        // D is odd: D exchanges, and the other side.
        if cell.is_positive() != (D % 2 == 1) {
            v.swap(D - 2, D - 1);
            n.swap(D - 2, D - 1);
        }
        found.simplices.push(v);
        found.neighbors.push(n);
        let far = mesh
            .hull
            .as_ref()
            .map_or(INFINITE, |inside| inside.far[c as usize]);
        found.inside.push(rows[far as usize]);
    }
    Ok(found)
}
