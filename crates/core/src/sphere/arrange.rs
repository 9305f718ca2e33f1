//! The insertion order of directions: along a curve, and for large sets by the sides of a plane.

use delone_predicates::Point3;

use super::directions::{Directions, units};
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;
use crate::order::order_of;

/// The number of vectors that one task takes at a time.
const SHARE: usize = 1 << 14;

/// Directions and their rows.
#[derive(Debug)]
pub struct Arranged {
    /// The directions; the same one may still occur twice, from different vectors.
    pub directions: Directions,
    /// For each, its first row in the input.
    pub rows: Vec<u32>,
    /// Rows that repeat the vector of a direction, with its number.
    pub repeats: Vec<[u32; 2]>,
    /// The plane, if they are arranged by its sides so that two triangulations can be joined.
    pub halves: Option<Halves>,
}

/// Two sides of a plane through the center.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Halves {
    /// The axis at a right angle to it; the first side is that of positive coordinates.
    pub axis: usize,
    /// How many directions are on the first side; the others are on the plane or beyond it.
    pub first: u32,
}

/// The number of directions from which on two triangulations pay off; small for fuzzers.
#[allow(unexpected_cfgs)] // Set by fuzz/run.sh and by cargo fuzz.
const MANY: usize = if cfg!(fuzzing) { 8 } else { 1 << 14 };
/// Each octant must have one in this many directions, or some are too empty for a join.
const OCTANT: usize = 64;
/// Each side of the plane must have one in this many, or two workers gain too little.
const SIDE: usize = 4;

/// The coordinate whose sign divides the directions best; `None` if they are few, or not all
/// octants have their share.
fn axis(vectors: &[Point3], many: usize, workers: usize, watch: &Watch) -> Result<Option<usize>> {
    let n = vectors.len();
    if n < many {
        return Ok(None);
    }
    let lots = vectors.chunks(SHARE).collect();
    let found = parallel::map_watched(workers, lots, watch, |lot: &[Point3]| Ok(octants(lot)))?;
    let counts = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| found.iter().map(|c| c[i]).sum::<usize>());
    if counts.iter().any(|count| count * OCTANT < n) {
        return Ok(None);
    }
    let smaller = |k: usize| {
        let above = (0..8).filter(|i| i >> k & 1 == 1).map(|i| counts[i]);
        let above: usize = above.sum();
        above.min(n - above)
    };
    Ok((0..3)
        .max_by_key(|&k| smaller(k))
        .filter(|&k| smaller(k) * SIDE > n))
}

/// How many vectors are in each octant, those on its boundary left out.
fn octants(vectors: &[Point3]) -> [usize; 8] {
    let mut counts = [0; 8];
    for v in vectors.iter().filter(|v| !v.contains(&0.0)) {
        let [x, y, z] = v.map(|x| usize::from(x > 0.0));
        counts[x | y << 1 | z << 2] += 1;
    }
    counts
}

/// Arranges `vectors`, which have been checked, along a curve through their directions.
pub fn arrange(vectors: &[Point3], workers: usize, watch: &Watch) -> Result<Arranged> {
    arrange_from(vectors, MANY, workers, watch)
}

/// The same, but arranged by sides from `many` vectors on.
pub fn arrange_from(
    vectors: &[Point3],
    many: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Arranged> {
    let axis = axis(vectors, many, workers, watch)?;
    let order = {
        let places = places(vectors, workers, watch)?;
        order_of(&places, workers, watch)?
    };
    let (mut rows, mut first) = match axis {
        Some(axis) => by_sides(vectors, &order, axis, workers, watch)?,
        None => (joined(&order)?, 0),
    };
    drop(order);
    let (mut own, is_repeated) = gathered(vectors, &rows, workers, watch)?;
    let mut repeats = Vec::new();
    if is_repeated {
        first -= close_up(&mut own, &mut rows, &mut repeats, first, watch)?;
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
        halves: axis.map(|axis| Halves { axis, first }),
    })
}

fn joined(parts: &[Vec<u32>]) -> Result<Vec<u32>> {
    let mut rows = with_room(parts.iter().map(Vec::len).sum())?;
    parts.iter().for_each(|part| rows.extend_from_slice(part));
    Ok(rows)
}

