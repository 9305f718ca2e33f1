//! Subdivides triangles at vertices and edges of others that lie on them.
//!
//! If no pair crosses, what a triangle has in common with another is a polygon, a segment or a
//! point whose corners are vertices. Each triangle becomes the constrained Delaunay triangulation
//! of the vertices on it, with the edges of others on it as segments, in the projection of its
//! plane. Where two triangles overlap, both have the same vertices and segments there, and hence,
//! as that triangulation is canonical, the same triangles. No two segments cross in a triangle: the
//! triangles that they are edges of would cross, too.

use delone_predicates::{Point3, Sign};

use super::clean::{Clean, is_even, sorted};
use super::contact::{Contact, Place, Projection, Triangle, contact};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::constrained::{Options, constrain};
use crate::delaunay::plane::Method;
use crate::order::sort;

/// No triangle.
pub const NONE: u32 = u32::MAX;
/// Pairs or triangles between two checks for interruption.
const LOT: usize = 1 << 12;
/// Marks per task.
const SHARE: usize = 1 << 10;

/// Triangles that have only vertices and edges in common, with what each is a part of.
#[derive(Debug, Default)]
pub struct Resolved {
    /// Their vertices, oriented as their sources.
    pub faces: Vec<[u32; 3]>,
    /// The first row of the input that each is a part of.
    pub source: Vec<u32>,
    /// How often each occurs in the input with its own orientation, minus with the other.
    pub net: Vec<i32>,
    /// For each row of the input one of its parts; [`NONE`] without any.
    pub place: Vec<u32>,
}

/// A vertex on a triangle, twice, or the ends of a segment on it.
type Mark = (u32, [u32; 2]);

/// The triangles of `rows` as they are, and for those that others repeat how often.
pub fn as_given(clean: &Clean, rows: &[u32]) -> Result<Resolved> {
    let mut made = Resolved {
        faces: with_room(rows.len())?,
        source: with_room(rows.len())?,
        net: filled(rows.len(), 1)?,
        place: filled(clean.faces.len(), NONE)?,
    };
    for &row in rows {
        made.place[row as usize] = made.faces.len() as u32;
        made.faces.push(clean.faces[row as usize]);
        made.source.push(row);
    }
    for &[row, first] in &clean.same_faces {
        let at = made.place[first as usize];
        let [other, own] = [row, first].map(|r| is_even(clean.faces[r as usize]));
        made.net[at as usize] += if own == other { 1 } else { -1 };
        made.place[row as usize] = at;
    }
    Ok(made)
}

/// Subdivides the triangles of pairs that touch; no pair may cross.
pub fn resolve(
    points: &[Point3],
    clean: &Clean,
    touching: &[[u32; 2]],
    workers: usize,
    watch: &Watch,
) -> Result<Resolved> {
    let whole = as_given(clean, &clean.kept)?;
    if touching.is_empty() {
        return Ok(whole);
    }
    let marks = marks(points, clean, touching, watch)?;
    let mut shares: Vec<&[Mark]> = Vec::new();
    let mut rest = &marks[..];
    while !rest.is_empty() {
        let mut end = SHARE.min(rest.len());
        while end < rest.len() && rest[end].0 == rest[end - 1].0 {
            end += 1;
        }
        let (share, after) = rest.split_at(end);
        push(&mut shares, share)?;
        rest = after;
    }
    let parts = parallel::map_watched(workers, shares, watch, |share| {
        let mut made = Vec::new();
        for marks in share.chunk_by(|a, b| a.0 == b.0) {
            watch.check()?;
            let face = marks[0].0;
            for ids in parts_of(points, clean.faces[face as usize], marks, watch)? {
                push(&mut made, (face, ids))?;
            }
        }
        Ok(made)
    })?;
    joined(&whole, &parts.concat(), watch)
}

/// What lies on triangles: their rows ascending, each vertex and segment once.
fn marks(
    points: &[Point3],
    clean: &Clean,
    touching: &[[u32; 2]],
    watch: &Watch,
) -> Result<Vec<Mark>> {
    let mut made = Vec::new();
    let mut pace = Pace::new(watch, LOT);
    for &[row_a, row_b] in touching {
        pace.spend(1)?;
        let [a, b] = [row_a, row_b].map(|row| {
            let ids = clean.faces[row as usize];
            let at = ids.map(|v| points[v as usize]);
            Triangle { ids, at }
        });
        let Some(Contact { first, second, .. }) = contact(&a, &b) else {
            continue;
        };
        mark(row_a, (&b, second), (&a, first), &mut made)?;
        mark(row_b, (&a, first), (&b, second), &mut made)?;
    }
    sort(&mut made, watch)?;
    made.dedup();
    Ok(made)
}

