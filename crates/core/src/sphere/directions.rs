//! Vectors with their directions in insertion order, and the predicates of their numbers.

use delone_predicates::sphere::{Unit, incircle_of, orient_of, same, tie};
use delone_predicates::{Point3, Sign, orient2d};

use crate::constrained::sites::Sites;
use crate::error::{Error, Result};
use crate::memory::{filled, push, with_room};
use crate::order::order_of;
use crate::parallel;
use crate::points::{NAMED_ROWS, scan};
use crate::watch::Watch;

/// Vectors whose directions are computed together.
const SHARE: usize = 1 << 14;

/// Directions along a space-filling curve; the last one is NaN, for infinity.
#[derive(Debug)]
pub struct Directions {
    /// The directions, rounded.
    pub heads: Vec<Point3>,
    /// What is left of them.
    tails: Vec<Point3>,
    /// The vectors, exact.
    vectors: Vec<Point3>,
}

/// Directions and their rows.
#[derive(Debug)]
pub struct Arranged {
    /// The directions; the same one may still occur twice, from different vectors.
    pub directions: Directions,
    /// For each, its first row in the input.
    pub rows: Vec<u32>,
    /// Rows that repeat the vector of a direction, with its number.
    pub repeats: Vec<[u32; 2]>,
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

/// Arranges `vectors`, which have been checked, along a curve through their directions.
pub fn arrange(vectors: &[Point3], workers: usize, watch: &Watch) -> Result<Arranged> {
    let order = {
        let places = places(vectors, workers, watch)?;
        order_of(&places, workers, watch)?
    };
    let n = vectors.len();
    let mut rows: Vec<u32> = with_room(n)?;
    let mut repeats = Vec::new();
    let mut own: Vec<Point3> = with_room(n + 1)?;
    for part in order {
        watch.check()?;
        for row in part {
            // Adding zero turns -0.0 into 0.0.
            let v = vectors[row as usize].map(|x| x + 0.0);
            if own.last() == Some(&v) {
                push(&mut repeats, [row, own.len() as u32 - 1])?;
            } else {
                own.push(v);
                rows.push(row);
            }
        }
    }
    own.push([f64::NAN; 3]);
    let (heads, tails) = units(&own, workers, watch)?;
    Ok(Arranged {
        directions: Directions {
            heads,
            tails,
            vectors: own,
        },
        rows,
        repeats,
    })
}

/// The places of vectors on the curve.
fn places(vectors: &[Point3], workers: usize, watch: &Watch) -> Result<Vec<Point3>> {
    let mut places = filled(vectors.len(), [0.0; 3])?;
    let tasks = vectors.chunks(SHARE).zip(places.chunks_mut(SHARE));
    parallel::map_watched(workers, tasks.collect(), watch, |(vectors, places)| {
        for (place, &v) in places.iter_mut().zip(vectors) {
            *place = rough(v);
        }
        Ok(())
    })?;
    Ok(places)
}

/// The directions of vectors: heads and tails.
pub fn units(
    vectors: &[Point3],
    workers: usize,
    watch: &Watch,
) -> Result<(Vec<Point3>, Vec<Point3>)> {
    let mut heads = filled(vectors.len(), [0.0; 3])?;
    let mut tails = filled(vectors.len(), [0.0; 3])?;
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

/// The direction, roughly: its place on the curve depends on it, and no triangle.
fn rough(v: Point3) -> Point3 {
    let top = v.iter().fold(0.0, |top: f64, x| top.max(x.abs()));
    let w = v.map(|x| x / top);
    let length = (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt();
    w.map(|x| x / length)
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

    /// The sign of the determinant of three.
    #[inline]
    pub fn orient(&self, numbers: [u32; 3]) -> Sign {
        let units = numbers.map(|i| self.unit(i));
        orient_of(numbers.map(|i| self.vector(i)), units.each_ref())
    }

    /// Whether the last of four distinct directions is inside the circle of the first three; ties are
    /// broken canonically.
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

    /// Whether two are the same.
    pub fn same(&self, a: u32, b: u32) -> bool {
        same(self.vector(a), self.vector(b))
    }

    /// Whether two are the same or opposite.
    pub fn parallel(&self, a: u32, b: u32) -> bool {
        self.same(a, b) || same(self.vector(a).map(|x| -x), self.vector(b))
    }

    /// Whether `p`, on the great circle through `a` and `b`, is strictly inside the short arc between
    /// them.
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

/// The sign of one coordinate of the cross product of two vectors, by the other two axes.
pub fn turn(a: Point3, b: Point3, [i, j]: [usize; 2]) -> Sign {
    orient2d([a[i], a[j]], [b[i], b[j]], [0.0; 2])
}
