//! Constrained triangulations of directions: each arc is a chain of edges, and the others are
//! Delaunay as far as arcs permit.
//!
//! An arc is the shorter of the two arcs of the great circle through two directions. Arcs are
//! inserted into the Delaunay triangulation by the code for segments in the plane
//! (`constrained::segment`); `constrained::sites` explains why that is correct.
//!
//! # One result
//!
//! A triangle t with normal n, at distance h from the center, has the direction p inside its circle
//! if f_t(p) = n p / h > 1. Let p be visible from a point of t: their short arc, which stays inside
//! the circle if p is there, meets no other vertex and crosses no constrained edge. Each edge that
//! the arc crosses is locally Delaunay, so from triangle to triangle f(p) rises or stays (see
//! `walk`), up to 1 in the last triangle, of which p is a corner. So f_t(p) <= 1: if all edges but
//! the constrained ones are locally Delaunay, then no circle contains a direction that is visible
//! from its triangle. With ties broken by the perturbation of `delone_predicates::sphere`, f
//! differs for all vertices, and two such triangulations are the same: where triangles of both
//! overlapped, one would have a visible corner of the other inside. So neither the order of the
//! rows nor that of the insertions matters. Flips end, as each raises the surface of flat triangles
//! along rays.

use delone_predicates::sphere::same;
use delone_predicates::{Point3, Sign};

use super::directions::Directions;
use super::triangulate::{Built, build, join};
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::points::NAMED_ROWS;
use crate::base::watch::{Pace, Watch};
use crate::constrained::Subsegments;
use crate::constrained::inserted::{Inserted, insert_all};
use crate::constrained::marked::Marked;
use crate::constrained::segment::Met;
use crate::mesh::plane::{export, next, prev, triangle};
use crate::order::sort;

/// The most pairs of crossing arcs that are listed.
const MOST: usize = 1 << 20;
/// Units of work between two checks for interruption; a candidate pair counts as one.
const WATCH_EVERY: usize = 1 << 12;

/// A constrained Delaunay triangulation in the rows of the input.
#[derive(Debug)]
pub struct Constrained {
    /// Triangles, counterclockwise seen from outside, and their neighbors; -1 beyond the hull.
    pub arrays: Arrays<3>,
    /// For each triangle and corner, whether the opposite edge is part of an arc.
    pub constrained: Vec<[bool; 3]>,
    /// `[row, first row of the same direction]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// The edges that the arcs consist of.
    pub subsegments: Subsegments,
    /// Arcs whose ends are the same direction.
    pub zero: Vec<u32>,
    /// `[row, vertex]`: vertices inside arcs, ascending.
    pub through: Vec<[u32; 2]>,
}

/// The constrained Delaunay triangulation of the directions of `vectors`, with the arcs between
/// pairs of their rows, `segments`. Arcs that cross are an error.
pub fn constrain(
    vectors: &[Point3],
    segments: &[[u32; 2]],
    workers: usize,
    watch: &Watch,
) -> Result<Constrained> {
    let mut built = build(vectors, workers, watch)?;
    refuse_antipodes(vectors, segments, watch)?;
    let duplicates = join(&mut built.arranged, &built.repeats, watch)?;
    let place = places(&built, &duplicates, vectors.len())?;
    let Built {
        mesh,
        ghost,
        taken,
        arranged,
        ..
    } = built;
    let mut ends: Vec<[u32; 2]> = with_room(segments.len())?;
    ends.extend(segments.iter().map(|s| s.map(|row| place[row as usize])));
    let rows = arranged.rows;
    let mut marked = Marked::with_records(mesh, arranged.directions, taken as u32, watch)?;
    let (inserted, waiting) = insert_all(&mut marked, &ends, usize::MAX, watch)?
        .ok_or_else(|| Error::Internal("arcs are left".into()))?;
    if !waiting.is_empty() {
        let pairs = crossings(&mut marked, &ends, &inserted, &waiting, watch)?;
        return Err(Error::CrossingArcs { pairs });
    }
    let zero = (0u32..).zip(&ends).filter(|(_, e)| e[0] == e[1]);
    let zero = zero.map(|(row, _)| row).collect();
    let (arrays, constrained) =
        export::partial_marked_arrays(marked.mesh, ghost, taken, &rows, workers, watch)?;
    let Inserted {
        mut pieces,
        mut through,
        repeated,
        ..
    } = inserted;
    for piece in &mut pieces {
        piece.0 = piece.0.map(|v| rows[v as usize]);
    }
    for pair in &mut through {
        pair[1] = rows[pair[1] as usize];
    }
    sort(&mut through, watch)?;
    Ok(Constrained {
        arrays,
        constrained,
        duplicates,
        subsegments: Subsegments::of(&pieces, repeated, watch)?,
        zero,
        through,
    })
}

