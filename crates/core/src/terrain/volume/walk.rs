//! Walks from triangle to triangle of a surface, through those that share area with a triangle of
//! another surface.
//!
//! A walk starts at the center, and crosses each edge that enters the interior of the triangle:
//! otherwise a line along a side of one of the two separates them. Signs are exact. Each triangle
//! is visited once, so a walk ends.
//!
//! Why all are found: from the center to a point that both have inside, a straight line within the
//! triangle crosses edges which enter it, up to the boundary. If a walk reaches the boundary, or has
//! its center outside, it also starts at all boundary triangles nearby: beyond a hole the line comes
//! back across an edge of one of them. The center of a thin triangle may be rounded to outside it:
//! then walks start at a corner, and cross edges that only touch the triangle, too.

use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::locate::{Boxes, Kept, Located, Locator, Star, next, outer_sides, prev};
use delone_predicates::{Point2, Sign, orient2d};

use super::clip::{Line, WATCH_EVERY, relative};
use super::parts::center;

/// A bound of the rounding of [`Line::side`], relative to the largest coordinate of its line, times
/// that of the line plus that of its point. Coordinates relative to an origin have one rounding each;
/// differences of two have another one: at most four roundings of a coordinate. Products of
/// differences have 8 + 8 from both factors, and two of their own, twice; 64 are allowed for.
const SLACK: f64 = 32.0 * f64::EPSILON;
/// Where products of lengths neither overflow nor lose digits.
const SAFE: std::ops::Range<f64> = 1e-140..1e140;
/// Places in the table of visited triangles at the beginning, a power of two.
const PLACES: usize = 64;

/// A surface, made ready for walks.
pub struct Ground<'a> {
    given: Triangles<'a>,
    kept: Kept,
    /// The triangles with a side on the boundary, and the boxes of these.
    outer: Vec<u32>,
    boxes: Boxes<2>,
}

impl<'a> Ground<'a> {
    /// Sorts the triangles at the boundary.
    pub fn of(given: Triangles<'a>, watch: &Watch) -> Result<Self> {
        let sides = outer_sides(&given, watch)?;
        let mut outer: Vec<u32> = sides.iter().map(|side| side.simplex as u32).collect();
        outer.dedup();
        let box_of = |i: usize| Extent::of(given.corners(outer[i] as usize));
        let boxes = Boxes::over(outer.len(), box_of, watch)?;
        let kept = Kept::of(&given, watch)?;
        Ok(Self {
            given,
            kept,
            outer,
            boxes,
        })
    }
}

/// Walks, each for another triangle.
pub struct Walk<'a> {
    ground: &'a Ground<'a>,
    watch: &'a Watch<'a>,
    /// Where the last walk started, or left the surface.
    near: Option<usize>,
    star: Star<3>,
    /// The triangles found, in the order of the visits.
    found: Vec<u32>,
    visited: Visited,
}

impl<'a> Walk<'a> {
    /// Without a place to start.
    pub fn new(ground: &'a Ground<'a>, watch: &'a Watch<'a>) -> Result<Self> {
        Ok(Self {
            ground,
            watch,
            near: None,
            star: Star::default(),
            found: Vec::new(),
            visited: Visited::new()?,
        })
    }

    /// Calls `meet` on triangles, among them all that have an area in common with a counterclockwise
    /// triangle, in an order that depends on nothing else.
    #[inline]
    pub fn meeting(
        &mut self,
        corners: [Point2; 3],
        mut meet: impl FnMut(usize, &Pair),
    ) -> Result<()> {
        self.found.clear();
        self.visited.clear();
        let around = Around::of(corners);
        let start = self.start(around.start)?;
        let mut inside = start.is_some();
        match start {
            Some(start) => self.visit(start as u32)?,
            None => self.visit_outer(&corners)?,
        }
        let given = self.ground.given;
        let mut next = 0;
        while let Some(&t) = self.found.get(next) {
            next += 1;
            if next.is_multiple_of(WATCH_EVERY) {
                self.watch.check()?;
            }
            let t = t as usize;
            let corners = given.corners(t);
            let pair = Pair::of(&around, corners);
            let apart = pair.apart(&around, &corners);
            for (apart, beyond) in apart.into_iter().zip(given.neighbors[t]) {
                if apart {
                    continue;
                }
                if beyond >= 0 {
                    self.visit(beyond as u32)?;
                } else if inside {
                    // The walk has reached the boundary.
                    inside = false;
                    self.visit_outer(&around.given)?;
                }
            }
            meet(t, &pair);
        }
        Ok(())
    }

