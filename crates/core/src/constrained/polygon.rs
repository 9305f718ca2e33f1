//! The triangles inside rings, whatever the rings are: crossings become vertices, and the winding
//! number of each triangle says whether it is inside.
//!
//! The winding number is 0 outside of the hull and changes
//! by one at each edge of a ring, so a flood over the triangles finds it: linear after the
//! triangulation.

use delone_predicates::Point2;

use super::edges::{Edges, edge};
use super::marked::Marked;
use super::{Options, Work};
use crate::delaunay2::{Clock, Method};
use crate::error::{Error, Result};
use crate::memory::{filled, push, with_room};
use crate::mesh2::{next, prev, triangle};
use crate::points::LIMIT2;
use crate::watch::Watch;

/// Which places are inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Those that the rings wind round an odd number of times.
    EvenOdd,
    /// Those that the rings wind round at all, all turns counted with their sign.
    NonZero,
}

/// Triangles inside rings.
#[derive(Debug, Default)]
pub struct Filled {
    /// Vertices that the rings do not have: their crossings.
    pub added: Vec<Point2>,
    /// Triangles as rows of the points of the rings, added vertices behind them.
    pub simplices: Vec<[i32; 3]>,
}

/// Not yet met by the flood.
const UNKNOWN: u32 = u32::MAX;

/// The triangles inside the rings `points[starts[i]..starts[i + 1]]`, each of which closes itself.
/// Rings without area have none.
pub fn polygon(points: &[Point2], starts: &[usize], rule: Rule, watch: &Watch) -> Result<Filled> {
    let mut segments = with_room(points.len())?;
    for ring in starts.windows(2) {
        let rows = ring[0] as u32..ring[1] as u32;
        let after = rows.clone().skip(1).chain(rows.clone().take(1));
        segments.extend(rows.zip(after).map(|(a, b)| [a, b]));
    }
    let options = Options {
        split: true,
        conforming: false,
        max_vertices: LIMIT2.saturating_sub(points.len()),
        method: Method::Auto,
        workers: 1,
    };
    let work = Work::start(points, &segments, options, watch, &mut Clock::start());
    let mut work = match work {
        Err(Error::TooFew { .. } | Error::Collinear { .. }) => return Ok(Filled::default()),
        work => work?,
    };
    let laid = work.lay(points, watch)?;
    let parts = flood(&mut work.marked, &laid.pieces)?;
    let added = work.added(points.len());
    let rows = &work.rows;
    let inside = |w: &i32| match rule {
        Rule::EvenOdd => w % 2 != 0,
        Rule::NonZero => *w != 0,
    };
    let inside: Vec<bool> = parts.winding.iter().map(inside).collect();
    let mesh = work.marked.patch();
    let mut simplices = with_room(parts.of.len())?;
    for (t, _) in (0..)
        .zip(&parts.of)
        .filter(|(_, part)| inside[**part as usize])
    {
        simplices.push(mesh.corners(t).map(|v| rows[v as usize] as i32));
    }
    Ok(Filled { added, simplices })
}

/// Parts of the plane that the pieces separate.
struct Parts {
    /// For each triangle the part that it lies in; ghosts lie in the first.
    of: Vec<u32>,
    /// The winding number of each part.
    winding: Vec<i32>,
}

/// The parts of the plane: a flood within each, which leaves it through a piece when it is full. So
/// only as many pieces as there are parts are looked up.
fn flood(marked: &mut Marked, pieces: &[([u32; 2], u32)]) -> Result<Parts> {
    let used = marked.triangles();
    let vertices = marked.count;
    let mesh = marked.patch();
    let mut of = filled(used as usize, UNKNOWN)?;
    let inf = mesh.infinite();
    let ghost = (0..used).find(|&t| mesh.corners(t).contains(&inf));
    let mut stack = Vec::new();
    stack.extend(ghost);
    // Pieces, by the code on the side that was met, and the part there.
    let (mut doors, mut entries) = (Vec::new(), Vec::new());
    let mut part = 0;
    for &t in &stack {
        of[t as usize] = part;
    }
    loop {
        while let Some(t) = stack.pop() {
            for e in 8 * t..8 * t + 3 {
                let there = triangle(mesh.opposite(e));
                if of[there as usize] != UNKNOWN {
                    continue;
                }
                if mesh.is_marked(e) {
                    push(&mut doors, e)?;
                } else {
                    of[there as usize] = part;
                    push(&mut stack, there)?;
                }
            }
        }
        let beyond = |e: u32| triangle(mesh.opposite(e));
        while doors
            .pop_if(|e| of[beyond(*e) as usize] != UNKNOWN)
            .is_some()
        {}
        let Some(e) = doors.pop() else {
            break;
        };
        part += 1;
        of[beyond(e) as usize] = part;
        stack.push(beyond(e));
        let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
        push(&mut entries, (ends, of[triangle(e) as usize]))?;
    }
    let edges = Edges::of(entries.iter().map(|e| edge(e.0)).collect(), vertices)?;
    // What is on the left of an edge from its smaller end is wound round so much more often.
    let mut more = filled(edges.all.len(), 0)?;
    for &(ends, _) in pieces {
        if let Some(place) = edges.place(ends) {
            more[place] += if ends[0] < ends[1] { 1 } else { -1 };
        }
    }
    let mut winding = filled(1, 0)?;
    for (ends, from) in entries {
        let more = edges.place(ends).map_or(0, |place| more[place]);
        let more = if ends[0] < ends[1] { more } else { -more };
        winding.push(winding[from as usize] - more);
    }
    Ok(Parts { of, winding })
}
