//! Convex polygons, cut by triangles: I. E. Sutherland and G. W. Hodgman, "Reentrant polygon
//! clipping", Communications of the ACM 17 (1974).

use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::locate::Boxes;
use delone_predicates::Point2;

/// A triangle cut by two others has nine corners at most.
pub const MOST: usize = 10;
/// Candidates between two checks for interruption.
pub const WATCH_EVERY: usize = 1 << 12;

/// A convex polygon, counterclockwise, relative to an origin.
#[derive(Clone, Copy)]
pub struct Polygon {
    corners: [Point2; MOST],
    len: usize,
}

impl Polygon {
    /// Without corners.
    pub const EMPTY: Self = Self {
        corners: [[0.0; 2]; MOST],
        len: 0,
    };

    /// A triangle.
    pub fn triangle(corners: [Point2; 3], origin: Point2) -> Self {
        let mut polygon = Self {
            corners: [[0.0; 2]; MOST],
            len: 3,
        };
        for (to, from) in polygon.corners.iter_mut().zip(corners) {
            *to = relative(from, origin);
        }
        polygon
    }

    /// Its corners; empty if fewer than three.
    pub fn corners(&self) -> &[Point2] {
        &self.corners[..self.len]
    }

    /// The box around it.
    pub fn extent(&self) -> Extent<2> {
        Extent::of(self.corners().iter().copied())
    }

    /// The part in a triangle; `None` if it has no area. Written into one of `space` if it is cut.
    #[inline]
    pub fn clipped<'a>(
        &'a self,
        &[a, b, c]: &[Point2; 3],
        space: &'a mut [Self; 3],
    ) -> Option<&'a Self> {
        let lines = [Line::new(a, b), Line::new(b, c), Line::new(c, a)];
        // Most triangles whose boxes meet are on different sides of one of these lines, and most of
        // the others are cut by one or two of them.
        let mut cuts = [false; 3];
        for (line, cuts) in lines.iter().zip(&mut cuts) {
            let (mut beyond, mut before) = (true, true);
            for &p in self.corners() {
                let side = line.side(p);
                beyond &= side <= 0.0;
                before &= side >= 0.0;
            }
            if beyond {
                return None;
            }
            *cuts = !before;
        }
        self.cut_by(&lines, cuts, space)
    }

    /// The same for a triangle, where the sides of its corners are known.
    #[inline]
    pub fn in_pair<'a>(
        &'a self,
        corners: &[Point2; 3],
        sides: &[[f64; 3]; 3],
        space: &'a mut [Self; 3],
    ) -> Option<&'a Self> {
        let beyond = |s: &[f64; 3]| (s[0] <= 0.0) & (s[1] <= 0.0) & (s[2] <= 0.0);
        if sides.iter().any(beyond) {
            return None;
        }
        let [a, b, c] = *corners;
        let lines = [Line::new(a, b), Line::new(b, c), Line::new(c, a)];
        let cuts = sides.map(|s| !((s[0] >= 0.0) & (s[1] >= 0.0) & (s[2] >= 0.0)));
        self.cut_by(&lines, cuts, space)
    }

    /// The part to the left of those lines that cut.
    #[inline]
    fn cut_by<'a>(
        &'a self,
        lines: &[Line; 3],
        cuts: [bool; 3],
        space: &'a mut [Self; 3],
    ) -> Option<&'a Self> {
        let mut part = self;
        for ((line, cuts), to) in lines.iter().zip(cuts).zip(space) {
            if cuts {
                part.cut(line, to);
                part = to;
            }
        }
        (part.len >= 3).then_some(part)
    }

    /// Writes the part to the left of a line.
    #[inline]
    fn cut(&self, line: &Line, found: &mut Self) {
        found.len = 0;
        let Some(&last) = self.corners().last() else {
            return;
        };
        let (mut from, mut before) = (last, line.side(last));
        for &to in self.corners() {
            let after = line.side(to);
            if (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0) {
                let share = before / (before - after);
                found.push(std::array::from_fn(|k| from[k] + share * (to[k] - from[k])));
            }
            if after >= 0.0 {
                found.push(to);
            }
            (from, before) = (to, after);
        }
    }

    fn push(&mut self, corner: Point2) {
        // Rounding cannot add a corner for each cut and one more; such a corner would be left out.
        if self.len < MOST {
            self.corners[self.len] = corner;
            self.len += 1;
        }
    }
}

/// A directed line.
pub struct Line {
    at: Point2,
    along: Point2,
}

impl Line {
    /// From a point to another one.
    #[inline]
    pub fn new(a: Point2, b: Point2) -> Self {
        Self {
            at: a,
            along: relative(b, a),
        }
    }

    /// Above zero to the left.
    #[inline]
    pub fn side(&self, p: Point2) -> f64 {
        let [x, y] = relative(p, self.at);
        self.along[0] * y - self.along[1] * x
    }
}

/// Triangles of a region that may overlap those of a group, by their boxes.
#[derive(Default)]
pub struct Candidates {
    boxes: Vec<Extent<2>>,
    corners: Vec<[Point2; 3]>,
    /// Room for the rows of those found.
    found: Vec<u32>,
    /// Those found, relative to an origin.
    near: Vec<[Point2; 3]>,
}

impl Candidates {
    /// Takes the triangles of a region whose boxes in a tree are near that of a group.
    pub fn gather(&mut self, region: Triangles, boxes: &Boxes<2>, group: &Extent<2>) -> Result<()> {
        self.boxes.clear();
        self.corners.clear();
        let mut end = Ok(());
        boxes.meeting(group, |t| {
            if end.is_ok() {
                end = self.add(region.corners(t));
            }
        });
        end
    }

    fn add(&mut self, corners: [Point2; 3]) -> Result<()> {
        push(&mut self.boxes, Extent::of(corners))?;
        push(&mut self.corners, corners)?;
        if self.found.len() < self.boxes.len() {
            push(&mut self.found, 0)?;
        }
        Ok(())
    }

    /// Those whose boxes have an area in common with `extent`, that of a triangle relative to its first
    /// corner; relative to that, too.
    pub fn meeting(
        &mut self,
        triangle: &[Point2; 3],
        extent: &Extent<2>,
        watch: &Watch,
    ) -> Result<&[[Point2; 3]]> {
        // Differences keep their order when they are rounded: what is apart here is so relative to an
        // origin, and few are left.
        let whole = Extent::of(*triangle);
        let mut count = 0;
        let mut row = 0;
        for lot in self.boxes.chunks(WATCH_EVERY) {
            if row > 0 {
                watch.check()?;
            }
            // Without a branch: about one in four meets, in an unpredictable order.
            for other in lot {
                self.found[count] = row;
                count += usize::from(meet(other, &whole));
                row += 1;
            }
        }
        self.near.clear();
        for &row in &self.found[..count] {
            let corners = self.corners[row as usize].map(|p| relative(p, triangle[0]));
            if meet(&Extent::of(corners), extent) {
                push(&mut self.near, corners)?;
            }
        }
        Ok(&self.near)
    }
}

/// Whether two boxes have an area in common.
#[inline]
fn meet(one: &Extent<2>, other: &Extent<2>) -> bool {
    (one.min[0] < other.max[0])
        & (other.min[0] < one.max[0])
        & (one.min[1] < other.max[1])
        & (other.min[1] < one.max[1])
}

/// A point relative to an origin.
#[inline]
pub fn relative(p: Point2, origin: Point2) -> Point2 {
    [p[0] - origin[0], p[1] - origin[1]]
}