/// The rows in their order, first those with a positive coordinate `axis`; and how many these are.
fn by_sides(
    vectors: &[Point3],
    order: &[Vec<u32>],
    axis: usize,
    workers: usize,
    watch: &Watch,
) -> Result<(Vec<u32>, u32)> {
    // A byte for each row stays in the cache, where vectors do not.
    let mut is_above = filled(vectors.len(), false)?;
    let tasks = vectors.chunks(SHARE).zip(is_above.chunks_mut(SHARE));
    parallel::map_watched(workers, tasks.collect(), watch, |(vectors, above)| {
        for (above, v) in above.iter_mut().zip(vectors) {
            *above = v[axis] > 0.0;
        }
        Ok(())
    })?;
    let lots = order.iter().flat_map(|part| part.chunks(SHARE)).collect();
    let sides = parallel::map_watched(workers, lots, watch, |lot: &[u32]| {
        let (mut above, mut below) = (with_room(lot.len())?, with_room(lot.len())?);
        for &row in lot {
            let side = if is_above[row as usize] {
                &mut above
            } else {
                &mut below
            };
            side.push(row);
        }
        Ok((above, below))
    })?;
    let (mut above, below): (Vec<Vec<u32>>, Vec<Vec<u32>>) = sides.into_iter().unzip();
    let first = above.iter().map(|part| part.len() as u32).sum();
    above.extend(below);
    Ok((joined(&above)?, first))
}

/// The vectors of the rows, with room for one more, and whether one is the same as the one before.
fn gathered(
    vectors: &[Point3],
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<(Vec<Point3>, bool)> {
    let mut own = zeroed(rows.len() + 1)?;
    own.pop();
    let tasks = (0..).step_by(SHARE).zip(own.chunks_mut(SHARE));
    let repeated = parallel::map_watched(workers, tasks.collect(), watch, |(start, lot)| {
        // Adding zero turns -0.0 into 0.0.
        let vector = |i: usize| vectors[rows[i] as usize].map(|x| x + 0.0);
        let mut last = if start > 0 {
            vector(start - 1)
        } else {
            [f64::NAN; 3]
        };
        let mut is_repeated = false;
        for (i, own) in (start..).zip(lot) {
            *own = vector(i);
            is_repeated |= *own == last;
            last = *own;
        }
        Ok(is_repeated)
    })?;
    Ok((own, repeated.contains(&true)))
}

/// Keeps the first of equal neighbors, and lists the rows of the others with its number. Returns
/// how many of the first `side` vectors are left out.
fn close_up(
    own: &mut Vec<Point3>,
    rows: &mut Vec<u32>,
    repeats: &mut Vec<[u32; 2]>,
    side: u32,
    watch: &Watch,
) -> Result<u32> {
    let (mut end, mut left_out) = (0, 0);
    for i in 0..rows.len() {
        if i.is_multiple_of(SHARE) {
            watch.check()?;
        }
        if end > 0 && own[end - 1] == own[i] {
            push(repeats, [rows[i], end as u32 - 1])?;
            left_out += u32::from((i as u32) < side);
        } else {
            (own[end], rows[end]) = (own[i], rows[i]);
            end += 1;
        }
    }
    own.truncate(end);
    rows.truncate(end);
    Ok(left_out)
}

/// The places of vectors on the curve.
fn places(vectors: &[Point3], workers: usize, watch: &Watch) -> Result<Vec<Point3>> {
    let mut places = zeroed(vectors.len())?;
    let tasks = vectors.chunks(SHARE).zip(places.chunks_mut(SHARE));
    parallel::map_watched(workers, tasks.collect(), watch, |(vectors, places)| {
        for (place, &v) in places.iter_mut().zip(vectors) {
            *place = rough(v);
        }
        Ok(())
    })?;
    Ok(places)
}

/// The approximate direction: its place on the curve depends on it, but no triangle does.
fn rough(v: Point3) -> Point3 {
    let top = v.iter().fold(0.0, |top: f64, x| top.max(x.abs()));
    let w = v.map(|x| x / top);
    let length = (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt();
    w.map(|x| x / length)
}
