//! Contour lines: for each level lines from outline to outline, and rings.

use delone_predicates::lexicographic;

use super::link::{Edge, Linker, first_of};
use super::nodes::Nodes;
use super::untangle::untangle;
use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::{filled, make_room, push, with_room};
use crate::base::watch::Watch;
use delone_predicates::Point2;

/// Triangles between two checks for interruption.
const WATCH_EVERY: usize = 1 << 14;

/// Lines as runs of coordinates.
#[derive(Debug, Default)]
pub struct Lines {
    /// Triangles in which contours would cross; if there are any, there is nothing else.
    pub tangled: Vec<i32>,
    /// Coordinates of all lines. A ring ends with its first point.
    pub points: Vec<Point2>,
    /// The start of each line in `points`, and the end of the last.
    pub starts: Vec<i64>,
    /// The level of each line, ascending.
    pub levels: Vec<i32>,
}

/// The contour lines of ascending `levels`, with higher ground to their left, in a canonical order:
/// rings start at their first point in lexicographic order, and the lines of a level are in the
/// order of their starts. For `collapsed` see `Nodes::new`, for `far` see
/// `untangle`.
pub fn lines(
    given: Triangles,
    heights: &[f64],
    (levels, collapsed): (&[f64], &[bool]),
    far: bool,
    limit: usize,
    watch: &Watch,
) -> Result<Lines> {
    let mut nodes = Nodes::new(given, heights, (levels, collapsed), limit, watch)?;
    let tangled = untangle(&mut nodes, far, watch)?;
    if !tangled.is_empty() {
        return Ok(Lines {
            tangled,
            ..Lines::default()
        });
    }
    let (starts, edges) = chords(&nodes, watch)?;
    let mut linker = Linker::new(nodes.len())?;
    let mut found = Lines::default();
    push(&mut found.starts, 0)?;
    for (level, range) in starts.windows(2).enumerate() {
        watch.check()?;
        let mut runs = Vec::new();
        let mut places = Vec::new();
        linker.link(&nodes, &edges[range[0]..range[1]], |line, _| {
            let start = places.len();
            make_room(&mut places, line.len())?;
            places.extend_from_slice(line);
            if line.first() == line.last() {
                let ring = &mut places[start..];
                rotate(&nodes, ring);
            }
            push(&mut runs, start..places.len())
        })?;
        runs.sort_by(|a, b| {
            let second = |run: &std::ops::Range<usize>| nodes.at(places[run.start + 1]);
            let first = |run: &std::ops::Range<usize>| nodes.at(places[run.start]);
            lexicographic(first(a), first(b)).then_with(|| lexicographic(second(a), second(b)))
        });
        make_room(&mut found.points, places.len())?;
        for run in runs {
            found
                .points
                .extend(places[run].iter().map(|&place| nodes.at(place)));
            push(&mut found.starts, found.points.len() as i64)?;
            push(&mut found.levels, level as i32)?;
        }
    }
    Ok(found)
}

/// Lets a ring start at its first place in lexicographic order.
pub fn rotate(nodes: &Nodes, ring: &mut [u32]) {
    let first = first_of(nodes, ring);
    let count = ring.len() - 1;
    ring[..count].rotate_left(first);
    ring[count] = ring[0];
}

/// The contours in all triangles, by level: the start of each level, and the edges.
fn chords(nodes: &Nodes, watch: &Watch) -> Result<(Vec<usize>, Vec<Edge>)> {
    let mut starts = filled(nodes.levels + 1, 0)?;
    each_chord(nodes, watch, |level, _| starts[level + 1] += 1)?;
    for level in 0..nodes.levels {
        starts[level + 1] += starts[level];
    }
    let mut edges = with_room(starts[nodes.levels])?;
    let none = Edge {
        from: 0,
        to: 0,
        owner: 0,
    };
    edges.resize(starts[nodes.levels], none);
    let mut next = starts.clone();
    each_chord(nodes, watch, |level, edge| {
        edges[next[level]] = edge;
        next[level] += 1;
    })?;
    Ok((starts, edges))
}

/// Calls `chord` with each contour in each triangle that has a length, higher ground to its left.
fn each_chord(nodes: &Nodes, watch: &Watch, mut chord: impl FnMut(usize, Edge)) -> Result<()> {
    for t in 0..nodes.triangles() {
        if t.is_multiple_of(WATCH_EVERY) {
            watch.check()?;
        }
        let crossed = nodes.crossed(t);
        for level in crossed.ranks[0]..crossed.ranks[2] {
            let [left, right] = nodes
                .chord(t, &crossed, level)
                .map(|place| nodes.find(place));
            if left != right {
                let (from, to) = if crossed.even {
                    (left, right)
                } else {
                    (right, left)
                };
                chord(
                    level as usize,
                    Edge {
                        from,
                        to,
                        owner: t as u32,
                    },
                );
            }
        }
    }
    Ok(())
}
