//! Clips cells, including unbounded ones, to a box.
//!
//! Each cell is convex and is clipped by the four half-planes of the box one after the other (I. E.
//! Sutherland and G. W. Hodgman, "Reentrant polygon clipping", 1974). An unbounded cell has corners
//! at infinity, each given by its direction, and edges at infinity, which turn by at most a
//! quadrant. So no artificial far corner is needed, and half-planes, strips and the whole plane are
//! clipped like any other cell. A vertex out of range has infinite coordinates, which compare
//! correctly and are never on a side of the box.
//!
//! Where a ridge crosses a side of the box is computed from the bisector of its two sites, not from
//! its ends, which may be far away; the result is clamped to the interval between the ends. It
//! depends on the ridge and its ends only, so both cells of the ridge get the same doubles. Corners
//! on a side have its coordinate exactly. Hence the signed areas of all cells, evaluated exactly,
//! sum to that of the box: common edges cancel, and the rest is the boundary of the box, once.

use delone_predicates::Point2;

use super::axis::{crossing, foot};
use crate::base::error::{Error, Result};
use crate::base::memory::{push, with_room};
use crate::base::parallel;
use crate::base::vector::dot;
use crate::base::watch::Watch;

/// Cells per task.
const SHARE: usize = 1 << 12;
/// Directions of the axes, counterclockwise.
const AXES: [Point2; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

/// A diagram as arrays.
#[derive(Clone, Copy)]
pub struct Cells<'a> {
    /// Coordinates of sites.
    pub points: &'a [Point2],
    /// Their weights; empty for none.
    pub weights: &'a [f64],
    /// Vertices of the diagram.
    pub vertices: &'a [Point2],
    /// The two sites of each ridge.
    pub sites: &'a [[i32; 2]],
    /// The two ends of each ridge: a vertex or !i for ray i.
    pub ends: &'a [[i32; 2]],
    /// Directions of rays.
    pub rays: &'a [Point2],
    /// The out-of-range vertices to which they lead, NaN for none.
    pub beyond: &'a [Point2],
    /// The site of each cell.
    pub site: &'a [i32],
    /// Where the entries of each cell begin, plus the end.
    pub starts: &'a [i32],
    /// Entry: a vertex, or -1 for a ray at that end.
    pub entry_vertices: &'a [i32],
    /// Entry: the ridge that follows the vertex.
    pub entry_ridges: &'a [i32],
}

/// Convex polygons, counterclockwise.
#[derive(Debug, Default)]
pub struct Polygons {
    /// The corners of polygon i are `starts[i]..starts[i + 1]`.
    pub starts: Vec<i32>,
    /// Corners.
    pub points: Vec<Point2>,
    /// Corner: the ridge along which the edge to the next corner lies, -1 along the box.
    pub ridges: Vec<i32>,
}