    /// The first of the triangles that contain `q`.
    fn start(&mut self, q: Point2) -> Result<Option<usize>> {
        let ground = self.ground;
        let locator = Locator::new(ground.given, &ground.kept, self.watch);
        let near = match self.near {
            Some(near) => near,
            None if ground.given.simplices.is_empty() => return Ok(None),
            None => locator.near(q),
        };
        match locator.locate_from(near, q, &mut self.star)? {
            Located::Inside(place) => {
                self.near = Some(place.simplex);
                Ok(self.near)
            }
            Located::Outside(side) => {
                self.near = Some(side.map_or(near, |side| side.simplex));
                Ok(None)
            }
        }
    }

    #[inline]
    fn visit(&mut self, t: u32) -> Result<()> {
        if self.visited.insert(t)? {
            push(&mut self.found, t)?;
        }
        Ok(())
    }

    /// Visits the triangles at the boundary whose boxes meet that of a triangle.
    #[cold]
    fn visit_outer(&mut self, corners: &[Point2; 3]) -> Result<()> {
        let ground = self.ground;
        let extent = Extent::of(*corners);
        let mut end = Ok(());
        ground.boxes.meeting(&extent, |i| {
            let t = ground.outer[i];
            let other = Extent::of(ground.given.corners(t as usize));
            if touch(&other, &extent) && end.is_ok() {
                end = self.visit(t);
            }
        });
        end
    }
}

/// A triangle, and relative to its first corner.
struct Around {
    given: [Point2; 3],
    corners: [Point2; 3],
    /// A bound of its coordinates.
    size: f64,
    /// Where walks start.
    start: Point2,
    /// Whether they cross edges that only touch it.
    touching: bool,
}

impl Around {
    fn of(given: [Point2; 3]) -> Self {
        let [a, b, c] = given;
        let corners = given.map(|p| relative(p, a));
        let middle = center(given);
        let sides = [[a, b], [b, c], [c, a]];
        let touching = !sides
            .iter()
            .all(|&[p, q]| orient2d(p, q, middle) == Sign::Positive);
        Self {
            given,
            corners,
            size: size(&corners),
            start: if touching { a } else { middle },
            touching,
        }
    }
}

/// A triangle beside another one, relative to the first corner of that.
pub struct Pair {
    /// Its corners.
    pub corners: [Point2; 3],
    /// For the side from each corner to the next: on which side each corner of the other one is.
    pub sides: [[f64; 3]; 3],
}

impl Pair {
    #[inline(always)]
    fn of(around: &Around, corners: [Point2; 3]) -> Self {
        let corners = corners.map(|p| relative(p, around.given[0]));
        let sides = sides(&corners, &around.corners);
        Self { corners, sides }
    }

    /// Whether the side opposite each corner is apart from the other triangle.
    #[inline(always)]
    fn apart(&self, around: &Around, given: &[Point2; 3]) -> [bool; 3] {
        let far = size(&self.corners);
        let safe = SAFE.contains(&around.size) & SAFE.contains(&far);
        let reach = SLACK * (around.size + far);
        let slack = [reach * far, reach * around.size];
        let theirs = sides(&around.corners, &self.corners);
        let (mut ours, mut others) = ([0u8; 3], [0u8; 3]);
        let mut certain = safe;
        for k in 0..3 {
            for i in 0..3 {
                let (one, other) = (self.sides[k][i], theirs[k][i]);
                certain &= (one.abs() > slack[0]) & (other.abs() > slack[1]);
                ours[k] |= u8::from(one < 0.0) << i;
                others[i] |= u8::from(other < 0.0) << k;
            }
        }
        if !certain {
            let slack = if safe { slack } else { [f64::INFINITY; 2] };
            return exactly(around, given, &self.sides, &theirs, slack);
        }
        [0, 1, 2].map(|k| {
            let all = ours[next(k)];
            (all == 0) | (all == 7) | (others[next(k)] & others[prev(k)] != 0)
        })
    }
}

