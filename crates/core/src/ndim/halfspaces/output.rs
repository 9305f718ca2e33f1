//! The hull of dual points as arrays: simplices, corners with all their half-spaces, planes.

use super::corner::{Corner, corner};
use super::sites::Sites;
use super::start::{first, middle};
use super::wrap::{Hull, NONE};
use crate::base::error::{Error, Result};
use crate::base::memory::{self, filled, push, with_room};
use crate::base::watch::{Pace, Watch};

/// Units of work between two checks for interruption.
const PACE: usize = 1 << 10;

/// An intersection of half-spaces.
#[derive(Debug, Clone, PartialEq)]
pub struct Corners<const D: usize, const V: usize> {
    /// The dual point of each half-space.
    pub dual: Vec<[f64; D]>,
    /// The half-spaces of the simplices of the dual hull, in 2-D and 3-D counterclockwise as seen from
    /// outside and otherwise ascending; sorted by their half-spaces.
    pub simplices: Vec<[u32; D]>,
    /// The corner of each simplex.
    pub corner: Vec<u32>,
    /// The half-spaces that meet in each corner, in the same orders, corner by corner.
    pub facets: Vec<u32>,
    /// Where the half-spaces of each corner begin, and the end.
    pub starts: Vec<u32>,
    /// The corners; infinite where the intersection is unbounded.
    pub points: Vec<[f64; D]>,
    /// The plane of the dual points of each corner: outer unit normal and offset.
    pub equations: Vec<[f64; V]>,
}

/// Why there is no intersection with corners.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    /// The point is not strictly inside this half-space, the first one.
    NotInside(u32),
    /// The point is so close to the boundary of this half-space that its dual point is not a double.
    TooClose(u32),
    /// The dual points span no volume; the vectors of these half-spaces span those of all.
    Flat(Vec<u32>),
}

/// The corners of an intersection, or why there are none.
pub type Found<const D: usize, const V: usize> = std::result::Result<Corners<D, V>, Trouble>;

/// The intersection of half-spaces around a point; all numbers must be finite.
pub fn intersect<const D: usize, const V: usize, const P: usize>(
    rows: &[[f64; V]],
    point: [f64; D],
    watch: &Watch,
) -> Result<Found<D, V>> {
    const { assert!(V == D + 1 && P >= D && D >= 2 && D <= 8) };
    let mut pace = Pace::new(watch, PACE);
    let mut sites = match Sites::<D, V, P>::new(rows, point)? {
        Ok(sites) => sites,
        Err(row) => return Ok(Err(Trouble::NotInside(row))),
    };
    let is_far = |q: &[f64; D]| q.iter().any(|x| !x.is_finite());
    if let Some(row) = sites.dual.iter().position(is_far) {
        return Ok(Err(Trouble::TooClose(row as u32)));
    }
    if rows.is_empty() {
        return Ok(Err(Trouble::Flat(Vec::new())));
    }
    let scaled = sites.scale()?;
    let (corners, sign) = match first(&sites, &scaled, &mut pace)? {
        Ok(found) => found,
        Err(spanning) => return Ok(Err(Trouble::Flat(spanning))),
    };
    sites.look(&scaled, &middle(&scaled, &corners))?;
    let mut hull = Hull::new(sites, corners, sign)?;
    hull.wrap(&mut pace)?;
    exported(hull, &mut pace).map(Ok)
}

/// Facets of a hull by their planes.
struct Planes {
    /// The plane of each facet, [`NONE`] for those that are removed.
    of: Vec<u32>,
    /// The facets, plane by plane.
    members: Vec<u32>,
    /// Where the facets of each plane begin, and the end.
    starts: Vec<u32>,
}

impl Planes {
    fn members(&self, plane: u32) -> &[u32] {
        let plane = plane as usize;
        &self.members[self.starts[plane] as usize..self.starts[plane + 1] as usize]
    }
}

/// The facets of a hull as arrays.
fn exported<const D: usize, const V: usize, const P: usize>(
    mut hull: Hull<'_, D, V, P>,
    pace: &mut Pace,
) -> Result<Corners<D, V>> {
    let planes = planes(&mut hull, pace)?;
    // Simplices by their vertices, ascending, with the vertices in order and the plane.
    let mut simplices = with_room(planes.members.len())?;
    for &c in &planes.members {
        let facet = turned(&hull, c);
        let mut key = facet;
        key.sort_unstable();
        simplices.push((key, facet, planes.of[c as usize]));
    }
    pace.spend(simplices.len())?;
    simplices.sort_unstable();
    let count = planes.starts.len() - 1;
    let mut found = Corners {
        dual: Vec::new(),
        simplices: with_room(simplices.len())?,
        corner: with_room(simplices.len())?,
        facets: with_room(D * count)?,
        starts: with_room(count + 1)?,
        points: with_room(count)?,
        equations: with_room(count)?,
    };
    found.starts.push(0);
    let mut number = filled(count, NONE)?;
    for (n, plane) in (0u32..).zip(in_order(
        &hull,
        &planes,
        &simplices,
        &mut found.facets,
        &mut found.starts,
    )?) {
        pace.spend(16)?;
        number[plane as usize] = n;
        let (point, equation): Corner<D, V> =
            corner(&mut hull, planes.members(plane)[0]).ok_or_else(flat)?;
        found.points.push(point);
        found.equations.push(equation);
    }
    found
        .simplices
        .extend(simplices.iter().map(|(_, facet, _)| *facet));
    found
        .corner
        .extend(simplices.iter().map(|(.., plane)| number[*plane as usize]));
    found.dual = hull.sites.dual;
    Ok(found)
}