/// Marks the vertices of `other` on the triangle `own`, which is in a row, and the parts of its
/// edges there, whose ends may be vertices of `own`.
fn mark(
    row: u32,
    (other, on_own): (&Triangle, [Place; 3]),
    (own, on_other): (&Triangle, [Place; 3]),
    made: &mut Vec<Mark>,
) -> Result<()> {
    for i in 0..3 {
        if matches!(on_own[i], Place::Edge(_) | Place::Inside) {
            push(made, (row, [other.ids[i]; 2]))?;
        }
        let mut along = [NONE; 5];
        let next = (i + 1) % 3;
        let ends = [i, next].into_iter().filter(|&k| on_own[k] != Place::Off);
        let inside = (0..3).filter(|&k| on_other[k] == Place::Edge(i));
        let all = ends.map(|k| other.ids[k]).chain(inside.map(|k| own.ids[k]));
        for (count, v) in all.enumerate() {
            for &u in &along[..count] {
                push(made, (row, [u.min(v), u.max(v)]))?;
            }
            along[count] = v;
        }
    }
    Ok(())
}

/// The triangles of a subdivided triangle.
fn parts_of(
    points: &[Point3],
    corners: [u32; 3],
    marks: &[Mark],
    watch: &Watch,
) -> Result<Vec<[u32; 3]>> {
    let flat = || Error::Internal("a triangle without area is subdivided".into());
    let plane = Projection::of(corners.map(|v| points[v as usize])).ok_or_else(flat)?;
    let mut ids = corners.to_vec();
    ids.extend(marks.iter().flat_map(|(_, ends)| ends));
    ids.sort_unstable();
    ids.dedup();
    let place = |v: u32| ids.partition_point(|&u| u < v) as u32;
    let [a, b, c] = corners.map(place);
    let mut segments = vec![[a, b], [b, c], [c, a]];
    let lines = marks.iter().filter(|(_, [u, v])| u != v);
    segments.extend(lines.map(|(_, ends)| ends.map(place)));
    let flat: Vec<_> = ids
        .iter()
        .map(|&v| plane.of_point(points[v as usize]))
        .collect();
    let options = Options {
        split: false,
        conforming: false,
        max_vertices: 0,
        method: Method::Auto,
        workers: 1,
    };
    let made = constrain(&flat, &segments, options, watch).map_err(|error| match error {
        Error::Crossing { .. } => Error::Internal("segments on a triangle cross".into()),
        other => other,
    })?;
    let turned = plane.turn == Sign::Negative;
    let oriented = |t: [i32; 3]| {
        let [a, b, c] = t.map(|v| ids[v as usize]);
        if turned { [a, c, b] } else { [a, b, c] }
    };
    Ok(made.arrays.simplices.into_iter().map(oriented).collect())
}

/// All triangles, those that are subdivided replaced by their `parts`, each only once.
fn joined(whole: &Resolved, parts: &[(u32, [u32; 3])], watch: &Watch) -> Result<Resolved> {
    let mut keys = with_room(whole.faces.len() + parts.len())?;
    let mut pace = Pace::new(watch, LOT);
    let mut rest = parts;
    for at in 0..whole.faces.len() {
        let row = whole.source[at];
        let own = rest.partition_point(|part| part.0 <= row);
        pace.spend(1 + own)?;
        let (own, after) = rest.split_at(own);
        rest = after;
        for &(_, ids) in own {
            keys.push((sorted(ids), at as u32, ids));
        }
        if own.is_empty() {
            let ids = whole.faces[at];
            keys.push((sorted(ids), at as u32, ids));
        }
    }
    sort(&mut keys, watch)?;
    let mut distinct = with_room(keys.len())?;
    let mut covered = with_room(keys.len())?;
    for same in keys.chunk_by(|x, y| x.0 == y.0) {
        pace.spend(same.len())?;
        let (_, first, ids) = same[0];
        let net: i32 = same
            .iter()
            .map(|&(_, at, other)| {
                let net = whole.net[at as usize];
                if is_even(other) == is_even(ids) {
                    net
                } else {
                    -net
                }
            })
            .sum();
        distinct.push((first, ids, net));
        covered.extend(same.iter().map(|&(_, at, _)| (at, first, ids)));
    }
    sort(&mut distinct, watch)?;
    placed(whole, &distinct, &covered, watch)
}

/// The distinct triangles, sorted by source, as a result; `covered` has for each triangle that was
/// subdivided `(its number, source, vertices)` of its parts.
fn placed(
    whole: &Resolved,
    distinct: &[(u32, [u32; 3], i32)],
    covered: &[(u32, u32, [u32; 3])],
    watch: &Watch,
) -> Result<Resolved> {
    let mut made = Resolved {
        faces: with_room(distinct.len())?,
        source: with_room(distinct.len())?,
        net: with_room(distinct.len())?,
        place: with_room(whole.place.len())?,
    };
    for &(at, ids, net) in distinct {
        made.faces.push(ids);
        made.source.push(whole.source[at as usize]);
        made.net.push(net);
    }
    let mut one = filled(whole.faces.len(), NONE)?;
    let mut pace = Pace::new(watch, LOT);
    for &(at, first, ids) in covered {
        pace.spend(1)?;
        if one[at as usize] == NONE {
            let found = distinct.partition_point(|d| (d.0, d.1) < (first, ids));
            one[at as usize] = found as u32;
        }
    }
    let part = |&at: &u32| if at == NONE { NONE } else { one[at as usize] };
    made.place.extend(whole.place.iter().map(part));
    Ok(made)
}
