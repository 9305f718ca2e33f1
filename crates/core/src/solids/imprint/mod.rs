//! Cuts surfaces that cross or overlap where they meet, so that their triangles share only vertices
//! and edges, or all three vertices.
//!
//! Points where edges cross edges and faces are rounded, and what is nearer than a tolerance, which
//! exceeds the rounding errors, is joined: vertices, vertices on edges and in faces, edges that cross.
//! Each round finds these for all pairs of triangles whose boxes are that near, adds the vertices,
//! and cuts each triangle along the lines that it has in common with others. Cut triangles are not
//! exactly in the planes of their sources, so there are further rounds as long as some cross, and a few
//! until nothing is near. Distances are computed in doubles; the exact tests for surfaces decide whether
//! parts cross.
//!
//! Coordinates are scaled by a power of two first. Vertices, edges and faces are processed in the order
//! of coordinates, so the result does not depend on the order of rows or on threads.

mod cut;
mod events;
pub(crate) mod near;
#[cfg(test)]
mod tests;
mod work;

use delone_predicates::Point3;

use self::cut::cut;
use self::events::Events;
use self::work::{Edges, Face, Work};
use super::surface::edges::Edges as SurfaceEdges;
use super::surface::{NONE, Options as Limits, prepared};
use crate::base::error::Result;
use crate::base::memory::{copied, filled, push, with_room};
use crate::base::points::{Extent, scan};
use crate::base::watch::Watch;
use crate::base::wide::times_power;
use crate::order::sort;

/// Rounds at most. Almost all surfaces need one.
const ROUNDS: usize = 16;
/// Rounds after which parts that do not cross are the result, even if some are near each other.
const SETTLED: usize = 4;
/// Rounds end when there are this many times as many parts as after the first one, and some more for few:
/// what is nearer than the tolerance then causes ever more parts.
const MOST: usize = 8;
const LEAST: usize = 1 << 10;
/// How often lines that cross on a face become vertices in one round.
const CROSSINGS: usize = 4;
/// Two to this power is the smallest tolerance relative to the largest coordinate.
const FINEST: i32 = -48;

/// Options of the caller.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// The distance within which vertices, edges and faces are joined; at least
    /// [`finest`] is used.
    pub tolerance: f64,
    /// The number of threads.
    pub workers: usize,
}

/// A surface cut at itself.
#[derive(Debug)]
pub struct Imprinted {
    /// Vertices after those of the input.
    pub added: Vec<Point3>,
    /// The triangles, each oriented as its source.
    pub faces: Vec<[u32; 3]>,
    /// The row of the input that each is a part of, ascending.
    pub source: Vec<u32>,
    /// `[row, row that replaces it]`: vertices of the input that were joined, ascending.
    pub merged: Vec<[u32; 2]>,
    /// The largest distance of a vertex of a part from its source.
    pub distance: f64,
    /// The tolerance used.
    pub tolerance: f64,
    /// The number of rounds that changed something.
    pub rounds: usize,
    /// `[row, row]`: faces of which parts still cross or touch, or could not be cut, ascending.
    pub crossing: Vec<[u32; 2]>,
}

/// The smallest tolerance for these points: a few rounding errors of the largest coordinate.
pub fn finest(points: &[Point3]) -> f64 {
    times_power(1.0, exponent(points) + FINEST)
}

/// Cuts a surface at itself; `faces` must be rows of `points`.
pub fn imprint(
    points: &[Point3],
    faces: &[[i32; 3]],
    options: Options,
    watch: &Watch,
) -> Result<Imprinted> {
    scan(points)?;
    let shift = exponent(points);
    let used = options.tolerance.max(finest(points));
    let tolerance = times_power(used, -shift);
    let workers = options.workers;
    let mut scaled = with_room(points.len())?;
    scaled.extend(points.iter().map(|p| p.map(|x| times_power(x, -shift))));
    let mut given = with_room(faces.len())?;
    given.extend(
        (0u32..)
            .zip(faces)
            .map(|(row, f)| (f.map(|v| v as u32), row)),
    );
    let mut rows: Vec<u32> = with_room(points.len())?;
    rows.extend(0..points.len() as u32);
    let mut made = Imprinted {
        added: Vec::new(),
        faces: Vec::new(),
        source: Vec::new(),
        merged: Vec::new(),
        distance: 0.0,
        tolerance: used,
        rounds: 0,
        crossing: Vec::new(),
    };
    let (mut work, merged) = Work::arranged(&scaled, &rows, &given, tolerance, watch)?;
    made.merged = merged;
    let closed = is_closed(&work.faces, work.at.len(), watch)?;
    let (mut narrow, mut last, mut before, mut most) = (Vec::new(), None, None, usize::MAX);
    loop {
        made.number(points.len(), &work, shift)?;
        made.crossing = made.left(points, &narrow, workers, watch)?;
        // Parts of a closed surface are closed.
        if closed && made.crossing.is_empty() {
            made.crossing = loose(&work, watch)?;
        }
        let size = (work.faces.len(), work.at.len());
        if made.rounds == 1 {
            most = MOST * size.0 + LEAST;
        }
        // Further rounds join what is still near, but they can also make parts that cross again.
        if made.rounds > 0 && made.crossing.is_empty() {
            last = Some(work.clone());
        }
        let settled = last.is_some() && made.rounds >= SETTLED;
        // They are of no use if they change nothing, or make more and more parts.
        if settled || made.rounds == ROUNDS || before == Some(size) || size.0 > most {
            break;
        }
        before = Some(size);
        let Some((parts, stuck)) = round(&mut work, tolerance, workers, watch)? else {
            break;
        };
        made.rounds += 1;
        narrow = stuck;
        let (next, merged) = Work::arranged(&work.at, &work.row, &parts, tolerance, watch)?;
        for pair in merged {
            push(&mut made.merged, pair)?;
        }
        work = next;
    }
    // The last parts that do not cross.
    if let Some(found) = last {
        work = found;
        made.crossing.clear();
        made.number(points.len(), &work, shift)?;
    }
    sort(&mut made.merged, watch)?;
    made.distance = times_power(distance(&scaled, faces, &work), shift);
    Ok(made)
}