/// The error of arcs whose ends are opposite: many great circles join them.
fn refuse_antipodes(vectors: &[Point3], segments: &[[u32; 2]], watch: &Watch) -> Result<()> {
    let mut pace = Pace::new(watch, WATCH_EVERY);
    let (mut rows, mut count) = (Vec::new(), 0);
    for (row, &ends) in (0u32..).zip(segments) {
        pace.spend(1)?;
        let [a, b] = ends.map(|v| vectors[v as usize]);
        if same(a.map(|x| -x), b) {
            count += 1;
            if rows.len() < NAMED_ROWS {
                rows.push(row);
            }
        }
    }
    if count > 0 {
        return Err(Error::OppositeEnds { rows, count });
    }
    Ok(())
}

/// The vertex of each of `n` rows.
fn places(built: &Built, duplicates: &[[u32; 2]], n: usize) -> Result<Vec<u32>> {
    let mut is_vertex = filled(built.arranged.rows.len(), true)?;
    for repeat in &built.repeats {
        is_vertex[repeat[0] as usize] = false;
    }
    let mut place = filled(n, 0u32)?;
    for (v, (&row, is_vertex)) in (0u32..).zip(built.arranged.rows.iter().zip(is_vertex)) {
        if is_vertex {
            place[row as usize] = v;
        }
    }
    for &[row, first] in duplicates {
        place[row as usize] = place[first as usize];
    }
    Ok(place)
}

/// The pairs of arcs that cross, ascending; at most [`MOST`]. `waiting` are the arcs that were not
/// inserted completely.
///
/// Of two arcs that cross, one was inserted there, and the other meets it as a marked edge; or both
/// wait, and where they cross they pass through one triangle, its boundary included.
fn crossings(
    marked: &mut Marked<Directions>,
    ends: &[[u32; 2]],
    inserted: &Inserted,
    waiting: &[u32],
    watch: &Watch,
) -> Result<Vec<[u32; 2]>> {
    let mut pace = Pace::new(watch, WATCH_EVERY);
    // Marked edges that waiting arcs cross, triangles that they meet, and vertices on them.
    let (mut edges, mut met, mut on) = (Vec::new(), Vec::new(), Vec::new());
    for &row in waiting {
        let [a, b] = ends[row as usize];
        let mut seen = Vec::new();
        marked.trace(a, b, |mesh, what| {
            if let Met::Across(e) = what
                && mesh.is_marked(e)
            {
                let [u, v] = [next(e), prev(e)].map(|c| mesh.vertex(c));
                edges.push(([u.min(v), u.max(v)], row));
            }
            match what {
                Met::Across(e) | Met::Along(e) => {
                    seen.extend([triangle(e), triangle(mesh.opposite(e))]);
                }
                Met::Vertex(v) => on.push([row, v]),
            }
        })?;
        pace.spend(1 + seen.len())?;
        seen.sort_unstable();
        seen.dedup();
        met.extend(seen.into_iter().map(|t| (t, row)));
    }
    sort(&mut edges, watch)?;
    sort(&mut met, watch)?;
    on.sort_unstable();
    let mut pairs: Vec<[u32; 2]> = Vec::new();
    for &([u, v], row) in &inserted.pieces {
        pace.spend(1)?;
        let edge = [u.min(v), u.max(v)];
        let first = edges.partition_point(|e| e.0 < edge);
        for &(_, other) in edges[first..].iter().take_while(|e| e.0 == edge) {
            push(&mut pairs, [row.min(other), row.max(other)])?;
        }
    }
    let directions = &marked.points;
    let passes = |row: u32, v: u32| on.binary_search(&[row, v]).is_ok();
    for group in met.chunk_by(|s, t| s.0 == t.0) {
        for (i, &(_, s)) in group.iter().enumerate() {
            if pairs.len() > MOST {
                break;
            }
            for &(_, t) in &group[i + 1..] {
                pace.spend(1)?;
                let first = on.partition_point(|x| x[0] < s);
                let mut own = on[first..].iter().take_while(|x| x[0] == s);
                if crosses(directions, ends[s as usize], ends[t as usize])
                    && !own.any(|x| passes(t, x[1]))
                {
                    push(&mut pairs, [s.min(t), s.max(t)])?;
                }
            }
        }
    }
    sort(&mut pairs, watch)?;
    pairs.dedup();
    pairs.truncate(MOST);
    Ok(pairs)
}

/// Whether two arcs cross in the interior of both.
fn crosses(directions: &Directions, [a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
    let side = |p: u32, q: u32, r: u32| directions.orient([p, q, r]);
    // From one side to the other; the last test rules out arcs whose antipodes cross.
    let first = side(a, b, c);
    first != Sign::Zero
        && side(a, b, d) == -first
        && side(c, d, a) == -first
        && side(c, d, b) == first
}
