//! Points of space along a curve: Morton's order of the cells of a cube around them (G. M. Morton, "A
//! computer oriented geodetic data base", 1966). For points of which nothing is built in that order.

use delone_predicates::Point3;

use super::radix;
use crate::error::Result;
use crate::memory::with_room;

/// Bits of a cell along each axis: three of them fit the upper half of an item.
const BITS: u32 = 10;

/// The rows of the finite points, from cell to cell along the curve.
pub fn morton(points: &[Point3]) -> Result<Vec<u32>> {
    let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points.iter().filter(|&&p| is_finite(p)) {
        for k in 0..3 {
            min[k] = min[k].min(p[k]);
            max[k] = max[k].max(p[k]);
        }
    }
    // Halves, so that no difference overflows.
    let side = (0..3)
        .map(|k| max[k] / 2.0 - min[k] / 2.0)
        .fold(0.0, f64::max);
    let cells = f64::from((1 << BITS) - 1);
    let key = |p: Point3| {
        (0..3).fold(0, |key, k| {
            let share = (p[k] / 2.0 - min[k] / 2.0) / side;
            // The cast takes NaN, where the side is 0, to 0.
            key | spread((share * cells) as u64) << k
        })
    };
    let mut items = with_room(points.len())?;
    let rows = (0u64..).zip(points).filter(|(_, p)| is_finite(**p));
    items.extend(rows.map(|(i, &p)| key(p) << 32 | i));
    radix::sort(&mut items, &mut Vec::new(), 0)?;
    Ok(items
        .into_iter()
        .map(|item| (item & u64::from(u32::MAX)) as u32)
        .collect())
}

fn is_finite(p: Point3) -> bool {
    p.iter().all(|x| x.is_finite())
}

/// The bits of a number below 2^10, two zeros after each.
fn spread(x: u64) -> u64 {
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread() {
        for x in [0, 1, 2, 5, 513, 1023] {
            let expected = (0..10).fold(0, |s, i| s | (x >> i & 1) << (3 * i));
            assert_eq!(spread(x), expected);
        }
    }

    #[test]
    fn every_finite_row_comes_once() {
        let points: Vec<Point3> = (0..1000)
            .map(|i| {
                [
                    f64::from(i % 10),
                    f64::from(i / 10 % 10),
                    f64::from(i / 100),
                ]
            })
            .chain([[f64::NAN, 0.0, 0.0], [f64::MAX, f64::MIN, 0.0]])
            .collect();
        let mut rows = morton(&points).unwrap();
        rows.sort_unstable();
        assert!(rows.into_iter().eq((0..1000).chain([1001])));
        assert_eq!(morton(&[[2.0; 3]; 3]).unwrap(), [0, 1, 2]);
    }
}
