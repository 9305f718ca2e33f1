//! The triangles inside rings, whatever the rings are: crossings become vertices, and the winding
//! number of each triangle says whether it is inside.
//!
//! The winding number is 0 outside of the hull and changes by one at each edge of a ring, so a flood
//! over the triangles finds it: linear after the triangulation.

use delone_predicates::Point2;

use super::marked::Marked;
use super::{Options, Work};
use crate::delaunay2::{Clock, Method};
use crate::error::{Error, Result};
use crate::memory::{filled, with_room};
use crate::mesh2::triangle;
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
const UNKNOWN: i32 = i32::MIN;

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
    let winding = flood(&mut work.marked, &laid.pieces)?;
    let added = work.added(points.len());
    let rows = &work.rows;
    let inside = |w: i32| match rule {
        Rule::EvenOdd => w % 2 != 0,
        Rule::NonZero => w != 0,
    };
    let mesh = work.marked.patch();
    let mut simplices = with_room(winding.len())?;
    for (t, _) in (0..).zip(&winding).filter(|(_, w)| inside(**w)) {
        simplices.push(mesh.corners(t).map(|v| rows[v as usize] as i32));
    }
    Ok(Filled { added, simplices })
}

/// The winding number of each triangle; ghosts have 0.
fn flood(marked: &mut Marked, pieces: &[([u32; 2], u32)]) -> Result<Vec<i32>> {
    let used = marked.triangles();
    // What the number gains from the other side of an edge to this one.
    let mut gain = filled(4 * used as usize, 0i32)?;
    let at = |e: u32| 4 * triangle(e) as usize + (e & 3) as usize;
    for &([u, v], _) in pieces {
        let left = marked.edge(u, v)?;
        gain[at(left)] += 1;
        gain[at(marked.patch().opposite(left))] -= 1;
    }
    let mesh = marked.patch();
    let mut winding = filled(used as usize, UNKNOWN)?;
    let inf = mesh.infinite();
    let mut stack: Vec<u32> = (0..used)
        .filter(|&t| mesh.corners(t).contains(&inf))
        .collect();
    for &t in &stack {
        winding[t as usize] = 0;
    }
    while let Some(t) = stack.pop() {
        for e in 8 * t..8 * t + 3 {
            let o = mesh.opposite(e);
            let there = triangle(o) as usize;
            if winding[there] == UNKNOWN {
                winding[there] = winding[t as usize] + gain[at(o)];
                stack.push(triangle(o));
            }
        }
    }
    Ok(winding)
}
