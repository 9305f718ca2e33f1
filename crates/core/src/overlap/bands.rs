//! Cells between meridians and parallels, in blocks of rows that share their meridians.
//!
//! A block has parallels from south to north, and meridians all around the globe, from west to
//! east. Wide columns are cut into several with one number; where there is no cell the number is
//! -1. So no column is wider than [`WIDEST`], and each place has a column.

use delone_predicates::arithmetic::Pair;
use delone_predicates::{Point2, Sign, orient2d};

use crate::base::error::{Error, Result};

use super::pairs::{ONE, Pair3, ZERO, pair, quotient, root};
use super::signs::above;

/// Widest column, 30 degrees: what is between a parallel and its chord is integrated with errors of
/// 1e-16 times the cube of the width.
const WIDEST: f64 = std::f64::consts::PI / 6.0;
/// Columns are cut to this many times the height of their row, into at most [`PARTS`] parts, for
/// the same reason.
const HEIGHTS: f64 = 16.0;
/// See above.
const PARTS: f64 = 64.0;

/// The tangent of 60 degrees: rows beyond this latitude on both sides are cut at the equator.
const FAR: f64 = 1.75;

/// Cells between meridians and parallels, by rows.
pub struct Rows<'a> {
    /// The tangents of the latitudes south and north of each row, infinite at poles.
    pub tangents: &'a [[f64; 2]],
    /// Where the meridians of each row start, and their number.
    pub starts: &'a [i64],
    /// Directions of meridians from west to east, less than half a turn apart, at most one turn in
    /// all.
    pub meridians: &'a [Point2],
    /// The number of the cell between each meridian and the next one of its row; -1 for none. The
    /// entry of a row's last meridian is meaningless.
    pub numbers: &'a [i32],
    /// The number of cells.
    pub count: usize,
}

/// Rows with common meridians.
pub struct Block {
    /// Tangents of latitudes, ascending.
    pub tan: Vec<f64>,
    /// Cosines and sines of latitudes.
    pub lat: Vec<[Pair; 2]>,
    /// Latitudes, rounded.
    pub phi: Vec<f64>,
    /// Directions of meridians, leveled, counterclockwise.
    pub lon: Vec<Point2>,
    /// Their lengths, rounded.
    pub len: Vec<f64>,
    /// Their unit vectors.
    pub dir: Vec<[Pair; 2]>,
    /// Angles from the first meridian, rounded.
    pub angle: Vec<f64>,
    /// Widths of columns.
    pub width: Vec<f64>,
    /// Cells, row by row.
    pub numbers: Vec<i32>,
}

/// The pair of numbers times the power of two that brings the larger one to 1 <= |x| < 2.
fn leveled2(v: Point2) -> Point2 {
    let w = delone_predicates::sphere::leveled([v[0], v[1], 0.0]);
    [w[0] + 0.0, w[1] + 0.0]
}

/// The sign of the angle from one direction to another, less than half a turn.
pub fn turn2(a: Point2, b: Point2) -> Sign {
    orient2d(a, b, [0.0; 2])
}

/// The angle from one direction to another, from -pi to pi.
pub fn angle2(a: Point2, b: Point2) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

