//! Which polygons contain each component of triangles between segments, by the even-odd rule.
//!
//! Crossing an odd number of a polygon's sides switches between its inside and its outside. So one
//! traversal of the components finds the polygons that contain each of them, without coordinates:
//! crossings and overlaps of rings are subsegments by then, and rings that rounding has bent are
//! still closed. The sides of each polygon must form closed rings: then all paths agree.

use crate::base::error::{Error, Result};
use crate::base::joins::{Facets, ascending};
use crate::base::memory::{copied, filled, make_room, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::order;

/// Items between two checks for interruption.
const LOT: usize = 1 << 14;

/// Triangles, and the components between segments. What no triangle covers is one component more.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// Their corners.
    pub simplices: &'a [[i32; 3]],
    /// The triangle opposite each corner, -1 if there is none.
    pub neighbors: &'a [[i32; 3]],
    /// Whether the edge opposite each corner is a subsegment.
    pub walls: &'a [[bool; 3]],
    /// The component of each, at least 0.
    pub component: &'a [i32],
}

/// What covers subsegments.
#[derive(Debug, Clone, Copy)]
pub struct Covers<'a> {
    /// The start of each subsegment in `source`, and the end.
    pub starts: &'a [i64],
    /// The rows of segments that cover it.
    pub source: &'a [i32],
    /// The polygon of each row, -1 if it is a side of none.
    pub polygons: &'a [i32],
}

impl Parts<'_> {
    /// The number of components that have triangles.
    fn count(&self) -> usize {
        self.component.iter().max().map_or(0, |&c| c as usize + 1)
    }

    /// The components to the left and right of each subsegment.
    pub fn beside(&self, segments: &[[i32; 2]], watch: &Watch) -> Result<Vec<[i32; 2]>> {
        let known = Facets::of(segments.iter().map(|&ends| ascending(ends)), watch)?;
        let mut found = filled(segments.len(), [self.count() as i32; 2])?;
        let mut pace = Pace::new(watch, LOT);
        for (t, corners) in self.simplices.iter().enumerate() {
            pace.spend(1)?;
            for k in (0..3).filter(|&k| self.walls[t][k]) {
                let [tail, head] = [1, 2].map(|i| corners[(k + i) % 3]);
                let row = known.row(ascending([tail, head])).ok_or_else(|| {
                    Error::Shape(format!("the edge {tail} {head} is not a subsegment"))
                })?;
                let side = usize::from(segments[row as usize][0] != tail);
                found[row as usize][side] = self.component[t];
            }
        }
        Ok(found)
    }

    /// Pairs of a component and a polygon that contains it, ascending. The component `first` is in
    /// none; what no triangle covers has the number of components.
    pub fn containing(
        &self,
        segments: &[[i32; 2]],
        covers: Covers,
        first: usize,
        watch: &Watch,
    ) -> Result<Vec<[i32; 2]>> {
        let count = self.count();
        let beside = self.beside(segments, watch)?;
        let odd = odd_pairs(covers, watch)?;
        let mut starts = filled(segments.len() + 1, 0)?;
        for pair in &odd {
            starts[pair[0] as usize + 1] += 1;
        }
        for s in 1..starts.len() {
            starts[s] += starts[s - 1];
        }
        let steps = self.steps(&beside, count)?;
        // The polygons of each component that is reached, ascending, are a part of `inside`.
        let mut inside: Vec<i32> = Vec::new();
        let mut part = filled(count + 1, None)?;
        let mut queue = with_room(count + 1)?;
        let mut pace = Pace::new(watch, LOT);
        // Each component enters the queue once.
        for start in std::iter::once(first.min(count)).chain(0..=count) {
            if part[start].is_some() {
                continue;
            }
            part[start] = Some((0, 0));
            queue.push(start);
            while let Some(here) = queue.pop() {
                let (from, to) = part[here].unwrap_or((0, 0));
                for &(there, s) in steps.of(here) {
                    pace.spend(1)?;
                    if part[there as usize].is_some() {
                        continue;
                    }
                    let crossed = match s {
                        NONE => &[],
                        s => &odd[starts[s as usize]..starts[s as usize + 1]],
                    };
                    let begin = inside.len();
                    make_room(&mut inside, to - from + crossed.len())?;
                    toggle(&mut inside, from..to, crossed);
                    pace.spend(inside.len() - begin)?;
                    part[there as usize] = Some((begin, inside.len()));
                    queue.push(there as usize);
                }
            }
        }
        let mut pairs = Vec::new();
        for (c, part) in (0..).zip(&part) {
            let (from, to) = part.unwrap_or((0, 0));
            for &polygon in &inside[from..to] {
                push(&mut pairs, [c, polygon])?;
            }
        }
        Ok(pairs)
    }

    /// The steps between components.
    fn steps(&self, beside: &[[i32; 2]], count: usize) -> Result<Steps> {
        let mut open = filled(count, false)?;
        for ((across, walls), &c) in self.neighbors.iter().zip(self.walls).zip(self.component) {
            open[c as usize] |= (0..3).any(|k| across[k] < 0 && !walls[k]);
        }
        let walls = (0..)
            .zip(beside)
            .map(|(s, &[a, b])| [a as u32, b as u32, s]);
        let rim = (0..).zip(&open).filter(|(_, open)| **open);
        let rim = rim.map(|(c, _)| [c, count as u32, NONE]);
        let each = walls.filter(|[a, b, _]| a != b).chain(rim);
        let mut starts = filled(count + 3, 0)?;
        for [a, b, _] in each.clone() {
            starts[a as usize + 2] += 1;
            starts[b as usize + 2] += 1;
        }
        for c in 2..starts.len() {
            starts[c] += starts[c - 1];
        }
        let mut to = filled(starts[count + 2], (0, NONE))?;
        for [a, b, s] in each {
            for (here, there) in [(a, b), (b, a)] {
                let at = &mut starts[here as usize + 1];
                to[*at] = (there, s);
                *at += 1;
            }
        }
        Ok(Steps { starts, to })
    }
}

