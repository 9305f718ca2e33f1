//! Contour lines: for each level lines from outline to outline, and rings.

use std::ops::Range;

use delone_predicates::lexicographic;

use super::edges::{Edges, Local};
use super::link::{Edge, link, rotate};
use super::nodes::{Crossed, Nodes};
use super::untangle::untangle;
use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::{make_room, push, with_room, zeroed};
use crate::base::parallel::map_watched;
use crate::base::watch::Watch;
use delone_predicates::Point2;

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
    (workers, watch): (usize, &Watch),
) -> Result<Lines> {
    let threads = (workers, watch);
    let mut nodes = Nodes::new(given, heights, (levels, collapsed), limit, threads)?;
    let tangled = untangle(&mut nodes, far, threads)?;
    if !tangled.is_empty() {
        return Ok(Lines {
            tangled,
            ..Lines::default()
        });
    }
    let edges = Edges::collect(&nodes, levels.len(), threads, |t, chord| {
        if let Some(crossed) = nodes.crossed(t) {
            each_chord(&nodes, &crossed, |level, from, to| {
                let owner = t as u32;
                chord(level, Edge { from, to, owner });
            });
        }
    })?;
    let linked = map_watched(
        workers,
        (0..levels.len() as u32).collect(),
        watch,
        |level| Linked::of(&nodes, edges.group(level)?),
    )?;
    drop(edges);
    joined(&nodes, &linked, threads)
}

/// Calls `chord` with the level and both ends of each contour of a triangle that has a length, higher
/// ground to its left.
pub fn each_chord(nodes: &Nodes, crossed: &Crossed, mut chord: impl FnMut(u32, u32, u32)) {
    for level in crossed.ranks[0]..crossed.ranks[2] {
        let [left, right] = crossed.chord(level).map(|place| nodes.find(place));
        if left != right {
            let (from, to) = if crossed.even {
                (left, right)
            } else {
                (right, left)
            };
            chord(level, from, to);
        }
    }
}

/// The lines of a level, in their order.
struct Linked {
    places: Vec<u32>,
    /// The end of each line in the places.
    ends: Vec<u32>,
}

impl Linked {
    fn of(nodes: &Nodes, mut edges: Vec<Edge>) -> Result<Self> {
        let local = Local::of(nodes, &mut edges)?;
        let mut runs: Vec<Range<usize>> = Vec::new();
        let mut numbers = Vec::new();
        link(&local.at, &edges, |line, _| {
            let start = numbers.len();
            make_room(&mut numbers, line.len())?;
            numbers.extend_from_slice(line);
            if line.first() == line.last() {
                rotate(&local.at, &mut numbers[start..]);
            }
            push(&mut runs, start..numbers.len())
        })?;
        drop(edges);
        let at = |place: usize| local.at[numbers[place] as usize];
        runs.sort_by(|a, b| {
            lexicographic(at(a.start), at(b.start))
                .then_with(|| lexicographic(at(a.start + 1), at(b.start + 1)))
        });
        let (mut places, mut ends) = (with_room(numbers.len())?, with_room(runs.len())?);
        for run in runs {
            places.extend(
                numbers[run]
                    .iter()
                    .map(|&number| local.places[number as usize]),
            );
            ends.push(places.len() as u32);
        }
        Ok(Self { places, ends })
    }
}

/// The lines of all levels.
fn joined(nodes: &Nodes, linked: &[Linked], (workers, watch): (usize, &Watch)) -> Result<Lines> {
    let count = |of: fn(&Linked) -> usize| linked.iter().map(of).sum::<usize>();
    let mut points = zeroed(count(|level| level.places.len()))?;
    let lines = count(|level| level.ends.len());
    let (mut starts, mut levels) = (with_room(lines + 1)?, with_room(lines)?);
    starts.push(0);
    let mut tasks = with_room(linked.len())?;
    let (mut rest, mut start) = (&mut points[..], 0);
    for (number, level) in linked.iter().enumerate() {
        starts.extend(level.ends.iter().map(|&end| start + i64::from(end)));
        levels.resize(starts.len() - 1, number as i32);
        start += level.places.len() as i64;
        let (own, after) = rest.split_at_mut(level.places.len());
        rest = after;
        tasks.push((own, level));
    }
    map_watched(workers, tasks, watch, |(points, level)| {
        for (point, &place) in points.iter_mut().zip(&level.places) {
            *point = nodes.at(place);
        }
        Ok(())
    })?;
    Ok(Lines {
        tangled: Vec::new(),
        points,
        starts,
        levels,
    })
}