impl Polygons {
    /// Adds a corner to the last polygon.
    fn add(&mut self, corner: Point2, ridge: i32) -> Result<()> {
        push(&mut self.points, corner)?;
        push(&mut self.ridges, ridge)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    At(Point2),
    /// At infinity, in this direction.
    Toward(Point2),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Edge {
    Ridge(i32),
    /// On the line where the coordinate on this axis has this value.
    Side(usize, f64),
    Infinity,
}

type Corner = (End, Edge);

/// The half-plane in which the coordinate on `axis` is at least `value`, or at most if `most` is
/// set.
#[derive(Clone, Copy)]
struct Half {
    axis: usize,
    value: f64,
    most: bool,
}

/// Clips all cells to the box from `min` to `max`, which has a positive area. Empty cells have no
/// corners.
pub fn clip(
    cells: Cells,
    min: Point2,
    max: Point2,
    workers: usize,
    watch: &Watch,
) -> Result<Polygons> {
    let mut rows = with_room(cells.site.len())?;
    rows.extend(0..cells.site.len());
    let parts = parallel::map(workers, rows.chunks(SHARE).collect(), |rows| {
        watch.check()?;
        part(cells, min, max, rows)
    });
    let parts = parts.into_iter().collect::<Result<Vec<_>>>()?;
    let total = parts.iter().map(|p| p.points.len()).sum();
    let mut out = Polygons {
        starts: with_room(rows.len() + 1)?,
        points: with_room(total)?,
        ridges: with_room(total)?,
    };
    out.starts.push(0);
    for part in parts {
        let before = out.points.len() as i32;
        out.starts
            .extend(part.starts.iter().map(|end| before + end));
        out.points.extend_from_slice(&part.points);
        out.ridges.extend_from_slice(&part.ridges);
    }
    Ok(out)
}

fn part(cells: Cells, min: Point2, max: Point2, rows: &[usize]) -> Result<Polygons> {
    let mut out = Polygons::default();
    let (mut corners, mut cut) = (Vec::new(), Vec::new());
    for &row in rows {
        if !cells.inside(row, min, max, &mut out)? {
            cells.corners(row, &mut corners)?;
            for (axis, value, most) in [
                (0, min[0], false),
                (0, max[0], true),
                (1, min[1], false),
                (1, max[1], true),
            ] {
                let half = Half { axis, value, most };
                cells.cut(&corners, half, &mut cut);
                std::mem::swap(&mut corners, &mut cut);
            }
            add_clipped(&mut corners, &mut out)?;
        }
        push(&mut out.starts, out.points.len() as i32)?;
    }
    Ok(out)
}

/// Adds the clipped cell without repeated corners, or nothing if it has no area.
fn add_clipped(corners: &mut Vec<Corner>, out: &mut Polygons) -> Result<()> {
    // The point that represented a whole line is not a corner.
    let mut before = corners.last().map(|c| c.1);
    corners.retain(|&(_, edge)| {
        let along = matches!(edge, Edge::Ridge(_)) && before == Some(edge);
        before = Some(edge);
        !along
    });
    let at = |(end, _): &Corner| match end {
        End::At(p) => *p,
        End::Toward(d) => *d, // The box is bounded, so none is left.
    };
    let Some(first) = corners.first().map(at) else {
        return Ok(());
    };
    let flat = |k: usize| corners.iter().all(|c| at(c)[k] == first[k]);
    if flat(0) || flat(1) {
        return Ok(());
    }
    for (i, corner) in corners.iter().enumerate() {
        let (p, next) = (at(corner), at(&corners[(i + 1) % corners.len()]));
        if p != next {
            let ridge = match corner.1 {
                Edge::Ridge(r) => r,
                _ => -1,
            };
            out.add(p, ridge)?;
        }
    }
    Ok(())
}

impl Cells<'_> {
    fn entries(&self, row: usize) -> Result<(&[i32], &[i32])> {
        let range = self.starts[row] as usize..self.starts[row + 1] as usize;
        let found = self.entry_vertices.get(range.clone());
        found
            .zip(self.entry_ridges.get(range))
            .ok_or_else(|| Error::Shape(format!("the entries of cell {row} are out of range")))
    }

    /// Adds the cell unchanged if it lies in the box.
    fn inside(&self, row: usize, min: Point2, max: Point2, out: &mut Polygons) -> Result<bool> {
        let (vertices, ridges) = self.entries(row)?;
        let within = |p: Point2| (0..2).all(|k| min[k] <= p[k] && p[k] <= max[k]);
        if vertices.is_empty()
            || !vertices
                .iter()
                .all(|&v| v >= 0 && within(self.vertices[v as usize]))
        {
            return Ok(false);
        }
        for (i, (&v, &ridge)) in vertices.iter().zip(ridges).enumerate() {
            let (p, next) = (v, vertices[(i + 1) % vertices.len()]);
            let p = self.vertices[p as usize];
            if p != self.vertices[next as usize] {
                out.add(p, ridge)?;
            }
        }
        Ok(true)
    }

    /// The corners of a cell, counterclockwise, those at infinity included.
    fn corners(&self, row: usize, corners: &mut Vec<Corner>) -> Result<()> {
        corners.clear();
        let (vertices, ridges) = self.entries(row)?;
        if vertices.is_empty() {
            corners.extend(AXES.map(|axis| (End::Toward(axis), Edge::Infinity)));
        }
        for (i, (&v, &ridge)) in vertices.iter().zip(ridges).enumerate() {
            if v >= 0 {
                corners.push((End::At(self.vertices[v as usize]), Edge::Ridge(ridge)));
                continue;
            }
            if let Some(place) = self.beyond(row, ridge)? {
                corners.push((End::At(place), Edge::Ridge(ridge)));
                continue;
            }
            let before = ridges[(i + ridges.len() - 1) % ridges.len()];
            let out = self.ray(row, before, 1)?;
            let back = self.ray(row, ridge, 0)?;
            corners.push((End::Toward(out), Edge::Infinity));
            let between = axes_between(out, back);
            corners.extend(between.map(|axis| (End::Toward(axis), Edge::Infinity)));
            corners.push((End::Toward(back), Edge::Ridge(ridge)));
            if self.is_line(ridge) {
                // A whole line. One of its points tells on which side of a parallel line it
                // runs; if that point is out of range, only for lines along an axis.
                let (at, along) = (self.foot(ridge), back.contains(&0.0));
                if along || at.iter().all(|x| x.is_finite()) {
                    corners.push((End::At(at), Edge::Ridge(ridge)));
                }
            }
        }
        Ok(())
    }

    /// The point where the bisector of a ridge meets the line through its sites; infinite if out of
    /// range.
    fn foot(&self, ridge: i32) -> Point2 {
        foot(self.sites[ridge as usize].map(|v| self.weighted(v)))
    }

    fn weighted(&self, v: i32) -> (Point2, f64) {
        let weight = self.weights.get(v as usize).copied();
        (self.points[v as usize], weight.unwrap_or(0.0))
    }

    fn end(&self, row: usize, ridge: i32, which: usize) -> i32 {
        let turned = usize::from(self.sites[ridge as usize][0] != self.site[row]);
        self.ends[ridge as usize][which ^ turned]
    }

    /// The direction of the ray with which a ridge begins (0) or ends (1), as seen from a cell.
    fn ray(&self, row: usize, ridge: i32, which: usize) -> Result<Point2> {
        let ray = self.rays.get(!self.end(row, ridge, which) as usize);
        ray.copied()
            .ok_or_else(|| Error::Shape(format!("ridge {ridge} has no ray at its end")))
    }

    /// The out-of-range vertex with which a ridge begins, as seen from a cell.
    fn beyond(&self, row: usize, ridge: i32) -> Result<Option<Point2>> {
        let ray = self.end(row, ridge, 0);
        let place = self.beyond.get(!ray as usize);
        let place = place
            .copied()
            .ok_or_else(|| Error::Shape(format!("ridge {ridge} has no ray at its end")))?;
        Ok((!place[0].is_nan()).then_some(place))
    }

    /// Whether a ridge is a whole line.
    fn is_line(&self, ridge: i32) -> bool {
        let far = |end: i32| self.beyond.get(!end as usize);
        let ends = self.ends[ridge as usize];
        ends.iter()
            .all(|&end| end < 0 && far(end).is_some_and(|place| place[0].is_nan()))
    }

    /// Clips a convex polygon by a half-plane.
    fn cut(&self, corners: &[Corner], half: Half, out: &mut Vec<Corner>) {
        out.clear();
        for (i, &(end, edge)) in corners.iter().enumerate() {
            let next = corners[(i + 1) % corners.len()].0;
            let (here, there) = (half.side(end), half.side(next));
            let side = Edge::Side(half.axis, half.value);
            if here >= 0 {
                out.push((end, if here == 0 && there < 0 { side } else { edge }));
            }
            if here > 0 && there < 0 {
                out.push((self.crossing(end, next, edge, half, true), side));
            } else if here < 0 && there > 0 {
                out.push((self.crossing(end, next, edge, half, false), edge));
            }
        }
    }

    /// The point where an edge crosses the line of a half-plane.
    fn crossing(&self, from: End, to: End, edge: Edge, half: Half, leaves: bool) -> End {
        let other = 1 - half.axis;
        match edge {
            Edge::Infinity => End::Toward(half.along(leaves)),
            Edge::Side(_, value) => half.at(value),
            Edge::Ridge(ridge) => {
                let mut found = self.bisector(ridge, half);
                let (low, high) = (bound(from, to, other), bound(to, from, other));
                let (low, high) = if low < high { (low, high) } else { (high, low) };
                if found.is_nan() {
                    found = if low.is_finite() { low } else { high };
                }
                if found < low {
                    found = low;
                }
                if found > high {
                    found = high;
                }
                half.at(found)
            }
        }
    }

    /// The other coordinate of the point where the bisector of a ridge meets the line of a
    /// half-plane.
    fn bisector(&self, ridge: i32, half: Half) -> f64 {
        let sites = self.sites[ridge as usize].map(|v| self.weighted(v));
        crossing(sites, half.axis, half.value)
    }
}

impl Half {
    /// Positive inside, negative outside, zero on the line.
    fn side(&self, end: End) -> i8 {
        let (x, value) = match end {
            End::At(p) => (p[self.axis], self.value),
            End::Toward(d) => (d[self.axis], 0.0),
        };
        let above = i8::from(x > value) - i8::from(x < value);
        if self.most { -above } else { above }
    }