/// Whether the side opposite each corner of a triangle is apart from another one, by exact signs.
#[cold]
#[inline(never)]
fn exactly(
    around: &Around,
    given: &[Point2; 3],
    ours: &[[f64; 3]; 3],
    theirs: &[[f64; 3]; 3],
    slack: [f64; 2],
) -> [bool; 3] {
    let ours = signs(given, &around.given, ours, slack[0]);
    let theirs = signs(&around.given, given, theirs, slack[1]);
    let behind = |s: Sign| s == Sign::Negative || (s == Sign::Zero && !around.touching);
    let before = |s: Sign| s == Sign::Positive || (s == Sign::Zero && !around.touching);
    std::array::from_fn(|k| {
        let (u, v) = (next(k), prev(k));
        let side = ours[u];
        side.into_iter().all(behind)
            || side.into_iter().all(before)
            || theirs.iter().any(|s| behind(s[u]) && behind(s[v]))
    })
}

/// The signs of [`sides`]: of numbers above `slack` their own, of others exact ones.
fn signs(
    of: &[Point2; 3],
    points: &[Point2; 3],
    sides: &[[f64; 3]; 3],
    slack: f64,
) -> [[Sign; 3]; 3] {
    let mut found = [[Sign::Zero; 3]; 3];
    for k in 0..3 {
        let (a, b) = (of[k], of[next(k)]);
        for ((sign, &side), &p) in found[k].iter_mut().zip(&sides[k]).zip(points) {
            // Surfaces often have points in common.
            if p != a && p != b {
                *sign = match side {
                    _ if side > slack => Sign::Positive,
                    _ if side < -slack => Sign::Negative,
                    _ => orient2d(a, b, p),
                };
            }
        }
    }
    found
}

/// For the line along the side from each corner of a triangle to the next: where points are.
#[inline(always)]
fn sides(of: &[Point2; 3], points: &[Point2; 3]) -> [[f64; 3]; 3] {
    let mut found = [[0.0; 3]; 3];
    for k in 0..3 {
        let line = Line::new(of[k], of[next(k)]);
        for (side, &p) in found[k].iter_mut().zip(points) {
            *side = line.side(p);
        }
    }
    found
}

/// Whether two boxes have a point in common.
fn touch(one: &Extent<2>, other: &Extent<2>) -> bool {
    (0..2).all(|k| one.min[k] <= other.max[k] && other.min[k] <= one.max[k])
}

#[inline]
fn size(corners: &[Point2; 3]) -> f64 {
    let largest = |p: &Point2| p[0].abs().max(p[1].abs());
    corners.iter().map(largest).fold(0.0, f64::max)
}

/// The triangles of a walk: a table of hashes, each with the number of the walk.
struct Visited {
    places: Vec<[u32; 2]>,
    walk: u32,
    count: usize,
}

impl Visited {
    fn new() -> Result<Self> {
        Ok(Self {
            places: filled(PLACES, [0; 2])?,
            walk: 0,
            count: 0,
        })
    }

    /// Clears the table. Walks are counted from one.
    fn clear(&mut self) {
        self.count = 0;
        if self.walk == u32::MAX {
            self.places.fill([0; 2]);
            self.walk = 0;
        }
        self.walk += 1;
    }

    /// Adds a triangle, and returns whether it is new.
    #[inline]
    fn insert(&mut self, t: u32) -> Result<bool> {
        if self.count * 2 >= self.places.len() {
            self.grow()?;
        }
        let new = self.put(t);
        self.count += usize::from(new);
        Ok(new)
    }

    /// The search terminates, because half of the places are free.
    #[inline]
    fn put(&mut self, t: u32) -> bool {
        let mask = self.places.len() - 1;
        // D. Knuth's multiplicative hash; its upper bits are the good ones.
        let mut at = (t.wrapping_mul(0x9e37_79b9) >> 7) as usize & mask;
        loop {
            let place = &mut self.places[at];
            if place[0] != self.walk {
                *place = [self.walk, t];
                return true;
            }
            if place[1] == t {
                return false;
            }
            at = (at + 1) & mask;
        }
    }