impl Rows<'_> {
    /// The blocks, from south to north.
    pub fn blocks(&self) -> Result<Vec<Block>> {
        let mut order: Vec<usize> = (0..self.tangents.len()).collect();
        for (row, [south, north]) in self.tangents.iter().enumerate() {
            if south >= north {
                return Err(Error::Shape(format!("row {row} has no height")));
            }
        }
        order.sort_by(|&a, &b| self.tangents[a][0].total_cmp(&self.tangents[b][0]));
        let mut blocks: Vec<Block> = Vec::new();
        let mut last: Option<(usize, f64)> = None;
        for row in order {
            let [south, north] = self.tangents[row];
            let height = north.atan() - south.atan();
            let limit = WIDEST.min(HEIGHTS * height);
            let same = last.is_some_and(|(before, other)| {
                self.of(before).0 == self.of(row).0
                    && self.cuts(before, other) == self.cuts(row, limit)
            });
            match blocks.last_mut() {
                Some(block) if same && block.tan.last() == Some(&south) => {
                    let numbers = self.spread(row, limit)?.1;
                    block.push(north, &numbers);
                }
                _ => {
                    let (lon, numbers) = self.spread(row, limit)?;
                    let mut block = Block::new(south, lon);
                    block.push(north, &numbers);
                    blocks.push(block);
                }
            }
            last = Some((row, limit));
        }
        for block in &mut blocks {
            block.finish();
        }
        Ok(blocks)
    }

    /// The meridians and numbers of a row.
    fn of(&self, row: usize) -> (&[Point2], &[i32]) {
        let range = self.starts[row] as usize..self.starts[row + 1] as usize;
        (&self.meridians[range.clone()], &self.numbers[range])
    }

    /// Into how many parts each column of a row is cut.
    fn cuts(&self, row: usize, limit: f64) -> Vec<usize> {
        let parts = |pair: &[Point2]| {
            let width = angle2(pair[0], pair[1]).abs();
            (width / limit)
                .ceil()
                .clamp(1.0, PARTS.max((width / WIDEST).ceil())) as usize
        };
        self.of(row).0.windows(2).map(parts).collect()
    }

    /// Meridians all around the globe, and the cell in each column.
    fn spread(&self, row: usize, limit: f64) -> Result<(Vec<Point2>, Vec<i32>)> {
        let (given, numbers) = self.of(row);
        let (mut lon, mut cells) = (Vec::new(), Vec::new());
        let mut total = 0.0;
        for (k, parts) in self.cuts(row, limit).into_iter().enumerate() {
            let (a, b) = (leveled2(given[k]), leveled2(given[k + 1]));
            if turn2(a, b) != Sign::Positive {
                return Err(Error::Shape(format!(
                    "column {k} of row {row} has no width"
                )));
            }
            total += angle2(a, b);
            cut(&mut lon, a, b, parts);
            cells.resize(lon.len(), numbers[k]);
        }
        if given.len() < 2 || total > std::f64::consts::TAU + 1e-9 {
            return Err(Error::Shape(format!("row {row} is not within one turn")));
        }
        // The rest of the turn has no cells. Rounding may put the last meridian slightly beyond the first; the
        // rest would then be almost a whole turn, so the last column ends at the first meridian.
        let (end, start) = (leveled2(given[given.len() - 1]), lon[0]);
        let near = end[0] * start[0] + end[1] * start[1] > 0.0;
        let beyond = near && total > std::f64::consts::PI && turn2(start, end) == Sign::Positive;
        if beyond && turn2(lon[lon.len() - 1], start) != Sign::Positive {
            return Err(Error::Shape(format!("row {row} is not within one turn")));
        }
        let closed = beyond || near && turn2(end, start) == Sign::Zero;
        if !closed {
            let gap = angle2(end, start).rem_euclid(std::f64::consts::TAU);
            let middle = |share: f64| {
                let (s, c) = (end[1].atan2(end[0]) + share * gap).sin_cos();
                leveled2([c, s])
            };
            let parts = (gap / WIDEST).ceil().max(1.0);
            lon.push(end);
            lon.extend((1..parts as usize).map(|k| middle(k as f64 / parts)));
            cells.resize(lon.len(), -1);
        }
        Ok((lon, cells))
    }
}

/// Appends a meridian and those that cut the column to the next one.
fn cut(lon: &mut Vec<Point2>, a: Point2, b: Point2, parts: usize) {
    lon.push(a);
    let (from, width) = (a[1].atan2(a[0]), angle2(a, b));
    for k in 1..parts {
        let (s, c) = (from + width * (k as f64 / parts as f64)).sin_cos();
        let m = leveled2([c, s]);
        // A column of a few units in the last place is not cut.
        if turn2(lon[lon.len() - 1], m) == Sign::Positive && turn2(m, b) == Sign::Positive {
            lon.push(m);
        }
    }
}

impl Block {
    /// A block without rows, north of a parallel.
    fn new(south: f64, lon: Vec<Point2>) -> Self {
        Self {
            tan: vec![south],
            lon,
            numbers: Vec::new(),
            lat: Vec::new(),
            phi: Vec::new(),
            len: Vec::new(),
            dir: Vec::new(),
            angle: Vec::new(),
            width: Vec::new(),
        }
    }

    /// Adds a row to the north, cut at the equator if it reaches far to both sides: then one pole is
    /// far from the opposite of all its places.
    fn push(&mut self, north: f64, numbers: &[i32]) {
        let wide = self.tan.last().is_some_and(|&south| south < -FAR) && north > FAR;
        for t in wide.then_some(0.0).into_iter().chain([north]) {
            self.tan.push(t);
            self.numbers.extend(numbers);
        }
    }