    /// The point on the line with this other coordinate.
    fn at(&self, other: f64) -> End {
        let mut p = [other; 2];
        p[self.axis] = self.value;
        End::At(p)
    }

    /// The direction, along the line, at which a counterclockwise turn leaves the half-plane or
    /// enters it again.
    fn along(&self, leaves: bool) -> Point2 {
        // A quarter turn from the inner normal, in either direction.
        let inward = if self.most { -1.0 } else { 1.0 };
        let turn = if leaves { inward } else { -inward };
        if self.axis == 0 {
            [0.0, turn]
        } else {
            [-turn, 0.0]
        }
    }
}

/// The bound on coordinate `k` of an edge at its end `end`.
fn bound(end: End, beyond: End, k: usize) -> f64 {
    match (end, beyond) {
        (End::At(p), _) => p[k],
        (End::Toward(d), _) if d[k] > 0.0 => f64::INFINITY,
        (End::Toward(d), _) if d[k] < 0.0 => f64::NEG_INFINITY,
        (_, End::At(p)) => p[k],
        // Both ends are along the other axis: this one has no bound.
        (_, End::Toward(_)) => f64::NAN,
    }
}

/// The axes strictly between two directions, counterclockwise, that are at most half a turn apart.
fn axes_between(from: Point2, to: Point2) -> impl Iterator<Item = Point2> {
    // Sector i is from axis i, included, to the next.
    let sector = |d: Point2| match d {
        [x, y] if x > 0.0 && y >= 0.0 => 0,
        [x, y] if x <= 0.0 && y > 0.0 => 1,
        [x, y] if x < 0.0 && y <= 0.0 => 2,
        _ => 3,
    };
    let (first, last) = (sector(from), sector(to));
    let cross = from[0] * to[1] - from[1] * to[0];
    let mut steps = (last + 4 - first) % 4;
    if dot(from, to) > 0.0 && cross <= 0.0 {
        steps = 0; // Parallel, up to rounding.
    } else if steps > 0 && (to[0] == 0.0 || to[1] == 0.0) {
        steps -= 1;
    }
    (1..=steps).map(move |i| AXES[(first + i) % 4])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane<'a>(points: &'a [Point2], site: &'a [i32], starts: &'a [i32]) -> Cells<'a> {
        Cells {
            points,
            weights: &[],
            vertices: &[],
            sites: &[],
            ends: &[],
            rays: &[],
            beyond: &[],
            site,
            starts,
            entry_vertices: &[],
            entry_ridges: &[],
        }
    }

    #[test]
    fn one_site_has_the_whole_box() {
        let cells = plane(&[[5.0, 5.0]], &[0], &[0, 0]);
        let found = clip(cells, [0.0, 0.0], [2.0, 1.0], 1, &Watch::idle()).unwrap();
        let mut corners = found.points.clone();
        corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(corners, [[0.0, 0.0], [0.0, 1.0], [2.0, 0.0], [2.0, 1.0]]);
        assert_eq!(found.ridges, [-1; 4]);
    }

    #[test]
    fn two_sites_share_the_box() {
        let cells = Cells {
            sites: &[[0, 1]],
            ends: &[[!0, !1]],
            rays: &[[0.0, -1.0], [0.0, 1.0]],
            beyond: &[[f64::NAN; 2]; 2],
            entry_vertices: &[-1, -1],
            entry_ridges: &[0, 0],
            ..plane(&[[0.0, 0.0], [1.0, 0.0]], &[0, 1], &[0, 1, 2])
        };
        let found = clip(cells, [-1.0, -1.0], [4.0, 1.0], 1, &Watch::idle()).unwrap();
        assert_eq!(found.starts, [0, 4, 8]);
        assert_eq!(
            clip(cells, [-1.0, -1.0], [0.0, 1.0], 1, &Watch::idle())
                .unwrap()
                .starts,
            [0, 4, 4]
        );
        assert_eq!(
            clip(cells, [1.0, -1.0], [2.0, 1.0], 1, &Watch::idle())
                .unwrap()
                .starts,
            [0, 0, 4]
        );
        let left = |p: &Point2| p[0] <= 0.5;
        assert!(found.points[..4].iter().all(left));
        assert!(found.points[4..].iter().all(|p| p[0] >= 0.5));
    }

    #[test]
    fn axes_are_counted_counterclockwise() {
        let count = |from, to| axes_between(from, to).count();
        assert_eq!(count([1.0, 0.0], [0.0, 1.0]), 0);
        assert_eq!(count([1.0, 0.0], [-1.0, 0.0]), 1);
        assert_eq!(count([1.0, -0.5], [-1.0, 0.5]), 2);
        assert_eq!(count([1.0, 0.5], [1.0, 0.5]), 0);
        assert_eq!(count([1.0, 0.5], [1.0, 0.4999]), 0);
    }
}