    #[cold]
    fn grow(&mut self) -> Result<()> {
        let more = filled(self.places.len() * 2, [0; 2])?;
        let walk = self.walk;
        for [of, t] in std::mem::replace(&mut self.places, more) {
            if of == walk {
                self.put(t);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::watch::IDLE;
    use crate::delaunay::plane::{Method, triangulate};

    type Rows = Vec<[i32; 3]>;

    /// A triangulation of a lattice with gaps, without some of its triangles.
    fn tiling(
        random: &mut impl FnMut() -> u32,
        scale: f64,
        shift: f64,
    ) -> (Vec<Point2>, Rows, Rows) {
        let mut points: Vec<Point2> = (0..100).map(|i| [i % 10, i / 10].map(f64::from)).collect();
        points.retain(|_| !random().is_multiple_of(3));
        points.extend([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]]);
        for p in &mut points {
            *p = p.map(|x| (x + shift) * scale);
        }
        let made = triangulate(&points, Method::Auto, 1, &IDLE).expect("a tiling");
        let (simplices, neighbors) = (&made.arrays.simplices, &made.arrays.neighbors);
        let odds = 2 + random() % 9;
        let kept: Vec<bool> = simplices
            .iter()
            .map(|_| !random().is_multiple_of(odds))
            .collect();
        let mut count = 0;
        let number: Vec<i32> = kept
            .iter()
            .map(|&kept| {
                count += i32::from(kept);
                if kept { count - 1 } else { -1 }
            })
            .collect();
        let of = |rows: &[[i32; 3]]| -> Rows {
            let rows = rows.iter().zip(&kept).filter(|(_, kept)| **kept);
            rows.map(|(row, _)| *row).collect()
        };
        let to = |t: i32| usize::try_from(t).map_or(-1, |t| number[t]);
        let neighbors = of(neighbors).into_iter().map(|row| row.map(to)).collect();
        let simplices = of(simplices);
        (points, simplices, neighbors)
    }

    /// Whether two triangles have an area in common: no line along a side has them on two sides.
    fn overlap(one: &[Point2; 3], other: &[Point2; 3]) -> bool {
        let parts = |one: &[Point2; 3], other: &[Point2; 3]| {
            (0..3).any(|k| {
                let (a, b) = (one[k], one[next(k)]);
                other.iter().all(|&p| orient2d(a, b, p) != Sign::Positive)
            })
        };
        !parts(one, other) && !parts(other, one)
    }

    #[test]
    fn walks_find_all_that_overlap_across_holes_and_at_any_scale() {
        let mut state = 9u32;
        let mut random = move || {
            // G. Marsaglia's xorshift.
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            state >> 8
        };
        // At 2^52 coordinates are integers: centers are rounded to corners and sides. With the
        // smallest and largest scales products leave the doubles.
        let (large, tiny) = (2f64.powi(600), 2f64.powi(-600));
        let kinds = [(1.0, 0.0), (1.0, 2f64.powi(52)), (large, 0.0), (tiny, 0.25)];
        let (mut pairs, mut visits) = (0, 0);
        for round in 0..60 {
            let (scale, shift) = kinds[round % kinds.len()];
            let (points, rows, _) = tiling(&mut random, scale, shift);
            let (others, simplices, neighbors) = tiling(&mut random, scale, shift);
            let given = Triangles {
                points: &others,
                simplices: &simplices,
                neighbors: &neighbors,
            };
            let ground = Ground::of(given, &IDLE).expect("memory");
            let mut walk = Walk::new(&ground, &IDLE).expect("memory");
            for row in &rows {
                let corners = row.map(|v| points[v as usize]);
                let mut found = vec![0; simplices.len()];
                walk.meeting(corners, |t, _| found[t] += 1).expect("a walk");
                visits += found.iter().sum::<usize>();
                for (t, &times) in found.iter().enumerate() {
                    let overlaps = overlap(&corners, &given.corners(t));
                    pairs += usize::from(overlaps);
                    assert!(
                        times <= 1 && (times == 1 || !overlaps),
                        "round {round}, {t}"
                    );
                }
            }
        }
        assert!(
            pairs > 5_000 && visits < 4 * pairs,
            "{visits} visits, {pairs} pairs"
        );
    }
}
