//! Vectors with their directions in insertion order, and the predicates of their numbers.

use delone_predicates::sphere::{Unit, incircle_of, orient_of, same, tie};
use delone_predicates::{Point3, Sign, orient2d};

use crate::base::error::{Error, Result};
use crate::base::memory::zeroed;
use crate::base::parallel;
use crate::base::points::{NAMED_ROWS, scan};
use crate::base::watch::Watch;
use crate::constrained::sites::Sites;

/// Vectors whose directions are computed together.
const SHARE: usize = 1 << 14;

/// Directions along a space-filling curve; the last one is NaN, for infinity.
#[derive(Debug)]
pub struct Directions {
    /// The directions, rounded.
    pub heads: Vec<Point3>,
    /// Their tails: what rounding removed.
    pub tails: Vec<Point3>,
    /// The vectors, exact.
    pub vectors: Vec<Point3>,
}

/// Checks that each of the `vectors` is finite and has a direction.
pub fn check(vectors: &[Point3]) -> Result<()> {
    scan(vectors)?;
    let is_zero = |v: &Point3| v.iter().all(|&x| x == 0.0);
    let count = vectors.iter().filter(|v| is_zero(v)).count();
    if count == 0 {
        return Ok(());
    }
    let rows = (0u32..).zip(vectors).filter(|(_, v)| is_zero(v));
    Err(Error::ZeroVectors {
        rows: rows.map(|(row, _)| row).take(NAMED_ROWS).collect(),
        count,
    })
}

/// The directions of vectors: heads and tails.
pub fn units(
    vectors: &[Point3],
    workers: usize,
    watch: &Watch,
) -> Result<(Vec<Point3>, Vec<Point3>)> {
    let mut heads = zeroed(vectors.len())?;
    let mut tails = zeroed(vectors.len())?;
    let both = heads.chunks_mut(SHARE).zip(tails.chunks_mut(SHARE));
    let tasks = vectors.chunks(SHARE).zip(both);
    parallel::map_watched(
        workers,
        tasks.collect(),
        watch,
        |(vectors, (heads, tails))| {
            for ((&v, head), tail) in vectors.iter().zip(heads).zip(tails) {
                let unit = Unit::of(v);
                (*head, *tail) = (unit.hi, unit.lo);
            }
            Ok(())
        },
    )?;
    Ok((heads, tails))
}

impl Directions {
    /// How many there are.
    pub fn count(&self) -> u32 {
        self.vectors.len() as u32 - 1
    }

    /// The vector of a direction.
    pub fn vector(&self, i: u32) -> Point3 {
        self.vectors[i as usize]
    }

    fn unit(&self, i: u32) -> Unit {
        Unit {
            hi: self.heads[i as usize],
            lo: self.tails[i as usize],
        }
    }

    /// The sign of the determinant of three directions.
    #[inline]
    pub fn orient(&self, numbers: [u32; 3]) -> Sign {
        let units = numbers.map(|i| self.unit(i));
        orient_of(numbers.map(|i| self.vector(i)), units.each_ref())
    }

    /// Whether the last of four distinct directions is inside the circle of the first three; ties
    /// are broken canonically.
    #[inline]
    pub fn in_circle(&self, numbers: [u32; 4]) -> bool {
        let vectors = numbers.map(|i| self.vector(i));
        let units = numbers.map(|i| self.unit(i));
        let sign = match incircle_of(vectors, units.each_ref()) {
            Sign::Zero => tie(vectors),
            sign => sign,
        };
        sign == Sign::Positive
    }

    /// Whether two directions are the same.
    pub fn same(&self, a: u32, b: u32) -> bool {
        same(self.vector(a), self.vector(b))
    }

    /// Whether two directions are the same or opposite.
    pub fn parallel(&self, a: u32, b: u32) -> bool {
        self.same(a, b) || same(self.vector(a).map(|x| -x), self.vector(b))
    }

    /// Whether `p`, on the great circle through `a` and `b`, is strictly inside the short arc
    /// between them.
    pub fn between(&self, a: u32, p: u32, b: u32) -> bool {
        let [a, p, b] = [a, p, b].map(|i| self.vector(i));
        // The cross products of two of them are multiples of that of a and b.
        [[0, 1], [1, 2], [2, 0]].iter().any(|&axes| {
            let side = turn(a, b, axes);
            !side.is_zero() && turn(a, p, axes) == side && turn(p, b, axes) == side
        })
    }
}

impl Sites for Directions {
    #[inline]
    fn orient(&self, vertices: [u32; 3]) -> Sign {
        self.orient(vertices)
    }

    #[inline]
    fn in_circle(&self, vertices: [u32; 4]) -> bool {
        self.in_circle(vertices)
    }

    fn ahead(&self, a: u32, b: u32, v: u32) -> bool {
        let [a, b, v] = [a, b, v].map(|i| self.vector(i));
        [[0, 1], [1, 2], [2, 0]].iter().any(|&axes| {
            let side = turn(a, b, axes);
            !side.is_zero() && turn(a, v, axes) == side
        })
    }
}

/// The sign of one coordinate of the cross product of two vectors, by the other two axes: that of
/// their determinant with this axis.
pub fn turn(a: Point3, b: Point3, [i, j]: [usize; 2]) -> Sign {
    orient2d([a[i], a[j]], [b[i], b[j]], [0.0; 2])
}