    /// The chart in which areas of a row are summed: that of the pole that is nearer.
    pub fn axis(&self, row: usize) -> usize {
        usize::from(self.phi[row] + self.phi[row + 1] < 0.0)
    }

    /// Fills what follows from meridians and parallels.
    fn finish(&mut self) {
        self.lat = self.tan.iter().map(|&t| latitude(t)).collect();
        self.phi = self.tan.iter().map(|t| t.atan()).collect();
        for &[c, s] in &self.lon {
            let len = root(Pair::product(c, c) + Pair::product(s, s));
            self.len.push(len.hi);
            self.dir
                .push([quotient(pair(c), len), quotient(pair(s), len)]);
        }
        let mut at = 0.0;
        for m in 0..self.lon.len() {
            let next = self.dir[self.after(m)];
            let width = angle(&self.dir[m], &next);
            self.angle.push(at);
            self.width.push(width);
            at += width;
        }
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.tan.len() - 1
    }

    /// The number of columns, and of meridians.
    pub fn columns(&self) -> usize {
        self.lon.len()
    }

    /// The meridian east of a column, or the column east of it.
    #[inline]
    pub fn after(&self, m: usize) -> usize {
        if m + 1 == self.lon.len() { 0 } else { m + 1 }
    }

    /// The column west of a meridian.
    #[inline]
    pub fn before(&self, m: usize) -> usize {
        if m == 0 { self.lon.len() - 1 } else { m - 1 }
    }

    /// The cell of a row and a column.
    #[inline]
    pub fn number(&self, row: usize, column: usize) -> i32 {
        self.numbers[row * self.lon.len() + column]
    }

    /// The area of a row of a column.
    #[inline]
    pub fn area(&self, row: usize, column: usize) -> f64 {
        self.width[column] * (self.lat[row + 1][1] - self.lat[row][1]).hi
    }

    /// The place of a meridian on a parallel.
    pub fn corner(&self, m: usize, l: usize) -> Pair3 {
        let ([c, s], [x, z]) = (self.dir[m], self.lat[l]);
        [c * x, s * x, z]
    }

    /// The row of a moved corner: -1 below the block, the number of rows above it.
    pub fn row_of(&self, v: [f64; 3]) -> i64 {
        let phi = v[2].atan2((v[0] * v[0] + v[1] * v[1]).sqrt());
        let mut row = self.phi.partition_point(|&x| x <= phi) as i64 - 1;
        while row >= 0 && !above(self.tan[row as usize], v) {
            row -= 1;
        }
        while row + 1 < self.tan.len() as i64 && above(self.tan[(row + 1) as usize], v) {
            row += 1;
        }
        row
    }

    /// The column in which a direction is, where `east` tells whether it is to the left of a
    /// meridian; fails after a full turn.
    pub fn column_of(&self, v: Point2, east: impl Fn(Point2) -> bool) -> Result<usize> {
        let at = angle2(self.lon[0], v).rem_euclid(std::f64::consts::TAU);
        let mut m = self.angle.partition_point(|&x| x <= at).max(1) - 1;
        for _ in 0..2 * self.lon.len() + 2 {
            if !east(self.lon[m]) {
                m = self.before(m);
            } else if east(self.lon[self.after(m)]) {
                m = self.after(m);
            } else {
                return Ok(m);
            }
        }
        Err(Error::Internal("a direction is in no column".into()))
    }
}

/// The cosine and sine of a latitude by its tangent.
fn latitude(t: f64) -> [Pair; 2] {
    if t.is_infinite() {
        return [ZERO, pair(t.signum())];
    }
    // Beyond 1e140 the square overflows, and the sine is 1.
    if t.abs() > 1e140 {
        return [quotient(ONE, pair(t.abs())), pair(t.signum())];
    }
    let length = root(ONE + Pair::product(t, t));
    [quotient(ONE, length), quotient(pair(t), length)]
}

/// The angle between unit vectors in the plane.
pub fn angle(p: &[Pair; 2], q: &[Pair; 2]) -> f64 {
    (p[0] * q[1] - p[1] * q[0])
        .hi
        .atan2((p[0] * q[0] + p[1] * q[1]).hi)
}
