//! Convex hulls: only facets, and for each point outside one facet that it sees.
//!
//! The cells are the ghosts of a triangulation without its simplices. In place of the corner behind a
//! facet there is one of D + 1 points that are not on one plane (`Inside`). The point that is farthest
//! from its facet is inserted, and the points of the facets that are removed are kept with new
//! facets (K. L. Clarkson, P. W. Shor, "Applications of random sampling in computational geometry,
//! II", 1989; C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The quickhull algorithm for convex hulls",
//! 1996). A point that sees none of these is inside: the plane of a new facet is a positive
//! combination of the planes of the two facets at its ridge.
//!
//! Where points were on the plane of a facet, a second pass over the extreme points makes the
//! triangulation of each flat facet its Delaunay triangulation, with the canonical choice among ties.

use super::cell::{INFINITE, Inside, Mesh};
use super::order::arranged;
use super::sites::Sites;
use super::triangulate::{simplex_of, sorted};
use super::wrapping::wrap;
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};

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
    let (sites, rows, duplicates) = sorted::<D, P>(points)?;
    hull_of::<D, V, P>(sites, rows, duplicates, watch)
}

/// The hull of sites, which have the given rows.
pub fn hull_of<const D: usize, const V: usize, const P: usize>(
    sites: Sites<D, P>,
    rows: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
    watch: &Watch,
) -> Result<Hull<D>> {
    let mut pace = Pace::new(watch, PACE);
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
        let (mut corners, mut kept) = (Vec::new(), Vec::new());
        for (v, _) in (0u32..).zip(&extreme).filter(|(_, is)| **is) {
            push(&mut corners, v)?;
            push(&mut kept, numbers[v as usize])?;
        }
        let sites = mesh.sites.only(&corners)?;
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
    wrap(&mut mesh, &left, pace)?;
    Ok(mesh)
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
