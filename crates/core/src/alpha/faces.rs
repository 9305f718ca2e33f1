//! The values of simplices in four and more dimensions, and of all their faces.
//!
//! From the highest dimension down, the faces of the simplices of one dimension are listed and sorted.
//! Each is then next to its cofaces, whose other corners are tested: if one is in conflict with the
//! smallest ball of the face, the value is the least one of a coface.

use super::gram::Cloud;
use super::simplices::each;
use crate::base::error::{Error, Result};
use crate::base::memory::with_room;
use crate::base::watch::{Pace, Watch};
use crate::order::sort;

/// Faces between two checks for interruption.
const LOT: usize = 1 << 14;

/// The simplices of one dimension, rows of each and all ascending, with their values.
pub struct Level {
    /// The rows, simplex by simplex.
    pub rows: Vec<i32>,
    /// The values.
    pub values: Vec<f64>,
}

/// Simplices of A corners, and their values.
struct Valued<'a, const A: usize> {
    simplices: &'a [[i32; A]],
    values: &'a [f64],
}

/// The values of simplices with one more corner than points have coordinates, 4 to 8, and their faces
/// with their values, vertices first.
pub fn faces(
    cloud: Cloud<'_>,
    simplices: &[i32],
    workers: usize,
    watch: &Watch,
) -> Result<(Vec<f64>, Vec<Level>)> {
    let width = cloud.dimension + 1;
    let values = each(simplices.len() / width, workers, watch, |t| {
        cloud.radius(&simplices[width * t..][..width])
    })?;
    let mut found = Vec::new();
    // Dimension by dimension, from that of the simplices on.
    macro_rules! down {
        ($rows:expr, $values:expr; $a:literal) => {};
        ($rows:expr, $values:expr; $a:literal $b:literal $($rest:literal)*) => {{
            let cofaces = Valued::<$a> {
                simplices: $rows.as_chunks().0,
                values: $values,
            };
            let level = level::<$a, $b>(cloud, cofaces, workers, watch)?;
            down!(&level.rows, &level.values; $b $($rest)*);
            found.push(level);
        }};
    }
    match width {
        5 => down!(simplices, &values; 5 4 3 2 1),
        6 => down!(simplices, &values; 6 5 4 3 2 1),
        7 => down!(simplices, &values; 7 6 5 4 3 2 1),
        8 => down!(simplices, &values; 8 7 6 5 4 3 2 1),
        9 => down!(simplices, &values; 9 8 7 6 5 4 3 2 1),
        _ => {
            let message = format!("points have {} coordinates, not 4 to 8", cloud.dimension);
            return Err(Error::Shape(message));
        }
    }
    Ok((values, found))
}

/// The faces of simplices, each once, and their values.
fn level<const A: usize, const B: usize>(
    cloud: Cloud<'_>,
    cofaces: Valued<'_, A>,
    workers: usize,
    watch: &Watch,
) -> Result<Level> {
    let limit = u32::MAX as usize / A;
    if cofaces.simplices.len() > limit {
        return Err(Error::TooManySimplices { limit });
    }
    let mut pace = Pace::new(watch, LOT);
    // The rows of each face, and `A t + k` where it is opposite corner k of coface t.
    let mut sides: Vec<([i32; B], u32)> = with_room(A * cofaces.simplices.len())?;
    for (t, v) in (0u32..).zip(cofaces.simplices) {
        pace.spend(1)?;
        for k in 0..A {
            let mut face: [i32; B] = std::array::from_fn(|i| v[i + usize::from(i >= k)]);
            face.sort_unstable();
            sides.push((face, A as u32 * t + k as u32));
        }
    }
    sort(&mut sides, watch)?;
    let mut starts = with_room(sides.len() + 1)?;
    for (i, side) in sides.iter().enumerate() {
        if i == 0 || sides[i - 1].0 != side.0 {
            starts.push(i);
        }
    }
    let count = starts.len();
    starts.push(sides.len());
    let values = each(count, workers, watch, |f| {
        let around = &sides[starts[f]..starts[f + 1]];
        let mut rows = [0; A];
        rows[..B].copy_from_slice(&around[0].0);
        let is_met = around.iter().any(|&(_, side)| {
            let side = side as usize;
            rows[B] = cofaces.simplices[side / A][side % A];
            // A single point without weights is in conflict with nothing.
            (B > 1 || !cloud.weights.is_empty()) && cloud.meets(&rows)
        });
        if is_met {
            let of = |&(_, side): &([i32; B], u32)| cofaces.values[side as usize / A];
            around.iter().map(of).fold(f64::INFINITY, f64::min)
        } else {
            cloud.radius(&rows[..B])
        }
    })?;
    let mut rows = with_room(B * count)?;
    for &start in &starts[..count] {
        rows.extend_from_slice(&sides[start].0);
    }
    Ok(Level { rows, values })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn work_is_interrupted() {
        let mut next = uniform(3);
        let points: Vec<[f64; 4]> = (0..400).map(|_| [(); 4].map(|()| next())).collect();
        // Any simplices have faces.
        let simplices: Vec<i32> = (0..4000).map(|i| (i / 5 % 396) + i % 5).collect();
        let cloud = Cloud {
            points: points.as_flattened(),
            dimension: 4,
            weights: &[],
        };
        let asked = AtomicUsize::new(0);
        let count = || asked.fetch_add(1, Ordering::Relaxed) == usize::MAX;
        let (values, below) = faces(cloud, &simplices, 1, &Watch::new(&count)).unwrap();
        assert_eq!((values.len(), below.len()), (800, 4));
        assert_eq!(below[0].values.len(), 400);
        let all = asked.into_inner();
        for last in [0, all / 2, all - 1] {
            let asked = AtomicUsize::new(0);
            let stop = || asked.fetch_add(1, Ordering::Relaxed) == last;
            let found = faces(cloud, &simplices, 1, &Watch::new(&stop));
            assert!(matches!(found, Err(Error::Interrupted)), "{last} of {all}");
        }
        assert!(all > 5, "{all}");
    }
}