/// No subsegment: an edge of the hull that is open.
const NONE: u32 = u32::MAX;

/// The steps from each component to others, with the subsegment between.
struct Steps {
    starts: Vec<usize>,
    to: Vec<(u32, u32)>,
}

impl Steps {
    fn of(&self, component: usize) -> &[(u32, u32)] {
        &self.to[self.starts[component]..self.starts[component + 1]]
    }
}

/// Appends what is either in a range of `inside` or among the polygons of `crossed`; ascending.
fn toggle(inside: &mut Vec<i32>, range: std::ops::Range<usize>, crossed: &[[i32; 2]]) {
    let mut crossed = crossed.iter().map(|pair| pair[1]).peekable();
    for i in range {
        let own = inside[i];
        while let Some(polygon) = crossed.next_if(|&polygon| polygon < own) {
            inside.push(polygon);
        }
        if crossed.next_if_eq(&own).is_none() {
            inside.push(own);
        }
    }
    inside.extend(crossed);
}

/// The first polygon of each component, or -1, of the pairs of a component and a polygon, ascending.
pub fn first_of(pairs: &[[i32; 2]], components: usize) -> Result<Vec<i32>> {
    let mut first = filled(components, -1)?;
    for &[component, polygon] in pairs.iter().rev() {
        first[component as usize] = polygon;
    }
    Ok(first)
}

/// The polygon of each segment, or -1, without the polygons of which an odd number of sides meet at
/// some vertex: there a side is missing, and the polygon has no inside.
pub fn closed(ends: &[[i32; 2]], polygons: &[i32], watch: &Watch) -> Result<Vec<i32>> {
    let sides = ends
        .iter()
        .zip(polygons)
        .filter(|(_, polygon)| **polygon >= 0);
    let mut meetings = with_room(2 * ends.len())?;
    meetings.extend(sides.flat_map(|(ends, &polygon)| ends.map(|v| (polygon, v))));
    order::sort_by(&mut meetings, watch, Ord::cmp)?;
    let mut open = Vec::new();
    for run in meetings.chunk_by(|a, b| a == b) {
        if run.len() % 2 == 1 {
            push(&mut open, run[0].0)?;
        }
    }
    let mut found = copied(polygons)?;
    for polygon in &mut found {
        if open.binary_search(polygon).is_ok() {
            *polygon = -1;
        }
    }
    Ok(found)
}

/// Pairs of a subsegment and a polygon of which an odd number of sides cover it, ascending.
pub fn odd_pairs(covers: Covers, watch: &Watch) -> Result<Vec<[i32; 2]>> {
    let mut found = with_room(covers.source.len())?;
    let mut polygons = Vec::new();
    let mut pace = Pace::new(watch, LOT);
    for (s, ends) in (0..).zip(covers.starts.windows(2)) {
        let rows = &covers.source[ends[0] as usize..ends[1] as usize];
        pace.spend(rows.len())?;
        polygons.clear();
        make_room(&mut polygons, rows.len())?;
        polygons.extend(rows.iter().map(|&row| covers.polygons[row as usize]));
        polygons.sort_unstable();
        let runs = polygons.chunk_by(|a, b| a == b);
        let odd = runs.filter(|run| run[0] >= 0 && run.len() % 2 == 1);
        found.extend(odd.map(|run| [s, run[0]]));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two squares, of polygons 4 and 7, that share an edge covered by both.
    #[test]
    fn squares_side_by_side() {
        let simplices = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
        let neighbors = [[3, 1, -1], [-1, -1, 0], [-1, 3, -1], [-1, 0, 2]];
        let walls = [[true, false, true], [true, true, false]];
        let walls = [walls[0], walls[1], [true, false, true], [true, true, false]];
        let parts = Parts {
            simplices: &simplices,
            neighbors: &neighbors,
            walls: &walls,
            component: &[0, 0, 1, 1],
        };
        let segments = [[0, 1], [1, 4], [4, 3], [3, 0], [1, 2], [2, 5], [5, 4]];
        let covers = Covers {
            starts: &[0, 1, 3, 4, 5, 6, 7, 8],
            source: &[0, 1, 7, 2, 3, 4, 5, 6],
            polygons: &[4, 4, 4, 4, 7, 7, 7, 7],
        };
        let watch = Watch::idle();
        let beside = parts.beside(&segments, &watch).unwrap();
        assert_eq!(beside[..3], [[0, 2], [0, 1], [0, 2]]);
        let found = parts.containing(&segments, covers, 2, &watch).unwrap();
        assert_eq!(found, [[0, 4], [1, 7]]);
        let found = parts.containing(&segments, covers, 0, &watch).unwrap();
        assert_eq!(found, [[1, 4], [1, 7], [2, 4]]);
        assert_eq!(first_of(&found, 4).unwrap(), [-1, 4, 4, -1]);
    }

    /// A triangle, a path, a repeated side and a side of no polygon.
    #[test]
    fn polygons_with_a_missing_side_have_none() {
        let ends = [
            [0, 1],
            [1, 2],
            [2, 0],
            [3, 4],
            [5, 4],
            [6, 7],
            [7, 6],
            [8, 8],
            [0, 9],
        ];
        let polygons = [2, 2, 2, 0, 0, 5, 5, 3, -1];
        let found = closed(&ends, &polygons, &Watch::idle()).unwrap();
        assert_eq!(found, [2, 2, 2, -1, -1, 5, 5, 3, -1]);
    }
}