/// A simplex: its vertices, ascending and in order, and its plane.
type Simplex<const D: usize> = ([u32; D], [u32; D], u32);

/// The planes in the order of their vertices, which are added to `facets` and `starts`.
fn in_order<const D: usize, const V: usize, const P: usize>(
    hull: &Hull<'_, D, V, P>,
    planes: &Planes,
    simplices: &[Simplex<D>],
    facets: &mut Vec<u32>,
    starts: &mut Vec<u32>,
) -> Result<Vec<u32>> {
    let count = planes.starts.len() - 1;
    let mut order = with_room(count)?;
    if count == simplices.len() {
        // Each simplex has its own plane.
        for (_, facet, plane) in simplices {
            facets.extend_from_slice(facet);
            starts.push(facets.len() as u32);
            order.push(*plane);
        }
        return Ok(order);
    }
    let mut made = with_room(count)?;
    for plane in 0..count as u32 {
        let facet = match planes.members(plane) {
            [one] => turned(hull, *one).to_vec(),
            many => around(hull, many)?,
        };
        let mut key = facet.clone();
        key.sort_unstable();
        made.push((key, facet, plane));
    }
    made.sort_unstable();
    for (_, facet, plane) in made {
        memory::make_room(facets, facet.len())?;
        facets.extend(facet);
        push(starts, facets.len() as u32)?;
        order.push(plane);
    }
    Ok(order)
}

fn flat() -> Error {
    Error::Internal("the vectors of a facet are not independent".into())
}

/// The rows of the vertices of a simplex: in 2-D and 3-D counterclockwise as seen from outside, from the
/// smallest on; otherwise ascending.
///
/// With V components whose last is -1 - p q in the section, the determinant of the vectors and w is
/// that of the differences from the first dual point, times -1 if D is even: positive for w outside of
/// three that are counterclockwise, and of two that are.
fn turned<const D: usize, const V: usize, const P: usize>(
    hull: &Hull<'_, D, V, P>,
    c: u32,
) -> [u32; D] {
    let facet = &hull.facets[c as usize];
    let mut v = facet.vertices.map(|v| hull.sites.first[v as usize]);
    if D > 3 {
        v.sort_unstable();
    } else {
        if facet.odd {
            v.swap(D - 2, D - 1);
        }
        if D == 3 {
            let least = (0..D).min_by_key(|&k| v[k]).unwrap_or(0);
            v.rotate_left(least);
        }
    }
    v
}

/// The vertices of simplices in one plane, in the same orders.
fn around<const D: usize, const V: usize, const P: usize>(
    hull: &Hull<'_, D, V, P>,
    members: &[u32],
) -> Result<Vec<u32>> {
    let mut all = Vec::new();
    for &c in members {
        all.extend(turned(hull, c));
    }
    if D != 3 {
        all.sort_unstable();
        all.dedup();
        return Ok(all);
    }
    // The edges without a counterpart form the outline of the polygon.
    let mut edges = with_room(all.len())?;
    for t in all.chunks_exact(3) {
        edges.extend((0..3).map(|k| (t[k], t[(k + 1) % 3])));
    }
    edges.sort_unstable();
    let is_outer = |(u, v): &(u32, u32)| edges.binary_search(&(*v, *u)).is_err();
    let outer: Vec<(u32, u32)> = edges.iter().copied().filter(is_outer).collect();
    // They are sorted by their first vertices, which are distinct.
    let mut ring = Vec::new();
    let mut at = outer.first().map_or(0, |edge| edge.0);
    for _ in 0..outer.len() {
        push(&mut ring, at)?;
        let found = outer.binary_search_by_key(&at, |edge| edge.0);
        at = found.map_or(at, |k| outer[k].1);
    }
    Ok(ring)
}

/// The planes of facets: neighbors share one if the vertex that only one of them has is on it.
fn planes<const D: usize, const V: usize, const P: usize>(
    hull: &mut Hull<'_, D, V, P>,
    pace: &mut Pace,
) -> Result<Planes> {
    let mut found = Planes {
        of: filled(hull.facets.len(), NONE)?,
        members: with_room(hull.facets.len())?,
        starts: with_room(hull.facets.len() + 1)?,
    };
    for seed in 0..hull.facets.len() {
        if !hull.facets[seed].alive || found.of[seed] != NONE {
            continue;
        }
        let number = found.starts.len() as u32;
        let mut next = found.members.len();
        found.starts.push(next as u32);
        found.of[seed] = number;
        found.members.push(seed as u32);
        while next < found.members.len() {
            let c = found.members[next];
            next += 1;
            pace.spend(1)?;
            let facet = hull.facets[c as usize];
            for t in facet.neighbors {
                if found.of[t as usize] != NONE {
                    continue;
                }
                let theirs = hull.facets[t as usize].vertices;
                let apex = theirs.iter().find(|v| !facet.vertices.contains(v));
                // From the first facet, whose normal is kept.
                if apex.is_some_and(|&v| hull.side(seed as u32, v) == 0) {
                    found.of[t as usize] = number;
                    found.members.push(t);
                }
            }
        }
    }
    found.starts.push(found.members.len() as u32);
    Ok(found)
}