/// Cuts all triangles once: the parts, and the sources that could not be cut. `None` if nothing is
/// near.
#[allow(clippy::type_complexity)]
fn round(
    work: &mut Work,
    tolerance: f64,
    workers: usize,
    watch: &Watch,
) -> Result<Option<(Vec<([u32; 3], u32)>, Vec<u32>)>> {
    let edges = Edges::of(&work.faces, watch)?;
    let mut events = Events::of(work, &edges, tolerance, workers, watch)?;
    if events.on.is_empty() {
        return Ok(None);
    }
    for turn in 0..=CROSSINGS {
        let last = turn == CROSSINGS;
        match cut(work, &edges, &events, tolerance, last, workers, watch)? {
            Ok(parts) => return Ok(Some((parts.faces, parts.narrow))),
            // Three faces meet in a point: a vertex on all of them.
            Err(met) => {
                events.extend(met)?;
                events.name(work, &edges, tolerance, watch)?;
            }
        }
    }
    Ok(None)
}

impl Imprinted {
    /// Fills in the vertices and triangles of the result.
    fn number(&mut self, count: usize, work: &Work, shift: i32) -> Result<()> {
        self.added.clear();
        let mut name = with_room(work.at.len())?;
        for (&row, &p) in work.row.iter().zip(&work.at) {
            if row == NONE {
                name.push((count + self.added.len()) as u32);
                push(&mut self.added, p.map(|x| times_power(x, shift)))?;
            } else {
                name.push(row);
            }
        }
        self.faces = with_room(work.faces.len())?;
        self.source = with_room(work.faces.len())?;
        for face in &work.faces {
            self.faces.push(face.oriented().map(|v| name[v as usize]));
            self.source.push(face.source);
        }
        Ok(())
    }

    /// The pairs of sources of which parts cross, or touch other than in vertices and edges, by the exact
    /// test, and with themselves those that could not be cut.
    fn left(
        &self,
        points: &[Point3],
        narrow: &[u32],
        workers: usize,
        watch: &Watch,
    ) -> Result<Vec<[u32; 2]>> {
        let mut all = copied(points)?;
        all.extend(&self.added);
        let mut faces = with_room(self.faces.len())?;
        faces.extend(self.faces.iter().map(|f| f.map(|v| v as i32)));
        let limits = Limits {
            limit: 1 << 16,
            workers,
        };
        let (_, pairs) = prepared(&all, &faces, limits, watch)?;
        let mut left: Vec<[u32; 2]> = with_room(pairs.first.len() + narrow.len())?;
        left.extend(pairs.first.iter().map(|pair| {
            let [f, g] = pair.faces.map(|face| self.source[face as usize]);
            [f.min(g), f.max(g)]
        }));
        left.extend(narrow.iter().map(|&row| [row; 2]));
        sort(&mut left, watch)?;
        left.dedup();
        Ok(left)
    }
}

/// The edges of triangles, and which are not passed equally often in both directions.
fn unbalanced(faces: &[Face], count: usize, watch: &Watch) -> Result<Vec<[u32; 2]>> {
    let mut oriented = with_room(faces.len())?;
    oriented.extend(faces.iter().map(Face::oriented));
    let all = SurfaceEdges::of(&oriented, count, watch)?;
    let mut found = all.faults(&oriented, &filled(faces.len(), 1)?, watch)?;
    found.unbalanced.append(&mut found.boundary);
    Ok(found.unbalanced)
}

/// Whether all edges are passed equally often in both directions.
fn is_closed(faces: &[Face], count: usize, watch: &Watch) -> Result<bool> {
    Ok(unbalanced(faces, count, watch)?.is_empty())
}

/// The sources of parts at edges that are not, each with itself.
fn loose(work: &Work, watch: &Watch) -> Result<Vec<[u32; 2]>> {
    let mut edges = unbalanced(&work.faces, work.at.len(), watch)?;
    sort(&mut edges, watch)?;
    let mut found = Vec::new();
    for face in &work.faces {
        let [a, b, c] = face.ids;
        if [[a, b], [b, c], [a, c]]
            .iter()
            .any(|e| edges.binary_search(e).is_ok())
        {
            push(&mut found, [face.source; 2])?;
        }
    }
    found.dedup();
    Ok(found)
}

/// The largest distance of a vertex of a part from its source.
fn distance(points: &[Point3], faces: &[[i32; 3]], work: &Work) -> f64 {
    let of = |face: &Face| {
        let source = faces[face.source as usize];
        let corners = source.map(|v| points[v as usize]);
        let distances = face.ids.map(|v| {
            let row = work.row[v as usize];
            if row != NONE && source.contains(&(row as i32)) {
                0.0
            } else {
                near::distance(work.at[v as usize], corners)
            }
        });
        distances.into_iter().fold(0.0, f64::max)
    };
    work.faces.iter().map(of).fold(0.0, f64::max)
}

/// The exponent of the smallest power of two above all coordinates.
fn exponent(points: &[Point3]) -> i32 {
    let Extent { min, max } = Extent::of(points.iter().copied());
    let most = min
        .into_iter()
        .chain(max)
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    if most == 0.0 || !most.is_finite() {
        return 0;
    }
    // The logarithm may be one off at powers of two, which does no harm.
    (most.log2().floor() as i32 + 1).clamp(-1022, 1024)
}
